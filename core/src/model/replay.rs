//! Replay: a model driven by a measured input, restarted at the windows' estimated states.

use super::bristle::Bristle;
use super::delayed_input::DelayedInput;
use super::excitation::{Excitation, Sensor};
use super::felt_load::Felt;
use super::followed::{Followed, FollowedNoise, Follower};
use super::seen_load::{Sight, Tracker};
use super::slow_sensor::SlowSensor;
use super::{Engine, Load, Model, State};

/// Where a window starts and from which state of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Index of the first sample.
    pub sample: usize,
    /// Position there, rad or m; 0 where it cannot be known. A process has none: at its first sample this is by how
    /// much what its lag had stored, or what its slow sensor showed, is off what the input and the output there say;
    /// where it swings, how fast its output moves there.
    pub position: f64,
    /// Velocity there, rad/s or m/s; the output of a process.
    pub velocity: f64,
    /// By how much the load is off where it is taken to be: its position, and what is then left of its velocity, in
    /// standard deviations of what its contacts tell, or of a load that follows the noisy motion of the body.
    pub load: [f64; 2],
}

/// Where a load is at the start of each window if the body moves as measured: models that differ in their body alone
/// have the same.
#[derive(Clone, Debug, Default)]
pub struct FollowedLoad {
    /// None where there is none, or where it hangs on the body too.
    load: Option<Load>,
    samples: Vec<usize>,
    /// None where it goes on from the window before.
    at: Vec<Option<Followed>>,
    /// Roots of the covariances where it is known by the force that the body felt.
    roots: Vec<[f64; 3]>,
}

/// Where a load behind a gap begins in a window, if its contacts were not seen one by one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum LoadBegin {
    /// Where it would be if the body had moved as measured.
    #[default]
    Followed,
    /// Where the window before left it, where windows follow on each other.
    Carried,
    /// Where the force that the body felt has moved it.
    Felt,
}

impl FollowedLoad {
    /// Whether it was felt by the body, and is known at these starts.
    pub(crate) fn is_felt_at(&self, starts: &[Start]) -> bool {
        !self.roots.is_empty() && self.is_at(starts)
    }

    fn is_at(&self, starts: &[Start]) -> bool {
        let samples = starts.iter().map(|s| s.sample);
        samples.eq(self.samples.iter().copied())
    }

    /// Whether this is what the load of `model` does at these starts.
    fn suits(&self, model: &Model, starts: &[Start]) -> bool {
        self.load.is_some() && self.load == model.load && self.is_at(starts)
    }
}

impl Excitation {
    /// Whether the load of `model` is told by contacts that the motor felt.
    pub(crate) fn sees_load_of(&self, model: &Model) -> bool {
        self.tracker(model).is_some()
    }

    /// Whether the load of `model` may be off where it is taken to be, by deviations that a [`Start`] tells.
    pub(crate) fn doubts_load_of(&self, model: &Model, begin: LoadBegin) -> bool {
        let felt = begin == LoadBegin::Felt && model.load.is_some();
        felt || self.sees_load_of(model) || self.doubt(model).is_some()
    }

    /// Standard deviations of position and velocity of a load that is never free, from the noise of what it follows.
    fn doubt(&self, model: &Model) -> Option<[f64; 2]> {
        let load = model.load.as_ref()?;
        (load.coupling.half_gap == 0.0).then_some(load.doubt(self.noise?, self.mean_step()))
    }

    /// Gives `starts` the states of a seen load with which it meets the contacts that were felt; the last window ends
    /// with the record.
    pub(crate) fn guess_loads(&self, model: &Model, starts: &mut [Start]) {
        let Some(mut tracker) = self.tracker(model) else {
            return;
        };
        for k in 0..starts.len() {
            let until = starts.get(k + 1).map_or(self.len() - 1, |s| s.sample);
            let guess = tracker.next_met(self.time[starts[k].sample], self.time[until]);
            if let Some(guess) = guess {
                starts[k].load = guess;
            }
        }
    }

