//! What is set on the page.

use hysteron_core::explore::ExploreInput;
use hysteron_core::maps::{Axis, Quantity};
use hysteron_core::message::Message;
use hysteron_core::msg;
use serde::{Deserialize, Serialize};

use super::Maps;
use crate::desk::Desk;
use crate::page::Settable;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    across: Axis,
    upwards: Axis,
    quantity: Quantity,
    /// Values of the two parameters that are read out.
    point: Option<[f64; 2]>,
    /// The loop around which they vary; a click on the map makes that of *Explore* another one.
    around: ExploreInput,
}

impl Settable for Maps {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        Settings {
            across: self.input.x,
            upwards: self.input.y,
            quantity: self.quantity,
            point: self.point,
            around: self.input.base.clone(),
        }
    }

    fn take(
        &mut self,
        _ctx: &egui::Context,
        settings: Settings,
        desk: &Desk,
    ) -> Result<(), Message> {
        let mut input = self.input.clone();
        input.x = settings.across;
        input.y = settings.upwards;
        input.base = settings.around;
        input
            .validate()
            .map_err(|e| msg!("This map is not possible: {}.", e))?;
        input
            .base
            .validate()
            .map_err(|e| msg!("This loop is not possible: {}.", e))?;
        self.input = input;
        self.quantity = settings.quantity;
        self.point = settings.point;
        // The loop of *Explore* belongs to them.
        self.seen = Some(desk.relay_loop.clone());
        self.picture.outdated();
        Ok(())
    }
}
