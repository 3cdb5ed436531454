//! The formula of what no effect explains: looked for beside the page, shown by its length, added by a click.

use egui_plot::{Line, PlotPoints, Points};
use hysteron_core::diagnosis::{Discovery, FoundFormula};
use hysteron_core::effect::EffectId;
use hysteron_core::uncertain::brief;
use hysteron_work::tasks::DiscoveryTask;

use super::command::Command;
use super::formula::Typed;
use super::state::Compare;
use crate::hook::Targets;
use crate::jobs::Job;
use crate::language::tr;
use crate::theme;
use crate::widgets::chart::Chart;

/// Formulas that are buttons.
const MOST: usize = 6;

/// Height of the plot, and width of its labels of y, points.
const HEIGHT: f32 = 150.0;
const AXIS_WIDTH: f32 = 60.0;

/// A search beside the model with these effects, and how far it is.
pub(super) struct Searching {
    effects: Vec<EffectId>,
    job: Job<DiscoveryTask>,
    progress: (f64, String),
}

/// What was looked for, and what was found.
#[derive(Default)]
pub(super) struct Unknown {
    searching: Option<Searching>,
    found: Vec<(Vec<EffectId>, Discovery)>,
}

impl Unknown {
    /// Whether it looks for a formula.
    pub fn is_busy(&self) -> bool {
        self.searching.is_some()
    }
}

impl Compare {
    /// Looks for a formula beside the model on screen.
    pub(super) fn discover(&mut self, ctx: &egui::Context) {
        let (Some(measurement), Some(effects)) = (&self.measurement, &self.shown) else {
            return;
        };
        let task = DiscoveryTask {
            measurement: Box::new((**measurement).clone()),
            effects: effects.clone(),
            model: self.model.clone(),
        };
        self.unknown.searching = Some(Searching {
            effects: effects.clone(),
            job: Job::run(ctx, task),
            progress: (0.0, String::new()),
        });
    }

    /// Takes what was found.
    pub(super) fn take_discovery(&mut self) {
        let Some(searching) = &mut self.unknown.searching else {
            return;
        };
        let progress = &mut searching.progress;
        let Some(end) = searching.job.end(|share, text| *progress = (share, text)) else {
            return;
        };
        let effects = std::mem::take(&mut searching.effects);
        self.unknown.searching = None;
        match end {
            Ok(found) => self.unknown.found.push((effects, found)),
            Err(text) => self.message = Some(text),
        }
    }

    /// What was found beside the model on screen.
    pub(super) fn discovery(&self) -> Option<&Discovery> {
        let shown = self.shown.as_ref()?;
        let mut all = self.unknown.found.iter().rev();
        all.find(|(effects, _)| effects == shown).map(|(_, d)| d)
    }

    /// The search, or what it found.
    pub(super) fn unknown_ui(
        &self,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        if let Some(searching) = &self.unknown.searching {
            let (share, text) = &searching.progress;
            ui.add(egui::ProgressBar::new(*share as f32).text(tr(text)));
            if ui.button(tr("Cancel")).clicked() {
                commands.push(Command::Discover(false));
            }
            return;
        }
        let Some(discovery) = self.discovery() else {
            let look = ui
                .add_enabled(
                    self.job.is_none(),
                    egui::Button::new(tr("Look for a formula")),
                )
                .on_hover_text(tr(
                    "Tries sums of up to three terms in the equation of motion; it takes a minute",
                ));
            targets.note("discover", ui, &look);
            if look.clicked() {
                commands.push(Command::Discover(true));
            }
            return;
        };
        ui.strong(tr("The formula of the unknown"));
        ui.label(tr(&discovery.text));
        let listed = discovery
            .class()
            .chain(front(discovery).filter(|f| !f.in_class));
        ui.horizontal_wrapped(|ui| {
            for formula in listed.take(MOST) {
                self.formula_button(formula, ui, targets, commands);
            }
        });
        front_ui(discovery, ui);
    }

    fn formula_button(
        &self,
        found: &FoundFormula,
        ui: &mut egui::Ui,
        targets: &mut Targets,
        commands: &mut Vec<Command>,
    ) {
        let Some(measurement) = &self.measurement else {
            return;
        };
        let title = format!("{}  ({})", found.formula, brief(found.error));
        let add = ui
            .add_enabled(self.job.is_none(), egui::Button::new(title))
            .on_hover_text(tr("Add this force and fit it"));
        targets.note(format!("discovered:{}", found.name), ui, &add);
        if add.clicked() {
            let (_, typed) = found.typed.split_once(':').unwrap_or_default();
            commands.push(Command::AddOwn(Typed {
                kind: measurement.kind,
                name: self.free_name(&found.name),
                formula: typed.trim().to_owned(),
            }));
        }
    }
}

/// Formulas that leave less than every shorter one.
fn front(discovery: &Discovery) -> impl Iterator<Item = &FoundFormula> {
    discovery.formulas.iter().filter(|f| f.on_front)
}

/// Error against length: all that were tried, and the front.
fn front_ui(discovery: &Discovery, ui: &mut egui::Ui) {
    if discovery.formulas.is_empty() {
        return;
    }
    let at = |f: &FoundFormula| [f.length as f64, f.error];
    let tried: Vec<[f64; 2]> = discovery.formulas.iter().map(at).collect();
    let mut line = vec![[0.0, discovery.before]];
    line.extend(front(discovery).map(at));
    let axes = ["length of the formula", "error [noise]"];
    let chart = Chart::new("formulas", axes, HEIGHT, AXIS_WIDTH).still();
    chart.show(ui, |plot| {
        plot.line(
            Line::new("", PlotPoints::from(line))
                .color(theme::MODEL)
                .width(1.5),
        );
        plot.points(
            Points::new("", PlotPoints::from(tried))
                .color(theme::RESIDUAL)
                .radius(3.0),
        );
    });
    ui.small(tr(
        "Every formula that was simulated, by the names, numbers and signs in it; the line joins those that leave least for their length.",
    ));
}
