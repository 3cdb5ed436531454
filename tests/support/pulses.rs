//! A process that is seen to do something else in two short moments only.

use std::fmt::Write as _;

use hysteron_core::rig::Random;

/// Time constant and time between samples, s.
const TIME_CONSTANT: f64 = 0.5;
const STEP: f64 = 0.1;

/// Samples at which the input is reversed for a moment: in neighbouring stretches, of which one is held back.
const REVERSALS: [usize; 2] = [125, 175];

/// Gain under a reversed input, in times of the usual one.
pub const OTHER_GAIN: f64 = 1.8;

const NOISE: f64 = 0.012;

/// A lag under steps of an input that goes the other way twice, for so many samples, and then with another gain.
pub fn reversed_twice(samples: usize) -> String {
    let mut random = Random::new(3);
    let mut text = "t [s],u [1],y [1]\n".to_owned();
    let mut y = 0.5;
    for i in 0..1000_usize {
        let reversed = REVERSALS.iter().any(|at| (*at..at + samples).contains(&i));
        let level = [0.3, 0.6, 0.45, 0.7][i / 25 % 4];
        let u = if reversed { -0.4 } else { level };
        let measured = y + NOISE * random.normal();
        let _ = writeln!(text, "{:.1},{u},{measured:.5}", STEP * i as f64);
        let gain = if reversed { OTHER_GAIN } else { 1.0 };
        y += (gain * u - y) * (1.0 - (-STEP / TIME_CONSTANT).exp());
    }
    text
}
