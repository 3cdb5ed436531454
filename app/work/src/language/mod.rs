//! The language of what is read. The app thinks in English; what it says is translated where it is drawn:
//! `ui.label(tr("..."))`, and what the command line says where it is printed. So state, links, JSON, tests and files
//! are the same in every language.
//!
//! A language is a folder of texts in `assets/` and a line in [`Language::ALL`]; see `docs/translation.md`.

mod catalogue;
mod number;
mod plain;
mod tied;

use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use hysteron_core::message::Message;

pub use catalogue::Catalogue;
pub use number::typed_in;
pub use plain::is_plain;
use tied::{TIE, tied};

/// A language that the app speaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Language {
    /// What stands in the source.
    #[default]
    English,
    /// Deutsch.
    German,
}

/// The German texts, by the parts of the app. What only a terminal says is not part of the page.
const GERMAN: &[&str] = &[
    include_str!("../../../../assets/german/app.txt"),
    include_str!("../../../../assets/german/backlash.txt"),
    include_str!("../../../../assets/german/compare.txt"),
    include_str!("../../../../assets/german/controllers.txt"),
    include_str!("../../../../assets/german/effects.txt"),
    include_str!("../../../../assets/german/errors.txt"),
    include_str!("../../../../assets/german/loops.txt"),
    include_str!("../../../../assets/german/tune.txt"),
    include_str!("../../../../assets/german/mystery.txt"),
    include_str!("../../../../assets/german/report.txt"),
    #[cfg(not(target_arch = "wasm32"))]
    include_str!("../../../../assets/german/terminal.txt"),
];

impl Language {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 2] = [Self::English, Self::German];

    /// Its name in itself.
    pub fn name(self) -> &'static str {
        match self {
            Self::English => "English",
            Self::German => "Deutsch",
        }
    }

    /// Its code (ISO 639-1), also where it is kept.
    pub fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::German => "de",
        }
    }

    /// The language of a code, or of a locale such as `de_AT.UTF-8` or `de-CH`.
    pub fn of_locale(locale: &str) -> Option<Self> {
        let code = locale.split(['_', '-', '.', '@']).next()?;
        let code = code.to_ascii_lowercase();
        Self::ALL.into_iter().find(|l| l.code() == code)
    }

    /// That of the system or the browser; English where the app does not speak it.
    pub fn of_system() -> Self {
        system_locale()
            .and_then(|locale| Self::of_locale(&locale))
            .unwrap_or_default()
    }

    /// Its texts; English has none.
    fn sources(self) -> &'static [&'static str] {
        match self {
            Self::English => &[],
            Self::German => GERMAN,
        }
    }

    /// All that is said in it, by what it is in English.
    pub fn catalogue(self) -> Catalogue {
        Catalogue::read(self.sources())
    }
}

/// The locale of messages, as POSIX names it (IEEE 1003.1, 8.2).
#[cfg(not(target_arch = "wasm32"))]
fn system_locale() -> Option<String> {
    ["LC_ALL", "LC_MESSAGES", "LANG"]
        .into_iter()
        .filter_map(|name| std::env::var(name).ok())
        .find(|locale| !locale.is_empty())
}

#[cfg(target_arch = "wasm32")]
fn system_locale() -> Option<String> {
    web_sys::window()?.navigator().language()
}

/// Untranslated texts that are remembered.
const MISSED: usize = 200;

#[derive(Default)]
struct Speaker {
    catalogue: Option<Catalogue>,
    missed: BTreeSet<String>,
}

thread_local! {
    // Whatever draws does so on one thread.
    static LANGUAGE: Cell<Language> = const { Cell::new(Language::English) };
    static SPEAKER: RefCell<Speaker> = RefCell::default();
}

/// The language that is spoken on this thread.
pub fn spoken() -> Language {
    LANGUAGE.get()
}

/// Speaks a language on this thread from now on.
pub fn speak(language: Language) {
    if LANGUAGE.replace(language) != language {
        SPEAKER.set(Speaker::default());
    }
}

/// A text of the interface in the language that is spoken: the English one where it has no translation. Its numbers
/// stay on a line with their units.
pub fn tr<'a>(text: impl Into<Said<'a>>) -> String {
    let Said(message) = text.into();
    match spoken() {
        Language::English => tied(message.to_string()),
        language @ Language::German => {
            SPEAKER.with_borrow_mut(|speaker| speaker.say(language, &message))
        }
    }
}

/// What is said: a message, or a literal, which is one without values. What is put together as the program runs is no
/// literal, so that no text is looked up that no one could have translated.
#[derive(Debug)]
pub struct Said<'a>(Cow<'a, Message>);

impl From<&'static str> for Said<'_> {
    fn from(text: &'static str) -> Self {
        Message::from(text).into()
    }
}

impl From<&&'static str> for Said<'_> {
    fn from(text: &&'static str) -> Self {
        Message::from(text).into()
    }
}

impl From<Message> for Said<'_> {
    fn from(message: Message) -> Self {
        Self(Cow::Owned(message))
    }
}

impl<'a> From<&'a Message> for Said<'a> {
    fn from(message: &'a Message) -> Self {
        Self(Cow::Borrowed(message))
    }
}

/// The same with usual spaces, for a terminal and for files, where nothing breaks a line but who writes it.
pub fn say<'a>(text: impl Into<Said<'a>>) -> String {
    let Said(message) = text.into();
    match spoken() {
        Language::English => message.to_string(),
        Language::German => tr(Said(message)).replace(TIE, " "),
    }
}

/// A text of the interface as a sentence of its own: on a terminal it goes on behind the name of a file.
pub fn tr_sentence<'a>(text: impl Into<Said<'a>>) -> String {
    let text = tr(text);
    let mut rest = text.chars();
    let initial = rest.next().map(char::to_uppercase);
    let end = if text.ends_with(['.', '?', '!']) {
        ""
    } else {
        "."
    };
    let initial: String = initial.into_iter().flatten().collect();
    format!("{initial}{}{end}", rest.as_str())
}

/// Numbers of the interface, with a decimal comma where the language has one; names stay as they are.
pub fn tr_number(text: impl AsRef<str>) -> String {
    match spoken() {
        Language::English => text.as_ref().to_owned(),
        Language::German => number::with_comma(text.as_ref()),
    }
}

/// What was said since the language was chosen and had no translation.
pub fn missed() -> Vec<String> {
    SPEAKER.with_borrow(|speaker| speaker.missed.iter().cloned().collect())
}

impl Speaker {
    fn say(&mut self, language: Language, message: &Message) -> String {
        let catalogue = self.catalogue.get_or_insert_with(|| language.catalogue());
        let said = catalogue.say(message);
        if !said.complete && self.missed.len() < MISSED {
            self.missed.insert(message.to_string());
        }
        tied(said.text)
    }
}
