//! The event-driven run: from switch to switch by exact flows.
//!
//! Each step carries the series of every output over the whole step, so that a crossing is found as the
//! first root of a polynomial, between its extrema, and no pair of crossings can hide between samples.

use std::collections::VecDeque;

use super::flow::{Flow, State};
use super::noise::NoiseAlong;
use super::series::{Curve, TERMS, first_rise, is_resolved, power_derivative, value};
use super::sliding::Sliding;
use super::trajectory::{Cut, Trajectory};
use crate::relay::Relay;

/// Steps after which a run is cut: the fastest mode of a plant may be a billion times faster than its cycle.
pub const MAX_STEPS: usize = 3_000_000;

/// The first and the last of so many parts of all switches are compared where a run has too many of them.
const COMPARED_PARTS: usize = 10;

/// Share of the time which the first switches take that the last ones take where they follow each other ever faster.
/// (Those that die away as slowly as 1/k, towards a threshold that cannot be slid along, take a hundredth of it.)
const EVER_FASTER: f64 = 0.1;

/// Share of the time in which the plant moves within which no relay with hysteresis or delay switches.
const FAR_FASTER: f64 = 1e-6;

/// A relay and what it has recorded.
#[derive(Clone, Debug)]
struct Channel {
    relay: Relay,
    /// Delay from switch to input, dead time included, s.
    lag: f64,
    high: bool,
    noise: Option<NoiseAlong>,
    swing: Option<[f64; 2]>,
    out: Trajectory,
}

/// A change of an input that is on its way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// When, s.
    pub time: f64,
    /// Which input.
    pub channel: usize,
    /// To what.
    pub value: f64,
}

/// A running loop.
pub(crate) struct Engine<'a> {
    flow: &'a Flow,
    sliding: Option<Sliding>,
    channels: Vec<Channel>,
    /// The outputs over the present step.
    curves: Vec<Curve>,
    /// State.
    pub x: State,
    u: Vec<f64>,
    pending: VecDeque<Change>,
    now: f64,
    level: usize,
    /// Switches left.
    budget: usize,
    /// Instant of the next sample and distance of samples, s; samples so far.
    sampling: Option<(f64, usize)>,
    slides: Option<f64>,
}

/// What the outputs do within one step.
struct Step {
    level: usize,
    /// End of the part that is looked at, as `z` in [-1, 1].
    end: f64,
    /// First crossing and its channel.
    crossing: Option<(f64, usize)>,
}

impl<'a> Engine<'a> {
    /// A loop in state `x` at time 0; inputs are those of the relays unless `pending` changes them.
    pub fn new(flow: &'a Flow, relays: &[Relay], lags: &[f64], x: State, budget: usize) -> Self {
        let channels: Vec<Channel> = relays
            .iter()
            .zip(lags)
            .enumerate()
            .map(|(i, (relay, lag))| Channel {
                relay: *relay,
                lag: *lag,
                high: flow.output(&x, i) > relay.hysteresis,
                noise: None,
                swing: None,
                out: Trajectory::default(),
            })
            .collect();
        let u: Vec<f64> = channels.iter().map(|c| c.relay.output(c.high)).collect();
        let mut engine = Self {
            flow,
            sliding: None,
            curves: vec![Curve::new([0.0; TERMS]); channels.len()],
            channels,
            x,
            u,
            pending: VecDeque::new(),
            now: 0.0,
            level: 0,
            budget,
            sampling: None,
            slides: None,
        };
        for i in 0..engine.channels.len() {
            engine.record_input(i);
        }
        engine
    }

    /// Lets an ideal relay without delay slide where the plant allows it.
    pub fn allow_sliding(&mut self, sliding: Option<Sliding>) {
        self.sliding = sliding;
    }

    /// Adds noise to what the relays see.
    pub fn add_noise(&mut self, noise: super::Noise) {
        for (i, channel) in self.channels.iter_mut().enumerate() {
            channel.noise = Some(NoiseAlong::new(noise, i as u64));
        }
    }

