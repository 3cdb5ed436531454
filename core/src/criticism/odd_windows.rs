//! Windows that start from a wrong state while the others are right.
//!
//! Where a body sticks, the motion depends on the state at the start of a window by leaps: a little slower and it stays
//! where it is, a little faster and it breaks loose. So it does where a load comes up behind a gap, and is met or
//! missed. A fit that follows derivatives stops on the wrong side of such a leap, and one window may then cost more
//! than all the others. Its state is looked for about the present and the measured one.

use super::cost::window_costs;
use super::data::Data;
use super::fit::Fit;
use crate::effect::Scales;
use crate::model::Start;
use crate::order::median;

/// Mean square from which a window is odd, in times of the median one, or of the noise where that is more.
const ODD_TIMES: f64 = 3.0;

/// Share of windows that may be odd: where more are, it is the model that is wrong.
const MOST: f64 = 0.25;

/// Velocities that are tried on either side, as shares of the typical speed.
const STEPS: [f64; 7] = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

/// Deviations of a load's place and of its velocity that are tried beside none and to either side, an odd number, in
/// standard deviations: far more of the velocity, since a load that is believed to rest may have been pushed unseen.
const PLACES: [f64; 7] = [0.25, 0.5, 1.0, 2.0, 4.0, 7.0, 10.0];
const VELOCITIES: [f64; 7] = [1.5, 5.0, 15.0, 40.0, 100.0, 250.0, 600.0];

/// How many of these the states are improved from, the best of each window, and how often.
const IMPROVED: usize = 6;
const IMPROVEMENTS: usize = 8;

/// How many places of the coarse grid are refined.
const REFINED: usize = 2;

/// A deviation of a load that was tried in a window: its place in the grid.
#[derive(Clone, Copy)]
struct Tried {
    cost: f64,
    at: [usize; 2],
    load: [f64; 2],
}

impl Fit {
    /// Looks for better states of odd windows, if the body sticks, has a load that was felt, or may stay on either side
    /// of a hill of force, and takes what fits better.
    pub fn mend_odd_windows(&mut self, data: &Data, scales: &Scales) {
        let model = self.structure.model(&self.values);
        let sees_load = self.sees_load(data);
        if !sees_load && !model.may_stick() && model.is_same_everywhere() {
            return;
        }
        let costs = window_costs(data, &self.motion);
        let odd = odd(data, &costs);
        if !odd.contains(&true) {
            return;
        }
        self.in_windows(&odd, data, scales, |own, part| {
            if sees_load {
                own.try_loads(part, scales);
            } else {
                own.try_quicker(part, scales);
                own.grow_from(part.guessed_starts(), part, scales);
            }
            own.polish_starts(part, scales);
        });
    }

    /// Has the states of the `chosen` windows improved by themselves, and takes what fits better.
    pub(super) fn in_windows(
        &mut self,
        chosen: &[bool],
        data: &Data,
        scales: &Scales,
        improve: impl FnOnce(&mut Self, &Data),
    ) {
        let part = data.only(|window| chosen[window]);
        let own = self.starts.iter().zip(chosen).filter(|(_, own)| **own);
        let starts = own.map(|(start, _)| *start).collect();
        let structure = self.structure.clone();
        let mut own = Self::new(&part, structure, self.values.clone(), starts, scales);
        improve(&mut own, &part);
        let mut better = self.starts.clone();
        let places = (0..better.len()).filter(|k| chosen[*k]);
        for (place, start) in places.zip(&own.starts) {
            better[place] = *start;
        }
        self.take_better(data, &better);
    }

    /// Starts every window with the body a little quicker or slower than now or than measured, and keeps what fits
    /// best.
    fn try_quicker(&mut self, data: &Data, scales: &Scales) {
        // A state that suited other values may have led far from the measured one.
        let measured = data.guessed_starts();
        self.try_from(measured.clone(), 1, data, scales);
        for step in STEPS {
            for side in [1.0, -1.0] {
                let faster = side * step * scales.speed;
                for base in [self.starts.clone(), measured.clone()] {
                    self.try_from(quicker(base, faster), 1, data, scales);
                }
            }
        }
    }

