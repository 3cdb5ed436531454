//! Play in a relay loop: its describing function, and the limit cycle that it predicts.
//!
//! The loop is relay, plant, play, and perhaps a second plant behind the play, whose output the relay
//! sees. The play is friction-controlled: its output stays where it was until the input has crossed the
//! gap, and then follows at a distance of `beta`.

use std::cmp::Ordering;
use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::{DriveError, check};
use crate::plant::TransferFunction;
use crate::relay::Relay;
use crate::root::bisect;

/// Describing function of play with half gap `beta` for a sine of `amplitude > beta`:
///
/// ```text
/// N(A) = 1/pi [pi/2 + asin s + s sqrt(1 - s^2)] - j (1 - s^2)/pi,    s = 1 - 2 beta/A
/// ```
///
/// (Gelb and Vander Velde 1968.) `None` where the amplitude does not exceed `beta`: nothing passes.
pub fn play_describing_function(amplitude: f64, half_gap: f64) -> Option<Complex<f64>> {
    if !(half_gap >= 0.0 && amplitude > half_gap && amplitude.is_finite()) {
        return None;
    }
    let s = 1.0 - 2.0 * half_gap / amplitude;
    let root = (1.0 - s * s).max(0.0);
    Some(Complex::new(
        (0.5 * PI + libm::asin(s) + s * root.sqrt()) / PI,
        -root / PI,
    ))
}

/// A limit cycle that harmonic balance predicts for a loop with relay and play.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlayCycle {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Period, s.
    pub period: f64,
    /// Amplitude before the play.
    pub before: f64,
    /// Amplitude at the relay.
    pub at_relay: f64,
}

/// Points of the scan in a decade, and its decades around the plant's own frequency.
const SCAN: i32 = 400;
const DECADES: i32 = 4;

/// Limit cycles of a relay that sees `plant` through play of half gap `half_gap` and then `behind`, by
/// rising frequency: solutions of `N_relay(A2) P1(jw) N_play(A1) P2(jw) = -1`.
///
/// The first harmonic of the relay's output has the amplitude `4k/pi` whatever it sees, so that
/// `A1 = 4k/pi |P1(jw)|` and `A2 = A1 |N_play P2(jw)|` follow from the frequency, and the phase alone is
/// left to be solved for. For a symmetric relay.
///
/// # Errors
/// A half gap that is negative or no number, or a relay out of range.
pub fn cycles_with_play(
    plant: &TransferFunction,
    half_gap: f64,
    behind: &TransferFunction,
    relay: &Relay,
) -> Result<Vec<PlayCycle>, DriveError> {
    relay.validate()?;
    check("half gap", half_gap, half_gap >= 0.0, "0 or more")?;
    let loop_ = PlayLoop {
        plant,
        half_gap,
        behind,
        relay,
    };
    let centre = crate::limit_cycle::typical_frequency(plant);
    let omega = |i: i32| centre * libm::pow(10_f64, f64::from(i) / f64::from(SCAN));
    let mut found = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for i in -DECADES * SCAN..=DECADES * SCAN {
        let here = omega(i);
        let next = loop_.phase(here).map(|(phase, _)| (here, phase));
        if let (Some(a), Some(b)) = (last, next) {
            // The phase is known up to whole turns: a jump by one is no crossing.
            let crosses = (a.1 < 0.0) != (b.1 < 0.0) && (a.1 - b.1).abs() < PI;
            if crosses && let Some(cycle) = loop_.solve(a, b) {
                found.push(cycle);
            }
        }
        last = next;
    }
    Ok(found)
}

struct PlayLoop<'a> {
    plant: &'a TransferFunction,
    half_gap: f64,
    behind: &'a TransferFunction,
    relay: &'a Relay,
}

impl PlayLoop<'_> {
    /// Phase of `-N_relay P1 N_play P2`, -pi to pi, with the cycle that it would be; `None` where the
    /// oscillation does not reach through the play or to the relay's thresholds.
    fn phase(&self, omega: f64) -> Option<(f64, PlayCycle)> {
        let first = self.plant.response(omega);
        let before = 4.0 * self.relay.gain / PI * first.norm();
        let through =
            play_describing_function(before, self.half_gap)? * self.behind.response(omega);
        let at_relay = before * through.norm();
        let eps = self.relay.hysteresis;
        if !(at_relay >= eps && at_relay.is_finite() && at_relay > 0.0) {
            return None;
        }
        let share = eps / at_relay;
        let relay = Complex::new((1.0 - share * share).sqrt(), -share)
            * Complex::from_polar(1.0, -omega * self.relay.delay);
        let phase = (-(first * through * relay)).arg();
        let cycle = PlayCycle {
            omega,
            period: 2.0 * PI / omega,
            before,
            at_relay,
        };
        phase.is_finite().then_some((phase, cycle))
    }

    fn solve(&self, low: (f64, f64), high: (f64, f64)) -> Option<PlayCycle> {
        let omega = bisect(low.0, high.0, |omega| match self.phase(omega) {
            Some((phase, _)) if (phase < 0.0) == (low.1 < 0.0) => Ordering::Less,
            _ => Ordering::Greater,
        });
        self.phase(omega).map(|(_, cycle)| cycle)
    }
}

/// The relay that does the same without the play, where the relay sees the play's output itself: play
/// before a relay adds its half gap to the hysteresis. Exact for any oscillation that reaches both of its
/// thresholds, so that the exact limit cycle of a loop with play is that of this relay.
#[must_use]
pub fn relay_seen_through_play(relay: &Relay, half_gap: f64) -> Relay {
    Relay {
        hysteresis: relay.hysteresis + half_gap,
        ..*relay
    }
}
