//! From a few numbers read off a relay test, without its record.
//!
//! Amplitude, period, levels and hysteresis do not tell the waveform. By the describing function the output is a sine;
//! the cycles of lags with dead time, which can be computed exactly, go from a triangle (an integrator) to a square (a
//! dead time) of the same amplitude. How far these disagree is the error that is told: little in a symmetric cycle,
//! much in another.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::evidence::{Trouble, TroubleKind};
use super::family::{Member, Seen};
use super::fourier::Point;
use super::gains::{self, Basis};
use super::number::{full_scale, number};
use super::record::RecordError;
use super::report::{Conventional, MeasuredTuning, Settings, Summary};
use super::ultimate::MeasuredUltimate;
use crate::message::Message;
use crate::msg;

/// The phase counts as -180 degrees up to this many degrees beside it.
const NEAR: f64 = 3.0;

/// Half periods that are said to differ have a ratio below this.
const UNEQUAL: f64 = 0.66;

/// How an amplitude was read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AmplitudeConvention {
    /// Half of peak to peak.
    #[default]
    Half,
    /// Peak to peak.
    PeakToPeak,
}

/// What was read off a relay test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Readings {
    /// Amplitude of the output, by `convention`; above 0.
    pub amplitude: f64,
    /// What it is.
    pub convention: AmplitudeConvention,
    /// Period, s; above 0.
    pub period: f64,
    /// Input while the relay is down and up; they differ.
    pub levels: [f64; 2],
    /// Half the distance of the relay's thresholds, in the unit of the output; at least 0.
    pub hysteresis: f64,
    /// Times up and down, s; equal where they are not known.
    pub half_periods: Option<[f64; 2]>,
    /// Whether they are known to differ, though not by how much.
    #[serde(default)]
    pub unequal: bool,
}

fn check(
    name: &'static str,
    value: f64,
    fits: bool,
    range: impl Into<Message>,
) -> Result<(), RecordError> {
    if value.is_finite() && fits {
        return Ok(());
    }
    Err(RecordError::Reading {
        name: Box::new(name.into()),
        value,
        range: Box::new(range.into()),
    })
}

impl Readings {
    /// Half of peak to peak.
    pub fn half_amplitude(&self) -> f64 {
        match self.convention {
            AmplitudeConvention::Half => self.amplitude,
            AmplitudeConvention::PeakToPeak => 0.5 * self.amplitude,
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`RecordError::Reading`] with the first out of its range.
    pub fn validate(&self) -> Result<(), RecordError> {
        check(
            "the amplitude",
            self.amplitude,
            self.amplitude > 0.0,
            "above 0",
        )?;
        check("the period", self.period, self.period > 0.0, "above 0 s")?;
        let [low, high] = self.levels;
        check("the lower level", low, true, "a number")?;
        check(
            "the upper level",
            high,
            high != low,
            "a number other than the lower level",
        )?;
        let a = self.half_amplitude();
        let range = msg!(
            "0 or more, and less than the amplitude of {} (half of peak to peak)",
            number(a)
        );
        check(
            "the hysteresis",
            self.hysteresis,
            (0.0..a).contains(&self.hysteresis),
            range,
        )?;
        if let Some([up, down]) = self.half_periods {
            let fits = up > 0.0 && down > 0.0 && ((up + down) / self.period - 1.0).abs() < 0.01;
            check(
                "the sum of the half periods",
                up + down,
                fits,
                "the period, of two times above 0 s",
            )?;
        }
        Ok(())
    }

    fn symmetric(&self) -> bool {
        self.half_periods.map_or(!self.unequal, |[up, down]| {
            (up - down).abs() < 0.02 * self.period
        })
    }

    fn seen(&self) -> Seen {
        Seen {
            amplitude: self.half_amplitude(),
            period: self.period,
            up: self.half_periods.map_or(0.5 * self.period, |[up, _]| up),
            hysteresis: self.hysteresis,
            swing: (self.levels[1] - self.levels[0]).abs(),
        }
    }

    /// The point, with the error of not knowing the waveform: of a symmetric cycle by the describing function, of
    /// another in the middle of all that its numbers leave open.
    fn point(&self) -> Option<Point> {
        if self.unequal && self.half_periods.is_none() {
            return None;
        }
        let seen = self.seen();
        let (family, sine) = (seen.family(), seen.sine());
        let span = |of: fn(&Member) -> f64| {
            family
                .iter()
                .chain(&sine)
                .map(of)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                    (low.min(v), high.max(v))
                })
        };
        let (magnitudes, phases) = (span(|m| m.magnitude), span(|m| m.phase_deg));
        let middle = match sine {
            Some(sine) if self.symmetric() => sine,
            _ if family.is_empty() => return None,
            _ => Member {
                magnitude: (magnitudes.0 * magnitudes.1).sqrt(),
                phase_deg: 0.5 * (phases.0 + phases.1),
            },
        };
        // Between the ends of the span every value is as likely.
        let error =
            |middle: f64, ends: (f64, f64)| (middle - ends.0).max(ends.1 - middle) / 3.0_f64.sqrt();
        Some(Point {
            omega: 2.0 * PI / self.period,
            magnitude: middle.magnitude,
            phase_deg: middle.phase_deg,
            std_error_magnitude: error(middle.magnitude, magnitudes),
            std_error_phase_deg: error(middle.phase_deg, phases),
        })
    }

    /// What the half periods do to it.
    fn asymmetric(&self) -> Option<Trouble> {
        let (number, text) = match self.half_periods {
            Some([up, down]) if !self.symmetric() => (
                up.min(down) / up.max(down),
                msg!(
                    "The half periods of {} s and {} s differ: 4d/(πa) does not hold for such a cycle. Lags with dead \
                     time that have this very cycle are spread all over the error of the point; the record of the \
                     test would narrow it down.",
                    number(up),
                    number(down)
                ),
            ),
            None if self.unequal => (
                UNEQUAL,
                "The half periods are known to differ, but not by how much: without them, amplitude and period do not \
                 determine the phase of the cycle, so neither a point nor gains follow. Give the times up and down, \
                 or the record of the test."
                    .into(),
            ),
            _ => return None,
        };
        Some(Trouble {
            kind: TroubleKind::Asymmetric,
            fatal: false,
            number,
            text,
        })
    }
}