    /// Records the outputs every `step` s from now on.
    pub fn sample_every(&mut self, step: f64) {
        self.sampling = Some((step, 0));
    }

    /// Sets a relay and its acting input, and what is on its way.
    pub fn set(&mut self, channel: usize, high: bool, u: f64, pending: &[Change]) {
        if let (Some(c), Some(input)) = (self.channels.get_mut(channel), self.u.get_mut(channel)) {
            c.high = high;
            *input = u;
            c.out.input.clear();
            self.record_input(channel);
        }
        self.pending.extend(pending);
    }

    /// What was recorded, per relay.
    pub fn finish(mut self) -> Vec<Trajectory> {
        self.end_slide();
        self.channels.into_iter().map(|c| c.out).collect()
    }

    /// What was recorded so far by relay `i`.
    pub fn trajectory(&self, i: usize) -> Option<&Trajectory> {
        self.channels.get(i).map(|c| &c.out)
    }

    /// Since when an output has been sliding, s.
    pub fn slides_since(&self) -> Option<f64> {
        self.slides
    }

    /// Smallest and largest output of relay `i` since its last rise or since [`Engine::watch`].
    pub fn swing(&self, i: usize) -> Option<[f64; 2]> {
        self.channels.get(i).and_then(|c| c.swing)
    }

    /// Begins to watch the extrema now.
    pub fn watch(&mut self) {
        for (i, channel) in self.channels.iter_mut().enumerate() {
            let y = self.flow.output(&self.x, i);
            channel.swing = Some([y, y]);
        }
    }

    fn record_input(&mut self, i: usize) {
        self.channels[i].out.input.push([self.now, self.u[i]]);
    }

    /// Runs until `end` s; false if the relay switched too often, or a plant much faster than the run takes too many
    /// steps.
    pub fn run(&mut self, end: f64) -> bool {
        let mut steps = 0;
        // A step that does not move time on is an event, and events are counted.
        while self.now < end {
            steps += 1;
            let mut limit = end;
            if let Some(change) = self.pending.front() {
                limit = limit.min(change.time);
            }
            for channel in &self.channels {
                if let Some(noise) = &channel.noise {
                    limit = limit.min(noise.end());
                }
            }
            if limit > self.now {
                let fine = if self.slides.is_some() {
                    self.slide(limit)
                } else {
                    self.advance(limit)
                };
                let cut = if !fine && self.chatters() {
                    Some(Cut::Chattering)
                } else if !fine {
                    Some(Cut::TooManySwitches)
                } else if steps > MAX_STEPS {
                    Some(Cut::TooFast)
                } else {
                    None
                };
                if cut.is_some() {
                    for channel in &mut self.channels {
                        channel.out.cut = cut;
                    }
                    return false;
                }
            }
            self.arrive();
        }
        true
    }

    /// Whether the relays have switched ever faster, or far faster than the plant moves.
    fn chatters(&self) -> bool {
        let mut times: Vec<f64> = self
            .channels
            .iter()
            .flat_map(|c| c.out.rises.iter().chain(&c.out.falls).copied())
            .collect();
        times.sort_by(f64::total_cmp);
        let part = times.len() / COMPARED_PARTS;
        let taken = |all: &[f64]| all.last().zip(all.first()).map_or(0.0, |(b, a)| b - a);
        let first = taken(&times[..part]);
        let last = taken(&times[times.len() - part..]);
        last < EVER_FASTER * first || last < FAR_FASTER * part as f64 * self.flow.step(0)
    }

    /// Handles what is due now: changes of inputs and new pieces of noise.
    fn arrive(&mut self) {
        while let Some(change) = self.pending.front().copied().filter(|c| c.time <= self.now) {
            self.pending.pop_front();
            self.note_extremes();
            self.u[change.channel] = change.value;
            self.record_input(change.channel);
        }
        for channel in &mut self.channels {
            if let Some(noise) = &mut channel.noise {
                noise.go_to(self.now);
            }
        }
    }

