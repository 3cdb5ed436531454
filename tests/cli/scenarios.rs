//! `hysteron simulate` and `hysteron limit-cycle` on scenario files.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn scenario(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../assets/scenarios")
        .join(name)
}

fn hysteron(command: &str, file: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hysteron-cli"))
        .arg(command)
        .arg(file)
        .args(more)
        .output()
        .unwrap()
}

#[track_caller]
fn text(output: &Output) -> String {
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn limit_cycle(name: &str) -> Value {
    let output = hysteron("limit-cycle", &scenario(name), &["--format", "json"]);
    serde_json::from_str(&text(&output)).unwrap()
}

#[track_caller]
fn close(value: &Value, exact: f64, tolerance: f64) {
    let value = value.as_f64().unwrap();
    assert!(
        (value / exact - 1.0).abs() < tolerance,
        "{value}, exact {exact}"
    );
}

#[test]
fn every_scenario_in_the_assets_runs_and_is_predicted() {
    let folder = std::fs::read_dir(scenario("")).unwrap();
    let mut count = 0;
    for entry in folder {
        let path = entry.unwrap().path();
        let said = text(&hysteron("simulate", &path, &[]));
        let counts = said.contains("switches") || said.contains("sticks");
        assert!(counts, "{path:?}: {said}");
        let said = text(&hysteron("limit-cycle", &path, &[]));
        assert!(said.contains("half of peak to peak"), "{path:?}: {said}");
        count += 1;
    }
    assert!(count >= 6, "{count}");
}

#[test]
fn fig_3_in_json_as_the_contract_says() {
    let found = limit_cycle("fig-3-third-order-lag.toml");
    assert_eq!(found["schema"], 1);
    // The reference table's row, and by hand: w of equations (5) and (6), and w = sqrt(3), P = -1/8 for the truth.
    for cycle in [&found["exact"][0], &found["simulated"]] {
        close(&cycle["period"], 4.787_671_942_045_41, 1e-9);
        close(&cycle["amplitude"], 0.285_687_386_127_379, 1e-9);
    }
    close(
        &found["exact"][0]["half_periods"][0],
        0.5 * 4.787_671_942_045_41,
        1e-9,
    );
    close(&found["describing_function"][0]["omega"], 1.325_8, 1e-4);
    close(&found["ultimate"]["gain_true"], 8.0, 1e-9);
    close(
        &found["ultimate"]["period_true"],
        2.0 * std::f64::consts::PI / 3.0_f64.sqrt(),
        1e-9,
    );
    let relay = 4.0 / (std::f64::consts::PI * 0.285_687_386_127_379);
    close(&found["ultimate"]["gain_relay"], relay, 1e-9);
    // What the cycle shows: 1/(jw + 1)^3 at its frequency.
    let omega = 2.0 * std::f64::consts::PI / 4.787_671_942_045_41;
    let phase = -3.0 * omega.atan().to_degrees();
    close(&found["ultimate"]["phase_deg"], phase, 1e-9);
    close(
        &found["ultimate"]["gain_shown"],
        omega.hypot(1.0).powi(3),
        1e-9,
    );
    assert_eq!(found["outcome"], "limit_cycle");
    assert_eq!(found["exists"], true);
    assert_eq!(found["exact"][0]["stable"], true);
}

#[test]
fn fig_5_more_hysteresis_is_larger_slower_and_a_smaller_ultimate_gain() {
    let [less, more] = ["fig-4-noise.toml", "fig-5-more-hysteresis.toml"].map(limit_cycle);
    let of = |v: &Value, part: &str| v["exact"][0][part].as_f64().unwrap();
    assert!(of(&more, "amplitude") > of(&less, "amplitude"));
    assert!(of(&more, "period") > of(&less, "period"));
    let gain = |v: &Value| v["ultimate"]["gain_relay"].as_f64().unwrap();
    assert!(gain(&more) < gain(&less));
}

#[test]
fn a_describing_function_that_fails_is_called_so() {
    let found = limit_cycle("describing-function-fails.toml");
    assert!(
        found["text"].as_str().unwrap().contains("Do not trust"),
        "{found}"
    );
}

/// Relay tests of which tuners told an ultimate gain: the phase that the cycle shows, `1/|P|` there, and a word of the
/// remedy. The plant's own is 0.1694 at 31.65 s.
#[test]
fn reported_relay_tests_say_what_their_cycle_shows() {
    for (name, phase, shown, remedy) in [
        (
            "relay-hysteresis-ku",
            -157.0,
            0.0883,
            "Less hysteresis comes nearer",
        ),
        (
            "asymmetric-heating-ku",
            -140.0,
            0.0556,
            "A symmetric relay with less hysteresis",
        ),
        (
            "dead-time-ideal-relay",
            -177.5,
            0.1581,
            "36 more of this family",
        ),
    ] {
        let Some(bytes) = crate::shared::shared(&format!("failing/{name}.toml")) else {
            return;
        };
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.toml"));
        std::fs::write(&file, bytes).unwrap();
        let said = text(&hysteron("limit-cycle", &file, &[]));
        assert!(said.contains(remedy), "{name}: {said}");
        assert!(said.lines().count() < 20, "{name}: {said}");
        let json = text(&hysteron("limit-cycle", &file, &["--format", "json"]));
        let ultimate = &serde_json::from_str::<Value>(&json).unwrap()["ultimate"];
        let of = |key: &str| ultimate[key].as_f64().unwrap();
        assert!((of("phase_deg") - phase).abs() < 0.5, "{name}: {ultimate}");
        assert!(
            (of("gain_shown") / shown - 1.0).abs() < 0.001,
            "{name}: {ultimate}"
        );
        assert!(
            (of("gain_true") / 0.1694 - 1.0).abs() < 0.001,
            "{name}: {ultimate}"
        );
    }
}

#[test]
fn simulate_writes_what_diagnose_reads() {
    let csv = Path::new(env!("CARGO_TARGET_TMPDIR")).join("simulated.csv");
    let said = text(&hysteron(
        "simulate",
        &scenario("asymmetric-first-order.toml"),
        &["--csv", csv.to_str().unwrap()],
    ));
    assert!(said.contains("2000 samples"), "{said}");
    let written = std::fs::read(&csv).unwrap();
    let measurement =
        hysteron_core::measurement::import_csv("simulated.csv", &written, None).unwrap();
    assert_eq!(measurement.kind, hysteron_core::measurement::Kind::Process);
    assert_eq!(String::from_utf8(written).unwrap().lines().count(), 2001);
}

#[test]
fn the_output_is_written_with_the_noise_that_the_relay_sees() {
    let csv = Path::new(env!("CARGO_TARGET_TMPDIR")).join("noisy.csv");
    let file = scenario("fig-4-noise.toml");
    text(&hysteron(
        "simulate",
        &file,
        &["--csv", csv.to_str().unwrap()],
    ));
    let written = std::fs::read(&csv).unwrap();
    let m = hysteron_core::measurement::import_csv("noisy.csv", &written, None).unwrap();
    let y = &m.outputs[0].values;
    // From one sample to the next the plant moves little.
    let moves = y.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum::<f64>();
    let std_dev = (0.5 * moves / (y.len() - 1) as f64).sqrt();
    assert!((std_dev / 0.02 - 1.0).abs() < 0.1, "{std_dev}");
}

#[test]
fn noise_before_a_controller_is_simulated_written_and_said() {
    for (name, words) in [
        ("one-sided-heater.toml", "It oscillates between"),
        ("hunting-stiction.toml", "It hunts"),
    ] {
        let calm = std::fs::read_to_string(scenario(name)).unwrap();
        assert!(!calm.contains("noise"), "{calm}");
        let noisy = calm.replace(
            "[run]\n",
            "[run]\nnoise = { std_dev = 0.3, interval = 0.5, seed = 2 }\n",
        );
        let [calm, noisy] = [("calm", calm), ("noisy", noisy)].map(|(kind, text)| {
            let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{kind}-{name}"));
            std::fs::write(&path, text).unwrap();
            path
        });
        let [before, after] = [&calm, &noisy].map(|path| {
            let csv = path.with_extension("csv");
            let said = text(&hysteron(
                "simulate",
                path,
                &["--csv", csv.to_str().unwrap()],
            ));
            (said, std::fs::read_to_string(csv).unwrap())
        });
        assert_ne!(before.1, after.1, "{name}");
        assert!(
            before.0.contains(words) && !before.0.contains("noise"),
            "{}",
            before.0
        );
        let said = format!("Without the noise: {words}");
        assert!(after.0.contains(&said), "{}", after.0);
        assert!(!(before.0 + &after.0).contains("-0.000000"));
        let predicted = text(&hysteron("limit-cycle", &noisy, &[]));
        assert!(
            predicted.contains("The noise of the file is left out here; simulate has it."),
            "{predicted}"
        );
    }
}

#[test]
fn one_switch_is_no_plural() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("one-switch.toml");
    let loop_ = "[plant]\nformula = \"1/(s+1)^3\"\n[relay]\ngain = 1\nhysteresis = 0.1\n[run]\n";
    std::fs::write(&path, format!("{loop_}duration = 2.0\n")).unwrap();
    let said = text(&hysteron("simulate", &path, &[]));
    assert!(said.starts_with("1 switch in "), "{said}");
}

