//! Whether the archives hold all that is needed: packed with the program of the tests, unpacked and used.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::release;
use crate::run::{PROGRAM, check, root, run};

/// A measurement that every native archive has.
const MEASUREMENT: &str = "assets/measurements/process-02.csv";

/// Packs what the stages before have built, unpacks it elsewhere, and uses it.
pub fn test() -> Result<(), String> {
    let folder = root().join("target/archives-test");
    let archives = release::archives(&root().join("target/debug"), &folder.join("packed"))?;
    let [native, page] = archives.map(|archive| unpack(&archive, &folder));
    let (native, page) = (native?, page?);
    let mut diagnose = Command::new(native.join(PROGRAM));
    diagnose
        .args(["diagnose", MEASUREMENT])
        .stdout(Stdio::null());
    check(
        diagnose.current_dir(&native),
        "the unpacked program",
        &["diagnose", MEASUREMENT],
    )?;
    links(&native, &native)?;
    links(&native, &native.join("docs"))?;
    kept(&page)?;
    println!("both archives are complete");
    fs::remove_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))
}

/// Unpacks an archive beside its folder; the folder that is in it.
fn unpack(archive: &Path, folder: &Path) -> Result<PathBuf, String> {
    let [path, place] = [archive, folder].map(|p| p.to_string_lossy().into_owned());
    run("tar", &["-xzf", &path, "-C", &place])?;
    let name = archive
        .file_name()
        .map(|n| n.to_string_lossy().into_owned());
    let name = name.unwrap_or_default();
    Ok(folder.join(name.trim_end_matches(".tar.gz")))
}

/// Checks that what the manual in a folder points to is there.
fn links(top: &Path, folder: &Path) -> Result<(), String> {
    let fail = |e: std::io::Error| format!("{}: {e}", folder.display());
    for entry in fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        if path.extension().is_none_or(|e| e != "md") {
            continue;
        }
        let text = fs::read_to_string(&path).map_err(fail)?;
        let ends = text
            .split("](")
            .skip(1)
            .filter_map(|rest| rest.split(')').next());
        for end in ends.filter(|end| !end.starts_with("http") && !end.starts_with('#')) {
            if !folder.join(end).exists() {
                let page = path.strip_prefix(top).unwrap_or(&path).display();
                return Err(format!(
                    "{page} points to {end}, which is not in the archive"
                ));
            }
        }
    }
    Ok(())
}

/// Checks that the page has every file that it keeps for visits without a network.
fn kept(page: &Path) -> Result<(), String> {
    let script = page.join("service-worker.js");
    let text = fs::read_to_string(&script).map_err(|e| format!("{}: {e}", script.display()))?;
    let list = text
        .lines()
        .find_map(|line| line.strip_prefix("const FILES = "));
    let list = list
        .ok_or("the service worker names no files")?
        .trim_end_matches(';');
    let names: Vec<String> = serde_json::from_str(list).map_err(|e| e.to_string())?;
    for name in names {
        if !page.join(&name).exists() {
            return Err(format!("{name} is not in the archive of the page"));
        }
    }
    Ok(())
}
