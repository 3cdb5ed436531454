//! How the page gives what is set on it, and takes it: the measurement by its name, and what was added to the model.

use hysteron_core::effect::{self, EffectId};
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;
use hysteron_core::mystery::Mystery;
use hysteron_core::user_model::UserModel;
use hysteron_work::content::Content;
use hysteron_work::reading::Reading;

use super::awaited::{Awaited, Meant, Settings, effect_of};
use super::built_in::BUILT_IN;
use super::look::Look;
use super::opening::Opening;
use super::state::Compare;
use crate::desk::Desk;
use crate::files::Held;
use crate::link::not_enclosed;
use crate::page::Settable;

/// Effects that a link may add.
const MOST_EFFECTS: usize = 12;

impl Settable for Compare {
    type Settings = Settings;

    fn set_to(&self) -> Settings {
        if let Some(awaited) = self.opening.as_ref().and_then(|o| o.then.as_ref()) {
            return awaited.settings.clone();
        }
        let mystery = self.sealed.as_ref().and_then(|s| s.link.clone());
        let file = self.measurement.as_ref().filter(|_| mystery.is_none());
        Settings {
            file: file.map(|m| m.name.clone()),
            mystery,
            model: self.model_file.clone(),
            own: self.own.clone(),
            effects: self.effects.iter().map(ToString::to_string).collect(),
            finding: self.finding,
            look: self.look,
            before: self.before,
            guess: (self.guess_first != self.sealed.is_some()).then_some(self.guess_first),
            fingerprint: self.fingerprint.map(|e| e.to_string()),
        }
    }

    fn take(
        &mut self,
        ctx: &egui::Context,
        settings: Settings,
        _desk: &Desk,
    ) -> Result<(), Message> {
        let (settings, present) = (&settings, self.set_to());
        let other = self.other_file(settings, &present)?;
        if settings.effects.len() > MOST_EFFECTS || settings.own.len() > MOST_EFFECTS {
            return Err(msg!("A link may add at most {} effects.", MOST_EFFECTS));
        }
        if settings.file.is_none() && settings.mystery.is_none() {
            if let Some(name) = &settings.model {
                self.held_model(name)?;
            }
            if self.measurement.is_some() || self.opening.is_some() {
                self.close();
            }
            return Ok(());
        }
        if let Some(file) = other {
            let then = self.awaited(settings, file.kind)?;
            self.close();
            self.opening = Some(Opening::again(ctx, file).with(then));
            return Ok(());
        }
        if let Some(kind) = self
            .opening
            .as_ref()
            .and_then(|o| Some(o.then.as_ref()?.kind))
        {
            let then = self.awaited(settings, kind)?;
            if let Some(opening) = &mut self.opening {
                opening.then = Some(then);
            }
            return Ok(());
        }
        let other_model = settings.model != present.model;
        let model = match &self.measurement {
            Some(measurement) if other_model || settings.own != self.own => {
                self.model_of(settings, measurement.kind)?
            }
            _ => self.model.clone(),
        };
        let meant = settings.meant(model)?;
        if other_model {
            self.forget_model();
            self.model.clone_from(&meant.model);
            self.restart(ctx);
        }
        self.adopt(ctx, settings, meant);
        Ok(())
    }
}

impl Compare {
    /// The measurement of `settings`, if it is another than is open at `present`.
    fn other_file(&self, settings: &Settings, present: &Settings) -> Result<Option<Held>, Message> {
        match (&settings.file, &settings.mystery) {
            (Some(_), Some(_)) => Err("A link may open a file or a mystery, not both.".into()),
            (Some(name), None) if settings.file != present.file => {
                let built_in = BUILT_IN.iter().find(|b| b.file.id == name);
                let file = built_in.map(|b| Held::from(&b.file));
                let file = file.or_else(|| self.files.held(name).cloned());
                let file = file.ok_or_else(|| not_enclosed(name))?;
                Ok(Some(file))
            }
            (None, Some(text)) if settings.mystery != present.mystery => {
                let mystery = Mystery::from_link(text).map_err(|e| e.to_string())?;
                Ok(Some(Held {
                    name: mystery.name(),
                    kind: mystery.kind,
                    content: Content::Mystery(Box::new(mystery)),
                    reading: Reading::default(),
                }))
            }
            _ => Ok(None),
        }
    }

    /// What is set as soon as a measurement of this kind is open.
    fn awaited(&self, settings: &Settings, kind: Kind) -> Result<Awaited, Message> {
        Ok(Awaited {
            meant: settings.meant(self.model_of(settings, kind)?)?,
            settings: settings.clone(),
            kind,
        })
    }

    /// The user's model as in `settings`: that of a file, and the effects of their own.
    fn model_of(&self, settings: &Settings, kind: Kind) -> Result<Option<UserModel>, Message> {
        let mut model = match &settings.model {
            Some(name) => {
                let model = self.held_model(name)?.clone();
                let fits = (model.kind == kind).then_some(model);
                fits.ok_or_else(|| not_enclosed(name))?
            }
            None if settings.own.is_empty() => return Ok(None),
            None => UserModel::blank(kind),
        };
        for line in &settings.own {
            model.add_candidate(line)?;
        }
        Ok(Some(model))
    }

    fn held_model(&self, name: &str) -> Result<&UserModel, Message> {
        let model = self.files.held_model(name);
        model.ok_or_else(|| not_enclosed(name))
    }

    /// Sets what was to be set as soon as the measurement is open, which it is now.
    pub(super) fn take_awaited(&mut self, ctx: &egui::Context, awaited: Awaited) {
        let Awaited {
            settings, meant, ..
        } = awaited;
        if let Some(sealed) = &mut self.sealed {
            sealed.link.clone_from(&settings.mystery);
        }
        self.adopt(ctx, &settings, meant);
        if self.job.is_none() {
            self.start(ctx);
        }
    }

    fn adopt(&mut self, ctx: &egui::Context, settings: &Settings, meant: Meant) {
        if self.own != settings.own {
            // A formula may have changed under its name.
            self.reports
                .retain(|effects, _| effects.iter().all(|e| effect::find(*e).is_some()));
            self.own.clone_from(&settings.own);
            self.unknown.forget_own();
        }
        self.model = meant.model;
        self.model_file.clone_from(&settings.model);
        if meant.effects != self.effects {
            self.go_to(ctx, meant.effects);
        }
        // An effect of the user's own that is not there any more cannot come again, nor what came after it.
        let model = self.model.as_ref();
        let gone = |e: &EffectId| effect_of(e.as_str(), model).is_err();
        let there = self.undone.iter().position(gone);
        self.undone.truncate(there.unwrap_or(self.undone.len()));
        self.finding = settings.finding;
        self.fingerprint = meant.fingerprint;
        self.look = match settings.look {
            Look::Reveal if self.sealed.is_none() => Look::default(),
            look => look,
        };
        self.before = settings.before;
        self.guess_first = settings.guess.unwrap_or(self.sealed.is_some());
    }
}
