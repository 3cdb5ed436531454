//! The labels of the axes of plots, and the lines of their grids.

use egui_plot::{GridInput, GridMark};
use hysteron_core::curve::extremes;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::uncertain::{Scale, power_of_ten, titled};

use crate::language::tr_number;

/// Points between labels of x and of y: what they shall have, and what those of a low plot must have, which would
/// have one label or none else.
pub(super) const LABELS: [[f32; 2]; 2] = [[40.0, 40.0], [24.0, 16.0]];

/// Labels that an axis has at least where there is room: one alone shows no scale.
const FEWEST_LABELS: f64 = 2.0;

/// Width of the smallest step that `egui_plot` wants, of a letter of a label, and between two labels of x, points.
const FINEST: f64 = 8.0;
const LETTER: f64 = 7.5;
const APART: f64 = 6.0;

/// Height of the labels and of the name of x below a plot, points.
const BELOW: f32 = 40.0;

/// Numbers without a unit, or with one that takes no prefix, have a power of ten below this.
const LEAST_PLAIN: f64 = 1e-3;

/// Labels that far apart are drawn, and in full.
pub(super) fn shown_from(points: f32) -> egui::Rangef {
    egui::Rangef::new(points - 0.1, points)
}

/// The unit in which an axis is read that shows values up to this size.
pub(super) fn scale(axis: &Message, size: f64) -> Scale {
    let unit = parts(axis).map_or("", |(_, unit)| unit);
    let scale = Scale::of(size, unit);
    if scale.factor != 1.0 || !(f64::MIN_POSITIVE..LEAST_PLAIN).contains(&size) {
        return scale;
    }
    let exponent = 3 * (size.log10() / 3.0).floor() as i32;
    Scale {
        factor: 10_f64.powi(exponent),
        unit: format!("{} {unit}", power_of_ten(exponent))
            .trim_end()
            .to_owned(),
    }
}

/// The name of an axis with the unit in which it is read.
pub(super) fn title(axis: &Message, scale: &Scale) -> Message {
    let name = parts(axis).map_or(axis, |(name, _)| name);
    titled(name, &scale.unit)
}

/// What an axis is called, with its unit apart: it is read in one that suits its values. Multiples of something are said
/// with what they are multiples of.
pub(super) fn named(axis: Message) -> Message {
    let apart = |text: &str| {
        let (name, unit) = text.strip_suffix(']')?.rsplit_once(" [")?;
        if unit.starts_with('×') {
            return None;
        }
        let name = Message::words(name.to_owned());
        Some(msg!("{} [{}]", name, unit.to_owned()))
    };
    match &axis {
        Message::Words(text, values) if values.is_empty() => apart(text).unwrap_or(axis),
        _ => axis,
    }
}

/// The name of an axis and its unit, if it has one.
fn parts(axis: &Message) -> Option<(&Message, &str)> {
    match axis {
        Message::Words(words, values) if words == "{} [{}]" => match values.as_slice() {
            [name, Message::Number(unit)] => Some((name, unit)),
            _ => None,
        },
        _ => None,
    }
}

/// A label in the unit of its axis, with as many decimals as its step has: 0.05 apart are 0.05, 0.10 and not 0.1, 0.1.
pub(super) fn label(mark: GridMark, factor: f64) -> String {
    let step = mark.step_size.abs() / factor;
    let first = step.log10().floor();
    let lead = step / 10_f64.powf(first);
    // 2.5 has a second digit; 1, 2 and 5 have none.
    let more = if (lead - lead.round()).abs() > 0.1 {
        1.0
    } else {
        0.0
    };
    let decimals = (more - first).clamp(0.0, 12.0) as usize;
    let value = mark.value / factor;
    if value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    tr_number(format!("{value:.decimals$}"))
}

/// The name of y beside a chart of this height, on more lines where one would lie over what is above and below; its
/// unit stays together.
pub(super) fn beside(name: &str, height: f32, width: impl Fn(&str) -> f32) -> String {
    let room = height - BELOW;
    if width(name) <= room {
        return name.to_owned();
    }
    let (plain, unit) = match name.rsplit_once(" [") {
        Some((plain, unit)) => (plain, Some(format!("[{unit}"))),
        None => (name, None),
    };
    let mut lines: Vec<String> = Vec::new();
    for word in plain.split(' ').chain(unit.as_deref()) {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match (lines.last_mut(), longer) {
            (Some(line), Some(longer)) if width(&longer) <= room => *line = longer,
            _ => lines.push(word.to_owned()),
        }
    }
    lines.join("\n")
}

