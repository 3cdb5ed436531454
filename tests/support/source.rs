//! Texts in the source: string literals, as a reader of Rust finds them.

use std::path::{Path, PathBuf};

/// Rust files below a folder of the repository.
pub fn files(folder: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(folder);
    let mut found = Vec::new();
    let mut open = vec![root];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The literals of a file but for its unit tests, with `{}` for whatever is put into them.
pub fn literals(source: &str) -> Vec<String> {
    let source = source
        .split("#[cfg(test)]\nmod tests")
        .next()
        .unwrap_or_default();
    let mut found = Vec::new();
    let mut rest = source.chars().peekable();
    let mut before = ' ';
    while let Some(c) = rest.next() {
        match c {
            '/' if rest.peek() == Some(&'/') => while rest.next_if(|c| *c != '\n').is_some() {},
            // A character, not a lifetime: its quote ends after one, or after an escape.
            '\'' => {
                let ahead: Vec<char> = rest.clone().take(2).collect();
                if ahead.first() == Some(&'\\') {
                    rest.nth(1);
                    while rest.next_if(|c| *c != '\'').is_some() {}
                    rest.next();
                } else if ahead.get(1) == Some(&'\'') {
                    rest.nth(1);
                }
            }
            '"' => {
                assert!(before != '#', "a raw string with marks: teach it here");
                found.push(without_values(&literal(&mut rest)));
            }
            _ => {}
        }
        before = c;
    }
    found
}

/// The rest of a literal, its escapes resolved.
fn literal(rest: &mut std::iter::Peekable<std::str::Chars<'_>>) -> String {
    let mut text = String::new();
    while let Some(c) = rest.next() {
        match c {
            '"' => break,
            '\\' => match rest.next() {
                Some('n') => text.push('\n'),
                // A line that goes on below.
                Some('\n') => while rest.next_if(|c| c.is_whitespace()).is_some() {},
                Some(other) => text.push(other),
                None => {}
            },
            c => text.push(c),
        }
    }
    text
}

/// `{name:.3}` becomes `{}`, `{{` becomes `{`; `{-0.5s}` stays.
fn without_values(text: &str) -> String {
    let text = text.replace("{{", "\u{1}").replace("}}", "\u{2}");
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(open) = rest.find('{') {
        out.push_str(&rest[..open]);
        let close = rest[open..].find('}').map_or(rest.len(), |i| open + i + 1);
        let inner = rest[open..close].trim_matches(['{', '}']);
        let name = inner.split(':').next().unwrap_or_default();
        if name
            .chars()
            .all(|c| c.is_alphanumeric() || "_.*".contains(c))
        {
            out.push_str("{}");
        } else {
            out.push_str(&rest[open..close]);
        }
        rest = &rest[close..];
    }
    out.push_str(rest);
    out.replace('\u{1}', "{").replace('\u{2}', "}")
}
