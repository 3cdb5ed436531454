//! Is what is left what small random forces leave?
//!
//! A controller that is faster than the record, or a rough way, pushes a body at random between the samples. A model
//! cannot know that: the velocity goes on a random walk, whose variance grows with the time. A missing effect is told
//! from it by two things. What it leaves goes one way for a while, so that it grows faster, or comes back. And it
//! depends on the motion or on the input, so that what one half of the windows shows of that foretells something of the
//! other half.

use crate::criticism::data::Data;
use crate::criticism::fit::residuals;
use crate::criticism::motion::Motion;
use crate::criticism::output::Output;
use crate::effect::Probe;
use crate::measurement::Kind;

/// Octaves of time over which the residual must grow as it should, up to one part in so many of a usual window: a
/// position is compared over twice the time.
const OCTAVES: u32 = 3;
const VELOCITY_PART: usize = 2;
const POSITION_PART: usize = 3;

/// Growth beyond the noise, in times of it, from which on it is seen.
const SEEN: f64 = 0.05;

/// Powers of time with which the mean square may grow: of a velocity on a random walk the first, of its position the
/// third. A force that goes one way brings the second and the fourth.
const VELOCITY_POWERS: (f64, f64) = (0.3, 1.5);
const POSITION_POWERS: (f64, f64) = (1.8, 3.5);

/// Share of what is left beyond the noise that may be foretold.
const FORETOLD: f64 = 0.3;

/// Error up to which they may be what is left where the record does not tell their size.
const MOST_PUSHED: f64 = 2.5;

/// Shares of what is expected of the input that are as much: its noise is known to a third where it is smooth.
const AS_BY_INPUT: std::ops::RangeInclusive<f64> = 0.5..=1.5;

/// Whether small random forces leave what a model of a drive with this `error` (in noise units) leaves: as much as what
/// is not known of the input does (`by_input`, likewise), or up to a few times the noise, in the way in which they do;
/// `probe` gives the force that it leaves unexplained.
pub(in crate::criticism) fn is_left_by_random_forces(
    data: &Data,
    motion: &Motion,
    error: f64,
    by_input: impl FnOnce() -> f64,
    probe: impl FnOnce() -> Probe,
) -> bool {
    if data.kind != Kind::Drive || data.used() != data.len() {
        return false;
    }
    let beyond = (error * error - 1.0).max(0.0).sqrt();
    let expected = AS_BY_INPUT.contains(&(beyond / by_input().max(f64::MIN_POSITIVE)));
    (expected || error < MOST_PUSHED && grows_by_chance(data, motion))
        && !is_foretold(data, error, probe().halves())
}

/// Whether what is left grows in the windows as random forces make it grow.
fn grows_by_chance(data: &Data, motion: &Motion) -> bool {
    let residuals = residuals(data, motion);
    let walks: Vec<Option<bool>> = data
        .outputs
        .iter()
        .zip(&residuals)
        .map(|(output, residual)| walks(data, output, residual))
        .collect();
    // A position alone hides in its starting states what tells a walk from a force.
    let mut shown = data.outputs.iter().zip(&walks);
    let seen = shown.any(|(output, walks)| output.is_velocity && *walks == Some(true));
    seen && !walks.contains(&Some(false))
}

/// Whether what one half of the windows shows of the unexplained force, over the motion or the input, foretells the
/// other half.
fn is_foretold(data: &Data, error: f64, [shown, others]: [Probe; 2]) -> bool {
    let axes = [
        &data.time,
        &data.velocity_estimate(),
        &data.position_estimate(),
        &data.input,
    ];
    let beyond = (1.0 - 1.0 / (error * error)).max(f64::MIN_POSITIVE);
    let told = |axis: &&Vec<f64>| {
        let told = shown.foretells(&others, axis);
        told.is_none_or(|share| share > FORETOLD * beyond)
    };
    axes.iter().any(told)
}

/// Whether a residual grows in the windows as a random walk does; `None` where it is not seen to grow.
fn walks(data: &Data, output: &Output, residual: &[f64]) -> Option<bool> {
    let usual = data.used() / data.windows.len().max(1);
    let (longest, (least, most)) = if output.is_velocity {
        (usual / VELOCITY_PART, VELOCITY_POWERS)
    } else {
        (usual / POSITION_PART, POSITION_POWERS)
    };
    let change = |lag: usize| mean_square_change(data, output, residual, lag);
    let noise = change(1)?;
    let lags = (0..=OCTAVES).map(|octave| longest >> octave);
    let grown: Vec<f64> = lags.map_while(|lag| Some(change(lag)? - noise)).collect();
    let seen = grown.iter().take_while(|g| **g > SEEN * noise).count();
    if grown
        .first()
        .is_none_or(|longest| longest.abs() <= SEEN * noise)
    {
        return None;
    }
    let power = |pair: &[f64]| libm::log2(pair[0] / pair[1]);
    let mut powers = grown[..seen].windows(2).map(power);
    Some(seen >= 2 && powers.all(|power| least < power && power < most))
}

/// Mean square of what a residual changes by in so many samples of a window: of a position, whose window may begin with
/// a wrong velocity, of what it changes by once more.
fn mean_square_change(data: &Data, output: &Output, residual: &[f64], lag: usize) -> Option<f64> {
    let reach = if output.is_velocity { lag } else { 2 * lag };
    let (mut sum, mut count) = (0.0, 0_usize);
    for (from, to) in data.spans() {
        for i in from..to.saturating_sub(reach).max(from) {
            let places = [i, i + lag, i + reach];
            if !places.iter().all(|place| output.tells(*place)) {
                continue;
            }
            let [first, middle, last] = places.map(|place| residual[place]);
            let change = if output.is_velocity {
                last - first
            } else {
                last - 2.0 * middle + first
            };
            sum += change * change;
            count += 1;
        }
    }
    (lag > 0 && count > 0).then(|| sum / count as f64)
}
