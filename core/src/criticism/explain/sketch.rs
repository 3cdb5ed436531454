//! A model with values from which it may be fitted.

use super::hidden_body::{hidden_inertia, is_hidden_body};
use super::tuning::{CROSSINGS, SAME_BODY, SETTLED, SETTLING};
use crate::criticism::data::Data;
use crate::criticism::fit::Fit;
use crate::criticism::guess::guess;
use crate::criticism::screen::{Screened, Start};
use crate::criticism::session::Session;
use crate::criticism::structure::Structure;
use crate::effect::baseline::Baseline;
use crate::effect::{Effect, EffectId, Range, Scales};
use crate::model::Start as WindowStart;

/// A model with values from which it may be fitted.
#[derive(Clone)]
pub(super) struct Sketch {
    structure: Structure,
    values: Vec<f64>,
    /// States from which windows began in the fit that it comes from.
    known: Vec<WindowStart>,
}

impl Sketch {
    /// The baseline with these effects, and values of both in order.
    pub fn new(session: &Session, effects: &[&'static dyn Effect], mut values: Vec<f64>) -> Self {
        let structure = session.structure(effects);
        structure.begin(&mut values, 0);
        Self {
            structure,
            values,
            known: Vec::new(),
        }
    }

    /// A subset with the values that the screen told; none where an effect is not in the library.
    pub fn of(session: &Session, start: &Start) -> Option<Self> {
        let effects: Option<Vec<_>> = start.effects.iter().map(|e| session.find(e.id())).collect();
        let mut values = match session.data.baseline {
            Baseline::Integrator => vec![start.body.first()? / start.body.get(1)?],
            Baseline::Drive | Baseline::Lag { .. } => start.body.clone(),
        };
        values.extend(start.values.iter().flatten());
        Some(Self::new(session, &effects?, values))
    }

    /// A fit with one more effect that has these values.
    pub fn with(fit: &Fit, effect: &'static dyn Effect, own: &[f64]) -> Self {
        let structure = fit.structure.with(effect);
        let mut values = fit.values.clone();
        values.extend(own);
        structure.begin(&mut values, fit.values.len());
        Self::from(fit, structure, values)
    }

    /// A fit with another effect, which has these values, at a place.
    pub fn replacing(fit: &Fit, place: usize, effect: &'static dyn Effect, own: &[f64]) -> Self {
        let mut structure = fit.structure.clone();
        let mut values = fit.values.clone();
        values.splice(structure.range(place), own.iter().copied());
        structure.effects[place] = effect;
        structure.load_begin = crate::model::LoadBegin::Followed;
        structure.begin(&mut values, structure.range(place).start);
        Self::from(fit, structure, values)
    }

    /// Another model that begins where a fit did.
    fn from(fit: &Fit, structure: Structure, values: Vec<f64>) -> Self {
        let known = fit.starts.clone();
        Self {
            structure,
            values,
            known,
        }
    }

    /// The same with a body of its own.
    pub fn with_body(fit: &Fit, effect: &'static dyn Effect, body: [f64; 2], own: &[f64]) -> Self {
        let mut sketch = Self::with(fit, effect, own);
        sketch.set_body(&body);
        sketch
    }

    /// A fit with one more effect, and these first values of the baseline.
    pub fn with_values(fit: &Fit, effect: &'static dyn Effect, body: &[f64], own: &[f64]) -> Self {
        let mut sketch = Self::with(fit, effect, own);
        sketch.set_body(body);
        sketch
    }

    fn set_body(&mut self, body: &[f64]) {
        self.values[..body.len()].copy_from_slice(body);
        self.structure.begin(&mut self.values, 0);
    }

    /// A fit with one more effect: with the values that the screen tells beside its effects and alone, and from where
    /// that finds itself if the screen tells none, or not all that it may be.
    pub fn beside(
        session: &Session,
        screened: &Screened,
        fit: &Fit,
        effect: &'static dyn Effect,
    ) -> Vec<Self> {
        let beside = screened.values(&fit.structure.ids(), effect.id());
        let alone = screened.values(&[], effect.id());
        let told: Vec<Vec<f64>> = beside.into_iter().chain(alone).collect();
        // What repeats along the way has a valley at every period.
        let mut specs = effect.parameters().iter();
        let repeats = specs.any(|p| matches!(p.range, Range::Repeating | Range::Recurring));
        let mut sketches = Vec::new();
        if told.is_empty() || is_hidden_body(effect) || repeats {
            sketches.extend(Self::sought(session, fit, effect));
        }
        sketches.extend(told.iter().map(|own| Self::with(fit, effect, own)));
        sketches
    }

    /// A fit with one more effect, from where that finds itself in what the fit leaves. A body that was hidden may have
    /// been taken for a part of the other.
    pub fn sought(session: &Session, fit: &Fit, effect: &'static dyn Effect) -> Vec<Self> {
        let probed = session.probed(fit);
        let own = probed.starts(effect, 1.0);
        let hidden = hidden_inertia(effect);
        let parted = own.iter().filter_map(|own| {
            let body = fit.values[0] - own[hidden?];
            (body > 0.0).then(|| Self::with_body(fit, effect, [body, fit.values[1]], own))
        });
        let parted: Vec<Self> = parted.collect();
        let own = own.iter().map(|own| Self::with(fit, effect, own));
        let with_body = probed.starts_with_body(effect, 1.0).into_iter();
        own.chain(parted)
            .chain(with_body.map(|(body, own)| Self::with_body(fit, effect, body, &own)))
            .collect()
    }

    /// Adds the same with each of these bodies where a fit ended with another one: what is missing may have bent it out
    /// of all likeness.
    pub fn with_other_bodies(
        sketches: &mut Vec<Self>,
        fit: &Fit,
        bodies: impl IntoIterator<Item = Vec<f64>>,
    ) {
        let same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_BODY * a.abs();
        let essential = fit.structure.baseline.essential();
        let is_other = |body: &Vec<f64>| !body.iter().zip(&fit.values).take(essential).all(same);
        let with_body = |sketch: &Self, body: &[f64]| {
            let mut sketch = sketch.clone();
            sketch.set_body(body);
            sketch
        };
        let others: Vec<Self> = bodies
            .into_iter()
            .filter(is_other)
            .flat_map(|body| sketches.iter().map(move |s| with_body(s, &body)))
            .collect();
        sketches.extend(others);
    }

    /// A fit from other starting points, if it has values that the screen cannot tell: it may be in a valley of its
    /// own.
    pub fn again(fit: &Fit) -> Option<Self> {
        let mut values = fit.values.clone();
        let open = displacements(&fit.structure);
        for j in &open {
            values[*j] = 0.0;
        }
        let structure = fit.structure.clone();
        (!open.is_empty()).then_some(Self::from(fit, structure, values))
    }

    /// The same with each of some values where the screen cannot tell one: how far a dry contact gives way, and how a
    /// load bounces in its gap.
    pub fn variants(self, session: &Session) -> Vec<Self> {
        let mut all = Vec::new();
        for (k, effect) in self.structure.effects.iter().enumerate() {
            let range = self.structure.range(k);
            for other in effect.other_contacts(&self.values[range.clone()], true) {
                let mut sketch = self.clone();
                sketch.values[range.clone()].copy_from_slice(&other);
                all.extend(sketch.with_displacements(session));
            }
        }
        all.extend(self.with_displacements(session));
        all
    }

    /// The same with each of some displacements over which dry contacts build up their force, where it has none.
    fn with_displacements(self, session: &Session) -> Vec<Self> {
        let mut open = displacements(&self.structure);
        open.retain(|j| self.values[*j] == 0.0);
        if open.is_empty() {
            return vec![self];
        }
        let crossed = session.scales.crossed();
        let with = |samples: f64| {
            let mut sketch = self.clone();
            for j in &open {
                sketch.values[*j] = samples * crossed;
            }
            sketch
        };
        CROSSINGS.map(with).to_vec()
    }

    /// A fit with these of its effects alone.
    pub fn part(session: &Session, fit: &Fit, ids: &[EffectId]) -> Option<Self> {
        let mut values = fit.values[..fit.structure.baseline_len()].to_vec();
        let mut effects = Vec::new();
        for id in ids {
            let place = fit.structure.effects.iter().position(|e| e.id() == *id)?;
            effects.push(fit.structure.effects[place]);
            values.extend_from_slice(&fit.values[fit.structure.range(place)]);
        }
        let known = fit.starts.clone();
        Some(Self {
            known,
            ..Self::new(session, &effects, values)
        })
    }

    pub fn effects(&self) -> &[&'static dyn Effect] {
        &self.structure.effects
    }

    /// Its fit to a record, or to a part of it, not begun: of the states that are measured and those that are known,
    /// each window takes the one that suits it.
    fn on(&self, data: &Data, scales: &Scales) -> Fit {
        let mut starts = data.guessed_starts();
        let (structure, values) = (self.structure.clone(), self.values.clone());
        let mut fit = Fit::new(data, structure, values, starts.clone(), scales);
        for start in &mut starts {
            let place = self.known.binary_search_by_key(&start.sample, |s| s.sample);
            if let Ok(place) = place {
                *start = self.known[place];
            }
        }
        if !self.known.is_empty() {
            fit.take_better(data, &starts);
        }
        fit
    }

    /// Its fit on the scout, not begun.
    pub fn begun(&self, session: &Session) -> Fit {
        self.on(&session.scout, &session.scales)
    }

    /// The model that a fit on the scout came to.
    pub fn reached(fit: Fit) -> Self {
        Self {
            structure: fit.structure,
            values: fit.values,
            known: fit.starts,
        }
    }

    /// Fitted to the whole record.
    pub fn fitted(&self, session: &Session) -> Fit {
        let (data, scales) = (&session.data, &session.scales);
        let mut fit = self.on(data, scales);
        for _ in 0..SETTLING {
            fit.finish(data, scales);
            let before = fit.cost;
            fit.polish_starts(data, scales);
            let ordered = fit.put_in_order(data, scales);
            if !ordered && fit.cost > SETTLED * before {
                break;
            }
            let Fit {
                structure,
                values,
                starts,
                ..
            } = fit;
            fit = Fit::new(data, structure, values, starts, scales);
        }
        fit.mend_odd_windows(data, scales);
        fit
    }
}

/// Places of the values of displacements over which dry contacts build up their force.
fn displacements(structure: &Structure) -> Vec<usize> {
    let effects = structure.effects.iter().enumerate();
    let all = effects.flat_map(|(k, e)| structure.range(k).zip(e.parameters()));
    let own = all.filter(|(_, spec)| matches!(spec.range, Range::Short | Range::Long));
    own.map(|(j, _)| j).collect()
}

/// The body by regression of the motion alone.
pub(super) fn first_guess(session: &Session) -> Option<Vec<f64>> {
    let plain = Baseline::plain();
    guess(
        &session.data,
        &session.data.excitation.effective_input(&plain),
    )
}
