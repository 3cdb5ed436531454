//! When, where and how hard does the motor meet the load?

use super::cycles::Cycles;
use super::drift::Drift;
use super::free_motor::FreeMotor;
use super::gap::Side;
use super::record::{DIFFERENCE, Record};
use crate::order::{drop_marked, median, quantile};

/// Contacts with one side only from which engagement is believed.
pub(super) const FEWEST_CONTACTS: usize = 3;

/// Cycles about an engaged one in which contacts are looked for.
const MARGIN: usize = 2;

/// Cumulative sum: allowance a sample and threshold, in standard deviations of the unexplained velocity.
const ALLOWANCE: f64 = 0.25;
const THRESHOLD: f64 = 5.0;

/// Share of a cycle without growth after which a contact is over.
const WAIT: f64 = 1.0 / 7.0;

/// Samples before and after a contact that show its levels.
const AROUND: usize = 6;

/// Share of its change up to which a contact is looked at to place its begin, and least samples of it.
const RISE: f64 = 0.7;
const LEAST_RISE: usize = 2;
/// Share of a cycle up to which the same is looked at.
const LEADING: f64 = 0.35;

/// Step of the search for the begin, and how far before the first sample of a contact it starts, samples.
const BEGIN_STEP: f64 = 0.125;
const BEFORE: f64 = 2.5;

/// Begins are alike whose squares differ by less than this of the noise (95 % of a normal distribution), or than this
/// share of the change where there is none.
const ALIKE: f64 = 2.0;
const ROUND_OFF: f64 = 1e-6;

/// Pause before a contact, in cycles, after which the load was free and not still touched.
const FREE: f64 = 0.25;

/// Cycles before and after a contact in which nothing acts, least samples of them, and the largest share of the force
/// in a contact that may act there: on in the direction of the contact, in either direction, and below which three in
/// four must lie. Loads in gaps have up to 0.18 in either direction, shafts 0.3 and more of the last two.
const ABOUT: f64 = 0.35;
const LEAST_ABOUT: f64 = 4.0;
const SHARP: f64 = 0.12;
const SHARP_EITHER_WAY: f64 = 0.2;
const MOSTLY_SHARP: f64 = 0.25;
const THREE_IN_FOUR: f64 = 0.75;

/// Samples after the end of a contact in which a little push may be left.
const TAIL_SAMPLES: usize = 2;

/// Least jump of a contact in standard deviations.
const CLEAR: f64 = 4.0;

/// A touch of the other side within so many cycles is the tail of a contact if its jump is less than
/// this share: the free motor is not known well enough to tell such a small one.
const TAIL: f64 = 2.0;
const TAIL_SHARE: f64 = 0.2;

/// Most contacts that are used; the first ones.
const MOST: usize = 2500;

/// Cycles next to contacts that may hold a touch too light to be found, and cycles from which levels are read.
const GUARD: f64 = 3.0;
const LEVEL: f64 = 40.0;
const LEAST_LEVEL: f64 = 4.0;

/// A contact on the grid of samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Sample at which it begins, between samples.
    pub begin: f64,
    /// Samples that it lasts.
    pub length: f64,
    /// Samples from its begin to the centre of its push.
    pub centre: f64,
    pub side: Side,
    /// Loss of the motor's velocity, positive where the load is pushed forwards; rad/s or m/s.
    pub jump: f64,
    /// Standard deviation of `jump`.
    pub jump_noise: f64,
    /// Whether the load flew freely before.
    pub free: bool,
}

/// All contacts in engaged cycles, in order of time; empty where what disturbs the motor is no contact, and
/// then `true`.
pub(super) fn touches(
    record: &Record,
    cycles: &Cycles,
    motor: &FreeMotor,
    drift: &Drift,
) -> (Vec<Touch>, bool) {
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
    let leading = (LEADING * cycles.length).round() as usize;
    let mut touches: Vec<Touch> = found
        .iter()
        .filter_map(|span| {
            // Differences of the position see a contact before it begins.
            let early = if record.has_velocity {
                0.0
            } else {
                0.5 * DIFFERENCE as f64
            };
            let begin = begin(&flat, *span, leading, motor.noise)? + early;
            let change = flat[span.1] - flat[span.0];
            Some(Touch {
                begin,
                length: (span.1 as f64 - begin).max(1.0),
                centre: centre(&flat, *span, begin),
                side: if change < 0.0 {
                    Side::Positive
                } else {
                    Side::Negative
                },
                jump: -change,
                jump_noise: motor.noise,
                free: true,
            })
        })
        .collect();
    touches.sort_by(|a, b| a.begin.total_cmp(&b.begin));
    touches.retain(|touch| !flips_at(record, touch.begin));
    loop {
        weigh(&flat, cycles, motor.noise, &mut touches);
        for touch in &mut touches {
            let (from, to) = (touch.begin.max(1.0) - 1.0, touch.begin + touch.length + 1.0);
            let unsure = motor.unsure(from as usize, to.ceil() as usize);
            touch.jump_noise = libm::hypot(touch.jump_noise, unsure);
        }
        let doubtful = doubtful(&touches, cycles);
        if !doubtful.contains(&true) {
            for k in 1..touches.len() {
                let pause = touches[k].begin - touches[k - 1].begin - touches[k - 1].length;
                touches[k].free = pause > FREE * cycles.length;
            }
            // A few touches that are none show nothing of what acts all through the cycle.
            return if is_sharp(&flat, &touches, cycles) {
                (touches, false)
            } else {
                (Vec::new(), touches.len() >= FEWEST_CONTACTS)
            };
        }
        drop_marked(&mut touches, &doubtful);
    }
}

