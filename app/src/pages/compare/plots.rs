//! Measured and modelled curves over each other, the residual beneath.

use std::ops::Range;

use egui_plot::{
    HLine, Line, LineStyle, PlotBounds, PlotPoint, PlotPoints, PlotResponse, Span, Text,
};
use hysteron_core::diagnosis::{Finding, ReplayChannel};
use hysteron_core::measurement::{Channel, Measurement, Quantity, less_model};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::uncertain::titled;

use super::by_hand::Hand;
use super::hand::note_seen;
use super::parts::Part;
use super::state::Compare;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Chart, Key, Pen, Shape, caption_ui, envelope, extremes};

/// Most points of a curve that are drawn; above, each stretch shows its extremes.
const MAX_POINTS: usize = 10_000;

/// Times that the input passes its mean in what is shown at first: a few periods, not a solid band; and the least
/// share of the record.
const FIRST_PASSES: usize = 28;
const LEAST_VIEW: f64 = 0.01;

/// Widest view of a finding, in first views; and the share of one that is shown before a finding behind it.
const WIDEST: f64 = 4.0;
const LEAD: f64 = 0.25;

/// Height of the words over a finding, and of what is below a plot, points.
const WORDS: f32 = 20.0;
const BELOW: f32 = 40.0;

/// Room above and below what is in view, as a share of it.
const ROOM: f64 = 0.08;

/// How much the ground of words hides of the curves under it.
const GROUND: f32 = 0.75;

/// What jumps of the residual are.
const RESTARTED: &str = "In each short window the model starts afresh from an estimated state, so that small errors do \
    not add up: where one begins, the residual (measured minus model) may jump.";

/// Height of the caption, points.
const CAPTION: f32 = 26.0;

/// Least width of the labels of y, so that the plots line up: that of a name on two lines with long numbers, points.
const AXIS_WIDTH: f32 = 86.0;

/// Height of a signal, of that of both: what the model leaves is what the page is about, the signal where it is.
const SIGNAL: f32 = 0.75;

/// Height of a plot below which the page scrolls.
const LEAST_HEIGHT: f32 = 106.0;

pub(super) fn ui(page: &Compare, ui: &mut egui::Ui, height: f32) {
    let Some(measurement) = &page.measurement else {
        return;
    };
    let report = page.report_in(Part::Plots);
    let finding = report.and_then(|r| r.step.findings.get(page.finding));
    let count = measurement.outputs.len().max(1) as f32;
    caption_ui(ui, "", &curves(page, report.is_some()));
    let mut above = CAPTION;
    // In a low window it stands beneath the plots.
    let low = theme::is_low(ui.ctx());
    if report.is_some() && !low {
        let note = ui.small(tr(RESTARTED));
        above += note.rect.height() + ui.spacing().item_spacing.y;
    }
    let each = ((height - above) / (2.0 * count) - 8.0).max(LEAST_HEIGHT);
    for (index, output) in measurement.outputs.iter().enumerate() {
        let modelled = report.and_then(|r| r.replay.channels.get(index));
        let hand = page.hand().and_then(|hand| by_hand(hand, index));
        let size = |share: f32| Size {
            height: share * each,
            labels: AXIS_WIDTH,
        };
        signal_plot(
            ui,
            measurement,
            output,
            (modelled, hand),
            finding,
            size(SIGNAL),
        );
        if let Some(modelled) = modelled {
            let before = page.report_before().filter(|_| page.before);
            let before = before.and_then(|r| r.replay.channels.get(index));
            let models = (modelled, before, hand);
            residual_plot(ui, measurement, output, models, finding, size(2.0 - SIGNAL));
        }
    }
    if report.is_some() && low {
        ui.small(tr(RESTARTED));
    }
}

/// What the values that are set by hand say of an output, and the samples that have it.
type Near<'a> = (&'a [f64], (usize, usize));

fn by_hand(hand: &Hand, index: usize) -> Option<Near<'_>> {
    let modelled = hand.replay.as_ref()?.modelled.get(index)?;
    Some((modelled, hand.samples))
}

/// Height of a plot, and width of its labels of y, points.
#[derive(Clone, Copy)]
struct Size {
    height: f32,
    labels: f32,
}

/// What stands in the plots, for all of them.
fn curves(page: &Compare, modelled: bool) -> Vec<Key> {
    let mut curves = vec![("measured", theme::MEASURED, Shape::Line)];
    if modelled {
        curves.push(("model", theme::MODEL, Shape::Dashes));
        curves.push(("residual", theme::RESIDUAL, Shape::Line));
        if page.before && page.report_before().is_some() {
            curves.push(("the previous step", theme::BEFORE, Shape::Line));
        }
        if page.hand().is_some() {
            curves.push(("by hand", theme::BEFORE, Shape::Line));
        }
        curves.push(("noise, ±2σ", theme::NOISE, Shape::Dashes));
    }
    curves
}

