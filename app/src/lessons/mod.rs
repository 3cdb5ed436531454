//! Lessons: texts in `assets/lessons/` with live buttons and a question that the app checks.
//!
//! A lesson is a file and a line in [`SOURCES`]. Its text is Markdown: `# title`, `## heading`, paragraphs,
//! `- points`, `**strong**`, `` `formula` ``, and links to states of the app, `[Set ε to 0.5](#v1;explore;...)`.
//! Lines that begin with a key say the rest:
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

/// The texts, in the order of the course, by their ids.
const SOURCES: [(&str, &str); 8] = [
    ("relay", include_str!("../../../assets/lessons/relay.md")),
    (
        "oscillation",
        include_str!("../../../assets/lessons/oscillation.md"),
    ),
    ("exact", include_str!("../../../assets/lessons/exact.md")),
    (
        "ultimate",
        include_str!("../../../assets/lessons/ultimate.md"),
    ),
    ("tuning", include_str!("../../../assets/lessons/tuning.md")),
    ("gap", include_str!("../../../assets/lessons/gap.md")),
    ("drift", include_str!("../../../assets/lessons/drift.md")),
    (
        "mystery",
        include_str!("../../../assets/lessons/mystery.md"),
    ),
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

/// All lessons, in the order of the course.
pub fn all() -> impl Iterator<Item = Lesson> {
    SOURCES.iter().map(|(id, source)| Lesson::read(id, source))
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

    /// Links of its live buttons.
    pub fn links(&self) -> impl Iterator<Item = &'static str> {
        self.text.iter().flat_map(|line| markdown::links(line))
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
