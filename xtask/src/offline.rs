//! The service worker that keeps the page for visits without a network.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

const SOURCE: &str = include_str!("service-worker.js");

/// Writes `service-worker.js` into `dist`; it names the files that stand there, and their version.
pub fn write(dist: &Path) -> Result<(), String> {
    let fail = |path: &Path, e: std::io::Error| format!("{}: {e}", path.display());
    let entries = fs::read_dir(dist).map_err(|e| fail(dist, e))?;
    let mut names: Vec<String> = entries
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let mut hasher = DefaultHasher::new();
    for name in &names {
        let path = dist.join(name);
        let bytes = fs::read(&path).map_err(|e| fail(&path, e))?;
        (name, bytes).hash(&mut hasher);
    }
    // The page is asked for by its folder too.
    names.insert(0, "./".to_owned());
    let list = serde_json::to_string(&names).map_err(|e| e.to_string())?;
    let script = SOURCE
        .replace("VERSION", &format!("{:016x}", hasher.finish()))
        .replace("FILE_LIST", &list);
    let path = dist.join("service-worker.js");
    fs::write(&path, script).map_err(|e| fail(&path, e))
}
