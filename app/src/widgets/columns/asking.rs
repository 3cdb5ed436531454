//! The form as it is drawn, and what is asked of it.

use egui::Ui;
use hysteron_core::measurement::{FoundColumn, Kind, Role};
use hysteron_core::message::Message;
use hysteron_core::msg;

use super::choice::{Channel, Choice, Chosen};
use super::form::Form;
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::significant;

/// Widths of the names of channels, and of the lists of columns and of units, points.
const TITLE_WIDTH: f32 = 104.0;
const COLUMN_WIDTH: f32 = 220.0;
const UNIT_WIDTH: f32 = 90.0;

/// Size of the course of a column, and width of its line, points.
const COURSE: egui::Vec2 = egui::vec2(104.0, 30.0);
const COURSE_WIDTH: f32 = 1.2;

/// Width of the form in a wide window, points.
const WIDEST: f32 = 940.0;

/// Significant digits of the values that are shown.
const DIGITS: i32 = 4;

/// What a click in the form asks for.
#[derive(Clone)]
pub enum Wanted {
    /// What was chosen.
    Choose(Box<Choice>),
    /// The file, read with what was chosen.
    Open,
    /// Nothing of it.
    Cancel,
}

impl Form {
    /// The form, in place of what is open; what was chosen comes before what is asked of it.
    pub fn ui(&self, ui: &mut Ui, targets: &mut Targets) -> Vec<Wanted> {
        let mut wanted = Vec::new();
        ui.set_max_width(ui.available_width().min(WIDEST));
        theme::answer_ui(ui, "Which column is what?");
        ui.strong(&self.file);
        ui.label(tr(&self.reason));
        let mut choice = self.choice.clone();
        ui.horizontal_wrapped(|ui| {
            for (kind, name) in [(Kind::Drive, "A drive"), (Kind::Process, "A process")] {
                ui.radio_value(&mut choice.kind, kind, tr(name));
            }
        });
        for (i, channel) in choice.channels() {
            let kind = choice.kind;
            egui::Frame::group(ui.style()).show(ui, |ui| {
                ui.set_width(ui.available_width());
                self.channel_ui(ui, channel, kind, &mut choice.chosen[i]);
            });
        }
        if choice.needs_period() {
            period_ui(ui, &mut choice.period);
        }
        if choice.needs_torque_constant() {
            torque_constant_ui(ui, &mut choice);
        }
        if let Some(error) = &self.error {
            ui.colored_label(ui.visuals().warn_fg_color, tr(error));
        }
        let missing = choice.missing();
        if !missing.is_empty() {
            let missing = Message::list(", ", missing.iter().copied());
            ui.label(tr(msg!("Still to choose: {}.", missing)));
        }
        ui.horizontal_wrapped(|ui| {
            let open = ui.add_enabled(missing.is_empty(), egui::Button::new(tr("Open it")));
            targets.note("map:open", ui, &open);
            let cancel = ui.button(tr("Cancel"));
            targets.note("map:cancel", ui, &cancel);
            // First what was typed, then what is asked of it.
            if choice != self.choice {
                // What is being typed stays as it is.
                if choice.columns() != self.choice.columns() {
                    choice.suit(&self.columns);
                }
                wanted.push(Wanted::Choose(Box::new(choice)));
            }
            if open.clicked() {
                wanted.push(Wanted::Open);
            }
            if cancel.clicked() {
                wanted.push(Wanted::Cancel);
            }
        });
        wanted
    }

    /// A channel: its column, its unit, its direction, and what stands in the column.
    fn channel_ui(&self, ui: &mut Ui, channel: &Channel, kind: Kind, chosen: &mut Chosen) {
        ui.horizontal_wrapped(|ui| {
            let title = title_ui(ui, channel.title);
            let before = chosen.column;
            self.column_ui(ui, channel, title.id, &mut chosen.column);
            if chosen.column != before {
                // The next column says its own.
                chosen.unit.clear();
            }
            if chosen.column.is_some() {
                unit_ui(ui, channel, kind, chosen);
                if !channel.turn.is_empty() {
                    ui.checkbox(&mut chosen.turned, tr(channel.turn));
                }
            }
        });
        if let Some(column) = chosen.column.and_then(|i| self.columns.get(i)) {
            ui.horizontal_wrapped(|ui| {
                course_ui(ui, column, COURSE);
                ui.small(tr(values(column, chosen.unit.trim())));
            });
        }
    }

