//! Short polynomials on `[0, 1]`, lowest power first, and the first time at which one rises above zero.

use crate::root::newton;

/// Terms of a polynomial: the Taylor series of a step whose rates reach [`super::flow::REACH`] fall to
/// round-off within them.
pub(super) const TERMS: usize = 18;

/// Coefficients, lowest power first; those from the length in use on are zero.
pub(super) type Polynomial = [f64; TERMS];

/// Value at `z`.
pub(super) fn value(c: &[f64], z: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * z + c)
}

/// `1/(k + 1)`: divisions are the slowest part of an integral.
static INVERSES: [f64; 2 * TERMS] = inverses();

const fn inverses() -> [f64; 2 * TERMS] {
    let mut table = [0.0; 2 * TERMS];
    let mut k = 0;
    while k < table.len() {
        table[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    table
}

/// Integral from 0 to `z`.
pub(super) fn integral(c: &[f64], z: f64) -> f64 {
    let sum = c
        .iter()
        .zip(&INVERSES)
        .rev()
        .fold(0.0, |sum, (c, inverse)| sum * z + c * inverse);
    sum * z
}

/// Integral of the square from 0 to `z`.
pub(super) fn integral_of_square(c: &[f64], z: f64) -> f64 {
    let mut terms = [0.0; TERMS];
    let mut power = 1.0;
    for (term, c) in terms.iter_mut().zip(c) {
        *term = c * power;
        power *= z;
    }
    let terms = &terms[..c.len().min(TERMS)];
    let mut sum = 0.0;
    for (i, a) in terms.iter().enumerate() {
        sum += a * a * INVERSES[2 * i];
        let mut mixed = 0.0;
        for (b, inverse) in terms[i + 1..].iter().zip(&INVERSES[2 * i + 1..]) {
            mixed += b * inverse;
        }
        sum += 2.0 * a * mixed;
    }
    sum * z
}

/// Halvings before a pair of crossings counts as a touch.
const MAX_DEPTH: u32 = 48;

/// First `z` in `[0, end]` at which the polynomial comes from 0 or below to above 0.
///
/// A polynomial that starts exactly at 0 begins by the sign of its first power that is not 0: an event
/// that has just been handled is not found again. One that starts above 0 and grows is found at once.
pub(super) fn first_rise(c: &[f64], end: f64) -> Option<f64> {
    let zeros = c.iter().take_while(|c| **c == 0.0).count();
    let c = &c[zeros..];
    let first = *c.first()?;
    if first > 0.0 && (zeros > 0 || c.get(1).is_none_or(|slope| *slope >= 0.0)) {
        return Some(0.0);
    }
    // Scaled to [0, 1], so that bounds are plain sums.
    let mut scaled = [0.0; TERMS];
    let mut power = 1.0;
    for (s, c) in scaled.iter_mut().zip(c) {
        *s = c * power;
        power *= end;
    }
    search(&scaled[..c.len()], 0).map(|s| s * end)
}

/// First rise on `[0, 1]`, the start excluded.
fn search(c: &[f64], depth: u32) -> Option<f64> {
    let (mut up, mut down, mut bend) = (0.0, 0.0, 0.0);
    for (k, c) in c.iter().enumerate().skip(1) {
        if *c > 0.0 {
            up += c;
        } else {
            down += c;
        }
        if k > 1 {
            bend += k as f64 * c.abs();
        }
    }
    let start = c[0];
    let sum = up + down;
    if start + up <= 0.0 || start + down > 0.0 || !sum.is_finite() {
        return None;
    }
    let slope = c.get(1).copied().unwrap_or(0.0);
    if slope.abs() > bend || depth >= MAX_DEPTH {
        return (start <= 0.0 && start + sum > 0.0).then(|| root(c));
    }
    let mut left = [0.0; TERMS];
    let mut power = 1.0;
    for (l, c) in left.iter_mut().zip(c) {
        *l = c * power;
        power *= 0.5;
    }
    let left = &mut left[..c.len()];
    if let Some(s) = search(left, depth + 1) {
        return Some(0.5 * s);
    }
    // The right half: the left one moved on by its length.
    for i in 0..left.len() - 1 {
        for k in (i..left.len() - 1).rev() {
            left[k] += left[k + 1];
        }
    }
    search(left, depth + 1).map(|s| 0.5 + 0.5 * s)
}

/// The zero of a polynomial that is not above 0 at 0 and above it at 1.
fn root(c: &[f64]) -> f64 {
    let sum: f64 = c.iter().sum();
    let start = c[0] / (c[0] - sum);
    newton(
        [0.0, 1.0],
        start,
        false,
        |s| 2.0 * f64::EPSILON * s,
        |s| {
            c.iter()
                .rev()
                .fold((0.0, 0.0), |(f, slope), c| (f * s + c, slope * s + f))
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(roots: &[f64]) -> Vec<f64> {
        let mut c = vec![1.0];
        for r in roots {
            c.insert(0, 0.0);
            for k in 0..c.len() - 1 {
                c[k] -= r * c[k + 1];
            }
        }
        c
    }

    #[test]
    fn the_first_rise_of_many_crossings_is_found() {
        // Falls at 0.2, rises at 0.5, falls at 0.7, rises at 0.9.
        let c = product(&[0.2, 0.5, 0.7, 0.9]);
        assert!((first_rise(&c, 1.0).unwrap() - 0.5).abs() < 1e-14);
        assert_eq!(first_rise(&c, 0.49), None);
        assert!((first_rise(&c, 0.8).unwrap() - 0.5).abs() < 1e-14);
    }

    #[test]
    fn a_narrow_double_crossing_is_not_missed() {
        // Above zero between 0.3 and 0.3 + 1e-7 only.
        let c: Vec<f64> = product(&[0.3, 0.300_000_1]).iter().map(|c| -c).collect();
        assert!((first_rise(&c, 1.0).unwrap() - 0.3).abs() < 1e-8);
    }

    #[test]
    fn an_event_at_the_start_counts_only_if_it_goes_on() {
        assert_eq!(first_rise(&[0.0, -1.0, 0.5], 1.0), None);
        assert!((first_rise(&[0.0, -1.0, 2.0], 1.0).unwrap() - 0.5).abs() < 1e-15);
        assert_eq!(first_rise(&[0.0, 0.0, 1.0], 1.0), Some(0.0));
        assert_eq!(first_rise(&[1e-18, 1.0], 1.0), Some(0.0));
        assert_eq!(first_rise(&[1e-18, -1.0], 1.0), None);
        assert_eq!(first_rise(&[0.0, 0.0], 1.0), None);
    }

    #[test]
    fn integrals_are_those_of_the_powers() {
        let c = [1.0, -2.0, 3.0];
        assert!((integral(&c, 0.5) - (0.5 - 0.25 + 0.125)).abs() < 1e-15);
        // (1 - 2z + 3z^2)^2 = 1 - 4z + 10z^2 - 12z^3 + 9z^4
        assert!((integral_of_square(&c, 1.0) - (1.0 - 2.0 + 10.0 / 3.0 - 3.0 + 1.8)).abs() < 1e-14);
    }
}
