//! Forces that nobody told the search: it finds their formula, or one that is as good, and says none where there is
//! none.

#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_macros,
    reason = "the core neither prints nor starts threads nor reads the clock; its bench does"
)]

use crate::support::hidden_force::{Hidden, Truth};
use hysteron_core::criticism::DiscoveryJob;
use hysteron_core::diagnosis::{Discovery, DiscoveryEnd, FoundFormula};
use hysteron_core::effect::{EffectId, Formula};
use hysteron_core::measurement::{Kind, Measurement};
use hysteron_core::model::Instant;
use hysteron_core::progress::Progress;
use hysteron_core::rig::{DriveRig, Excitation, Stranger};
use hysteron_core::user_model::UserModel;
use std::collections::BTreeMap;

/// Share of the force by which a formula may be off on the record to be the same.
const SAME: f64 = 0.02;

/// Seeds of the small part of the bench.
const SMALL: [u64; 2] = [2, 3];

fn search(record: &Measurement, effects: &[EffectId]) -> Discovery {
    let mut job = DiscoveryJob::new(record, effects, &UserModel::blank(record.kind)).unwrap();
    loop {
        if let Progress::Done(discovery) = job.advance() {
            return discovery;
        }
    }
}

/// Root mean square of the acceleration that a formula with its body has wrong along the record, over that of the
/// hidden force.
fn off(found: &FoundFormula, hidden: &Hidden, truth: &Truth) -> f64 {
    let formula = Formula {
        name: found.name.clone(),
        text: found.formula.clone(),
    };
    let value = |symbol: &str| {
        let mut all = found.parameters.iter().chain(&found.body);
        all.find(|p| p.name == symbol).unwrap().value
    };
    let symbols = formula.parameters(Kind::Drive).unwrap();
    let values: Vec<f64> = symbols.iter().map(|s| value(s)).collect();
    let force = formula.force(Kind::Drive).unwrap();
    let (inertia, viscous) = (value("J1"), value("d1"));
    let (mut wrong, mut all) = (0.0, 0.0);
    for (at, acts) in truth.at.iter().zip(&truth.force) {
        let instant = Instant {
            position: at.x,
            velocity: at.v,
            input: at.u,
            time: at.t,
        };
        let said = (at.u - viscous * at.v + force(&instant, &values)) / inertia;
        let was = (at.u - hidden.viscous * at.v + acts) / hidden.inertia;
        wrong += (hidden.inertia * (said - was)).powi(2);
        all += acts * acts;
    }
    (wrong / all).sqrt()
}

/// How far the answer is off; none where there is none.
fn found(seed: u64) -> (Hidden, Discovery, Option<f64>) {
    let hidden = Hidden::drawn(seed);
    let (record, truth) = hidden.measure();
    let discovery = search(&record, &[]);
    let off = discovery.found().map(|f| off(f, &hidden, &truth));
    (hidden, discovery, off)
}

#[test]
fn hidden_forces_are_found() {
    // Moves of a servo and a torque that wanders, of one term and of two.
    for seed in SMALL {
        let (hidden, discovery, off) = found(seed);
        assert_eq!(discovery.end, DiscoveryEnd::Explained, "{}", discovery.text);
        assert!(
            off.is_some_and(|off| off < SAME),
            "{}: {}, off by {off:?}",
            hidden.text(),
            discovery.text
        );
        let answer = discovery.found().unwrap();
        assert!(answer.in_class && answer.on_front, "{answer:?}");
        for p in &answer.parameters {
            assert!(p.is_told() && p.unit != "?", "{p:?}");
        }
        // It is an effect of the user's own, as it stands.
        let mut model = UserModel::blank(Kind::Drive);
        model.add_candidate(&answer.typed).unwrap();
        assert_eq!(
            model.formula(model.candidates[0].id),
            Some(answer.formula.as_str())
        );
    }
}

#[test]
fn where_nothing_is_missing_there_is_no_formula() {
    let clean = DriveRig {
        excitation: Excitation::Multisine { amplitude: 0.08 },
        ..DriveRig::default()
    };
    let discovery = search(&clean.measure(), &[]);
    assert_eq!(
        discovery.end,
        DiscoveryEnd::NothingLeft,
        "{}",
        discovery.text
    );
    assert_eq!(discovery.formulas, []);
}

#[test]
fn what_remembers_has_no_formula() {
    // A torque that follows the command along a loop: no function of the moment.
    let rig = DriveRig {
        samples: 5000,
        excitation: Excitation::Multisine { amplitude: 0.08 },
        stranger: Some(Stranger::Hysteresis {
            share: 0.6,
            width: 0.1,
        }),
        ..DriveRig::default()
    };
    let discovery = search(&rig.measure(), &[]);
    assert_ne!(discovery.end, DiscoveryEnd::Explained, "{}", discovery.text);
    assert_ne!(
        discovery.end,
        DiscoveryEnd::NothingLeft,
        "{}",
        discovery.text
    );
}

#[test]
fn what_was_found_stays_in_the_model() {
    // Drag, and a place that pushes back.
    let rig = DriveRig {
        excitation: Excitation::Multisine { amplitude: 0.08 },
        quadratic_drag: 1e-4,
        stranger: Some(Stranger::PositionBump {
            torque: 0.06,
            at: 0.5,
            width: 0.1,
        }),
        ..DriveRig::default()
    };
    let discovery = search(&rig.measure(), &[EffectId::new("quadratic_drag")]);
    let answer = discovery.found().map(|f| f.formula.as_str());
    assert_eq!(answer, Some("-a*exp(-((x-c)/w)^2)"), "{}", discovery.text);
    assert_eq!(discovery.end, DiscoveryEnd::Explained);
}

/// `HYSTERON_HIDDEN_SEEDS=FROM,TO cargo test --release --test core hidden_forces_by_kind -- --ignored --nocapture`
#[test]
#[ignore = "a bench of many minutes"]
fn hidden_forces_by_kind() {
    let seeds = std::env::var("HYSTERON_HIDDEN_SEEDS").unwrap_or_else(|_| "1,50".to_owned());
    let (from, to) = seeds.split_once(',').unwrap();
    let (from, to): (u64, u64) = (from.parse().unwrap(), to.parse().unwrap());
    // Of each kind of term: how many were found, and of how many.
    let mut table: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    let (mut right, mut claimed) = (0, 0);
    for seed in from..=to {
        let (hidden, discovery, off) = found(seed);
        let is_right = off.is_some_and(|off| off < SAME);
        right += usize::from(is_right);
        claimed += usize::from(off.is_some());
        for term in &hidden.terms {
            let row = table.entry(term.kind).or_default();
            row[0] += usize::from(is_right);
            row[1] += 1;
        }
        println!(
            "{} {seed} {:?} {}: {:?}, {:?}, off by {off:.3?}",
            if is_right { "right" } else { "WRONG" },
            hidden.drive,
            hidden.text(),
            discovery.end,
            discovery.found().map(|f| &f.formula)
        );
    }
    for (kind, [right, all]) in &table {
        println!("| {kind} | {right} of {all} |");
    }
    let all = (to + 1 - from) as usize;
    println!("{right} of {all} right; {} named none", all - claimed);
    assert!(10 * right >= 8 * all, "{right} of {all}");
}
