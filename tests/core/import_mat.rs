//! Files of MATLAB and columns with a mapping go in; SI units, or one line that says what to correct,
//! come out. The `.mat` files in `tests/data` were written by `SciPy`, and hold, for k = 0 to 59, the time
//! k/2 ms, a current of 2 or -2 A that changes every 5 samples, k^2 encoder counts and 1.5 k rpm.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::support::mat::{element, file, iddata, timeseries};
use hysteron_core::measurement::{
    ImportOptions, Kind, Mapping, Measurement, Motion, Quantity, Role, TorqueConstant, columns,
    guess, import,
};
use hysteron_core::message::Message;
use proptest::prelude::*;

const FLAT: &[u8] = include_bytes!("../data/flat-v7.mat");
const NESTED: &[u8] = include_bytes!("../data/nested-v7.mat");
const RIG: &str = "t=time [ms],u=current [A],x1=enc [counts:4096],v1=speed [rpm]";

fn options(mapping: &str, constant: Option<&str>) -> ImportOptions {
    ImportOptions {
        kind: None,
        mapping: if mapping.is_empty() {
            Mapping::default()
        } else {
            mapping.parse().unwrap_or_else(|e| panic!("{e}"))
        },
        torque_constant: constant.map(|c| c.parse().unwrap_or_else(|e| panic!("{e}"))),
        ..ImportOptions::default()
    }
}

#[track_caller]
fn read(bytes: &[u8], mapping: &str, constant: Option<&str>) -> Measurement {
    import("rig.mat", bytes, &options(mapping, constant)).unwrap_or_else(|e| panic!("{e}"))
}

#[track_caller]
fn refused(bytes: &[u8], mapping: &str, constant: Option<&str>, parts: &[&str]) {
    let line = import("rig.mat", bytes, &options(mapping, constant))
        .expect_err("must be refused")
        .to_string();
    assert!(
        line.starts_with("rig.mat") && !line.contains('\n'),
        "{line}"
    );
    for part in parts {
        assert!(line.contains(part), "expected '{part}' in: {line}");
    }
}

/// So many lines.
fn lines(count: i32, line: impl Fn(i32) -> String) -> String {
    (0..count).map(line).collect::<Vec<_>>().join("\n")
}

/// The values of the rig, by formula.
#[track_caller]
fn is_the_rig(m: &Measurement, torque_by_current: f64) {
    assert_eq!((m.kind, m.len()), (Kind::Drive, 60));
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b.abs();
    let position = m.output(Quantity::Position).unwrap();
    for k in 0..60_u32 {
        let i = k as usize;
        let current = if k % 10 < 5 { 2.0 } else { -2.0 };
        assert!(close(m.time[i], f64::from(k) * 0.5e-3), "t {k}");
        assert!(
            close(m.input.values[i], current * torque_by_current),
            "u {k}"
        );
        assert!(
            close(position.values[i], f64::from(k * k) * TAU / 4096.0),
            "x1 {k}"
        );
        if let Some(v) = m.output(Quantity::Velocity) {
            assert!(
                close(v.values[i], f64::from(k) * 1.5 * TAU / 60.0),
                "v1 {k}"
            );
        }
    }
}

/// What was said of a file, but that its velocity is not the rate of its position: the columns are made up.
fn notes(m: &Measurement) -> Vec<String> {
    let said = m.warnings.iter().map(Message::to_string);
    said.filter(|w| !w.contains("the rate at which")).collect()
}

#[test]
fn a_compressed_file_is_read_in_si_units() {
    let m = read(FLAT, RIG, Some("0.05 N m/A"));
    is_the_rig(&m, 0.05);
    assert_eq!(
        (m.motion(), m.input.unit.as_str()),
        (Motion::Rotational, "N m")
    );
    assert!(m.output(Quantity::Velocity).is_some() && notes(&m).is_empty());
}

