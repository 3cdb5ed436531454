//! The loop with the tuned controller: step of the set point, and of a load at the plant's input.
//!
//! Controller and plant without its dead time are one linear system `z' = F z + B v + G`, moved by its
//! matrix exponential. `v` is the control signal one dead time ago. The step divides the dead time, so
//! that every jump and kink (which travel round the loop, one dead time each) falls on a grid point;
//! between grid points `v` is the cubic through its values and slopes at both ends, which are known
//! exactly from the state, taken from the inside. The error falls with the fourth power of the step;
//! without dead time there is none.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::controller::Pid;
use super::error::{TuningError, check};
use super::linear::polynomial;
use super::margins::{Margins, margins, nyquist, unstable_poles};
use super::scan::product;
use crate::plant::TransferFunction;

/// Most steps of a simulation: a dead time shorter than this share of the horizon is replaced.
const MOST_STEPS: f64 = 40_000.0;

/// Points that are kept for drawing.
const POINTS: usize = 400;

/// Share of the step within which the output must stay to have settled.
const BAND: f64 = 0.02;

/// Outputs beyond this multiple of the step end the simulation of an unstable loop.
const RUNAWAY: f64 = 1e3;

/// What happens to the loop at time 0, from rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Disturbance {
    /// The set point steps from 0 to 1.
    SetPoint,
    /// A load of 1 is added to the control signal, at the plant's input.
    Load,
}

/// The loop's answer to a step of 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Response {
    /// Times, s, evenly spaced.
    pub time: Vec<f64>,
    /// Output of the plant.
    pub output: Vec<f64>,
    /// Control signal.
    pub input: Vec<f64>,
    /// Integral of the absolute control error over the horizon, unit of the output times s.
    pub iae: f64,
    /// Largest absolute output.
    pub peak: f64,
    /// How far a step of the set point is overshot, as a share of its final value; 0 for a load.
    pub overshoot: f64,
    /// Time, s, from which on the output stays within 2 % of the step (for a load: of the peak) around
    /// its final value; `None` where that is not reached within the horizon.
    pub settling_time: Option<f64>,
    /// The output ran away and the simulation was ended.
    pub cut: bool,
}

/// A controller in its loop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoopReport {
    /// The controller.
    pub pid: Pid,
    /// Number of closed-loop poles in the right half plane; 0: stable.
    pub unstable_poles: usize,
    /// Margins of a stable loop.
    pub margins: Option<Margins>,
    /// Nyquist curve `C(jw) P(jw)` around -1, real and imaginary parts.
    pub nyquist: Vec<[f64; 2]>,
    /// Step of the set point.
    pub set_point: Response,
    /// Step of the load.
    pub load: Response,
}

/// Simulates and judges the loop of `plant` and `pid` over `horizon` s, in steps of at most `step` s.
///
/// # Errors
/// An invalid plant, controller, horizon or step.
pub fn close(
    plant: &TransferFunction,
    pid: &Pid,
    horizon: f64,
    step: f64,
) -> Result<LoopReport, TuningError> {
    let set_point = respond(plant, pid, Disturbance::SetPoint, horizon, step)?;
    let load = respond(plant, pid, Disturbance::Load, horizon, step)?;
    let unstable = unstable_poles(plant, pid);
    Ok(LoopReport {
        pid: *pid,
        unstable_poles: unstable,
        margins: (unstable == 0).then(|| margins(plant, pid)),
        nyquist: nyquist(plant, Some(pid)),
        set_point,
        load,
    })
}

/// Simulates the loop of `plant` and `pid` from rest over `horizon` s, in steps of at most `step` s.
///
/// A dead time below 1/40,000 of the horizon is replaced by its Pade approximant of orders 1 and 2,
/// which is off by less than `(w L)^4/72`.
///
/// # Errors
/// An invalid plant, controller, horizon or step.
pub fn respond(
    plant: &TransferFunction,
    pid: &Pid,
    disturbance: Disturbance,
    horizon: f64,
    step: f64,
) -> Result<Response, TuningError> {
    plant.validate()?;
    pid.validate()?;
    check("horizon", horizon, horizon > 0.0, "above 0 s")?;
    check("step", step, step > 0.0, "above 0 s")?;
    let step = step.max(horizon / MOST_STEPS);
    let lag = plant.dead_time;
    if lag > 0.0 && lag < horizon / MOST_STEPS {
        let rational = TransferFunction::new(
            &product(&plant.numerator, &[-lag / 3.0, 1.0]),
            &product(&plant.denominator, &[lag * lag / 6.0, 2.0 * lag / 3.0, 1.0]),
            0.0,
        );
        return Simulation::new(&rational, pid, disturbance, step).run(horizon);
    }
    Simulation::new(plant, pid, disturbance, step).run(horizon)
}

/// The control signal over one step: values and slopes (times the step) at its start and end.
#[derive(Clone, Copy, Default)]
struct Piece {
    start: [f64; 2],
    end: [f64; 2],
}

