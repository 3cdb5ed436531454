//! The axes on which a model can fail: a value for every sample.

use super::data::Data;
use super::motion::Motion;
use crate::measurement::Kind;
use crate::message::{Message, fixed};
use crate::msg;
use crate::order::median;

/// Most levels of an input that counts as a relay's.
const RELAY_LEVELS: usize = 6;

/// Share by which periods of a relay loop may differ from the usual one.
const ALIKE: f64 = 0.25;

/// A change of velocity from sample to sample below this share of the largest is none: the body rests, or what is
/// left is round-off.
const STEADY: f64 = 1e-9;

/// A position that is summed up from a noisy velocity is off by this share of the travel at most, half a part of the
/// axis.
const MOST_WANDERING: f64 = 0.02;

/// Turns that a motor makes at least for its angle within a turn to be an axis of its own.
const LEAST_TURNS: f64 = 2.0;

/// One axis.
pub(super) struct Axis {
    pub name: &'static str,
    /// Unit of the values, `1` for a share.
    pub unit: String,
    /// A value for every sample, `NaN` where it has none.
    pub values: Vec<f64>,
    /// Has few values, each of which is a part of its own.
    discrete: bool,
    /// The place between two values in words, given the unit.
    say: fn(f64, f64, &str) -> Message,
}

/// The samples that have a value, in the order of their values, and where the parts of the axis begin and end in it.
pub(super) struct Parts {
    pub order: Vec<usize>,
    edges: Vec<usize>,
}

impl Axis {
    /// Divides `samples` into `count` parts of equal number; `None` where there are too few.
    pub fn parts(&self, samples: impl Iterator<Item = usize>, count: usize) -> Option<Parts> {
        let mut pairs: Vec<(f64, usize)> = samples
            .map(|i| (self.values[i], i))
            .filter(|(value, _)| value.is_finite())
            .collect();
        if pairs.len() < 2 * count {
            return None;
        }
        pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let n = pairs.len();
        let edges = if self.discrete {
            let changes = (1..n).filter(|k| pairs[*k].0 > pairs[k - 1].0);
            [0].into_iter().chain(changes).chain([n]).collect()
        } else {
            // Equal values are in one part.
            let whole = |k: usize| k == 0 || k == n || pairs[k].0 > pairs[k - 1].0;
            let next = |k: usize| (k..n).find(|k| whole(*k)).unwrap_or(n);
            let mut edges: Vec<usize> = (0..=count).map(|k| next(k * n / count)).collect();
            edges.dedup();
            edges
        };
        Some(Parts {
            order: pairs.into_iter().map(|(_, i)| i).collect(),
            edges,
        })
    }

    /// The place between two values in words.
    pub fn place(&self, from: f64, to: f64) -> Message {
        (self.say)(from, to, &self.unit)
    }
}

impl Parts {
    /// Number of parts.
    pub fn len(&self) -> usize {
        self.edges.len() - 1
    }

    /// The samples of the parts `from` to `to`, the last not among them.
    pub fn between(&self, from: usize, to: usize) -> &[usize] {
        &self.order[self.edges[from]..self.edges[to]]
    }
}

/// Every axis on which the residual is looked at; `velocity_unit` is that of the drive's velocity or of the process
/// output.
pub(super) fn axes(data: &Data, motion: &Motion, velocity_unit: &str) -> Vec<Axis> {
    let mut axes = vec![continuous("time", "s", data.time.clone(), |a, b, _| {
        let [from, to] = [a, b].map(|t| moment(t, b - a));
        let from = if a == 0.0 { "0".to_owned() } else { from };
        msg!("between {} and {}", from, to)
    })];
    match data.kind {
        Kind::Drive => drive_axes(data, motion, velocity_unit, &mut axes),
        Kind::Process => {
            let values = motion.velocity.clone();
            axes.push(continuous("output", velocity_unit, values, |a, b, unit| {
                msg!("where the output is {}", within(a, b, unit))
            }));
        }
    }
    if levels(&data.input) <= RELAY_LEVELS {
        let switched = |i: usize| data.input[i] != data.input[i - 1];
        axes.push(continuous(
            "time_since_switch",
            "s",
            since(&data.time, switched),
            |a, b, _| span_after(a, b, "the input switched"),
        ));
        if has_period(data) {
            axes.push(continuous(
                "relay_phase",
                "1",
                relay_phase(data),
                |a, b, _| {
                    let (a, b) = (100.0 * a, 100.0 * b);
                    msg!(
                        "between {} % and {} % of the relay period",
                        fixed(a, 0),
                        fixed(b, 0)
                    )
                },
            ));
        }
    }
    axes
}

