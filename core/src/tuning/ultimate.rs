//! Equation (9): ultimate gain and period from a relay test, beside the true ones.
//!
//! **Amplitude** means half of peak to peak everywhere. A program that puts peak to peak into equation
//! (9) reports half of the gain; one that takes peak to peak of the relay for its gain reports twice it.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::experiment::RelayTest;
use super::scan;
use crate::limit_cycle::{Cycle, typical_frequency};
use crate::message::{Message, fixed};
use crate::msg;
use crate::plant::TransferFunction;
use crate::relay::Relay;

/// The amplitude convention of every result.
pub const AMPLITUDE_CONVENTION: &str =
    "amplitude is half of peak to peak, for the output and for the relay";

/// Ultimate gain and period.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ultimate {
    /// `K_u`: the proportional gain at which the loop oscillates, unit of the input over unit of the output.
    pub gain: f64,
    /// `T_u`, s.
    pub period: f64,
}

/// A frequency at which the Nyquist curve crosses the negative real axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Gain that moves the crossing to -1.
    pub gain: f64,
    /// Whether the phase falls through -180 degrees with rising frequency.
    pub falling: bool,
}

/// What a relay test says about the ultimate point, and what is true; errors are relative.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UltimateReport {
    /// How amplitudes are counted.
    pub amplitude_convention: String,
    /// By `K_u = |N(a)| = 4k/(pi a)`, equation (9), whatever the hysteresis.
    pub by_relay: Ultimate,
    /// By `-1/Re(-1/N(a)) = 4k/(pi sqrt(a^2 - eps^2))`: where the line of the relay, moved along the imaginary axis,
    /// would meet the real one (Åström and Hägglund 1984). Not the paper's (9).
    pub on_real_axis: Ultimate,
    /// From the plant's phase crossover; `None` where its phase never falls through -180 degrees.
    pub truth: Option<Ultimate>,
    /// Error of `by_relay`'s gain.
    pub by_relay_error: Option<f64>,
    /// Error of `on_real_axis`' gain.
    pub on_real_axis_error: Option<f64>,
    /// Error of the measured period.
    pub period_error: Option<f64>,
}

/// `|N(a)| = 4k/(pi a)`, equation (9), whatever the hysteresis: `gain` of the relay, amplitude `a` (half of peak to
/// peak).
///
/// ```
/// // The ideal relay around e^(-0.5 s)/(s + 1): amplitude 1 - e^(-0.5).
/// let a = 1.0 - (-0.5_f64).exp();
/// assert!((hysteron_core::tuning::ultimate_gain(1.0, a) - 3.236).abs() < 5e-4);
/// ```
pub fn ultimate_gain(gain: f64, amplitude: f64) -> f64 {
    4.0 * gain / (PI * amplitude)
}

/// `4k/(pi sqrt(a^2 - eps^2))`: the inverse of the real part of `-1/N(a)` (Åström and Hägglund 1984); the paper's (9)
/// is [`ultimate_gain`].
pub fn gain_on_real_axis(gain: f64, amplitude: f64, hysteresis: f64) -> f64 {
    let (a, eps) = (amplitude, hysteresis);
    ultimate_gain(gain, ((a - eps) * (a + eps)).max(0.0).sqrt())
}

/// All crossings of the negative real axis by the Nyquist curve of a valid `plant` up to 100 times its
/// fastest pole or zero, lowest frequency first; integrators and dead time included.
///
/// They are the sign changes of `Im P(jw)` where `Re P(jw) < 0`: no phase has to be unwrapped.
pub fn crossings(plant: &TransferFunction) -> Vec<Crossing> {
    let (low, high) = scan::range(&[&plant.numerator, &plant.denominator], plant.dead_time);
    scan::roots(&scan::grid(low, high), |w| plant.response(w).im)
        .into_iter()
        .filter_map(|(omega, rising)| {
            let p = plant.response(omega);
            // A sign change at a pole on the axis is a jump, not a crossing.
            (p.re < 0.0 && p.im.abs() < 1e-6 * p.re.abs()).then(|| Crossing {
                omega,
                gain: -1.0 / p.re,
                falling: rising,
            })
        })
        .collect()
}

/// The true ultimate gain and period of a valid `plant`: the upper one of its [`stability_limits`].
pub fn true_ultimate(plant: &TransferFunction) -> Option<Ultimate> {
    stability_limits(plant).upper
}

/// Gains between which the loop is stable, proportional controller and negative feedback.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StabilityLimits {
    /// Below it the loop is unstable: a conditionally stable or an unstable plant.
    pub lower: Option<Ultimate>,
    /// Above it the loop is unstable: the ultimate gain.
    pub upper: Option<Ultimate>,
    /// What the loop is at every gain where there is no limit.
    pub without: Without,
}

/// A loop whose stability does not depend on the gain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Without {
    /// Stable at every gain.
    #[default]
    Stable,
    /// Unstable at every gain.
    Unstable,
    /// On the limit of stability at every gain, as `1/s^2` is.
    OnTheLimit,
}

