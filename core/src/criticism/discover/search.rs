//! Which terms, and which sums of them, leave least of the regression? All terms and pairs are tried on grids of their
//! numbers; those of the best are refined, and where the best pairs leave more than noise, a third term is tried beside
//! them.

use std::collections::BTreeMap;

use super::grammar::{Form, forms, length};
use super::numbers::{Reaches, stepped};
use super::sum::{Sum, Term, score, text};
use super::tuning::{
    AT_A_TIME, FIRST_TERMS, LAST_STEP, LEAST_TOLD, MOST_STEPS, NOISE_LEFT, PER_PART, REFINED,
    SHAPES_KEPT, THIRDS, TOLD, WORTH,
};
use super::weak::{BodyColumn, Solved, Weak};
use crate::crew::Crew;
use crate::measurement::Kind;
use crate::sums::dot;

/// A form with values of its numbers, on the grid.
struct Tried {
    form: usize,
    numbers: [f64; 2],
    /// Orthonormal, without what the body explains.
    directions: Vec<Vec<f64>>,
    /// What they have of what the body leaves.
    shares: Vec<f64>,
}

impl Tried {
    fn gain(&self) -> f64 {
        self.shares.iter().map(|s| s * s).sum()
    }
}

/// A pair of tried terms with what it takes away.
type Pair = (f64, [usize; 2]);

enum Stage {
    /// The next form.
    Forms(usize),
    /// The next first terms.
    Pairs(usize),
    /// The next sum to be refined.
    Refine(usize),
    /// The next pair beside which a third term is looked for.
    Thirds(usize),
    /// The next sum of three to be refined.
    RefineThirds(usize),
    Done,
}

/// A search that goes on piece by piece.
pub(super) struct Search {
    kind: Kind,
    forms: Vec<Form>,
    reaches: Reaches,
    tried: Vec<Tried>,
    /// Places of the first terms of pairs, and of each form its best pair with each other.
    firsts: Vec<usize>,
    pairs: BTreeMap<[usize; 2], Pair>,
    open: Vec<Sum>,
    /// Pairs beside which a third term is looked for.
    seconds: Vec<Sum>,
    pub found: Vec<Sum>,
    stage: Stage,
}

impl Search {
    pub fn new(kind: Kind, weak: &Weak) -> Self {
        Self {
            kind,
            forms: forms(kind),
            reaches: Reaches::of(kind, weak),
            tried: Vec::new(),
            firsts: Vec::new(),
            pairs: BTreeMap::new(),
            open: Vec::new(),
            seconds: Vec::new(),
            found: Vec::new(),
            stage: Stage::Forms(0),
        }
    }

    /// Share done, 0 to 1.
    pub fn progress(&self) -> f64 {
        let share = |k: usize, of: usize| k as f64 / of.max(1) as f64;
        match self.stage {
            Stage::Forms(k) => 0.4 * share(k, self.forms.len()),
            Stage::Pairs(k) => 0.4 + 0.3 * share(k, self.firsts.len()),
            Stage::Refine(k) => 0.7 + 0.15 * share(k, self.open.len()),
            Stage::Thirds(k) => 0.85 + 0.05 * share(k, self.seconds.len()),
            Stage::RefineThirds(k) => 0.9 + 0.1 * share(k, self.open.len()),
            Stage::Done => 1.0,
        }
    }

    /// Does some work; false when all is done.
    pub fn advance(&mut self, weak: &Weak, crew: &Crew) -> bool {
        match self.stage {
            Stage::Forms(k) => {
                let end = (k + AT_A_TIME).min(self.forms.len());
                let found = crew.gather(end - k, |i| self.on_grid(weak, k + i));
                self.tried.extend(found.into_iter().flatten());
                self.stage = Stage::Forms(end);
                if end == self.forms.len() {
                    self.drop_repeated();
                    self.choose_firsts();
                    self.stage = Stage::Pairs(0);
                }
            }
            Stage::Pairs(k) => {
                let end = (k + AT_A_TIME).min(self.firsts.len());
                let found = crew.gather(end - k, |i| self.beside(self.firsts[k + i]));
                for pair in found.into_iter().flatten() {
                    let mut key = pair.1.map(|t| self.tried[t].form);
                    key.sort_unstable();
                    let best = self.pairs.entry(key).or_insert(pair);
                    if pair.0 > best.0 {
                        *best = pair;
                    }
                }
                self.stage = Stage::Pairs(end);
                if end == self.firsts.len() {
                    self.open = self.likely(weak.first_loss());
                    self.pairs = BTreeMap::new();
                    self.stage = Stage::Refine(0);
                }
            }
            Stage::Refine(k) => {
                let end = self.refine(weak, crew, k);
                self.stage = Stage::Refine(end);
                if end == self.open.len() {
                    self.open = Vec::new();
                    self.seconds = self.worth_a_third(weak);
                    self.stage = Stage::Thirds(0);
                }
            }
            Stage::Thirds(k) => {
                let end = (k + PER_PART).min(self.seconds.len());
                let found = crew.gather(end - k, |i| self.with_third(weak, &self.seconds[k + i]));
                self.open.extend(found.into_iter().flatten());
                self.stage = Stage::Thirds(end);
                if end == self.seconds.len() {
                    self.tried = Vec::new();
                    let open = std::mem::take(&mut self.open);
                    self.open = self.best(open, REFINED[2]);
                    self.stage = Stage::RefineThirds(0);
                }
            }
            Stage::RefineThirds(k) => {
                let end = self.refine(weak, crew, k);
                self.stage = Stage::RefineThirds(end);
                if end == self.open.len() {
                    self.stage = Stage::Done;
                }
            }
            Stage::Done => return false,
        }
        true
    }

