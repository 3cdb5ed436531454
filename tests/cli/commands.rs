//! The command line as a person and a script meet it: exit codes, one line per error, the contract.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use hysteron_cli::render;
use hysteron_core::diagnosis::{Diagnosis, Discovery};
use hysteron_core::rig::{DriveRig, Excitation, Stranger};

fn hysteron() -> Command {
    Command::new(env!("CARGO_BIN_EXE_hysteron-cli"))
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/data")
        .join(name)
}

/// Exit code 2, nothing on stdout, exactly one line on stderr that has all `parts`.
#[track_caller]
fn refused(output: &Output, parts: &[&str]) {
    let line = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line}");
    assert!(output.stdout.is_empty());
    assert!(
        line.ends_with('\n') && line.lines().count() == 1,
        "{line:?}"
    );
    for part in parts {
        assert!(line.contains(part), "expected '{part}' in: {line}");
    }
}

fn diagnose(file: &Path) -> Output {
    hysteron().arg("diagnose").arg(file).output().unwrap()
}

/// A file of this test alone.
fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn bad_input_is_one_line_and_code_2() {
    refused(
        &diagnose(Path::new("no-such-file.csv")),
        &["no-such-file.csv", "cannot be read"],
    );
    refused(&diagnose(&data("")), &["is a directory"]);
    refused(
        &diagnose(&written("empty.csv", b"")),
        &["empty.csv", "empty", "t [s]"],
    );
    refused(
        &diagnose(&written("binary.csv", &[0xff, 0xfe, 0x00])),
        &["binary.csv", "line 1", "UTF-8"],
    );
    let mut text = String::from("t [s],u [N m],v1 [rad/s]\n");
    for i in 0..30 {
        let _ = writeln!(text, "{i},1,{}", if i == 4 { "abc" } else { "2" });
    }
    refused(
        &diagnose(&written("abc.csv", text.as_bytes())),
        &["abc.csv, line 6, column 3 (v1): 'abc'"],
    );
    let constant = text.replace("abc", "3");
    refused(
        &diagnose(&written("constant.csv", constant.as_bytes())),
        &["constant.csv", "input is constant"],
    );
}

#[test]
fn wrong_arguments_are_one_line_and_code_2() {
    let run = |arguments: &[&str]| hysteron().args(arguments).output().unwrap();
    refused(&run(&["diagnose"]), &["FILE.csv", "--help"]);
    refused(
        &run(&["frobnicate"]),
        &["frobnicate", "hysteron-cli --help"],
    );
    refused(&run(&[]), &["diagnose", "hysteron-cli --help"]);
    refused(&run(&["diagnose", "a.csv", "--format", "xml"]), &["xml"]);
    refused(
        &run(&["diagnose", "a.csv", "--kind", "rocket"]),
        &["rocket"],
    );
}

#[cfg(unix)]
#[test]
fn a_path_that_is_not_text_is_no_panic() {
    use std::os::unix::ffi::OsStrExt as _;
    let path = Path::new(std::ffi::OsStr::from_bytes(b"rig\n\xff.csv"));
    refused(&diagnose(path), &["cannot be read"]);
}

#[test]
fn help_and_version_are_no_errors() {
    for argument in ["--help", "--version"] {
        let output = hysteron().arg(argument).output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty());
        assert!(
            String::from_utf8(output.stdout)
                .unwrap()
                .contains("ysteron")
        );
    }
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let mut child = hysteron()
        .args(["diagnose", "--help"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty());
}

#[test]
fn the_json_keeps_the_contract() {
    let output = hysteron()
        .arg("diagnose")
        .arg(data("drive-02.csv"))
        .args(["--format", "json"])
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(output.stderr.is_empty(), "progress is for terminals");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["kind"], "drive");
    assert_eq!(json["samples"], 10_000);
    assert!(json["noise_floor"].is_f64() && json["seconds"].as_f64().unwrap() > 0.0);
    let steps = json["steps"].as_array().unwrap();
    assert_eq!(steps[0]["effects"][0], "viscous_friction");
    for step in steps {
        assert!(step["error"].is_f64() && step["error_fit"].is_f64());
        for parameter in step["parameters"].as_array().unwrap() {
            assert!(parameter["name"].is_string() && parameter["unit"].is_string());
            assert!(parameter["value"].is_f64() && parameter["std_error"].is_f64());
            assert!(parameter.get("effect").is_some());
        }
        for finding in step["where"].as_array().unwrap() {
            assert!(finding["axis"].is_string() && finding["text"].is_string());
            assert!(finding["share_of_error"].is_f64() && finding["share_of_samples"].is_f64());
        }
        for candidate in step["candidates"].as_array().unwrap() {
            assert!(candidate["effects"].is_array() && candidate["equivalent_to"].is_array());
            assert!(candidate["error"].is_f64() && candidate["delta_bic"].is_f64());
        }
    }
    let verdict = &json["verdict"];
    assert_eq!(
        verdict["missing"],
        serde_json::json!([["coulomb_friction"]])
    );
    assert_eq!(
        (&verdict["complete"], &verdict["unknown"]),
        (&true.into(), &false.into())
    );
    assert!(verdict.get("next_experiment").is_some() && verdict["text"].is_string());
    let diagnosis: Diagnosis = serde_json::from_value(json).unwrap();
    assert!(diagnosis.steps.last().unwrap().error < diagnosis.steps[0].error);
}

