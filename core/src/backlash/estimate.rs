//! The gap from the motor's columns.

use crate::measurement::Measurement;
use crate::message::Message;
use crate::model::{SeenContact, SeenLoad, Sharpness, Turn};
use crate::order::{drop_marked, median, quantile, range};

use super::contacts::{FEWEST_CONTACTS, Touch, touches};
use super::cycles::{Cycles, ENOUGH_SAMPLES, NoCycles};
use super::drift::Drift;
use super::free_motor::FreeMotor;
use super::gap::{Contact, CycleDrift, GapError, GapEstimate, LoadMotion, Quality, Side, Traverse};
use super::likelihood::{self, Fit, Scales};
use super::record::Record;
use super::verdict;

/// Standard normal quantile of a two-sided 95 % interval.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Systematic error of a contact's begin where the velocity was measured, samples, and as share of how long it lasts: a
/// straight edge is found up to so much early or late at a hard, a soft, a little and a much damped contact (damping
/// ratio 0.1 to 0.6).
const PLACE: f64 = 0.1;
const PLACE_SHARE: f64 = 0.06;

/// Share of the way that the load flies during a traverse by which that may be wrong: no law of friction is right to
/// more digits.
const FLIGHT: f64 = 0.03;
/// The same in samples where the velocity was not measured.
const POSITION_PLACE: f64 = 0.5;

/// Relative standard errors up to which an estimate is good, fair, and stated at all.
const GOOD: f64 = 0.03;
const FAIR: f64 = 0.08;
const STATED: f64 = 0.25;

/// Median relative deviation of the traverses up to which they are of one gap.
const AGREE: f64 = 0.1;

/// Traverses of a good estimate.
const GOOD_TRAVERSES: usize = 3;

/// Share of the gap by which a traverse may be off before its ends are doubted.
const STRAY: f64 = 0.5;

/// Crossings of the gap within so many cycles, from how many on the load rattles, and the relative error
/// that this leaves; seen with independent rigs.
const RATTLE_CYCLES: f64 = 20.0;
const RATTLES: usize = 20;
const RATTLE_ERROR: f64 = 0.05;

/// Cycles after and before a contact that are left to it.
const MARGIN: f64 = 0.5;

/// Speed at the start, of the cycle's, up to which the motor starts at rest.
const AT_REST: f64 = 0.1;

/// The gap of a drive by a drifting test, from `u` and `x1` and/or `v1` alone; the load's columns are
/// not read. The module says how. Errors say what is wrong with the measurement; a sound one in which no
/// gap is seen gives an estimate without a gap and the reason.
pub fn estimate_gap(measurement: &Measurement) -> Result<GapEstimate, GapError> {
    look(measurement).map(|(estimate, _)| estimate)
}

/// The same with the load as its contacts show it, where a gap is stated.
pub(crate) fn sighted(
    measurement: &Measurement,
) -> Result<(GapEstimate, Option<SeenLoad>), GapError> {
    let (estimate, felt) = look(measurement)?;
    Ok((estimate, felt.and_then(Felt::load)))
}

/// The load behind a gap that is stated.
enum Felt {
    /// The gap was estimated together with it.
    AtBothEnds(SeenLoad),
    /// The gap is known without it; what it takes to estimate it.
    AtOneEnd {
        events: Vec<SeenContact>,
        scales: Scales,
        half_gap: f64,
        place_error: f64,
    },
}

impl Felt {
    fn load(self) -> Option<SeenLoad> {
        match self {
            Self::AtBothEnds(load) => Some(load),
            Self::AtOneEnd {
                events,
                scales,
                half_gap,
                place_error,
            } => {
                let fit = likelihood::fit(&events, &scales, Some((half_gap, place_error)))?;
                seen_load(events, &fit, place_error)
            }
        }
    }
}

