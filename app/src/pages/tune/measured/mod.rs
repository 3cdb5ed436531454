//! What does a measured relay test tell? A record, the log of an auto-tuner, or what was read off it.

mod loops;
mod plots;
mod set;
mod settings;
mod side;
mod tables;

use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::tuning::measured::{
    AmplitudeConvention, MeasuredTuning, Readings, TunedGains, Wishes,
};
use hysteron_core::uncertain::{with_error, with_uncertainty};
use hysteron_work::content::Content;
use hysteron_work::enclosed::{Enclosed, PROCESS_02};
use hysteron_work::reading::Reading;
use hysteron_work::tasks::{
    MeasuredReport, MeasuredTask, MeasuredTest, ReadTask, ReadTest, Unclear,
};

use super::draw::{beside, number};
use crate::export::Table;
use crate::files::{Files, Held};
use crate::hook::Targets;
use crate::jobs::{Job, ended};
use crate::language::tr;
use crate::motion;
use crate::page::{Hint, Offer};
use crate::theme;
use crate::widgets::columns::{Form, Wanted};

pub use settings::{From, Settings};
use tables::key;

/// The test that comes with the page.
const BUILT_IN: Enclosed = PROCESS_02;

/// Name of what was pasted.
const PASTED: &str = "pasted text";

/// What a report is of.
#[derive(Clone, PartialEq)]
struct Asked {
    /// Which file, counted as they came; nothing for numbers.
    file: Option<u64>,
    readings: Option<Readings>,
    wishes: Wishes,
}

/// What is open, what was read off, and what is told of it.
pub struct Measured {
    /// Where the test comes from.
    pub from: From,
    pub files: Files,
    file: Option<Held>,
    /// Files that were opened.
    opened: u64,
    readings: Readings,
    wishes: Wishes,
    /// What stands in the field for pasted text.
    pasted: String,
    /// Rule and controller in view.
    chosen: Option<String>,
    asked: Option<Asked>,
    job: Option<Job<MeasuredTask>>,
    shown: Option<Box<MeasuredReport>>,
    message: Option<Message>,
    /// The form for a file that does not say what its columns are.
    form: Option<Form>,
}

impl Default for Measured {
    fn default() -> Self {
        Self {
            from: From::Simulation,
            files: Files::default(),
            file: None,
            opened: 0,
            readings: Readings {
                amplitude: 1.2,
                convention: AmplitudeConvention::Half,
                period: 47.0,
                levels: [0.0, 100.0],
                hysteresis: 0.5,
                half_periods: None,
                unequal: false,
            },
            wishes: Wishes::default(),
            pasted: String::new(),
            chosen: None,
            asked: None,
            job: None,
            shown: None,
            message: None,
            form: None,
        }
    }
}

impl Measured {
    /// Takes what jobs and files have brought.
    pub fn update(&mut self) {
        while let Some(arrival) = self.files.arrived() {
            match arrival.bytes {
                Ok(bytes) => self.open(Held {
                    name: arrival.name,
                    kind: Kind::Process,
                    content: Content::Plain(bytes.into()),
                    reading: arrival.reading,
                }),
                Err(error) => {
                    self.message = Some(msg!(
                        "{}: cannot be read ({})",
                        Message::name(arrival.name),
                        Message::name(error)
                    ));
                }
            }
        }
        match ended(&mut self.job, |_, _| ()) {
            Some(Ok(ReadTest::Told(report))) => self.take_report(report),
            Some(Ok(ReadTest::Unclear(unclear))) => self.ask_columns(unclear),
            Some(Err(text)) => match &mut self.form {
                Some(form) => form.error = Some(text),
                None => self.message = Some(text),
            },
            None => {}
        }
    }

    /// Asks which column of the file is what; where that was asked already, says what is wrong with the answer.
    fn ask_columns(&mut self, unclear: Unclear) {
        let Unclear { reason, columns } = unclear;
        match (&mut self.form, &self.file) {
            (Some(form), _) => form.error = Some(reason),
            (form, Some(file)) => {
                let (name, content) = (file.name.clone(), file.content.clone());
                let new = Form::new(name, content, None, reason, columns);
                // As `tune` on the command line takes it: a drive is a plant as well.
                *form = Some(new.of_kind(Kind::Process));
            }
            _ => self.message = Some(reason),
        }
    }

