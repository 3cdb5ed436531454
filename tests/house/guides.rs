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

/// Files of a folder and of those in it.
fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if path.is_dir() && name != "target" {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push((
                path.to_string_lossy().into_owned(),
                fs::read_to_string(&path).unwrap(),
            ));
        }
    }
}

#[test]
fn names_in_the_guides_are_defined() {
    let project = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let mut all = Vec::new();
    for folder in ["core/src", "app", "tests/support"] {
        sources(&project.join(folder), &mut all);
    }
    let defined = |name: &str, of: &str| {
        let kinds = ["fn", "struct", "enum", "trait", "const", "type", "mod"];
        kinds.iter().any(|kind| {
            let definition = format!("{kind} {name}");
            of.match_indices(&definition).any(|(at, _)| {
                let next = of[at + definition.len()..].chars().next();
                next.is_none_or(|c| !c.is_alphanumeric() && c != '_')
            })
        })
    };
    let words = |text: &str, name: &str| {
        text.split(|c: char| !c.is_alphanumeric() && c != '_')
            .any(|word| word == name)
    };
    // A path's last name is defined or passed on in a file of the name before it, or stands where that is defined.
    let stands = |before: &str, name: &str| {
        all.iter().any(|(path, text)| {
            let is_file =
                path.ends_with(&format!("/{before}.rs")) || path.contains(&format!("/{before}/"));
            let mut uses = text.lines().filter(|l| l.starts_with("pub use"));
            let passes_on = uses.any(|l| words(l, name));
            is_file && (defined(name, text) || passes_on)
                || defined(before, text) && words(text, name)
        })
    };
    for guide in [
        "ARCHITECTURE.md",
        "docs/adding-a-page.md",
        "docs/adding-an-effect.md",
        "docs/translation.md",
    ] {
        for code in text(guide).split('`').skip(1).step_by(2) {
            let path = code.split('(').next().unwrap_or_default();
            let is_name =
                |s: &str| !s.is_empty() && s.chars().all(|c| c.is_alphanumeric() || c == '_');
            match path.split("::").collect::<Vec<_>>()[..] {
                [before, name] if is_name(before) && is_name(name) => {
                    assert!(stands(before, name), "{guide}: {code}");
                }
                [name] if is_name(name) && code.ends_with("()") => {
                    assert!(all.iter().any(|(_, t)| defined(name, t)), "{guide}: {code}");
                }
                _ => {}
            }
        }
    }
}
