//! The page before a measurement is open.

use std::sync::Arc;

use super::built_in::{BUILT_IN, BuiltIn};
use super::command::Command;
use super::state::Compare;
use crate::hook::Targets;
use crate::language::tr;
use crate::layout;
use crate::recent::{Recents, measurement};
use crate::theme;
use hysteron_core::msg;

/// Height of the picture on a card, points, and as a share of the window; how often the input switches in it, and most
/// samples.
const GLIMPSE: std::ops::RangeInclusive<f32> = 90.0..=240.0;
const GLIMPSE_SHARE: f32 = 0.25;
const GLIMPSE_SWITCHES: usize = 12;
const GLIMPSE_SAMPLES: usize = 1000;

/// Height of the button of a card, points.
const BUTTON: f32 = 36.0;

/// A measurement: how it begins, what it is, and the button that opens it.
fn card_ui(
    ui: &mut egui::Ui,
    (index, built_in): (usize, &'static BuiltIn),
    foot: &mut layout::Foot,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    ui.strong(egui::RichText::new(tr(built_in.title)).size(17.0));
    glimpse_ui(ui, built_in);
    ui.label(tr(built_in.story));
    let size = egui::vec2(ui.available_width(), BUTTON);
    foot.room(ui, BUTTON);
    let button = ui.add_sized(
        size,
        egui::Button::new(tr(msg!("Open {}", built_in.file.id))),
    );
    targets.note(format!("builtin:{}", built_in.file.id), ui, &button);
    if button.clicked() {
        commands.push(Command::OpenBuiltIn(index));
    }
}

/// The beginning of a record: its input, and over it what was measured last.
#[derive(Default)]
struct Glimpse {
    time: Vec<f32>,
    input: Vec<f32>,
    output: Vec<f32>,
}

impl Glimpse {
    fn of(csv: &[u8]) -> Self {
        let mut glimpse = Self::default();
        let text = String::from_utf8_lossy(csv);
        let mut switches = 0;
        for line in text.lines().skip(1) {
            let mut fields = line.split(',').map_while(|f| f.parse::<f32>().ok());
            let (Some(t), Some(u), Some(y)) = (fields.next(), fields.next(), fields.last()) else {
                break;
            };
            let passes = |last: &f32| (*last > 0.0) != (u > 0.0);
            switches += usize::from(glimpse.input.last().is_some_and(passes));
            if switches > GLIMPSE_SWITCHES {
                break;
            }
            glimpse.time.push(t);
            glimpse.input.push(u);
            glimpse.output.push(y);
        }
        glimpse
    }
}

/// Draws the beginning of a record, without axes: it is a picture on a door.
fn glimpse_ui(ui: &mut egui::Ui, built_in: &'static BuiltIn) {
    let id = egui::Id::unique(("glimpse", built_in.file.id));
    let known = ui.data(|data| data.get_temp::<Arc<Glimpse>>(id));
    let glimpse = known.unwrap_or_else(|| {
        let glimpse = Arc::new(Glimpse::of(&built_in.file.beginning(GLIMPSE_SAMPLES)));
        ui.data_mut(|data| data.insert_temp(id, glimpse.clone()));
        glimpse
    });
    let height = GLIMPSE_SHARE * ui.ctx().content_rect().height();
    let height = height.clamp(*GLIMPSE.start(), *GLIMPSE.end());
    let size = egui::vec2(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    ui.painter()
        .rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
    let place = rect.shrink(10.0);
    let range = |values: &[f32]| {
        let low = values.iter().copied().fold(f32::INFINITY, f32::min);
        let high = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        egui::Rangef::new(low, high)
    };
    let across = range(&glimpse.time);
    for (values, color, width) in [
        (&glimpse.input, theme::INPUT, 1.0),
        (&glimpse.output, theme::MEASURED, 2.0),
    ] {
        let up = range(values);
        let points = glimpse.time.iter().zip(values).map(|(t, v)| {
            let x = egui::emath::remap(*t, across, place.x_range());
            egui::pos2(x, egui::emath::remap(*v, up, place.bottom()..=place.top()))
        });
        ui.painter().line(points.collect(), (width, color));
    }
}

impl Compare {
    pub(super) fn welcome_ui(
        &self,
        ui: &mut egui::Ui,
        recent: &Recents,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        theme::scroll("compare_welcome").show(ui, |ui| {
            ui.add_space(16.0);
            theme::answer_ui(ui, "What is missing from the model?");
            ui.label(tr(
                "Take a measurement. Hysteron fits the simplest model to it, shows where that fails, and which \
                 physical effect would explain the rest."));
            self.message_ui(ui, commands);
            ui.add_space(12.0);
            if ui.available_width() < layout::NARROW {
                for (index, built_in) in BUILT_IN.iter().enumerate() {
                    let card = layout::card(ui, 0.0, |ui, foot| {
                        card_ui(ui, (index, built_in), foot, targets, commands);
                    });
                    commands.extend(card.pressed.then_some(Command::OpenBuiltIn(index)));
                }
            } else {
                let pressed = layout::row(ui, "measurements", BUILT_IN.len(), |ui, index, foot| {
                    card_ui(ui, (index, &BUILT_IN[index]), foot, targets, commands);
                });
                commands.extend(pressed.map(Command::OpenBuiltIn));
            }
            ui.add_space(12.0);
            ui.horizontal_wrapped(|ui| {
                ui.label(tr("Or your own: drop a CSV or MATLAB file anywhere on this window, or"));
                if ui.button(tr("Open a file ...")).clicked() {
                    commands.push(Command::OpenDialog);
                }
            });
            if let Some(recent) = recent.ui(ui, measurement, targets) {
                commands.push(Command::Reopen(recent));
            }
            ui.small(tr(
                "Its first line names the columns with units: t [s],u [N m],x1 [rad],v1 [rad/s] for a drive, t [s],u \
                 [1],y [1] for a process. For any other file you say which column is what."));
        });
    }
}
