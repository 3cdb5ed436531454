//! Which formula is the answer, and what is said of it.

use super::curve::{self, Curve};
use super::tuning::{CURVE_BETTER, PIECES};
use super::weak::Weak;
use super::written::Written;
use crate::criticism::explain::{Trial, difference};
use crate::criticism::select::outweighs;
use crate::criticism::session::{Rest, Session};
use crate::diagnosis::{Discovery, DiscoveryEnd, FoundFormula, Parameter};
use crate::effect::EffectId;
use crate::message::Message;
use crate::msg;
use crate::uncertain::{brief, with_error};

/// A formula that was simulated.
pub(super) struct Simulated {
    pub id: EffectId,
    pub written: Written,
    pub trial: Trial,
}

/// The places of the formulas with the fewest numbers that the record cannot tell from the best one, the shortest
/// first.
pub(super) fn class(session: &Session, all: &[Simulated]) -> Vec<usize> {
    let error = |k: &usize| all[*k].trial.error();
    let Some(best) = (0..all.len()).min_by(|a, b| error(a).total_cmp(&error(b))) else {
        return Vec::new();
    };
    let is_same =
        |k: &usize| *k == best || difference(session, &all[*k].trial, &all[best].trial).is_same();
    let mut class: Vec<usize> = (0..all.len()).filter(is_same).collect();
    let numbers = |k: &usize| all[*k].written.numbers;
    let fewest = class.iter().map(numbers).min().unwrap_or(0);
    class.retain(|k| numbers(k) == fewest);
    class.sort_by(|a, b| {
        let length = |k: &usize| all[*k].written.length;
        length(a)
            .cmp(&length(b))
            .then(error(a).total_cmp(&error(b)))
    });
    class
}

/// How it ends with this answer.
fn end(
    session: &Session,
    base: &Trial,
    answer: &Simulated,
    curve: Option<&Curve>,
    foretold: Option<&[f64]>,
) -> DiscoveryEnd {
    if !difference(session, base, &answer.trial).is_better() {
        return DiscoveryEnd::NoneBetter;
    }
    if session.rest(&session.completed(&answer.trial.scored)) != Rest::More {
        return DiscoveryEnd::Explained;
    }
    if !outweighs(base.error(), answer.trial.error()) {
        return DiscoveryEnd::NoneBetter;
    }
    let more = curve
        .zip(foretold)
        .is_some_and(|(curve, own)| foretells_more(&curve.foretold, own));
    if more || answer.written.numbers >= PIECES {
        return DiscoveryEnd::Curve;
    }
    DiscoveryEnd::Part
}

/// Whether one of two regressions foretells blocks of the record better than the other, by the paired difference of the
/// logarithms of what they leave.
fn foretells_more(one: &[f64], other: &[f64]) -> bool {
    let pairs = one
        .iter()
        .zip(other)
        .filter(|(a, b)| **a > 0.0 && **b > 0.0);
    let logs: Vec<f64> = pairs.map(|(a, b)| libm::log(b / a)).collect();
    let n = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / n;
    let squares: f64 = logs.iter().map(|l| (l - mean).powi(2)).sum();
    n > 4.0 && mean > CURVE_BETTER * (squares / (n - 1.0) / n).sqrt()
}

/// What is told of a formula.
fn told(session: &Session, own: &Simulated) -> FoundFormula {
    let parameters = session.parameters(&own.trial.scored, &own.trial.spreads());
    let (own_parameters, body): (Vec<Parameter>, Vec<Parameter>) = parameters
        .into_iter()
        .partition(|p| p.effect == Some(own.id));
    let starts: Vec<String> = own_parameters
        .iter()
        .map(|p| format!("{} = {}", p.name, digits(p.value)))
        .collect();
    FoundFormula {
        name: own.id.as_str().to_owned(),
        formula: own.written.text.clone(),
        length: own.written.length,
        error: own.trial.error(),
        on_front: false,
        in_class: false,
        typed: format!("{}: {}; {}", own.id, own.written.text, starts.join(", ")),
        parameters: own_parameters,
        body,
    }
}

/// A number that reads back as itself to six digits.
fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// The answer where the model leaves noise as it is.
pub(super) fn nothing_left(base: &Trial) -> Discovery {
    Discovery {
        end: DiscoveryEnd::NothingLeft,
        before: base.error(),
        answer: None,
        formulas: Vec::new(),
        curve: None,
        experiment: None,
        text: "The model leaves measurement noise: there is no formula to look for.".into(),
    }
}

/// The whole answer; `foretold` is what the formula at the head of the class leaves of the blocks of the regression.
pub(super) fn answer(
    session: &Session,
    weak: &Weak,
    base: &Trial,
    all: &[Simulated],
    class: &[usize],
    foretold: Option<&[f64]>,
) -> Discovery {
    let kind = session.kind();
    let curve = curve::best(weak, kind);
    let mut formulas: Vec<FoundFormula> = all.iter().map(|s| told(session, s)).collect();
    let mut least = base.error();
    for formula in &mut formulas {
        formula.on_front = formula.error < least;
        least = least.min(formula.error);
    }
    let end = class.first().map_or(DiscoveryEnd::NoneBetter, |k| {
        end(session, base, &all[*k], curve.as_ref(), foretold)
    });
    let stands = matches!(end, DiscoveryEnd::Explained | DiscoveryEnd::Part);
    if stands {
        for k in class {
            formulas[*k].in_class = true;
        }
    }
    let mut discovery = Discovery {
        end,
        before: base.error(),
        answer: class.first().copied().filter(|_| stands),
        formulas,
        curve: curve
            .filter(|_| end == DiscoveryEnd::Curve)
            .map(|c| c.variable.axis(kind).to_owned()),
        experiment: None,
        text: Message::default(),
    };
    discovery.text = words(&discovery);
    discovery
}

/// The answer in words.
fn words(discovery: &Discovery) -> Message {
    let before = brief(discovery.before);
    let Some(found) = discovery.found() else {
        return match (&discovery.curve, discovery.end) {
            (Some(variable), _) => msg!(
                "None of the formulas that were tried: a smooth curve along the {} predicts more of what is left than \
                 the best of them.",
                Message::words(variable.clone())
            ),
            _ => msg!(
                "No formula of up to three terms explains more than it leaves of the error of {} × the noise.",
                before
            ),
        };
    };
    let values = found.parameters.iter().map(|p| {
        let value = with_error(p.value, p.std_error, &p.unit);
        msg!("{} = {}", Message::name(&p.name), value)
    });
    let mut text = msg!(
        "F = {} with {}: the error falls from {} to {} × the noise.",
        Message::name(&found.formula),
        Message::list(", ", values),
        before,
        brief(found.error)
    );
    if discovery.end == DiscoveryEnd::Part {
        text.add("More than noise is left: this is part of what is missing, or close to it.");
    }
    let others = discovery.class().skip(1);
    let others = Message::list(" or ", others.map(|f| Message::name(&f.formula)));
    if !others.is_empty() {
        text.add(msg!("This record cannot tell it from {}.", others));
    }
    text
}
