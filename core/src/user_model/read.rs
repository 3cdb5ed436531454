//! A model from text: every error names its line and says what would be right.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Known, MAX_BYTES, MAX_PRESENT, Present, Status, UserModel};
use crate::effect::{self, EffectId, Formula, VISCOUS_FRICTION, baseline};
use crate::measurement::Kind;
use crate::message::{Message, says};
use crate::msg;

/// Why a text is no model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct ModelFileError {
    /// Line, from 1.
    pub line: usize,
    /// What is wrong and what would be right.
    pub message: Message,
}

impl ModelFileError {
    /// In words.
    pub fn message(&self) -> Message {
        msg!("line {}: {}", &self.line, &self.message)
    }
}

says!(ModelFileError);

type Value<'t> = Spanned<DeValue<'t>>;

impl UserModel {
    /// Reads a model.
    ///
    /// # Errors
    /// The line, what is wrong there, and what is accepted.
    pub fn from_toml(text: &str) -> Result<Self, ModelFileError> {
        let reader = Reader { text };
        if text.len() > MAX_BYTES {
            return Err(ModelFileError {
                line: 1,
                message: msg!(
                    "the file is longer than {} bytes: this is not a model",
                    MAX_BYTES
                ),
            });
        }
        let file = DeTable::parse(text).map_err(|e| {
            let said = Message::name(e.message());
            reader.error(&e.span().unwrap_or(0..0), said)
        })?;
        reader.model(file.get_ref())
    }
}

struct Reader<'t> {
    text: &'t str,
}

