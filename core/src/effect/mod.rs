//! Which physics can be added? One file per effect, one line in [`registry`].

mod actuator_lag;
mod atom;
mod backlash;
pub(crate) mod baseline;
mod cogging;
mod cogging_harmonics;
mod constant_load;
mod coulomb_friction;
mod dead_zone;
mod directional_friction;
mod directional_lag;
mod driven_load;
mod dry_friction;
#[allow(clippy::module_inception, reason = "the room is named after its trait")]
mod effect;
mod encoder_eccentricity;
mod end_stop;
mod flattening_friction;
mod formula;
mod gain_asymmetry;
mod gravity;
mod hardening_spring;
mod id;
mod input_delay;
mod inverse_response;
mod joint_compliance;
mod load_dependent_friction;
mod load_ramp;
mod names;
mod nonlinear_loss;
mod outflow;
mod periodic_disturbance;
mod position_friction;
mod presliding_friction;
mod probe;
mod quadratic_drag;
mod rate_limit;
mod return_spring;
mod sampled_input;
mod saturation;
mod second_lag;
mod sensor_lag;
mod spec;
mod static_curvature;
mod stribeck_friction;
mod torque_ripple;
mod underdamped;
mod valve_stiction;

pub use atom::{
    Atom, BodyStart, Extent, Moment, NO_SHAPE, Own, Part, Series, Shape, Solved, Track,
};
pub use effect::Effect;
pub use formula::{Formula, FormulaError, MAX_FORMULA, MAX_PARAMETERS};
pub(crate) use formula::{Variable, variables};
pub use id::{EffectId, VISCOUS_FRICTION};
pub use names::{find, for_kind, is_of_record, name_of};
pub use probe::{GapLoad, Place, Rubbing, SeenGap, StepPart, Steps};
pub use probe::{Probe, ProbeInput, ProbeOutput, Regression};
pub use spec::{Dimension, ParameterSpec, Range, Scales};

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
        &gravity::Gravity,
        &return_spring::ReturnSpring,
        &hardening_spring::HardeningSpring,
        &load_dependent_friction::LoadDependentFriction,
        &flattening_friction::FlatteningFriction,
        &underdamped::Underdamped,
        &outflow::Outflow,
        &end_stop::EndStop,
        &position_friction::PositionFriction,
        &cogging_harmonics::CoggingHarmonics,
        &torque_ripple::TorqueRipple,
        &encoder_eccentricity::EncoderEccentricity,
        &rate_limit::RateLimit,
        &periodic_disturbance::PeriodicDisturbance,
        &inverse_response::InverseResponse,
        &directional_lag::DirectionalLag,
        &valve_stiction::ValveStiction,
    ]
}

/// Effects that only the screen looks for, since a diagnosis has them under another name: in motion, friction that
/// differs by direction is dry friction with a constant load, and a loss that grows is a static curvature of the
/// balance.
fn screened_only() -> &'static [&'static dyn Effect] {
    &[
        &directional_friction::DirectionalFriction,
        &nonlinear_loss::NonlinearLoss,
    ]
}

/// Whether few machines have the effect with this id, or its curve can stand in for much else: it is tried last, where
/// all others leave more than noise, and named only where it leaves little.
pub fn is_seldom(id: EffectId) -> bool {
    [
        rate_limit::ID,
        end_stop::ID,
        cogging_harmonics::ID,
        position_friction::ID,
        torque_ripple::ID,
        encoder_eccentricity::ID,
        periodic_disturbance::ID,
        inverse_response::ID,
        directional_lag::ID,
        valve_stiction::ID,
    ]
    .contains(&id)
}

/// Every effect, in the order in which equals are listed: the screen looks for those that have atoms.
pub fn library() -> impl Iterator<Item = &'static dyn Effect> {
    registry().iter().chain(screened_only()).copied()
}
