//! The shell around the pages.

mod carry_out;
mod give;
mod keep;
#[cfg(not(target_arch = "wasm32"))]
pub mod program;
pub mod start;

use std::sync::mpsc::{Receiver, Sender, channel};

use egui::util::undoer::Undoer;
use hysteron_core::message::Message;
use hysteron_core::msg;

#[cfg(target_arch = "wasm32")]
use crate::address;
use crate::bar::Bar;
use crate::desk::Desk;
use crate::document::Document;
#[cfg(target_arch = "wasm32")]
use crate::edges;
use crate::files::Door;
use crate::fonts;
use crate::language::{self, Language, tr};
use crate::motion;
use crate::notice::{self, Notice};
use crate::page::{Hint, Page, View};
use crate::pages::registry;
use crate::save::GivenFile;
use crate::shortcuts;
use crate::theme::{self, Look};
use crate::widgets::{chart_menu, chart_zoom, typed};
use crate::{link, purpose_line};

/// Width of a window below which it is taken for a phone's, points.
const PHONE: f32 = 500.0;

/// The app: the pages and what they share.
pub struct HysteronApp {
    pages: Vec<Page>,
    front: usize,
    desk: Desk,
    /// What is set when nothing was touched.
    untouched: Document,
    /// What was set before; never what was computed.
    history: Undoer<Document>,
    /// How the app looks; as the system does where it is unknown.
    look: Option<Look>,
    language: Language,
    /// Whether nothing moves by itself.
    calm: bool,
    chosen: Chosen,
    /// Width and height of the window, points.
    size: [u32; 2],
    fingers: Fingers,
    /// Whether the sheet with the keys is open.
    sheet: bool,
    notice: Option<Notice>,
    /// Axes of the plots of the last frame, x and y, in English.
    plots: Vec<[String; 2]>,
    /// What saving a file has to say.
    said: (Sender<Message>, Receiver<Message>),
    /// Where files go that are given away, if not to the user.
    diverted: Option<Sender<GivenFile>>,
    #[cfg(target_arch = "wasm32")]
    address: address::Address,
    frame: u64,
}

/// Which of these someone has chosen: they are kept. All others are as the system has them, on every day anew.
#[derive(Default)]
struct Chosen {
    look: bool,
    language: bool,
    calm: bool,
}

/// Whether a finger was ever seen, and whether what is pressed is large enough for one.
#[derive(Default)]
struct Fingers {
    seen: bool,
    fit: bool,
}

impl Default for HysteronApp {
    fn default() -> Self {
        let (pages, desk) = (registry(), Desk::default());
        Self {
            untouched: Document::of(&pages, 0, &desk),
            pages,
            front: 0,
            desk,
            history: Undoer::default(),
            look: None,
            language: Language::English,
            calm: false,
            chosen: Chosen::default(),
            size: [0; 2],
            fingers: Fingers::default(),
            sheet: false,
            notice: None,
            plots: Vec::new(),
            said: channel(),
            diverted: None,
            #[cfg(target_arch = "wasm32")]
            address: address::Address::default(),
            frame: 0,
        }
    }
}

impl HysteronApp {
    /// The app with the page of this id in front; an unknown id changes nothing.
    pub fn at(id: &str) -> Self {
        let mut app = Self::default();
        app.go(id);
        app
    }

    /// Speaks a language from now on.
    pub fn speak(&mut self, language: Language) {
        self.language = language;
    }

