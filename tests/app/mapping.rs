//! A file that does not say what its columns are: a form asks, and the answer is the one that a file gives which does.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::support::ui::{
    App, TALL, WIDE, app, choose, click, finish, finish_when, picture, state, texts, type_over,
};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use hysteron::language::{self, Language};
use serde_json::{Value, json};

/// A phone's window, points.
const PHONE: [f32; 2] = [390.0, 844.0];

/// A drive without friction in its model, in SI units: t, u, x1, v1.
fn drive() -> String {
    let path = format!("{}/../tests/data/drive-02.csv", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("a file of the tests")
}

/// Its columns.
fn columns(csv: &str) -> [Vec<f64>; 4] {
    let rows = csv.lines().skip(1);
    let fields = |row: &str| -> Vec<f64> {
        let numbers = row.split(',').map(|f| f.parse().expect("a number"));
        numbers.collect()
    };
    let rows: Vec<Vec<f64>> = rows.map(fields).collect();
    std::array::from_fn(|i| rows.iter().map(|row| row[i]).collect())
}

/// It as a matrix of MATLAB, with the torque in the other direction.
fn matrix() -> Vec<u8> {
    let [t, u, x, v] = columns(&drive());
    let turned = u.iter().map(|u| -u).collect();
    let all = [t, turned, x, v].concat();
    let numbers: Vec<u8> = all.iter().flat_map(|n| n.to_le_bytes()).collect();
    let rows = i32::try_from(all.len() / 4).expect("a size");
    crate::support::mat::file(false, "log", 6, [rows, 4], 9, &numbers)
}

/// What is said of a drive by its columns, and not by its name.
fn found(harness: &App) -> Value {
    let state = state(harness);
    json!([state["error"], state["candidates"], state["verdict"]])
}

/// What is found in the file that says what its columns are.
fn expected() -> Value {
    let mut harness = app("compare", WIDE);
    open(&mut harness, "drive.csv", drive().as_bytes());
    found(&harness)
}

fn open(harness: &mut App, name: &str, bytes: &[u8]) {
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, name, bytes);
    finish(harness);
}

fn form(harness: &App) -> Value {
    state(harness)["mapping"].clone()
}

fn missing(harness: &App) -> Value {
    form(harness)["missing"].clone()
}

fn press(harness: &mut App, label: &str) {
    harness.get_by_label(label).click_accesskit();
    finish(harness);
}

/// Says what is what in [`matrix`].
fn map_matrix(harness: &mut App) {
    for (channel, column, unit, of) in [
        ("Time", "log(:,1)", "Unit of the time", "s"),
        ("Input", "log(:,2)", "Unit of the input", "N m"),
        ("Position", "log(:,3)", "Unit of the position", "rad"),
        ("Velocity", "log(:,4)", "Unit of the velocity", "rad/s"),
    ] {
        choose(harness, channel, column);
        choose(harness, unit, of);
    }
    press(harness, "Flip sign of the input");
}

/// A file that is let go over the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

/// The app, from another page, with this file named on the command line, as soon as the state is so.
fn started_with(name: &str, bytes: &[u8], what: &str, holds: impl Fn(&Value) -> bool) -> App {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).expect("a file");
    let mut harness = app("backlash", WIDE);
    let ctx = harness.ctx.clone();
    harness.state_mut().open_path(&ctx, &path);
    finish_when(&mut harness, what, holds);
    harness
}

#[test]
fn a_file_of_the_command_line_is_opened_in_compare() {
    let drive = drive();
    let harness = started_with("given.csv", drive.as_bytes(), "file", |state| {
        state["file"] == "given.csv"
    });
    assert_eq!(state(&harness)["page"], "compare");
    assert_eq!(found(&harness), expected());
    // One that does not say what its columns are.
    let harness = started_with("given.mat", &matrix(), "form", |state| {
        state["mapping"].is_object()
    });
    assert_eq!(state(&harness)["page"], "compare");
    let harness = started_with("given-bad.csv", &[0xff, 0xfe, 0], "sentence", |state| {
        state["message"].is_string()
    });
    let message = state(&harness)["message"].clone();
    let message = message.as_str().expect("a sentence");
    assert!(message.contains("given-bad.csv"), "{message}");
    assert!(texts(&harness).iter().any(|t| t == message), "{message}");
}

