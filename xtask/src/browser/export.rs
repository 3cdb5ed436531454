//! A page is saved as a picture and as numbers, and arrives as files.

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::json;

use super::driver::Session;
use super::{click, wait};

/// What is asked for in the menu, how the file ends, and how it begins.
const FILES: [(&str, &str, &[u8]); 3] = [
    ("svg", "svg", b"<svg xmlns="),
    ("png", "png", b"\x89PNG\r\n\x1a\n"),
    ("time series", "csv", b"time [s],output y"),
];

/// Times that a file is asked for, and how long it may take.
const TRIES: usize = 4;
const ARRIVAL: Duration = Duration::from_secs(20);

/// Saves *Explore* in every form.
pub fn journey(session: &Session, folder: &Path, page: &str) -> Result<(), String> {
    let _ = std::fs::remove_dir_all(folder);
    std::fs::create_dir_all(folder).map_err(|e| e.to_string())?;
    let place = json!({"behavior": "allow", "downloadPath": folder.display().to_string()});
    session.devtools("Browser.setDownloadBehavior", &place)?;
    session.open("about:blank")?;
    session.open(&format!("{page}#v1;explore;explore.paused=20"))?;
    wait(session, "the page to save", |s| {
        s["page"] == "explore" && s["targets"]["export"].is_array()
    })?;
    for (item, ending, begin) in FILES {
        let bytes = saved(session, folder, item, ending)?;
        if !bytes.starts_with(begin) {
            return Err(format!("the {ending} file begins otherwise"));
        }
        println!("exported: {ending}, {} bytes", bytes.len());
    }
    Ok(())
}

/// Asks for a file in the menu. On a machine that is busy the menu may still move when it is clicked: then it is asked
/// once more.
fn saved(session: &Session, folder: &Path, item: &str, ending: &str) -> Result<Vec<u8>, String> {
    let mut missed = String::new();
    for _ in 0..TRIES {
        click(session, "export")?;
        std::thread::sleep(Duration::from_secs(1));
        click(session, &format!("export:{item}"))?;
        match arrived(folder, ending) {
            Ok(bytes) => return Ok(bytes),
            Err(error) => missed = error,
        }
    }
    Err(format!(
        "{missed}; the page says {}",
        session.state()?["notice"]
    ))
}

/// The file with this ending, once it is whole.
fn arrived(folder: &Path, ending: &str) -> Result<Vec<u8>, String> {
    let started = Instant::now();
    while started.elapsed() < ARRIVAL {
        std::thread::sleep(Duration::from_millis(200));
        let files = std::fs::read_dir(folder).map_err(|e| e.to_string())?;
        let mut paths = files.flatten().map(|f| f.path());
        let found = paths.find(|p| p.extension().is_some_and(|e| e == ending));
        let bytes = found.and_then(|p| std::fs::read(p).ok());
        if let Some(bytes) = bytes.filter(|b| !b.is_empty()) {
            return Ok(bytes);
        }
    }
    Err(format!("no {ending} file has arrived"))
}
