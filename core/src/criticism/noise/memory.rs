//! Is what is left noise that remembers for some samples, as of a sensor with a filter?
//!
//! Such noise is larger than differences of neighbouring samples show, so that it looks like more than noise. It is
//! told from a missing effect by what it does not know: it forgets within a few samples, and neither its size nor its
//! mean depends on time, on the motion or on the input. (Whiteness is no requirement on a residual for a model to be
//! right, independence of the input is: Ljung, System Identification, 2nd edition, 1999, section 16.6.)

use crate::criticism::axes::{Axis, axes};
use crate::criticism::correlation::product;
use crate::criticism::data::Data;
use crate::criticism::fit::residuals;
use crate::criticism::locate::depends_on_the_motion;
use crate::criticism::motion::Motion;
use crate::criticism::output::Output;
use crate::sums::centred;

/// Samples within which it forgets, and up to which it must not remember again.
const FORGETS: usize = 6;
const NEVER_AGAIN: usize = 60;

/// Correlation that is forgotten.
const FORGOTTEN: f64 = 0.12;

/// Correlation with the input, some samples earlier or at once, that is none.
const UNRELATED: f64 = 0.15;

/// Share of its power by which the means over parts of an axis may differ, beside so many times what chance leaves.
const SAME_MEAN: f64 = 0.1;
const CHANCE: f64 = 1.5;

/// Parts of an axis.
const PARTS: usize = 20;

/// Whether the residual of every output is noise, with a memory of some samples at most.
pub(in crate::criticism) fn is_noise_with_memory(
    data: &Data,
    motion: &Motion,
    velocity_unit: &str,
) -> bool {
    if data.used() != data.len() {
        return false;
    }
    let runs = data.runs();
    // What was measured has the noise in it: at rest, it would sort the residual by its own size.
    let said = data.saying(motion);
    let axes = axes(&said, motion, velocity_unit);
    let is_noise = |(output, residual): (&Output, &Vec<f64>)| {
        let (input, _) = output.told(&data.input, &runs);
        let (told, runs) = output.told(residual, &runs);
        let input = centred(&input, &runs);
        let power = product(&told, &told, &runs, 0);
        let remembers = |lag: usize| product(&told, &told, &runs, lag) / power;
        let forgets = || (FORGETS..=NEVER_AGAIN).all(|lag| remembers(lag).abs() < FORGOTTEN);
        let powers = power * product(&input, &input, &runs, 0);
        let with = |lag: usize| product(&input, &told, &runs, lag) / powers.sqrt();
        let follows = || (0..=FORGETS).any(|lag| with(lag).abs() > UNRELATED);
        let alike = 1.0 + 2.0 * (1..FORGETS).map(|lag| remembers(lag).max(0.0)).sum::<f64>();
        let by_chance = PARTS as f64 * alike / told.len() as f64;
        let most = SAME_MEAN + CHANCE * by_chance;
        forgets()
            && !follows()
            && axes
                .iter()
                .all(|axis| power_of_means(axis, residual) < most)
    };
    let residuals = residuals(data, motion);
    data.outputs.iter().zip(&residuals).all(is_noise)
        && !depends_on_the_motion(data, motion, velocity_unit)
}

/// Share of the power of a residual that its means over the parts of an axis have.
fn power_of_means(axis: &Axis, residual: &[f64]) -> f64 {
    let Some(parts) = axis.parts(0..residual.len(), PARTS) else {
        return 0.0;
    };
    let sum = |places: &[usize]| places.iter().map(|i| residual[*i]).sum::<f64>();
    let of_means: f64 = (0..parts.len())
        .map(|k| parts.between(k, k + 1))
        .map(|places| sum(places).powi(2) / places.len().max(1) as f64)
        .sum();
    of_means
        / parts
            .order
            .iter()
            .map(|i| residual[*i].powi(2))
            .sum::<f64>()
}
