//! When, where and how hard does the motor meet the load?

use super::change_points::pelt;
use super::cycles::{Cycles, median};
use super::estimate::Side;
use super::free_motor::FreeMotor;
use super::record::Record;

/// Penalty of a change of drift, in units of the logarithm of the number of cycles.
const PENALTY: f64 = 3.0;

/// Least deviation of engaged cycles: in standard deviations of their mean, and as share of the swing of
/// the velocity, below which a changing friction could do the same.
const DEVIATION: f64 = 4.0;
const LEAST_SHARE: f64 = 5e-3;

/// Cycles about an engaged one in which contacts are looked for.
const MARGIN: usize = 2;

/// Cumulative sum: allowance a sample and threshold, in standard deviations of the unexplained velocity.
const ALLOWANCE: f64 = 0.25;
const THRESHOLD: f64 = 5.0;

/// Share of a cycle without growth after which a contact is over.
const WAIT: f64 = 1.0 / 7.0;

/// Samples before and after a contact that show its levels.
const AROUND: usize = 6;

/// Steps of the search for begin and duration, samples.
const BEGIN_STEP: f64 = 0.25;
const DURATION_STEP: f64 = 0.5;

/// Contacts on which the shape is chosen.
const SHAPE_CONTACTS: usize = 80;

/// Most contacts that are used; the first ones.
const MOST: usize = 1500;

/// Cycles next to contacts that may hold a touch too light to be found, and cycles from which levels are read.
const GUARD: f64 = 3.0;
const LEVEL: f64 = 40.0;
const LEAST_LEVEL: f64 = 4.0;

/// How the unexplained velocity goes through a contact, from 0 to 1.
#[derive(Clone, Copy)]
enum Shape {
    /// A spring alone.
    Cosine,
    /// Constant force.
    Line,
    /// Most force at the begin, as a damper gives it.
    Parabola,
}

impl Shape {
    fn at(self, share: f64) -> f64 {
        let q = share.clamp(0.0, 1.0);
        match self {
            Self::Cosine => 0.5 * (1.0 - (std::f64::consts::PI * q).cos()),
            Self::Line => q,
            Self::Parabola => 1.0 - (1.0 - q) * (1.0 - q),
        }
    }
}

/// A contact on the grid of samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Sample at which it begins, between samples.
    pub begin: f64,
    /// Samples that it lasts.
    pub length: f64,
    pub side: Side,
    /// Loss of the motor's velocity, positive where the load is pushed forwards; rad/s or m/s.
    pub jump: f64,
    /// Standard deviation of `jump`.
    pub jump_noise: f64,
}

/// What each cycle says.
pub(super) struct Drift {
    /// Change of the unexplained velocity in each cycle.
    pub change: Vec<f64>,
    /// The same of the free motor, for the phase it lies in.
    pub base: Vec<f64>,
    /// Whether the pattern of drift differs from the free one.
    pub engaged: Vec<bool>,
}

/// Cycle by cycle: where does the pattern of drift change?
pub(super) fn drift(cycles: &Cycles, motor: &FreeMotor) -> Drift {
    let w = &motor.unexplained;
    let level = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 2).min(w.len()));
        w[a..b].iter().sum::<f64>() / (b - a) as f64
    };
    let change: Vec<f64> = cycles
        .starts
        .windows(2)
        .map(|s| level(s[1]) - level(s[0]))
        .collect();
    let mut base = vec![0.0; change.len()];
    let mut engaged = vec![false; change.len()];
    for (from, to) in cycles.phases() {
        let part = &change[from..to];
        let middle = median(&mut part.to_vec());
        let mut sizes: Vec<f64> = part.iter().map(|c| (c - middle).abs()).collect();
        let sigma = (1.4826 * median(&mut sizes)).max(motor.noise);
        base[from..to].fill(middle);
        for segment in pelt(part, sigma, PENALTY * (cycles.count() as f64).ln()) {
            let count = (segment.to - segment.from) as f64;
            let needed = (DEVIATION * sigma / count.sqrt()).max(LEAST_SHARE * 2.0 * cycles.speed);
            if (segment.mean - middle).abs() > needed {
                engaged[from + segment.from..from + segment.to].fill(true);
            }
        }
    }
    Drift {
        change,
        base,
        engaged,
    }
}

