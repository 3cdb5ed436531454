//! A header and a row in their parts.

/// Stands for any number of blanks and tabs.
pub(super) const BLANKS: char = ' ';

/// Splits a header; a separator inside brackets belongs to the unit (`[counts, 4096/rev]`), one inside quotes around a
/// name to that.
pub(super) fn split_header(header: &str, separator: char) -> Vec<String> {
    split_names(header, separator)
        .unwrap_or_else(|| split_names(&header.replace('"', ""), separator).unwrap_or_default())
}

/// [`split_header`] where quotes come in pairs.
fn split_names(header: &str, separator: char) -> Option<Vec<String>> {
    let mut fields = vec![String::new()];
    let mut depth = 0;
    let mut quoted = false;
    let blanks = separator == BLANKS;
    for c in header
        .trim_matches(|c: char| blanks && c.is_whitespace())
        .chars()
    {
        match c {
            '[' | '(' => depth += 1,
            ']' | ')' => depth -= 1,
            '"' => {
                let begins = || fields.last().is_some_and(|f| f.trim().is_empty());
                quoted = !quoted && (blanks || begins());
            }
            _ => {}
        }
        let parts = c == separator || (blanks && c.is_whitespace());
        if depth <= 0 && !quoted && parts {
            fields.push(String::new());
        } else if c != '"'
            && !c.is_control()
            && let Some(last) = fields.last_mut()
        {
            last.push(c);
        }
    }
    if quoted {
        return None;
    }
    if blanks {
        return Some(join_units(fields));
    }
    // A separator at the end of the line is a habit of some loggers.
    if fields.len() > 1 && fields.last().is_some_and(|f| f.trim().is_empty()) {
        fields.pop();
    }
    Some(fields.iter().map(|f| f.trim().to_owned()).collect())
}

/// Puts units that stand apart by blanks (`t [s]`) to their names, and leaves out what stands between blanks alone.
fn join_units(parts: Vec<String>) -> Vec<String> {
    let mut fields: Vec<String> = Vec::new();
    for part in parts.into_iter().filter(|p| !p.is_empty()) {
        match fields.last_mut() {
            Some(name) if part.starts_with(['[', '(']) => *name = format!("{name} {part}"),
            _ => fields.push(part),
        }
    }
    fields
}

/// Splits a row of numbers; a separator inside quotes belongs to the field.
pub(super) fn split_row<'a>(row: &'a str, separator: char, fields: &mut Vec<&'a str>) {
    fields.clear();
    if separator == BLANKS {
        fields.extend(row.split_whitespace().map(|f| f.trim_matches('"')));
        return;
    }
    if !row.contains('"') {
        fields.extend(row.split(separator).map(str::trim));
        return;
    }
    let mut quoted = false;
    let pieces = row.split(|c| {
        quoted ^= c == '"';
        c == separator && !quoted
    });
    fields.extend(pieces.map(|f| f.trim().trim_matches('"').trim()));
}
