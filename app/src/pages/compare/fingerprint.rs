//! What an effect would leave if it were what is missing, beside what is left.

use egui_plot::{Line, LineStyle};
use hysteron_core::diagnosis::{Fingerprint, Profile, StepReport};
use hysteron_core::effect::{self, EffectId, name_of};
use hysteron_core::measurement::Measurement;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::uncertain::titled;

use super::atlas::{draw, grid_ui, small, words};
use super::command::Command;
use super::parts::Part;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::{Chart, Shape, caption_ui};

/// Height of a plot over time, and width of its labels, points.
const HEIGHT: f32 = 170.0;
const AXIS_WIDTH: f32 = 90.0;

/// Likeness from which a fingerprint is the same at a glance, and from which it resembles.
const SAME: f64 = 0.9;
const ALIKE: f64 = 0.5;

/// What the word says, where it first stands.
pub(super) const FINGERPRINT: &str =
    "A fingerprint is the residual that an effect would leave if it were missing.";

/// With what its effect is in a sentence, since its name alone may say nothing yet.
pub(super) fn explained(button: egui::Response, id: EffectId) -> egui::Response {
    match effect::find(id) {
        Some(effect) => button.on_hover_text(tr(effect.sentence())),
        None => button,
    }
}

pub(super) fn ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let (Some(report), Some(measurement)) = (page.report_in(Part::Plots), &page.measurement) else {
        return;
    };
    let Some(chosen) = page.chosen() else {
        ui.label(tr("No effect was tried on top of this model."));
        return;
    };
    ui.horizontal_wrapped(|ui| {
        ui.label(tr("Effect:"));
        let by_name = Compare::prints(report);
        let ranked = report.fingerprints.iter().map(|print| print.effect);
        let guessing = page.is_guessing();
        let effects = if guessing { by_name } else { ranked.collect() };
        for id in effects {
            let mut prints = report.fingerprints.iter();
            let likeness = prints.find(|p| p.effect == id).map_or(0.0, |p| p.likeness);
            let label = if guessing {
                tr(name_of(id))
            } else {
                format!("{} {}", tr(name_of(id)), tr_number(two_digits(likeness)))
            };
            let button = explained(ui.selectable_label(id == chosen, label), id);
            targets.note(format!("print:{id}"), ui, &button);
            if button.clicked() {
                commands.push(Command::Fingerprint(id));
            }
        }
    });
    let Some(print) = report.fingerprints.iter().find(|f| f.effect == chosen) else {
        return;
    };
    if !page.is_guessing() {
        ui.label(tr(sentence(print)));
    }
    ui.small(tr(FINGERPRINT));
    let name = msg!("what {} would leave", name_of(chosen));
    caption_ui(
        ui,
        "Residual",
        &[
            ("what is left".into(), theme::RESIDUAL, Shape::Line),
            (name, theme::INPUT, Shape::Dashes),
        ],
    );
    time_ui(measurement, report, print, ui);
    ui.label(tr("The mean along each axis, in units of the noise"));
    let profiles: Vec<&Profile> = print.profiles.iter().collect();
    grid_ui(&profiles, ui, |profile, ui| {
        let output = measurement.outputs.get(profile.output);
        let output = output.map_or("", |c| c.name.as_str());
        ui.label(tr(msg!(
            "{} against {}",
            Message::name(output),
            words(&profile.axis)
        )));
        profile_ui(report, profile, ui);
    });
}

/// A likeness with two digits; what is next to none has no sign.
fn two_digits(likeness: f64) -> String {
    format!("{:.2}", (100.0 * likeness).round() / 100.0 + 0.0)
}

/// How alike, in words.
fn sentence(print: &Fingerprint) -> Message {
    let name = name_of(print.effect);
    let alike = two_digits(print.likeness);
    if print.likeness >= SAME {
        msg!(
            "The residual looks like {}: similarity {}, where 1 is identical.",
            name,
            alike
        )
    } else if print.likeness >= ALIKE {
        msg!(
            "{} explains part of the residual: similarity {}, where 1 is identical.",
            name,
            alike
        )
    } else {
        msg!(
            "The residual does not look like {}: similarity {}, where 1 is identical.",
            name,
            alike
        )
    }
}

/// The stretch of the strongest finding, over each other for each output.
fn time_ui(measurement: &Measurement, report: &StepReport, print: &Fingerprint, ui: &mut egui::Ui) {
    for (index, series) in print.would_leave.iter().enumerate() {
        let (Some(output), Some(modelled)) = (
            measurement.outputs.get(index),
            report.replay.channels.get(index),
        ) else {
            continue;
        };
        let times = measurement.time.iter().skip(print.from);
        let left = output
            .values
            .iter()
            .zip(&modelled.modelled)
            .skip(print.from);
        let would: Vec<[f64; 2]> = times.clone().zip(series).map(|(t, v)| [*t, *v]).collect();
        let left: Vec<[f64; 2]> = times
            .zip(left)
            .take(series.len())
            .map(|(t, (y, m))| [*t, y - m])
            .collect();
        let label = titled(Message::name(output.title()), &output.unit);
        let id = format!("fingerprint {} {index}", print.effect);
        let axes = ["time [s]".into(), label];
        let linked = egui::Id::unique("fingerprint");
        let chart = Chart::new(id, axes, HEIGHT, AXIS_WIDTH).linked(linked);
        chart.show(ui, |plot| {
            plot.line(
                Line::new(tr("what is left"), left)
                    .color(theme::RESIDUAL)
                    .width(1.5),
            );
            plot.line(
                Line::new(tr("what it would leave"), would)
                    .color(theme::INPUT)
                    .style(LineStyle::dashed_loose())
                    .width(2.0),
            );
        });
    }
}

fn profile_ui(report: &StepReport, profile: &Profile, ui: &mut egui::Ui) {
    let mut all = report.atlas.iter();
    let left = all.find(|p| p.output == profile.output && p.axis == profile.axis);
    let id = format!("print {} {}", profile.output, profile.axis);
    small(id, profile, "mean [× noise]").show(ui, |plot| {
        if let Some(left) = left {
            let name = ("what is left", theme::RESIDUAL);
            draw(plot, left, |b| b.mean, name, |line| line.width(2.0));
        }
        let name = ("what it would leave", theme::INPUT);
        let dashed = |line: Line<'static>| line.style(LineStyle::dashed_loose()).width(2.0);
        draw(plot, profile, |b| b.mean, name, dashed);
    });
}
