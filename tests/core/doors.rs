//! Files as loggers, spreadsheets and programs write them are read at once, or refused with the words that read them.

use crate::support::shared::shared;
use hysteron_core::measurement::{
    ImportError, ImportOptions, Kind, Measurement, Period, columns, guess, import,
};
use proptest::prelude::*;
use std::fmt::Write as _;

fn read(text: &str) -> Result<Measurement, ImportError> {
    import("rig.csv", text.as_bytes(), &ImportOptions::default())
}

#[track_caller]
fn accepted(text: &str) -> Measurement {
    read(text).unwrap_or_else(|e| panic!("{e}"))
}

/// What stands between these in a text.
fn between<'a>(text: &'a str, before: &str, after: &str) -> Option<&'a str> {
    Some(text.split_once(before)?.1.split_once(after)?.0)
}

/// The options that the advice of an error stands for, one for each way to fill in what it leaves open.
fn all_advised(error: &ImportError) -> Vec<ImportOptions> {
    let Some(advice) = error.advice.as_deref() else {
        return Vec::new();
    };
    let map = between(advice, "--map \"", "\"").or_else(|| between(advice, "--map '", "'"));
    let kind = between(advice, "--kind ", " ").map(|kind| match kind {
        "drive" => Kind::Drive,
        _ => Kind::Process,
    });
    let open = ["two of ", "one of "]
        .iter()
        .find_map(|of| between(advice, of, " for "));
    let names: Vec<&str> = open.map_or_else(Vec::new, |open| open.split(", ").collect());
    let one = |first: &str, second: &str| {
        let [input, output] = if advice.contains("=INPUT") {
            [first, second]
        } else {
            ["", first]
        };
        let map = map?.replace("=INPUT", &format!("={input}"));
        Some(ImportOptions {
            kind,
            mapping: map.replace("=OUTPUT", &format!("={output}")).parse().ok()?,
            period: between(advice, "--period ", " ").and_then(|p| p.parse().ok()),
            torque_constant: None,
        })
    };
    match names.as_slice() {
        [] => one("", "").into_iter().collect(),
        names => {
            let pairs = names
                .iter()
                .flat_map(|first| names.iter().map(move |second| (first, second)));
            let apart = pairs.filter(|(first, second)| first != second || names.len() == 1);
            apart
                .filter_map(|(first, second)| one(first, second))
                .collect()
        }
    }
}

/// The first of them.
fn advised(error: &ImportError) -> Option<ImportOptions> {
    all_advised(error).into_iter().next()
}

/// Refused with words that read it.
#[track_caller]
fn read_with_advice(bytes: &[u8], words: &str) -> Measurement {
    let error = import("rig", bytes, &ImportOptions::default()).expect_err("must be refused");
    let line = error.to_string();
    assert!(
        line.contains(words) && !line.contains('\n'),
        "expected '{words}' in: {line}"
    );
    let options = advised(&error).unwrap_or_else(|| panic!("no advice: {line}"));
    import("rig", bytes, &options).unwrap_or_else(|e| panic!("{e}"))
}

/// Rows made of their number.
fn rows(count: usize, row: impl Fn(usize) -> String) -> String {
    (0..count).fold(String::new(), |mut text, k| {
        let _ = writeln!(text, "{}", row(k));
        text
    })
}

/// A heater that is on for five samples and off for five, and what it warms.
fn on(k: usize) -> bool {
    k % 10 < 5
}

fn warmth(k: usize) -> f64 {
    20.0 + (k % 10) as f64 * 0.5
}

#[track_caller]
fn is_the_heater(m: &Measurement, step: f64) {
    assert_eq!((m.kind, m.len()), (Kind::Process, 40));
    for k in 0..40 {
        assert!(
            (m.time[k] - k as f64 * step).abs() < 1e-6 * step,
            "{} at {k}",
            m.time[k]
        );
        assert_eq!(m.input.values[k], f64::from(u8::from(on(k))));
        assert_eq!(m.outputs[0].values[k], warmth(k));
    }
}

