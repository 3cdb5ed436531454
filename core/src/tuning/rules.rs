//! The registry of tuning rules: one entry each, from which app and command line list them.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::asymmetric_test::Model;
use super::controller::Pid;
use super::error::TuningError;
use super::moving_point::{self, NyquistPoint, Target};
use super::ultimate::Ultimate;

/// What the experiments found and the user wants: all that a rule may use.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identified {
    /// Ultimate point as the relay sees it (with the hysteresis allowed for).
    pub ultimate: Ultimate,
    /// Point `M` of the Nyquist curve, by the describing function.
    pub point: NyquistPoint,
    /// Model from the asymmetric test.
    pub model: Result<Model, TuningError>,
    /// What is wanted.
    pub wish: Wish,
}

/// What the user wants of a controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Wish {
    /// Phase margin, rad, above 0 and below pi/2.
    pub phase_margin: f64,
    /// Amplitude margin, above 1.
    pub amplitude_margin: f64,
    /// Where the identified point shall go, `S`.
    pub target: Target,
    /// `Ti/Td` where a rule leaves it open; 1 to 100, 4 is usual.
    pub time_ratio: f64,
    /// `N = Td/Tf` of the derivative's filter; 1 to 1000, 10 is usual.
    pub filter: f64,
}

impl Default for Wish {
    fn default() -> Self {
        Self {
            phase_margin: PI / 4.0,
            amplitude_margin: 2.0,
            target: Target::Point {
                size: 0.5,
                angle: PI / 6.0,
            },
            time_ratio: 4.0,
            filter: 10.0,
        }
    }
}

/// A tuning rule.
#[derive(Clone, Copy)]
pub struct Rule {
    /// Its id in files and reports.
    pub id: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Author and year.
    pub source: &'static str,
    /// One sentence about it.
    pub sentence: &'static str,
    /// The controller.
    pub tune: fn(&Identified) -> Result<Pid, TuningError>,
}

impl std::fmt::Debug for Rule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Rule")
            .field("id", &self.id)
            .finish_non_exhaustive()
    }
}

/// All rules, in the order in which they are shown.
pub const RULES: [Rule; 10] = [
    Rule {
        id: "ziegler_nichols_pi",
        name: "Ziegler-Nichols PI",
        source: "Ziegler and Nichols 1942",
        sentence: "Less than half of the ultimate gain, for a load response that decays to a quarter with each swing.",
        tune: |p| from_ultimate(p, 0.45, 1.0 / 1.2, None),
    },
    Rule {
        id: "ziegler_nichols_pid",
        name: "Ziegler-Nichols PID",
        source: "Ziegler and Nichols 1942",
        sentence: "The oldest rule: quick to reject loads, with large overshoot and little margin.",
        tune: |p| from_ultimate(p, 0.6, 0.5, Some(1.0 / 8.0)),
    },
    Rule {
        id: "tyreus_luyben_pi",
        name: "Tyreus-Luyben PI",
        source: "Tyreus and Luyben 1992",
        sentence: "Less gain and much slower integration than Ziegler-Nichols: calm, made for integrating plants.",
        tune: |p| from_ultimate(p, 1.0 / 3.2, 2.2, None),
    },
    Rule {
        id: "tyreus_luyben_pid",
        name: "Tyreus-Luyben PID",
        source: "Luyben and Luyben 1997",
        sentence: "The calm rule with derivative action.",
        tune: |p| from_ultimate(p, 1.0 / 2.2, 2.2, Some(1.0 / 6.3)),
    },
    Rule {
        id: "astrom_hagglund_phase",
        name: "Åström-Hägglund, phase margin",
        source: "Åström and Hägglund 1984",
        sentence: "Turns the ultimate point along the unit circle until the wanted phase margin is reached.",
        tune: |p| move_ultimate(p, Target::PhaseMargin(p.wish.phase_margin)),
    },
    Rule {
        id: "astrom_hagglund_amplitude",
        name: "Åström-Hägglund, amplitude margin",
        source: "Åström and Hägglund 1984",
        sentence: "Leaves the ultimate point on the negative real axis and shrinks it to the wanted amplitude margin.",
        tune: |p| move_ultimate(p, Target::AmplitudeMargin(p.wish.amplitude_margin)),
    },
    Rule {
        id: "moving_point_pid",
        name: "Moving point M to S, PID",
        source: "equation (4)",
        sentence: "Moves the point of the Nyquist curve found by the relay with hysteresis to the target.",
        tune: |p| {
            let wish = &p.wish;
            moving_point::pid(&p.point, wish.target.point(), wish.time_ratio, wish.filter)
        },
    },
    Rule {
        id: "moving_point_pi",
        name: "Moving point M to S, PI",
        source: "equation (4)",
        sentence: "The same without derivative action: the point can only be turned back.",
        tune: |p| moving_point::pi(&p.point, p.wish.target.point()),
    },
    Rule {
        id: "amigo_pi",
        name: "AMIGO PI from one asymmetric test",
        source: "Åström and Hägglund 2004; Berner, Hägglund and Åström 2016",
        sentence: "Uses gain, lag and dead time, and keeps the sensitivity near 1.4.",
        tune: amigo_pi,
    },
    Rule {
        id: "amigo_pid",
        name: "AMIGO PID from one asymmetric test",
        source: "Åström and Hägglund 2004; Berner, Hägglund and Åström 2016",
        sentence: "The same with derivative action: robust for all plants with monotone step responses.",
        tune: amigo_pid,
    },
];

