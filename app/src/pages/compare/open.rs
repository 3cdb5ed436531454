//! What comes in: measurements, models, effects of the user's own.

use std::sync::Arc;

use hysteron_core::measurement::FoundColumn;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::user_model::UserModel;

use super::formula::Typed;
use super::hints::Guess;
use super::look::Look;
use super::opening::Opening;
use super::sealed::Sealed;
use super::state::Compare;
use super::unknown::Unknown;
use crate::files::Held;
use crate::jobs::Job;
use crate::widgets::columns::Form;
use hysteron_work::content::Content;
use hysteron_work::reading::Reading;
use hysteron_work::tasks::{Opened, ReadReport};

impl Compare {
    /// Opens a measurement, or a model (TOML), from the bytes of a file; a bad one leaves everything as it was.
    pub(super) fn open_as(
        &mut self,
        ctx: &egui::Context,
        name: &str,
        bytes: Vec<u8>,
        reading: Reading,
    ) {
        if name.to_ascii_lowercase().ends_with(".toml") {
            return self.open_model(ctx, name, &bytes);
        }
        let content = Content::Plain(bytes.into());
        self.opening = Some(Opening {
            origin: self.files.origin(name),
            ..Opening::read_as(ctx, name, content, reading)
        });
    }

    /// Takes what was read of a file.
    pub(super) fn take_opened(&mut self, ctx: &egui::Context) {
        let Some(mut opening) = self.opening.take() else {
            return;
        };
        match opening.job.end(|_, _| ()) {
            Some(Ok(ReadReport::Measurement(opened))) => {
                self.take_measurement(ctx, *opened, opening);
            }
            Some(Ok(ReadReport::Unclear(unclear))) => {
                self.ask(opening, unclear.reason, unclear.columns);
            }
            Some(Err(error)) => self.refuse(error),
            None => self.opening = Some(opening),
        }
    }

    /// Asks which column of a file is what, unless that is what was asked.
    fn ask(&mut self, opening: Opening, reason: Message, columns: Vec<FoundColumn>) {
        match &mut self.form {
            Some(form) if opening.from_form => form.error = Some(reason),
            form => {
                let Opening {
                    file,
                    content,
                    origin,
                    ..
                } = opening;
                *form = Some(Form::new(file, content, origin, reason, columns));
            }
        }
    }

    /// Says why a file is not taken, where it is seen.
    pub(super) fn refuse(&mut self, sentence: Message) {
        let place = match &mut self.form {
            Some(form) => &mut form.error,
            None => &mut self.message,
        };
        *place = Some(sentence);
    }

    /// Opens the file of the form with what was chosen in it.
    pub(super) fn open_mapped(&mut self, ctx: &egui::Context) {
        if let Some(form) = &mut self.form {
            form.error = None;
            let reading = form.reading();
            self.opening = Some(Opening {
                origin: form.origin.clone(),
                from_form: true,
                ..Opening::read_as(ctx, &form.file, form.content.clone(), reading)
            });
        }
    }

    fn take_measurement(&mut self, ctx: &egui::Context, opened: Opened, opening: Opening) {
        let Opened {
            measurement,
            source,
            seal,
        } = opened;
        let Opening {
            job,
            origin,
            content,
            reading,
            then,
            ..
        } = opening;
        // On the web its worker goes on with the diagnosis.
        drop(job);
        self.form = None;
        self.files.comes_from(origin);
        self.files.taken(&measurement.name, &reading);
        self.files.hold(Held {
            name: measurement.name.clone(),
            kind: measurement.kind,
            content,
            reading: reading.clone(),
        });
        self.reading = reading;
        self.message = measurement.warnings.first().cloned();
        if self
            .model
            .as_ref()
            .is_some_and(|m| m.kind != measurement.kind)
        {
            self.forget_model();
        }
        self.measurement = Some(Arc::new(measurement));
        self.parts.fresh = true;
        self.source = source;
        // A mystery is to be solved, not to be told; what follows it is as it was wished before.
        let wished = self.guess_first && self.sealed.is_none();
        self.sealed = seal.map(Sealed::new);
        self.guess_first = wished || self.sealed.is_some();
        if self.look == Look::Reveal {
            self.look = Look::default();
        }
        self.forget_steps();
        match then {
            Some(awaited) => self.take_awaited(ctx, awaited),
            None => self.start(ctx),
        }
    }

    /// Takes a model and begins anew with it.
    fn open_model(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        let read = str::from_utf8(bytes)
            .map_err(|_| "a model must be UTF-8 text".into())
            .and_then(|text| UserModel::from_toml(text).map_err(Message::from));
        match (read, &self.measurement) {
            (Err(error), _) => self.refuse(msg!("{}, {}", Message::name(name), error)),
            (Ok(model), Some(measurement)) if model.kind != measurement.kind => {
                self.refuse(msg!(
                    "{} is the model of a {}, but {} is the measurement of a {}.",
                    Message::name(name),
                    model.kind.name(),
                    Message::name(&measurement.name),
                    measurement.kind.name()
                ));
            }
            (Ok(_), None) => self.refuse(msg!(
                "{} is a model, which goes with a measurement: open the measurement first.",
                Message::name(name)
            )),
            (Ok(model), Some(_)) => {
                self.files.taken(name, &Reading::default());
                self.files.hold_model(name, &model);
                self.message = None;
                self.forget_model();
                self.model = Some(model);
                self.model_file = Some(name.to_owned());
                self.restart(ctx);
            }
        }
    }

    pub(super) fn forget_model(&mut self) {
        self.model = None;
        self.model_file = None;
        self.own.clear();
    }

    /// Adds an effect of the user's own to the model.
    pub(super) fn add_own(&mut self, ctx: &egui::Context, typed: &Typed) {
        let Some(measurement) = &self.measurement else {
            return;
        };
        let blank = || UserModel::blank(measurement.kind);
        let mut model = self.model.clone().unwrap_or_else(blank);
        match model.add_candidate(&typed.line()) {
            Ok(()) => {
                self.message = None;
                self.effects.extend(model.candidates.last().map(|c| c.id));
                self.undone.clear();
                self.model = Some(model);
                self.own.push(typed.line());
                self.start(ctx);
            }
            Err(error) => self.message = Some(error),
        }
    }

    /// Begins with the first model again.
    pub(super) fn restart(&mut self, ctx: &egui::Context) {
        self.forget_steps();
        self.start(ctx);
    }

    fn forget_steps(&mut self) {
        self.effects.clear();
        self.reports.clear();
        self.shown = None;
        self.undone.clear();
        self.lost.clear();
        self.limits = None;
        self.search = None;
        self.unknown = Unknown::default();
        self.hand = None;
        self.guess = Guess::default();
        self.finding = 0;
    }

    /// Shows the step of the present effects: at once if it is known, else by a job.
    pub(super) fn start(&mut self, ctx: &egui::Context) {
        self.job = None;
        self.unknown.follow(&self.effects);
        let earlier = self.earlier.take();
        if self.reports.contains_key(&self.effects) {
            self.shown = Some(self.effects.clone());
            self.follow_at_once();
        } else if let Some(measurement) = &self.measurement {
            self.progress = (0.0, "Starting".into());
            // It may be on its way already.
            let begun = earlier.filter(|(effects, _)| *effects == self.effects);
            self.job = Some(begun.map_or_else(
                || Job::start(ctx, measurement, &self.effects, self.model.as_ref()),
                |(_, job)| job,
            ));
        }
    }
}
