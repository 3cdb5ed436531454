//! Records that are kept beside the project, and may not be copied into it.

use std::path::Path;

/// The bytes of a file in the folder `shared` beside the project. Where it is absent the test says that it is skipped, and
/// fails under `CI`.
pub fn shared(file: &str) -> Option<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../shared")
        .join(file);
    let bytes = std::fs::read(&path).ok();
    if bytes.is_none() {
        let is_checked = std::env::var_os("CI").is_some();
        assert!(!is_checked, "{} is absent", path.display());
        println!("skipped: no {}", path.display());
    }
    bytes
}
