//! `hysteron diagnose` with many files: one line or block for each as it finishes.
//!
//! A file that cannot be diagnosed does not stop the rest. With `--resume OUT` every result is added to
//! OUT at once, as one line of JSON, and files whose result stands there already are skipped: a run that
//! was cut off goes on where it was.

use std::collections::{HashMap, VecDeque};
use std::fs::{File, OpenOptions};
use std::io::{self, IsTerminal as _, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError, mpsc};

use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_work::language::say;
use serde::Serialize;

use crate::arguments::Arguments;
use crate::one::{Report, Setup, one};
use crate::output::{Format, complain, fail, write_error};

/// A file that could not be diagnosed, as a line of JSON.
#[derive(Serialize)]
struct BadFile<'a> {
    schema: u32,
    file: &'a str,
    failed: &'a str,
}

/// Diagnoses all files, some at a time.
pub fn run(setup: &Setup) -> ExitCode {
    match Batch::new(setup.arguments).and_then(|batch| batch.run(setup)) {
        Ok(code) => code,
        Err(Stop::BadInput(line)) => fail(&line, 2),
        Err(Stop::Output(error)) => write_error(&error),
    }
}

/// What ends a batch early.
enum Stop {
    BadInput(Message),
    Output(io::Error),
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// The work, and where the results go.
struct Batch {
    /// Files to do, in the order of the arguments, each once.
    files: Vec<PathBuf>,
    /// Files whose result stands in the record already.
    skipped: usize,
    record: Option<Record>,
    progress: Progress,
}

impl Batch {
    fn new(arguments: &Arguments) -> Result<Self, Stop> {
        let record = arguments.resume.as_deref().map(Record::open).transpose()?;
        let done = |file: &Path| {
            record
                .as_ref()
                .is_some_and(|r| r.is_done(&file.to_string_lossy()))
        };
        let mut files: Vec<PathBuf> = Vec::new();
        let mut seen = std::collections::HashSet::new();
        let mut skipped = 0;
        for file in arguments.files.iter().filter(|f| seen.insert(*f)) {
            if done(file) {
                skipped += 1;
            } else {
                files.push(file.clone());
            }
        }
        let progress = Progress::new(files.len());
        Ok(Self {
            files,
            skipped,
            record,
            progress,
        })
    }

    fn run(mut self, setup: &Setup) -> Result<ExitCode, Stop> {
        let arguments = setup.arguments;
        if self.skipped > 0 {
            let skipped = self.skipped;
            self.progress
                .line(&say(msg!("{} skipped: their results are there", skipped)));
        }
        let workers = arguments
            .jobs
            .map_or_else(available, usize::from)
            .min(self.files.len());
        let queue: Mutex<VecDeque<PathBuf>> = Mutex::new(std::mem::take(&mut self.files).into());
        let mut bad = 0_usize;
        std::thread::scope(|scope| {
            let (sender, results) = mpsc::channel();
            for _ in 0..workers {
                let (queue, sender) = (&queue, sender.clone());
                scope.spawn(move || {
                    while let Some(file) = next(queue) {
                        let report = one(&file, setup, |_, _| {});
                        if sender.send((file, report)).is_err() {
                            return;
                        }
                    }
                });
            }
            drop(sender);
            for (file, report) in results {
                bad += usize::from(report.is_err());
                let kept = self.keep(&file, report, arguments.format);
                if kept.is_err() {
                    // Nobody takes the results any more: let the workers finish what they have in hand.
                    queue.lock().unwrap_or_else(PoisonError::into_inner).clear();
                    return kept;
                }
            }
            Ok(())
        })?;
        self.progress.clear();
        Ok(ExitCode::from(if bad == 0 { 0 } else { 2 }))
    }

