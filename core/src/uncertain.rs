//! Quantities as they are read: in a verdict, a report, a table, on an axis and on the terminal.
//!
//! One rule for all of them. A unit takes the prefix with which the number is from 0.1 to below 1000 (0.035 N m is
//! 35 mN m). A value has as many decimals as its standard error leaves it, which stands behind it in per cent; what a
//! record does not determine is said to be so. No power of ten is written as `e-7`.

use std::fmt::Write as _;

use crate::message::Message;
use crate::msg;

/// An error below this share of its value is written as this: no fifth digit of a measurement is read.
const LEAST_SHARE: f64 = 1e-4;

/// Significant digits of a value whose error is not known, and of a brief one.
const DIGITS: i32 = 4;
const BRIEF: i32 = 3;

/// A number from the first to the second of these is written without a power of ten.
const PLAIN: std::ops::Range<f64> = 1e-4..1e6;

/// A number in its unit is from the first to below the second of these.
const SMALLEST: f64 = 0.1;
const LARGEST: f64 = 1e3;

/// Units that begin with one of these take a prefix; thousands are usual for the last ones only.
const PREFIXED: [&str; 9] = ["rad", "m", "s", "A", "V", "N", "W", "Hz", "J"];
const THOUSANDS_FROM: usize = 5;
const SMALLER: [(f64, &str); 4] = [(1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];
const LARGER: [(f64, &str); 2] = [(1e6, "M"), (1e3, "k")];

/// Inertias and masses: the kilogram has a prefix already. Each with the least size for which it is taken, in kg m² or
/// kg.
const INERTIAS: [(f64, f64, &str); 3] = [
    (1e-2, 1.0, "kg m²"),
    (1e-8, 1e-6, "kg mm²"),
    (0.0, 1e-9, "g mm²"),
];
const MASSES: [(f64, f64, &str); 3] = [(0.1, 1.0, "kg"), (1e-4, 1e-3, "g"), (0.0, 1e-6, "mg")];

/// The unit in which values of a size are read, and how many of the unit they are given in it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// A value in the unit that it is given in, divided by this, is in [`Self::unit`].
    pub factor: f64,
    /// As it is shown; empty for a plain number.
    pub unit: String,
}

impl Scale {
    /// The unit for values up to this size, which are given in `unit`.
    pub fn of(size: f64, unit: &str) -> Self {
        let (size, shown) = (size.abs(), shown_unit(unit));
        let plain = |shown: String| Self {
            factor: 1.0,
            unit: shown,
        };
        if !(size.is_finite() && size > 0.0) {
            return plain(shown);
        }
        let listed = match shown.as_str() {
            "kg m²" => &INERTIAS,
            "kg" => &MASSES,
            _ => return Self::prefixed(size, &shown).unwrap_or_else(|| plain(shown)),
        };
        let (_, factor, unit) = listed.iter().find(|l| size >= l.0).unwrap_or(&listed[0]);
        Self {
            factor: *factor,
            unit: (*unit).to_owned(),
        }
    }

    /// With a prefix, if the unit takes one and the size wants it.
    fn prefixed(size: f64, shown: &str) -> Option<Self> {
        let first: String = shown
            .chars()
            .take_while(char::is_ascii_alphabetic)
            .collect();
        let place = PREFIXED.iter().position(|unit| *unit == first)?;
        // A prefix of a square would be squared.
        let squared = shown[first.len()..].starts_with('²');
        if squared {
            return None;
        }
        let larger = LARGER
            .iter()
            .find(|(factor, _)| size >= LARGEST.max(*factor));
        let (factor, prefix) = match larger {
            Some(larger) => Some(larger).filter(|_| place >= THOUSANDS_FROM)?,
            None if size >= SMALLEST => return None,
            None => SMALLER
                .iter()
                .find(|(factor, _)| size >= SMALLEST * factor)?,
        };
        Some(Self {
            factor: *factor,
            unit: format!("{prefix}{shown}"),
        })
    }

    /// A value in this unit as text, with so many decimals.
    fn write(&self, value: f64, decimals: i32) -> String {
        joined(&fixed(value / self.factor, decimals), &self.unit)
    }
}

/// Decimals with which a number has so many significant digits.
fn decimals_for(value: f64, digits: i32) -> i32 {
    match exponent(value, digits) {
        Some(exponent) => digits - 1 - exponent,
        None => 0,
    }
}

