//! Measurements as people have them go in; SI units, or one line that says what to correct, come out.

use hysteron_core::measurement::{
    ImportOptions, Kind, MIN_SAMPLES, Measurement, Motion, Quantity, import as import_with,
    import_csv,
};
use hysteron_core::message::Message;
use proptest::prelude::*;
use std::fmt::Write as _;

const HEADER: &str = "t [s],u [N m],x1 [rad],v1 [rad/s]";

/// A header and `rows` rows: time 0, 1, 2, ..., every other column 2.
fn file(header: &str, rows: usize) -> String {
    let columns = header.matches(" [").count();
    let mut text = format!("{header}\n");
    for i in 0..rows {
        let _ = writeln!(text, "{i}{}", ",2".repeat(columns - 1));
    }
    text
}

fn import(text: &str) -> Measurement {
    import_csv("rig.csv", text.as_bytes(), None).unwrap_or_else(|e| panic!("{e}"))
}

/// The message of a file that must be refused: always one line that begins with the file.
fn refusal(bytes: &[u8]) -> String {
    let line = import_csv("rig.csv", bytes, None)
        .expect_err("must be refused")
        .to_string();
    assert!(
        line.starts_with("rig.csv") && !line.contains('\n'),
        "{line:?}"
    );
    line
}

#[track_caller]
fn refused(text: &str, parts: &[&str]) {
    let line = refusal(text.as_bytes());
    for part in parts {
        assert!(line.contains(part), "expected '{part}' in: {line}");
    }
}

/// A valid file with one of its data rows replaced; row 5 stands on line 7.
fn with_row_5(row: &str) -> String {
    file(HEADER, 30).replace("\n5,2,2,2\n", &format!("\n{row}\n"))
}

#[track_caller]
fn si(header: &str, quantity: Quantity, unit: &str, value: f64) {
    let m = import(&file(header, 30));
    let channel = std::iter::once(&m.input)
        .chain(&m.outputs)
        .chain(&m.reference)
        .find(|c| c.quantity == quantity)
        .unwrap_or_else(|| panic!("{header} has no {quantity:?}"));
    assert_eq!(channel.unit, unit, "{header}");
    assert!(
        (channel.values[3] / value - 1.0).abs() < 1e-12,
        "{header}: {}",
        channel.values[3]
    );
}

#[test]
fn a_rig_file_is_read_in_si_units() {
    let m = import(include_str!("../data/drive-02.csv"));
    assert_eq!(
        (m.kind, m.len(), m.motion()),
        (Kind::Drive, 10_000, Motion::Rotational)
    );
    assert_eq!((m.time[1], m.input.values[0]), (0.0002, 0.55));
    assert_eq!(
        m.output(Quantity::Position).unwrap().values[1],
        1.198_422_49e-5
    );
    assert_eq!(m.output(Quantity::Velocity).unwrap().values[3], 0.347_755);
    assert!(m.warnings.is_empty() && m.reference.is_empty());
}

#[test]
fn a_process_keeps_its_own_units() {
    let m = import(include_str!("../data/process-01.csv"));
    assert_eq!((m.kind, m.motion()), (Kind::Process, Motion::None));
    si("t [s],u [V],y [degC]", Quantity::Input, "V", 2.0);
    si("t [s],input [%],output [bar]", Quantity::Output, "bar", 2.0);
}

#[test]
fn every_spelling_of_a_unit_becomes_si() {
    use std::f64::consts::{PI, TAU};
    let torque = |unit| format!("t [s],u [{unit}],x1 [rad]");
    for unit in ["N m", "Nm", "N*m", "N·m", "nm"] {
        si(&torque(unit), Quantity::Input, "N m", 2.0);
    }
    si(&torque("mN m"), Quantity::Input, "N m", 2e-3);
    for (unit, factor) in [("N", 1.0), ("kN", 1e3), ("mN", 1e-3)] {
        si(
            &format!("t [s],force [{unit}],x [m]"),
            Quantity::Input,
            "N",
            2.0 * factor,
        );
    }
    for (unit, factor) in [
        ("rad", 1.0),
        ("mrad", 1e-3),
        ("deg", PI / 180.0),
        ("°", PI / 180.0),
        ("rev", TAU),
        ("counts, 4096/rev", TAU / 4096.0),
        ("counts, 4096 counts/rev", TAU / 4096.0),
    ] {
        si(
            &format!("t [s],u [N m],theta [{unit}]"),
            Quantity::Position,
            "rad",
            2.0 * factor,
        );
    }
    for (unit, factor) in [
        ("m", 1.0),
        ("mm", 1e-3),
        ("um", 1e-6),
        ("µm", 1e-6),
        ("counts, 0.001 mm", 1e-6),
    ] {
        si(
            &format!("t [s],u [N],x1 [{unit}]"),
            Quantity::Position,
            "m",
            2.0 * factor,
        );
    }
    for (unit, factor) in [("rad/s", 1.0), ("deg/s", PI / 180.0), ("rpm", TAU / 60.0)] {
        si(
            &format!("t [s],u [N m],omega [{unit}]"),
            Quantity::Velocity,
            "rad/s",
            2.0 * factor,
        );
    }
    for (unit, factor) in [("m/s", 1.0), ("mm/s", 1e-3)] {
        si(
            &format!("t [s],u [N],v [{unit}]"),
            Quantity::Velocity,
            "m/s",
            2.0 * factor,
        );
    }
    for (unit, second) in [
        ("s", 1.0),
        ("ms", 1e-3),
        ("us", 1e-6),
        ("µs", 1e-6),
        ("min", 60.0),
    ] {
        let m = import(&file(&format!("t [{unit}],u [N m],x1 [rad]"), 30));
        assert!((m.time[1] / second - 1.0).abs() < 1e-12, "{unit}");
    }
}

