//! What is set on the page: the measurement by its name, and what was added to the model.

use hysteron_core::effect::{self, EffectId};
use hysteron_core::mystery::Mystery;
use hysteron_core::user_model::UserModel;
use serde::{Deserialize, Serialize};

use super::{BUILT_IN, Command, Compare, Look};

/// Effects that a link may add.
const MOST_EFFECTS: usize = 12;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Settings {
    /// Name of the measurement that is open, unless it is the next.
    file: Option<String>,
    /// The measurement itself: a mystery that came in a link.
    mystery: Option<String>,
    /// Name of the file with the user's model.
    model: Option<String>,
    /// Effects of the user's own, as the command line takes them.
    own: Vec<String>,
    /// Effects on top of the baseline, in the order in which they were added.
    effects: Vec<String>,
    /// The finding that is shaded.
    finding: usize,
    /// What the plots show, and whether beside the step before.
    look: Look,
    before: bool,
    /// The effect whose fingerprint is shown, if someone chose one.
    fingerprint: Option<String>,
}

/// Whether a measurement of this name comes with the page.
pub fn is_built_in(name: &str) -> bool {
    BUILT_IN.iter().any(|b| b.file.id == name)
}

impl Compare {
    pub(super) fn set_to(&self) -> Settings {
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
            fingerprint: self.fingerprint.map(|e| e.to_string()),
        }
    }

    pub(super) fn take(&mut self, ctx: &egui::Context, settings: &Settings) -> Result<(), String> {
        let present = self.set_to();
        let same_file = settings.file == present.file;
        let built_in = match &settings.file {
            Some(name) if !same_file => {
                let found = BUILT_IN.iter().find(|b| b.file.id == name);
                Some(found.ok_or_else(|| crate::document::not_enclosed(name))?)
            }
            _ => None,
        };
        if settings.file.is_some() && settings.mystery.is_some() {
            return Err("A link may open a file or a mystery, not both.".to_owned());
        }
        let mystery = match &settings.mystery {
            Some(text) if settings.mystery != present.mystery => {
                let read = Mystery::from_link(text).map_err(|e| e.to_string())?;
                Some((read, text))
            }
            _ => None,
        };
        if let Some(name) = &settings.model
            && settings.model != present.model
        {
            return Err(crate::document::not_enclosed(name));
        }
        if settings.effects.len() > MOST_EFFECTS || settings.own.len() > MOST_EFFECTS {
            return Err(format!("A link may add {MOST_EFFECTS} effects."));
        }
        if settings.file.is_none() && settings.mystery.is_none() {
            if self.measurement.is_some() {
                self.carry_out(ctx, Command::Close);
            }
            return Ok(());
        }
        if let Some(built_in) = built_in {
            self.carry_out(ctx, Command::Close);
            self.open(ctx, built_in.file.id, &built_in.file.csv());
        }
        if let Some((mystery, text)) = &mystery {
            self.carry_out(ctx, Command::Close);
            self.open_mystery(ctx, mystery, text);
        }
        if settings.model != present.model {
            self.forget_model();
            self.restart(ctx);
        }
        self.take_own(&settings.own)?;
        let effects = settings.effects.iter().map(|id| self.effect(id));
        let effects: Vec<EffectId> = effects.collect::<Result<_, _>>()?;
        let fingerprint = settings.fingerprint.as_ref().map(|id| self.effect(id));
        let fingerprint = fingerprint.transpose()?;
        if effects != self.effects {
            self.go_to(ctx, effects);
        }
        self.finding = settings.finding;
        self.fingerprint = fingerprint;
        self.look = match settings.look {
            Look::Reveal if self.sealed.is_none() => Look::default(),
            look => look,
        };
        self.before = settings.before;
        Ok(())
    }

    /// Makes the user's own effects these.
    fn take_own(&mut self, lines: &[String]) -> Result<(), String> {
        if self.own == lines {
            return Ok(());
        }
        let Some(measurement) = &self.measurement else {
            return Ok(());
        };
        if let Some(name) = &self.model_file {
            return Err(crate::document::not_enclosed(name));
        }
        let mut model = UserModel::blank(measurement.kind);
        for line in lines {
            model.add_candidate(line)?;
        }
        // A formula may have changed under its name.
        self.reports
            .retain(|effects, _| effects.iter().all(|e| effect::find(*e).is_some()));
        self.model = (!lines.is_empty()).then_some(model);
        self.own = lines.to_vec();
        Ok(())
    }

    /// An effect of the library, or of the user's own.
    fn effect(&self, id: &str) -> Result<EffectId, String> {
        let own = self.model.iter().flat_map(|m| &m.candidates).map(|c| c.id);
        let library = effect::registry().iter().map(|e| e.id());
        library
            .chain(own)
            .find(|e| e.as_str() == id)
            .ok_or_else(|| "This link adds an effect that does not exist.".to_owned())
    }
}
