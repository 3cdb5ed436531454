//! A record at equal time steps, with the velocity, its sign and the rests that atoms need.

use super::tuning::{REST, SIGN_SIGMAS, SMOOTH, WIDEST_SMOOTHING};
use crate::criticism::cut::pauses;
use crate::criticism::noise::noise_level;
use crate::effect::{Extent, Moment, Track};
use crate::measurement::{Kind, Measurement, Motion, Quantity};
use crate::order::{median, range, sign};
use crate::sums::deviation;

/// A measured output and the standard deviation of its noise.
#[derive(Clone, Debug)]
pub(in crate::criticism) struct Seen {
    pub values: Vec<f64>,
    pub noise: f64,
}

/// What is regressed.
#[derive(Clone, Debug)]
pub(in crate::criticism) struct Signals {
    pub kind: Kind,
    pub step: f64,
    /// Time of each sample since the first, s.
    time: Vec<f64>,
    /// First samples of runs: a gap in time is before each but the first.
    pub begins: Vec<usize>,
    /// Held from a sample to the next.
    pub input: Vec<f64>,
    /// Position of a drive as measured.
    pub position: Option<Seen>,
    /// Velocity of a drive as measured; the output of a process.
    pub velocity: Option<Seen>,
    /// Position as measured, or the integral of the velocity; empty for a process.
    pub place: Vec<f64>,
    /// Velocity without noise; the output of a process as measured.
    pub speed: Vec<f64>,
    /// Sign of the velocity.
    pub direction: Vec<f64>,
    /// 0 where a drive rests, else 1: what holds it there is not known.
    pub moving: Vec<f64>,
    rotates: bool,
}

/// Mean of the values within so many samples.
fn smoothed(values: &[f64], reach: usize) -> Vec<f64> {
    if reach == 0 {
        return values.to_vec();
    }
    let mut sums = vec![0.0; values.len() + 1];
    for (k, value) in values.iter().enumerate() {
        sums[k + 1] = sums[k] + value;
    }
    (0..values.len())
        .map(|k| {
            let reach = reach.min(k).min(values.len() - 1 - k);
            (sums[k + reach + 1] - sums[k - reach]) / (2 * reach + 1) as f64
        })
        .collect()
}

/// Slope of the straight line through the values within so many samples, per second.
fn slope(values: &[f64], reach: usize, step: f64) -> Vec<f64> {
    let n = values.len();
    // Prefix sums of values and of values times their index, from the middle to lose no digits.
    let mean = values.iter().sum::<f64>() / n.max(1) as f64;
    let (mut plain, mut moment) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    for (k, value) in values.iter().enumerate() {
        plain[k + 1] = plain[k] + (value - mean);
        moment[k + 1] = moment[k] + (value - mean) * k as f64;
    }
    (0..n)
        .map(|k| {
            let (from, to) = (k.saturating_sub(reach), (k + reach).min(n - 1));
            let count = (to - from + 1) as f64;
            let middle = (from + to) as f64 / 2.0;
            let squares = count * (count * count - 1.0) / 12.0;
            let sum = moment[to + 1] - moment[from] - middle * (plain[to + 1] - plain[from]);
            sum / (squares.max(f64::MIN_POSITIVE) * step)
        })
        .collect()
}

pub(super) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// A record at equal steps in each of its runs.
#[derive(Default)]
struct Resampled {
    step: f64,
    time: Vec<f64>,
    begins: Vec<usize>,
    input: Vec<f64>,
    outputs: Vec<Vec<f64>>,
}