/// All contacts in engaged cycles, in order of time.
pub(super) fn touches(
    record: &Record,
    cycles: &Cycles,
    motor: &FreeMotor,
    drift: &Drift,
) -> Vec<Touch> {
    let n = record.len();
    let (mut near, mut slope) = (vec![false; n], vec![0.0; n]);
    for k in 0..cycles.count() {
        let span = cycles.starts[k]..cycles.starts[k + 1];
        slope[span.clone()].fill(drift.base[k] / span.len() as f64);
        if drift.engaged[k] {
            let from = cycles.starts[k.saturating_sub(MARGIN)];
            let to = cycles.starts[(k + 1 + MARGIN).min(cycles.count())];
            near[from..to].fill(true);
        }
    }
    // The free motor's own drift taken out.
    let mut flat = vec![0.0; n];
    for i in 1..n {
        flat[i] = flat[i - 1] + motor.unexplained[i] - motor.unexplained[i - 1] - slope[i];
    }
    let wait = ((WAIT * cycles.length).round() as usize).max(2);
    let mut found: Vec<(usize, usize)> = [1.0, -1.0]
        .iter()
        .flat_map(|sign| cumulative_sum(&flat, *sign, motor.noise, wait))
        .filter(|(begin, end)| near[*begin] || near[*end])
        .collect();
    found.sort_unstable();
    found.truncate(MOST);
    let shape = best_shape(&flat, &found);
    let mut touches: Vec<Touch> = found
        .iter()
        .filter_map(|span| place(&flat, *span, shape))
        .map(|p| Touch {
            begin: p.begin,
            length: p.length,
            side: if p.change < 0.0 {
                Side::Positive
            } else {
                Side::Negative
            },
            jump: -p.change,
            jump_noise: motor.noise,
        })
        .collect();
    touches.sort_by(|a, b| a.begin.total_cmp(&b.begin));
    weigh(&flat, cycles, motor.noise, &mut touches);
    touches.retain(|t| t.jump.abs() > t.jump_noise && (t.jump > 0.0) == (t.side == Side::Positive));
    touches
}

/// Page's cumulative sum for a change of this sign: begins and ends of what exceeds the threshold.
fn cumulative_sum(values: &[f64], sign: f64, noise: f64, wait: usize) -> Vec<(usize, usize)> {
    let (allowance, threshold) = (ALLOWANCE * noise, THRESHOLD * noise);
    let mut found = Vec::new();
    let (mut sum, mut begin, mut most, mut peak) = (0.0_f64, 0, 0.0_f64, 0);
    for i in 1..values.len() {
        sum += sign * (values[i] - values[i - 1]) - allowance;
        if sum > most {
            (most, peak) = (sum, i);
        }
        let over = sum <= 0.0 || i == values.len() - 1 || (most > threshold && i - peak >= wait);
        if over {
            if most > threshold {
                found.push((begin, peak));
            }
            (sum, begin, most, peak) = (0.0, i, 0.0, i);
        }
    }
    found
}

struct Placed {
    begin: f64,
    length: f64,
    change: f64,
    squares: f64,
}

