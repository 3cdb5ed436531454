//! What a present model leaves unexplained: where effects look for starting values.
//!
//! A missing force moves the body, and the body's answer shows in the outputs. To first order the error
//! of a model is therefore the answer of its linear part (inertia `J`, viscous friction `d`) to the
//! missing force. A force that an effect would bring is sent through that part and compared with the
//! error in all outputs, in noise units, beyond what other starting states of the windows, another
//! inertia or viscous friction, and a constant force can explain: a score test (Rao 1948), one linear
//! regression instead of a fit.

mod bounces;
mod bristle;
mod equations;
mod momentum;
mod moving;
mod regression;
mod spatial;
mod steps;

use nalgebra::DVector;

use super::Scales;
use crate::crew::Crew;
use crate::measurement::Kind;
use crate::model::{Load, free_body, load_torque};
use crate::order::{median, range};
use crate::sums::dot;
pub(super) use bounces::Bounces;
use equations::spans_stride;
pub use momentum::Rubbing;
pub use regression::Regression;
pub use steps::{Place, StepPart, Steps};

/// Samples at most that are looked at.
const MAX_SAMPLES: usize = 200_000;

/// Samples at most that enter a regression.
const REGRESSED: usize = 60_000;

/// Samples of the stretch on which what takes a simulation is scanned.
const STRETCH: usize = 4_000;

/// Forces of every regression: input, velocity, constant.
const BASE: usize = 3;

/// Natural frequencies of a load that are scanned.
const LOAD_FREQUENCIES: u32 = 110;

/// Share of the typical speed below which a velocity has no sign.
const STILL: f64 = 0.01;

/// Smallest friction level to start from, as a share of the typical force.
const LEAST_FRICTION: f64 = 0.01;

/// Largest asymmetry of the input to start from.
const LARGEST_ASYMMETRY: f64 = 0.5;

/// A search for starting values whose best one leaves more than this share of the unexplained force has found nothing:
/// a fit from there would not lower the error by the three per cent that count.
const FOUND: f64 = 0.99;

/// A measured motion and what a present model leaves of it.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Drive or process.
    pub kind: Kind,
    /// Whether it is a drive that turns.
    pub rotates: bool,
    /// Typical sizes.
    pub scales: Scales,
    position: Vec<f64>,
    followed: Vec<f64>,
    velocity: Vec<f64>,
    input: Vec<f64>,
    /// Input that reaches the body, one value per interval.
    acting: Vec<f64>,
    /// First sample and end of each window.
    spans: Vec<(usize, usize)>,
    /// Whether an output is a velocity, and one over its noise.
    outputs: Vec<(bool, f64)>,
    body: FreeBody,
    /// What other starting states do, orthonormal, for the longest window.
    states: Vec<[Vec<f64>; 2]>,
    /// Error of each window, free of what a starting state explains.
    target: Vec<Vec<f64>>,
    /// Answers to the base forces, and to others that are explained beside them, likewise.
    base: Vec<Vec<Vec<f64>>>,
    /// What these come to in the equations, likewise.
    known: Vec<Known>,
    base_left: f64,
    inverse_inertia: f64,
    /// Viscous friction of the present model.
    viscous: f64,
    gap: Option<SeenGap>,
    /// Who tries forces.
    pub crew: Crew,
}

/// Products of the base answers of a window with each other and with its error, and of that with itself.
#[derive(Clone, Debug)]
struct Known {
    normal: Vec<Vec<f64>>,
    right: Vec<f64>,
    power: f64,
}

impl Known {
    fn new(target: &[f64], base: &[Vec<f64>]) -> Self {
        let products = |a: &Vec<f64>| base.iter().map(|b| dot(a, b)).collect();
        Self {
            normal: base.iter().map(products).collect(),
            right: base.iter().map(|a| dot(a, target)).collect(),
            power: dot(target, target),
        }
    }
}

/// One step of the linear body.
#[derive(Clone, Copy, Debug)]
struct FreeBody {
    decay: f64,
    phi1: f64,
    phi2: f64,
}

/// An output of a [`ProbeInput`].
pub struct ProbeOutput {
    /// Whether it shows the velocity (or the output of a process), else the position.
    pub is_velocity: bool,
    /// Measured less modelled values.
    pub error: Vec<f64>,
    /// Standard deviation of its noise.
    pub noise: f64,
}

/// A gap that shows in the record itself, before any fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenGap {
    /// Half of the gap, rad or m.
    pub half_gap: f64,
    /// Standard error of the half gap, rad or m.
    pub error: f64,
    /// The load, where its motion shows.
    pub load: Option<GapLoad>,
}