/// The rule with an id.
///
/// # Errors
/// [`TuningError::UnknownRule`].
pub fn rule(id: &str) -> Result<&'static Rule, TuningError> {
    RULES
        .iter()
        .find(|r| r.id == id)
        .ok_or_else(|| TuningError::UnknownRule(id.to_owned()))
}

/// Gain and times as shares of ultimate gain and period.
fn from_ultimate(
    p: &Identified,
    gain: f64,
    integral: f64,
    derivative: Option<f64>,
) -> Result<Pid, TuningError> {
    let Ultimate { gain: ku, period } = p.ultimate;
    let pid = derivative.map_or_else(
        || Pid::pi(gain * ku, integral * period),
        |d| Pid::with_derivative(gain * ku, integral * period, d * period, p.wish.filter),
    );
    pid.validate()?;
    Ok(pid)
}

fn move_ultimate(p: &Identified, target: Target) -> Result<Pid, TuningError> {
    let from = NyquistPoint {
        omega: 2.0 * PI / p.ultimate.period,
        value: [-1.0 / p.ultimate.gain, 0.0],
    };
    moving_point::pid(&from, target.point(), p.wish.time_ratio, p.wish.filter)
}

/// Least dead time, as a share of the time constant, for which AMIGO gives a finite gain.
const LEAST_DEAD_TIME: f64 = 1e-9;

fn with_dead_time(model: &Model) -> Result<(), TuningError> {
    let (dead_time, scale) = match *model {
        Model::Lag {
            time_constant,
            dead_time,
            ..
        } => (dead_time, time_constant),
        Model::Integrating { dead_time, .. } => (dead_time, 0.0),
    };
    if dead_time > LEAST_DEAD_TIME * scale && dead_time.is_finite() {
        return Ok(());
    }
    Err(TuningError::NotFirstOrder {
        what: "the dead time".into(),
        value: dead_time,
        range: "above 0 s".into(),
    })
}

/// `K = 0.15/Kp + (0.35 - L T/(L+T)^2) T/(Kp L)`, `Ti = 0.35 L + 13 L T^2/(T^2 + 12 L T + 7 L^2)`;
/// integrating: `K = 0.35/(Kv L)`, `Ti = 13.4 L`.
fn amigo_pi(p: &Identified) -> Result<Pid, TuningError> {
    let model = p.model.as_ref().map_err(Clone::clone)?;
    with_dead_time(model)?;
    let pid = match *model {
        Model::Lag {
            gain,
            time_constant: t,
            dead_time: l,
        } => Pid::pi(
            (0.15 + (0.35 - l * t / (l + t).powi(2)) * t / l) / gain,
            0.35 * l + 13.0 * l * t * t / (t * t + 12.0 * l * t + 7.0 * l * l),
        ),
        Model::Integrating { gain, dead_time } => {
            Pid::pi(0.35 / (gain * dead_time), 13.4 * dead_time)
        }
    };
    pid.validate()?;
    Ok(pid)
}

/// `K = (0.2 + 0.45 T/L)/Kp`, `Ti = L (0.4 L + 0.8 T)/(L + 0.1 T)`, `Td = 0.5 L T/(0.3 L + T)`, set-point
/// weight 0 where `L <= T`, else 1; integrating: `K = 0.45/(Kv L)`, `Ti = 8 L`, `Td = 0.5 L`.
fn amigo_pid(p: &Identified) -> Result<Pid, TuningError> {
    let model = p.model.as_ref().map_err(Clone::clone)?;
    with_dead_time(model)?;
    let filter = p.wish.filter;
    let (pid, setpoint_weight) = match *model {
        Model::Lag {
            gain,
            time_constant: t,
            dead_time: l,
        } => (
            Pid::with_derivative(
                (0.2 + 0.45 * t / l) / gain,
                l * (0.4 * l + 0.8 * t) / (l + 0.1 * t),
                0.5 * l * t / (0.3 * l + t),
                filter,
            ),
            if l <= t { 0.0 } else { 1.0 },
        ),
        Model::Integrating { gain, dead_time: l } => (
            Pid::with_derivative(0.45 / (gain * l), 8.0 * l, 0.5 * l, filter),
            0.0,
        ),
    };
    let pid = Pid {
        setpoint_weight,
        ..pid
    };
    pid.validate()?;
    Ok(pid)
}
