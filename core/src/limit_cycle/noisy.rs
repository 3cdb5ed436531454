//! Cycles of a run in measurement noise, by the output itself and not by the relay's switches.

use crate::order::range;
use crate::simulate::Trajectory;

/// Share of half the output's range that it must pass its middle by, up and down, for a cycle.
const PASSES: f64 = 0.3;

/// Fewest cycles that have a scatter.
const FEWEST: usize = 4;

/// Switches in a cycle from which the relay chatters: twice as many as the two that the cycle needs.
const CHATTERS: f64 = 4.0;

/// Means and standard deviations from cycle to cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NoisyCycle {
    /// s.
    pub period: [f64; 2],
    /// Half of peak to peak of the output without the noise.
    pub amplitude: [f64; 2],
    /// Switches of the relay in a cycle.
    pub switches: f64,
}

impl NoisyCycle {
    /// Whether the relay switches many times where the output passes once.
    pub fn chatters(&self) -> bool {
        self.switches >= CHATTERS
    }
}

/// The cycles in the later half of a sampled run.
pub(super) fn noisy_cycle(run: &Trajectory) -> Option<NoisyCycle> {
    let from = run.output.len() / 2;
    let (time, output) = (run.time.get(from..)?, run.output.get(from..)?);
    if output.is_empty() {
        return None;
    }
    let (low, high) = range(output);
    let (middle, pass) = (0.5 * (low + high), PASSES * 0.5 * (high - low));
    let mut starts = Vec::new();
    let mut below = false;
    for (i, y) in output.iter().enumerate() {
        if *y < middle - pass {
            below = true;
        } else if below && *y > middle + pass {
            below = false;
            starts.push(i);
        }
    }
    if starts.len() <= FEWEST {
        return None;
    }
    let periods: Vec<f64> = starts.windows(2).map(|w| time[w[1]] - time[w[0]]).collect();
    let amplitudes: Vec<f64> = starts
        .windows(2)
        .map(|w| {
            let (low, high) = range(&output[w[0]..w[1]]);
            0.5 * (high - low)
        })
        .collect();
    let (begin, end) = (time[starts[0]], time[starts[starts.len() - 1]]);
    let switches = run.rises.iter().chain(&run.falls);
    let within = switches.filter(|t| **t >= begin && **t < end).count();
    Some(NoisyCycle {
        period: mean_and_deviation(&periods),
        amplitude: mean_and_deviation(&amplitudes),
        switches: within as f64 / periods.len() as f64,
    })
}

fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    [mean, (squares / (count - 1.0)).sqrt()]
}
