//! What holds for every page: the first minute, undo, keys, looks, and taking up where one left.

use crate::support::ui::{App, NARROW, WIDE, app, click, finish, picture, show, state, type_over};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use hysteron::HysteronApp;

fn press(harness: &mut App, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    finish(harness);
}

/// Gain of the relay of the loop that the pages share.
fn hysteresis(harness: &App) -> f64 {
    let value = state(harness)["explore"]["loop"]["relay"]["hysteresis"].as_f64();
    value.expect("a hysteresis")
}

#[test]
fn the_first_minute_shows_a_running_loop_a_question_and_three_doors() {
    let ids = HysteronApp::default().page_ids();
    assert_eq!(ids.first(), Some(&"start"), "it opens there");
    let mut harness = app("start", WIDE);
    harness.step();
    let before = state(&harness)["clock"].as_f64().expect("a clock");
    for _ in 0..10 {
        harness.step();
    }
    let after = state(&harness)["clock"].as_f64().expect("a clock");
    assert!(after > before, "the loop runs: {before} {after}");
    harness.get_by_label("Why does a thermostat never come to rest?");
    harness.get_by_label_contains("It oscillates: period 4.788\u{a0}s");
    harness.get_by_label("Pause").click();
    harness.step();
    show(&mut harness, "v1;start;start.paused=20");
    picture(&mut harness, "start");
    for (door, page) in [
        ("Open Explore", "explore"),
        ("Open Backlash", "backlash"),
        ("Open Compare", "compare"),
        ("Tune a controller from one experiment", "tune"),
        ("Maps of period and amplitude", "maps"),
        ("Lessons of five to ten minutes", "lessons"),
    ] {
        let mut harness = app("start", WIDE);
        harness.get_by_label(door).click();
        harness.step();
        harness.step();
        assert_eq!(state(&harness)["page"], page);
    }
}

#[test]
fn every_page_stands_in_a_phone_s_window_and_is_reached_by_its_menu() {
    let pages = [
        ("start", "Menu: Start"),
        ("lessons", "Menu: Lessons"),
        ("explore", "Menu: Explore"),
    ];
    for (page, menu) in pages {
        let mut harness = app(page, [390.0, 844.0]);
        press(&mut harness, Modifiers::NONE, Key::P);
        harness.get_by_label(menu).click();
        harness.step();
        harness.step();
        harness.get_by_label("Tune").click();
        harness.step();
        harness.step();
        assert_eq!(state(&harness)["page"], "tune");
    }
    let mut harness = app("start", NARROW);
    show(&mut harness, "v1;start;start.paused=20");
    picture(&mut harness, "start_narrow");
}

#[test]
fn each_page_says_what_to_try_next_and_shows_it() {
    for page in ["explore", "maps", "tune", "compare", "backlash"] {
        let mut harness = app(page, WIDE);
        finish(&mut harness);
        let before = state(&harness)["link"].clone();
        click(&mut harness, "Try it");
        let after = state(&harness);
        assert_eq!(after["notice"], serde_json::Value::Null, "{page}");
        assert_ne!(after["link"], before, "{page}");
    }
}

#[test]
fn the_next_thing_to_try_follows_from_what_is_set() {
    let mut harness = app("explore", WIDE);
    finish(&mut harness);
    type_over(&mut harness, "P(s) =", "1/(s+1)^4");
    let plant = state(&harness)["loop"]["plant"].clone();
    // Wider and wider, until the describing function fails or nothing oscillates: the plant stays.
    let mut said = Vec::new();
    for _ in 0..8 {
        let hint = state(&harness)["hint"].clone();
        assert!(!said.contains(&hint), "{hint} is said again");
        said.push(hint);
        click(&mut harness, "Try it");
        if state(&harness)["page"] != "explore" {
            break;
        }
        assert_eq!(state(&harness)["loop"]["plant"], plant);
    }
    assert_eq!(state(&harness)["page"], "maps", "{said:?}");

    // The steps of the tuning lead on to the next one, and then elsewhere.
    let mut harness = app("tune", WIDE);
    for _ in 0..6 {
        assert_eq!(state(&harness)["page"], "tune");
        finish(&mut harness);
        click(&mut harness, "Try it");
    }
    assert_eq!(state(&harness)["page"], "backlash");
}

