//! A finished run or a measurement, made ready to be drawn.

use hysteron_core::backlash::GapEstimate;
use hysteron_core::drive::{
    Command, DriveInput, DriveRun, EventKind, Summary, checks, drifting_cycle, summarize,
};
use hysteron_core::figures::Check;
use hysteron_core::measurement::{Measurement, Quantity};
use hysteron_core::message::Message;
use hysteron_core::msg;

use super::drift::lesson;
use super::units::MILLI;
use crate::widgets::chart::{envelope, extremes};

/// Most points of a curve over the whole run.
const CURVE_POINTS: usize = 1800;

/// Points of the map that are drawn at most.
const MAP_POINTS: usize = 4000;

/// Points between two corners of the phase portrait, and between those of the closed form.
const BENDS: usize = 4;
const ORBIT: usize = 24;

/// Share of the record by which a period is guessed where no relay is known, s.
const MEASURED_PERIOD: f64 = 5e-3;

/// What is shown.
pub enum Shown {
    Simulated(Box<Simulated>),
    /// The name of the file.
    Measured(String),
}

/// A simulation and what follows from it.
pub struct Simulated {
    pub input: DriveInput,
    pub summary: Summary,
    pub checks: Vec<Check>,
}

/// Curves in mrad, and what the page says about them.
pub struct Scene {
    pub shown: Shown,
    /// Samples, and events of a simulation; positions of the load only if they are known.
    pub run: DriveRun,
    /// Positions of motor and load over time, thinned.
    pub motor: Vec<[f64; 2]>,
    pub load: Vec<[f64; 2]>,
    /// Load over motor position, thinned.
    pub map: Vec<[f64; 2]>,
    /// Least and largest position of either, and of the load.
    pub range: [f64; 2],
    pub load_range: [f64; 2],
    /// Largest torque, N m.
    pub strongest: f64,
    /// What the motor alone tells, once it is known.
    pub estimate: Option<Result<GapEstimate, Message>>,
    pub lesson: Message,
}

impl Scene {
    /// A simulated drive, with the claim of a figure checked on it.
    pub fn simulated(input: DriveInput, run: DriveRun, figure: Option<u32>) -> Self {
        let summary = summarize(&input, &run);
        let lesson = lesson(&input, &run, &summary);
        let checks = figure.map_or_else(Vec::new, |n| checks(n, &input, &run, &summary));
        let simulated = Simulated {
            input,
            summary,
            checks,
        };
        Self::new(Shown::Simulated(Box::new(simulated)), run, lesson)
    }

    /// A measured drive.
    pub fn measured(
        measurement: &Measurement,
        estimate: Result<GapEstimate, Message>,
    ) -> Result<Self, Message> {
        let output = |q| measurement.output(q).map(|c| c.values.clone());
        let name = measurement.name.clone();
        let Some(x1) = output(Quantity::Position) else {
            return Err(msg!(
                "{}: no motor position; expected a column x1 [rad]",
                name
            ));
        };
        let time = measurement.time.clone();
        let v1 = output(Quantity::Velocity).unwrap_or_else(|| slopes(&time, &x1));
        let load = measurement
            .reference
            .iter()
            .find(|c| c.quantity == Quantity::LoadPosition);
        let lesson = match load {
            Some(_) => {
                "The load was measured too, for comparison only: the estimate does not use it."
            }
            None => "The load was not measured: the motor's columns must suffice.",
        };
        let run = DriveRun {
            input: measurement.input.values.clone(),
            x2: load.map_or_else(Vec::new, |c| c.values.clone()),
            time,
            x1,
            v1,
            ..DriveRun::default()
        };
        let mut scene = Self::new(Shown::Measured(name), run, lesson.into());
        scene.estimate = Some(estimate);
        Ok(scene)
    }

