//! What is said, as a value: words with their numbers, before they are put into a language.
//!
//! The English of a text is the key under which other languages have it, so that it stands beside its numbers:
//! `msg!("The error is {} times the noise.", fixed(error, 2))`. [`Message`] prints as that English.

use std::borrow::Cow;
use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Something said.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Message {
    /// Words in English, with `{}` where the values stand in their order.
    Words(Cow<'static, str>, Vec<Message>),
    /// Numbers, already rounded, and their units.
    Number(String),
    /// What someone has named so: it is the same in every language.
    Name(String),
    /// Several, with what stands between them.
    List(Cow<'static, str>, Vec<Message>),
}

/// A [`Message`] of words and of the values in their `{}`, as many as there are.
#[macro_export]
macro_rules! msg {
    ($words:expr $(, $value:expr)* $(,)?) => {
        $crate::message::Message::Words(
            const {
                assert!($crate::message::slots($words) == [$(stringify!($value)),*].len());
                $words
            }
            .into(),
            vec![$($value.into()),*],
        )
    };
}

/// A number with this many decimals; one that rounds to 0 is not below it.
pub fn fixed(value: f64, decimals: usize) -> Message {
    let text = format!("{value:.decimals$}");
    let size = text.trim_start_matches('-');
    if is_zero(size) {
        return Message::Number(size.to_owned());
    }
    Message::Number(text)
}

/// The same with its sign, also where that is a plus.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if is_zero(size) => format!("+{size}"),
        _ => text,
    }
}

/// Whether digits are all 0.
fn is_zero(digits: &str) -> bool {
    digits.chars().all(|c| c == '0' || c == '.')
}

/// The `{}` in a text.
pub const fn slots(words: &str) -> usize {
    let (mut rest, mut count) = (words.as_bytes(), 0);
    while let [first, tail @ ..] = rest {
        if let (b'{', [b'}', ..]) = (*first, tail) {
            count += 1;
        }
        rest = tail;
    }
    count
}

impl Message {
    /// What someone has named so.
    pub fn name(name: impl Into<String>) -> Self {
        Self::Name(name.into())
    }

    /// Words that are known by name at run time only, such as that of an axis.
    pub fn words(words: impl Into<Cow<'static, str>>) -> Self {
        Self::Words(words.into(), Vec::new())
    }

    /// Several with `joint` between them, such as ` and `.
    pub fn list<M: Into<Self>>(joint: &'static str, items: impl IntoIterator<Item = M>) -> Self {
        Self::List(joint.into(), items.into_iter().map(Into::into).collect())
    }

    /// Nothing is said.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Words(text, _) => text.is_empty(),
            Self::Number(text) | Self::Name(text) => text.is_empty(),
            Self::List(_, items) => items.iter().all(Self::is_empty),
        }
    }

    /// Says one sentence more.
    pub fn add(&mut self, sentence: impl Into<Self>) {
        let sentence = sentence.into();
        match self {
            _ if sentence.is_empty() => {}
            _ if self.is_empty() => *self = sentence,
            Self::List(joint, items) if joint == " " => items.push(sentence),
            _ => *self = Self::list(" ", [std::mem::take(self), sentence]),
        }
    }

    /// Says something else in the place of the last sentence.
    pub fn restate(&mut self, sentence: impl Into<Self>) {
        match self {
            Self::List(joint, items) if joint == " " => drop(items.pop()),
            _ => *self = Self::default(),
        }
        self.add(sentence);
    }

    /// The same with one sentence more.
    #[must_use]
    pub fn and(mut self, sentence: impl Into<Self>) -> Self {
        self.add(sentence);
        self
    }
}

impl Default for Message {
    fn default() -> Self {
        Self::List(" ".into(), Vec::new())
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Words(words, values) => {
                let mut values = values.iter();
                words.split("{}").enumerate().try_for_each(|(i, text)| {
                    let value = if i > 0 { values.next() } else { None };
                    value.map_or(Ok(()), |v| v.fmt(f))?;
                    f.write_str(text)
                })
            }
            Self::Number(text) | Self::Name(text) => f.write_str(text),
            Self::List(joint, items) => items.iter().enumerate().try_for_each(|(i, item)| {
                f.write_str(if i > 0 { joint } else { "" })?;
                item.fmt(f)
            }),
        }
    }
}

impl std::error::Error for Message {}

/// Whether its English is this.
impl PartialEq<&str> for Message {
    fn eq(&self, english: &&str) -> bool {
        let mut left = Left(english);
        fmt::write(&mut left, format_args!("{self}")).is_ok() && left.0.is_empty()
    }
}

/// What is left of a text of which the beginning has been said.
struct Left<'a>(&'a str);

impl fmt::Write for Left<'_> {
    fn write_str(&mut self, said: &str) -> fmt::Result {
        self.0 = self.0.strip_prefix(said).ok_or(fmt::Error)?;
        Ok(())
    }
}

