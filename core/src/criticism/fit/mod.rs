//! Levenberg-Marquardt on the parameters, with the states at the window starts estimated alongside.
//!
//! The unknowns are the parameters `theta`, shared by all windows, and a state per window. The
//! normal equations are block-arrow shaped: each window's state is eliminated (Schur complement)
//! and found again by back-substitution, so that cost grows linearly with the record. Windows that
//! are held back never inform `theta`; they estimate their own state only.

mod equations;
mod starts;

use nalgebra::DMatrix;

use super::cost::{ODD_MEAN_SQUARE, oddness, robust_cost, robust_share};
use super::data::Data;
use super::motion::Motion;
use super::noise::news;
use super::output::Output;
use super::structure::Structure;
use super::window_sums::reduced;
use crate::effect::Scales;
use crate::model::{LoadBegin, Start};

/// Iterations after which a fit ends in any case.
const MAX_ITERATIONS: usize = 30;

/// A fall of the cost by less than this share of what it has beyond the noise, for the second time, ends a fit: a
/// twentieth of the least that counts between two models, 3 % of the error. (A thousand times less takes a quarter more
/// work, and names the same.)
const BEYOND_TOLERANCE: f64 = 3e-3;

/// The same of the whole cost: a fit that leaves noise ends where its values are known far better than that tells them.
const COST_TOLERANCE: f64 = 1e-6;

/// The same where whole steps do not lower it: on rough ground short ones may go on to find a little for long.
const CREEP: f64 = 1e-4;

/// Damping of the first step.
const FIRST_DAMPING: f64 = 1e-3;

/// Iterations of a fit whose values were put in order.
const ORDERED_ITERATIONS: usize = 4;

/// Damping above which no step is tried any more.
const MAX_DAMPING: f64 = 1e9;

/// Growth of the damping after a step that did not lower the cost; it doubles with every further one.
const DAMPING_GROWTH: f64 = 6.0;

/// A fit ends when it stalls for the second time; damping with which it goes on after the first.
const MAX_STALLS: usize = 2;
const RESTART_DAMPING: f64 = 1e-3;

/// Share of the cost below which better states of odd windows are worth going on for.
const MENDED: f64 = 0.999;

/// Times that other valleys are looked for, the iterations that each is given, and the share of the cost below which
/// one is lower.
const MOST_VALLEYS: usize = 2;
const VALLEY_ITERATIONS: usize = 4;
const LOWER_VALLEY: f64 = 0.98;

/// Share of their size by which values may differ that say the same.
const SAME_PLACE: f64 = 0.01;

/// Standard deviations by which a load on a joint may be off where it follows the body.
const FARTHEST: f64 = 3.0;

/// Relative fall of the `present` cost below which it falls no more.
fn tolerance(data: &Data, present: f64) -> f64 {
    let fitted = data.blocks.iter().filter(|b| !b.held_back);
    let noise: usize = fitted.map(|b| data.measured(b.from, b.to)).sum();
    let beyond = (1.0 - noise as f64 / present).max(0.0);
    COST_TOLERANCE.max(BEYOND_TOLERANCE * beyond)
}

