//! The modules of some crates, read from their source: what each defines, imports and names.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path as FilePath;

use proc_macro2::{TokenStream, TokenTree};
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, Token, UseTree};

/// Segments of a path, such as `crate`, `effect`, `EffectId`.
pub type Segments = Vec<String>;

/// A module of a crate. Those in braces have the file of the module around them.
#[derive(Default)]
pub struct Module {
    /// File that it stands in.
    pub file: String,
    /// Module around it; none for the root of a crate.
    pub parent: Option<usize>,
    /// Modules in it.
    pub children: BTreeMap<String, usize>,
    /// Names of the items that it defines.
    pub items: BTreeSet<String>,
    /// Names that it imports or passes on, and the path behind each.
    pub aliases: Vec<(String, Segments)>,
    /// Paths all names of which it imports or passes on.
    pub globs: Vec<Segments>,
    /// Paths that it needs: those of its code and of its private imports.
    pub named: Vec<Segments>,
    /// Text literals of its code, without those of attributes and comments.
    pub texts: Vec<String>,
}

/// A crate: its name in paths (none for a program) and the file of its root.
pub struct Crate {
    pub name: Option<String>,
    pub root: String,
}

/// All modules of all crates.
#[derive(Default)]
pub struct Tree {
    pub modules: Vec<Module>,
    /// Root modules of the crates that others can name.
    pub crates: BTreeMap<String, usize>,
    /// Where the modules that only tests have may stand: they are not read.
    pub for_tests: BTreeSet<String>,
}

impl Tree {
    /// Reads crates from files, given as texts by their paths. Fails on what is no Rust and on modules without a file.
    pub fn read(crates: &[Crate], files: &BTreeMap<String, String>) -> Result<Self, String> {
        let mut tree = Self::default();
        for one in crates {
            let folder = one.root.rsplit_once('/').map_or("", |(folder, _)| folder);
            let root = tree.read_file(&one.root, folder, None, files)?;
            tree.crates
                .extend(one.name.clone().map(|name| (name, root)));
        }
        Ok(tree)
    }

    /// Reads a file as a module whose children stand in `folder`.
    fn read_file(
        &mut self,
        file: &str,
        folder: &str,
        parent: Option<usize>,
        files: &BTreeMap<String, String>,
    ) -> Result<usize, String> {
        let text = files
            .get(file)
            .ok_or_else(|| format!("{file} is not there"))?;
        let parsed = syn::parse_file(text).map_err(|e| format!("{file}: {e}"))?;
        self.read_module(file, folder, parent, &parsed.items, files)
    }

    fn read_module(
        &mut self,
        file: &str,
        folder: &str,
        parent: Option<usize>,
        items: &[Item],
        files: &BTreeMap<String, String>,
    ) -> Result<usize, String> {
        let index = self.modules.len();
        self.modules.push(Module {
            file: file.to_owned(),
            parent,
            ..Module::default()
        });
        for item in items {
            let Item::Mod(child) = item else {
                Reader(&mut self.modules[index]).visit_item(item);
                continue;
            };
            let name = child.ident.to_string();
            let inside = format!("{folder}/{name}");
            let (beside, within) = (format!("{inside}.rs"), format!("{inside}/mod.rs"));
            if is_for_tests(&child.attrs) {
                self.for_tests.extend([beside, within]);
                continue;
            }
            if child.attrs.iter().any(|a| a.path().is_ident("path")) {
                return Err(format!(
                    "{file}: {name} is another module's file, by #[path]: a file has one place"
                ));
            }
            let read = if let Some((_, items)) = &child.content {
                self.read_module(file, &inside, Some(index), items, files)?
            } else {
                let found = if files.contains_key(&beside) {
                    beside
                } else {
                    within
                };
                self.read_file(&found, &inside, Some(index), files)?
            };
            self.modules[index].children.insert(name, read);
        }
        Ok(index)
    }
}

/// Whether the item with these attributes is compiled for tests only.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let only = |list: &syn::MetaList| list.tokens.to_string() == "test";
        let cfg = attribute.path().is_ident("cfg") && attribute.meta.require_list().is_ok_and(only);
        cfg || attribute.path().is_ident("test")
    })
}

/// Attributes and name of an item.
fn head(item: &Item) -> (&[Attribute], Option<&syn::Ident>) {
    match item {
        Item::Const(i) => (&i.attrs, Some(&i.ident)),
        Item::Enum(i) => (&i.attrs, Some(&i.ident)),
        Item::Fn(i) => (&i.attrs, Some(&i.sig.ident)),
        Item::Impl(i) => (&i.attrs, None),
        Item::Macro(i) => (&i.attrs, i.ident.as_ref()),
        Item::Static(i) => (&i.attrs, Some(&i.ident)),
        Item::Struct(i) => (&i.attrs, Some(&i.ident)),
        Item::Trait(i) => (&i.attrs, Some(&i.ident)),
        Item::TraitAlias(i) => (&i.attrs, Some(&i.ident)),
        Item::Type(i) => (&i.attrs, Some(&i.ident)),
        Item::Union(i) => (&i.attrs, Some(&i.ident)),
        Item::Use(i) => (&i.attrs, None),
        _ => (&[], None),
    }
}

/// Enters what stands in a module, but for modules in it.
struct Reader<'a>(&'a mut Module);

