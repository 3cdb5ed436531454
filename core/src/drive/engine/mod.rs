//! The hybrid engine: from event to event by exact flows.

mod guards;
mod switching;

use std::collections::VecDeque;

use crate::drive::flow::{REACH, Rates, Step};
use crate::drive::polynomial::integral_of_square;
use crate::drive::relay::{Command, VelocityRelay};
use crate::drive::state::{Friction, State};
use crate::drive::trajectory::{DriveRun, Event, EventKind, Side};
use crate::drive::{Contact, Drive, DriveError, DriveInput};

/// Runs a drive.
///
/// Guards are the relay's thresholds, the stops and break-aways of either mass, and the ends of the gap; their instants
/// are zeros of the series to round-off. Impacts that die out in ever shorter bounces end in contact once they rebound
/// with 1e-9 of the fastest speed (1e-6 where they hardly die out). A run that goes on switching without end is cut,
/// see [`DriveRun::chattering`].
///
/// # Errors
/// A value out of its range.
pub fn run(input: &DriveInput) -> Result<DriveRun, DriveError> {
    let mut job = DriveJob::new(input)?;
    while !job.advance(usize::MAX) {}
    Ok(job.finish())
}

/// A run in pieces, so that a caller can draw in between.
#[derive(Clone, Debug)]
pub struct DriveJob {
    drive: Drive,
    relay: Option<VelocityRelay>,
    rates: Rates,
    state: State,
    time: f64,
    duration: f64,
    /// Distance of samples, and how many there are.
    sampling: Option<f64>,
    samples: u64,
    /// Torque that acts, and those that are on their way.
    u: f64,
    coming: VecDeque<(f64, f64)>,
    commanded: f64,
    /// State of the relay.
    high: bool,
    turned: bool,
    flips: u64,
    /// When a sampled relay looks again; `None` while the velocity has not crossed its threshold.
    look: Option<f64>,
    /// Fastest speed so far.
    fastest: f64,
    /// Events without progress.
    idle: usize,
    max_events: usize,
    done: bool,
    run: DriveRun,
}

/// Share of the duration that counts as no progress, and events without any before a run is cut.
const NO_PROGRESS: f64 = 1e-12;
const MAX_IDLE: usize = 10_000;

/// A step need not reach further than this many times the time to the next switch.
const LOOK_AHEAD: f64 = 4.0;

/// Share of the rest of a run below which steps are not shortened for that.
const SHORTEST: f64 = 1e-4;

impl DriveJob {
    /// Prepares a run.
    ///
    /// # Errors
    /// A value out of its range.
    pub fn new(input: &DriveInput) -> Result<Self, DriveError> {
        input.validate()?;
        let start = input.start;
        let relay = match input.command {
            Command::Torque(_) => None,
            Command::Relay(relay) => Some(relay),
        };
        let mut job = Self {
            drive: input.drive,
            relay,
            rates: Rates::of(&input.drive),
            state: State {
                x1: start.x1,
                v1: start.v1,
                v2: start.v2,
                gap: start.x1 - start.x2,
                motor: Friction::Up,
                load: Friction::Up,
                joint: None,
            },
            time: 0.0,
            duration: input.duration,
            sampling: input.step,
            samples: 0,
            u: 0.0,
            coming: VecDeque::new(),
            commanded: 0.0,
            high: false,
            turned: false,
            flips: 0,
            look: None,
            fastest: start.v1.abs().max(start.v2.abs()),
            idle: 0,
            max_events: input.max_events,
            done: false,
            run: DriveRun::default(),
        };
        job.u = match input.command {
            Command::Torque(u) => u,
            Command::Relay(relay) => {
                job.high = start.v1 > relay.relay.hysteresis;
                relay.output(job.high, false)
            }
        };
        job.commanded = job.u;
        job.run.energy.initial = job.drive.kinetic_energy(start.v1, start.v2);
        job.press_at_start();
        job.state.settle(&job.drive, job.u);
        Ok(job)
    }

    /// Goes on for so many events at most; true when the run is finished.
    pub fn advance(&mut self, events: usize) -> bool {
        for _ in 0..events {
            if self.done {
                return true;
            }
            self.go();
        }
        self.done
    }

    /// The time that has been reached, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// What has happened so far.
    pub fn so_far(&self) -> &DriveRun {
        &self.run
    }

    /// The run.
    pub fn finish(mut self) -> DriveRun {
        let s = self.state;
        self.run.energy.kinetic = self.drive.kinetic_energy(s.v1, s.v2);
        self.run.energy.elastic = if s.joint.is_some() {
            self.elastic_energy()
        } else {
            0.0
        };
        self.run
    }

