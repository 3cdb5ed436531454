//! Levenberg-Marquardt on the parameters, with the states at the window starts estimated alongside.
//!
//! The unknowns are the parameters `theta`, shared by all windows, and a state per window. The
//! normal equations are block-arrow shaped: each window's state is eliminated (Schur complement)
//! and found again by back-substitution, so that cost grows linearly with the record. Windows that
//! are held back never inform `theta`; they estimate their own state only.

use nalgebra::{DMatrix, DVector, Vector4};

use super::cost::{
    ODD_MEAN_SQUARE, informed_windows, oddness, robust_cost, robust_share, window_costs,
    window_weights,
};
use super::data::Data;
use super::structure::Structure;
use super::window_sums::{
    BODY_STATES, STATES, WindowSums, changed, inverse, kept_within, reduced, state,
};
use crate::effect::Scales;
use crate::model::{FollowedLoad, Start};

/// Iterations after which a fit ends in any case.
const MAX_ITERATIONS: usize = 30;

/// A relative fall of the cost below this ends a fit.
const COST_TOLERANCE: f64 = 1e-6;

/// Damping of the first step.
const FIRST_DAMPING: f64 = 1e-3;

/// Iterations of the baseline before an effect is fitted.
const BODY_ITERATIONS: usize = 2;

/// Iterations of a fit whose values were put in order.
const ORDERED_ITERATIONS: usize = 4;

/// Damping above which no step is tried any more.
const MAX_DAMPING: f64 = 1e9;

/// Growth of the damping after a step that did not lower the cost; it doubles with every further one.
const DAMPING_GROWTH: f64 = 6.0;

/// A fit ends when it stalls for the second time; damping with which it goes on after the first.
const MAX_STALLS: usize = 2;
const RESTART_DAMPING: f64 = 1e-3;

/// Step for differences with respect to where a load is, in its standard deviations.
const LOAD_DIFFERENCE: f64 = 0.1;

/// Standard deviations by which a load on a joint may be off where it follows the body.
const FARTHEST: f64 = 3.0;

/// Times that the states of windows are improved: with a seen load as long as that lowers the cost below this share.
const FEWEST_POLISHINGS: usize = 2;
const POLISHINGS: usize = 6;
const POLISHED_ENOUGH: f64 = 0.999;

/// Shares of the step of a window's state that are tried where a contact bends the motion.
const POLISHED: [f64; 3] = [1.0, 0.3, 0.1];

/// Smallest step for finite differences, as a share of the first one.
const LEAST_DIFFERENCE: f64 = 1e-4;

/// Position and velocity of the body at every sample.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    /// For each window, what its state costs by itself: how far a load is off where it is taken to be.
    pub priors: Vec<f64>,
    /// Where a load begins in the windows.
    pub loads: FollowedLoad,
}

impl Motion {
    /// No motion over `n` samples.
    fn still(n: usize) -> Self {
        Self {
            position: vec![0.0; n],
            velocity: vec![0.0; n],
            ..Self::default()
        }
    }

    /// The derivative of the motion with respect to where it starts, if that is all that changes.
    fn shifted(data: &Data) -> Self {
        let mut motion = Self::still(data.len());
        for (from, to) in data.spans() {
            motion.position[from..to].fill(1.0);
        }
        motion
    }

    /// Takes the motion of another one in a window.
    fn take_window(&mut self, other: &Self, window: usize, (from, to): (usize, usize)) {
        self.position[from..to].copy_from_slice(&other.position[from..to]);
        self.velocity[from..to].copy_from_slice(&other.velocity[from..to]);
        self.priors[window] = other.priors[window];
    }

    /// The part that an output shows.
    pub fn of(&self, is_velocity: bool) -> &[f64] {
        if is_velocity {
            &self.velocity
        } else {
            &self.position
        }
    }
}

/// A fit that goes on iteration by iteration.
#[derive(Clone)]
pub(super) struct Fit {
    pub structure: Structure,
    pub values: Vec<f64>,
    pub starts: Vec<Start>,
    pub motion: Motion,
    /// Squared residuals in noise units over the samples used for the fit; where windows differ widely,
    /// by their usual size (see [`robust_cost`]).
    pub cost: f64,
    damping: f64,
    /// Index of the first value that is held.
    held: usize,
    iterations: usize,
    stalls: usize,
    pub done: bool,
    /// Inverse covariance of the values for unit noise, from the last iteration.
    information: DMatrix<f64>,
}

