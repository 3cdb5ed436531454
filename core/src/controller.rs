//! Was the loop closed? In open loop the input knows nothing of what the output does by chance; a controller answers to
//! it.

use std::fmt::Write as _;
use std::ops::Range;

use crate::least_squares::{least_squares, take_off};
use crate::measurement::Kind;
use crate::order::{distinct, range};
use crate::sums::dot;
use crate::uncertain::brief;

/// Levels of an input up to which it is switched and not computed.
const FEW_LEVELS: usize = 6;

/// Share of the variance of the input that the output must explain for a linear controller to have made it.
const CONTROLLED: f64 = 0.99;

/// Samples of the past that foretell the next: three resonances.
const PAST: usize = 6;

/// Share of what the past does not foretell of the input that must follow the output for the loop to have been closed:
/// in open loop it is chance alone (at most 0.003 in records of 3,000 samples), with a controller that had the logged
/// readings nearly all.
const ANSWERED: f64 = 0.5;

/// Share of the variance of its changes down to which an input is foretold wholly: sums of squares are not known to
/// less.
const FORETOLD: f64 = 1e-6;

/// Change of the input, in mean changes, from which it jumps: of noise it would be one in 10^15.
const JUMP: f64 = 10.0;

/// Samples between two limits of the input from which on it may show what it follows: twice the past that foretells it.
const SHORTEST_STRETCH: usize = 2 * PAST;

/// Changes of the input from which the share that follows the output is told: of as many as the past has terms, chance
/// takes all.
const LEAST_CHANGES: usize = 10 * PAST;

/// Samples that are looked at: a controller shows in so many, or not at all.
const MOST_SAMPLES: usize = 100_000;

/// A record at equal time steps of a loop that may have been closed.
#[derive(Clone, Copy, Debug)]
pub struct Logged<'a> {
    pub kind: Kind,
    /// From a sample to the next, s.
    pub step: f64,
    /// First samples of runs: a gap in time is before each but the first.
    pub begins: &'a [usize],
    pub input: &'a [f64],
    /// Velocity of a drive, output of a process.
    pub output: &'a [f64],
    /// Position of a drive; not looked at for a process.
    pub place: &'a [f64],
}

/// A linear controller, read off the record: `u = offset + sum gains`.
#[derive(Clone, Debug, PartialEq)]
pub struct Controller {
    /// Terms as they are read, such as `-1.84 y`.
    pub law: String,
    /// Its kind in a word.
    pub kind: &'static str,
    /// Share of the variance of the input that it explains, where it is not at a limit.
    pub explained: f64,
    /// Gain of its first term, in units of the input per unit of what it measures.
    pub gain: f64,
    /// Whether its set point changed: else the input says nothing that the output does not.
    pub is_led: bool,
}

/// A term that a controller may have.
struct Term {
    symbol: &'static str,
    values: Vec<f64>,
    /// What it is the integral about, if it is one.
    about: Option<f64>,
}

/// The controller that made the input, if one did. Where the input is at its limits it follows nothing, and what an
/// integral holds afterwards is not known: each stretch between them has an offset of its own.
pub fn controller(logged: &Logged<'_>) -> Option<Controller> {
    let between = between_limits(logged);
    let switched = without_jumps(logged.input, &[], between.clone());
    let free = switched.iter().flat_map(|s| &logged.input[s.clone()]);
    if distinct(free.copied().collect()).len() <= FEW_LEVELS {
        return None;
    }
    let term = |symbol, values: &[f64]| Term {
        symbol,
        values: values.to_vec(),
        about: None,
    };
    let (output, place) = (logged.output, logged.place);
    let sets = match logged.kind {
        Kind::Process => vec![
            ("proportional", vec![term("y", output)]),
            (
                "proportional-integral",
                vec![term("y", output), integral(output, logged.step)],
            ),
        ],
        Kind::Drive => vec![
            ("proportional", vec![term("v", output)]),
            ("proportional", vec![term("x", place)]),
            (
                "proportional-derivative",
                vec![term("x", place), term("v", output)],
            ),
        ],
    };
    let made = sets.into_iter().filter_map(|(kind, terms)| {
        let stretches = without_jumps(logged.input, &terms, switched.clone());
        let law = follows(logged.input, &terms, &stretches, 0)?;
        let made = law.explained >= CONTROLLED && is_control(logged, &law, &terms, &stretches);
        made.then_some((kind, terms, law, stretches))
    });
    // A term more is the controller's where it explains more than it leaves.
    let (kind, terms, law, stretches) = made.reduce(|simple, rich| {
        let worth = simple.2.left > 2.0 * rich.2.left;
        if worth { rich } else { simple }
    })?;
    let answered = match logged.kind {
        Kind::Process => answers(logged.input, output, &stretches),
        Kind::Drive => [output, place]
            .iter()
            .any(|measured| answers(logged.input, measured, &stretches)),
    };
    answered.then(|| Controller {
        law: written(logged, &law.gains, &terms, &stretches),
        kind,
        explained: law.explained,
        gain: law.gains[0],
        is_led: follows(logged.input, &terms, &between, 0)
            .is_none_or(|one| one.explained < CONTROLLED),
    })
}

