//! Parameters that are set by hand: what is in view answers within the frame, the whole record when the slider is let
//! go.

use hysteron_core::by_hand::ByHand;
use hysteron_work::tasks::HandTask;

use super::by_hand::Hand;
use super::state::Compare;
use crate::jobs::{Job, ended};

/// Samples that are replayed within a frame, at most.
const MOST: usize = 12_000;

/// Where the plots over time note which samples are in view.
fn seen_key() -> egui::Id {
    egui::Id::unique("compare_seen")
}

/// Notes which samples are in view.
pub(super) fn note_seen(ctx: &egui::Context, samples: (usize, usize)) {
    ctx.data_mut(|data| data.insert_temp(seen_key(), samples));
}

impl Compare {
    /// The values that are set by hand, if they are those of the step on screen.
    pub(super) fn hand(&self) -> Option<&Hand> {
        let hand = self.hand.as_ref()?;
        (self.shown.as_ref() == Some(&hand.effects)).then_some(hand)
    }

    /// The error with the values that are set by hand, in noise units, and whether it is that of the whole record.
    pub(super) fn hand_error(&self) -> Option<(f64, bool)> {
        let hand = self.hand()?;
        Some((hand.replay.as_ref()?.error, hand.exact))
    }

    /// Sets values by hand; `held` while the slider is.
    pub(super) fn set_by_hand(&mut self, ctx: &egui::Context, values: Vec<f64>, held: bool) {
        let before = self.hand.take();
        let (Some(measurement), Some(report)) = (&self.measurement, self.report()) else {
            return;
        };
        let Some(shown) = self.shown.clone() else {
            return;
        };
        let view = ctx.data(|data| data.get_temp(seen_key()));
        let view = view.unwrap_or((0, measurement.len()));
        let before = before.filter(|hand| hand.effects == shown);
        let mut near = before.and_then(|hand| hand.near);
        let wanted = ByHand::windows_about(report, view, MOST);
        if near.as_ref().is_none_or(|(_, samples)| *samples != wanted) {
            near = ByHand::new(measurement, report, wanted).map(|hand| (hand, wanted));
        }
        let replay = near.as_ref().map(|(hand, _)| hand.replay(&values));
        let job = (!held).then(|| {
            let task = HandTask {
                measurement: Box::new((**measurement).clone()),
                report: Box::new(report.clone()),
                values: values.clone(),
            };
            Job::run(ctx, task)
        });
        self.hand = Some(Hand {
            effects: shown,
            values,
            held,
            near,
            replay,
            samples: wanted,
            exact: false,
            job,
        });
        ctx.request_repaint();
    }

    /// Takes what the replay of the whole record has come to.
    pub(super) fn take_by_hand(&mut self) {
        let Some(hand) = &mut self.hand else {
            return;
        };
        match ended(&mut hand.job, |_, _| ()) {
            Some(Ok(replay)) => {
                hand.samples = (0, replay.modelled.first().map_or(0, Vec::len));
                hand.replay = Some(replay);
                hand.exact = true;
            }
            Some(Err(text)) => {
                self.hand = None;
                self.message = Some(text);
            }
            None => {}
        }
    }
}
