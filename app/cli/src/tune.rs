//! `hysteron tune FILE.csv|LOG`, or with `--amplitude`, `--period`, `--levels` and `--hysteresis`

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use hysteron_core::measurement::{ImportOptions, Mapping, Period, TorqueConstant};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::tuning::measured::{
    AmplitudeConvention, FittedModel, Form, MeasuredTuning, OpenError, Readings, TunedGains,
    Wishes, open, tune_readings,
};
use hysteron_core::uncertain::digits;
use hysteron_work::language::{say, tr_number};
use serde_json::json;

use crate::arguments::Kind;
use crate::output::Format;
use crate::read::{bytes_of, shown};

/// Version of the JSON object.
const SCHEMA: u32 = 1;

/// What may be given.
const FILE_HELP: &str = "Record of a relay test as CSV or MATLAB file, or the log of an auto-tuner: Klipper, Marlin, \
                         ESPHome, Mycodo, Home Assistant";

#[derive(Debug, clap::Args)]
pub struct Arguments {
    #[arg(value_name = "FILE.csv|LOG", help = FILE_HELP, required_unless_present_all = ["amplitude", "period", "levels"])]
    file: Option<PathBuf>,
    /// Amplitude of the output, in its unit: half of peak to peak, unless --peak-to-peak
    #[arg(long, value_name = "A", conflicts_with = "file", requires_all = ["period", "levels"])]
    amplitude: Option<f64>,
    /// The amplitude was read from peak to peak
    #[arg(long, requires = "amplitude")]
    peak_to_peak: bool,
    /// Period of the oscillation, s; of a file without a time column its sampling period, such as 4s or 250Hz
    #[arg(long, value_name = "PERIOD")]
    period: Option<String>,
    /// Input while the relay is down and up; of a log only if it does not say so
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true)]
    levels: Option<Two>,
    /// Half the distance between the outputs at which the relay switches
    #[arg(long, value_name = "H")]
    hysteresis: Option<f64>,
    /// Time with the input up and down, s
    #[arg(long, value_name = "UP,DOWN", requires = "amplitude")]
    half_periods: Option<Two>,
    /// Form of the gains; parallel, or for a log that of its firmware, if not given
    #[arg(long, value_enum)]
    form: Option<FormName>,
    /// Largest value of the input, such as 1, 100 or 255; guessed if not given
    #[arg(long, value_name = "U")]
    full_scale: Option<f64>,
    /// Set point of the test, in the unit of the output
    #[arg(long, value_name = "Y", allow_hyphen_values = true)]
    target: Option<f64>,
    /// Drive or process; guessed from the columns if not given
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// Which column is what: t, u, y, its name in the file (- before it flips the sign), its unit
    #[arg(long, value_name = "WHAT=COLUMN [UNIT],...")]
    map: Option<Mapping>,
    /// What a current, voltage or command as input becomes, such as "0.05 N m/A"
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    torque_constant: Option<TorqueConstant>,
    /// For a person or for a program
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

/// Form of the gains.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum FormName {
    /// kp + ki/s + kd s
    Parallel,
    /// kp (1 + 1/(ti s) + td s)
    Ideal,
    /// kp (1 + 1/(ti s)) (1 + td s)
    Series,
    /// `pid_Kp`, `pid_Ki` and `pid_Kd`
    Klipper,
    /// P, I and D of M301 or M304
    Marlin,
    /// kp, ki and kd of a climate
    Esphome,
}

impl FormName {
    const fn form(self) -> Form {
        match self {
            Self::Parallel => Form::Parallel,
            Self::Ideal => Form::Ideal,
            Self::Series => Form::Series,
            Self::Klipper => Form::Klipper,
            Self::Marlin => Form::Marlin,
            Self::Esphome => Form::Esphome,
        }
    }
}

/// Two numbers with a comma between them.
#[derive(Clone, Copy, Debug)]
struct Two([f64; 2]);

impl FromStr for Two {
    type Err = Message;

    fn from_str(text: &str) -> Result<Self, Message> {
        let numbers: Vec<f64> = text
            .split(',')
            .filter_map(|n| n.trim().parse().ok())
            .collect();
        match (numbers.as_slice(), text.split(',').count()) {
            ([a, b], 2) => Ok(Self([*a, *b])),
            _ => Err("expected two numbers with a comma between them, such as 0,255".into()),
        }
    }
}

