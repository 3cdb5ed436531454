//! The relay experiment: the plant is put under a relay until it oscillates evenly, then measured.
//!
//! The instrument is ideal. It takes the switching instants of the settled cycle from the simulation,
//! rebuilds the output between them with the plant's exact flow, and integrates that, so that what a
//! tuning rule gets wrong is the rule's error and not the sampling's.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::error::TuningError;
use super::linear::held;
use crate::limit_cycle::{describing_function, typical_frequency};
use crate::plant::{StateSpace, TransferFunction};
use crate::relay::Relay;
use crate::simulate::{Cut, Trajectory, simulate};

/// Lengths of an experiment that are tried in turn, in periods.
const PERIODS: [usize; 3] = [40, 160, 640];

/// Samples in a period.
const SAMPLES: usize = 64;

/// Relative difference of two successive half periods of the same kind below which a cycle has settled;
/// switching instants are known to some 1e-12.
const SETTLED: f64 = 1e-10;

/// What still counts as settled after the longest experiment.
const NEARLY_SETTLED: f64 = 1e-6;

/// Intervals of a half period that are integrated; a multiple of 4 for Boole's rule.
const INTERVALS: usize = 128;

/// Halvings of an interval around an extremum: its value is then known to the last bits, since the
/// error of the value goes with the square of that of the time.
const HALVINGS: usize = 24;

/// Periods of a run that are kept for drawing.
const SHOWN_PERIODS: f64 = 10.0;

/// A run of the experiment, for drawing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Times, s.
    pub time: Vec<f64>,
    /// Output of the plant at these times.
    pub output: Vec<f64>,
    /// Input that acts on the plant, `[t, u]` at each change.
    pub input: Vec<[f64; 2]>,
}

/// A relay experiment and what was measured in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelayTest {
    /// The relay.
    pub relay: Relay,
    /// Period, s.
    pub period: f64,
    /// Amplitude of the output, half of peak to peak.
    pub amplitude: f64,
    /// Time within a period with the relay up, s.
    pub on_time: f64,
    /// Time with the relay down, s.
    pub off_time: f64,
    /// Integral of the output over a period, unit of the output times s.
    pub output_integral: f64,
    /// Integral of the input over a period, unit of the input times s.
    pub input_integral: f64,
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Point of the Nyquist curve by the describing function, `-1/N(a)`, equation (6).
    pub point: [f64; 2],
    /// The same point as the ratio of the first Fourier coefficients of output and input: exact.
    pub fourier_point: [f64; 2],
    /// The run from rest.
    pub run: Run,
}

impl RelayTest {
    /// Puts a valid `plant` under a valid `relay` and measures the settled cycle.
    ///
    /// # Errors
    /// [`TuningError::Chattering`], [`TuningError::TooFast`], or [`TuningError::NoOscillation`] where the cycle does
    /// not come to repeat itself with two switches a period.
    pub fn run(plant: &TransferFunction, relay: &Relay) -> Result<Self, TuningError> {
        let space = plant.state_space();
        let lag = plant.dead_time + relay.delay;
        let mut period = guess(plant, relay);
        let mut duration = 0.0;
        for (attempt, periods) in PERIODS.into_iter().enumerate() {
            let step = period / SAMPLES as f64;
            let run = simulate(&space, relay, lag, step, periods * SAMPLES);
            // Sliding to the end is chattering without limit.
            let end = step * (periods * SAMPLES - 1) as f64;
            let slides = run.sliding.last().is_some_and(|s| s[1] >= end);
            if run.cut == Some(Cut::TooFast) {
                return Err(TuningError::TooFast);
            }
            if run.cut == Some(Cut::Chattering) || slides {
                return Err(TuningError::Chattering {
                    hysteresis: relay.hysteresis,
                });
            }
            duration = period * periods as f64;
            let Some(cycle) = Cycle::last(&run) else {
                // Slower than thought, or not at all.
                period *= 8.0;
                continue;
            };
            // A grid that is too coarse may step over two crossings at once.
            let fine = cycle.period() > 0.4 * SAMPLES as f64 * step;
            period = cycle.period();
            let last = attempt + 1 == PERIODS.len();
            if fine && (cycle.change < SETTLED || (last && cycle.change < NEARLY_SETTLED)) {
                return measure(&space, relay, lag, &run, &cycle);
            }
        }
        Err(TuningError::NoOscillation {
            duration,
            gain: relay.gain,
            hysteresis: relay.hysteresis,
        })
    }