impl Fit {
    pub fn new(
        data: &Data,
        structure: Structure,
        mut values: Vec<f64>,
        starts: Vec<Start>,
        scales: &Scales,
    ) -> Self {
        structure.clamp(&mut values, scales);
        let unknown = FollowedLoad::default();
        let motion = simulate(data, &structure, &values, &starts, &unknown);
        let cost = robust_cost(data, &motion, ODD_MEAN_SQUARE) + structure.prior_cost(&values);
        let p = values.len();
        let mut fit = Self {
            structure,
            values,
            starts,
            motion,
            cost,
            damping: FIRST_DAMPING,
            held: usize::MAX,
            iterations: 0,
            stalls: 0,
            done: !cost.is_finite(),
            information: DMatrix::identity(p, p),
        };
        fit.take_felt_loads(data);
        fit
    }

    /// Takes for each window the state of a seen load in which it meets what was felt, where that is better; true if
    /// there is a seen load.
    fn take_felt_loads(&mut self, data: &Data) -> bool {
        let model = self.structure.model(&self.values);
        if !data.excitation.sees_load_of(&model) {
            return false;
        }
        let mut trial = self.starts.clone();
        data.excitation.guess_loads(&model, &mut trial);
        self.take_better(data, &trial);
        true
    }

    /// One iteration: derivatives, then steps with growing damping until one lowers the cost.
    pub fn iterate(&mut self, data: &Data, scales: &Scales) {
        if self.done {
            return;
        }
        self.iterations += 1;
        let p = self.values.len();
        let steps = self.difference_steps(data, scales);
        let columns = self.columns(data, &steps, scales);
        let scale = oddness(data, &self.motion);
        let (mut matrix, mut gradient, windows) = self.normal_equations(data, &columns, p, scale);
        let present = self.objective(data, &self.motion, &self.values, scale);
        let priors = self.structure.priors();
        // The equations of the data stand for their cost divided by this.
        let share = robust_share(data, &self.motion, scale);
        for (j, value, tolerance) in &priors {
            let weight = 1.0 / (share * tolerance * tolerance);
            matrix[(*j, *j)] += weight;
            gradient[*j] += weight * (value - self.values[*j]);
        }
        let (mut lowered, mut shortened, mut growth) = (false, false, DAMPING_GROWTH);
        while self.damping < MAX_DAMPING {
            let Some((values, starts)) = self.step(data, &matrix, &gradient, &windows, scales)
            else {
                self.damping *= 10.0;
                continue;
            };
            if shortened
                && share * self.hoped_fall(data, &gradient, &windows, &values, &starts)
                    < COST_TOLERANCE * present
            {
                break;
            }
            let (starts, motion) = self.motion_from(data, &values, starts, scale, present, scales);
            let cost = self.objective(data, &motion, &values, scale);
            if cost <= present {
                let fall = (present - cost) / present.max(f64::MIN_POSITIVE);
                self.cost = self.objective(data, &motion, &values, ODD_MEAN_SQUARE);
                (self.values, self.starts, self.motion) = (values, starts, motion);
                self.damping = (self.damping * 0.2).max(1e-9);
                lowered = fall > COST_TOLERANCE;
                break;
            }
            self.damping *= growth;
            growth *= 2.0;
            shortened = true;
        }
        self.information = reduced(&matrix, &gradient, &windows, data, p).0;
        for (j, _, tolerance) in &priors {
            self.information[(*j, *j)] += (1.0 - 1.0 / share) / (tolerance * tolerance);
        }
        if !lowered {
            self.damping = RESTART_DAMPING;
            if !self.mend_odd_windows(data, scales) {
                // Once more with long difference steps, which see past the kinks around a stall.
                self.stalls += 1;
            }
        }
        self.done = self.stalls >= MAX_STALLS || self.iterations >= MAX_ITERATIONS;
    }

    /// Motion with these values and starts; a load that they leave alone is not followed again.
    fn simulate(&self, data: &Data, values: &[f64], starts: &[Start]) -> Motion {
        simulate(data, &self.structure, values, starts, &self.motion.loads)
    }

    /// What a step must lower: the cost of the data and of what the user knows before.
    fn objective(&self, data: &Data, motion: &Motion, values: &[f64], scale: f64) -> f64 {
        robust_cost(data, motion, scale) + self.structure.prior_cost(values)
    }

