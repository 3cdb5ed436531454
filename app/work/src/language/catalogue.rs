//! Texts and what they are in another language.
//!
//! ```text
//! # a remark
//! It oscillates: period {} s, amplitude {}.
//! Sie schwingt: Periode {} s, Amplitude {}.
//!
//! Reading {*} from {}
//! Aus {2} wird {1} gelesen
//! ```
//!
//! Two lines each, English first, an empty line between them. `{}` stands for a part that is translated on its own: a
//! number (it gets a decimal comma), a name, a sentence that the core has made. `{*}` stands for what stays as it is: a
//! name that the user has given. The translation has the same number of them; `{1}`, `{2}` say which, where their order
//! is another. `\n` is a new line.

use std::collections::HashMap;

use hysteron_core::message::Message;

use super::number::with_comma;

/// Texts nested in each other, at most.
const DEEPEST: usize = 8;

/// Words that are the same in every language: units, names of functions and of parameters.
const SAME: [&str; 59] = [
    "rad", "mrad", "deg", "rev", "ms", "us", "µs", "kg", "mm", "um", "mN", "kN", "mA", "mV", "Hz",
    "rpm", "min", "Ti", "Td", "Tf", "Ms", "cos", "sin", "exp", "sgn", "ln", "sqrt", "tau", "phi",
    "beta", "dt", "dy", "du", "dx", "dv", "log", "Hysteron", "csv", "toml", "abs", "rms", "kHz",
    "max", "counts", "dw", "tanh", "dc", "Ku", "Tu", "µrad", "µm", "µN", "µV", "ambient", "kp",
    "ki", "kd", "ti", "td",
];

/// What joins parts that are translated one by one, English and translated; the loosest first.
type Joint = (&'static str, &'static str);
const JOINTS: [Joint; 6] = [
    ("\n", "\n"),
    ("; ", "; "),
    (", and ", " und "),
    (", ", ", "),
    (" and ", " und "),
    (" or ", " oder "),
];

/// Between two sentences.
const SENTENCE: &str = ". ";

/// A text in another language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Translated {
    /// As far as it is translated.
    pub text: String,
    /// Whether all of it is.
    pub complete: bool,
}

/// A piece of a translation.
#[derive(Clone, Debug)]
enum Piece {
    Text(String),
    Slot(usize),
}

/// A text with slots.
#[derive(Debug)]
struct Pattern {
    /// What stands before, between and behind the slots.
    texts: Vec<String>,
    /// Whether a slot stays as it is.
    verbatim: Vec<bool>,
    translation: Vec<Piece>,
    /// Letters outside of the slots: the more, the closer it fits.
    weight: usize,
}

/// A translation with slots.
#[derive(Clone, Debug)]
struct Filled {
    pieces: Vec<Piece>,
    /// Whether a slot stays as it is.
    verbatim: Vec<bool>,
}

/// All texts of a language.
#[derive(Debug, Default)]
pub struct Catalogue {
    texts: HashMap<String, String>,
    /// By their English, with `{}` for every slot.
    messages: HashMap<String, Filled>,
    patterns: Vec<Pattern>,
    faults: Vec<String>,
}

impl Catalogue {
    /// Reads texts; what is wrong with them stands in [`Self::faults`].
    pub fn read(sources: &[&str]) -> Self {
        let mut catalogue = Self::default();
        for source in sources {
            let mut english = None;
            for line in source.lines().filter(|l| !l.starts_with('#')) {
                match english.take() {
                    _ if line.is_empty() => {}
                    None => english = Some(line),
                    Some(english) => catalogue.add(english, line),
                }
            }
        }
        catalogue
            .patterns
            .sort_by_key(|p| std::cmp::Reverse(p.weight));
        catalogue
    }

