//! A load that the body meets again and again behind a gap, from the momentum that the body gives to it.
//!
//! While it is free, inertia and friction of the body explain its acceleration. What they do not explain elsewhere is
//! the push of the load, and moves that: its velocity follows from its own inertia and friction, its place by one more
//! integration. Where the load is right, the twist at all pushes is half the gap to their side and the depth of the
//! contact.

use std::f64::consts::SQRT_2;

use super::equations::solved;
use super::{Probe, STILL};
use crate::model::{free_body, slope};
use crate::order::{quantile, sign};
use crate::simplex::minimise;
use nalgebra::{DMatrix, DVector};

/// Samples at most that are looked at, and at least.
const LOOKED_AT: usize = 20_000;
const LEAST_SAMPLES: usize = 100;

/// Inertias of the body that are tried: how many, and the least and the most as a share of that of the present model.
const INERTIAS: i32 = 120;
const LEAST_INERTIA: f64 = 0.01;
const MOST_INERTIA: f64 = 1.5;

/// By how much that may be above what the balance of momentum tells.
const MOST_ASTRAY: f64 = 2.0;

/// Share of the intervals that tell the inertia: those that it explains best. The share of a standard deviation below
/// which as many values of a normal distribution lie.
const EXPLAINED: f64 = 0.35;
const EXPLAINED_DEVIATIONS: f64 = 0.454;

/// Part of the usual input that friction may take up while the body is free.
const UNSURE: f64 = 0.03;

/// Standard deviations within which the body is free, and from which a force is a push; rounds of the regression.
const IS_FREE: f64 = 4.0;
const IS_PUSH: f64 = 8.0;
const ROUNDS: usize = 8;

/// Pushes to either side that a gap takes, and intervals in which the body is free, at least.
const PUSHES: usize = 8;
const FREE: f64 = 0.1;

/// Rates at which a free load is slowed down that are tried, per record, and how the best is refined.
const SLOWEST: f64 = 0.05;
const FASTEST: f64 = 200.0;
const RATES: u32 = 30;
const SIDE: f64 = 0.2;
const EVALUATIONS: usize = 25;
const ENOUGH: f64 = 1e-4;

/// Inertia of body and load over each other at most.
const MOST_UNLIKE: f64 = 50.0;

/// Times that the direction in which the load moves is taken from what was found.
const DIRECTIONS: usize = 3;

/// Usual twists off the line that count fully, and the most that may be left, as a share of the half gap.
const ODD: f64 = 5.0;
const LEFT: f64 = 0.25;

/// Damping ratio of the contact.
const DAMPING_RATIO: f64 = 0.15;

/// A body and the load that it meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounces {
    /// Inertia and viscous friction of the body.
    pub body: [f64; 2],
    /// Half gap, rad or m.
    pub half_gap: f64,
    /// Inertia, viscous and dry friction of the load.
    pub load: [f64; 3],
    /// Stiffness and damping of the contact.
    pub contact: [f64; 2],
}

/// Motion of the body over an interval.
struct Interval {
    position: f64,
    velocity: f64,
    acceleration: f64,
    input: f64,
}

impl Probe {
    /// The load that the body meets, if there is one.
    pub fn bounces(&self) -> Option<Bounces> {
        let intervals = self.intervals();
        if intervals.len() < LEAST_SAMPLES {
            return None;
        }
        let (body, forces, noise) = self.free_body_of(&intervals)?;
        let pushes: Vec<usize> = (0..forces.len())
            .filter(|k| forces[*k].abs() > IS_PUSH * noise)
            .collect();
        let forwards = pushes.iter().filter(|k| forces[**k] > 0.0).count();
        if forwards.min(pushes.len() - forwards) < PUSHES {
            return None;
        }
        let seen = Seen {
            step: self.scales.step,
            intervals: &intervals,
            forces: &forces,
            pushes: &pushes,
        };
        let duration = self.scales.step * intervals.len() as f64;
        let growth = libm::pow(FASTEST / SLOWEST, 1.0 / f64::from(RATES - 1));
        let rates: Vec<f64> = (0..RATES)
            .map(|i| SLOWEST / duration * libm::pow(growth, f64::from(i)))
            .collect();
        let left = |rate: f64| {
            let line = seen.line(rate).filter(|line| {
                let ratio = line.coefficients[0] * body[0];
                ratio > 1.0 / MOST_UNLIKE && ratio < MOST_UNLIKE
            });
            line.map_or(f64::INFINITY, |line| libm::log(line.left))
        };
        let tried = self.crew.gather(rates.len(), |i| left(rates[i]));
        let best = (0..rates.len()).min_by(|a, b| tried[*a].total_cmp(&tried[*b]))?;
        let start = [libm::log(rates[best])];
        let by_log = |point: &[f64; 1]| left(libm::exp(point[0]));
        let (point, _) = minimise(by_log, start, SIDE, EVALUATIONS, ENOUGH);
        let rate = libm::exp(point[0]);
        let line = seen.line(rate)?;
        let [inverse, drag, _, _, rubs, half_gap, compliance, _, _] = line.coefficients;
        if inverse <= 0.0 {
            return None;
        }
        let inertia = 1.0 / inverse;
        let load = [inertia, rate * inertia, (-rubs * inertia).max(0.0)];
        let body = [body[0], (body[1] - drag * inertia).max(0.0)];
        let telling =
            half_gap > 0.0 && half_gap < self.scales.travel && line.left < LEFT * half_gap;
        let joined = body[0] * load[0] / (body[0] + load[0]);
        let stiffest = joined / (self.scales.step * self.scales.step);
        let stiffness = if compliance * stiffest > 1.0 {
            1.0 / compliance
        } else {
            stiffest
        };
        telling.then_some(Bounces {
            body,
            half_gap,
            load,
            contact: [stiffness, 2.0 * DAMPING_RATIO * (stiffness * joined).sqrt()],
        })
    }