#[test]
fn structures_and_columns_of_matrices_are_addressed_as_in_matlab() {
    for mapping in [
        "t=log.time [ms], u=log.signals(1).values [A], x1=log.signals(2).values [counts:4096]",
        "t=data(:,1) [ms], u=data(:,2) [A], x1=data(:,3) [counts, 4096/rev], v1=data(:,4) [rpm]",
        "t=wide(1,:) [ms], u=wide(2,:) [A], x1=data(:,3) [counts; 4096/rev]",
    ] {
        is_the_rig(&read(NESTED, mapping, Some("50 mN m/A")), 0.05);
    }
}

#[test]
fn a_minus_turns_the_direction() {
    let mapping = RIG.replace("=current", "=-current");
    is_the_rig(&read(FLAT, &mapping, Some("0.05 N m/A")), -0.05);
}

#[test]
fn a_torque_constant_that_is_not_known_is_one_and_that_is_said() {
    let m = read(FLAT, RIG, None);
    is_the_rig(&m, 1.0);
    assert_eq!(notes(&m).len(), 1);
    assert!(notes(&m)[0].contains("1 N m/A is assumed") && notes(&m)[0].contains("multiples"));
    // A linear motor: what moves in metres is pushed by a force.
    let slide = "t=time [ms],u=current [A],x1=enc [counts, 0.001 mm]";
    let m = read(FLAT, slide, None);
    assert_eq!(
        (m.motion(), m.input.unit.as_str()),
        (Motion::Translational, "N")
    );
    assert!(notes(&m)[0].contains("1 N/A is assumed"));
    // A voltage brings the back-EMF, known constant or not.
    let voltage = RIG.replace("[A]", "[V]");
    assert_eq!(notes(&read(FLAT, &voltage, None)).len(), 2);
    let known = read(FLAT, &voltage, Some("0.1 N m/V"));
    assert!(notes(&known).len() == 1 && notes(&known)[0].contains("back-EMF"));
    assert_eq!(known.input.values[0], 0.2);
}

#[test]
fn a_command_is_an_input_of_unknown_scale() {
    for (unit, shown) in [
        ("%", "%"),
        ("PWM", "PWM"),
        ("pwm", "PWM"),
        ("1", "1"),
        ("counts", "counts"),
    ] {
        let m = read(FLAT, &RIG.replace("[A]", &format!("[{unit}]")), None);
        is_the_rig(&m, 1.0);
        assert_eq!(m.input.unit, "N m", "{unit}");
        assert!(notes(&m)[0].contains(&format!("1 N m/{shown} is assumed")));
        assert!(notes(&m).len() == 2 && notes(&m)[1].contains("is a command"));
    }
    let command = RIG.replace("[A]", "[%]");
    let known = read(FLAT, &command, Some("0.002 N m/%"));
    is_the_rig(&known, 0.002);
    assert_eq!(notes(&known).len(), 1);
    let slide = "t=time [ms],u=current [PWM],x1=enc [counts, 0.001 mm]";
    assert_eq!(read(FLAT, slide, None).input.unit, "N");
    // The constant of another command, or of a current, does not fit it.
    for constant in ["1 N m/PWM", "0.05 N m/A"] {
        refused(
            FLAT,
            &command,
            Some(constant),
            &["torque constant", "an input in %"],
        );
    }
    // Only the input is one.
    for wrong in [
        "v1=speed [%]",
        "v1=speed [counts]",
        "x1=enc [%]",
        "x1=enc [1]",
    ] {
        let mapping = format!("t=time [ms],u=current [%],{wrong}");
        refused(FLAT, &mapping, None, &["does not fit"]);
    }
    refused(
        FLAT,
        &RIG.replace("[A]", "[degC]"),
        None,
        &["'degC' does not fit", "a command: %, PWM, counts, 1"],
    );
}

#[test]
fn a_process_keeps_its_units() {
    let m = read(FLAT, "t=time [s],u=current [%],y=speed [degC]", None);
    assert_eq!((m.kind, m.input.unit.as_str()), (Kind::Process, "%"));
    assert_eq!(m.output(Quantity::Output).unwrap().values[2], 3.0);
}

