//! The equation of motion as a regression without derivatives, to which terms of formulas come.
//!
//! ```text
//! acceleration = (u - d v + held effects + terms) / J        y' = (K u - y + ambient + K terms) / T
//! ```
//!
//! Both sides are multiplied with a smooth bump and integrated by parts, as in the screen; the acceleration, in which
//! the noise is, is the target, and every window counts by what its noise lets it tell. Body, held effects and
//! coefficients of terms are fitted together.

use super::grammar::{Form, Plain};
use super::tuning::{EXACT, LEAST_TOLD, MOST_ROWS, WIDEST_SHARE};
use crate::criticism::screen::{AtomColumns, Rows, Signals, Width, widths};
use crate::effect::baseline::Baseline;
use crate::effect::{Variable, variables};
use crate::measurement::Kind;
use crate::order::{quantile, range, sign};
use crate::sums::dot;

/// What terms see of a record.
pub(super) struct Seen {
    signals: Signals,
    widths: Vec<Width>,
    time: Vec<f64>,
    /// Factors of each variable, at their [`place`].
    factors: Vec<[Vec<f64>; 2]>,
}

/// Where a factor of a variable stands.
fn place(variable: Variable, plain: Plain) -> usize {
    variable as usize * Plain::ALL.len() + plain as usize
}

impl Seen {
    pub fn new(signals: Signals) -> Self {
        let widths = thinned(widths(&signals), signals.len());
        let time = (0..signals.len()).map(|k| signals.step * k as f64);
        let mut seen = Self {
            time: time.collect(),
            widths,
            signals,
            factors: Vec::new(),
        };
        let all = variables(seen.signals.kind);
        for variable in [
            Variable::Position,
            Variable::Velocity,
            Variable::Input,
            Variable::Time,
        ] {
            let factors = |plain: Plain| {
                if all.iter().any(|(_, own)| *own == variable) {
                    seen.factors(variable, plain)
                } else {
                    [Vec::new(), Vec::new()]
                }
            };
            let of_variable = Plain::ALL.map(factors);
            seen.factors.extend(of_variable);
        }
        seen
    }

    pub fn rows(&self) -> Rows<'_> {
        Rows::new(&self.signals, &self.widths)
    }

    fn series(&self, variable: Variable) -> &[f64] {
        let signals = &self.signals;
        match variable {
            Variable::Position => &signals.place,
            Variable::Velocity => &signals.speed,
            Variable::Input => &signals.input,
            Variable::Time => &self.time,
        }
    }

    /// A factor at every sample: with the input that is held from there on, and with that which was held until there.
    fn factors(&self, variable: Variable, plain: Plain) -> [Vec<f64>; 2] {
        let signals = &self.signals;
        let series = self.series(variable);
        let is_speed = variable == Variable::Velocity && signals.kind == Kind::Drive;
        let at = |k: usize| {
            let z = series.get(k).copied().unwrap_or(0.0);
            let side = if is_speed {
                signals.direction[k]
            } else {
                sign(z)
            };
            plain.at(z, side)
        };
        let now = (0..self.time.len()).map(at).collect();
        let before = if variable == Variable::Input {
            (0..self.time.len())
                .map(|k| at(k.saturating_sub(1)))
                .collect()
        } else {
            Vec::new()
        };
        [now, before]
    }

    /// A form at every sample, with each column that it makes; the input jumps there, so that what follows it is the
    /// mean of both sides.
    fn values(&self, form: &Form, numbers: [f64; 2]) -> [Vec<f64>; 2] {
        let both = if form.has(Variable::Input) { 2 } else { 1 };
        let n = self.time.len();
        let mut columns = [vec![0.0; n], vec![0.0; n]];
        for side in 0..both {
            let mut product = vec![1.0 / both as f64; n];
            for (variable, plain) in &form.plain {
                let factors = &self.factors[place(*variable, *plain)];
                let factors = factors[side].as_slice();
                let factors = if factors.is_empty() {
                    &self.factors[place(*variable, *plain)][0]
                } else {
                    factors
                };
                product.iter_mut().zip(factors).for_each(|(p, f)| *p *= f);
            }
            match form.bend {
                None => columns[0]
                    .iter_mut()
                    .zip(&product)
                    .for_each(|(c, p)| *c += p),
                Some((bend, variable)) => {
                    let late = usize::from(side == 1 && variable == Variable::Input);
                    let series = self.series(variable);
                    for (k, p) in product.iter().enumerate() {
                        let [one, two] = bend.at(series[k.saturating_sub(late)], numbers);
                        columns[0][k] += p * one;
                        columns[1][k] += p * two;
                    }
                }
            }
        }
        for value in columns.iter_mut().flatten().filter(|v| !v.is_finite()) {
            *value = 0.0;
        }
        columns
    }

    /// Sizes of a variable: its least and largest value without the outermost, and the size that few values exceed.
    pub fn reach(&self, variable: Variable) -> Reach {
        let share = |values: &[f64], share: f64| quantile(&mut values.to_vec(), share);
        let values = self.series(variable);
        let sizes: Vec<f64> = values.iter().map(|z| z.abs()).collect();
        let ends = range(values);
        Reach {
            low: share(values, 0.01).max(ends.0),
            high: share(values, 0.99).min(ends.1),
            size: share(&sizes, 0.95),
        }
    }
}

