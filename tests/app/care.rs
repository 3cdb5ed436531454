//! What is noticed only where it is missing: what Escape closes, where the keyboard is, what becomes of a number that
//! cannot be, and where a page stands when one comes back to it.

use std::path::PathBuf;

use crate::support::ui::{
    App, Dropped, TALL, WIDE, app, click, finish, finish_when, show, state, texts,
};
use egui::epaint::{ClippedShape, Shape};
use egui::{Event, Key, Modifiers, Rect, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use hysteron::language::Language;

/// A phone's window, points.
const PHONE: [f32; 2] = [390.0, 844.0];

fn press(harness: &mut App, key: Key) {
    harness.key_press_modifiers(Modifiers::NONE, key);
    finish(harness);
}

fn notice(harness: &App) -> String {
    let state = state(harness);
    state["notice"].as_str().unwrap_or_default().to_owned()
}

/// Where the first control with this name is.
fn place(harness: &App, role: Role, name: &str) -> Rect {
    let mut nodes = harness.root().children_recursive();
    let found = nodes.find(|n| {
        let node = n.accesskit_node();
        node.role() == role && !node.is_hidden() && node.label().as_deref() == Some(name)
    });
    found.unwrap_or_else(|| panic!("no {name}")).rect()
}

/// All that was painted in the last frame.
fn shapes(harness: &App) -> Vec<Shape> {
    fn collect(shape: &Shape, all: &mut Vec<Shape>) {
        match shape {
            Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, all)),
            shape => all.push(shape.clone()),
        }
    }
    let mut all = Vec::new();
    for ClippedShape { shape, .. } in &harness.output().shapes {
        collect(shape, &mut all);
    }
    all
}

#[test]
fn escape_closes_a_menu_and_a_list_and_then_what_lies_beneath() {
    let mut harness = app("explore", WIDE);
    show(&mut harness, "v1;explore;explore.paused=20");
    press(&mut harness, Key::L);
    for (opener, inside) in [
        ("Export", "Picture of this page (SVG)"),
        ("Look", "Projector"),
        (
            "Menu of the plot: output y, input u over time [s]",
            "Data of this plot (CSV)",
        ),
    ] {
        harness.get_by_label(opener).click_accesskit();
        finish(&mut harness);
        harness.get_by_label(inside);
        press(&mut harness, Key::F1);
        press(&mut harness, Key::Escape);
        assert!(harness.query_by_label(inside).is_none(), "{opener}");
        harness.get_by_label("Undo the last change");
        press(&mut harness, Key::Escape);
        assert!(harness.query_by_label("Undo the last change").is_none());
    }
    let lists = |harness: &App| harness.query_all_by_role(Role::ComboBox).count();
    assert_eq!(lists(&harness), 2, "controller and plant");
    let entries = |harness: &App| texts(harness).len();
    let before = entries(&harness);
    for list in 0..2 {
        let found = harness.query_all_by_role(Role::ComboBox).nth(list);
        found.expect("a list").click_accesskit();
        finish(&mut harness);
        assert!(entries(&harness) > before, "list {list} is open");
        press(&mut harness, Key::Escape);
        assert_eq!(entries(&harness), before, "list {list} is closed");
    }
}

/// Whether a line is drawn around a place.
fn ringed(harness: &App, place: Rect) -> bool {
    shapes(harness).iter().any(|shape| {
        let Shape::Rect(rect) = shape else {
            return false;
        };
        let near = |a: f32, b: f32| (a - b).abs() < 6.0;
        let around = near(rect.rect.left(), place.left())
            && near(rect.rect.right(), place.right())
            && near(rect.rect.top(), place.top())
            && near(rect.rect.bottom(), place.bottom());
        around && rect.stroke.width >= 1.0 && rect.stroke.color.a() > 128
    })
}

#[test]
fn whatever_has_the_keyboard_has_a_ring() {
    for place in [
        "v1;start;start.paused=20",
        "v1;lessons",
        "v1;explore;explore.paused=20",
        "v1;maps",
        "v1;tune",
        "v1;backlash;backlash.paused=1",
        "v1;compare",
        "v1;mystery",
    ] {
        let mut harness = app("start", TALL);
        show(&mut harness, place);
        let mut stops = 0;
        let mut seen = Vec::new();
        loop {
            harness.key_press(Key::Tab);
            harness.step();
            harness.step();
            let focused = harness
                .root()
                .children_recursive()
                .find(egui_kittest::Node::is_focused)
                .map(|n| (n.accesskit_node().label().unwrap_or_default(), n.rect()));
            // A plot is no control: it has no node of its own.
            if let Some((name, at)) = focused {
                assert!(ringed(&harness, at), "{place}: {name} {at:?}");
                seen.push(name);
            }
            stops += 1;
            let ring = harness.ctx.memory(egui::Memory::focused);
            let at = ring.and_then(|id| harness.ctx.read_response(id));
            if let Some(at) = at {
                assert!(ringed(&harness, at.rect), "{place}: stop {stops}: {at:?}");
            }
            let first = seen.first().cloned();
            if stops > 8 && seen.last() == first.as_ref() || stops > 150 {
                break;
            }
        }
        assert!(stops > 8, "{place}: {stops} stops");
    }
}

