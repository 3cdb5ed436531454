//! A self-regulating process with everything that a plant adds to a first-order lag.
//!
//! Runge-Kutta steps of 5 ms on a chain of lags with a transport delay line; the controller is sampled,
//! the sensor is noisy.

use super::{Proposed, Random};
use crate::measurement::{Channel, Kind, Measurement, Quantity};

/// Sampling time of the controller and the record, s.
pub const SAMPLING: f64 = 0.2;
/// Steps of integration in that time.
const SUBSTEPS: usize = 40;
/// Standard deviation of the noise of y.
const NOISE: f64 = 0.01;

/// Levels of the staircase, as shares of the largest.
pub const STAIRS: [f64; 8] = [0.5, -0.25, 1.0, 0.25, -0.75, 0.75, -1.0, 0.0];

/// What drives the process.
#[derive(Clone, Copy, Debug)]
pub enum Excitation {
    /// Relay of this gain on the measured output.
    Relay {
        /// In the unit of the input.
        gain: f64,
        /// In the unit of the output.
        hysteresis: f64,
    },
    /// Levels up to this size, held 24 s each, in an irregular order.
    Staircase {
        /// The largest level, in the unit of the input.
        top: f64,
    },
    /// Two levels, held for random multiples of 3 s.
    Binary {
        /// Of both signs, in the unit of the input.
        level: f64,
    },
    /// What a proposed experiment asks for.
    Proposed(Proposed),
}

/// Physics that no library of the project knows.
#[derive(Clone, Copy, Debug)]
pub enum Stranger {
    /// The gain changes by this factor in the middle of the record.
    GainSteps {
        /// Of the change.
        factor: f64,
    },
    /// A disturbance of the input that swings.
    Swing {
        /// In the unit of the input.
        amplitude: f64,
        /// s.
        period: f64,
    },
    /// The valve sticks: play in the input.
    StickyValve {
        /// Half width, in the unit of the input.
        width: f64,
    },
    /// A valve that sticks and slips (Choudhury, Thornhill and Shah 2005).
    SlippingValve {
        /// S, in the unit of the input.
        band: f64,
        /// J, in the unit of the input.
        jump: f64,
    },
    /// A valve that moves at this rate at most, input unit per s.
    SlowValve {
        /// Input unit per s.
        rate: f64,
    },
    /// A valve that opens only beyond this command.
    DeadBand {
        /// Half width, in the unit of the input.
        width: f64,
    },
    /// The output first goes the wrong way: a zero in the right half-plane.
    WrongWay {
        /// Its time constant, s.
        time: f64,
    },
    /// A tank that empties through a hole: this outflow, in the unit of the input, at a level of one.
    Outflow {
        /// In the unit of the input.
        flow: f64,
    },
    /// The time constant depends on the direction.
    SlowFall {
        /// Of the time constant when falling.
        factor: f64,
    },
}

/// One experiment and everything that is hidden in it; values are taken as they are.
#[derive(Clone, Copy, Debug)]
pub struct ProcessRig {
    /// Of the noise and of what is random in the input.
    pub seed: u64,
    /// What drives it.
    pub excitation: Excitation,
    /// Length of the record.
    pub samples: usize,
    /// Output unit per input unit.
    pub gain: f64,
    /// Of the first lag, s.
    pub time_constant: f64,
    /// Time constant of a lag behind it, s; 0 for none.
    pub second_lag: f64,
    /// Period of the free swing of a process that swings before it settles, s, in the place of the lags behind; 0 for
    /// none.
    pub swing_period: f64,
    /// Time constant of one behind both, s; 0 for none.
    pub third_lag: f64,
    /// Of the input, s; met to a step of integration.
    pub dead_time: f64,
    /// Share by which positive input acts more and negative input less.
    pub gain_asymmetry: f64,
    /// Added to the input of the process.
    pub constant_load: f64,
    /// Its growth, input unit per s.
    pub load_ramp: f64,
    /// The largest input that the valve passes.
    pub saturation: f64,
    /// The output is `y + curvature y^2`, 1/output unit.
    pub curvature: f64,
    /// The valve passes `u + valve_curvature u^2`, 1/input unit.
    pub valve_curvature: f64,
    /// Time constant of the sensor, s; 0 for none.
    pub sensor_lag: f64,
    /// Physics that no library of the project knows.
    pub stranger: Option<Stranger>,
}

