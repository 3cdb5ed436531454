//! Trees of source that are made up, each to show that a rule can be broken.

use std::collections::BTreeMap;

use crate::imports::{Imports, circles, imports};
use crate::tree::{Crate, Tree};
use crate::{between_pages, compare, effects_named, upward};

/// Files of a core and an app, read as crates.
fn tree(files: &[(&str, &str)]) -> Tree {
    let files: BTreeMap<String, String> = files
        .iter()
        .map(|(path, text)| ((*path).to_owned(), (*text).to_owned()))
        .collect();
    let libraries = [
        ("hysteron_core", "core/src/lib.rs"),
        ("hysteron", "app/src/lib.rs"),
    ];
    let crates: Vec<Crate> = libraries
        .iter()
        .filter(|(_, root)| files.contains_key(*root))
        .map(|(name, root)| Crate {
            name: Some((*name).to_owned()),
            root: (*root).to_owned(),
        })
        .collect();
    Tree::read(&crates, &files).unwrap()
}

/// The names that a file needs of another.
fn names(imports: &Imports, file: &str, other: &str) -> Vec<String> {
    let needed = imports[file].get(other);
    needed.into_iter().flatten().cloned().collect()
}

const TWO: &str = "mod a; mod b;";

#[test]
fn a_circle_is_found() {
    let tree = tree(&[
        ("core/src/lib.rs", TWO),
        ("core/src/a.rs", "use crate::b::B; pub struct A(B);"),
        (
            "core/src/b.rs",
            "pub struct B; fn b() { let _: Option<super::a::A> = None; }",
        ),
    ]);
    assert_eq!(
        circles(&imports(&tree)),
        [["core/src/a.rs", "core/src/b.rs"]]
    );
}

#[test]
fn a_circle_of_three_is_one_and_what_hangs_on_it_is_none() {
    let tree = tree(&[
        ("core/src/lib.rs", "mod a; mod b; mod c; mod d; mod e;"),
        ("core/src/a.rs", "pub fn a() { crate::b::b() }"),
        ("core/src/b.rs", "pub fn b() { crate::c::c() }"),
        (
            "core/src/c.rs",
            "pub fn c() { crate::a::a(); crate::e::e() }",
        ),
        ("core/src/d.rs", "pub fn d() { crate::a::a() }"),
        ("core/src/e.rs", "pub fn e() {}"),
    ]);
    let wanted = [["core/src/a.rs", "core/src/b.rs", "core/src/c.rs"]];
    assert_eq!(circles(&imports(&tree)), wanted);
}

#[test]
fn a_name_is_followed_to_where_it_is_defined() {
    let tree = tree(&[
        (
            "core/src/lib.rs",
            "pub mod a; pub use a::inner::Deep as Renamed; pub use a::*;",
        ),
        (
            "core/src/a.rs",
            "mod inner; mod other; pub use inner::*; pub use self::other::{Wide, self as way};",
        ),
        (
            "core/src/a/inner.rs",
            "pub struct Deep; pub enum Kind { One }",
        ),
        ("core/src/a/other.rs", "pub struct Wide; pub fn far() {}"),
        (
            "app/src/lib.rs",
            "use hysteron_core::{Renamed, a}; fn f() { a::Kind::One; a::way::far(); hysteron_core::Wide; }",
        ),
    ]);
    let imports = imports(&tree);
    assert_eq!(
        names(&imports, "app/src/lib.rs", "core/src/a/inner.rs"),
        ["One", "Renamed"]
    );
    assert_eq!(
        names(&imports, "app/src/lib.rs", "core/src/a/other.rs"),
        ["Wide", "far"]
    );
    // Who passes a name on needs nothing of it, and nobody needs the one who does.
    assert!(imports["core/src/lib.rs"].is_empty() && imports["core/src/a.rs"].is_empty());
    assert!(!imports["app/src/lib.rs"].contains_key("core/src/a.rs"));
}

#[test]
fn a_child_needs_its_parent_only_for_what_that_defines() {
    let tree = tree(&[
        ("core/src/lib.rs", TWO),
        (
            "core/src/a.rs",
            "mod child; pub use child::C; pub struct A;",
        ),
        ("core/src/a/child.rs", "use super::A; pub struct C(A);"),
        (
            "core/src/b.rs",
            "mod child; mod other; pub use other::O; use child::C; fn b(_: C) {}",
        ),
        ("core/src/b/child.rs", "use super::O; pub struct C(O);"),
        ("core/src/b/other.rs", "pub struct O;"),
    ]);
    let imports = imports(&tree);
    assert_eq!(
        names(&imports, "core/src/a/child.rs", "core/src/a.rs"),
        ["A"]
    );
    assert!(imports["core/src/a.rs"].is_empty());
    assert!(!imports["core/src/b/child.rs"].contains_key("core/src/b.rs"));
    assert!(circles(&imports).is_empty());
}

