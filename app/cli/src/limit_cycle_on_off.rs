//! `hysteron limit-cycle` on an on-off controller as it is built.

use std::fmt::Write as _;

use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::on_off::{Balance, OnOffCycle, Settled, describing_function, settled};
use hysteron_core::scenario::OnOffScenario;
use hysteron_core::simulate::Noise;
use hysteron_work::language::say;
use serde_json::{Value, json};

use crate::cycle_table::CycleTable;
use crate::output::{off_by, without_noise};

/// Version of the JSON object.
const SCHEMA: u32 = 1;

/// What is predicted and simulated.
pub struct OnOffReport {
    /// `None` where the first harmonic does not tell.
    describing_function: Option<Vec<Balance>>,
    settled: Settled,
    /// Whether there are shortest times to keep.
    holds: bool,
    noise: Option<Noise>,
}

impl OnOffReport {
    pub fn new(scenario: &OnOffScenario) -> Result<Self, Message> {
        let on_off = &scenario.on_off;
        Ok(Self {
            settled: settled(on_off).map_err(Message::from)?,
            describing_function: describing_function(on_off),
            holds: on_off.relay.min_on.max(on_off.relay.min_off) > 0.0,
            noise: scenario.noise,
        })
    }

    /// What is said, with a word where the describing function says nothing.
    fn sentences(&self) -> Message {
        let exact = self.settled.exact.as_ref();
        let stable = |b: &&Balance| b.stable == Some(true);
        let beside = match &self.describing_function {
            None => {
                "The describing function is not given: with three positions it is known only for outputs of equal \
                 strength in both directions and a reference of 0."
                    .into()
            }
            Some(all) if all.is_empty() && self.holds => {
                "The describing function sees no oscillation that keeps the shortest times.".into()
            }
            Some(all) if all.is_empty() => {
                "The describing function sees no oscillation.".into()
            }
            Some(all) => all
                .iter()
                .find(stable)
                .zip(exact)
                .map_or_else(Message::default, |(b, c)| {
                    off_by([b.period, b.amplitude], [c.period, c.amplitude])
                }),
        };
        let text = self.settled.text.clone().and(beside);
        text.and(without_noise(self.noise))
    }

    pub fn json(&self) -> Value {
        let describing: Vec<Value> = self
            .describing_function
            .iter()
            .flatten()
            .map(|b| {
                json!({"omega": b.omega, "period": b.period, "amplitude": b.amplitude, "stable": b.stable})
            })
            .collect();
        let exact: Vec<Value> = self.settled.exact.iter().map(cycle).collect();
        let outcome = if self.settled.rests.is_some() {
            "rest"
        } else if self.settled.simulated.is_some() {
            "limit_cycle"
        } else {
            "long_pattern"
        };
        json!({
            "schema": SCHEMA,
            "outcome": outcome,
            "describing_function": describing,
            "exact": exact,
            "simulated": self.settled.simulated.as_ref().map(cycle),
            "ultimate": null,
            "exists": self.settled.rests.is_none(),
            "text": self.sentences(),
        })
    }

    pub fn text(&self) -> String {
        let mut out = format!("{}\n", say(self.sentences()));
        let mut table = CycleTable::default();
        for b in self.describing_function.iter().flatten() {
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
        let shown = self
            .settled
            .exact
            .as_ref()
            .or(self.settled.simulated.as_ref());
        if let Some(cycle) = shown {
            let parts = cycle.positions.iter();
            let parts = parts.map(|(position, time)| position.lasting(format!("{time:.6} s")));
            let parts = msg!("In each period: {}.", Message::list(", ", parts));
            let _ = writeln!(out, "{}", say(&parts));
        }
        out
    }
}

fn cycle(cycle: &OnOffCycle) -> Value {
    let durations: Vec<f64> = cycle.positions.iter().map(|p| p.1).collect();
    let positions: Vec<&str> = cycle.positions.iter().map(|p| p.0.name()).collect();
    json!({"period": cycle.period, "amplitude": cycle.amplitude, "half_periods": durations, "positions": positions,
           "range": cycle.range, "stable": cycle.stable, "multiplier": cycle.multiplier})
}