impl StabilityLimits {
    /// Both in words.
    pub fn text(&self) -> Message {
        let at = |u: &Ultimate| {
            if u.period.is_finite() {
                msg!(
                    "{} at a period of {} s",
                    fixed(u.gain, 4),
                    fixed(u.period, 4)
                )
            } else {
                msg!("{} at frequency 0", fixed(u.gain, 4))
            }
        };
        match (&self.lower, &self.upper) {
            (None, Some(upper)) => msg!("The plant's true Ku is {} (-180°).", at(upper)),
            (Some(lower), Some(upper)) => msg!(
                "The loop is stable only between two gains: the lower limit is {}; the upper one, the true Ku, is {}.",
                at(lower),
                at(upper)
            ),
            (Some(lower), None) => msg!(
                "The loop is stable only above a gain of {}; there is no true Ku.",
                at(lower)
            ),
            (None, None) => match self.without {
                Without::Stable => {
                    "With a proportional controller the loop is stable at every gain: the plant has no true Ku."
                }
                Without::Unstable => {
                    "With a proportional controller no gain makes the loop stable: the plant has no true Ku."
                }
                Without::OnTheLimit => {
                    "With a proportional controller every gain leaves the loop at the limit of stability: the plant \
                     has no Ku of its own."
                }
            }
            .into(),
        }
    }
}

/// The least range of gains in which a valid `plant` is stable, by the Nyquist criterion: from crossing to crossing of
/// the negative real axis a pair of poles goes to the right (falling phase) or comes back. A real pole of an unstable
/// plant crosses at frequency 0, so that the period of such a limit is infinite. Empty where no gain is stable.
pub fn stability_limits(plant: &TransferFunction) -> StabilityLimits {
    let mut crossings = crossings(plant);
    let gain = plant.dc_gain();
    if gain.is_finite() && gain < 0.0 {
        crossings.push(Crossing {
            omega: 0.0,
            gain: -1.0 / gain,
            falling: plant.response(NEAR_ZERO * typical_frequency(plant)).im > 0.0,
        });
    }
    crossings.sort_by(|a, b| a.gain.total_cmp(&b.gain));
    let mut unstable = unstable_at_small_gain(plant);
    let ultimate = |c: &Crossing| Ultimate {
        gain: c.gain,
        period: 2.0 * PI / c.omega,
    };
    let mut limits = StabilityLimits::default();
    let mut stable = unstable == 0;
    for crossing in &crossings {
        unstable += match (crossing.omega == 0.0, crossing.falling) {
            (true, true) => 1,
            (true, false) => -1,
            (false, true) => 2,
            (false, false) => -2,
        };
        match (stable, unstable == 0) {
            (false, true) => {
                limits.lower = Some(ultimate(crossing));
                stable = true;
            }
            (true, false) => {
                limits.upper = Some(ultimate(crossing));
                return limits;
            }
            _ => {}
        }
    }
    if limits.lower.is_none() {
        limits.without = without_limit(plant, stable);
    }
    limits
}

/// What a loop without limits is, by its poles at a gain of the plant's size; with a dead time it has none that could
/// be computed, and is what it is at a small gain.
fn without_limit(plant: &TransferFunction, stable_at_small_gain: bool) -> Without {
    if plant.dead_time > 0.0 {
        return if stable_at_small_gain {
            Without::Stable
        } else {
            Without::Unstable
        };
    }
    let frequency = typical_frequency(plant);
    let gain = 1.0 / plant.response(frequency).norm();
    let gain = if gain.is_finite() && gain > 0.0 {
        gain
    } else {
        1.0
    };
    let (num, mut den) = (&plant.numerator, plant.denominator.clone());
    let shift = den.len().saturating_sub(num.len());
    for (d, n) in den.iter_mut().skip(shift).zip(num) {
        *d += gain * n;
    }
    let closed = TransferFunction::new(&[1.0], &den, 0.0).poles();
    let right = closed
        .iter()
        .map(|p| p.re)
        .fold(f64::NEG_INFINITY, f64::max);
    if right.abs() <= ON_AXIS * frequency {
        Without::OnTheLimit
    } else if right < 0.0 {
        Without::Stable
    } else {
        Without::Unstable
    }
}

/// Real part of a pole, as share of the typical frequency, that is none but round-off; a double root has half of the
/// digits.
const ON_AXIS: f64 = 1e-7;

/// Share of the typical frequency at which a Nyquist curve leaves frequency 0.
const NEAR_ZERO: f64 = 1e-4;

/// Poles of the closed loop with a positive real part at a gain next to nothing: those of the plant, and what its
/// integrators become, which their phase tells.
fn unstable_at_small_gain(plant: &TransferFunction) -> i32 {
    let poles = plant.poles();
    let unstable = poles.iter().filter(|p| p.re > 0.0).map(|_| 1).sum::<i32>();
    let integrators = poles.iter().filter(|p| p.norm() == 0.0).count();
    if integrators == 0 {
        return unstable;
    }
    // The phase of K/s^n near 0 is -n 90 degrees, or that and 180 degrees; the arc at infinity goes round from there.
    let sign = if plant.dc_gain() < 0.0 { PI } else { 0.0 };
    let begin = -0.5 * PI * integrators as f64 - sign;
    unstable + 2 * ((PI - begin) / (2.0 * PI) - ROUNDING).floor() as i32
}

