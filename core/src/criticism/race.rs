//! Many effects tried side by side on top of one model: only those that may win are fitted to the end.

use super::fit::Fit;
use super::score::score;
use super::search::{Ground, Search};
use super::select::is_plain_noise;
use super::session::Session;
use crate::effect::Effect;

/// Iterations on the whole record that every effect gets.
const HEAT: usize = 2;

/// An effect is fitted to the end while it may come this close to the best cost.
const CLOSE: f64 = 1.03;

/// The same for a part of the effect that it stands in for: it may do though it does a little worse.
const PART_CLOSE: f64 = 1.4;

/// Share of the present cost below which an effect must hope to come, or it is not fitted to the end:
/// a fall of the error by less than 3 % does not count.
const WORTHWHILE: f64 = 0.94;

/// Share of the present cost on the scout below which a starting point must come to be followed.
const PROMISING: f64 = 0.995;

/// The same in the place of another effect, in times of the cost with that one: what first has to come back
/// to where that was may still have some way to go.
const WITHIN_REACH: f64 = 30.0;

/// One effect in the race.
struct Contender {
    effect: &'static dyn Effect,
    search: Search,
    /// It is fitted to the end while it may come this close to the best cost.
    close: f64,
    heats: usize,
}

/// Whether the effect at this place of a fit contains `part`.
fn contains(whole: &Fit, place: usize, part: &dyn Effect) -> bool {
    let effect = whole.structure.effects.get(place);
    effect.is_some_and(|e| e.contains().contains(&part.id()))
}

/// A race that goes on piece by piece.
pub(super) struct Race {
    contenders: Vec<Contender>,
    /// Index of the contender that is scanned or in its heat.
    at: usize,
    /// Cost to come close to; infinite where the best of the race sets it.
    target: f64,
    /// Cost above which it is not worth going on.
    ceiling: f64,
}

impl Race {
    /// Tries each of `effects` on top of `fit`. Where they stand in for an effect of another fit (at this
    /// place in it), only those that may reach its cost are fitted to the end, otherwise those that may
    /// be the best.
    pub fn new(
        session: &Session,
        fit: &Fit,
        effects: impl IntoIterator<Item = &'static dyn Effect>,
        instead: Option<(&Fit, usize)>,
    ) -> Self {
        let target = instead.map(|(whole, _)| whole.cost);
        let probe = session.probe(fit);
        let ground = match instead {
            None => Ground {
                limit: PROMISING * session.scouted(fit),
                settled: is_plain_noise(&score(&session.data, fit)),
            },
            Some((whole, _)) => Ground {
                limit: WITHIN_REACH * session.scouted(whole),
                settled: false,
            },
        };
        Self {
            contenders: effects
                .into_iter()
                .map(|effect| Contender {
                    effect,
                    search: Search::adding(
                        &session.data,
                        fit,
                        effect,
                        &probe,
                        instead,
                        Some(ground),
                    ),
                    close: match instead {
                        Some((whole, place)) if contains(whole, place, effect) => PART_CLOSE,
                        _ => CLOSE,
                    },
                    heats: 0,
                })
                .collect(),
            at: 0,
            target: target.unwrap_or(f64::INFINITY),
            ceiling: if target.is_some() {
                f64::INFINITY
            } else {
                WORTHWHILE * fit.cost
            },
        }
    }

    /// Share done, 0 to 1, roughly, and the name of the effect that is tried.
    pub fn progress(&self) -> (f64, &'static str) {
        let count = self.contenders.len().max(1) as f64;
        match self.contenders.get(self.at) {
            Some(c) => (
                0.7 * (self.at as f64 + c.search.scanned()) / count,
                c.effect.name(),
            ),
            None => (0.8, "the best of them"),
        }
    }

    /// One iteration; false when the race is over.
    pub fn advance(&mut self, session: &Session) -> bool {
        let Session {
            data,
            scout,
            scales,
            ..
        } = session;
        if let Some(contender) = self.contenders.get_mut(self.at) {
            if !contender.search.scan(data, scout, scales) {
                contender.heats += 1;
                if !contender.search.iterate(data, scales) || contender.heats >= HEAT {
                    self.at += 1;
                }
            }
            return true;
        }
        let best = self
            .contenders
            .iter()
            .map(|c| c.search.cost())
            .fold(self.target, f64::min);
        let ceiling = self.ceiling;
        let next = self
            .contenders
            .iter_mut()
            .filter(|c| c.search.goes_on() && c.search.optimism() <= ceiling.min(c.close * best))
            .min_by(|a, b| a.search.optimism().total_cmp(&b.search.optimism()));
        match next {
            Some(contender) => {
                contender.search.iterate(data, scales);
                true
            }
            None => false,
        }
    }

    /// Every effect with its best fit.
    pub fn finish(self, session: &Session) -> Vec<(&'static dyn Effect, Fit)> {
        self.contenders
            .into_iter()
            .filter_map(|c| {
                let fit = c.search.finish(&session.data, &session.scales)?;
                Some((c.effect, fit))
            })
            .collect()
    }
}