/// The load of a [`SeenGap`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapLoad {
    /// Its inertia over that of the motor.
    pub inertia_ratio: f64,
    /// Viscous friction over its inertia, 1/s.
    pub viscous: f64,
    /// Dry friction over its inertia, rad/s^2 or m/s^2.
    pub dry: f64,
    /// From the begin of a contact to the centre of its push, s.
    pub push: f64,
    /// Standard errors of its inertia, viscous and dry friction, as shares of these.
    pub errors: [f64; 3],
}

/// What a [`Probe`] is made from.
pub struct ProbeInput<'a> {
    /// Drive or process.
    pub kind: Kind,
    /// Whether it is a drive that turns.
    pub rotates: bool,
    /// Typical sizes.
    pub scales: Scales,
    /// Measured position, or an estimate.
    pub position: &'a [f64],
    /// The same for a load to follow, without its noise; empty for a process.
    pub followed: &'a [f64],
    /// Measured velocity (output of a process), or an estimate.
    pub velocity: &'a [f64],
    /// Commanded input.
    pub input: &'a [f64],
    /// Input that reaches the body, as its mean over each sampling interval.
    pub acting: &'a [f64],
    /// What the present model leaves of each output.
    pub outputs: &'a [ProbeOutput],
    /// First sample and end of the windows at which the present model restarts.
    pub spans: &'a [(usize, usize)],
    /// Inertia and viscous friction of the present model.
    pub body: (f64, f64),
    /// The gap that was seen, if any.
    pub gap: Option<SeenGap>,
    /// Who tries forces.
    pub crew: &'a Crew,
}

impl Probe {
    /// Prepares the regressions.
    pub fn new(input: &ProbeInput) -> Self {
        let n = input.velocity.len().min(MAX_SAMPLES);
        let spans: Vec<(usize, usize)> = input
            .spans
            .iter()
            .map(|(from, to)| (*from, (*to).min(n)))
            .filter(|(from, to)| from + 2 < *to)
            .collect();
        let stride = spans_stride(&spans, REGRESSED);
        let spans: Vec<_> = spans.into_iter().step_by(stride).collect();
        let (inertia, viscous) = input.body;
        let (decay, phi1, phi2) = free_body(viscous / inertia, input.scales.step);
        let outputs: Vec<(bool, f64)> = input
            .outputs
            .iter()
            .map(|o| (o.is_velocity, 1.0 / o.noise))
            .collect();
        let mut probe = Self {
            kind: input.kind,
            rotates: input.rotates,
            scales: input.scales,
            position: input.position[..n].to_vec(),
            followed: input.followed.iter().take(n).copied().collect(),
            velocity: input.velocity[..n].to_vec(),
            input: input.input[..n].to_vec(),
            acting: input.acting.iter().take(n).copied().collect(),
            spans,
            outputs,
            body: FreeBody { decay, phi1, phi2 },
            states: Vec::new(),
            target: Vec::new(),
            base: Vec::new(),
            known: Vec::new(),
            base_left: f64::NAN,
            inverse_inertia: 1.0 / inertia,
            viscous,
            gap: input.gap,
            crew: input.crew.clone(),
        };
        probe.look(|_, (from, to)| {
            let errors = input.outputs.iter();
            errors
                .flat_map(|o| o.error[from..to].iter().map(|e| e / o.noise))
                .collect()
        });
        probe
    }

    /// Takes what is to be explained in each window from `errors`, one output after the other, in noise units.
    fn look(&mut self, errors: impl Fn(&Self, (usize, usize)) -> Vec<f64>) {
        let mut lengths: Vec<usize> = self.spans.iter().map(|(a, b)| b - a).collect();
        lengths.sort_unstable();
        lengths.dedup();
        self.states = lengths.iter().map(|l| self.state_answers(*l)).collect();
        let v = &self.velocity;
        let drag: Vec<f64> = v.windows(2).map(|w| -0.5 * (w[0] + w[1])).collect();
        let ones = vec![1.0; v.len()];
        (self.target, self.base) = self
            .spans
            .iter()
            .map(|&span| {
                let mut target = errors(self, span);
                self.without_states(&mut target, span.1 - span.0);
                let forces = [&self.acting, &drag, &ones];
                let answers = forces.map(|f| self.answer(span, |k| f[k]));
                (target, answers.to_vec())
            })
            .unzip();
        let windows = self.target.iter().zip(&self.base);
        self.known = windows.map(|(t, b)| Known::new(t, b)).collect();
        self.base_left = self.solve(&[], 1).map_or(f64::NAN, |(_, left)| left);
    }

    /// The same with this force, one value for every sample, of any size explained beside the base forces.
    #[must_use]
    pub fn beside(&self, force: &[f64]) -> Self {
        let mut probe = self.clone();
        probe.explain(|k| 0.5 * (force[k] + force[k + 1]));
        probe
    }