    /// Refines some of the open sums; the place of the next.
    fn refine(&mut self, weak: &Weak, crew: &Crew, from: usize) -> usize {
        let end = (from + PER_PART).min(self.open.len());
        let found = crew.gather(end - from, |i| self.refined(weak, &self.open[from + i]));
        self.found.extend(found.into_iter().flatten());
        end
    }

    /// The best pairs, where they leave more than noise.
    fn worth_a_third(&self, weak: &Weak) -> Vec<Sum> {
        let pairs = self.found.iter().filter(|s| s.terms.len() == 2).cloned();
        let pairs = self.best(pairs.collect(), THIRDS);
        let least = pairs.iter().map(|s| s.loss).fold(f64::INFINITY, f64::min);
        if least < NOISE_LEFT * weak.len() as f64 {
            return Vec::new();
        }
        pairs
    }

    /// A pair with each form as a third term.
    fn with_third(&self, weak: &Weak, pair: &Sum) -> Vec<Sum> {
        let Some(directions) = weak.directions(&pair.columns(weak)) else {
            return Vec::new();
        };
        let held = Tried {
            form: 0,
            numbers: [0.0; 2],
            shares: directions.iter().map(|d| dot(d, &weak.left)).collect(),
            directions,
        };
        let mut best: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
        for (place, tried) in self.tried.iter().enumerate() {
            if let Some(gain) = gain_beside(&held, tried) {
                let entry = best.entry(tried.form).or_insert((gain, place));
                if gain > entry.0 {
                    *entry = (gain, place);
                }
            }
        }
        let with = |(gain, place): (f64, usize)| {
            let tried = &self.tried[place];
            let mut terms = pair.terms.clone();
            terms.push(Term {
                form: self.forms[tried.form].clone(),
                numbers: tried.numbers,
            });
            Sum {
                terms,
                loss: (pair.loss - gain).max(0.0),
            }
        };
        self.best(best.into_values().map(with).collect(), REFINED[2])
    }

    /// So many of these sums that leave least for their length.
    fn best(&self, mut sums: Vec<Sum>, count: usize) -> Vec<Sum> {
        let score = |s: &Sum| score(s.loss, length(&text(&s.terms, self.kind)));
        sums.sort_by(|a, b| score(a).total_cmp(&score(b)));
        sums.truncate(count);
        sums
    }

    /// A form with all values of its numbers.
    fn on_grid(&self, weak: &Weak, form: usize) -> Vec<Tried> {
        let own = &self.forms[form];
        let told = |numbers: [f64; 2]| {
            let directions = weak.directions(&weak.columns(own, numbers))?;
            Some(Tried {
                form,
                numbers,
                shares: directions.iter().map(|d| dot(d, &weak.left)).collect(),
                directions,
            })
        };
        self.reaches
            .grid(own)
            .into_iter()
            .filter_map(told)
            .collect()
    }

    /// Of forms without numbers that are the same on this record, the shortest stays.
    fn drop_repeated(&mut self) {
        let mut kept: Vec<Tried> = Vec::with_capacity(self.tried.len());
        for tried in self.tried.drain(..) {
            let same = |other: &Tried| {
                let (a, b) = (&tried.directions, &other.directions);
                a.len() == 1 && b.len() == 1 && dot(&a[0], &b[0]).abs() > 1.0 - 1e-9
            };
            let plain = self.forms[tried.form].bend.is_none();
            if !plain || !kept.iter().any(same) {
                kept.push(tried);
            }
        }
        self.tried = kept;
    }

    /// The best values of the numbers of each form, and of these the best.
    fn choose_firsts(&mut self) {
        let mut places: Vec<usize> = (0..self.tried.len()).collect();
        let gain = |t: &usize| self.tried[*t].gain();
        places.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
        let mut of_form = vec![0; self.forms.len()];
        places.retain(|t| {
            let count = &mut of_form[self.tried[*t].form];
            *count += 1;
            *count <= SHAPES_KEPT
        });
        places.truncate(FIRST_TERMS);
        self.firsts = places;
    }