#[test]
fn times_are_dates_or_counted_from_1970() {
    let table = |time: &dyn Fn(usize) -> String| {
        let row = |k| format!("{},{},{}", time(k), u8::from(on(k)), warmth(k));
        format!("timestamp,heater,temperature\n{}", rows(40, row))
    };
    let dates: [(&str, &dyn Fn(usize) -> String); 5] = [
        ("a zone", &|k| {
            format!("2025-01-01T23:59:{:02}.250Z", 10 + k)
        }),
        ("no zone, past midnight", &|k| {
            let (day, second) = if k < 20 { (1, 40 + k) } else { (2, k - 20) };
            let minute = if k < 20 { "23:59" } else { "00:00" };
            format!("2025-01-0{day} {minute}:{second:02}")
        }),
        ("a time of day, past midnight", &|k| {
            let (minute, second) = if k < 20 {
                ("23:59", 40 + k)
            } else {
                ("00:00", k - 20)
            };
            format!("{minute}:{second:02}.5")
        }),
        ("seconds", &|k| format!("{}.5", 1_700_000_000 + k)),
        ("nanoseconds", &|k| {
            format!("{}", 1_700_000_000_000_000_001 + k as u64 * 1_000_000_000)
        }),
    ];
    for (habit, time) in dates {
        let m = accepted(&table(time));
        is_the_heater(&m, 1.0);
        let said = m.warnings.iter().any(|w| {
            w.to_string().contains("dates or times of day") || w.to_string().contains("from 1970")
        });
        assert!(said, "{habit}: {:?}", m.warnings);
    }
    let milli = |k: usize| format!("{}", 1_700_000_000_000_u64 + k as u64 * 100);
    is_the_heater(&accepted(&table(&milli)), 0.1);
    // A double has not the digits of the whole number that tell these apart as they are.
    let fast = |k: usize| format!("{}", 1_700_000_000_000_000_001_u64 + k as u64 * 1000);
    is_the_heater(&accepted(&table(&fast)), 1e-6);
    let german = rows(40, |k| {
        let temperature = format!("{:.1}", warmth(k)).replace('.', ",");
        format!(
            "31.12.2025 10:00:{k:02};{};{temperature}",
            if on(k) { "ein" } else { "aus" }
        )
    });
    is_the_heater(
        &accepted(&format!("Zeit;Heizung;Temperatur\n{german}")),
        1.0,
    );
}

#[test]
fn states_are_one_and_zero() {
    for (one, zero) in [
        ("True", "False"),
        ("on", "off"),
        ("YES", "no"),
        ("open", "closed"),
        ("ein", "aus"),
    ] {
        let row = |k| format!("{k},{},{}", if on(k) { one } else { zero }, warmth(k));
        is_the_heater(
            &accepted(&format!("time,heater_on,t1\n{}", rows(40, row))),
            1.0,
        );
    }
    let state = |k| {
        if k == 13 {
            "maybe"
        } else {
            ["off", "on"][usize::from(on(k))]
        }
    };
    let row = |k| format!("{k},{},{}", state(k), warmth(k));
    let error = read(&format!("time,heater_on,t1\n{}", rows(40, row))).expect_err("no state");
    assert!(
        error.to_string().contains("'maybe' is not a number"),
        "{error}"
    );
}

