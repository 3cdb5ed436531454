//! The spring of a compliant contact.

use super::state::State;
use super::trajectory::Side;
use super::{Contact, Drive};

/// The spring of a pressed contact, `F = K (x1 - x2) + D (v1 - v2) - offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    pub stiffness: f64,
    pub damping: f64,
    pub offset: f64,
}

impl Spring {
    /// The spring at an end of the gap; `None` where the contact is rigid.
    pub fn at(drive: &Drive, side: Side) -> Option<Self> {
        match drive.contact {
            Contact::Rigid { .. } => None,
            Contact::Compliant { stiffness, damping } => Some(Self {
                stiffness,
                damping,
                offset: stiffness * (side.sign() * drive.half_gap),
            }),
        }
    }

    /// Torque or force on the load.
    pub fn force(&self, s: &State) -> f64 {
        self.stiffness * s.gap + self.damping * (s.v1 - s.v2) - self.offset
    }
}
