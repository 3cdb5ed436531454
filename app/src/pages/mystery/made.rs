//! A mystery that was made: its record, and the ways to hand it on.

use egui_plot::Line;
use hysteron_core::measurement::Kind;
use hysteron_core::message::fixed;
use hysteron_core::msg;
use hysteron_core::mystery::{Choice, Experiment, Mystery, columns};

use crate::command::Command;
use crate::desk::Desk;
use crate::export::Table;
use crate::language::tr;
use crate::link::VERSION;
use crate::save::Document;
use crate::theme;
use crate::widgets::chart::{Shape, caption_ui, curve, envelope, still};
use hysteron_work::tasks::Made;

/// Longest link that is offered, characters: browsers take more, but not every message does.
const LONGEST: usize = 16_384;

/// Most points of a curve.
const MOST_POINTS: usize = 4000;

/// What is measured and what is hidden in it.
pub(super) type Asked = (Experiment, Choice);

/// A mystery, ready to be shown.
pub(super) struct Product {
    mystery: Mystery,
    /// Whether it was brought into view.
    seen: std::cell::Cell<bool>,
    pub name: String,
    /// What it was asked to be.
    pub asked: Option<Asked>,
    /// The text of a link that opens it.
    link: String,
    samples: usize,
    /// Length of the record, s.
    duration: f64,
    /// The last column over time in s.
    curve: Vec<[f64; 2]>,
}

impl Product {
    pub fn of(made: Made, asked: Option<Asked>) -> Self {
        let Made { mystery, link } = made;
        let step = f64::from(mystery.step) * 1e-6;
        let samples = mystery.len();
        let time: Vec<f64> = (0..samples).map(|i| i as f64 * step).collect();
        let last = columns(mystery.kind)
            .iter()
            .zip(&mystery.columns)
            .next_back();
        let values: Vec<f64> = last.map_or_else(Vec::new, |(column, counts)| {
            let value = |count: &i32| f64::from(*count) * column.step;
            counts.iter().map(value).collect()
        });
        Self {
            name: mystery.name(),
            asked,
            link: format!("{VERSION};compare;compare.mystery={link}"),
            samples,
            duration: samples as f64 * step,
            curve: envelope(&time, &values, MOST_POINTS),
            seen: std::cell::Cell::new(false),
            mystery,
        }
    }
}

/// The mystery; `changed`: what is chosen now is not what it was asked to be.
pub(super) fn ui(product: &Product, changed: bool, ui: &mut egui::Ui, desk: &mut Desk) {
    let Product {
        mystery,
        name,
        link,
        samples,
        duration,
        curve: points,
        seen,
        ..
    } = product;
    // The button that made it stands below a long list.
    if !seen.replace(true) {
        // At once: what moves cannot be clicked.
        let at_once = egui::style::ScrollAnimation::none();
        ui.scroll_to_cursor_animation(Some(egui::Align::TOP), at_once);
    }
    egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.strong(tr(msg!("{} is ready.", name)));
        ui.label(tr(msg!("{} samples in {} s. What is hidden is sealed inside.", samples, fixed(*duration, 1))));
        if changed {
            let color = ui.visuals().warn_fg_color;
            theme::tell(&ui.colored_label(color, tr(
                "This is still the mystery you made before: your choices have changed since.")));
        }
        ui.horizontal_wrapped(|ui| {
            let save = ui.button(tr("Save the file"));
            desk.targets.note("mystery:save", ui, &save);
            if save.clicked() {
                desk.commands.push(Command::Save(Box::new(Document {
                    name: format!("{name}.csv"),
                    kind: "Measurement",
                    media: "text/csv;charset=utf-8",
                    text: mystery.csv(),
                })));
            }
            let fits = link.len() <= LONGEST;
            let copy = ui
                .add_enabled(fits, egui::Button::new(tr("Copy the mystery's link")))
                .on_hover_text(tr("Opens this record in Compare; the truth is sealed in it"))
                .on_disabled_hover_text(tr("This record is too long for a link: save the file"));
            desk.targets.note("mystery:copy", ui, &copy);
            if copy.clicked() {
                desk.commands.push(Command::CopyOther {
                    link: link.clone(),
                    saying: "The link to the mystery is copied. It holds the record and, sealed, the truth.",
                });
            }
            if !fits {
                ui.label(tr("It is too long for a link: save the file."));
            }
            let open = ui.button(tr("Open it in Compare"));
            desk.targets.note("mystery:open", ui, &open);
            if open.clicked() {
                desk.commands.push(if fits {
                    Command::OpenLink(link.clone())
                } else {
                    Command::OpenFile("compare", format!("{name}.csv"), mystery.csv().into_bytes())
                });
            }
        });
        let (quantity, axis) = match mystery.kind {
            Kind::Drive => ("velocity", "v1 [rad/s]"),
            Kind::Process => ("output", "y [1]"),
        };
        caption_ui(ui, "What was measured", &[(quantity, theme::MEASURED, Shape::Line)]);
        still("mystery_record", "time [s]", axis, 200.0).show(ui, |plot| {
            plot.line(Line::new(tr(quantity), curve(points)).color(theme::MEASURED));
        });
    });
}

/// The record as a table.
pub(super) fn table(product: &Product) -> Table {
    let Mystery {
        kind,
        step,
        columns: counts,
        ..
    } = &product.mystery;
    let time = (0..product.samples as u64).map(|i| (i * u64::from(*step)) as f64 * 1e-6);
    let table = Table::new("mystery").with("t [s]", time);
    columns(*kind)
        .iter()
        .zip(counts)
        .fold(table, |table, (column, counts)| {
            table.with(
                column.title,
                counts.iter().map(|c| f64::from(*c) / column.counts),
            )
        })
}
