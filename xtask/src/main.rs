//! Set-up, web build, serve and tests: `cargo xtask help`.

mod archives;
mod browser;
mod offline;
mod release;
mod run;
mod serve;
mod setup;
mod size;
mod test;
mod web;

use std::process::ExitCode;

const HELP: &str = "cargo xtask COMMAND

  test            install what is missing, then every check and test
  setup           install what the tests need (Debian or Ubuntu)
  web             build the page into dist/
  serve [--port N]  serve dist/ on http://127.0.0.1:N (8080)
  browser-test    drive dist/ in headless Chromium
  fuzz [--minutes N] [--inputs N] [--seed N]
                  give every reader inputs that were made wrong
  pictures        write every page in each look and window into target/pictures/
  archives-test   pack what the tests have built, unpack it, and use it
  release         pack the program and the page into target/archives/
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match words.as_slice() {
        ["test"] => test::test(),
        ["setup"] => setup::setup(),
        ["web"] => web::build(),
        ["serve"] => serve::forever(8080),
        ["serve", "--port", port] => port
            .parse()
            .map_err(|_| format!("'{port}' is not a port; expected a number such as 8080"))
            .and_then(serve::forever),
        ["browser-test"] => browser::test(),
        ["fuzz", options @ ..] => fuzz(options),
        ["pictures"] => pictures(),
        ["archives-test"] => archives::test(),
        ["release"] => release::build(),
        [] | ["help" | "--help" | "-h"] => {
            print!("{HELP}");
            Ok(())
        }
        other => Err(format!("'{}' is not a command\n\n{HELP}", other.join(" "))),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the program that makes wrong inputs; what it says is the result.
fn fuzz(options: &[&str]) -> Result<(), String> {
    let run = ["run", "--quiet", "-p", "hysteron-fuzz", "--"];
    run::run("cargo", &[&run[..], options].concat())
}

/// Writes pictures of every page, to be looked at.
fn pictures() -> Result<(), String> {
    let test = "looks::pictures_of_every_page_in_each_look_and_window";
    let run = ["test", "--workspace", "--test", "app", "--"];
    let only = ["--ignored", "--exact", test, "--nocapture"];
    run::cargo(&[&run[..], &only].concat(), None)
}
