//! JSON: lines of objects, an array of objects, or an object of arrays, nested as they like.

use std::fmt::{self, Write as _};

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::error::Problem;
use super::header::shorten;
use super::series::{Builder, Series};
use super::text::{Located, decoded};

/// The series of a file, each by the names on the way to it: `log.u`; `None` where the file does not begin as JSON
/// does.
pub(super) fn read(bytes: &[u8]) -> Result<Option<Vec<Series>>, Located> {
    let begin = bytes.trim_ascii_start();
    let begin = begin.strip_prefix(b"\xef\xbb\xbf").unwrap_or(begin);
    let is_json = match begin.trim_ascii_start() {
        [b'{', ..] => true,
        // A word in brackets is the name of a part of a log.
        [b'[', inside @ ..] => !inside
            .trim_ascii_start()
            .first()
            .is_some_and(u8::is_ascii_alphabetic),
        _ => false,
    };
    if !is_json {
        return Ok(None);
    }
    let text = decoded(bytes)?.trim_start();
    let wrong = |e: serde_json::Error| {
        let what = e.to_string();
        let what = what.split(" at line").next().unwrap_or_default();
        (
            Some(e.line()),
            Problem::Json {
                what: shorten(what),
            },
        )
    };
    // More than one value is a file of lines.
    let mut values = serde_json::Deserializer::from_str(text).into_iter::<IgnoredAny>();
    let lines = values.next().is_some() && values.next().is_some();
    let mut found = Walk {
        builder: Builder::new(bytes.len()),
        path: String::new(),
    };
    let mut values = serde_json::Deserializer::from_str(text);
    let mut record = 0;
    while values.end().is_err() {
        let place = Place {
            walk: &mut found,
            row: lines.then_some(record),
        };
        place.deserialize(&mut values).map_err(wrong)?;
        record += 1;
    }
    Ok(Some(found.builder.finish()))
}

/// What was found on the way through a file.
struct Walk {
    builder: Builder,
    /// Names on the way to where we are.
    path: String,
}

/// A place in the file: what stands there goes to the series of its path, and to this row of it, if the rows have
/// begun.
struct Place<'a> {
    walk: &'a mut Walk,
    row: Option<usize>,
}

impl Place<'_> {
    fn put(self, value: f64) {
        self.walk
            .builder
            .number(&self.walk.path, self.row.unwrap_or_default(), value);
    }
}

impl<'de> DeserializeSeed<'de> for Place<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Place<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("numbers, in arrays or objects")
    }

    fn visit_bool<E>(self, value: bool) -> Result<(), E> {
        self.put(f64::from(u8::from(value)));
        Ok(())
    }

    fn visit_i64<E>(self, value: i64) -> Result<(), E> {
        self.put(value as f64);
        Ok(())
    }

    fn visit_u64<E>(self, value: u64) -> Result<(), E> {
        self.put(value as f64);
        Ok(())
    }

    fn visit_f64<E>(self, value: f64) -> Result<(), E> {
        self.put(value);
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        self.put(f64::NAN);
        Ok(())
    }

    fn visit_str<E>(self, text: &str) -> Result<(), E> {
        self.walk
            .builder
            .text(&self.walk.path, self.row.unwrap_or_default(), text);
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let length = self.walk.path.len();
        while let Some(name) = map.next_key::<String>()? {
            if length > 0 {
                self.walk.path.push('.');
            }
            self.walk.path.push_str(&name);
            let place = Place {
                walk: &mut *self.walk,
                row: self.row,
            };
            map.next_value_seed(place)?;
            self.walk.path.truncate(length);
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<(), A::Error> {
        let length = self.walk.path.len();
        for i in 0.. {
            // The first array on the way has the rows; one within it has columns.
            if self.row.is_some() {
                // Writing into a string cannot fail.
                let _ = write!(self.walk.path, "({})", i + 1);
            }
            let place = Place {
                walk: &mut *self.walk,
                row: self.row.or(Some(i)),
            };
            let more = elements.next_element_seed(place)?.is_some();
            self.walk.path.truncate(length);
            if !more {
                break;
            }
        }
        Ok(())
    }
}
