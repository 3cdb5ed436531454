//! An encoder whose disc is not centred on the shaft: within a turn it shows now too much, now too little.

/// What it adds to the angle: `amplitude sin(x + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eccentricity {
    /// Share of the radius by which the disc is off, which is the largest error of the angle, rad; below 1.
    pub amplitude: f64,
    /// rad.
    pub phase: f64,
}

impl Eccentricity {
    /// What is shown of an angle and of how fast it changes.
    pub fn seen(&self, x: f64, v: f64) -> (f64, f64) {
        let (sine, cosine) = libm::sincos(x + self.phase);
        (
            x + self.amplitude * sine,
            v * (1.0 + self.amplitude * cosine),
        )
    }
}