    fn add(&mut self, english: &str, translation: &str) {
        let [english, translation] = [english, translation].map(|t| t.replace("\\n", "\n"));
        let (from, to) = (pieces(&english), pieces(&translation));
        let verbatim: Vec<bool> = from
            .iter()
            .filter_map(Raw::slot)
            .map(|s| s == "*")
            .collect();
        if verbatim.is_empty() {
            if self.texts.insert(english.clone(), translation).is_some() {
                self.faults.push(format!("twice: {english}"));
            }
            return;
        }
        let mut next = 0;
        let translation: Vec<Piece> = to
            .into_iter()
            .map(|piece| match piece {
                Raw::Text(text) => Piece::Text(text.to_owned()),
                Raw::Slot(name) => {
                    next += 1;
                    Piece::Slot(name.parse::<usize>().unwrap_or(next) - 1)
                }
            })
            .collect();
        let mut used: Vec<usize> = translation.iter().filter_map(Piece::slot).collect();
        used.sort_unstable();
        if used != (0..verbatim.len()).collect::<Vec<_>>() {
            self.faults.push(format!("other slots: {english}"));
            return;
        }
        let mut texts = vec![String::new()];
        for piece in from {
            match piece {
                Raw::Text(text) => {
                    if let Some(last) = texts.last_mut() {
                        last.push_str(text);
                    }
                }
                Raw::Slot(_) => texts.push(String::new()),
            }
        }
        let filled = Filled {
            pieces: translation.clone(),
            verbatim: verbatim.clone(),
        };
        let key = texts.join("{}");
        if self.messages.insert(key, filled).is_some() {
            self.faults.push(format!("twice: {english}"));
        }
        self.patterns.push(Pattern {
            weight: texts.iter().map(String::len).sum(),
            texts,
            verbatim,
            translation,
        });
    }

    /// What is wrong with the texts; nothing, if the tests have passed.
    pub fn faults(&self) -> &[String] {
        &self.faults
    }

    /// The English texts with `{}` in place of the slots.
    pub fn english(&self) -> impl Iterator<Item = String> {
        let patterns = self.patterns.iter().map(|p| p.texts.join("{}"));
        self.texts.keys().cloned().chain(patterns)
    }

    /// A text in this language, as far as it is known.
    pub fn translate(&self, text: &str) -> Translated {
        self.nested(text, 0)
    }

    /// A message in this language: its English is the key of its words. What has no translation stays.
    pub fn say(&self, message: &Message) -> Translated {
        match message {
            Message::Words(words, values) => self.words(words, values),
            Message::Number(number) => Translated {
                text: with_comma(number),
                complete: true,
            },
            Message::Name(name) => Translated {
                text: name.clone(),
                complete: true,
            },
            Message::List(joint, items) => self.list(joint, items),
        }
    }

    fn words(&self, words: &str, values: &[Message]) -> Translated {
        if let Some(text) = self.texts.get(words) {
            return Translated {
                text: text.clone(),
                complete: true,
            };
        }
        let said: Vec<Translated> = values.iter().map(|value| self.say(value)).collect();
        let texts = || said.iter().map(|value| value.text.as_str());
        let Some(Filled { pieces, verbatim }) = self.messages.get(words) else {
            return Translated {
                text: filled_in(words, texts()),
                complete: is_plain(words) && said.iter().all(|value| value.complete),
            };
        };
        let piece = |piece: &Piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Slot(at) if verbatim.get(*at) == Some(&true) => {
                values.get(*at).map(Message::to_string).unwrap_or_default()
            }
            Piece::Slot(at) => texts().nth(*at).unwrap_or_default().to_owned(),
        };
        let mut all = said.iter().zip(verbatim);
        Translated {
            text: pieces.iter().map(piece).collect(),
            complete: all.all(|(value, verbatim)| *verbatim || value.complete),
        }
    }

    fn list(&self, joint: &str, items: &[Message]) -> Translated {
        // Numbers that have commas are listed with semicolons.
        if items.iter().all(|item| matches!(item, Message::Number(_))) {
            let items: Vec<String> = items.iter().map(Message::to_string).collect();
            return Translated {
                text: with_comma(&items.join(joint)),
                complete: true,
            };
        }
        let items: Vec<Translated> = items.iter().map(|item| self.say(item)).collect();
        let texts: Vec<&str> = items.iter().map(|item| item.text.as_str()).collect();
        let known = JOINTS.iter().find(|known| known.0 == joint);
        Translated {
            text: texts.join(known.map_or(joint, |known| known.1)),
            complete: items.iter().all(|item| item.complete),
        }
    }

    fn nested(&self, text: &str, depth: usize) -> Translated {
        if let Some(known) = self.texts.get(text) {
            return Translated {
                text: known.clone(),
                complete: true,
            };
        }
        if is_plain(text) {
            return Translated {
                text: with_comma(text),
                complete: true,
            };
        }
        let unknown = Translated {
            text: text.to_owned(),
            complete: false,
        };
        if depth >= DEEPEST {
            return unknown;
        }
        let mut partly = None;
        let mut swallowed = None;
        for pattern in &self.patterns {
            if let Some(parts) = pattern.matches(text) {
                let found = self.fill(pattern, &parts, depth);
                if found.complete && !Pattern::swallows(&parts) {
                    return found;
                }
                let kept = if found.complete {
                    &mut swallowed
                } else {
                    &mut partly
                };
                kept.get_or_insert(found);
            }
        }
        self.halves(text, SENTENCE, depth)
            .or(swallowed)
            .or_else(|| self.halves(text, ": ", depth))
            .or_else(|| JOINTS.iter().find_map(|j| self.joined(text, *j, depth)))
            .or(partly)
            .unwrap_or(unknown)
    }

    fn fill(&self, pattern: &Pattern, parts: &[&str], depth: usize) -> Translated {
        let mut complete = true;
        let parts: Vec<String> = parts
            .iter()
            .zip(&pattern.verbatim)
            .map(|(part, verbatim)| {
                if *verbatim {
                    return (*part).to_owned();
                }
                let inner = self.nested(part, depth + 1);
                complete &= inner.complete;
                inner.text
            })
            .collect();
        let text = pattern.translation.iter().map(|piece| match piece {
            Piece::Text(text) => text.as_str(),
            Piece::Slot(index) => &parts[*index],
        });
        Translated {
            text: text.collect(),
            complete,
        }
    }

    /// Both sides of an end of a sentence, or of a colon, if both are known. A full stop belongs to its sentence.
    fn halves(&self, text: &str, end: &str, depth: usize) -> Option<Translated> {
        let (kept, between) = end.split_at(usize::from(end.starts_with('.')));
        text.match_indices(end).find_map(|(at, _)| {
            let first = self.nested(&text[..at + kept.len()], depth + 1);
            let rest = &text[at + end.len()..];
            let rest = first.complete.then(|| self.nested(rest, depth + 1));
            rest.filter(|r| r.complete).map(|rest| Translated {
                text: format!("{}{between}{}", first.text, rest.text),
                complete: true,
            })
        })
    }

    /// Part by part, if all of them are known.
    fn joined(&self, text: &str, (joint, translated): Joint, depth: usize) -> Option<Translated> {
        if !text.contains(joint) {
            return None;
        }
        let parts: Option<Vec<String>> = text
            .split(joint)
            .map(|part| {
                let part = self.nested(part, depth + 1);
                part.complete.then_some(part.text)
            })
            .collect();
        parts.map(|parts| Translated {
            text: parts.join(translated),
            complete: true,
        })
    }
}

