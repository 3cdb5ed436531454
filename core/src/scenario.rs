//! A relay loop in a file: plant, relay and run as TOML.
//!
//! The plant is given in one of five ways, each with `dead_time` in s beside it:
//!
//! ```toml
//! [plant]
//! numerator = [1.0]                      # highest power first
//! denominator = [1.0, 3.0, 3.0, 1.0]
//! # or: formula = "1/(s+1)^3"            # as one would write it, dead time as e^{-0.5s}
//! # or: zeros = [-1.0], poles = [-2.0, [-1.0, 3.0], [-1.0, -3.0]], gain = 4.0
//! # or: gain = 2.0, time_constant = 3.0  # K e^{-Ls}/(Ts+1), s
//! # or: a = [[0.0, 1.0], [-1.0, -2.0]], b = [0.0, 1.0], c = [1.0, 0.0]
//! dead_time = 0.0
//! [relay]
//! gain = 1.0
//! hysteresis = 0.1                       # 0 if left out, as are asymmetry, bias and delay (s)
//! [run]
//! duration = 60.0                        # s
//! step = 0.01                            # s; a two-thousandth of the duration if left out
//! initial = [0.0, 0.0, 0.0]              # state; at rest if left out
//! noise = { std_dev = 0.01, interval = 0.01, seed = 1 }
//! ```
//!
//! With `[drive]` in place of `[plant]` it is a motor and a load with play between them, under a relay on
//! the motor's velocity; see [`crate::drive`] for its parameters.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::drive::{DriveError, DriveFile, DriveInput};
use crate::limit_cycle::{LongRun, LongRunResult, Prediction};
use crate::plant::{
    MAX_ORDER, ParseError, PlantError, StateSpace, TransferFunction, ZeroPoleGain, parse,
};
use crate::relay::{Relay, RelayError};
use crate::simulate::{Flow, MAX_SWITCHES, Noise, Options, SimulateError, Trajectory, run};

/// A loop and how to run it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The plant.
    pub plant: TransferFunction,
    /// The same without dead time, in the states of the file if it gives them.
    pub space: StateSpace,
    /// The relay.
    pub relay: Relay,
    /// How to run it.
    pub options: Options,
}

/// What a file can hold.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyScenario {
    /// A relay loop around a linear plant.
    Loop(Box<Scenario>),
    /// A drive with a hidden gap.
    Drive(Box<DriveInput>),
}

impl AnyScenario {
    /// Reads a scenario: a drive if it has a table `[drive]`, else a loop.
    ///
    /// # Errors
    /// Line and column of what is no TOML or not expected, or the table and value that cannot be.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        #[derive(Deserialize)]
        struct Tables {
            drive: Option<IgnoredAny>,
            plant: Option<IgnoredAny>,
        }
        let tables: Tables = toml::from_str(text).map_err(|e| located(text, &e))?;
        match (tables.drive, tables.plant) {
            (Some(_), Some(_)) => Err(ScenarioError::Form(
                "there is a [drive] as well; a scenario has one of both",
            )),
            (Some(_), None) => {
                let file: DriveFile = toml::from_str(text).map_err(|e| located(text, &e))?;
                let input = file
                    .input()
                    .map_err(|(table, error)| ScenarioError::Drive { table, error })?;
                Ok(Self::Drive(Box::new(input)))
            }
            _ => Ok(Self::Loop(Box::new(Scenario::from_toml(text)?))),
        }
    }
}

