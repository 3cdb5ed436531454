//! `hysteron screen FILE.csv`

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::Instant;

use hysteron_core::criticism::screen;
use hysteron_core::diagnosis::{Parameter, Screening, Subset};
use hysteron_core::effect::name_of;
use hysteron_core::measurement::{ImportOptions, Mapping, Period, TorqueConstant};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::uncertain::with_error;
use hysteron_work::language::{say, tr_number};

use crate::arguments::Kind;
use crate::output::Format;
use crate::read::read;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// CSV with units in its header, such as t [s],u [N m],x1 [rad],v1 [rad/s], or a MATLAB file
    #[arg(value_name = "FILE.csv")]
    file: PathBuf,
    /// Kind of system; guessed from the columns if not given
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// Which column is what: t, u, x1, v1 or y, its name in the file (- before it flips the sign), its unit
    #[arg(long, value_name = "WHAT=COLUMN [UNIT],...")]
    map: Option<Mapping>,
    /// What a current, voltage or command as input becomes, such as "0.05 N m/A"
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    torque_constant: Option<TorqueConstant>,
    /// Sampling period of a file without a time column, such as 4s or 250Hz
    #[arg(long, value_name = "PERIOD")]
    period: Option<Period>,
    /// For a person or for a program
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// The screening, or one line that says what is wrong with the input.
pub fn run(arguments: &Arguments) -> Result<String, Message> {
    let options = ImportOptions {
        kind: arguments.kind.map(Into::into),
        mapping: arguments.map.clone().unwrap_or_default(),
        torque_constant: arguments.torque_constant,
        period: arguments.period,
    };
    let (measurement, _) = read(&arguments.file, &options)?;
    let started = Instant::now();
    let mut screening = screen(&measurement);
    screening.seconds = started.elapsed().as_secs_f64();
    let name = &measurement.name;
    match arguments.format {
        Format::Text => Ok(text(name, &screening, &measurement.warnings)),
        Format::Json => serde_json::to_string_pretty(&screening)
            .map(|json| json + "\n")
            .map_err(|e| {
                msg!(
                    "{}: the screening cannot be written as JSON: {}",
                    Message::name(name.clone()),
                    Message::name(e.to_string())
                )
            }),
    }
}

fn text(name: &str, screening: &Screening, notes: &[Message]) -> String {
    let mut out = format!(
        "{}: {}\n",
        name.replace(char::is_control, " "),
        say(msg!("{} samples", screening.samples))
    );
    let _ = writeln!(out, "{}", say(&screening.input_check.text));
    if let Some(left) = screening.left_by_body {
        let alone = msg!(
            "The body alone leaves {} % of the motion unexplained.",
            fixed(100.0 * left, 1)
        );
        let _ = writeln!(out, "{}", say(&alone));
    }
    match screening.subsets.as_slice() {
        [] => {}
        [one] => {
            let _ = writeln!(out, "\n{}", say("What explains it best:"));
            subset(&mut out, one);
        }
        [first, others @ ..] => {
            let _ = writeln!(out, "\n{}", say("What explains it best:"));
            subset(&mut out, first);
            let _ = writeln!(out, "\n{}", say("This record cannot tell that from:"));
            for other in others {
                subset(&mut out, other);
            }
        }
    }
    for note in notes {
        let _ = writeln!(out, "{}: {}", say("Note"), say(note));
    }
    let _ = writeln!(
        out,
        "{}",
        tr_number(format!("({:.2} s)", screening.seconds))
    );
    out
}

fn subset(out: &mut String, subset: &Subset) {
    let names = subset.effects.iter().map(|id| name_of(*id));
    let names = if subset.effects.is_empty() {
        "the body alone".into()
    } else {
        Message::list(" and ", names)
    };
    let left = msg!("{} % of the motion is left", fixed(100.0 * subset.left, 1));
    let _ = writeln!(out, "  {}; {}", say(&names), say(&left));
    for parameter in &subset.parameters {
        let _ = writeln!(out, "    {}", line(parameter));
    }
}

fn line(parameter: &Parameter) -> String {
    let Parameter {
        name,
        label,
        value,
        std_error,
        unit,
        ..
    } = parameter;
    let value = say(with_error(*value, *std_error, unit));
    format!(
        "{name:<8} {value:<32} {}",
        say(Message::words(label.clone()))
    )
}
