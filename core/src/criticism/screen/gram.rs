//! Columns of the regression, and the sums of their products in each block: all that subsets need.

use super::signals::Signals;
use super::tuning::{BLOCKS, COLLINEAR};
use super::window::Width;
use crate::effect::{Atom, Part, Series, Shape};

/// Integrals of what may stand in the equation: one value for each window of all widths.
pub(in crate::criticism) struct Rows<'a> {
    pub signals: &'a Signals,
    pub widths: &'a [Width],
    /// Block of each window, by its middle.
    pub blocks: Vec<usize>,
    /// Width of each window.
    pub width_of: Vec<usize>,
}

/// The columns of an atom with one shape.
pub(in crate::criticism) struct AtomColumns {
    /// What it adds to the input, if it takes its place.
    pub tied: Option<Vec<f64>>,
    /// The rest, each with a coefficient.
    pub free: Vec<Vec<f64>>,
    /// Whether the first of these is what the inertia of a second body needs.
    pub has_body: bool,
}

impl AtomColumns {
    /// The same from a row on.
    pub fn rows_from(&self, row: usize) -> Self {
        let rest = |column: &Vec<f64>| column[row..].to_vec();
        Self {
            tied: self.tied.as_ref().map(rest),
            free: self.free.iter().map(rest).collect(),
            has_body: self.has_body,
        }
    }
}

impl<'a> Rows<'a> {
    pub fn new(signals: &'a Signals, widths: &'a [Width]) -> Self {
        let (mut blocks, mut width_of) = (Vec::new(), Vec::new());
        for (w, width) in widths.iter().enumerate() {
            for start in &width.starts {
                let middle = start + width.length / 2;
                blocks.push((middle * BLOCKS / signals.len()).min(BLOCKS - 1));
                width_of.push(w);
            }
        }
        Self {
            signals,
            widths,
            blocks,
            width_of,
        }
    }

    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Integrals of a derivative of a series.
    pub fn integrals(&self, values: &[f64], derivative: usize) -> Vec<f64> {
        let widths = self.widths.iter();
        widths
            .flat_map(|w| w.integrals(values, derivative))
            .collect()
    }

    /// Integrals of a force; at rest it is balanced by what holds.
    pub fn force(&self, mut values: Vec<f64>) -> Vec<f64> {
        for (value, moving) in values.iter_mut().zip(&self.signals.moving) {
            *value *= moving;
        }
        self.integrals(&values, 0)
    }

    /// Integrals of the input, or what becomes of it, which is held from a sample to the next.
    pub fn held(&self, input: &[f64]) -> Vec<f64> {
        let before = input.first().into_iter().chain(input);
        self.force(
            before
                .zip(input)
                .map(|(a, b)| f64::midpoint(*a, *b))
                .collect(),
        )
    }

    pub fn one(&self) -> Vec<f64> {
        self.integrals(&vec![1.0; self.signals.len()], 0)
    }

    /// Derivative 2: acceleration; 1: velocity.
    pub fn motion(&self, derivative: usize) -> Vec<f64> {
        let widths = self.widths.iter();
        widths
            .flat_map(|w| w.motion(self.signals, derivative))
            .collect()
    }

    pub fn atom(&self, atom: &Atom, shape: &Shape) -> AtomColumns {
        let track = self.signals.track();
        let mut columns = AtomColumns {
            tied: None,
            free: Vec::new(),
            has_body: false,
        };
        for part in atom.parts {
            match part {
                Part::Force(force) => columns
                    .free
                    .push(self.force(self.at_moments(|m| force(m, shape)))),
                Part::Own(force) => columns.free.push(self.force(self.at_moments(force.0))),
                Part::Input(path) => {
                    let acting = path(&track, shape);
                    let change: Vec<f64> =
                        acting.iter().zip(track.input).map(|(a, u)| a - u).collect();
                    columns.tied = Some(self.held(&change));
                }
                Part::Motion(series) | Part::Body(series) => {
                    columns.has_body |= matches!(part, Part::Body(_));
                    let integrated = |s: Series| match s.derivative {
                        0 => self.force(s.values),
                        derivative => self.integrals(&s.values, derivative),
                    };
                    let series = series(&track, shape).into_iter();
                    columns.free.extend(series.map(integrated));
                }
            }
        }
        columns
    }

