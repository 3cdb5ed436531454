//! Every page in every look and in a phone's window: pictures to be looked at.

use std::path::Path;

use crate::support::ui::{App, WIDE, app, click, finish, picture, show, wear};
use hysteron::HysteronApp;
use hysteron::language::Language;

/// A small window, a large one and a phone's, points.
const SMALL: [f32; 2] = [1100.0, 720.0];
const LARGE: [f32; 2] = [1920.0, 1080.0];
const PHONE: [f32; 2] = [390.0, 844.0];

/// Shows a page in a state in which it has something to show and nothing moves.
fn still(harness: &mut App, page: &str) {
    let more = match page {
        "start" => ";start.paused=20",
        "explore" => ";explore.paused=20;explore.margin=true",
        "backlash" => ";backlash.paused=1",
        "compare" => ";compare.file=drive-02",
        "tune" => ";tune.step=loops",
        _ => "",
    };
    show(harness, &format!("v1;{page}{more}"));
}

/// Pictures of these pages, under names that begin so.
fn pictures(harness: &mut App, pages: &[&str], name: &str) {
    for page in pages {
        still(harness, page);
        picture(harness, &format!("{name}_{page}"));
    }
}

fn every_page(look: &str) {
    let mut harness = app("start", SMALL);
    click(&mut harness, "Look");
    click(&mut harness, look);
    let name = format!("look_{}", look.to_lowercase());
    pictures(&mut harness, &HysteronApp::default().page_ids(), &name);
}

#[test]
fn dark() {
    every_page("Dark");
}

#[test]
fn light() {
    every_page("Light");
}

#[test]
fn projector() {
    every_page("Projector");
}

#[test]
fn on_a_phone() {
    let mut harness = app("start", PHONE);
    pictures(&mut harness, &HysteronApp::default().page_ids(), "phone");
}

#[test]
fn on_a_phone_in_german() {
    let mut harness = app("start", PHONE);
    harness.state_mut().speak(Language::German);
    finish(&mut harness);
    pictures(
        &mut harness,
        &["start", "explore", "compare"],
        "phone_german",
    );
}

/// More of some pages than they open with: a name and a link.
const MORE: [(&str, &str); 3] = [
    (
        "backlash-blocks",
        "v1;backlash;backlash.structure=true;backlash.paused=1",
    ),
    (
        "compare-added",
        "v1;compare;compare.file=drive-02;compare.effects=%5B%22coulomb_friction%22%5D",
    ),
    ("tune-relay", "v1;tune"),
];

/// For a person to look through; a test of what they show would be a test of every pixel.
#[test]
#[ignore = "writes pictures to be looked at: cargo xtask pictures"]
fn pictures_of_every_page_in_each_look_and_window() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/pictures");
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut written = 0;
    for size in [WIDE, LARGE, PHONE] {
        for look in ["Dark", "Light", "Projector"] {
            let mut harness = app("start", size);
            wear(&mut harness, look);
            let mut write = |harness: &mut App, name: &str| {
                let name = format!("{}x{}-{look}-{name}.png", size[0], size[1]);
                let picture = harness.render().expect("a picture");
                assert_eq!(picture.width(), size[0] as u32, "{name}");
                picture.save(folder.join(&name)).expect(&name);
                written += 1;
            };
            for page in HysteronApp::default().page_ids() {
                still(&mut harness, page);
                write(&mut harness, page);
            }
            for (name, link) in MORE {
                show(&mut harness, link);
                write(&mut harness, name);
            }
        }
    }
    println!("{written} pictures in {}", folder.display());
}