    fn tracker(&self, model: &Model) -> Option<Tracker<'_>> {
        Tracker::new(self.seen.as_ref()?, model)
    }

    /// Where the load of `model` is at each of `starts`; taken over from what is `known`, if that is the same.
    pub(crate) fn follow(
        &self,
        model: &Model,
        starts: &[Start],
        known: &FollowedLoad,
        begin: LoadBegin,
    ) -> FollowedLoad {
        if begin == LoadBegin::Followed && known.suits(model, starts) {
            return known.clone();
        }
        let Some(load) = model.load.filter(|_| self.position.len() == self.len()) else {
            return FollowedLoad::default();
        };
        let mut follower = Follower::new(&load, self.position[0], self.mean_step());
        let mut tracker = self.tracker(model);
        if begin == LoadBegin::Felt && tracker.is_none() {
            return self.feel(model, &load, starts);
        }
        let carried = begin == LoadBegin::Carried && tracker.is_none();
        let begins = |i: usize| self.runs.binary_search_by_key(&i, |run| run.0).is_ok();
        let at = starts.iter().map(|start| {
            let i = start.sample;
            if carried && !begins(i) {
                return None;
            }
            if let Some(tracker) = &mut tracker {
                self.take_sight(&mut follower, &tracker.at(self.time[i]), i);
            }
            follower.reach(&self.position, i, |k| self.step_after(k));
            Some(follower.now)
        });
        FollowedLoad {
            at: at.collect(),
            samples: starts.iter().map(|s| s.sample).collect(),
            // Where it was seen, it is followed by its contacts, and the body bounces off in them.
            load: (tracker.is_none() && !carried).then_some(load),
            roots: Vec::new(),
        }
    }

    /// The same by the force that the body felt.
    fn feel(&self, model: &Model, load: &Load, starts: &[Start]) -> FollowedLoad {
        let samples: Vec<usize> = starts.iter().map(|s| s.sample).collect();
        let felt = Felt {
            position: &self.position,
            velocity: (self.slow_sensor == Sensor::Velocity).then_some(self.shown.as_slice()),
            input: &self.effective_input(model),
            step: self.mean_step(),
        };
        let states = felt.states(model, load, &samples).into_iter();
        let (at, roots) = states.map(|(state, root)| (Some(state), root)).unzip();
        FollowedLoad {
            load: None,
            samples,
            at,
            roots,
        }
    }

    /// Runs `model` through the record and writes position and velocity at every simulated sample.
    ///
    /// At each of `starts` (ascending, the first at sample 0) the body restarts from the state given there. Of the
    /// hidden states the lagged input goes on from the window before; a load (`follow`) and the deflection of a
    /// friction contact are where they must be if the body moved as measured. Where the velocity alone was measured,
    /// the contact goes on as well, and comes to the begin of a run by itself. Returns the pieces of motion that this
    /// took, one an interval at least unless nothing moves.
    pub fn replay(
        &self,
        model: &Model,
        starts: &[Start],
        loads: &FollowedLoad,
        position: &mut [f64],
        velocity: &mut [f64],
    ) -> u64 {
        let path = DelayedInput::new(self, model);
        let mut engine = Engine::new(model);
        path.prepare(&mut engine);
        let mut course = Course::new(&engine, path, starts);
        let mut next = starts.iter().enumerate().peekable();
        let mut now = 0;
        for (from, end) in &self.runs {
            course.wait(now, *from);
            for i in *from..*end {
                if let Some((window, start)) = next.next_if(|(_, s)| s.sample == i) {
                    course.restart(start, loads, window);
                }
                [position[i], velocity[i]] =
                    model.seen([course.state.position(), course.state.velocity()]);
                if i + 1 < self.len() {
                    course.advance(i);
                }
            }
            now = *end;
        }
        if !model.output_maps.is_empty() {
            for (from, end) in &self.runs {
                for v in &mut velocity[*from..*end] {
                    *v = model.map_output(*v);
                }
            }
        }
        if let Some(encoder) = model.encoder {
            for i in self.runs.iter().flat_map(|(from, end)| *from..*end) {
                (position[i], velocity[i]) = encoder.seen(position[i], velocity[i]);
            }
        }
        if let Some(lag) = model.sensor_lag {
            let signal = match self.slow_sensor {
                Sensor::Velocity => velocity,
                Sensor::Position => position,
            };
            let slow = SlowSensor {
                lag,
                time: &self.time,
                shown: &self.shown,
                off: if model.lag.is_none() {
                    self.off_at_first(model, starts)
                } else {
                    0.0
                },
            };
            for run in &self.runs {
                slow.pass(signal, *run);
            }
        }
        engine.moves()
    }

    /// Puts `follower` where the load was seen at sample `i`, or before the contact in which it is.
    fn take_sight(&self, follower: &mut Follower, sight: &Sight, i: usize) {
        match *sight {
            Sight::Free(x, v) => follower.place(x, v, i),
            Sight::Touching { begin, x, v } => {
                let before = self.time[..i].partition_point(|t| *t <= begin);
                let before = before.saturating_sub(1);
                follower.place(x + v * (self.time[before] - begin), v, before);
            }
        }
    }

    /// What is stored before the body at first, under an input that was `before`: where the body rests, what keeps it
    /// there.
    fn stored(&self, model: &Model, starts: &[Start], before: f64) -> f64 {
        match starts.first().filter(|_| model.load_before_lag) {
            Some(start) if self.at_rest => model.holding() * start.velocity,
            _ => before + model.early_load(0.0) + self.off_at_first(model, starts),
        }
    }

    /// Whether a process holds more than its output tells at first: the input before the record is not known, and what
    /// a lag had stored of it, or had not shown yet, is a state of its own. Where nothing moved before, it is.
    pub(crate) fn doubts_store_of(&self, model: &Model) -> bool {
        let slow = model.lag.is_some() || model.sensor_lag.is_some() || model.spring.is_some();
        self.position.is_empty() && !self.at_rest && slow
    }

    /// By how much that is off; of a process that swings the state tells how fast its output moves at first.
    fn off_at_first(&self, model: &Model, starts: &[Start]) -> f64 {
        let told = self.doubts_store_of(model) && model.spring.is_none();
        let start = starts.first().filter(|_| told);
        start.map_or(0.0, |s| s.position)
    }

    /// Load before the lag from sample `i` on, held at its value in the middle of the interval.
    fn early_load(&self, model: &Model, i: usize) -> f64 {
        let end = self.time[(i + 1).min(self.len() - 1)];
        model.early_load(f64::midpoint(self.time[i], end) - self.time[0])
    }

    /// First sample that the lagged input at sample `i` still remembers.
    fn remembered(&self, i: usize, model: &Model) -> usize {
        let memory = FORGOTTEN * model.lag.unwrap_or(0.0);
        let since = self.time[i] - memory;
        self.time[..i]
            .partition_point(|t| *t < since)
            .min(i.saturating_sub(1))
    }

    /// The input that reaches the body: mapped, delayed and lagged, as its mean over each interval.
    pub fn effective_input(&self, model: &Model) -> Vec<f64> {
        let mut path = DelayedInput::new(self, model);
        let mut z = path.before;
        (0..self.len().saturating_sub(1))
            .map(|i| {
                let (mut sum, mut duration) = (0.0, 0.0);
                path.pieces(i, |w, h| {
                    sum += match model.lag {
                        None => w * h,
                        Some(tau) => {
                            let fading = tau * -libm::expm1(-h / tau) * (z - w);
                            z = w + (z - w) * libm::exp(-h / tau);
                            w * h + (1.0 - model.direct) * fading
                        }
                    };
                    duration += h;
                });
                sum / duration
            })
            .collect()
    }
}

