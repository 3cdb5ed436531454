//! The app's program without a window: its command line, and what it does where there is no display.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn hysteron(arguments: &[&Path]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron"));
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command.args(arguments).output().expect("it starts")
}

fn drive_02() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/drive-02.csv")
}

/// A file of this test alone that is empty.
fn empty() -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("none.csv");
    std::fs::write(&path, b"").expect("a file");
    path
}

#[test]
fn it_has_the_commands_of_the_command_line() {
    let output = hysteron(&[Path::new("diagnose"), &drive_02()]);
    let shown = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && output.stderr.is_empty());
    assert!(shown.contains("Missing: Coulomb friction"), "{shown}");
}

#[test]
fn what_is_no_file_and_no_command_is_one_line_and_code_2() {
    for name in ["frobnicate", "no-such-file.csv"] {
        let output = hysteron(&[Path::new(name)]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(output.stdout.is_empty() && said.lines().count() == 1);
        let line =
            format!("hysteron: {name}: there is no such file or command; see hysteron --help");
        assert_eq!(said.trim_end(), line);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_a_file_is_diagnosed() {
    let (good, bad) = (drive_02(), empty());
    let output = hysteron(&[&good, &bad]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("no display"), "{said}");
    let shown = String::from_utf8_lossy(&output.stdout);
    assert!(shown.contains("Missing: Coulomb friction"), "{shown}");
    let output = hysteron(&[&bad]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("none.csv"), "{said}");
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_it_says_so_and_shows_a_diagnosis() {
    let output = hysteron(&[]);
    let (said, shown) = (
        String::from_utf8_lossy(&output.stderr),
        String::from_utf8_lossy(&output.stdout),
    );
    assert!(output.status.success(), "{said}");
    assert!(
        said.lines().count() == 1 && said.contains("no display"),
        "{said}"
    );
    assert!(shown.contains("Missing: Coulomb friction"), "{shown}");
}
