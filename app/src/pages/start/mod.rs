//! The first minute: a loop that runs, a question, and doors to the rest.

use hysteron_core::explore::{ExploreData, ExploreInput, compute};
use hysteron_core::message::Message;
use hysteron_core::relay::Relay;
use serde::{Deserialize, Serialize};

use crate::command::Command;
use crate::desk::Desk;
use crate::export::Table;
use crate::language::tr;
use crate::layout;
use crate::page::{Offer, Page, Settable, View};
use crate::theme;
use crate::widgets::controls::slider;
use crate::widgets::playback::Playback;
use crate::widgets::relay_loop::{self, TABLES, tables};

/// Simulated periods that are played in a second.
const PERIODS_PER_SECOND: f64 = 0.6;

/// Tables of Explore that are about what is shown here too: all but Nyquist's curve.
const SHOWN: usize = TABLES.len() - 1;

/// Height of all but the plots, of the least plot, and of the button of a door, points.
const REST: f32 = 390.0;
const LEAST: f32 = 130.0;
const BUTTON: f32 = 36.0;

/// A door to another page.
struct Door {
    page: &'static str,
    button: &'static str,
    question: &'static str,
    story: &'static str,
}

const DOORS: [Door; 3] = [
    Door {
        page: "explore",
        button: "Open Explore",
        question: "How does a relay loop oscillate?",
        story: "Move the sliders and see the exact limit cycle beside what the describing function predicts.",
    },
    Door {
        page: "backlash",
        button: "Open Backlash",
        question: "How wide is a gap that nobody can see?",
        story: "A motor switched by a relay drifts through the backlash of its gear and feels both walls.",
    },
    Door {
        page: "compare",
        button: "Open Compare",
        question: "What is missing from the model?",
        story: "Take a measurement; see where the model fails, and which physics would explain the rest.",
    },
];

/// Doors of the second row: pages and their buttons.
const MORE: [(&str, &str); 4] = [
    ("lessons", "Lessons of five to ten minutes"),
    ("tune", "Tune a controller from one experiment"),
    ("maps", "Maps of period and amplitude"),
    ("mystery", "A mystery to solve or to set"),
];

/// The page.
#[derive(Default)]
pub struct Start {
    playback: Playback,
    /// The last loop and what it does.
    finished: Option<(ExploreInput, Result<ExploreData, Message>)>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Where the playback stands still, s.
    paused: Option<f64>,
}

/// The page as the registry has it.
pub fn page() -> Page {
    Page::new("start", "Start", Start::default())
}

impl View for Start {
    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        self.compute(&desk.relay_loop);
        if std::mem::take(&mut desk.play) {
            self.playback.toggle(ui.ctx());
        }
        self.play(ui);
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("start").show(ui, |ui| {
                self.loop_ui(ui, &mut desk.relay_loop.relay);
                ui.add_space(10.0);
                doors_ui(ui, desk);
            });
        });
    }

    fn hook_state(&self) -> serde_json::Value {
        serde_json::json!({
            "busy": false,
            "answer": self.data().map(|d| d.text.clone()),
            "clock": self.playback.clock,
            "playing": self.playback.playing,
        })
    }

    fn offer(&self) -> Offer<'_> {
        Offer::new(None, self.table_names(), || self.tables())
    }
}

impl Settable for Start {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            paused: self.playback.paused(),
        }
    }

    fn take(
        &mut self,
        _ctx: &egui::Context,
        settings: Settings,
        _desk: &Desk,
    ) -> Result<(), Message> {
        self.playback.set(settings.paused);
        Ok(())
    }
}

impl Start {
    /// Names of the tables that can be given now.
    fn table_names(&self) -> Vec<&'static str> {
        self.data()
            .map_or_else(Vec::new, |_| TABLES[..SHOWN].to_vec())
    }

    /// The numbers behind what is shown.
    fn tables(&self) -> Vec<Table> {
        let mut tables = self.data().map_or_else(Vec::new, tables);
        tables.truncate(SHOWN);
        tables
    }
}

impl Start {
    fn compute(&mut self, input: &ExploreInput) {
        if self
            .finished
            .as_ref()
            .is_none_or(|(known, _)| known != input)
        {
            let data = compute(input).map_err(Message::from);
            self.finished = Some((input.clone(), data));
        }
    }

