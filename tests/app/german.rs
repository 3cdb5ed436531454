//! The app in German: every text has a translation, and none is left out on any page.

use std::collections::BTreeSet;

use crate::support::ui::{App, NARROW, PLACES, TALL, WIDE, app, click, finish, show, state};
use egui::epaint::{ClippedShape, Shape};
use egui_kittest::kittest::Queryable as _;
use hysteron::language::{self, Catalogue, Language, is_plain, tr_number};
use hysteron::lessons;
use hysteron_core::message::Message;
use hysteron_core::msg;

/// Texts that are the same in both languages.
const SAME: [&str; 6] = ["Start", "Export", "Motor", "P(jω)", "Name", "Deutsch"];

fn painted(harness: &App) -> BTreeSet<String> {
    let mut texts = BTreeSet::new();
    for ClippedShape { shape, .. } in &harness.output().shapes {
        collect(shape, &mut texts);
    }
    texts
}

fn collect(shape: &Shape, texts: &mut BTreeSet<String>) {
    match shape {
        Shape::Text(text) => {
            texts.insert(text.galley.job.text.clone());
        }
        Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, texts)),
        _ => {}
    }
}

fn speak(harness: &mut App, language: Language) {
    harness.state_mut().speak(language);
    finish(harness);
}

/// What stands on the screen in English when German is spoken: what has no translation, and what is painted
/// in both languages alike.
#[derive(Default)]
struct English(BTreeSet<String>);

impl English {
    /// Looks at the app as it is now.
    fn look(&mut self, harness: &mut App) {
        speak(harness, Language::English);
        let english = painted(harness);
        speak(harness, Language::German);
        let german = painted(harness);
        let alike = german.intersection(&english);
        let words = alike.filter(|t| !is_plain(t) && !SAME.contains(&t.trim()));
        self.0.extend(words.cloned());
        // Formulas and names of files have a point in every language.
        let pointed = german.iter().filter(|t| tr_number(t.as_str()) != **t);
        let pointed = pointed.filter(|t| !t.contains("e^{-0.5s}") && !t.contains("[counts, "));
        self.0.extend(pointed.cloned());
        self.0.extend(language::missed());
    }

    fn assert_none(&self) {
        assert!(self.0.is_empty(), "{:#?}", self.0);
    }
}

/// Opens what can be opened on the page.
fn unfold(harness: &mut App, labels: &[&str]) {
    for label in labels {
        if let Some(found) = harness.query_all_by_label(label).next() {
            found.click_accesskit();
        }
        finish(harness);
    }
}

fn german() -> Catalogue {
    Language::German.catalogue()
}

#[test]
fn the_texts_have_the_same_slots_in_both_languages() {
    assert_eq!(german().faults(), Vec::<String>::new());
    assert!(german().english().count() > 1000);
}

/// Files whose texts are not read: what writes and reads files, and what tests read.
const NOT_DRAWN: [&str; 26] = [
    "core/src/rig/",
    "core/src/mystery/record.rs",
    "app/work/src/worker.rs",
    "app/src/export/",
    "app/work/src/language/",
    "app/src/hook.rs",
    "app/src/app/program.rs",
    "app/src/app/start.rs",
    "app/src/address.rs",
    "app/src/pages/compare/export.rs",
    "app/src/lessons/mod.rs",
    "app/src/lessons/question.rs",
    "app/src/lessons/markdown.rs",
    "core/src/report/html.rs",
    // What only the command line says.
    "core/src/drive/scenario.rs",
    "core/src/drive/record.rs",
    "core/src/backlash/map.rs",
    "core/src/measurement/mat/",
    "core/src/diagnosis/limits.rs",
    "core/src/user_model/write.rs",
    "core/src/plant/state_space.rs",
    "core/src/model/",
    // Its sentences are for the report of a command; the page has its own.
    "core/src/tuning/report.rs",
    "core/src/tuning/experiment.rs",
    "core/src/tuning/closed_loop.rs",
    // Options of the command line.
    "core/src/measurement/advice.rs",
];

