//! Fig. 8: the two-mass structure as a block diagram whose blocks light up by mode, with the distance in the gap and
//! the momentum of equation (11) over time.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, Ui, pos2, vec2};
use egui_plot::{HLine, Line, LineStyle, VLine};
use hysteron_core::drive::{DriveMode, Instant, Side};

use super::plots::{CONTACT, LOAD, moment};
use super::scene::{Now, Scene};
use super::units::MILLI;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, still};

/// Height of the diagram, points.
pub const HEIGHT: f32 = 150.0;

/// Periods of the relay before the present moment that are drawn over time.
const PERIODS: f64 = 6.0;

/// Share of a period for which an impact lights up.
const FLASH: f64 = 0.2;

/// Middle of each block and of both sums, and half the width of a block and of an integrator, as shares of the width.
const RELAY: f32 = 0.065;
const FORCES: f32 = 0.165;
const MOTOR: f32 = 0.27;
const TO_X1: f32 = 0.395;
const DISTANCE: f32 = 0.485;
const PLAY: f32 = 0.60;
const DRIVEN: f32 = 0.765;
const TO_X2: f32 = 0.895;
const HALF: f32 = 0.06;
const NARROW: f32 = 0.028;

/// Length of the head of an arrow, points.
const HEAD: f32 = 7.0;

/// Room that a word in a block leaves on both sides of it, points.
const MARGIN: f32 = 4.0;

/// The drawing, in shares of its width and points of height about its middle.
struct Diagram<'a> {
    painter: &'a Painter,
    rect: Rect,
    line: Stroke,
    font: FontId,
}

impl Diagram<'_> {
    fn at(&self, x: f32, y: f32) -> Pos2 {
        pos2(
            self.rect.left() + x * self.rect.width(),
            self.rect.center().y + y,
        )
    }

    /// An arrow whose head is as large as all others.
    fn point(&self, from: Pos2, to: Pos2) {
        let along = HEAD * (to - from).normalized();
        self.painter.line_segment([from, to], self.line);
        for side in [0.5, -0.5] {
            let barb = to - along + side * along.rot90();
            self.painter.line_segment([to, barb], self.line);
        }
    }

    fn arrow(&self, from: f32, to: f32, name: &'static str) {
        let (a, b) = (self.at(from, 0.0), self.at(to, 0.0));
        self.point(a, b);
        if name.is_empty() {
            return;
        }
        self.say(a + 0.45 * (b - a) + vec2(0.0, -9.0), name, self.line.color);
    }

    /// A way back, from behind one block to another at this height.
    fn back(&self, from: f32, to: f32, y: f32, end: f32, name: &'static str) {
        let corners = [
            self.at(from, 0.0),
            self.at(from, y),
            self.at(to, y),
            self.at(to, end),
        ];
        self.painter.line(corners[..3].to_vec(), self.line);
        self.point(corners[2], corners[3]);
        let middle = corners[1] + 0.5 * (corners[2] - corners[1]);
        self.say(middle + vec2(0.0, -8.0), name, self.line.color);
    }

    fn say(&self, at: Pos2, text: &'static str, color: Color32) {
        let font = self.font.clone();
        self.painter
            .text(at, Align2::CENTER_CENTER, tr(text), font, color);
    }

    fn frame(&self, x: f32, half: f32, fill: Color32) -> Rect {
        let middle = self.at(x, 0.0);
        let rect = Rect::from_center_size(middle, vec2(2.0 * half * self.rect.width(), 46.0));
        self.painter
            .rect(rect, 4.0, fill, self.line, StrokeKind::Middle);
        rect
    }

    /// A block with its name and, where that has room, its mode; it is lit while it acts.
    fn block(&self, x: f32, [name, mode]: [&'static str; 2], color: Color32, lit: bool) {
        let frame = self.frame(x, HALF, faint(color, lit));
        let text = if lit { Color32::BLACK } else { self.line.color };
        let mode = self
            .painter
            .layout_no_wrap(tr(mode), self.font.clone(), text);
        if mode.size().x + 2.0 * MARGIN > frame.width() {
            return self.say(self.at(x, 0.0), name, text);
        }
        self.say(self.at(x, -9.0), name, text);
        let corner = self.at(x, 9.0) - 0.5 * mode.size();
        self.painter.galley(corner, mode, text);
    }

    fn integrator(&self, x: f32) {
        self.frame(x, NARROW, Color32::TRANSPARENT);
        self.say(self.at(x, 0.0), "1/s", self.line.color);
    }

    /// A sum, from which what comes back is taken; `below`: it comes from there.
    fn sum(&self, x: f32, below: bool) {
        let middle = self.at(x, 0.0);
        self.painter.circle_stroke(middle, 7.0, self.line);
        let y = if below { 14.0 } else { -14.0 };
        self.say(middle + vec2(10.0, y), "−", self.line.color);
    }

    /// The play: no force in the gap, and where the masses are now.
    fn play(&self, now: &Now, half_gap: f64, mode: &DriveMode, impact: bool) {
        let lit = impact || mode.pressed.is_some();
        let frame = self.frame(PLAY, HALF + 0.01, faint(CONTACT, lit));
        let color = if lit { Color32::BLACK } else { self.line.color };
        let reach = (0.42 * frame.width(), 0.32 * frame.height());
        let middle = frame.center();
        // Its characteristic, with the gap in the middle half.
        let corners = [(-1.0, 1.0), (-0.5, 0.0), (0.5, 0.0), (1.0, -1.0)];
        let line = corners.map(|(x, y)| middle + vec2(x * reach.0, y * reach.1));
        self.painter.line(line.to_vec(), Stroke::new(1.5, color));
        if let Some(x2) = now.x2 {
            let share = (0.5 * (now.x1 - x2) / half_gap.max(f64::MIN_POSITIVE)) as f32;
            let beyond = (share.abs() - 0.5).max(0.0) * share.signum();
            let dot = vec2(
                share.clamp(-1.0, 1.0) * reach.0,
                (-2.0 * beyond).clamp(-1.0, 1.0) * reach.1,
            );
            self.painter.circle_filled(middle + dot, 4.0, theme::INPUT);
        }
        let words = match (impact, mode.pressed) {
            (_, Some(Side::Upper)) => "pushes up",
            (_, Some(Side::Lower)) => "pushes down",
            (true, None) => "impact",
            (false, None) => "open gap",
        };
        self.say(frame.center_top() + vec2(0.0, -9.0), words, self.line.color);
    }
}

