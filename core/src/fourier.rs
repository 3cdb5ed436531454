//! The discrete Fourier transform of as many values as a power of two.

use std::f64::consts::TAU;

use num_complex::Complex64;

/// Replaces the values, whose number is a power of two, by their sums with `exp(-2 pi i j k / n)` for k = 0 .. n - 1;
/// of another number nothing is changed.
///
/// Cooley and Tukey (1965), "An algorithm for the machine calculation of complex Fourier series": values in the order
/// of their reversed bits, then pairs of halves, quarters and so on.
pub(crate) fn transform(values: &mut [Complex64]) {
    let count = values.len();
    if count < 2 || !count.is_power_of_two() {
        return;
    }
    let shift = usize::BITS - count.trailing_zeros();
    for place in 0..count {
        let other = place.reverse_bits() >> shift;
        if place < other {
            values.swap(place, other);
        }
    }
    // Each by itself: a product of turns would gather errors.
    let turn = |k: usize| {
        let (sine, cosine) = libm::sincos(-TAU * k as f64 / count as f64);
        Complex64::new(cosine, sine)
    };
    let turns: Vec<Complex64> = (0..count / 2).map(turn).collect();
    let mut half = 1;
    while half < count {
        let stride = count / (2 * half);
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            let turns = turns.iter().step_by(stride);
            for ((low, high), turn) in low.iter_mut().zip(high).zip(turns) {
                let turned = *high * turn;
                (*low, *high) = (*low + turned, *low - turned);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn it_is_the_sum_that_defines_it() {
        for bits in 0..9_u64 {
            let count = 1_usize << bits;
            let mut random = Random::new(bits);
            let values: Vec<Complex64> = (0..count)
                .map(|_| Complex64::new(random.normal(), random.normal()))
                .collect();
            let mut found = values.clone();
            transform(&mut found);
            for (k, found) in found.iter().enumerate() {
                let terms = values.iter().enumerate().map(|(j, value)| {
                    let angle = -TAU * (j * k % count) as f64 / count as f64;
                    value * Complex64::from_polar(1.0, angle)
                });
                let sum: Complex64 = terms.sum();
                assert!((found - sum).norm() < 1e-12 * count as f64, "{count}, {k}");
            }
        }
    }

    #[test]
    fn another_number_of_values_is_left_alone() {
        let mut values = vec![Complex64::new(1.0, 2.0); 3];
        transform(&mut values);
        assert_eq!(values, vec![Complex64::new(1.0, 2.0); 3]);
    }
}
