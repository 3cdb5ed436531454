//! The PID controller and its forms.

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::error::{TuningError, check};

/// A PID controller in the ideal (standard, ISA) form, with a filter on the derivative:
///
/// `u = K (b r - y + 1/Ti int (r - y) dt - Td/(Tf s + 1) dy/dt)`
///
/// The derivative acts on the measured output only, so that a step of the set point `r` does not kick
/// the actuator; `b` weighs the set point in the proportional part. Around the loop it is
/// `C(s) = K (1 + 1/(Ti s) + Td s/(Tf s + 1))`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pid {
    /// Gain `K`, unit of the input over unit of the output.
    pub gain: f64,
    /// Integral time `Ti`, s, above 0; `None` without integral action.
    pub integral_time: Option<f64>,
    /// Derivative time `Td`, s, at least 0; 0 without derivative action.
    pub derivative_time: f64,
    /// Time constant `Tf` of the derivative's filter, s; above 0 where `Td` is.
    pub filter_time: f64,
    /// Weight `b` of the set point in the proportional part, 0 to 1.
    pub setpoint_weight: f64,
}

/// Gains of the parallel form `C(s) = kp + ki/s + kd s/(Tf s + 1)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parallel {
    /// Proportional gain.
    pub proportional: f64,
    /// Integral gain, per s.
    pub integral: f64,
    /// Derivative gain, times s.
    pub derivative: f64,
    /// Filter of the derivative, s.
    pub filter_time: f64,
}

/// The series (interacting) form `C(s) = K' (1 + 1/(Ti' s)) (1 + Td' s)`, without the filter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Gain `K'`.
    pub gain: f64,
    /// Integral time `Ti'`, s.
    pub integral_time: f64,
    /// Derivative time `Td'`, s.
    pub derivative_time: f64,
}

impl Pid {
    /// A proportional controller.
    pub fn p(gain: f64) -> Self {
        Self {
            gain,
            integral_time: None,
            derivative_time: 0.0,
            filter_time: 0.0,
            setpoint_weight: 1.0,
        }
    }

    /// A PI controller; `integral_time` in s.
    pub fn pi(gain: f64, integral_time: f64) -> Self {
        Self {
            integral_time: Some(integral_time),
            ..Self::p(gain)
        }
    }

    /// A PID controller; times in s, the derivative's filter at `derivative_time / filter`.
    pub fn with_derivative(
        gain: f64,
        integral_time: f64,
        derivative_time: f64,
        filter: f64,
    ) -> Self {
        Self {
            derivative_time,
            filter_time: derivative_time / filter,
            ..Self::pi(gain, integral_time)
        }
    }

    /// From the parallel form.
    ///
    /// # Errors
    /// A proportional gain of 0, which the ideal form cannot express, or what [`Self::validate`] finds.
    pub fn from_parallel(form: &Parallel) -> Result<Self, TuningError> {
        check(
            "proportional gain",
            form.proportional,
            form.proportional != 0.0,
            "other than 0",
        )?;
        let pid = Self {
            gain: form.proportional,
            integral_time: (form.integral != 0.0).then_some(form.proportional / form.integral),
            derivative_time: form.derivative / form.proportional,
            filter_time: form.filter_time,
            setpoint_weight: 1.0,
        };
        pid.validate()?;
        Ok(pid)
    }

    /// Gains of the parallel form: `kp = K`, `ki = K/Ti`, `kd = K Td`.
    pub fn parallel(&self) -> Parallel {
        Parallel {
            proportional: self.gain,
            integral: self.integral_time.map_or(0.0, |ti| self.gain / ti),
            derivative: self.gain * self.derivative_time,
            filter_time: self.filter_time,
        }
    }

    /// The series form; `None` without integral action or where `Ti < 4 Td`, whose zeros are complex.
    pub fn series(&self) -> Option<Series> {
        let ti = self.integral_time?;
        let root = 1.0 - 4.0 * self.derivative_time / ti;
        (root >= 0.0).then(|| {
            let share = 0.5 * (1.0 + root.sqrt());
            Series {
                gain: self.gain * share,
                integral_time: ti * share,
                derivative_time: self.derivative_time / share,
            }
        })
    }

    /// Checks every field.
    ///
    /// # Errors
    /// [`TuningError::Setting`] with the first value out of its range.
    pub fn validate(&self) -> Result<(), TuningError> {
        check("gain", self.gain, true, "a number")?;
        if let Some(ti) = self.integral_time {
            check("integral time", ti, ti > 0.0, "above 0 s")?;
        }
        let (td, tf) = (self.derivative_time, self.filter_time);
        check("derivative time", td, td >= 0.0, "0 s or more")?;
        let range = "above 0 s with derivative action, 0 s or more without";
        check(
            "filter time",
            tf,
            tf > 0.0 || (tf == 0.0 && td == 0.0),
            range,
        )?;
        let b = self.setpoint_weight;
        check("set-point weight", b, (0.0..=1.0).contains(&b), "0 to 1")
    }

    /// Response `C(jw)` at `omega` rad/s around the loop.
    pub fn response(&self, omega: f64) -> Complex<f64> {
        let s = Complex::new(0.0, omega);
        let integral = self
            .integral_time
            .map_or(Complex::new(0.0, 0.0), |ti| 1.0 / (s * ti));
        let derivative = s * self.derivative_time / (s * self.filter_time + 1.0);
        (integral + derivative + 1.0) * self.gain
    }

    /// Numerator and denominator of `C(s)`, highest power first.
    pub(super) fn polynomials(&self) -> (Vec<f64>, Vec<f64>) {
        let (k, td) = (self.gain, self.derivative_time);
        let tf = if td > 0.0 { self.filter_time } else { 0.0 };
        let (numerator, denominator) = match self.integral_time {
            Some(ti) => (
                vec![k * ti * (td + tf), k * (ti + tf), k],
                vec![ti * tf, ti, 0.0],
            ),
            None => (vec![k * (td + tf), k], vec![tf, 1.0]),
        };
        let skip = usize::from(td == 0.0);
        (numerator[skip..].to_vec(), denominator[skip..].to_vec())
    }
}
