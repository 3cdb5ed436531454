//! The relay loop of the paper's Figs. 3, 4 and 5: what they show, and whether it is so.

use serde::{Deserialize, Serialize};

use crate::explore::{ExploreData, ExploreError, ExploreInput, compute};
use crate::message::{Message, fixed, signed};
use crate::msg;
use crate::relay::Relay;
use crate::simulate::Noise;
use crate::tuning::ultimate_gain;

/// A figure of the paper that can be set up and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its number in the paper.
    pub number: u32,
    /// What it shows, in two words.
    pub title: &'static str,
    /// What it claims.
    pub claim: &'static str,
    /// The loop.
    pub input: ExploreInput,
}

/// One part of a claim, with its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// What is compared.
    pub text: Message,
    /// Whether it is so.
    pub holds: bool,
}

/// Share by which the describing function may be off in Fig. 3, where it is the tool.
const DESCRIBED: f64 = 0.05;

/// Share by which the simulation may differ from the exact cycle: it is still settling.
const SETTLED: f64 = 1e-3;

/// Share by which noise may move the mean period.
const MOVED: f64 = 0.05;

/// Standard deviation of the noise of Figs. 4 and 5, and the time between its values, s.
const NOISE: f64 = 0.02;
const NOISE_INTERVAL: f64 = 0.02;

/// Hysteresis of Figs. 3 and 4, and the larger one of Fig. 5.
const HYSTERESIS: f64 = 0.1;
const LARGER_HYSTERESIS: f64 = 0.3;

/// Figs. 3, 4 and 5: a third-order lag under a relay; the same with noise; and with more hysteresis.
pub fn figures() -> Vec<Figure> {
    let noise = Some(Noise {
        std_dev: NOISE,
        interval: NOISE_INTERVAL,
        seed: 4,
    });
    let input = |hysteresis, noise| ExploreInput {
        relay: Relay {
            hysteresis,
            ..Relay::default()
        },
        noise,
        ..ExploreInput::default()
    };
    vec![
        Figure {
            number: 3,
            title: "relay loop",
            claim: "A relay with hysteresis makes a third-order lag oscillate by itself, as the describing function \
                 says.",
            input: input(HYSTERESIS, None),
        },
        Figure {
            number: 4,
            title: "with noise",
            claim: "Hysteresis keeps measurement noise from switching the relay: it still switches twice a period.",
            input: input(HYSTERESIS, noise),
        },
        Figure {
            number: 5,
            title: "larger ε",
            claim: "More hysteresis: larger amplitude, longer period, smaller ultimate gain.",
            input: input(LARGER_HYSTERESIS, noise),
        },
    ]
}

/// Checks the claim of a figure on a loop and what was computed for it; none for a number that is not
/// among [`figures`].
///
/// # Errors
/// Where a loop to compare with cannot be computed.
pub fn checks(
    number: u32,
    input: &ExploreInput,
    data: &ExploreData,
) -> Result<Vec<Check>, ExploreError> {
    match number {
        3 => Ok(oscillates(data)),
        4 => noise_is_held_off(input, data),
        5 => hysteresis_costs(input, data),
        _ => Ok(Vec::new()),
    }
}

fn check(text: Message, holds: bool) -> Check {
    Check { text, holds }
}

/// Digits to which two numbers agree that differ by this share.
pub(crate) fn digits(difference: f64) -> i32 {
    let agreed = -libm::log10(difference.abs().max(f64::EPSILON));
    (agreed.floor() as i32).max(0)
}

fn none() -> Vec<Check> {
    vec![check("there is an exact cycle".into(), false)]
}

fn oscillates(data: &ExploreData) -> Vec<Check> {
    let Some(exact) = data.exact else {
        return none();
    };
    let mut all = vec![check(
        msg!(
            "the exact cycle of period {} s is stable",
            fixed(exact.period, 3)
        ),
        exact.stable == Some(true),
    )];
    let simulated = data
        .simulated
        .map(|c| (c.period / exact.period - 1.0).abs());
    all.push(match simulated {
        Some(error) => check(
            msg!(
                "the simulation matches its period to {} digits",
                digits(error)
            ),
            error < SETTLED,
        ),
        None => check("the simulation settles into it".into(), false),
    });
    if let Some(described) = data.describing() {
        let period = described.cycle.period / exact.period - 1.0;
        let amplitude = described.cycle.amplitude / exact.amplitude - 1.0;
        all.push(check(
            msg!(
                "the describing function is off by {} % in period, {} % in amplitude",
                signed(100.0 * period, 1),
                signed(100.0 * amplitude, 1)
            ),
            period.abs() < DESCRIBED && amplitude.abs() < DESCRIBED,
        ));
    }
    all
}

fn noise_is_held_off(input: &ExploreInput, data: &ExploreData) -> Result<Vec<Check>, ExploreError> {
    let (Some(exact), Some(count)) = (data.exact, data.switches_per_period) else {
        return Ok(none());
    };
    let mut all = vec![check(
        msg!(
            "{} switches a period with ε = {}",
            fixed(count, 2),
            fixed(input.relay.hysteresis, 3)
        ),
        (count - 2.0).abs() < 2.0 * MOVED,
    )];
    if let Some(simulated) = data.simulated {
        let moved = simulated.period / exact.period - 1.0;
        all.push(check(
            msg!(
                "noise moves the mean period by {} %",
                signed(100.0 * moved, 1)
            ),
            moved.abs() < MOVED,
        ));
    }
    let mut ideal = input.clone();
    ideal.relay.hysteresis = 0.0;
    if let Some(without) = compute(&ideal)?.switches_per_period {
        all.push(check(
            msg!(
                "{} switches a period with ε = 0 in the same noise",
                fixed(without, 1)
            ),
            without > 2.0 * (1.0 + MOVED),
        ));
    }
    Ok(all)
}

fn hysteresis_costs(input: &ExploreInput, data: &ExploreData) -> Result<Vec<Check>, ExploreError> {
    let mut before = input.clone();
    before.relay.hysteresis = HYSTERESIS;
    before.noise = None;
    let (Some(old), Some(new)) = (compute(&before)?.exact, data.exact) else {
        return Ok(none());
    };
    let gain = |amplitude| ultimate_gain(input.relay.gain, amplitude);
    let compared = |name: &'static str, old: f64, new: f64, holds| {
        check(
            msg!(
                "{}: {} at ε = {}, now {}",
                name,
                fixed(old, 3),
                HYSTERESIS,
                fixed(new, 3)
            ),
            holds,
        )
    };
    let (k_old, k_new) = (gain(old.amplitude), gain(new.amplitude));
    Ok(vec![
        compared(
            "larger amplitude a",
            old.amplitude,
            new.amplitude,
            new.amplitude > old.amplitude,
        ),
        compared(
            "longer period [s]",
            old.period,
            new.period,
            new.period > old.period,
        ),
        compared("smaller Ku = 4k/(πa)", k_old, k_new, k_new < k_old),
    ])
}
