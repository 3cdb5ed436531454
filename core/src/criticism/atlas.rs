//! The residual over every axis on which a model can fail: small curves for pictures.

use super::axes::{Axis, Parts, axes};
use super::data::Data;
use super::fit::residuals;
use super::motion::Motion;
use super::spectrum::Spectrum;
use crate::diagnosis::{Profile, ProfileBin};

/// Parts of equal sample count into which an axis is divided.
const BINS: usize = 30;

/// Every output over every axis. `velocity_unit` is that of the drive's velocity or of the process output.
pub(super) fn atlas(data: &Data, motion: &Motion, velocity_unit: &str) -> Vec<Profile> {
    let residuals = residuals(data, motion);
    let mut profiles = Places::new(data, motion, velocity_unit).profiles(&residuals);
    for (output, (channel, residual)) in data.outputs.iter().zip(&residuals).enumerate() {
        if let Some(spectrum) = Spectrum::of(data, &channel.values, residual) {
            profiles.push(Profile {
                output,
                axis: "frequency".to_owned(),
                unit: "Hz".to_owned(),
                bins: spectrum.profile(),
            });
        }
    }
    profiles
}

/// The parts of every axis of a motion.
pub(super) struct Places(Vec<(Axis, Parts)>);

impl Places {
    pub fn new(data: &Data, motion: &Motion, velocity_unit: &str) -> Self {
        let runs = data.runs();
        let used = || runs.iter().flat_map(|(from, to)| *from..*to);
        let axes = axes(data, motion, velocity_unit).into_iter();
        Self(
            axes.filter_map(|axis| axis.parts(used(), BINS).map(|parts| (axis, parts)))
                .collect(),
        )
    }

    /// A series for each output, in noise units, over every axis.
    pub fn profiles(&self, series: &[Vec<f64>]) -> Vec<Profile> {
        let mut profiles = Vec::new();
        for (axis, parts) in &self.0 {
            for (output, residual) in series.iter().enumerate() {
                profiles.push(Profile {
                    output,
                    axis: axis.name.to_owned(),
                    unit: axis.unit.clone(),
                    bins: (0..parts.len())
                        .filter_map(|k| bin(axis, parts.between(k, k + 1), residual))
                        .collect(),
                });
            }
        }
        profiles
    }
}

/// What a residual is in a part of an axis.
fn bin(axis: &Axis, part: &[usize], residual: &[f64]) -> Option<ProfileBin> {
    let count = part.len() as f64;
    let mean = part.iter().map(|i| residual[*i]).sum::<f64>() / count;
    let square = part.iter().map(|i| residual[*i].powi(2)).sum::<f64>() / count;
    Some(ProfileBin {
        from: axis.values[*part.first()?],
        to: axis.values[*part.last()?],
        mean,
        rms: square.sqrt(),
    })
}
