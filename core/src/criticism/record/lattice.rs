//! The lattice of a channel: the step of which its values are whole multiples, beside an offset.
//!
//! A converter or a counter has a step; what it says is scaled and printed, so that it is rounded once more, or jitters
//! about the lattice by some units of the last digit where it was computed from two numbers. Values that jitter about
//! one point of the lattice are far nearer to each other than two points are: the gaps between sorted values are of two
//! sizes. The step itself is the length of which the gaps between points are multiples (a quantum: Kendall 1974,
//! Hunting quanta).

use super::tuning::{
    ARITHMETIC, BEHIND_PRINT, FAR_APART, FEW_STEPS, JITTERS, MANY_STEPS, MOST_COUNTS, MOST_DIGITS,
    MOST_UNITS, NEAR_PRINT, NEAR_SHARE, PRINTED, QUANTUM_SAMPLES, WHOLE, WHOLE_SHARE,
};

/// Unit of the last digit to which the values were printed; 0 where they are no decimal numbers.
pub(in crate::criticism) fn resolution(values: &[f64]) -> f64 {
    let most = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut units = 1.0;
    for _ in 0..=MOST_DIGITS {
        if most * units > MOST_UNITS {
            break;
        }
        let is_whole = |v: &f64| (v * units - (v * units).round()).abs() < PRINTED;
        if values.iter().all(is_whole) {
            return 1.0 / units;
        }
        units *= 10.0;
    }
    0.0
}

/// Step of a quantised channel; 0 where none is seen.
pub(in crate::criticism) fn lattice(values: &[f64]) -> f64 {
    let stride = values.len().div_ceil(QUANTUM_SAMPLES).max(1);
    let mut sorted: Vec<f64> = values.iter().step_by(stride).copied().collect();
    sorted.sort_by(f64::total_cmp);
    let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    sorted.dedup_by(|next, kept| *next - *kept <= ARITHMETIC * largest);
    let printed = resolution(values);
    let behind_jitter = points_behind_jitter(&sorted);
    let behind_jitter = behind_jitter.map_or(0.0, |(points, jitter)| {
        step_of(&points, printed.max(jitter))
    });
    if behind_jitter > 0.0 {
        behind_jitter
    } else {
        step_of(&sorted, printed)
    }
}

/// The points about which ascending values jitter, and how far; `None` where they do not.
fn points_behind_jitter(ascending: &[f64]) -> Option<(Vec<f64>, f64)> {
    let mut gaps: Vec<f64> = ascending.windows(2).map(|w| w[1] - w[0]).collect();
    gaps.sort_by(f64::total_cmp);
    let ratio = |k: usize| gaps[k] / gaps[k - 1];
    let apart = (1..gaps.len()).max_by(|a, b| ratio(*a).total_cmp(&ratio(*b)))?;
    if ratio(apart) < FAR_APART || (apart as f64) < NEAR_SHARE * gaps.len() as f64 {
        return None;
    }
    let near = (gaps[apart - 1] * gaps[apart]).sqrt();
    let rows: Vec<&[f64]> = ascending.chunk_by(|a, b| b - a < near).collect();
    let width = |row: &&[f64]| row[row.len() - 1] - row[0];
    let widest = rows.iter().map(width).fold(0.0, f64::max);
    let points = || {
        rows.iter()
            .map(|row| row.iter().sum::<f64>() / row.len() as f64)
    };
    (JITTERS * widest < gaps[apart]).then(|| (points().collect(), widest))
}

/// The step of ascending points of which each may be off by half of `rounding`; 0 where there is none.
fn step_of(ascending: &[f64], rounding: f64) -> f64 {
    let mut steps: Vec<f64> = ascending.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let Some(least) = steps.first() else {
        return 0.0;
    };
    // The printed values are rounded, so the median of the single steps is better than the least.
    let single = steps.partition_point(|d| *d < 1.5 * least);
    let least = steps[single / 2];
    // Either end of a step was rounded where it was printed.
    let rounded = |step: f64| {
        let enough = if step > BEHIND_PRINT * rounding {
            FEW_STEPS
        } else {
            MANY_STEPS
        };
        if steps.len() >= enough && step > NEAR_PRINT * rounding {
            rounding / step
        } else {
            0.0
        }
    };
    // What runs on fast may never stop on two neighbouring counts.
    let mut parts = (1..=MOST_COUNTS).map(|n| {
        let rough = least / f64::from(n);
        refined(&steps, rough, rounded(rough))
    });
    let step = parts.find(|step| is_whole(&steps, *step, rounded(*step)));
    step.unwrap_or(0.0)
}

