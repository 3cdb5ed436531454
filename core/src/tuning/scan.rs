//! Frequencies at which something happens: a scan that is wide enough by bounds on poles and zeros.

use std::cmp::Ordering;

use num_complex::Complex;

use crate::root::bisect;

/// Points of a scan, per decade.
const PER_DECADE: f64 = 300.0;

/// Most decades of a scan: no plant is followed further.
const MAX_DECADES: f64 = 16.0;

/// How far beyond its poles, zeros and dead time a plant is followed, on either side.
const MARGIN: f64 = 100.0;

/// Value of a polynomial, highest power first, at `jw`.
pub(super) fn horner(polynomial: &[f64], omega: f64) -> Complex<f64> {
    let s = Complex::new(0.0, omega);
    polynomial
        .iter()
        .fold(Complex::new(0.0, 0.0), |acc, c| acc * s + *c)
}

/// Product of two polynomials.
pub(super) fn product(p: &[f64], q: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; (p.len() + q.len()).saturating_sub(1)];
    for (i, a) in p.iter().enumerate() {
        for (j, b) in q.iter().enumerate() {
            out[i + j] += a * b;
        }
    }
    out
}

/// Without zeros at either end, so that first and last coefficient are not 0.
fn trimmed(polynomial: &[f64]) -> &[f64] {
    let first = polynomial.iter().position(|c| *c != 0.0);
    let last = polynomial.iter().rposition(|c| *c != 0.0);
    match (first, last) {
        (Some(a), Some(b)) => &polynomial[a..=b],
        _ => &[],
    }
}

/// Fujiwara's bound: no root of the polynomial is larger.
fn upper<'a>(mut coefficients: impl Iterator<Item = &'a f64>) -> f64 {
    let Some(lead) = coefficients.next() else {
        return 0.0;
    };
    coefficients
        .enumerate()
        .map(|(i, c)| libm::pow((c / lead).abs(), 1.0 / (i + 1) as f64))
        .fold(0.0, f64::max)
        * 2.0
}

/// Lowest and highest frequency, rad/s, between which the roots of `polynomials` and a dead time make a
/// response turn.
pub(super) fn range(polynomials: &[&[f64]], dead_time: f64) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    let mut note = |a: f64, b: f64| {
        if a.is_finite() && b.is_finite() && a > 0.0 && b > 0.0 {
            low = low.min(a);
            high = high.max(b);
        }
    };
    for polynomial in polynomials {
        let p = trimmed(polynomial);
        if p.len() > 1 {
            note(1.0 / upper(p.iter().rev()), upper(p.iter()));
        }
    }
    if dead_time > 0.0 {
        note(0.1 / dead_time, 0.2 / dead_time);
    }
    if high == 0.0 {
        (low, high) = (1.0, 1.0);
    }
    let (low, high) = (low / MARGIN, high * MARGIN);
    (low, high.min(low * libm::pow(10_f64, MAX_DECADES)))
}

/// Frequencies from `low` to `high`, evenly spaced by their logarithm.
pub(super) fn grid(low: f64, high: f64) -> Vec<f64> {
    let decades = libm::log10(high / low).max(0.0);
    let count = (decades * PER_DECADE).ceil().max(1.0);
    (0..=count as usize)
        .map(|i| low * libm::pow(10_f64, decades * i as f64 / count))
        .collect()
}

/// Frequencies at which `f` changes its sign, and whether it rises there.
pub(super) fn roots(frequencies: &[f64], f: impl Fn(f64) -> f64) -> Vec<(f64, bool)> {
    let mut found = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    for &w in frequencies {
        let value = f(w);
        if let Some((a, fa)) = before
            && fa * value < 0.0
        {
            found.push((crossing(a, w, fa > 0.0, &f), value > 0.0));
        }
        // A point exactly on the root belongs to the interval that ends behind it.
        if value != 0.0 && value.is_finite() {
            before = Some((w, value));
        }
    }
    found
}

/// Root of `f` between `a` and `b`; `positive` tells its sign at `a`.
pub(super) fn crossing(a: f64, b: f64, positive: bool, f: impl Fn(f64) -> f64) -> f64 {
    bisect(a, b, |x| {
        if (f(x) > 0.0) == positive {
            Ordering::Less
        } else {
            Ordering::Greater
        }
    })
}
