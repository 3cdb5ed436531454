//! The motor-side columns on an even grid.

use crate::measurement::{Kind, Measurement, Quantity};
use crate::order::median;

use super::gap::GapError;

/// Share of the median step by which a step may differ and still count as even (printed times are rounded).
const EVEN: f64 = 0.1;

/// Most samples of the even grid, as a multiple of those measured; beyond it most of it would be invented.
const MOST_FILLED: f64 = 2.0;

/// Input, position and velocity of the motor, evenly sampled.
pub(super) struct Record {
    pub start: f64,
    pub step: f64,
    pub input: Vec<f64>,
    /// rad or m; from the velocity where no position was recorded.
    pub position: Vec<f64>,
    /// rad/s or m/s; from the position where no velocity was recorded.
    pub velocity: Vec<f64>,
    pub has_velocity: bool,
    pub unit: String,
}

impl Record {
    /// Reads `u`, `x1` and `v1` and nothing else.
    pub fn new(measurement: &Measurement) -> Result<Self, GapError> {
        if measurement.kind != Kind::Drive {
            return Err(GapError::NotADrive);
        }
        let position = measurement.output(Quantity::Position);
        let velocity = measurement.output(Quantity::Velocity);
        let unit = match (position, velocity) {
            (Some(x), _) => x.unit.clone(),
            (None, Some(v)) => v.unit.trim_end_matches("/s").to_owned(),
            (None, None) => return Err(GapError::NoMotorColumn),
        };
        let time = &measurement.time;
        let n = time.len();
        let usable = |values: &[f64]| values.len() == n && values.iter().all(|v| v.is_finite());
        let columns = std::iter::once(&measurement.input)
            .chain(position)
            .chain(velocity);
        if n < 3 || !usable(time) || !columns.into_iter().all(|c| usable(&c.values)) {
            return Err(GapError::Damaged);
        }
        let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
        if steps.iter().any(|s| *s <= 0.0) {
            return Err(GapError::Damaged);
        }
        let usual = median(&mut steps);
        let start = time[0];
        let duration = time[n - 1] - start;
        let even = steps.iter().all(|s| (s / usual - 1.0).abs() <= EVEN);
        let (grid, step) = if even {
            (None, duration / (n - 1) as f64)
        } else {
            let count = duration / usual;
            if count > MOST_FILLED * n as f64 {
                return Err(GapError::UnevenTime);
            }
            let times = (0..=count as usize).map(|i| start + i as f64 * usual);
            (Some(times.collect::<Vec<f64>>()), usual)
        };
        let held = |values: &[f64]| resample(time, values, grid.as_deref(), true);
        let linear = |values: &[f64]| resample(time, values, grid.as_deref(), false);
        let input = held(&measurement.input.values);
        let (position, velocity, has_velocity) = match (position, velocity) {
            (Some(x), Some(v)) => (linear(&x.values), linear(&v.values), true),
            (Some(x), None) => {
                let x = linear(&x.values);
                let v = slopes(&x, step);
                (x, v, false)
            }
            (None, Some(v)) => {
                let v = linear(&v.values);
                (integral(&v, step), v, true)
            }
            (None, None) => return Err(GapError::NoMotorColumn),
        };
        Ok(Self {
            start,
            step,
            input,
            position,
            velocity,
            has_velocity,
            unit,
        })
    }

    pub fn len(&self) -> usize {
        self.input.len()
    }

    /// Time in s of a sample, or between two.
    pub fn time(&self, sample: f64) -> f64 {
        self.start + sample * self.step
    }

    /// Position and velocity between two samples, as they went on from the ones before: something happens there.
    pub fn reaching(&self, sample: f64) -> (f64, f64) {
        let last = self.len() - 1;
        let i = (sample.max(0.0) as usize).min(last);
        let share = (sample - i as f64).clamp(0.0, 1.0);
        if !self.has_velocity || share == 0.0 {
            return (
                between(&self.position, sample),
                between(&self.velocity, sample),
            );
        }
        let v = self.velocity[i];
        let reached = v + share * (v - self.velocity[i.saturating_sub(1)]);
        let way = 0.5 * (v + reached) * share * self.step;
        (self.position[i] + way, reached)
    }
}

/// On the straight line between two samples.
fn between(values: &[f64], sample: f64) -> f64 {
    let last = values.len() - 1;
    let at = sample.clamp(0.0, last as f64);
    let i = (at as usize).min(last.saturating_sub(1));
    let share = at - i as f64;
    values[i] * (1.0 - share) + values[(i + 1).min(last)] * share
}

/// Values at the times of a grid, held or on straight lines; unchanged without a grid.
fn resample(time: &[f64], values: &[f64], grid: Option<&[f64]>, hold: bool) -> Vec<f64> {
    let Some(grid) = grid else {
        return values.to_vec();
    };
    let mut i = 0;
    grid.iter()
        .map(|t| {
            while i + 2 < time.len() && time[i + 1] <= *t {
                i += 1;
            }
            let share = ((t - time[i]) / (time[i + 1] - time[i])).clamp(0.0, 1.0);
            if hold {
                values[if share >= 1.0 { i + 1 } else { i }]
            } else {
                values[i] * (1.0 - share) + values[i + 1] * share
            }
        })
        .collect()
}

/// Half width of the differences that make a velocity of a position, samples: less would be all quantisation.
pub(super) const DIFFERENCE: usize = 2;

/// Central differences.
fn slopes(x: &[f64], step: f64) -> Vec<f64> {
    let last = x.len() - 1;
    (0..x.len())
        .map(|i| {
            let (a, b) = (i.saturating_sub(DIFFERENCE), (i + DIFFERENCE).min(last));
            (x[b] - x[a]) / (step * (b - a) as f64)
        })
        .collect()
}

/// Trapezoids.
fn integral(v: &[f64], step: f64) -> Vec<f64> {
    let mut sum = 0.0;
    (0..v.len())
        .map(|i| {
            if i > 0 {
                sum += 0.5 * step * (v[i] + v[i - 1]);
            }
            sum
        })
        .collect()
}
