//! The app as a user works it: its window, its buttons, what it says and how it looks.

#![allow(dead_code, reason = "each test uses a part of these")]

use std::path::PathBuf;
use std::time::Duration;

use egui::epaint::{ClippedShape, Shape};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotOptions};
use hysteron::HysteronApp;

/// Rounds of waiting before a job counts as hung; each is [`WAIT`] long.
const ROUNDS: usize = 60_000;
const WAIT: Duration = Duration::from_millis(10);

/// The window of the pictures, points.
pub const WIDE: [f32; 2] = [1280.0, 800.0];
/// A narrow window, points.
pub const NARROW: [f32; 2] = [420.0, 800.0];

/// A window so tall that nothing is below the fold.
pub const TALL: [f32; 2] = [1600.0, 2400.0];

/// A file that is let go over the window.
#[derive(Debug)]
pub struct Dropped(pub PathBuf, pub Vec<u8>);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Ok(self.1.clone())
    }
}

/// Where the app can be, so that all its pages, their steps, and what they say in several cases are seen.
pub const PLACES: [&str; 50] = [
    "v1;mystery",
    "v1;mystery;mystery.by_hand=true;mystery.experiment=relay",
    "v1;start",
    "v1;lessons",
    "v1;explore",
    "v1;explore;explore.figure=3",
    "v1;explore;explore.figure=4",
    "v1;explore;explore.figure=5",
    "v1;explore;explore.margin=true;loop.relay.hysteresis=0.5",
    "v1;explore;loop.relay.hysteresis=0",
    "v1;explore;loop.relay.asymmetry=0.3",
    "v1;explore;loop.relay.hysteresis=0;loop.plant.denominator=1,1",
    "v1;explore;loop.plant.denominator=1,1;loop.relay.hysteresis=2",
    "v1;explore;loop.plant.numerator=-1,-1,4;loop.plant.denominator=1,6,11,6;loop.relay.hysteresis=0.5",
    "v1;explore;explore.controller=three_positions",
    "v1;explore;explore.controller=three_positions;explore.on_off.dead_zone=0.8",
    "v1;explore;explore.controller=one_sided;explore.on_off.reference=0.7;explore.on_off.min_on=3;explore.on_off.min_off=3",
    "v1;explore;explore.controller=one_sided;explore.on_off.reference=5",
    "v1;explore;explore.on_off.sampling=0.5",
    "v1;explore;explore.on_off.z.sampling=0.2",
    "v1;explore;explore.controller=servo",
    "v1;explore;explore.controller=servo;explore.servo.integral=0",
    "v1;explore;explore.controller=servo;explore.servo.excess=0",
    "v1;explore;explore.controller=servo;explore.servo.integral=80",
    "v1;explore;explore.controller=servo;explore.servo.half_gap=0.02;explore.servo.excess=0;explore.servo.coulomb=4e-4;\
     explore.servo.proportional=0.4;explore.servo.integral=4.8;explore.servo.derivative=0.02;explore.servo.limit=0",
    "v1;maps",
    "v1;maps;maps.quantity=stability",
    "v1;maps;maps.quantity=amplitude_error;maps.across.parameter=dead_time;maps.across.from=0;maps.across.to=2",
    "v1;tune",
    "v1;tune;tune.step=ultimate",
    "v1;tune;tune.step=adaptation",
    "v1;tune;tune.step=model",
    "v1;tune;tune.step=model;tune.asymmetry=0",
    "v1;tune;tune.step=rules",
    "v1;tune;tune.step=loops",
    "v1;tune;tune.measured.from=record",
    "v1;tune;tune.measured.from=record;tune.measured.file=process-02",
    "v1;tune;tune.measured.from=numbers",
    "v1;tune;tune.measured.from=numbers;tune.measured.readings.hysteresis=0",
    "v1;backlash",
    "v1;backlash;backlash.figure=7",
    "v1;backlash;backlash.figure=10",
    "v1;backlash;backlash.figure=11",
    "v1;backlash;backlash.figure=12",
    "v1;backlash;backlash.run.command.relay.relay.asymmetry=0",
    "v1;backlash;backlash.file=drive-10",
    "v1;compare",
    "v1;compare;compare.file=drive-02",
    "v1;compare;compare.file=process-02",
    "v1;compare;compare.file=drive-02;compare.effects=%5B%22coulomb_friction%22%5D",
];

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

