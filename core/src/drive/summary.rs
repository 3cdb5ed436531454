//! What a run shows: where motor and load touch, how fast the cycle drifts, how wide the gap is.

use serde::{Deserialize, Serialize};

use super::{
    Command, DriftingCycle, DriveInput, DriveRun, Event, EventKind, Side, VelocityRelay,
    drifting_cycle,
};

/// A stretch of time in which the motor pushes the load along: from the first contact at an end of the
/// gap to the last one before a flip of the relay or a contact at the other end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Engagement {
    /// At which end.
    pub side: Side,
    /// Begin, s.
    pub from: f64,
    /// End, s.
    pub to: f64,
}

/// Mean drift over whole cycles without contact and without a flip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FreeDrift {
    /// Begin and end, s: switches of the relay.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Mean velocity, rad/s (or m/s).
    pub velocity: f64,
    /// The asymmetry had its opposite sign.
    pub turned: bool,
}

/// The way of the motor from one end of the gap to the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Traverse {
    /// Last contact at one end and first at the other, s.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Distance that the motor has come in between, rad (or m): the gap, and what the load has moved after
    /// the last contact.
    pub travel: f64,
}

/// What a run shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The cycle inside the gap in closed form.
    pub cycle: Option<DriftingCycle>,
    /// Where the masses touch.
    pub engagements: Vec<Engagement>,
    /// Drifts between them.
    pub drifts: Vec<FreeDrift>,
    /// Ways from one end of the gap to the other.
    pub traverses: Vec<Traverse>,
    /// Least and largest `x1 - x2`, rad (or m): the map's two branches. Their distance is the gap if
    /// both ends were reached.
    pub branches: [f64; 2],
    /// Both ends of the gap were reached.
    pub traversed: bool,
}

/// Cycles that are left out at either end of a stretch without contact, and those that it needs.
const MARGIN: usize = 2;
const FEWEST: usize = 6;

/// Sums a run up.
pub fn summarize(input: &DriveInput, run: &DriveRun) -> Summary {
    let relay = match input.command {
        Command::Relay(relay) => Some(relay),
        Command::Torque(_) => None,
    };
    let cycle = relay.and_then(|r| drifting_cycle(&input.drive.motor, &r));
    let engagements = engagements(run, input.duration);
    let drifts = relay.map_or_else(Vec::new, |r| drifts(run, &r, &engagements, input.duration));
    let mut branches = [f64::INFINITY, f64::NEG_INFINITY];
    for (x1, x2) in run.x1.iter().zip(&run.x2) {
        branches[0] = branches[0].min(x1 - x2);
        branches[1] = branches[1].max(x1 - x2);
    }
    for event in &run.events {
        branches[0] = branches[0].min(event.x1 - event.x2);
        branches[1] = branches[1].max(event.x1 - event.x2);
    }
    let reached = |side| engagements.iter().any(|e: &Engagement| e.side == side);
    Summary {
        cycle,
        traversed: reached(Side::Upper) && reached(Side::Lower),
        traverses: traverses(run, &engagements),
        engagements,
        drifts,
        branches,
    }
}

fn engagements(run: &DriveRun, duration: f64) -> Vec<Engagement> {
    let mut found: Vec<Engagement> = Vec::new();
    let mut flipped = true;
    let mut touching: Option<Side> = None;
    for Event { time, kind, .. } in &run.events {
        match kind {
            EventKind::Impact(side, _) | EventKind::Touch(side) | EventKind::Part(side) => {
                let touches = matches!(kind, EventKind::Touch(_));
                touching = touches.then_some(*side);
                match found.last_mut() {
                    Some(last) if last.side == *side && !flipped => last.to = *time,
                    _ => found.push(Engagement {
                        side: *side,
                        from: *time,
                        to: *time,
                    }),
                }
                flipped = false;
            }
            EventKind::Flip => flipped = touching.is_none(),
            _ => {}
        }
    }
    if let (Some(_), Some(last)) = (touching, found.last_mut()) {
        last.to = duration;
    }
    found
}

