//! A writer of MATLAB's level 5 files of its own, after the format's description.

#![allow(dead_code, reason = "each test uses a part of these")]

/// One element, padded to 8 bytes.
pub fn element(big: bool, kind: u32, data: &[u8]) -> Vec<u8> {
    let word = |n: u32| {
        if big {
            n.to_be_bytes()
        } else {
            n.to_le_bytes()
        }
    };
    let mut bytes = [word(kind), word(data.len() as u32)].concat();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// A file with one array of this class, whose numbers are stored as this type.
pub fn file(
    big: bool,
    name: &str,
    class: u32,
    sizes: [i32; 2],
    stored: u32,
    numbers: &[u8],
) -> Vec<u8> {
    let word = |n: u32| {
        if big {
            n.to_be_bytes()
        } else {
            n.to_le_bytes()
        }
    };
    let sizes = sizes.map(|n| word(n as u32)).concat();
    let array = [
        element(big, 6, &[word(class), word(0)].concat()),
        element(big, 5, &sizes),
        element(big, 1, name.as_bytes()),
        element(big, stored, numbers),
    ]
    .concat();
    let mut bytes = vec![b' '; 124];
    bytes.extend(if big { *b"\x01\x00MI" } else { *b"\x00\x01IM" });
    bytes.extend(element(big, 14, &array));
    bytes
}

/// Content of an array of this class whose numbers are stored as this type, in little-endian order.
fn array(class: u32, sizes: [u32; 2], name: &str, stored: u32, numbers: &[u8]) -> Vec<u8> {
    let head = [
        element(false, 6, &words(&[class, 0])),
        element(false, 5, &words(&sizes)),
    ];
    let rest = [
        element(false, 1, name.as_bytes()),
        element(false, stored, numbers),
    ];
    [head.concat(), rest.concat()].concat()
}

/// An object of a class of MATLAB's own, with what it holds.
fn opaque(name: &str, class: &str, content: &[u8]) -> Vec<u8> {
    let texts = [name, "MCOS", class].map(|text| element(false, 1, text.as_bytes()));
    let flags = element(false, 6, &words(&[17, 0]));
    [flags, texts.concat(), element(false, 14, content)].concat()
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|w| w.to_le_bytes()).collect()
}

fn doubles(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// A file with a timeseries of each name, its times and values, as Simulink logs them: the variables only refer to
/// objects, which a subsystem at the end describes. After what is known of the format (`MATLAB` does not publish it).
pub fn timeseries(logged: &[(&str, Vec<f64>, Vec<f64>)]) -> Vec<u8> {
    // The names that the description uses, counted from 1.
    const NAMES: [&str; 3] = ["timeseries", "Time_", "Data_"];
    let mut names: Vec<u8> = NAMES
        .iter()
        .flat_map(|n| [n.as_bytes(), b"\0"].concat())
        .collect();
    names.resize(names.len().next_multiple_of(8), 0);
    let classes = vec![0, 0, 0, 0, 0, 1, 0, 0];
    // The first of each list stands for none.
    let saved = vec![0, 0];
    let (mut objects, mut own) = (vec![0; 6], vec![0, 0]);
    let mut values = vec![Vec::new(), Vec::new()];
    for (k, (_, time, data)) in logged.iter().enumerate() {
        let (k, cell) = (k as u32 + 1, 2 * k as u32);
        objects.extend([1, 0, 0, 0, k, k]);
        own.extend([2, 2, 1, cell, 3, 1, cell + 1, 0]);
        for v in [time, data] {
            values.push(array(6, [v.len() as u32, 1], "", 9, &doubles(v)));
        }
    }
    let regions = [
        classes,
        saved,
        objects,
        own,
        vec![0, 0],
        vec![0, 0],
        vec![0, 0],
    ];
    let head = 4 * (2 + 8);
    let mut begins = vec![(head + names.len()) as u32];
    for region in &regions {
        begins.push(begins[begins.len() - 1] + 4 * region.len() as u32);
    }
    let description = [
        words(&[4, NAMES.len() as u32]),
        words(&begins),
        names,
        words(&regions.concat()),
    ]
    .concat();
    values[0] = array(9, [description.len() as u32, 1], "", 2, &description);
    let cells: Vec<u8> = values.iter().flat_map(|v| element(false, 14, v)).collect();
    let head = [
        element(false, 6, &words(&[1, 0])),
        element(false, 5, &words(&[values.len() as u32, 1])),
    ];
    let wrapper = [head.concat(), element(false, 1, b""), cells].concat();
    let field = opaque("", "FileWrapper__", &wrapper);
    let head = [
        element(false, 6, &words(&[2, 0])),
        element(false, 5, &words(&[1, 1])),
        element(false, 1, b""),
    ];
    let fields = [
        element(false, 5, &words(&[5])),
        element(false, 1, b"MCOS\0"),
        element(false, 14, &field),
    ];
    let structure = [head.concat(), fields.concat()].concat();
    let inner = [
        b"\x00\x01IM\0\0\0\0".to_vec(),
        element(false, 14, &structure),
    ]
    .concat();
    let subsystem = element(false, 14, &array(9, [1, inner.len() as u32], "", 2, &inner));
    let variables: Vec<u8> = logged
        .iter()
        .enumerate()
        .flat_map(|(k, (name, ..))| {
            let reference = words(&[0xdd00_0000, 2, 1, 1, k as u32 + 1, 1]);
            let reference = array(13, [6, 1], "", 6, &reference);
            element(false, 14, &opaque(name, "timeseries", &reference))
        })
        .collect();
    let mut bytes = vec![b' '; 116];
    bytes.extend((128 + variables.len() as u64).to_le_bytes());
    bytes.extend(*b"\x00\x01IM");
    [bytes, variables, subsystem].concat()
}

/// A file with a record of each name as the System Identification Toolbox keeps them: input, output and sampling period
/// in cells of an object, beside a variable of one number.
pub fn iddata(records: &[(&str, Vec<f64>, Vec<f64>, f64)]) -> Vec<u8> {
    let head = |class: u32, sizes: [u32; 2], name: &str| {
        let flags = element(false, 6, &words(&[class, 0]));
        let sizes = element(false, 5, &words(&sizes));
        [flags, sizes, element(false, 1, name.as_bytes())].concat()
    };
    let in_a_cell = |values: &[f64]| {
        let inside = array(6, [values.len() as u32, 1], "", 9, &doubles(values));
        let cell = [head(1, [1, 1], ""), element(false, 14, &inside)].concat();
        element(false, 14, &cell)
    };
    let mut bytes = vec![b' '; 124];
    bytes.extend(*b"\x00\x01IM");
    let count = array(6, [1, 1], "n", 9, &doubles(&[2.0]));
    bytes.extend(element(false, 14, &count));
    for (name, input, output, step) in records {
        const LENGTH: usize = 16;
        let mut names = Vec::new();
        for field in ["OutputData", "InputData", "Ts", "Notes"] {
            let mut padded = field.as_bytes().to_vec();
            padded.resize(LENGTH, 0);
            names.extend(padded);
        }
        let fields = [
            in_a_cell(output),
            in_a_cell(input),
            in_a_cell(&[*step]),
            element(false, 14, &head(1, [0, 0], "")),
        ];
        let object = [
            head(3, [1, 1], name),
            element(false, 1, b"iddata"),
            element(false, 5, &words(&[LENGTH as u32])),
            element(false, 1, &names),
            fields.concat(),
        ];
        bytes.extend(element(false, 14, &object.concat()));
    }
    bytes
}
