//! A relay as it is built: a dead zone, minimum times, sampling, one direction; around a plant in continuous or
//! discrete time.

mod controls;
mod plots;
mod settings;
mod words;

use hysteron_core::explore::ExploreInput;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::on_off::{OnOffCycle, OnOffInput};
use hysteron_work::tasks::OnOffTask;
use serde_json::{Value, json};

use super::controller::Controller;
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

/// Names of [`OnOff::tables`].
const TABLES: [&str; 2] = ["time series", "relay input"];

/// What is set, and what follows from it.
#[derive(Default)]
pub struct OnOff {
    pub set: Settings,
    pub controls: Controls,
    live: Live<OnOffInput, OnOffTask>,
}

impl OnOff {
    /// Sets what comes from elsewhere than the controls, of which none is unfolded then.
    pub fn put(&mut self, set: Settings) {
        self.controls = Controls::default();
        self.set = set;
    }

    /// Takes what the job has brought.
    pub fn update(&mut self) {
        self.live.update();
    }

    /// Computes anew where something was changed and nothing is computed.
    pub fn ask(&mut self, ctx: &egui::Context, controller: Controller, shared: &ExploreInput) {
        let input = self.set.input(controller, shared);
        self.live.ask(ctx, &input, OnOffTask);
    }

    pub fn answer_ui(&self, ui: &mut egui::Ui) {
        live_answer::ui(ui, &self.live, words::answer);
    }

    pub fn reasons_ui(&self, ui: &mut egui::Ui) {
        let Some((input, data)) = self.live.shown() else {
            return;
        };
        for sentence in words::reasons(input, data) {
            ui.label(tr(sentence));
        }
        if let Some(text) = data.exact.as_ref().and_then(lasting) {
            ui.label(tr(text));
        }
    }

    pub fn plots_ui(&self, ui: &mut egui::Ui, height: f32) {
        let Some((input, data)) = self.live.shown() else {
            return;
        };
        let curves = !data.nyquist.is_empty();
        if curves && layout::room_for_two(ui) {
            ui.columns(2, |columns| {
                plots::time_ui(&mut columns[0], input, data, height);
                plots::curves_ui(&mut columns[1], data, height);
            });
            return;
        }
        self.time_ui(ui, height);
        self.curves_ui(ui, height);
    }

    /// Output and input over time.
    pub fn time_ui(&self, ui: &mut egui::Ui, height: f32) {
        if let Some((input, data)) = self.live.shown() {
            plots::time_ui(ui, input, data, height);
        }
    }

    /// The Nyquist plot, where there is one.
    pub fn curves_ui(&self, ui: &mut egui::Ui, height: f32) {
        let shown = self.live.shown().filter(|(_, d)| !d.nyquist.is_empty());
        if let Some((_, data)) = shown {
            plots::curves_ui(ui, data, height);
        }
    }

    pub fn numbers_ui(&self, ui: &mut egui::Ui) {
        let Some((_, data)) = self.live.shown() else {
            return;
        };
        let row = |c: &OnOffCycle| ([c.period, c.amplitude], c.stable);
        let rows = [
            words::balance(data).map(|b| ([b.period, b.amplitude], b.stable)),
            data.exact.as_ref().map(row),
            data.simulated.as_ref().map(row),
        ];
        ui.separator();
        cycle_table::ui(ui, ["period [s]", "amplitude"], APART, &rows);
    }

    pub fn state(&self) -> Value {
        let data = self.live.shown();
        let cycle = |c: &OnOffCycle| json!({"period": c.period, "amplitude": c.amplitude});
        json!({
            "busy": self.live.is_busy(),
            "message": self.live.message(),
            "answer": data.map(|(input, data)| words::answer(input, data)),
            "rests": data.map(|(_, d)| d.rests.is_some()),
            "exact": data.and_then(|(_, d)| d.exact.as_ref().map(cycle)),
            "simulated": data.and_then(|(_, d)| d.simulated.as_ref().map(cycle)),
            "describing_function": data.and_then(|(_, d)| {
                words::balance(d).map(|b| json!({"period": b.period, "amplitude": b.amplitude}))
            }),
        })
    }

    /// What to try next.
    pub fn hint(&self, controller: Controller) -> Option<Hint> {
        let (_, data) = self.live.shown()?;
        let mut next = self.set.clone();
        let sentence = if next.min_on.max(next.min_off) > 0.0 {
            (next.min_on, next.min_off) = (0.0, 0.0);
            "Take the minimum times away: how fast does it switch then?"
        } else if controller == Controller::ThreePositions && data.rests.is_some() {
            next.dead_zone *= 0.125;
            "Narrow the dead zone: does it oscillate then?"
        } else if controller == Controller::ThreePositions {
            next.dead_zone *= 2.0;
            "Widen the dead zone: where does the oscillation end?"
        } else if next.sampling > 0.0 {
            next.sampling *= 0.25;
            "Sample more often: how much of the oscillation came from the sampling?"
        } else {
            let period = words::cycle(data)?.period;
            (next.min_on, next.min_off) = (period, period);
            "Give it minimum times, as a compressor needs them: how far does the output swing then?"
        };
        Some(Hint {
            sentence: sentence.into(),
            commands: vec![Command::Set("explore", "on_off", json!(next))],
        })
    }

    /// Names of the tables that can be given now.
    pub fn table_names(&self) -> Vec<&'static str> {
        self.live.shown().into_iter().flat_map(|_| TABLES).collect()
    }

    /// The numbers behind what is shown.
    pub fn tables(&self) -> Vec<Table> {
        let Some((_, data)) = self.live.shown() else {
            return Vec::new();
        };
        vec![
            Table::new(TABLES[0])
                .with("time [s]", data.time.iter().copied())
                .with("output y", data.output.iter().copied()),
            Table::curve(TABLES[1], ["time [s]", "input u"], &data.input),
        ]
    }
}

/// Whether the cycle lasts.
fn lasting(cycle: &OnOffCycle) -> Option<Message> {
    let Some(stable) = cycle.stable else {
        return cycle
            .multiplier
            .map(|_| "A different start leads to a different cycle.".into());
    };
    let rate = cycle.multiplier?;
    let percent = hysteron_core::explore::percent(rate);
    Some(if stable {
        msg!(
            "Stable: a small disturbance shrinks to {} in one period.",
            percent
        )
    } else {
        msg!(
            "Unstable: a small disturbance grows to {} in one period.",
            percent
        )
    })
}
