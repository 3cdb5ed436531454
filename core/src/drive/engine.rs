//! The hybrid engine: from event to event by exact flows.

use std::collections::VecDeque;

use super::flow::{REACH, Rates, Step};
use super::modes::{Friction, State, holding, pull_share};
use super::polynomial::{first_rise, integral_of_square};
use super::relay::{Command, VelocityRelay};
use super::trajectory::{DriveRun, Event, EventKind, Mass, Side};
use super::{Contact, Drive, DriveError, DriveInput};

/// Runs a drive.
///
/// Guards are the relay's thresholds, the stops and break-aways of either mass, and the ends of the gap;
/// their instants are zeros of the series to round-off. Impacts that die out in ever shorter bounces
/// end in contact once they rebound with 1e-9 of the fastest speed. A run that goes on switching without
/// end is cut, see [`DriveRun::chattering`].
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

/// What ends a step before its time.
#[derive(Clone, Copy, Debug)]
enum Guard {
    Relay,
    Stop(Mass),
    Break(Mass),
    Hit(Side),
    Release(Side),
    Repress(Side),
    Relax,
}

/// Share of the fastest speed below which a rebound counts as none: with loss at every impact, and
/// without (round-off).
const NO_BOUNCE: f64 = 1e-9;
const NO_ELASTIC_BOUNCE: f64 = 1e-13;

/// Share of the duration that counts as no progress, and events without any before a run is cut.
const NO_PROGRESS: f64 = 1e-12;
const MAX_IDLE: usize = 10_000;

/// A step need not reach further than this many times the time to the next switch.
const LOOK_AHEAD: f64 = 4.0;

/// Share of the rest of a run below which steps are not shortened for that.
const SHORTEST: f64 = 1e-4;

