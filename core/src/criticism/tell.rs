//! What is told of a model: where it fails, what could be added, and the verdict where nothing should be.

use super::contradicted::overruled;
use super::dry_or_viscous::InsteadOfViscous;
use super::explain::{
    Difference, Explain, Trial, difference as between, may_replace, outweighs_in_either_half,
};
use super::fingerprint::fingerprints;
use super::left_out::add_left_out;
use super::missing::missing_parts;
use super::next_experiment::{Design, Rival, designs};
use super::one_way::OneWay;
use super::ranking::{noise_floor, rank};
use super::residual_test::residual_tests;
use super::score::share_left;
use super::select::{delta_bic, is_all_that_counters_show, is_noise, outweighs};
use super::session::{Rest, Scored, Session, small_share};
use super::verdict::{
    Class, PartOfTheWay, Refused, add_both_ways, add_dry_friction, add_experiments, add_hint,
    add_idle, add_input_check, add_input_noise, add_integrating, add_one_push,
    add_other_experiment, add_overruled, add_part_of_the_way, add_relay_loop, add_rest, add_wander,
    verdict,
};
use crate::diagnosis::{
    Candidate, Contradiction, Finding, Limits, NextExperiment, Parameter, Step, StepReport, Verdict,
};
use crate::effect::{Effect, EffectId};

/// A model of which the verdict speaks, and what is known of it.
struct Told<'a> {
    /// Place of its trial.
    place: usize,
    trial: &'a Trial,
    /// The same on the whole record.
    whole: &'a Scored,
    rest: Rest,
    parameters: &'a [Parameter],
    /// Where it fails.
    findings: &'a [Finding],
    /// Effects that were tried beside its own, each with its best trial.
    tried: &'a [(&'static dyn Effect, &'a Trial)],
}

/// What is known beside the fits.
pub(super) struct Tell {
    limits: Limits,
    pub experiments: Vec<NextExperiment>,
    pub contradicted: Vec<Contradiction>,
    dry: Option<InsteadOfViscous>,
}

impl Tell {
    pub fn within(limits: Limits) -> Self {
        Self {
            limits,
            experiments: Vec::new(),
            contradicted: Vec::new(),
            dry: None,
        }
    }

    /// Looks whether dry friction does as well as the viscous friction of the best model.
    pub fn compare_frictions(&mut self, session: &Session, explain: &Explain) {
        let best = explain.trials.get(explain.best);
        self.dry = best.and_then(|best| InsteadOfViscous::of(session, best));
    }

    /// Searches for the experiments that tell apart what this one cannot: none where the model does not explain the
    /// record.
    pub fn designs(&self, session: &Session, explain: &Explain) -> Vec<Design> {
        let Some(best) = explain.trials.get(explain.best) else {
            return Vec::new();
        };
        if explain.rivals.is_empty() || session.rest(&session.completed(&best.scored)) == Rest::More
        {
            return Vec::new();
        }
        let rivals: Vec<Rival> = explain
            .rivals
            .iter()
            .map(|r| Rival {
                place: r.place,
                effect: r.effect.id(),
                model: explain.trials[r.trial].scored.clone(),
            })
            .collect();
        designs(session, &best.scored, best.effects(), &rivals, self.limits)
    }

