//! The page in a real headless Chromium: loads, opens a measurement, adds the effect, reads the error.

mod driver;
mod speed;

use std::cell::Cell;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::run::root;
use crate::serve;
use driver::Session;

/// How long to wait for any one thing; software rendering on a small machine is slow.
const PATIENCE: Duration = Duration::from_mins(3);

/// Different colours that a drawn page has at least; a blank one has one or two.
const LEAST_COLOURS: usize = 24;

/// Runs the whole test.
pub fn test() -> Result<(), String> {
    let folder = root().join("target/browser-test");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let port = serve::in_background()?;
    let session = Session::start(&folder.join("profile"))?;
    session.open(&format!("http://127.0.0.1:{port}/"))?;
    wait(&session, "the page to start", |s| s["ready"] == true)?;
    look(&session, &folder.join("explore.png"))?;
    click(&session, "page:compare")?;
    wait(&session, "the compare page", |s| {
        s["page"] == "compare" && !s["targets"]["builtin:drive-02"].is_null()
    })?;
    click(&session, "builtin:drive-02")?;
    let before = wait_drawing(&session, "the candidates", |s| {
        s["busy"] == false && has_candidate(s)
    })?;
    let error = before["error"].as_f64().ok_or("no error is shown")?;
    look(&session, &folder.join("compare.png"))?;
    click(&session, "add:coulomb_friction")?;
    let after = wait_drawing(&session, "the model with Coulomb friction", |s| {
        s["busy"] == false && s["effects"].to_string().contains("coulomb_friction")
    })?;
    let fallen = after["error"].as_f64().ok_or("no error is shown")?;
    println!("error {error:.2} -> {fallen:.2}");
    println!("verdict: {}", after["verdict"]);
    if fallen * 3.0 > error {
        return Err(format!("the error fell from {error} to {fallen} only"));
    }
    look(&session, &folder.join("added.png"))?;
    speed::report(&session)?;
    session.quiet()
}

fn has_candidate(state: &Value) -> bool {
    state["candidates"]
        .as_array()
        .is_some_and(|c| !c.is_empty())
        && !state["targets"]["add:coulomb_friction"].is_null()
}

fn wait(session: &Session, what: &str, done: impl Fn(&Value) -> bool) -> Result<Value, String> {
    let started = Instant::now();
    loop {
        let state = session.state()?;
        if done(&state) {
            return Ok(state);
        }
        if started.elapsed() > PATIENCE {
            return Err(format!(
                "waited in vain for {what}; the page says {state}; {:?}",
                session.quiet()
            ));
        }
        std::thread::sleep(Duration::from_millis(200));
    }
}

/// Waits, and checks that the page goes on drawing while a job runs.
fn wait_drawing(
    session: &Session,
    what: &str,
    done: impl Fn(&Value) -> bool,
) -> Result<Value, String> {
    let last = Cell::new(0);
    let (busy, drawn) = (Cell::new(0), Cell::new(0));
    let state = wait(session, what, |s| {
        let frame = s["frame"].as_u64().unwrap_or(0);
        if s["busy"] == true {
            busy.set(busy.get() + 1);
            drawn.set(drawn.get() + i32::from(frame > last.get()));
        }
        last.set(frame);
        done(s)
    })?;
    let (busy, drawn) = (busy.get(), drawn.get());
    println!("{what}: seen busy {busy} times, with new frames {drawn} times");
    if busy > 4 && drawn * 4 < busy {
        return Err(format!(
            "the page stood still while it waited for {what}: {drawn} of {busy} looks saw a new frame"
        ));
    }
    Ok(state)
}

fn click(session: &Session, target: &str) -> Result<(), String> {
    let state = wait(session, &format!("the button {target}"), |s| {
        s["targets"][target].is_array()
    })?;
    let coordinate = |i: usize| state["targets"][target][i].as_f64().unwrap_or(0.0);
    session.click(coordinate(0), coordinate(1))
}

/// Takes a screenshot and checks that something is drawn.
fn look(session: &Session, path: &std::path::Path) -> Result<(), String> {
    std::thread::sleep(Duration::from_millis(800));
    let bytes = session.screenshot()?;
    std::fs::write(path, &bytes).map_err(|e| e.to_string())?;
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .map_err(|e| e.to_string())?;
    let mut pixels = vec![
        0;
        reader
            .output_buffer_size()
            .ok_or("the screenshot is too large")?
    ];
    let info = reader.next_frame(&mut pixels).map_err(|e| e.to_string())?;
    let mut colours: Vec<&[u8]> = pixels[..info.buffer_size()]
        .chunks(info.color_type.samples())
        .collect();
    colours.sort_unstable();
    colours.dedup();
    println!("{}: {} colours", path.display(), colours.len());
    if colours.len() < LEAST_COLOURS {
        return Err(format!(
            "{} is blank: only {} colours",
            path.display(),
            colours.len()
        ));
    }
    Ok(())
}
