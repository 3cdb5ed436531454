//! The first guess of a baseline's values.

use nalgebra::{Matrix3, Vector3};

use super::data::Data;
use crate::effect::baseline::Baseline;
use crate::measurement::Kind;

/// Chunk lengths, in samples, over which velocity differences are regressed; the first whose
/// differences stand well above the noise is taken.
const CHUNKS: [usize; 7] = [1, 2, 5, 10, 20, 50, 100];

/// How far above the noise, root mean square.
const CLEAR_OF_NOISE: f64 = 10.0;

/// First guess by linear regression of `v(t2) - v(t1) = b int w dt - lambda int v dt + f (t2 - t1)` on chunks,
/// with `w` the input that reaches the body (one value per interval).
///
/// `None` where the regression has no sensible solution.
pub(super) fn guess(data: &Data, w: &[f64]) -> Option<Vec<f64>> {
    let v = data.velocity_estimate();
    let n = data.len();
    let duration = data.time[n - 1] - data.time[0];
    let sums = Sums::over_chunks(&data.time, &v, w, chunk_length(data, &v));
    let (b, lambda) = sums.sensible(data, duration);
    if !b.is_finite() || b == 0.0 {
        return None;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    Some(match data.baseline {
        Baseline::Drive => vec![1.0 / b, lambda / b],
        Baseline::Integrator => vec![b],
        Baseline::Lag { from_ambient } => {
            let gain = b / lambda;
            // What the output is in the mean beside what the input gives; the ends weigh less the longer the record.
            let ambient = if from_ambient {
                0.0
            } else {
                let change = (v[n - 1] - v[0]) / (lambda * duration);
                mean(&v) - gain * mean(w) + change
            };
            vec![gain, 1.0 / lambda, ambient]
        }
    })
}

/// Samples of a chunk over which the velocity changes by far more than its noise.
fn chunk_length(data: &Data, v: &[f64]) -> usize {
    let noise = data
        .outputs
        .iter()
        .find(|o| o.is_velocity)
        .map_or(0.0, |o| o.noise);
    let n = data.len();
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

/// Sums of the regression.
struct Sums {
    /// Of products of `int w dt`, `-int v dt` and `t2 - t1`: the constant term keeps an offset of the input from
    /// bending the other two.
    normal: Matrix3<f64>,
    /// Of their products with the differences of the velocity.
    right: Vector3<f64>,
    /// Of the squares of these differences.
    power: f64,
}

impl Sums {
    fn over_chunks(time: &[f64], v: &[f64], w: &[f64], chunk: usize) -> Self {
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        let mut power = 0.0;
        let mut i = 0;
        while i + chunk < time.len() {
            let (mut iw, mut iv) = (0.0, 0.0);
            for j in i..i + chunk {
                let dt = time[j + 1] - time[j];
                iw += w[j] * dt;
                iv += 0.5 * (v[j] + v[j + 1]) * dt;
            }
            let row = Vector3::new(iw, -iv, time[i + chunk] - time[i]);
            normal += row * row.transpose();
            right += row * (v[i + chunk] - v[i]);
            power += (v[i + chunk] - v[i]).powi(2);
            i += chunk;
        }
        Self {
            normal,
            right,
            power,
        }
    }

    /// `b` and `lambda` of least squares; by the input alone where that has no solution.
    fn solved(&self) -> (f64, f64) {
        // Columns differ by orders of magnitude: scaled to unit length before solving.
        let scale = self
            .normal
            .diagonal()
            .map(|d| 1.0 / d.max(f64::MIN_POSITIVE).sqrt());
        let scaled = Matrix3::from_diagonal(&scale) * self.normal * Matrix3::from_diagonal(&scale);
        let solution = scaled
            .try_inverse()
            .map(|m| (m * self.right.component_mul(&scale)).component_mul(&scale));
        let input_alone = (self.right[0] / self.normal[(0, 0)], 0.0);
        let (b, lambda) = solution.map_or(input_alone, |x| (x[0], x[1]));
        if b.is_finite() && lambda.is_finite() {
            (b, lambda)
        } else {
            input_alone
        }
    }

    /// `b` and `lambda` with the signs that a body can have: no drive has a negative inertia, and nothing a negative
    /// friction.
    fn sensible(&self, data: &Data, duration: f64) -> (f64, f64) {
        let (saa, sab, say) = (self.normal[(0, 0)], self.normal[(0, 1)], self.right[0]);
        let (mut b, mut lambda) = self.solved();
        if data.kind == Kind::Drive && b <= 0.0 {
            b = (say / saa).abs();
        }
        let integrates = data.baseline == Baseline::Integrator;
        if integrates {
            b = say / saa;
        } else if lambda <= 0.0 {
            lambda = match data.kind {
                Kind::Drive => 0.0,
                Kind::Process => 10.0 / duration,
            };
            b = (say - lambda * sab) / saa;
        }
        if data.kind == Kind::Drive && (b.is_nan() || b <= 0.0) {
            // A resonance turns the motor against its torque: the sizes alone say how heavy it is.
            (b, lambda) = ((self.power / saa).sqrt(), 0.0);
        }
        (b, lambda)
    }
}
