//! The keyboard leaves the page: after the last control, Tab goes on to the browser.

use std::time::Duration;

use super::driver::Session;
use super::wait;

/// The key Tab, as a driver writes it.
const TAB: &str = "\u{e004}";

/// Presses that lead past all controls of a page with few.
const MOST: usize = 80;

pub fn journey(session: &Session, page: &str) -> Result<(), String> {
    session.open("about:blank")?;
    session.open(&format!("{page}#v1;lessons"))?;
    wait(session, "the lessons", |s| s["page"] == "lessons")?;
    session.script("document.getElementById('hysteron-canvas').focus()")?;
    for presses in 1..=MOST {
        session.type_text(TAB)?;
        // A few frames: the app says where the keyboard goes.
        std::thread::sleep(Duration::from_millis(100));
        let at = session.script(
            "const at = document.activeElement; return at?.id === 'hysteron-edge' ? at.textContent : ''",
        )?;
        match at.as_str() {
            None | Some("") => {}
            Some(said) => {
                println!("after {presses} times Tab the page says: {said}");
                return Ok(());
            }
        }
    }
    Err(format!("{MOST} times Tab do not lead out of the page"))
}
