//! Many files on the command line: one result each, none lost, none twice.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// A folder of one test alone, empty.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// A short record of a process `y' = (2 u - y)/T` under steps, with noise.
fn process(folder: &Path, name: &str, time_constant: f64) -> PathBuf {
    let mut text = String::from("t [s],u [1],y [1]\n");
    let (mut y, mut noise) = (0.0, 1_u64);
    for i in 0..300 {
        let u = if i / 37 % 2 == 0 { 1.0 } else { -0.6 };
        noise = noise
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let scatter = 0.02 * ((noise >> 33) as f64 / f64::from(1_u32 << 31) - 0.5);
        let _ = writeln!(text, "{},{u},{}", f64::from(i) * 0.5, y + scatter);
        y = 2.0 * u + (y - 2.0 * u) * (-0.5 / time_constant).exp();
    }
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn diagnose(files: &[&Path], more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron-cli"))
        .arg("diagnose")
        .args(files)
        .args(more)
        .output()
        .unwrap()
}

fn lines(bytes: &[u8]) -> Vec<Value> {
    let text = std::str::from_utf8(bytes).unwrap();
    assert!(text.is_empty() || text.ends_with('\n'));
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}")))
        .collect()
}

fn names(lines: &[Value]) -> BTreeSet<String> {
    lines
        .iter()
        .map(|l| {
            let path = Path::new(l["file"].as_str().unwrap());
            path.file_name().unwrap().to_str().unwrap().to_owned()
        })
        .collect()
}

#[test]
fn many_files_are_a_line_of_json_each_and_a_bad_one_stops_nothing() {
    let folder = folder("batch-json");
    let good = [
        process(&folder, "a.csv", 10.0),
        process(&folder, "b.csv", 12.0),
    ];
    let bad = folder.join("bad.csv");
    std::fs::write(&bad, "t [s],u [1],y [1]\n0,1,x\n").unwrap();
    let missing = folder.join("missing.csv");
    let files = [&bad, &good[0], &missing, &good[1], &good[0]].map(PathBuf::as_path);
    let output = diagnose(&files, &["--format", "json"]);
    let log = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{log}");
    let lines = lines(&output.stdout);
    assert_eq!(lines.len(), 4, "the file that is named twice is done once");
    assert_eq!(names(&lines).len(), 4);
    for line in &lines {
        assert_eq!(line["schema"], 1);
        let is_good = good.iter().any(|g| line["file"] == g.to_str().unwrap());
        assert_eq!(line.get("verdict").is_some(), is_good);
        assert_eq!(line.get("failed").is_some(), !is_good);
        if is_good {
            assert_eq!(
                (&line["kind"], &line["samples"]),
                (&"process".into(), &300.into())
            );
            assert!(line["steps"][0]["error"].is_f64());
        }
    }
    // The log says which file was wrong, where and why; and how far the run has come.
    assert_eq!(log.lines().count(), 4, "{log}");
    assert!(log.contains("bad.csv, line 2, column 3 (y): 'x'"), "{log}");
    assert!(log.contains("missing.csv cannot be read"), "{log}");
    assert!(log.contains("4 of 4: "), "{log}");
}

#[test]
fn many_files_are_a_block_of_text_each() {
    let folder = folder("batch-text");
    let files = [
        process(&folder, "a.csv", 10.0),
        process(&folder, "b.csv", 12.0),
    ];
    let output = diagnose(&[&files[0], &files[1]], &["--jobs", "1"]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).unwrap();
    let [a, b] =
        ["a.csv: 300 samples of a process", "b.csv: 300 samples"].map(|t| text.find(t).unwrap());
    assert!(a < b, "one worker keeps the order");
    assert_eq!(text.matches("\nVerdict").count(), 2);
}

