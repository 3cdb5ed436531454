//! Gains for a controller in the form in which it wants them, and the margins that they achieve on the model.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::fourier::Point;
use super::structure::{FittedModel, Structure};
use super::ultimate::MeasuredUltimate;
use crate::plant::TransferFunction;
use crate::tuning::{
    Disturbance, Identified, Margins, Model, NyquistPoint, Pid, Response, Target, TuningError,
    Ultimate, Wish, margins, move_with_pi, move_with_pid, respond, rule, unstable_poles,
};

/// Full scale of the output of Klipper's and Marlin's controllers.
const FIRMWARE_SCALE: f64 = 255.0;

/// Largest standard error of the phase, degrees, with which a point is moved: twice of it is half of a phase margin.
const MOVED: f64 = 15.0;

/// The form in which a controller takes its gains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// `kp + ki/s + kd s`.
    #[default]
    Parallel,
    /// `kp (1 + 1/(ti s) + td s)`; `ki = kp/ti`, `kd = kp td`.
    Ideal,
    /// `kp (1 + 1/(ti s)) (1 + td s)`.
    Series,
    /// `pid_Kp`, `pid_Ki` and `pid_Kd` of Klipper: parallel, the output from 0 to 255.
    Klipper,
    /// `P`, `I` and `D` of Marlin's `M301`: parallel, the output from 0 to 255.
    Marlin,
    /// `kp`, `ki` and `kd` of `ESPHome`: parallel, the output from 0 (or -1) to 1.
    Esphome,
}

impl Form {
    /// All, the usual one first.
    pub const ALL: [Self; 6] = [
        Self::Parallel,
        Self::Ideal,
        Self::Series,
        Self::Klipper,
        Self::Marlin,
        Self::Esphome,
    ];

    /// Its name in files.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Parallel => "parallel",
            Self::Ideal => "ideal",
            Self::Series => "series",
            Self::Klipper => "klipper",
            Self::Marlin => "marlin",
            Self::Esphome => "esphome",
        }
    }

    /// Full scale of its output; none where it has the unit of the record.
    const fn scale(self) -> Option<f64> {
        match self {
            Self::Parallel | Self::Ideal | Self::Series => None,
            Self::Klipper | Self::Marlin => Some(FIRMWARE_SCALE),
            Self::Esphome => Some(1.0),
        }
    }
}

/// Gains by one rule in one form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TunedGains {
    /// Rule: `ziegler_nichols`, `tyreus_luyben`, `simc`, `amigo`, or `moving_point` where there is no model.
    pub rule: String,
    /// Its name.
    pub name: String,
    /// `pi` or `pid`.
    pub controller: String,
    /// Form of the gains.
    pub form: Form,
    /// Proportional gain.
    pub kp: f64,
    /// Integral gain, per s; of the series form `kp/ti`.
    pub ki: f64,
    /// Derivative gain, times s; of the series form `kp td`.
    pub kd: f64,
    /// Integral time, s.
    pub ti: Option<f64>,
    /// Derivative time, s.
    pub td: f64,
    /// The controller in the units of the record.
    pub pid: Pid,
    /// Least phase margin on the model, degrees; `None` where the loop is unstable or never passes gain 1.
    pub phase_margin_deg: Option<f64>,
    /// Gain margin on the model; `None` where the loop is unstable or the gain may rise without limit.
    pub gain_margin: Option<f64>,
    /// Maximum sensitivity on the model; `None` where the loop is unstable.
    pub max_sensitivity: Option<f64>,
    /// Whether the loop with the model is stable.
    pub stable: bool,
}

/// What the rules may use.
pub(super) struct Basis<'a> {
    /// The model on which margins are computed, if there is one.
    pub model: Option<&'a FittedModel>,
    /// All models, best first.
    pub models: &'a [FittedModel],
    pub ultimate: Option<&'a MeasuredUltimate>,
    pub point: Option<&'a Point>,
    /// Time between samples, s: no controller is meant to act faster.
    pub sampling: f64,
}

/// Lag or integrator with a second lag and dead time, as the rules want it.
#[derive(Clone, Copy, Debug)]
struct Reduced {
    gain: f64,
    /// `None`: an integrator.
    first: Option<f64>,
    second: f64,
    dead_time: f64,
}