#[test]
fn a_run_that_is_too_long_is_said_to_be() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("long.toml");
    let lines =
        "[plant]\nformula = \"1/(s+1)^3\"\n[relay]\ngain = 1\nhysteresis = 0.1\n[run]\nduration = ";
    for duration in ["1e5", "1e8"] {
        std::fs::write(&path, format!("{lines}{duration}\n")).unwrap();
        let said = text(&hysteron("simulate", &path, &[]));
        assert!(said.contains("a shorter duration"), "{said}");
        assert!(
            !said.contains("chatter") && !said.contains(" 0.000000 s"),
            "{said}"
        );
        assert!(said.contains("It oscillates"), "{said}");
    }
}

#[test]
fn what_is_no_scenario_is_one_line_with_its_place() {
    let relay = "[relay]\ngain = 1.0\n";
    for (name, content, parts) in [
        ("empty.toml", String::new(), vec!["plant"]),
        ("broken.toml", "[plant\n".to_owned(), vec!["line 1"]),
        (
            "no-plant.toml",
            format!("[plant]\n{relay}"),
            vec!["[plant]", "numerator and denominator"],
        ),
        (
            "both.toml",
            format!("[plant]\nformula = \"1/s\"\na = [[1.0]]\n{relay}"),
            vec!["several ways"],
        ),
        (
            "formula.toml",
            format!("[plant]\nformula = \"1/(s+\"\n{relay}"),
            vec!["formula", "column"],
        ),
        (
            "proper.toml",
            format!("[plant]\nnumerator = [1.0, 1.0]\ndenominator = [1.0, 1.0]\n{relay}"),
            vec!["numerator's must be lower"],
        ),
        (
            "typo.toml",
            format!("[plant]\nformula = \"1/s\"\n{relay}hysterisis = 0.1\n"),
            vec!["line 5", "hysterisis", "hysteresis"],
        ),
        (
            "negative.toml",
            "[plant]\nformula = \"1/s\"\n[relay]\ngain = -1.0\n".to_owned(),
            vec!["[relay]", "gain is -1", "above 0"],
        ),
        (
            "state.toml",
            format!(
                "[plant]\nformula = \"1/s\"\n{relay}[run]\nduration = 1.0\ninitial = [1.0, 2.0]\n"
            ),
            vec!["[run]", "initial state has 2"],
        ),
        (
            "long.toml",
            format!("[plant]\nformula = \"1/s\"\n{relay}[run]\nduration = 1e9\nstep = 1e-3\n"),
            vec!["[run]", "number of samples"],
        ),
    ] {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::write(&path, content).unwrap();
        for command in ["simulate", "limit-cycle"] {
            let output = hysteron(command, &path, &[]);
            let line = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{name}: {line}");
            assert_eq!(line.lines().count(), 1, "{line}");
            assert!(line.contains(name), "{line}");
            for part in &parts {
                assert!(line.contains(part), "{name}: expected '{part}' in: {line}");
            }
        }
    }
    for command in ["simulate", "limit-cycle"] {
        let output = hysteron(command, Path::new("no-such.toml"), &[]);
        assert_eq!(output.status.code(), Some(2));
    }
}

