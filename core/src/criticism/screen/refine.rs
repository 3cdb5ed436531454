//! Shapes between those of a grid: what an atom leaves beside others, and where it leaves least.

use std::ops::Range;

use super::gram::{AtomColumns, Halves, Reduced, Rows};
use super::model::{BASE, INPUT, Shaped, elements, found, unit};
use super::prepare::Builder;
use super::tuning::{
    BEYOND, COARSE, ENOUGH, EVALUATIONS, FAR_BEYOND, FINE, SHOWN, SIDE, SIMPLEX_SAMPLES, SIMPLEXES,
    WIDE,
};
use crate::effect::{Atom, Shape, Solved};
use crate::simplex::minimise;

impl Builder<'_> {
    /// Shapes of an atom with more numbers than a grid can be fine in: from the best ones of the grid, what a simplex
    /// finds in their logarithms, beside the body and beside all `linear` columns. It looks at the widest windows
    /// alone: in a narrow one a contact that is a little early or late is all or nothing. None where even the best
    /// explain next to nothing.
    pub(super) fn found_between(
        &self,
        atom: &Atom,
        linear: usize,
        grid: &[Shape],
        columns: &[AtomColumns],
    ) -> Vec<Shape> {
        let widths = &self.rows.widths[self.rows.widths.len().saturating_sub(WIDE)..];
        let rows = Rows::new(self.rows.signals, widths);
        let from = self.rows.len() - rows.len();
        let stay = self.columns.iter().map(|c| &c[from..]).take(linear);
        let weights = self.even_weights(from);
        let wide = Halves::new(stay.collect(), &weights, &rows.blocks);
        let bare = wide.with(&[]);
        let samples = self.rows.signals.len().max(1);
        let starts = (SIMPLEX_SAMPLES / (samples * EVALUATIONS)).clamp(1, SIMPLEXES);
        let evaluations = (SIMPLEX_SAMPLES / samples).min(EVALUATIONS);
        let within = Within::new(grid);
        let mut all = Vec::new();
        for others in [0..0, BASE..linear] {
            let without = bare.each_ref().map(|sums| {
                let found = self.regressed(sums, linear, &[], others.clone());
                found.map_or(f64::INFINITY, |(_, left)| left)
            });
            let without: f64 = without.iter().sum();
            let left = |shape: &Shape, columns: &AtomColumns| -> f64 {
                let [halves] = self.left(atom, shape, columns, &wide, [others.clone()]);
                halves.iter().sum()
            };
            let of_grid = grid.iter().zip(columns);
            let of_grid = of_grid.map(|(shape, c)| (left(shape, &c.rows_from(from)), shape));
            let mut order: Vec<(f64, &Shape)> = of_grid
                .filter(|(left, _)| *left < SHOWN * without)
                .collect();
            order.sort_by(|a, b| a.0.total_cmp(&b.0));
            let share = |logs: &Shape| {
                let shape = within.shape(logs);
                let left = left(&shape, &rows.atom(atom, &shape));
                if left.is_finite() {
                    left / without
                } else {
                    1.0
                }
            };
            let best = |logs: Shape| minimise(share, logs, SIDE, evaluations, ENOUGH);
            let order = order.into_iter().take(starts);
            let mut found: Vec<(Shape, f64)> =
                order.map(|(_, shape)| best(shape.map(libm::log))).collect();
            found.sort_by(|a, b| a.1.total_cmp(&b.1));
            // A simplex that has become flat goes on as a new one (Kelley 1999).
            found.extend(found.first().map(|(logs, _)| best(*logs)));
            all.extend(found.iter().map(|(logs, _)| within.shape(logs)));
        }
        all
    }

    /// Weights of the windows from the first of a width on with which all widths count alike.
    fn even_weights(&self, from: usize) -> Vec<f64> {
        let powers = self.powers(&[INPUT]);
        let of = |k: usize| 1.0 / powers[self.rows.width_of[k]].0.max(f64::MIN_POSITIVE);
        (from..self.rows.len()).map(of).collect()
    }

    /// The regression of these sums on the body, atoms and other columns that are linear by themselves: coefficients,
    /// and the squares that it leaves of the acceleration. What the others explain of a column is left out.
    fn regressed(
        &self,
        sums: &[f64],
        size: usize,
        atoms: &[&Shaped],
        others: Range<usize>,
    ) -> Option<(Vec<f64>, f64)> {
        let mut all = elements(self.kind, atoms);
        let target = all.pop()?;
        all.extend(others.map(|c| vec![c]));
        all.push(target);
        let reduced = Reduced::new(sums, size, &all);
        let w = reduced.coefficients(&reduced.solve(true)?);
        let left = reduced.loss(&w) / unit(self.kind, &w, atoms);
        Some((w, left))
    }

    /// What an atom leaves of either half of the record, beside the body and each of these other columns.
    pub(super) fn left<const N: usize>(
        &self,
        atom: &Atom,
        shape: &Shape,
        columns: &AtomColumns,
        halves: &Halves,
        others: [Range<usize>; N],
    ) -> [[f64; 2]; N] {
        let (shaped, extra) = behind(halves.len(), shape, columns);
        let sums = halves.with(&extra);
        let beside = |sums: &Vec<f64>, others: &Range<usize>| {
            let size = halves.len() + extra.len();
            let (w, left) = self.regressed(sums, size, &[&shaped], others.clone())?;
            let found = found(self.kind, &w);
            let solved = Solved {
                body: found.body,
                shape: *shape,
                extent: &self.extent,
                coefficients: &found.coefficients[..shaped.free.len()],
            };
            atom.read(&solved)?;
            left.is_finite().then_some(left)
        };
        others.map(|others| {
            let left = |sums| beside(sums, &others).unwrap_or(f64::INFINITY);
            sums.each_ref().map(left)
        })
    }

    /// Adds the shapes with which these members leave least, found by steps of halving length along each number.
    pub(super) fn refine(&mut self, members: &[(usize, usize)]) {
        let mut shaped: Vec<Shaped> = members
            .iter()
            .map(|(c, s)| self.choices[*c].shapes[*s].clone())
            .collect();
        for (at, (choice, _)) in members.iter().enumerate() {
            let atom = self.choices[*choice].atom;
            if atom.shapes == 0 {
                continue;
            }
            let rest: Vec<&Shaped> = shaped
                .iter()
                .enumerate()
                .filter(|(k, _)| *k != at)
                .map(|(_, s)| s)
                .collect();
            let from = shaped[at].shape;
            let best = {
                let mut stay: Vec<usize> = (0..BASE).collect();
                stay.extend(
                    rest.iter()
                        .flat_map(|s| s.tied.iter().chain(&s.free).copied()),
                );
                let place = |c: usize| stay.iter().position(|s| *s == c).unwrap_or(0);
                let moved: Vec<Shaped> = rest
                    .iter()
                    .map(|s| Shaped {
                        shape: s.shape,
                        has_body: s.has_body,
                        tied: s.tied.map(place),
                        free: s.free.iter().map(|c| place(*c)).collect(),
                    })
                    .collect();
                let columns = stay.iter().map(|c| self.columns[*c].as_slice()).collect();
                let halves = Halves::new(columns, &self.weights, &self.rows.blocks);
                let left = |shape: &Shape| {
                    let columns = self.rows.atom(&atom, shape);
                    self.left_beside(&atom, shape, &columns, &halves, &moved)
                };
                search(from, left)
            };
            if best != from {
                let columns = self.rows.atom(&atom, &best);
                let found = self.push(columns, best);
                shaped[at] = found.clone();
                self.choices[*choice].shapes.push(found);
            }
        }
    }

    /// What an atom leaves of the whole record beside others.
    fn left_beside(
        &self,
        atom: &Atom,
        shape: &Shape,
        columns: &AtomColumns,
        halves: &Halves,
        others: &[Shaped],
    ) -> f64 {
        let (own, extra) = behind(halves.len(), shape, columns);
        let [mut sums, other] = halves.with(&extra);
        sums.iter_mut().zip(&other).for_each(|(a, b)| *a += b);
        let mut all: Vec<&Shaped> = vec![&own];
        all.extend(others);
        let reduced = Reduced::new(
            &sums,
            halves.len() + extra.len(),
            &elements(self.kind, &all),
        );
        let Some(solution) = reduced.solve(false) else {
            return f64::INFINITY;
        };
        let w = reduced.coefficients(&solution);
        let found = found(self.kind, &w);
        let solved = Solved {
            body: found.body,
            shape: *shape,
            extent: &self.extent,
            coefficients: &found.coefficients[..own.free.len()],
        };
        if atom.read(&solved).is_none() {
            return f64::INFINITY;
        }
        reduced.loss(&w) / unit(self.kind, &w, &all)
    }
}