/// What a moving body has besides.
fn drive_axes(data: &Data, motion: &Motion, velocity_unit: &str, axes: &mut Vec<Axis>) {
    let velocity = &motion.velocity;
    axes.push(continuous(
        "velocity",
        velocity_unit,
        velocity.clone(),
        |a, b, unit| msg!("where the velocity is {}", within(a, b, unit)),
    ));
    let reversed = |i: usize| velocity[i] * velocity[i - 1] < 0.0;
    axes.push(continuous(
        "time_since_reversal",
        "s",
        since(&data.time, reversed),
        |a, b, _| span_after(a, b, "a velocity reversal"),
    ));
    axes.push(Axis {
        discrete: true,
        ..continuous(
            "acceleration_sign",
            "1",
            acceleration_signs(data, motion),
            |a, b, _| {
                match (a < 0.0, b > 0.0) {
                    (true, true) => "where the acceleration is not 0",
                    (true, false) => "where the acceleration is negative",
                    _ => "where the acceleration is positive",
                }
                .into()
            },
        )
    });
    let unit = velocity_unit.strip_suffix("/s").unwrap_or("1");
    if let Some(position) = position(data) {
        if data.has_position
            && unit == "rad"
            && range(&position) > LEAST_TURNS * std::f64::consts::TAU
        {
            let angle = position.iter().map(|x| x.rem_euclid(std::f64::consts::TAU));
            axes.push(continuous(
                "turn_angle",
                unit,
                angle.collect(),
                |a, b, unit| msg!("where the angle within a turn is {}", within(a, b, unit)),
            ));
        }
        axes.push(continuous("position", unit, position, |a, b, unit| {
            msg!("where the position is {}", within(a, b, unit))
        }));
    }
    if !data.felt.is_empty() {
        let touched = |i: usize| data.felt.binary_search(&i).is_ok();
        axes.push(continuous(
            "time_since_impact",
            "s",
            since(&data.time, touched),
            |a, b, _| span_after(a, b, "the motor felt the load"),
        ));
    }
}

fn continuous(
    name: &'static str,
    unit: &str,
    values: Vec<f64>,
    say: fn(f64, f64, &str) -> Message,
) -> Axis {
    Axis {
        name,
        unit: unit.to_owned(),
        values,
        discrete: false,
        say,
    }
}

/// The measured position, or the integral of the measured velocity if its noise does not lead it astray.
fn position(data: &Data) -> Option<Vec<f64>> {
    let position = data.position_estimate();
    // White noise summed up wanders by its size, times the square root of the number of samples.
    let wandering = data
        .outputs
        .first()
        .map_or(0.0, |o| o.noise * data.excitation.mean_step())
        * (data.len() as f64).sqrt();
    (data.has_position || wandering <= MOST_WANDERING * range(&position)).then_some(position)
}

fn range(values: &[f64]) -> f64 {
    let ends = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| {
        (low.min(*v), high.max(*v))
    });
    ends.1 - ends.0
}

/// Sign of the modelled acceleration; `NaN` where there is none. Between windows the model is set anew: that is none.
fn acceleration_signs(data: &Data, motion: &Motion) -> Vec<f64> {
    let v = &motion.velocity;
    let mut change = vec![f64::NAN; data.len()];
    for (from, to) in data.spans() {
        for i in from..to.saturating_sub(1) {
            change[i] = v[i + 1] - v[i];
        }
        if to >= from + 2 {
            change[to - 1] = change[to - 2];
        }
    }
    let most = change.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    let sign = |c: &f64| {
        if c.abs() > STEADY * most {
            c.signum()
        } else {
            f64::NAN
        }
    };
    change.iter().map(sign).collect()
}

/// Time since the last sample with an event, s; `NaN` before the first.
fn since(time: &[f64], event: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut last = f64::NAN;
    time.iter()
        .enumerate()
        .map(|(i, t)| {
            if i > 0 && event(i) {
                last = *t;
            }
            t - last
        })
        .collect()
}

/// Samples at which the input switches upwards.
fn ups(data: &Data) -> Vec<usize> {
    let is_up = |i: &usize| data.input[*i] > data.input[i - 1];
    (1..data.len()).filter(is_up).collect()
}

/// Whether the input switches upwards at times that are alike, as in a loop that a relay closed: not one that is drawn
/// or a staircase.
fn has_period(data: &Data) -> bool {
    let ups = ups(data);
    let length = |pair: &[usize]| data.time[pair[1]] - data.time[pair[0]];
    let mut lengths: Vec<f64> = ups.windows(2).map(length).collect();
    let usual = median(&mut lengths);
    let alike = lengths
        .iter()
        .filter(|l| (*l - usual).abs() <= ALIKE * usual);
    2 * alike.count() > lengths.len()
}

/// Share of the relay period, counted from each upward switch.
fn relay_phase(data: &Data) -> Vec<f64> {
    let ups = ups(data);
    let mut phase = vec![f64::NAN; data.len()];
    for pair in ups.windows(2) {
        let (from, to) = (data.time[pair[0]], data.time[pair[1]]);
        for (p, t) in phase[pair[0]..pair[1]]
            .iter_mut()
            .zip(&data.time[pair[0]..pair[1]])
        {
            *p = (t - from) / (to - from);
        }
    }
    phase
}

