//! What to try next with the loop that is set.

use hysteron_core::explore::{ExploreData, ExploreInput};
use hysteron_core::message::Message;
use hysteron_core::msg;

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
                msg!(
                    "Narrow the hysteresis to ε = {}: does it oscillate then?",
                    narrow
                ),
            )
        } else {
            let wait = rounded(FIRST * input.relay.gain);
            waiting(
                input,
                wait,
                msg!(
                    "Give the relay a hysteresis of ε = {}: then it no longer chatters.",
                    wait
                ),
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
                msg!("Widen the hysteresis to ε = {}: does the describing function still hold?", wide),
            )
        }
        _ => Hint {
            sentence:
                "Where does the describing function hold, and where does the oscillation end? See it for two \
                 parameters at once."
                .into(),
            commands: vec![Command::Go("maps")],
        },
    }
}

/// The same loop with another hysteresis.
fn waiting(input: &ExploreInput, eps: f64, sentence: Message) -> Hint {
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