/// A phase that is a whole number of turns but for rounding has not gone beyond it.
const ROUNDING: f64 = 1e-9;

/// What a limit cycle shows of its plant: the point of the Nyquist curve at the cycle's frequency, exact whatever the
/// harmonics, since each passes a linear plant on its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShownPoint {
    /// Angular frequency of the cycle, rad/s.
    pub omega: f64,
    /// `|P(jw)|`.
    pub magnitude: f64,
    /// Phase of `P(jw)` with its dead time, degrees, above -360 and up to 0.
    pub phase_deg: f64,
}

impl ShownPoint {
    /// The point at the frequency of a cycle with this period, s.
    pub fn new(plant: &TransferFunction, period: f64) -> Self {
        let omega = 2.0 * PI / period;
        let p = plant.response(omega);
        let degrees = p.arg().to_degrees();
        Self {
            omega,
            magnitude: p.norm(),
            phase_deg: if degrees > 0.0 {
                degrees - 360.0
            } else {
                degrees
            },
        }
    }
}

/// Ultimate gain by the relay, and what stands beside it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelayGain {
    /// By equation (9) with a symmetric relay; else first harmonic of the relay's output over that of its input.
    pub by_relay: Ultimate,
    /// What the cycle shows, exactly.
    pub shown: ShownPoint,
    /// The plant's own limits.
    pub limits: StabilityLimits,
    /// All of it in words, with the remedy.
    pub text: Message,
}

/// Phase within so many degrees of -180 that counts as the ultimate point itself.
const AT_ULTIMATE: f64 = 5.0;

/// The ultimate gain that a limit cycle of `plant` under `relay` gives, with what the cycle shows and the truth.
///
/// An asymmetric relay pushes for unequal times, and `4k/(pi a)` does not hold for it: the ratio of the first harmonics
/// of its output and of the plant's does, and that is `1/|P(jw)|`.
pub fn relay_gain(plant: &TransferFunction, relay: &Relay, cycle: &Cycle) -> RelayGain {
    let shown = ShownPoint::new(plant, cycle.period);
    let symmetric = relay.is_symmetric();
    let gain = if symmetric {
        ultimate_gain(relay.gain, cycle.amplitude)
    } else {
        1.0 / shown.magnitude
    };
    let by_relay = Ultimate {
        gain,
        period: cycle.period,
    };
    let limits = stability_limits(plant);
    RelayGain {
        text: gain_text(relay, &by_relay, &shown, &limits),
        by_relay,
        shown,
        limits,
    }
}

fn gain_text(
    relay: &Relay,
    by_relay: &Ultimate,
    shown: &ShownPoint,
    limits: &StabilityLimits,
) -> Message {
    let formula = if relay.is_symmetric() {
        "4k/(πa)"
    } else {
        "the first harmonics of an asymmetric relay"
    };
    let mut text = msg!(
        "The relay gives Ku = {} ({}) at a period of {} s.",
        fixed(by_relay.gain, 4),
        formula,
        fixed(by_relay.period, 4)
    );
    text.add(msg!(
        "The cycle shows the plant at {}°, where 1/|P| is {}.",
        fixed(shown.phase_deg, 1),
        fixed(1.0 / shown.magnitude, 4)
    ));
    text.add(limits.text());
    let away = (shown.phase_deg + 180.0).abs() > AT_ULTIMATE && limits.upper.is_some();
    if away && !relay.is_symmetric() {
        text.add("A symmetric relay with less hysteresis comes nearer to it.");
    } else if away && relay.hysteresis > 0.0 {
        text.add("Less hysteresis comes nearer to it.");
    } else if away && relay.delay > 0.0 {
        text.add("A relay without delay comes nearer to it.");
    }
    text
}

/// Compares the ultimate point of a symmetric relay `test` with the truth of its `plant`.
pub fn compare(test: &RelayTest, plant: &TransferFunction) -> UltimateReport {
    let (k, a, period) = (test.relay.gain, test.amplitude, test.period);
    let by_relay = ultimate_gain(k, a);
    let on_real_axis = gain_on_real_axis(k, a, test.relay.hysteresis);
    let truth = true_ultimate(plant);
    let error = |value: f64, exact: fn(&Ultimate) -> f64| {
        truth
            .as_ref()
            .map(|t| value / exact(t) - 1.0)
            .filter(|e| e.is_finite())
    };
    UltimateReport {
        amplitude_convention: AMPLITUDE_CONVENTION.to_owned(),
        by_relay: Ultimate {
            gain: by_relay,
            period,
        },
        on_real_axis: Ultimate {
            gain: on_real_axis,
            period,
        },
        by_relay_error: error(by_relay, |t| t.gain),
        on_real_axis_error: error(on_real_axis, |t| t.gain),
        period_error: error(period, |t| t.period),
        truth,
    }
}
