//! Measurements that come with the app.

/// A drifting test that comes with the app.
pub struct BuiltIn {
    pub id: &'static str,
    pub story: &'static str,
    deflated: &'static [u8],
}

pub const BUILT_IN: [BuiltIn; 2] = [
    BuiltIn {
        id: "drive-03",
        story: "A drifting test on a rig with dry friction. The load was measured as well, for comparison.",
        deflated: include_bytes!(concat!(env!("OUT_DIR"), "/drive-03.deflate")),
    },
    BuiltIn {
        id: "drive-10",
        story: "The same on a rig without dry friction and with half of the gap.",
        deflated: include_bytes!(concat!(env!("OUT_DIR"), "/drive-10.deflate")),
    },
];

impl BuiltIn {
    /// Its text.
    pub fn csv(&self) -> Vec<u8> {
        miniz_oxide::inflate::decompress_to_vec(self.deflated).unwrap_or_default()
    }
}
