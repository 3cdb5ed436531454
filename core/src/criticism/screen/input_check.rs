//! The input questioned before the physics.

use super::gram::{Gram, Reduced};
use super::model::{ACCELERATION, Fit, INPUT, ONE, VELOCITY};
use super::prepare::Prepared;
use super::response::{left_by_lags, left_of_forecast, work};
use super::signals::Signals;
use super::subsets::{Bench, Tried, smallest};
use super::tuning::{BLOCKS, CHANCE, DRIVEN, LATE, LATEST, TOLD, UNEXPLAINED};
use super::window::Width;
use crate::controller::{Controller, Logged, controller};
use crate::diagnosis::{InputCheck, InputVerdict};
use crate::measurement::Kind;
use crate::message::{Message, fixed};
use crate::msg;
use crate::order::median;
use crate::uncertain::{brief, digits};

/// Share of the motion that the best of these subsets leaves; all of it where there is none.
pub(super) fn left(bench: &Bench, tried: &[Tried]) -> f64 {
    let motion = bench.motion();
    let best = smallest(tried, motion).first().map(|t| t.loss());
    best.map_or(1.0, |loss| (loss / motion.max(f64::MIN_POSITIVE)).sqrt())
}

/// The controller that made the input, if one did.
pub(super) fn made_by(signals: &Signals) -> Option<Controller> {
    controller(&Logged {
        kind: signals.kind,
        step: signals.step,
        begins: &signals.begins,
        input: &signals.input,
        output: signals
            .velocity
            .as_ref()
            .map_or(&signals.speed, |v| &v.values),
        place: &signals.place,
    })
}

/// What the screen found says of the input, if a controller `made` it of that too.
pub(super) fn checked(
    input_name: &str,
    signals: &Signals,
    widths: &[Width],
    bench: &Bench,
    tried: &[Tried],
    made: Option<&Controller>,
) -> InputCheck {
    let say = |verdict, text: Message| InputCheck {
        verdict,
        text,
        plant_told: verdict == InputVerdict::Ok,
    };
    let left = left(bench, tried);
    let explained = !tried.is_empty() && left < UNEXPLAINED;
    if let Some(made) = made {
        let plant = smallest(tried, bench.motion())
            .first()
            .is_some_and(|t| bench.is_plant(&t.members, made));
        let plant_told = explained && plant;
        return InputCheck {
            plant_told,
            ..say(InputVerdict::ClosedLoop, closed(made, plant_told))
        };
    }
    if explained {
        let share = 100.0 * left;
        return say(
            InputVerdict::Ok,
            msg!(
                "The input explains the motion; {} % of it is left over.",
                fixed(share, 1)
            ),
        );
    }
    let follows = || left_by_lags(signals, widths) < UNEXPLAINED;
    if signals.kind == Kind::Drive {
        let [given, taken] = work(signals);
        let driven = given > DRIVEN * taken;
        if let Some(turned) =
            turned(signals, widths).filter(|turned| !driven && *turned < 0.7 * left.min(1.0))
        {
            let share = 100.0 * turned;
            return say(
                InputVerdict::Sign,
                msg!(
                    "The sign of the input is flipped: the inertia comes out negative, and with the other sign the \
                     input explains all but {} % of the motion. Give the column a minus, as in --map \"u=-{}\".",
                    fixed(share, 1),
                    Message::name(input_name)
                ),
            );
        }
        if let Some(text) = not_told(signals, bench) {
            return say(InputVerdict::InertiaNotTold, text);
        }
        if body_while_calm(signals, widths).is_some() {
            return say(InputVerdict::Ok, AT_TIMES.into());
        }
        if driven || follows() {
            return say(InputVerdict::InertiaNotTold, NOT_BY_INERTIA.into());
        }
    } else if changes_seldom(signals, bench) {
        return say(InputVerdict::InertiaNotTold, TOO_LITTLE.into());
    } else if follows() || left_of_forecast(signals) < UNEXPLAINED {
        return say(InputVerdict::Ok, NOT_AS_A_LAG.into());
    } else if may_explain(bench) {
        return say(InputVerdict::InertiaNotTold, TOO_LITTLE.into());
    }
    let reason = late(signals, widths, left).map_or_else(
        || {
            "Is it the right column, and is this the input that acted here, not one measured elsewhere? A motion that \
             something else imposes does not follow from it."
                .into()
        },
        |late| msg!("It would explain more of it if it acted {} s later than recorded.", fixed(late, 3)),
    );
    let text = Message::from("The input does not explain this motion.").and(reason);
    say(InputVerdict::DoesNotExplain, text)
}

