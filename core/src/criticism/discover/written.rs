//! A sum of terms as a formula that a user could have typed, with values from which a fit begins.

use super::grammar::{Bend, length};
use super::sum::{Sum, Term};
use super::weak::{BodyColumn, Weak};
use crate::effect::baseline::Baseline;
use crate::measurement::Kind;

/// A formula with values.
#[derive(Clone, Debug)]
pub(super) struct Written {
    pub text: String,
    /// Symbols with values in SI units.
    pub values: Vec<(&'static str, f64)>,
    /// Values of the baseline, as many as the regression tells.
    pub body: Vec<f64>,
    /// Parts of the text.
    pub length: usize,
    /// Numbers that it fits.
    pub numbers: usize,
    /// What it leaves of the regression.
    pub loss: f64,
    /// Windows of the acceleration that the formula and the body explain.
    pub said: Vec<f64>,
    /// What it was.
    pub sum: Sum,
}

/// Symbols and values of a term with these coefficients, and whether it is taken away.
fn term(term: &Term, place: usize, coefficients: &[f64]) -> (bool, Vec<(&'static str, f64)>) {
    let symbols = term.form.symbols(place);
    let first = coefficients.first().copied().unwrap_or(0.0);
    let mut values: Vec<f64> = Vec::new();
    let is_wave = term.form.bend.is_some_and(|(bend, _)| bend == Bend::Wave);
    if is_wave {
        let second = coefficients.get(1).copied().unwrap_or(0.0);
        values.extend([
            libm::hypot(first, second),
            term.numbers[0],
            libm::atan2(second, first),
        ]);
    } else {
        values.push(first.abs());
        values.extend(term.numbers);
    }
    let negative = !is_wave && first < 0.0;
    (negative, symbols.into_iter().zip(values).collect())
}

impl Written {
    /// None where the regression does not tell the coefficients.
    pub fn of(sum: &Sum, weak: &Weak, baseline: Baseline, kind: Kind) -> Option<Self> {
        let columns: Vec<Vec<Vec<f64>>> = sum
            .terms
            .iter()
            .map(|t| weak.columns(&t.form, t.numbers))
            .collect();
        let flat = columns.concat();
        let solved = weak.solve(&flat)?;
        let gain = *solved.coefficients.first()?;
        let mut from = weak.body.len();
        let (mut text, mut values) = (String::new(), Vec::new());
        for (k, (own, columns)) in sum.terms.iter().zip(&columns).enumerate() {
            let coefficients: Vec<f64> = solved.coefficients[from..from + columns.len()]
                .iter()
                .map(|c| c / gain)
                .collect();
            from += columns.len();
            let (negative, known) = term(own, k, &coefficients);
            match (negative, k) {
                (true, _) => text.push('-'),
                (false, 0) => {}
                (false, _) => text.push('+'),
            }
            text.push_str(&own.form.text(kind, k));
            values.extend(known);
        }
        let of = |wanted: BodyColumn| {
            let place = weak.body.iter().position(|c| *c == wanted)?;
            Some(solved.coefficients[place])
        };
        let rate = -of(BodyColumn::Velocity).unwrap_or(0.0);
        let body = match baseline {
            Baseline::Drive => vec![1.0 / gain, (rate / gain).max(0.0)],
            Baseline::Lag { .. } if rate <= 0.0 => return None,
            Baseline::Lag { .. } => vec![
                gain / rate,
                1.0 / rate,
                of(BodyColumn::Ambient).unwrap_or(0.0) / rate,
            ],
            Baseline::Integrator => vec![gain],
        };
        let finite =
            values.iter().all(|(_, v)| v.is_finite()) && body.iter().all(|b| b.is_finite());
        finite.then(|| Self {
            length: length(&text),
            numbers: values.len(),
            said: weak.said(&flat, &solved),
            loss: sum.loss,
            sum: sum.clone(),
            text,
            values,
            body,
        })
    }
}