/// Columns of an atom behind so many others, and where they are then.
fn behind<'a>(first: usize, shape: &Shape, columns: &'a AtomColumns) -> (Shaped, Vec<&'a [f64]>) {
    let tied = usize::from(columns.tied.is_some());
    let shaped = Shaped {
        shape: *shape,
        has_body: columns.has_body,
        tied: columns.tied.as_ref().map(|_| first),
        free: (0..columns.free.len()).map(|k| first + tied + k).collect(),
    };
    let all = columns.tied.iter().chain(&columns.free);
    (shaped, all.map(Vec::as_slice).collect())
}

/// How far the numbers of a shape may go.
struct Within {
    least: Shape,
    most: Shape,
}

impl Within {
    /// Somewhat beyond a grid; much farther where that has one value alone.
    fn new(grid: &[Shape]) -> Self {
        let (mut least, mut most) = ([f64::INFINITY; 5], [0.0_f64; 5]);
        for shape in grid {
            for (k, number) in shape.iter().enumerate() {
                least[k] = least[k].min(*number);
                most[k] = most[k].max(*number);
            }
        }
        for (low, high) in least.iter_mut().zip(&mut most) {
            let beyond = if low < high { BEYOND } else { FAR_BEYOND };
            (*low, *high) = (*low / beyond, *high * beyond);
        }
        Self { least, most }
    }

    fn shape(&self, logs: &Shape) -> Shape {
        std::array::from_fn(|k| libm::exp(logs[k]).clamp(self.least[k], self.most[k]))
    }
}

/// The shape from here on that leaves least: each number that it has up and down by a share that is halved where
/// nothing gets better.
fn search(from: Shape, left: impl Fn(&Shape) -> f64) -> Shape {
    let (mut at, mut least) = (from, left(&from));
    let mut share = COARSE;
    while share > FINE {
        let before = at;
        for k in 0..at.len() {
            for factor in [1.0 + share, 1.0 / (1.0 + share)] {
                let mut other = at;
                other[k] *= factor;
                if other == at {
                    continue;
                }
                let tried = left(&other);
                if tried < least {
                    (at, least) = (other, tried);
                }
            }
        }
        if at == before {
            share /= 2.0;
        }
    }
    at
}
