//! A diagnosis as a person wants to read it: 80 columns, no colours.

use std::fmt::Write as _;

use hysteron_core::diagnosis::{
    Candidate, Diagnosis, Discovery, InputCheck, InputVerdict, NextExperiment, Parameter, Step,
};
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::Kind;
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::uncertain::{brief, with_error};
use hysteron_work::language::{say, tr_number};

const WIDTH: usize = 80;

/// Longest bar of the chart, in characters.
const BAR: usize = 40;

/// Above this ratio of largest to smallest a linear bar of the smallest would not be seen.
const LOGARITHMIC_FROM: f64 = 40.0;

/// The report on the measurement called `name`, with notes of its import; ends with a newline.
pub fn render(diagnosis: &Diagnosis, name: &str, notes: &[Message]) -> String {
    let mut out = String::new();
    let title: String = name
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    let title = Message::name(title);
    paragraph(
        &mut out,
        "",
        match diagnosis.kind {
            Kind::Drive => msg!("{}: {} samples of a drive", title, diagnosis.samples),
            Kind::Process => msg!("{}: {} samples of a process", title, diagnosis.samples),
        },
    );
    for note in notes {
        bullet(&mut out, note);
    }
    let doubted =
        |check: &&InputCheck| check.verdict != InputVerdict::Ok && !diagnosis.verdict.complete;
    if let Some(check) = diagnosis.input_check.as_ref().filter(doubted) {
        bullet(&mut out, &check.text);
    }
    for overruled in &diagnosis.verdict.overruled {
        bullet(&mut out, overruled.words());
    }
    for noise in &diagnosis.noise {
        bullet(&mut out, noise.words());
    }
    for (i, step) in diagnosis.steps.iter().enumerate() {
        let before = i.checked_sub(1).and_then(|k| diagnosis.steps.get(k));
        let is_last = i + 1 == diagnosis.steps.len();
        describe_step(&mut out, step, before, is_last, diagnosis.noise_floor);
    }
    if !diagnosis.steps.is_empty() {
        chart(&mut out, diagnosis);
    }
    heading(&mut out, "Verdict");
    paragraph(&mut out, "  ", &diagnosis.verdict.text);
    if let Some(experiment) = &diagnosis.verdict.next_experiment
        && !diagnosis
            .verdict
            .text
            .to_string()
            .contains(&experiment.to_string())
    {
        paragraph(&mut out, "  ", msg!("Next experiment: {}", experiment));
    }
    for proposal in &diagnosis.verdict.experiments {
        other_experiments(&mut out, proposal);
    }
    let took = say(msg!("Took {} s.", fixed(diagnosis.seconds, 2)));
    let _ = writeln!(out, "\n{took}");
    out
}

/// The formula of what is left, and those that were tried by their length; ends with a newline.
pub fn formulas(discovery: &Discovery) -> String {
    let mut text = String::new();
    let out = &mut text;
    heading(out, "Formula of the unknown");
    paragraph(out, "  ", &discovery.text);
    if !discovery.formulas.is_empty() {
        let [length, error, formula] = ["length", "error", "formula"].map(say);
        let _ = writeln!(out, "  {length:>6}  {error:>6}  {formula}");
    }
    let listed = discovery
        .formulas
        .iter()
        .filter(|f| f.on_front || f.in_class);
    for formula in listed {
        let mark = if formula.in_class { '*' } else { ' ' };
        let (length, error) = (formula.length, tr_number(brief(formula.error)));
        let _ = writeln!(out, "{mark} {length:6}  {error:>6}  {}", formula.formula);
    }
    if let Some(found) = discovery.found() {
        let again = say("Again with");
        let _ = writeln!(out, "  {again}: --effect \"{}\"", found.typed);
    }
    if let Some(experiment) = &discovery.experiment {
        paragraph(out, "  ", msg!("Next experiment: {}", &experiment.text));
        other_experiments(out, experiment);
    }
    text
}

/// What the other kinds of experiment would do.
fn other_experiments(out: &mut String, proposal: &NextExperiment) {
    if !proposal.others.is_empty() {
        paragraph(
            out,
            "  ",
            "In other experiments the models would differ by:",
        );
    }
    for other in &proposal.others {
        let times = other.times_noise();
        bullet(out, msg!("{} times the noise with {}", times, &other.text));
    }
}

