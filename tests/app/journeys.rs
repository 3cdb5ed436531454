//! Ways through the app by clicks alone, counted: on what is in view, without keys, links or scrolling.

use std::sync::Arc;

use crate::support::ui::{App, Dropped, WIDE, app, finish, finish_when, show, state, texts};
use egui::Rect;
use egui_kittest::kittest::Queryable as _;
use hysteron_core::effect::EffectId;
use hysteron_core::mystery::{Choice, Experiment, Pick, Request, make};

/// Someone at the app, and how often they have clicked.
struct Visitor {
    app: App,
    clicks: usize,
}

impl Visitor {
    /// Before the first page, in its first frame.
    fn new() -> Self {
        let app = app("start", WIDE);
        Self { app, clicks: 0 }
    }

    /// Clicks what has this name, where it is seen.
    fn click(&mut self, name: &str) {
        let window = Rect::from_min_size(egui::Pos2::ZERO, WIDE.into());
        let node = self.app.get_by_label(name);
        assert!(window.contains_rect(node.rect()), "{name}: {}", node.rect());
        node.click();
        self.clicks += 1;
        finish(&mut self.app);
    }

    fn says(&self, part: &str) {
        let texts = texts(&self.app);
        assert!(texts.iter().any(|t| t.contains(part)), "{part}: {texts:#?}");
    }

    /// Whether something moves by itself.
    fn moves(&mut self) -> bool {
        let clock = |app: &App| state(app)["clock"].as_f64().expect("a clock");
        let before = clock(&self.app);
        self.app.run_steps(4);
        clock(&self.app) > before
    }

    fn error(&self) -> f64 {
        state(&self.app)["error"].as_f64().expect("an error")
    }

    fn hint(&self) -> String {
        let hint = state(&self.app)["hint"].clone();
        hint.as_str().expect("a hint").to_owned()
    }
}

#[test]
fn in_the_first_minute_three_clicks_lead_to_something_that_moves_and_is_explained() {
    // Without a click.
    let mut visitor = Visitor::new();
    assert!(visitor.moves());
    visitor.says("Why does a thermostat never come to rest?");
    visitor.says("It always switches too late");
    visitor.says("It oscillates: period 4.788 s");
    // Another story, and what it is about: one click, and one that changes it.
    visitor.click("Open Backlash");
    assert!(visitor.moves());
    visitor.says("The cycle drifts at");
    visitor.says("friction outweighs delay");
    visitor.click("Try it");
    visitor.says("The cycle stays where it is");
    assert!(visitor.clicks <= 3, "{}", visitor.clicks);
    // A measurement, and what is missing from its model.
    let mut visitor = Visitor::new();
    visitor.click("Open Compare");
    visitor.click("Open drive-02");
    visitor.says("The model's error is 5.19 × the noise");
    visitor.click("Add Coulomb friction");
    visitor.says("The missing effect was Coulomb friction");
    assert!(visitor.error() < 1.2, "{}", visitor.error());
    assert!(visitor.clicks <= 3, "{}", visitor.clicks);
}

#[test]
fn a_card_is_pressed_as_a_whole() {
    for (page, on_it, leads_to) in [
        (
            "start",
            "How wide is a gap that nobody can see?",
            "backlash",
        ),
        ("lessons", "A thermostat knows only two things", "explore"),
        ("compare", "A drive that responds late", "compare"),
    ] {
        let mut visitor = Visitor::new();
        show(&mut visitor.app, &format!("v1;{page}"));
        let words = visitor.app.query_all_by_label_contains(on_it).next();
        words.unwrap_or_else(|| panic!("{on_it}")).click();
        finish(&mut visitor.app);
        let state = state(&visitor.app);
        assert_eq!(state["page"], leads_to, "{page}");
        let opened = state["file"] == "drive-12" || state["studied"] == "relay";
        assert!(opened || leads_to == "backlash", "{page}: {state}");
    }
}

/// A drive with a force that the library does not have: t, u, x1, v1 in SI units.
fn unknown() -> Vec<u8> {
    let folder = env!("CARGO_MANIFEST_DIR");
    let path = format!("{folder}/../assets/measurements/drive-15.csv");
    std::fs::read(path).expect("a measurement that comes with the app")
}

/// The same as a logger writes it, with names and units of its own.
fn logged() -> Vec<u8> {
    let text = String::from_utf8(unknown()).expect("text");
    let per_turn = std::f64::consts::TAU;
    let factors = [1e3, 1e3, 360.0 / per_turn, 60.0 / per_turn];
    let mut rows = vec!["Time_ms;Torque_mNm;Angle_deg;Speed_rpm".to_owned()];
    for row in text.lines().skip(1) {
        let numbers = row.split(',').zip(factors);
        let numbers = numbers.map(|(n, f)| (n.parse::<f64>().expect("a number") * f).to_string());
        rows.push(numbers.collect::<Vec<_>>().join(";"));
    }
    rows.join("\n").into_bytes()
}

/// From an open record to the formula in the model.
fn to_the_formula(visitor: &mut Visitor) {
    visitor.says("No effect in the library explains the rest, but a formula does:");
    let formula = state(&visitor.app)["formula"]["text"].clone();
    assert_eq!(formula, "-a*exp(-((x-c)/w)^2)");
    visitor.click("Add formula_1");
    assert_eq!(state(&visitor.app)["effects"][1], "formula_1");
    assert!(visitor.error() < 1.15, "{}", visitor.error());
    assert!(visitor.clicks <= 4, "{}", visitor.clicks);
}