impl Reduced {
    /// From a fitted model; an inverse response counts as dead time (Skogestad 2003).
    fn of(model: &FittedModel, sampling: f64) -> Self {
        let lags: Vec<f64> = model.time_constants.iter().map(|t| t.value).collect();
        let at = |i: usize| lags.get(i).copied().unwrap_or(0.0);
        let integrates = model.structure.integrates();
        let inverse = model.zero.map_or(0.0, |z| (-z.value).max(0.0));
        Self {
            gain: model.gain.value,
            first: (!integrates).then(|| at(0)),
            second: if integrates { at(0) } else { at(1) },
            // A controller that samples as the record did is late by half a sample at least.
            dead_time: (model.dead_time.value + inverse).max(0.5 * sampling),
        }
    }

    /// Half of the second lag to each of its neighbours: Skogestad's half rule.
    fn half_rule(&self) -> Self {
        Self {
            first: self.first.map(|t| t + 0.5 * self.second),
            dead_time: self.dead_time + self.second * if self.first.is_some() { 0.5 } else { 1.0 },
            second: 0.0,
            ..*self
        }
    }

    fn model(&self) -> Model {
        let (gain, dead_time) = (self.gain, self.dead_time);
        self.first
            .map_or(Model::Integrating { gain, dead_time }, |time_constant| {
                Model::Lag {
                    gain,
                    time_constant,
                    dead_time,
                }
            })
    }

    /// `Kc = T1/(K (tc + L))`, `Ti = min(T1, 4 (tc + L))`, `Td = T2` in the series form, `tc = L` (Skogestad 2003).
    fn simc(&self, filter: f64) -> Pid {
        let closed = 2.0 * self.dead_time;
        let (gain, ti) = match self.first {
            Some(t) => (t / (self.gain * closed), t.min(4.0 * closed)),
            None => (1.0 / (self.gain * closed), 4.0 * closed),
        };
        if self.second > 0.0 {
            let share = 1.0 + self.second / ti;
            Pid::with_derivative(gain * share, ti * share, self.second / share, filter)
        } else {
            Pid::pi(gain, ti)
        }
    }
}

/// Gains by all rules that have what they need, in one form; `full_scale` is that of the record's input.
pub(super) fn all(basis: &Basis<'_>, form: Form, full_scale: f64) -> Vec<TunedGains> {
    let plant = basis.model.map(FittedModel::plant);
    let mut found = Vec::new();
    let mut add = |id: &str, name: &str, controller: &str, pid: Result<Pid, TuningError>| {
        let valid = pid.ok().filter(|p| p.validate().is_ok());
        if let Some(gains) = valid.and_then(|pid| tuned(pid, form, full_scale, plant.as_ref())) {
            found.push(TunedGains {
                rule: id.to_owned(),
                name: name.to_owned(),
                controller: controller.to_owned(),
                ..gains
            });
        }
    };
    let reduced = for_rules(basis).map(|m| Reduced::of(m, basis.sampling));
    if let Some(ultimate) = basis.ultimate {
        let identified = identified(Some(ultimate), None, basis.point);
        for (id, name, controller, entry) in [
            (
                "ziegler_nichols",
                "Ziegler-Nichols",
                "pi",
                "ziegler_nichols_pi",
            ),
            (
                "ziegler_nichols",
                "Ziegler-Nichols",
                "pid",
                "ziegler_nichols_pid",
            ),
            ("tyreus_luyben", "Tyreus-Luyben", "pi", "tyreus_luyben_pi"),
            ("tyreus_luyben", "Tyreus-Luyben", "pid", "tyreus_luyben_pid"),
        ] {
            add(
                id,
                name,
                controller,
                rule(entry).and_then(|r| (r.tune)(&identified)),
            );
        }
    }
    // Without a model the point alone is moved.
    if reduced.is_none()
        && let Some(point) = basis
            .point
            .filter(|p| p.is_known() && p.std_error_phase_deg <= MOVED)
    {
        // A plant of negative gain is moved with the input turned, and its gains are turned back.
        let turned = basis.model.is_some_and(|m| m.gain.value < 0.0);
        let seen = if turned { point.turned() } else { *point };
        let back = |pid: Result<Pid, TuningError>| {
            pid.map(|p| {
                if turned {
                    Pid { gain: -p.gain, ..p }
                } else {
                    p
                }
            })
        };
        let from = identified(None, None, Some(&seen)).point;
        let target = Target::PhaseMargin(Wish::default().phase_margin).point();
        add(
            "moving_point",
            "Moving point",
            "pi",
            back(move_with_pi(&from, target)),
        );
        let wish = Wish::default();
        add(
            "moving_point",
            "Moving point",
            "pid",
            back(move_with_pid(&from, target, wish.time_ratio, wish.filter)),
        );
    }
    if let Some(reduced) = reduced {
        let filter = Wish::default().filter;
        add("simc", "SIMC", "pi", Ok(reduced.half_rule().simc(filter)));
        if reduced.second > 0.0 {
            add("simc", "SIMC", "pid", Ok(reduced.simc(filter)));
        }
        let identified = identified(None, Some(reduced.half_rule().model()), basis.point);
        for (controller, entry) in [("pi", "amigo_pi"), ("pid", "amigo_pid")] {
            add(
                "amigo",
                "AMIGO",
                controller,
                rule(entry).and_then(|r| (r.tune)(&identified)),
            );
        }
    }
    found
}

