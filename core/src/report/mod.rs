//! A diagnosis as one self-contained page: text, tables and pictures (SVG), without scripts or requests.
//!
//! The page is made from finished data alone, so that the command line, the app and a batch write the
//! same one. Everything that comes from a file is escaped.

mod escape;
mod formulas;
mod html;
mod input;
mod math;
mod model;
mod pictures;
mod sha256;
mod svg;

use std::fmt::Write as _;

use crate::diagnosis::ChannelNoise;
use crate::measurement::Kind;
use crate::message::Message;
use crate::msg;
use crate::uncertain::brief;
use crate::user_model::UserModel;
use escape::escape;
use html::{figure, legend, section};
pub use input::{Provenance, ReportInput, Tongue, shell_word};
pub use model::baseline;
pub use sha256::sha256;

/// The report as an HTML page.
pub fn html(input: &ReportInput) -> String {
    let name = escape(&input.measurement.name);
    let tongue = input.tongue;
    let mut out = format!(
        "<!doctype html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"generator\" content=\"Hysteron {}\">\n<title>{name} - Hysteron</title>\n\
         <style>{}</style>\n</head>\n<body>\n<main>\n",
        escape(tongue.code),
        escape(&input.provenance.version),
        html::STYLE
    );
    answer(&mut out, input);
    section(
        &mut out,
        tongue,
        "How the error fell",
        &pictures::waterfall(tongue, input.steps, input.last.noise_floor),
    );
    section(&mut out, tongue, "Measured and modelled", &curves(input));
    section(&mut out, tongue, "Where the models fail", &places(input));
    if !input.last.missing.is_empty() {
        section(&mut out, tongue, "What is missing", &missing(input));
    }
    if let Some(discovery) = input.discovery {
        section(
            &mut out,
            tongue,
            "The formula of the unknown",
            &formulas::section(tongue, discovery),
        );
    }
    section(&mut out, tongue, "The model", &model::equations(input));
    section(
        &mut out,
        tongue,
        "Parameters",
        &model::parameters(tongue, &input.last.step.parameters),
    );
    section(
        &mut out,
        tongue,
        "What else was tried",
        &model::candidates(tongue, input.steps),
    );
    section(&mut out, tongue, "How to reproduce this", &reproduce(input));
    out.push_str("</main>\n</body>\n</html>\n");
    out
}

/// The page's question and its answer.
fn answer(out: &mut String, input: &ReportInput) {
    let measurement = input.measurement;
    let step = &input.last.step;
    let present = input.model.map(UserModel::present).unwrap_or_default();
    let answer = input.last.answer(input.verdict, &present, false);
    let verdict = input.verdict.map(|v| v.text.clone()).unwrap_or_default();
    let duration = match (measurement.time.first(), measurement.time.last()) {
        (Some(first), Some(last)) => last - first,
        _ => 0.0,
    };
    let tongue = input.tongue;
    let title = msg!(
        "What is missing from the model of {}?",
        Message::name(&measurement.name)
    );
    let (samples, duration) = (measurement.len(), brief(duration));
    let facts = match measurement.kind {
        Kind::Drive => msg!("{} samples of a drive over {} s.", samples, duration),
        Kind::Process => msg!("{} samples of a process over {} s.", samples, duration),
    };
    let facts = facts.and(msg!(
        "Error of the model on the part of the record that it was not fitted to: {} × the measurement noise; a \
         perfect model would leave {}.",
        brief(step.error),
        brief(input.last.noise_floor)
    ));
    let _ = write!(
        out,
        "<header>\n<h1>{}</h1>\n<p class=\"answer\">{}</p>\n<p>{}</p>\n<p class=\"facts\">{}</p>\n",
        tongue.page(title),
        tongue.page(answer),
        tongue.page(verdict),
        tongue.page(facts),
    );
    let missed = (input.last.step.left > 0.0).then(|| {
        msg!(
            "{} % of the motion is not explained.",
            brief(100.0 * input.last.step.left)
        )
    });
    let noise = input.last.noise.iter().map(ChannelNoise::words);
    for fact in missed.into_iter().chain(noise) {
        let _ = writeln!(out, "<p class=\"facts\">{}</p>", tongue.page(fact));
    }
    if let Some(next) = input.verdict.and_then(|v| v.next_experiment.as_ref()) {
        let _ = writeln!(
            out,
            "<p class=\"next\"><strong>{}:</strong> {}</p>",
            tongue.page("Next experiment"),
            tongue.page(next)
        );
    }
    for proposal in input.verdict.iter().flat_map(|v| &v.experiments) {
        out.push_str(&model::experiments(tongue, proposal));
    }
    for note in &measurement.warnings {
        let _ = writeln!(out, "<p class=\"small\">{}</p>", tongue.page(note));
    }
    out.push_str("</header>\n");
}

