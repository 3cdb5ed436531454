//! Pieces of a page: escaped text, tables, the style.

use std::fmt::Write as _;

use super::escape::escape;
use super::input::Tongue;
use super::math::math;
use crate::message::Message;

impl Tongue {
    /// A text in this language, as text of a page.
    pub(super) fn page(self, text: impl Into<Message>) -> String {
        escape(&(self.say)(&text.into()))
    }
}

/// A cell of a table: escaped text in the report's language, to the right if it is a number; formulas are typeset.
pub(super) enum Cell {
    Text(Message),
    Number(Message),
    /// A symbol or a formula, typeset.
    Math(String),
}

/// A table; every text is put into the report's language and escaped here.
pub(super) fn table(out: &mut String, tongue: Tongue, head: &[&'static str], rows: &[Vec<Cell>]) {
    out.push_str("<div class=\"wide\"><table><thead><tr>");
    for title in head {
        let _ = write!(out, "<th>{}</th>", tongue.page(title));
    }
    out.push_str("</tr></thead><tbody>\n");
    for row in rows {
        out.push_str("<tr>");
        for cell in row {
            let _ = match cell {
                Cell::Text(text) => write!(out, "<td>{}</td>", tongue.page(text)),
                Cell::Number(text) => {
                    write!(out, "<td class=\"n\">{}</td>", tongue.page(text))
                }
                Cell::Math(text) => write!(out, "<td>{}</td>", math(text)),
            };
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody></table></div>\n");
}

/// A section with its heading.
pub(super) fn section(out: &mut String, tongue: Tongue, title: &'static str, body: &str) {
    let _ = write!(
        out,
        "<section>\n<h2>{}</h2>\n{body}</section>\n",
        tongue.page(title)
    );
}

/// A picture with a caption, which is put into the report's language and escaped here.
pub(super) fn figure(out: &mut String, tongue: Tongue, svg: &str, caption: impl Into<Message>) {
    let _ = writeln!(
        out,
        "<figure>{svg}<figcaption>{}</figcaption></figure>",
        tongue.page(caption)
    );
}

/// Names of curves with their colours.
pub(super) fn legend(out: &mut String, tongue: Tongue, entries: &[(&str, &'static str)]) {
    out.push_str("<p class=\"legend\">");
    for (class, name) in entries {
        let _ = write!(
            out,
            "<span><svg viewBox=\"0 0 24 10\" width=\"24\" height=\"10\" aria-hidden=\"true\"><path \
             class=\"{class}\" d=\"M1 5H23\"/></svg> {}</span> ",
            tongue.page(name)
        );
    }
    out.push_str("</p>\n");
}

/// Light and dark, screen and paper. The colours are Okabe and Ito's, the same as in the app.
pub(super) const STYLE: &str = r#"
:root { color-scheme: light dark; --ground: #fff; --text: #16181b; --faint: #5b626b; --line: #c9ced5; --panel: #f4f6f8;
  --measured: #2f8fc4; --model: #d55e00; --residual: #b3578c; --noise: #00805d; --band: #e69f00; }
@media (prefers-color-scheme: dark) { :root { --ground: #16181b; --text: #e4e6e9; --faint: #9aa2ab; --line: #3b414a; --panel: #1f2328;
  --measured: #56b4e9; --model: #f0772a; --residual: #cc79a7; --noise: #1fc295; --band: #e69f00; } }
@media print { :root { --ground: #fff; --text: #000; --faint: #444; --line: #bbb; --panel: #fff;
  --measured: #2f8fc4; --model: #d55e00; --residual: #b3578c; --noise: #00805d; } main { max-width: none !important; padding: 0 !important; }
  figure, tr, pre, .answer { break-inside: avoid; } h2, h3 { break-after: avoid; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--text); font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; }
main { max-width: 960px; margin: 0 auto; padding: 2rem 1.25rem 4rem; }
h1 { font-size: 1.15rem; font-weight: 500; color: var(--faint); margin: 0 0 .5rem; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 2.5rem 0 .75rem; padding-top: .75rem; border-top: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 1.5rem 0 .25rem; }
p { margin: .4rem 0; overflow-wrap: anywhere; }
.answer { font-size: 1.55rem; line-height: 1.35; font-weight: 600; margin: 0 0 1rem; }
.facts, figcaption, .small { color: var(--faint); font-size: .9rem; }
.next { border-left: 4px solid var(--band); padding: .25rem 0 .25rem .75rem; }
figure { margin: .75rem 0; } figure > svg { width: 100%; height: auto; display: block; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); gap: 0 1.25rem; }
.legend span { margin-right: 1rem; font-size: .9rem; white-space: nowrap; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: .92rem; margin: .5rem 0; }
th, td { text-align: left; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
code { font: .88em/1.5 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; overflow-wrap: anywhere; }
.equations { background: var(--panel); border: 1px solid var(--line); padding: .25rem .75rem; overflow-x: auto; }
math { font-size: 1.1em; }
pre { background: var(--panel); border: 1px solid var(--line); padding: .75rem; overflow-x: auto; white-space: pre-wrap; }
svg text { fill: var(--text); font: 12px system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif; } svg text.faint { fill: var(--faint); }
svg .grid { stroke: var(--line); stroke-width: .6; } svg .frame { stroke: var(--faint); stroke-width: 1; fill: none; }
svg path { fill: none; stroke-linejoin: round; } svg .measured { stroke: var(--measured); stroke-width: 2.6; }
svg .model { stroke: var(--model); stroke-width: 1.5; stroke-dasharray: 6 3; } svg .residual { stroke: var(--residual); stroke-width: 1.3; }
svg .before { stroke: var(--model); stroke-width: 1.6; stroke-dasharray: 2 3; } svg .noise { stroke: var(--noise); stroke-width: 1.3; stroke-dasharray: 5 4; }
svg .estimate { stroke: var(--residual); stroke-width: 2; } svg path.diamond { fill: var(--measured); } svg .band { fill: var(--residual); opacity: .25; stroke: none; }
svg rect.bar { fill: var(--model); } svg rect.floor { fill: var(--noise); } svg rect.shade { fill: var(--band); opacity: .18; }
"#;