    /// A force at every sample; the input jumps there, so that one that depends on it is the mean of both sides.
    fn at_moments(&self, force: impl Fn(&crate::effect::Moment) -> f64) -> Vec<f64> {
        let signals = self.signals;
        let input = |k: usize| signals.input[k];
        let at = |k: usize, u: f64| force(&signals.moment(k, u));
        let n = signals.len();
        let probes = (0..n).step_by((n / 16).max(1));
        let follows = probes
            .into_iter()
            .any(|k| at(k, input(k)) != at(k, -0.7 * input(k) + 1e-3));
        (0..n)
            .map(|k| match k.checked_sub(1) {
                Some(before) if follows => f64::midpoint(at(k, input(before)), at(k, input(k))),
                _ => at(k, input(k)),
            })
            .collect()
    }
}

/// Weighted sums of products of columns, for each block.
pub(super) struct Gram {
    pub size: usize,
    pub blocks: Vec<Vec<f64>>,
}

impl Gram {
    /// Of these columns, each as long as `weights`.
    pub fn new(columns: &[&[f64]], weights: &[f64], owner: &[usize]) -> Self {
        let size = columns.len();
        let mut blocks = vec![vec![0.0; size * size]; BLOCKS];
        let mut weighted = vec![0.0; size];
        let mut row = vec![0.0; size];
        for (k, (weight, block)) in weights.iter().zip(owner).enumerate() {
            for ((w, v), column) in weighted.iter_mut().zip(&mut row).zip(columns) {
                *v = column[k];
                *w = weight * column[k];
            }
            let sums = &mut blocks[*block];
            for (i, w) in weighted.iter().enumerate() {
                let line = &mut sums[i * size..=i * size + i];
                for (sum, v) in line.iter_mut().zip(&row) {
                    *sum += w * v;
                }
            }
        }
        for sums in &mut blocks {
            for i in 0..size {
                for j in 0..i {
                    sums[j * size + i] = sums[i * size + j];
                }
            }
        }
        Self { size, blocks }
    }

    /// Sum over the blocks that `take` wants.
    pub fn sum(&self, take: impl Fn(usize) -> bool) -> Vec<f64> {
        let mut sum = vec![0.0; self.size * self.size];
        for (_, block) in self.blocks.iter().enumerate().filter(|(b, _)| take(*b)) {
            for (s, b) in sum.iter_mut().zip(block) {
                *s += b;
            }
        }
        sum
    }
}

/// Sums of two halves of a record, even and odd blocks, over columns that stay and to which a few others come for a
/// trial.
pub(super) struct Halves<'a> {
    columns: Vec<&'a [f64]>,
    weights: &'a [f64],
    owner: &'a [usize],
    /// Row by row, with the weights.
    weighted: Vec<f64>,
    sums: [Vec<f64>; 2],
}

impl<'a> Halves<'a> {
    pub fn new(columns: Vec<&'a [f64]>, weights: &'a [f64], owner: &'a [usize]) -> Self {
        let gram = Gram::new(&columns, weights, owner);
        let rows = weights.iter().enumerate();
        let weighted = rows.flat_map(|(k, weight)| columns.iter().map(move |c| weight * c[k]));
        Self {
            weighted: weighted.collect(),
            sums: [0, 1].map(|half| gram.sum(|b| b % 2 == half)),
            columns,
            weights,
            owner,
        }
    }

    /// How many stay.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// The sums of either half with these columns behind those that stay.
    pub fn with(&self, extra: &[&[f64]]) -> [Vec<f64>; 2] {
        let (stay, size) = (self.columns.len(), self.columns.len() + extra.len());
        let mut sums = [0, 1].map(|half: usize| {
            let mut wide = vec![0.0; size * size];
            for i in 0..stay {
                wide[i * size..i * size + stay]
                    .copy_from_slice(&self.sums[half][i * stay..(i + 1) * stay]);
            }
            wide
        });
        for (e, column) in extra.iter().enumerate() {
            let at = (stay + e) * size;
            for (k, value) in column.iter().enumerate() {
                let line = &mut sums[self.owner[k] % 2][at..at + size];
                let row = &self.weighted[k * stay..(k + 1) * stay];
                for (sum, w) in line.iter_mut().zip(row) {
                    *sum += value * w;
                }
                for (sum, other) in line[stay..].iter_mut().zip(&extra[..=e]) {
                    *sum += self.weights[k] * value * other[k];
                }
            }
        }
        for wide in &mut sums {
            for i in stay..size {
                for j in 0..i {
                    wide[j * size + i] = wide[i * size + j];
                }
            }
        }
        sums
    }
}