    fn intervals(&self) -> Vec<Interval> {
        let position = &self.followed[..self.followed.len().min(LOOKED_AT)];
        let (step, last) = (self.scales.step, position.len().saturating_sub(1));
        let measured = self.outputs.iter().any(|(is_velocity, _)| *is_velocity);
        let velocity = |k: usize| {
            if measured {
                self.velocity[k]
            } else {
                slope(position, k, step)
            }
        };
        let interval = |k: usize| Interval {
            position: f64::midpoint(position[k], position[k + 1]),
            velocity: (position[k + 1] - position[k]) / step,
            acceleration: (velocity(k + 1) - velocity(k)) / step,
            input: self.acting.get(k).copied().unwrap_or(0.0),
        };
        (0..last).map(interval).collect()
    }

    /// Inertia and viscous friction of the body where it is free, the force that they do not explain, and the noise of
    /// that; dry friction and a constant force are explained beside.
    fn free_body_of(&self, intervals: &[Interval]) -> Option<([f64; 2], Vec<f64>, f64)> {
        // A fit which the load has led astray may have any inertia.
        let told = self.inertia_by_momentum().unwrap_or(f64::INFINITY);
        let present = (1.0 / self.inverse_inertia.abs()).min(MOST_ASTRAY * told);
        let slow = STILL * self.scales.speed;
        let moving: Vec<&Interval> = intervals
            .iter()
            .filter(|i| i.velocity.abs() > slow)
            .collect();
        if moving.len() < LEAST_SAMPLES {
            return None;
        }
        let changes = moving
            .windows(2)
            .map(|w| (w[1].acceleration - w[0].acceleration).abs());
        let change = quantile(&mut changes.collect::<Vec<_>>(), EXPLAINED);
        let noise = change / EXPLAINED_DEVIATIONS / SQRT_2;
        let squares: f64 = moving.iter().map(|i| i.input * i.input).sum();
        let unsure = UNSURE * (squares / moving.len() as f64).sqrt();
        let explained = |inertia: f64| {
            let limit = IS_FREE * inertia * noise + unsure;
            let rests = moving.iter().map(|i| i.input - inertia * i.acceleration);
            rests.filter(|rest| rest.abs() < limit).count()
        };
        let growth = libm::pow(MOST_INERTIA / LEAST_INERTIA, 1.0 / f64::from(INERTIAS));
        let tried = (0..=INERTIAS)
            .map(|i| LEAST_INERTIA * present * libm::pow(growth, f64::from(i)))
            .map(|inertia| (explained(inertia), inertia));
        let (_, inertia) = tried.max_by_key(|(count, _)| *count)?;
        let mut values = [inertia, 0.0, 0.0, 0.0];
        let row = |i: &Interval| [i.acceleration, i.velocity, sign(i.velocity), 1.0];
        let force = |i: &Interval, values: &[f64; 4]| {
            let said: f64 = row(i).iter().zip(values).map(|(r, v)| r * v).sum();
            i.input - said
        };
        let noise = |values: &[f64; 4]| {
            let sizes = moving.iter().map(|i| force(i, values).abs());
            quantile(&mut sizes.collect::<Vec<_>>(), EXPLAINED) / EXPLAINED_DEVIATIONS
        };
        let mut free = 0;
        for _ in 0..ROUNDS {
            let limit = IS_FREE * noise(&values);
            let (mut normal, mut right) = (DMatrix::zeros(4, 4), DVector::zeros(4));
            free = 0;
            for i in moving.iter().filter(|i| force(i, &values).abs() < limit) {
                free += 1;
                let row = row(i);
                for a in 0..4 {
                    right[a] += row[a] * i.input;
                    for b in 0..=a {
                        normal[(a, b)] += row[a] * row[b];
                    }
                }
            }
            let (solution, _) = solved(normal, right)?;
            values = [solution[0], solution[1], solution[2], solution[3]];
        }
        let mostly = f64::from(free) > FREE * moving.len() as f64;
        let forces = intervals.iter().map(|i| force(i, &values)).collect();
        (mostly && values[0] > 0.0)
            .then(|| ([values[0], values[1].max(0.0)], forces, noise(&values)))
    }
}

