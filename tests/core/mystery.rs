//! A measured mystery: made by an independent bench, shared without its truth, diagnosed, revealed.

use crate::support::diagnosis::finish;
use hysteron_core::backlash::estimate_gap;
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::{Diagnosis, Parameter};
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::{Kind, Measurement, import_csv};
use hysteron_core::mystery::{
    Answer, Choice, Experiment, Hidden, Mark, Mystery, MysteryError, Pick, Request, Reveal, Row,
    SALT, Strength, Truth, columns, hideable, make, seal_of,
};
use proptest::prelude::*;

const WORD: &str = "blue whale";

/// The longest link that the app takes, characters, and room in it for the page and its settings.
const LINK: usize = 16_384 - 400;

fn request(experiment: Experiment, choice: Choice, salt: u8) -> Request {
    Request {
        experiment,
        choice,
        word: WORD.to_owned(),
        salt: [salt; 16],
    }
}

/// A pick of medium strength.
fn pick(kind: Kind, id: &str) -> Pick {
    let effect = hideable(kind).iter().find(|h| h.id.as_str() == id);
    let effect = effect.expect("an effect of the menu");
    Pick {
        effect: effect.id,
        value: effect.value(Strength::Medium),
    }
}

fn mystery(experiment: Experiment, ids: &[&str]) -> Mystery {
    let kind = experiment.kind();
    let choice = Choice::Chosen(ids.iter().map(|id| pick(kind, id)).collect());
    make(&request(experiment, choice, 5)).expect("a mystery")
}

fn measured(mystery: &Mystery) -> Measurement {
    import_csv("mystery", mystery.csv().as_bytes(), None).expect("a measurement")
}

fn diagnosed(mystery: &Mystery) -> Diagnosis {
    finish(DiagnosisJob::new(&measured(mystery)).expect("a measurement that can be judged"))
}

/// The model that a diagnosis ends with, as an answer.
fn answer(diagnosis: &Diagnosis) -> Answer {
    let last = diagnosis.steps.last().expect("a model");
    let class = |effect: &EffectId| {
        let mut classes = diagnosis.verdict.missing.iter();
        classes
            .find(|c| c.contains(effect))
            .cloned()
            .unwrap_or_default()
    };
    Answer {
        effects: last.effects.iter().map(|e| (*e, class(e))).collect(),
        parameters: last.parameters.clone(),
    }
}

fn id(text: &str) -> EffectId {
    EffectId::parse(text).expect("an effect of the library")
}

#[test]
fn the_bench_uses_nothing_of_the_models_that_are_fitted() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/rig");
    let mut files = 0;
    for entry in std::fs::read_dir(folder).expect("the bench") {
        let text = std::fs::read_to_string(entry.expect("a file").path()).expect("its text");
        for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
            // Numbers by chance are no model.
            let own = line
                .replace("crate::measurement", "")
                .replace("crate::random", "");
            assert!(!own.contains("crate::"), "{line}");
        }
        files += 1;
    }
    assert!(files >= 4);
}

#[test]
fn the_same_request_gives_the_same_record_and_another_salt_another() {
    let ask = |salt| make(&request(Experiment::Relay, Choice::Surprise, salt)).expect("a mystery");
    assert_eq!(ask(1), ask(1));
    assert_ne!(ask(1).columns, ask(2).columns);
}

