//! A rig of other physics than the model under test: bristle friction (Canudas de Wit et al. 1995)
//! integrated by Runge-Kutta, a relay in a sampled controller, an encoder that quantises, a noisy
//! velocity. A model that explains its files does not do so by construction.

use hysteron_core::measurement::Measurement;

use super::record::of_motor;

/// What is hidden in a drive.
#[derive(Clone, Copy, Debug)]
pub struct Rig {
    pub seed: u64,
    pub inertia: f64,
    pub viscous: f64,
    pub coulomb: f64,
    pub delay: f64,
    pub lag: f64,
    pub gain_asymmetry: f64,
    pub constant_load: f64,
    pub relay_gain: f64,
    pub relay_asymmetry: f64,
    /// A torque staircase instead of the relay.
    pub staircase: bool,
    pub samples: usize,
}

impl Default for Rig {
    fn default() -> Self {
        Self {
            seed: 1,
            inertia: 8.8e-4,
            viscous: 2e-3,
            coulomb: 0.0,
            delay: 0.0,
            lag: 0.0,
            gain_asymmetry: 0.0,
            constant_load: 0.0,
            relay_gain: 0.5,
            relay_asymmetry: 0.1,
            staircase: false,
            samples: 8000,
        }
    }
}

const STEP: f64 = 2e-4;
const SUBSTEPS: usize = 20;
const BRISTLE_STIFFNESS: f64 = 3000.0;
const BRISTLE_DAMPING: f64 = 0.3;
const ENCODER: f64 = std::f64::consts::TAU / 1_048_576.0;
const VELOCITY_NOISE: f64 = 2e-3;

/// Uniform numbers in 0 to 1 (xorshift64*).
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

impl Rig {
    /// Runs the experiment.
    pub fn measure(&self) -> Measurement {
        let mut random = Random(self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let h = STEP / SUBSTEPS as f64;
        let delay = (self.delay / h).round() as usize;
        let mut waiting = std::collections::VecDeque::from(vec![0.0; delay]);
        // Position, velocity, bristle, lagged torque.
        let mut s = [0.0_f64; 4];
        let mut high = false;
        let (mut time, mut input, mut position, mut velocity) = (vec![], vec![], vec![], vec![]);
        for i in 0..self.samples {
            let measured = s[1] + VELOCITY_NOISE * random.normal();
            if measured > 0.5 {
                high = true;
            } else if measured < -0.5 {
                high = false;
            }
            let level = [0.12, -0.2, 0.3, -0.08, -0.25, 0.2, -0.3, 0.25][i / 100 % 8];
            let relay = if high {
                -self.relay_gain * (1.0 - self.relay_asymmetry)
            } else {
                self.relay_gain * (1.0 + self.relay_asymmetry)
            };
            let u = if self.staircase { level } else { relay };
            time.push(i as f64 * STEP);
            input.push(u);
            position.push((s[0] / ENCODER).round() * ENCODER);
            velocity.push(measured);
            for _ in 0..SUBSTEPS {
                waiting.push_back(u);
                let acting = waiting.pop_front().unwrap_or(u);
                s = self.runge_kutta(s, acting, h);
            }
        }
        let signals = [input, position, velocity];
        of_motor(format!("rig {}", self.seed), time, signals)
    }

    fn rates(&self, s: [f64; 4], u: f64) -> [f64; 4] {
        let sign = f64::from(i8::from(u > 0.0) - i8::from(u < 0.0));
        let amplified = (1.0 + self.gain_asymmetry * sign) * u;
        let torque = if self.lag > 0.0 { s[3] } else { amplified };
        let (bristle, friction) = if self.coulomb > 0.0 {
            let rate = s[1] - BRISTLE_STIFFNESS * s[1].abs() * s[2] / self.coulomb;
            (rate, BRISTLE_STIFFNESS * s[2] + BRISTLE_DAMPING * rate)
        } else {
            (0.0, 0.0)
        };
        let force = torque + self.constant_load - self.viscous * s[1] - friction;
        let lagged = if self.lag > 0.0 {
            (amplified - s[3]) / self.lag
        } else {
            0.0
        };
        [s[1], force / self.inertia, bristle, lagged]
    }

    fn runge_kutta(&self, s: [f64; 4], u: f64, h: f64) -> [f64; 4] {
        let ahead = |k: [f64; 4], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
        let k1 = self.rates(s, u);
        let k2 = self.rates(ahead(k1, h / 2.0), u);
        let k3 = self.rates(ahead(k2, h / 2.0), u);
        let k4 = self.rates(ahead(k3, h), u);
        std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }
}
