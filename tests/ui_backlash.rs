//! The page on the hidden gap, as a user works it.

use std::time::Duration;

use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions};
use hysteron::HysteronApp;

/// Rounds of waiting before a job counts as hung; each is [`WAIT`] long.
const ROUNDS: usize = 6000;
const WAIT: Duration = Duration::from_millis(10);

fn page(width: f32, height: f32) -> Harness<'static, HysteronApp> {
    let mut harness = Harness::builder()
        .with_size(egui::vec2(width, height))
        .with_max_steps(16)
        .build_ui_state(
            |ui, app: &mut HysteronApp| app.frame_ui(ui),
            HysteronApp::at("backlash"),
        );
    harness.step();
    harness.get_by_label("Pause").click();
    finish(&mut harness);
    harness
}

/// Waits until the simulation is on the screen.
fn finish(harness: &mut Harness<'static, HysteronApp>) {
    harness.step();
    for _ in 0..ROUNDS {
        harness.step();
        if state(harness)["busy"] == false {
            harness.step();
            return;
        }
        std::thread::sleep(WAIT);
    }
    panic!("the simulation did not end: {}", state(harness));
}

fn state(harness: &Harness<'static, HysteronApp>) -> serde_json::Value {
    harness.state().hook_state()["backlash"].clone()
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

fn answer(harness: &Harness<'static, HysteronApp>) -> String {
    state(harness)["answer"]
        .as_str()
        .expect("an answer")
        .to_owned()
}

#[test]
fn the_page_opens_on_a_drive_whose_gap_the_motor_finds() {
    let mut harness = page(1280.0, 800.0);
    let found = state(&harness);
    assert_eq!(found["direction"], "against");
    let gap = found["gap_estimated"].as_f64().expect("a gap");
    assert!((gap / 0.019 - 1.0).abs() < 0.05, "{found}");
    assert!(
        answer(&harness).contains("True: 19.00 mrad"),
        "{}",
        answer(&harness)
    );
    // Play may have moved the clock by a few frames.
    click(&mut harness, "From the start");
    picture(&mut harness, "backlash");
    // The first event is the first switch, at eps J/(k(1 + a) - c) after the start.
    click(&mut harness, "Step");
    let clock = state(&harness)["clock"].as_f64().expect("a time");
    assert!(
        (clock / (0.5 * 8.8e-4 / 0.62) - 1.0).abs() < 0.01,
        "{clock}"
    );
}

#[test]
fn figs_7_10_11_and_12_check_their_claims_on_screen() {
    let mut harness = page(1280.0, 800.0);
    for number in [7, 10, 11, 12] {
        click(&mut harness, &format!("Fig. {number}"));
        let state = state(&harness);
        let checks = state["checks"].as_array().expect("checks");
        assert!(
            checks.len() >= 3 && checks.iter().all(|c| c == true),
            "{state}"
        );
        picture(&mut harness, &format!("backlash_fig_{number}"));
    }
}

#[test]
fn the_direction_of_drift_tells_friction_from_delay() {
    let mut harness = page(1280.0, 800.0);
    for (button, direction, words) in [
        ("friction alone", "against", "friction outweighs delay"),
        ("delay alone", "with", "delay outweighs friction"),
        ("neither", "nowhere", "stays where it is"),
    ] {
        click(&mut harness, button);
        let state = state(&harness);
        assert_eq!(state["direction"], direction, "{state}");
        assert!(
            state["lesson"].as_str().is_some_and(|l| l.contains(words)),
            "{state}"
        );
    }
}

#[test]
fn a_measured_drifting_test_shows_the_same_with_its_data() {
    let mut harness = page(1280.0, 800.0);
    click(&mut harness, "Open drive-10");
    let found = state(&harness);
    assert_eq!(found["file"], "drive-10");
    let gap = found["gap_estimated"].as_f64().expect("a gap");
    assert!((gap / 0.012 - 1.0).abs() < 0.05, "{found}");
    picture(&mut harness, "backlash_drive_10");
    let ctx = harness.ctx.clone();
    harness
        .state_mut()
        .open(&ctx, "notes.csv", b"this is no measurement\n");
    finish(&mut harness);
    let after = state(&harness);
    assert_eq!(after["file"], "drive-10", "the open measurement stays");
    let message = after["message"].as_str().expect("a sentence");
    assert_eq!(message.lines().count(), 1, "{message}");
    click(&mut harness, "Back to the simulation");
    assert_eq!(state(&harness)["file"], serde_json::Value::Null);
    assert_eq!(state(&harness)["direction"], "against");
}

#[test]
fn a_proposed_test_is_taken_over() {
    let mut harness = page(1280.0, 800.0);
    click(&mut harness, "Design a drifting test");
    harness
        .get_by_label("Propose a drifting test")
        .scroll_to_me();
    finish(&mut harness);
    click(&mut harness, "Propose a drifting test");
    harness.get_by_label_contains("The cycle swings over");
    let found = state(&harness);
    assert!(found["gap_by_positions"].as_f64().is_some(), "{found}");
    picture(&mut harness, "backlash_design");
}

#[test]
fn a_narrow_window_shows_the_same_drive() {
    let mut harness = page(420.0, 800.0);
    assert_eq!(state(&harness)["direction"], "against");
    click(&mut harness, "From the start");
    picture(&mut harness, "backlash_narrow");
}