/// Equal steps, and values there: outputs on straight lines, the input as it was held. Nothing is said of a gap in
/// time.
fn resampled(measurement: &Measurement) -> Resampled {
    let time = &measurement.time;
    let outputs: Vec<&[f64]> = measurement
        .outputs
        .iter()
        .map(|o| o.values.as_slice())
        .collect();
    let begins = [vec![0], pauses(time)].concat();
    let ends = begins[1..].iter().copied().chain([time.len()]);
    let runs: Vec<(usize, usize)> = begins.iter().copied().zip(ends).collect();
    let within = runs
        .iter()
        .flat_map(|(from, to)| time[*from..*to].windows(2));
    let mut steps: Vec<f64> = within.map(|w| w[1] - w[0]).collect();
    let step = median(&mut steps);
    let even = steps.iter().all(|s| (s - step).abs() < 0.5 * step);
    if even {
        let length: f64 = runs
            .iter()
            .map(|(from, to)| time[to - 1] - time[*from])
            .sum();
        let step = length / steps.len().max(1) as f64;
        let at = |(from, to): &(usize, usize)| {
            let begin = time[*from] - time[0];
            (0..to - from).map(move |k| begin + step * k as f64)
        };
        return Resampled {
            step,
            time: runs.iter().flat_map(at).collect(),
            begins,
            input: measurement.input.values.clone(),
            outputs: outputs.into_iter().map(<[f64]>::to_vec).collect(),
        };
    }
    let mut all = Resampled {
        step,
        outputs: vec![Vec::new(); outputs.len()],
        ..Resampled::default()
    };
    for (from, to) in runs {
        let time = &time[from..to];
        let span = time[time.len() - 1] - time[0];
        let count = ((span / step) as usize + 1).min(4 * time.len());
        all.begins.push(all.time.len());
        let mut before = 0;
        for k in 0..count {
            let at = time[0] + step * k as f64;
            while before + 2 < time.len() && time[before + 1] <= at {
                before += 1;
            }
            let share = ((at - time[before]) / (time[before + 1] - time[before])).clamp(0.0, 1.0);
            all.time.push(at - measurement.time[0]);
            all.input.push(measurement.input.values[from + before]);
            for (to, values) in all.outputs.iter_mut().zip(&outputs) {
                let (a, b) = (values[from + before], values[from + before + 1]);
                to.push(a + share * (b - a));
            }
        }
    }
    all
}

impl Signals {
    pub fn new(measurement: &Measurement) -> Self {
        let Resampled {
            step,
            time,
            begins,
            input,
            outputs,
        } = resampled(measurement);
        let seen = |quantity: Quantity| {
            let at = measurement
                .outputs
                .iter()
                .position(|o| o.quantity == quantity)?;
            let values = outputs.get(at)?.clone();
            let noise = noise_level(&values, &input);
            Some(Seen { values, noise })
        };
        let (position, velocity) = match measurement.kind {
            Kind::Drive => (seen(Quantity::Position), seen(Quantity::Velocity)),
            Kind::Process => (None, seen(Quantity::Output)),
        };
        let mut signals = Self {
            kind: measurement.kind,
            step,
            time,
            begins,
            moving: vec![1.0; input.len()],
            direction: vec![0.0; input.len()],
            place: Vec::new(),
            speed: Vec::new(),
            input,
            position,
            velocity,
            rotates: measurement.motion() == Motion::Rotational,
        };
        match measurement.kind {
            Kind::Drive => signals.follow_drive(),
            Kind::Process => {
                let output = signals.velocity.as_ref();
                signals.speed = output.map_or_else(Vec::new, |o| o.values.clone());
            }
        }
        signals
    }

    pub fn len(&self) -> usize {
        self.input.len()
    }

    /// First sample and end of each run.
    pub fn runs(&self) -> impl Iterator<Item = (usize, usize)> {
        let ends = self.begins.iter().skip(1).copied().chain([self.len()]);
        self.begins.iter().copied().zip(ends)
    }

    /// Whether no gap in time is between two samples.
    pub fn is_one_run(&self, from: usize, to: usize) -> bool {
        let run = |k: usize| self.begins.partition_point(|begin| *begin <= k);
        run(from) == run(to)
    }

    /// What a function makes of a series, of each run by itself.
    fn by_runs(&self, values: &[f64], of: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        self.runs()
            .flat_map(|(from, to)| of(&values[from..to]))
            .collect()
    }

