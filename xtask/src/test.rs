//! Every check and test, stage by stage.

use std::time::Instant;

use crate::run::{cargo, run};
use crate::{archives, browser, setup, web};

type Stage = (&'static str, fn() -> Result<(), String>);

/// Where proptest reads its seed.
const SEED: &str = "PROPTEST_RNG_SEED";

const STAGES: [Stage; 9] = [
    ("set-up", setup::setup),
    ("formatting", || run("cargo", &["fmt", "--all", "--check"])),
    ("lints", || {
        let lints = [
            "clippy",
            "--workspace",
            "--all-targets",
            "--",
            "-D",
            "warnings",
        ];
        cargo(&lints, None)
    }),
    ("documentation", || {
        let flags = ("RUSTDOCFLAGS", "-D warnings");
        cargo(&["doc", "--no-deps", "--workspace"], Some(flags))
    }),
    ("tests: core, command line, app", || {
        // The same random cases each time, so that a failure is of this change; `cargo test` by itself looks
        // for new ones.
        let seed = std::env::var_os(SEED).is_none().then_some((SEED, "1"));
        cargo(&["test", "--workspace", "--no-fail-fast"], seed)
    }),
    // It says what frames take, and fails for none: what else runs here is not known. In the tests' build, which is
    // there already, they take longer than in a release. Of the workspace, as one package would be built anew.
    ("frames while sliders are dragged", || {
        let bench = [
            "bench",
            "--profile",
            "dev",
            "--workspace",
            "--bench",
            "frames",
        ];
        cargo(&[&bench[..], &["--", "--short"]].concat(), None)
    }),
    ("web build", web::build),
    ("archives", archives::test),
    ("page in headless Chromium", browser::test),
];

/// Runs all stages; a failure does not keep the later ones from running.
pub fn test() -> Result<(), String> {
    let mut lines = Vec::new();
    let mut failed = 0;
    for (name, stage) in STAGES {
        println!("\n=== {name}");
        let started = Instant::now();
        let result = stage();
        let seconds = started.elapsed().as_secs();
        lines.push(match &result {
            Ok(()) => format!("ok      {name} ({seconds} s)"),
            Err(error) => {
                println!("{error}");
                format!("FAILED  {name} ({seconds} s): {error}")
            }
        });
        failed += usize::from(result.is_err());
    }
    println!("\n=== summary\n{}", lines.join("\n"));
    println!("{} passed, {failed} failed", STAGES.len() - failed);
    if failed == 0 {
        Ok(())
    } else {
        Err("not everything passed".to_owned())
    }
}