    /// Ids of all pages, in the order of their tabs.
    pub fn page_ids(&self) -> Vec<&'static str> {
        self.pages.iter().map(|p| p.id).collect()
    }

    /// Opens the bytes of a file on the page in front, or on the first one that takes files.
    pub fn open(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        if let Some((page, door)) = self.go_to_files(Some(name)) {
            door.entrance.open(name, bytes);
            page.update(ctx);
        }
    }

    /// Opens a measurement from where it is in the file system, as the user does by a dialog.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn open_path(&mut self, ctx: &egui::Context, path: &std::path::Path) {
        let file: egui::DroppedFileHandle = std::sync::Arc::new(crate::files::Given::new(path));
        self.go("compare");
        if let Some((_, door)) = self.go_to_files(None) {
            door.entrance.open_dropped(ctx, &file);
        }
    }

    /// Everything that is set.
    fn document(&self) -> Document {
        Document::of(&self.pages, self.front, &self.desk)
    }

    /// What is on the screen, as a text for a link: what stands behind `#`.
    pub fn link(&self) -> String {
        self.document().link(&self.untouched)
    }

    /// Shows what a link, or the text of one, says. What cannot be is refused, changes nothing, and is said
    /// on the screen too.
    ///
    /// # Errors
    /// One sentence.
    pub fn open_link(&mut self, ctx: &egui::Context, text: &str) -> Result<(), Message> {
        let present = self.document();
        let opened = Document::read(text, &self.untouched)
            .and_then(|document| document.check_shape(&self.untouched).map(|()| document))
            .and_then(|document| self.apply(ctx, &document.within(&present)));
        match &opened {
            Ok(()) => self.desk.purpose = None,
            Err(sentence) => self.notice = Some(Notice::refused(sentence)),
        }
        opened
    }

    /// Sets everything as in `document`, or nothing.
    fn apply(&mut self, ctx: &egui::Context, document: &Document) -> Result<(), Message> {
        let present = self.document();
        let (pages, front, desk) = (&mut self.pages, &mut self.front, &mut self.desk);
        document.apply(ctx, pages, front, desk).inspect_err(|_| {
            // What was set before can be set again, but for a file that is gone.
            let _ = present.apply(ctx, pages, front, desk);
        })
    }

    /// One frame: takes what came in, draws the page, publishes the state.
    pub fn frame_ui(&mut self, ui: &mut egui::Ui) {
        if self.frame == 0 {
            fonts::apply(ui.ctx());
            theme::apply(ui.ctx());
            let look = self.look.unwrap_or_else(|| Look::of_system(ui.ctx()));
            self.set_look(ui.ctx(), look);
            self.set_calm(ui.ctx(), self.calm);
        }
        self.frame += 1;
        self.look().fit(ui.ctx());
        let window = egui::accesskit_root_id();
        ui.ctx()
            .accesskit_node_builder(window, |window| window.set_label("Hysteron"));
        self.fit_to_fingers(ui.ctx());
        language::speak(self.language);
        #[cfg(target_arch = "wasm32")]
        if edges::before(ui) {
            edges::leave(false);
        }
        self.desk.targets.clear();
        chart_menu::clear(ui.ctx());
        self.take_dropped_files(ui.ctx());
        self.take_pasted_link(ui.ctx());
        for page in &mut self.pages {
            page.view.update(ui.ctx());
            for recent in page.door.iter().flat_map(Door::opened) {
                // A link that was refused for want of this file.
                let wanted = link::not_enclosed(&recent.name);
                self.notice.take_if(|notice| *notice.text() == wanted);
                self.desk.recent.note(recent);
            }
        }
        let present = self.document();
        let now = ui.input(|i| i.time);
        self.history.feed_state(now, &present);
        shortcuts::pressed(ui.ctx(), &self.page_ids(), &mut self.desk.commands);
        let front = self.pages.get(self.front).map(|p| p.view.offer());
        let offer = front.map(|offer| (offer.hint, offer.tables.names));
        let (hint, tables) = offer.unwrap_or_default();
        egui::Panel::top("bar").show(ui, |ui| self.bar_ui(ui, &present, &tables));
        let desk = &mut self.desk;
        desk.study.ui(ui, &mut desk.targets, &mut desk.commands);
        if let Some(hint) = hint
            && desk.study.lesson.is_none()
        {
            egui::Panel::bottom("hint").show(ui, |ui| hint_ui(ui, hint, desk));
        }
        let foot = ui.available_rect_before_wrap().bottom();
        purpose_line::ui(ui, &present.page, desk);
        if let Some(page) = self.pages.get_mut(self.front) {
            desk.zooms.follow(page.id, &present.settings[page.id]);
            chart_zoom::begin(ui.ctx(), desk.zooms.of(page.id));
            page.view.ui(ui, desk);
            // Nothing moves on it.
            desk.play = false;
            desk.zooms.note(page.id, chart_zoom::end(ui.ctx()));
        }
        self.give_plots(ui);
        self.plots = chart_menu::axes(ui.ctx());
        for command in std::mem::take(&mut self.desk.commands) {
            self.carry_out(ui, command);
        }
        if let Some(sentence) = typed::refused(ui.ctx()) {
            self.notice = Some(Notice::refused(sentence));
        }
        theme::focus_ring(ui.ctx());
        self.overlays_ui(ui.ctx(), foot);
        #[cfg(target_arch = "wasm32")]
        if edges::behind(ui) {
            edges::leave(true);
        }
        #[cfg(target_arch = "wasm32")]
        crate::hook::publish(&self.hook_state());
    }

    /// What is pressed is larger in a narrow window, and where fingers are.
    fn fit_to_fingers(&mut self, ctx: &egui::Context) {
        let (touched, held) = ctx.input(|i| (i.any_touches(), i.pointer.any_down()));
        self.fingers.seen |= touched;
        let size = ctx.content_rect().size();
        self.size = [size.x, size.y].map(|v| v.round() as u32);
        let fingers = size.x < PHONE || self.fingers.seen;
        // Nothing moves from under a finger.
        if fingers != self.fingers.fit && !held {
            self.fingers.fit = fingers;
            theme::fit_to_fingers(ctx, fingers);
        }
    }

    fn set_look(&mut self, ctx: &egui::Context, look: Look) {
        self.look = Some(look);
        look.apply(ctx);
    }

    fn set_calm(&mut self, ctx: &egui::Context, calm: bool) {
        self.calm = calm;
        motion::reduce(ctx, calm);
    }

    fn look(&self) -> Look {
        self.look.unwrap_or_default()
    }

    fn go(&mut self, id: &str) {
        if let Some(index) = self.pages.iter().position(|p| p.id == id) {
            self.front = index;
        }
    }

    /// What is on the screen, for tests: the state of the page in front, that of every page by its id,
    /// and what concerns all.
    pub fn hook_state(&self) -> serde_json::Value {
        let front = self.pages.get(self.front);
        let states: Vec<_> = self.pages.iter().map(|p| p.view.hook_state()).collect();
        let busy = states.iter().any(|own| own["busy"] == true);
        let mut state = states.get(self.front).cloned().unwrap_or_default();
        for (page, own) in self.pages.iter().zip(states) {
            state[page.id] = own;
        }
        state["ready"] = true.into();
        let hint = front.and_then(|p| p.view.offer().hint);
        state["hint"] = serde_json::json!(hint.map(|h| h.sentence));
        state["busy"] = busy.into();
        state["page"] = front.map(|p| p.id).into();
        state["frame"] = self.frame.into();
        state["studied"] = self.desk.study.lesson.clone().into();
        state["solved"] = serde_json::json!(self.desk.study.solved);
        state["look"] = self.look().name().into();
        state["language"] = self.language.code().into();
        state["calm"] = self.calm.into();
        state["link"] = self.link().into();
        state["notice"] = serde_json::json!(self.notice.as_ref().map(Notice::text));
        state["size"] = serde_json::json!(self.size);
        let purpose = self.desk.purpose.as_ref();
        state["purpose"] = serde_json::json!(purpose.map(|p| &p.sentence));
        state["plots"] = serde_json::json!(self.plots);
        state["targets"] = self.desk.targets.to_json();
        state
    }

    fn bar_ui(&mut self, ui: &mut egui::Ui, present: &Document, tables: &[&'static str]) {
        let pages: Vec<_> = self.pages.iter().map(|p| (p.id, p.title)).collect();
        let bar = Bar {
            pages: &pages,
            tables,
            front: self.front,
            undo: [
                self.history.has_undo(present),
                self.history.has_redo(present),
            ],
            look: self.look(),
            language: self.language,
            calm: self.calm,
        };
        bar.ui(ui, &mut self.desk);
    }

    /// What lies over the page, which ends at `foot`.
    fn overlays_ui(&mut self, ctx: &egui::Context, foot: f32) {
        // Another page than one that takes files makes way for the first that does.
        let front = self.pages.get(self.front).and_then(|p| p.door.as_ref());
        let elsewhere = || self.pages.iter().find(|page| page.takes_files());
        let door = front.or_else(|| elsewhere()?.door.as_ref());
        if let Some(door) = door {
            drop_hint_ui(ctx, door.drop_hint);
        }
        if self.sheet {
            let titles: Vec<_> = self.pages.iter().map(|p| p.title).collect();
            self.sheet = shortcuts::sheet_ui(ctx, &titles);
        }
        if let Some(text) = self.said.1.try_iter().last() {
            self.notice = Some(Notice::done(ctx, text));
        }
        notice::ui(ctx, &mut self.notice, foot);
    }

    fn take_dropped_files(&mut self, ctx: &egui::Context) {
        let (first, count) = ctx.input(|i| {
            let files = &i.raw.dropped_files;
            (files.first().cloned(), files.len())
        });
        let Some(file) = first else {
            return;
        };
        let name = file.path().to_string_lossy();
        if let Some((_, door)) = self.go_to_files(Some(&name)) {
            door.entrance.open_dropped(ctx, &file);
        }
        if count > 1 {
            let name = file.path().file_name().unwrap_or_default();
            let name = name.to_string_lossy();
            let saying = msg!(
                "Only one of the {} files is opened: {}.",
                count,
                Message::name(name)
            );
            self.notice = Some(Notice::done(ctx, saying));
        }
    }

    /// A link that is pasted while no text field has the keyboard is opened.
    fn take_pasted_link(&mut self, ctx: &egui::Context) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        let pasted = ctx.input(|i| {
            i.events.iter().find_map(|event| match event {
                egui::Event::Paste(text) => Some(text.clone()),
                _ => None,
            })
        });
        if let Some(text) = pasted {
            let _ = self.open_link(ctx, &text);
        }
    }

    /// Brings a page that takes a file of this name to the front, unless one is there.
    fn go_to_files(&mut self, name: Option<&str>) -> Option<(&mut Box<dyn View>, &Door)> {
        let has_door = |page: &Page| page.door.as_ref().is_some_and(|d| d.takes(name));
        if !self.pages.get(self.front).is_some_and(has_door) {
            self.front = self.pages.iter().position(Page::takes_files)?;
        }
        let page = self.pages.get_mut(self.front)?;
        Some((&mut page.view, page.door.as_ref()?))
    }
}

/// What to try next.
fn hint_ui(ui: &mut egui::Ui, hint: Hint, desk: &mut Desk) {
    let sentence = tr(hint.sentence);
    if hint.commands.is_empty() {
        ui.label(sentence);
        return;
    }
    ui.horizontal(|ui| {
        // The sentence breaks beside the button, which stays on the screen.
        let room = ui.available_width() - theme::button_width(ui, "Try it");
        ui.scope(|ui| {
            ui.set_max_width(room);
            ui.add(egui::Label::new(sentence).wrap());
        });
        let button = ui.button(tr("Try it"));
        desk.targets.note("try", ui, &button);
        if button.clicked() {
            desk.commands.extend(hint.commands);
        }
    });
}

fn drop_hint_ui(ctx: &egui::Context, sentence: &'static str) {
    if ctx.input(|i| !i.raw.hovered_files.is_empty()) {
        egui::Area::new(egui::Id::unique("drop"))
            .anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| ui.heading(tr(sentence)));
            });
    }
}
