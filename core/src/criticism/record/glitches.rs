//! Single values that stand alone, far off what their neighbours agree on: a sensor's, not the machine's.
//!
//! No body goes away from its path and back within two samples while the samples before and after show nothing of it. A
//! value that differs from the cubic through its neighbours by many times the noise, where these fit their own
//! neighbours without it, is put there (the idea of Hampel's filter: Hampel 1974, The influence curve).
//!
//! Two or three in a row may be an impact. They are a sensor's where they go far beyond all that the record shows
//! elsewhere, at once, while what is before and after them each runs on evenly, and nothing else in the record comes
//! and goes as quickly: as the first speeds that are counted over a time in which the machine stood. Nothing is known
//! there.

use super::tuning::{
    AGREE, AT_NEIGHBOUR, AT_VALUE, BEYOND, CUBIC, FAR_OFF, FEW, LONGEST, MOST_ROWS,
    SECOND_DIFFERENCE, SHARE,
};

/// What was found among the values of a channel.
#[derive(Debug, Default, PartialEq, Eq)]
pub(in crate::criticism) struct Glitches {
    /// Samples that were put where their neighbours say.
    pub mended: Vec<usize>,
    /// Samples at which nothing is known.
    pub lost: Vec<usize>,
}

/// Puts the glitches among `values` where their neighbours say, and tells where they were; none where they are many.
pub(in crate::criticism) fn mend(values: &mut [f64], noise: f64) -> Glitches {
    let found: Vec<(usize, f64)> = (3..values.len().saturating_sub(3))
        .filter_map(|i| Some(i).zip(expected(values, i, noise)))
        .collect();
    if found.len() as f64 > FEW * values.len() as f64 {
        return Glitches::default();
    }
    for (i, value) in &found {
        values[*i] = *value;
    }
    let mut lost = beyond(values, noise, 1.0);
    lost.extend(beyond(values, noise, -1.0));
    lost.sort_unstable();
    for row in lost.chunk_by(|a, b| a + 1 == *b) {
        let (before, after) = (row[0] - 1, row[row.len() - 1] + 1);
        let slope = (values[after] - values[before]) / (after - before) as f64;
        for i in row {
            values[*i] = values[before] + slope * (i - before) as f64;
        }
    }
    Glitches {
        mended: found.into_iter().map(|(i, _)| i).collect(),
        lost,
    }
}

/// The values that are above (below, for a `side` of -1) all others by far, where they are glitches.
fn beyond(values: &[f64], noise: f64, side: f64) -> Vec<usize> {
    let most = ((FEW * values.len() as f64) as usize).min(LONGEST * MOST_ROWS);
    if most == 0 {
        return Vec::new();
    }
    let highest_first = |a: &usize, b: &usize| (side * values[*b]).total_cmp(&(side * values[*a]));
    let mut order: Vec<usize> = (0..values.len()).collect();
    // Only so many may be glitches: of the others the highest and the lowest are needed.
    let (_, _, others) = order.select_nth_unstable_by(most, highest_first);
    let lowest = others.iter().map(|i| side * values[*i]);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    order.truncate(most + 1);
    order.sort_by(highest_first);
    // The gap between them and the others.
    let gap = (1..=most).find(|count| {
        let (above, highest) = (
            side * values[order[count - 1]],
            side * values[order[*count]],
        );
        above - highest > (FAR_OFF * noise).max(BEYOND * (highest - lowest))
    });
    let mut far: Vec<usize> = order[..gap.unwrap_or(0)].to_vec();
    far.sort_unstable();
    let rows: Vec<&[usize]> = far.chunk_by(|a, b| a + 1 == *b).collect();
    let are_glitches = rows.len() <= MOST_ROWS
        && rows.iter().all(|row| stands_alone(values, row, noise))
        && !has_pulses(values, &far, noise);
    if are_glitches { far } else { Vec::new() }
}

/// Whether values also come and go within as few samples where they are not these.
fn has_pulses(values: &[f64], but: &[usize], noise: f64) -> bool {
    let is_pulse = |window: &[f64]| {
        let rise = (window[1] - window[0]).abs();
        let back = |v: &f64| (v - window[0]).abs() < 0.5 * rise;
        rise > FAR_OFF * noise && window[2..].iter().any(back)
    };
    let near = |i: usize| but.iter().any(|b| (i..i + LONGEST + 2).contains(b));
    let mut windows = values.windows(LONGEST + 2).enumerate();
    windows.any(|(i, window)| is_pulse(window) && !near(i))
}

/// Whether what is before and what is after these neighbouring values each runs on evenly.
fn stands_alone(values: &[f64], row: &[usize], noise: f64) -> bool {
    let (first, last) = (row[0], row[row.len() - 1]);
    if row.len() > LONGEST || first < 3 || last + 3 >= values.len() {
        return false;
    }
    let off = (values[first] - values[first - 1])
        .abs()
        .min((values[last] - values[last + 1]).abs());
    // What goes on as it came, or comes as it goes on, is the peak of a motion.
    let side = (values[first] - values[first - 1]).signum();
    let before = side * off_the_line(values, first, [first - 1, first - 2]);
    let after = side * off_the_line(values, last, [last + 1, last + 2]);
    if before.min(after) <= FAR_OFF * noise {
        return false;
    }
    let even = (AGREE * SECOND_DIFFERENCE * noise).min(SHARE * off);
    let bend = |i: usize| (values[i - 1] - 2.0 * values[i] + values[i + 1]).abs();
    bend(first - 2) < even && bend(last + 2) < even
}

