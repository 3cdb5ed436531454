//! What is missing from the model? A measurement, the model's replay, and the effects that could be added.

mod answer;
mod atlas;
mod awaited;
mod built_in;
mod by_hand;
mod command;
mod discover;
mod experiment;
mod export;
mod fingerprint;
mod formula;
mod formulas;
mod guess;
mod hand;
mod hint;
mod hints;
mod history;
mod look;
mod missing;
mod open;
mod opening;
mod own;
mod parameters;
mod parts;
mod plots;
mod reveal;
mod sealed;
mod settings;
mod side;
mod state;
mod unknown;
mod waterfall;
mod welcome;

use hysteron_core::diagnosis::Discovery;
use hysteron_core::message::Message;
use hysteron_core::msg;

use crate::desk::Desk;
use crate::export::Table;
use crate::files::{MEASUREMENT, MODEL};
use crate::hook::Targets;
use crate::jobs::ended;
use crate::language::tr;
use crate::layout;
use crate::page::{Offer, Page, View};
use crate::save::save;
use crate::theme;
use crate::widgets::columns::{Form, Wanted};
use built_in::{BUILT_IN, BuiltIn};
use command::Command;
use look::Look;
use opening::Opening;
use sealed::Sealed;
pub use state::Compare;

/// Height of the plots over time in a narrow window, points.
const NARROW_PLOTS: f32 = 220.0;

/// Longest time without a new frame while a job runs.
const ALIVE: std::time::Duration = std::time::Duration::from_millis(100);

impl Compare {
    /// Takes what jobs and files have brought.
    pub fn update(&mut self, ctx: &egui::Context) {
        self.follow(ctx);
        while let Some(arrival) = self.files.arrived() {
            let name = arrival.name;
            match arrival.bytes {
                Ok(bytes) => self.open_as(ctx, &name, bytes, arrival.reading),
                Err(error) => {
                    self.refuse(msg!(
                        "{}: cannot be read ({})",
                        Message::name(name),
                        Message::name(error)
                    ));
                }
            }
        }
        if let Some(sentence) = self.files.refused() {
            self.refuse(sentence);
        }
        self.take_opened(ctx);
        if let Some(text) = self.saved.1.try_iter().last() {
            self.message = Some(text);
        }
        if self.job.is_some() || self.opening.is_some() || self.unknown.is_busy() {
            // The page shows that it lives, also where the job says nothing new for a while.
            ctx.request_repaint_after(ALIVE);
        }
        let progress = &mut self.progress;
        match ended(&mut self.job, |share, text| *progress = (share, text)) {
            Some(Ok(report)) => {
                self.reports.insert(self.effects.clone(), report);
                self.shown = Some(self.effects.clone());
                self.finding = 0;
            }
            Some(Err(text)) => self.message = Some(text),
            None => {}
        }
        self.take_search();
        self.take_by_hand();
        self.take_earlier(ctx);
        self.take_discovery(ctx);
        if let Some(sealed) = &mut self.sealed {
            sealed.update(self.shown.as_deref().unwrap_or_default());
        }
        self.pay_for_ranking();
    }

