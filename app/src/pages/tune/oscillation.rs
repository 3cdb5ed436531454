//! Step 1: the relay takes the controller's place.

use super::draw::{number, run_ui};
use super::stage::{Seen, Stage};
use crate::language::tr;
use hysteron_core::message::Message;
use hysteron_core::msg;

pub const STAGE: Stage = Stage {
    id: "oscillation",
    title: "Relay",
    question: "What does the loop do with a relay instead of the controller?",
    answer,
    next: "The swing reveals at which gain the loop would oscillate on its own: step 2.",
    plot,
    ui,
};

fn answer(seen: Seen<'_>) -> Message {
    let test = &seen.report.test;
    msg!(
        "It oscillates: period {} s, amplitude {}.",
        number(test.period),
        number(test.amplitude)
    )
}

fn ui(ui: &mut egui::Ui, seen: Seen<'_>, height: f32, _rule: &mut String) {
    ui.label(tr(
        "From rest to the settled cycle. No model is needed: these two numbers are the whole measurement. Amplitude: \
         half of peak to peak."));
    if !seen.pinned {
        plot(ui, seen, height);
    }
}

fn plot(ui: &mut egui::Ui, seen: Seen<'_>, height: f32) {
    run_ui(ui, "relay run", &seen.report.test, height);
}
