//! How large is the measurement noise? Estimated from the data alone, without a model.
//!
//! Differences of order p of a smooth signal vanish and leave `sqrt(binomial(2p, p))` times the
//! noise. A switching input makes kinks, always at the same times after the switch: differences
//! are therefore grouped by the number of samples since the input changed, and the quiet groups
//! decide. Within a group a low quantile keeps what kinks remain from counting. Of a channel that holds its readings only
//! the fresh ones tell.

use super::held::fresh;
use crate::order::quantile;

/// Orders of difference that are tried.
const ORDERS: [usize; 4] = [2, 3, 4, 5];

/// Groups by samples since the last change of the input; later samples share the last group.
const GROUPS: usize = 24;

/// Fewest differences from which a group may speak.
const MIN_GROUP: usize = 60;

/// Quantile of the absolute differences that is read off: low, so that kinks do not count.
const QUANTILE: f64 = 0.3;

/// The same quantile of the absolute value of a standard normal variable.
const NORMAL_QUANTILE: f64 = 0.385_320_466_407_567_6;

/// Share of the differences that lies in quieter groups than the one that decides.
const QUIET: f64 = 0.4;

/// Three standard errors of a level that is read off one difference, relative to it; of many, this over the root of their
/// number.
const CHANCE: f64 = 4.8;

/// Excess of the variance over that of quantisation up to which it is quantisation alone.
const QUANTISED: f64 = 1.25;

/// Values that are looked at to find the step of a quantised channel.
const QUANTUM_SAMPLES: usize = 4000;

/// Most counts that the least step between two values may be.
const MOST_COUNTS: u32 = 16;

/// Distance from a whole number of counts up to which many counts are whole.
const WHOLE: f64 = 0.1;

/// Digits after the point up to which values are looked at as printed ones, the most units of the last digit that they
/// may be, and how far they may be from whole ones: that of binary numbers.
const MOST_DIGITS: usize = 12;
const MOST_UNITS: f64 = 1e9;
const PRINTED: f64 = 1e-6;

/// A count is that of a sensor behind the print where it is this many units of the last digit, seen in so many steps.
const BEHIND_PRINT: f64 = 8.0;
const STEPS_BEHIND_PRINT: usize = 5;

/// Standard deviation of the noise in `values`, in their unit; above 0 unless all are equal.
///
/// `input` is as long and tells when the signal may have kinks.
pub fn noise_level(values: &[f64], input: &[f64]) -> f64 {
    noise(values, input).level
}

/// The noise of a channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// Standard deviation.
    pub level: f64,
    /// It is that of counting alone: nothing is seen of what stays within half a step, and a body that rests
    /// or creeps leaves an error that is no random one.
    pub counted: bool,
}

pub(super) fn noise(values: &[f64], input: &[f64]) -> Noise {
    let Some(mut fresh) = fresh(values) else {
        let places: Vec<usize> = (0..values.len()).collect();
        return noise_at(&places, values, input);
    };
    // At rest even a fresh reading may be the same again.
    fresh.dedup_by_key(|i| values[*i].to_bits());
    let at = |all: &[f64]| -> Vec<f64> { fresh.iter().map(|i| all[*i]).collect() };
    noise_at(&fresh, &at(values), &at(input))
}

/// The same without the samples that are marked; none is where there are no marks.
pub(super) fn noise_beside(values: &[f64], input: &[f64], marked: &[bool]) -> Noise {
    if marked.is_empty() {
        return noise(values, input);
    }
    let places: Vec<usize> = (0..values.len()).filter(|i| !marked[*i]).collect();
    let at = |all: &[f64]| -> Vec<f64> { places.iter().map(|i| all[*i]).collect() };
    noise_at(&places, &at(values), &at(input))
}

