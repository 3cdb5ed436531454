//! `hysteron simulate SCENARIO.toml`

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use hysteron_core::counted;
use hysteron_core::drive::{self, DriveInput, DriveRun, Summary, summarize};
use hysteron_core::hunting::{self, HuntingError, HuntingRun};
use hysteron_core::message::{Message, fixed};
use hysteron_core::msg;
use hysteron_core::on_off;
use hysteron_core::scenario::AnyScenario;
use hysteron_core::simulate::{Cut, Noise, Trajectory};
use hysteron_core::uncertain::digits;

use crate::output::say_lines;
use crate::read::{bytes_of, shown};

/// Digits of a velocity that is said.
const DIGITS: i32 = 7;

/// Share by which the last two cycles may differ and still count as settled.
const SETTLED: f64 = 1e-3;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Loop, drive or servo to run: tables [plant] or [drive], [relay] and [run]; or [servo] and [run]
    #[arg(value_name = "SCENARIO.toml")]
    file: PathBuf,
    /// Where to write time, input and output; the output is what the relay or controller sees, with the noise if there
    /// is some
    #[arg(long, value_name = "OUT.csv")]
    csv: Option<PathBuf>,
}

/// What happened in words, or one line that says what is wrong with the input.
pub fn run(arguments: &Arguments) -> Result<String, Message> {
    let shown = || shown(&arguments.file);
    let (mut text, table, samples) = match read(&arguments.file)? {
        AnyScenario::Loop(scenario) => {
            let run = scenario.run().map_err(|e| msg!("{}: {}", shown(), e))?;
            let noise = scenario.options.noise;
            let samples = (run.time.as_slice(), run.output.as_slice());
            (
                summary(&run),
                table(samples, &run.input, noise),
                run.time.len(),
            )
        }
        AnyScenario::OnOff(scenario) => {
            let run = scenario.run().map_err(|e| msg!("{}: {}", shown(), e))?;
            let end = run.time.last().copied().unwrap_or(0.0);
            let mut said = switched(run.switches.len(), end, run.cut);
            let cycle =
                on_off::settled(&scenario.on_off).map_err(|e| msg!("{}: {}", shown(), e))?;
            say_settled(&mut said, &cycle.text, scenario.noise);
            let samples = (run.time.as_slice(), run.output.as_slice());
            (
                said,
                table(samples, &run.input, scenario.noise),
                run.time.len(),
            )
        }
        AnyScenario::Servo(scenario) => {
            let located = |e: HuntingError| msg!("{}: {}", shown(), e);
            let run = scenario.run().map_err(located)?;
            let found = hunting::settled(&scenario.servo).map_err(|e| located(e.into()))?;
            let said = servo_summary(&run, &found.text, scenario.noise);
            (said, servo_table(&run, scenario.noise), run.time.len())
        }
        AnyScenario::Drive(input) => {
            let run = drive::run(&input).map_err(|e| msg!("{}: {}", shown(), e))?;
            let said = drive_summary(&input, &run);
            (said, drive_table(&run), run.time.len())
        }
    };
    if let Some(path) = &arguments.csv {
        std::fs::write(path, table).map_err(|e| {
            msg!(
                "{} cannot be written: {}",
                Message::name(path.display().to_string()),
                Message::name(e.to_string())
            )
        })?;
        text.push(msg!(
            "{} written to {}.",
            counted!(samples, "1 sample", "{} samples"),
            Message::name(path.display().to_string())
        ));
    }
    Ok(say_lines(&text))
}

/// Reads a scenario file.
pub fn read(path: &Path) -> Result<AnyScenario, Message> {
    if path.is_dir() {
        return Err(msg!("{} is a directory; expected a TOML file", shown(path)));
    }
    let bytes = bytes_of(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|e| {
        let line = bytes[..e.valid_up_to()].split(|b| *b == b'\n').count();
        msg!(
            "{}, line {}: not UTF-8 text; expected a TOML file",
            shown(path),
            line
        )
    })?;
    AnyScenario::from_toml(text).map_err(|e| msg!("{}: {}", shown(path), e))
}

/// How many switches there were, and why no more.
fn switched(switches: usize, end: f64, cut: Option<Cut>) -> Vec<Message> {
    let switches = counted!(switches, "1 switch", "{} switches");
    let mut text = vec![msg!("{} in {} s.", switches, fixed(end, 6))];
    let why = cut.map(|cut| match cut {
        Cut::Chattering => "The relay chatters: it switches without end, and the run was stopped there.",
        Cut::TooManySwitches => {
            "The run was stopped there, at the most switches allowed: a shorter duration runs to its end."
        }
        Cut::TooFast => {
            "A part of the plant is far too fast for the rest: the run was stopped there after millions of steps."
        }
    });
    text.extend(why.map(Message::from));
    text
}

