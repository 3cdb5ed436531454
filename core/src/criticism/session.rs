//! What all fits on one measurement share: its data, sizes and units.

use std::sync::Arc;

use super::cost::fitted_costs;
use super::data::Data;
use super::fit::Fit;
use super::guess::guess;
use super::knowledge::{self, Knowledge};
use super::noise::{WANDER, is_left_by_random_forces, is_noise_with_memory, left_by_input};
use super::probes::{Probed, Probes};
use super::record::Levelled;
use super::relay_loop::RelayLoop;
use super::score::{Score, motion_square, score};
use super::screen::Screened;
use super::select::{CHANCE, SAMPLED_SHARE, SMALL_SHARE, is_noise};
use super::sight::{Sighted, felt_gap, sight};
use super::split::hold_back;
use crate::crew::Crew;
use crate::diagnosis::{CriticismError, InputCheck, Screening};
use crate::effect::{
    self, Dimension, Effect, EffectId, ParameterSpec, Probe, ProbeInput, ProbeOutput, Range,
    Scales, SeenGap, baseline::Baseline,
};
use crate::measurement::{Kind, Measurement, Motion, Quantity};
use crate::uncertain::NORMAL_95;
use crate::user_model::UserModel;

/// A fit with its score.
#[derive(Clone)]
pub(super) struct Scored {
    pub fit: Fit,
    pub score: Score,
}

impl Scored {
    /// Standard errors of the values, widened by what the model leaves and by how that is correlated.
    pub fn standard_errors(&self) -> Vec<f64> {
        self.fit.standard_errors(self.inflation())
    }

    /// By how much the variance of the values is widened so.
    fn inflation(&self) -> f64 {
        let left = self.score.error_fit.powi(2).max(1.0);
        left * self.score.correlation.max(1.0)
    }

    /// Whether a parameter that tells of the effect at a place is not 0 by these errors: its 95 % interval leaves 0
    /// out.
    pub fn tells_of(&self, place: usize) -> bool {
        let structure = &self.fit.structure;
        let errors = self.standard_errors();
        let mut telling = structure
            .range(place)
            .take(structure.effects[place].telling());
        telling.any(|j| self.fit.values[j].abs() > TELLING * errors[j])
    }

    /// Whether what makes an effect in the model what it is stands out by these errors.
    pub fn shows_marks_of(&self, effect: &dyn Effect, scales: &Scales) -> bool {
        self.fit.shows_marks_of(effect, scales, self.inflation())
    }
}

/// What a model leaves of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rest {
    /// Noise, but for a trifle.
    Noise,
    /// Noise that remembers for some samples, and so is larger than neighbouring samples show.
    NoiseWithMemory,
    /// What small random forces leave, and noise.
    RandomForces,
    /// More than noise.
    More,
}

/// Error up to which noise that remembers some samples may be larger than their differences show.
const MOST_REMEMBERED: f64 = 2.0;

/// Standard errors by which a parameter that tells of an effect must differ from 0: its 95 % interval leaves it out.
pub(super) const TELLING: f64 = NORMAL_95;

/// Samples of a drive on which models are compared; a longer record is fitted as a whole at last.
const COMPARED: usize = 20_000;

/// Iterations of a fit of the whole record from that of a part of it.
const WHOLE_ITERATIONS: usize = 2;

/// Share of the typical input below which a force, or an asymmetry, is no effect.
const TRIFLE: f64 = 1e-3;

/// A guess of an inertia this many times the fitted one says nothing of the sizes of other things.
const FAR_HEAVIER: f64 = 4.0;

/// Factor within which a model keeps a body that the balance of momentum tells.
const HELD_FACTOR: f64 = 4.0;

/// Inertia and viscous friction that the screen of a drive told.
fn told_body(screening: &Screening) -> Option<[f64; 2]> {
    let told = screening.kind == Kind::Drive && screening.input_check.plant_told;
    let value = |k: usize| screening.body.get(k).map(|p| p.value);
    let body = [value(0)?, value(1)?.max(0.0)];
    (told && body[0] > 0.0).then_some(body)
}