/// Sizes of a variable in a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub low: f64,
    pub high: f64,
    pub size: f64,
}

/// A regression of the acceleration.
pub(super) struct Weak {
    pub seen: Seen,
    /// Block of the record of each window.
    blocks: Vec<usize>,
    /// Root of the weight of each window.
    weights: Vec<f64>,
    /// Windows as they are: the input (with what held effects make of it), the velocity, the ambient, columns of held
    /// effects.
    plain: Vec<Vec<f64>>,
    /// What each column of the body is.
    pub body: Vec<BodyColumn>,
    /// The acceleration.
    target: Vec<f64>,
    /// Orthonormal and weighted.
    base: Vec<Vec<f64>>,
    /// The weighted target without what the body explains.
    pub left: Vec<f64>,
}

/// What a column beside terms is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BodyColumn {
    Input,
    Velocity,
    Ambient,
    Held,
}

/// Coefficients with what they leave.
pub(super) struct Solved {
    /// Of the body, then of the terms.
    pub coefficients: Vec<f64>,
    /// Squared residual, weighted.
    pub loss: f64,
    /// Standard errors as if all windows told something of their own.
    pub errors: Vec<f64>,
}

impl Solved {
    /// What these columns come to in a window.
    fn at<'a>(&self, columns: impl IntoIterator<Item = &'a Vec<f64>>, window: usize) -> f64 {
        let parts = columns.into_iter().zip(&self.coefficients);
        parts.map(|(c, w)| c[window] * w).sum()
    }
}

impl Weak {
    /// Of a baseline, with the atoms of held effects.
    pub fn new(seen: Seen, baseline: Baseline, held: &[AtomColumns]) -> Self {
        let rows = seen.rows();
        let mut input = rows.held(&rows.signals.input);
        for tied in held.iter().filter_map(|h| h.tied.as_ref()) {
            for (sum, change) in input.iter_mut().zip(tied) {
                *sum += change;
            }
        }
        let mut plain = vec![input];
        let mut body = vec![BodyColumn::Input];
        if baseline != Baseline::Integrator {
            plain.push(rows.motion(1));
            body.push(BodyColumn::Velocity);
        }
        if baseline
            == (Baseline::Lag {
                from_ambient: false,
            })
        {
            plain.push(rows.one());
            body.push(BodyColumn::Ambient);
        }
        for column in held.iter().flat_map(|h| &h.free) {
            plain.push(column.clone());
            body.push(BodyColumn::Held);
        }
        let target = rows.motion(2);
        let mut weak = Self {
            weights: by_noise(&rows, &target),
            blocks: rows.blocks.clone(),
            plain,
            body,
            target,
            base: Vec::new(),
            left: Vec::new(),
            seen,
        };
        weak.project();
        weak
    }

