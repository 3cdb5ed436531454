//! What the switches of a long run show: settled, growing, or a pattern of several cycles.

use crate::simulate::Trajectory;

/// Relative change from one cycle to the next below which a run has settled: well above round-off.
const SETTLED: f64 = 1e-9;

/// Relative difference of a settled run from the exact cycle that it settled into.
pub(super) const SAME_CYCLE: f64 = 1e-6;

/// Cycles over which it must have.
const SETTLED_CYCLES: usize = 3;

/// Relative difference of patterns that repeat.
const REPEATS: f64 = 1e-7;

/// Longest pattern that is looked for, cycles, and how often it must be seen.
const LONGEST: usize = 64;
const SEEN: usize = 3;

/// Cycles that show growth.
const GROWTH_CYCLES: usize = 16;

/// Growth in the last quarter of the cycles per growth in the third quarter from which on it goes on for ever: growth
/// by `k^-p` in cycle `k` has a bound from `p = 1` on, where this ratio is 5/7.
const GOES_ON: f64 = 0.75;

/// Relative growth a cycle that is none but round-off.
const NO_GROWTH: f64 = 1e-9;

/// Period in s and amplitude (half of peak to peak) of one cycle, from rise to rise.
pub(super) type OneCycle = [f64; 2];

/// The whole cycles of a run.
pub(super) fn cycles(run: &Trajectory) -> Vec<OneCycle> {
    let periods = run.rises.windows(2).map(|w| w[1] - w[0]);
    periods
        .zip(&run.swings)
        .map(|(period, swing)| [period, 0.5 * (swing[1] - swing[0])])
        .collect()
}

/// How unlike two cycles are, relative.
pub(super) fn difference(a: &OneCycle, b: &OneCycle) -> f64 {
    let apart = |i: usize| (a[i] - b[i]).abs() / a[i].abs().max(b[i].abs());
    apart(0).max(apart(1))
}

/// The last cycle, if the run repeats it.
pub(super) fn settled(cycles: &[OneCycle]) -> Option<OneCycle> {
    let last = cycles.last()?;
    let from = cycles.len().checked_sub(SETTLED_CYCLES + 1)?;
    let calm = cycles[from..].iter().all(|c| difference(c, last) < SETTLED);
    calm.then_some(*last)
}

/// Cycles of the shortest pattern of several that the end of the run repeats.
pub(super) fn repeated(cycles: &[OneCycle]) -> Option<usize> {
    (2..=LONGEST).find(|&m| {
        cycles.len() >= SEEN * m && {
            let end = &cycles[cycles.len() - (SEEN - 1) * m..];
            let before = &cycles[cycles.len() - SEEN * m..];
            let mut pairs = before.iter().zip(end);
            pairs.all(|(a, b)| difference(a, b) < REPEATS)
        }
    })
}

/// Whether the amplitude grows from cycle to cycle at a pace that never dies down.
pub(super) fn grows(cycles: &[OneCycle]) -> bool {
    let n = cycles.len();
    if n < GROWTH_CYCLES {
        return false;
    }
    let half = &cycles[n / 2..];
    let rises = half
        .windows(2)
        .all(|w| w[1][1] > w[0][1] * (1.0 + NO_GROWTH));
    let quarter = half.len() / 2;
    let gain = |part: &[OneCycle]| {
        let ends = part.first().zip(part.last());
        ends.map_or(0.0, |(a, b)| (b[1] - a[1]) / (part.len() - 1) as f64)
    };
    rises && gain(&half[quarter..]) >= GOES_ON * gain(&half[..=quarter])
}
