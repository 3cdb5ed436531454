//! What one sees of a model's failure, and what to do next where a record cannot decide.

use crate::support::ui::{
    App, NARROW, WIDE, app, button, click, finish, picture, show, state, texts, type_over, wait,
};
use egui_kittest::kittest::Queryable as _;

/// Compare with a measurement of the tests, after the first fit.
fn opened(file: &str, size: [f32; 2]) -> App {
    let mut harness = app("compare", size);
    let path = format!("{}/../tests/data/{file}.csv", env!("CARGO_MANIFEST_DIR"));
    let bytes = std::fs::read(path).expect("a file of the tests");
    let ctx = harness.ctx.clone();
    let name = file.rsplit('/').next().unwrap_or_default();
    harness.state_mut().open(&ctx, name, &bytes);
    finish(&mut harness);
    harness
}

/// Presses what may stand below the fold.
fn press(harness: &mut App, label: &str) {
    harness.get_by_label(label).click_accesskit();
    finish(harness);
}

#[test]
fn what_cannot_be_told_apart_comes_with_an_experiment_that_opens_in_explore() {
    let mut harness = opened("drive-05", WIDE);
    press(&mut harness, "Add Gain asymmetry");
    harness.get_by_label("These two cannot be told apart with this record");
    harness.get_by_label("Gain asymmetry or Constant load");
    harness.get_by_label("Try this experiment");
    harness.get_by_label_contains("this record cannot tell which");
    picture(&mut harness, "compare_next_experiment");
    click(&mut harness, "Look");
    click(&mut harness, "Light");
    picture(&mut harness, "compare_next_experiment_light");
    press(&mut harness, "Limits of the experiment");
    press(&mut harness, "What other experiments would show");
    harness.get_by_label_contains("Largest input");
    press(&mut harness, "Limits of the experiment");
    // Either explanation with either gain: what one would see.
    let asymmetric = |harness: &mut App, index: usize| {
        let buttons: Vec<_> = harness
            .get_all_by_label_contains("Explore with gain")
            .collect();
        assert_eq!(buttons.len(), 4, "two models, two gains");
        buttons[index].click_accesskit();
        finish(harness);
        let state = state(harness);
        assert_eq!(state["page"], "explore", "{state}");
        state["explore"]["loop"]["relay"].clone()
    };
    let relay = asymmetric(&mut harness, 1);
    let number = |relay: &serde_json::Value, name: &str| relay[name].as_f64().expect("a number");
    assert!(
        (number(&relay, "asymmetry") - 0.06).abs() < 0.005,
        "{relay}"
    );
    assert_eq!(number(&relay, "bias"), 0.0);
    // It says what it is for, until something else is shown there.
    let purpose = "Experiment that tells Gain asymmetry and Constant load apart, for drive-05. Shown here for the case";
    harness.get_by_label(&format!("{purpose} Gain asymmetry."));
    picture(&mut harness, "explore_experiment");
    click(&mut harness, "Back to Compare");
    assert_eq!(state(&harness)["page"], "compare");
    // What has stood for a while is gone back to.
    harness.run_steps(90);
    let relay = asymmetric(&mut harness, 3);
    harness.get_by_label(&format!("{purpose} Constant load."));
    press(&mut harness, "Undo");
    assert_eq!(state(&harness)["page"], "compare");
    assert!(state(&harness)["purpose"].is_null());
    asymmetric(&mut harness, 3);
    press(&mut harness, "Dismiss");
    assert!(
        harness
            .query_by_label_contains("Experiment that tells")
            .is_none()
    );
    assert_eq!(state(&harness)["page"], "explore");
    assert!(number(&relay, "bias").abs() > 0.01, "{relay}");
    assert_eq!(number(&relay, "asymmetry"), 0.0);
}

#[test]
fn the_way_goes_back_and_forth_and_shows_the_step_before() {
    let mut harness = opened("drive-02", WIDE);
    let error = |harness: &App| state(harness)["error"].as_f64().expect("an error");
    let before = error(&harness);
    click(&mut harness, "Where it fails");
    let axes = texts(&harness);
    assert!(axes.iter().any(|t| t == "rms [× noise]"), "{axes:#?}");
    picture(&mut harness, "compare_places");
    click(&mut harness, "Fingerprints");
    assert_eq!(
        state(&harness)["compare"]["fingerprint"],
        "coulomb_friction"
    );
    harness.get_by_label_contains("The residual looks like Coulomb friction");
    picture(&mut harness, "compare_fingerprint");
    press(&mut harness, "Add Coulomb friction");
    let after = error(&harness);
    assert!(after < 1.2 && before > 2.0);
    click(&mut harness, "Where it fails");
    press(&mut harness, "Show the previous step too");
    picture(&mut harness, "compare_before_and_after");
    click(&mut harness, "Take back Coulomb friction");
    assert_eq!(error(&harness), before);
    click(&mut harness, "Put Coulomb friction back");
    assert_eq!(error(&harness), after, "forth again, without a new fit");
    click(&mut harness, "Baseline");
    assert_eq!(error(&harness), before);
    click(&mut harness, "+ Coulomb friction");
    assert_eq!(error(&harness), after);
}

