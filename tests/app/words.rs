//! What is drawn is what a reader would write: no exponents of a computer, no names of symbols, one unit in a label,
//! and no more digits than someone reads.

use std::collections::BTreeSet;

use crate::support::ui::{App, PLACES, TALL, app, finish, show, texts};
use egui::Key;
use egui_kittest::kittest::Queryable as _;
use hysteron::language::Language;
use hysteron::lessons;

/// Names that files have for Greek letters.
const NAMES: [&str; 7] = ["tau", "phi", "pi", "beta", "omega", "sigma", "eps"];

/// Units that a label may have in the name of a column, beside the one in its brackets.
const UNITS: [&str; 8] = ["deg", "rad", "rpm", "ms", "mm", "mA", "mV", "counts"];

/// Most digits of a number: the settings of a plant have no more.
const DIGITS: usize = 6;

/// What a diagnosis shows beside [`PLACES`]: its other views, and a formula.
const VIEWS: [&str; 4] = [
    "v1;compare;compare.file=drive-02;compare.look=places",
    "v1;compare;compare.file=drive-02;compare.look=fingerprint",
    "v1;compare;compare.file=drive-02;compare.guess=true",
    "v1;compare;compare.file=drive-15",
];

/// What is folded, in both languages.
const FOLDED: [&str; 6] = [
    "The equations",
    "Equation",
    "Effects that do not help",
    "Die Gleichungen",
    "Gleichung",
    "Effekte, die nicht helfen",
];

/// What someone types, or would: formulas and the columns of a file.
fn is_typed(text: &str) -> bool {
    ["exp(", "e^{", "s^", "t [s],u", "counts, ", "/rev"]
        .iter()
        .any(|part| text.contains(part))
}

/// What is wrong with a text, if something is.
fn fault(text: &str) -> Option<&'static str> {
    let chars: Vec<char> = text.chars().collect();
    let exponent = chars
        .windows(3)
        .any(|w| w[0].is_ascii_digit() && w[1] == 'e' && (w[2] == '-' || w[2].is_ascii_digit()));
    let words = || text.split(|c: char| !c.is_alphanumeric() && c != '_');
    let (name, unit) = text.split_once(" [").unwrap_or((text, ""));
    let ends =
        |unit: &&str| name.ends_with(&format!("_{unit}")) || name.ends_with(&format!(" {unit}"));
    if exponent {
        Some("an exponent")
    } else if text.contains('^') {
        Some("a raised sign")
    } else if words().any(|word| NAMES.contains(&word)) {
        Some("the name of a symbol")
    } else if words()
        .any(|word| word.starts_with("u_") || word.starts_with("T_") || word.starts_with("c_"))
    {
        Some("a raw symbol")
    } else if !unit.is_empty() && UNITS.iter().any(ends) {
        Some("two units")
    } else if numbers(text).any(|number| number.starts_with('-') && digits(number) == 0) {
        Some("a zero with a sign")
    } else if numbers(text).any(|number| digits(number) > DIGITS) {
        Some("digits that nobody reads")
    } else {
        None
    }
}

/// The numbers in a text.
fn numbers(text: &str) -> impl Iterator<Item = &str> {
    let ends = |c: char| !c.is_ascii_digit() && c != '-';
    let words = text.split_whitespace().map(move |w| w.trim_matches(ends));
    words.filter(|word| {
        let plain = |c: char| c.is_ascii_digit() || ".,-".contains(c);
        word.contains(|c: char| c.is_ascii_digit()) && word.chars().all(plain)
    })
}

/// Digits of a number from the first that is not 0; those behind a point count although they are.
fn digits(number: &str) -> usize {
    let told = number.trim_start_matches(|c: char| !c.is_ascii_digit() || c == '0');
    let told = told.trim_start_matches(['.', ',', '0']);
    let told = if number.contains(['.', ',']) {
        told
    } else {
        told.trim_end_matches('0')
    };
    told.chars().filter(char::is_ascii_digit).count()
}

fn unfold(harness: &mut App) {
    for label in FOLDED {
        if let Some(found) = harness.query_all_by_label(label).next() {
            found.click_accesskit();
        }
        finish(harness);
    }
}

/// Everything that is drawn in a language, and where.
fn drawn(language: Language) -> Vec<(String, String)> {
    let mut harness = app("start", TALL);
    harness.state_mut().speak(language);
    finish(&mut harness);
    let mut drawn = Vec::new();
    let lessons = lessons::all().map(|lesson| format!("v1;explore;lesson={}", lesson.id));
    let places = PLACES.into_iter().chain(VIEWS).map(str::to_owned);
    for place in places.chain(lessons) {
        show(&mut harness, &place);
        unfold(&mut harness);
        let texts = texts(&harness).into_iter();
        drawn.extend(texts.map(|text| (text, place.clone())));
    }
    harness.key_press(Key::F1);
    finish(&mut harness);
    let texts = texts(&harness).into_iter();
    drawn.extend(texts.map(|text| (text, "the keys".to_owned())));
    drawn
}

#[test]
fn what_is_drawn_is_what_a_reader_would_write() {
    for language in Language::ALL {
        let drawn = drawn(language);
        assert!(drawn.len() > 3000, "{} texts", drawn.len());
        let faults = drawn.into_iter().filter(|(text, _)| !is_typed(text));
        let faults = faults.filter_map(|(text, place)| {
            let fault = fault(&text)?;
            Some(format!("{fault}: {text:?} at {place}"))
        });
        let faults: BTreeSet<String> = faults.collect();
        assert!(faults.is_empty(), "{}: {faults:#?}", language.code());
    }
}

#[test]
fn a_fault_is_seen() {
    for text in [
        "1.2e-5 s",
        "x^2",
        "u(t - tau)",
        "u_acting = 3",
        "angle_deg [rad]",
        "-0.00 mrad",
        "0.28568739",
        "Amplitude 12345,67",
    ] {
        assert!(fault(text).is_some(), "{text}");
    }
    for text in [
        "35.0 mN m ± 0.2 %",
        "2.5 × 10⁻⁷",
        "x1 [mrad]",
        "10000 samples, 0.00100 s apart",
        "from -0.090 to 0.113 rad/s",
        "drive-02",
        "Beta test",
    ] {
        assert_eq!(fault(text), None, "{text}");
    }
}
