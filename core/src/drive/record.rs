//! What a test rig would record of a simulated drive: the motor's columns with encoder and noise.

use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::{DriveError, DriveInput, DriveRun, EventKind, check, run};
use crate::measurement::{Channel, Kind, Measurement, Quantity};

/// A data acquisition on the motor side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recorder {
    /// Sampling time, s; above 0.
    pub sampling: f64,
    /// Resolution of the encoder, rad (or m); at least 0.
    pub resolution: f64,
    /// Standard deviation of the velocity's noise, rad/s (or m/s); at least 0.
    pub velocity_noise: f64,
    /// The same seed gives the same noise.
    pub seed: u64,
}

impl Default for Recorder {
    /// An encoder of 2^20 counts a turn and 2 mrad/s of noise, every 0.1 ms.
    fn default() -> Self {
        Self {
            sampling: 1e-4,
            resolution: std::f64::consts::TAU / 1_048_576.0,
            velocity_noise: 2e-3,
            seed: 1,
        }
    }
}

/// Runs a drive and records `t`, `u`, `x1`, `v1`. The torque is its mean from each sample to the next, as a
/// measured current is; a relay that switches between samples would otherwise seem to be late by chance.
///
/// # Errors
/// A value out of its range.
pub fn record(input: &DriveInput, recorder: &Recorder) -> Result<Measurement, DriveError> {
    let Recorder {
        sampling,
        resolution,
        velocity_noise,
        seed,
    } = *recorder;
    check("resolution", resolution, resolution >= 0.0, "0 or more")?;
    check(
        "velocity noise",
        velocity_noise,
        velocity_noise >= 0.0,
        "0 or more",
    )?;
    let done = run(&DriveInput {
        step: Some(sampling),
        ..*input
    })?;
    let least = crate::measurement::MIN_SAMPLES as f64;
    let count = done.time.len() as f64;
    check("number of samples", count, count >= least, "at least 20")?;
    let torque = mean_input(&done);
    let mut random = Pcg64::seed_from_u64(seed);
    let position = done.x1.iter().map(|x| {
        if resolution > 0.0 {
            (x / resolution).round() * resolution
        } else {
            *x
        }
    });
    let velocity = done.v1.iter().map(|v| {
        let noise: f64 = StandardNormal.sample(&mut random);
        v + velocity_noise * noise
    });
    let channel = |quantity, name: &str, unit: &str, values| Channel {
        quantity,
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    };
    Ok(Measurement {
        name: "simulated drive".to_owned(),
        kind: Kind::Drive,
        input: channel(Quantity::Input, "u", "N m", torque),
        outputs: vec![
            channel(Quantity::Position, "x1", "rad", position.collect()),
            channel(Quantity::Velocity, "v1", "rad/s", velocity.collect()),
        ],
        time: done.time,
        reference: Vec::new(),
        warnings: Vec::new(),
    })
}

/// Mean torque from each sample to the next.
fn mean_input(run: &DriveRun) -> Vec<f64> {
    let mut changes = run
        .events
        .iter()
        .filter_map(|e| match e.kind {
            EventKind::Input(u) => Some((e.time, u)),
            _ => None,
        })
        .peekable();
    let mut u = run.input.first().copied().unwrap_or(0.0);
    let mut means: Vec<f64> = run
        .time
        .windows(2)
        .map(|pair| {
            let (mut from, mut sum) = (pair[0], 0.0);
            while let Some((t, next)) = changes.next_if(|c| c.0 < pair[1]) {
                let t = t.max(from);
                sum += u * (t - from);
                (from, u) = (t, next);
            }
            sum += u * (pair[1] - from);
            sum / (pair[1] - pair[0])
        })
        .collect();
    means.push(u);
    means
}
