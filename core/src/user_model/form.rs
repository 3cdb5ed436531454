//! The simplest forces that look like what is missing, as formulas to try.

use crate::diagnosis::MissingPart;
use crate::effect::variables;
use crate::measurement::Kind;

/// Forms that are named for a part at most.
const MOST: usize = 3;

/// Least share of what is missing that a form must follow.
const FOLLOWED: f64 = 0.3;

/// By how much a later form must follow it better to stand before a simpler one.
const BETTER: f64 = 0.03;

/// A force of one factor that may be what is missing.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// In words, such as `straight line`.
    pub words: &'static str,
    /// Name that it has in the model.
    pub name: &'static str,
    /// As a user would type it, such as `-k*x`.
    pub formula: String,
    /// Share of the squared steps that it follows, 0 to 1.
    pub follows: f64,
}

/// A shape over an axis: words, name, the formula with `x` for the axis, and what it is there.
type Shape = (&'static str, &'static str, &'static str, fn(f64) -> f64);

/// From the simplest on.
const SHAPES: [Shape; 6] = [
    ("constant", "constant", "-c", |_| 1.0),
    ("straight line", "line", "-k*x", |x| x),
    (
        "level that changes sign",
        "level",
        "-c*sign(x)",
        f64::signum,
    ),
    ("parabola", "parabola", "-k*x*abs(x)", |x| x * x.abs()),
    ("cubic", "cubic", "-k*x^3", |x| x * x * x),
    ("sine", "sine", "-a*sin(x)", libm::sin),
];

/// The simplest forms that follow a missing force of such a system, the likeliest first; none for an error of a sensor.
pub fn forms(kind: Kind, part: &MissingPart) -> Vec<Form> {
    let mut known = variables(kind).iter();
    let Some((letter, _)) = known.find(|(_, own)| own.axis(kind) == part.axis) else {
        return Vec::new();
    };
    if part.what == "output" {
        return Vec::new();
    }
    let angle = part.axis_unit == "rad";
    let shapes = SHAPES.iter().filter(|s| angle || s.0 != "sine");
    let mut forms: Vec<Form> = shapes
        .map(|(words, name, formula, shape)| Form {
            words,
            name,
            formula: formula.replace('x', letter),
            follows: follows(part, *shape),
        })
        .filter(|form| form.follows > FOLLOWED)
        .collect();
    // A stable sort by steps of what counts: of equals the simpler is first.
    forms.sort_by_key(|form| -(form.follows / BETTER) as i64);
    forms.truncate(MOST);
    forms
}

/// Share of the squared steps, each by its certainty, that the best multiple of a shape follows.
fn follows(part: &MissingPart, shape: fn(f64) -> f64) -> f64 {
    let (mut along, mut size, mut all) = (0.0, 0.0, 0.0);
    for step in &part.parts {
        let weight = 1.0 / step.std_error.powi(2);
        if !(weight.is_finite() && step.value.is_finite()) {
            continue;
        }
        let s = shape(f64::midpoint(step.from, step.to));
        along += weight * s * step.value;
        size += weight * s * s;
        all += weight * step.value.powi(2);
    }
    if size > 0.0 && all > 0.0 {
        along * along / (size * all)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::{Formula, StepPart};

    fn part(axis: &str, unit: &str, force: fn(f64) -> f64) -> MissingPart {
        let step = |i: i32| {
            let from = -3.0 + 0.2 * f64::from(i);
            StepPart {
                from,
                to: from + 0.2,
                value: force(from + 0.1),
                std_error: 0.01,
            }
        };
        MissingPart {
            what: "force".to_owned(),
            unit: "N m".to_owned(),
            axis: axis.to_owned(),
            axis_unit: unit.to_owned(),
            parts: (0..30).map(step).collect(),
            explained: 0.9,
            text: crate::message::Message::default(),
        }
    }

    #[test]
    fn a_missing_force_is_named_by_the_simplest_form_that_follows_it() {
        for (axis, unit, force, formula) in [
            ("position", "rad", (|x| -2.0 * x) as fn(f64) -> f64, "-k*x"),
            ("position", "rad", |x| -libm::sin(x), "-a*sin(x)"),
            ("velocity", "rad/s", |v| -0.3 * v.signum(), "-c*sign(v)"),
            ("velocity", "m/s", |v| -v * v.abs(), "-k*v*abs(v)"),
            ("time", "s", |_| 0.5, "-c"),
        ] {
            let found = forms(Kind::Drive, &part(axis, unit, force));
            assert_eq!(found[0].formula, formula, "{found:?}");
            assert!(found[0].follows > 0.99);
        }
    }

    #[test]
    fn every_form_is_a_formula_that_can_be_added() {
        for (kind, axis) in [
            (Kind::Drive, "position"),
            (Kind::Drive, "velocity"),
            (Kind::Drive, "time"),
            (Kind::Process, "output"),
            (Kind::Process, "input"),
        ] {
            for force in [(|x| x + 1.0) as fn(f64) -> f64, |x| x.signum(), libm::sin] {
                for form in forms(kind, &part(axis, "rad", force)) {
                    let formula = Formula {
                        name: form.name.to_owned(),
                        text: form.formula,
                    };
                    assert!(formula.parameters(kind).is_ok(), "{formula:?}");
                }
            }
        }
        let mut sensor = part("position", "rad", |x| x);
        sensor.what = "output".to_owned();
        assert_eq!(forms(Kind::Drive, &sensor), []);
    }
}