fn describe_step(out: &mut String, step: &Step, before: Option<&Step>, is_last: bool, floor: f64) {
    let title = before.map_or_else(|| "Baseline".into(), |before| change(step, before));
    heading(out, title);
    paragraph(
        out,
        "  ",
        msg!(
            "Error {} times the noise on held-back data; a perfect model would leave {}.",
            brief(step.error),
            brief(floor)
        ),
    );
    if step.left > 0.0 {
        let missed = msg!("The model misses {} % of the motion.", percent(step.left));
        paragraph(out, "  ", &missed);
    }
    // Of the last model all are said: the body is what it was found to be with all effects.
    let fresh = |p: &&Parameter| match before {
        None => true,
        Some(_) if is_last => true,
        Some(before) => p.effect.is_some_and(|e| !before.effects.contains(&e)),
    };
    parameters(
        out,
        &step.parameters.iter().filter(fresh).collect::<Vec<_>>(),
    );
    if !step.findings.is_empty() {
        let _ = writeln!(out, "\n  {}", say("Where it fails"));
        for finding in &step.findings {
            bullet(out, &finding.text);
        }
    }
    if !step.tests.is_empty() {
        let _ = writeln!(out, "\n  {}", say("What is left"));
        for test in &step.tests {
            bullet(out, &test.text);
        }
    }
    candidates(out, &step.candidates);
}

/// What was added to and taken from the model before, such as `+ Coulomb friction`.
fn change(step: &Step, before: &Step) -> Message {
    let changes = step.changes_from(before);
    if changes.is_empty() {
        "Refitted".into()
    } else {
        changes
    }
}

fn names(ids: &[EffectId]) -> String {
    ids.iter()
        .map(|id| id.as_str())
        .collect::<Vec<_>>()
        .join(" + ")
}

fn parameters(out: &mut String, list: &[&Parameter]) {
    let labels: Vec<String> = list
        .iter()
        .map(|p| say(Message::words(p.label.clone())))
        .collect();
    let name = widest(list.iter().map(|p| p.name.as_str()));
    let width = widest(labels.iter().map(String::as_str));
    for (p, label) in list.iter().zip(&labels) {
        let value = say(with_error(p.value, p.std_error, &p.unit));
        line(
            out,
            &format!("  {:<name$}  {label:<width$}  {value}", p.name),
        );
    }
}

fn candidates(out: &mut String, list: &[Candidate]) {
    if list.is_empty() {
        return;
    }
    let rows: Vec<(String, &Candidate)> = list.iter().map(|c| (names(&c.effects), c)).collect();
    let [title, error, evidence] = ["What could be added", "error", "evidence"].map(say);
    let names = rows.iter().map(|r| r.0.as_str());
    let width = widest(names.chain([title.as_str()]));
    let _ = writeln!(out);
    line(
        out,
        &format!("  {title:<width$}  {error:>9}  {evidence:>10}"),
    );
    for (name, candidate) in rows {
        let head = format!(
            "  {name:<width$}  {:>9}  {:>10}  ",
            tr_number(brief(candidate.error)),
            tr_number(format!("{:.1}", candidate.delta_bic))
        );
        let note = if candidate.equivalent_to.is_empty() {
            say(candidate.standing())
        } else {
            let ids: Vec<&str> = candidate.equivalent_to.iter().map(|e| e.as_str()).collect();
            format!("{} {}", say("same as"), ids.join(", "))
        };
        let indent = head.chars().count();
        let notes = wrap(&note, WIDTH.saturating_sub(indent).max(20));
        for (i, piece) in notes.iter().enumerate() {
            let lead = if i == 0 {
                head.clone()
            } else {
                " ".repeat(indent)
            };
            line(out, &format!("{lead}{piece}"));
        }
    }
    paragraph(
        out,
        "  ",
        "(error: in noise units after a refit; evidence: change of BIC, negative is better)",
    );
}

