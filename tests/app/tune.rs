//! The tuning page, as a user works it: from the relay to the tuned loop.

use crate::support::ui::{
    App, NARROW, WIDE, answer, app, choose, click, finish, marks_what_is_of_before, picture, show,
    state, texts, type_over,
};
use egui_kittest::kittest::Queryable as _;
use hysteron::language::Language;

fn page(size: [f32; 2]) -> App {
    let mut harness = app("tune", size);
    finish(&mut harness);
    harness
}

/// The paper's third-order lag under the relay k = 1, eps = 0.1: period 4.788 s and amplitude 0.2857
/// exactly, hence `Ku = 4/(pi sqrt(a^2 - eps^2)) = 4.758`; true are 8 and `2 pi/sqrt(3) = 3.628` s.
#[test]
fn the_experiment_leads_step_by_step_from_the_relay_to_the_tuned_loop() {
    let mut harness = page(WIDE);
    assert_eq!(
        answer(&harness),
        "It oscillates: period 4.788 s, amplitude 0.2857."
    );
    picture(&mut harness, "tune_relay");

    click(&mut harness, "Next step");
    let said = answer(&harness);
    for number in ["Ku = 4.457", "4.788 s", "8.000", "3.628 s"] {
        assert!(said.contains(number), "{number}: {said}");
    }
    picture(&mut harness, "tune_ultimate");

    for step in ["adaptation", "model", "rules", "loops"] {
        click(&mut harness, "Next step");
        assert_eq!(state(&harness)["step"], step);
        assert!(state(&harness)["message"].is_null());
    }
    assert!(
        answer(&harness).contains("after a load step the error now adds up to"),
        "{}",
        answer(&harness)
    );
    assert!(
        harness.query_by_label("Next step").is_none(),
        "there is no step after the last"
    );
    picture(&mut harness, "tune_loops");
}

#[test]
fn another_rule_changes_the_controller_and_the_loop() {
    let mut harness = page(WIDE);
    click(&mut harness, "5 Rule");
    assert!(answer(&harness).starts_with("AMIGO PID"));
    click(&mut harness, "Ziegler-Nichols PI");
    let said = answer(&harness);
    // 0.45 Ku and Tu/1.2 of the relay's 4.457 and 4.788 s.
    assert!(
        said.contains("K = 2.006") && said.contains("Ti = 3.990 s"),
        "{said}"
    );
    picture(&mut harness, "tune_rules");
    click(&mut harness, "6 Before and after");
    let worse = answer(&harness);
    click(&mut harness, "5 Rule");
    click(&mut harness, "Tyreus-Luyben PI");
    click(&mut harness, "6 Before and after");
    assert_ne!(answer(&harness), worse, "the loop follows the rule");
}

#[test]
fn a_narrow_window_shows_the_same_experiment() {
    let mut harness = page(NARROW);
    assert!(answer(&harness).starts_with("It oscillates"));
    click(&mut harness, "6 Before and after");
    picture(&mut harness, "tune_narrow");
}

#[test]
fn the_table_of_rules_has_room_in_a_smaller_window() {
    for language in [Language::English, Language::German] {
        let mut harness = app("tune", [1024.0, 800.0]);
        harness.state_mut().speak(language);
        show(&mut harness, "v1;tune;tune.step=rules");
        harness.run_steps(3);
        let last = ["load error [s]", "Lastfehler [s]"].map(|name| harness.query_by_label(name));
        let last = last.into_iter().flatten().next().expect("the last column");
        assert!(last.rect().right() <= 1024.0, "{:?}", last.rect());
    }
}

#[test]
fn a_measured_test_shows_its_point_models_and_gains() {
    let mut harness = app("tune", WIDE);
    show(
        &mut harness,
        "v1;tune;tune.measured.from=record;tune.measured.file=process-02",
    );
    finish(&mut harness);
    let said = state(&harness);
    assert!(said["message"].is_null(), "{said}");
    assert!(said["gains"].as_u64().is_some_and(|n| n >= 6), "{said}");
    // The rig's plant: gain 2, lag 30 s, dead time 6 s, hence Ku = 4.4 at 22 s.
    assert!(
        said["ultimate"]
            .as_f64()
            .is_some_and(|k| (k - 4.4).abs() < 0.3),
        "{said}"
    );
    picture(&mut harness, "tune_measured");
    click(&mut harness, "Ziegler-Nichols PI");
    picture(&mut harness, "tune_measured_chosen");
}

