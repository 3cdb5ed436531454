//! Replay: a model driven by a measured input, restarted at the windows' estimated states.

use super::bristle::{Bristle, Steady};
use super::felt_load::Felt;
use super::followed::{Followed, FollowedNoise, Follower};
use super::seen_load::{SeenLoad, Sight, Tracker};
use super::{Engine, Load, Model, State};

/// A time step within this share of the mean one counts as equal: files round their time column.
const UNIFORM_TOLERANCE: f64 = 0.02;

/// Where a window starts and from which state of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Index of the first sample.
    pub sample: usize,
    /// Position there, rad or m; 0 where it cannot be known.
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

/// A measured input, held between samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    time: Vec<f64>,
    input: Vec<f64>,
    /// Input before the record starts.
    before: f64,
    /// Nothing moves at first, wherever it is.
    at_rest: bool,
    /// Sampling time in s, if equal throughout.
    step: Option<f64>,
    slow_sensor: Sensor,
    /// What a slow sensor showed: the measured values of its output, or empty.
    shown: Vec<f64>,
    /// Position that a load follows, free of noise as far as known; empty for a process.
    position: Vec<f64>,
    /// The noise of what it stands for.
    noise: Option<FollowedNoise>,
    /// The same without its trembling.
    steady: Option<Steady>,
    /// The load, where the motor felt its contacts.
    seen: Option<SeenLoad>,
    /// Sample ranges that are simulated, ascending; between them only hidden states go on.
    runs: Vec<(usize, usize)>,
}

/// Which output a slow sensor shows: a counting encoder is not slow, but the velocity made from it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// The velocity, or the output of a process.
    Velocity,
    /// The position, where nothing else is measured.
    Position,
}

impl Excitation {
    /// `time` in s strictly increasing, `input` as long; `before` acted until the record starts;
    /// `position` that a load follows, as long or empty, with the noise of what was measured.
    pub fn new(
        time: &[f64],
        input: &[f64],
        before: f64,
        slow_sensor: Sensor,
        position: Vec<f64>,
        noise: Option<FollowedNoise>,
    ) -> Self {
        let n = time.len();
        let mean = (time[n - 1] - time[0]) / (n - 1) as f64;
        let uniform = time
            .iter()
            .enumerate()
            .all(|(i, t)| (t - time[0] - mean * i as f64).abs() < UNIFORM_TOLERANCE * mean);
        Self {
            time: time.to_vec(),
            input: input.to_vec(),
            before,
            at_rest: false,
            step: uniform.then_some(mean),
            slow_sensor,
            shown: Vec::new(),
            steady: noise.map(|noise| match noise {
                FollowedNoise::Position(level) => Steady::new(&position, level),
                FollowedNoise::Velocity(level) => Steady::new(&position, level * mean),
            }),
            position,
            noise,
            seen: None,
            runs: vec![(0, time.len())],
        }
    }

    /// The same with what a slow sensor showed, which tells its state where a run begins within the record.
    #[must_use]
    pub(crate) fn with_shown(self, shown: Vec<f64>) -> Self {
        Self { shown, ..self }
    }

    /// The same where nothing moves at first, or something does.
    #[must_use]
    pub(crate) fn at_rest_at_first(self, at_rest: bool) -> Self {
        Self { at_rest, ..self }
    }

    /// The same with a load that the motor felt.
    #[must_use]
    pub(crate) fn with_seen_load(self, seen: SeenLoad) -> Self {
        let seen = Some(seen);
        Self { seen, ..self }
    }

    /// Position that a load follows; empty for a process.
    pub(crate) fn followed(&self) -> &[f64] {
        &self.position
    }

    /// Whether a load is told by contacts that the motor felt.
    pub(crate) fn sees_load(&self) -> bool {
        self.seen.is_some()
    }

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

    /// The same, to be simulated in these sample ranges (ascending, apart) only; each begins at a start.
    #[must_use]
    pub fn within(&self, runs: Vec<(usize, usize)>) -> Self {
        Self {
            runs,
            ..self.clone()
        }
    }

    /// The first `n` samples.
    #[must_use]
    pub fn head(&self, n: usize) -> Self {
        Self {
            time: self.time[..n].to_vec(),
            input: self.input[..n].to_vec(),
            position: self.position.iter().take(n).copied().collect(),
            shown: self.shown.iter().take(n).copied().collect(),
            steady: self.steady.as_ref().map(|s| s.head(n)),
            seen: self.seen.clone(),
            runs: vec![(0, n)],
            ..*self
        }
    }

