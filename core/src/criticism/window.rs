//! How long may a drive run before it restarts from an estimated state?
//!
//! A window tells of forces by how far the motion bends within it: a velocity from a constant, a position from
//! a straight line, since the starting state takes up the rest. The position integrates, so that long windows
//! would drown an effect in drift; where samples come fast or the encoder is coarse, short ones show nothing
//! but noise. So a window is short as long as the motion in it stands well above the noise.

use super::output::Output;

/// Samples of the shortest window; a few relay periods fit in.
pub(super) const SHORTEST: usize = 250;

/// How far the motion must bend in a window, root mean square in noise units: some thousandths of the force are
/// then seen in it.
const CLEARLY_BENT: f64 = 50.0;

/// Samples per window of a drive with these outputs, at most `longest`.
pub(super) fn drive_window(outputs: &[Output], longest: usize) -> usize {
    let clear = |length: usize| outputs.iter().any(|o| bend(o, length) > CLEARLY_BENT);
    let mut length = SHORTEST;
    while length < longest && !clear(length) {
        length *= 2;
    }
    length.min(longest)
}

/// Root mean square, in noise units, of what is left of an output in windows of this length without its mean,
/// and of a position without its slope.
fn bend(output: &Output, length: usize) -> f64 {
    let windows = output.values.len() / length;
    let squares = output.values.chunks_exact(length);
    let squares = squares.map(|window| bend_within(output, window));
    if windows > 0 {
        (squares.sum::<f64>() / (windows * length) as f64).sqrt()
    } else {
        0.0
    }
}

/// Sum of squares of the same in a window of what such an output shows, in its noise units.
pub(super) fn bend_within(output: &Output, window: &[f64]) -> f64 {
    let n = window.len() as f64;
    let middle = (n - 1.0) / 2.0;
    // Sum of the squared distances from the middle.
    let spread = n * (n * n - 1.0) / 12.0;
    let mean = window.iter().sum::<f64>() / n;
    let tilt: f64 = window
        .iter()
        .enumerate()
        .map(|(k, v)| (k as f64 - middle) * (v - mean))
        .sum();
    let total: f64 = window.iter().map(|v| (v - mean).powi(2)).sum();
    let straight = if output.is_velocity || spread == 0.0 {
        0.0
    } else {
        tilt * tilt / spread
    };
    (total - straight).max(0.0) / output.noise.powi(2)
}