impl Default for ProcessRig {
    fn default() -> Self {
        Self {
            seed: 1,
            excitation: Excitation::Relay {
                gain: 1.0,
                hysteresis: 0.1,
            },
            samples: 2000,
            gain: 2.0,
            time_constant: 30.0,
            second_lag: 0.0,
            swing_period: 0.0,
            third_lag: 0.0,
            dead_time: 0.0,
            gain_asymmetry: 0.0,
            constant_load: 0.0,
            load_ramp: 0.0,
            saturation: f64::INFINITY,
            curvature: 0.0,
            valve_curvature: 0.0,
            sensor_lag: 0.0,
            stranger: None,
        }
    }
}

/// Process, second lag or rate of the process, third lag, sensor.
type State = [f64; 4];

impl ProcessRig {
    /// Runs the experiment.
    pub fn measure(&self) -> Measurement {
        let mut random = Random::new(self.seed);
        let mut controller = Controller {
            high: false,
            level: 1.0,
            until: 0.0,
        };
        let h = SAMPLING / SUBSTEPS as f64;
        let late = (self.dead_time / h).round() as usize;
        let mut s: State = [0.0; 4];
        let mut acting: Vec<f64> = Vec::with_capacity(self.samples);
        let (mut valve, mut stem) = (0.0, 0.0);
        let (mut time, mut input, mut output) = (vec![], vec![], vec![]);
        for i in 0..self.samples {
            let t = i as f64 * SAMPLING;
            let measured = self.seen(s) + NOISE * random.normal();
            let u = controller.command(self.excitation, t, measured, &mut random);
            time.push(t);
            input.push(u);
            output.push(measured);
            acting.push(self.passed(u, &mut valve));
            for j in 0..SUBSTEPS {
                let now = i * SUBSTEPS + j;
                let then = now.checked_sub(late).and_then(|n| acting.get(n / SUBSTEPS));
                let mut u = then.copied().unwrap_or(0.0);
                if let Some(Stranger::SlowValve { rate }) = self.stranger {
                    stem = u.clamp(stem - rate * h, stem + rate * h);
                    u = stem;
                }
                s = self.step(s, u, t + j as f64 * h, h);
            }
        }
        self.record(time, input, output)
    }

    /// What the valve makes of a command.
    fn passed(&self, u: f64, valve: &mut f64) -> f64 {
        let cut = u.clamp(-self.saturation, self.saturation);
        let sign = if cut > 0.0 { 1.0 } else { -1.0 };
        let out = (1.0 + self.gain_asymmetry * sign) * cut;
        if let Some(Stranger::StickyValve { width }) = self.stranger {
            *valve = valve.clamp(out - width, out + width);
            return *valve;
        }
        if let Some(Stranger::SlippingValve { band, jump }) = self.stranger {
            let behind = out - *valve;
            // A stem at rest needs more than one that slides.
            if behind.abs() > 0.5 * (band + jump) {
                *valve = out - 0.5 * (band - jump) * behind.signum();
            }
            return *valve;
        }
        if let Some(Stranger::DeadBand { width }) = self.stranger {
            return out - out.clamp(-width, width);
        }
        out
    }

    fn seen(&self, s: State) -> f64 {
        if self.sensor_lag > 0.0 {
            s[3]
        } else {
            self.output(s, s[0])
        }
    }

