//! Functions of small numbers, to a few units of round-off: the flows of short pieces of motion are made of them.
//!
//! Power series, summed in pairs, so that the sums do not wait for each other.

/// Arguments up to which the exponential is its series, of a quarter of the argument.
const SMALL: f64 = 1.0;

/// `1/k!` from `k = 0`; the next term, `0.25^13/13!`, is below round-off.
const EXPONENTIAL: [f64; 13] = inverse_factorials(0, 1, 1.0);

/// Squared radians of a swing below which it is its series.
pub(super) const SHORT_SWING: f64 = 0.25;

/// Of the cosine, `(-1)^k / (2 k)!`, and of `sin(x)/x`, `(-1)^k / (2 k + 1)!`.
const COSINE: [f64; 8] = inverse_factorials(0, 2, -1.0);
const SINE: [f64; 8] = inverse_factorials(1, 2, -1.0);

/// `sign^k / (first + step k)!`
const fn inverse_factorials<const N: usize>(first: u32, step: u32, sign: f64) -> [f64; N] {
    let mut terms = [1.0; N];
    let (mut k, mut at) = (1, first);
    while k < N {
        let mut term = sign * terms[k - 1];
        let mut j = 0;
        while j < step {
            at += 1;
            j += 1;
            term /= at as f64;
        }
        terms[k] = term;
        k += 1;
    }
    terms
}

/// Sum of eight terms by Estrin's scheme.
fn eight(c: &[f64; 8], x: f64) -> f64 {
    let (x2, x4) = (x * x, x * x * (x * x));
    let low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
    let high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
    low + high * x4
}

/// `exp(x)`
pub(super) fn exp(x: f64) -> f64 {
    if x.abs() < SMALL {
        let c = &EXPONENTIAL;
        let x = 0.25 * x;
        let (x2, x4) = (x * x, x * x * (x * x));
        let low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
        let middle = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
        let high = (c[8] + c[9] * x) + (c[10] + c[11] * x) * x2;
        let fourth_root = low + (middle + (high + c[12] * x4) * x4) * x4;
        let square = fourth_root * fourth_root;
        square * square
    } else {
        libm::exp(x)
    }
}

/// `cos(omega h)` and `sin(omega h) / omega` in terms of `square = omega^2`, which may be negative, where
/// `square h^2` is below [`SHORT_SWING`].
pub(super) fn swing(square: f64, h: f64) -> (f64, f64) {
    let q = square * h * h;
    (eight(&COSINE, q), h * eight(&SINE, q))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_functions_are_right_to_round_off() {
        for k in -2000..=2000 {
            let x = f64::from(k) * 1e-3;
            assert!((exp(x) / libm::exp(x) - 1.0).abs() < 1.5e-15, "exp({x})");
            let angle = x.abs() * 0.249;
            let (cosine, sine) = swing(angle * angle, 1.0);
            assert!((cosine - libm::cos(angle)).abs() < 3e-16, "cos({angle})");
            assert!(
                (sine * angle - libm::sin(angle)).abs() < 2e-16,
                "sin({angle})"
            );
            let (cosine, sine) = swing(-angle * angle, 1.0);
            assert!((cosine - libm::cosh(angle)).abs() < 5e-16, "cosh({angle})");
            assert!(
                (sine * angle - libm::sinh(angle)).abs() < 3e-16,
                "sinh({angle})"
            );
        }
        assert!(exp(f64::NAN).is_nan());
    }
}
