//! Cycle by cycle: where does the pattern of drift change?

use super::change_points::{Segment, pelt};
use super::cycles::Cycles;
use crate::order::median;

/// Penalty of a change of drift, in units of the logarithm of the number of cycles.
const PENALTY: f64 = 3.0;

/// Least deviation of engaged cycles: in standard deviations of their mean, and as share of the swing of
/// the velocity, below which a changing friction could do the same.
const DEVIATION: f64 = 4.0;
const LEAST_SHARE: f64 = 5e-3;

/// Deviation of a single engaged cycle, in standard deviations of the free ones.
const SINGLE: f64 = 6.0;

/// Times the spread of the changes in the calmest phase that it may be in any other while the motor is free.
const RESTLESS: f64 = 2.0;

/// Cycles alternate where those two apart differ by less than this share of what neighbours do.
const ALTERNATES: f64 = 0.5;

/// Standard deviation of normal values over the median of how far they are off.
const DEVIATIONS_IN_MEDIAN: f64 = 1.4826;

/// Fewest cycles of a run that can show how the free motor drifts; half a phase if that is shorter.
const FREE: usize = 8;

/// What each cycle says.
pub(super) struct Drift {
    /// Change of the unexplained velocity in each cycle.
    pub change: Vec<f64>,
    /// The same of the free motor, for the phase it lies in.
    pub base: Vec<f64>,
    /// Whether the pattern of drift differs from the free one.
    pub engaged: Vec<bool>,
}

impl Drift {
    /// From the unexplained velocity and its noise; `ahead`: in which direction each phase drifts.
    ///
    /// In each phase PELT finds runs of cycles with one mean change. The load can only resist the drift,
    /// so the run with the most change along it is free, and so are all that are like it.
    pub fn new(cycles: &Cycles, unexplained: &[f64], noise: f64, position: &[f64]) -> Self {
        let level = |i: usize| {
            let (a, b) = (i.saturating_sub(1), (i + 2).min(unexplained.len()));
            unexplained[a..b].iter().sum::<f64>() / (b - a) as f64
        };
        let change: Vec<f64> = cycles
            .starts
            .windows(2)
            .map(|s| level(s[1]) - level(s[0]))
            .collect();
        let mut base = vec![0.0; change.len()];
        let mut engaged = vec![false; change.len()];
        let penalty = PENALTY * libm::log(cycles.count() as f64);
        let least = LEAST_SHARE * 2.0 * cycles.speed;
        let phases = cycles.phases();
        let spreads: Vec<(f64, bool)> = phases
            .iter()
            .map(|(from, to)| {
                let part = &change[*from..*to];
                let (next, second) = (spread(part, 1), spread(part, 2));
                // A load that is met in every second cycle makes a pattern of two.
                let alternates = second < ALTERNATES * next;
                (if alternates { second } else { next }, alternates)
            })
            .collect();
        let calmest = phases
            .iter()
            .zip(&spreads)
            .filter(|((from, to), _)| to - from >= 2 * FREE)
            .map(|(_, (spread, _))| *spread)
            .fold(f64::INFINITY, f64::min);
        for ((from, to), (own, alternates)) in phases.into_iter().zip(spreads) {
            let part = &change[from..to];
            // The free motor is as restless in every phase; what is more is the load.
            let sigma = own.min(RESTLESS * calmest).max(noise);
            let way = position[cycles.starts[to]] - position[cycles.starts[from]];
            let segments = if alternates {
                pelt(&without_alternation(part), sigma, penalty)
            } else {
                pelt(part, sigma, penalty)
            };
            let free = free_level(&segments, way.signum(), part.len(), least);
            base[from..to].fill(free);
            let unlike = |s: &&Segment| {
                let count = (s.to - s.from) as f64;
                (s.mean - free).abs() > (DEVIATION * sigma / count.sqrt()).max(least)
            };
            for segment in segments.iter().filter(unlike) {
                engaged[from + segment.from..from + segment.to].fill(true);
            }
            // A load that is pushed along is met in some cycles and missed in others, which no run of them shows.
            let limit = (SINGLE * free_spread(part, &segments, free, least)).max(least);
            let run = &mut engaged[from..to];
            if run.contains(&true) {
                for (engaged, change) in run.iter_mut().zip(part) {
                    *engaged |= (change - free).abs() > limit;
                }
            }
        }
        Self {
            change,
            base,
            engaged,
        }
    }
}

/// Means over two cycles about each cycle.
fn without_alternation(values: &[f64]) -> Vec<f64> {
    let at = |k: usize| values[k.min(values.len() - 1)];
    (0..values.len())
        .map(|k| 0.25 * (at(k.saturating_sub(1)) + 2.0 * at(k) + at(k + 1)))
        .collect()
}

/// Standard deviation by the median difference of values so many cycles apart, which changes of the mean leave alone.
fn spread(values: &[f64], apart: usize) -> f64 {
    let pairs = values.iter().zip(values.iter().skip(apart));
    let mut steps: Vec<f64> = pairs.map(|(a, b)| (b - a).abs()).collect();
    DEVIATIONS_IN_MEDIAN * median(&mut steps) / std::f64::consts::SQRT_2
}

/// Standard deviation of the changes in the runs of one phase that are free; infinite where none is.
fn free_spread(changes: &[f64], segments: &[Segment], free: f64, tolerance: f64) -> f64 {
    let is_free = |s: &&Segment| s.to - s.from >= FREE && (s.mean - free).abs() <= tolerance;
    let free_runs = segments.iter().filter(is_free);
    let mut off: Vec<f64> = free_runs
        .flat_map(|s| &changes[s.from..s.to])
        .map(|change| (change - free).abs())
        .collect();
    if off.is_empty() {
        return f64::INFINITY;
    }
    DEVIATIONS_IN_MEDIAN * median(&mut off)
}

/// Mean change of the free motor in one phase: that of the run with the most change along the drift and
/// of all runs within `tolerance` of it.
fn free_level(segments: &[Segment], way: f64, cycles: usize, tolerance: f64) -> f64 {
    let fewest = FREE.min(cycles / 2);
    let most = segments
        .iter()
        .filter(|s| s.to - s.from >= fewest)
        .map(|s| way * s.mean)
        .fold(f64::NEG_INFINITY, f64::max);
    let (sum, count) = segments
        .iter()
        .filter(|s| s.to - s.from >= fewest && way * s.mean >= most - tolerance)
        .map(|s| (s.mean, (s.to - s.from) as f64))
        .fold((0.0, 0.0), |(sum, count), (mean, n)| {
            (sum + n * mean, count + n)
        });
    // A phase that has no free run at all: its least resistance is still one.
    if count > 0.0 && way * sum / count > -tolerance {
        sum / count
    } else {
        0.0
    }
}
