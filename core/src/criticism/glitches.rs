//! Single values that stand alone, far off what their neighbours agree on: a sensor's, not the machine's.
//!
//! No body goes away from its path and back within two samples while the samples before and after show nothing of it. A
//! value that differs from the cubic through its neighbours by many times the noise, where these fit their own
//! neighbours without it, is put there (the idea of Hampel's filter: Hampel 1974, The influence curve).

/// Deviation from the neighbours, in standard deviations of the noise, of a glitch: none of ten million normal values
/// is as far off.
const FAR_OFF: f64 = 8.0;

/// Deviation of the neighbours from each other, likewise, and as a share of that of the value between them.
const AGREE: f64 = 4.0;
const SHARE: f64 = 0.15;

/// Share of the values that may be glitches; more are the way that the sensor is.
const FEW: f64 = 0.01;

/// Standard deviation of a value less the cubic through four neighbours, in that of the noise.
const CUBIC: f64 = 1.394;

/// Weights of the cubic at a value through those two and one before and one and two after it, and at a neighbour of one
/// that is left out, through the two beyond that neighbour and the two beyond the gap, from the far side.
const AT_VALUE: [f64; 4] = [-1.0 / 6.0, 4.0 / 6.0, 4.0 / 6.0, -1.0 / 6.0];
const AT_NEIGHBOUR: [f64; 4] = [-0.3, 1.0, 0.5, -0.2];

/// Puts the glitches among `values` where their neighbours say, and tells how many there were; none where they are many.
pub(super) fn mend(values: &mut [f64], noise: f64) -> usize {
    let found: Vec<(usize, f64)> = (3..values.len().saturating_sub(3))
        .filter_map(|i| Some(i).zip(expected(values, i, noise)))
        .collect();
    if found.len() as f64 > FEW * values.len() as f64 {
        return 0;
    }
    for (i, value) in &found {
        values[*i] = *value;
    }
    found.len()
}

/// What the neighbours say of a value that is a glitch.
fn expected(values: &[f64], i: usize, noise: f64) -> Option<f64> {
    let sum = |weights: [f64; 4], places: [usize; 4]| -> f64 {
        let terms = weights.iter().zip(places);
        terms.map(|(w, k)| w * values[k]).sum()
    };
    let said = sum(AT_VALUE, [i - 2, i - 1, i + 1, i + 2]);
    let off = (values[i] - said).abs();
    if off < FAR_OFF * CUBIC * noise {
        return None;
    }
    let agree = (AGREE * CUBIC * noise).min(SHARE * off);
    let before = values[i - 1] - sum(AT_NEIGHBOUR, [i - 3, i - 2, i + 1, i + 2]);
    let after = values[i + 1] - sum(AT_NEIGHBOUR, [i + 3, i + 2, i - 1, i - 2]);
    (before.abs() < agree && after.abs() < agree).then_some(said)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Random;

    fn noisy(signal: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut random = Random::new(11);
        let mut normal = || (0..12).map(|_| random.between(-0.5, 0.5)).sum::<f64>();
        (0..3000).map(|i| signal(f64::from(i)) + normal()).collect()
    }

    #[test]
    fn single_values_far_off_are_put_back() {
        let swing = |i: f64| 400.0 * libm::sin(0.02 * i);
        let truth = noisy(swing);
        let mut values = truth.clone();
        for (place, off) in [(500, 30.0), (1501, -16.0), (2222, 200.0)] {
            values[place] += off;
        }
        assert_eq!(mend(&mut values, 1.0), 3);
        for i in 0..3000 {
            assert!((values[i] - truth[i]).abs() < 6.0, "{i}");
        }
    }

    #[test]
    fn peaks_steps_and_kinks_of_a_motion_stay() {
        let motions: [fn(f64) -> f64; 4] = [
            |i| 500.0 * (i / 40.0 % 2.0 - 1.0).abs(),
            |i| 100.0 * f64::from(u8::from(i > 1000.0)),
            |i| 90.0 * libm::sin(0.9 * i),
            |i| 300.0 * libm::exp(-(i % 100.0) / 1.5),
        ];
        for (k, motion) in motions.iter().enumerate() {
            assert_eq!(mend(&mut noisy(motion), 1.0), 0, "motion {k}");
        }
    }
}