    /// Draws the page and carries out what was clicked.
    pub fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let mut commands = Vec::new();
        let targets = &mut desk.targets;
        if self.form.is_some() {
            egui::CentralPanel::default().show(ui, |ui| self.form_ui(ui, targets, &mut commands));
        } else if self.measurement.is_some() {
            let narrow = ui.available_width() < layout::NARROW;
            if narrow {
                egui::CentralPanel::default().show(ui, |ui| {
                    theme::scroll("compare").show(ui, |ui| {
                        // What is seen first, then what could be done: the list of effects is long.
                        self.answer_ui(ui);
                        self.noise_ui(ui);
                        self.message_ui(ui, &mut commands);
                        side::progress_ui(self, ui, &mut commands);
                        let top = ui.cursor().min;
                        self.looks_ui(ui, targets, &mut commands);
                        self.evidence_ui(ui, NARROW_PLOTS, targets, &mut commands);
                        let asked = commands.len();
                        ui.separator();
                        side::file_ui(self, ui, targets, &mut commands);
                        side::findings_ui(self, ui, targets, &mut commands);
                        // What is asked for below stands above.
                        let shows =
                            |c: &Command| matches!(c, Command::Look(_) | Command::Fingerprint(_));
                        if commands.iter().skip(asked).any(shows) {
                            let place = egui::Rect::from_min_size(top, egui::Vec2::ZERO);
                            ui.scroll_to_rect(place, Some(egui::Align::TOP));
                        }
                    });
                });
            } else {
                let whole = ui.available_width();
                egui::Panel::right("effects")
                    .default_size(desk.side.width(ui, 400.0))
                    .min_size(320.0)
                    .show(ui, |ui| {
                        layout::side_ui(ui, "compare_side", |ui| {
                            side::ui(self, ui, targets, &mut commands);
                        });
                    });
                desk.side.note(ui, whole - ui.available_width());
                egui::CentralPanel::default().show(ui, |ui| {
                    let low = theme::is_low(ui.ctx());
                    self.answer_ui(ui);
                    if !low {
                        self.noise_ui(ui);
                    }
                    self.message_ui(ui, &mut commands);
                    theme::scroll("compare").show(ui, |ui| {
                        if !low {
                            self.findings_ui(ui, &mut commands);
                        }
                        self.looks_ui(ui, targets, &mut commands);
                        let height = ui.available_height();
                        self.evidence_ui(ui, height, targets, &mut commands);
                        if low {
                            self.findings_ui(ui, &mut commands);
                            self.noise_ui(ui);
                        }
                    });
                });
            }
        } else {
            egui::CentralPanel::default().show(ui, |ui| {
                self.welcome_ui(ui, &desk.recent, targets, &mut commands);
            });
        }
        for command in commands {
            match command {
                Command::Desk(asked) => desk.commands.extend(asked),
                command => self.carry_out(ui.ctx(), command),
            }
        }
        if self.is_behind() {
            ui.ctx().request_repaint();
        }
    }

    /// What the plots may show.
    fn looks_ui(&self, ui: &mut egui::Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
        ui.horizontal_wrapped(|ui| {
            for (look, id, title) in [
                (Look::Time, "time", "Over time"),
                (Look::Places, "places", "Where it fails"),
                (Look::Fingerprint, "fingerprint", "Fingerprints"),
                (Look::Reveal, "reveal", "Reveal"),
            ] {
                if look == Look::Reveal && self.sealed.is_none() {
                    continue;
                }
                let mut tab = ui.selectable_label(self.look == look, tr(title));
                if look == Look::Fingerprint {
                    tab = tab.on_hover_text(tr(fingerprint::FINGERPRINT));
                }
                targets.note(format!("look:{id}"), ui, &tab);
                if tab.clicked() {
                    commands.push(Command::Look(look));
                }
            }
            let mut before = self.before;
            let can =
                self.effects_before().is_some() && matches!(self.look, Look::Time | Look::Places);
            let toggle = ui.add_enabled(
                can,
                egui::Checkbox::new(&mut before, tr("Show the previous step too")),
            );
            targets.note("before", ui, &toggle);
            if toggle.changed() {
                commands.push(Command::Before(before));
            }
        });
    }

    /// The plots; `height` is for those over time.
    fn evidence_ui(
        &self,
        ui: &mut egui::Ui,
        height: f32,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        if self.parts.fresh {
            return;
        }
        if self.look == Look::Time {
            self.formulas_ui(ui, targets, commands);
            self.missing_ui(ui, targets, commands);
        }
        match self.look {
            Look::Time => plots::ui(self, ui, height),
            Look::Places => atlas::ui(self, ui),
            Look::Fingerprint => fingerprint::ui(self, ui, targets, commands),
            Look::Reveal => reveal::ui(self, ui, targets, commands),
        }
    }

    fn carry_out(&mut self, ctx: &egui::Context, command: Command) {
        match command {
            Command::OpenBuiltIn(index) => {
                if let Some(BuiltIn { file, .. }) = BUILT_IN.get(index) {
                    self.opening = Some(Opening::new(ctx, file.id, file.content()));
                }
            }
            Command::Reopen(recent) => self.files.entrance.reopen(ctx, &recent),
            Command::OpenDialog => self.files.entrance.open_dialog(ctx, MEASUREMENT),
            Command::OpenModel => self.files.entrance.open_dialog(ctx, MODEL),
            Command::Type(typed) => self.typed = Some(typed),
            Command::AddOwn(typed) => self.add_own(ctx, &typed),
            Command::DropModel => {
                self.forget_model();
                self.restart(ctx);
            }
            Command::Close => self.close(),
            Command::Map(Wanted::Choose(choice)) => {
                if let Some(form) = &mut self.form {
                    form.choice = *choice;
                }
            }
            Command::Map(Wanted::Open) => self.open_mapped(ctx),
            Command::Map(Wanted::Cancel) => (self.form, self.opening) = (None, None),
            Command::CancelReading => self.opening = None,
            Command::Add(effect) if !self.effects.contains(&effect) => {
                let mut effects = self.effects.clone();
                effects.push(effect);
                self.go_to(ctx, effects);
            }
            Command::Undo => self.step_to(ctx, self.effects.len().saturating_sub(1)),
            Command::Redo => self.step_to(ctx, self.effects.len() + 1),
            Command::Step(n) => self.step_to(ctx, n),
            Command::Look(look) => self.look = look,
            Command::Before(before) => self.before = before,
            Command::Fingerprint(effect) => {
                self.fingerprint = Some(effect);
                self.look = Look::Fingerprint;
            }
            Command::Limit(limits) => self.limits = Some(limits),
            Command::Discover(true) => self.discover(ctx),
            Command::Discover(false) => self.stop_discovery(),
            Command::Search(index, limits) => self.search_again(ctx, index, limits),
            Command::SaveInput(index) => {
                if let Some(document) = export::input(self, index) {
                    save(ctx, document, &self.saved.0);
                }
            }
            Command::Word(word, legible) => {
                if let Some(sealed) = &mut self.sealed {
                    (sealed.word, sealed.legible) = (word, legible);
                }
            }
            Command::Reveal => self.reveal(ctx),
            // Of the list of the step before; what the app is to do.
            Command::Add(_) | Command::Desk(_) => {}
            Command::Cancel => {
                self.job = None;
                match &self.shown {
                    Some(shown) => self.effects.clone_from(shown),
                    None => self.measurement = None,
                }
            }
            Command::Hand(values, held) => self.set_by_hand(ctx, values, held),
            Command::GuessFirst(first) => self.guess_first = first,
            Command::Hint => self.buy_hint(),
            Command::DropHand => self.hand = None,
            Command::Shade(index) => self.finding = index,
            Command::Dismiss => self.message = None,
            Command::ExportReport => {
                if let Some(document) = export::report(self) {
                    save(ctx, document, &self.saved.0);
                }
            }
            Command::SaveModel => {
                if let Some(document) = export::model(self) {
                    save(ctx, document, &self.saved.0);
                }
            }
        }
    }

    /// What is on the screen, for tests.
    pub fn hook_state(&self) -> serde_json::Value {
        let report = self.report();
        serde_json::json!({
            "guessing": self.is_guessing(),
            "by_hand": self.hand_error().map(|(error, exact)| serde_json::json!({"error": error, "exact": exact})),
            "busy": self.is_behind() || self.hand.as_ref().is_some_and(by_hand::Hand::is_busy) || self.opening.is_some() || self.job.is_some() || self.search.is_some() || self.unknown.is_busy() || self.earlier.is_some() || self.sealed.as_ref().is_some_and(Sealed::is_busy),
            "progress": self.progress.0,
            "mapping": self.form.as_ref().map(Form::hook_state),
            "file": self.measurement.as_ref().map(|m| m.name.clone()),
            "effects": report.map(|r| r.step.effects.clone()),
            "error": report.map(|r| r.step.error),
            "noise_floor": report.map(|r| r.noise_floor),
            "candidates": report.map_or_else(Vec::new, |r| {
                r.step.candidates.iter().map(|c| serde_json::json!({"effects": c.effects, "error": c.error})).collect()
            }),
            "verdict": report.and_then(|r| r.verdict.as_ref()).map(|v| v.text.clone()),
            "next_experiment": report.and_then(|r| r.verdict.as_ref()).and_then(|v| v.next_experiment.clone()),
            "experiments": report.and_then(|r| r.verdict.as_ref()).map_or(0, |v| v.experiments.len()),
            "looks": self.unknown.is_busy(),
            "formula": self.discovery().and_then(Discovery::found).map(|f| {
                let values = f.parameters.iter().map(|p| (p.name.clone(), p.value.into()));
                serde_json::json!({"text": f.formula, "values": values.collect::<serde_json::Map<_, _>>()})
            }),
            "steps": self.way_errors(),
            "undone": self.undone,
            "fingerprint": self.chosen(),
            "model": self.model_file,
            "message": self.message,
            "sealed": self.sealed.as_ref().map(|sealed| sealed.hook_state(self.points())),
        })
    }
}

