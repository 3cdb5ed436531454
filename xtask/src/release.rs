//! What is given out: the native program and the page, one archive each.

use std::env::consts::{ARCH, OS};
use std::fs;
use std::path::{Path, PathBuf};

use crate::run::{PROGRAM, root, run};
use crate::web;

/// What stands beside the program: what its manual speaks of.
const BESIDE: [&str; 8] = [
    "README.md",
    "ARCHITECTURE.md",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "docs",
    "assets/measurements",
    "assets/scenarios",
    "assets/screenshots",
];

/// What stands beside the page.
const BESIDE_PAGE: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

/// Builds both and packs them into `target/archives`.
pub fn build() -> Result<(), String> {
    let package = [
        "build",
        "--release",
        "--package",
        "hysteron",
        "--bin",
        "hysteron",
    ];
    run("cargo", &package)?;
    web::build()?;
    let profile = root().join("target/release");
    for archive in archives(&profile, &root().join("target/archives"))? {
        let size = fs::metadata(&archive).map_err(|e| format!("{}: {e}", archive.display()))?;
        println!("{}: {} bytes", archive.display(), size.len());
    }
    Ok(())
}

/// Packs the program that stands in `profile`, and the page, into `folder`, which is emptied; the native archive
/// comes first.
pub fn archives(profile: &Path, folder: &Path) -> Result<[PathBuf; 2], String> {
    let _ = fs::remove_dir_all(folder);
    let version = env!("CARGO_PKG_VERSION");
    let native = folder.join(format!("hysteron-{version}-{OS}-{ARCH}"));
    copy(&profile.join(PROGRAM), &native.join(PROGRAM))?;
    for name in BESIDE {
        copy(&root().join(name), &native.join(name))?;
    }
    let page = folder.join(format!("hysteron-{version}-web"));
    copy(&root().join("dist"), &page)?;
    for name in BESIDE_PAGE {
        copy(&root().join(name), &page.join(name))?;
    }
    Ok([pack(&native)?, pack(&page)?])
}

/// Packs a folder and takes it away; the archive that came of it.
fn pack(content: &Path) -> Result<PathBuf, String> {
    let (Some(folder), Some(name)) = (content.parent(), content.file_name()) else {
        return Err(format!("{} is no folder", content.display()));
    };
    let name = name.to_string_lossy();
    let archive = folder.join(format!("{name}.tar.gz"));
    let [path, place] = [archive.as_path(), folder].map(|p| p.to_string_lossy().into_owned());
    run("tar", &["-czf", &path, "-C", &place, &name])?;
    let fail = |e: std::io::Error| format!("{path}: {e}");
    fs::remove_dir_all(content).map_err(fail)?;
    Ok(archive)
}

/// Copies a file, or a folder with all that is in it.
fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let fail = |e: std::io::Error| format!("{}: {e}", from.display());
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(fail)?;
    }
    if !from.is_dir() {
        return fs::copy(from, to).map(|_| ()).map_err(fail);
    }
    let entries: Result<Vec<PathBuf>, _> = fs::read_dir(from)
        .map_err(fail)?
        .map(|e| e.map(|e| e.path()))
        .collect();
    for entry in entries.map_err(fail)? {
        if let Some(name) = entry.file_name() {
            copy(&entry, &to.join(name))?;
        }
    }
    Ok(())
}
