//! Records of real machines that are not part of the project.

use std::path::Path;

/// A file of the folder `shared` beside the project, by its path in that folder. Where it is not there, a test has
/// nothing to check and says so; under `CI` it fails, so that what is claimed of real machines is checked.
pub fn shared(path: &str) -> Option<Vec<u8>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../shared")
        .join(path);
    match std::fs::read(&file) {
        Ok(bytes) => Some(bytes),
        Err(error) => {
            let file = file.display();
            assert!(std::env::var_os("CI").is_none(), "{file}: {error}");
            println!("skipped: {file} is not there");
            None
        }
    }
}
