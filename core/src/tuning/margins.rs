//! Stability and margins of the loop `C(s) P(s)`.

use std::f64::consts::{FRAC_PI_2, PI};

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::controller::Pid;
use super::scan;
use crate::plant::TransferFunction;
use crate::root::golden_section;

/// How far a stable loop is from instability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Margins {
    /// Gain margin: the factor above 1 by which the gain may rise; `None` if without limit.
    pub gain_margin: Option<f64>,
    /// Angular frequency of that, rad/s.
    pub phase_crossover: Option<f64>,
    /// Phase margin, rad: the least one where the loop gain passes 1; `None` where it never does.
    pub phase_margin: Option<f64>,
    /// Angular frequency of that, rad/s.
    pub gain_crossover: Option<f64>,
    /// Delay margin, s: the dead time that the loop still bears.
    pub delay_margin: Option<f64>,
    /// Maximum sensitivity `Ms`, the largest `|1/(1 + C P)|`; 1/Ms is the distance from -1.
    pub max_sensitivity: f64,
}

/// Largest turn of the characteristic function between two frequencies that is taken as it is.
const TURN: f64 = 0.5;

/// Angle, rad, by which a dead time turns the curve at most while it is followed: each turn takes work, and a fast lag
/// with a dead time fades only after very many.
const FARTHEST: f64 = 1e4;

/// Halvings of an interval in which it turns by more.
const SPLITS: usize = 48;

/// Frequencies are followed until the part with the dead time is this small a share of the other.
const FADED: f64 = 0.05;

/// Golden-section steps for the maximum sensitivity.
const REFINEMENTS: usize = 60;

/// Number of closed-loop poles in the right half plane, by Mikhailov's criterion: along the imaginary
/// axis the characteristic function `D(jw) = den(jw) + num(jw) e^(-jwL)` of degree `n` turns by
/// `(n - 2 Z) pi/2`, `Z` of its zeros being to the right. Integrators and unstable plants are included.
pub fn unstable_poles(plant: &TransferFunction, pid: &Pid) -> usize {
    let (c_num, c_den) = pid.polynomials();
    let numerator = scan::product(&c_num, &plant.numerator);
    let denominator = scan::product(&c_den, &plant.denominator);
    let loop_parts = |w: f64| {
        let delayed = scan::horner(&numerator, w) * Complex::from_polar(1.0, -w * plant.dead_time);
        (scan::horner(&denominator, w), delayed)
    };
    let (low, mut high) = scan::range(&[&numerator, &denominator], plant.dead_time);
    for _ in 0..60 {
        let (own, delayed) = loop_parts(high);
        if delayed.norm() < FADED * own.norm() || high * plant.dead_time > FARTHEST {
            break;
        }
        high *= 2.0;
    }
    let value = |w: f64| {
        let (own, delayed) = loop_parts(w);
        own + delayed
    };
    let mut total = 0.0;
    let mut before = (0.0, value(0.0));
    for w in scan::grid(low, high) {
        let now = (w, value(w));
        total += turn(before, now, SPLITS, &value);
        before = now;
    }
    let degree = (denominator.len() - 1) as f64;
    let count = (0.5 * (degree - total / FRAC_PI_2)).round();
    if count > 0.0 { count as usize } else { 0 }
}

/// Angle by which a function turns between two frequencies at which it is known.
fn turn(
    a: (f64, Complex<f64>),
    b: (f64, Complex<f64>),
    splits: usize,
    value: &impl Fn(f64) -> Complex<f64>,
) -> f64 {
    let whole = (b.1 * a.1.conj()).arg();
    if whole.abs() < TURN || splits == 0 {
        return whole;
    }
    let middle = 0.5 * (a.0 + b.0);
    if middle <= a.0 || middle >= b.0 {
        return whole;
    }
    let middle = (middle, value(middle));
    turn(a, middle, splits - 1, value) + turn(middle, b, splits - 1, value)
}

/// Sizes of the response between which a curve is followed for drawing.
const DRAWN: std::ops::Range<f64> = 5e-3..20.0;

/// Most points of a curve for drawing.
const DRAWN_POINTS: usize = 800;

/// The part near the origin of the Nyquist curve of a valid `plant`, with the controller `pid` or
/// without, real and imaginary parts, lowest frequency first.
pub fn nyquist(plant: &TransferFunction, pid: Option<&Pid>) -> Vec<[f64; 2]> {
    let (c_num, c_den) = pid.map_or((Vec::new(), Vec::new()), Pid::polynomials);
    let polynomials: [&[f64]; 4] = [&plant.numerator, &plant.denominator, &c_num, &c_den];
    let (low, high) = scan::range(&polynomials, plant.dead_time);
    let drawn: Vec<[f64; 2]> = scan::grid(low, high)
        .into_iter()
        .map(|w| pid.map_or(Complex::new(1.0, 0.0), |c| c.response(w)) * plant.response(w))
        .skip_while(|p| !DRAWN.contains(&p.norm()))
        .take_while(|p| DRAWN.contains(&p.norm()))
        .map(|p| [p.re, p.im])
        .collect();
    let stride = drawn.len().div_ceil(DRAWN_POINTS).max(1);
    drawn.into_iter().step_by(stride).collect()
}

/// Margins of a stable loop of a valid `plant` and `pid`.
pub fn margins(plant: &TransferFunction, pid: &Pid) -> Margins {
    let (c_num, c_den) = pid.polynomials();
    let polynomials: [&[f64]; 4] = [&plant.numerator, &plant.denominator, &c_num, &c_den];
    let (low, high) = scan::range(&polynomials, plant.dead_time);
    let frequencies = scan::grid(low, high);
    let open = |w: f64| pid.response(w) * plant.response(w);
    let gain = scan::roots(&frequencies, |w| open(w).im)
        .into_iter()
        .map(|(w, _)| (w, open(w)))
        .filter(|(_, l)| l.re < 0.0 && l.re > -1.0 && l.im.abs() < 1e-6 * l.re.abs())
        .map(|(w, l)| (-1.0 / l.re, w))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let phases: Vec<(f64, f64)> = scan::roots(&frequencies, |w| open(w).norm() - 1.0)
        .into_iter()
        .map(|(w, _)| ((-open(w)).arg(), w))
        .collect();
    let phase = phases
        .iter()
        .min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
        .copied();
    let delay_margin = phases
        .iter()
        .map(|(angle, w)| angle.rem_euclid(2.0 * PI) / w)
        .min_by(f64::total_cmp);
    Margins {
        gain_margin: gain.map(|g| g.0),
        phase_crossover: gain.map(|g| g.1),
        phase_margin: phase.map(|p| p.0),
        gain_crossover: phase.map(|p| p.1),
        delay_margin,
        max_sensitivity: max_sensitivity(&frequencies, open),
    }
}

fn max_sensitivity(frequencies: &[f64], open: impl Fn(f64) -> Complex<f64>) -> f64 {
    let size = |w: f64| {
        let s = 1.0 / (open(w) + 1.0).norm();
        if s.is_finite() { s } else { 0.0 }
    };
    let values: Vec<f64> = frequencies.iter().map(|w| size(*w)).collect();
    let Some(top) = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b])) else {
        return 1.0;
    };
    let beside = (
        frequencies[top.saturating_sub(1)],
        frequencies[(top + 1).min(frequencies.len() - 1)],
    );
    let peak = golden_section(beside, REFINEMENTS, f64::INFINITY, size);
    values[top].max(peak.best.1)
}
