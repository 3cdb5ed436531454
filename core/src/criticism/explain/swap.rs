//! Other effects in the place of those of the best model.

use super::heat::as_set;
use super::hidden_body::is_hidden_body;
use super::rival::Rival;
use super::sketch::Sketch;
use super::task::Task;
use super::tuning::{ALIKE, MOST_SWAPS, QUIET};
use super::{Explain, Stage, Trial, difference};
use crate::criticism::fit::Fit;
use crate::criticism::noise::{WANDER, news_left};
use crate::criticism::screen::Screened;
use crate::criticism::select::{CHANCE, outweighs};
use crate::criticism::session::Session;
use crate::effect::{Effect, EffectId, ParameterSpec, is_seldom};
use crate::measurement::Kind;

/// Whether the values of two effects have the same dimensions.
fn same_dimensions(a: &dyn Effect, b: &dyn Effect) -> bool {
    let dimensions = |e: &dyn Effect| {
        e.parameters()
            .iter()
            .map(|p| p.dimension)
            .collect::<Vec<_>>()
    };
    dimensions(a) == dimensions(b)
}

/// The values of an effect that another one has too, if it has no others.
fn carried(own: &dyn Effect, values: &[f64], other: &dyn Effect) -> Option<Vec<f64>> {
    let specs = other.parameters().iter();
    specs.map(|spec| shared(own, values, spec)).collect()
}

/// The value of an effect that a parameter of another one has too.
pub(super) fn shared(own: &dyn Effect, values: &[f64], spec: &ParameterSpec) -> Option<f64> {
    let mut specs = own.parameters().iter();
    let same = |own: &ParameterSpec| own.symbol == spec.symbol && own.dimension == spec.dimension;
    specs.position(same).map(|place| values[place])
}

/// Whether one effect may stand in the place of another: what has that as a part, or comes near to it, says the same
/// with more.
pub(in crate::criticism) fn may_replace(effect: &dyn Effect, replaced: &dyn Effect) -> bool {
    !effect.has_part(replaced.id()) && !effect.limits().contains(&replaced.id())
}

impl Explain {
    /// Places of the best model in which others are tried: of what was added; where that is nothing, of what the user
    /// added to what is known.
    fn open_places(&self, session: &Session) -> Vec<usize> {
        let effects = self.trials[self.best].effects();
        let own = |k: &usize| !session.knowledge.has(effects[*k].id());
        let from = if self.size(self.best) == 0 {
            0
        } else {
            self.held.len()
        };
        (from..effects.len()).filter(own).collect()
    }

    /// Has what is to be replaced taken out of the best model.
    pub(super) fn open_swaps(&mut self, session: &Session) {
        self.stage = Stage::TakeOut;
        self.take_out(self.open_places(session));
    }

    /// Has other effects tried in the place of each that was added.
    pub(super) fn swap(&mut self, session: &mut Session, screened: &Screened) {
        self.stage = Stage::Swap;
        let best = &self.trials[self.best];
        session.look_where_left(&best.scored.fit);
        let fit = best.scored.fit.clone();
        self.limit = ALIKE * session.scouted(&fit);
        self.take(session, Sketch::again(&fit));
        for place in self.open_places(session) {
            if let Some(without) = self.without(self.best, place) {
                self.replace(session, screened, place, without);
            }
        }
    }

    /// Effects to be tried in the place of one of the best model, which is there `without` it; and whether for the
    /// first time, since another best model may have come to the same set before.
    fn open_replacements(
        &mut self,
        session: &Session,
        place: usize,
        without: usize,
    ) -> Vec<(&'static dyn Effect, bool)> {
        let own = self.trials[self.best].effects()[place];
        let ids = self.trials[without].ids();
        let set = |effect: &dyn Effect| as_set([ids.as_slice(), &[effect.id()]].concat());
        let is_open = |effect: &&'static dyn Effect| {
            effect.id() != own.id()
                && self.is_open(without, *effect)
                && !effect.has_part(own.id())
                && (is_hidden_body(own) || !is_hidden_body(*effect))
        };
        let open = session.library().filter(is_open).map(|effect| {
            let is_new = !self.replacements.contains(&set(effect));
            (effect, is_new)
        });
        let open: Vec<(&'static dyn Effect, bool)> = open.collect();
        let new = open.iter().filter(|(_, is_new)| *is_new);
        let sets: Vec<Vec<EffectId>> = new.map(|(effect, _)| set(*effect)).collect();
        self.replacements.extend(sets);
        open
    }