    /// The report on the model with these effects, which is on the way to the best one.
    pub fn report(
        &self,
        session: &Session,
        explain: &Explain,
        ids: &[EffectId],
    ) -> Option<StepReport> {
        let place = explain.of(ids)?;
        let trial = &explain.trials[place];
        let model = &trial.scored;
        let order = explain.order();
        let suggestion = order
            .get(ids.len())
            .copied()
            .filter(|_| self.contradicted.is_empty());
        let whole = session.completed(model);
        let parameters = session.parameters(&whole, &trial.spreads());
        let rest = session.rest(&whole);
        let findings = match rest {
            Rest::More => session.findings(&whole),
            Rest::Noise | Rest::NoiseWithMemory | Rest::RandomForces => Vec::new(),
        };
        // Of what the search took, a later trial may tell less surely that it is needed: it stays, with the error that
        // it has.
        let needless = if suggestion.is_none() && self.contradicted.is_empty() {
            let held = explain.held_ids();
            let mut needless = needless(session, explain, place);
            needless.retain(|id| held.contains(id));
            needless
        } else {
            Vec::new()
        };
        let (present, needless): (Vec<EffectId>, Vec<EffectId>) = needless
            .into_iter()
            .partition(|id| session.knowledge.has(*id));
        let tried = explain.with_one_more(ids);
        let last = suggestion.is_none() && needless.is_empty();
        let overruled = overruled(session, &whole);
        let told = Told {
            place,
            trial,
            whole: &whole,
            rest,
            parameters: &parameters,
            findings: &findings,
            tried: &tried,
        };
        let verdict = last.then(|| {
            let mut verdict = self.verdict(session, explain, &told);
            add_idle(&mut verdict, &present, &[]);
            add_input_check(&mut verdict, &session.input_check, &parameters);
            add_left_out(&mut verdict, session.whole());
            add_overruled(&mut verdict, overruled);
            verdict
        });
        let unknown = verdict.as_ref().is_some_and(|v| v.unknown);
        let scored: Vec<(EffectId, &Scored)> =
            tried.iter().map(|(e, t)| (e.id(), &t.scored)).collect();
        Some(StepReport {
            fingerprints: fingerprints(session, model, &scored, &findings),
            missing: if unknown {
                missing_parts(session, &whole)
            } else {
                Vec::new()
            },
            step: Step {
                effects: session.effects(&model.fit),
                error: whole.score.error,
                error_fit: whole.score.error_fit,
                left: share_left(session.whole(), &whole.score, &whole.fit.motion),
                relay_loop: trial.in_loop,
                parameters,
                findings,
                tests: residual_tests(session.whole(), &whole.fit.motion),
                candidates: candidates(session, trial, &whole, &tried, suggestion),
            },
            noise_floor: noise_floor(rest, &whole.score),
            noise: session.channel_noise(),
            replay: session.replay(&whole.fit),
            atlas: session.atlas(&whole.fit),
            suggestion,
            needless,
            verdict,
        })
    }

    /// What is missing and what is left, how the model does in its own loop, and what would explain a part of the rest.
    fn verdict(&self, session: &Session, explain: &Explain, told: &Told) -> Verdict {
        let mut verdict = self.missing(session, explain, told);
        let first = session.first(told.whole).error;
        let (rest, score) = (told.rest, &told.whole.score);
        add_rest(&mut verdict, rest, score, first, told.findings);
        if let Some(found) = &session.levelled {
            add_input_noise(&mut verdict, found.noise, &session.input_unit);
        }
        if session.data.wander > 0.0 {
            add_wander(&mut verdict);
        }
        add_integrating(&mut verdict, told.parameters);
        let dry = self.dry.as_ref().filter(|_| told.place == explain.best);
        match dry.filter(|_| verdict.contradicted.is_empty()) {
            Some(dry) => add_dry_friction(&mut verdict, dry),
            None => add_relay_loop(&mut verdict, told.trial.in_loop, explain.trials[0].in_loop),
        }
        if verdict.unknown {
            let (trial, tried) = (told.trial, told.tried);
            add_part_of_the_way(&mut verdict, part_of_the_way(session, trial, tried));
            add_hint(&mut verdict, hint(session, trial, tried));
        }
        verdict
    }