/// The integral of an output about its mean.
fn integral(output: &[f64], step: f64) -> Term {
    let mean = output.iter().sum::<f64>() / output.len().max(1) as f64;
    let sum = output.iter().scan(0.0, |sum, y| {
        *sum += step * (y - mean);
        Some(*sum)
    });
    Term {
        symbol: "y",
        values: sum.collect(),
        about: Some(mean),
    }
}

/// Stretches of the record without a gap in which the input is between its limits.
fn between_limits(logged: &Logged<'_>) -> Vec<Range<usize>> {
    let (least, most) = range(logged.input);
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for (k, u) in logged.input.iter().enumerate().take(MOST_SAMPLES) {
        if *u <= least || *u >= most {
            continue;
        }
        match stretches.last_mut() {
            Some(last) if last.end == k && logged.begins.binary_search(&k).is_err() => {
                last.end = k + 1;
            }
            _ => stretches.push(k..k + 1),
        }
    }
    stretches.retain(|s| s.len() >= SHORTEST_STRETCH);
    stretches
}

/// The stretches cut where the input jumps, as it does with a set point: by much more than it follows the changes of
/// the terms elsewhere. With the jumps out, the terms are followed closer, and smaller jumps show.
fn without_jumps(
    input: &[f64],
    terms: &[Term],
    mut stretches: Vec<Range<usize>>,
) -> Vec<Range<usize>> {
    loop {
        let changes = |values: &[f64]| -> Vec<f64> {
            let parts = stretches.iter().map(|s| &values[s.clone()]);
            parts
                .flat_map(|part| part.windows(2).map(|w| w[1] - w[0]))
                .collect()
        };
        let columns: Vec<Vec<f64>> = terms.iter().map(|t| changes(&t.values)).collect();
        let mut left = changes(input);
        if let Some(law) = regressed(&left, &columns) {
            take_off(&mut left, &columns, &law.gains);
        }
        let usual = left.iter().map(|c| c.abs()).sum::<f64>() / left.len().max(1) as f64;
        let mut jumps = left.iter().map(|c| c.abs() >= JUMP * usual && usual > 0.0);
        let mut parts: Vec<Range<usize>> = Vec::new();
        for stretch in &stretches {
            let mut from = stretch.start;
            for k in stretch.start + 1..stretch.end {
                if jumps.next() == Some(true) {
                    parts.push(from..k);
                    from = k;
                }
            }
            parts.push(from..stretch.end);
        }
        let whole = parts.len() == stretches.len();
        parts.retain(|s| s.len() >= SHORTEST_STRETCH);
        stretches = parts;
        if whole || terms.is_empty() {
            return stretches;
        }
    }
}

/// What the input follows.
struct Law {
    gains: Vec<f64>,
    /// Share of its variance that they explain.
    explained: f64,
    /// Sum of the squares that they leave.
    left: f64,
}

/// Gains of the terms, taken `later` samples after the input, by which the input follows them in each stretch, and the
/// share of its variance there that they explain.
fn follows(input: &[f64], terms: &[Term], stretches: &[Range<usize>], later: usize) -> Option<Law> {
    let integrates = terms.iter().any(|t| t.about.is_some());
    let of_stretches = |values: &[f64], later: usize| -> Vec<f64> {
        let parts = stretches
            .iter()
            .map(|s| &values[s.start + later..s.end - 1 + later]);
        parts.flat_map(|part| centred(part, integrates)).collect()
    };
    let columns: Vec<Vec<f64>> = terms
        .iter()
        .map(|t| of_stretches(&t.values, later))
        .collect();
    regressed(&of_stretches(input, 0), &columns)
}

/// Values about their mean, or about their straight line where a set point makes one of an integral.
fn centred(values: &[f64], integrates: bool) -> impl Iterator<Item = f64> + '_ {
    let [mean, slope] = line(values);
    let slope = if integrates { slope } else { 0.0 };
    let middle = (values.len() as f64 - 1.0) / 2.0;
    let at = move |k: usize| mean + slope * (k as f64 - middle);
    values
        .iter()
        .enumerate()
        .map(move |(k, value)| value - at(k))
}

