//! An effect of the user's own while it is typed.

use hysteron_core::effect::{EffectId, Formula};
use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::msg;

/// What is typed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Typed {
    /// What it is typed for: a formula of a drive is none of a process.
    pub(super) kind: Kind,
    pub name: String,
    pub formula: String,
}

impl Typed {
    /// What stands there before anything is typed.
    pub(super) fn example(kind: Kind) -> Self {
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
    pub(super) fn id(&self) -> String {
        let words: Vec<&str> = self
            .name
            .split([' ', '-'])
            .filter(|w| !w.is_empty())
            .collect();
        words.join("_").to_lowercase()
    }

    /// Names of the parameters, or what is wrong.
    pub(super) fn check(&self) -> Result<Vec<String>, Message> {
        if EffectId::own(&self.id()).is_none() {
            return Err(msg!("name: {}", EffectId::OWN_NAMES));
        }
        let formula = Formula {
            name: self.id(),
            text: self.formula.trim().to_owned(),
        };
        formula.parameters(self.kind).map_err(Message::from)
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
