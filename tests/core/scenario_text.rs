//! Relay loops as TOML: five ways to give a plant, and errors with their place.

use hysteron_core::scenario::{AnyScenario, Scenario, ScenarioError};
use nalgebra::Complex;

const RELAY: &str = "[relay]\ngain = 1.0\nhysteresis = 0.1\n";

fn read(plant: &str) -> Result<Scenario, ScenarioError> {
    Scenario::from_toml(&format!("[plant]\n{plant}\n{RELAY}"))
}

#[test]
fn five_ways_to_give_the_same_plant() {
    let exact = |w: f64| {
        let s = Complex::new(0.0, w);
        2.0 / (3.0 * s + 1.0) * Complex::from_polar(1.0, -0.5 * w)
    };
    for text in [
        "numerator = [2.0]\ndenominator = [3.0, 1.0]\ndead_time = 0.5",
        "formula = \"2 e^{-0.5s}/(3s+1)\"",
        "poles = [-0.3333333333333333333]\ngain = 0.6666666666666666667\ndead_time = 0.5",
        "gain = 2.0\ntime_constant = 3.0\ndead_time = 0.5",
        "a = [[-0.3333333333333333333]]\nb = [2.0]\nc = [0.3333333333333333333]\ndead_time = 0.5",
    ] {
        let scenario = read(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        for w in [0.01, 0.3, 5.0] {
            let error = (scenario.plant.response(w) - exact(w)).norm();
            assert!(error < 1e-13 * exact(w).norm(), "{text}: {error}");
        }
        let run = scenario.run().unwrap();
        assert!(run.settled(1e-6).is_some(), "{text}");
    }
}

#[test]
fn complex_poles_come_in_pairs() {
    let pair = read("poles = [[-1.0, 2.0], [-1.0, -2.0], -3]\ngain = 15.0").unwrap();
    assert!((pair.plant.dc_gain() - 1.0).abs() < 1e-14);
    let half = read("poles = [[-1.0, 2.0], -3.0]\ngain = 15.0").unwrap_err();
    assert!(half.to_string().contains("no conjugate"), "{half}");
}

#[test]
fn an_error_says_its_line() {
    let error =
        Scenario::from_toml("[plant]\nformula = \"1/s\"\n[relay]\ngain = 1.0\nhysterisis = 0.1\n")
            .unwrap_err();
    assert!(
        matches!(error, ScenarioError::Text { line: 5, .. }),
        "{error}"
    );
    let error = Scenario::from_toml("[plant\n").unwrap_err();
    assert!(
        matches!(error, ScenarioError::Text { line: 1, .. }),
        "{error}"
    );
    for (plant, part) in [
        ("", "no plant is given"),
        ("formula = \"1/s\"\na = [[1.0]]", "several ways"),
        ("numerator = [1.0]", "not complete"),
        ("formula = \"1/(s+\"", "column"),
        ("formula = \"1/s\"\ngain = 2.0", "'gain' does not belong"),
        (
            "numerator = [1.0, 1.0]\ndenominator = [1.0, 1.0]",
            "must be lower",
        ),
        ("a = [[1.0, 2.0]]\nb = [1.0]\nc = [1.0]", "row of A"),
        (
            "gain = 1.0\ntime_constant = 1.0\ndead_time = -1.0",
            "dead time -1 s",
        ),
    ] {
        let error = read(plant).unwrap_err().to_string();
        assert!(error.contains(part), "{plant}: {error}");
    }
}

#[test]
fn the_scenarios_that_come_with_it_run() {
    for (name, text) in [
        (
            "fig-3",
            include_str!("../../assets/scenarios/fig-3-third-order-lag.toml"),
        ),
        (
            "fig-4",
            include_str!("../../assets/scenarios/fig-4-noise.toml"),
        ),
        (
            "fig-5",
            include_str!("../../assets/scenarios/fig-5-more-hysteresis.toml"),
        ),
        (
            "fails",
            include_str!("../../assets/scenarios/describing-function-fails.toml"),
        ),
        (
            "sliding",
            include_str!("../../assets/scenarios/sliding.toml"),
        ),
        (
            "uneven",
            include_str!("../../assets/scenarios/asymmetric-first-order.toml"),
        ),
    ] {
        let run = Scenario::from_toml(text)
            .unwrap_or_else(|e| panic!("{name}: {e}"))
            .run()
            .unwrap();
        assert!(
            run.time.len() >= 2000 && run.cut.is_none(),
            "{name} {}",
            run.time.len()
        );
        assert!(run.rises.len() > 5, "{name}");
        assert_eq!(run.sliding.is_empty(), name != "sliding", "{name}");
    }
}

#[test]
fn noise_is_for_every_controller() {
    let run = |std_dev: &str| {
        format!(
            "[run]\nduration = 8.0\nstep = 0.1\nnoise = {{ std_dev = {std_dev}, interval = 0.05 }}\n"
        )
    };
    for (name, text) in [
        (
            "on-off",
            "[plant]\nformula = \"1/(s+1)^3\"\n[relay]\ngain = 1.0\ndead_zone = 0.1\nmin_on = 0.1\n",
        ),
        (
            "in z",
            "[plant]\nnumerator = [0.1]\ndenominator = [1.0, -0.9]\nsampling_time = 0.1\n[relay]\ngain = 1.0\n",
        ),
        (
            "servo",
            "[servo]\ninertia = 1e-3\nfriction = { coulomb = 0.03 }\ncontroller = { proportional = 4.0 }\nreference = 1.0\n",
        ),
    ] {
        let outputs = |run: &str| match AnyScenario::from_toml(&format!("{text}{run}")).unwrap() {
            AnyScenario::OnOff(scenario) => scenario.run().unwrap().output,
            AnyScenario::Servo(scenario) => scenario.run().unwrap().position,
            other => panic!("{other:?}"),
        };
        let (noisy, calm) = (
            outputs(&run("0.2")),
            outputs("[run]\nduration = 8.0\nstep = 0.1\n"),
        );
        assert_eq!(noisy.len(), calm.len(), "{name}");
        assert_ne!(noisy, calm, "{name}");
        assert_eq!(noisy, outputs(&run("0.2")), "{name}");
        let wrong = AnyScenario::from_toml(&format!("{text}{}", run("-1.0"))).unwrap_err();
        assert!(
            wrong.to_string().contains("noise std_dev is -1"),
            "{name}: {wrong}"
        );
    }
    let keys = hysteron_core::scenario::keys_of_run(&run("0.2"));
    assert_eq!(keys, ["duration", "noise", "step"]);
}