impl Reader<'_> {
    /// Enters an import. One that others can use passes a name on and needs nothing itself.
    fn enter_use(&mut self, tree: &UseTree, before: &[String], private: bool) {
        let with = |name: &syn::Ident| [before, &[name.to_string()]].concat();
        let (name, path) = match tree {
            UseTree::Path(path) => return self.enter_use(&path.tree, &with(&path.ident), private),
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.enter_use(tree, before, private);
                }
                return;
            }
            UseTree::Glob(_) => {
                self.0.globs.push(before.to_vec());
                if private {
                    self.0.named.push(before.to_vec());
                }
                return;
            }
            UseTree::Name(name) if name.ident == "self" => {
                let last = before.last().cloned().unwrap_or_default();
                (last, before.to_vec())
            }
            UseTree::Name(name) => (name.ident.to_string(), with(&name.ident)),
            UseTree::Rename(renamed) => (renamed.rename.to_string(), with(&renamed.ident)),
        };
        if private {
            self.0.named.push(path.clone());
        }
        self.0.aliases.push((name, path));
    }

    /// Enters paths and texts of a macro: its syntax is its own, so they are sought among its tokens.
    fn enter_tokens(&mut self, tokens: TokenStream) {
        let mut path = Segments::new();
        let mut before = String::new();
        for token in tokens {
            if let TokenTree::Punct(mark) = &token {
                before.push(mark.as_char());
                continue;
            }
            if before != "::" {
                self.enter_path(std::mem::take(&mut path));
            }
            match token {
                // A field or method is no path.
                TokenTree::Ident(name) if before != "." => path.push(name.to_string()),
                TokenTree::Group(group) => self.enter_tokens(group.stream()),
                TokenTree::Literal(literal) => self.enter_text(&literal.to_string()),
                _ => {}
            }
            before.clear();
        }
        self.enter_path(path);
    }

    fn enter_path(&mut self, path: Segments) {
        if !path.is_empty() {
            self.0.named.push(path);
        }
    }

    fn enter_text(&mut self, literal: &str) {
        if let Ok(text) = syn::parse_str::<syn::LitStr>(literal) {
            self.0.texts.push(text.value());
        }
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        let (attributes, name) = head(item);
        if is_for_tests(attributes) {
            return;
        }
        self.0.items.extend(name.map(ToString::to_string));
        visit::visit_item(self, item);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let private = matches!(item.vis, syn::Visibility::Inherited);
        self.enter_use(&item.tree, &[], private);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.enter_path(path.segments.iter().map(|s| s.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, mac: &'ast syn::Macro) {
        self.visit_path(&mac.path);
        self.enter_tokens(mac.tokens.clone());
    }

    /// What a field is called where it is printed is no text of its own.
    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        if call.method != "field" {
            return visit::visit_expr_method_call(self, call);
        }
        self.visit_expr(&call.receiver);
        for argument in call.args.iter().skip(1) {
            self.visit_expr(argument);
        }
    }

    fn visit_lit_str(&mut self, text: &'ast syn::LitStr) {
        self.0.texts.push(text.value());
    }

    /// Of attributes, only serde's name functions of the project, as texts.
    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        let parts = Punctuated::<Meta, Token![,]>::parse_terminated;
        let Ok(parts) = attribute.parse_args_with(parts) else {
            return;
        };
        for part in parts.iter().filter(|_| attribute.path().is_ident("serde")) {
            let (Some(key), Ok(value)) = (part.path().get_ident(), part.require_name_value())
            else {
                continue;
            };
            let names = key == "default" || key.to_string().ends_with("with");
            if let syn::Expr::Lit(literal) = &value.value
                && let syn::Lit::Str(text) = &literal.lit
                && let (true, Ok(path)) = (names, text.parse::<syn::Path>())
            {
                self.visit_path(&path);
            }
        }
    }
}

/// The crates of a project: each folder with a `Cargo.toml` whose path starts with one of `folders`, and all files
/// of their `src`.
pub fn crates_in(
    project: &FilePath,
    folders: &[&str],
) -> Result<(Vec<Crate>, BTreeMap<String, String>), String> {
    let mut texts = BTreeMap::new();
    for folder in folders {
        read_folder(project, folder, &mut texts)?;
    }
    let mut crates = Vec::new();
    for (manifest, text) in texts
        .iter()
        .filter(|(path, _)| path.ends_with("/Cargo.toml"))
    {
        let folder = manifest.trim_end_matches("/Cargo.toml");
        let table: toml::Table = text.parse().map_err(|e| format!("{manifest}: {e}"))?;
        let name = table["package"]["name"]
            .as_str()
            .unwrap_or_default()
            .replace('-', "_");
        let library = format!("{folder}/src/lib.rs");
        let programs = format!("{folder}/src/bin/");
        for file in texts.keys() {
            let is_program =
                *file == format!("{folder}/src/main.rs") || file.starts_with(&programs);
            let name = (*file == library).then(|| name.clone());
            if name.is_some() || is_program {
                let root = file.clone();
                crates.push(Crate { name, root });
            }
        }
    }
    texts.retain(|path, _| path.contains("/src/"));
    Ok((crates, texts))
}

/// Adds the texts of `Cargo.toml` and `*.rs` files in a folder of the project and in folders in it.
fn read_folder(
    project: &FilePath,
    folder: &str,
    texts: &mut BTreeMap<String, String>,
) -> Result<(), String> {
    let say = |e: std::io::Error| format!("{folder}: {e}");
    for entry in std::fs::read_dir(project.join(folder)).map_err(say)? {
        let entry = entry.map_err(say)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{folder}/{name}");
        if entry.file_type().map_err(say)?.is_dir() {
            read_folder(project, &path, texts)?;
        } else if name == "Cargo.toml" || entry.path().extension().is_some_and(|e| e == "rs") {
            texts.insert(path, std::fs::read_to_string(entry.path()).map_err(say)?);
        }
    }
    Ok(())
}
