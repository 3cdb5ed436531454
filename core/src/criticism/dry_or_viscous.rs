//! Dry friction in the place of viscous friction, where a relay loop shows one amplitude.
//!
//! A cycle of one amplitude tells the energy that friction takes in it: `pi d w A^2` of a viscous one, `4 c A` of a dry
//! one (harmonic balance; Tsypkin 1984). Whichever of them is fitted makes the same period and amplitude, so that only
//! the shape of the motion tells them apart. Where neither explains that shape, and neither is better, the loop has the
//! last word.

use super::explain::{Trial, difference};
use super::fit::{Fit, least};
use super::relay_loop::makes_cycle;
use super::session::{Rest, Session, TELLING};
use crate::diagnosis::{LoopError, Parameter};
use crate::effect::{Effect, EffectId, VISCOUS_FRICTION};
use crate::measurement::Kind;

const DRY: EffectId = EffectId::new("coulomb_friction");

/// Place of viscous friction among the values of a drive.
const VISCOUS: usize = 1;

/// A model with dry friction that may stand in the place of one with viscous friction.
pub(super) struct InsteadOfViscous {
    /// What is missing: dry friction, and the viscous one where that does as well.
    pub class: Vec<EffectId>,
    /// The level of the dry friction.
    pub level: Parameter,
    /// What it leaves of both halves of the record, and what the one with viscous friction does, in noise units.
    pub errors: [f64; 2],
    /// How far their cycles are off.
    pub in_loop: [LoopError; 2],
}

impl InsteadOfViscous {
    /// None where the record is no relay loop, the best model explains it, or one with dry friction does not do as
    /// well.
    pub fn of(session: &Session, best: &Trial) -> Option<Self> {
        let with_viscous = best.in_loop?;
        let is_drive = session.kind() == Kind::Drive;
        if !is_drive || session.rest(&session.completed(&best.scored)) != Rest::More {
            return None;
        }
        let dry = with_dry_friction(session, best)?;
        let with_dry = dry.in_loop.filter(|error| makes_cycle(*error))?;
        if difference(session, &dry, best).is_better() || !dry.same_body(best) {
            return None;
        }
        let mut parameters = session.parameters(&dry.scored, &dry.spreads()).into_iter();
        Some(Self {
            class: class(with_viscous),
            level: parameters.find(|p| p.effect == Some(DRY))?,
            errors: [dry.error(), best.error()],
            in_loop: [with_dry, with_viscous],
        })
    }
}

/// What is missing where dry friction makes the cycle: the viscous one stays beside it if it does, too.
fn class(with_viscous: LoopError) -> Vec<EffectId> {
    if makes_cycle(with_viscous) {
        vec![VISCOUS_FRICTION, DRY]
    } else {
        vec![DRY]
    }
}

/// The model with dry friction instead of viscous friction, fitted anew; none where it has dry friction already, or no
/// viscous friction that can be told, or the user says something of that.
fn with_dry_friction(session: &Session, best: &Trial) -> Option<Trial> {
    let own = &best.scored.fit;
    let effect = session.find(DRY)?;
    let is_dry = |e: &&'static dyn Effect| e.id() == DRY || e.has_part(DRY);
    let symbol = own.structure.baseline.parameters()[VISCOUS].symbol;
    let viscous = own.values[VISCOUS];
    let told = viscous > TELLING * best.scored.standard_errors()[VISCOUS];
    let known = session.knowledge.find(None, symbol).is_some();
    if best.effects().iter().any(is_dry) || !told || known {
        return None;
    }
    let mut structure = own.structure.with(effect);
    structure.knowledge = session.knowledge.holding(symbol, 0.0);
    let level = viscous * session.data.rubbing_speed();
    let probed = session.probed(own);
    let fits = probed.starts(effect, 1.0).into_iter().map(|start| {
        let mut values = own.values.clone();
        values[VISCOUS] = 0.0;
        values.push(level);
        values.extend(&start[1..]);
        let (structure, starts) = (structure.clone(), own.starts.clone());
        let mut fit = Fit::new(&session.data, structure, values, starts, &session.scales);
        fit.finish(&session.data, &session.scales);
        fit.polish_starts(&session.data, &session.scales);
        fit
    });
    let least = least(fits).filter(|fit| fit.cost.is_finite())?;
    Some(Trial::new(session, least))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viscous_friction_stays_where_it_makes_the_cycle() {
        let off = |period: f64, amplitude: f64| LoopError {
            period: Some(period),
            amplitude: Some(amplitude),
        };
        assert_eq!(class(off(0.03, -0.04)), [VISCOUS_FRICTION, DRY]);
        assert_eq!(class(off(0.71, 1.18)), [DRY]);
        assert_eq!(class(LoopError::default()), [DRY]);
    }
}
