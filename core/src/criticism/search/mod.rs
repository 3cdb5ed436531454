//! Finding the best fit of one structure from several starting points.

mod pair;
mod points;
mod screened;

use std::collections::VecDeque;

use super::data::Data;
use super::fit::{Fit, same_place};
use super::guess::guess;
use super::knowledge::Knowledge;
use super::structure::Structure;
use crate::effect::baseline::Baseline;
use crate::effect::{Scales, baseline};
use crate::model::Start;

/// Iterations that every starting point gets before the best are chosen.
const SCAN_ITERATIONS: usize = 2;

/// Starting points that get them; of more, those that are best after a first iteration.
const SHORTLIST: usize = 4;

/// A starting point that still costs this many times the present model is not followed.
const HOPELESS: f64 = 10.0;

/// A starting point is not given up while an iteration brings its cost below this share.
const COMING_ON: f64 = 0.5;

/// Starting points that cost this many times the best one after a few iterations may still lead farther than that.
const FAR_BEHIND: f64 = 4.0;

/// Starting points that are followed on the whole record.
const FINALISTS: usize = 3;

/// A fit that costs this many times the best one of its effect is not followed.
const NEAR: f64 = 2.0;

/// A fit on the whole record that costs this many times what it did on a part has unsuited states.
const UNSETTLED: f64 = 1.5;

/// A fit that goes on is hoped to fall by this many times its last fall.
const HOPE: f64 = 3.0;

/// The fitted model that effects are added to.
#[derive(Clone, Copy)]
pub(super) struct Ground {
    /// Cost on the scout below which a starting point must come to be followed.
    pub limit: f64,
    /// The same after its first iteration.
    pub reach: f64,
    /// Share of the squared error above which a force need not be looked for any more.
    pub share: f64,
    /// The model leaves nothing but noise: its body and its effects are not led astray by a missing one, so that
    /// no other values of theirs are tried with a new effect.
    pub settled: bool,
}

/// Values and states of the windows from which a fit starts.
pub(super) type Point = (Vec<f64>, Vec<Start>);

/// A search that goes on piece by piece.
pub(super) struct Search {
    structure: Structure,
    pending: VecDeque<Point>,
    /// Points with what a first iteration on the scout brings them to: the best so far, since each holds a motion.
    tried: Vec<(Fit, Point)>,
    /// The best of these, worst first; without that iteration where they are few.
    shortlist: Vec<(Option<Fit>, Point)>,
    /// What they came to on the scout, the best first once all are tried.
    scanned: Vec<(Fit, Vec<Start>)>,
    /// Share of the record that the scout is.
    share: f64,
    finalists: Vec<Fit>,
    /// No starting point came to be followed.
    given_up: bool,
    /// Cost of the model that this one would replace.
    present: f64,
    /// Cost on the scout below which a starting point must come to be followed.
    limit: f64,
    /// The same after its first iteration.
    reach: f64,
    /// The model to which an effect is added leaves nothing but noise.
    settled: bool,
    /// Whether a point that does not come to be followed is tried again with another body.
    retries: bool,
    total: usize,
    optimism: f64,
}

impl Search {
    /// Fits the baseline from a regression.
    pub fn baseline(data: &Data, knowledge: &Knowledge) -> Self {
        let structure = Structure::new(data.baseline, Vec::new(), knowledge.clone());
        let plain = Baseline::plain();
        let guess = guess(data, &data.excitation.effective_input(&plain));
        let mut values = guess.unwrap_or_else(|| data.baseline.unknown());
        structure.begin(&mut values, 0);
        Self::from_points(
            structure,
            vec![(values, data.guessed_starts())],
            f64::INFINITY,
        )
    }

    /// Fits a model of a process as one that integrates.
    pub fn integrating(fit: &Fit) -> Self {
        let (structure, values) = fit.structure.integrating(&fit.values);
        let point = (values, fit.starts.clone());
        Self::from_points(structure, vec![point], f64::INFINITY)
    }

    /// Fits the baseline once more, from the body that `scales` hold.
    pub fn held(data: &Data, fit: &Fit, scales: &Scales) -> Self {
        let mut values = fit.values.clone();
        (values[0], values[baseline::DAMPING]) = (scales.inertia, scales.viscous);
        let point = (values, data.guessed_starts());
        Self::from_points(fit.structure.clone(), vec![point], f64::INFINITY)
    }