/// What a load is judged by.
struct Seen<'a> {
    step: f64,
    intervals: &'a [Interval],
    forces: &'a [f64],
    pushes: &'a [usize],
}

/// What explains the place of the body at the pushes: what its push does to the load, and what the drag, the dry
/// friction and a constant force on the body would, if they are not yet right; dry friction of the load, half gap,
/// compliance of the contact, and place and velocity at which the load began.
const COLUMNS: usize = 9;

/// The place of the body at the pushes as far as they explain it.
struct Line {
    coefficients: [f64; COLUMNS],
    left: f64,
}

/// Place of the load at the pushes, and its velocity after each interval, under a force.
#[derive(Default)]
struct Answer {
    places: Vec<f64>,
    velocities: Vec<f64>,
}

impl Seen<'_> {
    /// The line for a load that is slowed down at this rate, 1/s.
    fn line(&self, rate: f64) -> Option<Line> {
        let velocities: Vec<f64> = self.intervals.iter().map(|i| i.velocity).collect();
        let signs: Vec<f64> = velocities.iter().map(|v| sign(*v)).collect();
        let ones = vec![1.0; self.forces.len()];
        let known = [self.forces, &velocities, &signs, &ones].map(|f| self.answer(rate, f));
        let mut directions = vec![0.0; self.forces.len()];
        let mut found = None;
        for _ in 0..DIRECTIONS {
            let (line, velocity) = self.solved(rate, &known, &directions)?;
            directions = velocity.iter().map(|v| sign(*v)).collect();
            found = Some(line);
        }
        found
    }

    /// What a force does to a load that is slowed down at this rate, per inertia.
    fn answer(&self, rate: f64, force: &[f64]) -> Answer {
        let (decay, phi1, phi2) = free_body(rate, self.step);
        let (mut x, mut v) = (0.0, 0.0);
        let mut pushes = self.pushes.iter().peekable();
        let mut answer = Answer::default();
        for (k, f) in force.iter().enumerate() {
            let after = x + phi1 * v + phi2 * f;
            if pushes.next_if(|p| **p == k).is_some() {
                answer.places.push(f64::midpoint(x, after));
            }
            x = after;
            v = decay * v + phi1 * f;
            answer.velocities.push(v);
        }
        answer
    }

    /// The line if the load moved in these directions, and the velocity of the load; what the forces on the body do to
    /// it is `known`.
    fn solved(
        &self,
        rate: f64,
        known: &[Answer; 4],
        directions: &[f64],
    ) -> Option<(Line, Vec<f64>)> {
        let n = self.forces.len();
        let rubbing = self.answer(rate, directions);
        let answers: Vec<&Answer> = known.iter().chain([&rubbing]).collect();
        let row = |(place, k): (usize, &usize)| {
            let mut row = [0.0; COLUMNS];
            for (value, answer) in row.iter_mut().zip(&answers) {
                *value = answer.places[place];
            }
            let time = (*k as f64 + 0.5) * self.step;
            row[5] = sign(self.forces[*k]);
            row[6] = self.forces[*k];
            row[7] = 1.0;
            row[8] = -libm::expm1(-rate * time) / rate;
            row
        };
        let rows: Vec<[f64; COLUMNS]> = self.pushes.iter().enumerate().map(row).collect();
        let rubs = directions.iter().any(|d| *d != 0.0);
        let used: Vec<usize> = (0..COLUMNS).filter(|c| rubs || *c != 4).collect();
        let p = used.len();
        let (mut normal, mut right) = (DMatrix::zeros(p, p), DVector::zeros(p));
        for (row, k) in rows.iter().zip(self.pushes) {
            for (a, c) in used.iter().enumerate() {
                right[a] += row[*c] * self.intervals[*k].position;
                for (b, d) in used[..=a].iter().enumerate() {
                    normal[(a, b)] += row[*c] * row[*d];
                }
            }
        }
        let (solution, _) = solved(normal, right)?;
        let mut coefficients = [0.0; COLUMNS];
        for (c, value) in used.iter().zip(solution.iter()) {
            coefficients[*c] = *value;
        }
        let sizes = rows.iter().zip(self.pushes).map(|(row, k)| {
            let said: f64 = row.iter().zip(&coefficients).map(|(r, c)| r * c).sum();
            (self.intervals[*k].position - said).abs()
        });
        let sizes: Vec<f64> = sizes.collect();
        let most = ODD * quantile(&mut sizes.clone(), 0.5);
        let squares = sizes.iter().map(|s| s.min(most).powi(2));
        let mean = squares.sum::<f64>() / sizes.len() as f64;
        let velocity = (0..n).map(|k| {
            let time = (k + 1) as f64 * self.step;
            let parts = answers.iter().zip(&coefficients);
            let pushed: f64 = parts.map(|(a, c)| a.velocities[k] * c).sum();
            pushed + coefficients[8] * libm::exp(-rate * time)
        });
        let velocity = velocity.collect();
        let left = mean.sqrt();
        Some((Line { coefficients, left }, velocity))
    }
}