#[test]
fn columns_are_known_by_the_names_that_people_give_them() {
    for (name, quantity, unit) in [
        ("X1", Quantity::Position, "rad"),
        ("Position", Quantity::Position, "rad"),
        ("angle", Quantity::Position, "rad"),
        ("SPEED", Quantity::Velocity, "rad/s"),
        ("velocity", Quantity::Velocity, "rad/s"),
    ] {
        for input in ["u", "Torque", "tau", "Input"] {
            let m = import(&file(
                &format!("Time [s],{input} [N m],{name} [{unit}]"),
                30,
            ));
            assert_eq!((m.outputs[0].quantity, m.outputs.len()), (quantity, 1));
            assert_eq!(
                (m.outputs[0].name.as_str(), m.input.name.as_str()),
                (name, input)
            );
        }
    }
    let m = import(&file(
        "t [s],u [N m],v1 [rad/s],x1 [rad],x2 [rad],v2 [rad/s]",
        30,
    ));
    assert_eq!(m.reference.len(), 2);
    assert_eq!(
        m.outputs[0].quantity,
        Quantity::Position,
        "position comes first"
    );
}

#[test]
fn the_ways_in_which_programs_write_csv_are_all_one() {
    let header = "t [s],u [N m],x1 [rad]";
    let mut plain = format!("{header}\n");
    for i in 0..30 {
        let _ = writeln!(plain, "{i}.5,{}e-3,-0.25", i * 2);
    }
    let wanted = import(&plain);
    let tabs = plain.replace(',', "\t");
    let quoted: String = plain
        .lines()
        .map(|l| {
            let fields: Vec<String> = l.split(',').map(|f| format!("\"{f}\"")).collect();
            fields.join(",") + "\n"
        })
        .collect();
    let quoted_comma: String = quoted
        .lines()
        .enumerate()
        .map(|(i, l)| {
            (if i == 0 {
                l.to_owned()
            } else {
                l.replace('.', ",")
            }) + "\n"
        })
        .collect::<String>()
        .replace("\",\"", "\";\"");
    for (habit, text) in [
        ("semicolon", plain.replace(',', ";")),
        (
            "semicolon and decimal comma",
            plain.replace(',', ";").replace('.', ","),
        ),
        ("tab and decimal comma", tabs.replace('.', ",")),
        ("tab", tabs),
        ("byte order mark", format!("\u{feff}{plain}")),
        ("CRLF", plain.replace('\n', "\r\n")),
        ("CR", plain.replace('\n', "\r")),
        (
            "comments and empty lines",
            format!(
                "# rig 3, 2026\n\n{}# end\n",
                plain.replace("\n3.5", "\n  # knocked\n\n3.5")
            ),
        ),
        ("spaces", plain.replace(',', " , ")),
        ("separator at the end", plain.replace('\n', ",\n")),
        ("no newline at the end", plain.trim_end().to_owned()),
        ("capital exponent", plain.replace("e-3", "E-03")),
        ("quotes", quoted),
        ("quotes and decimal comma", quoted_comma),
    ] {
        let read = import_csv("rig.csv", text.as_bytes(), None);
        assert_eq!(read.as_ref(), Ok(&wanted), "{habit}");
    }
}

/// Rows of four numbers, divided by this.
fn rows(separator: &str) -> String {
    let row = |i: i32| {
        let numbers = [f64::from(i) * 0.5, f64::from(i % 2), f64::from(-i), 1.5];
        numbers.map(|n| format!("{n:.3e}")).join(separator) + "\n"
    };
    (0..30).map(row).collect()
}