    /// Rows of the regression.
    pub fn len(&self) -> usize {
        self.target.len()
    }

    fn weighted(&self, column: &[f64]) -> Vec<f64> {
        column
            .iter()
            .zip(&self.weights)
            .map(|(c, w)| c * w)
            .collect()
    }

    fn project(&mut self) {
        self.base.clear();
        for k in 0..self.plain.len() {
            let column = self.weighted(&self.plain[k]);
            let told = orthonormal(column, &self.base, 1e-6);
            self.base.extend(told);
        }
        self.left = without(self.weighted(&self.target), &self.base);
    }

    /// Squared residual of the body alone.
    pub fn first_loss(&self) -> f64 {
        dot(&self.left, &self.left)
    }

    /// Windows of a form, unweighted: one column, or two of a wave.
    pub fn columns(&self, form: &Form, numbers: [f64; 2]) -> Vec<Vec<f64>> {
        let count = form.bend.map_or(1, |(bend, _)| bend.columns());
        let values = self.seen.values(form, numbers);
        let columns = values.into_iter().take(count);
        let rows = self.seen.rows();
        columns.map(|values| rows.force(values)).collect()
    }

    /// A column weighted, without what the body and these directions explain, of length 1; none where hardly anything
    /// is left.
    fn direction(&self, column: &[f64], beside: &[Vec<f64>]) -> Option<Vec<f64>> {
        let own = orthonormal(self.weighted(column), &self.base, LEAST_TOLD)?;
        orthonormal(own, beside, LEAST_TOLD)
    }

    /// The same of each, beside those before it.
    pub fn directions(&self, columns: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let mut all: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
        for column in columns {
            all.push(self.direction(column, &all)?);
        }
        Some(all)
    }

    /// The columns of the body, then these, weighted.
    fn beside_body(&self, columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let all = self.plain.iter().chain(columns);
        all.map(|c| self.weighted(c)).collect()
    }

    /// Body and coefficients of these columns, together; none where they are not told apart, or the body is none.
    pub fn solve(&self, columns: &[Vec<f64>]) -> Option<Solved> {
        least_squares(&self.beside_body(columns), &self.weighted(&self.target))
    }

    /// Weighted windows of the acceleration that a regression explains.
    pub fn said(&self, columns: &[Vec<f64>], solved: &Solved) -> Vec<f64> {
        let all = || self.plain.iter().chain(columns);
        (0..self.len())
            .map(|k| solved.at(all(), k) * self.weights[k])
            .collect()
    }

    /// Windows of a curve of straight pieces along a variable, but those that the body explains.
    pub fn pieces(&self, variable: Variable, count: usize) -> Option<Vec<Vec<f64>>> {
        let reach = self.seen.reach(variable);
        let width = (reach.high - reach.low) / (count - 1) as f64;
        if !(width > 0.0 && width.is_finite()) {
            return None;
        }
        let rows = self.seen.rows();
        let hat = |k: usize| -> Vec<f64> {
            let centre = reach.low + width * k as f64;
            let values = self.seen.series(variable).iter();
            let at =
                |z: &f64| (1.0 - (z.clamp(reach.low, reach.high) - centre).abs() / width).max(0.0);
            rows.force(values.map(at).collect())
        };
        let mut told: Vec<Vec<f64>> = Vec::new();
        let mut columns = Vec::new();
        for column in (0..count).map(hat) {
            if let Some(own) = self.direction(&column, &told) {
                told.push(own);
                columns.push(column);
            }
        }
        Some(columns)
    }