impl Reader<'_> {
    fn error(&self, at: &Range<usize>, message: impl Into<Message>) -> ModelFileError {
        let before = self.text.get(..at.start).unwrap_or(self.text);
        ModelFileError {
            line: before.matches('\n').count() + 1,
            message: message.into(),
        }
    }

    /// The entries of a table by name; a name that is not in `accepted` is an error.
    fn entries<'v, 'i>(
        &self,
        table: &'v DeTable<'i>,
        place: impl Into<Message>,
        accepted: &[&str],
    ) -> Result<impl Fn(&str) -> Option<&'v Value<'i>>, ModelFileError> {
        for key in table.keys() {
            if !accepted.contains(&key.get_ref().as_ref()) {
                return Err(self.error(
                    &key.span(),
                    msg!(
                        "'{}' is not known {}; expected {}",
                        Message::name(shown(key.get_ref())),
                        place,
                        Message::name(list(accepted))
                    ),
                ));
            }
        }
        Ok(move |name: &str| {
            table
                .iter()
                .find(|(key, _)| key.get_ref() == name)
                .map(|(_, value)| value)
        })
    }

    fn model(&self, file: &DeTable) -> Result<UserModel, ModelFileError> {
        let entry = self.entries(
            file,
            "here",
            &["kind", "parameters", "effects", "candidates"],
        )?;
        let kind = match entry("kind") {
            None => {
                return Err(
                    self.error(&(0..0), "kind = \"drive\" or kind = \"process\" is missing")
                );
            }
            Some(value) => match value.get_ref().as_str() {
                Some("drive") => Kind::Drive,
                Some("process") => Kind::Process,
                _ => {
                    return Err(self.error(&value.span(), "kind must be \"drive\" or \"process\""));
                }
            },
        };
        let mut model = UserModel::blank(kind);
        if let Some(value) = entry("parameters") {
            let symbols: Vec<&str> = baseline::known_parameters(kind)
                .iter()
                .map(|p| p.symbol)
                .collect();
            model.parameters = self.parameters(value, "the baseline", &symbols)?;
            for p in &model.parameters {
                // Inertia and time constant divide; the gain of a process may have either sign.
                let positive = ["J1", "T"].contains(&p.symbol.as_str());
                let bad = match p.symbol.as_str() {
                    "d1" => p.value < 0.0,
                    "ambient" => false,
                    _ => p.value == 0.0 || (positive && p.value < 0.0),
                };
                if bad {
                    let wanted = match p.symbol.as_str() {
                        "d1" => "at least 0",
                        "K" => "other than 0",
                        _ => "above 0",
                    };
                    return Err(self.error(
                        &place_of(&p.symbol, value),
                        msg!(
                            "{} = {} must be {}",
                            Message::name(&p.symbol),
                            p.value,
                            wanted
                        ),
                    ));
                }
            }
        }
        for (title, own) in [("effects", false), ("candidates", true)] {
            let Some(value) = entry(title) else {
                continue;
            };
            let Some(effects) = value.get_ref().as_array() else {
                return Err(self.error(
                    &value.span(),
                    msg!("{} must be written as [[{}]]", title, title),
                ));
            };
            if model.effects.len() + effects.len() > MAX_PRESENT {
                let text = msg!(
                    "{} effects are too many: at most {}",
                    effects.len(),
                    MAX_PRESENT
                );
                return Err(self.error(&value.span(), text));
            }
            for effect in effects {
                let present = self.effect(effect, kind, own)?;
                if model.find(present.id).is_some() {
                    let text = msg!(
                        "{} occurs twice: once is enough",
                        Message::name(present.id.as_str())
                    );
                    return Err(self.error(&effect.span(), text));
                }
                if own {
                    model.candidates.push(present);
                } else {
                    model.effects.push(present);
                }
            }
        }
        Ok(model)
    }

    /// An effect; with `own` one that must have a formula.
    fn effect(&self, value: &Value, kind: Kind, own: bool) -> Result<Present, ModelFileError> {
        let Some(table) = value.get_ref().as_table() else {
            return Err(self.error(&value.span(), "an effect must be written as [[effects]]"));
        };
        let entry = self.entries(table, "in an effect", &["id", "formula", "parameters"])?;
        if let (Some(id), Some(formula)) = (entry("id"), entry("formula")) {
            return self.own_effect(id, formula, entry("parameters"), kind);
        }
        if own {
            let text =
                "a candidate needs an id and a formula: those of the library are tried anyway";
            return Err(self.error(&value.span(), text));
        }
        let known: Vec<&str> = effect::for_kind(kind).map(|e| e.id().as_str()).collect();
        let id = entry("id").ok_or_else(|| {
            self.error(
                &value.span(),
                msg!("an effect needs an id: {}", Message::name(list(&known))),
            )
        })?;
        let name = id.get_ref().as_str().unwrap_or("");
        let effect = EffectId::parse(name)
            .filter(|id| *id != VISCOUS_FRICTION)
            .and_then(effect::find)
            .filter(|e| e.kinds().contains(&kind));
        let Some(effect) = effect else {
            let why = if name == VISCOUS_FRICTION.as_str() {
                "viscous_friction is part of every drive: its d1 goes under [parameters]".into()
            } else {
                msg!(
                    "no effect is called '{}'; expected {}",
                    Message::name(shown(name)),
                    Message::name(list(&known))
                )
            };
            return Err(self.error(&id.span(), why));
        };
        let symbols: Vec<&str> = effect.parameters().iter().map(|p| p.symbol).collect();
        let parameters = match entry("parameters") {
            None => Vec::new(),
            Some(value) => {
                let parameters =
                    self.parameters(value, Message::name(effect.id().as_str()), &symbols)?;
                for p in &parameters {
                    let spec = effect.parameters().iter().find(|s| s.symbol == p.symbol);
                    if let Some((spec, wanted)) =
                        spec.and_then(|s| Some((s, s.range.refuses(p.value)?)))
                    {
                        return Err(self.error(
                            &place_of(&p.symbol, value),
                            msg!(
                                "{} = {} ({}) must be {}",
                                Message::name(&p.symbol),
                                p.value,
                                spec.label,
                                wanted
                            ),
                        ));
                    }
                }
                parameters
            }
        };
        Ok(Present {
            id: effect.id(),
            formula: None,
            parameters,
        })
    }

    /// An effect of the user's own.
    fn own_effect(
        &self,
        id: &Value,
        formula: &Value,
        parameters: Option<&Value>,
        kind: Kind,
    ) -> Result<Present, ModelFileError> {
        let name = id.get_ref().as_str().unwrap_or("");
        let own = EffectId::own(name).ok_or_else(|| {
            let why = msg!(
                "'{}' is not a valid name for an effect: {}",
                Message::name(shown(name)),
                EffectId::OWN_NAMES
            );
            self.error(&id.span(), why)
        })?;
        let text = formula.get_ref().as_str().unwrap_or("");
        let written = Formula {
            name: name.to_owned(),
            text: text.to_owned(),
        };
        let symbols = written
            .parameters(kind)
            .map_err(|e| self.error(&formula.span(), msg!("formula, {}", &e)))?;
        let symbols: Vec<&str> = symbols.iter().map(String::as_str).collect();
        let parameters = match parameters {
            None => Vec::new(),
            Some(value) => self.parameters(value, Message::name(name), &symbols)?,
        };
        Ok(Present {
            id: own,
            formula: Some(text.to_owned()),
            parameters,
        })
    }

    fn parameters(
        &self,
        value: &Value,
        owner: impl Into<Message>,
        symbols: &[&str],
    ) -> Result<Vec<Known>, ModelFileError> {
        let Some(table) = value.get_ref().as_table() else {
            return Err(self.error(
                &value.span(),
                msg!(
                    "parameters must be a table of {}",
                    Message::name(list(symbols))
                ),
            ));
        };
        let place = msg!("among the parameters of {}", owner.into());
        let _checked = self.entries(table, place, symbols)?;
        table
            .iter()
            .map(|(key, value)| self.parameter(key.get_ref(), value))
            .collect()
    }

    fn parameter(&self, symbol: &str, value: &Value) -> Result<Known, ModelFileError> {
        let mut known = Known {
            symbol: symbol.to_owned(),
            value: f64::NAN,
            status: Status::Fixed,
            std_error: None,
            unit: None,
        };
        let Some(table) = value.get_ref().as_table() else {
            known.value = self.number(symbol, value)?;
            return Ok(known);
        };
        let accepted = ["value", "tolerance", "status", "unit"];
        let place = msg!("in {}", Message::name(symbol));
        let entry = self.entries(table, place, &accepted)?;
        let Some(number) = entry("value") else {
            return Err(self.error(
                &value.span(),
                msg!("{} needs a value", Message::name(symbol)),
            ));
        };
        known.value = self.number("value", number)?;
        let tolerance = match entry("tolerance") {
            None => None,
            Some(t) => {
                let tolerance = self.number("tolerance", t)?;
                if tolerance <= 0.0 {
                    let text = "tolerance must be above 0; what is exact has status = \"fixed\"";
                    return Err(self.error(&t.span(), text));
                }
                Some(tolerance)
            }
        };
        let written = entry("status");
        known.status = match (written.map(|s| s.get_ref().as_str()), tolerance) {
            (None | Some(Some("prior")), Some(tolerance)) => Status::Prior(tolerance),
            (None | Some(Some("fixed")), _) => Status::Fixed,
            (Some(Some("free")), _) => Status::Free,
            (Some(Some("prior")), None) => {
                let text = msg!(
                    "{} is a prior and needs a tolerance above 0",
                    Message::name(symbol)
                );
                return Err(self.error(&value.span(), text));
            }
            _ => {
                let text = "status must be \"fixed\", \"prior\" or \"free\"";
                return Err(self.error(&written.map_or(0..0, Spanned::span), text));
            }
        };
        if !matches!(known.status, Status::Prior(_)) {
            known.std_error = tolerance;
        }
        if let Some(unit) = entry("unit") {
            let text = unit.get_ref().as_str();
            let text = text.filter(|u| u.chars().count() <= 30);
            let Some(text) = text else {
                return Err(self.error(&unit.span(), "unit must be text, such as \"kg m^2\""));
            };
            known.unit = Some(text.to_owned());
        }
        Ok(known)
    }

    fn number(&self, name: &str, value: &Value) -> Result<f64, ModelFileError> {
        let number = match value.get_ref() {
            DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse::<f64>().ok(),
            DeValue::Float(f) => f.as_str().parse::<f64>().ok(),
            _ => None,
        };
        number.filter(|n| n.is_finite()).ok_or_else(|| {
            self.error(
                &value.span(),
                msg!(
                    "{} must be a finite number, such as 8.8e-4, or a table with a value",
                    Message::name(name)
                ),
            )
        })
    }
}

/// Where a table has the value of this name; the table itself where it has none.
fn place_of(name: &str, table: &Value) -> Range<usize> {
    let entries = table
        .get_ref()
        .as_table()
        .into_iter()
        .flat_map(|t| t.iter());
    let mut named = entries.filter(|(key, _)| key.get_ref() == name);
    named
        .next()
        .map_or_else(|| table.span(), |(_, value)| value.span())
}

/// `a, b or c`.
fn list(names: &[&str]) -> String {
    match names.split_last() {
        None => "nothing".to_owned(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}

/// A name from a file, short enough for a sentence.
fn shown(name: &str) -> String {
    let clean: String = name.chars().filter(|c| !c.is_control()).take(41).collect();
    if clean.chars().count() > 40 {
        clean.chars().take(40).chain("...".chars()).collect()
    } else {
        clean
    }
}
