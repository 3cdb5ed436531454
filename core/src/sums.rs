//! Sums over long series.

/// Sums that go on side by side, since each addition waits for the one before.
const LANES: usize = 8;

/// Sum of the products of two series, as far as both go.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len().min(b.len());
    let (a_parts, a_rest) = a[..length].as_chunks::<LANES>();
    let (b_parts, b_rest) = b[..length].as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (a, b) in a_parts.iter().zip(b_parts) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

/// Standard deviation about the mean; 0 of no values.
pub(crate) fn deviation(values: &[f64]) -> f64 {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt()
}

/// The values in the runs (first place and the place after the last of each) without their mean there; 0 elsewhere.
pub(crate) fn centred(values: &[f64], runs: &[(usize, usize)]) -> Vec<f64> {
    let used = || runs.iter().flat_map(|(from, to)| &values[*from..*to]);
    let mean = used().sum::<f64>() / used().count().max(1) as f64;
    let mut centred = vec![0.0; values.len()];
    for (from, to) in runs {
        for (c, v) in centred[*from..*to].iter_mut().zip(&values[*from..*to]) {
            *c = v - mean;
        }
    }
    centred
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_summed_as_far_as_both_go() {
        let a: Vec<f64> = (0..21).map(f64::from).collect();
        // Sum of squares up to n: n (n + 1) (2 n + 1) / 6.
        assert_eq!(dot(&a, &a), 2870.0);
        assert_eq!(dot(&a, &a[..19]), 2109.0);
        assert_eq!(dot(&a, &[]), 0.0);
    }
}
