//! Where searches begin.

use super::{Ground, Point, Search, come_on};
use crate::criticism::data::Data;
use crate::criticism::fit::Fit;
use crate::criticism::guess::guess;
use crate::criticism::probes::Probed;
use crate::criticism::structure::Structure;
use crate::effect::{Effect, Scales, baseline};
use crate::model::load_torque;

/// A regressed baseline that differs by less than this share from the present one is no new start.
const WORTH_A_START: f64 = 0.2;

/// Effects with at most this many starting values have one valley.
const FEW_STARTS: usize = 1;

/// Shares of every window from which a point is grown.
const GROWING: [f64; 4] = [0.1, 0.2, 0.4, 0.7];

/// Share of the inertia of body and joined load that the body has at least.
const LEAST_ALONE: f64 = 0.1;

impl Search {
    /// Adds `effect` to a fitted model; starts from its own values and from a fresh regression of
    /// the baseline, since a missing effect may have bent the baseline far off. What it contains, or
    /// what it stands in for (a fit and the place in it), lends it the values that both have.
    pub fn adding(
        data: &Data,
        fit: &Fit,
        effect: &'static dyn Effect,
        probed: &Probed,
        instead: Option<(&Fit, usize)>,
        ground: Option<Ground>,
        scales: &Scales,
    ) -> Self {
        let settled = ground.is_some_and(|g| g.settled);
        let (rest, kept) = fit.structure.without_contained(effect, &fit.values);
        let structure = rest.with(effect);
        let share = ground.map_or(1.0, |g| g.share);
        let with_body = if settled {
            Vec::new()
        } else {
            probed.starts_with_body(effect, share)
        };
        let mut own = probed.starts(effect, share);
        if own.is_empty() {
            // The body may as well be the present one.
            own = with_body.iter().map(|start| start.1.clone()).collect();
        }
        let mut points = Vec::new();
        let related =
            |other: &dyn Effect| other.has_part(effect.id()) || same_dimensions(effect, other);
        let contained = (0..fit.structure.effects.len())
            .filter(|i| effect.has_part(fit.structure.effects[*i].id()))
            .map(|index| (fit, index));
        let replaced = instead.filter(|(from, index)| related(from.structure.effects[*index]));
        let relatives = contained.chain(replaced);
        for (from, index) in relatives {
            let other = from.structure.effects[index];
            let mut rest = from.values.clone();
            let lent: Vec<f64> = rest.drain(from.structure.range(index)).collect();
            if rest.len() != kept.len() {
                continue;
            }
            for mut start in own.iter().cloned() {
                lend(effect, &mut start, other, &lent);
                let mut values = rest.clone();
                values.extend(start);
                points.push((values, from.starts.clone()));
                if same_dimensions(effect, other) {
                    break;
                }
            }
        }
        // What can stand in for another effect speaks of the same body, and of the same other effects.
        let (body, at) = match instead {
            Some((from, index)) => {
                let mut rest = from.values.clone();
                rest.drain(from.structure.range(index));
                (rest, from)
            }
            None => (kept.clone(), fit),
        };
        let (body, at) = if body.len() == kept.len() {
            (&body, at)
        } else {
            (&kept, fit)
        };
        for start in &own {
            let mut values = body.clone();
            values.extend(start);
            structure.begin(&mut values, kept.len());
            points.push((values.clone(), at.starts.clone()));
            if !settled {
                points.extend(Self::regressed(data, fit, &structure, values));
            }
        }
        if !settled {
            for start in effect.starts_undamped(&probed.probe) {
                let mut values = body.clone();
                values[baseline::DAMPING] = 0.0;
                values.extend(start);
                structure.begin(&mut values, kept.len());
                points.push((values, at.starts.clone()));
            }
            for (own, start) in with_body {
                let mut values = kept.clone();
                values[..own.len()].copy_from_slice(&own);
                values.extend(start);
                structure.begin(&mut values, kept.len());
                let point = (values, data.guessed_starts());
                points.extend(Self::grown(data, &structure, &point, scales));
                points.push(point);
            }
            points.extend(Self::other_valleys(
                data, fit, &rest, &kept, &structure, &own, probed,
            ));
        }
        Self {
            limit: ground.map_or(f64::INFINITY, |g| g.limit),
            reach: ground.map_or(f64::INFINITY, |g| g.reach),
            settled,
            retries: ground.is_some() && instead.is_none() && !settled,
            ..Self::from_points(structure, points, fit.cost)
        }
    }

