//! What all fits on one measurement share: its data, sizes, units, and how a fit becomes a report.

use super::baseline;
use super::data::Data;
use super::fit::{Fit, Score, score};
use super::locate::locate;
use super::select::is_noise;
use super::{CriticismError, Parameter, Replay, ReplayChannel};
use crate::effect::{EffectId, Motion, Probe, ProbeInput, ProbeOutput, Scales};
use crate::measurement::{Kind, Measurement, Quantity};

/// A fit with its score.
#[derive(Clone)]
pub(super) struct Scored {
    pub fit: Fit,
    pub score: Score,
}

pub(super) struct Session {
    pub data: Data,
    /// Part of the data on which starting points are tried.
    pub scout: Data,
    pub scales: Scales,
    motion: Motion,
    input_unit: String,
    outputs: Vec<(Quantity, String, String)>,
}

impl Session {
    pub fn new(measurement: &Measurement) -> Result<Self, CriticismError> {
        let data = Data::new(measurement)?;
        let plain = baseline::model(data.kind, &[1.0, 1.0]);
        let guess = baseline::guess(&data, &data.excitation.effective_input(&plain))
            .unwrap_or_else(|| vec![1.0, 1.0]);
        let (inertia, viscous) = baseline::body(data.kind, &guess);
        Ok(Self {
            scales: data.scales(inertia, viscous),
            scout: data.scout(),
            data,
            motion: measurement.motion(),
            input_unit: measurement.input.unit.clone(),
            outputs: measurement
                .outputs
                .iter()
                .map(|c| (c.quantity, c.name.clone(), c.unit.clone()))
                .collect(),
        })
    }

    /// What `fit` leaves unexplained, as a force.
    pub fn probe(&self, fit: &Fit) -> Probe {
        let data = &self.data;
        let model = fit.structure.model(&fit.values);
        let outputs: Vec<ProbeOutput> = data
            .outputs
            .iter()
            .map(|o| ProbeOutput {
                is_velocity: o.is_velocity,
                error: o
                    .values
                    .iter()
                    .zip(fit.motion.of(o.is_velocity))
                    .map(|(y, m)| y - m)
                    .collect(),
                noise: o.noise,
            })
            .collect();
        Probe::new(&ProbeInput {
            kind: data.kind,
            scales: self.scales,
            position: &data.position_estimate(),
            velocity: &data.velocity_estimate(),
            input: &data.input,
            acting: &data.excitation.effective_input(&model),
            outputs: &outputs,
            windows: &data.windows,
            body: (model.inertia, model.viscous),
        })
    }

    pub fn kind(&self) -> Kind {
        self.data.kind
    }

    pub fn scored(&self, fit: Fit) -> Scored {
        let score = score(&self.data, &fit);
        Scored { fit, score }
    }

    /// Effects of a fit, those of the baseline first.
    pub fn effects(&self, fit: &Fit) -> Vec<EffectId> {
        baseline::effects(self.kind())
            .iter()
            .copied()
            .chain(fit.structure.effects.iter().map(|e| e.id()))
            .collect()
    }

    /// Every parameter with its standard error.
    pub fn parameters(&self, scored: &Scored) -> Vec<Parameter> {
        let Scored { fit, score } = scored;
        let inflation = score.error_fit.powi(2).max(1.0) * score.correlation.max(1.0);
        let errors = fit.standard_errors(inflation);
        let output_unit = self.outputs.first().map_or("1", |o| o.2.as_str());
        let mut parameters: Vec<Parameter> = baseline::parameters(self.kind())
            .iter()
            .enumerate()
            .map(|(j, p)| Parameter {
                effect: p.effect,
                name: p.symbol.to_owned(),
                label: p.label.to_owned(),
                value: fit.values[j],
                std_error: errors[j],
                unit: p.dimension.map_or_else(
                    || baseline::gain_unit(&self.input_unit, output_unit),
                    |d| baseline::unit(d, self.motion, &self.input_unit),
                ),
            })
            .collect();
        for (index, effect) in fit.structure.effects.iter().enumerate() {
            for (j, spec) in fit.structure.range(index).zip(effect.parameters()) {
                parameters.push(Parameter {
                    effect: Some(effect.id()),
                    name: spec.symbol.to_owned(),
                    label: spec.label.to_owned(),
                    value: fit.values[j],
                    std_error: errors[j],
                    unit: baseline::unit(spec.dimension, self.motion, &self.input_unit),
                });
            }
        }
        parameters
    }

    /// Where the fit fails; empty where what is left is noise.
    pub fn findings(&self, scored: &Scored) -> Vec<super::Finding> {
        if is_noise(&scored.score) {
            return Vec::new();
        }
        let unit = self
            .outputs
            .iter()
            .find(|o| o.0 != Quantity::Position)
            .map_or_else(|| self.velocity_unit(), |o| o.2.as_str());
        locate(&self.data, &scored.fit.motion, unit)
    }

    fn velocity_unit(&self) -> &'static str {
        match self.motion {
            Motion::Rotational => "rad/s",
            Motion::Translational => "m/s",
            Motion::None => "1",
        }
    }

    /// Curves for the plots.
    pub fn replay(&self, fit: &Fit) -> Replay {
        Replay {
            channels: self
                .outputs
                .iter()
                .zip(&self.data.outputs)
                .map(|((quantity, name, unit), output)| ReplayChannel {
                    quantity: *quantity,
                    name: name.clone(),
                    unit: unit.clone(),
                    noise: output.noise,
                    modelled: fit.motion.of(output.is_velocity).to_vec(),
                })
                .collect(),
            window_starts: self.data.windows.clone(),
        }
    }
}
