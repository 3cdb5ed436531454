//! A model as text.

use std::fmt::Write as _;

use super::{Known, Status, UserModel};
use crate::measurement::Kind;

impl UserModel {
    /// The model as TOML, which [`UserModel::from_toml`] reads back to the same.
    pub fn to_toml(&self) -> String {
        let kind = match self.kind {
            Kind::Drive => "drive",
            Kind::Process => "process",
        };
        let mut out = format!(
            "# A model for Hysteron: hysteron diagnose FILE.csv --model THIS.toml\n\
             # status: \"fixed\", \"prior\" (value and tolerance), or \"free\" (the fit starts at value).\n\
             kind = \"{kind}\"\n"
        );
        if !self.parameters.is_empty() {
            out.push_str("\n[parameters]\n");
            lines(&mut out, &self.parameters);
        }
        for (title, list) in [("effects", &self.effects), ("candidates", &self.candidates)] {
            for effect in list {
                let id = quoted(effect.id.as_str());
                let _ = writeln!(out, "\n[[{title}]]\nid = {id}");
                if let Some(formula) = &effect.formula {
                    let _ = writeln!(out, "formula = {}", quoted(formula));
                }
                if !effect.parameters.is_empty() {
                    let _ = writeln!(out, "[{title}.parameters]");
                    lines(&mut out, &effect.parameters);
                }
            }
        }
        out
    }
}

fn lines(out: &mut String, parameters: &[Known]) {
    for p in parameters {
        let mut parts = vec![format!("value = {:?}", p.value)];
        let tolerance = match p.status {
            Status::Prior(tolerance) => Some(tolerance),
            _ => p.std_error,
        };
        if let Some(tolerance) = tolerance {
            parts.push(format!("tolerance = {tolerance:?}"));
        }
        if let Some(unit) = &p.unit {
            parts.push(format!("unit = {}", quoted(unit)));
        }
        let status = match p.status {
            Status::Free => "free",
            Status::Prior(_) => "prior",
            Status::Fixed => "fixed",
        };
        parts.push(format!("status = \"{status}\""));
        let _ = writeln!(out, "{} = {{ {} }}", p.symbol, parts.join(", "));
    }
}

/// A basic string of TOML.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
