//! Inputs: right ones, of every kind, and what becomes of them when bytes are changed, moved and left out.

use hdf5_pure::mat::Options;
use hdf5_pure::mat::builder::MatBuilder;
use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use crate::doors::Door;

/// Rows of a table: few, so that many are read in a second, but enough for a measurement.
const ROWS: usize = 24;

/// Pieces that a text is made of where none is changed: what stands in files of these kinds.
const PIECES: [&str; 44] = [
    "t",
    "u",
    "y",
    "x1",
    " [s]",
    " [N m]",
    " (5)",
    "time",
    "Ts",
    "\n",
    "\r\n",
    ",",
    ";",
    "\t",
    " ",
    ":",
    "=",
    "{",
    "}",
    "[",
    "]",
    "\"",
    "'",
    "#",
    "0",
    "1",
    "-1",
    "1e308",
    "nan",
    "0,5",
    "1.5",
    "True",
    "off",
    "null",
    "2025-01-31T09:27:03.5Z",
    "23:59:59",
    "1700000000000",
    "°",
    "\u{feff}",
    "[[effects]]",
    "value",
    "%",
    "v1;",
    "explore",
];

/// A stream of inputs.
pub struct Inputs {
    random: Pcg64,
    right: Vec<(Door, Vec<u8>)>,
}

impl Inputs {
    pub fn new(seed: u64) -> Self {
        let mut right = vec![
            (Door::Mat, include_bytes!("../../data/flat-v7.mat").to_vec()),
            (
                Door::Mat,
                include_bytes!("../../data/nested-v7.mat").to_vec(),
            ),
            (Door::Hdf5, hdf5()),
        ];
        let files = include_bytes!("../../data/flat-v7.mat");
        right.extend(unpacked(files).map(|bytes| (Door::Mat, bytes)));
        right.extend(
            texts()
                .into_iter()
                .map(|(door, text)| (door, text.into_bytes())),
        );
        Self {
            random: Pcg64::seed_from_u64(seed),
            right,
        }
    }

    /// The next input.
    pub fn next(&mut self) -> (Door, Vec<u8>) {
        let door = Door::ALL[self.random.random_range(0..Door::ALL.len())];
        let of_door: Vec<usize> = (0..self.right.len())
            .filter(|i| self.right[*i].0 == door)
            .collect();
        let mut bytes = match of_door.get(self.random.random_range(0..of_door.len().max(1))) {
            Some(i) => self.right[*i].1.clone(),
            None => Vec::new(),
        };
        let binary = matches!(door, Door::Mat | Door::Hdf5);
        if !binary && self.random.random_bool(0.2) {
            bytes = self.pieces();
        }
        for _ in 0..self.random.random_range(1..8) {
            self.change(&mut bytes, binary);
        }
        (door, bytes)
    }

    /// A text of pieces.
    fn pieces(&mut self) -> Vec<u8> {
        let count = self.random.random_range(0..400);
        let piece = |_| PIECES[self.random.random_range(0..PIECES.len())];
        (0..count).map(piece).collect::<String>().into_bytes()
    }

    /// Changes one place.
    fn change(&mut self, bytes: &mut Vec<u8>, binary: bool) {
        let at = self.random.random_range(0..=bytes.len());
        let end = (at + self.random.random_range(0..64)).min(bytes.len());
        match self.random.random_range(0..8) {
            0 if at < bytes.len() => bytes[at] = self.random.next_u32() as u8,
            1 if at < bytes.len() => bytes[at] ^= 1 << self.random.random_range(0..8),
            2 => {
                bytes.drain(at..end);
            }
            3 => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            4 if self.random.random_bool(0.2) => bytes.truncate(at),
            // Sizes and places of binary files stand in words.
            5 if binary && bytes.len() >= at + 4 => {
                let word = [0, 1, 0xffff_ffff, 0x7fff_ffff, 0x8000_0000, 0x10, 0x1000]
                    [self.random.random_range(0..7)];
                bytes[at..at + 4].copy_from_slice(&u32::to_le_bytes(word));
            }
            _ => {
                let piece = PIECES[self.random.random_range(0..PIECES.len())];
                bytes.splice(at..at, piece.bytes());
            }
        }
    }
}

