//! What of a motion is left where the input is not known exactly: by the noise of its sensor, or by what it did between
//! two samples.
//!
//! Differences of an input that a smooth course cannot have say how large that is. As a random force on the body it
//! makes the velocity go on a random walk in each window, beside the state in which that begins.

use super::level::noise_level;
use crate::criticism::data::Data;
use crate::criticism::window::bend_within;
use crate::model::Model;
use crate::random::dither;

/// Root mean square, in noise units, of what a body of this model is pushed off its way by what is not known of the
/// input, and of its levels.
pub(in crate::criticism) fn left_by_input(data: &Data, levels: f64, body: &Model) -> f64 {
    let unknown = libm::hypot(noise_level(&data.input, &vec![0.0; data.len()]), levels);
    // Evenly spread, of variance 1.
    let chance = |i: usize| 12.0_f64.sqrt() * (dither(i) - 0.5);
    let (mut velocity, mut position) = (vec![0.0; data.len()], vec![0.0; data.len()]);
    for (from, to) in data.spans() {
        let (mut v, mut x) = (0.0, 0.0);
        for i in from..to {
            (velocity[i], position[i]) = (v, x);
            let step = data.time.get(i + 1).map_or(0.0, |next| next - data.time[i]);
            let kept = libm::exp(-body.viscous * step / body.inertia);
            x += step * v;
            v = kept * v + step * unknown * chance(i) / body.inertia;
        }
    }
    let pushed = data.outputs.iter().map(|output| {
        let values = if output.is_velocity {
            &velocity
        } else {
            &position
        };
        let windows = data.spans().into_iter();
        windows
            .map(|(from, to)| bend_within(output, &values[from..to]))
            .sum::<f64>()
    });
    let count = data.outputs.len() * data.used();
    (pushed.sum::<f64>() / count.max(1) as f64).sqrt()
}