#[test]
fn four_clicks_lead_from_an_unknown_record_to_its_formula() {
    let mut visitor = Visitor::new();
    visitor.click("Open Compare");
    visitor.click("Open drive-15");
    to_the_formula(&mut visitor);
}

#[test]
fn four_clicks_lead_from_a_log_with_names_of_its_own_to_its_formula() {
    let mut visitor = Visitor::new();
    let file = Dropped("press 7.csv".into(), logged());
    let input = visitor.app.input_mut();
    input.dropped_files.push(Arc::new(file));
    finish_when(&mut visitor.app, "file or form", |state| {
        state["mapping"].is_object() || state["file"].is_string()
    });
    if state(&visitor.app)["mapping"].is_object() {
        visitor.click("Open it");
    }
    to_the_formula(&mut visitor);
}

const WORD: &str = "blue whale";

/// Someone who was given a mystery in which Coulomb friction is hidden.
fn student() -> Visitor {
    let pick = Pick {
        effect: EffectId::new("coulomb_friction"),
        value: 0.035,
    };
    let made = make(&Request {
        experiment: Experiment::Sines,
        choice: Choice::Chosen(vec![pick]),
        word: WORD.to_owned(),
        salt: [3; 16],
    });
    let mut visitor = Visitor::new();
    let link = made.expect("a mystery").link();
    show(
        &mut visitor.app,
        &format!("v1;compare;compare.mystery={link}"),
    );
    visitor
}

/// Types the password; the points that are said.
fn points(visitor: &mut Visitor) -> f64 {
    visitor.click("Reveal");
    visitor.app.get_by_label("Password").focus();
    visitor.app.step();
    visitor.app.get_by_label("Password").type_text(WORD);
    visitor.app.step();
    visitor.app.step();
    visitor.click("Reveal the truth");
    let points = state(&visitor.app)["sealed"]["points"].clone();
    let points = points.as_f64().expect("points");
    visitor.says(&format!("{points:.0} of 100 points."));
    points
}

/// Effects that are offered, in their order.
fn offered(visitor: &Visitor) -> Vec<String> {
    let all = visitor.app.query_all_by_label_contains("Add ");
    let names = all.filter_map(|node| {
        let name = egui_kittest::kittest::NodeT::accesskit_node(&node).label()?;
        Some(name.strip_prefix("Add ")?.to_owned())
    });
    names.filter(|name| name != "your effect").collect()
}

#[test]
fn a_mystery_is_solved_by_a_guess_and_nothing_tells_it_before() {
    let mut visitor = student();
    visitor.says("Which effect is missing?");
    // By name: their order tells nothing, and no error stands beside them.
    let choices = offered(&visitor);
    assert!(choices.len() > 8, "{choices:?}");
    assert!(choices.is_sorted(), "{choices:?}");
    let tells = |text: &String| text.contains("leaves ") || text.contains("helps most");
    let told: Vec<String> = texts(&visitor.app).into_iter().filter(tells).collect();
    assert_eq!(told, Vec::<String>::new());
    // What to try next has no button that would do it.
    assert!(visitor.hint().starts_with("Which fingerprint matches"));
    assert!(visitor.app.query_by_label("Try it").is_none());
    visitor.click("Fingerprints");
    let told: Vec<String> = texts(&visitor.app).into_iter().filter(tells).collect();
    assert_eq!(told, Vec::<String>::new());
    assert!(visitor.app.query_by_label_contains("looks like").is_none());
    // The guess.
    visitor
        .app
        .get_by_label("Add Coulomb friction")
        .scroll_to_me();
    finish(&mut visitor.app);
    visitor.click("Add Coulomb friction");
    assert_eq!(
        visitor.hint(),
        "The model is complete: now see what was hidden."
    );
    let points = points(&mut visitor);
    assert!(points > 95.0, "{points}");
}

#[test]
fn hints_of_a_mystery_narrow_the_choice_and_cost_points() {
    let mut visitor = student();
    let mut left = Vec::new();
    for _ in 0..3 {
        let hint = "Give me a hint (10 points)";
        visitor.app.get_by_label(hint).scroll_to_me();
        finish(&mut visitor.app);
        visitor.click(hint);
        left.push(offered(&visitor).len());
    }
    assert_eq!(left, [4, 2, 1]);
    assert_eq!(offered(&visitor), ["Coulomb friction"]);
    visitor.says("Hints have cost 30 points so far.");
    visitor.click("Add Coulomb friction");
    let points = points(&mut visitor);
    assert!((65.0..=70.0).contains(&points), "{points}");
}

#[test]
fn who_has_the_ranking_shown_pays_for_it_as_for_all_hints() {
    let mut visitor = student();
    visitor.app.get_by_label("Guess first").scroll_to_me();
    finish(&mut visitor.app);
    visitor.click("Guess first");
    assert_eq!(state(&visitor.app)["guessing"], false);
    visitor.click("Try it");
    let points = points(&mut visitor);
    assert!((65.0..=70.0).contains(&points), "{points}");
    visitor.says("Hints have cost 30 points so far.");
}
