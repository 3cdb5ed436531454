//! An input that goes in steps, read by a sensor with noise.
//!
//! The noise of a sensor does not act, but a model that is given it takes it for the input; what clips it seems to be
//! missing then. Between two jumps such an input is what its readings are on the average.

use super::tuning::{JUMP_SIGMAS, LONG_LEVELS, SCATTERS};
use crate::order::{NORMAL_MEDIAN, median};
use crate::sums::deviation;

/// An input on its levels.
#[derive(Clone, Debug)]
pub(in crate::criticism) struct Levelled {
    pub values: Vec<f64>,
    /// Standard deviation of the noise that was taken off.
    pub noise: f64,
    /// That of white noise which pushes a body as far off its way as what is still not known of the levels: none is
    /// known better by its mean than the impulse over its readings is.
    pub unknown: f64,
    /// Standard error of the level that is known least.
    pub level_error: f64,
}

/// A stretch between two jumps, or all of them on one level.
#[derive(Clone, Copy)]
struct Level {
    readings: usize,
    sum: f64,
}

impl Level {
    fn mean(self) -> f64 {
        self.sum / self.readings as f64
    }
}

/// An input between its jumps on the average, of all stretches on one level where it comes back to it; `None` where it
/// has no noise, or does not go in steps.
pub(in crate::criticism) fn levelled(input: &[f64]) -> Option<Levelled> {
    let noise = noise_between_jumps(input);
    let mut stretches: Vec<Level> = Vec::new();
    for u in input {
        match stretches.last_mut() {
            Some(last) if (u - last.mean()).abs() <= JUMP_SIGMAS * noise => {
                last.sum += u;
                last.readings += 1;
            }
            _ => stretches.push(Level {
                readings: 1,
                sum: *u,
            }),
        }
    }
    if stretches.len() * LONG_LEVELS > input.len() {
        return None;
    }
    let levels = common(&stretches, noise);
    let of_stretches = stretches.iter().zip(&levels);
    let values: Vec<f64> = of_stretches
        .clone()
        .flat_map(|(stretch, level)| std::iter::repeat_n(level.mean(), stretch.readings))
        .collect();
    let squares = input
        .iter()
        .zip(&values)
        .map(|(u, mean)| (u - mean).powi(2));
    let scatter = (squares.sum::<f64>() / input.len() as f64).sqrt();
    let alone = of_stretches.map(|(s, l)| (s.readings * s.readings) as f64 / l.readings as f64);
    // Else chance is the input, and no noise of it.
    let is_input = deviation(&values) > scatter;
    let fewest = levels.iter().map(|l| l.readings).min().unwrap_or(0);
    let is_noise = scatter > 0.0 && scatter < SCATTERS * noise;
    (is_noise && is_input).then(|| Levelled {
        values,
        noise: scatter,
        level_error: scatter / (fewest.max(1) as f64).sqrt(),
        unknown: scatter * (alone.sum::<f64>() / input.len() as f64).sqrt(),
    })
}

/// Standard deviation of white noise by what most readings differ from the next.
fn noise_between_jumps(input: &[f64]) -> f64 {
    let mut steps: Vec<f64> = input.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    median(&mut steps) / (std::f64::consts::SQRT_2 * NORMAL_MEDIAN)
}

/// For each stretch the level on which it is: that of all which differ by no more than chance lets them, if such are.
fn common(stretches: &[Level], noise: f64) -> Vec<Level> {
    let mut order: Vec<usize> = (0..stretches.len()).collect();
    order.sort_by(|a, b| stretches[*a].mean().total_cmp(&stretches[*b].mean()));
    let error = |k: usize| noise * noise / stretches[k].readings as f64;
    let near = |a: &usize, b: &usize| {
        let apart = stretches[*b].mean() - stretches[*a].mean();
        apart <= JUMP_SIGMAS * (error(*a) + error(*b)).sqrt()
    };
    let mut levels = stretches.to_vec();
    for group in order.chunk_by(near) {
        let all = Level {
            readings: group.iter().map(|k| stretches[*k].readings).sum(),
            sum: group.iter().map(|k| stretches[*k].sum).sum(),
        };
        let off = |k: &usize| (stretches[*k].mean() - all.mean()).powi(2) / error(*k);
        // What goes on from level to level is no level.
        let scatter = group.iter().map(off).sum::<f64>() / group.len() as f64;
        if scatter < SCATTERS * SCATTERS {
            for k in group {
                levels[*k] = all;
            }
        }
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn binary(k: usize) -> f64 {
        if (k / 40).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        }
    }

    #[test]
    fn levels_are_found_behind_noise() {
        let mut random = Random::new(5);
        let noisy: Vec<f64> = (0..2000)
            .map(|k| binary(k) + 0.05 * random.normal())
            .collect();
        let found = levelled(&noisy).expect("levels");
        assert!((found.noise / 0.05 - 1.0).abs() < 0.1, "{}", found.noise);
        let off = found.values.iter().enumerate();
        let off = off.map(|(k, u)| (u - binary(k)).abs());
        assert!(off.fold(0.0, f64::max) < 0.01);
        assert!(found.unknown < 0.02, "{}", found.unknown);
    }

    #[test]
    fn of_levels_that_do_not_come_back_the_impulse_is_as_unknown_as_before() {
        let mut random = Random::new(7);
        let level = |k: usize| libm::sin(3.0 * (k / 40) as f64);
        let noisy: Vec<f64> = (0..2000)
            .map(|k| level(k) + 0.003 * random.normal())
            .collect();
        let found = levelled(&noisy).expect("levels");
        assert!(
            (found.unknown / 0.003 - 1.0).abs() < 0.3,
            "{}",
            found.unknown
        );
    }

    #[test]
    fn what_is_exact_or_goes_no_steps_is_left_alone() {
        let exact: Vec<f64> = (0..2000).map(binary).collect();
        assert!(levelled(&exact).is_none());
        let swings: Vec<f64> = (0..2000).map(|k| libm::sin(0.1 * f64::from(k))).collect();
        assert!(levelled(&swings).is_none());
        let mut random = Random::new(6);
        let chance: Vec<f64> = (0..2000).map(|_| random.normal()).collect();
        assert!(levelled(&chance).is_none());
    }
}
