//! When a formula of what no effect explains is looked for, and what becomes of one that is found.

use hysteron_core::diagnosis::{Candidate, Discovery, FoundFormula, NextExperiment, Reach};
use hysteron_core::effect::EffectId;
use hysteron_work::tasks::DiscoveryTask;

use super::command::Command;
use super::formula::Typed;
use super::state::Compare;
use super::unknown::Searching;
use crate::jobs::Job;

impl Compare {
    /// Looks for a formula beside the model on screen.
    pub(super) fn discover(&mut self, ctx: &egui::Context) {
        let (Some(measurement), Some(effects)) = (&self.measurement, &self.shown) else {
            return;
        };
        let task = DiscoveryTask {
            measurement: Box::new((**measurement).clone()),
            effects: effects.clone(),
            model: self.model.clone(),
        };
        self.unknown.searching = Some(Searching {
            effects: effects.clone(),
            job: Job::run(ctx, task),
            progress: (0.0, "Looking for a formula".into()),
        });
    }

    /// Stops looking.
    pub(super) fn stop_discovery(&mut self) {
        let searching = self.unknown.searching.take();
        self.unknown.left.extend(searching.map(|s| s.effects));
    }

    /// Takes what was found, and begins by itself where a diagnosis has ended as unknown and nothing else is to be
    /// done.
    pub(super) fn take_discovery(&mut self, ctx: &egui::Context) {
        if let Some(searching) = &mut self.unknown.searching {
            let progress = &mut searching.progress;
            let Some(end) = searching.job.end(|share, text| *progress = (share, text)) else {
                return;
            };
            let effects = std::mem::take(&mut searching.effects);
            self.unknown.searching = None;
            match end {
                Ok(found) => self.unknown.found.push((effects, found)),
                Err(text) => {
                    self.unknown.left.push(effects);
                    self.message = Some(text);
                }
            }
        } else if self.begins_by_itself() {
            self.discover(ctx);
        }
    }

    fn begins_by_itself(&self) -> bool {
        let idle = self.job.is_none()
            && self.opening.is_none()
            && self.earlier.is_none()
            && self.search.is_none()
            && self.hand.is_none()
            && !self.is_behind();
        let (Some(shown), true) = (&self.shown, idle) else {
            return false;
        };
        self.is_unknown() && self.discovery().is_none() && !self.unknown.left.contains(shown)
    }

    /// Whether the diagnosis has ended without an explanation of what the model on screen leaves.
    pub(super) fn is_unknown(&self) -> bool {
        self.report().is_some_and(|report| {
            let verdict = report.verdict.as_ref();
            let unknown = verdict.is_some_and(|v| v.unknown && v.contradicted.is_empty());
            unknown && report.needless.is_empty()
        })
    }

    /// Whether a formula of what is left may be wanted: no effect takes most of it.
    pub(super) fn may_discover(&self) -> bool {
        let Some(report) = self.report() else {
            return false;
        };
        let suggested = report.suggestion.filter(|_| !self.is_guessing());
        let leads = |c: &&Candidate| c.effects.first().copied() == suggested;
        let best = report.step.candidates.iter().find(leads);
        let little = best.is_some_and(|c| report.reach_of(c) != Reach::Most);
        self.is_unknown() || suggested.is_some() && little
    }

    /// What was found beside the model on screen.
    pub(super) fn discovery(&self) -> Option<&Discovery> {
        self.unknown.beside(self.shown.as_ref()?)
    }

    /// What was found on the way to the model on screen, the last of it.
    pub(super) fn discovery_on_the_way(&self) -> Option<&Discovery> {
        let shown = self.shown.as_ref()?;
        let mut ways = (0..=shown.len()).rev().map(|n| &shown[..n]);
        ways.find_map(|way| self.unknown.beside(way))
    }

    /// The experiments that are proposed: of classes of effects, and then of formulas.
    pub(super) fn proposals(&self) -> impl Iterator<Item = &NextExperiment> {
        let verdict = self.report().and_then(|r| r.verdict.as_ref());
        let of_effects = verdict.into_iter().flat_map(|v| &v.experiments);
        of_effects.chain(self.discovery().and_then(|d| d.experiment.as_ref()))
    }

    /// Adds a formula to the model as an effect of the user's own, or the same one again.
    pub(super) fn adding(&self, found: &FoundFormula) -> Option<Command> {
        let kind = self.measurement.as_ref()?.kind;
        let same = |line: &&String| **line == found.typed;
        if self.own.iter().any(|line| same(&line)) {
            return EffectId::own(&found.name).map(Command::Add);
        }
        let (_, typed) = found.typed.split_once(':')?;
        Some(Command::AddOwn(Typed {
            kind,
            name: self.free_name(&found.name),
            formula: typed.trim().to_owned(),
        }))
    }
}
