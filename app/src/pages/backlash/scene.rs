//! A finished run, made ready to be drawn.

use hysteron_core::drive::{Command, Direction, DriveInput, DriveRun, Summary, summarize};

/// Buckets of a curve over the whole run; each keeps its least and largest value.
const BUCKETS: usize = 900;

/// Points of the map that are drawn at most.
const MAP_POINTS: usize = 4000;

/// Points between two corners of the phase portrait.
const BENDS: usize = 4;

/// Milliradians in a radian: the page speaks of them.
pub const MILLI: f64 = 1e3;

/// A run and what is drawn of it, in mrad.
pub struct Scene {
    pub input: DriveInput,
    pub run: DriveRun,
    pub summary: Summary,
    /// Positions of motor and load over time, thinned.
    pub motor: Vec<[f64; 2]>,
    pub load: Vec<[f64; 2]>,
    /// Load over motor position, thinned.
    pub map: Vec<[f64; 2]>,
    /// Least and largest position of either, and of the load.
    pub range: [f64; 2],
    pub load_range: [f64; 2],
    pub answer: String,
    pub lesson: String,
}

impl Scene {
    pub fn new(input: DriveInput, run: DriveRun) -> Self {
        let summary = summarize(&input, &run);
        let thin = |values: &[f64]| envelope(&run.time, values);
        let skip = run.time.len().div_ceil(MAP_POINTS).max(1);
        let map = run.x1.iter().zip(&run.x2).step_by(skip);
        let (motor_range, load_range) = (range(&run.x1), range(&run.x2));
        Self {
            motor: thin(&run.x1),
            load: thin(&run.x2),
            map: map.map(|(a, b)| [MILLI * a, MILLI * b]).collect(),
            range: [
                motor_range[0].min(load_range[0]),
                motor_range[1].max(load_range[1]),
            ],
            load_range,
            answer: answer(&input, &summary),
            lesson: lesson(&input, &summary),
            summary,
            input,
            run,
        }
    }

    /// Index of the last sample at or before a time.
    pub fn index_at(&self, clock: f64) -> usize {
        let after = self.run.time.partition_point(|t| *t <= clock);
        after.saturating_sub(1)
    }

    /// Positions of motor and load in mrad and the torque at a time, between the samples.
    pub fn now(&self, clock: f64) -> Option<[f64; 4]> {
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
        Some([
            MILLI * between(&run.x1),
            MILLI * between(&run.x2),
            between(&run.v1),
            run.input[i],
        ])
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

/// Least and largest value, in mrad.
fn range(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(MILLI * x), high.max(MILLI * x)]
        })
}

fn envelope(time: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let size = time.len().div_ceil(BUCKETS).max(1);
    let mut curve = Vec::with_capacity(2 * BUCKETS);
    for (t, v) in time.chunks(size).zip(values.chunks(size)) {
        let (mut low, mut high) = (0, 0);
        for (i, value) in v.iter().enumerate() {
            if *value < v[low] {
                low = i;
            }
            if *value > v[high] {
                high = i;
            }
        }
        let mut pair = [low, high];
        pair.sort_unstable();
        curve.extend(pair.map(|i| [t[i], MILLI * v[i]]));
    }
    curve
}

fn answer(input: &DriveInput, summary: &Summary) -> String {
    let gap = 2.0 * input.drive.half_gap * MILLI;
    match summary.gap() {
        Some(found) => format!(
            "The gap is {gap:.2} mrad; both positions show {:.2} mrad.",
            MILLI * found
        ),
        None => format!("The gap is {gap:.2} mrad; the motor has not met both of its ends."),
    }
}

fn lesson(input: &DriveInput, summary: &Summary) -> String {
    let Command::Relay(relay) = input.command else {
        return String::new();
    };
    let Some(cycle) = &summary.cycle else {
        return "The relay cannot keep the motor swinging.".to_owned();
    };
    let speed = match summary.drifts.first() {
        Some(drift) => drift.velocity,
        None => cycle.drift_velocity(),
    };
    let speed = (MILLI * speed).abs();
    match summary.direction(&relay) {
        Some(Direction::Against) => format!(
            "The cycle drifts at {speed:.2} mrad/s against the stronger push: friction outweighs delay."
        ),
        Some(Direction::With) => format!(
            "The cycle drifts at {speed:.2} mrad/s with the stronger push: delay outweighs friction."
        ),
        _ if relay.relay.asymmetry == 0.0 => {
            "The cycle stays where it is: both pushes are equal.".to_owned()
        }
        _ => "The cycle stays where it is: without friction and delay no asymmetry moves it."
            .to_owned(),
    }
}
