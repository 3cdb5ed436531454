//! Lessons: texts in `assets/lessons/` with live buttons and a question that the app checks.
//!
//! A lesson is a file for each language and a line in `SOURCES`. Its text is Markdown: `# title`, `## heading`,
//! paragraphs, `- points`, `**strong**`, `` `formula` ``, and links to states of the app, `[Set ε to
//! 0.5](#v1;explore;...)`. Lines that begin with a key say the rest:
//!
//! ```text
//! minutes: 5
//! answer: 2.197 within 2 % [s]
//! reach: backlash.direction is with
//! reach: compare.error between 0 and 1.2
//! hint: what helps whoever is stuck
//! right: what is said when it is solved
//! ```

mod markdown;
mod panel;
mod question;

pub use panel::Study;
use question::Question;

use crate::language::{self, Language};

/// A text in each language of [`Language::ALL`].
type Texts = [&'static str; Language::ALL.len()];

macro_rules! texts {
    ($id:literal) => {
        (
            $id,
            [
                include_str!(concat!("../../../assets/lessons/", $id, ".md")),
                include_str!(concat!("../../../assets/lessons/german/", $id, ".md")),
            ],
        )
    };
}

/// The texts, in the order of the course, by their ids.
const SOURCES: [(&str, Texts); 10] = [
    texts!("relay"),
    texts!("oscillation"),
    texts!("exact"),
    texts!("ultimate"),
    texts!("tuning"),
    texts!("gap"),
    texts!("drift"),
    texts!("hunting"),
    texts!("mystery"),
    texts!("unknown"),
];

/// A lesson.
pub struct Lesson {
    /// Its name in links.
    pub id: &'static str,
    /// Its title.
    pub title: &'static str,
    /// How long it takes, minutes.
    pub minutes: u32,
    /// What stands before the question.
    text: Vec<&'static str>,
    question: Question,
}

/// All lessons, in the order of the course, in the language that is spoken.
pub fn all() -> impl Iterator<Item = Lesson> {
    all_in(language::spoken())
}

/// All lessons in a language.
pub fn all_in(language: Language) -> impl Iterator<Item = Lesson> {
    let place = Language::ALL.iter().position(|l| *l == language);
    SOURCES
        .iter()
        .map(move |(id, texts)| Lesson::read(id, texts[place.unwrap_or(0)]))
}

/// The lesson of this id.
pub fn find(id: &str) -> Option<Lesson> {
    all().find(|l| l.id == id)
}

/// The lesson after the one of this id.
pub fn after(id: &str) -> Option<Lesson> {
    all().skip_while(|l| l.id != id).nth(1)
}

impl Lesson {
    fn read(id: &'static str, source: &'static str) -> Self {
        let mut lesson = Self {
            id,
            title: id,
            minutes: 10,
            text: Vec::new(),
            question: Question::default(),
        };
        for line in source.lines() {
            if let Some(title) = line.strip_prefix("# ") {
                lesson.title = title;
            } else if let Some(minutes) = line.strip_prefix("minutes: ") {
                lesson.minutes = minutes.parse().unwrap_or(lesson.minutes);
            } else if !lesson.question.read(line) {
                lesson.text.push(line);
            }
        }
        lesson
    }

    /// Draws its first paragraph.
    pub fn beginning_ui(&self, ui: &mut egui::Ui) {
        if let Some(first) = self.text.iter().find(|line| !line.trim().is_empty()) {
            markdown::ui(ui, &[first]);
        }
    }

    /// Links of its live buttons.
    pub fn links(&self) -> impl Iterator<Item = &'static str> {
        self.text.iter().flat_map(|line| markdown::links(line))
    }

    /// What its question asks for, whatever the language.
    pub fn asked(&self) -> String {
        self.question.asked()
    }

    /// What is wrong with its text; nothing, if the tests have passed.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = self.question.faults();
        if self.title == self.id {
            faults.push("it has no title".to_owned());
        }
        if self.links().next().is_none() {
            faults.push("it has no live button".to_owned());
        }
        faults
    }
}
