//! Long computations as resumable jobs: threads natively, a worker on the web, a loop in tests.

use super::select::{SMALL_SHARE, is_trifle, outweighs};
use super::session::{Scored, Session};
use super::step::StepJob;
use crate::crew::Crew;
use crate::diagnosis::{CriticismError, Diagnosis, Limits, Step, StepReport};
use crate::effect::EffectId;
use crate::measurement::Measurement;
use crate::progress::Progress;
use crate::user_model::UserModel;

/// Most effects that a diagnosis adds; a model that needs more is not this one.
const MAX_EFFECTS: usize = 6;

/// Most models that a diagnosis visits, so that adding and removing cannot go round for ever.
const MAX_STEPS: usize = 12;

/// Other effects that are tried first where the best ones led to no end: the greedy choice may be the
/// wrong one of two that hide each other.
const MAX_DETOURS: usize = 4;

/// Steps in which alternatives are noted, and how many in each.
const DETOUR_STEPS: usize = 2;
const DETOURS_PER_STEP: usize = 2;

/// Effects that are tried on where none helps beyond chance by itself: two that only show together.
const BOLD_DETOURS: usize = 2;

/// Share of the error there was without it that a bold detour may leave after its second effect.
const BOLD_GAIN: f64 = 0.5;

/// Share by which a detour must lower the error to be the better way.
const DETOUR_GAIN: f64 = 0.97;

/// The same of a bold one that does not explain all.
const LARGE_GAIN: f64 = 0.2;

/// Share of the error that the same effects left before which is no better.
const AS_BEFORE: f64 = 0.97;

/// Share of its error that a model may leave to be gone on with when enough was tried.
const LATE_GAIN: f64 = 0.5;

/// A way not taken yet: the steps before, and the model to go on from.
struct Detour {
    steps: Vec<Step>,
    model: Scored,
    /// Whether the model has an effect that did not help clearly by itself; such a way must explain
    /// everything.
    bold: bool,
    /// Effects that are not tried on it.
    barred: Vec<EffectId>,
}

/// Where a way came to.
struct End {
    diagnosis: Diagnosis,
    /// Report on its last model.
    last: Option<StepReport>,
    /// What in that may be an imitation, and the model without it.
    imitation: Option<(EffectId, Scored)>,
}

/// From the baseline to the verdict: adds what helps, removes what is not needed, until nothing does.
pub struct DiagnosisJob {
    job: Option<StepJob>,
    /// How far the next experiment may go.
    limits: Limits,
    diagnosis: Diagnosis,
    /// Ways not taken yet.
    detours: Vec<Detour>,
    detours_taken: usize,
    /// Effects that were taken out because they may be imitations.
    barred: Vec<EffectId>,
    /// Whether the present way began with an effect that was not seen clearly.
    bold: bool,
    /// The best that came to an end without explaining everything.
    unfinished: Option<End>,
    /// Report on the baseline, without its curves.
    first: Option<StepReport>,
    /// Report on the last model.
    last: Option<StepReport>,
}

impl DiagnosisJob {
    /// Prepares a diagnosis.
    pub fn new(measurement: &Measurement) -> Result<Self, CriticismError> {
        Self::with_model(measurement, &UserModel::blank(measurement.kind))
    }

    /// Prepares a diagnosis that begins with what the user knows.
    pub fn with_model(
        measurement: &Measurement,
        model: &UserModel,
    ) -> Result<Self, CriticismError> {
        let job = StepJob::with_model(measurement, &[], model)?;
        let input_check = job.input_check().clone();
        Ok(Self {
            job: Some(job),
            limits: Limits::of(measurement),
            diagnosis: Diagnosis::begun(measurement.kind, measurement.len(), input_check),
            detours: Vec::new(),
            detours_taken: 0,
            barred: Vec::new(),
            bold: false,
            unfinished: None,
            first: None,
            last: None,
        })
    }

    /// The same with other limits of the next experiment than [`Limits::of`] the measurement.
    #[must_use]
    pub fn within(self, limits: Limits) -> Self {
        Self {
            job: self.job.map(|job| job.within(limits)),
            limits,
            ..self
        }
    }