    /// Fits the baseline alone, the effects as they are: with a wrong body the values of a new effect
    /// would be led astray at once.
    pub fn fit_body(&mut self, data: &Data, scales: &Scales) {
        self.held = self.structure.baseline_len();
        for _ in 0..BODY_ITERATIONS {
            self.iterate(data, scales);
        }
        self.held = usize::MAX;
        (self.iterations, self.stalls, self.damping) = (0, 0, FIRST_DAMPING);
        self.done = !self.cost.is_finite();
    }

    /// Motion with new values; where it got worse than the `present` cost, each window starts from the better of its
    /// new and its present state: near a kink a step in the state may lead anywhere. Where a body sticks that state is
    /// then improved with the values kept: judged with wrong states, no step of the values along a valley would seem to
    /// lower the cost.
    fn motion_from(
        &self,
        data: &Data,
        values: &[f64],
        starts: Vec<Start>,
        scale: f64,
        present: f64,
        scales: &Scales,
    ) -> (Vec<Start>, Motion) {
        let moved = self.simulate(data, values, &starts);
        if self.objective(data, &moved, values, scale) <= present {
            return (starts, moved);
        }
        let mut trial = Self {
            values: values.to_vec(),
            starts,
            motion: moved,
            ..self.clone()
        };
        trial.take_better(data, &self.starts);
        let model = self.structure.model(values);
        if data.excitation.sees_load_of(&model) {
            trial.polish_until(present, data, scales);
        } else if model.friction.breakaway() > 0.0 {
            trial.polish_once(data, scales);
        }
        (trial.starts, trial.motion)
    }

    /// Steps for finite differences: as large as the uncertainty of a value, once that is known, so that
    /// curvature does not bend the derivative by more than the noise does.
    fn difference_steps(&self, data: &Data, scales: &Scales) -> Vec<f64> {
        let mut steps = self.structure.difference_steps(&self.values, scales);
        if self.iterations > 1 && self.stalls == 0 {
            let count = data.len() as f64;
            let level = (self.cost / count).sqrt().max(1.0);
            for (j, step) in steps.iter_mut().enumerate() {
                let uncertain = level / self.information[(j, j)].max(f64::MIN_POSITIVE).sqrt();
                let size = uncertain.max(LEAST_DIFFERENCE * step.abs()).min(step.abs());
                *step = size.copysign(*step);
            }
        }
        steps
    }

    /// The most by which a step may lower the squared residuals, as far as they are linear: twice the
    /// gradient along it.
    fn hoped_fall(
        &self,
        data: &Data,
        gradient: &DVector<f64>,
        windows: &[WindowSums],
        values: &[f64],
        starts: &[Start],
    ) -> f64 {
        let moved = values.iter().zip(&self.values).map(|(to, from)| to - from);
        let shared: f64 = gradient.iter().zip(moved).map(|(g, d)| g * d).sum();
        let own: f64 = windows
            .iter()
            .zip(informed_windows(data))
            .zip(starts.iter().zip(&self.starts))
            .filter(|((_, informed), _)| *informed)
            .map(|((sums, _), (to, from))| sums.gradient.dot(&(state(to) - state(from))))
            .sum();
        2.0 * (shared + own)
    }

    /// Derivatives of the motion: one column per value, then position and velocity of the starts, then those of a
    /// load that may be off.
    fn columns(&self, data: &Data, steps: &[f64], scales: &Scales) -> Vec<Motion> {
        let spans = data.spans();
        let difference = |moved: Motion, step: f64| difference(moved, &self.motion, step, &spans);
        let fixed = self.structure.fixed();
        let by_value = |j: usize| {
            if j >= self.held || fixed[j] {
                return Motion::still(data.len());
            }
            let mut values = self.values.clone();
            values[j] += steps[j];
            difference(self.simulate(data, &values, &self.starts), steps[j])
        };
        let model = self.structure.model(&self.values);
        let dx = 1e-6 * scales.travel.max(f64::MIN_POSITIVE);
        let dv = 1e-6 * scales.speed.max(f64::MIN_POSITIVE);
        let by_state = |k: usize| {
            if k == 0 && !data.has_position {
                return Motion::still(data.len());
            }
            if k == 0 && model.is_same_everywhere() {
                return Motion::shifted(data);
            }
            let step = [dx, dv, LOAD_DIFFERENCE, LOAD_DIFFERENCE][k];
            let change = Vector4::ith(k, step);
            let starts: Vec<Start> = self.starts.iter().map(|s| changed(s, &change)).collect();
            difference(self.simulate(data, &self.values, &starts), step)
        };
        let states = if data.excitation.doubts_load_of(&model) {
            STATES
        } else {
            BODY_STATES
        };
        let values = steps.len();
        data.crew.gather(values + states, |j| {
            j.checked_sub(values).map_or_else(|| by_value(j), by_state)
        })
    }