/// A plot over time that moves together with the others; what is in view fills its height.
fn plot<'a>(
    measurement: &Measurement,
    finding: Option<&Finding>,
    id: String,
    y_label: Message,
    size: Size,
) -> Chart<'a> {
    let group = egui::Id::unique(("compare", &measurement.name));
    let (start, end) = view_of(measurement, finding);
    let axes = ["time [s]".into(), y_label];
    let chart = Chart::new(id, axes, size.height, size.labels)
        .zoomed_as("time")
        .linked(group);
    chart.with(|plot| {
        plot.default_x_bounds(start, end)
            .allow_drag([true, false])
            .allow_zoom([true, false])
            .allow_boxed_zoom(false)
            .link_axis(group, [true, false])
    })
}

/// Begin and end of what is shown at first, s.
fn first_view(measurement: &Measurement) -> (f64, f64) {
    let (time, input) = (&measurement.time, &measurement.input.values);
    let (start, end) = (time[0], time[measurement.len() - 1]);
    let mean = input.iter().sum::<f64>() / input.len() as f64;
    let passes = input
        .windows(2)
        .zip(time)
        .filter(|(pair, _)| (pair[0] > mean) != (pair[1] > mean));
    let last = passes.map(|(_, t)| *t).nth(FIRST_PASSES);
    let least = start + LEAST_VIEW * (end - start).max(f64::MIN_POSITIVE);
    (start, last.unwrap_or(end).max(least))
}

/// Begin and end of what is shown until someone zooms, s: also where the finding lies, or the first part of it.
fn view_of(measurement: &Measurement, finding: Option<&Finding>) -> (f64, f64) {
    let view = first_view(measurement);
    match finding.and_then(|f| f.spans.first()) {
        Some(span) => with_span(view, *span, measurement.time[measurement.len() - 1]),
        None => view,
    }
}

/// A view that also shows this span of a record until `last`, but is not so wide that its curves become a band.
fn with_span(view: (f64, f64), span: (f64, f64), last: f64) -> (f64, f64) {
    if span.1 <= view.1 {
        return view;
    }
    let width = view.1 - view.0;
    let begin = if span.0 < view.1 {
        view.0
    } else {
        span.0 - LEAD * width
    };
    let end = (span.1 + ROOM * width).clamp(begin + width, begin + WIDEST * width);
    (begin, end.min(last))
}

/// Fills the height with the values in view, and these others; a share of it above them is left for words.
fn fit(plot: &mut Pen<'_, '_>, time: &[f64], curves: &[&[f64]], others: &[f64], words: f64) {
    let view = in_view(&plot.plot_bounds(), time);
    let values = curves.iter().filter_map(|c| c.get(view.clone()));
    let (low, high) = extremes(values.flatten().chain(others).copied());
    if low <= high {
        let room = ROOM * (high - low).max(f64::MIN_POSITIVE);
        let above = words / (1.0 - words) * (high + room - low);
        plot.set_plot_bounds_y(low - room..=high + room.max(above));
    }
}

