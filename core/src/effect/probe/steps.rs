//! A force, or an error of an output, estimated as steps over an axis, without any model of it.
//!
//! Each part of the axis gets a force of its own; sent through the linear body and compared with the error,
//! they are regressed together. Standard errors hold for correlated and uneven errors alike, since they come
//! from the scatter between stretches of the record (cluster-robust covariance: Liang and Zeger 1986).

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::Probe;
use crate::sums::dot;

/// Parts of an axis at most.
const PARTS: usize = 30;

/// Fewest samples in a part.
const LEAST_SAMPLES: usize = 20;

/// Stretches of the record over which errors scatter: at least so many, and so many for each part.
const LEAST_STRETCHES: usize = 60;
const STRETCHES_PER_PART: usize = 2;

/// Share of the samples left out at both ends of an axis, where few values lie far apart.
const TAIL: f64 = 0.002;

/// A part of an axis with what acts there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepPart {
    /// Lower end, in the unit of the axis.
    pub from: f64,
    /// Upper end, in the unit of the axis.
    pub to: f64,
    /// Force, input or error of the output there, in its unit.
    pub value: f64,
    /// Standard error of the value.
    pub std_error: f64,
}

/// What acts along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// From low to high.
    pub parts: Vec<StepPart>,
    /// Share of the squared error that it explains beyond chance, 0 to 1.
    pub explained: f64,
}

/// Where the steps act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A force on the body, or an input of a process.
    Force,
    /// An error of the output with this index.
    Output(usize),
}

impl Probe {
    /// What would have to act along `axis` (a value for every sample) to leave the error that is left; `None`
    /// where the record is too short for an answer.
    pub fn steps(&self, axis: &[f64], place: Place) -> Option<Steps> {
        let stretches = self.stretches();
        let parts = PARTS.min(stretches.len() / STRETCHES_PER_PART);
        let edges = edges(axis, &self.spans, parts)?;
        let p = edges.len() - 1;
        let part_of = |a: f64| edges[1..p].partition_point(|e| *e <= a);
        let mut normal = DMatrix::zeros(p, p);
        let mut right = DVector::<f64>::zeros(p);
        let (mut power, mut count) = (0.0, 0);
        let mut columns_of = Vec::with_capacity(self.spans.len());
        for (span, target) in self.spans.iter().zip(&self.target) {
            let columns = self.columns(*span, p, &|k| part_of(axis[k]), place);
            for a in 0..p {
                for b in 0..=a {
                    normal[(a, b)] += dot(&columns[a], &columns[b]);
                }
                right[a] += dot(&columns[a], target);
            }
            power += dot(target, target);
            count += target.len();
            columns_of.push(columns);
        }
        let sizes: Vec<f64> = (0..p)
            .map(|j| f64::sqrt(normal[(j, j)]).max(f64::MIN_POSITIVE))
            .collect();
        let mut scaled = DMatrix::from_fn(p, p, |a, b| {
            normal[(a.max(b), a.min(b))] / (sizes[a] * sizes[b])
        });
        for j in 0..p {
            // A little damping: what the starting states of the windows hide stays near 0.
            scaled[(j, j)] += 1e-6;
        }
        let inverse = scaled.cholesky()?.inverse();
        let scaled_right = DVector::from_fn(p, |j, _| right[j] / sizes[j]);
        let solution = &inverse * &scaled_right;
        let meat = self.scatter(&stretches, &columns_of, &solution, &sizes);
        let covariance = &inverse * meat * &inverse;
        let few = stretches.len() as f64 / (stretches.len() as f64 - 1.0).max(1.0);
        let unit = match place {
            Place::Force => 1.0 / self.inverse_inertia,
            Place::Output(_) => 1.0,
        };
        let explained = solution.dot(&scaled_right) / power;
        let chance = p as f64 / count as f64;
        let parts = (0..p)
            .map(|j| StepPart {
                from: edges[j],
                to: edges[j + 1],
                value: unit * solution[j] / sizes[j],
                std_error: (few * covariance[(j, j)].max(0.0)).sqrt() * unit.abs() / sizes[j],
            })
            .collect();
        (explained.is_finite() && power > 0.0).then(|| Steps {
            parts,
            explained: ((explained - chance) / (1.0 - chance)).clamp(0.0, 1.0),
        })
    }

    /// Every other window, and the windows between.
    pub fn halves(&self) -> [Self; 2] {
        [0, 1].map(|odd| self.of_windows(|window| window % 2 == odd))
    }

