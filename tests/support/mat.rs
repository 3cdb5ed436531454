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
