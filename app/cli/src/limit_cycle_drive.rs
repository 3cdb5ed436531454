//! `hysteron limit-cycle` on a drive: the motor's cycle inside the gap.

use hysteron_core::drive::{
    Command, Direction, DriftingCycle, DriveInput, EventKind, drifting_cycle, run, summarize,
};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::uncertain::digits;
use serde_json::json;

/// Version of the JSON object.
const SCHEMA: u32 = 1;

/// Digits of a length or velocity that is said.
const DIGITS: i32 = 7;

/// What is predicted and simulated, of the motor's velocity.
pub struct DriveReport {
    cycle: Option<DriftingCycle>,
    /// Period and amplitude of the last simulated cycle, wherever the motor is then.
    simulated: Option<(f64, f64)>,
    direction: Option<Direction>,
    gap: f64,
}

impl DriveReport {
    pub fn new(input: &DriveInput) -> Result<Self, Message> {
        let Command::Relay(relay) = input.command else {
            return Err("a drive under a constant torque has no limit cycle".into());
        };
        let done = run(input).map_err(Message::from)?;
        let ups: Vec<_> = done
            .events
            .iter()
            .filter(|e| e.kind == EventKind::SwitchUp)
            .collect();
        let simulated = match ups.as_slice() {
            [.., from, to] if done.chattering.is_none() => {
                let within = done
                    .events
                    .iter()
                    .filter(|e| e.time >= from.time && e.time <= to.time);
                let [low, high] = within
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], e| {
                        [low.min(e.v1), high.max(e.v1)]
                    });
                Some((to.time - from.time, 0.5 * (high - low)))
            }
            _ => None,
        };
        Ok(Self {
            cycle: drifting_cycle(&input.drive.motor, &relay),
            simulated,
            direction: summarize(input, &done).direction(&relay),
            gap: 2.0 * input.drive.half_gap,
        })
    }

    pub fn json(&self) -> serde_json::Value {
        let exact: Vec<_> = self
            .cycle
            .iter()
            .map(|c| {
                let down = c.points[3].time;
                json!({"period": c.period, "amplitude": amplitude(c), "half_periods": [down, c.period - down],
                       "range": [c.trough, c.peak], "stable": true, "swing": c.swing,
                       "drift": c.drift, "drift_velocity": c.drift_velocity()})
            })
            .collect();
        json!({
            "schema": SCHEMA,
            "describing_function": [],
            "exact": exact,
            "simulated": self.simulated.map(|(period, amplitude)| json!({"period": period, "amplitude": amplitude})),
            "ultimate": null,
            "exists": self.cycle.is_some(),
            "text": format!("{}\n", Message::list("\n", self.lines())),
        })
    }

    pub fn lines(&self) -> Vec<Message> {
        let Some(cycle) = &self.cycle else {
            return vec![
                "The relay cannot keep the motor swinging: there is no cycle, and no amplitude (half of peak to peak)."
                    .into(),
            ];
        };
        let mut lines = vec![msg!(
            "In the gap the motor's velocity oscillates: period {} s, amplitude {} rad/s or m/s (half of peak to \
             peak).",
            fixed(cycle.period, 9),
            fixed(amplitude(cycle), 9)
        )];
        let (swing, share) = (
            digits(cycle.swing, DIGITS),
            fixed(100.0 * cycle.swing / self.gap, 1),
        );
        let [drift, velocity] = [cycle.drift, cycle.drift_velocity()].map(|v| digits(v, DIGITS));
        lines.push(match self.direction {
            Some(Direction::Against) => msg!(
                "It swings over {} rad or m, {} % of the gap, and drifts by {} a period, {} a second, against the \
                 stronger push: friction outweighs delay.", swing, share, drift, velocity),
            Some(Direction::With) => msg!(
                "It swings over {} rad or m, {} % of the gap, and drifts by {} a period, {} a second, with the \
                 stronger push: delay outweighs friction.", swing, share, drift, velocity),
            _ => msg!(
                "It swings over {} rad or m, {} % of the gap, and drifts by {} a period, {} a second.",
                swing,
                share,
                drift,
                velocity
            ),
        });
        if let Some((period, amplitude)) = self.simulated {
            lines.push(msg!(
                "Simulated, at the end of the run: period {} s, amplitude {}.",
                fixed(period, 9),
                fixed(amplitude, 9)
            ));
        }
        lines
    }
}

fn amplitude(cycle: &DriftingCycle) -> f64 {
    0.5 * (cycle.peak - cycle.trough)
}
