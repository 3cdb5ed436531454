//! A smooth curve along one variable, with as many values as a short table has: what a formula must be as good as.

use super::tuning::PIECES;
use super::weak::Weak;
use crate::effect::{Variable, variables};
use crate::measurement::Kind;

/// The best smooth curve.
pub(super) struct Curve {
    pub variable: Variable,
    /// Squared residuals of each block by the fit to the others.
    pub foretold: Vec<f64>,
}

/// The curve along that variable which foretells most.
pub(super) fn best(weak: &Weak, kind: Kind) -> Option<Curve> {
    let curves = variables(kind).iter().filter_map(|(_, variable)| {
        let columns = weak.pieces(*variable, PIECES)?;
        Some(Curve {
            variable: *variable,
            foretold: weak.foretold(&columns)?,
        })
    });
    let all = |c: &Curve| c.foretold.iter().sum::<f64>();
    curves.min_by(|a, b| all(a).total_cmp(&all(b)))
}