    /// Explains a force of any size, as a function of the interval, beside the base forces.
    fn explain(&mut self, force: impl Fn(usize) -> f64) {
        for index in 0..self.spans.len() {
            let answer = self.answer(self.spans[index], &force);
            self.base[index].push(answer);
            self.known[index] = Known::new(&self.target[index], &self.base[index]);
        }
    }

    /// Orthonormal answers to a starting position and velocity over a window of `length` samples.
    fn state_answers(&self, length: usize) -> [Vec<f64>; 2] {
        let (mut position, mut velocity) = (Vec::new(), Vec::new());
        for (is_velocity, weight) in &self.outputs {
            let (mut x, mut v) = (0.0, 1.0);
            for _ in 0..length {
                position.push(if *is_velocity { 0.0 } else { *weight });
                velocity.push(weight * if *is_velocity { v } else { x });
                x += self.body.phi1 * v;
                v *= self.body.decay;
            }
        }
        normalise(&mut position);
        let shared = dot(&position, &velocity);
        for (v, p) in velocity.iter_mut().zip(&position) {
            *v -= shared * p;
        }
        normalise(&mut velocity);
        [position, velocity]
    }

    /// Takes out of the outputs of a window what a starting state explains.
    fn without_states(&self, outputs: &mut [f64], length: usize) {
        let known = self
            .states
            .iter()
            .find(|s| s[0].len() == length * self.outputs.len());
        for state in known.into_iter().flatten() {
            let share = dot(state, outputs);
            for (o, s) in outputs.iter_mut().zip(state) {
                *o -= share * s;
            }
        }
    }

    /// Answer of the outputs in a window to an acceleration (one value per interval), in noise units.
    fn answer(&self, (from, to): (usize, usize), acceleration: impl Fn(usize) -> f64) -> Vec<f64> {
        let length = to - from;
        let FreeBody { decay, phi1, phi2 } = self.body;
        let mut answer = vec![0.0; length * self.outputs.len()];
        let (mut x, mut v) = (0.0, 0.0);
        for k in 0..length {
            for (j, (is_velocity, weight)) in self.outputs.iter().enumerate() {
                answer[j * length + k] = weight * if *is_velocity { v } else { x };
            }
            if k + 1 < length {
                let a = acceleration(from + k);
                x += phi1 * v + phi2 * a;
                v = decay * v + phi1 * a;
            }
        }
        self.without_states(&mut answer, length);
        answer
    }

    /// A force signature as a function of position and velocity, at every sample.
    pub fn signature(&self, force: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let still = STILL * self.scales.speed;
        self.position
            .iter()
            .zip(&self.velocity)
            .map(|(x, v)| if v.abs() < still { 0.0 } else { force(*x, *v) })
            .collect()
    }

    /// Inertia of the body of the present model.
    pub fn inertia(&self) -> f64 {
        1.0 / self.inverse_inertia.abs()
    }

    /// Lowest and highest measured position.
    pub fn position_range(&self) -> (f64, f64) {
        range(&self.position)
    }

    /// Lowest and highest measured velocity, or output of a process.
    pub fn velocity_range(&self) -> (f64, f64) {
        range(&self.velocity)
    }

    /// Where a spring of this stiffness begins on which the body rests, by the input that holds it there, among the
    /// samples at rest at these places: their median, in the unit of the position. None where it rests there for fewer
    /// than so many samples.
    pub fn spring_at_rest(
        &self,
        stiffness: f64,
        is_there: impl Fn(f64) -> bool,
        least: usize,
    ) -> Option<f64> {
        let still = STILL * self.scales.speed;
        let samples = self.position.iter().zip(&self.velocity).zip(&self.input);
        let mut begins: Vec<f64> = samples
            .filter(|((x, v), _)| v.abs() <= still && is_there(**x))
            .map(|((x, _), u)| x - u / stiffness)
            .collect();
        (begins.len() >= least).then(|| median(&mut begins))
    }

    /// Whether the body moves both ways: where it does not, dry friction and a constant force are the same.
    fn turns(&self) -> bool {
        let (low, high) = self.velocity_range();
        let still = STILL * self.scales.speed;
        low < -still && high > still
    }

    /// Level of dry friction that the unexplained force suggests.
    pub fn friction_level(&self) -> f64 {
        let level = if self.turns() {
            let sign = self.signature(|_, v| v.signum());
            let found = self.regress(&[&sign]);
            found.map_or(0.0, |fit| -fit.coefficients[0])
        } else {
            let (low, high) = self.velocity_range();
            -self.offset() * (low + high).signum()
        };
        level.max(LEAST_FRICTION * self.scales.force)
    }

    /// Constant force that the unexplained force suggests, beside friction and another body.
    pub fn offset(&self) -> f64 {
        let found = self.beside_friction(Vec::new()).map(|forces| forces[2]);
        found.filter(|f| f.is_finite()).unwrap_or(0.0)
    }

