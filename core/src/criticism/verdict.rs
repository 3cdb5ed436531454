//! What the data say in the end, in plain words.

use std::fmt::Write as _;

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
use crate::uncertain::{in_unit, with_error};

/// Effects that could stand in the place of one in the model.
pub(super) type Class = Vec<&'static dyn Effect>;

/// Standard error, as a share of it, up to which an inertia, or the gain of a process, is told: its 95 % interval is
/// half of it.
const DETERMINED: f64 = 0.25;

/// What a model leaves that explains all there is.
const ALL_NOISE: &str = " is measurement noise.";

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
    let mut text = listed("A logging effect, not the machine", &of_record, parameters);
    text.push_str(&listed("Missing", &missing, parameters));
    let complete = rest != Rest::More;
    if !contradicted.is_empty() {
        return Verdict {
            complete,
            ..contradiction(missing, contradicted, &text, model.score.error)
        };
    }
    text.push_str(match (missing.is_empty(), complete) {
        (true, true) => "Nothing is missing: what the model leaves",
        (false, true) => "With that, what is left",
        (true, false) => {
            "The model leaves more than noise, but no effect in the library explains it."
        }
        (false, false) => {
            "What is left is more than noise, but no further effect in the library explains it."
        }
    });
    if complete {
        text.push_str(ALL_NOISE);
    }
    Verdict {
        missing,
        complete,
        unknown: !complete,
        next_experiment: ambiguous.then(|| NEXT_EXPERIMENT.to_owned()),
        part_of_the_way: Vec::new(),
        experiments: Vec::new(),
        contradicted,
        overruled: Vec::new(),
        text,
    }
}

/// `Missing: Coulomb friction, friction level 0.0406 ± 0.0002 N m. `, or nothing where there is none.
fn listed(what: &str, classes: &[Vec<EffectId>], parameters: &[Parameter]) -> String {
    if classes.is_empty() {
        return String::new();
    }
    let list: Vec<String> = classes.iter().map(|c| describe(c, parameters)).collect();
    format!("{what}: {}. ", list.join("; "))
}

/// The verdict where the data contradict what the user's model holds.
fn contradiction(
    missing: Vec<Vec<EffectId>>,
    contradicted: Vec<Contradiction>,
    listed: &str,
    error: f64,
) -> Verdict {
    let mut text = String::new();
    for c in &contradicted {
        let _ = write!(
            text,
            "The model holds {} = {}, but these data want {}. ",
            c.name,
            in_unit(format!("{:.4e}", c.held), &c.unit),
            with_error(c.wanted, c.std_error, &c.unit)
        );
    }
    text.push_str(listed);
    let released = contradicted.first().map_or(error, |c| c.error);
    if released < error {
        let _ = write!(
            text,
            "With the known values released the error falls from {error:.2} to {released:.2} times the noise: correct \
             or free them before looking for effects."
        );
    } else {
        text.push_str("Correct or free what is known before looking for effects.");
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
        let first: Vec<String> = new.iter().map(|o| o.words()).collect();
        let names: Vec<&str> = new.iter().map(|o| o.name.as_str()).collect();
        verdict.text = format!(
            "{} {} All this holds with another value than the one that was given: {}.",
            first.join(" "),
            verdict.text,
            names.join(", ")
        );
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
        let _ = write!(
            verdict.text,
            " This noise remembers for some samples, as that of a sensor with a filter does: it is {error:.2} times \
             what neighbouring samples show, and depends neither on the motion nor on the input."
        );
        return;
    }
    if verdict.complete {
        if let Some(before) = verdict.text.strip_suffix(ALL_NOISE) {
            verdict.text = before.to_owned();
        }
        if rest == Rest::RandomForces {
            let _ = write!(
                verdict.text,
                " is noise, and what small random forces leave, such as those of a controller that is faster than the \
                 record: {error:.2} times the noise. It goes on a random walk, and depends neither on the motion nor \
                 on the input."
            );
            return;
        }
        let _ = write!(
            verdict.text,
            " is noise but for a trifle, or for short stretches: the error is {error:.2} times the noise, {share:.2} % \
             of what it was at first."
        );
        return;
    }
    let _ = write!(verdict.text, " The error is {error:.2} times the noise");
    if !verdict.missing.is_empty() {
        let digits = if share < 1.0 { 2 } else { 0 };
        let _ = write!(verdict.text, ", {share:.digits$} % of what it was at first");
    }
    verdict.text.push('.');
    if let Some(strongest) = findings.first() {
        let _ = write!(verdict.text, " {}", strongest.text);
    }
}

/// Says by what models were compared where the surroundings of a process wander.
pub(super) fn add_wander(verdict: &mut Verdict) {
    verdict.text.push_str(
        " Most of what any model leaves wanders slowly, as if the surroundings changed: each model is judged by how \
         well it foretells a sample from those before it.",
    );
}

/// Says what would tell apart what a drive that turns one way only leaves alike.
pub(super) fn add_both_ways(verdict: &mut Verdict) {
    verdict.text.push_str(" The drive turns one way only.");
    verdict.next_experiment = Some(BOTH_WAYS.to_owned());
}