/// Whether the asymmetry flips where a touch begins: what is unexplained there is the flip, which comes too seldom to
/// be placed by what is usual.
fn flips_at(record: &Record, begin: f64) -> bool {
    let from = (begin - AT_FLIP).max(0.0) as usize;
    let to = ((begin + AT_FLIP).ceil().max(0.0) as usize + 1).min(record.len());
    let part = record.input.get(from..to).unwrap_or_default();
    part.windows(2)
        .any(|u| u[0] * u[1] > 0.0 && (u[1] - u[0]).abs() > FLIPS * u[0].abs())
}

/// Samples about a flip of the asymmetry, and the least change of the torque without a change of its sign that is one.
const AT_FLIP: f64 = 1.0;
const FLIPS: f64 = 0.1;

/// Whether the unexplained force acts within the contacts and not about them: a load is touched at one end of the cycle
/// and left when the motor turns round, while a force that depends on position, speed or time acts all through it, and
/// a shaft pulls back after it has pushed.
fn is_sharp(values: &[f64], touches: &[Touch], cycles: &Cycles) -> bool {
    let last = values.len() - 1;
    let at = |sample: f64| values[(sample.max(0.0) as usize).min(last)];
    let about = ABOUT * cycles.length;
    // As it goes on in the direction of the contact, and either way.
    let (mut signed, mut either) = (Vec::new(), Vec::new());
    for (k, touch) in touches.iter().enumerate() {
        let (begin, end) = (touch.begin - 2.0, touch.begin + touch.length + 2.0);
        let free_before = k
            .checked_sub(1)
            .map_or(0.0, |j| touches[j].begin + touches[j].length + 2.0);
        let free_after = touches.get(k + 1).map_or(last as f64, |t| t.begin - 2.0);
        let (before, after) = (
            (begin - (begin - about).max(free_before)).max(0.0),
            ((end + about).min(free_after) - end).max(0.0),
        );
        let outside = before + after;
        if outside < LEAST_ABOUT {
            signed.push(0.0);
            continue;
        }
        let changes = [at(begin) - at(begin - before), at(end + after) - at(end)];
        let inside = (at(end) - at(begin)) / (end - begin);
        signed.push((changes[0] + changes[1]) / outside / inside);
        either.push((changes[0].abs() + changes[1].abs()) / outside / inside.abs());
    }
    let mut lengths: Vec<f64> = touches.iter().map(|t| t.length).collect();
    !either.is_empty()
        && median(&mut lengths) < cycles.length
        && median(&mut signed) < SHARP
        && median(&mut either) < SHARP_EITHER_WAY
        && quantile(&mut either, THREE_IN_FOUR) < MOSTLY_SHARP
}

/// Which touches are none: too light for the noise, against their own sign, or the tail of another one.
fn doubtful(touches: &[Touch], cycles: &Cycles) -> Vec<bool> {
    let tail = |touch: &Touch, other: Option<&Touch>| {
        other.is_some_and(|other| {
            other.side != touch.side
                && (other.begin - touch.begin).abs() < TAIL * cycles.length
                && touch.jump.abs() < TAIL_SHARE * other.jump.abs()
        })
    };
    (0..touches.len())
        .map(|k| {
            let touch = &touches[k];
            let before = k.checked_sub(1).and_then(|k| touches.get(k));
            touch.jump * touch.side.sign() < CLEAR * touch.jump_noise
                || tail(touch, before)
                || tail(touch, touches.get(k + 1))
        })
        .collect()
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
        let over = sum <= 0.0 || i == values.len() - 1 || i - peak >= wait;
        if over {
            if most > threshold {
                found.push((begin, peak));
            }
            (sum, begin, most, peak) = (0.0, i, 0.0, i);
        }
    }
    found
}

