//! Long computations as resumable jobs: threads natively, a worker on the web, a loop in tests.

use super::search::Search;
use super::select::{delta_bic, helps, is_noise, same};
use super::session::{Scored, Session};
use super::verdict::{Class, verdict};
use super::{Candidate, Diagnosis, Step, StepReport};
use crate::effect::{self, Effect, EffectId};
use crate::measurement::Measurement;

/// Error of a perfect model in noise units.
const NOISE_FLOOR: f64 = 1.0;

/// Most effects that a diagnosis adds; a model that needs more is not this one.
const MAX_EFFECTS: usize = 6;

/// Most models that a diagnosis visits, so that adding and removing cannot go round for ever.
const MAX_STEPS: usize = 12;

/// How far a job has come.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress<T> {
    /// Not finished: share done, 0 to 1, and what it is doing, in plain words.
    Running {
        /// Share done, 0 to 1.
        fraction: f64,
        /// What it is doing, in plain words.
        text: String,
    },
    /// Finished.
    Done(T),
}

/// Why a measurement cannot be criticised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CriticismError {
    /// The input never changes, so nothing can be learnt from it.
    #[error("the input is constant over the whole file: an experiment must move it")]
    ConstantInput,
    /// An output never changes.
    #[error(
        "the column {name} is constant over the whole file: there is nothing to compare the model with"
    )]
    ConstantOutput {
        /// Its name in the file.
        name: String,
    },
    /// An effect that makes no sense for this kind of system.
    #[error("{effect} cannot be added to this kind of system")]
    WrongEffect {
        /// The effect.
        effect: EffectId,
    },
}

/// What a step is doing.
enum Stage {
    /// Fitting the model itself, effect by effect.
    Build { search: Search },
    /// Trying every effect on top.
    Try { index: usize, search: Search },
    /// Trying to do without each effect.
    Remove { index: usize, search: Search },
    /// Trying every other effect in the place of each one.
    Swap {
        place: usize,
        index: usize,
        search: Search,
    },
    /// Everything is known.
    Report,
}

/// Fits one model and tries every effect on top of it; where none helps, gives the verdict.
pub struct StepJob {
    session: Session,
    wanted: Vec<&'static dyn Effect>,
    stage: Stage,
    model: Option<Scored>,
    tried: Vec<(&'static dyn Effect, Scored)>,
    without: Vec<Scored>,
    classes: Vec<Class>,
    work: usize,
}

impl StepJob {
    /// The baseline plus `effects` (in the order in which the user added them) on `measurement`.
    pub fn new(measurement: &Measurement, effects: &[EffectId]) -> Result<Self, CriticismError> {
        let session = Session::new(measurement)?;
        let wanted = effects
            .iter()
            .filter(|id| **id != effect::VISCOUS_FRICTION)
            .map(|id| {
                effect::find(*id)
                    .filter(|e| e.kinds().contains(&measurement.kind))
                    .ok_or(CriticismError::WrongEffect { effect: *id })
            })
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self::of(session, wanted))
    }

    fn of(session: Session, wanted: Vec<&'static dyn Effect>) -> Self {
        let search = Search::baseline(&session.data);
        Self {
            session,
            wanted,
            stage: Stage::Build { search },
            model: None,
            tried: Vec::new(),
            without: Vec::new(),
            classes: Vec::new(),
            work: 0,
        }
    }

    /// The next step of a diagnosis, which knows the fit already.
    fn from_fit(session: Session, model: Scored) -> Self {
        let mut job = Self::of(session, model.fit.structure.effects.clone());
        job.model = Some(model);
        job.stage = job.after_build();
        job
    }