impl Piece {
    /// Coefficients of `s^k/k!`, `s` the share of the step that has passed.
    fn coefficients(&self, offset: f64) -> [f64; 4] {
        let [a, da] = self.start;
        let [b, db] = self.end;
        let rise = b - a;
        [
            a + offset,
            da,
            2.0 * (3.0 * rise - 2.0 * da - db),
            6.0 * (da + db - 2.0 * rise),
        ]
    }
}

struct Simulation {
    /// States: plant, integral of the control error, filtered output.
    size: usize,
    step: f64,
    /// Steps in the dead time; 0 without.
    delay: usize,
    /// Of the plant's input.
    load: f64,
    set_point: f64,
    /// Dynamics, row by row; without dead time with the loop closed.
    dynamics: Vec<f64>,
    /// How the plant's input enters.
    entry: Vec<f64>,
    /// Constant part of the state's slope.
    constant: Vec<f64>,
    /// Transition matrix of a step.
    transition: Vec<f64>,
    /// Responses to the powers of the plant's input, and to the constant part.
    responses: [Vec<f64>; 4],
    held: Vec<f64>,
    output: Vec<f64>,
    /// Control signal: `feedback z + direct`.
    feedback: Vec<f64>,
    direct: f64,
    /// Final value of the output, where there is one.
    rest: f64,
}

impl Simulation {
    fn new(plant: &TransferFunction, pid: &Pid, disturbance: Disturbance, step: f64) -> Self {
        let space = plant.state_space();
        let n = space.b.len();
        let size = n + 2;
        let (set_point, load) = match disturbance {
            Disturbance::SetPoint => (1.0, 0.0),
            Disturbance::Load => (0.0, 1.0),
        };
        let filter = pid.filter_time;
        // Without derivative action the filter's state stays at 0.
        let (rate, kick) = if pid.derivative_time > 0.0 {
            (1.0 / filter, pid.derivative_time / filter)
        } else {
            (0.0, 0.0)
        };
        let mut f = DMatrix::zeros(size, size);
        f.view_mut((0, 0), (n, n)).copy_from(&space.a);
        let mut feedback = DVector::zeros(size);
        for j in 0..n {
            f[(n, j)] = -space.c[j];
            f[(n + 1, j)] = rate * space.c[j];
            feedback[j] = -pid.gain * (1.0 + kick) * space.c[j];
        }
        f[(n + 1, n + 1)] = -rate;
        feedback[n] = pid.integral_time.map_or(0.0, |ti| pid.gain / ti);
        feedback[n + 1] = pid.gain * kick;
        let direct = pid.gain * pid.setpoint_weight * set_point;
        let mut entry = DVector::zeros(size);
        entry.rows_mut(0, n).copy_from(&space.b);
        let mut constant = DVector::zeros(size);
        constant[n] = set_point;

        let lag = plant.dead_time;
        let delay = (lag / step).ceil() as usize;
        let step = if delay > 0 { lag / delay as f64 } else { step };
        if delay == 0 {
            f += &entry * feedback.transpose();
            constant += &entry * (direct + load);
        }
        let (transition, gammas) = polynomial(&f, &entry, step, 4);
        let (_, held) = polynomial(&f, &constant, step, 1);
        let mut output = vec![0.0; size];
        output[..n].copy_from_slice(space.c.as_slice());
        let by_rows = |m: &DMatrix<f64>| m.transpose().as_slice().to_vec();
        let response = |k: usize| {
            gammas
                .get(k)
                .map_or_else(Vec::new, |g| g.as_slice().to_vec())
        };
        Self {
            size,
            step,
            delay,
            load,
            set_point,
            dynamics: by_rows(&f),
            entry: entry.as_slice().to_vec(),
            constant: constant.as_slice().to_vec(),
            transition: by_rows(&transition),
            responses: [response(0), response(1), response(2), response(3)],
            held: held
                .first()
                .map_or_else(Vec::new, |h| h.as_slice().to_vec()),
            output,
            feedback: feedback.as_slice().to_vec(),
            direct,
            rest: rest(plant, pid, disturbance),
        }
    }

    /// Control signal and its slope times the step, and the output and its slope times the step; `input`
    /// is what acts on the plant.
    fn signals(&self, z: &[f64], input: f64, slope: &mut [f64]) -> ([f64; 2], [f64; 2]) {
        let input = if self.delay > 0 { input } else { 0.0 };
        for (i, row) in self.dynamics.chunks_exact(self.size).enumerate() {
            slope[i] = dot(row, z) + self.entry[i] * input + self.constant[i];
        }
        (
            [
                dot(&self.feedback, z) + self.direct,
                dot(&self.feedback, slope) * self.step,
            ],
            [dot(&self.output, z), dot(&self.output, slope) * self.step],
        )
    }

