//! The page on the hidden gap, as a user works it.

use crate::support::ui::{
    App, NARROW, WIDE, answer, app, click, finish, picture, show, state, texts,
};
use egui_kittest::kittest::Queryable as _;

/// The page, standing still.
fn page(size: [f32; 2]) -> App {
    let mut harness = app("backlash", size);
    click(&mut harness, "Pause");
    harness
}

#[test]
fn the_page_opens_on_a_drive_whose_gap_the_motor_finds() {
    let mut harness = page(WIDE);
    let found = state(&harness);
    assert_eq!(found["direction"], "against");
    let gap = found["gap_estimated"].as_f64().expect("a gap");
    assert!((gap / 0.019 - 1.0).abs() < 0.05, "{found}");
    assert!(
        answer(&harness).contains("(true: 19.00)"),
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
fn figs_7_8_10_11_and_12_check_their_claims_on_screen() {
    let mut harness = page(WIDE);
    for number in [7, 8, 10, 11, 12] {
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

/// The blocks of Fig. 8 stand still with the load met, and go back to the masses.
#[test]
fn fig_8_lights_its_blocks_up_where_the_load_is_met() {
    let mut harness = app("start", WIDE);
    // Next to the end of the gap, and where it is first met.
    show(
        &mut harness,
        "v1;backlash;backlash.structure=true;backlash.run.start.x1=-0.0094;backlash.paused=0.0425",
    );
    let said = texts(&harness);
    assert!(said.iter().any(|t| t == "Momentum"), "{said:?}");
    picture(&mut harness, "backlash_blocks");
    click(&mut harness, "Blocks");
    let said = texts(&harness);
    assert!(said.iter().any(|t| t == "Phase portrait"), "{said:?}");
}

#[test]
fn the_direction_of_drift_tells_friction_from_delay() {
    let mut harness = page(WIDE);
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
    let mut harness = page(WIDE);
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
    let mut harness = page(WIDE);
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
    let mut harness = page(NARROW);
    assert_eq!(state(&harness)["direction"], "against");
    click(&mut harness, "From the start");
    picture(&mut harness, "backlash_narrow");
}

#[test]
fn the_verdict_on_a_measured_gap_is_a_sentence() {
    let mut harness = app("start", WIDE);
    show(&mut harness, "v1;backlash;backlash.file=drive-10");
    let texts = texts(&harness);
    let verdict = texts.iter().find(|t| t.contains("traverses agree"));
    let verdict = verdict.expect("a verdict on the gap");
    assert!(verdict.starts_with("The gap is 11.9"), "{verdict}");
    assert!(verdict.contains(" mrad: "), "{verdict}");
    assert!(verdict.ends_with(" %."), "{verdict}");
}
