//! All subsets of up to four atoms, each judged on blocks that its fit did not see.

use super::gram::{Gram, Reduced};
use super::model::{Choice, Fit, Shaped, elements, unit, values};
use super::tuning::{BLOCKS, GROWTH, MOST_ATOMS, PRACTICAL, SAME, TOLD, WORSE};
use crate::controller::Controller;
use crate::effect::Extent;
use crate::measurement::Kind;

/// Indices of choices, and of the shape of each.
pub(super) type Members = Vec<(usize, usize)>;

/// A subset of the choices with the shapes that fit best.
#[derive(Clone, Debug)]
pub(super) struct Tried {
    /// Indices of the choices, and of the shape of each.
    pub members: Members,
    /// Squared residuals of the acceleration in each block, by the fit to the others.
    pub losses: Vec<f64>,
    /// Numbers that it fits.
    pub size: usize,
}

impl Tried {
    pub fn loss(&self) -> f64 {
        self.losses.iter().sum()
    }
}

/// Everything that subsets are judged by.
pub(super) struct Bench<'a> {
    pub kind: Kind,
    pub gram: &'a Gram,
    pub choices: &'a [Choice],
    pub extent: &'a Extent,
    halves: [Vec<f64>; 2],
    all: Vec<f64>,
}

impl<'a> Bench<'a> {
    pub fn new(kind: Kind, gram: &'a Gram, choices: &'a [Choice], extent: &'a Extent) -> Self {
        Self {
            kind,
            gram,
            choices,
            extent,
            halves: [0, 1].map(|half| gram.sum(|b| b % 2 == half)),
            all: gram.sum(|_| true),
        }
    }

    pub fn shaped(&self, members: &[(usize, usize)]) -> Vec<&'a Shaped> {
        members
            .iter()
            .map(|(c, s)| &self.choices[*c].shapes[*s])
            .collect()
    }

    pub fn elements(&self, members: &[(usize, usize)]) -> Vec<Vec<usize>> {
        elements(self.kind, &self.shaped(members))
    }

    /// Loss of the best fit to these sums, in units of the acceleration, and its coefficients.
    fn fitted(&self, sums: &[f64], members: &[(usize, usize)]) -> Option<(f64, Vec<f64>)> {
        let reduced = Reduced::new(sums, self.gram.size, &self.elements(members));
        let solution = reduced.solve(false)?;
        let w = reduced.coefficients(&solution);
        let unit = unit(self.kind, &w, &self.shaped(members));
        Some((reduced.loss(&w) / unit, w))
    }

    /// The shapes of these choices that leave least of these sums: one after the other, until none gets better.
    fn profiled(&self, sums: &[f64], choices: &[usize]) -> Option<(Members, Vec<f64>)> {
        let mut members: Vec<(usize, usize)> = choices.iter().map(|c| (*c, 0)).collect();
        let mut best = self.fitted(sums, &members);
        let shaped = choices
            .iter()
            .filter(|c| self.choices[**c].shapes.len() > 1)
            .count();
        let rounds = match shaped {
            0 => 0,
            1 => 1,
            _ => 2,
        };
        for _ in 0..rounds {
            let before = members.clone();
            for at in 0..members.len() {
                for shape in 0..self.choices[members[at].0].shapes.len() {
                    let mut other = members.clone();
                    if other[at].1 == shape {
                        continue;
                    }
                    other[at].1 = shape;
                    let tried = self.fitted(sums, &other);
                    let better = match (&tried, &best) {
                        (Some(t), Some(b)) => t.0 < b.0,
                        (Some(_), None) => true,
                        (None, _) => false,
                    };
                    if better {
                        (members, best) = (other, tried);
                    }
                }
            }
            if members == before {
                break;
            }
        }
        best.map(|(_, w)| (members, w))
    }

    /// Losses on the blocks that the fit to the others did not see.
    fn held_out(&self, choices: &[usize]) -> Option<Vec<f64>> {
        let mut losses = vec![0.0; BLOCKS];
        for (half, sums) in self.halves.iter().enumerate() {
            let (members, w) = self.profiled(sums, choices)?;
            let elements = self.elements(&members);
            let unit = unit(self.kind, &w, &self.shaped(&members));
            for (b, loss) in losses.iter_mut().enumerate().filter(|(b, _)| b % 2 != half) {
                let reduced = Reduced::new(&self.gram.blocks[b], self.gram.size, &elements);
                *loss = reduced.loss(&w) / unit;
            }
        }
        losses.iter().all(|l| l.is_finite()).then_some(losses)
    }

    /// Whether what drives the body is told: its inertia, and the sign of it.
    pub fn told(&self, fit: &Fit) -> bool {
        match self.kind {
            Kind::Drive => fit.w[0] > TOLD * fit.error(0),
            // A gain has either sign, but a process that runs away within a window is none.
            Kind::Process => {
                let grows =
                    fit.w[1] > TOLD * fit.error(1) && fit.w[1] * self.extent.window > GROWTH;
                fit.w[0].abs() > TOLD * fit.error(0) && !grows
            }
        }
    }

    /// Whether these are the plant and not the controller turned round, where one closed the loop: it settles by itself,
    /// told by its own standard errors, or what the set point does to its input acts against the controller.
    pub fn is_plant(&self, members: &[(usize, usize)], made: &Controller) -> bool {
        let fit = Fit::new(self.gram, &self.elements(members));
        let plant = |fit: Fit| {
            let settles = -fit.w[1] > TOLD * fit.error(1);
            settles || made.is_led && self.told(&fit) && fit.w[0] * made.gain < 0.0
        };
        self.kind == Kind::Drive || fit.is_some_and(plant)
    }

    pub fn subset(&self, members: &[(usize, usize)]) -> Vec<(&'a Choice, &'a Shaped)> {
        let pair = |(c, s): &(usize, usize)| {
            let choice = &self.choices[*c];
            (choice, &choice.shapes[*s])
        };
        members.iter().map(pair).collect()
    }

    /// A subset, if it is one that can be: its effects have values that they may have, and the body is told.
    fn tried(&self, choices: &[usize]) -> Option<Tried> {
        let (members, w) = self.profiled(&self.all, choices)?;
        values(self.kind, &w, &self.subset(&members), self.extent)?;
        let fit = Fit::new(self.gram, &self.elements(&members))?;
        if !self.told(&fit) {
            return None;
        }
        Some(Tried {
            losses: self.held_out(choices)?,
            size: choices.iter().map(|c| self.choices[*c].size()).sum(),
            members,
        })
    }

    /// Whether these may stand beside each other: not twice the same effect, none that is a part of another.
    fn compatible(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.choices[a].effect, self.choices[b].effect);
        a.id() != b.id() && !a.has_part(b.id()) && !b.has_part(a.id())
    }

    /// All subsets that can be.
    pub fn all(&self) -> Vec<Tried> {
        let mut found = Vec::new();
        let mut open: Vec<Vec<usize>> = vec![Vec::new()];
        while let Some(choices) = open.pop() {
            found.extend(self.tried(&choices));
            if choices.len() == MOST_ATOMS {
                continue;
            }
            let next = choices.last().map_or(0, |c| c + 1);
            for c in next..self.choices.len() {
                if choices.iter().all(|other| self.compatible(*other, c)) {
                    let mut longer = choices.clone();
                    longer.push(c);
                    open.push(longer);
                }
            }
        }
        found
    }

    /// Values of the body and of each effect of a subset, fitted to all blocks.
    pub fn start(&self, members: &[(usize, usize)]) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let (_, w) = self.fitted(&self.all, members)?;
        let (found, effects) = values(self.kind, &w, &self.subset(members), self.extent)?;
        Some((found.baseline(self.kind), effects))
    }

    /// Squares of the acceleration in all blocks.
    pub fn motion(&self) -> f64 {
        self.all[super::model::ACCELERATION * self.gram.size + super::model::ACCELERATION]
    }
}

