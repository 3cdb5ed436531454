//! Whether a least time on or off holds the relay.
//!
//! A relay switches at the first sample beyond its threshold: whatever the noise, no output before a switch is beyond
//! the output of any switch of the same kind. Where some are, and the times are all alike, it is the time that
//! switches.

use super::cycle::Cycle;
use super::evidence::{Evidence, Trouble, TroubleKind, trouble};
use super::number::number as n;
use super::record::Record;
use crate::message::Message;
use crate::msg;
use crate::order::{median, range};

/// So many half periods or more are held by a minimum time, where they agree within the first share of a sample and the
/// outputs before their ends pass those at their ends; or within the second, those of the other side differ by more
/// than the third, and the outputs at their ends by more than the fourth of what chance makes.
const FEWEST_HELD: usize = 4;
const EQUAL_LENGTH: f64 = 0.01;
const SAME_LENGTH: f64 = 1.01;
const VARIES: f64 = 2.0;
const SCATTERS: f64 = 3.0;

/// Half periods of one side: their lengths, the outputs at their ends, and how far these move in a sample there.
struct Halves {
    lengths: Vec<f64>,
    ends: Vec<f64>,
    slopes: Vec<f64>,
    /// The output farthest towards the switch among the samples before each end, and at it; both rise to the switch.
    before: f64,
    at: f64,
}

impl Halves {
    fn of(record: &Record, cycle: &Cycle, up: bool) -> Self {
        let mut halves = Self {
            lengths: Vec::new(),
            ends: Vec::new(),
            slopes: Vec::new(),
            before: f64::NEG_INFINITY,
            at: f64::INFINITY,
        };
        // Of a plant with negative gain the relay goes down at a low output.
        let sign = if up == (cycle.hysteresis >= 0.0) {
            1.0
        } else {
            -1.0
        };
        // The first one belongs to the start.
        let all = cycle.switches.windows(2).filter(|s| s[0].1 == up);
        for s in all.skip(1) {
            halves.lengths.push(s[1].0 - s[0].0);
            let i = record.time.partition_point(|t| *t < s[1].0);
            if let Some([before, at]) = record
                .output
                .get(i.saturating_sub(1)..=i)
                .and_then(|y| y.first_chunk())
            {
                halves.ends.push(*at);
                halves.slopes.push((at - before).abs());
                halves.at = halves.at.min(sign * at);
            }
            // After a switch the output is still beyond the other threshold, and far from this one only later.
            let own = &record.output[record.between(0.5 * (s[0].0 + s[1].0), s[1].0)];
            halves.before = own.iter().fold(halves.before, |most, y| most.max(sign * y));
        }
        halves
    }
}

/// Lengths that no threshold set: all the same, while the outputs at their ends and the other half periods are not.
pub(super) fn minimum_time(e: &Evidence<'_>, cycle: &Cycle) -> Option<Trouble> {
    let sampling = e.record.sampling();
    let both = [true, false].map(|up| Halves::of(e.record, cycle, up));
    let spread = |values: &[f64]| {
        let (least, most) = range(values);
        most - least
    };
    [true, false].into_iter().find_map(|up| {
        let (own, other) = if up {
            (&both[0], &both[1])
        } else {
            (&both[1], &both[0])
        };
        let chance = median(&mut own.slopes.clone())
            .max(e.noise)
            .max(e.record.sensor_step());
        let (same, shown) = (spread(&own.lengths), own.before > own.at);
        // By thresholds that are known the output passes none by more than it moves in a sample.
        let beyond = (e.hysteresis).is_some_and(|h| cycle.hysteresis > h + SCATTERS * chance);
        let held = own.lengths.len() >= FEWEST_HELD
            && ((same <= EQUAL_LENGTH * sampling && (shown || beyond))
                || (same <= SAME_LENGTH * sampling
                    && spread(&other.lengths) > VARIES * sampling
                    && spread(&own.ends) > SCATTERS * chance));
        held.then(|| {
            let (least, (low, high)) = (range(&own.lengths).0, range(&own.ends));
            trouble(
                TroubleKind::MinimumTime,
                false,
                least,
                held_text(up, least, low, high),
            )
        })
    })
}

fn held_text(up: bool, least: f64, low: f64, high: f64) -> Message {
    let (least, low, high) = (n(least), n(low), n(high));
    if up {
        msg!(
            "Every time on lasts {} s, whatever the output is at its end ({} to {}): a minimum time on \
             holds the relay, so the cycle is not that of its thresholds.",
            least,
            low,
            high
        )
    } else {
        msg!(
            "Every time off lasts {} s, whatever the output is at its end ({} to {}): a minimum time off \
             holds the relay, so the cycle is not that of its thresholds.",
            least,
            low,
            high
        )
    }
}