#[test]
fn a_run_that_was_cut_off_goes_on_where_it_was() {
    let folder = folder("batch-resume");
    let files = ["a.csv", "b.csv", "c.csv"].map(|name| process(&folder, name, 10.0));
    let bad = folder.join("bad.csv");
    std::fs::write(&bad, "t [s],u [1],y [1]\n0,1,x\n").unwrap();
    let out = folder.join("out.jsonl");
    let resume = ["--format", "json", "--resume", out.to_str().unwrap()];
    let first = diagnose(&[&files[0], &bad], &resume);
    assert_eq!(first.status.code(), Some(2));
    assert!(first.stdout.is_empty(), "the results are in the file");
    let before = std::fs::read(&out).unwrap();
    assert_eq!(lines(&before).len(), 2);
    // Power fails in the middle of a line.
    let half = br#"{"file":"b.csv","schema":1,"ki"#;
    std::fs::write(&out, [before.as_slice(), half].concat()).unwrap();
    let all = [&files[0], &files[1], &files[2], &bad].map(PathBuf::as_path);
    let second = diagnose(&all, &resume);
    assert_eq!(
        second.status.code(),
        Some(2),
        "the bad file is tried again and still bad"
    );
    let log = String::from_utf8(second.stderr).unwrap();
    assert!(log.contains("1 skipped") && log.contains("3 of 3"), "{log}");
    let after = std::fs::read(&out).unwrap();
    assert!(
        after.starts_with(&before),
        "what stands there is not touched"
    );
    let found = lines(&after);
    assert_eq!(found.len(), 4, "the same failure is not said twice");
    assert_eq!(names(&found).len(), 4);
    // Now the bad file is mended: the last line about a file counts.
    process(&folder, "bad.csv", 9.0);
    assert_eq!(diagnose(&all, &resume).status.code(), Some(0));
    let mended = lines(&std::fs::read(&out).unwrap());
    assert!(mended.len() == 5 && mended[4].get("verdict").is_some());
    // Everything is done: nothing more happens.
    let last = diagnose(&all, &resume);
    assert_eq!(last.status.code(), Some(0));
    assert_eq!(lines(&std::fs::read(&out).unwrap()), mended);
}

#[test]
fn one_file_can_resume_as_well() {
    let folder = folder("batch-one");
    let file = process(&folder, "a.csv", 10.0);
    let out = folder.join("out.jsonl");
    for _ in 0..2 {
        let output = diagnose(&[&file], &["--resume", out.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(lines(&std::fs::read(&out).unwrap()).len(), 1);
    }
}

#[test]
fn a_file_of_something_else_is_never_written_to() {
    let folder = folder("batch-wrong");
    let file = process(&folder, "a.csv", 10.0);
    for (name, text) in [
        ("data.csv", "t [s],u [1]\n0,1\n"),
        ("note", "no newline"),
        ("json", "{\"a\": 1}\n"),
    ] {
        let out = folder.join(name);
        std::fs::write(&out, text).unwrap();
        let output = diagnose(&[&file], &["--resume", out.to_str().unwrap()]);
        let line = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(line.contains(name) && line.contains("not a result") && line.lines().count() == 1);
        assert_eq!(std::fs::read_to_string(&out).unwrap(), text);
    }
    let nowhere = folder.join("no/such/folder/out.jsonl");
    let output = diagnose(&[&file], &["--resume", nowhere.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("cannot be opened")
    );
}

#[test]
fn columns_are_mapped_and_what_was_assumed_is_said() {
    let folder = folder("mapping");
    let rig = include_str!("../data/drive-02.csv");
    let rows: Vec<&str> = rig.lines().skip(1).take(400).collect();
    let file = folder.join("drive.csv");
    std::fs::write(&file, format!("zeit,strom,x,v\n{}\n", rows.join("\n"))).unwrap();
    let map = "t=zeit [s],u=strom [A],x1=x [rad],v1=v [rad/s]";
    let json = |more: &[&str]| -> Value {
        let output = diagnose(
            &[&file],
            &[&["--format", "json", "--map", map], more].concat(),
        );
        let log = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && log.is_empty(), "{log}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let inertia = |json: &Value| {
        let parameters = json["steps"][0]["parameters"].as_array().unwrap();
        let j1 = parameters.iter().find(|p| p["name"] == "J1").unwrap();
        j1["value"].as_f64().unwrap()
    };
    let (free, known) = (json(&[]), json(&["--torque-constant", "0.5 N m/A"]));
    assert!(
        free["notes"][0]
            .as_str()
            .unwrap()
            .contains("1 N m/A is assumed")
    );
    assert!(known.get("notes").is_none());
    // Twice the inertia if nothing is said of a constant of a half.
    let ratio = inertia(&free) / inertia(&known);
    assert!((ratio - 2.0).abs() < 1e-3, "{ratio}");
    let text = diagnose(&[&file], &["--map", map]).stdout;
    let text = String::from_utf8(text).unwrap();
    assert!(
        text.contains("  - The torque constant is not known: 1 N m/A is assumed."),
        "{text}"
    );
    for (arguments, expected) in [
        (["--map", "t:zeit"], "is not a mapping"),
        (["--torque-constant", "0.5"], "is not a torque constant"),
    ] {
        let output = diagnose(&[&file], &arguments);
        let line = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(
            line.contains(expected) && line.lines().count() == 1,
            "{line}"
        );
    }
}