#[test]
fn a_diagnosis_finds_what_is_hidden_and_the_truth_gives_it_the_points() {
    for (experiment, ids) in [
        (Experiment::Relay, &["input_delay"][..]),
        (Experiment::Sines, &["dead_zone"]),
        (Experiment::Stairs, &["coulomb_friction", "constant_load"]),
        (Experiment::Sines, &[]),
        // A relay cannot tell an offset from an asymmetry: the class is right, and no number is asked.
        (Experiment::Relay, &["gain_asymmetry"]),
        (Experiment::ProcessBinary, &["input_delay", "second_lag"]),
        // Two lags in a row are the same in either order.
        (Experiment::ProcessBinary, &["sensor_lag"]),
        (Experiment::ProcessRelay, &["input_delay", "load_ramp"]),
        (Experiment::ProcessStairs, &["input_delay", "saturation"]),
        (Experiment::ProcessStairs, &["underdamped"]),
        (Experiment::ProcessStairs, &["static_curvature"]),
        (Experiment::ProcessStairs, &["second_lag", "constant_load"]),
        (Experiment::ProcessRelay, &[]),
    ] {
        let made = mystery(experiment, ids);
        let diagnosis = diagnosed(&made);
        let reveal = Reveal::open(&made.seal, WORD, &answer(&diagnosis)).expect("the word");
        let found = reveal.rows.iter().all(|r| match r.mark {
            Mark::Right => true,
            Mark::Alike(_) => {
                ["gain_asymmetry", "sensor_lag", "second_lag"].contains(&r.effect.as_str())
            }
            _ => false,
        });
        assert!(
            found && reveal.rows.len() == ids.len(),
            "{ids:?}: {reveal:?}"
        );
        assert!(reveal.points() >= 97.0, "{ids:?}: {reveal:?}");
        assert!(diagnosis.verdict.complete, "{ids:?}");
    }
}

#[test]
fn a_drive_that_sticks_is_followed_down_to_the_noise() {
    // In these records a window begins where the body just sticks, or just breaks loose.
    for number in [4, 12] {
        let choice = Choice::Chosen(vec![pick(Kind::Drive, "coulomb_friction")]);
        let mut asked = request(Experiment::Sines, choice, 0);
        asked.salt[0] = number;
        let diagnosis = diagnosed(&make(&asked).expect("a mystery"));
        let last = diagnosis.steps.last().expect("a step");
        assert_eq!(diagnosis.verdict.missing, [[id("coulomb_friction")]]);
        assert!(last.error < 1.1, "{number}: {}", last.error);
    }
}

#[test]
fn a_hidden_gap_is_measured_from_the_motor_alone() {
    let made = mystery(Experiment::Drifting, &["backlash"]);
    assert!(made.link().len() < LINK, "{}", made.link().len());
    let found = estimate_gap(&measured(&made)).expect("an estimate").gap;
    let found = found.expect("a gap") / 2.0;
    let truth = pick(Kind::Drive, "backlash").value;
    assert!((found / truth - 1.0).abs() < 0.05, "{found} for {truth}");
    let without = measured(&mystery(Experiment::Drifting, &[]));
    assert_eq!(estimate_gap(&without).expect("an estimate").gap, None);
}

#[test]
fn neither_the_file_nor_the_link_says_what_is_hidden() {
    let with = mystery(
        Experiment::Sines,
        &["coulomb_friction", "cogging", "input_delay"],
    );
    let without = mystery(Experiment::Sines, &[]);
    assert_eq!(with.seal.len(), without.seal.len(), "the length would tell");
    let hidden = [
        "coulomb",
        "cogging",
        "input_delay",
        "truth\n",
        "baseline",
        WORD,
    ];
    let inflated = |link: &str| {
        use base64::Engine as _;
        let letters = base64::prelude::BASE64_URL_SAFE_NO_PAD;
        let bytes = letters.decode(link).expect("the letters of a link");
        miniz_oxide::inflate::decompress_to_vec(&bytes[1..]).expect("what was deflated")
    };
    for bytes in [
        with.csv().into_bytes(),
        with.link().into_bytes(),
        inflated(&with.link()),
        with.seal.clone(),
    ] {
        for word in hidden {
            let found = bytes.windows(word.len()).any(|w| w == word.as_bytes());
            assert!(!found, "{word}");
        }
    }
    // What is sealed looks like noise: no byte is much more frequent than others.
    let mut counts = [0; 256];
    for byte in &with.seal[SALT..] {
        counts[usize::from(*byte)] += 1;
    }
    assert!(counts.iter().all(|n| *n < 16), "{counts:?}");
}

