//! The states from which windows start, improved with the values kept.

use super::{Fit, farthest};
use crate::criticism::cost::{ODD_MEAN_SQUARE, window_costs};
use crate::criticism::data::Data;
use crate::criticism::motion::Motion;
use crate::criticism::window_sums::{changed, inverse, kept_within};
use crate::effect::Scales;
use crate::model::{LoadBegin, Start};

/// Times that the states of windows are improved: with a seen load as long as that lowers the cost below this share.
const FEWEST_POLISHINGS: usize = 2;
const POLISHINGS: usize = 6;
const POLISHED_ENOUGH: f64 = 0.999;

/// Share of the cost that is left at most where a load is carried from window to window.
const CARRIED: f64 = 0.98;

/// The same where a load is known by the force that the body felt: that is told with noise of its own.
const FELT: f64 = 0.1;

/// Shares of a window from which the state of a felt load is found one after the other, how often each, and the share
/// of the cost that may be left for it to have been worth while.
const GROWING: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];
const GROWING_ROUNDS: usize = 3;
const WON: f64 = 0.9;

/// A window whose cost has become so many times what it was has lost a contact.
const LOST: f64 = 1.2;

/// Shares of the step of a window's state that are tried where a contact bends the motion.
const POLISHED: [f64; 3] = [1.0, 0.3, 0.1];

impl Fit {
    /// Takes for each window the state of a seen load in which it meets what was felt, where that is better; true if
    /// there is a seen load.
    pub(super) fn take_felt_loads(&mut self, data: &Data) -> bool {
        let model = self.structure.model(&self.values);
        if !data.excitation.sees_load_of(&model) {
            return false;
        }
        let mut trial = self.starts.clone();
        data.excitation.guess_loads(&model, &mut trial);
        self.take_better(data, &trial);
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

    /// Improves the states of all windows with the values kept, window by window where it helps. That of a window which
    /// is held back goes along with steps of the values that it has no say in, and may have gone astray: none is worse
    /// than the measured one.
    pub fn polish_starts(&mut self, data: &Data, scales: &Scales) {
        self.polish_until(f64::NEG_INFINITY, data, scales);
    }

    /// The same until the cost is as low as that.
    pub(super) fn polish_until(&mut self, enough: f64, data: &Data, scales: &Scales) {
        self.take_measured_starts(data);
        for round in 0..POLISHINGS {
            let before = self.cost;
            let sees_load = self.polish_once(data, scales);
            let worthwhile = sees_load && self.cost < POLISHED_ENOUGH * before;
            if self.cost <= enough || (round + 1 >= FEWEST_POLISHINGS && !worthwhile) {
                return;
            }
        }
    }

    /// Improves the states of the windows that cost much more than with the motion `before`: each contact of a load
    /// that is met again and again multiplies a change of the values, and some windows lose it.
    pub(super) fn polish_lost(&mut self, before: &Motion, data: &Data, scales: &Scales) {
        let before = window_costs(data, before).into_iter();
        let costs = before.zip(window_costs(data, &self.motion));
        let lost: Vec<bool> = costs.map(|(before, now)| now > LOST * before).collect();
        if lost.contains(&true) {
            self.in_windows(&lost, data, scales, |own, part| {
                own.polish_starts(part, scales);
            });
        }
    }

    /// One step of the states of all windows, taken where it helps; true if there is a seen load.
    pub(in crate::criticism) fn polish_once(&mut self, data: &Data, scales: &Scales) -> bool {
        let columns = self.columns(data, &[], scales);
        let (_, _, windows) = self.normal_equations(data, &columns, 0, f64::INFINITY);
        let sees_load = self.sees_load(data);
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

    /// Whether its load is known by what the body felt of it, contact by contact or as a force.
    pub(in crate::criticism) fn sees_load(&self, data: &Data) -> bool {
        let model = self.structure.model(&self.values);
        let felt = self.structure.load_begin == LoadBegin::Felt && model.load.is_some();
        felt || data.excitation.sees_load_of(&model)
    }

    /// Whether it has a load behind a gap that nothing tells of yet but the motion of the body.
    fn follows_hidden_load(&self, data: &Data) -> bool {
        let model = self.structure.model(&self.values);
        let gap = model.load.is_some_and(|load| load.coupling.half_gap > 0.0);
        let followed = self.structure.load_begin == LoadBegin::Followed;
        gap && followed && !data.excitation.sees_load_of(&model)
    }

    /// Takes a load behind a gap to be where the force that the body felt has moved it, if that fits far better than
    /// where it would be if the body had moved as measured.
    pub(super) fn try_feeling(&mut self, data: &Data) {
        if !self.follows_hidden_load(data) {
            return;
        }
        let mut trial = self.clone();
        trial.structure.load_begin = LoadBegin::Felt;
        trial.follow_starts(data);
        if trial.cost < FELT * self.cost {
            *self = trial;
        }
    }

    /// Finds the state of each window with a felt load from its first part, then from more and more of it: each contact
    /// multiplies what was wrong before it, so that the whole has many valleys. True if much was won.
    pub(super) fn try_growing(&mut self, data: &Data, scales: &Scales) -> bool {
        if self.structure.load_begin != LoadBegin::Felt {
            return false;
        }
        let before = self.cost;
        self.grow_from(self.starts.clone(), data, scales);
        self.cost < WON * before
    }

    /// The same from these states.
    pub(in crate::criticism) fn grow_from(
        &mut self,
        starts: Vec<Start>,
        data: &Data,
        scales: &Scales,
    ) {
        let mut trial = self.clone();
        trial.starts = starts;
        for share in GROWING {
            let part = data.beginning(share);
            trial.follow_starts(&part);
            for _ in 0..GROWING_ROUNDS {
                trial.polish_once(&part, scales);
            }
        }
        self.take_better(data, &trial.starts);
    }

    /// Has a load behind a gap go on from window to window, if that fits better than where it would be if the body had
    /// moved as measured: a stiff contact makes much of little noise. True if so.
    pub(super) fn try_carrying(&mut self, data: &Data, scales: &Scales) -> bool {
        if !self.follows_hidden_load(data) {
            return false;
        }
        let mut trial = self.clone();
        trial.structure.load_begin = LoadBegin::Carried;
        trial.follow_starts(data);
        for _ in 0..FEWEST_POLISHINGS {
            trial.polish_once(data, scales);
        }
        let better = trial.cost < CARRIED * self.cost;
        if better {
            *self = trial;
        }
        better
    }

    /// Takes up the motion from the present starts.
    pub(in crate::criticism) fn follow_starts(&mut self, data: &Data) {
        self.motion = self.simulate(data, &self.values, &self.starts);
        self.cost = self.objective(data, &self.motion, &self.values, ODD_MEAN_SQUARE);
    }

    /// Takes for each window its state of `trial` where that fits better.
    pub(in crate::criticism) fn take_better(&mut self, data: &Data, trial: &[Start]) {
        let kept = (self.starts.clone(), self.cost);
        let motion = self.simulate(data, &self.values, trial);
        let before = window_costs(data, &self.motion);
        let after = window_costs(data, &motion);
        // A slow sensor carries over from window to window, and a load may; apart from that each has its own motion.
        let slow = self.structure.model(&self.values).sensor_lag.is_some();
        let apart = !slow && self.structure.load_begin != LoadBegin::Carried;
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
            if self.structure.load_begin == LoadBegin::Carried && self.cost > kept.1 {
                self.starts = kept.0;
                self.follow_starts(data);
            }
        }
    }
}