fn faint(color: Color32, lit: bool) -> Color32 {
    if lit {
        color
    } else {
        color.gamma_multiply(0.15)
    }
}

/// The block diagram at a time.
pub fn ui(ui: &mut Ui, scene: &Scene, clock: f64) {
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let (Some(now), Some(half_gap)) = (scene.now(clock), scene.half_gap()) else {
        return;
    };
    let mode = scene.run.mode_at(clock);
    let impact = mode
        .met
        .is_some_and(|(_, ago)| ago < FLASH * scene.period());
    let painter = ui.painter_at(rect);
    let diagram = Diagram {
        painter: &painter,
        rect,
        line: Stroke::new(1.2, ui.visuals().text_color()),
        font: theme::letters(ui, 13.0),
    };
    diagram.arrow(RELAY + HALF, FORCES - 0.012, "u");
    diagram.arrow(FORCES + 0.012, MOTOR - HALF, "");
    diagram.arrow(MOTOR + HALF, TO_X1 - NARROW, "");
    diagram.arrow(TO_X1 + NARROW, DISTANCE - 0.012, "x1");
    diagram.arrow(DISTANCE + 0.012, PLAY - HALF - 0.01, "d");
    diagram.arrow(PLAY + HALF + 0.01, DRIVEN - HALF, "");
    diagram.arrow(DRIVEN + HALF, TO_X2 - NARROW, "v2");
    diagram.arrow(TO_X2 + NARROW, 0.985, "");
    diagram.back(MOTOR + HALF + 0.015, RELAY, -52.0, -25.0, "v1");
    diagram.back(TO_X2 + NARROW + 0.02, DISTANCE, -60.0, -9.0, "x2");
    diagram.back(PLAY + HALF + 0.03, FORCES, 48.0, 9.0, "F");
    let up = now.torque > 0.0;
    let pushes = if up { "pushes up" } else { "pushes down" };
    diagram.block(RELAY, ["relay", pushes], theme::INPUT, up);
    for (x, name, color, rests) in [
        (MOTOR, "motor", theme::MEASURED, mode.motor_rests),
        (DRIVEN, "load", LOAD, mode.load_rests),
    ] {
        let words = if rests { "rests" } else { "moves" };
        diagram.block(x, [name, words], color, !rests);
    }
    diagram.integrator(TO_X1);
    diagram.integrator(TO_X2);
    diagram.sum(FORCES, true);
    diagram.sum(DISTANCE, false);
    diagram.play(&now, half_gap, &mode, impact);
}

/// What the last periods before a time looked like.
fn lately(scene: &Scene, clock: f64) -> Vec<Instant> {
    let span = PERIODS * scene.period();
    let to = clock.max(span);
    let drive = scene.input().map(|i| i.drive);
    drive.map_or_else(Vec::new, |d| scene.run.instants(&d, to - span, to))
}

/// The distance in the gap over time.
pub fn distance_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    let curves = [
        ("d = x1 - x2", theme::MEASURED, Shape::Line),
        ("ends of the gap", CONTACT, Shape::Dashes),
    ];
    caption_ui(ui, "Distance d", &curves);
    let points: Vec<[f64; 2]> = lately(scene, clock)
        .iter()
        .map(|i| [i.time, MILLI * i.distance])
        .collect();
    let chart = still("distance", "time [s]", "distance d [mrad]", height).linked(moment());
    chart.show(ui, |plot| {
        plot.line(
            Line::new(tr("d = x1 - x2"), curve(&points))
                .color(theme::MEASURED)
                .width(2.0),
        );
        for side in [-1.0, 1.0] {
            if let Some(beta) = scene.half_gap() {
                plot.hline(
                    HLine::new(tr("ends of the gap"), side * beta)
                        .color(CONTACT)
                        .style(LineStyle::dashed_dense()),
                );
            }
        }
        plot.vline(VLine::new(tr("now"), clock).color(theme::INPUT).width(1.0));
    });
}

/// Both momenta and their sum, which no impact changes.
pub fn momentum_ui(ui: &mut Ui, scene: &Scene, clock: f64, height: f32) {
    let all = lately(scene, clock);
    let curves = [
        ("J1 v1", theme::MEASURED, Shape::Line),
        ("J2 v2", LOAD, Shape::Line),
        ("sum, eq. (11)", theme::RESIDUAL, Shape::Line),
    ];
    caption_ui(ui, "Momentum", &curves);
    let chart = still("momentum", "time [s]", "momentum [mN m s]", height).linked(moment());
    chart.show(ui, move |plot| {
        let values: [fn(&Instant) -> f64; 3] = [|i| i.motor, |i| i.load, Instant::momentum];
        for ((name, color, _), value) in curves.into_iter().zip(values) {
            let points: Vec<[f64; 2]> = all.iter().map(|i| [i.time, MILLI * value(i)]).collect();
            let line = Line::new(tr(name), curve(&points)).color(color);
            plot.line(line.width(2.0));
        }
        plot.vline(VLine::new(tr("now"), clock).color(theme::INPUT).width(1.0));
    });
}
