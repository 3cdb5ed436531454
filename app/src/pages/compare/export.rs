//! Files that the page can give away.

use std::fmt::Write as _;

use hysteron_core::diagnosis::{Program, Step};
use hysteron_core::report::{self, Provenance, ReportInput, Tongue};
use hysteron_core::user_model::UserModel;

use super::state::Compare;
use crate::language::{Language, say, spoken};
use crate::save::Document;

/// Samples of an input that is saved, at most.
const MOST_SAMPLES: f64 = 2e6;

/// The model on screen as a report.
pub(super) fn report(page: &Compare) -> Option<Document> {
    let (measurement, last) = (page.measurement.as_ref()?, page.report()?);
    let shown = page.shown.as_deref().unwrap_or_default();
    let steps: Vec<Step> = (0..=shown.len())
        .filter_map(|n| Some(page.reports.get(&shown[..n])?.step.clone()))
        .collect();
    let first = page.reports.get(&[][..]);
    let text = report::html(&ReportInput {
        measurement,
        steps: &steps,
        first_atlas: first.map_or(&[], |r| r.atlas.as_slice()),
        last,
        verdict: last.verdict.as_ref(),
        discovery: page.discovery_on_the_way(),
        model: page.model.as_ref(),
        provenance: &Provenance {
            command: command(page, &measurement.name),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            bytes: page.source.bytes,
            sha256: page.source.sha256.clone(),
        },
        tongue: Tongue {
            code: spoken().code(),
            say: |text| say(text),
        },
    });
    Some(Document {
        name: format!("{}.html", stem(&measurement.name)),
        kind: "Web page",
        media: "text/html;charset=utf-8",
        text,
    })
}

/// What to type for the same diagnosis.
fn command(page: &Compare, file: &str) -> String {
    let mut command = format!("hysteron diagnose {}", report::shell_word(file));
    let model = page
        .model_file
        .iter()
        .map(|name| ("--model", name.as_str()));
    let own = page.own.iter().map(|line| ("--effect", line.as_str()));
    for (option, value) in page.reading.arguments().chain(model).chain(own) {
        command.extend([" ", option, " ", &report::shell_word(value)]);
    }
    if spoken() != Language::default() {
        command.extend([" --lang ", spoken().code()]);
    }
    command
}

/// The model on screen as a file.
pub(super) fn model(page: &Compare) -> Option<Document> {
    let (measurement, last) = (page.measurement.as_ref()?, page.report()?);
    let model = UserModel::from_step(measurement.kind, &last.step, page.model.as_ref());
    Some(Document {
        name: format!("{}.toml", stem(&measurement.name)),
        kind: "Model",
        media: "application/toml;charset=utf-8",
        text: model.to_toml(),
    })
}

/// The input of a proposed experiment, sample by sample; `None` where it follows from what is measured.
pub(super) fn input(page: &Compare, index: usize) -> Option<Document> {
    let measurement = page.measurement.as_ref()?;
    let proposal = page.proposals().nth(index)?;
    let samples = (proposal.duration / proposal.step).min(MOST_SAMPLES) as usize;
    let open = !matches!(proposal.program, Program::Relay { .. });
    open.then(|| {
        let mut controller = proposal.program.controller();
        let mut text = format!("t [s],u [{}]\n", proposal.input_unit);
        for i in 0..samples {
            let time = i as f64 * proposal.step;
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{time:?},{:?}", controller.command(time, 0.0));
        }
        Document {
            name: format!("{}-next-input.csv", stem(&measurement.name)),
            kind: "Input",
            media: "text/csv;charset=utf-8",
            text,
        }
    })
}

/// The name of a file without its ending.
fn stem(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}
