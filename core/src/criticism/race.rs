//! Many effects tried side by side on top of one model: only those that may win are fitted to the end.

use super::fit::Fit;
use super::score::score;
use super::search::{Ground, Search};
use super::select::is_plain_noise;
use super::session::Session;
use crate::effect::{Effect, Probe};

/// Iterations on the whole record that every effect gets.
const HEAT: usize = 2;

/// An effect is fitted to the end while it may come this close to the best cost.
const CLOSE: f64 = 1.03;

/// The same for a part of the effect that it stands in for, or of the best one: it may do though it does a little
/// worse, and whether it does is seen at the end of its fit only.
const PART_CLOSE: f64 = 1.4;

/// Share of the present cost below which an effect must hope to come, or it is not fitted to the end:
/// a fall of the error by less than 3 % does not count.
const WORTHWHILE: f64 = 0.94;

/// Share of the present cost on the scout below which a starting point must come to be followed.
const PROMISING: f64 = 0.995;

/// The same in the place of another effect, in times of the cost with that one: what first has to come back
/// to where that was may still have some way to go.
const WITHIN_REACH: f64 = 30.0;

/// What the effects in a race are added to.
struct Track {
    fit: Fit,
    /// The fit whose effect at this place they stand in for.
    instead: Option<(Fit, usize)>,
    probe: Probe,
    ground: Ground,
}

/// One effect in the race.
struct Contender {
    effect: &'static dyn Effect,
    /// None before it has begun.
    search: Option<Search>,
    /// It is fitted to the end while it may come this close to the best cost.
    close: f64,
    heats: usize,
    /// It has had its heats.
    over: bool,
}

impl Contender {
    /// Begins, tries a starting point or does an iteration.
    fn advance(&mut self, track: &Track, session: &Session) {
        let Session {
            data,
            scout,
            scales,
            ..
        } = session;
        let search = self.search.get_or_insert_with(|| {
            let instead = track.instead.as_ref().map(|(fit, place)| (fit, *place));
            let (fit, probe, ground) = (&track.fit, &track.probe, Some(track.ground));
            Search::adding(data, fit, self.effect, probe, instead, ground)
        });
        if !search.scan(data, scout, scales) {
            self.heats += 1;
            self.over = !search.iterate(data, scales) || self.heats >= HEAT;
        }
    }

    /// Least cost so far.
    fn cost(&self) -> f64 {
        self.search.as_ref().map_or(f64::INFINITY, Search::cost)
    }
}

/// A piece of a computation that is independent of others handed out with it: they may be done in any order,
/// also at the same time, and the result is the same to the last digit.
pub struct Piece<'a> {
    contender: &'a mut Contender,
    track: &'a Track,
    session: &'a Session,
}

impl Piece<'_> {
    /// Does it; once.
    pub fn run(&mut self) {
        self.contender.advance(self.track, self.session);
    }
}

/// Does pieces one after the other.
pub(super) fn one_by_one(pieces: &mut [Piece<'_>]) {
    for piece in pieces {
        piece.run();
    }
}

/// Whether the effect at this place of a fit contains `part`.
fn contains(whole: &Fit, place: usize, part: &dyn Effect) -> bool {
    let effect = whole.structure.effects.get(place);
    effect.is_some_and(|e| e.contains().contains(&part.id()))
}

/// A race that goes on piece by piece.
pub(super) struct Race {
    track: Track,
    contenders: Vec<Contender>,
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
            track: Track {
                fit: fit.clone(),
                instead: instead.map(|(whole, place)| (whole.clone(), place)),
                probe: session.probe(fit),
                ground,
            },
            contenders: effects
                .into_iter()
                .map(|effect| Contender {
                    effect,
                    search: None,
                    close: match instead {
                        Some((whole, place)) if contains(whole, place, effect) => PART_CLOSE,
                        _ => CLOSE,
                    },
                    heats: 0,
                    over: false,
                })
                .collect(),
            target: instead.map_or(f64::INFINITY, |(whole, _)| whole.cost),
            ceiling: match instead {
                Some(_) => f64::INFINITY,
                None => WORTHWHILE * fit.cost,
            },
        }
    }

    /// Share done, 0 to 1, roughly, and the name of the effect that is tried.
    pub fn progress(&self) -> (f64, &'static str) {
        let count = self.contenders.len().max(1) as f64;
        let scanned = |c: &Contender| c.search.as_ref().map_or(0.0, Search::scanned);
        let done: f64 = self
            .contenders
            .iter()
            .map(|c| if c.over { 1.0 } else { scanned(c) })
            .sum();
        match self.contenders.iter().find(|c| !c.over) {
            Some(c) => (0.7 * done / count, c.effect.name()),
            None => (0.8, "the best of them"),
        }
    }

    /// Some work, at most `width` pieces at a time given to `run`; false when the race is over.
    pub fn advance(
        &mut self,
        session: &Session,
        width: usize,
        run: &mut dyn FnMut(&mut [Piece<'_>]),
    ) -> bool {
        let mut pieces: Vec<Piece<'_>> = self
            .contenders
            .iter_mut()
            .filter(|c| !c.over)
            .take(width.max(1))
            .map(|contender| Piece {
                contender,
                track: &self.track,
                session,
            })
            .collect();
        if !pieces.is_empty() {
            run(&mut pieces);
            return true;
        }
        let leader = self
            .contenders
            .iter()
            .min_by(|a, b| a.cost().total_cmp(&b.cost()));
        let best = leader.map_or(self.target, |c| c.cost().min(self.target));
        let parts = leader.map_or(&[][..], |c| c.effect.contains());
        let ceiling = self.ceiling;
        let next = self
            .contenders
            .iter_mut()
            .filter_map(|c| {
                let part = parts.contains(&c.effect.id());
                let close = if part { PART_CLOSE } else { c.close };
                Some((close, c.search.as_mut()?))
            })
            .filter(|(close, s)| s.goes_on() && s.optimism() <= ceiling.min(close * best))
            .min_by(|a, b| a.1.optimism().total_cmp(&b.1.optimism()));
        match next {
            Some((_, search)) => {
                search.iterate(&session.data, &session.scales);
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
                let fit = c.search?.finish(&session.data, &session.scales)?;
                Some((c.effect, fit))
            })
            .collect()
    }
}
