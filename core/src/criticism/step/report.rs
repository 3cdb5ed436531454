//! What a step tells: the model, what could be added, and the verdict where nothing is.

use super::StepJob;
use crate::criticism::fingerprint::fingerprints;
use crate::criticism::judge::{alike, helps_clearly, nested};
use crate::criticism::knowledge::overruled;
use crate::criticism::missing::missing_parts;
use crate::criticism::one_way::OneWay;
use crate::criticism::ranking::{noise_floor, rank};
use crate::criticism::residual_test::residual_tests;
use crate::criticism::score::share_left;
use crate::criticism::select::delta_bic;
use crate::criticism::session::{Rest, Scored};
use crate::criticism::verdict::{
    add_both_ways, add_experiments, add_glitches, add_held, add_hint, add_idle, add_imitations,
    add_input_check, add_integrating, add_limited, add_overruled, add_pauses, add_rest, verdict,
};
use crate::diagnosis::{Candidate, Step, StepReport};
use crate::effect::{Effect, EffectId};

impl StepJob {
    pub(super) fn report(&self) -> Option<StepReport> {
        let model = self.model.as_ref()?;
        let suggested = self.suggestion(model);
        let suggestion = suggested.map(|(e, _)| e.id());
        let needless = self.needless(model);
        let whole = self.session.completed(model);
        let parameters = self.session.parameters(&whole);
        let rest = self.session.rest(&whole);
        let findings = match rest {
            Rest::More => self.session.findings(&whole),
            Rest::Noise | Rest::NoiseWithMemory | Rest::RandomForces => Vec::new(),
        };
        let verdict = (suggestion.is_none() && needless.is_empty()).then(|| {
            let places = (0..self.wanted.len()).filter(|k| !self.is_present(*k));
            let mut places: Vec<usize> = places.collect();
            places.sort_by_key(|k| self.found(self.wanted[*k]));
            let (mut added, mut classes): (Vec<_>, Vec<_>) = places
                .into_iter()
                .map(|k| {
                    (
                        (self.wanted[k], self.session.tells_of_record(&model.fit, k)),
                        self.classes.get(k).cloned().unwrap_or_default(),
                    )
                })
                .unzip();
            let one_way = OneWay::of(&self.session);
            let is_joined = one_way
                .is_some_and(|o| o.join(&self.session, &model.fit, &mut added, &mut classes));
            let mut verdict = verdict(
                &added,
                &classes,
                &parameters,
                &whole,
                rest,
                self.contradicted.clone(),
            );
            let first = self.session.first(&whole).error;
            add_rest(&mut verdict, rest, &whole.score, first, &findings);
            add_integrating(&mut verdict, &parameters);
            add_imitations(&mut verdict, &self.barred);
            add_hint(&mut verdict, self.hint(model));
            // What is held wrongly says nothing of what is needed.
            let present = if self.contradicted.is_empty() {
                self.idle(model).0
            } else {
                Vec::new()
            };
            let present = present.into_iter();
            let (unsure, idle): (Vec<_>, Vec<_>) = present.partition(|id| self.lowers(model, *id));
            add_idle(&mut verdict, &idle, &unsure);
            if is_joined {
                add_both_ways(&mut verdict);
            } else {
                add_experiments(&mut verdict, &self.experiments);
            }
            add_input_check(&mut verdict, &self.session.input_check);
            add_glitches(&mut verdict, self.session.whole().glitches);
            add_pauses(&mut verdict, self.session.whole().pauses);
            add_held(&mut verdict, self.session.whole());
            add_limited(&mut verdict, self.session.whole());
            add_overruled(&mut verdict, overruled(&self.session, &whole));
            verdict
        });
        let unknown = verdict.as_ref().is_some_and(|v| v.unknown);
        let tried: Vec<(EffectId, &Scored)> = self.tried.iter().map(|(e, s)| (e.id(), s)).collect();
        // Effects are compared on a part of a long record: their errors are put in proportion to all of it.
        let share = whole.score.error / model.score.error;
        let mut candidates = self.candidates(model, suggestion);
        for candidate in candidates.iter_mut().filter(|_| share.is_finite()) {
            candidate.error *= share;
        }
        // What is going to be added is said as it will be.
        if let (Some((_, added)), Some(leads)) = (suggested, candidates.first_mut()) {
            leads.error = self.session.completed(added).score.error;
        }
        Some(StepReport {
            fingerprints: fingerprints(&self.session, model, &tried, &findings),
            missing: if unknown {
                missing_parts(&self.session, &whole)
            } else {
                Vec::new()
            },
            step: Step {
                effects: self.session.effects(&model.fit),
                error: whole.score.error,
                error_fit: whole.score.error_fit,
                left: share_left(self.session.whole(), &whole.score),
                parameters,
                findings,
                tests: residual_tests(self.session.whole(), &whole.fit.motion),
                candidates,
            },
            noise_floor: noise_floor(rest, &whole.score),
            noise: self.session.channel_noise(),
            replay: self.session.replay(&whole.fit),
            atlas: self.session.atlas(&whole.fit),
            suggestion,
            needless,
            verdict,
        })
    }