    /// Effects that are not in the model.
    fn others(&self) -> Vec<&'static dyn Effect> {
        effect::for_kind(self.session.kind())
            .filter(|e| self.wanted.iter().all(|w| w.id() != e.id()))
            .collect()
    }

    /// Does a small piece of work.
    pub fn advance(&mut self) -> Progress<StepReport> {
        self.work += 1;
        let Session {
            data,
            scout,
            scales,
            ..
        } = &self.session;
        let found = match &mut self.stage {
            Stage::Build { search }
            | Stage::Try { search, .. }
            | Stage::Remove { search, .. }
            | Stage::Swap { search, .. } => search.advance(data, scout, scales),
            Stage::Report => {
                if let Some(report) = self.report() {
                    return Progress::Done(report);
                }
                None
            }
        };
        if let Some(fit) = found {
            let scored = self.session.scored(fit);
            self.next(scored);
        }
        let (fraction, text) = self.progress();
        Progress::Running { fraction, text }
    }

    /// Takes the result of the search of this stage and goes on to the next one.
    fn next(&mut self, scored: Scored) {
        self.stage = match &self.stage {
            Stage::Build { .. } => {
                let done = scored.fit.structure.effects.len();
                let stage = self.wanted.get(done).map(|effect| Stage::Build {
                    search: Search::adding(
                        &self.session.data,
                        &scored.fit,
                        *effect,
                        &self.session.scales,
                    ),
                });
                self.model = Some(scored);
                stage.unwrap_or_else(|| self.after_build())
            }
            Stage::Try { index, .. } => {
                let index = *index;
                if let Some(effect) = self.others().get(index) {
                    self.tried.push((*effect, scored));
                }
                self.try_stage(index + 1)
            }
            Stage::Remove { index, .. } => {
                let index = *index;
                self.without.push(scored);
                self.remove_stage(index + 1)
            }
            Stage::Swap { place, index, .. } => {
                let (place, index) = (*place, *index);
                self.judge_swap(place, index, &scored);
                self.swap_stage(place, index + 1)
            }
            Stage::Report => Stage::Report,
        };
    }

    fn after_build(&self) -> Stage {
        self.try_stage(0)
    }

    fn try_stage(&self, index: usize) -> Stage {
        match (self.others().get(index), &self.model) {
            (Some(effect), Some(model)) => Stage::Try {
                index,
                search: Search::adding(
                    &self.session.data,
                    &model.fit,
                    *effect,
                    &self.session.scales,
                ),
            },
            _ => self.remove_stage(0),
        }
    }

    fn remove_stage(&self, index: usize) -> Stage {
        match &self.model {
            Some(model) if index < self.wanted.len() => Stage::Remove {
                index,
                search: Search::removing(&model.fit, index),
            },
            _ => self.swap_stage(0, 0),
        }
    }

    /// Swaps are tried only for a final model: nothing helps it, and all in it is needed.
    fn swap_stage(&self, place: usize, index: usize) -> Stage {
        let Some(model) = &self.model else {
            return Stage::Report;
        };
        if self.suggestion(model).is_some() || !self.needless(model).is_empty() {
            return Stage::Report;
        }
        let others = self.others();
        if index >= others.len() {
            return if place + 1 < self.wanted.len() && !others.is_empty() {
                self.swap_stage(place + 1, 0)
            } else {
                Stage::Report
            };
        }
        match self.without.get(place) {
            Some(without) => Stage::Swap {
                place,
                index,
                search: Search::adding(
                    &self.session.data,
                    &without.fit,
                    others[index],
                    &self.session.scales,
                ),
            },
            None => Stage::Report,
        }
    }

    fn judge_swap(&mut self, place: usize, index: usize, swapped: &Scored) {
        let (others, Some(model)) = (self.others(), &self.model) else {
            return;
        };
        let alike = same(
            &model.score,
            model.fit.values.len(),
            &swapped.score,
            swapped.fit.values.len(),
        );
        if self.classes.len() <= place {
            self.classes.resize_with(place + 1, Class::default);
        }
        if alike && let Some(effect) = others.get(index) {
            self.classes[place].push(*effect);
        }
    }

    /// The effect to add next: the best that helps; of equals the one with fewer parameters.
    fn suggestion(&self, model: &Scored) -> Option<&(&'static dyn Effect, Scored)> {
        let helping = || self.tried.iter().filter(|(_, s)| helps_clearly(model, s));
        let best = helping().min_by(|a, b| a.1.score.error.total_cmp(&b.1.score.error))?;
        helping()
            .filter(|(_, s)| {
                s.fit.values.len() < best.1.fit.values.len()
                    && same(
                        &s.score,
                        s.fit.values.len(),
                        &best.1.score,
                        best.1.fit.values.len(),
                    )
            })
            .min_by_key(|(_, s)| s.fit.values.len())
            .or(Some(best))
    }

    /// Effects without which the held-back error does not rise.
    fn needless(&self, model: &Scored) -> Vec<EffectId> {
        self.wanted
            .iter()
            .zip(&self.without)
            .filter(|(_, without)| !helps(&without.score, &model.score))
            .map(|(e, _)| e.id())
            .collect()
    }

    fn progress(&self) -> (f64, String) {
        let count = self.others().len().max(1) as f64;
        let place = |index: usize, search: &Search| (index as f64 + search.fraction()) / count;
        match &self.stage {
            Stage::Build { search } => (0.1 * search.fraction(), "Fitting the model".to_owned()),
            Stage::Try { index, search } => {
                let name = self.others().get(*index).map_or("", |e| e.name());
                (0.1 + 0.6 * place(*index, search), format!("Trying: {name}"))
            }
            Stage::Remove { index, search } => {
                let share = (*index as f64 + search.fraction()) / self.wanted.len().max(1) as f64;
                (
                    0.7 + 0.05 * share,
                    "Checking that every effect is needed".to_owned(),
                )
            }
            Stage::Swap {
                place: k,
                index,
                search,
            } => {
                let share = (*k as f64 + place(*index, search)) / self.wanted.len().max(1) as f64;
                (
                    0.75 + 0.25 * share,
                    "Checking what else could explain it".to_owned(),
                )
            }
            Stage::Report => (1.0, "Done".to_owned()),
        }
    }

    fn report(&self) -> Option<StepReport> {
        let model = self.model.as_ref()?;
        let suggestion = self.suggestion(model).map(|(e, _)| e.id());
        let needless = self.needless(model);
        let parameters = self.session.parameters(model);
        let verdict = (suggestion.is_none() && needless.is_empty()).then(|| {
            verdict(
                &self.wanted,
                &self.classes,
                &parameters,
                model,
                is_noise(&model.score),
            )
        });
        Some(StepReport {
            step: Step {
                effects: self.session.effects(&model.fit),
                error: model.score.error,
                error_fit: model.score.error_fit,
                parameters,
                findings: self.session.findings(model),
                candidates: self.candidates(model, suggestion),
            },
            noise_floor: NOISE_FLOOR,
            replay: self.session.replay(&model.fit),
            suggestion,
            needless,
            verdict,
        })
    }

    /// Every effect tried, best first; the suggested one leads.
    fn candidates(&self, model: &Scored, suggestion: Option<EffectId>) -> Vec<Candidate> {
        let length = model.fit.values.len();
        let mut candidates: Vec<Candidate> = self
            .tried
            .iter()
            .map(|(effect, scored)| {
                let worse = scored.fit.cost > model.fit.cost;
                let equivalent_to = self
                    .tried
                    .iter()
                    .filter(|(other, o)| {
                        other.id() != effect.id()
                            && helps_clearly(model, scored)
                            && helps_clearly(model, o)
                            && same(
                                &scored.score,
                                scored.fit.values.len(),
                                &o.score,
                                o.fit.values.len(),
                            )
                    })
                    .map(|(other, _)| other.id())
                    .collect();
                Candidate {
                    effects: vec![effect.id()],
                    // Every effect contains "none of it", so it never has to make things worse.
                    error: if worse {
                        model.score.error
                    } else {
                        scored.score.error
                    },
                    delta_bic: if worse {
                        effect.parameters().len() as f64 * model.score.fit_count.ln()
                    } else {
                        delta_bic(&model.score, length, &scored.score, scored.fit.values.len())
                    },
                    significant: helps_clearly(model, scored),
                    parameters: self
                        .session
                        .parameters(scored)
                        .into_iter()
                        .filter(|p| p.effect == Some(effect.id()))
                        .collect(),
                    equivalent_to,
                }
            })
            .collect();
        candidates.sort_by(|a, b| {
            let first = |c: &Candidate| suggestion.is_none_or(|s| c.effects[0] != s);
            first(a).cmp(&first(b)).then(a.error.total_cmp(&b.error))
        });
        candidates
    }

    /// The model to go on from: with the suggestion, or without the first needless effect.
    fn successor(self) -> Option<(Session, Scored)> {
        let model = self.model.as_ref()?;
        let next = if let Some(id) = self.needless(model).first() {
            let index = self.wanted.iter().position(|w| w.id() == *id)?;
            self.without.get(index).cloned()
        } else {
            self.suggestion(model).map(|(_, scored)| scored.clone())
        }?;
        Some((self.session, next))
    }
}

