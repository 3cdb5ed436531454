//! The verdict in plain words.

use super::cycles::ENOUGH_SAMPLES;
use super::gap::{GapEstimate, Quality};
use crate::message::{Message, fixed};
use crate::{counted, msg};

/// Traverses up to which all of them are spoken for; of more, nine in ten.
const FEW: usize = 10;

/// Relative deviation of a traverse from the gap up to which it agrees with it.
const AGREES: f64 = 0.1;

/// One or two sentences about `estimate`; `flips`: whether the asymmetry of the relay changed its sign.
pub(super) fn text(estimate: &GapEstimate, flips: bool) -> Message {
    let (scale, unit) = estimate.written_in();
    let travel = number(estimate.travel * scale);
    let contacts = counted!(estimate.contacts.len(), "1 contact", "{} contacts");
    match estimate.quality {
        Quality::TooFewSamples => too_few_samples(None),
        Quality::NoDriftingTest => {
            "no drifting test: expected a limit cycle under a velocity relay whose asymmetry \
            changes its sign every few seconds"
                .into()
        }
        Quality::NoEngagement if !flips => msg!(
            "no engagement seen: the motor met no load on its {} {} of travel, and the asymmetry of the relay never \
             changed its sign, so that this is not a drifting test either",
            travel,
            unit
        ),
        Quality::NoEngagement => {
            msg!("no engagement seen: the gap may be wider than the travel of {} {}, or there is no load", travel, unit)
        }
        Quality::Disturbed => "no engagement seen: the motor is disturbed, but not by contacts with a load, since the \
                               force acts all through the cycle (as with cogging, changing friction or a flexible \
                               shaft)"
            .into(),
        Quality::OneSide => msg!(
            "the load was met on one side only ({}); the gap may be wider than the travel of {} {}",
            contacts,
            travel,
            unit
        ),
        Quality::Undecided => msg!(
            "the load was met on both sides ({} contacts), but it moved so much in between that the width of the gap \
             stays unknown",
            estimate.contacts.len()
        ),
        Quality::AssumedCentre => msg!(
            "the gap is {}, if the motor started in its middle: the load was met on one side only ({}), and the \
             travel from the start to the first contact counts as half a gap; no traverse confirms it",
            value(estimate),
            contacts
        ),
        Quality::Good | Quality::Fair | Quality::Poor => {
            msg!("the gap is {}: {}", value(estimate), agreement(estimate))
        }
    }
}

/// The same where the input turns round every so many samples, if that is known.
pub(super) fn too_few_samples(per_cycle: Option<f64>) -> Message {
    let needed = fixed(ENOUGH_SAMPLES, 0);
    match per_cycle {
        Some(n) => msg!(
            "too few samples to see contacts within a cycle: a cycle of the relay has {}, and {} are needed; sample \
             faster, or make the cycle longer by more hysteresis or less torque",
            fixed(n, 1),
            needed
        ),
        None => msg!(
            "too few samples to see contacts within a cycle, and {} are needed; sample faster, or \
         make the cycle longer by more hysteresis or less torque",
            needed
        ),
    }
}

/// The gap with its standard error.
fn value(estimate: &GapEstimate) -> String {
    let gap = estimate.gap.unwrap_or(0.0);
    let (scale, unit) = estimate.written_in();
    let (gap, error) = (gap * scale, estimate.std_error.unwrap_or(0.0) * scale);
    let digits = if error > 0.0 {
        (1 - libm::log10(error).floor() as i32).clamp(0, 12) as usize
    } else {
        6
    };
    format!("{gap:.digits$} ± {error:.digits$} {unit}")
}

/// How well the traverses agree: all of a few, nine in ten of many, else those that do and how far the others are off.
fn agreement(estimate: &GapEstimate) -> Message {
    let gap = estimate.gap.unwrap_or(1.0);
    let mut off: Vec<f64> = estimate
        .traverses
        .iter()
        .map(|t| (t.gap / gap - 1.0).abs())
        .collect();
    off.sort_by(f64::total_cmp);
    let percent = |share: f64| {
        let percent = 100.0 * share;
        if percent < 0.95 {
            format!("{percent:.1} %")
        } else {
            format!("{percent:.0} %")
        }
    };
    let agree = off.iter().filter(|o| **o <= AGREES).count();
    let last = off.last().copied().unwrap_or(0.0);
    match off.len() {
        0 => "by the travel between contacts on both sides".into(),
        1 => "one traverse; a longer test would confirm it".into(),
        n if n == agree && n <= FEW => {
            msg!("{} traverses agree within {}", word(n), percent(last))
        }
        n if n > FEW && off[n * 9 / 10] <= AGREES => msg!(
            "nine in ten of {} traverses agree within {}",
            n,
            percent(off[n * 9 / 10])
        ),
        n if 2 * agree > n => msg!(
            "{} of {} traverses agree within {}, the others are off by up to {}",
            word(agree),
            word(n),
            percent(off[agree - 1]),
            percent(last)
        ),
        n => msg!(
            "{} traverses scatter about it by up to {}",
            word(n),
            percent(last)
        ),
    }
}

fn word(n: usize) -> Message {
    const WORDS: [&str; 11] = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
    ];
    WORDS.get(n).map_or_else(|| n.into(), Into::into)
}

/// Three significant digits.
fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = (2 - libm::log10(value.abs()).floor() as i32).clamp(0, 12) as usize;
    format!("{value:.digits$}")
}
