//! The pages, as a user sees and works them: pictures of fixed size, and the way from a file to the answer.

use crate::support::pulses::reversed_twice;
use crate::support::ui::{App, WIDE, finish, picture, show, state, type_over, wait};
use egui_kittest::kittest::Queryable as _;
use hysteron::HysteronApp;
use hysteron_core::rig;

/// The app in the window of the pictures, on this page.
fn app(page: &str) -> App {
    crate::support::ui::app(page, WIDE)
}

fn error(harness: &App) -> f64 {
    state(harness)["error"]
        .as_f64()
        .expect("an error on screen")
}

#[test]
fn the_welcome_of_compare_offers_its_measurements() {
    let mut harness = app("compare");
    for id in ["drive-02", "drive-12", "drive-15", "process-02"] {
        harness.get_by_label(&format!("Open {id}"));
    }
    picture(&mut harness, "compare_welcome");
}

#[test]
fn a_diagnosis_that_is_cancelled_leaves_what_was_there() {
    let mut harness = app("compare");
    harness.get_by_label("Open drive-02").click();
    harness.step();
    finish(&mut harness);
    let before = error(&harness);
    harness.get_by_label("Add Coulomb friction").click();
    harness.step();
    assert_eq!(state(&harness)["busy"], true);
    harness.step();
    harness.get_by_label("Cancel").click();
    harness.step();
    harness.step();
    let state = state(&harness);
    assert_eq!((&state["busy"], error(&harness)), (&false.into(), before));
    harness.get_by_label("Add Coulomb friction");
}

#[test]
fn adding_coulomb_friction_to_drive_02_lowers_the_error_to_the_noise() {
    let mut harness = app("compare");
    harness.get_by_label("Open drive-02").click();
    harness.step();
    assert_eq!(
        state(&harness)["busy"],
        true,
        "the job runs beside the window"
    );
    finish(&mut harness);
    let before = error(&harness);
    harness.get_by_label("Add Coulomb friction").click();
    harness.step();
    assert_eq!(
        error(&harness),
        before,
        "the last result stays while the next is computed"
    );
    finish(&mut harness);
    let after = error(&harness);
    assert!(
        before > 2.0,
        "the baseline should miss by far more than the noise, was {before}"
    );
    assert!(
        after < 1.2,
        "the noise floor should be reached, was {after} after {before}"
    );
    picture(&mut harness, "compare_drive_02");

    harness.get_by_label("Take back Coulomb friction").click();
    harness.step();
    harness.step();
    assert_eq!(
        error(&harness),
        before,
        "undo shows the stored step at once"
    );
    assert_eq!(state(&harness)["busy"], false);
}

#[test]
fn a_bad_file_gives_one_sentence_and_loses_nothing() {
    let mut harness = app("compare");
    harness.get_by_label("Open drive-02").click();
    finish(&mut harness);
    let ctx = harness.ctx.clone();
    harness
        .state_mut()
        .open(&ctx, "notes.csv", b"this is no measurement\n");
    finish(&mut harness);
    let state = state(&harness);
    assert_eq!(state["file"], "drive-02", "the open measurement stays");
    let message = state["message"].as_str().expect("a sentence");
    assert_eq!(message.lines().count(), 1, "{message}");
}

#[test]
fn a_model_from_a_file_is_where_compare_begins() {
    let mut harness = app("compare");
    harness.get_by_label("Open drive-02").click();
    finish(&mut harness);
    let ctx = harness.ctx.clone();
    let mut open = |text: &str| {
        harness.state_mut().open(&ctx, "rig.toml", text.as_bytes());
        finish(&mut harness);
        state(&harness)["compare"].clone()
    };
    let bad = open("kind = \"drive\"\n[parameters]\nJ9 = 1\n");
    let message = bad["message"].as_str().expect("a sentence");
    assert!(message.contains("rig.toml, line 3"), "{message}");
    assert_eq!(bad["model"], serde_json::Value::Null);
    let good = open("kind = \"drive\"\n[[effects]]\nid = \"coulomb_friction\"\n");
    assert_eq!(good["model"], "rig.toml");
    assert!(good["error"].as_f64().expect("an error") < 1.2, "{good}");
    let verdict = good["verdict"].as_str().expect("a verdict");
    assert!(verdict.contains("Nothing is missing"), "{verdict}");
    harness.get_by_label("Begins with rig.toml");
    harness.get_by_label("Discard it").click();
    harness.step();
    finish(&mut harness);
    assert!(error(&harness) > 2.0, "the baseline again");
}