/// Fall of the error below which the leading parameter of an effect must stand out by itself.
const LARGE_FALL: f64 = 0.1;

/// Standard errors by which it must differ from 0 then.
const CLEAR_ERRORS: f64 = 3.0;

/// Whether the last effect of `with` helps `model`, and is itself seen if it helps only a little.
fn helps_clearly(model: &Scored, with: &Scored) -> bool {
    if !helps(&model.score, &with.score) {
        return false;
    }
    if with.score.error < (1.0 - LARGE_FALL) * model.score.error {
        return true;
    }
    let leading = model.fit.values.len();
    let inflation = with.score.error_fit.powi(2).max(1.0) * with.score.correlation.max(1.0);
    let errors = with.fit.standard_errors(inflation);
    with.fit
        .values
        .get(leading)
        .zip(errors.get(leading))
        .is_some_and(|(v, e)| v.abs() > CLEAR_ERRORS * e)
}

/// From the baseline to the verdict: adds what helps, removes what is not needed, until nothing does.
pub struct DiagnosisJob {
    job: Option<StepJob>,
    diagnosis: Diagnosis,
}

impl DiagnosisJob {
    /// Prepares a diagnosis.
    pub fn new(measurement: &Measurement) -> Result<Self, CriticismError> {
        Ok(Self {
            job: Some(StepJob::new(measurement, &[])?),
            diagnosis: Diagnosis {
                schema: 1,
                kind: measurement.kind,
                samples: measurement.len(),
                noise_floor: NOISE_FLOOR,
                steps: Vec::new(),
                verdict: super::Verdict {
                    missing: Vec::new(),
                    complete: false,
                    unknown: false,
                    next_experiment: None,
                    text: String::new(),
                },
                seconds: 0.0,
            },
        })
    }