#[test]
fn a_period_stands_for_times() {
    let table = rows(40, |k| format!("{},{}", u8::from(on(k)), warmth(k)));
    let with = |head: &str, period: &str| {
        let period: Period = period.parse().expect("a period");
        let options = ImportOptions {
            period: Some(period),
            ..ImportOptions::default()
        };
        import("rig.csv", format!("{head}\n{table}").as_bytes(), &options)
            .unwrap_or_else(|e| panic!("{e}"))
    };
    is_the_heater(&with("u,y", "4s"), 4.0);
    is_the_heater(&with("u,y", "100Hz"), 0.01);
    read_with_advice(
        format!("u,y\n{table}").as_bytes(),
        "--period 1s --map \"u=u, y=y\" with the true period",
    );
    // A column that has it, in its first row or in all.
    for rest in ["", "4"] {
        let row = |k| {
            format!(
                "{},{},{}",
                u8::from(on(k)),
                warmth(k),
                if k == 0 { "4" } else { rest }
            )
        };
        for name in ["Ts", "dt [s]", "sampling time"] {
            let m = accepted(&format!("u,y,{name}\n{}", rows(40, row)));
            is_the_heater(&m, 4.0);
            assert!(
                m.warnings
                    .iter()
                    .any(|w| w.to_string().contains("sampling period, 4 s")),
                "{:?}",
                m.warnings
            );
        }
        let m = accepted(&format!("u,y,Ts [min]\n{}", rows(40, row)));
        is_the_heater(&m, 240.0);
    }
    // A period that changes is none.
    let row = |k| format!("{},{},{k}", u8::from(on(k)), warmth(k));
    let changing = format!("u,y,Ts\n{}", rows(40, row));
    read_with_advice(changing.as_bytes(), "no column 't'");
}

#[test]
fn a_device_says_much_before_its_numbers() {
    let table = rows(40, |k| {
        format!("{}.0,{}.0,{},0", k * 1000, u8::from(on(k)), warmth(k))
    });
    for head in [
        "Recorder 7\nSamples,40\nInterval(ms),1000\nTime,Channel 1,Channel 2,Channel 3\nms,heater,temperature,-\n",
        "Recorder 7,,,\n,,,\nTime [ms],heater,temperature,-\n",
        "Recorder 7\n\nTime,heater,temperature,-\nms,%,degC,-\n",
        "a;b\nc,d\nTime [ms],heater,temperature,-\n",
        "[Header]\nDevice=7\n[Data]\nTime [ms],heater,temperature,-\n",
        "\"Time, of day [ms]\",\"heater, left\",\"temperature, right\",\"-\"\n",
    ] {
        is_the_heater(&accepted(&format!("{head}{table}")), 1.0);
    }
    // Channels are called by their numbers too.
    let head = "Recorder 7\nTime,Channel 1,Channel 2,Channel 3\nms,this,that,-\n";
    let options = ImportOptions {
        mapping: "u=Channel 1, y=that".parse().expect("a mapping"),
        ..ImportOptions::default()
    };
    let m = import("rig.csv", format!("{head}{table}").as_bytes(), &options)
        .unwrap_or_else(|e| panic!("{e}"));
    is_the_heater(&m, 1.0);
    // A drive needs the units that stand nowhere.
    let head = "Axis 1\nTime,Analog 1,Analog 2,Analog 3\nms,Torque,Motor speed,Not selected\n";
    read_with_advice(
        format!("{head}{table}").as_bytes(),
        "--map \"t=Time, u=Torque [N m], v1=Motor speed [rad/s]\" with the true units",
    );
}

#[test]
fn the_only_column_left_is_the_input() {
    let table = |head: &str| {
        let row = |k| format!("{k},{},{},7,{k}", u8::from(on(k)), warmth(k));
        format!("{head},still,index\n{}", rows(40, row))
    };
    is_the_heater(&accepted(&table("time,control,temperature")), 1.0);
    is_the_heater(&accepted(&table("time,whatever,temperature")), 1.0);
    is_the_heater(&accepted(&table("Zeit,Stellgröße,Temperatur")), 1.0);
    // What was only wanted is no input.
    read_with_advice(
        table("time,setpoint,temperature").as_bytes(),
        "no column 'u'",
    );
}

/// What a refused file is advised.
fn advice(text: &str) -> String {
    let advice = read(text).expect_err("must be refused").advice;
    advice.map_or_else(String::new, Into::into)
}

/// A process with this first column, its input and its output, two columns that say nothing of themselves.
fn table(head: &str, input: impl Fn(usize) -> f64) -> String {
    let mut y = 20.0;
    let row = |k: usize| {
        y += 0.1 * (20.0 + 30.0 * input(k) - y);
        format!("{k},{y:.4},{}\n", input(k))
    };
    let body: String = (0..200).map(row).collect();
    format!("{head}\n{body}")
}

