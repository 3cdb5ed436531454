//! The rule of a relay with hysteresis, read off a record.

use super::tuning::{BEYOND_A_CLOCK, CLOCK_SAMPLES, EXPLAINED, FEWEST_HALVES, LONGEST_DELAY};

/// A sampled relay with hysteresis: it leaves its upper level when its signal is beyond one threshold, the lower one
/// when it is beyond the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rule {
    /// Upper and lower level of the input.
    levels: [f64; 2],
    /// Values of the signal, times `sign`, above which it leaves the upper level, and below which the lower one.
    thresholds: [f64; 2],
    /// 1 where a signal that rises ends the upper level, as negative feedback does; -1 where one that falls does.
    sign: f64,
    /// Samples from the crossing of a threshold to the switch.
    pub late: usize,
}

/// Samples from one switch to the next.
#[derive(Clone, Copy, Debug)]
struct Half {
    from: usize,
    to: usize,
    is_upper: bool,
}

impl Half {
    fn len(self) -> usize {
        self.to - self.from
    }
}

/// How many of the half cycles a rule explains.
#[derive(Clone, Copy, Debug)]
struct Reading {
    rule: Rule,
    explained: usize,
}

impl Rule {
    /// The rule that leads from one of the signals to the input, with the place of that signal; `None` where the input
    /// has not two levels, or may have come from a clock.
    pub fn read(input: &[f64], signals: &[&[f64]]) -> Option<(Self, usize)> {
        let levels = two_levels(input)?;
        let halves = halves(input, levels);
        if halves.len() < FEWEST_HALVES {
            return None;
        }
        let usual = usual_length(halves.iter().copied());
        let longest = (LONGEST_DELAY * usual as f64) as usize;
        let mut best: Option<(Reading, usize)> = None;
        for (place, signal) in signals.iter().enumerate() {
            for sign in [1.0, -1.0] {
                for late in 0..=longest {
                    let reading = reading(levels, &halves, signal, sign, late);
                    // Of equals the first: the switch is seen soonest there.
                    if best.is_none_or(|(b, _)| reading.explained > b.explained) {
                        best = Some((reading, place));
                    }
                }
            }
        }
        let (reading, place) = best?;
        let timed = by_a_clock(&halves);
        let enough = reading.explained as f64 >= EXPLAINED * halves.len() as f64;
        (enough && reading.explained >= timed + BEYOND_A_CLOCK).then_some((reading.rule, place))
    }

    /// Whether it is at its upper level after it has seen this, where it was there before or not.
    pub fn is_upper_after(&self, seen: f64, was_upper: bool) -> bool {
        let value = self.sign * seen;
        if was_upper {
            value <= self.thresholds[0]
        } else {
            value < self.thresholds[1]
        }
    }

    /// Its output.
    pub fn level(&self, is_upper: bool) -> f64 {
        self.levels[usize::from(!is_upper)]
    }

    /// Whether an input is its upper level.
    pub fn is_upper(&self, input: f64) -> bool {
        input == self.levels[0]
    }
}

/// The larger and the smaller value of an input that has two.
fn two_levels(input: &[f64]) -> Option<[f64; 2]> {
    let fold = |f: fn(f64, f64) -> f64| input.iter().copied().reduce(f);
    let (upper, lower) = (fold(f64::max)?, fold(f64::min)?);
    let two = upper > lower && input.iter().all(|u| *u == upper || *u == lower);
    two.then_some([upper, lower])
}

/// The runs from switch to switch: what was before the first switch and after the last is not whole.
fn halves(input: &[f64], levels: [f64; 2]) -> Vec<Half> {
    let switches: Vec<usize> = (1..input.len())
        .filter(|i| input[*i] != input[i - 1])
        .collect();
    let half = |pair: &[usize]| Half {
        from: pair[0],
        to: pair[1],
        is_upper: input[pair[0]] == levels[0],
    };
    switches.windows(2).map(half).collect()
}

fn usual_length(halves: impl Iterator<Item = Half>) -> usize {
    let mut lengths: Vec<usize> = halves.map(Half::len).collect();
    lengths.sort_unstable();
    lengths.get(lengths.len() / 2).copied().unwrap_or(0)
}

/// Half cycles that are as long as the others at their level.
fn by_a_clock(halves: &[Half]) -> usize {
    let at = |is_upper: bool| {
        halves
            .iter()
            .copied()
            .filter(move |h| h.is_upper == is_upper)
    };
    let timed = |is_upper: bool| {
        let usual = usual_length(at(is_upper));
        at(is_upper)
            .filter(|h| h.len().abs_diff(usual) <= CLOCK_SAMPLES)
            .count()
    };
    timed(true) + timed(false)
}

/// The thresholds that explain most half cycles. In each the signal was not yet beyond the threshold before the switch,
/// and was then: that bounds it from both sides.
fn reading(levels: [f64; 2], halves: &[Half], signal: &[f64], sign: f64, late: usize) -> Reading {
    let bounds = |is_upper: bool| {
        let way = if is_upper { sign } else { -sign };
        let of_level = halves.iter().filter(move |h| h.is_upper == is_upper);
        let bound = of_level.filter_map(move |half| {
            let before = signal.get((half.from + 1).checked_sub(late)?..half.to - late)?;
            let most = before.iter().map(|y| way * y).reduce(f64::max)?;
            Some([most, way * signal[half.to - late]])
        });
        (most_bounded(bound.collect()), way)
    };
    let [(upper, up), (lower, down)] = [bounds(true), bounds(false)];
    // Both in the direction in which the signal rises at the upper level.
    let thresholds = [upper.0 * up * sign, lower.0 * down * sign];
    Reading {
        rule: Rule {
            levels,
            thresholds,
            sign,
            late,
        },
        explained: upper.1 + lower.1,
    }
}

/// The middle of the values that lie within most of these bounds, and how many those are.
fn most_bounded(bounds: Vec<[f64; 2]>) -> (f64, usize) {
    let mut ends: Vec<(f64, bool)> = bounds
        .into_iter()
        .filter(|[low, high]| low < high)
        .flat_map(|[low, high]| [(low, true), (high, false)])
        .collect();
    // Where one ends and another begins, no value is within both.
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let (mut within, mut best) = (0, (0.0, 0));
    for pair in ends.windows(2) {
        let (value, begins) = pair[0];
        if !begins {
            within -= 1;
            continue;
        }
        within += 1;
        if within > best.1 {
            best = (f64::midpoint(value, pair[1].0), within);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_threshold_lies_where_most_half_cycles_have_it() {
        let bounds = vec![[0.0, 1.0], [0.8, 2.0], [0.9, 1.2], [3.0, 4.0]];
        let (value, count) = most_bounded(bounds);
        assert_eq!(count, 3);
        assert!((value - 0.95).abs() < 1e-12);
        assert_eq!(most_bounded(Vec::new()), (0.0, 0));
    }
}
