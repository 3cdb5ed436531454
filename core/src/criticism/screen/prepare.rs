//! From signals to sums: which shapes of which atoms go into the subsets, and what each window counts.

use std::ops::Range;

use super::gram::{AtomColumns, Gram, Halves, Reduced, Rows};
use super::model::{BASE, Choice, INPUT, Shaped, elements, found, unit};
use super::signals::Signals;
use super::subsets::{Bench, Tried, smallest};
use super::tuning::{
    ATTENUATED, BEYOND, COARSE, DULL, ENOUGH, EVALUATIONS, EXACT, FAR_BEYOND, FINE, GRID_NUMBERS,
    HUBER, KEPT_SHAPES, REFINED, ROUNDS, SHOWN, SIDE, SIMPLEX_SAMPLES, SIMPLEXES, WIDE,
};
use super::window::Width;
use crate::effect::{self, Atom, Effect, Extent, Shape, Solved};
use crate::measurement::Kind;
use crate::order::median;
use crate::simplex::minimise;

/// Sums and what they are of.
pub(super) struct Prepared {
    kind: Kind,
    gram: Gram,
    choices: Vec<Choice>,
    extent: Extent,
}

struct Builder<'a> {
    rows: Rows<'a>,
    kind: Kind,
    extent: Extent,
    /// What may explain the record, in the order in which equals are listed.
    library: Vec<&'static dyn Effect>,
    columns: Vec<Vec<f64>>,
    choices: Vec<Choice>,
    /// Of each window.
    weights: Vec<f64>,
    /// Widths that tell noise alone.
    dull: Vec<bool>,
}

impl Prepared {
    /// With the effects of the library and those of the user's own.
    pub fn new(signals: &Signals, widths: &[Width], own: &[&'static dyn Effect]) -> Self {
        let longest = widths.iter().map(|w| w.length).max().unwrap_or(1);
        let rows = Rows::new(signals, widths);
        let columns = vec![
            rows.held(&signals.input),
            rows.motion(2),
            rows.motion(1),
            rows.one(),
        ];
        let mut builder = Builder {
            kind: signals.kind,
            extent: signals.extent(longest as f64 * signals.step),
            weights: vec![1.0; rows.len()],
            library: effect::library().chain(own.iter().copied()).collect(),
            choices: Vec::new(),
            dull: vec![false; widths.len()],
            rows,
            columns,
        };
        builder.add_linear();
        builder.weigh_by_everything();
        builder.add_shaped();
        for _ in 1..ROUNDS {
            builder.weigh_by_best();
        }
        Self {
            kind: builder.kind,
            gram: builder.gram(),
            extent: builder.extent,
            choices: builder.choices,
        }
    }

    pub fn bench(&self) -> Bench<'_> {
        Bench::new(self.kind, &self.gram, &self.choices, &self.extent)
    }
}

