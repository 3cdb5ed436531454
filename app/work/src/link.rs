//! Settings as a text that fits into a link, and back.
//!
//! ```text
//! v1;explore;loop.relay.gain=2;explore.margin=true
//! ```
//!
//! The version, the page, and every setting that differs from its default, by its path. A value is a number,
//! `true`, `false`, `null`, a list of numbers `1,3,3,1`, a word, or else JSON; characters that an address
//! does not take stand as `%XX`. What a reader does not know is refused, never guessed.

use hysteron_core::message::Message;
use hysteron_core::msg;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// The version that is written, and the only one that is read.
pub const VERSION: &str = "v1";

/// Length beyond which a text is refused unread, bytes: a mystery has half of it, everything else a tenth.
pub const LONGEST: usize = 32_768;

/// The text for `page` with `settings`; those that equal `defaults` are left out.
pub fn write(page: &str, settings: &Value, defaults: &Value) -> String {
    let mut text = format!("{VERSION};{page}");
    differences("", settings, defaults, &mut text);
    text
}

/// The page and the settings that a text stands for; what it does not name is as in `defaults`. The text may
/// be a whole address: what comes before `#` is left out.
///
/// # Errors
/// One sentence that says what cannot be read.
pub fn read(text: &str, defaults: &Value) -> Result<(String, Value), Message> {
    if text.len() > LONGEST {
        return Err(msg!(
            "This link is too long: it has {} characters, and at most {} are allowed.",
            text.len(),
            LONGEST
        ));
    }
    let text = text.trim();
    let text = text.split_once('#').map_or(text, |(_, fragment)| fragment);
    let mut parts = text.split(';');
    match parts.next() {
        Some(VERSION) => {}
        Some(other) if other.starts_with('v') && other.len() < 6 => {
            return Err(msg!(
                "This link is of version {}; this Hysteron reads {}.",
                Message::name(shortened(other)),
                VERSION
            ));
        }
        _ => {
            return Err(msg!(
                "This is not a link to Hysteron: it should begin with #{};.",
                VERSION
            ));
        }
    }
    let page = parts.next().unwrap_or_default().to_owned();
    let mut settings = defaults.clone();
    for part in parts.filter(|p| !p.is_empty()) {
        let Some((path, value)) = part.split_once('=') else {
            return Err(msg!(
                "This link has a setting without a value: {}.",
                Message::name(shortened(part))
            ));
        };
        let place = path
            .split('.')
            .try_fold(&mut settings, |at, key| at.as_object_mut()?.get_mut(key));
        let Some(place) = place else {
            return Err(msg!(
                "This link sets something that Hysteron does not know: {}.",
                Message::name(shortened(path))
            ));
        };
        *place = decode(value).ok_or_else(|| {
            msg!(
                "This link has a bad value: {}.",
                Message::name(shortened(part))
            )
        })?;
    }
    Ok((page, settings))
}

/// Whether all settings have the shape of the usual ones.
///
/// # Errors
/// One sentence that names the one that has not, as it stands in a link.
pub fn check_shape(settings: &Value, usual: &Value) -> Result<(), Message> {
    match misfit("", settings, usual) {
        Some(part) => Err(msg!(
            "This link has a bad value: {}.",
            Message::name(shortened(&part))
        )),
        None => Ok(()),
    }
}

/// The first value that cannot stand in its place, with its path.
fn misfit(path: &str, value: &Value, usual: &Value) -> Option<String> {
    if let (Value::Object(values), Value::Object(usual)) = (value, usual) {
        return usual.iter().find_map(|(key, usual)| {
            let dot = if path.is_empty() { "" } else { "." };
            misfit(&format!("{path}{dot}{key}"), values.get(key)?, usual)
        });
    }
    let part = || format!("{path}={}", encode(value));
    (!is_alike(value, usual)).then(part)
}

/// Whether a value can stand in the place of another: a list for a list, a number for a number. Nothing stands for
/// anything, and what is chosen by a word may have another shape.
fn is_alike(value: &Value, usual: &Value) -> bool {
    match usual {
        Value::Array(_) => value.is_array() || value.is_null(),
        Value::Number(_) => value.is_number() || value.is_null(),
        Value::Bool(_) => value.is_boolean() || value.is_null(),
        _ => true,
    }
}

