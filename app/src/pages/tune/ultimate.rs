//! Step 2: ultimate gain and period, equation (9), beside the true ones.

use egui_plot::{Line, LineStyle, MarkerShape, Points};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::tuning::Ultimate;

use hysteron_core::uncertain::significant;

use super::draw::{CAPTION, beside, curve, error, maybe, number, plot, table};
use super::stage::{Seen, Stage};
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui};

pub const STAGE: Stage = Stage {
    id: "ultimate",
    title: "Ultimate gain",
    question: "At which gain would the loop oscillate on its own?",
    answer,
    next: "Ask the relay for a gain with a phase margin instead: step 3.",
    plot: nyquist_ui,
    ui,
};

fn answer(seen: Seen<'_>) -> Message {
    let found = &seen.report.ultimate;
    let [gain, period] = [found.by_relay.gain, found.by_relay.period].map(number);
    match found.truth {
        Some(truth) => msg!(
            "Relay estimate Ku = {}, Tu = {} s; true values {} and {} s.",
            gain,
            period,
            number(truth.gain),
            number(truth.period)
        ),
        None => msg!("Relay estimate Ku = {}, Tu = {} s.", gain, period)
            .and("In fact, no gain makes this loop oscillate."),
    }
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32, _rule: &mut String) {
    ui.label(tr(
        "The relay finds the point where the plant's Nyquist curve meets -1/N(a). With hysteresis that line lies \
         below the real axis: the point has less than 180° of phase lag, and 4k/(πa) is the gain that moves it onto \
         the unit circle. Try less hysteresis."));
    beside(
        ui,
        height,
        |ui, height| {
            if !seen.pinned {
                nyquist_ui(ui, seen, height);
            }
        },
        |ui, _| table_ui(ui, seen),
    );
}

fn nyquist_ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32) {
    let report = seen.report;
    let found = report.point.point.value;
    let reach = 2.2 * found[0].hypot(found[1]);
    let mut curves = vec![
        ("plant P(jω)", theme::MEASURED, Shape::Line),
        ("relay -1/N(a)", theme::DESCRIBING, Shape::Dashes),
        ("point by the relay", theme::MODEL, Shape::Diamond),
        ("-1/Ku by the relay", theme::MODEL, Shape::Square),
    ];
    if report.ultimate.truth.is_some() {
        curves.push(("true -1/Ku", theme::EXACT, Shape::Circle));
    }
    caption_ui(ui, "", &curves);
    plot(
        "ultimate",
        height - 2.0 * CAPTION,
        "real part",
        "imaginary part",
    )
    .with(|plot| {
        plot.data_aspect(1.0)
            .default_x_bounds(-reach, 0.4 * reach)
            .default_y_bounds(-0.8 * reach, 0.4 * reach)
    })
    .show(ui, |plot| {
        plot.line(
            Line::new(tr("plant P(jω)"), curve(&report.nyquist))
                .color(theme::MEASURED)
                .width(2.0),
        );
        let line = curve(&[[-20.0, found[1]], [0.0, found[1]]]);
        plot.line(
            Line::new(tr("relay -1/N(a)"), line)
                .color(theme::DESCRIBING)
                .width(2.5)
                .style(LineStyle::dashed_loose()),
        );
        let mut mark = |name: &'static str, at: [f64; 2], color, shape| {
            plot.points(
                Points::new(tr(name), curve(&[at]))
                    .color(color)
                    .radius(6.0)
                    .shape(shape),
            );
        };
        let on_axis = |u: Ultimate| [-1.0 / u.gain, 0.0];
        mark(
            "point by the relay",
            found,
            theme::MODEL,
            MarkerShape::Diamond,
        );
        let by_relay = on_axis(report.ultimate.by_relay);
        mark(
            "-1/Ku by the relay",
            by_relay,
            theme::MODEL,
            MarkerShape::Square,
        );
        if let Some(truth) = report.ultimate.truth {
            mark(
                "true -1/Ku",
                on_axis(truth),
                theme::EXACT,
                MarkerShape::Circle,
            );
        }
    });
}

fn table_ui(ui: &mut egui::Ui, seen: Seen<'_>) {
    let found = &seen.report.ultimate;
    let heads = ["", "Ku", "error", "Tu [s]", "error"];
    table(ui, "ultimate table", &heads, |ui| {
        let mut row =
            |name: &'static str, u: Option<Ultimate>, gain: Option<f64>, period: Option<f64>| {
                ui.label(tr(name));
                ui.label(tr(maybe(u.map(|u| u.gain), "none")));
                ui.label(tr(error(gain)));
                ui.label(tr(maybe(u.map(|u| u.period), "none")));
                ui.label(tr(error(period)));
                ui.end_row();
            };
        row(
            "4k/(π a), eq. (9)",
            Some(found.by_relay),
            found.by_relay_error,
            found.period_error,
        );
        row(
            "on the real axis, 4k/(π √(a² - ε²))",
            Some(found.on_real_axis),
            found.on_real_axis_error,
            found.period_error,
        );
        row("true", found.truth, None, None);
    });
    ui.small(tr(msg!(
        "Convention here: {}. A program that counts differently reports half or twice this Ku.",
        Message::words(found.amplitude_convention.clone())
    )));
    ui.add_space(6.0);
    let point = &seen.report.point;
    ui.label(tr(msg!(
        "The point itself, at ω = {} rad/s, is off by {} % of its size, since the describing function takes the \
         output for a sine; computed from the first harmonic of the record it is exact (off by {}).",
        number(point.point.omega),
        fixed(100.0 * point.error, 1),
        significant(point.fourier_error, 1)
    )));
}
