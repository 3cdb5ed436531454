//! The pages, as a user sees and works them: pictures of fixed size, and the way from a file to the answer.

use std::time::Duration;

use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions};
use hysteron::HysteronApp;

/// Rounds of waiting before a job counts as hung; each is [`WAIT`] long.
const ROUNDS: usize = 6000;
const WAIT: Duration = Duration::from_millis(20);

/// The app in a window of 1280 x 800 points, on this page.
fn app(page: &str) -> Harness<'static, HysteronApp> {
    let app = HysteronApp::at(page);
    Harness::builder()
        .with_size(egui::vec2(1280.0, 800.0))
        .with_max_steps(16)
        .build_ui_state(|ui, app: &mut HysteronApp| app.frame_ui(ui), app)
}

/// Software and hardware renderers differ in the smoothing of edges: a few pixels in a thousand.
fn picture(harness: &mut Harness<'static, HysteronApp>, name: &str) {
    let options = SnapshotOptions::new()
        .output_path("../tests/snapshots")
        .threshold(1.0)
        .max_failed_pixels(2000);
    harness.snapshot_options(name, &options);
}

fn wait_until_idle(harness: &mut Harness<'static, HysteronApp>) {
    for _ in 0..ROUNDS {
        harness.step();
        if harness.state().hook_state()["busy"] == false {
            harness.step();
            return;
        }
        std::thread::sleep(WAIT);
    }
    panic!("the job did not end: {}", harness.state().hook_state());
}

fn error(harness: &Harness<'static, HysteronApp>) -> f64 {
    harness.state().hook_state()["error"]
        .as_f64()
        .expect("an error on screen")
}

#[test]
fn the_welcome_of_compare_offers_three_measurements() {
    let mut harness = app("compare");
    harness.step();
    for id in ["drive-02", "drive-12", "process-02"] {
        harness.get_by_label(&format!("Open {id}"));
    }
    picture(&mut harness, "compare_welcome");
}

#[test]
fn adding_coulomb_friction_to_drive_02_lowers_the_error_to_the_noise() {
    let mut harness = app("compare");
    harness.step();
    harness.get_by_label("Open drive-02").click();
    harness.step();
    assert_eq!(
        harness.state().hook_state()["busy"],
        true,
        "the job runs beside the window"
    );
    wait_until_idle(&mut harness);
    let before = error(&harness);
    harness.get_by_label("Add Coulomb friction").click();
    harness.step();
    assert_eq!(
        error(&harness),
        before,
        "the last result stays while the next is computed"
    );
    wait_until_idle(&mut harness);
    let after = error(&harness);
    assert!(
        before > 2.0,
        "the baseline should miss by far more than the noise, was {before}"
    );
    assert!(
        after < 1.2,
        "the noise floor should be reached, was {after} after {before}"
    );
    picture(&mut harness, "compare_drive_02");

    harness.get_by_label("Take back Coulomb friction").click();
    harness.step();
    harness.step();
    assert_eq!(
        error(&harness),
        before,
        "undo shows the stored step at once"
    );
    assert_eq!(harness.state().hook_state()["busy"], false);
}

#[test]
fn a_bad_file_gives_one_sentence_and_loses_nothing() {
    let mut harness = app("compare");
    harness.step();
    harness.get_by_label("Open drive-02").click();
    harness.step();
    let ctx = harness.ctx.clone();
    harness
        .state_mut()
        .open(&ctx, "notes.csv", b"this is no measurement\n");
    harness.step();
    let state = harness.state().hook_state();
    assert_eq!(state["file"], "drive-02", "the open measurement stays");
    let message = state["message"].as_str().expect("a sentence");
    assert_eq!(message.lines().count(), 1, "{message}");
}

#[test]
fn explore_opens_on_an_oscillating_loop() {
    let mut harness = app("explore");
    harness.step();
    harness.step();
    harness.get_by_label_contains("It oscillates: period 4.788 s");
    picture(&mut harness, "explore");
}

#[test]
fn every_page_draws_itself_and_says_what_it_shows() {
    for id in HysteronApp::default().page_ids() {
        let mut harness = app(id);
        harness.step();
        harness.step();
        let state = harness.state().hook_state();
        assert_eq!(state["page"], id);
        assert!(state[id]["busy"].is_boolean(), "{id}: {state}");
    }
}

#[test]
fn the_parameter_map_fills_and_a_click_sets_the_loop() {
    let mut harness = app("maps");
    harness.step();
    wait_until_idle(&mut harness);
    let state = harness.state().hook_state();
    assert_eq!(state["share"], 1.0);
    assert_eq!(state["message"], serde_json::Value::Null);
    picture(&mut harness, "maps");
    harness.get_by_label("Show this loop in Explore").click();
    harness.step();
    harness.step();
    assert_eq!(harness.state().hook_state()["page"], "explore");
    harness.get_by_label_contains("It oscillates: period 4.788 s");
}
