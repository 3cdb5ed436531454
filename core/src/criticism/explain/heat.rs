//! Many models from many starting points: those that may win are found on a part of the record by successive halving
//! (Jamieson and Talwalkar 2016).

use std::collections::VecDeque;

use super::sketch::Sketch;
use super::tuning::{FAR, HOPE, ROUNDS, ROUNDS_LEFT, Round};
use crate::criticism::fit::{Fit, same_place};
use crate::criticism::session::Session;
use crate::effect::EffectId;

/// Models in a race on the scout.
#[derive(Default)]
pub(super) struct Heat {
    /// Each with its cost before the round.
    waiting: VecDeque<(f64, Fit)>,
    over: Vec<(f64, Fit)>,
    round: usize,
}

/// What a model may come to: the cost of one that still falls fast says little.
fn hoped((before, fit): &(f64, Fit)) -> f64 {
    let falls = if fit.done { 0.0 } else { before - fit.cost };
    (fit.cost - HOPE * falls).max(0.0)
}

/// Where a model ends if each further round lowers its cost as the last one did.
fn settled((before, fit): &(f64, Fit)) -> f64 {
    let ratio = if fit.done {
        1.0
    } else {
        (fit.cost / before).min(1.0)
    };
    fit.cost * ratio.powi(ROUNDS_LEFT)
}

impl Heat {
    pub fn new(session: &Session, sketches: &[Sketch]) -> Self {
        let crew = &session.data.crew;
        let begun = crew.gather(sketches.len(), |i| sketches[i].begun(session));
        Self {
            waiting: begun
                .into_iter()
                .filter(|fit| fit.cost.is_finite())
                .map(|fit| (fit.cost, fit))
                .collect(),
            over: Vec::new(),
            round: 0,
        }
    }

    pub fn add(&mut self, session: &Session, sketches: &[Sketch]) {
        self.waiting.extend(Self::new(session, sketches).waiting);
    }

    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty() && self.over.is_empty()
    }

    /// Does some iterations; true while there are more. What costs less than `alike` goes on, however little another
    /// one costs. So many places of the model are open. A race that `gives_up` ends with its round, and nobody wins.
    pub fn advance(
        &mut self,
        session: &Session,
        alike: f64,
        places: usize,
        gives_up: bool,
    ) -> bool {
        let crew = &session.data.crew;
        let width = crew.width().min(self.waiting.len());
        let mut batch: Vec<(f64, Fit)> = self.waiting.drain(..width).collect();
        let Round { iterations, .. } = ROUNDS[self.round];
        crew.for_each(
            batch.iter_mut().collect(),
            |(before, fit): &mut (f64, Fit)| {
                *before = fit.cost;
                for _ in 0..iterations {
                    fit.iterate(&session.scout, &session.scales);
                }
            },
        );
        self.over.extend(batch);
        if self.waiting.is_empty() {
            self.cull(alike, places);
            self.round += 1;
            if gives_up {
                *self = Self::default();
            } else if self.round < ROUNDS.len() {
                self.waiting = self.over.drain(..).collect();
            }
        }
        !self.waiting.is_empty()
    }

    /// Leaves the best of each set of effects, of the sets that have a turn, and none that is far behind.
    fn cull(&mut self, alike: f64, places: usize) {
        let Round { sets, starts, .. } = ROUNDS[self.round];
        let in_turn = self.sets_in_turn(sets * places);
        let last = self.round + 1 == ROUNDS.len();
        let key = |entry: &(f64, Fit)| if last { entry.1.cost } else { hoped(entry) };
        let (set, cost) = (|e: &(f64, Fit)| sorted_ids(&e.1), |e: &(f64, Fit)| e.1.cost);
        self.over = leaders_first(std::mem::take(&mut self.over), set, cost, key);
        let least = self.over.first().map_or(f64::INFINITY, cost);
        let mut kept: Vec<(Vec<EffectId>, Vec<f64>)> = Vec::new();
        let far = FAR[self.round];
        self.over.retain(|entry| {
            let fit = &entry.1;
            let ids = sorted_ids(fit);
            let same = || kept.iter().filter(|(k, _)| *k == ids);
            let twin = same().any(|(_, values)| same_place(values, &fit.values));
            let has_turn = in_turn.contains(&ids) && same().count() < starts;
            let stays = hoped(entry) <= alike.max(far * least) && has_turn && !twin;
            if stays {
                kept.push((ids, fit.values.clone()));
            }
            stays
        });
    }

    /// So many sets of effects that cost least, and half as many more that may come to least: what began where it ends
    /// falls no further, and what began far off says little by its cost.
    fn sets_in_turn(&self, count: usize) -> Vec<Vec<EffectId>> {
        let mut sets: Vec<Vec<EffectId>> = Vec::new();
        let mut take = |key: &dyn Fn(&(f64, Fit)) -> f64, most: usize| {
            let mut order: Vec<&(f64, Fit)> = self.over.iter().collect();
            order.sort_by(|a, b| key(a).total_cmp(&key(b)));
            for (_, fit) in order {
                let ids = sorted_ids(fit);
                if sets.len() < most && !sets.contains(&ids) {
                    sets.push(ids);
                }
            }
        };
        take(&|entry| entry.1.cost, count);
        take(&hoped, count + count / 2);
        sets
    }

    /// The best of each of so many sets of effects, of those that cost no more than a limit, and a second of the first;
    /// and none is left.
    pub fn best(&mut self, count: usize, limit: f64) -> Vec<Sketch> {
        let over = std::mem::take(self).over.into_iter();
        let mut sets: Vec<Vec<EffectId>> = Vec::new();
        let near = over
            .filter(|entry| settled(entry) <= limit)
            .map(|(_, fit)| fit);
        let chosen = near.filter(|fit| {
            let ids = sorted_ids(fit);
            let known = sets.iter().filter(|set| **set == ids).count();
            let is_first = known == 0 || known == 1 && sets[0] == ids;
            if is_first {
                sets.push(ids);
            }
            is_first
        });
        chosen.take(count).map(Sketch::reached).collect()
    }
}

