//! Judging a diagnosis by the truth, and the table of all.

use std::fmt::Write as _;
use std::time::Instant;

use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::{Diagnosis, Step};
use hysteron_core::effect::{EffectId, is_of_record};
use hysteron_core::measurement::Measurement;
use serde::Serialize;

use super::case::{Case, Hidden, Truth};
use super::diagnosis::{classes, finish};
use super::threads;

/// A final error within this factor of the noise floor counts as reaching it.
pub const NEAR_FLOOR: f64 = 1.2;
/// A parameter this close is right whatever its interval.
pub const CLOSE: f64 = 0.05;
/// Half width of a 95 % interval in standard errors.
const INTERVAL: f64 = 1.96;

/// A fitted parameter beside the truth.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    pub name: String,
    pub truth: f64,
    pub value: f64,
    pub std_error: f64,
    pub close: bool,
    pub covered: bool,
}

/// One case, judged.
#[derive(Clone, Debug, Serialize)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "independent yes-or-no columns of a table"
)]
pub struct Outcome {
    pub seed: u64,
    pub case: &'static str,
    pub truth: String,
    pub found: String,
    pub complete: bool,
    pub unknown: bool,
    /// Fully right: the classes, and whether anything is left.
    pub right: bool,
    /// Whether the case has a noise floor that the library can reach.
    pub known: bool,
    /// Error of the baseline and of the last model over the noise floor.
    pub error_before: f64,
    pub error: f64,
    pub effects: Vec<Compared>,
    pub baseline: Vec<Compared>,
    pub seconds: f64,
}

/// Diagnoses one measurement.
pub fn diagnose(measurement: &Measurement) -> Result<Diagnosis, String> {
    let job = DiagnosisJob::new(measurement).map_err(|e| e.to_string())?;
    Ok(finish(job))
}

/// Runs the cases on all processors; the order of the outcomes is that of the cases.
pub fn run(cases: &[(u64, Case)]) -> Vec<Outcome> {
    threads::each(cases, |(seed, case)| {
        let measurement = case.measure();
        let start = Instant::now();
        let diagnosis = diagnose(&measurement);
        let seconds = start.elapsed().as_secs_f64();
        let outcome = judge(*seed, case, diagnosis, seconds);
        println!("{}", row(&outcome));
        outcome
    })
}

fn judge(seed: u64, case: &Case, diagnosis: Result<Diagnosis, String>, seconds: f64) -> Outcome {
    let known = matches!(case.hidden, Hidden::Known { .. });
    let mut outcome = Outcome {
        seed,
        case: case.name,
        truth: case.truth(),
        found: String::new(),
        complete: false,
        unknown: false,
        right: false,
        known,
        error_before: f64::NAN,
        error: f64::NAN,
        effects: vec![],
        baseline: vec![],
        seconds,
    };
    let diagnosis = match diagnosis {
        Ok(diagnosis) => diagnosis,
        Err(error) => {
            outcome.found = error;
            return outcome;
        }
    };
    let (verdict, floor) = (&diagnosis.verdict, diagnosis.noise_floor);
    let found = classes(&diagnosis);
    outcome.found = words(&found);
    (outcome.complete, outcome.unknown) = (verdict.complete, verdict.unknown);
    outcome.error_before = diagnosis
        .steps
        .first()
        .map_or(f64::NAN, |s| s.error / floor);
    outcome.error = diagnosis.steps.last().map_or(f64::NAN, |s| s.error / floor);
    match &case.hidden {
        Hidden::Unknown => outcome.right = verdict.unknown && !verdict.complete,
        Hidden::Known { truths, or } => {
            // What tells how the record was made is in the model, but not missing from the machine.
            let of_record = |t: &&Truth| is_of_record(EffectId::new(t.effect));
            let (of_record, missing): (Vec<&Truth>, Vec<&Truth>) =
                truths.iter().partition(of_record);
            let told = of_record.iter().all(|t| {
                let last = diagnosis.steps.last();
                last.is_some_and(|s| s.effects.iter().any(|e| e.as_str() == t.effect))
            });
            let reads = is_truth(&missing, &found) || or.iter().any(|r| is_reading(r, or, &found));
            outcome.right = told && reads && verdict.complete && !verdict.unknown;
            if let Some(last) = diagnosis.steps.last().filter(|_| outcome.right) {
                outcome.effects = truths.iter().filter_map(|t| compare(t, last)).collect();
                // Where asymmetry is exchangeable with a load, inertia goes with it.
                if truths
                    .iter()
                    .all(|t| t.same.is_empty() && t.alike.is_empty())
                    && or.is_empty()
                {
                    outcome.baseline = baseline(case, last);
                }
            }
        }
    }
    outcome
}

/// `coulomb_friction + actuator_lag|sensor_lag`.
fn words(classes: &[Vec<&str>]) -> String {
    if classes.is_empty() {
        return "nothing".to_owned();
    }
    let classes: Vec<String> = classes.iter().map(|c| c.join("|")).collect();
    classes.join(" + ")
}

/// Whether each truth stands in exactly one class, all classes are used, and no class holds what it
/// must not or lacks what is exactly the same.
fn is_truth(truths: &[&Truth], classes: &[Vec<&str>]) -> bool {
    let Some((first, rest)) = truths.split_first() else {
        return classes.is_empty();
    };
    let fits = |class: &Vec<&str>| {
        let allowed =
            |id: &str| id == first.effect || first.same.contains(&id) || first.alike.contains(&id);
        class.contains(&first.effect)
            && first.same.iter().all(|id| class.contains(id))
            && class.iter().all(|id| allowed(id))
    };
    (0..classes.len()).any(|i| {
        let mut others = classes.to_vec();
        fits(&others.remove(i)) && is_truth(rest, &others)
    })
}

