//! Everything about one relay loop, for drawing: prediction beside simulation.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use crate::limit_cycle::{
    Cycle, Intersection, describing_function, exact_cycle, typical_frequency,
};
use crate::plant::{PlantError, TransferFunction, presets};
use crate::relay::{Relay, RelayError};
use crate::simulate::simulate;

/// A relay loop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExploreInput {
    /// The plant.
    pub plant: TransferFunction,
    /// The relay.
    pub relay: Relay,
}

impl Default for ExploreInput {
    fn default() -> Self {
        let plant = presets().into_iter().next().map(|p| p.plant);
        Self {
            plant: plant.unwrap_or_else(|| TransferFunction::new(&[1.0], &[1.0, 1.0], 0.0)),
            relay: Relay::default(),
        }
    }
}

/// Why a loop cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExploreError {
    /// The plant.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// The relay.
    #[error(transparent)]
    Relay(#[from] RelayError),
}

/// What there is to see.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExploreData {
    /// Nyquist curve `P(jw)` with all delays, as real and imaginary parts.
    pub nyquist: Vec<[f64; 2]>,
    /// `-1/N(a)`, the same way.
    pub inverse_df: Vec<[f64; 2]>,
    /// Where they meet.
    pub intersections: Vec<Intersection>,
    /// The exact cycle nearest to the prediction.
    pub exact: Option<Cycle>,
    /// The cycle into which the simulation settles.
    pub simulated: Option<Cycle>,
    /// The answer in a sentence.
    pub text: String,
    /// Times of the simulation, s.
    pub time: Vec<f64>,
    /// Output.
    pub output: Vec<f64>,
    /// Acting input, `[t, u]` at the corners of its steps.
    pub input: Vec<[f64; 2]>,
    /// Output against its derivative.
    pub phase: Vec<[f64; 2]>,
    /// The last period of that.
    pub cycle: Vec<[f64; 2]>,
}

/// Points of the Nyquist curve.
const NYQUIST_POINTS: usize = 600;

/// Periods that are simulated, and samples in each.
const PERIODS: f64 = 14.0;
const SAMPLES_PER_PERIOD: f64 = 128.0;

/// Swings of the last cycles that may differ by this share and still count as settled.
const SETTLED: f64 = 1e-3;

/// Computes everything; the same input gives the same data.
pub fn compute(input: &ExploreInput) -> Result<ExploreData, ExploreError> {
    input.plant.validate()?;
    input.relay.validate()?;
    let (plant, relay) = (&input.plant, &input.relay);
    let lag = plant.dead_time + relay.delay;
    let intersections = describing_function(plant, relay);
    let dominant = intersections
        .iter()
        .find(|i| i.cycle.stable == Some(true))
        .or(intersections.first());
    let space = plant.state_space();
    let guess = dominant.map_or(10.0 / typical_frequency(plant) + 2.0 * lag, |i| {
        i.cycle.period
    });
    let exact = exact_cycle(&space, relay, lag, 0.5 * guess).map(|c| c.cycle);
    let period = exact.map_or(guess, |c| c.period);
    let step = period / SAMPLES_PER_PERIOD;
    let run = simulate(
        &space,
        relay,
        lag,
        step,
        (PERIODS * SAMPLES_PER_PERIOD) as usize,
    );
    let simulated = settled(&run);
    let phase: Vec<[f64; 2]> = run
        .output
        .iter()
        .zip(&run.slope)
        .map(|(y, v)| [*y, *v])
        .collect();
    let last = (simulated.map_or(period, |c| c.period) / step).ceil() as usize + 1;
    let cycle = phase[phase.len().saturating_sub(last)..].to_vec();
    let end = run.time.last().copied().unwrap_or(0.0);
    let text = sentence(simulated, exact, run.chattering);
    Ok(ExploreData {
        nyquist: nyquist(
            plant,
            relay.delay,
            dominant.map_or(typical_frequency(plant), |i| i.omega),
        ),
        inverse_df: inverse_df(relay, dominant),
        intersections,
        exact,
        simulated,
        text,
        input: corners(&run.input, end),
        time: run.time,
        output: run.output,
        phase,
        cycle,
    })
}

/// Period and amplitude of the last cycle, if the run has settled into one.
fn settled(run: &crate::simulate::Trajectory) -> Option<Cycle> {
    let [.., a, b, c] = run.rises.as_slice() else {
        return None;
    };
    let [.., before, last] = run.swings.as_slice() else {
        return None;
    };
    let (period, amplitude) = (c - b, 0.5 * (last[1] - last[0]));
    let calm = ((b - a) / period - 1.0).abs() < SETTLED
        && ((before[1] - before[0]) / (2.0 * amplitude) - 1.0).abs() < SETTLED;
    calm.then_some(Cycle {
        period,
        amplitude,
        stable: Some(true),
    })
}

fn sentence(simulated: Option<Cycle>, exact: Option<Cycle>, chattering: bool) -> String {
    match (simulated, exact) {
        _ if chattering => {
            "The relay chatters: it switches without end, the output slides along the threshold."
                .to_owned()
        }
        (Some(c), _) => format!(
            "It oscillates: period {:.3} s, amplitude {:.4}.",
            c.period, c.amplitude
        ),
        (None, Some(c)) => format!(
            "It approaches an oscillation: period {:.3} s, amplitude {:.4}.",
            c.period, c.amplitude
        ),
        (None, None) => {
            "It does not settle into an oscillation: the relay never comes back, or not regularly."
                .to_owned()
        }
    }
}

fn nyquist(plant: &TransferFunction, delay: f64, centre: f64) -> Vec<[f64; 2]> {
    (0..NYQUIST_POINTS)
        .map(|i| {
            let w = centre * 10_f64.powf(-2.0 + 3.5 * i as f64 / (NYQUIST_POINTS - 1) as f64);
            let p = plant.response(w) * Complex::from_polar(1.0, -w * delay);
            [p.re, p.im]
        })
        .filter(|p| p[0].is_finite() && p[1].is_finite())
        .collect()
}

/// `-1/N(a)` from the smallest amplitude to twice the predicted one.
fn inverse_df(relay: &Relay, dominant: Option<&Intersection>) -> Vec<[f64; 2]> {
    let reach = dominant.map_or(4.0 * relay.hysteresis.max(relay.gain), |i| {
        2.5 * i.cycle.amplitude
    });
    let largest = reach.max(1.5 * relay.hysteresis);
    [relay.hysteresis, largest]
        .map(|a| relay.inverse_describing_function(a))
        .to_vec()
}

/// Corners of a step curve.
fn corners(changes: &[[f64; 2]], end: f64) -> Vec<[f64; 2]> {
    let mut points = Vec::with_capacity(2 * changes.len() + 1);
    for (i, [t, u]) in changes.iter().enumerate() {
        if let Some([_, before]) = i.checked_sub(1).map(|j| changes[j]) {
            points.push([*t, before]);
        }
        points.push([*t, *u]);
    }
    if let Some([_, u]) = changes.last() {
        points.push([end, *u]);
    }
    points
}
