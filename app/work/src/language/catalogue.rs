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
//! Two lines each, English first, an empty line between them; the English is looked up as it is. `{}` stands for a
//! value that is said in the language too: a number gets a decimal comma. `{*}` stands for what stays as it is: a name
//! that the user has given. The translation has the same number of them; `{1}`, `{2}` say which, where their order
//! is another. `\n` is a new line.

use std::collections::HashMap;

use hysteron_core::message::Message;

use super::number::with_comma;
use super::plain::is_plain;

/// A text in another language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Translated {
    /// As far as it is translated.
    pub text: String,
    /// Whether all of it is.
    pub complete: bool,
}

/// A piece of a translation.
#[derive(Debug)]
enum Piece {
    Text(String),
    /// The place of a value.
    Slot(usize),
}

/// A translation.
#[derive(Debug)]
struct Filled {
    pieces: Vec<Piece>,
    /// Whether a value stays as it is.
    verbatim: Vec<bool>,
}

/// All texts of a language.
#[derive(Debug, Default)]
pub struct Catalogue {
    /// By their English, with `{}` for every slot.
    texts: HashMap<String, Filled>,
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
    }

    fn add(&mut self, english: &str, translation: &str) {
        let [english, translation] = [english, translation].map(|t| t.replace("\\n", "\n"));
        let mut key = String::new();
        let mut verbatim = Vec::new();
        for piece in pieces(&english) {
            match piece {
                Raw::Text(text) => key.push_str(text),
                Raw::Slot(name) => {
                    key.push_str("{}");
                    verbatim.push(name == "*");
                }
            }
        }
        let mut used = Vec::new();
        let pieces = pieces(&translation).into_iter().map(|piece| match piece {
            Raw::Text(text) => Piece::Text(text.to_owned()),
            Raw::Slot(name) => {
                let next = used.len() + 1;
                used.push(name.parse().unwrap_or(next) - 1);
                Piece::Slot(used[next - 1])
            }
        });
        let pieces = pieces.collect();
        used.sort_unstable();
        if used != (0..verbatim.len()).collect::<Vec<_>>() {
            self.faults.push(format!("other slots: {english}"));
        } else if self
            .texts
            .insert(key, Filled { pieces, verbatim })
            .is_some()
        {
            self.faults.push(format!("twice: {english}"));
        }
    }

    /// What is wrong with the texts; nothing, if the tests have passed.
    pub fn faults(&self) -> &[String] {
        &self.faults
    }

    /// The English texts with `{}` in place of the slots.
    pub fn english(&self) -> impl Iterator<Item = String> {
        self.texts.keys().cloned()
    }

    /// A message in this language: its English is the key of its words. What has no translation stays.
    pub fn say(&self, message: &Message) -> Translated {
        let known = |text| Translated {
            text,
            complete: true,
        };
        match message {
            Message::Words(words, values) => self.words(words, values),
            Message::Number(number) => known(with_comma(number)),
            Message::Name(name) => known(name.clone()),
            Message::List(joint, items) => self.list(joint, items),
        }
    }

    fn words(&self, words: &str, values: &[Message]) -> Translated {
        let said: Vec<Translated> = values.iter().map(|value| self.say(value)).collect();
        let texts = || said.iter().map(|value| value.text.as_str());
        let Some(Filled { pieces, verbatim }) = self.texts.get(words) else {
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
        let word = joint.trim();
        let number = |item: &Message| matches!(item, Message::Number(_));
        if word == "," && items.iter().all(number) {
            // Numbers that have commas are listed with semicolons.
            let items: Vec<String> = items.iter().map(Message::to_string).collect();
            return Translated {
                text: with_comma(&items.join(joint)),
                complete: true,
            };
        }
        let items: Vec<Translated> = items.iter().map(|item| self.say(item)).collect();
        let texts: Vec<&str> = items.iter().map(|item| item.text.as_str()).collect();
        let complete = items.iter().all(|item| item.complete);
        let text = if word.contains(char::is_alphabetic) {
            texts.join(&format!(" {} ", self.words(word, &[]).text))
        } else {
            texts.join(joint)
        };
        Translated { text, complete }
    }
}

/// A piece of a line.
enum Raw<'a> {
    Text(&'a str),
    /// What stands in the braces.
    Slot(&'a str),
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

#[cfg(test)]
mod tests {
    use hysteron_core::message::fixed;
    use hysteron_core::msg;

    use super::*;

    const TEXTS: &str = "# remark
friction
Reibung

load
Last

or
oder

It drifts by {} because of {}.
Wegen {2} driftet sie um {1}.

The file {*} is read.
Die Datei {*} wird gelesen.

e^{-0.5s} is a dead time
e^{-0.5s} ist eine Totzeit
";

    fn german(message: impl Into<Message>) -> Translated {
        Catalogue::read(&[TEXTS]).say(&message.into())
    }

    fn check(message: impl Into<Message>, expected: &str) {
        let said = german(message);
        assert_eq!((said.text.as_str(), said.complete), (expected, true));
    }

    #[test]
    fn a_message_is_found_by_its_words_and_its_values_are_said_too() {
        check("friction", "Reibung");
        check("0.5 rad/s".to_owned(), "0,5 rad/s");
        check("e^{-0.5s} is a dead time", "e^{-0.5s} ist eine Totzeit");
        let parts = Message::list(" or ", ["friction", "load"]);
        let drift = msg!(
            "It drifts by {} because of {}.",
            "0.5 rad".to_owned(),
            parts
        );
        let file = msg!("The file {} is read.", Message::name("load 0.5"));
        check(
            drift.and(file),
            "Wegen Reibung oder Last driftet sie um 0,5 rad. Die Datei load 0.5 wird gelesen.",
        );
        check(msg!("{}: {}", "load", fixed(0.5, 1)), "Last: 0,5");
        let numbers = || ["0.5".to_owned(), "2".to_owned()];
        check(Message::list(", ", numbers()), "0,5; 2");
        check(Message::list(" or ", numbers()), "0,5 oder 2");
    }

    #[test]
    fn what_is_not_known_stays_and_is_told() {
        let english = [
            Message::words("something else"),
            // As one text it is no key.
            Message::words("It drifts by 3 because of load."),
            msg!("The file {} is gone.", Message::name("a")),
        ];
        for unknown in english {
            let said = german(&unknown);
            assert_eq!((said.text, said.complete), (unknown.to_string(), false));
        }
        let part = german(msg!("It drifts by {} because of {}.", 1, "something"));
        assert_eq!(part.text, "Wegen something driftet sie um 1.");
        assert!(!part.complete);
    }

    #[test]
    fn slots_must_agree() {
        let faulty = Catalogue::read(&["a {} b {}\nc {}\n\nx\ny\n\nx\nz\n"]);
        assert_eq!(faulty.faults(), ["other slots: a {} b {}", "twice: x"]);
    }
}
