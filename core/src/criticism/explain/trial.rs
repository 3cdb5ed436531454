//! A model fitted to either half of the blocks of a record.

use super::tuning::{OTHER_HALF, SAME_BODY};
use crate::criticism::data::Data;
use crate::criticism::fit::{Fit, residuals};
use crate::criticism::score::score;
use crate::criticism::session::{Scored, Session, TELLING};
use crate::criticism::structure::Structure;
use crate::diagnosis::LoopError;
use crate::effect::{Effect, EffectId};

/// A model fitted to either half of the blocks.
#[derive(Clone)]
pub(in crate::criticism) struct Trial {
    /// Fitted to the half that the record gives to the fit.
    pub scored: Scored,
    /// Fitted to the other half.
    other: Scored,
    /// Mean squared residual of every block by the fit that did not see it, in units of the noise.
    pub held: Vec<f64>,
    /// Its error in the relay loop that was measured; `None` where there is none.
    pub in_loop: Option<LoopError>,
}

impl Trial {
    pub fn new(session: &Session, fit: Fit) -> Self {
        let scored = session.scored(fit);
        let turned = session.data.turned();
        let Fit {
            structure,
            values,
            starts,
            ..
        } = scored.fit.clone();
        let mut fit = Fit::new(&turned, structure, values, starts, &session.scales);
        for _ in 0..OTHER_HALF {
            fit.iterate(&turned, &session.scales);
        }
        fit.polish_starts(&turned, &session.scales);
        let other = Scored {
            score: score(&turned, &fit),
            fit,
        };
        let mut halves = [
            scored.score.held_blocks.iter(),
            other.score.held_blocks.iter(),
        ];
        let held = session.data.blocks.iter().zip(&turned.blocks);
        let held = held.filter_map(|(block, turned)| {
            let half = match (block.held_back, turned.held_back) {
                (true, _) => 0,
                (false, true) => 1,
                (false, false) => return None,
            };
            Some(halves[half].next().copied().unwrap_or(f64::INFINITY))
        });
        let held = held
            .map(|m| if m.is_finite() { m } else { f64::MAX.sqrt() })
            .collect();
        let in_loop = session.relay_loop.as_ref().map(|relay_loop| {
            let fit = &scored.fit;
            relay_loop.error_of(&fit.structure.model(&fit.values))
        });
        Self {
            scored,
            other,
            held,
            in_loop,
        }
    }

    /// The fits to either half.
    pub fn halves(&self) -> impl Iterator<Item = &Scored> {
        [&self.scored, &self.other].into_iter()
    }

    /// Standard errors of the values that either half shows by what the other says, with one degree of freedom:
    /// whatever correlates the residual, or bends a fit, the halves do not share it (the jackknife of two groups;
    /// Quenouille 1956).
    pub fn spreads(&self) -> Vec<f64> {
        let pairs = self.scored.fit.values.iter().zip(&self.other.fit.values);
        pairs
            .map(|(a, b)| (a - b).abs() * std::f64::consts::FRAC_1_SQRT_2)
            .collect()
    }

    /// Whether the first value of its body is not 0, by what either half tells.
    pub fn tells_body(&self) -> bool {
        let error = self.scored.standard_errors()[0].max(self.spreads()[0]);
        self.scored.fit.values[0].abs() > TELLING * error
    }

    /// Root mean square of what is left of all blocks, in units of the noise.
    pub fn error(&self) -> f64 {
        let squares: f64 = self
            .halves()
            .map(|s| s.score.error.powi(2) * s.score.held_count)
            .sum();
        let count: f64 = self.halves().map(|s| s.score.held_count).sum();
        let error = (squares / count).sqrt();
        if error.is_finite() {
            error
        } else {
            f64::INFINITY
        }
    }

    /// What is left of the outputs of these data, in their units: the geometric mean of their root mean squares.
    pub fn left_of_outputs(&self, data: &Data) -> f64 {
        let all = residuals(data, &self.scored.fit.motion);
        let logarithms = all.iter().zip(&data.outputs).map(|(left, output)| {
            let squares: f64 = left.iter().filter(|r| r.is_finite()).map(|r| r * r).sum();
            0.5 * libm::log(squares / left.len().max(1) as f64) + libm::log(output.noise)
        });
        libm::exp(logarithms.sum::<f64>() / all.len().max(1) as f64)
    }

    /// Number of values that its effects say something with: how a dry contact builds up its force is seen of few.
    pub fn values(&self) -> usize {
        let specs = self.effects().iter().flat_map(|e| e.parameters());
        specs.filter(|spec| !spec.is_of_contact()).count()
    }

    pub fn effects(&self) -> &[&'static dyn Effect] {
        &self.scored.fit.structure.effects
    }

    pub fn ids(&self) -> Vec<EffectId> {
        self.scored.fit.structure.ids()
    }

    pub fn has(&self, id: EffectId) -> bool {
        self.effects().iter().any(|e| e.id() == id)
    }

    /// Whether two models agree on the body, which the user knows roughly.
    pub fn same_body(&self, other: &Self) -> bool {
        let essential = self.scored.fit.structure.baseline.essential();
        let pairs = self.scored.fit.values.iter().zip(&other.scored.fit.values);
        pairs
            .take(essential)
            .all(|(a, b)| (a - b).abs() <= SAME_BODY * a.abs())
    }
}

impl Session {
    /// The baseline with these effects.
    pub(super) fn structure(&self, effects: &[&'static dyn Effect]) -> Structure {
        let empty = Structure::new(self.data.baseline, Vec::new(), self.knowledge.clone());
        effects
            .iter()
            .fold(empty, |with, effect| with.with(*effect))
    }
}
