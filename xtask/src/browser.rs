//! The page in a real headless Chromium: loads, opens a measurement, adds the effect, reads the error.

mod driver;
mod dropped;
mod export;
mod mystery;
mod phone;
mod refused;
mod same;
mod speed;
mod watch;
mod way_out;

use std::cell::Cell;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::run::root;
use crate::serve;
use driver::Session;
use watch::Busy;

/// How long to wait for any one thing; software rendering on a small machine is slow.
const PATIENCE: Duration = Duration::from_mins(3);

/// A wait that is said: from these one sees how far the patience is.
const WORTH_SAYING: Duration = Duration::from_secs(5);

/// Different colours that a drawn page has at least; a blank one has one or two.
const LEAST_COLOURS: usize = 24;

/// Runs the whole test.
pub fn test() -> Result<(), String> {
    let folder = root().join("target/browser-test");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let port = serve::in_background()?;
    let session = Session::start(&folder.join("profile"))?;
    let page = format!("http://127.0.0.1:{port}/");
    watch::install(&session)?;
    session.open(&page)?;
    let interactive = watch::interactive(&session, "lessons")?;
    click(&session, "page:start")?;
    wait(&session, "the page to start", |s| s["page"] == "start")?;
    look(&session, &folder.join("start.png"))?;
    click(&session, "door:compare")?;
    wait(&session, "the compare page", |s| {
        s["page"] == "compare" && !s["targets"]["builtin:drive-02"].is_null()
    })?;
    let mut busy = Busy::default();
    Busy::begin(&session)?;
    click(&session, "builtin:drive-02")?;
    let before = wait_drawing(&session, "the candidates", |s| {
        s["busy"] == false && has_candidate(s)
    })?;
    busy.read(&session)?;
    let error = before["error"].as_f64().ok_or("no error is shown")?;
    same::check(&before, "assets/measurements/drive-02.csv")?;
    look(&session, &folder.join("compare.png"))?;
    Busy::begin(&session)?;
    click(&session, "add:coulomb_friction")?;
    let after = wait_drawing(&session, "the model with Coulomb friction", |s| {
        s["busy"] == false && s["effects"].to_string().contains("coulomb_friction")
    })?;
    busy.read(&session)?;
    let fallen = after["error"].as_f64().ok_or("no error is shown")?;
    println!("error {error:.2} -> {fallen:.2}");
    println!("verdict: {}", after["verdict"]);
    if fallen * 3.0 > error {
        return Err(format!("the error fell from {error} to {fallen} only"));
    }
    look(&session, &folder.join("added.png"))?;
    let quiet = Busy::quiet(&session, &SWAY)?;
    share(&session, &page, &after)?;
    offline(&session, &page)?;
    export::journey(&session, &folder.join("exports"), &page)?;
    mystery::journey(&session, &page, &folder)?;
    dropped::journey(&session, &page)?;
    way_out::journey(&session, &page)?;
    phone::journey(&session, &folder, port)?;
    refused::journey(&folder.join("refused"), &page)?;
    speed::report(&session)?;
    println!("{interactive}\n{}\n  {quiet}", busy.report());
    session.quiet()
}

/// Copies the link of what is shown and opens it anew: the same must be there.
fn share(session: &Session, page: &str, shown: &Value) -> Result<(), String> {
    click(session, "copy link")?;
    wait(session, "the word that the link is copied", |s| {
        s["notice"].is_string()
    })?;
    let address = session.address()?;
    let expected = format!("{page}#{}", shown["link"].as_str().unwrap_or_default());
    if address != expected {
        return Err(format!("the address bar says {address}, not {expected}"));
    }
    session.open("about:blank")?;
    session.open(&address)?;
    let again = wait(session, "the page of the link", |s| {
        s["busy"] == false && s["error"].is_number() && s["link"] == shown["link"]
    })?;
    for key in ["page", "file", "effects", "error", "verdict"] {
        if again[key] != shown[key] {
            return Err(format!(
                "the link shows another {key}: {} instead of {}",
                again[key], shown[key]
            ));
        }
    }
    println!("the link shows the same: {address}");
    session.open("about:blank")?;
    session.open(&format!("{page}#v1;explore;loop.relay.gain=-1"))?;
    let refused = wait(session, "the refusal of a bad link", |s| {
        s["notice"].is_string()
    })?;
    println!("a bad link is refused: {}", refused["notice"]);
    Ok(())
}

