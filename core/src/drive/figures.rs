//! Figs. 7, 10, 11 and 12 of the paper: a drive for each.

use super::{Adhesion, Body, Command, Contact, Drive, DriveInput, VelocityRelay};
use crate::relay::Relay;

/// A figure of the paper as a run of a drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveFigure {
    /// Its number in the paper.
    pub number: u32,
    /// What it shows, in a few words.
    pub title: &'static str,
    /// What it claims.
    pub claim: &'static str,
    /// The run.
    pub input: DriveInput,
}

/// Distance of the samples, s.
const STEP: f64 = 2.5e-4;

/// The reference rig: motor and load of 8.8e-4 kg m^2 and a gap of 0.019 rad.
pub fn reference_drive() -> Drive {
    Drive {
        motor: Body {
            inertia: 8.8e-4,
            viscous: 2e-3,
            coulomb: 0.03,
        },
        load: Body {
            inertia: 8.8e-4,
            viscous: 2e-3,
            coulomb: 0.01,
        },
        half_gap: 0.0095,
        contact: Contact::Rigid { restitution: 1.0 },
        adhesion: Adhesion::default(),
    }
}

/// A drifting relay on the reference rig.
pub fn drifting_test() -> DriveInput {
    let relay = VelocityRelay {
        relay: Relay {
            gain: 0.5,
            hysteresis: 0.5,
            asymmetry: 0.3,
            ..Relay::default()
        },
        flip: Some(2.5),
        sampling: None,
    };
    DriveInput::new(reference_drive(), Command::Relay(relay), 10.0, Some(STEP))
}

/// Figs. 7, 10, 11 and 12.
pub fn figures() -> Vec<DriveFigure> {
    let with = |asymmetry: f64, hysteresis: f64, flip: Option<f64>, duration: f64| {
        let mut input = drifting_test();
        input.command = Command::Relay(VelocityRelay {
            relay: Relay {
                gain: 0.5,
                hysteresis,
                asymmetry,
                ..Relay::default()
            },
            flip,
            sampling: None,
        });
        input.duration = duration;
        input
    };
    let mut map = with(0.0, 6.0, None, 1.0);
    map.drive.contact = Contact::Rigid { restitution: 0.0 };
    map.drive.load.coulomb = 0.1;
    vec![
        DriveFigure {
            number: 7,
            title: "backlash map",
            claim: "Load over motor position is a loop of two parallel branches, 2β apart.",
            input: map,
        },
        DriveFigure {
            number: 10,
            title: "limit cycle in the gap",
            claim: "A symmetric relay swings the motor inside the gap without touching the load.",
            input: with(0.0, 0.5, None, 1.0),
        },
        DriveFigure {
            number: 11,
            title: "drifting cycle",
            claim: "An asymmetric relay makes the same cycle drift through the gap.",
            input: with(0.3, 0.5, None, 0.6),
        },
        DriveFigure {
            number: 12,
            title: "drifted position",
            claim: "Where the motor meets the load, its drift changes: between two such changes lies the gap.",
            input: with(0.3, 0.5, Some(2.5), 10.0),
        },
    ]
}