#[test]
fn a_drive_is_simulated_into_what_a_rig_would_have_recorded() {
    let csv = Path::new(env!("CARGO_TARGET_TMPDIR")).join("drive.csv");
    let said = text(&hysteron(
        "simulate",
        &scenario("drive-drifting.toml"),
        &["--csv", csv.to_str().unwrap()],
    ));
    assert!(said.contains("crosses the gap 3 times"), "{said}");
    let written = std::fs::read(&csv).unwrap();
    let measurement = hysteron_core::measurement::import_csv("drive.csv", &written, None).unwrap();
    assert_eq!(measurement.kind, hysteron_core::measurement::Kind::Drive);
    assert_eq!(measurement.len(), 40_001);
    // The map of both positions shows the gap.
    let map = hysteron_core::backlash::backlash_map(&measurement).unwrap();
    let gap = map.gap.expect("both ends were met");
    assert!((gap / 0.019 - 1.0).abs() < 0.02, "{gap}");
}

/// What `gap` says of what `simulate` writes, beside what the drive of the file has: its gap in rad, and its impacts.
fn gap_after_simulate(name: &str, text: &str) -> Option<(f64, usize, Value)> {
    use hysteron_core::scenario::AnyScenario;
    let AnyScenario::Drive(input) = AnyScenario::from_toml(text).unwrap() else {
        return None;
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let [file, csv] = ["toml", "csv"].map(|e| folder.join(format!("gap-{name}.{e}")));
    std::fs::write(&file, text).unwrap();
    hysteron("simulate", &file, &["--csv", csv.to_str().unwrap()]);
    let found = hysteron("gap", &csv, &["--format", "json"]);
    let impacts = hysteron_core::drive::run(&input).unwrap().impacts();
    let found = serde_json::from_str(&self::text(&found)).unwrap();
    Some((2.0 * input.drive.half_gap, impacts, found))
}

#[track_caller]
fn gap_is_right(name: &str, (gap, impacts, found): (f64, usize, Value)) {
    if impacts == 0 {
        assert_eq!(found["quality"], "no_engagement", "{name}: {found}");
        assert!(found["gap"].is_null(), "{name}: {found}");
    } else {
        close(&found["gap"], gap, 0.05);
    }
}

#[test]
fn every_drive_that_is_simulated_has_its_gap_or_none_was_met() {
    let mut drives = 0;
    for entry in std::fs::read_dir(scenario("")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        if let Some(found) = gap_after_simulate(&name, &text) {
            gap_is_right(&name, found);
            drives += 1;
        }
    }
    assert!(drives >= 2, "{drives}");
}

/// Drives of an independent check: `gs` crosses its gap, the others never meet their load.
#[test]
fn drives_of_an_independent_check_are_told_as_it_says() {
    for (name, met) in [
        ("gs", true),
        ("gs_5e-5", false),
        ("gs_1.3e-4", false),
        ("gs_2e-4", false),
    ] {
        let Some(bytes) = crate::shared::shared(&format!("theory/{name}.toml")) else {
            return;
        };
        let text = String::from_utf8(bytes).unwrap();
        let found = gap_after_simulate(name, &text).expect("a drive");
        assert_eq!(found.1 > 0, met, "{name}");
        gap_is_right(name, found);
    }
}

#[test]
fn the_cycle_of_a_drive_in_its_gap_by_hand() {
    // m = 8.8e-4, d small, eps = 0.5, k+ = 0.65 and k- = 0.35 less or more friction 0.03:
    // T = m eps (1/0.62 + 1/0.38 + 1/0.68 + 1/0.32), the drift 1/2 m eps^2 (1/0.62 + 1/0.38 - ...).
    let found = limit_cycle("drive-drifting.toml");
    let (p, q) = (1.0 / 0.62 + 1.0 / 0.38, 1.0 / 0.68 + 1.0 / 0.32);
    let exact = &found["exact"][0];
    close(&exact["period"], 8.8e-4 * 0.5 * (p + q), 1e-3);
    close(&exact["drift"], 0.5 * 8.8e-4 * 0.25 * (p - q), 0.03);
    assert_eq!(found["exists"], true);
    assert!(
        found["text"]
            .as_str()
            .unwrap()
            .contains("against the stronger push")
    );
}

#[test]
fn what_is_no_drive_is_one_line_with_its_place() {
    let masses = "motor = { inertia = 1e-3 }\nload = { inertia = 1e-3 }\n";
    let relay = "[relay]\ngain = 0.5\nhysteresis = 0.5\n";
    for (name, content, parts) in [
        (
            "drive-and-plant.toml",
            format!("[drive]\n{masses}half_gap = 0.01\n[plant]\nformula = \"1/s\"\n{relay}"),
            vec!["[drive] as well"],
        ),
        (
            "drive-inertia.toml",
            format!(
                "[drive]\nmotor = {{ inertia = 0.0 }}\nload = {{ inertia = 1e-3 }}\nhalf_gap = 0.01\n{relay}"
            ),
            vec!["[drive]", "motor inertia is 0", "above 0"],
        ),
        (
            "drive-typo.toml",
            format!("[drive]\n{masses}halfgap = 0.01\n{relay}"),
            vec!["line 4", "halfgap", "half_gap"],
        ),
        (
            "drive-flip.toml",
            format!("[drive]\n{masses}half_gap = 0.01\n{relay}flip = -1.0\n"),
            vec!["[relay]", "flip is -1"],
        ),
        (
            "drive-start.toml",
            format!("[drive]\n{masses}half_gap = 0.01\n{relay}[run]\nstart = {{ x1 = 1.0 }}\n"),
            vec!["[run]", "start x1 - x2 is 1", "half gap"],
        ),
    ] {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::write(&path, content).unwrap();
        for command in ["simulate", "limit-cycle"] {
            let output = hysteron(command, &path, &[]);
            let line = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{name}: {line}");
            assert_eq!(line.lines().count(), 1, "{line}");
            for part in &parts {
                assert!(line.contains(part), "{name}: expected '{part}' in: {line}");
            }
        }
    }
}

#[test]
fn a_controller_with_a_dead_zone_heats_waits_and_cools() {
    let found = limit_cycle("heat-off-cool.toml");
    assert_eq!(found["outcome"], "limit_cycle", "{found}");
    let cycle = &found["exact"][0];
    assert_eq!(cycle["stable"], true);
    let positions: Vec<&str> = cycle["positions"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(Value::as_str)
        .collect();
    for position in ["up", "off", "down"] {
        assert!(positions.contains(&position), "{positions:?}");
    }
    let durations = cycle["half_periods"].as_array().unwrap();
    let sum: f64 = durations.iter().filter_map(Value::as_f64).sum();
    close(&cycle["period"], sum, 1e-12);
    for (position, duration) in positions.iter().zip(durations) {
        let shortest = if *position == "off" { 30.0 } else { 60.0 };
        assert!(duration.as_f64().unwrap() >= shortest, "{cycle}");
    }
}

/// A first-order lag of 400 s and 90 K whose heater may not come back for three minutes: it switches at whole seconds,
/// and from these alone follows how warm it becomes. What heats acts 12 s later, for as long.
#[test]
fn a_thermostat_switches_at_whole_seconds() {
    let found = limit_cycle("one-sided-heater.toml");
    let cycle = &found["exact"][0];
    let positions = cycle["positions"].as_array().unwrap();
    let durations = cycle["half_periods"].as_array().unwrap();
    let (mut y, mut range) = (0.0, [0.0; 2]);
    for _ in 0..100 {
        range = [f64::INFINITY, f64::NEG_INFINITY];
        for (position, duration) in positions.iter().zip(durations) {
            let duration = duration.as_f64().unwrap();
            assert!((duration - duration.round()).abs() < 1e-6, "{duration}");
            let goal = if position == "up" { 90.0 } else { 0.0 };
            assert!(position == "up" || duration >= 180.0, "{found}");
            y = goal + (y - goal) * (-duration / 400.0_f64).exp();
            range = [y.min(range[0]), y.max(range[1])];
        }
    }
    close(&cycle["range"][0], range[0], 1e-9);
    close(&cycle["range"][1], range[1], 1e-9);
}

#[test]
fn a_servo_hunts_by_sticking_and_by_play() {
    let found = limit_cycle("hunting-stiction.toml");
    let cycle = &found["exact"][0];
    assert!(cycle["stuck"].as_f64().unwrap() > 0.3, "{found}");
    assert_eq!(cycle["stable"], true);
    let found = limit_cycle("hunting-play.toml");
    let cycle = &found["exact"][0];
    assert_eq!(cycle["stable"], true);
    let predicted = found["describing_function"].as_array().unwrap();
    let period = cycle["period"].as_f64().unwrap();
    let near = |b: &&Value| (b["period"].as_f64().unwrap() / period - 1.0).abs() < 0.1;
    assert!(
        predicted.iter().any(|b| near(&b) && b["stable"] == true),
        "{found}"
    );
}

#[test]
fn what_is_wrong_with_a_controller_is_one_line() {
    let cases = [
        ("[relay]\ngain = 1.0\nmin_off = -1.0", "min_off"),
        (
            "[relay]\nlevels = [0.0, 1.0]\ngain = 1.0\nsampling = 1.0",
            "levels",
        ),
        ("[relay]\ndead_zone = 1.0", "gain"),
    ];
    let folder = std::env::temp_dir();
    for (i, (relay, word)) in cases.into_iter().enumerate() {
        let path = folder.join(format!("hysteron-on-off-{i}-{}.toml", std::process::id()));
        let plant = "[plant]\nformula = \"1/(s+1)^3\"\n";
        std::fs::write(&path, format!("{plant}{relay}\n")).unwrap();
        let output = hysteron("limit-cycle", &path, &[]);
        std::fs::remove_file(&path).unwrap();
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            said.contains(word) && said.trim().lines().count() == 1,
            "{said}"
        );
    }
}