/// Loads the page again without a network.
fn offline(session: &Session, page: &str) -> Result<(), String> {
    let started = Instant::now();
    while !session.kept_for_offline()? {
        if started.elapsed() > PATIENCE {
            return Err("the page was not kept for visits without a network".to_owned());
        }
        std::thread::sleep(Duration::from_millis(200));
    }
    session.open("about:blank")?;
    session.network(false)?;
    session.open(&format!("{page}#v1;lessons"))?;
    wait(session, "the page without a network", |s| {
        s["ready"] == true && s["page"] == "lessons"
    })?;
    session.network(true)?;
    println!("the page opens without a network");
    Ok(())
}

fn has_candidate(state: &Value) -> bool {
    state["candidates"]
        .as_array()
        .is_some_and(|c| !c.is_empty())
        && !state["targets"]["add:coulomb_friction"].is_null()
}

fn wait(session: &Session, what: &str, done: impl Fn(&Value) -> bool) -> Result<Value, String> {
    wait_and(session, what, done, || {
        std::thread::sleep(Duration::from_millis(200));
        Ok(())
    })
}

/// Waits, and does something between the looks.
fn wait_and(
    session: &Session,
    what: &str,
    done: impl Fn(&Value) -> bool,
    between: impl Fn() -> Result<(), String>,
) -> Result<Value, String> {
    let started = Instant::now();
    loop {
        let state = session.state()?;
        if done(&state) {
            if started.elapsed() > WORTH_SAYING {
                println!("waited {} s for {what}", started.elapsed().as_secs());
            }
            return Ok(state);
        }
        if started.elapsed() > PATIENCE {
            return Err(format!(
                "waited in vain for {what}; the page says {state}; {:?}",
                session.quiet()
            ));
        }
        between()?;
    }
}

/// Where the pointer goes while a job runs: over the plots.
const SWAY: [(f64, f64); 8] = [
    (300.0, 500.0),
    (360.0, 510.0),
    (420.0, 520.0),
    (480.0, 530.0),
    (540.0, 530.0),
    (480.0, 520.0),
    (420.0, 510.0),
    (360.0, 500.0),
];

/// Waits with a pointer that moves, and checks that the page goes on drawing while a job runs.
fn wait_drawing(
    session: &Session,
    what: &str,
    done: impl Fn(&Value) -> bool,
) -> Result<Value, String> {
    let last = Cell::new(0);
    let (busy, drawn) = (Cell::new(0), Cell::new(0));
    let look = |s: &Value| {
        let frame = s["frame"].as_u64().unwrap_or(0);
        if s["busy"] == true {
            busy.set(busy.get() + 1);
            drawn.set(drawn.get() + i32::from(frame > last.get()));
        }
        last.set(frame);
        done(s)
    };
    let state = wait_and(session, what, look, || session.hover(&SWAY))?;
    let (busy, drawn) = (busy.get(), drawn.get());
    println!("{what}: seen busy {busy} times, with new frames {drawn} times");
    if busy > 4 && drawn * 4 < busy {
        return Err(format!(
            "the page stood still while it waited for {what}: {drawn} of {busy} looks saw a new frame"
        ));
    }
    Ok(state)
}

/// Clicks on a button where it stands still.
fn click(session: &Session, target: &str) -> Result<(), String> {
    let last = Cell::new(Value::Null);
    let state = wait(session, &format!("the button {target}"), |s| {
        let place = s["targets"][target].clone();
        place.is_array() && last.replace(place.clone()) == place
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
