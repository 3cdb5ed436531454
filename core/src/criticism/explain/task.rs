//! One model to be fitted.

use super::Trial;
use super::heat::Heat;
use super::sketch::{Sketch, first_guess};
use super::tuning::{FITTED, USUAL};
use crate::criticism::fit::{Fit, least};
use crate::criticism::screen::Screened;
use crate::criticism::session::Session;
use crate::effect::{Effect, EffectId, ParameterSpec};
use crate::message::Message;
use crate::msg;

/// A model to be fitted.
#[derive(Clone)]
pub(super) enum Task {
    /// The baseline with these effects.
    Base(Vec<&'static dyn Effect>),
    /// A model from values that are known.
    Fit(Sketch),
    /// A trial without the effect at a place.
    Without { from: usize, place: usize },
}

impl Task {
    pub fn text(&self) -> Message {
        let names = |effects: &[&'static dyn Effect]| {
            let names = effects.iter().map(|e| e.name());
            msg!("Trying: {}", Message::list(", ", names))
        };
        match self {
            Self::Base(_) | Self::Without { .. } => "Fitting the model".into(),
            Self::Fit(sketch) => names(sketch.effects()),
        }
    }

    pub fn run(&self, session: &Session, screened: &Screened, trials: &[Trial]) -> Option<Trial> {
        let fit = match self {
            Self::Base(held) => base(session, screened, held)?,
            Self::Fit(sketch) => sketch.fitted(session),
            Self::Without { from, place } => {
                let fit = &trials[*from].scored.fit;
                let mut ids = fit.structure.ids();
                ids.remove(*place);
                Sketch::part(session, fit, &ids)?.fitted(session)
            }
        };
        // What the first model is too large or too small for is said of it.
        let is_base = matches!(self, Self::Base(_));
        (is_base || fit.cost.is_finite()).then(|| Trial::new(session, fit))
    }
}

/// Values of an effect of which the record tells none to begin with: a share of what is typical.
pub(super) fn usual(session: &Session, effect: &dyn Effect) -> Vec<f64> {
    let scales = &session.scales;
    let value = |p: &ParameterSpec| p.clamp(USUAL * scales.of(p.dimension), scales);
    effect.parameters().iter().map(value).collect()
}

/// The model that effects are added to: from what the screen told, and one effect after the other.
fn base(session: &Session, screened: &Screened, held: &[&'static dyn Effect]) -> Option<Fit> {
    let ids: Vec<EffectId> = held.iter().map(|e| e.id()).collect();
    let told = screened.starts(&ids, ids.len()).next();
    let told = told.and_then(|start| Sketch::of(session, &start));
    let told = told.map(|sketch| sketch.fitted(session));
    let guessed = first_guess(session).unwrap_or_else(|| session.data.baseline.unknown());
    let mut fit = Sketch::new(session, &[], guessed).fitted(session);
    for effect in held {
        let mut sketches = Sketch::beside(session, screened, &fit, *effect);
        if sketches.is_empty() {
            sketches.push(Sketch::with(&fit, *effect, &usual(session, *effect)));
        }
        Sketch::with_other_bodies(&mut sketches, &fit, first_guess(session));
        let all = sketches
            .into_iter()
            .flat_map(|sketch| sketch.variants(session));
        let mut heat = Heat::new(session, &all.collect::<Vec<_>>());
        while heat.advance(session, 0.0, 1, false) {}
        let fits = heat.best(FITTED, f64::INFINITY).into_iter();
        let fits = fits.map(|sketch| sketch.fitted(session));
        fit = least(fits)?;
    }
    let complete = |fit: &Fit| fit.structure.effects.len() == held.len();
    least(told.into_iter().chain([fit]).filter(complete))
}