    /// Measured or estimated position at a sample; 0 of a process.
    pub(crate) fn position_at(&self, sample: usize) -> f64 {
        self.position.get(sample).copied().unwrap_or(0.0)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Mean sampling time, s.
    pub fn mean_step(&self) -> f64 {
        (self.time[self.len() - 1] - self.time[0]) / (self.len() - 1) as f64
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
    /// At each of `starts` (ascending, the first at sample 0) the body restarts from the state
    /// given there. Of the hidden states the lagged input goes on from the window before; a load (`follow`)
    /// and the deflection of a friction contact are where they must be if the body moved as measured. Where the velocity
    /// alone was measured, the contact goes on as well, and comes to the begin of a run by itself. Returns the pieces of
    /// motion that this took, one an interval at least unless nothing moves.
    pub fn replay(
        &self,
        model: &Model,
        starts: &[Start],
        loads: &FollowedLoad,
        position: &mut [f64],
        velocity: &mut [f64],
    ) -> u64 {
        let mut engine = Engine::new(model);
        let mut path = DelayedInput::new(self, model);
        path.prepare(&mut engine);
        let mut state = State::at_rest(self.stored(model, starts, path.before));
        let mut next = starts.iter().enumerate().peekable();
        let tracker = self.tracker(model);
        let doubt = self.doubt(model).unwrap_or_default();
        let mut bristle = engine
            .contact()
            .zip(self.steady.as_ref())
            .map(|(contact, steady)| Bristle::new(contact, steady, &model.friction));
        let measured = matches!(self.noise, Some(FollowedNoise::Position(_)));
        // A load would have to be where it was, too.
        let alone = !measured && model.load.is_none();
        let mut now = 0;
        for (from, end) in &self.runs {
            if now < *from {
                // Noise of the velocity would loosen a contact that follows a body at rest: the model goes on alone.
                let told = bristle.as_ref().filter(|_| alone);
                let begin = told.map_or(*from, |b| b.told_from(*from).clamp(now, *from - 1));
                now = now.max(self.remembered(*from, model).min(begin));
                state = state.at_time(self.time[now] - self.time[0]);
                for i in now..*from {
                    let load = self.early_load(model, i);
                    if i < begin {
                        path.pieces(i, |w, h| state.wait(model, w + load, h));
                        continue;
                    }
                    if let Some(bristle) = bristle.as_mut().filter(|_| i == begin) {
                        state = state.restarted(self.position[i], self.speed_after(i));
                        state = state.with_deflection(bristle.at(i, &self.time));
                    }
                    path.pieces(i, |w, h| engine.advance(&mut state, w + load, h));
                }
            }
            for i in *from..*end {
                if let Some((window, start)) = next.next_if(|(_, s)| s.sample == i) {
                    state = state.restarted(start.position, start.velocity);
                    if let Some(Some(load)) = loads.at.get(window) {
                        let shift = match &tracker {
                            Some(tracker) => tracker.shift(self.time[i], start.load),
                            None => match loads.roots.get(window) {
                                Some([x, slope, v]) => {
                                    let [a, b] = start.load;
                                    [x * a, slope * a + v * b]
                                }
                                None => [doubt[0] * start.load[0], doubt[1] * start.load[1]],
                            },
                        };
                        state = state.with_load(load, self.position[i], shift);
                    }
                    if let Some(bristle) = bristle.as_mut().filter(|_| measured) {
                        state = state.with_deflection(bristle.at(i, &self.time));
                    }
                }
                position[i] = state.position();
                velocity[i] = state.velocity();
                if i + 1 < self.len() {
                    let load = self.early_load(model, i);
                    path.pieces(i, |w, h| engine.advance(&mut state, w + load, h));
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
        if let Some(lag) = model.sensor_lag {
            let slowed = match self.slow_sensor {
                Sensor::Velocity => velocity,
                Sensor::Position => position,
            };
            self.slow_down(slowed, lag);
        }
        engine.moves()
    }

    /// Time from a sample to the next, s.
    fn step_after(&self, i: usize) -> f64 {
        self.step.unwrap_or_else(|| self.time[i + 1] - self.time[i])
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

    /// Mean velocity from a sample to the next.
    fn speed_after(&self, i: usize) -> f64 {
        (self.position[i + 1] - self.position[i]) / self.step_after(i)
    }

    /// What is stored before the body at first, under an input that was `before`: where the body rests, what keeps it there.
    fn stored(&self, model: &Model, starts: &[Start], before: f64) -> f64 {
        match starts.first().filter(|_| model.load_before_lag) {
            Some(start) if self.at_rest => model.viscous * start.velocity,
            _ => before + model.early_load(0.0),
        }
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

    /// Passes a signal through a first-order lag, straight between its samples. A run that begins within
    /// the record begins as if the signal had come the same way before, or so that what was shown comes out best.
    fn slow_down(&self, signal: &mut [f64], lag: f64) {
        for (from, end) in &self.runs {
            let (Some(signal), Some(time)) =
                (signal.get_mut(*from..*end), self.time.get(*from..*end))
            else {
                continue;
            };
            if signal.len() < 2 {
                continue;
            }
            let mut before = signal[0];
            let mut slow = before;
            if *from > 0 {
                slow -= lag * (signal[1] - signal[0]) / (time[1] - time[0]);
                signal[0] = slow;
            }
            for (value, time) in signal[1..].iter_mut().zip(time.windows(2)) {
                let (h, now) = (time[1] - time[0], *value);
                let (decay, slope) = (libm::exp(-h / lag), (now - before) / h);
                // The lag follows a ramp at the distance slope * lag.
                slow = now - slope * lag + (slow - before + slope * lag) * decay;
                before = now;
                *value = slow;
            }
            if *from > 0
                && let Some(shown) = self.shown.get(*from..*end)
            {
                begin_as_shown(signal, shown, time, lag);
            }
        }
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
                            w * h + fading
                        }
                    };
                    duration += h;
                });
                sum / duration
            })
            .collect()
    }
}

/// Share of what a lag began with that is no longer looked at.
const FADED: f64 = 1e-3;

/// Adds to a lagged signal what it may have begun with, which fades away: so much that it comes nearest to what was
/// `shown` (least squares).
fn begin_as_shown(signal: &mut [f64], shown: &[f64], time: &[f64], lag: f64) {
    let fading = |k: usize| libm::exp((time[0] - time[k]) / lag);
    let seen = (0..signal.len()).take_while(|k| fading(*k) > FADED);
    let (product, square) = seen.fold((0.0, 0.0), |(product, square), k| {
        let share = fading(k);
        (
            product + share * (shown[k] - signal[k]),
            square + share * share,
        )
    });
    // The first sample is shown as it is, so that there is a square.
    let begun = product / square;
    for (k, value) in signal.iter_mut().enumerate() {
        let share = fading(k);
        if share <= FADED {
            break;
        }
        *value += begun * share;
    }
}

/// Time constants after which the state before is forgotten to the last digit.
const FORGOTTEN: f64 = 37.0;

/// The held input shifted by a dead time, as pieces of constant value in each sampling interval.
struct DelayedInput<'a> {
    excitation: &'a Excitation,
    model: &'a Model,
    before: f64,
    delay: f64,
    /// For equal steps: whole samples and the rest of the dead time.
    whole: usize,
    rest: f64,
    /// For unequal steps: first sample whose delayed value may still act.
    pointer: usize,
}

