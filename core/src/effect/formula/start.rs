//! Where the fit of a formula starts: points spread over sizes that make sense for each parameter, judged by
//! one regression each.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::parse::Expr;
use crate::effect::{Dimension, Probe};
use crate::model::Instant;

/// Points that are tried, and steps from each of the best.
const TRIED: usize = 240;
const STEPS: usize = 30;

/// Points that are given.
const BEST: usize = 3;

/// Seed of the points: the same for the same formula.
const SEED: u64 = 1;

/// A parameter that is no place is between this share of its typical size and that size.
const SMALLEST: f64 = 3e-3;

/// Whether the force is linear in each parameter, all of those together: tried at a few points.
pub(super) fn linear(tree: &Expr, count: usize) -> Vec<bool> {
    let mut random = Pcg64::seed_from_u64(SEED);
    let mut draw = |low: f64, high: f64| random.random_range(low..high);
    let mut chosen = vec![false; count];
    for index in 0..count {
        chosen[index] = true;
        let affine = (0..12).all(|_| {
            let at = Instant {
                position: draw(-2.0, 2.0),
                velocity: draw(-2.0, 2.0),
                input: draw(-2.0, 2.0),
                time: draw(0.1, 2.0),
            };
            let others: Vec<f64> = (0..count).map(|_| draw(0.3, 2.0)).collect();
            let value = |linear: &[f64]| {
                let both = others.iter().zip(linear).zip(&chosen);
                let all: Vec<f64> = both.map(|((o, l), c)| if *c { *l } else { *o }).collect();
                tree.value(&at, &all)
            };
            let a: Vec<f64> = (0..count).map(|_| draw(-2.0, 2.0)).collect();
            let b: Vec<f64> = (0..count).map(|_| draw(-2.0, 2.0)).collect();
            let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + b).collect();
            let zero = value(&vec![0.0; count]);
            let (left, right) = (value(&sum) + zero, value(&a) + value(&b));
            // Where the formula has no value nothing can be said against it.
            !(left - right).is_finite()
                || (left - right).abs() <= 1e-9 * (left.abs() + right.abs() + zero.abs() + 1e-9)
        });
        chosen[index] = affine;
    }
    chosen
}

/// Whether a force is left where all parameters are 0: tried at a few points.
pub(super) fn leaves_a_force(tree: &Expr, count: usize) -> bool {
    let mut random = Pcg64::seed_from_u64(SEED);
    let mut draw = |low: f64, high: f64| random.random_range(low..high);
    let zeros = vec![0.0; count];
    (0..12).any(|_| {
        let at = Instant {
            position: draw(-2.0, 2.0),
            velocity: draw(-2.0, 2.0),
            input: draw(-2.0, 2.0),
            time: draw(0.1, 2.0),
        };
        tree.value(&at, &zeros) != 0.0
    })
}

/// Order of the parameters in the effect: the first one in which the force is linear leads, since it tells
/// whether the effect is there at all.
pub(super) fn order(tree: &Expr, count: usize) -> Vec<usize> {
    let linear = linear(tree, count);
    let leading = linear.iter().position(|l| *l).unwrap_or(0);
    let mut order = vec![leading];
    order.extend((0..count).filter(|k| *k != leading));
    order
}

/// A force at an instant.
type Force<'a> = dyn Fn(&Instant) -> f64 + 'a;

/// A point with the share of the squared error that it leaves.
type Trial = (Vec<f64>, f64);

/// Values to start from, in the order of the tree, the best first.
pub(super) fn starts(
    tree: &Expr,
    dimensions: &[Dimension],
    linear: &[bool],
    probe: &Probe,
) -> Vec<Vec<f64>> {
    let bent = linear.iter().filter(|l| !**l).count();
    let mut random = Pcg64::seed_from_u64(SEED);
    let tried = if bent == 0 { 1 } else { TRIED };
    let mut trials: Vec<Trial> = Vec::new();
    for _ in 0..tried {
        let point: Vec<f64> = dimensions
            .iter()
            .map(|d| draw(*d, probe, &mut random))
            .collect();
        trials.extend(judge(tree, linear, probe, point));
    }
    trials.sort_by(|a, b| a.1.total_cmp(&b.1));
    trials.truncate(BEST);
    if bent > 0 {
        for trial in &mut trials {
            improve(trial, tree, linear, probe, &mut random);
        }
    }
    trials.sort_by(|a, b| a.1.total_cmp(&b.1));
    if trials.is_empty() {
        // Nothing to go by: small sizes, so that the fit may still try.
        let sizes = dimensions.iter().map(|d| 0.1 * probe.scales.of(*d));
        return vec![sizes.collect()];
    }
    trials.into_iter().map(|t| t.0).collect()
}

