//! Measurements that come with the page.

use hysteron_work::enclosed::{self, Enclosed};

/// A measurement that comes with the app.
pub(super) struct BuiltIn {
    pub file: Enclosed,
    pub title: &'static str,
    pub story: &'static str,
}

pub(super) const BUILT_IN: [BuiltIn; 4] = [
    BuiltIn {
        file: enclosed::DRIVE_02,
        title: "A drive that loses momentum",
        story: "A motor under a velocity relay. It never moves quite as far as its inertia says it should.",
    },
    BuiltIn {
        file: enclosed::DRIVE_12,
        title: "A drive that responds late",
        story: "The same rig with another amplifier and older bearings. One effect is not enough.",
    },
    BuiltIn {
        file: enclosed::DRIVE_15,
        title: "A drive with something in its way",
        story: "Nothing in the library explains it. Let the data say what the force looks like.",
    },
    BuiltIn {
        file: enclosed::PROCESS_02,
        title: "A slow heating process",
        story: "A heater switched by a relay. The temperature overshoots both limits, every time.",
    },
];
