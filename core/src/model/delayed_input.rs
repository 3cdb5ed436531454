//! The held input as it acts on a body: mapped, and shifted by a dead time.

use super::actuator::Remembering;
use super::excitation::Excitation;
use super::{Engine, Model};

/// The held input shifted by a dead time, as pieces of constant value in each sampling interval.
pub(super) struct DelayedInput<'a> {
    pub excitation: &'a Excitation,
    pub model: &'a Model,
    /// What acts before the record starts.
    pub before: f64,
    /// What an actuator that remembers gives after each sample.
    given: Option<Vec<f64>>,
    delay: f64,
    /// For equal steps: whole samples and the rest of the dead time.
    whole: usize,
    rest: f64,
    /// For unequal steps: first sample whose delayed value may still act.
    pointer: usize,
}

/// What a sample tells the actuator.
fn command(excitation: &Excitation, model: &Model, sample: usize) -> f64 {
    let input = &excitation.input;
    let next = input.get(sample + 1).unwrap_or(&input[sample]);
    let acting = input[sample] + model.next_input * (next - input[sample]);
    model.map_input(acting)
}

impl<'a> DelayedInput<'a> {
    pub fn new(excitation: &'a Excitation, model: &'a Model) -> Self {
        let delay = model.delay.max(0.0);
        let (mut whole, mut rest) = (0, 0.0);
        if let Some(step) = excitation.step {
            let samples = (delay / step).min(excitation.len() as f64);
            whole = samples.floor() as usize;
            rest = (samples - samples.floor()) * step;
            // A rest of round-off size is no piece of its own.
            if rest < 1e-9 * step {
                rest = 0.0;
            } else if step - rest < 1e-9 * step {
                whole += 1;
                rest = 0.0;
            }
        }
        let before = model.map_input(excitation.before);
        let given = model.actuator.map(|actuator| {
            let mut actuator = Remembering::new(actuator, before);
            let last = excitation.len() - 1;
            let commands = (0..last).map(|i| (i, excitation.step_after(i)));
            let mut given: Vec<f64> = commands
                .map(|(i, h)| actuator.after(command(excitation, model, i), h))
                .collect();
            given.push(command(excitation, model, last));
            given
        });
        Self {
            excitation,
            model,
            before,
            given,
            delay,
            whole,
            rest,
            pointer: 0,
        }
    }

    pub fn prepare(&self, engine: &mut Engine) {
        if let Some(step) = self.excitation.step {
            engine.prepare(step);
            if self.rest > 0.0 {
                engine.prepare(self.rest);
                engine.prepare(step - self.rest);
            }
        }
    }

    fn value(&self, sample: Option<usize>) -> f64 {
        sample.map_or(self.before, |i| {
            self.given
                .as_ref()
                .map_or_else(|| command(self.excitation, self.model, i), |given| given[i])
        })
    }

    /// Calls `go(value, duration)` for each piece between samples `i` and `i + 1`.
    pub fn pieces(&mut self, i: usize, mut go: impl FnMut(f64, f64)) {
        let Some(step) = self.excitation.step else {
            return self.uneven_pieces(i, go);
        };
        let late = self.value(i.checked_sub(self.whole));
        if self.rest == 0.0 {
            return go(late, step);
        }
        let early = self.value(i.checked_sub(self.whole + 1));
        if early == late {
            go(late, step);
        } else {
            go(early, self.rest);
            go(late, step - self.rest);
        }
    }

    fn uneven_pieces(&mut self, i: usize, mut go: impl FnMut(f64, f64)) {
        let time = &self.excitation.time;
        let (mut now, end) = (time[i], time[i + 1]);
        while now < end {
            while self.pointer < time.len() && time[self.pointer] + self.delay <= now {
                self.pointer += 1;
            }
            let until = time
                .get(self.pointer)
                .map_or(end, |t| (t + self.delay).min(end));
            go(self.value(self.pointer.checked_sub(1)), until - now);
            now = until;
        }
    }
}
