//! Plants to begin with.

use super::TransferFunction;

/// A plant to explore.
pub struct Preset {
    /// Its name.
    pub name: &'static str,
    /// One sentence about it.
    pub sentence: &'static str,
    /// The plant.
    pub plant: TransferFunction,
}

/// The plants that *Explore* offers.
pub fn presets() -> Vec<Preset> {
    let preset = |name, sentence, numerator: &[f64], denominator: &[f64], dead_time| Preset {
        name,
        sentence,
        plant: TransferFunction::new(numerator, denominator, dead_time),
    };
    vec![
        preset(
            "Third-order lag",
            "Three equal first-order lags in series.",
            &[1.0],
            &[1.0, 3.0, 3.0, 1.0],
            0.0,
        ),
        preset(
            "Fourth-order lag",
            "Four equal first-order lags in series.",
            &[1.0],
            &[1.0, 4.0, 6.0, 4.0, 1.0],
            0.0,
        ),
        preset(
            "Lag with dead time",
            "One storage behind a transport belt.",
            &[1.0],
            &[1.0, 1.0],
            0.5,
        ),
        preset(
            "Integrator with lags",
            "A positioning drive.",
            &[1.0],
            &[1.0, 3.0, 2.0, 0.0],
            0.0,
        ),
        preset(
            "Resonant",
            "A storage and a weakly damped oscillation.",
            &[4.0],
            &[1.0, 1.8, 4.8, 4.0],
            0.0,
        ),
        preset(
            "Non-minimum phase",
            "It first moves the wrong way.",
            &[-1.0, 1.0],
            &[1.0, 2.0, 1.0],
            0.0,
        ),
    ]
}
