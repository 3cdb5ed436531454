//! The experiments that are simulated: what one model does, and what the others leave of it.

use super::candidates::{LEAST_SAMPLES, Sizes};
use super::limits::extent;
use crate::criticism::data::Data;
use crate::criticism::fit::Fit;
use crate::criticism::noise::Noise;
use crate::criticism::score::score;
use crate::criticism::session::{Scored, Session};
use crate::criticism::structure::Structure;
use crate::criticism::window;
use crate::diagnosis::{CriticismError, FittedModel, Limits, Program};
use crate::effect::EffectId;
use crate::effect::baseline::Baseline;
use crate::measurement::{Channel, Kind, Measurement, Quantity};
use crate::model::{Run, Sensor, run_controlled};

/// Samples that are simulated at most: windows of a drive are alike, and a process is slow.
const DRIVE_SAMPLES: f64 = 5000.0;
const PROCESS_SAMPLES: f64 = 2000.0;

/// Shares of the input that are tried until the limits of speed and travel are kept.
const SHARES: [f64; 5] = [1.0, 0.6, 0.35, 0.2, 0.1];

/// Samples of the run that checks the limits over the whole record.
const CHECKED: f64 = 100_000.0;

/// A model with its fitted values.
#[derive(Clone)]
pub(in crate::criticism) struct Hypothesis {
    structure: Structure,
    values: Vec<f64>,
    pub said: FittedModel,
}

impl Hypothesis {
    /// The fit of a model in which `effect` explains what others could.
    pub fn new(session: &Session, effect: EffectId, scored: &Scored) -> Self {
        let fit = &scored.fit;
        Self {
            structure: fit.structure.clone(),
            values: fit.values.clone(),
            said: FittedModel {
                effect,
                effects: fit.structure.ids(),
                parameters: session.parameters(scored, &[]),
            },
        }
    }