/// The best model that the rules understand: of a known gain, without a zero that leads.
fn for_rules<'a>(basis: &Basis<'a>) -> Option<&'a FittedModel> {
    basis
        .models
        .iter()
        .filter(|m| m.gain.is_known())
        .find(|m| m.structure != Structure::SopdtZero || m.zero.is_some_and(|z| z.value <= 0.0))
}

/// As the registry of rules wants it; rules ask only for what is given.
fn identified(
    ultimate: Option<&MeasuredUltimate>,
    model: Option<Model>,
    point: Option<&Point>,
) -> Identified {
    let value = point.map(Point::value);
    Identified {
        ultimate: ultimate.map_or(
            Ultimate {
                gain: f64::NAN,
                period: f64::NAN,
            },
            |u| Ultimate {
                gain: u.gain,
                period: u.period,
            },
        ),
        point: NyquistPoint {
            omega: point.map_or(f64::NAN, |p| p.omega),
            value: value.map_or([f64::NAN; 2], |v| [v.re, v.im]),
        },
        model: model.ok_or_else(|| TuningError::NotFinite("the model".into())),
        wish: Wish::default(),
    }
}

fn tuned(
    pid: Pid,
    form: Form,
    full_scale: f64,
    plant: Option<&TransferFunction>,
) -> Option<TunedGains> {
    let scale = form.scale().map_or(1.0, |s| s / full_scale);
    let (kp, ti, td) = if form == Form::Series {
        // A PI controller is the same in both; a PID controller may have no series form.
        let series = pid.series()?;
        (
            series.gain,
            Some(series.integral_time),
            series.derivative_time,
        )
    } else {
        (pid.gain * scale, pid.integral_time, pid.derivative_time)
    };
    let unstable = plant.map(|p| unstable_poles(p, &pid));
    let achieved: Option<Margins> = plant
        .filter(|_| unstable == Some(0))
        .map(|p| margins(p, &pid));
    Some(TunedGains {
        rule: String::new(),
        name: String::new(),
        controller: String::new(),
        form,
        kp,
        ki: ti.map_or(0.0, |ti| kp / ti),
        kd: kp * td,
        ti,
        td,
        pid,
        phase_margin_deg: achieved
            .and_then(|m| m.phase_margin)
            .map(|p| p * 180.0 / PI),
        gain_margin: achieved.and_then(|m| m.gain_margin),
        max_sensitivity: achieved.map(|m| m.max_sensitivity),
        stable: unstable == Some(0),
    })
}

/// Steps of set point and load of the loop of `model` with `gains`, over `horizon` s.
///
/// # Errors
/// A horizon that is not above 0.
pub fn steps(
    model: &FittedModel,
    gains: &TunedGains,
    horizon: f64,
) -> Result<[Response; 2], TuningError> {
    let plant = model.plant();
    let of = |disturbance| respond(&plant, &gains.pid, disturbance, horizon, horizon / 400.0);
    Ok([of(Disturbance::SetPoint)?, of(Disturbance::Load)?])
}

/// What a step of the load does where no controller answers, over `horizon` s.
///
/// # Errors
/// A horizon that is not above 0.
pub fn alone(model: &FittedModel, horizon: f64) -> Result<Response, TuningError> {
    respond(
        &model.plant(),
        &Pid::p(0.0),
        Disturbance::Load,
        horizon,
        horizon / 400.0,
    )
}
