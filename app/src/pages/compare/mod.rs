//! What is missing from the model? A measurement, the model's replay, and the effects that could be added.

mod export;
mod missing;
mod own;
mod plots;
mod settings;
mod side;

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use hysteron_core::criticism::{StepReport, with_error};
use hysteron_core::effect::{self, Effect, EffectId};
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::user_model::UserModel;

use super::{Desk, View};
pub use settings::is_built_in;

use crate::document::parsed;
use crate::hook::Targets;
use crate::jobs::{Job, News};
use crate::save::save;
use crate::theme;

/// A measurement that comes with the app.
struct BuiltIn {
    id: &'static str,
    title: &'static str,
    story: &'static str,
    csv: &'static [u8],
}

const BUILT_IN: [BuiltIn; 3] = [
    BuiltIn {
        id: "drive-02",
        title: "A drive that loses its swing",
        story: "A motor under a velocity relay. It never moves quite as far as its inertia says it should.",
        csv: include_bytes!("../../../../assets/measurements/drive-02.csv"),
    },
    BuiltIn {
        id: "drive-12",
        title: "A drive that answers late",
        story: "The same rig with another amplifier and older bearings. One effect is not enough.",
        csv: include_bytes!("../../../../assets/measurements/drive-12.csv"),
    },
    BuiltIn {
        id: "process-02",
        title: "A slow heating process",
        story: "A heater switched by a relay. The temperature overshoots both limits, every time.",
        csv: include_bytes!("../../../../assets/measurements/process-02.csv"),
    },
];

/// A file that is being read elsewhere: its name, and its bytes or why there are none.
type Arrival = (String, Result<Vec<u8>, String>);

/// The page.
pub struct Compare {
    measurement: Option<Arc<Measurement>>,
    source: export::Source,
    /// What the user knows of the model.
    model: Option<UserModel>,
    /// The file that says it.
    model_file: Option<String>,
    /// Effects of the user's own that were added here, as the command line takes them.
    own: Vec<String>,
    /// The formula in the editor.
    typed: own::Typed,
    /// Effects on top of the baseline, in the order in which they were added.
    effects: Vec<EffectId>,
    /// Finished steps by their effects, so that undo is instant.
    reports: HashMap<Vec<EffectId>, StepReport>,
    /// Effects of the step on screen: the last one finished.
    shown: Option<Vec<EffectId>>,
    job: Option<Job>,
    progress: (f64, String),
    message: Option<String>,
    /// The finding that is shaded.
    finding: usize,
    arrivals: (Sender<Arrival>, Receiver<Arrival>),
    /// What saving a file has to say.
    saved: (Sender<String>, Receiver<String>),
}

impl Default for Compare {
    fn default() -> Self {
        Self {
            measurement: None,
            source: export::Source::default(),
            model: None,
            model_file: None,
            own: Vec::new(),
            typed: own::Typed::default(),
            effects: Vec::new(),
            reports: HashMap::new(),
            shown: None,
            job: None,
            progress: (0.0, String::new()),
            message: None,
            finding: 0,
            arrivals: channel(),
            saved: channel(),
        }
    }
}

/// What a click asks for; carried out once, after drawing.
#[derive(Clone)]
enum Command {
    OpenBuiltIn(usize),
    OpenDialog,
    Close,
    Add(EffectId),
    Undo,
    Cancel,
    Shade(usize),
    Dismiss,
    ExportReport,
    SaveModel,
    OpenModel,
    DropModel,
    Type(own::Typed),
    AddOwn(own::Typed),
}

impl Compare {
    /// Opens a measurement, or a model (TOML), from the bytes of a file; a bad one leaves everything as it was.
    pub fn open(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        if name.to_ascii_lowercase().ends_with(".toml") {
            return self.open_model(ctx, name, bytes);
        }
        match import_csv(name, bytes, None) {
            Ok(measurement) => {
                self.message = measurement.warnings.first().cloned();
                self.measurement = Some(Arc::new(measurement));
                self.source = export::Source::of(bytes);
                let kind = self.measurement.as_ref().map(|m| m.kind);
                if self.model.as_ref().is_some_and(|m| Some(m.kind) != kind) {
                    self.forget_model();
                }
                self.restart(ctx);
            }
            Err(error) => self.message = Some(error.to_string()),
        }
    }