    /// Has other effects raced in the place of one of the best model.
    fn replace(&mut self, session: &Session, screened: &Screened, place: usize, without: usize) {
        let open = self.open_replacements(session, place, without);
        let fit = &self.trials[self.best].scored.fit;
        let rest = &self.trials[without];
        let (ids, own) = (rest.ids(), fit.structure.effects[place]);
        let own_values = &fit.values[fit.structure.range(place)];
        let (mut sketches, mut same) = (Vec::new(), Vec::new());
        for (effect, is_new) in open {
            let told = || {
                let beside = screened.values(&ids, effect.id());
                beside.or_else(|| screened.values(&[], effect.id()))
            };
            let mut starts: Vec<Vec<f64>> = is_new.then(told).flatten().into_iter().collect();
            if same_dimensions(own, effect) {
                starts.push(own_values.to_vec());
            }
            // What says the same with the same values needs no race.
            let carried = carried(own, own_values, effect);
            same.extend(carried.map(|values| Sketch::replacing(fit, place, effect, &values)));
            if starts.is_empty() && is_new {
                let probed = session.probed(&rest.scored.fit);
                starts = probed.starts(effect, 1.0);
                let with_body = probed.starts_with_body(effect, 1.0).into_iter();
                starts.extend(with_body.map(|(_, own)| own));
            }
            let starts = starts.iter();
            sketches.extend(starts.map(|start| Sketch::replacing(fit, place, effect, start)));
        }
        self.take(session, sketches);
        self.tasks.extend(same.into_iter().map(Task::Fit));
    }

    /// Trials that differ from the best in one effect that was added, with the place of that; no richer ones, and of
    /// what few machines have those that leave little only.
    fn swapped(&self, session: &Session) -> Vec<Rival> {
        let best = &self.trials[self.best];
        let own = best.ids();
        let values = best.values();
        let places = self.open_places(session);
        let mut found: Vec<Rival> = Vec::new();
        for (index, trial) in self.trials.iter().enumerate() {
            let ids = trial.ids();
            let gone: Vec<usize> = (0..own.len()).filter(|k| !ids.contains(&own[*k])).collect();
            let new: Vec<&'static dyn Effect> = trial
                .effects()
                .iter()
                .copied()
                .filter(|e| !own.contains(&e.id()))
                .collect();
            let ([place], [effect]) = (gone.as_slice(), new.as_slice()) else {
                continue;
            };
            let fair = places.contains(place)
                && may_replace(*effect, best.effects()[*place])
                && (!is_seldom(effect.id()) || self.leaves_little(session, index));
            if ids.len() == own.len() && fair && trial.values() <= values {
                let rival = Rival {
                    place: *place,
                    effect: *effect,
                    trial: index,
                };
                match found
                    .iter_mut()
                    .find(|r| r.place == *place && r.effect.id() == effect.id())
                {
                    Some(known) if self.trials[known.trial].error() > trial.error() => {
                        *known = rival;
                    }
                    Some(_) => {}
                    None => found.push(rival),
                }
            }
        }
        found
    }

    /// The model with the effects of the best that leaves least: another start may have led further.
    fn best_of_its_kind(&self, session: &Session) -> usize {
        let best = &self.trials[self.best];
        let same = |t: &usize| {
            let other = &self.trials[*t];
            other.effects().len() == best.effects().len()
                && best.ids().iter().all(|id| other.has(*id))
        };
        let lower = |t: &usize| self.trials[*t].error() < best.error();
        let all =
            (0..self.trials.len()).filter(|t| same(t) && lower(t) && self.is_needed(session, *t));
        let error = |t: &usize| self.trials[*t].error();
        all.min_by(|a, b| error(a).total_cmp(&error(b)))
            .unwrap_or(self.best)
    }

    /// The best model without one of its effects, where that does as well: beside what took another one's place it may
    /// not be needed any more.
    fn as_good_a_part(&self, session: &Session) -> Option<usize> {
        let places = self.open_places(session).into_iter();
        let mut parts = places.filter_map(|place| self.without(self.best, place));
        parts.find(|part| self.does_as_well(session, *part, self.best))
    }

