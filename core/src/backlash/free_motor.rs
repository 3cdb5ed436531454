//! The motor alone, and the velocity that it leaves unexplained.

use nalgebra::{DMatrix, DVector};

use super::cycles::Cycles;
use super::drift::Drift;
use super::record::{DIFFERENCE, Record};
use super::switches::Switches;
use crate::order::{NORMAL_MEDIAN, median, quantile, range};

/// How late the input may act, s; delay and lag of the drive lie within.
const LATE: f64 = 2e-3;
/// Bounds of the same in samples.
const LAGS: (usize, usize) = (FRICTION_LAGS, 14);

/// Times the median change anywhere that the median one at a switch may be unexplained if the torque is as written.
const AT_SWITCHES: f64 = 3.0;

/// Share of the velocity's swing to which a free motor is known at best: no equation of a motor is right to more
/// digits, and a record without noise would show the error of ours instead.
const DISCREPANCY: f64 = 3e-4;

/// Rounds of reweighting; the weights settle within a few.
const ROUNDS: usize = 8;

/// Tukey's biweight gives nothing to what is farther off, in standard deviations.
const BIWEIGHT: f64 = 4.685;

/// Steps by which dry friction may be late after a reversal: presliding.
const FRICTION_LAGS: usize = 3;
const REVERSAL_LAGS: usize = 2;

/// Speed, as share of the cycle's, over which friction that falls or grows with the speed bends.
const BEND: f64 = 0.2;

/// Added to the diagonal, of its own size, so that columns which are alike share.
const RIDGE: f64 = 1e-9;

/// Rounds of taking engaged cycles out.
const REFITS: usize = 2;

/// Fewest rows for each coefficient.
const ROWS: usize = 10;

/// What the motor alone says to the record.
pub(super) struct FreeMotor {
    /// Velocity that the motor alone does not explain, summed from 0; rad/s or m/s.
    pub unexplained: Vec<f64>,
    /// Standard deviation of its noise.
    pub noise: f64,
    /// Acceleration by the relay's gain, rad/s^2 or m/s^2.
    pub acceleration: f64,
    /// Standard deviation of each sample's change by switches in it, rad/s or m/s; empty where all are known.
    unsure: Vec<f64>,
}

impl FreeMotor {
    /// Change of velocity in each step, regressed on the input of the last few steps, on viscous and
    /// dry friction and a constant torque. Contacts are few samples with a large remainder: reweighted
    /// least squares with Tukey's biweight takes them out (Beaton and Tukey 1974, Technometrics 16).
    /// Where most cycles push the load they would pass for the motor's own, so that it is then fitted
    /// to the cycles that are free by their drift. `None` where that has no answer.
    ///
    /// The torque of a sample is taken as it was written, or with its switches placed inside the samples by the
    /// velocity: as the record shows it, by what either leaves unexplained where the relay switches.
    pub fn new(record: &Record, cycles: &Cycles) -> Option<Self> {
        let written = Self::with_input(record, cycles, &record.input)?;
        let switches = Switches::new(record, 2.0 * cycles.gain);
        if !record.has_velocity || !written.fails_at(&switches.at) {
            return Some(written);
        }
        let input = switches.mean_input(record);
        let placed = Self::with_input(record, cycles, &input.mean)
            .map(|p| p.unsure_of(&input.spread, cycles, record.step));
        Some(
            placed
                .filter(|p| p.left_at(&switches.at) < written.left_at(&switches.at))
                .unwrap_or(written),
        )
    }

    /// The same, not sure of the torque in some samples.
    fn unsure_of(self, spread: &[f64], cycles: &Cycles, step: f64) -> Self {
        let per_torque = self.acceleration * step / cycles.gain;
        Self {
            // Placed switches leave more than the sensor's noise, from which a contact must stand out.
            noise: self.noise.max(calm(&self.unexplained, cycles)),
            unsure: spread.iter().map(|s| s * per_torque).collect(),
            ..self
        }
    }

    /// Standard deviation of the unexplained change of velocity from sample `from` to `to` by switches that could not
    /// be placed, rad/s or m/s.
    pub fn unsure(&self, from: usize, to: usize) -> f64 {
        let part = self
            .unsure
            .get(from..to.min(self.unsure.len()))
            .unwrap_or_default();
        part.iter().map(|s| s * s).sum::<f64>().sqrt()
    }