#[test]
fn a_header_may_stand_in_the_comment_above_the_numbers() {
    let plain = import(&format!("t [s],u [N m],x1 [rad],a [1]\n{}", rows(",")));
    for (header, separator) in [
        ("# t [s], u [N m], x1 [rad], a [1]", ","),
        ("#t [s],u [N m],x1 [rad],a [1]", ","),
        (
            "# rig 3, 2026, b, c\n\n## t [s],u [N m],x1 [rad],a [1]\n",
            ",",
        ),
        ("#t [s]\tu [N m]\tx1 [rad]\ta [1]", "\t"),
        ("# t [s] u [N m] x1[rad] a", " "),
    ] {
        let text = format!("{header}\n{}", rows(separator));
        let read = import_csv("rig.csv", text.as_bytes(), None);
        assert_eq!(read.as_ref(), Ok(&plain), "{header}");
    }
    // What is no header stays a comment: too few columns, or numbers alone; and a header that is there is the one.
    for comment in ["# rig 3, 2026", "# 1,2,3,4"] {
        let text = format!("{comment}\n{}", rows(","));
        refused(&text, &["line 2", "is not a header"]);
        let text = format!("{comment}\nt [s],u [N m],x1 [rad],a [1]\n{}", rows(","));
        assert_eq!(import(&text), plain, "{comment}");
    }
    // What is wrong in it is said where it stands.
    let text = format!("# rig\n# t [s],u,x1 [rad],a\n{}", rows(","));
    refused(&text, &["line 2, column 2 (u)", "no unit"]);
}

#[test]
fn units_may_stand_in_a_row_of_their_own() {
    let wanted = import(&file("t [ms],u [N m],x1 [deg],v1 [rpm]", 30));
    let rows = file("t [ms],u [N m],x1 [deg],v1 [rpm]", 30);
    let (_, rows) = rows.split_once('\n').unwrap();
    for head in [
        "t,u,x1,v1\nms,N m,deg,rpm",
        "\"Time\",\"Torque\",\"pos\",\"speed\"\n\"ms\",\"Nm\",\"deg\",\"rpm\"",
        "t,u,x1,v1\n[ms],[Nm],[deg],[rpm]",
        // What stands in the header is right.
        "t [ms],u,x1 [deg],v1\n,N m,rad,rpm",
    ] {
        let read = import(&format!("{head}\n{rows}"));
        let values = |m: &Measurement| {
            (
                m.time.clone(),
                m.input.values.clone(),
                m.outputs[0].values.clone(),
            )
        };
        assert_eq!(values(&read), values(&wanted), "{head}");
        assert_eq!(read.outputs[1].values, wanted.outputs[1].values, "{head}");
    }
    let m = import(&format!("t,u,status,y\ns,%,-,degC\n{rows}"));
    assert_eq!(
        (m.kind, m.outputs[0].unit.as_str()),
        (Kind::Process, "degC")
    );
    // What is no unit is still a row that is wrong.
    refused(
        &format!("t [s],u [N m],x1 [rad],v1 [rad/s]\ns,N m,furlong,rpm\n{rows}"),
        &["line 2, column 1 (t)", "'s' is not a number"],
    );
}

#[test]
fn blanks_divide_columns_where_nothing_else_does() {
    let plain = import(&format!("t [s],u [N m],x1 [rad],a [1]\n{}", rows(",")));
    for header in [
        "t [s] u [N m] x1 [rad] a [1]",
        "  t[s]   u[N m]\t x1 [rad]   \"a\"  ",
        "t [s]   u [N m]   x1 (rad)   a",
    ] {
        for separator in [" ", "    ", " \t", "\t  "] {
            let text = format!("{header}\n  {}", rows(separator).replace('\n', "  \n  "));
            let read = import_csv("rig.csv", text.as_bytes(), None);
            assert_eq!(read.as_ref(), Ok(&plain), "{header:?} {separator:?}");
        }
    }
    // Names have blanks in them where something else divides.
    for separator in [" \t ", " ; ", " , "] {
        let header = ["t [s]", "u [N m]", "x1 [rad]", "motor pos"].join(separator);
        let m = import(&format!("{header}\n{}", rows(separator)));
        assert_eq!(m.outputs, plain.outputs, "{separator:?}");
        assert!(m.warnings[0].to_string().contains("'motor pos'"));
    }
    // Without a header the first line is missed.
    let first = "'0.000e0  0.000e0  0.000e0  1.500e0' is not a header";
    refused(&rows("  "), &["line 1", first, "the first line must name"]);
    refused("0\t64\t0\n1\t64\t0\n", &["'0 64 0' is not a header"]);
    let text = format!("t [s]  u [N m]  x1 [rad]\n{}", rows("  "));
    refused(&text, &["line 2", "4 fields, but the header has 3"]);
}

#[test]
fn a_decimal_comma_that_comes_late_is_still_one() {
    let mut text = file(HEADER, 30).replace(',', ";");
    text += "30,5;2;2,25;2\n";
    let m = import(&text);
    assert_eq!((m.time[30], m.outputs[0].values[30]), (30.5, 2.25));
    text += "31.5;2;2;2\n";
    refused(
        &text,
        &["line 33", "column 1 (t)", "'31.5' is not a number"],
    );
}

