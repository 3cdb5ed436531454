//! Does the relay keep switching?

use crate::plant::TransferFunction;
use crate::relay::Relay;

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
    let unstable = |p: &num_complex::Complex<f64>| p.re > 0.0 || (p.re == 0.0 && p.im != 0.0);
    if plant.poles().iter().any(unstable) {
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