fn look(measurement: &Measurement) -> Result<(GapEstimate, Option<Felt>), GapError> {
    let record = Record::new(measurement)?;
    let none = |record: &Record| Ok((nothing(record, Quality::NoDriftingTest), None));
    let cycles = match Cycles::new(&record) {
        Ok(cycles) => cycles,
        Err(NoCycles::NoRelay) => return none(&record),
        Err(NoCycles::Few(per_cycle)) => {
            let mut estimate = nothing(&record, Quality::TooFewSamples);
            estimate.text = verdict::too_few_samples(Some(per_cycle));
            return Ok((estimate, None));
        }
    };
    let Some(motor) = FreeMotor::new(&record, &cycles) else {
        return none(&record);
    };
    let drift = Drift::new(&cycles, &motor.unexplained, motor.noise, &record.position);
    let (touches, disturbed) = touches(&record, &cycles, &motor, &drift);
    let mut estimate = nothing(&record, Quality::NoEngagement);
    estimate.cycles = cycle_drift(&record, &cycles, &drift);
    let (low, high) = range(
        &estimate
            .cycles
            .iter()
            .map(|c| c.position)
            .collect::<Vec<_>>(),
    );
    estimate.travel = high - low;
    estimate.contacts = touches
        .iter()
        .map(|t| Contact {
            time: record.time(t.begin),
            position: record.reaching(t.begin).0,
            side: t.side,
            velocity_loss: t.jump,
        })
        .collect();
    let place_error = place_error(&touches, &record, cycles.speed);
    let both = [Side::Positive, Side::Negative]
        .iter()
        .all(|side| touches.iter().any(|t| t.side == *side));
    let mut felt = None;
    let mut events: Vec<SeenContact> = touches.iter().map(|t| seen(t, &record)).collect();
    between(&mut events, &record, &cycles);
    let (low, high) = range(&record.position);
    let scales = Scales {
        step: record.step,
        speed: cycles.speed,
        acceleration: motor.acceleration,
        travel: high - low,
        unseen: false,
    };
    if both {
        let period = cycles.length * record.step;
        let turned = |events: &mut Vec<SeenContact>| between(events, &record, &cycles);
        let load = two_sided(&mut estimate, events, turned, &scales, period, place_error);
        felt = load.map(Felt::AtBothEnds);
    } else if touches.len() >= FEWEST_CONTACTS {
        one_sided(&mut estimate, &record, &cycles, place_error);
        felt = estimate.gap.map(|gap| Felt::AtOneEnd {
            events,
            scales,
            half_gap: 0.5 * gap,
            place_error,
        });
    } else {
        estimate.contacts.clear();
        if disturbed {
            estimate.quality = Quality::Disturbed;
        }
    }
    estimate.text = verdict::text(&estimate, cycles.flips.iter().any(|f| *f));
    if estimate.gap.is_none() && cycles.length < ENOUGH_SAMPLES {
        estimate.quality = Quality::TooFewSamples;
        estimate.contacts.clear();
        estimate.text = verdict::too_few_samples(Some(cycles.length));
    }
    Ok((estimate, felt))
}

fn nothing(record: &Record, quality: Quality) -> GapEstimate {
    let mut estimate = GapEstimate {
        gap: None,
        std_error: None,
        interval: None,
        unit: record.unit.clone(),
        traverses: Vec::new(),
        contacts: Vec::new(),
        cycles: Vec::new(),
        load: None,
        travel: 0.0,
        quality,
        text: Message::default(),
    };
    estimate.text = verdict::text(&estimate, false);
    estimate
}

/// Both ends were met: the likelihood decides. `period` is that of a cycle, s.
fn two_sided(
    estimate: &mut GapEstimate,
    mut events: Vec<SeenContact>,
    turned: impl Fn(&mut Vec<SeenContact>),
    scales: &Scales,
    period: f64,
    place_error: f64,
) -> Option<SeenLoad> {
    estimate.quality = Quality::Undecided;
    let mut fit = likelihood::fit(&events, scales, None)?;
    let stray = strays(&estimate.contacts, &fit);
    if stray.contains(&true) {
        drop_marked(&mut events, &stray);
        turned(&mut events);
        drop_marked(&mut estimate.contacts, &stray);
        fit = likelihood::fit(&events, scales, None)?;
    }
    if let Some(again) = pushed_unseen(&estimate.contacts, &events, &fit, scales, period) {
        fit = again;
    }
    estimate.traverses = traverses(&estimate.contacts, &fit);
    let gap = 2.0 * fit.play.half_gap;
    let rattles = rattles(&estimate.traverses, period);
    let systematic = if rattles { RATTLE_ERROR * gap } else { 0.0 };
    let flight = FLIGHT * flight(&estimate.traverses, gap);
    let error = [2.0 * fit.error, 2.0 * place_error, systematic, flight]
        .into_iter()
        .fold(0.0, libm::hypot);
    let agree = !disagree(&estimate.contacts, &fit);
    if !(error < STATED * gap && gap < 2.0 * scales.travel && agree) {
        return None;
    }
    estimate.load = Some(LoadMotion {
        inertia_ratio: 1.0 / fit.play.ratio,
        viscous: fit.play.slowing.viscous,
        dry: fit.play.slowing.dry,
    });
    let scatter = scatter(&estimate.traverses, gap);
    estimate.quality =
        if error <= GOOD * gap && estimate.traverses.len() >= GOOD_TRAVERSES && scatter <= STATED {
            Quality::Good
        } else if error <= FAIR * gap && estimate.traverses.len() > 1 {
            Quality::Fair
        } else {
            Quality::Poor
        };
    state(estimate, gap, error);
    seen_load(events, &fit, place_error)
}