    /// Starts every window as measured with the load in several places, improves the states from the best of these, and
    /// keeps what fits best.
    fn try_loads(&mut self, data: &Data, scales: &Scales) {
        let measured = data.guessed_starts();
        let (places, velocities) = (about_zero(&PLACES), about_zero(&VELOCITIES));
        // Every second one of each, then those beside the best of these.
        let coarse = |grid: &[f64]| (1..grid.len()).step_by(2).collect::<Vec<_>>();
        let mut tried: Vec<Vec<Tried>> = vec![Vec::new(); measured.len()];
        for place in coarse(&places) {
            for velocity in coarse(&velocities) {
                let at = vec![Some([place, velocity]); measured.len()];
                self.try_places(&at, [&places, &velocities], &measured, data, &mut tried);
            }
        }
        let best: Vec<Vec<[usize; 2]>> = tried
            .iter()
            .map(|tried| tried.iter().take(REFINED).map(|t| t.at).collect())
            .collect();
        for rank in 0..REFINED {
            for beside in (0..9).filter(|beside| *beside != 4) {
                let [i, j] = [beside / 3, beside % 3];
                let at = |best: &Vec<[usize; 2]>| {
                    let [place, velocity] = best.get(rank)?;
                    Some([place + i - 1, velocity + j - 1])
                };
                let at: Vec<Option<[usize; 2]>> = best.iter().map(at).collect();
                self.try_places(&at, [&places, &velocities], &measured, data, &mut tried);
            }
        }
        for rank in 0..IMPROVED {
            let ranked = measured.iter().zip(&tried);
            let starts = ranked.map(|(start, tried)| Start {
                load: tried.get(rank).map_or(start.load, |tried| tried.load),
                ..*start
            });
            self.try_from(starts.collect(), IMPROVEMENTS, data, scales);
        }
    }

    /// Tries the load of each window at one place of the grid, if any, and puts it in order among those that were
    /// tried.
    fn try_places(
        &self,
        at: &[Option<[usize; 2]>],
        [places, velocities]: [&[f64]; 2],
        measured: &[Start],
        data: &Data,
        tried: &mut [Vec<Tried>],
    ) {
        let load = |at: &Option<[usize; 2]>| at.map(|[i, j]| [places[i], velocities[j]]);
        let starts = measured.iter().zip(at).map(|(start, at)| Start {
            load: load(at).unwrap_or(start.load),
            ..*start
        });
        let trial = self.started(starts.collect(), data);
        let costs = window_costs(data, &trial.motion);
        for ((tried, cost), at) in tried.iter_mut().zip(costs).zip(at) {
            let Some((at, load)) = at.zip(load(at)) else {
                continue;
            };
            let better = tried.partition_point(|t| t.cost <= cost);
            tried.insert(better, Tried { cost, at, load });
        }
    }

    /// The same values from these states.
    fn started(&self, starts: Vec<Start>, data: &Data) -> Self {
        let mut trial = self.clone();
        trial.starts = starts;
        trial.follow_starts(data);
        trial
    }

    /// Starts every window from here, improves the states so many times, and keeps those that fit better than before.
    fn try_from(&mut self, starts: Vec<Start>, times: usize, data: &Data, scales: &Scales) {
        let mut trial = self.started(starts, data);
        for _ in 0..times {
            trial.polish_once(data, scales);
        }
        self.take_better(data, &trial.starts);
    }
}

/// These sizes to either side of 0, and that, in order.
fn about_zero(sizes: &[f64]) -> Vec<f64> {
    let below = sizes.iter().rev().map(|size| -size);
    let above = sizes.iter().copied();
    below.chain(std::iter::once(0.0)).chain(above).collect()
}

/// The same states with the body faster by this.
fn quicker(mut starts: Vec<Start>, faster: f64) -> Vec<Start> {
    for start in &mut starts {
        start.velocity += faster;
    }
    starts
}

/// Which windows are far worse than usual; none where many are.
fn odd(data: &Data, costs: &[f64]) -> Vec<bool> {
    let spans = data.spans();
    let squares: Vec<f64> = costs
        .iter()
        .zip(&spans)
        .map(|(cost, (from, to))| cost / data.measured(*from, *to).max(1) as f64)
        .collect();
    let limit = ODD_TIMES * median(&mut squares.clone()).max(1.0);
    let odd: Vec<bool> = squares.iter().map(|square| *square > limit).collect();
    let count = odd.iter().filter(|odd| **odd).count() as f64;
    if count > MOST * odd.len() as f64 {
        return vec![false; odd.len()];
    }
    odd
}