/// Literals that are no texts: names under which things are kept or drawn, and reasons for the compiler.
const NO_TEXTS: [&str; 64] = [
    "Crew",
    // By which logs of tuners are known.
    "rule: ziegler-nichols",
    "state: relay step",
    "PID Autotuner output with",
    // Help, which stays as it is.
    "Record of a relay test as CSV or MATLAB file, or the log of an auto-tuner: Klipper, Marlin, ESPHome, Mycodo, Home Assistant",
    "Downloads",
    "hysteron files",
    "hysteron address",
    "hysteron motion",
    "reduced motion",
    "(prefers-reduced-motion: reduce)",
    "µN m s²/rad²",
    "hysteron language",
    "hysteron lessons",
    "hysteron look",
    "hysteron side",
    "copy link",
    "lesson below",
    "phase of the motor",
    "own effect",
    "map choices",
    "adaptation table",
    "loop nyquist",
    "asymmetric run",
    "ultimate table",
    "a download has no dialog",
    "only a browser asks for it",
    "a thread needs no messages",
    "reads like fail",
    "the message of each says it",
    "no numbers",
    "MNm",
    "the room is named after its trait",
    "measured load",
    "measured step",
    "measured nyquist",
    "measured gains",
    "measured models",
    // Words by which logs are recognised, as their tuners write them.
    "Autotune is still running!",
    "Autotune is still running",
    "Frequency is not symmetrical",
    "Oscillation Amplitude:",
    "Oscillation Period:",
    "Setpoint changed",
    "Turning output to ",
    "oscillation amplitude",
    "Stats ",
    "Bad heater id",
    "PID Autotune start",
    "Temperature too high",
    "Autotune: raw=",
    "PID Autotune finished!\n  ",
    "PID Autotune",
    "found peak:",
    "state:   failed",
    "state: failed",
    "switched state: relay step ",
    "switched state: relay",
    // Names that files give, and what the reader of JSON says, which is put into our sentence as it is.
    "sample time",
    "sample period",
    "sampling interval",
    "sample interval",
    "Units",
    "numbers, in arrays or objects",
];

/// Whether a literal says something: several words, or one that begins a sentence.
fn speaks(text: &str) -> bool {
    let words = text.split(|c: char| !c.is_alphabetic());
    let words: Vec<&str> = words.filter(|w| w.chars().count() > 1).collect();
    let several = text.contains(' ') && words.len() > 1;
    let begins =
        words.len() == 1 && text.trim() == words[0] && text.starts_with(char::is_uppercase);
    !is_plain(text) && (several || begins)
}

/// Whether a known text has all that a literal says, in its order. The core puts sentences together of several
/// literals, so that one may be a part of what is known.
fn holds(known: &str, literal: &str) -> bool {
    let mut rest = known;
    literal
        .split("{}")
        .all(|part| match rest.find(part.trim()) {
            Some(at) => {
                rest = &rest[at + part.trim().len()..];
                true
            }
            None => false,
        })
}

