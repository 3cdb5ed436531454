//! The equation of motion with a subset of atoms as one regression, and what its coefficients mean.

use super::gram::{Gram, Reduced, Solution};
use super::tuning::{BLOCKS, DIFFERENCE};
use crate::effect::{Atom, Effect, Extent, Shape, Solved};
use crate::measurement::Kind;

/// Columns of the base in the Gram matrices.
pub(super) const INPUT: usize = 0;
pub(super) const ACCELERATION: usize = 1;
pub(super) const VELOCITY: usize = 2;
pub(super) const ONE: usize = 3;
/// How many they are.
pub(super) const BASE: usize = 4;

/// An atom with one shape, and where its columns are.
#[derive(Clone, Debug)]
pub(super) struct Shaped {
    pub shape: Shape,
    pub tied: Option<usize>,
    pub free: Vec<usize>,
    /// Whether the coefficient of the first free one is the inertia of a second body.
    pub has_body: bool,
}

/// An atom that may be in a subset.
#[derive(Clone)]
pub(super) struct Choice {
    /// Its place in the list of effects.
    pub rank: usize,
    pub effect: &'static dyn Effect,
    pub atom: Atom,
    pub shapes: Vec<Shaped>,
}

impl Choice {
    /// Parameters that it adds.
    pub fn size(&self) -> usize {
        self.atom.shapes + self.shapes.first().map_or(0, |s| s.free.len())
    }
}

/// Inertia, viscous friction, operating point (0 for a drive) and coefficients of atoms, for an input with the
/// coefficient 1.
pub(super) struct Found {
    pub body: [f64; 2],
    pub offset: f64,
    pub coefficients: Vec<f64>,
}

impl Found {
    /// Values of the baseline model.
    pub fn baseline(&self, kind: Kind) -> Vec<f64> {
        let [inertia, damping] = self.body;
        match kind {
            Kind::Drive => vec![inertia, damping],
            Kind::Process => vec![1.0 / damping, inertia / damping, self.offset / damping],
        }
    }
}

/// Regressors and, last, the target: the input of a drive, the rate of a process output, in which the noise is.
pub(super) fn elements(kind: Kind, atoms: &[&Shaped]) -> Vec<Vec<usize>> {
    let mut input = vec![INPUT];
    input.extend(atoms.iter().filter_map(|a| a.tied));
    let free = atoms.iter().flat_map(|a| a.free.iter().map(|c| vec![*c]));
    match kind {
        Kind::Drive => {
            let mut all = vec![vec![ACCELERATION], vec![VELOCITY]];
            all.extend(free);
            all.push(input);
            all
        }
        Kind::Process => {
            let mut all = vec![input, vec![VELOCITY], vec![ONE]];
            all.extend(free);
            all.push(vec![ACCELERATION]);
            all
        }
    }
}

/// What coefficients of [`elements`] mean.
pub(super) fn found(kind: Kind, w: &[f64]) -> Found {
    match kind {
        Kind::Drive => Found {
            body: [w[0], w[1]],
            offset: 0.0,
            coefficients: w[2..].iter().map(|c| -c).collect(),
        },
        Kind::Process => Found {
            body: [1.0 / w[0], -w[1] / w[0]],
            offset: w[2] / w[0],
            coefficients: w[3..].iter().map(|c| c / w[0]).collect(),
        },
    }
}

/// By what a squared residual is divided to be one of the acceleration of all bodies: one of a model whose atoms make
/// up the input themselves, and need no body, is large.
pub(super) fn unit(kind: Kind, w: &[f64], atoms: &[&Shaped]) -> f64 {
    match kind {
        Kind::Drive => {
            let (mut inertia, mut first) = (w[0], 2);
            for atom in atoms {
                if atom.has_body {
                    inertia += (-w[first]).max(0.0);
                }
                first += atom.free.len();
            }
            (inertia * inertia).max(f64::MIN_POSITIVE)
        }
        Kind::Process => 1.0,
    }
}

