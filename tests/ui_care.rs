//! What is noticed only where it is missing: what Escape closes, where the keyboard is, what becomes of a number that
//! cannot be, whether a warning can be read, and where a page stands when one comes back to it.

#[path = "support/ui.rs"]
mod ui;

use std::path::PathBuf;

use egui::epaint::{ClippedShape, Color32, Shape};
use egui::{Event, Key, Modifiers, Rect, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use hysteron::language::Language;
use ui::{App, TALL, WIDE, app, click, finish, show, state, texts};

/// A phone's window, points.
const PHONE: [f32; 2] = [390.0, 844.0];

/// Contrast that small text needs (WCAG 2.2, 1.4.3).
const READABLE: f32 = 4.5;

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
        harness.get_by_label("Take back the last change");
        press(&mut harness, Key::Escape);
        assert!(
            harness
                .query_by_label("Take back the last change")
                .is_none()
        );
    }
    let lists = |harness: &App| harness.query_all_by_role(Role::ComboBox).count();
    assert_eq!(lists(&harness), 1);
    let entries = |harness: &App| texts(harness).len();
    let before = entries(&harness);
    harness.get_by_role(Role::ComboBox).click_accesskit();
    finish(&mut harness);
    assert!(entries(&harness) > before, "the list is open");
    press(&mut harness, Key::Escape);
    assert_eq!(entries(&harness), before, "the list is closed");
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