/// Begin and duration by least squares about a contact between the samples `span`.
fn place(values: &[f64], span: (usize, usize), shape: Shape) -> Option<Placed> {
    let from = span.0.saturating_sub(AROUND);
    let to = (span.1 + AROUND + 1).min(values.len());
    let part = &values[from..to];
    let mean = part.iter().sum::<f64>() / part.len() as f64;
    let long = (span.1 - span.0).max(1) as f64;
    let mut best: Option<Placed> = None;
    let mut form = vec![0.0; part.len()];
    let begins = (0..=26).map(|k| span.0 as f64 - 2.5 + BEGIN_STEP * f64::from(k));
    for begin in begins {
        let mut length = (0.5 * long).max(1.0);
        while length < 1.4 * long + 2.0 {
            for (k, value) in form.iter_mut().enumerate() {
                *value = shape.at(((from + k) as f64 - begin) / length);
            }
            let middle = form.iter().sum::<f64>() / form.len() as f64;
            let (mut own, mut with) = (0.0, 0.0);
            for (f, v) in form.iter().zip(part) {
                own += (f - middle) * (f - middle);
                with += (f - middle) * (v - mean);
            }
            if own > 1e-9 {
                let change = with / own;
                let squares = part.iter().map(|v| (v - mean).powi(2)).sum::<f64>() - change * with;
                if best.as_ref().is_none_or(|b| squares < b.squares) {
                    best = Some(Placed {
                        begin,
                        length,
                        change,
                        squares,
                    });
                }
            }
            length += DURATION_STEP;
        }
    }
    best
}

/// The shape that fits the contacts best, all together.
fn best_shape(values: &[f64], found: &[(usize, usize)]) -> Shape {
    let stride = found.len().div_ceil(SHAPE_CONTACTS).max(1);
    let mut best = (f64::INFINITY, Shape::Line);
    for shape in [Shape::Line, Shape::Cosine, Shape::Parabola] {
        let squares: f64 = found
            .iter()
            .step_by(stride)
            .filter_map(|span| place(values, *span, shape))
            .map(|p| p.squares)
            .sum();
        if squares < best.0 {
            best = (squares, shape);
        }
    }
    best.1
}

/// A level of the unexplained velocity, extrapolated to a sample, with its variance.
#[derive(Clone, Copy)]
struct Level {
    value: f64,
    variance: f64,
}

/// How much velocity the motor loses at each contact: the difference of the levels before and after.
///
/// Next to a long free flight the level is that of a line through the quiet part of the flight, beyond
/// the guard, so that touches too light to be found count as well.
fn weigh(values: &[f64], cycles: &Cycles, noise: f64, touches: &mut [Touch]) {
    let n = values.len() as f64;
    let ends = |touches: &[Touch], k: usize| touches[k].begin + touches[k].length;
    for k in 0..touches.len() {
        let (begin, end) = (touches[k].begin, ends(touches, k));
        let before = if k == 0 { 0.0 } else { ends(touches, k - 1) };
        let after = touches.get(k + 1).map_or(n - 1.0, |t| t.begin);
        let middle = 0.5 * (begin + end);
        let old = level(values, cycles, noise, (before, begin), middle, false);
        let new = level(values, cycles, noise, (end, after), middle, true);
        touches[k].jump = old.value - new.value;
        touches[k].jump_noise = (old.variance + new.variance).sqrt();
    }
}

/// Level within the free flight `span`, near its begin (`early`) or its end, extrapolated to `at`.
fn level(
    values: &[f64],
    cycles: &Cycles,
    noise: f64,
    span: (f64, f64),
    at: f64,
    early: bool,
) -> Level {
    let last = values.len() - 1;
    let (guard, most) = (GUARD * cycles.length, LEVEL * cycles.length);
    let (mut from, mut to) = span;
    let long = to - from > 2.0 * guard + LEAST_LEVEL * cycles.length;
    if long {
        (from, to) = (from + guard, to - guard);
        if early {
            to = to.min(from + most);
        } else {
            from = from.max(to - most);
        }
    }
    let first = (from.ceil().max(0.0) as usize).min(last);
    let end = (to.floor().max(0.0) as usize).clamp(first, last);
    let part = &values[first..=end];
    let count = part.len() as f64;
    let mean = part.iter().sum::<f64>() / count;
    let variance = noise * noise / count;
    let own = count * (count * count - 1.0) / 12.0;
    if !long || own <= 0.0 {
        return Level {
            value: mean,
            variance,
        };
    }
    let centre = 0.5 * (first + end) as f64;
    let with: f64 = part
        .iter()
        .enumerate()
        .map(|(k, v)| ((first + k) as f64 - centre) * (v - mean))
        .sum();
    let away = at - centre;
    Level {
        value: mean + with / own * away,
        variance: variance + noise * noise * away * away / own,
    }
}
