//! The value of a formula.

use super::parse::{Expr, Function, Variable};
use crate::model::Instant;

impl Expr {
    /// The force at this instant with these parameters; 0 where the formula has no finite value.
    pub fn force(&self, at: &Instant, parameters: &[f64]) -> f64 {
        let force = self.value(at, parameters);
        if force.is_finite() { force } else { 0.0 }
    }

    /// The value at this instant with these parameters; may be no number where the formula has none.
    pub fn value(&self, at: &Instant, parameters: &[f64]) -> f64 {
        let of = |e: &Self| e.value(at, parameters);
        match self {
            Self::Number(value) => *value,
            Self::Variable(Variable::Position) => at.position,
            Self::Variable(Variable::Velocity) => at.velocity,
            Self::Variable(Variable::Input) => at.input,
            Self::Variable(Variable::Time) => at.time,
            Self::Parameter(index) => parameters.get(*index).copied().unwrap_or(f64::NAN),
            Self::Negative(a) => -of(a),
            Self::Sum(a, b) => of(a) + of(b),
            Self::Difference(a, b) => of(a) - of(b),
            Self::Product(a, b) => of(a) * of(b),
            Self::Quotient(a, b) => of(a) / of(b),
            Self::Power(a, b) => power(of(a), b, || of(b)),
            Self::Call(function, arguments) => {
                let first = arguments.first().map_or(f64::NAN, of);
                match function {
                    Function::Sin => libm::sin(first),
                    Function::Cos => libm::cos(first),
                    Function::Tan => libm::tan(first),
                    Function::Atan => libm::atan(first),
                    Function::Tanh => libm::tanh(first),
                    Function::Exp => libm::exp(first),
                    Function::Ln => libm::log(first),
                    Function::Sqrt => first.sqrt(),
                    Function::Abs => first.abs(),
                    Function::Sign if first == 0.0 => 0.0,
                    Function::Sign => first.signum(),
                    Function::Min => first.min(arguments.get(1).map_or(f64::NAN, of)),
                    Function::Max => first.max(arguments.get(1).map_or(f64::NAN, of)),
                }
            }
        }
    }

    /// The value of a part without variables and parameters.
    pub fn constant(&self) -> Option<f64> {
        let both =
            |a: &Self, b: &Self, f: fn(f64, f64) -> f64| Some(f(a.constant()?, b.constant()?));
        match self {
            Self::Number(value) => Some(*value),
            Self::Negative(a) => a.constant().map(|v| -v),
            Self::Sum(a, b) => both(a, b, |a, b| a + b),
            Self::Difference(a, b) => both(a, b, |a, b| a - b),
            Self::Product(a, b) => both(a, b, |a, b| a * b),
            Self::Quotient(a, b) => both(a, b, |a, b| a / b),
            _ => None,
        }
    }
}

/// Whole powers by multiplication, the same on every machine and for negative bases.
fn power(base: f64, exponent: &Expr, value: impl Fn() -> f64) -> f64 {
    match exponent.constant() {
        Some(n) if n.fract() == 0.0 && n.abs() <= 64.0 => base.powi(n as i32),
        Some(n) => libm::pow(base, n),
        None => libm::pow(base, value()),
    }
}