#[test]
fn a_hint_takes_what_goes_in_steps_for_the_input_and_invents_nothing() {
    let steps = |k: usize| (k / 40 % 2) as f64;
    let hint = advice(&table("t [s],Data,entry", steps));
    assert_eq!(hint, "--map \"t=t, u=entry, y=Data\"");
    let hint = advice(&table("-1,20,0", steps));
    assert!(
        hint.contains("t=column 1 [s], u=column 3, y=column 2"),
        "{hint}"
    );
    let hint = advice(&table("-1,20,3", |_| 3.0));
    assert!(
        hint.contains("t=column 1 [s], u=column 3, y=column 2"),
        "{hint}"
    );
    // A flow or an angle, an angle or a temperature: who made the file knows.
    let noise = |k: usize| wavy(k * k);
    let text = table("ts,q,th", noise);
    let hint = advice(&text);
    assert_eq!(
        hint,
        "--map \"t=ts [s], u=INPUT, y=OUTPUT\" with the true units, and with two of q, th for INPUT and OUTPUT"
    );
    // What goes in steps may have been wanted only, where there are more columns than an input and an output.
    let row = |k: usize| format!("{},{},{}\n", k / 50 % 2, noise(k), noise(k + 1));
    let body: String = (0..200).map(row).collect();
    let hint = advice(&format!("Channel 1,Channel 2,Channel 3\n{body}"));
    let all =
        "two of Channel 1, Channel 2, Channel 3 for INPUT and OUTPUT (Channel 1 goes in steps";
    assert!(hint.contains(all), "{hint}");
    // An acceleration is no position, whatever its x means.
    let hint = advice(&table("t [s],AccX [g],torque [N m]", noise));
    assert!(!hint.contains("x1=AccX"), "{hint}");
}

/// A signal without steps.
fn wavy(k: usize) -> f64 {
    (k as f64).sin()
}

#[test]
fn a_temperature_comes_out_whatever_else_its_name_says() {
    let row = |k| format!("{k},{:.1},{}", warmth(k), 100 * u8::from(on(k)));
    let text = format!("time,current_temp_c,ssr_output_percent\n{}", rows(40, row));
    let m = accepted(&text);
    assert_eq!(
        (m.input.name.as_str(), m.outputs[0].name.as_str()),
        ("ssr_output_percent", "current_temp_c")
    );
}

#[test]
fn lines_in_quotes_are_read() {
    let row = |k| format!("\"{k}, {}, {}\"", u8::from(on(k)), warmth(k));
    is_the_heater(
        &accepted(&format!("\"t [s], u, y\"\n{}", rows(40, row))),
        1.0,
    );
}

#[test]
fn a_step_from_rest_needs_no_row_before_it() {
    let row = |k: usize| format!("{},5,{}", k as f64 * 0.5, 1.0 - (-0.1 * k as f64).exp());
    let m = accepted(&format!("t [s],u [N m],v1 [rad/s]\n{}", rows(60, row)));
    assert_eq!((m.len(), m.time[0], m.input.values[0]), (61, -0.5, 0.0));
    assert_eq!((m.input.values[1], m.outputs[0].values[0]), (5.0, 0.0));
    assert!(
        m.warnings
            .iter()
            .any(|w| w.to_string().starts_with("The input is constant"))
    );
    // Diagnosed as any other.
    assert!(hysteron_core::criticism::DiagnosisJob::new(&m).is_ok());
    // What moves at first already is no step from rest.
    let row = |k: usize| format!("{},5,{}", k as f64 * 0.5, 2.0 - (-0.1 * k as f64).exp());
    let m = accepted(&format!("t [s],u [N m],v1 [rad/s]\n{}", rows(60, row)));
    assert_eq!(m.len(), 60);
}

