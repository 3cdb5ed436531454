//! A process, and the same under a controller as they are built.

use std::fmt::Write as _;

use hysteron_core::measurement::{ImportOptions, Measurement, import};
use hysteron_core::rig::Random;

/// Two lags in a row under an input that may depend on the output, sampled each second: a process by other means than
/// the model's.
pub fn process(mut input: impl FnMut(usize, f64) -> f64) -> Measurement {
    let mut random = Random::new(11);
    let (mut heater, mut sensor, mut surroundings) = (0.0, 0.0, 0.0);
    let mut csv = "t [s],u [1],y [1]\n".to_owned();
    for k in 0..2500 {
        surroundings = 0.999 * surroundings + 0.01 * random.normal();
        let y = 20.0 + sensor + surroundings + 0.02 * random.normal();
        let u = input(k, y);
        let _ = writeln!(csv, "{k},{u},{y}");
        for _ in 0..10 {
            heater += 0.1 * (8.0 * u - heater) / 120.0;
            sensor += 0.1 * (heater - sensor) / 15.0;
        }
    }
    import("process.csv", csv.as_bytes(), &ImportOptions::default()).expect("a record")
}

/// The same under a proportional-integral controller between limits, whose integral stops there; its set point steps.
pub fn under_controller() -> Measurement {
    let mut integral = 0.0;
    process(|k, y| {
        let error = if k < 1200 { 45.0 } else { 30.0 } - y;
        let wish = 0.4 * error + integral + 0.005 * error;
        let u = wish.clamp(0.0, 5.0);
        integral += if u == wish { 0.005 * error } else { 0.0 };
        u
    })
}