    /// Integral of the output over that of the input: the static gain; `None` for an integrating plant,
    /// whose input has no mean in a settled cycle.
    pub fn static_gain(&self) -> Option<f64> {
        let pushed = self.relay.gain * self.period;
        (self.input_integral.abs() > 1e-6 * pushed)
            .then(|| self.output_integral / self.input_integral)
    }
}

/// Period to start with, s.
fn guess(plant: &TransferFunction, relay: &Relay) -> f64 {
    let symmetric = Relay {
        asymmetry: 0.0,
        bias: 0.0,
        ..*relay
    };
    let found = describing_function(plant, &symmetric);
    found
        .iter()
        .find(|i| i.cycle.stable == Some(true))
        .or(found.first())
        .map_or_else(
            || 2.0 * PI / typical_frequency(plant) + 4.0 * (plant.dead_time + relay.delay),
            |i| i.cycle.period,
        )
}

/// The last period of a run: the input's changes that bound it and divide it.
struct Cycle {
    /// Start, change and end, s.
    times: [f64; 3],
    /// Input in the first and second part.
    inputs: [f64; 2],
    /// Relative difference to the period before.
    change: f64,
}

impl Cycle {
    fn last(run: &Trajectory) -> Option<Self> {
        let [.., a, b, c, d, e] = run.input.as_slice() else {
            return None;
        };
        let period = e[0] - c[0];
        let change = ((e[0] - d[0]) - (c[0] - b[0]))
            .abs()
            .max(((d[0] - c[0]) - (b[0] - a[0])).abs());
        (period > 0.0).then(|| Self {
            times: [c[0], d[0], e[0]],
            inputs: [c[1], d[1]],
            change: change / period,
        })
    }

    fn period(&self) -> f64 {
        self.times[2] - self.times[0]
    }

    fn spans(&self) -> [f64; 2] {
        [self.times[1] - self.times[0], self.times[2] - self.times[1]]
    }
}

/// The state at the start of a settled cycle: it must come back after a period, and the output must
/// agree with the samples in between (which also fixes the offset of an integrator, that comes back
/// from anywhere). Solved together by least squares.
fn periodic_state(space: &StateSpace, cycle: &Cycle, run: &Trajectory) -> Option<DVector<f64>> {
    let n = space.b.len();
    let [first, second] = cycle.spans();
    let ([phi1, phi2], [gamma1, gamma2]) = {
        let (a, b) = held(space, first);
        let (c, d) = held(space, second);
        ([a, c], [b, d])
    };
    let samples: Vec<usize> = {
        let from = run.time.partition_point(|t| *t < cycle.times[0]);
        let to = run.time.partition_point(|t| *t <= cycle.times[2]);
        let stride = (to.saturating_sub(from) / (2 * n + 2)).max(1);
        (from..to).step_by(stride).collect()
    };
    let mut rows = DMatrix::zeros(n + samples.len(), n);
    let mut right = DVector::zeros(n + samples.len());
    rows.view_mut((0, 0), (n, n))
        .copy_from(&(DMatrix::identity(n, n) - &phi2 * &phi1));
    right
        .rows_mut(0, n)
        .copy_from(&(&phi2 * &gamma1 * cycle.inputs[0] + gamma2 * cycle.inputs[1]));
    for (i, sample) in samples.iter().enumerate() {
        let t = run.time[*sample];
        let (row, forced) = if t <= cycle.times[1] {
            let (phi, gamma) = held(space, t - cycle.times[0]);
            (phi, gamma * cycle.inputs[0])
        } else {
            let (phi, gamma) = held(space, t - cycle.times[1]);
            let forced = &phi * &gamma1 * cycle.inputs[0] + gamma * cycle.inputs[1];
            (phi * &phi1, forced)
        };
        rows.row_mut(n + i).copy_from(&(space.c.transpose() * row));
        right[n + i] = run.output[*sample] - space.c.dot(&forced);
    }
    if rows.iter().chain(right.iter()).any(|v| !v.is_finite()) {
        return None;
    }
    let svd = nalgebra::SVD::try_new(rows, true, true, f64::EPSILON, 10_000)?;
    let tolerance = 1e-14 * svd.singular_values.max();
    svd.solve(&right, tolerance).ok()
}

