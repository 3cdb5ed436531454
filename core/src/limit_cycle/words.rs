//! What becomes of a loop, in sentences.

use super::noisy::NoisyCycle;
use super::pattern::{OneCycle, SAME_CYCLE, difference};
use super::{Cycle, ExactCycle, Prediction};
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

fn values([period, amplitude]: &OneCycle) -> String {
    let [period, amplitude] = [*period, *amplitude].map(significant);
    format!("period {period} s, amplitude {amplitude}")
}

/// It settles into a cycle.
pub(super) fn limit_cycle(
    cycle: &OneCycle,
    stable: Option<bool>,
    prediction: &Prediction,
) -> String {
    let slow = prediction.exact.iter().find(|c| {
        let of = [c.cycle.period, c.cycle.amplitude];
        difference(cycle, &of) < SAME_CYCLE
    });
    let slow = slow
        .and_then(|c| c.multiplier)
        .filter(|m| (SLOW..1.0).contains(m));
    let mut text = format!("It oscillates: {}.", values(cycle));
    if let Some(multiplier) = slow {
        let left = format!("{multiplier:.4}");
        text.push_str(" It settles slowly: a small disturbance shrinks to ");
        text.push_str(&left);
        text.push_str(" of its size in one period.");
    }
    if stable.is_none() {
        text += " Small disturbances neither die out nor grow.";
    }
    let rests = prediction.existence.is_some_and(|e| !e.holds);
    if rests {
        text += " From other starts it can also come to rest: the relay's push does not reach beyond both thresholds.";
    }
    text
}

/// A part of each cycle is sliding.
pub(super) fn slides_within(duration: f64) -> String {
    format!(
        " In each cycle the output slides along the threshold for {} s.",
        significant(duration)
    )
}

/// The output stays within the thresholds, at `level` if it is known.
pub(super) fn rest(level: Option<f64>, cycles: usize) -> String {
    let after = match cycles {
        0..MANY => String::new(),
        _ => format!(" It takes {cycles} cycles to get there."),
    };
    let rest = match level.filter(|l| l.is_finite()) {
        Some(level) => format!(
            "It comes to rest: with the relay held, the output goes to {}, which is not beyond the threshold.",
            significant(level)
        ),
        None => "It comes to rest: the relay no longer switches.".to_owned(),
    };
    rest + &after
}

/// The relay holds the output on its threshold.
pub(super) fn sliding(since: f64, rests: bool) -> String {
    let rest = if rests {
        ", and comes to rest there"
    } else {
        ""
    };
    format!(
        "It slides: from {} s on the relay holds the output on its threshold{rest}. There is no oscillation.",
        significant(since)
    )
}

/// Infinitely many switches up to an instant.
pub(super) fn accumulates(end: f64) -> String {
    format!(
        "The switches follow each other ever faster: from {} s on the relay holds the output on its threshold.",
        significant(end)
    )
}

/// Switches far faster than the plant.
pub(super) fn chatters() -> String {
    "The relay chatters: it switches far faster than the plant can follow.".to_owned()
}

/// No input of the relay's brings it back.
pub(super) fn unstable() -> String {
    "The output grows without bound: the plant is unstable, and has gone farther than the relay's push can bring it \
     back from."
        .to_owned()
}

/// The relay is held and the plant integrates.
pub(super) fn held() -> String {
    "The output grows without bound: the relay no longer switches, and the plant integrates its push.".to_owned()
}

/// Each swing is larger than the one before.
pub(super) fn grows(cycles: &[OneCycle]) -> String {
    let listed: Vec<String> = cycles
        .iter()
        .take(LISTED)
        .map(|c| significant(c[1]))
        .collect();
    format!(
        "The output grows without bound: from cycle to cycle the amplitude is {}, and so on.",
        listed.join(", ")
    )
}

/// One of a continuum.
pub(super) fn continuum(cycle: &OneCycle, others: Option<&[Cycle]>) -> String {
    let others: Vec<String> = others
        .into_iter()
        .flatten()
        .map(|c| {
            format!(
                "{} s at amplitude {}",
                significant(c.period),
                significant(c.amplitude)
            )
        })
        .collect();
    format!(
        "It oscillates: {}. This is one of a continuum of cycles: every start keeps its own, and the period depends on \
         the amplitude ({}).",
        values(cycle),
        others.join(", ")
    )
}

/// Several cycles that repeat together.
pub(super) fn pattern(cycles: &[OneCycle]) -> String {
    let period: f64 = cycles.iter().map(|c| c[0]).sum();
    let amplitudes = cycles.iter().map(|c| c[1]);
    let (low, high) = amplitudes.fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(a), h.max(a)));
    format!(
        "It oscillates in a pattern of {} cycles: {} s in all, amplitudes from {} to {}.",
        cycles.len(),
        significant(period),
        significant(low),
        significant(high)
    )
}

/// No pattern was found.
pub(super) fn irregular(cycles: &[OneCycle]) -> String {
    let half = &cycles[cycles.len() / 2..];
    let mean = |i: usize| half.iter().map(|c| c[i]).sum::<f64>() / half.len() as f64;
    format!(
        "It oscillates without a pattern that repeats: mean {} over {} cycles.",
        values(&[mean(0), mean(1)]),
        half.len()
    )
}

/// It leaves an unstable cycle slowly.
pub(super) fn leaves(exact: &ExactCycle, cycles: &[OneCycle]) -> String {
    let multiplier = exact.multiplier.unwrap_or(f64::NAN);
    format!(
        "It leaves the unstable cycle of {} slowly: a disturbance grows by the factor {multiplier:.7} in each period, \
         and after {} cycles the run has not settled.",
        values(&[exact.cycle.period, exact.cycle.amplitude]),
        cycles.len()
    )
}

/// Means and scatter in noise.
pub(super) fn noisy(
    found: &NoisyCycle,
    relay: &Relay,
    noise: Noise,
    prediction: &Prediction,
) -> String {
    let [period, amplitude] = [found.period, found.amplitude].map(uncertain);
    if found.chatters() {
        return format!(
            "The relay chatters in the noise: {:.0} switches in a cycle where two would do. Make its hysteresis ({}) \
             larger than the noise (standard deviation {}): three times as large is usual. Mean period {period} s, \
             amplitude {amplitude}.",
            found.switches,
            significant(relay.hysteresis),
            significant(noise.std_dev)
        );
    }
    let without = prediction
        .exact
        .iter()
        .find(|c| c.cycle.stable == Some(true));
    let without = without.map_or_else(String::new, |c| {
        format!(
            " Without noise: {}.",
            values(&[c.cycle.period, c.cycle.amplitude])
        )
    });
    format!(
        "It oscillates in the noise: mean period {period} s, amplitude {amplitude} (± from cycle to cycle).{without}"
    )
}

/// Nothing happens, noise or not.
pub(super) fn rest_in_noise() -> String {
    "It comes to rest: the noise does not make the relay switch.".to_owned()
}

/// The noise alone switches the relay.
pub(super) fn chatter_at_rest(switches: usize, duration: f64) -> String {
    format!(
        "The relay chatters in the noise: {switches} switches in {} s, and the output does not swing.",
        significant(duration)
    )
}

/// No run is long enough.
pub(super) fn too_fast() -> String {
    "A part of the plant is far too fast for the rest: the run was cut. Leave that part out."
        .to_owned()
}

/// Hardly any switch.
pub(super) fn too_slow() -> String {
    "The relay has hardly switched in a very long run: what becomes of it is not seen.".to_owned()
}
