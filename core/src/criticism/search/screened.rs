//! Effects that only show together, as the screen found them.

use super::Search;
use crate::criticism::fit::Fit;
use crate::criticism::session::Session;
use crate::diagnosis::Parameter;
use crate::diagnosis::Subset;
use crate::effect::{Effect, EffectId};

impl Search {
    /// Adds each of the subsets that the screen found to a baseline, from the values that it told; the best first.
    pub fn screened(session: &Session, fit: &Fit) -> Vec<Self> {
        let subsets = session.screened.iter();
        subsets
            .filter_map(|subset| Self::of_subset(session, fit, subset))
            .collect()
    }

    fn of_subset(session: &Session, fit: &Fit, subset: &Subset) -> Option<Self> {
        let effects: Vec<&'static dyn Effect> = subset
            .effects
            .iter()
            .map(|id| session.find(*id))
            .collect::<Option<_>>()?;
        let structure = effects
            .iter()
            .fold(fit.structure.clone(), |with, effect| with.with(*effect));
        let told = |(effect, symbol): &(Option<EffectId>, &str)| {
            let is_it = |p: &&Parameter| p.effect == *effect && p.name == *symbol;
            subset.parameters.iter().find(is_it).map(|p| p.value)
        };
        let symbols = structure.symbols();
        let mut values = symbols
            .iter()
            .enumerate()
            .map(|(j, symbol)| told(symbol).or_else(|| fit.values.get(j).copied()))
            .collect::<Option<Vec<f64>>>()?;
        structure.begin(&mut values, 0);
        let point = (values, session.data.guessed_starts());
        Some(Self::from_points(structure, vec![point], f64::INFINITY))
    }
}
