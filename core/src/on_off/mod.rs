//! What does an on-off controller do as it is built? A dead zone between heating and cooling, minimum on and off times,
//! a sampling time; around a plant in continuous time, or in discrete time.
//!
//! [`run`] simulates it, from event to event by exact flows; [`settled`] finds the cycle in which it ends, its switches
//! to round-off, and whether it is stable; [`describing_function`] predicts it by the first harmonic; [`view`] gives
//! all of it for drawing.

mod course;
mod cycle;
mod describing_function;
mod discrete;
mod pattern;
mod plant;
mod relay;
mod run;
mod simulation;
mod stability;
mod view;

pub use cycle::{OnOffCycle, Settled, settled};
pub use describing_function::{Balance, describing_function};
pub use discrete::DiscretePlant;
pub use plant::OnOffPlant;
pub use relay::{OnOffRelay, Position};
pub use run::{Cause, OnOffLoop, OnOffRun, Switch};
pub use simulation::run;
pub use view::{GivenPlant, OnOffData, OnOffInput, view};