/// Types into the number beside a slider, key by key, and leaves it.
fn type_number(harness: &mut App, name: &str, text: &str) {
    let at = place(harness, Role::Slider, name).left_center() + vec2(185.0, 0.0);
    harness.hover_at(at);
    harness.step();
    for pressed in [true, false] {
        harness.input_mut().events.push(Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    harness.step();
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.step();
    for key in text.chars() {
        harness.event(Event::Text(key.to_string()));
        harness.step();
    }
    harness.key_press(Key::Enter);
    finish(harness);
    // So that the next click is not the second.
    harness.run_steps(8);
}

#[test]
fn a_number_that_cannot_be_changes_nothing_and_is_said() {
    let mut harness = app("explore", TALL);
    show(&mut harness, "v1;explore;explore.paused=20");
    let set = |harness: &App| {
        let state = state(harness);
        let set = &state["explore"]["loop"];
        let noise = set["noise"]["std_dev"].as_f64().unwrap_or_default();
        (set["relay"]["delay"].as_f64().expect("a delay"), noise)
    };
    type_number(&mut harness, "delay [s]", "250 ms");
    assert_eq!(set(&harness), (0.25, 0.0));
    assert_eq!(notice(&harness), "");
    for (name, text, said) in [
        (
            "delay [s]",
            "2 kg",
            "2 kg is not accepted: enter a number in s.",
        ),
        (
            "delay [s]",
            "1e",
            "1e is not accepted: enter a number in s.",
        ),
        (
            "delay [s]",
            "50",
            "50 is not accepted: the range is 0 to 2 s.",
        ),
        (
            "noise σ",
            "50 ms",
            "50 ms is not accepted: enter a number without a unit.",
        ),
    ] {
        type_number(&mut harness, name, text);
        assert_eq!(set(&harness), (0.25, 0.0), "{text}");
        assert_eq!(notice(&harness), said);
        press(&mut harness, Key::Escape);
    }
    type_number(&mut harness, "noise σ", "0.05");
    assert_eq!(set(&harness), (0.25, 0.05));
    assert_eq!(notice(&harness), "");
}

#[test]
fn a_number_that_is_only_looked_at_stays_as_it_is() {
    let mut harness = app("explore", TALL);
    let link = "v1;explore;explore.paused=20;loop.relay.delay=3.00004";
    show(&mut harness, link);
    type_number(&mut harness, "delay [s]", "3");
    assert_eq!(
        state(&harness)["explore"]["loop"]["relay"]["delay"],
        3.00004
    );
    assert_eq!(notice(&harness), "");
}

#[test]
fn each_page_stands_where_it_was_left() {
    let mut harness = app("backlash", [1000.0, 500.0]);
    show(&mut harness, "v1;backlash;backlash.paused=1");
    let headline = |harness: &App| {
        let y = shapes(harness).into_iter().find_map(|shape| match shape {
            Shape::Text(text) if text.galley.job.text.starts_with("It oscillates") => {
                Some(text.pos.y)
            }
            _ => None,
        });
        y.expect("a headline")
    };
    for at in [[700.0, 300.0], [100.0, 300.0]] {
        harness.hover_at(at.into());
        harness.step();
        harness.input_mut().events.push(Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, -200.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        harness.run_steps(6);
    }
    show(&mut harness, "v1;explore;explore.paused=20");
    let after = headline(&harness);
    let mut fresh = app("explore", [1000.0, 500.0]);
    show(&mut fresh, "v1;explore;explore.paused=20");
    assert!((after - headline(&fresh)).abs() < 0.5, "{after}");
}

/// Drops a file and waits until the page has said something about it, or opened it.
fn drop_file(harness: &mut App, name: &str, bytes: &[u8]) {
    let file: egui::DroppedFileHandle =
        std::sync::Arc::new(Dropped(PathBuf::from(name), bytes.to_vec()));
    harness.input_mut().dropped_files.push(file);
    let before = state(harness)["message"].clone();
    finish_when(harness, "answer to the file", |now| {
        let said = now["message"].is_string() && now["message"] != before;
        said || now["file"] == name
    });
}

#[test]
fn a_refused_file_is_not_among_those_opened_before() {
    let good = format!("{}/../tests/data/drive-02.csv", env!("CARGO_MANIFEST_DIR"));
    let good = std::fs::read(good).expect("a file of the tests");
    for page in ["compare", "backlash"] {
        let mut harness = app(page, TALL);
        finish(&mut harness);
        drop_file(&mut harness, "bad.csv", b"no measurement\n");
        assert!(state(&harness)["message"].is_string(), "{page}");
        assert!(harness.query_by_label("bad.csv").is_none(), "{page}");
        drop_file(&mut harness, "good.csv", &good);
        if page == "compare" {
            click(&mut harness, "Open another");
        }
        let buttons = |name| {
            harness
                .query_all_by_role_and_label(Role::Button, name)
                .count()
        };
        assert_eq!([buttons("good.csv"), buttons("bad.csv")], [1, 0], "{page}");
    }
}

#[test]
fn a_model_without_a_measurement_is_told_where_it_belongs() {
    for (page, said) in [
        ("compare", "open the measurement first"),
        ("backlash", "open it in Compare"),
    ] {
        let mut harness = app(page, TALL);
        finish(&mut harness);
        drop_file(&mut harness, "rig.toml", b"kind = \"drive\"\n");
        let message = state(&harness)["message"].clone();
        let message = message.as_str().expect("a message");
        assert!(
            message.contains("rig.toml") && message.contains(said),
            "{message}"
        );
        assert!(texts(&harness).iter().any(|t| t == message), "{page}");
        harness.state_mut().speak(Language::German);
        finish(&mut harness);
        let german = |t: &String| t.contains("rig.toml ist ein Modell");
        assert!(texts(&harness).iter().any(german), "{page}");
    }
}

#[test]
fn a_wish_for_a_file_goes_once_it_is_open() {
    let good = format!("{}/../tests/data/drive-02.csv", env!("CARGO_MANIFEST_DIR"));
    let good = std::fs::read(good).expect("a file of the tests");
    let mut harness = app("compare", TALL);
    let ctx = harness.ctx.clone();
    let link = "v1;compare;compare.file=one.csv";
    assert!(harness.state_mut().open_link(&ctx, link).is_err());
    harness.step();
    assert!(notice(&harness).contains("one.csv"));
    drop_file(&mut harness, "two.csv", &good);
    assert!(notice(&harness).contains("one.csv"));
    drop_file(&mut harness, "one.csv", &good);
    assert_eq!(state(&harness)["notice"], serde_json::Value::Null);
}

#[test]
fn backlash_points_to_the_page_that_asks_for_columns() {
    let file = format!("{}/../tests/data/flat-v7.mat", env!("CARGO_MANIFEST_DIR"));
    let bytes = std::fs::read(file).expect("a file of the tests");
    let mut harness = app("backlash", TALL);
    finish(&mut harness);
    drop_file(&mut harness, "log.mat", &bytes);
    let said = state(&harness)["message"].clone();
    let said = said.as_str().expect("a message");
    assert!(said.contains("Open it in Compare"), "{said}");
    harness.state_mut().speak(Language::German);
    finish(&mut harness);
    let texts = texts(&harness);
    let german =
        |t: &String| t.contains("eine MATLAB-Datei sagt nicht") && t.contains("Vergleichen");
    assert!(texts.iter().any(german), "{texts:#?}");
}

#[test]
fn the_answer_to_a_lesson_s_question_comes_into_view() {
    for size in [[1280.0, 657.0], PHONE] {
        let mut harness = app("lessons", size);
        show(&mut harness, "v1;explore;explore.paused=20;lesson=relay");
        let field = harness.get_by_label("Your answer");
        field.scroll_to_me();
        harness.run_steps(8);
        for (typed, said) in [("0.5", "Not yet."), ("0.7616", "Right.")] {
            crate::support::ui::type_over(&mut harness, "Your answer", typed);
            harness.get_by_label("Check").click_accesskit();
            finish(&mut harness);
            harness.run_steps(20);
            let panel = harness.ctx.content_rect();
            let seen = harness.output().shapes.iter().any(|clipped| {
                let Shape::Text(text) = &clipped.shape else {
                    return false;
                };
                let place = text.visual_bounding_rect();
                let inside = clipped.clip_rect.intersect(panel).contains_rect(place);
                text.galley.job.text == said && inside
            });
            assert!(seen, "{size:?}: {said}");
        }
    }
}

#[test]
fn a_lesson_is_folded_on_a_phone() {
    let mut harness = app("lessons", PHONE);
    show(&mut harness, "v1;explore;explore.paused=20;lesson=relay");
    let room = |harness: &App, fold: &str| place(harness, Role::Button, fold).top();
    let before = room(&harness, "Collapse the lesson");
    click(&mut harness, "Collapse the lesson");
    let after = room(&harness, "Expand the lesson");
    assert!(after > before + 200.0, "{before} {after}");
    let title = |t: &String| t.contains("The relay and its hysteresis");
    assert!(texts(&harness).iter().any(title), "its title stays");
    assert!(harness.query_by_label("Check").is_none());
    // The slider and the plot that it changes stand in the window together.
    let node = harness.get_by_role_and_label(Role::Slider, "hysteresis ε");
    node.scroll_to_me();
    harness.run_steps(20);
    let slider = place(&harness, Role::Slider, "hysteresis ε");
    let menu = "Menu of the plot: output y, input u over time [s]";
    let plot = place(&harness, Role::Button, menu);
    let (plot_height, bar) = (220.0, 60.0);
    let together = slider.bottom() - (plot.bottom() - plot_height);
    assert!(together < after - bar, "{together} {after}");
    click(&mut harness, "Expand the lesson");
    assert!((room(&harness, "Collapse the lesson") - before).abs() < 1.0);
    // Where there is room, nothing is folded.
    let mut harness = app("lessons", WIDE);
    show(&mut harness, "v1;explore;explore.paused=20;lesson=relay");
    assert!(harness.query_by_label("Collapse the lesson").is_none());
}

#[test]
fn a_link_that_cannot_be_is_refused_in_the_words_of_the_interface() {
    let mut harness = app("start", WIDE);
    harness.state_mut().speak(Language::German);
    let ctx = harness.ctx.clone();
    for (link, said) in [
        (
            "v1;explore;loop.plant.numerator=1,nan",
            "Dieser Link hat einen falschen Wert: loop.plant.numerator=1,nan.",
        ),
        (
            "v1;explore;loop.relay.gain=much",
            "Dieser Link hat einen falschen Wert: loop.relay.gain=much.",
        ),
        ("v1;backlash;backlash.run.drive.half_gap=-1", "halbe Lose"),
        (
            "v1;maps;maps.quantity=mine",
            "Diese Einstellungen sind nicht lesbar.",
        ),
    ] {
        let refused = harness.state_mut().open_link(&ctx, link);
        assert!(refused.is_err(), "{link}");
        finish(&mut harness);
        let texts = texts(&harness);
        assert!(texts.iter().any(|t| t.contains(said)), "{link}: {texts:#?}");
        let raw = |t: &String| {
            ["invalid", "expected", "half_gap is", "unknown"]
                .iter()
                .any(|w| t.contains(w))
        };
        assert!(!texts.iter().any(raw), "{link}: {texts:#?}");
    }
}

#[test]
fn of_several_files_it_is_said_which_one_is_opened() {
    let mut harness = app("compare", WIDE);
    for name in ["a.csv", "b.csv"] {
        let file: egui::DroppedFileHandle =
            std::sync::Arc::new(Dropped(PathBuf::from(name), Vec::new()));
        harness.input_mut().dropped_files.push(file);
    }
    harness.step();
    assert_eq!(
        notice(&harness),
        "Only one of the 2 files is opened: a.csv."
    );
}

#[test]
fn a_notice_leaves_what_to_try_next_in_view() {
    let mut harness = app("explore", WIDE);
    show(&mut harness, "v1;explore;explore.paused=20");
    press(&mut harness, Key::L);
    harness.run_steps(2);
    let said = notice(&harness);
    let at = shapes(&harness).into_iter().find_map(|shape| match shape {
        Shape::Text(text) if text.galley.job.text == said => Some(text.visual_bounding_rect()),
        _ => None,
    });
    let next = place(&harness, Role::Button, "Try it");
    assert!(at.expect("a notice").bottom() < next.top());
}

#[test]
fn the_word_of_a_mystery_is_shown_only_when_asked_for() {
    let mut harness = app("mystery", TALL);
    crate::support::ui::type_over(&mut harness, "Password", "blue whale");
    let shown = |harness: &App| texts(harness).iter().any(|t| t == "blue whale");
    assert!(!shown(&harness));
    click(&mut harness, "Show the password");
    assert!(shown(&harness));
}

#[test]
fn a_page_exports_what_it_shows() {
    let mut harness = app("start", WIDE);
    for (link, first, none) in [
        ("v1;start", "time series", "Nyquist curve"),
        (
            "v1;tune;tune.step=loops",
            "step response before",
            "relay test",
        ),
        ("v1;tune", "relay test", "step response before"),
    ] {
        show(&mut harness, link);
        let tables = harness.state().tables();
        assert_eq!(tables[0].name, first, "{link}");
        assert!(tables.iter().all(|t| t.name != none), "{link}");
        click(&mut harness, "Export");
        for table in &tables {
            harness.get_by_label(&format!("Data: {} (CSV)", table.name));
        }
        press(&mut harness, Key::Escape);
    }
}
