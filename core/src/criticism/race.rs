//! Many effects tried side by side on top of one model: only those that may win are fitted to the end.

use std::sync::Arc;

use super::fit::Fit;
use super::probes::Probed;
use super::score::score;
use super::search::{Ground, Search};
use super::select::is_plain_noise;
use super::session::Session;
use crate::effect::Effect;
use crate::model::Load;

/// After its first iteration on the whole record, an effect gets another one if it is hoped to come within this many
/// times the best cost.
const IN_SIGHT: f64 = 6.0;

/// An effect is fitted to the end while it may come this close to the best cost.
const CLOSE: f64 = 1.03;

/// The same for a part of the effect that it stands in for, or of the best one: it may do though it does a little
/// worse, and whether it does is seen at the end of its fit only.
const PART_CLOSE: f64 = 1.4;

/// An effect that costs this many times the best does not speak for what contains it: if it is needed, it is found by
/// itself later, and widened then.
const FAR: f64 = 10.0;

/// Share of the present cost above which an effect comes to nothing.
const NOTHING: f64 = 0.98;

/// Share of the present cost below which an effect must hope to come, or it is not fitted to the end:
/// a fall of the error by less than 3 % does not count.
const WORTHWHILE: f64 = 0.94;

/// Share of the present cost on the scout below which a starting point must come to be followed.
const PROMISING: f64 = 0.995;

/// The same where the model leaves nothing but noise: less is found there by chance, where many values are tried.
const PROMISING_IN_NOISE: f64 = 0.985;

/// A force is looked for with care where it may leave this many times the share of the squared error above which the first
/// iteration is not followed.
const LINEAR: f64 = 1.5;

/// The same in the place of another effect, in times of the cost with that one: what first has to come back
/// to where that was may still have some way to go.
const WITHIN_REACH: f64 = 30.0;

/// A point from which the first iteration does not lead to within this many times the cost that it must come
/// to is not followed where the model leaves nothing but noise: what is missing there must be faint.
const FAR_OFF: f64 = 2.0;

/// What stands in for another effect does at least this share of what that does, in squared residuals, after the first
/// iteration: where it begins is regressed.
const FIRST_SHARE: f64 = 0.9;

/// Where that effect does not do much, the same after the first iteration in shares of what it does.
const HALFWAY: f64 = 0.3;

/// Parameters of an effect up to which it is tried before those with more, group by group: those that take long need
/// not be followed where a simple one explains nearly all.
const GROUPS: [usize; 2] = [1, 3];

/// Starting points of an effect that are tried without waiting for others.
const SCANNED_AT_ONCE: usize = 8;

/// The first iteration of an effect must come to within this many times what simpler ones have come to on the scout:
/// what explains so much less is looked for again when that is in the model.
const OUTSHONE: f64 = 8.0;

/// What the effects in a race are added to.
struct Track {
    fit: Fit,
    /// Its cost on the scout.
    present: f64,
    /// The fit whose effect at this place they stand in for.
    instead: Option<(Fit, usize)>,
    probed: Arc<Probed>,
    ground: Ground,
}

/// How far an effect has come.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// Its starting points are tried on the scout.
    Scan,
    /// It is to get an iteration on the whole record.
    FirstHeat,
    /// It has had that, and is to be compared with the others.
    Warm,
    /// It is to get another one.
    SecondHeat,
    /// It has had its heats; its result is not taken yet.
    Over,
    /// Nothing more is done.
    Closed,
}

/// One effect in the race.
struct Contender {
    effect: &'static dyn Effect,
    /// None before it has begun.
    search: Option<Search>,
    /// It is fitted to the end while it may come this close to the best cost.
    close: f64,
    stage: Stage,
    /// What it came to.
    result: Option<Fit>,
    /// That leaves nothing but noise.
    explains: bool,
}