fn traverses(run: &DriveRun, engagements: &[Engagement]) -> Vec<Traverse> {
    let position = |time: f64| {
        let at = run.events.partition_point(|e| e.time < time);
        run.events.get(at).map(|e| e.x1)
    };
    engagements
        .windows(2)
        .filter(|pair| pair[0].side != pair[1].side)
        .filter_map(|pair| {
            let (from, to) = (pair[0].to, pair[1].from);
            let travel = (position(to)? - position(from)?).abs();
            Some(Traverse { from, to, travel })
        })
        .collect()
}

fn drifts(
    run: &DriveRun,
    relay: &VelocityRelay,
    engagements: &[Engagement],
    duration: f64,
) -> Vec<FreeDrift> {
    let mut borders: Vec<f64> = engagements.iter().flat_map(|e| [e.from, e.to]).collect();
    let flips: Vec<f64> = run
        .events
        .iter()
        .filter(|e| e.kind == EventKind::Flip)
        .map(|e| e.time)
        .collect();
    borders.extend(&flips);
    borders.extend([0.0, duration]);
    borders.sort_by(f64::total_cmp);
    let switches: Vec<&Event> = run
        .events
        .iter()
        .filter(|e| e.kind == EventKind::SwitchUp)
        .collect();
    let mut found = Vec::new();
    for pair in borders.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        if engagements.iter().any(|e| e.from < middle && middle < e.to) {
            continue;
        }
        let begin = switches.partition_point(|e| e.time <= pair[0]) + MARGIN;
        let end = switches.partition_point(|e| e.time < pair[1]);
        let Some(last) = end.checked_sub(1 + MARGIN) else {
            continue;
        };
        if last < begin + FEWEST {
            continue;
        }
        let (a, b) = (switches[begin], switches[last]);
        let turns = flips.iter().filter(|t| **t <= a.time).count();
        found.push(FreeDrift {
            from: a.time,
            to: b.time,
            velocity: (b.x1 - a.x1) / (b.time - a.time),
            turned: turns % 2 == 1 && relay.flip.is_some(),
        });
    }
    found
}

/// Mean velocity of the motor while it pushes the load along in the longest engagement, rad/s (or m/s).
pub fn engaged_drift(run: &DriveRun, summary: &Summary) -> Option<f64> {
    let longest = summary
        .engagements
        .iter()
        .max_by(|a, b| (a.to - a.from).total_cmp(&(b.to - b.from)))?;
    let within: Vec<&Event> = run
        .events
        .iter()
        .filter(|e| e.kind == EventKind::SwitchUp && longest.from <= e.time && e.time <= longest.to)
        .collect();
    let (first, last) = (within.first()?, within.last()?);
    (within.len() > FEWEST).then(|| (last.x1 - first.x1) / (last.time - first.time))
}

/// Which way a cycle drifts, against or with its stronger push.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Against the stronger push: friction outweighs delay.
    Against,
    /// With it: delay outweighs friction.
    With,
    /// It stays where it is.
    Nowhere,
}

/// Share of the swing per period below which a drift is none.
const NO_DRIFT: f64 = 1e-6;

impl Summary {
    /// Direction of the drift against that of the stronger push, of `relay`.
    pub fn direction(&self, relay: &VelocityRelay) -> Option<Direction> {
        let cycle = self.cycle.as_ref()?;
        let stronger = relay.relay.mean_output();
        let drift = match self.drifts.first() {
            Some(d) => (if d.turned { -1.0 } else { 1.0 }) * d.velocity * cycle.period,
            None => cycle.drift,
        };
        if drift.abs() <= NO_DRIFT * cycle.swing || stronger == 0.0 {
            return Some(Direction::Nowhere);
        }
        Some(if drift * stronger > 0.0 {
            Direction::With
        } else {
            Direction::Against
        })
    }

    /// Gap between the map's branches, rad (or m), if both were reached.
    pub fn gap(&self) -> Option<f64> {
        self.traversed
            .then_some(self.branches[1] - self.branches[0])
    }
}
