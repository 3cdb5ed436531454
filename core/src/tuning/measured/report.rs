//! All that a measured relay test tells, in numbers and sentences.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::compared::Compared;
use super::cycle::{self, Cycle};
use super::evidence::{Evidence, Trouble};
use super::fourier::{self, Point};
use super::gains::{self, Basis, Form, TunedGains};
use super::number::{full_scale, number};
use super::record::{Record, RecordError};
use super::structure::{FittedModel, Value};
use super::trouble;
use super::ultimate::{self, MeasuredUltimate};
use crate::order::range;
use crate::uncertain::{with_error, with_uncertainty};

/// Part of the record that is taken for the plant's time where there is no cycle.
const PART: f64 = 0.1;

/// Hysteresis over amplitude from which less hysteresis is the remedy.
const MUCH_HYSTERESIS: f64 = 0.2;

/// A static gain is told with at most this relative error.
const GAIN_TOLD: f64 = 0.2;

/// Share of the motion that a model may miss and still be told whose gain is not.
const FOLLOWED: f64 = 0.5;

/// Where no rule has what it needs.
const NO_GAINS: &str =
    "No gains follow: neither the gain of a model nor a point of the curve is known well enough.";

/// What the user wants besides.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Form of the gains.
    pub form: Form,
    /// Largest value of the input; guessed from the record where it is not given.
    pub full_scale: Option<f64>,
    /// Set point of the test, in the unit of the output.
    pub target: Option<f64>,
    /// What else is to be said of it, as by the reader of a log.
    pub notes: Vec<String>,
}

/// The cycle in a few numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Period, s.
    pub period: f64,
    /// Half of peak to peak of the output.
    pub amplitude: f64,
    /// Time with the input up and down, s.
    pub half_periods: [f64; 2],
    /// Input while down and up.
    pub levels: [f64; 2],
    /// Half the distance of the thresholds, in the unit of the output.
    pub hysteresis: f64,
    /// Whole periods that were used; 0 where only numbers were given.
    pub periods: usize,
}

/// What the usual formula says, `4d/(pi a)` with the cycle's period: right only for a symmetric relay without hysteresis
/// and a sine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conventional {
    /// "Ultimate gain".
    pub gain: f64,
    /// "Ultimate period", s.
    pub period: f64,
}

/// All that a measured relay test tells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredTuning {
    /// Name of the record.
    pub name: String,
    /// The cycle, where there is one.
    pub cycle: Option<Summary>,
    /// The point of the Nyquist curve at the cycle's frequency.
    pub point: Option<Point>,
    /// Ultimate gain and period, where they follow.
    pub ultimate: Option<MeasuredUltimate>,
    /// What the usual formula says.
    pub conventional: Option<Conventional>,
    /// Static gain, where the record tells it.
    pub static_gain: Option<Value>,
    /// Models, the preferred first.
    pub models: Vec<FittedModel>,
    /// Gains by all rules that have what they need.
    pub gains: Vec<TunedGains>,
    /// What went wrong or misleads, the fatal first.
    pub troubles: Vec<Trouble>,
    /// What else is to be said.
    pub notes: Vec<String>,
    /// Unit of the input.
    pub input_unit: String,
    /// Unit of the output.
    pub output_unit: String,
    /// What it means, in sentences.
    pub text: String,
}