    /// The same with the independent parts of the work done by `crew`.
    #[must_use]
    pub fn with_crew(self, crew: &Crew) -> Self {
        let job = self.job.map(|job| job.with_crew(crew));
        Self { job, ..self }
    }

    /// Does some work.
    pub fn advance(&mut self) -> Progress<Diagnosis> {
        let Some(job) = &mut self.job else {
            return Progress::Done(self.diagnosis.clone());
        };
        let report = match job.advance() {
            Progress::Running { fraction, text } => {
                let done = self.diagnosis.steps.len() as f64;
                // The number of steps is not known: each takes half of what is left.
                let fraction = 1.0 - libm::pow(0.5_f64, done + fraction);
                return Progress::Running { fraction, text };
            }
            Progress::Done(report) => report,
        };
        let effects = report.step.effects.len();
        let before = self.diagnosis.steps.len();
        self.diagnosis.steps.push(report.step.clone());
        if self.first.is_none() {
            self.first = Some(report.without_curves());
        }
        let Some(job) = self.job.take() else {
            return Progress::Done(self.diagnosis.clone());
        };
        if before < DETOUR_STEPS && self.detours_taken == 0 {
            self.note(job.alternatives(DETOURS_PER_STEP), false);
        }
        let ways = !self.bold && self.barred.is_empty();
        if ways && report.verdict.as_ref().is_some_and(|v| !v.complete) {
            self.note(job.faint(BOLD_DETOURS), true);
        }
        let unknown = report.verdict.as_ref().filter(|v| v.unknown);
        let imitation = unknown.and_then(|_| job.imitation(report.step.error));
        let (session, next) = job.successor();
        // What is needless is taken out in any case.
        let worthwhile = next.as_ref().is_some_and(|model| {
            model.score.error < LATE_GAIN * report.step.error
                || session.effects(&model.fit).len() < effects
        });
        let ended = self.diagnosis.steps.len() >= MAX_STEPS
            || effects > MAX_EFFECTS
            || (session.data.tried_enough() && !worthwhile);
        let verdict = report.verdict.clone();
        if verdict.as_ref().is_some_and(|v| !v.contradicted.is_empty()) {
            // Wrong values are to be put right; no other way round them is looked for.
            self.detours.clear();
            self.unfinished = None;
        }
        self.diagnosis.noise_floor = report.noise_floor;
        self.diagnosis.noise.clone_from(&report.noise);
        self.last = Some(report);
        match (verdict, next) {
            (_, Some(model)) if !ended && !self.falls_short(&session, &model) => {
                if let Some(round) = self.left_in_a_round(&session, &model) {
                    self.bar(round);
                }
                self.go_on(session, model);
            }
            (verdict, _) => {
                self.diagnosis.verdict = verdict.unwrap_or_else(|| {
                    super::verdict::undecided(&self.diagnosis.steps, session.knowledge.present())
                });
                if let Some(done) = self.end_of_way(session, imitation) {
                    return Progress::Done(done);
                }
            }
        }
        Progress::Running {
            fraction: 1.0 - libm::pow(0.5_f64, self.diagnosis.steps.len() as f64),
            text: "Next".to_owned(),
        }
    }

    /// Tries this effect no more.
    fn bar(&mut self, effect: EffectId) {
        if !self.barred.contains(&effect) {
            self.barred.push(effect);
        }
    }

    /// Whether a bold way goes on with a model that explains little more than what came to an end before: two
    /// effects that only show together leave next to nothing. Doing without an effect is not meant to explain more.
    fn falls_short(&self, session: &Session, next: &Scored) -> bool {
        let count = session.effects(&next.fit).len();
        let adds = self
            .diagnosis
            .steps
            .last()
            .is_some_and(|last| count > last.effects.len());
        let before = self.unfinished.as_ref().filter(|_| self.bold && adds);
        let error = before
            .and_then(|end| end.diagnosis.steps.last())
            .map(|s| s.error);
        error.is_some_and(|error| next.score.error > BOLD_GAIN * error)
    }