#[test]
fn runs_in_one_file_follow_one_another() {
    let row = |k: usize| {
        format!(
            "{},{},{}",
            (k % 60) as f64 * 0.5,
            1 + k / 60,
            (k % 60) as f64
        )
    };
    let drive = format!("t [s],u [N m],v1 [rad/s]\n{}", rows(180, row));
    let m = accepted(&drive);
    assert_eq!(
        (m.len(), m.time[59], m.time[60], m.time[61]),
        (180, 29.5, 34.5, 35.0)
    );
    assert_eq!(hysteron_core::measurement::gaps(&m.time), [60, 120]);
    assert!(
        m.warnings.iter().any(|w| w.to_string().contains("3 runs")),
        "{:?}",
        m.warnings
    );
    let process = drive.replace("u [N m],v1 [rad/s]", "u [V],y [K]");
    let error = read(&process).expect_err("what went on between them is not known");
    assert_eq!(error.line, Some(62), "{error}");
    assert!(
        error
            .to_string()
            .contains("save each run in a file of its own"),
        "{error}"
    );
}

#[test]
fn a_clock_that_starts_late_costs_its_first_rows() {
    let row = |k: usize| match k.checked_sub(2) {
        None => format!("0,1,{}", 19 + k),
        Some(k) => format!("{k},{},{}", u8::from(on(k)), warmth(k)),
    };
    is_the_heater(&accepted(&format!("t [s],u,y\n{}", rows(42, row))), 1.0);
    // Two values at one time later on are a coarse clock.
    let row = |k: usize| format!("{},{},{}", k / 2, u8::from(on(k)), warmth(k));
    let error = read(&format!("t [s],u,y\n{}", rows(80, row))).expect_err("a coarse clock");
    assert!(
        error.to_string().contains("give the sampling period"),
        "{error}"
    );
}

#[test]
fn what_a_mapping_leaves_out_and_is_used_by_its_name_is_said() {
    let row = |k: usize| format!("{k},{},{k},{}", k % 3, k % 5);
    let text = format!("t [s],u [N m],x1 [rad],speed_2 [rad/s]\n{}", rows(40, row));
    let mapped = |map: &str| {
        let options = ImportOptions {
            mapping: map.parse().expect("a mapping"),
            ..ImportOptions::default()
        };
        import("rig.csv", text.as_bytes(), &options).unwrap_or_else(|e| panic!("{e}"))
    };
    let m = mapped("v1=speed_2");
    assert_eq!(m.outputs.len(), 2);
    let said =
        "The column 'x1' is used as well, because of its name: x1=- in the mapping leaves it out.";
    assert!(m.warnings.iter().any(|w| *w == said), "{:?}", m.warnings);
    let m = mapped("v1=speed_2,x1=-");
    assert_eq!(m.outputs.len(), 1);
    assert!(
        !m.warnings.iter().any(|w| w.to_string().contains("as well")),
        "{:?}",
        m.warnings
    );
}

#[test]
fn rows_that_are_there_twice_are_read_once() {
    let row = |k| format!("{},{},{}", k / 2, u8::from(on(k / 2)), warmth(k / 2));
    let m = accepted(&format!("t [s],u,y\n{}", rows(80, row)));
    is_the_heater(&m, 1.0);
    assert!(
        m.warnings
            .iter()
            .any(|w| w.to_string().starts_with("40 rows repeat")),
        "{:?}",
        m.warnings
    );
    // Other values at the same time are a contradiction.
    let row = |k| format!("{},{},{}", k / 2, u8::from(on(k)), warmth(k));
    assert!(read(&format!("t [s],u,y\n{}", rows(80, row))).is_err());
}

#[test]
fn numbers_are_read_with_their_units_behind_them() {
    let state = |k: usize| u8::from(on(k));
    let cell = |k: usize| format!("{k} s;{} %;{} °C", state(k), warmth(k));
    let text = rows(40, cell);
    is_the_heater(&accepted(&format!("time;heater;temperature\n{text}")), 1.0);
    // Of one unit only.
    let mixed = text.replace("7 s;0 %", "7 s;0 V");
    let error = read(&format!("time;heater;temperature\n{mixed}")).expect_err("two units");
    let said = "line 9, column 2 (heater): '0 V' is not a number";
    assert!(error.to_string().contains(said), "{error}");
}