/// A diagnosis made by hand: Coulomb friction found, two candidates alike.
fn by_hand() -> Diagnosis {
    let j1 = |value: f64| {
        serde_json::json!({"effect": null, "name": "J1", "label": "motor inertia",
            "value": value, "std_error": 1.04e-6, "unit": "kg m^2"})
    };
    let c = serde_json::json!({"effect": "coulomb_friction", "name": "c", "label": "friction level",
        "value": 0.040_12, "std_error": 0.001_23, "unit": "N m"});
    let candidate = |id: &str, error: f64, bic: f64, same: &[&str]| {
        serde_json::json!({"effects": [id], "error": error, "delta_bic": bic,
            "significant": bic < 0.0, "parameters": [], "equivalent_to": same})
    };
    serde_json::from_value(serde_json::json!({
        "schema": 1, "kind": "drive", "samples": 10_000, "noise_floor": 1.0, "seconds": 0.41,
        "steps": [
            {"effects": ["viscous_friction"], "error": 8.31, "error_fit": 8.2, "parameters": [j1(8.79e-4)],
             "where": [{"axis": "time_since_reversal", "from": 0.0, "to": 0.003, "share_of_error": 0.71,
                "share_of_samples": 0.08,
                "text": "71 % of the error comes from the 8 % of samples within 3 ms after a velocity reversal"}],
             "candidates": [candidate("coulomb_friction", 1.02, -5210.0, &[]),
                candidate("gain_asymmetry", 8.0, -12.0, &["constant_load"]),
                candidate("input_delay", 8.31, 9.2, &[])]},
            {"effects": ["viscous_friction", "coulomb_friction"], "error": 1.02, "error_fit": 1.0,
             "parameters": [j1(9.01e-4), c], "where": [], "candidates": []},
        ],
        "verdict": {"missing": [["coulomb_friction"]], "complete": true, "unknown": false,
            "next_experiment": null, "text": "The missing effect is Coulomb friction."},
    }))
    .unwrap()
}

#[test]
fn the_text_tells_the_story_in_80_columns() {
    let text = render(&by_hand(), "rig.csv", &[]);
    let mut rest = text.as_str();
    for part in [
        "rig.csv: 10000 samples of a drive",
        "Baseline",
        "Error 8.31 times the noise",
        "879 kg mm² ± 0.1 %",
        "71 % of the error comes from the 8 % of samples within 3 ms",
        "coulomb_friction          1.02     -5210.0  helps",
        "same as constant_load",
        "too little to be added",
        "+ Coulomb friction",
        "motor inertia",
        "friction level",
        "40 mN m ± 3 %",
        "Error step by step",
        "baseline",
        "noise floor",
        "Verdict",
        "The missing effect is Coulomb friction.",
        "Took 0.41 s.",
    ] {
        let at = rest
            .find(part)
            .unwrap_or_else(|| panic!("'{part}' is missing or out of order in\n{text}"));
        rest = &rest[at + part.len()..];
    }
    assert!(text.lines().all(|l| l.chars().count() <= 80), "{text}");
}

#[test]
fn the_bars_fall_with_the_error() {
    let text = render(&by_hand(), "rig.csv", &[]);
    let bars: Vec<usize> = text
        .lines()
        .map(|l| l.chars().filter(|c| *c == '█').count())
        .filter(|n| *n > 0)
        .collect();
    assert_eq!(
        bars,
        [40, 4, 4],
        "8.31, 1.02 and 1.00 in proportion:\n{text}"
    );
}

