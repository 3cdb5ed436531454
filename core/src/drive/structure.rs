//! Fig. 8 of the paper, the two-mass structure, at each instant of a run: which of its blocks act, the distance `d` in
//! the gap, and the momentum that equation (11) conserves.

use serde::{Deserialize, Serialize};

use super::Drive;
use super::trajectory::{DriveRun, Event, EventKind, Mass, Side};

/// Which blocks act at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DriveMode {
    /// The motor rests, held by its friction.
    pub motor_rests: bool,
    /// The load rests.
    pub load_rests: bool,
    /// The end of the gap at which motor and load are pressed together; `None` while the gap is open.
    pub pressed: Option<Side>,
    /// The last impact or touch, and how long ago it was, s.
    pub met: Option<(Side, f64)>,
}

/// An instant of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instant {
    /// When, s.
    pub time: f64,
    /// `d = x1 - x2`, rad (or m).
    pub distance: f64,
    /// `J1 v1` of the motor, N m s (or N s).
    pub motor: f64,
    /// `J2 v2` of the load.
    pub load: f64,
}

impl Instant {
    /// `J1 v1 + J2 v2`, which no impact changes.
    pub fn momentum(&self) -> f64 {
        self.motor + self.load
    }
}

impl DriveRun {
    /// The mode at a time in s.
    pub fn mode_at(&self, time: f64) -> DriveMode {
        let past = self.events.partition_point(|e| e.time <= time);
        let past = self.events.get(..past).unwrap_or_default();
        let sample = self.time.partition_point(|t| *t <= time).saturating_sub(1);
        let begin = self.time.get(sample).copied().unwrap_or(0.0);
        let end = self.time.get(sample + 1).copied().unwrap_or(begin);
        let last = past.last().filter(|e| e.time >= begin);
        let more = self.events.get(past.len()).is_some_and(|e| e.time <= end);
        // A mass that rests has no speed from one sample or event to the next.
        let rests = |mass: Mass| {
            let (of_event, speeds): (fn(&Event) -> f64, _) = match mass {
                Mass::Motor => (|e| e.v1, &self.v1),
                Mass::Load => (|e| e.v2, &self.v2),
            };
            let stands = |i: usize| speeds.get(i).is_none_or(|v| *v == 0.0);
            let from = match last {
                Some(event) => of_event(event) == 0.0 && event.kind != EventKind::Move(mass),
                None => stands(sample),
            };
            from && (more || stands(sample + 1))
        };
        let joint = past.iter().rev().find_map(|e| match e.kind {
            EventKind::Touch(side) => Some(Some(side)),
            EventKind::Part(_) | EventKind::Impact(..) => Some(None),
            _ => None,
        });
        let met = past.iter().rev().find_map(|e| match e.kind {
            EventKind::Touch(side) | EventKind::Impact(side, _) => Some((side, time - e.time)),
            _ => None,
        });
        DriveMode {
            motor_rests: rests(Mass::Motor),
            load_rests: rests(Mass::Load),
            pressed: joint.flatten(),
            met,
        }
    }

    /// Distance and momenta from one time to another in s: samples, and both sides of every event.
    pub fn instants(&self, drive: &Drive, from: f64, to: f64) -> Vec<Instant> {
        let at = |time: f64, [x1, v1, x2, v2]: [f64; 4]| Instant {
            time,
            distance: x1 - x2,
            motor: drive.motor.inertia * v1,
            load: drive.load.inertia * v2,
        };
        let sampled = self.time.len().min(self.x2.len()).min(self.v2.len());
        let first = self.time.partition_point(|t| *t < from);
        let end = self.time.partition_point(|t| *t <= to).min(sampled);
        let samples = (first..end).map(|i| {
            let state = [self.x1[i], self.v1[i], self.x2[i], self.v2[i]];
            at(self.time[i], state)
        });
        let first = self.events.partition_point(|e| e.time < from);
        let events = self.events.get(first..).unwrap_or_default();
        let events = events.iter().take_while(|e| e.time <= to).flat_map(|e| {
            let [v1, v2] = e.speeds_before(drive);
            [
                at(e.time, [e.x1, v1, e.x2, v2]),
                at(e.time, [e.x1, e.v1, e.x2, e.v2]),
            ]
        });
        let mut all: Vec<Instant> = samples.chain(events).collect();
        // What has one time keeps its order: before an event, and after it.
        all.sort_by(|a, b| a.time.total_cmp(&b.time));
        all
    }
}

impl Event {
    /// Velocities of motor and load right before it, rad/s (or m/s): an impact leaves the momentum as it was (11), and
    /// nothing else changes a velocity at once.
    pub fn speeds_before(&self, drive: &Drive) -> [f64; 2] {
        let EventKind::Impact(side, speed) = self.kind else {
            return [self.v1, self.v2];
        };
        let (motor, load) = (drive.motor.inertia, drive.load.inertia);
        let approach = side.sign() * speed;
        let v2 = (drive.momentum(self.v1, self.v2) - motor * approach) / (motor + load);
        [v2 + approach, v2]
    }
}