    /// Does what was asked for in the form.
    fn map(&mut self, wanted: Wanted) {
        match (wanted, &mut self.form) {
            (Wanted::Choose(choice), Some(form)) => form.choice = *choice,
            (Wanted::Open, Some(form)) => {
                form.error = None;
                if let Some(file) = &mut self.file {
                    file.reading = form.reading();
                    self.opened += 1;
                }
            }
            (Wanted::Cancel, _) => {
                (self.form, self.file, self.job) = (None, None, None);
                self.opened += 1;
            }
            (_, None) => {}
        }
    }

    fn take_report(&mut self, report: Box<MeasuredReport>) {
        self.message = None;
        self.form = None;
        if let (From::Record, Some(file)) = (self.from, &self.file) {
            self.files.taken(&file.name, &file.reading);
            self.files.hold(file.clone());
        }
        self.shown = Some(report);
    }

    /// Opens a record or a log.
    fn open(&mut self, file: Held) {
        self.from = From::Record;
        self.file = Some(file);
        self.opened += 1;
        self.message = None;
        self.form = None;
    }

    /// Opens what stands in the field.
    fn open_pasted(&mut self) {
        self.open(Held {
            name: PASTED.to_owned(),
            kind: Kind::Process,
            content: Content::Plain(self.pasted.clone().into_bytes().into()),
            reading: Reading::default(),
        });
    }

    /// Has it told what is set now, where that is not known or asked yet.
    pub fn ask(&mut self, ctx: &egui::Context) {
        if self.job.is_some() {
            return;
        }
        let numbers = (self.from == From::Numbers).then(|| self.readings.clone());
        let file = (self.from == From::Record).then_some(self.opened);
        let asked = Asked {
            file,
            readings: numbers,
            wishes: self.wishes.clone(),
        };
        if self.asked.as_ref() == Some(&asked) {
            return;
        }
        let test = match (self.from, &self.file) {
            (From::Numbers, _) => MeasuredTest::Readings(self.readings.clone()),
            (From::Record, Some(file)) => MeasuredTest::File(Box::new(ReadTask {
                file: file.name.clone(),
                content: file.content.clone(),
                reading: file.reading.clone(),
            })),
            _ => return,
        };
        let another = self.asked.as_ref().map(|a| (a.file, a.readings.is_some()))
            != Some((asked.file, asked.readings.is_some()));
        if another {
            // Another test: what was told is of no use.
            self.shown = None;
            self.chosen = None;
        }
        self.asked = Some(asked);
        let wishes = self.wishes.clone();
        self.job = Some(Job::run(ctx, MeasuredTask { test, wishes }));
    }

    /// Whether there is a plot that can stay in view.
    pub fn has_plot(&self) -> bool {
        self.shown.is_some()
    }

    /// The answer and a plot that stay in view in a narrow window.
    pub fn pinned_ui(&self, ui: &mut egui::Ui, height: f32) {
        if let Some(report) = &self.shown {
            theme::answer_ui(ui, answer(&report.tuning));
            match &report.record {
                Some(record) => plots::record_ui(ui, record, &report.tuning, height),
                None => plots::nyquist_ui(ui, report, height),
            }
        }
    }

    /// All that the test tells; the answer and the plot not again where they are `pinned`.
    pub fn ui(&mut self, ui: &mut egui::Ui, targets: &mut Targets, pinned: bool, height: f32) {
        if let (From::Record, Some(form)) = (self.from, &self.form) {
            for wanted in form.ui(ui, targets) {
                self.map(wanted);
            }
            return;
        }
        if let Some(message) = &self.message {
            theme::tell(&ui.colored_label(ui.visuals().warn_fg_color, tr(message)));
        }
        let Some(report) = &self.shown else {
            let text = match (self.job.is_some(), self.from) {
                (true, _) => "Reading the test ...",
                (_, From::Record) => "Drop a record, or the log of an auto-tuner, on this window.",
                _ => "These numbers say nothing yet.",
            };
            theme::answer_ui(ui, text);
            return;
        };
        if !pinned {
            theme::answer_ui(ui, answer(&report.tuning));
        }
        if self.job.is_some() {
            motion::busy_ui(ui);
        }
        for sentence in report.tuning.sentences() {
            ui.label(tr(sentence));
        }
        let half = (0.4 * height).max(200.0);
        match &report.record {
            Some(_) if pinned => plots::nyquist_ui(ui, report, half),
            Some(record) => beside(
                ui,
                half,
                |ui, height| plots::nyquist_ui(ui, report, height),
                |ui, height| plots::record_ui(ui, record, &report.tuning, height),
            ),
            None if pinned => {}
            None => plots::nyquist_ui(ui, report, half),
        }
        tables::gains_ui(ui, &report.tuning, &mut self.chosen);
        if let Some((gains, Some(responses))) = chosen(report, self.chosen.as_deref()) {
            loops::ui(ui, gains, responses, report.alone.as_ref(), half);
        }
        tables::models_ui(ui, &report.tuning);
    }