/// Where the input explains the motion most of the time.
const AT_TIMES: &str = "The input explains the motion most of the time. At other times something else acts that is far \
    stronger, such as a stop.";

/// Where the input moves a drive, and what it takes to accelerate the body is not seen.
const NOT_BY_INERTIA: &str = "The input moves the body, but this record hardly shows its inertia: the body sticks, a \
                              spring holds it, or the position is read too coarsely to show an acceleration. Let the \
                              input jump further, and sample the run-up finely.";

/// Where the output of a process follows the input, but not as a first-order lag and the library would have it.
const NOT_AS_A_LAG: &str = "The output follows the input, but not as a first-order lag would.";

/// Where a process did too little to tell what its input does.
const TOO_LITTLE: &str = "This record does not show what the input does to the output: it may cause all of the \
                          motion, or none of it. Change the input more strongly or more often, and record until the \
                          output has settled.";

/// Inertia and viscous friction, each with its error, in the calmer half of the windows of the width that tells the
/// inertia best: what acts at times only, such as a stop, does not hide there what the input does. None where no width
/// tells it.
pub(super) fn body_while_calm(signals: &Signals, widths: &[Width]) -> Option<[(f64, f64); 2]> {
    let jerk = |k: usize| {
        let v = &signals.speed;
        (v[k + 1] - 2.0 * v[k] + v[k - 1]).abs()
    };
    let bodies = widths.iter().filter_map(|width| {
        let violence: Vec<f64> = width
            .starts
            .iter()
            .map(|k| (k + 1..k + width.length).map(jerk).fold(0.0, f64::max))
            .collect();
        let middle = median(&mut violence.clone());
        let weights: Vec<f64> = violence
            .iter()
            .map(|v| f64::from(u8::from(*v <= middle)))
            .collect();
        let input: Vec<f64> = width.integrals(&signals.input, 0).collect();
        let columns = [input, width.motion(signals, 2), width.motion(signals, 1)];
        let blocks = width.starts.iter().map(|k| k * BLOCKS / signals.len());
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let gram = Gram::new(&columns, &weights, &blocks.collect::<Vec<_>>());
        let fit = Fit::new(&gram, &[vec![ACCELERATION], vec![VELOCITY], vec![INPUT]]);
        let body = fit.map(|fit| [0, 1].map(|k| (fit.w[k], fit.error(k))))?;
        (body[0].0 > TOLD * body[0].1).then_some(body)
    });
    bodies.min_by(|a, b| (a[0].1 / a[0].0).total_cmp(&(b[0].1 / b[0].0)))
}

/// Whether the input changes in fewer blocks of the record than the body has numbers: one step says too little to test
/// whether the output follows it.
fn changes_seldom(signals: &Signals, bench: &Bench) -> bool {
    let input = &signals.input;
    let changes = (1..input.len()).filter(|i| input[*i] != input[i - 1]);
    let mut blocks: Vec<usize> = changes.map(|i| i * BLOCKS / input.len()).collect();
    blocks.dedup();
    let numbers = bench.elements(&[]).len() - 1;
    blocks.len() < numbers
}

/// Whether the input of a process, with an effect as far from the one found as chance may put it, would make as much of
/// the rate of the output as there is.
fn may_explain(bench: &Bench) -> bool {
    let Some(fit) = Fit::new(bench.gram, &bench.elements(&[])) else {
        return true;
    };
    let (sums, size) = (bench.gram.sum(|_| true), bench.gram.size);
    let about_mean =
        |k: usize| sums[k * size + k] - sums[k * size + ONE].powi(2) / sums[ONE * size + ONE];
    let most = fit.w[0].abs() + CHANCE * fit.error(0);
    most * most * about_mean(INPUT) > about_mean(ACCELERATION)
}

