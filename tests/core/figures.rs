//! The relay loop of the paper's Figs. 3, 4 and 5: each claim holds on its own loop, and a check can fail.

use hysteron_core::explore::{ExploreInput, compute};
use hysteron_core::figures::{checks, figures};
use hysteron_core::plant::TransferFunction;
use hysteron_core::tuning::ultimate_gain;

#[test]
fn the_claims_of_figs_3_4_and_5_hold() {
    for figure in figures() {
        let data = compute(&figure.input).unwrap();
        let all = checks(figure.number, &figure.input, &data).unwrap();
        assert!(all.len() >= 3, "Fig. {}: {all:?}", figure.number);
        for check in all {
            assert!(check.holds, "Fig. {}: {}", figure.number, check.text);
        }
    }
}

#[test]
fn fig_5_costs_what_the_exact_cycle_says() {
    // Reference values of the third-order lag at eps = 0.1, solved to 15 digits elsewhere.
    let base = ExploreInput::default();
    let data = compute(&base).unwrap();
    let exact = data.exact.unwrap();
    assert!((exact.period / 4.787_671_942_045_41 - 1.0).abs() < 1e-9);
    let gain = ultimate_gain(base.relay.gain, exact.amplitude);
    let expected = 4.0 / (std::f64::consts::PI * 0.285_687_386_127_379);
    assert!((gain / expected - 1.0).abs() < 1e-9);
}

#[test]
fn a_check_fails_where_the_claim_is_wrong() {
    let failing = |number, input: &ExploreInput| {
        let data = compute(input).unwrap();
        let all = checks(number, input, &data).unwrap();
        all.iter().any(|c| !c.holds)
    };
    let mut input = ExploreInput::default();
    input.relay.hysteresis = 0.05;
    assert!(failing(5, &input), "less hysteresis is not more");
    let mut noisy = figures()[1].input.clone();
    noisy.relay.hysteresis = 0.001;
    assert!(
        failing(4, &noisy),
        "noise above the hysteresis adds switches"
    );
    let lag = ExploreInput {
        plant: TransferFunction::new(&[1.0], &[1.0, 1.0], 0.5),
        ..ExploreInput::default()
    };
    assert!(failing(3, &lag), "a first-order lag is no filter");
}

#[test]
fn harmonics_of_a_symmetric_cycle_are_odd_and_fall_with_the_plant() {
    let data = compute(&ExploreInput::default()).unwrap();
    let first = data.harmonics[0].amplitude;
    let share = |order: usize| data.harmonics[order - 1].amplitude / first;
    assert!(share(2) < 1e-12 && share(4) < 1e-12);
    // |P(3jw)/P(jw)|/3 for 1/(s+1)^3.
    let w = 2.0 * std::f64::consts::PI / data.exact.unwrap().period;
    let gain = |n: f64| (1.0 + (n * w).powi(2)).powf(-1.5);
    assert!((share(3) - gain(3.0) / gain(1.0) / 3.0).abs() < 1e-9);
    assert!(data.swing.last().unwrap()[1] > 0.28);
}

#[test]
fn a_fast_loop_is_told_in_as_many_digits_as_a_slow_one() {
    for (scale, period) in [(1.0, "4.788 s"), (1e-3, "0.004788 s"), (1e3, "4788 s")] {
        let mut input = ExploreInput::default();
        let order = input.plant.denominator.len() - 1;
        for (k, c) in input.plant.denominator.iter_mut().enumerate() {
            *c *= f64::powf(scale, (order - k) as f64);
        }
        let text = compute(&input).unwrap().text;
        assert!(
            text.to_string().contains(&format!("period {period}")),
            "{text}"
        );
        assert!(text.to_string().contains("amplitude 0.2857"), "{text}");
    }
}