    fn data(&self) -> Option<&ExploreData> {
        self.finished.as_ref()?.1.as_ref().ok()
    }

    /// Moves the playback on; at its end it begins again.
    fn play(&mut self, ui: &egui::Ui) {
        let Some(data) = self.data() else {
            return;
        };
        let end = data.time.last().copied().unwrap_or(0.0);
        let period = data
            .exact
            .or(data.simulated)
            .map_or(0.1 * end, |c| c.period);
        self.playback.advance(ui, PERIODS_PER_SECOND * period, end);
    }

    fn loop_ui(&mut self, ui: &mut egui::Ui, relay: &mut Relay) {
        ui.add_space(6.0);
        theme::answer_ui(ui, "Why does a thermostat never come to rest?");
        ui.label(tr(
            "A relay switches a process up and down. It always switches too late, so the output overshoots both \
             thresholds again and again: a limit cycle."));
        match self.finished.as_ref().map(|(_, data)| data) {
            Some(Ok(data)) => {
                ui.strong(tr(&data.text));
                if ui.available_width() < layout::NARROW {
                    relay_loop::time_ui(ui, relay, data, self.playback.clock, 200.0);
                } else {
                    // The doors beneath stay in view.
                    let window = ui.ctx().content_rect().height();
                    let height = (window - REST).min(0.42 * window).max(LEAST);
                    ui.columns(2, |columns| {
                        relay_loop::time_ui(
                            &mut columns[0],
                            relay,
                            data,
                            self.playback.clock,
                            height,
                        );
                        relay_loop::phase_ui(&mut columns[1], data, self.playback.clock, height);
                    });
                }
            }
            Some(Err(error)) => {
                ui.colored_label(ui.visuals().warn_fg_color, tr(error));
            }
            None => {}
        }
        // A slider does not break: in a narrow window its name needs the whole width.
        let narrow = ui.available_width() < layout::NARROW;
        if narrow {
            ui.label(tr("Try it:"));
        }
        ui.horizontal_wrapped(|ui| {
            if !narrow {
                ui.label(tr("Try it:"));
            }
            let normal = Relay::default().hysteresis;
            slider(
                ui,
                &mut relay.hysteresis,
                normal,
                1.0,
                0.0..=1.0,
                "hysteresis ε",
            )
            .on_hover_text(tr(
                "How far past zero the output must go before the relay switches",
            ));
            let label = self.playback.label(ui.ctx());
            if ui.button(tr(label)).clicked() {
                self.playback.toggle(ui.ctx());
            }
        });
    }
}

fn doors_ui(ui: &mut egui::Ui, desk: &mut Desk) {
    let pressed = if ui.available_width() < layout::NARROW {
        let cards = DOORS.iter().map(|door| {
            let card = layout::card(ui, 0.0, |ui, foot| door_ui(ui, desk, door, foot));
            card.pressed.then_some(door)
        });
        cards.fold(None, Option::or)
    } else {
        let place = layout::row(ui, "doors", DOORS.len(), |ui, place, foot| {
            door_ui(ui, desk, &DOORS[place], foot);
        });
        place.and_then(|place| DOORS.get(place))
    };
    desk.commands
        .extend(pressed.map(|door| Command::Go(door.page)));
    ui.add_space(6.0);
    ui.horizontal_wrapped(|ui| {
        ui.label(tr("Or:"));
        for (page, label) in MORE {
            if ui.button(tr(label)).clicked() {
                desk.commands.push(Command::Go(page));
            }
        }
    });
}

fn door_ui(ui: &mut egui::Ui, desk: &mut Desk, door: &Door, foot: &mut layout::Foot) {
    ui.strong(egui::RichText::new(tr(door.question)).size(17.0));
    // In a low window the plots come first.
    if !theme::is_low(ui.ctx()) {
        ui.label(tr(door.story));
    }
    let size = egui::vec2(ui.available_width(), BUTTON);
    foot.room(ui, BUTTON);
    let button = ui.add_sized(size, egui::Button::new(tr(door.button)));
    desk.targets
        .note(format!("door:{}", door.page), ui, &button);
    if button.clicked() {
        desk.commands.push(Command::Go(door.page));
    }
}