    /// The list of columns.
    fn column_ui(
        &self,
        ui: &mut Ui,
        channel: &Channel,
        title: egui::Id,
        chosen: &mut Option<usize>,
    ) {
        let nothing = if channel.is_optional() || channel.role == Role::Time {
            "none"
        } else {
            "choose ..."
        };
        let present = chosen.and_then(|i| self.columns.get(i));
        let list = egui::ComboBox::from_id_salt(channel.title)
            .selected_text(present.map_or_else(|| tr(nothing), |column| tr(name_of(column))))
            .width(COLUMN_WIDTH)
            .truncate()
            .show_ui(ui, |ui| {
                ui.selectable_value(chosen, None, tr(nothing));
                for (i, column) in self.columns.iter().enumerate() {
                    ui.horizontal(|ui| {
                        let row = egui::vec2(COURSE.x, ui.spacing().interact_size.y);
                        course_ui(ui, column, row);
                        ui.selectable_value(chosen, Some(i), tr(name_of(column)));
                    });
                }
            });
        list.response.labelled_by(title);
    }
}

/// The name of a channel, as wide as that of any other.
fn title_ui(ui: &mut Ui, title: &'static str) -> egui::Response {
    let size = egui::vec2(TITLE_WIDTH, ui.spacing().interact_size.y);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let title = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_width(TITLE_WIDTH);
        ui.strong(tr(title))
    });
    title.inner
}

/// The name of a field, which goes to the next line as a whole.
fn label_ui(ui: &mut Ui, name: &'static str) -> egui::Response {
    ui.add(egui::Label::new(tr(name)).extend())
}

/// A column as it is called in the lists.
fn name_of(column: &FoundColumn) -> Message {
    let mut name = Message::name(&column.name);
    if column.address != column.name {
        let place = match column.address.strip_prefix("column ") {
            Some(place) => msg!("column {}", place.to_owned()),
            None => Message::name(&column.address),
        };
        name = if name.is_empty() {
            place
        } else {
            msg!("{} ({})", name, place)
        };
    }
    match &column.unit {
        Some(unit) => msg!("{} [{}]", name, Message::name(unit)),
        None => name,
    }
}

/// What stands in a column, in one line.
fn values(column: &FoundColumn, unit: &str) -> Message {
    let numbers = &column.numbers;
    let Some([least, largest]) = numbers.range.map(|r| r.map(|v| significant(v, DIGITS))) else {
        return msg!("{} values, none of which is finite", numbers.count);
    };
    let first: Vec<String> = numbers
        .first
        .iter()
        .map(|v| significant(*v, DIGITS))
        .collect();
    let (count, first) = (numbers.count, first.join(", "));
    if unit.is_empty() {
        msg!(
            "{} values from {} to {}; the first are {}",
            count,
            least,
            largest,
            first
        )
    } else {
        msg!(
            "{} values from {} to {} {}; the first are {}",
            count,
            least,
            largest,
            Message::name(unit),
            first
        )
    }
}

