//! Does it hunt? A drive with dry friction, cogging or play under a P, PI or PID controller of its position.

mod controls;
mod plots;
mod settings;
mod words;

use hysteron_core::hunting::{HuntingCycle, HuntingData, Servo};
use hysteron_work::tasks::ServoTask;
use serde_json::{Value, json};

use super::cycle_table::{self, Row};
use crate::command::Command;
use crate::export::Table;
use crate::jobs::{Job, ended};
use crate::language::tr;
use crate::layout;
use crate::page::Hint;
use crate::theme;
use controls::Controls;
pub use settings::Settings;
use words::Verdict;

/// Name of [`Hunting::tables`].
const TABLE: &str = "servo";

/// What is set, and what follows from it.
#[derive(Default)]
pub struct Hunting {
    pub set: Settings,
    controls: Controls,
    asked: Option<Servo>,
    job: Option<Job<ServoTask>>,
    /// The last result; it stays while the next is computed.
    shown: Option<(Servo, Box<HuntingData>)>,
    message: Option<String>,
}

impl Hunting {
    /// Sets what comes from elsewhere than the sliders: they reach as far as it needs them.
    pub fn put(&mut self, set: Settings) {
        self.controls.fit(&set);
        self.set = set;
    }

    /// Takes what the job has brought.
    pub fn update(&mut self) {
        match (ended(&mut self.job, |_, _| ()), &self.asked) {
            (Some(Ok(data)), Some(asked)) => {
                self.shown = Some((*asked, Box::new(data)));
                self.message = None;
            }
            (Some(Err(text)), _) => self.message = Some(text),
            _ => {}
        }
    }

    /// Computes anew where something was changed and nothing is computed.
    pub fn ask(&mut self, ctx: &egui::Context) {
        let servo = self.set.servo();
        if self.job.is_none() && self.asked != Some(servo) {
            self.asked = Some(servo);
            self.job = Some(Job::run(ctx, ServoTask(servo)));
        }
    }

    pub fn controls_ui(&mut self, ui: &mut egui::Ui) {
        self.controls.ui(ui, &mut self.set);
    }

    pub fn answer_ui(&self, ui: &mut egui::Ui) {
        ui.label(tr("Does it hunt?"));
        if let Some(message) = &self.message {
            ui.colored_label(ui.visuals().warn_fg_color, tr(message));
            return;
        }
        match &self.shown {
            None => theme::answer_ui(ui, "Computing ..."),
            Some((servo, data)) if self.job.is_some() && self.asked.as_ref() != Some(servo) => {
                theme::answer_of_before_ui(ui, &words::answer(servo, data));
            }
            Some((servo, data)) => theme::answer_ui(ui, &words::answer(servo, data)),
        }
    }

    pub fn reasons_ui(&self, ui: &mut egui::Ui) {
        if let Some((servo, data)) = &self.shown {
            for sentence in words::reasons(servo, data) {
                ui.label(tr(sentence));
            }
        }
    }

    pub fn plots_ui(&self, ui: &mut egui::Ui, height: f32) {
        let Some((servo, data)) = &self.shown else {
            return;
        };
        let half = 0.5 * height;
        plots::position_ui(ui, servo, data, half);
        if layout::room_for_two(ui) {
            ui.columns(2, |columns| {
                plots::torque_ui(&mut columns[0], servo, data, half);
                plots::phase_ui(&mut columns[1], data, half);
            });
        } else {
            plots::torque_ui(ui, servo, data, half);
            plots::phase_ui(ui, data, half);
        }
    }

    pub fn numbers_ui(&self, ui: &mut egui::Ui) {
        let Some((_, data)) = &self.shown else {
            return;
        };
        let row = |values: Option<([f64; 2], Option<bool>)>| Row {
            values: values.map(|([period, amplitude], _)| [1.0 / period, amplitude.to_degrees()]),
            stable: values.and_then(|v| v.1),
        };
        let cycle = |c: &HuntingCycle| ([c.period, c.amplitude], c.stable);
        let rows = [
            row(words::balance(data).map(|b| ([b.period, b.amplitude], b.stable))),
            row(data.exact.as_ref().map(cycle)),
            row(data.simulated.as_ref().map(cycle)),
        ];
        ui.separator();
        cycle_table::ui(ui, ["frequency [Hz]", "amplitude [°]"], &rows);
        ui.small(tr(
            "Amplitude: half of peak to peak of the measured position.",
        ));
    }

    pub fn state(&self) -> Value {
        let data = self.shown.as_ref();
        let cycle = |c: &HuntingCycle| json!({"period": c.period, "frequency": 1.0 / c.period, "amplitude": c.amplitude, "stuck": c.stuck});
        json!({
            "busy": self.job.is_some(),
            "message": self.message,
            "answer": data.map(|(servo, data)| words::answer(servo, data)),
            "verdict": data.map(|(servo, data)| words::verdict(servo, data).id()),
            "servo": self.set,
            "exact": data.and_then(|(_, d)| d.exact.as_ref().map(cycle)),
            "simulated": data.and_then(|(_, d)| d.simulated.as_ref().map(cycle)),
            "describing_function": data.and_then(|(_, d)| {
                words::balance(d).map(|b| json!({"period": b.period, "amplitude": b.amplitude}))
            }),
        })
    }

    /// What to try next.
    pub fn hint(&self) -> Option<Hint> {
        let (servo, data) = self.shown.as_ref()?;
        let mut next = self.set.clone();
        let usual = Settings::default();
        let sentence = match words::verdict(servo, data) {
            Verdict::Hunts | Verdict::HuntsWithoutPattern if next.half_gap > 0.0 => {
                next.half_gap = 0.0;
                "Take the play away: does it still hunt?"
            }
            Verdict::Hunts | Verdict::HuntsWithoutPattern if next.integral > 0.0 => {
                next.integral = 0.0;
                "Take the integral away: does it still hunt, and where does it stop?"
            }
            Verdict::StopsShort => {
                next.integral = usual.integral;
                "Give it an integral: does it come to where it should be?"
            }
            Verdict::Settles => {
                next.half_gap = 0.02;
                "Put play between the motor and what is measured: does it hunt then?"
            }
            _ => {
                next = usual;
                "Back to the servo that sticks and slips."
            }
        };
        Some(Hint {
            sentence: sentence.to_owned(),
            commands: vec![Command::Set("explore", "servo", json!(next))],
        })
    }

    /// Names of the tables that can be given now.
    pub fn table_names(&self) -> Vec<&'static str> {
        self.shown.iter().map(|_| TABLE).collect()
    }

    /// The numbers behind what is shown.
    pub fn tables(&self) -> Vec<Table> {
        let Some((_, data)) = &self.shown else {
            return Vec::new();
        };
        let run = &data.run;
        vec![
            Table::new(TABLE)
                .with("time [s]", run.time.iter().copied())
                .with("torque [N m]", run.input.iter().copied())
                .with("motor [rad]", run.position.iter().copied())
                .with("velocity [rad/s]", run.velocity.iter().copied())
                .with("measured [rad]", run.measured.iter().copied()),
        ]
    }
}
