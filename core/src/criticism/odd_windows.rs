//! Windows that start from a wrong state while the others are right.
//!
//! Where a body sticks, the motion depends on the state at the start of a window by leaps: a little slower and it
//! stays where it is, a little faster and it breaks loose. So it does where a load comes up behind a gap, and is met or
//! missed. A fit that follows derivatives stops on the wrong side of such a leap, and one window may then cost more than
//! all the others. Its state is looked for about the present and the measured one.

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

/// Deviations of a load's place and of its velocity that are tried beside none and to either side, each with each, in
/// standard deviations: far more of the velocity, since a load that is believed to rest may have been pushed unseen.
const PLACES: [f64; 7] = [0.25, 0.5, 1.0, 2.0, 4.0, 7.0, 10.0];
const VELOCITIES: [f64; 7] = [1.5, 5.0, 15.0, 40.0, 100.0, 250.0, 600.0];

/// How many of these the states are improved from, the best of each window, and how often.
const IMPROVED: usize = 6;
const IMPROVEMENTS: usize = 8;

impl Fit {
    /// Looks for better states of odd windows, if the body sticks or has a load that was felt; true if that lowers the
    /// cost.
    pub fn mend_odd_windows(&mut self, data: &Data, scales: &Scales) -> bool {
        let model = self.structure.model(&self.values);
        let sees_load = self.sees_load(data);
        if !sees_load && model.friction.breakaway() == 0.0 {
            return false;
        }
        let costs = window_costs(data, &self.motion);
        let odd = odd(data, &costs);
        if !odd.contains(&true) {
            return false;
        }
        let part = data.only(|window| odd[window]);
        let chosen = self.starts.iter().zip(&odd).filter(|(_, odd)| **odd);
        let starts = chosen.map(|(start, _)| *start).collect();
        let structure = self.structure.clone();
        let mut own = Self::new(&part, structure, self.values.clone(), starts, scales);
        if sees_load {
            own.try_loads(&part, scales);
        } else {
            // A state that suited other values may have led far from the measured one.
            let measured = part.guessed_starts();
            own.try_from(measured.clone(), 1, &part, scales);
            for step in STEPS {
                for side in [1.0, -1.0] {
                    let faster = side * step * scales.speed;
                    for base in [own.starts.clone(), measured.clone()] {
                        own.try_from(quicker(base, faster), 1, &part, scales);
                    }
                }
            }
        }
        own.polish_starts(&part, scales);
        let mut better = self.starts.clone();
        let places = (0..better.len()).filter(|k| odd[*k]);
        for (place, start) in places.zip(&own.starts) {
            better[place] = *start;
        }
        let before = self.cost;
        self.take_better(data, &better);
        self.cost < before
    }

    /// Starts every window as measured with the load in several places, improves the states from the best of these, and
    /// keeps what fits best.
    fn try_loads(&mut self, data: &Data, scales: &Scales) {
        let measured = data.guessed_starts();
        let loads = about_zero(&PLACES)
            .flat_map(|place| about_zero(&VELOCITIES).map(move |velocity| [place, velocity]));
        let mut tried: Vec<Vec<(f64, [f64; 2])>> = vec![Vec::new(); measured.len()];
        for load in loads {
            let starts = measured.iter().map(|start| Start { load, ..*start });
            let trial = self.started(starts.collect(), data);
            let costs = window_costs(data, &trial.motion);
            for (tried, cost) in tried.iter_mut().zip(costs) {
                tried.push((cost, load));
            }
        }
        for tried in &mut tried {
            tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        for rank in 0..IMPROVED {
            let ranked = measured.iter().zip(&tried);
            let starts = ranked.map(|(start, tried)| Start {
                load: tried.get(rank).map_or(start.load, |(_, load)| *load),
                ..*start
            });
            self.try_from(starts.collect(), IMPROVEMENTS, data, scales);
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

/// 0 and these sizes to either side of it.
fn about_zero(sizes: &[f64]) -> impl Iterator<Item = f64> {
    let sides = sizes.iter().flat_map(|size| [*size, -size]);
    std::iter::once(0.0).chain(sides)
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
        .map(|(cost, (from, to))| cost / ((to - from) * data.outputs.len()).max(1) as f64)
        .collect();
    let limit = ODD_TIMES * median(&mut squares.clone()).max(1.0);
    let odd: Vec<bool> = squares.iter().map(|square| *square > limit).collect();
    let count = odd.iter().filter(|odd| **odd).count() as f64;
    if count > MOST * odd.len() as f64 {
        return vec![false; odd.len()];
    }
    odd
}
