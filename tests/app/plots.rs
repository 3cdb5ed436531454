//! What people expect of any plot, on every page: it says what stands at the pointer or at the cursor that keys move,
//! is zoomed and moved by either, marks what is pointed at in its neighbours, and gives itself away.

use std::collections::BTreeSet;
use std::sync::mpsc::channel;

use crate::support::ui::{
    App, TALL, app, button, click, controls, double_click, finish, show, state, texts,
};
use egui::epaint::Shape;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Role, Vec2};
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

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

#[test]
fn every_plot_says_what_stands_at_the_pointer_with_its_unit() {
    let mut count = 0;
    let mut harness = app("start", TALL);
    for place in PLOTS {
        show(&mut harness, place);
        for (axes, menu) in plots(&harness) {
            harness.hover_at(menu.left_top() - Vec2::new(40.0, 20.0));
            harness.step();
            harness.step();
            let texts = texts(&harness);
            let read = texts
                .iter()
                .any(|t| reads(&t.lines().collect::<Vec<_>>(), &axes));
            assert!(read, "{place}: {axes:?}: {texts:?}");
            count += 1;
        }
    }
    assert!(count > 40, "{count} plots");
}

/// The value that a line says of an axis, if it is in its unit or in this with a prefix.
fn value_in(line: &str, axis: &str) -> Option<f64> {
    let (name, unit) = match axis.strip_suffix(']').and_then(|a| a.rsplit_once(" [")) {
        Some((name, unit)) => (name, unit),
        None => (axis, ""),
    };
    let value = line.strip_prefix(name)?.strip_prefix(": ")?;
    let number = value.strip_suffix(unit)?;
    let factors = [
        ("m", 1e-3),
        ("µ", 1e-6),
        ("n", 1e-9),
        ("k", 1e3),
        ("10⁻⁶", 1e-6),
    ];
    let prefixed = factors.iter().find_map(|(prefix, factor)| {
        Some(
            number
                .trim_end()
                .strip_suffix(prefix)?
                .trim()
                .parse::<f64>()
                .ok()?
                * factor,
        )
    });
    number.trim().parse().ok().or(prefixed)
}

/// Whether lines say a place by both axes. On a curve of an axis of several quantities, the curve is named instead.
fn reads(lines: &[&str], [x, y]: &[String; 2]) -> bool {
    let line = |axis: &str| lines.iter().any(|l| value_in(l, axis).is_some());
    line(x) && (line(y) || y.contains(", "))
}

/// The axes of the plot that has the keyboard, x and y, and what it says.
fn focused_plot(harness: &App) -> Option<([String; 2], Option<String>)> {
    let nodes = harness.root().children_recursive();
    let mut plots = nodes.filter(|n| n.accesskit_node().role() == Role::Image);
    let node = plots.find(Node::is_focused)?;
    let node = node.accesskit_node();
    let name = node.label()?;
    let (y, x) = name.strip_prefix("Plot: ")?.split_once(" over ")?;
    let said = node.value().map(|v| v.replace('\u{a0}', " "));
    Some(([x.to_owned(), y.to_owned()], said))
}

fn press(harness: &mut App, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
}

/// Gives the keyboard to the plot of this name.
fn focus_plot(harness: &mut App, name: &str) {
    harness.get_by_label(name).focus();
    harness.run_steps(3);
    assert!(focused_plot(harness).is_some(), "{name}");
}

