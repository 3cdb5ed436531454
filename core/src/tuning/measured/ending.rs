//! Why the input no longer changes at the end of a record.

use super::cycle::Cycle;
use super::evidence::{Evidence, Trouble, TroubleKind, of_unit, trouble};
use super::number::number as n;
use super::record::Record;
use crate::msg;
use crate::order::{median, range};

/// What is left of a climb that counts as over, as a share of it: the usual band of a settling time.
const SETTLED: f64 = 0.05;

/// Standard errors within which something may be as well.
const ERRORS: f64 = 2.0;

/// Part of a stretch over which its slope at the end is taken, and samples of it at least.
const END: usize = 10;
const FEWEST: usize = 5;

/// So many of the longest periods before, without a switch, are no period.
const PERIODS: f64 = 2.0;

/// The input no longer changes: where does the output go?
pub(super) fn stalled(e: &Evidence<'_>, since: usize, up: bool) -> Option<Trouble> {
    levels_off(e, since, up).or_else(|| still_moves(e, since, up))
}

/// The output goes to a level, as far as the record shows it, that is short of the threshold.
fn levels_off(e: &Evidence<'_>, since: usize, up: bool) -> Option<Trouble> {
    let record = e.record;
    let last = record.input.len() - 1;
    let fit = e.fit?;
    let (ends, now) = (fit.settles?, *fit.simulated.last()?);
    let band = SETTLED * (ends.value - record.output[since]).abs();
    let settled = (ends.value - now).abs() <= band && ERRORS * ends.std_error <= band;
    let (low, high) = range(&record.output[since..]);
    let reached = n(if up { high } else { low });
    let word = if up { "up" } else { "down" };
    let seconds = n(record.time[last] - record.time[since]);
    // By which the level is beyond the target; of a plant with negative gain, a high input makes the output fall.
    let rises = up == (fit.model.gain.value > 0.0);
    let short = e.target.map(|t| {
        if rises {
            t - ends.value
        } else {
            ends.value - t
        }
    });
    let where_to = match (e.target, short) {
        (Some(target), Some(short)) if short > ERRORS * ends.std_error => msg!(
            "{}, {} short of the target of {}",
            n(ends.value),
            n(short),
            n(target)
        ),
        (None, _) if settled => n(ends.value).into(),
        _ => return None,
    };
    let text = if settled {
        msg!(
            "The input stays {} for the last {} s while the output has reached {} and levels off at \
             {}: the relay waits for a threshold that this input cannot reach. A lower target, or a stronger \
             input, lets it switch.",
            word,
            seconds,
            reached,
            where_to
        )
    } else {
        msg!(
            "The input stays {} for the last {} s while the output has reached {} and, going by the model, heads for \
             {}: the relay waits for a threshold that this input cannot reach. A lower target, or a stronger input, \
             lets it switch.",
            word,
            seconds,
            reached,
            where_to
        )
    };
    Some(trouble(
        TroubleKind::TargetUnreachable,
        true,
        ends.value,
        text,
    ))
}

/// The record ends on the way.
fn still_moves(e: &Evidence<'_>, since: usize, up: bool) -> Option<Trouble> {
    let record = e.record;
    let all = record.time.len();
    let part = ((all - since) / END).max(FEWEST);
    let from = all.checked_sub(part)?;
    let (slope, error) = slope(&record.time[from..], &record.output[from..])?;
    let word = if up { "up" } else { "down" };
    (slope.abs() > ERRORS * error).then(|| {
        let seconds = n(record.time[all - 1] - record.time[since]);
        let by = of_unit(slope.abs(), &record.output_unit);
        let text = if slope > 0.0 {
            msg!("The input stays {} for the last {} s and the output still rises at the end, by {} in a second: the \
                  record is too short to say whether the relay would switch. Let the test run on until the output has \
                  gone up and down several times, or no longer rises.", word, seconds, by)
        } else {
            msg!("The input stays {} for the last {} s and the output still falls at the end, by {} in a second: the \
                  record is too short to say whether the relay would switch. Let the test run on until the output has \
                  gone up and down several times, or no longer falls.", word, seconds, by)
        };
        trouble(TroubleKind::WindowTooShort, !e.told, slope, text)
    })
}

/// Slope of a straight line and its standard error.
fn slope(time: &[f64], values: &[f64]) -> Option<(f64, f64)> {
    let count = time.len() as f64;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / count;
    let (t0, y0) = (mean(time), mean(values));
    let pairs = || time.iter().zip(values).map(|(t, y)| (t - t0, y - y0));
    let tt: f64 = pairs().map(|(t, _)| t * t).sum();
    let slope = pairs().map(|(t, y)| t * y).sum::<f64>() / tt;
    let rss: f64 = pairs().map(|(t, y)| (y - slope * t).powi(2)).sum();
    (tt > 0.0 && count > 2.0).then(|| (slope, (rss / (count - 2.0) / tt).sqrt()))
}

/// A relay that no longer switches after some cycles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    /// Sample of the last switch.
    last: usize,
    /// Samples that are surely of the cycle before.
    pub before: usize,
    switches: usize,
    up: bool,
    /// Output since, from the first period on.
    reached: [f64; 2],
    middle: f64,
}

/// Whether the input stays for much longer than before while the output is where the relay does not switch.
pub(super) fn stop(record: &Record, cycle: &Cycle) -> Option<Stop> {
    let (at, up) = *cycle.switches.last()?;
    let end = *record.time.last()?;
    let longest = (cycle.marks.windows(2).map(|m| m[1] - m[0])).fold(0.0, f64::max);
    let last = record.time.partition_point(|t| *t < at);
    let later = record
        .output
        .get(record.time.partition_point(|t| *t < at + longest)..)?;
    let held = record.input[last..].windows(2).all(|u| u[0] == u[1]);
    let above = median(&mut later.to_vec()) > cycle.middle;
    // Up waits for a high output, of a plant with negative gain for a low one; on the other side a test is just over.
    let waits = above != (up == (cycle.hysteresis >= 0.0));
    let back = cycle.switches.len().checked_sub(3)?;
    let before = record
        .time
        .partition_point(|t| *t <= cycle.switches[back].0);
    let (low, high) = range(later);
    (held && waits && end - at > PERIODS * longest).then_some(Stop {
        last,
        before,
        switches: cycle.switches.len(),
        up,
        reached: [low, high],
        middle: cycle.middle,
    })
}

/// In words.
pub(super) fn stopped(record: &Record, stop: &Stop) -> Trouble {
    let seconds = n(record.time[record.time.len() - 1] - record.time[stop.last]);
    let [low, high] = stop.reached;
    let word = if stop.up { "up" } else { "down" };
    let ends = record.output[record.output.len() - 1];
    trouble(
        TroubleKind::TargetUnreachable,
        false,
        ends,
        msg!(
            "After {} switches the input stays {} for the last {} s, more than two of the longest periods before, \
             while the output, from {} to {}, does not come back to {} where the relay switched: from {} s on the \
             input no longer acts on the plant as it did, or something else does. What is said here applies to the \
             record before that.",
            stop.switches,
            word,
            seconds,
            n(low),
            n(high),
            n(stop.middle),
            n(record.time[stop.last])
        ),
    )
}
