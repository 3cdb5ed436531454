//! The user's own effect as a formula.

use hysteron_core::effect::{EffectId, Formula};
use hysteron_core::measurement::Kind;

use super::{Command, Compare};
use crate::hook::Targets;
use crate::language::tr;
use crate::theme;

/// What is typed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Typed {
    /// What it is typed for: a formula of a drive is none of a process.
    kind: Kind,
    pub name: String,
    pub formula: String,
}

impl Typed {
    /// What stands there before anything is typed.
    fn example(kind: Kind) -> Self {
        let formula = match kind {
            Kind::Drive => "-a*exp(-((x-b)/c)^2)",
            Kind::Process => "-a*exp(-((y-b)/c)^2)",
        };
        Self {
            kind,
            name: "bump".to_owned(),
            formula: formula.to_owned(),
        }
    }

    /// As the command line takes it.
    pub fn line(&self) -> String {
        format!("{}: {}", self.id(), self.formula.trim())
    }

    /// The name as files and links have it: in small letters, with `_` between words.
    fn id(&self) -> String {
        let words: Vec<&str> = self
            .name
            .split([' ', '-'])
            .filter(|w| !w.is_empty())
            .collect();
        words.join("_").to_lowercase()
    }

    /// Names of the parameters, or what is wrong.
    fn check(&self) -> Result<Vec<String>, String> {
        if EffectId::own(&self.id()).is_none() {
            return Err(format!("name: {}", EffectId::OWN_NAMES));
        }
        let formula = Formula {
            name: self.id(),
            text: self.formula.trim().to_owned(),
        };
        formula.parameters(self.kind).map_err(|e| e.to_string())
    }
}

pub(super) fn ui(
    page: &Compare,
    ui: &mut egui::Ui,
    targets: &mut Targets,
    commands: &mut Vec<Command>,
) {
    let Some(measurement) = &page.measurement else {
        return;
    };
    let kind = measurement.kind;
    let before = page.typed.clone().filter(|t| t.kind == kind);
    let before = before.unwrap_or_else(|| Typed::example(kind));
    let mut typed = before.clone();
    egui::CollapsingHeader::new(tr("An effect of your own")).show(ui, |ui| {
        let (variables, symbol) = match kind {
            Kind::Drive => (
                "A force as a formula of x, v, u, t; every other name is fitted.",
                "F =",
            ),
            Kind::Process => (
                "An input as a formula of y, u, t; every other name is fitted.",
                "Input =",
            ),
        };
        ui.label(tr(variables));
        egui::Grid::new("own effect").num_columns(2).show(ui, |ui| {
            let label = ui.label(tr("Name"));
            ui.add(theme::line(&mut typed.name).desired_width(120.0))
                .labelled_by(label.id);
            ui.end_row();
            let label = ui.label(tr(symbol));
            ui.add(
                theme::line(&mut typed.formula)
                    .desired_width(240.0)
                    .font(egui::TextStyle::Monospace),
            )
            .labelled_by(label.id);
            ui.end_row();
        });
        let checked = typed.check();
        let id = typed.id();
        if checked.is_ok() && id != typed.name {
            ui.label(tr(format!("In the model it is called {id}.")));
        }
        match &checked {
            Ok(names) => ui.label(tr(format!("To be fitted: {}", names.join(", ")))),
            Err(error) => ui.colored_label(ui.visuals().warn_fg_color, tr(error)),
        };
        let ready = checked.is_ok() && page.job.is_none() && page.report().is_some();
        let add = ui.add_enabled(ready, egui::Button::new(tr("Add your effect")));
        targets.note("own:add", ui, &add);
        if add.clicked() {
            commands.push(Command::AddOwn(typed.clone()));
        }
    });
    if typed != before {
        commands.push(Command::Type(typed));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_as_one_writes_it_becomes_one_of_files() {
        let named = |name: &str| Typed {
            name: name.to_owned(),
            ..Typed::example(Kind::Drive)
        };
        let line = named(" Bump at  the-stop 2 ").line();
        assert_eq!(line, "bump_at_the_stop_2: -a*exp(-((x-b)/c)^2)");
        assert!(named("Bump at the stop").check().is_ok());
        for name in ["", "2nd", "a:b", "größer", "Coulomb friction"] {
            assert!(named(name).check().is_err(), "{name}");
        }
    }
}