/// What a controller calls input and output is the other way round in the loop; a set point is wanted of what comes
/// out.
#[test]
fn beside_a_set_point_the_output_may_be_that_of_a_controller() {
    let log = |header: &str, swap: bool| {
        let mut text = format!("{header}\n");
        for k in 0..60 {
            let heat = 120.0 - f64::from(k);
            let warm = 20.0 + 0.5 * f64::from(k);
            let [first, second] = if swap { [heat, warm] } else { [warm, heat] };
            let _ = writeln!(text, "{k},50,{first},{second}");
        }
        import(&text)
    };
    let named = |m: &Measurement| [m.input.name.clone(), m.outputs[0].name.clone()];
    for (header, swap, input, output) in [
        (
            "time,setpoint,temperature,output",
            false,
            "output",
            "temperature",
        ),
        ("time,setpoint,input,output", false, "output", "input"),
        ("time,reference,input,output", true, "input", "output"),
        ("time,SP,PV,OP", false, "OP", "PV"),
        ("time,soll,u,output", true, "u", "output"),
        (
            "time,extra,temperature,output",
            false,
            "output",
            "temperature",
        ),
    ] {
        let m = log(header, swap);
        assert_eq!(named(&m), [input, output], "{header}");
        let said = m
            .warnings
            .iter()
            .any(|w| w.to_string().contains("the output of a controller"));
        assert_eq!(said, input == "output", "{header}: {:?}", m.warnings);
    }
    // As the plotter of a microcontroller has it.
    let line = |k: i32| {
        format!(
            "t:{k} Setpoint:50 Input:{} Output:{}\n",
            20 + k / 2,
            120 - k
        )
    };
    let m = import(&(0..60).map(line).collect::<String>());
    assert_eq!(named(&m), ["Output", "Input"]);
    // Without a set point nothing says so.
    let plain = log("time,extra,input,output", false);
    assert_eq!(named(&plain), ["input", "output"]);
}

/// A logger that ends says what it found, or cuts its last row; in the middle, and from the beginning, it is an error.
#[test]
fn lines_at_the_end_that_are_no_rows_are_left_out_and_said() {
    let whole = file(HEADER, 30);
    let rows = import(&whole);
    let left_out = |end: &str, begin: &str| {
        let m = import(&format!("{whole}{end}"));
        assert_eq!((&m.time, &m.outputs), (&rows.time, &rows.outputs), "{end}");
        let note = format!("From line 32 on there are no rows of numbers ('{begin}'): left out.");
        assert_eq!(m.warnings.last().map(Message::to_string), Some(note));
    };
    left_out("30,2", "30,2");
    left_out("kp: 1.26 ki: 0.00\ndone\n", "kp: 1.26 ki: 0.00");
    refused(
        &format!("{whole}done\n30,2,2,2\n"),
        &["line 32", "1 field, but the header has 4"],
    );
    refused(&format!("{whole}{}", "done\n".repeat(9)), &["line 32"]);
    refused(&format!("{whole}30,2,nan,2\n"), &["line 32"]);
    refused(&format!("{}done\n", file(HEADER, 3)), &["line 5"]);
}

#[test]
fn a_process_needs_no_units() {
    let rows: Vec<String> = (0..40).map(|k| format!("{k},{},{k}", k % 2)).collect();
    let rows = rows.join("\n");
    let import = |head: &str| import_csv("process.csv", format!("{head}\n{rows}").as_bytes(), None);
    let process = import("t [s],u,y").unwrap();
    let units = [&process.input.unit, &process.outputs[0].unit];
    assert_eq!(units, ["1", "1"]);
    assert_eq!(
        process.warnings,
        ["No unit is given for u, y: taken as plain numbers."]
    );
    assert!(import("t [s],u [V],y [K]").unwrap().warnings.is_empty());
}

#[test]
fn a_process_without_a_unit_of_time_has_seconds_unless_its_steps_are_long() {
    let seconds = |step: f64| {
        let row = |k: i32| format!("{},{},{k}", f64::from(k) * step, k % 2);
        (0..40).map(row).collect::<Vec<_>>().join("\n")
    };
    for (name, step) in [("t", 1.0), ("Time", 2.0), ("time", 0.01), ("Zeit", 9.9)] {
        let m = import(&format!("{name},u,y\n{}", seconds(step)));
        assert!((m.time[1] - step).abs() < 1e-12, "{name}");
        let note = format!("No unit is given for {name}: taken as seconds.");
        assert!(
            m.warnings.iter().any(|w| *w == note.as_str()),
            "{:?}",
            m.warnings
        );
    }
    // Those are milliseconds more likely.
    for step in [10.0, 50.0, 1000.0] {
        refused(
            &format!("# oven\ntime,u,y\n{}", seconds(step)),
            &["line 2, column 1 (time)", "no unit", "such as time [s]"],
        );
    }
    // Another name says less, and of a drive every result hangs on it.
    refused(
        &format!("timestamp,u,y\n{}", seconds(1.0)),
        &["column 1 (timestamp)", "no unit"],
    );
    refused(
        &format!("t,u [N m],x1 [rad]\n{}", seconds(1.0)),
        &["column 1 (t)", "no unit"],
    );
    assert_eq!(
        import(&format!("t [ms],u,y\n{}", seconds(50.0))).time[2],
        0.1
    );
}