    /// Output before the sensor; `y` is that of the first lag.
    fn output(&self, s: State, y: f64) -> f64 {
        let last = if self.third_lag > 0.0 {
            s[2]
        } else if self.second_lag > 0.0 {
            s[1]
        } else {
            y
        };
        last + self.curvature * last * last
    }

    fn step(&self, s: State, u: f64, t: f64, h: f64) -> State {
        let ahead = |k: State, h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
        let k1 = self.rates(s, u, t);
        let k2 = self.rates(ahead(k1, h / 2.0), u, t + h / 2.0);
        let k3 = self.rates(ahead(k2, h / 2.0), u, t + h / 2.0);
        let k4 = self.rates(ahead(k3, h), u, t + h);
        std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }

    fn rates(&self, s: State, u: f64, t: f64) -> State {
        let valve = u + self.valve_curvature * u * u;
        let mut push = valve + self.constant_load + self.load_ramp * t;
        let mut gain = self.gain;
        match self.stranger {
            Some(Stranger::Swing { amplitude, period }) => {
                push += amplitude * libm::sin(std::f64::consts::TAU * t / period);
            }
            Some(Stranger::Outflow { flow }) => push -= flow * s[0].max(0.0).sqrt(),
            Some(Stranger::GainSteps { factor }) if t > 0.5 * self.samples as f64 * SAMPLING => {
                gain *= factor;
            }
            _ => {}
        }
        let mut rate = (gain * push - s[0]) / self.time_constant;
        if let Some(Stranger::SlowFall { factor }) = self.stranger
            && rate < 0.0
        {
            rate /= factor;
        }
        // A zero in the right half-plane: the next lag sees y - T_z dy/dt.
        let shown = match self.stranger {
            Some(Stranger::WrongWay { time }) => s[0] - time * rate,
            _ => s[0],
        };
        let lag = |from: f64, to: f64, time: f64| if time > 0.0 { (from - to) / time } else { 0.0 };
        let second = lag(shown, s[1], self.second_lag);
        let third = lag(s[1], s[2], self.third_lag);
        if self.swing_period > 0.0 {
            let time = self.swing_period / std::f64::consts::TAU;
            let pull = gain * push - s[0] - self.time_constant * s[1];
            let sensor = lag(self.output(s, s[0]), s[3], self.sensor_lag);
            return [s[1], pull / (time * time), 0.0, sensor];
        }
        [
            rate,
            second,
            third,
            lag(self.output(s, s[0]), s[3], self.sensor_lag),
        ]
    }

    fn record(&self, time: Vec<f64>, input: Vec<f64>, output: Vec<f64>) -> Measurement {
        let channel = |quantity, name: &str, values| Channel {
            quantity,
            name: name.to_owned(),
            unit: "1".to_owned(),
            values,
        };
        Measurement {
            name: format!("process rig {}", self.seed),
            kind: Kind::Process,
            time,
            input: channel(Quantity::Input, "u", input),
            outputs: vec![channel(Quantity::Output, "y", output)],
            reference: vec![],
            warnings: vec![],
        }
    }
}

/// The sampled controller.
struct Controller {
    high: bool,
    level: f64,
    until: f64,
}

impl Controller {
    fn command(&mut self, excitation: Excitation, t: f64, y: f64, random: &mut Random) -> f64 {
        match excitation {
            Excitation::Relay { gain, hysteresis } => {
                if y > hysteresis {
                    self.high = true;
                } else if y < -hysteresis {
                    self.high = false;
                }
                if self.high { -gain } else { gain }
            }
            Excitation::Proposed(proposed) => proposed.input(t, y, &mut self.high),
            Excitation::Staircase { top } => {
                top * STAIRS
                    .get((t / 24.0) as usize % STAIRS.len())
                    .unwrap_or(&0.0)
            }
            Excitation::Binary { level } => {
                if t >= self.until {
                    self.level = level * random.sign();
                    self.until = t + 3.0 * (1.0 + (5.0 * random.uniform()).floor());
                }
                self.level
            }
        }
    }
}