/// What costs least of each set, by its cost, and then the others by what they may come to: one that has arrived falls
/// no further, and is not to give way to others of its set for that.
fn leaders_first<E, S: PartialEq>(
    mut entries: Vec<E>,
    set: impl Fn(&E) -> S,
    cost: impl Fn(&E) -> f64,
    key: impl Fn(&E) -> f64,
) -> Vec<E> {
    entries.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    let mut sets: Vec<S> = Vec::new();
    let is_new = |entry: &E| {
        let own = set(entry);
        let is_new = !sets.contains(&own);
        if is_new {
            sets.push(own);
        }
        is_new
    };
    let (mut leaders, mut others): (Vec<E>, Vec<E>) = entries.into_iter().partition(is_new);
    others.sort_by(|a, b| key(a).total_cmp(&key(b)));
    leaders.append(&mut others);
    leaders
}

/// The effects of a model in an order that does not hang on how it came about.
fn sorted_ids(fit: &Fit) -> Vec<EffectId> {
    as_set(fit.structure.ids())
}

/// Effects in that order.
pub(super) fn as_set(mut ids: Vec<EffectId>) -> Vec<EffectId> {
    ids.sort_unstable();
    ids
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_arrived_does_not_give_way_to_what_still_falls() {
        // A set, what it costs, and what it may come to.
        let entries = vec![
            ("a", 9.0, 0.0),
            ("a", 3.0, 3.0),
            ("b", 5.0, 4.0),
            ("a", 8.0, 1.0),
        ];
        let order = leaders_first(entries, |e| e.0, |e| e.1, |e| e.2);
        let costs: Vec<f64> = order.iter().map(|e| e.1).collect();
        assert_eq!(costs, [3.0, 5.0, 9.0, 8.0]);
    }
}
