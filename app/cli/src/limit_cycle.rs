//! `hysteron limit-cycle SCENARIO.toml`

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::PathBuf;

use hysteron_core::limit_cycle::{Prediction, describing_function, dominant, predict};
use hysteron_core::relay::Relay;
use hysteron_core::scenario::{AnyScenario, Scenario};
use hysteron_core::simulate::Options;
use serde_json::json;

use crate::limit_cycle_drive::DriveReport;
use crate::output::Format;
use crate::simulate;

/// Version of the JSON object.
const SCHEMA: u32 = 1;

/// Periods that are simulated, so that the loop has time to settle.
const PERIODS: f64 = 200.0;

/// Share by which the last two cycles may differ and still count as settled.
const SETTLED: f64 = 1e-6;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Loop or drive to predict: tables [plant] or [drive], and [relay]
    #[arg(value_name = "SCENARIO.toml")]
    file: PathBuf,
    /// For a person or for a program
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// Period and amplitude.
type Pair = Option<(f64, f64)>;

struct Report {
    prediction: Prediction,
    simulated: Pair,
    /// By equation (4) from amplitude and period of the cycle.
    ultimate_relay: Pair,
    /// Where the plant's own phase is -180 degrees.
    ultimate_true: Pair,
}

/// The report, or one line that says what is wrong with the input.
pub fn run(arguments: &Arguments) -> Result<String, String> {
    let located = |e| format!("{}: {e}", arguments.file.display());
    Ok(match simulate::read(&arguments.file)? {
        AnyScenario::Loop(scenario) => {
            let report = report(&scenario).map_err(located)?;
            match arguments.format {
                Format::Text => text(&report),
                Format::Json => format!("{:#}\n", json(&report)),
            }
        }
        AnyScenario::Drive(input) => {
            let report = DriveReport::new(&input).map_err(located)?;
            match arguments.format {
                Format::Text => report.text(),
                Format::Json => format!("{:#}\n", report.json()),
            }
        }
    })
}

fn report(scenario: &Scenario) -> Result<Report, String> {
    let prediction = predict(&scenario.plant, &scenario.relay).map_err(|e| e.to_string())?;
    let simulated = simulated(scenario, &prediction)?;
    let exact = prediction
        .exact
        .iter()
        .find(|c| c.cycle.stable == Some(true));
    let cycle = exact
        .map(|c| (c.cycle.period, c.cycle.amplitude))
        .or(simulated);
    let ideal = Relay {
        gain: 1.0,
        hysteresis: 0.0,
        ..Relay::default()
    };
    let crossover = describing_function(&scenario.plant, &ideal);
    Ok(Report {
        simulated,
        ultimate_relay: cycle.map(|(period, a)| (4.0 * scenario.relay.gain / (PI * a), period)),
        ultimate_true: dominant(&crossover)
            .map(|i| (1.0 / i.point[0].hypot(i.point[1]), i.cycle.period)),
        prediction,
    })
}

/// A run that is long enough to settle, from the state in the file.
fn simulated(scenario: &Scenario, prediction: &Prediction) -> Result<Pair, String> {
    let period = prediction
        .exact
        .iter()
        .map(|c| c.cycle.period)
        .chain(
            prediction
                .describing_function
                .iter()
                .map(|i| i.cycle.period),
        )
        .fold(0.0, f64::max);
    let duration = scenario.options.duration.max(PERIODS * period);
    let mut longer = scenario.clone();
    longer.options = Options {
        duration,
        step: None,
        ..scenario.options.clone()
    };
    let result = longer.run();
    Ok(result.map_err(|e| e.to_string())?.settled(SETTLED))
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
    let pair = |pair: Pair, part: fn((f64, f64)) -> f64| pair.map(part);
    json!({
        "schema": SCHEMA,
        "describing_function": describing,
        "exact": exact,
        "simulated": report.simulated.map(|(period, amplitude)| json!({"period": period, "amplitude": amplitude})),
        "ultimate": {
            "gain_relay": pair(report.ultimate_relay, |u| u.0),
            "gain_true": pair(report.ultimate_true, |u| u.0),
            "period_relay": pair(report.ultimate_relay, |u| u.1),
            "period_true": pair(report.ultimate_true, |u| u.1),
        },
        "exists": !p.exact.is_empty() || report.simulated.is_some(),
        "text": p.text,
    })
}

fn text(report: &Report) -> String {
    let p = &report.prediction;
    let mut out = format!("{}\n\n", p.text);
    let row = |out: &mut String, name: &str, period: f64, amplitude: f64, stable: Option<bool>| {
        let stable = stable.map_or("not known", |s| if s { "yes" } else { "no" });
        let _ = writeln!(
            out,
            "{name:<22} {period:>16.9} {amplitude:>16.9}   {stable}"
        );
    };
    let _ = writeln!(
        out,
        "{:<22} {:>16} {:>16}   stable",
        "", "period [s]", "amplitude"
    );
    for i in &p.describing_function {
        row(
            &mut out,
            "describing function",
            i.cycle.period,
            i.cycle.amplitude,
            i.cycle.stable,
        );
    }
    for c in &p.exact {
        row(
            &mut out,
            "exact",
            c.cycle.period,
            c.cycle.amplitude,
            c.cycle.stable,
        );
    }
    if let Some((period, amplitude)) = report.simulated {
        row(&mut out, "simulated", period, amplitude, Some(true));
    }
    out.push_str("Amplitude: half of peak to peak.\n");
    let mut ultimate = |name: &str, pair: Pair| {
        if let Some((gain, period)) = pair {
            let _ = writeln!(out, "{name}: {gain:.6} at a period of {period:.6} s");
        }
    };
    ultimate(
        "Ultimate gain by the relay, 4k/(pi a)",
        report.ultimate_relay,
    );
    ultimate("Ultimate gain of the plant", report.ultimate_true);
    out
}