#[test]
fn thousands_may_be_parted_where_the_decimals_have_the_other_mark() {
    let cell = |k: usize| {
        let decimals = format!("{:.1}", warmth(k)).replace('.', ",");
        format!("{k};{};2.0{decimals}", u8::from(on(k)))
    };
    let text = rows(40, cell);
    let read = accepted(&format!("t;heater;pressure\n{text}"));
    for (k, pressure) in read.outputs[0].values.iter().enumerate() {
        assert!((pressure - 2000.0 - warmth(k)).abs() < 1e-9, "{pressure}");
    }
}

#[test]
fn a_cell_that_is_no_number_is_said_where_it_stands() {
    let cell = |k: usize| format!("{k},{},\"{},5\"", u8::from(on(k)), 20 + k % 10);
    let error = read(&format!("time,heater,temperature\n{}", rows(40, cell)));
    let error = error.expect_err("commas that part the columns and decimals");
    let said = "line 2, column 3 (temperature): '20,5' is not a number";
    assert!(error.to_string().contains(said), "{error}");
}

/// As a spreadsheet saves "Unicode text".
#[test]
fn a_text_in_utf_16_is_read() {
    let cell = |k: usize| format!("{k};{};{}", u8::from(on(k)), warmth(k));
    let text = format!("time;Stellgröße [%];Temperatur [°C]\n{}", rows(40, cell));
    for low_first in [true, false] {
        let order = |unit: u16| {
            if low_first {
                unit.to_le_bytes()
            } else {
                unit.to_be_bytes()
            }
        };
        let mark = order(0xfeff);
        let units: Vec<u8> = text.encode_utf16().flat_map(order).collect();
        let file = [&mark[..], &units].concat();
        let read = import("x.csv", &file, &ImportOptions::default());
        is_the_heater(&read.expect("a record"), 1.0);
        assert_eq!(columns("x.csv", &file).map(|c| c.len()).ok(), Some(3));
    }
}

#[test]
fn names_keep_their_numbers() {
    let row = |k| format!("{k},{},{},{},1", u8::from(on(k)), warmth(k), warmth(k + 3));
    let text = format!(
        "t (s),heater (1),temp (5),temp (6),state (1)\n{}",
        rows(40, row)
    );
    let names: Vec<String> = columns("rig.csv", text.as_bytes())
        .unwrap()
        .into_iter()
        .map(|c| c.name)
        .collect();
    assert_eq!(
        names,
        ["t", "heater (1)", "temp (5)", "temp (6)", "state (1)"]
    );
    let m = read_with_advice(text.as_bytes(), "--map \"t=t, u=heater (1), y=temp (5)\"");
    is_the_heater(&m, 1.0);
    // So does a word that alone tells columns apart; a unit does not.
    let row = |k| format!("{k},{},{},{},7", u8::from(on(k)), warmth(k), warmth(k + 3));
    let text = format!(
        "t (s),heater,temp (left),temp (right),flow (l/min)\n{}",
        rows(40, row)
    );
    let found = columns("rig.csv", text.as_bytes()).unwrap();
    let names: Vec<&str> = found.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        names,
        ["t", "heater", "temp (left)", "temp (right)", "flow"]
    );
    // A plain number is a unit where no other number stands in parentheses.
    let row = |k| format!("{k},{},{}", u8::from(on(k)), warmth(k));
    assert!(
        accepted(&format!("t (s),u (1),y (1)\n{}", rows(40, row)))
            .warnings
            .is_empty()
    );
}

#[test]
fn logs_of_names_with_values_are_read() {
    type Line = fn(usize) -> String;
    let lines: [Line; 4] = [
        |k| format!("t: {k} u: {} y: {}", u8::from(on(k)), warmth(k)),
        |k| format!("t={k}, u={}, y={}", u8::from(on(k)), warmth(k)),
        |k| {
            format!(
                "[info] t: {k} s; u: {} %; y: {} degC; state: running",
                u8::from(on(k)),
                warmth(k)
            )
        },
        |k| {
            format!(
                "time:{k}s heater:{} temp:{}degC",
                if on(k) { "on" } else { "off" },
                warmth(k)
            )
        },
    ];
    for line in lines {
        let m = accepted(&format!("logger 3\n{}", rows(40, line)));
        is_the_heater(&m, 1.0);
    }
    let m = accepted(&rows(40, lines[2]));
    assert_eq!(
        (m.input.unit.as_str(), m.outputs[0].unit.as_str()),
        ("%", "degC")
    );
}

