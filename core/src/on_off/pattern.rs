//! Positions that repeat: when the input changes in a period, where the state comes to, and what must hold there.

use nalgebra::DVector;

use super::plant::Motion;
use super::relay::Position;
use super::run::{Cause, OnOffLoop, Switch};
use crate::simulate::State;

/// Positions and causes that repeat.
pub(super) struct Pattern<'a> {
    pub loop_: &'a OnOffLoop,
    pub motion: &'a Motion,
    pub positions: Vec<Position>,
    /// Why each ends.
    pub causes: Vec<Cause>,
    /// How long each lasts, s.
    pub durations: Vec<f64>,
}

/// A change of the acting input within a period, s from its begin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    pub time: f64,
    pub value: f64,
}

impl<'a> Pattern<'a> {
    /// The pattern between the first and the last of these switches; `None` where they take no time.
    pub fn of(loop_: &'a OnOffLoop, motion: &'a Motion, switches: &[Switch]) -> Option<Self> {
        let durations = switches.windows(2).map(|s| s[1].time - s[0].time).collect();
        let (_, ends) = switches.split_first()?;
        let begins = &switches[..ends.len()];
        (ends.last()?.time > begins.first()?.time).then(|| Self {
            loop_,
            motion,
            positions: begins.iter().map(|s| s.to).collect(),
            causes: ends.iter().map(|s| s.cause).collect(),
            durations,
        })
    }

    /// The acting input just after the begin of a period, and its changes up to the end.
    pub fn arrivals(&self, durations: &[f64]) -> (f64, Vec<Arrival>) {
        let period: f64 = durations.iter().sum();
        let lag = self.loop_.lag();
        let mut begin = 0.0;
        let mut all = Vec::new();
        for (position, duration) in self.positions.iter().zip(durations) {
            let mut time = (begin + lag).rem_euclid(period);
            if let Some(step) = self.loop_.plant.sampling() {
                time = (time / step - 1e-9).ceil() * step;
                time = if time >= period * (1.0 - 1e-12) {
                    0.0
                } else {
                    time
                };
            }
            let value = self.loop_.relay.output(*position);
            all.push(Arrival { time, value });
            begin += duration;
        }
        all.sort_by(|a, b| a.time.total_cmp(&b.time));
        let first = all.last().map_or(0.0, |last| last.value);
        let at_begin = all.partition_point(|a| a.time <= 0.0);
        let first = all[..at_begin].last().map_or(first, |a| a.value);
        (first, all.split_off(at_begin))
    }

    /// The states at the ends of the positions, from `x` at the begin.
    pub fn states(&self, durations: &[f64], x: &State) -> Vec<State> {
        let (mut u, arrivals) = self.arrivals(durations);
        let mut arrivals = arrivals.into_iter().peekable();
        let (mut x, mut now, mut end) = (*x, 0.0, 0.0);
        let mut states = Vec::with_capacity(durations.len());
        for duration in durations {
            end += duration;
            while let Some(arrival) = arrivals.next_if(|a| a.time < end) {
                x = self.motion.after(&x, u, arrival.time - now);
                (now, u) = (arrival.time, arrival.value);
            }
            x = self.motion.after(&x, u, end - now);
            now = end;
            states.push(x);
        }
        states
    }

    /// The threshold at which a position ends, where a crossing ends it.
    pub fn threshold(&self, i: usize) -> Option<f64> {
        let [low, high] = self.loop_.relay.guards(self.positions[i]);
        match self.causes[i] {
            Cause::Rising => Some(high),
            Cause::Falling => Some(low),
            Cause::HoldEnd | Cause::Sample => None,
        }
    }

    /// By how much the state is another one after a period, and the output off the thresholds at its switches.
    pub fn residual(&self, durations: &[f64], x: &State) -> Option<DVector<f64>> {
        let n = self.loop_.plant.order();
        let states = self.states(durations, x);
        let end = states.last()?;
        let mut residual: Vec<f64> = (0..n).map(|i| end[i] - x[i]).collect();
        for (i, state) in states.iter().enumerate() {
            residual.extend(self.threshold(i).map(|t| self.motion.output(state) - t));
        }
        let fine = residual.iter().all(|v| v.is_finite());
        fine.then(|| DVector::from_vec(residual))
    }
}
