//! Is it a relay's limit cycle, where does each cycle begin, and when does the asymmetry flip?

use super::record::Record;
use crate::order::{median, range};

/// Fewest cycles of a drifting test.
const FEWEST: usize = 30;

/// Fewest samples in a cycle; with fewer nothing of it is seen.
const FEWEST_SAMPLES: f64 = 6.0;
/// Samples in a cycle from which on a load that was met is seen: of fewer a gap may follow, but not that there is none.
pub(super) const ENOUGH_SAMPLES: f64 = 15.0;

/// Share of the swing within which a sample counts as on a level of the relay.
const ON_LEVEL: f64 = 0.1;

/// Share of samples that must be on a level, and share of cycles that must be like the rest.
const MOSTLY: f64 = 0.9;

/// Distance of the asymmetry from the middle of its range, as share of the range, that shows its sign; and
/// the least range that is one.
const FLIP: f64 = 0.25;
const LEAST_ASYMMETRY: f64 = 0.01;

/// Cycles of the relay: `starts[k]..starts[k + 1]`, each from a switch up to the next.
pub(super) struct Cycles {
    pub starts: Vec<usize>,
    /// Whether a new asymmetry begins with this cycle.
    pub flips: Vec<bool>,
    /// Typical samples in a cycle.
    pub length: f64,
    /// Half the swing of the input, N m or N.
    pub gain: f64,
    /// Half the swing of the velocity, rad/s or m/s.
    pub speed: f64,
}

/// Why there are no cycles.
pub(super) enum NoCycles {
    /// The input is not that of a velocity relay in a limit cycle.
    NoRelay,
    /// Too few samples in each to see anything of it; how many there are.
    Few(f64),
}

impl Cycles {
    /// The cycles of a velocity relay.
    pub fn new(record: &Record) -> Result<Self, NoCycles> {
        let u = &record.input;
        let (low, high) = range(u);
        let middle = if low < 0.0 && high > 0.0 {
            0.0
        } else {
            0.5 * (low + high)
        };
        let starts: Vec<usize> = (1..u.len())
            .filter(|&i| u[i] > middle && u[i - 1] <= middle)
            .collect();
        if starts.len() <= FEWEST {
            return Err(NoCycles::NoRelay);
        }
        let mut lengths: Vec<f64> = starts.windows(2).map(|w| (w[1] - w[0]) as f64).collect();
        let length = median(&mut lengths);
        let covered = (starts[starts.len() - 1] - starts[0]) as f64;
        if covered < 0.5 * record.len() as f64 {
            return Err(NoCycles::NoRelay);
        }
        let (mut on_level, mut reversing) = (0, 0);
        let (mut asymmetries, mut gains, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
        for pair in starts.windows(2) {
            let span = pair[0]..pair[1];
            let (low, high) = range(&u[span.clone()]);
            let near = ON_LEVEL * (high - low);
            on_level += u[span.clone()]
                .iter()
                .filter(|v| (**v - low).min(high - **v) <= near)
                .count();
            let (slow, fast) = range(&record.velocity[span]);
            reversing += usize::from(slow < 0.0 && fast > 0.0);
            gains.push(0.5 * (high - low));
            speeds.push(0.5 * (fast - slow));
            asymmetries.push((high + low) / (high - low));
        }
        let count = starts.len() - 1;
        if (reversing as f64) < MOSTLY * count as f64 {
            return Err(NoCycles::NoRelay);
        }
        // Of so few samples many may be means over a switch, off both levels.
        if length < FEWEST_SAMPLES {
            return Err(NoCycles::Few(length));
        }
        if (on_level as f64) < MOSTLY * covered {
            return Err(NoCycles::NoRelay);
        }
        let flips = flips(&asymmetries);
        Ok(Self {
            flips,
            length,
            gain: median(&mut gains),
            speed: median(&mut speeds),
            starts,
        })
    }

    /// Number of whole cycles.
    pub fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// First cycle and end of each stretch with one asymmetry.
    pub fn phases(&self) -> Vec<(usize, usize)> {
        let mut phases = Vec::new();
        let mut from = 0;
        for k in 1..=self.count() {
            if k == self.count() || self.flips[k] {
                phases.push((from, k));
                from = k;
            }
        }
        phases
    }
}

/// Where the asymmetry changes to the other side of its range; the cycle of the change itself has both.
fn flips(asymmetries: &[f64]) -> Vec<bool> {
    let (least, most) = range(asymmetries);
    let (middle, far) = (0.5 * (least + most), FLIP * (most - least));
    let mut side = None;
    asymmetries
        .iter()
        .map(|a| {
            let now =
                (most - least > LEAST_ASYMMETRY && (a - middle).abs() > far).then_some(*a > middle);
            let flips = now.is_some() && side.is_some() && now != side;
            side = now.or(side);
            flips
        })
        .collect()
}