#[test]
fn what_is_no_unit_of_a_drive_may_be_one_of_a_process() {
    for header in ["t [s],u [degC],x1 [rad]", "t [s],u [%],x [degC]"] {
        let text = file(header, 30);
        let said = "the output of a process is y, in any unit";
        refused(&text, &["does not fit; expected", said]);
        let error = import_csv("rig.csv", text.as_bytes(), Some(Kind::Drive)).unwrap_err();
        assert!(!error.to_string().contains(said), "{error}");
    }
    // Without what moves it is asked for before any unit.
    refused(
        &file("t [s],u [degC],flux [kg/s]", 30),
        &["line 1: no column 'x1'", "a process needs y [1]"],
    );
}

/// A header and rows in which only the first column increases, and those that are called `still` are constant.
fn log(header: &str) -> String {
    let names: Vec<&str> = header.split(',').collect();
    let mut text = format!("{header}\n");
    for row in 0..40 {
        let field = |(i, name): (usize, &&str)| match i {
            0 => f64::from(row) * 0.5,
            _ if name.contains("still") => 3.0,
            _ => f64::from(row * i32::try_from(i).unwrap() % 7),
        };
        let fields: Vec<String> = names
            .iter()
            .enumerate()
            .map(field)
            .map(|v| v.to_string())
            .collect();
        let _ = writeln!(text, "{}", fields.join(","));
    }
    text
}

#[test]
fn what_only_one_column_can_be_it_is() {
    // Time, input and output, each in its column by name.
    for (header, kind, named) in [
        ("Time [s],T1 [degC],u [%]", Kind::Process, ["u", "T1"]),
        ("Time [s],Q1,T1", Kind::Process, ["Q1", "T1"]),
        (
            "time_ms,heater_pwm,Temperature",
            Kind::Process,
            ["heater_pwm", "Temperature"],
        ),
        (
            "elapsed [min],duty,Reactor [°C]",
            Kind::Process,
            ["duty", "Reactor"],
        ),
        (
            "t [s],pump [%],tank level [cm]",
            Kind::Process,
            ["pump", "tank level"],
        ),
        ("t [s],Voltage,y", Kind::Process, ["Voltage", "y"]),
        (
            "t [s],Heater 1,Heater still,T2,setpoint T1",
            Kind::Process,
            ["Heater 1", "T2"],
        ),
        (
            "Tiempo (s),Voltaje (V),Velocidad (rad/s)",
            Kind::Drive,
            ["Voltaje", "Velocidad"],
        ),
        (
            "t [s],pwm [PWM],motor_pos [deg]",
            Kind::Drive,
            ["pwm", "motor_pos"],
        ),
        (
            "t [s],current [A],x1 [rad],target speed [rpm]",
            Kind::Drive,
            ["current", "x1"],
        ),
    ] {
        let m = import(&log(header));
        let names = [&m.input, &m.outputs[0]].map(|c| c.name.as_str());
        assert_eq!(
            (m.kind, names, m.outputs.len()),
            (kind, named, 1),
            "{header}"
        );
        let taken = m
            .warnings
            .iter()
            .filter(|w| w.to_string().contains("is taken as the"));
        assert!(taken.count() > 0, "{header}: {:?}", m.warnings);
    }
    let m = import(&log("time_ms,heater_pwm,Temperature,note"));
    assert_eq!(m.time[1], 0.5e-3);
    assert_eq!(
        m.warnings,
        [
            "The column 'note' is not used: a process has t, u, y.",
            "The column 'time_ms' is taken as the time.",
            "The column 'heater_pwm' is taken as the input.",
            "The column 'Temperature' is taken as the output.",
            "No unit is given for heater_pwm, Temperature: taken as plain numbers.",
        ]
    );
    // What is there by its name is not looked for, whatever else resembles it.
    let m = import(&log("t [s],u [N m],x1 [rad],motor speed [rpm],current [A]"));
    assert_eq!((m.outputs.len(), m.input.name.as_str()), (1, "u"));
}