/// A model on its way through a record.
struct Course<'a> {
    excitation: &'a Excitation,
    model: &'a Model,
    engine: &'a Engine<'a>,
    path: DelayedInput<'a>,
    state: State,
    tracker: Option<Tracker<'a>>,
    doubt: [f64; 2],
    bristle: Option<Bristle<'a>>,
    /// Whether the position was measured.
    measured: bool,
}

impl<'a> Course<'a> {
    fn new(engine: &'a Engine<'a>, path: DelayedInput<'a>, starts: &[Start]) -> Self {
        let (excitation, model) = (path.excitation, path.model);
        let contact = engine.contact().zip(excitation.steady.as_ref());
        Self {
            state: State::at_rest(excitation.stored(model, starts, path.before)),
            tracker: excitation.tracker(model),
            doubt: excitation.doubt(model).unwrap_or_default(),
            bristle: contact
                .map(|(contact, steady)| Bristle::new(contact, steady, &model.friction)),
            measured: matches!(excitation.noise, Some(FollowedNoise::Position(_))),
            excitation,
            model,
            engine,
            path,
        }
    }

    /// From a sample to the next.
    fn advance(&mut self, i: usize) {
        let load = self.excitation.early_load(self.model, i);
        self.path
            .pieces(i, |w, h| self.engine.advance(&mut self.state, w + load, h));
    }

    /// From the end of a run to the begin of the next, where only hidden states go on.
    fn wait(&mut self, now: usize, from: usize) {
        let (excitation, model) = (self.excitation, self.model);
        if now >= from {
            return;
        }
        // A load would have to be where it was, too.
        let alone = !self.measured && model.load.is_none();
        // Noise of the velocity would loosen a contact that follows a body at rest: the model goes on alone.
        let told = self.bristle.as_ref().filter(|_| alone);
        let begin = told.map_or(from, |b| b.told_from(from).clamp(now, from - 1));
        let now = now.max(excitation.remembered(from, model).min(begin));
        self.state = self
            .state
            .at_time(excitation.time[now] - excitation.time[0]);
        for i in now..from {
            if i < begin {
                let load = excitation.early_load(model, i);
                self.path
                    .pieces(i, |w, h| self.state.wait(model, w + load, h));
                continue;
            }
            if let Some(bristle) = self.bristle.as_mut().filter(|_| i == begin) {
                let deflection = bristle.at(i, &excitation.time);
                let (position, velocity) = (excitation.position[i], excitation.speed_after(i));
                self.state = self.state.restarted(position, velocity);
                self.state = self.state.with_deflection(deflection);
            }
            self.advance(i);
        }
    }

    /// At the begin of a window.
    fn restart(&mut self, start: &Start, loads: &FollowedLoad, window: usize) {
        let (excitation, i) = (self.excitation, start.sample);
        let [position, velocity] = self.model.seen([start.position, start.velocity]);
        self.state = self.state.restarted(position, velocity);
        if let Some(Some(load)) = loads.at.get(window) {
            let [a, b] = start.load;
            let shift = match (&self.tracker, loads.roots.get(window)) {
                (Some(tracker), _) => tracker.shift(excitation.time[i], start.load),
                (None, Some([x, slope, v])) => [x * a, slope * a + v * b],
                (None, None) => [self.doubt[0] * a, self.doubt[1] * b],
            };
            self.state = self.state.with_load(load, excitation.position_at(i), shift);
        }
        if let Some(bristle) = self.bristle.as_mut().filter(|_| self.measured) {
            self.state = self.state.with_deflection(bristle.at(i, &excitation.time));
        }
    }
}

/// Time constants after which the state before is forgotten to the last digit.
const FORGOTTEN: f64 = 37.0;
