//! A model beside the truth, and what it is worth.

use serde::{Deserialize, Serialize};

use super::{Hidden, MysteryError, Truth, seal};
use crate::diagnosis::Parameter;
use crate::effect::{Dimension, Effect, EffectId, VISCOUS_FRICTION, find};
use crate::measurement::{Kind, Motion};

/// Points for the effects and for the numbers; together 100.
const EFFECT_POINTS: f64 = 70.0;
const NUMBER_POINTS: f64 = 30.0;

/// A number this close has full marks, as a share of the truth.
const CLOSE: f64 = 0.05;
/// So has one within so many of its standard errors, up to the widest share.
const ERRORS: f64 = 2.0;
const WIDEST: f64 = 0.5;
/// So much further off it has none.
const FAR: f64 = 0.5;

/// The model that is judged: the one on screen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Effects that were added, each with those that the record cannot tell from it.
    pub effects: Vec<(EffectId, Vec<EffectId>)>,
    /// Every parameter of the model.
    pub parameters: Vec<Parameter>,
}

/// What became of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mark {
    /// Hidden and found.
    Right,
    /// Hidden; found was this one, and the record cannot tell the two apart.
    Alike(EffectId),
    /// Hidden and not found.
    Missed,
    /// Not hidden.
    Wrong,
}

/// One effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Which.
    pub effect: EffectId,
    /// What became of it.
    pub mark: Mark,
}

/// One number beside the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// The effect that it belongs to; `None` for the simplest model.
    pub effect: Option<EffectId>,
    /// Its symbol.
    pub symbol: String,
    /// What it is, SI.
    pub truth: f64,
    /// What the model says, in `unit`, with its standard error; `None` where the effect was missed.
    pub found: Option<(f64, f64)>,
    /// SI unit.
    pub unit: String,
    /// Share of the marks for it, 0 to 1.
    pub mark: f64,
}

impl Compared {
    /// Its error as a share of the truth.
    pub fn error(&self) -> Option<f64> {
        self.found
            .map(|(value, _)| (value - self.truth) / self.truth.abs())
    }
}

/// The truth beside a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reveal {
    /// The truth.
    pub truth: Truth,
    /// Hidden effects, then those that were added and are not hidden.
    pub rows: Vec<Row>,
    /// The numbers that can be compared.
    pub numbers: Vec<Compared>,
    /// Points for the effects, and how many there are.
    pub effect_points: [f64; 2],
    /// Points for the numbers, and how many there are.
    pub number_points: [f64; 2],
}

impl Reveal {
    /// Opens a seal with its word and judges an answer.
    ///
    /// # Errors
    /// One sentence, where the word is another one.
    pub fn open(sealed: &[u8], word: &str, answer: &Answer) -> Result<Self, MysteryError> {
        let truth = Truth::read(&seal::open(sealed, word)?)?;
        Ok(Self::of(truth, answer))
    }

