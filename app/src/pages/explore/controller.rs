//! What switches or steers: the kind of controller that the page is about.

use serde::{Deserialize, Serialize};

use crate::language::tr;

/// A kind of controller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Controller {
    /// A relay that pushes up or down.
    #[default]
    TwoLevels,
    /// One that is off in a zone between both.
    ThreePositions,
    /// One that pushes in one direction or not at all.
    OneSided,
    /// P, PI or PID on the position of a drive.
    Servo,
}

impl Controller {
    /// All of them, in the order of the menu.
    const ALL: [Self; 4] = [
        Self::TwoLevels,
        Self::ThreePositions,
        Self::OneSided,
        Self::Servo,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::TwoLevels => "Relay: up or down",
            Self::ThreePositions => "Relay: heat, off, cool",
            Self::OneSided => "Relay: on or off",
            Self::Servo => "Motor under PID",
        }
    }

    fn sentence(self) -> &'static str {
        match self {
            Self::TwoLevels => {
                "The relay of the textbook: it pushes with the same strength in both directions"
            }
            Self::ThreePositions => {
                "It heats below a dead zone, cools above it, and is off inside it"
            }
            Self::OneSided => "A heater or a valve: it pushes in one direction, or not at all",
            Self::Servo => {
                "A servo with dry friction, cogging or play: does it hunt, swinging about its set point \
                            without end?"
            }
        }
    }

    /// Draws the menu; true when another one was chosen.
    pub fn ui(&mut self, ui: &mut egui::Ui) -> bool {
        let before = *self;
        egui::ComboBox::from_label(tr("controller"))
            .selected_text(tr(self.name()))
            .width(250.0)
            .show_ui(ui, |ui| {
                for kind in Self::ALL {
                    ui.selectable_value(self, kind, tr(kind.name()))
                        .on_hover_text(tr(kind.sentence()));
                }
            });
        *self != before
    }
}
