//! A small static server for `dist/` on this machine.

use std::io::{BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};

use crate::run::root;

/// A path at which the page is served as well, as on a host that has others.
pub const ELSEWHERE: &str = "/some/where";

/// Serves until it is stopped.
pub fn forever(port: u16) -> Result<(), String> {
    let dist = root().join("dist");
    if !dist.join("index.html").is_file() {
        return Err("there is no page yet: build it with cargo xtask web".to_owned());
    }
    let listener =
        TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|e| format!("port {port}: {e}"))?;
    println!("Hysteron is at http://127.0.0.1:{port}/ (stop with Ctrl-C)");
    accept(&listener, &dist);
    Ok(())
}

/// Serves on a free port in the background; returns the port.
pub fn in_background() -> Result<u16, String> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).map_err(|e| e.to_string())?;
    let port = listener.local_addr().map_err(|e| e.to_string())?.port();
    std::thread::spawn(move || accept(&listener, &root().join("dist")));
    Ok(port)
}

fn accept(listener: &TcpListener, dist: &Path) {
    for stream in listener.incoming().flatten() {
        let dist = dist.to_path_buf();
        std::thread::spawn(move || {
            // A browser that hangs up early is no concern of the server.
            let _ = answer(stream, &dist);
        });
    }
}

fn answer(mut stream: TcpStream, dist: &Path) -> std::io::Result<()> {
    let mut line = String::new();
    BufReader::new(&stream).read_line(&mut line)?;
    let wanted = line.split_whitespace().nth(1).unwrap_or("/");
    let found = file_for(dist, wanted)
        .and_then(|path| Some((content_type(&path), std::fs::read(path).ok()?)));
    let (status, kind, body) = match found {
        Some((kind, body)) => ("200 OK", kind, body),
        None => ("404 Not Found", "text/plain", b"not found".to_vec()),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-cache\r\nConnection: close\r\n\r\n",
        body.len()
    )?;
    stream.write_all(&body)
}

/// The file inside `dist` that a request names; nothing outside it.
fn file_for(dist: &Path, wanted: &str) -> Option<PathBuf> {
    let path = wanted.split(['?', '#']).next().unwrap_or("/");
    let path = path.strip_prefix(ELSEWHERE).unwrap_or(path);
    let path = path.trim_start_matches('/');
    let path = Path::new(if path.is_empty() { "index.html" } else { path });
    path.components()
        .all(|c| matches!(c, Component::Normal(_)))
        .then(|| dist.join(path))
}

fn content_type(path: &Path) -> &'static str {
    match path.extension().and_then(|e| e.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript",
        Some("wasm") => "application/wasm",
        Some("png") => "image/png",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_outside_the_folder_is_served() {
        let dist = Path::new("dist");
        assert_eq!(file_for(dist, "/"), Some(dist.join("index.html")));
        assert_eq!(file_for(dist, "/a.js?x=1"), Some(dist.join("a.js")));
        assert_eq!(file_for(dist, "/../Cargo.toml"), None);
    }
}