    /// A search from these points.
    pub(super) fn from_points(structure: Structure, points: Vec<Point>, present: f64) -> Self {
        let few = points.len() <= SHORTLIST;
        let (pending, shortlist) = if few {
            let points = points.into_iter();
            (Vec::new(), points.map(|point| (None, point)).collect())
        } else {
            (points, Vec::new())
        };
        Self {
            structure,
            total: pending.len() + SHORTLIST,
            pending: pending.into(),
            tried: Vec::new(),
            shortlist,
            scanned: Vec::new(),
            share: 1.0,
            finalists: Vec::new(),
            given_up: false,
            present,
            limit: f64::INFINITY,
            reach: f64::INFINITY,
            settled: false,
            retries: false,
            optimism: f64::INFINITY,
        }
    }

    /// Share of the scan that is done, 0 to 1.
    pub fn scanned(&self) -> f64 {
        let left = match self.pending.len() {
            0 => self.shortlist.len(),
            pending => pending + SHORTLIST,
        };
        1.0 - left as f64 / self.total as f64
    }

    /// Tries the next starting point on `scout`; false when all are tried.
    pub fn scan(&mut self, data: &Data, scout: &Data, scales: &Scales) -> bool {
        if let Some(point) = self.pending.pop_front() {
            let mut fit = self.begun(&point, scout, scales);
            fit.iterate(scout, scales);
            self.tried.push((fit, point));
            self.tried.sort_by(|a, b| a.0.cost.total_cmp(&b.0.cost));
            self.tried.truncate(SHORTLIST);
            if self.pending.is_empty() {
                let near = self.tried.partition_point(|(f, _)| f.cost <= self.reach);
                self.tried.truncate(near.max(1));
                let tried = self.tried.drain(..).rev();
                self.shortlist = tried.map(|(fit, point)| (Some(fit), point)).collect();
            }
            return true;
        }
        let Some((known, point)) = self.shortlist.pop() else {
            return false;
        };
        let mut fit = known.unwrap_or_else(|| {
            let mut fit = self.begun(&point, scout, scales);
            fit.iterate(scout, scales);
            fit
        });
        fit.done |= fit.cost > self.reach;
        for _ in 1..SCAN_ITERATIONS {
            fit.iterate(scout, scales);
        }
        if self.retries && self.scanned.is_empty() && fit.cost > self.limit {
            // Perhaps a wrong body led the new effect astray.
            let mut other = self.begun(&point, scout, scales);
            other.fit_body(scout, scales);
            for _ in 0..SCAN_ITERATIONS {
                other.iterate(scout, scales);
            }
            if other.cost < fit.cost {
                fit = other;
            }
        }
        self.scanned.push((fit, point.1));
        if self.shortlist.is_empty() {
            self.rank(data, scout, scales);
        }
        true
    }

    /// A fit on the scout that begins at this point.
    fn begun(&self, (values, starts): &Point, scout: &Data, scales: &Scales) -> Fit {
        let known = starts
            .iter()
            .copied()
            .filter(|s| scout.windows.binary_search(&s.sample).is_ok())
            .collect();
        let mut fit = Fit::new(scout, self.structure.clone(), values.clone(), known, scales);
        if !self.settled {
            fit.take_measured_starts(scout);
        }
        fit
    }

    /// Puts the scanned points in order; those that are not far behind the best go on while they are coming on.
    fn rank(&mut self, data: &Data, scout: &Data, scales: &Scales) {
        self.sort_scanned();
        self.share = scout.used() as f64 / data.used() as f64;
        let Some((best, _)) = self.scanned.first_mut() else {
            return;
        };
        if !self.settled && best.cost > self.limit {
            come_on(best, scout, scales, self.limit);
        }
        if self.settled || best.cost > self.limit {
            return;
        }
        let far = FAR_BEHIND * best.cost;
        for (fit, _) in &mut self.scanned {
            if fit.cost <= far {
                come_on(fit, scout, scales, 0.0);
            }
        }
        self.sort_scanned();
    }

    fn sort_scanned(&mut self) {
        self.scanned.sort_by(|a, b| a.0.cost.total_cmp(&b.0.cost));
    }