    /// Takes what is better, or does as well with fewer values; else what is the same could stand in its place.
    pub(super) fn judge_swaps(&mut self, session: &mut Session) {
        self.best = self.best_of_its_kind(session);
        // What the user added stays.
        let may_change = self.size(self.best) > 0 && self.swaps < MOST_SWAPS;
        let smaller = may_change.then(|| self.as_good_a_part(session)).flatten();
        if let Some(smaller) = smaller {
            self.swaps += 1;
            self.best = smaller;
            self.open_swaps(session);
            return;
        }
        let rivals = self.swapped(session);
        let is_simpler = |r: &&Rival| self.does_as_well_with_less(session, r.trial, self.best);
        let better: Vec<usize> = rivals
            .iter()
            .filter(|r| self.difference(session, self.best, r.trial).is_better())
            .map(|r| r.trial)
            .collect();
        let simpler: Vec<usize> = rivals.iter().filter(is_simpler).map(|r| r.trial).collect();
        let other = self
            .lead(session, &better)
            .or_else(|| self.lead(session, &simpler));
        if let Some(other) = other.filter(|_| may_change) {
            self.swaps += 1;
            self.best = other;
            self.open_swaps(session);
            return;
        }
        let mut alike: Vec<usize> = vec![self.best];
        let same = |r: &&Rival| self.difference(session, self.best, r.trial).is_same();
        alike.extend(rivals.iter().filter(same).map(|r| r.trial));
        let agree = |a: usize, b: usize| self.trials[a].same_body(&self.trials[b]);
        // Of what does as well, the body on which most agree is the likeliest.
        let agreeing = |a: usize| alike.iter().filter(|b| agree(a, **b)).count();
        let most = alike.iter().copied().map(agreeing).max().unwrap_or(0);
        if may_change && agreeing(self.best) < most {
            self.swaps += 1;
            let other = alike.iter().copied().find(|a| agreeing(*a) == most);
            self.best = other.unwrap_or(self.best);
            self.open_swaps(session);
            return;
        }
        let best = self.best;
        // What no model explains bends each of them, some more than others: there two are one class unless one is better.
        let noise = self.is_noise(session, best);
        let may_be = |r: &Rival| {
            alike.contains(&r.trial)
                || !noise && !self.difference(session, r.trial, best).is_better()
        };
        let of_class = |r: &Rival| agree(best, r.trial) && may_be(r);
        self.rivals = rivals.into_iter().filter(of_class).collect();
        if let Some(share) = self.quiet_share(session) {
            session.quieten(share);
        } else if self.wanders(session) {
            session.let_surroundings_wander();
        } else if self.integrates(session) {
            session.integrate();
        } else {
            self.open_path(session);
            return;
        }
        *self = Self::new(std::mem::take(&mut self.held));
    }

    /// What the best model leaves of a process, in shares of the noise, where it foretells the output better than the
    /// noise that was seen would let it: an input that changes again and again leaves no smooth stretch that shows the
    /// noise alone.
    fn quiet_share(&self, session: &Session) -> Option<f64> {
        let data = &session.data;
        let random = data.wander == 0.0 && data.outputs.iter().all(|o| !o.counted);
        let count = data.measured(0, data.len()) as f64;
        let error = self.trials[self.best].error();
        let quiet = error < QUIET.min(1.0 - CHANCE / count.sqrt());
        (session.kind() == Kind::Process && random && quiet).then_some(error)
    }

    /// Whether the surroundings of a process wander: of what the best of all models leaves, a level that moves towards
    /// each sample explains more than it leaves once that model is fitted so.
    fn wanders(&self, session: &Session) -> bool {
        let data = &session.data;
        if session.kind() != Kind::Process || data.wander > 0.0 || self.is_noise(session, self.best)
        {
            return false;
        }
        let left = |fit: &Fit, gain: f64| news_left(data, &fit.motion, gain, |_| true);
        let news = |fit: &Fit| left(fit, WANDER);
        let fits = self.trials.iter().map(|t| &t.scored.fit);
        let best = fits.min_by(|a, b| news(a).total_cmp(&news(b)));
        best.is_some_and(|fit| {
            let all = left(fit, 0.0);
            outweighs(
                all,
                news(&fit.among_surroundings(data, WANDER, &session.scales)),
            )
        })
    }

    /// Whether a process whose output stays where the input leaves it does as well as the best, and the record tells
    /// how fast the input moves that.
    fn integrates(&self, session: &Session) -> bool {
        let best = &self.trials[self.best];
        if !session.may_integrate(&best.scored) {
            return false;
        }
        let fit = session.integrating(&best.scored.fit);
        let trial = fit.map(|fit| Trial::new(session, fit));
        trial.is_some_and(|t| t.tells_body() && difference(session, &t, best).is_no_better())
    }
}
