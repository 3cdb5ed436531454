//! The residual over every axis on which a model can fail: small curves for pictures.

use serde::{Deserialize, Serialize};

use super::data::Data;
use super::fit::{Motion, residuals};
use super::locate::axes;
use crate::measurement::Kind;

/// Parts of equal sample count into which an axis is divided.
const BINS: usize = 30;

/// A part of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProfileBin {
    /// Least value of the axis in it.
    pub from: f64,
    /// Largest value of the axis in it.
    pub to: f64,
    /// Mean residual in noise units.
    pub mean: f64,
    /// Root mean square of the residual in noise units.
    pub rms: f64,
}

/// The residual of one output over one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Index of the output in the measurement.
    pub output: usize,
    /// Name of the axis, as in [`super::Finding::axis`].
    pub axis: String,
    /// Unit of the axis, `1` for a share.
    pub unit: String,
    /// Along the axis, the same number of samples in each.
    pub bins: Vec<ProfileBin>,
}

/// Every output over every axis. `velocity_unit` is that of the drive's velocity or of the process output.
pub(super) fn atlas(data: &Data, motion: &Motion, velocity_unit: &str) -> Vec<Profile> {
    profiles(data, motion, &residuals(data, motion), velocity_unit)
}

/// A series for each output, in noise units, over every axis of a motion.
pub(super) fn profiles(
    data: &Data,
    motion: &Motion,
    series: &[Vec<f64>],
    velocity_unit: &str,
) -> Vec<Profile> {
    let runs = data.runs();
    let mut profiles = Vec::new();
    for axis in axes(data, motion) {
        let mut order: Vec<usize> = runs
            .iter()
            .flat_map(|(from, to)| *from..*to)
            .filter(|i| axis.values[*i].is_finite())
            .collect();
        if order.len() < 2 * BINS {
            continue;
        }
        order.sort_by(|a, b| axis.values[*a].total_cmp(&axis.values[*b]));
        let (name, unit) = match axis.name {
            "velocity" if data.kind == Kind::Process => ("output", velocity_unit),
            "velocity" => ("velocity", velocity_unit),
            "relay_phase" => ("relay_phase", "1"),
            name => (name, "s"),
        };
        for (output, residual) in series.iter().enumerate() {
            let bins = (0..BINS)
                .filter_map(|k| {
                    let part = &order[k * order.len() / BINS..(k + 1) * order.len() / BINS];
                    let count = part.len() as f64;
                    let mean = part.iter().map(|i| residual[*i]).sum::<f64>() / count;
                    let square = part.iter().map(|i| residual[*i].powi(2)).sum::<f64>() / count;
                    Some(ProfileBin {
                        from: axis.values[*part.first()?],
                        to: axis.values[*part.last()?],
                        mean,
                        rms: square.sqrt(),
                    })
                })
                .collect();
            profiles.push(Profile {
                output,
                axis: name.to_owned(),
                unit: unit.to_owned(),
                bins,
            });
        }
    }
    profiles
}