/// Values of the body and of each effect in a subset, in order, if these are such as the effects can have.
pub(super) fn values(
    kind: Kind,
    w: &[f64],
    subset: &[(&Choice, &Shaped)],
    extent: &Extent,
) -> Option<(Found, Vec<Vec<f64>>)> {
    let mut found = found(kind, w);
    let mut all = Vec::with_capacity(subset.len());
    let mut from = 0;
    for (choice, shaped) in subset {
        let coefficients = &found.coefficients[from..from + shaped.free.len()];
        from += shaped.free.len();
        let solved = Solved {
            body: found.body,
            shape: shaped.shape,
            extent,
            coefficients,
        };
        let (body, values) = choice.atom.read(&solved)?;
        all.push((body, values));
    }
    // What an effect says of the body holds for the one beside the others.
    let body = all
        .iter()
        .map(|(body, _)| *body)
        .find(|body| *body != found.body);
    found.body = body.unwrap_or(found.body);
    Some((found, all.into_iter().map(|(_, values)| values).collect()))
}

/// A fit to all blocks with errors from the scatter of blocks: residuals are correlated and windows overlap.
pub(super) struct Fit {
    pub w: Vec<f64>,
    /// Covariance of the coefficients, row by row.
    pub covariance: Vec<f64>,
}

impl Fit {
    pub fn new(gram: &Gram, elements: &[Vec<usize>]) -> Option<Self> {
        let blocks: Vec<Reduced> = gram
            .blocks
            .iter()
            .map(|b| Reduced::new(b, gram.size, elements))
            .collect();
        let mut all = Reduced {
            order: elements.len() - 1,
            values: vec![0.0; elements.len() * elements.len()],
        };
        for block in &blocks {
            for (sum, value) in all.values.iter_mut().zip(&block.values) {
                *sum += value;
            }
        }
        let solution = all.solve(false)?;
        let w = all.coefficients(&solution);
        Some(Self {
            covariance: clustered(&solution, &blocks, &w),
            w,
        })
    }

    pub fn error(&self, i: usize) -> f64 {
        self.covariance[i * self.w.len() + i].max(0.0).sqrt()
    }

    /// Standard error of a function of the coefficients that is as smooth as its values, by differences.
    pub fn errors(&self, of: impl Fn(&[f64]) -> Option<Vec<f64>>) -> Option<(Vec<f64>, Vec<f64>)> {
        let values = of(&self.w)?;
        let n = self.w.len();
        let mut slopes = vec![vec![0.0; n]; values.len()];
        for j in 0..n {
            let step = DIFFERENCE * self.error(j);
            if step == 0.0 {
                continue;
            }
            let moved = |by: f64| {
                let mut w = self.w.clone();
                w[j] += by;
                of(&w)
            };
            let (up, down) = (moved(step), moved(-step));
            let (high, low, span) = match (&up, &down) {
                (Some(up), Some(down)) => (up, down, 2.0 * step),
                (Some(up), None) => (up, &values, step),
                (None, Some(down)) => (&values, down, step),
                (None, None) => continue,
            };
            for (slope, (a, b)) in slopes.iter_mut().zip(high.iter().zip(low)) {
                slope[j] = (a - b) / span;
            }
        }
        let variance = |slope: &Vec<f64>| -> f64 {
            let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            pairs
                .map(|(i, j)| slope[i] * self.covariance[i * n + j] * slope[j])
                .sum()
        };
        let errors = slopes.iter().map(|s| variance(s).max(0.0).sqrt()).collect();
        Some((values, errors))
    }
}

/// Cluster-robust covariance: the inverse normal matrix about the scatter of the blocks' scores (Liang and Zeger 1986).
fn clustered(solution: &Solution, blocks: &[Reduced], w: &[f64]) -> Vec<f64> {
    let n = w.len();
    let mut covariance = vec![0.0; n * n];
    for block in blocks {
        let moved = solution.apply(&block.scores(w));
        for i in 0..n {
            for j in 0..n {
                covariance[i * n + j] += moved[i] * moved[j];
            }
        }
    }
    // As many blocks as coefficients leave no scatter.
    let few = BLOCKS as f64 / (BLOCKS - n.min(BLOCKS / 2)) as f64;
    for c in &mut covariance {
        *c *= few;
    }
    covariance
}
