//! Charts as SVG: axes with round ticks, curves, bands, bars.

use std::fmt::Write as _;

use super::escape::escape;
use super::input::Tongue;
use crate::message::Message;
use crate::uncertain::{significant, titled};

/// Space for the labels, in units of the picture.
const LEFT: f64 = 74.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = 40.0;

/// A range that spans more than this factor is shown on a logarithmic axis.
const LOGARITHMIC_FROM: f64 = 20.0;

/// Width of a character, for the bars' labels.
const CHARACTER: f64 = 6.8;

/// An axis: what it shows, with its unit, and the range that is shown.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    label: Message,
    from: f64,
    to: f64,
    logarithmic: bool,
}

impl Axis {
    /// A range that is empty or no number becomes one that can be drawn.
    pub fn new(name: impl Into<Message>, unit: &str, range: (f64, f64)) -> Self {
        let label = titled(name.into(), unit);
        let (mut from, mut to) = range;
        if !(from.is_finite() && to.is_finite() && from <= to && (to - from).is_finite()) {
            (from, to) = (0.0, 1.0);
        }
        if to - from <= 1e-12 * from.abs().max(to.abs()) {
            let half = if from == 0.0 { 1.0 } else { 0.1 * from.abs() };
            (from, to) = (from - half, to + half);
        }
        Self {
            label,
            from,
            to,
            logarithmic: false,
        }
    }

    /// The same with some room at both ends.
    pub fn roomy(name: impl Into<Message>, unit: &str, range: (f64, f64)) -> Self {
        let mut axis = Self::new(name, unit, range);
        let room = 0.06 * (axis.to - axis.from);
        axis.from -= room;
        axis.to += room;
        axis
    }

    /// A logarithmic axis where the range spans far, both ends above 0; else a linear one from 0.
    pub fn sized(name: impl Into<Message>, unit: &str, (from, to): (f64, f64)) -> Self {
        if from > 0.0 && to > LOGARITHMIC_FROM * from {
            Self {
                logarithmic: true,
                ..Self::new(name, unit, (0.9 * from, 1.15 * to))
            }
        } else {
            Self::new(name, unit, (0.0, 1.06 * to))
        }
    }

    /// Where a value lies between the ends, 0 to 1.
    fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            libm::log(value.max(f64::MIN_POSITIVE) / self.from) / libm::log(self.to / self.from)
        } else {
            (value - self.from) / (self.to - self.from)
        }
    }

    /// Round values about `count` in number, and digits after the point.
    fn ticks(&self, count: f64) -> Vec<f64> {
        if self.logarithmic {
            let powers =
                (libm::log10(self.from).floor() as i32)..=(libm::log10(self.to).ceil() as i32);
            return powers
                .take(20)
                .map(|p| 10_f64.powi(p))
                .filter(|t| (self.from..=self.to).contains(t))
                .collect();
        }
        let rough = (self.to - self.from) / count;
        let power = libm::pow(10_f64, libm::log10(rough).floor());
        let step = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|m| m * power)
            .find(|s| *s >= rough)
            .unwrap_or(rough);
        let first = (self.from / step).ceil();
        (0..20)
            .map(|k| (first + f64::from(k)) * step)
            .take_while(|t| *t <= self.to + 1e-9 * step)
            .map(|t| if t.abs() < 1e-9 * step { 0.0 } else { t })
            .collect()
    }
}

/// Lowest and highest finite value; `None` where there is none.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|v| v.is_finite())
        .fold(None, |r, v| {
            Some(r.map_or((v, v), |(a, b): (f64, f64)| (a.min(v), b.max(v))))
        })
}

/// A number on an axis whose ticks are `step` apart.
fn tick_text(value: f64, step: f64) -> String {
    let step = step.min(value.abs().max(f64::MIN_POSITIVE));
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&value.abs()) && step < 1e-3 || value.abs() >= 1e6 {
        return significant(value, 4);
    }
    let digits = (-libm::log10(step) + 1e-9).ceil().clamp(0.0, 7.0) as usize;
    format!("{value:.digits$}")
}

/// How a place in a chart is marked: the shape tells it where colours cannot.
#[derive(Clone, Copy)]
pub(super) enum Mark {
    Ring,
    Diamond,
}

/// A chart that is drawn piece by piece.
pub(super) struct Chart {
    tongue: Tongue,
    width: f64,
    height: f64,
    x: Axis,
    y: Axis,
    body: String,
}

