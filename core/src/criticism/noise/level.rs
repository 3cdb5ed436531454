//! How large is the measurement noise? Estimated from the data alone, without a model.
//!
//! Differences of order p of a smooth signal vanish and leave `sqrt(binomial(2p, p))` times the noise. A switching
//! input makes kinks, always at the same times after the switch: differences are therefore grouped by the number of
//! samples since the input changed, and the quiet groups decide. Within a group a low quantile keeps what kinks remain
//! from counting. Of a channel that holds its readings only the fresh ones tell. Of a quantised channel the lattice
//! adds its own variance, however its values are printed.

use super::tuning::{
    CHANCE, GROUPS, MIN_GROUP, NORMAL_QUANTILE, ORDERS, QUANTILE, QUANTISED, QUIET, REPEATED,
    STATE_ORDER, STATES, UNLIKE,
};
use crate::criticism::record::{ARITHMETIC, fresh, lattice, resolution};
use crate::order::quantile;
use crate::random::dither;

/// Standard deviation of the noise in `values`, in their unit; above 0 unless all are equal.
///
/// `input` is as long and tells when the signal may have kinks.
pub fn noise_level(values: &[f64], input: &[f64]) -> f64 {
    noise(values, input).level
}

/// The noise of a channel.
#[derive(Clone, Copy, Debug)]
pub(in crate::criticism) struct Noise {
    /// Standard deviation.
    pub level: f64,
    /// It is that of counting alone: nothing is seen of what stays within half a step, and a body that rests
    /// or creeps leaves an error that is no random one.
    pub counted: bool,
    /// Step of the lattice on which the values lie; 0 where none is seen.
    pub step: f64,
}

pub(super) fn noise(values: &[f64], input: &[f64]) -> Noise {
    let Some(mut fresh) = fresh(values) else {
        let places: Vec<usize> = (0..values.len()).collect();
        return noise_at(&places, values, input);
    };
    // At rest even a fresh reading may be the same again; where most are, they count steps and go on so.
    let mut single = fresh.clone();
    single.dedup_by_key(|i| values[*i].to_bits());
    if single.len() as f64 > (1.0 - REPEATED) * fresh.len() as f64 {
        fresh = single;
    }
    let at = |all: &[f64]| -> Vec<f64> { fresh.iter().map(|i| all[*i]).collect() };
    noise_at(&fresh, &at(values), &at(input))
}

/// The same without the samples that are marked; none is where there are no marks.
pub(in crate::criticism) fn noise_beside(values: &[f64], input: &[f64], marked: &[bool]) -> Noise {
    if marked.is_empty() {
        return noise(values, input);
    }
    let places: Vec<usize> = (0..values.len()).filter(|i| !marked[*i]).collect();
    let at = |all: &[f64]| -> Vec<f64> { places.iter().map(|i| all[*i]).collect() };
    noise_at(&places, &at(values), &at(input))
}

/// The same of values at these samples.
fn noise_at(places: &[usize], values: &[f64], input: &[f64]) -> Noise {
    let quantum = lattice(values);
    // A quantised signal is dithered by one step, evenly spread, so that quantiles are smooth.
    let dithered: Vec<f64> = values
        .iter()
        .enumerate()
        .map(|(i, v)| v + quantum * (dither(i) - 0.5))
        .collect();
    let uniform = quantum * quantum / 12.0;
    // Counting, print and arithmetic leave at least this.
    let rounding = values.iter().fold(0.0_f64, |m, v| m.max(v.abs())) * ARITHMETIC;
    let printed = resolution(values);
    let floor = uniform
        .max(printed * printed / 12.0)
        .max(rounding * rounding);
    let groups = since_change(input);
    let smallest = least_level(places, &dithered, &groups);
    if let Some(mean_square) = mean_square_over_states(places, &dithered, &groups, smallest) {
        return Noise {
            level: (mean_square - uniform).max(floor).sqrt(),
            counted: false,
            step: quantum,
        };
    }
    // Quantisation and dither alone, within what the estimate can tell.
    if quantum > 0.0 && smallest * smallest < QUANTISED * 2.0 * uniform {
        return Noise {
            level: uniform.sqrt(),
            counted: true,
            step: quantum,
        };
    }
    let variance = if smallest.is_finite() {
        smallest * smallest - uniform
    } else {
        0.0
    };
    Noise {
        level: variance.max(floor).sqrt(),
        counted: false,
        step: quantum,
    }
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

/// The mean square of the noise over the states of the signal, where it depends on them: of a speed that is counted
/// over a time, say, which is quiet at rest and rough in motion, neither part tells alone. `usual` is what the quiet
/// differences show. `None` where the loudest part is no louder than the quietest, but for chance.
fn mean_square_over_states(
    places: &[usize],
    values: &[f64],
    groups: &[usize],
    usual: f64,
) -> Option<f64> {
    let signs = binomials(STATE_ORDER);
    let gain = signs.iter().map(|c| c * c).sum::<f64>().sqrt();
    let even = evenly_spaced(places, STATE_ORDER);
    // Long after a change of the input there are no kinks.
    let settled = |i: usize| even[i] && groups[i + STATE_ORDER] == GROUPS - 1;
    let mut differences: Vec<(f64, f64)> = values
        .windows(STATE_ORDER + 1)
        .enumerate()
        .filter(|(i, _)| settled(*i))
        .map(|(_, window)| {
            let mean = window.iter().sum::<f64>() / window.len() as f64;
            let difference: f64 = window.iter().zip(&signs).map(|(v, c)| v * c).sum();
            (mean.abs(), difference.abs() / gain)
        })
        .collect();
    let part = differences.len() / STATES;
    if part < MIN_GROUP {
        return None;
    }
    differences.sort_by(|a, b| a.0.total_cmp(&b.0));
    let levels = differences.chunks(part).take(STATES).map(|part| {
        let mut part: Vec<f64> = part.iter().map(|(_, difference)| *difference).collect();
        low_quantile(&mut part)
    });
    let levels: Vec<f64> = levels.collect();
    let loudest = levels.iter().copied().fold(0.0, f64::max);
    let quietest = levels.iter().copied().fold(f64::INFINITY, f64::min);
    let chance = 1.0 + chance(part);
    let depends = loudest > UNLIKE * chance * quietest.min(usual);
    depends.then(|| levels.iter().map(|l| l * l).sum::<f64>() / STATES as f64)
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
    fn a_count_that_is_no_round_number_is_found_behind_the_print() {
        // A converter's steps of 0.3223 degrees, printed with two digits: they are 0.32 and 0.33.
        let step = 0.3223;
        let values: Vec<f64> = (0..800)
            .map(|i| 40.0 * (1.0 - libm::exp(-f64::from(i) / 150.0)))
            .map(|x| 20.9 + (x / step).floor() * step)
            .map(|x| (x * 100.0).round() / 100.0)
            .collect();
        let found = lattice(&values);
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