    /// What is missing, what could stand in its place, and which experiments tell.
    fn missing(&self, session: &Session, explain: &Explain, told: &Told) -> Verdict {
        let trial = told.trial;
        let order = explain.order();
        let effects = trial.effects();
        let mut places: Vec<usize> = (0..effects.len())
            .filter(|k| !session.knowledge.has(effects[*k].id()))
            .collect();
        places.sort_by_key(|k| order.iter().position(|id| *id == effects[*k].id()));
        let class = |place: usize| -> Class {
            let rivals = explain.rivals.iter().filter(|r| r.place == place);
            rivals.map(|r| r.effect).collect()
        };
        let (mut added, mut classes): (Vec<(&'static dyn Effect, bool)>, Vec<Class>) = places
            .into_iter()
            .map(|k| {
                (
                    (effects[k], session.tells_of_record(&trial.scored.fit, k)),
                    class(k),
                )
            })
            .unzip();
        let one_way = OneWay::of(session);
        let fit = &trial.scored.fit;
        let joins = |o: &OneWay| o.join(session, fit, &mut added, &mut classes);
        let is_joined = one_way.as_ref().is_some_and(joins);
        let mut verdict = verdict(
            &added,
            &classes,
            told.parameters,
            told.whole,
            told.rest,
            self.contradicted.clone(),
        );
        let is_pushed_alike = one_way.is_some_and(|o| o.is_pushed_alike());
        if is_joined {
            add_both_ways(&mut verdict);
        } else if added.is_empty() && is_pushed_alike {
            add_one_push(&mut verdict);
        } else {
            add_other_experiment(&mut verdict, &session.whole().input);
            add_experiments(&mut verdict, &self.experiments);
        }
        verdict
    }
}

/// Effects without which the model explains as much.
fn needless(session: &Session, explain: &Explain, place: usize) -> Vec<EffectId> {
    let effects = explain.trials[place].effects();
    (0..effects.len())
        .filter(|k| !explain.needs(session, place, *k))
        .map(|k| effects[k].id())
        .collect()
}

/// Whether a step explains more than it leaves of either half, and yet not beyond chance.
fn is_promising(difference: &Difference, from: &Trial, to: &Trial) -> bool {
    outweighs_in_either_half(from, to) && !difference.is_better()
}

/// The effects that would lower the error most, and to what, where that is much and yet not beyond chance.
fn hint(
    session: &Session,
    model: &Trial,
    tried: &[(&'static dyn Effect, &Trial)],
) -> Option<(Vec<EffectId>, f64)> {
    let promising = |t: &&(&'static dyn Effect, &Trial)| {
        is_promising(&between(session, model, t.1), model, t.1)
    };
    let promising: Vec<&(&'static dyn Effect, &Trial)> = tried.iter().filter(promising).collect();
    let (best, trial) = promising.first()?;
    let class = same_as(session, best.id(), trial, &promising);
    Some((class, session.completed(&trial.scored).score.error))
}

/// Of the effects that were tried, this one and those that need no more values and leave the same; none that comes near
/// to another of them, or has it as a part.
fn same_as(
    session: &Session,
    best: EffectId,
    trial: &Trial,
    tried: &[&(&'static dyn Effect, &Trial)],
) -> Vec<EffectId> {
    let same = |t: &&&(&'static dyn Effect, &Trial)| {
        t.0.id() == best || does_the_same(session, trial, t.1)
    };
    let same: Vec<&'static dyn Effect> = tried.iter().filter(same).map(|t| t.0).collect();
    let says_more = |e: &&'static dyn Effect| same.iter().all(|other| may_replace(*e, *other));
    let class = same.iter().copied().filter(says_more);
    class.map(Effect::id).collect()
}

/// Whether another model needs no more values and leaves the same.
fn does_the_same(session: &Session, trial: &Trial, other: &Trial) -> bool {
    other.values() <= trial.values() && between(session, trial, other).is_same()
}

/// The effects that lower the error most for certain and were not taken, why not, and the error with them.
fn part_of_the_way(
    session: &Session,
    model: &Trial,
    tried: &[(&'static dyn Effect, &Trial)],
) -> Option<PartOfTheWay> {
    let better = |t: &&(&'static dyn Effect, &Trial)| between(session, model, t.1).is_better();
    let better: Vec<&(&'static dyn Effect, &Trial)> = tried.iter().filter(better).collect();
    // Of what leaves noise, that which needs the fewest values.
    let noise = better.iter().filter(|t| leaves_noise(session, t.1));
    let plain = noise.min_by_key(|t| t.1.values());
    let (best, trial) = plain.or(better.first())?;
    Some(PartOfTheWay {
        class: same_as(session, best.id(), trial, &better),
        error: session.completed(&trial.scored).score.error,
        refused: refused(session, model, trial, best.id()),
    })
}

/// Whether a model leaves noise of either half.
fn leaves_noise(session: &Session, trial: &Trial) -> bool {
    let small = small_share(&trial.scored.fit);
    let mut halves = trial.halves();
    halves.all(|half| {
        is_all_that_counters_show(&half.score) || is_noise(&half.score, session.first(half), small)
    })
}

/// Why an effect that lowers the error for certain is not named.
fn refused(session: &Session, before: &Trial, after: &Trial, effect: EffectId) -> Refused {
    let scored = &after.scored;
    let effects = &scored.fit.structure.effects;
    let Some(place) = effects.iter().position(|e| e.id() == effect) else {
        return Refused::Other;
    };
    if !leaves_noise(session, after) && !outweighs(before.error(), after.error()) {
        Refused::LeavesMore
    } else if !scored.shows_marks_of(effects[place], &session.scales) {
        Refused::WithoutMarks
    } else if !scored.tells_of(place) {
        Refused::MayBeNothing
    } else if !session.is_sizeable(&scored.fit, place) {
        Refused::Trifle
    } else {
        Refused::Other
    }
}

/// Every effect of the library, the best first; the suggested one leads.
fn candidates(
    session: &Session,
    model: &Trial,
    whole: &Scored,
    tried: &[(&'static dyn Effect, &Trial)],
    suggestion: Option<EffectId>,
) -> Vec<Candidate> {
    let before = &model.scored.score;
    let length = model.scored.fit.values.len();
    // Models are compared on a part of a long record: their errors are put in proportion to all of it.
    let share = if before.error > 0.0 {
        whole.score.error / before.error
    } else {
        1.0
    };
    let share = if share.is_finite() { share } else { 1.0 };
    let count = libm::log(before.fit_count);
    let mut candidates: Vec<Candidate> = tried
        .iter()
        .map(|(effect, trial)| {
            let difference = between(session, model, trial);
            let (after, values) = (&trial.scored.score, trial.scored.fit.values.len());
            let worse = trial.error() > model.error();
            let noise = !outweighs(after.error, 1.0);
            let most = outweighs(before.error, after.error) || noise;
            Candidate {
                effects: vec![effect.id()],
                // Every effect contains "none of it", so it never has to make things worse.
                error: share * if worse { before.error } else { after.error },
                delta_bic: if worse {
                    (values as f64 - length as f64) * count
                } else {
                    delta_bic(before, length, after, values)
                },
                significant: difference.is_better() && most,
                promising: is_promising(&difference, model, trial),
                parameters: session
                    .parameters(&trial.scored, &trial.spreads())
                    .into_iter()
                    .filter(|p| p.effect == Some(effect.id()))
                    .collect(),
                equivalent_to: tried
                    .iter()
                    .filter(|(other, t)| {
                        difference.is_better()
                            && other.id() != effect.id()
                            && may_replace(*other, *effect)
                            && does_the_same(session, trial, t)
                    })
                    .map(|(other, _)| other.id())
                    .collect(),
            }
        })
        .collect();
    let open = session.library().filter(|e| {
        model
            .effects()
            .iter()
            .all(|own| own.id() != e.id() && !own.has_part(e.id()))
            && tried.iter().all(|(effect, _)| effect.id() != e.id())
    });
    candidates.extend(open.map(|e| Candidate {
        effects: vec![e.id()],
        error: whole.score.error,
        delta_bic: e.parameters().len() as f64 * count,
        significant: false,
        promising: false,
        parameters: Vec::new(),
        equivalent_to: Vec::new(),
    }));
    rank(&mut candidates, suggestion);
    candidates
}
