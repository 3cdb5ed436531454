//! Exact flow of `x' = A x + B u`, `y = C x` under held inputs.
//!
//! Steps are `h_0 2^j` long. The shortest is short against the norm of `A`, so that Taylor series give
//! its transition matrix to round-off; each longer one is the square of the one before. Every level
//! also carries the Chebyshev coefficients of the outputs over its step as a linear function of
//! state and input: one small matrix product says where the outputs go during the whole step.
//! Only additions and multiplications are used, so that every platform has the same bits.

use nalgebra::{DMatrix, DVector};

use super::series::{NODES, Series, TERMS, chebyshev};
use crate::plant::{MAX_ORDER, StateSpace};

/// A state, filled up with zeros.
pub(crate) type State = [f64; MAX_ORDER];

/// Norm of `A h_0`: `1/18!` is round-off.
const SHORTEST: f64 = 1.0;

/// A Taylor series ends at terms below this.
const SMALLEST_TERM: f64 = 1e-18;

/// Doublings of the shortest step.
const MAX_LEVELS: usize = 40;

/// Levels end where an unstable plant grows beyond this.
const LARGEST: f64 = 1e100;

/// Round-off of a matrix product, relative to its summands.
const PRODUCT_NOISE: f64 = 4e-16;

/// Sweeps of the balancing, each over all states; it settles in a few.
const BALANCE_SWEEPS: usize = 20;

/// A plant's flow.
#[derive(Clone, Debug)]
pub(crate) struct Flow {
    /// Order.
    pub n: usize,
    inputs: usize,
    outputs: usize,
    /// Fours of states to work on.
    quads: usize,
    /// Columns of `A`.
    a: Vec<State>,
    /// A norm of `A`, 1/s.
    norm: f64,
    /// Columns of `B`.
    b: Vec<State>,
    /// Rows of `C`.
    c: Vec<State>,
    /// State in the units of the caller per state in here.
    scale: State,
    levels: Vec<Level>,
}

#[derive(Clone, Debug)]
struct Level {
    h: f64,
    /// Columns of the transition matrix, then responses to the inputs.
    columns: Vec<State>,
    /// Chebyshev coefficients of each output (outer) by each state and input (inner).
    rows: Vec<Series>,
    /// Sum of their sizes.
    sizes: Vec<f64>,
}

#[inline]
fn add_scaled(sum: &mut State, column: &State, factor: f64, quads: usize) {
    for (s, c) in sum
        .chunks_exact_mut(4)
        .zip(column.chunks_exact(4))
        .take(quads)
    {
        s[0] += c[0] * factor;
        s[1] += c[1] * factor;
        s[2] += c[2] * factor;
        s[3] += c[3] * factor;
    }
}

fn dot(a: &State, b: &State) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

impl Flow {
    /// Flow of a plant with finite coefficients and order at most [`MAX_ORDER`], quick for durations up
    /// to some `longest` s.
    pub fn new(a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>, longest: f64) -> Self {
        let n = a.nrows().min(MAX_ORDER);
        let mut flow = Self {
            n,
            inputs: b.ncols(),
            outputs: c.nrows(),
            quads: n.div_ceil(4),
            a: (0..n).map(|j| state(|i| a[(i, j)], n)).collect(),
            norm: 0.0,
            b: (0..b.ncols()).map(|j| state(|i| b[(i, j)], n)).collect(),
            c: (0..c.nrows()).map(|i| state(|j| c[(i, j)], n)).collect(),
            scale: [1.0; MAX_ORDER],
            levels: Vec::new(),
        };
        flow.balance();
        flow.norm = flow.balanced_norm();
        flow.build(longest);
        flow
    }

    /// Flow of a plant with one input and one output.
    pub fn single(plant: &StateSpace, longest: f64) -> Self {
        let n = plant.b.len();
        Self::new(
            &plant.a,
            &DMatrix::from_fn(n, 1, |i, _| plant.b[i]),
            &DMatrix::from_fn(1, n, |_, j| plant.c[j]),
            longest,
        )
    }

