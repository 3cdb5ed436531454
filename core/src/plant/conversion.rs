//! A transfer function in the other forms.

use nalgebra::{DMatrix, DVector};

use super::{PlantError, StateSpace, TransferFunction, ZeroPoleGain, roots};

impl TransferFunction {
    /// The same plant by poles and zeros.
    pub fn zero_pole_gain(&self) -> Result<ZeroPoleGain, PlantError> {
        self.validate()?;
        let numerator = self.trimmed();
        let gain = numerator.first().copied().unwrap_or(0.0) / self.denominator[0];
        Ok(ZeroPoleGain {
            zeros: roots(numerator),
            poles: roots(&self.denominator),
            gain,
            dead_time: self.dead_time,
        })
    }

    /// Unwrapped phase at `omega` rad/s, in rad: see [`ZeroPoleGain::phase`], which serves better for
    /// many frequencies.
    pub fn phase(&self, omega: f64) -> Result<f64, PlantError> {
        Ok(self.zero_pole_gain()?.phase(omega))
    }

    /// Controllable canonical form, without the dead time. An invalid transfer function gives the
    /// plant of order 0, which [`StateSpace::validate`] refuses; see also `TryFrom`.
    pub fn state_space(&self) -> StateSpace {
        if self.validate().is_err() {
            return StateSpace {
                a: DMatrix::zeros(0, 0),
                b: DVector::zeros(0),
                c: DVector::zeros(0),
            };
        }
        let n = self.denominator.len() - 1;
        let lead = self.denominator[0];
        let mut a = DMatrix::zeros(n, n);
        let mut c = DVector::zeros(n);
        for i in 0..n {
            a[(0, i)] = -self.denominator[i + 1] / lead;
            if i + 1 < n {
                a[(i + 1, i)] = 1.0;
            }
        }
        let numerator = self.trimmed();
        for (i, value) in numerator.iter().rev().enumerate() {
            c[n - 1 - i] = value / lead;
        }
        let mut b = DVector::zeros(n);
        b[0] = 1.0;
        StateSpace { a, b, c }
    }
}

impl TryFrom<&TransferFunction> for StateSpace {
    type Error = PlantError;

    fn try_from(plant: &TransferFunction) -> Result<Self, PlantError> {
        plant.validate()?;
        Ok(plant.state_space())
    }
}
