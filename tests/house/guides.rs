//! What the guides say of the source is so.

use std::fs;
use std::path::Path;

use hysteron_core::effect::registry;

fn text(path: &str) -> String {
    let project = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    fs::read_to_string(project.join(path)).expect(path)
}

#[test]
fn every_effect_of_the_library_has_its_equation_in_the_theory() {
    let theory = text("docs/theory.md");
    for effect in registry() {
        let row = format!("| {} | `", effect.name());
        assert!(theory.contains(&row), "no row for {}", effect.name());
    }
}

#[test]
fn the_guide_to_effects_shows_a_file_as_it_is() {
    let guide = text("docs/adding-an-effect.md");
    let file = text("core/src/effect/return_spring.rs");
    let (_, from) = guide
        .split_once("but for its imports:\n\n")
        .expect("a listing");
    let (listing, _) = from.split_once("\n\n- `id`").expect("its end");
    let lines: Vec<&str> = listing
        .lines()
        .map(|line| line.strip_prefix("    ").unwrap_or(line))
        .collect();
    assert!(file.trim_end().ends_with(&lines.join("\n")));
}

#[test]
fn paths_in_the_guides_exist() {
    let project = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let roots = ["core/", "app/", "tests/", "docs/", "assets/", "xtask/"];
    for guide in [
        "ARCHITECTURE.md",
        "docs/adding-a-page.md",
        "docs/adding-an-effect.md",
        "docs/translation.md",
    ] {
        let text = text(guide);
        // What stands between two backquotes; a name such as `core/root` is a module of `core/src`.
        for path in text.split('`').skip(1).step_by(2) {
            let path = path.trim_end_matches('/');
            let is_path = roots.iter().any(|root| path.starts_with(root))
                && !path.contains(['<', '*', ' ', '{']);
            let inside = ["core/", "app/"]
                .iter()
                .find_map(|c| Some(format!("{c}src/{}", path.strip_prefix(c)?)));
            let files = [
                path.to_owned(),
                inside.clone().unwrap_or_default(),
                format!("{}.rs", inside.unwrap_or_default()),
            ];
            let named = |project: &Path| {
                files
                    .iter()
                    .any(|f| !f.is_empty() && project.join(f).exists())
            };
            assert!(!is_path || named(project), "{guide}: {path}");
        }
    }
}
