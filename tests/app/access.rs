//! What whoever cannot see or point needs: names of all controls, units of all numbers, labels of all axes, and
//! a way by keys alone.

use std::collections::BTreeSet;
use std::sync::mpsc::channel;

use crate::support::ui::{
    App, NARROW, PLACES, TALL, WIDE, app, click, finish, finish_when, show, state,
};
use egui::accesskit::Live;
use egui::{Key, Role};
use egui_kittest::kittest::{AccessKitNode, NodeT as _, Queryable as _};
use hysteron::GivenFile;

/// Numbers that have no unit: the loop of Explore is in units of its own signals, the rest are ratios.
const PLAIN: [&str; 24] = [
    // As they were read off a test, in the units of its controller.
    "amplitude",
    "hysteresis",
    "input while down",
    "input while up",
    "full scale of the input",
    "set point of the test",
    "gain k",
    "hysteresis ε",
    "asymmetry α",
    "full power",
    "reference r",
    "dead zone d",
    "output at the start",
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
    "Playback speed as a multiple of real time",
];

/// Axes and columns that have no unit, but for those of the measurements, which are named by their columns.
const PLAIN_AXES: [&str; 24] = [
    "real part",
    "imaginary part",
    "output y",
    "output y, input u",
    "output y, set point 1",
    "output y, load 1",
    "step n",
    "error of the amplitude, log10",
    "hysteresis ε",
    "relay gain k",
    "amplitude a",
    "plant gain, times",
    "time constants, times",
    "relay phase",
    "output",
    "input",
    "input u",
    "ultimate gain Ku",
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

#[test]
fn a_screen_reader_says_which_window_which_plot_and_what_was_found() {
    let mut harness = app("start", WIDE);
    for place in PLACES {
        show(&mut harness, place);
        let root = harness.root().accesskit_node();
        assert_eq!(root.label().as_deref(), Some("Hysteron"));
        let plots = harness.query_all_by_role(Role::Image);
        let names: Vec<_> = plots.map(|p| p.accesskit_node().label()).collect();
        let said = |n: &Option<String>| n.as_deref().is_some_and(|n| n.starts_with("Plot: "));
        assert!(names.iter().all(said), "{place}: {names:?}");
        let drawn = state(&harness)["plots"].as_array().map_or(0, Vec::len);
        assert!(names.len() >= drawn, "{place}: {names:?} of {drawn}");
        // What is said by itself, when it changes.
        let nodes = harness.root().children_recursive();
        let spoken: Vec<_> = nodes
            .filter(|n| n.accesskit_node().live() == Live::Polite)
            .map(|n| n.accesskit_node().value())
            .collect();
        assert!((1..=3).contains(&spoken.len()), "{place}: {spoken:?}");
    }
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

/// Width and height of a picture, and how many colours it has.
fn png(bytes: &[u8]) -> ([usize; 2], usize) {
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"));
    let number = |at: usize| {
        let four = bytes[at..at + 4].try_into().expect("four bytes");
        u32::from_be_bytes(four) as usize
    };
    let size = [number(16), number(20)];
    // Behind the signature and the head stand the pixels, row by row, each row behind a byte.
    let (head, data) = (8 + 25, number(8 + 25));
    assert_eq!(&bytes[head + 4..head + 8], b"IDAT");
    let pixels = &bytes[head + 8..head + 8 + data];
    let rows = miniz_oxide::inflate::decompress_to_vec_zlib(pixels).expect("pixels");
    assert_eq!(rows.len(), (1 + 3 * size[0]) * size[1]);
    let colours = rows
        .chunks(1 + 3 * size[0])
        .flat_map(|row| row[1..].chunks(3));
    (size, colours.collect::<BTreeSet<_>>().len())
}

#[test]
fn every_plot_gives_its_picture_and_its_numbers() {
    let mut harness = app("explore", WIDE);
    finish(&mut harness);
    let menu = "Menu of the plot: its rate of change [1/s] over output y";
    let (name, bytes) = ask(&mut harness, menu, "Data of this plot (CSV)");
    assert_eq!(name, "explore-its-rate-of-change-over-output-y.csv");
    let text = String::from_utf8(bytes).expect("text");
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some(
            "from the start: output y,from the start: its rate of change [1/s],\
             limit cycle: output y,limit cycle: its rate of change [1/s],now: output y,now: its rate of change [1/s]"
        )
    );
    // The largest output on the limit cycle is its amplitude.
    let amplitude = state(&harness)["exact"]["amplitude"].as_f64();
    let largest = lines
        .filter_map(|line| line.split(',').nth(2)?.parse::<f64>().ok())
        .fold(0.0, f64::max);
    assert!((largest / amplitude.expect("a cycle") - 1.0).abs() < 1e-3);

    let (name, bytes) = ask(&mut harness, menu, "Picture of this plot (SVG)");
    assert_eq!(name, "explore-its-rate-of-change-over-output-y.svg");
    let svg = String::from_utf8(bytes).expect("text");
    for word in ["output y", "its rate of change [1/s]"] {
        assert!(svg.contains(word), "{word}");
    }
    for elsewhere in ["real part", "Relay", "thresholds"] {
        assert!(!svg.contains(elsewhere), "{elsewhere}");
    }
    let (name, bytes) = ask(&mut harness, menu, "Picture of this plot (PNG)");
    assert_eq!(name, "explore-its-rate-of-change-over-output-y.png");
    let (size, colours) = png(&bytes);
    // A part of the page, and not a blank one.
    assert!(size[0] > 300 && size[0] < 1000, "{size:?}");
    assert!(size[1] > 150 && size[1] < 500, "{size:?}");
    assert!(colours > 24, "{colours} colours");

    show(&mut harness, "v1;maps");
    let menu = "Menu of the plot: relay gain k over hysteresis ε";
    let (name, bytes) = ask(&mut harness, menu, "Data of this plot (CSV)");
    assert_eq!(name, "maps-relay-gain-k-over-hysteresis-ε.csv");
    assert!(bytes.starts_with("hysteresis ε,relay gain k,period [s]".as_bytes()));
}

/// Presses Tab until the control of this name has the keyboard.
fn tab_to(harness: &mut App, name: &str) {
    for _ in 0..200 {
        harness.key_press(Key::Tab);
        harness.step();
        let found = harness.query_all_by_label(name).any(|n| n.is_focused());
        if found {
            return;
        }
    }
    panic!("the keys do not lead to {name}");
}

fn press(harness: &mut App, key: Key) {
    harness.key_press(key);
    finish(harness);
}

#[test]
fn keys_alone_lead_everywhere() {
    let mut harness = app("start", WIDE);
    finish(&mut harness);
    tab_to(&mut harness, "Open Explore");
    press(&mut harness, Key::Enter);
    assert_eq!(state(&harness)["page"], "explore");
    // A slider is moved by the arrows and reset by Delete.
    let gain = |harness: &App| {
        let gain = state(harness)["explore"]["loop"]["relay"]["gain"].as_f64();
        gain.expect("a gain")
    };
    tab_to(&mut harness, "gain k");
    for _ in 0..5 {
        press(&mut harness, Key::ArrowRight);
    }
    assert!(gain(&harness) > 1.0, "{}", gain(&harness));
    press(&mut harness, Key::Delete);
    assert_eq!(gain(&harness), 1.0);
    // A menu.
    tab_to(&mut harness, "Look");
    press(&mut harness, Key::Enter);
    tab_to(&mut harness, "Light");
    press(&mut harness, Key::Enter);
    assert_eq!(state(&harness)["look"], "Light");
    // The menu of a plot.
    let (sender, files) = channel();
    harness.state_mut().divert_files(sender);
    tab_to(
        &mut harness,
        "Menu of the plot: output y, input u over time [s]",
    );
    press(&mut harness, Key::Enter);
    tab_to(&mut harness, "Data of this plot (CSV)");
    press(&mut harness, Key::Enter);
    let (name, _) = files.try_recv().expect("a file");
    assert_eq!(name, "explore-output-y-input-u-over-time.csv");
    // A measurement, and an effect.
    press(&mut harness, Key::Num6);
    assert_eq!(state(&harness)["page"], "compare");
    tab_to(&mut harness, "Open drive-02");
    press(&mut harness, Key::Enter);
    tab_to(&mut harness, "Add Coulomb friction");
    press(&mut harness, Key::Enter);
    assert!(state(&harness)["error"].as_f64().is_some_and(|e| e < 1.2));
}

#[test]
fn with_less_motion_nothing_moves_that_was_not_started() {
    let clock = |harness: &App| state(harness)["clock"].as_f64().expect("a clock");
    let moved = |harness: &mut App| {
        let before = clock(harness);
        for _ in 0..10 {
            harness.step();
        }
        clock(harness) > before
    };
    let mut harness = app("start", WIDE);
    assert!(moved(&mut harness), "the first page is alive");
    harness.get_by_label("Look").click();
    harness.step();
    harness.step();
    harness.get_by_label("Less motion").click();
    finish(&mut harness);
    assert_eq!(state(&harness)["calm"], true);
    assert!(!moved(&mut harness));
    assert_eq!(
        state(&harness)["link"],
        "v1;start",
        "a link is not about it"
    );
    for page in ["backlash", "start"] {
        show(&mut harness, &format!("v1;{page}"));
        assert!(!moved(&mut harness), "{page}");
        harness.get_by_label("Play").click();
        finish(&mut harness);
        assert!(moved(&mut harness), "{page}: who presses Play sees it");
        harness.get_by_label("Pause").click();
        finish(&mut harness);
        assert!(!moved(&mut harness), "{page}");
    }
}

/// A file that is let go over the window.
#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

#[test]
fn a_file_that_was_opened_is_opened_again_by_one_click() {
    let mut harness = app("compare", WIDE);
    let source = format!("{}/../tests/data/drive-02.csv", env!("CARGO_MANIFEST_DIR"));
    let file: egui::DroppedFileHandle = std::sync::Arc::new(Dropped(source.into()));
    harness.input_mut().dropped_files.push(file);
    harness.step();
    let opened = |harness: &mut App| {
        finish_when(harness, "opened file", |s| s["file"] == "drive-02.csv");
    };
    opened(&mut harness);
    click(&mut harness, "Open another");
    harness.get_by_label("Recent files:");
    harness.get_by_label("drive-02.csv").click();
    opened(&mut harness);
}