    /// Goes on with the best of the scanned points on the whole record.
    fn choose_finalists(&mut self, data: &Data, scales: &Scales) {
        let mut scanned = std::mem::take(&mut self.scanned).into_iter();
        let Some((best, starts)) = scanned.next() else {
            return;
        };
        let hopeless = HOPELESS * self.present * self.share;
        let near = (NEAR * best.cost).min(self.limit);
        let mut first = Fit::new(data, best.structure, best.values, starts, scales);
        self.given_up = best.cost > hopeless.min(self.limit);
        first.done |= self.given_up;
        settle(&mut first, best.cost / self.share, data, scales);
        self.finalists.push(first);
        for (fit, starts) in scanned {
            if self.finalists.len() == FINALISTS {
                break;
            }
            let twin = self
                .finalists
                .iter()
                .any(|f| same_place(&f.values, &fit.values));
            if fit.cost <= near.min(hopeless) && !twin {
                let mut next = Fit::new(data, fit.structure, fit.values, starts, scales);
                settle(&mut next, fit.cost / self.share, data, scales);
                self.finalists.push(next);
            }
        }
    }

    /// Least cost that the scanned points came to on the scout.
    pub fn scouted(&self) -> f64 {
        let costs = self.scanned.iter().map(|(fit, _)| fit.cost);
        costs.fold(f64::INFINITY, f64::min)
    }

    /// Whether no starting point led to where it is worth going on.
    pub fn given_up(&self) -> bool {
        self.given_up
    }

    /// One iteration of every fit that may still win; false when none goes on.
    pub fn iterate(&mut self, data: &Data, scales: &Scales) -> bool {
        if self.finalists.is_empty() {
            self.choose_finalists(data, scales);
        }
        let before: Vec<f64> = self.finalists.iter().map(|fit| fit.cost).collect();
        let all = self.finalists.iter_mut().collect();
        data.crew
            .for_each(all, |fit: &mut Fit| fit.iterate(data, scales));
        let fits = self.finalists.drain(..).zip(before);
        let hoped = |fit: &Fit, before: f64| {
            if fit.done {
                fit.cost
            } else {
                fit.cost - HOPE * (before - fit.cost).max(0.0)
            }
        };
        let mut fits: Vec<(f64, Fit)> = fits
            .map(|(fit, before)| (hoped(&fit, before), fit))
            .collect();
        fits.sort_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        self.optimism = fits.iter().map(|f| f.0).fold(f64::INFINITY, f64::min);
        for (hoped, fit) in fits {
            // One that goes where a better one is, or that is not hoped to come to where the best has ended, may not win.
            let vain = |best: &Fit| fit.cost > NEAR * best.cost || best.done && hoped > best.cost;
            let twin = |better: &Fit| same_place(&better.values, &fit.values);
            if !self.finalists.first().is_some_and(vain) && !self.finalists.iter().any(twin) {
                self.finalists.push(fit);
            }
        }
        self.goes_on()
    }

    /// Whether a fit may still become better.
    pub fn goes_on(&self) -> bool {
        self.finalists.iter().any(|fit| !fit.done)
    }

    /// Least cost so far.
    pub fn cost(&self) -> f64 {
        let costs = self.finalists.iter().map(|fit| fit.cost);
        costs.fold(f64::INFINITY, f64::min)
    }

    /// Cost that the fits could come to, judged by their last iteration.
    pub fn optimism(&self) -> f64 {
        self.optimism
    }

    /// The best fit, with the states of its windows improved if it was fitted to the end.
    pub fn finish(&self, data: &Data, scales: &Scales) -> Option<Fit> {
        let fits = self.finalists.iter();
        let mut best = fits.min_by(|a, b| a.cost.total_cmp(&b.cost))?.clone();
        if best.done && !self.given_up && best.cost.is_finite() {
            best.polish_starts(data, scales);
            if best.put_in_order(data, scales) {
                best.polish_starts(data, scales);
            }
            best.mend_odd_windows(data, scales);
        }
        Some(best)
    }
}

/// Iterates while that brings the cost far down, until it is as low as `enough`.
fn come_on(fit: &mut Fit, data: &Data, scales: &Scales, enough: f64) {
    while fit.cost > enough && !fit.done {
        let before = fit.cost;
        fit.iterate(data, scales);
        if fit.cost > COMING_ON * before {
            break;
        }
    }
}

/// The states of the windows belong to the model before: where they do not suit the new one, which came
/// to `expected` on the scout, they are improved first.
fn settle(fit: &mut Fit, expected: f64, data: &Data, scales: &Scales) {
    if !fit.done && fit.cost > UNSETTLED * expected {
        fit.take_measured_starts(data);
        fit.polish_starts(data, scales);
    }
}
