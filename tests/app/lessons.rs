//! Every lesson, as someone takes it: open it, press its buttons, miss its question, then answer it.

use crate::support::ui::{App, WIDE, app, finish, picture, show, state};
use egui_kittest::kittest::Queryable as _;
use hysteron::lessons;

/// Opens a lesson from the list.
fn open(id: &str) -> App {
    let mut harness = app("lessons", WIDE);
    let (index, lesson) = lessons::all()
        .enumerate()
        .find(|(_, l)| l.id == id)
        .expect("a lesson");
    harness
        .get_by_label(&format!("{}  {}", index + 1, lesson.title))
        .click();
    finish(&mut harness);
    assert_eq!(state(&harness)["studied"], id);
    harness
}

/// Opens what a live button of the lesson shows.
fn follow(harness: &mut App, label: &str) {
    harness.get_by_label(label).click_accesskit();
    finish(harness);
    assert_eq!(state(harness)["notice"], serde_json::Value::Null, "{label}");
}

/// Types an answer and has it checked.
fn answer(harness: &mut App, text: &str) {
    harness.get_by_label("Your answer").focus();
    harness.step();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.step();
    harness.get_by_label("Your answer").type_text(text);
    harness.step();
    check(harness);
}

fn check(harness: &mut App) {
    harness.get_by_label("Check").click_accesskit();
    finish(harness);
}

fn solved(harness: &App, id: &str) -> bool {
    let state = state(harness);
    let all = state["solved"].as_array().expect("a list");
    all.iter().any(|s| s == id)
}

/// A number that the app shows, by its path.
fn shown(harness: &App, path: &str) -> f64 {
    let state = state(harness);
    let value = path.split('.').fold(&state, |at, key| &at[key]);
    value.as_f64().unwrap_or_else(|| panic!("{path}: {value}"))
}

#[test]
fn there_are_eight_lessons_of_five_to_ten_minutes_whose_buttons_work() {
    assert!(lessons::all().count() >= 8);
    for lesson in lessons::all() {
        assert_eq!(lesson.faults(), Vec::<String>::new(), "{}", lesson.id);
        assert!((5..=10).contains(&lesson.minutes), "{}", lesson.id);
        for link in lesson.links() {
            let mut app = hysteron::HysteronApp::default();
            let opened = app.open_link(&egui::Context::default(), link);
            assert_eq!(opened, Ok(()), "{}: {link}", lesson.id);
        }
    }
    let mut harness = app("lessons", WIDE);
    picture(&mut harness, "lessons");
}

#[test]
fn the_relay_and_its_hysteresis() {
    let mut harness = open("relay");
    assert_eq!(state(&harness)["page"], "explore");
    for (button, eps) in [
        ("An almost ideal relay", 0.05_f64),
        ("Hysteresis 0.2", 0.2),
        ("Hysteresis 0.5", 0.5),
    ] {
        follow(&mut harness, button);
        let formula = 2.0 * ((1.0 + eps) / (1.0 - eps)).ln();
        for way in ["exact.period", "simulated.period"] {
            let period = shown(&harness, way);
            assert!((period / formula - 1.0).abs() < 1e-9, "{button}: {period}");
        }
    }
    let still = format!(
        "{};explore.paused=3",
        state(&harness)["link"].as_str().expect("a link")
    );
    show(&mut harness, &still);
    picture(&mut harness, "lesson_relay");
    answer(&mut harness, "0.5");
    assert!(!solved(&harness, "relay"));
    harness.get_by_label("Not yet.");
    answer(&mut harness, &1.0_f64.tanh().to_string());
    assert!(solved(&harness, "relay"));
    harness
        .get_by_label("Next lesson: Why does it oscillate?")
        .click_accesskit();
    finish(&mut harness);
    assert_eq!(state(&harness)["studied"], "oscillation");
    harness.get_by_label("Close lesson").click_accesskit();
    finish(&mut harness);
    assert_eq!(state(&harness)["studied"], serde_json::Value::Null);
}

