//! Does it hunt? A drive with dry friction, cogging or play under a P, PI or PID controller of its position.

mod controls;
mod plots;
mod settings;
mod words;

use hysteron_core::hunting::{HuntingCycle, Servo};
use hysteron_work::tasks::ServoTask;
use serde_json::{Value, json};

use super::cycle_table::{self, APART};
use super::live_answer;
use crate::command::Command;
use crate::export::Table;
use crate::language::tr;
use crate::layout;
use crate::live::Live;
use crate::page::Hint;
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
    live: Live<Servo, ServoTask>,
}

impl Hunting {
    /// Sets what comes from elsewhere than the sliders: they reach as far as it needs them.
    pub fn put(&mut self, set: Settings) {
        self.controls.fit(&set);
        self.set = set;
    }

    /// Takes what the job has brought.
    pub fn update(&mut self) {
        self.live.update();
    }

    /// Computes anew where something was changed and nothing is computed.
    pub fn ask(&mut self, ctx: &egui::Context) {
        self.live.ask(ctx, &self.set.servo(), ServoTask);
    }

    pub fn controls_ui(&mut self, ui: &mut egui::Ui) {
        self.controls.ui(ui, &mut self.set);
    }

    pub fn answer_ui(&self, ui: &mut egui::Ui) {
        ui.label(tr("Does it hunt?"));
        live_answer::ui(ui, &self.live, words::answer);
    }

    pub fn reasons_ui(&self, ui: &mut egui::Ui) {
        if let Some((servo, data)) = self.live.shown() {
            for sentence in words::reasons(servo, data) {
                ui.label(tr(sentence));
            }
        }
    }

    pub fn plots_ui(&self, ui: &mut egui::Ui, height: f32) {
        let half = 0.5 * height;
        self.position_ui(ui, half);
        self.others_ui(ui, half);
    }

    /// The position over time.
    pub fn position_ui(&self, ui: &mut egui::Ui, height: f32) {
        if let Some((servo, data)) = self.live.shown() {
            plots::position_ui(ui, servo, data, height);
        }
    }

    /// The torque and the phase portrait.
    pub fn others_ui(&self, ui: &mut egui::Ui, height: f32) {
        let Some((servo, data)) = self.live.shown() else {
            return;
        };
        if layout::room_for_two(ui) {
            ui.columns(2, |columns| {
                plots::torque_ui(&mut columns[0], servo, data, height);
                plots::phase_ui(&mut columns[1], data, height);
            });
        } else {
            plots::torque_ui(ui, servo, data, height);
            plots::phase_ui(ui, data, height);
        }
    }

    pub fn numbers_ui(&self, ui: &mut egui::Ui) {
        let Some((_, data)) = self.live.shown() else {
            return;
        };
        let row = |period: f64, amplitude: f64| [1.0 / period, amplitude.to_degrees()];
        let cycle = |c: &HuntingCycle| (row(c.period, c.amplitude), c.stable);
        let rows = [
            words::balance(data).map(|b| (row(b.period, b.amplitude), b.stable)),
            data.exact.as_ref().map(cycle),
            data.simulated.as_ref().map(cycle),
        ];
        ui.separator();
        cycle_table::ui(ui, ["frequency [Hz]", "amplitude [°]"], APART, &rows);
        ui.small(tr(
            "Amplitude: half of peak to peak of the measured position.",
        ));
    }

    pub fn state(&self) -> Value {
        let data = self.live.shown();
        let cycle = |c: &HuntingCycle| json!({"period": c.period, "frequency": 1.0 / c.period, "amplitude": c.amplitude, "stuck": c.stuck});
        json!({
            "busy": self.live.is_busy(),
            "message": self.live.message(),
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
        let (servo, data) = self.live.shown()?;
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
                "Give it an integral: does it reach its set point?"
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
            sentence: sentence.into(),
            commands: vec![Command::Set("explore", "servo", json!(next))],
        })
    }

    /// Names of the tables that can be given now.
    pub fn table_names(&self) -> Vec<&'static str> {
        self.live.shown().into_iter().map(|_| TABLE).collect()
    }

    /// The numbers behind what is shown.
    pub fn tables(&self) -> Vec<Table> {
        let Some((_, data)) = self.live.shown() else {
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