/// Whether two inertias are not within a factor of each other in which a fit would find from one to the other.
fn far_apart(a: f64, b: f64) -> bool {
    a > HELD_FACTOR * b || b > HELD_FACTOR * a
}

/// Share of what there was at first that may be left beside noise by a model that explains the record.
pub(super) fn small_share(fit: &Fit) -> f64 {
    if fit.structure.effects.iter().any(|e| e.is_of_record()) {
        SAMPLED_SHARE
    } else {
        SMALL_SHARE
    }
}

pub(super) struct Session {
    /// What fits are compared on: all of the record, or windows spread over a long one.
    pub data: Data,
    /// All of a long record, if `data` is not.
    full: Option<Data>,
    /// Score of the baseline, once it is fitted.
    pub baseline: Option<Score>,
    /// What the user knows beforehand.
    pub knowledge: Knowledge,
    /// Effects of the user's own.
    own: Vec<&'static dyn Effect>,
    /// Effects that are not to be known.
    pub lacking: Vec<EffectId>,
    /// Part of the data on which starting points are tried.
    pub scout: Data,
    pub scales: Scales,
    /// Inertia and viscous friction of a drive that the screen told.
    pub screened_body: Option<[f64; 2]>,
    /// Mean square of the motion in units of the noise.
    pub motion_square: f64,
    /// What models that were met leave unexplained.
    probes: Probes,
    pub motion: Motion,
    /// Whether the input explains the motion.
    pub input_check: InputCheck,
    /// The gap that a drifting test shows.
    pub gap: Option<SeenGap>,
    /// The input on its levels, if its noise was taken off.
    pub levelled: Option<Levelled>,
    /// The loop in which the record was made, if a relay closed it.
    pub relay_loop: Option<RelayLoop>,
    pub input_unit: String,
    /// Quantity, name and unit of each output.
    pub outputs: Vec<(Quantity, String, String)>,
}

impl Session {
    /// What is known of a record, and the record as it was screened.
    pub fn screened(
        measurement: &Measurement,
        model: &UserModel,
    ) -> Result<(Self, Screened), CriticismError> {
        knowledge::check(model, measurement)?;
        let Sighted {
            gap,
            seen,
            contacts,
        } = sight(measurement);
        let mut data = Data::new(measurement)?;
        data = data.with_contacts(&contacts).cut_at_contacts();
        if let Some(seen) = seen {
            data = data.with_seen_load(seen);
        }
        let plain = Baseline::plain();
        let guess = guess(&data, &data.excitation.effective_input(&plain))
            .unwrap_or_else(|| data.baseline.unknown());
        let own: Vec<&'static dyn Effect> = model
            .formulas()
            .map(|formula| {
                formula.effect(model.kind).map_err(|error| {
                    let name = formula.name.clone();
                    CriticismError::OwnEffect { name, error }
                })
            })
            .collect::<Result<_, _>>()?;
        let screened = Screened::new(measurement, &own);
        let screening = &screened.screening;
        let screened_body = told_body(screening);
        // Where a regression sample by sample has run off, sizes are those that the weak form tells.
        let guessed: [f64; 2] = data.baseline.body(&guess).into();
        let run_off = |body: &[f64; 2]| far_apart(body[0], guessed[0]);
        let [inertia, viscous] = screened_body.filter(run_off).unwrap_or(guessed);
        let scales = data.scales(inertia, viscous);
        let knowledge = Knowledge::of(model).with_felt_gap(gap.map(felt_gap));
        hold_back(&mut data, &knowledge, guess, &scales);
        let relay_loop = RelayLoop::of(&data);
        let compared = data.thinned(COMPARED);
        let session = Self {
            scales,
            screened_body,
            input_check: screening.input_check.clone(),
            motion_square: motion_square(&compared, 0.0, |_| true),
            probes: Probes::default(),
            scout: compared.scout(),
            knowledge,
            own,
            lacking: Vec::new(),
            baseline: None,
            full: (compared.used() < data.used()).then_some(data),
            data: compared,
            motion: measurement.motion(),
            gap,
            levelled: None,
            relay_loop,
            input_unit: measurement.input.unit.clone(),
            outputs: measurement
                .outputs
                .iter()
                .map(|c| (c.quantity, c.name.clone(), c.unit.clone()))
                .collect(),
        };
        Ok((session, screened))
    }

