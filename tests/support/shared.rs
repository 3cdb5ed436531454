//! Records of real machines that are not part of the project.

use std::path::Path;

/// A file of the folder `shared` beside the project, by its path in that folder. Where it is not there, a test has
/// nothing to check and says so; under `CI` it fails, so that what is claimed of real machines is checked.
pub fn shared(path: &str) -> Option<Vec<u8>> {
    // The project is where the lock file is, whichever crate is tested.
    let project = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .find(|folder| folder.join("Cargo.lock").is_file())
        .expect("the project");
    let file = project.join("../shared").join(path);
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
