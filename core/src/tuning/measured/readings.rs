//! From a few numbers read off a relay test, without its record.
//!
//! Amplitude, period, levels and hysteresis do not tell the waveform. By the describing function the output is a sine;
//! the cycles of a lag with dead time, which can be computed exactly, go from a triangle (an integrator) to a square (a
//! dead time) of the same amplitude. How far these disagree is the error that is told.

use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::evidence::{Trouble, TroubleKind};
use super::fourier::Point;
use super::gains::{self, Basis};
use super::number::{full_scale, number};
use super::record::RecordError;
use super::report::{Conventional, MeasuredTuning, Settings, Summary};
use super::ultimate::MeasuredUltimate;

/// Dead times over time constants of the lags whose cycles are compared.
const RATIOS: [f64; 2] = [0.02, 8.0];
const RATIOS_TRIED: usize = 60;

/// The phase counts as -180 degrees up to this many degrees beside it.
const NEAR: f64 = 3.0;

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
}

fn check(name: &str, value: f64, fits: bool, range: &str) -> Result<(), RecordError> {
    if value.is_finite() && fits {
        return Ok(());
    }
    Err(RecordError::Reading {
        name: name.to_owned(),
        value,
        range: range.to_owned(),
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
        let range = format!(
            "0 or more, and less than the amplitude of {} (half of peak to peak)",
            number(a)
        );
        check(
            "the hysteresis",
            self.hysteresis,
            (0.0..a).contains(&self.hysteresis),
            &range,
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
        self.half_periods
            .is_none_or(|[up, down]| (up - down).abs() < 0.02 * self.period)
    }

    /// The point by the describing function, with the error of not knowing the waveform.
    fn point(&self) -> Point {
        let a = self.half_amplitude();
        let omega = 2.0 * PI / self.period;
        let up = self.half_periods.map_or(0.5, |[up, _]| up / self.period);
        let push = (self.levels[1] - self.levels[0]).abs() * libm::sin(PI * up);
        let magnitude = PI * a / (2.0 * push);
        let phase = -180.0 + libm::asin(self.hysteresis / a).to_degrees();
        let family: Vec<(f64, f64)> = (0..RATIOS_TRIED)
            .filter_map(|i| {
                let share = i as f64 / (RATIOS_TRIED - 1) as f64;
                let ratio = RATIOS[0] * libm::pow(RATIOS[1] / RATIOS[0], share);
                let p = lag_with_dead_time(ratio, a, self.hysteresis, self.period)?;
                let arg = libm::atan2(p.im, p.re).to_degrees();
                let arg = if arg > 0.0 { arg - 360.0 } else { arg };
                // For an input of +-1; a sine of the amplitude would have pi a/4.
                Some((p.norm() / (0.25 * PI * a), arg - phase))
            })
            .collect();
        let spread = |of: fn(&(f64, f64)) -> f64, middle: f64| {
            // Between the ends of the range every value is as likely.
            family
                .iter()
                .map(|p| (of(p) - middle).abs())
                .fold(0.0, f64::max)
                / 3.0_f64.sqrt()
        };
        Point {
            omega,
            magnitude,
            phase_deg: phase,
            std_error_magnitude: magnitude * spread(|p| p.0, 1.0),
            std_error_phase_deg: spread(|p| p.1, 0.0),
        }
    }
}

/// `P(jw)` of the lag with dead time, `L/T = ratio`, that oscillates with amplitude `a` and this period under a symmetric
/// relay of +-1 with hysteresis `eps`: `a/K = 1 - (1 - eps/K) e^(-L/T)`, `period/2 = T ln((2 e^(L/T) - 1 + eps/K)/(1 - eps/K))`.
fn lag_with_dead_time(ratio: f64, a: f64, eps: f64, period: f64) -> Option<Complex<f64>> {
    let decay = libm::exp(-ratio);
    let amplitude = |e: f64| 1.0 - (1.0 - e) * decay;
    // eps/a = e/amplitude(e) is linear in e: e (1 - (eps/a) decay) = (eps/a)(1 - decay).
    let share = eps / a;
    let e = share * (1.0 - decay) / (1.0 - share * decay);
    let time_constant = 0.5 * period / libm::log((2.0 / decay - 1.0 + e) / (1.0 - e));
    let gain = a / amplitude(e);
    let omega = 2.0 * PI / period;
    let (sin, cos) = libm::sincos(-omega * ratio * time_constant);
    let p = Complex::new(cos, sin) * gain / Complex::new(1.0, omega * time_constant);
    p.norm().is_finite().then_some(p)
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
    let near = (point.phase_deg + 180.0).abs() <= NEAR && readings.symmetric();
    let ultimate = near.then(|| MeasuredUltimate {
        gain: 1.0 / point.magnitude,
        period: readings.period,
        std_error_gain: point.std_error_magnitude / point.magnitude.powi(2),
        std_error_period: readings.period * point.std_error_phase_deg.to_radians(),
    });
    let basis = Basis {
        model: None,
        models: &[],
        ultimate: ultimate.as_ref(),
        point: Some(&point),
        sampling: 0.0,
    };
    let scale = settings
        .full_scale
        .unwrap_or_else(|| full_scale(readings.levels[1]));
    let gains = gains::all(&basis, settings.form, scale);
    let mut troubles = Vec::new();
    if !readings.symmetric()
        && let Some([up, down]) = readings.half_periods
    {
        let ratio = up.min(down) / up.max(down);
        troubles.push(Trouble {
            kind: TroubleKind::Asymmetric,
            fatal: false,
            number: ratio,
            text: format!(
                "The half periods of {} s and {} s differ: 4d/(pi a) does not hold for such a cycle, and its phase is \
                 not that of the describing function; give the record of the test instead.",
                number(up),
                number(down)
            ),
        });
    }
    let half_periods = readings.half_periods.unwrap_or([0.5 * readings.period; 2]);
    let mut result = MeasuredTuning {
        name: "the numbers".to_owned(),
        cycle: Some(Summary {
            period: readings.period,
            amplitude: a,
            half_periods,
            levels: readings.levels,
            hysteresis: readings.hysteresis,
            periods: 0,
        }),
        point: Some(point),
        ultimate,
        conventional: Some(Conventional {
            gain: 2.0 * swing / (PI * a),
            period: readings.period,
        }),
        static_gain: None,
        models: Vec::new(),
        gains,
        troubles,
        notes: settings.notes.clone(),
        input_unit: "1".to_owned(),
        output_unit: "1".to_owned(),
        text: String::new(),
    };
    result.notes.push(
        "From numbers alone the waveform is not known: the errors are those of not knowing it. The record of the test \
         tells more, and gives models."
            .to_owned(),
    );
    result.tell();
    Ok(result)
}
