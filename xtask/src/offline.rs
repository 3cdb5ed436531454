//! The service worker that keeps the page for visits without a network.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

const SOURCE: &str = include_str!("service-worker.js");

/// Writes `service-worker.js` into `dist`; it names the files that stand there, and their version.
pub fn write(dist: &Path) -> Result<(), String> {
    let fail = |path: &Path, e: std::io::Error| format!("{}: {e}", path.display());
    let entries = fs::read_dir(dist).map_err(|e| fail(dist, e))?;
    let mut names: Vec<String> = entries
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let mut hasher = DefaultHasher::new();
    for name in &names {
        let path = dist.join(name);
        let bytes = fs::read(&path).map_err(|e| fail(&path, e))?;
        (name, bytes).hash(&mut hasher);
    }
    // The page is asked for by its folder too.
    names.insert(0, "./".to_owned());
    let list = serde_json::to_string(&names).map_err(|e| e.to_string())?;
    let script = SOURCE
        .replace("VERSION", &format!("{:016x}", hasher.finish()))
        .replace("FILE_LIST", &list);
    let path = dist.join("service-worker.js");
    fs::write(&path, script).map_err(|e| fail(&path, e))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two builds beside each other on one host, each with its store, in the words of the browser.
    const HOST: &str = r#"
const stores = new Map(), asked = [];
const caches = {
  open: async (name) => {
    if (!stores.has(name)) stores.set(name, []);
    return { addAll: async (all) => { asked.push(...all); stores.get(name).push(...all); } };
  },
  keys: async () => [...stores.keys()],
  delete: async (name) => stores.delete(name),
};
class Request { constructor(url, options) { this.url = url; this.cache = options?.cache; } }
const run = async (script, scope) => {
  const on = {}, waits = [];
  const self = {
    registration: { scope }, clients: { claim: async () => {} },
    addEventListener: (name, act) => { on[name] = act; },
  };
  new Function("self", "caches", "Request", script)(self, caches, Request);
  for (const name of ["install", "activate"]) {
    on[name]({ waitUntil: (work) => waits.push(work) });
    await Promise.all(waits);
  }
};
const script = (version) => SOURCE.replace("VERSION", version).replace("FILE_LIST", '["./", "a.js"]');
(async () => {
  await run(script("1"), "https://example.org/a/");
  await run(script("1"), "https://example.org/b/");
  await run(script("2"), "https://example.org/b/");
  console.log([...stores.keys()].join("|"));
  console.log(asked.every((r) => r.cache === "no-cache"));
})();
"#;

    #[test]
    fn a_new_build_deletes_the_stores_of_its_own_folder_only() {
        let source = serde_json::to_string(SOURCE).expect("a text");
        let script = format!("const SOURCE = {source};\n{HOST}");
        let Ok(node) = std::process::Command::new("node")
            .args(["-e", &script])
            .output()
        else {
            eprintln!("no node here: not tested");
            return;
        };
        let said = String::from_utf8_lossy(&node.stdout);
        assert_eq!(said, "hysteron /a/ 1|hysteron /b/ 2\ntrue\n", "{node:?}");
    }
}
