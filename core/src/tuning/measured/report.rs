//! All that a measured relay test tells, in numbers and sentences.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::compared::Compared;
use super::cycle::{self, Cycle};
use super::ending;
use super::evidence::{Evidence, Trouble, TroubleKind};
use super::fourier::{self, Point};
use super::gains::{self, Basis, Form, TunedGains};
use super::number::{full_scale, number};
use super::record::{Record, RecordError};
use super::structure::{FittedModel, Value};
use super::trouble;
use super::ultimate::{self, MeasuredUltimate};
use crate::message::Message;
use crate::msg;
use crate::order::range;
use crate::uncertain::{is_told, with_error, with_uncertainty};

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

const DENIED: &str = "No gains follow: a controller made the input, so that none of the models is that of the plant alone.";
const UNDETERMINED: &str = "No gains follow: a rule needs gain, time constant and dead time, and this record does not determine all of them.";

/// What the user wants besides.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Form of the gains.
    pub form: Form,
    /// Largest value of the input; guessed from the record where it is not given.
    pub full_scale: Option<f64>,
    /// Set point of the test, in the unit of the output.
    pub target: Option<f64>,
    /// Half the distance of the thresholds of the test, in the unit of the output.
    pub hysteresis: Option<f64>,
    /// What else is to be said of it, as by the reader of a log.
    pub notes: Vec<Message>,
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

/// What the usual formula says, `4d/(pi a)` with the cycle's period: right only for a symmetric relay without
/// hysteresis and a sine.
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
    pub notes: Vec<Message>,
    /// Unit of the input.
    pub input_unit: String,
    /// Unit of the output.
    pub output_unit: String,
    /// What it means, in sentences.
    pub text: Message,
}

/// What the record tells.
///
/// # Errors
/// A record that cannot be used.
pub fn tune_record(record: &Record, settings: &Settings) -> Result<MeasuredTuning, RecordError> {
    record.validate()?;
    let controller = trouble::of_controller(record);
    // A relay that stops switching is told; the cycle is that before.
    let switched = || cycle::find(record).and_then(|c| ending::stop(record, &c));
    let stop = if controller.is_none() {
        switched()
    } else {
        None
    };
    let kept = stop.map(|s| record.first(s.before));
    let kept = kept.filter(|before| before.validate().is_ok());
    let whole = record;
    let record = kept.as_ref().unwrap_or(record);
    let [mut cycle, chatter] = match controller {
        Some(_) => [None, None],
        None => cycle_and_chatter(record),
    };
    let scale = cycle.as_ref().map_or_else(|| time_of(record), |c| c.period);
    let mut compared = Compared::new(record, scale);
    let fits = if cycle.is_some() {
        compared.fit_all()
    } else {
        compared.fit_all_without_cycle()
    };
    // A plant of negative gain is the same loop with the input turned: its relay goes up where the output is high.
    let sign = fits.first().map_or(1.0, |f| f.model.gain.value.signum());
    if let Some(cycle) = &mut cycle {
        cycle.hysteresis *= sign;
    }
    let point = cycle
        .as_ref()
        .and_then(|c| fourier::point(record, c, &compared, fits.first()));
    let omega = point.map_or(2.0 * PI / scale, |p| p.omega);
    let ultimate = ultimate::ultimate(&fits, point.as_ref(), omega);
    let models: Vec<FittedModel> = fits.iter().map(|f| f.model.clone()).collect();
    let static_gain = models.first().and_then(static_gain);
    let mut troubles = trouble::find(&Evidence {
        record,
        cycle: cycle.as_ref(),
        chatter: chatter.as_ref(),
        controller,
        fit: fits.first(),
        noise: fits.first().map_or(0.0, |f| f.noise),
        target: settings.target,
        hysteresis: settings.hysteresis,
        told: ultimate.is_some() || static_gain.is_some(),
    });
    if let Some(stop) = stop.filter(|_| kept.is_some()) {
        troubles.insert(0, ending::stopped(whole, &stop));
        troubles.sort_by_key(|t| !t.fatal);
    }
    // What a controller made is as much of it as of the plant.
    let denied = troubles
        .iter()
        .any(|t| t.kind == TroubleKind::Controller && t.fatal);
    let (ultimate, static_gain) = if denied {
        (None, None)
    } else {
        (ultimate, static_gain)
    };
    let followed = !denied && models.first().is_some_and(follows);
    let basis = Basis {
        model: models.first(),
        models: if followed { &models } else { &[] },
        ultimate: ultimate.as_ref(),
        point: point.as_ref().filter(|_| !denied),
        sampling: record.sampling(),
    };
    let (_, high) = range(&record.input);
    let gains = gains::all(
        &basis,
        settings.form,
        settings.full_scale.unwrap_or_else(|| full_scale(high)),
    );
    let conventional = cycle.as_ref().map(|c| Conventional {
        gain: sign * 2.0 * (c.levels[1] - c.levels[0]) / (PI * c.amplitude),
        period: c.period,
    });
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
        text: Message::default(),
    };
    result.tell();
    Ok(result)
}

