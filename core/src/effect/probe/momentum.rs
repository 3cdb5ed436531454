//! Body and missing force together, from the balance of momentum.
//!
//! Over a stretch of the record the input gives to the body what it gains in momentum, what viscous friction takes, and
//! what the missing force takes. That is linear in inertia, friction and force, asks for no model before, and for no
//! state of a window: where a missing force has bent the body of the present model far off, it is told here.

use std::f64::consts::SQRT_2;

use nalgebra::{DMatrix, DVector};

use super::Probe;
use super::equations::solved;
use super::spatial::{APART, FASTEST_SPATIAL, Row, rows};
use crate::effect::spec::SEEN_TURN;
use crate::sums::dot;

/// Samples at most that are looked at, and for waves along the way, of which many are tried.
const LOOKED_AT: usize = 60_000;
const LOOKED_AT_FOR_WAVES: usize = 6_000;

/// Samples of a stretch at most, the share of the change of velocity over it that may be noise, and stretches at least.
const LONGEST: usize = 512;
const NOISE: f64 = 0.1;
const LEAST: usize = 40;

/// Stretches at least of a body that rests for most of the record: whether they are enough is asked of what they tell.
const FEW: usize = 6;

/// Standard deviations of its noise above which a velocity is one.
const MOVES: f64 = 3.0;

/// Standard errors by which an inertia must differ from none to contradict another one, the share of the impulse of the
/// input that its balance may leave, since a load that is met or swings has impulses of its own, and the one by which
/// the other inertia must miss it.
const CERTAIN: f64 = 20.0;
const BALANCED: f64 = 0.2;
const IMPOSSIBLE: f64 = 50.0;

/// A force speaks for another body if it leaves less than this share of what none does.
const CLEARLY: f64 = 0.7;

/// Displacements over which friction may build up that are tried, from a part of the travel on, and the share of what
/// it leaves when it builds up at once that the best must leave.
const DISPLACEMENTS: u32 = 16;
const DISPLACEMENTS_PER_DECADE: u32 = 5;
const GRADUAL: f64 = 0.9;

/// Waves along the way that are tried at most; parts of their distance in which the best of them is looked for, and how
/// often among ever closer ones.
const MOST_WAVES: usize = 500;
const PARTS: i32 = 5;
const FINER: usize = 2;

/// Inertia, viscous friction and missing forces, as the balance of momentum tells them.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance {
    /// Inertia and viscous friction of the body.
    pub body: [f64; 2],
    /// Missing force per unit of each signature.
    pub forces: Vec<f64>,
    /// Share of the impulse of the input that is left.
    pub left: f64,
}

/// A body that rubs under a constant force, as the balance of momentum tells while it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rubbing {
    /// Inertia and viscous friction.
    pub body: [f64; 2],
    /// Force beside the input.
    pub load: f64,
}

/// The values that are kept.
fn only<T: Copy>(kept: &[bool], values: &[T]) -> Vec<T> {
    let pairs = values.iter().zip(kept);
    pairs.filter(|(_, kept)| **kept).map(|(v, _)| *v).collect()
}

/// The record in stretches, one after the other.
struct Stretches {
    samples: usize,
    /// Velocity at the samples, and its noise.
    velocity: Vec<f64>,
    noise: f64,
    /// First samples.
    begins: Vec<usize>,
    /// Impulse of the input, gain of velocity, way, and duration.
    impulse: Vec<f64>,
    known: [Vec<f64>; 3],
}

impl Stretches {
    /// Sum of a rate over each stretch, from its values at the samples, times `step`.
    fn sums(&self, step: f64, rate: impl Fn(usize) -> f64) -> Vec<f64> {
        let over = |from: &usize| {
            let inner: f64 = (from + 1..from + self.samples).map(&rate).sum();
            let ends = 0.5 * (rate(*from) + rate(from + self.samples));
            step * (inner + ends)
        };
        self.begins.iter().map(over).collect()
    }

    /// Those in which the body moves one way throughout, if there are enough: dry friction holds a body at rest with
    /// any force up to its level.
    fn in_motion(&self, least: usize) -> Option<Self> {
        let still = MOVES * self.noise;
        let moves = |from: &usize| {
            let part = &self.velocity[*from..=from + self.samples];
            part.iter().all(|v| *v > still) || part.iter().all(|v| *v < -still)
        };
        let kept: Vec<bool> = self.begins.iter().map(moves).collect();
        let enough = kept.iter().filter(|k| **k).count() >= least;
        enough.then(|| Self {
            begins: only(&kept, &self.begins),
            impulse: only(&kept, &self.impulse),
            known: self.known.each_ref().map(|column| only(&kept, column)),
            velocity: self.velocity.clone(),
            ..*self
        })
    }

