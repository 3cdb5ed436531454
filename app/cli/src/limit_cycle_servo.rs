//! `hysteron limit-cycle` on a servo: does it hunt?

use std::fmt::Write as _;

use hysteron_core::hunting::{HuntingBalance, HuntingCycle, Settled, describing_function, settled};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::scenario::ServoScenario;
use hysteron_core::simulate::Noise;
use hysteron_work::language::say;
use serde_json::{Value, json};

use crate::cycle_table::CycleTable;
use crate::output::{off_by, without_noise};

/// Version of the JSON object.
const SCHEMA: u32 = 1;

/// What is predicted and simulated, of the measured position.
pub struct ServoReport {
    describing_function: Vec<HuntingBalance>,
    settled: Settled,
    noise: Option<Noise>,
}

impl ServoReport {
    pub fn new(scenario: &ServoScenario) -> Result<Self, Message> {
        let servo = &scenario.servo;
        Ok(Self {
            settled: settled(servo).map_err(|e| msg!("[servo]: {}", e))?,
            describing_function: describing_function(servo),
            noise: scenario.noise,
        })
    }

    fn sentences(&self) -> Message {
        let stable = |b: &&HuntingBalance| b.stable == Some(true);
        let beside = if self.describing_function.is_empty() {
            "The describing function sees no oscillation.".into()
        } else {
            let found = self.describing_function.iter().find(stable);
            found
                .zip(self.settled.exact.as_ref())
                .map_or_else(Message::default, |(b, c)| {
                    off_by([b.period, b.amplitude], [c.period, c.amplitude])
                })
        };
        let text = self.settled.text.clone().and(beside);
        text.and(without_noise(self.noise))
    }

    pub fn json(&self) -> Value {
        let describing: Vec<Value> = self
            .describing_function
            .iter()
            .map(|b| {
                json!({"omega": b.omega, "period": b.period, "amplitude": b.amplitude,
                       "motor_amplitude": b.motor_amplitude, "stable": b.stable})
            })
            .collect();
        let exact: Vec<Value> = self.settled.exact.iter().map(cycle).collect();
        let s = &self.settled;
        let outcome = match (s.error_at_rest, s.unbounded, &s.simulated) {
            (Some(_), ..) => "rest",
            (None, true, _) => "unbounded",
            (None, false, Some(_)) => "limit_cycle",
            (None, false, None) => "long_pattern",
        };
        json!({
            "schema": SCHEMA,
            "outcome": outcome,
            "describing_function": describing,
            "exact": exact,
            "simulated": s.simulated.as_ref().map(cycle),
            "ultimate": null,
            "exists": s.error_at_rest.is_none() && !s.unbounded,
            "error_at_rest": s.error_at_rest,
            "text": self.sentences(),
        })
    }

    pub fn text(&self) -> String {
        let mut out = format!("{}\n", say(self.sentences()));
        let mut table = CycleTable::default();
        for b in &self.describing_function {
            table.row("describing function", b.period, b.amplitude, b.stable);
        }
        let found = [
            ("exact", &self.settled.exact),
            ("simulated", &self.settled.simulated),
        ];
        for (name, cycle) in found {
            if let Some(c) = cycle {
                table.row(name, c.period, c.amplitude, c.stable);
            }
        }
        if let Some(table) = table.text() {
            let _ = write!(out, "\n{table}");
        }
        out
    }
}

fn cycle(cycle: &HuntingCycle) -> Value {
    json!({"period": cycle.period, "amplitude": cycle.amplitude, "motor_amplitude": cycle.motor_amplitude,
           "range": cycle.range, "stuck": cycle.stuck, "stable": cycle.stable, "multiplier": cycle.multiplier})
}
