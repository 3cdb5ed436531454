//! Values with their uncertainty, as they are read in a verdict, a report, the app and on the terminal.

/// Values from the first to the second of these are written without a power of ten.
const PLAIN: std::ops::Range<f64> = 1e-3..1e5;

/// A smaller error, of a value below the second, has too many zeros to be read aloud.
const LEAST_ERROR: f64 = 1e-5;
const SMALL: f64 = 0.1;

/// Digits of a value whose error is not known.
const DIGITS: i32 = 5;

/// How a value and its error are written.
struct Notation {
    /// The power of ten that is taken out.
    power: i32,
    /// Decimals of both; below 0 their last digits are zeros.
    decimals: i32,
}

impl Notation {
    /// Two significant digits of the error and the value to match; a power of ten is taken out where the digits would
    /// be lost in zeros. None is known without an error.
    fn of(value: f64, error: f64) -> Option<Self> {
        if !(value.is_finite() && error.is_finite() && error > 0.0) {
            return None;
        }
        let size = value.abs().max(error);
        let readable = error >= LEAST_ERROR || size >= SMALL;
        let power = if PLAIN.contains(&size) && readable {
            0
        } else {
            libm::log10(size).floor() as i32
        };
        let spread = error / 10_f64.powi(power);
        if !spread.is_finite() {
            return None;
        }
        // Rounded first: 0.0996 is 0.10, with one decimal less than its own exponent says.
        let exponent = format!("{spread:.1e}")
            .rsplit('e')
            .next()
            .and_then(|e| e.parse::<i32>().ok())
            .unwrap_or(0);
        // Beyond 12 decimals a double has no more to say next to a value of order one.
        let decimals = (1 - exponent).min(12);
        Some(Self { power, decimals })
    }

    /// The digits of a value, without its power of ten.
    fn digits(&self, value: f64) -> String {
        let scaled = value / 10_f64.powi(self.power);
        let text = if let Ok(decimals) = usize::try_from(self.decimals) {
            format!("{scaled:.decimals$}")
        } else {
            let step = 10_f64.powi(-self.decimals);
            format!("{:.0}", (scaled / step).round() * step)
        };
        // 0.0 rather than -0.0.
        match text.strip_prefix('-') {
            Some(zero) if !zero.contains(|c: char| c.is_ascii_digit() && c != '0') => {
                zero.to_owned()
            }
            _ => text,
        }
    }
}

/// `value ± error` as `12.35 ± 0.10` or `(8.79 ± 0.10)e-4`; nothing where the error is not known.
pub fn with_uncertainty(value: f64, error: f64) -> Option<String> {
    let notation = Notation::of(value, error)?;
    let [value, error] = [value, error].map(|v| notation.digits(v));
    Some(match notation.power {
        0 => format!("{value} ± {error}"),
        power => format!("({value} ± {error})e{power}"),
    })
}

/// A value with its error and unit, alone where the error is not known; and that the record does not tell it, where it
/// does not.
pub fn with_error(value: f64, error: f64, unit: &str) -> String {
    let text = in_table(value, error, unit);
    if is_told(value, error) {
        text
    } else {
        format!("{text} ({NOT_TOLD})")
    }
}

/// The same for a table that has another place for the words.
pub fn in_table(value: f64, error: f64, unit: &str) -> String {
    let text = with_uncertainty(value, error).unwrap_or_else(|| alone(value));
    in_unit(text, unit)
}

/// What is said of a value that is not told.
pub const NOT_TOLD: &str = "not told by this record";

/// Whether a record tells a value: its standard error is no larger than it is.
pub fn is_told(value: f64, error: f64) -> bool {
    // No error is known of a value that is held.
    error.is_nan() || error <= value.abs()
}

/// A value with the digits and in the notation in which [`with_error`] writes another value and its error.
pub fn written_like(value: f64, (other, error): (f64, f64), unit: &str) -> String {
    let text = match Notation::of(other, error) {
        None => alone(value),
        Some(notation) => match (notation.digits(value), notation.power) {
            (digits, 0) => digits,
            (digits, power) => format!("{digits}e{power}"),
        },
    };
    in_unit(text, unit)
}

/// The interval of so many errors on either side of a value, with their digits, as `1.80 to 2.20 N m`.
pub fn interval(value: f64, error: f64, times: f64, unit: &str) -> String {
    let end = |times: f64, unit| written_like(value + times * error, (value, error), unit);
    format!("{} to {}", end(-times, "1"), end(times, unit))
}

/// A value of which no error is known.
fn alone(value: f64) -> String {
    let short = |digits: &str| {
        digits
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned()
    };
    let size = value.abs();
    if size > 0.0 && !PLAIN.contains(&size) {
        let text = format!("{value:.*e}", DIGITS as usize - 1);
        return match text.split_once('e') {
            Some((digits, power)) => format!("{}e{power}", short(digits)),
            None => text,
        };
    }
    let decimals = if size > 0.0 {
        DIGITS - 1 - libm::log10(size).floor() as i32
    } else {
        0
    };
    let decimals = usize::try_from(decimals).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        short(&text)
    } else {
        text
    }
}

/// A value as text with its unit; a plain number has none.
pub fn in_unit(text: impl Into<String>, unit: &str) -> String {
    let (mut text, unit) = (text.into(), shown_unit(unit));
    if !unit.is_empty() {
        text.push(' ');
        text.push_str(&unit);
    }
    text
}