/// The variables of a file of MATLAB with nothing compressed, so that changes come to what was within.
fn unpacked(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut out = bytes.get(..128)?.to_vec();
    let mut rest = bytes.get(128..)?;
    while let Some(tag) = rest.first_chunk::<8>() {
        let size = u32::from_le_bytes([tag[4], tag[5], tag[6], tag[7]]) as usize;
        let packed = rest.get(8..8 + size)?;
        out.extend(miniz_oxide::inflate::decompress_to_vec_zlib(packed).ok()?);
        rest = &rest[8 + size..];
    }
    Some(out)
}

/// A file as MATLAB writes it in HDF5, with a structure in it.
fn hdf5() -> Vec<u8> {
    let mut file = MatBuilder::new(Options::default());
    let values: Vec<f64> = (0..ROWS).map(|k| k as f64).collect();
    let written = file.write_f64("t", &[ROWS, 1], &values).is_ok()
        && file
            .struct_("log", |log| {
                log.write_f64("u", &[ROWS, 1], &values)?;
                log.write_f64("y", &[ROWS, 1], &values)?;
                Ok(())
            })
            .is_ok();
    if written {
        file.finish().unwrap_or_default()
    } else {
        Vec::new()
    }
}

/// Right texts of every kind.
fn texts() -> Vec<(Door, String)> {
    let rows = |row: &dyn Fn(usize) -> String| (0..ROWS).map(row).collect::<Vec<_>>();
    let lines = |row: &dyn Fn(usize) -> String| rows(row).join("\n");
    let table = lines(&|k| format!("{k},{},{}", k % 2, k % 5));
    let dated = lines(&|k| {
        format!(
            "2025-01-31T09:00:{k:02}Z;{};{},5",
            ["on", "off"][k % 2],
            k % 5
        )
    });
    let device = lines(&|k| format!("{k}.0,{},{},0", k % 2, k % 5));
    let object = |k: usize| {
        format!(
            "{{\"t\": {k}, \"log\": {{\"u\": {}, \"y\": {}}}}}",
            k % 2,
            k % 5
        )
    };
    let list = rows(&|k| (k % 5).to_string()).join(",");
    let csv = [
        format!("t [s],u [N m],x1 [rad]\n{table}"),
        format!("# rig\ntime,control,temperature\n{table}"),
        format!("timestamp;heater;temp (5)\n{dated}"),
        format!("Recorder\nSamples,24\nTime,A 1,A 2,A 3\nms,heater,temperature,-\n{device}"),
        format!(
            "u,y,Ts\n0,1,4\n{}",
            lines(&|k| format!("{},{},", k % 2, k % 5))
        ),
    ];
    let json = [
        lines(&object),
        format!("[{}]", rows(&object).join(",")),
        format!("{{\"Ts\": 1, \"u\": [{list}], \"y\": [{list}]}}"),
    ];
    let logs = [
        lines(&|k| format!("t: {k} u: {} y: {}", k % 2, k % 5)),
        lines(&|k| format!("[info] t={k}s, u={} V, y={} degC", k % 2, k % 5)),
    ];
    let scenarios = [
        "[plant]\nnumerator = [1.0]\ndenominator = [1.0, 3.0, 3.0, 1.0]\ndead_time = 0.1\n[relay]\ngain = 1.0\nhysteresis = 0.1\nasymmetry = 0.2\ndelay = 0.01\n[run]\nduration = 60.0\n",
        include_str!("../../../assets/scenarios/drive-drifting.toml"),
    ];
    let models = [
        "kind = \"drive\"\n[parameters]\nJ1 = 8.8e-4\nd1 = { value = 2e-3, tolerance = 5e-4 }\n[[effects]]\nid = \"coulomb_friction\"\n",
        "kind = \"process\"\n[parameters]\nK = 2.0\n[[effects]]\nid = \"input_delay\"\n[[effects]]\nid = \"bump\"\nformula = \"-a*exp(-((y-b)/c)^2)\"\n",
    ];
    let links = [
        "v1;explore;loop.relay.gain=2;explore.margin=true",
        "https://example.org/#v1;explore;loop.plant.denominator=1,2,3;explore.view=%22bode%22",
    ];
    let all = csv.into_iter().map(|t| (Door::Csv, t));
    let all = all.chain(json.into_iter().map(|t| (Door::Json, t)));
    let all = all.chain(logs.into_iter().map(|t| (Door::Log, t)));
    let all = all.chain(
        scenarios
            .into_iter()
            .map(|t| (Door::Scenario, t.to_owned())),
    );
    let all = all.chain(models.into_iter().map(|t| (Door::Model, t.to_owned())));
    all.chain(links.into_iter().map(|t| (Door::Link, t.to_owned())))
        .collect()
}