#[test]
fn a_file_of_matlab_is_mapped_diagnosed_and_opened_again() {
    let expected = expected();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ui-mapping-log.mat");
    std::fs::write(&path, matrix()).expect("a file");
    let mut harness = app("compare", TALL);
    let file: egui::DroppedFileHandle = Arc::new(Dropped(path));
    harness.input_mut().dropped_files.push(file);
    finish_when(&mut harness, "form", |s| s["mapping"].is_object());
    harness.get_by_label("Which column is what?");
    harness.get_by_label("A MATLAB file does not say what its columns are.");
    assert_eq!(
        missing(&harness),
        json!(["Time or Sampling period", "Input", "Position or Velocity"])
    );
    assert!(open_it_is_disabled(&harness));
    map_matrix(&mut harness);
    assert_eq!(missing(&harness), json!([]));
    harness
        .get_by_label_contains("10000 values from 0 to 2\u{a0}s; the first are 0, 0.0002, 0.0004");
    picture(&mut harness_of(WIDE), "compare_mapping");
    click(&mut harness, "Open it");
    assert_eq!(state(&harness)["file"], "ui-mapping-log.mat");
    assert_eq!(found(&harness), expected);
    // Once more, without being asked.
    click(&mut harness, "Open another");
    click(&mut harness, "ui-mapping-log.mat");
    finish_when(&mut harness, "file", |s| s["error"].is_number());
    assert_eq!((form(&harness), found(&harness)), (Value::Null, expected));
    // The other page that takes files knows it too.
    click(&mut harness, "Backlash");
    click(&mut harness, "ui-mapping-log.mat");
    finish_when(&mut harness, "file in Backlash", |s| {
        s["backlash"]["file"] == "ui-mapping-log.mat"
    });
}

/// The form for the matrix, filled in.
fn harness_of(size: [f32; 2]) -> App {
    let mut harness = app("compare", size);
    open(&mut harness, "log.mat", &matrix());
    map_matrix(&mut harness);
    harness
}

fn open_it_is_disabled(harness: &App) -> bool {
    let button = harness.get_by_label("Open it");
    button.accesskit_node().is_disabled()
}

/// A log in German, with names and units of its own.
fn german_log() -> String {
    use std::fmt::Write as _;
    let mut text = String::from("Zeit_ms;Status;Strom;Encoder;Drehzahl [U/min]\n");
    let [t, u, x, v] = columns(&drive());
    for (k, t) in t.iter().enumerate() {
        let counts = (x[k] / std::f64::consts::TAU * 1e6).round();
        let row = format!(
            "{};7;{};{counts};{}",
            t * 1e3,
            u[k] / 0.05,
            v[k] * 60.0 / std::f64::consts::TAU
        );
        let _ = writeln!(text, "{}", row.replace('.', ","));
    }
    text
}

#[test]
fn a_csv_with_names_of_its_own_is_guessed_and_mapped() {
    let mut harness = app("compare", TALL);
    open(&mut harness, "log.csv", german_log().as_bytes());
    // What resembles something is chosen already; what is not known is asked.
    let reason = form(&harness)["reason"].clone();
    assert!(
        reason
            .as_str()
            .is_some_and(|r| r.contains("log.csv, line 1")),
        "{reason}"
    );
    assert_eq!(
        missing(&harness),
        json!(["Unit of the input", "Unit of the position"])
    );
    choose(&mut harness, "Unit of the input", "A");
    choose(&mut harness, "Unit of the position", "counts");
    assert_eq!(
        missing(&harness),
        json!(["Counts per turn or length of a count"])
    );
    type_over(
        &mut harness,
        "Counts per turn or length of a count",
        "1000000/rev",
    );
    // With a unit of its own, or with that of the menu, which goes with the input.
    let constant = "Torque constant, if it is known";
    type_over(&mut harness, constant, "0,05 N m/A");
    let said = |harness: &App| form(harness)["reading"]["torque_constant"].clone();
    assert_eq!(said(&harness), "0.05 N m/A");
    type_over(&mut harness, constant, "50");
    choose(&mut harness, "Unit of the torque constant", "mN m/A");
    assert_eq!(said(&harness), "50 mN m/A");
    choose(&mut harness, "Unit of the input", "V");
    assert_eq!(said(&harness), "50 N m/V");
    choose(&mut harness, "Unit of the input", "A");
    choose(&mut harness, "Unit of the torque constant", "N m/A");
    type_over(&mut harness, constant, "0,05");
    assert_eq!(
        form(&harness)["reading"],
        json!({
            "kind": "drive",
            "map": "t=Zeit_ms [ms], u=Strom [A], x1=Encoder [counts, 1000000/rev], v1=Drehzahl [U/min]",
            "torque_constant": "0.05 N m/A",
            "period": "",
        })
    );
    click(&mut harness, "Open it");
    // Rounded to counts it is another record, with the same thing missing.
    let state = state(&harness);
    assert_eq!(
        (&state["file"], &state["message"]),
        (&json!("log.csv"), &Value::Null)
    );
    assert_eq!(
        state["candidates"][0]["effects"],
        json!(["coulomb_friction"])
    );
}

