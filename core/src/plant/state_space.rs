//! Plants as first-order differential equations.

use nalgebra::{DMatrix, DVector};

use super::{MAX_ORDER, PlantError, TransferFunction};

/// `x' = A x + B u`, `y = C x`.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// Dynamics, n x n, 1/s.
    pub a: DMatrix<f64>,
    /// Input, n.
    pub b: DVector<f64>,
    /// Output, n.
    pub c: DVector<f64>,
}

/// `x' = A x + B u`, `y = C x` with as many inputs as outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Multivariable {
    /// Dynamics, n x n, 1/s.
    pub a: DMatrix<f64>,
    /// Inputs, n x m.
    pub b: DMatrix<f64>,
    /// Outputs, m x n.
    pub c: DMatrix<f64>,
}

/// A leading coefficient below this share of what its summands could give is round-off.
const VANISHED: f64 = 1e-12;

impl StateSpace {
    /// Checks sizes and values.
    pub fn validate(&self) -> Result<(), PlantError> {
        check_shapes(&self.a, (self.b.len(), 1), (1, self.c.len()), 1)?;
        check_finite(self.a.iter().chain(&self.b).chain(&self.c))
    }

    /// The same plant as a transfer function with the dead time given, s.
    ///
    /// The denominator is the characteristic polynomial by La Budde's method (Rehman and Ipsen 2011),
    /// the numerator follows from it and the Markov parameters `C A^k B`. Leading coefficients of the
    /// numerator that are round-off are taken for 0.
    pub fn transfer_function(&self, dead_time: f64) -> Result<TransferFunction, PlantError> {
        self.validate()?;
        let n = self.b.len();
        // Time is scaled by the norm, so that powers of A neither overflow nor vanish.
        let norm = self.a.norm();
        let scale = if norm > 0.0 { norm } else { 1.0 };
        let a = &self.a / scale;
        let monic = characteristic(&a);
        let mut numerator = vec![0.0; n];
        let mut x = &self.b / scale;
        let mut markov = Vec::with_capacity(n);
        let mut sizes = Vec::with_capacity(n);
        for _ in 0..n {
            markov.push(self.c.dot(&x));
            sizes.push(self.c.norm() * x.norm());
            x = &a * x;
        }
        let mut leading = true;
        for k in 0..n {
            let (mut sum, mut size) = (0.0, 0.0);
            for i in 0..=k {
                sum += monic[i] * markov[k - i];
                size += monic[i].abs() * sizes[k - i];
            }
            let vanished = sum.abs() <= VANISHED * size;
            if !(leading && vanished) {
                leading = false;
                numerator[k] = sum;
            }
        }
        let power = |k: usize| scale.powi(i32::try_from(k).unwrap_or(i32::MAX));
        let plant = TransferFunction {
            numerator: numerator
                .iter()
                .enumerate()
                .map(|(k, c)| c * power(k + 1))
                .collect(),
            denominator: monic
                .iter()
                .enumerate()
                .map(|(k, c)| c * power(k))
                .collect(),
            dead_time,
        };
        plant.validate()?;
        Ok(plant)
    }

    /// `-C A^-1 B`: output in the end per constant input; infinite where `A` is singular.
    pub fn dc_gain(&self) -> f64 {
        if self.validate().is_err() {
            return f64::NAN;
        }
        let x = self.a.clone().lu().solve(&self.b);
        x.map_or(f64::INFINITY, |x| -self.c.dot(&x))
    }
}

impl Multivariable {
    /// Checks sizes and values.
    pub fn validate(&self) -> Result<(), PlantError> {
        check_shapes(&self.a, self.b.shape(), self.c.shape(), self.c.nrows())?;
        check_finite(self.a.iter().chain(&self.b).chain(&self.c))
    }
}

fn check_shapes(
    a: &DMatrix<f64>,
    b: (usize, usize),
    c: (usize, usize),
    channels: usize,
) -> Result<(), PlantError> {
    let n = a.nrows();
    let check = |matrix, shape: (usize, usize), wanted: (usize, usize)| {
        if shape == wanted {
            Ok(())
        } else {
            Err(PlantError::Shape {
                matrix,
                rows: shape.0,
                columns: shape.1,
                wanted: format!("{} x {}", wanted.0, wanted.1),
            })
        }
    };
    if n == 0 || n > MAX_ORDER {
        return Err(PlantError::Order(n));
    }
    if channels == 0 || channels > n {
        return Err(PlantError::Shape {
            matrix: "C",
            rows: channels,
            columns: c.1,
            wanted: format!("1 to {n} rows"),
        });
    }
    check("A", a.shape(), (n, n))?;
    check("B", b, (n, channels))?;
    check("C", c, (channels, n))
}

fn check_finite<'a>(mut values: impl Iterator<Item = &'a f64>) -> Result<(), PlantError> {
    if values.any(|v| !v.is_finite()) {
        return Err(PlantError::NotFinite);
    }
    Ok(())
}

/// Monic characteristic polynomial, highest power first, from the Hessenberg form.
fn characteristic(a: &DMatrix<f64>) -> Vec<f64> {
    let n = a.nrows();
    let h = if n > 1 {
        nalgebra::Hessenberg::new(a.clone()).unpack_h()
    } else {
        a.clone()
    };
    // Polynomials of the leading blocks, lowest power first.
    let mut p: Vec<Vec<f64>> = vec![vec![1.0]];
    for i in 0..n {
        let mut next = vec![0.0; i + 2];
        for (k, c) in p[i].iter().enumerate() {
            next[k + 1] += c;
            next[k] -= h[(i, i)] * c;
        }
        let mut chain = 1.0;
        for m in 1..=i {
            chain *= h[(i - m + 1, i - m)];
            let weight = h[(i - m, i)] * chain;
            for (k, c) in p[i - m].iter().enumerate() {
                next[k] -= weight * c;
            }
        }
        p.push(next);
    }
    let mut last = p.pop().unwrap_or_default();
    last.reverse();
    last
}
