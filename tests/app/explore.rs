//! Explore beyond the relay of the textbook: relays as they are built, and a drive with a controller.

use crate::support::ui::{
    App, WIDE, answer, app, click, finish, marks_what_is_of_before, picture, show, state, texts,
};
use egui_kittest::kittest::Queryable as _;
use hysteron_core::on_off;
use hysteron_core::scenario::AnyScenario;

fn explored(harness: &App) -> serde_json::Value {
    state(harness)["explore"].clone()
}

/// Chooses a kind of controller as a user does.
fn choose(harness: &mut App, from: &str, to: &str) {
    harness.get_by_label("controller").click();
    finish(harness);
    harness
        .query_all_by_label(to)
        .last()
        .unwrap_or_else(|| panic!("no {to} in the menu of {from}"))
        .click();
    finish(harness);
}

/// Opens a scenario that comes with the project, as someone does who drops it.
fn open_scenario(harness: &mut App, name: &str) -> String {
    let path = format!(
        "{}/../assets/scenarios/{name}.toml",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).expect("a scenario");
    let ctx = harness.ctx.clone();
    let file = format!("{name}.toml");
    harness.state_mut().open(&ctx, &file, text.as_bytes());
    finish(harness);
    text
}

fn number(value: &serde_json::Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn heat_off_cool_is_chosen_in_a_menu_and_shows_its_exact_cycle() {
    let mut harness = app("explore", WIDE);
    choose(&mut harness, "Relay: up or down", "Relay: heat, off, cool");
    let state = explored(&harness);
    assert_eq!(state["controller"], "three_positions");
    // 1/(s+1)^3 with k = 1, eps = 0.1, d = 0.1: as `hysteron limit-cycle` says.
    assert!(
        (number(&state["exact"]["period"]) - 4.901_668_676).abs() < 1e-8,
        "{state}"
    );
    assert!((number(&state["exact"]["amplitude"]) - 0.273_414_977).abs() < 1e-8);
    assert!((number(&state["describing_function"]["period"]) - 4.898_102_098).abs() < 1e-8);
    assert!(texts(&harness).contains(&"dead zone d".to_owned()));
    harness.get_by_label_contains("Exact cycle: ");
    picture(&mut harness, "explore_heat_off_cool");
    show(
        &mut harness,
        "v1;explore;explore.controller=three_positions;explore.on_off.dead_zone=0.8",
    );
    assert_eq!(explored(&harness)["rests"], true);
    harness.get_by_label_contains("the output rests in the dead zone");
    // What to try next is one press away.
    click(&mut harness, "Try it");
    assert_eq!(explored(&harness)["rests"], false, "{}", explored(&harness));
}

#[test]
fn minimum_times_and_sampling_are_one_press_away_and_make_the_period_theirs() {
    let mut harness = app("explore", WIDE);
    click(&mut harness, "minimum times on and off");
    let state = explored(&harness);
    assert!(
        (number(&state["exact"]["period"]) - 6.0).abs() < 1e-9,
        "{state}"
    );
    assert_eq!(state["describing_function"], serde_json::Value::Null);
    harness
        .get_by_label("The describing function sees no oscillation that keeps the minimum times.");
    click(&mut harness, "minimum times on and off");
    assert!((number(&explored(&harness)["exact"]["period"]) - 4.788).abs() < 1e-3);
    click(&mut harness, "sampled");
    let period = number(&explored(&harness)["exact"]["period"]);
    assert!(
        (period - 5.0).abs() < 1e-9,
        "a whole number of samples: {period}"
    );
    assert!(texts(&harness).contains(&"sampling time [s]".to_owned()));
}

#[test]
fn every_scenario_of_a_controller_opens_with_what_it_sets() {
    for (name, controller) in [
        ("heat-off-cool", "three_positions"),
        ("one-sided-heater", "one_sided"),
        ("sampled-relay", "two_levels"),
        ("discrete-plant", "two_levels"),
        ("fig-5-more-hysteresis", "two_levels"),
    ] {
        let mut harness = app("explore", WIDE);
        let text = open_scenario(&mut harness, name);
        let state = explored(&harness);
        assert_eq!(state["controller"], controller, "{name}: {state}");
        assert_eq!(state["message"], serde_json::Value::Null, "{name}");
        if let AnyScenario::OnOff(scenario) = AnyScenario::from_toml(&text).expect("a scenario") {
            let exact = on_off::settled(&scenario.on_off).expect("a loop").exact;
            let period = exact.expect("a cycle").period;
            let shown = number(&state["exact"]["period"]);
            assert!(
                (shown / period - 1.0).abs() < 1e-9,
                "{name}: {shown} for {period}"
            );
        }
        // What a link keeps is the same again.
        let link = crate::support::ui::state(&harness)["link"]
            .as_str()
            .expect("a link")
            .to_owned();
        let mut there = app("start", WIDE);
        show(&mut there, &link);
        assert_eq!(explored(&there)["exact"], state["exact"], "{name}: {link}");
        if name == "one-sided-heater" {
            picture(&mut harness, "explore_one_sided_heater");
        }
    }
}

#[test]
fn a_servo_hunts_and_no_longer_without_its_integral() {
    let mut harness = app("explore", WIDE);
    choose(&mut harness, "Relay: up or down", "Motor under PID");
    let hunts = explored(&harness);
    assert_eq!(hunts["verdict"], "hunts");
    assert!(
        (number(&hunts["exact"]["period"]) - 0.601_547_584).abs() < 1e-8,
        "{hunts}"
    );
    harness.get_by_label("It hunts: 1.66\u{a0}Hz, ±3.96°.");
    harness.get_by_label_contains("The motor sticks for 67\u{a0}% of the time.");
    picture(&mut harness, "explore_servo");
    click(&mut harness, "Try it");
    let stops = explored(&harness);
    assert_eq!(stops["verdict"], "stops_short");
    assert_eq!(stops["servo"]["integral"], 0.0);
    harness.get_by_label_contains("It settles, 0.897° from where it should be.");
}

#[test]
fn a_servo_that_hunts_in_its_play_opens_from_a_scenario() {
    let mut harness = app("explore", WIDE);
    open_scenario(&mut harness, "hunting-play");
    let state = explored(&harness);
    assert_eq!(state["controller"], "servo", "{state}");
    assert!(
        (number(&state["exact"]["period"]) - 0.386_127_581).abs() < 1e-8,
        "{state}"
    );
    assert!((number(&state["describing_function"]["period"]) - 0.384_145_810).abs() < 1e-8);
    picture(&mut harness, "explore_servo_play");
}

#[test]
fn a_drive_with_a_gap_opens_on_its_own_page() {
    for name in ["drive-drifting", "drive-late-compliant"] {
        let mut harness = app("explore", WIDE);
        let before = explored(&harness)["loop"].clone();
        let text = open_scenario(&mut harness, name);
        assert_eq!(state(&harness)["page"], "backlash", "{name}");
        let Ok(AnyScenario::Drive(drive)) = AnyScenario::from_toml(&text) else {
            panic!("{name} is a drive");
        };
        let shown = &state(&harness)["backlash"];
        assert_eq!(shown["gap"], 2.0 * drive.drive.half_gap, "{name}");
        assert_eq!(shown["motor_coulomb"], drive.drive.motor.coulomb, "{name}");
        assert_eq!(explored(&harness)["loop"], before, "{name}");
    }
}

#[test]
fn what_is_no_scenario_is_said_and_loses_nothing() {
    let mut harness = app("explore", WIDE);
    let ctx = harness.ctx.clone();
    let before = explored(&harness)["loop"].clone();
    for (text, said) in [
        ("nonsense", "line 1"),
        ("[plant]\nformula = \"1/(s+1)\"\n", "relay"),
        ("[drive]\n", "line 1"),
    ] {
        harness.state_mut().open(&ctx, "mine.toml", text.as_bytes());
        finish(&mut harness);
        let state = explored(&harness);
        let message = state["message"].as_str().expect("a sentence");
        assert!(message.contains(said), "{message}");
        assert_eq!(state["loop"], before);
    }
}

#[test]
fn a_measurement_that_is_dropped_on_explore_is_opened_where_it_belongs() {
    let mut harness = app("explore", WIDE);
    let ctx = harness.ctx.clone();
    harness
        .state_mut()
        .open(&ctx, "notes.csv", b"this is no measurement\n");
    finish(&mut harness);
    assert_eq!(state(&harness)["page"], "compare");
}

#[test]
fn what_a_controller_cannot_be_is_refused_in_a_link() {
    let mut app = hysteron::HysteronApp::default();
    let ctx = egui::Context::default();
    for link in [
        "v1;explore;explore.controller=none",
        "v1;explore;explore.on_off.min_on=-1",
        "v1;explore;explore.on_off.sampling=-1",
        "v1;explore;explore.controller=three_positions;explore.on_off.dead_zone=-0.1",
        "v1;explore;explore.servo.inertia=0",
        "v1;explore;explore.servo.limit=-1",
    ] {
        assert!(app.open_link(&ctx, link).is_err(), "{link}");
    }
}

#[test]
fn equation_3_in_z_and_play_stand_beside_the_exact_cycle() {
    let mut harness = app("start", WIDE);
    show(&mut harness, "v1;explore;explore.play=0.05");
    for name in ["Equation (3) in z", "Play before the relay"] {
        harness.get_by_label(name).scroll_to_me();
        finish(&mut harness);
        click(&mut harness, name);
    }
    let said = texts(&harness);
    let z = said
        .iter()
        .find(|t| t.starts_with("By (3) h = "))
        .expect("a sentence");
    let [value, level] = ["-Hₕ(-1) = ", "ε/k = "].map(|key| {
        let rest = z.split(key).nth(1).expect("a value");
        rest[..8].parse::<f64>().expect("a number")
    });
    assert!((value - level).abs() < 1e-6, "{z}");
    harness
        .get_by_label_contains("With play the relay acts")
        .scroll_to_me();
    finish(&mut harness);
    picture(&mut harness, "explore_theory");
}

#[test]
fn what_a_page_does_not_show_of_a_scenario_is_said() {
    for (name, keys) in [
        ("fig-4-noise", "duration, step"),
        ("one-sided-heater", "duration"),
        ("hunting-stiction", "duration"),
    ] {
        let mut harness = app("explore", WIDE);
        open_scenario(&mut harness, name);
        let state = explored(&harness);
        let said = state["left_out"]
            .as_str()
            .unwrap_or_else(|| panic!("{name}: {state}"));
        assert!(
            said.contains(&format!("in the file: {keys}.")),
            "{name}: {said}"
        );
        harness.get_by_label_contains("hysteron simulate");
    }
}

#[test]
fn a_loop_with_noise_is_computed_beside_the_frames() {
    let mut harness = app("explore", WIDE);
    let noise = "loop.noise=%7B%22std_dev%22:0.05,%22interval%22:0.02,%22seed%22:4%7D";
    marks_what_is_of_before(&mut harness, &format!("v1;explore;{noise}"));
    assert!(answer(&harness).starts_with("It oscillates in the noise"));
    // Without noise it is there at once.
    let ctx = harness.ctx.clone();
    assert_eq!(harness.state_mut().open_link(&ctx, "v1;explore"), Ok(()));
    harness.step();
    assert!(answer(&harness).starts_with("It oscillates: period"));
}
