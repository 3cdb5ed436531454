//! Which stage of a step comes next.

use super::{BETTER_VALLEY, Stage, StepJob};
use crate::criticism::fit::Fit;
use crate::criticism::judge::{alike, part_does, same_body};
use crate::criticism::next_experiment::{Rival, designs};
use crate::criticism::race::Race;
use crate::criticism::search::Search;
use crate::criticism::select::{LITTLE_LEFT, is_plain_noise};
use crate::criticism::session::{Rest, Scored};
use crate::criticism::verdict::Class;
use crate::effect::Effect;

/// Times that a model is fitted once more.
const MAX_VISITS: usize = 2;

impl StepJob {
    /// The effects that the screen found, together: what shows only so is found without detours.
    pub(super) fn screened_stage(&mut self) -> Stage {
        let bare = self.model.as_ref().filter(|_| self.wanted.is_empty());
        let searches = bare.map(|model| {
            let held = Search::rubbing_under_load(&self.session, &model.fit);
            let screened = Search::screened(&self.session, &model.fit);
            held.into_iter().chain(screened).collect::<Vec<_>>()
        });
        let searches = searches.filter(|searches| !searches.is_empty());
        searches.map_or_else(|| self.try_stage(), |all| Stage::Screened(all.into()))
    }

    /// Where little is left, it may be for how the record was made; if so, no other effect is tried before that is in the
    /// model.
    pub(super) fn try_stage(&mut self) -> Stage {
        let Some(model) = self.model.as_ref() else {
            return Stage::Report;
        };
        self.session.look_where_left(&model.fit);
        let mut of_record = self.others();
        of_record.retain(|e| e.is_of_record());
        let little = model.score.error < LITTLE_LEFT && !is_plain_noise(&model.score);
        if little && !of_record.is_empty() {
            Stage::Record(Race::new(&self.session, &model.fit, of_record, None))
        } else {
            self.try_all_stage()
        }
    }

    /// A part of an effect that leaves nothing but noise is not widened to the whole.
    pub(super) fn try_all_stage(&self) -> Stage {
        self.model.as_ref().map_or(Stage::Report, |model| {
            let mut others = self.others();
            if is_plain_noise(&model.score) {
                others.retain(|e| !model.fit.structure.is_widened_by(*e));
            }
            Stage::Try(Race::new(&self.session, &model.fit, others, None))
        })
    }

    /// Where the model with an effect on top costs much less, the model itself may have stopped in a worse valley than it
    /// need have: it is fitted again from where the effect led. One to which nothing is to be added, but which is stuck,
    /// is fitted again from beyond where it stopped.
    pub(super) fn revisit_stage(&mut self) -> Stage {
        let search = self.model.as_ref().and_then(|model| {
            let costs = self.tried.iter().map(|(_, with)| &with.fit);
            let best = costs.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
            let bends = !model.fit.structure.effects.is_empty();
            let lower = best.cost < BETTER_VALLEY * model.fit.cost;
            if !bends || self.visits >= MAX_VISITS {
                return None;
            }
            if lower {
                return Some(Search::revisiting(&model.fit, best));
            }
            let stuck = model.fit.is_stuck() && self.suggestion(model).is_none();
            stuck.then(|| Search::leaping(&model.fit))
        });
        self.visits += usize::from(search.is_some());
        search.map_or_else(|| self.remove_stage(0), Stage::Revisit)
    }

    pub(super) fn remove_stage(&mut self, index: usize) -> Stage {
        match &self.model {
            Some(model) if index < self.wanted.len() => Stage::Remove {
                index,
                search: Search::removing(&model.fit, index),
            },
            _ => self.swap_stage(0),
        }
    }

    /// Swaps are tried only for a final model: nothing helps it, and all in it is needed.
    pub(super) fn swap_stage(&mut self, place: usize) -> Stage {
        let Some(model) = &self.model else {
            return Stage::Report;
        };
        if !self.contradicted.is_empty()
            || self.suggestion(model).is_some()
            || !self.needless(model).is_empty()
        {
            return Stage::Report;
        }
        if place == 0 && self.session.settle_baseline(model) {
            let search = Search::integrating(&model.fit);
            self.without.clear();
            let next = self.wanted.len();
            return Stage::Build { search, next };
        }
        // What the user says is in the model is not up for exchange, nor what is not said of the machine.
        let kept = |k: &usize| self.is_present(*k) || self.session.tells_of_record(&model.fit, *k);
        let mut rest = (place..self.wanted.len()).skip_while(kept);
        let place = rest.next().unwrap_or(self.wanted.len());
        match self.without.get(place) {
            Some(without) => Stage::Swap {
                place,
                race: Race::new(
                    &self.session,
                    &without.fit,
                    self.rivals(place),
                    Some((&model.fit, place)),
                ),
            },
            None => self.design_stage(model),
        }
    }

    /// One search for each effect in whose place others could stand; none where the model does not explain the
    /// record, or is not the last.
    fn design_stage(&self, model: &Scored) -> Stage {
        let explains = || self.session.rest(&self.session.completed(model)) != Rest::More;
        if self.rivals.is_empty() || !explains() || self.simpler.is_some() {
            return Stage::Report;
        }
        let designs = designs(
            &self.session,
            model,
            &self.wanted,
            &self.rivals,
            self.limits,
        );
        if designs.is_empty() {
            Stage::Report
        } else {
            Stage::Design(designs)
        }
    }

    /// Takes what could stand in the place of the effect at `place` as well.
    pub(super) fn judge_swaps(&mut self, place: usize, fits: Vec<(&'static dyn Effect, Fit)>) {
        let Some(model) = &self.model else {
            return;
        };
        let own = self.wanted[place];
        let mut class = Class::default();
        for (effect, fit) in fits {
            let swapped = self.session.scored(fit);
            if own.has_part(effect.id()) {
                let fewer = |s: &Scored| s.fit.values.len() > swapped.fit.values.len();
                if part_does(model, &swapped, place, self.session.first(model))
                    && self.simpler.as_ref().is_none_or(fewer)
                {
                    self.simpler = Some(swapped);
                }
            } else if alike(model, &swapped) && same_body(model, &swapped) {
                class.push(effect);
                self.rivals.push(Rival {
                    place,
                    effect: effect.id(),
                    model: swapped,
                });
            }
        }
        self.classes.resize_with(place, Class::default);
        self.classes.push(class);
    }
}