/// Number of different values, counted up to one more than a relay may have.
fn levels(input: &[f64]) -> usize {
    let mut seen: Vec<f64> = Vec::new();
    for u in input {
        if !seen.contains(u) {
            seen.push(*u);
            if seen.len() > RELAY_LEVELS {
                break;
            }
        }
    }
    seen.len()
}

fn within(from: f64, to: f64, unit: &str) -> Message {
    let unit = if unit == "1" {
        String::new()
    } else {
        format!(" {unit}")
    };
    let size = from.abs().max(to.abs());
    if to - from <= SAME * size {
        let value = rounded(to, apart(size) + 1);
        return msg!("close to {}", value + &unit);
    }
    let digits = apart(to - from) + 1;
    let [from, to] = [from, to].map(|value| rounded(value, digits));
    msg!("between {} and {}", from, to + &unit)
}

/// Share of their size up to which two ends of a range say the same.
const SAME: f64 = 1e-4;

fn span_after(from: f64, to: f64, what: &'static str) -> Message {
    if to <= 0.0 {
        msg!("right after {}", what)
    } else if from <= 0.0 {
        msg!("within {} after {}", seconds(to), what)
    } else {
        let [from, to] = [from, to].map(|t| moment(t, to - from));
        msg!("from {} to {} after {}", from, to, what)
    }
}

/// Digits behind the point with which two values so far apart differ in two digits.
fn apart(difference: f64) -> usize {
    let first = libm::log10(difference.abs().max(f64::MIN_POSITIVE)).floor();
    (1.0 - first).clamp(0.0, MOST_DIGITS) as usize
}

/// Most digits behind the point: two ends that are the same have no end of them.
const MOST_DIGITS: f64 = 9.0;

/// A value with so many digits behind the point; nothing but zeros is 0.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text.contains(|c| ('1'..='9').contains(&c)) {
        text
    } else {
        "0".to_owned()
    }
}

/// A duration in a unit that suits it, also when it is rounded: 1.0 ms, not 1000 µs.
pub(super) fn seconds(t: f64) -> String {
    moment(t, f64::INFINITY)
}

/// Such a duration as one of two that are so far apart, s.
fn moment(t: f64, difference: f64) -> String {
    let size = t.abs();
    let (unit, scale, digits) = if size == 0.0 || size >= 0.999_95 {
        ("s", 1.0, 2)
    } else if size >= 0.999_5e-3 {
        ("ms", 1e3, 1)
    } else {
        ("µs", 1e6, 0)
    };
    let digits = apart(scale * difference).max(digits);
    format!("{} {unit}", rounded(scale * t, digits))
}

#[cfg(test)]
mod tests {
    use super::{continuous, moment, seconds, span_after, within};

    #[test]
    fn equal_values_are_in_one_part() {
        let mut values = vec![0.0; 50];
        values.extend((1..=50).map(f64::from));
        let axis = continuous("output", "1", values, |_, _, _| {
            crate::message::Message::default()
        });
        let parts = axis.parts(0..100, 10).unwrap();
        assert_eq!(parts.between(0, 1).len(), 50);
        assert_eq!(parts.len(), 6);
    }

    #[test]
    fn the_ends_of_a_range_differ_in_two_digits() {
        assert_eq!(within(-0.04, 0.2, "rad"), "between -0.040 and 0.200 rad");
        assert_eq!(
            within(-0.000_31, 0.001_04, "rad"),
            "between -0.00031 and 0.00104 rad"
        );
        assert_eq!(within(-10.84, 7.23, "rad/s"), "between -10.8 and 7.2 rad/s");
        assert_eq!(within(0.178_346_330, 0.178_346_333, "1"), "close to 0.178");
        assert_eq!(within(-0.000_01, 0.5, "1"), "between 0 and 0.500");
        assert_eq!(moment(0.0, 0.0998), "0 s");
        assert_eq!(
            span_after(10.001, 10.0043, "it"),
            "from 10.0010 s to 10.0043 s after it"
        );
        assert_eq!(span_after(0.0, 0.0, "it"), "right after it");
        assert_eq!(
            span_after(0.8e-3, 2.2e-3, "it"),
            "from 800 µs to 2.2 ms after it"
        );
    }

    #[test]
    fn a_rounded_duration_has_the_unit_that_suits_it() {
        assert_eq!(seconds(0.000_999_96), "1.0 ms");
        assert_eq!(seconds(0.000_72), "720 µs");
        assert_eq!(seconds(0.999_96), "1.00 s");
        assert_eq!(seconds(0.72), "720.0 ms");
        assert_eq!(seconds(0.0), "0 s");
    }
}
