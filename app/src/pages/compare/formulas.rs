//! What a search for a formula says: how far it is, the formulas by their length, and what would tell them apart.

use egui_plot::{HLine, Line, LineStyle, MarkerShape, PlotPoints, Points};
use hysteron_core::diagnosis::{Discovery, FoundFormula, Program};
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::uncertain::{brief, with_error};

use super::command::Command;
use super::experiment::{save_ui, trials_ui};
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Chart, Shape, caption_ui, span_decades};
use crate::widgets::equation::{equation_ui, sentence_ui};

/// Formulas with their parameters, and rows of others, at most.
const MOST: usize = 4;
const MOST_OTHERS: usize = 6;

/// Height of the plot, and width of its labels of y, points.
const HEIGHT: f32 = 150.0;
const AXIS_WIDTH: f32 = 60.0;

impl Compare {
    /// The search, or what it found.
    pub(super) fn formulas_ui(
        &self,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        if let Some(searching) = &self.unknown.searching {
            ui.strong(tr("The formula of the unknown"));
            ui.label(tr(
                "No effect in the library explains what is left: searching for a formula.",
            ));
            ui.horizontal(|ui| {
                let width = ui.available_width() - theme::button_width(ui, "Cancel");
                let (share, text) = &searching.progress;
                let bar = egui::ProgressBar::new(*share as f32).desired_width(width);
                ui.add(bar.text(tr(text)));
                let cancel = ui.button(tr("Cancel"));
                targets.note("discover:cancel", ui, &cancel);
                if cancel.clicked() {
                    commands.push(Command::Discover(false));
                }
            });
        } else if let Some(discovery) = self.discovery() {
            ui.strong(tr("The formula of the unknown"));
            let known = discovery.formulas.iter().map(|f| f.formula.as_str());
            sentence_ui(ui, &tr(&discovery.text), &known.collect::<Vec<_>>());
            if !discovery.formulas.is_empty() {
                self.class_ui(discovery, ui, targets, commands);
                front_ui(discovery, ui);
                self.others_ui(discovery, ui, targets, commands);
                self.apart_ui(discovery, ui, targets, commands);
            }
        } else if self.may_discover() {
            let look = ui
                .add_enabled(
                    self.job.is_none(),
                    egui::Button::new(tr("Look for a formula")),
                )
                .on_hover_text(tr(
                    "Tries sums of up to three terms in the equation of motion; it takes a minute",
                ));
            targets.note("discover", ui, &look);
            if look.clicked() {
                commands.push(Command::Discover(true));
            }
        } else {
            return;
        }
        ui.separator();
    }

    /// The answer and what this record cannot tell from it, with their parameters.
    fn class_ui(
        &self,
        discovery: &Discovery,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        for formula in discovery.class().take(MOST) {
            egui::Frame::group(ui.style()).show(ui, |ui| {
                ui.set_width(ui.available_width());
                self.row_ui(formula, ui, targets, commands);
                for p in &formula.parameters {
                    ui.horizontal_wrapped(|ui| {
                        equation_ui(ui, &p.name, &|_| None);
                        ui.label(tr(msg!("= {}", with_error(p.value, p.std_error, &p.unit))));
                        if p.is_told() && p.std_error > 0.0 {
                            ui.weak(tr(msg!("95 %: {}", p.interval())));
                        }
                    });
                }
            });
        }
    }

    /// A formula, what it leaves, and the button that adds it.
    fn row_ui(
        &self,
        formula: &FoundFormula,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        let symbol = self.force_symbol();
        ui.horizontal_wrapped(|ui| {
            let title = tr(msg!("Add {}", Message::name(&formula.name)));
            let add = ui
                .add_enabled(self.job.is_none(), egui::Button::new(title))
                .on_hover_text(tr("Add this force and fit it"));
            targets.note(format!("discovered:{}", formula.name), ui, &add);
            if add.clicked() {
                commands.extend(self.adding(formula));
            }
            equation_ui(ui, &format!("{symbol} = {}", formula.formula), &|_| None);
            let left = tr(msg!("leaves {} × noise", brief(formula.error)));
            ui.label(egui::RichText::new(left).strong());
        });
    }

    /// The rest of the front.
    fn others_ui(
        &self,
        discovery: &Discovery,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        let others: Vec<&FoundFormula> = discovery.front().filter(|f| !f.in_class).collect();
        if others.is_empty() {
            return;
        }
        let title = match discovery.answer {
            Some(_) => "Shorter and longer formulas",
            None => "The best formula of each length",
        };
        ui.collapsing(tr(title), |ui| {
            for formula in others.into_iter().take(MOST_OTHERS) {
                self.row_ui(formula, ui, targets, commands);
            }
        });
    }

    /// The experiment that tells the class apart.
    fn apart_ui(
        &self,
        discovery: &Discovery,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        let Some(experiment) = &discovery.experiment else {
            return;
        };
        let index = self.proposals().count() - 1;
        egui::Frame::group(ui.style()).show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.strong(tr("Try this experiment"));
            ui.label(tr(&experiment.text));
            if experiment.sufficient && !matches!(experiment.program, Program::Relay { .. }) {
                save_ui(index, ui, targets, commands);
            }
            trials_ui(index, experiment, ui);
        });
    }
}

/// Error against length: all that were tried, and the front.
fn front_ui(discovery: &Discovery, ui: &mut egui::Ui) {
    let errors = discovery.formulas.iter().map(|f| f.error);
    let decades = span_decades(errors.chain([discovery.before, 1.0]));
    let scaled = |error: f64| if decades { error.log10() } else { error };
    let at = |f: &FoundFormula| [f.length as f64, scaled(f.error)];
    let tried: Vec<[f64; 2]> = discovery.formulas.iter().map(at).collect();
    let class: Vec<[f64; 2]> = discovery.class().map(at).collect();
    let mut line = vec![[0.0, scaled(discovery.before)]];
    line.extend(discovery.front().map(at));
    let mut curves = vec![
        ("tried", theme::RESIDUAL, Shape::Circle),
        ("least error for its length", theme::MODEL, Shape::Line),
        ("noise", theme::NOISE, Shape::Dashes),
    ];
    match class.len() {
        0 => {}
        1 => curves.push(("the answer", theme::MEASURED, Shape::Diamond)),
        _ => curves.push(("cannot be told apart", theme::MEASURED, Shape::Diamond)),
    }
    caption_ui(ui, "", &curves);
    let axes = ["length of the formula", "error [× noise]"];
    let mut chart = Chart::new("formulas", axes, HEIGHT, AXIS_WIDTH).still();
    if decades {
        chart = chart.decades_up();
    }
    chart.show(ui, |plot| {
        let noise = HLine::new(tr("noise"), scaled(1.0)).color(theme::NOISE);
        plot.hline(noise.style(LineStyle::dashed_dense()));
        plot.line(
            Line::new(tr("least error for its length"), PlotPoints::from(line))
                .color(theme::MODEL)
                .width(1.5),
        );
        plot.points(
            Points::new(tr("tried"), PlotPoints::from(tried))
                .color(theme::RESIDUAL)
                .radius(3.0),
        );
        plot.points(
            Points::new(tr("the answer"), PlotPoints::from(class))
                .color(theme::MEASURED)
                .shape(MarkerShape::Diamond)
                .radius(6.0),
        );
    });
    ui.small(tr(
        "Every formula that was simulated, by the names, numbers and signs in it; the line joins those that leave \
         least for their length.",
    ));
}
