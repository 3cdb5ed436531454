//! How does the oscillation change with two parameters? A map of exact cycles.

mod picture;
mod settings;
mod side;
mod words;

use hysteron_core::explore::ExploreInput;
use hysteron_core::maps::{Axis, Map, MapInput, Outcome, Parameter, Quantity};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;

use crate::command::Command;
use crate::desk::Desk;
use crate::export::Table;
use crate::jobs::{Job, News};
use crate::language::tr;
use crate::layout;
use crate::motion;
use crate::page::{Hint, Offer, Page, View};
use crate::theme;
use hysteron_work::tasks::MapTask;
use picture::Picture;
use words::{axis_title, number, with_unit};

/// Share of a narrow window that the map has where it stays in view.
const PINNED: f32 = 0.42;

/// The page: what is asked for, what is known of it, and what is drawn.
#[derive(Default)]
pub struct Maps {
    input: MapInput,
    quantity: Quantity,
    /// Values of the two parameters that are read out; clicked or typed.
    point: Option<[f64; 2]>,
    /// What the loop at that point does, for the loop beside it.
    reading: Option<(ExploreInput, Outcome)>,
    /// The loop that was last seen in *Explore*, and whether this page put it there.
    seen: Option<ExploreInput>,
    /// Input of the map below, finished or not.
    started: Option<MapInput>,
    map: Map,
    job: Option<Job<MapTask>>,
    message: Option<Message>,
    picture: Picture,
}

impl Maps {
    /// Takes over the loop of *Explore*, unless it is the one that a click on this map has set.
    fn follow(&mut self, explored: &ExploreInput) {
        if self.seen.as_ref() == Some(explored) {
            return;
        }
        self.seen = Some(explored.clone());
        self.input.base = explored.clone();
        self.point = None;
    }

    /// Starts anew if the input has changed, and takes what the job has found.
    fn update(&mut self, ctx: &egui::Context) {
        let mut wanted = self.input.clone();
        // What the axes vary is not part of the loop around which they vary it.
        for axis in [wanted.x, wanted.y] {
            let factor = matches!(axis.parameter, Parameter::PlantGain | Parameter::TimeScale);
            if !factor {
                axis.parameter.write(&mut wanted.base, axis.to);
            }
        }
        if self.started.as_ref() != Some(&wanted) {
            self.started = Some(wanted.clone());
            self.message = wanted.validate().err().map(Message::from);
            self.job = None;
            if self.message.is_none() {
                self.map = Map::new(wanted.size);
                self.job = Some(Job::run(ctx, MapTask(wanted)));
            }
        }
        let mut finished = false;
        for news in self.job.as_mut().map(Job::news).unwrap_or_default() {
            match news {
                News::Report(tile) => {
                    self.map.insert(&tile);
                    finished |= self.map.share() >= 1.0;
                    self.picture.outdated();
                }
                News::Failed(text) => {
                    self.message = Some(text);
                    finished = true;
                }
                News::Progress(..) => {}
            }
        }
        if finished {
            self.job = None;
        }
    }

    /// The map in one sentence.
    fn answer_ui(&self, ui: &mut egui::Ui) {
        if let Some(message) = &self.message {
            ui.colored_label(ui.visuals().warn_fg_color, tr(message));
        }
        theme::answer_ui(ui, self.answer());
        theme::running_text(ui, |ui| {
            ui.label(tr(
                "Click a point to set it in Explore. Try another quantity: where is the describing function worst?"));
            if self.job.is_some() {
                motion::busy_ui(ui);
                ui.label(format!("{:.0} %", 100.0 * self.map.share()));
            }
        });
    }

    fn answer(&self) -> Message {
        let values = self.map.values(self.quantity);
        let (Some(least), Some(most)) = (values.first(), values.last()) else {
            return match self.map.share() {
                0.0 => "Computing the first cycles ...".into(),
                _ => "None of these loops oscillates.".into(),
            };
        };
        let silent = self.map.silent_share();
        let tail = if silent > 0.0 {
            msg!(
                "{} % of these loops do not oscillate.",
                fixed(100.0 * silent, 0)
            )
        } else {
            Message::default()
        };
        let (from, to) = (number(*least), with_unit(*most, self.quantity.unit()));
        let range = match self.quantity {
            Quantity::Period => msg!("Period from {} to {}.", from, to),
            Quantity::Amplitude => msg!("Amplitude a from {} to {}.", from, to),
            Quantity::UltimateGain => msg!("Ultimate gain Ku from {} to {}.", from, to),
            Quantity::PeriodError => msg!(
                "Describing function's error in period from {} to {}.",
                from,
                to
            ),
            Quantity::AmplitudeError => msg!(
                "Describing function's error in amplitude from {} to {}.",
                from,
                to
            ),
            Quantity::Stability => {
                let stable = 100.0 * values.iter().sum::<f64>() / values.len() as f64;
                msg!("{} % of the cycles are stable.", fixed(stable, 0))
            }
        };
        range.and(tail)
    }

