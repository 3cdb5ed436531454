//! What to add, to leave out, or to follow on trial, of what a step has fitted.

use super::StepJob;
use crate::criticism::judge::{
    HUGE_FALL, alike, helps_clearly, is_certain, may_hide, nested, part_does, tied,
};
use crate::criticism::knowledge::contradictions;
use crate::criticism::score::Score;
use crate::criticism::select::{
    LEAST_FALL, fall, fall_on_both, goes_first, helps, is_plain_noise, outweighs,
};
use crate::criticism::session::Scored;
use crate::diagnosis::Contradiction;
use crate::effect::{Effect, EffectId};

/// The effect that is tried together with others where nothing helps by itself.
const COMPANION: EffectId = EffectId::new("constant_load");

/// Relative fall of the error on both parts from which an effect is mentioned though chance is not ruled out.
const HINT_FALL: f64 = 0.3;

impl StepJob {
    /// Known values that the data contradict more than they want any effect.
    pub(super) fn contradictions(&self) -> Vec<Contradiction> {
        let Some(model) = &self.model else {
            return Vec::new();
        };
        // What takes the place of an effect of the user's model lets go of what was known of it.
        let keeps = |e: &dyn Effect| {
            let mut parts = e.contains().iter();
            !parts.any(|part| self.session.knowledge.has(*part))
        };
        let best = self.suggestion(model).filter(|(e, _)| keeps(*e));
        let best = best.map_or(f64::INFINITY, |(_, s)| s.score.error);
        contradictions(&self.session, model, best)
    }

    /// The effect to add next: the best that helps; of equals the one with fewer parameters, or that stands
    /// first in the registry.
    pub(super) fn suggestion(&self, model: &Scored) -> Option<&(&'static dyn Effect, Scored)> {
        if !self.contradicted.is_empty() {
            return None;
        }
        let first = self.session.first(model);
        let helping = || {
            self.tried
                .iter()
                .filter(|(e, _)| !self.barred.contains(&e.id()))
                .filter(|(_, s)| self.session.is_sizeable(&s.fit))
                .filter(|(_, s)| helps_clearly(model, s, first))
        };
        let best = helping().min_by(|a, b| a.1.score.error.total_cmp(&b.1.score.error))?;
        helping()
            .filter(|(e, s)| {
                if best.0.has_part(e.id()) {
                    let place = best.1.fit.structure.effects.len() - 1;
                    part_does(&best.1, s, place, first)
                        || goes_first(&model.score, &s.score, &best.1.score)
                } else {
                    let (own, most) = (s.fit.values.len(), best.1.fit.values.len());
                    alike(s, &best.1) && (own < most || (own == most && tied(s, &best.1)))
                }
            })
            .min_by_key(|(_, s)| s.fit.values.len())
            .or(Some(best))
    }

    /// The model with what the screen found together, where that leaves far less than `model` and than the best with one
    /// effect.
    pub(super) fn together(&self, model: &Scored, best: Option<&Scored>) -> Option<&Scored> {
        let less = |than: &Scored, found: &&Scored| {
            helps(&than.score, &found.score) && fall(&than.score, &found.score) > HUGE_FALL
        };
        let found = self.screened.as_ref().filter(|found| less(model, found));
        found.filter(|found| best.is_none_or(|best| less(best, found)))
    }

    /// Effects without which the held-back error does not rise; those of the user's model stay.
    pub(super) fn needless(&self, model: &Scored) -> Vec<EffectId> {
        if !self.contradicted.is_empty() {
            return Vec::new();
        }
        let (_, own) = self.idle(model);
        own
    }

    /// Effects without which the held-back error does not rise, or that do not show their marks: of the user's model, and
    /// others.
    pub(super) fn idle(&self, model: &Scored) -> (Vec<EffectId>, Vec<EffectId>) {
        // Where nothing but noise is left, and more without an effect, it is needed wherever it acts.
        let explains = |without: &Score| {
            is_plain_noise(&model.score)
                && !is_plain_noise(without)
                && outweighs(without.error, model.score.error)
        };
        let idle = |without: &Score| !helps(without, &model.score) && !explains(without);
        // Of two that do the same between them, the one of which nothing is seen.
        let unseen = |place: usize, without: &Scored| {
            is_plain_noise(&without.score) && !is_certain(without, model, place)
        };
        let shows = |e: &dyn Effect| model.shows_marks_of(e, &self.session.scales);
        self.wanted
            .iter()
            .zip(&self.without)
            .enumerate()
            .filter(|(place, (e, without))| {
                idle(&without.score) || !shows(**e) || unseen(*place, without)
            })
            .map(|(_, (e, _))| e.id())
            .partition(|id| self.session.knowledge.has(*id))
    }