impl From<&'static str> for Message {
    fn from(words: &'static str) -> Self {
        Self::words(words)
    }
}

impl From<&&'static str> for Message {
    fn from(words: &&'static str) -> Self {
        (*words).into()
    }
}

/// Numbers with their units.
impl From<String> for Message {
    fn from(numbers: String) -> Self {
        Self::Number(numbers)
    }
}

impl From<&String> for Message {
    fn from(numbers: &String) -> Self {
        Self::Number(numbers.clone())
    }
}

impl From<&Self> for Message {
    fn from(message: &Self) -> Self {
        message.clone()
    }
}

macro_rules! from_numbers {
    ($($number:ty)*) => {$(
        impl From<$number> for Message {
            fn from(number: $number) -> Self {
                Self::Number(number.to_string())
            }
        }

        impl From<&$number> for Message {
            fn from(number: &$number) -> Self {
                Self::Number(number.to_string())
            }
        }
    )*};
}
from_numbers!(f64 usize i32 u8 u16 u32 u64);

/// An error that says what is wrong as a message, and prints as its English.
macro_rules! says {
    ($($error:ty)*) => {$(
        impl std::fmt::Display for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.message().fmt(f)
            }
        }

        impl From<$error> for $crate::message::Message {
            fn from(error: $error) -> Self {
                error.message()
            }
        }

        impl From<&$error> for $crate::message::Message {
            fn from(error: &$error) -> Self {
                error.message()
            }
        }
    )*};
}
pub(crate) use says;

/// What a message is for programs on the same machine; for people and in files it is its English.
#[derive(Serialize, Deserialize)]
enum Packed<'a> {
    Words(Cow<'a, str>, Cow<'a, [Message]>),
    Number(Cow<'a, str>),
    Name(Cow<'a, str>),
    List(Cow<'a, str>, Cow<'a, [Message]>),
}

impl Serialize for Message {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if serializer.is_human_readable() {
            return serializer.collect_str(self);
        }
        let packed = match self {
            Self::Words(words, values) => Packed::Words(words.as_ref().into(), values.into()),
            Self::Number(text) => Packed::Number(text.into()),
            Self::Name(text) => Packed::Name(text.into()),
            Self::List(joint, items) => Packed::List(joint.as_ref().into(), items.into()),
        };
        packed.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Message {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            return String::deserialize(deserializer).map(Self::words);
        }
        Ok(match Packed::deserialize(deserializer)? {
            Packed::Words(words, values) => {
                Self::Words(words.into_owned().into(), values.into_owned())
            }
            Packed::Number(text) => Self::Number(text.into_owned()),
            Packed::Name(text) => Self::Name(text.into_owned()),
            Packed::List(joint, items) => Self::List(joint.into_owned().into(), items.into_owned()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Message {
        let friction = msg!("Coulomb friction, {}", Message::name("own {}"));
        let list = Message::list(" and ", [friction, "load".into()]);
        msg!("Missing: {}.", list).and(msg!("With {} left, {} samples.", fixed(1.25, 1), 3_usize))
    }

    #[test]
    fn what_rounds_to_zero_is_not_below_it() {
        for (value, plain, with_sign) in [
            (-0.04, "0.0", "+0.0"),
            (0.04, "0.0", "+0.0"),
            (-0.06, "-0.1", "-0.1"),
            (20.0, "20.0", "+20.0"),
            (-20.0, "-20.0", "-20.0"),
        ] {
            assert_eq!(fixed(value, 1).to_string(), plain);
            assert_eq!(signed(value, 1), with_sign);
        }
    }

    #[test]
    fn it_prints_as_its_english() {
        let english = "Missing: Coulomb friction, own {} and load. With 1.2 left, 3 samples.";
        assert_eq!(example().to_string(), english);
        let mut text = Message::default();
        assert!(text.is_empty());
        text.add(String::new());
        text.add("First.");
        text.add("Second.");
        text.add("Third.");
        assert_eq!(text, "First. Second. Third.");
        assert!(text != "First. Second." && text != "First. Second. Third. Fourth.");
        text.restate("Last.");
        assert_eq!(text.to_string(), "First. Second. Last.");
    }

    #[test]
    fn it_is_english_in_json_and_whole_in_a_packet() {
        let json = serde_json::to_value(example()).unwrap();
        assert_eq!(json, serde_json::json!(example().to_string()));
        let mut bytes = Vec::new();
        ciborium::into_writer(&example(), &mut bytes).unwrap();
        let back: Message = ciborium::from_reader(bytes.as_slice()).unwrap();
        assert_eq!(back, example());
    }

    #[test]
    fn slots_are_counted() {
        for (words, count) in [("", 0), ("{}", 1), ("a {} {} {x} }{", 2), ("{", 0)] {
            assert_eq!(slots(words), count, "{words}");
        }
    }
}
