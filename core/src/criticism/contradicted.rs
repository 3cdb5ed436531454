//! What the data say against what is known beforehand.

use super::explain::{Trial, difference};
use super::fit::Fit;
use super::select::is_plain_noise;
use super::session::{Scored, Session};
use crate::diagnosis::{Contradiction, Overruled};
use crate::user_model::Status;

/// Standard errors by which the data must miss a known value to contradict it.
const CLEAR: f64 = 3.0;

/// Iterations of a fit whose known values are released.
const RELEASED_ITERATIONS: usize = 8;

/// Tolerances by which the data must have moved a known value to overrule it.
const OVERRULED: f64 = 3.0;

/// Values with a tolerance that the data have moved by more than three of it.
pub(super) fn overruled(session: &Session, model: &Scored) -> Vec<Overruled> {
    let known = model.fit.structure.known();
    let found = session.parameters(model, &[]);
    let pairs = known.into_iter().zip(found);
    pairs
        .filter_map(|(known, found)| {
            let known = known?;
            let Status::Prior(tolerance) = known.status else {
                return None;
            };
            ((found.value - known.value).abs() > OVERRULED * tolerance).then_some(Overruled {
                effect: found.effect,
                name: found.name,
                given: known.value,
                tolerance,
                found: found.value,
                unit: found.unit,
            })
        })
        .collect()
}

/// A model whose known values are free.
pub(super) fn released(session: &Session, model: &Trial) -> Trial {
    let own = &model.scored.fit;
    let mut structure = own.structure.clone();
    structure.knowledge = structure.knowledge.released();
    let (values, starts) = (own.values.clone(), own.starts.clone());
    let mut fit = Fit::new(&session.data, structure, values, starts, &session.scales);
    for _ in 0..RELEASED_ITERATIONS {
        fit.iterate(&session.data, &session.scales);
    }
    fit.polish_starts(&session.data, &session.scales);
    Trial::new(session, fit)
}

/// Known values that the data contradict: with all of them released the model is better, and these end elsewhere; or
/// nothing but noise is left since the data were too strong for them.
pub(super) fn contradictions(session: &Session, model: &Trial) -> Vec<Contradiction> {
    let own = &model.scored;
    let held = &own.fit.structure;
    if held.knowledge.is_free() {
        return Vec::new();
    }
    let released = released(session, model);
    let released = if difference(session, model, &released).is_better() {
        &released.scored
    } else if is_plain_noise(&own.score) {
        own
    } else {
        return Vec::new();
    };
    let wanted = session.parameters(released, &[]);
    held.known()
        .into_iter()
        .zip(wanted)
        .filter_map(|(known, wanted)| {
            let known = known?;
            let tolerance = match known.status {
                Status::Free => return None,
                Status::Prior(tolerance) => tolerance,
                Status::Fixed => 0.0,
            };
            let clear = CLEAR * libm::hypot(wanted.std_error, tolerance);
            ((wanted.value - known.value).abs() > clear).then_some(Contradiction {
                effect: wanted.effect,
                name: wanted.name,
                held: known.value,
                wanted: wanted.value,
                std_error: wanted.std_error,
                unit: wanted.unit,
                error: released.score.error,
            })
        })
        .collect()
}