/// What the numbers tell.
///
/// # Errors
/// A number out of its range.
pub fn tune_readings(
    readings: &Readings,
    settings: &Settings,
) -> Result<MeasuredTuning, RecordError> {
    readings.validate()?;
    let point = readings.point();
    let a = readings.half_amplitude();
    let swing = (readings.levels[1] - readings.levels[0]).abs();
    let near = |p: &&Point| (p.phase_deg + 180.0).abs() <= NEAR && readings.symmetric();
    let ultimate = point.as_ref().filter(near).map(|point| MeasuredUltimate {
        gain: 1.0 / point.magnitude,
        period: readings.period,
        std_error_gain: point.std_error_magnitude / point.magnitude.powi(2),
        std_error_period: readings.period * point.std_error_phase_deg.to_radians(),
    });
    let basis = Basis {
        model: None,
        models: &[],
        ultimate: ultimate.as_ref(),
        point: point.as_ref(),
        sampling: 0.0,
    };
    let scale = settings
        .full_scale
        .unwrap_or_else(|| full_scale(readings.levels[1]));
    let gains = gains::all(&basis, settings.form, scale);
    let half_periods = readings.half_periods.unwrap_or([0.5 * readings.period; 2]);
    let mut result = MeasuredTuning {
        name: "the numbers".into(),
        cycle: Some(Summary {
            period: readings.period,
            amplitude: a,
            half_periods,
            levels: readings.levels,
            hysteresis: readings.hysteresis,
            periods: 0,
        }),
        point,
        ultimate,
        conventional: Some(Conventional {
            gain: 2.0 * swing / (PI * a),
            period: readings.period,
        }),
        static_gain: None,
        models: Vec::new(),
        gains,
        troubles: readings.asymmetric().into_iter().collect(),
        notes: settings.notes.clone(),
        input_unit: "1".to_owned(),
        output_unit: "1".to_owned(),
        text: Message::default(),
    };
    if readings.half_periods.is_none() && !readings.unequal {
        result.notes.push(
            "The half periods were taken as equal; if they are not, give them: the point is then a different \
             one.".into(),
        );
    }
    result.notes.push(
        "From numbers alone the waveform is not known: the errors come from not knowing it. The record of the test \
         tells more, and gives models."
            .into(),
    );
    result.tell();
    Ok(result)
}