impl Chart {
    /// An empty one; its labels and numbers are put into this language as it is finished.
    pub fn new(tongue: Tongue, width: f64, height: f64, x: Axis, y: Axis) -> Self {
        Self {
            tongue,
            width,
            height,
            x,
            y,
            body: String::new(),
        }
    }

    fn at_x(&self, x: f64) -> f64 {
        LEFT + self.x.share(x).clamp(-1.0, 2.0) * (self.width - LEFT - RIGHT)
    }

    fn at_y(&self, y: f64) -> f64 {
        TOP + (1.0 - self.y.share(y).clamp(-1.0, 2.0)) * (self.height - TOP - BOTTOM)
    }

    /// A curve; values that are no numbers break it.
    pub fn line(&mut self, points: &[[f64; 2]], class: &str) {
        let mut path = String::new();
        let mut drawing = false;
        for [x, y] in points {
            if x.is_finite() && y.is_finite() {
                let command = if drawing { 'L' } else { 'M' };
                let _ = write!(path, "{command}{:.1} {:.1}", self.at_x(*x), self.at_y(*y));
                drawing = true;
            } else {
                drawing = false;
            }
        }
        let _ = write!(self.body, "<path class=\"{class}\" d=\"{path}\"/>");
    }

    /// Places, each with a mark.
    pub fn points(&mut self, points: &[[f64; 2]], mark: Mark) {
        for [x, y] in points.iter().filter(|p| p.iter().all(|v| v.is_finite())) {
            let (x, y) = (self.at_x(*x), self.at_y(*y));
            let _ = match mark {
                Mark::Ring => write!(
                    self.body,
                    "<path class=\"estimate\" d=\"M{:.1} {y:.1}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0\"/>",
                    x - 3.0
                ),
                Mark::Diamond => write!(
                    self.body,
                    "<path class=\"diamond\" d=\"M{x:.1} {:.1}l6 6l-6 6l-6 -6Z\"/>",
                    y - 6.0
                ),
            };
        }
    }

    /// A level.
    pub fn level(&mut self, y: f64, class: &str) {
        self.line(&[[self.x.from, y], [self.x.to, y]], class);
    }

    /// The area between two curves over the same points: x, lower, upper.
    pub fn band(&mut self, points: &[(f64, f64, f64)], class: &str) {
        let mut path = String::new();
        let there = points.iter().map(|p| (p.0, p.2));
        let back = points.iter().rev().map(|p| (p.0, p.1));
        let closed = there
            .chain(back)
            .filter(|p| p.0.is_finite() && p.1.is_finite());
        for (k, (x, y)) in closed.enumerate() {
            let command = if k == 0 { 'M' } else { 'L' };
            let _ = write!(path, "{command}{:.1} {:.1}", self.at_x(x), self.at_y(y));
        }
        let _ = write!(self.body, "<path class=\"{class}\" d=\"{path}Z\"/>");
    }

    /// Spans of x that are shaded.
    pub fn shade(&mut self, spans: &[(f64, f64)]) {
        for (from, to) in spans {
            if *to < self.x.from || *from > self.x.to {
                continue;
            }
            let (a, b) = (
                self.at_x(from.max(self.x.from)),
                self.at_x(to.min(self.x.to)),
            );
            let _ = write!(
                self.body,
                "<rect class=\"shade\" x=\"{a:.1}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{:.1}\"/>",
                (b - a).max(0.5),
                self.height - TOP - BOTTOM
            );
        }
    }

