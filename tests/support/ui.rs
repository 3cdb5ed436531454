//! The app as a user works it: its window, its buttons, what it says and how it looks.

#![allow(dead_code, reason = "each test uses a part of these")]

use std::time::Duration;

use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions};
use hysteron::HysteronApp;

/// Rounds of waiting before a job counts as hung; each is [`WAIT`] long.
const ROUNDS: usize = 12_000;
const WAIT: Duration = Duration::from_millis(10);

/// The window of the pictures, points.
pub const WIDE: [f32; 2] = [1280.0, 800.0];
/// A narrow window, points.
pub const NARROW: [f32; 2] = [420.0, 800.0];

/// The app in its window.
pub type App = Harness<'static, HysteronApp>;

/// The app in a window of this size, on this page, after its first frame.
pub fn app(page: &str, size: [f32; 2]) -> App {
    let mut harness = Harness::builder()
        .with_size(egui::Vec2::from(size))
        .with_max_steps(16)
        .build_ui_state(
            |ui, app: &mut HysteronApp| app.frame_ui(ui),
            HysteronApp::at(page),
        );
    harness.step();
    harness
}

/// What the app says of itself: of all, and of the page in front.
pub fn state(harness: &App) -> serde_json::Value {
    harness.state().hook_state()
}

/// The answer of the page in front.
pub fn answer(harness: &App) -> String {
    state(harness)["answer"]
        .as_str()
        .expect("an answer")
        .to_owned()
}

/// Waits until nothing is computed any more and the result is on the screen.
pub fn finish(harness: &mut App) {
    harness.step();
    for _ in 0..ROUNDS {
        harness.step();
        if state(harness)["busy"] == false {
            // One frame takes the result, the next draws it with its sizes settled.
            harness.step();
            harness.step();
            return;
        }
        std::thread::sleep(WAIT);
    }
    panic!("the job did not end: {}", state(harness));
}

/// Clicks what has this label and waits for what follows.
pub fn click(harness: &mut App, label: &str) {
    harness.get_by_label(label).click();
    finish(harness);
}

/// Opens a link and waits until what it shows is there.
pub fn show(harness: &mut App, link: &str) {
    let ctx = harness.ctx.clone();
    let opened = harness.state_mut().open_link(&ctx, link);
    assert_eq!(opened, Ok(()), "{link}");
    finish(harness);
}

/// Types a text in place of what stands in the field with this label.
pub fn type_over(harness: &mut App, label: &str, text: &str) {
    harness.get_by_label(label).focus();
    harness.step();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.step();
    harness.get_by_label(label).type_text(text);
    harness.step();
    harness.step();
}

/// Compares with the picture in `tests/snapshots`. Software and hardware renderers differ in the smoothing
/// of edges: a few pixels in a thousand.
pub fn picture(harness: &mut App, name: &str) {
    let options = SnapshotOptions::new()
        .output_path("../tests/snapshots")
        .threshold(1.0)
        .max_failed_pixels(2000);
    harness.snapshot_options(name, &options);
}