    /// Velocity by the sensor that is less noisy, smoothed until its noise is small; its sign; rests.
    fn follow_drive(&mut self) {
        let step = self.step;
        let by_velocity = self.velocity.as_ref().map(|v| (v.noise, v));
        // Noise of a slope over three samples.
        let by_position = self
            .position
            .as_ref()
            .map(|p| (p.noise / (2.0_f64.sqrt() * step), p));
        let (speed, noise) = match (by_velocity, by_position) {
            (Some((noise, v)), other) if other.is_none_or(|o| noise <= o.0) => {
                let wanted = (noise / (SMOOTH * rms(&v.values))).powi(2) / 2.0;
                let reach = (wanted as usize).min(WIDEST_SMOOTHING);
                let left = noise / (2.0 * reach as f64 + 1.0).sqrt();
                (self.by_runs(&v.values, |v| smoothed(v, reach)), left)
            }
            (_, Some((_, p))) => {
                let coarse = self.by_runs(&p.values, |x| slope(x, 8, step));
                let wanted = SMOOTH * rms(&coarse);
                let noise = |reach: usize| {
                    let m = reach as f64;
                    p.noise / step * (3.0 / (m * (m + 1.0) * (2.0 * m + 1.0))).sqrt()
                };
                let reach = (1..=WIDEST_SMOOTHING).find(|r| noise(*r) <= wanted);
                let reach = reach.unwrap_or(WIDEST_SMOOTHING);
                (
                    self.by_runs(&p.values, |x| slope(x, reach, step)),
                    noise(reach),
                )
            }
            _ => (vec![0.0; self.input.len()], 0.0),
        };
        self.place = match &self.position {
            Some(p) => p.values.clone(),
            None => integral(&speed, step),
        };
        self.set_direction(&speed, noise);
        self.speed = speed;
    }

    fn set_direction(&mut self, speed: &[f64], noise: f64) {
        let n = speed.len();
        let hidden = SIGN_SIGMAS * noise;
        let change =
            |k: usize| (speed[(k + 1).min(n - 1)] - speed[k.saturating_sub(1)]).abs() / 4.0;
        let mut changes: Vec<f64> = (0..n).map(change).collect();
        for (k, direction) in self.direction.iter_mut().enumerate() {
            let width = hidden.max(changes[k]);
            *direction = if width > 0.0 {
                (speed[k] / width).clamp(-1.0, 1.0)
            } else {
                sign(speed[k])
            };
        }
        // A reversal crosses the hidden band at the typical acceleration, seen over two half samples.
        let typical = rms(&changes) * 2.0;
        changes.clear();
        let crossing = if typical > 0.0 {
            2.0 * hidden / typical
        } else {
            0.0
        };
        let least = (REST * (1.0 + crossing)) as usize;
        let quiet = |k: usize| speed[k].abs() <= hidden;
        let mut k = 0;
        while k < n {
            let end = (k..n).find(|i| !quiet(*i)).unwrap_or(n);
            if end - k > least.max(3) {
                self.moving[k..end].fill(0.0);
            }
            k = end.max(k + 1);
        }
    }

    /// What atoms see.
    pub fn track(&self) -> Track<'_> {
        Track {
            step: self.step,
            input: &self.input,
            position: &self.place,
            velocity: &self.speed,
        }
    }

    /// A sample, with an input that acts there.
    pub fn moment(&self, k: usize, input: f64) -> Moment {
        Moment {
            position: self.place.get(k).copied().unwrap_or(0.0),
            velocity: self.speed[k],
            direction: self.direction[k],
            input,
            time: self.time[k],
        }
    }

    /// Sizes, with this longest window.
    pub fn extent(&self, window: f64) -> Extent {
        let input = self.input.iter().fold(0.0_f64, |a, u| a.max(u.abs()));
        let rate = self.by_runs(&self.speed, |v| slope(v, 2, self.step));
        let (low, high) = range(&self.place);
        let (least, most) = range(&self.speed);
        Extent {
            step: self.step,
            window,
            input,
            speed: match self.kind {
                Kind::Drive => rms(&self.speed),
                Kind::Process => deviation(&self.speed),
            },
            travel: if self.place.is_empty() {
                0.0
            } else {
                high - low
            },
            acceleration: rms(&rate),
            rotates: self.rotates,
            range: [least, most],
        }
    }
}

/// Trapezoids from 0.
fn integral(values: &[f64], step: f64) -> Vec<f64> {
    let mut at = 0.0;
    let mut before = values.first().copied().unwrap_or(0.0);
    let mut next = |value: f64| {
        at += step * f64::midpoint(before, value);
        before = value;
        at
    };
    values.iter().map(|v| next(*v)).collect()
}