#[test]
fn a_link_brings_the_whole_way_and_not_its_end_alone() {
    let way = |harness: &App| -> Vec<String> {
        let texts = texts(harness);
        let rows = ["Baseline", "+ Coulomb friction", "+ Quadratic drag"];
        // Beside the name of a step stands its error.
        let known = texts.windows(2).filter(|w| rows.contains(&&*w[0]));
        known.flatten().cloned().collect()
    };
    let mut here = opened("drive-02", WIDE);
    press(&mut here, "Add Coulomb friction");
    let shown = way(&here);
    assert_eq!(shown.len(), 4, "{shown:?}");
    let link = state(&here)["link"].as_str().expect("a link").to_owned();
    let mut there = app("explore", WIDE);
    show(&mut there, &link);
    assert_eq!(way(&there), shown);
    // While it is not known, the way is there: back at once, and on to the end.
    let two = "v1;compare;compare.effects=%5B%22coulomb_friction%22%2C%22quadratic_drag%22%5D;compare.file=drive-02";
    show(&mut there, "v1;compare");
    show(&mut there, two);
    assert_eq!(way(&there).len(), 6);
    click(&mut there, "Baseline");
    assert_eq!(state(&there)["steps"][1], state(&here)["error"]);
    click(&mut there, "+ Coulomb friction");
    assert_eq!(state(&there)["error"], state(&here)["error"]);
}

#[test]
fn the_finding_that_is_shaded_lies_in_the_plots() {
    let mut harness = opened("../../assets/measurements/drive-03", WIDE);
    let marked = |harness: &App, share: &str| {
        let said = texts(harness);
        let words = format!("{share} % of the error");
        assert!(said.contains(&words), "{said:#?}");
    };
    // Seconds after the first periods.
    let first =
        "48\u{a0}% of the position error comes from the 8\u{a0}% of samples within 15.2\u{a0}ms";
    harness.get_by_label_contains(first);
    marked(&harness, "48");
    let other =
        "41\u{a0}% of the velocity error comes from the 10\u{a0}% of samples between 1.80\u{a0}s";
    harness.get_by_label_contains(other).click();
    finish(&mut harness);
    marked(&harness, "41");
    picture(&mut harness, "compare_finding");
}

#[test]
fn an_effect_of_ones_own_is_named_as_one_writes() {
    let mut harness = opened("drive-05", WIDE);
    press(&mut harness, "An effect of your own");
    harness.get_by_label("Add your effect").scroll_to_me();
    finish(&mut harness);
    type_over(&mut harness, "Name", "Bump at the stop");
    finish(&mut harness);
    harness.get_by_label("In the model it is called bump_at_the_stop.");
    picture(&mut harness, "compare_own_effect");
    press(&mut harness, "Add your effect");
    assert_eq!(state(&harness)["effects"][1], "bump_at_the_stop");
}

#[test]
fn what_no_effect_explains_comes_out_as_a_formula_that_one_click_adds() {
    let mut harness = opened("../../assets/measurements/drive-15", WIDE);
    // It was looked for without being asked.
    let formula = state(&harness)["formula"].clone();
    assert_eq!(formula["text"], "-a*exp(-((x-c)/w)^2)");
    harness.get_by_label_contains("but a formula does:");
    let set = harness.query_all_by_label("F = -a*exp(-((x-c)/w)^2)");
    assert!(
        set.count() > 1,
        "typeset in the answer and beside its button"
    );
    let said = texts(&harness);
    assert!(said.iter().any(|t| t.starts_with("95 %: 0.79")), "{said:?}");
    says(&harness, "A formula explains what is left: add it");
    picture(&mut harness, "compare_formula");
    press(&mut harness, "Add formula_1");
    let error = |harness: &App| state(harness)["error"].as_f64();
    assert!(error(&harness).is_some_and(|e| e < 1.15));
    assert_eq!(state(&harness)["effects"][1], "formula_1");
    says(&harness, "Nothing more is missing");
    // It goes wherever an effect of one's own goes.
    let link = state(&harness)["link"].as_str().expect("a link").to_owned();
    assert!(
        link.contains("compare.own=") && link.contains("formula_1"),
        "{link}"
    );
    let mut there = app("compare", WIDE);
    show(&mut there, &link);
    assert_eq!(error(&there), error(&harness));
    // Back again, and by what the page says to do next.
    press(&mut harness, "Baseline");
    assert_eq!(state(&harness)["formula"], formula);
    press(&mut harness, "Try it");
    assert_eq!(state(&harness)["effects"][1], "formula_1");
    assert!(error(&harness).is_some_and(|e| e < 1.15));
}

