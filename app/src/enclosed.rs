//! Measurements that come with the app, packed by `build.rs`.

/// A measurement.
pub struct Enclosed {
    /// Its name.
    pub id: &'static str,
    packed: &'static [u8],
}

macro_rules! enclosed {
    ($id:literal) => {
        Enclosed {
            id: $id,
            packed: include_bytes!(concat!(env!("OUT_DIR"), "/", $id, ".packed")),
        }
    };
}

pub const DRIVE_02: Enclosed = enclosed!("drive-02");
pub const DRIVE_03: Enclosed = enclosed!("drive-03");
pub const DRIVE_10: Enclosed = enclosed!("drive-10");
pub const DRIVE_12: Enclosed = enclosed!("drive-12");
pub const PROCESS_02: Enclosed = enclosed!("process-02");

impl Enclosed {
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
        for enclosed in [DRIVE_02, DRIVE_03, DRIVE_10, DRIVE_12, PROCESS_02] {
            let file = std::fs::read(format!("{folder}/{}.csv", enclosed.id)).expect("the file");
            assert!(enclosed.csv() == file, "{}", enclosed.id);
        }
    }
}
