//! Which of the models that were fitted leads, and whether it needs each of its effects.

use super::judge::{Difference, difference, outweighs_in_either_half};
use super::{Explain, Trial};
use crate::criticism::select::{
    SMALL_SHARE, STRETCH_SHARE, is_all_that_counters_show, is_noise, is_trifle, outweighs,
};
use crate::criticism::session::{Session, small_share};

impl Explain {
    pub(super) fn is_noise(&self, session: &Session, trial: usize) -> bool {
        Self::leaves_noise(session, &self.trials[trial])
    }

    pub(super) fn leaves_noise(session: &Session, trial: &Trial) -> bool {
        let small = small_share(&trial.scored.fit);
        trial.halves().all(|scored| {
            let score = &scored.score;
            is_all_that_counters_show(score) || is_noise(score, session.first(scored), small)
        })
    }

    /// Whether a model explains all but a small share of what there was.
    pub(super) fn leaves_little(&self, session: &Session, trial: usize) -> bool {
        let own = &self.trials[trial];
        let little = is_trifle(own.error(), session.first(&own.scored), STRETCH_SHARE);
        little || self.is_noise(session, trial)
    }

    /// Whether a model has, in the place of an effect of another, a part of that or what that comes near to.
    fn has_part_of(&self, part: usize, whole: usize) -> bool {
        let (own, other) = (&self.trials[part], &self.trials[whole]);
        let mut wholes = other.effects().iter().filter(|e| !own.has(e.id()));
        own.effects().len() == other.effects().len()
            && wholes.any(|whole| {
                own.effects()
                    .iter()
                    .any(|e| whole.has_part(e.id()) || whole.limits().contains(&e.id()))
            })
    }

    /// Whether a model has fewer values than another, or as many and a part in the place of the whole.
    pub(super) fn is_simpler(&self, a: usize, b: usize) -> bool {
        let (own, other) = (self.trials[a].values(), self.trials[b].values());
        own < other || own == other && self.has_part_of(a, b)
    }

    /// Whether a simpler model does as well as another. What a whole has beside its part must be worth it as an effect
    /// must that is added; where the part leaves noise, or a trifle of what there was at first, it is not.
    pub(super) fn does_as_well(&self, session: &Session, simpler: usize, other: usize) -> bool {
        let difference = self.difference(session, simpler, other);
        let (before, after) = (self.trials[simpler].error(), self.trials[other].error());
        let scored = &self.trials[simpler].scored;
        let trifle = is_trifle(before, session.first(scored), small_share(&scored.fit));
        let better = difference.is_better() || self.explains(session, simpler, other);
        let worth = better
            && !trifle
            && !self.is_noise(session, simpler)
            && (self.is_noise(session, other) || outweighs(before, after));
        difference.is_no_better() || self.has_part_of(simpler, other) && !worth
    }

    /// Whether a model does as well as another with fewer values.
    pub(super) fn does_as_well_with_less(
        &self,
        session: &Session,
        less: usize,
        other: usize,
    ) -> bool {
        self.is_simpler(less, other) && self.does_as_well(session, less, other)
    }

    /// The one that leaves least; of those that do as well, the one with fewest values.
    pub(super) fn lead(&self, session: &Session, trials: &[usize]) -> Option<usize> {
        let error = |t: &usize| self.trials[*t].error();
        let all = || trials.iter().copied();
        let least = all().min_by(|a, b| error(a).total_cmp(&error(b)))?;
        all()
            .filter(|t| self.does_as_well_with_less(session, *t, least))
            .min_by(|a, b| {
                let values = |t: &usize| self.trials[*t].values();
                values(a)
                    .cmp(&values(b))
                    .then(error(a).total_cmp(&error(b)))
            })
            .or(Some(least))
    }

    pub(super) fn difference(&self, session: &Session, from: usize, to: usize) -> Difference {
        difference(session, &self.trials[from], &self.trials[to])
    }

    /// Whether each of the added effects explains more than it leaves, or is needed for what is left to be noise.
    pub(super) fn is_needed(&self, session: &Session, trial: usize) -> bool {
        (self.held.len()..self.trials[trial].effects().len())
            .all(|place| self.needs(session, trial, place))
    }

    /// Whether a model leaves noise where another one leaves more than that, however few blocks show it: what is met
    /// once is explained all the same.
    pub(super) fn explains(&self, session: &Session, before: usize, after: usize) -> bool {
        let outweighs = outweighs(self.trials[before].error(), self.trials[after].error());
        outweighs && self.is_noise(session, after) && !self.is_noise(session, before)
    }

    pub(in crate::criticism) fn needs(
        &self,
        session: &Session,
        trial: usize,
        place: usize,
    ) -> bool {
        let Some(without) = self.without(trial, place) else {
            return true;
        };
        let noise = self.is_noise(session, trial);
        let (before, after) = (self.trials[without].error(), self.trials[trial].error());
        let outweighs = outweighs_in_either_half(&self.trials[without], &self.trials[trial]);
        // Below that an effect only mends what a clock, a rig or an equation is off by.
        let first = session.baseline.as_ref().map_or(0.0, |first| first.error);
        let matters = (before.powi(2) - after.powi(2)).max(0.0).sqrt() > SMALL_SHARE * first;
        let better = self.difference(session, without, trial).is_better();
        let of_record = session.tells_of_record(&self.trials[trial].scored.fit, place);
        let explains = self.explains(session, without, trial);
        let scored = &self.trials[trial].scored;
        let shown = scored.shows_marks_of(scored.fit.structure.effects[place], &session.scales);
        shown
            && scored.tells_of(place)
            && session.is_sizeable(&scored.fit, place)
            && (of_record || matters)
            && (better && (noise || outweighs || of_record) || explains)
    }
}
