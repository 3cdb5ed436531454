//! A mystery is made, handed on as a link, diagnosed and revealed.

use std::path::Path;
use std::time::Duration;

use super::driver::Session;
use super::{click, look, wait, wait_and};

const WORD: &str = "blue whale";

/// The whole way, teacher's and student's.
pub fn journey(session: &Session, page: &str, folder: &Path) -> Result<(), String> {
    click(session, "page:mystery")?;
    click(session, "mystery:choose")?;
    click(session, "mystery:hide:input_delay")?;
    // The word stands below a long list.
    session.wheel(300.0, 500.0, 2000)?;
    wait(session, "the end of the page", |s| {
        s["targets"]["mystery:make"].is_array()
    })?;
    type_word(session, "mystery:word")?;
    click(session, "mystery:make")?;
    let made = wait(session, "the mystery", |s| s["mystery"]["made"].is_string())?;
    click(session, "mystery:open")?;
    let opened = wait(session, "the mystery in Compare", |s| {
        s["page"] == "compare" && s["link"].to_string().contains("mystery=")
    })?;
    let link = opened["link"].as_str().unwrap_or_default().to_owned();
    session.open("about:blank")?;
    session.open(&format!("{page}#{link}"))?;
    let before = wait(session, "the record of the link", |s| {
        s["busy"] == false && s["error"].is_number() && s["file"] == made["mystery"]["made"]
    })?;
    if before.to_string().contains("whale") {
        return Err("the word is in the page".to_owned());
    }
    if before["guessing"] != true {
        return Err("a mystery tells at once what helps".to_owned());
    }
    look(session, &folder.join("mystery.png"))?;
    reach(session, "add:input_delay", "guess")?;
    click(session, "add:input_delay")?;
    let after = wait(session, "the model with the input delay", |s| {
        s["busy"] == false && s["effects"].to_string().contains("input_delay")
    })?;
    click(session, "look:reveal")?;
    type_word(session, "reveal:word")?;
    click(session, "reveal")?;
    let revealed = wait(session, "the truth", |s| s["sealed"]["points"].is_number())?;
    let points = revealed["sealed"]["points"].as_f64().unwrap_or(0.0);
    println!(
        "{}: error {} -> {}, {points:.0} of 100 points; its link has {} characters",
        made["mystery"]["made"],
        before["error"],
        after["error"],
        link.len()
    );
    if points < 90.0 {
        return Err(format!("the right effect has {points} points only"));
    }
    Ok(())
}

/// Turns the wheel over one thing until another is seen.
fn reach(session: &Session, target: &str, over: &str) -> Result<(), String> {
    let state = wait(session, over, |s| s["targets"][over].is_array())?;
    let place = |i: usize| state["targets"][over][i].as_f64().unwrap_or(0.0);
    let seen = |s: &serde_json::Value| s["targets"][target].is_array();
    // The page knows the pointer only once it moves.
    session.hover(&[(place(0), place(1))])?;
    // One step at a time, or the page goes past it.
    let step = || {
        session.wheel(place(0), place(1), 100)?;
        std::thread::sleep(Duration::from_millis(400));
        Ok(())
    };
    wait_and(session, target, seen, step).map(|_| ())
}

/// Types the word where it belongs, once the page stands still and the keyboard is there.
fn type_word(session: &Session, field: &str) -> Result<(), String> {
    let pause = || std::thread::sleep(Duration::from_secs(1));
    pause();
    click(session, field)?;
    pause();
    session.type_text(WORD)?;
    pause();
    Ok(())
}