#[test]
fn only_the_word_opens_the_seal() {
    let made = mystery(Experiment::Relay, &["actuator_lag"]);
    let open = |seal: &[u8], word: &str| Reveal::open(seal, word, &Answer::default());
    for word in ["", "blue", "Blue whale", "blue  whale", "blue whale."] {
        assert_eq!(
            open(&made.seal, word),
            Err(MysteryError::WrongWord),
            "{word}"
        );
    }
    // Spaces about it come with copying.
    assert!(open(&made.seal, " blue whale\n").is_ok());
    for at in [0, 20, 100, made.seal.len() - 1] {
        let mut changed = made.seal.clone();
        changed[at] ^= 1;
        assert_eq!(open(&changed, WORD), Err(MysteryError::WrongWord), "{at}");
    }
    for length in [0, 15, 16, made.seal.len() - 1] {
        assert_eq!(open(&made.seal[..length], WORD), Err(MysteryError::BadSeal));
    }
}

#[test]
fn a_file_and_a_link_are_the_same_measurement_and_the_link_is_short() {
    for (experiment, id, samples) in [
        (Experiment::Relay, "coulomb_friction", 8000),
        (Experiment::Sines, "coulomb_friction", 8000),
        (Experiment::Stairs, "coulomb_friction", 8000),
        (Experiment::ProcessRelay, "second_lag", 2000),
        (Experiment::ProcessStairs, "saturation", 2000),
        (Experiment::ProcessBinary, "input_delay", 2000),
    ] {
        let made = mystery(experiment, &[id]);
        let link = made.link();
        assert!(link.len() < LINK, "{experiment:?}: {}", link.len());
        let read = Mystery::from_link(&link).expect("a link of ours");
        assert_eq!(read, made);
        assert_eq!(read.name(), made.name());
        let file = made.csv();
        assert_eq!(seal_of(file.as_bytes()).as_ref(), Some(&made.seal));
        // Some editors end lines in another way.
        let windows = file.replace('\n', "\r\n");
        assert_eq!(seal_of(windows.as_bytes()).as_ref(), Some(&made.seal));
        let measurement = measured(&made);
        assert_eq!(
            (measurement.len(), &measurement.warnings[..]),
            (samples, &[][..])
        );
        assert_eq!(measurement.kind, experiment.kind());
        let unit = match measurement.kind {
            Kind::Drive => "N m",
            Kind::Process => "1",
        };
        assert_eq!(measurement.input.unit, unit);
    }
    assert_eq!(seal_of(b"# a comment\nt [s],u [N m],x1 [rad]\n"), None);
}

#[test]
fn a_surprise_is_none_one_or_two_effects_that_the_experiment_shows() {
    for experiment in [Experiment::Stairs, Experiment::ProcessStairs] {
        let mut seen = [0; 3];
        for salt in 0..14 {
            let made = make(&request(experiment, Choice::Surprise, salt)).expect("a mystery");
            let reveal = Reveal::open(&made.seal, WORD, &Answer::default()).expect("the word");
            let hidden = &reveal.truth.hidden;
            seen[hidden.len()] += 1;
            for Hidden { effect, parameters } in hidden {
                let mut menu = hideable(experiment.kind()).iter();
                let item = menu.find(|h| h.id == *effect);
                let item = item.expect("an effect of the menu");
                assert!(item.shown_by.contains(&experiment), "{effect}");
                let [least, most] = item.range;
                assert!((least..=most).contains(&parameters[0].1), "{effect}");
            }
        }
        assert!(seen.iter().all(|n| *n > 0), "{seen:?}");
    }
}

