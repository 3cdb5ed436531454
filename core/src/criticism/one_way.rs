//! A drive that turns one way only.
//!
//! Dry friction is then a constant, and so are a load and what a dead zone takes off the input: whatever the sampling
//! rate, no such record tells them apart, since each shows itself only where the motion or the input turns.

use super::data::Data;
use super::fit::Fit;
use super::session::Session;
use super::verdict::Class;
use crate::effect::{Dimension, Effect, Scales};
use crate::measurement::Kind;
use crate::model::Model;
use crate::order::quantile;

/// Share of the usual speed, and times the noise, from which on a velocity has a sign.
const MOVES: f64 = 0.05;
const CLEAR_OF_NOISE: f64 = 6.0;

/// Share of the moving samples that may go the other way, by noise.
const OTHER_WAY: f64 = 0.01;

/// Times the speed from which on it moves that a load would have given a drive at rest: then it is friction that held
/// it.
const TURNED_BACK: f64 = 2.0;

/// Size of an effect that is looked at, as a share of its typical size.
const SIZE: f64 = 0.1;

/// How far, as a share of its median, the force of an effect may be off it while it is a constant, and in which share
/// of the moving samples.
const SAME: f64 = 0.1;
const MOSTLY: f64 = 0.8;

/// Samples at which an effect is looked at.
const LOOKED_AT: usize = 500;

/// A drive that turns one way only: what it is like while it moves.
pub(super) struct OneWay {
    /// Input, position and velocity.
    moving: Vec<[f64; 3]>,
    /// Rests: how long, s, and the mean input.
    rests: Vec<[f64; 2]>,
    /// The speed from which on it moves.
    least: f64,
    /// The way it turns, 1 or -1.
    side: f64,
    scales: Scales,
}

impl OneWay {
    /// `None` where the drive turns both ways.
    pub fn of(session: &Session) -> Option<Self> {
        let data = session.whole();
        if data.kind != Kind::Drive {
            return None;
        }
        let velocity = data.velocity_estimate();
        let least = least_speed(data, &velocity);
        let count = |side: f64| velocity.iter().filter(|v| side * **v > least).count();
        let (forward, back) = (count(1.0), count(-1.0));
        let rare = OTHER_WAY * (forward + back) as f64;
        if forward.min(back) as f64 > rare || forward + back == 0 {
            return None;
        }
        let side = if forward > back { 1.0 } else { -1.0 };
        let position = data.position_estimate();
        let moves = (0..data.len()).filter(|i| side * velocity[*i] > least);
        let moving: Vec<[f64; 3]> = moves
            .map(|i| [data.input[i], position[i], velocity[i]])
            .collect();
        let stride = moving.len().div_ceil(LOOKED_AT).max(1);
        Some(Self {
            moving: moving.into_iter().step_by(stride).collect(),
            rests: rests(data, &velocity, least, session.scales.step),
            least,
            side,
            scales: session.scales,
        })
    }