#[test]
fn a_mapping_serves_text_as_well() {
    let mut text = String::from("no,zeit,strom [mA],enc,x1 [rad]\n");
    for k in 0..60 {
        let current = if k % 10 < 5 { 2000 } else { -2000 };
        let _ = writeln!(text, "7,{},{current},{},9", f64::from(k) * 0.5, k * k);
    }
    // The unit in the file holds where the mapping has none; the file's own x1 makes way.
    let mapping = "t=zeit [ms],u=strom,x1=enc [counts:4096]";
    let m = read(text.as_bytes(), mapping, Some("0.05 N m/A"));
    is_the_rig(&m, 0.05);
    assert!(notes(&m).is_empty());
    let again = import("back.csv", m.to_csv().as_bytes(), &ImportOptions::default()).unwrap();
    assert_eq!((again.time, again.input.values), (m.time, m.input.values));
    refused(
        text.as_bytes(),
        "t=zeit [ms],u=power [A]",
        None,
        &["line 1", "no column 'power'", "strom"],
    );
}

#[test]
fn columns_without_a_name_of_their_own_are_called_by_their_place() {
    let rows = lines(60, |k| {
        let current = if k % 10 < 5 { 2 } else { -2 };
        format!("{};{current};{};{k}", f64::from(k) * 0.5, k * k)
    });
    let mapping = "t=column 1 [ms],u=column 2 [A],x1=column 3 [counts:4096]";
    for header in ["", ";;;x\n", "a;a;a;a\n", "-;x,y;=;#\n"] {
        let text = format!("{header}{rows}");
        let m = read(text.as_bytes(), mapping, Some("0.05 N m/A"));
        is_the_rig(&m, 0.05);
        assert!(!m.input.name.is_empty(), "{header}");
    }
    refused(
        rows.as_bytes(),
        "t=column 9 [s],u=column 2 [A]",
        None,
        &["no column 'column 9'", "column 1, column 2, column 3"],
    );
    refused(rows.as_bytes(), "", None, &["'0;2;0;0' is not a header"]);
}

#[test]
fn a_minus_alone_leaves_a_column_out() {
    let text = lines(60, |k| format!("{k},{},{k},?", k % 2));
    let text = format!("t [s],u [N m],x1 [rad],v1\n{text}");
    refused(text.as_bytes(), "t=t", None, &["column 4 (v1)", "no unit"]);
    let m = read(text.as_bytes(), "t=t,v1=-", None);
    assert_eq!((m.len(), m.outputs.len()), (60, 1));
}

#[test]
fn the_columns_of_a_file_are_shown_before_they_are_mapped() {
    let found = columns("rig.mat", FLAT).unwrap();
    let names: Vec<&str> = found.iter().map(|c| c.address.as_str()).collect();
    // Ts is one number, and no series.
    assert_eq!(names, ["time", "current", "enc", "speed"]);
    let [time, current] = [0, 1].map(|i| &found[i].numbers);
    assert_eq!(
        (time.count, &time.first, time.range),
        (60, &vec![0.0, 0.5, 1.0], Some([0.0, 29.5]))
    );
    assert_eq!(current.range, Some([-2.0, 2.0]));
    assert!(time.increase() && !current.increase());
    assert!(
        found
            .iter()
            .all(|c| c.unit.is_none() && c.known_as.is_none())
    );

    let rows = lines(30, |k| format!("{k},5;run;{};1", -k));
    let found = columns("x.csv", format!("t [ms];state;a=b;a,b\n{rows}").as_bytes()).unwrap();
    let shown = |i: usize| (found[i].name.as_str(), found[i].address.as_str());
    // A name that a mapping cannot say is called by its place.
    assert_eq!(
        [shown(0), shown(1), shown(2)],
        [("t", "t"), ("a=b", "a=b"), ("a,b", "column 4")]
    );
    assert_eq!(found[0].unit.as_deref(), Some("ms"));
    assert_eq!(found[0].known_as, Some(Role::Time));
    assert_eq!(found[0].numbers.range, Some([0.5, 29.5]));
    let error = columns("x.mat", &FLAT[..200]).unwrap_err();
    assert!(error.to_string().contains("damaged"), "{error}");
}