    fn normal_equations(
        &self,
        data: &Data,
        columns: &[Motion],
        p: usize,
        scale: f64,
    ) -> (DMatrix<f64>, DVector<f64>, Vec<WindowSums>) {
        // The columns after those of the values are those of the starts.
        let has_load = columns.len() == p + STATES;
        let mut matrix = DMatrix::zeros(p, p);
        let mut gradient = DVector::zeros(p);
        let mut windows: Vec<WindowSums> =
            data.windows.iter().map(|_| WindowSums::new(p)).collect();
        let informed = informed_windows(data);
        let robust = window_weights(data, &self.motion, scale);
        let mut row = vec![0.0; p];
        for block in &data.blocks {
            // A held-back block in a window that is also fitted informs nothing.
            if block.held_back && informed[block.window] {
                continue;
            }
            let sums = &mut windows[block.window];
            for output in &data.outputs {
                let weight = robust[block.window].sqrt() / output.noise;
                let modelled = self.motion.of(output.is_velocity);
                let parts: Vec<&[f64]> = columns.iter().map(|c| c.of(output.is_velocity)).collect();
                for i in block.from..block.to {
                    let r = (output.values[i] - modelled[i]) * weight;
                    for (value, part) in row.iter_mut().zip(&parts) {
                        *value = part[i] * weight;
                    }
                    let state = |k: usize| parts[p + k][i] * weight;
                    if has_load {
                        sums.add([state(0), state(1), state(2), state(3)], &row, r);
                    } else {
                        sums.add([state(0), state(1)], &row, r);
                    }
                    if !block.held_back {
                        for a in 0..p {
                            gradient[a] += row[a] * r;
                            for b in 0..=a {
                                matrix[(a, b)] += row[a] * row[b];
                            }
                        }
                    }
                }
            }
        }
        for a in 0..p {
            for b in 0..a {
                matrix[(b, a)] = matrix[(a, b)];
            }
        }
        if has_load {
            for ((sums, start), weight) in windows.iter_mut().zip(&self.starts).zip(&robust) {
                for (k, deviation) in start.load.iter().enumerate() {
                    let k = BODY_STATES + k;
                    sums.state[(k, k)] += weight;
                    sums.gradient[k] -= weight * deviation;
                }
            }
        }
        (matrix, gradient, windows)
    }

    /// Values and starts after a damped step; `None` where the equations cannot be solved.
    fn step(
        &self,
        data: &Data,
        matrix: &DMatrix<f64>,
        gradient: &DVector<f64>,
        windows: &[WindowSums],
        scales: &Scales,
    ) -> Option<(Vec<f64>, Vec<Start>)> {
        let p = self.values.len();
        let (mut schur, reduced_gradient) = reduced(matrix, gradient, windows, data, p);
        for j in 0..p {
            let d = schur[(j, j)];
            schur[(j, j)] = d + self.damping * d.max(1e-12 * matrix[(j, j)]) + f64::MIN_POSITIVE;
        }
        let moved = self.bounded_step(&schur, &reduced_gradient, scales)?;
        let values: Vec<f64> = self.values.iter().zip(&moved).map(|(v, d)| v + d).collect();
        let model = self.structure.model(&self.values);
        let farthest = farthest(data.excitation.sees_load_of(&model));
        let starts = self
            .starts
            .iter()
            .zip(windows)
            .map(|(start, sums)| {
                let mut g = sums.gradient;
                for (mixed, d) in sums.mixed.iter().zip(&moved) {
                    g -= mixed * *d;
                }
                kept_within(changed(start, &(inverse(&sums.state) * g)), farthest)
            })
            .collect();
        Some((values, starts))
    }