    /// The same point with the baseline regressed anew, if that is somewhere else.
    fn regressed(
        data: &Data,
        fit: &Fit,
        structure: &Structure,
        mut values: Vec<f64>,
    ) -> Option<Point> {
        let model = structure.model(&values);
        if let Some(load) = model.load.filter(|_| model.friction.level > 0.0) {
            // A regression without dry friction knows the body less well than the fit, which took the load for a part of it.
            let alone = fit.values[0] - load.inertia;
            let joined = load.coupling.half_gap == 0.0 && alone > LEAST_ALONE * fit.values[0];
            values[0] = alone;
            return joined.then(|| (values, fit.starts.clone()));
        }
        let mut acting = data.excitation.effective_input(&model);
        if let Some(load) = &model.load {
            // What a load takes does not move the body.
            let (position, spans) = (data.excitation.followed(), data.spans());
            let torque = load_torque(load, position, data.excitation.mean_step(), &spans);
            for (input, torque) in acting.iter_mut().zip(torque) {
                *input -= torque;
            }
        }
        let guess = guess(data, &acting)?;
        let far = guess
            .iter()
            .zip(&fit.values)
            .any(|(g, v)| (g - v).abs() > WORTH_A_START * v.abs());
        values[..guess.len()].copy_from_slice(&guess);
        structure.hold(&mut values);
        far.then(|| (values, data.guessed_starts()))
    }

    /// A point to which the first part of every window leads, then more and more of it, where a force depends on the
    /// position: a body that comes to the wrong side of a hill goes quite another way from there, so that whole windows
    /// tell little of values that are a little off.
    fn grown(
        data: &Data,
        structure: &Structure,
        (values, starts): &Point,
        scales: &Scales,
    ) -> Option<Point> {
        if structure.model(values).is_same_everywhere() {
            return None;
        }
        let (mut values, mut starts) = (values.clone(), starts.clone());
        for share in GROWING {
            let part = data.beginning(share);
            let mut fit = Fit::new(&part, structure.clone(), values, starts, scales);
            come_on(&mut fit, &part, scales, 0.0);
            (values, starts) = (fit.values, fit.starts);
        }
        Some((values, starts))
    }

    /// An effect found while another one was missing may sit in a wrong valley: its own starting
    /// values are tried again together with the new effect.
    fn other_valleys(
        data: &Data,
        fit: &Fit,
        rest: &Structure,
        kept: &[f64],
        structure: &Structure,
        own: &[Vec<f64>],
        probed: &Probed,
    ) -> Vec<Point> {
        let mut points = Vec::new();
        if own.len() > FEW_STARTS {
            return points;
        }
        for (index, present) in rest.effects.iter().enumerate() {
            if present.parameters().len() > 1 {
                continue;
            }
            let starts = probed.starts(*present, 1.0);
            if starts.len() <= FEW_STARTS {
                continue;
            }
            for start in own {
                for other in &starts {
                    let mut values = kept.to_vec();
                    values[rest.range(index)].copy_from_slice(other);
                    values.extend(start);
                    points.extend(Self::regressed(data, fit, structure, values));
                }
            }
        }
        points
    }

    /// Refits without the effect at `index`.
    pub fn removing(fit: &Fit, index: usize) -> Self {
        let mut values = fit.values.clone();
        values.drain(fit.structure.range(index));
        Self::from_points(
            fit.structure.without(index),
            vec![(values, fit.starts.clone())],
            f64::INFINITY,
        )
    }

    /// Refits the structure of `fit` from the values and states of another fit that has more: where that came from
    /// a better valley, the effect that it adds is not what made it better.
    pub fn revisiting(fit: &Fit, from: &Fit) -> Self {
        let structure = fit.structure.clone();
        let mut values = fit.values.clone();
        let body = structure.baseline_len();
        values[..body].copy_from_slice(&from.values[..body]);
        for (index, effect) in structure.effects.iter().enumerate() {
            let own = &mut values[structure.range(index)];
            for (place, other) in from.structure.effects.iter().enumerate() {
                let lent = &from.values[from.structure.range(place)];
                if other.id() == effect.id() {
                    own.copy_from_slice(lent);
                } else if other.has_part(effect.id()) {
                    lend(*effect, own, *other, lent);
                }
            }
        }
        let points = vec![(values, from.starts.clone())];
        Self::from_points(structure, points, f64::INFINITY)
    }
}

/// Whether two effects have the same kind of parameters: two lags, say, which may do the same.
fn same_dimensions(a: &dyn Effect, b: &dyn Effect) -> bool {
    let dimensions = |e: &dyn Effect| e.parameters().iter().map(|p| p.dimension);
    dimensions(a).eq(dimensions(b)) && a.id() != b.id()
}

/// Gives `start` of one effect the values of another for the parameters that both have.
fn lend(effect: &dyn Effect, start: &mut [f64], other: &dyn Effect, lent: &[f64]) {
    if same_dimensions(effect, other) {
        start.copy_from_slice(lent);
    }
    for (value, spec) in start.iter_mut().zip(effect.parameters()) {
        let same = other.parameters().iter().zip(lent);
        if let Some((_, known)) = same.into_iter().find(|(o, _)| o.symbol == spec.symbol) {
            *value = *known;
        }
    }
}
