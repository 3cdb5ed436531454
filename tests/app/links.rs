//! The whole state in a link: what is on the screen goes into a text and comes back from it, and nothing else
//! comes from any other text.

use crate::support::ui::{
    App, TALL, WIDE, app, click, finish, picture, show, state, texts, type_over,
};
use egui_kittest::kittest::Queryable as _;
use hysteron::{HysteronApp, link};
use hysteron_core::message::Message;
use proptest::prelude::*;
use serde_json::{Value, json};

/// Opens a link in an app of its own and gives the link to what is there then.
fn through(text: &str) -> Result<String, Message> {
    let mut app = HysteronApp::default();
    app.open_link(&egui::Context::default(), text)?;
    Ok(app.link())
}

#[test]
fn untouched_pages_have_the_shortest_links() {
    for id in HysteronApp::default().page_ids() {
        assert_eq!(HysteronApp::at(id).link(), format!("v1;{id}"));
    }
}

#[test]
fn a_link_reads_like_what_it_sets() {
    let text = "v1;explore;loop.plant.denominator=3,1;loop.plant.dead_time=0.5;loop.relay.gain=2;explore.margin=true";
    let mut app = HysteronApp::default();
    let ctx = egui::Context::default();
    app.open_link(&ctx, &format!("https://example.org/lab/#{text}"))
        .expect("a link");
    assert_eq!(app.hook_state()["page"], "explore");
    let written = app.link();
    let mut parts: Vec<&str> = written.split(';').collect();
    let mut expected: Vec<&str> = text.split(';').collect();
    parts.sort_unstable();
    expected.sort_unstable();
    assert_eq!(parts, expected);
}

#[test]
fn what_was_set_by_hand_comes_back_in_another_window() {
    let mut here = app("explore", WIDE);
    type_over(&mut here, "P(s) =", "2 e^{-0.5s}/(3s+1)");
    click(&mut here, "phase-margin point S");
    click(&mut here, "Pause");
    let copied = state(&here)["link"].as_str().expect("a link").to_owned();
    assert!(copied.len() < 200, "{copied}");
    let mut there = app("compare", WIDE);
    show(&mut there, &copied);
    for key in [
        "page",
        "link",
        "loop",
        "answer",
        "exact",
        "describing_function",
    ] {
        assert_eq!(state(&there)[key], state(&here)[key], "{key}");
    }
}

#[test]
fn a_link_diagnoses_a_measurement_with_its_effects() {
    let mut there = app("explore", WIDE);
    let text = "v1;compare;compare.effects=%5B%22coulomb_friction%22%5D;compare.file=drive-02";
    show(&mut there, text);
    let shown = state(&there);
    assert_eq!(shown["file"], "drive-02");
    assert!(shown["error"].as_f64().expect("an error") < 1.2, "{shown}");
    assert_eq!(shown["link"], text);
}

#[test]
fn what_a_link_sets_is_set_while_its_file_is_still_read() {
    let mut there = app("explore", WIDE);
    let ctx = there.ctx.clone();
    let texts = [
        "v1;compare;compare.effects=%5B%22coulomb_friction%22%5D;compare.file=drive-02",
        "v1;compare;compare.file=drive-02;compare.look=places",
    ];
    for text in texts {
        assert_eq!(there.state_mut().open_link(&ctx, text), Ok(()));
        assert_eq!(state(&there)["link"], text);
        assert_eq!(state(&there)["busy"], true);
    }
    let magic = "v1;compare;compare.file=drive-02;compare.effects=%5B%22magic%22%5D";
    let refused = there.state_mut().open_link(&ctx, magic);
    assert!(refused.is_err_and(|e| e.to_string().contains("does not exist")));
    finish(&mut there);
    assert_eq!(state(&there)["link"], texts[1]);
    assert!(
        state(&there)["error"].as_f64().is_some_and(|e| e > 2.0),
        "no friction"
    );
}

#[test]
fn a_link_opens_a_measured_drifting_test_and_back() {
    let mut there = app("explore", WIDE);
    let ctx = there.ctx.clone();
    let text = "v1;backlash;backlash.file=drive-10;backlash.paused=1.5";
    show(&mut there, text);
    assert_eq!(state(&there)["file"], "drive-10");
    assert_eq!(state(&there)["clock"], 1.5);
    assert_eq!(state(&there)["link"], text);
    there
        .state_mut()
        .open_link(&ctx, "v1;backlash")
        .expect("a link");
    finish(&mut there);
    assert_eq!(state(&there)["file"], Value::Null);
    assert_eq!(state(&there)["direction"], "against");
}

