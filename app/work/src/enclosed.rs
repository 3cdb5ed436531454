//! Measurements that come with the app, packed by `build.rs`.

use hysteron_core::measurement::Kind;

use crate::content::Content;
#[cfg(not(target_arch = "wasm32"))]
use crate::packed::unpack;
use crate::packed::unpack_rows;

/// A measurement.
pub struct Enclosed {
    /// Its name.
    pub id: &'static str,
    /// What was measured.
    pub kind: Kind,
    packed: &'static [u8],
}

macro_rules! enclosed {
    ($kind:ident, $id:literal) => {
        Enclosed {
            id: $id,
            kind: Kind::$kind,
            packed: include_bytes!(concat!(env!("OUT_DIR"), "/", $id, ".packed")),
        }
    };
}

pub const DRIVE_02: Enclosed = enclosed!(Drive, "drive-02");
pub const DRIVE_03: Enclosed = enclosed!(Drive, "drive-03");
pub const DRIVE_10: Enclosed = enclosed!(Drive, "drive-10");
pub const DRIVE_12: Enclosed = enclosed!(Drive, "drive-12");
pub const DRIVE_15: Enclosed = enclosed!(Drive, "drive-15");
pub const PROCESS_02: Enclosed = enclosed!(Process, "process-02");

/// All of them.
const ALL: [Enclosed; 6] = [DRIVE_02, DRIVE_03, DRIVE_10, DRIVE_12, DRIVE_15, PROCESS_02];

/// Whether a measurement of this name comes with the app.
pub fn is_enclosed(name: &str) -> bool {
    ALL.iter().any(|enclosed| enclosed.id == name)
}

impl Enclosed {
    /// Its text.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn csv(&self) -> Vec<u8> {
        unpack(self.packed).unwrap_or_default()
    }

    /// How its text begins: the head, and at most so many rows.
    pub fn beginning(&self, most_rows: usize) -> Vec<u8> {
        unpack_rows(self.packed, most_rows).unwrap_or_default()
    }

    /// The same, for where it is read.
    pub fn content(&self) -> Content {
        Content::Packed(self.packed.to_vec().into())
    }
}

#[cfg(test)]
mod tests {
    use hysteron_core::measurement::{ImportOptions, import};

    use super::*;

    #[test]
    fn what_is_packed_is_the_very_file() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/measurements");
        for enclosed in ALL {
            let file = std::fs::read(format!("{folder}/{}.csv", enclosed.id)).expect("the file");
            assert!(enclosed.csv() == file, "{}", enclosed.id);
            let five = file.split_inclusive(|b| *b == b'\n').take(6);
            assert_eq!(enclosed.beginning(5), five.collect::<Vec<_>>().concat());
            let options = ImportOptions::default();
            let read = import(enclosed.id, &file, &options).expect("a measurement");
            assert_eq!(read.kind, enclosed.kind, "{}", enclosed.id);
        }
    }
}