/// Every text of the last frame, as it was drawn, with usual spaces.
pub fn texts(harness: &App) -> Vec<String> {
    fn collect(shape: &Shape, texts: &mut Vec<String>) {
        match shape {
            Shape::Text(text) => texts.push(text.galley.job.text.replace('\u{a0}', " ")),
            Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, texts)),
            _ => {}
        }
    }
    let mut texts = Vec::new();
    for ClippedShape { shape, .. } in &harness.output().shapes {
        collect(shape, &mut texts);
    }
    texts
}

/// Waits until the app says this of itself, however busy the machine is.
pub fn wait(harness: &mut App, what: &str, holds: impl Fn(&serde_json::Value) -> bool) {
    for _ in 0..ROUNDS {
        harness.step();
        if holds(&state(harness)) {
            return;
        }
        std::thread::sleep(WAIT);
    }
    panic!("no {what}: {}", state(harness));
}

/// Waits until nothing is computed any more and the result is on the screen.
pub fn finish(harness: &mut App) {
    harness.step();
    wait(harness, "end of the job", |s| s["busy"] == false);
    // One frame takes the result, the next draws it with its sizes settled.
    harness.step();
    harness.step();
}

/// Waits until the app says this of itself, and for what follows.
pub fn finish_when(harness: &mut App, what: &str, holds: impl Fn(&serde_json::Value) -> bool) {
    wait(harness, what, holds);
    finish(harness);
}

/// Clicks what has this label and waits for what follows.
pub fn click(harness: &mut App, label: &str) {
    harness.get_by_label(label).click();
    finish(harness);
}

/// Has the app look so, by its menu, which in a narrow window is inside another one.
pub fn wear(harness: &mut App, look: &str) {
    harness.step();
    if harness.query_by_label("Look").is_none() {
        let mut menus = ["More", "Menu: Start"].into_iter();
        let menu = menus.find(|name| harness.query_by_label(name).is_some());
        harness.get_by_label(menu.expect("a menu")).click();
        harness.run_steps(3);
    }
    harness.get_by_label("Look").click();
    harness.run_steps(3);
    harness.get_by_label(look).click();
    finish(harness);
    // Away from where the buttons are.
    harness.hover_at(Pos2::new(1.0, 1.0));
    finish(harness);
}

/// Opens a link and waits until what it shows is there.
pub fn show(harness: &mut App, link: &str) {
    let ctx = harness.ctx.clone();
    let opened = harness.state_mut().open_link(&ctx, link);
    assert_eq!(opened, Ok(()), "{link}");
    finish(harness);
}

/// Opens a link to what is computed beside the frames: the answer of before is marked until the new one is there.
pub fn marks_what_is_of_before(harness: &mut App, link: &str) {
    let marked = |harness: &App| {
        let saying = "Computing for what is set now ...";
        texts(harness).iter().any(|t| t == saying)
    };
    assert!(!marked(harness));
    let before = answer(harness);
    let ctx = harness.ctx.clone();
    assert_eq!(harness.state_mut().open_link(&ctx, link), Ok(()), "{link}");
    harness.step();
    // The computation has begun in this frame, so that it cannot be over.
    assert!(marked(harness), "{link}");
    finish(harness);
    assert!(!marked(harness), "{link}");
    assert_ne!(answer(harness), before, "{link}");
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

/// Names and places of the controls of some roles.
pub fn controls(harness: &App, roles: &[Role]) -> Vec<(String, Rect)> {
    let nodes = harness.root().children_recursive();
    nodes
        .filter(|n| {
            let node = n.accesskit_node();
            roles.contains(&node.role()) && !node.is_hidden()
        })
        .map(|n| (n.accesskit_node().label().unwrap_or_default(), n.rect()))
        .collect()
}

pub fn button(at: Pos2, which: PointerButton, pressed: bool) -> Event {
    Event::PointerButton {
        pos: at,
        button: which,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

/// Two clicks, each within a frame: the test's clock goes a quarter of a second from frame to frame.
pub fn double_click(harness: &mut App, at: Pos2) {
    harness.hover_at(at);
    harness.step();
    for _ in 0..2 {
        let click = [true, false].map(|p| button(at, PointerButton::Primary, p));
        harness.input_mut().events.extend(click);
        harness.step();
    }
}

/// Chooses an entry of a list.
pub fn choose(harness: &mut App, list: &str, entry: &str) {
    let found = harness.get_by_role_and_label(Role::ComboBox, list);
    found.click_accesskit();
    harness.run_steps(3);
    // What is drawn last lies on top.
    let last = harness.query_all_by_label(entry).last();
    last.unwrap_or_else(|| panic!("no {entry} in {list}"))
        .click_accesskit();
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    finish(harness);
}
