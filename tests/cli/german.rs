//! The command line in German: what is said is said in one language, and JSON and errors keep their contract.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use hysteron_cli::render;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::measurement::import_csv;
use hysteron_core::progress::Progress;
use hysteron_core::report::{Provenance, ReportInput, Tongue, html};
use hysteron_work::language::{self, Language, is_plain, say};

fn asset(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../assets")
        .join(name)
}

fn hysteron(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron-cli"))
        .args(arguments)
        .output()
        .unwrap()
}

fn said(arguments: &[&str]) -> String {
    let output = hysteron(arguments);
    let line = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {line}");
    String::from_utf8(output.stdout).unwrap()
}

/// Words that every English sentence has some of and no German one has.
const ENGLISH: [&str; 24] = [
    "the", "of", "is", "and", "with", "that", "are", "by", "its", "from", "to", "not", "it", "at",
    "which", "than", "has", "for", "more", "or", "error", "noise", "gain", "left",
];

/// No line is in English: none is as it is in English, and none has English words between German ones.
#[track_caller]
fn speaks_german(arguments: &[&str]) {
    let english = said(arguments);
    let in_german: Vec<&str> = arguments.iter().copied().chain(["--lang", "de"]).collect();
    let german = said(&in_german);
    let lines: Vec<&str> = english.lines().map(str::trim).collect();
    for line in german.lines().map(str::trim) {
        // Ids of effects and models are names, in JSON as here.
        let id = |word: &&str| word.contains('_') || line.starts_with(*word);
        let words: Vec<&str> = line.split_whitespace().filter(|w| !id(w)).collect();
        let alike = lines.contains(&line) && !is_plain(&words.join(" "));
        assert!(!alike, "{arguments:?} says in both languages: {line}");
        let letters = |word: &str| word.trim_matches(|c: char| !c.is_alphabetic()).to_owned();
        let english = words
            .iter()
            .find(|w| ENGLISH.contains(&letters(w).as_str()));
        assert_eq!(english, None, "{arguments:?}: {line}");
    }
    let count = |text: &str| text.lines().count();
    assert!(count(&german) >= count(&english) * 3 / 4, "{german}");
}

fn with_file(command: &str, file: &str) {
    let path = asset(file);
    speaks_german(&[command, &path.display().to_string()]);
}

#[test]
fn a_diagnosis_speaks_german() {
    with_file("diagnose", "measurements/drive-12.csv");
    with_file("screen", "measurements/drive-12.csv");
}

#[test]
fn tune_speaks_german() {
    with_file("tune", "measurements/process-02.csv");
    with_file("tune", "measurements/drive-12.csv");
    let numbers = "--amplitude 1.2 --period 47 --levels 0,255 --hysteresis 0.5";
    let arguments: Vec<&str> = ["tune"].into_iter().chain(numbers.split(' ')).collect();
    speaks_german(&arguments);
}

#[test]
fn gap_speaks_german() {
    for name in ["drive-03", "drive-10", "drive-12", "drive-15"] {
        with_file("gap", &format!("measurements/{name}.csv"));
    }
}

#[test]
fn every_scenario_is_predicted_and_run_in_german() {
    let mut scenarios = 0;
    for entry in std::fs::read_dir(asset("scenarios")).unwrap().flatten() {
        let path = entry.path().display().to_string();
        speaks_german(&["limit-cycle", &path]);
        speaks_german(&["simulate", &path]);
        scenarios += 1;
    }
    assert!(scenarios > 10);
}

#[test]
fn every_text_of_a_diagnosis_and_of_its_report_has_a_german_one() {
    let bytes = std::fs::read(asset("measurements/drive-12.csv")).unwrap();
    let measurement = import_csv("drive-12.csv", &bytes, None).unwrap();
    let mut job = DiagnosisJob::new(&measurement).unwrap();
    let diagnosis = loop {
        if let Progress::Done(diagnosis) = job.advance() {
            break diagnosis;
        }
    };
    let (first, last) = job.evidence().unwrap();
    let page = |tongue| {
        html(&ReportInput {
            measurement: &measurement,
            steps: &diagnosis.steps,
            first_atlas: &first.atlas,
            last,
            verdict: Some(&diagnosis.verdict),
            discovery: None,
            model: None,
            provenance: &Provenance {
                command: "hysteron diagnose drive-12.csv".to_owned(),
                version: "1.2.3".to_owned(),
                bytes: 4711,
                sha256: String::new(),
            },
            tongue,
        })
    };
    let english = page(Tongue::ENGLISH);
    language::speak(Language::German);
    let text = render(&diagnosis, "drive-12.csv", &measurement.warnings);
    let german = page(Tongue {
        code: "de",
        say: |text| say(text),
    });
    assert_eq!(language::missed(), Vec::<String>::new());
    assert!(text.contains("Urteil"), "{text}");
    assert!(english.contains("<html lang=\"en\">") && english.contains("0.5997 ms"));
    assert!(german.contains("<html lang=\"de\">") && german.contains("0,5997 ms"));
    assert!(german.contains("Was fehlt im Modell von drive-12.csv?"));
    // Curves are drawn where they are, with points.
    let curves = |page: &str| {
        let paths = page
            .split("<path")
            .skip(1)
            .filter_map(|p| p.split('>').next());
        paths.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(curves(&german), curves(&english));
}

#[test]
fn json_is_the_same_in_both_languages() {
    let path = asset("measurements/drive-10.csv").display().to_string();
    let json = said(&["gap", &path, "--format", "json"]);
    let german = said(&["--lang", "de", "gap", &path, "--format", "json"]);
    assert_eq!(json, german);
}

#[test]
fn what_is_wrong_is_one_line_of_one_language() {
    let line = |arguments: &[&str]| {
        let output = hysteron(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let line = String::from_utf8(output.stderr).unwrap();
        assert_eq!(line.lines().count(), 1, "{line}");
        line
    };
    let other = line(&["gap", "a.csv", "--lang", "fr"]);
    assert!(
        other.contains("'fr'") && other.contains("en, de"),
        "{other}"
    );
    let missing = line(&["diagnose", "no-such-file.csv", "--lang", "de"]);
    let german = "no-such-file.csv kann nicht gelesen werden: ";
    assert!(missing.contains(german), "{missing}");
    let help = said(&["diagnose", "--help"]);
    assert!(
        help.contains("--lang") && help.contains("de: Deutsch"),
        "{help}"
    );
}