/// A few columns of a [`Gram`], each a sum of some of its own; the last is the target.
pub(super) struct Reduced {
    /// Regressors.
    pub order: usize,
    /// `order + 1` squared.
    pub values: Vec<f64>,
}

impl Reduced {
    pub fn new(gram: &[f64], size: usize, elements: &[Vec<usize>]) -> Self {
        let n = elements.len();
        let mut values = vec![0.0; n * n];
        for (i, a) in elements.iter().enumerate() {
            for (j, b) in elements.iter().enumerate().take(i + 1) {
                let pairs = a
                    .iter()
                    .flat_map(|x| b.iter().map(move |y| gram[x * size + y]));
                let sum: f64 = pairs.sum();
                values[i * n + j] = sum;
                values[j * n + i] = sum;
            }
        }
        Self {
            order: n - 1,
            values,
        }
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.values[i * (self.order + 1) + j]
    }

    /// Least squares by Cholesky: coefficients and, if wanted, the inverse of the normal matrix. Columns that the
    /// others explain are left out with a coefficient of 0 where that is allowed, else there is no solution.
    pub fn solve(&self, leave_out: bool) -> Option<Solution> {
        let n = self.order;
        let scale: Vec<f64> = (0..n).map(|i| self.at(i, i).max(0.0).sqrt()).collect();
        let mut lower = vec![0.0; n * n];
        let mut out = vec![false; n];
        for i in 0..n {
            if scale[i] == 0.0 {
                out[i] = true;
            }
            for j in 0..=i {
                if out[i] || out[j] {
                    continue;
                }
                let products = (0..j).map(|k| lower[i * n + k] * lower[j * n + k]);
                let rest = self.at(i, j) / (scale[i] * scale[j]) - products.sum::<f64>();
                if i == j {
                    if rest > COLLINEAR {
                        lower[i * n + i] = rest.sqrt();
                    } else {
                        out[i] = true;
                        lower[i * n..i * n + n].fill(0.0);
                    }
                } else {
                    lower[i * n + j] = rest / lower[j * n + j];
                }
            }
            if out[i] && !leave_out {
                return None;
            }
        }
        Some(Solution {
            lower,
            scale,
            out,
            order: n,
        })
    }

    /// Coefficients of a solution of this matrix.
    pub fn coefficients(&self, solution: &Solution) -> Vec<f64> {
        let n = self.order;
        let right: Vec<f64> = (0..n).map(|i| self.at(i, n)).collect();
        solution.apply(&right)
    }

    /// Squared residuals of these coefficients.
    pub fn loss(&self, w: &[f64]) -> f64 {
        let n = self.order;
        let mut loss = self.at(n, n);
        for i in 0..n {
            let inner: f64 = (0..n).map(|j| self.at(i, j) * w[j]).sum();
            loss += w[i] * (inner - 2.0 * self.at(i, n));
        }
        loss.max(0.0)
    }

    /// Derivative of half the squared residuals by the coefficients, turned: what cluster-robust errors sum up.
    pub fn scores(&self, w: &[f64]) -> Vec<f64> {
        let n = self.order;
        (0..n)
            .map(|i| self.at(i, n) - (0..n).map(|j| self.at(i, j) * w[j]).sum::<f64>())
            .collect()
    }

    /// Sum of squares of a regressor or, with `order`, of the target.
    pub fn square(&self, i: usize) -> f64 {
        self.at(i, i)
    }
}

/// A factor of a normal matrix.
pub(super) struct Solution {
    lower: Vec<f64>,
    scale: Vec<f64>,
    out: Vec<bool>,
    order: usize,
}

impl Solution {
    /// The inverse of the normal matrix times a vector.
    pub fn apply(&self, right: &[f64]) -> Vec<f64> {
        let n = self.order;
        let mut y = vec![0.0; n];
        for i in 0..n {
            if !self.out[i] {
                let inner: f64 = (0..i).map(|k| self.lower[i * n + k] * y[k]).sum();
                y[i] = (right[i] / self.scale[i] - inner) / self.lower[i * n + i];
            }
        }
        for i in (0..n).rev() {
            if !self.out[i] {
                let inner: f64 = (i + 1..n).map(|k| self.lower[k * n + i] * y[k]).sum();
                y[i] = (y[i] - inner) / self.lower[i * n + i];
            }
        }
        for (y, (scale, out)) in y.iter_mut().zip(self.scale.iter().zip(&self.out)) {
            if !out {
                *y /= scale;
            }
        }
        y
    }
}
