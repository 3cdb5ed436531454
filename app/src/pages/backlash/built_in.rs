//! Measurements that come with the page.

use hysteron_work::enclosed::{self, Enclosed};

/// A drifting test that comes with the app.
pub struct BuiltIn {
    pub file: Enclosed,
    pub story: &'static str,
}

pub const BUILT_IN: [BuiltIn; 2] = [
    BuiltIn {
        file: enclosed::DRIVE_03,
        story: "A drifting test on a rig with dry friction. The load was measured as well, for comparison.",
    },
    BuiltIn {
        file: enclosed::DRIVE_10,
        story: "The same on a rig without dry friction and with half the gap.",
    },
];