    /// What each of these takes, as the impulse of the input tells, and the share of that which is left.
    fn shared_among(&self, columns: &[&[f64]]) -> Option<(DVector<f64>, f64)> {
        let p = columns.len();
        let normal = DMatrix::from_fn(p, p, |a, b| dot(columns[a], columns[b]));
        let right = DVector::from_fn(p, |a, _| dot(columns[a], &self.impulse));
        let power = dot(&self.impulse, &self.impulse);
        let (solution, explained) = solved(normal, right)?;
        Some((solution, (1.0 - explained / power).max(0.0)))
    }

    /// Share of the impulse of the input that a body by itself leaves.
    fn left_alone(&self) -> Option<f64> {
        let [gain, way, duration] = &self.known;
        Some(self.shared_among(&[gain, way, duration])?.1)
    }

    /// Body and forces of which these are the impulses per unit.
    fn balance(&self, forces: &[Vec<f64>]) -> Option<Balance> {
        let columns: Vec<&[f64]> = self.known.iter().chain(forces).map(Vec::as_slice).collect();
        let (solution, left) = self.shared_among(&columns)?;
        let (inertia, viscous) = (solution[0], solution[1].max(0.0));
        (inertia > 0.0).then(|| Balance {
            body: [inertia, viscous],
            forces: solution.iter().skip(3).map(|f| -f).collect(),
            left,
        })
    }
}

impl Probe {
    /// Stretches over which the change of velocity is more than noise, in so many first samples.
    fn in_stretches(&self, most: usize) -> Option<Stretches> {
        let n = self.velocity.len().min(self.acting.len()).min(most);
        let (velocity, noise) = self.sharpest_velocity(n);
        let v = &velocity[..];
        let change = |m: usize| {
            let squares: f64 = (m..n).map(|k| (v[k] - v[k - m]).powi(2)).sum();
            (squares / (n - m) as f64).sqrt()
        };
        let lengths = (1..).map(|k| 1_usize << k).take_while(|m| *m <= LONGEST);
        let mut fit = lengths.filter(|m| n / m >= LEAST);
        let samples = fit.find(|m| SQRT_2 * noise <= NOISE * change(*m))?;
        let begins: Vec<usize> = (0..n - samples).step_by(samples).collect();
        let step = self.scales.step;
        let between = |values: &[f64]| -> Vec<f64> {
            begins
                .iter()
                .map(|k| values[k + samples] - values[*k])
                .collect()
        };
        let impulse = begins
            .iter()
            .map(|k| step * self.acting[*k..k + samples].iter().sum::<f64>());
        let stretches = Stretches {
            samples,
            impulse: impulse.collect(),
            known: [
                between(v),
                between(&self.position),
                vec![samples as f64 * step; begins.len()],
            ],
            begins,
            noise,
            velocity,
        };
        Some(stretches)
    }

