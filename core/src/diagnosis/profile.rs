//! The residual over an axis.

use serde::{Deserialize, Serialize};

/// A part of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProfileBin {
    /// Least value of the axis in it.
    pub from: f64,
    /// Largest value of the axis in it.
    pub to: f64,
    /// Mean residual in noise units; 0 for a band of frequencies.
    pub mean: f64,
    /// Root mean square of the residual in noise units; in a band of frequencies that of white noise with the same
    /// power there.
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
    /// Along the axis, the same number of samples in each; an axis with few values has one for each, frequencies are in
    /// equal ratios.
    #[serde(with = "packed_bins")]
    pub bins: Vec<ProfileBin>,
}

/// Bins as one packed series.
mod packed_bins {
    use serde::{Deserializer, Serializer};

    use super::ProfileBin;
    use crate::packed;

    pub fn serialize<S: Serializer>(bins: &[ProfileBin], serializer: S) -> Result<S::Ok, S::Error> {
        let flat: Vec<f64> = bins
            .iter()
            .flat_map(|b| [b.from, b.to, b.mean, b.rms])
            .collect();
        packed::serialize(&flat, serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<ProfileBin>, D::Error> {
        let flat = packed::deserialize(deserializer)?;
        let (bins, _) = flat.as_chunks::<4>();
        Ok(bins
            .iter()
            .map(|[from, to, mean, rms]| ProfileBin {
                from: *from,
                to: *to,
                mean: *mean,
                rms: *rms,
            })
            .collect())
    }
}