/// Says that a process integrates, and how fast its output moves.
pub(super) fn add_integrating(verdict: &mut Verdict, parameters: &[Parameter]) {
    let rate = parameters
        .iter()
        .find(|p| p.effect.is_none() && p.name == RATE);
    if let Some(rate) = rate {
        let _ = write!(
            verdict.text,
            " The process integrates, so that its output stays where the input leaves it: K/T is {}.",
            with_error(rate.value, rate.std_error, &rate.unit)
        );
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
            let _ = write!(
                verdict.text,
                " Run free in its own relay loop, the model's period is off by {period} and its amplitude by {amplitude}"
            );
            if let Some(first) = first.filter(|_| !verdict.missing.is_empty()) {
                let _ = match cycle_words(first) {
                    Some([period, amplitude]) => write!(
                        verdict.text,
                        " (without what was found: {period} and {amplitude})"
                    ),
                    None => write!(verdict.text, " (without what was found there is no cycle)"),
                };
            }
            verdict.text.push('.');
        }
        None => verdict
            .text
            .push_str(" Run free in its own relay loop, the model comes to no cycle."),
    }
}

/// Errors of period and amplitude in per cent.
fn cycle_words(error: LoopError) -> Option<[String; 2]> {
    let words = |share: f64| format!("{:.1} %", 100.0 * share.abs());
    Some([words(error.period?), words(error.amplitude?)])
}

/// Says that dry friction may stand in the place of viscous friction, by the cycle in the relay loop.
pub(super) fn add_dry_friction(verdict: &mut Verdict, dry: &InsteadOfViscous) {
    let [with_dry, with_viscous] = dry.in_loop.map(|error| {
        cycle_words(error).map_or_else(
            || "there is no cycle".to_owned(),
            |[period, amplitude]| {
                format!("the period is off by {period} and the amplitude by {amplitude}")
            },
        )
    });
    let lead = if dry.class.len() > 1 {
        "The friction may be dry as well"
    } else {
        "The friction is dry"
    };
    let level = with_error(dry.level.value, dry.level.std_error, &dry.level.unit);
    let [error, before] = dry.errors;
    let _ = write!(
        verdict.text,
        " {lead}: with {level} of Coulomb friction in the place of the viscous friction, both halves of the record are \
         left with {error:.2} times the noise instead of {before:.2}, too small a difference to count. Run free in its \
         own relay loop, {with_dry}; with viscous friction {with_viscous}."
    );
    verdict.missing.push(dry.class.clone());
    if dry.class.len() > 1 {
        verdict
            .next_experiment
            .get_or_insert_with(|| NEXT_EXPERIMENT.to_owned());
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
            let _ = write!(
                verdict.text,
                " Part of the way, and not named since it leaves more than it explains: {listed}, with which the error \
                 is {error:.2} times the noise."
            );
            verdict.part_of_the_way = class;
            return;
        }
        Refused::WithoutMarks => {
            " It is not named, since what sets it apart from others does not stand out in this record."
        }
        Refused::MayBeNothing => " It is not named, since by its error its size may be 0.",
        Refused::Trifle => " It is not named, since it would be a trifle of the input.",
        Refused::Other => "",
    };
    let _ = write!(
        verdict.text,
        " With {listed} the error would be {error:.2} times the noise.{reason}"
    );
    verdict.part_of_the_way = class;
}

/// Says which effects would lower the error much, and to what, though chance is not ruled out.
pub(super) fn add_hint(verdict: &mut Verdict, hint: Option<(Vec<EffectId>, f64)>) {
    if let Some((class, error)) = hint {
        let _ = write!(
            verdict.text,
            " Perhaps {}: that would lower the error to {error:.2} times the noise, but not in enough independent \
             stretches of the record to rule out chance.",
            names(&in_registry_order(class), " or ")
        );
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
    if check.verdict == InputVerdict::Sign || closed && !check.plant_told {
        verdict.missing.clear();
        verdict.experiments.clear();
        verdict.next_experiment = None;
        verdict.complete = false;
        verdict.unknown = true;
        verdict.text.clone_from(&check.text);
    } else {
        verdict.text = format!("{} {}", check.text, verdict.text);
    }
}

/// Says which effects of the user's model the data do not need: `idle` ones leave no trace, `unsure` ones lower the
/// error.
pub(super) fn add_idle(verdict: &mut Verdict, idle: &[EffectId], unsure: &[EffectId]) {
    if !idle.is_empty() {
        let _ = write!(
            verdict.text,
            " In the model, but without a trace in these data: {}.",
            names(idle, ", ")
        );
    }
    if !unsure.is_empty() {
        let _ = write!(
            verdict.text,
            " In the model, and the error is lower with it, but not beyond chance: {}.",
            names(unsure, ", ")
        );
    }
}

/// Puts advice for an input that has more than two levels in the place of the general one.
pub(super) fn add_other_experiment(verdict: &mut Verdict, input: &[f64]) {
    let first = input.first();
    let second = input.iter().find(|u| Some(*u) != first);
    let has_more = input.iter().any(|u| Some(u) != first && Some(u) != second);
    if let Some(advice) = verdict.next_experiment.as_mut().filter(|_| has_more) {
        OTHER_EXPERIMENT.clone_into(advice);
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
const BOTH_WAYS: &str = "Let the drive turn both ways, and rest between: dry friction then changes its sign with the \
    motion, a dead zone with the input, and a constant load never.";

fn names(ids: &[EffectId], between: &str) -> String {
    let names: Vec<&str> = ids.iter().map(|id| name_of(*id)).collect();
    names.join(between)
}

/// `Coulomb friction, friction level 0.0406 ± 0.0002 N m`.
fn describe(class: &[EffectId], parameters: &[Parameter]) -> String {
    if class.len() > 1 {
        return format!(
            "{} (this measurement cannot tell them apart)",
            names(class, " or ")
        );
    }
    let Some(id) = class.first() else {
        return String::new();
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
        || name_of(*id).to_owned(),
        |p| {
            let (name, value) = (name_of(*id), with_error(p.value, p.std_error, &p.unit));
            if name.eq_ignore_ascii_case(&p.label) {
                format!("{name} {value}")
            } else {
                format!("{name}, {} {value}", p.label)
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
