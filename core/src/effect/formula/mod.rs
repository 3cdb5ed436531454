//! An effect that the user writes as a formula: a force on the body (an input of a process) with named
//! parameters.
//!
//! The variables are `x`, `v` (position and velocity of a drive), `y` (output of a process), `u` (the input
//! that reaches the body) and `t` (time since the first sample, s). Where a formula has no finite value, no
//! force acts.

mod dimension;
mod evaluate;
mod parse;
mod start;

use serde::{Deserialize, Serialize};

use super::atom::Values;
use super::{Atom, Dimension, Effect, EffectId, Moment, Own, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::message::Message;
use crate::model::{Instant, Model};
use crate::msg;

pub use parse::{FormulaError, MAX_FORMULA, MAX_PARAMETERS};
pub(crate) use parse::{Variable, variables};

/// An effect as the user writes it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Formula {
    /// Its name, which is also its id: see [`EffectId::own`].
    pub name: String,
    /// The force, such as `-a*exp(-((x-b)/c)^2)`.
    pub text: String,
}

impl Formula {
    /// Checks the formula for this kind of system.
    ///
    /// # Errors
    /// The column and what would be right there.
    pub fn check(&self, kind: Kind) -> Result<(), FormulaError> {
        self.parameters(kind).map(|_| ())
    }

    /// Names of its parameters, in the order in which the effect has them.
    ///
    /// # Errors
    /// The column and what would be right there.
    pub fn parameters(&self, kind: Kind) -> Result<Vec<String>, FormulaError> {
        let (tree, names) = parse::parse(&self.text, kind)?;
        let order = start::order(&tree, names.len());
        Ok(order.into_iter().map(|k| names[k].clone()).collect())
    }

    /// The force at an instant with these values of its parameters, in the order of [`Self::parameters`]; 0 where the
    /// formula has no finite value.
    ///
    /// # Errors
    /// The column and what would be right there.
    pub fn force(
        &self,
        kind: Kind,
    ) -> Result<impl Fn(&Instant, &[f64]) -> f64 + use<>, FormulaError> {
        let (tree, names) = parse::parse(&self.text, kind)?;
        let order = start::order(&tree, names.len());
        Ok(move |at: &Instant, values: &[f64]| tree.force(at, &sorted(&order, values)))
    }

    /// The effect.
    ///
    /// Effects are referred to as long as the program runs, as those of the library are: what is made here is
    /// never given back. It is a few hundred bytes.
    ///
    /// # Errors
    /// The column and what would be right there; column 1 for the name.
    pub fn effect(&self, kind: Kind) -> Result<&'static dyn Effect, FormulaError> {
        let id = EffectId::own(&self.name).ok_or_else(|| FormulaError {
            column: 1,
            message: msg!(
                "'{}' is not a valid name for an effect: {}",
                Message::name(&self.name),
                EffectId::OWN_NAMES
            ),
        })?;
        let (tree, names) = parse::parse(&self.text, kind)?;
        let dimensions = dimension::dimensions(&tree, names.len(), kind);
        let order = start::order(&tree, names.len());
        let specs: Vec<ParameterSpec> = order
            .iter()
            .map(|k| {
                let symbol: &'static str = names[*k].clone().leak();
                ParameterSpec {
                    symbol,
                    label: symbol,
                    dimension: dimensions[*k],
                    range: Range::Signed,
                }
            })
            .collect();
        let text: &'static str = format!("F = {}", self.text).leak();
        let linear = start::linear(&tree, names.len());
        let tree: &'static parse::Expr = Box::leak(Box::new(tree));
        Ok(Box::leak(Box::new(FormulaEffect {
            id,
            equation: text,
            kinds: match kind {
                Kind::Drive => &[Kind::Drive],
                Kind::Process => &[Kind::Process],
            },
            columns: columns(tree, &order),
            linear,
            tree,
            order,
            specs: specs.leak(),
        })))
    }
}

/// A formula as an effect.
struct FormulaEffect {
    id: EffectId,
    equation: &'static str,
    kinds: &'static [Kind],
    tree: &'static parse::Expr,
    /// Indices in the tree of the parameters, as `specs` has them.
    order: Vec<usize>,
    /// Whether the force is linear in each parameter of the tree, all of them together.
    linear: Vec<bool>,
    specs: &'static [ParameterSpec],
    /// What each parameter, in the order of `specs`, multiplies where the force is linear in all of them.
    columns: Option<&'static [Part]>,
}

/// What each of the parameters multiplies, in this order; none where the force is not all in them.
fn columns(tree: &'static parse::Expr, order: &[usize]) -> Option<&'static [Part]> {
    let count = order.len();
    let alone =
        |k: usize| -> Vec<f64> { (0..count).map(|j| f64::from(u8::from(j == k))).collect() };
    if start::leaves_a_force(tree, count) {
        return None;
    }
    let parts: Vec<Part> = order
        .iter()
        .map(|k| {
            let values = alone(*k);
            let force = move |m: &Moment| {
                let at = Instant {
                    position: m.position,
                    velocity: m.velocity,
                    input: m.input,
                    time: m.time,
                };
                tree.force(&at, &values)
            };
            Part::Own(Own(Box::leak(Box::new(force))))
        })
        .collect();
    Some(parts.leak())
}

/// Values in the order of the tree, where they come in this one.
fn sorted(order: &[usize], values: &[f64]) -> Vec<f64> {
    let mut sorted = vec![0.0; order.len()];
    for (k, value) in order.iter().zip(values) {
        sorted[*k] = *value;
    }
    sorted
}

impl Effect for FormulaEffect {
    fn id(&self) -> EffectId {
        self.id
    }

    fn name(&self) -> &'static str {
        self.id.as_str()
    }

    fn sentence(&self) -> &'static str {
        "An effect of your own: a force given by a formula."
    }

    fn equation(&self) -> &'static str {
        self.equation
    }

    fn source(&self) -> &'static str {
        "your own formula"
    }

    fn kinds(&self) -> &'static [Kind] {
        self.kinds
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        self.specs
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let dimensions: Vec<Dimension> = (0..self.specs.len())
            .map(|tree_index| {
                let place = self.order.iter().position(|k| *k == tree_index);
                place.map_or(Dimension::Undetermined, |p| self.specs[p].dimension)
            })
            .collect();
        start::starts(self.tree, &dimensions, &self.linear, probe)
            .into_iter()
            .map(|point| self.order.iter().map(|k| point[*k]).collect())
            .collect()
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        // Linear parameters alone: what is left of a formula without them would be a force of known size.
        let linear = self.columns.filter(|_| self.linear.iter().all(|l| *l));
        let atom = linear.map(|columns| Atom::linear(columns, Values::Coefficients));
        atom.into_iter().collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (tree, values) = (self.tree, sorted(&self.order, values));
        model
            .own_forces
            .push(Box::new(move |at: &Instant| tree.force(at, &values)));
    }
}