    pub fn state(&self) -> serde_json::Value {
        let tuning = self.shown.as_ref().map(|r| &r.tuning);
        serde_json::json!({
            "busy": self.job.is_some(),
            "answer": tuning.map(answer),
            "text": tuning.map(|t| &t.text),
            "ultimate": tuning.and_then(|t| t.ultimate.map(|u| u.gain)),
            "gains": tuning.map(|t| t.gains.len()),
            "file": self.file.as_ref().map(|f| &f.name),
            "message": self.message,
            "mapping": self.form.as_ref().map(Form::hook_state),
        })
    }

    pub fn offer(&self) -> Offer<'_> {
        Offer::new(self.hint(), self.table_names(), || self.tables())
    }

    fn hint(&self) -> Hint {
        match self.from {
            From::Record => Hint {
                sentence: "Is the model all there is to the plant? Drop the file on Compare too."
                    .into(),
                commands: vec![crate::command::Command::Go("compare")],
            },
            _ => Hint::say(
                "The record of the test tells more than its numbers: drop it on this window.",
            ),
        }
    }

    fn table_names(&self) -> Vec<&'static str> {
        let Some(report) = &self.shown else {
            return Vec::new();
        };
        let record = report.record.as_ref().map(|_| "measured test");
        let curve = (!report.nyquist.is_empty()).then_some("Nyquist curve of the model");
        record.into_iter().chain(curve).collect()
    }

    fn tables(&self) -> Vec<Table> {
        let Some(report) = &self.shown else {
            return Vec::new();
        };
        let record = report.record.as_ref().map(|r| {
            Table::new("measured test")
                .with("time [s]", r.time.iter().copied())
                .with("input u", r.input.iter().copied())
                .with("output y", r.output.iter().copied())
        });
        let titles = ["real part", "imaginary part"];
        let curve = (!report.nyquist.is_empty())
            .then(|| Table::curve("Nyquist curve of the model", titles, &report.nyquist));
        record.into_iter().chain(curve).collect()
    }
}

/// What matters most.
fn answer(tuning: &MeasuredTuning) -> Message {
    match (&tuning.ultimate, tuning.stall(), &tuning.point) {
        (_, Some(_), _) => "The test stalled.".into(),
        (Some(u), _, _) => msg!(
            "The ultimate gain is {}, the ultimate period {}.",
            with_error(u.gain, u.std_error_gain, "1"),
            with_error(u.period, u.std_error_period, "s")
        ),
        (None, None, Some(point)) => msg!(
            "No ultimate gain follows: the cycle shows the plant at {} degrees.",
            with_uncertainty(point.phase_deg, point.std_error_phase_deg)
                .unwrap_or_else(|| number(point.phase_deg))
        ),
        (None, None, None) => "There is no cycle, but there may be a model.".into(),
    }
}

/// The gains in view: those that were chosen, else the last of Skogestad's, else the first.
fn chosen<'a>(
    report: &'a MeasuredReport,
    name: Option<&str>,
) -> Option<(
    &'a TunedGains,
    Option<&'a [hysteron_core::tuning::Response; 2]>,
)> {
    let gains = &report.tuning.gains;
    let named = gains.iter().position(|g| Some(key(g).as_str()) == name);
    let simc = || gains.iter().rposition(|g| g.rule == "simc" && g.stable);
    let index = named.or_else(simc).unwrap_or(0);
    let responses = report.loops.get(index).and_then(Option::as_ref);
    gains.get(index).map(|g| (g, responses))
}
