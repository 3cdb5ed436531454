//! Does the output of a process stay where the input leaves it?

use super::fit::Fit;
use super::guess::guess;
use super::session::{Scored, Session};
use super::structure::Structure;
use crate::effect::baseline::Baseline;

impl Session {
    /// Whether the output of a process may stay where the input leaves it, by its last model: an earlier one may miss a
    /// dead time, and find the process slower than it is.
    pub fn may_integrate(&self, scored: &Scored) -> bool {
        let fit = &scored.fit;
        let (symbols, duration) = (fit.structure.symbols(), self.scales.duration);
        let known = symbols
            .iter()
            .any(|(o, s)| self.knowledge.find(*o, s).is_some());
        let errors = scored.standard_errors();
        let baseline = fit.structure.baseline;
        !known && baseline.may_integrate(&fit.values, &errors, duration)
    }

    /// A fit of a process that integrates, with the effects of another one and what is left of its ambient: a drift.
    pub fn integrating(&self, fit: &Fit) -> Option<Fit> {
        let mut data = self.data.clone();
        data.baseline = Baseline::Integrator;
        let plain = data.excitation.effective_input(&Baseline::plain());
        let mut values = guess(&data, &plain)?;
        values.extend_from_slice(&fit.values[fit.structure.baseline_len()..]);
        let mut effects = fit.structure.effects.clone();
        let drift = self.find(Baseline::drift());
        if let Some(drift) = drift.filter(|e| effects.iter().all(|own| own.id() != e.id())) {
            effects.push(drift);
            values.extend(drift.parameters().iter().map(|_| 0.0));
        }
        let structure = Structure::new(Baseline::Integrator, effects, self.knowledge.clone());
        let starts = data.guessed_starts();
        let mut fit = Fit::new(&data, structure, values, starts, &self.scales);
        fit.finish(&data, &self.scales);
        Some(fit)
    }
}