    /// The best pair of a term with each form.
    fn beside(&self, first: usize) -> Vec<Pair> {
        let one = &self.tried[first];
        let mut best: BTreeMap<usize, Pair> = BTreeMap::new();
        for (second, two) in self.tried.iter().enumerate() {
            if two.form == one.form && self.forms[one.form].bend.is_none() {
                continue;
            }
            let Some(more) = gain_beside(one, two) else {
                continue;
            };
            let pair = (one.gain() + more, [first, second]);
            let entry = best.entry(two.form).or_insert(pair);
            if pair.0 > entry.0 {
                *entry = pair;
            }
        }
        best.into_values().collect()
    }

    /// Sums that leave least for their length.
    fn likely(&self, first_loss: f64) -> Vec<Sum> {
        let term = |t: usize| Term {
            form: self.forms[self.tried[t].form].clone(),
            numbers: self.tried[t].numbers,
        };
        let of = |gain: f64, terms: &[usize]| Sum {
            terms: terms.iter().map(|t| term(*t)).collect(),
            loss: (first_loss - gain).max(0.0),
        };
        let mut seen = vec![false; self.forms.len()];
        let singles = self
            .firsts
            .iter()
            .filter(|t| !std::mem::replace(&mut seen[self.tried[**t].form], true));
        let singles = singles.map(|t| of(self.tried[*t].gain(), &[*t])).collect();
        let pairs = self
            .pairs
            .values()
            .map(|(gain, terms)| of(*gain, terms))
            .collect();
        let mut all = self.best(singles, REFINED[0]);
        all.extend(self.best(pairs, REFINED[1]));
        all
    }

    /// The numbers with which a sum leaves least, by steps along each that become shorter.
    fn refined(&self, weak: &Weak, sum: &Sum) -> Option<Sum> {
        let mut terms = sum.terms.clone();
        let mut columns: Vec<Vec<Vec<f64>>> = terms
            .iter()
            .map(|t| weak.columns(&t.form, t.numbers))
            .collect();
        let loss = |columns: &[Vec<Vec<f64>>]| -> Option<f64> {
            let solved = weak.solve(&columns.concat())?;
            is_body(&solved, &weak.body, self.kind).then_some(solved.loss)
        };
        let mut least = loss(&columns)?;
        let mut steps: Vec<(usize, usize, f64)> = Vec::new();
        for (k, term) in terms.iter().enumerate() {
            steps.extend(
                self.reaches
                    .steps(term)
                    .into_iter()
                    .enumerate()
                    .map(|(j, s)| (k, j, s)),
            );
        }
        let mut share = 1.0;
        let mut rounds = 0;
        while share > LAST_STEP && !steps.is_empty() && rounds < MOST_STEPS {
            rounds += 1;
            let mut moved = false;
            for (k, j, step) in &steps {
                for sign in [1.0, -1.0] {
                    let mut other = terms[*k].clone();
                    other.numbers[*j] = stepped(&other, *j, sign * share * step);
                    if !self.reaches.may_be(&other) {
                        continue;
                    }
                    let mut trial = columns.clone();
                    trial[*k] = weak.columns(&other.form, other.numbers);
                    if let Some(less) = loss(&trial).filter(|l| *l < WORTH * least) {
                        (least, columns, moved) = (less, trial, true);
                        terms[*k] = other;
                        break;
                    }
                }
            }
            if !moved {
                share /= 2.0;
            }
        }
        Some(Sum { terms, loss: least })
    }
}

/// What a term takes away beside another one, or beside a sum; none where that says the same.
fn gain_beside(one: &Tried, two: &Tried) -> Option<f64> {
    let least = LEAST_TOLD * LEAST_TOLD;
    // Of each direction of the second: what the first leaves of its share, and of the products of both.
    let mut left = [0.0; 2];
    let [mut own, mut other, mut cross] = [1.0, 1.0, 0.0];
    for (direction, share) in one.directions.iter().zip(&one.shares) {
        let mut parts = [0.0; 2];
        for (part, second) in parts.iter_mut().zip(&two.directions) {
            *part = dot(direction, second);
        }
        left[0] -= parts[0] * share;
        left[1] -= parts[1] * share;
        own -= parts[0] * parts[0];
        other -= parts[1] * parts[1];
        cross -= parts[0] * parts[1];
    }
    for (left, share) in left.iter_mut().zip(&two.shares) {
        *left += share;
    }
    if two.directions.len() == 1 {
        return (own > least).then(|| left[0] * left[0] / own);
    }
    let determinant = own * other - cross * cross;
    (determinant > least).then(|| {
        let [a, b] = left;
        (other * a * a - 2.0 * cross * a * b + own * b * b) / determinant
    })
}

/// Whether what drives the body is told, and a drive does not drive itself.
fn is_body(solved: &Solved, body: &[BodyColumn], kind: Kind) -> bool {
    let of = |wanted: BodyColumn| {
        let place = body.iter().position(|c| *c == wanted)?;
        Some((solved.coefficients[place], solved.errors[place]))
    };
    let input = of(BodyColumn::Input).is_some_and(|(gain, error)| match kind {
        Kind::Drive => gain > TOLD * error,
        Kind::Process => gain.abs() > TOLD * error,
    });
    input && of(BodyColumn::Velocity).is_none_or(|(rate, error)| rate < TOLD * error)
}
