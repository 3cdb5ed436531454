//! What is on its way to the plant.

use crate::relay::Relay;
use crate::simulate::Change;

/// Periods for which a delay may reach back.
const MAX_PERIODS_BACK: f64 = 200.0;

/// What is on its way to the plant when the relay has just risen.
pub(super) struct History {
    /// Acting input.
    pub input: f64,
    /// Its changes to come that were decided already, in order.
    pub pending: Vec<Change>,
}

impl History {
    pub fn new(relay: &Relay, durations: [f64; 2], lag: f64) -> Option<Self> {
        let period = durations[0] + durations[1];
        if !(period > 0.0 && lag <= MAX_PERIODS_BACK * period) {
            return None;
        }
        let mut pending = Vec::new();
        let (mut time, mut high) = (lag, true);
        // A change at this very instant has come.
        while time > 1e-14 * period {
            pending.push(Change {
                time,
                channel: 0,
                value: relay.output(high),
            });
            time -= if high { durations[1] } else { durations[0] };
            high = !high;
        }
        pending.reverse();
        Some(Self {
            input: relay.output(high),
            pending,
        })
    }
}
