//! From what a teacher chooses to a sealed record.

use serde::{Deserialize, Serialize};

use super::record::{COUNTS, INPUT_STEP, VELOCITY_STEP};
use super::seal::{Keys, SALT};
use super::{Hideable, Mystery, MysteryError, Truth, hideable};
use crate::effect::EffectId;
use crate::measurement::{Channel, Measurement, Quantity};
use crate::rig::{self, DriveRig, ENCODER, Excitation, Random};

/// Most effects that are hidden.
const MOST_EFFECTS: usize = 3;

/// Length of the record.
const SAMPLES: usize = 8000;

/// Shares of mysteries without and with one effect, where the bench chooses; the others have two.
const NONE: f64 = 0.2;
const ONE: f64 = 0.5;

/// What the motor is driven with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Experiment {
    /// A relay on the velocity, a little asymmetric.
    Relay,
    /// A sum of sines.
    #[default]
    Sines,
    /// Steps of growing size in both directions.
    Stairs,
}

impl Experiment {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Sines, Self::Relay, Self::Stairs];

    fn excitation(self) -> Excitation {
        match self {
            Self::Relay => rig::relay(0.1),
            Self::Sines => Excitation::Multisine { amplitude: 0.08 },
            Self::Stairs => Excitation::Staircase { top: 0.3 },
        }
    }
}

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
    /// What the motor is driven with.
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
    let mut rig = DriveRig {
        seed: random.seed(),
        excitation: request.experiment.excitation(),
        samples: SAMPLES,
        encoder: ENCODER,
        input_step: INPUT_STEP,
        velocity_step: VELOCITY_STEP,
        inertia: 8.8e-4 * random.between(0.9, 1.1),
        viscous: 2e-3 * random.between(0.8, 1.2),
        ..DriveRig::default()
    };
    let picks = match &request.choice {
        Choice::Chosen(picks) => chosen(picks)?,
        Choice::Surprise => surprise(request.experiment, &mut random),
    };
    let hidden = picks
        .into_iter()
        .map(|(effect, value)| effect.hide(value, &mut rig, &mut random))
        .collect::<Result<_, _>>()?;
    let truth = Truth {
        hidden,
        baseline: vec![
            ("J1".to_owned(), rig.inertia),
            ("d1".to_owned(), rig.viscous),
        ],
    };
    Ok(Mystery {
        step: (rig.sampling * 1e6).round() as u32,
        columns: counts(&rig.measure()),
        seal: keys.seal(&request.salt, &truth.text())?,
    })
}

/// What was picked, as far as the bench can do it.
fn chosen(picks: &[Pick]) -> Result<Vec<(&'static Hideable, f64)>, MysteryError> {
    if picks.len() > MOST_EFFECTS {
        return Err(MysteryError::TooMany(MOST_EFFECTS));
    }
    let mut found: Vec<(&Hideable, f64)> = Vec::new();
    for pick in picks {
        let effect = hideable().iter().find(|h| h.id == pick.effect);
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
    let mut left: Vec<&Hideable> = hideable()
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
fn counts(measurement: &Measurement) -> [Vec<i32>; 3] {
    let count = |channel: Option<&Channel>, step: f64| {
        let values = channel.map(|c| c.values.as_slice()).unwrap_or_default();
        // A cast of a number beyond all bounds gives the bound.
        values.iter().map(|v| (v / step).round() as i32).collect()
    };
    [
        count(Some(&measurement.input), INPUT_STEP),
        count(
            measurement.output(Quantity::Position),
            std::f64::consts::TAU / COUNTS,
        ),
        count(measurement.output(Quantity::Velocity), VELOCITY_STEP),
    ]
}
