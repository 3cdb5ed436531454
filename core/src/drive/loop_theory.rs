//! What the theory says of a relay loop beside its describing function: equation (3) in the paper's z-form, and play
//! before the relay.

use super::{PlayCycle, cycles_with_play, play_describing_function, relay_seen_through_play};
use crate::explore::{ExploreData, ExploreInput, compute};
use crate::limit_cycle::{Cycle, pulse_transfer_at_minus_one, z_form};
use crate::plant::TransferFunction;

/// Equation (3) beside its z-form, and what play before the relay makes of the loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopTheory {
    /// `-H_h(-1)` over the half period `h` in s; empty for an asymmetric relay.
    pub z_form: Vec<[f64; 2]>,
    /// Half period of the exact cycle in s, by equation (3), and `-H_h(-1)` there, which is `eps/k`.
    pub at_cycle: Option<[f64; 2]>,
    /// Describing function of the play from nearly no passage to nearly all: real and imaginary parts.
    pub play: Vec<[f64; 2]>,
    /// The cycles that it predicts for the loop with play, each with `N(A)` of the play.
    pub predicted: Vec<(PlayCycle, [f64; 2])>,
    /// The exact cycle with play, by the relay that does the same.
    pub with_play: Option<Cycle>,
}

/// Ratio of the amplitude to the half gap up to which the describing function of play is drawn, and its points.
const PLAY_REACH: f64 = 30.0;
const PLAY_POINTS: usize = 120;

/// What the theory says of a loop, of which `plain` is known, with play of this half gap (in the unit of the output)
/// before its relay; 0 for none.
pub fn loop_theory(input: &ExploreInput, plain: &ExploreData, half_gap: f64) -> LoopTheory {
    let (plant, relay) = (&input.plant, &input.relay);
    let space = plant.state_space();
    let lag = plant.dead_time + relay.delay;
    let symmetric = relay.is_symmetric();
    let half_period = plain.exact.filter(|_| symmetric).map(|c| 0.5 * c.period);
    let at_cycle =
        half_period.and_then(|h| Some([h, -pulse_transfer_at_minus_one(&space, lag, h)?]));
    let seen = relay_seen_through_play(relay, half_gap);
    let nothing = TransferFunction::new(&[1.0], &[1.0], 0.0);
    let play = |amplitude: f64| play_describing_function(amplitude, half_gap).map(|n| [n.re, n.im]);
    let predicted = if symmetric && half_gap > 0.0 {
        let cycles = cycles_with_play(plant, half_gap, &nothing, relay);
        cycles.unwrap_or_default()
    } else {
        Vec::new()
    };
    let with_play = compute(&ExploreInput {
        relay: seen,
        noise: None,
        ..input.clone()
    });
    LoopTheory {
        z_form: half_period.map_or_else(Vec::new, |h| z_form(&space, lag, h)),
        at_cycle,
        play: (1..=PLAY_POINTS)
            .map(|i| libm::pow(PLAY_REACH, i as f64 / PLAY_POINTS as f64))
            .filter_map(|ratio| play(ratio * half_gap))
            .collect(),
        predicted: predicted
            .into_iter()
            .filter_map(|c| Some((c, play(c.before)?)))
            .collect(),
        with_play: with_play.ok().and_then(|d| d.exact),
    }
}