/// The smallest subsets that are the same as the best: by the paired difference of their losses on held-back blocks, or
/// by what it is of the `motion`. The best first.
pub(super) fn smallest(tried: &[Tried], motion: f64) -> Vec<&Tried> {
    let Some(best) = tried.iter().min_by(|a, b| a.loss().total_cmp(&b.loss())) else {
        return Vec::new();
    };
    let mut near: Vec<&Tried> = tried.iter().filter(|t| is_same(t, best, motion)).collect();
    let size = near.iter().map(|t| t.size).min().unwrap_or(0);
    near.retain(|t| t.size == size);
    near.sort_by(|a, b| a.loss().total_cmp(&b.loss()));
    near
}

/// Whether two subsets are the same: within the error of the mean paired difference over blocks, of losses and of their
/// logarithms (a likelihood that does not know the noise of a block), and not worse by more than a share; or within
/// what is a trifle of the motion.
fn is_same(tried: &Tried, best: &Tried, motion: f64) -> bool {
    let excess = tried.loss() - best.loss();
    if excess <= PRACTICAL * PRACTICAL * motion {
        return true;
    }
    let floor = PRACTICAL * PRACTICAL * motion / BLOCKS as f64;
    let pairs = || tried.losses.iter().zip(&best.losses);
    let plain: Vec<f64> = pairs().map(|(a, b)| a - b).collect();
    let logs: Vec<f64> = pairs()
        .map(|(a, b)| libm::log((a + floor) / (b + floor)))
        .collect();
    let near = tried.loss() <= WORSE * WORSE * best.loss();
    near && within_error(&plain) && within_error(&logs)
}

fn within_error(differences: &[f64]) -> bool {
    let n = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / n;
    let squares = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>();
    mean <= SAME * (squares / (n - 1.0) / n).sqrt()
}
