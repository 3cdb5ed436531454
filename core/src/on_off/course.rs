//! The run from event to event: arrivals of changes, ends of holds, sampling instants, and crossings of thresholds,
//! which are roots of the series that carry the output over a step.

use std::collections::VecDeque;

use super::plant::Motion;
use super::relay::{OnOffRelay, Position};
use super::run::{Cause, OnOffLoop, OnOffRun, Switch};
use crate::simulate::series::{Curve, first_rise, is_resolved, value};
use crate::simulate::{Cut, Flow, MAX_STEPS, Noise, NoiseAlong, State};

/// Times are the same that differ by less than this share of the sampling time.
const SAME_TICK: f64 = 1e-9;

/// An output that could move by less than this share of itself is at rest, and its extrema are round-off.
const AT_REST: f64 = 1e-12;

/// A running loop.
pub(super) struct Course<'a> {
    motion: &'a Motion,
    relay: &'a OnOffRelay,
    lag: f64,
    /// Sampling time, s, and instants of it so far.
    clock: Option<f64>,
    ticks: u64,
    pub x: State,
    pub now: f64,
    u: f64,
    pub position: Position,
    /// Noise on the output that the controller sees.
    noise: Option<NoiseAlong>,
    /// When it may switch again, while it may not.
    held_until: Option<f64>,
    /// Changes of the input on their way: when, and to what.
    pending: VecDeque<(f64, f64)>,
    level: usize,
    swing: [f64; 2],
    /// Distance of samples, s, and how many there are.
    record: Option<(f64, u64)>,
    budget: usize,
    pub out: OnOffRun,
}

impl<'a> Course<'a> {
    /// A loop in state `x` at time 0, free to switch.
    pub fn new(loop_: &'a OnOffLoop, motion: &'a Motion, x: State, budget: usize) -> Self {
        let y = motion.output(&x);
        let position = loop_.relay.first(y);
        let u = loop_.relay.output(position);
        Self {
            motion,
            relay: &loop_.relay,
            lag: loop_.lag(),
            clock: loop_.clock(),
            ticks: 0,
            x,
            now: 0.0,
            u,
            position,
            noise: None,
            held_until: None,
            pending: VecDeque::new(),
            level: 0,
            swing: [y, y],
            record: None,
            budget,
            out: OnOffRun {
                input: vec![[0.0, u]],
                ..OnOffRun::default()
            },
        }
    }

    /// Adds noise to what the controller sees, from the start on.
    pub fn add_noise(&mut self, noise: Noise) {
        self.noise = Some(NoiseAlong::new(noise, 0));
        self.position = self.relay.first(self.seen());
        self.u = self.relay.output(self.position);
        self.out.input = vec![[self.now, self.u]];
    }

    /// The output as the controller sees it now.
    fn seen(&self) -> f64 {
        let noise = self.noise.as_ref().map_or(0.0, |noise| noise.at(self.now));
        self.motion.output(&self.x) + noise
    }

    /// The same just after a switch to `position`, with what is on its way.
    pub fn just_switched(mut self, position: Position, u: f64, pending: &[(f64, f64)]) -> Self {
        self.position = position;
        self.u = u;
        self.pending.extend(pending);
        self.hold();
        // The instant at which it switched is over.
        self.ticks = 1;
        self
    }

    /// Records the output every `step` s from now on.
    pub fn record_every(&mut self, step: f64) {
        self.record = Some((step, 0));
    }

    /// Runs until `end` s, or until it is cut.
    pub fn run(&mut self, end: f64) {
        let mut steps = 0;
        loop {
            self.arrive();
            self.decide();
            self.note_sample();
            if self.now >= end || self.out.cut.is_some() {
                return;
            }
            steps += 1;
            if steps > MAX_STEPS {
                self.out.cut = Some(Cut::TooFast);
                return;
            }
            match self.motion {
                Motion::Flow(flow) => self.advance(flow, self.limit(end)),
                Motion::Steps(plant) => {
                    self.x = self.motion.after(&self.x, self.u, plant.sampling);
                    self.now = self.ticks as f64 * plant.sampling;
                    self.note(self.motion.output(&self.x));
                }
            }
        }
    }

    /// The next instant at which something is due, s.
    fn limit(&self, end: f64) -> f64 {
        let due = [
            self.pending.front().map(|change| change.0),
            self.clock.map(|clock| self.ticks as f64 * clock),
            self.held_until.filter(|_| self.clock.is_none()),
            (self.noise.as_ref().map(NoiseAlong::end)).filter(|_| self.clock.is_none()),
            self.record.map(|(step, count)| count as f64 * step),
        ];
        due.into_iter()
            .flatten()
            .filter(|t| *t > self.now)
            .fold(end, f64::min)
    }

    /// Lets changes of the input arrive, and the noise go on.
    fn arrive(&mut self) {
        if let Some(noise) = &mut self.noise {
            noise.go_to(self.now);
        }
        let tolerance = match self.motion {
            Motion::Flow(_) => 0.0,
            Motion::Steps(plant) => SAME_TICK * plant.sampling,
        };
        while let Some((_, value)) = self
            .pending
            .pop_front_if(|change| change.0 <= self.now + tolerance)
        {
            self.set(value);
        }
    }

    fn set(&mut self, u: f64) {
        self.u = u;
        self.out.input.push([self.now, u]);
    }