    /// Takes a model and begins anew with it.
    fn open_model(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        let read = str::from_utf8(bytes)
            .map_err(|_| "a model must be UTF-8 text".to_owned())
            .and_then(|text| UserModel::from_toml(text).map_err(|e| e.to_string()));
        match (read, &self.measurement) {
            (Err(error), _) => self.message = Some(format!("{name}, {error}")),
            (Ok(model), Some(measurement)) if model.kind != measurement.kind => {
                self.message = Some(format!(
                    "{name} is the model of a {}, but {} is the measurement of a {}.",
                    model.kind.name(),
                    measurement.name,
                    measurement.kind.name()
                ));
            }
            (Ok(model), _) => {
                self.message = None;
                self.forget_model();
                self.model = Some(model);
                self.model_file = Some(name.to_owned());
                self.restart(ctx);
            }
        }
    }

    fn forget_model(&mut self) {
        self.model = None;
        self.model_file = None;
        self.own.clear();
    }

    /// Adds an effect of the user's own to the model.
    fn add_own(&mut self, ctx: &egui::Context, typed: &own::Typed) {
        let Some(measurement) = &self.measurement else {
            return;
        };
        let blank = || UserModel::blank(measurement.kind);
        let mut model = self.model.clone().unwrap_or_else(blank);
        match model.add_candidate(&typed.line()) {
            Ok(()) => {
                self.message = None;
                self.effects.extend(model.candidates.last().map(|c| c.id));
                self.model = Some(model);
                self.own.push(typed.line());
                self.start(ctx);
            }
            Err(error) => self.message = Some(error),
        }
    }

    /// Begins with the first model again.
    fn restart(&mut self, ctx: &egui::Context) {
        self.effects.clear();
        self.reports.clear();
        self.shown = None;
        self.finding = 0;
        self.start(ctx);
    }