    /// Scales the states by powers of two until rows and columns of `A` are alike (Parlett and
    /// Reinsch 1969): a companion matrix takes the time scale of its poles.
    fn balance(&mut self) {
        for _ in 0..BALANCE_SWEEPS {
            let mut settled = true;
            for i in 0..self.n {
                let column: f64 = (0..self.n)
                    .filter(|j| *j != i)
                    .map(|j| self.a[i][j].abs())
                    .sum();
                let row: f64 = (0..self.n)
                    .filter(|j| *j != i)
                    .map(|j| self.a[j][i].abs())
                    .sum();
                if column == 0.0 || row == 0.0 || !(column + row).is_finite() {
                    continue;
                }
                let mut factor = 1.0_f64;
                while column * factor * factor < 0.5 * row && factor < 1e30 {
                    factor *= 2.0;
                }
                while column * factor * factor > 2.0 * row && factor > 1e-30 {
                    factor *= 0.5;
                }
                if factor == 1.0 {
                    continue;
                }
                settled = false;
                self.scale[i] *= factor;
                for value in &mut self.a[i] {
                    *value *= factor;
                }
                for column in self.a.iter_mut().chain(&mut self.b) {
                    column[i] /= factor;
                }
                for row in &mut self.c {
                    row[i] *= factor;
                }
            }
            if settled {
                break;
            }
        }
    }

    fn balanced_norm(&self) -> f64 {
        let columns = self.a.iter().map(|c| c.iter().map(|v| v.abs()).sum());
        let rows = (0..self.n).map(|i| self.a.iter().map(|c| c[i].abs()).sum());
        columns.fold(0.0, f64::max).min(rows.fold(0.0, f64::max))
    }

    fn build(&mut self, longest: f64) {
        let norm = self.norm;
        let longest = if longest.is_finite() && longest > 0.0 {
            longest
        } else {
            1.0
        };
        let h = if norm > 0.0 && norm.is_finite() {
            SHORTEST / norm
        } else {
            longest
        };
        let mut level = self.shortest(h);
        while self.levels.len() < MAX_LEVELS {
            let h = level.h;
            let next = (h < longest).then(|| self.doubled(&level));
            self.levels.push(level);
            match next {
                Some(next) if next.size() < LARGEST => level = next,
                _ => break,
            }
        }
    }

    fn shortest(&self, h: f64) -> Level {
        let columns = (0..self.n)
            .map(|j| {
                let mut x = [0.0; MAX_ORDER];
                x[j] = 1.0;
                self.taylor(&x, None, h)
            })
            .chain((0..self.inputs).map(|j| self.taylor(&[0.0; MAX_ORDER], Some(&self.b[j]), h)))
            .collect();
        let mut samples = Vec::with_capacity(self.outputs * (self.n + self.inputs));
        for c in &self.c {
            let mut states = [[0.0; TERMS]; MAX_ORDER];
            let mut inputs = vec![[0.0; TERMS]; self.inputs];
            let mut row = *c;
            for k in 0..TERMS {
                for (s, r) in states.iter_mut().zip(&row) {
                    s[k] = *r;
                }
                if k + 1 < TERMS {
                    let factor = h / (k + 1) as f64;
                    for (s, b) in inputs.iter_mut().zip(&self.b) {
                        s[k + 1] = dot(&row, b) * factor;
                    }
                    row = state(|j| dot(&row, &self.a[j]) * factor, self.n);
                }
            }
            let at_nodes = |taylor: &Series| {
                let mut values = [0.0; TERMS];
                for (v, z) in values.iter_mut().zip(NODES) {
                    let t = 0.5 * (1.0 + z);
                    *v = taylor.iter().rev().fold(0.0, |sum, c| sum * t + c);
                }
                values
            };
            samples.extend(states[..self.n].iter().chain(&inputs).map(at_nodes));
        }
        Level::new(h, columns, &samples)
    }

