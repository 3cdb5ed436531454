//! Times of day and of the calendar, as seconds from the first of them.

/// Days from 0000-03-01 to 1970-01-01.
const DAYS_TO_1970: i64 = 719_468;

const SECONDS_OF_DAY: i64 = 86_400;

/// From 2001-09-09, when a clock that counts seconds from 1970 got its tenth digit, to 2100: what counts from 1970 lies
/// between these, s.
const COUNTED_FROM_1970: std::ops::Range<f64> = 1e9..4.1e9;

/// Units in which clocks count from 1970, and how many of them are a second.
const UNITS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)];

/// The unit in which a clock counts from 1970 that shows this number.
pub(super) fn unit_from_1970(number: f64) -> Option<&'static str> {
    let counts = |(_, a_second): &&(&str, f64)| COUNTED_FROM_1970.contains(&(number / a_second));
    UNITS.iter().find(counts).map(|(unit, _)| *unit)
}

/// What the times of a column are counted from.
#[derive(Clone, Debug, Default)]
pub(super) struct Clock {
    /// The first date, seconds from 1970 and what is beyond the whole ones; of a time of day from the begin of the day.
    begin: Option<(i64, f64)>,
    /// The last time of day, s, and the days that have gone by since the first.
    day: Option<(f64, i64)>,
    /// What a clock that counts from 1970 showed first, in its own unit.
    counts_from: Option<(i128, f64)>,
}

impl Clock {
    /// A clock that counts from 1970, and begins with this number, so that no digit is lost.
    pub fn from_1970(first: &str) -> Option<Self> {
        let counts_from = Some(parts(first)?);
        Some(Self {
            counts_from,
            ..Self::default()
        })
    }

    /// Whether dates or times of day were read by it.
    pub fn has_dates(&self) -> bool {
        self.begin.is_some()
    }

    /// What the clock shows that counts from 1970, from its first number.
    pub fn counted(&self, text: &str) -> Option<f64> {
        let (from, beyond) = self.counts_from?;
        let (whole, fraction) = parts(text)?;
        Some(whole.checked_sub(from)? as f64 + (fraction - beyond))
    }

    /// Seconds from the first date, or time of day, to this one.
    pub fn date(&mut self, text: &str) -> Option<f64> {
        let stamp = Stamp::read(text)?;
        let days = match (stamp.day, self.day) {
            (Some(day), _) => day,
            // Midnight has passed where the time of day falls.
            (None, Some((before, days))) => days + i64::from(stamp.seconds < before),
            (None, None) => 0,
        };
        if stamp.day.is_none() {
            self.day = Some((stamp.seconds, days));
        }
        let whole = stamp.seconds as i64;
        let seconds = days * SECONDS_OF_DAY + whole - stamp.east;
        let fraction = stamp.seconds - whole as f64;
        let (begin, beyond) = *self.begin.get_or_insert((seconds, fraction));
        Some((seconds - begin) as f64 + (fraction - beyond))
    }
}

/// The whole part of a number, and the rest of it.
fn parts(text: &str) -> Option<(i128, f64)> {
    let (whole, rest) = text.split_once(['.', ',']).unwrap_or((text, ""));
    if !rest.bytes().all(|b| b.is_ascii_digit()) || whole.len() > 30 {
        return None;
    }
    let fraction = if rest.is_empty() {
        0.0
    } else {
        format!("0.{rest}").parse().ok()?
    };
    Some((whole.parse().ok()?, fraction))
}

/// A date with a time of day, or a time of day alone.
struct Stamp {
    /// Days from 1970.
    day: Option<i64>,
    /// Of the day, s.
    seconds: f64,
    /// By how much the clock is ahead of universal time, s.
    east: i64,
}

impl Stamp {
    /// Reads a date as in ISO 8601 (`2025-01-31T09:27:03.748Z`, also with a blank, slashes, or without a zone), as in
    /// German (`31.01.2025 09:27:03`), or a time of day (`09:27:03.5`).
    fn read(text: &str) -> Option<Self> {
        let text = text.trim();
        if !text.starts_with(|c: char| c.is_ascii_digit()) || text.len() > 40 {
            return None;
        }
        let (date, time) = match text.find(['T', 't', ' ', '_']) {
            Some(i) => (Some(&text[..i]), text[i + 1..].trim_start()),
            None if text.contains(':') => (None, text),
            None => (Some(text), "00:00:00"),
        };
        let (time, east) = zone(time)?;
        Some(Self {
            day: date.map(day).map_or(Some(None), |d| d.map(Some))?,
            seconds: time_of_day(time)?,
            east,
        })
    }
}

