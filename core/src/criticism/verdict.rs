//! What the data say in the end, in plain words.

use super::dry_or_viscous::InsteadOfViscous;
use super::score::Score;
use super::select::is_plain_noise;
use super::session::{Rest, Scored};
use crate::diagnosis::{
    Contradiction, Finding, InputCheck, InputVerdict, LoopError, NextExperiment, Overruled,
    Parameter, Verdict,
};
use crate::effect::baseline::RATE;
use crate::effect::{self, Effect, EffectId, is_of_record, name_of};
use crate::message::{Message, fixed};
use crate::msg;
use crate::uncertain::{digits, in_unit, with_error};

/// Effects that could stand in the place of one in the model.
pub(super) type Class = Vec<&'static dyn Effect>;

/// Standard error, as a share of it, up to which an inertia, or the gain of a process, is told: its 95 % interval is
/// half of it.
const DETERMINED: f64 = 0.25;

/// The verdict on a final model: `wanted` are its effects, each with whether it only tells how the record was made,
/// `classes` what could replace each.
pub(super) fn verdict(
    wanted: &[(&'static dyn Effect, bool)],
    classes: &[Class],
    parameters: &[Parameter],
    model: &Scored,
    rest: Rest,
    contradicted: Vec<Contradiction>,
) -> Verdict {
    let class = |(place, (effect, _)): (usize, &(&'static dyn Effect, bool))| {
        let others = classes.get(place).into_iter().flatten().map(|e| e.id());
        let all = std::iter::once(effect.id()).chain(others);
        in_registry_order(all.filter(|id| !is_of_record(*id)).collect())
    };
    let of_record: Vec<Vec<EffectId>> = wanted
        .iter()
        .filter(|(_, of_record)| *of_record)
        .map(|(e, _)| vec![e.id()])
        .collect();
    let of_machine = wanted.iter().enumerate().filter(|(_, w)| !w.1);
    let missing: Vec<Vec<EffectId>> = of_machine.map(class).collect();
    let ambiguous = missing.iter().any(|class| class.len() > 1);
    let mut text = Message::default();
    if !of_record.is_empty() {
        let listed = listed(&of_record, parameters);
        text.add(msg!("A logging effect, not the machine: {}.", listed));
    }
    if !missing.is_empty() {
        text.add(msg!("Missing: {}.", listed(&missing, parameters)));
    }
    let complete = rest != Rest::More;
    if !contradicted.is_empty() {
        return Verdict {
            complete,
            ..contradiction(missing, contradicted, text, model.score.error)
        };
    }
    text.add(match (missing.is_empty(), complete) {
        (true, true) => "Nothing is missing: what the model leaves is measurement noise.",
        (false, true) => "With that, what is left is measurement noise.",
        (true, false) => {
            "The model leaves more than noise, but no effect in the library explains it."
        }
        (false, false) => {
            "What is left is more than noise, but no further effect in the library explains it."
        }
    });
    Verdict {
        missing,
        complete,
        unknown: !complete,
        next_experiment: ambiguous.then(|| NEXT_EXPERIMENT.into()),
        part_of_the_way: Vec::new(),
        experiments: Vec::new(),
        contradicted,
        overruled: Vec::new(),
        text,
    }
}

/// `Coulomb friction, friction level 0.0406 ± 0.0002 N m; Dead zone`.
fn listed(classes: &[Vec<EffectId>], parameters: &[Parameter]) -> Message {
    Message::list("; ", classes.iter().map(|c| describe(c, parameters)))
}

/// The verdict where the data contradict what the user's model holds.
fn contradiction(
    missing: Vec<Vec<EffectId>>,
    contradicted: Vec<Contradiction>,
    listed: Message,
    error: f64,
) -> Verdict {
    let mut text = Message::default();
    for c in &contradicted {
        text.add(msg!(
            "The model is given {} = {}, but these data say {}.",
            Message::name(&c.name),
            in_unit(digits(c.held, 5), &c.unit),
            with_error(c.wanted, c.std_error, &c.unit)
        ));
    }
    text.add(listed);
    let released = contradicted.first().map_or(error, |c| c.error);
    if released < error {
        text.add(msg!(
            "With the given values freed, the error falls from {} to {} times the noise: correct or free them before \
             looking for effects.",
            fixed(error, 2),
            fixed(released, 2)
        ));
    } else {
        text.add("Correct or free the given values before looking for effects.");
    }
    Verdict {
        missing,
        complete: false,
        unknown: false,
        next_experiment: None,
        part_of_the_way: Vec::new(),
        experiments: Vec::new(),
        contradicted,
        overruled: Vec::new(),
        text,
    }
}

/// Says first and last which values the data have overruled; what they contradict is said already.
pub(super) fn add_overruled(verdict: &mut Verdict, overruled: Vec<Overruled>) {
    let said = |o: &&Overruled| {
        let mut all = verdict.contradicted.iter();
        !all.any(|c| (c.effect, &c.name) == (o.effect, &o.name))
    };
    let new: Vec<&Overruled> = overruled.iter().filter(said).collect();
    if !new.is_empty() {
        let names = Message::list(", ", new.iter().map(|o| Message::name(&o.name)));
        let mut text = Message::list(" ", new.iter().map(|o| o.words()));
        text.add(std::mem::take(&mut verdict.text));
        text.add(msg!(
            "All this holds with a value other than the one given: {}.",
            names
        ));
        verdict.text = text;
    }
    verdict.overruled = overruled;
}

/// Says how much is left of what was there at `first` where that is more than plain noise, and, of a verdict that
/// is not complete, where it lies.
pub(super) fn add_rest(
    verdict: &mut Verdict,
    rest: Rest,
    score: &Score,
    first: f64,
    findings: &[Finding],
) {
    if !verdict.contradicted.is_empty() || is_plain_noise(score) {
        return;
    }
    let error = score.error;
    let share = 100.0 * error / first;
    if rest == Rest::NoiseWithMemory {
        verdict.text.add(msg!(
            "This noise is correlated over a few samples, like that of a sensor with a filter: it is {} times what \
             neighbouring samples show, and depends neither on the motion nor on the input.",
            fixed(error, 2)
        ));
        return;
    }
    if verdict.complete {
        let nothing = verdict.missing.is_empty();
        if rest == Rest::RandomForces {
            verdict.text.restate(if nothing {
                msg!(
                    "Nothing is missing: what the model leaves is noise and the effect of small random forces, such \
                     as noise of the measured input or a controller that is faster than the record: {} times the noise.", fixed(error, 2))
            } else {
                msg!(
                    "With that, what is left is noise and the effect of small random forces, such as noise of \
                     the measured input or a controller that is faster than the record: {} times the noise.", fixed(error, 2))
            });
            verdict.text.add(
                "That effect wanders like a random walk, and depends neither on the motion nor on the input.",
            );
            return;
        }
        verdict.text.restate(if nothing {
            msg!(
                "Nothing is missing: what the model leaves is noise, apart from a small remainder or a few short \
                 stretches: the error is {} times the noise, {} % of what it was at first.",
                fixed(error, 2),
                fixed(share, 2)
            )
        } else {
            msg!(
                "With that, what is left is noise, apart from a small remainder or a few short stretches: the error \
                 is {} times the noise, {} % of what it was at first.", fixed(error, 2), fixed(share, 2))
        });
        return;
    }
    let error = fixed(error, 2);
    verdict.text.add(if verdict.missing.is_empty() {
        msg!("The error is {} times the noise.", error)
    } else {
        let share = fixed(share, if share < 1.0 { 2 } else { 0 });
        msg!(
            "The error is {} times the noise, {} % of what it was at first.",
            error,
            share
        )
    });
    if let Some(strongest) = findings.first() {
        verdict.text.add(&strongest.text);
    }
}

/// Says that the noise of the input was taken off.
pub(super) fn add_input_noise(verdict: &mut Verdict, noise: f64, unit: &str) {
    verdict.text.add(msg!(
        "The input was measured with a noise of {}, which does not act: its readings were averaged.",
        in_unit(digits(noise, 2), unit)
    ));
}

/// Says by what models were compared where the surroundings of a process wander.
pub(super) fn add_wander(verdict: &mut Verdict) {
    verdict.text.add(
        "Most of what any model leaves drifts slowly, as if the surroundings changed: so each model is judged by how \
         well it predicts a sample from those before it.",
    );
}

/// Says what would tell apart what a drive that turns one way only leaves alike.
pub(super) fn add_both_ways(verdict: &mut Verdict) {
    verdict.text.add("The drive turns one way only.");
    verdict.next_experiment = Some(BOTH_WAYS.into());
}

/// Says that what is a constant cannot show where the input is one too.
pub(super) fn add_one_push(verdict: &mut Verdict) {
    verdict.text.add(
        "While the drive moved, its input had one value: dry friction, a constant load or a dead zone would only make \
         the inertia and the viscous friction look larger or smaller, so this record cannot tell whether there is any.",
    );
    verdict.next_experiment = Some(BOTH_WAYS.into());
}

/// Says that a process integrates, and how fast its output moves.
pub(super) fn add_integrating(verdict: &mut Verdict, parameters: &[Parameter]) {
    let rate = parameters
        .iter()
        .find(|p| p.effect.is_none() && p.name == RATE);
    if let Some(rate) = rate {
        verdict.text.add(msg!(
            "The process integrates, so that its output stays where the input leaves it: K/T is {}.",
            with_error(rate.value, rate.std_error, &rate.unit)
        ));
    }
}

/// Says how far the cycle of a model in the measured relay loop is off, and how far without what was found.
pub(super) fn add_relay_loop(
    verdict: &mut Verdict,
    model: Option<LoopError>,
    first: Option<LoopError>,
) {
    let Some(model) = model else {
        return;
    };
    match cycle_words(model) {
        Some([period, amplitude]) => {
            let first = first.filter(|_| !verdict.missing.is_empty());
            verdict.text.add(match first.map(cycle_words) {
                None => msg!(
                    "Left to run in its own relay loop, the model is off by {} % in period and {} % in amplitude.",
                    period,
                    amplitude
                ),
                Some(Some([first, swing])) => msg!(
                    "Left to run in its own relay loop, the model is off by {} % in period and {} % in amplitude \
                     (without what was found: {} % and {} %).",
                    period,
                    amplitude,
                    first,
                    swing
                ),
                Some(None) => msg!(
                    "Left to run in its own relay loop, the model is off by {} % in period and {} % in amplitude \
                     (without what was found it does not oscillate).",
                    period,
                    amplitude
                ),
            });
        }
        None => verdict
            .text
            .add("Left to run in its own relay loop, the model does not oscillate."),
    }
}

/// Errors of period and amplitude in per cent.
fn cycle_words(error: LoopError) -> Option<[Message; 2]> {
    let words = |share: f64| fixed(100.0 * share.abs(), 1);
    Some([words(error.period?), words(error.amplitude?)])
}

/// Says that dry friction may stand in the place of viscous friction, by the cycle in the relay loop.
pub(super) fn add_dry_friction(verdict: &mut Verdict, dry: &InsteadOfViscous) {
    let level = with_error(dry.level.value, dry.level.std_error, &dry.level.unit);
    let [error, before] = dry.errors.map(|error| fixed(error, 2));
    verdict.text.add(if dry.class.len() > 1 {
        msg!(
            "The friction could just as well be dry: with {} of Coulomb friction in place of the viscous friction, \
             the error over both halves of the record is {} times the noise instead of {}, too small a difference to \
             count.",
            level,
            error,
            before
        )
    } else {
        msg!(
            "The friction is dry: with {} of Coulomb friction in place of the viscous friction, the error over both \
             halves of the record is {} times the noise instead of {}, too small a difference to count.",
            level,
            error,
            before
        )
    });
    let [with_dry, with_viscous] = dry.in_loop.map(cycle_words);
    verdict.text.add(match (with_dry, with_viscous) {
        (Some([period, swing]), Some([other, old])) => msg!(
            "Left to run in its own relay loop, the model is then off by {} % in period and {} % in amplitude; with \
             viscous friction, by {} % and {} %.",
            period,
            swing,
            other,
            old
        ),
        (Some([period, swing]), None) => msg!(
            "Left to run in its own relay loop, the model is then off by {} % in period and {} % in amplitude; with \
             viscous friction it does not oscillate.",
            period,
            swing
        ),
        (None, Some([period, swing])) => msg!(
            "Left to run in its own relay loop, the model then does not oscillate; with viscous friction it is off by \
             {} % in period and {} % in amplitude.",
            period,
            swing
        ),
        (None, None) =>
            "Left to run in its own relay loop, the model then does not oscillate, nor does it with \
             viscous friction.".into(),
    });
    verdict.missing.push(dry.class.clone());
    if dry.class.len() > 1 {
        verdict
            .next_experiment
            .get_or_insert_with(|| NEXT_EXPERIMENT.into());
    }
}

/// Effects that lower the error for certain and are not named, and the error with the best of them.
pub(super) struct PartOfTheWay {
    /// Which cannot be told apart.
    pub class: Vec<EffectId>,
    /// In times of the noise.
    pub error: f64,
    /// Why they are not named.
    pub refused: Refused,
}

/// Why an effect that lowers the error for certain is not named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refused {
    /// It leaves more than it explains.
    LeavesMore,
    /// What makes it what it is does not stand out.
    WithoutMarks,
    /// Its size may be 0 by its error.
    MayBeNothing,
    /// It is a trifle of the input.
    Trifle,
    /// It was not the best when it was compared.
    Other,
}

/// Says what would explain a part for certain, why it is not named, and the error with it.
pub(super) fn add_part_of_the_way(verdict: &mut Verdict, part: Option<PartOfTheWay>) {
    let Some(part) = part else { return };
    let class = in_registry_order(part.class);
    let (listed, error) = (names(&class, " or "), part.error);
    let reason = match part.refused {
        Refused::LeavesMore => {
            verdict.text.add(msg!(
                "Part of the way, but not named as missing, since it leaves more than it explains: {}, with which the \
                 error is {} times the noise.",
                listed,
                fixed(error, 2)
            ));
            verdict.part_of_the_way = class;
            return;
        }
        Refused::WithoutMarks => {
            "It is not named, since this record hardly shows what sets it apart from others."
        }
        Refused::MayBeNothing => "It is not named, since within its error its size may be 0.",
        Refused::Trifle => "It is not named, since it would be a negligible part of the input.",
        Refused::Other => "",
    };
    verdict.text.add(
        msg!(
            "With {} the error would be {} times the noise.",
            listed,
            fixed(error, 2)
        )
        .and(reason),
    );
    verdict.part_of_the_way = class;
}

/// Says which effects would lower the error much, and to what, though chance is not ruled out.
pub(super) fn add_hint(verdict: &mut Verdict, hint: Option<(Vec<EffectId>, f64)>) {
    if let Some((class, error)) = hint {
        verdict.text.add(msg!(
            "Perhaps {}: that would lower the error to {} times the noise, but not in enough independent stretches \
             of the record to rule out chance.",
            names(&in_registry_order(class), " or "),
            fixed(error, 2)
        ));
    }
}

/// Says first where the input does not explain the motion: where its sign is turned, or it follows the output and the
/// record does not tell the plant, no physics is named, for that would be physics of another machine. A model that
/// leaves noise alone has explained the motion, which a controller may have made. That the inertia is not told is not
/// said beside one that is.
pub(super) fn add_input_check(verdict: &mut Verdict, check: &InputCheck, parameters: &[Parameter]) {
    let inertia = parameters.first();
    let is_told = inertia.is_some_and(|p| p.std_error < DETERMINED * p.value.abs());
    let leads = match check.verdict {
        InputVerdict::Ok => false,
        InputVerdict::InertiaNotTold => !is_told,
        InputVerdict::DoesNotExplain | InputVerdict::Sign | InputVerdict::ClosedLoop => true,
    };
    let closed = check.verdict == InputVerdict::ClosedLoop;
    if !leads || verdict.complete && !closed {
        return;
    }
    if check.is_of_another_plant() {
        verdict.missing.clear();
        verdict.experiments.clear();
        verdict.next_experiment = None;
        verdict.complete = false;
        verdict.unknown = true;
        verdict.text.clone_from(&check.text);
    } else {
        verdict.text = check.text.clone().and(std::mem::take(&mut verdict.text));
    }
}

/// Says which effects of the user's model the data do not need: `idle` ones leave no trace, `unsure` ones lower the
/// error.
pub(super) fn add_idle(verdict: &mut Verdict, idle: &[EffectId], unsure: &[EffectId]) {
    if !idle.is_empty() {
        verdict.text.add(msg!(
            "In the model, but without a trace in these data: {}.",
            names(idle, ", ")
        ));
    }
    if !unsure.is_empty() {
        verdict.text.add(msg!(
            "In the model, but lowering the error by no more than chance would: {}.",
            names(unsure, ", ")
        ));
    }
}

/// Puts advice for an input that has more than two levels in the place of the general one.
pub(super) fn add_other_experiment(verdict: &mut Verdict, input: &[f64]) {
    let first = input.first();
    let second = input.iter().find(|u| Some(*u) != first);
    let has_more = input.iter().any(|u| Some(u) != first && Some(u) != second);
    if let Some(advice) = verdict.next_experiment.as_mut().filter(|_| has_more) {
        *advice = OTHER_EXPERIMENT.into();
    }
}

/// Puts the experiments that were found in the place of the general advice.
pub(super) fn add_experiments(verdict: &mut Verdict, experiments: &[NextExperiment]) {
    if !experiments.is_empty() && verdict.next_experiment.is_some() {
        verdict.experiments = experiments.to_vec();
        verdict.say_experiments();
    }
}

/// For effects that act alike in one experiment.
const NEXT_EXPERIMENT: &str = "Repeat the measurement with an input of more than two levels, such as a \
    staircase or a relay with changing gain: what acts alike at one pair of levels differs at another.";

/// The same where the input has more levels than two already.
const OTHER_EXPERIMENT: &str = "Repeat the measurement with another input, of other levels and other speeds of change: \
    what acts alike in one motion differs in another.";

/// For what is one constant while a drive turns one way.
const BOTH_WAYS: &str = "Let the drive turn both ways and rest in between: dry friction then changes sign with the \
                         motion, a dead zone with the input, and a constant load never.";

fn names(ids: &[EffectId], between: &'static str) -> Message {
    Message::list(between, ids.iter().map(|id| name_of(*id)))
}

/// `Coulomb friction, friction level 0.0406 ± 0.0002 N m`.
fn describe(class: &[EffectId], parameters: &[Parameter]) -> Message {
    if class.len() > 1 {
        return msg!(
            "{} (this measurement cannot tell them apart)",
            names(class, " or ")
        );
    }
    let Some(id) = class.first() else {
        return Message::default();
    };
    let telling = effect::find(*id).map_or(1, Effect::telling);
    let own = parameters.iter().filter(|p| p.effect == Some(*id));
    // Of several that may tell of an effect, that which does; the first of equals.
    let sureness = |p: &Parameter| (p.value / p.std_error).abs();
    let main = own.take(telling).reduce(|best, other| {
        if sureness(other) > sureness(best) {
            other
        } else {
            best
        }
    });
    main.map_or_else(
        || name_of(*id).into(),
        |p| {
            let (name, value) = (name_of(*id), with_error(p.value, p.std_error, &p.unit));
            if name.eq_ignore_ascii_case(&p.label) {
                msg!("{} {}", name, value)
            } else {
                msg!("{}, {} {}", name, Message::words(p.label.clone()), value)
            }
        },
    )
}

fn in_registry_order(mut ids: Vec<EffectId>) -> Vec<EffectId> {
    // Effects of the user's own come last.
    ids.sort_by_key(|id| {
        let at = effect::registry().iter().position(|e| e.id() == *id);
        at.unwrap_or(usize::MAX)
    });
    ids
}
