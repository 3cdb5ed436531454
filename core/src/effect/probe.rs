//! What a present model leaves unexplained, as a force: where effects look for starting values.
//!
//! Between two samples the velocity error `r` of a model with inertia `J` and viscous friction `d`
//! changes by `J dr = int (f - d r) dt`, with `f` the missing force. Summed over short chunks and
//! regressed on what the effect would do, together with changes of inertia, viscous friction and a
//! constant, this is a score test in force space: one linear regression instead of a fit.

use nalgebra::{DMatrix, DVector};

use super::Scales;
use crate::measurement::Kind;
use crate::model::{Load, load_torque};

/// Samples at most that are looked at.
const MAX_SAMPLES: usize = 20_000;

/// Chunks at most that enter a regression.
const MAX_CHUNKS: usize = 5000;

/// Chunk lengths, in samples; the first over which velocity differences stand well above the noise is
/// taken.
const CHUNKS: [usize; 7] = [1, 2, 5, 10, 20, 50, 100];

/// How far above the noise, root mean square.
const CLEAR_OF_NOISE: f64 = 10.0;

/// Columns of every regression: input, velocity, constant.
const BASE: usize = 3;

/// Spatial frequencies that are scanned at most, over the measured travel.
const MAX_SPATIAL: usize = 500;

/// Highest spatial frequency, in radians per sample at the typical speed.
const FASTEST_SPATIAL: f64 = 0.8;

/// Natural frequencies of a load that are scanned.
const LOAD_FREQUENCIES: u32 = 48;

/// Share of the typical speed below which a velocity has no sign.
const STILL: f64 = 0.01;

/// Smallest friction level to start from, as a share of the typical force.
const LEAST_FRICTION: f64 = 0.01;

/// A measured motion and what a present model leaves of it.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Drive or process.
    pub kind: Kind,
    /// Typical sizes.
    pub scales: Scales,
    position: Vec<f64>,
    velocity: Vec<f64>,
    input: Vec<f64>,
    /// First and last sample of each chunk.
    chunks: Vec<(usize, usize)>,
    /// Change of the velocity error over each chunk, its viscous decay taken out.
    target: DVector<f64>,
    base: DMatrix<f64>,
    base_left: f64,
    inverse_inertia: f64,
}

/// What a [`Probe`] is made from.
pub struct ProbeInput<'a> {
    /// Drive or process.
    pub kind: Kind,
    /// Typical sizes.
    pub scales: Scales,
    /// Sampling times, s.
    pub time: &'a [f64],
    /// Measured position, or an estimate.
    pub position: &'a [f64],
    /// Measured velocity (output of a process), or an estimate.
    pub velocity: &'a [f64],
    /// Commanded input.
    pub input: &'a [f64],
    /// Input that reaches the body, as its mean over each sampling interval.
    pub acting: &'a [f64],
    /// Velocity that the present model leaves unexplained.
    pub error: &'a [f64],
    /// Standard deviation of the noise of `velocity`.
    pub noise: f64,
    /// First samples of the windows at which the present model restarts.
    pub windows: &'a [usize],
    /// Inertia and viscous friction of the present model.
    pub body: (f64, f64),
}

/// Outcome of a regression on force signatures.
#[derive(Clone, Debug, PartialEq)]
pub struct Regression {
    /// Force per unit of each signature.
    pub coefficients: Vec<f64>,
    /// Share of the unexplained force that is left, 0 to 1.
    pub left: f64,
}

