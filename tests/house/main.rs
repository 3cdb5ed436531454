//! The house stands: files in layers, without circles, and each effect in its own file.
//!
//! Read from the source itself: every path is followed through `use` and `pub use` to the file that defines what it
//! names. That a module passes a name on, or has a file as its child, is no import.

#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    reason = "the core neither prints nor reads files; this test does"
)]

mod guides;
mod imports;
mod made_up;
mod tree;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::LazyLock;

use imports::{Imports, circles, imports as imports_of};
use tree::{Tree, crates_in};

/// Rooms of core, lowest first, then those of the app: a file imports from its own room and from rooms before it.
const ROOMS: [&str; 46] = [
    // what is said
    "message",
    // small numerics, no physics
    "count",
    "order",
    "sums",
    "simplex",
    "root",
    "random",
    "curve",
    "equation",
    "exponential",
    "fourier",
    "crew",
    "packed",
    "progress",
    "uncertain",
    "least_squares",
    "measurement",
    "controller",
    // the linear loop
    "plant",
    "relay",
    "simulate",
    "limit_cycle",
    "on_off",
    "tuning",
    "explore",
    "maps",
    "figures",
    "model",
    // two masses; the independent bench
    "drive",
    "hunting",
    "backlash",
    "rig",
    "effect",
    "diagnosis",
    "opening",
    "user_model",
    "by_hand",
    "criticism",
    "report",
    "mystery",
    "scenario",
    // the app
    "app: work",
    "app: command line",
    "app: parts",
    "app: pages",
    "app: shell",
];

/// The effects that are named elsewhere: what contacts tell of a gap, and what turns viscous friction into dry
/// friction.
const NAMED_ELSEWHERE: [(&str, &str); 2] = [
    ("core/src/criticism/dry_or_viscous.rs", "coulomb_friction"),
    ("core/src/criticism/knowledge.rs", "backlash"),
];

/// Still to be mended: rooms with circles, arrows upward, pages that import others. A test
/// fails for a line that is needed no more, so that the lists only become shorter.
const KNOWN_CIRCLES: &[&str] = &[];
const KNOWN_UPWARD: &[(&str, &str)] = &[];
const KNOWN_PAGES: &[&str] = &[];

/// Where the app's pages stand, a folder each, and the files there that are no page.
const PAGES: &str = "app/src/pages/";
const REGISTRY: [&str; 2] = ["app/src/pages/mod.rs", "app/src/pages/registry.rs"];

/// The window around the pages, and what starts it.
const SHELL: [&str; 4] = [
    "app/src/app.rs",
    "app/src/start.rs",
    "app/src/program.rs",
    "app/src/main.rs",
];

/// The room that a file belongs to; the list of modules of a crate belongs to none.
fn room(file: &str) -> Option<&str> {
    if let Some(inside) = file.strip_prefix("core/src/") {
        let room = inside.split(['/', '.']).next();
        return room.filter(|room| *room != "lib");
    }
    let is_shell = |f: &str| f.starts_with("app/src/app/") || SHELL.contains(&f);
    let room = match file {
        f if f.ends_with("/lib.rs") => return None,
        f if f.starts_with("app/work/") => "app: work",
        f if f.starts_with("app/cli/") => "app: command line",
        f if page(f).is_some() => "app: pages",
        f if REGISTRY.contains(&f) || is_shell(f) => "app: shell",
        _ => "app: parts",
    };
    Some(room)
}

/// The page that a file belongs to.
fn page(file: &str) -> Option<&str> {
    let inside = file
        .strip_prefix(PAGES)
        .filter(|_| !REGISTRY.contains(&file))?;
    inside.split(['/', '.']).next()
}

/// Whether a file may name the effect of this id: its own, those that list effects, and the menu of the mysteries.
fn may_name(file: &str, id: &str) -> bool {
    let own = format!("core/src/effect/{id}");
    let lists = [
        "core/src/effect/mod.rs",
        "core/src/effect/registry.rs",
        "core/src/mystery/menu",
    ];
    file == format!("{own}.rs")
        || file.starts_with(&format!("{own}/"))
        || lists.iter().any(|l| file.starts_with(l))
}

/// The project's own modules, and what its files need of each other.
static HOUSE: LazyLock<(Tree, Imports)> = LazyLock::new(|| {
    let tree = own_tree();
    let imports = imports_of(&tree);
    (tree, imports)
});

fn own_tree() -> Tree {
    let project = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let (crates, files) = crates_in(project, &["core", "app"]).unwrap();
    let tree = Tree::read(&crates, &files).unwrap();
    let read: BTreeSet<&String> = tree.modules.iter().map(|m| &m.file).collect();
    let unread: Vec<&String> = files
        .keys()
        .filter(|file| !read.contains(file) && !tree.for_tests.contains(*file))
        .collect();
    assert!(unread.is_empty(), "in no crate: {unread:?}");
    tree
}

