//! Plants in discrete time.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;

use crate::plant::{PlantError, TransferFunction};

/// `x[k+1] = A x[k] + B u[k]`, `y[k] = C x[k]`, from a transfer function in `z`.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscretePlant {
    /// Dynamics from sample to sample.
    pub a: DMatrix<f64>,
    /// Input.
    pub b: DVector<f64>,
    /// Output.
    pub c: DVector<f64>,
    /// Sampling time, s.
    pub sampling: f64,
}

impl DiscretePlant {
    /// A transfer function in `z` with its sampling time in s: numerator and denominator, highest power first, the
    /// numerator of lower degree (the input acts from the next sample on).
    ///
    /// # Errors
    /// Coefficients that make no strictly proper transfer function, or a sampling time that is not above 0 s.
    pub fn new(numerator: &[f64], denominator: &[f64], sampling: f64) -> Result<Self, PlantError> {
        let function = TransferFunction::new(numerator, denominator, 0.0);
        function.validate()?;
        if !(sampling.is_finite() && sampling > 0.0) {
            return Err(PlantError::SamplingTime(sampling));
        }
        // The same matrices realise it, whether the variable is s or z.
        let space = function.state_space();
        Ok(Self {
            a: space.a,
            b: space.b,
            c: space.c,
            sampling,
        })
    }

    /// Frequency response at `omega` rad/s, `P(e^{j omega T})`; `None` on a pole.
    pub fn response(&self, omega: f64) -> Option<Complex<f64>> {
        let n = self.b.len();
        let z = Complex::from_polar(1.0, omega * self.sampling);
        let matrix = DMatrix::from_fn(n, n, |i, j| {
            let own = if i == j { z } else { Complex::from(0.0) };
            own - self.a[(i, j)]
        });
        let x = matrix.lu().solve(&self.b.map(Complex::from))?;
        let y: Complex<f64> = self.c.iter().zip(&x).map(|(c, x)| x * c).sum();
        (y.re.is_finite() && y.im.is_finite()).then_some(y)
    }
}
