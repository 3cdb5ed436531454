//! The screening as plain data.

use super::input_check;
use super::model::{Fit, values};
use super::signals::Signals;
use super::subsets::{Bench, Tried, smallest};
use super::tuning::LISTED;
use super::window::Width;
use crate::diagnosis::{InputVerdict, Parameter, Screening, Status, Subset};
use crate::effect::{Dimension, EffectId, VISCOUS_FRICTION, baseline};
use crate::measurement::{Kind, Measurement};

/// Version of the layout.
const SCHEMA: u32 = 1;

/// A parameter without its value.
struct Name {
    effect: Option<EffectId>,
    symbol: &'static str,
    label: &'static str,
    unit: String,
}

impl Name {
    fn with(self, value: f64, std_error: f64) -> Parameter {
        Parameter {
            effect: self.effect,
            name: self.symbol.to_owned(),
            label: self.label.to_owned(),
            value,
            std_error,
            unit: self.unit,
            status: Status::Free,
        }
    }
}

pub(super) fn screening(
    measurement: &Measurement,
    signals: &Signals,
    widths: &[Width],
    bench: &Bench,
    tried: &[Tried],
) -> Screening {
    let motion = bench.motion();
    let share = |loss: f64| (loss / motion.max(f64::MIN_POSITIVE)).sqrt();
    let made = input_check::made_by(signals);
    let name = &measurement.input.name;
    let input_check = input_check::checked(name, signals, widths, bench, tried, made.as_ref());
    let mut class = smallest(tried, motion);
    if let Some(controller) = &made {
        class.retain(|t| bench.is_plant(&t.members, controller));
    }
    let subsets: Vec<Subset> = class
        .iter()
        .take(LISTED)
        .filter_map(|t| {
            Some(Subset {
                effects: t
                    .members
                    .iter()
                    .map(|(c, _)| bench.choices[*c].effect.id())
                    .collect(),
                left: share(t.loss()),
                parameters: parameters(measurement, bench, &t.members)?,
            })
        })
        .collect();
    let body = match subsets.first() {
        Some(best) => best
            .parameters
            .iter()
            .filter(|p| is_body(p))
            .cloned()
            .collect(),
        None => while_calm(measurement, signals, widths, bench, input_check.verdict),
    };
    Screening {
        schema: SCHEMA,
        kind: measurement.kind,
        samples: measurement.len(),
        body,
        left_by_body: tried
            .iter()
            .find(|t| t.members.is_empty())
            .map(|t| share(t.loss())),
        subsets,
        input_check,
        seconds: 0.0,
    }
}

/// The body of a drive whose input explains the motion most of the time.
fn while_calm(
    measurement: &Measurement,
    signals: &Signals,
    widths: &[Width],
    bench: &Bench,
    verdict: InputVerdict,
) -> Vec<Parameter> {
    let tells = measurement.kind == Kind::Drive && verdict == InputVerdict::Ok;
    let body = tells.then(|| input_check::body_while_calm(signals, widths));
    let named = names(measurement, bench, &[]).into_iter();
    named
        .zip(body.flatten().into_iter().flatten())
        .map(|(name, (value, std_error))| name.with(value, std_error))
        .collect()
}

fn is_body(parameter: &Parameter) -> bool {
    parameter.effect.is_none() || parameter.effect == Some(VISCOUS_FRICTION)
}

fn names(measurement: &Measurement, bench: &Bench, members: &[(usize, usize)]) -> Vec<Name> {
    let (motion, input) = (measurement.motion(), measurement.input.unit.as_str());
    let output = measurement.outputs.first().map_or("1", |o| o.unit.as_str());
    let mut names: Vec<Name> = baseline::known_parameters(measurement.kind)
        .iter()
        .map(|p| Name {
            effect: p.effect,
            symbol: p.symbol,
            label: p.label,
            unit: match p.dimension {
                None => baseline::gain_unit(input, output),
                Some(Dimension::Compound { .. }) => output.to_owned(),
                Some(d) => baseline::unit(d, motion, input),
            },
        })
        .collect();
    for (c, _) in members {
        let effect = bench.choices[*c].effect;
        names.extend(effect.parameters().iter().map(|p| Name {
            effect: Some(effect.id()),
            symbol: p.symbol,
            label: p.label,
            unit: baseline::unit(p.dimension, motion, input),
        }));
    }
    names
}

/// The parameters of a subset with errors from the scatter of blocks.
fn parameters(
    measurement: &Measurement,
    bench: &Bench,
    members: &[(usize, usize)],
) -> Option<Vec<Parameter>> {
    let fit = Fit::new(bench.gram, &bench.elements(members))?;
    let subset = bench.subset(members);
    let all = |w: &[f64]| {
        let (found, effects) = values(bench.kind, w, &subset, bench.extent)?;
        let mut all = found.baseline(bench.kind);
        all.extend(effects.into_iter().flatten());
        Some(all)
    };
    let (values, errors) = fit.errors(all)?;
    let named = names(measurement, bench, members).into_iter();
    let with_values = named.zip(values.into_iter().zip(errors));
    Some(
        with_values
            .map(|(name, (value, std_error))| name.with(value, std_error))
            .collect(),
    )
}
