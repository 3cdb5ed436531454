//! An effect that the user writes as a formula behaves like any other.

use std::f64::consts::TAU;

use crate::support::diagnosis::{classes, finish, step};
use crate::support::servo::servo;
use hysteron_core::criticism::{DiagnosisJob, StepJob};
use hysteron_core::diagnosis::Diagnosis;
use hysteron_core::effect::{EffectId, Formula, registry};
use hysteron_core::measurement::{Kind, Measurement, import_csv};
use hysteron_core::rig::{DriveRig, Excitation, Friction, Stranger};
use hysteron_core::user_model::UserModel;
use proptest::prelude::*;

fn diagnose(measurement: &Measurement, model: &UserModel) -> Diagnosis {
    finish(DiagnosisJob::with_model(measurement, model).unwrap())
}

fn with_candidate(text: &str) -> UserModel {
    let mut model = UserModel::blank(Kind::Drive);
    model.add_candidate(text).unwrap();
    model
}

#[test]
fn a_bump_at_one_position_is_unknown_until_its_formula_is_there() {
    let (torque, at, width) = (0.06, 0.5, 0.1);
    let rig = DriveRig {
        excitation: Excitation::Multisine { amplitude: 0.08 },
        stranger: Some(Stranger::PositionBump { torque, at, width }),
        ..DriveRig::default()
    };
    let measurement = rig.measure();
    let before = diagnose(&measurement, &UserModel::blank(Kind::Drive));
    assert!(before.verdict.unknown, "{}", before.verdict.text);

    let model = with_candidate("bump: -a*exp(-((x-b)/c)^2)");
    let after = diagnose(&measurement, &model);
    assert!(after.verdict.complete, "{}", after.verdict.text);
    let bump = EffectId::own("bump").unwrap();
    assert_eq!(after.verdict.missing, [[bump]], "{}", after.verdict.text);
    let last = after.steps.last().unwrap();
    assert!(last.error < 1.2, "{}", last.error);
    for (symbol, truth, unit) in [("a", torque, "N m"), ("b", at, "rad"), ("c", width, "rad")] {
        let own = last.parameters.iter().filter(|p| p.effect == Some(bump));
        let p = own.clone().find(|p| p.name == symbol).unwrap();
        assert_eq!(p.unit, unit);
        // The width may come out negative: it is squared.
        assert!((p.value.abs() / truth - 1.0).abs() < 0.02, "{p:?}");
        assert!((p.value.abs() - truth).abs() < 4.0 * p.std_error, "{p:?}");
        assert!(p.std_error < 0.01 * truth, "{p:?}");
    }

    // Saved with its formula, it is part of the model.
    let saved = UserModel::from_step(Kind::Drive, last, Some(&model)).to_toml();
    let read = UserModel::from_toml(&saved).unwrap();
    assert_eq!(read.present(), [bump]);
    let again = diagnose(&measurement, &read);
    assert!(
        again.verdict.complete && again.verdict.missing.is_empty(),
        "{saved}"
    );
}

#[test]
fn a_formula_of_what_the_library_has_is_found_like_it() {
    // Quadratic drag under its own name, on a rig that has it.
    let rig = DriveRig {
        excitation: Excitation::Multisine { amplitude: 0.08 },
        quadratic_drag: 1e-4,
        ..DriveRig::default()
    };
    let d = diagnose(&rig.measure(), &with_candidate("own_drag: -q*v*abs(v)"));
    let names = classes(&d);
    assert_eq!(
        names,
        [["quadratic_drag", "own_drag"]],
        "{}",
        d.verdict.text
    );
    assert!(d.verdict.complete);
}

#[test]
fn a_formula_that_jumps_where_the_body_turns_is_dry_friction() {
    // A position loop that rests between its moves, with an encoder that does not see the bristles of the rig.
    let friction = 0.02;
    let rig = DriveRig {
        excitation: servo(2.0, 1.2, 16.0),
        sampling: 2e-3,
        samples: 8000,
        friction: Friction::dry(friction),
        encoder: TAU / 20_000.0,
        velocity_noise: 0.02,
        ..DriveRig::default()
    };
    let text = "kind = \"drive\"\n[[effects]]\nid = \"dry\"\nformula = \"-c*sign(v)\"\n";
    let d = diagnose(&rig.measure(), &UserModel::from_toml(text).unwrap());
    let first = &d.steps[0];
    assert!(first.error < 1.2, "{}", first.error);
    for (symbol, truth) in [("c", friction), ("J1", rig.inertia), ("d1", rig.viscous)] {
        let p = first.parameters.iter().find(|p| p.name == symbol).unwrap();
        assert!((p.value / truth - 1.0).abs() < 0.05, "{p:?}");
    }
}

/// Viscous friction once more, and a bend of it: the body may rub less by as much.
#[test]
fn a_formula_of_what_the_model_has_is_needless() {
    let csv = include_bytes!("../data/drive-02.csv");
    let measurement = import_csv("drive-02", csv, None).unwrap();
    let effects = [
        EffectId::new("coulomb_friction"),
        EffectId::own("again").unwrap(),
    ];
    let model = with_candidate("again: -p*v-q*v^3");
    let report = step(StepJob::with_model(&measurement, &effects, &model).unwrap());
    assert_eq!(report.needless, effects[1..], "{:?}", report.verdict);
}

