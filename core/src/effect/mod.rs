//! Which physics can be added? One file per effect, one line in [`registry`].

mod actuator_lag;
mod atom;
mod backlash;
mod cogging;
mod constant_load;
mod coulomb_friction;
mod dead_zone;
mod directional_friction;
mod flattening_friction;
mod formula;
mod gain_asymmetry;
mod gravity;
mod hardening_spring;
mod id;
mod input_delay;
mod joint_compliance;
mod load_dependent_friction;
mod load_ramp;
mod nonlinear_loss;
mod outflow;
mod presliding_friction;
mod probe;
mod quadratic_drag;
mod return_spring;
mod sampled_input;
mod saturation;
mod second_lag;
mod sensor_lag;
mod spec;
mod static_curvature;
mod stribeck_friction;

pub use atom::{Atom, Extent, Moment, NO_SHAPE, Part, Series, Shape, Solved, Track};
pub use formula::{Formula, FormulaError, MAX_FORMULA, MAX_PARAMETERS};
pub use id::{EffectId, VISCOUS_FRICTION};
pub use probe::{GapLoad, Place, Rubbing, SeenGap, StepPart, Steps};
pub use probe::{Probe, ProbeInput, ProbeOutput, Regression};
pub use spec::{Dimension, Motion, ParameterSpec, Range, Scales, shown_unit};

use crate::measurement::Kind;
use crate::model::Model;

/// Inertia and viscous friction of a body, and values of an effect that go with them.
pub type BodyStart = ([f64; 2], Vec<f64>);

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
    /// only asked for if it leaves less than this `share` of the squared error: what takes long to search for need not be.
    fn starts(&self, probe: &Probe, share: f64) -> Vec<Vec<f64>>;
    /// The same for a drive without viscous friction, where that of a model without this effect may have taken its
    /// place.
    fn starts_undamped(&self, _probe: &Probe) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// The same with inertia and viscous friction of the body, where the record tells them together.
    fn starts_with_body(&self, _probe: &Probe, _share: f64) -> Vec<BodyStart> {
        Vec::new()
    }

    /// Values from which a fit may come to a lower valley, where it has stalled at these; a hidden load goes on from window
    /// to window, or is where it must be if the body moved as measured.
    fn other_valleys(&self, _values: &[f64], _goes_on: bool) -> Vec<Vec<f64>> {
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

    /// Least standard errors of these values, where the record shows a gap: a fit that has many valleys side by side knows
    /// its own only.
    fn least_errors(&self, _values: &[f64], _gap: &SeenGap) -> Vec<f64> {
        Vec::new()
    }
    /// Effects that are this one with some values at 0: it replaces them.
    fn contains(&self) -> &'static [EffectId] {
        &[]
    }

    /// Effects that it comes near to at the ends of the ranges of its values: in the place of one of these that explains the
    /// data it says no more.
    fn limits(&self) -> &'static [EffectId] {
        &[]
    }

    /// Whether it tells how the record was made and not what the machine does: it is fitted and said, but nothing is
    /// missing from the machine.
    fn is_of_record(&self) -> bool {
        false
    }

    /// Whether with these `values`, in this model of a record that has a sample every `step` seconds, it only tells what
    /// happened between the samples that were kept: how the record was made, too.
    fn is_between_samples(&self, _values: &[f64], _model: &Model, _step: f64) -> bool {
        false
    }

    /// Whether the effect of this id is this one with some values at 0.
    fn has_part(&self, id: EffectId) -> bool {
        self.contains().contains(&id)
    }

    /// Whether it is worth a try only where one of the effects that it contains comes to something: what it adds to
    /// them does not hide them.
    fn needs_its_parts(&self) -> bool {
        false
    }

    /// Exchanges `values` with those of the `body` where they only have each other's roles; true if it did. Of
    /// two equal storages in series, say, the slower one is the process.
    fn order(&self, _kind: Kind, _body: &mut [f64], _values: &mut [f64]) -> bool {
        false
    }

    /// What it adds to the equation of motion of such a system: columns of a regression that may find it. Several where it
    /// may be in several places; each alone is the effect.
    fn atoms(&self, _kind: Kind) -> Vec<Atom> {
        Vec::new()
    }

    /// Puts the effect with these `values` into `model`.
    fn apply(&self, values: &[f64], model: &mut Model);
}

/// [`Effect::order`] of a lag in series with a process: the slower of the two is the process's.
fn slower_is_the_process(kind: Kind, body: &mut [f64], values: &mut [f64]) -> bool {
    match (kind, body, values) {
        (Kind::Process, [_, slow], [fast]) if *fast > *slow => {
            std::mem::swap(slow, fast);
            true
        }
        _ => false,
    }
}

/// Every effect in the library, in the order in which equals are listed.
pub fn registry() -> &'static [&'static dyn Effect] {
    &[
        &coulomb_friction::CoulombFriction,
        &presliding_friction::PreslidingFriction,
        &stribeck_friction::StribeckFriction,
        &quadratic_drag::QuadraticDrag,
        &backlash::Backlash,
        &joint_compliance::JointCompliance,
        &input_delay::InputDelay,
        &sampled_input::SampledInput,
        &actuator_lag::ActuatorLag,
        &second_lag::SecondLag,
        &gain_asymmetry::GainAsymmetry,
        &constant_load::ConstantLoad,
        &load_ramp::LoadRamp,
        &cogging::Cogging,
        &saturation::Saturation,
        &dead_zone::DeadZone,
        &sensor_lag::SensorLag,
        &static_curvature::StaticCurvature,
    ]
}

/// Effects that only the screen looks for so far: a model may have them, a diagnosis does not try them.
fn screened_only() -> &'static [&'static dyn Effect] {
    &[
        &gravity::Gravity,
        &return_spring::ReturnSpring,
        &hardening_spring::HardeningSpring,
        &load_dependent_friction::LoadDependentFriction,
        &flattening_friction::FlatteningFriction,
        &directional_friction::DirectionalFriction,
        &nonlinear_loss::NonlinearLoss,
        &outflow::Outflow,
    ]
}

/// Every effect that the screen looks for, in the order in which equals are listed.
pub fn library() -> impl Iterator<Item = &'static dyn Effect> {
    registry().iter().chain(screened_only()).copied()
}

/// The effect with this id.
pub fn find(id: EffectId) -> Option<&'static dyn Effect> {
    library().find(|e| e.id() == id)
}

/// The name of the effect with this id on screen; that of an unknown one, such as a user's own, is its id.
pub fn name_of(id: EffectId) -> &'static str {
    find(id).map_or(id.as_str(), Effect::name)
}

/// Whether the effect with this id tells how the record was made ([`Effect::is_of_record`]).
pub fn is_of_record(id: EffectId) -> bool {
    find(id).is_some_and(Effect::is_of_record)
}

/// The effects that make sense for this kind of system.
pub fn for_kind(kind: Kind) -> impl Iterator<Item = &'static dyn Effect> {
    registry()
        .iter()
        .copied()
        .filter(move |e| e.kinds().contains(&kind))
}
