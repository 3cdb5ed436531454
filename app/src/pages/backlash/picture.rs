//! The two masses and the gap between them, drawn.

use egui::{Align2, Color32, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};

use super::plots::{CONTACT, LOAD};
use super::scene::Scene;
use crate::language::{tr, tr_number};
use crate::theme;
use crate::widgets::chart::round_step;

/// Share of the width that the gap takes at least.
const LEAST_GAP: f64 = 0.12;

/// From the top of the walls to the middle of the words, above the arrow, points.
const WORDS: f32 = 18.0;

/// Half width of the motor's peg and width of the load's walls, points.
const PEG: f32 = 26.0;
const WALL: f32 = 34.0;

/// Distance from an end that counts as touching, as a share of the gap.
const TOUCHING: f64 = 0.004;

/// Draws motor and load at a time; the view stands still if the whole travel fits.
pub fn ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    let (rect, _) =
        ui.allocate_exact_size(vec2(ui.available_width(), height), egui::Sense::hover());
    let Some(now) = scene.now(clock) else {
        return;
    };
    let painter = ui.painter_at(rect);
    let x1 = now.x1;
    let view = View::new(rect, scene, now.x2.unwrap_or(x1));
    view.ruler(&painter, ui);
    let middle = rect.center().y - 8.0;
    let (top, bottom) = (rect.top() + 6.0, rect.bottom() - 34.0);
    let text = |at: Pos2, text: &'static str| {
        let font = theme::letters(ui, 13.0);
        painter.text(at, Align2::CENTER_CENTER, tr(text), font, Color32::BLACK);
    };

    // The load: a yoke whose walls stand a half gap and the peg away from its middle.
    if let (Some(x2), Some(beta)) = (now.x2, scene.half_gap()) {
        let [low, high] = [view.at(x2 - beta) - PEG, view.at(x2 + beta) + PEG];
        let near = |distance: f64| distance < 2.0 * TOUCHING * beta;
        for (wall, touches) in [
            (low - WALL..=low, near(x1 - x2 + beta)),
            (high..=high + WALL, near(beta - (x1 - x2))),
        ] {
            let wall = Rect::from_x_y_ranges(wall, top..=bottom);
            painter.rect_filled(wall, 3.0, if touches { CONTACT } else { LOAD });
            text(wall.center_top() + vec2(0.0, WORDS), "load");
        }
        let beam = Rect::from_x_y_ranges(low - WALL..=high + WALL, bottom..=bottom + 9.0);
        painter.rect_filled(beam, 3.0, LOAD);
    }

    // The motor: a peg between them, with its torque.
    let x = view.at(x1);
    let peg = Rect::from_x_y_ranges(x - PEG..=x + PEG, top + 8.0..=bottom - 6.0);
    painter.rect_filled(peg, 5.0, theme::MEASURED);
    if scene.strongest > 0.0 {
        let length = (60.0 * now.torque / scene.strongest) as f32;
        painter.arrow(
            pos2(x, middle),
            vec2(length, 0.0),
            Stroke::new(4.0, theme::INPUT),
        );
    }
    text(pos2(x, top + WORDS), "motor");
}

/// From mrad to points.
struct View {
    rect: Rect,
    /// mrad in the middle, and points in a mrad.
    middle: f64,
    scale: f64,
}

impl View {
    fn new(rect: Rect, scene: &Scene, x2: f64) -> Self {
        let beta = scene.half_gap().unwrap_or(1.0);
        let [low, high] = scene.range;
        // The walls are drawn outside of the places that they stand at.
        let margin = PEG + WALL + 8.0;
        let width = f64::from((rect.width() - 2.0 * margin).max(50.0));
        let span = (high - low) + 2.0 * beta;
        let least = LEAST_GAP * width / (2.0 * beta).max(1e-9);
        let fits = width / span.max(1e-9);
        let (middle, scale) = if fits >= least {
            (0.5 * (low + high), fits)
        } else {
            (x2, least)
        };
        Self {
            rect,
            middle,
            scale,
        }
    }

    fn at(&self, x: f64) -> f32 {
        self.rect.center().x + (self.scale * (x - self.middle)) as f32
    }

    /// A ruler beneath, so that motion can be seen where the view follows it.
    fn ruler(&self, painter: &Painter, ui: &Ui) {
        let width = f64::from(self.rect.width());
        let step = round_step(80.0 / self.scale);
        let first = ((self.middle - 0.5 * width / self.scale) / step).ceil();
        let color = ui.visuals().text_color();
        let font = theme::letters(ui, 11.0);
        let y = self.rect.bottom() - 1.3 * font.size - 5.0;
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let mut named = false;
        for k in 0..40 {
            let x = (first + f64::from(k)) * step;
            let at = self.at(x);
            if at > self.rect.right() {
                break;
            }
            painter.line_segment([pos2(at, y), pos2(at, y + 5.0)], Stroke::new(1.0, color));
            let unit = if named { "" } else { " mrad" };
            let label = painter.layout_no_wrap(
                tr_number(format!("{x:.decimals$}")) + unit,
                font.clone(),
                color,
            );
            let half = 0.5 * label.size().x;
            // One at an end would be cut.
            if at - half >= self.rect.left() && at + half <= self.rect.right() {
                painter.galley(pos2(at - half, y + 5.0), label, color);
                named = true;
            }
        }
    }
}