/// The cycle of a record, or in its place that which noise makes: its output and input show nothing of the plant.
fn cycle_and_chatter(record: &Record) -> [Option<Cycle>; 2] {
    let found = cycle::find(record);
    let chatters = (found.as_ref()).is_some_and(|c| trouble::is_chatter(record, c));
    if chatters {
        [None, found]
    } else {
        [found, None]
    }
}

/// The static gain of a model, where it has one and the record tells it.
fn static_gain(model: &FittedModel) -> Option<Value> {
    Some(model.gain).filter(|gain| !model.structure.integrates() && tells(gain))
}

fn tells(gain: &Value) -> bool {
    gain.std_error <= GAIN_TOLD * gain.value.abs()
}

/// Whether a model is more of the record than what was left for it by chance.
fn follows(model: &FittedModel) -> bool {
    model.left <= FOLLOWED || tells(&model.gain)
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
    /// -1 where the output falls with a rising input, else 1.
    fn sign(&self) -> f64 {
        let falls = self.models.first().is_some_and(|m| m.gain.value < 0.0);
        if falls { -1.0 } else { 1.0 }
    }

    /// The first fatal cause, in words.
    pub fn stall(&self) -> Option<&Message> {
        self.troubles.iter().find(|t| t.fatal).map(|t| &t.text)
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
        self.text = Message::list(" ", self.sentences());
    }

    /// The same, one by one: the point, the ultimate gain, the model, what went wrong, and notes.
    pub fn sentences(&self) -> Vec<Message> {
        let mut sentences: Vec<Message> = self.of_point().into_iter().collect();
        sentences.extend(self.of_turned());
        sentences.extend(self.of_ultimate());
        sentences.extend(self.of_formula());
        if let Some(model) = self.models.first() {
            sentences.push(self.of_model(model));
        }
        if self.gains.is_empty() {
            sentences.push(self.no_gains().into());
        }
        sentences.extend(self.troubles.iter().map(|t| t.text.clone()));
        sentences.extend(self.notes.iter().cloned());
        sentences
    }

    fn of_point(&self) -> Option<Message> {
        let (cycle, point) = (self.cycle.as_ref()?, self.point.as_ref()?);
        if !point.is_known() {
            return Some(msg!(
                "The cycle (period {} s, amplitude {}, half of peak to peak) does not show the plant: |P| at {} rad/s \
                 is not determined by this record.",
                number(cycle.period),
                number(cycle.amplitude),
                number(point.omega)
            ));
        }
        Some(msg!(
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
                .unwrap_or_else(|| number(point.phase_deg))
        ))
    }

    /// Why there are none.
    fn no_gains(&self) -> &'static str {
        let known = |m: &FittedModel| follows(m) && m.gain.is_known();
        if self
            .troubles
            .iter()
            .any(|t| t.kind == TroubleKind::Controller)
        {
            DENIED
        } else if self.models.first().is_some_and(known) {
            UNDETERMINED
        } else {
            NO_GAINS
        }
    }

    /// Where the point is for a controller of a plant of negative gain.
    fn of_turned(&self) -> Option<Message> {
        let point = self.point.filter(|p| self.sign() < 0.0 && p.is_known())?;
        Some(msg!(
            "Its gain is negative: with the sign of the input flipped, as its controller flips it, the phase is {} \
             degrees.",
            number(point.turned().phase_deg)
        ))
    }

    /// Ultimate gain and period, or why they do not follow and what would help.
    fn of_ultimate(&self) -> Option<Message> {
        if let Some(u) = &self.ultimate {
            return Some(msg!(
                "Ultimate gain {}, ultimate period {}.",
                with_error(u.gain, u.std_error_gain, "1"),
                with_error(u.period, u.std_error_period, "s")
            ));
        }
        let (point, cycle) = (self.point.as_ref()?, self.cycle.as_ref()?);
        if !point.is_known() {
            return Some("The ultimate gain does not follow.".into());
        }
        let off = point.beyond(self.sign());
        let held = (self.troubles.iter()).any(|t| t.kind == TroubleKind::MinimumTime);
        let remedy: Message = if held {
            "a relay without a minimum time brings the cycle nearer to it".into()
        } else if cycle.hysteresis > MUCH_HYSTERESIS * cycle.amplitude && off > 0.0 {
            msg!(
                "less hysteresis (it is {}, the amplitude {}) brings the cycle nearer to it",
                number(cycle.hysteresis),
                number(cycle.amplitude)
            )
        } else if self.models.is_empty() {
            "the record of the test would show how the curve goes on".into()
        } else if off < 0.0 {
            "a relay that switches sooner, without delay, brings the cycle nearer to it".into()
        } else {
            "a longer test, a bias that makes the half periods differ, or a second test with another hysteresis or an \
             added delay settles it"
                .into()
        };
        Some(msg!(
            "The ultimate gain does not follow: the phase of the cycle is {} degrees from -180, and how the curve goes \
             on from there is not known well enough; {}.",
            number(off.abs()),
            remedy
        ))
    }

    /// What the usual formula makes of the same cycle.
    fn of_formula(&self) -> Option<Message> {
        let formula = self.conventional?;
        Some(msg!(
            "4d/(πa), which holds only for a symmetric cycle without hysteresis, would give {} at {} s.",
            number(formula.gain),
            number(formula.period)
        ))
    }

    fn of_model(&self, model: &FittedModel) -> Message {
        let unit = self.gain_unit();
        let lags = model.time_constants.iter();
        let all = std::iter::once(("gain", model.gain, unit.as_str()))
            .chain(lags.map(|t| ("time constant", *t, "s")))
            .chain(model.zero.iter().map(|z| ("zero", *z, "s")))
            .chain([("dead time", model.dead_time, "s")]);
        let (told, untold): (Vec<_>, Vec<_>) =
            all.partition(|(_, v, _)| is_told(v.value, v.std_error));
        let parts = told
            .iter()
            .map(|(name, v, unit)| msg!("{} {}", name, with_error(v.value, v.std_error, unit)));
        let parts = Message::list(", ", parts);
        if !follows(model) {
            return msg!(
                "No model follows the record: the one that comes nearest, {}, misses {} % of the motion of the output.",
                model.structure.name(),
                number(100.0 * model.left)
            );
        }
        let (name, left) = (model.structure.name(), number(100.0 * model.left));
        if told.is_empty() {
            return msg!(
                "The record prefers {}, but determines none of its numbers. It misses {} % of the motion of \
                 the output.",
                name,
                left
            );
        }
        if untold.is_empty() {
            return msg!(
                "The record prefers {}: {}. It misses {} % of the motion of the output.",
                name,
                parts,
                left
            );
        }
        // Each name once, however many time constants there are.
        let mut names: Vec<&'static str> = untold.iter().map(|u| u.0).collect();
        names.dedup();
        msg!(
            "The record prefers {}: {}; not determined by this record: {}. It misses {} % of the motion of the \
             output.",
            name,
            parts,
            Message::list(", ", names),
            left
        )
    }
}
