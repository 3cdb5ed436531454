//! Why a relay test stalls, or misleads: each cause recognised from the record, with the number that shows it.

use super::cycle::{Cycle, rounds, threshold};
use super::ending::stalled;
use super::evidence::{Evidence, Trouble, TroubleKind, of_unit, trouble};
use super::minimum_time::minimum_time;
use super::number::number;
use super::record::Record;
use crate::controller::{Logged, controller};
use crate::counted;
use crate::measurement::Kind;
use crate::msg;
use crate::order::{distinct, median, range};

/// The shorter half period over the longer, below which heating and cooling count as of different strength.
const SYMMETRIC: f64 = 0.66;

/// Share of the time with the input up from which a heater counts as too weak, and with it down as far too strong.
const WEAK: f64 = 0.85;

/// Fewest steps of the sensor in the amplitude.
const FEWEST_STEPS: f64 = 5.0;

/// Drift of a mean from the first to the last period, as a share of the swing, that is worth a word.
const DRIFT: f64 = 0.1;

/// Noise, as a share of the hysteresis, from which the relay switches on noise.
const NOISY: f64 = 0.5;

/// Flicker pulses for each half period from which they are told by the half period.
const FLICKERS: f64 = 0.25;

/// Scatter of the periods, as a share of their mean, from which they come at random.
const IRREGULAR: f64 = 0.3;

/// Median size of the second differences of white noise, in its standard deviations: 0.6745 times the root of 6.
const MEDIAN_OF_SECOND: f64 = 1.6522;

/// The input is stuck where it does not change over this last share of the record.
const STUCK: f64 = 0.5;

/// Share of the input's variance that a straight line in the output explains where a controller is at work.
const FOLLOWS: f64 = 0.95;

/// Values of an input that a controller makes; a relay, or steps by hand, have fewer.
const LEVELS: usize = 12;

/// Whole periods from which the window is long enough.
const WHOLE_PERIODS: usize = 2;

/// All that is wrong, the fatal first.
pub(super) fn find(evidence: &Evidence<'_>) -> Vec<Trouble> {
    let causes = match evidence.cycle {
        Some(cycle) => of_cycle(evidence, cycle),
        None => without_cycle(evidence),
    };
    let mut causes: Vec<Trouble> = causes.into_iter().flatten().collect();
    causes.sort_by_key(|c| !c.fatal);
    causes
}

/// Four significant digits.
fn n(value: f64) -> String {
    number(value)
}

fn of_cycle(e: &Evidence<'_>, cycle: &Cycle) -> Vec<Option<Trouble>> {
    let [up, down] = cycle.half_periods;
    let share = up / cycle.period;
    let ratio = up.min(down) / up.max(down);
    let (slower, faster) = if up > down {
        ("rise", "fall")
    } else {
        ("fall", "rise")
    };
    let weak = (share > WEAK).then(|| {
        let percent = n(100.0 * share);
        trouble(
            TroubleKind::HeaterTooWeak,
            false,
            share,
            msg!("The input is up {} % of the time: it is only just strong enough for this set point, so a \
                 controller has little left to act with.", percent),
        )
    });
    let asymmetric = (ratio < SYMMETRIC).then(|| {
        trouble(
            TroubleKind::Asymmetric,
            false,
            ratio,
            msg!(
                "The {} takes {} times as long as the {} ({} s against {} s): 4d/(πa) does not hold for such a \
                 cycle; levels whose middle is {} instead of {} would make it symmetric.",
                slower,
                n(1.0 / ratio),
                faster,
                n(up.max(down)),
                n(up.min(down)),
                n(cycle.levels[0] + share * (cycle.levels[1] - cycle.levels[0])),
                n(0.5 * (cycle.levels[0] + cycle.levels[1]))
            ),
        )
    });
    vec![
        weak,
        asymmetric,
        noise(e, cycle),
        quantised(e, cycle),
        drift(e, cycle),
        minimum_time(e, cycle),
    ]
}