/// Writes what differs: within objects that have the same keys by key, else as a whole.
fn differences(path: &str, value: &Value, default: &Value, text: &mut String) {
    if value == default {
        return;
    }
    if let (Value::Object(new), Value::Object(old)) = (value, default)
        && !new.is_empty()
        && new.len() == old.len()
        && new.keys().all(|k| old.contains_key(k) && is_word(k))
    {
        for (key, value) in new {
            let dot = if path.is_empty() { "" } else { "." };
            if let Some(default) = old.get(key) {
                differences(&format!("{path}{dot}{key}"), value, default, text);
            }
        }
        return;
    }
    text.push(';');
    text.push_str(path);
    text.push('=');
    text.push_str(&escape(&encode(value)));
}

/// Whether a key can stand in a path.
fn is_word(key: &str) -> bool {
    !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
}

fn encode(value: &Value) -> String {
    match value {
        Value::Number(number) => number_text(number),
        Value::String(word) if plain(word) == Value::String(word.clone()) => word.clone(),
        Value::Array(list) if list.len() > 1 && list.iter().all(Value::is_number) => list
            .iter()
            .filter_map(|v| match v {
                Value::Number(number) => Some(number_text(number)),
                _ => None,
            })
            .collect::<Vec<_>>()
            .join(","),
        other => other.to_string(),
    }
}

/// The shorter of both ways to write a number.
fn number_text(number: &serde_json::Number) -> String {
    match number.as_f64() {
        Some(value) if number.is_f64() => {
            let (fixed, scientific) = (value.to_string(), format!("{value:e}"));
            if scientific.len() < fixed.len() {
                scientific
            } else {
                fixed
            }
        }
        _ => number.to_string(),
    }
}

/// The value that stands behind `=`; `None` where its `%XX` are no text or it is a number beyond all bounds.
fn decode(text: &str) -> Option<Value> {
    Some(plain(&unescape(text)?))
}

/// The value of an unescaped text: what is nothing else is a word.
fn plain(text: &str) -> Value {
    if let Some(number) = number(text) {
        return number;
    }
    if let Ok(value) = serde_json::from_str(text) {
        return value;
    }
    if text.contains(',') {
        let list: Option<Vec<Value>> = text.split(',').map(number).collect();
        if let Some(list) = list {
            return Value::Array(list);
        }
    }
    Value::String(text.to_owned())
}

fn number(text: &str) -> Option<Value> {
    // Rust also reads "inf", "NaN", "+1" and ".5"; a number here begins with a digit or a minus.
    let begins = text.strip_prefix('-').unwrap_or(text);
    if !begins.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    if text != "-0"
        && let Ok(whole) = text.parse::<i64>()
    {
        return Some(whole.into());
    }
    if let Ok(whole) = text.parse::<u64>() {
        return Some(whole.into());
    }
    let value = text.parse::<f64>().ok()?;
    serde_json::Number::from_f64(value).map(Value::Number)
}

/// Characters that the part of an address behind `#` takes, and that mean nothing here.
fn is_safe(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || b"-._~,+/:@".contains(&byte)
}

fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for byte in text.bytes() {
        if is_safe(byte) {
            escaped.push(char::from(byte));
        } else {
            escaped.push('%');
            for digit in [byte >> 4, byte & 15] {
                let digit = char::from_digit(u32::from(digit), 16).unwrap_or('0');
                escaped.push(digit.to_ascii_uppercase());
            }
        }
    }
    escaped
}

fn unescape(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let digit = |b: u8| char::from(b).to_digit(16);
            let (high, low) = (digit(rest.next()?)?, digit(rest.next()?)?);
            bytes.push((16 * high + low) as u8);
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

/// As much of a strange text as a sentence can carry.
pub fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let text: String = text
        .chars()
        .map(|c| if c.is_ascii_graphic() { c } else { '?' })
        .collect();
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text,
    }
}

/// An object of settings from its parts.
pub fn object(parts: impl IntoIterator<Item = (String, Value)>) -> Value {
    Value::Object(parts.into_iter().collect::<Map<_, _>>())
}

/// Settings of a page from their plain value.
///
/// # Errors
/// One sentence.
pub fn parsed<T: DeserializeOwned>(value: &Value) -> Result<T, Message> {
    // What serde says is about Rust, and in English.
    T::deserialize(value).map_err(|_| "These settings cannot be read.".into())
}

/// Why a link cannot show what is about a file of the user's.
pub fn not_enclosed(name: &str) -> Message {
    let name: String = name.chars().filter(|c| !c.is_control()).take(60).collect();
    msg!(
        "This link needs the file {}, which is not part of it: open that file here.",
        Message::name(name)
    )
}