#[test]
fn a_narrow_window_shows_the_formula_too() {
    let mut harness = opened("../../assets/measurements/drive-15", NARROW);
    harness.get_by_label("Add formula_1").scroll_to_me();
    finish(&mut harness);
    picture(&mut harness, "compare_formula_narrow");
}

#[test]
fn in_a_low_window_each_plot_is_scrolled_to_with_its_axis() {
    let size = [1000.0, 700.0];
    let mut harness = opened("drive-05", size);
    let last = "Plot: v1 - model [rad/s] over time [s]";
    let plot = |harness: &App| harness.get_by_label(last).rect();
    assert!(plot(&harness).height() >= 60.0, "{}", plot(&harness));
    harness.hover_at(egui::pos2(300.0, 400.0));
    harness.step();
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::vec2(0.0, -2000.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: egui::Modifiers::NONE,
    });
    harness.run_steps(60);
    // Beneath it are the labels of time, and the hint.
    assert!(
        plot(&harness).bottom() < size[1] - 60.0,
        "{}",
        plot(&harness)
    );
    // All four are in view then.
    let first = harness.get_by_label("Plot: x1 [rad] over time [s]").rect();
    assert!(first.top() > 60.0, "{first}");
    picture(&mut harness, "compare_low");
}

#[test]
fn a_narrow_window_shows_the_next_experiment_too() {
    let mut harness = opened("drive-05", NARROW);
    press(&mut harness, "Add Gain asymmetry");
    harness.get_by_label("Try this experiment").scroll_to_me();
    finish(&mut harness);
    picture(&mut harness, "compare_next_experiment_narrow");
}

/// What the page says to try next: short, and about this.
fn left_ends(harness: &App, names: &[&str]) -> Vec<f32> {
    let at = |name: &&str| harness.get_by_label(name).rect().left();
    names.iter().map(at).collect()
}

#[test]
fn the_plots_over_time_line_up_however_wide_their_labels_are() {
    for (file, size) in [
        ("drive-02", WIDE),
        ("drive-05", [1100.0, 720.0]),
        ("drive-02", NARROW),
    ] {
        let mut harness = opened(file, size);
        finish(&mut harness);
        let names = [
            "Plot: x1 [rad] over time [s]",
            "Plot: x1 - model [rad] over time [s]",
            "Plot: v1 [rad/s] over time [s]",
            "Plot: v1 - model [rad/s] over time [s]",
        ];
        let lefts = left_ends(&harness, &names);
        let apart = lefts.iter().map(|left| (left - lefts[0]).abs());
        assert!(
            apart.fold(0.0, f32::max) < 1.0,
            "{file} {size:?}: {lefts:?}"
        );
    }
}

fn says(harness: &App, part: &str) {
    let state = state(harness);
    let hint = state["hint"].as_str().expect("a hint");
    assert!(hint.contains(part), "{hint}");
    assert!(hint.len() < 80, "{hint}");
}

#[test]
fn the_hint_follows_what_is_open_and_what_was_found() {
    let mut harness = app("compare", WIDE);
    says(&harness, "Begin with a drive");
    // Pressed again and again, it leads through a diagnosis and on to another record.
    click(&mut harness, "Try it");
    assert_eq!(state(&harness)["file"], "drive-02");
    says(&harness, "Coulomb friction helps most");
    click(&mut harness, "Try it");
    assert!(state(&harness)["error"].as_f64().is_some_and(|e| e < 1.2));
    says(&harness, "Nothing more is missing: compare with");
    click(&mut harness, "Try it");
    let link = state(&harness)["link"].clone();
    assert!(
        link.as_str()
            .is_some_and(|l| l.contains("compare.before=true"))
    );
    says(&harness, "A drive that responds late");
    click(&mut harness, "Try it");
    assert_eq!(state(&harness)["file"], "drive-12");
    says(&harness, "helps most: add it");
    // What no data of it can decide.
    let mut harness = opened("drive-05", WIDE);
    says(&harness, "helps most; this record cannot tell which");
    press(&mut harness, "Try it");
    let added = state(&harness)["effects"][1].clone();
    assert!(
        added == "gain_asymmetry" || added == "constant_load",
        "{added}"
    );
    says(&harness, "Only another experiment");
    press(&mut harness, "Try it");
    assert_eq!(state(&harness)["page"], "explore");
    // Nothing to find, but elsewhere.
    let harness = opened("drive-01", WIDE);
    says(&harness, "A drive that responds late");
}

