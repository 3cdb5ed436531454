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

/// Samples of a drive on which models are compared; a longer record is fitted as a whole at last.
const COMPARED: usize = 60_000;

/// Iterations of a fit of the whole record from that of a part of it.
const WHOLE_ITERATIONS: usize = 2;

pub(super) struct Session {
    /// What fits are compared on: all of the record, or windows spread over a long one.
    pub data: Data,
    /// All of a long record, if `data` is not.
    full: Option<Data>,
    /// Score of the baseline, once it is fitted.
    pub baseline: Option<Score>,
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
        let scales = data.scales(inertia, viscous);
        let compared = data.thinned(COMPARED);
        Ok(Self {
            scales,
            scout: compared.scout(),
            baseline: None,
            full: (compared.used() < data.used()).then_some(data),
            data: compared,
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
            spans: &data.spans(),
            body: (model.inertia, model.viscous),
        })
    }

    /// Score of the baseline, or of `scored` if there is none yet.
    pub fn first<'a>(&'a self, scored: &'a Scored) -> &'a Score {
        self.baseline.as_ref().unwrap_or(&scored.score)
    }

    /// The whole record.
    pub fn whole(&self) -> &Data {
        self.full.as_ref().unwrap_or(&self.data)
    }

    /// The fit carried over to the whole record.
    pub fn completed(&self, scored: &Scored) -> Scored {
        let Some(full) = &self.full else {
            return scored.clone();
        };
        let mut starts = full.guessed_starts();
        for known in &scored.fit.starts {
            if let Ok(at) = starts.binary_search_by_key(&known.sample, |s| s.sample) {
                starts[at] = *known;
            }
        }
        let (structure, values) = (scored.fit.structure.clone(), scored.fit.values.clone());
        let mut fit = Fit::new(full, structure, values, starts, &self.scales);
        fit.polish_starts(full, &self.scales);
        for _ in 0..WHOLE_ITERATIONS {
            fit.iterate(full, &self.scales);
        }
        fit.polish_starts(full, &self.scales);
        let score = score(full, &fit);
        Scored { fit, score }
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
        if is_noise(&scored.score, self.first(scored)) {
            return Vec::new();
        }
        let unit = self
            .outputs
            .iter()
            .find(|o| o.0 != Quantity::Position)
            .map_or_else(|| self.velocity_unit(), |o| o.2.as_str());
        locate(self.whole(), &scored.fit.motion, unit)
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
                .zip(&self.whole().outputs)
                .map(|((quantity, name, unit), output)| ReplayChannel {
                    quantity: *quantity,
                    name: name.clone(),
                    unit: unit.clone(),
                    noise: output.noise,
                    modelled: fit.motion.of(output.is_velocity).to_vec(),
                })
                .collect(),
            window_starts: self.whole().windows.clone(),
        }
    }
}
