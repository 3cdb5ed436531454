//! What becomes of a loop: one word for it, and a sentence that holds.

use crate::support::shared::shared;
use hysteron_core::limit_cycle::{LongRunResult, Outcome, Prediction, predict};
use hysteron_core::scenario::Scenario;
use hysteron_core::tuning::stability_limits;

/// Prediction and outcome of a loop in a file.
fn outcome(text: &str) -> (Prediction, LongRunResult) {
    let scenario = Scenario::from_toml(text).unwrap();
    let prediction = predict(&scenario.plant, &scenario.relay).unwrap();
    let result = scenario.long_run(&prediction).unwrap();
    (prediction, result)
}

/// A loop with this plant and relay.
fn of(plant: &str, relay: &str) -> (Prediction, LongRunResult) {
    outcome(&format!("[plant]\n{plant}\n[relay]\n{relay}\n"))
}

#[track_caller]
fn check(plant: &str, relay: &str, expected: Outcome, phrase: &str) -> LongRunResult {
    let (_, result) = of(plant, relay);
    assert_eq!(
        result.outcome,
        Some(expected),
        "{plant} {relay}: {}",
        result.text
    );
    assert!(
        result.text.to_string().contains(phrase),
        "{plant} {relay}: {}",
        result.text
    );
    result
}

#[test]
fn a_loop_that_oscillates() {
    // The reference table's row.
    let plant = "formula = \"1/(s+1)^3\"";
    let found = check(
        plant,
        "gain = 1\nhysteresis = 0.1",
        Outcome::LimitCycle,
        "period 4.788 s",
    );
    let cycle = found.cycle.unwrap();
    assert!((cycle.period / 4.787_671_942_045_41 - 1.0).abs() < 1e-9);
    assert_eq!(cycle.stable, Some(true));
}

#[test]
fn a_loop_that_comes_to_rest_or_slides() {
    let lag = "formula = \"1/(s+1)\"";
    check(
        lag,
        "gain = 1\nhysteresis = 1.5",
        Outcome::Rest,
        "goes to 1.000",
    );
    check(lag, "gain = 1", Outcome::Sliding, "where it comes to rest");
    // Relative degree two: the switches have a limit.
    check(
        "formula = \"1/(s*(s+1))\"",
        "gain = 1",
        Outcome::Sliding,
        "ever faster",
    );
}

#[test]
fn an_unstable_plant_that_the_relay_cannot_hold_is_unbounded_and_one_that_it_can_is_not() {
    let growing = "formula = \"1/(s^2-0.2s+1)\"";
    check(
        growing,
        "gain = 1\nhysteresis = 0.3",
        Outcome::Unbounded,
        "without bound",
    );
    // exp(L) must be less than 2 for exp(-L s)/(s - 1).
    for (dead_time, expected) in [
        (0.5, Outcome::LimitCycle),
        (0.68, Outcome::LimitCycle),
        (0.7, Outcome::Unbounded),
    ] {
        let plant = format!("formula = \"1/(s-1)\"\ndead_time = {dead_time}");
        check(&plant, "gain = 1", expected, "");
    }
}

#[test]
fn plants_on_the_limit_of_stability_grow_keep_what_they_have_or_settle() {
    let double = "formula = \"1/s^2\"";
    check(
        double,
        "gain = 1\nhysteresis = 0.1",
        Outcome::Unbounded,
        "from cycle to cycle",
    );
    check(
        "formula = \"1/((s^2+1)*(s+1))\"",
        "gain = 1\nhysteresis = 0.1",
        Outcome::Unbounded,
        "without bound",
    );
    let found = check(double, "gain = 2", Outcome::Continuum, "one of a continuum")
        .cycle
        .unwrap();
    // Two parabolas of height a and duration sqrt(2a/k) on either side: period 4 sqrt(2a/k).
    let period = 4.0 * (2.0 * found.amplitude / 2.0_f64).sqrt();
    assert!((found.period / period - 1.0).abs() < 1e-9, "{found:?}");
    check(
        "formula = \"1/s\"",
        "gain = 1\nhysteresis = 0.1",
        Outcome::LimitCycle,
        "period 0.4000 s",
    );
}

#[test]
fn a_run_that_leaves_an_unstable_cycle_slowly_has_not_settled_into_it() {
    let plant = "formula = \"s/(s^2+0.1s+1)\"";
    let (prediction, result) = of(plant, "gain = 1\nhysteresis = 0.1");
    let multiplier = prediction.exact[0].multiplier.unwrap();
    assert!((multiplier - 1.000_265_7).abs() < 1e-6, "{multiplier}");
    // After 17,000 cycles it comes to rest at 0, the gain at frequency 0.
    assert_eq!(result.outcome, Some(Outcome::Rest), "{}", result.text);
    assert!(
        result.cycle.is_none() && result.text.to_string().contains("cycles to get there"),
        "{}",
        result.text
    );
}

#[test]
fn noise_below_and_above_the_hysteresis() {
    let run =
        "[run]\nduration = 60\nstep = 0.01\nnoise = { std_dev = 0.02, interval = 0.01, seed = 3 }";
    for (hysteresis, expected, phrase) in [
        (
            0.1,
            Outcome::NoisyLimitCycle,
            "Without noise: period 4.788 s",
        ),
        (0.005, Outcome::Chatter, "larger than the noise"),
        (1.5, Outcome::Rest, "noise"),
    ] {
        let (_, result) = outcome(&format!(
            "[plant]\nformula = \"1/(s+1)^3\"\n[relay]\ngain = 1\nhysteresis = {hysteresis}\n{run}\n"
        ));
        assert_eq!(
            result.outcome,
            Some(expected),
            "{hysteresis}: {}",
            result.text
        );
        assert!(
            result.text.to_string().contains(phrase),
            "{hysteresis}: {}",
            result.text
        );
        assert_eq!(
            result.scatter.is_some(),
            expected != Outcome::Rest,
            "{hysteresis}"
        );
    }
}

