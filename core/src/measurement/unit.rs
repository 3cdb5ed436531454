//! Units of columns, as people spell them, and their factors to SI.

use super::Quantity;
use super::column::Role;

/// What a unit measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measures {
    Time,
    Torque,
    Force,
    Angle,
    Length,
    AngularVelocity,
    Speed,
    Current,
    Voltage,
    /// What a drive is told, on a scale of its own, such as a share of the full voltage; as written on screen.
    Command(&'static str),
    Other,
}

impl Measures {
    /// Whether a torque constant makes a torque or a force of it.
    pub fn needs_torque_constant(self) -> bool {
        matches!(self, Self::Current | Self::Voltage | Self::Command(_))
    }

    /// SI unit as written on screen.
    pub fn si(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Torque => "N m",
            Self::Force => "N",
            Self::Angle => "rad",
            Self::Length => "m",
            Self::AngularVelocity => "rad/s",
            Self::Speed => "m/s",
            Self::Current => "A",
            Self::Voltage => "V",
            Self::Command(unit) => unit,
            Self::Other => "1",
        }
    }
}

/// What is accepted, for messages.
pub(super) const ACCEPTED: &str = "time s, ms, us, ns, min, h; torque N m, mN m; force N, mN, kN; current A, mA; voltage \
    V, mV; command %, PWM, counts, 1; angle rad, mrad, deg, rev; length m, mm, um; velocity rad/s, deg/s, rpm, m/s, \
    mm/s; counts with their resolution, such as [counts, 4096/rev] or [counts, 0.001 mm]";

/// Units that a column of a drive in this role often has, of which counts need their resolution; none for the output of
/// a process, which may have any.
pub fn usual_units(role: Role) -> &'static [&'static str] {
    match role {
        Role::Time => &["s", "ms", "us", "min"],
        Role::Measured(Quantity::Input) => &[
            "N m", "mN m", "N", "kN", "A", "mA", "V", "mV", "%", "PWM", "1",
        ],
        Role::Measured(Quantity::Position | Quantity::LoadPosition) => {
            &["rad", "mrad", "deg", "rev", "m", "mm", "um", COUNTS]
        }
        Role::Measured(Quantity::Velocity | Quantity::LoadVelocity) => {
            &["rad/s", "deg/s", "rpm", "rev/s", "m/s", "mm/s"]
        }
        Role::Measured(Quantity::Output) => &[],
    }
}

/// What an encoder counts: a unit that needs its resolution.
pub const COUNTS: &str = "counts";

/// Whether this is a unit of a current, a voltage or a command, which a torque constant makes a torque or a force.
pub fn needs_torque_constant(unit: &str) -> bool {
    constant_per(unit).is_some()
}

/// What a torque constant is given by where the input has this unit, such as the `A` of `N m/A` for `mA`; nothing where
/// it needs none.
pub fn constant_per(unit: &str) -> Option<&'static str> {
    let (measures, _) = parse_input(unit)?;
    measures.needs_torque_constant().then(|| measures.si())
}

/// Quantity and factor of a unit that the input of a drive may have: also of a command, which is no physical one.
pub(super) fn parse_input(text: &str) -> Option<(Measures, f64)> {
    let command = match text.trim().to_lowercase().as_str() {
        "%" | "percent" | "prozent" => "%",
        "pwm" | "duty" => "PWM",
        "1" | "-" => "1",
        _ if is_bare_counts(text) => COUNTS,
        _ => return parse(text),
    };
    Some((Measures::Command(command), 1.0))
}

/// Quantity and factor to SI of a unit, or of counts with a resolution.
///
/// Counts are written `counts, 4096/rev` or `counts:4096` (so many a turn) or `counts, 0.001 mm` (one count is so
/// much).
pub(super) fn parse(text: &str) -> Option<(Measures, f64)> {
    if let Some((name, resolution)) = text.split_once([',', ';', ':'])
        && is_bare_counts(name)
    {
        return counts(resolution.trim());
    }
    plain(text)
}

