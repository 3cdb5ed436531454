//! What a page is to the app around it.

use hysteron_core::message::Message;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::command::Command;
use crate::desk::Desk;
use crate::export::{Table, Tables};
use crate::files::Door;
use crate::link::parsed;

/// A page, and what is known of it whatever is on it.
pub struct Page {
    /// Its name in links and tests.
    pub id: &'static str,
    /// What its tab says.
    pub title: &'static str,
    /// The page itself.
    pub view: Box<dyn View>,
    /// Where files come in, if it takes any.
    pub door: Option<Door>,
    /// Whether it takes them only while it is in front.
    pub in_front_only: bool,
}

impl Page {
    /// A page that takes no files.
    pub fn new(id: &'static str, title: &'static str, view: impl View + 'static) -> Self {
        Self {
            id,
            title,
            view: Box::new(view),
            door: None,
            in_front_only: false,
        }
    }

    /// Whether files that come in while another page is in front are brought to it.
    pub fn takes_files(&self) -> bool {
        self.door.is_some() && !self.in_front_only
    }

    /// A page that takes the files that come in by this door.
    pub fn with_door(self, door: Door) -> Self {
        Self {
            door: Some(door),
            ..self
        }
    }

    /// The same of one that takes them only while it is in front.
    pub fn with_own_door(self, door: Door) -> Self {
        Self {
            in_front_only: true,
            ..self.with_door(door)
        }
    }
}

/// What a page does.
pub trait View: Kept {
    /// Takes in what its jobs and files have brought; also called while another page is in front.
    fn update(&mut self, _ctx: &egui::Context) {}
    /// Draws it.
    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk);
    /// What the app around it can offer now.
    fn offer(&self) -> Offer<'_> {
        Offer::default()
    }
    /// What it shows, for tests: an object, with `busy` while a job runs.
    fn hook_state(&self) -> Value;
}

/// What is set on a page, as a plain value: what links, undo and the autosave keep.
pub trait Settable {
    /// All that can be set.
    type Settings: Serialize + DeserializeOwned;
    /// What is set.
    fn set_to(&self) -> Self::Settings;
    /// Sets it.
    ///
    /// # Errors
    /// One sentence where it cannot be; then nothing is changed.
    fn take(
        &mut self,
        ctx: &egui::Context,
        settings: Self::Settings,
        desk: &Desk,
    ) -> Result<(), Message>;
}

/// [`Settable`] as the app around a page knows it, whatever its settings are.
pub trait Kept {
    /// What is set.
    fn settings(&self) -> Value;
    /// Sets it.
    ///
    /// # Errors
    /// One sentence where it cannot be; then nothing is changed.
    fn set(&mut self, ctx: &egui::Context, settings: &Value, desk: &Desk) -> Result<(), Message>;
}

impl<T: Settable> Kept for T {
    fn settings(&self) -> Value {
        serde_json::json!(self.set_to())
    }

    fn set(&mut self, ctx: &egui::Context, settings: &Value, desk: &Desk) -> Result<(), Message> {
        self.take(ctx, parsed(settings)?, desk)
    }
}

/// What the app around a page offers for it.
#[derive(Default)]
pub struct Offer<'a> {
    /// What to try next.
    pub hint: Option<Hint>,
    /// The numbers behind what it shows.
    pub tables: Tables<'a>,
}

impl<'a> Offer<'a> {
    /// A hint, and tables of these names, in the order in which `numbers` gives them.
    pub fn new(
        hint: impl Into<Option<Hint>>,
        names: impl Into<Vec<&'static str>>,
        numbers: impl Fn() -> Vec<Table> + 'a,
    ) -> Self {
        Self {
            hint: hint.into(),
            tables: Tables::new(names, numbers),
        }
    }
}

/// What to try next: a sentence, and what does it at a press; some things only the user can do.
pub struct Hint {
    pub sentence: Message,
    pub commands: Vec<Command>,
}

impl Hint {
    /// One that a link shows.
    pub fn open(sentence: &'static str, link: &str) -> Self {
        Self {
            sentence: sentence.into(),
            commands: vec![Command::OpenLink(link.to_owned())],
        }
    }

    /// One that the app cannot do.
    pub fn say(sentence: impl Into<Message>) -> Self {
        Self {
            sentence: sentence.into(),
            commands: Vec::new(),
        }
    }
}
