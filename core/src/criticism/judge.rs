//! Does an effect stand out, may one do in the place of another, and do two models say the same?
//!
//! Held-back data decide whether an effect helps (see `select`); here its own size must be seen as well, in standard
//! errors that are widened by what the model leaves.

use super::score::Score;
use super::select::{
    fall, helps, is_all_that_counters_show, is_plain_noise, matters, same, suffices, usual_fall,
};
use super::session::Scored;
use crate::effect::Effect;

/// Whether two effects are the same or one contains the other.
pub(super) fn nested(a: &dyn Effect, b: &dyn Effect) -> bool {
    a.id() == b.id() || a.has_part(b.id()) || b.has_part(a.id())
}

/// Whether a part of an effect does in place of the whole: as well, or so that noise alone is left.
fn enough(whole: &Scored, part: &Scored, first: &Score) -> bool {
    alike(whole, part) || is_plain_noise(&part.score) || suffices(&part.score, &whole.score, first)
}

/// Whether a part does in place of the effect at this `place` of the whole, or of that effect nothing is seen beside it and
/// the held-back data do not want it.
pub(super) fn part_does(whole: &Scored, part: &Scored, place: usize, first: &Score) -> bool {
    enough(whole, part, first)
        || (!is_seen(part, whole, place) && !helps(&part.score, &whole.score))
}

/// Whether two models leave the same error within noise.
pub(super) fn alike(a: &Scored, b: &Scored) -> bool {
    same(&a.score, a.fit.values.len(), &b.score, b.fit.values.len())
}

/// Relative difference of error up to which two models do exactly the same.
const TIED: f64 = 1e-3;

/// Whether two models leave the same error for all that can be computed.
pub(super) fn tied(a: &Scored, b: &Scored) -> bool {
    (a.score.error / b.score.error - 1.0).abs() < TIED
}

/// Relative difference of inertia (of a process: gain and time constant) up to which two models speak of
/// the same body.
const SAME_BODY: f64 = 0.2;

/// Whether two models agree on the body, which the user knows roughly: with two levels of input a huge
/// dead zone looks like a small load, on a motor half as heavy.
pub(super) fn same_body(a: &Scored, b: &Scored) -> bool {
    let essential = a.fit.structure.baseline.essential();
    let mut pairs = a.fit.values.iter().zip(&b.fit.values).take(essential);
    pairs.all(|(a, b)| (a - b).abs() <= SAME_BODY * a.abs())
}

/// Fall of the error below which the leading parameter of an effect must stand out by itself, and by how
/// many standard errors; a larger fall asks for less, since its errors are widened by what is left.
const LARGE_FALL: f64 = 0.1;
const CLEAR_ERRORS: f64 = 3.0;
const LEAST_ERRORS: f64 = 1.5;

/// Fall of the error that speaks for itself.
pub(super) const HUGE_FALL: f64 = 0.5;

/// Whether the last effect of `with` helps `model` on both parts of the record, and is itself seen. What only tells how the record was made may be a
/// trifle: it is not said to be missing from the machine.
pub(super) fn helps_clearly(model: &Scored, with: &Scored, first: &Score) -> bool {
    let effects = &with.fit.structure.effects;
    let Some((last, _)) = effects.split_last() else {
        return false;
    };
    !is_all_that_counters_show(&model.score)
        && helps(&model.score, &with.score)
        && with.score.fit_cost < model.score.fit_cost
        && (last.is_of_record() || matters(&model.score, &with.score, first))
        && is_seen(model, with, effects.len() - 1)
}

/// Whether the effect at this place of `with`, which `model` has not, or only a part of, stands out by itself.
fn is_seen(model: &Scored, with: &Scored, place: usize) -> bool {
    let fall = fall(&model.score, &with.score);
    if fall > HUGE_FALL {
        return true;
    }
    let clear = if fall > LARGE_FALL {
        LEAST_ERRORS
    } else {
        CLEAR_ERRORS
    };
    stands_out(model, with, place, clear)
}

/// Whether the effect at this place of `with`, which `without` has not, is there whatever the fall of the error.
pub(super) fn is_certain(without: &Scored, with: &Scored, place: usize) -> bool {
    stands_out(without, with, place, CLEAR_ERRORS)
}

/// Fall of the error on the fitted part, a third of its square, that the few values of an effect do not bring by chance.
const FITTED_FALL: f64 = 0.2;

/// Whether an effect lowers the error, or that of the usual block, so much that it may be there although chance is not
/// ruled out while the rest is as correlated as it is; where one effect holds the motion and another lets it loose, the
/// held-back part may be led astray by the other alone, and the fitted part tells.
pub(super) fn may_hide(model: &Scored, with: &Scored) -> bool {
    fall(&model.score, &with.score) > LARGE_FALL
        || usual_fall(&model.score, &with.score) > HUGE_FALL
        || with.score.error_fit < (1.0 - FITTED_FALL) * model.score.error_fit
}

/// Whether a parameter that tells of the effect at this place of `with` is this many standard errors off 0.
fn stands_out(model: &Scored, with: &Scored, place: usize, clear: f64) -> bool {
    let errors = with.standard_errors();
    let structure = &with.fit.structure;
    let effect = structure.effects[place];
    let first = telling(model, effect);
    let mut own = structure.range(place).skip(first).take(effect.telling());
    own.any(|j| with.fit.values[j].abs() > clear * errors[j])
}

/// The place of the parameter that tells whether `effect` is there: its first one; in the place of a part of it in
/// `model`, the first that the part has not, or not so large. A level of friction that both have tells nothing.
fn telling(model: &Scored, effect: &dyn Effect) -> usize {
    let effects = model.fit.structure.effects.iter();
    let part = effects.copied().find(|e| effect.has_part(e.id()));
    part.and_then(|part| {
        effect.parameters().iter().position(|own| {
            let mut others = part.parameters().iter();
            others.all(|other| other.symbol != own.symbol || other.range != own.range)
        })
    })
    .unwrap_or(0)
}
