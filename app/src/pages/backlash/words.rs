//! What the page says.

use hysteron_core::backlash::Quality;
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;

use super::scene::Scene;
use super::units::MILLI;

impl Scene {
    /// The page's answer.
    pub fn answer(&self) -> Message {
        let known = self.input().map(|i| 2.0 * MILLI * i.drive.half_gap);
        let found = match &self.estimate {
            None => "Estimating the gap from the motor alone ...".into(),
            Some(Err(error)) => msg!("The motor cannot tell: {}.", error),
            Some(Ok(e)) => match (e.gap, e.std_error) {
                (Some(gap), Some(error)) => {
                    let value = digits(MILLI * gap, MILLI * error);
                    let error = digits(MILLI * error, MILLI * error);
                    let truth = known.map(|known| fixed(known, 2));
                    return match (e.quality == Quality::AssumedCentre, truth) {
                        (true, Some(truth)) => msg!(
                            "From the motor alone, if it started in the middle: 2β = {} ± {} mrad (true: {}).",
                            value,
                            error,
                            truth
                        ),
                        (true, None) => msg!(
                            "From the motor alone, if it started in the middle: 2β = {} ± {} mrad.",
                            value,
                            error
                        ),
                        (false, Some(truth)) => msg!(
                            "From the motor alone: 2β = {} ± {} mrad (true: {}).",
                            value,
                            error,
                            truth
                        ),
                        (false, None) => {
                            msg!("From the motor alone: 2β = {} ± {} mrad.", value, error)
                        }
                    };
                }
                _ => "The gap cannot be found from the motor alone.".into(),
            },
        };
        match known {
            Some(known) => found.and(msg!("True: {} mrad.", fixed(known, 2))),
            None => found,
        }
    }

    /// Why the motor alone does not tell the gap of a simulated drive.
    pub fn refusal(&self) -> Option<Message> {
        let estimate = self.estimate.as_ref()?.as_ref().ok()?;
        self.input()?;
        estimate
            .gap
            .is_none()
            .then(|| msg!("Why: {}.", &estimate.text))
    }

    /// The estimate's own verdict.
    pub fn verdict(&self) -> Option<&Message> {
        Some(&self.estimate.as_ref()?.as_ref().ok()?.text)
    }
}

/// As many digits as its error leaves, two of that.
fn digits(value: f64, error: f64) -> String {
    let decimals = if error > 0.0 {
        (1.0 - error.log10().floor()).clamp(0.0, 4.0) as usize
    } else {
        4
    };
    format!("{value:.decimals$}")
}