    /// Judges an answer.
    ///
    /// Effects: the share of right ones among all that are hidden or were added; all points where there is
    /// neither. An effect that the record cannot tell from the hidden one is right. Numbers: the mean of
    /// their marks. They are those of the hidden effects and of the simplest model; where an effect stands
    /// for another, the simplest model need not be right and is left out.
    pub fn of(truth: Truth, answer: &Answer) -> Self {
        let mut left: Vec<_> = answer
            .effects
            .iter()
            .filter(|(effect, _)| *effect != VISCOUS_FRICTION)
            .collect();
        let mut marks: Vec<Option<Mark>> = vec![None; truth.hidden.len()];
        for (hidden, mark) in truth.hidden.iter().zip(&mut marks) {
            if let Some(i) = left.iter().position(|(e, _)| *e == hidden.effect) {
                left.remove(i);
                *mark = Some(Mark::Right);
            }
        }
        for (hidden, mark) in truth.hidden.iter().zip(&mut marks) {
            let alike = |(_, class): &&(EffectId, Vec<EffectId>)| class.contains(&hidden.effect);
            if mark.is_none()
                && let Some(i) = left.iter().position(alike)
            {
                *mark = Some(Mark::Alike(left.remove(i).0));
            }
        }
        let marks: Vec<Mark> = marks
            .into_iter()
            .map(|m| m.unwrap_or(Mark::Missed))
            .collect();
        let wrong = left.len();
        let right = marks.iter().filter(|m| **m != Mark::Missed).count();
        let numbers = numbers(&truth, &marks, answer);
        let all = truth.hidden.len() + wrong;
        let share = |part: f64, of: usize| if of == 0 { 1.0 } else { part / of as f64 };
        let known: f64 = numbers.iter().map(|n| n.mark).sum();
        let hidden = truth.hidden.iter().zip(&marks);
        let mut rows: Vec<Row> = hidden
            .map(|(h, mark)| Row {
                effect: h.effect,
                mark: *mark,
            })
            .collect();
        rows.extend(left.iter().map(|(effect, _)| Row {
            effect: *effect,
            mark: Mark::Wrong,
        }));
        Self {
            effect_points: [EFFECT_POINTS * share(right as f64, all), EFFECT_POINTS],
            number_points: [NUMBER_POINTS * share(known, numbers.len()), NUMBER_POINTS],
            truth,
            rows,
            numbers,
        }
    }

    /// All points, 0 to 100.
    pub fn points(&self) -> f64 {
        self.effect_points[0] + self.number_points[0]
    }
}

fn numbers(truth: &Truth, marks: &[Mark], answer: &Answer) -> Vec<Compared> {
    let (kind, mut numbers) = (truth.kind, Vec::new());
    if !marks.iter().any(|m| matches!(m, Mark::Alike(_))) {
        let baseline = truth.baseline.iter();
        numbers.extend(baseline.map(|(symbol, value)| compare(kind, None, symbol, *value, answer)));
    }
    for (Hidden { effect, parameters }, mark) in truth.hidden.iter().zip(marks) {
        if !matches!(mark, Mark::Alike(_)) {
            let own = parameters.iter();
            numbers.extend(
                own.map(|(symbol, value)| compare(kind, Some(*effect), symbol, *value, answer)),
            );
        }
    }
    numbers
}

/// One number; those that may have either sign with the same meaning are compared by size.
fn compare(
    kind: Kind,
    effect: Option<EffectId>,
    symbol: &str,
    truth: f64,
    answer: &Answer,
) -> Compared {
    let found = answer
        .parameters
        .iter()
        .find(|p| p.effect.filter(|e| *e != VISCOUS_FRICTION) == effect && p.name == symbol);
    // Half a turn of its phase turns the sign of a ripple.
    let has_phase = |e: &dyn Effect| {
        e.parameters()
            .iter()
            .any(|p| p.dimension == Dimension::Phase)
    };
    let ripple = effect.and_then(find).is_some_and(has_phase);
    let value = |p: &Parameter| if ripple { p.value.abs() } else { p.value };
    let mark = found.map_or(0.0, |p| {
        let error = (value(p) - truth).abs() / truth.abs();
        let close = (ERRORS * p.std_error / truth.abs()).clamp(CLOSE, WIDEST);
        // Where the model has no number there are no marks.
        (1.0 - (error - close).max(0.0) / FAR).max(0.0)
    });
    Compared {
        effect,
        symbol: symbol.to_owned(),
        truth,
        found: found.map(|p| (value(p), p.std_error)),
        unit: found.map_or_else(|| unit(kind, effect, symbol), |p| p.unit.clone()),
        mark,
    }
}

/// The unit that the library gives a parameter; empty where it does not know it.
fn unit(kind: Kind, effect: Option<EffectId>, symbol: &str) -> String {
    let motion = match kind {
        Kind::Drive => Motion::Rotational,
        Kind::Process => Motion::None,
    };
    let parameters = effect.and_then(find).map(Effect::parameters);
    let own = parameters.unwrap_or_default().iter();
    let mut own = own.filter(|p| p.symbol == symbol);
    own.next()
        .map_or_else(String::new, |p| p.dimension.unit(motion).to_owned())
}
