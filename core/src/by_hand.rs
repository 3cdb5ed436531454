//! What does the model say with other values? A replay with parameters that someone sets, beside a fit that is
//! finished.
//!
//! The model runs through the record from the states with which the fit begins its windows. That takes one replay, so
//! that a slider can have it while it is dragged. With other values other states would fit better: [`ByHand::settled`]
//! finds them, by Gauss-Newton steps with the derivatives of each window with respect to its state.

use serde::{Deserialize, Serialize};

use crate::diagnosis::{Parameter, StepReport};
use crate::effect::baseline::Baseline;
use crate::effect::{self, Effect, VISCOUS_FRICTION};
use crate::measurement::{Kind, Measurement, Quantity};
use crate::model::{
    Excitation, FollowedLoad, FollowedNoise, LoadBegin, Model, Sensor, Start, smoothed,
};

/// Gauss-Newton steps for the states.
const STEPS: usize = 3;

/// Share of the noise by which a state is moved for a derivative.
const MOVED: f64 = 1e-3;

/// Fewest samples.
const LEAST: usize = 10;

/// Share by which the error with the fitted values may differ from that of the fit: a model with more states than are
/// known here, such as a load that was felt, cannot be set by hand.
const ALIKE: f64 = 0.1;

/// What a model with values set by hand says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HandReplay {
    /// One entry per measured output, a value for each of the samples.
    pub modelled: Vec<Vec<f64>>,
    /// Error in noise units, comparable with that of the step.
    pub error: f64,
}

/// A measured output.
struct Output {
    is_velocity: bool,
    noise: f64,
    values: Vec<f64>,
}

/// A model whose values can be set, on its record.
pub struct ByHand {
    excitation: Excitation,
    baseline: Baseline,
    effects: Vec<&'static dyn Effect>,
    outputs: Vec<Output>,
    starts: Vec<Start>,
    /// Error of the step for each unit of root mean square of its own replay.
    unit: f64,
}

impl ByHand {
    /// Of a step and these samples of its record; none where the model has more than can be set here: an effect of the
    /// user's own, or a load that its contacts tell.
    pub fn new(
        measurement: &Measurement,
        report: &StepReport,
        (from, to): (usize, usize),
    ) -> Option<Self> {
        let to = to.min(measurement.len());
        let samples = from..to;
        if samples.len() < LEAST {
            return None;
        }
        let step = &report.step;
        let own = step.parameters.iter().filter(|p| p.effect.is_none());
        let baseline = match (measurement.kind, own.count()) {
            (Kind::Drive, _) => Baseline::Drive,
            (Kind::Process, 1) => Baseline::Integrator,
            (Kind::Process, _) => Baseline::Lag {
                from_ambient: false,
            },
        };
        let added = step.effects.iter().filter(|id| **id != VISCOUS_FRICTION);
        let effects: Vec<_> = added.map(|id| effect::find(*id)).collect::<Option<_>>()?;
        let count = |e: &&dyn Effect| e.parameters().len();
        let wanted = baseline.parameters().len() + effects.iter().map(count).sum::<usize>();
        let channels = &report.replay.channels;
        if step.parameters.len() != wanted || channels.len() != measurement.outputs.len() {
            return None;
        }
        let outputs: Vec<Output> = measurement
            .outputs
            .iter()
            .zip(channels)
            .map(|(output, channel)| Output {
                is_velocity: output.quantity != Quantity::Position,
                noise: channel.noise,
                values: output
                    .values
                    .get(samples.clone())
                    .unwrap_or_default()
                    .to_vec(),
            })
            .collect();
        let fitted = channels.iter().map(|c| c.modelled.get(samples.clone()));
        let fitted: Vec<Vec<f64>> = fitted.map(|m| m.unwrap_or_default().to_vec()).collect();
        let values: Vec<f64> = step.parameters.iter().map(|p| p.value).collect();
        let mut hand = Self {
            excitation: excitation(measurement, from, &outputs, false)?,
            baseline,
            effects,
            outputs,
            starts: starts(measurement, report, (from, to)),
            unit: 1.0,
        };
        let of_fit = hand.rms(&fitted);
        hand.unit = step.error / of_fit;
        let (first, at_rest) = (hand.starts.clone(), [false, true]);
        let mut ways = at_rest.into_iter();
        // What acted before the record is not said: its first sample, or nothing.
        let alike = ways.any(|at_rest| {
            let excitation = excitation(measurement, from, &hand.outputs, at_rest);
            hand.excitation = excitation.unwrap_or_else(|| hand.excitation.clone());
            hand.starts.clone_from(&first);
            let alike = |hand: &Self| {
                let error = hand.replay(&values).error;
                (error / step.error - 1.0).abs() < ALIKE
            };
            // What the replay of the fit shows is the state itself, but for a slow sensor or a velocity that is not
            // there.
            alike(&hand) || {
                hand.starts = hand.settled_starts(&values);
                alike(&hand)
            }
        });
        alike.then_some(hand)
    }