    fn new(shown: Shown, run: DriveRun, lesson: Message) -> Self {
        let thin = |values: &[f64]| -> Vec<[f64; 2]> {
            let curve = envelope(&run.time, values, CURVE_POINTS).into_iter();
            curve.map(|[t, x]| [t, MILLI * x]).collect()
        };
        let skip = run.time.len().div_ceil(MAP_POINTS).max(1);
        let map = run.x1.iter().zip(&run.x2).step_by(skip);
        let range = |values: &[f64]| extremes(values.iter().map(|x| MILLI * x));
        let (motor_range, load_range) = (range(&run.x1), range(&run.x2));
        Self {
            motor: thin(&run.x1),
            load: thin(&run.x2),
            map: map.map(|(a, b)| [MILLI * a, MILLI * b]).collect(),
            range: [
                motor_range.0.min(load_range.0),
                motor_range.1.max(load_range.1),
            ],
            load_range: load_range.into(),
            strongest: run.input.iter().fold(0.0, |m, u| u.abs().max(m)),
            estimate: None,
            lesson,
            shown,
            run,
        }
    }

    /// The simulation, if it is one.
    pub fn simulation(&self) -> Option<&Simulated> {
        match &self.shown {
            Shown::Simulated(simulated) => Some(simulated),
            Shown::Measured(_) => None,
        }
    }

    /// What was simulated.
    pub fn input(&self) -> Option<&DriveInput> {
        self.simulation().map(|s| &s.input)
    }

    /// The file that was measured.
    pub fn file(&self) -> Option<&str> {
        match &self.shown {
            Shown::Simulated(_) => None,
            Shown::Measured(name) => Some(name),
        }
    }

    /// Length of the record, s.
    pub fn duration(&self) -> f64 {
        match self.input() {
            Some(input) => input.duration,
            None => self.run.time.last().copied().unwrap_or(0.0),
        }
    }

    /// Half gap that is drawn, mrad: the true one, else the estimated one.
    pub fn half_gap(&self) -> Option<f64> {
        match self.input() {
            Some(input) => Some(MILLI * input.drive.half_gap),
            None => Some(0.5 * MILLI * self.estimate.as_ref()?.as_ref().ok()?.gap?),
        }
    }

    /// Period of the relay's cycle, s.
    pub fn period(&self) -> f64 {
        let cycle = self.simulation().and_then(|s| s.summary.cycle.as_ref());
        cycle.map_or(MEASURED_PERIOD, |c| c.period)
    }

    /// Stretches in which the motor pushes the load: by the simulation, or as estimated from contacts.
    pub fn engagements(&self) -> Vec<[f64; 2]> {
        if let Some(simulated) = self.simulation() {
            let all = &simulated.summary.engagements;
            return all.iter().map(|e| [e.from, e.to]).collect();
        }
        let Some(Ok(estimate)) = &self.estimate else {
            return Vec::new();
        };
        let mut found: Vec<[f64; 2]> = Vec::new();
        let mut last = None;
        for contact in &estimate.contacts {
            match found.last_mut() {
                Some(stretch) if last == Some(contact.side) => stretch[1] = contact.time,
                _ => found.push([contact.time; 2]),
            }
            last = Some(contact.side);
        }
        found
    }

    /// Where the estimate saw the motor leave one end of the gap and reach the other: time in s,
    /// position in mrad.
    pub fn signature(&self) -> Vec<[[f64; 2]; 2]> {
        let Some(Ok(estimate)) = &self.estimate else {
            return Vec::new();
        };
        estimate
            .traverses
            .iter()
            .map(|t| {
                [
                    [t.from.time, MILLI * t.from.position],
                    [t.to.time, MILLI * t.to.position],
                ]
            })
            .collect()
    }