    fn doubled(&self, level: &Level) -> Level {
        let width = self.n + self.inputs;
        let columns = (0..width)
            .map(|j| {
                let mut x = level.apply_transition(&level.columns[j], self.n, self.quads);
                if j >= self.n {
                    add_scaled(&mut x, &level.columns[j], 1.0, self.quads);
                }
                x
            })
            .collect();
        let mut samples = vec![[0.0; TERMS]; self.outputs * width];
        for (i, z) in NODES.into_iter().enumerate() {
            // Nodes of the first half lie in the short step, those of the second in the one after it.
            let late = z > 0.0;
            let basis = chebyshev(if late { 2.0 * z - 1.0 } else { 2.0 * z + 1.0 });
            for (rows, samples) in level.rows.chunks(width).zip(samples.chunks_mut(width)) {
                let mut at = [0.0; MAX_ORDER];
                let value = |r: &Series| r.iter().zip(&basis).map(|(c, t)| c * t).sum::<f64>();
                for (v, r) in at.iter_mut().zip(&rows[..self.n]) {
                    *v = value(r);
                }
                for j in 0..width {
                    let own = if j < self.n { at[j] } else { value(&rows[j]) };
                    samples[j][i] = match (late, j < self.n) {
                        (false, _) => own,
                        (true, true) => dot(&at, &level.columns[j]),
                        (true, false) => own + dot(&at, &level.columns[j]),
                    };
                }
            }
        }
        Level::new(2.0 * level.h, columns, &samples)
    }

    /// `A x`.
    pub fn multiply(&self, x: &State) -> State {
        let mut v = [0.0; MAX_ORDER];
        for (column, x) in self.a.iter().zip(x) {
            add_scaled(&mut v, column, *x, self.quads);
        }
        v
    }

    /// State after a short time `t` by Taylor series: from `x`, pushed by `force = B u`.
    fn taylor(&self, x: &State, force: Option<&State>, t: f64) -> State {
        let mut sum = *x;
        let mut term = self.multiply(x);
        if let Some(force) = force {
            add_scaled(&mut term, force, 1.0, self.quads);
        }
        // Bounds what a term can be of the first one, or of the state.
        let mut bound = 1.0;
        for k in 1..=TERMS {
            let factor = t / k as f64;
            for value in &mut term[..4 * self.quads] {
                *value *= factor;
            }
            add_scaled(&mut sum, &term, 1.0, self.quads);
            bound *= self.norm * factor;
            if bound <= SMALLEST_TERM {
                break;
            }
            term = self.multiply(&term);
        }
        sum
    }

    /// `B u`.
    pub fn force(&self, u: &[f64]) -> State {
        let mut v = [0.0; MAX_ORDER];
        for (b, u) in self.b.iter().zip(u) {
            add_scaled(&mut v, b, *u, self.quads);
        }
        v
    }

    /// Velocity `A x + B u`.
    pub fn velocity(&self, x: &State, u: &[f64]) -> State {
        let mut v = self.force(u);
        for (column, x) in self.a.iter().zip(x) {
            add_scaled(&mut v, column, *x, self.quads);
        }
        v
    }

    /// Output `i`, `C_i x`.
    pub fn output(&self, x: &State, i: usize) -> f64 {
        self.c.get(i).map_or(0.0, |c| dot(c, x))
    }

    /// State after `t` s under held inputs.
    pub fn after(&self, x: &State, u: &[f64], mut t: f64) -> State {
        let mut x = *x;
        let last = self.levels.len().saturating_sub(1);
        for (i, level) in self.levels.iter().enumerate().rev() {
            if i == last && t >= level.h {
                let times = (t / level.h).floor();
                t = (t - times * level.h).max(0.0);
                for _ in 0..(times as u64).min(MAX_REPEATS) {
                    x = level.apply(&x, u, self.n, self.quads);
                }
            } else if t >= level.h {
                t -= level.h;
                x = level.apply(&x, u, self.n, self.quads);
            }
        }
        if t > 0.0 {
            self.taylor(&x, Some(&self.force(u)), t)
        } else {
            x
        }
    }

    /// Number of levels.
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// Length of the steps of a level, s.
    pub fn step(&self, level: usize) -> f64 {
        self.levels.get(level).map_or(0.0, |l| l.h)
    }

    /// State after a whole step of a level.
    pub fn after_step(&self, level: usize, x: &State, u: &[f64]) -> State {
        self.levels
            .get(level)
            .map_or(*x, |l| l.apply(x, u, self.n, self.quads))
    }

