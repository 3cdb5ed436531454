//! What of a record was not used, in plain words.

use super::data::Data;
use super::locate::signal_name;
use crate::diagnosis::Verdict;
use crate::msg;

/// Says which values and samples of the whole record were left out, and over which gaps no model runs.
pub(super) fn add_left_out(verdict: &mut Verdict, whole: &Data) {
    add_glitches(verdict, whole.glitches);
    add_pauses(verdict, whole.pauses);
    add_held(verdict, whole);
    add_limited(verdict, whole);
}

/// Says how many values were left out.
fn add_glitches(verdict: &mut Verdict, glitches: usize) {
    let said = match glitches {
        0 => return,
        1 => "One outlier, far from its neighbours, was left out as a sensor glitch.".into(),
        many => msg!(
            "{} outliers, far from their neighbours, were left out as sensor glitches.",
            many
        ),
    };
    verdict.text.add(said);
}

/// Says over how many gaps in the time the model does not run.
fn add_pauses(verdict: &mut Verdict, pauses: usize) {
    let said = match pauses {
        0 => return,
        1 => "Rows are missing in one place, or two runs are joined there: the model starts afresh after it.".into(),
        many => msg!(
            "Rows are missing in {} places, or runs are joined there: the model starts afresh after each.", many),
    };
    verdict.text.add(said);
}

/// Says of which outputs only the fresh readings were used.
fn add_held(verdict: &mut Verdict, data: &Data) {
    for output in data.outputs.iter().filter(|o| o.is_held()) {
        verdict.text.add(msg!(
            "The {} holds its value between {} readings: only these were used.",
            signal_name(data.kind, output),
            output.telling(0, data.len())
        ));
    }
}

/// Says which sensors were at their limit for a while.
fn add_limited(verdict: &mut Verdict, data: &Data) {
    for output in data.outputs.iter().filter(|o| o.limited > 0) {
        verdict.text.add(msg!(
            "The {} stays at its largest values for {} samples: its sensor was at its limit, and they were left out.",
            signal_name(data.kind, output),
            output.limited
        ));
    }
}