    /// The picture; `title` is what a screen reader says.
    pub fn finish(self, title: impl Into<Message>) -> String {
        let page = |text: Message| self.tongue.page(text);
        let (w, h) = (self.width, self.height);
        let mut out = format!(
            "<svg viewBox=\"0 0 {w} {h}\" role=\"img\"><title>{}</title>",
            page(title.into())
        );
        let (left, right, top, bottom) = (LEFT, w - RIGHT, TOP, h - BOTTOM);
        let spacing = |ticks: &[f64]| ticks.windows(2).next().map_or(1.0, |t| t[1] - t[0]);
        let xs = self.x.ticks((w / 110.0).max(2.0));
        for tick in &xs {
            let (x, text) = (
                self.at_x(*tick),
                page(tick_text(*tick, spacing(&xs)).into()),
            );
            let _ = write!(
                out,
                "<path class=\"grid\" d=\"M{x:.1} {top}V{bottom:.1}\"/><text x=\"{x:.1}\" y=\"{:.1}\" \
                 text-anchor=\"middle\">{text}</text>",
                bottom + 15.0
            );
        }
        let ys = self.y.ticks(((h - TOP - BOTTOM) / 28.0).max(2.0));
        for tick in &ys {
            let (y, text) = (
                self.at_y(*tick),
                page(tick_text(*tick, spacing(&ys)).into()),
            );
            let _ = write!(
                out,
                "<path class=\"grid\" d=\"M{left} {y:.1}H{right}\"/><text x=\"{:.1}\" y=\"{:.1}\" \
                 text-anchor=\"end\">{text}</text>",
                left - 5.0,
                y + 4.0
            );
        }
        // A nested picture cuts off what leaves the axes.
        let _ = write!(
            out,
            "<svg x=\"{left}\" y=\"{top}\" width=\"{:.1}\" height=\"{:.1}\" viewBox=\"{left} {top} {:.1} \
             {:.1}\">{}</svg>",
            right - left,
            bottom - top,
            right - left,
            bottom - top,
            self.body
        );
        let _ = write!(
            out,
            "<path class=\"frame\" d=\"M{left} {top}V{bottom:.1}H{right}\"/><text class=\"faint\" x=\"{:.1}\" \
             y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            0.5 * (left + right),
            h - 6.0,
            page(self.x.label.clone())
        );
        let middle = 0.5 * (top + bottom);
        let _ = write!(
            out,
            "<text class=\"faint\" transform=\"translate(14 {middle:.1}) rotate(-90)\" \
             text-anchor=\"middle\">{}</text></svg>",
            page(self.y.label.clone())
        );
        out
    }
}

/// A bar with its label and value as text; `share` of the full length.
pub(super) struct Bar {
    pub label: Message,
    pub value: Message,
    pub share: f64,
    pub class: &'static str,
}

/// Horizontal bars under each other.
pub(super) fn bars(tongue: Tongue, width: f64, rows: &[Bar], title: &'static str) -> String {
    const ROW: f64 = 28.0;
    let said = |text: fn(&Bar) -> &Message| -> Vec<String> {
        rows.iter().map(|row| (tongue.say)(text(row))).collect()
    };
    let (labels, values) = (said(|r| &r.label), said(|r| &r.value));
    let longest = |texts: &[String]| {
        let lengths = texts.iter().map(|t| t.chars().count());
        lengths.max().unwrap_or(0) as f64
    };
    let label = (CHARACTER * longest(&labels) + 12.0).min(0.5 * width);
    let value = CHARACTER * longest(&values) + 14.0;
    let room = (width - label - value).max(50.0);
    let mut out = format!(
        "<svg viewBox=\"0 0 {width} {}\" role=\"img\"><title>{}</title>",
        ROW * rows.len() as f64,
        tongue.page(title)
    );
    let texts = labels.iter().zip(&values);
    for (k, (row, (name, amount))) in rows.iter().zip(texts).enumerate() {
        let y = ROW * k as f64;
        let share = if row.share.is_finite() {
            row.share.clamp(0.0, 1.0)
        } else {
            0.0
        };
        let length = (share * room).max(2.0);
        let _ = write!(
            out,
            "<text x=\"0\" y=\"{:.1}\">{}</text><rect class=\"{}\" x=\"{label:.1}\" y=\"{:.1}\" \
             width=\"{length:.1}\" height=\"18\" rx=\"2\"/><text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            y + 18.0,
            escape(name),
            row.class,
            y + 5.0,
            label + length + 7.0,
            y + 18.0,
            escape(amount)
        );
    }
    out.push_str("</svg>");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis::new("t", "s", (0.13, 0.87));
        let ticks = axis.ticks(5.0);
        assert_eq!(ticks.len(), 4);
        for (tick, expected) in ticks.iter().zip([0.2, 0.4, 0.6, 0.8]) {
            assert!((tick - expected).abs() < 1e-12);
        }
        assert_eq!(tick_text(0.2, 0.2), "0.2");
        assert_eq!(tick_text(4e-6, 2e-6), "4 × 10⁻⁶");
        assert_eq!(tick_text(1500.0, 500.0), "1500");
    }

    #[test]
    fn wild_values_draw_a_picture_without_wild_numbers() {
        let wild = [f64::NAN, f64::INFINITY, -1e300, 1e300, 0.0];
        let mut chart = Chart::new(
            Tongue::ENGLISH,
            400.0,
            200.0,
            Axis::new("x", "1", (f64::NAN, 1.0)),
            Axis::new("y", "m", (-1e308, 1e308)),
        );
        chart.line(&wild.map(|v| [v, v]), "model");
        chart.band(&wild.map(|v| (v, v, -v)), "band");
        let svg = chart.finish("wild");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
}