fn noise(e: &Evidence<'_>, cycle: &Cycle) -> Option<Trouble> {
    let level = e.noise;
    let half_periods = 2.0 * cycle.periods as f64;
    let flickers = cycle.flicker as f64 / half_periods;
    let shown = cycle.flicker > 0 && level > NOISY * cycle.hysteresis.max(0.0);
    shown.then(|| {
        let (noise, hysteresis) = (
            of_unit(level, &e.record.output_unit),
            n(cycle.hysteresis.max(0.0)),
        );
        let text = if flickers > FLICKERS {
            msg!("The relay flickers {} times at each switch: the noise ({}) is about as large as the hysteresis \
                  ({}). A hysteresis of three times the noise, or a filter, ends it.", n(flickers), noise, hysteresis)
        } else {
            msg!(
                "The relay flickers {} in {} half periods: the noise ({}) is about as large as the hysteresis ({}). A \
                 hysteresis of three times the noise, or a filter, ends it.",
                counted!(cycle.flicker, "1 time", "{} times"),
                n(half_periods),
                noise,
                hysteresis
            )
        };
        trouble(TroubleKind::NoiseLargerThanHysteresis, false, level, text)
    })
}

/// Whether noise makes the switches of a cycle: they come at random, and the output jumps by as much as the hysteresis
/// from sample to sample.
pub(super) fn is_chatter(record: &Record, cycle: &Cycle) -> bool {
    cycle.scatter > IRREGULAR * cycle.period
        && jumps(&record.output) > NOISY * cycle.hysteresis.max(0.0)
}

/// Standard deviation of white noise that would change the second differences as much: no course that is sampled well
/// does.
fn jumps(output: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = output
        .windows(3)
        .map(|y| (y[0] - 2.0 * y[1] + y[2]).abs())
        .collect();
    median(&mut sizes) / MEDIAN_OF_SECOND
}

fn chatter(e: &Evidence<'_>, cycle: &Cycle) -> Trouble {
    let level = jumps(&e.record.output);
    trouble(
        TroubleKind::NoiseLargerThanHysteresis,
        true,
        level,
        msg!(
            "Noise switches the relay, every {} s on average and at random: the noise ({}) is not small compared with \
             the hysteresis ({}), so there is no cycle to read. A hysteresis of three times the noise, or a filter, \
             ends it.",
            n(0.5 * cycle.period),
            of_unit(level, &e.record.output_unit),
            n(cycle.hysteresis.max(0.0))
        ),
    )
}

fn quantised(e: &Evidence<'_>, cycle: &Cycle) -> Option<Trouble> {
    let step = e.record.sensor_step();
    let steps = cycle.amplitude / step;
    // A sensor with fine steps has as many values as samples.
    let few = distinct(e.record.output.clone()).len() * 4 < e.record.output.len();
    (few && steps < FEWEST_STEPS).then(|| {
        trouble(
            TroubleKind::Quantised,
            false,
            steps,
            msg!("The amplitude of {} is only {} steps of the sensor ({}): a larger swing or a finer sensor would tell \
                 more.", n(cycle.amplitude), n(steps), n(step)),
        )
    })
}

/// Mean of a column in each period.
fn means(record: &Record, column: &[f64], cycle: &Cycle) -> Vec<f64> {
    (cycle.marks.windows(2))
        .filter_map(|ends| {
            let inside = &column[record.between(ends[0], ends[1])];
            (!inside.is_empty()).then(|| inside.iter().sum::<f64>() / inside.len() as f64)
        })
        .collect()
}

/// A relay keeps the output where it is: what drifts is the input that this takes, and seldom the output too. As the
/// half periods change, so does the shape of the output, and with it its mean: that tells nothing more.
fn drift(e: &Evidence<'_>, cycle: &Cycle) -> Option<Trouble> {
    let ends = |column: &[f64]| {
        let means = means(e.record, column, cycle);
        (means.len() >= 3)
            .then(|| means.first().copied().zip(means.last().copied()))
            .flatten()
    };
    let (u, y) = (ends(&e.record.input)?, ends(&e.record.output)?);
    let swing = (cycle.levels[1] - cycle.levels[0]).abs();
    let shares = [(u.1 - u.0) / swing, (y.1 - y.0) / (2.0 * cycle.amplitude)];
    let (word, unit, ends, share) = if shares[0].abs() > DRIFT {
        ("mean input", &e.record.input_unit, u, shares[0])
    } else {
        ("mean output", &e.record.output_unit, y, shares[1])
    };
    (share.abs() > DRIFT).then(|| {
        trouble(
            TroubleKind::Drift,
            false,
            share,
            msg!(
                "From the first to the last period the {} drifts from {} to {}, {} % of its swing: the plant was not \
                 settled when the test began, or something else acts on it.",
                word,
                n(ends.0),
                of_unit(ends.1, unit),
                n(100.0 * share.abs())
            ),
        )
    })
}

