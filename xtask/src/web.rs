//! Builds the page into `dist/`.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use wasm_bindgen_cli_support::Bindgen;

use crate::offline;
use crate::run::{check, output, root, run};
use crate::size;

const TARGET: &str = "wasm32-unknown-unknown";

/// A worker's script: the page sends it its own module.
const WORKER: &str = "import init from \"./hysteron.js\";
onmessage = ({ data }) => {
  onmessage = null;
  // An error that no one awaits reaches the page.
  init({ module_or_path: data }).catch((error) => setTimeout(() => { throw error; }));
};
";

/// Builds the wasm module, its bindings and the page around them.
pub fn build() -> Result<(), String> {
    let module = compile()?;
    let dist = root().join("dist");
    if dist.exists() {
        fs::remove_dir_all(&dist).map_err(|e| format!("{}: {e}", dist.display()))?;
    }
    fs::create_dir_all(&dist).map_err(|e| format!("{}: {e}", dist.display()))?;
    bind(&module, &dist)?;
    let page = root().join("index.html");
    fs::copy(&page, dist.join("index.html")).map_err(|e| format!("{}: {e}", page.display()))?;
    fs::write(dist.join("worker.js"), WORKER).map_err(|e| format!("worker.js: {e}"))?;
    offline::write(&dist)?;
    println!(
        "The page is in {}; see it with cargo xtask serve.",
        dist.display()
    );
    size::report(&dist)
}

/// Makes the JavaScript bindings of the module.
fn bind(wasm: &Path, dist: &Path) -> Result<(), String> {
    let mut bindgen = Bindgen::new();
    bindgen
        .input_path(wasm)
        .out_name("hysteron")
        .omit_default_module_path(false)
        .web(true)
        .and_then(|b| b.typescript(false).generate(dist))
        .map_err(|e| format!("{}: {e:#}", wasm.display()))
}

/// Compiles the app; returns its module.
fn compile() -> Result<PathBuf, String> {
    let folder = root().join("target/wasm");
    let mut command = Command::new("cargo");
    let arguments = [
        "build",
        "--package",
        "hysteron",
        "--bins",
        "--profile",
        "web",
        "--target",
        TARGET,
        "--target-dir",
        "target/wasm",
    ];
    command.args(arguments).current_dir(root());
    if !target_installed() {
        println!(
            "rustup cannot add {TARGET} here: building its standard library with Debian's compiler."
        );
        let toolchain = debian_toolchain()?;
        command
            .env("RUSTC", &toolchain.rustc)
            .env("RUSTC_BOOTSTRAP", "1")
            .env("CARGO_UNSTABLE_BUILD_STD", "std,panic_abort")
            .env(
                "CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER",
                &toolchain.linker,
            );
    }
    check(&mut command, "cargo", &arguments)?;
    Ok(folder.join(TARGET).join("web/hysteron.wasm"))
}

fn target_installed() -> bool {
    let listed = || {
        output("rustc", &["--print", "sysroot"]).is_some_and(|s| {
            Path::new(&s)
                .join("lib/rustlib")
                .join(TARGET)
                .join("lib")
                .is_dir()
        })
    };
    listed() || (output("rustup", &["target", "add", TARGET]).is_some() && listed())
}

struct Toolchain {
    rustc: PathBuf,
    linker: PathBuf,
}

/// Debian's rustc for the web with its standard library's source, unpacked (not installed: it would
/// conflict with rustup's) into `target/wasm-toolchain`.
fn debian_toolchain() -> Result<Toolchain, String> {
    let folder = root().join("target/wasm-toolchain");
    let sysroot = output("rustc", &["--print", "sysroot"])
        .ok_or("rustc is not there: install Rust with rustup")?;
    let linker = PathBuf::from(sysroot).join("lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld");
    let rustc = folder.join("rustc");
    if rustc.is_file() {
        return Ok(Toolchain { rustc, linker });
    }
    let packages = packages()?;
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut download = Command::new("apt-get");
    download
        .arg("download")
        .args(&packages)
        .current_dir(&folder);
    check(
        &mut download,
        "apt-get download",
        &packages.iter().map(String::as_str).collect::<Vec<_>>(),
    )?;
    let entries = fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for entry in entries
        .flatten()
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "deb"))
    {
        let file = entry.to_string_lossy().into_owned();
        let deb = folder.join("deb").to_string_lossy().into_owned();
        run("dpkg", &["-x", &file, &deb])?;
        let _ = fs::remove_file(&entry);
    }
    link_source(&folder.join("deb"))?;
    let script = "#!/bin/sh\nhere=$(CDPATH= cd -- \"$(dirname -- \"$0\")\" && pwd)/deb/usr\n\
        LD_LIBRARY_PATH=\"$here/lib/x86_64-linux-gnu\" exec \"$here/bin/rustc\" \"$@\"\n";
    fs::write(&rustc, script).map_err(|e| format!("{}: {e}", rustc.display()))?;
    fs::set_permissions(&rustc, fs::Permissions::from_mode(0o755))
        .map_err(|e| format!("{}: {e}", rustc.display()))?;
    Ok(Toolchain { rustc, linker })
}

/// Names of the packages, with the versions that today's archive has.
fn packages() -> Result<Vec<String>, String> {
    const NEEDED: &str = "the web build needs the wasm32 target: run `rustup target add wasm32-unknown-unknown`, \
        or on Debian 12 `apt-get update` with the security archive enabled";
    let depends = |package: &str| output("apt-cache", &["depends", package]).unwrap_or_default();
    let name_in = |text: &str, prefix: &str| {
        text.split_whitespace()
            .find(|w| w.starts_with(prefix) && !w.ends_with("dev"))
            .map(str::to_owned)
    };
    let all = depends("rustc-web") + "\n" + &depends("libstd-rust-web-dev");
    let std = name_in(&all, "libstd-rust-web-").ok_or(NEEDED)?;
    let llvm = name_in(&(all + "\n" + &depends(&std)), "libllvm").ok_or(NEEDED)?;
    let mut packages: Vec<String> = ["rustc-web", "libstd-rust-web-dev", "rust-web-src"]
        .iter()
        .map(|s| (*s).to_owned())
        .collect();
    packages.extend([std, llvm]);
    Ok(packages)
}

/// Points the compiler's place for the library source at where the package puts it.
fn link_source(deb: &Path) -> Result<(), String> {
    let sources = deb.join("usr/src");
    let source = fs::read_dir(&sources)
        .map_err(|e| format!("{}: {e}", sources.display()))?
        .flatten()
        .map(|e| e.path())
        .find(|p| {
            p.file_name()
                .is_some_and(|n| n.to_string_lossy().starts_with("rustc-"))
        })
        .ok_or("rust-web-src holds no source")?;
    let place = deb.join("usr/lib/rustlib/src");
    fs::create_dir_all(&place).map_err(|e| format!("{}: {e}", place.display()))?;
    let link = place.join("rust");
    let _ = fs::remove_file(&link);
    symlink(&source, &link).map_err(|e| format!("{}: {e}", link.display()))
}