impl Contender {
    /// Begins, tries some starting points, does an iteration, or after all that takes the result.
    fn advance(&mut self, track: &Track, session: &Session) {
        let Session {
            data,
            scout,
            scales,
            ..
        } = session;
        if self.stage == Stage::Scan {
            let search = self.search.get_or_insert_with(|| {
                let instead = track.instead.as_ref().map(|(fit, place)| (fit, *place));
                let (fit, probed, ground) = (&track.fit, &track.probed, Some(track.ground));
                Search::adding(data, fit, self.effect, probed, instead, ground, scales)
            });
            if (0..SCANNED_AT_ONCE).any(|_| !search.scan(data, scout, scales)) {
                self.stage = Stage::FirstHeat;
            }
            return;
        }
        self.stage = match (self.stage, &mut self.search) {
            (Stage::FirstHeat | Stage::SecondHeat, Some(search)) => {
                if !search.iterate(data, scales) {
                    self.take_result(track, session);
                    return;
                }
                if self.stage == Stage::FirstHeat {
                    Stage::Warm
                } else {
                    Stage::Over
                }
            }
            _ => return self.take_result(track, session),
        };
    }

    /// Number of its group by its parameters.
    fn group(&self) -> usize {
        GROUPS.partition_point(|most| *most < self.effect.parameters().len())
    }

    /// Whether it has had its heats.
    fn over(&self) -> bool {
        matches!(self.stage, Stage::Over | Stage::Closed)
    }

    /// Cost that it could come to.
    fn optimism(&self) -> f64 {
        let search = self.search.as_ref();
        search.map_or(f64::INFINITY, Search::optimism)
    }

    /// Least cost so far.
    fn cost(&self) -> f64 {
        self.search.as_ref().map_or(f64::INFINITY, Search::cost)
    }

    /// Another iteration, of those that may win.
    fn go_on(&mut self, track: &Track, session: &Session) {
        let (data, scales) = (&session.data, &session.scales);
        if let Some(search) = &mut self.search
            && !search.iterate(data, scales)
        {
            self.take_result(track, session);
        }
    }

    /// Takes what it has come to, and sees whether that leaves nothing but noise.
    fn take_result(&mut self, track: &Track, session: &Session) {
        let search = self.search.as_ref();
        let result = search.and_then(|s| s.finish(&session.data, &session.scales));
        // A spring to the ground is none of the effects, though a joint whose load cannot be moved is like one.
        self.result = result
            .filter(|fit| !tied_to_ground(fit, session) || tied_to_ground(&track.fit, session));
        let plain = |fit: &Fit| is_plain_noise(&score(&session.data, fit));
        self.explains = self.result.as_ref().is_some_and(plain);
        self.stage = Stage::Closed;
    }
}

/// Whether a fit holds the body to the ground, by a joint with a load that does not move; what is met behind a gap that is
/// seen may well be a wall.
fn tied_to_ground(fit: &Fit, session: &Session) -> bool {
    let load = fit.structure.model(&fit.values).load;
    let still = |load: Load| load.is_still(fit.values[0], session.scales.duration);
    load.is_some_and(still) && !fit.shows_gap()
}

/// Whether the effect at this place of a fit contains `part`.
fn contains(whole: &Fit, place: usize, part: &dyn Effect) -> bool {
    let effect = whole.structure.effects.get(place);
    effect.is_some_and(|e| e.has_part(part.id()))
}