    /// A compliant contact that is pressed at the start acts from there on.
    fn press_at_start(&mut self) {
        if !matches!(self.drive.contact, Contact::Compliant { .. }) {
            return;
        }
        for side in [Side::Upper, Side::Lower] {
            if self.depth(side) > 0.0 {
                self.state.joint = Some(side);
                if side.sign() * self.state.spring_force(&self.drive) > 0.0 {
                    self.run.energy.initial += self.elastic_energy();
                } else {
                    self.state.joint = None;
                }
            }
        }
    }

    /// One step, to the next event or as far as its series reaches.
    fn go(&mut self) {
        if self.crossed() {
            self.crossing();
            return;
        }
        let limit = self.next_instant();
        let left = limit - self.time;
        if left > 0.0 {
            let h = self.step_length(left);
            let step = Step::new(&self.drive, &self.state, self.u, h);
            let (z, guard) = self.first_guard(&step);
            let reached = if guard.is_none() && h >= left {
                limit
            } else {
                self.time + z * h
            };
            self.progress(reached);
            self.sample(&step, reached);
            self.move_to(&step, z);
            self.time = reached;
            if let Some(guard) = guard {
                self.handle(guard);
            }
            if guard.is_some() || h < left {
                return;
            }
        }
        self.handle_instant();
    }

    /// Counts events that bring the run no further, and cuts one that stands still.
    fn progress(&mut self, reached: f64) {
        self.idle = if reached - self.time > NO_PROGRESS * self.duration {
            0
        } else {
            self.idle + 1
        };
        if self.idle > MAX_IDLE || self.run.events.len() >= self.max_events {
            self.run.chattering = Some(reached);
            self.done = true;
        }
    }

    fn step_length(&self, left: f64) -> f64 {
        let pressed = self.state.joint.is_some();
        let rate = if pressed {
            self.rates.pressed
        } else {
            self.rates.free
        };
        let mut h = left.min(REACH / rate);
        if let Some(relay) = self.relay {
            let motor = self.drive.motor;
            let speed = self.state.v1.abs() + relay.relay.hysteresis;
            let time = speed * motor.inertia / (self.u.abs() + motor.coulomb);
            h = h.min((LOOK_AHEAD * time).max(SHORTEST * left));
        }
        h
    }

    fn depth(&self, side: Side) -> f64 {
        side.sign() * self.state.gap - self.drive.half_gap
    }

    fn elastic_energy(&self) -> f64 {
        match (self.drive.contact, self.state.joint) {
            (Contact::Compliant { stiffness, .. }, Some(side)) => {
                0.5 * stiffness * self.depth(side).powi(2)
            }
            _ => 0.0,
        }
    }

    /// Moves the state along a step and books the energy.
    fn move_to(&mut self, step: &Step, z: f64) {
        let (s, drive) = (&mut self.state, &self.drive);
        let n = step.terms;
        let [v1, v2, gap] = step.values(z);
        let moved = step.motor_travel(z);
        let moved_load = moved - (gap - s.gap);
        let energy = &mut self.run.energy;
        energy.supplied += self.u * moved;
        energy.coulomb += drive.motor.coulomb * moved.abs() + drive.load.coulomb * moved_load.abs();
        for (body, v) in [(drive.motor, &step.v1), (drive.load, &step.v2)] {
            if body.viscous > 0.0 {
                energy.viscous += body.viscous * step.h * integral_of_square(&v[..n], z);
            }
        }
        if let Some(spring) = s.spring(drive)
            && spring.damping > 0.0
        {
            let rate = step.combine(0.0, 1.0, -1.0, 0.0);
            energy.contact += spring.damping * step.h * integral_of_square(&rate[..n], z);
        }
        s.x1 += moved;
        (s.v1, s.v2, s.gap) = (v1, v2, gap);
        self.fastest = self.fastest.max(v1.abs()).max(v2.abs());
    }

    /// Takes the samples of a step, up to but without the instant `end`.
    fn sample(&mut self, step: &Step, end: f64) {
        let Some(distance) = self.sampling else {
            return;
        };
        loop {
            let t = self.samples as f64 * distance;
            if t >= end {
                return;
            }
            let z = ((t - self.time) / step.h).max(0.0);
            let [v1, v2, gap] = step.values(z);
            self.note_sample(t, self.state.x1 + step.motor_travel(z), v1, v2, gap);
        }
    }

    fn note_sample(&mut self, t: f64, x1: f64, v1: f64, v2: f64, gap: f64) {
        self.samples += 1;
        self.run.time.push(t);
        self.run.input.push(self.u);
        self.run.x1.push(x1);
        self.run.v1.push(v1);
        self.run.x2.push(x1 - gap);
        self.run.v2.push(v2);
    }

    fn note(&mut self, kind: EventKind) {
        let s = &self.state;
        self.run.events.push(Event {
            time: self.time,
            kind,
            x1: s.x1,
            v1: s.v1,
            x2: s.x1 - s.gap,
            v2: s.v2,
        });
    }
}
