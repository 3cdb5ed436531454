//! The page on a phone, at a path below the root of its host: by fingers alone from the first page to a diagnosis.

use std::path::Path;

use serde_json::{Value, json};

use super::driver::Session;
use super::{look, wait};
use crate::serve::ELSEWHERE;

/// Width and height of the screen, points, and its pixels in a point.
const SCREEN: [u32; 2] = [390, 844];
const DENSITY: u32 = 3;

/// The whole way; the screen is as before at its end.
pub fn journey(session: &Session, folder: &Path, port: u16) -> Result<(), String> {
    let [width, height] = SCREEN;
    let screen =
        json!({"width": width, "height": height, "deviceScaleFactor": DENSITY, "mobile": true});
    session.devtools("Emulation.setDeviceMetricsOverride", &screen)?;
    session.devtools(
        "Emulation.setTouchEmulationEnabled",
        &json!({"enabled": true}),
    )?;
    session.open("about:blank")?;
    let page = format!("http://127.0.0.1:{port}{ELSEWHERE}/");
    session.open(&format!("{page}#v1;start"))?;
    let there = wait(session, "the page on a phone", |s| {
        s["ready"] == true && s["targets"]["menu"].is_array() && s["size"][0] == width
    })?;
    if there["size"] != json!(SCREEN) {
        return Err(format!("the page is {} points large", there["size"]));
    }
    let pixels = session.script("return document.querySelector('canvas').width")?;
    if pixels != json!(width * DENSITY) {
        return Err(format!("its canvas is {pixels} pixels wide"));
    }
    look(session, &folder.join("phone.png"))?;
    finger(session, "menu")?;
    finger(session, "page:explore")?;
    wait(session, "Explore on a phone", |s| s["page"] == "explore")?;
    // The page has come up with what was open at the last visit: a link without a file closes it.
    session.open("about:blank")?;
    session.open(&format!("{page}#v1;compare"))?;
    finger(session, "builtin:drive-02")?;
    let found = wait(session, "the diagnosis on a phone", |s| {
        s["busy"] == false && s["error"].is_number()
    })?;
    look(session, &folder.join("phone-compare.png"))?;
    let strangers = session.script(&format!(
        "return performance.getEntriesByType('resource').map((e) => e.name)\
         .filter((n) => !n.startsWith(location.origin + '{ELSEWHERE}/') && !n.startsWith('blob:'))"
    ))?;
    if strangers != json!([]) {
        return Err(format!("the page asks elsewhere: {strangers}"));
    }
    println!(
        "on a phone, at {ELSEWHERE}/: error {}, nothing asked of others",
        found["error"]
    );
    session.devtools(
        "Emulation.setTouchEmulationEnabled",
        &json!({"enabled": false}),
    )?;
    session.devtools("Emulation.clearDeviceMetricsOverride", &json!({}))
}

/// Touches a button.
fn finger(session: &Session, target: &str) -> Result<(), String> {
    let shown = |s: &Value| s["targets"][target].is_array();
    wait(session, &format!("the button {target}"), shown)?;
    // Menus open with a movement.
    std::thread::sleep(std::time::Duration::from_millis(600));
    let state = wait(session, &format!("the button {target}"), shown)?;
    let [x, y] = [0, 1].map(|i| state["targets"][target][i].as_f64().unwrap_or(0.0));
    let touch = |kind: &str, points: Value| {
        session.devtools(
            "Input.dispatchTouchEvent",
            &json!({"type": kind, "touchPoints": points}),
        )
    };
    touch("touchStart", json!([{"x": x, "y": y}]))?;
    std::thread::sleep(std::time::Duration::from_millis(120));
    touch("touchEnd", json!([]))
}