    /// Chebyshev coefficients of output `i` over a step of a level, and their round-off.
    pub fn series(&self, level: usize, i: usize, x: &State, u: &[f64]) -> (Series, f64) {
        let mut sum = [0.0; TERMS];
        let mut noise = 0.0;
        if let Some(level) = self.levels.get(level) {
            let width = self.n + self.inputs;
            let rows = &level.rows[i * width..(i + 1) * width];
            let sizes = &level.sizes[i * width..(i + 1) * width];
            let values = x[..self.n].iter().chain(u);
            for ((row, size), value) in rows.iter().zip(sizes).zip(values) {
                for (s, r) in sum.iter_mut().zip(row) {
                    *s += r * value;
                }
                noise += size * value.abs();
            }
        }
        (sum, PRODUCT_NOISE * noise)
    }

    /// Columns of the transition matrix over `t` s, then responses to unit inputs from rest.
    pub fn transition(&self, t: f64) -> Vec<State> {
        let none = [0.0; MAX_ORDER];
        let zero = vec![0.0; self.inputs];
        let mut columns: Vec<State> = (0..self.n)
            .map(|j| {
                let mut x = none;
                x[j] = 1.0;
                self.after(&x, &zero, t)
            })
            .collect();
        for j in 0..self.inputs {
            let mut u = zero.clone();
            u[j] = 1.0;
            columns.push(self.after(&none, &u, t));
        }
        columns
    }

    /// Row `C_i`.
    pub fn row(&self, i: usize) -> State {
        self.c.get(i).copied().unwrap_or([0.0; MAX_ORDER])
    }

    /// A state in here from one in the caller's units.
    pub fn inner(&self, x: &DVector<f64>) -> State {
        state(|i| x.get(i).copied().unwrap_or(0.0) / self.scale[i], self.n)
    }

    /// A state in the caller's units.
    pub fn outer(&self, x: &State) -> DVector<f64> {
        DVector::from_fn(self.n, |i, _| x[i] * self.scale[i])
    }
}

/// Repetitions of the longest step within one call; beyond them time counts as passed.
const MAX_REPEATS: u64 = 100_000;

fn state(value: impl Fn(usize) -> f64, n: usize) -> State {
    let mut x = [0.0; MAX_ORDER];
    for (i, x) in x.iter_mut().enumerate().take(n) {
        *x = value(i);
    }
    x
}

impl Level {
    /// A level from the outputs at the Chebyshev nodes.
    fn new(h: f64, columns: Vec<State>, samples: &[Series]) -> Self {
        let bases = NODES.map(chebyshev);
        let rows: Vec<Series> = samples
            .iter()
            .map(|values| {
                let mut c = [0.0; TERMS];
                for (v, basis) in values.iter().zip(&bases) {
                    for (c, t) in c.iter_mut().zip(basis) {
                        *c += v * t * (2.0 / TERMS as f64);
                    }
                }
                c[0] *= 0.5;
                c
            })
            .collect();
        let sizes = rows
            .iter()
            .map(|r| r.iter().map(|v| v.abs()).sum())
            .collect();
        Self {
            h,
            columns,
            rows,
            sizes,
        }
    }

    fn size(&self) -> f64 {
        // A value that is no number must not pass for a small one.
        self.columns
            .iter()
            .flatten()
            .chain(&self.sizes)
            .fold(0.0_f64, |m, v| {
                if v.is_nan() {
                    f64::INFINITY
                } else {
                    m.max(v.abs())
                }
            })
    }

    fn apply_transition(&self, x: &State, n: usize, quads: usize) -> State {
        let mut sum = [0.0; MAX_ORDER];
        for (column, x) in self.columns.iter().zip(&x[..n]) {
            add_scaled(&mut sum, column, *x, quads);
        }
        sum
    }

    fn apply(&self, x: &State, u: &[f64], n: usize, quads: usize) -> State {
        let mut sum = self.apply_transition(x, n, quads);
        for (column, u) in self.columns[n..].iter().zip(u) {
            add_scaled(&mut sum, column, *u, quads);
        }
        sum
    }
}