fn closed(made: &Controller, explained: bool) -> Message {
    let Controller {
        law,
        kind,
        explained: share,
        ..
    } = made;
    let plant = if explained {
        "What is said about the plant comes from how the output moves under this input, which is valid in a closed \
         loop too."
    } else {
        "This record shows only what the controller does: it says nothing about the plant. Change the set point or \
         add steps to the input."
    };
    let share = 100.0 * share;
    msg!(
        "The loop was closed: a {} controller made the input, {}, which explains {} % of its variance.",
        kind,
        law,
        fixed(share, 1)
    ).and(plant)
}

/// What the best subset leaves with the sign of the input turned.
fn turned(signals: &Signals, widths: &[Width]) -> Option<f64> {
    let mut other = signals.clone();
    other.input.iter_mut().for_each(|u| *u = -*u);
    let prepared = Prepared::new(&other, widths, &[]);
    let bench = prepared.bench();
    let tried = bench.all();
    (!tried.is_empty()).then(|| left(&bench, &tried))
}

/// Whether friction explains the input, at speeds that hardly change.
fn not_told(signals: &Signals, bench: &Bench) -> Option<Message> {
    let fit = Fit::new(bench.gram, &bench.elements(&[]))?;
    let told = fit.w[0].abs() > TOLD * fit.error(0);
    if told {
        return None;
    }
    let (inertia, error) = (fit.w[0], fit.error(0));
    let noise = signals.velocity.as_ref().map_or(0.0, |v| v.noise);
    let rests = signals.moving.iter().sum::<f64>() < 0.05 * signals.len() as f64
        || super::signals::rms(&signals.speed) <= 2.0 * noise;
    let sums = bench.gram.sum(|_| true);
    let at = |i: usize, j: usize| sums[i * bench.gram.size + j];
    // The input by speed and a constant alone.
    let elements = vec![vec![VELOCITY], vec![ONE], vec![INPUT]];
    let reduced = Reduced::new(&sums, bench.gram.size, &elements);
    let w = reduced.coefficients(&reduced.solve(true)?);
    let steady = reduced.loss(&w) < 0.1 * at(INPUT, INPUT);
    if rests {
        return Some("The drive is at rest: this record does not show its inertia.".into());
    }
    let changes = at(ACCELERATION, ACCELERATION) > 0.0;
    (steady && changes).then(|| {
        msg!(
            "This record does not determine the inertia ({} with an error of {}): apart from noise, the speed hardly \
             changes. It does show friction. Let the input jump, and sample the run-up.",
            brief(inertia),
            digits(error, 2)
        )
    })
}

/// A delay with which the input explains half of what it leaves now.
fn late(signals: &Signals, widths: &[Width], left: f64) -> Option<f64> {
    let width = widths.last()?;
    let longest = (signals.len() as f64 * LATEST) as usize;
    let acceleration = width.motion(signals, 2);
    let velocity = width.motion(signals, 1);
    let tried = (1..=LATE).filter_map(|k| {
        let back = longest * k / LATE;
        let input: Vec<f64> = (0..signals.len())
            .map(|i| signals.input[i.saturating_sub(back)])
            .collect();
        let column: Vec<f64> = width.integrals(&input, 0).collect();
        let one: Vec<f64> = width.integrals(&vec![1.0; signals.len()], 0).collect();
        let columns = [&column, &velocity, &one, &acceleration];
        let mut values = vec![0.0; 16];
        for i in 0..4 {
            for j in 0..4 {
                values[4 * i + j] = columns[i].iter().zip(columns[j]).map(|(a, b)| a * b).sum();
            }
        }
        let reduced = Reduced { order: 3, values };
        let w = reduced.coefficients(&reduced.solve(false)?);
        let of_all = (reduced.loss(&w) / reduced.square(3).max(f64::MIN_POSITIVE)).sqrt();
        Some((of_all, back as f64 * signals.step))
    });
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 < 0.5 * left.min(1.0)).then_some(best.1)
}
