//! Browsers that cannot run the page: it says what they lack, and what to do.

use std::path::Path;
use std::time::{Duration, Instant};

use super::PATIENCE;
use super::driver::Session;

/// What is taken from the browser, and what the page then says; each also lacks what those before it lack.
const LACKING: [(&str, &str); 2] = [
    (
        "HTMLCanvasElement.prototype.getContext = () => null;",
        "WebGL 2",
    ),
    ("delete window.WebAssembly;", "WebAssembly"),
];

/// In a browser of its own, whose errors are meant.
pub fn journey(profile: &Path, page: &str) -> Result<(), String> {
    let session = Session::start(profile)?;
    for (taken, word) in LACKING {
        session.before_every_page(taken)?;
        session.open("about:blank")?;
        session.open(page)?;
        let started = Instant::now();
        loop {
            let said = session
                .script("return document.getElementById('hysteron-error')?.textContent || ''")?;
            let said = said.as_str().unwrap_or_default();
            if said.contains(word) && said.contains("Firefox") {
                println!("a page that cannot start says: {said}");
                break;
            }
            if started.elapsed() > PATIENCE {
                return Err(format!("without {word} the page says: {said}"));
            }
            std::thread::sleep(Duration::from_millis(200));
        }
    }
    Ok(())
}
