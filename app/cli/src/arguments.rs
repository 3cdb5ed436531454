//! The arguments of `hysteron diagnose`.

use std::path::PathBuf;
use std::str::FromStr;

use hysteron_core::diagnosis::Limits;
use hysteron_core::measurement::{self, Mapping, Period, TorqueConstant};
use hysteron_core::message::Message;

use crate::output::Format;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// CSV with units in its header, such as t [s],u [N m],x1 [rad],v1 [rad/s], JSON, a log of names with values, or a
    /// MATLAB file; many files: one result each
    #[arg(value_name = "FILE.csv", required = true)]
    pub files: Vec<PathBuf>,
    /// Kind of system; guessed from the columns if not given
    #[arg(long, value_enum)]
    pub kind: Option<Kind>,
    /// Which column is what: t, u, x1, v1, x2, v2 or y, its name in the file (- before it flips the sign), its
    /// unit; such as "t=time [ms],u=-current [A],x1=enc [counts:4096]"
    #[arg(long, value_name = "WHAT=COLUMN [UNIT],...")]
    pub map: Option<AsWritten<Mapping>>,
    /// What a current, voltage or command as input becomes, such as "0.05 N m/A"; without it all torques are
    /// multiples of it
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    pub torque_constant: Option<AsWritten<TorqueConstant>>,
    /// The time from one sample to the next where the file has no times, such as 4s, 0.5ms or 100Hz
    #[arg(long, value_name = "TIME")]
    pub period: Option<AsWritten<Period>>,
    /// For a person or for a program; of many files one block or one line of JSON each
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// What is known of the model: parameters that are fixed or roughly known, effects that it has already
    #[arg(long, value_name = "M.toml")]
    pub model: Option<PathBuf>,
    /// An effect of your own to be tried: a force as a formula of x, v, u, t (a process: y, u, t) with parameters
    /// to fit, and optional starting values: "bump: -a*exp(-((x-b)/c)^2); b = 0.5"
    #[arg(long, value_name = "NAME: FORMULA", allow_hyphen_values = true)]
    pub effect: Vec<String>,
    /// Look for a formula of what the effects leave: an expression of x, v, u, t (a process: y, u, t) with its
    /// parameters, up to three terms
    #[arg(long)]
    pub discover: bool,
    /// How far the next experiment may go where effects cannot be told apart: the largest input, the longest record
    /// (s), the sampling time (s), the largest speed (of a process: output) and travel, in SI units, such as
    /// "input=0.5,duration=10,travel=3"; what is not named is as in the file, or twice as fast
    #[arg(long, value_name = "NAME=VALUE,...", value_parser = limits)]
    pub limits: Option<String>,
    /// Write the model with the effects that were found to this file, for --model
    #[arg(long, value_name = "OUT.toml")]
    pub save_model: Option<PathBuf>,
    /// Write what was found to this file as a page with pictures, for a browser or a printer
    #[arg(long, value_name = "OUT.html")]
    pub report: Option<PathBuf>,
    /// Add each result to this file as a line of JSON, and skip files whose result is there
    #[arg(long, value_name = "OUT")]
    pub resume: Option<PathBuf>,
    /// Of many files, how many at a time; as many as there are processors if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
}

impl Arguments {
    /// A file, and nothing else said.
    pub fn of(file: impl Into<PathBuf>) -> Self {
        Self {
            files: vec![file.into()],
            kind: None,
            map: None,
            torque_constant: None,
            period: None,
            format: Format::Text,
            model: None,
            effect: Vec::new(),
            discover: false,
            limits: None,
            save_model: None,
            report: None,
            resume: None,
            jobs: None,
        }
    }
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Kind {
    /// Torque or force in, position or velocity out
    Drive,
    /// Any input u, any output y
    Process,
}

impl From<Kind> for measurement::Kind {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Drive => Self::Drive,
            Kind::Process => Self::Process,
        }
    }
}

/// A value of an option and how it was written.
#[derive(Clone, Debug)]
pub struct AsWritten<T> {
    pub text: String,
    pub value: T,
}

impl<T: FromStr> FromStr for AsWritten<T> {
    type Err = T::Err;

    fn from_str(text: &str) -> Result<Self, T::Err> {
        Ok(Self {
            text: text.to_owned(),
            value: text.parse()?,
        })
    }
}

/// The limits as written, if they can be read.
fn limits(text: &str) -> Result<String, Message> {
    if text.trim_matches([' ', ',']).is_empty() {
        return Err("no limit is named; expected something like input=0.5,duration=10".into());
    }
    let mut any = Limits {
        input: 1.0,
        side: 0,
        duration: 1.0,
        step: 1.0,
        speed: None,
        travel: None,
    };
    any.set(text).map_err(Message::from)?;
    Ok(text.to_owned())
}
