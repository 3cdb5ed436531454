//! The keyboard leaves the page: after the last control, Tab goes on to the browser.

use std::time::{Duration, Instant};

use super::driver::Session;
use super::wait;

/// The key Tab, as a driver writes it.
const TAB: &str = "\u{e004}";

/// Presses that lead past all controls of a page with few.
const MOST: usize = 80;

/// Longest that is waited for a frame; there is none once the keyboard has left.
const SLOWEST: Duration = Duration::from_secs(2);

pub fn journey(session: &Session, page: &str) -> Result<(), String> {
    session.open("about:blank")?;
    session.open(&format!("{page}#v1;lessons"))?;
    wait(session, "the lessons", |s| s["page"] == "lessons")?;
    session.script("document.getElementById('hysteron-canvas').focus()")?;
    for presses in 1..=MOST {
        let before = session.state()?["frame"].clone();
        session.type_text(TAB)?;
        // Of two presses in one frame the app takes one.
        let pressed = Instant::now();
        while session.state()?["frame"] == before && pressed.elapsed() < SLOWEST {
            std::thread::sleep(Duration::from_millis(10));
        }
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
