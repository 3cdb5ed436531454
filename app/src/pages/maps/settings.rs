//! What is set on the page.

use hysteron_core::explore::ExploreInput;
use hysteron_core::maps::{Axis, Quantity};
use serde::{Deserialize, Serialize};

use super::Maps;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    across: Axis,
    upwards: Axis,
    quantity: Quantity,
    /// Values of the two parameters that are read out.
    point: Option<[f64; 2]>,
    /// The loop around which they vary; a click on the map makes that of *Explore* another one.
    around: ExploreInput,
}

impl Maps {
    pub(super) fn set_to(&self) -> Settings {
        Settings {
            across: self.input.x,
            upwards: self.input.y,
            quantity: self.quantity,
            point: self.point,
            around: self.input.base.clone(),
        }
    }

    /// Takes settings, with the loop of *Explore* that belongs to them.
    pub(super) fn take(
        &mut self,
        settings: Settings,
        explored: &ExploreInput,
    ) -> Result<(), String> {
        let mut input = self.input.clone();
        input.x = settings.across;
        input.y = settings.upwards;
        input.base = settings.around;
        input
            .validate()
            .map_err(|e| format!("This map cannot be: {e}."))?;
        input
            .base
            .validate()
            .map_err(|e| format!("This loop cannot be: {e}."))?;
        self.input = input;
        self.quantity = settings.quantity;
        self.point = settings.point;
        self.seen = Some(explored.clone());
        self.picture.outdated();
        Ok(())
    }
}
