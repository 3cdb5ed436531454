//! Sums of terms, as they are tried and as one types them.

use super::grammar::Form;
use super::tuning::PRICE;
use super::weak::Weak;
use crate::measurement::Kind;

/// A term: a form with values of its numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Term {
    pub form: Form,
    pub numbers: [f64; 2],
}

/// A sum of terms with what it leaves of the regression.
#[derive(Clone, Debug)]
pub(super) struct Sum {
    pub terms: Vec<Term>,
    pub loss: f64,
}

impl Sum {
    /// Windows of its terms, unweighted.
    pub fn columns(&self, weak: &Weak) -> Vec<Vec<f64>> {
        let of = |t: &Term| weak.columns(&t.form, t.numbers);
        self.terms.iter().flat_map(of).collect()
    }
}

/// What is least for a formula that leaves little and is short: the logarithm of what it leaves of some hundred windows
/// that tell something of their own, and a price for each part.
pub(super) fn score(loss: f64, length: usize) -> f64 {
    libm::log(loss.max(f64::MIN_POSITIVE)) + PRICE * length as f64
}

/// A sum as one types it, with all coefficients above 0.
pub(super) fn text(terms: &[Term], kind: Kind) -> String {
    let texts: Vec<String> = terms
        .iter()
        .enumerate()
        .map(|(k, t)| t.form.text(kind, k))
        .collect();
    texts.join("+")
}