#[test]
fn a_process_takes_any_unit() {
    let row = |k: i32| format!("{k};{};{}", k / 10 % 2, 20.0 + 0.1 * f64::from(k % 20));
    let rows = (0..200).map(row).collect::<Vec<_>>().join("\n");
    let mut harness = app("compare", TALL);
    open(&mut harness, "oven.txt", rows.as_bytes());
    press(&mut harness, "A process");
    choose(&mut harness, "Time", "column 1");
    choose(&mut harness, "Unit of the time", "s");
    choose(&mut harness, "Input", "column 2");
    choose(&mut harness, "Output", "column 3");
    assert_eq!(missing(&harness), json!([]));
    // A field that is being typed into may be empty for a while.
    type_over(&mut harness, "Unit of the output", "x");
    harness.key_press(egui::Key::Backspace);
    harness.run_steps(2);
    assert_eq!(missing(&harness), json!(["Unit of the output"]));
    type_over(&mut harness, "Unit of the output", "counts");
    assert_eq!(missing(&harness), json!([]));
    type_over(&mut harness, "Unit of the output", "degC");
    harness.get_by_label_contains("200 values from 20 to 21.9 degC");
    click(&mut harness, "Open it");
    assert_eq!(state(&harness)["file"], "oven.txt");
}

#[test]
fn numbers_alone_that_blanks_divide_are_mapped_with_a_command_as_input() {
    let expected = expected();
    let rows = drive().lines().skip(1).collect::<Vec<_>>().join("\n  ");
    let mut harness = app("compare", TALL);
    open(&mut harness, "rig.dat", rows.replace(',', "   ").as_bytes());
    let reason = form(&harness)["reason"].clone();
    assert!(
        reason
            .as_str()
            .is_some_and(|r| r.contains("is not a header; the first line must name")),
        "{reason}"
    );
    for (channel, column, unit, of) in [
        ("Time", "column 1", "Unit of the time", "s"),
        ("Input", "column 2", "Unit of the input", "PWM"),
        ("Position", "column 3", "Unit of the position", "rad"),
        ("Velocity", "column 4", "Unit of the velocity", "rad/s"),
    ] {
        choose(&mut harness, channel, column);
        choose(&mut harness, unit, of);
    }
    harness.get_by_label("Torque constant, if it is known");
    click(&mut harness, "Open it");
    assert_eq!(state(&harness)["file"], "rig.dat");
    assert_eq!(found(&harness), expected);
    in_german(&mut harness);
}

/// Nothing that is shown is left in English but the name of the file.
fn in_german(harness: &mut App) {
    harness.state_mut().speak(Language::German);
    finish(harness);
    let mut missed = language::missed();
    missed.retain(|text| !["rig.dat", "oven.csv"].contains(&text.as_str()));
    assert_eq!(missed, Vec::<String>::new());
    harness.state_mut().speak(Language::English);
    finish(harness);
}

#[test]
fn what_can_be_one_column_only_is_taken_and_what_can_be_several_is_asked() {
    let row = |k: i32| {
        let heat = f64::from(k / 10 % 2);
        format!(
            "{k},{heat},{},{}",
            20.0 + 0.1 * f64::from(k % 20),
            1 - k % 2
        )
    };
    let rows = (0..200).map(row).collect::<Vec<_>>().join("\n");
    let mut harness = app("compare", TALL);
    open(
        &mut harness,
        "oven.csv",
        format!("Time,Q1,T1,Q2\n{rows}").as_bytes(),
    );
    let reason = form(&harness)["reason"].clone();
    assert!(
        reason
            .as_str()
            .is_some_and(|r| r.contains("it is not clear which is meant: Q1, Q2")),
        "{reason}"
    );
    in_german(&mut harness);
    click(&mut harness, "Cancel");
    open(
        &mut harness,
        "oven.csv",
        format!("Time,Q1,T1,note\n{rows}").as_bytes(),
    );
    assert_eq!(form(&harness), Value::Null);
    assert_eq!(state(&harness)["file"], "oven.csv");
    in_german(&mut harness);
    // A unit of a process in what looks like a drive.
    open(
        &mut harness,
        "oven.csv",
        format!("t [s],u [%],x [degC],note\n{rows}").as_bytes(),
    );
    let reason = form(&harness)["reason"].clone();
    assert!(
        reason.as_str().is_some_and(|r| r.contains("in any unit")),
        "{reason}"
    );
    in_german(&mut harness);
}

#[test]
fn cancel_keeps_what_was_open() {
    let mut harness = app("compare", WIDE);
    open(&mut harness, "drive.csv", drive().as_bytes());
    press(&mut harness, "Add Coulomb friction");
    let before = state(&harness);
    let kept = |s: &Value| {
        let state = s.clone();
        ["file", "effects", "error", "steps", "verdict", "message"].map(|key| state[key].clone())
    };
    open(&mut harness, "log.mat", &matrix());
    assert!(form(&harness).is_object());
    // Another file that cannot be is refused meanwhile, and the form stays.
    open(&mut harness, "bad.csv", b"no measurement\n");
    let said = form(&harness)["error"].clone();
    assert!(
        said.as_str().is_some_and(|s| s.contains("bad.csv")),
        "{said}"
    );
    click(&mut harness, "Cancel");
    assert_eq!(form(&harness), Value::Null);
    assert_eq!(kept(&state(&harness)), kept(&before));
    harness.get_by_label("Take back Coulomb friction");
}

