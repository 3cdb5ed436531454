//! The tuning page, as a user works it: from the relay to the tuned loop.

use std::time::Duration;

use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions};
use hysteron::HysteronApp;

/// Rounds of waiting before a job counts as hung; each is [`WAIT`] long.
const ROUNDS: usize = 3000;
const WAIT: Duration = Duration::from_millis(20);

fn page(width: f32, height: f32) -> Harness<'static, HysteronApp> {
    let mut harness = Harness::builder()
        .with_size(egui::vec2(width, height))
        .with_max_steps(16)
        .build_ui_state(
            |ui, app: &mut HysteronApp| app.frame_ui(ui),
            HysteronApp::at("tune"),
        );
    finish(&mut harness);
    harness
}

/// Waits until the experiment is on the screen.
fn finish(harness: &mut Harness<'static, HysteronApp>) {
    harness.step();
    for _ in 0..ROUNDS {
        harness.step();
        if state(harness)["busy"] == false {
            harness.step();
            harness.step();
            return;
        }
        std::thread::sleep(WAIT);
    }
    panic!("the experiment did not end: {}", state(harness));
}

fn state(harness: &Harness<'static, HysteronApp>) -> serde_json::Value {
    harness.state().hook_state()
}

fn answer(harness: &Harness<'static, HysteronApp>) -> String {
    state(harness)["answer"]
        .as_str()
        .expect("an answer")
        .to_owned()
}

fn click(harness: &mut Harness<'static, HysteronApp>, label: &str) {
    harness.get_by_label(label).click();
    finish(harness);
}

/// Software and hardware renderers differ in the smoothing of edges: a few pixels in a thousand.
fn picture(harness: &mut Harness<'static, HysteronApp>, name: &str) {
    let options = SnapshotOptions::new()
        .output_path("../tests/snapshots")
        .threshold(1.0)
        .max_failed_pixels(2000);
    harness.snapshot_options(name, &options);
}

/// The paper's third-order lag under the relay k = 1, eps = 0.1: period 4.788 s and amplitude 0.2857
/// exactly, hence `K_u = 4/(pi sqrt(a^2 - eps^2)) = 4.758`; true are 8 and `2 pi/sqrt(3) = 3.628` s.
#[test]
fn the_experiment_leads_step_by_step_from_the_relay_to_the_tuned_loop() {
    let mut harness = page(1280.0, 800.0);
    assert_eq!(
        answer(&harness),
        "It oscillates: period 4.788 s, amplitude 0.2857."
    );
    picture(&mut harness, "tune_relay");

    click(&mut harness, "Next step");
    let said = answer(&harness);
    for number in [
        "K_u = 4.758",
        "4.788 s",
        "8.000",
        "3.628 s",
        "40.5 % too low",
    ] {
        assert!(said.contains(number), "{number}: {said}");
    }
    picture(&mut harness, "tune_ultimate");

    for step in ["adaptation", "model", "rules", "loops"] {
        click(&mut harness, "Next step");
        assert_eq!(state(&harness)["step"], step);
        assert!(state(&harness)["message"].is_null());
    }
    assert!(
        answer(&harness).starts_with("A load leaves"),
        "{}",
        answer(&harness)
    );
    assert!(
        harness.query_by_label("Next step").is_none(),
        "there is no step after the last"
    );
    picture(&mut harness, "tune_loops");
}

#[test]
fn another_rule_changes_the_controller_and_the_loop() {
    let mut harness = page(1280.0, 800.0);
    click(&mut harness, "5 Rule");
    assert!(answer(&harness).starts_with("AMIGO PID"));
    click(&mut harness, "Ziegler-Nichols PI");
    let said = answer(&harness);
    // 0.45 K_u and T_u/1.2 of the relay's 4.758 and 4.788 s.
    assert!(
        said.contains("K = 2.141") && said.contains("Ti = 3.990 s"),
        "{said}"
    );
    picture(&mut harness, "tune_rules");
    click(&mut harness, "6 Before and after");
    let worse = answer(&harness);
    click(&mut harness, "5 Rule");
    click(&mut harness, "Tyreus-Luyben PI");
    click(&mut harness, "6 Before and after");
    assert_ne!(answer(&harness), worse, "the loop follows the rule");
}

#[test]
fn a_narrow_window_shows_the_same_experiment() {
    let mut harness = page(420.0, 800.0);
    assert!(answer(&harness).starts_with("It oscillates"));
    click(&mut harness, "6 Before and after");
    picture(&mut harness, "tune_narrow");
}