    /// Solves for the step; values that would leave their range stop at its end and the others are
    /// solved again, so that a value at its end does not hold back the rest.
    fn bounded_step(
        &self,
        matrix: &DMatrix<f64>,
        gradient: &DVector<f64>,
        scales: &Scales,
    ) -> Option<Vec<f64>> {
        let p = self.values.len();
        let known = self.structure.fixed();
        let mut fixed: Vec<Option<f64>> = known.iter().map(|f| f.then_some(0.0)).collect();
        loop {
            let free: Vec<usize> = (0..p).filter(|j| fixed[*j].is_none()).collect();
            let part = DMatrix::from_fn(free.len(), free.len(), |a, b| matrix[(free[a], free[b])]);
            let right = DVector::from_fn(free.len(), |a, _| {
                let known: f64 = (0..p)
                    .map(|j| fixed[j].map_or(0.0, |d| matrix[(free[a], j)] * d))
                    .sum();
                gradient[free[a]] - known
            });
            let solution = part.cholesky()?.solve(&right);
            let mut step: Vec<f64> = fixed.iter().map(|d| d.unwrap_or(0.0)).collect();
            for (a, j) in free.iter().enumerate() {
                step[*j] = solution[a];
            }
            let mut values: Vec<f64> = self.values.iter().zip(&step).map(|(v, d)| v + d).collect();
            if values.iter().any(|v| !v.is_finite()) {
                return None;
            }
            let wanted = values.clone();
            self.structure.limit_step(&mut values, &self.values);
            self.structure.clamp(&mut values, scales);
            let out: Vec<usize> = free
                .into_iter()
                .filter(|j| values[*j] != wanted[*j])
                .collect();
            if out.is_empty() {
                return Some(step);
            }
            for j in out {
                fixed[j] = Some(values[j] - self.values[j]);
            }
        }
    }

    /// Puts values in order that only have each other's roles, and fits on from there; true if any were not.
    pub fn put_in_order(&mut self, data: &Data, scales: &Scales) -> bool {
        let mut values = self.values.clone();
        if !self.structure.order(&mut values) {
            return false;
        }
        let starts = self.starts.clone();
        *self = Self::new(data, self.structure.clone(), values, starts, scales);
        for _ in 0..ORDERED_ITERATIONS {
            self.iterate(data, scales);
        }
        true
    }

    /// Takes for each window the measured state where that suits the values better than the present one.
    pub fn take_measured_starts(&mut self, data: &Data) {
        let mut trial = data.guessed_starts();
        for (guessed, present) in trial.iter_mut().zip(&self.starts) {
            guessed.load = present.load;
        }
        self.take_better(data, &trial);
        let model = self.structure.model(&self.values);
        if data.excitation.sees_load_of(&model) {
            data.excitation.guess_loads(&model, &mut trial);
            self.take_better(data, &trial);
        }
    }

    /// Improves the states of all windows with the values kept, window by window where it helps.
    pub fn polish_starts(&mut self, data: &Data, scales: &Scales) {
        self.polish_until(f64::NEG_INFINITY, data, scales);
    }

    /// The same until the cost is as low as that.
    fn polish_until(&mut self, enough: f64, data: &Data, scales: &Scales) {
        let model = self.structure.model(&self.values);
        if data.excitation.sees_load_of(&model) {
            self.take_measured_starts(data);
        }
        for round in 0..POLISHINGS {
            let before = self.cost;
            let sees_load = self.polish_once(data, scales);
            let worthwhile = sees_load && self.cost < POLISHED_ENOUGH * before;
            if self.cost <= enough || (round + 1 >= FEWEST_POLISHINGS && !worthwhile) {
                return;
            }
        }
    }

    /// One step of the states of all windows, taken where it helps; true if there is a seen load.
    pub(super) fn polish_once(&mut self, data: &Data, scales: &Scales) -> bool {
        let columns = self.columns(data, &[], scales);
        let (_, _, windows) = self.normal_equations(data, &columns, 0, f64::INFINITY);
        let sees_load = data
            .excitation
            .sees_load_of(&self.structure.model(&self.values));
        let farthest = farthest(sees_load);
        let shares: &[f64] = if sees_load { &POLISHED } else { &[1.0] };
        for share in shares {
            let changes = windows
                .iter()
                .map(|sums| inverse(&sums.state) * sums.gradient * *share);
            let trial = self.starts.iter().zip(changes);
            let trial: Vec<Start> = trial
                .map(|(s, change)| kept_within(changed(s, &change), farthest))
                .collect();
            self.take_better(data, &trial);
        }
        sees_load
    }

    /// Takes up the motion from the present starts.
    pub(super) fn follow_starts(&mut self, data: &Data) {
        self.motion = self.simulate(data, &self.values, &self.starts);
        self.cost = self.objective(data, &self.motion, &self.values, ODD_MEAN_SQUARE);
    }

