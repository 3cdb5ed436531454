//! Finding the best fit of one structure from several starting points.

use std::collections::VecDeque;

use super::baseline;
use super::data::Data;
use super::fit::Fit;
use super::structure::Structure;
use crate::effect::{Effect, Scales};
use crate::model::Start;

/// Iterations that every starting point gets before the best are chosen.
const SCAN_ITERATIONS: usize = 2;

/// A starting point that still costs this many times the present model is not followed.
const HOPELESS: f64 = 10.0;

/// A regressed baseline that differs by less than this share from the present one is no new start.
const WORTH_A_START: f64 = 0.2;

/// Effects with at most this many starting values have one valley.
const FEW_STARTS: usize = 1;

/// Starting points that are followed to the end.
const FINALISTS: usize = 3;

/// A search that goes on piece by piece.
pub(super) struct Search {
    structure: Structure,
    pending: VecDeque<(Vec<f64>, Vec<Start>)>,
    scanned: Vec<(Fit, Vec<Start>)>,
    finalists: VecDeque<Fit>,
    best: Option<Fit>,
    /// Cost of the model that this one would replace.
    present: f64,
    total: usize,
    steps: usize,
}

impl Search {
    /// Fits the baseline from a regression.
    pub fn baseline(data: &Data) -> Self {
        let structure = Structure::new(data.kind, Vec::new());
        let plain = baseline::model(data.kind, &[1.0, 1.0]);
        let guess = baseline::guess(data, &data.excitation.effective_input(&plain));
        let values = guess.unwrap_or_else(|| vec![1.0, 1.0]);
        Self::from_points(
            structure,
            vec![(values, data.guessed_starts())],
            f64::INFINITY,
        )
    }

    /// Adds `effect` to a fitted model; starts from its own values and from a fresh regression of
    /// the baseline, since a missing effect may have bent the baseline far off.
    pub fn adding(data: &Data, fit: &Fit, effect: &'static dyn Effect, scales: &Scales) -> Self {
        let structure = fit.structure.with(effect);
        let mut points = Vec::new();
        for start in effect.starts(scales) {
            let mut values = fit.values.clone();
            values.extend(&start);
            points.push((values.clone(), fit.starts.clone()));
            points.extend(Self::regressed(data, fit, &structure, values));
        }
        points.extend(Self::other_valleys(data, fit, &structure, effect, scales));
        Self::from_points(structure, points, fit.cost)
    }

    /// The same point with the baseline regressed anew, if that is somewhere else.
    fn regressed(
        data: &Data,
        fit: &Fit,
        structure: &Structure,
        mut values: Vec<f64>,
    ) -> Option<(Vec<f64>, Vec<Start>)> {
        let guess = baseline::guess(
            data,
            &data.excitation.effective_input(&structure.model(&values)),
        )?;
        let far = guess
            .iter()
            .zip(&fit.values)
            .any(|(g, v)| (g - v).abs() > WORTH_A_START * v.abs());
        values[..guess.len()].copy_from_slice(&guess);
        far.then(|| (values, data.guessed_starts()))
    }

    /// An effect found while another one was missing may sit in a wrong valley: its own starting
    /// values are tried again together with the new effect.
    fn other_valleys(
        data: &Data,
        fit: &Fit,
        structure: &Structure,
        effect: &'static dyn Effect,
        scales: &Scales,
    ) -> Vec<(Vec<f64>, Vec<Start>)> {
        let mut points = Vec::new();
        let own = effect.starts(scales);
        if own.len() > FEW_STARTS {
            return points;
        }
        for (index, present) in fit.structure.effects.iter().enumerate() {
            let starts = present.starts(scales);
            if starts.len() <= FEW_STARTS || present.parameters().len() > 1 {
                continue;
            }
            for start in &own {
                for other in &starts {
                    let mut values = fit.values.clone();
                    values[fit.structure.range(index)].copy_from_slice(other);
                    values.extend(start);
                    points.extend(Self::regressed(data, fit, structure, values));
                }
            }
        }
        points
    }

    /// Refits without the effect at `index`.
    pub fn removing(fit: &Fit, index: usize) -> Self {
        let mut values = fit.values.clone();
        values.drain(fit.structure.range(index));
        Self::from_points(
            fit.structure.without(index),
            vec![(values, fit.starts.clone())],
            f64::INFINITY,
        )
    }

    fn from_points(
        structure: Structure,
        points: Vec<(Vec<f64>, Vec<Start>)>,
        present: f64,
    ) -> Self {
        Self {
            structure,
            total: points.len(),
            pending: points.into(),
            scanned: Vec::new(),
            finalists: VecDeque::new(),
            best: None,
            present,
            steps: 0,
        }
    }

    /// Share done, 0 to 1, roughly.
    pub fn fraction(&self) -> f64 {
        let scan = (self.total * SCAN_ITERATIONS) as f64;
        (self.steps as f64 / (scan + 16.0)).min(1.0)
    }

    /// Goes on with the best of the scanned points on the whole record.
    fn choose_finalists(&mut self, data: &Data, scout: &Data, scales: &Scales) {
        self.scanned.sort_by(|a, b| a.0.cost.total_cmp(&b.0.cost));
        let hopeless = HOPELESS * self.present * scout.len() as f64 / data.len() as f64;
        for (rank, (fit, starts)) in std::mem::take(&mut self.scanned).into_iter().enumerate() {
            if rank < FINALISTS && (rank == 0 || fit.cost <= hopeless) {
                let mut next = Fit::new(data, fit.structure, fit.values, starts, scales);
                if fit.cost > hopeless {
                    next.done = true;
                }
                self.finalists.push_back(next);
            }
        }
    }

    /// One iteration of one fit; the best fit when finished. Starting points are tried on `scout`.
    pub fn advance(&mut self, data: &Data, scout: &Data, scales: &Scales) -> Option<Fit> {
        self.steps += 1;
        if let Some((values, starts)) = self.pending.pop_front() {
            let known = starts
                .iter()
                .copied()
                .filter(|s| s.sample < scout.len())
                .collect();
            let mut fit = Fit::new(scout, self.structure.clone(), values, known, scales);
            for _ in 0..SCAN_ITERATIONS {
                fit.iterate(scout, scales);
            }
            self.scanned.push((fit, starts));
            if self.pending.is_empty() {
                self.choose_finalists(data, scout, scales);
            }
            return None;
        }
        if let Some(fit) = self.finalists.front_mut() {
            fit.iterate(data, scales);
            if fit.done
                && let Some(fit) = self.finalists.pop_front()
                && self.best.as_ref().is_none_or(|best| fit.cost < best.cost)
            {
                self.best = Some(fit);
            }
            return None;
        }
        let mut best = self.best.take()?;
        best.polish_starts(data, scales);
        Some(best)
    }
}
