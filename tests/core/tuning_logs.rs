//! Logs of auto-tuners: one session of each, made here after the public description of its lines.

use std::fmt::Write as _;

use hysteron_core::tuning::measured::log::{Held, Levels, Log, LogError, Source, read, recognise};
use hysteron_core::tuning::measured::{Form, Record, TroubleKind, Wishes};

use crate::support::relay_rig::{plants, relay_test, tests};

fn session(text: &str, source: Source) -> Log {
    assert_eq!(recognise(text), Some(source));
    read("a log", text).unwrap().unwrap()
}

/// A hot end as the bench tests it: about 200 degrees, the input from 0 to 1.
fn heated(test: usize) -> Record {
    let mut record = relay_test(&plants()[3], &tests()[test], 4);
    record
        .output
        .iter_mut()
        .for_each(|y| *y = 200.0 + 20.0 * *y);
    record
}

#[test]
fn the_file_that_klipper_writes_is_a_record() {
    let record = heated(2);
    let mut text = String::new();
    for i in 0..record.time.len() {
        if i == 0 || record.input[i] != record.input[i - 1] {
            writeln!(text, "pwm: {:.3} {:.3}", record.time[i], record.input[i]).unwrap();
        }
    }
    for (t, y) in record.time.iter().zip(&record.output) {
        writeln!(text, "{t:.3} {y:.3}").unwrap();
    }
    let log = session(&text, Source::Klipper);
    assert!(matches!(log.held, Held::Record(_)));
    let result = log.tune(None).unwrap();
    let [gain, period] = plants()[3].ultimate();
    let told = result.ultimate.unwrap();
    assert!(
        (told.gain * 20.0 / gain - 1.0).abs() < 0.05 && (told.period / period - 1.0).abs() < 0.05,
        "{told:?}"
    );
    assert!(
        result
            .gains
            .iter()
            .all(|g| g.form == Form::Klipper && (g.kp - 255.0 * g.pid.gain).abs() < 1e-9 * g.kp)
    );
}

#[test]
fn the_statistics_of_klippy_are_a_record() {
    let record = heated(1);
    let mut text = String::from("Start printer at Mon Jan  1 10:00:00 2024\n");
    for i in 0..record.time.len() {
        let (t, u, y) = (record.time[i] + 2000.0, record.input[i], record.output[i]);
        writeln!(
            text,
            "Stats {t:.1}: gcodein=0  mcu: mcu_awake=0.002 freq=180000017 heater_bed: target=0 temp=23.1 pwm=0.000 \
             sysload=0.10 extruder: target=200 temp={y:.1} pwm={u:.3}"
        )
        .unwrap();
    }
    let log = session(&text, Source::Klipper);
    assert_eq!(log.settings.target, Some(200.0));
    let result = log.tune(None).unwrap();
    let cycle = result.cycle.unwrap();
    assert!(cycle.periods > 5 && result.point.unwrap().std_error_phase_deg < 2.0);
}

#[test]
fn the_lines_of_klippers_tuner_show_a_point_that_is_not_the_ultimate_one() {
    let text = "Autotune: raw=-9.600000/1.000000 Ku=0.265258 Tu=41.200000  Kp=40.584457 Ki=1.970119 Kd=209.009955\n\
                Autotune: raw=9.800000/1.000000 Ku=0.259844 Tu=41.000000  Kp=39.756203 Ki=1.939327 Kd=203.750543\n\
                Autotune: raw=-9.700000/1.000000 Ku=0.262523 Tu=41.100000  Kp=40.166060 Ki=1.954553 Kd=206.353134\n\
                Autotune: final: Kp=40.166060 Ki=1.954553 Kd=206.353134\n";
    let result = session(text, Source::Klipper).tune(None).unwrap();
    let point = result.point.unwrap();
    // Half of peak to peak 4.85 with a hysteresis of 2.5.
    assert!((point.phase_deg + 180.0 - (2.5_f64 / 4.85).asin().to_degrees()).abs() < 1e-9);
    assert!(result.ultimate.is_none());
    // Half of what Klipper says: its relay swings by half the power either way.
    assert!((result.conventional.unwrap().gain - 0.5 * 0.262_523).abs() < 1e-5);
}