#[test]
fn what_is_wrong_is_said_with_what_would_be_right() {
    refused(
        FLAT,
        "",
        None,
        &["map them", "time, current, enc, speed, Ts"],
    );
    refused(
        FLAT,
        "t=Time [s],u=current [A]",
        None,
        &["no column 'Time'", "time, current"],
    );
    refused(
        FLAT,
        "t=time,u=current [A],x1=enc [rad]",
        None,
        &[
            "column time",
            "no unit",
            "time [s]",
            "--map \"t=time [s], u=current [A], x1=enc [rad]",
        ],
    );
    refused(FLAT, "t=time [s],u=current [A]", None, &["no column 'x1'"]);
    refused(
        FLAT,
        "t=time [s],u=current [A],x1=Ts [rad]",
        None,
        &["column Ts", "1 values", "60"],
    );
    refused(
        FLAT,
        "t=time [s],u=current [A],x1=enc [counts]",
        None,
        &["resolution"],
    );
    refused(
        FLAT,
        "t=current [s],u=time [A],x1=enc [rad]",
        None,
        &["column current, sample 6", "increase"],
    );
    refused(
        FLAT,
        &RIG.replace("[A]", "[N m]"),
        Some("1 N m/A"),
        &["torque constant", "N m"],
    );
    refused(FLAT, RIG, Some("1 N m/V"), &["torque constant", "A"]);
    // A force constant, but the position turns.
    refused(FLAT, RIG, Some("1 N/A"), &["mixed"]);
    refused(
        b"MATLAB 7.3 MAT-file, Platform: GLNXA64",
        RIG,
        None,
        &["HDF5", "damaged", "-v7"],
    );
    // One column of doubles called t, by little-endian and by big-endian words.
    let old = |word: fn(u32) -> [u8; 4], order: u32| {
        let words = [1000 * order, 3, 1, 0, 2].map(word);
        [words.concat(), b"t\0".to_vec(), vec![0; 24]].concat()
    };
    for old in [old(u32::to_le_bytes, 0), old(u32::to_be_bytes, 1)] {
        refused(&old, RIG, None, &["level 4", "-v4", "-v7"]);
    }
    refused(&FLAT[..200], RIG, None, &["at byte", "damaged"]);
}

#[test]
fn a_mapping_or_constant_that_makes_no_sense_is_refused() {
    let mapping = |text: &str| text.parse::<Mapping>().unwrap_err().to_string();
    assert!(mapping("x1 enc").contains("'x1 enc' is not a mapping"));
    assert!(mapping("x1=").contains("not a mapping"));
    assert!(mapping("x1=enc [rad").contains("not a mapping"));
    assert!(mapping("what=enc [rad]").contains("'what' is none of t, u, x1"));
    // A name that a column may have, on the wrong side.
    assert!(mapping("q=u").contains("'q' is none of t, u, x1"));
    assert!(mapping("x1=a [rad],x1=b [rad]").contains("'x1' appears in the mapping twice"));
    assert!(mapping("x1=a [rad],v1=a [rpm]").contains("'a' appears in the mapping twice"));
    for wrong in [
        "",
        "5",
        "5 N m",
        "x N m/A",
        "0 N m/A",
        "1 rad/s",
        "1 A/N m",
        "inf N m/A",
    ] {
        let constant = wrong.parse::<TorqueConstant>();
        assert!(constant.is_err(), "{wrong}: {constant:?}");
    }
    assert_eq!("-2 N/A".parse::<TorqueConstant>().unwrap().value(), -2.0);
    assert_eq!(
        "0.05 N·m/mA".parse::<TorqueConstant>().unwrap().value(),
        50.0
    );
}