#[test]
fn another_file_of_the_same_name_has_a_form_of_its_own() {
    let mut harness = app("compare", WIDE);
    open(&mut harness, "log.csv", b"a,b\n0,1\n1,2\n2,1\n");
    open(&mut harness, "log.csv", b"when,what\n0,1\n1,2\n2,1\n");
    assert_eq!(form(&harness)["error"], Value::Null);
    harness.get_by_label_contains("when,what");
}

#[test]
fn a_wrong_mapping_says_so_and_can_be_mended() {
    let mut harness = app("compare", TALL);
    open(&mut harness, "log.mat", &matrix());
    map_matrix(&mut harness);
    let said = |harness: &App, part: &str| {
        let error = form(harness)["error"].clone();
        assert!(error.as_str().is_some_and(|e| e.contains(part)), "{error}");
        let error = error.as_str().unwrap_or_default().to_owned();
        assert!(texts(harness).contains(&error), "it is on the screen");
    };
    // Twice the same column, units of turning and of sliding, a time that is none.
    choose(&mut harness, "Velocity", "log(:,3)");
    choose(&mut harness, "Unit of the velocity", "rad/s");
    click(&mut harness, "Open it");
    said(&harness, "'log(:,3)' appears in the mapping twice");
    choose(&mut harness, "Velocity", "none");
    choose(&mut harness, "Unit of the position", "mm");
    click(&mut harness, "Open it");
    said(&harness, "rotational and translational units are mixed");
    choose(&mut harness, "Unit of the position", "counts");
    type_over(&mut harness, "Counts per turn or length of a count", "many");
    click(&mut harness, "Open it");
    said(&harness, "the unit 'counts, many' does not fit");
    choose(&mut harness, "Unit of the position", "rad");
    choose(&mut harness, "Time", "log(:,4)");
    choose(&mut harness, "Unit of the time", "s");
    click(&mut harness, "Open it");
    said(&harness, "time does not increase");
    assert_eq!(state(&harness)["file"], Value::Null);
    choose(&mut harness, "Time", "log(:,1)");
    choose(&mut harness, "Unit of the time", "s");
    click(&mut harness, "Open it");
    assert_eq!(
        (&state(&harness)["file"], form(&harness)),
        (&json!("log.mat"), Value::Null)
    );
}

#[test]
fn what_is_broken_is_refused_without_a_form() {
    let mut harness = app("compare", WIDE);
    let broken = drive().replacen("\n0.002000,", "\nno number,", 1);
    for (name, bytes, said) in [
        ("broken.csv", broken.into_bytes(), "is not a number"),
        (
            "new.mat",
            b"MATLAB 7.3 MAT-file".to_vec(),
            "save it from MATLAB with -v7",
        ),
        ("short.csv", b"a,b,c\n1,2,3\n".to_vec(), "is not a header"),
    ] {
        open(&mut harness, name, &bytes);
        assert_eq!(form(&harness), Value::Null, "{name}");
        let message = state(&harness)["message"].clone();
        assert!(
            message.as_str().is_some_and(|m| m.contains(said)),
            "{message}"
        );
        harness.state_mut().speak(Language::German);
        finish(&mut harness);
        assert_eq!(language::missed(), Vec::<String>::new());
        harness.state_mut().speak(Language::English);
    }
}

#[test]
fn on_a_phone_and_in_german_and_for_who_cannot_see() {
    let mut harness = app("compare", PHONE);
    open(&mut harness, "log.csv", german_log().as_bytes());
    choose(&mut harness, "Unit of the input", "A");
    choose(&mut harness, "Unit of the position", "counts");
    let nameless = harness.unnamed_widgets();
    assert!(nameless.is_empty(), "{nameless:#?}");
    picture(&mut harness, "phone_mapping");
    // Nothing is wider than the window.
    let nodes = harness.root().children_recursive();
    let places = nodes.filter_map(|n| n.accesskit_node().bounding_box());
    let widest = places.map(|place| place.x1).fold(0.0, f64::max);
    assert!(widest <= f64::from(PHONE[0]), "{widest}");
    harness.state_mut().speak(Language::German);
    finish(&mut harness);
    let missed = language::missed();
    assert!(missed.is_empty(), "{missed:#?}");
    for text in [
        "Welche Spalte ist was?",
        "Einheit des Eingangs",
        "Momentkonstante, falls bekannt",
    ] {
        harness.get_by_label(text);
    }
}