#[test]
fn klippers_gains_alone_tell_what_it_read() {
    let text = "PID parameters: pid_Kp=40.166 pid_Ki=1.955 pid_Kd=206.353\n\
                The SAVE_CONFIG command will update the printer config file\n";
    let cycle = session(text, Source::Klipper)
        .tune(None)
        .unwrap()
        .cycle
        .unwrap();
    assert!(
        (cycle.period - 41.1).abs() < 0.02 && (cycle.amplitude - 4.85).abs() < 0.005,
        "{cycle:?}"
    );
}

/// The reports of Marlin in a session, each as the power, 0 to 127, and the temperature make it; and by how much its 2
/// s slow the bench's plant down.
fn reports(report: impl Fn(f64, f64) -> String) -> (f64, String) {
    let record = heated(1);
    let lines = record.input.iter().zip(&record.output);
    let lines = lines.map(|(u, y)| report(127.0 * u, *y) + "\n");
    let text = std::iter::once("PID Autotune start\n".to_owned()).chain(lines);
    (2.0 / record.time[1], text.collect())
}

#[test]
fn the_reports_of_marlin_are_a_record() {
    let (scale, text) = reports(|u, y| format!(" T:{y:.2} /200.00 B:24.10 /0.00 @:{u:.0} B@:0"));
    let result = session(&text, Source::Marlin).tune(None).unwrap();
    let [gain, period] = plants()[3].ultimate();
    let told = result.ultimate.unwrap();
    assert!(
        (told.period / (scale * period) - 1.0).abs() < 0.05,
        "{told:?}"
    );
    assert!(
        (told.gain * 20.0 / 254.0 / gain - 1.0).abs() < 0.05,
        "{told:?}"
    );
    assert!(result.gains.iter().all(|g| g.form == Form::Marlin));
}

#[test]
fn the_bed_is_read_where_marlin_tunes_the_bed() {
    let (scale, text) = reports(|u, y| format!(" T:24.1 /0.00 B:{y:.2} /200.00 @:0 B@:{u:.0}"));
    let log = session(&text, Source::Marlin);
    assert!(matches!(log.held, Held::Record(_)));
    let [_, period] = plants()[3].ultimate();
    let told = log.tune(None).unwrap().ultimate.unwrap();
    assert!(
        (told.period / (scale * period) - 1.0).abs() < 0.05,
        "{told:?}"
    );
}

#[test]
fn the_cycles_of_marlin_lead_to_gains() {
    let text = "PID Autotune start\n bias: 92 d: 92 min: 196.56 max: 203.75\n \
                bias: 90 d: 90 min: 196.64 max: 203.82 Ku: 31.92 Tu: 39.45\n Classic PID\n Kp: 19.15 Ki: 0.97 Kd: \
                94.44\nPID Autotune finished! Put the last Kp, Ki and Kd constants from below into Configuration.h\n";
    let result = session(text, Source::Marlin).tune(None).unwrap();
    let (cycle, told) = (result.cycle.unwrap(), result.ultimate.unwrap());
    assert_eq!(cycle.levels, [0.0, 180.0]);
    assert!(
        (told.gain - 31.92).abs() < 0.01 && told.period == 39.45 && told.std_error_gain > 1.0,
        "{told:?}"
    );
    let classic = result
        .gains
        .iter()
        .find(|g| g.rule == "ziegler_nichols" && g.controller == "pid")
        .unwrap();
    assert!(
        (classic.kp - 19.15).abs() < 0.02 && (classic.kd - 94.44).abs() < 0.1,
        "{classic:?}"
    );
}