/// Days from 1970 of a date, year first or day first with points; what has slashes and the year last means one day in
/// America and another elsewhere.
fn day(text: &str) -> Option<i64> {
    let (mark, turned) = match text.as_bytes().iter().find(|b| !b.is_ascii_digit())? {
        b'-' => ('-', false),
        b'/' => ('/', false),
        b'.' => ('.', true),
        _ => return None,
    };
    let mut parts = text.split(mark);
    let mut next = || parts.next()?.parse::<i64>().ok();
    let [mut year, month, mut day] = [next()?, next()?, next()?];
    if turned {
        (year, day) = (day, year);
    }
    let real =
        (1000..=9999).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day);
    (real && parts.next().is_none()).then(|| days_from_1970(year, month, day))
}

/// Days from 1970-01-01 to a day of the Gregorian calendar (H. Hinnant, "chrono-compatible low-level date algorithms",
/// `days_from_civil`): years begin in March, so that the day that leap years add is their last.
fn days_from_1970(year: i64, month: i64, day: i64) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let (era, of_era) = (year.div_euclid(400), year.rem_euclid(400));
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - DAYS_TO_1970
}

/// A time of day without its zone, and by how much that is ahead of universal time, s.
fn zone(text: &str) -> Option<(&str, i64)> {
    if let Some(time) = text.strip_suffix(['Z', 'z']) {
        return Some((time, 0));
    }
    let Some(i) = text.find(['+', '-']) else {
        return Some((text, 0));
    };
    let (time, zone) = text.split_at(i);
    let digits: String = zone[1..].chars().filter(|c| *c != ':').collect();
    let number: i64 = digits.parse().ok().filter(|_| zone.len() <= 6)?;
    let seconds = match digits.len() {
        2 => number * 3600,
        4 => number / 100 * 3600 + number % 100 * 60,
        _ => return None,
    };
    Some((
        time,
        if zone.starts_with('-') {
            -seconds
        } else {
            seconds
        },
    ))
}

/// Seconds of a time of day, `09:27`, `09:27:03` or `09:27:03.748`.
fn time_of_day(text: &str) -> Option<f64> {
    let mut parts = text.trim_end().split(':');
    let mut whole = |most| parts.next()?.parse::<u8>().ok().filter(|n| *n <= most);
    let [hours, minutes] = [whole(24)?, whole(59)?];
    let seconds: f64 = match parts.next() {
        Some(s) if s.starts_with(|c: char| c.is_ascii_digit()) => {
            s.replacen(',', ".", 1).parse().ok()?
        }
        Some(_) => return None,
        None => 0.0,
    };
    let fits = (0.0..61.0).contains(&seconds) && parts.next().is_none();
    fits.then(|| f64::from(hours) * 3600.0 + f64::from(minutes) * 60.0 + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seconds from the first to the second.
    fn between(first: &str, second: &str) -> Option<f64> {
        let mut clock = Clock::default();
        clock.date(first)?;
        clock.date(second)
    }

    #[test]
    fn dates_are_seconds_from_the_first() {
        for (first, second, seconds) in [
            (
                "2025-01-01T09:27:03.748Z",
                "2025-01-01T09:27:03.849Z",
                0.101,
            ),
            ("2024-02-28 23:59:59", "2024-03-01 00:00:00", 86_401.0),
            ("2023-02-28T23:59:59,5", "2023-03-01T00:00:00", 0.5),
            (
                "2025-03-30T01:00:00+01:00",
                "2025-03-30T03:00:00+02:00",
                3600.0,
            ),
            ("2025-03-30T01:00:00-0330", "2025-03-30T04:30:01Z", 1.0),
            ("31.12.2025 23:59:59", "01.01.2026 00:00:01", 2.0),
            ("2025/01/01 00:00", "2025/01/02 00:00", 86_400.0),
            ("2025-01-01", "2026-01-01", 365.0 * 86_400.0),
            ("23:59:59.5", "00:00:00.25", 0.75),
        ] {
            let found = between(first, second).unwrap_or(f64::NAN);
            assert!((found - seconds).abs() < 1e-6, "{first} {second}: {found}");
        }
        for text in [
            "12/31/2025 10:00:00",
            "2025-13-01",
            "2025-01-01T25:00:00",
            "1:2:3:4",
            "2025-01",
            "12",
            "-1:00",
        ] {
            assert_eq!(Clock::default().date(text), None, "{text}");
        }
    }

    #[test]
    fn a_clock_that_counts_from_1970_is_known_by_its_size() {
        let now = 1_700_000_000.0;
        for (factor, unit) in [(1.0, "s"), (1e3, "ms"), (1e6, "us"), (1e9, "ns")] {
            assert_eq!(unit_from_1970(now * factor), Some(unit));
        }
        for other in [0.0, 5e3, 9e8, -now, 1e20, f64::NAN] {
            assert_eq!(unit_from_1970(other), None);
        }
        // No digit of a count of nanoseconds is lost.
        let clock = Clock::from_1970("1700000000000000001").expect("a clock");
        assert_eq!(clock.counted("1700000000000000004"), Some(3.0));
        assert_eq!(clock.counted("1700000000000000004.5"), Some(3.5));
    }
}