#[test]
fn an_effect_of_ones_own_is_typed_and_added() {
    let mut harness = app("compare");
    harness.get_by_label("Open process-02").click();
    harness.step();
    finish(&mut harness);
    // It stands below the fold.
    harness
        .get_by_label("An effect of your own")
        .click_accesskit();
    harness.run();
    harness.get_by_label_contains("To be fitted: ");
    type_over(&mut harness, "Input =", "a*t");
    harness.get_by_label("To be fitted: a");
    harness.get_by_label("Add your effect").click_accesskit();
    harness.step();
    finish(&mut harness);
    let state = state(&harness)["compare"].clone();
    assert_eq!(state["effects"], serde_json::json!(["bump"]), "{state}");
    assert_eq!(state["message"], serde_json::Value::Null);
}

#[test]
fn an_effect_of_ones_own_can_be_undone_and_done_again() {
    let mut harness = app("compare");
    harness.get_by_label("Open process-02").click();
    harness.step();
    finish(&mut harness);
    harness.get_by_label("Add Input delay").click();
    harness.step();
    finish(&mut harness);
    harness
        .get_by_label("An effect of your own")
        .click_accesskit();
    harness.run();
    type_over(&mut harness, "Input =", "a*t");
    harness.get_by_label("Add your effect").click_accesskit();
    harness.step();
    finish(&mut harness);
    harness.get_by_label_contains("with or without bump");
    for (button, effects) in [
        ("Undo", vec!["input_delay"]),
        ("Redo", vec!["input_delay", "bump"]),
    ] {
        harness.get_by_label(button).click();
        harness.step();
        finish(&mut harness);
        let state = state(&harness)["compare"].clone();
        assert_eq!(state["message"], serde_json::Value::Null, "{button}");
        assert_eq!(state["effects"], serde_json::json!(effects), "{button}");
        assert_eq!(state["undone"], serde_json::json!([]), "{button}");
    }
}

/// Waits until a formula is looked for, which begins by itself, and stops that: then only who asks for one gets it.
fn stop_looking(harness: &mut App) {
    wait(harness, "search", |s| s["looks"] == true);
    assert_eq!(
        state(harness)["hint"],
        "Nothing in the library fits: searching for a formula."
    );
    harness.step();
    harness.get_by_label("Cancel").click();
    finish(harness);
    assert_eq!(state(harness)["looks"], false);
    assert_eq!(state(harness)["formula"], serde_json::Value::Null);
}

#[test]
fn where_no_effect_explains_the_rest_the_missing_force_is_drawn() {
    let rig = rig::DriveRig {
        excitation: rig::Excitation::Multisine { amplitude: 0.08 },
        samples: 3000,
        sampling: 1e-3,
        stranger: Some(rig::Stranger::SpeedBump {
            torque: 0.05,
            centre: 3.0,
            width: 0.5,
        }),
        ..rig::DriveRig::default()
    };
    let mut harness = app("compare");
    let ctx = harness.ctx.clone();
    let csv = rig.measure().to_csv();
    harness.state_mut().open(&ctx, "rig.csv", csv.as_bytes());
    stop_looking(&mut harness);
    harness.get_by_label("What is missing, estimated without a model");
    harness.get_by_label_contains("A force that depends on the velocity alone");
    picture(&mut harness, "compare_missing_force");
    let hint = |harness: &App| state(harness)["hint"].clone();
    assert_eq!(
        hint(&harness),
        "No effect explains the rest: see where it lies."
    );
    harness.get_by_label("Try it").click();
    finish(&mut harness);
    assert_eq!(
        hint(&harness),
        "No effect explains the rest: write one of your own."
    );
    assert!(harness.query_by_label("Try it").is_none());
    harness.get_by_label("Over time").click();
    finish(&mut harness);
    harness.get_by_label("Look for a formula").click();
    finish(&mut harness);
    // A drag to both sides at one speed is none of the forms that are tried.
    harness.get_by_label_contains("No formula of up to three terms explains more than it leaves");
    assert_eq!(state(&harness)["formula"], serde_json::Value::Null);
    picture(&mut harness, "compare_formula_none");
}

/// Where a process does something else in two short moments only, that may be chance: what explains it is offered as
/// that, and the way goes on from there.
#[test]
fn what_may_help_is_offered_though_chance_is_not_ruled_out() {
    let mut harness = app("compare");
    let ctx = harness.ctx.clone();
    harness
        .state_mut()
        .open(&ctx, "pulses.csv", reversed_twice(4).as_bytes());
    stop_looking(&mut harness);
    harness.get_by_label("Perhaps, but it may be chance");
    let state = state(&harness);
    let hint = state["hint"].as_str().expect("a hint");
    assert!(hint.starts_with("Perhaps "), "{hint}");
    harness.get_by_label("Try it").click();
    finish(&mut harness);
    let after = crate::support::ui::state(&harness)["compare"].clone();
    assert!(
        !after["effects"].as_array().expect("effects").is_empty(),
        "{after}"
    );
}

