//! A relay test on a bench of its own: lags, an integrator, a zero and a dead time by Runge and Kutta in small steps,
//! a relay that sees a noisy, coarse sensor once a sample, and what a data logger would write.

use std::f64::consts::PI;

use hysteron_core::rig::Random;
use hysteron_core::tuning::measured::Record;

/// Steps of the integration for each sample.
const STEPS: usize = 40;

/// A plant as a chain: dead time, gain, lags, and at the end an integrator or a zero.
#[derive(Clone, Debug)]
pub struct Plant {
    pub name: &'static str,
    pub gain: f64,
    /// Time constants, s.
    pub lags: Vec<f64>,
    pub integrates: bool,
    /// Time constant of the zero in the last lag, s.
    pub zero: f64,
    /// Dead time, s.
    pub dead_time: f64,
}

impl Plant {
    /// Real and imaginary part of the response at `omega` rad/s.
    pub fn response(&self, omega: f64) -> [f64; 2] {
        let mut magnitude = self.gain.abs() * (self.zero * omega).hypot(1.0);
        let mut phase = (self.zero * omega).atan() - self.dead_time * omega;
        for t in &self.lags {
            magnitude /= (t * omega).hypot(1.0);
            phase -= (t * omega).atan();
        }
        if self.integrates {
            magnitude /= omega;
            phase -= 0.5 * PI;
        }
        [magnitude, phase]
    }

    /// Gain and period where the phase is -180 degrees.
    pub fn ultimate(&self) -> [f64; 2] {
        let (mut low, mut high) = (1e-6, 1e6);
        for _ in 0..200 {
            let middle = f64::sqrt(low * high);
            if self.response(middle)[1] > -PI {
                low = middle;
            } else {
                high = middle;
            }
        }
        [1.0 / self.response(low)[0], 2.0 * PI / low]
    }
}

/// The ten plants of the bench.
pub fn plants() -> Vec<Plant> {
    let plant = |name, gain, lags: &[f64], integrates, zero, dead_time| Plant {
        name,
        gain,
        lags: lags.to_vec(),
        integrates,
        zero,
        dead_time,
    };
    vec![
        plant("lag, short dead time", 2.0, &[20.0], false, 0.0, 2.0),
        plant("lag and dead time alike", 1.0, &[10.0], false, 0.0, 10.0),
        plant("mostly dead time", 0.8, &[5.0], false, 0.0, 20.0),
        plant("two lags and dead time", 3.0, &[30.0, 6.0], false, 0.0, 3.0),
        plant("three equal lags", 1.0, &[1.0, 1.0, 1.0], false, 0.0, 0.0),
        plant("five equal lags", 5.0, &[4.0; 5], false, 0.0, 0.0),
        plant(
            "four falling lags",
            1.5,
            &[8.0, 4.0, 2.0, 1.0],
            false,
            0.0,
            0.5,
        ),
        plant("integrator and dead time", 0.1, &[], true, 0.0, 4.0),
        plant("integrator, lag, dead time", 0.05, &[6.0], true, 0.0, 2.0),
        plant("inverse response", 1.0, &[10.0, 5.0], false, -3.0, 1.0),
    ]
}

/// How a plant is tested.
#[derive(Clone, Debug)]
pub struct Test {
    pub name: &'static str,
    /// Input of the relay, down and up.
    pub levels: [f64; 2],
    /// Input at which the plant stays at the set point.
    pub holds: f64,
    /// Half the distance of the thresholds, as a share of the amplitude without hysteresis.
    pub hysteresis: f64,
    /// Standard deviation of the noise, as a share of that amplitude.
    pub noise: f64,
    /// Step of the sensor, as a share of that amplitude.
    pub step: f64,
    /// Drift of the load, in input levels over the whole test.
    pub drift: f64,
    /// Standard deviation, at the end of the test, of a load that wanders at random, in input levels.
    pub wander: f64,
    /// Least time up and down, in periods without it.
    pub least_time: f64,
    /// Whether the test begins where the plant rests with the relay down, with the relay up.
    pub cold: bool,
    /// Share of the test from which another load acts, and how much, in input levels.
    pub later: [f64; 2],
    /// Samples of a period, and periods.
    pub samples: f64,
    pub periods: f64,
}

/// The six tests of the bench.
pub fn tests() -> Vec<Test> {
    let test = |name, holds, hysteresis, noise, step, drift| Test {
        name,
        levels: [0.0, 1.0],
        holds,
        hysteresis,
        noise,
        step,
        drift,
        wander: 0.0,
        least_time: 0.0,
        cold: false,
        later: [1.0, 0.0],
        samples: 100.0,
        periods: 10.0,
    };
    vec![
        test("symmetric", 0.5, 0.0, 0.0, 0.0, 0.0),
        test("noisy", 0.5, 0.15, 0.03, 0.0, 0.0),
        test("biased", 0.3, 0.1, 0.01, 0.0, 0.0),
        test("strongly biased, hysteresis", 0.75, 0.4, 0.01, 0.0, 0.0),
        test("coarse sensor", 0.4, 0.1, 0.02, 0.125, 0.0),
        test("drifting, noisy", 0.6, 0.2, 0.02, 0.02, 0.1),
    ]
}

/// The plant in motion.
struct Motion<'a> {
    plant: &'a Plant,
    states: Vec<f64>,
}