/// Names of a circle's files, and what each needs of the others.
fn circle_text(circle: &[String], imports: &Imports) -> String {
    let mut text = format!("{} files import each other:\n", circle.len());
    for file in circle {
        let needed = imports[file]
            .iter()
            .filter(|(other, _)| circle.contains(other));
        for (other, names) in needed {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let _ = writeln!(text, "    {file} -> {other}: {}", names.join(", "));
        }
    }
    text
}

/// Arrows from a room to one after it, with the files; by the two rooms.
fn upward(imports: &Imports) -> BTreeMap<(&str, &str), Vec<String>> {
    let mut found = BTreeMap::new();
    let level = |room: &str| ROOMS.iter().position(|r| *r == room);
    for (file, needed) in imports {
        for (other, names) in needed {
            let (Some(from), Some(to)) = (room(file), room(other)) else {
                continue;
            };
            if level(from) < level(to) {
                let arrows: &mut Vec<String> = found.entry((from, to)).or_default();
                arrows.push(format!("{file} -> {other}: {names:?}"));
            }
        }
    }
    found
}

/// Pages that import from others, with the files.
fn between_pages(imports: &Imports) -> BTreeMap<&str, Vec<String>> {
    let mut found = BTreeMap::new();
    for (file, needed) in imports {
        for (other, names) in needed {
            if let (Some(from), Some(to)) = (page(file), page(other))
                && from != to
            {
                let arrows: &mut Vec<String> = found.entry(from).or_default();
                arrows.push(format!("{file} -> {other}: {names:?}"));
            }
        }
    }
    found
}

/// Rooms that name effects of others, with the files and the effects.
fn effects_named<'a>(tree: &'a Tree, ids: &[&'a str]) -> BTreeMap<(&'a str, &'a str), Vec<String>> {
    let mut found = BTreeMap::new();
    let pages: BTreeSet<&str> = tree.modules.iter().filter_map(|m| page(&m.file)).collect();
    for module in &tree.modules {
        let file = &module.file;
        // A page may be called as an effect is.
        let is_page = |text: &str| file.starts_with("app/") && pages.contains(text);
        for id in ids {
            let named = module.texts.iter().filter(|text| text == id);
            if named.count() > 0 && !is_page(id) && !may_name(file, id) {
                let of: &mut Vec<String> = found.entry((file.as_str(), *id)).or_default();
                of.push(format!("{file}: {id}"));
            }
        }
    }
    found
}

/// Fails for what is found and not known, and for what is known and no longer found.
fn compare<K: Ord + std::fmt::Debug>(found: &BTreeMap<K, Vec<String>>, known: &[K]) {
    let new: BTreeMap<_, _> = found.iter().filter(|(k, _)| !known.contains(k)).collect();
    assert!(new.is_empty(), "{new:#?}");
    let mended: Vec<&K> = known.iter().filter(|k| !found.contains_key(k)).collect();
    assert!(
        mended.is_empty(),
        "mended, so no longer to be listed as known: {mended:?}"
    );
}

#[test]
fn no_files_import_each_other() {
    let imports = &HOUSE.1;
    let circles = circles(imports);
    let files: usize = circles.iter().map(Vec::len).sum();
    println!(
        "{} circles with {files} of {} files",
        circles.len(),
        imports.len()
    );
    let mut rooms: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for circle in &circles {
        let text = circle_text(circle, imports);
        println!("{text}");
        for room in circle
            .iter()
            .filter_map(|file| room(file))
            .collect::<BTreeSet<_>>()
        {
            rooms.entry(room).or_default().push(text.clone());
        }
    }
    compare(&rooms, KNOWN_CIRCLES);
}

#[test]
fn nothing_imports_from_a_room_above() {
    let imports = &HOUSE.1;
    for room in imports.keys().filter_map(|file| room(file)) {
        assert!(
            ROOMS.contains(&room),
            "{room} has no place in the order of rooms"
        );
    }
    compare(&upward(imports), KNOWN_UPWARD);
}

#[test]
fn no_page_imports_another() {
    compare(&between_pages(&HOUSE.1), KNOWN_PAGES);
}

#[test]
fn effects_are_named_in_their_own_files() {
    let effects = hysteron_core::effect::registry();
    let ids: Vec<&str> = effects.iter().map(|e| e.id().as_str()).collect();
    compare(&effects_named(&HOUSE.0, &ids), &NAMED_ELSEWHERE);
}