#[test]
fn every_plot_is_reached_by_tab_and_read_by_the_arrows() {
    let mut count = 0;
    let mut harness = app("start", TALL);
    for place in PLOTS.into_iter().chain(["v1;maps"]) {
        show(&mut harness, place);
        let here = plots(&harness).len();
        let mut seen = 0;
        for _ in 0..200 {
            press(&mut harness, Modifiers::NONE, Key::Tab);
            let Some((axes, before)) = focused_plot(&harness) else {
                continue;
            };
            assert_eq!(before, None, "{place}: {axes:?}");
            let read = |harness: &App| focused_plot(harness).and_then(|p| p.1).expect("a value");
            press(&mut harness, Modifiers::NONE, Key::ArrowRight);
            let first = read(&harness);
            let lines: Vec<&str> = first.split("; ").collect();
            // A map says all of a place.
            let map = lines.len() > 3;
            assert!(map || reads(&lines, &axes), "{place}: {axes:?}: {first}");
            press(&mut harness, Modifiers::SHIFT, Key::ArrowLeft);
            assert_ne!(read(&harness), first, "{place}: {axes:?}");
            // It is on the screen too.
            let said = read(&harness).replace("; ", "\n");
            assert!(texts(&harness).contains(&said), "{place}: {axes:?}: {said}");
            press(&mut harness, Modifiers::NONE, Key::Escape);
            let left = focused_plot(&harness).expect("it keeps the keyboard");
            assert_eq!(left.1, None, "{place}: {axes:?}");
            seen += 1;
            if seen == here {
                break;
            }
        }
        assert_eq!(seen, here, "{place}");
        count += seen;
    }
    assert!(count > 40, "{count} plots");
}

#[test]
fn a_plot_is_zoomed_and_moved_by_keys() {
    let mut harness = app("explore", TALL);
    show(&mut harness, "v1;explore;explore.paused=20");
    focus_plot(&mut harness, "Plot: output y, input u over time [s]");
    let time = |harness: &App| {
        let said = focused_plot(harness).and_then(|p| p.1).expect("a value");
        let mut lines = said.split("; ");
        lines.find_map(|l| value_in(l, "time [s]")).expect("a time")
    };
    let zoom = |harness: &App| {
        let link = harness.state().link();
        let zoom = link.split_once("time:").map(|(_, z)| z.to_owned())?;
        let ends: Vec<f64> = zoom
            .split(',')
            .take(2)
            .filter_map(|e| e.parse().ok())
            .collect();
        Some([ends[0], ends[1]])
    };
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    let begin = time(&harness);
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    let step = time(&harness) - begin;
    press(&mut harness, Modifiers::SHIFT, Key::ArrowRight);
    let far = time(&harness) - begin - step;
    assert!((far / step - 10.0).abs() < 0.1, "{step} and {far} s");
    assert_eq!(zoom(&harness), None);
    for _ in 0..3 {
        press(&mut harness, Modifiers::NONE, Key::Plus);
    }
    let nearer = zoom(&harness).expect("it is zoomed");
    let at = time(&harness);
    assert!(nearer[0] < at && at < nearer[1], "{nearer:?} about {at} s");
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    let finer = time(&harness) - at;
    assert!((step / finer - 1.5_f64.powi(3)).abs() < 0.1, "{finer} s");
    press(&mut harness, Modifiers::COMMAND, Key::ArrowRight);
    let moved = zoom(&harness).expect("it is zoomed");
    assert!(moved[0] > nearer[0] && moved[1] > nearer[1], "{moved:?}");
    press(&mut harness, Modifiers::COMMAND, Key::ArrowLeft);
    // Where the cursor goes beyond what is in view, that follows.
    while time(&harness) < nearer[1] {
        press(&mut harness, Modifiers::SHIFT, Key::ArrowRight);
    }
    assert!(zoom(&harness).is_some_and(|z| z[1] > nearer[1]));
    press(&mut harness, Modifiers::NONE, Key::Home);
    assert_eq!(zoom(&harness), None);
    // The menu, and the way back.
    press(&mut harness, Modifiers::NONE, Key::Enter);
    harness.get_by_label("Data of this plot (CSV)");
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.query_by_label("Data of this plot (CSV)").is_none());
}

#[test]
fn a_place_of_a_map_is_chosen_by_keys() {
    let mut harness = app("maps", TALL);
    finish(&mut harness);
    focus_plot(&mut harness, "Plot: relay gain k over hysteresis ε");
    for key in [Key::ArrowRight, Key::ArrowRight, Key::ArrowUp] {
        press(&mut harness, Modifiers::SHIFT, key);
    }
    let (_, said) = focused_plot(&harness).expect("a plot");
    let said = said.expect("a value");
    assert!(
        said.contains("; period ") && said.contains(" s; "),
        "{said}"
    );
    press(&mut harness, Modifiers::NONE, Key::Enter);
    click(&mut harness, "Show this loop in Explore");
    let state = state(&harness);
    let relay = &state["explore"]["loop"]["relay"];
    for (name, key) in [("hysteresis ε", "hysteresis"), ("relay gain k", "gain")] {
        let value = relay[key].as_f64().expect("a number");
        assert!(
            said.contains(&format!("{name} {value:.3}")),
            "{said}: {relay}"
        );
    }
}