    /// Share of the squared error in `others` that a force along `axis`, as the windows here show it, explains there, 0
    /// to 1; `None` where the record is too short to tell.
    pub fn foretells(&self, others: &Self, axis: &[f64]) -> Option<f64> {
        let parts = self.steps(axis, Place::Force)?.parts;
        let at = |a: &f64| parts.partition_point(|part| part.to <= *a);
        let force = |a: &f64| parts.get(at(a)).or(parts.last()).map_or(0.0, |p| p.value);
        let force: Vec<f64> = axis.iter().map(force).collect();
        let fit = others.regress(&[&force])?;
        let follows = fit.coefficients[0] > 0.0;
        Some(if follows { 1.0 - fit.left } else { 0.0 })
    }

    /// Answer of the outputs in a window to each part.
    fn columns(
        &self,
        span: (usize, usize),
        parts: usize,
        part: &dyn Fn(usize) -> usize,
        place: Place,
    ) -> Vec<Vec<f64>> {
        let length = span.1 - span.0;
        (0..parts)
            .map(|j| {
                let here = |k: usize| f64::from(u8::from(part(k) == j));
                match place {
                    // The force of an interval is the mean of its ends.
                    Place::Force => self.answer(span, |k| 0.5 * (here(k) + here(k + 1))),
                    Place::Output(index) => {
                        let mut column = vec![0.0; length * self.outputs.len()];
                        let weight = self.outputs.get(index).map_or(0.0, |o| o.1);
                        let own = column.iter_mut().skip(index * length).take(length);
                        for (k, value) in own.enumerate() {
                            *value = weight * here(span.0 + k);
                        }
                        self.without_states(&mut column, length);
                        column
                    }
                }
            })
            .collect()
    }

    /// Windows, or pieces of them: index of the window, first and last row of each output.
    fn stretches(&self) -> Vec<(usize, usize, usize)> {
        let pieces = LEAST_STRETCHES.div_ceil(self.spans.len().max(1));
        let windows = self.spans.iter().enumerate();
        windows
            .flat_map(|(w, (from, to))| {
                let length = to - from;
                (0..pieces).map(move |k| (w, k * length / pieces, (k + 1) * length / pieces))
            })
            .collect()
    }

    /// Sum over the stretches of the outer products of what each adds to the gradient.
    fn scatter(
        &self,
        stretches: &[(usize, usize, usize)],
        columns: &[Vec<Vec<f64>>],
        solution: &DVector<f64>,
        sizes: &[f64],
    ) -> DMatrix<f64> {
        let p = sizes.len();
        let mut left: Vec<Vec<f64>> = self.target.clone();
        for (left, columns) in left.iter_mut().zip(columns) {
            for (j, column) in columns.iter().enumerate() {
                let share = solution[j] / sizes[j];
                for (l, c) in left.iter_mut().zip(column) {
                    *l -= share * c;
                }
            }
        }
        let mut meat = DMatrix::zeros(p, p);
        for (w, from, to) in stretches {
            let length = self.spans[*w].1 - self.spans[*w].0;
            let gradient = DVector::from_fn(p, |j, _| {
                let rows = (0..self.outputs.len()).map(|o| (o * length + from, o * length + to));
                rows.map(|(a, b)| dot(&columns[*w][j][a..b], &left[*w][a..b]))
                    .sum::<f64>()
                    / sizes[j]
            });
            meat += &gradient * gradient.transpose();
        }
        meat
    }
}

/// Ends of parts, narrower where there are many samples; parts with too few samples join the one below.
fn edges(axis: &[f64], spans: &[(usize, usize)], parts: usize) -> Option<Vec<f64>> {
    let mut values: Vec<f64> = spans
        .iter()
        .flat_map(|(from, to)| axis[*from..*to].iter().copied())
        .filter(|v| v.is_finite())
        .collect();
    values.sort_by(f64::total_cmp);
    let tail = (TAIL * values.len() as f64) as usize;
    let (low, high) = (
        *values.get(tail)?,
        *values.get(values.len().checked_sub(1 + tail)?)?,
    );
    if parts < 2 || high <= low {
        return None;
    }
    let below = |edge: f64| values.partition_point(|v| *v < edge);
    let mut edges = vec![low];
    let mut counted = 0;
    for k in 1..parts {
        // Half way between parts of equal width and of equal count.
        let even = low + (high - low) * k as f64 / parts as f64;
        let edge = 0.5 * (even + values[k * values.len() / parts]);
        let here = below(edge);
        if here - counted >= LEAST_SAMPLES && values.len() - here >= LEAST_SAMPLES {
            edges.push(edge);
            counted = here;
        }
    }
    edges.push(high);
    (edges.len() > 2).then_some(edges)
}