#[test]
fn what_several_columns_could_be_is_asked() {
    let asked: [(&str, &[&str]); 6] = [
        (
            "Time [s],T1,Q1,Q2",
            &[
                "no column 'u'",
                "not clear which is meant: Q1, Q2;",
                "--map \"t=Time, u=Q1, y=T1\"",
            ],
        ),
        (
            "Time [s],T1 [degC],T2 [degC],u [%]",
            &["no column 'y'", ": T1, T2;", "y=T1"],
        ),
        (
            "t [s],pwm,motor_pos [deg],motor_temp [degC]",
            &[
                "no column 'x1' / 'y'",
                ": motor_pos, motor_temp;",
                "to read it: --map \"t=t, u=pwm",
            ],
        ),
        (
            "t [s],pwm,Voltage (V),speed [rpm]",
            &["line 1", "no column 'u'", ": pwm, Voltage;"],
        ),
        // Of one that could be two things, and of two that have one name.
        ("t [s],pump flow", &["no column 'u'", ": pump flow"]),
        (
            "t [s],y,duty,duty",
            &["no column 'u'", ": column 3, column 4;", "u=column 3"],
        ),
    ];
    for (header, parts) in asked {
        refused(&log(header), parts);
    }
    // A mapping answers it.
    let text = log("Time [s],T1,Q1,Q2");
    let options = |map: &str| ImportOptions {
        mapping: map.parse().unwrap(),
        ..ImportOptions::default()
    };
    let m = import_with("rig.csv", text.as_bytes(), &options("u=Q2")).unwrap();
    assert_eq!(
        (m.input.name.as_str(), m.outputs[0].name.as_str()),
        ("Q2", "T1")
    );
    // What it leaves out is not looked for.
    let text = log("t [s],u [N m],x1 [rad],motor speed [rpm]");
    let error = import_with("rig.csv", text.as_bytes(), &options("x1=-,v1=-")).unwrap_err();
    assert!(error.to_string().contains("no column 'x1'"), "{error}");
    // Of a drive no unit is guessed.
    refused(
        &log("t [s],pwm,motor_pos [deg]"),
        &["column 2 (pwm)", "no unit"],
    );
    refused(
        &log("t [s],u [V],encoder"),
        &["column 3 (encoder)", "no unit"],
    );
    // A unit alone tells neither what moves nor what pushes.
    refused(&log("t [s],a [N m],b [rad]"), &["no column 'u'"]);
}

#[test]
fn a_missing_header_or_unit_is_named_with_what_is_accepted() {
    refused(
        "0,1,2\n1,2,3\n",
        &["line 1", "not a header", "t [s],u [N m]"],
    );
    refused(
        &file("t [s],u,x1 [rad],v1 [rad/s]", 30),
        &["line 1", "column 2 (u)", "such as u [N m]"],
    );
    refused(
        &file("t [s],u [N m],x1 []", 30),
        &["column 3 (x1)", "no unit", "such as x1 [rad]"],
    );
    refused(
        &file("t [s],u [N m],x1 [furlong]", 30),
        &["column 3 (x1)", "furlong", "rad, deg"],
    );
    refused(
        &file("t [s],u [N m],x1 [rad/s]", 30),
        &["column 3 (x1)", "rad/s", "angle or length"],
    );
    refused(
        &file("t [s],u [N m],x1 [counts]", 30),
        &["column 3 (x1)", "[counts, 4096/rev]"],
    );
    refused(
        &file("u [N m],x1 [rad]", 30),
        &["line 1", "no column 't'", "t [s]"],
    );
    refused(&file("t [s],x1 [rad]", 30), &["no column 'u'", "u [N m]"]);
    refused(
        &file("t [s],u [N m]", 30),
        &["x1 [rad]", "v1 [rad/s]", "y [1]"],
    );
    refused(
        &file("t [s],u [N m],x1 [rad],theta [rad]", 30),
        &["column 4 (theta)", "twice"],
    );
}

#[test]
fn dates_that_are_not_understood_are_said() {
    let dated = |name: &str, date: &str| {
        let rows: Vec<String> = (10..40).map(|i| format!("{i}{date},2,2")).collect();
        format!("{name},u [N m],x1 [rad]\n{}\n", rows.join("\n"))
    };
    // The day or the month may come first, months have names in many languages, and years four digits.
    for (name, date) in [
        ("day", "/03/2024"),
        ("time", "-Mar-2024 12:00:00"),
        ("timestamp", "-03-05T12:00:00.5"),
    ] {
        let said = [
            &format!("column '{}", &name[..1]) as &str,
            date,
            "expected 2025-01-31T09:27:03.5",
        ];
        refused(&dated(name, date), &said);
    }
    // A date beside the time does not matter.
    let beside = file("t [s],day,u [N m],x1 [rad]", 30);
    let beside = beside.replace(",2,2\n", ",2024-03-05,2,2\n");
    assert_eq!(import(&beside).len(), 30);
    refused(&dated("a", ""), &["no column 't'"]);
}