/// The same of values at these samples.
fn noise_at(places: &[usize], values: &[f64], input: &[f64]) -> Noise {
    let quantum = quantum(values);
    // A quantised signal is dithered by one step, evenly spread, so that quantiles are smooth.
    let dithered: Vec<f64> = values
        .iter()
        .enumerate()
        .map(|(i, v)| v + quantum * (dither(i) - 0.5))
        .collect();
    let uniform = quantum * quantum / 12.0;
    let groups = since_change(input);
    let smallest = least_level(places, &dithered, &groups);
    // Quantisation and dither alone, within what the estimate can tell.
    if quantum > 0.0 && smallest * smallest < QUANTISED * 2.0 * uniform {
        return Noise {
            level: uniform.sqrt(),
            counted: true,
        };
    }
    let variance = if smallest.is_finite() {
        smallest * smallest - uniform
    } else {
        0.0
    };
    let rounding = values.iter().fold(0.0_f64, |m, v| m.max(v.abs())) * 1e-9;
    let printed = resolution(values);
    Noise {
        level: variance
            .max(uniform)
            .max(printed * printed / 12.0)
            .max(rounding * rounding)
            .sqrt(),
        counted: false,
    }
}

/// Unit of the last digit to which the values were printed; 0 where they are no decimal numbers.
pub(super) fn resolution(values: &[f64]) -> f64 {
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
fn quantum(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().take(QUANTUM_SAMPLES).copied().collect();
    sorted.sort_by(f64::total_cmp);
    let mut steps: Vec<f64> = sorted
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|d| *d > 0.0)
        .collect();
    steps.sort_by(f64::total_cmp);
    let Some(least) = steps.first() else {
        return 0.0;
    };
    // The printed values are rounded, so the median of the single steps is better than the least.
    let single = steps.partition_point(|d| *d < 1.5 * least);
    let least = steps[single / 2];
    // What runs on fast may never stop on two neighbouring counts.
    let mut parts = (1..=MOST_COUNTS).map(|n| refined(&steps, least / f64::from(n)));
    // Either end of a step was rounded where it was printed.
    let printed = resolution(values);
    let seen = steps.len() >= STEPS_BEHIND_PRINT;
    let rounded = |step: f64| {
        if seen && step > BEHIND_PRINT * printed {
            printed / step
        } else {
            0.0
        }
    };
    let step = parts.find(|step| is_whole(&steps, *step, rounded(*step)));
    step.unwrap_or(0.0)
}

