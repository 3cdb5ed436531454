//! What comes in: measurements, models, effects of the user's own.

use std::sync::Arc;

use hysteron_core::measurement::{Measurement, import};
use hysteron_core::mystery::{Mystery, seal_of};
use hysteron_core::user_model::UserModel;

use super::mapping::Form;
use super::reveal::Sealed;
use super::{Compare, Look, export, own};
use crate::jobs::Job;
use crate::reading::Reading;

impl Compare {
    /// Opens a measurement, or a model (TOML), from the bytes of a file; a bad one leaves everything as it was.
    pub fn open(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        self.open_as(ctx, name, bytes, &Reading::default());
    }

    /// The same of a file that was opened before, with what it does not say itself.
    pub(super) fn open_as(
        &mut self,
        ctx: &egui::Context,
        name: &str,
        bytes: &[u8],
        reading: &Reading,
    ) {
        if name.to_ascii_lowercase().ends_with(".toml") {
            return self.open_model(ctx, name, bytes);
        }
        let options = reading.options().unwrap_or_default();
        match import(name, bytes, &options) {
            Ok(measurement) => self.take_measurement(ctx, measurement, bytes, reading),
            Err(error) => {
                let origin = self.files.origin(name);
                match Form::new(bytes, &error, origin) {
                    Some(form) => self.form = Some(form),
                    None => self.refuse(error.to_string()),
                }
            }
        }
    }

    /// Says why a file is not taken, where it is seen.
    pub(super) fn refuse(&mut self, sentence: String) {
        let place = match &mut self.form {
            Some(form) => &mut form.error,
            None => &mut self.message,
        };
        *place = Some(sentence);
    }

    /// Opens the file of the form with what was chosen in it, or says there why it cannot be.
    pub(super) fn open_mapped(&mut self, ctx: &egui::Context) {
        let Some(mut form) = self.form.take() else {
            return;
        };
        let reading = form.choice.reading(&form.columns);
        let read = reading.options().and_then(|options| {
            import(&form.file, &form.bytes, &options).map_err(|e| e.to_string())
        });
        match read {
            Ok(measurement) => {
                self.files.comes_from(form.origin);
                self.take_measurement(ctx, measurement, &form.bytes, &reading);
            }
            Err(error) => {
                form.error = Some(error);
                self.form = Some(form);
            }
        }
    }

    fn take_measurement(
        &mut self,
        ctx: &egui::Context,
        measurement: Measurement,
        bytes: &[u8],
        reading: &Reading,
    ) {
        self.form = None;
        self.files.taken(&measurement.name, reading);
        self.reading = reading.clone();
        self.message = measurement.warnings.first().cloned();
        if self
            .model
            .as_ref()
            .is_some_and(|m| m.kind != measurement.kind)
        {
            self.forget_model();
        }
        self.measurement = Some(Arc::new(measurement));
        self.source = export::Source::of(bytes);
        self.sealed = seal_of(bytes).map(Sealed::new);
        if self.look == Look::Reveal {
            self.look = Look::default();
        }
        self.restart(ctx);
    }

    /// Opens a mystery that came in a link.
    pub(super) fn open_mystery(&mut self, ctx: &egui::Context, mystery: &Mystery, link: &str) {
        self.open(ctx, &mystery.name(), mystery.csv().as_bytes());
        if let Some(sealed) = &mut self.sealed {
            sealed.link = Some(link.to_owned());
        }
    }

    /// Takes a model and begins anew with it.
    fn open_model(&mut self, ctx: &egui::Context, name: &str, bytes: &[u8]) {
        let read = str::from_utf8(bytes)
            .map_err(|_| "a model must be UTF-8 text".to_owned())
            .and_then(|text| UserModel::from_toml(text).map_err(|e| e.to_string()));
        match (read, &self.measurement) {
            (Err(error), _) => self.refuse(format!("{name}, {error}")),
            (Ok(model), Some(measurement)) if model.kind != measurement.kind => {
                self.refuse(format!(
                    "{name} is the model of a {}, but {} is the measurement of a {}.",
                    model.kind.name(),
                    measurement.name,
                    measurement.kind.name()
                ));
            }
            (Ok(model), _) => {
                self.files.taken(name, &Reading::default());
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
    pub(super) fn add_own(&mut self, ctx: &egui::Context, typed: &own::Typed) {
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
        self.effects.clear();
        self.reports.clear();
        self.shown = None;
        self.undone.clear();
        self.lost.clear();
        self.limits = None;
        self.search = None;
        self.finding = 0;
        self.start(ctx);
    }

    /// Shows the step of the present effects: at once if it is known, else by a job.
    pub(super) fn start(&mut self, ctx: &egui::Context) {
        self.job = None;
        let earlier = self.earlier.take();
        if self.reports.contains_key(&self.effects) {
            self.shown = Some(self.effects.clone());
        } else if let Some(measurement) = &self.measurement {
            self.progress = (0.0, "Starting".to_owned());
            // It may be on its way already.
            let begun = earlier.filter(|(effects, _)| *effects == self.effects);
            self.job = Some(begun.map_or_else(
                || Job::start(ctx, measurement, &self.effects, self.model.as_ref()),
                |(_, job)| job,
            ));
        }
    }
}