/// A race that goes on piece by piece.
pub(super) struct Race {
    track: Track,
    contenders: Vec<Contender>,
    /// Cost to come close to; infinite where the best of the race sets it.
    target: f64,
    /// Cost above which it is not worth going on.
    ceiling: f64,
    /// Effects up to this group may begin.
    group: usize,
    /// Effects that have parts in the race may begin: these are fitted as far as they may win.
    parts_known: bool,
    /// The race is run, and results are taken.
    run: bool,
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
        let scouted = instead.map_or(f64::INFINITY, |(whole, _)| session.scouted(whole));
        let present = session.scouted(fit);
        let ground = if instead.is_some() {
            let limit = WITHIN_REACH * scouted;
            Ground {
                limit,
                reach: limit
                    .min(scouted + HALFWAY * (present - scouted))
                    .max((1.0 - FIRST_SHARE) * present),
                share: 1.0,
                settled: false,
            }
        } else {
            let settled = is_plain_noise(&score(&session.data, fit));
            let promising = if settled {
                PROMISING_IN_NOISE
            } else {
                PROMISING
            };
            let limit = promising * present;
            Ground {
                limit,
                reach: if settled {
                    FAR_OFF * limit
                } else {
                    f64::INFINITY
                },
                share: 1.0,
                settled,
            }
        };
        Self {
            track: Track {
                fit: fit.clone(),
                present,
                instead: instead.map(|(whole, place)| (whole.clone(), place)),
                probed: session.probed(fit),
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
                    stage: Stage::Scan,
                    result: None,
                    explains: false,
                })
                .collect(),
            target: instead.map_or(f64::INFINITY, |(whole, _)| whole.cost),
            ceiling: match instead {
                Some(_) => f64::INFINITY,
                None => WORTHWHILE * fit.cost,
            },
            group: 0,
            parts_known: false,
            run: false,
        }
    }

    /// Share done, 0 to 1, roughly, and the name of the effect that is tried.
    pub fn progress(&self) -> (f64, &'static str) {
        let count = self.contenders.len().max(1) as f64;
        let scanned = |c: &Contender| c.search.as_ref().map_or(0.0, Search::scanned);
        let done: f64 = self
            .contenders
            .iter()
            .map(|c| if c.over() { 1.0 } else { scanned(c) })
            .sum();
        match self.contenders.iter().find(|c| !c.over() && !self.waits(c)) {
            Some(c) => (0.7 * done / count, c.effect.name()),
            None => (0.8, "the best of them"),
        }
    }

    /// The effect that has come lowest.
    fn leader(&self) -> Option<&Contender> {
        let contenders = self.contenders.iter();
        contenders.min_by(|a, b| a.cost().total_cmp(&b.cost()))
    }

    /// Least cost, also of what they stand in for.
    fn best(&self) -> f64 {
        self.leader()
            .map_or(self.target, |c| c.cost().min(self.target))
    }

    /// Parts of an effect in the race.
    fn parts_of<'a>(&'a self, whole: &'a Contender) -> impl Iterator<Item = &'a Contender> {
        let is_part = move |c: &&Contender| whole.effect.has_part(c.effect.id());
        self.contenders.iter().filter(is_part)
    }

    /// Whether an effect waits for its parts, or for simpler ones.
    fn waits(&self, contender: &Contender) -> bool {
        contender.group() > self.group
            || !self.parts_known && self.parts_of(contender).next().is_some()
    }

    /// What those that begin now must come to, from what others have come to on the scout.
    fn raise_the_bar(&mut self) {
        let scouted = self.contenders.iter().filter_map(|c| c.search.as_ref());
        let best = scouted.map(Search::scouted).fold(f64::INFINITY, f64::min);
        let Track {
            present, ground, ..
        } = &mut self.track;
        ground.reach = ground.reach.min(OUTSHONE * best);
        ground.share = (LINEAR * ground.reach / *present).min(1.0);
    }

    /// Lets effects with more parameters begin.
    fn open_next_group(&mut self) {
        self.raise_the_bar();
        self.group += 1;
    }

    /// Whether an effect with fewer parameters, or a part of this one, leaves nothing but noise, so that it is not asked for.
    fn is_needless(&self, whole: &Contender) -> bool {
        let simpler = |c: &Contender| {
            c.effect.parameters().len() < whole.effect.parameters().len()
                || whole.effect.has_part(c.effect.id())
        };
        self.contenders.iter().any(|c| c.explains && simpler(c))
    }

    /// Effects that need one of their parts where all came to nothing and none is in the model, or that are not asked for,
    /// are over before they begin.
    fn judge_waiting(&mut self) {
        let (best, present) = (self.best(), self.track.fit.cost);
        let idle = |c: &Contender| {
            c.cost() > (FAR * best).min(NOTHING * present)
                || c.search.as_ref().is_none_or(Search::given_up)
        };
        let vain: Vec<bool> = self
            .contenders
            .iter()
            .map(|c| {
                let mut parts = self.parts_of(c).peekable();
                let widens = self.track.fit.structure.is_widened_by(c.effect);
                let needs = c.effect.needs_its_parts() && !widens;
                let vain = needs && parts.peek().is_some() && parts.all(idle);
                c.search.is_none() && (vain || self.is_needless(c))
            })
            .collect();
        for (contender, vain) in self.contenders.iter_mut().zip(vain) {
            if vain {
                contender.stage = Stage::Over;
            }
        }
    }

    /// What all do before any goes on: their scans, then a heat, then another.
    fn together(&self) -> Option<Stage> {
        [
            Stage::Scan,
            Stage::FirstHeat,
            Stage::Warm,
            Stage::SecondHeat,
        ]
        .into_iter()
        .find(|stage| {
            let mut there = self.contenders.iter().filter(|c| c.stage == *stage);
            there.any(|c| !self.waits(c))
        })
    }

    /// Those that are warm get another heat if they are in sight of the best.
    fn compare_warm(&mut self) {
        let best = self.best();
        for c in self
            .contenders
            .iter_mut()
            .filter(|c| c.stage == Stage::Warm)
        {
            c.stage = if c.optimism() <= IN_SIGHT * best {
                Stage::SecondHeat
            } else {
                Stage::Over
            };
        }
    }

    /// Some work; false when the race is over.
    pub fn advance(&mut self, session: &Session) -> bool {
        let together = self.together();
        if together != Some(Stage::Scan) && self.group < GROUPS.len() {
            self.open_next_group();
            return true;
        }
        if together == Some(Stage::Warm) {
            self.compare_warm();
            return true;
        }
        let ready = |c: &Contender| match together {
            Some(stage) => c.stage == stage && !self.waits(c),
            None => self.run && c.stage != Stage::Closed,
        };
        let ready: Vec<bool> = self.contenders.iter().map(ready).collect();
        let crew = &session.data.crew;
        let contenders = self.contenders.iter_mut().zip(ready);
        let some = contenders.filter(|(_, ready)| *ready).take(crew.width());
        let some: Vec<&mut Contender> = some.map(|(c, _)| c).collect();
        if !some.is_empty() {
            let track = &self.track;
            crew.for_each(some, |contender| contender.advance(track, session));
            return true;
        }
        if self.run {
            return false;
        }
        let best = self.best();
        let parts = self.leader().map_or(&[][..], |c| c.effect.contains());
        let ceiling = self.ceiling;
        let next = self
            .contenders
            .iter_mut()
            .filter_map(|c| {
                let part = parts.contains(&c.effect.id());
                let close = if part { PART_CLOSE } else { c.close };
                let optimism = c.search.as_ref().filter(|s| s.goes_on())?.optimism();
                (optimism <= ceiling.min(close * best)).then_some((optimism, c))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match next {
            Some((_, contender)) => contender.go_on(&self.track, session),
            None if !self.parts_known => {
                self.parts_known = true;
                self.judge_waiting();
                self.raise_the_bar();
            }
            None => self.run = true,
        }
        true
    }

    /// Every effect that was tried, came to a cost and shows its marks, with its best fit.
    pub fn finish(self, session: &Session) -> Vec<(&'static dyn Effect, Fit)> {
        let results = self.contenders.into_iter();
        results
            .filter_map(|c| Some((c.effect, c.result?)))
            .filter(|(effect, fit)| {
                fit.cost.is_finite() && fit.shows_marks_of(*effect, &session.scales, 1.0)
            })
            .collect()
    }
}