/// A relay of 0 and 100 about 50 on a lag of 20 s and gain 0.3 that comes 5 s late, under names that say nothing.
fn nameless() -> String {
    use std::fmt::Write as _;
    let mut text = String::from("alpha,beta,gamma\n");
    let (mut late, mut output, mut up) = ([1.0; 20], 50.0, true);
    for i in 0..1600_usize {
        up = if up { output < 50.2 } else { output < 49.8 };
        let u = if up { 100.0 } else { 0.0 };
        writeln!(text, "{},{u},{output:.4}", 0.25 * i as f64).expect("a string takes it");
        let end = 35.0 + 0.3 * late[i % 20];
        output = end + (output - end) * (-0.25_f64 / 20.0).exp();
        late[i % 20] = u;
    }
    text
}

#[test]
fn a_table_that_does_not_say_what_its_columns_are_is_asked_about() {
    let mut harness = app("tune", WIDE);
    let open = |harness: &mut App| {
        let (ctx, text) = (harness.ctx.clone(), nameless());
        harness
            .state_mut()
            .open(&ctx, "nameless.csv", text.as_bytes());
        finish(harness);
    };
    open(&mut harness);
    let said = state(&harness);
    assert_eq!(said["page"], "tune");
    assert_eq!(said["mapping"]["file"], "nameless.csv", "{said}");
    picture(&mut harness, "tune_mapping");
    click(&mut harness, "A process");
    for (channel, column) in [("Time", "alpha"), ("Input", "beta"), ("Output", "gamma")] {
        choose(&mut harness, channel, column);
    }
    choose(&mut harness, "Unit of the time", "s");
    click(&mut harness, "Open it");
    finish(&mut harness);
    let said = state(&harness);
    assert!(
        said["mapping"].is_null() && said["message"].is_null(),
        "{said}"
    );
    // Phase -180 degrees of the lag and dead time at 0.3431 rad/s.
    let ultimate = (20.0 * 0.343_101_f64).hypot(1.0) / 0.3;
    assert!(
        said["ultimate"]
            .as_f64()
            .is_some_and(|k| (k / ultimate - 1.0).abs() < 0.03),
        "{said}"
    );
    // Left where it was, it leaves nothing behind.
    open(&mut harness);
    assert!(state(&harness)["mapping"].is_object());
    click(&mut harness, "Cancel");
    finish(&mut harness);
    let said = state(&harness);
    assert!(
        said["mapping"].is_null() && said["file"].is_null(),
        "{said}"
    );
}

#[test]
fn only_numbers_give_a_point_and_what_would_help() {
    let mut harness = app("tune", WIDE);
    click(&mut harness, "Only numbers");
    finish(&mut harness);
    let said = state(&harness);
    assert!(said["ultimate"].is_null(), "{said}");
    assert!(
        answer(&harness).starts_with("No ultimate gain follows"),
        "{said}"
    );
    picture(&mut harness, "tune_numbers");
}

#[test]
fn times_up_and_down_that_differ_are_part_of_the_numbers() {
    let mut harness = app("tune", WIDE);
    click(&mut harness, "Only numbers");
    finish(&mut harness);
    let symmetric = answer(&harness);
    click(&mut harness, "it is up longer than down, or shorter");
    finish(&mut harness);
    assert_eq!(answer(&harness), symmetric);
    type_over(&mut harness, "time up [s]", "9");
    harness.key_press(egui::Key::Enter);
    harness.run_steps(2);
    finish(&mut harness);
    let said = texts(&harness).join("\n");
    assert!(said.contains("32.5 s") && said.contains("9 s"), "{said}");
    assert_ne!(answer(&harness), symmetric);
}

#[test]
fn an_answer_of_before_does_not_look_like_one_of_now() {
    let mut harness = page(WIDE);
    marks_what_is_of_before(&mut harness, "v1;tune;loop.relay.hysteresis=0.3");
}

#[test]
fn the_plain_law_8_is_stepped_by_hand_beside_steffensens() {
    let mut harness = app("start", WIDE);
    show(&mut harness, "v1;tune;tune.step=adaptation");
    let next = |harness: &App| texts(harness).iter().any(|t| t.starts_with("Next: K = "));
    assert!(next(&harness));
    let mut runs = 2;
    while next(&harness) {
        runs += 1;
        assert!(runs < 14, "it has an end");
        click(&mut harness, "Next run");
    }
    let said = texts(&harness);
    let end = said
        .iter()
        .find(|t| t.starts_with("It has the wanted amplitude after"));
    let end = end.expect("a last sentence");
    assert!(end.contains(&format!("after {runs} runs")), "{end}");
    picture(&mut harness, "tune_secant");
}