impl Builder<'_> {
    fn gram(&self) -> Gram {
        let columns: Vec<&[f64]> = self.columns.iter().map(Vec::as_slice).collect();
        Gram::new(&columns, &self.weights, &self.rows.blocks)
    }

    fn push(&mut self, columns: AtomColumns, shape: Shape) -> Shaped {
        let mut add = |column: Vec<f64>| {
            self.columns.push(column);
            self.columns.len() - 1
        };
        Shaped {
            shape,
            has_body: columns.has_body,
            tied: columns.tied.map(&mut add),
            free: columns.free.into_iter().map(add).collect(),
        }
    }

    /// Atoms of all effects that have no shape to look for.
    fn add_linear(&mut self) {
        let kind = self.kind;
        for (rank, effect) in self
            .library
            .clone()
            .into_iter()
            .enumerate()
            .filter(|(_, e)| e.kinds().contains(&kind))
        {
            for atom in effect
                .atoms(self.kind)
                .into_iter()
                .filter(|a| a.shapes == 0)
            {
                let shapes = (atom.grid)(&self.extent);
                for shape in shapes {
                    let columns = self.rows.atom(&atom, &shape);
                    let shapes = vec![self.push(columns, shape)];
                    self.choices.push(Choice {
                        rank,
                        effect,
                        atom,
                        shapes,
                    });
                }
            }
        }
    }

    /// Atoms with shapes, of which those are kept that leave least beside the body, or beside all that is linear.
    fn add_shaped(&mut self) {
        let kind = self.kind;
        let effects = self
            .library
            .clone()
            .into_iter()
            .enumerate()
            .filter(|(_, e)| e.kinds().contains(&kind));
        let atoms =
            effects.flat_map(|(rank, e)| e.atoms(kind).into_iter().map(move |a| (rank, e, a)));
        let shaped: Vec<_> = atoms.filter(|(_, _, a)| a.shapes > 0).collect();
        let kept: Vec<Vec<Shape>> = {
            let columns = self.columns.iter().map(Vec::as_slice).collect();
            let halves = Halves::new(columns, &self.weights, &self.rows.blocks);
            shaped
                .iter()
                .map(|(_, _, atom)| self.promising(atom, &halves))
                .collect()
        };
        for ((rank, effect, atom), shapes) in shaped.into_iter().zip(kept) {
            let columns = |builder: &mut Self, shape| {
                let columns = builder.rows.atom(&atom, &shape);
                builder.push(columns, shape)
            };
            let shapes: Vec<Shaped> = shapes
                .into_iter()
                .map(|shape| columns(self, shape))
                .collect();
            if !shapes.is_empty() {
                self.choices.push(Choice {
                    rank,
                    effect,
                    atom,
                    shapes,
                });
            }
        }
        self.choices.sort_by_key(|c| c.rank);
    }

    /// Shapes of an atom that leave least of either half of the record.
    fn promising(&self, atom: &Atom, halves: &Halves) -> Vec<Shape> {
        let grid = (atom.grid)(&self.extent);
        let columns: Vec<AtomColumns> = grid.iter().map(|s| self.rows.atom(atom, s)).collect();
        let beside = [0..0, BASE..halves.len()];
        let left = |shape: &Shape, columns: &AtomColumns| {
            (
                self.left(atom, shape, columns, halves, beside.clone()),
                *shape,
            )
        };
        let pairs = grid.iter().zip(&columns);
        let mut tried: Vec<([[f64; 2]; 2], Shape)> = pairs.map(|(s, c)| left(s, c)).collect();
        if atom.shapes > GRID_NUMBERS {
            for shape in self.found_between(atom, halves.len(), &grid, &columns) {
                tried.push(left(&shape, &self.rows.atom(atom, &shape)));
            }
        }
        let left = |k: usize, beside: usize| tried[k].0.as_flattened()[beside];
        let mut kept: Vec<Shape> = Vec::new();
        for beside in 0..4 {
            let mut order: Vec<usize> = (0..tried.len()).collect();
            order.sort_by(|a, b| left(*a, beside).total_cmp(&left(*b, beside)));
            for k in order.into_iter().take(KEPT_SHAPES) {
                if left(k, beside).is_finite() && !kept.contains(&tried[k].1) {
                    kept.push(tried[k].1);
                }
            }
        }
        kept
    }

    /// Shapes of an atom with more numbers than a grid can be fine in: from the best ones of the grid, what a simplex finds in their
    /// logarithms, beside the body and beside all `linear` columns. It looks at the widest windows alone: in a narrow one a contact
    /// that is a little early or late is all or nothing. None where even the best explain next to nothing.
    fn found_between(
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

    /// The regression of these sums on the body, atoms and other columns that are linear by themselves: coefficients, and the
    /// squares that it leaves of the acceleration. What the others explain of a column is left out.
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
    fn left<const N: usize>(
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

    /// Residual of each window, in the unit of the target.
    fn residuals(&self, elements: &[Vec<usize>], w: &[f64]) -> Vec<f64> {
        let column =
            |element: &[usize], k: usize| element.iter().map(|c| self.columns[*c][k]).sum::<f64>();
        let (target, regressors) = match elements.split_last() {
            Some((target, regressors)) => (target.as_slice(), regressors),
            None => return Vec::new(),
        };
        (0..self.rows.len())
            .map(|k| {
                let said: f64 = regressors
                    .iter()
                    .zip(w)
                    .map(|(e, w)| w * column(e, k))
                    .sum();
                column(target, k) - said
            })
            .collect()
    }

    /// Weights by a model: windows of each width count by its robust scale, and those far off less.
    fn weigh(&mut self, elements: &[Vec<usize>], w: &[f64]) {
        let residuals = self.residuals(elements, w);
        let target = elements.last().map_or(&[][..], Vec::as_slice);
        for width in 0..self.rows.widths.len() {
            let of_width = || (0..residuals.len()).filter(|k| self.rows.width_of[*k] == width);
            let mut sizes: Vec<f64> = of_width().map(|k| residuals[k].abs()).collect();
            let squares: f64 = of_width()
                .map(|k| {
                    target
                        .iter()
                        .map(|c| self.columns[*c][k])
                        .sum::<f64>()
                        .powi(2)
                })
                .sum();
            let exact = EXACT * (squares / sizes.len().max(1) as f64).sqrt();
            // The median of the absolute values of a normal distribution is 0.6745 of its deviation.
            let scale = (median(&mut sizes) / 0.6745)
                .max(exact)
                .max(f64::MIN_POSITIVE);
            let windows: Vec<usize> = of_width().collect();
            for k in windows {
                let far = residuals[k].abs() / (HUBER * scale);
                self.weights[k] = if self.dull[width] {
                    0.0
                } else {
                    1.0 / (scale * scale * far.max(1.0))
                };
            }
        }
    }

    /// By the model with everything that is linear, from equal weights within each width.
    fn weigh_by_everything(&mut self) {
        let mut all = elements(self.kind, &[]);
        let Some(target) = all.pop() else { return };
        all.extend((BASE..self.columns.len()).map(|c| vec![c]));
        all.push(target.clone());
        self.drop_dull_widths(&all);
        self.scale_widths(&target);
        let gram = self.gram();
        let reduced = Reduced::new(&gram.sum(|_| true), gram.size, &all);
        if let Some(solution) = reduced.solve(true) {
            let w = reduced.coefficients(&solution);
            self.weigh(&all, &w);
        }
    }

    /// Leaves out the widths whose windows are too short to tell more than noise. Noise in the acceleration of a drive makes
    /// its inertia too small, and what is left of the input larger (errors in variables); the rate of a process is the target,
    /// where noise only adds to what is left.
    fn drop_dull_widths(&mut self, everything: &[Vec<usize>]) {
        self.dull.fill(false);
        if self.kind == Kind::Drive {
            self.mark_dull(&elements(self.kind, &[]));
        }
        self.mark_dull(everything);
        if self.dull.iter().all(|dull| *dull) {
            self.dull.fill(false);
        }
    }

    fn mark_dull(&mut self, all: &[Vec<usize>]) {
        let told: Vec<(f64, f64)> = (0..self.rows.widths.len())
            .map(|width| {
                for (weight, of) in self.weights.iter_mut().zip(&self.rows.width_of) {
                    *weight = f64::from(u8::from(*of == width));
                }
                let gram = self.gram();
                let reduced = Reduced::new(&gram.sum(|_| true), gram.size, all);
                let w = reduced
                    .solve(true)
                    .map(|s| reduced.coefficients(&s))
                    .unwrap_or_default();
                let target = reduced.square(reduced.order).max(f64::MIN_POSITIVE);
                match w.first() {
                    Some(inertia) => ((reduced.loss(&w) / target).sqrt(), *inertia),
                    None => (f64::INFINITY, 0.0),
                }
            })
            .collect();
        let Some(best) = told.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return;
        };
        let bent = |inertia: f64| self.kind == Kind::Process || inertia < ATTENUATED * best.1;
        for (dull, (left, inertia)) in self.dull.iter_mut().zip(&told) {
            *dull |= *left > DULL * best.0 && bent(*inertia);
        }
    }

    /// Squares of a sum of columns in the windows of each width, and how many these are.
    fn powers(&self, sum: &[usize]) -> Vec<(f64, f64)> {
        let mut squares = vec![(0.0, 0.0); self.rows.widths.len()];
        for k in 0..self.rows.len() {
            let value: f64 = sum.iter().map(|c| self.columns[*c][k]).sum();
            let of_width = &mut squares[self.rows.width_of[k]];
            *of_width = (of_width.0 + value.powi(2), of_width.1 + 1.0);
        }
        squares
    }

    /// All widths count alike.
    fn scale_widths(&mut self, target: &[usize]) {
        let squares = self.powers(target);
        for (k, weight) in self.weights.iter_mut().enumerate() {
            let (sum, count) = squares[self.rows.width_of[k]];
            let dull = self.dull[self.rows.width_of[k]];
            *weight = if dull {
                0.0
            } else {
                count / f64::max(sum, f64::MIN_POSITIVE)
            };
        }
    }

    /// Finer shapes about those of the best subsets, then weights by what the best one leaves.
    fn weigh_by_best(&mut self) {
        let gram = self.gram();
        let bench = Bench::new(self.kind, &gram, &self.choices, &self.extent);
        let tried: Vec<Tried> = bench.all();
        let class = smallest(&tried, bench.motion());
        let members: Vec<Vec<(usize, usize)>> = class
            .iter()
            .take(REFINED)
            .map(|t| t.members.clone())
            .collect();
        let Some(best) = members.first().cloned() else {
            return;
        };
        let elements = bench.elements(&best);
        if let Some(fit) = super::model::Fit::new(&gram, &elements) {
            self.weigh(&elements, &fit.w);
        }
        // A part of the best may do as well, once its own shapes are as fine: lags make up for a dead time off the grid.
        let parts = (0..best.len()).map(|out| {
            let mut part = best.clone();
            part.remove(out);
            part
        });
        let refined: Vec<Vec<(usize, usize)>> = parts.chain(members.iter().cloned()).collect();
        for members in &refined {
            self.refine(members);
        }
    }

    /// Adds the shapes with which these members leave least, found by steps of halving length along each number.
    fn refine(&mut self, members: &[(usize, usize)]) {
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

/// The shape from here on that leaves least: each number that it has up and down by a share that is halved where nothing
/// gets better.
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