/// What the test tells, or one line that says what is wrong with the input.
pub fn run(arguments: &Arguments) -> Result<String, Message> {
    let wishes = Wishes {
        form: arguments.form.map(FormName::form),
        full_scale: arguments.full_scale,
        target: arguments.target,
        hysteresis: arguments.hysteresis,
        levels: arguments
            .levels
            .map(|l| l.0)
            .filter(|_| arguments.file.is_some()),
    };
    if let Some(levels) = wishes.levels
        && !(levels.iter().all(|l| l.is_finite()) && levels[0] != levels[1] && levels[1] != 0.0)
    {
        return Err("--levels must be two different numbers, the second not 0".into());
    }
    if let Some(scale) = arguments.full_scale
        && !(scale.is_finite() && scale > 0.0)
    {
        return Err(msg!("--full-scale is {}: it must be above 0", scale));
    }
    let result = match (&arguments.file, of_numbers(arguments)?) {
        (Some(file), _) => of_file(file, arguments, &wishes)?,
        (None, Some(readings)) => {
            let settings = wishes.settings(Vec::new());
            tune_readings(&readings, &settings).map_err(Message::from)?
        }
        (None, None) => {
            return Err("expected a file, or --amplitude, --period and --levels".into());
        }
    };
    Ok(match arguments.format {
        Format::Text => text(&result),
        Format::Json => format!("{:#}\n", json(&result)),
    })
}

/// What was read off a test, where that and no file is given.
fn of_numbers(arguments: &Arguments) -> Result<Option<Readings>, Message> {
    let (Some(amplitude), Some(period), Some(levels), None) = (
        arguments.amplitude,
        &arguments.period,
        arguments.levels,
        &arguments.file,
    ) else {
        return Ok(None);
    };
    let period = period.trim_end_matches('s').trim();
    Ok(Some(Readings {
        amplitude,
        convention: if arguments.peak_to_peak {
            AmplitudeConvention::PeakToPeak
        } else {
            AmplitudeConvention::Half
        },
        period: period.parse().map_err(|_| {
            msg!(
                "--period is {}: expected the period in s, such as 47",
                Message::name(period)
            )
        })?,
        levels: levels.0,
        hysteresis: arguments.hysteresis.unwrap_or(0.0),
        half_periods: arguments.half_periods.map(|t| t.0),
        unequal: false,
    }))
}

/// What the file does not say itself.
fn options(arguments: &Arguments) -> Result<ImportOptions, Message> {
    let period = arguments.period.as_deref().map(str::parse::<Period>);
    let period = period.transpose().map_err(|e| msg!("--period: {}", e))?;
    Ok(ImportOptions {
        kind: arguments.kind.map(Into::into),
        mapping: arguments.map.clone().unwrap_or_default(),
        torque_constant: arguments.torque_constant,
        period,
    })
}

fn of_file(file: &Path, arguments: &Arguments, wishes: &Wishes) -> Result<MeasuredTuning, Message> {
    if file.is_dir() {
        return Err(msg!(
            "{} is a directory; expected a CSV or MATLAB file, or a log",
            shown(file)
        ));
    }
    let bytes = bytes_of(file)?;
    let name = file
        .file_name()
        .unwrap_or(file.as_os_str())
        .to_string_lossy();
    let opened = open(&name, &bytes, &options(arguments)?).map_err(|e| match e {
        OpenError::Log(e) => msg!("{}: {}", shown(file), e),
        OpenError::Import(e) => e.message(),
    })?;
    let mut result = opened
        .tune(wishes)
        .map_err(|e| msg!("{}: {}", shown(file), e))?;
    result.name = name.into_owned();
    Ok(result)
}

fn json(result: &MeasuredTuning) -> serde_json::Value {
    let cycle = result.cycle.as_ref().map(|c| {
        json!({"period": c.period, "amplitude": c.amplitude, "half_periods": c.half_periods, "levels": c.levels,
               "hysteresis": c.hysteresis, "periods": c.periods})
    });
    let point = result.point.map(|p| {
        json!({"omega": p.omega, "magnitude": p.magnitude, "phase_deg": p.phase_deg,
               "std_error_magnitude": p.std_error_magnitude, "std_error_phase_deg": p.std_error_phase_deg})
    });
    let ultimate = result.ultimate.map(|u| {
        json!({"gain": u.gain, "period": u.period, "std_error_gain": u.std_error_gain,
               "std_error_period": u.std_error_period})
    });
    json!({
        "schema": SCHEMA,
        "cycle": cycle,
        "point": point,
        "ultimate": ultimate,
        "conventional": result.conventional.map(|c| json!({"gain": c.gain, "period": c.period})),
        "static_gain": result.static_gain.map(|k| json!({"value": k.value, "std_error": k.std_error})),
        "models": result.models.iter().map(model).collect::<Vec<_>>(),
        "gains": result.gains.iter()
            .map(|g| gains(g, !result.models.is_empty()))
            .collect::<Vec<_>>(),
        "stall": result.stall(),
        "troubles": result.troubles.iter()
            .map(|t| json!({"kind": t.kind, "fatal": t.fatal, "number": t.number, "text": t.text}))
            .collect::<Vec<_>>(),
        "text": result.text,
    })
}

