//! What could explain a record? Regression on its weak form, without a simulation.
//!
//! Both sides of the equation of motion, integrated over windows with a smooth bump, are linear in the body and in the
//! atoms of all effects ([`crate::effect::Atom`]). Sums of products in blocks make all subsets of a few atoms cheap;
//! those that are as good as the best on held-back blocks, and have the fewest parameters, are a class.

mod gram;
mod input_check;
mod model;
mod prepare;
mod refine;
mod response;
mod say;
mod signals;
mod subsets;
mod tuning;
mod window;

use crate::diagnosis::Screening;
use crate::effect::{Effect, EffectId};
use crate::measurement::Measurement;
use subsets::Tried;

pub(super) use gram::{AtomColumns, Rows};
pub(super) use signals::Signals;
pub(super) use window::{Width, widths};

/// Screens a record. Linear in its samples.
pub fn screen(measurement: &Measurement) -> Screening {
    Screened::new(measurement, &[]).screening
}

/// A screened record, of which any subset of effects can be asked.
pub(super) struct Screened {
    pub screening: Screening,
    prepared: prepare::Prepared,
    /// Every subset that can be, the best first.
    tried: Vec<Tried>,
}

/// A subset of effects with the values from which it may be fitted.
#[derive(Clone)]
pub(super) struct Start {
    pub effects: Vec<&'static dyn Effect>,
    /// Inertia and viscous friction of a drive; gain, time constant and ambient of a process.
    pub body: Vec<f64>,
    /// Values of each effect.
    pub values: Vec<Vec<f64>>,
}

impl Screened {
    /// With the effects of the library and those of the user's own.
    pub fn new(measurement: &Measurement, own: &[&'static dyn Effect]) -> Self {
        let signals = signals::Signals::new(measurement);
        let widths = window::widths(&signals);
        let prepared = prepare::Prepared::new(&signals, &widths, own);
        let bench = prepared.bench();
        let mut tried = bench.all();
        let screening = say::screening(measurement, &signals, &widths, &bench, &tried);
        tried.sort_by(|a, b| a.loss().total_cmp(&b.loss()));
        Self {
            screening,
            prepared,
            tried,
        }
    }

    /// Subsets of so many effects that begin with these, the best first.
    pub fn starts<'a>(
        &'a self,
        held: &'a [EffectId],
        size: usize,
    ) -> impl Iterator<Item = Start> + 'a {
        let bench = self.prepared.bench();
        self.tried.iter().filter_map(move |tried| {
            let ids = || {
                tried
                    .members
                    .iter()
                    .map(|(c, _)| bench.choices[*c].effect.id())
            };
            let has_all = held.iter().all(|held| ids().any(|id| id == *held));
            if tried.members.len() != size || !has_all {
                return None;
            }
            let (body, values) = bench.start(&tried.members)?;
            let effects = tried.members.iter().map(|(c, _)| bench.choices[*c].effect);
            let mut own: Vec<(&'static dyn Effect, Vec<f64>)> = effects.zip(values).collect();
            own.sort_by_key(|(e, _)| {
                held.iter()
                    .position(|id| *id == e.id())
                    .unwrap_or(held.len())
            });
            let (effects, values) = own.into_iter().unzip();
            Some(Start {
                effects,
                body,
                values,
            })
        })
    }

    /// What the atoms of just these effects add to the equation of motion, with the shapes that suit the record best;
    /// none where an effect has no atom.
    pub fn columns(&self, held: &[EffectId], rows: &Rows) -> Option<Vec<AtomColumns>> {
        let bench = self.prepared.bench();
        let id = |(c, _): &(usize, usize)| bench.choices[*c].effect.id();
        let is_held = |tried: &&Tried| {
            tried.members.len() == held.len() && tried.members.iter().all(|m| held.contains(&id(m)))
        };
        let tried = self.tried.iter().find(is_held)?;
        let columns = tried.members.iter().map(|(c, s)| {
            let choice = &bench.choices[*c];
            rows.atom(&choice.atom, &choice.shapes[*s].shape)
        });
        Some(columns.collect())
    }

    /// Values of an effect beside these, as the best subset has them.
    pub fn values(&self, beside: &[EffectId], effect: EffectId) -> Option<Vec<f64>> {
        let all: Vec<EffectId> = beside.iter().copied().chain([effect]).collect();
        let start = self.starts(&all, all.len()).next()?;
        start.values.last().cloned()
    }
}
