//! Roots of functions of one variable between points where the signs differ, and the maximum of one that has one.

use std::cmp::Ordering;

/// Halvings of an interval: it is halved to the last bit.
const BISECTIONS: usize = 200;

/// The root between `low` and `high`; `side` tells of a point whether it is below the root (`Less`), at it or above it.
pub(crate) fn bisect(mut low: f64, mut high: f64, side: impl Fn(f64) -> Ordering) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        match side(middle) {
            Ordering::Less => low = middle,
            Ordering::Equal => return middle,
            Ordering::Greater => high = middle,
        }
    }
    0.5 * (low + high)
}

/// Root of `f` between two points of different sign (Illinois method, then bisection).
pub(crate) fn illinois(low: (f64, f64), high: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    let (mut a, mut b) = (low, high);
    for _ in 0..60 {
        let mut x = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        if !(x > a.0.min(b.0) && x < a.0.max(b.0)) {
            x = 0.5 * (a.0 + b.0);
        }
        let value = f(x);
        if value == 0.0 || (x - b.0).abs() <= 2.0 * f64::EPSILON * x {
            return x;
        }
        if (value < 0.0) == (b.1 < 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = (x, value);
    }
    let (low, high) = if a.0 < b.0 { (a, b) } else { (b, a) };
    bisect(low.0, high.0, |x| match f(x) {
        0.0 => Ordering::Equal,
        value if (value < 0.0) == (low.1 < 0.0) => Ordering::Less,
        _ => Ordering::Greater,
    })
}

/// Root of `f` between 0 and `h`, where `f(0)` and `f(h)` have different signs.
///
/// Regula falsi with the Illinois rule, safeguarded by bisection; stops at `1e-13 h`.
pub(crate) fn falsi(h: f64, f0: f64, fh: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut a, mut fa, mut b, mut fb) = (0.0, f0, h, fh);
    for i in 0..80 {
        if fb == 0.0 || (b - a).abs() <= 1e-13 * h {
            return b;
        }
        let falsi = b - fb * (b - a) / (fb - fa);
        let c = if i % 8 == 7 || !falsi.is_finite() {
            0.5 * (a + b)
        } else {
            falsi
        };
        let fc = f(c);
        if (fc < 0.0) == (fb < 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (c, fc);
    }
    b
}

/// Golden sections that leave less of an interval than a double resolves.
pub(crate) const SECTIONS: usize = 80;

/// A maximum, found by [`golden_section`].
pub(crate) struct Peak {
    /// The middle of what is left of the interval.
    pub at: f64,
    /// The largest value seen, and where it was.
    pub best: (f64, f64),
}

/// The one maximum of `f` between `low` and `high` by so many golden sections (Kiefer 1953); a value above `enough`
/// ends the search.
pub(crate) fn golden_section(
    (mut low, mut high): (f64, f64),
    sections: usize,
    enough: f64,
    f: impl Fn(f64) -> f64,
) -> Peak {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let mut best = (low, f64::NEG_INFINITY);
    for _ in 0..sections {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        let (at_left, at_right) = (f(left), f(right));
        for (at, value) in [(left, at_left), (right, at_right)] {
            if value > best.1 {
                best = (at, value);
            }
        }
        if best.1 > enough {
            break;
        }
        if at_left < at_right {
            low = left;
        } else {
            high = right;
        }
    }
    Peak {
        at: 0.5 * (low + high),
        best,
    }
}

/// Most steps of Newton's method.
const MAX_NEWTON: usize = 80;

/// Root by Newton's method from `start`; bisection takes over where a step leaves the bracket from `low` to `high`.
/// `falling`: positive below the root. A step of `round_off` ends the search; `f` gives value and slope.
pub(crate) fn newton(
    [mut low, mut high]: [f64; 2],
    start: f64,
    falling: bool,
    round_off: impl Fn(f64) -> f64,
    f: impl Fn(f64) -> (f64, f64),
) -> f64 {
    let mut x = start;
    for _ in 0..MAX_NEWTON {
        let (value, slope) = f(x);
        if value == 0.0 {
            return x;
        }
        if (value > 0.0) == falling {
            low = x;
        } else {
            high = x;
        }
        let mut next = x - value / slope;
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        if (next - x).abs() <= round_off(next) {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falsi_finds_a_crossing_to_round_off() {
        let f = |t: f64| (t - 0.3).mul_add(1.0, (t - 0.3).powi(3));
        assert!((falsi(1.0, f(0.0), f(1.0), f) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn every_finder_comes_to_the_root_of_two() {
        let f = |x: f64| x * x - 2.0;
        let side = |x: f64| f(x).total_cmp(&0.0);
        let found = [
            bisect(1.0, 2.0, side),
            illinois((1.0, f(1.0)), (2.0, f(2.0)), f),
            falsi(2.0, f(0.0), f(2.0), f),
            newton(
                [1.0, 2.0],
                1.1,
                false,
                |x| f64::EPSILON * x,
                |x| (f(x), 2.0 * x),
            ),
        ];
        for root in found {
            assert!((root - 2.0_f64.sqrt()).abs() < 1e-12, "{root}");
        }
    }

    #[test]
    fn golden_sections_come_to_the_maximum() {
        let f = |x: f64| 2.0 - (x - 0.3).powi(2);
        let peak = golden_section((0.0, 1.0), 80, f64::INFINITY, f);
        // A parabola is flat over the root of what a double resolves.
        assert!((peak.at - 0.3).abs() < 1e-7, "{}", peak.at);
        assert!((peak.best.1 - 2.0).abs() < 1e-15, "{}", peak.best.1);
        let soon = golden_section((0.0, 1.0), 80, 1.9, f).best;
        assert!(soon.1 > 1.9 && soon.1 < 2.0 - 1e-6, "{soon:?}");
    }

    #[test]
    fn newton_keeps_to_its_bracket() {
        // From here the first step of Newton's method would go far away.
        let root = newton(
            [0.0, 4.0],
            3.9,
            false,
            |_| 1e-14,
            |x| (libm::atan(x - 1.0), 1.0 / (1.0 + (x - 1.0).powi(2))),
        );
        assert!((root - 1.0).abs() < 1e-12, "{root}");
    }
}