    /// The range in which a slider sets a parameter: what it can be, about the fitted value.
    pub fn range(parameter: &Parameter) -> (f64, f64) {
        let value = parameter.value;
        let reach = value.abs().max(3.0 * parameter.std_error);
        let reach = if reach.is_finite() && reach > 0.0 {
            reach
        } else {
            1.0
        };
        if value > 0.0 && !parameter.unit.is_empty() {
            (0.02 * value, value + reach)
        } else {
            (value - reach, value + reach)
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.excitation.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.excitation.is_empty()
    }

    /// The samples of the whole windows of a step that have these samples, the last one excluded, but no more than
    /// `most`.
    pub fn windows_about(
        report: &StepReport,
        (from, to): (usize, usize),
        most: usize,
    ) -> (usize, usize) {
        let samples = || report.replay.window_starts.iter().copied();
        let first = samples().filter(|s| *s <= from).max().unwrap_or(0);
        let all = report
            .replay
            .channels
            .first()
            .map_or(to, |c| c.modelled.len());
        let last = samples().find(|s| *s >= to).unwrap_or(all);
        (first, last.min(first + most))
    }

    /// What the model says with these values, in the order of the parameters of the step.
    pub fn replay(&self, values: &[f64]) -> HandReplay {
        let modelled = self.run(values, &self.starts);
        let error = self.unit * self.rms(&modelled);
        HandReplay { modelled, error }
    }

    /// The same, with the states of the windows that suit these values best.
    pub fn settled(&self, values: &[f64]) -> HandReplay {
        let starts = self.settled_starts(values);
        let modelled = self.run(values, &starts);
        let error = self.unit * self.rms(&modelled);
        HandReplay { modelled, error }
    }

    fn model(&self, values: &[f64]) -> Model {
        let mut model = self.baseline.model(values);
        let mut from = self.baseline.parameters().len();
        for effect in &self.effects {
            let to = from + effect.parameters().len();
            effect.apply(&values[from..to], &mut model);
            from = to;
        }
        model
    }

    fn run(&self, values: &[f64], starts: &[Start]) -> Vec<Vec<f64>> {
        let n = self.len();
        let model = self.model(values);
        let (mut position, mut velocity) = (vec![f64::NAN; n], vec![f64::NAN; n]);
        let known = FollowedLoad::default();
        let loads = self
            .excitation
            .follow(&model, starts, &known, LoadBegin::Followed);
        self.excitation
            .replay(&model, starts, &loads, &mut position, &mut velocity);
        let of = |o: &Output| {
            if o.is_velocity {
                velocity.clone()
            } else {
                position.clone()
            }
        };
        self.outputs.iter().map(of).collect()
    }

    /// Root mean square of what is left, each output in its noise.
    fn rms(&self, modelled: &[Vec<f64>]) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for (output, modelled) in self.outputs.iter().zip(modelled) {
            for (y, m) in output.values.iter().zip(modelled) {
                let left = (y - m) / output.noise;
                if left.is_finite() {
                    sum += left * left;
                    count += 1.0;
                }
            }
        }
        (sum / f64::max(count, 1.0)).sqrt()
    }

