//! The backlash map: load position against motor position, where both are measured.

use serde::{Deserialize, Serialize};

use crate::measurement::{Measurement, Quantity};
use crate::message::{Message, says};
use crate::msg;
use crate::order::{NORMAL_MEDIAN, median, range};

/// Fewest samples of a branch.
const FEWEST: usize = 50;

/// Fewest samples in which the load is pushed one way, for a branch.
const FEWEST_PUSHED: usize = 10;

/// Least acceleration of a pushed load, as share of the largest in the record.
const PUSHED: f64 = 0.25;

/// Distance from the middle of all offsets, as share of half their range, from which a push is believed:
/// dry friction slows the load with a force against its motion as well, but near the other branch.
const OUTER: f64 = 0.3;

/// Second difference of the load's position, as share of the motor's travel, below which it does not move: an encoder
/// of 30 bits over the travel resolves no less, and what a computed load does there is round-off.
const RESOLVED: f64 = 1e-9;

/// Share of the span of `x1 - x2` that a gap must be: what the contacts yield is the rest, and a spring that yields
/// more than it joins has no gap that could be told from it.
const MOSTLY_GAP: f64 = 0.5;

/// Part of the gap about its middle, on either side, and the share of the samples in it in which the load may be
/// pushed.
const INNER: f64 = 0.25;
const FREE_OF_PUSHES: f64 = 0.05;

/// Half window of the second difference, samples; the least in which the largest acceleration stands out
/// by `CLEAR` from what the noise makes of it: six of its standard deviations, since there are many.
const WINDOWS: std::ops::RangeInclusive<usize> = 2..=16;
const CLEAR: f64 = 15.0;

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
    /// Distance of the branches: the whole gap. `None` where the map shows none.
    pub gap: Option<f64>,
    /// Why it shows none.
    pub silence: Option<MapSilence>,
    /// Middle of the branches: 0 where the load stood in the middle of its gap at zero.
    pub asymmetry: Option<f64>,
    /// `rad` or `m`.
    pub unit: String,
}

/// Why a map shows no gap.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MapSilence {
    /// The load did not move by more than its sensor can tell.
    NotMoved,
    /// It was pushed one way at most.
    OneWay,
    /// What joins the masses yields over most of the way that they move against each other, as a shaft or preloaded
    /// gears do.
    Yields {
        /// From the least to the largest `x1 - x2`, rad or m.
        span: f64,
    },
}

/// Why there is no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
pub enum MapError {
    /// A column is missing.
    NoColumn(&'static str),
    /// Too little to see a branch.
    TooShort(usize),
}

impl MapError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::NoColumn(given) => msg!(
                "no column {}; the map needs the positions x1 of the motor and x2 of the load",
                given
            ),
            Self::TooShort(given) => msg!(
                "{} samples are too few for a map; expected at least {}",
                given,
                FEWEST
            ),
        }
    }
}

says!(MapError);

/// The map of a record with `x1` and `x2` (Fig. 7 of the paper): the gap as a reference, and how unlike the branches
/// are.
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
    let (least, most) = range(&points.iter().map(|p| p[0]).collect::<Vec<_>>());
    let Some((window, accelerations)) = accelerations(&points, RESOLVED * (most - least)) else {
        return Ok(BacklashMap {
            points,
            positive: None,
            negative: None,
            gap: None,
            silence: Some(MapSilence::NotMoved),
            asymmetry: None,
            unit: motor.unit.clone(),
        });
    };
    let largest = accelerations.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
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
    let gap = both.map(|(p, n)| p.offset - n.offset);
    let span = high - low;
    // A gap is where nothing pushes.
    let pushed_within = |gap: f64, at: f64| {
        let inside = accelerations
            .iter()
            .enumerate()
            .filter(|(i, _)| (offset(i + window) - at).abs() < INNER * gap);
        let (all, pushed) = inside.fold((0, 0), |(all, pushed), (_, a)| {
            (all + 1, pushed + i32::from(a.abs() > PUSHED * largest))
        });
        f64::from(pushed) > FREE_OF_PUSHES * f64::from(all)
    };
    let silence = match both {
        None => Some(MapSilence::OneWay),
        Some((p, n)) => {
            let (gap, at) = (p.offset - n.offset, 0.5 * (p.offset + n.offset));
            let yields = gap < MOSTLY_GAP * span || pushed_within(gap, at);
            yields.then_some(MapSilence::Yields { span })
        }
    };
    let shown = |value: f64| silence.is_none().then_some(value);
    Ok(BacklashMap {
        positive,
        negative,
        gap: gap.and_then(shown),
        asymmetry: both.and_then(|(p, n)| shown(0.5 * (p.offset + n.offset))),
        silence,
        unit: motor.unit.clone(),
        points,
    })
}

/// Second differences of the load's position (rad or m in the window squared), and the half window; `None` where none
/// stands out from what the sensor writes of a load at rest, or reaches `least`.
fn accelerations(points: &[[f64; 2]], least: f64) -> Option<(usize, Vec<f64>)> {
    let quantum = points
        .windows(2)
        .map(|w| (w[1][1] - w[0][1]).abs())
        .filter(|d| *d > 0.0)
        .fold(f64::INFINITY, f64::min);
    let mut rough: Vec<f64> = points
        .windows(4)
        .map(|w| (w[3][1] - 3.0 * w[2][1] + 3.0 * w[1][1] - w[0][1]).abs())
        .collect();
    // Third differences of white noise have sqrt(20) times its size, and half of them are within 0.67 of that.
    let noise = median(&mut rough) / (NORMAL_MEDIAN * 20.0_f64.sqrt());
    let noise = if quantum.is_finite() {
        noise.max(quantum)
    } else {
        noise
    };
    for window in WINDOWS {
        if points.len() <= 2 * window {
            break;
        }
        let values: Vec<f64> = points
            .windows(2 * window + 1)
            .map(|w| w[2 * window][1] - 2.0 * w[window][1] + w[0][1])
            .collect();
        if values.iter().any(|a| a.abs() > (CLEAR * noise).max(least)) {
            return Some((window, values));
        }
    }
    None
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