/// The derivative of the motion with respect to where it starts, if that is all that changes.
fn shifted(data: &Data) -> Motion {
    let mut motion = Motion::still(data.len());
    for (from, to) in data.spans() {
        motion.position[from..to].fill(1.0);
    }
    motion
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
    /// Times that other valleys were looked for.
    valleys_seen: usize,
    pub done: bool,
    /// Share of the cost by which the first step of the last iteration should have lowered it.
    hope: f64,
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
        let motion = simulate(data, &structure, &values, &starts, &Motion::default());
        let cost = robust_cost(data, &motion, ODD_MEAN_SQUARE) + structure.prior_cost(&values);
        let p = values.len();
        let mut fit = Self {
            structure,
            values,
            starts,
            motion,
            cost,
            hope: 0.0,
            damping: FIRST_DAMPING,
            held: usize::MAX,
            iterations: 0,
            stalls: 0,
            valleys_seen: 0,
            done: !cost.is_finite(),
            information: DMatrix::identity(p, p),
        };
        fit.take_felt_loads(data);
        fit.try_feeling(data);
        fit
    }

    /// One iteration: derivatives, then steps with growing damping until one lowers the cost.
    pub fn iterate(&mut self, data: &Data, scales: &Scales) {
        if self.done {
            return;
        }
        self.iterations += 1;
        let p = self.values.len();
        let steps = self.structure.difference_steps(&self.values, scales);
        let columns = self.columns(data, &steps, scales);
        let scale = oddness(data, &self.motion);
        let (mut matrix, mut gradient, windows) = self.normal_equations(data, &columns, p, scale);
        let present = self.objective(data, &self.motion, &self.values, scale);
        let tolerance = tolerance(data, present);
        let priors = self.structure.priors();
        // The equations of the data stand for their cost divided by this.
        let share = robust_share(data, &self.motion, scale);
        for (j, value, tolerance) in &priors {
            let weight = 1.0 / (share * tolerance * tolerance);
            matrix[(*j, *j)] += weight;
            gradient[*j] += weight * (value - self.values[*j]);
        }
        let began_with = self.damping;
        let (mut moved, mut lowered, mut shortened, mut growth) =
            (false, false, false, DAMPING_GROWTH);
        while self.damping < MAX_DAMPING {
            let Some((values, starts)) = self.step(data, &matrix, &gradient, &windows, scales)
            else {
                self.damping *= 10.0;
                continue;
            };
            let fall = share * self.hoped_fall(data, &gradient, &windows, &values, &starts);
            let hope = fall / present.max(f64::MIN_POSITIVE);
            if !shortened {
                self.hope = hope;
            } else if hope < tolerance {
                break;
            }
            let (starts, motion) = self.motion_from(data, &values, starts, scale, present, scales);
            let cost = self.objective(data, &motion, &values, scale);
            if cost <= present {
                let fall = (present - cost) / present.max(f64::MIN_POSITIVE);
                self.cost = self.objective(data, &motion, &values, ODD_MEAN_SQUARE);
                (self.values, self.starts, self.motion) = (values, starts, motion);
                self.damping = (self.damping * 0.2).max(1e-9);
                moved = true;
                lowered = fall
                    > if shortened {
                        tolerance.max(CREEP)
                    } else {
                        tolerance
                    };
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
            self.damping = self.damping.min(RESTART_DAMPING);
            let before = self.cost;
            self.mend_odd_windows(data, scales);
            let found = self.cost < MENDED * before
                || self.try_growing(data, scales)
                || self.try_carrying(data, scales)
                || self.try_other_valleys(data, scales);
            // With as little damping as it would go on with, it would only do the same again.
            let repeats = !moved && began_with <= RESTART_DAMPING;
            self.stalls += match (found, repeats) {
                (true, _) => 0,
                (false, true) => MAX_STALLS,
                (false, false) => 1,
            };
        }
        self.done = self.stalls >= MAX_STALLS || self.iterations >= MAX_ITERATIONS;
    }

    /// Iterates until it is done.
    pub fn finish(&mut self, data: &Data, scales: &Scales) {
        while !self.done {
            self.iterate(data, scales);
        }
    }

    /// The same model fitted anew where the surroundings wander, so that each sample moves what is foretold by this
    /// share.
    pub fn among_surroundings(&self, data: &Data, share: f64, scales: &Scales) -> Self {
        let mut data = data.clone();
        data.wander = share;
        let (structure, values) = (self.structure.clone(), self.values.clone());
        let mut fit = Self::new(&data, structure, values, self.starts.clone(), scales);
        fit.finish(&data, scales);
        fit
    }

    /// Looks where an effect says that a lower valley may be, if the load behind a gap is hidden; true if one is.
    fn try_other_valleys(&mut self, data: &Data, scales: &Scales) -> bool {
        let model = self.structure.model(&self.values);
        let hidden = model.load.is_some() && !data.excitation.sees_load_of(&model);
        if !hidden || self.valleys_seen >= MOST_VALLEYS {
            return false;
        }
        self.valleys_seen += 1;
        let present = self.cost;
        let goes_on = self.structure.load_begin == LoadBegin::Carried;
        let effects = self.structure.effects.clone().into_iter().enumerate();
        for (index, effect) in effects.filter(|_| goes_on) {
            let range = self.structure.range(index);
            for other in effect.other_contacts(&self.values[range.clone()], false) {
                let mut trial = self.clone();
                trial.values[range.clone()].copy_from_slice(&other);
                trial.structure.clamp(&mut trial.values, scales);
                trial.follow_starts(data);
                trial.valleys_seen = MOST_VALLEYS;
                trial.damping = FIRST_DAMPING;
                for _ in 0..VALLEY_ITERATIONS {
                    trial.iterate(data, scales);
                }
                if trial.cost < self.cost {
                    trial.valleys_seen = self.valleys_seen;
                    *self = trial;
                }
            }
        }
        self.stalls = 0;
        self.cost < LOWER_VALLEY * present
    }

    /// Motion with these values and starts; a load that they leave alone is not followed again.
    fn simulate(&self, data: &Data, values: &[f64], starts: &[Start]) -> Motion {
        simulate(data, &self.structure, values, starts, &self.motion)
    }

    /// What a step must lower: the cost of the data and of what the user knows before.
    fn objective(&self, data: &Data, motion: &Motion, values: &[f64], scale: f64) -> f64 {
        robust_cost(data, motion, scale) + self.structure.prior_cost(values)
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
        if self.structure.load_begin == LoadBegin::Felt {
            trial.polish_lost(&self.motion, data, scales);
        } else if data.excitation.sees_load_of(&model) {
            trial.polish_until(present, data, scales);
        } else if model.may_stick() {
            trial.polish_once(data, scales);
        }
        (trial.starts, trial.motion)
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
    known: &Motion,
) -> Motion {
    let mut motion = Motion::still(data.len());
    let model = structure.model(values);
    let begin = structure.load_begin;
    let same = begin == LoadBegin::Felt && known.values == values && known.loads.is_felt_at(starts);
    motion.loads = if same {
        known.loads.clone()
    } else {
        let known = &known.loads;
        data.excitation.follow(&model, starts, known, begin)
    };
    motion.values = values.to_vec();
    let (position, velocity) = (&mut motion.position, &mut motion.velocity);
    let moves = data
        .excitation
        .replay(&model, starts, &motion.loads, position, velocity);
    data.count_moves(moves);
    let wanders = |o: &&Output| o.is_velocity && data.wander > 0.0;
    if let Some(output) = data.outputs.iter().find(wanders) {
        let pairs = motion.velocity.iter().zip(&output.values);
        let beyond: Vec<f64> = pairs.map(|(m, y)| m - y).collect();
        motion.news = news(data, output, &beyond, data.wander);
    }
    let doubts_load = data.excitation.doubts_load_of(&model, structure.load_begin);
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

/// The fit that costs least; one whose cost is not finite only where there is no other.
pub(super) fn least(fits: impl Iterator<Item = Fit>) -> Option<Fit> {
    let cost = |fit: &Fit| {
        if fit.cost.is_finite() {
            fit.cost
        } else {
            f64::INFINITY
        }
    };
    fits.min_by(|a, b| cost(a).total_cmp(&cost(b)))
}

/// Whether the values of two fits of one structure say the same, but for a hundredth of each.
pub(super) fn same_place(a: &[f64], b: &[f64]) -> bool {
    let mut pairs = a.iter().zip(b);
    pairs.all(|(a, b)| (a - b).abs() <= SAME_PLACE * a.abs().max(b.abs()))
}

/// Residual in noise units.
pub(super) fn residuals(data: &Data, motion: &Motion) -> Vec<Vec<f64>> {
    data.outputs
        .iter()
        .map(|o| {
            (0..data.len())
                .map(|i| motion.left(o, i) / o.noise)
                .collect()
        })
        .collect()
}