/// What the record tells.
///
/// # Errors
/// A record that cannot be used.
pub fn tune_record(record: &Record, settings: &Settings) -> Result<MeasuredTuning, RecordError> {
    record.validate()?;
    let found = cycle::find(record);
    // Where noise makes the switches, output and input of the cycle are that of the noise: it shows nothing of the plant.
    let chatters = found
        .as_ref()
        .is_some_and(|c| trouble::is_chatter(record, c));
    let (cycle, chatter) = if chatters {
        (None, found)
    } else {
        (found, None)
    };
    let scale = cycle.as_ref().map_or_else(|| time_of(record), |c| c.period);
    let mut compared = Compared::new(record, scale);
    let fits = compared.fit_all();
    let point = cycle
        .as_ref()
        .and_then(|c| fourier::point(record, c, &compared, fits.first()));
    let omega = point.map_or(2.0 * PI / scale, |p| p.omega);
    let ultimate = ultimate::ultimate(&fits, point.as_ref(), omega);
    let models: Vec<FittedModel> = fits.iter().map(|f| f.model.clone()).collect();
    let followed = models.first().is_some_and(follows);
    let basis = Basis {
        model: models.first(),
        models: if followed { &models } else { &[] },
        ultimate: ultimate.as_ref(),
        point: point.as_ref(),
        sampling: record.sampling(),
    };
    let (_, high) = range(&record.input);
    let gains = gains::all(
        &basis,
        settings.form,
        settings.full_scale.unwrap_or_else(|| full_scale(high)),
    );
    let troubles = trouble::find(&Evidence {
        record,
        cycle: cycle.as_ref(),
        chatter: chatter.as_ref(),
        fit: fits.first(),
        noise: fits.first().map_or(0.0, |f| f.noise),
        target: settings.target,
    });
    let conventional = cycle.as_ref().map(|c| Conventional {
        gain: 2.0 * (c.levels[1] - c.levels[0]) / (PI * c.amplitude),
        period: c.period,
    });
    let static_gain = models
        .first()
        .filter(|m| !m.structure.integrates())
        .map(|m| m.gain)
        .filter(is_told);
    let mut result = MeasuredTuning {
        name: record.name.clone(),
        cycle: cycle.as_ref().map(summary),
        point,
        ultimate,
        conventional,
        static_gain,
        models,
        gains,
        troubles,
        notes: settings.notes.clone(),
        input_unit: record.input_unit.clone(),
        output_unit: record.output_unit.clone(),
        text: String::new(),
    };
    result.tell();
    Ok(result)
}

fn is_told(gain: &Value) -> bool {
    gain.std_error <= GAIN_TOLD * gain.value.abs()
}

/// Whether a model is more of the record than what was left for it by chance.
fn follows(model: &FittedModel) -> bool {
    model.left <= FOLLOWED || is_told(&model.gain)
}

/// A time in the order of the plant's, s: that of a round of the output, or a part of the record.
fn time_of(record: &Record) -> f64 {
    match cycle::rounds(record).len() {
        0 | 1 => PART * record.span(),
        rounds => record.span() / rounds as f64,
    }
}

fn summary(cycle: &Cycle) -> Summary {
    Summary {
        period: cycle.period,
        amplitude: cycle.amplitude,
        half_periods: cycle.half_periods,
        levels: cycle.levels,
        hysteresis: cycle.hysteresis.max(0.0),
        periods: cycle.periods,
    }
}

impl MeasuredTuning {
    /// The first fatal cause, in words.
    pub fn stall(&self) -> Option<&str> {
        self.troubles
            .iter()
            .find(|t| t.fatal)
            .map(|t| t.text.as_str())
    }

    /// Unit of the gain from input to output.
    pub fn gain_unit(&self) -> String {
        match (self.output_unit.as_str(), self.input_unit.as_str()) {
            (out, "1") => out.to_owned(),
            (out, input) => format!("{out}/{input}"),
        }
    }

    /// Puts it into words.
    pub(super) fn tell(&mut self) {
        self.text = self.sentences().join(" ");
    }

    /// The same, one by one: the point, the ultimate gain, the model, what went wrong, and notes.
    pub fn sentences(&self) -> Vec<String> {
        let mut sentences: Vec<String> = self.of_point().into_iter().collect();
        sentences.extend(self.of_ultimate());
        sentences.extend(self.of_formula());
        if let Some(model) = self.models.first() {
            sentences.push(self.of_model(model));
        }
        if self.gains.is_empty() {
            sentences.push(NO_GAINS.to_owned());
        }
        sentences.extend(self.troubles.iter().map(|t| t.text.clone()));
        sentences.extend(self.notes.iter().cloned());
        sentences
    }

