//! The search for the experiment, in small pieces.

use super::bench::{Bench, Hypothesis, Outcome};
use super::candidates::{LEAST_SAMPLES, candidates};
use super::program::Shape;
use super::words;
use crate::criticism::session::{Scored, Session};
use crate::diagnosis::{Limits, NextExperiment, Program, Trial};
use crate::effect::{Effect, EffectId};
use crate::measurement::Kind;
use crate::message::Message;

/// Iterations of a fit of the rival: at first, and for what comes into question.
const SCAN_ITERATIONS: usize = 3;
const FINAL_ITERATIONS: usize = 10;

/// Programs that come to this share of the best are looked at from both sides.
const HOPEFUL: f64 = 0.3;

/// Excess of squared residuals on held-back data, in noise units, that tells two models apart for sure: the statistic
/// that is asked for is 25, and its own spread is twice the root of the excess (25 + 4 sqrt(55) = 55).
const EXCESS: f64 = 55.0;

/// Least separation that is more than what clocks and rigs leave, in noise units: the error then differs by 1 %.
const LEAST_SEPARATION: f64 = 0.145;

/// Of experiments that are nearly as good (this share of the best) the gentler one is taken.
const NEARLY: f64 = 0.5;

/// The record is as much longer than needed, and shows a program as often.
const MARGIN: f64 = 1.5;
const CYCLES: f64 = 3.0;

/// Samples that a diagnosis wants in any case, so that all other effects can be judged as well.
const DIAGNOSED: f64 = 5000.0;

/// A program that was tried.
struct Tried {
    program: Program,
    outcome: Outcome,
    /// Whether it is looked at from both sides.
    hopeful: bool,
}

fn better(a: &Tried, b: &Tried) -> std::cmp::Ordering {
    b.outcome.separation.total_cmp(&a.outcome.separation)
}

enum Stage {
    /// The next program to be simulated with the first model.
    Scan(usize),
    /// The next of the best that is looked at from both sides.
    Final(usize),
    Done,
}

/// The search for one class.
pub(in crate::criticism) struct Design {
    bench: Bench,
    today: f64,
    programs: Vec<Program>,
    tried: Vec<Tried>,
    stage: Stage,
}

impl Design {
    /// `models` explain the record alike, the first of them being in the model; `today` is what the others leave
    /// beyond it. `None` where there is nothing to tell apart, or the limits leave no room.
    pub fn new(
        session: &Session,
        models: Vec<Hypothesis>,
        limits: Limits,
        today: f64,
    ) -> Option<Self> {
        let bench = Bench::new(session, models, limits)?;
        let step = bench.step;
        Some(Self {
            programs: candidates(&bench.sizes, &Limits { step, ..limits }),
            bench,
            today,
            tried: Vec::new(),
            stage: Stage::Scan(0),
        })
    }

    /// Share done, 0 to 1.
    pub fn progress(&self) -> f64 {
        match self.stage {
            Stage::Scan(k) => 0.7 * k as f64 / self.programs.len().max(1) as f64,
            Stage::Final(k) => 0.7 + 0.3 * k as f64 / self.tried.len().max(1) as f64,
            Stage::Done => 1.0,
        }
    }

    /// Tries one program; false when all is known.
    pub fn advance(&mut self) -> bool {
        match self.stage {
            Stage::Scan(k) => {
                let Some(program) = self.programs.get(k).cloned() else {
                    self.keep_the_best_of_each_kind();
                    self.stage = Stage::Final(0);
                    return true;
                };
                self.stage = Stage::Scan(k + 1);
                if let Some(program) = self.bench.within_limits(&program) {
                    let outcome = self.bench.rivals_of(0, &program, SCAN_ITERATIONS);
                    self.tried.extend(outcome.map(|outcome| Tried {
                        program,
                        outcome,
                        hopeful: false,
                    }));
                }
            }
            Stage::Final(k) => {
                let Some(tried) = self.tried.get(k).filter(|t| t.hopeful) else {
                    self.tried.sort_by(better);
                    self.stage = Stage::Done;
                    return true;
                };
                self.stage = Stage::Final(k + 1);
                let outcome = (0..self.bench.models.len())
                    .map(|truth| {
                        self.bench
                            .rivals_of(truth, &tried.program, FINAL_ITERATIONS)
                    })
                    .reduce(|a, b| Some(a?.worse(b?)))
                    .flatten();
                if let Some(outcome) = outcome {
                    self.tried[k].outcome = outcome;
                } else {
                    self.tried.remove(k);
                    self.stage = Stage::Final(k);
                }
            }
            Stage::Done => return false,
        }
        true
    }