    /// Squared residuals of each block of the record, by the fit to every other one that does not hold it; none where
    /// either half does not tell the columns.
    pub fn foretold(&self, columns: &[Vec<f64>]) -> Option<Vec<f64>> {
        let blocks = &self.blocks;
        let all = self.beside_body(columns);
        let target = self.weighted(&self.target);
        let mut losses = vec![0.0; blocks.iter().max().map_or(0, |b| b + 1)];
        for half in [0, 1] {
            let of = |column: &[f64]| -> Vec<f64> {
                column
                    .iter()
                    .zip(blocks)
                    .map(|(c, b)| if b % 2 == half { *c } else { 0.0 })
                    .collect()
            };
            let own: Vec<Vec<f64>> = all.iter().map(|c| of(c)).collect();
            let solved = least_squares(&own, &of(&target))?;
            for (k, block) in blocks.iter().enumerate().filter(|(_, b)| *b % 2 != half) {
                losses[*block] += (target[k] - solved.at(&all, k)).powi(2);
            }
        }
        Some(losses)
    }
}

/// The roots of weights by the noise of the acceleration alone, and by what a sum is exact to.
fn by_noise(rows: &Rows, target: &[f64]) -> Vec<f64> {
    let squares: f64 = target.iter().map(|a| a * a).sum();
    let exact = EXACT * (squares / target.len().max(1) as f64).sqrt();
    let noise: Vec<f64> = rows
        .widths
        .iter()
        .map(|w| w.noise_of_motion(rows.signals, 2))
        .collect();
    let weight = |width: &usize| {
        1.0 / (noise[*width].powi(2) + exact * exact)
            .sqrt()
            .max(f64::MIN_POSITIVE)
    };
    rows.width_of.iter().map(weight).collect()
}

/// Widths of windows for a search: as those of the screen, but fewer windows.
fn thinned(mut widths: Vec<Width>, samples: usize) -> Vec<Width> {
    let narrow = widths
        .iter()
        .any(|w| w.length as f64 <= WIDEST_SHARE * samples as f64);
    widths.retain(|w| !narrow || w.length as f64 <= WIDEST_SHARE * samples as f64);
    let each = MOST_ROWS / widths.len().max(1);
    for width in &mut widths {
        let every = width.starts.len().div_ceil(each.max(1)).max(1);
        let kept = width.starts.iter().step_by(every).copied();
        width.starts = kept.collect();
    }
    widths
}

/// What is left of a column beside orthonormal ones.
fn without(mut column: Vec<f64>, base: &[Vec<f64>]) -> Vec<f64> {
    // Twice is enough (Kahan; Parlett 1980).
    for _ in 0..2 {
        for direction in base {
            let share = dot(&column, direction);
            for (c, d) in column.iter_mut().zip(direction) {
                *c -= share * d;
            }
        }
    }
    column
}

/// The same with length 1; none where less than a share is left.
fn orthonormal(column: Vec<f64>, base: &[Vec<f64>], least: f64) -> Option<Vec<f64>> {
    let before = dot(&column, &column).sqrt();
    let mut column = without(column, base);
    let after = dot(&column, &column).sqrt();
    let told = after > least * before && before.is_finite() && after > 0.0;
    for c in &mut column {
        *c /= after;
    }
    told.then_some(column)
}

/// Least squares by Cholesky on columns of length 1; none where they depend on each other.
fn least_squares(columns: &[Vec<f64>], target: &[f64]) -> Option<Solved> {
    let n = columns.len();
    let scale: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
    if scale.iter().any(|s| !(*s > 0.0 && s.is_finite())) {
        return None;
    }
    let normal = nalgebra::DMatrix::from_fn(n, n, |i, j| {
        dot(&columns[i], &columns[j]) / (scale[i] * scale[j])
    });
    let right = nalgebra::DVector::from_fn(n, |i, _| dot(&columns[i], target) / scale[i]);
    let factor = normal.cholesky()?;
    if (0..n).any(|i| factor.l_dirty()[(i, i)].powi(2) < 1e-9) {
        return None;
    }
    let solution = factor.solve(&right);
    let loss = (dot(target, target) - solution.dot(&right)).max(0.0);
    let inverse = factor.inverse();
    let variance = loss / (target.len().saturating_sub(n)).max(1) as f64;
    Some(Solved {
        coefficients: (0..n).map(|i| solution[i] / scale[i]).collect(),
        errors: (0..n)
            .map(|i| (variance * inverse[(i, i)]).max(0.0).sqrt() / scale[i])
            .collect(),
        loss,
    })
}
