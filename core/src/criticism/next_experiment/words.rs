//! The proposal in words.

use crate::diagnosis::{NextExperiment, short, times};
use crate::effect::name_of;

/// Separation below which two models do the same for all that can be computed or measured: it would take some two
/// million samples to see it, and a slow sensor is computed as if its signal were straight between samples.
const THE_SAME: f64 = 5e-3;

/// What to do and what to expect.
pub(super) fn text(proposal: &NextExperiment) -> String {
    let names: Vec<&str> = proposal.class.iter().map(|id| name_of(*id)).collect();
    let names = names.join(" and ");
    let program = proposal
        .program
        .words(&proposal.input_unit, &proposal.output_unit);
    if proposal.separation < THE_SAME {
        return format!(
            "{names} do the same to what is measured here, whatever the input: no relay and no other excitation within \
             the limits tells them apart. Measure another quantity, or what is between."
        );
    }
    if !proposal.sufficient {
        return format!(
            "No experiment within the limits tells {names} apart. The best of those tried is {program}: the models \
             would differ by only {} times the noise. A larger input or a longer record would help.",
            times(proposal.separation)
        );
    }
    let enough = if proposal.needed < proposal.duration {
        format!(
            " {} s are enough for this; {} s let all other effects be judged as well.",
            short(proposal.needed),
            short(proposal.duration)
        )
    } else {
        format!(" Measure for {} s.", short(proposal.duration))
    };
    format!(
        "To tell {names} apart, measure again with {program}. The models would then differ by {} times the noise; in \
         this record they differ by {}.{enough}",
        times(proposal.separation),
        times(proposal.today),
    )
}