impl<'a> DelayedInput<'a> {
    fn new(excitation: &'a Excitation, model: &'a Model) -> Self {
        let delay = model.delay.max(0.0);
        let (mut whole, mut rest) = (0, 0.0);
        if let Some(step) = excitation.step {
            let samples = (delay / step).min(excitation.len() as f64);
            whole = samples.floor() as usize;
            rest = (samples - samples.floor()) * step;
            // A rest of round-off size is no piece of its own.
            if rest < 1e-9 * step {
                rest = 0.0;
            } else if step - rest < 1e-9 * step {
                whole += 1;
                rest = 0.0;
            }
        }
        Self {
            excitation,
            model,
            before: model.map_input(excitation.before),
            delay,
            whole,
            rest,
            pointer: 0,
        }
    }

    fn prepare(&self, engine: &mut Engine) {
        if let Some(step) = self.excitation.step {
            engine.prepare(step);
            if self.rest > 0.0 {
                engine.prepare(self.rest);
                engine.prepare(step - self.rest);
            }
        }
    }

    fn value(&self, sample: Option<usize>) -> f64 {
        sample.map_or(self.before, |i| {
            let input = &self.excitation.input;
            let next = input.get(i + 1).unwrap_or(&input[i]);
            let acting = input[i] + self.model.next_input * (next - input[i]);
            self.model.map_input(acting)
        })
    }

    /// Calls `go(value, duration)` for each piece between samples `i` and `i + 1`.
    fn pieces(&mut self, i: usize, mut go: impl FnMut(f64, f64)) {
        let Some(step) = self.excitation.step else {
            return self.uneven_pieces(i, go);
        };
        let late = self.value(i.checked_sub(self.whole));
        if self.rest == 0.0 {
            return go(late, step);
        }
        let early = self.value(i.checked_sub(self.whole + 1));
        if early == late {
            go(late, step);
        } else {
            go(early, self.rest);
            go(late, step - self.rest);
        }
    }

    fn uneven_pieces(&mut self, i: usize, mut go: impl FnMut(f64, f64)) {
        let time = &self.excitation.time;
        let (mut now, end) = (time[i], time[i + 1]);
        while now < end {
            while self.pointer < time.len() && time[self.pointer] + self.delay <= now {
                self.pointer += 1;
            }
            let until = time
                .get(self.pointer)
                .map_or(end, |t| (t + self.delay).min(end));
            go(self.value(self.pointer.checked_sub(1)), until - now);
            now = until;
        }
    }
}
