//! A disturbance that comes back: day and night, a compressor, an unbalanced fan.

use std::f64::consts::TAU;

use super::atom::even;
use super::cogging::wave;
use super::spec::SEEN_PERIODS;
use super::{Dimension, Effect, EffectId, ParameterSpec, Probe, Range, Shape};
use crate::measurement::Kind;
use crate::model::{Instant, Model};

pub(super) const ID: EffectId = EffectId::new("periodic_disturbance");

pub(super) struct PeriodicDisturbance;

/// Waves in the record: at least so many, or nothing has come back twice and it may be any drift, at most so many, and
/// so many frequencies for each.
const LEAST_WAVES: f64 = SEEN_PERIODS;
const MOST_WAVES: f64 = 60.0;
const FREQUENCIES_PER_WAVE: f64 = 2.0;

/// Samples in the shortest wave.
const LEAST_SAMPLES: f64 = 8.0;

/// Angular frequencies, rad/s, that a record of this duration and step tells apart.
fn frequencies(duration: f64, step: f64) -> Vec<Shape> {
    let shortest = LEAST_SAMPLES * step / duration;
    let most = MOST_WAVES.min(1.0 / shortest);
    let wave = TAU / duration;
    let count = (most - LEAST_WAVES) * FREQUENCIES_PER_WAVE;
    even(LEAST_WAVES * wave, most * wave, count.max(0.0) as usize + 1)
}

/// Amplitude, period and phase of a disturbance of an angular frequency with these parts.
fn disturbance(frequency: f64, sine: f64, cosine: f64) -> Vec<f64> {
    let [amplitude, phase] = wave(sine, cosine);
    vec![amplitude, TAU / frequency, phase]
}

impl Effect for PeriodicDisturbance {
    fn id(&self) -> EffectId {
        ID
    }

    fn name(&self) -> &'static str {
        "Periodic disturbance"
    }

    fn sentence(&self) -> &'static str {
        "Something else pushes to and fro at its own pace, like day and night or a machine next door."
    }

    fn equation(&self) -> &'static str {
        "F = a sin(2 pi t / P + phi)"
    }

    fn source(&self) -> &'static str {
        "sinusoidal disturbance: Francis and Wonham, The internal model principle, 1976"
    }

    fn kinds(&self) -> &'static [Kind] {
        &[Kind::Drive, Kind::Process]
    }

    fn parameters(&self) -> &'static [ParameterSpec] {
        &[
            ParameterSpec {
                symbol: "a",
                label: "amplitude of the disturbance",
                dimension: Dimension::Force,
                range: Range::NonNegative,
            },
            ParameterSpec {
                symbol: "P",
                label: "period",
                dimension: Dimension::Time,
                range: Range::Recurring,
            },
            ParameterSpec {
                symbol: "phi",
                label: "phase at the first sample",
                dimension: Dimension::Phase,
                range: Range::Signed,
            },
        ]
    }

    fn starts(&self, probe: &Probe, _share: f64) -> Vec<Vec<f64>> {
        let frequencies = frequencies(probe.scales.duration, probe.scales.step);
        let at = |m: &Instant, w: f64| [libm::sin(w * m.time), libm::cos(w * m.time)];
        let best = probe.best_waves(&frequencies, at).into_iter();
        best.map(|(w, [sine, cosine])| disturbance(w, sine, cosine))
            .collect()
    }

    fn apply(&self, values: &[f64], model: &mut Model) {
        let (amplitude, period, phase) = (values[0], values[1], values[2]);
        model.own_forces.push(Box::new(move |now| {
            amplitude * libm::sin(TAU * now.time / period + phase)
        }));
    }
}
