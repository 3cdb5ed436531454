//! `hysteron limit-cycle SCENARIO.toml`

use std::fmt::Write as _;
use std::path::PathBuf;

use hysteron_core::limit_cycle::{Cycle, ExactCycle, LongRunResult, Prediction, Trust, predict};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::scenario::{AnyScenario, Scenario};
use hysteron_core::tuning::{RelayGain, StabilityLimits, relay_gain, stability_limits};
use hysteron_work::language::say;
use serde_json::json;

use crate::cycle_table::CycleTable;
use crate::limit_cycle_drive::DriveReport;
use crate::limit_cycle_on_off::OnOffReport;
use crate::limit_cycle_servo::ServoReport;
use crate::output::{Format, say_lines};
use crate::simulate;

/// Version of the JSON object.
const SCHEMA: u32 = 1;

/// Unstable cycles of a kind that are listed one by one; a dead time has infinitely many.
const LISTED: usize = 3;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Loop, drive or servo to predict: tables [plant] or [drive], and [relay]; or [servo]
    #[arg(value_name = "SCENARIO.toml")]
    file: PathBuf,
    /// For a person or for a program
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

struct Report {
    prediction: Prediction,
    long_run: LongRunResult,
    trust: Trust,
    /// Of the cycle in the end, or else of the first exact one.
    ultimate: Option<RelayGain>,
    limits: StabilityLimits,
}

/// The report, or one line that says what is wrong with the input.
pub fn run(arguments: &Arguments) -> Result<String, Message> {
    let located = |e: Message| {
        msg!(
            "{}: {}",
            Message::name(arguments.file.display().to_string()),
            e
        )
    };
    Ok(match simulate::read(&arguments.file)? {
        AnyScenario::Loop(scenario) => {
            let report = report(&scenario).map_err(located)?;
            match arguments.format {
                Format::Text => text(&report),
                Format::Json => format!("{:#}\n", json(&report)),
            }
        }
        AnyScenario::OnOff(scenario) => {
            let report = OnOffReport::new(&scenario).map_err(located)?;
            match arguments.format {
                Format::Text => report.text(),
                Format::Json => format!("{:#}\n", report.json()),
            }
        }
        AnyScenario::Servo(scenario) => {
            let report = ServoReport::new(&scenario).map_err(located)?;
            match arguments.format {
                Format::Text => report.text(),
                Format::Json => format!("{:#}\n", report.json()),
            }
        }
        AnyScenario::Drive(input) => {
            let report = DriveReport::new(&input).map_err(located)?;
            match arguments.format {
                Format::Text => say_lines(&report.lines()),
                Format::Json => format!("{:#}\n", report.json()),
            }
        }
    })
}

fn report(scenario: &Scenario) -> Result<Report, Message> {
    let (plant, relay) = (&scenario.plant, &scenario.relay);
    let prediction = predict(plant, relay).map_err(Message::from)?;
    let long_run = scenario.long_run(&prediction).map_err(Message::from)?;
    let trust = match long_run.outcome {
        Some(outcome) => prediction.trust_after(plant, relay, outcome),
        None => prediction.trust.clone(),
    };
    let stable = |c: &&ExactCycle| c.cycle.stable == Some(true);
    let exact = prediction.exact.iter().find(stable).map(|c| c.cycle);
    Ok(Report {
        ultimate: exact
            .or(long_run.of_two_levels())
            .map(|c| relay_gain(plant, relay, &c)),
        limits: stability_limits(plant),
        prediction,
        long_run,
        trust,
    })
}

impl Report {
    /// Whether there is an oscillation that lasts.
    fn exists(&self) -> bool {
        let stable = |c: &ExactCycle| c.cycle.stable == Some(true);
        self.long_run.cycle.is_some() || self.prediction.exact.iter().any(stable)
    }

    /// Outcome and how far the describing function holds.
    fn sentences(&self) -> Message {
        self.long_run.text.clone().and(&self.trust.text)
    }
}