    /// The record as it is compared, its scout, and where that is more the whole of it.
    fn all_data(&mut self) -> impl Iterator<Item = &mut Data> {
        [&mut self.data, &mut self.scout]
            .into_iter()
            .chain(&mut self.full)
    }

    /// Has the parts of what is computed done by `crew`.
    pub fn employ(&mut self, crew: &Crew) {
        for data in self.all_data() {
            data.crew = crew.clone();
        }
    }

    /// Effects of the user's model, then `added` ones, as they may be in a model.
    pub fn chosen(
        &self,
        model: &UserModel,
        added: &[EffectId],
    ) -> Result<Vec<&'static dyn Effect>, CriticismError> {
        let present = model.present();
        let added = added.iter().filter(|id| !present.contains(id));
        let chosen = present
            .iter()
            .chain(added)
            .filter(|id| **id != effect::VISCOUS_FRICTION)
            .map(|id| {
                self.find(*id)
                    .ok_or(CriticismError::WrongEffect { effect: *id })
            })
            .collect::<Result<Vec<_>, _>>()?;
        self.check_units(&chosen)?;
        Ok(chosen)
    }

    /// Effects that may be in a model: those of the library and the user's own.
    fn known(&self) -> impl Iterator<Item = &'static dyn Effect> {
        let all = effect::for_kind(self.kind()).chain(self.own.iter().copied());
        all.filter(|e| !self.lacking.contains(&e.id()))
    }

    /// Those that say something which the baseline does not.
    fn open(&self) -> impl Iterator<Item = &'static dyn Effect> {
        self.known().filter(|e| !self.data.baseline.has(e.id()))
    }

    /// Those of them that are tried at once.
    pub fn library(&self) -> impl Iterator<Item = &'static dyn Effect> {
        self.open().filter(|e| !effect::is_seldom(e.id()))
    }

    /// Those that few machines have, which are tried last.
    pub fn seldom(&self) -> impl Iterator<Item = &'static dyn Effect> {
        self.open().filter(|e| effect::is_seldom(e.id()))
    }

    /// One that may be in a model.
    pub fn find(&self, id: EffectId) -> Option<&'static dyn Effect> {
        self.known().find(|e| e.id() == id)
    }

    /// What `fit` leaves unexplained, as a force.
    pub fn probed(&self, fit: &Fit) -> Arc<Probed> {
        self.probes.of(fit, || self.probe_of(&self.data, fit))
    }

    /// The same of a fit on these data.
    pub fn probe_of(&self, data: &Data, fit: &Fit) -> Probe {
        let model = fit.structure.model(&fit.values);
        let outputs: Vec<ProbeOutput> = data
            .outputs
            .iter()
            .map(|o| ProbeOutput {
                is_velocity: o.is_velocity,
                error: o
                    .values
                    .iter()
                    .zip(fit.motion.of(o.is_velocity))
                    .map(|(y, m)| y - m)
                    .collect(),
                // Between two readings that a channel held there is nothing new.
                noise: o.noise
                    * (data.len() as f64 / o.telling(0, data.len()).max(1) as f64).sqrt(),
            })
            .collect();
        Probe::new(&ProbeInput {
            kind: data.kind,
            rotates: self.motion == Motion::Rotational,
            scales: self.scales,
            position: &data.position_estimate(),
            followed: data.excitation.followed(),
            velocity: &data.velocity_estimate(),
            input: &data.input,
            acting: &data.excitation.effective_input(&model),
            outputs: &outputs,
            spans: &data.spans(),
            body: fit.structure.baseline.body(&fit.values),
            gap: self.gap,
            crew: &data.crew,
        })
    }

    /// Takes a process for one whose output stays where the input leaves it.
    pub fn integrate(&mut self) {
        for data in self.all_data() {
            data.baseline = Baseline::Integrator;
        }
    }

    /// Has models fitted and compared by the news of each sample, beyond a level that moves towards each.
    pub fn let_surroundings_wander(&mut self) {
        for data in self.all_data() {
            data.wander = WANDER;
        }
        self.forget_models();
    }

    /// Takes the noise of a process for this share of what its smooth stretches showed.
    pub fn quieten(&mut self, share: f64) {
        for data in self.all_data() {
            for output in &mut data.outputs {
                output.noise *= share;
            }
        }
        self.forget_models();
    }

    /// Forgets what was found of models by another measure of what they leave.
    fn forget_models(&mut self) {
        self.motion_square = motion_square(&self.data, self.data.wander, |_| true);
        self.probes = Probes::default();
        self.baseline = None;
    }

    /// Settles sizes by the fitted baseline: where the screen told another body, by that, since a body that rests for
    /// most of a record seems held by its own weight; where the guess had a far heavier one, by the fit, since a
    /// resonance turns a body against its input and tells a regression nothing.
    pub fn settle_sizes(&mut self, fit: &Fit) {
        if self.kind() != Kind::Drive || !fit.structure.effects.is_empty() {
            return;
        }
        let (inertia, viscous) = self.data.baseline.body(&fit.values);
        let other = |body: &[f64; 2]| far_apart(body[0], inertia);
        if let Some(body) = self.screened_body.filter(other) {
            self.scales = self.whole().scales(body[0], body[1]);
        } else if self.scales.inertia > FAR_HEAVIER * inertia {
            self.scales = self.whole().scales(inertia, viscous);
        }
    }

    /// Score of the baseline, or of `scored` if there is none yet.
    pub fn first<'a>(&'a self, scored: &'a Scored) -> &'a Score {
        self.baseline.as_ref().unwrap_or(&scored.score)
    }

    /// The whole record.
    pub fn whole(&self) -> &Data {
        self.full.as_ref().unwrap_or(&self.data)
    }

    /// The fit carried over to the whole record.
    pub fn completed(&self, scored: &Scored) -> Scored {
        let Some(full) = &self.full else {
            return scored.clone();
        };
        let mut starts = full.guessed_starts();
        for known in &scored.fit.starts {
            if let Ok(at) = starts.binary_search_by_key(&known.sample, |s| s.sample) {
                starts[at] = *known;
            }
        }
        let (structure, values) = (scored.fit.structure.clone(), scored.fit.values.clone());
        let mut fit = Fit::new(full, structure, values, starts, &self.scales);
        fit.polish_starts(full, &self.scales);
        for _ in 0..WHOLE_ITERATIONS {
            fit.iterate(full, &self.scales);
        }
        fit.polish_starts(full, &self.scales);
        fit.mend_odd_windows(full, &self.scales);
        let score = score(full, &fit);
        Scored { fit, score }
    }

    /// Tries starting points where something of what `fit` leaves is seen.
    pub fn look_where_left(&mut self, fit: &Fit) {
        self.scout = self
            .data
            .scout_seeing(&fitted_costs(&self.data, &fit.motion));
    }

    /// Cost of `fit` on the scout.
    pub fn scouted(&self, fit: &Fit) -> f64 {
        let starts = fit
            .starts
            .iter()
            .copied()
            .filter(|s| self.scout.windows.binary_search(&s.sample).is_ok())
            .collect();
        let (structure, values) = (fit.structure.clone(), fit.values.clone());
        Fit::new(&self.scout, structure, values, starts, &self.scales).cost
    }

    pub fn kind(&self) -> Kind {
        self.data.kind
    }

    pub fn scored(&self, fit: Fit) -> Scored {
        let score = score(&self.data, &fit);
        Scored { fit, score }
    }

    /// Whether the effect at this place of a fit only tells how the record was made.
    pub fn tells_of_record(&self, fit: &Fit, place: usize) -> bool {
        fit.structure.effects.get(place).is_some_and(|effect| {
            let values = &fit.values[fit.structure.range(place)];
            let model = fit.structure.model(&fit.values);
            let step = self.data.excitation.mean_step();
            effect.is_of_record()
                || effect.is_between_samples(values, &model, step)
                || self.is_within_levels(fit, place)
        })
    }

    /// Whether the effect at a place of a fit is no more than what the levels of a noisy input are not known to.
    fn is_within_levels(&self, fit: &Fit, place: usize) -> bool {
        let error = self.levelled.as_ref().map(|found| found.level_error);
        let sizes = self.sizes(fit, place).zip(error);
        sizes.is_some_and(|(mut sizes, error)| {
            sizes.all(|size| size < CHANCE * error / self.scales.of(Dimension::Force))
        })
    }

    /// Whether the effect at a place of a fit is more than a trifle of the input: where a motion is unstable, its least
    /// disturbance grows until it is seen, and an asymmetry of the last digits of a record seems to explain it.
    pub fn is_sizeable(&self, fit: &Fit, place: usize) -> bool {
        // Friction may be all in what it takes to start.
        let sizes = self.sizes(fit, place);
        sizes.is_none_or(|mut sizes| sizes.any(|size| size >= TRIFLE))
    }

    /// The forces of an effect and its shares of the input, as shares of what is typical; `None` where it is first of
    /// all something else: it may bring a force that is 0, such as the friction of a load.
    fn sizes(&self, fit: &Fit, place: usize) -> Option<impl Iterator<Item = f64>> {
        let structure = &fit.structure;
        let specs = structure.effects.get(place)?.parameters();
        let is_force = |spec: &ParameterSpec| {
            spec.dimension == Dimension::Force
                || (spec.dimension, spec.range) == (Dimension::Ratio, Range::Fraction)
        };
        specs.first().filter(|spec| is_force(spec))?;
        let values = &fit.values[structure.range(place)];
        let forces = specs
            .iter()
            .zip(values)
            .filter(move |(spec, _)| is_force(spec));
        Some(forces.map(|(spec, size)| size.abs() / self.scales.of(spec.dimension)))
    }

    /// What a fit of the whole record leaves.
    pub fn rest(&self, scored: &Scored) -> Rest {
        let remembers =
            || is_noise_with_memory(self.whole(), &scored.fit.motion, self.output_unit());
        let small = small_share(&scored.fit);
        if self.is_too_heavy(&scored.fit) || self.data.wander > 0.0 {
            Rest::More
        } else if is_noise(&scored.score, self.first(scored), small) {
            Rest::Noise
        } else if scored.score.error < MOST_REMEMBERED && remembers() {
            Rest::NoiseWithMemory
        } else if self.is_left_by_random_forces(scored) {
            Rest::RandomForces
        } else {
            Rest::More
        }
    }

    /// Whether all that the input gave in the whole record could not have brought a body as heavy as that of a fit to
    /// its usual speed: such a model explains a motion by where its windows begin, and nothing by the input.
    fn is_too_heavy(&self, fit: &Fit) -> bool {
        if self.kind() != Kind::Drive {
            return false;
        }
        let (scales, input) = (&self.scales, &self.whole().input);
        let mean = input.iter().map(|u| u.abs()).sum::<f64>() / input.len() as f64;
        fit.values[0] * scales.speed > mean * scales.duration
    }

    /// Whether small random forces leave what a fit of the whole record leaves.
    fn is_left_by_random_forces(&self, scored: &Scored) -> bool {
        let (data, fit) = (self.whole(), &scored.fit);
        let error = scored.score.error;
        let levels = self.levelled.as_ref().map_or(0.0, |l| l.unknown);
        let by_input = || left_by_input(data, levels, &fit.structure.model(&fit.values));
        let probe = || self.probe_of(data, fit);
        is_left_by_random_forces(data, &fit.motion, error, by_input, probe)
    }
}
