//! What few machines have is tried last: where everything else leaves more than noise, or takes two effects to explain
//! what one of these may.

use super::sketch::{Sketch, first_guess};
use super::swap::shared;
use super::task::usual;
use super::tuning::ALIKE;
use super::{Explain, Stage};
use crate::criticism::fit::Fit;
use crate::criticism::screen::Screened;
use crate::criticism::session::Session;
use crate::effect::{Dimension, ParameterSpec, is_seldom};

/// A fit with what few machines have in the place of a part of that, from these places on: what both have keeps its
/// value, a phase that only the whole has begins at each quarter of a turn, and the rest at its usual size.
fn grown(session: &Session, fit: &Fit, from: usize) -> Vec<Sketch> {
    let mut sketches = Vec::new();
    for place in from..fit.structure.effects.len() {
        let part = fit.structure.effects[place];
        let own = &fit.values[fit.structure.range(place)];
        let known = |spec: &ParameterSpec| shared(part, own, spec);
        for whole in session.seldom().filter(|e| e.has_part(part.id())) {
            let specs = whole.parameters();
            let usual = usual(session, whole);
            let turns = |spec: &ParameterSpec| spec.dimension == Dimension::Phase;
            let open = specs.iter().any(|p| turns(p) && known(p).is_none());
            for quarter in 0..if open { 4 } else { 1 } {
                let phase = f64::from(quarter) * std::f64::consts::FRAC_PI_2;
                let value = |(spec, usual): (&ParameterSpec, &f64)| {
                    let begun = if turns(spec) { phase } else { *usual };
                    known(spec).unwrap_or(begun)
                };
                let values: Vec<f64> = specs.iter().zip(&usual).map(value).collect();
                sketches.push(Sketch::replacing(fit, place, whole, &values));
            }
        }
    }
    sketches
}

impl Explain {
    /// Has what few machines have raced, alone and beside the best, unless there is nothing to be explained.
    pub(super) fn open_seldom(&mut self, session: &mut Session, screened: &Screened) {
        let other = session.input_check.is_of_another_plant();
        let explained = self.is_noise(session, self.best);
        if other || explained && self.size(self.best) < 2 || self.knows_wrongly(session) {
            self.open_swaps(session);
            return;
        }
        self.stage = Stage::Seldom;
        session.look_where_left(&self.trials[self.best].scored.fit);
        self.limit = ALIKE * session.scouted(&self.trials[self.best].scored.fit);
        // A hidden body makes each simulation far slower, and few machines have both.
        let mut places = vec![0];
        if !explained && self.best != 0 && !self.has_hidden_body(self.best) {
            places.push(self.best);
        }
        let told = session.screened_body.map(Vec::from);
        let bodies: Vec<Vec<f64>> = first_guess(session).into_iter().chain(told).collect();
        for from in places {
            let fit = &self.trials[from].scored.fit;
            let open = session.seldom().filter(|e| self.is_open(from, *e));
            let sketches = open.flat_map(|e| Sketch::beside(session, screened, fit, e));
            let mut sketches: Vec<Sketch> = sketches.collect();
            Sketch::with_other_bodies(&mut sketches, fit, bodies.iter().cloned());
            sketches.extend(grown(session, fit, self.held.len()));
            self.take(session, sketches);
        }
    }

    /// Looks at the best of those that leave little: their curves can stand in for much else.
    pub(super) fn judge_seldom(&mut self, session: &Session) {
        let better = |t: &usize| {
            let mut effects = self.trials[*t].effects().iter();
            effects.any(|e| is_seldom(e.id()))
                && self.holds(*t)
                && self.leaves_little(session, *t)
                && (self.difference(session, self.best, *t).is_better()
                    || self.explains(session, self.best, *t)
                    || self.does_as_well_with_less(session, *t, self.best))
        };
        let better: Vec<usize> = (1..self.trials.len()).filter(better).collect();
        let Some(lead) = self.lead(session, &better) else {
            self.open_swaps(session);
            return;
        };
        self.stage = Stage::CheckSeldom(lead);
        self.take_out_of(lead, self.size(lead) > 1);
    }
}