/// The formula is refused at this column with a sentence that has these parts.
#[track_caller]
fn refused(text: &str, column: usize, parts: &[&str]) {
    let formula = Formula {
        name: "own".to_owned(),
        text: text.to_owned(),
    };
    let error = formula.check(Kind::Drive).unwrap_err();
    let said = error.to_string();
    assert_eq!(error.column, column, "{said}");
    for part in parts {
        assert!(said.contains(part), "expected '{part}' in: {said}");
    }
}

#[test]
fn what_is_wrong_in_a_formula_is_said_with_its_column() {
    refused("", 1, &["empty", "exp("]);
    refused("3*x", 1, &["no parameter"]);
    refused("-a*exp(-x", 10, &["')' is missing"]);
    refused("-a*x)", 5, &["closes nothing"]);
    refused("a x", 3, &["write *"]);
    refused("2a", 2, &["write *"]);
    refused("a(x-1)", 1, &["'a' is not a function", "sin", "*"]);
    refused("a*sin", 3, &["write sin(...)"]);
    refused("a*min(x)", 3, &["2 argument"]);
    refused("a*e^x", 3, &["exp(...)"]);
    refused("a*y", 3, &["no y", "x, v, u and t"]);
    refused("a*0,5", 4, &["point"]);
    refused("a**2", 3, &["^"]);
    refused("a*", 3, &["too early"]);
    refused("a+$", 3, &["'$'"]);
    refused("a*1.2.3", 3, &["'1.2.3'"]);
    refused("p1*p2*p3*p4*p5*p6*p7*p8*p9", 25, &["at most 8"]);
    refused(&"(".repeat(200), 31, &["deeply"]);
    refused(&"a".repeat(301), 301, &["too long"]);
    let process = Formula {
        name: "own".to_owned(),
        text: "a*x".to_owned(),
    };
    let said = process.check(Kind::Process).unwrap_err().to_string();
    assert!(said.contains("y, u and t"), "{said}");
}

#[test]
fn what_is_wrong_with_a_candidate_is_said() {
    let said = |text: &str| {
        UserModel::blank(Kind::Drive)
            .add_candidate(text)
            .unwrap_err()
    };
    assert!(said("a*x").to_string().contains("name: formula"));
    // A name of the library is no reason to refuse a formula that had it first.
    let mut model = UserModel::blank(Kind::Drive);
    model.add_candidate("cogging: a*x").unwrap();
    assert_eq!(model.candidates[0].id.as_str(), "own_cogging");
    assert!(
        said("Bump!: a*x")
            .to_string()
            .contains("lower-case letters")
    );
    assert!(said("bump: a*(x").to_string().contains("column 5"));
    assert!(said("bump: a*x; k = 3").to_string().contains("a = 0.05"));
    let twice = said("bump: a*x + b; a = 0.8; b = 0.3");
    assert!(
        twice.to_string().contains("'a = 0.8; b = 0.3'") && twice.to_string().contains("comma"),
        "{twice}"
    );
    for effect in registry() {
        assert_eq!(EffectId::own(effect.id().as_str()), None);
    }
}

#[test]
fn units_follow_from_the_formula() {
    let units = |text: &str| -> Vec<String> {
        let model = with_candidate(&format!("own: {text}"));
        let rig = DriveRig {
            samples: 600,
            ..DriveRig::default()
        };
        // A wrong unit in the file is refused by naming the right one.
        let mut wrong = model.clone();
        let symbols = Formula {
            name: "own".to_owned(),
            text: text.to_owned(),
        }
        .parameters(Kind::Drive)
        .unwrap();
        let measurement = rig.measure();
        symbols
            .iter()
            .map(|symbol| {
                wrong.candidates[0].parameters = vec![hysteron_core::user_model::Known {
                    symbol: symbol.clone(),
                    value: 1.0,
                    status: hysteron_core::user_model::Status::Free,
                    std_error: None,
                    unit: Some("wrong".to_owned()),
                }];
                let mut effects = wrong.clone();
                effects.effects = std::mem::take(&mut effects.candidates);
                let error = DiagnosisJob::with_model(&measurement, &effects)
                    .err()
                    .unwrap();
                error
                    .to_string()
                    .rsplit_once("it is in ")
                    .unwrap()
                    .1
                    .to_owned()
            })
            .collect()
    };
    assert_eq!(units("-a*exp(-((x-b)/c)^2)"), ["N m", "rad", "rad"]);
    assert_eq!(units("-d*v*abs(v)"), ["N m s^2/rad^2"]);
    assert_eq!(units("a*sin(n*x+p)"), ["N m", "1/rad", "1"]);
    assert_eq!(units("-q*v^3"), ["N m s^3/rad^3"]);
    assert_eq!(units("u*k*t"), ["1/s"]);
    assert_eq!(units("-a*tanh(v/0.1)"), ["N m"]);
    assert_eq!(units("a*b*x"), ["?", "?"], "only their product is known");
}

proptest! {
    #[test]
    fn no_formula_is_a_panic(text in "[-+*/^(),.a-d0-9xvut esinpqrlog]{0,60}") {
        let formula = Formula { name: "own".to_owned(), text };
        let _ = formula.effect(Kind::Drive);
        let _ = formula.check(Kind::Process);
    }
}
