//! The proposal in words.

use crate::diagnosis::{LEAST, NextExperiment, short, times};
use crate::effect::name_of;
use crate::message::Message;
use crate::msg;

/// Separation below which two models do the same for all that can be computed or measured: it would take some two
/// million samples to see it, and a slow sensor is computed as if its signal were straight between samples.
const THE_SAME: f64 = 5e-3;

/// What to do and what to expect.
pub(super) fn text(proposal: &NextExperiment) -> Message {
    let names = Message::list(" and ", proposal.class.iter().map(|id| name_of(*id)));
    let program = proposal
        .program
        .words(&proposal.input_unit, &proposal.output_unit);
    if proposal.separation < THE_SAME {
        return msg!(
            "{} have the same effect on what is measured here, whatever the input: no relay or other excitation \
             within the limits can tell them apart. Measure another quantity, or something in between.",
            names
        );
    }
    let separation = times(proposal.separation);
    if !proposal.sufficient {
        let best = if proposal.separation < LEAST {
            msg!(
                "The best of those tried is {}: the models would differ by less than {} times the noise.",
                program,
                LEAST
            )
        } else {
            msg!(
                "The best of those tried is {}: the models would differ by only {} times the noise.",
                program,
                separation
            )
        };
        let text = msg!("No experiment within the limits tells {} apart.", names);
        return text
            .and(best)
            .and("A larger input or a longer record would help.");
    }
    let enough = if proposal.needed < proposal.duration {
        msg!(
            "{} s are enough for this; {} s let all other effects be judged as well.",
            short(proposal.needed),
            short(proposal.duration)
        )
    } else {
        msg!("Measure for {} s.", short(proposal.duration))
    };
    let differ = if proposal.today < LEAST {
        msg!(
            "The models would then differ by {} times the noise; in this record they differ by less than {}.",
            separation,
            LEAST
        )
    } else {
        msg!(
            "The models would then differ by {} times the noise; in this record they differ by {}.",
            separation,
            times(proposal.today)
        )
    };
    msg!("To tell {} apart, measure again with {}.", names, program)
        .and(differ)
        .and(enough)
}