/// The text of a file beside the project.
fn shared_text(path: &str) -> Option<String> {
    shared(path).map(|bytes| String::from_utf8(bytes).unwrap())
}

#[test]
fn loops_of_an_independent_check_end_as_it_says() {
    for (file, expected, phrase) in [
        ("h22_dintegr_h", Outcome::Unbounded, "without bound"),
        ("h07_undamped", Outcome::Unbounded, "without bound"),
        ("h10_unst_L070", Outcome::Unbounded, "unstable"),
        ("h20_cook", Outcome::Unbounded, "unstable"),
        (
            "h21_dintegr",
            Outcome::Continuum,
            "each start leads to its own",
        ),
        ("h05_zerogain", Outcome::Rest, "cycles to get there"),
        (
            "a20_sliding_CB2",
            Outcome::Sliding,
            "where it comes to rest",
        ),
        ("h03_condstable", Outcome::Sliding, "slides"),
        ("fig-4-noise", Outcome::NoisyLimitCycle, "in the noise"),
        ("noise1", Outcome::Chatter, "chatters"),
    ] {
        let Some(text) = shared_text(&format!("theory/{file}.toml")) else {
            return;
        };
        let (_, result) = outcome(&text);
        assert_eq!(result.outcome, Some(expected), "{file}: {}", result.text);
        assert!(
            result.text.to_string().contains(phrase),
            "{file}: {}",
            result.text
        );
    }
}

#[test]
fn the_describing_function_is_judged_by_what_happens() {
    let said = |plant: &str, relay: &str| {
        let scenario =
            Scenario::from_toml(&format!("[plant]\n{plant}\n[relay]\n{relay}\n")).unwrap();
        let prediction = predict(&scenario.plant, &scenario.relay).unwrap();
        let outcome = scenario.long_run(&prediction).unwrap().outcome.unwrap();
        prediction.trust_after(&scenario.plant, &scenario.relay, outcome)
    };
    // It sees nothing and there is nothing: it slides.
    assert!(said("formula = \"1/(s+1)\"", "gain = 1").reliable);
    // A continuum, 2 pi sqrt(pi a/(4k)) for 4 sqrt(2a/k).
    let double = said("formula = \"1/s^2\"", "gain = 1");
    let error = 2.0 * std::f64::consts::PI * (std::f64::consts::PI / 4.0_f64).sqrt()
        / 32.0_f64.sqrt()
        - 1.0;
    assert!(
        (double.period_error.unwrap() - error).abs() < 1e-9,
        "{double:?}"
    );
    assert!(double.reliable);
    // It predicts a cycle of 4.8 s that is none.
    let late = said("formula = \"1/(s-1)\"\ndead_time = 0.7", "gain = 1");
    assert!(
        !late.reliable && late.text.to_string().contains("no exact cycle"),
        "{}",
        late.text
    );
}

#[test]
fn the_unstable_cycles_of_a_dead_time_have_no_gaps() {
    let (prediction, _) = of("formula = \"2*e^{-3s}/((150s+1)*(8s+1))\"", "gain = 0.5");
    let mut exact: Vec<f64> = prediction
        .exact
        .iter()
        .map(|c| 3.0 / c.durations[0])
        .collect();
    exact.sort_by(f64::total_cmp);
    // The n-th has n pairs of switches within the dead time, but for the plant's own lag.
    for (n, ratio) in exact.iter().enumerate().skip(1) {
        assert!((ratio - 2.0 * n as f64).abs() < 0.1, "{n}: {ratio}");
    }
    assert!(exact.len() >= 39, "{}", exact.len());
}

#[test]
fn no_gain_is_told_by_a_continuum_or_a_relay_that_slides() {
    let (_, continuum) = of("formula = \"1/s^2\"", "gain = 1");
    assert!(continuum.cycle.is_some() && continuum.of_two_levels().is_none());
    let (_, sliding) = outcome(include_str!("../../assets/scenarios/sliding.toml"));
    assert!(sliding.slides > 0.0 && sliding.of_two_levels().is_none());
    let (_, cycle) = of("formula = \"1/(s+1)^3\"", "gain = 1\nhysteresis = 0.1");
    assert!(cycle.of_two_levels().is_some());
}

#[test]
fn a_loop_without_limits_of_stability_is_said_to_be_what_it_is_at_every_gain() {
    for (formula, said) in [
        ("1/(s+1)", "stable at every gain"),
        ("s/(s^2+0.1s+1)", "stable at every gain"),
        ("1/((s^2+1)*(s+1))", "no gain makes the loop stable"),
        ("1/(s^2-0.2s+1)", "no gain makes the loop stable"),
        ("1/s^2", "at the limit of stability"),
    ] {
        let text = format!("[plant]\nformula = \"{formula}\"\n[relay]\ngain = 1\n");
        let plant = Scenario::from_toml(&text).unwrap().plant;
        let limits = stability_limits(&plant);
        assert!(limits.lower.is_none() && limits.upper.is_none());
        assert!(
            limits.text().to_string().contains(said),
            "{formula}: {}",
            limits.text()
        );
    }
}

#[test]
fn the_scatter_in_noise_has_two_digits() {
    let (_, result) = outcome(include_str!("../../assets/scenarios/fig-4-noise.toml"));
    assert!(
        result
            .text
            .to_string()
            .contains("period 4.602 ± 0.077 s, amplitude 0.2639 ± 0.0075"),
        "{}",
        result.text
    );
}