/// How far a value is off the line through two others, of which one is its neighbour.
fn off_the_line(values: &[f64], i: usize, [near, far]: [usize; 2]) -> f64 {
    values[i] - 2.0 * values[near] + values[far]
}

/// What the neighbours say of a value that is a glitch.
fn expected(values: &[f64], i: usize, noise: f64) -> Option<f64> {
    let sum = |weights: [f64; 4], places: [usize; 4]| -> f64 {
        let terms = weights.iter().zip(places);
        terms.map(|(w, k)| w * values[k]).sum()
    };
    let said = sum(AT_VALUE, [i - 2, i - 1, i + 1, i + 2]);
    let (off, side) = ((values[i] - said).abs(), (values[i] - said).signum());
    // A kink is off the cubic through both of its sides, and lies on the line of either.
    let before = side * off_the_line(values, i, [i - 1, i - 2]);
    let after = side * off_the_line(values, i, [i + 1, i + 2]);
    let least = before.min(after);
    if off < FAR_OFF * CUBIC * noise || least < 0.5 * off {
        return None;
    }
    let agree = (AGREE * CUBIC * noise).min(SHARE * off);
    let before = values[i - 1] - sum(AT_NEIGHBOUR, [i - 3, i - 2, i + 1, i + 2]);
    let after = values[i + 1] - sum(AT_NEIGHBOUR, [i + 3, i + 2, i - 1, i - 2]);
    (before.abs() < agree && after.abs() < agree).then_some(said)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Random;

    fn noisy(signal: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut random = Random::new(11);
        let mut normal = || (0..12).map(|_| random.between(-0.5, 0.5)).sum::<f64>();
        (0..3000).map(|i| signal(f64::from(i)) + normal()).collect()
    }

    #[test]
    fn single_values_far_off_are_put_back() {
        let swing = |i: f64| 400.0 * libm::sin(0.02 * i);
        let truth = noisy(swing);
        let mut values = truth.clone();
        for (place, off) in [(500, 30.0), (1501, -16.0), (2222, 200.0)] {
            values[place] += off;
        }
        assert_eq!(mend(&mut values, 1.0).mended, [500, 1501, 2222]);
        for i in 0..3000 {
            assert!((values[i] - truth[i]).abs() < 6.0, "{i}");
        }
    }

    #[test]
    fn peaks_steps_and_kinks_of_a_motion_stay() {
        let motions: [fn(f64) -> f64; 4] = [
            |i| 500.0 * (i / 40.0 % 2.0 - 1.0).abs(),
            |i| 100.0 * f64::from(u8::from(i > 1000.0)),
            |i| 90.0 * libm::sin(0.9 * i),
            |i| 300.0 * libm::exp(-(i % 100.0) / 1.5),
        ];
        for (k, motion) in motions.iter().enumerate() {
            let found = mend(&mut noisy(motion), 1.0);
            assert_eq!(found, Glitches::default(), "motion {k}");
        }
    }

    #[test]
    fn the_highest_peak_of_a_thermostat_is_none() {
        // Up by 28 a sample, down by 8, from a sample or from within two.
        for within in [0.0, 0.37] {
            let peak = |i: f64| {
                let (cycle, since) = ((i / 45.0).floor(), i % 45.0);
                let top = 10.0 + (cycle * within) % 1.0;
                28.0 * since.min(top) - 8.0 * (since - top).max(0.0)
            };
            assert_eq!(mend(&mut noisy(peak), 1.0), Glitches::default(), "{within}");
        }
    }

    #[test]
    fn two_values_beyond_all_others_are_lost_though_a_motion_begins_there() {
        let start = |i: f64| 100.0 * (1.0 - libm::exp(-(i - 1000.0).max(0.0) / 40.0));
        let mut values = noisy(start);
        values[1000] = 150.0;
        values[1001] = 157.0;
        let found = mend(&mut values, 1.0);
        assert!(found.mended.is_empty());
        assert_eq!(found.lost, [1000, 1001]);
        assert!(values[1000] < 20.0 && values[1001] < 20.0);
    }

    #[test]
    fn overshoots_impacts_and_rows_that_come_again_stay() {
        let ringing = |i: f64, period: f64| {
            let t = (i - 1000.0).max(0.0);
            100.0 - 100.0 * libm::exp(-t / 8.0) * libm::cos(t * std::f64::consts::TAU / period)
        };
        let blow = |i: f64, decay: f64| {
            f64::from(u8::from(i >= 1000.0)) * 300.0 * libm::exp((1000.0 - i).min(0.0) / decay)
        };
        let slips = |i: f64| {
            let size = if i > 2000.0 { 250.0 } else { 150.0 };
            size * f64::from(u8::from(i % 500.0 < 2.0))
        };
        let motions: [&dyn Fn(f64) -> f64; 7] = [
            &slips,
            &|i| ringing(i, 4.0),
            &|i| ringing(i, 6.0),
            &|i| ringing(i, 12.0),
            &|i| blow(i, 1.0),
            &|i| blow(i, 2.5),
            &|i| 100.0 * f64::from(u8::from(i % 500.0 < 2.0)),
        ];
        for (k, motion) in motions.iter().enumerate() {
            let lost = mend(&mut noisy(motion), 1.0).lost;
            assert!(lost.is_empty(), "motion {k}: {lost:?}");
        }
    }
}
