//! Numbers and times in the lines of a log.

/// The number that follows `key`, which must not be the end of a longer word; blanks and units may surround it.
pub(super) fn after(line: &str, key: &str) -> Option<f64> {
    line.match_indices(key)
        .filter(|(at, _)| !line[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
        .find_map(|(at, _)| leading(&line[at + key.len()..]))
}

/// The number at the start of a text.
pub(super) fn leading(text: &str) -> Option<f64> {
    let text = text.trim_start();
    let end = text
        .char_indices()
        .find(|(i, c)| !(c.is_ascii_digit() || *c == '.' || (*i == 0 && (*c == '-' || *c == '+'))))
        .map_or(text.len(), |(i, _)| i);
    text[..end].parse().ok().filter(|v: &f64| v.is_finite())
}

/// Time of a line in s, by the first `hh:mm:ss` in it, with a fraction after `.` or `,` and a date before it where
/// there is one. Only differences mean something.
pub(super) fn time(line: &str) -> Option<f64> {
    let at = line.as_bytes().windows(8).position(|w| {
        let digit = |i: usize| w[i].is_ascii_digit();
        w[2] == b':' && w[5] == b':' && [0, 1, 3, 4, 6, 7].into_iter().all(digit)
    })?;
    let clock = line.get(at..at + 8)?;
    let part = |range: std::ops::Range<usize>| clock.get(range)?.parse::<f64>().ok();
    let mut seconds = 3600.0 * part(0..2)? + 60.0 * part(3..5)? + part(6..8)?;
    let rest = line.get(at + 8..).unwrap_or_default();
    if let Some(digits) = rest.strip_prefix(['.', ',']) {
        let digits: String = digits
            .chars()
            .take_while(char::is_ascii_digit)
            .take(9)
            .collect();
        seconds += format!("0.{digits}").parse::<f64>().unwrap_or(0.0);
    }
    Some(seconds + 86_400.0 * line.get(..at).and_then(day).unwrap_or(0.0))
}

/// Days of the date `yyyy-mm-dd` before a clock time, by the civil calendar.
fn day(text: &str) -> Option<f64> {
    let date = text.trim_end_matches([' ', 'T']);
    let date = date.get(date.len().checked_sub(10)?..)?;
    let mut parts = date.split('-').map(|p| p.parse::<i64>().ok());
    let (year, month, day) = (parts.next()??, parts.next()??, parts.next()??);
    if parts.next().is_some()
        || !(1..=12).contains(&month)
        || !(1..=31).contains(&day)
        || !(0..=9999).contains(&year)
    {
        return None;
    }
    // Years from March, so that the leap day is the last.
    let (y, m) = if month > 2 {
        (year, month - 3)
    } else {
        (year - 1, month + 9)
    };
    Some((365 * y + y / 4 - y / 100 + y / 400 + (153 * m + 2) / 5 + day) as f64)
}

/// Times that go on past midnight where lines have no date.
pub(super) fn unwrapped(times: &mut [f64]) {
    let mut days = 0.0;
    for i in 1..times.len() {
        times[i] += days;
        if times[i] < times[i - 1] - 43_200.0 {
            days += 86_400.0;
            times[i] += 86_400.0;
        }
    }
}