#[test]
fn json_is_read_by_lines_rows_or_columns() {
    let object = |k| {
        format!(
            "{{\"t\": {k}, \"log\": {{\"u\": {}, \"y\": {}}}, \"note\": null}}",
            on(k),
            warmth(k)
        )
    };
    let list = |value: &dyn Fn(usize) -> String| (0..40).map(value).collect::<Vec<_>>().join(",");
    let plain = |k: usize| format!("{{\"t\": {k}, \"u\": {}, \"y\": {}}}", on(k), warmth(k));
    let series = |value: &dyn Fn(usize) -> String| format!("[{}]", list(value));
    let [t, u, y] = [
        series(&|k| k.to_string()),
        series(&|k| on(k).to_string()),
        series(&|k| warmth(k).to_string()),
    ];
    let dates = series(&|k| format!("\"2025-01-01T00:00:{k:02}Z\""));
    for text in [
        rows(40, plain),
        format!("[{}]", list(&plain)),
        format!("{{\"t\": {t}, \"u\": {u}, \"y\": {y}}}"),
        format!("{{\"name\": \"rig\", \"Ts\": 1, \"u\": {u}, \"y\": {y}}}"),
        format!("{{\"time\": {dates}, \"heater\": {u}, \"temp\": {y}}}"),
    ] {
        is_the_heater(&accepted(&text), 1.0);
    }
    for text in [rows(40, object), format!("[{}]", list(&object))] {
        is_the_heater(&accepted(&text), 1.0);
    }
    for (text, said) in [
        ("{\"t\": [1,", "is not JSON"),
        ("[1, 2", "is not JSON"),
        ("{}", "no numbers"),
        ("[[[[", "is not JSON"),
    ] {
        let error = read(text).expect_err("no record").to_string();
        assert!(error.contains(said) && !error.contains('\n'), "{error}");
    }
}

#[test]
fn hdf5_of_matlab_is_read() {
    use hdf5_pure::mat::builder::MatBuilder;
    let mut file = MatBuilder::new(hdf5_pure::mat::Options::default());
    let values = |of: &dyn Fn(usize) -> f64| (0..40).map(of).collect::<Vec<f64>>();
    let (t, u, y) = (
        values(&|k| k as f64),
        values(&|k| f64::from(u8::from(on(k)))),
        values(&warmth),
    );
    file.write_f64("t", &[40, 1], &t).expect("t");
    file.struct_("log", |log| {
        log.write_f64("heater", &[40, 1], &u)?;
        log.write_f64("data", &[40, 2], &[y.clone(), t.clone()].concat())?;
        Ok(())
    })
    .expect("a structure");
    let bytes = file.finish().expect("a file");
    let m = read_with_advice(&bytes, "--map \"t=t [s], u=log.heater, y=OUTPUT\"");
    is_the_heater(&m, 1.0);
}

/// The files of `../shared/failing` that are no tables as they should be, and what is said of them: the words that read
/// them, or nothing where they are read at once.
const FAILING: [(&str, &str); 7] = [
    ("cart-0m20-velocity-printed.csv", ""),
    ("heater-step-plain-header.csv", ""),
    (
        "incubator-exp1-original-head.csv",
        "--map \"t=time [s], u=heater_on, y=t1\"",
    ),
    (
        "tanks-original-no-time-column.csv",
        "--map \"u=uEst, y=yEst\"",
    ),
    (
        "servo-export-preamble.csv",
        "--map \"t=Time, u=Torque [N m], v1=Servo motor speed [rad/s]\"",
    ),
    (
        "iso-time-and-numbered-names.csv",
        "x1=pos (5) [rad], v1=speed (5) [rad/s]\"",
    ),
    (
        "simulink-timeseries.mat",
        "--map \"t=sig_speed.Time, u=sig_volt.Data [V], v1=sig_speed.Data [rad/s]\"",
    ),
];

