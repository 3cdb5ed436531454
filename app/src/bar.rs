//! The bar at the top: pages, undo, link, look.

use egui::Ui;
use hysteron_core::message::Message;
use hysteron_core::msg;

use crate::command::Command;
use crate::desk::Desk;
use crate::hook::Targets;
use crate::language::{Language, tr};
use crate::theme::{self, Look};

/// Between two buttons where the usual gap would break the line, points.
const GAP: f32 = 4.0;

/// What can be taken back, and what concerns the page as a whole.
const UNDO: [&str; 2] = ["Undo", "Redo"];
const TOOLS: [&str; 4] = ["Copy link", "Export", "Look", "Keys"];

/// What the bar shows.
pub struct Bar<'a> {
    /// Ids and titles of the pages, in the order of their tabs.
    pub pages: &'a [(&'static str, &'static str)],
    /// Index of the page in front.
    pub front: usize,
    /// Whether there is something to take back, and to do again.
    pub undo: [bool; 2],
    /// Names of the tables that the page in front can save.
    pub tables: &'a [&'static str],
    /// The look of the app.
    pub look: Look,
    /// Whether nothing moves by itself.
    pub calm: bool,
    /// Its language.
    pub language: Language,
}

impl Bar<'_> {
    /// Draws it; clicks become commands.
    pub fn ui(&self, ui: &mut Ui, desk: &mut Desk) {
        let (targets, commands) = (&mut desk.targets, &mut desk.commands);
        let room = ui.available_width();
        let all = |ui: &Ui| {
            let pages = heading(ui) + buttons(ui, self.pages.iter().map(|p| p.1));
            [pages, buttons(ui, UNDO), buttons(ui, TOOLS)]
        };
        if all(ui).iter().sum::<f32>() > room {
            ui.spacing_mut().item_spacing.x = GAP;
        }
        let [pages, undo, tools] = all(ui);
        let more = buttons(ui, ["More"]);
        ui.horizontal(|ui| {
            if pages + more > room {
                let title = self.pages.get(self.front).map_or("Hysteron", |p| p.1);
                let menu = ui.menu_button(tr(msg!("Menu: {}", title)), |ui| {
                    self.pages_ui(ui, targets, commands);
                    ui.separator();
                    self.tools_ui(ui, targets, commands);
                });
                targets.note("menu", ui, &menu.response);
                self.undo_ui(ui, targets, commands);
                return;
            }
            ui.heading(tr("Hysteron"));
            self.pages_ui(ui, targets, commands);
            ui.separator();
            theme::quiet(ui);
            if pages + undo + tools <= room {
                self.undo_ui(ui, targets, commands);
                self.tools_ui(ui, targets, commands);
                return;
            }
            let together = pages + undo + more > room;
            if !together {
                self.undo_ui(ui, targets, commands);
            }
            ui.menu_button(tr("More"), |ui| {
                if together {
                    self.undo_ui(ui, targets, commands);
                    ui.separator();
                }
                self.tools_ui(ui, targets, commands);
            });
        });
    }

    fn pages_ui(&self, ui: &mut Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
        for (index, (id, title)) in self.pages.iter().enumerate() {
            let tab = ui.selectable_label(self.front == index, tr(*title));
            targets.note(format!("page:{id}"), ui, &tab);
            if tab.clicked() {
                commands.push(Command::Go(id));
            }
        }
    }

    fn undo_ui(&self, ui: &mut Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
        let [undo, redo] = self.undo;
        let commanded = [Command::Undo, Command::Redo];
        for ((name, can), command) in UNDO.into_iter().zip([undo, redo]).zip(commanded) {
            let button = ui.add_enabled(can, egui::Button::new(tr(name)));
            targets.note(name, ui, &button);
            if button.clicked() {
                commands.push(command);
            }
        }
    }

    fn tools_ui(&self, ui: &mut Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
        let copy = ui
            .button(tr("Copy link"))
            .on_hover_text(tr("A link that shows exactly this page, as it is now"));
        targets.note("copy link", ui, &copy);
        if copy.clicked() {
            commands.push(Command::CopyLink);
            ui.close();
        }
        let export = ui.menu_button(tr("Export"), |ui| {
            let mut item = |label: Message, name: &str, command| {
                let button = ui.button(tr(label));
                targets.note(format!("export:{name}"), ui, &button);
                if button.clicked() {
                    commands.push(command);
                    ui.close();
                }
            };
            let [svg, png] = ["SVG", "PNG"].map(|kind| msg!("Picture of this page ({})", kind));
            item(svg, "svg", Command::SaveSvg);
            item(png, "png", Command::SavePng);
            for table in self.tables {
                let label = msg!("Data: {} (CSV)", table);
                item(label, table, Command::SaveTable(table));
            }
        });
        targets.note("export", ui, &export.response);
        ui.menu_button(tr("Look"), |ui| {
            for look in Look::ALL {
                if ui.radio(self.look == look, tr(look.name())).clicked() {
                    commands.push(Command::SetLook(look));
                    ui.close();
                }
            }
            ui.separator();
            let mut calm = self.calm;
            let hint = tr("Nothing moves by itself; Play still works");
            if ui
                .checkbox(&mut calm, tr("Less motion"))
                .on_hover_text(hint)
                .changed()
            {
                commands.push(Command::Calm(calm));
                ui.close();
            }
            ui.separator();
            for language in Language::ALL {
                if ui
                    .radio(self.language == language, language.name())
                    .clicked()
                {
                    commands.push(Command::Speak(language));
                    ui.close();
                }
            }
        });
        if ui
            .button(tr("Keys"))
            .on_hover_text(tr("All keys of the keyboard"))
            .clicked()
        {
            commands.push(Command::Sheet);
            ui.close();
        }
    }
}

/// Width of the heading and of the line behind the pages, points.
fn heading(ui: &Ui) -> f32 {
    let font = egui::TextStyle::Heading.resolve(ui.style());
    width(ui, "Hysteron", font) + 2.0 * ui.spacing().item_spacing.x + SEPARATOR
}

/// What egui gives a line between buttons, points.
const SEPARATOR: f32 = 6.0;

/// Width of buttons with their gaps, points.
fn buttons(ui: &Ui, names: impl IntoIterator<Item = &'static str>) -> f32 {
    names
        .into_iter()
        .map(|name| theme::button_width(ui, name))
        .sum()
}

fn width(ui: &Ui, name: &'static str, font: egui::FontId) -> f32 {
    theme::text_width(ui, tr(name), font)
}