/// The power of ten of a number that is rounded to so many digits first: 0.0996 is 0.10.
fn exponent(value: f64, digits: i32) -> Option<i32> {
    if !(value.is_finite() && value != 0.0) {
        return None;
    }
    let decimals = usize::try_from(digits - 1).unwrap_or(0);
    let text = format!("{:.decimals$e}", value.abs());
    text.rsplit('e').next()?.parse().ok()
}

/// A number with so many decimals; below 0 its last digits are zeros.
fn fixed(value: f64, decimals: i32) -> String {
    let text = if let Ok(decimals) = usize::try_from(decimals) {
        format!("{value:.*}", decimals.min(12))
    } else {
        let step = libm::pow(10.0, f64::from(-decimals));
        format!("{:.0}", libm::round(value / step) * step)
    };
    // 0.0 rather than -0.0.
    match text.strip_prefix('-') {
        Some(zero) if !zero.contains(|c: char| c.is_ascii_digit() && c != '0') => zero.to_owned(),
        _ => text,
    }
}

/// Without zeros at the end of its decimals.
fn short(digits: &str) -> &str {
    if digits.contains('.') {
        digits.trim_end_matches('0').trim_end_matches('.')
    } else {
        digits
    }
}

/// A power of ten, as `10⁻⁷`.
pub fn power_of_ten(exponent: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let mut text = String::from(if exponent < 0 { "10⁻" } else { "10" });
    for digit in exponent.unsigned_abs().to_string().bytes() {
        text.push(RAISED[usize::from(digit - b'0') % 10]);
    }
    text
}

/// A number with so many significant digits, without zeros at its end if it is `short`; far from 1 with a power of ten.
fn number(value: f64, digits: i32, is_short: bool) -> String {
    let trimmed = |text: &str| if is_short { short(text) } else { text }.to_owned();
    if !value.is_finite() {
        return "unknown".to_owned();
    }
    match exponent(value, digits) {
        Some(exponent) if !PLAIN.contains(&value.abs()) => {
            let text = fixed(value / libm::pow(10.0, f64::from(exponent)), digits - 1);
            format!("{} × {}", trimmed(&text), power_of_ten(exponent))
        }
        _ => trimmed(&fixed(value, decimals_for(value, digits).max(0))),
    }
}

/// A value with so many significant digits, in the unit with the prefix that suits it.
fn sized(value: f64, unit: &str, digits: i32) -> String {
    let scale = Scale::of(value, unit);
    joined(&number(value / scale.factor, digits, true), &scale.unit)
}

/// A value of which no error is said, with its unit: `35 mN m`.
pub fn quantity(value: f64, unit: &str) -> String {
    sized(value, unit, DIGITS)
}

/// The same with three digits.
pub fn brief_quantity(value: f64, unit: &str) -> String {
    sized(value, unit, BRIEF)
}

/// A value with its standard error in per cent and its unit, as `40.3 mN m ± 0.3 %`; alone where the error is not
/// known; and that the record does not determine it, where it does not.
pub fn with_error(value: f64, error: f64, unit: &str) -> Message {
    if !is_told(value, error) {
        return NOT_TOLD.into();
    }
    let text = match written(value, error, unit) {
        Some((scale, decimals)) => scale.write(value, decimals),
        None => match digits_told(value, error) {
            Some(digits) => {
                let scale = Scale::of(value, unit);
                joined(&number(value / scale.factor, digits, false), &scale.unit)
            }
            None => return quantity(value, unit).into(),
        },
    };
    format!("{text} ± {} %", per_cent(error / value.abs())).into()
}

/// Digits of a value that is written with a power of ten: the last one is no larger than the error.
fn digits_told(value: f64, error: f64) -> Option<i32> {
    let known = value.is_finite() && value != 0.0 && error.is_finite() && error > 0.0;
    let place = |v: f64| libm::floor(libm::log10(v)) as i32;
    known.then(|| {
        let value = value.abs();
        1 + place(value) - place(error.max(LEAST_SHARE * value))
    })
}

/// The unit and the decimals of a value with its error: the last digit is no larger than the error.
fn written(value: f64, error: f64, unit: &str) -> Option<(Scale, i32)> {
    if !(value.is_finite() && error.is_finite() && error > 0.0) {
        return None;
    }
    let scale = Scale::of(value, unit);
    let [value, error] = [value, error].map(|v| v.abs() / scale.factor);
    if !PLAIN.contains(&value) {
        return None;
    }
    let last = error.max(LEAST_SHARE * value);
    Some((scale, -libm::floor(libm::log10(last)) as i32))
}