    /// Opens a file that was dropped on the window.
    pub fn open_dropped(&mut self, ctx: &egui::Context, file: &egui::DroppedFileHandle) {
        let name = file
            .path()
            .file_name()
            .map_or_else(|| "file".into(), |n| n.to_string_lossy().into_owned());
        let (sender, ctx, file) = (self.arrivals.0.clone(), ctx.clone(), Arc::clone(file));
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || {
            let _ = sender.send((name, file.bytes()));
            ctx.request_repaint();
        });
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(async move {
            let bytes = file.bytes_async().await;
            let _ = sender.send((name, bytes));
            ctx.request_repaint();
        });
    }

    fn open_dialog(&self, ctx: &egui::Context, kind: &str, endings: &[&str]) {
        let (sender, ctx) = (self.arrivals.0.clone(), ctx.clone());
        let dialog = rfd::AsyncFileDialog::new().add_filter(kind, endings);
        let pick = async move {
            if let Some(file) = dialog.pick_file().await {
                let bytes = file.read().await;
                let _ = sender.send((file.file_name(), Ok(bytes)));
                ctx.request_repaint();
            }
        };
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(pick);
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || pollster::block_on(pick));
    }

    /// Takes what jobs and files have brought.
    pub fn update(&mut self, ctx: &egui::Context) {
        while let Ok((name, bytes)) = self.arrivals.1.try_recv() {
            match bytes {
                Ok(bytes) => self.open(ctx, &name, &bytes),
                Err(error) => self.message = Some(format!("{name}: cannot be read ({error})")),
            }
        }
        if let Some(text) = self.saved.1.try_iter().last() {
            self.message = Some(text);
        }
        let news = self.job.as_mut().map(Job::news).unwrap_or_default();
        for news in news {
            match news {
                News::Progress(fraction, text) => self.progress = (fraction, text),
                News::Report(report) => {
                    self.reports.insert(self.effects.clone(), *report);
                    self.shown = Some(self.effects.clone());
                    self.finding = 0;
                    self.job = None;
                }
                News::Failed(text) => {
                    self.message = Some(text);
                    self.job = None;
                }
            }
        }
    }

    /// Shows the step of the present effects: at once if it is known, else by a job.
    fn start(&mut self, ctx: &egui::Context) {
        self.job = None;
        if self.reports.contains_key(&self.effects) {
            self.shown = Some(self.effects.clone());
        } else if let Some(measurement) = &self.measurement {
            self.progress = (0.0, "Starting".to_owned());
            let model = self.model.as_ref();
            self.job = Some(Job::start(ctx, measurement, &self.effects, model));
        }
    }

    /// The step on screen.
    fn report(&self) -> Option<&StepReport> {
        self.reports.get(self.shown.as_ref()?)
    }

    /// Draws the page and carries out what was clicked.
    pub fn ui(&mut self, ui: &mut egui::Ui, targets: &mut Targets) {
        let mut commands = Vec::new();
        if self.measurement.is_some() {
            let narrow = ui.available_width() < 700.0;
            if narrow {
                egui::CentralPanel::default().show(ui, |ui| {
                    egui::ScrollArea::vertical().show(ui, |ui| {
                        self.answer_ui(ui);
                        side::ui(self, ui, targets, &mut commands);
                        plots::ui(self, ui, 220.0);
                    });
                });
            } else {
                egui::Panel::right("effects")
                    .default_size(400.0)
                    .min_size(320.0)
                    .show(ui, |ui| {
                        egui::ScrollArea::vertical()
                            .show(ui, |ui| side::ui(self, ui, targets, &mut commands));
                    });
                egui::CentralPanel::default().show(ui, |ui| {
                    self.answer_ui(ui);
                    self.message_ui(ui, &mut commands);
                    self.findings_ui(ui, &mut commands);
                    let height = ui.available_height();
                    plots::ui(self, ui, height);
                });
            }
        } else {
            egui::CentralPanel::default()
                .show(ui, |ui| self.welcome_ui(ui, targets, &mut commands));
        }
        for command in commands {
            self.carry_out(ui.ctx(), command);
        }
    }

    fn carry_out(&mut self, ctx: &egui::Context, command: Command) {
        match command {
            Command::OpenBuiltIn(index) => {
                if let Some(built_in) = BUILT_IN.get(index) {
                    self.open(ctx, built_in.id, built_in.csv);
                }
            }
            Command::OpenDialog => self.open_dialog(ctx, "Measurement", &["csv", "txt", "tsv"]),
            Command::OpenModel => self.open_dialog(ctx, "Model", &["toml"]),
            Command::Type(typed) => self.typed = typed,
            Command::AddOwn(typed) => self.add_own(ctx, &typed),
            Command::DropModel => {
                self.forget_model();
                self.restart(ctx);
            }
            Command::Close => {
                let arrivals = std::mem::replace(&mut self.arrivals, channel());
                *self = Self {
                    arrivals,
                    ..Self::default()
                };
            }
            Command::Add(effect) => {
                self.effects.push(effect);
                self.start(ctx);
            }
            Command::Undo => {
                self.effects.pop();
                self.start(ctx);
            }
            Command::Cancel => {
                self.job = None;
                match &self.shown {
                    Some(shown) => self.effects.clone_from(shown),
                    None => self.measurement = None,
                }
            }
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

    fn welcome_ui(&self, ui: &mut egui::Ui, targets: &mut Targets, commands: &mut Vec<Command>) {
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.add_space(16.0);
            theme::answer_ui(ui, "What is missing from the model?");
            ui.label("Take a measurement. Hysteron fits the simplest model to it, shows where that fails, and which physical effect would explain the rest.");
            self.message_ui(ui, commands);
            ui.add_space(12.0);
            for (index, built_in) in BUILT_IN.iter().enumerate() {
                egui::Frame::group(ui.style()).show(ui, |ui| {
                    ui.set_width(ui.available_width().min(620.0));
                    ui.strong(built_in.title);
                    ui.label(built_in.story);
                    let button = ui.button(format!("Open {}", built_in.id));
                    targets.note(format!("builtin:{}", built_in.id), ui, &button);
                    if button.clicked() {
                        commands.push(Command::OpenBuiltIn(index));
                    }
                });
            }
            ui.add_space(12.0);
            ui.label("Or your own: drop a CSV file anywhere on this window, or");
            if ui.button("Open a file ...").clicked() {
                commands.push(Command::OpenDialog);
            }
            ui.small("Its first line names the columns with units: t [s],u [N m],x1 [rad],v1 [rad/s] for a drive, t [s],u [1],y [1] for a process.");
        });
    }

    fn message_ui(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        if let Some(message) = &self.message {
            ui.horizontal_wrapped(|ui| {
                ui.colored_label(ui.visuals().warn_fg_color, message);
                if ui.small_button("Dismiss").clicked() {
                    commands.push(Command::Dismiss);
                }
            });
        }
    }

    fn answer_ui(&self, ui: &mut egui::Ui) {
        let text = match self.report() {
            None => "Fitting the simplest model ...".to_owned(),
            Some(report) => {
                let present = self.model.as_ref().map(UserModel::present);
                answer(report, &present.unwrap_or_default())
            }
        };
        theme::answer_ui(ui, &text);
    }

    fn findings_ui(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        let Some(report) = self.report() else {
            return;
        };
        for (index, finding) in report.step.findings.iter().enumerate().take(3) {
            let row = ui.selectable_label(self.finding == index, &finding.text);
            if row
                .on_hover_text("Click to shade it in the plots")
                .clicked()
            {
                commands.push(Command::Shade(index));
            }
        }
    }

    /// What is on the screen, for tests.
    pub fn hook_state(&self) -> serde_json::Value {
        let report = self.report();
        serde_json::json!({
            "busy": self.job.is_some(),
            "progress": self.progress.0,
            "file": self.measurement.as_ref().map(|m| m.name.clone()),
            "effects": report.map(|r| r.step.effects.clone()),
            "error": report.map(|r| r.step.error),
            "noise_floor": report.map(|r| r.noise_floor),
            "candidates": report.map_or_else(Vec::new, |r| {
                r.step.candidates.iter().map(|c| serde_json::json!({"effects": c.effects, "error": c.error})).collect()
            }),
            "verdict": report.and_then(|r| r.verdict.as_ref()).map(|v| v.text.clone()),
            "model": self.model_file,
            "message": self.message,
        })
    }
}