/// Begin of a contact between the samples `span`, between samples: its leading edge is a broken line.
///
/// Hinkley 1969, "Inference about the intersection in two-phase regression", Biometrika 56. A damped contact pushes at
/// once, so that the velocity falls linearly at first. Of begins that explain the edge alike the middle one is taken:
/// of a hard impact only the sample is seen in which it was.
fn begin(values: &[f64], span: (usize, usize), leading: usize, noise: f64) -> Option<f64> {
    let from = span.0.saturating_sub(AROUND);
    let change = values[span.1] - values[span.0];
    let rise = (span.0..span.1)
        .find(|i| (values[*i] - values[span.0]) / change >= RISE)
        .unwrap_or(span.1)
        .clamp(span.0 + 1, span.0 + leading.max(LEAST_RISE));
    let part = values.get(from..=rise)?;
    let mean = part.iter().sum::<f64>() / part.len() as f64;
    // What a line from a begin on explains of the squares, if it goes the right way.
    let explained = |begin: f64| {
        let form = |k: usize| ((from + k) as f64 - begin).max(0.0);
        let middle = (0..part.len()).map(form).sum::<f64>() / part.len() as f64;
        let (mut own, mut with) = (0.0, 0.0);
        for (k, v) in part.iter().enumerate() {
            let f = form(k) - middle;
            own += f * f;
            with += f * (v - mean);
        }
        if own > 0.0 && with * change > 0.0 {
            with * with / own
        } else {
            0.0
        }
    };
    let first = span.0 as f64 - BEFORE;
    let count = ((rise as f64 - first) / BEGIN_STEP) as usize;
    let tried: Vec<(f64, f64)> = (0..count)
        .map(|k| first + k as f64 * BEGIN_STEP)
        .map(|begin| (begin, explained(begin)))
        .collect();
    let best = tried.iter().fold(0.0_f64, |b, t| b.max(t.1));
    let alike = (ALIKE * noise).powi(2).max(ROUND_OFF * change * change);
    let mut good = tried.iter().filter(|t| t.1 > 0.0 && t.1 >= best - alike);
    let first = good.next()?.0;
    let last = good.next_back().map_or(first, |t| t.0);
    Some(0.5 * (first + last))
}

/// Samples from `begin` to the centre of the push between the samples `span`.
fn centre(values: &[f64], span: (usize, usize), begin: f64) -> f64 {
    let to = (span.1 + TAIL_SAMPLES).min(values.len() - 1);
    let (mut sum, mut moment) = (0.0, 0.0);
    for i in span.0..to {
        let change = values[i + 1] - values[i];
        sum += change;
        moment += change * (i as f64 + 0.5 - begin);
    }
    let length = to as f64 - begin;
    let middle = 0.5 * (span.1 as f64 - begin);
    let centre = if sum == 0.0 { middle } else { moment / sum };
    if (0.0..=length).contains(&centre) {
        centre
    } else {
        middle.max(0.0)
    }
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
    // The free motor drifts differently under each asymmetry: no level reaches across a flip.
    let flips: Vec<f64> = cycles
        .phases()
        .iter()
        .map(|p| cycles.starts[p.0] as f64)
        .collect();
    for k in 0..touches.len() {
        let (begin, end) = (touches[k].begin, ends(touches, k));
        let before = if k == 0 { 0.0 } else { ends(touches, k - 1) };
        let after = touches.get(k + 1).map_or(n - 1.0, |t| t.begin);
        let middle = 0.5 * (begin + end);
        let before = flips
            .iter()
            .filter(|f| **f <= begin)
            .fold(before, |b, f| b.max(*f));
        let after = flips
            .iter()
            .filter(|f| **f >= end)
            .fold(after, |a, f| a.min(*f));
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
    let slope = with / own;
    let away = at - centre;
    Level {
        value: mean + slope * away,
        variance: variance + noise * noise * away * away / own + ripple(part, slope, mean, cycles),
    }
}

/// Variance of the cycles' means about the line with this slope: what the free motor does not explain of itself.
fn ripple(part: &[f64], slope: f64, mean: f64, cycles: &Cycles) -> f64 {
    let block = (cycles.length.round() as usize).max(1);
    let middle = 0.5 * (part.len() - 1) as f64;
    let (sum, count) = part
        .chunks_exact(block)
        .enumerate()
        .map(|(k, values)| {
            let at = (k * block) as f64 + 0.5 * (block - 1) as f64;
            let own = values.iter().sum::<f64>() / block as f64;
            own - mean - slope * (at - middle)
        })
        .fold((0.0, 0.0), |(sum, count), r| (sum + r * r, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}
