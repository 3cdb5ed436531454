//! Whether the page is there soon, and whether it answers while a diagnosis runs: said as shares of what is asked,
//! never judged, since machines differ. That the diagnosis runs in a worker, and that the page draws meanwhile, is.

use std::time::{Duration, Instant};

use serde_json::Value;

use super::PATIENCE;
use super::driver::Session;

/// Notes times within the page; loaded before its own scripts.
const SCRIPT: &str = include_str!("watch.js");

/// Time from the start of the navigation to the first frame that answers an input, as asked, ms.
const INTERACTIVE: f64 = 3000.0;

/// Time in which the page answers while a diagnosis runs, as asked, ms.
const ANSWER: f64 = 50.0;

/// Times that the pointer sways while nothing runs.
const QUIET: usize = 12;

/// Has every page of the session watched.
pub fn install(session: &Session) -> Result<(), String> {
    session.before_every_page(SCRIPT)
}

/// Clicks a tab as soon as it is there, and says when the frame that answers was drawn.
pub fn interactive(session: &Session, page: &str) -> Result<String, String> {
    let tab = format!("page:{page}");
    let started = Instant::now();
    let mut asked = Value::Null;
    while asked.is_null() {
        if started.elapsed() > PATIENCE {
            return Err("the page did not start".to_owned());
        }
        std::thread::sleep(Duration::from_millis(10));
        asked = session.state()?["targets"][&tab].take();
    }
    session.script(&format!("window.hysteron_watch.expect('{page}')"))?;
    let coordinate = |i: usize| asked[i].as_f64().unwrap_or(0.0);
    session.tap(coordinate(0), coordinate(1))?;
    // It is painted a little after the page has taken the click.
    let mut seen = Value::Null;
    while seen[1].is_null() {
        if started.elapsed() > PATIENCE {
            return Err("no frame answered the click".to_owned());
        }
        std::thread::sleep(Duration::from_millis(50));
        seen = session.script("return window.hysteron_watch.reacted()")?;
    }
    let [first, reacted] = [0, 1].map(|i| seen[i].as_f64().unwrap_or(f64::NAN));
    Ok(format!(
        "interactive in {:.2} s, the first frame in {:.2} s: {:.2} of the {} s asked",
        reacted / 1e3,
        first / 1e3,
        reacted / INTERACTIVE,
        INTERACTIVE / 1e3
    ))
}

/// What took longest, and how long after the click that began the diagnosis, ms.
#[derive(Clone, Copy, Default)]
struct Longest {
    time: f64,
    at: f64,
}

impl Longest {
    fn or(self, other: Self) -> Self {
        if other.time > self.time { other } else { self }
    }

    fn share(self) -> String {
        let Self { time, at } = self;
        let share = time / ANSWER;
        format!("{time:.0} ms, {share:.2} of the {ANSWER} ms asked, {at:.0} ms after the beginning")
    }
}

/// What the page did while a diagnosis ran.
#[derive(Default)]
pub struct Busy {
    frames: u64,
    answers: u64,
    /// The app's own work on a frame.
    frame: Longest,
    /// A task above [`ANSWER`].
    task: Longest,
    /// From an input to the end of the frame that answers it.
    answer: Longest,
}

impl Busy {
    /// From now on.
    pub fn begin(session: &Session) -> Result<(), String> {
        session.script("window.hysteron_watch.begin()").map(|_| ())
    }

    /// What was noted since then, while a diagnosis ran.
    ///
    /// # Errors
    /// Where no worker was given anything, or nothing was drawn.
    pub fn read(&mut self, session: &Session) -> Result<(), String> {
        if self.note(session)? == 0 {
            return Err("the diagnosis did not run in a worker".to_owned());
        }
        Ok(())
    }

    /// What was noted since then, and how many tasks workers were given.
    fn note(&mut self, session: &Session) -> Result<u64, String> {
        // Tasks are told a little later.
        std::thread::sleep(Duration::from_millis(200));
        let seen = session.script("return window.hysteron_watch.read()")?;
        let count = |key: &str| seen[key].as_u64().unwrap_or(0);
        let longest = |key: &str| Longest {
            time: seen[key].as_f64().unwrap_or(0.0),
            at: seen[format!("{key}_at")].as_f64().unwrap_or(0.0),
        };
        if count("frames") == 0 {
            return Err("nothing was drawn".to_owned());
        }
        self.frames += count("frames");
        self.answers += count("answers");
        self.frame = self.frame.or(longest("frame"));
        self.task = self.task.or(longest("task"));
        self.answer = self.answer.or(longest("answer"));
        Ok(count("tasks"))
    }

    /// How long an answer takes while nothing runs: what of it is the renderer's.
    ///
    /// # Errors
    /// Where nothing was drawn.
    pub fn quiet(session: &Session, sway: &[(f64, f64)]) -> Result<String, String> {
        Self::begin(session)?;
        for _ in 0..QUIET {
            session.hover(sway)?;
        }
        let mut quiet = Self::default();
        quiet.note(session)?;
        Ok(format!(
            "with nothing running, that takes at most: {}",
            quiet.answer.share()
        ))
    }

    /// All of it, as shares of what is asked.
    pub fn report(&self) -> String {
        let task = if self.task.time == 0.0 {
            format!("none above the {ANSWER} ms asked")
        } else {
            self.task.share()
        };
        format!(
            "while a diagnosis ran: {} frames, {} of them answers to the pointer\n  \
             longest work of the app on a frame: {}\n  \
             longest task of the page's thread: {task}\n  \
             longest from the pointer to its frame, with the wait for the software renderer: {}",
            self.frames,
            self.answers,
            self.frame.share(),
            self.answer.share()
        )
    }
}