/// Grid lines of x, whose labels stand beside each other: so far apart that none touches the next.
pub(super) fn grid_x(input: &GridInput, factor: f64) -> [f64; 3] {
    let steps = grid(input, LABELS[0]);
    let least = f64::from(LABELS[0][1]) * input.base_step_size / FINEST;
    let labelled = steps.into_iter().find(|s| *s >= least);
    let Some(first) = labelled.filter(|s| touch(input, *s, factor)) else {
        return steps;
    };
    let wider = std::iter::successors(Some(first), |s| Some(round_step(1.01 * s)));
    let readable = |s: &f64| labels(input, *s) >= FEWEST_LABELS;
    let wider = wider.take_while(readable).collect::<Vec<_>>();
    let apart = wider.iter().find(|s| !touch(input, **s, factor));
    let step = *apart.or(wider.last()).unwrap_or(&first);
    if 0.5 * step >= least {
        return [step, 10.0 * step, 100.0 * step];
    }
    [0.5 * step, step, 10.0 * step]
}

/// Whether labels of x that are one step apart touch each other.
fn touch(input: &GridInput, step_size: f64, factor: f64) -> bool {
    let (low, high) = input.bounds;
    let letters = |value: f64| {
        let mark = GridMark { value, step_size };
        label(mark, factor).chars().count()
    };
    let ends = [(low / step_size).ceil(), (high / step_size).floor()];
    let [first, last] = ends.map(|end| letters(end * step_size));
    let width = LETTER * first.max(last) as f64 + APART;
    step_size * FINEST / input.base_step_size < width
}

/// Labels at a step that are in view.
fn labels(input: &GridInput, step: f64) -> f64 {
    let (low, high) = input.bounds;
    (high / step).ceil() - (low / step).ceil()
}

/// Grid lines at 1, 2 or 5 times a power of ten, some seven across or as many as have room for a label, with
/// a finer and a coarser set.
pub(super) fn grid(input: &GridInput, [apart, least_apart]: [f32; 2]) -> [f64; 3] {
    let (low, high) = input.bounds;
    let point = input.base_step_size / FINEST;
    let wanted = ((high - low) / 7.0).max(f64::from(apart) * point);
    let step = round_step(wanted.max(f64::MIN_POSITIVE));
    let closer = [0.5, 0.4, 0.2].map(|share| round_step(0.99 * share * step));
    let step = [step]
        .into_iter()
        .chain(closer)
        .find(|s| labels(input, *s) >= FEWEST_LABELS && *s >= f64::from(least_apart) * point)
        .unwrap_or(step);
    // A finer line that is far enough from the next would have a label too.
    let half = 0.5 * step / point;
    if half >= f64::from(least_apart) && half < f64::from(apart) {
        return [step, 10.0 * step, 100.0 * step];
    }
    [0.5 * step, step, 10.0 * step]
}

/// The next 1, 2 or 5 times a power of ten from here on.
pub fn round_step(wanted: f64) -> f64 {
    let decade = 10_f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|s| s * decade >= wanted)
        .map_or(wanted, |s| s * decade)
}

/// A line at every power of ten, and fine ones between at 2 to 9 times it.
pub(super) fn powers(input: &GridInput) -> Vec<GridMark> {
    let (low, high) = (input.bounds.0.floor() as i32, input.bounds.1.ceil() as i32);
    let mark = |decade: i32, times: i32| GridMark {
        value: f64::from(decade) + f64::from(times).log10(),
        step_size: if times == 1 { 1.0 } else { 0.1 },
    };
    (low..high.min(low.saturating_add(MOST_DECADES)))
        .flat_map(|decade| (1..10).map(move |times| mark(decade, times)))
        // A mark beyond the ends would be drawn beside the plot.
        .filter(|mark| (input.bounds.0..=input.bounds.1).contains(&mark.value))
        .collect()
}

/// What is drawn at a place, where logarithms may stand for it.
pub(super) fn plain(decades: [bool; 2], at: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| {
        if decades[i] {
            10_f64.powf(at[i])
        } else {
            at[i]
        }
    })
}

/// Decades that have grid lines, at most: what a plot spans before it has anything to show may be wild.
const MOST_DECADES: i32 = 40;

/// Decades that an axis must span for its values to be read better as powers.
const FEWEST_DECADES: f64 = 1.0;

/// Whether positive values are so far apart that a logarithmic axis shows them better.
pub fn span_decades(values: impl Iterator<Item = f64>) -> bool {
    let (low, high) = extremes(values);
    low > 0.0 && (high / low).log10() >= FEWEST_DECADES
}