fn summary(run: &Trajectory) -> Vec<Message> {
    let mut text = switched(run.rises.len() + run.falls.len(), run.end(), run.cut);
    if !run.sliding.is_empty() {
        let total: f64 = run.sliding.iter().map(|s| s[1] - s[0]).sum();
        text.push(msg!(
            "The output slides along the threshold {}, {} s in all.",
            counted!(run.sliding.len(), "1 time", "{} times"),
            fixed(total, 6)
        ));
    }
    match run.settled(SETTLED) {
        Some((period, amplitude)) => {
            text.push(msg!(
                "It oscillates: period {} s, amplitude {} (half of peak to peak).",
                fixed(period, 9),
                fixed(amplitude, 9)
            ));
        }
        None if run.cut.is_none() => {
            text.push("It has not settled into an oscillation.".into());
        }
        None => {}
    }
    text
}

/// What becomes of a loop, which is found without the noise.
fn say_settled(text: &mut Vec<Message>, settled: &Message, noise: Option<Noise>) {
    text.push(if noise.is_some() {
        msg!("Without the noise: {}", settled)
    } else {
        settled.clone()
    });
}

/// Noise at the sampling instants.
fn noise_at(noise: Option<Noise>, time: &[f64]) -> Vec<f64> {
    noise.map_or_else(|| vec![0.0; time.len()], |noise| noise.at(time))
}

/// Input and output at the sampling instants, in the columns that `hysteron diagnose` reads: the output as a recorder
/// would have it, with what the relay sees of the noise.
fn table((time, output): (&[f64], &[f64]), input: &[[f64; 2]], noise: Option<Noise>) -> String {
    let noise = noise_at(noise, time);
    let mut text = String::from("t [s],u [1],y [1]\n");
    let mut inputs = input.iter().peekable();
    let mut u = 0.0;
    for ((t, y), noise) in time.iter().zip(output).zip(noise) {
        while let Some(change) = inputs.next_if(|i| i[0] <= *t) {
            u = change[1];
        }
        let _ = writeln!(text, "{t},{u},{}", y + noise);
    }
    text
}

/// What a drive did.
fn drive_summary(input: &DriveInput, run: &DriveRun) -> Vec<Message> {
    let end = run.time.last().copied().unwrap_or(0.0);
    let mut text = vec![msg!(
        "{} and {} in {} s.",
        counted!(run.switches(), "1 switch", "{} switches"),
        counted!(run.impacts(), "1 impact", "{} impacts"),
        fixed(end, 6)
    )];
    if let Some(time) = run.chattering {
        text.push(msg!(
            "At {} s it switches without end, and the run was stopped there.",
            fixed(time, 6)
        ));
    }
    let found: Summary = summarize(input, run);
    if let Some(drift) = found.drifts.first() {
        text.push(msg!(
            "In the gap the motor drifts at {} rad/s (or m/s) from {} s to {} s.",
            digits(drift.velocity, DIGITS),
            fixed(drift.from, 3),
            fixed(drift.to, 3)
        ));
    }
    let count = found.traverses.len();
    if count > 0 {
        let mean = found.traverses.iter().map(|t| t.travel).sum::<f64>() / count as f64;
        text.push(msg!(
            "It crosses the gap {}, {} rad (or m) from contact to contact; the gap is {}.",
            counted!(count, "1 time", "{} times"),
            fixed(mean, 6),
            fixed(2.0 * input.drive.half_gap, 6)
        ));
    }
    text
}

/// Torque, motor and load at the sampling instants, in the columns that `hysteron gap` and `diagnose` read.
fn drive_table(run: &DriveRun) -> String {
    let mut text = String::from("t [s],u [N m],x1 [rad],v1 [rad/s],x2 [rad]\n");
    for (i, t) in run.time.iter().enumerate() {
        let (u, x1, v1, x2) = (run.input[i], run.x1[i], run.v1[i], run.x2[i]);
        let _ = writeln!(text, "{t},{u},{x1},{v1},{x2}");
    }
    text
}

/// What a servo did, and what becomes of it.
fn servo_summary(run: &HuntingRun, settled: &Message, noise: Option<Noise>) -> Vec<Message> {
    let end = run.time.last().copied().unwrap_or(0.0);
    let stuck = run.stuck.iter().fold(0.0, |sum, s| sum + (s[1] - s[0]));
    let mut text = vec![msg!(
        "The motor sticks {} in {} s, for {} s in all.",
        counted!(run.stuck.len(), "1 time", "{} times"),
        fixed(end, 6),
        fixed(stuck, 6)
    )];
    if run.cut {
        text.push("It runs away, and the run was stopped there.".into());
    }
    say_settled(&mut text, settled, noise);
    text
}

/// The controller's output, the motor, and what the controller sees behind the play, at the sampling instants.
fn servo_table(run: &HuntingRun, noise: Option<Noise>) -> String {
    let noise = noise_at(noise, &run.time);
    let mut text = String::from("t [s],u [N m],x1 [rad],v1 [rad/s],x2 [rad]\n");
    for (i, t) in run.time.iter().enumerate() {
        let (u, x1, v1, x2) = (
            run.input[i],
            run.position[i],
            run.velocity[i],
            run.measured[i] + noise[i],
        );
        let _ = writeln!(text, "{t},{u},{x1},{v1},{x2}");
    }
    text
}
