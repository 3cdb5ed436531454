//! What becomes of a loop, in sentences.

use super::noisy::NoisyCycle;
use super::pattern::{OneCycle, SAME_CYCLE, difference};
use super::{Cycle, ExactCycle, Prediction};
use crate::message::{Message, fixed};
use crate::msg;
use crate::relay::Relay;
use crate::simulate::Noise;
use crate::uncertain::digits;

/// Cycles of a growing swing that are listed.
const LISTED: usize = 4;

/// Cycles before it comes to rest that are many.
const MANY: usize = 20;

/// Share of a disturbance that is left after a period from which on a cycle is slow to settle.
const SLOW: f64 = 0.9;

/// A value with four significant digits.
fn significant(value: f64) -> String {
    digits(value, 4)
}

/// A mean with its scatter: two significant digits of this, and as many decimals of the mean.
fn uncertain([mean, spread]: [f64; 2]) -> String {
    if !(spread > 0.0 && spread.is_finite() && spread < mean.abs()) {
        return format!("{} ± {}", significant(mean), significant(spread));
    }
    let decimals = (1.0 - libm::floor(libm::log10(spread))).clamp(0.0, 12.0) as usize;
    format!("{mean:.decimals$} ± {spread:.decimals$}")
}

fn values([period, amplitude]: &OneCycle) -> Message {
    let [period, amplitude] = [*period, *amplitude].map(significant);
    msg!("period {} s, amplitude {}", period, amplitude)
}

/// It settles into a cycle.
pub(super) fn limit_cycle(
    cycle: &OneCycle,
    stable: Option<bool>,
    prediction: &Prediction,
) -> Message {
    let slow = prediction.exact.iter().find(|c| {
        let of = [c.cycle.period, c.cycle.amplitude];
        difference(cycle, &of) < SAME_CYCLE
    });
    let slow = slow
        .and_then(|c| c.multiplier)
        .filter(|m| (SLOW..1.0).contains(m));
    let mut text = msg!("It oscillates: {}.", values(cycle));
    if let Some(multiplier) = slow {
        text.add(msg!(
            "It settles slowly: a small disturbance shrinks to {} of its size in one period.",
            fixed(multiplier, 4)
        ));
    }
    if stable.is_none() {
        text.add("Small disturbances neither die out nor grow.");
    }
    let rests = prediction.existence.is_some_and(|e| !e.holds);
    if rests {
        text.add(
            "From other starts it can also come to rest: the relay's push does not reach beyond both thresholds.",
        );
    }
    text
}

/// A part of each cycle is sliding.
pub(super) fn slides_within(duration: f64) -> Message {
    msg!(
        "In each cycle the output slides along the threshold for {} s.",
        significant(duration)
    )
}

/// The output stays within the thresholds, at `level` if it is known.
pub(super) fn rest(level: Option<f64>, cycles: usize) -> Message {
    let after = match cycles {
        0..MANY => Message::default(),
        _ => msg!("It takes {} cycles to get there.", cycles),
    };
    let rest = match level.filter(|l| l.is_finite()) {
        Some(level) => msg!(
            "It comes to rest: with the relay held, the output goes to {}, which is not beyond the threshold.",
            significant(level)
        ),
        None => "It comes to rest: the relay no longer switches.".into(),
    };
    rest.and(after)
}

/// The relay holds the output on its threshold.
pub(super) fn sliding(since: f64, rests: bool) -> Message {
    let since = significant(since);
    let slides = if rests {
        msg!(
            "It slides: from {} s on the relay holds the output on its threshold, where it comes to rest.",
            since
        )
    } else {
        msg!(
            "It slides: from {} s on the relay holds the output on its threshold.",
            since
        )
    };
    slides.and("There is no oscillation.")
}

/// Infinitely many switches up to an instant.
pub(super) fn accumulates(end: f64) -> Message {
    msg!(
        "The switches follow each other ever faster: from {} s on the relay holds the output on its threshold.",
        significant(end)
    )
}

/// Switches far faster than the plant.
pub(super) fn chatters() -> Message {
    "The relay chatters: it switches far faster than the plant can follow.".into()
}

/// No input of the relay's brings it back.
pub(super) fn unstable() -> Message {
    "The output grows without bound: the plant is unstable, and has gone farther than the relay's push can bring it \
     back from."
        .into()
}