impl Probe {
    /// Prepares the regressions.
    pub fn new(input: &ProbeInput) -> Self {
        let n = input.velocity.len().min(MAX_SAMPLES);
        let (time, v) = (&input.time[..n], &input.velocity[..n]);
        let length = chunk_length(v, input.noise);
        let mut chunks: Vec<(usize, usize)> = Vec::new();
        for (k, from) in input.windows.iter().enumerate() {
            let end = input.windows.get(k + 1).copied().unwrap_or(n).min(n);
            let mut i = *from;
            while i + length < end {
                chunks.push((i, i + length));
                i += length;
            }
        }
        let stride = chunks.len().div_ceil(MAX_CHUNKS).max(1);
        let chunks: Vec<_> = chunks.into_iter().step_by(stride).collect();
        let (inertia, viscous) = input.body;
        let rate = viscous / inertia;
        let integral = |values: &[f64], (from, to): (usize, usize)| -> f64 {
            (from..to)
                .map(|j| 0.5 * (values[j] + values[j + 1]) * (time[j + 1] - time[j]))
                .sum()
        };
        let target = DVector::from_iterator(
            chunks.len(),
            chunks.iter().map(|&(from, to)| {
                input.error[to] - input.error[from] + rate * integral(input.error, (from, to))
            }),
        );
        let mut base = DMatrix::zeros(chunks.len(), BASE);
        for (row, &(from, to)) in chunks.iter().enumerate() {
            base[(row, 0)] = (from..to)
                .map(|j| input.acting[j] * (time[j + 1] - time[j]))
                .sum();
            base[(row, 1)] = -integral(v, (from, to));
            base[(row, 2)] = time[to] - time[from];
        }
        let mut probe = Self {
            kind: input.kind,
            scales: input.scales,
            position: input.position[..n].to_vec(),
            velocity: v.to_vec(),
            input: input.input[..n].to_vec(),
            chunks,
            target,
            base,
            base_left: f64::NAN,
            inverse_inertia: 1.0 / inertia,
        };
        probe.base_left = probe
            .solve(&DMatrix::zeros(probe.chunks.len(), 0))
            .map_or(f64::NAN, |(_, left)| left);
        probe
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

    /// Regresses the unexplained force on `signatures`, each with a value for every sample; `None` where
    /// they leave no trace or cannot be told from the baseline.
    pub fn regress(&self, signatures: &[&[f64]]) -> Option<Regression> {
        let step = self.scales.step;
        let columns = DMatrix::from_fn(self.chunks.len(), signatures.len(), |row, j| {
            let (from, to) = self.chunks[row];
            let s = signatures[j];
            (from..to).map(|k| 0.5 * (s[k] + s[k + 1])).sum::<f64>() * step
        });
        let (solution, left) = self.solve(&columns)?;
        let b = self.inverse_inertia + solution[0];
        let coefficients: Vec<f64> = solution.iter().skip(BASE).map(|c| c / b).collect();
        (b * self.inverse_inertia > 0.0 && coefficients.iter().all(|c| c.is_finite())).then(|| {
            Regression {
                coefficients,
                left: left / self.base_left,
            }
        })
    }

    /// Least squares on the base columns and `columns`: coefficients and squared remainder.
    fn solve(&self, columns: &DMatrix<f64>) -> Option<(DVector<f64>, f64)> {
        let p = BASE + columns.ncols();
        let column = |j: usize| {
            if j < BASE {
                self.base.column(j)
            } else {
                columns.column(j - BASE)
            }
        };
        let sizes: Vec<f64> = (0..p).map(|j| column(j).norm()).collect();
        if self.chunks.len() <= 2 * p || sizes.iter().any(|s| !(*s > 0.0 && s.is_finite())) {
            return None;
        }
        let mut normal = DMatrix::identity(p, p) * (1.0 + 1e-9);
        for a in 0..p {
            for b in 0..a {
                let product = column(a).dot(&column(b)) / (sizes[a] * sizes[b]);
                normal[(a, b)] = product;
                normal[(b, a)] = product;
            }
        }
        let right = DVector::from_fn(p, |j, _| column(j).dot(&self.target) / sizes[j]);
        let scaled = normal.cholesky()?.solve(&right);
        let left = self.target.norm_squared() - scaled.dot(&right);
        let solution = DVector::from_fn(p, |j, _| scaled[j] / sizes[j]);
        solution
            .iter()
            .all(|v| v.is_finite())
            .then_some((solution, left.max(0.0)))
    }

    /// Level of dry friction that the unexplained force suggests.
    pub fn friction_level(&self) -> f64 {
        let sign = self.signature(|_, v| v.signum());
        let level = self
            .regress(&[&sign])
            .map_or(0.0, |fit| -fit.coefficients[0]);
        level.max(LEAST_FRICTION * self.scales.force)
    }

    /// Largest commanded input.
    pub fn largest_input(&self) -> f64 {
        self.input.iter().fold(0.0, |m: f64, u| m.max(u.abs()))
    }

    /// Torque that `load` would put on the motor, moved as measured.
    pub fn load_torque(&self, load: &Load) -> Vec<f64> {
        load_torque(load, &self.position, self.scales.step)
    }

    /// Natural frequencies that a load may have, rad/s: from a few periods in the record to a few
    /// samples in a period.
    pub fn load_frequencies(&self) -> Vec<f64> {
        let (low, high) = (40.0 / self.scales.duration, 1.0 / self.scales.step);
        let ratio = (high / low).max(1.0).powf(1.0 / f64::from(LOAD_FREQUENCIES - 1));
        (0..LOAD_FREQUENCIES)
            .map(|i| low * ratio.powf(f64::from(i)))
            .collect()
    }

    /// The `count` spatial frequencies (radians per unit of position) at which the unexplained force
    /// repeats most clearly, with the coefficients of sine and cosine.
    pub fn spatial_frequencies(&self, count: usize) -> Vec<(f64, f64, f64)> {
        let travel = self.scales.travel;
        let fastest = FASTEST_SPATIAL / (self.scales.speed * self.scales.step);
        let spacing = (1.2 / travel).max(fastest / MAX_SPATIAL as f64);
        let scan: Vec<(f64, f64, f64, f64)> = (1..=MAX_SPATIAL)
            .map(|k| k as f64 * spacing)
            .take_while(|n| *n <= fastest)
            .filter_map(|n| self.spatial(n))
            .collect();
        let mut peaks: Vec<(f64, f64, f64, f64)> = (0..scan.len())
            .filter(|i| {
                let left = |j: Option<usize>| j.and_then(|j| scan.get(j)).map_or(f64::MAX, |s| s.3);
                let here = scan[*i].3;
                here <= left(i.checked_sub(1)) && here <= left(Some(i + 1))
            })
            .map(|i| scan[i])
            .collect();
        peaks.sort_by(|a, b| a.3.total_cmp(&b.3));
        peaks
            .into_iter()
            .take(count)
            .map(|peak| {
                // The peak lies between the scanned frequencies.
                let finer = (-4..=4)
                    .filter_map(|k| self.spatial(peak.0 + 0.2 * f64::from(k) * spacing))
                    .min_by(|a, b| a.3.total_cmp(&b.3))
                    .unwrap_or(peak);
                (finer.0, finer.1, finer.2)
            })
            .collect()
    }

    /// Frequency, coefficients of sine and cosine, share left.
    fn spatial(&self, n: f64) -> Option<(f64, f64, f64, f64)> {
        let length = |c: &(usize, usize)| (c.1 - c.0) as f64 * self.scales.step;
        let columns = DMatrix::from_fn(self.chunks.len(), 2, |_, _| 0.0);
        let mut columns = columns;
        for (row, chunk) in self.chunks.iter().enumerate() {
            let middle = 0.5 * (self.position[chunk.0] + self.position[chunk.1]);
            let (sine, cosine) = (n * middle).sin_cos();
            columns[(row, 0)] = sine * length(chunk);
            columns[(row, 1)] = cosine * length(chunk);
        }
        let (solution, left) = self.solve(&columns)?;
        let b = self.inverse_inertia + solution[0];
        Some((n, solution[BASE] / b, solution[BASE + 1] / b, left))
    }
}

/// Chunk length over which velocity differences stand above `noise`.
fn chunk_length(v: &[f64], noise: f64) -> usize {
    let n = v.len();
    CHUNKS
        .iter()
        .copied()
        .filter(|c| c * 20 < n)
        .find(|c| {
            let sum: f64 = (0..n - c).map(|i| (v[i + c] - v[i]).powi(2)).sum();
            (sum / (n - c) as f64).sqrt() > CLEAR_OF_NOISE * noise
        })
        .unwrap_or((n / 40).clamp(1, 100))
}
