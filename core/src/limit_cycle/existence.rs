//! Does the relay keep switching?

use crate::plant::TransferFunction;
use crate::relay::Relay;

/// A pole counts as on the imaginary axis below this share of the largest: what the roots of a polynomial with a double
/// root are good to.
pub(super) const ON_AXIS: f64 = 1e-7;

/// Where the output would go if the relay stopped switching, and what that means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Existence {
    /// Output in the end with `h = +1` held and with `h = -1` held; infinite with an integrator.
    pub equilibria: [f64; 2],
    /// Each lies beyond the opposite threshold, `k (-C A^{-1} B) > eps`: the relay cannot rest, whatever
    /// the start. Where it does not hold the loop can come to rest; a cycle may exist beside that.
    pub holds: bool,
}

/// The condition for a relay that never comes to rest. For plants with all poles in the left half
/// plane or at 0; an unstable one has no such equilibria, and `None` is said.
pub fn existence(plant: &TransferFunction, relay: &Relay) -> Option<Existence> {
    if plant.validate().is_err() || relay.validate().is_err() {
        return None;
    }
    let poles = plant.poles();
    let axis = ON_AXIS * poles.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let unstable = |p: &num_complex::Complex<f64>| p.re > axis || (p.re > -axis && p.im != 0.0);
    if poles.iter().any(unstable) {
        return None;
    }
    let gain = plant.dc_gain();
    let at = |high: bool| {
        let u = relay.output(high);
        if u == 0.0 { 0.0 } else { gain * u }
    };
    let equilibria = [at(true), at(false)];
    // At its own threshold an ideal relay could rest, but not beyond it.
    let holds = equilibria[0] < -relay.hysteresis && equilibria[1] > relay.hysteresis;
    Some(Existence { equilibria, holds })
}