/// How far the load usually flies during a traverse, rad or m.
fn flight(traverses: &[Traverse], gap: f64) -> f64 {
    let mut ways: Vec<f64> = traverses
        .iter()
        .map(|t| ((t.to.position - t.from.position).abs() - gap).abs())
        .collect();
    if ways.is_empty() {
        return 0.0;
    }
    median(&mut ways)
}

/// Whether the traverses of a fit are not of one gap.
fn disagree(contacts: &[Contact], fit: &Fit) -> bool {
    disagreement(&traverses(contacts, fit), 2.0 * fit.play.half_gap) >= AGREE
}

/// Where the traverses disagree touches too light to be seen may have pushed the load along: the fit that counts with
/// it. They can push along what moves by itself only: a load that dry friction stops between two cycles is hit in each
/// anew, and that is seen. `period` is that of a cycle, s.
fn pushed_unseen(
    contacts: &[Contact],
    events: &[SeenContact],
    fit: &Fit,
    scales: &Scales,
    period: f64,
) -> Option<Fit> {
    if !disagree(contacts, fit) {
        return None;
    }
    let scales = Scales {
        unseen: true,
        ..*scales
    };
    let again = likelihood::fit(events, &scales, None)?;
    let mut pushes: Vec<f64> = events
        .iter()
        .map(|e| again.play.ratio * e.jump.abs())
        .collect();
    let stopped = again.play.slowing.dry * period;
    (stopped < SLOWED * median(&mut pushes)).then_some(again)
}

/// Share of the speed that a contact gives the load which dry friction may take within a cycle of one that moves by
/// itself.
const SLOWED: f64 = 0.1;

/// Contacts at one end of the gap between two at the other from which the motor did not go anything like the gap: what
/// else disturbed the motor there was no load.
fn strays(contacts: &[Contact], fit: &Fit) -> Vec<bool> {
    let least = STRAY * 2.0 * fit.play.half_gap;
    let off: Vec<bool> = contacts
        .windows(2)
        .zip(&fit.innovations)
        .map(|(pair, i)| {
            !i.lost && pair[0].side != pair[1].side && i.value.abs() > least + i.deviation
        })
        .collect();
    let at = |pair: Option<usize>| pair.and_then(|k| off.get(k)).copied().unwrap_or(false);
    (0..contacts.len())
        .map(|k| at(k.checked_sub(1)) && at(Some(k)))
        .collect()
}

fn seen_load(events: Vec<SeenContact>, fit: &Fit, place_error: f64) -> Option<SeenLoad> {
    let sharpness = Sharpness {
        place: libm::hypot(fit.sharpness.place, place_error),
        ..fit.sharpness
    };
    SeenLoad::new(events, fit.play, sharpness, fit.load_errors)
}

/// Systematic error of the place of a contact, rad or m.
fn place_error(touches: &[Touch], record: &Record, speed: f64) -> f64 {
    let mut lengths: Vec<f64> = touches.iter().map(|t| t.length).collect();
    if touches.is_empty() {
        return 0.0;
    }
    let samples = if record.has_velocity {
        libm::hypot(PLACE, PLACE_SHARE * median(&mut lengths))
    } else {
        POSITION_PLACE
    };
    samples * record.step * speed
}

/// A touch in SI units.
fn seen(touch: &Touch, record: &Record) -> SeenContact {
    let (position, velocity) = record.reaching(touch.begin);
    SeenContact {
        begin: record.time(touch.begin),
        end: record.time(touch.begin + touch.length),
        centre: touch.centre * record.step,
        position,
        velocity,
        side: touch.side.sign(),
        jump: touch.jump,
        jump_noise: touch.jump_noise,
        free: touch.free,
        turns: [None; 2],
    }
}

