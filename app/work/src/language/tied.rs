//! Spaces at which no line breaks: a number stays with its unit and its error, a name with its value.

/// A space at which no line breaks.
pub const TIE: char = '\u{a0}';

/// What stands behind a number and belongs to it.
const UNITS: [&str; 40] = [
    "%", "°", "s", "ms", "µs", "us", "min", "h", "rad", "mrad", "µrad", "deg", "rad/s", "mrad/s",
    "deg/s", "°/s", "rpm", "1/s", "m", "mm", "µm", "m/s", "mm/s", "N", "mN", "kN", "µN", "kg", "g",
    "Hz", "kHz", "A", "mA", "V", "mV", "dB", "x", "1/rad", "1/m", "counts",
];

/// What goes on with a unit behind a space, as in N m.
const REST: [&str; 12] = [
    "m",
    "m²",
    "m^2",
    "mm²",
    "mm^2",
    "s",
    "m/rad",
    "s/rad",
    "s/m",
    "m/A",
    "s²/rad²",
    "s^2/rad^2",
];

/// Longest name that stays with its value, letters.
const NAME: usize = 3;

/// A text in which what belongs together stays on one line.
pub fn tied(text: String) -> String {
    if !text.contains(' ') || !text.contains(|c: char| c.is_ascii_digit()) {
        return text;
    }
    let words: Vec<&str> = text.split(' ').collect();
    let mut out = String::with_capacity(text.len() + 8);
    // Whether the word before is a unit.
    let mut unit = false;
    for (i, word) in words.iter().enumerate() {
        if let Some(before) = i.checked_sub(1).and_then(|b| words.get(b)) {
            let plain = word.trim_end_matches(['.', ',', ';', ':', ')', '?', '!', '\n']);
            let goes_on = unit && REST.contains(&plain);
            unit = goes_on || ends_a_number(before) && UNITS.contains(&plain);
            let together = unit || is_error(before, word) || is_value(before, word);
            out.push(if together { TIE } else { ' ' });
            // A sentence that ends with a unit does not go on with it.
            unit &= plain.len() == word.len();
        }
        out.push_str(word);
    }
    out
}

fn begins_a_number(word: &str) -> bool {
    let digits = word.trim_start_matches(['(', '-', '+', '±']);
    digits.starts_with(|c: char| c.is_ascii_digit())
}

fn ends_a_number(word: &str) -> bool {
    let digits = word.trim_end_matches(')');
    digits.ends_with(|c: char| c.is_ascii_digit())
}

/// A value and its error: 0.5 ± 0.1.
fn is_error(before: &str, word: &str) -> bool {
    word == "±" && ends_a_number(before) || before == "±" && begins_a_number(word)
}

/// A name and its value: k = 0.5.
fn is_value(before: &str, word: &str) -> bool {
    before == "=" && begins_a_number(word) || word == "=" && before.chars().count() <= NAME
}

#[cfg(test)]
mod tests {
    use super::tied;

    #[test]
    fn a_number_keeps_its_unit_and_its_error() {
        // A tie is shown as _.
        for text in [
            "period 4.788_s, amplitude 0.2857.",
            "18_% of these loops; -1,0_% in period",
            "0.0403_±_0.0003_N_m. Nothing more",
            "(1.3468_±_0.0041)e-5_rad and (2_±_1)_s",
            "8.8e-4_±_1e-5_kg_m², 2_mN_m_s/rad is much",
            "After: K_=_1.401, Td_=_0.4893_s.",
            "10000 samples in drive 2 so 5 more is 3 %x",
            "no number s here",
            "gain k [N m]",
        ] {
            let plain = text.replace('_', " ");
            assert_eq!(tied(plain).replace('\u{a0}', "_"), text);
        }
    }
}