    fn keep_the_best_of_each_kind(&mut self) {
        self.tried.sort_by(better);
        let mut seen: Vec<Shape> = Vec::new();
        self.tried.retain(|t| {
            let new = !seen.contains(&t.program.shape());
            seen.push(t.program.shape());
            new
        });
        let best = self.tried.first().map_or(0.0, |t| t.outcome.separation);
        for tried in &mut self.tried {
            tried.hopeful = tried.outcome.separation >= HOPEFUL * best;
        }
    }

    /// The proposal; `None` where no program could be tried.
    pub fn finish(self) -> Option<NextExperiment> {
        let best = self.tried.first()?;
        let near =
            |t: &&Tried| t.hopeful && t.outcome.separation >= NEARLY * best.outcome.separation;
        let chosen = self
            .tried
            .iter()
            .filter(near)
            .filter_map(|t| {
                let (needed, advised) = self.enough(t)?;
                Some((
                    t,
                    needed,
                    advised,
                    self.bench.reach_in(&t.program, advised)?,
                ))
            })
            .min_by_key(|(t, ..)| order(t.program.shape()));
        let sufficient = chosen.is_some();
        let (tried, needed, duration, (speed, travel)) = chosen.unwrap_or_else(|| {
            let duration = self.bench.limits.duration;
            let reach = self.bench.reach_in(&best.program, duration);
            (best, duration, duration, reach.unwrap_or_default())
        });
        let others = self
            .tried
            .iter()
            .filter(|t| t.program != tried.program)
            .map(|t| Trial {
                program: t.program.clone(),
                separation: t.outcome.separation,
                text: t.program.words(&self.bench.units.0, &self.bench.units.1),
            })
            .collect();
        let mut proposal = NextExperiment {
            class: self.bench.models.iter().map(|m| m.said.effect).collect(),
            program: tried.program.clone(),
            input_unit: self.bench.units.0.clone(),
            output_unit: self.bench.units.1.clone(),
            step: self.bench.limits.step,
            needed,
            duration,
            separation: tried.outcome.separation,
            today: self.today,
            sufficient,
            speed,
            travel,
            limits: self.bench.limits,
            others,
            models: self.bench.models.iter().map(|m| m.said.clone()).collect(),
            text: Message::default(),
        };
        proposal.text = words::text(&proposal);
        Some(proposal)
    }

    /// Length of record that tells the pair apart and that is advised, s; `None` where that is beyond the limit.
    fn enough(&self, tried: &Tried) -> Option<(f64, f64)> {
        let Outcome { separation, rate } = tried.outcome;
        if separation < LEAST_SEPARATION || rate <= 0.0 {
            return None;
        }
        let once = program_once(&tried.program, self.bench.limits.step);
        let needed = (MARGIN * EXCESS / rate).max(once);
        let shown = (CYCLES * tried.program.cycle()).max(DIAGNOSED * self.bench.limits.step);
        let slow = match self.bench.kind {
            Kind::Drive => 0.0,
            Kind::Process => 5.0 * self.bench.sizes.time_constant,
        };
        let longest = self.bench.limits.duration;
        let advised = || round_up(needed.max(shown).max(slow)).min(longest);
        (needed <= longest).then(|| (round_up(needed).min(longest), advised()))
    }
}

/// What could stand in the place of an effect, fitted.
pub(in crate::criticism) struct Rival {
    /// Index of the effect in the model.
    pub place: usize,
    /// What stands there instead.
    pub effect: EffectId,
    pub model: Scored,
}

/// One search for each effect of `model` in whose place others could stand.
pub(in crate::criticism) fn designs(
    session: &Session,
    model: &Scored,
    effects: &[&'static dyn Effect],
    rivals: &[Rival],
    limits: Limits,
) -> Vec<Design> {
    let class = |(place, own): (usize, &&'static dyn Effect)| {
        let mut models = vec![Hypothesis::new(session, own.id(), model)];
        let mut today = 0.0_f64;
        for rival in rivals.iter().filter(|r| r.place == place) {
            models.push(Hypothesis::new(session, rival.effect, &rival.model));
            let beyond = rival.model.score.error.powi(2) - model.score.error.powi(2);
            today = today.max(beyond.max(0.0).sqrt());
        }
        Design::new(session, models, limits, today)
    };
    effects.iter().enumerate().filter_map(class).collect()
}

/// Time in which a program shows once what it does, s.
fn program_once(program: &Program, step: f64) -> f64 {
    program.cycle().max(LEAST_SAMPLES * step)
}

/// Gentle programs first.
fn order(shape: Shape) -> usize {
    let all = [
        Shape::Relay,
        Shape::AsymmetricRelay,
        Shape::ChangingRelay,
        Shape::Levels,
        Shape::TwoLevels,
        Shape::Multisine,
    ];
    all.iter().position(|s| *s == shape).unwrap_or(all.len())
}

/// Two digits that count, upwards.
fn round_up(value: f64) -> f64 {
    let unit = libm::pow(10_f64, libm::log10(value).floor() - 1.0);
    (value / unit - 1e-6).ceil() * unit
}
