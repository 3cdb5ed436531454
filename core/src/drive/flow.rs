//! The affine motion between events as a Taylor series.
//!
//! Over a step of length `h` with all rates times `h` below [`REACH`], the series of the matrix
//! exponential falls to round-off within [`TERMS`] terms; the coefficients come from the recurrence
//! `y_{k+1} = h/(k+1) (M y_k + [k = 0] b)`. Every guard is then a polynomial.

use super::polynomial::{Polynomial, TERMS, integral, value};
use super::state::{Friction, State};
use super::{Contact, Drive};

/// Largest rate times length of a step: `0.8^18 / 18!` is below round-off.
pub(super) const REACH: f64 = 0.8;

/// A term below this share of the largest ends a series.
const NEGLIGIBLE: f64 = 1e-18;

/// Motion over one step of `h` seconds, as polynomials in `z = t / h`.
#[derive(Clone, Debug)]
pub(super) struct Step {
    pub h: f64,
    /// Terms in use.
    pub terms: usize,
    pub v1: Polynomial,
    pub v2: Polynomial,
    /// `x1 - x2`.
    pub gap: Polynomial,
}

/// Constants of a drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    pub free: f64,
    pub pressed: f64,
}

impl Rates {
    /// Fastest rates of the free and of the pressed drive, 1/s.
    pub fn of(drive: &Drive) -> Self {
        let (motor, load) = (drive.motor, drive.load);
        let free = (motor.viscous / motor.inertia).max(load.viscous / load.inertia);
        let pressed = match drive.contact {
            Contact::Rigid { .. } => free,
            Contact::Compliant { stiffness, damping } => {
                let mobility = 1.0 / motor.inertia + 1.0 / load.inertia;
                free + damping * mobility + (stiffness * mobility).sqrt()
            }
        };
        Self { free, pressed }
    }
}

impl Step {
    /// The motion of `drive` from `s` under the torque `u` for `h` seconds.
    pub fn new(drive: &Drive, s: &State, u: f64, h: f64) -> Self {
        if s.joint.is_some() && matches!(drive.contact, Contact::Rigid { .. }) {
            return Self::together(drive, s, u, h);
        }
        let (motor, load) = (drive.motor, drive.load);
        let (j1, j2) = (1.0 / motor.inertia, 1.0 / load.inertia);
        let (l1, l2) = (motor.viscous * j1, load.viscous * j2);
        let push1 = (u - s.motor.sign() * motor.coulomb) * j1;
        let push2 = -s.load.sign() * load.coulomb * j2;
        let (free1, free2) = (s.motor != Friction::Stuck, s.load != Friction::Stuck);
        let spring = s.spring(drive);
        let mut step = Self::at(s, h);
        let (mut size_v, mut size_gap) = (s.v1.abs().max(s.v2.abs()), s.gap.abs());
        for k in 0..TERMS - 1 {
            let (v1, v2, gap) = (step.v1[k], step.v2[k], step.gap[k]);
            let first = if k == 0 { 1.0 } else { 0.0 };
            let force = spring.map_or(0.0, |f| {
                f.stiffness * gap + f.damping * (v1 - v2) - first * f.offset
            });
            let scale = h / (k + 1) as f64;
            if free1 {
                let rate = first * push1 - l1 * v1 - force * j1;
                let forces = (u.abs() + motor.coulomb + force.abs()) * j1;
                step.v1[k + 1] = scale * at_break_away(rate, k == 0 && v1 == 0.0, forces);
            }
            if free2 {
                let rate = first * push2 - l2 * v2 + force * j2;
                let forces = (load.coulomb + force.abs()) * j2;
                step.v2[k + 1] = scale * at_break_away(rate, k == 0 && v2 == 0.0, forces);
            }
            step.gap[k + 1] = scale * (v1 - v2);
            let term_v = step.v1[k + 1].abs().max(step.v2[k + 1].abs());
            let term_gap = step.gap[k + 1].abs();
            size_v = size_v.max(term_v);
            size_gap = size_gap.max(term_gap);
            step.terms = k + 2;
            if k > 0 && term_v <= NEGLIGIBLE * size_v && term_gap <= NEGLIGIBLE * size_gap {
                break;
            }
        }
        step
    }

    /// Both masses as one.
    fn together(drive: &Drive, s: &State, u: f64, h: f64) -> Self {
        let mut step = Self::at(s, h);
        if s.motor == Friction::Stuck {
            return step;
        }
        let inertia = drive.motor.inertia + drive.load.inertia;
        let rate = (drive.motor.viscous + drive.load.viscous) / inertia;
        let dry = s.motor.sign() * (drive.motor.coulomb + drive.load.coulomb);
        let mut term = h * ((u - dry) / inertia - rate * s.v1);
        let mut size = s.v1.abs();
        for k in 1..TERMS {
            step.v1[k] = term;
            step.terms = k + 1;
            size = size.max(term.abs());
            if term.abs() <= NEGLIGIBLE * size {
                break;
            }
            term *= -rate * h / (k + 1) as f64;
        }
        step.v2 = step.v1;
        step
    }

    fn at(s: &State, h: f64) -> Self {
        let mut step = Self {
            h,
            terms: 1,
            v1: [0.0; TERMS],
            v2: [0.0; TERMS],
            gap: [0.0; TERMS],
        };
        (step.v1[0], step.v2[0], step.gap[0]) = (s.v1, s.v2, s.gap);
        step
    }

    /// `constant + a v1 + b v2 + c (x1 - x2)` as a polynomial.
    pub fn combine(&self, constant: f64, a: f64, b: f64, c: f64) -> Polynomial {
        let mut sum = [0.0; TERMS];
        for (k, sum) in sum.iter_mut().enumerate().take(self.terms) {
            *sum = a * self.v1[k] + b * self.v2[k] + c * self.gap[k];
        }
        sum[0] += constant;
        sum
    }

    /// `a dv1/dt + b v1 + constant` as a polynomial.
    pub fn motor_force(&self, a: f64, b: f64, constant: f64) -> Polynomial {
        let mut sum = [0.0; TERMS];
        for (k, sum) in sum.iter_mut().enumerate().take(self.terms) {
            // The last power has none above it, which is below round-off anyway.
            let next = self.v1.get(k + 1).copied().unwrap_or(0.0);
            *sum = a * (k + 1) as f64 * next / self.h + b * self.v1[k];
        }
        sum[0] += constant;
        sum
    }

    /// Distance that the motor has come at `z`.
    pub fn motor_travel(&self, z: f64) -> f64 {
        self.h * integral(&self.v1[..self.terms], z)
    }

    /// Velocities and gap at `z`.
    pub fn values(&self, z: f64) -> [f64; 3] {
        [
            value(&self.v1[..self.terms], z),
            value(&self.v2[..self.terms], z),
            value(&self.gap[..self.terms], z),
        ]
    }
}

/// Share of the forces below which they count as balanced.
const BALANCED: f64 = 1e-12;

/// The acceleration of a mass that may just break away: at rest, with forces that balance its friction, it
/// is zero, and round-off must not choose the direction. What the forces do next does.
fn at_break_away(rate: f64, at_rest: bool, forces: f64) -> f64 {
    if at_rest && rate.abs() <= BALANCED * forces {
        0.0
    } else {
        rate
    }
}
