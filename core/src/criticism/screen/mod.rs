//! What could explain a record? Regression on its weak form, without a simulation.
//!
//! Both sides of the equation of motion, integrated over windows with a smooth bump, are linear in the body and in the atoms
//! of all effects ([`crate::effect::Atom`]). Sums of products in blocks make all subsets of a few atoms cheap; those that
//! are as good as the best on held-back blocks, and have the fewest parameters, are a class.

mod closed_loop;
mod gram;
mod input_check;
mod model;
mod prepare;
mod say;
mod signals;
mod subsets;
mod tuning;
mod window;

use crate::diagnosis::Screening;
use crate::effect::Effect;
use crate::measurement::Measurement;

/// Screens a record. Linear in its samples.
pub fn screen(measurement: &Measurement) -> Screening {
    screen_with(measurement, &[])
}

/// The same with effects of the user's own among those of the library.
pub(super) fn screen_with(measurement: &Measurement, own: &[&'static dyn Effect]) -> Screening {
    let signals = signals::Signals::new(measurement);
    let widths = window::widths(&signals);
    let prepared = prepare::Prepared::new(&signals, &widths, own);
    let bench = prepared.bench();
    let tried = bench.all();
    say::screening(measurement, &signals, &widths, &bench, &tried)
}
