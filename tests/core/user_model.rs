//! What a user knows of a model takes part in the diagnosis, and a file that says it wrongly gets one clear
//! sentence.

use crate::support::diagnosis::{classes, finish};
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::{CriticismError, Diagnosis};
use hysteron_core::measurement::{Kind, Measurement, import_csv};
use hysteron_core::rig::{DriveRig, Excitation, Friction};
use hysteron_core::user_model::{MAX_BYTES, Status, UserModel};
use proptest::prelude::*;

fn measured(name: &str) -> Measurement {
    let path = format!("{}/../tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    import_csv(name, &std::fs::read(path).unwrap(), None).unwrap()
}

fn diagnose(measurement: &Measurement, model: &str) -> Diagnosis {
    let model = UserModel::from_toml(model).unwrap();
    finish(DiagnosisJob::with_model(measurement, &model).unwrap())
}

/// Value and standard error of a parameter of the last model.
fn parameter(d: &Diagnosis, symbol: &str) -> (f64, f64) {
    let p = crate::support::parameter::parameter(d, symbol);
    (p.value, p.std_error)
}

#[test]
fn an_effect_that_the_model_has_is_not_missing() {
    // drive-12 has Coulomb friction 0.05 and a dead time of 0.6 ms.
    let d = diagnose(
        &measured("drive-12"),
        "kind = \"drive\"\n[[effects]]\nid = \"coulomb_friction\"\n",
    );
    assert_eq!(classes(&d), [["input_delay"]], "{}", d.verdict.text);
    assert!(d.verdict.complete);
    assert_eq!(
        d.steps[0].effects.last().unwrap().as_str(),
        "coulomb_friction"
    );
    assert!((parameter(&d, "c").0 / 0.05 - 1.0).abs() < 0.05);
}

#[test]
fn an_effect_that_the_data_do_not_show_stays_and_is_named() {
    let d = diagnose(
        &measured("process-02"),
        "kind = \"process\"\n[[effects]]\nid = \"load_ramp\"\n",
    );
    let last = d.steps.last().unwrap();
    assert!(last.effects.iter().any(|e| e.as_str() == "load_ramp"));
    assert_eq!(classes(&d), [["input_delay"]], "{}", d.verdict.text);
    assert!(
        d.verdict
            .text
            .to_string()
            .contains("without a trace in these data: Load ramp")
    );
}

#[test]
fn a_value_fixed_wrongly_is_kept_and_said() {
    let measurement = measured("drive-01");
    let d = diagnose(
        &measurement,
        "kind = \"drive\"\n[parameters]\nJ1 = 1.1e-3\n",
    );
    assert_eq!(parameter(&d, "J1"), (1.1e-3, 0.0), "never changed");
    assert!(!d.verdict.complete && classes(&d).is_empty());
    let [c] = d.verdict.contradicted.as_slice() else {
        panic!("one contradiction: {}", d.verdict.text);
    };
    assert_eq!((c.name.as_str(), c.held), ("J1", 1.1e-3));
    // The rig's inertia.
    assert!((c.wanted / 8.8e-4 - 1.0).abs() < 1e-3, "{c:?}");
    assert!(c.error < 1.2 && d.steps[0].error > 10.0);
    assert!(
        d.verdict.text.to_string().contains("given J1"),
        "{}",
        d.verdict.text
    );
}

/// What takes the place of the user's effect, with a level of its own, is no way round the level that is held.
#[test]
fn a_level_held_wrongly_is_said_though_another_friction_would_do() {
    let rig = DriveRig {
        friction: Friction::dry(0.06),
        inertia: 2e-3,
        viscous: 5e-3,
        excitation: Excitation::Multisine { amplitude: 0.4 },
        ..DriveRig::default()
    };
    let held = "kind = \"drive\"\n[[effects]]\nid = \"coulomb_friction\"\n[effects.parameters]\nc = 0.03\n";
    let d = diagnose(&rig.measure(), held);
    let [c] = d.verdict.contradicted.as_slice() else {
        panic!("one contradiction: {}", d.verdict.text);
    };
    assert_eq!((c.name.as_str(), c.held), ("c", 0.03));
    assert!((c.wanted / 0.06 - 1.0).abs() < 0.1, "{c:?}");
    assert!(
        !d.verdict.text.to_string().contains("without a trace"),
        "{}",
        d.verdict.text
    );
}

#[test]
fn a_value_that_the_data_overrule_is_said_though_all_is_explained() {
    let d = diagnose(
        &measured("drive-01"),
        "kind = \"drive\"\n[parameters]\nJ1 = { value = 1.1e-3, tolerance = 1e-6 }\n",
    );
    assert!(d.verdict.complete && classes(&d).is_empty());
    let [c] = d.verdict.contradicted.as_slice() else {
        panic!("one contradiction: {}", d.verdict.text);
    };
    assert!((c.wanted / 8.8e-4 - 1.0).abs() < 1e-3, "{c:?}");
    assert!(
        d.verdict.text.to_string().contains("given J1"),
        "{}",
        d.verdict.text
    );
    let [o] = d.verdict.overruled.as_slice() else {
        panic!("one value overruled: {}", d.verdict.text);
    };
    assert_eq!(
        (o.name.as_str(), o.given, o.tolerance),
        ("J1", 1.1e-3, 1e-6)
    );
    assert!((o.found / 8.8e-4 - 1.0).abs() < 1e-3, "{o:?}");
    assert!(
        d.verdict
            .text
            .to_string()
            .starts_with("The model is given J1"),
        "{}",
        d.verdict.text
    );
    let usual = diagnose(
        &measured("drive-01"),
        "kind = \"drive\"\n[parameters]\nJ1 = { value = 8.9e-4, tolerance = 1e-5 }\n",
    );
    assert!(
        usual.verdict.contradicted.is_empty(),
        "{}",
        usual.verdict.text
    );
}

#[test]
fn a_value_overruled_beside_what_is_missing_is_said_first_and_last() {
    // drive-02 has a constant load or an asymmetry, and the inertia of drive-01.
    let d = diagnose(
        &measured("drive-02"),
        "kind = \"drive\"\n[parameters]\nJ1 = { value = 1.1e-3, tolerance = 2e-5 }\n",
    );
    let [o] = d.verdict.overruled.as_slice() else {
        panic!("one value overruled: {}", d.verdict.text);
    };
    assert!(o.found < 1.04e-3, "{o:?}");
    let text = &d.verdict.text;
    assert!(
        text.to_string()
            .starts_with("The data contradict what was given: J1 is")
            || text.to_string().starts_with("The model is given J1"),
        "{text}"
    );
    assert!(
        text.to_string().ends_with("given: J1.")
            || text.to_string().ends_with("looking for effects."),
        "{text}"
    );
}

#[test]
fn a_value_fixed_rightly_disturbs_nothing() {
    let d = diagnose(
        &measured("drive-02"),
        "kind = \"drive\"\n[parameters]\nJ1 = { value = 8.8e-4, unit = \"kg m^2\", status = \"fixed\" }\n",
    );
    assert_eq!(classes(&d), [["coulomb_friction"]], "{}", d.verdict.text);
    assert!(d.verdict.complete && d.verdict.contradicted.is_empty());
    assert_eq!(parameter(&d, "J1"), (8.8e-4, 0.0));
}

#[test]
fn a_prior_draws_as_strongly_as_it_is_sure() {
    let measurement = measured("process-01");
    let model = |gain: &str| {
        let known = format!("K = {{ value = {gain} }}");
        format!("kind = \"process\"\n[parameters]\n{known}\n")
    };
    let free = diagnose(&measurement, &model("2.0, status = \"free\""));
    let (value, error) = parameter(&free, "K");
    let far = value + 4.0 * error;
    let with = |tolerance: f64| {
        let d = diagnose(
            &measurement,
            &model(&format!("{far}, tolerance = {tolerance}")),
        );
        parameter(&d, "K")
    };
    let (unsure, even, sure) = (with(1e3 * error), with(error), with(1e-3 * error));
    assert!((unsure.0 - value).abs() < 0.01 * error, "{unsure:?}");
    assert!((sure.0 - far).abs() < 0.01 * error, "{sure:?}");
    assert!(
        value + 0.1 * error < even.0 && even.0 < far - 0.1 * error,
        "{even:?}"
    );
    assert!(sure.1 < 2e-3 * error && even.1 < error && unsure.1 > 0.9 * error);
}

#[test]
fn a_saved_model_explains_its_measurement() {
    let measurement = measured("process-02");
    let first = diagnose(&measurement, "kind = \"process\"\n");
    let last = first.steps.last().unwrap();
    let saved = UserModel::from_step(Kind::Process, last, None);
    let text = saved.to_toml();
    assert_eq!(UserModel::from_toml(&text), Ok(saved), "{text}");
    let again = diagnose(&measurement, &text);
    assert_eq!(again.steps.len(), 1, "nothing is added or removed");
    assert!((again.steps[0].error - last.error).abs() < 1e-3);
    assert!(again.verdict.complete && again.verdict.missing.is_empty());
}

#[test]
fn a_model_must_suit_the_measurement() {
    let refused = |name: &str, text: &str| {
        let model = UserModel::from_toml(text).unwrap();
        DiagnosisJob::with_model(&measured(name), &model).err()
    };
    let error = refused("process-01", "kind = \"drive\"");
    assert!(matches!(error, Some(CriticismError::WrongKind { .. })));
    let error = refused(
        "drive-01",
        "kind = \"drive\"\n[parameters]\nJ1 = { value = 90, unit = \"kg\" }",
    );
    let text = error.unwrap().to_string();
    assert!(
        text.contains("J1 in kg") && text.contains("kg m^2"),
        "{text}"
    );
}

#[test]
fn an_error_that_is_no_number_is_not_said() {
    // No file is read with such a value.
    let mut measurement = measured("drive-01");
    measurement.outputs[0].values[500] = 1e300;
    let job = DiagnosisJob::new(&measurement).unwrap();
    let step = finish(job).steps.pop().unwrap();
    assert!(!step.error.is_finite(), "{}", step.error);
    let refused = step.checked().unwrap_err();
    assert_eq!(refused, CriticismError::NotFinite);
    assert!(refused.to_string().contains("too large or too small"));
    let job = DiagnosisJob::new(&measured("drive-01")).unwrap();
    assert!(finish(job).steps.iter().all(|step| step.checked().is_ok()));
}

/// The text is refused on this line with a sentence that has these parts.
#[track_caller]
fn refused(text: &str, line: usize, parts: &[&str]) {
    let error = UserModel::from_toml(text).unwrap_err();
    let said = error.to_string();
    assert_eq!(error.line, line, "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    for part in parts {
        assert!(said.contains(part), "expected '{part}' in: {said}");
    }
}

#[test]
fn what_is_wrong_in_a_file_is_said_with_its_line() {
    refused("", 1, &["kind = \"drive\" or kind = \"process\""]);
    refused("kind = \"rocket\"", 1, &["\"drive\" or \"process\""]);
    refused(
        "kind = \"drive\"\nparametres = 1\n",
        2,
        &["'parametres'", "parameters"],
    );
    refused(
        "kind = \"drive\"\n[parameters]\nT = 3\n",
        3,
        &["'T'", "J1 or d1"],
    );
    refused(
        "kind = \"drive\"\n[parameters]\nJ1 = \"heavy\"\n",
        3,
        &["J1", "number"],
    );
    refused(
        "kind = \"drive\"\n[parameters]\n\nJ1 = inf\n",
        4,
        &["finite"],
    );
    refused(
        "kind = \"drive\"\nparameters.J1 = -1\n",
        2,
        &["J1 = -1", "above 0"],
    );
    refused(
        "kind = \"drive\"\n\n[parameters]\nd1 = 1\nJ1 = -4e-3\n",
        5,
        &["J1 = -0.004", "above 0"],
    );
    refused(
        "kind = \"drive\"\n[[effects]]\nid=\"cogging\"\n[effects.parameters]\nn = 2\na = { value = -1 }\n",
        6,
        &["a = -1", "at least 0"],
    );
    refused(
        "kind = \"drive\"\nparameters.J1 = {}\n",
        2,
        &["J1 needs a value"],
    );
    refused(
        "kind = \"drive\"\nparameters.d1 = {value=1,tolerance=0}\n",
        2,
        &["above 0", "fixed"],
    );
    refused(
        "kind = \"drive\"\nparameters.d1 = {value=1,status=\"prior\"}\n",
        2,
        &["tolerance"],
    );
    refused(
        "kind = \"drive\"\nparameters.d1 = {value=1,status=\"maybe\"}\n",
        2,
        &["\"free\""],
    );
    refused(
        "kind = \"drive\"\n[[effects]]\nid = \"friction\"\n",
        3,
        &["'friction'", "coulomb_friction"],
    );
    refused(
        "kind = \"drive\"\n[[effects]]\nid = \"second_lag\"\n",
        3,
        &["'second_lag'"],
    );
    refused(
        "kind = \"drive\"\n[[effects]]\nid = \"viscous_friction\"\n",
        3,
        &["d1"],
    );
    refused("kind = \"drive\"\n[[effects]]\n", 2, &["needs an id"]);
    refused(
        "kind = \"drive\"\n[[effects]]\nid=\"cogging\"\nparameters.b = 1\n",
        4,
        &["'b'", "a, n or phi"],
    );
    refused(
        "kind = \"drive\"\n[[effects]]\nid=\"cogging\"\nparameters.a = -1\n",
        4,
        &["a = -1", "at least 0"],
    );
    refused(
        "kind = \"drive\"\n[[effects]]\nid=\"cogging\"\n[[effects]]\nid=\"cogging\"\n",
        4,
        &["twice"],
    );
    let own = "kind = \"drive\"\n[[candidates]]\nid = \"bump\"\n";
    refused(own, 2, &["id and a formula"]);
    refused(
        &format!("{own}formula = \"a*(x\"\n"),
        4,
        &["formula, column 5", "')'"],
    );
    refused(
        &format!("{own}formula = \"a*x\"\nparameters.b = 1\n"),
        5,
        &["'b'", "expected a"],
    );
    let taken = own.replace("bump", "cogging") + "formula = \"a*x\"\n";
    refused(&taken, 3, &["not a name from the library"]);
    refused("kind = \"drive\"\neffects = 3\n", 2, &["[[effects]]"]);
    refused("kind = \"drive\"\nkind = \"drive\"\n", 2, &[]);
    refused("kind = [[[[[[[[\n", 1, &[]);
    refused(&"#".repeat(MAX_BYTES + 1), 1, &["longer"]);
    refused(&format!("kind = {}", "[".repeat(50_000)), 1, &[]);
    let many = "[[effects]]\nid=\"cogging\"\n".repeat(1000);
    refused(&format!("kind = \"drive\"\n{many}"), 2, &["too many"]);
}

#[test]
fn a_number_alone_is_fixed_and_a_tolerance_makes_a_prior() {
    let model = UserModel::from_toml(
        "kind = \"drive\"\n[parameters]\nJ1 = 1\nd1 = { value = 2, tolerance = 0.5 }",
    )
    .unwrap();
    let status = |symbol: &str| {
        let p = model.parameters.iter().find(|p| p.symbol == symbol);
        p.unwrap().status
    };
    assert_eq!(
        (status("J1"), status("d1")),
        (Status::Fixed, Status::Prior(0.5))
    );
}

proptest! {
    #[test]
    fn no_text_is_a_panic(text in "\\PC{0,200}") {
        let _ = UserModel::from_toml(&text);
    }

    #[test]
    fn nothing_made_of_our_own_words_is_a_panic(
        words in prop::collection::vec(
            prop::sample::select(vec![
                "kind", "=", "\"drive\"", "[parameters]", "J1", "{", "}", "value", "1e400", "nan", ",", "\n",
                "[[effects]]", "id", "\"backlash\"", "tolerance", "status", "\"prior\"", "-0", "0x10", "'", ".", "[",
            ]),
            0..40,
        )
    ) {
        let _ = UserModel::from_toml(&words.concat());
    }
}
