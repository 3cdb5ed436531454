//! Was the loop closed? An input that follows from the output by a linear law was made by a controller.

use std::fmt::Write as _;

use super::signals::Signals;
use super::tuning::{CONTROLLED, FEW_LEVELS};
use crate::measurement::Kind;
use crate::sums::deviation;

/// A linear controller, read off the record: `u = offset + sum gains`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Controller {
    /// Terms as they are read, such as `-1.84 y`.
    pub law: String,
    /// Its kind in a word.
    pub kind: &'static str,
    /// Share of the variance of the input that it explains.
    pub explained: f64,
}

/// A term that a controller may have.
struct Term {
    symbol: &'static str,
    values: Vec<f64>,
}

/// The controller that made the input, if one did: at the level and in the changes from sample to sample, which an output
/// that follows the input does not have.
pub(super) fn controller(signals: &Signals) -> Option<Controller> {
    if levels(&signals.input) <= FEW_LEVELS {
        return None;
    }
    let n = signals.len();
    let one = || Term {
        symbol: "",
        values: vec![1.0; n],
    };
    let term = |symbol, values: &[f64]| Term {
        symbol,
        values: values.to_vec(),
    };
    let sets: Vec<(&'static str, Vec<Term>)> = match signals.kind {
        Kind::Process => {
            let y = &signals.speed;
            let mut sum = 0.0;
            let mean = y.iter().sum::<f64>() / n as f64;
            let integral: Vec<f64> = y
                .iter()
                .map(|y| {
                    sum += signals.step * (y - mean);
                    sum
                })
                .collect();
            vec![
                ("proportional", vec![one(), term("y", y)]),
                (
                    "proportional-integral",
                    vec![one(), term("y", y), term("∫y", &integral)],
                ),
            ]
        }
        Kind::Drive => {
            let v = match &signals.velocity {
                Some(v) => v.values.as_slice(),
                None => signals.speed.as_slice(),
            };
            vec![
                ("proportional", vec![one(), term("v", v)]),
                (
                    "proportional-derivative",
                    vec![one(), term("x", &signals.place), term("v", v)],
                ),
            ]
        }
    };
    sets.into_iter().find_map(|(kind, terms)| {
        let (gains, explained) = regressed(&signals.input, &terms)?;
        let changes = |values: &[f64]| values.windows(2).map(|w| w[1] - w[0]).collect::<Vec<f64>>();
        let rest: Vec<Term> = terms[1..]
            .iter()
            .map(|t| term(t.symbol, &changes(&t.values)))
            .collect();
        let (_, of_changes) = regressed(&changes(&signals.input), &rest)?;
        let made = explained >= CONTROLLED && of_changes >= CONTROLLED / 2.0;
        (made && is_control(signals, &gains, &terms, explained)).then(|| Controller {
            law: law(&gains, &terms),
            kind,
            explained,
        })
    })
}

/// Whether a law that the input follows was made by a controller, and not by the plant itself. A drive is controlled by what opposes
/// its motion: what grows with it holds a spring or drags through a liquid. The output of a process that settles within a sample
/// follows the input, and tells the one of the sample before better than its own.
fn is_control(signals: &Signals, gains: &[f64], terms: &[Term], explained: f64) -> bool {
    match signals.kind {
        Kind::Drive => gains.get(1).is_some_and(|gain| *gain < 0.0),
        Kind::Process => {
            let n = signals.len();
            let late = terms.iter().map(|t| Term {
                symbol: t.symbol,
                values: t.values[1..].to_vec(),
            });
            let late: Vec<Term> = late.collect();
            let before = regressed(&signals.input[..n - 1], &late);
            before.is_none_or(|(_, of_late)| explained > of_late)
        }
    }
}

fn law(gains: &[f64], terms: &[Term]) -> String {
    let mut text = "u =".to_owned();
    let order = (1..terms.len()).chain(std::iter::once(0));
    for (place, k) in order.enumerate() {
        let gain = gains[k];
        let sign = match (gain < 0.0, place) {
            (true, 0) => " -",
            (true, _) => " - ",
            (false, 0) => " ",
            (false, _) => " + ",
        };
        let space = if terms[k].symbol.is_empty() { "" } else { " " };
        // Writing into a string cannot fail.
        let _ = write!(
            text,
            "{sign}{}{space}{}",
            three(gain.abs()),
            terms[k].symbol
        );
    }
    text
}

/// Three significant digits.
fn three(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = libm::log10(value).floor() as i32;
    if (-3..6).contains(&exponent) {
        let decimals = usize::try_from(2 - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}

fn levels(input: &[f64]) -> usize {
    let mut seen: Vec<u64> = input.iter().map(|u| u.to_bits()).collect();
    seen.sort_unstable();
    seen.dedup();
    seen.len()
}

/// Least squares on a few terms: gains and the share of the variance that they explain.
fn regressed(target: &[f64], terms: &[Term]) -> Option<(Vec<f64>, f64)> {
    let columns: Vec<&[f64]> = terms
        .iter()
        .map(|t| t.values.as_slice())
        .chain([target])
        .collect();
    let n = columns.len();
    let mut values = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            values[i * n + j] = columns[i].iter().zip(columns[j]).map(|(a, b)| a * b).sum();
        }
    }
    let reduced = super::gram::Reduced {
        order: n - 1,
        values,
    };
    let gains = reduced.coefficients(&reduced.solve(false)?);
    let variance = deviation(target).powi(2) * target.len() as f64;
    (variance > 0.0).then(|| (gains.clone(), 1.0 - reduced.loss(&gains) / variance))
}
