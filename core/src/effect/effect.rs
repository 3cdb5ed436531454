//! What an effect is.

use super::atom::{Atom, BodyStart};
use super::id::EffectId;
use super::probe::{Probe, SeenGap};
use super::spec::ParameterSpec;
use crate::measurement::Kind;
use crate::model::Model;

/// A piece of physics that a user can add to a model.
pub trait Effect: Sync {
    /// Name in files, JSON and links.
    fn id(&self) -> EffectId;
    /// Name on screen, such as `Coulomb friction`.
    fn name(&self) -> &'static str;
    /// One sentence that a student understands.
    fn sentence(&self) -> &'static str;
    /// The equation as text.
    fn equation(&self) -> &'static str;
    /// Where the equation stands: author, year.
    fn source(&self) -> &'static str;
    /// The kinds of system that it makes sense for.
    fn kinds(&self) -> &'static [Kind];
    /// Its parameters, in the order in which every slice of values has them.
    fn parameters(&self) -> &'static [ParameterSpec];
    /// Values from which a fit may start, most likely first; several where the error has several valleys. The effect is
    /// only asked for if it leaves less than this `share` of the squared error: what takes long to search for need not
    /// be.
    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>>;
    /// The same with inertia and viscous friction of the body, where the record tells them together.
    fn starts_with_body(&self, _probe: &Probe, _share: f64) -> Vec<BodyStart> {
        Vec::new()
    }

    /// The same values with other contacts, with which a fit may come to a lower valley: such as bounce, which no
    /// regression tells, or harder ones, where a fit has stalled at these.
    fn other_contacts(&self, _values: &[f64], _bouncing: bool) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// How many of its first parameters tell that it is there, each alone by not being 0.
    fn telling(&self) -> usize {
        1
    }

    /// Symbols of the parameters that make it what it is: where data do not tell their sizes, they show something else.
    fn marks(&self) -> &'static [&'static str] {
        &[]
    }

    /// Least standard errors of these values, where the record shows a gap: a fit that has many valleys side by side
    /// knows its own only.
    fn least_errors(&self, _values: &[f64], _gap: &SeenGap) -> Vec<f64> {
        Vec::new()
    }
    /// Effects that are this one with some values at 0: it replaces them.
    fn contains(&self) -> &'static [EffectId] {
        &[]
    }

    /// Effects that it comes near to at the ends of the ranges of its values: in the place of one of these that
    /// explains the data it says no more.
    fn limits(&self) -> &'static [EffectId] {
        &[]
    }

    /// Whether it tells how the record was made and not what the machine does: it is fitted and said, but nothing is
    /// missing from the machine.
    fn is_of_record(&self) -> bool {
        false
    }

    /// Whether with these `values`, in this model of a record that has a sample every `step` seconds, it only tells
    /// what happened between the samples that were kept: how the record was made, too.
    fn is_between_samples(&self, _values: &[f64], _model: &Model, _step: f64) -> bool {
        false
    }

    /// Whether the effect of this id is this one with some values at 0.
    fn has_part(&self, id: EffectId) -> bool {
        self.contains().contains(&id)
    }

    /// Exchanges `values` with those of the `body` where they only have each other's roles; true if it did. Of
    /// two equal storages in series, say, the slower one is the process.
    fn order(&self, _kind: Kind, _body: &mut [f64], _values: &mut [f64]) -> bool {
        false
    }

    /// What it adds to the equation of motion of such a system: columns of a regression that may find it. Several where
    /// it may be in several places; each alone is the effect. None where the screen is not to look for it.
    fn atoms(&self, _kind: Kind) -> Vec<Atom> {
        Vec::new()
    }

    /// Puts the effect with these `values` into `model`.
    fn apply(&self, values: &[f64], model: &mut Model);
}

/// [`Effect::order`] of a lag in series with a process: the slower of the two is the process's.
pub(super) fn slower_is_the_process(kind: Kind, body: &mut [f64], values: &mut [f64]) -> bool {
    match (kind, body, values) {
        (Kind::Process, [_, slow, ..], [fast, ..]) if *fast > *slow => {
            std::mem::swap(slow, fast);
            true
        }
        _ => false,
    }
}
