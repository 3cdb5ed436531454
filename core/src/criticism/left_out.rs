//! What of a record was not used, in plain words.

use std::fmt::Write as _;

use super::data::Data;
use super::locate::signal_name;
use crate::diagnosis::Verdict;

/// Says which values and samples of the whole record were left out, and over which gaps no model runs.
pub(super) fn add_left_out(verdict: &mut Verdict, whole: &Data) {
    add_glitches(verdict, whole.glitches);
    add_pauses(verdict, whole.pauses);
    add_held(verdict, whole);
    add_limited(verdict, whole);
}

/// Says how many values were left out.
fn add_glitches(verdict: &mut Verdict, glitches: usize) {
    let _ = match glitches {
        0 => return,
        1 => write!(
            verdict.text,
            " One value stood alone, far off its neighbours, and was left out: a glitch of the sensor."
        ),
        many => write!(
            verdict.text,
            " {many} values stood alone, far off their neighbours, and were left out: glitches of the sensor."
        ),
    };
}

/// Says over how many gaps in the time the model does not run.
fn add_pauses(verdict: &mut Verdict, pauses: usize) {
    let _ = match pauses {
        0 => return,
        1 => write!(
            verdict.text,
            " Rows are missing in one place, or two runs are joined there: the model begins anew after it."
        ),
        many => write!(
            verdict.text,
            " Rows are missing in {many} places, or runs are joined there: the model begins anew after each."
        ),
    };
}

/// Says of which outputs only the fresh readings were used.
fn add_held(verdict: &mut Verdict, data: &Data) {
    for output in data.outputs.iter().filter(|o| o.is_held()) {
        let _ = write!(
            verdict.text,
            " The {} stays as it is between {} readings: only these were used.",
            signal_name(data.kind, output),
            output.telling(0, data.len())
        );
    }
}

/// Says which sensors were at their limit for a while.
fn add_limited(verdict: &mut Verdict, data: &Data) {
    for output in data.outputs.iter().filter(|o| o.limited > 0) {
        let _ = write!(
            verdict.text,
            " The {} stays at its largest values for {} samples: its sensor was at its limit, and they were left out.",
            signal_name(data.kind, output),
            output.limited
        );
    }
}