/// The step of which these ascending ones are whole multiples, from a rough value: the longer ones, whose number of
/// steps follows from the shorter ones, tell it to more digits than print rounding leaves of one.
fn refined(ascending: &[f64], rough: f64, rounded: f64) -> f64 {
    let (mut product, mut square, mut step) = (0.0, 0.0, rough);
    for length in ascending {
        let count = (length / step).round();
        if count > 0.0 && (length / step - count).abs() < WHOLE + rounded {
            product += length * count;
            square += count * count;
            step = product / square;
        }
    }
    step
}

/// Whether nearly all of these steps are whole multiples of one, but for a share of it by which they are rounded.
fn is_whole(steps: &[f64], step: f64, rounded: f64) -> bool {
    let whole = steps.iter().filter(|d| {
        let ratio = *d / step;
        (ratio - ratio.round()).abs() < WHOLE * (0.2 * ratio).clamp(0.2, 1.0) + rounded
    });
    whole.count() as f64 > WHOLE_SHARE * steps.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_is_found_where_no_two_neighbouring_counts_were_seen() {
        let step = 2.0 * std::f64::consts::PI / f64::from(1 << 20);
        for (stride, least) in [(293.0, 2.0), (299.5, 3.0), (1201.0, 5.0)] {
            // Coasting, but for a turn that passes a few counts twice.
            let mut values: Vec<f64> = (0..3000)
                .map(|i| (stride * f64::from(i)).round() * step)
                .collect();
            let last = values[2999];
            values.push(last + least * step);
            values.extend((1..900).map(|i| last + 5e3 * step * f64::from(i)));
            let found = lattice(&values);
            assert!((found / step - 1.0).abs() < 1e-9, "{stride}: {found}");
        }
        let smooth: Vec<f64> = (0..3000).map(|i| libm::sin(f64::from(i) * 0.7)).collect();
        assert_eq!(lattice(&smooth), 0.0);
    }

    #[test]
    fn the_step_is_found_where_hardly_two_samples_are_near_each_other() {
        // A body at 20 rad/s, encoder of 2^20 counts, nine digits printed: neighbours are hundreds of counts apart.
        let step = std::f64::consts::TAU / f64::from(1 << 20);
        let printed = |x: f64| (x * 1e8).round() * 1e-8;
        let values: Vec<f64> = (0..4000)
            .map(|i| 8.0 * libm::sin(1e-3 * f64::from(i)) + 1e-3 * f64::from(i * i % 977))
            .map(|x| printed((x / step).round() * step))
            .collect();
        let found = lattice(&values);
        assert!((found / step - 1.0).abs() < 1e-4, "{found}");
    }

    #[test]
    fn a_step_is_found_behind_values_that_jitter_in_the_last_digit() {
        // Counts over a sampling time that is no round number, printed with five digits.
        let step = 0.013_19;
        let values: Vec<f64> = (0..3000)
            .map(|i| (30.0 * libm::sin(0.01 * f64::from(i))).round() * step)
            .enumerate()
            .map(|(i, v)| ((v * 1e5).round() + (i % 3) as f64 - 1.0) * 1e-5)
            .collect();
        let found = lattice(&values);
        assert!((found / step - 1.0).abs() < 1e-2, "{found}");
        // The mean of two sensors of 1/16 degree, each printed with three decimals.
        let sensor = |i: i32| (f64::from(i) / 16.0 * 1e3).round() * 1e-3;
        let values: Vec<f64> = (0..900)
            .map(|i| 160 + (40.0 * libm::sin(0.02 * f64::from(i))) as i32)
            .enumerate()
            .map(|(i, k)| 0.5 * (sensor(k) + sensor(k + i32::try_from(i * i % 3).unwrap_or(0))))
            .collect();
        let found = lattice(&values);
        assert!((found * 32.0 - 1.0).abs() < 1e-2, "{found}");
    }
}