/// The same for a list of ids, where a class may hold any that stand in some fair reading.
fn is_reading(reading: &[&'static str], fair: &[Vec<&'static str>], classes: &[Vec<&str>]) -> bool {
    let anything: Vec<&'static str> = fair.concat();
    let Some((first, rest)) = reading.split_first() else {
        return classes.is_empty();
    };
    (0..classes.len()).any(|i| {
        let mut others = classes.to_vec();
        let class = others.remove(i);
        class.contains(first)
            && class.iter().all(|id| anything.contains(id))
            && is_reading(rest, fair, &others)
    })
}

fn compare(truth: &Truth, last: &Step) -> Option<Compared> {
    let (symbols, value) = truth.value?;
    let mut own = last
        .parameters
        .iter()
        .filter(|p| p.effect.is_some_and(|e| e.as_str() == truth.effect));
    let named = own.clone().find(|p| symbols.contains(&p.name.as_str()));
    let parameter = named.or_else(|| own.next())?;
    // A half turn of the phase of cogging changes the sign of its amplitude.
    let fitted = if truth.effect == "cogging" {
        parameter.value.abs()
    } else {
        parameter.value
    };
    Some(beside(&parameter.name, value, fitted, parameter.std_error))
}

fn baseline(case: &Case, last: &Step) -> Vec<Compared> {
    let find = |(name, truth): (&str, f64)| {
        let p = last.parameters.iter().find(|p| p.name == name)?;
        Some(beside(name, truth, p.value, p.std_error))
    };
    case.baseline().into_iter().filter_map(find).collect()
}

fn beside(name: &str, truth: f64, value: f64, std_error: f64) -> Compared {
    Compared {
        name: name.to_owned(),
        truth,
        value,
        std_error,
        close: (value / truth - 1.0).abs() <= CLOSE,
        covered: (value - truth).abs() <= INTERVAL * std_error,
    }
}

/// One line of the table.
fn row(o: &Outcome) -> String {
    let mut line = format!(
        "{:5} {:6} {:34} | {:36} | {:48} | {:7.2} -> {:6.3} | {:5.1} s |",
        o.seed,
        if o.right { "right" } else { "WRONG" },
        o.case,
        o.truth,
        format!(
            "{}{}",
            o.found,
            match (o.complete, o.unknown) {
                (true, false) => "",
                (_, true) => " (unknown left)",
                (false, false) => " (not complete)",
            }
        ),
        o.error_before,
        o.error,
        o.seconds
    );
    for c in &o.effects {
        let mark = match (c.close, c.covered) {
            (true, true) => "",
            (true, false) => " not covered",
            (false, true) => " covered",
            (false, false) => " OFF",
        };
        let _ = write!(
            line,
            " {} {:.4e} ± {:.1e} ({:.4e}){mark}",
            c.name, c.value, c.std_error, c.truth
        );
    }
    line
}

/// Shares over many cases.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Totals {
    pub cases: usize,
    pub right: usize,
    pub known: usize,
    /// Of the known ones, those that end near the noise floor.
    pub near_floor: usize,
    /// Main parameters of the effects found.
    pub parameters: usize,
    pub close: usize,
    pub covered: usize,
    pub close_or_covered: usize,
    /// The same for inertia and friction, gain and time constant.
    pub baseline_parameters: usize,
    pub baseline_close_or_covered: usize,
    pub seconds: f64,
}

impl Totals {
    pub fn of(outcomes: &[Outcome]) -> Self {
        let mut t = Self::default();
        for o in outcomes {
            t.cases += 1;
            t.right += usize::from(o.right);
            t.known += usize::from(o.known);
            t.near_floor += usize::from(o.known && o.error <= NEAR_FLOOR);
            t.seconds += o.seconds;
            for c in &o.effects {
                t.parameters += 1;
                t.close += usize::from(c.close);
                t.covered += usize::from(c.covered);
                t.close_or_covered += usize::from(c.close || c.covered);
            }
            for c in &o.baseline {
                t.baseline_parameters += 1;
                t.baseline_close_or_covered += usize::from(c.close || c.covered);
            }
        }
        t
    }

    /// The totals in words.
    pub fn text(&self) -> String {
        let share = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
        format!(
            "{} of {} fully right ({:.1} %); {} of {} known ones within {NEAR_FLOOR} of the noise floor ({:.1} %); \
             {} parameters: {:.1} % within 5 %, {:.1} % in their 95 % interval, {:.1} % either; \
             baseline parameters {:.1} % either; {:.2} s a case",
            self.right,
            self.cases,
            share(self.right, self.cases),
            self.near_floor,
            self.known,
            share(self.near_floor, self.known),
            self.parameters,
            share(self.close, self.parameters),
            share(self.covered, self.parameters),
            share(self.close_or_covered, self.parameters),
            share(self.baseline_close_or_covered, self.baseline_parameters),
            self.seconds / self.cases.max(1) as f64
        )
    }
}

/// The table, the wrong ones once more, and the totals.
pub fn report(title: &str, outcomes: &[Outcome]) -> String {
    let mut text = format!("\n== {title} ==\n");
    for o in outcomes {
        let _ = writeln!(text, "{}", row(o));
    }
    let wrong: Vec<&Outcome> = outcomes.iter().filter(|o| !o.right).collect();
    if !wrong.is_empty() {
        let _ = writeln!(text, "-- wrong --");
    }
    for o in wrong {
        let _ = writeln!(text, "{}", row(o));
    }
    let _ = writeln!(text, "{title}: {}", Totals::of(outcomes).text());
    text
}