/// The relay is held and the plant integrates.
pub(super) fn held() -> Message {
    "The output grows without bound: the relay no longer switches, and the plant integrates its push.".into()
}

/// Each swing is larger than the one before.
pub(super) fn grows(cycles: &[OneCycle]) -> Message {
    let listed = cycles.iter().take(LISTED).map(|c| significant(c[1]));
    msg!(
        "The output grows without bound: from cycle to cycle the amplitude is {}, and so on.",
        Message::list(", ", listed)
    )
}

/// One of a continuum.
pub(super) fn continuum(cycle: &OneCycle, others: Option<&[Cycle]>) -> Message {
    let others = others.into_iter().flatten().map(|c| {
        msg!(
            "{} s at amplitude {}",
            significant(c.period),
            significant(c.amplitude)
        )
    });
    msg!(
        "It oscillates: {}. This is one of a continuum of cycles: each start leads to its own, and the period depends \
         on the amplitude ({}).",
        values(cycle),
        Message::list(", ", others)
    )
}

/// Several cycles that repeat together.
pub(super) fn pattern(cycles: &[OneCycle]) -> Message {
    let period: f64 = cycles.iter().map(|c| c[0]).sum();
    let amplitudes = cycles.iter().map(|c| c[1]);
    let (low, high) = amplitudes.fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(a), h.max(a)));
    msg!(
        "It oscillates in a pattern of {} cycles: {} s in all, amplitudes from {} to {}.",
        cycles.len(),
        significant(period),
        significant(low),
        significant(high)
    )
}

/// No pattern was found.
pub(super) fn irregular(cycles: &[OneCycle]) -> Message {
    let half = &cycles[cycles.len() / 2..];
    let mean = |i: usize| half.iter().map(|c| c[i]).sum::<f64>() / half.len() as f64;
    msg!(
        "It oscillates without a pattern that repeats: mean {} over {} cycles.",
        values(&[mean(0), mean(1)]),
        half.len()
    )
}

/// It leaves an unstable cycle slowly.
pub(super) fn leaves(exact: &ExactCycle, cycles: &[OneCycle]) -> Message {
    let multiplier = exact.multiplier.unwrap_or(f64::NAN);
    msg!(
        "It slowly leaves the unstable cycle of {}: a disturbance grows by a factor of {} in each period, and after \
         {} cycles the run has not settled.",
        values(&[exact.cycle.period, exact.cycle.amplitude]),
        fixed(multiplier, 7),
        cycles.len()
    )
}

/// Means and scatter in noise.
pub(super) fn noisy(
    found: &NoisyCycle,
    relay: &Relay,
    noise: Noise,
    prediction: &Prediction,
) -> Message {
    let [period, amplitude] = [found.period, found.amplitude].map(uncertain);
    if found.chatters() {
        return msg!(
            "The relay chatters in the noise: {} switches in a cycle where two would do. Make its hysteresis ({}) \
             larger than the noise (standard deviation {}): three times as large is usual. Mean period {} s, \
             amplitude {}.",
            fixed(found.switches, 0),
            significant(relay.hysteresis),
            significant(noise.std_dev),
            period,
            amplitude
        );
    }
    let without = prediction
        .exact
        .iter()
        .find(|c| c.cycle.stable == Some(true));
    let without = without.map_or_else(Message::default, |c| {
        msg!(
            "Without noise: {}.",
            values(&[c.cycle.period, c.cycle.amplitude])
        )
    });
    msg!(
        "It oscillates in the noise: mean period {} s, amplitude {} (± from cycle to cycle).",
        period,
        amplitude
    )
    .and(without)
}

/// Nothing happens, noise or not.
pub(super) fn rest_in_noise() -> Message {
    "It comes to rest: the noise does not make the relay switch.".into()
}

/// The noise alone switches the relay.
pub(super) fn chatter_at_rest(switches: usize, duration: f64) -> Message {
    msg!(
        "The relay chatters in the noise: {} switches in {} s, and the output does not swing.",
        switches,
        significant(duration)
    )
}

/// No run is long enough.
pub(super) fn too_fast() -> Message {
    "A part of the plant is far too fast for the rest: the run was stopped. Leave that part out."
        .into()
}

/// Hardly any switch.
pub(super) fn too_slow() -> Message {
    "The relay has hardly switched in a very long run: how it goes on cannot be seen.".into()
}