#[test]
fn an_unfinished_diagnosis_can_be_shown() {
    let mut diagnosis = by_hand();
    diagnosis.steps.clear();
    assert!(render(&diagnosis, "a\nb", &[]).starts_with("a b: "));
    let mut diagnosis = by_hand();
    diagnosis.steps[0].error = f64::NAN;
    diagnosis.steps[1].error = 0.0;
    diagnosis.noise_floor = f64::INFINITY;
    assert!(render(&diagnosis, "rig.csv", &[]).contains("unknown"));
}

#[test]
fn a_report_is_written_beside_the_answer() {
    let page = Path::new(env!("CARGO_TARGET_TMPDIR")).join("process-02.html");
    let _ = std::fs::remove_file(&page);
    let output = hysteron()
        .args(["diagnose", "--kind", "process", "--limits", "duration=600"])
        .arg("--report")
        .args([&page, &data("process-02.csv")])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
    for part in ["process-02.csv --kind process", "--limits ", "duration=600"] {
        assert!(page.contains(part), "how to make it again: {part}");
    }
    let run = |arguments: &[&Path]| hysteron().arg("diagnose").args(arguments).output().unwrap();
    let (file, option) = (data("process-02.csv"), Path::new("--report"));
    refused(
        &run(&[&file, option, Path::new("/no/such/folder/out.html")]),
        &["out.html", "cannot be written"],
    );
    refused(
        &run(&[
            &file,
            &data("process-01.csv"),
            option,
            Path::new("out.html"),
        ]),
        &["--report", "one FILE"],
    );
}

#[test]
fn a_model_is_read_and_saved() {
    let saved = Path::new(env!("CARGO_TARGET_TMPDIR")).join("saved.toml");
    let run = |arguments: &[&Path]| hysteron().arg("diagnose").args(arguments).output().unwrap();
    let (file, model) = (data("process-02.csv"), Path::new("--model"));
    let output = run(&[&file, Path::new("--save-model"), &saved]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stdout).contains("Missing: Input delay"));
    let output = run(&[&file, model, &saved]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("Nothing is missing"), "{text}");
    let bad = written("bad.toml", b"kind = \"process\"\n[parameters]\nJ1 = 3\n");
    refused(
        &run(&[&file, model, &bad]),
        &["bad.toml, line 3: 'J1'", "K, T or ambient"],
    );
    refused(
        &run(&[&file, model, Path::new("none.toml")]),
        &["none.toml cannot be read"],
    );
    refused(
        &run(&[&data("drive-01.csv"), model, &saved]),
        &["the model is of a process, the measurement of a drive"],
    );
}

#[test]
fn an_effect_of_ones_own_is_tried() {
    let run = |effect: &str| {
        let mut command = hysteron();
        command.arg("diagnose").arg(data("process-02.csv"));
        command.args(["--effect", effect]).output().unwrap()
    };
    let output = run("drift: -a*t; a = 0.001");
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("  drift "), "{text}");
    assert!(text.contains("Missing: Input delay"), "{text}");
    refused(
        &run("drift: -a*x"),
        &["--effect: drift, column 4", "y, u and t"],
    );
    refused(&run("-a*t"), &["name: formula"]);
}

#[test]
fn the_next_experiment_is_proposed_within_the_limits() {
    let run = |limits: &str, format: &str| {
        let mut command = hysteron();
        command.arg("diagnose").arg(data("drive-05.csv"));
        let options = ["--limits", limits, "--format", format];
        command.args(options).output().unwrap()
    };
    let json = run("input=0.4, duration=1.2", "json");
    let diagnosis: Diagnosis = serde_json::from_slice(&json.stdout).unwrap();
    let [proposal] = diagnosis.verdict.experiments.as_slice() else {
        panic!("one proposal: {:?}", diagnosis.verdict);
    };
    assert_eq!(proposal.limits.input, 0.4);
    assert!(
        proposal.sufficient && proposal.duration <= 1.2,
        "{proposal:?}"
    );
    let words = diagnosis
        .verdict
        .next_experiment
        .as_ref()
        .unwrap()
        .to_string();
    assert!(words.contains("0.4"), "the gain of the relay: {words}");
    let text = run("input=0.4, duration=1.2", "text");
    let text = String::from_utf8_lossy(&text.stdout);
    for part in [
        "Next experiment: To tell ",
        "Gain asymmetry",
        "Constant load",
    ] {
        assert!(text.contains(part), "{text}");
    }
    refused(
        &run("torque=3", "text"),
        &["torque=3", "one of input, duration, step, speed, travel"],
    );
    refused(&run(" ", "text"), &["--limits", "no limit", "input=0.5"]);
}