    /// The states with which the windows begin best with these values.
    fn settled_starts(&self, values: &[f64]) -> Vec<Start> {
        let mut starts = self.starts.clone();
        let noise = |is_velocity: bool| {
            let output = self.outputs.iter().find(|o| o.is_velocity == is_velocity);
            output.or(self.outputs.first()).map_or(1.0, |o| o.noise)
        };
        let steps = [MOVED * noise(false), MOVED * noise(true)];
        for _ in 0..STEPS {
            let here = self.run(values, &starts);
            let moved = |k: usize| -> Vec<Vec<f64>> {
                let mut there = starts.clone();
                for start in &mut there {
                    *[&mut start.position, &mut start.velocity][k] += steps[k];
                }
                self.run(values, &there)
            };
            let by_position = moved(0);
            let by_velocity = moved(1);
            for (w, start) in starts.iter_mut().enumerate() {
                let from = start.sample;
                let to = self.starts.get(w + 1).map_or(self.len(), |s| s.sample);
                let slope = |there: &Vec<Vec<f64>>, o: usize, i: usize, step: f64| {
                    (there[o][i] - here[o][i]) / step
                };
                // Normal equations of the two states of the window.
                let (mut a, mut b, mut c, mut p, mut q) = (0.0, 0.0, 0.0, 0.0, 0.0);
                for (o, output) in self.outputs.iter().enumerate() {
                    let weight = 1.0 / output.noise.powi(2);
                    let modelled = here[o].iter().enumerate();
                    for (i, now) in modelled.skip(from).take(to - from) {
                        let left = output.values[i] - now;
                        let x = slope(&by_position, o, i, steps[0]);
                        let v = slope(&by_velocity, o, i, steps[1]);
                        if !(left + x + v).is_finite() {
                            continue;
                        }
                        a += weight * x * x;
                        b += weight * x * v;
                        c += weight * v * v;
                        p += weight * x * left;
                        q += weight * v * left;
                    }
                }
                let determinant = a * c - b * b;
                let [dx, dv] = if determinant > 1e-12 * a * c && determinant > 0.0 {
                    [(c * p - b * q) / determinant, (a * q - b * p) / determinant]
                } else if c > 0.0 {
                    [0.0, q / c]
                } else {
                    [0.0; 2]
                };
                if (dx + dv).is_finite() {
                    start.position += dx;
                    start.velocity += dv;
                }
            }
        }
        starts
    }
}

/// The measured input from a sample on, before which nothing moved or its last value acted; none where it cannot be.
fn excitation(
    measurement: &Measurement,
    from: usize,
    outputs: &[Output],
    at_rest: bool,
) -> Option<Excitation> {
    let to = from + outputs.first()?.values.len();
    let input = measurement.input.values.get(from..to)?;
    let time = measurement.time.get(from..to)?;
    let before = match from.checked_sub(1) {
        Some(last) => *measurement.input.values.get(last)?,
        None if at_rest => 0.0,
        None => *input.first()?,
    };
    let seen = |is_velocity: bool| outputs.iter().find(|o| o.is_velocity == is_velocity);
    let velocity = seen(true);
    let sensor = if velocity.is_some() {
        Sensor::Velocity
    } else {
        Sensor::Position
    };
    let (position, noise) = match measurement.kind {
        Kind::Process => (Vec::new(), None),
        Kind::Drive => {
            let [x, v] = [seen(false), velocity].map(|o| o.map(|o| (o.values.as_slice(), o.noise)));
            let noise = x.map(|x| FollowedNoise::Position(x.1));
            let noise = noise.or(v.map(|v| FollowedNoise::Velocity(v.1)));
            (smoothed(time, x, v), noise)
        }
    };
    let shown = velocity.or(outputs.first())?.values.clone();
    let excitation = Excitation::new(time, input, before, sensor, position, noise);
    Some(
        excitation
            .with_shown(shown)
            .at_rest_at_first(at_rest && from == 0),
    )
}

/// The states of the fit where its windows begin, as far as its replay shows them.
fn starts(
    measurement: &Measurement,
    report: &StepReport,
    (from, to): (usize, usize),
) -> Vec<Start> {
    let time = &measurement.time;
    let of = |position: bool| {
        let channels = measurement.outputs.iter().zip(&report.replay.channels);
        channels
            .filter(|(output, _)| (output.quantity == Quantity::Position) == position)
            .map(|(_, channel)| channel.modelled.as_slice())
            .next()
    };
    let [position, velocity] = [true, false].map(of);
    let inside = report.replay.window_starts.iter().copied();
    let inside = inside.filter(|i| (from + 1..to).contains(i) && i + 1 < time.len());
    std::iter::once(from)
        .chain(inside)
        .map(|i| {
            let x = position.map_or(0.0, |x| x[i]);
            let v = match (velocity, position) {
                (Some(v), _) => v[i],
                (None, Some(x)) => (x[i + 1] - x[i]) / (time[i + 1] - time[i]),
                (None, None) => 0.0,
            };
            let known = |value: f64| if value.is_finite() { value } else { 0.0 };
            Start {
                sample: i - from,
                position: known(x),
                velocity: known(v),
                load: [0.0; 2],
            }
        })
        .collect()
}