#[test]
fn why_does_it_oscillate() {
    let mut harness = open("oscillation");
    follow(&mut harness, "Twice the gain");
    // The describing function is linear in the gain: 4 k/(8 pi) for k = 2 is on the screen.
    let amplitude = shown(&harness, "describing_function.amplitude");
    assert!((amplitude - 1.0 / std::f64::consts::PI).abs() < 1e-6);
    answer(&mut harness, "0.318");
    assert!(!solved(&harness, "oscillation"));
    answer(&mut harness, &(1.5 * amplitude).to_string());
    assert!(solved(&harness, "oscillation"));
}

#[test]
fn how_wrong_is_the_describing_function() {
    let mut harness = open("exact");
    follow(&mut harness, "One lag with dead time filters badly");
    let off = |h: &App| 1.0 - shown(h, "describing_function.period") / shown(h, "exact.period");
    assert!((off(&harness) + 0.039).abs() < 1e-3, "{}", off(&harness));
    follow(&mut harness, "A plant where it fails");
    answer(&mut harness, "27.7");
    assert!(!solved(&harness, "exact"));
    let percent = format!("{:.1}", 100.0 * off(&harness));
    answer(&mut harness, &percent);
    assert!(solved(&harness, "exact"), "{percent}");
}

#[test]
fn more_hysteresis_less_ultimate_gain() {
    let mut harness = open("ultimate");
    let said = |h: &App| {
        let text = state(h)["answer"].as_str().expect("an answer").to_owned();
        let number = text
            .split("Ku = ")
            .nth(1)
            .and_then(|t| t.split([' ', ',']).next());
        number.and_then(|n| n.parse::<f64>().ok()).expect("Ku")
    };
    assert!((said(&harness) - 7.81).abs() < 0.01, "{}", said(&harness));
    follow(&mut harness, "Hysteresis 0.1");
    // The paper's (9), 4k/(pi a) with a = 0.285687.
    assert!((said(&harness) - 4.457).abs() < 0.001);
    answer(&mut harness, "4.457");
    assert!(!solved(&harness, "ultimate"));
    let link = "v1;tune;loop.relay.hysteresis=0.3;tune.step=ultimate;lesson=ultimate";
    show(&mut harness, link);
    let gain = said(&harness).to_string();
    answer(&mut harness, &gain);
    assert!(solved(&harness, "ultimate"), "{gain}");
}

#[test]
fn a_pid_controller_from_one_experiment() {
    let mut harness = open("tuning");
    for (label, step) in [
        ("The ultimate gain", "ultimate"),
        ("An asymmetric test tells more", "model"),
        ("Before and after", "loops"),
        ("The rule", "rules"),
    ] {
        follow(&mut harness, label);
        assert_eq!(state(&harness)["step"], step);
    }
    answer(&mut harness, "4.788 s");
    assert!(!solved(&harness, "tuning"));
    harness.get_by_label("Ziegler-Nichols PI").click();
    finish(&mut harness);
    let said = state(&harness)["answer"]
        .as_str()
        .expect("an answer")
        .to_owned();
    let time = said
        .split("Ti = ")
        .nth(1)
        .and_then(|t| t.split([' ', ',']).next());
    answer(&mut harness, time.expect("Ti"));
    assert!(solved(&harness, "tuning"), "{said}");
}

#[test]
fn inside_the_gap() {
    let mut harness = open("gap");
    let estimated = |h: &App| 1e3 * shown(h, "gap_estimated");
    assert!((estimated(&harness) / 19.0 - 1.0).abs() < 0.05);
    follow(&mut harness, "A gap of half the width");
    assert!((estimated(&harness) / 9.5 - 1.0).abs() < 0.05);
    follow(&mut harness, "Open the measurement");
    assert_eq!(state(&harness)["file"], "drive-10");
    answer(&mut harness, "19");
    assert!(!solved(&harness, "gap"));
    let gap = format!("{:.2}", estimated(&harness));
    answer(&mut harness, &gap);
    assert!(solved(&harness, "gap"), "{gap}");
}