/// What is written on the screen, the numbers of axes too, without a pointer.
fn written(harness: &mut App) -> Vec<String> {
    harness.remove_cursor();
    harness.run_steps(4);
    let mut texts = texts(harness);
    texts.sort();
    texts
}

/// Zooms into the plot of this name by a pinch.
fn zoom_in(harness: &mut App, axes: &str) -> Value {
    let menu = format!("Menu of the plot: {axes}");
    let mut menus = harness.get_all_by_label(&menu);
    let corner = menus.next().expect("a plot").rect().left_top();
    drop(menus);
    harness.hover_at(corner - egui::vec2(90.0, 60.0));
    harness.step();
    harness.input_mut().events.push(egui::Event::Zoom(2.5));
    finish(harness);
    state(harness)["link"].clone()
}

#[test]
fn the_zoom_of_a_plot_comes_back_in_another_window() {
    for (place, axes, plot) in [
        (
            "v1;explore;explore.paused=20",
            "output y, input u over time [s]",
            "explore=time:",
        ),
        (
            "v1;tune",
            "output y, input u over time [s]",
            "tune=relay_run:",
        ),
        (
            "v1;tune;tune.step=ultimate",
            "imaginary part over real part",
            "tune=ultimate:",
        ),
        (
            "v1;backlash;backlash.paused=1",
            "position [mrad] over time [s]",
            "backlash=positions:",
        ),
        (
            "v1;compare;compare.file=drive-02",
            "v1 [rad/s] over time [s]",
            "compare=time:",
        ),
        (
            "v1;compare;compare.file=drive-02;compare.look=places",
            "rms [× noise] over velocity [rad/s]",
            "compare=atlas_",
        ),
    ] {
        let mut here = app("start", TALL);
        show(&mut here, place);
        let link = zoom_in(&mut here, axes);
        let copied = link.as_str().expect("a link");
        assert!(
            copied.contains(&format!("zoom.{plot}")),
            "{place}: {copied}"
        );
        assert!(copied.len() < place.len() + 80, "{copied}");
        let seen = written(&mut here);

        let mut there = app("lessons", TALL);
        show(&mut there, copied);
        assert_eq!(state(&there)["link"], link, "{place}");
        assert_eq!(written(&mut there), seen, "{place}");
        // A link without it shows all, also where one has zoomed.
        let mut whole = app("lessons", TALL);
        show(&mut whole, place);
        show(&mut there, place);
        assert_eq!(state(&there)["link"], place);
        assert_eq!(written(&mut there), written(&mut whole), "{place}");
        assert_ne!(written(&mut there), seen, "{place}");
    }
}

#[test]
fn a_zoom_is_taken_back_and_is_not_of_the_next_record() {
    let mut harness = app("start", TALL);
    show(&mut harness, "v1;compare;compare.file=drive-02");
    let axes = "v1 [rad/s] over time [s]";
    let zoomed = zoom_in(&mut harness, axes);
    assert!(zoomed.as_str().is_some_and(|l| l.contains("zoom")));
    // Long enough for undo to take it for a step.
    harness.run_steps(12);
    click(&mut harness, "Undo");
    assert_eq!(state(&harness)["link"], "v1;compare;compare.file=drive-02");
    click(&mut harness, "Redo");
    assert_eq!(state(&harness)["link"], zoomed);
    click(&mut harness, "Open another");
    assert_eq!(state(&harness)["link"], "v1;compare");
}