#[test]
fn rotational_and_translational_drives_do_not_mix() {
    let m = import(&file("t [s],u [N],x1 [mm],v1 [mm/s]", 30));
    assert_eq!(m.motion(), Motion::Translational);
    refused(
        &file("t [s],u [N m],x1 [mm]", 30),
        &["column 3 (x1)", "mixed", "N m with rad", "N with m"],
    );
    refused(
        &file("t [s],u [N],v1 [rpm]", 30),
        &["column 3 (v1)", "mixed"],
    );
}

#[test]
fn too_little_data_is_refused() {
    refused("", &["empty", "t [s],u [N m]"]);
    refused("\n# only a comment\n\n", &["empty"]);
    refused(&file(HEADER, 0), &["only 0 rows", "at least 20"]);
    refused(&file(HEADER, 1), &["only 1 row of"]);
    refused(&file(HEADER, MIN_SAMPLES - 1), &["only 19 rows"]);
    assert_eq!(import(&file(HEADER, MIN_SAMPLES)).len(), MIN_SAMPLES);
}

#[test]
fn bad_values_are_named_with_their_place() {
    let line = refusal(with_row_5("5,2,abc,2").as_bytes());
    assert_eq!(
        line,
        "rig.csv, line 7, column 3 (x1): 'abc' is not a number; expected e.g. 0.25 or 1e-3"
    );
    for text in ["nan", "NaN", "inf", "-Infinity", "1e999"] {
        refused(
            &with_row_5(&format!("5,2,2,{text}")),
            &["line 7", "column 4 (v1)", text, "not finite"],
        );
    }
    refused(
        &with_row_5("5,2,,2"),
        &["line 7", "column 3 (x1)", "'' is not a number"],
    );
    refused(
        &with_row_5("5,2,2"),
        &["line 7", "3 fields", "header has 4"],
    );
    refused(
        &with_row_5("5,2,2,2,2"),
        &["line 7", "5 fields", "decimal commas need ;"],
    );
    refused(
        &with_row_5("4,2,3,2"),
        &[
            "line 7",
            "column 1 (t)",
            "does not increase",
            "4 s appears in two rows",
        ],
    );
    refused(&with_row_5("3.5,2,2,2"), &["line 7", "3.5 s after 4 s"]);
}

#[test]
fn a_value_that_overflows_in_si_is_not_finite() {
    let text = file("t [s],u [kN],x1 [m]", 30).replace("\n5,2,", "\n5,1e306,");
    refused(&text, &["line 7", "column 2 (u)", "not finite"]);
}

#[test]
fn what_is_too_large_or_too_small_to_calculate_with_is_no_measurement() {
    for text in ["1e308", "-1e76", "1e20"] {
        refused(
            &with_row_5(&format!("5,2,2,{text}")),
            &["line 7, column 4 (v1): '", text, "too large"],
        );
    }
    let late = file(HEADER, 30).replace("\n29,", "\n1e300,");
    refused(&late, &["line 31, column 1 (t)", "'1e300'", "too large"]);
    let late = file(HEADER, 30).replace("\n29,", "\n1e18,");
    refused(&late, &["line 31, column 1 (t)", "'1e18'", "too large"]);
    let tiny = file("t [s],u [N m],v1 [rad/s]", 30).replace(",2,2", ",0,1e-170");
    refused(&tiny, &["line 2, column 3 (v1): '1e-170'", "too small"]);
    // Values that a logger writes where it has none are seen later, in the company of the others.
    for text in ["-9999", "1e12"] {
        assert_eq!(import(&with_row_5(&format!("5,2,2,{text}"))).len(), 30);
    }
    // Nor is a long pause, or a clock that counts nanoseconds from 1970.
    let paused = file(HEADER, 30).replace("\n29,", "\n1e9,");
    assert_eq!(import(&paused).len(), 30);
    let mut text = HEADER.to_owned();
    for i in 0..30_u64 {
        let _ = write!(
            text,
            "\n{},2,2,2",
            1_700_000_000_000_000_000 + i * 1_000_000
        );
    }
    assert_eq!(import(&text.replace("t [s]", "t [us]")).len(), 30);
    // At rest but for a moment.
    let rest = file("t [s],u [N m],v1 [rad/s]", 30).replace(",2,2", ",1e-20,1e-20");
    assert_eq!(import(&rest.replace("\n5,1e-20", "\n5,2")).len(), 30);
}

#[test]
fn bytes_that_are_not_text_are_refused() {
    let mut latin1 = file(HEADER, 3).into_bytes();
    latin1.extend(b"# 3 \xb0C\n");
    let line = refusal(&latin1);
    assert!(line.contains("line 5") && line.contains("UTF-8"), "{line}");
}

