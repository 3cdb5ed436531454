//! The model in equations and numbers.

use std::fmt::Write as _;

use super::html::{Cell, table};
use super::input::{ReportInput, Tongue};
use super::math::{display, math};
use crate::diagnosis::{NextExperiment, Parameter, Step};
use crate::effect::baseline::{AMBIENT, RATE};
use crate::effect::{self, EffectId, VISCOUS_FRICTION, name_of};
use crate::measurement::Kind;
use crate::message::{Message, fixed};
use crate::msg;
use crate::uncertain::{brief, with_error};
use crate::user_model::Status;

/// Equations of the baseline that has these parameters; `F` is the sum of what the effects add. The second may be
/// empty.
pub fn baseline(kind: Kind, parameters: &[Parameter]) -> [&'static str; 2] {
    let has = |name: &str| {
        let mut own = parameters.iter().filter(|p| p.effect.is_none());
        own.any(|p| p.name == name)
    };
    match kind {
        Kind::Drive => ["J1 dv1/dt = u_acting - d1 v1 + F", "dx1/dt = v1"],
        Kind::Process if has(RATE) => ["dy/dt = K/T (u_acting + F)", ""],
        Kind::Process if has(AMBIENT) => ["T dy/dt + y = K (u_acting + F) + ambient", ""],
        Kind::Process => ["T dy/dt + y = K (u_acting + F)", ""],
    }
}

/// The baseline, and one block for each effect on top of it.
pub(super) fn equations(input: &ReportInput) -> String {
    let mut out = display(baseline(
        input.measurement.kind,
        &input.last.step.parameters,
    ));
    let tongue = input.tongue;
    let symbols = "the input that reaches the body (u, unless an effect changes it)";
    let _ = writeln!(
        out,
        "<p class=\"small\">{}: {}; {}: {}</p>",
        math("u_acting"),
        tongue.page(symbols),
        math("F"),
        tongue.page("the forces of the effects")
    );
    for id in added(&input.last.step) {
        let _ = writeln!(out, "<h3>{}</h3>", tongue.page(name_of(id)));
        let Some(effect) = effect::find(id) else {
            if let Some(formula) = input.model.and_then(|m| m.formula(id)) {
                let _ = writeln!(
                    out,
                    "<p>{}</p>\n{}",
                    tongue.page("An effect of your own."),
                    display([format!("F = {formula}").as_str()])
                );
            }
            continue;
        };
        let _ = writeln!(
            out,
            "<p>{}</p>\n{}<p class=\"small\">{}</p>",
            tongue.page(effect.sentence()),
            display(effect.equation().lines()),
            tongue.page(effect.source())
        );
    }
    out
}

/// What each kind of experiment would tell of a class, the proposed one first.
pub(super) fn experiments(tongue: Tongue, proposal: &NextExperiment) -> String {
    let trials = std::iter::once(proposal.trial()).chain(proposal.others.iter().cloned());
    let rows: Vec<Vec<Cell>> = trials
        .map(|t| vec![Cell::Text(t.text.clone()), Cell::Number(t.times_noise())])
        .collect();
    let mut out = String::new();
    table(
        &mut out,
        tongue,
        &["Experiment", "The models differ by (× noise)"],
        &rows,
    );
    out
}

/// Effects that are not in the baseline.
fn added(step: &Step) -> Vec<EffectId> {
    step.effects
        .iter()
        .copied()
        .filter(|id| *id != VISCOUS_FRICTION)
        .collect()
}

pub(super) fn parameters(tongue: Tongue, parameters: &[Parameter]) -> String {
    let mut out = String::new();
    let rows: Vec<Vec<Cell>> = parameters
        .iter()
        .map(|p| {
            vec![
                Cell::Math(p.name.clone()),
                Cell::Text(Message::words(p.label.clone())),
                Cell::Number(with_error(p.value, p.std_error, &p.unit)),
                Cell::Text(
                    match p.status {
                        Status::Free => "",
                        Status::Prior(_) => "known roughly",
                        Status::Fixed => "fixed",
                    }
                    .into(),
                ),
                Cell::Text(
                    p.effect
                        .filter(|id| *id != VISCOUS_FRICTION)
                        .map_or("baseline", name_of)
                        .into(),
                ),
            ]
        })
        .collect();
    table(
        &mut out,
        tongue,
        &[
            "symbol",
            "meaning",
            "value ± standard error",
            "",
            "belongs to",
        ],
        &rows,
    );
    let widened = tongue.page("Standard errors are widened where the residuals are correlated.");
    let _ = writeln!(out, "<p class=\"small\">{widened}</p>");
    out
}

/// A table for each step that had candidates.
pub(super) fn candidates(tongue: Tongue, steps: &[Step]) -> String {
    let mut out = String::new();
    for step in steps.iter().filter(|s| !s.candidates.is_empty()) {
        let names = Message::list(" + ", added(step).into_iter().map(name_of));
        let error = brief(step.error);
        let title = if names.is_empty() {
            msg!("On top of the baseline (error {})", error)
        } else {
            msg!("On top of {} (error {})", names, error)
        };
        let _ = writeln!(out, "<h3>{}</h3>", tongue.page(title));
        let rows: Vec<Vec<Cell>> = step
            .candidates
            .iter()
            .map(|c| {
                let ids = c.effects.iter().map(|e| name_of(*e));
                let note = if c.equivalent_to.is_empty() {
                    c.standing().into()
                } else {
                    let others = c.equivalent_to.iter().map(|e| name_of(*e));
                    msg!("cannot be told apart from {}", Message::list(", ", others))
                };
                // What does not help has values that mean nothing.
                let shown = c.parameters.iter().filter(|_| c.significant);
                let values = shown.map(|p| {
                    let value = with_error(p.value, p.std_error, &p.unit);
                    msg!("{} = {}", Message::name(&p.name), value)
                });
                vec![
                    Cell::Text(Message::list(" + ", ids)),
                    Cell::Number(brief(c.error).into()),
                    Cell::Number(fixed(c.delta_bic, 1)),
                    Cell::Text(note),
                    Cell::Text(Message::list(", ", values)),
                ]
            })
            .collect();
        table(
            &mut out,
            tongue,
            &["effect", "error", "evidence", "", "its parameters"],
            &rows,
        );
    }
    let explained = "Error: after a refit, on the part of the record that the model was not fitted to, in units of the \
                     noise. Evidence: change of the Bayesian information criterion on the fitted data, negative is \
                     better.";
    let _ = writeln!(out, "<p class=\"small\">{}</p>", tongue.page(explained));
    out
}