#[test]
fn explore_opens_on_an_oscillating_loop() {
    let mut harness = app("explore");
    harness.step();
    harness.get_by_label_contains("It oscillates: period 4.788\u{a0}s");
    harness.get_by_label("phase-margin point S").click();
    harness.step();
    harness.step();
    picture(&mut harness, "explore");
}

/// What Explore computed for its loop.
fn explored(harness: &App) -> serde_json::Value {
    state(harness)["explore"].clone()
}

#[test]
fn figs_3_4_and_5_check_their_claims_on_screen() {
    let mut harness = app("explore");
    // At rest: how many frames the noise of Fig. 4 takes is not known.
    show(&mut harness, "v1;explore;explore.paused=20");
    for number in 3..=5 {
        harness.get_by_label(&format!("Fig. {number}")).click();
        harness.step();
        finish(&mut harness);
        let state = explored(&harness);
        let checks = state["checks"].as_array().expect("checks");
        assert!(
            checks.len() >= 3 && checks.iter().all(|c| c == true),
            "{state}"
        );
        picture(&mut harness, &format!("explore_fig_{number}"));
    }
}

#[test]
fn a_typed_plant_is_taken_and_a_wrong_one_loses_nothing() {
    let mut harness = app("explore");
    type_over(&mut harness, "P(s) =", "2 e^{-0.5s}/(3s+1)");
    let good = explored(&harness);
    assert_eq!(good["plant_error"], serde_json::Value::Null, "{good}");
    assert_eq!(good["loop"]["plant"]["dead_time"], 0.5);
    assert_eq!(
        good["loop"]["plant"]["denominator"],
        serde_json::json!([3.0, 1.0])
    );
    // Closed form for K e^{-Ls}/(Ts+1): a = k K (1 - e^{-L/T}) + eps e^{-L/T}.
    let decay = (-0.5_f64 / 3.0).exp();
    let amplitude = good["exact"]["amplitude"].as_f64().expect("a cycle");
    assert!((amplitude / (2.0 * (1.0 - decay) + 0.1 * decay) - 1.0).abs() < 1e-9);
    type_over(&mut harness, "P(s) =", "2/(3s+");
    let bad = explored(&harness);
    assert!(
        bad["plant_error"].as_str().is_some_and(|e| !e.is_empty()),
        "{bad}"
    );
    assert_eq!(bad["loop"], good["loop"], "the last valid plant stays");
    picture(&mut harness, "explore_wrong_plant");
    harness.get_by_label("Back to this plant").click();
    harness.step();
    harness.step();
    assert_eq!(explored(&harness)["plant_error"], serde_json::Value::Null);
}

#[test]
fn dragging_the_line_of_the_nyquist_plot_sets_the_hysteresis() {
    let mut harness = app("explore");
    harness.step();
    let before = explored(&harness);
    let at = state(&harness)["targets"]["nyquist:line"].clone();
    let coordinate = |i: usize| at[i].as_f64().expect("the line can be seen") as f32;
    let from = egui::pos2(coordinate(0), coordinate(1));
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for dy in [8.0, 20.0, 30.0] {
        harness.hover_at(from + egui::vec2(0.0, dy));
        harness.step();
    }
    harness.drop_at(from + egui::vec2(0.0, 30.0));
    harness.step();
    harness.step();
    let after = explored(&harness);
    let hysteresis =
        |v: &serde_json::Value| v["loop"]["relay"]["hysteresis"].as_f64().expect("a number");
    assert!(hysteresis(&after) > hysteresis(&before) + 0.03, "{after}");
    let period = |v: &serde_json::Value| v["exact"]["period"].as_f64().expect("a cycle");
    assert!(period(&after) > period(&before), "the answer follows");
}

#[test]
fn every_page_draws_itself_and_says_what_it_shows() {
    for id in HysteronApp::default().page_ids() {
        let mut harness = app(id);
        harness.step();
        let state = state(&harness);
        assert_eq!(state["page"], id);
        assert!(state[id]["busy"].is_boolean(), "{id}: {state}");
    }
}

#[test]
fn the_parameter_map_fills_and_a_click_sets_the_loop() {
    let mut harness = app("maps");
    finish(&mut harness);
    let filled = state(&harness);
    assert_eq!(filled["share"], 1.0);
    assert_eq!(filled["message"], serde_json::Value::Null);
    picture(&mut harness, "maps");
    harness.get_by_label("Show this loop in Explore").click();
    harness.step();
    harness.step();
    assert_eq!(state(&harness)["page"], "explore");
    harness.get_by_label_contains("It oscillates: period 4.788\u{a0}s");
}
