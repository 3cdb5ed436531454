//! Measurements that come with the app.

/// A drifting test that comes with the app.
pub struct BuiltIn {
    pub id: &'static str,
    pub story: &'static str,
    packed: &'static [u8],
}

pub const BUILT_IN: [BuiltIn; 2] = [
    BuiltIn {
        id: "drive-03",
        story: "A drifting test on a rig with dry friction. The load was measured as well, for comparison.",
        packed: include_bytes!(concat!(env!("OUT_DIR"), "/drive-03.packed")),
    },
    BuiltIn {
        id: "drive-10",
        story: "The same on a rig without dry friction and with half of the gap.",
        packed: include_bytes!(concat!(env!("OUT_DIR"), "/drive-10.packed")),
    },
];

impl BuiltIn {
    /// Its text.
    pub fn csv(&self) -> Vec<u8> {
        crate::packed::unpack(self.packed).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_the_very_file() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/measurements");
        for built_in in &BUILT_IN {
            let file = std::fs::read(format!("{folder}/{}.csv", built_in.id)).expect("the file");
            assert!(built_in.csv() == file, "{}", built_in.id);
        }
    }
}