/// Mean of some values, and their slope in a sample.
fn line(values: &[f64]) -> [f64; 2] {
    let n = values.len().max(1) as f64;
    let middle = (n - 1.0) / 2.0;
    let mean = values.iter().sum::<f64>() / n;
    let moment = values
        .iter()
        .enumerate()
        .map(|(k, v)| (k as f64 - middle) * (v - mean));
    let squares = (n * n - 1.0) * n / 12.0;
    [mean, moment.sum::<f64>() / squares.max(f64::MIN_POSITIVE)]
}

/// Whether the input answers to what the output does by chance: of its changes, what its own past and that of the
/// output do not foretell follows the change of the output. An input that is foretold wholly, as a sine is, tells
/// nothing of that.
fn answers(input: &[f64], output: &[f64], stretches: &[Range<usize>]) -> bool {
    let changes = |values: &[f64], before: usize| -> Vec<f64> {
        let parts = stretches
            .iter()
            .map(|s| &values[s.start + PAST - before..s.end - before]);
        parts
            .flat_map(|part| part.windows(2).map(|w| w[1] - w[0]))
            .collect()
    };
    let past = (1..PAST).flat_map(|before| [changes(input, before), changes(output, before)]);
    let mut columns: Vec<Vec<f64>> = past.collect();
    let target = changes(input, 0);
    if target.len() < LEAST_CHANGES {
        return false;
    }
    let Some(Law {
        explained: foretold,
        ..
    }) = regressed(&target, &columns)
    else {
        return false;
    };
    columns.push(changes(output, 0));
    let told = regressed(&target, &columns).map_or(foretold, |law| law.explained);
    let news = 1.0 - foretold;
    news > FORETOLD && told - foretold > ANSWERED * news
}

/// Whether a law that the input follows was made by a controller, and not by the plant itself. A drive is controlled by
/// what opposes its motion: what grows with it holds a spring or drags through a liquid. The output of a process that
/// settles within a sample follows the input, and tells the one of the sample before better than its own.
fn is_control(logged: &Logged<'_>, law: &Law, terms: &[Term], stretches: &[Range<usize>]) -> bool {
    match logged.kind {
        Kind::Drive => law.gains.first().is_some_and(|gain| *gain < 0.0),
        Kind::Process => {
            let late = follows(logged.input, terms, stretches, 1);
            late.is_none_or(|late| law.explained > late.explained)
        }
    }
}

/// The law as one writes it; an integral is that of the distance from the set point of the longest stretch.
fn written(
    logged: &Logged<'_>,
    gains: &[f64],
    terms: &[Term],
    stretches: &[Range<usize>],
) -> String {
    let mut text = "u =".to_owned();
    let mut add = |gain: f64, what: &str| {
        let sign = match (gain < 0.0, text.ends_with('=')) {
            (true, true) => " -",
            (true, false) => " - ",
            (false, true) => " ",
            (false, false) => " + ",
        };
        // Writing into a string cannot fail.
        let _ = write!(text, "{sign}{}{what}", brief(gain.abs()));
    };
    let longest = stretches
        .iter()
        .max_by_key(|s| s.len())
        .cloned()
        .unwrap_or_default();
    let left = longest.map(|k| {
        let made = terms.iter().zip(gains).map(|(t, gain)| gain * t.values[k]);
        logged.input[k] - made.sum::<f64>()
    });
    let [offset, slope] = line(&left.collect::<Vec<f64>>());
    for (term, gain) in terms.iter().zip(gains) {
        match term.about {
            Some(about) => {
                let set_point = about - slope / (logged.step * gain);
                let sign = if set_point < 0.0 { '+' } else { '-' };
                add(
                    *gain,
                    &format!(" ∫({} {sign} {}) dt", term.symbol, brief(set_point.abs())),
                );
            }
            None => add(*gain, &format!(" {}", term.symbol)),
        }
    }
    if terms.iter().all(|t| t.about.is_none()) {
        add(offset, "");
    }
    text
}

/// Least squares on columns about their means.
fn regressed(target: &[f64], columns: &[Vec<f64>]) -> Option<Law> {
    let gains = least_squares(columns, target)?;
    let mut rest = target.to_vec();
    take_off(&mut rest, columns, &gains);
    let (squares, left) = (dot(target, target), dot(&rest, &rest));
    (squares > 0.0).then(|| Law {
        gains,
        explained: 1.0 - left / squares,
        left,
    })
}