    fn picture_ui(&mut self, ui: &mut egui::Ui, height: f32, commands: &mut Vec<Command>) {
        let chosen = self.picture.ui(
            ui,
            &self.input,
            &self.map,
            self.quantity,
            self.shown_point(),
            height,
        );
        if let Some(point) = chosen {
            self.choose(point, commands);
        }
    }

    /// The point that is read out: the one that was chosen, or the loop in *Explore*.
    fn shown_point(&self) -> [f64; 2] {
        let own = |axis: Axis| axis.parameter.read(&self.input.base);
        self.point.unwrap_or_else(|| {
            [self.input.x, self.input.y].map(|axis| own(axis).clamp(axis.from, axis.to))
        })
    }

    /// Reads a point out and sets it in *Explore*.
    fn choose(&mut self, point: [f64; 2], commands: &mut Vec<Command>) {
        self.point = Some(point);
        let input = self.input.with(point);
        self.seen = Some(input.clone());
        commands.push(Command::SetLoop(Box::new(input)));
    }

    /// What the loop at a point does, computed for exactly that point.
    fn read(&mut self, point: [f64; 2]) -> Option<Outcome> {
        self.message.is_none().then(|| {
            let input = self.input.with(point);
            match &self.reading {
                Some((read, outcome)) if *read == input => *outcome,
                _ => {
                    let outcome = Outcome::of(&input, None);
                    self.reading = Some((input, outcome));
                    outcome
                }
            }
        })
    }
}

/// The page as the registry has it.
pub fn page() -> Page {
    Page::new("maps", "Maps", Maps::default())
}

impl View for Maps {
    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        self.follow(&desk.relay_loop);
        let commands = &mut desk.commands;
        let narrow = ui.available_width() < layout::NARROW;
        if narrow {
            self.narrow_ui(ui, commands);
            return;
        }
        egui::Panel::left("map choices")
            .exact_size(layout::side(ui, 350.0))
            .resizable(false)
            .show(ui, |ui| {
                theme::scroll("maps_side").show(ui, |ui| {
                    self.choices_ui(ui);
                    self.update(ui.ctx());
                    ui.separator();
                    self.point_ui(ui, commands);
                });
            });
        egui::CentralPanel::default().show(ui, |ui| {
            self.answer_ui(ui);
            let height = ui.available_height();
            self.picture_ui(ui, height, commands);
        });
    }

    fn hook_state(&self) -> serde_json::Value {
        serde_json::json!({
            "busy": self.job.is_some(),
            "share": self.map.share(),
            "point": self.point,
            "message": self.message,
            "answer": self.answer(),
        })
    }

    fn offer(&self) -> Offer<'_> {
        let hint = Hint::open(
            "Give the plant a dead time instead of widening the hysteresis, and see how slow it can get.",
            "v1;maps;maps.across.parameter=dead_time;maps.across.from=0;maps.across.to=2",
        );
        Offer::new(hint, ["map"], || self.tables())
    }
}

impl Maps {
    fn narrow_ui(&mut self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        self.update(ui.ctx());
        // The answer and the map stay in view while a slider below them is turned.
        let pinned = layout::pins(ui);
        let square = ui.available_width() + 40.0;
        if pinned {
            let height = square.min(PINNED * ui.available_height());
            egui::Panel::top("maps_answer").show(ui, |ui| {
                self.answer_ui(ui);
                self.picture_ui(ui, height, commands);
            });
        }
        egui::CentralPanel::default().show(ui, |ui| {
            theme::scroll("maps").show(ui, |ui| {
                if pinned {
                    self.point_ui(ui, commands);
                    ui.separator();
                    self.choices_ui(ui);
                } else {
                    self.answer_ui(ui);
                    self.picture_ui(ui, square, commands);
                    self.choices_ui(ui);
                    ui.separator();
                    self.point_ui(ui, commands);
                }
                self.update(ui.ctx());
            });
        });
    }

    /// The numbers behind what is shown.
    fn tables(&self) -> Vec<Table> {
        let size = self.map.size();
        let known: Vec<_> = (0..size * size)
            .map(|i| [i % size, i / size])
            .filter_map(|place| Some((place, self.map.known(place)?)))
            .collect();
        let (x, y) = (self.input.x, self.input.y);
        let title =
            |axis: Axis| axis_title(axis.parameter.label(), axis.parameter.unit()).to_string();
        let mut table = Table::new("map")
            .with(title(x), known.iter().map(|(p, _)| x.value(p[0], size)))
            .with(title(y), known.iter().map(|(p, _)| y.value(p[1], size)));
        for quantity in Quantity::ALL {
            let title = axis_title(quantity.label(), quantity.unit()).to_string();
            let values = known
                .iter()
                .map(|(_, o)| quantity.value(o).unwrap_or(f64::NAN));
            table = table.with(title, values);
        }
        vec![table]
    }
}