    fn of_point(&self) -> Option<String> {
        let (cycle, point) = (self.cycle.as_ref()?, self.point.as_ref()?);
        if !point.is_known() {
            return Some(format!(
                "The cycle (period {} s, amplitude {}, half of peak to peak) does not show the plant: |P| at {} rad/s is \
                 not determined by this record.",
                number(cycle.period),
                number(cycle.amplitude),
                number(point.omega),
            ));
        }
        Some(format!(
            "The cycle (period {} s, amplitude {}, half of peak to peak) shows the plant at {} rad/s: |P| {}, phase {} \
             degrees.",
            number(cycle.period),
            number(cycle.amplitude),
            number(point.omega),
            with_error(
                point.magnitude,
                point.std_error_magnitude,
                &self.gain_unit()
            ),
            with_uncertainty(point.phase_deg, point.std_error_phase_deg)
                .unwrap_or_else(|| number(point.phase_deg)),
        ))
    }

    /// Ultimate gain and period, or why they do not follow and what would help.
    fn of_ultimate(&self) -> Option<String> {
        if let Some(u) = &self.ultimate {
            return Some(format!(
                "Ultimate gain {}, ultimate period {}.",
                with_error(u.gain, u.std_error_gain, "1"),
                with_error(u.period, u.std_error_period, "s"),
            ));
        }
        let (point, cycle) = (self.point.as_ref()?, self.cycle.as_ref()?);
        if !point.is_known() {
            return Some("The ultimate gain does not follow.".to_owned());
        }
        let off = point.phase_deg + 180.0;
        let remedy = if cycle.hysteresis > MUCH_HYSTERESIS * cycle.amplitude && off > 0.0 {
            format!(
                "less hysteresis (it is {}, the amplitude {}) brings the cycle nearer to it",
                number(cycle.hysteresis),
                number(cycle.amplitude)
            )
        } else if self.models.is_empty() {
            "the record of the test would show how the curve goes on".to_owned()
        } else if off < 0.0 {
            "a relay that switches sooner, without delay, brings the cycle nearer to it".to_owned()
        } else {
            "a longer test, a bias that makes the half periods differ, or a second test with another hysteresis or an \
             added delay settles it"
                .to_owned()
        };
        Some(format!(
            "The ultimate gain does not follow: the phase of the cycle is {} degrees from -180, and how the curve goes on \
             from there is not known well enough; {remedy}.",
            number(off.abs()),
        ))
    }

    /// What the usual formula makes of the same cycle.
    fn of_formula(&self) -> Option<String> {
        let formula = self.conventional?;
        Some(format!(
            "4d/(pi a), which is right for a symmetric cycle without hysteresis alone, would say {} at {} s.",
            number(formula.gain),
            number(formula.period)
        ))
    }

    fn of_model(&self, model: &FittedModel) -> String {
        let seconds = |v: &Value| with_error(v.value, v.std_error, "s");
        let gain = with_error(model.gain.value, model.gain.std_error, &self.gain_unit());
        let mut parts = vec![format!("gain {gain}")];
        let lags = model.time_constants.iter();
        parts.extend(lags.map(|t| format!("time constant {}", seconds(t))));
        parts.extend(model.zero.iter().map(|z| format!("zero {}", seconds(z))));
        parts.push(format!("dead time {}", seconds(&model.dead_time)));
        if !follows(model) {
            return format!(
                "No model follows the record: the one that comes nearest, {}, misses {} % of the motion of the output.",
                model.structure.name(),
                number(100.0 * model.left),
            );
        }
        format!(
            "The record prefers {}: {}. It misses {} % of the motion of the output.",
            model.structure.name(),
            parts.join(", "),
            number(100.0 * model.left),
        )
    }
}
