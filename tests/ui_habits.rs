//! What people expect of any control and any plot, on every page: a slider is reset by a double click, a number is
//! typed with its unit, a plot says what stands at the pointer, is zoomed, and gives itself away; and on a phone a
//! finger finds everything.

#[path = "support/ui.rs"]
mod ui;

use std::collections::BTreeSet;
use std::sync::mpsc::channel;

use egui::{Event, Modifiers, PointerButton, Pos2, Rect, Role, Vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use ui::{App, PLACES, TALL, app, finish, show, state, texts};

/// A phone's window, points.
const PHONE: [f32; 2] = [390.0, 844.0];

/// Least height of what a finger presses, points.
const FINGER: f32 = 40.0;

/// Pages with plots, with nothing that moves by itself.
const PLOTS: [&str; 13] = [
    "v1;start;start.paused=20",
    "v1;explore;explore.paused=20",
    "v1;tune",
    "v1;tune;tune.step=ultimate",
    "v1;tune;tune.step=adaptation",
    "v1;tune;tune.step=model",
    "v1;tune;tune.step=loops",
    "v1;backlash;backlash.paused=1",
    "v1;backlash;backlash.paused=1;backlash.file=drive-10",
    "v1;compare;compare.file=drive-02",
    "v1;compare;compare.file=drive-02;compare.look=places",
    "v1;compare;compare.file=drive-02;compare.look=fingerprint",
    "v1;compare;compare.file=process-02",
];

/// Names and places of the controls of some roles.
fn controls(harness: &App, roles: &[Role]) -> Vec<(String, Rect)> {
    let nodes = harness.root().children_recursive();
    nodes
        .filter(|n| {
            let node = n.accesskit_node();
            roles.contains(&node.role()) && !node.is_hidden()
        })
        .map(|n| (n.accesskit_node().label().unwrap_or_default(), n.rect()))
        .collect()
}

/// Names of the axes of the plots with their menus in view: y, x, and where the menu is.
fn plots(harness: &App) -> Vec<([String; 2], Rect)> {
    let all = controls(harness, &[Role::Button]);
    all.into_iter()
        .filter_map(|(name, at)| {
            let axes = name.strip_prefix("Menu of the plot: ")?;
            let (y, x) = axes.split_once(" over ")?;
            Some(([x.to_owned(), y.to_owned()], at))
        })
        .collect()
}

fn button(at: Pos2, which: PointerButton, pressed: bool) -> Event {
    Event::PointerButton {
        pos: at,
        button: which,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

/// Two clicks, each within a frame: the test's clock goes a quarter of a second from frame to frame.
fn double_click(harness: &mut App, at: Pos2) {
    harness.hover_at(at);
    harness.step();
    for _ in 0..2 {
        let click = [true, false].map(|p| button(at, PointerButton::Primary, p));
        harness.input_mut().events.extend(click);
        harness.step();
    }
}

#[test]
fn every_slider_is_reset_by_a_double_click() {
    let mut seen = BTreeSet::new();
    for place in [
        "v1;start;start.paused=20",
        "v1;explore;explore.paused=20",
        "v1;maps",
        "v1;tune",
        "v1;backlash;backlash.paused=1",
    ] {
        let mut harness = app("start", TALL);
        show(&mut harness, place);
        if place.contains("backlash") {
            harness
                .get_by_label("Design a drifting test")
                .click_accesskit();
            finish(&mut harness);
        }
        for (index, (name, _)) in controls(&harness, &[Role::Slider]).iter().enumerate() {
            let now = |harness: &App| {
                let (_, at) = controls(harness, &[Role::Slider])[index];
                let node = harness.root().children_recursive();
                let mut sliders = node.filter(|n| n.accesskit_node().role() == Role::Slider);
                let slider = sliders.nth(index).expect("a slider");
                (at, slider.accesskit_node().numeric_value())
            };
            let (at, first) = now(&harness);
            let track = at.left_center();
            // Somewhere else on its track.
            for there in [track + Vec2::new(70.0, 0.0), track + Vec2::new(40.0, 0.0)] {
                harness.hover_at(there);
                harness.step();
                harness
                    .input_mut()
                    .events
                    .push(button(there, PointerButton::Primary, true));
                harness.step();
                harness
                    .input_mut()
                    .events
                    .push(button(there, PointerButton::Primary, false));
                harness.run_steps(3);
            }
            let (at, moved) = now(&harness);
            assert_ne!(moved, first, "{place}: {name} does not move");
            // So that the next click is not the third.
            for _ in 0..8 {
                harness.step();
            }
            double_click(&mut harness, at.left_center() + Vec2::new(12.0, 0.0));
            harness.run_steps(3);
            assert_eq!(now(&harness).1, first, "{place}: {name} is not reset");
            seen.insert(name.clone());
        }
    }
    assert!(seen.len() > 20, "{seen:?}");
}

#[test]
fn a_number_is_typed_with_a_unit() {
    let mut harness = app("explore", TALL);
    show(&mut harness, "v1;explore;explore.paused=20");
    let delay = |harness: &App| state(harness)["explore"]["loop"]["relay"]["delay"].as_f64();
    for (text, value) in [("250 ms", 0.25), ("0.5", 0.5), ("2 mm", 0.5)] {
        // The number beside the slider is a field of its own, which a click opens.
        let mut fields = controls(&harness, &[Role::SpinButton, Role::Slider]).into_iter();
        let (_, at) = fields.find(|f| f.0 == "delay [s]").expect("a slider");
        let at = at.left_center() + Vec2::new(185.0, 0.0);
        harness.hover_at(at);
        harness.step();
        let click = [true, false].map(|p| button(at, PointerButton::Primary, p));
        harness.input_mut().events.extend(click);
        harness.step();
        harness.step();
        harness.key_press_modifiers(Modifiers::COMMAND, egui::Key::A);
        harness.step();
        harness.event(Event::Text(text.to_owned()));
        harness.step();
        harness.key_press(egui::Key::Enter);
        finish(&mut harness);
        for _ in 0..8 {
            harness.step();
        }
        assert_eq!(delay(&harness), Some(value), "{text}");
    }
}

#[test]
fn every_plot_says_what_stands_at_the_pointer_with_its_unit() {
    let mut count = 0;
    let mut harness = app("start", TALL);
    for place in PLOTS {
        show(&mut harness, place);
        for ([x, y], menu) in plots(&harness) {
            harness.hover_at(menu.left_top() - Vec2::new(40.0, 20.0));
            harness.step();
            harness.step();
            let line = |text: &String, axis: &str| {
                let (name, unit) = match axis.strip_suffix(']').and_then(|a| a.rsplit_once(" [")) {
                    Some((name, unit)) => (name, unit),
                    None => (axis, ""),
                };
                text.lines().any(|line| {
                    let value = line.strip_prefix(name).and_then(|l| l.strip_prefix(": "));
                    let value = value.and_then(|v| v.strip_suffix(unit));
                    value.is_some_and(|v| v.trim().parse::<f64>().is_ok())
                })
            };
            let texts = texts(&harness);
            // Near a curve of an axis of several quantities, the curve is named instead.
            let read = |t: &String| line(t, &x) && (line(t, &y) || y.contains(", "));
            assert!(texts.iter().any(read), "{place}: {y} over {x}: {texts:?}");
            count += 1;
        }
    }
    assert!(count > 40, "{count} plots");
}

#[test]
fn a_zoomed_plot_shows_all_of_it_again_after_a_double_click() {
    let mut harness = app("start", TALL);
    for place in [
        "v1;explore;explore.paused=20",
        "v1;backlash;backlash.paused=1",
        "v1;tune",
        "v1;compare;compare.file=drive-02;compare.look=places",
    ] {
        show(&mut harness, place);
        for _ in 0..3 {
            harness.step();
        }
        // The last one: Nyquist's plot, which is dragged itself, comes first.
        let ([x, y], menu) = plots(&harness).pop().expect("a plot");
        let at = menu.left_top() - Vec2::new(60.0, 40.0);
        let read = |harness: &mut App| {
            harness.hover_at(at);
            harness.step();
            harness.step();
            let mut texts = texts(harness);
            texts.retain(|t| t.lines().count() > 1 && t.contains(": "));
            texts
        };
        let whole = read(&mut harness);
        harness.input_mut().events.push(Event::Zoom(2.0));
        harness.step();
        let nearer = read(&mut harness);
        harness.hover_at(at - Vec2::new(30.0, 10.0));
        harness.step();
        let aside = texts(&harness);
        assert!(
            !whole.is_empty() && !nearer.is_empty(),
            "{place}: {y} over {x}"
        );
        double_click(&mut harness, at);
        for _ in 0..3 {
            harness.step();
        }
        harness.hover_at(at - Vec2::new(30.0, 10.0));
        harness.step();
        harness.step();
        assert_ne!(texts(&harness), aside, "{place}: {y} over {x}");
        assert_eq!(read(&mut harness), whole, "{place}: {y} over {x}");
    }
}

#[test]
fn nothing_is_read_at_the_pointer_over_an_open_menu() {
    let mut harness = app("start", TALL);
    show(&mut harness, "v1;explore;explore.paused=20");
    let (_, menu) = plots(&harness).pop().expect("a plot");
    let read = |harness: &mut App, at: Pos2| {
        harness.hover_at(at);
        harness.run_steps(3);
        texts(harness)
            .iter()
            .any(|t| t.lines().count() > 1 && t.contains(": "))
    };
    let aside = menu.left_top() - Vec2::new(60.0, 40.0);
    assert!(read(&mut harness, aside));
    harness.hover_at(menu.center());
    harness.step();
    let click = [true, false].map(|p| button(menu.center(), PointerButton::Primary, p));
    harness.input_mut().events.extend(click);
    harness.run_steps(2);
    harness.get_by_label("Data of this plot (CSV)");
    assert!(!read(&mut harness, menu.center()));
    assert!(!read(&mut harness, aside));
}

#[test]
fn every_plot_gives_its_picture_and_its_numbers() {
    let mut count = 0;
    let mut harness = app("start", TALL);
    let (sender, files) = channel();
    harness.state_mut().divert_files(sender);
    for place in PLOTS {
        show(&mut harness, place);
        for ([x, y], _) in plots(&harness) {
            let menu = format!("Menu of the plot: {y} over {x}");
            for (item, ending) in [
                ("Picture of this plot (SVG)", "svg"),
                ("Picture of this plot (PNG)", "png"),
                ("Data of this plot (CSV)", "csv"),
            ] {
                let mut menus = harness.query_all_by_label(&menu);
                menus.next().expect("a menu").click_accesskit();
                drop(menus);
                harness.step();
                harness.step();
                harness.get_by_label(item).click_accesskit();
                finish(&mut harness);
                let (name, bytes) = files.try_recv().expect("a file");
                assert!(name.ends_with(ending), "{name}");
                if ending == "png" {
                    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{place}: {menu}");
                    continue;
                }
                let text = String::from_utf8(bytes).expect("text");
                let first = text.lines().next().unwrap_or_default();
                if ending == "svg" {
                    assert!(text.contains(&x) && text.contains(&y), "{place}: {menu}");
                } else {
                    assert!(first.contains(&x) && first.contains(&y), "{place}: {first}");
                    assert!(text.lines().count() > 1, "{place}: {menu}");
                    let titles: Vec<&str> = first.split(',').collect();
                    let distinct: BTreeSet<&&str> = titles.iter().collect();
                    assert!(
                        first.contains('"') || distinct.len() == titles.len(),
                        "{place}: {first}"
                    );
                }
            }
            count += 1;
        }
    }
    assert!(count > 40, "{count} plots");
}

#[test]
fn on_a_phone_a_finger_finds_everything() {
    let mut harness = app("start", PHONE);
    let mut small = BTreeSet::new();
    let mut count = 0;
    for place in PLACES {
        show(&mut harness, place);
        let roles = [
            Role::Button,
            Role::Slider,
            Role::SpinButton,
            Role::CheckBox,
            Role::RadioButton,
            Role::ComboBox,
            Role::TextInput,
        ];
        for (name, at) in controls(&harness, &roles) {
            count += 1;
            if at.height() < FINGER - 0.1 {
                small.insert(format!("{name}: {:.0} points", at.height()));
            }
            let beyond = at.left() < -0.5 || at.right() > PHONE[0] + 0.5;
            assert!(!beyond, "{place}: {name} is cut off: {at:?}");
        }
    }
    assert!(count > 500, "{count} controls");
    assert!(small.is_empty(), "{small:#?}");
}
