//! What a relay has as it is built, beside what every relay has.

use hysteron_core::explore::ExploreInput;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::on_off::{GivenPlant, OnOffInput, OnOffRelay};
use hysteron_core::relay::Relay;
use serde::{Deserialize, Serialize};

use crate::pages::explore::controller::Controller;

/// A plant in discrete time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Discrete {
    /// Polynomials in `z`, highest power first.
    pub numerator: Vec<f64>,
    pub denominator: Vec<f64>,
    /// Sampling time, s; 0: the plant is in continuous time.
    pub sampling: f64,
}

impl Default for Discrete {
    fn default() -> Self {
        Self {
            numerator: vec![0.1, 0.0],
            denominator: vec![1.0, -1.5, 0.7],
            sampling: 0.0,
        }
    }
}

/// What is set, in the units of the loop and in s; 0 where there is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// What the output should be.
    pub reference: f64,
    /// Half the zone in which it is off, where there are three positions.
    pub dead_zone: f64,
    /// Shortest times on and off.
    pub min_on: f64,
    pub min_off: f64,
    /// Sampling time.
    pub sampling: f64,
    /// Output at the start.
    pub start: f64,
    pub z: Discrete,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            reference: 0.0,
            dead_zone: 0.1,
            min_on: 0.0,
            min_off: 0.0,
            sampling: 0.0,
            start: 1.0,
            z: Discrete::default(),
        }
    }
}

impl Settings {
    /// Whether the relay has more than the one of the textbook.
    pub fn is_more(&self, controller: Controller) -> bool {
        let values = [self.min_on, self.min_off, self.sampling, self.z.sampling];
        controller != Controller::TwoLevels
            || self.reference != 0.0
            || values.iter().any(|v| *v > 0.0)
    }

    /// The loop with this relay.
    pub fn input(&self, controller: Controller, shared: &ExploreInput) -> OnOffInput {
        let z = &self.z;
        let plant = if z.sampling > 0.0 {
            GivenPlant::Discrete(z.numerator.clone(), z.denominator.clone(), z.sampling)
        } else {
            GivenPlant::Continuous(shared.plant.clone())
        };
        let relay = if controller == Controller::OneSided {
            // Off is 0, and on is twice the gain.
            Relay {
                asymmetry: 0.0,
                bias: shared.relay.gain,
                ..shared.relay
            }
        } else {
            shared.relay
        };
        let three = controller == Controller::ThreePositions;
        OnOffInput {
            plant,
            relay: OnOffRelay {
                relay,
                reference: self.reference,
                dead_zone: if three { self.dead_zone } else { 0.0 },
                min_on: self.min_on,
                min_off: self.min_off,
                // A plant in discrete time has its own samples.
                sampling: (self.sampling > 0.0 && z.sampling == 0.0).then_some(self.sampling),
            },
            start: if three { self.start } else { 0.0 },
        }
    }

    /// What shows a loop, with the kind of its controller and what pages share of it.
    pub fn of(input: &OnOffInput, shared: &ExploreInput) -> (Controller, Self, ExploreInput) {
        let relay = input.relay.relay;
        let [down, up] = [true, false].map(|high| relay.output(high));
        let one_sided = down == 0.0 && up > 0.0 && input.relay.dead_zone == 0.0;
        let controller = if one_sided {
            Controller::OneSided
        } else if input.relay.has_three_positions() {
            Controller::ThreePositions
        } else {
            Controller::TwoLevels
        };
        let usual = Self::default();
        let mut shared = ExploreInput {
            relay: if one_sided {
                Relay {
                    gain: 0.5 * up,
                    asymmetry: 0.0,
                    bias: 0.0,
                    ..relay
                }
            } else {
                relay
            },
            noise: None,
            ..shared.clone()
        };
        let z = match &input.plant {
            GivenPlant::Continuous(plant) => {
                shared.plant = plant.clone();
                Discrete::default()
            }
            GivenPlant::Discrete(numerator, denominator, sampling) => Discrete {
                numerator: numerator.clone(),
                denominator: denominator.clone(),
                sampling: *sampling,
            },
        };
        let set = Self {
            reference: input.relay.reference,
            dead_zone: if input.relay.has_three_positions() {
                input.relay.dead_zone
            } else {
                usual.dead_zone
            },
            min_on: input.relay.min_on,
            min_off: input.relay.min_off,
            sampling: input.relay.sampling.unwrap_or(0.0),
            start: input.start,
            z,
        };
        (controller, set, shared)
    }

    /// Checks what the relay itself does not.
    ///
    /// # Errors
    /// One sentence.
    pub fn check(&self, controller: Controller, shared: &ExploreInput) -> Result<(), Message> {
        let values = [self.sampling, self.z.sampling];
        let coefficients = self.z.numerator.iter().chain(&self.z.denominator);
        let times = values.iter().all(|v| v.is_finite() && *v >= 0.0);
        if !times || !self.start.is_finite() || coefficients.into_iter().any(|c| !c.is_finite()) {
            return Err("This loop is not possible: a sampling time, a start or a coefficient is out of range.".into());
        }
        let input = self.input(controller, shared);
        (input.relay.validate()).map_err(|e| msg!("This loop is not possible: {}.", e))
    }
}