/// The bytes of a file of the tests.
fn data(name: &str) -> Vec<u8> {
    let file = format!("{}/../tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(file).expect("a file of the tests")
}

/// Opens a file of the user's, and waits until undo takes it for a step.
fn open(harness: &mut App, name: &str, bytes: &[u8]) {
    let ctx = harness.ctx.clone();
    harness.state_mut().open(&ctx, name, bytes);
    finish(harness);
    harness.run_steps(12);
}

#[test]
fn it_is_said_which_files_a_link_cannot_carry() {
    let mut harness = app("compare", TALL);
    let copy = |harness: &mut App| {
        click(harness, "Copy link");
        let said = state(harness)["notice"].clone();
        said.as_str().expect("a notice").to_owned()
    };
    open(&mut harness, "drive-02", &data("drive-02.csv"));
    open(&mut harness, "rig.toml", b"kind = \"drive\"\n");
    assert!(copy(&mut harness).contains("The file rig.toml is not"));
    open(&mut harness, "one.csv", &data("drive-02.csv"));
    assert!(copy(&mut harness).contains("The files one.csv, rig.toml are not"));
}

#[test]
fn a_file_of_ones_own_can_be_gone_back_to() {
    for page in ["compare", "backlash"] {
        let mut harness = app(page, TALL);
        finish(&mut harness);
        harness.run_steps(12);
        open(&mut harness, "one.csv", &data("drive-12.csv"));
        let opened = state(&harness);
        assert_eq!(opened["file"], "one.csv", "{page}");
        click(&mut harness, "Undo");
        finish(&mut harness);
        assert_eq!(state(&harness)["file"], Value::Null, "{page}");
        click(&mut harness, "Redo");
        finish(&mut harness);
        assert_eq!(state(&harness)["notice"], Value::Null, "{page}");
        for key in ["file", "link", "answer", "error"] {
            assert_eq!(state(&harness)[key], opened[key], "{page}: {key}");
        }
    }
}

#[test]
fn a_model_of_ones_own_can_be_gone_back_to() {
    let mut harness = app("compare", TALL);
    open(&mut harness, "one.csv", &data("drive-02.csv"));
    let without = state(&harness);
    let model = "kind = \"drive\"\n[[effects]]\nid = \"coulomb_friction\"\n";
    open(&mut harness, "rig.toml", model.as_bytes());
    let with = state(&harness);
    assert_eq!(with["model"], "rig.toml");
    for (button, expected) in [("Undo", without), ("Redo", with)] {
        click(&mut harness, button);
        finish(&mut harness);
        for key in ["notice", "model", "file", "error"] {
            assert_eq!(state(&harness)[key], expected[key], "{button}: {key}");
        }
    }
}

#[test]
fn what_compare_shows_comes_back_in_another_window() {
    let mut here = app("compare", TALL);
    show(&mut here, "v1;compare;compare.file=drive-02");
    here.get_by_label("Add Coulomb friction").click_accesskit();
    finish(&mut here);
    let steps = state(&here)["steps"].as_array().map_or(0, Vec::len);
    assert_eq!(steps, 2, "the baseline, and what was added");
    for (label, parts) in [
        ("Where it fails", &["compare.look=places"][..]),
        (
            "Show the previous step too",
            &["compare.before=true", "compare.look=places"],
        ),
        (
            "Fingerprints",
            &["compare.before=true", "compare.look=fingerprint"],
        ),
    ] {
        here.get_by_label(label).click_accesskit();
        finish(&mut here);
        comes_back(&here, parts);
    }
    // Another fingerprint than the one that is shown by itself: of the baseline, beside which others were tried.
    let mut here = app("compare", TALL);
    show(
        &mut here,
        "v1;compare;compare.file=drive-02;compare.look=fingerprint",
    );
    assert_ne!(state(&here)["fingerprint"], "presliding_friction");
    here.get_by_label_contains("Presliding friction 0")
        .click_accesskit();
    finish(&mut here);
    comes_back(&here, &["compare.fingerprint=presliding_friction"]);
}

/// Whether the link to what is here has these settings, and shows them in another window.
fn comes_back(here: &App, parts: &[&str]) {
    let link = state(here)["link"].as_str().expect("a link").to_owned();
    for part in parts {
        assert!(link.split(';').any(|p| p == *part), "{part}: {link}");
    }
    let mut there = app("explore", TALL);
    show(&mut there, &link);
    for key in ["link", "effects", "error", "steps", "fingerprint", "plots"] {
        assert_eq!(state(&there)[key], state(here)[key], "{key} of {link}");
    }
}

#[test]
fn a_refused_link_says_why_in_one_sentence_and_changes_nothing() {
    let mut harness = app("explore", WIDE);
    type_over(&mut harness, "P(s) =", "1/(s+1)^4");
    click(&mut harness, "Pause");
    click(&mut harness, "From the start");
    let before = state(&harness)["link"].clone();
    let ctx = harness.ctx.clone();
    for (text, reason) in [
        ("", "not a link to Hysteron"),
        ("<script>alert(1)</script>", "not a link to Hysteron"),
        ("v2;explore", "version v2"),
        ("v1;nowhere", "a page that does not exist"),
        ("v1;explore;loop.relay.gian=2", "loop.relay.gian"),
        ("v1;explore;loop.relay.gain=-2", "gain"),
        ("v1;explore;loop.relay.gain=1e999", "bad value"),
        ("v1;explore;loop.relay.delay=1e9", "dead time and delay"),
        ("v1;explore;loop.plant.dead_time=1e8", "dead time and delay"),
        ("v1;tune;loop.relay.delay=1e300", "dead time and delay"),
        ("v1;maps;maps.around.relay.delay=1e9", "dead time and delay"),
        ("v1;explore;loop.relay.gain=fast", "bad value"),
        ("v1;explore;loop.relay=1", "cannot be read"),
        ("v1;explore;loop.relay.gain", "without a value"),
        ("v1;explore;loop.relay.gain=%F", "bad value"),
        ("v1;explore;loop.plant.denominator=%5B1%5D", "order"),
        ("v1;explore;explore.figure=77", "no figure 77"),
        ("v1;backlash;backlash.run.duration=1e9", "120 s"),
        ("v1;backlash;backlash.run.drive.half_gap=-1", "half gap"),
        ("v1;compare;compare.file=passwords.csv", "passwords.csv"),
        (
            "v1;compare;compare.file=drive-02;compare.effects=%5B%22magic%22%5D",
            "does not exist",
        ),
        ("v1;compare;compare.mystery=AAAA", "another version"),
        ("v1;compare;compare.mystery=AQ-not", "no mystery"),
        (
            "v1;compare;compare.mystery=%C3%A4",
            "characters that do not belong",
        ),
        ("v1;compare;compare.mystery=7", "cannot be read"),
        (
            "v1;compare;compare.mystery=AQ;compare.file=drive-02",
            "not both",
        ),
        ("v1;explore;zoom.explore=time:0,nan", "impossible"),
        ("v1;explore;zoom.explore=time:5,2", "impossible"),
        ("v1;explore;zoom.explore=7", "impossible"),
        ("v1;explore;zoom=7", "impossible"),
        ("v1;explore;zoom.nowhere=time:0,1", "zoom.nowhere"),
        ("v1;tune;tune.rule=luck", "rule"),
        ("v1;maps;maps.across.from=9", "must be the larger"),
    ] {
        let refused = harness
            .state_mut()
            .open_link(&ctx, text)
            .expect_err("this is no state of the app");
        assert!(refused.to_string().contains(reason), "{text}: {refused}");
        assert_eq!(refused.to_string().lines().count(), 1, "{refused}");
        assert!(refused.to_string().len() < 240, "{refused}");
        assert_eq!(state(&harness)["notice"], refused.to_string());
        assert_eq!(state(&harness)["link"], before, "{text}");
    }
    let long = format!("v1;explore;loop.relay.gain={}", "1".repeat(40_000));
    assert!(through(&long).is_err_and(|e| e.to_string().contains("too long")));
    harness.step();
    harness.step();
    picture(&mut harness, "link_refused");
    click(&mut harness, "Dismiss");
    assert_eq!(state(&harness)["notice"], Value::Null);
}

#[test]
fn the_button_copies_the_link_to_what_is_on_the_screen() {
    let mut harness = app("tune", WIDE);
    finish(&mut harness);
    click(&mut harness, "2 Ultimate gain");
    harness.get_by_label("Copy link").click();
    let copied = (0..4).find_map(|_| {
        harness.step();
        let commands = &harness.output().platform_output.commands;
        commands.iter().find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    });
    assert_eq!(copied.as_deref(), Some("#v1;tune;tune.step=ultimate"));
}

/// A number as it may stand in a setting, of any size.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::num::f64::NORMAL,
        (-1000_i32..1000).prop_map(f64::from),
        (-1000_i32..1000).prop_map(|n| f64::from(n) / 100.0),
        Just(-0.0),
        Just(5e-324),
        Just(f64::MAX),
    ]
}