    fn note_extremes(&mut self) {
        for i in 0..self.channels.len() {
            self.note(i, self.flow.output(&self.x, i));
        }
    }

    fn note(&mut self, i: usize, y: f64) {
        if let Some([low, high]) = &mut self.channels[i].swing {
            *low = low.min(y);
            *high = high.max(y);
        }
    }

    /// One step, at most to `limit`, ending early at a switch.
    fn advance(&mut self, limit: f64) -> bool {
        let span = limit - self.now;
        while self.level > 0 && self.flow.step(self.level - 1) >= span {
            self.level -= 1;
        }
        let mut curves = std::mem::take(&mut self.curves);
        loop {
            let mut resolved = true;
            for (i, curve) in curves.iter_mut().enumerate() {
                let (c, noise) = self.flow.series(self.level, i, &self.x, &self.u);
                resolved &= self.level == 0 || is_resolved(&c, noise);
                *curve = Curve::new(c);
            }
            if resolved {
                break;
            }
            self.level -= 1;
        }
        let h = self.flow.step(self.level);
        let whole = span >= h;
        let mut step = Step {
            level: self.level,
            end: if whole { 1.0 } else { 2.0 * span / h - 1.0 },
            crossing: None,
        };
        for (i, curve) in curves.iter_mut().enumerate() {
            self.analyse(i, curve, h, &mut step);
        }
        let z = step.crossing.map_or(step.end, |(z, _)| z);
        let t = 0.5 * h * (z + 1.0);
        for (i, curve) in curves.iter_mut().enumerate() {
            self.watch_extrema(i, curve, step.end, z);
        }
        self.sample_until(self.now + t, &mut curves, h);
        self.curves = curves;
        if step.crossing.is_none() && whole {
            self.x = self.flow.after_step(step.level, &self.x, &self.u);
            self.now += h;
            self.level = (self.level + 1).min(self.flow.levels().saturating_sub(1));
        } else {
            self.x = self.flow.after(&self.x, &self.u, t);
            self.now = if step.crossing.is_some() {
                self.now + t
            } else {
                limit
            };
        }
        let Some((_, channel)) = step.crossing else {
            return true;
        };
        self.switch(channel);
        if self.budget == 0 {
            return false;
        }
        self.budget -= 1;
        true
    }

    /// Finds the first crossing of channel `i` in the step, if before the one found already.
    fn analyse(&self, i: usize, curve: &mut Curve, h: f64, step: &mut Step) {
        let channel = &self.channels[i];
        let mut noisy;
        let seen = if let Some(noise) = &channel.noise {
            let mut c = *curve.coefficients();
            noise.add_to(&mut c, self.now, h);
            noisy = Curve::new(c);
            &mut noisy
        } else {
            curve
        };
        // The distance beyond the threshold: y - eps on the way up, -eps - y on the way down.
        let [low, high] = seen.bounds();
        let (sign, reach) = if channel.high {
            (-1.0, -low)
        } else {
            (1.0, high)
        };
        if reach <= channel.relay.hysteresis {
            return;
        }
        let mut beyond = seen.powers().map(|v| sign * v);
        beyond[0] -= channel.relay.hysteresis;
        let turns = seen.turns(step.end);
        let end = step.crossing.map_or(step.end, |(z, _)| z);
        if let Some(z) = first_rise(&beyond, turns.before(end), -1.0, end) {
            step.crossing = Some((z, i));
        }
    }

    /// Notes the extrema of output `i` up to `z` in a step that ends at `end`.
    fn watch_extrema(&mut self, i: usize, curve: &mut Curve, end: f64, z: f64) {
        let Some([low, high]) = self.channels[i].swing else {
            return;
        };
        let [lowest, highest] = curve.bounds();
        if lowest >= low && highest <= high {
            return;
        }
        let turns = *curve.turns(end);
        for turn in turns.before(z) {
            self.note(i, value(curve.powers(), *turn));
        }
    }

