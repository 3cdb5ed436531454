//! What is said of a servo.

use hysteron_core::hunting::{HuntingBalance, HuntingCycle, HuntingData, Servo};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::uncertain::brief;

use super::super::cycle_table::difference;

/// An error at rest below this share of the way is none.
const NO_ERROR: f64 = 1e-4;

/// Share of the period for which the motor must stick for its sticking to be the reason.
const STICKS: f64 = 0.02;

/// What becomes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Hunts,
    HuntsWithoutPattern,
    Settles,
    StopsShort,
    RunsAway,
}

impl Verdict {
    /// Its name in tests and lessons.
    pub fn id(self) -> &'static str {
        match self {
            Self::Hunts => "hunts",
            Self::HuntsWithoutPattern => "no_pattern",
            Self::Settles => "settles",
            Self::StopsShort => "stops_short",
            Self::RunsAway => "runs_away",
        }
    }
}

/// The cycle, exact if it is known.
pub fn cycle(data: &HuntingData) -> Option<&HuntingCycle> {
    data.exact.as_ref().or(data.simulated.as_ref())
}

/// The first stable balance.
pub fn balance(data: &HuntingData) -> Option<&HuntingBalance> {
    let all = &data.describing_function;
    all.iter().find(|b| b.stable == Some(true))
}

pub fn verdict(servo: &Servo, data: &HuntingData) -> Verdict {
    let way = servo.reference.abs().max(servo.half_gap);
    match data.error_at_rest {
        _ if data.unbounded => Verdict::RunsAway,
        Some(error) if error.abs() > NO_ERROR * way => Verdict::StopsShort,
        Some(_) => Verdict::Settles,
        None if cycle(data).is_some() => Verdict::Hunts,
        None => Verdict::HuntsWithoutPattern,
    }
}

/// Frequency in Hz and amplitude in degrees, as they are read.
fn swing(period: f64, amplitude: f64) -> [String; 2] {
    [1.0 / period, amplitude.to_degrees()].map(brief)
}

/// The answer.
pub fn answer(servo: &Servo, data: &HuntingData) -> Message {
    match (verdict(servo, data), cycle(data)) {
        (Verdict::Hunts, Some(cycle)) => {
            let [frequency, amplitude] = swing(cycle.period, cycle.amplitude);
            msg!("It hunts: {} Hz, ±{}°.", frequency, amplitude)
        }
        (Verdict::StopsShort, _) => {
            let error = brief(data.error_at_rest.unwrap_or(0.0).abs().to_degrees());
            msg!("It settles, {}° from where it should be.", error)
        }
        (Verdict::Settles, _) => "It settles where it should be.".into(),
        (Verdict::RunsAway, _) => "It runs away: the loop is unstable.".into(),
        (Verdict::Hunts | Verdict::HuntsWithoutPattern, _) => {
            "It hunts, in a pattern that does not repeat.".into()
        }
    }
}

/// What the answer rests on, sentence by sentence.
pub fn reasons(servo: &Servo, data: &HuntingData) -> Vec<Message> {
    let cause = cause(servo, data);
    let lasts = data.exact.as_ref().and_then(lasting);
    [cause, lasts, first_harmonic(servo, data)]
        .into_iter()
        .flatten()
        .collect()
}

fn cause(servo: &Servo, data: &HuntingData) -> Option<Message> {
    let integral = servo.controller.integral > 0.0;
    match verdict(servo, data) {
        Verdict::Hunts => {
            let stuck = cycle(data).map_or(0.0, |c| c.stuck);
            if stuck > STICKS && integral {
                return Some(msg!(
                    "The motor sticks for {} % of the time. Meanwhile the integral grows until the motor breaks \
                     away, and since friction is lower in motion, it overshoots.",
                    fixed(100.0 * stuck, 0)
                ));
            }
            (servo.half_gap > 0.0).then(|| {
                "While the motor crosses the play, what is measured stands still: the controller acts late.".into()
            })
        }
        Verdict::StopsShort => Some(
            "Dry friction holds it there: the controller asks for less than it takes to break away.".into(),
        ),
        Verdict::Settles if integral => Some("The integral has removed the error.".into()),
        _ => None,
    }
}

/// Whether the cycle lasts.
fn lasting(cycle: &HuntingCycle) -> Option<Message> {
    let percent = hysteron_core::explore::percent(cycle.multiplier?);
    Some(if cycle.stable? {
        msg!(
            "The hunting is stable: a small disturbance shrinks to {} in one period.",
            percent
        )
    } else {
        msg!(
            "The cycle is unstable: a small disturbance grows to {} in one period.",
            percent
        )
    })
}

/// What the describing function says beside it.
fn first_harmonic(servo: &Servo, data: &HuntingData) -> Option<Message> {
    let hunts = match verdict(servo, data) {
        Verdict::RunsAway => return None,
        Verdict::Hunts | Verdict::HuntsWithoutPattern => true,
        Verdict::Settles | Verdict::StopsShort => false,
    };
    Some(match (balance(data), cycle(data)) {
        (None, _) if hunts => {
            "The describing function sees no oscillation: it takes the motion for a sine, which never sticks."
                .into()
        }
        (None, _) => "The describing function sees no oscillation either.".into(),
        (Some(found), Some(cycle)) => {
            let [frequency, amplitude] = swing(found.period, found.amplitude);
            msg!(
                "The describing function predicts {} Hz ({}) and ±{}° ({}).",
                frequency,
                difference(cycle.period, found.period),
                amplitude,
                difference(found.amplitude, cycle.amplitude)
            )
        }
        (Some(found), None) => {
            let [frequency, amplitude] = swing(found.period, found.amplitude);
            msg!("The describing function predicts hunting at {} Hz and ±{}°.", frequency, amplitude)
        }
    })
}
