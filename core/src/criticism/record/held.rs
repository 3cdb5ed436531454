//! Channels that hold a reading until the next one comes, as a bus or a slow sensor does in a log that is faster.
//!
//! What repeats tells nothing new: the noise is that of the fresh readings, and only they are compared with a model. A
//! counter repeats as well, at rest or while it creeps on; but where a channel holds, nearly every reading stays for
//! the same number of samples while the signal goes on by now more and now fewer counts.

use super::lattice::resolution;
use super::tuning::{
    BINARY, COUNTED, IN_STEP, LEAST_READINGS, LONGER, REPEATED, SIZES_OF_COUNTS, USUAL,
};
use crate::order::distinct;

/// The samples with fresh readings, of a channel that holds them.
pub(in crate::criticism) fn fresh(values: &[f64]) -> Option<Vec<usize>> {
    let mut begins: Vec<usize> = (1..values.len())
        .filter(|i| values[*i] != values[i - 1])
        .collect();
    if begins.len() < LEAST_READINGS {
        return None;
    }
    let mut stays: Vec<usize> = begins.windows(2).map(|w| w[1] - w[0]).collect();
    let count = stays.len();
    let median = *stays.select_nth_unstable(count / 2).1;
    let readings: Vec<f64> = begins.iter().map(|i| values[*i]).collect();
    if median < 2 {
        return (is_fine(&readings) && repeats_by_chance(&stays)).then(|| {
            begins.insert(0, 0);
            begins
        });
    }
    let every = in_step(&stays, median);
    stays.retain(|stay| *stay > 1 && stay.abs_diff(median) <= 1);
    let usual = stays.len() as f64 >= USUAL * count as f64;
    // A counter that creeps goes on by one count at a time.
    let moves = moves_of(&readings);
    let creeps = every.is_none() || !skips_counts(&moves);
    if usual && creeps && goes_by_counts(&readings, &moves) {
        return None;
    }
    // One that stays longer came again as it was.
    let period = match every {
        Some(every) => every as f64,
        None if usual => stays.iter().sum::<usize>() as f64 / stays.len() as f64,
        None => return None,
    };
    let again = |times: usize| (0..times).map(move |k| (k as f64 * period).round() as usize);
    let first = begins[0];
    let before = (first as f64 / period) as usize + 1;
    let mut fresh: Vec<usize> = again(before)
        .skip(1)
        .filter_map(|back| first.checked_sub(back))
        .collect();
    fresh.reverse();
    begins.push(values.len());
    for stay in begins.windows(2) {
        let times = ((stay[1] - stay[0]) as f64 / period).round().max(1.0);
        fresh.extend(again(times as usize).map(|k| stay[0] + k));
    }
    fresh.retain(|i| *i < values.len());
    Some(fresh)
}

/// Whether hardly any reading comes again: what repeats is the same reading, and not another one of the same size.
fn is_fine(readings: &[f64]) -> bool {
    let other = distinct(readings.to_vec()).len();
    other as f64 > IN_STEP * readings.len() as f64
}

/// Whether readings stay for a sample more now and then, as often and as long as chance has it: a logger missed the
/// next one. What is at rest stays longer.
fn repeats_by_chance(stays: &[usize]) -> bool {
    let all: usize = stays.iter().sum();
    let share = 1.0 - stays.len() as f64 / all as f64;
    let longest = stays.iter().copied().max().unwrap_or(0) as f64;
    let usual = 1.0 - libm::log(stays.len() as f64) / libm::log(share);
    share > REPEATED && longest < LONGER * usual
}

/// For how many samples each reading is held, where nearly all stay for a multiple of that: the longest such time, up
/// to `most`.
fn in_step(stays: &[usize], most: usize) -> Option<usize> {
    let share = |every: usize| {
        let whole = stays.iter().filter(|stay| **stay % every == 0);
        whole.count() as f64 / stays.len() as f64
    };
    (2..=most).rev().find(|every| share(*every) >= IN_STEP)
}

/// The sizes of the moves from one reading to the next, the least first.
fn moves_of(readings: &[f64]) -> Vec<f64> {
    let mut moves: Vec<f64> = readings.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    moves.sort_by(f64::total_cmp);
    moves
}

/// Whether some moves from one reading to the next are of more than one count.
fn skips_counts(moves: &[f64]) -> bool {
    let of_one = moves.partition_point(|m| *m < 1.5 * moves[0]);
    (moves.len() - of_one) as f64 > (1.0 - IN_STEP) * moves.len() as f64
}

/// Whether most moves from one reading to the next are of a few sizes only.
fn goes_by_counts(readings: &[f64], moves: &[f64]) -> bool {
    let most = readings.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let same = (0.5 * resolution(readings)).max(BINARY * most);
    let sizes = moves.chunk_by(|a, b| b - a < same);
    let mut counts: Vec<usize> = sizes.map(<[f64]>::len).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    let usual: usize = counts.iter().take(SIZES_OF_COUNTS).sum();
    usual as f64 >= COUNTED * moves.len() as f64
}

