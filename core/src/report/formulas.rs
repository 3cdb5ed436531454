//! The formula of what no effect explains.

use std::fmt::Write as _;

use super::escape::escape;
use super::html::{Cell, figure, legend, table};
use super::input::{Tongue, shell_word};
use super::math::sentence;
use super::model::experiments;
use super::svg::{Axis, Chart, Mark, range};
use crate::diagnosis::{Discovery, FoundFormula};
use crate::message::Message;
use crate::msg;
use crate::uncertain::{brief, with_error};

/// Size of the picture.
const WIDE: f64 = 920.0;
const TALL: f64 = 230.0;

/// What was found, and what it was chosen from.
pub(super) fn section(tongue: Tongue, discovery: &Discovery) -> String {
    let known: Vec<&str> = discovery
        .formulas
        .iter()
        .map(|f| f.formula.as_str())
        .collect();
    let said = sentence(&(tongue.say)(&discovery.text), &known);
    let mut out = format!("<p>{said}</p>\n");
    if discovery.formulas.is_empty() {
        return out;
    }
    let fronts: Vec<&FoundFormula> = discovery.front().collect();
    let alone = discovery.class().count() < 2;
    let class = if alone {
        "the answer"
    } else {
        "this record cannot tell them apart"
    };
    legend(
        &mut out,
        tongue,
        &[
            ("model", "least error for its length"),
            ("measured", class),
            ("estimate", "tried"),
            ("noise", "noise"),
        ],
    );
    figure(
        &mut out,
        tongue,
        &picture(tongue, discovery, &fronts),
        "Every formula that was simulated: its length in names, numbers and signs, and its error on parts of the \
         record that it was not fitted to, in units of the noise.",
    );
    let others = fronts.into_iter().filter(|f| !f.in_class);
    let rows: Vec<Vec<Cell>> = discovery
        .class()
        .chain(others)
        .map(|formula| row(formula, class))
        .collect();
    table(
        &mut out,
        tongue,
        &["Formula", "Length", "Error (× noise)", "Parameters", ""],
        &rows,
    );
    if let Some(experiment) = &discovery.experiment {
        let _ = writeln!(
            out,
            "<p class=\"next\"><strong>{}</strong> {}</p>",
            tongue.page("What would tell them apart:"),
            tongue.page(&experiment.text)
        );
        out.push_str(&experiments(tongue, experiment));
    }
    if let Some(found) = discovery.found() {
        let _ = writeln!(
            out,
            "<p class=\"small\">{}</p>\n<pre><code>--effect {}</code></pre>",
            tongue.page("The same formula again:"),
            escape(&shell_word(&found.typed))
        );
    }
    out
}

/// A formula as a row of the table, and what is said of those that this record cannot tell from the answer.
fn row(formula: &FoundFormula, class: &'static str) -> Vec<Cell> {
    let parameters = formula.parameters.iter().map(|p| {
        let (name, value) = (
            Message::name(&p.name),
            with_error(p.value, p.std_error, &p.unit),
        );
        if p.is_told() && p.std_error > 0.0 {
            msg!("{} = {} (95 %: {})", name, value, p.interval())
        } else {
            msg!("{} = {}", name, value)
        }
    });
    let parameters = Message::list("; ", parameters);
    let class = if formula.in_class { class } else { "" };
    vec![
        Cell::Math(formula.formula.clone()),
        Cell::Number(formula.length.into()),
        Cell::Number(brief(formula.error).into()),
        Cell::Text(parameters),
        Cell::Text(class.into()),
    ]
}

/// Error against length, and the front.
fn picture(tongue: Tongue, discovery: &Discovery, front: &[&FoundFormula]) -> String {
    let at = |f: &FoundFormula| [f.length as f64, f.error];
    let mut line = vec![[0.0, discovery.before]];
    line.extend(front.iter().map(|f| at(f)));
    let all: Vec<[f64; 2]> = discovery.formulas.iter().map(at).collect();
    let class: Vec<[f64; 2]> = discovery.class().map(at).collect();
    let ends = |k: usize| range(all.iter().chain(&line).map(|p| p[k]));
    let lengths = ends(0).unwrap_or((0.0, 1.0));
    let errors = range(
        [1.0]
            .into_iter()
            .chain(all.iter().chain(&line).map(|p| p[1])),
    );
    let mut chart = Chart::new(
        tongue,
        WIDE,
        TALL,
        Axis::new("length of the formula", "1", (0.0, lengths.1 + 1.0)),
        Axis::sized("error / noise", "1", errors.unwrap_or((0.0, 1.0))),
    );
    chart.level(1.0, "noise");
    chart.line(&line, "model");
    chart.points(&all, Mark::Ring);
    chart.points(&class, Mark::Diamond);
    chart.finish("Error of the formulas against their length")
}