/// A share in per cent with one digit, or two from 10 % on.
fn per_cent(share: f64) -> String {
    let percent = 100.0 * share.max(LEAST_SHARE);
    let digits = if percent >= 9.5 { 2 } else { 1 };
    fixed(percent, decimals_for(percent, digits).max(0))
}

/// What is said of a value that is not told.
pub const NOT_TOLD: &str = "not determined by this record";

/// Whether a record tells a value: its standard error is no larger than it is.
pub fn is_told(value: f64, error: f64) -> bool {
    // No error is known of a value that is held.
    error.is_nan() || error <= value.abs()
}

/// A value with its error in the same unit, as `-178.3 ± 1.2`: for what has no natural zero, such as a phase. Nothing
/// where the error is not known.
pub fn with_uncertainty(value: f64, error: f64) -> Option<String> {
    if !(value.is_finite() && error.is_finite() && error > 0.0) {
        return None;
    }
    let size = value.abs().max(error);
    let power = if PLAIN.contains(&size) {
        0
    } else {
        exponent(size, 2)?
    };
    let [value, error] = [value, error].map(|v| v / libm::pow(10.0, f64::from(power)));
    let decimals = decimals_for(error.max(LEAST_SHARE * LEAST_SHARE * value.abs()), 2);
    let text = format!("{} ± {}", fixed(value, decimals), fixed(error, decimals));
    Some(match power {
        0 => text,
        power => format!("({text}) × {}", power_of_ten(power)),
    })
}

/// A value with the digits and in the unit in which [`with_error`] writes another value and its error.
pub fn written_like(value: f64, (other, error): (f64, f64), unit: &str) -> String {
    let told = Some(()).filter(|()| is_told(other, error));
    match told.and_then(|()| written(other, error, unit)) {
        None => quantity(value, unit),
        Some((scale, decimals)) => scale.write(value, decimals),
    }
}

/// Standard errors on either side of a 95 % interval.
pub const NORMAL_95: f64 = 1.96;

/// The interval of so many errors on either side of a value, with their digits, as `1.80 to 2.20 N m`.
pub fn interval(value: f64, error: f64, times: f64, unit: &str) -> Message {
    let scale = Scale::of(value.abs().max(times * error), unit);
    let decimals = decimals_for(error / scale.factor, 2);
    let [low, high] = [-times, times].map(|t| fixed((value + t * error) / scale.factor, decimals));
    msg!("{} to {}", low, joined(&high, &scale.unit))
}

/// A text and a unit as it is shown, if it has one.
fn joined(text: &str, shown: &str) -> String {
    let mut all = text.to_owned();
    if !shown.is_empty() {
        let _ = write!(all, " {shown}");
    }
    all
}

/// A value as text with its unit; a plain number has none.
pub fn in_unit(text: impl Into<String>, unit: &str) -> String {
    joined(&text.into(), &shown_unit(unit))
}

/// The name of an axis or of a column with its unit, as `v1 [rad/s]`; a plain number has none.
pub fn titled(name: impl Into<Message>, unit: &str) -> Message {
    match shown_unit(unit) {
        unit if unit.is_empty() => name.into(),
        unit => msg!("{} [{}]", name.into(), unit),
    }
}

/// A unit as it is shown, nothing for a plain number: files and JSON have `kg m^2`, which is easier to type than `kg
/// m²`.
pub fn shown_unit(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        unit => unit.replace("^2", "²").replace("^3", "³"),
    }
}

/// A number with three digits that count.
pub fn brief(value: f64) -> String {
    digits(value, BRIEF)
}

/// A number with so many digits that count.
pub fn digits(value: f64, digits: i32) -> String {
    number(value, digits, false)
}