#[test]
fn the_menu_says_what_the_library_has() {
    for kind in [Kind::Drive, Kind::Process] {
        for item in hideable(kind) {
            let effect = item.effect().expect("an effect of the library");
            assert!(effect.kinds().contains(&kind), "{}", item.id);
            let (symbol, label, _) = item.parameter();
            assert!(!symbol.is_empty() && !label.is_empty(), "{}", item.id);
            assert!(
                item.shown_by.iter().all(|e| e.kind() == kind),
                "{}",
                item.id
            );
            let [least, most] = item.range;
            for value in Strength::ALL.map(|s| item.value(s)) {
                assert!((least..=most).contains(&value), "{}", item.id);
            }
        }
    }
}

#[test]
fn what_the_bench_cannot_do_is_refused_in_one_sentence() {
    let refused = |picks: Vec<Pick>, word: &str| {
        let asked = Request {
            word: word.to_owned(),
            ..request(Experiment::Relay, Choice::Chosen(picks), 1)
        };
        let sentence = make(&asked).expect_err("it cannot be").to_string();
        assert_eq!(sentence.lines().count(), 1);
        assert!(sentence.ends_with('.'), "{sentence}");
        sentence
    };
    assert!(refused(vec![], "whale").contains("too short (5): it needs at least 6"));
    let strange = Pick {
        effect: id("load_ramp"),
        value: 1.0,
    };
    assert!(refused(vec![strange], WORD).contains("cannot hide load_ramp"));
    for value in [0.0, 1e9, f64::NAN, f64::INFINITY] {
        let much = Pick {
            value,
            ..pick(Kind::Drive, "coulomb_friction")
        };
        assert!(refused(vec![much], WORD).contains("0.005 to 0.12 N m"));
    }
    let drive = |id| pick(Kind::Drive, id);
    let both = vec![drive("coulomb_friction"), drive("stribeck_friction")];
    assert!(refused(both, WORD).contains("cannot be hidden together"));
    let four = ["coulomb_friction", "input_delay", "dead_zone", "cogging"];
    let four = four.into_iter().map(drive).collect();
    assert!(refused(four, WORD).contains("At most 3"));
}

/// A truth with friction and delay.
fn truth() -> Truth {
    let hidden = |effect: &str, symbol: &str, value| Hidden {
        effect: id(effect),
        parameters: vec![(symbol.to_owned(), value)],
    };
    Truth {
        kind: Kind::Drive,
        hidden: vec![
            hidden("coulomb_friction", "c", 0.04),
            hidden("input_delay", "tau", 1e-3),
        ],
        baseline: vec![("J1".to_owned(), 9e-4), ("d1".to_owned(), 2e-3)],
    }
}

fn parameter(effect: Option<&str>, name: &str, value: f64, std_error: f64) -> Parameter {
    serde_json::from_value(serde_json::json!({
        "effect": effect, "name": name, "label": name, "value": value, "std_error": std_error, "unit": "1",
    }))
    .expect("a parameter")
}

