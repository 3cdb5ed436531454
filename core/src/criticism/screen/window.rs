//! Windows of several widths and the integrals over them.
//!
//! Both sides of the equation of motion are multiplied by a smooth bump that is 0 at the ends of a window, and
//! integrated by parts (Shinbrot 1957; Preisig and Rippin 1993; Messenger and Bortz 2021): derivatives go to the bump,
//! and noise is never differentiated.

use super::signals::Signals;
use super::tuning::{
    BLOCKS, BUMP_POWER, MOST_WINDOWS, NOISY, SHORTEST, STRIDE, WIDEST, WIDEST_OF_PROCESS,
    WIDTH_RATIO, WIDTHS,
};
use crate::measurement::Kind;

/// Windows of one width.
#[derive(Clone, Debug)]
pub(in crate::criticism) struct Width {
    /// Intervals in a window.
    pub length: usize,
    /// First samples.
    pub starts: Vec<usize>,
    /// Weights of the samples: the bump and its derivatives, with the sign of the integration by parts and the step.
    pub weights: [Vec<f64>; 4],
}

/// The bump `(1 - s^2)^p` over `length` intervals and its derivatives up to the third, times the step and the sign of
/// the integration by parts.
fn weights(length: usize, step: f64) -> [Vec<f64>; 4] {
    let p = f64::from(BUMP_POWER);
    let half = length as f64 * step / 2.0;
    let at = |k: usize| -1.0 + 2.0 * k as f64 / length as f64;
    let of = |f: &dyn Fn(f64, f64) -> f64, order: i32| -> Vec<f64> {
        let scale = step * (-1.0 / half).powi(order);
        (0..=length)
            .map(|k| {
                let s = at(k);
                scale * f(s, 1.0 - s * s)
            })
            .collect()
    };
    let power = |q: f64, e: i32| q.max(0.0).powi(e);
    let (n, second, third) = (BUMP_POWER, p * (p - 1.0), p * (p - 1.0) * (p - 2.0));
    [
        of(&|_, q| power(q, n), 0),
        of(&|s, q| -2.0 * p * s * power(q, n - 1), 1),
        of(
            &|s, q| -2.0 * p * power(q, n - 1) + 4.0 * second * s * s * power(q, n - 2),
            2,
        ),
        of(
            &|s, q| 12.0 * second * s * power(q, n - 2) - 8.0 * third * s.powi(3) * power(q, n - 3),
            3,
        ),
    ]
}

/// Sum of products, in four lanes: the same on every machine.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let (pairs, rest) = (a.chunks_exact(4).zip(b.chunks_exact(4)), a.len() / 4 * 4);
    for (x, y) in pairs {
        for (lane, (x, y)) in lanes.iter_mut().zip(x.iter().zip(y)) {
            *lane += x * y;
        }
    }
    let tail: f64 = a[rest..].iter().zip(&b[rest..]).map(|(x, y)| x * y).sum();
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + tail
}

impl Width {
    fn new(length: usize, signals: &Signals) -> Self {
        let last = signals.len().saturating_sub(length + 1);
        let stride = ((STRIDE * length as f64) as usize).max(1);
        let stride = stride.max(last.div_ceil(MOST_WINDOWS));
        let block = signals.len() as f64 / BLOCKS as f64;
        let in_one =
            |k: usize| (k as f64 / block) as usize == ((k + length) as f64 / block) as usize;
        // A window in two blocks would show the one to a fit that is judged by the other.
        let apart = 2 * length <= block as usize;
        let starts = (0..=last)
            .step_by(stride)
            .filter(|k| (!apart || in_one(*k)) && signals.is_one_run(*k, *k + length));
        Self {
            length,
            starts: starts.collect(),
            weights: weights(length, signals.step),
        }
    }

