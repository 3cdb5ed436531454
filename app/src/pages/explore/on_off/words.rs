//! What is said of an on-off loop.

use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::on_off::{Balance, OnOffCycle, OnOffData, OnOffInput, Position};
use hysteron_core::uncertain::{brief, digits, quantity};

use super::super::cycle_table::difference;

/// Positions of a cycle that are told one by one.
const TOLD: usize = 6;

/// Digits of the ends of a swing.
const DIGITS: i32 = 4;

/// The cycle, exact if it is known.
pub fn cycle(data: &OnOffData) -> Option<&OnOffCycle> {
    data.exact.as_ref().or(data.simulated.as_ref())
}

/// The first stable balance, or else the first.
pub fn balance(data: &OnOffData) -> Option<&Balance> {
    let all = data.describing_function.as_deref().unwrap_or_default();
    let stable = all.iter().find(|b| b.stable == Some(true));
    stable.or(all.first())
}

/// Whether down is off: the actuator works in one direction.
fn one_sided(input: &OnOffInput) -> bool {
    input.relay.output(Position::Down) == 0.0
}

/// The answer.
pub fn answer(input: &OnOffInput, data: &OnOffData) -> Message {
    if let Some(position) = data.rests {
        return match position {
            Position::Off => {
                "It stays off and no longer switches: the output rests in the dead zone."
            }
            Position::Up if one_sided(input) => {
                "It stays on and no longer switches: the reference is out of reach."
            }
            Position::Down if one_sided(input) => "It stays off and no longer switches.",
            _ => "It no longer switches: the output does not reach the other threshold.",
        }
        .into();
    }
    match cycle(data) {
        Some(cycle) => {
            let [low, high] = cycle.range.map(|v| digits(v, DIGITS));
            msg!(
                "It oscillates between {} and {}, with a period of {}.",
                low,
                high,
                quantity(cycle.period, "s")
            )
        }
        None => "It oscillates in a pattern that does not repeat.".into(),
    }
}

/// What the answer rests on, sentence by sentence.
pub fn reasons(input: &OnOffInput, data: &OnOffData) -> Vec<Message> {
    if data.rests.is_some() {
        return Vec::new();
    }
    [Some(exactly(input, data)), first_harmonic(input, data)]
        .into_iter()
        .flatten()
        .collect()
}

/// The exact cycle, or that there is none.
fn exactly(input: &OnOffInput, data: &OnOffData) -> Message {
    let Some(cycle) = &data.exact else {
        return if data.simulated.is_some() {
            "The simulation repeats itself, but no exact cycle was found to match it."
        } else {
            "There is no exact cycle to compare with: no pattern of up to 24 switches repeats."
        }
        .into();
    };
    let count = cycle.positions.len();
    if count > TOLD {
        return msg!("Exact cycle: {} switches in each period.", count);
    }
    let parts = cycle.positions.iter();
    let parts = parts.map(|(position, time)| {
        let time = quantity(*time, "s");
        match position {
            Position::Up if one_sided(input) => msg!("on {}", time),
            Position::Down if one_sided(input) => msg!("off {}", time),
            other => other.lasting(time),
        }
    });
    msg!("Exact cycle: {}.", Message::list(", ", parts))
}

/// What the describing function says beside it.
fn first_harmonic(input: &OnOffInput, data: &OnOffData) -> Option<Message> {
    let relay = &input.relay;
    let Some(all) = &data.describing_function else {
        return Some(
            if relay.has_three_positions() {
                "No describing function here: with three positions it needs a reference of 0 and pushes of the same \
                 strength."
            } else {
                "No describing function here: in discrete time it needs a reference of 0 and pushes of the same \
                 strength."
            }
            .into(),
        );
    };
    if all.is_empty() {
        let holds = relay.min_on.max(relay.min_off) > 0.0;
        return Some(
            if holds {
                "The describing function sees no oscillation that keeps the minimum times."
            } else {
                "The describing function sees no oscillation."
            }
            .into(),
        );
    }
    let (found, cycle) = (balance(data)?, cycle(data)?);
    Some(msg!(
        "The describing function predicts a period of {} ({}) and an amplitude of {} ({}).",
        quantity(found.period, "s"),
        difference(found.period, cycle.period),
        brief(found.amplitude),
        difference(found.amplitude, cycle.amplitude)
    ))
}
