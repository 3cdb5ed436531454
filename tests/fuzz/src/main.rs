//! Gives every reader of Hysteron inputs that were made wrong, and fails on a panic, on one that takes longer than 2 s,
//! and on more than 1 GB of memory: `cargo xtask fuzz --minutes 5`. The same seed makes the same inputs.

mod doors;
mod inputs;

use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::Mutex;
use std::thread;
use std::time::{Duration, Instant};

use doors::Door;
use inputs::Inputs;

/// Longest that an input may take.
const LONGEST: Duration = Duration::from_secs(2);

/// Most memory that the whole program may have had, KiB.
const MOST_MEMORY: u64 = 1 << 20;

/// How often it is looked whether an input hangs.
const LOOK: Duration = Duration::from_millis(50);

/// What is read at present.
struct Present {
    count: u64,
    door: Door,
    bytes: Vec<u8>,
    since: Instant,
}

/// How long it goes on, and with which inputs.
struct Arguments {
    seed: u64,
    time: Duration,
    inputs: u64,
}

fn main() -> ExitCode {
    let arguments = match arguments() {
        Ok(arguments) => arguments,
        Err(error) => {
            eprintln!("fuzz: {error}");
            return ExitCode::from(2);
        }
    };
    let begin = Instant::now();
    let present: Mutex<Option<Present>> = Mutex::new(None);
    let result = thread::scope(|scope| {
        let reader = scope.spawn(|| read_all(&arguments, begin, &present));
        while !reader.is_finished() {
            thread::sleep(LOOK);
            if let Some(wrong) = watch(&present) {
                // A reader that hangs cannot be stopped otherwise.
                eprintln!("{wrong}");
                std::process::exit(1);
            }
        }
        reader
            .join()
            .unwrap_or_else(|_| Err("the program itself failed".to_owned()))
    });
    let seconds = begin.elapsed().as_secs_f64();
    match result {
        Ok(counts) => {
            let all: u64 = counts.iter().map(|(_, count)| count).sum();
            let each = counts
                .iter()
                .fold(String::new(), |mut text, (door, count)| {
                    // Writing into a string cannot fail.
                    let _ = write!(text, ", {count} {}", door.name());
                    text
                });
            println!(
                "{all} inputs in {seconds:.0} s, {:.0} a second; no panic, none over 2 s, {} MB at most{each}",
                all as f64 / seconds,
                peak_memory() >> 10,
            );
            ExitCode::SUCCESS
        }
        Err(wrong) => {
            eprintln!("{wrong}");
            ExitCode::FAILURE
        }
    }
}

/// `--minutes N`, `--inputs N` and `--seed N`: whichever of the first two comes first ends it.
fn arguments() -> Result<Arguments, String> {
    let mut given = Arguments {
        seed: 1,
        time: Duration::from_mins(1),
        inputs: u64::MAX,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let number = words.next().and_then(|n| n.parse::<u64>().ok());
        let number = number.ok_or_else(|| format!("{word} needs a whole number"))?;
        match word.as_str() {
            "--seed" => given.seed = number,
            "--minutes" => given.time = Duration::from_mins(number),
            "--inputs" => given.inputs = number,
            _ => {
                return Err(format!(
                    "'{word}' is not an option; expected --minutes, --inputs or --seed"
                ));
            }
        }
    }
    Ok(given)
}

/// Reads inputs until the time is over; how many of each kind there were.
fn read_all(
    arguments: &Arguments,
    begin: Instant,
    present: &Mutex<Option<Present>>,
) -> Result<Vec<(Door, u64)>, String> {
    let mut inputs = Inputs::new(arguments.seed);
    let mut counts: Vec<(Door, u64)> = Door::ALL.map(|door| (door, 0)).to_vec();
    let mut count = 0;
    while begin.elapsed() < arguments.time && count < arguments.inputs {
        let (door, bytes) = inputs.next();
        set(
            present,
            Some(Present {
                count,
                door,
                bytes: bytes.clone(),
                since: Instant::now(),
            }),
        );
        let read = catch_unwind(AssertUnwindSafe(|| doors::read(door, &bytes)));
        set(present, None);
        let wrong = match read {
            Err(_) => Some("panicked".to_owned()),
            Ok(Some(said)) => Some(format!(
                "was refused in words that are no sentence: {said:?}"
            )),
            Ok(None) => None,
        };
        if let Some(wrong) = wrong {
            return Err(failure(count, door, &bytes, &wrong));
        }
        if let Some((_, counted)) = counts.iter_mut().find(|(d, _)| *d == door) {
            *counted += 1;
        }
        count += 1;
    }
    Ok(counts)
}

fn set(present: &Mutex<Option<Present>>, value: Option<Present>) {
    // A reader that panicked has not held it.
    if let Ok(mut present) = present.lock() {
        *present = value;
    }
}

/// What is wrong with what is read at present, if anything is.
fn watch(present: &Mutex<Option<Present>>) -> Option<String> {
    let present = present.lock().ok()?;
    let present = present.as_ref()?;
    if present.since.elapsed() > LONGEST {
        return Some(failure(
            present.count,
            present.door,
            &present.bytes,
            "took more than 2 s",
        ));
    }
    let memory = peak_memory();
    (memory > MOST_MEMORY).then(|| {
        failure(
            present.count,
            present.door,
            &present.bytes,
            &format!("took {} MB", memory >> 10),
        )
    })
}

/// One line about an input, which is kept in a file.
fn failure(count: u64, door: Door, bytes: &[u8], wrong: &str) -> String {
    let file = std::env::temp_dir().join(format!(
        "hysteron-fuzz-{count}-{}",
        door.name().replace(' ', "-")
    ));
    let kept = match std::fs::write(&file, bytes) {
        Ok(()) => format!("kept as {}", file.display()),
        Err(e) => format!("could not be kept: {e}"),
    };
    format!(
        "input {count} ({}, {} bytes) {wrong}; {kept}",
        door.name(),
        bytes.len()
    )
}

/// The most memory that the program has had, KiB; 0 where the system does not say it.
fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|l| l.trim().strip_suffix("kB")?.trim().parse().ok())
        .unwrap_or(0)
}