    /// Does a small piece of work.
    pub fn advance(&mut self) -> Progress<Diagnosis> {
        let Some(job) = &mut self.job else {
            return Progress::Done(self.diagnosis.clone());
        };
        let report = match job.advance() {
            Progress::Running { fraction, text } => {
                let done = self.diagnosis.steps.len() as f64;
                // The number of steps is not known: each takes half of what is left.
                let fraction = 1.0 - 0.5_f64.powf(done + fraction);
                return Progress::Running { fraction, text };
            }
            Progress::Done(report) => report,
        };
        let effects = report.step.effects.len();
        self.diagnosis.steps.push(report.step);
        if let Some(verdict) = report.verdict {
            self.diagnosis.verdict = verdict;
            self.job = None;
            return Progress::Done(self.diagnosis.clone());
        }
        let ended = self.diagnosis.steps.len() >= MAX_STEPS || effects > MAX_EFFECTS;
        let next = self
            .job
            .take()
            .filter(|_| !ended)
            .and_then(StepJob::successor);
        match next {
            Some((session, model)) => self.job = Some(StepJob::from_fit(session, model)),
            None => self.diagnosis.verdict = super::verdict::undecided(&self.diagnosis.steps),
        }
        Progress::Running {
            fraction: 1.0 - 0.5_f64.powf(self.diagnosis.steps.len() as f64),
            text: "Next".to_owned(),
        }
    }
}
