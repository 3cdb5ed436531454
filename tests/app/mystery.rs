//! The mystery bench as a teacher and a student work it: made, handed on, diagnosed, revealed.

use crate::support::ui::{
    App, NARROW, TALL, WIDE, app, click, controls, finish, picture, show, state, texts, type_over,
};
use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable as _;
use hysteron_core::effect::EffectId;
use hysteron_core::mystery::{Choice, Experiment, Mystery, Pick, Request, make};
use serde_json::Value;

const WORD: &str = "blue whale";

/// The text that the next frames put on the clipboard.
fn copied(harness: &mut App) -> Option<String> {
    (0..4).find_map(|_| {
        harness.step();
        let commands = &harness.output().platform_output.commands;
        commands.iter().find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    })
}

#[test]
fn a_mystery_is_made_sealed_handed_on_and_revealed() {
    // The teacher hides a dead time.
    let mut teacher = app("mystery", WIDE);
    click(&mut teacher, "Relay");
    click(&mut teacher, "I choose");
    click(&mut teacher, "Input delay");
    picture(&mut teacher, "mystery_choices");
    harness_refuses_without_a_word(&mut teacher);
    type_over(&mut teacher, "Password", WORD);
    click(&mut teacher, "Make the mystery");
    let page = state(&teacher)["link"].as_str().expect("a link").to_owned();
    assert!(!page.contains("delay") && !page.contains("whale"), "{page}");
    let hint = state(&teacher)["hint"].as_str().expect("a hint").to_owned();
    assert!(hint.starts_with("Share the file or link"), "{hint}");
    // What is chosen afterwards is not in it.
    let remark = "This is still the mystery you made before: your choices have changed since.";
    assert!(teacher.query_by_label(remark).is_none());
    click(&mut teacher, "large");
    teacher.get_by_label(remark);
    click(&mut teacher, "medium");
    assert!(teacher.query_by_label(remark).is_none());
    teacher.get_by_label("Copy the mystery's link").click();
    let link = copied(&mut teacher).expect("a link on the clipboard");
    assert!(link.len() <= 16_384, "{} characters", link.len());

    // The file is the same record.
    let (there, given) = std::sync::mpsc::channel();
    teacher.state_mut().divert_files(there);
    click(&mut teacher, "Save the file");
    let (name, bytes) = given.try_recv().expect("a file");
    let (_, text) = link.split_once("mystery=").expect("a mystery");
    let linked = Mystery::from_link(text).expect("a mystery");
    assert_eq!(name, format!("{}.csv", linked.name()));
    assert_eq!(bytes, linked.csv().into_bytes());

    // The student opens the link.
    let mut student = app("start", WIDE);
    show(&mut student, &link);
    let opened = state(&student);
    assert_eq!(opened["page"], "compare");
    assert!(
        opened["file"]
            .as_str()
            .expect("a file")
            .starts_with("mystery-")
    );
    click(&mut student, "Reveal ...");
    student.get_by_label_contains("The truth about this record is sealed inside it");
    type_over(&mut student, "Password", "green whale");
    click(&mut student, "Reveal the truth");
    assert_eq!(
        state(&student)["sealed"]["message"],
        "This password does not open the seal."
    );
    // Revealed too early, the model has missed it.
    type_over(&mut student, "Password", WORD);
    student.key_press(Key::Enter);
    finish(&mut student);
    student.get_by_label("Input delay: missed");
    student.get_by_label("A mystery: its truth is revealed.");
    assert!(student.query_by_label("Password").is_none());
    // The word is not asked for again.
    student.get_by_label("Add Input delay").click_accesskit();
    finish(&mut student);
    click(&mut student, "Judge this one");
    student.get_by_label("Input delay: found");
    assert!(student.query_by_label("Judge this one").is_none());
}

#[test]
fn what_is_hidden_on_one_machine_is_not_changed_by_the_other() {
    let mut teacher = app("mystery", TALL);
    click(&mut teacher, "I choose");
    click(&mut teacher, "A process");
    click(&mut teacher, "Staircase");
    click(&mut teacher, "Input delay");
    let strength = |teacher: &App| {
        let chosen = controls(teacher, &[Role::SpinButton]);
        let [(name, _)] = &chosen[..] else {
            panic!("one strength: {chosen:?}");
        };
        let field = teacher.get_by_label(name);
        field.value().expect("a strength")
    };
    let chosen = strength(&teacher);
    for (key, times) in [(Key::Z, 6), (Key::Y, 6)] {
        for _ in 0..times {
            teacher.key_press_modifiers(Modifiers::COMMAND, key);
            finish(&mut teacher);
        }
    }
    assert_eq!(
        state(&teacher)["link"],
        "v1;mystery;mystery.by_hand=true;mystery.experiment=process_stairs"
    );
    assert_eq!(strength(&teacher), chosen);
}

