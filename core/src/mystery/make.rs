//! From what a teacher chooses to a sealed record.

use serde::{Deserialize, Serialize};

use super::seal::{Keys, SALT};
use super::{Experiment, Hideable, Mystery, MysteryError, Truth, columns, hideable};
use crate::effect::EffectId;
use crate::measurement::{Kind, Measurement};
use crate::rig::Random;

/// Most effects that are hidden.
const MOST_EFFECTS: usize = 3;

/// Shares of mysteries without and with one effect, where the bench chooses; the others have two.
const NONE: f64 = 0.2;
const ONE: f64 = 0.5;

/// An effect to hide, and its main parameter in SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pick {
    /// Which effect.
    pub effect: EffectId,
    /// Value of its first parameter, SI.
    pub value: f64,
}

/// What to hide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Choice {
    /// None to two effects, which nobody knows before the word is said.
    Surprise,
    /// These; none is a mystery as well.
    Chosen(Vec<Pick>),
}

/// Everything that a mystery follows from: the same request gives the same record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// What is measured, and what it is driven with.
    pub experiment: Experiment,
    /// What to hide.
    pub choice: Choice,
    /// The word that opens the seal.
    pub word: String,
    /// Anything that was not used before; it is no secret.
    pub salt: [u8; SALT],
}

/// Runs the bench and seals the truth.
///
/// # Errors
/// One sentence, where the word is too short or what is chosen cannot be.
pub fn make(request: &Request) -> Result<Mystery, MysteryError> {
    let keys = Keys::new(&request.word, &request.salt)?;
    let mut random = Random::new(keys.seed);
    let kind = request.experiment.kind();
    let mut bench = request.experiment.bench(&mut random);
    let picks = match &request.choice {
        Choice::Chosen(picks) => chosen(kind, picks)?,
        Choice::Surprise => surprise(request.experiment, &mut random),
    };
    let hidden = picks
        .into_iter()
        .map(|(effect, value)| effect.hide(value, &mut bench, &mut random))
        .collect::<Result<_, _>>()?;
    let truth = Truth {
        kind,
        hidden,
        baseline: bench.baseline().into(),
    };
    let measurement = bench.measure(request.experiment);
    Ok(Mystery {
        kind,
        step: (step(&measurement) * 1e6).round() as u32,
        columns: counts(&measurement),
        seal: keys.seal(&request.salt, &truth.text())?,
    })
}

/// Sampling time of what was measured, s.
fn step(measurement: &Measurement) -> f64 {
    match measurement.time.as_slice() {
        [first, second, ..] => second - first,
        _ => 0.0,
    }
}

/// What was picked, as far as the bench can do it.
fn chosen(kind: Kind, picks: &[Pick]) -> Result<Vec<(&'static Hideable, f64)>, MysteryError> {
    if picks.len() > MOST_EFFECTS {
        return Err(MysteryError::TooMany(MOST_EFFECTS));
    }
    let mut found: Vec<(&Hideable, f64)> = Vec::new();
    for pick in picks {
        let effect = hideable(kind).iter().find(|h| h.id == pick.effect);
        let unknown = || MysteryError::UnknownEffect(pick.effect.to_string());
        let effect = effect.ok_or_else(unknown)?;
        if let Some((other, _)) = found.iter().find(|(other, _)| !other.goes_with(effect)) {
            return Err(MysteryError::Together(other.name(), effect.name()));
        }
        found.push((effect, pick.value));
    }
    Ok(found)
}

/// None to two effects that the experiment shows.
fn surprise(experiment: Experiment, random: &mut Random) -> Vec<(&'static Hideable, f64)> {
    let share = random.uniform();
    let count = usize::from(share >= NONE) + usize::from(share >= NONE + ONE);
    let mut left: Vec<&Hideable> = hideable(experiment.kind())
        .iter()
        .filter(|h| h.shown_by.contains(&experiment))
        .collect();
    let mut picks = Vec::new();
    while picks.len() < count && !left.is_empty() {
        let index = (random.uniform() * left.len() as f64) as usize;
        let effect = left.swap_remove(index.min(left.len() - 1));
        left.retain(|other| other.goes_with(effect));
        picks.push((effect, effect.draw(random)));
    }
    picks
}

/// The columns as the bench has counted them.
fn counts(measurement: &Measurement) -> Vec<Vec<i32>> {
    let count = |column: &super::Column| {
        let output = || measurement.output(column.quantity);
        let channel = Some(&measurement.input).filter(|c| c.quantity == column.quantity);
        let channel = channel.or_else(output);
        let values = channel.map(|c| c.values.as_slice()).unwrap_or_default();
        // A cast of a number beyond all bounds gives the bound.
        let counts = values.iter().map(|v| (v / column.step).round() as i32);
        counts.collect()
    };
    columns(measurement.kind).iter().map(count).collect()
}