/// A message is looked up by its words as they are: a part of another text does not help.
#[test]
fn every_message_in_the_source_has_its_german_words() {
    let known: BTreeSet<String> = german().english().collect();
    let mut unknown = BTreeSet::new();
    let mut seen = 0;
    for file in ["app/src", "app/cli/src", "app/work/src", "core/src"]
        .into_iter()
        .flat_map(crate::support::source::files)
    {
        let name = file.display().to_string();
        if name.ends_with("core/src/message.rs") || NOT_DRAWN.iter().any(|n| name.contains(n)) {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("a file");
        let messages = text.split("msg!(").skip(1).map(str::trim_start);
        for words in messages.filter(|m| m.starts_with('"')) {
            let literals = crate::support::source::literals(words);
            let words = literals.into_iter().next().unwrap_or_default();
            seen += 1;
            if !is_plain(&words) && !known.contains(&words) {
                unknown.insert(format!("{name}: {words:?}"));
            }
        }
    }
    assert!(seen > 500, "{seen}");
    assert!(unknown.is_empty(), "{unknown:#?}");
}

#[test]
fn every_text_in_the_source_has_a_german_one() {
    let known: Vec<String> = german().english().collect();
    let mut unknown = BTreeSet::new();
    for file in ["app/src", "app/cli/src", "app/work/src", "core/src"]
        .into_iter()
        .flat_map(crate::support::source::files)
    {
        let name = file.display().to_string();
        if NOT_DRAWN.iter().any(|n| name.contains(n)) {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("a file");
        for literal in crate::support::source::literals(&text) {
            let mut sentences = literal.split(". ");
            // An axis is said by its name, and its unit beside it.
            let axis = literal.strip_suffix(']').and_then(|l| l.rsplit_once(" ["));
            let said = axis.is_some_and(|(name, _)| known.iter().any(|k| k == name))
                || sentences.all(|s| known.iter().any(|k| holds(k, s)));
            // Markup and drawing have no words of their own: what they say is put into them.
            if literal.contains(['<', '>']) && name.contains("core/src/report/") {
                continue;
            }
            if speaks(&literal) && !said && !NO_TEXTS.contains(&literal.as_str()) {
                unknown.insert(format!("{name}: {literal:?}"));
            }
        }
    }
    assert!(unknown.is_empty(), "{unknown:#?}");
}

/// German texts whose English is put together of what is known by name, or comes from where keys are named.
const OF_NAMES: [&str; 7] = [
    "Escape",
    "SIMC PI",
    "SIMC PID",
    "AMIGO PI",
    "AMIGO PID",
    "Moving point PI",
    "Moving point PID",
];

/// A text that nothing says any more is left out.
#[test]
fn every_german_text_is_said_somewhere() {
    let mut said: BTreeSet<String> = OF_NAMES.map(str::to_owned).into();
    for file in ["app/src", "app/cli/src", "app/work/src", "core/src"]
        .into_iter()
        .flat_map(crate::support::source::files)
        // It has a style sheet, which is a raw string, and no text.
        .filter(|f| !f.ends_with("core/src/report/html.rs"))
    {
        let text = std::fs::read_to_string(&file).expect("a file");
        for literal in crate::support::source::literals(&text) {
            // Axes are named with their units, by ids, and lists by what stands between.
            let name = literal.rsplit_once(" [").map_or("", |(name, _)| name);
            said.extend([name, literal.trim()].map(str::to_owned));
            said.extend([literal.replace('_', " "), literal]);
        }
    }
    let unsaid: Vec<String> = german().english().filter(|t| !said.contains(t)).collect();
    assert!(unsaid.is_empty(), "{unsaid:#?}");
}

#[test]
fn no_page_leaves_a_text_in_english() {
    let mut english = English::default();
    let mut harness = app("start", TALL);
    for place in PLACES {
        show(&mut harness, place);
        unfold(
            &mut harness,
            &[
                "Die Gleichungen",
                "Pole, Nullstellen, Verstärkung",
                "Gleichung",
            ],
        );
        english.look(&mut harness);
    }
    for page in harness.state().page_ids() {
        let mut harness = app(page, NARROW);
        finish(&mut harness);
        english.look(&mut harness);
    }
    english.assert_none();
}

#[test]
fn the_sentences_of_an_experiment_stay_in_their_order() {
    let gains = msg!(
        "a relay with gains {} and {} in turn, {} s each",
        0.55,
        "0.16 N m".to_owned(),
        0.035
    );
    let hysteresis = msg!("hysteresis {}", "0.39 rad/s".to_owned());
    let relay = Message::list(", ", [gains, hysteresis]);
    let names = Message::list(" and ", ["Gain asymmetry", "Constant load"]);
    let said = msg!("To tell {} apart, measure again with {}.", names, relay)
        .and(msg!(
            "The models would then differ by {} times the noise; in this record they differ by less than {}.",
            132,
            0.01
        ))
        .and(msg!(
            "{} s are enough for this; {} s let all other effects be judged as well.",
            0.07,
            1
        ));
    let said = german().say(&said);
    assert!(said.complete, "{}", said.text);
    let end = "Die Modelle würden sich dann um das 132-Fache des Rauschens unterscheiden; in dieser Aufzeichnung ist \
               es weniger als das 0,01-Fache. Dafür genügen 0,07 s; mit 1 s lassen sich auch alle anderen Effekte \
               beurteilen.";
    assert!(
        said.text.starts_with("Zur Unterscheidung ("),
        "{}",
        said.text
    );
    assert!(said.text.ends_with(end), "{}", said.text);
}

#[test]
fn one_effect_was_missing_or_two_were() {
    let delay = msg!("{}: {}", "Input delay", "0.88 ms ± 1 %".to_owned());
    let zone = msg!("{}: {}", "Dead zone", "0.05 ± 24 %".to_owned());
    let either = Message::list(" or ", ["Dead zone", "Saturation"]);
    for (said, expected) in [
        (
            msg!("The missing effect was {}.", &delay).and("Nothing more is missing."),
            "Der fehlende Effekt war Eingangstotzeit: 0,88 ms ± 1 %. Mehr fehlt nicht.",
        ),
        (
            msg!(
                "The missing effects were {}.",
                Message::list(" and ", [delay, zone])
            )
            .and("Nothing more is missing."),
            "Die fehlenden Effekte waren Eingangstotzeit: 0,88 ms ± 1 % und Tote Zone: 0,05 ± 24 %. Mehr fehlt nicht.",
        ),
        (
            msg!(
                "The missing effects are {}: this record cannot tell which.",
                Message::list(", and ", ["Input delay".into(), either])
            ),
            "Es fehlen Eingangstotzeit und Tote Zone oder Sättigung: Diese Aufzeichnung kann nicht sagen, was davon.",
        ),
    ] {
        let said = german().say(&said);
        assert_eq!((said.text.as_str(), said.complete), (expected, true));
    }
}

#[test]
fn the_keys_are_named_in_german() {
    let mut english = English::default();
    let mut harness = app("lessons", WIDE);
    click(&mut harness, "Keys");
    english.look(&mut harness);
    english.assert_none();
    harness.get_by_label("Strg+Umschalt+Z  oder  Strg+Y");
}

#[test]
fn what_a_record_cannot_decide_is_said_in_german() {
    let mut english = English::default();
    let mut harness = app("compare", TALL);
    let path = format!("{}/../tests/data/drive-05.csv", env!("CARGO_MANIFEST_DIR"));
    let bytes = std::fs::read(path).expect("a file of the tests");
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, "drive-05", &bytes);
    speak(&mut harness, Language::German);
    for look in ["Über der Zeit", "Wo es versagt", "Fingerabdrücke"] {
        unfold(&mut harness, &[look]);
        english.look(&mut harness);
    }
    unfold(&mut harness, &["Verstärkungsasymmetrie hinzufügen"]);
    harness.get_by_label("Mach diesen Versuch");
    unfold(
        &mut harness,
        &[
            "Grenzen des Versuchs",
            "Was andere Versuche verraten würden",
            "Ein eigener Effekt",
        ],
    );
    english.look(&mut harness);
    unfold(&mut harness, &["Ausprobieren"]);
    harness.get_by_label("Zurück zum Vergleich");
    harness.get_by_label_contains(
        "Versuch zur Unterscheidung (Verstärkungsasymmetrie und Konstante Last), für drive-05.",
    );
    english.assert_none();
}

#[test]
fn what_is_refused_is_said_in_german() {
    let mut english = English::default();
    let mut harness = app("compare", TALL);
    let ctx = harness.ctx.clone();
    for (name, text) in [
        ("a.csv", ""),
        ("b.csv", "t [s],u [N m],x1 [rad]\n0,1\n"),
        ("c.csv", "t,u,x1\n0,1,2\n"),
        ("d.csv", "t [s],u [N m],x1 [rad]\n0,1,2\n"),
        ("e.toml", "kind = \"drive\"\n[parameters]\nJ9 = 1\n"),
    ] {
        harness.state_mut().open(&ctx, name, text.as_bytes());
        english.look(&mut harness);
    }
    for link in [
        "nonsense",
        "v9;explore",
        "v1;nowhere",
        "v1;explore;loop.relay.gain=-1",
        "v1;explore;loop.relay.delay=-1",
        "v1;explore;explore.figure=9",
        "v1;backlash;backlash.run.duration=-1",
        "v1;backlash;backlash.run.drive.motor.inertia=0",
        "v1;maps;maps.across.from=9",
        "v1;tune;tune.rule=mine",
        "v1;compare;compare.file=mine",
    ] {
        let refused = harness.state_mut().open_link(&ctx, link);
        assert!(refused.is_err(), "{link}");
        english.look(&mut harness);
    }
    english.assert_none();
}

#[test]
fn the_lessons_ask_the_same_in_both_languages() {
    let [english, german] = Language::ALL.map(|l| lessons::all_in(l).collect::<Vec<_>>());
    assert_eq!(english.len(), german.len());
    for (english, german) in english.iter().zip(&german) {
        let id = english.id;
        assert_eq!(german.faults(), Vec::<String>::new(), "{id}");
        assert_eq!((german.id, german.minutes), (id, english.minutes));
        assert_eq!(german.asked(), english.asked(), "{id}");
        let links = |l: &lessons::Lesson| l.links().collect::<Vec<_>>();
        assert_eq!(links(german), links(english), "{id}");
        assert_ne!(german.title, english.title);
    }
}

#[test]
fn a_language_is_chosen_in_the_menu_and_a_lesson_is_taken_in_it() {
    let mut harness = app("lessons", WIDE);
    click(&mut harness, "Look");
    click(&mut harness, "Deutsch");
    assert_eq!(state(&harness)["language"], "de");
    click(&mut harness, "1  Das Relais und seine Hysterese");
    harness.get_by_label("Deine Antwort").focus();
    harness.step();
    harness.get_by_label("Deine Antwort").type_text("0,7616");
    harness.step();
    unfold(&mut harness, &["Prüfen"]);
    assert_eq!(state(&harness)["solved"], serde_json::json!(["relay"]));
    harness.get_by_label("Richtig.");
    harness.get_by_label("Nächste Lektion: Warum schwingt er?");
    click(&mut harness, "Ansicht");
    click(&mut harness, "English");
    harness.get_by_label("Right.");
}

#[test]
fn a_locale_names_a_language() {
    for (locale, language) in [
        ("de", Some(Language::German)),
        ("de_AT.UTF-8", Some(Language::German)),
        ("DE-ch", Some(Language::German)),
        ("en_US", Some(Language::English)),
        ("C.UTF-8", None),
        ("delta", None),
        ("", None),
    ] {
        assert_eq!(Language::of_locale(locale), language, "{locale}");
    }
}

#[test]
fn the_reader_is_addressed_alike_and_a_thing_has_one_word() {
    let assets = format!("{}/../assets", env!("CARGO_MANIFEST_DIR"));
    let folders = [
        format!("{assets}/german"),
        format!("{assets}/lessons/german"),
    ];
    let files = folders
        .iter()
        .flat_map(|f| std::fs::read_dir(f).expect("a folder"));
    for file in files.flatten() {
        let text = std::fs::read_to_string(file.path()).expect("a text");
        let words: Vec<&str> = text.split_whitespace().collect();
        for pair in words.windows(2) {
            let polite = pair[0].ends_with("en") && pair[1] == "Sie";
            assert!(!polite, "{}: {pair:?}", file.path().display());
            let other = pair[0].starts_with("Spiel");
            assert!(!other, "backlash is Lose: {pair:?}");
        }
    }
}
