//! What is missing where no effect explains it: a force, an input or an error of an output, against velocity,
//! position and time.

use super::session::{Scored, Session};
use crate::diagnosis::MissingPart;
use crate::effect::{Dimension, Place, StepPart, Variable};
use crate::measurement::Kind;
use crate::message::{Message, fixed};
use crate::msg;
use crate::uncertain::with_error;

/// Estimates that explain less than this share of the squared error are not shown.
const LEAST_EXPLAINED: f64 = 0.02;

/// Standard errors by which a part must stand out to be named.
const CLEAR: f64 = 3.0;

/// Estimates for what `fit` leaves, the one that explains most first.
pub(super) fn missing_parts(session: &Session, scored: &Scored) -> Vec<MissingPart> {
    let data = session.whole();
    let probe = session.probe_of(data, &scored.fit);
    let velocity = data.velocity_estimate();
    let force = session.unit_of(Some(Dimension::Force));
    let first = data.time.first().copied().unwrap_or(0.0);
    let time: Vec<f64> = data.time.iter().map(|t| t - first).collect();
    let speed = session.output_unit().to_owned();
    let mut axes: Vec<(&str, Variable, String, Vec<f64>)> =
        vec![("force", Variable::Time, "s".to_owned(), time)];
    match data.kind {
        Kind::Drive => {
            let position = session.unit_of(Some(Dimension::Position));
            let place = data.position_estimate();
            axes.push(("force", Variable::Velocity, speed, velocity));
            axes.push(("force", Variable::Position, position, place));
        }
        Kind::Process => {
            axes[0].0 = "input";
            axes.push(("input", Variable::Velocity, speed, velocity));
        }
    }
    axes.push(("input", Variable::Input, force.clone(), data.input.clone()));
    let mut found: Vec<MissingPart> = axes
        .into_iter()
        .filter_map(|(what, axis, axis_unit, values)| {
            let steps = probe.steps(&values, Place::Force)?;
            Some(part(
                what,
                &force,
                axis.axis(data.kind),
                &axis_unit,
                steps.parts,
                steps.explained,
            ))
        })
        .collect();
    for (index, output) in data.outputs.iter().enumerate() {
        let steps = probe.steps(&output.values, Place::Output(index));
        let (name, unit) = session.output_name(index);
        found.extend(steps.map(|s| part("output", unit, name, unit, s.parts, s.explained)));
    }
    found.retain(|m| m.explained > LEAST_EXPLAINED);
    found.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    found
}

fn part(
    what: &str,
    unit: &str,
    axis: &str,
    axis_unit: &str,
    parts: Vec<StepPart>,
    explained: f64,
) -> MissingPart {
    let shown = |unit: &str| {
        if unit == "1" {
            String::new()
        } else {
            format!(" {unit}")
        }
    };
    let share = fixed(100.0 * explained, 0);
    let strongest = parts
        .iter()
        .filter(|p| p.value.abs() > CLEAR * p.std_error)
        .max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))
        .map(|p| {
            let to = format!("{:.3}{}", p.to, shown(axis_unit));
            let value = with_error(p.value, p.std_error, unit);
            [fixed(p.from, 3), to.into(), value]
        });
    let over = Message::words(axis.to_owned());
    let text = match (what, strongest) {
        ("force", None) => msg!(
            "A force that depends on the {} alone would explain {} % of what is left.",
            over,
            share
        ),
        ("force", Some([from, to, value])) => msg!(
            "A force that depends on the {} alone would explain {} % of what is left; it is strongest from {} to {}, \
             with {}.",
            over,
            share,
            from,
            to,
            value
        ),
        ("input", None) => msg!(
            "A further input that depends on the {} alone would explain {} % of what is left.",
            over,
            share
        ),
        ("input", Some([from, to, value])) => msg!(
            "A further input that depends on the {} alone would explain {} % of what is left; it is strongest from {} \
             to {}, with {}.",
            over,
            share,
            from,
            to,
            value
        ),
        (_, None) => msg!(
            "An error of the sensor that depends on the {} alone would explain {} % of what is left.",
            over,
            share
        ),
        (_, Some([from, to, value])) => msg!(
            "An error of the sensor that depends on the {} alone would explain {} % of what is left; it is strongest \
             from {} to {}, with {}.",
            over,
            share,
            from,
            to,
            value
        ),
    };
    MissingPart {
        what: what.to_owned(),
        unit: unit.to_owned(),
        axis: axis.to_owned(),
        axis_unit: axis_unit.to_owned(),
        parts,
        explained,
        text,
    }
}
