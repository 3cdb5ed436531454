//! The table `[plant]`.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use serde::Deserialize;

use super::error::ScenarioError;
use crate::on_off::DiscretePlant;
use crate::plant::{PlantError, StateSpace, TransferFunction, ZeroPoleGain, parse};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlantTable {
    numerator: Option<Vec<f64>>,
    denominator: Option<Vec<f64>>,
    formula: Option<String>,
    zeros: Option<Vec<Root>>,
    poles: Option<Vec<Root>>,
    gain: Option<f64>,
    time_constant: Option<f64>,
    a: Option<Vec<Vec<f64>>>,
    b: Option<Vec<f64>>,
    c: Option<Vec<f64>>,
    dead_time: Option<f64>,
    sampling_time: Option<f64>,
}

/// A real number, or real and imaginary part.
#[derive(Deserialize)]
#[serde(untagged)]
enum Root {
    Real(f64),
    Complex([f64; 2]),
}

impl PlantTable {
    /// The plant in discrete time, where the file gives a sampling time.
    pub fn read_discrete(&self) -> Option<Result<DiscretePlant, ScenarioError>> {
        let sampling = self.sampling_time?;
        let others = [
            self.formula.is_some(),
            self.zeros.is_some() || self.poles.is_some(),
            self.gain.is_some() || self.time_constant.is_some(),
            self.a.is_some() || self.b.is_some() || self.c.is_some(),
            self.dead_time.is_some(),
        ];
        Some(match (&self.numerator, &self.denominator) {
            (Some(numerator), Some(denominator)) if !others.contains(&true) => {
                DiscretePlant::new(numerator, denominator, sampling).map_err(Into::into)
            }
            _ => Err(ScenarioError::Form(
                "'sampling_time' belongs to a numerator and a denominator in z, and to nothing else",
            )),
        })
    }

    /// The plant in continuous time, and the states of the file if it gives them.
    pub fn read(self) -> Result<(TransferFunction, StateSpace), ScenarioError> {
        let dead_time = self.dead_time.unwrap_or(0.0);
        let polynomials = self.numerator.is_some() || self.denominator.is_some();
        let roots = self.zeros.is_some() || self.poles.is_some();
        let matrices = self.a.is_some() || self.b.is_some() || self.c.is_some();
        let forms = [
            polynomials,
            self.formula.is_some(),
            roots,
            self.time_constant.is_some(),
            matrices,
        ];
        match forms.iter().filter(|f| **f).count() {
            0 => return Err(ScenarioError::Form("no plant is given")),
            1 => {}
            _ => {
                return Err(ScenarioError::Form(
                    "the plant is given in several ways at once",
                ));
            }
        }
        if self.gain.is_some() && !(roots || self.time_constant.is_some()) {
            return Err(ScenarioError::Form("'gain' does not belong to this form"));
        }
        if let (Some(a), Some(b), Some(c)) = (&self.a, &self.b, &self.c) {
            let space = matrices_of(a, b, c)?;
            let plant = space.transfer_function(dead_time)?;
            return Ok((plant, space));
        }
        let plant = match self {
            Self {
                numerator: Some(n),
                denominator: Some(d),
                ..
            } => TransferFunction::new(&n, &d, dead_time),
            Self {
                formula: Some(text),
                ..
            } => {
                let mut plant = parse(&text).map_err(ScenarioError::Formula)?;
                plant.dead_time += dead_time;
                plant
            }
            Self {
                poles: Some(poles),
                zeros,
                gain: Some(gain),
                ..
            } => ZeroPoleGain {
                zeros: zeros.unwrap_or_default().iter().map(Root::value).collect(),
                poles: poles.iter().map(Root::value).collect(),
                gain,
                dead_time,
            }
            .transfer_function()?,
            Self {
                gain: Some(gain),
                time_constant: Some(time),
                ..
            } => TransferFunction::new(&[gain], &[time, 1.0], dead_time),
            _ => return Err(ScenarioError::Form("the plant is not complete")),
        };
        plant.validate()?;
        let space = plant.state_space();
        Ok((plant, space))
    }
}

impl Root {
    fn value(&self) -> Complex<f64> {
        match self {
            Self::Real(re) => Complex::new(*re, 0.0),
            Self::Complex([re, im]) => Complex::new(*re, *im),
        }
    }
}

fn matrices_of(a: &[Vec<f64>], b: &[f64], c: &[f64]) -> Result<StateSpace, PlantError> {
    let n = a.len();
    if let Some(row) = a.iter().find(|r| r.len() != n) {
        return Err(PlantError::Shape {
            matrix: "a row of A",
            rows: 1,
            columns: row.len(),
            wanted: format!("1 x {n}"),
        });
    }
    let space = StateSpace {
        a: DMatrix::from_row_iterator(n, n, a.iter().flatten().copied()),
        b: DVector::from_row_slice(b),
        c: DVector::from_row_slice(c),
    };
    space.validate()?;
    Ok(space)
}