#[test]
fn the_hint_says_what_is_under_way_needless_or_contradicted() {
    let mut harness = app("compare", WIDE);
    let text = "v1;compare;compare.effects=%5B%22coulomb_friction%22%2C%22quadratic_drag%22%5D;compare.file=drive-02";
    let ctx = harness.ctx.clone();
    assert_eq!(harness.state_mut().open_link(&ctx, text), Ok(()));
    harness.step();
    says(&harness, "Every effect in the library is being tried");
    finish(&mut harness);
    says(&harness, "Quadratic drag is not needed: remove it");
    press(&mut harness, "Try it");
    assert!(state(&harness)["error"].as_f64().is_some_and(|e| e < 1.2));
    says(&harness, "Nothing more is missing");
    // A motor of which the model says that it has twice its inertia, for certain.
    let known = "kind = \"drive\"\n[parameters]\nJ1 = { value = 1.8e-3, unit = \"kg m^2\", status = \"fixed\" }\n";
    harness
        .state_mut()
        .open(&ctx, "wrong.toml", known.as_bytes());
    finish(&mut harness);
    says(&harness, "Correct the given value of J1 in your model");
}

#[test]
fn a_parameter_is_set_by_hand_and_everything_answers() {
    let mut harness = app("compare", WIDE);
    show(
        &mut harness,
        "v1;compare;compare.effects=%5B%22coulomb_friction%22%5D;compare.file=drive-02",
    );
    let fitted = state(&harness)["error"].as_f64().expect("an error");
    let slider = harness.get_by_label("friction level").rect();
    harness.hover_at(slider.center());
    harness.step();
    let event = |pressed, at| button(at, egui::PointerButton::Primary, pressed);
    harness
        .input_mut()
        .events
        .push(event(true, slider.center()));
    harness.step();
    // While it is held, the samples in view answer in the same frame.
    let mut errors = Vec::new();
    for share in [0.3, 0.2, 0.1] {
        let at = egui::pos2(slider.left() + share * slider.width(), slider.center().y);
        harness
            .input_mut()
            .events
            .push(egui::Event::PointerMoved(at));
        harness.step();
        harness.step();
        let by_hand = &state(&harness)["by_hand"];
        assert_eq!(by_hand["exact"], false, "{by_hand}");
        errors.push(by_hand["error"].as_f64().expect("an error by hand"));
    }
    assert!(errors.windows(2).all(|e| e[1] > e[0]), "{errors:?}");
    assert!(texts(&harness).iter().any(|t| t == "by hand"));
    let at = egui::pos2(slider.left() + 0.1 * slider.width(), slider.center().y);
    harness.input_mut().events.push(event(false, at));
    finish(&mut harness);
    let by_hand = state(&harness)["by_hand"].clone();
    assert_eq!(by_hand["exact"], true, "the whole record, once let go");
    let exact = by_hand["error"].as_f64().expect("an error by hand");
    assert!(exact > 2.0 * fitted, "{exact} by hand, {fitted} fitted");
    picture(&mut harness, "compare_by_hand");
    press(&mut harness, "Back to the fit");
    assert!(state(&harness)["by_hand"].is_null());
    assert_eq!(state(&harness)["error"].as_f64(), Some(fitted));
}

#[test]
fn a_new_step_comes_part_by_part() {
    let mut harness = app("compare", WIDE);
    let ctx = harness.ctx.clone();
    let link = "v1;compare;compare.file=process-02";
    assert_eq!(harness.state_mut().open_link(&ctx, link), Ok(()));
    wait(&mut harness, "step", |s| !s["error"].is_null());
    // The answer, the plots, the list: no frame draws all of them for the first time.
    let parts = |harness: &App| {
        let plots = state(harness)["plots"].to_string();
        let list = harness.query_by_label("An effect of your own").is_some();
        (
            plots.contains("y - model"),
            list,
            state(harness)["busy"] == true,
        )
    };
    assert_eq!(parts(&harness), (false, false, true));
    harness.step();
    assert_eq!(parts(&harness), (true, false, true));
    harness.step();
    assert_eq!(parts(&harness), (true, true, true));
    harness.step();
    assert_eq!(parts(&harness), (true, true, false));
    harness.get_by_label("Parameters of the model");
}
