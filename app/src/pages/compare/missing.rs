//! Where no effect explains the rest: what is missing, estimated without a model.

use egui_plot::{HLine, Line, Plot, PlotPoints, Polygon};
use hysteron_core::criticism::{MissingPart, StepReport};

use crate::theme;

/// Estimates that are drawn.
const MOST: usize = 3;

/// Height of a plot, points.
const HEIGHT: f32 = 130.0;

/// Small plots of what is missing, the likeliest first.
pub(super) fn ui(report: &StepReport, ui: &mut egui::Ui) {
    if report.missing.is_empty() {
        return;
    }
    ui.strong("What is missing, estimated without a model");
    for part in report.missing.iter().take(MOST) {
        ui.label(&part.text);
        plot_ui(part, ui);
    }
    ui.small("Steps over one axis at a time, with a band of two standard errors.");
}

fn plot_ui(part: &MissingPart, ui: &mut egui::Ui) {
    let label = |name: &str, unit: &str| {
        if unit == "1" {
            name.to_owned()
        } else {
            format!("{name} [{unit}]")
        }
    };
    let size = part.parts.iter().map(|p| p.value.abs()).fold(0.0, f64::max);
    Plot::new(("missing", &part.what, &part.axis))
        .height(HEIGHT)
        .x_axis_label(label(&part.axis, &part.axis_unit))
        .y_axis_label(label(&part.what, &part.unit))
        .y_axis_min_width(50.0)
        .allow_scroll(false)
        .allow_drag(false)
        .allow_zoom(false)
        .show(ui, |plot| {
            for p in &part.parts {
                // Bands that know nothing would squeeze the rest.
                let half = (2.0 * p.std_error).min(2.0 * size);
                let (low, high) = (p.value - half, p.value + half);
                let corners = vec![[p.from, low], [p.to, low], [p.to, high], [p.from, high]];
                let band = Polygon::new("", PlotPoints::from(corners));
                plot.polygon(
                    band.fill_color(theme::RESIDUAL.gamma_multiply(0.25))
                        .stroke(egui::Stroke::NONE),
                );
            }
            let ends = part
                .parts
                .iter()
                .flat_map(|p| [[p.from, p.value], [p.to, p.value]]);
            let line = Line::new("estimate", ends.collect::<PlotPoints>());
            plot.line(line.color(theme::RESIDUAL).width(2.0));
            plot.hline(HLine::new("", 0.0).color(theme::NOISE).width(1.0));
        });
}
