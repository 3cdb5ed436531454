//! Units and names of what a session speaks of.

use super::session::Session;
use crate::diagnosis::CriticismError;
use crate::effect::{Dimension, Effect, baseline};
use crate::measurement::{Motion, Quantity};

impl Session {
    /// Checks the units that the user's model says, its effects being among `effects`.
    pub fn check_units(&self, effects: &[&'static dyn Effect]) -> Result<(), CriticismError> {
        let baseline = self
            .data
            .baseline
            .parameters()
            .iter()
            .map(|p| (None, p.symbol, self.unit_of(p.dimension)));
        let own = effects.iter().flat_map(|e| {
            e.parameters().iter().map(|spec| {
                (
                    Some(e.id()),
                    spec.symbol,
                    self.unit_of(Some(spec.dimension)),
                )
            })
        });
        for (owner, symbol, unit) in baseline.chain(own) {
            let said = self.knowledge.find(owner, symbol);
            if let Some(said) = said.and_then(|k| k.unit.as_ref()).filter(|u| **u != unit) {
                return Err(CriticismError::WrongUnit {
                    symbol: symbol.to_owned(),
                    said: said.clone(),
                    unit,
                });
            }
        }
        Ok(())
    }

    /// Unit of a parameter; without a dimension that of a process gain.
    pub fn unit_of(&self, dimension: Option<Dimension>) -> String {
        let output = self.outputs.first().map_or("1", |o| o.2.as_str());
        if let Some(Dimension::Compound {
            force,
            position,
            output: power,
            time,
        }) = dimension
        {
            let unit = |d: Dimension| baseline::unit(d, self.motion, &self.input_unit);
            return compound(&[
                (unit(Dimension::Force), force),
                (unit(Dimension::Position), position),
                (output.to_owned(), power),
                ("s".to_owned(), time),
            ]);
        }
        dimension.map_or_else(
            || baseline::gain_unit(&self.input_unit, output),
            |d| baseline::unit(d, self.motion, &self.input_unit),
        )
    }

    /// Unit of the input.
    pub fn input_unit(&self) -> &str {
        &self.input_unit
    }

    /// Unit of the velocity, or of the output of a process.
    pub fn output_unit(&self) -> &str {
        self.outputs
            .iter()
            .find(|o| o.0 != Quantity::Position)
            .map_or_else(|| self.velocity_unit(), |o| o.2.as_str())
    }

    /// Name and unit of an output.
    pub fn output_name(&self, index: usize) -> (&str, &str) {
        self.outputs
            .get(index)
            .map_or(("output", "1"), |(_, name, unit)| (name, unit))
    }

    fn velocity_unit(&self) -> &'static str {
        match self.motion {
            Motion::Rotational => "rad/s",
            Motion::Translational => "m/s",
            Motion::None => "1",
        }
    }
}

/// A product of powers of units, such as `N m s^2/rad`.
fn compound(parts: &[(String, i8)]) -> String {
    let side = |sign: i8| -> Vec<String> {
        let own = parts
            .iter()
            .filter(|(unit, power)| power * sign > 0 && unit != "1");
        own.map(|(unit, power)| match power.abs() {
            1 => unit.clone(),
            n if unit.contains(' ') => format!("({unit})^{n}"),
            n => format!("{unit}^{n}"),
        })
        .collect()
    };
    let (above, below) = (side(1).join(" "), side(-1));
    match (above.as_str(), below.as_slice()) {
        ("", []) => "1".to_owned(),
        (above, []) => above.to_owned(),
        ("", [one]) => format!("1/{one}"),
        ("", many) => format!("1/({})", many.join(" ")),
        (above, [one]) => format!("{above}/{one}"),
        (above, many) => format!("{above}/({})", many.join(" ")),
    }
}
