//! How fast the page computes in the browser: said, never judged, since machines differ.

use serde_json::Value;

use super::driver::Session;
use super::{click, wait};

/// Drags the hysteresis and says how long the *Explore* page computed, then simulates the drive.
pub fn report(session: &Session) -> Result<(), String> {
    click(session, "page:explore")?;
    let state = wait(session, "the Nyquist plot", |s| {
        s["page"] == "explore" && s["targets"]["nyquist:line"].is_array()
    })?;
    let line = |i: usize| state["targets"]["nyquist:line"][i].as_f64().unwrap_or(0.0);
    let (x, y) = (line(0), line(1));
    let sway: Vec<(f64, f64)> = (0..80)
        .map(|i| (x, y + 12.0 * (f64::from(i) * 0.37).sin()))
        .collect();
    session.drag(&sway)?;
    let computed = wait(session, "the dragged loop", |s| s["busy"] == false)?;
    say("explore, slider to data", &computed["compute_ms"], "ms");

    click(session, "page:backlash")?;
    let drive = wait(session, "the simulated drive", |s| {
        s["page"] == "backlash" && s["times_real_time"].is_number()
    })?;
    say(
        "the drifting drive, times real time",
        &drive["times_real_time"],
        "",
    );
    Ok(())
}

fn say(what: &str, value: &Value, unit: &str) {
    println!("speed here: {what}: {value} {unit}");
}