impl Motion<'_> {
    fn slopes(&self, x: &[f64], u: f64) -> Vec<f64> {
        let mut out = Vec::with_capacity(x.len());
        let mut into = self.plant.gain * u;
        for (state, lag) in x.iter().zip(&self.plant.lags) {
            out.push((into - state) / lag);
            into = *state;
        }
        if self.plant.integrates {
            out.push(into);
        }
        out
    }

    fn step(&mut self, u: f64, h: f64) {
        let x = self.states.clone();
        let moved =
            |k: &[f64], by: f64| -> Vec<f64> { x.iter().zip(k).map(|(x, k)| x + by * k).collect() };
        let a = self.slopes(&x, u);
        let b = self.slopes(&moved(&a, 0.5 * h), u);
        let c = self.slopes(&moved(&b, 0.5 * h), u);
        let d = self.slopes(&moved(&c, h), u);
        for (i, state) in self.states.iter_mut().enumerate() {
            *state += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
    }

    fn output(&self, u: f64) -> f64 {
        let last = self.states.last().copied().unwrap_or(0.0);
        if self.plant.zero == 0.0 {
            return last;
        }
        let slope = self.slopes(&self.states, u)[self.states.len() - 1];
        last + self.plant.zero * slope
    }
}

/// What the relay and its sensor do.
struct Relay {
    levels: [f64; 2],
    holds: f64,
    hysteresis: f64,
    noise: f64,
    step: f64,
    drift: f64,
    wander: f64,
    cold: bool,
    later: [f64; 2],
    /// Samples.
    least_time: usize,
}

/// Runs the plant about its set point (output 0) for `count` samples every `sampling` s.
fn run(plant: &Plant, relay: &Relay, sampling: f64, count: usize, random: &mut Random) -> Record {
    let order = plant.lags.len() + usize::from(plant.integrates);
    // What acted before.
    let rest = if relay.cold {
        relay.levels[0] - relay.holds
    } else {
        0.0
    };
    let mut motion = Motion {
        plant,
        states: vec![plant.gain * rest; order],
    };
    let h = sampling / STEPS as f64;
    let late = (plant.dead_time / h).round() as usize;
    let mut inputs: Vec<f64> = Vec::new();
    let mut up = true;
    let mut switched = 0;
    let (mut time, mut input, mut output) = (Vec::new(), Vec::new(), Vec::new());
    // Counts of a sensor do not lie on the set point.
    let offset = relay.step * random.uniform();
    let mut wandered = 0.0;
    for i in 0..count {
        // The input that acted in the last step.
        let acted = (inputs.len().checked_sub(late + 1)).map_or(rest, |k| inputs[k]);
        let mut seen = motion.output(acted) + relay.noise * random.normal();
        if relay.step > 0.0 {
            seen = ((seen - offset) / relay.step).round() * relay.step + offset;
        }
        let may = i - switched >= relay.least_time;
        if may && ((up && seen > relay.hysteresis) || (!up && seen < -relay.hysteresis)) {
            up = !up;
            switched = i;
        }
        let u = relay.levels[usize::from(up)];
        time.push(i as f64 * sampling);
        input.push(u);
        output.push(seen);
        if relay.wander > 0.0 {
            wandered += relay.wander * random.normal() / (count as f64).sqrt();
        }
        let later = if i as f64 >= relay.later[0] * count as f64 {
            relay.later[1]
        } else {
            0.0
        };
        for _ in 0..STEPS {
            let load =
                later + wandered + relay.drift * inputs.len() as f64 / (count * STEPS) as f64;
            inputs.push(u - relay.holds - load);
            let acting = (inputs.len().checked_sub(late + 1)).map_or(rest, |k| inputs[k]);
            motion.step(acting, h);
        }
    }
    Record {
        name: plant.name.to_owned(),
        time,
        input,
        output,
        input_unit: "1".to_owned(),
        output_unit: "1".to_owned(),
    }
}

/// The record of a test; the same seed gives the same record.
pub fn relay_test(plant: &Plant, test: &Test, seed: u64) -> Record {
    let mut random = Random::new(seed);
    let [_, period] = plant.ultimate();
    let samples = test.samples * random.between(0.7, 1.3);
    // A whole number of steps of the integration fits into the dead time.
    let step = period / samples / STEPS as f64;
    let step = match (plant.dead_time / step).ceil() {
        0.0 => step,
        late => plant.dead_time / late,
    };
    let sampling = step * STEPS as f64;
    let mut relay = Relay {
        levels: test.levels,
        holds: if test.cold { 0.5 } else { test.holds },
        hysteresis: 0.0,
        noise: 0.0,
        step: 0.0,
        drift: 0.0,
        wander: 0.0,
        cold: false,
        later: [1.0, 0.0],
        least_time: 0,
    };
    // Tried once without noise, to know what amplitude there will be.
    let trial = run(
        plant,
        &relay,
        sampling,
        (6.0 * samples) as usize,
        &mut random.clone(),
    );
    let later = &trial.output[trial.output.len() / 2..];
    let (low, high) = later
        .iter()
        .fold((0.0_f64, 0.0_f64), |(a, b), y| (a.min(*y), b.max(*y)));
    let amplitude = 0.5 * (high - low);
    relay.hysteresis = test.hysteresis * amplitude;
    relay.noise = test.noise * amplitude;
    relay.step = test.step * amplitude;
    relay.drift = test.drift;
    relay.wander = test.wander;
    (relay.holds, relay.cold, relay.later) = (test.holds, test.cold, test.later);
    relay.least_time = (test.least_time * samples) as usize;
    run(
        plant,
        &relay,
        sampling,
        (test.periods * samples * (1.0 + 2.0 * test.hysteresis)) as usize,
        &mut random,
    )
}
