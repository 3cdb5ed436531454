//! A model structure: which baseline, which effects, and how a vector of values becomes a model.

use super::knowledge::Knowledge;
use crate::effect::baseline::Baseline;
use crate::effect::{Effect, EffectId, Range, Scales};
use crate::model::{LoadBegin, Model};
use crate::user_model::{Known, Status};

/// Share of a parameter, or of its typical size, by which it is moved for a sensitivity: the motion is exact, so that
/// the difference is the derivative to some six digits.
const RELATIVE_STEP: f64 = 1e-6;

/// Share of the typical size that stands in for a parameter near 0.
const ZERO_SHARE: f64 = 0.01;

/// Largest change of a size, such as inertia, time constant or stiffness, in one step of a fit.
const STEP_FACTOR: f64 = 4.0;

/// Baseline and effects; the order of the values is baseline first, then effect by effect.
#[derive(Clone)]
pub(super) struct Structure {
    pub baseline: Baseline,
    pub effects: Vec<&'static dyn Effect>,
    pub knowledge: Knowledge,
    /// Where a load behind a gap begins in the windows.
    pub load_begin: LoadBegin,
}

impl Structure {
    pub fn new(
        baseline: Baseline,
        effects: Vec<&'static dyn Effect>,
        knowledge: Knowledge,
    ) -> Self {
        Self {
            baseline,
            effects,
            knowledge,
            load_begin: LoadBegin::Followed,
        }
    }

    /// The same with one more effect.
    pub fn with(&self, effect: &'static dyn Effect) -> Self {
        let mut next = self.clone();
        next.effects.push(effect);
        next.load_begin = LoadBegin::Followed;
        next
    }

    /// The effects, in their order.
    pub fn ids(&self) -> Vec<EffectId> {
        self.effects.iter().map(|e| e.id()).collect()
    }

    /// Number of values of the baseline.
    pub fn baseline_len(&self) -> usize {
        self.baseline.parameters().len()
    }

    /// Range of the values of the effect at `index`.
    pub fn range(&self, index: usize) -> std::ops::Range<usize> {
        let before: usize = self.effects[..index]
            .iter()
            .map(|e| e.parameters().len())
            .sum();
        let from = self.baseline_len() + before;
        from..from + self.effects[index].parameters().len()
    }

    /// Owner (`None` for the baseline) and symbol of each value.
    pub fn symbols(&self) -> Vec<(Option<EffectId>, &'static str)> {
        let baseline = self.baseline.parameters().iter();
        let mut symbols: Vec<_> = baseline.map(|p| (None, p.symbol)).collect();
        for effect in &self.effects {
            let own = effect.parameters().iter();
            symbols.extend(own.map(|p| (Some(effect.id()), p.symbol)));
        }
        symbols
    }

    /// The model with these values.
    pub fn model(&self, values: &[f64]) -> Model {
        let mut model = self.baseline.model(values);
        for (index, effect) in self.effects.iter().enumerate() {
            effect.apply(&values[self.range(index)], &mut model);
        }
        model
    }

    /// Puts values of effects and baseline that only have each other's roles in order; true if any were not. What
    /// the user said of a value stays with it.
    pub fn order(&self, values: &mut [f64]) -> bool {
        if self.known().iter().any(Option::is_some) {
            return false;
        }
        let mut swapped = false;
        for (index, effect) in self.effects.iter().enumerate() {
            let range = self.range(index);
            let (body, own) = values.split_at_mut(self.baseline_len());
            let own = &mut own[range.start - body.len()..range.end - body.len()];
            swapped |= effect.order(self.baseline.kind(), body, own);
        }
        swapped
    }

    /// Moves the values into their ranges.
    pub fn clamp(&self, values: &mut [f64], scales: &Scales) {
        self.baseline.clamp(values, scales);
        for (index, effect) in self.effects.iter().enumerate() {
            let range = self.range(index);
            for (value, spec) in values[range].iter_mut().zip(effect.parameters()) {
                *value = spec.clamp(*value, scales);
            }
        }
        for (value, known) in values.iter_mut().zip(self.known()) {
            if let Some(known) = known.filter(|k| k.status == Status::Fixed) {
                *value = known.value;
            }
        }
        self.hold(values);
    }

    /// Puts what the baseline holds in its place.
    pub fn hold(&self, values: &mut [f64]) {
        if let Some((place, value)) = self.held() {
            values[place] = value;
        }
    }

    /// The place of the baseline that is never changed, and its value, where the user says nothing of it.
    pub fn held(&self) -> Option<(usize, f64)> {
        let held = self.baseline.fixed(&self.effects)?;
        let symbol = self.baseline.parameters()[held.0].symbol;
        self.knowledge.find(None, symbol).is_none().then_some(held)
    }

    /// Whether each value is never changed.
    pub fn fixed(&self) -> Vec<bool> {
        let held = self.held().map(|(place, _)| place);
        let fixed = |k: Option<&Known>| k.is_some_and(|k| k.status == Status::Fixed);
        let known = self.known().into_iter().enumerate();
        known.map(|(j, k)| fixed(k) || held == Some(j)).collect()
    }

    /// Keeps sizes within a factor of `present`: the motion goes with their inverse or logarithm, so that
    /// a linear step from a value far too large would overshoot below 0.
    pub fn limit_step(&self, values: &mut [f64], present: &[f64]) {
        let j = self.baseline.size();
        let limit = |value: &mut f64, present: f64| {
            let (a, b) = (present / STEP_FACTOR, present * STEP_FACTOR);
            *value = value.max(a.min(b)).min(a.max(b));
        };
        limit(&mut values[j], present[j]);
        for (index, effect) in self.effects.iter().enumerate() {
            for (j, spec) in self.range(index).zip(effect.parameters()) {
                if spec.is_size() && present[j] > 0.0 {
                    limit(&mut values[j], present[j]);
                }
                // Where the input jumps, its derivative tells nothing of what is farther off.
                if spec.range == Range::Late && present[j] > 0.0 {
                    values[j] = values[j].min(STEP_FACTOR * present[j]);
                }
            }
        }
    }

    /// Steps for finite differences, one per value, pointing into the ranges.
    pub fn difference_steps(&self, values: &[f64], scales: &Scales) -> Vec<f64> {
        let mut sizes: Vec<f64> = self
            .baseline
            .parameters()
            .iter()
            .zip(values)
            .map(|(p, v)| {
                let fallback = p.dimension.map_or(v.abs(), |d| match d {
                    crate::effect::Dimension::Time => scales.time_constant,
                    d => scales.of(d),
                });
                v.abs().max(ZERO_SHARE * fallback)
            })
            .collect();
        for (index, effect) in self.effects.iter().enumerate() {
            for (value, spec) in values[self.range(index)].iter().zip(effect.parameters()) {
                sizes.push(value.abs().max(ZERO_SHARE * scales.of(spec.dimension)));
            }
        }
        let mut steps: Vec<f64> = sizes.iter().map(|s| RELATIVE_STEP * s).collect();
        for (j, step) in steps.iter_mut().enumerate() {
            let mut moved = values.to_vec();
            moved[j] += *step;
            let wanted = moved[j];
            self.clamp(&mut moved, scales);
            if moved[j] != wanted {
                *step = -*step;
            }
        }
        steps
    }
}
