//! Plants by their poles and zeros.

use std::f64::consts::PI;

use num_complex::Complex;

use super::{MAX_ORDER, PlantError, TransferFunction};

/// `gain prod(s - z) / prod(s - p) e^{-Ls}`.
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroPoleGain {
    /// Zeros, 1/s; complex ones in conjugate pairs.
    pub zeros: Vec<Complex<f64>>,
    /// Poles, 1/s; complex ones in conjugate pairs.
    pub poles: Vec<Complex<f64>>,
    /// Ratio of the leading coefficients.
    pub gain: f64,
    /// Dead time `L`, s; at least 0.
    pub dead_time: f64,
}

/// Conjugates may differ by this share of their size.
const PAIR_TOLERANCE: f64 = 1e-9;

impl ZeroPoleGain {
    /// The same plant as polynomials.
    pub fn transfer_function(&self) -> Result<TransferFunction, PlantError> {
        let numerator = expand("zero", &self.zeros)?;
        let denominator = expand("pole", &self.poles)?;
        let plant = TransferFunction {
            numerator: numerator.iter().map(|c| c * self.gain).collect(),
            denominator,
            dead_time: self.dead_time,
        };
        plant.validate()?;
        Ok(plant)
    }

    /// Number of poles minus number of zeros.
    pub fn relative_degree(&self) -> usize {
        self.poles.len().saturating_sub(self.zeros.len())
    }

    /// Zeros to the right of the imaginary axis.
    pub fn right_half_plane_zeros(&self) -> usize {
        self.zeros.iter().filter(|z| z.re > 0.0).count()
    }

    /// Phase at `omega > 0` rad/s, unwrapped: rad, continuous from low frequencies, where it begins at
    /// -90 degrees per integrator (+90 per zero at 0) and 180 degrees lower where the low-frequency gain
    /// is negative.
    ///
    /// Each factor `1 - jw/r` moves on a straight line from 1 that never meets the negative real axis,
    /// so that its angle needs no unwrapping; right-half-plane zeros and dead time add lag.
    pub fn phase(&self, omega: f64) -> f64 {
        let mut phase = -omega * self.dead_time;
        let mut sign = self.gain.signum();
        for (roots, direction) in [(&self.zeros, 1.0), (&self.poles, -1.0)] {
            for r in roots {
                if r.norm() == 0.0 {
                    phase += direction * 0.5 * PI;
                } else {
                    let factor = Complex::new(1.0, 0.0) - Complex::new(0.0, omega) / r;
                    // A pole on the axis turns by -180 degrees, as a stable one beside it does.
                    let angle = if r.re == 0.0 && factor.re < 0.0 {
                        PI
                    } else {
                        factor.arg()
                    };
                    phase += direction * angle;
                    if r.im == 0.0 {
                        sign *= -r.re.signum();
                    }
                }
            }
        }
        if sign < 0.0 { phase - PI } else { phase }
    }

    /// Modulus at `omega` rad/s.
    pub fn magnitude(&self, omega: f64) -> f64 {
        let s = Complex::new(0.0, omega);
        let product =
            |roots: &[Complex<f64>]| roots.iter().map(|r| (s - r).norm()).product::<f64>();
        self.gain.abs() * product(&self.zeros) / product(&self.poles)
    }
}

/// Real polynomial with the given roots, highest power first, leading 1.
fn expand(kind: &'static str, roots: &[Complex<f64>]) -> Result<Vec<f64>, PlantError> {
    if roots.len() > MAX_ORDER {
        return Err(PlantError::Order(roots.len()));
    }
    if roots
        .iter()
        .any(|r| !(r.re.is_finite() && r.im.is_finite()))
    {
        return Err(PlantError::NotFinite);
    }
    let mut p = vec![1.0];
    let mut lower: Vec<Complex<f64>> = roots.iter().filter(|r| r.im < 0.0).copied().collect();
    for r in roots {
        if r.im == 0.0 {
            p = product(&p, &[1.0, -r.re]);
        } else if r.im > 0.0 {
            let mirror = lower
                .iter()
                .position(|l| (l - r.conj()).norm() <= PAIR_TOLERANCE * r.norm());
            let Some(index) = mirror else {
                return Err(conjugate(kind, r));
            };
            lower.remove(index);
            p = product(&p, &[1.0, -2.0 * r.re, r.norm_sqr()]);
        }
    }
    match lower.first() {
        Some(r) => Err(conjugate(kind, r)),
        None => Ok(p),
    }
}

fn conjugate(kind: &'static str, r: &Complex<f64>) -> PlantError {
    PlantError::Conjugate {
        kind,
        re: r.re,
        im: r.im,
    }
}

/// Product of two polynomials.
pub(super) fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut p = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            p[i + j] += x * y;
        }
    }
    p
}
