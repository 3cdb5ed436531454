//! The page before a measurement is open.

use super::{Command, Compare};
use crate::hook::Targets;
use crate::language::tr;
use crate::recent::{Recents, measurement};
use crate::theme;

/// A measurement that comes with the app.
pub(super) struct BuiltIn {
    pub id: &'static str,
    title: &'static str,
    story: &'static str,
    packed: &'static [u8],
}

pub(super) const BUILT_IN: [BuiltIn; 3] = [
    BuiltIn {
        id: "drive-02",
        title: "A drive that loses its swing",
        story: "A motor under a velocity relay. It never moves quite as far as its inertia says it should.",
        packed: include_bytes!(concat!(env!("OUT_DIR"), "/drive-02.packed")),
    },
    BuiltIn {
        id: "drive-12",
        title: "A drive that answers late",
        story: "The same rig with another amplifier and older bearings. One effect is not enough.",
        packed: include_bytes!(concat!(env!("OUT_DIR"), "/drive-12.packed")),
    },
    BuiltIn {
        id: "process-02",
        title: "A slow heating process",
        story: "A heater switched by a relay. The temperature overshoots both limits, every time.",
        packed: include_bytes!(concat!(env!("OUT_DIR"), "/process-02.packed")),
    },
];

impl BuiltIn {
    /// Its text.
    pub(super) fn csv(&self) -> Vec<u8> {
        crate::packed::unpack(self.packed).unwrap_or_default()
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
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.add_space(16.0);
            theme::answer_ui(ui, "What is missing from the model?");
            ui.label(tr("Take a measurement. Hysteron fits the simplest model to it, shows where that fails, and which physical effect would explain the rest."));
            self.message_ui(ui, commands);
            ui.add_space(12.0);
            for (index, built_in) in BUILT_IN.iter().enumerate() {
                egui::Frame::group(ui.style()).show(ui, |ui| {
                    ui.set_width(ui.available_width().min(620.0));
                    ui.strong(tr(built_in.title));
                    ui.label(tr(built_in.story));
                    let button = ui.button(tr(format!("Open {}", built_in.id)));
                    targets.note(format!("builtin:{}", built_in.id), ui, &button);
                    if button.clicked() {
                        commands.push(Command::OpenBuiltIn(index));
                    }
                });
            }
            ui.add_space(12.0);
            ui.label(tr("Or your own: drop a CSV file anywhere on this window, or"));
            if ui.button(tr("Open a file ...")).clicked() {
                commands.push(Command::OpenDialog);
            }
            if let Some(recent) = recent.ui(ui, measurement, targets) {
                commands.push(Command::Reopen(recent));
            }
            ui.small(tr("Its first line names the columns with units: t [s],u [N m],x1 [rad],v1 [rad/s] for a drive, t [s],u [1],y [1] for a process."));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_the_very_file() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/measurements");
        for built_in in &BUILT_IN {
            let file = std::fs::read(format!("{folder}/{}.csv", built_in.id)).expect("the file");
            assert!(built_in.csv() == file, "{}", built_in.id);
        }
    }
}
