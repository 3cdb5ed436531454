//! A file of the user's own is dropped on the page, which says what is missing from its model.

use serde_json::{Value, json};

use super::driver::Session;
use super::{same, wait};
use crate::run::root;

/// A measurement that does not come with the page, and how the verdict on it begins.
const FILE: &str = "tests/data/process-01.csv";
const VERDICT: &str = "Nothing is missing: what the model leaves is measurement noise.";

/// The name that it has on the user's machine.
const NAME: &str = "my own process.csv";

/// Drops the file as a hand does that drags it over the page.
const DROP: &str = "
    const data = new DataTransfer();
    data.items.add(new File([text], name, {type: 'text/csv'}));
    const canvas = document.querySelector('canvas');
    for (const kind of ['dragover', 'drop']) {
        const event = new DragEvent(kind, {dataTransfer: data, bubbles: true, cancelable: true});
        canvas.dispatchEvent(event);
    }
";

/// Opens *Compare* without a measurement, and drops one.
pub fn journey(session: &Session, page: &str) -> Result<(), String> {
    session.open("about:blank")?;
    session.open(&format!("{page}#v1;compare"))?;
    wait(session, "the page to drop a file on", |s| {
        s["page"] == "compare" && s["targets"]["builtin:drive-02"].is_array()
    })?;
    let text = std::fs::read_to_string(root().join(FILE)).map_err(|e| e.to_string())?;
    let (name, text) = (json!(NAME), json!(text));
    session.script(&format!("const name = {name}; const text = {text}; {DROP}"))?;
    let shown = wait(session, "the verdict on a dropped file", |s| {
        s["busy"] == false && s["verdict"].is_string()
    })?;
    said(&shown, "file", |said| said == NAME, NAME)?;
    said(&shown, "verdict", |said| said.starts_with(VERDICT), VERDICT)?;
    same::check(&shown, FILE)?;
    println!("{NAME} was dropped: {VERDICT}");
    Ok(())
}

/// Whether what the page says is right, or else what was expected.
fn said(
    shown: &Value,
    key: &str,
    is_right: impl Fn(&str) -> bool,
    expected: &str,
) -> Result<(), String> {
    if shown[key].as_str().is_some_and(is_right) {
        return Ok(());
    }
    Err(format!(
        "the {key} of a dropped file is {}, not {expected}",
        shown[key]
    ))
}
