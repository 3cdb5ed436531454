//! What a record gives away of a gap before any fit.

use crate::backlash::{Quality, sighted};
use crate::effect::{GapLoad, SeenGap};
use crate::measurement::{Kind, Measurement};
use crate::model::SeenLoad;

/// Tolerance of a half gap that was felt in its standard errors, and the least of these as a share of it.
const GAP_TOLERANCE: f64 = 3.0;
const LEAST_GAP_ERROR: f64 = 0.01;

/// The half gap that contacts tell, with a tolerance wide enough to add little to what a fit sees of it, so that
/// it only keeps a trial from losing the contacts.
pub(super) fn felt_gap(gap: SeenGap) -> (f64, f64) {
    let error = gap.error.max(LEAST_GAP_ERROR * gap.half_gap);
    (gap.half_gap, GAP_TOLERANCE * error)
}

/// What the motor's columns give away of a load behind a gap, if they are those of a drifting test.
#[derive(Default)]
pub(super) struct Sighted {
    pub gap: Option<SeenGap>,
    /// The load behind it.
    pub seen: Option<SeenLoad>,
    /// When the motor met the load where it met one end only, s, in order.
    pub contacts: Vec<f64>,
}

pub(super) fn sight(measurement: &Measurement) -> Sighted {
    if measurement.kind != Kind::Drive {
        return Sighted::default();
    }
    let Ok((estimate, seen)) = sighted(measurement) else {
        return Sighted::default();
    };
    let load = seen.as_ref().map(|seen| GapLoad {
        inertia_ratio: 1.0 / seen.play().ratio,
        viscous: seen.play().slowing.viscous,
        dry: seen.play().slowing.dry,
        push: seen.usual_push(),
        errors: seen.errors(),
    });
    let gap = estimate.gap.map(|gap| SeenGap {
        half_gap: 0.5 * gap,
        error: 0.5 * estimate.std_error.unwrap_or(0.0),
        load,
    });
    // Where something else disturbs the cycle, what was felt need not be a load.
    let is_load = !matches!(
        estimate.quality,
        Quality::Disturbed
            | Quality::NoEngagement
            | Quality::TooFewSamples
            | Quality::NoDriftingTest
    );
    let contacts = estimate.contacts.iter().filter(|_| is_load);
    Sighted {
        gap,
        seen: seen.filter(|_| gap.is_some()),
        contacts: contacts.map(|c| c.time).collect(),
    }
}