#[test]
fn files_from_real_work_are_read() {
    for (name, words) in FAILING {
        let Some(bytes) = shared(&format!("failing/{name}")) else {
            continue;
        };
        let m = if words.is_empty() {
            import(name, &bytes, &ImportOptions::default()).unwrap_or_else(|e| panic!("{e}"))
        } else {
            let error = import(name, &bytes, &ImportOptions::default()).expect_err(name);
            assert!(error.to_string().contains(words), "{error}");
            match import(name, &bytes, &advised(&error).expect("advice")) {
                Ok(m) => m,
                // Heads of files are short.
                Err(e) if e.to_string().contains("rows of numbers") => continue,
                Err(e) => panic!("{e}"),
            }
        };
        let step = (m.time[m.len() - 1] - m.time[0]) / (m.len() - 1) as f64;
        assert!((1e-4..10.0).contains(&step), "{name}: {step}");
    }
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        "[a-zA-Zäß][a-zA-Z0-9_ äß.-]{0,12}",
        "(pos|speed|temp|time|heater|u|y|Ts)( \\([0-9]\\))?",
        "(t|u|x1|v1|y|a) \\[(s|ms|N m|rad|counts|rpm|degC|furlong)\\]",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_is_refused_for_its_columns_is_read_with_the_advice(
        names in prop::collection::vec(name(), 3..7),
        separator in prop::sample::select(vec![",", ";", "\t"]),
        kind in prop::sample::select(vec![None, Some(Kind::Process)]),
    ) {
        let row = |k: usize| {
            let value = |i: usize| if i == 0 { k } else { (k * i) % 7 };
            (0..names.len()).map(|i| value(i).to_string()).collect::<Vec<_>>().join(separator)
        };
        let text = format!("{}\n{}", names.join(separator), rows(40, row));
        let options = ImportOptions { kind, ..ImportOptions::default() };
        // A header that ends with a separator has a column less.
        prop_assume!(names.last().is_some_and(|name| !name.is_empty()));
        if let Err(error) = import("rig.csv", text.as_bytes(), &options) {
            let line = error.to_string();
            prop_assert!(!line.contains('\n') && !line.ends_with("has "), "{line}");
            if error.problem.is_about_columns() {
                let ways = all_advised(&error);
                prop_assert!(!ways.is_empty(), "no advice: {line}");
                let settles = |options: &ImportOptions| {
                    let again = import("rig.csv", text.as_bytes(), options);
                    again.map_or_else(|e| !e.problem.is_about_columns(), |_| true)
                };
                prop_assert!(ways.iter().any(settles), "{line}");
            }
        }
    }

    #[test]
    fn any_text_of_these_kinds_is_read_or_refused_in_one_line(
        text in "(\\{|\\[|t[:=]|u|y|[0-9]{1,4}|[.,;: \\n\"\\]}-]|true|off|2025-01-01T10:00:0[0-9]){0,80}",
    ) {
        if let Err(error) = read(&text) {
            let line = error.to_string();
            prop_assert!(!line.contains('\n') && line.len() < 2000, "{line}");
        }
        if let Ok(found) = columns("rig.csv", text.as_bytes()) {
            let guess = guess(&found);
            prop_assert!(guess.channels.iter().all(|(_, i)| *i < found.len()));
        }
    }

    #[test]
    fn damaged_hdf5_is_read_or_refused(
        changes in prop::collection::vec((0_usize..4000, any::<u8>()), 1..6),
        length in 8_usize..6000,
    ) {
        use hdf5_pure::mat::builder::MatBuilder;
        let mut file = MatBuilder::new(hdf5_pure::mat::Options::default());
        let values: Vec<f64> = (0..40_u8).map(f64::from).collect();
        file.write_f64("t", &[40, 1], &values).expect("t");
        let mut bytes = file.finish().expect("a file");
        for (at, value) in changes {
            let at = at % bytes.len();
            bytes[at] = value;
        }
        bytes.truncate(length);
        if let Err(error) = import("rig.mat", &bytes, &ImportOptions::default()) {
            prop_assert!(!error.to_string().contains('\n'));
        }
    }
}