    /// Whether more is unexplained where the relay switches than elsewhere.
    fn fails_at(&self, switches: &[usize]) -> bool {
        let mut all: Vec<f64> = self
            .unexplained
            .windows(2)
            .map(|w| (w[1] - w[0]).abs())
            .collect();
        self.left_at(switches) > AT_SWITCHES * median(&mut all)
    }

    /// Median of what is unexplained in these samples.
    fn left_at(&self, switches: &[usize]) -> f64 {
        let change =
            |i: &usize| Some((self.unexplained.get(i + 1)? - self.unexplained.get(*i)?).abs());
        let mut changes: Vec<f64> = switches.iter().filter_map(change).collect();
        median(&mut changes)
    }

    fn with_input(record: &Record, cycles: &Cycles, input: &[f64]) -> Option<Self> {
        let rows = Rows::new(record, cycles, input)?;
        let mut weights = vec![1.0; rows.target.len()];
        let mut motor = rows.fit(record, cycles, &weights)?;
        for _ in 0..REFITS {
            let drift = Drift::new(cycles, &motor.unexplained, motor.noise, &record.position);
            if !drift.engaged.contains(&true) {
                break;
            }
            weights.fill(0.0);
            for (span, engaged) in cycles.starts.windows(2).zip(&drift.engaged) {
                let (from, to) = (
                    span[0].max(rows.first),
                    span[1].min(rows.first + weights.len()),
                );
                if !engaged && from < to {
                    weights[from - rows.first..to - rows.first].fill(1.0);
                }
            }
            if weights.iter().sum::<f64>() < (ROWS * rows.width) as f64 {
                break;
            }
            motor = rows.fit(record, cycles, &weights)?;
        }
        Some(motor)
    }
}

/// The regression: one row for each step.
struct Rows {
    /// Step of the first row.
    first: usize,
    width: usize,
    /// How many of the columns are inputs.
    inputs: usize,
    matrix: Vec<f64>,
    target: Vec<f64>,
}

impl Rows {
    fn new(record: &Record, cycles: &Cycles, input: &[f64]) -> Option<Self> {
        let lags = ((LATE / record.step).ceil() as usize).clamp(LAGS.0, LAGS.1);
        // A central difference of the position sees the input of the next steps as well.
        let lead = if record.has_velocity { 0 } else { DIFFERENCE };
        let inputs = lead + lags;
        let width = inputs + FRICTION_LAGS + REVERSAL_LAGS + 3;
        let (first, end) = (lags, record.len().checked_sub(1 + lead)?);
        let rows = end.checked_sub(first).filter(|r| *r > ROWS * width)?;
        let (gain, speed) = (cycles.gain, cycles.speed);
        if gain.is_nan() || gain <= 0.0 || speed.is_nan() || speed <= 0.0 {
            return None;
        }
        let sign: Vec<f64> = record
            .velocity
            .windows(2)
            .map(|v| mean_sign(v[0], v[1]))
            .collect();
        let mut matrix = Vec::with_capacity(rows * width);
        let mut target = Vec::with_capacity(rows);
        for i in first..end {
            let v = 0.5 * (record.velocity[i] + record.velocity[i + 1]) / speed;
            matrix.extend((0..inputs).map(|lag| input[i + lead - lag] / gain));
            matrix.extend((0..FRICTION_LAGS).map(|lag| sign[i - lag]));
            // Presliding lasts the shorter the harder the motor is driven through the reversal.
            matrix.extend(
                (0..REVERSAL_LAGS)
                    .map(|lag| (sign[i - lag] - sign[i - lag - 1]) * input[i].abs() / gain),
            );
            matrix.extend([v, libm::tanh(v / BEND), 1.0]);
            target.push(record.velocity[i + 1] - record.velocity[i]);
        }
        Some(Self {
            first,
            width,
            inputs,
            matrix,
            target,
        })
    }

