//! Which column is what, as someone chooses it: a plain value, and the mapping that it stands for.

use hysteron_core::measurement::{
    COUNTS, FoundColumn, Kind, Quantity, Role, constant_per, guess, needs_torque_constant,
    usual_units,
};

use hysteron_work::reading::Reading;

/// A channel that a column can be.
pub(super) struct Channel {
    pub role: Role,
    /// Its names in the form.
    pub title: &'static str,
    pub unit: &'static str,
    pub resolution: &'static str,
    pub turn: &'static str,
}

pub(super) const CHANNELS: [Channel; 5] = [
    Channel {
        role: Role::Time,
        title: "Time",
        unit: "Unit of the time",
        resolution: "",
        turn: "",
    },
    Channel {
        role: Role::Measured(Quantity::Input),
        title: "Input",
        unit: "Unit of the input",
        resolution: "",
        turn: "Flip sign of the input",
    },
    Channel {
        role: Role::Measured(Quantity::Position),
        title: "Position",
        unit: "Unit of the position",
        resolution: "Counts per turn or length of a count",
        turn: "Flip sign of the position",
    },
    Channel {
        role: Role::Measured(Quantity::Velocity),
        title: "Velocity",
        unit: "Unit of the velocity",
        resolution: "",
        turn: "Flip sign of the velocity",
    },
    Channel {
        role: Role::Measured(Quantity::Output),
        title: "Output",
        unit: "Unit of the output",
        resolution: "",
        turn: "Flip sign of the output",
    },
];

impl Channel {
    /// Whether such a system has it.
    fn belongs_to(&self, kind: Kind) -> bool {
        match self.role {
            Role::Time | Role::Measured(Quantity::Input) => true,
            Role::Measured(Quantity::Output) => kind == Kind::Process,
            Role::Measured(_) => kind == Kind::Drive,
        }
    }

    /// Whether a measurement can do without it: of position and velocity one is enough.
    pub fn is_optional(&self) -> bool {
        matches!(
            self.role,
            Role::Measured(Quantity::Position | Quantity::Velocity)
        )
    }

    /// The units that it can have; none where it may have any.
    pub fn units(&self, kind: Kind) -> &'static [&'static str] {
        if kind == Kind::Process && self.role != Role::Time {
            return &[];
        }
        usual_units(self.role)
    }

    /// Whether it was counted by an encoder, so that the unit needs a resolution.
    pub fn is_counted(&self, kind: Kind, chosen: &Chosen) -> bool {
        chosen.unit == COUNTS && self.units(kind).contains(&COUNTS)
    }

    /// The unit as a mapping has it. People type decimal commas too.
    fn whole_unit(&self, kind: Kind, chosen: &Chosen) -> String {
        if self.is_counted(kind, chosen) {
            return format!("{COUNTS}, {}", chosen.resolution.trim().replace(',', "."));
        }
        chosen.unit.trim().to_owned()
    }
}

/// What was chosen for a channel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chosen {
    /// Place of the column among those of the file.
    pub column: Option<usize>,
    pub unit: String,
    /// Of counts, such as `4096/rev` or `0.001 mm`.
    pub resolution: String,
    /// Whether the other direction counts as positive.
    pub turned: bool,
}

/// What was chosen in the form.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    pub kind: Kind,
    /// For each of [`CHANNELS`].
    pub chosen: [Chosen; CHANNELS.len()],
    /// Such as `0.05`, or with a unit of its own `0.05 N m/A`; empty where it is not known.
    pub torque_constant: String,
    /// Its unit, where it was given none of its own.
    pub constant_unit: String,
    /// The time from sample to sample where no column has the times, such as `4s`.
    pub period: String,
}

impl Choice {
    /// What the columns most likely are.
    pub fn likeliest(columns: &[FoundColumn]) -> Self {
        let guess = guess(columns);
        let mut choice = Self {
            kind: guess.kind,
            chosen: Default::default(),
            torque_constant: String::new(),
            constant_unit: String::new(),
            period: String::new(),
        };
        for (channel, chosen) in CHANNELS.iter().zip(&mut choice.chosen) {
            let found = guess
                .channels
                .iter()
                .find(|(role, _)| *role == channel.role);
            chosen.column = found.map(|(_, column)| *column);
        }
        choice.suit(columns);
        choice
    }

    /// Gives each channel a unit that suits it: what does not is replaced by what the column says.
    pub fn suit(&mut self, columns: &[FoundColumn]) {
        for (channel, chosen) in CHANNELS.iter().zip(&mut self.chosen) {
            let known = !chosen.unit.is_empty()
                && (channel.is_counted(self.kind, chosen)
                    || channel.role.takes(self.kind, &chosen.unit));
            if let Some(column) = chosen
                .column
                .and_then(|i| columns.get(i))
                .filter(|_| !known)
            {
                chosen.unit = column.unit_as(channel.role, self.kind).unwrap_or_default();
            }
        }
    }

