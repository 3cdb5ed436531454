//! The limit cycle of a motor inside its gap, in closed form: characteristic points, period, drift.

use serde::{Deserialize, Serialize};

use super::{Body, VelocityRelay};
use crate::model::free_body;

/// A characteristic point of the cycle in the phase plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Turn {
    /// The velocity rises through `+eps`: the relay switches to pushing down.
    SwitchUp,
    /// That push arrives: the velocity is largest.
    Peak,
    /// The motor turns round at its uppermost position.
    Top,
    /// The velocity falls through `-eps`.
    SwitchDown,
    /// The push up arrives: the velocity is least.
    Trough,
    /// The motor turns round at its lowest position.
    Bottom,
    /// A period later: as at the first point, but for the drift.
    Again,
}

/// Where the cycle is at a characteristic point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CyclePoint {
    /// Which.
    pub turn: Turn,
    /// Time since the first one, s.
    pub time: f64,
    /// Position relative to the first one, rad (or m).
    pub x: f64,
    /// Velocity, rad/s (or m/s).
    pub v: f64,
}

/// The cycle of a motor that touches nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DriftingCycle {
    /// Period, s.
    pub period: f64,
    /// Displacement per period, rad (or m).
    pub drift: f64,
    /// Distance of the uppermost from the lowest position before it, rad (or m).
    pub swing: f64,
    /// Largest velocity, rad/s (or m/s).
    pub peak: f64,
    /// Least velocity; negative.
    pub trough: f64,
    /// The characteristic points, in order.
    pub points: [CyclePoint; 7],
}

impl DriftingCycle {
    /// Mean velocity, rad/s (or m/s).
    pub fn drift_velocity(&self) -> f64 {
        self.drift / self.period
    }

    /// The cycle as `count` points for each leg, `[x, v]`, to be drawn.
    pub fn curve(&self, motor: &Body, relay: &VelocityRelay, count: usize) -> Vec<[f64; 2]> {
        let mut curve = Vec::with_capacity(6 * count + 1);
        for (i, pair) in self.points.windows(2).enumerate() {
            let force = leg_force(motor, relay, i);
            for k in 0..count {
                let t = (pair[1].time - pair[0].time) * k as f64 / count as f64;
                let (v, dx) = moved(motor, pair[0].v, force, t);
                curve.push([pair[0].x + dx, v]);
            }
        }
        let last = self.points[6];
        curve.push([last.x, last.v]);
        curve
    }
}

/// Force on the motor along a leg, friction included: up, down, down, down, up, up.
fn leg_force(motor: &Body, relay: &VelocityRelay, leg: usize) -> f64 {
    let rising = relay.output(false, false);
    let falling = relay.output(true, false);
    let c = motor.coulomb;
    match leg {
        1 => falling - c,
        2 | 3 => falling + c,
        4 => rising + c,
        _ => rising - c,
    }
}

/// Velocity and displacement of the motor after `t` s under a constant force.
fn moved(motor: &Body, v: f64, force: f64, t: f64) -> (f64, f64) {
    let (decay, phi1, phi2) = free_body(motor.viscous / motor.inertia, t);
    let a = force / motor.inertia;
    (v * decay + a * phi1, v * phi1 + a * phi2)
}

/// Time in which a constant force takes the motor from one velocity to another, if it does.
fn time_between(motor: &Body, from: f64, to: f64, force: f64) -> Option<f64> {
    let change = to - from;
    if change == 0.0 {
        return Some(0.0);
    }
    let end_force = force - motor.viscous * to;
    if end_force * change <= 0.0 || !end_force.is_finite() {
        return None;
    }
    // m dv/dt = F - d v: t = m/d ln(1 + d (to - from)/(F - d to))
    let ratio = motor.viscous * change / end_force;
    let stretch = if ratio.abs() < f64::EPSILON {
        1.0
    } else {
        libm::log1p(ratio) / ratio
    };
    Some(motor.inertia * change / end_force * stretch)
}

/// The cycle of a free motor under a velocity relay: exact for a relay that sees the velocity all the
/// time, with viscous and Coulomb friction and delay; a sampled one is given its mean delay.
///
/// `None` where the relay cannot keep the motor swinging: a push that friction eats up before the
/// velocity reaches `eps`, or no hysteresis and no delay, where it would switch without end.
pub fn drifting_cycle(motor: &Body, relay: &VelocityRelay) -> Option<DriftingCycle> {
    let eps = relay.relay.hysteresis;
    let tau = relay.mean_delay();
    if eps + tau <= 0.0 {
        return None;
    }
    // A push must get beyond its threshold, and from standstill at all.
    let rising = leg_force(motor, relay, 0) - motor.viscous * eps;
    let falling = leg_force(motor, relay, 3) + motor.viscous * eps;
    if !(rising > 0.0 && falling < 0.0) {
        return None;
    }
    let mut points = [CyclePoint {
        turn: Turn::SwitchUp,
        time: 0.0,
        x: 0.0,
        v: eps,
    }; 7];
    // Leg, where it ends, and at which velocity; `None`: after the delay.
    let legs = [
        (Turn::Peak, None),
        (Turn::Top, Some(0.0)),
        (Turn::SwitchDown, Some(-eps)),
        (Turn::Trough, None),
        (Turn::Bottom, Some(0.0)),
        (Turn::Again, Some(eps)),
    ];
    for (i, (turn, end)) in legs.into_iter().enumerate() {
        let from = points[i];
        let force = leg_force(motor, relay, i);
        let t = match end {
            Some(v) => time_between(motor, from.v, v, force)?,
            None => tau,
        };
        let (v, dx) = moved(motor, from.v, force, t);
        points[i + 1] = CyclePoint {
            turn,
            time: from.time + t,
            x: from.x + dx,
            v: end.unwrap_or(v),
        };
    }
    let [_, peak, top, _, trough, bottom, again] = points;
    Some(DriftingCycle {
        period: again.time,
        drift: again.x,
        swing: top.x - (bottom.x - again.x),
        peak: peak.v,
        trough: trough.v,
        points,
    })
}

/// Period in s and drift per period in rad (or m) without viscous friction:
///
/// ```text
/// vM = eps + tau (k+ - c)/m        p = 1/(k+ - c) + 1/(k- + c)        T  = m (vM p + vm q)
/// vm = eps + tau (k- - c)/m        q = 1/(k+ + c) + 1/(k- - c)        dx = m/2 (vM^2 p - vm^2 q)
/// ```
///
/// With friction alone the drift runs against the stronger push, with delay alone with it. `push` holds
/// `k+` and `k-`, both above `c`.
pub fn drift_formula(
    inertia: f64,
    coulomb: f64,
    push: [f64; 2],
    hysteresis: f64,
    delay: f64,
) -> [f64; 2] {
    let ([up, down], c, m) = (push, coulomb, inertia);
    let peak = hysteresis + delay * (up - c) / m;
    let trough = hysteresis + delay * (down - c) / m;
    let p = 1.0 / (up - c) + 1.0 / (down + c);
    let q = 1.0 / (up + c) + 1.0 / (down - c);
    [
        m * (peak * p + trough * q),
        0.5 * m * (peak * peak * p - trough * trough * q),
    ]
}
