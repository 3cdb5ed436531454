//! What is drawn is what a reader would write: no exponents of a computer, no names of symbols, one unit in a label.

use std::collections::BTreeSet;

use crate::support::ui::{App, PLACES, TALL, app, finish, show, texts};
use egui_kittest::kittest::Queryable as _;

/// Names that files have for Greek letters.
const NAMES: [&str; 7] = ["tau", "phi", "pi", "beta", "omega", "sigma", "eps"];

/// Units that a label may have in the name of a column, beside the one in its brackets.
const UNITS: [&str; 8] = ["deg", "rad", "rpm", "ms", "mm", "mA", "mV", "counts"];

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
    } else {
        None
    }
}

fn unfold(harness: &mut App) {
    for label in ["The equations", "Equation", "Effects that do not help"] {
        if let Some(found) = harness.query_all_by_label(label).next() {
            found.click_accesskit();
        }
        finish(harness);
    }
}

#[test]
fn what_is_drawn_is_what_a_reader_would_write() {
    let mut found = BTreeSet::new();
    let mut count = 0;
    let mut harness = app("start", TALL);
    for place in PLACES {
        show(&mut harness, place);
        unfold(&mut harness);
        for text in texts(&harness) {
            count += 1;
            if let Some(fault) = fault(&text).filter(|_| !is_typed(&text)) {
                found.insert(format!("{fault}: {text:?} at {place}"));
            }
        }
    }
    assert!(count > 2000, "{count} texts");
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn a_fault_is_seen() {
    for text in [
        "1.2e-5 s",
        "x^2",
        "u(t - tau)",
        "u_acting = 3",
        "angle_deg [rad]",
    ] {
        assert!(fault(text).is_some(), "{text}");
    }
    for text in [
        "35.0 mN m ± 0.2 %",
        "2.5 × 10⁻⁷",
        "x1 [mrad]",
        "drive-02",
        "Beta test",
    ] {
        assert_eq!(fault(text), None, "{text}");
    }
}