    /// Whether the effect of this id lowers the error of the model, though perhaps not beyond chance.
    pub(super) fn lowers(&self, model: &Scored, id: EffectId) -> bool {
        let place = self.wanted.iter().position(|w| w.id() == id);
        let without = place.and_then(|place| self.without.get(place));
        without.is_some_and(|without| fall(&without.score, &model.score) > LEAST_FALL)
    }

    /// Whether a model with this effect leaves much less on both parts of the record, though chance is not ruled out.
    pub(super) fn is_promising(&self, model: &Scored, effect: &dyn Effect, with: &Scored) -> bool {
        let much = fall_on_both(&model.score, &with.score) > HINT_FALL;
        let clearly = helps_clearly(model, with, self.session.first(model));
        much && !clearly && !self.barred.contains(&effect.id())
    }

    /// The effect that would lower the error most, and to what, where that is much and yet not beyond chance.
    pub(super) fn hint(&self, model: &Scored) -> Option<(EffectId, f64)> {
        let unsure = self
            .tried
            .iter()
            .filter(|(e, s)| self.is_promising(model, *e, s));
        let best = unsure.min_by(|a, b| a.1.score.error.total_cmp(&b.1.score.error));
        best.map(|(e, s)| (e.id(), self.session.completed(s).score.error))
    }

    /// In a last model that leaves more than noise, this `error` on the whole record, the effect that explains
    /// least, if that is less than what is left or its size is not known to differ from 0, and the model without it:
    /// it may as well imitate a part of what no effect explains.
    pub(in crate::criticism) fn imitation(&self, error: f64) -> Option<(EffectId, Scored)> {
        self.wanted
            .iter()
            .zip(&self.without)
            .enumerate()
            .filter(|(_, (e, _))| !self.session.knowledge.has(e.id()))
            // Where a long record was thinned, all of it decides.
            .map(|(place, (e, without))| {
                let completed = self.session.completed(without).score.error;
                (place, e.id(), without, completed)
            })
            .filter(|(place, _, without, completed)| {
                let certain = |model| is_certain(without, model, *place);
                !outweighs(*completed, error) || !self.model.as_ref().is_none_or(certain)
            })
            .min_by(|a, b| a.3.total_cmp(&b.3))
            .map(|(_, id, without, _)| (id, without.clone()))
    }

    /// Models with an effect that lowers the error much, though not beyond chance while the rest is as
    /// correlated as it is: the best first. Two missing effects may hide each other so.
    pub(in crate::criticism) fn faint(&self, count: usize) -> Vec<Scored> {
        let Some(model) = self.model.as_ref().filter(|_| self.contradicted.is_empty()) else {
            return Vec::new();
        };
        let mut seen: Vec<&Scored> = self
            .tried
            .iter()
            .map(|(_, s)| s)
            .filter(|s| may_hide(model, s))
            .collect();
        seen.sort_by(|a, b| a.score.error.total_cmp(&b.score.error));
        seen.truncate(count);
        // A constant load hides behind almost anything that repeats.
        let loaded = self.tried.iter().find(|(e, _)| e.id() == COMPANION);
        seen.extend(loaded.map(|(_, s)| s));
        seen.into_iter().cloned().collect()
    }

    /// The model with what the screen found together, then those with another effect that would help too, the best first:
    /// where the suggestion may turn out to lead astray.
    pub(in crate::criticism) fn alternatives(&self, count: usize) -> Vec<Scored> {
        let Some(model) = &self.model else {
            return Vec::new();
        };
        let Some((suggested, _)) = self.suggestion(model) else {
            return Vec::new();
        };
        let first = self.session.first(model);
        let mut others: Vec<&Scored> = self
            .tried
            .iter()
            .filter(|(e, s)| !nested(*e, *suggested) && helps_clearly(model, s, first))
            .map(|(_, s)| s)
            .collect();
        others.sort_by(|a, b| a.score.error.total_cmp(&b.score.error));
        let found = self.screened.iter().filter(|found| may_hide(model, found));
        found.chain(others).take(count).cloned().collect()
    }
}