/// A value that makes sense: a place within the measured range, or a size.
fn draw(dimension: Dimension, probe: &Probe, random: &mut Pcg64) -> f64 {
    let place = match dimension {
        Dimension::Position => Some(probe.position_range()),
        Dimension::Speed
        | Dimension::Compound {
            output: 1,
            force: 0,
            time: 0,
            ..
        } => Some(probe.velocity_range()),
        Dimension::Time => Some((0.0, probe.scales.duration)),
        _ => None,
    };
    let size = match dimension {
        Dimension::Time => probe.scales.duration,
        d => probe.scales.of(d),
    };
    let size = if size.is_finite() && size != 0.0 {
        size
    } else {
        1.0
    };
    match place {
        Some((low, high)) if low < high && random.random_bool(0.5) => {
            random.random_range(low..high)
        }
        _ => {
            // Frequencies over the position and numbers may well be larger than typical.
            let top = match dimension {
                Dimension::PerPosition => 300.0,
                Dimension::Ratio | Dimension::Undetermined => 10.0,
                _ => 1.0,
            };
            size * SMALLEST * libm::pow(top / SMALLEST, random.random_range(0.0..1.0))
        }
    }
}

/// The point with its linear parameters regressed; `None` where the formula leaves no trace there.
fn judge(tree: &Expr, linear: &[bool], probe: &Probe, mut point: Vec<f64>) -> Option<Trial> {
    let chosen: Vec<usize> = (0..point.len()).filter(|k| linear[*k]).collect();
    let base: Vec<f64> = point
        .iter()
        .zip(linear)
        .map(|(p, l)| if *l { 0.0 } else { *p })
        .collect();
    if chosen.is_empty() {
        let fit = probe.regress_instants(&[&|at| finite(tree.value(at, &point))])?;
        // Its size is part of the formula: a coefficient far from 1 is as bad as none.
        let misfit = (fit.coefficients[0] - 1.0).abs().min(1.0);
        return Some((point, fit.left + (1.0 - fit.left) * misfit));
    }
    let units: Vec<Vec<f64>> = chosen
        .iter()
        .map(|k| {
            let mut unit = base.clone();
            unit[*k] = 1.0;
            unit
        })
        .collect();
    let forces: Vec<Box<Force>> = units
        .iter()
        .map(|unit| -> Box<Force> {
            let base = &base;
            Box::new(move |at| finite(tree.value(at, unit)) - finite(tree.value(at, base)))
        })
        .collect();
    let references: Vec<&Force> = forces.iter().map(AsRef::as_ref).collect();
    let fit = probe.regress_instants(&references)?;
    for (k, coefficient) in chosen.iter().zip(&fit.coefficients) {
        point[*k] = *coefficient;
    }
    Some((point, fit.left))
}

/// As the model takes it.
fn finite(force: f64) -> f64 {
    if force.is_finite() { force } else { 0.0 }
}

/// Small steps from a point, those that make it better.
fn improve(trial: &mut Trial, tree: &Expr, linear: &[bool], probe: &Probe, random: &mut Pcg64) {
    let mut reach = 0.3;
    for _ in 0..STEPS {
        let point: Vec<f64> = trial
            .0
            .iter()
            .zip(linear)
            .map(|(p, l)| {
                if *l {
                    *p
                } else {
                    p * (1.0 + reach * random.random_range(-1.0..1.0))
                }
            })
            .collect();
        match judge(tree, linear, probe, point) {
            Some(better) if better.1 < trial.1 => *trial = better,
            _ => reach *= 0.93,
        }
    }
}
