//! Records of a drive by hand.

use hysteron_core::measurement::{Channel, Kind, Measurement, Quantity};

/// A channel with this unit.
pub fn channel(quantity: Quantity, name: &str, unit: &str, values: Vec<f64>) -> Channel {
    Channel {
        quantity,
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    }
}

/// Torque, position and velocity of a motor.
pub fn of_motor(
    name: String,
    time: Vec<f64>,
    [torque, position, velocity]: [Vec<f64>; 3],
) -> Measurement {
    Measurement {
        name,
        kind: Kind::Drive,
        time,
        input: channel(Quantity::Input, "u", "N m", torque),
        outputs: vec![
            channel(Quantity::Position, "x1", "rad", position),
            channel(Quantity::Velocity, "v1", "rad/s", velocity),
        ],
        reference: vec![],
        warnings: vec![],
    }
}