fn curves(input: &ReportInput) -> String {
    let mut out = String::new();
    legend(
        &mut out,
        input.tongue,
        &[
            ("measured", "measured"),
            ("model", "model"),
            ("residual", "measured minus model"),
            ("noise", "twice the noise"),
        ],
    );
    for (index, channel) in input.last.replay.channels.iter().enumerate() {
        let Some(output) = input.measurement.outputs.get(index) else {
            continue;
        };
        pictures::output(
            &mut out,
            input.tongue,
            &input.measurement.time,
            output,
            channel,
            &input.last.step.findings,
        );
    }
    let windows = "The model is driven by the measured input. In each short window it starts afresh from an estimated \
                   state, so that small errors do not add up.";
    let _ = writeln!(out, "<p class=\"small\">{}</p>", input.tongue.page(windows));
    out
}

/// Sentences and pictures: where the baseline failed and the last model does.
fn places(input: &ReportInput) -> String {
    let mut out = String::new();
    let tongue = input.tongue;
    let (first, last) = (input.steps.first(), &input.last.step);
    let more = input.steps.len() > 1;
    for (title, step) in [("The baseline", first), ("The last model", Some(last))] {
        let Some(step) = step.filter(|_| more || title == "The last model") else {
            continue;
        };
        let _ = writeln!(out, "<h3>{}</h3>", tongue.page(title));
        if step.findings.is_empty() {
            let noise = tongue.page("What it leaves is measurement noise everywhere.");
            let _ = writeln!(out, "<p>{noise}</p>");
            continue;
        }
        out.push_str("<ul>\n");
        for finding in &step.findings {
            let _ = writeln!(out, "<li>{}</li>", tongue.page(&finding.text));
        }
        out.push_str("</ul>\n");
    }
    let wanted: Vec<&str> = last
        .findings
        .iter()
        .chain(first.into_iter().flat_map(|s| &s.findings))
        .map(|f| f.axis.as_str())
        .collect();
    let first_atlas = if more { input.first_atlas } else { &[] };
    let charts = pictures::profiles(
        tongue,
        input.measurement,
        &wanted,
        first_atlas,
        &input.last.atlas,
    );
    if !charts.is_empty() {
        let mut entries = vec![("residual", "last model"), ("noise", "noise")];
        if more {
            entries.insert(0, ("before", "baseline"));
        }
        legend(&mut out, tongue, &entries);
        out.push_str("<div class=\"pair\">\n");
        for (svg, caption) in charts {
            figure(&mut out, tongue, &svg, caption);
        }
        out.push_str("</div>\n");
    }
    out
}

/// What no effect of the library explains.
fn missing(input: &ReportInput) -> String {
    let tongue = input.tongue;
    let mut out = format!(
        "<p>{}</p>\n<div class=\"pair\">\n",
        tongue.page(
            "No effect in the library explains the rest. These are forces, inputs or sensor errors that would, \
             estimated without a model: in steps along one axis at a time, with a band of two standard errors."
        )
    );
    for (svg, caption) in pictures::missing(tongue, &input.last.missing) {
        figure(&mut out, tongue, &svg, caption);
    }
    out.push_str("</div>\n");
    out
}

/// The command, the version, the file, and the model that the user brought.
fn reproduce(input: &ReportInput) -> String {
    let Provenance {
        command,
        version,
        bytes,
        sha256,
    } = input.provenance;
    let tongue = input.tongue;
    let made = msg!("Hysteron {}.", Message::name(version))
        .and("The same file gives the same answer, on any machine.");
    let name = Message::name(&input.measurement.name);
    let file = msg!("File: {}, {} bytes, SHA-256", name, *bytes);
    let mut out = format!(
        "<pre><code>{}</code></pre>\n<p>{}</p>\n<p>{} <code>{}</code></p>\n",
        escape(command),
        tongue.page(made),
        tongue.page(file),
        escape(sha256),
    );
    if let Some(model) = input.model {
        let lines: Vec<String> = model.to_toml().lines().map(escape).collect();
        let _ = writeln!(
            out,
            "<p>{}</p>\n<pre><code>{}</code></pre>",
            tongue.page("The model that it began with:"),
            lines.join("\n")
        );
    }
    out
}