fn gap(file: &Path, arguments: &[&str]) -> Output {
    hysteron()
        .arg("gap")
        .arg(file)
        .args(arguments)
        .output()
        .unwrap()
}

fn asset(name: &str) -> PathBuf {
    data("../../assets/measurements").join(name)
}

#[test]
fn the_gap_keeps_the_contract() {
    let output = gap(&asset("drive-10.csv"), &["--format", "json"]);
    assert!(output.status.success() && output.stderr.is_empty());
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["schema"], 1);
    assert!(
        (json["gap"].as_f64().unwrap() / 0.012 - 1.0).abs() < 0.05,
        "{json}"
    );
    assert!(json["std_error"].as_f64().unwrap() < 0.05 * 0.012, "{json}");
    assert_eq!(
        (&json["unit"], &json["traverses"]),
        (&"rad".into(), &3.into())
    );
    assert!(
        json["text"]
            .as_str()
            .unwrap()
            .contains("three traverses agree")
    );

    let output = gap(&data("drive-02.csv"), &["--format", "json"]);
    assert!(output.status.success());
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["schema"], 1);
    assert!(
        json["gap"].is_null() && json["std_error"].is_null(),
        "{json}"
    );
    assert_eq!(
        (&json["unit"], &json["traverses"]),
        (&"rad".into(), &0.into())
    );
    assert!(
        json["text"]
            .as_str()
            .unwrap()
            .contains("no engagement seen")
    );
}

#[test]
fn the_gap_in_words() {
    let output = gap(&asset("drive-03.csv"), &[]);
    assert!(output.status.success() && output.stderr.is_empty());
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("drive-03.csv: the gap is 19."), "{text}");
    for part in [
        "if the motor started in its middle",
        "95 % interval",
        "pushed one way at most",
    ] {
        assert!(text.contains(part), "expected '{part}' in {text}");
    }
    let text =
        String::from_utf8(gap(&asset("drive-10.csv"), &["--format", "text"]).stdout).unwrap();
    assert!(
        text.contains("reached [s]") && text.contains("By the backlash map"),
        "{text}"
    );
}

#[test]
fn bad_input_for_a_gap_is_one_line_and_code_2() {
    refused(
        &gap(Path::new("no-such-file.csv"), &[]),
        &["no-such-file.csv", "cannot be read"],
    );
    refused(
        &gap(&data("process-01.csv"), &[]),
        &["process-01.csv", "a process has no gap", "x1 or v1"],
    );
    refused(
        &gap(&written("gap-empty.csv", b""), &[]),
        &["gap-empty.csv", "empty"],
    );
    refused(&gap(&data("drive-02.csv"), &["--format", "xml"]), &["xml"]);
    refused(
        &hysteron().arg("gap").output().unwrap(),
        &["FILE.csv", "--help"],
    );
}

#[test]
fn a_formula_is_looked_for_where_that_is_asked() {
    // A drive that a place holds back: no effect of the library.
    let rig = DriveRig {
        excitation: Excitation::Multisine { amplitude: 0.08 },
        samples: 5000,
        stranger: Some(Stranger::PositionBump {
            torque: 0.06,
            at: 0.5,
            width: 0.1,
        }),
        ..DriveRig::default()
    };
    let file = written("bump.csv", rig.measure().to_csv().as_bytes());
    let run = |format: &str| {
        let mut command = hysteron();
        command
            .arg("diagnose")
            .arg(&file)
            .args(["--discover", "--format", format]);
        String::from_utf8(command.output().unwrap().stdout).unwrap()
    };
    let text = run("text");
    assert!(text.contains("Formula of the unknown"), "{text}");
    assert!(text.contains("--effect \"formula_"), "{text}");
    let page = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bump.html");
    let _ = std::fs::remove_file(&page);
    let json = (hysteron()
        .arg("diagnose")
        .arg(&file)
        .arg("--report")
        .arg(&page))
    .args(["--discover", "--format", "json"])
    .output()
    .unwrap();
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let discovery: Discovery = serde_json::from_value(json["discovery"].clone()).unwrap();
    let found = discovery.found().unwrap();
    assert_eq!(found.formula, "-a*exp(-((x-c)/w)^2)");
    // The report has it as well, with the words that look for it again.
    let page = std::fs::read_to_string(page).unwrap();
    for part in [
        "bump.csv --discover",
        "Every formula that was simulated",
        "exp(-((x-c)/w)^2)",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // Without it nothing is looked for.
    let plain = diagnose(&data("drive-01.csv"));
    assert!(!String::from_utf8_lossy(&plain.stdout).contains("Formula"));
}