fn json(report: &Report) -> serde_json::Value {
    let p = &report.prediction;
    let describing: Vec<_> = p
        .describing_function
        .iter()
        .map(|i| {
            json!({"omega": i.omega, "period": i.cycle.period, "amplitude": i.cycle.amplitude,
                   "mean": i.mean, "distortion": i.distortion, "stable": i.cycle.stable})
        })
        .collect();
    let exact: Vec<_> = p
        .exact
        .iter()
        .map(|c| {
            json!({"period": c.cycle.period, "amplitude": c.cycle.amplitude, "half_periods": c.durations,
                   "range": c.range, "stable": c.cycle.stable, "multiplier": c.multiplier})
        })
        .collect();
    let run = &report.long_run;
    let scatter = |i: usize| run.scatter.map(|s| s[i]);
    json!({
        "schema": SCHEMA,
        "outcome": run.outcome,
        "describing_function": describing,
        "exact": exact,
        "continuum": p.continuum.as_ref().map(|cycles| {
            cycles.iter().map(|c| json!({"period": c.period, "amplitude": c.amplitude})).collect::<Vec<_>>()
        }),
        "simulated": run.cycle.map(|c| json!({
            "period": c.period, "amplitude": c.amplitude, "stable": c.stable,
            "std_dev_period": scatter(0), "std_dev_amplitude": scatter(1),
        })),
        "ultimate": ultimate_json(report),
        "exists": report.exists(),
        "text": report.sentences(),
    })
}

fn ultimate_json(report: &Report) -> serde_json::Value {
    let relay = report.ultimate.as_ref();
    let StabilityLimits { lower, upper, .. } = report.limits;
    let finite = |period: f64| Some(period).filter(|p| p.is_finite());
    json!({
        "gain_relay": relay.map(|u| u.by_relay.gain),
        "period_relay": relay.map(|u| u.by_relay.period),
        "phase_deg": relay.map(|u| u.shown.phase_deg),
        "gain_shown": relay.map(|u| 1.0 / u.shown.magnitude),
        "gain_true": upper.map(|u| u.gain),
        "period_true": upper.and_then(|u| finite(u.period)),
        "gain_lower": lower.map(|u| u.gain),
        "period_lower": lower.and_then(|u| finite(u.period)),
    })
}

fn text(report: &Report) -> String {
    let p = &report.prediction;
    let mut out = format!("{}\n\n", say(report.sentences()));
    let describing: Vec<Cycle> = p.describing_function.iter().map(|i| i.cycle).collect();
    let exact: Vec<Cycle> = p.exact.iter().map(|c| c.cycle).collect();
    let mut table = CycleTable::default();
    rows(&mut table, "describing function", &describing);
    rows(&mut table, "exact", &exact);
    rows(
        &mut table,
        "one of a continuum",
        p.continuum.as_deref().unwrap_or_default(),
    );
    if let Some(cycle) = report.long_run.cycle {
        row(&mut table, "simulated", &cycle);
    }
    out += &table.text().unwrap_or_default();
    let ultimate = report.ultimate.as_ref().map(|u| u.text.clone());
    let text = ultimate.unwrap_or_else(|| report.limits.text());
    let _ = writeln!(out, "{}", say(text));
    out
}

fn row(table: &mut CycleTable, name: &'static str, cycle: &Cycle) {
    table.row(name, cycle.period, cycle.amplitude, cycle.stable);
}

/// All cycles of a kind, but for a long family of unstable ones, of which the longest and the shortest stand for all.
fn rows(table: &mut CycleTable, name: &'static str, cycles: &[Cycle]) {
    let mut sorted: Vec<&Cycle> = cycles.iter().collect();
    sorted.sort_by(|a, b| b.period.total_cmp(&a.period));
    let (family, single): (Vec<&Cycle>, Vec<&Cycle>) =
        sorted.into_iter().partition(|c| c.stable == Some(false));
    for cycle in single {
        row(table, name, cycle);
    }
    let (listed, folded) = family.split_at(family.len().min(LISTED));
    for cycle in listed {
        row(table, name, cycle);
    }
    if let Some(last) = folded.last() {
        let words = msg!(
            "{} more of this family down to a period of {} s: all unstable",
            folded.len(),
            fixed(last.period, 9)
        );
        table.words(name, &words);
    }
}
