//! Where windows begin, and which samples are fitted and which judge.
//!
//! A model restarts in each window from a state that is estimated there. So a window begins where the outputs tell that
//! state: where the body moves (while it sticks, the deflection of its friction contact cannot be seen, and decides
//! when it breaks loose) and not inside a contact with a load.

use crate::measurement::gaps;
use crate::sums::deviation;

/// Golden section: its multiples, without their whole part, are evenly spread and never repeat.
pub(super) const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Fewest samples in a window.
pub(super) const MIN_WINDOW: usize = 10;

/// Share of the typical speed that a body has where a window begins.
const MOVING: f64 = 0.2;

/// Swings of the motor before a contact in its window.
const SWINGS_BEFORE: usize = 4;

/// Swings of the motor in a window without a contact that was felt.
const MOST_SWINGS: usize = 6;

/// A run of samples that is used as a whole, either for fitting or for judging.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    pub from: usize,
    pub to: usize,
    /// Index of the window in which it lies.
    pub window: usize,
    /// It judges; what is not held back is fitted.
    pub held_back: bool,
}

/// First samples of runs of `length` of `n` samples; a short rest joins the last run.
pub(super) fn evenly(n: usize, length: usize) -> Vec<usize> {
    (0..(n / length).max(1)).map(|k| k * length).collect()
}

/// The same, each put off by at most half its length until the body moves; where it does not, to the sample at which
/// it is fastest.
pub(super) fn in_motion(velocity: &[f64], length: usize) -> Vec<usize> {
    let n = velocity.len();
    let moving = MOVING * deviation(velocity);
    let put_off = |cut: usize| {
        let later = cut..(cut + length / 2).min(n);
        let speed = |k: &usize| velocity[*k].abs();
        let found = later.clone().find(|k| speed(k) >= moving);
        let fastest = || later.rev().max_by(|a, b| speed(a).total_cmp(&speed(b)));
        found.or_else(fastest).unwrap_or(cut)
    };
    let cuts = evenly(n, length).into_iter();
    cuts.map(|cut| if cut == 0 { 0 } else { put_off(cut) })
        .collect()
}

/// First samples after gaps in `time`, where rows are missing or runs are joined: what the input did there is not
/// known.
pub(super) fn pauses(time: &[f64]) -> Vec<usize> {
    let mut found = gaps(time);
    // What stands between two of them may be too short for a window.
    let mut from = 0;
    found.retain(|k| {
        let long = *k >= from + MIN_WINDOW && *k + MIN_WINDOW <= time.len();
        if long {
            from = *k;
        }
        long
    });
    found
}

/// Windows as [`in_motion`], and each of these samples begins one.
pub(super) fn between(pauses: &[usize], velocity: &[f64], length: usize) -> Vec<usize> {
    let from = [&[0], pauses].concat();
    let to = pauses.iter().copied().chain([velocity.len()]);
    let runs = from.iter().zip(to);
    runs.flat_map(|(from, to)| {
        let windows = in_motion(&velocity[*from..to], length).into_iter();
        windows.map(move |cut| from + cut)
    })
    .collect()
}

/// Windows each with one of the contacts that were `felt`, samples in order: every contact multiplies what was wrong
/// before it, and from far away a load may be met one swing of the motor too early or too late. They begin some swings
/// before the contact, which tell the motion without it, at most half way from the contact before. Without one, they
/// are so short, `usual` at most, that a contact too weak to be felt does not go on to another.
pub(super) fn at_contacts(felt: &[usize], velocity: &[f64], usual: usize) -> Vec<usize> {
    let n = velocity.len();
    let turns = |k: &usize| velocity[*k] * velocity[k + 1] <= 0.0;
    let count = (0..n - 1).filter(turns).count();
    let swing = n / count.max(1);
    let usual = usual.min((MOST_SWINGS * n / count.max(1)).max(MIN_WINDOW));
    // Whether a contact that began a swing or less before is still on.
    let touches = |sample: usize| {
        let before = felt.partition_point(|felt| *felt <= sample);
        let before = before.checked_sub(1);
        before.is_some_and(|k| sample < felt[k] + swing)
    };
    let begin = |place: usize| {
        let before = place.checked_sub(1).map_or(0, |k| felt[k]);
        let half_way = usize::midpoint(before, felt[place]);
        let mut turns = (half_way..felt[place]).rev().filter(turns);
        turns.nth(SWINGS_BEFORE).unwrap_or(half_way)
    };
    // What follows within a swing is the same contact once more.
    let apart = |place: &usize| *place == 0 || felt[*place] - felt[place - 1] > swing;
    let mut begins = (0..felt.len()).filter(apart).map(begin).peekable();
    let mut windows = vec![0];
    let mut from = 0;
    loop {
        while begins.next_if(|b| *b < from + MIN_WINDOW).is_some() {}
        // A rest shorter than half a window joins the one before.
        let next = begins.peek().filter(|b| **b < from + usual + usual / 2);
        from = next.copied().unwrap_or_else(|| {
            let cut = from + usual;
            let mut later = cut..cut + usual / 2;
            later.find(|sample| !touches(*sample)).unwrap_or(cut)
        });
        if from + MIN_WINDOW >= n {
            return windows;
        }
        windows.push(from);
    }
}