/// The power of ten at a line of [`powers`]; nothing at the fine ones.
pub(super) fn power_label(exponent: f64) -> String {
    if exponent.fract() != 0.0 {
        return String::new();
    }
    let decimals = (-exponent).clamp(0.0, 12.0) as usize;
    tr_number(format!("{:.decimals$}", 10_f64.powf(exponent)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of an axis that is so many points high.
    fn lines(bounds: (f64, f64), points: f64) -> [f64; 3] {
        let base_step_size = 8.0 * (bounds.1 - bounds.0) / points;
        grid(
            &GridInput {
                bounds,
                base_step_size,
            },
            LABELS[1],
        )
    }

    #[test]
    fn a_low_plot_has_two_labels() {
        assert_eq!(lines((-1.1, 1.1), 220.0), [0.25, 0.5, 5.0]);
        assert_eq!(lines((-0.9, 0.9), 60.0), [0.25, 0.5, 5.0], "not 0 alone");
        assert_eq!(lines((-1.1, 1.1), 24.0)[1], 5.0, "no room for two");
    }

    fn labels(axis: &str, size: f64, marks: &[(f64, f64)]) -> (String, Vec<String>) {
        let axis = named(Message::words(axis.to_owned()));
        let scale = scale(&axis, size);
        let mark = |&(value, step_size)| GridMark { value, step_size };
        let marks = marks.iter().map(mark);
        let labels = marks.map(|mark| label(mark, scale.factor));
        (title(&axis, &scale).to_string(), labels.collect())
    }

    #[test]
    fn the_labels_of_an_axis_are_written_alike_in_its_unit() {
        let fine = [(0.0005, 0.0005), (0.00075, 0.00025), (0.0, 0.0005)];
        for (axis, size, marks, title, texts) in [
            ("u", 0.0009, &fine[..], "u [10⁻⁶]", &["500", "750", "0"][..]),
            ("u", 0.002, &fine, "u", &["0.0005", "0.00075", "0"]),
            ("u", 4e-6, &[(-2e-6, 2e-6)], "u [10⁻⁶]", &["-2"]),
            ("x [m]", 9e-4, &fine, "x [mm]", &["0.5", "0.75", "0"]),
            ("time [s]", 3e-3, &[(1.5e-3, 5e-4)], "time [ms]", &["1.5"]),
            (
                "x1 - model [rad]",
                9e-5,
                &[(5e-5, 5e-5)],
                "x1 - model [µrad]",
                &["50"],
            ),
            (
                "t [s]",
                5.375,
                &[(5.3742, 2e-4), (5.37425, 5e-5)],
                "t [s]",
                &["5.3742", "5.37425"],
            ),
            (
                "rms [× noise]",
                3000.0,
                &[(2500.0, 500.0)],
                "rms [× noise]",
                &["2500"],
            ),
        ] {
            let (found, labels) = labels(axis, size, marks);
            assert_eq!(found, title);
            assert_eq!(labels, texts, "{axis}");
        }
    }

    #[test]
    fn a_name_that_is_longer_than_its_plot_is_high_has_its_unit_on_a_line_of_its_own() {
        let width = |text: &str| 7.0 * text.chars().count() as f32;
        let long = "Mittelwert [× Rauschen]";
        for (name, height, lines) in [
            (long, 150.0, "Mittelwert\n[× Rauschen]"),
            (long, 210.0, long),
            ("x1 [mrad]", 82.0, "x1\n[mrad]"),
            ("x1 [mrad]", 104.0, "x1 [mrad]"),
            ("x1 - model [µrad]", 137.0, "x1 - model\n[µrad]"),
            ("momentum [mN m s]", 150.0, "momentum\n[mN m s]"),
            ("a name without a unit", 120.0, "a name\nwithout a\nunit"),
            (
                "its rate of change [1/s]",
                150.0,
                "its rate of\nchange [1/s]",
            ),
        ] {
            assert_eq!(beside(name, height, width), lines, "{height}");
        }
    }

    #[test]
    fn the_labels_of_x_do_not_touch() {
        let steps = |bounds: (f64, f64), points: f64, factor| {
            let base_step_size = FINEST * (bounds.1 - bounds.0) / points;
            let input = GridInput {
                bounds,
                base_step_size,
            };
            grid_x(&input, factor)
        };
        assert_eq!(steps((0.0, 7.0), 280.0, 1.0)[1], 1.0, "0, 1, 2: as before");
        // 0.0005, 0.0010 and so on would need 50 points each.
        let [step, ..] = steps((0.0, 3e-3), 280.0, 1.0);
        assert_eq!(step, 1e-3);
        assert_eq!(steps((0.0, 3e-3), 280.0, 1e-3)[1], 5e-4, "0.5, 1.0, 1.5");
    }
}