/// Share of the sampling time by which an instant may miss its sample by round-off.
const SAME_INSTANT: f64 = 1e-9;

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

    /// The next instant that is known beforehand.
    fn next_instant(&self) -> f64 {
        let mut next = self.duration;
        if let Some(look) = self.look {
            next = next.min(look);
        }
        if let Some((t, _)) = self.coming.front() {
            next = next.min(*t);
        }
        if let Some(t) = self.next_flip() {
            next = next.min(t);
        }
        next
    }

    fn next_flip(&self) -> Option<f64> {
        let flip = self.relay?.flip?;
        Some((self.flips + 1) as f64 * flip)
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

    /// The first guard that a step meets, and where; its end and `None` if it meets none.
    fn first_guard(&self, step: &Step) -> (f64, Option<Guard>) {
        let mut first = (1.0, None);
        let mut meet = |guard: Guard, constant: f64, a: f64, b: f64, c: f64| {
            let g = step.combine(constant, a, b, c);
            if let Some(z) = first_rise(&g[..step.terms], first.0)
                && (z < first.0 || first.1.is_none())
            {
                first = (z, Some(guard));
            }
        };
        let (s, drive) = (&self.state, &self.drive);
        if let (Some(relay), None) = (self.relay, self.look) {
            let sign = if self.high { -1.0 } else { 1.0 };
            meet(Guard::Relay, -relay.relay.hysteresis, sign, 0.0, 0.0);
        }
        let rigid = matches!(drive.contact, Contact::Rigid { .. });
        let together = rigid && s.joint.is_some();
        let level = drive.motor.coulomb + if together { drive.load.coulomb } else { 0.0 };
        if level > 0.0 && s.motor != Friction::Stuck {
            meet(Guard::Stop(Mass::Motor), 0.0, -s.motor.sign(), 0.0, 0.0);
        }
        if drive.load.coulomb > 0.0 && s.load != Friction::Stuck && !together {
            meet(Guard::Stop(Mass::Load), 0.0, 0.0, -s.load.sign(), 0.0);
        }
        if let Some(spring) = s.spring(drive) {
            let side = s.joint.map_or(1.0, Side::sign);
            let (k, d, offset) = (spring.stiffness, spring.damping, spring.offset);
            let hold = s.joint.map_or(0.0, |side| holding(drive, side));
            let end = s.joint.map_or(Guard::Relax, Guard::Release);
            meet(end, side * offset - hold, -side * d, side * d, -side * k);
            for sign in [1.0, -1.0] {
                if s.motor == Friction::Stuck {
                    let constant = sign * (self.u + offset) - drive.motor.coulomb;
                    let guard = Guard::Break(Mass::Motor);
                    meet(guard, constant, -sign * d, sign * d, -sign * k);
                }
                if s.load == Friction::Stuck {
                    let constant = -sign * offset - drive.load.coulomb;
                    meet(
                        Guard::Break(Mass::Load),
                        constant,
                        sign * d,
                        -sign * d,
                        sign * k,
                    );
                }
            }
        } else if let Some(side) = s.joint {
            if s.motor != Friction::Stuck {
                let sign = -side.sign();
                let dry = sign * s.load.sign() * drive.load.coulomb;
                let hold = holding(drive, side) + pull_share(drive, self.u);
                let (j, d) = (sign * drive.load.inertia, sign * drive.load.viscous);
                let g = step.motor_force(j, d, dry - hold);
                if let Some(z) = first_rise(&g[..step.terms], first.0)
                    && (z < first.0 || first.1.is_none())
                {
                    first = (z, Some(Guard::Release(side)));
                }
            }
        } else {
            for side in [Side::Upper, Side::Lower] {
                let sign = side.sign();
                match drive.contact {
                    Contact::Compliant { stiffness, damping } if self.depth(side) > 0.0 => {
                        let (k, d) = (sign * stiffness, sign * damping);
                        meet(Guard::Repress(side), -stiffness * drive.half_gap, d, -d, k);
                        meet(Guard::Relax, drive.half_gap, 0.0, 0.0, -sign);
                    }
                    _ => meet(Guard::Hit(side), -drive.half_gap, 0.0, 0.0, sign),
                }
            }
        }
        first
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

    /// Sets the modes anew and notes what changed.
    fn settle(&mut self) {
        let before = self.state;
        self.state.settle(&self.drive, self.u);
        let after = self.state;
        match (before.joint, after.joint) {
            (None, Some(side)) => self.note(EventKind::Touch(side)),
            (Some(side), None) => self.note(EventKind::Part(side)),
            _ => {}
        }
        let masses = [
            (Mass::Motor, self.drive.motor, before.motor, after.motor),
            (Mass::Load, self.drive.load, before.load, after.load),
        ];
        for (mass, body, was, is) in masses {
            if was != is && body.coulomb > 0.0 {
                self.note(match is {
                    Friction::Stuck => EventKind::Stick(mass),
                    _ => EventKind::Move(mass),
                });
            }
        }
    }

    fn handle(&mut self, guard: Guard) {
        let half_gap = self.drive.half_gap;
        match guard {
            Guard::Relay => {
                let relay = self.relay.unwrap_or_default().relay;
                self.state.v1 = if self.high {
                    -relay.hysteresis
                } else {
                    relay.hysteresis
                };
                self.crossing();
            }
            Guard::Stop(mass) => {
                let rigid = matches!(self.drive.contact, Contact::Rigid { .. });
                let together = rigid && self.state.joint.is_some();
                if mass == Mass::Motor || together {
                    self.state.v1 = 0.0;
                }
                if mass == Mass::Load || together {
                    self.state.v2 = 0.0;
                }
                self.settle();
            }
            Guard::Break(mass) => {
                let force = self.state.spring_force(&self.drive);
                let (friction, force) = match mass {
                    Mass::Motor => (&mut self.state.motor, self.u - force),
                    Mass::Load => (&mut self.state.load, force),
                };
                *friction = if force < 0.0 {
                    Friction::Down
                } else {
                    Friction::Up
                };
                self.note(EventKind::Move(mass));
            }
            Guard::Hit(side) => {
                self.state.gap = side.sign() * half_gap;
                match self.drive.contact {
                    Contact::Rigid { restitution } => self.impact(side, restitution),
                    Contact::Compliant { .. } => {
                        self.state.joint = Some(side);
                        self.note(EventKind::Touch(side));
                        self.settle();
                    }
                }
            }
            Guard::Release(side) => {
                self.run.energy.contact += self.elastic_energy();
                self.state.joint = None;
                self.note(EventKind::Part(side));
                self.settle_free();
            }
            Guard::Repress(side) => {
                if self.depth(side) > 0.0 {
                    self.state.joint = Some(side);
                    self.run.energy.contact -= self.elastic_energy();
                    self.note(EventKind::Touch(side));
                    self.settle();
                }
            }
            Guard::Relax => {}
        }
    }

    /// Friction of masses that have just parted.
    fn settle_free(&mut self) {
        let s = &mut self.state;
        s.motor = Friction::of(s.v1, self.u, self.drive.motor.coulomb);
        s.load = Friction::of(s.v2, 0.0, self.drive.load.coulomb);
    }

    /// Momentum is kept; the relative velocity turns round.
    fn impact(&mut self, side: Side, restitution: f64) {
        let (j1, j2) = (self.drive.motor.inertia, self.drive.load.inertia);
        let sign = side.sign();
        let s = &mut self.state;
        let before = self.drive.kinetic_energy(s.v1, s.v2);
        let approach = sign * (s.v1 - s.v2);
        let least = if restitution < 1.0 {
            NO_BOUNCE
        } else {
            NO_ELASTIC_BOUNCE
        };
        let stays = restitution * approach <= least * self.fastest;
        if stays {
            let common = (j1 * s.v1 + j2 * s.v2) / (j1 + j2);
            (s.v1, s.v2) = (common, common);
            s.joint = Some(side);
        } else {
            let exchanged = sign * (1.0 + restitution) * approach / (j1 + j2);
            s.v1 -= exchanged * j2;
            s.v2 += exchanged * j1;
            self.fastest = self.fastest.max(s.v1.abs()).max(s.v2.abs());
        }
        let s = &self.state;
        self.run.energy.contact += before - self.drive.kinetic_energy(s.v1, s.v2);
        self.note(if stays {
            EventKind::Touch(side)
        } else {
            EventKind::Impact(side, approach)
        });
        self.settle();
    }

    /// Whether the velocity has jumped beyond the relay's threshold.
    fn crossed(&self) -> bool {
        let (Some(relay), None) = (self.relay, self.look) else {
            return false;
        };
        if self.high {
            self.state.v1 < -relay.relay.hysteresis
        } else {
            self.state.v1 > relay.relay.hysteresis
        }
    }

    /// Whether a relay that looks now switches.
    fn at_threshold(&self) -> bool {
        let eps = self.relay.map_or(0.0, |r| r.relay.hysteresis);
        if self.high {
            self.state.v1 <= -eps
        } else {
            self.state.v1 >= eps
        }
    }

    /// The velocity is at or beyond the threshold: the relay switches, a sampled one when it looks.
    fn crossing(&mut self) {
        if let Some(sampling) = self.relay.and_then(|r| r.sampling) {
            self.look = Some((self.time / sampling - SAME_INSTANT).ceil() * sampling);
            return;
        }
        self.switch();
    }

    fn switch(&mut self) {
        self.high = !self.high;
        self.note(if self.high {
            EventKind::SwitchUp
        } else {
            EventKind::SwitchDown
        });
        self.command();
    }

    /// Sends what the relay says now on its way.
    fn command(&mut self) {
        let Some(relay) = self.relay else {
            return;
        };
        let u = relay.output(self.high, self.turned);
        if u == self.commanded {
            return;
        }
        self.commanded = u;
        if relay.relay.delay > 0.0 {
            self.coming.push_back((self.time + relay.relay.delay, u));
        } else {
            self.act(u);
        }
    }

    fn act(&mut self, u: f64) {
        self.u = u;
        self.note(EventKind::Input(u));
        self.settle();
    }

    /// Whatever is due at this instant.
    fn handle_instant(&mut self) {
        if let Some((t, u)) = self.coming.front().copied()
            && t <= self.time
        {
            self.coming.pop_front();
            self.act(u);
            return;
        }
        if self.next_flip().is_some_and(|t| t <= self.time) {
            self.flips += 1;
            self.turned = !self.turned;
            self.note(EventKind::Flip);
            match self.relay.and_then(|r| r.sampling) {
                Some(_) => self.crossing(),
                None => self.command(),
            }
            return;
        }
        if self.look.is_some_and(|t| t <= self.time) {
            self.look = None;
            if self.at_threshold() {
                self.switch();
            } else {
                self.command();
            }
            return;
        }
        if self.time >= self.duration {
            let s = self.state;
            let last = self.sampling.map(|d| self.samples as f64 * d);
            if last.is_some_and(|t| t <= self.duration) {
                self.note_sample(self.duration, s.x1, s.v1, s.v2, s.gap);
            }
            self.done = true;
        }
    }
}