#[test]
fn every_type_of_number_and_both_byte_orders_are_read() {
    macro_rules! check {
        ($($kind:literal $number:ty),*) => {$(
            for big in [false, true] {
                let value = |n: i8| {
                    let n = n as $number;
                    if big { n.to_be_bytes().to_vec() } else { n.to_le_bytes().to_vec() }
                };
                // Three columns of 30: 0.., 30.., 60...
                let numbers: Vec<u8> = (0..90).flat_map(value).collect();
                let bytes = file(big, "d", 6, [30, 3], $kind, &numbers);
                let m = read(&bytes, "t=d(:,1) [s],u=d(:,2) [N m],x1=-d(:,3) [rad]", None);
                assert_eq!((m.time[29], m.input.values[0]), (29.0, 30.0), "type {}", $kind);
                assert_eq!(m.outputs[0].values[29], -89.0);
            }
        )*};
    }
    check!(1 i8, 2 u8, 3 i16, 4 u16, 5 i32, 6 u32, 7 f32, 9 f64, 12 i64, 13 u64);
}

/// Two timeseries of Simulink, whose values stand apart from their names.
#[test]
fn timeseries_are_read_by_the_words_of_the_message() {
    let time: Vec<f64> = (0..60).map(|k| 0.01 * f64::from(k)).collect();
    let volt: Vec<f64> = (0..60).map(|k| f64::from(k / 20 % 2)).collect();
    let speed: Vec<f64> = (0..60).map(|k| 0.3 * f64::from(k)).collect();
    let bytes = timeseries(&[
        ("sig_volt", time.clone(), volt.clone()),
        ("sig_speed", time.clone(), speed.clone()),
    ]);
    let map = "t=sig_volt.Time [s], u=sig_volt.Data [V], v1=sig_speed.Data [rad/s]";
    refused(&bytes, "", None, &[&format!("--map \"{map}\"")]);
    let m = read(&bytes, map, None);
    assert_eq!((m.time, m.input.values), (time, volt));
    assert_eq!(m.outputs[0].values, speed);
}

/// What the System Identification Toolbox keeps says which is input and which is output, and the sampling period.
#[test]
fn records_of_the_toolbox_are_read_at_once() {
    let input: Vec<f64> = (0..60).map(|k| f64::from(k / 7 % 2)).collect();
    let output: Vec<f64> = (0..60).map(f64::from).collect();
    let other: Vec<f64> = output.iter().map(|y| 2.0 * y).collect();
    let bytes = iddata(&[
        ("id", input.clone(), output.clone(), 0.25),
        ("val", input.clone(), other, 0.5),
    ]);
    let record = read(&bytes, "", None);
    let said = "The file holds id, val: 'id' was read. A mapping can read another one.";
    assert!(
        notes(&record).contains(&said.to_owned()),
        "{:?}",
        notes(&record)
    );
    assert_eq!(record.kind, Kind::Process);
    assert_eq!(record.time[59], 59.0 * 0.25);
    assert_eq!(record.input.values, input);
    assert_eq!(record.outputs[0].values, output);
    let map = "t=val.Time, u=val.InputData, y=val.OutputData";
    assert_eq!(read(&bytes, map, None).time[1], 0.5);
    let names: Vec<String> = columns("rig.mat", &bytes)
        .unwrap()
        .into_iter()
        .map(|c| c.name)
        .collect();
    let expected =
        ["id", "val"].map(|of| ["Time", "OutputData", "InputData"].map(|c| format!("{of}.{c}")));
    assert_eq!(names, expected.concat());
}