fn without_cycle(e: &Evidence<'_>) -> Vec<Option<Trouble>> {
    let record = e.record;
    if let Some(cycle) = e.chatter {
        return vec![Some(chatter(e, cycle))];
    }
    if e.controller.is_some() {
        return vec![e.controller.clone()];
    }
    let Some(middle) = threshold(record) else {
        let (low, high) = range(&record.input);
        return vec![Some(trouble(
            TroubleKind::NoRelay,
            false,
            high - low,
            msg!(
                "The input takes values all the way from {} to {}: this is not a relay test, so there is no cycle to \
                 read; the models are fitted to the record as it is.",
                n(low),
                n(high)
            ),
        ))];
    };
    let last = record.input.len() - 1;
    let up = record.input[last] > middle;
    let since = (0..=last)
        .rev()
        .find(|&i| (record.input[i] > middle) != up)
        .map_or(0, |i| i + 1);
    let stuck = (record.time[last] - record.time[since]) / record.span();
    vec![
        (stuck > STUCK)
            .then(|| stalled(e, since, up))
            .flatten()
            .or_else(|| too_short(e)),
    ]
}

/// Whether a controller made the input: where it is a straight line in the output, the record shows the controller at
/// least as much as the plant.
pub(super) fn of_controller(record: &Record) -> Option<Trouble> {
    let count = record.input.len() as f64;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / count;
    let (u0, y0) = (mean(&record.input), mean(&record.output));
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        record
            .input
            .iter()
            .zip(&record.output)
            .map(|(u, y)| of(u - u0, y - y0))
            .sum()
    };
    let (uu, uy, yy) = (sum(&|u, _| u * u), sum(&|u, y| u * y), sum(&|_, y| y * y));
    let explained = uy * uy / (uu * yy);
    // A relay has two levels: that these follow the output says nothing.
    if distinct(record.input.clone()).len() <= LEVELS {
        return None;
    }
    if explained > FOLLOWS {
        let slope = uy / yy;
        let text = msg!(
            "The input follows the output: u = {} y + {} explains {} % of it, so a controller was at work, and the \
             models below describe it as much as the plant. Record a step or a relay test with the controller off.",
            n(slope),
            n(u0 - slope * y0),
            n(100.0 * explained)
        );
        return Some(trouble(TroubleKind::Controller, true, slope, text));
    }
    let made = controller(&Logged {
        kind: Kind::Process,
        step: record.sampling(),
        begins: &[],
        input: &record.input,
        output: &record.output,
        place: &[],
    })?;
    let text = msg!(
        "A {} controller made the input, {}: this is not a relay test. Where its set point or its limits moved the \
         input, the models are those of the plant.",
        made.kind,
        made.law
    );
    Some(trouble(
        TroubleKind::Controller,
        false,
        made.explained,
        text,
    ))
}

fn too_short(e: &Evidence<'_>) -> Option<Trouble> {
    let middle = threshold(e.record)?;
    let switched = e
        .record
        .input
        .windows(2)
        .filter(|u| (u[0] > middle) != (u[1] > middle))
        .count();
    let rounds = rounds(e.record).len().saturating_sub(1).min(switched / 2);
    (rounds <= WHOLE_PERIODS).then(|| {
        let (seconds, switched, went) = (
            n(e.record.span()),
            counted!(switched, "1 time", "{} times"),
            counted!(rounds, "1 time", "{} times"),
        );
        let text = if e.told {
            msg!("In {} s the input switches {} and the output goes up and down {}: there is no cycle to read, since \
                  at least {} whole periods after the first are needed; what is said here comes from the models, \
                  fitted to the record as it is.", seconds, switched, went, WHOLE_PERIODS)
        } else {
            msg!("In {} s the input switches {} and the output goes up and down {}: the window is too short, at least \
                  {} whole periods after the first are needed.", seconds, switched, went, WHOLE_PERIODS)
        };
        trouble(TroubleKind::WindowTooShort, !e.told, rounds as f64, text)
    })
}