    /// What decides about the units: the kind and the columns.
    pub fn columns(&self) -> (Kind, [Option<usize>; CHANNELS.len()]) {
        (self.kind, self.chosen.each_ref().map(|c| c.column))
    }

    /// The channels of such a system, with their places.
    pub(super) fn channels(&self) -> impl Iterator<Item = (usize, &'static Channel)> + use<> {
        let kind = self.kind;
        let all = CHANNELS.iter().enumerate();
        all.filter(move |(_, channel)| channel.belongs_to(kind))
    }

    /// The channels that have a column, and what was chosen for them.
    fn mapped(&self) -> impl Iterator<Item = (&'static Channel, &Chosen, usize)> {
        self.channels().filter_map(|(i, channel)| {
            let chosen = &self.chosen[i];
            Some((channel, chosen, chosen.column?))
        })
    }

    /// Whether the input of a drive is a current, a voltage or a command, which a torque constant makes a torque.
    pub fn needs_torque_constant(&self) -> bool {
        let input = Role::Measured(Quantity::Input);
        self.kind == Kind::Drive
            && self.mapped().any(|(channel, chosen, _)| {
                channel.role == input && needs_torque_constant(&chosen.unit)
            })
    }

    /// Units that the torque constant can have: a torque or a force by what the input is.
    pub fn constant_units(&self) -> Vec<String> {
        let input = Role::Measured(Quantity::Input);
        let mut inputs = self.mapped().filter(|(channel, ..)| channel.role == input);
        let unit = inputs.next().map(|(_, chosen, _)| chosen.unit.as_str());
        let Some(per) = unit.and_then(constant_per) else {
            return Vec::new();
        };
        let gives = ["N m", "mN m", "N", "kN"];
        gives.map(|gives| format!("{gives}/{per}")).to_vec()
    }

    /// The torque constant with its unit as the command line has it.
    fn whole_constant(&self) -> String {
        let typed = self.torque_constant.trim().replace(',', ".");
        if typed.parse::<f64>().is_ok() {
            format!("{typed} {}", self.constant_unit)
        } else {
            typed
        }
    }

    /// Whether no column has the times, so that a sampling period is needed.
    pub fn needs_period(&self) -> bool {
        self.mapped()
            .all(|(channel, ..)| channel.role != Role::Time)
    }

    /// What is still to be chosen, by its names in the form.
    pub fn missing(&self) -> Vec<&'static str> {
        let mut missing = Vec::new();
        let has = |channel: &Channel| self.mapped().any(|(c, ..)| c.role == channel.role);
        for (_, channel) in self.channels() {
            if channel.role == Role::Time && !has(channel) {
                if self.period.trim().is_empty() {
                    missing.push("Time or Sampling period");
                }
            } else if !channel.is_optional() && !has(channel) {
                missing.push(channel.title);
            }
        }
        let one = self.mapped().any(|(channel, ..)| channel.is_optional());
        if self.kind == Kind::Drive && !one {
            missing.push("Position or Velocity");
        }
        for (channel, chosen, _) in self.mapped() {
            if chosen.unit.trim().is_empty() {
                missing.push(channel.unit);
            } else if channel.is_counted(self.kind, chosen) && chosen.resolution.trim().is_empty() {
                missing.push(channel.resolution);
            }
        }
        missing
    }

    /// The same as the command line says it.
    pub fn reading(&self, columns: &[FoundColumn]) -> Reading {
        let mut map: Vec<String> = Vec::new();
        for (channel, chosen, column) in self.mapped() {
            let sign = if chosen.turned { "-" } else { "" };
            let address = columns.get(column).map_or("", |c| &c.address);
            let (role, unit) = (channel.role.name(), channel.whole_unit(self.kind, chosen));
            map.push(format!("{role}={sign}{address} [{unit}]"));
        }
        // Nothing is taken by its name alone that was not chosen.
        let others = columns.iter().filter_map(|c| c.known_as);
        for role in others.filter(|role| self.mapped().all(|(c, ..)| c.role != *role)) {
            let out = format!("{}=-", role.name());
            if !map.contains(&out) {
                map.push(out);
            }
        }
        let torque_constant = if self.needs_torque_constant() {
            self.whole_constant()
        } else {
            String::new()
        };
        let period = if self.needs_period() {
            self.period.trim().replace(',', ".")
        } else {
            String::new()
        };
        Reading {
            kind: Some(self.kind),
            map: map.join(", "),
            torque_constant,
            period,
        }
    }
}
