//! Does a servo hunt? A linear controller (P, PI, PID with anti-windup) on the position of a drive with dry friction,
//! cogging or play.
//!
//! [`run`] simulates it: sticking, slipping, and play taken up or not are modes with events; at rest nothing but the
//! integral moves, in closed form, and between events the motion is a Runge-Kutta solution to 1e-10 (Dormand and Prince
//! 1980). [`settled`] finds whether it comes to rest, or the cycle in which it ends and what is left of a small
//! disturbance in it. [`describing_function`] is the prediction by the first harmonic; [`view`] gives all of it for
//! drawing.

mod course;
mod cycle;
mod describing_function;
mod run;
mod runge_kutta;
mod servo;
mod view;

pub use cycle::{HuntingCycle, Settled, settled};
pub use describing_function::{HuntingBalance, describing_function, friction_gain};
pub use run::{HuntingError, HuntingRun, run};
pub use servo::{Cogging, Controller, Friction, Servo, ServoError};
pub use view::{HuntingData, view};
