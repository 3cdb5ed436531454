//! Where no effect explains the rest: what is missing, estimated without a model, and what it looks like.

use egui_plot::{HLine, Line, PlotPoints};
use hysteron_core::diagnosis::{MissingPart, StepReport};
use hysteron_core::message::Message;
use hysteron_core::uncertain::titled;
use hysteron_core::user_model::{Form, forms};

use super::command::Command;
use super::formula::Typed;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::Chart;

/// Estimates that are drawn.
const MOST: usize = 3;

/// Height of a plot beside the others, and of that in the middle of the page, points.
const HEIGHT: f32 = 130.0;
const TALL: f32 = 230.0;

impl Compare {
    /// The missing force that explains most, where nothing in the library fits.
    pub(super) fn missing(&self) -> Option<&MissingPart> {
        self.report()?.missing.first()
    }

    /// The simplest forms that it may have.
    pub(super) fn forms(&self) -> Vec<Form> {
        let part = self.measurement.as_ref().zip(self.missing());
        part.map_or_else(Vec::new, |(m, part)| forms(m.kind, part))
    }

    /// The missing force that explains most, in the middle of the page, with the simplest forms that it may have.
    pub(super) fn missing_ui(
        &self,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        let (Some(part), Some(measurement)) = (self.missing(), &self.measurement) else {
            return;
        };
        ui.strong(tr("What is missing, estimated without a model"));
        ui.label(tr(&part.text));
        let forms = self.forms();
        ui.horizontal_wrapped(|ui| {
            if !forms.is_empty() {
                ui.label(tr("It looks like:"));
            }
            for form in forms {
                let title = format!("{}: {}", tr(form.words), form.formula);
                let add = ui
                    .add_enabled(self.job.is_none(), egui::Button::new(title))
                    .on_hover_text(tr("Add this force and fit it"));
                targets.note(format!("form:{}", form.name), ui, &add);
                if add.clicked() {
                    commands.push(Command::AddOwn(Typed {
                        kind: measurement.kind,
                        name: self.free_name(form.name),
                        formula: form.formula,
                    }));
                }
            }
        });
        plot_ui(part, TALL, ui);
        ui.small(tr(
            "In steps along one axis, with bars of two standard errors.",
        ));
    }

    /// A name that no effect of the user's has yet.
    pub(super) fn free_name(&self, name: &str) -> String {
        let taken = |name: &str| {
            self.own
                .iter()
                .any(|line| line.starts_with(&format!("{name}:")))
        };
        let numbered = (2..).map(|n| format!("{name}_{n}"));
        let mut names = std::iter::once(name.to_owned()).chain(numbered);
        names.find(|name| !taken(name)).unwrap_or_default()
    }
}

/// Small plots of what else may be missing, the likeliest first.
pub(super) fn ui(report: &StepReport, ui: &mut egui::Ui) {
    if report.missing.len() < 2 {
        return;
    }
    ui.strong(tr("What else could be missing"));
    for part in report.missing.iter().take(MOST).skip(1) {
        ui.label(tr(&part.text));
        plot_ui(part, HEIGHT, ui);
    }
}

/// Width of the labels of y, so that the plots line up.
const AXIS_WIDTH: f32 = 60.0;

fn plot_ui(part: &MissingPart, height: f32, ui: &mut egui::Ui) {
    let size = part.parts.iter().map(|p| p.value.abs()).fold(0.0, f64::max);
    let (x, y) = (
        titled(Message::words(part.axis.clone()), &part.axis_unit),
        titled(Message::words(part.what.clone()), &part.unit),
    );
    let id = format!("missing {} {}", part.what, part.axis);
    let chart = Chart::new(id, [x, y], height, AXIS_WIDTH).still();
    chart.show(ui, |plot| {
        for p in &part.parts {
            // Bars that know nothing would squeeze the rest.
            let half = (2.0 * p.std_error).min(2.0 * size);
            let middle = 0.5 * (p.from + p.to);
            let bar = vec![[middle, p.value - half], [middle, p.value + half]];
            let step = vec![[p.from, p.value], [p.to, p.value]];
            let faint = theme::RESIDUAL.gamma_multiply(0.5);
            plot.line(Line::new("", PlotPoints::from(bar)).color(faint).width(1.5));
            plot.line(
                Line::new("", PlotPoints::from(step))
                    .color(theme::RESIDUAL)
                    .width(3.0),
            );
        }
        plot.hline(HLine::new("", 0.0).color(theme::NOISE).width(1.0));
    });
}
