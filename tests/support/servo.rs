//! A position loop.

use hysteron_core::rig::{DriveRig, Excitation};

/// A position loop of this bandwidth (rad/s) that makes a move in each `period` s.
pub fn servo(reach: f64, period: f64, bandwidth: f64) -> Excitation {
    let inertia = DriveRig::default().inertia;
    Excitation::Servo {
        reach,
        period,
        stiffness: inertia * bandwidth * bandwidth,
        damping: 1.4 * inertia * bandwidth,
    }
}