    /// The velocity of the first samples as it was measured or as the measured position says, whichever has less noise,
    /// and its noise.
    fn sharpest_velocity(&self, n: usize) -> (Vec<f64>, f64) {
        // White noise, as far as three samples in a row may be off a line.
        let noise = |v: &[f64]| {
            let bends = v.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2));
            (bends.sum::<f64>() / (6.0 * v.len() as f64)).sqrt()
        };
        let measured = self.velocity[..n].to_vec();
        let own = noise(&measured);
        if self.outputs.iter().all(|(is_velocity, _)| *is_velocity) {
            return (measured, own);
        }
        let x = &self.position[..n];
        let mut told = measured.clone();
        for k in 1..n.saturating_sub(1) {
            told[k] = (x[k + 1] - x[k - 1]) / (2.0 * self.scales.step);
        }
        let other = noise(&told);
        if other < own {
            (told, other)
        } else {
            (measured, own)
        }
    }

    /// Inertia of the body if no force is missing.
    pub(super) fn inertia_by_momentum(&self) -> Option<f64> {
        Some(self.in_stretches(LOOKED_AT)?.balance(&[])?.body[0])
    }

    /// The body as it moves, whatever dry friction there is beside, where that contradicts an inertia of `present`: all
    /// that the input gave could not have moved it so.
    pub fn other_body(&self, present: f64) -> Option<Rubbing> {
        let moving = self.in_stretches(LOOKED_AT)?.in_motion(FEW)?;
        let dry = moving.sums(self.scales.step, |k| moving.velocity[k].signum());
        let [gain, way, duration] = &moving.known;
        let (told, left) = moving.shared_among(&[gain, way, duration, &dry])?;
        let (_, weightless) = moving.shared_among(&[way, duration, &dry])?;
        let due = weightless - left;
        let certain =
            left < BALANCED && due * moving.begins.len() as f64 > CERTAIN * CERTAIN * left;
        let off = present / told[0] - 1.0;
        let found = Rubbing {
            body: [told[0], told[1].max(0.0)],
            load: -told[2],
        };
        (told[0] > 0.0 && certain && left + due * off * off > IMPOSSIBLE).then_some(found)
    }

    /// Body and a missing force of this signature while the body moves, where that leaves clearly less than no force.
    pub fn balanced_in_motion(&self, force: impl Fn(f64, f64) -> f64) -> Option<Balance> {
        let all = self.in_stretches(LOOKED_AT)?;
        let stretches = all.in_motion(LEAST).unwrap_or(all);
        let at = |k: usize| force(self.position[k], stretches.velocity[k]);
        let alone = stretches.balance(&[])?;
        let sums = stretches.sums(self.scales.step, at);
        let found = stretches.balance(&[sums])?;
        (found.left < CLEARLY * alone.left).then_some(found)
    }

    /// Body and dry friction that builds up over a displacement, with that, where it leaves clearly less than no
    /// friction and less than one that builds up at once; a contact that gives way tells of itself at rest, too.
    pub fn balanced_bristle(&self) -> Option<(f64, Balance)> {
        let stretches = self.in_stretches(LOOKED_AT)?;
        let bent = |displacement: f64| -> Option<(f64, Balance)> {
            let deflection = self.deflection(displacement);
            let sums = stretches.sums(self.scales.step, |k| -deflection[k]);
            Some((displacement, stretches.balance(&[sums])?))
        };
        let finer = libm::pow(10.0, -1.0 / f64::from(DISPLACEMENTS_PER_DECADE));
        let tried = self.crew.gather(DISPLACEMENTS as usize, |i| {
            bent(self.scales.travel * libm::pow(finer, i as f64 + 1.0))
        });
        let at_once = tried.last()?.as_ref().map_or(1.0, |t| t.1.left);
        let best = tried.into_iter().flatten();
        let best = best.min_by(|a, b| a.1.left.total_cmp(&b.1.left))?;
        let alone = stretches.left_alone()?;
        let clearly = best.1.left < CLEARLY * alone && best.1.left < GRADUAL * at_once;
        (clearly && best.1.forces[0] > 0.0).then_some(best)
    }

    /// Body and the force that repeats along the way, with its spatial frequency (rad per unit of position); its parts
    /// are those with the sine and the cosine.
    pub fn balanced_wave(&self) -> Option<(f64, Balance)> {
        let stretches = self.in_stretches(LOOKED_AT_FOR_WAVES)?;
        let travel = self.scales.travel;
        let spacing = APART / travel;
        let fastest = FASTEST_SPATIAL / (self.scales.speed * self.scales.step);
        let along = &self.position[..self.position.len().min(LOOKED_AT_FOR_WAVES)];
        let waves = |row: &Row| -> Vec<(f64, Balance)> {
            row.waves(along, |n, sine, cosine| {
                let forces = [sine, cosine].map(|f| stretches.sums(self.scales.step, |k| f[k]));
                Some((n, stretches.balance(&forces)?))
            })
        };
        let least = |rows: &[Row]| {
            let found = self.crew.gather(rows.len(), |i| waves(&rows[i]));
            let found = found.into_iter().flatten();
            found.min_by(|a, b| a.1.left.total_cmp(&b.1.left))
        };
        let first = (SEEN_TURN / APART).ceil();
        let count = ((fastest / spacing).floor() + 1.0 - first).min(MOST_WAVES as f64) as usize;
        let rows: Vec<Row> = rows((first - 1.0) * spacing, spacing, count).collect();
        let mut found = least(&rows)?;
        let mut apart = spacing;
        for _ in 0..FINER {
            let finer = Row {
                before: found.0 - apart * (1.0 + 1.0 / f64::from(PARTS)),
                spacing: apart / f64::from(PARTS),
                count: 2 * PARTS as usize + 1,
            };
            found = least(&[finer])?;
            apart /= f64::from(PARTS);
        }
        let alone = stretches.balance(&[])?;
        (found.1.left < CLEARLY * alone.left).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::{ProbeInput, ProbeOutput, Scales};
    use crate::measurement::Kind;
    use crate::model::runge_kutta::integrate;

    const STEP: f64 = 5e-3;
    const SAMPLES: usize = 6_000;
    const BODY: [f64; 2] = [1.3, 3.3];

    /// What a present model with quite another body is shown of a body under this force, pushed to and fro, whose
    /// velocity is measured with noise of a tenth of it.
    fn shown(force: impl Fn(f64, f64) -> f64) -> Probe {
        let [inertia, viscous] = BODY;
        let mut state = [0.0; 2];
        let (mut position, mut velocity, mut input) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..SAMPLES {
            let time = STEP * k as f64;
            let push = 0.9 * libm::sin(1.1 * time) + 0.5 * libm::sin(7.3 * time);
            position.push(state[0]);
            velocity.push(state[1] + 2e-3 * libm::sin(1e4 * libm::sin(1e3 * k as f64)));
            input.push(push);
            let rates = |[x, v]: [f64; 2], _| [v, (push - viscous * v + force(x, v)) / inertia];
            state = integrate(rates, state, STEP, 20);
        }
        let travel = position.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        Probe::new(&ProbeInput {
            kind: Kind::Drive,
            rotates: false,
            scales: Scales {
                step: STEP,
                duration: STEP * SAMPLES as f64,
                force: 0.7,
                inertia: 40.0,
                inertia_factor: 1e4,
                viscous: 50.0,
                speed: 0.03,
                travel: 2.0 * travel,
                resolution: 0.0,
                time_constant: 1.0,
            },
            position: &position,
            followed: &position,
            velocity: &velocity,
            input: &input,
            acting: &input,
            outputs: &[ProbeOutput {
                is_velocity: true,
                error: velocity.clone(),
                noise: 1e-3,
            }],
            spans: &[(0, SAMPLES)],
            body: (40.0, 50.0),
            gap: None,
            crew: &crate::crew::Crew::default(),
        })
    }

    fn check(name: &str, found: f64, truth: f64, share: f64) {
        let off = (found / truth - 1.0).abs();
        assert!(off < share, "{name} = {found}, truth {truth}");
    }

    #[test]
    fn troughs_that_hold_the_body_are_told_with_it() {
        let (amplitude, teeth) = (0.76, 349.0);
        let probe = shown(|x, _| amplitude * libm::sin(teeth * x + 0.4));
        let (n, balance) = probe.balanced_wave().expect("a wave");
        check("J", balance.body[0], BODY[0], 0.05);
        check("d", balance.body[1], BODY[1], 0.05);
        check("n", n, teeth, 0.01);
        let [sine, cosine] = balance.forces[..] else {
            panic!("two parts");
        };
        check("a", libm::hypot(sine, cosine), amplitude, 0.05);
        assert!((libm::atan2(cosine, sine) - 0.4).abs() < 0.1);
    }

    #[test]
    fn so_is_dry_friction() {
        let probe = shown(|_, v| -0.3 * libm::tanh(v / 1e-4));
        let balance = probe
            .balanced_in_motion(|_, v| -v.signum())
            .expect("a balance");
        check("J", balance.body[0], BODY[0], 0.1);
        check("c", balance.forces[0], 0.3, 0.1);
    }

    #[test]
    fn a_body_far_too_heavy_is_contradicted_and_the_load_beside_its_friction_told() {
        let probe = shown(|_, v| 0.1 - 0.3 * libm::tanh(v / 1e-4));
        let other = probe.other_body(40.0).expect("another body");
        check("J", other.body[0], BODY[0], 0.1);
        check("F0", other.load, 0.1, 0.1);
        assert_eq!(probe.other_body(1.5 * BODY[0]), None);
    }

    #[test]
    fn friction_that_builds_up_slowly_is_told_with_its_displacement() {
        let (level, displacement) = (0.3, 0.02);
        let bent = std::cell::Cell::new((0.0, 0.0));
        let probe = shown(|x, _| {
            let (last, before) = bent.get();
            let now = crate::model::dahl(before, (x - last) / displacement, 1.0);
            bent.set((x, now));
            -level * now
        });
        let (told, balance) = probe.balanced_bristle().expect("a bristle");
        check("J", balance.body[0], BODY[0], 0.1);
        check("c", balance.forces[0], level, 0.1);
        check("s", told, displacement, 0.3);
        let at_once = shown(|_, v| -0.3 * libm::tanh(v / 1e-4));
        assert_eq!(at_once.balanced_bristle(), None);
    }

    #[test]
    fn a_body_alone_needs_no_force() {
        let probe = shown(|_, _| 0.0);
        assert_eq!(probe.other_body(BODY[0]), None);
        assert_eq!(probe.balanced_bristle(), None);
        assert_eq!(probe.balanced_in_motion(|_, v| -v.signum()), None);
        assert_eq!(probe.balanced_wave(), None);
        let inertia = probe.inertia_by_momentum().expect("an inertia");
        check("J", inertia, BODY[0], 0.05);
    }
}
