//! The backlash map: load position against motor position, where both are measured.

use serde::{Deserialize, Serialize};

use crate::measurement::{Measurement, Quantity};
use crate::order::{median, range};

/// Fewest samples of a branch.
const FEWEST: usize = 50;

/// Fewest samples in which the load is pushed one way, for a branch.
const FEWEST_PUSHED: usize = 10;

/// Least acceleration of a pushed load, as share of the largest in the record.
const PUSHED: f64 = 0.25;

/// Distance from the middle of all offsets, as share of half their range, from which a push is believed:
/// dry friction slows the load with a force against its motion as well, but near the other branch.
const OUTER: f64 = 0.3;

/// Second difference of the load's position, as share of the motor's travel, below which it does not move: an encoder of
/// 30 bits over the travel resolves no less, and what a computed load does there is round-off.
const RESOLVED: f64 = 1e-9;

/// Half window of the second difference, samples; the least in which the largest acceleration stands out
/// by `CLEAR` from what the noise makes of it.
const WINDOWS: std::ops::RangeInclusive<usize> = 2..=16;
const CLEAR: f64 = 12.0;

/// One branch of the map: the load pushed one way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Branch {
    /// `x1 - x2` on the branch, rad or m.
    pub offset: f64,
    /// Spread of the offset about it: compliance and noise, rad or m.
    pub spread: f64,
    /// Samples on the branch.
    pub samples: usize,
}

/// Load position against motor position.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BacklashMap {
    /// Motor and load position of each sample, rad or m.
    pub points: Vec<[f64; 2]>,
    /// The load pushed forwards; `None` where it never was.
    pub positive: Option<Branch>,
    /// The load pushed backwards.
    pub negative: Option<Branch>,
    /// Distance of the branches: the whole gap, with what the contact yields.
    pub gap: Option<f64>,
    /// Middle of the branches: 0 where the load stood in the middle of its gap at zero.
    pub asymmetry: Option<f64>,
    /// `rad` or `m`.
    pub unit: String,
}

/// Why there is no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
pub enum MapError {
    /// A column is missing.
    #[error("no column {0}; the map needs the positions x1 of the motor and x2 of the load")]
    NoColumn(&'static str),
    /// Too little to see a branch.
    #[error("{0} samples are too few for a map; expected at least {FEWEST}")]
    TooShort(usize),
}

/// The map of a record with `x1` and `x2` (Fig. 7 of the paper): the gap as a reference, and how unlike the branches are.
///
/// Where the load accelerates outwards it is pushed, and there `x1 - x2` is the half gap plus what the
/// contact yields, which grows with the acceleration. The branch is the offset where the line through
/// those samples meets zero acceleration: the touch itself.
pub fn backlash_map(measurement: &Measurement) -> Result<BacklashMap, MapError> {
    let motor = measurement
        .output(Quantity::Position)
        .ok_or(MapError::NoColumn("x1"))?;
    let load = measurement
        .reference
        .iter()
        .find(|c| c.quantity == Quantity::LoadPosition)
        .ok_or(MapError::NoColumn("x2"))?;
    let points: Vec<[f64; 2]> = motor
        .values
        .iter()
        .zip(&load.values)
        .filter(|(a, b)| a.is_finite() && b.is_finite())
        .map(|(a, b)| [*a, *b])
        .collect();
    if points.len() < FEWEST {
        return Err(MapError::TooShort(points.len()));
    }
    let offset = |i: usize| points[i][0] - points[i][1];
    let offsets: Vec<f64> = (0..points.len()).map(offset).collect();
    let (low, high) = range(&offsets);
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let (window, accelerations) = accelerations(&points);
    let largest = accelerations.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
    let (least, most) = range(&points.iter().map(|p| p[0]).collect::<Vec<_>>());
    if largest < RESOLVED * (most - least) {
        return Ok(untouched(points, motor.unit.clone()));
    }
    let branch = |sign: f64| {
        let pushed: Vec<[f64; 2]> = accelerations
            .iter()
            .enumerate()
            .map(|(i, a)| [sign * a, offset(i + window)])
            .filter(|[a, d]| *a > PUSHED * largest && sign * (d - middle) > OUTER * half)
            .collect();
        touch(&pushed)
    };
    let (positive, negative) = (branch(1.0), branch(-1.0));
    let both = positive.zip(negative);
    Ok(BacklashMap {
        positive,
        negative,
        gap: both.map(|(p, n)| p.offset - n.offset),
        asymmetry: both.map(|(p, n)| 0.5 * (p.offset + n.offset)),
        unit: motor.unit.clone(),
        points,
    })
}

/// The map of a load that did not move.
fn untouched(points: Vec<[f64; 2]>, unit: String) -> BacklashMap {
    BacklashMap {
        points,
        positive: None,
        negative: None,
        gap: None,
        asymmetry: None,
        unit,
    }
}

/// Second differences of the load's position (rad or m in the window squared), and the half window.
fn accelerations(points: &[[f64; 2]]) -> (usize, Vec<f64>) {
    let quantum = points
        .windows(2)
        .map(|w| (w[1][1] - w[0][1]).abs())
        .filter(|d| *d > 0.0)
        .fold(f64::INFINITY, f64::min);
    let mut rough: Vec<f64> = points
        .windows(4)
        .map(|w| (w[3][1] - 3.0 * w[2][1] + 3.0 * w[1][1] - w[0][1]).abs())
        .collect();
    // Third differences of white noise have sqrt(20) times its size.
    let noise = median(&mut rough) / 20.0_f64.sqrt();
    let noise = if quantum.is_finite() {
        noise.max(quantum)
    } else {
        noise
    };
    let mut found = (*WINDOWS.start(), Vec::new());
    for window in WINDOWS {
        if points.len() <= 2 * window {
            break;
        }
        let values: Vec<f64> = points
            .windows(2 * window + 1)
            .map(|w| w[2 * window][1] - 2.0 * w[window][1] + w[0][1])
            .collect();
        let clear = values.iter().any(|a| a.abs() > CLEAR * noise);
        found = (window, values);
        if clear {
            break;
        }
    }
    found
}

/// The offset at which the load is touched: where the line of offset against acceleration meets zero.
fn touch(pushed: &[[f64; 2]]) -> Option<Branch> {
    if pushed.len() < FEWEST_PUSHED {
        return None;
    }
    let n = pushed.len() as f64;
    let (ma, md) = pushed
        .iter()
        .fold((0.0, 0.0), |(a, d), p| (a + p[0] / n, d + p[1] / n));
    let (mut own, mut with) = (0.0, 0.0);
    for [a, d] in pushed {
        own += (a - ma) * (a - ma);
        with += (a - ma) * (d - md);
    }
    let slope = if own > 0.0 { with / own } else { 0.0 };
    let spread = pushed
        .iter()
        .map(|[a, d]| (d - md - slope * (a - ma)).powi(2))
        .sum::<f64>();
    Some(Branch {
        offset: md - slope * ma,
        spread: (spread / n).sqrt(),
        samples: pushed.len(),
    })
}
