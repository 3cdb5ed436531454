//! `hysteron tune` as a person and a script meet it.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

fn tune(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hysteron-cli"));
    command.arg("tune").args(arguments).output().unwrap()
}

fn json(arguments: &[&str]) -> Value {
    let output = tune(arguments);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A file of this test alone.
fn written(name: &str, text: &str) -> String {
    let path: PathBuf = [env!("CARGO_TARGET_TMPDIR"), name].iter().collect();
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// A relay of 0 and 100 with a hysteresis of 0.2 about 50 on a lag of 20 s and gain 0.3 that comes 5 s late.
fn record() -> String {
    let mut text = String::from("t [s],u [%],y [°C]\n");
    let (mut late, mut output, mut up) = ([1.0; 50], 50.0, true);
    for i in 0..4000_usize {
        if output > 50.2 {
            up = false;
        } else if output < 49.8 {
            up = true;
        }
        let u = if up { 100.0 } else { 0.0 };
        writeln!(text, "{:.1},{u},{output:.6}", 0.1 * i as f64).unwrap();
        // The lag goes on exactly from sample to sample.
        let end = 35.0 + 0.3 * late[i % 50];
        output = end + (output - end) * (-0.1_f64 / 20.0).exp();
        late[i % 50] = u;
    }
    text
}

#[test]
fn a_record_gives_what_the_contract_says() {
    let file = written("relay-test.csv", &record());
    let found = json(&[&file, "--format", "json"]);
    assert_eq!(found["schema"], 1);
    let number = |pointer: &str| {
        found
            .pointer(pointer)
            .and_then(Value::as_f64)
            .unwrap_or_else(|| panic!("{pointer}: {found}"))
    };
    let omega = number("/point/omega");
    let phase = -(20.0 * omega).atan().to_degrees() - (5.0 * omega).to_degrees();
    assert!((number("/point/magnitude") * (20.0 * omega).hypot(1.0) / 0.3 - 1.0).abs() < 0.005);
    assert!((number("/point/phase_deg") - phase).abs() < 0.5);
    let halves = number("/cycle/half_periods/0") + number("/cycle/half_periods/1");
    assert!((halves - number("/cycle/period")).abs() < 1e-9);
    // Phase -180 degrees of the lag and dead time: atan(20 w) + 5 w = pi.
    let ultimate = 0.343_101_f64;
    assert!(
        (number("/ultimate/period") * ultimate / std::f64::consts::TAU - 1.0).abs() < 0.02,
        "{found}"
    );
    assert!(number("/ultimate/std_error_gain") > 0.0);
    assert_eq!(found["models"][0]["kind"], "fopdt");
    assert!(
        (number("/models/0/time_constant") - 20.0).abs() < 0.5
            && (number("/models/0/dead_time") - 5.0).abs() < 0.2
    );
    let gains = found["gains"].as_array().unwrap();
    let simc = gains.iter().find(|g| g["rule"] == "simc").unwrap();
    assert_eq!(simc["form"], "parallel");
    assert!(
        simc["phase_margin_deg"].as_f64().unwrap() > 45.0
            && simc["gain_margin"].as_f64().unwrap() > 2.0
    );
    assert_eq!(found["stall"], Value::Null);
    let said = String::from_utf8(tune(&[&file]).stdout).unwrap();
    assert!(
        said.contains("Ultimate gain") && said.contains("SIMC PI") && said.contains("ki [1/s]"),
        "{said}"
    );
    // The ideal form has times: AMIGO's PI has the same gain, and kp/ki for its integral time.
    let ideal = String::from_utf8(tune(&[&file, "--form", "ideal"]).stdout).unwrap();
    assert!(
        ideal.contains("ti [s]") && !ideal.contains("ki [1/s]"),
        "{ideal}"
    );
    let row = |text: &str| -> Vec<f64> {
        let row = text.lines().find(|line| line.starts_with("AMIGO PI "));
        let numbers = row.unwrap().split_whitespace().skip(2).take(2);
        numbers.map(|n| n.parse().unwrap()).collect()
    };
    let (parallel, ideal) = (row(&said), row(&ideal));
    assert_eq!(parallel[0], ideal[0]);
    assert!((parallel[0] / parallel[1] / ideal[1] - 1.0).abs() < 1e-3);
}

#[test]
fn a_record_without_times_takes_a_sampling_period_and_columns() {
    let whole = json(&[&written("with-times.csv", &record()), "--format", "json"]);
    let without: String = record()
        .lines()
        .map(|line| line.split_once(',').unwrap().1.to_owned() + "\n")
        .collect();
    let file = written(
        "without-times.csv",
        &without.replace("u [%],y [°C]", "heater,room"),
    );
    let asked = [
        &file,
        "--period",
        "10Hz",
        "--map",
        "u=heater [%], y=room [°C]",
        "--format",
        "json",
    ];
    let found = json(&asked);
    let close = |pointer: &str| {
        let of = |v: &Value| v.pointer(pointer).and_then(Value::as_f64).unwrap();
        assert!((of(&found) / of(&whole) - 1.0).abs() < 1e-9, "{pointer}");
    };
    close("/point/magnitude");
    close("/models/0/time_constant");
}

/// What was read off a test with hysteresis.
const NUMBERS: [&str; 8] = [
    "--amplitude",
    "1.2",
    "--period",
    "47",
    "--levels",
    "0,255",
    "--hysteresis",
    "0.5",
];

#[test]
fn numbers_with_hysteresis_give_a_point_and_the_remedy() {
    let found = json(&[&NUMBERS[..], &["--format", "json"]].concat());
    assert_eq!(found["ultimate"], Value::Null);
    assert!(
        (found["point"]["phase_deg"].as_f64().unwrap() + 155.376).abs() < 1e-3,
        "{found}"
    );
    assert!(found["text"].as_str().unwrap().contains("less hysteresis"));
}

#[test]
fn bad_input_gets_one_line() {
    let garbled = written("garbled.log", "PID Autotune start\n bias: 9");
    let scenario = written(
        "loop.toml",
        "# a loop\n[plant] # of one lag\nformula = \"1/(s+1)\"\n",
    );
    for (arguments, part) in [
        (
            vec![scenario.as_str()],
            "a scenario with a table [plant], no measurement",
        ),
        (
            vec![garbled.as_str()],
            "this looks like a log of Marlin M303",
        ),
        (vec!["none.csv"], "cannot be read"),
        (vec!["--amplitude", "1", "--period", "2"], "--levels"),
        (
            vec!["--amplitude", "1", "--period", "2", "--levels", "0"],
            "two numbers with a comma",
        ),
        (
            vec!["--amplitude", "1", "--period", "0", "--levels", "0,1"],
            "the period is 0: it must be above 0 s",
        ),
    ] {
        let output = tune(&arguments);
        let line = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(
            line.contains(part) && line.lines().count() == 1,
            "{part}: {line}"
        );
    }
}

/// A room whose air comes and goes, and a heater that is switched on once and hardly felt in what is left of the
/// record.
#[test]
fn a_record_that_no_model_follows_gives_none() {
    let mut text = String::from("t [s],u [%],y [°C]\n");
    for i in 0..400_usize {
        let t = 0.5 * i as f64;
        let u = if t < 125.0 { 0.0 } else { 40.0 };
        let air = 2.0 * (t / 17.0).sin() - 3.0 * (-((t - 60.0) / 9.0).powi(2)).exp();
        let heat = 1e-4 * (t - 125.0).max(0.0).powi(2);
        writeln!(text, "{t:.1},{u},{:.2}", 24.0 + air + heat).unwrap();
    }
    let file = written("hardly-heated.csv", &text);
    let found = json(&[&file, "--format", "json"]);
    let said = found["text"].as_str().unwrap();
    assert!(said.contains("No model follows the record"), "{said}");
    assert!(said.contains("the input switches 1 time and"), "{said}");
    assert!(!said.contains("dead time "), "{said}");
    assert_eq!(found["gains"].as_array().unwrap().len(), 0);
    assert_eq!(found["ultimate"], Value::Null);
}

/// All keys of objects in it, and words that stand for one of a few.
fn keys(value: &Value, found: &mut std::collections::BTreeSet<String>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                found.insert(key.clone());
                if let (true, Some(word)) = (
                    ["kind", "rule", "controller", "form"].contains(&key.as_str()),
                    value.as_str(),
                ) {
                    found.insert(word.to_owned());
                }
                keys(value, found);
            }
        }
        Value::Array(values) => values.iter().for_each(|v| keys(v, found)),
        _ => {}
    }
}