    /// The closed form of the cycle and its characteristic points at the last switch before a time.
    pub fn orbit(&self, before: f64) -> Option<Orbit> {
        let simulated = self.simulation()?;
        let Command::Relay(relay) = simulated.input.command else {
            return None;
        };
        let cycle = simulated.summary.cycle.as_ref()?;
        let start = self
            .run
            .events
            .iter()
            .take_while(|e| e.time + cycle.period <= before)
            .filter(|e| e.kind == EventKind::SwitchUp)
            .last()?;
        // With the asymmetry turned round, the cycle is another.
        let flips = relay.flip.map_or(0.0, |f| (start.time / f).floor());
        let mut now = relay;
        if flips % 2.0 == 1.0 {
            now.relay.asymmetry = -now.relay.asymmetry;
        }
        let motor = &simulated.input.drive.motor;
        let cycle = drifting_cycle(motor, &now)?;
        let place = |[x, v]: [f64; 2]| [MILLI * (start.x1 + x), v];
        let curve = cycle.curve(motor, &now, ORBIT).into_iter().map(place);
        let points = cycle.points[..6].iter().map(|p| place([p.x, p.v]));
        Some(Orbit {
            curve: curve.collect(),
            corners: points.collect(),
        })
    }

    /// Index of the last sample at or before a time.
    fn index_at(&self, clock: f64) -> usize {
        let after = self.run.time.partition_point(|t| *t <= clock);
        after.saturating_sub(1)
    }

    /// Positions of motor and load in mrad, motor velocity and torque at a time, between the samples.
    pub fn now(&self, clock: f64) -> Option<Now> {
        let run = &self.run;
        let i = self.index_at(clock);
        let j = (i + 1).min(run.time.len().checked_sub(1)?);
        let span = run.time[j] - run.time[i];
        let share = if span > 0.0 {
            ((clock - run.time[i]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let between = |v: &[f64]| v[i] + share * (v[j] - v[i]);
        Some(Now {
            x1: MILLI * between(&run.x1),
            x2: (!run.x2.is_empty()).then(|| MILLI * between(&run.x2)),
            v1: between(&run.v1),
            torque: run.input[i],
        })
    }

    /// Motor position in mrad and velocity from one time to another: samples, corners from events, and
    /// the parabolas between them.
    pub fn phase(&self, from: f64, to: f64) -> Vec<[f64; 2]> {
        let run = &self.run;
        let samples =
            run.time.partition_point(|t| *t < from)..run.time.partition_point(|t| *t <= to);
        let events = run.events.partition_point(|e| e.time < from)
            ..run.events.partition_point(|e| e.time <= to);
        let mut places: Vec<[f64; 3]> = samples
            .map(|i| [run.time[i], run.x1[i], run.v1[i]])
            .chain(run.events[events].iter().map(|e| [e.time, e.x1, e.v1]))
            .collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut points = Vec::with_capacity(BENDS * places.len());
        for pair in places.windows(2) {
            let ([t, x, v], [t_end, _, v_end]) = (pair[0], pair[1]);
            let span = t_end - t;
            for k in 0..BENDS {
                let share = k as f64 / BENDS as f64;
                let speed = v + 0.5 * share * (v_end - v);
                points.push([MILLI * (x + share * span * speed), v + share * (v_end - v)]);
            }
        }
        points.extend(places.last().map(|[_, x, v]| [MILLI * x, *v]));
        points
    }
}

/// A closed cycle in the phase plane, mrad and rad/s.
pub struct Orbit {
    pub curve: Vec<[f64; 2]>,
    /// Its characteristic points.
    pub corners: Vec<[f64; 2]>,
}

/// Where everything is at an instant.
#[derive(Clone, Copy)]
pub struct Now {
    /// mrad
    pub x1: f64,
    /// mrad, if the load is known.
    pub x2: Option<f64>,
    /// rad/s
    pub v1: f64,
    /// N m
    pub torque: f64,
}

/// Slopes between the neighbours of each sample.
fn slopes(time: &[f64], values: &[f64]) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|i| {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
            if b > a {
                (values[b] - values[a]) / (time[b] - time[a])
            } else {
                0.0
            }
        })
        .collect()
}
