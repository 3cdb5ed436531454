//! What stands above a plot: the names of its curves.

use crate::language::tr;
use crate::theme;
use hysteron_core::message::Message;

/// How a curve is drawn: its shape tells it where colours cannot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Line,
    Dashes,
    Diamond,
    Square,
    Circle,
    Cross,
    Area,
}

/// A curve in the caption of a plot.
pub type Key<N = &'static str> = (N, egui::Color32, Shape);

/// Size of a sample in a caption, points.
const SAMPLE: egui::Vec2 = egui::vec2(18.0, 10.0);

/// Names of the curves in their colours and shapes, above a plot: they hide nothing.
pub fn caption_ui<N: Clone + Into<Message>>(
    ui: &mut egui::Ui,
    title: &'static str,
    curves: &[Key<N>],
) {
    theme::running_text(ui, |ui| {
        if !title.is_empty() {
            ui.strong(tr(title));
        }
        for key in curves {
            let text = egui::RichText::new(tr(key.0.clone().into()));
            // A sample never stands at the end of a line without its name.
            let job = ui.painter().layout_no_wrap(
                text.text().to_owned(),
                egui::TextStyle::Body.resolve(ui.style()),
                egui::Color32::PLACEHOLDER,
            );
            let width = SAMPLE.x + ui.spacing().item_spacing.x + job.size().x;
            if width > ui.available_size_before_wrap().x && width < ui.max_rect().width() {
                ui.end_row();
            }
            sample_ui(ui, key.1, key.2);
            ui.label(text);
        }
    });
}

fn sample_ui(ui: &mut egui::Ui, color: egui::Color32, shape: Shape) {
    // As high as its name, so that all stand on one line.
    let height = ui.text_style_height(&egui::TextStyle::Body);
    let (place, _) = ui.allocate_exact_size(egui::vec2(SAMPLE.x, height), egui::Sense::hover());
    let rect = egui::Rect::from_center_size(place.center(), SAMPLE);
    let painter = ui.painter();
    let middle = rect.center();
    let bar = |from: f32, to: f32| {
        let x = |share: f32| rect.left() + share * rect.width();
        let half = egui::vec2(0.0, 2.0);
        let ends = [egui::pos2(x(from), middle.y), egui::pos2(x(to), middle.y)];
        painter.rect_filled(
            egui::Rect::from_min_max(ends[0] - half, ends[1] + half),
            1.0,
            color,
        );
    };
    match shape {
        Shape::Line => bar(0.0, 1.0),
        Shape::Dashes => {
            bar(0.0, 0.4);
            bar(0.6, 1.0);
        }
        Shape::Area => {
            painter.rect_filled(rect, 1.0, color.gamma_multiply(0.5));
        }
        Shape::Diamond => {
            let corners = [(-5.0, 0.0), (0.0, -5.0), (5.0, 0.0), (0.0, 5.0)];
            let points = corners.map(|(x, y)| middle + egui::vec2(x, y)).to_vec();
            painter.add(egui::Shape::convex_polygon(
                points,
                color,
                egui::Stroke::NONE,
            ));
        }
        Shape::Square => {
            let square = egui::Rect::from_center_size(middle, egui::Vec2::splat(8.0));
            painter.rect_filled(square, 0.0, color);
        }
        Shape::Circle => {
            painter.circle_filled(middle, 4.5, color);
        }
        Shape::Cross => {
            for side in [-4.0, 4.0] {
                let half = egui::vec2(4.0, side);
                painter.line_segment([middle - half, middle + half], (1.5, color));
            }
        }
    }
}
