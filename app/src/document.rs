//! Everything that is set in the app, as one plain value: links, undo and the autosave hold nothing else.

use hysteron_core::explore::ExploreInput;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_work::enclosed::is_enclosed;
use serde_json::{Value, json};

use crate::desk::Desk;
use crate::lessons::find;
use crate::link::{self, parsed};
use crate::page::Page;
use crate::zoom::Zooms;

/// Key of the loop that several pages share.
const LOOP: &str = "loop";
/// Key of the lesson that is open.
const LESSON: &str = "lesson";
/// Key of what of the plots is in view, page by page.
const ZOOM: &str = "zoom";

/// The page in front and what is set on every page.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// Id of the page in front.
    pub page: String,
    /// By page, and what pages share.
    pub settings: Value,
}

impl Document {
    /// What is set now.
    pub fn of(pages: &[Page], front: usize, desk: &Desk) -> Self {
        let ids = pages.iter().map(|p| p.id);
        let zooms = ids.map(|id| (id.to_owned(), json!(desk.zooms.of(id).text())));
        let shared = [
            (LOOP.to_owned(), json!(desk.relay_loop)),
            (LESSON.to_owned(), json!(desk.study.lesson)),
            (ZOOM.to_owned(), link::object(zooms)),
        ];
        let own = pages.iter().map(|p| (p.id.to_owned(), p.view.settings()));
        Self {
            page: pages.get(front).map_or("", |p| p.id).to_owned(),
            settings: link::object(shared.into_iter().chain(own)),
        }
    }

    /// As a link: what is on the screen, which is the page in front and what it shares with others.
    pub fn link(&self, defaults: &Self) -> String {
        let mut shown = defaults.settings.clone();
        for key in [LOOP, LESSON, &self.page] {
            shown[key] = self.settings[key].clone();
        }
        shown[ZOOM][&self.page] = self.settings[ZOOM][&self.page].clone();
        link::write(&self.page, &shown, &defaults.settings)
    }

    /// The files on the page in front that no link can carry: the user's own, a measurement and a model.
    pub fn files(&self) -> Vec<&str> {
        let named = ["file", "model"].map(|key| self.settings[&self.page][key].as_str());
        let named = named.into_iter().flatten();
        named.filter(|name| !is_enclosed(name)).collect()
    }

    /// As a text that keeps everything.
    pub fn text(&self, defaults: &Self) -> String {
        link::write(&self.page, &self.settings, &defaults.settings)
    }

    /// Reads what [`Self::text`] or [`Self::link`] has written.
    ///
    /// # Errors
    /// One sentence.
    pub fn read(text: &str, defaults: &Self) -> Result<Self, Message> {
        let (page, settings) = link::read(text, &defaults.settings)?;
        Ok(Self { page, settings })
    }

    /// Whether all that is set has the shape of what is set when nothing was touched.
    ///
    /// # Errors
    /// One sentence.
    pub fn check_shape(&self, defaults: &Self) -> Result<(), Message> {
        link::check_shape(&self.settings, &defaults.settings)
    }

    /// What a link sets here: its page and what pages share; the other pages stay as they are.
    pub fn within(mut self, present: &Self) -> Self {
        let mut settings = present.settings.clone();
        for key in [LOOP, LESSON, &self.page] {
            settings[key] = self.settings[key].take();
        }
        settings[ZOOM][&self.page] = self.settings[ZOOM][&self.page].clone();
        self.settings = settings;
        self
    }

    /// Sets all that differs from what is set now; on an error some of it may have been set.
    ///
    /// # Errors
    /// One sentence.
    pub fn apply(
        &self,
        ctx: &egui::Context,
        pages: &mut [Page],
        front: &mut usize,
        desk: &mut Desk,
    ) -> Result<(), Message> {
        let Some(index) = pages.iter().position(|p| p.id == self.page) else {
            let known: Vec<&str> = pages.iter().map(|p| p.id).collect();
            return Err(msg!(
                "This link leads to a page that does not exist; the pages are {}.",
                known.join(", ")
            ));
        };
        let relay_loop: ExploreInput = parsed(&self.settings[LOOP])?;
        relay_loop
            .validate()
            .map_err(|e| msg!("This loop is not possible: {}.", e))?;
        let lesson: Option<String> = parsed(&self.settings[LESSON])?;
        if lesson.as_deref().is_some_and(|id| find(id).is_none()) {
            return Err("This link leads to a lesson that does not exist.".into());
        }
        let zooms = pages
            .iter()
            .map(|p| Zooms::read(&self.settings[ZOOM][p.id]));
        let zooms: Vec<Zooms> = zooms.collect::<Result<_, _>>()?;
        desk.relay_loop = relay_loop;
        desk.study.lesson = lesson;
        for page in pages.iter_mut() {
            let settings = &self.settings[page.id];
            if page.view.settings() != *settings {
                page.view.set(ctx, settings, desk)?;
            }
        }
        for (page, zooms) in pages.iter().zip(zooms) {
            desk.zooms.set(page.id, zooms, &page.view.settings());
        }
        *front = index;
        Ok(())
    }

    /// Sets what can be set, page by page, and leaves out the rest.
    pub fn restore(
        &self,
        ctx: &egui::Context,
        pages: &mut [Page],
        front: &mut usize,
        desk: &mut Desk,
    ) {
        if let Ok(relay_loop) = parsed::<ExploreInput>(&self.settings[LOOP])
            && relay_loop.validate().is_ok()
        {
            desk.relay_loop = relay_loop;
        }
        let lesson: Option<String> = parsed(&self.settings[LESSON]).ok().flatten();
        desk.study.lesson = lesson.filter(|id| find(id).is_some());
        for page in pages.iter_mut() {
            // A page whose settings are of another day begins anew.
            let _ = page.view.set(ctx, &self.settings[page.id], desk);
            let zooms = Zooms::read(&self.settings[ZOOM][page.id]).unwrap_or_default();
            desk.zooms.set(page.id, zooms, &page.view.settings());
        }
        if let Some(index) = pages.iter().position(|p| p.id == self.page) {
            *front = index;
        }
    }
}
