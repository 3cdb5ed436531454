//! Coulomb friction: a constant force against the motion, and sticking at rest.
//!
//! No contact is infinitely stiff: after a reversal the force needs a small deflection `s` to build
//! up. On a drive that reverses every few samples, leaving `s` out bends the friction level by tens
//! of per cent and pushes it into the viscous friction, so it is fitted along; where the data show
//! none it goes to 0 and the contact is rigid.

use super::atom::{Values, not_negative};
use super::dry_friction::{DAMPING, LEVEL, SHORT};
use super::spec::HARD_CROSSINGS;
use super::{Atom, BodyStart, Effect, EffectId, ParameterSpec, Part, Probe};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) const ID: EffectId = EffectId::new("coulomb_friction");

pub(super) struct CoulombFriction;

/// Values with this level. The deflection is seen if it takes about a sample to cross after a reversal.
fn starts(level: f64, probe: &Probe) -> Vec<Vec<f64>> {
    let crossed = probe.scales.crossed();
    let values = [HARD_CROSSINGS, 0.35, 0.8].map(|samples| vec![level, samples * crossed, 0.1]);
    values.to_vec()
}

impl Effect for CoulombFriction {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Coulomb friction"
    }

    fn sentence(&self) -> &'static str {
        "Dry friction pushes against the motion with the same force at every speed, and holds the drive still until the push exceeds it."
    }

    fn equation(&self) -> &'static str {
        "F = -c sgn(v) while moving; after a reversal it builds up over s, damped by z; at rest it balances the input up to c"
    }

    fn source(&self) -> &'static str {
        "C.-A. de Coulomb, Théorie des machines simples, 1785; stick-slip as in Armstrong-Hélouvry, Dupont and Canudas de Wit, 1994"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[LEVEL, SHORT, DAMPING]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        starts(probe.friction_level(), probe)
    }

    fn starts_with_body(&self, probe: &Probe, _share: f64) -> Vec<BodyStart> {
        let Some(balance) = probe.balanced_in_motion(|_, v| -v.signum()) else {
            return Vec::new();
        };
        let level = balance.forces[0];
        let rubbing = starts(level, probe).into_iter().filter(|_| level > 0.0);
        rubbing.map(|values| (balance.body, values)).collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Force(|m, _| -m.direction)];
        vec![Atom::linear(
            COLUMNS,
            Values::From(|solved| {
                let (body, level) = not_negative(solved)?;
                Some((body, vec![level[0], 0.0, 0.1]))
            }),
        )]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.friction.level += values[0];
        model.friction.presliding = values[1];
        model.friction.contact_damping = values[2];
    }
}