fn signal_plot(
    ui: &mut egui::Ui,
    measurement: &Measurement,
    output: &Channel,
    (modelled, hand): (Option<&ReplayChannel>, Option<Near<'_>>),
    finding: Option<&Finding>,
    size: Size,
) {
    let label = titled(Message::name(output.title()), &output.unit);
    let model = modelled.map_or(&[][..], |m| m.modelled.as_slice());
    let ground = ui.visuals().extreme_bg_color.gamma_multiply(GROUND);
    let alone = measurement.outputs.len() == 1;
    let marked = finding.filter(|f| alone || is_about(f, output));
    let words = marked.map_or(0.0, |_| f64::from(WORDS / (size.height - BELOW)));
    let shown = plot(
        measurement,
        finding,
        format!("signal {}", output.name),
        label,
        size,
    )
    .show(ui, |plot| {
        fit(
            plot,
            &measurement.time,
            &[&output.values, model],
            &[],
            words,
        );
        shade(plot, finding);
        let drawn = drawn(plot, &measurement.time);
        let measured = points(&measurement.time, &output.values, &drawn);
        plot.line(
            Line::new(tr("measured"), measured)
                .color(theme::MEASURED)
                .width(2.5),
        );
        if modelled.is_some() {
            let line = Line::new(tr("model"), points(&measurement.time, model, &drawn));
            plot.line(
                line.color(theme::MODEL)
                    .width(1.5)
                    .style(LineStyle::dashed_loose()),
            );
        }
        if let Some((modelled, samples)) = hand {
            let points = points_of(&measurement.time, modelled, samples, &drawn);
            plot.line(
                Line::new(tr("by hand"), points)
                    .color(theme::BEFORE)
                    .width(1.5),
            );
        }
        mark(plot, marked, ground);
        drawn
    });
    draw_more(ui, &measurement.time, &shown);
}

fn residual_plot(
    ui: &mut egui::Ui,
    measurement: &Measurement,
    output: &Channel,
    (modelled, before, hand): (&ReplayChannel, Option<&ReplayChannel>, Option<Near<'_>>),
    finding: Option<&Finding>,
    size: Size,
) {
    let label = titled(less_model(output.title()), &output.unit);
    let less = |model: &ReplayChannel| -> Vec<f64> {
        let pairs = output.values.iter().zip(&model.modelled);
        pairs.map(|(y, m)| y - m).collect()
    };
    let residual = less(modelled);
    let earlier = before.map_or_else(Vec::new, less);
    // What the values that are set by hand leave.
    let left: Vec<f64> = hand.map_or_else(Vec::new, |(modelled, (from, _))| {
        let pairs = output.values.iter().skip(from).zip(modelled);
        pairs.map(|(y, m)| y - m).collect()
    });
    let shown = plot(
        measurement,
        finding,
        format!("residual {}", output.name),
        label,
        size,
    )
    .show(ui, |plot| {
        let noise = [2.0, -2.0].map(|side| side * modelled.noise);
        let mut others = noise.to_vec();
        if let Some((_, (from, _))) = hand {
            let view = in_view(&plot.plot_bounds(), &measurement.time);
            let begin = view.start.saturating_sub(from);
            let seen = left.iter().skip(begin).take(view.len());
            let (low, high) = extremes(seen.copied());
            others.extend([low, high].into_iter().filter(|v| v.is_finite()));
        }
        fit(
            plot,
            &measurement.time,
            &[&residual, &earlier],
            &others,
            0.0,
        );
        shade(plot, finding);
        let drawn = drawn(plot, &measurement.time);
        if before.is_some() {
            let line = Line::new(
                tr("the previous step"),
                points(&measurement.time, &earlier, &drawn),
            );
            plot.line(line.color(theme::BEFORE).width(1.2));
        }
        plot.line(
            Line::new(tr("residual"), points(&measurement.time, &residual, &drawn))
                .color(theme::RESIDUAL)
                .width(1.2),
        );
        if let Some((_, samples)) = hand {
            let points = points_of(&measurement.time, &left, samples, &drawn);
            plot.line(
                Line::new(tr("by hand"), points)
                    .color(theme::BEFORE)
                    .width(1.5),
            );
        }
        for side in [2.0, -2.0] {
            let line = HLine::new(tr("noise, ±2σ"), side * modelled.noise);
            plot.hline(line.color(theme::NOISE).style(LineStyle::dashed_dense()));
        }
        drawn
    });
    draw_more(ui, &measurement.time, &shown);
}

/// Where the selected finding says that the error lies.
fn shade(plot: &mut egui_plot::PlotUi<'_>, finding: Option<&Finding>) {
    let Some(finding) = finding else {
        return;
    };
    let bounds = plot.plot_bounds();
    let point = 1.0 / plot.transform().dpos_dvalue_x().abs();
    for (from, to) in seen(&finding.spans, (bounds.min()[0], bounds.max()[0]), point) {
        let color = theme::SHADE.gamma_multiply(0.16);
        plot.add(Span::new("", from..=to).fill(color).border_width(0.0));
    }
}

/// The spans in view; those that are less than a `point` of the screen apart are one.
fn seen(spans: &[(f64, f64)], view: (f64, f64), point: f64) -> Vec<(f64, f64)> {
    let mut seen: Vec<(f64, f64)> = Vec::new();
    for (from, to) in spans.iter().filter(|s| s.1 >= view.0 && s.0 <= view.1) {
        match seen.last_mut() {
            Some(last) if from - last.1 < point => last.1 = *to,
            _ => seen.push((*from, *to)),
        }
    }
    seen
}

/// Whether a finding is about this output.
fn is_about(finding: &Finding, output: &Channel) -> bool {
    let word = match output.quantity {
        Quantity::Position => "position",
        _ => "velocity",
    };
    finding.text.to_string().contains(&format!("{word} error"))
}

/// Says at the first of its stretches on screen how much of the error is in the selected finding; on a `ground` that
/// lets it be read over a curve.
fn mark(plot: &mut egui_plot::PlotUi<'_>, finding: Option<&Finding>, ground: egui::Color32) {
    let Some(finding) = finding else {
        return;
    };
    let bounds = plot.plot_bounds();
    let (low, high) = (bounds.min(), bounds.max());
    let seen = |s: &&(f64, f64)| s.1 >= low[0] && s.0 <= high[0];
    if let Some(span) = finding.spans.iter().find(seen) {
        let text = msg!(
            "{} % of the error",
            fixed(100.0 * finding.share_of_error, 0)
        );
        // Words that begin in the right half might not end before the plot does.
        let from = span.0.max(low[0]);
        let (x, anchor) = if from < f64::midpoint(low[0], high[0]) {
            (from, egui::Align2::LEFT_TOP)
        } else {
            (span.1.min(high[0]), egui::Align2::RIGHT_TOP)
        };
        let at = PlotPoint::new(x, high[1]);
        let words = egui::RichText::new(tr(text));
        let words = words.strong().background_color(ground);
        plot.text(Text::new("", at, words).anchor(anchor));
    }
}

/// Points of the drawn stretch of a curve.
fn points(time: &[f64], values: &[f64], drawn: &Range<usize>) -> PlotPoints<'static> {
    let [time, values] = [time, values].map(|all| all.get(drawn.clone()).unwrap_or_default());
    envelope(time, values, MAX_POINTS).into()
}

/// The same of a curve that only some of the samples have.
fn points_of(
    time: &[f64],
    values: &[f64],
    (from, to): (usize, usize),
    drawn: &Range<usize>,
) -> PlotPoints<'static> {
    let within = drawn.start.max(from)..drawn.end.min(to).max(drawn.start.max(from));
    let time = time.get(within.clone()).unwrap_or_default();
    let values = values.get(within.start - from..within.end - from);
    envelope(time, values.unwrap_or_default(), MAX_POINTS).into()
}

