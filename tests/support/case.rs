//! One blind case: a measurement, what is hidden in it, and what a fair diagnosis may say.

use hysteron_core::measurement::Measurement;
use hysteron_core::rig::DriveRig;
use hysteron_core::rig::process::ProcessRig;

use super::sparse::thinned;

/// A hidden effect.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Its id.
    pub effect: &'static str,
    /// Effects that are the same as it in this record, exactly: an honest class holds them all.
    pub same: &'static [&'static str],
    /// Effects that are nearly the same in this record: a fair class may hold them.
    pub alike: &'static [&'static str],
    /// Its main parameter: symbols that may name it (else the effect's first one) and the value in SI.
    pub value: Option<(&'static [&'static str], f64)>,
}

impl Truth {
    /// An effect that stands alone, with its main parameter.
    pub fn new(effect: &'static str, symbols: &'static [&'static str], value: f64) -> Self {
        Self {
            effect,
            same: &[],
            alike: &[],
            value: Some((symbols, value)),
        }
    }

    /// The effect with its fair companions and its main parameter in SI.
    fn json(&self) -> serde_json::Value {
        serde_json::json!({
            "effect": self.effect,
            "same": self.same,
            "alike": self.alike,
            "value": self.value.map(|(_, value)| value),
        })
    }

    /// The truth where others act exactly the same.
    pub fn same(self, others: &'static [&'static str]) -> Self {
        Self {
            same: others,
            ..self
        }
    }

    /// The truth where others act nearly the same.
    pub fn alike(self, others: &'static [&'static str]) -> Self {
        Self {
            alike: others,
            ..self
        }
    }
}

/// What is hidden.
#[derive(Clone, Debug)]
pub enum Hidden {
    /// Effects of the library; other lists that explain the record as well stand in `or`.
    Known {
        truths: Vec<Truth>,
        or: Vec<Vec<&'static str>>,
    },
    /// Physics outside the library.
    Unknown,
}

/// The bench that makes the measurement.
#[derive(Clone, Copy, Debug)]
pub enum Bench {
    Drive(DriveRig),
    /// A drive of whose record one sample in so many is kept.
    Sparse(DriveRig, usize),
    Process(ProcessRig),
}

/// One case.
#[derive(Clone, Debug)]
pub struct Case {
    pub name: &'static str,
    pub bench: Bench,
    pub hidden: Hidden,
}

impl Case {
    /// Known effects on a drive.
    pub fn drive(name: &'static str, truths: Vec<Truth>, rig: DriveRig) -> Self {
        Self::new(name, truths, Bench::Drive(rig))
    }

    /// Known effects on a drive of whose record one sample in so many is kept.
    pub fn sparse(name: &'static str, truths: Vec<Truth>, rig: DriveRig, every: usize) -> Self {
        Self::new(name, truths, Bench::Sparse(rig, every))
    }

    /// Known effects on a process.
    pub fn process(name: &'static str, truths: Vec<Truth>, rig: ProcessRig) -> Self {
        Self::new(name, truths, Bench::Process(rig))
    }

    fn new(name: &'static str, truths: Vec<Truth>, bench: Bench) -> Self {
        let hidden = Hidden::Known {
            truths,
            or: Vec::new(),
        };
        Self {
            name,
            bench,
            hidden,
        }
    }

    /// Something outside the library.
    pub fn unknown(name: &'static str, bench: Bench) -> Self {
        Self {
            name,
            bench,
            hidden: Hidden::Unknown,
        }
    }

    /// Another list of effects that is a fair reading of this record.
    pub fn or(mut self, reading: Vec<&'static str>) -> Self {
        if let Hidden::Known { or, .. } = &mut self.hidden {
            or.push(reading);
        }
        self
    }

    /// Runs the experiment.
    pub fn measure(&self) -> Measurement {
        match &self.bench {
            Bench::Drive(rig) => rig.measure(),
            Bench::Sparse(rig, every) => thinned(rig.measure(), *every),
            Bench::Process(rig) => rig.measure(),
        }
    }

    /// What is hidden, as text.
    pub fn truth(&self) -> String {
        match &self.hidden {
            Hidden::Unknown => "outside the library".to_owned(),
            Hidden::Known { truths, .. } if truths.is_empty() => "nothing".to_owned(),
            Hidden::Known { truths, .. } => {
                let names: Vec<&str> = truths.iter().map(|t| t.effect).collect();
                names.join(" + ")
            }
        }
    }

    /// The baseline parameters: symbol and true value.
    pub fn baseline(&self) -> [(&'static str, f64); 2] {
        match &self.bench {
            Bench::Drive(rig) | Bench::Sparse(rig, _) => [("J1", rig.inertia), ("d1", rig.viscous)],
            Bench::Process(rig) => [("K", rig.gain), ("T", rig.time_constant)],
        }
    }

    /// All that is known about the case, for a file beside its record. `missing` has for each hidden
    /// effect the ids that a fair class may hold; null where the library does not have it.
    pub fn truth_json(&self) -> serde_json::Value {
        let (missing, or) = match &self.hidden {
            Hidden::Unknown => (serde_json::Value::Null, &[][..]),
            Hidden::Known { truths, or } => {
                (truths.iter().map(Truth::json).collect(), or.as_slice())
            }
        };
        let [first, second] = self.baseline();
        serde_json::json!({
            "name": self.name,
            "unknown": matches!(self.hidden, Hidden::Unknown),
            "missing": missing,
            "or": or,
            "baseline": { first.0: first.1, second.0: second.1 },
        })
    }
}