/// Why a file is no scenario.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScenarioError {
    /// The text.
    #[error("line {line}, column {column}: {message}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// The plant is given in no way, or in several.
    #[error(
        "[plant]: {0}; expected one of: numerator and denominator; formula; zeros, poles and gain; gain and \
         time_constant; a, b and c"
    )]
    Form(&'static str),
    /// The formula.
    #[error("[plant] formula, {0}")]
    Formula(ParseError),
    /// The plant.
    #[error("[plant]: {0}")]
    Plant(#[from] PlantError),
    /// The relay.
    #[error("[relay]: {0}")]
    Relay(#[from] RelayError),
    /// The run.
    #[error("[run]: {0}")]
    Run(SimulateError),
    /// A drive, its relay or its run.
    #[error("{table}: {error}")]
    Drive {
        /// Where it stands.
        table: &'static str,
        /// What is wrong.
        error: DriveError,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    plant: PlantTable,
    relay: RelayTable,
    run: Option<RunTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlantTable {
    numerator: Option<Vec<f64>>,
    denominator: Option<Vec<f64>>,
    formula: Option<String>,
    zeros: Option<Vec<Root>>,
    poles: Option<Vec<Root>>,
    gain: Option<f64>,
    time_constant: Option<f64>,
    a: Option<Vec<Vec<f64>>>,
    b: Option<Vec<f64>>,
    c: Option<Vec<f64>>,
    dead_time: Option<f64>,
}

/// A real number, or real and imaginary part.
#[derive(Deserialize)]
#[serde(untagged)]
enum Root {
    Real(f64),
    Complex([f64; 2]),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RelayTable {
    gain: f64,
    #[serde(default)]
    hysteresis: f64,
    #[serde(default)]
    asymmetry: f64,
    #[serde(default)]
    bias: f64,
    #[serde(default)]
    delay: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RunTable {
    duration: f64,
    step: Option<f64>,
    initial: Option<Vec<f64>>,
    noise: Option<Noise>,
}

/// Duration of a run that the file does not set, s.
const DURATION: f64 = 60.0;

/// Samples of a run whose step the file does not set.
const SAMPLES: f64 = 2000.0;

impl Scenario {
    /// Reads a scenario.
    ///
    /// # Errors
    /// Line and column of what is no TOML or not expected, or the table and value that cannot be.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        let file: File = toml::from_str(text).map_err(|e| located(text, &e))?;
        let (plant, space) = file.plant.read()?;
        let r = file.relay;
        let relay = Relay {
            gain: r.gain,
            hysteresis: r.hysteresis,
            asymmetry: r.asymmetry,
            bias: r.bias,
            delay: r.delay,
        };
        relay.validate()?;
        let run = file.run.unwrap_or(RunTable {
            duration: DURATION,
            step: None,
            initial: None,
            noise: None,
        });
        let options = Options {
            duration: run.duration,
            step: Some(run.step.unwrap_or(run.duration / SAMPLES)),
            initial: run.initial.map(DVector::from_vec),
            noise: run.noise,
            max_switches: MAX_SWITCHES,
        };
        options.check(space.b.len()).map_err(ScenarioError::Run)?;
        Ok(Self {
            plant,
            space,
            relay,
            options,
        })
    }

    /// Dead time and delay, s.
    pub fn lag(&self) -> f64 {
        self.plant.dead_time + self.relay.delay
    }

    /// What becomes of the loop in the end, however long that takes, from the file's start and in its noise.
    ///
    /// # Errors
    /// What is wrong with the noise.
    pub fn long_run(&self, prediction: &Prediction) -> Result<LongRunResult, SimulateError> {
        let run = LongRun {
            plant: &self.plant,
            space: &self.space,
            relay: &self.relay,
            initial: self.options.initial.as_ref(),
            push: self.push(),
            noise: self.options.noise,
        };
        run.run(prediction)
    }

    /// How long an ideal relay pushes from rest before it begins to look at the output, s.
    fn push(&self) -> f64 {
        let options = &self.options;
        options.step.unwrap_or(options.duration / SAMPLES)
    }

    /// Runs the loop as the file says. From rest an ideal relay without any delay would never leave
    /// its threshold; it begins after one step of upward push.
    pub fn run(&self) -> Result<Trajectory, SimulateError> {
        let mut options = self.options.clone();
        let stuck = self.relay.hysteresis == 0.0 && self.lag() == 0.0;
        if stuck && options.initial.is_none() {
            let push = self.push();
            let flow = Flow::single(&self.space, push);
            let pushed = flow.after(&[0.0; MAX_ORDER], &[self.relay.output(false)], push);
            options.initial = Some(flow.outer(&pushed));
        }
        run(&self.space, &self.relay, self.lag(), &options)
    }
}

impl PlantTable {
    fn read(self) -> Result<(TransferFunction, StateSpace), ScenarioError> {
        let dead_time = self.dead_time.unwrap_or(0.0);
        let polynomials = self.numerator.is_some() || self.denominator.is_some();
        let roots = self.zeros.is_some() || self.poles.is_some();
        let matrices = self.a.is_some() || self.b.is_some() || self.c.is_some();
        let forms = [
            polynomials,
            self.formula.is_some(),
            roots,
            self.time_constant.is_some(),
            matrices,
        ];
        match forms.iter().filter(|f| **f).count() {
            0 => return Err(ScenarioError::Form("no plant is given")),
            1 => {}
            _ => {
                return Err(ScenarioError::Form(
                    "the plant is given in several ways at once",
                ));
            }
        }
        if self.gain.is_some() && !(roots || self.time_constant.is_some()) {
            return Err(ScenarioError::Form("'gain' does not belong to this form"));
        }
        if let (Some(a), Some(b), Some(c)) = (&self.a, &self.b, &self.c) {
            let space = matrices_of(a, b, c)?;
            let plant = space.transfer_function(dead_time)?;
            return Ok((plant, space));
        }
        let plant = match self {
            Self {
                numerator: Some(n),
                denominator: Some(d),
                ..
            } => TransferFunction::new(&n, &d, dead_time),
            Self {
                formula: Some(text),
                ..
            } => {
                let mut plant = parse(&text).map_err(ScenarioError::Formula)?;
                plant.dead_time += dead_time;
                plant
            }
            Self {
                poles: Some(poles),
                zeros,
                gain: Some(gain),
                ..
            } => ZeroPoleGain {
                zeros: zeros.unwrap_or_default().iter().map(Root::value).collect(),
                poles: poles.iter().map(Root::value).collect(),
                gain,
                dead_time,
            }
            .transfer_function()?,
            Self {
                gain: Some(gain),
                time_constant: Some(time),
                ..
            } => TransferFunction::new(&[gain], &[time, 1.0], dead_time),
            _ => return Err(ScenarioError::Form("the plant is not complete")),
        };
        plant.validate()?;
        let space = plant.state_space();
        Ok((plant, space))
    }
}

impl Root {
    fn value(&self) -> Complex<f64> {
        match self {
            Self::Real(re) => Complex::new(*re, 0.0),
            Self::Complex([re, im]) => Complex::new(*re, *im),
        }
    }
}

fn matrices_of(a: &[Vec<f64>], b: &[f64], c: &[f64]) -> Result<StateSpace, PlantError> {
    let n = a.len();
    if let Some(row) = a.iter().find(|r| r.len() != n) {
        return Err(PlantError::Shape {
            matrix: "a row of A",
            rows: 1,
            columns: row.len(),
            wanted: format!("1 x {n}"),
        });
    }
    let space = StateSpace {
        a: DMatrix::from_row_iterator(n, n, a.iter().flatten().copied()),
        b: DVector::from_row_slice(b),
        c: DVector::from_row_slice(c),
    };
    space.validate()?;
    Ok(space)
}

fn located(text: &str, error: &toml::de::Error) -> ScenarioError {
    let at = error.span().map_or(0, |s| s.start).min(text.len());
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    ScenarioError::Text {
        line,
        column,
        message: error.message().to_owned(),
    }
}
