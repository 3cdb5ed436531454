//! Where no effect explains the rest: what is missing, estimated without a model.

use egui_plot::{HLine, Line, PlotPoints};
use hysteron_core::diagnosis::{MissingPart, StepReport};
use hysteron_core::uncertain::titled;

use crate::language::tr;
use crate::theme;
use crate::widgets::chart::Chart;

/// Estimates that are drawn.
const MOST: usize = 3;

/// Height of a plot, points.
const HEIGHT: f32 = 130.0;

/// Small plots of what is missing, the likeliest first.
pub(super) fn ui(report: &StepReport, ui: &mut egui::Ui) {
    if report.missing.is_empty() {
        return;
    }
    ui.strong(tr("What is missing, estimated without a model"));
    for part in report.missing.iter().take(MOST) {
        ui.label(tr(&part.text));
        plot_ui(part, ui);
    }
    ui.small(tr(
        "Steps over one axis at a time, with bars of two standard errors.",
    ));
}

/// Width of the labels of y, so that the plots line up.
const AXIS_WIDTH: f32 = 60.0;

fn plot_ui(part: &MissingPart, ui: &mut egui::Ui) {
    let size = part.parts.iter().map(|p| p.value.abs()).fold(0.0, f64::max);
    let (x, y) = (
        titled(&part.axis, &part.axis_unit),
        titled(&part.what, &part.unit),
    );
    let id = format!("missing {} {}", part.what, part.axis);
    let chart = Chart::new(id, [x, y], HEIGHT, AXIS_WIDTH).still();
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