    /// Takes for each window its state of `trial` where that fits better.
    pub(super) fn take_better(&mut self, data: &Data, trial: &[Start]) {
        let motion = self.simulate(data, &self.values, trial);
        let before = window_costs(data, &self.motion);
        let after = window_costs(data, &motion);
        // A slow sensor carries over from window to window; apart from that each has its own motion.
        let apart = self.structure.model(&self.values).sensor_lag.is_none();
        let spans = data.spans();
        let better = (0..trial.len()).filter(|k| after[*k] < before[*k]);
        for k in better {
            self.starts[k] = trial[k];
            if apart {
                self.motion.take_window(&motion, k, spans[k]);
            }
        }
        if apart {
            self.cost = self.objective(data, &self.motion, &self.values, ODD_MEAN_SQUARE);
        } else {
            self.follow_starts(data);
        }
    }

    /// Standard errors of the values: noise as found, with `inflation` of the variance; 0 for fixed ones.
    pub fn standard_errors(&self, inflation: f64) -> Vec<f64> {
        let p = self.values.len();
        let mut information = self.information.clone();
        // The tolerance of a prior is as the user says: it does not grow with the residuals.
        for (j, _, tolerance) in self.structure.priors() {
            information[(j, j)] += (inflation - 1.0) / (tolerance * tolerance);
        }
        let fixed = self.structure.fixed();
        let free: Vec<usize> = (0..p).filter(|j| !fixed[*j]).collect();
        let d: Vec<f64> = free
            .iter()
            .map(|j| information[(*j, *j)].max(f64::MIN_POSITIVE).sqrt())
            .collect();
        let mut scaled = DMatrix::from_fn(free.len(), free.len(), |a, b| {
            information[(free[a], free[b])] / (d[a] * d[b])
        });
        for j in 0..free.len() {
            scaled[(j, j)] += 1e-12;
        }
        let mut errors = vec![0.0; p];
        let inverse = scaled.cholesky().map(|c| c.inverse());
        for (a, j) in free.into_iter().enumerate() {
            errors[j] = inverse
                .as_ref()
                .map_or(f64::INFINITY, |i| (i[(a, a)] * inflation).sqrt() / d[a]);
        }
        errors
    }
}

/// Standard deviations by which a load may be off at most. One that was seen by its contacts may have been met by
/// chance, but if one on a joint is far off where it follows the body, the model is wrong.
fn farthest(seen: bool) -> f64 {
    if seen { f64::INFINITY } else { FARTHEST }
}

/// Runs the model through the whole record; what its load does may be known.
fn simulate(
    data: &Data,
    structure: &Structure,
    values: &[f64],
    starts: &[Start],
    known: &FollowedLoad,
) -> Motion {
    let mut motion = Motion::still(data.len());
    let model = structure.model(values);
    if model.load.is_some() {
        data.count_load_replay();
    }
    motion.loads = data.excitation.follow(&model, starts, known);
    let (position, velocity) = (&mut motion.position, &mut motion.velocity);
    data.excitation
        .replay(&model, starts, &motion.loads, position, velocity);
    let doubts_load = data.excitation.doubts_load_of(&model);
    let prior = |s: &Start| {
        if doubts_load {
            s.load[0].powi(2) + s.load[1].powi(2)
        } else {
            0.0
        }
    };
    motion.priors = starts.iter().map(prior).collect();
    motion
}

/// Residual in noise units.
pub(super) fn residuals(data: &Data, motion: &Motion) -> Vec<Vec<f64>> {
    data.outputs
        .iter()
        .map(|o| {
            let modelled = motion.of(o.is_velocity);
            o.values
                .iter()
                .zip(modelled)
                .map(|(y, m)| (y - m) / o.noise)
                .collect()
        })
        .collect()
}

/// Difference quotient in place of `moved`, where there are data.
fn difference(mut moved: Motion, base: &Motion, step: f64, spans: &[(usize, usize)]) -> Motion {
    let pairs = [
        (&mut moved.position, &base.position),
        (&mut moved.velocity, &base.velocity),
    ];
    for (moved, base) in pairs {
        for (from, to) in spans {
            for (value, base) in moved[*from..*to].iter_mut().zip(&base[*from..*to]) {
                *value = (*value - base) / step;
            }
        }
    }
    moved
}