    /// The effect that is left out next, where that leads back to effects that the way had before and is no better now:
    /// it seems to help, and then not to be needed, for ever.
    fn left_in_a_round(&self, session: &Session, next: &Scored) -> Option<EffectId> {
        let effects = session.effects(&next.fit);
        let steps = &self.diagnosis.steps;
        let again = steps.iter().any(|step| {
            step.effects.len() == effects.len()
                && effects.iter().all(|e| step.effects.contains(e))
                && next.score.error > AS_BEFORE * step.error
        });
        let last = steps.last().filter(|_| again)?;
        let left = last.effects.iter().find(|e| !effects.contains(e));
        left.copied()
    }

    /// Takes the diagnosis that came to an end, or another way if there is one and this one explains too
    /// little.
    fn end_of_way(
        &mut self,
        session: Session,
        imitation: Option<(EffectId, Scored)>,
    ) -> Option<Diagnosis> {
        let error = |d: &Diagnosis| d.steps.last().map_or(f64::INFINITY, |s| s.error);
        let gain = if self.bold { LARGE_GAIN } else { DETOUR_GAIN };
        let better = self.unfinished.take().filter(|other| {
            only_adds(&self.diagnosis, &other.diagnosis)
                || !self.diagnosis.verdict.complete
                    && gain * error(&other.diagnosis) <= error(&self.diagnosis)
        });
        let here = End {
            diagnosis: self.diagnosis.clone(),
            last: self.last.take(),
            imitation,
        };
        let best = better.unwrap_or(here);
        let settled = best.diagnosis.verdict.complete
            || trifling(&best.diagnosis, &session)
            || session.data.tried_enough();
        let next = if settled || self.detours_taken >= MAX_DETOURS || self.detours.is_empty() {
            (self.diagnosis, self.last) = (best.diagnosis, best.last);
            let more = !self.diagnosis.verdict.complete
                && self.diagnosis.steps.len() < MAX_STEPS
                && !session.data.tried_enough();
            let Some((effect, without)) = best.imitation.filter(|_| more) else {
                return Some(self.diagnosis.clone());
            };
            self.bar(effect);
            self.detours.clear();
            self.bold = false;
            without
        } else {
            self.unfinished = Some(best);
            self.detours_taken += 1;
            let detour = self.detours.remove(0);
            self.diagnosis.steps = detour.steps;
            self.bold = detour.bold;
            self.barred = detour.barred;
            detour.model
        };
        self.go_on(session, next);
        None
    }

    /// Notes ways to try later, which branch off here.
    fn note(&mut self, models: Vec<Scored>, bold: bool) {
        let steps = &self.diagnosis.steps;
        self.detours.extend(models.into_iter().map(|model| Detour {
            steps: steps.clone(),
            model,
            bold,
            barred: self.barred.clone(),
        }));
    }

    /// Begins the next step.
    fn go_on(&mut self, session: Session, model: Scored) {
        let job = StepJob::from_fit(session, model, self.limits);
        let job = job.following(&self.diagnosis.steps);
        self.job = Some(job.barring(&self.barred));
    }

    /// Once it is done: the reports on the baseline (without its curves) and on the last model.
    pub fn evidence(&self) -> Option<(&StepReport, &StepReport)> {
        self.first.as_ref().zip(self.last.as_ref())
    }
}

/// Whether a diagnosis says no other effects than the `shorter` one, but for some more that explain less than they leave.
fn only_adds(longer: &Diagnosis, shorter: &Diagnosis) -> bool {
    let ends = longer.steps.last().zip(shorter.steps.last());
    ends.is_some_and(|(long, short)| {
        let same = short.effects.iter().all(|e| long.effects.contains(e));
        same && !outweighs(short.error, long.error)
    })
}

/// Whether the last model leaves a trifle of what there was at first: another way would find nothing else.
fn trifling(diagnosis: &Diagnosis, session: &Session) -> bool {
    let last = diagnosis.steps.last().map(|s| s.error);
    last.zip(session.baseline.as_ref())
        .is_some_and(|(error, first)| is_trifle(error, first, SMALL_SHARE))
}
