//! Formulas for what no effect explains.

use serde::{Deserialize, Serialize};

use super::experiment::NextExperiment;
use super::parameter::Parameter;
use crate::message::Message;

/// How a search for a formula ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DiscoveryEnd {
    /// A formula explains what is left, but for noise.
    Explained,
    /// A formula explains a part of it for certain, and more than noise is left.
    Part,
    /// The model leaves noise: there is nothing to look for.
    NothingLeft,
    /// No formula lowers the error beyond chance, or explains more than it leaves.
    NoneBetter,
    /// A smooth curve along one variable foretells more than any formula: the form is none of those that were tried.
    Curve,
}

/// A formula that was tried.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundFormula {
    /// Its name as an effect of the user's own.
    pub name: String,
    /// The force (the further input of a process), such as `-a*tanh(v/s)`.
    pub formula: String,
    /// Names, numbers and signs in it.
    pub length: usize,
    /// Root mean square of what the model with it leaves of blocks that its fit did not see, in noise units.
    pub error: f64,
    /// Whether every shorter one leaves more.
    pub on_front: bool,
    /// Whether this record cannot tell it from the best one.
    pub in_class: bool,
    /// Its own parameters, in SI units.
    pub parameters: Vec<Parameter>,
    /// Those of the body beside it.
    pub body: Vec<Parameter>,
    /// As an effect of the user's own is typed: `name: formula; a = 0.05, s = 2`.
    pub typed: String,
}

/// What a search for a formula found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Discovery {
    /// How it ended.
    pub end: DiscoveryEnd,
    /// Error of the model without a formula, in noise units.
    pub before: f64,
    /// Place of the answer among the formulas: the shortest that this record cannot tell from the best one; none where
    /// there is none.
    pub answer: Option<usize>,
    /// What was tried, shorter ones first.
    pub formulas: Vec<FoundFormula>,
    /// Where a smooth curve foretells more: along what.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<String>,
    /// The experiment that tells the formulas of the class apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub experiment: Option<NextExperiment>,
    /// In plain words.
    pub text: Message,
}

impl Discovery {
    /// No answer, where there is not even a model.
    pub(crate) fn none() -> Self {
        Self {
            end: DiscoveryEnd::NoneBetter,
            before: 0.0,
            answer: None,
            formulas: Vec::new(),
            curve: None,
            experiment: None,
            text: "No model can be fitted to this record.".into(),
        }
    }

    /// The answer.
    pub fn found(&self) -> Option<&FoundFormula> {
        self.formulas.get(self.answer?)
    }

    /// Formulas that leave less than every shorter one.
    pub fn front(&self) -> impl Iterator<Item = &FoundFormula> {
        self.formulas.iter().filter(|f| f.on_front)
    }

    /// Formulas that this record cannot tell from the best one, the answer first.
    pub fn class(&self) -> impl Iterator<Item = &FoundFormula> {
        let others = self.formulas.iter().enumerate();
        let others = others.filter(|(k, f)| f.in_class && Some(*k) != self.answer);
        self.found().into_iter().chain(others.map(|(_, f)| f))
    }
}