#[test]
fn marlins_failure_is_explained() {
    let text = "PID Autotune start\n T:150.0 /200.0 @:127\nPID Autotune failed! timeout\n";
    let said = read("a log", text).unwrap().unwrap_err();
    assert!(matches!(said, LogError::Failed(..)));
    assert!(
        said.to_string().contains("beyond what the heater reaches"),
        "{said}"
    );
}

const ESPHOME: &str = "\
[10:01:02][V][pid.autotune:290]: Autotune: Turning output to 100.0%
[10:01:40][V][pid.autotune:310]:   dt: 40000
[10:01:42][V][pid.autotune:290]: Autotune: Turning output to 0.0%
[10:03:01][V][pid.autotune:310]:   dt: 81000
[10:03:03][V][pid.autotune:290]: Autotune: Turning output to 100.0%
[10:03:41][V][pid.autotune:310]:   dt: 40000
[10:03:43][V][pid.autotune:290]: Autotune: Turning output to 0.0%
[10:05:02][V][pid.autotune:310]:   dt: 81000
[10:05:25][I][pid.autotune:125]: PID Autotune finished!
[10:05:25][I][pid.autotune:141]: PID Autotune:
[10:05:25][I][pid.autotune:142]:   State: Succeeded!
[10:05:25][W][pid.autotune:150]:   Oscillation Frequency is not symmetrical. PID parameters may be inaccurate!
[10:05:25][I][pid.autotune:163]:   Calculated PID parameters (\"Ziegler-Nichols PID\" rule):
[10:05:25][I][pid.autotune:165]:   control_parameters:
[10:05:25][I][pid.autotune:166]:     kp: 0.49822
[10:05:25][I][pid.autotune:167]:     ki: 0.00823
[10:05:25][I][pid.autotune:168]:     kd: 7.53548
";

#[test]
fn esphomes_log_gives_what_it_says() {
    let result = session(ESPHOME, Source::Esphome).tune(None).unwrap();
    let cycle = result.cycle.as_ref().unwrap();
    // kp = 0.6 Ku, ki = 1.2 Ku/Tu, Ku = 4 d/(pi a).
    assert!(
        (cycle.period - 121.0).abs() < 0.2 && (cycle.amplitude - 0.7667).abs() < 1e-3,
        "{cycle:?}"
    );
    assert!(
        result.ultimate.is_none() && result.text.to_string().contains("different length"),
        "{}",
        result.text
    );
    let verbose = format!(
        "{ESPHOME}[V][pid.autotune:172]:   Oscillation Period: 121.0\n[V]:   Oscillation Amplitude: 0.7667\n"
    );
    let cycle = session(&verbose, Source::Esphome)
        .tune(None)
        .unwrap()
        .cycle
        .unwrap();
    assert!(
        (cycle.half_periods[0] - 40.0).abs() < 0.5 && (cycle.half_periods[1] - 81.0).abs() < 0.5,
        "{cycle:?}"
    );
}

#[test]
fn esphomes_info_log_of_an_asymmetric_cycle_gives_no_point_and_no_gains() {
    // Without the times, which only the verbose log has.
    let info: String = ESPHOME
        .lines()
        .filter(|l| !l.contains("][V]["))
        .fold(String::new(), |all, l| all + l + "\n");
    let log = session(&info, Source::Esphome);
    assert_eq!(log.levels, Levels::AssumedByGain);
    let result = log.tune(None).unwrap();
    assert!(
        result.point.is_none() && result.gains.is_empty() && result.cycle.is_some(),
        "{}",
        result.text
    );
    assert!(
        result
            .troubles
            .iter()
            .any(|t| t.kind == TroubleKind::Asymmetric),
        "{}",
        result.text
    );
    assert!(
        result.text.to_string().contains("0 and 1 were assumed"),
        "{}",
        result.text
    );
    // One that found nothing wrong gives both.
    let symmetric = info.replace(
        "Oscillation Frequency is not symmetrical",
        "All checks passed!",
    );
    let result = session(&symmetric, Source::Esphome).tune(None).unwrap();
    assert!(result.point.is_some(), "{}", result.text);
}

#[test]
fn esphomes_stretch_belongs_to_the_output_in_the_middle_of_it() {
    // A slow sensor: the relay turns in the update in which the set point is crossed, and the turn is written first.
    let mut text = String::new();
    let mut clock = 0;
    for k in 0..6 {
        for (wait, output, dt) in [(60, "0.0", 60_000), (240, "100.0", 240_000)] {
            clock += wait;
            let (m, s) = (clock / 60, clock % 60);
            writeln!(
                text,
                "[10:{m:02}:{s:02}][V][pid.autotune:290]: Autotune: Turning output to {output}%"
            )
            .unwrap();
            if k > 0 {
                writeln!(text, "[10:{m:02}:{s:02}][V][pid.autotune:314]:   dt: {dt}").unwrap();
            }
        }
    }
    text +=
        "[V][pid.autotune:172]:   Oscillation Period: 300.0\n[V]:   Oscillation Amplitude: 1.8\n";
    let log = session(&text, Source::Esphome);
    assert_eq!(log.levels, Levels::Told);
    let cycle = log.tune(None).unwrap().cycle.unwrap();
    // Up from the line with 100 % to that with 0 %.
    assert_eq!(cycle.half_periods, [60.0, 240.0]);
}

#[test]
fn an_autotune_that_still_runs_has_not_given_up() {
    let text = "[10:00:00][I][pid.autotune:190]: PID Autotune:\n\
                [10:00:00][I][pid.autotune:190]:   Autotune is still running!\n";
    let said = read("a log", text).unwrap().unwrap_err().to_string();
    assert!(
        said.starts_with("the log ends before the result") && !said.contains("gave up"),
        "{said}"
    );
}

/// An ultimate gain of 0.02 at 300 s under a relay of 0 and 100: the amplitude is `4 100/(pi 0.02)` by the tuner.
const THERMOSTAT: [f64; 2] = [0.02, 300.0];

#[test]
fn home_assistants_gains_alone_tell_what_it_read() {
    let [gain, period] = THERMOSTAT;
    let kp = gain / 34.0;
    let line = |rule: &str, kp: f64| {
        format!(
            "2024-02-28 22:39:20.876 WARNING (MainThread) [custom_components.smart_thermostat.climate] Smart \
             thermostat Living (climate.living) PID Autotuner output with {rule} rule: Kp={kp}, Ki={}, Kd={}\n",
            kp / (period / 40.0),
            kp * period / 160.0
        )
    };
    let text = line("ziegler-nichols", kp) + &line("tyreus-luyben", gain / 44.0);
    let log = session(&text, Source::Mycodo);
    let result = log.tune(None).unwrap();
    let cycle = result.cycle.as_ref().unwrap();
    let amplitude = 400.0 / (std::f64::consts::PI * gain);
    assert!(
        (cycle.period / period - 1.0).abs() < 1e-9
            && (cycle.amplitude / amplitude - 1.0).abs() < 1e-9
            && cycle.levels == [0.0, 100.0],
        "{cycle:?}"
    );
    assert!(
        result.text.to_string().contains("0 and 100 were assumed"),
        "{}",
        result.text
    );
    // Half of the tuner's: the relay swings by 50 either way.
    assert!((result.conventional.unwrap().gain / (0.5 * gain) - 1.0).abs() < 1e-9);
    // Levels of the user's: the amplitude is in proportion to the step.
    let wishes = Wishes {
        levels: Some([0.0, 40.0]),
        ..Wishes::default()
    };
    let result = log.clone().with(&wishes).unwrap().tune(None).unwrap();
    let cycle = result.cycle.as_ref().unwrap();
    assert!(
        (cycle.amplitude / (0.4 * amplitude) - 1.0).abs() < 1e-9 && cycle.levels == [0.0, 40.0]
    );
    assert!(
        !result.text.to_string().contains("assumed"),
        "{}",
        result.text
    );
}

#[test]
fn mycodos_info_log_tells_the_times_and_the_levels() {
    let [gain, period] = THERMOSTAT;
    let mut text = String::new();
    // Up for 100 s, down for 200 s, written every 10 s.
    for i in 0..150 {
        let s = 10 * i;
        let stamp = format!(
            "2024-02-28 22:{:02}:{:02},876 - mycodo.pid_3b8a1c2f - INFO -",
            10 + s / 60,
            s % 60
        );
        let (word, output) = if s % 300 < 100 {
            ("up", 60)
        } else {
            ("down", 0)
        };
        writeln!(
            text,
            "{stamp} state: relay step {word}\n{stamp} output: {output}"
        )
        .unwrap();
    }
    let stamp = "2024-02-28 22:59:59,876 - mycodo.pid_3b8a1c2f - INFO -";
    for (rule, kp) in [("ziegler-nichols", gain / 34.0), ("brewing", gain / 2.5)] {
        writeln!(
            text,
            "{stamp} rule: {rule}\n{stamp} Kp: {kp}\n{stamp} Ki: {}\n{stamp} Kd: 1",
            kp / (period / 40.0)
        )
        .unwrap();
    }
    let log = session(&text, Source::Mycodo);
    assert_eq!(log.levels, Levels::Told);
    let cycle = log.tune(None).unwrap().cycle.unwrap();
    assert_eq!(
        (cycle.period, cycle.half_periods, cycle.levels),
        (300.0, [100.0, 200.0], [0.0, 60.0])
    );
    let amplitude = 4.0 * 60.0 / (std::f64::consts::PI * gain);
    assert!(
        (cycle.amplitude / amplitude - 1.0).abs() < 1e-9,
        "{cycle:?}"
    );
}

#[test]
fn levels_are_asked_for_only_where_a_log_does_not_say_them() {
    let wishes = Wishes {
        levels: Some([0.0, 0.6]),
        ..Wishes::default()
    };
    // The console has the gains at full power; with 0.6 of it they come from 0.6 of the amplitude.
    let text = "PID parameters: pid_Kp=40.166 pid_Ki=1.955 pid_Kd=206.353\n";
    let log = session(text, Source::Klipper);
    let said = log.tune(None).unwrap().text;
    assert!(said.to_string().contains("0 and 1 were assumed"), "{said}");
    let cycle = log
        .with(&wishes)
        .unwrap()
        .tune(None)
        .unwrap()
        .cycle
        .unwrap();
    assert!((cycle.amplitude - 0.6 * 4.85).abs() < 0.005, "{cycle:?}");
    let text =
        "Autotune: raw=-9.600000/0.600000 Ku=0.159155 Tu=41.200000  Kp=24.3 Ki=1.18 Kd=125.4\n";
    let said = session(text, Source::Klipper).with(&wishes).unwrap_err();
    assert_eq!(said, LogError::Levels);
}

/// Lines of the tuner that Mycodo and Home Assistant's thermostats share, after a clock in their own form.
fn shared_tuner(stamp: impl Fn(u32) -> String) -> String {
    let mut text = String::new();
    let mut at = 0;
    for k in 0..6 {
        let rows = [
            (90, "switched state: relay step down".to_owned()),
            (0, "input: 32.52".to_owned()),
            (
                60,
                format!("found peak: {}", if k % 2 == 0 { 34.0 } else { 34.1 }),
            ),
            (0, format!("peak count: {}", 2 * k + 1)),
            (120, "switched state: relay step up".to_owned()),
            (0, "input: 31.48".to_owned()),
            (30, "found peak: 31.05".to_owned()),
            (0, format!("peak count: {}", 2 * k + 2)),
        ];
        for (wait, line) in rows {
            at += wait;
            writeln!(text, "{}{line}", stamp(at)).unwrap();
        }
    }
    text
}

#[test]
fn mycodos_log_gives_the_cycle_and_what_is_wrong_with_its_gains() {
    let stamp = |s: u32| {
        format!(
            "2024-02-28 23:{:02}:{:02},876 - mycodo.pid_autotune - INFO - ",
            10 + s / 60,
            s % 60
        )
    };
    let mut text = shared_tuner(stamp);
    // 4 step/(pi a) with a step of 10, divided by 34.
    text += "2024-02-28 23:59:00,000 - mycodo.pid_autotune - INFO - amplitude: 1.5\n\
             2024-02-28 23:59:00,001 - mycodo.pid_3b - INFO - state: succeeded\n\
             2024-02-28 23:59:00,002 - mycodo.pid_3b - INFO - rule: ziegler-nichols\n\
             2024-02-28 23:59:00,003 - mycodo.pid_3b - INFO - Kp: 0.249654\n";
    let result = session(&text, Source::Mycodo).tune(None).unwrap();
    let cycle = result.cycle.as_ref().unwrap();
    assert_eq!(cycle.period, 300.0);
    assert_eq!(cycle.half_periods, [120.0, 180.0]);
    assert!(
        (cycle.levels[1] - 10.0).abs() < 1e-4 && (cycle.hysteresis - 0.52).abs() < 1e-9,
        "{cycle:?}"
    );
    assert!(
        result
            .text
            .to_string()
            .contains("twice as large as it should be")
            && result.text.to_string().contains("20 times"),
        "{}",
        result.text
    );
    assert!(!result.gains.is_empty());
}

#[test]
fn home_assistants_log_is_read_alike_past_midnight() {
    let stamp = |s: u32| {
        let s = s + 86_400 - 400;
        let (day, s) = (1 + s / 86_400, s % 86_400);
        format!(
            "2024-03-{day:02} {:02}:{:02}:{:02}.120 DEBUG (MainThread) [custom_components.smart_thermostat] ",
            s / 3600,
            s / 60 % 60,
            s % 60
        )
    };
    let cycle = session(&shared_tuner(stamp), Source::Mycodo)
        .tune(None)
        .unwrap()
        .cycle
        .unwrap();
    assert_eq!((cycle.period, cycle.half_periods), (300.0, [120.0, 180.0]));
}

#[test]
fn a_garbled_log_gets_one_clear_sentence() {
    for (text, part) in [
        (
            "PID_CALIBRATE HEATER=extruder TARGET=200\n// pid_Kp=4?? pid_Ki=\n",
            "pid_Kp=... pid_Ki=... pid_Kd=...",
        ),
        (
            "PID Autotune start\n bias: 9\u{0}2 d: min max\n",
            "'bias: ... d: ... min: ... max: ...'",
        ),
        ("[I][pid.autotune:125]: PID Auto", "'kp: ...' and 'ki: ...'"),
        ("found peak: 12\nfound pe", "'switched state: ...'"),
    ] {
        let said = read("a log", text).unwrap().unwrap_err().to_string();
        assert!(
            said.contains(part)
                && said.starts_with("this looks like a log of")
                && !said.contains('\n'),
            "{said}"
        );
    }
    let cannot = "PID parameters: pid_Kp=40.1 pid_Ki=-1.9 pid_Kd=206.3\n";
    let said = read("a log", cannot).unwrap().unwrap().tune(None);
    let said = said.unwrap_err().to_string();
    assert!(
        said.starts_with(
            "this looks like a log of Klipper PID_CALIBRATE, but it cannot be used: the period is "
        ),
        "{said}"
    );
    assert!(read("a table", "t [s],u [1],y [1]\n0,1,2\n").is_none());
}
