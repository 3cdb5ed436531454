//! Which file needs which: paths followed through `use` and `pub use` to the file that defines what they name.

use std::collections::{BTreeMap, BTreeSet};

use crate::tree::{Segments, Tree};

/// For each file the files that it needs, and the names for which it needs them.
pub type Imports = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

/// Where a path leads.
#[derive(Clone, Copy, PartialEq)]
enum Target {
    Module(usize),
    /// An item that this module defines, or something in it.
    ItemOf(usize),
}

/// A look-up that is under way: a name in a module, and whether it is a module's.
type Asked = (usize, String, bool);

/// What every file of a tree needs of others. To pass a name on by `pub use`, or to have a file as its module, is not
/// to need it.
pub fn imports(tree: &Tree) -> Imports {
    let mut all = Imports::new();
    for (index, module) in tree.modules.iter().enumerate() {
        let needed = all.entry(module.file.clone()).or_default();
        for path in &module.named {
            let Some(Target::ItemOf(home)) = tree.follow(index, path, &[]) else {
                continue;
            };
            let file = &tree.modules[home].file;
            if *file != module.file {
                let names = needed.entry(file.clone()).or_default();
                names.extend(path.last().cloned());
            }
        }
    }
    all
}

impl Tree {
    /// Follows a path that stands in this module.
    fn follow(&self, module: usize, path: &Segments, asked: &[Asked]) -> Option<Target> {
        let mut at = module;
        for (i, segment) in path.iter().enumerate() {
            let is_last = i + 1 == path.len();
            let next = match segment.as_str() {
                "self" => Some(at),
                "super" => self.modules[at].parent,
                "crate" => Some(self.root_of(at)),
                name => {
                    let item = || self.item(at, name, &mut asked.to_vec());
                    if let Some(home) = item().filter(|_| is_last) {
                        return Some(Target::ItemOf(home));
                    }
                    let named = || self.crates.get(name).copied().filter(|_| i == 0);
                    let inner = self.module(at, name, &mut asked.to_vec()).or_else(named);
                    if inner.is_none() {
                        return item().map(Target::ItemOf);
                    }
                    inner
                }
            };
            at = next?;
        }
        Some(Target::Module(at))
    }

    fn root_of(&self, module: usize) -> usize {
        self.modules[module]
            .parent
            .map_or(module, |parent| self.root_of(parent))
    }

    /// The module of this name in a module: its own, or one that it imports.
    fn module(&self, at: usize, name: &str, asked: &mut Vec<Asked>) -> Option<usize> {
        let own = self.modules[at].children.get(name).copied();
        own.or_else(|| match self.imported(at, name, true, asked)? {
            Target::Module(module) => Some(module),
            Target::ItemOf(_) => None,
        })
    }

    /// The module that defines the item of this name in a module: itself, or one that it imports it from.
    fn item(&self, at: usize, name: &str, asked: &mut Vec<Asked>) -> Option<usize> {
        if self.modules[at].items.contains(name) {
            return Some(at);
        }
        match self.imported(at, name, false, asked)? {
            Target::ItemOf(home) => Some(home),
            Target::Module(_) => None,
        }
    }

    /// What the imports of a module have under this name.
    fn imported(
        &self,
        at: usize,
        name: &str,
        is_module: bool,
        asked: &mut Vec<Asked>,
    ) -> Option<Target> {
        let question = (at, name.to_owned(), is_module);
        if asked.contains(&question) {
            return None;
        }
        asked.push(question);
        let here = &self.modules[at];
        let wanted = |target: &Target| matches!(target, Target::Module(_)) == is_module;
        let by_name = here.aliases.iter().filter(|(alias, _)| alias == name);
        by_name
            .filter_map(|(_, path)| self.follow(at, path, asked))
            .find(wanted)
            .or_else(|| {
                here.globs.iter().find_map(|glob| {
                    let Target::Module(from) = self.follow(at, glob, asked)? else {
                        return None;
                    };
                    if is_module {
                        self.module(from, name, asked).map(Target::Module)
                    } else {
                        self.item(from, name, asked).map(Target::ItemOf)
                    }
                })
            })
    }
}

/// Groups of files that need each other, in the order of their names: in each, every file leads to every other.
pub fn circles(imports: &Imports) -> Vec<Vec<String>> {
    let reached: BTreeMap<&String, BTreeSet<&String>> = imports
        .keys()
        .map(|file| (file, reached_from(file, imports)))
        .collect();
    let mut circles: Vec<Vec<String>> = Vec::new();
    for (file, from_it) in &reached {
        if circles.iter().any(|circle| circle.contains(file)) {
            continue;
        }
        let leads_back = |other: &&&String| reached.get(*other).is_some_and(|r| r.contains(*file));
        let circle: Vec<String> = from_it
            .iter()
            .filter(leads_back)
            .map(|f| (*f).clone())
            .collect();
        if circle.len() > 1 {
            circles.push(circle);
        }
    }
    circles
}

fn reached_from<'a>(file: &String, imports: &'a Imports) -> BTreeSet<&'a String> {
    let mut reached = BTreeSet::new();
    let mut open = vec![file];
    while let Some(next) = open.pop() {
        for needed in imports.get(next).into_iter().flat_map(BTreeMap::keys) {
            if reached.insert(needed) {
                open.push(needed);
            }
        }
    }
    reached
}
