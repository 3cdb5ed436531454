//! The answer of a part of the page that is computed while its sliders move.

use hysteron_core::message::Message;
use hysteron_work::tasks::Task;

use crate::jobs::Runs;
use crate::language::tr;
use crate::live::Live;
use crate::theme;

/// Draws it in these words, or why there is none.
pub fn ui<I: Clone + PartialEq, T: Runs>(
    ui: &mut egui::Ui,
    live: &Live<I, T>,
    words: impl Fn(&I, &<T as Task>::Report) -> Message,
) {
    if let Some(message) = live.message() {
        ui.colored_label(ui.visuals().warn_fg_color, tr(message));
        return;
    }
    let Some((input, report)) = live.shown() else {
        theme::answer_ui(ui, "Computing ...");
        return;
    };
    let answer = words(input, report);
    if live.is_of_before() {
        theme::answer_of_before_ui(ui, &answer);
    } else {
        theme::answer_ui(ui, &answer);
    }
}
