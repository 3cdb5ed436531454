//! What people expect of any control, on every page: a slider is reset by a double click, a number is typed with its
//! unit; and on a phone a finger finds everything.

use std::collections::BTreeSet;

use crate::support::ui::{
    App, PLACES, TALL, app, button, controls, double_click, finish, show, state,
};
use egui::{
    Event, Key, Modifiers, PointerButton, Pos2, Role, TouchDeviceId, TouchId, TouchPhase, Vec2,
};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// A phone's window, points.
const PHONE: [f32; 2] = [390.0, 844.0];

/// Least height of what a finger presses, points.
const FINGER: f32 = 40.0;

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
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.step();
        harness.event(Event::Text(text.to_owned()));
        harness.step();
        harness.key_press(Key::Enter);
        finish(&mut harness);
        for _ in 0..8 {
            harness.step();
        }
        assert_eq!(delay(&harness), Some(value), "{text}");
    }
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

/// A finger goes from one place to another on the screen.
fn swipe(harness: &mut App, from: Pos2, way: Vec2) {
    const STEPS: usize = 8;
    let touch = |phase, pos| Event::Touch {
        device_id: TouchDeviceId(1),
        id: TouchId(1),
        phase,
        pos,
        force: None,
    };
    harness.input_mut().events.extend([
        touch(TouchPhase::Start, from),
        Event::PointerMoved(from),
        button(from, PointerButton::Primary, true),
    ]);
    harness.step();
    for step in 1..=STEPS {
        let at = from + way * (step as f32 / STEPS as f32);
        let moved = [touch(TouchPhase::Move, at), Event::PointerMoved(at)];
        harness.input_mut().events.extend(moved);
        harness.step();
    }
    harness.input_mut().events.extend([
        button(from + way, PointerButton::Primary, false),
        touch(TouchPhase::End, from + way),
        Event::PointerGone,
    ]);
    harness.run_steps(4);
}

#[test]
fn on_a_phone_one_plot_stays_in_view_while_the_sliders_scroll() {
    for place in [
        "v1;explore;explore.paused=20",
        "v1;backlash;backlash.paused=1",
        "v1;maps",
        "v1;tune",
        "v1;tune;tune.step=ultimate",
        "v1;tune;tune.step=adaptation",
        "v1;tune;tune.step=model",
        "v1;tune;tune.step=rules",
        "v1;tune;tune.step=loops",
        "v1;tune;tune.measured.from=record;tune.measured.file=process-02",
        "v1;tune;tune.measured.from=numbers",
    ] {
        let mut harness = app("start", PHONE);
        show(&mut harness, place);
        let plots = |harness: &App| -> Vec<(String, egui::Rect)> {
            let all = controls(harness, &[Role::Button]).into_iter();
            all.filter(|(name, _)| name.starts_with("Menu of the plot: "))
                .collect()
        };
        let sliders = |harness: &App| controls(harness, &[Role::Slider]);
        let before = plots(&harness);
        // By the margin, where no slider is dragged.
        swipe(
            &mut harness,
            Pos2::new(4.0, PHONE[1] - 130.0),
            Vec2::new(0.0, -160.0),
        );
        finish(&mut harness);
        let after = plots(&harness);
        let stays = before.iter().find(|plot| after.contains(plot));
        let (name, at) = stays.unwrap_or_else(|| panic!("{place}: {before:?} {after:?}"));
        assert!(at.bottom() < 0.75 * PHONE[1], "{place}: {name} at {at:?}");
        let twice = after.iter().filter(|plot| plot.0 == *name).count();
        assert_eq!(twice, 1, "{place}: {name}");
        if !place.contains("measured") {
            assert!(!sliders(&harness).is_empty(), "{place}: a slider beside it");
        }
    }
}

#[test]
fn on_a_phone_a_finger_on_a_plot_scrolls_the_page() {
    for (place, name) in [
        (
            "v1;compare;compare.file=drive-02",
            "Plot: x1 [rad] over time [s]",
        ),
        (
            "v1;compare;compare.file=drive-02",
            "Plot: x1 - model [rad] over time [s]",
        ),
    ] {
        let mut harness = app("start", PHONE);
        show(&mut harness, place);
        let plot = |harness: &App| harness.get_by_label(name).rect();
        let before = plot(&harness);
        assert!(before.center().y < PHONE[1], "{place}: {before}");
        swipe(&mut harness, before.center(), Vec2::new(0.0, -120.0));
        let after = plot(&harness);
        let moved = before.top() - after.top();
        assert!((60.0..=180.0).contains(&moved), "{place}: {moved}");
    }
}