    /// Makes one class of what is missing and a constant: of `missing` effects, each with whether it only tells how the
    /// record was made, and the `classes` of what could replace each. True if there is one.
    pub fn join(
        &self,
        session: &Session,
        fit: &Fit,
        missing: &mut Vec<(&'static dyn Effect, bool)>,
        classes: &mut Vec<Class>,
    ) -> bool {
        let all: Class = session.library().filter(|e| self.is_constant(*e)).collect();
        let widened = |e: &dyn Effect| all.iter().any(|part| e.has_part(part.id()));
        let plain: Class = all.iter().copied().filter(|e| !widened(*e)).collect();
        let is_one = |e: &dyn Effect| all.iter().any(|own| own.id() == e.id());
        // What pushes a drive on is no friction.
        let held: f64 = (0..fit.structure.effects.len())
            .filter_map(|k| {
                let values = &fit.values[fit.structure.range(k)];
                self.constant(fit.structure.effects[k], values)
            })
            .sum();
        if held * self.side >= 0.0 || self.is_held_at_rest(held, &fit.structure.model(&fit.values))
        {
            return false;
        }
        let Some(first) = missing.iter().position(|(e, _)| is_one(*e)) else {
            return false;
        };
        let Some((named, others)) = plain.split_first().filter(|(_, others)| !others.is_empty())
        else {
            return false;
        };
        missing[first].0 = *named;
        classes[first] = others.to_vec();
        for k in (first + 1..missing.len()).rev() {
            if is_one(missing[k].0) {
                missing.remove(k);
                classes.remove(k);
            }
        }
        true
    }

    /// Whether its input is a constant while it moves.
    pub fn is_pushed_alike(&self) -> bool {
        let mut inputs: Vec<f64> = self.moving.iter().map(|m| m[0]).collect();
        let usual = quantile(&mut inputs, 0.5);
        inputs
            .iter()
            .all(|u| (u - usual).abs() <= SAME * usual.abs())
    }

    /// Whether it rests somewhere where a load of this size would have turned it back: what holds it there is friction.
    fn is_held_at_rest(&self, load: f64, body: &Model) -> bool {
        self.rests.iter().any(|[duration, input]| {
            let force = self.side * (input + load);
            let friction = body.viscous * duration / body.inertia;
            let speed = -force * duration / body.inertia / (1.0 + friction);
            speed > TURNED_BACK * self.least
        })
    }

    /// Whether an effect does nothing but add a constant to the input while the drive moves.
    pub fn is_constant(&self, effect: &dyn Effect) -> bool {
        let size = |d: Dimension| SIZE * self.scales.of(d);
        let values: Vec<f64> = effect
            .parameters()
            .iter()
            .map(|p| p.clamp(size(p.dimension), &self.scales))
            .collect();
        self.constant(effect, &values).is_some()
    }

    /// The constant that an effect with these values adds to the input while the drive moves; `None` where it is none.
    fn constant(&self, effect: &dyn Effect, values: &[f64]) -> Option<f64> {
        let mut model = Model::body(self.scales.inertia, self.scales.viscous);
        effect.apply(values, &mut model);
        let plain = model.delay == 0.0
            && model.next_input == 0.0
            && model.actuator.is_none()
            && model.encoder.is_none()
            && model.lag.is_none()
            && model.sensor_lag.is_none()
            && model.load.is_none()
            && model.force_ramp == 0.0
            && model.own_forces.is_empty()
            && model.gear_friction == 0.0
            && model.output_maps.is_empty()
            && model.inertia == self.scales.inertia
            && model.viscous == self.scales.viscous;
        if !plain {
            return None;
        }
        let added = |[u, x, v]: &[f64; 3]| {
            let forces: f64 = model.forces.iter().map(|force| force(*x, *v)).sum();
            let friction = model.friction.level_at(*x, *v) * v.signum();
            model.map_input(*u) - u + model.constant_force + forces - friction
        };
        let mut forces: Vec<f64> = self.moving.iter().map(added).collect();
        let usual = quantile(&mut forces, 0.5);
        let same = forces
            .iter()
            .filter(|f| (*f - usual).abs() <= SAME * usual.abs());
        let is_constant = usual != 0.0 && same.count() as f64 > MOSTLY * forces.len() as f64;
        is_constant.then_some(usual)
    }
}

/// Stretches of a record in which a drive does not move: how long each is, s, and its mean input.
fn rests(data: &Data, velocity: &[f64], least: f64, step: f64) -> Vec<[f64; 2]> {
    let samples: Vec<(bool, f64)> = velocity
        .iter()
        .zip(&data.input)
        .map(|(v, u)| (v.abs() <= least, *u))
        .collect();
    samples
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|stretch| stretch[0].0)
        .map(|stretch| {
            let n = stretch.len() as f64;
            let mean = stretch.iter().map(|s| s.1).sum::<f64>() / n;
            [n * step, mean]
        })
        .collect()
}

/// The speed from which on a drive moves.
fn least_speed(data: &Data, velocity: &[f64]) -> f64 {
    let mean_square = velocity.iter().map(|v| v * v).sum::<f64>() / velocity.len().max(1) as f64;
    let noise = data.outputs.iter().find(|o| o.is_velocity);
    let noise = noise.map_or(0.0, |o| o.noise);
    (MOVES * mean_square.sqrt()).max(CLEAR_OF_NOISE * noise)
}