#[test]
fn a_student_adds_what_is_hidden_and_gets_the_points() {
    let pick = Pick {
        effect: EffectId::new("coulomb_friction"),
        value: 0.035,
    };
    let made = mystery(Experiment::Sines, vec![pick]);
    let mut student = app("start", WIDE);
    let text = format!("v1;compare;compare.mystery={}", made.link());
    show(&mut student, &text);
    assert!(state(&student)["error"].as_f64().expect("an error") > 1.5);
    student
        .get_by_label("Add Coulomb friction")
        .click_accesskit();
    finish(&mut student);
    assert!(state(&student)["error"].as_f64().expect("an error") < 1.3);
    assert_eq!(
        state(&student)["hint"],
        "The model is complete: now see what was hidden."
    );
    click(&mut student, "Reveal ...");
    type_over(&mut student, "Password", WORD);
    click(&mut student, "Reveal the truth");
    student.get_by_label("Coulomb friction: found");
    let points = state(&student)["sealed"]["points"]
        .as_f64()
        .expect("points");
    assert!(points > 95.0, "{points}");
    // The truth is written as what was found: the same decimals.
    let said = texts(&student);
    let at = said.iter().position(|t| t.starts_with("J1 ("));
    let row = &said[at.expect("a row of the inertia")..];
    let decimals = |text: &str| {
        let number = text.split(' ').next().unwrap_or_default();
        let digits = |d: &str| d.chars().take_while(char::is_ascii_digit).count();
        number.split_once('.').map(|(_, d)| digits(d))
    };
    assert!(row[2].contains('±'), "{row:#?}");
    assert_eq!(decimals(&row[1]), decimals(&row[2]), "{row:#?}");
    // On from there, and not back to the seal.
    let next = "Nothing more is missing: compare with what the previous step left.";
    assert_eq!(state(&student)["hint"], next);
    click(&mut student, "Try it");
    let texts = texts(&student);
    assert!(texts.iter().any(|t| t == "the previous step"), "{texts:#?}");
    let state = state(&student);
    let hint = state["hint"].as_str().expect("a hint");
    assert!(hint.contains("A drive that responds late"), "{hint}");
}

fn harness_refuses_without_a_word(teacher: &mut App) {
    teacher.get_by_label_contains("The password needs at least 6 characters");
    click(teacher, "Make the mystery");
    assert_eq!(state(teacher)["mystery"]["made"], Value::Null);
}

/// A mystery of the bench with these effects.
fn mystery(experiment: Experiment, picks: Vec<Pick>) -> Mystery {
    make(&Request {
        experiment,
        choice: Choice::Chosen(picks),
        word: WORD.to_owned(),
        salt: [3; 16],
    })
    .expect("a mystery")
}

#[test]
fn a_mystery_file_in_which_nothing_is_hidden_is_a_mystery_too() {
    let made = mystery(Experiment::Relay, Vec::new());
    let mut student = app("mystery", NARROW);
    picture(&mut student, "mystery_narrow");
    let ctx = student.ctx.clone();
    let name = format!("{}.csv", made.name());
    student.state_mut().open(&ctx, &name, made.csv().as_bytes());
    finish(&mut student);
    assert_eq!(state(&student)["page"], "compare");
    let said = student.get_all_by_label_contains("Nothing is missing");
    assert_eq!(said.count(), 2, "the answer and the data");
    student.get_by_label("Reveal ...").click_accesskit();
    finish(&mut student);
    type_over(&mut student, "Password", WORD);
    student.get_by_label("Reveal the truth").click_accesskit();
    finish(&mut student);
    student.get_by_label("Nothing was hidden, and nothing was added: right.");
    picture(&mut student, "mystery_revealed_narrow");
    // Another file has no truth in it.
    show(&mut student, "v1;compare;compare.file=drive-02");
    assert_eq!(state(&student)["sealed"], Value::Null);
    assert!(student.query_by_label("Reveal ...").is_none());
}

#[test]
fn a_students_model_goes_back_to_the_teacher_in_a_link() {
    let pick = Pick {
        effect: EffectId::new("input_delay"),
        value: 7e-4,
    };
    let made = mystery(Experiment::Relay, vec![pick]);
    let text = format!("v1;compare;compare.mystery={}", made.link());
    let mut student = app("start", WIDE);
    show(&mut student, &text);
    assert_eq!(state(&student)["link"], text);
    // What helps is not told; a wrong guess, sent for help.
    assert_eq!(state(&student)["guessing"], true);
    student.get_by_label("Which effect is missing?");
    student.get_by_label("Add Dead zone").click_accesskit();
    finish(&mut student);
    let answer = state(&student)["link"].as_str().expect("a link").to_owned();
    let mut teacher = app("mystery", WIDE);
    show(&mut teacher, &answer);
    assert_eq!(
        state(&teacher)["effects"],
        serde_json::json!(["viscous_friction", "dead_zone"])
    );
    click(&mut teacher, "Reveal");
    type_over(&mut teacher, "Password", WORD);
    click(&mut teacher, "Reveal the truth");
    teacher.get_by_label("Input delay: missed");
    teacher.get_by_label("Dead zone: wrong, it is not there");
    let points = state(&teacher)["sealed"]["points"]
        .as_f64()
        .expect("points");
    assert!(points < 30.0, "{points}");
    picture(&mut teacher, "mystery_revealed");
    // The way back to a page without a mystery.
    show(&mut teacher, "v1;compare");
    assert_eq!(state(&teacher)["file"], Value::Null);
}