    /// Writes one result: to the record, to stdout, and a word on stderr.
    fn keep(
        &mut self,
        file: &Path,
        report: Result<Report, Message>,
        format: Format,
    ) -> Result<(), Stop> {
        let name = file.to_string_lossy();
        let json = match &report {
            Ok(report) => report.json_line(&name),
            Err(line) => serde_json::to_string(&BadFile {
                schema: 1,
                file: &name,
                failed: &line.to_string(),
            }),
        }
        .map_err(|e| {
            Stop::Output(io::Error::other(msg!(
                "{} cannot be written as JSON: {}",
                Message::name(name.to_string()),
                Message::name(e.to_string())
            )))
        })?;
        if let Some(record) = &mut self.record {
            record.add(&name, &json, report.as_ref().err().map(Message::to_string))?;
        }
        let shown = match (&report, format, &self.record) {
            (Ok(report), Format::Text, _) => report.text(&name) + "\n",
            (Err(_), Format::Text, _) | (_, Format::Json, Some(_)) => String::new(),
            (_, Format::Json, None) => json + "\n",
        };
        let mut stdout = io::stdout().lock();
        stdout.write_all(shown.as_bytes())?;
        stdout.flush()?;
        match report {
            Ok(report) => self
                .progress
                .finished(&format!("{name}: {}", report.summary())),
            Err(line) => self.progress.failed(&say(&line)),
        }
        Ok(())
    }
}

fn next(queue: &Mutex<VecDeque<PathBuf>>) -> Option<PathBuf> {
    queue
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .pop_front()
}

fn available() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// The file of results that a run adds to and a later run resumes from.
struct Record {
    file: File,
    /// By file: `None` where it is diagnosed, else why it could not be.
    seen: HashMap<String, Option<String>>,
}

impl Record {
    /// Opens or makes it. A last line that was cut off while it was written is taken away.
    fn open(path: &Path) -> Result<Self, Stop> {
        let shown = || Message::name(path.display().to_string());
        let cause = |e: io::Error| Message::name(e.to_string());
        let mut file = OpenOptions::new()
            .read(true)
            .append(true)
            .create(true)
            .open(path)
            .map_err(|e| Stop::BadInput(msg!("{} cannot be opened: {}", shown(), cause(e))))?;
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(0))
            .and_then(|_| file.read_to_end(&mut bytes))
            .map_err(|e| Stop::BadInput(msg!("{} cannot be read: {}", shown(), cause(e))))?;
        let whole = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        let (lines, rest) = bytes.split_at(whole);
        let mut seen = HashMap::new();
        for (i, line) in lines.split(|b| *b == b'\n').enumerate() {
            if line.trim_ascii().is_empty() {
                continue;
            }
            let (file, failed) = understand(line).ok_or_else(|| {
                Stop::BadInput(msg!(
                    "{}, line {}: not a result of hysteron diagnose; --resume needs a new file or one that it wrote",
                    shown(),
                    i + 1
                ))
            })?;
            seen.insert(file, failed);
        }
        if let Some((name, failed)) = understand(rest) {
            seen.insert(name, failed);
            file.write_all(b"\n")?;
        } else if rest.is_empty() || rest.starts_with(b"{\"") {
            file.set_len(whole as u64)?;
        } else {
            return Err(Stop::BadInput(msg!(
                "{}: not a result of hysteron diagnose; --resume needs a new file or one that it wrote",
                shown()
            )));
        }
        Ok(Self { file, seen })
    }

    fn is_done(&self, name: &str) -> bool {
        matches!(self.seen.get(name), Some(None))
    }

    /// Adds a line in one write; a failure that stands there already is not said again.
    fn add(&mut self, name: &str, json: &str, failed: Option<String>) -> io::Result<()> {
        if failed.is_some() && self.seen.get(name).and_then(Option::as_ref) == failed.as_ref() {
            return Ok(());
        }
        self.file.write_all(format!("{json}\n").as_bytes())?;
        self.seen.insert(name.to_owned(), failed);
        Ok(())
    }
}

/// File and, where it could not be diagnosed, the reason.
fn understand(line: &[u8]) -> Option<(String, Option<String>)> {
    let value: serde_json::Value = serde_json::from_slice(line).ok()?;
    let file = value.get("file")?.as_str()?.to_owned();
    match value.get("failed") {
        Some(reason) => Some((file, Some(reason.as_str()?.to_owned()))),
        None => value.get("verdict").map(|_| (file, None)),
    }
}

/// Words on stderr: a line for each file in a log, one line written over again on a terminal.
struct Progress {
    terminal: bool,
    done: usize,
    of: usize,
}

impl Progress {
    fn new(of: usize) -> Self {
        Self {
            terminal: io::stderr().is_terminal(),
            done: 0,
            of,
        }
    }

    fn finished(&mut self, text: &str) {
        self.done += 1;
        let text = format!("{}: {text}", self.count());
        if self.terminal {
            let line: String = text.chars().filter(|c| !c.is_control()).take(79).collect();
            // Progress that cannot be shown is no reason to stop.
            let _ = write!(io::stderr(), "\r\x1b[K{line}");
        } else {
            self.line(&text);
        }
    }

    fn count(&self) -> String {
        format!("{} {} {}", self.done, say("of"), self.of)
    }

    /// A failure stays on the screen.
    fn failed(&mut self, text: &str) {
        self.done += 1;
        self.line(&format!("{}: {text}", self.count()));
    }

    fn line(&self, text: &str) {
        self.clear();
        complain(text);
    }

    fn clear(&self) {
        if self.terminal {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}
