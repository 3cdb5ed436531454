//! Does the noise of a measured input act?
//!
//! That of a sensor does not; what a controller makes of a noisy output does. The record tells: the body follows what
//! acts.

use super::explain::{LEAST_FALL, begun};
use super::record::levelled;
use super::screen::Screened;
use super::session::Session;
use crate::diagnosis::CriticismError;
use crate::measurement::Measurement;
use crate::user_model::UserModel;

/// A session and the record as it was screened; without the noise of its input where that is better explained.
pub(super) fn prepared(
    measurement: &Measurement,
    model: &UserModel,
) -> Result<(Session, Screened), CriticismError> {
    let as_read = Session::screened(measurement, model)?;
    let Some(found) = levelled(&measurement.input.values) else {
        return Ok(as_read);
    };
    let mut quiet = measurement.clone();
    quiet.input.values.clone_from(&found.values);
    let (mut session, screened) = Session::screened(&quiet, model)?;
    session.levelled = Some(found);
    let quiet = (session, screened);
    let left = |(session, screened): &(Session, Screened)| {
        let held = session.chosen(model, &[]).ok()?;
        begun(session, screened, &held).map(|trial| trial.left_of_outputs(&session.data))
    };
    let pair = left(&quiet).zip(left(&as_read));
    let is_better = pair.is_some_and(|(less, more)| less < (1.0 - LEAST_FALL) * more);
    Ok(if is_better { quiet } else { as_read })
}
