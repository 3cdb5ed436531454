//! From signals to sums: which shapes of which atoms go into the subsets, and what each window counts.

use super::gram::{AtomColumns, Gram, Halves, Reduced, Rows};
use super::model::{BASE, Choice, Shaped, elements};
use super::signals::Signals;
use super::subsets::{Bench, Tried, smallest};
use super::tuning::{ATTENUATED, DULL, EXACT, GRID_NUMBERS, HUBER, KEPT_SHAPES, REFINED, ROUNDS};
use super::window::Width;
use crate::effect::{self, Atom, Effect, Extent, Shape};
use crate::measurement::Kind;
use crate::order::median;

/// Sums and what they are of.
pub(super) struct Prepared {
    kind: Kind,
    gram: Gram,
    choices: Vec<Choice>,
    extent: Extent,
}

/// Columns of all choices and weights of the windows, from which the sums are made.
pub(super) struct Builder<'a> {
    pub rows: Rows<'a>,
    pub kind: Kind,
    pub extent: Extent,
    /// What may explain the record, in the order in which equals are listed.
    library: Vec<&'static dyn Effect>,
    pub columns: Vec<Vec<f64>>,
    pub choices: Vec<Choice>,
    /// Of each window.
    pub weights: Vec<f64>,
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

    pub(super) fn push(&mut self, columns: AtomColumns, shape: Shape) -> Shaped {
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

    /// Leaves out the widths whose windows are too short to tell more than noise. Noise in the acceleration of a drive
    /// makes its inertia too small, and what is left of the input larger (errors in variables); the rate of a process
    /// is the target, where noise only adds to what is left.
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
    pub(super) fn powers(&self, sum: &[usize]) -> Vec<(f64, f64)> {
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
        // A part of the best may do as well, once its own shapes are as fine: lags make up for a dead time off the
        // grid.
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
}