impl View for Compare {
    fn id(&self) -> &'static str {
        "compare"
    }

    fn title(&self) -> &'static str {
        "Compare"
    }

    fn update(&mut self, ctx: &egui::Context) {
        Self::update(self, ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        Self::ui(self, ui, &mut desk.targets);
    }

    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.set_to())
    }

    fn set(
        &mut self,
        ctx: &egui::Context,
        settings: &serde_json::Value,
        _desk: &Desk,
    ) -> Result<(), String> {
        self.take(ctx, &parsed(settings)?)
    }

    fn hook_state(&self) -> serde_json::Value {
        Self::hook_state(self)
    }

    fn takes_files(&self) -> bool {
        true
    }

    fn open(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        Self::open(self, ctx, name, bytes);
    }

    fn open_dropped(&mut self, ctx: &egui::Context, file: &egui::DroppedFileHandle) {
        Self::open_dropped(self, ctx, file);
    }
}

/// Name of an effect on screen.
fn name_of(id: EffectId) -> &'static str {
    effect::find(id).map_or(id.as_str(), Effect::name)
}

/// An error in noise units, three digits.
fn times_noise(error: f64) -> String {
    if error >= 100.0 {
        format!("{error:.0}")
    } else if error >= 10.0 {
        format!("{error:.1}")
    } else {
        format!("{error:.2}")
    }
}

/// The page's answer in one or two sentences; `present` are the effects of the user's model.
fn answer(report: &StepReport, present: &[EffectId]) -> String {
    let step = &report.step;
    let added: Vec<String> = step
        .effects
        .iter()
        .filter(|e| **e != effect::VISCOUS_FRICTION && !present.contains(e))
        .map(|id| {
            let main = step.parameters.iter().find(|p| p.effect == Some(*id));
            main.map_or_else(
                || name_of(*id).to_owned(),
                |p| {
                    format!(
                        "{}: {}",
                        name_of(*id),
                        with_error(p.value, p.std_error, &p.unit)
                    )
                },
            )
        })
        .collect();
    match (&report.verdict, added.is_empty()) {
        (Some(verdict), false) if verdict.complete => {
            let ambiguous = verdict.missing.iter().any(|class| class.len() > 1);
            let tail = if ambiguous {
                "Another effect would explain it as well."
            } else {
                "Nothing more is missing."
            };
            format!("The missing effect was {}. {tail}", added.join(" and "))
        }
        (Some(verdict), true) if verdict.complete => {
            "Nothing is missing: what the model leaves is measurement noise.".to_owned()
        }
        (Some(verdict), _) if !verdict.contradicted.is_empty() => {
            let names: Vec<&str> = verdict
                .contradicted
                .iter()
                .map(|c| c.name.as_str())
                .collect();
            format!("The data contradict the known {}.", names.join(" and "))
        }
        _ => format!(
            "The model misses by {} times the noise.",
            times_noise(step.error)
        ),
    }
}