/// The samples in view.
fn in_view(bounds: &PlotBounds, time: &[f64]) -> Range<usize> {
    let at = |t: f64| time.partition_point(|s| *s < t);
    at(bounds.min()[0])..at(bounds.max()[0])
}

/// The samples to draw: those in view, and as many on both sides for what moves before the next frame. A whole record
/// takes a browser longer than a frame. Its beginning moves in steps, so that the dashes of a curve stand still.
fn drawn(plot: &Pen<'_, '_>, time: &[f64]) -> Range<usize> {
    let bounds = plot.plot_bounds();
    if plot.notes() || !bounds.is_valid_x() {
        return 0..time.len();
    }
    let view = in_view(&bounds, time);
    let width = view.len().max(1);
    let begin = view.start.saturating_sub(width) / width * width;
    begin..(view.end + 2 * width).min(time.len())
}

/// Asks for another frame where a plot now shows more than was drawn.
fn draw_more(ui: &egui::Ui, time: &[f64], shown: &PlotResponse<Range<usize>>) {
    let view = in_view(shown.transform.bounds(), time);
    note_seen(ui.ctx(), (view.start, view.end));
    if view.start < shown.inner.start || view.end > shown.inner.end {
        ui.ctx().request_repaint();
    }
}

#[cfg(test)]
mod tests {
    use super::{seen, with_span};

    #[test]
    fn all_of_a_finding_that_is_in_view_is_shaded() {
        let spans: Vec<(f64, f64)> = (0..300)
            .map(|i| f64::from(i) * 0.1)
            .map(|t| (t, t + 0.05))
            .collect();
        assert_eq!(seen(&spans, (0.0, 30.0), 0.01), spans);
        assert_eq!(seen(&spans, (9.96, 20.02), 0.01).len(), 101);
        // From afar they are one.
        let [(from, to)] = seen(&spans, (0.0, 30.0), 0.06)[..] else {
            panic!("more than one");
        };
        assert_eq!((from, to), (spans[0].0, spans[299].1));
    }

    #[test]
    fn a_finding_is_in_view() {
        let first = (0.0, 0.73);
        assert_eq!(with_span(first, (0.1, 0.4), 60.0), first);
        let (begin, end) = with_span(first, (0.72, 1.6), 60.0);
        assert!(begin == 0.0 && end > 1.6 && end < 1.7, "{end}");
        let (begin, end) = with_span(first, (50.0, 50.1), 60.0);
        assert!(begin > 49.0 && begin < 50.0 && end > 50.1, "{begin} {end}");
        assert!((end - begin - 0.73).abs() < 1e-9);
        let (begin, end) = with_span(first, (0.1, 60.0), 60.0);
        assert!(begin == 0.0 && end < 3.0, "a solid band: {end}");
        let (_, end) = with_span(first, (1.0, 2.0), 2.0);
        assert_eq!(end, 2.0);
    }
}