/// Whether the unit is counts without a resolution.
pub(super) fn is_bare_counts(text: &str) -> bool {
    matches!(
        text.trim().to_lowercase().as_str(),
        "count" | "counts" | "cnt" | "inc" | "increments" | "tick" | "ticks" | "inkremente"
    )
}

fn counts(resolution: &str) -> Option<(Measures, f64)> {
    if let Some((number, per)) = resolution.split_once('/') {
        let number: f64 = number.replace("counts", "").trim().parse().ok()?;
        let (what, factor) = plain(per)?;
        let whole = matches!(what, Measures::Angle | Measures::Length);
        return (whole && number > 0.0 && number.is_finite()).then_some((what, factor / number));
    }
    if let Ok(number) = resolution.parse::<f64>() {
        let whole = number > 0.0 && number.is_finite();
        return whole.then_some((Measures::Angle, std::f64::consts::TAU / number));
    }
    let split = resolution.find(|c: char| c.is_ascii_whitespace())?;
    let number: f64 = resolution[..split].parse().ok()?;
    let (what, factor) = plain(&resolution[split..])?;
    (number > 0.0 && number.is_finite()).then_some((what, factor * number))
}

fn plain(text: &str) -> Option<(Measures, f64)> {
    use Measures::{Angle, AngularVelocity, Current, Force, Length, Speed, Time, Torque, Voltage};
    use std::f64::consts::{PI, TAU};
    let compact: String = text
        .trim()
        .chars()
        .filter(|c| !matches!(c, ' ' | '*' | '·' | '⋅' | '\u{a0}'))
        .map(|c| if c == 'µ' || c == 'μ' { 'u' } else { c })
        .collect();
    let exact = match compact.as_str() {
        "mNm" | "mnm" => Some((Torque, 1e-3)),
        "MNm" => Some((Torque, 1e6)),
        "mN" => Some((Force, 1e-3)),
        "mA" | "ma" => Some((Current, 1e-3)),
        "mV" => Some((Voltage, 1e-3)),
        _ => None,
    };
    if exact.is_some() {
        return exact;
    }
    Some(match compact.to_lowercase().as_str() {
        "s" | "sec" | "secs" | "second" | "seconds" | "sekunde" | "sekunden" => (Time, 1.0),
        "ms" | "msec" | "millis" | "millisec" | "millisecond" | "milliseconds" => (Time, 1e-3),
        "us" | "usec" | "micros" | "microsec" | "microsecond" | "microseconds" => (Time, 1e-6),
        "ns" | "nsec" | "nanoseconds" => (Time, 1e-9),
        "min" | "mins" | "minute" | "minutes" | "minuten" => (Time, 60.0),
        "h" | "hour" | "hours" => (Time, 3600.0),
        "nm" | "n.m" | "n-m" | "newtonmetre" | "newtonmeter" => (Torque, 1.0),
        "knm" => (Torque, 1e3),
        "ncm" => (Torque, 1e-2),
        "a" | "amp" | "amps" | "ampere" => (Current, 1.0),
        "v" | "volt" | "volts" => (Voltage, 1.0),
        "n" | "newton" => (Force, 1.0),
        "kn" => (Force, 1e3),
        "rad" | "radian" | "radians" => (Angle, 1.0),
        "mrad" => (Angle, 1e-3),
        "deg" | "°" | "degree" | "degrees" => (Angle, PI / 180.0),
        "rev" | "turn" | "turns" | "revolutions" => (Angle, TAU),
        "m" | "metre" | "meter" => (Length, 1.0),
        "mm" => (Length, 1e-3),
        "cm" => (Length, 1e-2),
        "um" => (Length, 1e-6),
        "rad/s" | "rad/sec" | "rads^-1" | "rads-1" => (AngularVelocity, 1.0),
        "mrad/s" => (AngularVelocity, 1e-3),
        "deg/s" | "deg/sec" | "dps" | "°/s" => (AngularVelocity, PI / 180.0),
        "rpm" | "rev/min" | "u/min" | "upm" | "1/min" | "min-1" | "min^-1" => {
            (AngularVelocity, TAU / 60.0)
        }
        "rev/s" | "rps" => (AngularVelocity, TAU),
        "m/s" => (Speed, 1.0),
        "mm/s" => (Speed, 1e-3),
        "cm/s" => (Speed, 1e-2),
        "m/min" => (Speed, 1.0 / 60.0),
        "mm/min" => (Speed, 1e-3 / 60.0),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, what: Measures, factor: f64) {
        let (measures, value) = parse(text).unwrap_or((Measures::Other, 0.0));
        assert_eq!(measures, what, "{text}");
        assert!((value / factor - 1.0).abs() < 1e-12, "{text}: {value}");
    }

    #[test]
    fn a_role_takes_its_usual_units() {
        use Quantity::{Input, LoadPosition, Position, Velocity};
        let measured = [Input, Position, Velocity, LoadPosition].map(Role::Measured);
        for role in measured.into_iter().chain([Role::Time]) {
            for unit in usual_units(role) {
                let unit = unit.replace(COUNTS, "counts:4096");
                assert!(role.takes(crate::measurement::Kind::Drive, &unit), "{unit}");
            }
        }
        for unit in ["mA", "V", "%", "PWM", "counts", "1"] {
            assert!(needs_torque_constant(unit), "{unit}");
        }
        assert!(!needs_torque_constant("N m") && !needs_torque_constant("degC"));
        for (unit, per) in [
            ("mA", "A"),
            ("V", "V"),
            ("percent", "%"),
            ("ticks", "counts"),
        ] {
            let per_one = constant_per(unit).unwrap_or_default();
            assert_eq!(per_one, per, "{unit}");
            let constant = format!("2 mN m/{per_one}").parse();
            assert!(constant.is_ok_and(|c: crate::measurement::TorqueConstant| c.value() == 2e-3));
        }
    }

    #[test]
    fn common_spellings() {
        for second in ["s", "sec", "Second", "seconds"] {
            check(second, Measures::Time, 1.0);
        }
        for milli in ["ms", "msec", "millis", "millisec", "milliseconds"] {
            check(milli, Measures::Time, 1e-3);
        }
        for micro in ["us", "µs", "usec", "micros", "microsecond"] {
            check(micro, Measures::Time, 1e-6);
        }
        for minute in ["min", "minute", "minutes"] {
            check(minute, Measures::Time, 60.0);
        }
        check("hours", Measures::Time, 3600.0);
        check("N·m", Measures::Torque, 1.0);
        check("mN m", Measures::Torque, 1e-3);
        check("mN", Measures::Force, 1e-3);
        check("deg", Measures::Angle, std::f64::consts::PI / 180.0);
        check(
            "rpm",
            Measures::AngularVelocity,
            std::f64::consts::TAU / 60.0,
        );
        check(
            "counts, 4096/rev",
            Measures::Angle,
            std::f64::consts::TAU / 4096.0,
        );
        check("counts, 0.001 mm", Measures::Length, 1e-6);
        check(
            "counts:4096",
            Measures::Angle,
            std::f64::consts::TAU / 4096.0,
        );
        check("mA", Measures::Current, 1e-3);
        check("mnm", Measures::Torque, 1e-3);
        check("MNm", Measures::Torque, 1e6);
        check(
            "ticks, 4096/rev",
            Measures::Angle,
            std::f64::consts::TAU / 4096.0,
        );
        check(
            "U/min",
            Measures::AngularVelocity,
            std::f64::consts::TAU / 60.0,
        );
        assert!(
            parse("furlong").is_none()
                && parse("counts, 0/rev").is_none()
                && parse("counts").is_none()
                && parse("counts:-4").is_none()
        );
    }
}