#[test]
fn macros_globs_and_attributes_are_read() {
    let tree = tree(&[
        ("core/src/lib.rs", TWO),
        (
            "core/src/a.rs",
            "use crate::b::*; #[derive(Serialize)] struct S { #[serde(with = \"crate::b::packed\")] x: f64 }
             fn f(x: &T) { matches!(x, crate::b::Kind::One); vec![Free { time: x.ignored() }]; }",
        ),
        (
            "core/src/b.rs",
            "pub enum Kind { One } pub fn packed() {} pub struct Free; pub fn time() {} pub fn ignored() {}",
        ),
    ]);
    let wanted = ["Free", "One", "packed", "time"];
    assert_eq!(
        names(&imports(&tree), "core/src/a.rs", "core/src/b.rs"),
        wanted
    );
}

#[test]
fn tests_are_not_read() {
    let tree = tree(&[
        (
            "core/src/lib.rs",
            "mod a; mod b; #[cfg(test)] mod only_tests;",
        ),
        (
            "core/src/a.rs",
            "pub struct A; #[cfg(test)] mod tests { use crate::b::B; fn f() { \"cogging\"; } }",
        ),
        (
            "core/src/b.rs",
            "use crate::a::A; pub struct B(A); #[cfg(test)] use crate::a::nothing;",
        ),
    ]);
    let imports = imports(&tree);
    assert!(imports["core/src/a.rs"].is_empty());
    assert!(circles(&imports).is_empty());
    assert!(effects_named(&tree, &["cogging"]).is_empty());
    assert!(tree.for_tests.contains("core/src/only_tests.rs"));
}

#[test]
fn an_arrow_upward_is_found() {
    let tree = tree(&[
        ("core/src/lib.rs", "mod measurement; mod effect;"),
        (
            "core/src/measurement.rs",
            "use crate::effect::Motion; pub struct M(Motion);",
        ),
        ("core/src/effect.rs", "pub struct Motion;"),
    ]);
    let imports = imports(&tree);
    assert_eq!(
        upward(&imports).keys().collect::<Vec<_>>(),
        [&("measurement", "effect")]
    );
}

#[test]
fn a_page_that_imports_a_page_is_found() {
    let tree = tree(&[
        ("app/src/lib.rs", "mod pages;"),
        (
            "app/src/pages/mod.rs",
            "mod start; mod tune; fn all() { (start::S, tune::T); }",
        ),
        ("app/src/pages/start/mod.rs", ""),
        (
            "app/src/pages/start.rs",
            "use super::tune::T; pub struct S(T);",
        ),
        ("app/src/pages/tune/mod.rs", "mod plots; pub struct T;"),
        (
            "app/src/pages/tune/plots.rs",
            "use super::T; fn plot(_: T) {}",
        ),
    ]);
    let imports = imports(&tree);
    assert_eq!(
        between_pages(&imports).keys().collect::<Vec<_>>(),
        [&"start"]
    );
}

#[test]
fn an_effect_named_elsewhere_is_found() {
    let named = "//! As \"cogging\" does.\nfn f() { let id = EffectId::new(\"cogging\"); }";
    let tree = tree(&[
        ("core/src/lib.rs", "mod effect; mod model;"),
        ("core/src/effect/mod.rs", "mod cogging; mod load;"),
        ("core/src/effect/cogging.rs", named),
        (
            "core/src/effect/load.rs",
            "fn f() { assert_eq!(id, \"cogging\"); }",
        ),
        (
            "core/src/model.rs",
            "fn debug() { f.field(\"cogging\", &self.cogging); }",
        ),
        (
            "app/src/lib.rs",
            "mod pages; fn address() { \"tune\"; \"cogging\"; }",
        ),
        ("app/src/pages/mod.rs", "mod tune;"),
        ("app/src/pages/tune.rs", ""),
    ]);
    let found = effects_named(&tree, &["cogging", "tune"]);
    let wanted = [
        ("app/src/lib.rs", "cogging"),
        ("core/src/effect/load.rs", "cogging"),
    ];
    assert!(found.keys().eq(&wanted), "{found:?}");
}

#[test]
#[should_panic(expected = "mended")]
fn what_is_mended_is_no_longer_known() {
    compare(&BTreeMap::new(), &["criticism"]);
}

#[test]
#[should_panic(expected = "rig")]
fn what_is_new_is_not_known() {
    compare(&BTreeMap::from([("rig", vec![])]), &[]);
}
