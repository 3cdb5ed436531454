//! Regressions of what a model leaves unexplained on the answers to forces.

use nalgebra::{DMatrix, DVector};

use super::equations::{solved, spans_stride};
use super::{BASE, Probe};
use crate::effect::Shape;
use crate::model::Instant;
use crate::sums::dot;

/// Samples at most that enter a scan over very many forces.
const SCANNED: usize = 6_000;

/// Waves of force that are followed.
pub(super) const WAVES: usize = 3;

/// Outcome of a regression on force signatures.
#[derive(Clone, Debug, PartialEq)]
pub struct Regression {
    /// Force per unit of each signature.
    pub coefficients: Vec<f64>,
    /// Inertia and viscous friction that go with them.
    pub body: [f64; 2],
    /// Share of the squared error that is left, 0 to 1.
    pub left: f64,
}

impl Probe {
    /// Regresses the error on the answers to `signatures`, each with a value for every sample; `None`
    /// where they leave no trace or cannot be told from the baseline.
    pub fn regress(&self, signatures: &[&[f64]]) -> Option<Regression> {
        let forces: Vec<Box<dyn Fn(usize) -> f64 + '_>> = signatures
            .iter()
            .map(|s| -> Box<dyn Fn(usize) -> f64> { Box::new(|k| 0.5 * (s[k] + s[k + 1])) })
            .collect();
        self.regress_forces(&forces, 1)
    }

    /// The same for forces by position, velocity, acting input and time, on a part of a long record.
    pub(in crate::effect) fn regress_instants(
        &self,
        forces: &[&dyn Fn(&Instant) -> f64],
    ) -> Option<Regression> {
        let middle = |values: &[f64], k: usize| 0.5 * (values[k] + values[k + 1]);
        let at = |k: usize| Instant {
            position: middle(&self.position, k),
            velocity: middle(&self.velocity, k),
            input: self.acting.get(k).copied().unwrap_or(self.input[k]),
            time: self.scales.step * (k as f64 + 0.5),
        };
        let stride = spans_stride(&self.spans, SCANNED);
        let own: Vec<Box<dyn Fn(usize) -> f64 + '_>> = forces
            .iter()
            .map(|f| -> Box<dyn Fn(usize) -> f64> { Box::new(move |k| f(&at(k))) })
            .collect();
        self.regress_forces(&own, stride)
    }

    /// Of waves of force of these frequencies (radians per unit of what they go along), the sine and the cosine of each
    /// as a function of the moment, those that leave least: frequency and coefficients of both.
    pub(in crate::effect) fn best_waves(
        &self,
        frequencies: &[Shape],
        at: impl Fn(&Instant, f64) -> [f64; 2] + Sync,
    ) -> Vec<(f64, [f64; 2])> {
        let tried = self.crew.gather(frequencies.len(), |i| {
            let frequency = frequencies[i][0];
            let sine = |m: &Instant| at(m, frequency)[0];
            let cosine = |m: &Instant| at(m, frequency)[1];
            self.regress_instants(&[&sine, &cosine])
                .map(|found| (frequency, found))
        });
        let mut found: Vec<(f64, Regression)> = tried.into_iter().flatten().collect();
        found.sort_by(|a, b| a.1.left.total_cmp(&b.1.left));
        let best = found.into_iter().take(WAVES);
        best.map(|(frequency, fit)| (frequency, [fit.coefficients[0], fit.coefficients[1]]))
            .collect()
    }

    /// The same for forces as functions of the interval, on one window in `stride`.
    pub(super) fn regress_forces(
        &self,
        forces: &[Box<dyn Fn(usize) -> f64 + '_>],
        stride: usize,
    ) -> Option<Regression> {
        self.regress_beside(self.left_without(stride)?, forces, stride)
    }

    /// Squared remainder of the base forces alone, on one window in `stride`.
    pub(super) fn left_without(&self, stride: usize) -> Option<f64> {
        if stride == 1 {
            return Some(self.base_left);
        }
        self.solve(&[], stride).map(|(_, left)| left)
    }

    /// The same where the base forces alone leave so much.
    pub(super) fn regress_beside(
        &self,
        without: f64,
        forces: &[Box<dyn Fn(usize) -> f64 + '_>],
        stride: usize,
    ) -> Option<Regression> {
        let (solution, left) = self.solve(forces, stride)?;
        let b = self.inverse_inertia + solution[0];
        let own = solution.iter().skip(self.explained());
        let coefficients: Vec<f64> = own.map(|c| c / b).collect();
        (b * self.inverse_inertia > 0.0 && coefficients.iter().all(|c| c.is_finite())).then(|| {
            Regression {
                coefficients,
                body: [
                    1.0 / b,
                    (self.viscous * self.inverse_inertia + solution[1]) / b,
                ],
                left: left / without,
            }
        })
    }

    /// Forces that are explained in any case.
    pub(super) fn explained(&self) -> usize {
        self.base.first().map_or(BASE, Vec::len)
    }

    /// Least squares on what is explained in any case and `forces`: coefficients and squared remainder.
    pub(super) fn solve(
        &self,
        forces: &[Box<dyn Fn(usize) -> f64 + '_>],
        stride: usize,
    ) -> Option<(DVector<f64>, f64)> {
        let given = self.explained();
        let p = given + forces.len();
        let mut normal = DMatrix::zeros(p, p);
        let mut right = DVector::zeros(p);
        let (mut power, mut count) = (0.0, 0);
        for index in (0..self.spans.len()).step_by(stride) {
            let (target, base, known) =
                (&self.target[index], &self.base[index], &self.known[index]);
            let span = self.spans[index];
            let own: Vec<Vec<f64>> = forces.iter().map(|f| self.answer(span, f)).collect();
            let columns: Vec<&[f64]> = base.iter().chain(&own).map(Vec::as_slice).collect();
            for a in 0..p {
                for b in 0..=a {
                    normal[(a, b)] += if a < given {
                        known.normal[a][b]
                    } else {
                        dot(columns[a], columns[b])
                    };
                }
                right[a] += if a < given {
                    known.right[a]
                } else {
                    dot(columns[a], target)
                };
            }
            power += known.power;
            count += target.len();
        }
        if count <= 4 * p {
            return None;
        }
        let (solution, explained) = solved(normal, right)?;
        Some((solution, (power - explained).max(0.0)))
    }
}