    /// Robust fit of the rows with a weight, and what it leaves of all of them.
    fn fit(&self, record: &Record, cycles: &Cycles, used: &[f64]) -> Option<FreeMotor> {
        let mut weights = used.to_vec();
        let mut left = self.target.clone();
        let mut solution = DVector::zeros(self.width);
        for _ in 0..ROUNDS {
            solution = solve(&self.matrix, &self.target, &weights, self.width)?;
            let rows = self.matrix.chunks_exact(self.width);
            for ((row, left), target) in rows.zip(&mut left).zip(&self.target) {
                *left = target
                    - row
                        .iter()
                        .zip(solution.iter())
                        .map(|(a, c)| a * c)
                        .sum::<f64>();
            }
            let mut sizes: Vec<f64> = left
                .iter()
                .zip(used)
                .filter(|(_, used)| **used > 0.0)
                .map(|(e, _)| e.abs())
                .collect();
            let spread = median(&mut sizes) / NORMAL_MEDIAN;
            if spread.is_nan() || spread <= 0.0 {
                return None;
            }
            for ((weight, left), used) in weights.iter_mut().zip(&left).zip(used) {
                let q = left / (BIWEIGHT * spread);
                *weight = used * (1.0 - q * q).max(0.0).powi(2);
            }
        }
        let mut unexplained = vec![0.0; record.len()];
        let mut sum = 0.0;
        for (k, left) in left.iter().enumerate() {
            sum += left;
            unexplained[self.first + k + 1] = sum;
        }
        unexplained[self.first + left.len() + 1..].fill(sum);
        let total: f64 = solution.iter().take(self.inputs).sum();
        Some(FreeMotor {
            unsure: Vec::new(),
            noise: noise(record, &unexplained, cycles).max(DISCREPANCY * 2.0 * cycles.speed),
            unexplained,
            acceleration: (total / record.step).abs(),
        })
    }
}

/// Mean of the sign of a velocity that goes from `a` to `b` on a straight line.
fn mean_sign(a: f64, b: f64) -> f64 {
    if a * b >= 0.0 {
        let sum = a + b;
        return if sum == 0.0 { 0.0 } else { sum.signum() };
    }
    (b.abs() - a.abs()) / (b - a)
}

/// Noise of the unexplained velocity: median deviation of its change over one or a few steps.
fn noise(record: &Record, unexplained: &[f64], cycles: &Cycles) -> f64 {
    let from = cycles.starts[0];
    let level = |apart: usize| {
        let mut changes: Vec<f64> = unexplained[from..]
            .windows(apart + 1)
            .map(|w| w[apart] - w[0])
            .collect();
        let middle = median(&mut changes);
        for change in &mut changes {
            *change = (*change - middle).abs();
        }
        median(&mut changes) / NORMAL_MEDIAN / std::f64::consts::SQRT_2
    };
    // A velocity made of the position has noise that is alike over a few steps.
    let far = if record.has_velocity {
        3
    } else {
        3 + 2 * DIFFERENCE
    };
    [1, 3, far].into_iter().map(level).fold(0.0, f64::max)
}

/// What the calmer cycles show from the least to the largest unexplained velocity, as the standard deviation of a noise
/// that would.
fn calm(unexplained: &[f64], cycles: &Cycles) -> f64 {
    let mut ranges: Vec<f64> = cycles
        .starts
        .windows(2)
        .map(|w| {
            let (low, high) = range(&unexplained[w[0]..=w[1]]);
            high - low
        })
        .collect();
    quantile(&mut ranges, CALM) / normal_range(cycles.length)
}

/// Share of the cycles that are calm: fewer are free in hardly any record.
const CALM: f64 = 0.25;

/// Expected range of so many standard normal values, to some per cent (Tippett 1925 has the table).
fn normal_range(count: f64) -> f64 {
    2.0 * (2.0 * libm::log(count.max(2.0))).sqrt() * TIPPETT
}

/// What the asymptotic range is too large by for 10 to 100 values.
const TIPPETT: f64 = 0.78;

/// Weighted least squares.
fn solve(matrix: &[f64], target: &[f64], weights: &[f64], width: usize) -> Option<DVector<f64>> {
    let mut normal = DMatrix::zeros(width, width);
    let mut right = DVector::zeros(width);
    for ((row, target), weight) in matrix.chunks_exact(width).zip(target).zip(weights) {
        if *weight == 0.0 {
            continue;
        }
        for (a, left) in row.iter().enumerate() {
            let weighted = weight * left;
            right[a] += weighted * target;
            for (b, other) in row.iter().enumerate().take(a + 1) {
                normal[(a, b)] += weighted * other;
            }
        }
    }
    for a in 0..width {
        for b in 0..a {
            normal[(b, a)] = normal[(a, b)];
        }
    }
    let trace = (0..width).map(|a| normal[(a, a)]).sum::<f64>() / width as f64;
    for a in 0..width {
        normal[(a, a)] += RIDGE * trace;
    }
    Some(normal.cholesky()?.solve(&right)).filter(|s| s.iter().all(|c: &f64| c.is_finite()))
}