/// The place of the plot of this name.
fn plot_at(harness: &App, name: &str) -> Rect {
    harness.get_by_label(&format!("Plot: {name}")).rect()
}

/// Rings that mark a place, and lines from the top to the bottom of a plot that mark an x.
fn marks(harness: &App, plot: Rect) -> (Vec<Pos2>, Vec<f32>) {
    let (mut rings, mut lines) = (Vec::new(), Vec::new());
    let color = harness.ctx.global_style().visuals.selection.stroke.color;
    for clipped in &harness.output().shapes {
        match &clipped.shape {
            Shape::Circle(circle)
                if circle.stroke.color == color && plot.contains(circle.center) =>
            {
                rings.push(circle.center);
            }
            Shape::LineSegment {
                points: [a, b],
                stroke,
            } if a.x == b.x
                && stroke.color == color
                && plot.expand(1.0).contains(*a)
                && (a.y - b.y).abs() > 0.9 * plot.height() =>
            {
                lines.push(a.x);
            }
            _ => {}
        }
    }
    (rings, lines)
}

#[test]
fn a_moment_that_is_pointed_at_is_marked_in_the_other_plots() {
    let mut harness = app("start", TALL);
    for (link, over_time, others) in [
        (
            "v1;explore;explore.paused=20",
            "output y, input u over time [s]",
            &["its rate of change [1/s] over output y"][..],
        ),
        (
            "v1;backlash;backlash.paused=1",
            "position [mrad] over time [s]",
            &[
                "velocity v1 [rad/s] over motor position x1 [mrad]",
                "load x2 [mrad] over motor x1 [mrad]",
            ][..],
        ),
    ] {
        show(&mut harness, link);
        let time = plot_at(&harness, over_time);
        let there = |harness: &App, name: &str| marks(harness, plot_at(harness, name));
        let mut last = Vec::new();
        // Soon after the start: a phase portrait shows a few periods.
        for x in [0.06, 0.07] {
            harness.hover_at(time.lerp_inside(Vec2::new(x, 0.5)));
            harness.run_steps(3);
            let rings: Vec<Pos2> = others
                .iter()
                .flat_map(|name| there(&harness, name).0)
                .collect();
            assert_eq!(rings.len(), others.len(), "{link}");
            assert_ne!(rings, last, "{link}: they go along");
            last = rings;
        }
        // The same by keys.
        harness.hover_at(Pos2::ZERO);
        harness.run_steps(3);
        for name in others {
            assert_eq!(there(&harness, name).0, [], "{link}");
        }
        focus_plot(&mut harness, &format!("Plot: {over_time}"));
        press(&mut harness, Modifiers::NONE, Key::ArrowRight);
        for name in others {
            assert_eq!(there(&harness, name).0.len(), 1, "{link}");
        }
        press(&mut harness, Modifiers::NONE, Key::Escape);
        if others.len() == 1 {
            // A place that was passed, and when that was.
            harness.hover_at(last[0]);
            harness.run_steps(3);
            let lines = there(&harness, over_time).1;
            assert_eq!(lines.len(), 1, "{link}");
            assert!(
                lines[0] <= time.left() + 0.07 * time.width() + 1.0,
                "{link}: {lines:?}"
            );
        } else {
            // Both have the motor's position across.
            let name = others[0];
            focus_plot(&mut harness, &format!("Plot: {name}"));
            press(&mut harness, Modifiers::NONE, Key::ArrowRight);
            assert_eq!(there(&harness, others[1]).1.len(), 1, "{link}");
        }
    }
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
                    // The unit may have a prefix there.
                    let [x, y] = [&x, &y].map(|axis| axis.split(" [").next().unwrap_or(axis));
                    assert!(text.contains(x) && text.contains(y), "{place}: {menu}");
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
