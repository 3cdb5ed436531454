//! The way from the baseline to the model on screen, back and forth; and proposals that are looked for again.

use hysteron_core::diagnosis::{Limits, StepReport};
use hysteron_core::effect::EffectId;

use super::state::Compare;
use crate::jobs::Job;
use hysteron_work::tasks::ExperimentTask;

impl Compare {
    /// Every effect that was added, those that were taken back last.
    pub(super) fn way(&self) -> Vec<EffectId> {
        let shown = self.shown.as_deref().unwrap_or_default();
        // While a job runs, the way is that of the model on screen.
        let effects = if self.job.is_some() && shown != self.effects {
            return shown.to_vec();
        } else {
            &self.effects
        };
        [effects.as_slice(), &self.undone].concat()
    }

    /// Shows the model with these effects; what comes behind them on the way stays at hand.
    pub(super) fn go_to(&mut self, ctx: &egui::Context, effects: Vec<EffectId>) {
        let way = [self.effects.as_slice(), &self.undone].concat();
        self.undone = way
            .strip_prefix(effects.as_slice())
            .map_or_else(Vec::new, <[EffectId]>::to_vec);
        self.effects = effects;
        self.start(ctx);
    }

    /// Shows the model with so many effects of the way.
    pub(super) fn step_to(&mut self, ctx: &egui::Context, count: usize) {
        let mut way = [self.effects.as_slice(), &self.undone].concat();
        way.truncate(count);
        self.go_to(ctx, way);
    }

    /// The step before the one on screen.
    pub(super) fn report_before(&self) -> Option<&StepReport> {
        self.reports.get(self.effects_before()?)
    }

    /// Its effects; the first step has none before it.
    pub(super) fn effects_before(&self) -> Option<&[EffectId]> {
        let (_, before) = self.shown.as_ref()?.split_last()?;
        Some(before)
    }

    /// The errors on the way, as far as they are known, for tests.
    pub(super) fn way_errors(&self) -> Vec<Option<f64>> {
        let way = self.way();
        let steps = (0..=way.len()).map(|n| self.reports.get(&way[..n]));
        steps.map(|r| r.map(|r| r.step.error)).collect()
    }

    /// The step of the way to compute next: the one before that on screen may be wanted beside it.
    fn unknown(&self) -> Option<Vec<EffectId>> {
        let way = self.way();
        let all = (0..=way.len()).map(|n| &way[..n]);
        self.effects_before()
            .into_iter()
            .chain(all)
            .find(|step| !self.reports.contains_key(*step) && !self.lost.contains(*step))
            .map(<[EffectId]>::to_vec)
    }

    /// Has the steps computed that are missing on the way to the model on screen, one after the other, and takes what
    /// has been found.
    pub(super) fn take_earlier(&mut self, ctx: &egui::Context) {
        if let Some((effects, job)) = &mut self.earlier {
            let Some(end) = job.end(|_, _| ()) else {
                return;
            };
            let effects = std::mem::take(effects);
            self.earlier = None;
            match end {
                Ok(report) => {
                    self.reports.insert(effects, report);
                }
                Err(text) => {
                    self.message = Some(text);
                    self.before &= self.effects_before() != Some(effects.as_slice());
                    self.lost.insert(effects);
                }
            }
            return;
        }
        if self.job.is_some() || self.shown.is_none() {
            return;
        }
        if let (Some(step), Some(measurement)) = (self.unknown(), &self.measurement) {
            let job = Job::start(ctx, measurement, &step, self.model.as_ref());
            self.earlier = Some((step, job));
        }
    }

    /// The effect whose fingerprint is shown.
    pub(super) fn chosen(&self) -> Option<EffectId> {
        let report = self.report()?;
        let known = |id: &EffectId| report.fingerprints.iter().any(|f| f.effect == *id);
        let guessing = self.is_guessing();
        let first = if guessing {
            Self::prints(report).first().copied()
        } else {
            report.fingerprints.first().map(|f| f.effect)
        };
        self.fingerprint
            .filter(known)
            .or(report.suggestion.filter(known).filter(|_| !guessing))
            .or(first)
    }

    /// Looks for a proposal again, within these limits.
    pub(super) fn search_again(&mut self, ctx: &egui::Context, index: usize, limits: Limits) {
        let (Some(measurement), Some(effects)) = (&self.measurement, &self.shown) else {
            return;
        };
        let verdict = self.report().and_then(|r| r.verdict.as_ref());
        let Some(proposal) = verdict.and_then(|v| v.experiments.get(index)) else {
            return;
        };
        let task = ExperimentTask {
            measurement: Box::new((**measurement).clone()),
            model: self.model.clone(),
            models: proposal.models.clone(),
            limits,
            today: proposal.today,
        };
        self.search = Some((effects.clone(), index, Job::run(ctx, task)));
    }

    /// Takes what a search has found.
    pub(super) fn take_search(&mut self) {
        let Some((effects, index, job)) = &mut self.search else {
            return;
        };
        let Some(end) = job.end(|_, _| ()) else {
            return;
        };
        match end {
            Ok(found) => {
                let report = self.reports.get_mut(effects);
                if let Some(verdict) = report.and_then(|r| r.verdict.as_mut()) {
                    verdict.replace_experiment(*index, found);
                }
                self.limits = None;
            }
            Err(text) => self.message = Some(text),
        }
        self.search = None;
    }
}