/// The same without zeros at the end.
pub fn significant(value: f64, digits: i32) -> String {
    number(value, digits, true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_the_prefix_the_digits_and_the_per_cent_of_its_error() {
        for (value, error, unit, text) in [
            (0.034_999_74, 5.8e-8, "N m", "35.000 mN m ± 0.01 %"),
            (5.997e-4, 1.2e-7, "s", "0.5997 ms ± 0.02 %"),
            (0.040_123, 0.001_23, "N m", "40 mN m ± 3 %"),
            (0.040_123, 0.000_33, "N m", "40.1 mN m ± 0.8 %"),
            (8.79e-4, 1.04e-7, "kg m^2", "879.0 kg mm² ± 0.01 %"),
            (2e-3, 5e-4, "N m s/rad", "2.0 mN m s/rad ± 25 %"),
            (1234.0, 56.7, "N m/rad", "1.23 kN m/rad ± 5 %"),
            (1234.0, 56.7, "rad/s", "1230 rad/s ± 5 %"),
            (-0.5, 0.25, "1", "-0.5 ± 50 %"),
            (1.7604e-6, 3.693e-7, "1/s", "1.8 × 10⁻⁶ 1/s ± 21 %"),
            (-2.5e7, 1.2e5, "1", "-2.50 × 10⁷ ± 0.5 %"),
            (3.5e-3, 1e-4, "N m s^2/rad^2", "3.5 mN m s²/rad² ± 3 %"),
            (2.0, f64::NAN, "1", "2"),
            (0.0, 0.0, "N m", "0 N m"),
            (8.799_942e-4, 0.0, "kg m^2", "880 kg mm²"),
        ] {
            assert_eq!(with_error(value, error, unit), text);
        }
    }

    #[test]
    fn a_value_within_its_error_is_not_determined() {
        assert_eq!(with_error(0.54, 0.81, "s"), NOT_TOLD);
        assert_eq!(with_error(0.0, 8700.0, "N m"), NOT_TOLD);
        assert_eq!(with_error(-0.81, 0.54, "s"), "-0.8 s ± 67 %");
        assert!(is_told(0.0, 0.0) && !is_told(3.0, f64::INFINITY));
    }

    #[test]
    fn a_value_beside_another_is_written_like_it() {
        let found = (9.100_61e-4, 7.7e-7);
        assert_eq!(
            with_error(found.0, found.1, "kg m^2"),
            "910.1 kg mm² ± 0.08 %"
        );
        assert_eq!(written_like(9.098e-4, found, "kg m^2"), "909.8 kg mm²");
        assert_eq!(written_like(3.0, (29.87, 0.43), "1"), "3.0");
        assert_eq!(written_like(3.0, (2.0, f64::NAN), "1"), "3");
        assert_eq!(interval(2.0, 0.1, 1.96, "N m"), "1.80 to 2.20 N m");
        assert_eq!(
            interval(8.8e-4, 1e-6, 2.0, "kg m^2"),
            "878.0 to 882.0 kg mm²"
        );
    }

    #[test]
    fn what_has_no_natural_zero_has_its_error_in_the_same_unit() {
        for (value, error, text) in [
            (-178.34, 1.23, "-178.3 ± 1.2"),
            (1234.0, 567.0, "1230 ± 570"),
            (-0.004, 4.6, "0.0 ± 4.6"),
            (12.345, 0.0996, "12.35 ± 0.10"),
            (1.5e7, 2e5, "(1.500 ± 0.020) × 10⁷"),
        ] {
            assert_eq!(with_uncertainty(value, error).as_deref(), Some(text));
        }
        assert_eq!(with_uncertainty(0.3, f64::NAN), None);
    }

    #[test]
    fn a_unit_stands_behind_and_a_plain_number_has_none() {
        assert_eq!(in_unit("3.0", "kg m^2"), "3.0 kg m²");
        assert_eq!(in_unit("3.0", "1"), "3.0");
        assert_eq!(titled("v1", "rad/s"), "v1 [rad/s]");
        assert_eq!(titled("gain", "1"), "gain");
    }

    #[test]
    fn a_brief_number_has_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.234, "1.23"),
            (99.96, "100"),
            (1234.5, "1234"),
            (2.5e-4, "0.000250"),
            (2.5e-7, "2.50 × 10⁻⁷"),
            (f64::NAN, "unknown"),
        ] {
            assert_eq!(brief(value), text);
        }
        assert_eq!(brief_quantity(1.7321e-6, "rad"), "1.73 µrad");
        assert_eq!(brief_quantity(2.034e-3, "rad/s"), "2.03 mrad/s");
        assert_eq!(quantity(0.02, "degC"), "0.02 degC");
    }

    #[test]
    fn an_axis_has_one_unit_for_all_its_labels() {
        for (size, unit, factor, shown) in [
            (0.012, "rad", 1e-3, "mrad"),
            (4e-6, "N m", 1e-6, "µN m"),
            (0.4, "s", 1.0, "s"),
            (5.0, "m^2", 1.0, "m²"),
            (3e-3, "m^2", 1.0, "m²"),
            (2e4, "N", 1e3, "kN"),
            (9e-4, "1", 1.0, ""),
            (0.2, "min", 1.0, "min"),
            (0.02, "kg", 1e-3, "g"),
            (0.0, "rad", 1.0, "rad"),
        ] {
            let found = Scale::of(size, unit);
            assert_eq!((found.factor, found.unit.as_str()), (factor, shown));
        }
    }
}