impl Pattern {
    /// What stands in the slots, if the text fits; each as short as the next text allows.
    fn matches<'t>(&self, text: &'t str) -> Option<Vec<&'t str>> {
        let (first, last) = (self.texts.first()?, self.texts.last()?);
        let rest = text.strip_prefix(first.as_str())?;
        let mut rest = rest.strip_suffix(last.as_str())?;
        let mut parts = Vec::with_capacity(self.verbatim.len());
        for between in self.texts.get(1..self.texts.len() - 1)? {
            let at = rest.find(between.as_str())?;
            parts.push(&rest[..at]);
            rest = &rest[at + between.len()..];
        }
        parts.push(rest);
        parts.iter().all(|p| !p.is_empty()).then_some(parts)
    }

    /// Whether a slot holds the end of a sentence: it may have taken in the sentences that stand beside its own.
    fn swallows(parts: &[&str]) -> bool {
        parts.iter().any(|part| part.contains(SENTENCE))
    }
}

impl Piece {
    fn slot(&self) -> Option<usize> {
        match self {
            Self::Text(_) => None,
            Self::Slot(index) => Some(*index),
        }
    }
}

/// A piece of a line.
enum Raw<'a> {
    Text(&'a str),
    /// What stands in the braces.
    Slot(&'a str),
}

impl<'a> Raw<'a> {
    fn slot(&self) -> Option<&'a str> {
        match self {
            Self::Text(_) => None,
            Self::Slot(name) => Some(name),
        }
    }
}

/// Cuts a line at its slots; other braces are text.
fn pieces(line: &str) -> Vec<Raw<'_>> {
    let mut pieces = Vec::new();
    let (mut start, mut from) = (0, 0);
    while let Some(open) = line[from..].find('{').map(|i| from + i) {
        from = open + 1;
        let Some(close) = line[open..].find('}').map(|i| open + i) else {
            break;
        };
        let name = &line[open + 1..close];
        let numbered = |n: &str| n.parse::<usize>().is_ok_and(|n| (1..100).contains(&n));
        if name.is_empty() || name == "*" || numbered(name) {
            if start < open {
                pieces.push(Raw::Text(&line[start..open]));
            }
            pieces.push(Raw::Slot(name));
            (start, from) = (close + 1, close + 1);
        }
    }
    if start < line.len() {
        pieces.push(Raw::Text(&line[start..]));
    }
    pieces
}

