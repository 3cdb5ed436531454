//! The mystery bench as a teacher and a student work it: made, handed on, diagnosed, revealed.

#[path = "support/ui.rs"]
mod ui;

use egui_kittest::kittest::Queryable as _;
use hysteron_core::effect::EffectId;
use hysteron_core::mystery::{Choice, Experiment, Pick, Request, make};
use serde_json::Value;
use ui::{App, NARROW, WIDE, app, click, finish, picture, show, state, type_over};

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
fn a_mystery_is_made_handed_on_diagnosed_and_revealed() {
    // The teacher hides dry friction.
    let mut teacher = app("mystery", WIDE);
    click(&mut teacher, "I choose");
    click(&mut teacher, "Coulomb friction");
    picture(&mut teacher, "mystery_choices");
    harness_refuses_without_a_word(&mut teacher);
    type_over(&mut teacher, "Word", WORD);
    click(&mut teacher, "Make the mystery");
    picture(&mut teacher, "mystery_made");
    let page = state(&teacher)["link"].as_str().expect("a link").to_owned();
    assert!(
        !page.contains("coulomb") && !page.contains("whale"),
        "{page}"
    );
    teacher.get_by_label("Copy the mystery's link").click();
    let link = copied(&mut teacher).expect("a link on the clipboard");
    assert!(link.len() <= 16_384, "{} characters", link.len());

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
    assert!(opened["error"].as_f64().expect("an error") > 3.0);
    // Revealed too early, the model has missed it.
    click(&mut student, "Reveal ...");
    student.get_by_label_contains("The truth about this record lies in it, sealed");
    type_over(&mut student, "Word", "green whale");
    click(&mut student, "Reveal the truth");
    assert_eq!(
        state(&student)["sealed"]["message"],
        "This word does not open the seal."
    );
    student
        .get_by_label("Add Coulomb friction")
        .click_accesskit();
    finish(&mut student);
    assert!(state(&student)["error"].as_f64().expect("an error") < 1.2);
    type_over(&mut student, "Word", WORD);
    click(&mut student, "Reveal the truth");
    student.get_by_label("Coulomb friction: found");
    let points = state(&student)["sealed"]["points"]
        .as_f64()
        .expect("points");
    assert!(points > 95.0, "{points}");
    picture(&mut student, "mystery_revealed");
}

fn harness_refuses_without_a_word(teacher: &mut App) {
    teacher.get_by_label_contains("It needs a word of 6 letters");
    click(teacher, "Make the mystery");
    assert_eq!(state(teacher)["mystery"]["made"], Value::Null);
}