/// The unit: of a list, or of the user's own where any will do.
fn unit_ui(ui: &mut Ui, channel: &Channel, kind: Kind, chosen: &mut Chosen) {
    let units = channel.units(kind);
    let label = label_ui(ui, channel.unit);
    if units.is_empty() {
        ui.add(theme::line(&mut chosen.unit).desired_width(UNIT_WIDTH))
            .labelled_by(label.id);
        return;
    }
    let shown = match chosen.unit.as_str() {
        "" => tr("choose ..."),
        unit => unit.to_owned(),
    };
    let list = egui::ComboBox::from_id_salt(channel.unit)
        .selected_text(shown)
        .width(UNIT_WIDTH)
        .show_ui(ui, |ui| {
            // What the file says may be spelled in another way than usual.
            let own =
                Some(chosen.unit.clone()).filter(|u| !u.is_empty() && !units.contains(&u.as_str()));
            let usual = units.iter().map(|unit| (*unit).to_owned());
            for unit in own.into_iter().chain(usual) {
                let text = unit.clone();
                ui.selectable_value(&mut chosen.unit, unit, text);
            }
        });
    list.response.labelled_by(label.id);
    if channel.is_counted(kind, chosen) {
        let label = label_ui(ui, channel.resolution);
        ui.add(
            theme::line(&mut chosen.resolution)
                .hint_text(tr("4096/rev or 0.001 mm"))
                .desired_width(UNIT_WIDTH * 2.0),
        )
        .labelled_by(label.id);
    }
}

fn period_ui(ui: &mut Ui, period: &mut String) {
    ui.horizontal_wrapped(|ui| {
        let label = label_ui(ui, "Sampling period, if no column has the times");
        ui.add(
            theme::line(period)
                .hint_text(tr("4s or 100Hz"))
                .desired_width(UNIT_WIDTH),
        )
        .labelled_by(label.id);
    });
}

fn torque_constant_ui(ui: &mut Ui, choice: &mut Choice) {
    ui.horizontal_wrapped(|ui| {
        let label = label_ui(ui, "Torque constant, if it is known");
        ui.add(
            theme::line(&mut choice.torque_constant)
                .hint_text(tr("0.05"))
                .desired_width(UNIT_WIDTH),
        )
        .labelled_by(label.id);
        let units = choice.constant_units();
        if !units.contains(&choice.constant_unit) {
            // Of another input, or none yet.
            choice.constant_unit = units.first().cloned().unwrap_or_default();
        }
        let label = label_ui(ui, "Unit of the torque constant");
        let list = egui::ComboBox::from_id_salt("Unit of the torque constant")
            .selected_text(&choice.constant_unit)
            .width(UNIT_WIDTH)
            .show_ui(ui, |ui| {
                for unit in units {
                    let text = unit.clone();
                    ui.selectable_value(&mut choice.constant_unit, unit, text);
                }
            });
        list.response.labelled_by(label.id);
    });
    ui.small(tr(
        "Without it, inertia, friction and loads are given in multiples of it; times and gaps do not depend on it."));
}

/// How the numbers of a column go, from the first to the last; what is not finite is a gap.
fn course_ui(ui: &mut Ui, column: &FoundColumn, size: egui::Vec2) {
    let (place, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let numbers = &column.numbers;
    let Some([least, largest]) = numbers.range else {
        return;
    };
    let rect = place.shrink(COURSE_WIDTH);
    let count = numbers.course.len().max(2) - 1;
    let at = |i: usize, value: f64| {
        // What never changes goes through the middle.
        let up = if largest > least {
            (value - least) / (largest - least)
        } else {
            0.5
        };
        let across = i as f32 / count as f32;
        egui::pos2(
            rect.left() + across * rect.width(),
            rect.bottom() - up as f32 * rect.height(),
        )
    };
    let mut line: Vec<egui::Pos2> = Vec::new();
    let stroke = egui::Stroke::new(COURSE_WIDTH, theme::MEASURED);
    for (i, stretch) in numbers.course.iter().enumerate() {
        match *stretch {
            Some([low, high]) => {
                let mut ends = [at(i, low), at(i, high)];
                // The nearer end comes first, so that the line goes no way twice.
                if line
                    .last()
                    .is_some_and(|p| (p.y - ends[1].y).abs() < (p.y - ends[0].y).abs())
                {
                    ends.reverse();
                }
                line.extend(ends);
            }
            None => {
                ui.painter().line(std::mem::take(&mut line), stroke);
            }
        }
    }
    ui.painter().line(line, stroke);
}