/// Words with their values in them.
fn filled_in<'v>(words: &str, mut values: impl Iterator<Item = &'v str>) -> String {
    let mut pieces = words.split("{}");
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        text.push_str(values.next().unwrap_or_default());
        text.push_str(piece);
    }
    text
}

/// Whether a text has nothing to translate: numbers, units and symbols only.
pub fn is_plain(text: &str) -> bool {
    let name = |word: &str| word.contains(|c: char| c == '_' || c.is_ascii_digit());
    let words = text.split_whitespace().filter(|w| !name(w));
    words
        .flat_map(|word| word.split(|c: char| !c.is_alphabetic()))
        .all(|word| {
            let short = word.chars().count() < 2;
            let shouted = !word.chars().any(char::is_lowercase);
            short || shouted || SAME.contains(&word)
        })
}

#[cfg(test)]
mod tests {
    use hysteron_core::msg;

    use super::*;

    const TEXTS: &str = "# remark
friction
Reibung

load
Last

It drifts by {} because of {}.
Wegen {2} driftet sie um {1}.

{} s are enough for {}.
Für {2} genügen {1} s.

The file {*} is read.
Die Datei {*} wird gelesen.

e^{-0.5s} is a dead time
e^{-0.5s} ist eine Totzeit
";

    fn german(text: &str) -> Translated {
        Catalogue::read(&[TEXTS]).translate(text)
    }

    fn check(english: &str, expected: &str) {
        let found = german(english);
        assert_eq!((found.text.as_str(), found.complete), (expected, true));
    }

    #[test]
    fn texts_are_found_with_what_stands_in_them() {
        check("friction", "Reibung");
        check("0.5 rad/s", "0,5 rad/s");
        check("friction and 0.5 rad/s", "Reibung und 0,5 rad/s");
        check("friction and load", "Reibung und Last");
        check(
            "It drifts by 3 mm because of friction or load.",
            "Wegen Reibung oder Last driftet sie um 3 mm.",
        );
        check("The file load is read.", "Die Datei load wird gelesen.");
        check(
            "The file load is read. The file friction is read.",
            "Die Datei load wird gelesen. Die Datei friction wird gelesen.",
        );
        check(
            "The file a. b is read. It drifts by 1 because of load.",
            "Die Datei a. b wird gelesen. Wegen Last driftet sie um 1.",
        );
        check(
            "It drifts by 1 because of load. 0.5 s are enough for friction.",
            "Wegen Last driftet sie um 1. Für Reibung genügen 0,5 s.",
        );
        check("e^{-0.5s} is a dead time", "e^{-0.5s} ist eine Totzeit");
    }

    #[test]
    fn a_message_is_found_by_its_words_and_its_values_are_said_too() {
        let parts = Message::list(" or ", ["friction", "load"]);
        let drift = msg!(
            "It drifts by {} because of {}.",
            "0.5 rad".to_owned(),
            parts
        );
        let file = msg!("The file {} is read.", Message::name("load 0.5"));
        let said = Catalogue::read(&[TEXTS]).say(&drift.and(file));
        let german =
            "Wegen Reibung oder Last driftet sie um 0,5 rad. Die Datei load 0.5 wird gelesen.";
        assert_eq!((said.text.as_str(), said.complete), (german, true));
        let numbers = Message::list(", ", ["0.5".to_owned(), "2".to_owned()]);
        assert_eq!(Catalogue::read(&[TEXTS]).say(&numbers).text, "0,5; 2");
        // Its English as one text is not matched.
        let whole = Message::words("It drifts by 3 because of load.");
        let said = Catalogue::read(&[TEXTS]).say(&whole);
        assert_eq!(said.text, whole.to_string());
        assert!(!said.complete);
    }

    #[test]
    fn what_is_not_known_stays_and_is_told() {
        for unknown in ["something else", "friction and something"] {
            let found = german(unknown);
            assert_eq!((found.text.as_str(), found.complete), (unknown, false));
        }
        let part = german("It drifts by 1 because of something.");
        assert_eq!(part.text, "Wegen something driftet sie um 1.");
        assert!(!part.complete);
    }

    #[test]
    fn slots_must_agree() {
        let faulty = Catalogue::read(&["a {} b {}\nc {}\n\nx\ny\n\nx\nz\n"]);
        assert_eq!(faulty.faults(), ["other slots: a {} b {}", "twice: x"]);
    }
}