/// Values for every time, on straight lines between the `readings` at these samples, of which there must be one.
pub(in crate::criticism) fn bridged(readings: &[f64], samples: &[usize], time: &[f64]) -> Vec<f64> {
    let last = readings.len() - 1;
    let value = |i: usize| {
        let next = samples.partition_point(|s| *s <= i);
        if next == 0 || next > last {
            return readings[next.min(last)];
        }
        let (from, to) = (time[samples[next - 1]], time[samples[next]]);
        let share = (time[i] - from) / (to - from);
        readings[next - 1] + share * (readings[next] - readings[next - 1])
    };
    (0..time.len()).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::criticism::noise_level;
    use crate::rig::Random;

    /// A turning body whose angle, with noise of 0.01, comes once in so many samples, after a rest.
    fn held(every: &dyn Fn(usize) -> bool, step: f64) -> Vec<f64> {
        let mut random = Random::new(5);
        let mut last = 0.0;
        (0..4000)
            .map(|i| {
                if every(i) && i > 300 {
                    let noise: f64 = (0..12).map(|_| random.between(-0.5, 0.5)).sum();
                    let angle = 40.0 * (1.0 - libm::cos(2e-3 * i as f64)) + 0.01 * noise;
                    last = (angle / step).round() * step;
                }
                last
            })
            .collect()
    }

    #[test]
    fn noise_of_a_channel_that_holds_is_that_of_its_fresh_readings() {
        let values = held(&|i| i % 4 == 1, 1e-6);
        let found = fresh(&values).unwrap();
        assert!(found.iter().all(|i| i % 4 == 1), "{found:?}");
        assert_eq!(found.len(), 1000);
        let level = noise_level(&values, &vec![1.0; 4000]);
        assert!((level / 0.01 - 1.0).abs() < 0.15, "{level}");
    }

    #[test]
    fn a_body_at_a_steady_speed_does_not_creep_where_its_angle_is_told_finely() {
        let mut values = held(&|i| i % 4 == 1, 1e-6);
        for (i, value) in values.iter_mut().enumerate() {
            *value = ((*value + i.div_ceil(4) as f64) * 2048.0).round() / 2048.0;
        }
        assert!(fresh(&values).is_some());
    }

    #[test]
    fn a_log_with_a_clock_of_its_own_holds_now_and_then_one_sample_more() {
        let values = held(&|i| (i * 10) % 43 < 10, 1e-6);
        let count = fresh(&values).unwrap().len();
        assert!(count.abs_diff(4000 * 10 / 43) < 12, "{count}");
        let level = noise_level(&values, &vec![1.0; 4000]);
        assert!((level / 0.01 - 1.0).abs() < 0.3, "{level}");
    }

    #[test]
    fn a_coarse_sensor_that_is_logged_twice_holds_though_it_goes_by_counts() {
        let mut random = Random::new(3);
        let reading = |i: usize| 20.0 + 30.0 * (1.0 - libm::exp(-(i as f64) / 60.0));
        let values: Vec<f64> = (0..200)
            .map(|i| reading(i) + 0.2 * random.normal())
            .map(|v| (4.0 * v).round() / 4.0)
            .flat_map(|v| [v, v])
            .collect();
        assert_eq!(fresh(&values).map(|f| f.len()), Some(200));
        let level = noise_level(&values, &[1.0; 400]);
        assert!((level / 0.21 - 1.0).abs() < 0.25, "{level}");
    }

    #[test]
    fn a_coarse_sensor_that_a_faster_log_holds_in_step_does_so_though_it_goes_by_counts() {
        let mut random = Random::new(8);
        let reading = |i: usize| 45.0 + 3.0 * libm::sin(0.02 * i as f64);
        for hold in [2, 5] {
            let values: Vec<f64> = (0..300)
                .map(|i| reading(i) + 0.05 * random.normal())
                .map(|v| (10.0 * v).round() / 10.0)
                .flat_map(|v| vec![v; hold])
                .collect();
            assert_eq!(fresh(&values).map(|f| f.len()), Some(300), "{hold}");
        }
    }

    #[test]
    fn readings_that_a_logger_missed_are_not_fresh() {
        for share in [0.05, 0.3, 0.5] {
            let mut random = Random::new(9);
            let mut stale = 0;
            let mut values = vec![0.0];
            for i in 1..3000 {
                let next = libm::sin(0.01 * f64::from(i)) + 0.01 * random.normal();
                let missed = random.uniform() < share;
                stale += usize::from(missed);
                values.push(if missed {
                    values[values.len() - 1]
                } else {
                    next
                });
            }
            assert_eq!(fresh(&values).map(|f| f.len()), Some(3000 - stale));
        }
        // A body that rests now and then repeats as well.
        let resting: Vec<f64> = (0..3000)
            .map(|i| (libm::sin(0.01 * f64::from(i)) - 0.5).max(0.0))
            .collect();
        assert_eq!(fresh(&resting), None);
    }

    #[test]
    fn a_counter_that_creeps_or_rests_does_not_hold() {
        let count = |motion: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..4000)
                .map(|i| (motion(f64::from(i)) / 1e-3).round() * 1e-3)
                .collect()
        };
        assert_eq!(fresh(&count(&|i| 2.5e-4 * i)), None);
        assert_eq!(fresh(&count(&|i| 0.3 * libm::sin(4e-4 * i))), None);
        // Slips of many counts between rests.
        assert_eq!(fresh(&count(&|i| (i / 50.0 - 0.8).max(0.0).floor())), None);
        assert_eq!(fresh(&held(&|i| !(1000..=1500).contains(&i), 1e-6)), None);
    }

    #[test]
    fn between_fresh_readings_are_straight_lines() {
        let time = [0.0, 1.0, 2.0, 3.0, 5.0, 6.0];
        let values = bridged(&[1.0, 5.0], &[1, 4], &time);
        assert_eq!(values, [1.0, 1.0, 2.0, 3.0, 5.0, 5.0]);
    }
}