/// Any setting: numbers, words, lists, what is missing, and things within things.
fn setting() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        number().prop_map(|v| json!(v)),
        any::<u64>().prop_map(|v| json!(v)),
        any::<i64>().prop_map(|v| json!(v)),
        any::<bool>().prop_map(|v| json!(v)),
        any::<String>().prop_map(|v| json!(v)),
        "[0-9eE.,+-]{0,6}".prop_map(|v| json!(v)),
        Just(Value::Null),
        prop::collection::vec(number(), 0..5).prop_map(|v| json!(v)),
        prop::collection::vec(any::<String>(), 0..3).prop_map(|v| json!(v)),
    ];
    leaf.prop_recursive(3, 24, 4, |inner| {
        prop::collection::btree_map("[a-z_]{1,6}", inner, 0..4).prop_map(|m| json!(m))
    })
}

/// The same numbers, whether written as whole or not: a setting of a number does not care.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => a == b || a.as_f64() == b.as_f64(),
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b))
        }
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(k, v)| b.get(k).is_some_and(|w| same(v, w)))
        }
        _ => a == b,
    }
}

proptest! {
    #[test]
    fn any_settings_survive_the_way_through_a_link(
        settings in prop::collection::btree_map("[a-z_]{1,6}", setting(), 1..5),
        other in setting(),
    ) {
        // The defaults have the same names with other values, or with the same.
        let defaults: Value = settings
            .iter()
            .enumerate()
            .map(|(i, (k, v))| (k.clone(), if i % 2 == 0 { other.clone() } else { v.clone() }))
            .collect();
        let settings = json!(settings);
        let text = link::write("page", &settings, &defaults);
        prop_assume!(text.len() <= link::LONGEST);
        prop_assert!(text.bytes().all(|b| b.is_ascii_graphic() && b != b'#' && b != b'"'));
        let (page, read) = link::read(&text, &defaults).expect("what was written");
        prop_assert_eq!(page, "page");
        prop_assert!(same(&read, &settings), "{} became {} through {}", settings, read, text);
    }

    #[test]
    fn any_loop_comes_back_to_the_last_bit(
        gain in 1e-3_f64..1e3,
        hysteresis in 0.0_f64..10.0,
        asymmetry in -0.9_f64..0.9,
        delay in 0.0_f64..5.0,
        poles in prop::collection::vec(0.01_f64..10.0, 2..6),
        seed in any::<u64>(),
        margin in any::<bool>(),
    ) {
        let list: Vec<String> = poles.iter().map(ToString::to_string).collect();
        let text = format!(
            "v1;explore;explore.margin={margin};loop.relay.gain={gain};loop.relay.hysteresis={hysteresis};\
             loop.relay.asymmetry={asymmetry};loop.relay.delay={delay};loop.plant.denominator={};\
             loop.noise=%7B%22std_dev%22:0.01,%22interval%22:0.02,%22seed%22:{seed}%7D",
            list.join(",")
        );
        let once = through(&text).expect("a loop that can be");
        for (key, value) in [("gain", gain), ("hysteresis", hysteresis), ("asymmetry", asymmetry), ("delay", delay)] {
            let part = format!("loop.relay.{key}=");
            let found = once.split(';').find_map(|p| p.strip_prefix(&part));
            let read: f64 = found.expect("it differs from the default").parse().expect("a number");
            prop_assert_eq!(read.to_bits(), value.to_bits());
        }
        prop_assert!(once.contains(&seed.to_string()));
        prop_assert_eq!(through(&once).expect("a link of ours"), once);
    }

    #[test]
    fn no_text_makes_it_panic(text in any::<String>(), bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = through(&text);
        let _ = through(&format!("v1;explore;{text}"));
        let _ = through(&format!("v1;backlash;backlash.{text}"));
        let _ = through(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn no_value_makes_it_panic(value in setting(), which in 0_usize..9) {
        let path = [
            "loop", "loop.relay.gain", "loop.noise", "loop.plant", "maps.across", "backlash.run",
            "compare.effects", "tune.step", "compare.mystery",
        ][which];
        for page in HysteronApp::default().page_ids() {
            let settings = json!({"x": value});
            let text = link::write(page, &settings, &json!({"x": "nothing"}));
            let _ = through(&text.replace(";x=", &format!(";{path}=")));
        }
    }
}