/// Writes down where the motor was farthest between the contacts.
fn between(events: &mut [SeenContact], record: &Record, cycles: &Cycles) {
    let length = cycles.length;
    let sample = |time: f64| (time - record.start) / record.step;
    for k in 1..events.len() {
        let from = sample(events[k - 1].end) + MARGIN * length;
        let to = sample(events[k].begin) - MARGIN * length;
        events[k].turns = [None; 2];
        if to - from < length {
            continue;
        }
        let (from, to) = (from.ceil() as usize, to as usize);
        let place = |i: &usize, j: &usize| record.position[*i].total_cmp(&record.position[*j]);
        let turn = |at: usize, side: f64| Turn {
            time: record.time(at as f64),
            position: record.position[at],
            side,
        };
        let high = (from..to).max_by(place).map(|at| turn(at, 1.0));
        let low = (from..to).min_by(place).map(|at| turn(at, -1.0));
        events[k].turns = [high, low];
        events[k].turns.sort_by(|a, b| {
            a.map_or(0.0, |t| t.time)
                .total_cmp(&b.map_or(0.0, |t| t.time))
        });
    }
}

/// Median deviation of the traverses from the gap, relative, as far as the load's motion does not explain it.
fn disagreement(traverses: &[Traverse], gap: f64) -> f64 {
    let mut off: Vec<f64> = traverses
        .iter()
        .map(|t| ((t.gap - gap).abs() - t.std_error.min(AGREE * gap)) / gap)
        .collect();
    median(&mut off)
}

/// Relative deviation from the gap within which nine in ten traverses lie.
fn scatter(traverses: &[Traverse], gap: f64) -> f64 {
    let mut off: Vec<f64> = traverses
        .iter()
        .map(|t| (t.gap / gap - 1.0).abs())
        .collect();
    quantile(&mut off, 0.9)
}

/// Whether the load rattles: it flies to and fro so fast that the motor hardly moves meanwhile, so that
/// gap and load speed can be scaled together.
fn rattles(traverses: &[Traverse], period: f64) -> bool {
    let fast = traverses
        .iter()
        .filter(|t| t.to.time - t.from.time < RATTLE_CYCLES * period);
    fast.count() >= RATTLES
}

fn state(estimate: &mut GapEstimate, gap: f64, error: f64) {
    estimate.gap = Some(gap);
    estimate.std_error = Some(error);
    estimate.interval = Some([(gap - NORMAL_95 * error).max(0.0), gap + NORMAL_95 * error]);
}

fn traverses(contacts: &[Contact], fit: &Fit) -> Vec<Traverse> {
    contacts
        .windows(2)
        .zip(&fit.innovations)
        .filter(|(pair, i)| pair[0].side != pair[1].side && !i.lost)
        .map(|(pair, innovation)| Traverse {
            from: pair[0],
            to: pair[1],
            gap: 2.0 * fit.play.half_gap + pair[1].side.sign() * innovation.value,
            std_error: innovation.deviation,
        })
        .collect()
}

/// Only one end was met: from the start to the first contact is half a gap if the motor started in the
/// middle, which is said. What the motor travelled afterwards without meeting the other end must fit.
fn one_sided(estimate: &mut GapEstimate, record: &Record, cycles: &Cycles, place_error: f64) {
    estimate.quality = Quality::OneSide;
    let Some(first) = estimate.contacts.first().copied() else {
        return;
    };
    let sign = first.side.sign();
    let gap = 2.0 * sign * (first.position - record.position[0]);
    let at_rest = record.velocity[0].abs() <= AT_REST * cycles.speed;
    // The load never flies against a push, so that it stays or goes ahead: the way back is free gap.
    let mut ahead = f64::NEG_INFINITY;
    let mut free = 0.0_f64;
    let mut next = estimate.contacts.iter().peekable();
    for (i, x) in record.position.iter().enumerate() {
        while let Some(contact) = next.next_if(|c| c.time <= record.time(i as f64)) {
            ahead = ahead.max(sign * contact.position);
        }
        if ahead.is_finite() {
            free = free.max(ahead - sign * x);
        }
    }
    let error = 2.0 * libm::hypot(place_error, place_error);
    if at_rest && gap > 4.0 * error && gap > free {
        estimate.quality = Quality::AssumedCentre;
        state(estimate, gap, error);
    }
}

fn cycle_drift(record: &Record, cycles: &Cycles, drift: &Drift) -> Vec<CycleDrift> {
    const ABOUT: usize = 2;
    let starts = &cycles.starts;
    (0..cycles.count())
        .map(|k| {
            let (from, to) = (starts[k], starts[k + 1]);
            let part = &record.position[from..to];
            let first = starts[k.saturating_sub(ABOUT)];
            let last = starts[(k + 1 + ABOUT).min(cycles.count())];
            CycleDrift {
                time: record.time(0.5 * (from + to) as f64),
                position: part.iter().sum::<f64>() / part.len() as f64,
                rate: (record.position[last] - record.position[first])
                    / ((last - first) as f64 * record.step),
                unexplained: drift.change[k],
                engaged: drift.engaged[k],
            }
        })
        .collect()
}
