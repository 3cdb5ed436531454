//! What acted before the record began.

use super::output::Output;
use crate::measurement::Kind;

/// Noise within which an output is at rest at zero.
const AT_REST: f64 = 5.0;

/// Samples that tell where an output lay at first, at most, and of how many that it is watched for one is.
const FIRST: usize = 5;
const ONE_OF: usize = 20;

/// Noise by which an output must move while the input stays as it was at first, to tell when it began to.
const MOVES: f64 = 20.0;

/// Share of that way at which it has begun, and up to which it is watched; of the time until then, the share before it
/// has begun of what moves on at a steady rate. A process that was on its way, ever slower, begins sooner.
const BEGUN: f64 = 0.1;
const HALFWAY: f64 = 0.5;
const STEADY: f64 = BEGUN / HALFWAY;

/// Samples by which it must begin later than that, and the same in shares of the time for noise as large as the way.
const LATER: f64 = 1.0;
const LATER_FOR_NOISE: f64 = 4.0;

/// Share of its first value by which an input may change meanwhile.
const ABOUT: f64 = 0.5;

/// Whether nothing moved before the input came on with the record.
pub(super) fn begins_at_rest(kind: Kind, input: &[f64], outputs: &[Output]) -> bool {
    let came_on = || outputs.iter().any(|y| began_late(input, y));
    begins_at_zero(outputs) || kind == Kind::Process && came_on()
}

/// Whether a velocity, or the output of a process, is 0 at first.
pub(super) fn begins_at_zero(outputs: &[Output]) -> bool {
    let mut moving = outputs.iter().filter(|o| o.is_velocity);
    moving.all(|o| o.values[0].abs() < AT_REST * o.noise)
}

/// Whether an output lay still at first, wherever that was, and went its way later though the input stayed about as it
/// was: so that came on with the record, and the process is late.
fn began_late(input: &[f64], output: &Output) -> bool {
    // Without an input none came on: what moves then was stored before.
    if input[0] == 0.0 {
        return false;
    }
    let stays = |u: &&f64| (**u - input[0]).abs() <= ABOUT * input[0].abs();
    let held = input.iter().take_while(stays).count();
    let values = &output.values[..held.min(output.values.len())];
    let first = &values[..values.len().div_ceil(ONE_OF).min(FIRST)];
    let rest = first.iter().sum::<f64>() / first.len() as f64;
    let way = values.last().map_or(0.0, |last| last - rest);
    if way.abs() < MOVES * output.noise {
        return false;
    }
    let shares = values.iter().map(|y| (y - rest) / way);
    let coming: Vec<f64> = shares.take_while(|share| *share < HALFWAY).collect();
    let still = coming.iter().filter(|share| **share < BEGUN).count();
    // One that still goes the other way was not at rest.
    let back = coming
        .iter()
        .any(|share| *share < -BEGUN - AT_REST * output.noise / way.abs());
    let late = STEADY + LATER_FOR_NOISE * output.noise / way.abs();
    !back && still as f64 > LATER + late * coming.len() as f64
}
