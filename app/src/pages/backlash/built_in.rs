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
        let packed = miniz_oxide::inflate::decompress_to_vec(self.deflated).unwrap_or_default();
        unpack(&String::from_utf8_lossy(&packed)).into_bytes()
    }
}

/// The CSV text of a table that `build.rs` has packed by columns.
fn unpack(packed: &str) -> String {
    let mut parts = packed.split("\n\n");
    let mut csv = parts.next().unwrap_or_default().to_owned();
    let columns: Vec<Vec<String>> = parts.map(column).collect();
    let rows = columns.iter().map(Vec::len).min().unwrap_or(0);
    csv.push('\n');
    for row in 0..rows {
        for (i, column) in columns.iter().enumerate() {
            if i > 0 {
                csv.push(',');
            }
            csv.push_str(&column[row]);
        }
        csv.push('\n');
    }
    csv
}

/// The fields of one column.
fn column(packed: &str) -> Vec<String> {
    let steps = || {
        let mut words = packed.strip_prefix("= ")?.split(' ');
        let step: f64 = words.next()?.parse().ok()?;
        let decimals: usize = words.next()?.parse().ok()?;
        let rows: usize = words.next()?.parse().ok()?;
        Some((0..rows).map(move |i| format!("{:.decimals$}", i as f64 * step)))
    };
    match steps() {
        Some(fields) => fields.collect(),
        None => packed.lines().map(str::to_owned).collect(),
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