/// The page as the registry has it.
pub fn page() -> Page {
    let mut view = Compare::default();
    let door = view.files.door("Drop the measurement here to compare it");
    Page::new("compare", "Compare", view).with_door(door)
}

impl View for Compare {
    fn update(&mut self, ctx: &egui::Context) {
        Self::update(self, ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        Self::ui(self, ui, desk);
    }

    fn hook_state(&self) -> serde_json::Value {
        Self::hook_state(self)
    }

    fn offer(&self) -> Offer<'_> {
        Offer::new(self.next(), self.table_names(), || self.tables())
    }
}

impl Compare {
    /// Names of the tables that can be given now.
    fn table_names(&self) -> Vec<&'static str> {
        self.measurement
            .iter()
            .map(|_| "measurement and model")
            .collect()
    }

    /// The numbers behind what is shown.
    fn tables(&self) -> Vec<Table> {
        let Some(measurement) = &self.measurement else {
            return Vec::new();
        };
        let title = |name: &str, unit: &str| format!("{name} [{unit}]");
        let input = &measurement.input;
        let mut table = Table::new("measurement and model")
            .with("t [s]", measurement.time.iter().copied())
            .with(
                title(&input.name, &input.unit),
                input.values.iter().copied(),
            );
        for output in &measurement.outputs {
            table = table.with(
                title(&output.name, &output.unit),
                output.values.iter().copied(),
            );
        }
        let modelled = self.report().map(|r| &r.replay.channels);
        for channel in modelled.into_iter().flatten() {
            let name = format!("{} of the model", channel.name);
            table = table.with(
                title(&name, &channel.unit),
                channel.modelled.iter().copied(),
            );
        }
        vec![table]
    }
}