#[test]
fn unknown_columns_are_ignored_with_a_warning() {
    let text =
        file("t [s],u [N m],x1 [rad],note [1]", 30).replace("\n5,2,2,2", "\n5,2,2,fell over");
    let m = import(&text);
    assert_eq!((m.len(), m.outputs.len(), m.warnings.len()), (30, 1, 1));
    assert!(m.warnings[0].to_string().contains("'note'"));
    let m = import(&file("t [s],u [N m],x1 [rad],y [1]", 30));
    assert!(
        m.warnings[0].to_string().contains("'y'")
            && m.warnings[0].to_string().contains("a drive has")
    );
}

#[test]
fn the_kind_that_is_asked_for_wins_over_the_guess() {
    let text = file("t [s],u [N m],x1 [rad],y [V]", 30);
    assert_eq!(import(&text).kind, Kind::Drive);
    let m = import_csv("rig.csv", text.as_bytes(), Some(Kind::Process)).unwrap();
    assert_eq!((m.kind, m.motion()), (Kind::Process, Motion::None));
    assert_eq!(
        (m.outputs[0].name.as_str(), m.outputs[0].unit.as_str()),
        ("y", "V")
    );
    let refused = import_csv("rig.csv", file(HEADER, 30).as_bytes(), Some(Kind::Process));
    assert!(refused.unwrap_err().to_string().contains("y [1]"));
}

#[test]
fn what_is_written_is_read_back() {
    for text in [
        include_str!("../data/drive-05.csv").to_owned(),
        include_str!("../data/process-02.csv").to_owned(),
        file("Time [ms],tau [mN m],x1 [deg],speed [rpm],x2 [rev]", 30),
        file("t [s],u [counts, 4096/rev],y [°C]", 30),
    ] {
        let m = import(&text);
        assert_eq!(import(&m.to_csv()), m);
    }
    let mut m = import(&file(HEADER, 30));
    m.outputs[0].name = "left wheel".into();
    assert_eq!(import(&m.to_csv()).outputs[0].values, m.outputs[0].values);
}

#[test]
fn two_million_rows_are_read_rightly() {
    const ROWS: usize = 2_000_000;
    let mut text = String::from("t [ms],u [mN m],v1 [rad/s]\n");
    for i in 0..ROWS {
        writeln!(text, "{}.{},{},{}", i / 10, i % 10, i % 7, i).unwrap();
    }
    let m = import(&text);
    assert_eq!(m.len(), ROWS);
    for i in (0..ROWS).step_by(9_973).chain([ROWS - 1]) {
        assert!((m.time[i] - i as f64 * 1e-4).abs() < 1e-9);
        assert!((m.input.values[i] - (i % 7) as f64 * 1e-3).abs() < 1e-15);
        assert_eq!(m.outputs[0].values[i], i as f64);
    }
}

/// What holds whatever the bytes are: values that later modules can rely on, or one line.
fn holds_its_promise(bytes: &[u8], kind: Option<Kind>) {
    match import_csv("rig.csv", bytes, kind) {
        Ok(m) => {
            assert!(m.len() >= MIN_SAMPLES && !m.outputs.is_empty());
            assert!(m.time.windows(2).all(|w| w[0] < w[1]));
            for channel in std::iter::once(&m.input)
                .chain(&m.outputs)
                .chain(&m.reference)
            {
                assert_eq!(channel.values.len(), m.len());
                assert!(channel.values.iter().all(|v| v.is_finite()));
            }
            assert!(m.time.iter().all(|t| t.is_finite()));
        }
        Err(error) => {
            let line = error.to_string();
            assert!(!line.chars().any(char::is_control), "{line:?}");
        }
    }
}

fn any_kind() -> impl Strategy<Value = Option<Kind>> {
    prop_oneof![
        Just(None),
        Just(Some(Kind::Drive)),
        Just(Some(Kind::Process))
    ]
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..600), kind in any_kind()) {
        holds_its_promise(&bytes, kind);
    }

    #[test]
    fn arbitrary_headers_never_panic(header in "[tuxyv12 \\[\\](),;\t\"#/a-z0-9.µ°·*-]{0,60}", kind in any_kind()) {
        let text = format!("{header}\n{}", "0,0,0\n".repeat(25));
        holds_its_promise(text.as_bytes(), kind);
    }

    #[test]
    fn damaged_files_never_panic(
        damage in prop::collection::vec((0usize..400, any::<u8>(), 0u8..3), 1..6),
        kind in any_kind(),
    ) {
        let mut bytes = file(HEADER, 40).into_bytes();
        for (at, byte, how) in damage {
            let at = at % bytes.len();
            match how {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => {
                    bytes.remove(at);
                }
            }
        }
        holds_its_promise(&bytes, kind);
    }
}
