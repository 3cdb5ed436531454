//! The page on the hidden gap, as a user works it.

use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions};
use hysteron::HysteronApp;

/// Frames before a simulation counts as hung.
const FRAMES: usize = 20_000;

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
    for _ in 0..FRAMES {
        harness.step();
        if state(harness)["busy"] == false {
            harness.step();
            return;
        }
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

#[test]
fn the_page_opens_on_a_drive_that_drifts_through_its_gap() {
    let mut harness = page(1280.0, 800.0);
    assert_eq!(state(&harness)["direction"], "against");
    // Play may have moved the clock by a few frames.
    click(&mut harness, "From the start");
    picture(&mut harness, "backlash");
}
