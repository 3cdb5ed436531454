//! What the bench does, drawn: it drives a motor or a valve, hides something on the way to the load or the tank,
//! and measures.

use std::f32::consts::TAU;

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};
use hysteron_core::measurement::Kind;
use hysteron_core::mystery::Experiment;
use hysteron_core::rig::process::STAIRS;

use crate::language::tr;
use crate::theme;

/// Height of the picture and its largest width, points.
const HEIGHT: f32 = 124.0;
const WIDEST: f32 = 900.0;

/// Points of a curve.
const POINTS: usize = 160;

/// Time constant of the tank, as a share of the record.
const TANK: f32 = 0.07;

/// Shares of the width: what drives it, the system, what is measured; the names in the drive need theirs.
const SHARES: [f32; 3] = [0.27, 0.46, 0.27];
const NARROW_SHARES: [f32; 3] = [0.21, 0.58, 0.21];
const NARROW: f32 = 500.0;

pub(super) fn ui(ui: &mut Ui, experiment: Experiment) {
    let size = vec2(ui.available_width().min(WIDEST), HEIGHT);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let pen = Pen {
        painter: ui.painter_at(rect),
        color: ui.visuals().text_color(),
        ground: ui.visuals().extreme_bg_color,
        names: theme::letters(ui, 13.0),
    };
    let mut left = rect.left();
    let shares = if rect.width() < NARROW {
        NARROW_SHARES
    } else {
        SHARES
    };
    let [cause, system, effect] = shares.map(|share| {
        let width = share * rect.width();
        let part = Rect::from_min_size(pos2(left, rect.top()), vec2(width, HEIGHT));
        left += width;
        part.shrink2(vec2(4.0, 4.0))
    });
    let push = curve(|t| push(experiment, t));
    let (names, answer) = match experiment.kind() {
        Kind::Drive => (["torque", "motor", "load", "velocity"], summed(&push)),
        Kind::Process => (["input", "valve", "tank", "output"], followed(&push)),
    };
    let [input, near, far, output] = names;
    pen.curve(cause, input, &push, theme::INPUT);
    pen.system(system, near, far);
    pen.curve(effect, output, &answer, theme::MEASURED);
}

struct Pen {
    painter: Painter,
    color: Color32,
    ground: Color32,
    names: FontId,
}

impl Pen {
    fn name(&self, at: Pos2, align: Align2, text: &'static str, color: Color32) {
        let font = self.names.clone();
        self.painter.text(at, align, tr(text), font, color);
    }

    /// A name, and a curve from -1 to 1 beneath it.
    fn curve(&self, rect: Rect, name: &'static str, values: &[f32], color: Color32) {
        self.name(rect.center_top(), Align2::CENTER_TOP, name, self.color);
        let frame = rect.with_min_y(rect.top() + 20.0);
        self.painter.rect_filled(frame, 4.0, self.ground);
        let (middle, half) = (frame.center().y, 0.42 * frame.height());
        let step = (frame.width() - 12.0) / (values.len().max(2) - 1) as f32;
        let at =
            |(i, v): (usize, &f32)| pos2(frame.left() + 6.0 + i as f32 * step, middle - v * half);
        let points = values.iter().enumerate().map(at).collect();
        self.painter
            .add(Shape::line(points, Stroke::new(2.0, color)));
    }

    /// Motor and load on a shaft, or valve and tank on a pipe, and what stands between them.
    fn system(&self, rect: Rect, near: &'static str, far: &'static str) {
        let middle = rect.center().y + 10.0;
        let end = 0.12 * rect.width();
        for (tip, from) in [
            (rect.left() + end, rect.left()),
            (rect.right(), rect.right() - end),
        ] {
            let stroke = Stroke::new(2.5, self.color);
            self.painter
                .arrow(pos2(from, middle), vec2(tip - from - 4.0, 0.0), stroke);
        }
        let inner = rect.shrink2(vec2(end, 0.0));
        let shaft = Rect::from_x_y_ranges(inner.x_range(), middle - 4.0..=middle + 4.0);
        self.painter.rect_filled(shaft, 0.0, Color32::GRAY);
        let side = 0.29 * inner.width();
        let block = |left: f32, width: f32, height: f32| {
            Rect::from_center_size(pos2(left + 0.5 * width, middle), vec2(width, height))
        };
        for (part, name, color) in [
            (block(inner.left(), side, 56.0), near, theme::MEASURED),
            (block(inner.right() - side, side, 84.0), far, theme::NOISE),
        ] {
            self.painter.rect_filled(part, 5.0, color);
            self.name(part.center(), Align2::CENTER_CENTER, name, Color32::BLACK);
        }
        let hidden = block(inner.left() + 1.15 * side, inner.width() - 2.3 * side, 70.0);
        self.painter.rect_filled(hidden, 5.0, theme::RESIDUAL);
        self.painter.text(
            hidden.center(),
            Align2::CENTER_CENTER,
            "?",
            FontId::proportional(40.0),
            Color32::BLACK,
        );
    }
}

fn curve(f: impl Fn(f32) -> f32) -> Vec<f32> {
    let time = |i: usize| i as f32 / (POINTS - 1) as f32;
    (0..POINTS).map(|i| f(time(i))).collect()
}

/// What drives it over the share of the record, from -1 to 1.
fn push(experiment: Experiment, t: f32) -> f32 {
    // One of the levels that take turns.
    let level = |levels: &[f32]| {
        let turn = (levels.len() as f32 * t) as usize;
        levels.get(turn).or(levels.last()).copied().unwrap_or(0.0)
    };
    let square = |turns: f32| (TAU * (turns * t + 0.25)).sin().signum();
    match experiment {
        Experiment::Sines => [1.0, 2.0, 5.0, 11.0]
            .iter()
            .map(|n| 0.3 * (TAU * n * t + n * n).sin())
            .sum(),
        Experiment::Relay => square(4.0),
        Experiment::Stairs => {
            let step = (16.0 * t).min(15.9).floor();
            let level = 0.4 + 0.2 * (step / 4.0).floor();
            [level, 0.0, -level, 0.0][step as usize % 4]
        }
        Experiment::Drifting => square(8.0) + if t < 0.5 { 0.15 } else { -0.15 },
        Experiment::ProcessRelay => square(6.0),
        Experiment::ProcessStairs => level(&STAIRS.map(|share| share as f32)),
        Experiment::ProcessBinary => level(&[
            1.0, 1.0, -1.0, 1.0, -1.0, -1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0,
        ]),
    }
}

/// What a body does that nothing holds: its velocity sums up the torque. Without its mean, from -1 to 1.
fn summed(torque: &[f32]) -> Vec<f32> {
    let mut sum = 0.0;
    scaled(torque.iter().map(|u| {
        sum += u;
        sum
    }))
}

/// What a tank does: its level follows the input late.
fn followed(input: &[f32]) -> Vec<f32> {
    let mut level = 0.0;
    let share = 1.0 / (TANK * input.len() as f32);
    scaled(input.iter().map(|u| {
        level += share * (u - level);
        level
    }))
}

/// From -1 to 1.
fn scaled(values: impl Iterator<Item = f32>) -> Vec<f32> {
    let raw: Vec<f32> = values.collect();
    let (low, high) = raw
        .iter()
        .fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let scale = (high - low).max(f32::MIN_POSITIVE);
    raw.iter().map(|v| 2.0 * (v - low) / scale - 1.0).collect()
}
