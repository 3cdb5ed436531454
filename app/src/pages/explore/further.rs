//! What is computed for the two plots at the end of the page.

use hysteron_core::drive::{PlayCycle, cycles_with_play, relay_seen_through_play};
use hysteron_core::explore::{ExploreData, ExploreInput};
use hysteron_core::limit_cycle::{Cycle, exact_symmetric, pulse_transfer_at_minus_one, z_form};
use hysteron_core::plant::TransferFunction;

/// Equation (3) in the z-form.
pub struct ZForm {
    /// `-H_h(-1)` over the half period in s.
    pub curve: Vec<[f64; 2]>,
    /// The same at the exact half period, s.
    pub exact: Option<[f64; 2]>,
    /// `eps/k`.
    pub level: f64,
}

impl ZForm {
    /// Of a symmetric relay with a cycle, exact or predicted; the equation has no other.
    pub fn new(input: &ExploreInput, data: &ExploreData) -> Option<Self> {
        let relay = &input.relay;
        if !relay.is_symmetric() {
            return None;
        }
        let exact = data.exact.map(|c| 0.5 * c.period);
        let guess = exact.or(data.describing().map(|i| 0.5 * i.cycle.period))?;
        let space = input.plant.state_space();
        let lag = input.plant.dead_time + relay.delay;
        Some(Self {
            curve: z_form(&space, lag, guess),
            exact: exact.and_then(|h| Some([h, -pulse_transfer_at_minus_one(&space, lag, h)?])),
            level: relay.hysteresis / relay.gain,
        })
    }
}

/// Cycles of the loop with play between plant and relay.
pub struct WithPlay {
    /// By the describing functions of relay and play.
    pub balanced: Vec<PlayCycle>,
    /// Exactly: play before a relay adds its half gap to the hysteresis.
    pub exact: Option<Cycle>,
}

impl WithPlay {
    /// Of a symmetric relay that sees the plant through play of this half gap, in the unit of the output.
    pub fn new(input: &ExploreInput, half_gap: f64) -> Option<Self> {
        if !input.relay.is_symmetric() {
            return None;
        }
        let direct = TransferFunction::new(&[1.0], &[1.0], 0.0);
        let balanced = cycles_with_play(&input.plant, half_gap, &direct, &input.relay).ok()?;
        let seen = relay_seen_through_play(&input.relay, half_gap);
        let guess = balanced.first().map(|c| 0.5 * c.period);
        let lag = input.plant.dead_time + input.relay.delay;
        let space = input.plant.state_space();
        let exact = guess.and_then(|guess| exact_symmetric(&space, &seen, lag, guess));
        Some(Self { balanced, exact })
    }
}