/// The error of every model and the noise floor as bars.
fn chart(out: &mut String, diagnosis: &Diagnosis) {
    let mut rows: Vec<(Message, f64)> = Vec::new();
    let mut before: Option<&Step> = None;
    for step in &diagnosis.steps {
        rows.push((
            before.map_or_else(|| "baseline".into(), |b| change(step, b)),
            step.error,
        ));
        before = Some(step);
    }
    rows.push(("noise floor".into(), diagnosis.noise_floor));
    let rows: Vec<(String, f64)> = rows.into_iter().map(|r| (say(r.0), r.1)).collect();
    let finite = || {
        rows.iter()
            .map(|r| r.1)
            .filter(|e| e.is_finite() && *e > 0.0)
    };
    let (most, least) = (
        finite().fold(0.0, f64::max),
        finite().fold(f64::INFINITY, f64::min),
    );
    let logarithmic = most > LOGARITHMIC_FROM * least;
    let title = if logarithmic {
        "Error step by step (times the noise, bars logarithmic)"
    } else {
        "Error step by step (times the noise)"
    };
    heading(out, title);
    let width = widest(rows.iter().map(|r| r.0.as_str())).min(WIDTH - BAR - 14);
    for (label, error) in &rows {
        let label: String = label.chars().take(width).collect();
        let share = if logarithmic {
            // Bars begin at half the least, so that the least is seen as well.
            (error / (0.5 * least)).ln() / (most / (0.5 * least)).ln()
        } else {
            error / most
        };
        let value = tr_number(brief(*error));
        line(
            out,
            &format!("  {label:<width$}  {value:>8}  {}", bar(share)),
        );
    }
}

/// A bar with a resolution of an eighth of a character.
fn bar(share: f64) -> String {
    const PARTS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let share = if share.is_finite() {
        share.clamp(0.0, 1.0)
    } else {
        0.0
    };
    let eighths = (share * (BAR * 8) as f64).round() as usize;
    "█".repeat(eighths / 8) + PARTS[eighths % 8]
}

/// A share in per cent, two digits that count.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent >= 10.0 {
        format!("{percent:.0}")
    } else if percent >= 1.0 {
        format!("{percent:.1}")
    } else {
        format!("{percent:.2}")
    }
}

/// Characters of the longest.
fn widest<'a>(texts: impl Iterator<Item = &'a str>) -> usize {
    texts.map(|t| t.chars().count()).max().unwrap_or(0)
}

/// A heading in the language that is spoken, as paragraphs and bullets are.
fn heading(out: &mut String, text: impl Into<Message>) {
    let _ = writeln!(out);
    let lines = wrap(&say(text.into()), WIDTH);
    let rule = lines.iter().map(|l| l.chars().count()).max().unwrap_or(0);
    for text in lines {
        line(out, &text);
    }
    line(out, &"-".repeat(rule));
}

fn paragraph(out: &mut String, indent: &str, text: impl Into<Message>) {
    for piece in wrap(&say(text.into()), WIDTH - indent.len()) {
        line(out, &format!("{indent}{piece}"));
    }
}

fn bullet(out: &mut String, text: impl Into<Message>) {
    for (i, piece) in wrap(&say(text.into()), WIDTH - 4).iter().enumerate() {
        line(
            out,
            &format!("{}{piece}", if i == 0 { "  - " } else { "    " }),
        );
    }
}

fn line(out: &mut String, text: &str) {
    out.push_str(text.trim_end());
    out.push('\n');
}

/// Lines of at most `width` characters; only a single longer word goes beyond.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut used = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if used > 0 && used + 1 + length > width {
            lines.push(String::new());
            used = 0;
        }
        if let Some(last) = lines.last_mut() {
            if used > 0 {
                last.push(' ');
                used += 1;
            }
            last.push_str(word);
            used += length;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_as_long_as_their_share() {
        assert_eq!(bar(1.0).chars().count(), BAR);
        assert_eq!(bar(0.5).chars().count(), BAR / 2);
        assert_eq!(bar(0.0), "");
        assert_eq!(bar(1.0 / 320.0), "▏");
        assert_eq!(bar(f64::NAN), "");
    }
}
