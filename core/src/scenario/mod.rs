//! A relay loop in a file: plant, relay and run as TOML.
//!
//! The plant is given in one of five ways, each with `dead_time` in s beside it:
//!
//! ```toml
//! [plant]
//! numerator = [1.0]                      # highest power first
//! denominator = [1.0, 3.0, 3.0, 1.0]
//! # or: formula = "1/(s+1)^3"            # as one would write it, dead time as e^{-0.5s}
//! # or: zeros = [-1.0], poles = [-2.0, [-1.0, 3.0], [-1.0, -3.0]], gain = 4.0
//! # or: gain = 2.0, time_constant = 3.0  # K e^{-Ls}/(Ts+1), s
//! # or: a = [[0.0, 1.0], [-1.0, -2.0]], b = [0.0, 1.0], c = [1.0, 0.0]
//! dead_time = 0.0
//! [relay]
//! gain = 1.0
//! hysteresis = 0.1                       # 0 if left out, as are asymmetry, bias and delay (s)
//! [run]
//! duration = 60.0                        # s
//! step = 0.01                            # s; a two-thousandth of the duration if left out
//! initial = [0.0, 0.0, 0.0]              # state; at rest if left out
//! noise = { std_dev = 0.01, interval = 0.01, seed = 1 }  # on the output that the relay sees; none if left out
//! ```
//!
//! The relay may be an on-off controller as it is built, with one or more of:
//!
//! ```toml
//! [relay]
//! levels = [0.0, 255.0]                  # in place of gain and bias: output down and up; off is 0
//! reference = 60.0                       # what the output shall be; 0 if left out
//! dead_zone = 0.5                        # off within this of the reference: three positions
//! min_on = 60.0                          # s; shortest time up, or down where there are three positions
//! min_off = 180.0                        # s; shortest time off, or down where there are two
//! sampling = 1.0                         # s; it sees the output at these instants only
//! ```
//!
//! With `sampling_time` in s beside them, `numerator` and `denominator` are polynomials in `z`; the relay then works at
//! the plant's samples.
//!
//! With `[servo]` it is a controller of the position around a drive, without a relay; see [`crate::hunting`]:
//!
//! ```toml
//! [servo]
//! inertia = 1e-3                         # kg m^2 (or kg)
//! viscous = 1e-3                         # N m s/rad; 0 if left out
//! friction = { coulomb = 0.03, excess = 0.02, stribeck_speed = 0.5 }  # N m, N m, rad/s
//! cogging = { amplitude = 0.01, per_turn = 12.0 }
//! half_gap = 0.002                       # rad; none if left out
//! controller = { proportional = 4.0, integral = 30.0, derivative = 0.05, limit = 0.5, tracking_time = 0.1 }
//! reference = 1.0                        # rad
//! [run]
//! duration = 10.0                        # s
//! noise = { std_dev = 1e-4, interval = 0.01 }  # on the position that the controller sees; none if left out
//! ```
//!
//! `[run]` is what `hysteron simulate` runs. *Explore* shows as much of a loop as its cycle needs: of `[run]` it takes
//! the noise of a relay with two levels and the output at the start of an on-off controller, and says what it leaves
//! out.
//!
//! With `[drive]` in place of `[plant]` it is a motor and a load with play between them, under a relay on
//! the motor's velocity; see [`crate::drive`] for its parameters.

mod any;
mod error;
mod on_off;
mod plant;
mod relay;
mod relay_loop;
mod servo;

pub use any::{AnyScenario, keys_of_run};
pub use error::ScenarioError;
pub use on_off::OnOffScenario;
pub use relay_loop::Scenario;
pub use servo::ServoScenario;