    fn switch(&mut self, i: usize) {
        self.note_extremes();
        let y = self.flow.output(&self.x, i);
        let now = self.now;
        let channel = &mut self.channels[i];
        channel.high = !channel.high;
        if channel.high {
            channel.out.rises.push(now);
            if channel.out.rises.len() > 1
                && let Some(swing) = channel.swing
            {
                channel.out.swings.push(swing);
            }
            channel.swing = Some([y, y]);
        } else {
            channel.out.falls.push(now);
        }
        let value = channel.relay.output(channel.high);
        let noise_slope = channel.noise.as_ref().map_or(0.0, NoiseAlong::slope);
        if channel.lag > 0.0 {
            let change = Change {
                time: now + channel.lag,
                channel: i,
                value,
            };
            // Relays with different delays: keep the queue in order.
            let at = self.pending.partition_point(|c| c.time <= change.time);
            self.pending.insert(at, change);
            return;
        }
        if let Some(sliding) = &self.sliding
            && channel.relay.hysteresis == 0.0
        {
            let held = sliding.input(&self.x, noise_slope);
            if held > channel.relay.output(true) && held < channel.relay.output(false) {
                self.slides = Some(now);
                self.u[i] = held;
                self.record_input(i);
                return;
            }
        }
        self.u[i] = value;
        self.record_input(i);
    }

    /// One step along the threshold, at most to `limit`, ending where the relay cannot hold the output.
    fn slide(&mut self, limit: f64) -> bool {
        let Some(sliding) = self.sliding.take() else {
            return false;
        };
        let relay = self.channels[0].relay;
        let slope = (self.channels[0].noise.as_ref()).map_or(0.0, NoiseAlong::slope);
        let step = sliding.step(
            &self.x,
            slope,
            limit - self.now,
            [relay.output(true), relay.output(false)],
        );
        self.sample_slide(&sliding, self.now + step.time, slope);
        self.x = step.x;
        self.now = if step.leaves.is_none() && step.to_limit {
            limit
        } else {
            self.now + step.time
        };
        if let Some(high) = step.leaves {
            self.end_slide();
            self.channels[0].high = high;
            self.u[0] = relay.output(high);
            self.record_input(0);
            self.level = 0;
        }
        self.sliding = Some(sliding);
        if step.leaves.is_some() {
            if self.budget == 0 {
                return false;
            }
            self.budget -= 1;
        }
        true
    }

    fn end_slide(&mut self) {
        if let Some(start) = self.slides.take() {
            self.channels[0].out.sliding.push([start, self.now]);
        }
    }

    fn sample_slide(&mut self, sliding: &Sliding, end: f64, noise_slope: f64) {
        let Some((step, mut count)) = self.sampling else {
            return;
        };
        while count as f64 * step < end {
            let t = count as f64 * step;
            let x = sliding.after(&self.x, noise_slope, t - self.now);
            let y = self.flow.output(&x, 0);
            let u = sliding.input(&x, noise_slope);
            let out = &mut self.channels[0].out;
            out.time.push(t);
            out.output.push(y);
            out.slope.push(-noise_slope);
            out.input.push([t, u]);
            count += 1;
        }
        self.sampling = Some((step, count));
    }

    /// Records samples from now to before `end` from the series of the step.
    fn sample_until(&mut self, end: f64, curves: &mut [Curve], h: f64) {
        let Some((step, first)) = self.sampling else {
            return;
        };
        if first as f64 * step >= end || curves.is_empty() {
            return;
        }
        let mut count = first;
        for (curve, channel) in curves.iter_mut().zip(&mut self.channels) {
            let m = curve.powers();
            let d = power_derivative(m);
            count = first;
            while (count as f64) * step < end {
                let t = count as f64 * step;
                let z = 2.0 * (t - self.now) / h - 1.0;
                channel.out.time.push(t);
                channel.out.output.push(value(m, z));
                channel.out.slope.push(2.0 / h * value(&d, z));
                count += 1;
            }
        }
        self.sampling = Some((step, count));
    }
}