/// The name of an axis or of a column with its unit, as `v1 [rad/s]`; a plain number has none.
pub fn titled(name: &str, unit: &str) -> String {
    match shown_unit(unit) {
        unit if unit.is_empty() => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}

/// A unit as it is shown, nothing for a plain number: files and JSON have `kg m^2`, which is easier to type than `kg m²`.
pub fn shown_unit(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        unit => unit.replace("^2", "²"),
    }
}

/// A value with its error, or in words that its error, or even the value, is not known.
pub fn in_words(value: f64, error: f64) -> String {
    with_uncertainty(value, error).unwrap_or_else(|| {
        if value.is_finite() {
            format!("{value} (uncertainty unknown)")
        } else {
            "unknown".to_owned()
        }
    })
}

/// A number with three digits that count, and no power of ten within the usual range.
pub fn brief(value: f64) -> String {
    match value.abs() {
        size if !size.is_finite() => "unknown".to_owned(),
        size if size > 0.0 && !PLAIN.contains(&size) => format!("{value:.2e}"),
        size if size >= 99.95 => format!("{value:.0}"),
        size if size >= 9.995 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_uncertainty_has_two_digits_and_the_value_matches() {
        for (value, error, text) in [
            (0.040_123, 0.001_23, "0.0401 ± 0.0012"),
            (0.004_012, 0.000_123, "0.00401 ± 0.00012"),
            (8.79e-4, 1.04e-7, "(8.7900 ± 0.0010)e-4"),
            (0.040_123_4, 4.2e-6, "(4.01234 ± 0.00042)e-2"),
            (12.345, 0.0996, "12.35 ± 0.10"),
            (1234.0, 56.7, "1234 ± 57"),
            (1234.0, 567.0, "1230 ± 570"),
            (-0.5, 0.25, "-0.50 ± 0.25"),
            (0.0, 3.3e-5, "(0.0 ± 3.3)e-5"),
            (-0.004, 4.6, "0.0 ± 4.6"),
            (1.5e7, 2e5, "(1.500 ± 0.020)e7"),
        ] {
            assert_eq!(with_uncertainty(value, error).as_deref(), Some(text));
        }
        assert_eq!(with_uncertainty(0.3, f64::NAN), None);
    }

    #[test]
    fn a_value_beside_another_is_written_like_it() {
        let found = (9.100_61e-4, 7.7e-8);
        assert_eq!(
            with_error(found.0, found.1, "kg m^2"),
            "(9.10061 ± 0.00077)e-4 kg m²"
        );
        assert_eq!(written_like(9.098e-4, found, "kg m^2"), "9.09800e-4 kg m²");
        assert_eq!(written_like(3.0, (29.87, 0.43), "1"), "3.00");
        assert_eq!(written_like(3.0, (2.0, f64::NAN), "1"), "3");
        assert_eq!(interval(2.0, 0.1, 1.96, "N m"), "1.80 to 2.20 N m");
        assert_eq!(
            interval(8.8e-4, 4.2e-9, 2.0, "kg m^2"),
            "8.799916e-4 to 8.800084e-4 kg m²"
        );
    }

    #[test]
    fn a_value_within_its_error_is_said_not_to_be_told() {
        assert_eq!(
            with_error(0.54, 0.81, "s"),
            "0.54 ± 0.81 s (not told by this record)"
        );
        assert_eq!(in_table(0.54, 0.81, "s"), "0.54 ± 0.81 s");
        assert_eq!(with_error(-0.81, 0.54, "s"), "-0.81 ± 0.54 s");
        assert_eq!(with_error(2.0, f64::NAN, "1"), "2");
        assert!(is_told(0.0, 0.0) && !is_told(3.0, f64::INFINITY));
    }

    #[test]
    fn a_unit_stands_behind_and_a_plain_number_has_none() {
        assert_eq!(in_unit("3.0", "kg m^2"), "3.0 kg m²");
        assert_eq!(in_unit("3.0", "1"), "3.0");
        assert_eq!(titled("v1", "rad/s"), "v1 [rad/s]");
        assert_eq!(titled("gain", "1"), "gain");
    }

    #[test]
    fn where_no_uncertainty_is_known_it_says_so() {
        assert_eq!(in_words(0.3, 0.02), "0.300 ± 0.020");
        assert_eq!(in_words(0.3, f64::NAN), "0.3 (uncertainty unknown)");
        assert_eq!(in_words(f64::NAN, 0.1), "unknown");
    }

    #[test]
    fn a_brief_number_has_three_digits() {
        for (value, text) in [
            (0.0, "0.00"),
            (1.234, "1.23"),
            (99.96, "100"),
            (1234.5, "1234"),
            (2.5e-4, "2.50e-4"),
            (f64::NAN, "unknown"),
        ] {
            assert_eq!(brief(value), text);
        }
    }

    #[test]
    fn a_value_alone_has_no_more_digits_than_are_read() {
        for (value, text) in [
            (0.0, "0"),
            (8.8e-4, "8.8e-4"),
            (8.799_942_123e-4, "8.7999e-4"),
            (0.002, "0.002"),
            (12.345_678, "12.346"),
            (-40.0, "-40"),
        ] {
            assert_eq!(with_error(value, 0.0, "1"), text);
        }
    }
}