    fn run(&self, horizon: f64) -> Result<Response, TuningError> {
        let steps = (horizon / self.step).ceil().max(1.0) as usize;
        let stride = steps.div_ceil(POINTS).max(1);
        let mut z = vec![0.0; self.size];
        let mut next = vec![0.0; self.size];
        let mut slope = vec![0.0; self.size];
        let mut line = vec![Piece::default(); self.delay];
        let mut judge = Judge::new(self.set_point, self.rest, self.step, steps);
        let mut out = Response {
            time: Vec::with_capacity(POINTS + 2),
            output: Vec::with_capacity(POINTS + 2),
            input: Vec::with_capacity(POINTS + 2),
            iae: 0.0,
            peak: 0.0,
            overshoot: 0.0,
            settling_time: None,
            cut: false,
        };
        for i in 0..=steps {
            let slot = if self.delay > 0 { i % self.delay } else { 0 };
            let acting = line.get(slot).map_or([0.0; 4], |piece| {
                piece.coefficients(if i >= self.delay { self.load } else { 0.0 })
            });
            let (u, y) = self.signals(&z, acting[0], &mut slope);
            if y[0].is_nan() || y[0].abs() >= RUNAWAY {
                out.cut = true;
                break;
            }
            if i % stride == 0 || i == steps {
                out.time.push(i as f64 * self.step);
                out.output.push(y[0]);
                out.input.push(u[0]);
            }
            if i == steps {
                break;
            }
            for (j, row) in self.transition.chunks_exact(self.size).enumerate() {
                let pushed: f64 = (0..4).map(|k| self.responses[k][j] * acting[k]).sum();
                next[j] = dot(row, &z) + self.held[j] + pushed;
            }
            std::mem::swap(&mut z, &mut next);
            let end = acting[0] + acting[1] + acting[2] / 2.0 + acting[3] / 6.0;
            let (u_end, y_end) = self.signals(&z, end, &mut slope);
            if let Some(piece) = line.get_mut(slot) {
                *piece = Piece {
                    start: u,
                    end: u_end,
                };
            }
            judge.note(y, y_end);
        }
        judge.finish(&mut out);
        if out.time.is_empty() || self.transition.iter().any(|v| !v.is_finite()) {
            return Err(TuningError::NotFinite(
                "the closed loop's transition".into(),
            ));
        }
        Ok(out)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Where the output of a stable loop ends.
fn rest(plant: &TransferFunction, pid: &Pid, disturbance: Disturbance) -> f64 {
    let last = |p: &[f64]| p.last().copied().unwrap_or(0.0);
    let (num, den) = (last(&plant.numerator), last(&plant.denominator));
    let forward = match disturbance {
        Disturbance::SetPoint if pid.integral_time.is_some() => return 1.0,
        Disturbance::Load if pid.integral_time.is_some() => return 0.0,
        Disturbance::SetPoint => pid.gain * pid.setpoint_weight * num,
        Disturbance::Load => num,
    };
    forward / (den + pid.gain * num)
}

/// Collects what is judged about a response, at every step.
struct Judge {
    set_point: f64,
    rest: f64,
    step: f64,
    iae: f64,
    highest: f64,
    peak: f64,
    /// Output at the end of each step.
    outputs: Vec<f64>,
}

impl Judge {
    fn new(set_point: f64, rest: f64, step: f64, steps: usize) -> Self {
        Self {
            set_point,
            rest,
            step,
            iae: 0.0,
            highest: 0.0,
            peak: 0.0,
            outputs: Vec::with_capacity(steps),
        }
    }

    /// Output and slope times the step, at both ends of a step.
    fn note(&mut self, start: [f64; 2], end: [f64; 2]) {
        let (a, b) = (self.set_point - start[0], self.set_point - end[0]);
        // The cubic's integral; where the error changes its sign, two triangles.
        self.iae += self.step
            * if a * b >= 0.0 {
                (0.5 * (a + b) + (end[1] - start[1]) / 12.0).abs()
            } else {
                0.5 * (a * a + b * b) / (a - b).abs()
            };
        self.highest = self.highest.max(end[0]);
        self.peak = self.peak.max(end[0].abs());
        self.outputs.push(end[0]);
    }

    fn finish(&self, out: &mut Response) {
        out.iae = self.iae;
        out.peak = self.peak;
        if self.set_point != 0.0 && self.rest > 0.0 {
            out.overshoot = (self.highest / self.rest - 1.0).max(0.0);
        }
        let size = if self.set_point == 0.0 {
            self.peak
        } else {
            self.rest.abs()
        };
        let outside = |y: &f64| {
            let inside = (y - self.rest).abs() <= BAND * size;
            !inside
        };
        let last = self.outputs.iter().rposition(outside);
        let settled = last.map_or(0, |i| i + 1);
        if !out.cut && settled < self.outputs.len() {
            out.settling_time = Some((settled + 1) as f64 * self.step);
        }
    }
}
