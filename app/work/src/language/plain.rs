//! What is the same in every language.

/// Words that are the same in every language: units, names of functions and of parameters.
const SAME: [&str; 59] = [
    "rad", "mrad", "deg", "rev", "ms", "us", "µs", "kg", "mm", "um", "mN", "kN", "mA", "mV", "Hz",
    "rpm", "min", "Ti", "Td", "Tf", "Ms", "cos", "sin", "exp", "sgn", "ln", "sqrt", "tau", "phi",
    "beta", "dt", "dy", "du", "dx", "dv", "log", "Hysteron", "csv", "toml", "abs", "rms", "kHz",
    "max", "counts", "dw", "tanh", "dc", "Ku", "Tu", "µrad", "µm", "µN", "µV", "ambient", "kp",
    "ki", "kd", "ti", "td",
];

/// Whether a text has nothing to translate: numbers, units and symbols only.
pub fn is_plain(text: &str) -> bool {
    let name = |word: &str| word.contains(|c: char| c == '_' || c.is_ascii_digit());
    let words = text.split_whitespace().filter(|w| !name(w));
    words
        .flat_map(|word| word.split(|c: char| !c.is_alphabetic()))
        .all(|word| {
            let short = word.chars().count() < 2;
            let shouted = !word.chars().any(char::is_lowercase);
            short || shouted || SAME.contains(&word)
        })
}
