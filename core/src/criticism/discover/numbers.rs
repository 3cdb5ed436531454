//! Values that the numbers of a form may have, by what the record reaches: a grid, and the steps from there.

use super::grammar::{Form, Numbers};
use super::sum::Term;
use super::tuning::{CENTRES, FIRST_SCALE, LAST_SCALE, MOST_WAVES, SCALES, WAVE_STEP, WIDTHS};
use super::weak::{Reach, Weak};
use crate::effect::{Variable, variables};
use crate::measurement::Kind;

/// What the record reaches of each variable.
pub(super) struct Reaches(Vec<(Variable, Reach)>);

impl Reaches {
    /// Those of a record.
    pub fn of(kind: Kind, weak: &Weak) -> Self {
        let all = variables(kind).iter();
        Self(all.map(|(_, v)| (*v, weak.seen.reach(*v))).collect())
    }

    fn reach(&self, variable: Variable) -> Option<Reach> {
        self.0.iter().find(|(v, _)| *v == variable).map(|(_, r)| *r)
    }

    /// Values of the numbers of a form that are tried.
    pub fn grid(&self, form: &Form) -> Vec<[f64; 2]> {
        let Some((bend, variable)) = form.bend else {
            return vec![[0.0; 2]];
        };
        let Some(reach) = self.reach(variable) else {
            return Vec::new();
        };
        let width = reach.high - reach.low;
        let centre = |k: usize| reach.low + width * (k as f64 + 0.5) / CENTRES as f64;
        match bend.numbers() {
            Numbers::Scale => {
                let ratio = libm::log(LAST_SCALE / FIRST_SCALE) / (SCALES - 1) as f64;
                let at = |k: usize| reach.size * FIRST_SCALE * libm::exp(ratio * k as f64);
                (0..SCALES).map(|k| [at(k), 0.0]).collect()
            }
            Numbers::Centre => (0..CENTRES).map(|k| [centre(k), 0.0]).collect(),
            Numbers::CentreAndWidth => (0..CENTRES)
                .flat_map(|k| WIDTHS.map(|w| [centre(k), w * width]))
                .collect(),
            Numbers::WaveNumber => {
                let step = WAVE_STEP * std::f64::consts::PI / width.max(f64::MIN_POSITIVE);
                let count = (2.0 * MOST_WAVES / WAVE_STEP) as usize;
                (1..=count).map(|k| [step * k as f64, 0.0]).collect()
            }
        }
    }

    /// First steps of the numbers of a term: half of the grid's.
    pub fn steps(&self, term: &Term) -> Vec<f64> {
        let Some((bend, variable)) = term.form.bend else {
            return Vec::new();
        };
        let Some(reach) = self.reach(variable) else {
            return Vec::new();
        };
        let width = reach.high - reach.low;
        match bend.numbers() {
            Numbers::Scale => vec![0.2],
            Numbers::Centre => vec![0.5 * width / CENTRES as f64],
            Numbers::CentreAndWidth => vec![0.5 * width / CENTRES as f64, 0.35],
            Numbers::WaveNumber => vec![0.5 * WAVE_STEP * std::f64::consts::PI / width],
        }
    }

    /// Whether the numbers of a term are such as the record can tell: beyond them a bend is a power.
    pub fn may_be(&self, term: &Term) -> bool {
        let Some((bend, variable)) = term.form.bend else {
            return true;
        };
        let Some(reach) = self.reach(variable) else {
            return false;
        };
        let [p, q] = term.numbers;
        let scale =
            |s: f64| s > 0.3 * FIRST_SCALE * reach.size && s < 1.5 * LAST_SCALE * reach.size;
        let centre = |c: f64| c > reach.low && c < reach.high;
        match bend.numbers() {
            Numbers::Scale => scale(p),
            Numbers::Centre => centre(p),
            Numbers::CentreAndWidth => centre(p) && scale(q),
            Numbers::WaveNumber => p > 0.0 && p.is_finite(),
        }
    }
}

/// A number after a step: sizes change by factors.
pub(super) fn stepped(term: &Term, place: usize, step: f64) -> f64 {
    let now = term.numbers[place];
    match term.form.bend.map(|(bend, _)| bend.numbers()) {
        Some(Numbers::Scale) => now * libm::exp(step),
        Some(Numbers::CentreAndWidth) if place == 1 => now * libm::exp(step),
        _ => now + step,
    }
}