#[test]
fn the_points_follow_the_rule() {
    let exact = vec![
        parameter(None, "J1", 9e-4, 0.0),
        parameter(None, "d1", 2e-3, 0.0),
        parameter(Some("coulomb_friction"), "c", 0.04, 0.0),
        parameter(Some("input_delay"), "tau", 1e-3, 0.0),
    ];
    let judge = |effects: &[(&str, &[&str])], parameters: &[Parameter]| {
        let answer = Answer {
            effects: effects
                .iter()
                .map(|(e, class)| (id(e), class.iter().map(|c| id(c)).collect()))
                .collect(),
            parameters: parameters.to_vec(),
        };
        Reveal::of(truth(), &answer)
    };
    let near = |value: f64, wanted: f64| assert!((value - wanted).abs() < 1e-9, "{value} {wanted}");
    let both: &[(&str, &[&str])] = &[
        ("viscous_friction", &[]),
        ("input_delay", &[]),
        ("coulomb_friction", &[]),
    ];
    near(judge(both, &exact).points(), 100.0);
    // 4 % off is close; 30 % off loses half of its mark, 25 % off within two standard errors nothing.
    let mut off = exact.clone();
    off[0].value *= 1.04;
    near(judge(both, &off).points(), 100.0);
    off[3].value *= 1.30;
    near(judge(both, &off).points(), 100.0 - 30.0 / 4.0 * 0.5);
    off[3].value = 1.25e-3;
    off[3].std_error = 1.3e-4;
    near(judge(both, &off).points(), 100.0);
    // Nothing can be bought with a large standard error.
    off[3].value = 9e-3;
    off[3].std_error = 1.0;
    near(judge(both, &off).points(), 70.0 + 30.0 * 0.75);
    // One found, one missed with its number, one that is not there.
    let some: &[(&str, &[&str])] = &[("coulomb_friction", &[]), ("cogging", &[])];
    let reveal = judge(some, &exact[..3]);
    near(reveal.effect_points[0], 70.0 / 3.0);
    near(reveal.number_points[0], 30.0 * 0.75);
    let mark = |effect: &str| {
        let row = reveal
            .rows
            .iter()
            .find(|Row { effect: e, .. }| *e == id(effect));
        row.expect("a row").mark
    };
    assert_eq!(mark("coulomb_friction"), Mark::Right);
    assert_eq!(mark("input_delay"), Mark::Missed);
    assert_eq!(mark("cogging"), Mark::Wrong);
    // What the record cannot tell apart is right; the simplest model is then not asked.
    let class: &[(&str, &[&str])] = &[
        ("actuator_lag", &["actuator_lag", "input_delay"]),
        ("coulomb_friction", &["coulomb_friction"]),
    ];
    let reveal = judge(class, &exact[2..3]);
    assert_eq!(reveal.rows[1].mark, Mark::Alike(id("actuator_lag")));
    near(reveal.points(), 100.0);
    // Where nothing is hidden, nothing is to be added.
    let nothing = Truth {
        hidden: vec![],
        ..truth()
    };
    let clean = Answer {
        effects: vec![],
        parameters: exact.clone(),
    };
    near(Reveal::of(nothing.clone(), &clean).points(), 100.0);
    let added = Answer {
        effects: vec![(id("cogging"), vec![])],
        ..clean
    };
    near(Reveal::of(nothing, &added).points(), 30.0);
}

fn some_mystery() -> impl Strategy<Value = Mystery> {
    let kind = prop_oneof![Just(Kind::Drive), Just(Kind::Process)];
    let rows = prop::collection::vec(any::<[i32; 3]>(), 20..200);
    let seal = prop::collection::vec(any::<u8>(), 0..100);
    (kind, 1..=u32::MAX, rows, seal).prop_map(|(kind, step, rows, seal)| Mystery {
        kind,
        step,
        columns: (0..columns(kind).len())
            .map(|i| rows.iter().map(|row| row[i]).collect())
            .collect(),
        seal,
    })
}

proptest! {
    #[test]
    fn any_record_comes_back_from_its_link(made in some_mystery()) {
        prop_assert_eq!(Mystery::from_link(&made.link()), Ok(made));
    }

    #[test]
    fn a_changed_link_is_another_record_or_one_sentence(
        made in some_mystery(),
        at in any::<prop::sample::Index>(),
        letter in "[A-Za-z0-9_-]",
        cut in any::<prop::sample::Index>(),
    ) {
        let link = made.link();
        let i = at.index(link.len());
        let changed = format!("{}{letter}{}", &link[..i], &link[i + 1..]);
        for text in [changed.as_str(), &link[..cut.index(link.len())]] {
            if let Err(error) = Mystery::from_link(text) {
                prop_assert_eq!(error.to_string().lines().count(), 1);
            }
        }
    }

    #[test]
    fn no_text_makes_it_panic(text in any::<String>(), letters in "[A-Za-z0-9_-]{0,300}") {
        let _ = Mystery::from_link(&text);
        let _ = Mystery::from_link(&letters);
        let _ = Mystery::from_link(&format!("AQ{letters}"));
        let _ = seal_of(text.as_bytes());
        let _ = seal_of(format!("# sealed truth 1: {text}").as_bytes());
    }
}
