//! Which way a relay cycle drifts, in words.

use hysteron_core::drive::{Command, Direction, DriveInput, DriveRun, Summary};

use super::units::MILLI;

/// Which way the cycle drifts, and what that means.
pub fn lesson(input: &DriveInput, run: &DriveRun, summary: &Summary) -> String {
    if let Some(time) = run.chattering {
        return format!(
            "The run was cut at {time:.3} s: there it switches or bounces without end. Some loss at impact (restitution below 1), or a delay, would end that."
        );
    }
    let Command::Relay(relay) = input.command else {
        return String::new();
    };
    let Some(cycle) = &summary.cycle else {
        return "The relay cannot keep the motor swinging: friction uses up its push.".to_owned();
    };
    let speed = match summary.drifts.first() {
        Some(drift) => drift.velocity,
        None => cycle.drift_velocity(),
    };
    let speed = (MILLI * speed).abs();
    match summary.direction(&relay) {
        Some(Direction::Against) => format!(
            "The cycle drifts at {speed:.2} mrad/s against the stronger push: friction outweighs delay. The direction reveals which effect is at work."
        ),
        Some(Direction::With) => format!(
            "The cycle drifts at {speed:.2} mrad/s with the stronger push: delay outweighs friction. The direction reveals which effect is at work."
        ),
        _ if relay.relay.asymmetry == 0.0 => {
            "The cycle stays where it is: both pushes are equal.".to_owned()
        }
        _ => "The cycle stays where it is: without friction and delay no asymmetry moves it."
            .to_owned(),
    }
}