    /// Every effect tried, best first, the simpler one of two as good; the suggested one leads.
    fn candidates(&self, model: &Scored, suggestion: Option<EffectId>) -> Vec<Candidate> {
        let length = model.fit.values.len();
        let first = self.session.first(model);
        let mut candidates: Vec<Candidate> = self
            .tried
            .iter()
            .map(|(effect, scored)| {
                let worse = scored.score.fit_cost > model.score.fit_cost;
                let equivalent_to = self
                    .tried
                    .iter()
                    .filter(|(other, o)| {
                        !nested(*other, *effect)
                            && helps_clearly(model, scored, first)
                            && helps_clearly(model, o, first)
                            && alike(scored, o)
                    })
                    .map(|(other, _)| other.id())
                    .collect();
                Candidate {
                    effects: vec![effect.id()],
                    // Every effect contains "none of it", so it never has to make things worse.
                    error: if worse {
                        model.score.error
                    } else {
                        scored.score.error
                    },
                    delta_bic: if worse {
                        effect.parameters().len() as f64 * libm::log(model.score.fit_count)
                    } else {
                        delta_bic(&model.score, length, &scored.score, scored.fit.values.len())
                    },
                    significant: helps_clearly(model, scored, first),
                    promising: self.is_promising(model, *effect, scored),
                    parameters: self
                        .session
                        .parameters(scored)
                        .into_iter()
                        .filter(|p| p.effect == Some(effect.id()))
                        .collect(),
                    equivalent_to,
                }
            })
            .collect();
        let untried: Vec<Candidate> = self
            .others()
            .into_iter()
            .filter(|e| self.tried.iter().all(|(tried, _)| tried.id() != e.id()))
            .map(|e| as_its_best_part(e, &candidates, model))
            .collect();
        candidates.extend(untried);
        rank(&mut candidates, suggestion);
        candidates
    }
}

/// An effect that was not worth a fit, among the `candidates` that were: it does at least what the best of its parts
/// does, and was not seen to do more.
fn as_its_best_part(
    effect: &'static dyn Effect,
    candidates: &[Candidate],
    model: &Scored,
) -> Candidate {
    let more = |from: usize| {
        let values = effect.parameters().len().saturating_sub(from);
        values as f64 * libm::log(model.score.fit_count)
    };
    let part = candidates
        .iter()
        .filter(|c| c.effects.iter().all(|id| effect.has_part(*id)))
        .min_by(|a, b| a.error.total_cmp(&b.error));
    Candidate {
        effects: vec![effect.id()],
        error: part.map_or(model.score.error, |p| p.error),
        delta_bic: part.map_or(more(0), |p| p.delta_bic + more(p.parameters.len())),
        significant: part.is_some_and(|p| p.significant),
        promising: part.is_some_and(|p| p.promising),
        parameters: Vec::new(),
        equivalent_to: Vec::new(),
    }
}