/// A record by a step, by a controller, and by an input of all values: no cycle, a cause, an integrator.
fn other_records() -> Vec<String> {
    let head = || String::from("t [s],u [%],y [°C]\n");
    let (mut step, mut ramp, mut looped) = (head(), head(), head());
    let (mut level, mut tank, mut room) = (20.0, 0.0, 20.0);
    for i in 0..600_usize {
        let t = i as f64;
        let u = if (50..).contains(&i) { 100.0 } else { 0.0 };
        writeln!(step, "{t},{u},{level:.4}").unwrap();
        level += (20.0 + 0.5 * u - level) / 60.0;
        let pulse = if i / 60 % 2 == 0 { 100.0 } else { 0.0 };
        writeln!(ramp, "{t},{pulse},{tank:.4}").unwrap();
        tank += 0.01 * (pulse - 50.0);
        let control = 180.0 - 2.0 * room;
        writeln!(looped, "{t},{control:.4},{room:.4}").unwrap();
        room += (20.0 + 0.6 * control - room) / 60.0;
    }
    vec![step, ramp, looped]
}

#[test]
fn every_key_of_the_json_is_documented_and_every_documented_key_is_there() {
    let document = include_str!("../../docs/tuning.md");
    let section = document.split("## JSON").nth(1).unwrap();
    let mut all = std::collections::BTreeSet::new();
    let mut files = vec![record()];
    files.extend(other_records());
    for (i, text) in files.iter().enumerate() {
        let file = written(&format!("documented-{i}.csv"), text);
        keys(&json(&[&file, "--format", "json"]), &mut all);
    }
    let form = ["--form", "klipper", "--format", "json"];
    let told = json(&[&NUMBERS[..], &form].concat());
    assert_eq!(told["gains"][0]["stable"], Value::Null);
    keys(&told, &mut all);
    for key in &all {
        assert!(
            section.contains(&format!("`{key}`")),
            "{key} is not in the document"
        );
    }
    // Keys stand in the first column.
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    let named = rows.flat_map(|row| {
        let first = row.split(" |").next().unwrap_or_default();
        first
            .split(", ")
            .map(|key| key.trim_matches('`').to_owned())
            .collect::<Vec<_>>()
    });
    for key in named {
        assert!(all.contains(&key), "{key} is documented, but in no answer");
    }
}
