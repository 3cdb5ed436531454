//! How a file is read that does not say itself what its columns are: as the options of the command line say it, so that
//! it can be kept, and read again elsewhere.

use hysteron_core::measurement::{ImportOptions, Kind, Mapping, MappingError, PeriodError};
use hysteron_core::message::Message;
use serde::{Deserialize, Serialize};

/// What a file does not say; nothing where it says everything.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Reading {
    /// Drive or process; told by the columns if `None`.
    pub kind: Option<Kind>,
    /// Which column is what, as behind `--map`.
    pub map: String,
    /// As behind `--torque-constant`.
    pub torque_constant: String,
    /// As behind `--period`.
    pub period: String,
}

impl Reading {
    /// What the importer needs.
    ///
    /// # Errors
    /// One sentence.
    pub fn options(&self) -> Result<ImportOptions, Message> {
        let mapping = match self.map.as_str() {
            "" => Mapping::default(),
            map => map.parse::<Mapping>().map_err(Message::from)?,
        };
        let torque_constant = match self.torque_constant.as_str() {
            "" => None,
            constant => Some(constant.parse().map_err(|e: MappingError| e.message())?),
        };
        let period = match self.period.as_str() {
            "" => None,
            period => Some(period.parse().map_err(|e: PeriodError| e.message())?),
        };
        Ok(ImportOptions {
            kind: self.kind,
            mapping,
            torque_constant,
            period,
        })
    }

    /// Options of the command line for the same.
    pub fn arguments(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let all = [
            ("--kind", self.kind.map_or("", Kind::name)),
            ("--map", self.map.as_str()),
            ("--torque-constant", self.torque_constant.as_str()),
            ("--period", self.period.as_str()),
        ];
        all.into_iter().filter(|(_, value)| !value.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_what_the_command_line_takes() {
        let nothing = Reading::default();
        assert_eq!(nothing.options(), Ok(ImportOptions::default()));
        assert_eq!(nothing.arguments().count(), 0);
        let reading = Reading {
            kind: Some(Kind::Drive),
            map: "t=time [ms], u=-current [A], v1=-".to_owned(),
            torque_constant: "0.05 N m/A".to_owned(),
            period: "4s".to_owned(),
        };
        let options = reading.options().expect("options");
        assert_eq!(Ok(&options.mapping), reading.map.parse().as_ref());
        assert!(options.period.is_some_and(|p| p.seconds() == 4.0));
        assert!(options.torque_constant.is_some_and(|c| c.value() == 0.05));
        let arguments: Vec<_> = reading.arguments().collect();
        let expected = [
            ("--kind", "drive"),
            ("--map", "t=time [ms], u=-current [A], v1=-"),
            ("--torque-constant", "0.05 N m/A"),
            ("--period", "4s"),
        ];
        assert_eq!(arguments, expected);
        let wrong = Reading {
            map: "t".to_owned(),
            ..nothing
        };
        assert!(
            wrong
                .options()
                .is_err_and(|e| e.to_string().contains("not a mapping"))
        );
    }
}
