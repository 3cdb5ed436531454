//! `hysteron gap FILE.csv`

use std::fmt::Write as _;
use std::path::PathBuf;

use hysteron_core::backlash::{BacklashMap, GapEstimate, MapSilence, backlash_map, estimate_gap};
use hysteron_core::measurement::{ImportOptions, Mapping, Period, Quantity, TorqueConstant};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_work::language::{say, tr_number};
use serde_json::json;

use crate::output::Format;
use crate::read::read;

/// Version of the JSON object.
const SCHEMA: u32 = 1;

/// Traverses that the text lists one by one.
const LISTED: usize = 12;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Drifting test: CSV with units in its header, such as t [s],u [N m],x1 [rad],v1 [rad/s], or a MATLAB file
    #[arg(value_name = "FILE.csv")]
    file: PathBuf,
    /// Which column is what: t, u, x1 or v1, its name in the file (- before it flips the sign), its unit
    #[arg(long, value_name = "WHAT=COLUMN [UNIT],...")]
    map: Option<Mapping>,
    /// What a current, voltage or command as input becomes, such as "0.05 N m/A"; the gap does not depend on it
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    torque_constant: Option<TorqueConstant>,
    /// The time from one sample to the next where the file has no times, such as 0.5ms or 2kHz
    #[arg(long, value_name = "TIME")]
    period: Option<Period>,
    /// For a person or for a program
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// The estimate, or one line that says what is wrong with the input.
pub fn run(arguments: &Arguments) -> Result<String, Message> {
    let options = ImportOptions {
        kind: None,
        mapping: arguments.map.clone().unwrap_or_default(),
        torque_constant: arguments.torque_constant,
        period: arguments.period,
    };
    let (measurement, _) = read(&arguments.file, &options)?;
    let name = &measurement.name;
    let estimate =
        estimate_gap(&measurement).map_err(|e| msg!("{}: {}", Message::name(name.clone()), e))?;
    let has_load = measurement
        .reference
        .iter()
        .any(|c| c.quantity == Quantity::LoadPosition);
    let map = if has_load {
        backlash_map(&measurement).ok()
    } else {
        None
    };
    Ok(match arguments.format {
        Format::Text => text(name, &estimate, map.as_ref(), &measurement.warnings),
        Format::Json => format!("{:#}\n", json(&estimate)),
    })
}

fn json(estimate: &GapEstimate) -> serde_json::Value {
    json!({
        "schema": SCHEMA,
        "gap": estimate.gap,
        "std_error": estimate.std_error,
        "unit": estimate.unit,
        "traverses": estimate.traverses.len(),
        "text": estimate.text,
        "interval": estimate.interval,
        "quality": estimate.quality,
    })
}

fn text(
    name: &str,
    estimate: &GapEstimate,
    map: Option<&BacklashMap>,
    notes: &[Message],
) -> String {
    let (scale, unit) = estimate.written_in();
    let scaled = |length: f64| length * scale;
    let mut out = format!(
        "{}: {}\n",
        name.replace(char::is_control, " "),
        say(&estimate.text)
    );
    if let Some(interval) = estimate.interval {
        let [low, high] = interval.map(scaled);
        let interval = msg!(
            "95 % interval {} to {} {}",
            fixed(low, 3),
            fixed(high, 3),
            &unit
        );
        let _ = writeln!(out, "{}", say(&interval));
    }
    if !estimate.traverses.is_empty() && estimate.gap.is_some() {
        let (at, gap) = (msg!("at [{}]", &unit), msg!("gap [{}]", &unit));
        let [left, reached, at, gap] =
            ["left [s]".into(), "reached [s]".into(), at, gap].map(|m: Message| say(m));
        let _ = writeln!(
            out,
            "\n{left:>13} {at:>11} {reached:>13} {at:>11} {gap:>12}"
        );
        for t in estimate.traverses.iter().take(LISTED) {
            let row = format!(
                "{:13.4} {:11.3} {:13.4} {:11.3} {:12.3} ± {:.3}",
                t.from.time,
                scaled(t.from.position),
                t.to.time,
                scaled(t.to.position),
                scaled(t.gap),
                scaled(t.std_error)
            );
            let _ = writeln!(out, "{}", tr_number(row));
        }
        if estimate.traverses.len() > LISTED {
            let more = msg!("... {} more", estimate.traverses.len() - LISTED);
            let _ = writeln!(out, "{}", say(&more));
        }
    }
    if let Some(map) = map {
        let found = match (map.gap, map.asymmetry) {
            (Some(gap), Some(asymmetry)) => {
                let [gap, asymmetry] = [gap, asymmetry].map(scaled);
                msg!(
                    "By the backlash map with the measured load, for reference: gap {} {}, its middle at \
                     {} {}",
                    fixed(gap, 3),
                    &unit,
                    fixed(asymmetry, 3),
                    &unit
                )
            }
            _ => msg!(
                "By the measured load, for reference: {}",
                silence(map, scale, &unit)
            ),
        };
        let _ = writeln!(out, "\n{}", say(&found));
    }
    for note in notes {
        let _ = writeln!(out, "{}: {}", say("Note"), say(note));
    }
    out
}

/// Why the map shows no gap.
fn silence(map: &BacklashMap, scale: f64, unit: &str) -> Message {
    match map.silence {
        Some(MapSilence::NotMoved) => {
            "it moved no more than its sensor can resolve, so that its map shows no gap".into()
        }
        Some(MapSilence::Yields { span }) => msg!(
            "it stays within {} {} of the motor, and the coupling between them gives over most of that, as a flexible \
             shaft does: its map shows no gap",
            fixed(scale * span, 3),
            unit.to_owned()
        ),
        Some(MapSilence::OneWay) | None => {
            "it was pushed one way at most, so that its map shows no gap".into()
        }
    }
}
