//! A model under a sampled controller: the input follows from what was seen.

use super::actuator::Remembering;
use super::{Engine, Model, Sensor, State};

/// What a model does under a controller, one value per sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Commanded input, held from its sample to the next.
    pub input: Vec<f64>,
    /// Position as seen by its sensor.
    pub position: Vec<f64>,
    /// Velocity, or the output of a process, as seen by its sensor.
    pub velocity: Vec<f64>,
}

/// Runs `model` from rest for `samples` samples, `step` s apart (above 0). `command` gives the input for a time
/// in s and the velocity (output of a process) seen then; before the first one it was 0. `slow_sensor` is the
/// sensor that a sensor lag makes slow.
pub fn run_controlled(
    model: &Model,
    step: f64,
    samples: usize,
    slow_sensor: Sensor,
    mut command: impl FnMut(f64, f64) -> f64,
) -> Run {
    let at_rest = [0.0, 0.0];
    run_controlled_from(model, step, samples, slow_sensor, at_rest, |t, _, v| {
        command(t, v)
    })
}

/// The same from a position and a velocity (output of a process); `command` is told the position before the velocity
/// too.
pub fn run_controlled_from(
    model: &Model,
    step: f64,
    samples: usize,
    slow_sensor: Sensor,
    [position, velocity]: [f64; 2],
    mut command: impl FnMut(f64, f64, f64) -> f64,
) -> Run {
    let before = model.map_input(0.0);
    let late = (model.delay.max(0.0) / step).min(samples as f64);
    let (whole, rest) = (late.floor() as usize, late.fract() * step);
    let mut engine = Engine::new(model);
    for h in [step, rest, step - rest].into_iter().filter(|h| *h > 0.0) {
        engine.prepare(h);
    }
    let [position, velocity] = model.seen([position, velocity]);
    let mut state = State::at_rest(before).restarted(position, velocity);
    let mut slow = Slow::new(model.sensor_lag, step);
    let mut mapped: Vec<f64> = Vec::with_capacity(samples);
    let mut actuator = model.actuator.map(|a| Remembering::new(a, before));
    let mut run = Run::default();
    for i in 0..samples {
        let time = i as f64 * step;
        let [mut x, v] = model.seen([state.position(), state.velocity()]);
        let mut v = model.map_output(v);
        if let Some(encoder) = model.encoder {
            (x, v) = encoder.seen(x, v);
        }
        match slow_sensor {
            Sensor::Velocity => v = slow.follow(v),
            Sensor::Position => x = slow.follow(x),
        }
        let u = command(time, x, v);
        run.input.push(u);
        run.position.push(x);
        run.velocity.push(v);
        let command = model.map_input(u);
        let given = actuator.as_mut().map(|a| a.after(command, step));
        mapped.push(given.unwrap_or(command));
        let load = model.early_load(time + 0.5 * step);
        let acting = |back: usize| i.checked_sub(back).map_or(before, |k| mapped[k]);
        if rest > 0.0 {
            engine.advance(&mut state, acting(whole + 1) + load, rest);
        }
        engine.advance(&mut state, acting(whole) + load, step - rest);
    }
    run
}

/// A first-order lag, straight between samples; it starts where its signal does.
struct Slow {
    lag: Option<f64>,
    step: f64,
    last: Option<(f64, f64)>,
}

impl Slow {
    fn new(lag: Option<f64>, step: f64) -> Self {
        Self {
            lag,
            step,
            last: None,
        }
    }

    fn follow(&mut self, now: f64) -> f64 {
        let Some(lag) = self.lag else {
            return now;
        };
        let slow = self.last.map_or(now, |(before, slow)| {
            // The lag follows a ramp at the distance slope * lag.
            let behind = (now - before) / self.step * lag;
            now - behind + (slow - before + behind) * libm::exp(-self.step / lag)
        });
        self.last = Some((now, slow));
        slow
    }
}
