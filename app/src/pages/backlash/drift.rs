//! Which way a relay cycle drifts, in words.

use hysteron_core::drive::{Command, Direction, DriveInput, DriveRun, Summary};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;

use super::units::MILLI;

/// Which way the cycle drifts, and what that means.
pub fn lesson(input: &DriveInput, run: &DriveRun, summary: &Summary) -> Message {
    if let Some(time) = run.chattering {
        return msg!(
            "The run was stopped at {} s, where it switches or bounces without end. Some loss at impact (restitution \
             below 1) or a delay would prevent that.",
            fixed(time, 3)
        );
    }
    let Command::Relay(relay) = input.command else {
        return Message::default();
    };
    let Some(cycle) = &summary.cycle else {
        return "The relay cannot keep the motor swinging: friction uses up its push.".into();
    };
    let speed = match summary.drifts.first() {
        Some(drift) => drift.velocity,
        None => cycle.drift_velocity(),
    };
    let speed = (MILLI * speed).abs();
    match summary.direction(&relay) {
        Some(Direction::Against) => msg!(
            "The cycle drifts at {} mrad/s against the stronger push: friction outweighs delay. The direction \
             reveals which effect is at work.",
            fixed(speed, 2)
        ),
        Some(Direction::With) => msg!(
            "The cycle drifts at {} mrad/s with the stronger push: delay outweighs friction. The direction reveals \
             which effect is at work.",
            fixed(speed, 2)
        ),
        _ if relay.relay.asymmetry == 0.0 => {
            "The cycle stays where it is: both pushes are equal.".into()
        }
        _ => {
            "The cycle stays where it is: without friction and delay no asymmetry moves it.".into()
        }
    }
}
