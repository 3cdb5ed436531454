//! A diagnosis as text that a person wants to read, 80 columns wide.

use std::fmt::Write as _;

use hysteron_core::criticism::{Candidate, Diagnosis, Step, with_error};
use hysteron_core::effect::{self, EffectId};
use hysteron_core::measurement::Kind;

/// Widest bar of the chart, in characters.
const BAR: usize = 40;

/// Line length.
const WIDTH: usize = 80;

/// The whole diagnosis; `name` is that of the file.
pub fn render(diagnosis: &Diagnosis, name: &str) -> String {
    let mut out = String::new();
    let kind = match diagnosis.kind {
        Kind::Drive => "drive",
        Kind::Process => "process",
    };
    let _ = writeln!(out, "{name}: {kind}, {} samples\n", diagnosis.samples);
    let mut previous: Option<&Step> = None;
    for step in &diagnosis.steps {
        heading(&mut out, previous, step);
        parameters(&mut out, step);
        for finding in &step.findings {
            wrapped(&mut out, &format!("  Where: {}", finding.text), 9);
        }
        candidates(&mut out, step);
        out.push('\n');
        previous = Some(step);
    }
    waterfall(&mut out, diagnosis);
    out.push('\n');
    wrapped(&mut out, &diagnosis.verdict.text, 0);
    if let Some(next) = &diagnosis.verdict.next_experiment {
        wrapped(&mut out, &format!("Next experiment: {next}"), 0);
    }
    let _ = writeln!(out, "({:.1} s)", diagnosis.seconds);
    out
}

fn effect_name(id: EffectId) -> &'static str {
    effect::find(id).map_or(id.as_str(), effect::Effect::name)
}

/// What changed from the step before.
fn change(previous: Option<&Step>, step: &Step) -> String {
    let Some(previous) = previous else {
        return "Baseline".to_owned();
    };
    let names = |a: &Step, b: &Step| -> Vec<&str> {
        a.effects.iter().filter(|e| !b.effects.contains(e)).map(|e| effect_name(*e)).collect()
    };
    let (added, removed) = (names(step, previous), names(previous, step));
    let mut parts: Vec<String> = added.iter().map(|n| format!("+ {n}")).collect();
    parts.extend(removed.iter().map(|n| format!("- {n}")));
    parts.join(", ")
}

fn heading(out: &mut String, previous: Option<&Step>, step: &Step) {
    let _ = writeln!(
        out,
        "{}: the model misses by {} times the noise",
        change(previous, step),
        significant(step.error)
    );
}

fn parameters(out: &mut String, step: &Step) {
    for p in &step.parameters {
        let _ = writeln!(out, "  {:4} {:<36} {}", p.name, p.label, with_error(p.value, p.std_error, &p.unit));
    }
}

fn candidates(out: &mut String, step: &Step) {
    if step.candidates.is_empty() {
        return;
    }
    let _ = writeln!(out, "  {:<22} {:>16} {:>12}", "If added:", "error it leaves", "evidence");
    for c in &step.candidates {
        let name = c.effects.iter().map(|e| effect_name(*e)).collect::<Vec<_>>().join(" + ");
        let _ = writeln!(
            out,
            "  {} {:<20} {:>16} {:>12}{}",
            if c.significant { '*' } else { ' ' },
            name,
            significant(c.error),
            evidence(c),
            same_as(c)
        );
    }
}

fn evidence(c: &Candidate) -> String {
    if c.delta_bic < -10.0 { format!("{:.0}", -c.delta_bic) } else { "none".to_owned() }
}

fn same_as(c: &Candidate) -> String {
    let names: Vec<&str> = c.equivalent_to.iter().map(|e| effect_name(*e)).collect();
    if names.is_empty() { String::new() } else { format!("  same as {}", names.join(", ")) }
}

/// The error falling step by step, on a logarithmic scale from the noise floor.
fn waterfall(out: &mut String, diagnosis: &Diagnosis) {
    let _ = writeln!(out, "Error in units of the noise (bars on a logarithmic scale)");
    let largest = diagnosis.steps.iter().map(|s| s.error).fold(2.0, f64::max);
    let bar = |error: f64| {
        let share = (error / diagnosis.noise_floor).max(1.0).ln() / (largest / diagnosis.noise_floor).ln();
        "#".repeat(1 + (share * (BAR - 1) as f64).round() as usize)
    };
    let mut previous: Option<&Step> = None;
    for step in &diagnosis.steps {
        let label: String = change(previous, step).chars().take(24).collect();
        let _ = writeln!(out, "  {label:<24} {:>8} {}", significant(step.error), bar(step.error));
        previous = Some(step);
    }
    let _ = writeln!(out, "  {:<24} {:>8} {}", "noise floor", significant(diagnosis.noise_floor), bar(diagnosis.noise_floor));
}

/// Three significant digits.
fn significant(value: f64) -> String {
    if value >= 100.0 {
        format!("{value:.0}")
    } else if value >= 10.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.2}")
    }
}

/// Breaks a line at spaces; later lines are indented.
fn wrapped(out: &mut String, text: &str, indent: usize) {
    let start = text.len() - text.trim_start().len();
    let mut line = " ".repeat(start);
    let mut empty = true;
    for word in text.split_whitespace() {
        if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(out, "{line}");
            line = " ".repeat(indent);
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    let _ = writeln!(out, "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_sentences_are_broken_at_eighty_columns() {
        let mut out = String::new();
        wrapped(&mut out, &"word ".repeat(40), 2);
        assert!(out.lines().count() > 2 && out.lines().all(|l| l.chars().count() <= WIDTH));
    }
}