#[test]
fn what_was_changed_is_taken_back_and_done_again() {
    let mut harness = app("explore", WIDE);
    finish(&mut harness);
    let first = state(&harness)["link"].clone();
    type_over(&mut harness, "P(s) =", "1/(s+1)^4");
    let plant = state(&harness)["link"].clone();
    assert_ne!(plant, first);
    // The text field keeps its keys, among them its own undo, until it is left.
    harness.get_by_label("Pause").click();
    finish(&mut harness);
    let paused = state(&harness)["link"].clone();
    click(&mut harness, "Undo");
    assert_ne!(state(&harness)["link"], paused);
    press(&mut harness, Modifiers::COMMAND, Key::Y);
    assert_eq!(state(&harness)["link"], paused);
    for _ in 0..8 {
        press(&mut harness, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(state(&harness)["link"], first, "all is as it was");
    assert!((hysteresis(&harness) - 0.1).abs() < 1e-12);
    press(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_ne!(state(&harness)["link"], first);
}

#[test]
fn undo_takes_back_an_effect_and_shows_the_stored_result() {
    let mut harness = app("compare", WIDE);
    click(&mut harness, "Open drive-02");
    let before = state(&harness)["error"].clone();
    click(&mut harness, "Add Coulomb friction");
    assert_ne!(state(&harness)["error"], before);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(state(&harness)["error"], before);
    press(&mut harness, Modifiers::COMMAND, Key::Y);
    assert_eq!(state(&harness)["effects"][1], "coulomb_friction");
}

#[test]
fn keys_do_what_the_sheet_says() {
    let mut harness = app("start", WIDE);
    press(&mut harness, Modifiers::NONE, Key::Num3);
    assert_eq!(state(&harness)["page"], "explore");
    press(&mut harness, Modifiers::NONE, Key::P);
    let paused = state(&harness)["link"].as_str().expect("a link").to_owned();
    assert!(paused.contains("explore.paused="), "{paused}");
    // With Shift a key is another sign.
    press(&mut harness, Modifiers::SHIFT, Key::R);
    press(&mut harness, Modifiers::SHIFT, Key::Num8);
    assert_eq!(state(&harness)["link"].as_str(), Some(paused.as_str()));
    press(&mut harness, Modifiers::NONE, Key::R);
    assert_eq!(state(&harness)["link"], "v1;explore");
    let said = "This page is reset. Undo brings your settings back.";
    assert_eq!(state(&harness)["notice"], said);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(state(&harness)["link"].as_str(), Some(paused.as_str()));
    press(&mut harness, Modifiers::NONE, Key::R);
    press(&mut harness, Modifiers::NONE, Key::L);
    assert!(state(&harness)["notice"].is_string());
    press(&mut harness, Modifiers::NONE, Key::F1);
    harness.get_by_label("Undo the last change");
    press(&mut harness, Modifiers::NONE, Key::P);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.query_by_label("Undo the last change").is_none());
    // In a text field the same keys are letters.
    type_over(&mut harness, "P(s) =", "1/(s+1)^3");
    press(&mut harness, Modifiers::NONE, Key::Num1);
    assert_eq!(state(&harness)["page"], "explore");
}

#[test]
fn the_sheet_of_keys_is_drawn() {
    let mut harness = app("lessons", WIDE);
    click(&mut harness, "Keys");
    picture(&mut harness, "keys");
}

#[test]
fn a_pasted_link_is_opened() {
    let mut harness = app("start", WIDE);
    harness.event(egui::Event::Paste(
        "https://example.org/hysteron/#v1;tune;tune.step=rules".to_owned(),
    ));
    finish(&mut harness);
    assert_eq!(state(&harness)["page"], "tune");
    assert_eq!(state(&harness)["step"], "rules");
}

#[test]
fn a_slider_is_reset_by_a_double_click() {
    let mut harness = app("explore", WIDE);
    let link = "v1;explore;explore.paused=0;loop.relay.hysteresis=0.5";
    show(&mut harness, link);
    assert!((hysteresis(&harness) - 0.5).abs() < 1e-12);
    let at = harness
        .get_by_role_and_label(egui::accesskit::Role::Slider, "hysteresis ε")
        .rect()
        .left_center()
        + egui::vec2(12.0, 0.0);
    harness.hover_at(at);
    harness.step();
    // Each click within one frame: the test's clock goes a quarter of a second from frame to frame.
    let click = |pressed| egui::Event::PointerButton {
        pos: at,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    for _ in 0..2 {
        let events = [true, false].map(click);
        harness.input_mut().events.extend(events);
        harness.step();
    }
    finish(&mut harness);
    assert!((hysteresis(&harness) - 0.1).abs() < 1e-12);
}

#[test]
fn each_look_draws_every_page() {
    let mut harness = app("explore", WIDE);
    let ctx = harness.ctx.clone();
    for (look, name) in [("Light", "light"), ("Projector", "projector")] {
        let link = "v1;explore;explore.paused=12;loop.relay.hysteresis=0.2";
        harness.state_mut().open_link(&ctx, link).expect("a link");
        click(&mut harness, "Look");
        click(&mut harness, look);
        assert_eq!(state(&harness)["look"], look);
        finish(&mut harness);
        picture(&mut harness, &format!("explore_{name}"));
        for page in HysteronApp::default().page_ids() {
            let link = format!("v1;{page}");
            show(&mut harness, &link);
            assert_eq!(state(&harness)["page"], page);
        }
    }
}

#[test]
fn a_panel_that_was_made_wider_is_so_at_the_next_start() {
    let left = |harness: &App| {
        let rect = harness.get_by_label("What could be missing").rect();
        rect.left()
    };
    let mut harness = app("compare", WIDE);
    show(&mut harness, "v1;compare;compare.file=drive-02");
    let before = left(&harness);
    // The edge is a few points beside what stands in the panel.
    let edge = egui::pos2(before - 8.0, 400.0);
    harness.hover_at(edge);
    harness.step();
    harness.drag_at(edge);
    harness.step();
    let to = edge - egui::vec2(120.0, 0.0);
    harness.hover_at(to);
    harness.step();
    harness.drop_at(to);
    harness.run_steps(3);
    let dragged = left(&harness);
    assert!((before - dragged - 120.0).abs() < 9.0, "{before} {dragged}");

    let mut kept = Memory::default();
    eframe::App::save(harness.state_mut(), &mut kept);
    let mut later = app("start", WIDE);
    let mut context = eframe::CreationContext::_new_kittest(later.ctx.clone());
    context.storage = Some(&kept);
    *later.state_mut() = HysteronApp::restored(&context);
    finish(&mut later);
    assert!((left(&later) - dragged).abs() < 1.0, "{}", left(&later));
}

#[test]
fn what_stands_in_a_panel_does_not_move_its_edge() {
    let path = format!("{}/../tests/data/drive-05.csv", env!("CARGO_MANIFEST_DIR"));
    let bytes = std::fs::read(path).expect("a file of the tests");
    for (size, look) in [
        (WIDE, "Dark"),
        ([1000.0, 700.0], "Dark"),
        ([760.0, 700.0], "Dark"),
        ([1000.0, 700.0], "Projector"),
    ] {
        let mut harness = app("compare", size);
        if look != "Dark" {
            harness.run_steps(2);
            for label in ["More", look] {
                if let Some(found) = harness.query_by_label(label) {
                    found.click();
                    harness.run_steps(5);
                }
            }
        }
        let ctx = harness.ctx.clone();
        let name = "a-drive-with-a-long-name-of-the-tenth-of-may.csv";
        harness.state_mut().open(&ctx, name, &bytes);
        let mut edges = Vec::new();
        let mut look = |harness: &App, what: &str| {
            let found = harness.query_by_label("Load model ...");
            edges.extend(found.map(|button| (what.to_owned(), button.rect().left())));
        };
        while state(&harness)["busy"] == true {
            harness.step();
            look(&harness, "busy");
        }
        finish(&mut harness);
        look(&harness, "done");
        for label in [
            "Fingerprints",
            "An effect of your own",
            "Add Gain asymmetry",
            "Limits of the experiment",
            "What other experiments would show",
            "Set a limit",
            "Equation",
            "Over time",
            "Effects that do not help",
            "Explore with gain",
            "Back to Compare",
        ] {
            let found = harness.query_all_by_label_contains(label).last();
            found.inspect(egui_kittest::Node::click_accesskit);
            for _ in 0..5 {
                harness.step();
                look(&harness, label);
            }
            finish(&mut harness);
            look(&harness, label);
        }
        let first = edges.first().expect("a panel").1;
        let moved = edges.iter().find(|(_, edge)| (edge - first).abs() > 0.5);
        assert!(moved.is_none(), "{first} {moved:?}");
    }
}

#[test]
fn the_app_opens_as_it_was_left() {
    let mut harness = app("tune", WIDE);
    finish(&mut harness);
    click(&mut harness, "5 Rule");
    click(&mut harness, "Ziegler-Nichols PI");
    let link = "v1;explore;explore.margin=true;loop.relay.gain=2";
    show(&mut harness, link);
    let kept = harness.state().kept();

    let mut later = app("start", WIDE);
    let ctx = later.ctx.clone();
    later.state_mut().restore(&ctx, &kept);
    finish(&mut later);
    assert_eq!(state(&later)["link"], state(&harness)["link"]);
    assert_eq!(later.state().kept(), kept);
    press(&mut later, Modifiers::NONE, Key::Num5);
    press(&mut later, Modifiers::NONE, Key::Num5);

    // What another version has left, or a file that is gone, does no harm.
    later.state_mut().restore(&ctx, "v1;explore;old.setting=1");
    let gone = kept.replace("v1;explore", "v1;explore;compare.file=gone.csv");
    later.state_mut().restore(&ctx, &gone);
    finish(&mut later);
    assert_eq!(state(&later)["page"], "explore");
    assert_eq!(state(&later)["compare"]["file"], serde_json::Value::Null);
}

/// The app with the last picture that it gave of itself.
type Drawn = (HysteronApp, String);

#[test]
fn a_page_is_saved_as_a_picture_of_lines_and_words() {
    let mut harness = egui_kittest::Harness::builder()
        .with_size(egui::Vec2::from(WIDE))
        .build_ui_state(
            |ui, (app, svg): &mut Drawn| {
                app.frame_ui(ui);
                *svg = app.svg(ui);
            },
            (HysteronApp::at("explore"), String::new()),
        );
    for _ in 0..3 {
        harness.step();
    }
    let svg = &harness.state().1;
    for part in [
        "<svg xmlns=",
        "viewBox=\"0 0 1280 800\"",
        "It oscillates: period 4.788 s",
        "time [s]",
        "its rate of change [1/s]",
        "rotate(-90",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    // A word in a row of several is as wide as itself.
    let words = svg.lines().find(|l| l.contains(">limit cycle<"));
    let width = words.and_then(|l| l.split("textLength=\"").nth(1)?.split('"').next());
    let width: f32 = width.expect("a width").parse().expect("a number");
    assert!((40.0..100.0).contains(&width), "{width}");
    let long = svg.lines().filter(|l| l.matches('L').count() > 500).count();
    assert!(long >= 2, "the curves are there: {long}");
    assert!(!svg.contains("NaN"));
    assert!(svg.trim_end().ends_with("</svg>"));
    assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
}

#[test]
fn the_numbers_of_a_page_are_saved_as_a_table() {
    let mut harness = app("explore", WIDE);
    finish(&mut harness);
    let tables = harness.state().tables();
    assert_eq!(tables.len(), 5);
    let csv = tables[0].csv();
    assert_eq!(csv.lines().next(), Some("time [s],output y"));
    let rows: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|l| l.split(',').map(|n| n.parse().expect("a number")).collect())
        .collect();
    // The output of the exact cycle stays within its amplitude, and reaches it.
    let late = rows.iter().filter(|r| r[0] > 40.0).map(|r| r[1].abs());
    let largest = late.fold(0.0, f64::max);
    assert!((largest / 0.285_687_386 - 1.0).abs() < 1e-3, "{largest}");

    for (page, columns) in [
        ("backlash", "t [s],u [N m],x1 [rad],v1 [rad/s],x2 [rad]"),
        ("tune", "time [s],output y"),
    ] {
        let mut harness = app(page, WIDE);
        finish(&mut harness);
        let tables = harness.state().tables();
        let csv = tables.first().expect("a table").csv();
        assert_eq!(csv.lines().next(), Some(columns));
        assert!(csv.lines().count() > 100, "{page}");
    }
    let mut harness = app("explore", WIDE);
    finish(&mut harness);
    click(&mut harness, "Export");
    for item in [
        "Picture of this page (SVG)",
        "Picture of this page (PNG)",
        "Data: Nyquist curve (CSV)",
    ] {
        harness.get_by_label(item);
    }
}

/// What the app keeps, in memory.
#[derive(Default)]
struct Memory(std::collections::BTreeMap<String, String>);

impl eframe::Storage for Memory {
    fn get_string(&self, key: &str) -> Option<String> {
        self.0.get(key).cloned()
    }

    fn set_string(&mut self, key: &str, value: String) {
        self.0.insert(key.to_owned(), value);
    }

    fn remove_string(&mut self, key: &str) {
        self.0.remove(key);
    }

    fn flush(&mut self) {}
}

#[test]
fn only_what_someone_has_chosen_is_kept_of_look_language_and_motion() {
    let mut harness = app("start", WIDE);
    let keys = ["hysteron look", "hysteron language", "hysteron motion"];
    let kept = |harness: &mut App| {
        let mut memory = Memory::default();
        eframe::App::save(harness.state_mut(), &mut memory);
        keys.map(|key| memory.0.get(key).cloned())
    };
    assert_eq!(kept(&mut harness), [None, None, None]);
    let choices = [
        ("Light", [Some("Light"), None, None]),
        ("Less motion", [Some("Light"), None, Some("reduced")]),
        ("Deutsch", [Some("Light"), Some("de"), Some("reduced")]),
    ];
    for (choice, expected) in choices {
        click(&mut harness, "Look");
        click(&mut harness, choice);
        assert_eq!(kept(&mut harness), expected.map(|v| v.map(str::to_owned)));
    }
}