/// The step of which these ascending ones are whole multiples, from a rough value: the longer ones, whose number of steps
/// follows from the shorter ones, tell it to more digits than print rounding leaves of one.
fn refined(ascending: &[f64], rough: f64) -> f64 {
    let (mut product, mut square, mut step) = (0.0, 0.0, rough);
    for length in ascending {
        let count = (length / step).round();
        if (length / step - count).abs() < WHOLE {
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
    whole.count() as f64 > 0.95 * steps.len() as f64
}

/// Evenly spread over 0 to 1 and without pattern, the same on every machine (finaliser of `SplitMix64`).
fn dither(i: usize) -> f64 {
    let mut z = (i as u64)
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// For each sample the number of samples since the input changed, at most `GROUPS - 1`.
fn since_change(input: &[f64]) -> Vec<usize> {
    let mut count = GROUPS - 1;
    input
        .iter()
        .enumerate()
        .map(|(i, u)| {
            count = if i > 0 && *u != input[i - 1] {
                0
            } else {
                (count + 1).min(GROUPS - 1)
            };
            count
        })
        .collect()
}

/// The noise that the differences of that order show which cancel the signal best; of all that could be as good, the
/// mean.
fn least_level(places: &[usize], values: &[f64], groups: &[usize]) -> f64 {
    let levels = ORDERS.iter();
    let levels: Vec<_> = levels
        .filter_map(|order| level_at_order(places, values, groups, *order))
        .collect();
    let of = |(level, count): &(f64, usize)| level * (1.0 + chance(*count));
    let most = levels.iter().map(of).fold(f64::INFINITY, f64::min);
    let good = || levels.iter().filter(|(level, _)| *level <= most);
    let sum: f64 = good().map(|(level, _)| level).sum();
    match good().count() {
        0 => f64::INFINITY,
        count => sum / count as f64,
    }
}

/// The noise that the differences of this order show, and the number of those that tell.
fn level_at_order(
    places: &[usize],
    values: &[f64],
    groups: &[usize],
    order: usize,
) -> Option<(f64, usize)> {
    let signs = binomials(order);
    let gain = signs.iter().map(|c| c * c).sum::<f64>().sqrt();
    let mut by_group: Vec<Vec<f64>> = vec![Vec::new(); GROUPS];
    let even = evenly_spaced(places, order);
    for (i, window) in values.windows(order + 1).enumerate().filter(|w| even[w.0]) {
        let difference: f64 = window.iter().zip(&signs).map(|(v, c)| v * c).sum();
        by_group[groups[i + order]].push(difference.abs() / gain);
    }
    let mut levels: Vec<(f64, usize)> = by_group
        .iter_mut()
        .filter(|g| g.len() >= MIN_GROUP)
        .map(|g| (low_quantile(g), g.len()))
        .collect();
    if levels.is_empty() {
        let mut all: Vec<f64> = by_group.concat();
        return (!all.is_empty()).then(|| (low_quantile(&mut all), all.len()));
    }
    levels.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The upper levels may hold kinks. Those of small groups are too small by chance as often as too large.
    let total: usize = levels.iter().map(|(_, count)| count).sum();
    let mut below = 0;
    let (quiet, _) = levels.iter().find(|(_, count)| {
        below += count;
        below as f64 > QUIET * total as f64
    })?;
    // One group is known to a tenth at best: all that could be as quiet tell together.
    let as_quiet = |group: &mut Vec<f64>| {
        let count = group.len();
        count >= MIN_GROUP && low_quantile(group) <= (1.0 + chance(count)) * quiet
    };
    by_group.retain_mut(as_quiet);
    let mut pooled = by_group.concat();
    // None is as quiet as one that is no number.
    (!pooled.is_empty()).then(|| (low_quantile(&mut pooled), pooled.len()))
}

/// Whether the samples of each difference are evenly spaced: only then does a smooth signal vanish. All may speak where
/// too few are.
fn evenly_spaced(places: &[usize], order: usize) -> Vec<bool> {
    let is_even = |window: &[usize]| {
        let mut steps = window.windows(2).map(|w| w[1] - w[0]);
        steps.next().is_none_or(|first| steps.all(|s| s == first))
    };
    let even: Vec<bool> = places.windows(order + 1).map(is_even).collect();
    if even.iter().filter(|e| **e).count() < MIN_GROUP {
        return vec![true; even.len()];
    }
    even
}

/// Share by which the level of so many differences may be off by chance.
fn chance(count: usize) -> f64 {
    CHANCE / (count as f64).sqrt()
}

/// The noise that these absolute differences show; 0 without any.
fn low_quantile(differences: &mut [f64]) -> f64 {
    quantile(differences, QUANTILE) / NORMAL_QUANTILE
}

/// Signed binomial coefficients of the difference of this order.
fn binomials(order: usize) -> Vec<f64> {
    let mut row = vec![1.0];
    for _ in 0..order {
        let mut next = vec![1.0];
        next.extend(row.windows(2).map(|w| w[1] - w[0]));
        next.push(-row[row.len() - 1]);
        row = next;
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_no_numbers_show_no_noise() {
        let places: Vec<usize> = (0..100).collect();
        let level = |values: &[f64]| least_level(&places, values, &[0; 100]);
        assert!(!level(&[f64::NAN; 100]).is_finite());
        assert!(!level(&[f64::INFINITY; 100]).is_finite());
    }

    #[test]
    fn differences_have_binomial_weights() {
        assert_eq!(binomials(2), [1.0, -2.0, 1.0]);
        assert_eq!(binomials(3), [1.0, -3.0, 3.0, -1.0]);
    }

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
            let found = quantum(&values);
            assert!((found / step - 1.0).abs() < 1e-9, "{stride}: {found}");
        }
        let smooth: Vec<f64> = (0..3000).map(|i| libm::sin(f64::from(i) * 0.7)).collect();
        assert_eq!(quantum(&smooth), 0.0);
    }

    #[test]
    fn noise_is_known_where_a_controller_changes_the_input_now_and_then() {
        let random = |i: usize, of: usize| dither(i * 13 + of);
        for of in 0..8 {
            let mut input = vec![0.0];
            let mut values = Vec::new();
            for i in 0..10_000 {
                let last = input[i];
                input.push(if random(i, of) < 0.5 { i as f64 } else { last });
                let normal: f64 = (1..13).map(|k| random(i, of + 20_000 * k)).sum::<f64>() - 6.0;
                values.push(0.05 * normal + libm::sin(1e-3 * i as f64));
            }
            let level = noise_level(&values, &input[1..]);
            assert!((level / 0.05 - 1.0).abs() < 0.05, "{of}: {level}");
        }
    }

    #[test]
    fn of_a_short_record_that_switches_often_the_noise_is_as_often_too_large_as_too_small() {
        let records = 40;
        let input: Vec<f64> = (0..2000).map(|i| f64::from(i / 16 % 2)).collect();
        let level = |record: usize| {
            let normal = |i| {
                (1..13)
                    .map(|k| dither(i + 2000 * (13 * record + k)))
                    .sum::<f64>()
            };
            let values: Vec<f64> = (0..2000).map(|i| normal(i) - 6.0).collect();
            noise_level(&values, &input)
        };
        let mean = (0..records).map(level).sum::<f64>() / records as f64;
        assert!((mean - 1.0).abs() < 0.02, "{mean}");
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
        let found = quantum(&values);
        assert!((found / step - 1.0).abs() < 1e-4, "{found}");
    }

    #[test]
    fn a_count_that_is_no_round_number_is_found_behind_the_print() {
        // A converter's steps of 0.3223 degrees, printed with two digits: they are 0.32 and 0.33.
        let step = 0.3223;
        let values: Vec<f64> = (0..800)
            .map(|i| 40.0 * (1.0 - libm::exp(-f64::from(i) / 150.0)))
            .map(|x| 20.9 + (x / step).floor() * step)
            .map(|x| (x * 100.0).round() / 100.0)
            .collect();
        let found = quantum(&values);
        assert!((found / step - 1.0).abs() < 1e-3, "{found}");
        let noise = noise(&values, &vec![50.0; 800]);
        assert!(noise.counted);
        assert!((noise.level / (step / 12.0_f64.sqrt()) - 1.0).abs() < 0.1);
    }

    #[test]
    fn noise_is_never_less_than_what_print_rounds_off() {
        // A reading stays for a while, of no fixed length.
        let (mut values, mut hundredths) = (Vec::new(), 0);
        for k in 0..60_u32 {
            hundredths += 40 + 7 * k * k % 61;
            let stay = 3 + k * k % 11;
            values.extend((0..stay).map(|_| f64::from(hundredths) / 100.0));
        }
        assert!((resolution(&values) - 0.01).abs() < 1e-12);
        let level = noise_level(&values, &vec![0.0; values.len()]);
        assert!(level >= 0.01 / 12.0_f64.sqrt(), "{level}");
        let exact: Vec<f64> = (0..300).map(|i| libm::sin(f64::from(i))).collect();
        assert_eq!(resolution(&exact), 0.0);
    }

    #[test]
    fn quantisation_alone_leaves_its_step_over_root_twelve() {
        let step = 5.99e-6;
        let values: Vec<f64> = (0..5000)
            .map(|i| (0.01 * libm::sin(f64::from(i) * 0.0123) / step).round() * step)
            .collect();
        let noise = noise(&values, &vec![0.0; 5000]);
        assert!(noise.counted);
        assert!(
            (noise.level / (step / 12.0_f64.sqrt()) - 1.0).abs() < 0.1,
            "{}",
            noise.level
        );
    }
}
