//! Dead time between the commanded and the acting input.

use super::atom::{Values, geometric};
use super::{Atom, Dimension, Effect, EffectId, ParameterSpec, Part, Probe, Range};
use crate::measurement::Kind;
use crate::model::Model;

pub(super) struct InputDelay;

/// Dead times are tried from half a sample to this share of the record.
const LONGEST_SHARE: f64 = 0.1;

/// Samples of a drive of which that share counts.
const SEEN: f64 = 1000.0;

/// Starting values that cover that span evenly on a log scale.
const STARTS: u32 = 12;

/// Dead times that a regression tries.
const DELAYS: usize = 24;

/// The input so many samples late, as the mean over each sample of what is held.
fn delayed(input: &[f64], samples: f64) -> Vec<f64> {
    let (whole, part) = (samples.floor(), samples - samples.floor());
    let at = |k: usize, back: usize| input[k.saturating_sub(back)];
    let back = whole as usize;
    (0..input.len())
        .map(|k| (1.0 - part) * at(k, back) + part * at(k, back + 1))
        .collect()
}

impl Effect for InputDelay {
    fn id(&self) -> EffectId {
        EffectId::new("input_delay")
    }

    fn name(&self) -> &'static str {
        "Input delay"
    }

    fn sentence(&self) -> &'static str {
        "The command takes effect a fixed time after it was given: nothing happens, then all of it."
    }

    fn equation(&self) -> &'static str {
        "u_acting(t) = u(t - tau)"
    }

    fn source(&self) -> &'static str {
        "dead time L of the plant: Åström and Hägglund, Advanced PID Control, 2006"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[ParameterSpec {
            symbol: "tau",
            label: "dead time",
            dimension: Dimension::Time,
            range: Range::Late,
        }]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let shortest = 0.5 * probe.scales.step;
        let seen = match probe.kind {
            // Its windows begin anew with a state of their own.
            Kind::Drive => probe.scales.duration.min(SEEN * probe.scales.step),
            Kind::Process => probe.scales.duration,
        };
        let longest = LONGEST_SHARE * seen;
        let ratio = libm::pow((longest / shortest).max(1.0), 1.0 / f64::from(STARTS - 1));
        (0..STARTS)
            .map(|i| vec![shortest * libm::pow(ratio, f64::from(i))])
            .collect()
    }

    /// An input that is taken from ahead by more than it is late is not late.
    fn is_between_samples(&self, values: &[f64], model: &Model, step: f64) -> bool {
        values[0] <= model.next_input * step
    }

    fn atoms(&self, _: Kind) -> Vec<Atom> {
        const COLUMNS: &[Part] = &[Part::Input(|track, delay| {
            delayed(track.input, delay[0] / track.step)
        })];
        vec![Atom {
            parts: COLUMNS,
            grid: |extent| geometric(0.5 * extent.step, 0.5 * extent.window, DELAYS),
            shapes: 1,
            values: Values::Shape,
        }]
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        model.delay += values[0];
    }
}
