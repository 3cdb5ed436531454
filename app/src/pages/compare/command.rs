//! What is asked of the page.

use hysteron_core::diagnosis::Limits;
use hysteron_core::effect::EffectId;

use super::formula::Typed;
use super::look::Look;
use crate::command;
use crate::recent::Recent;
use crate::widgets::columns::Wanted;

/// What a click asks for; carried out once, after drawing.
#[derive(Clone)]
pub(super) enum Command {
    OpenBuiltIn(usize),
    OpenDialog,
    /// Opens a file once more.
    Reopen(Recent),
    Close,
    /// Which column of a file is what, and the file with that, or without.
    Map(Wanted),
    /// Leaves the file that is being read.
    CancelReading,
    Add(EffectId),
    Undo,
    Redo,
    /// Goes to the model with so many effects.
    Step(usize),
    Look(Look),
    Before(bool),
    Fingerprint(EffectId),
    Limit(Limits),
    /// Looks for a proposal again, within these limits.
    Search(usize, Limits),
    /// Looks for a formula of what is left, or stops looking.
    Discover(bool),
    /// Saves the input of a proposal.
    SaveInput(usize),
    /// The word that opens the seal is being typed, and whether it can be read.
    Word(String, bool),
    /// Opens the seal.
    Reveal,
    /// What the app is to do.
    Desk(Vec<command::Command>),
    /// Sets the parameters by hand, and whether the slider is still held; or goes back to the fit.
    Hand(Vec<f64>, bool),
    DropHand,
    /// Hides what helps most until it is found; and buys a hint.
    GuessFirst(bool),
    Hint,
    Cancel,
    Shade(usize),
    Dismiss,
    ExportReport,
    SaveModel,
    OpenModel,
    DropModel,
    Type(Typed),
    AddOwn(Typed),
}