/// Weights of Boole's rule, times 45/2.
const BOOLE: [f64; 4] = [14.0, 32.0, 12.0, 32.0];

fn measure(
    space: &StateSpace,
    relay: &Relay,
    lag: f64,
    run: &Trajectory,
    cycle: &Cycle,
) -> Result<RelayTest, TuningError> {
    let broken = || TuningError::NotFinite("the measured cycle".into());
    let mut x = periodic_state(space, cycle, run).ok_or_else(broken)?;
    let period = cycle.period();
    let omega = 2.0 * PI / period;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut output_integral = 0.0;
    let (mut y_harmonic, mut u_harmonic) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
    let mut start = 0.0;
    for (span, u) in cycle.spans().into_iter().zip(cycle.inputs) {
        let step = span / INTERVALS as f64;
        let (phi, gamma) = held(space, step);
        let slope = |x: &DVector<f64>| space.c.dot(&(&space.a * x + &space.b * u));
        for i in 0..=INTERVALS {
            let y = space.c.dot(&x);
            (low, high) = (low.min(y), high.max(y));
            let ends = i == 0 || i == INTERVALS;
            let weight = 2.0 / 45.0 * step * if ends { 7.0 } else { BOOLE[i % 4] };
            output_integral += weight * y;
            let t = start + step * i as f64;
            y_harmonic += Complex::from_polar(weight * y, -omega * t);
            if i == INTERVALS {
                break;
            }
            let next = &phi * &x + &gamma * u;
            if slope(&x) * slope(&next) < 0.0 {
                let y = extremum(space, &x, u, step);
                (low, high) = (low.min(y), high.max(y));
            }
            x = next;
        }
        // Integral of u e^(-jwt) over the part, in closed form.
        let edge = |t: f64| Complex::from_polar(1.0, -omega * t);
        u_harmonic += (edge(start) - edge(start + span)) * u / Complex::new(0.0, omega);
        start += span;
    }
    // The input acts `lag` after the switch; the plant's dead time belongs to the plant.
    let point = y_harmonic / u_harmonic * Complex::from_polar(1.0, -omega * lag);
    let amplitude = 0.5 * (high - low);
    let [first, second] = cycle.spans();
    let up_first = cycle.inputs[0] > cycle.inputs[1];
    let (on_time, off_time) = if up_first {
        (first, second)
    } else {
        (second, first)
    };
    let finite = amplitude.is_finite() && amplitude > 0.0 && point.re.is_finite();
    if !finite {
        return Err(broken());
    }
    Ok(RelayTest {
        relay: *relay,
        period,
        amplitude,
        on_time,
        off_time,
        output_integral,
        input_integral: first * cycle.inputs[0] + second * cycle.inputs[1],
        omega,
        point: relay.inverse_describing_function(amplitude),
        fourier_point: [point.re, point.im],
        run: shown(run, period),
    })
}

/// Output at its extremum within `step` seconds from `x`.
fn extremum(space: &StateSpace, x: &DVector<f64>, u: f64, step: f64) -> f64 {
    let mut x = x.clone();
    let mut span = step;
    let slope = |x: &DVector<f64>| space.c.dot(&(&space.a * x + &space.b * u));
    let rising = slope(&x) > 0.0;
    for _ in 0..HALVINGS {
        span *= 0.5;
        let (phi, gamma) = held(space, span);
        let middle = phi * &x + gamma * u;
        if (slope(&middle) > 0.0) == rising {
            x = middle;
        }
    }
    space.c.dot(&x)
}

/// The beginning of a run.
fn shown(run: &Trajectory, period: f64) -> Run {
    let end = SHOWN_PERIODS * period;
    let count = run.time.partition_point(|t| *t <= end);
    Run {
        time: run.time[..count].to_vec(),
        output: run.output[..count].to_vec(),
        input: run.input.iter().filter(|c| c[0] <= end).copied().collect(),
    }
}