    /// Integrals of the derivative of this order of a series, one for each window.
    pub fn integrals<'a>(
        &'a self,
        values: &'a [f64],
        derivative: usize,
    ) -> impl Iterator<Item = f64> + 'a {
        let weights = &self.weights[derivative.min(3)];
        let window = |start: usize| &values[start..=start + self.length];
        self.starts
            .iter()
            .map(move |start| dot(weights, window(*start)))
    }

    /// Standard deviation of the integral of white noise.
    fn of_noise(&self, noise: f64, derivative: usize) -> f64 {
        noise * dot(&self.weights[derivative], &self.weights[derivative]).sqrt()
    }

    /// Which sensor tells a derivative of the motion best, its series and the order that is taken of it.
    fn sensor<'a>(&self, signals: &'a Signals, derivative: usize) -> (f64, &'a [f64], usize) {
        let by = |seen: &'a Option<super::signals::Seen>, order: usize| {
            let seen = seen.as_ref()?;
            Some((
                self.of_noise(seen.noise, order),
                seen.values.as_slice(),
                order,
            ))
        };
        let velocity = by(&signals.velocity, derivative - 1);
        let position = by(&signals.position, derivative);
        match (velocity, position) {
            (Some(v), Some(x)) if v.0 <= x.0 => v,
            (_, Some(x)) => x,
            (Some(v), None) => v,
            (None, None) => (0.0, signals.speed.as_slice(), derivative - 1),
        }
    }

    /// Integrals of the acceleration (derivative 2) or of the velocity (derivative 1) of a drive; of a process, of the
    /// rate of its output and of the output.
    pub fn motion(&self, signals: &Signals, derivative: usize) -> Vec<f64> {
        let (_, values, order) = self.sensor(signals, derivative);
        self.less_begin(values, order)
    }

    /// [`Self::integrals`] of a series that counts from where it began: a sum of samples is the integral but nearly, so
    /// that what stands still far from the origin would seem to be accelerated.
    fn less_begin(&self, values: &[f64], derivative: usize) -> Vec<f64> {
        let begin = values.first().copied().unwrap_or(0.0);
        let still: f64 = match derivative {
            2 => begin * self.weights[2].iter().sum::<f64>(),
            _ => 0.0,
        };
        let integrals = self.integrals(values, derivative);
        integrals.map(|integral| integral - still).collect()
    }

    /// Standard deviation of the noise in what [`Self::motion`] gives.
    pub fn noise_of_motion(&self, signals: &Signals, derivative: usize) -> f64 {
        self.sensor(signals, derivative).0
    }

    /// Share of the acceleration that is noise.
    fn noisy(&self, signals: &Signals) -> f64 {
        let (noise, values, order) = self.sensor(signals, 2);
        let integrals = self.less_begin(values, order);
        noise / super::signals::rms(&integrals).max(f64::MIN_POSITIVE)
    }
}

/// Widths from the shortest whose acceleration is not noise.
pub(in crate::criticism) fn widths(signals: &Signals) -> Vec<Width> {
    let share = match signals.kind {
        Kind::Drive => WIDEST,
        Kind::Process => WIDEST_OF_PROCESS,
    };
    let widest = ((signals.len() as f64 * share) as usize)
        .max(SHORTEST)
        .min(signals.len() / 2);
    let mut lengths = Vec::new();
    let mut length = SHORTEST as f64;
    while length * WIDTH_RATIO.sqrt() < widest as f64 {
        lengths.push(length as usize);
        length *= WIDTH_RATIO;
    }
    lengths.push(widest);
    let mut widths = lengths
        .into_iter()
        .map(|length| Width::new(length, signals));
    let mut kept = Vec::new();
    let mut last = None;
    for width in &mut widths {
        if width.noisy(signals) <= NOISY {
            kept.push(width);
            break;
        }
        last = Some(width);
    }
    kept.extend(widths.filter(|w| !w.starts.is_empty()));
    if kept.is_empty() {
        kept.extend(last);
    }
    // The shortest and the widest stay; between them as many as there is room for.
    while kept.len() > WIDTHS {
        kept.remove(kept.len() / 2);
    }
    kept
}
