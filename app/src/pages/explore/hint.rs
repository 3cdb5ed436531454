//! What to try next with the loop that is set.

use hysteron_core::explore::{ExploreData, ExploreInput};

use crate::command::Command;
use crate::page::Hint;

/// Share by which the describing function may miss the amplitude and still be right enough to be tried further.
const RIGHT: f64 = 0.05;

/// Hysteresis of a relay that is to wait longer, in times of what it is; of an ideal one, as a share of the amplitude.
const WIDER: f64 = 2.0;
const FIRST: f64 = 0.2;

/// The same of one that waits so long that nothing oscillates.
const NARROWER: f64 = 0.25;

/// Another loop to try, or where to go with this one.
pub(super) fn hint(input: &ExploreInput, data: &ExploreData) -> Hint {
    let eps = input.relay.hysteresis;
    let Some(cycle) = data.exact.or(data.simulated) else {
        return if eps > 0.0 {
            let narrow = rounded(NARROWER * eps);
            waiting(
                input,
                narrow,
                format!("Narrow the hysteresis to ε = {narrow}: does it oscillate then?"),
            )
        } else {
            let wait = rounded(FIRST * input.relay.gain);
            waiting(
                input,
                wait,
                format!("Give the relay a hysteresis of ε = {wait}: then it no longer chatters."),
            )
        };
    };
    let wide = rounded(if eps > 0.0 {
        WIDER * eps
    } else {
        FIRST * cycle.amplitude
    });
    // Beyond that the output does not come.
    let farthest = (input.relay.gain * input.plant.dc_gain()).abs();
    match data.trust.amplitude_error {
        Some(error) if error.abs() < RIGHT && wide < farthest => {
            waiting(
                input,
                wide,
                format!("Widen the hysteresis to ε = {wide}: does the describing function still hold?"),
            )
        }
        _ => Hint {
            sentence: "Where does the describing function hold, and where does the oscillation end? See it for two parameters at once."
                .to_owned(),
            commands: vec![Command::Go("maps")],
        },
    }
}

/// The same loop with another hysteresis.
fn waiting(input: &ExploreInput, eps: f64, sentence: String) -> Hint {
    let mut input = input.clone();
    input.relay.hysteresis = eps;
    Hint {
        sentence,
        commands: vec![Command::SetLoop(Box::new(input))],
    }
}

/// To two digits.
fn rounded(value: f64) -> f64 {
    let digits = 10_f64.powf(1.0 - value.abs().log10().floor());
    let value = (value * digits).round() / digits;
    if value.is_finite() { value } else { 0.0 }
}