/// A model; times in s, the largest time constant first.
fn model(model: &FittedModel) -> serde_json::Value {
    let lag = |i: usize, of: fn(&hysteron_core::tuning::measured::Value) -> f64| {
        model.time_constants.get(i).map(of)
    };
    json!({
        "kind": model.structure.id(),
        "gain": model.gain.value,
        "std_error_gain": model.gain.std_error,
        "time_constant": lag(0, |t| t.value),
        "std_error_time_constant": lag(0, |t| t.std_error),
        "second_time_constant": lag(1, |t| t.value),
        "std_error_second_time_constant": lag(1, |t| t.std_error),
        "third_time_constant": lag(2, |t| t.value),
        "std_error_third_time_constant": lag(2, |t| t.std_error),
        "zero": model.zero.map(|z| z.value),
        "std_error_zero": model.zero.map(|z| z.std_error),
        "dead_time": model.dead_time.value,
        "std_error_dead_time": model.dead_time.std_error,
        "operating_point": model.operating_point,
        "left": model.left,
        "preferred": model.preferred,
    })
}

/// Gains; without a model nobody knows whether their loop is stable.
fn gains(gains: &TunedGains, judged: bool) -> serde_json::Value {
    json!({
        "rule": gains.rule,
        "controller": gains.controller,
        "form": gains.form.id(),
        "kp": gains.kp,
        "ki": gains.ki,
        "kd": gains.kd,
        "ti": gains.ti,
        "td": gains.td,
        "stable": judged.then_some(gains.stable),
        "phase_margin_deg": gains.phase_margin_deg,
        "gain_margin": gains.gain_margin,
        "max_sensitivity": gains.max_sensitivity,
    })
}

fn text(result: &MeasuredTuning) -> String {
    let mut out = format!(
        "{}: {}\n",
        result.name.replace(char::is_control, " "),
        say(&result.text)
    );
    for rows in [model_rows(result), gain_rows(result)] {
        if rows.len() > 1 {
            let _ = write!(out, "\n{}", aligned(&rows));
        }
    }
    out
}

/// The models under their head.
fn model_rows(result: &MeasuredTuning) -> Vec<Vec<String>> {
    let head = [
        "model",
        "gain",
        "lag [s]",
        "2nd lag [s]",
        "dead time [s]",
        "left",
    ];
    let row = |m: &FittedModel| {
        let lag = |i: usize| {
            m.time_constants
                .get(i)
                .map_or_else(String::new, |t| short(t.value))
        };
        vec![
            m.structure.id().to_owned(),
            short(m.gain.value),
            lag(0),
            lag(1),
            short(m.dead_time.value),
            tr_number(format!("{:.2} %", 100.0 * m.left)),
        ]
    };
    let models = result.models.iter().map(row);
    std::iter::once(head.map(say).to_vec())
        .chain(models)
        .collect()
}

/// The gains under their head; some forms have times in the place of gains.
fn gain_rows(result: &MeasuredTuning) -> Vec<Vec<String>> {
    let Some(form) = result.gains.first().map(|g| g.form) else {
        return Vec::new();
    };
    let of_times = matches!(form, Form::Ideal | Form::Series);
    let [integral, derivative] = if of_times {
        ["ti [s]", "td [s]"]
    } else {
        ["ki [1/s]", "kd [s]"]
    };
    let title = msg!("gains, {} form", form.id());
    let words = ["kp", integral, derivative, "phase margin", "gain margin"];
    let head = std::iter::once(title).chain(words.map(Message::from));
    let none = || "-".to_owned();
    let row = |g: &TunedGains| {
        let name = format!(
            "{} {}",
            say(Message::words(g.name.clone())),
            g.controller.to_uppercase()
        );
        let [integral, derivative] = if of_times {
            [g.ti.map_or_else(none, short), short(g.td)]
        } else {
            [short(g.ki), short(g.kd)]
        };
        let mut row = vec![name, short(g.kp), integral, derivative];
        if g.stable || result.models.is_empty() {
            row.push(g.phase_margin_deg.map_or_else(none, |p| format!("{p:.0}°")));
            row.push(
                g.gain_margin
                    .map_or_else(none, |m| tr_number(format!("{m:.2}"))),
            );
        } else {
            row.push(say("unstable on the model"));
        }
        row
    };
    let gains = result.gains.iter().map(row);
    std::iter::once(head.map(say).collect())
        .chain(gains)
        .collect()
}

/// Rows as lines: the first column begins at the left, the others end beneath each other. A row with fewer columns than
/// the first ends with words, which need no column.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |column: usize| {
        let whole = rows.iter().filter(|r| r.len() == columns);
        let cells = whole.filter_map(|r| r.get(column));
        cells.map(|c| c.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut out = String::new();
    for row in rows {
        for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
            let _ = match column {
                0 => write!(out, "{cell:<width$}"),
                last if last + 1 == row.len() && row.len() < columns => write!(out, "   {cell}"),
                _ => write!(out, "   {cell:>width$}"),
            };
        }
        out.truncate(out.trim_end().len());
        out.push('\n');
    }
    out
}

/// Five significant digits.
fn short(value: f64) -> String {
    tr_number(digits(value, 5))
}