/// Each window as one block, every other one held back.
pub(super) fn one_each(windows: &[usize], n: usize) -> Vec<Block> {
    let ends = windows.iter().skip(1).copied().chain([n]);
    windows
        .iter()
        .zip(ends)
        .enumerate()
        .map(|(window, (from, to))| Block {
            from: *from,
            to,
            window,
            held_back: window % 2 == 1,
        })
        .collect()
}

/// Blocks of `length` of `n` samples in these windows; a short rest joins the last block. Of every pair one is held
/// back, in an order that goes with no period: an input that steps every so many blocks would else show all of its
/// steps to the fit, or to the judge.
pub(super) fn blocks(n: usize, length: usize, windows: &[usize]) -> Vec<Block> {
    let begins = evenly(n, length);
    one_each(&begins, n)
        .into_iter()
        .enumerate()
        .map(|(k, block)| Block {
            window: windows.partition_point(|w| *w <= block.from) - 1,
            held_back: (k % 2 == 1) != is_turned(k / 2),
            ..block
        })
        .collect()
}

/// Whether the first of a pair is held back: a square of its number times an irrational one falls alike into either
/// half of a whole along every even distance (Weyl 1916).
fn is_turned(pair: usize) -> bool {
    ((pair * pair) as f64 * GOLDEN).fract() >= 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A saw-tooth: it turns every `swing` samples.
    fn swinging(n: usize, swing: usize) -> Vec<f64> {
        let way = |k: usize| [1.0, -1.0][k / swing % 2];
        (0..n)
            .map(|k| way(k) * (0.5 - (k % swing) as f64 / swing as f64))
            .collect()
    }

    #[test]
    fn no_window_begins_while_the_body_sticks() {
        // It moves for 70 samples and sticks for 30.
        let velocity: Vec<f64> = (0..2_000)
            .map(|k| if k % 100 < 70 { 1.0 } else { 0.0 })
            .collect();
        let windows = in_motion(&velocity, 90);
        assert_eq!(windows.len(), 22);
        assert_eq!(windows[0], 0);
        for pair in windows.windows(2) {
            assert!(pair[1] >= pair[0] + 45, "{pair:?}");
            assert!(velocity[pair[1]] > 0.0, "{}", pair[1]);
        }
    }

    #[test]
    fn a_body_that_stands_for_long_starts_where_it_is_fastest() {
        let mut velocity = [vec![0.0; 60], vec![1.0; 5], vec![0.0; 235]].concat();
        velocity[170] = 1e-3;
        assert_eq!(in_motion(&velocity, 100), [0, 100, 200]);
        velocity[140] = 1e-3;
        assert_eq!(in_motion(&velocity, 100), [0, 140, 200]);
    }

    #[test]
    fn steps_every_so_many_blocks_are_shown_to_either_half() {
        let blocks = blocks(64 * 50, 50, &[0]);
        for period in 2..=6 {
            let steps = || blocks.iter().step_by(period);
            let held = steps().filter(|b| b.held_back).count();
            assert!(
                4 * held >= steps().count() && 4 * held <= 3 * steps().count(),
                "{period}: {held} of {}",
                steps().count()
            );
        }
    }

    /// The load is met every 185 samples, and once more five samples later, as the contact presses and lets go.
    #[test]
    fn no_window_begins_inside_a_contact() {
        let first: Vec<usize> = (1..50).map(|k| 185 * k).collect();
        let felt: Vec<usize> = first.iter().flat_map(|k| [*k, k + 5]).collect();
        let windows = at_contacts(&felt, &swinging(10_000, 12), 250);
        assert!(windows.len() > first.len(), "{}", windows.len());
        for window in windows {
            let inside = first.iter().any(|k| (*k..k + 8).contains(&window));
            assert!(!inside, "a window begins at {window}");
        }
    }
}