    /// Looks at the output where it is time to: at a sampling instant, or at the end of a hold.
    fn decide(&mut self) {
        let y = self.seen();
        if let Some(clock) = self.clock {
            if self.now < self.ticks as f64 * clock {
                return;
            }
            self.ticks += 1;
            let tolerance = SAME_TICK * clock;
            if self.held_until.is_some_and(|t| self.now < t - tolerance) {
                return;
            }
            if let Some(next) = self.relay.wanted(self.position, y) {
                self.switch(next, Cause::Sample);
            }
        } else if self.held_until.is_some_and(|t| self.now >= t) {
            self.held_until = None;
            if let Some(next) = self.relay.wanted(self.position, y) {
                self.switch(next, Cause::HoldEnd);
            }
        }
    }

    fn hold(&mut self) {
        let hold = self.relay.hold(self.position);
        self.held_until = (hold > 0.0).then_some(self.now + hold);
    }

    fn switch(&mut self, to: Position, cause: Cause) {
        self.position = to;
        self.hold();
        self.out.switches.push(Switch {
            time: self.now,
            to,
            cause,
            swing: self.swing,
        });
        let y = self.motion.output(&self.x);
        self.swing = [y, y];
        let value = self.relay.output(to);
        if self.lag > 0.0 {
            self.pending.push_back((self.now + self.lag, value));
        } else {
            self.set(value);
        }
        match self.budget.checked_sub(1) {
            Some(left) => self.budget = left,
            None => self.out.cut = Some(Cut::TooManySwitches),
        }
    }

    fn note(&mut self, y: f64) {
        self.swing = [self.swing[0].min(y), self.swing[1].max(y)];
    }

    fn note_sample(&mut self) {
        if let Some((step, count)) = &mut self.record
            && self.now >= *count as f64 * *step
        {
            *count += 1;
            self.out.time.push(self.now);
            self.out.output.push(self.motion.output(&self.x));
        }
    }

    /// One step, at most to `limit`, ending early where the output leaves the guards.
    fn advance(&mut self, flow: &Flow, limit: f64) {
        let span = limit - self.now;
        self.level = (self.level + 1).min(flow.levels().saturating_sub(1));
        while self.level > 0 && flow.step(self.level - 1) >= span {
            self.level -= 1;
        }
        let u = [self.u];
        let mut curve = loop {
            let (c, noise) = flow.series(self.level, 0, &self.x, &u);
            if self.level == 0 || is_resolved(&c, noise) {
                break Curve::new(c);
            }
            self.level -= 1;
        };
        let h = flow.step(self.level);
        let whole = span >= h;
        let end = if whole { 1.0 } else { 2.0 * span / h - 1.0 };
        let looks = self.clock.is_none() && self.held_until.is_none();
        let crossing = match &self.noise {
            _ if !looks => None,
            None => self.crossing(&mut curve, end),
            Some(noise) => {
                let mut seen = *curve.coefficients();
                noise.add_to(&mut seen, self.now, h);
                self.crossing(&mut Curve::new(seen), end)
            }
        };
        let z = crossing.map_or(end, |(z, _)| z);
        self.watch(&mut curve, end, z);
        if crossing.is_none() && whole {
            self.x = flow.after_step(self.level, &self.x, &u);
            self.now += h;
        } else {
            let t = 0.5 * h * (z + 1.0);
            self.x = flow.after(&self.x, &u, t);
            self.now = if crossing.is_some() {
                self.now + t
            } else {
                limit
            };
        }
        self.note(flow.output(&self.x, 0));
        let y = self.seen();
        if let Some((_, rising)) = crossing {
            let (next, cause) = if rising {
                (self.relay.next(self.position, true, y), Cause::Rising)
            } else {
                (self.relay.next(self.position, false, y), Cause::Falling)
            };
            self.switch(next, cause);
        }
    }

    /// Notes the extrema up to `z` in a step that ends at `end`, where there can be new ones.
    fn watch(&mut self, curve: &mut Curve, end: f64, z: f64) {
        let [low, high] = curve.bounds();
        let rests = high - low <= AT_REST * (low.abs() + high.abs());
        if rests || (low >= self.swing[0] && high <= self.swing[1]) {
            return;
        }
        let turns = *curve.turns(end);
        for turn in turns.before(z) {
            self.note(value(curve.powers(), *turn));
        }
    }

    /// Where in a step the output first leaves the guards, and whether upwards.
    fn crossing(&self, curve: &mut Curve, end: f64) -> Option<(f64, bool)> {
        let [low, high] = self.relay.guards(self.position);
        let bounds = curve.bounds();
        let mut found: Option<(f64, bool)> = None;
        for (rising, guard) in [(true, high), (false, low)] {
            let reached = if rising {
                bounds[1] > guard
            } else {
                bounds[0] < guard
            };
            if !reached {
                continue;
            }
            let sign = if rising { 1.0 } else { -1.0 };
            let mut beyond = curve.powers().map(|v| sign * v);
            beyond[0] -= sign * guard;
            let until = found.map_or(end, |(z, _)| z);
            let turns = *curve.turns(end);
            if let Some(z) = first_rise(&beyond, turns.before(until), -1.0, until) {
                found = Some((z, rising));
            }
        }
        found
    }
}