    /// The model that was said; `None` where a parameter is missing.
    pub fn of(session: &Session, said: &FittedModel) -> Result<Self, CriticismError> {
        let effects = said
            .effects
            .iter()
            .map(|id| {
                let wrong = CriticismError::WrongEffect { effect: *id };
                session.find(*id).ok_or(wrong)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let structure = Structure::new(session.data.baseline, effects, session.knowledge.clone());
        let values = structure
            .symbols()
            .into_iter()
            .map(|(owner, symbol)| {
                let known = said.parameters.iter().find(|p| {
                    // The viscous friction of a drive is an effect of the baseline.
                    let baseline = owner.is_none()
                        && p.effect
                            .is_none_or(|e| e == crate::effect::VISCOUS_FRICTION);
                    p.name == symbol && (p.effect == owner || baseline)
                });
                let value = known.map(|p| p.value).filter(|v| v.is_finite());
                value.ok_or_else(|| CriticismError::NoValue {
                    symbol: symbol.to_owned(),
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            structure,
            values,
            said: said.clone(),
        })
    }
}

/// What a simulation tells of a pair, from one side or both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    /// Root mean square of what the rival leaves, in noise units.
    pub separation: f64,
    /// Excess of squared residuals on held-back data per second of record.
    pub rate: f64,
}

impl Outcome {
    pub fn worse(self, other: Self) -> Self {
        Self {
            separation: self.separation.min(other.separation),
            rate: self.rate.min(other.rate),
        }
    }
}

/// Where experiments are simulated.
pub(super) struct Bench {
    pub models: Vec<Hypothesis>,
    pub limits: Limits,
    pub kind: Kind,
    /// Units of the input, and of the velocity or output.
    pub units: (String, String),
    pub sizes: Sizes,
    /// Sampling time of the simulations, s.
    pub step: f64,
    /// Their number of samples.
    samples: usize,
    outputs: Vec<(Quantity, String, String)>,
    noise: Vec<Noise>,
}

impl Bench {
    /// `None` where there is nothing to tell apart, or the limits leave no room.
    pub fn new(session: &Session, models: Vec<Hypothesis>, limits: Limits) -> Option<Self> {
        let data = &session.data;
        let kind = session.kind();
        let first = models.first().filter(|_| models.len() > 1)?;
        let wanted = limits.duration / limits.step;
        if !limits.are_sound() || wanted < LEAST_SAMPLES {
            return None;
        }
        let (step, samples) = match kind {
            Kind::Drive => (limits.step, wanted.min(DRIVE_SAMPLES)),
            Kind::Process => {
                let samples = wanted.min(PROCESS_SAMPLES);
                (limits.duration / samples, samples)
            }
        };
        let seen = data.outputs.iter().find(|o| o.is_velocity);
        let sizes = Sizes {
            kind,
            speed: session.scales.speed,
            noise: seen.map(|o| o.noise),
            inertia: first.values[0],
            time_constant: match kind {
                Kind::Drive => session.scales.time_constant,
                Kind::Process => match first.structure.baseline {
                    Baseline::Lag { .. } => first.values[1],
                    _ => session.scales.time_constant,
                },
            },
            window: window::SHORTEST as f64 * step,
            stretch: step * samples,
        };
        Some(Self {
            noise: data
                .outputs
                .iter()
                .map(|o| Noise {
                    level: o.noise,
                    counted: o.counted,
                    step: o.step,
                })
                .collect(),
            outputs: session.outputs.clone(),
            units: (
                session.input_unit().to_owned(),
                session.output_unit().to_owned(),
            ),
            samples: samples as usize,
            models,
            limits,
            kind,
            sizes,
            step,
        })
    }

    /// Runs a model under a program.
    fn run(&self, model: &Hypothesis, program: &Program, step: f64, samples: usize) -> Run {
        let sensor = if self.sizes.noise.is_some() {
            Sensor::Velocity
        } else {
            Sensor::Position
        };
        let mut controller = program.controller();
        let model = model.structure.model(&model.values);
        run_controlled(&model, step, samples, sensor, |t, seen| {
            controller.command(t, seen)
        })
    }

    /// Largest velocity (output) and travel of a run, if they are within the limits.
    fn reach(&self, run: &Run) -> Option<(f64, f64)> {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let speed = largest(&run.velocity);
        let travel = match self.kind {
            Kind::Drive => extent(&run.position),
            Kind::Process => 0.0,
        };
        let within = |value: f64, limit: Option<f64>| {
            value.is_finite() && limit.is_none_or(|limit| value <= limit)
        };
        let fits = within(speed, self.limits.speed)
            && within(travel, self.limits.travel)
            && within(largest(&run.input), Some(1.0001 * self.limits.input));
        fits.then_some((speed, travel))
    }

    /// The program, with a smaller input if need be, that no model takes beyond the limits.
    pub fn within_limits(&self, program: &Program) -> Option<Program> {
        SHARES.iter().map(|s| program.scaled(*s)).find(|program| {
            let reach = |m| self.reach(&self.run(m, program, self.step, self.samples));
            self.models.iter().all(|m| reach(m).is_some())
        })
    }

    /// What the others leave of what the model at `truth` does, the closest of them.
    pub fn rivals_of(&self, truth: usize, program: &Program, iterations: usize) -> Option<Outcome> {
        let model = self.models.get(truth)?;
        let data = self.record(&self.run(model, program, self.step, self.samples))?;
        // Where windows restart from estimated states, not even the truth is exact.
        let own = left(&data, model, 0)?;
        self.models
            .iter()
            .enumerate()
            .filter(|(k, _)| *k != truth)
            .map(|(_, rival)| {
                let (square, count) = left(&data, rival, iterations)?;
                let excess = (square - own.0).max(0.0);
                Some(Outcome {
                    separation: excess.sqrt(),
                    // A process may be simulated with longer steps than it is sampled with.
                    rate: excess * count / (self.samples as f64 * self.limits.step),
                })
            })
            .reduce(|a, b| Some(a?.worse(b?)))
            .flatten()
    }

    /// A run as a record without noise.
    fn record(&self, run: &Run) -> Option<Data> {
        let outputs = self
            .outputs
            .iter()
            .map(|(quantity, name, unit)| Channel {
                quantity: *quantity,
                name: name.clone(),
                unit: unit.clone(),
                values: match quantity {
                    Quantity::Position => run.position.clone(),
                    _ => run.velocity.clone(),
                },
            })
            .collect();
        let measurement = Measurement {
            name: String::new(),
            kind: self.kind,
            time: (0..self.samples).map(|i| i as f64 * self.step).collect(),
            input: Channel {
                quantity: Quantity::Input,
                name: String::new(),
                unit: self.units.0.clone(),
                values: run.input.clone(),
            },
            outputs,
            reference: Vec::new(),
            warnings: Vec::new(),
        };
        // An input or output that stands still is no experiment.
        Data::with_noise(&measurement, &self.noise).ok()
    }

    /// Largest velocity and travel over the whole record, if the limits are kept.
    pub fn reach_in(&self, program: &Program, duration: f64) -> Option<(f64, f64)> {
        let samples = (duration / self.step).min(CHECKED) as usize;
        self.models
            .iter()
            .map(|m| self.reach(&self.run(m, program, self.step, samples)))
            .reduce(|a, b| {
                let (a, b) = (a?, b?);
                Some((a.0.max(b.0), a.1.max(b.1)))
            })
            .flatten()
    }
}

/// Mean square that a model leaves of a record on its held-back part, in noise units, after `iterations` of a
/// fit; and the number of residuals there.
fn left(data: &Data, model: &Hypothesis, iterations: usize) -> Option<(f64, f64)> {
    let (structure, values) = (model.structure.clone(), model.values.clone());
    let body = structure.model(&values);
    let scales = data.scales(body.inertia, body.viscous);
    let mut fit = Fit::new(data, structure, values, data.guessed_starts(), &scales);
    fit.polish_starts(data, &scales);
    for _ in 0..iterations {
        fit.iterate(data, &scales);
    }
    fit.polish_starts(data, &scales);
    let score = score(data, &fit);
    let square = score.error * score.error;
    square.is_finite().then_some((square, score.held_count))
}