#[test]
fn sizes_that_lie_end_in_one_line() {
    let numbers: Vec<u8> = (0..90_u8).collect();
    // Fewer numbers than the sizes say: no such column.
    for sizes in [[30, 4], [i32::MAX, i32::MAX], [-30, -3], [0, 0]] {
        let bytes = file(false, "d", 6, sizes, 2, &numbers);
        refused(
            &bytes,
            "t=d(:,1) [s],u=d(:,2) [N m],x1=d(:,3) [rad]",
            None,
            &["no numbers in the file"],
        );
    }
    // An array of 2^62 structures in a hundred bytes.
    let word = |n: i32| n.to_le_bytes();
    let array = [
        element(false, 6, &[word(2), word(0)].concat()),
        element(false, 5, &[word(i32::MAX), word(i32::MAX)].concat()),
        element(false, 1, b"s"),
        element(false, 5, &word(8)),
        element(false, 1, b"field\0\0\0"),
    ]
    .concat();
    let mut bytes = FLAT[..128].to_vec();
    bytes.extend(element(false, 14, &array));
    refused(&bytes, RIG, None, &["at byte", "damaged"]);
}

#[test]
fn a_bomb_does_not_fill_the_memory() {
    // 1 MiB of zeros in 1 kB, 300 times, is more than a file may unpack to.
    let zeros = element(false, 2, &vec![0; 1 << 20]);
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(&zeros, 6);
    let word = |n: u32| n.to_le_bytes();
    let mut bytes = FLAT[..128].to_vec();
    for _ in 0..300 {
        bytes.extend([word(15), word(packed.len() as u32)].concat());
        bytes.extend(&packed);
    }
    assert!(bytes.len() < 1 << 20);
    refused(&bytes, RIG, None, &["more than 256 MiB"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_damaged_file_is_read_or_refused_in_one_line(
        nested in any::<bool>(),
        changes in prop::collection::vec((128_usize..3000, any::<u8>()), 1..6),
        length in 128_usize..4000,
    ) {
        let mut bytes = if nested { NESTED } else { FLAT }.to_vec();
        for (at, value) in changes {
            let at = at % bytes.len();
            bytes[at] = value;
        }
        bytes.truncate(length);
        match import("rig.mat", &bytes, &options(RIG, None)) {
            Ok(m) => prop_assert!(m.len() >= 20 && m.time.windows(2).all(|w| w[0] < w[1])),
            Err(e) => prop_assert!(!e.to_string().contains('\n')),
        }
        if let Err(e) = columns("rig.mat", &bytes) {
            prop_assert!(!e.to_string().contains('\n'));
        }
    }

    #[test]
    fn damage_inside_what_was_compressed_is_no_panic(
        numbers in prop::collection::vec(any::<u8>(), 0..600),
        class in 0_u32..20,
        kind in 0_u32..20,
        sizes in any::<[i32; 2]>(),
        cut in 128_usize..900,
    ) {
        let whole = file(false, "d", class, sizes, kind, &numbers);
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(&whole[128..cut.min(whole.len())], 6);
        let mut bytes = whole[..128].to_vec();
        bytes.extend([15_u32.to_le_bytes(), (packed.len() as u32).to_le_bytes()].concat());
        bytes.extend(&packed);
        prop_assert!(import("rig.mat", &bytes, &options(RIG, None)).is_err());
    }

    #[test]
    fn any_text_is_a_mapping_or_is_refused(text in "[tuxvy1=,\\[\\]: a-z(-]{0,40}") {
        if let Err(error) = text.parse::<Mapping>() {
            prop_assert!(!error.to_string().contains('\n'));
        }
        let _ = text.parse::<TorqueConstant>();
    }

    #[test]
    fn any_text_with_any_mapping_is_read_or_refused(rows in "[0-9,.;\\n\\-e]{0,400}") {
        let text = format!("time,current,enc\n{rows}");
        if let Ok(found) = columns("rig.csv", rows.as_bytes()) {
            let guess = guess(&found);
            let there = guess.channels.iter().all(|(_, i)| *i < found.len());
            prop_assert!(there);
        }
        if let Err(error) = import("rig.csv", text.as_bytes(), &options("t=time [s],u=current [A],x1=enc [rad]", None)) {
            prop_assert!(!error.to_string().contains('\n'));
        }
    }
}
