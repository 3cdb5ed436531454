//! Gaps in the time of a record, where rows are missing.

use super::Kind;
use crate::message::Message;
use crate::msg;

/// A step in time this many times the usual one is a gap, if there is no more than one in so many.
const GAP: f64 = 1.6;
const RARE: usize = 50;

/// Where the clock is so uneven that there are more, one is a gap that is this many times as long as the longest of the
/// others: of intervals as random as those of a decay, one in a billion.
const FAR_LONGER: f64 = 5.0;

/// Average steps from which a gap of a process is said: over a shorter one hardly anything moves.
const SAID: f64 = 5.0;

/// First samples after gaps in times that increase.
pub fn gaps(time: &[f64]) -> Vec<usize> {
    let step = |k: usize| time[k] - time[k - 1];
    let mut steps: Vec<f64> = (1..time.len()).map(step).collect();
    if steps.is_empty() {
        return Vec::new();
    }
    let longer = |than: f64| (1..time.len()).filter(|k| step(*k) > than).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let found: Vec<usize> = longer(GAP * steps[steps.len() / 2]);
    if found.len() * RARE <= time.len() {
        return found;
    }
    let often = steps.len() - time.len() / RARE;
    longer(FAR_LONGER * steps[often.saturating_sub(1)])
}

/// What is to be said of the gaps of a process, whose model runs on over them.
pub(super) fn said(kind: Kind, time: &[f64]) -> Option<Message> {
    let found = gaps(time);
    let step = |k: &usize| time[*k] - time[k - 1];
    let longest = found.iter().map(step).max_by(f64::total_cmp)?;
    let usual = (time.last()? - time.first()?) / time.len() as f64;
    (kind == Kind::Process && longest > SAID * usual).then(|| {
        let longest = format!("{longest:.3e}").parse().unwrap_or(longest);
        match found.len() {
            1 => msg!(
                "The time has {} gap, of {} s: the input is taken as held across it.",
                1,
                longest
            ),
            many => msg!(
                "The time has {} gaps, the longest of {} s: the input is taken as held across them.",
                many,
                longest
            ),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Times of a clock whose steps are `1 + jitter` at most, with a gap of 100 before every 200th sample.
    fn times(jitter: f64) -> Vec<f64> {
        let mut random = Random::new(5);
        let mut now = 0.0;
        (0..1000)
            .map(|k| {
                now += 1.0 + jitter * random.uniform();
                if k > 0 && k % 200 == 0 {
                    now += 100.0;
                }
                now
            })
            .collect()
    }

    #[test]
    fn gaps_are_found_however_the_clock_jitters() {
        for jitter in [0.0, 0.1, 1.0, 3.0] {
            assert_eq!(gaps(&times(jitter)), [200, 400, 600, 800], "{jitter}");
        }
        assert!(gaps(&[0.0]).is_empty());
    }

    #[test]
    fn a_record_with_samples_at_all_distances_has_none() {
        let mut random = Random::new(7);
        let mut now = 0.0;
        let times: Vec<f64> = (0..5000)
            .map(|_| {
                now -= libm::log(1.0 - random.uniform());
                now
            })
            .collect();
        assert!(gaps(&times).is_empty());
    }

    #[test]
    fn the_gaps_of_a_process_are_said() {
        let said = said(Kind::Process, &times(0.0)).unwrap();
        assert_eq!(
            said,
            "The time has 4 gaps, the longest of 101 s: the input is taken as held across them."
        );
    }
}
