//! What whoever cannot see or point needs: names of all controls, units of all numbers, labels of all axes, and
//! a way by keys alone.

#[path = "support/ui.rs"]
mod ui;

use std::collections::BTreeSet;
use std::sync::mpsc::channel;

use egui::Role;
use egui_kittest::kittest::{AccessKitNode, NodeT as _, Queryable as _};
use hysteron::GivenFile;
use ui::{App, NARROW, PLACES, TALL, WIDE, app, finish, show, state};

/// Numbers that have no unit: the loop of Explore is in units of its own signals, the rest are ratios.
const PLAIN: [&str; 14] = [
    "gain k",
    "hysteresis ε",
    "asymmetry a",
    "noise σ",
    "restitution",
    "gain before",
    "relay gain k",
    "plant gain, times",
    "time constants, times",
    "from",
    "to",
    // Of a process: its input and output are in the units of its file, here 1.
    "Largest input",
    "Largest output",
    "Speed of the playback, times real time",
];

/// Axes and columns that have no unit, but for those of the measurements, which are named by their columns.
const PLAIN_AXES: [&str; 26] = [
    "real part",
    "imaginary part",
    "output y",
    "output y, input u",
    "output y, set point 1",
    "output y, load 1 at the input",
    "step n",
    "error of the amplitude, log10",
    "hysteresis ε",
    "relay gain k",
    "amplitude a",
    "plant gain, times",
    "time constants, times",
    "relay phase",
    "rms",
    "mean",
    "output",
    "input",
    "input u",
    "ultimate gain K_u",
    "stability",
    "y of the model",
    "u",
    "y",
    "y - model",
    "force",
];

/// What is wrong with the names and units on the screen.
fn faults(harness: &App, place: &str) -> Vec<String> {
    let mut faults: Vec<String> = harness
        .unnamed_widgets()
        .iter()
        .map(|widget| format!("{place}: no name: {widget}"))
        .collect();
    for node in harness.root().children_recursive() {
        let node = node.accesskit_node();
        let number = matches!(node.role(), Role::Slider | Role::SpinButton);
        if number && !node.is_hidden() && !has_unit(&node) {
            let name = node.label().unwrap_or_default();
            faults.push(format!("{place}: no unit: {name} {:?}", node.value()));
        }
    }
    for table in harness.state().tables() {
        for (column, _) in &table.columns {
            if !named_with_unit(column) {
                faults.push(format!("{place}: no unit of a column: {column:?}"));
            }
        }
    }
    for axes in state(harness)["plots"].as_array().expect("plots") {
        for axis in axes.as_array().expect("two axes") {
            let axis = axis.as_str().expect("a name");
            if !named_with_unit(axis) {
                faults.push(format!("{place}: no label or unit of an axis: {axis:?}"));
            }
        }
    }
    faults
}

/// Whether the name of an axis or a column says its unit, or is known to have none.
fn named_with_unit(name: &str) -> bool {
    let unit = name.ends_with(']') && name.find('[').is_some_and(|at| at > 0);
    unit || PLAIN_AXES.contains(&name)
}

/// Whether a number says its unit: in brackets behind its name, or behind its value.
fn has_unit(node: &AccessKitNode<'_>) -> bool {
    let name = node.label().unwrap_or_default();
    let value = node.value().unwrap_or_default();
    let behind = value.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.e".contains(c));
    name.ends_with(']') || !behind.trim().is_empty() || PLAIN.contains(&name.as_str())
}

#[test]
fn every_control_has_a_name_every_number_a_unit_and_every_axis_a_label() {
    let mut found = BTreeSet::new();
    let mut plots = 0;
    for size in [TALL, NARROW] {
        let mut harness = app("start", size);
        for place in PLACES {
            show(&mut harness, place);
            found.extend(faults(&harness, place));
            plots += state(&harness)["plots"].as_array().map_or(0, Vec::len);
        }
    }
    assert!(plots > 100, "{plots} plots were seen");
    assert!(found.is_empty(), "{found:#?}");
}

/// Asks something of the plot with this menu; the file that it gives.
fn ask(harness: &mut App, menu: &str, item: &str) -> GivenFile {
    let (sender, files) = channel();
    harness.state_mut().divert_files(sender);
    harness.get_by_label(menu).click_accesskit();
    harness.step();
    harness.step();
    harness.get_by_label(item).click_accesskit();
    finish(harness);
    files.try_recv().expect("a file")
}

#[test]
fn every_plot_gives_its_picture_and_its_numbers() {
    let mut harness = app("explore", WIDE);
    finish(&mut harness);
    let menu = "Menu of the plot: its rate dy/dt [1/s] over output y";
    let (name, bytes) = ask(&mut harness, menu, "Data of this plot (CSV)");
    assert_eq!(name, "explore-its-rate-dy-dt-over-output-y.csv");
    let text = String::from_utf8(bytes).expect("text");
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some(
            "from the start: output y,from the start: its rate dy/dt [1/s],\
             limit cycle: output y,limit cycle: its rate dy/dt [1/s],now: output y,now: its rate dy/dt [1/s]"
        )
    );
    // The largest output on the limit cycle is its amplitude.
    let amplitude = state(&harness)["exact"]["amplitude"].as_f64();
    let largest = lines
        .filter_map(|line| line.split(',').nth(2)?.parse::<f64>().ok())
        .fold(0.0, f64::max);
    assert!((largest / amplitude.expect("a cycle") - 1.0).abs() < 1e-3);

    let (name, bytes) = ask(&mut harness, menu, "Picture of this plot (SVG)");
    assert_eq!(name, "explore-its-rate-dy-dt-over-output-y.svg");
    let svg = String::from_utf8(bytes).expect("text");
    for word in ["output y", "its rate dy/dt [1/s]"] {
        assert!(svg.contains(word), "{word}");
    }
    for elsewhere in ["real part", "Relay", "thresholds"] {
        assert!(!svg.contains(elsewhere), "{elsewhere}");
    }
    show(&mut harness, "v1;maps");
    let menu = "Menu of the plot: relay gain k over hysteresis ε";
    let (name, bytes) = ask(&mut harness, menu, "Data of this plot (CSV)");
    assert_eq!(name, "maps-relay-gain-k-over-hysteresis-ε.csv");
    assert!(bytes.starts_with("hysteresis ε,relay gain k,period [s]".as_bytes()));
}
