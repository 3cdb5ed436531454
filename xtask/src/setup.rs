//! Installs what the tests need on Debian or Ubuntu, or says what to install.

use std::process::Command;

use crate::run::{check, exists, output, root};

/// Free disk that building and testing takes the first time, GB: 4.7 were measured.
const DISK: f64 = 6.0;

/// Debian packages, and a file or program that shows that each is there.
const PACKAGES: [(&str, &str); 7] = [
    ("chromium", "/usr/bin/chromium"),
    ("chromium-driver", "/usr/bin/chromedriver"),
    ("mesa-vulkan-drivers", ""),
    ("libgl1-mesa-dri", ""),
    ("libegl1", ""),
    ("libxkbcommon-x11-0", ""),
    ("libx11-xcb1", ""),
];

/// Installs what is missing.
pub fn setup() -> Result<(), String> {
    if let Some(free) = free_disk().filter(|free| *free < DISK)
        && !root().join("target/wasm").exists()
    {
        let folder = root().display().to_string();
        return Err(format!(
            "the build needs {DISK} GB of disk, but {free:.1} GB are free at {folder}: make room first"
        ));
    }
    let missing: Vec<&str> = PACKAGES
        .iter()
        .filter(|p| !installed(p.0, p.1))
        .map(|p| p.0)
        .collect();
    if missing.is_empty() {
        println!("Everything that the tests need is installed.");
        return Ok(());
    }
    let list = missing.join(" ");
    let by_hand = format!("install these first: apt-get update && apt-get install --yes {list}");
    if !exists("apt-get") {
        return Err(format!(
            "this system has no apt-get; install what corresponds to: {list}"
        ));
    }
    let root = output("id", &["-u"]).is_some_and(|id| id == "0");
    let sudo = !root && output("sudo", &["-n", "true"]).is_some();
    if !root && !sudo {
        return Err(by_hand);
    }
    let apt = |arguments: &[&str]| {
        let mut command = if root {
            Command::new("apt-get")
        } else {
            Command::new("sudo")
        };
        if !root {
            command.args(["-n", "apt-get"]);
        }
        command
            .env("DEBIAN_FRONTEND", "noninteractive")
            .args(arguments);
        check(&mut command, "apt-get", arguments)
    };
    let mut install = vec!["install", "--yes", "--no-install-recommends"];
    install.extend(&missing);
    apt(&["update"])
        .and_then(|()| apt(&install))
        .map_err(|e| format!("{e}; {by_hand}"))
}

/// GB that are free where the project is, if the system says so.
fn free_disk() -> Option<f64> {
    let folder = root().display().to_string();
    let told = output("df", &["-Pk", &folder])?;
    let free = told.lines().nth(1)?.split_whitespace().nth(3)?;
    free.parse().ok().map(|kilobytes: f64| kilobytes / 1e6)
}

fn installed(package: &str, file: &str) -> bool {
    (!file.is_empty() && std::path::Path::new(file).exists())
        || output("dpkg-query", &["-W", "-f=${Status}", package])
            .is_some_and(|s| s.contains("install ok installed"))
}
