//! What is said of a machine with an effect that the library does not have: each case of the blind bench with its
//! effect taken out. To name another one as missing is a false name.
//!
//! ```text
//! HYSTERON_BENCH_SEEDS=1 cargo test --release -p hysteron-core --test core taken_out -- --ignored --nocapture
//! ```
//!
//! runs every case of the seeds and prints what was named.

#![allow(
    clippy::disallowed_macros,
    reason = "the core neither prints nor starts threads; its bench does"
)]

use crate::support::case::{Case, Hidden, Truth};
use crate::support::diagnosis::{classes, finish};
use crate::support::{drive_cases, process_cases, threads};
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::effect::{EffectId, is_of_record, library};

/// Share of the records on which another effect may be named.
const FALSE_NAMES: f64 = 0.05;

/// Cases with effects of the machine, the first of which is taken out.
fn cases() -> Vec<(Case, Vec<Truth>)> {
    let seeds = std::env::var("HYSTERON_BENCH_SEEDS").unwrap_or_else(|_| "1".to_owned());
    let seeds = seeds.split(',').filter_map(|s| s.trim().parse().ok());
    let all = seeds.flat_map(|seed: u64| {
        let drives = drive_cases::drive_cases(seed);
        drives.into_iter().chain(process_cases::process_cases(seed))
    });
    let known = all.filter_map(|case| match &case.hidden {
        Hidden::Known { truths, .. } if !truths.is_empty() => {
            let truths = truths.clone();
            Some((case, truths))
        }
        _ => None,
    });
    known.collect()
}

/// Whether an effect is a part of another one, or has it as one.
fn is_kin(a: &str, b: &str) -> bool {
    let find = |id: &str| library().find(|e| e.id().as_str() == id);
    let (Some(a), Some(b)) = (find(a), find(b)) else {
        return false;
    };
    a.contains().contains(&b.id()) || b.contains().contains(&a.id())
}

/// What is said without the first effect: the classes that name nothing of what acts, and all.
fn false_names(case: &Case, truths: &[Truth]) -> (Vec<String>, String) {
    let record = case.measure();
    let taken_out = EffectId::parse(truths[0].effect).expect("an effect of the library");
    let job = DiagnosisJob::new(&record).unwrap().lacking(&[taken_out]);
    let diagnosis = finish(job);
    let others = match &case.hidden {
        Hidden::Known { or, .. } => or.concat(),
        Hidden::Unknown => Vec::new(),
    };
    let acting = truths
        .iter()
        .flat_map(|t| [&[t.effect], t.same, t.alike].concat());
    let acting: Vec<&str> = acting.chain(others).collect();
    let is_true = |id: &str| {
        let own = truths.iter().any(|t| is_kin(t.effect, id));
        own || acting.contains(&id)
    };
    let found = classes(&diagnosis);
    let named = found.iter().map(|class| class.join("|"));
    let all: Vec<String> = named.clone().collect();
    let wrong = named
        .zip(&found)
        .filter(|(_, class)| !class.iter().any(|id| is_true(id)));
    let of_machine = wrong.filter(|(_, class)| {
        !class
            .iter()
            .all(|id| EffectId::parse(id).is_some_and(is_of_record))
    });
    (of_machine.map(|(name, _)| name).collect(), all.join(" + "))
}

#[test]
#[ignore = "runs for minutes, and does not hold yet: docs/criticism.md has the figure"]
fn what_is_not_in_the_library_is_not_called_by_another_name() {
    let cases = cases();
    let outcomes = threads::each(&cases, |(case, truths)| {
        let (wrong, all) = false_names(case, truths);
        println!(
            "{:32} without {:24} {all}{}",
            case.name,
            truths[0].effect,
            if wrong.is_empty() { "" } else { "   FALSE" }
        );
        !wrong.is_empty()
    });
    let wrong = outcomes.iter().filter(|wrong| **wrong).count();
    println!("false names: {wrong} of {}", cases.len());
    assert!(
        wrong as f64 <= FALSE_NAMES * cases.len() as f64,
        "{wrong} of {}",
        cases.len()
    );
}
