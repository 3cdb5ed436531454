//! Level by level: subsets of more and more effects, those with a hidden body last of each size.

use super::hidden_body::is_hidden_body;
use super::sketch::Sketch;
use super::tuning::{ALIKE, MOST_HIDDEN_MISSES, MOST_LEADS, MOST_MISSES, MOST_SIZE, STARTS};
use super::{Explain, Level, Stage};
use crate::criticism::screen::{Screened, Start};
use crate::criticism::session::Session;

impl Explain {
    /// Tasks of the subsets of a level.
    pub(super) fn open_level(&mut self, session: &mut Session, screened: &Screened, level: Level) {
        let Level { size, hidden } = level;
        self.stage = Stage::Fit(level);
        self.looked_at.clear();
        // Where the input is not what acted, an effect would be one of another machine.
        let other = session.input_check.is_of_another_plant();
        // A hidden body is free: what acts on the measured one, with an effect more, may do as well with fewer values.
        let doubted =
            !hidden && self.has_hidden_body(self.best) && size == self.size(self.best) + 1;
        let explained =
            self.is_noise(session, self.best) && !doubted || self.knows_wrongly(session);
        let enough = |hidden: bool| size > 1 && session.data.tried_enough(hidden);
        if other
            || explained
            || enough(false)
            || size > MOST_SIZE
            || [false, true].iter().all(|hidden| self.gives_up_on(*hidden))
        {
            self.open_seldom(session, screened);
            return;
        }
        if self.gives_up_on(hidden) || hidden && enough(true) {
            self.open_level(session, screened, level.next());
            return;
        }
        let lead = |hidden: bool| {
            let leads = &self.leads[usize::from(hidden)];
            leads.get(size - 2).copied().flatten()
        };
        let (visible, with_hidden) = if size > 1 {
            (lead(false), lead(true))
        } else {
            (Some(0), None)
        };
        if let Some(from) = visible.or(with_hidden) {
            session.look_where_left(&self.trials[from].scored.fit);
        }
        self.limit = ALIKE * session.scouted(&self.trials[self.best].scored.fit);
        let held = self.held_ids();
        let starts = screened.starts(&held, held.len() + size);
        let of_level = |start: &Start| start.effects.iter().any(|e| is_hidden_body(*e)) == hidden;
        let sketches = starts
            .filter(of_level)
            .filter_map(|start| Sketch::of(session, &start));
        let sketches: Vec<Sketch> = sketches.take(STARTS).collect();
        self.take(session, sketches);
        if let Some(from) = visible {
            self.extend(session, screened, from, hidden);
        }
        if let Some(from) = with_hidden.filter(|_| hidden) {
            self.extend(session, screened, from, false);
        }
    }

    /// Whether too many sizes in a row brought nothing, of models with a hidden body or without.
    fn gives_up_on(&self, hidden: bool) -> bool {
        let most = if hidden {
            MOST_HIDDEN_MISSES
        } else {
            MOST_MISSES
        };
        self.misses[usize::from(hidden)] > most
    }

    /// Whether a trial belongs to a level.
    fn is_of(&self, trial: usize, level: Level) -> bool {
        let mut added = self.trials[trial]
            .effects()
            .iter()
            .filter(|e| !self.held.iter().any(|own| own.id() == e.id()));
        self.size(trial) == level.size
            && self.holds(trial)
            && added.any(|e| is_hidden_body(*e)) == level.hidden
    }

    pub(super) fn has_hidden_body(&self, trial: usize) -> bool {
        let mut effects = self.trials[trial].effects().iter();
        effects.any(|e| is_hidden_body(*e))
    }

    /// Looks at the best subset of a level, if it is better than the best before; else goes on to the next level.
    pub(super) fn judge_level(&mut self, session: &mut Session, screened: &Screened, level: Level) {
        let Level { size, hidden } = level;
        if self.looked_at.is_empty() {
            let of_level: Vec<usize> = (0..self.trials.len())
                .filter(|t| self.is_of(*t, level))
                .collect();
            let lead = self.lead(session, &of_level);
            self.leads[usize::from(hidden)].push(lead);
        }
        // A smaller one may have come up as a part of one that was looked at.
        let open =
            |t: &usize| self.size(*t) <= size && !self.looked_at.contains(t) && self.holds(*t);
        let better = |t: &usize| {
            let difference = self.difference(session, self.best, *t);
            difference.is_better()
                || difference.is_met_once() && self.explains(session, self.best, *t)
                || self.does_as_well_with_less(session, *t, self.best)
        };
        let better: Vec<usize> = (0..self.trials.len()).filter(open).filter(better).collect();
        let lead = self
            .lead(session, &better)
            .filter(|_| self.looked_at.len() < MOST_LEADS);
        let Some(lead) = lead else {
            let taken = self.looked_at.contains(&self.best);
            let misses = &mut self.misses[usize::from(hidden)];
            *misses = if taken { 0 } else { *misses + 1 };
            self.open_level(session, screened, level.next());
            return;
        };
        self.looked_at.push(lead);
        self.stage = Stage::Check(level);
        self.take_out_of(lead, size > 1);
    }

    /// Takes the subset that was looked at if each of its effects is needed, and looks at the next one.
    pub(super) fn judge_check(&mut self, session: &mut Session, screened: &Screened, level: Level) {
        let lead = self.looked_at.last().copied();
        if let Some(lead) = lead.filter(|lead| self.is_needed(session, *lead)) {
            self.best = lead;
        }
        self.judge_level(session, screened, level);
    }
}