#[test]
fn why_does_a_servo_hunt() {
    let mut harness = open("hunting");
    let verdict = |h: &App| state(h)["explore"]["verdict"].clone();
    assert_eq!(verdict(&harness), "hunts");
    for (button, expected) in [
        ("Without the integral", "stops_short"),
        ("The same friction at rest", "settles"),
        ("A servo with play", "hunts"),
    ] {
        follow(&mut harness, button);
        assert_eq!(verdict(&harness), expected, "{button}");
        check(&mut harness);
        assert!(!solved(&harness, "hunting"), "{button}");
    }
    // What the text says of the describing function.
    let off = |of: &str| {
        let found = shown(&harness, &format!("explore.describing_function.{of}"));
        found / shown(&harness, &format!("explore.exact.{of}")) - 1.0
    };
    assert!(
        (off("amplitude") - 0.15).abs() < 0.005,
        "{}",
        off("amplitude")
    );
    assert!(off("period").abs() < 0.01, "{}", off("period"));
    follow(&mut harness, "Back to the servo that hunts");
    assert_eq!(
        state(&harness)["explore"]["describing_function"],
        serde_json::Value::Null
    );
    check(&mut harness);
    assert!(!solved(&harness, "hunting"));
    show(
        &mut harness,
        "v1;explore;explore.controller=servo;explore.servo.proportional=6;lesson=hunting",
    );
    check(&mut harness);
    assert!(solved(&harness, "hunting"), "{}", state(&harness));
}

#[test]
fn why_does_it_drift() {
    let mut harness = open("drift");
    assert_eq!(state(&harness)["direction"], "against");
    follow(&mut harness, "Without friction");
    assert_eq!(state(&harness)["direction"], "nowhere");
    follow(&mut harness, "With delay");
    assert_eq!(state(&harness)["direction"], "with");
    check(&mut harness);
    assert!(!solved(&harness, "drift"), "this drive has no friction");
    follow(&mut harness, "The drive with friction");
    check(&mut harness);
    assert!(!solved(&harness, "drift"), "this one drifts against");
    // The slider for the delay goes to 2 ms: what it reaches there must solve the question.
    let link = "v1;backlash;backlash.run.drive.motor.coulomb=0.03;backlash.run.drive.motor.viscous=0;\
                backlash.run.command.relay.relay.delay=0.0015;lesson=drift";
    show(&mut harness, link);
    assert_eq!(state(&harness)["direction"], "with");
    check(&mut harness);
    assert!(solved(&harness, "drift"));
}

#[test]
fn find_the_formula() {
    let mut harness = open("unknown");
    assert_eq!(state(&harness)["file"], "drive-15");
    assert!(shown(&harness, "error") > 100.0);
    answer(&mut harness, "0.5");
    assert!(!solved(&harness, "unknown"));
    let place = shown(&harness, "formula.values.c").to_string();
    answer(&mut harness, &place);
    assert!(solved(&harness, "unknown"), "{place}");
    follow(&mut harness, "Add formula_1");
    assert!(shown(&harness, "error") < 1.15);
}

#[test]
fn which_effect_is_missing() {
    let mut harness = open("mystery");
    assert_eq!(state(&harness)["file"], "drive-02");
    follow(&mut harness, "Add it");
    assert!(shown(&harness, "error") < 1.15);
    check(&mut harness);
    assert!(!solved(&harness, "mystery"), "this is not the mystery");
    follow(&mut harness, "Open the mystery");
    let before = shown(&harness, "error");
    let mut added = 0;
    while shown(&harness, "error") > 1.15 {
        check(&mut harness);
        assert!(!solved(&harness, "mystery"));
        assert!(added < 4, "the hint leads nowhere");
        // The best effect stands first.
        let best = state(&harness)["candidates"][0]["effects"][0].clone();
        let best = best.as_str().expect("a candidate");
        let name = hysteron_core::effect::registry()
            .iter()
            .find(|e| e.id().as_str() == best)
            .map(|e| e.name())
            .expect("an effect of the library");
        harness
            .get_by_label(&format!("Add {name}"))
            .click_accesskit();
        finish(&mut harness);
        added += 1;
    }
    assert!(added >= 2, "one effect is not enough, {before}");
    check(&mut harness);
    assert!(solved(&harness, "mystery"));
    picture(&mut harness, "lesson_mystery");
}
