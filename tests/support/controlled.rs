//! A process and a drive, and the same under controllers as they are built.

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

/// The position of a drive under a proportional controller of this gain (N m/rad), whose set point steps by little and
/// by much.
pub fn positioned(gain: f64) -> Measurement {
    const STEP: f64 = 1e-3;
    const FINE: usize = 20;
    let (inertia, viscous) = (1e-3, 5e-3);
    let mut random = Random::new(13);
    let (mut x, mut v, mut set_point) = (0.0, 0.0, 0.0);
    let mut csv = "t [s],u [N m],x1 [rad]\n".to_owned();
    for k in 0..3000 {
        if k % 200 == 0 {
            set_point = random.normal();
        }
        let logged = x + 1e-4 * random.normal();
        let u = gain * (set_point - logged);
        let _ = writeln!(csv, "{},{u},{logged}", f64::from(k) * STEP);
        for _ in 0..FINE {
            v += STEP / FINE as f64 * (u - viscous * v) / inertia;
            x += STEP / FINE as f64 * v;
        }
    }
    import("positioned.csv", csv.as_bytes(), &ImportOptions::default()).expect("a record")
}

/// The level of a tank that gains 0.02 a second from each unit of its input, under a proportional-integral controller
/// whose set point steps.
pub fn level_under_controller() -> Measurement {
    let mut random = Random::new(17);
    let (mut level, mut integral) = (50.0, 0.0);
    let mut csv = "t [s],u [1],y [1]\n".to_owned();
    for k in 0..2000 {
        let set_point = 50.0 + 10.0 * f64::from(k / 300 % 2);
        let y = level + 0.05 * random.normal();
        let error = set_point - y;
        let u = 3.0 * error + integral;
        integral += 0.02 * error;
        let _ = writeln!(csv, "{k},{u},{y}");
        level += 0.02 * u;
    }
    import("level.csv", csv.as_bytes(), &ImportOptions::default()).expect("a record")
}
