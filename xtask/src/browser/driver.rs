//! A small client of chromedriver (the W3C `WebDriver` protocol, JSON over HTTP).

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::{Value, json};

use crate::run::{exists, output};

/// A running browser; closed when dropped.
pub struct Session {
    driver: Child,
    port: u16,
    id: String,
}

impl Session {
    /// Starts chromedriver and a headless browser with an empty profile.
    pub fn start(profile: &Path) -> Result<Self, String> {
        if !exists("chromedriver") {
            return Err("chromedriver is not installed: cargo xtask setup".to_owned());
        }
        let _ = std::fs::remove_dir_all(profile);
        let free = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))
            .and_then(|l| l.local_addr())
            .map_err(|e| e.to_string())?;
        let port = free.port();
        let driver = Command::new("chromedriver")
            .arg(format!("--port={port}"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|e| format!("chromedriver: {e}"))?;
        let mut session = Self {
            driver,
            port,
            id: String::new(),
        };
        let mut arguments: Vec<String> = [
            "--headless",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--disable-dev-shm-usage",
            "--window-size=1280,800",
        ]
        .map(str::to_owned)
        .to_vec();
        arguments.push(format!("--user-data-dir={}", profile.display()));
        if output("id", &["-u"]).is_some_and(|id| id == "0") {
            arguments.push("--no-sandbox".to_owned());
        }
        let body = json!({"capabilities": {"alwaysMatch": {
            "goog:chromeOptions": {"args": arguments},
            "goog:loggingPrefs": {"browser": "ALL"},
        }}});
        for _ in 0..50 {
            std::thread::sleep(Duration::from_millis(200));
            if TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_ok() {
                break;
            }
        }
        let value = session.request("POST", "/session", &body)?;
        value["sessionId"]
            .as_str()
            .ok_or("the browser did not start")?
            .clone_into(&mut session.id);
        Ok(session)
    }

    /// Opens an address.
    pub fn open(&self, url: &str) -> Result<(), String> {
        self.command("POST", "url", &json!({"url": url}))
            .map(|_| ())
    }

    /// The app's own word on what it shows; empty until it has one.
    pub fn state(&self) -> Result<Value, String> {
        let text = self.script("return window.hysteron_state || '{}'")?;
        serde_json::from_str(text.as_str().unwrap_or("{}")).map_err(|e| e.to_string())
    }

    /// What the address bar says.
    pub fn address(&self) -> Result<String, String> {
        let address = self.script("return window.location.href")?;
        Ok(address.as_str().unwrap_or_default().to_owned())
    }

    /// Whether the service worker has taken the page over.
    pub fn kept_for_offline(&self) -> Result<bool, String> {
        let kept = self
            .script("return !!(navigator.serviceWorker && navigator.serviceWorker.controller)")?;
        Ok(kept == true)
    }

    /// Takes the network from the page, or gives it back.
    pub fn network(&self, there: bool) -> Result<(), String> {
        let limits = json!({"offline": !there, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1});
        self.devtools("Network.enable", &json!({}))?;
        self.devtools("Network.emulateNetworkConditions", &limits)
    }

    /// Runs a script before those of every page that is opened from now on.
    pub fn before_every_page(&self, script: &str) -> Result<(), String> {
        self.devtools(
            "Page.addScriptToEvaluateOnNewDocument",
            &json!({"source": script}),
        )
    }

    /// Asks the browser for what a driver has no word for.
    pub fn devtools(&self, command: &str, params: &Value) -> Result<(), String> {
        let body = json!({"cmd": command, "params": params});
        self.command("POST", "goog/cdp/execute", &body).map(|_| ())
    }

    /// Runs a script in the page.
    pub fn script(&self, script: &str) -> Result<Value, String> {
        self.command(
            "POST",
            "execute/sync",
            &json!({"script": script, "args": []}),
        )
    }

    /// A click as a hand makes it: move, press, release.
    pub fn click(&self, x: f64, y: f64) -> Result<(), String> {
        let pause = json!({"type": "pause", "duration": 150});
        self.pointer(&[go(x, y, 50), pause.clone(), press(), pause, release()])
    }

    /// A click without a pause.
    pub fn tap(&self, x: f64, y: f64) -> Result<(), String> {
        self.pointer(&[go(x, y, 0), press(), release()])
    }

    /// A drag from one place through others.
    pub fn drag(&self, places: &[(f64, f64)]) -> Result<(), String> {
        let mut actions: Vec<Value> = places.iter().map(|(x, y)| go(*x, *y, 100)).collect();
        actions.insert(1.min(actions.len()), press());
        actions.push(release());
        self.pointer(&actions)
    }

    /// The pointer goes from place to place.
    pub fn hover(&self, places: &[(f64, f64)]) -> Result<(), String> {
        let actions: Vec<Value> = places.iter().map(|(x, y)| go(*x, *y, 20)).collect();
        self.pointer(&actions)
    }

    /// Turns the wheel at a place: so many points down the page.
    pub fn wheel(&self, x: f64, y: f64, points: i64) -> Result<(), String> {
        let turn = json!({"type": "scroll", "x": x.round() as i64, "y": y.round() as i64, "deltaX": 0, "deltaY": points, "duration": 0});
        let actions = json!({"actions": [{"type": "wheel", "id": "wheel", "actions": [turn]}]});
        self.command("POST", "actions", &actions).map(|_| ())
    }

    fn pointer(&self, actions: &[Value]) -> Result<(), String> {
        let actions = json!({"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": actions}]});
        self.command("POST", "actions", &actions).map(|_| ())
    }

    /// Types a text where the keyboard is.
    pub fn type_text(&self, text: &str) -> Result<(), String> {
        let strokes: Vec<Value> = text
            .chars()
            .flat_map(|c| ["keyDown", "keyUp"].map(|kind| json!({"type": kind, "value": c})))
            .collect();
        let actions = json!({"actions": [{"type": "key", "id": "keys", "actions": strokes}]});
        self.command("POST", "actions", &actions).map(|_| ())
    }

    /// A screenshot as PNG.
    pub fn screenshot(&self) -> Result<Vec<u8>, String> {
        let value = self.command("GET", "screenshot", &Value::Null)?;
        decode_base64(value.as_str().ok_or("no screenshot")?)
    }

    /// Fails if the console or the page holds an error.
    pub fn quiet(&self) -> Result<(), String> {
        let log = self.command("POST", "se/log", &json!({"type": "browser"}))?;
        let severe: Vec<&Value> = log
            .as_array()
            .into_iter()
            .flatten()
            .filter(|entry| {
                entry["level"] == "SEVERE" && !entry["message"].to_string().contains("favicon.ico")
            })
            .collect();
        let errors = self.script("return window.hysteron_errors || []")?;
        if severe.is_empty() && errors.as_array().is_none_or(Vec::is_empty) {
            return Ok(());
        }
        Err(format!("the console has errors: {severe:?} {errors}"))
    }

    fn command(&self, method: &str, path: &str, body: &Value) -> Result<Value, String> {
        self.request(method, &format!("/session/{}/{path}", self.id), body)
    }

    fn request(&self, method: &str, path: &str, body: &Value) -> Result<Value, String> {
        let fail = |e: std::io::Error| format!("chromedriver {path}: {e}");
        let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).map_err(fail)?;
        stream
            .set_read_timeout(Some(Duration::from_mins(5)))
            .map_err(fail)?;
        let body = if body.is_null() {
            String::new()
        } else {
            body.to_string()
        };
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
            body.len()
        )
        .map_err(fail)?;
        let reply = read_reply(&mut stream).map_err(fail)?;
        let value: Value =
            serde_json::from_str(&reply).map_err(|e| format!("chromedriver {path}: {e}"))?;
        match value["value"]["error"].as_str() {
            Some(error) => Err(format!(
                "chromedriver {path}: {error}: {}",
                value["value"]["message"]
            )),
            None => Ok(value["value"].clone()),
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if !self.id.is_empty() {
            let _ = self.request("DELETE", &format!("/session/{}", self.id), &Value::Null);
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

fn go(x: f64, y: f64, duration: u32) -> Value {
    json!({"type": "pointerMove", "duration": duration, "x": x.round() as i64, "y": y.round() as i64})
}

fn press() -> Value {
    json!({"type": "pointerDown", "button": 0})
}

fn release() -> Value {
    json!({"type": "pointerUp", "button": 0})
}

/// Body of an HTTP reply with a content length.
fn read_reply(stream: &mut TcpStream) -> std::io::Result<String> {
    let mut bytes = Vec::new();
    let mut part = vec![0; 65536];
    loop {
        if let Some(end) = bytes.windows(4).position(|w| w == b"\r\n\r\n") {
            let head = String::from_utf8_lossy(&bytes[..end]).to_lowercase();
            let length = head
                .lines()
                .find_map(|l| l.strip_prefix("content-length:"))
                .and_then(|l| l.trim().parse::<usize>().ok());
            if let Some(length) = length
                && bytes.len() >= end + 4 + length
            {
                return Ok(String::from_utf8_lossy(&bytes[end + 4..end + 4 + length]).into_owned());
            }
        }
        let n = stream.read(&mut part)?;
        if n == 0 {
            let end = bytes
                .windows(4)
                .position(|w| w == b"\r\n\r\n")
                .map_or(bytes.len(), |e| e + 4);
            return Ok(String::from_utf8_lossy(&bytes[end..]).into_owned());
        }
        bytes.extend_from_slice(&part[..n]);
    }
}

fn decode_base64(text: &str) -> Result<Vec<u8>, String> {
    let mut out = Vec::with_capacity(text.len() * 3 / 4);
    let (mut bits, mut count) = (0_u32, 0);
    for c in text
        .bytes()
        .filter(|c| !c.is_ascii_whitespace() && *c != b'=')
    {
        let value = match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return Err("the screenshot is not base64".to_owned()),
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
        }
    }
    Ok(out)
}