    /// By which share the input acts more strongly one way than the unexplained force says, beside friction, a constant
    /// force and another body; `None` where that cannot be told, as under an input of one size.
    pub fn asymmetry(&self) -> Option<f64> {
        let size = |k: usize| self.acting.get(k).map_or(0.0, |u| u.abs());
        let share = self.beside_friction(vec![Box::new(size)])?[BASE];
        (share.abs() < LARGEST_ASYMMETRY).then_some(share)
    }

    /// What the unexplained force has of the base forces and of these, beside dry friction of a drive and another body.
    fn beside_friction<'a>(
        &'a self,
        mut forces: Vec<Box<dyn Fn(usize) -> f64 + 'a>>,
    ) -> Option<DVector<f64>> {
        if self.kind == Kind::Drive && self.turns() {
            let sign = self.signature(|_, v| v.signum());
            forces.push(Box::new(move |k| 0.5 * (sign[k] + sign[k + 1])));
        }
        let (c, _) = self.solve(&forces, 1)?;
        let inverse_inertia = self.inverse_inertia + c[0];
        Some(c / inverse_inertia)
    }

    /// Largest commanded input.
    pub fn largest_input(&self) -> f64 {
        self.input.iter().fold(0.0, |m: f64, u| m.max(u.abs()))
    }

    /// Whether a force that leaves this share of the unexplained one may be there at all.
    pub fn may_be(left: f64) -> bool {
        left < FOUND
    }

    /// The gap that shows in the record before any fit, if there is one.
    pub fn gap(&self) -> Option<SeenGap> {
        self.gap
    }

    /// The same of a stretch of the record, the one with the most that is unexplained: enough for a scan of many
    /// forces that each take a simulation.
    #[must_use]
    pub fn stretch(&self) -> Self {
        let total: usize = self.spans.iter().map(|(from, to)| to - from).sum();
        let count = (self.spans.len() * STRETCH).div_ceil(total.max(1)).max(1);
        if count >= self.spans.len() {
            return self.clone();
        }
        let power = |first: &usize| -> f64 {
            let windows = self.known.iter().skip(*first).take(count);
            windows.map(|known| known.power).sum()
        };
        let firsts = 0..=self.spans.len() - count;
        let first = firsts.max_by(|a, b| power(a).total_cmp(&power(b)));
        let first = first.unwrap_or(0);
        self.of_windows(|window| (first..first + count).contains(&window))
    }

    /// The same in the windows that are `chosen` by their number.
    fn of_windows(&self, chosen: impl Fn(usize) -> bool) -> Self {
        let chosen: Vec<usize> = (0..self.spans.len()).filter(|w| chosen(*w)).collect();
        let mut part = Self {
            spans: chosen.iter().map(|w| self.spans[*w]).collect(),
            target: chosen.iter().map(|w| self.target[*w].clone()).collect(),
            base: chosen.iter().map(|w| self.base[*w].clone()).collect(),
            known: chosen.iter().map(|w| self.known[*w].clone()).collect(),
            ..self.clone()
        };
        part.base_left = part.solve(&[], 1).map_or(f64::NAN, |(_, left)| left);
        part
    }

    /// The same with loads that follow the position as it was measured: what is free of noise is rounded where a load
    /// is met between two samples.
    #[must_use]
    pub fn as_measured(&self) -> Self {
        Self {
            followed: self.position.clone(),
            ..self.clone()
        }
    }

    /// By how much the acting input changes from each sample to the next.
    pub fn input_changes(&self) -> Vec<f64> {
        let acting = |k: usize| self.acting.get(k).or(self.acting.last());
        let change = |k| {
            acting(k + 1)
                .zip(acting(k))
                .map_or(0.0, |(to, from)| to - from)
        };
        (0..self.input.len()).map(change).collect()
    }

    /// Torque that `load` would put on the motor, moved as measured, where the windows are.
    pub fn load_torque(&self, load: &Load) -> Vec<f64> {
        load_torque(load, &self.followed, self.scales.step, &self.spans)
    }

    /// Natural frequencies that a load may have, rad/s: from a few periods in the record to a few
    /// samples in a period.
    pub fn load_frequencies(&self) -> Vec<f64> {
        let (low, high) = (40.0 / self.scales.duration, 1.0 / self.scales.step);
        let ratio = libm::pow((high / low).max(1.0), 1.0 / f64::from(LOAD_FREQUENCIES - 1));
        (0..LOAD_FREQUENCIES)
            .map(|i| low * libm::pow(ratio, f64::from(i)))
            .collect()
    }
}

fn normalise(values: &mut [f64]) {
    let size = dot(values, values).sqrt();
    if size > 0.0 {
        for v in values {
            *v /= size;
        }
    }
}
