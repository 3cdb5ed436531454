//! Everything that can be said about the oscillation of a loop without simulating it.

use std::f64::consts::PI;

use num_complex::Complex;
use serde::{Deserialize, Serialize};

use super::{
    Cycle, ExactCycle, Existence, Intersection, Outcome, TRUSTED_DISTORTION, continuum,
    describing_function, exact_cycles, existence, likely_half_periods, settled_cycle,
    typical_frequency,
};
use crate::message::{Message, fixed, says, signed};
use crate::msg;
use crate::plant::{PlantError, TransferFunction};
use crate::relay::{Relay, RelayError};
use crate::root::illinois;
use crate::uncertain::brief;

/// What is predicted for a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// By the describing function, equations (5) and (6), by rising frequency.
    pub describing_function: Vec<Intersection>,
    /// Exactly, equation (3): cycles with two switches a period, shortest first.
    pub exact: Vec<ExactCycle>,
    /// Whether the relay must keep switching; `None` for an unstable plant.
    pub existence: Option<Existence>,
    /// Cycles of the loop, for example, if every half period is one; `exact` is empty then.
    pub continuum: Option<Vec<Cycle>>,
    /// How far the describing function can be trusted here.
    pub trust: Trust,
}

/// How far the describing function can be trusted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Trust {
    /// It agrees with the exact cycle, and the plant filters the harmonics.
    pub reliable: bool,
    /// Period by the describing function per exact period, minus 1.
    pub period_error: Option<f64>,
    /// The same for the amplitude.
    pub amplitude_error: Option<f64>,
    /// Why, in words.
    pub text: Message,
}

/// Why there is no prediction.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PredictError {
    /// The plant.
    Plant(#[from] PlantError),
    /// The relay.
    Relay(#[from] RelayError),
    /// A delay beside which the plant is at rest at once.
    LongDelay {
        /// Dead time and delay, s.
        lag: f64,
        /// The longest that is taken, s.
        most: f64,
    },
}

impl PredictError {
    /// In words.
    pub fn message(&self) -> Message {
        match self {
            Self::Plant(error) => error.message(),
            Self::Relay(error) => error.message(),
            Self::LongDelay { lag, most } => msg!(
                "dead time and delay are {} s, but the plant's slowest time constant allows {} s at most: beyond that \
                 they are too far apart to compute with",
                brief(*lag),
                brief(*most)
            ),
        }
    }
}

says!(PredictError);

/// Largest ratio of the delay to the plant's slowest time constant: of an `f64`'s 16 digits, the instants of switches
/// then have seven left to say what the plant does.
const MAX_DELAY: f64 = 1e9;

/// Share by which period or amplitude may be off for the describing function to be called reliable.
const TRUSTED_ERROR: f64 = 0.05;

/// What is said of one that can be trusted, with noise and without.
const IS_GOOD: &str = "The describing function is good here: {}.";
const GOOD_WITHOUT_NOISE: &str = "Without noise the describing function is good: {}.";

/// Guesses closer than this ratio share a scan, which reaches a factor of five to either side.
const SAME_SCAN: f64 = 4.0;

/// Ratio of their periods up to which an exact cycle is what the describing function predicts.
const SAME_KIND: f64 = 2.0;

/// Cycles whose periods differ by less are the same.
const SAME_CYCLE: f64 = 1e-6;

/// Predicts the oscillation of a relay loop.
pub fn predict(plant: &TransferFunction, relay: &Relay) -> Result<Prediction, PredictError> {
    plant.validate()?;
    relay.validate()?;
    let lag = plant.dead_time + relay.delay;
    let most = slowest(plant).map_or(f64::INFINITY, |time| MAX_DELAY * time);
    if lag > most {
        return Err(PredictError::LongDelay { lag, most });
    }
    let describing = describing_function(plant, relay);
    let existence = existence(plant, relay);
    let guess = PI / typical_frequency(plant) + lag;
    let continuum = continuum(&plant.state_space(), relay, lag, guess);
    let exact = match continuum {
        Some(_) => Vec::new(),
        None => all_exact(plant, relay, &describing),
    };
    let mut prediction = Prediction {
        describing_function: describing,
        exact,
        existence,
        continuum,
        trust: Trust::default(),
    };
    prediction.trust = trust(&prediction, plant, relay, None);
    Ok(prediction)
}

impl Prediction {
    /// How far the describing function can be trusted, now that the loop's outcome is known.
    pub fn trust_after(&self, plant: &TransferFunction, relay: &Relay, outcome: Outcome) -> Trust {
        let mut trust = trust(self, plant, relay, Some(outcome));
        if matches!(outcome, Outcome::NoisyLimitCycle | Outcome::Chatter) {
            // The exact cycle, with which it is compared, knows no noise.
            if let Message::Words(words, _) = &mut trust.text
                && words == IS_GOOD
            {
                *words = GOOD_WITHOUT_NOISE.into();
            }
        }
        trust
    }
}

/// The slowest time constant of a plant, s, but for what it integrates.
fn slowest(plant: &TransferFunction) -> Option<f64> {
    let sizes = plant.poles().into_iter().map(Complex::norm);
    let slowest = sizes.filter(|size| *size > 0.0).reduce(f64::min)?;
    Some(1.0 / slowest)
}

/// The intersection that the loop would go to: the first stable one, or else the first.
pub fn dominant(intersections: &[Intersection]) -> Option<&Intersection> {
    intersections
        .iter()
        .find(|i| i.cycle.stable == Some(true))
        .or(intersections.first())
}

fn all_exact(
    plant: &TransferFunction,
    relay: &Relay,
    describing: &[Intersection],
) -> Vec<ExactCycle> {
    let lag = plant.dead_time + relay.delay;
    let seen = dominant(describing).into_iter().chain(describing);
    // Where the describing function sees nothing there may still be a cycle.
    let guesses = seen
        .map(|i| 0.5 * i.cycle.period)
        .chain(likely_half_periods(plant, relay));
    let space = plant.state_space();
    let mut scanned: Vec<f64> = Vec::new();
    let mut found: Vec<ExactCycle> = Vec::new();
    for guess in guesses {
        let near = |s: &f64| (guess / s).max(s / guess) < SAME_SCAN;
        if scanned.iter().any(near) {
            continue;
        }
        scanned.push(guess);
        found.extend(exact_cycles(&space, relay, lag, guess));
    }
    if found.is_empty() {
        let longest = scanned.iter().copied().reduce(f64::max);
        found.extend(longest.and_then(|guess| settled_cycle(&space, relay, lag, guess)));
    }
    found.sort_by(|a, b| a.cycle.period.total_cmp(&b.cycle.period));
    found.dedup_by(|a, b| (a.cycle.period / b.cycle.period - 1.0).abs() < SAME_CYCLE);
    found
}

fn trust(
    prediction: &Prediction,
    plant: &TransferFunction,
    relay: &Relay,
    outcome: Option<Outcome>,
) -> Trust {
    if let Some(cycle) = prediction.continuum.iter().flatten().next() {
        return trust_of_continuum(plant, relay, cycle);
    }
    let exact = &prediction.exact;
    let keeps_switching = match outcome {
        Some(outcome) => !matches!(
            outcome,
            Outcome::Rest | Outcome::Sliding | Outcome::Unbounded | Outcome::Chatter
        ),
        None => prediction.existence.is_some_and(|e| e.holds),
    };
    let Some(main) = dominant(&prediction.describing_function) else {
        return trust_of_none(exact.first(), keeps_switching);
    };
    let (period, amplitude) = (main.cycle.period, main.cycle.amplitude);
    let distance = |c: &&ExactCycle| libm::log(c.cycle.period / period).abs();
    let nearest = exact
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .filter(|c| distance(c) < libm::log(SAME_KIND));
    let kind = match main.cycle.stable {
        Some(false) => "an unstable cycle",
        _ => "a cycle",
    };
    let Some(nearest) = nearest else {
        return untrusted(msg!(
            "The describing function predicts {} of period {} s, but there is no exact cycle with two \
             switches a period near it: do not trust it here.",
            kind,
            fixed(period, 4)
        ));
    };
    let errors = [
        period / nearest.cycle.period - 1.0,
        amplitude / nearest.cycle.amplitude - 1.0,
    ];
    let accurate = errors.iter().all(|e| e.abs() <= TRUSTED_ERROR);
    let smooth = main.distortion <= TRUSTED_DISTORTION;
    let differences = msg!(
        "it is off by {} % in period and {} % in amplitude",
        signed(100.0 * errors[0], 1),
        signed(100.0 * errors[1], 1)
    );
    let harmonics = msg!(
        "harmonics {} % as large as the first reach the output",
        fixed(100.0 * main.distortion, 0)
    );
    let text = match (accurate, smooth) {
        (true, true) => msg!(IS_GOOD, differences),
        (true, false) => msg!(
            "Do not trust the describing function here, although {}: {}.",
            differences,
            harmonics
        ),
        (false, true) => msg!(
            "Do not trust the describing function here: {}.",
            differences
        ),
        (false, false) => {
            msg!(
                "Do not trust the describing function here: {}, since {}.",
                differences,
                harmonics
            )
        }
    };
    Trust {
        reliable: accurate && smooth,
        period_error: Some(errors[0]),
        amplitude_error: Some(errors[1]),
        text,
    }
}

/// Where the describing function sees no oscillation.
fn trust_of_none(exact: Option<&ExactCycle>, keeps_switching: bool) -> Trust {
    match exact {
            Some(c) => {
                let period = fixed(c.cycle.period, 4);
                untrusted(match c.cycle.stable {
                    Some(false) => msg!(
                        "The describing function sees no oscillation, but there is an exact one, unstable, of period \
                         {} s: do not trust it here.", period),
                    _ => msg!(
                        "The describing function sees no oscillation, but there is an exact one of period {} s: do \
                         not trust it here.", period),
                })
            }
            None if keeps_switching => untrusted(
                "The describing function sees no oscillation, though the relay keeps switching: do not trust it here."
                    .into(),
            ),
            None => Trust {
                reliable: true,
                ..untrusted("The describing function sees no oscillation, and there is none.".into())
            },
        }
}

fn untrusted(text: Message) -> Trust {
    Trust {
        text,
        ..Trust::default()
    }
}

/// Beside one exact cycle of a continuum: the describing function at its amplitude, `4k |P(jw)|/pi = a`.
fn trust_of_continuum(plant: &TransferFunction, relay: &Relay, cycle: &Cycle) -> Trust {
    let exact = 2.0 * PI / cycle.period;
    let off = |omega: f64| 4.0 * relay.gain / PI * plant.response(omega).norm() - cycle.amplitude;
    let [low, high] = [exact / SAME_KIND, exact * SAME_KIND];
    if (off(low) < 0.0) == (off(high) < 0.0) {
        return Trust {
            text: "The describing function sees no continuum here: do not trust it.".into(),
            ..Trust::default()
        };
    }
    let omega = illinois((low, off(low)), (high, off(high)), off);
    let error = exact / omega - 1.0;
    let good = error.abs() <= TRUSTED_ERROR;
    let off = signed(100.0 * error, 1);
    Trust {
        reliable: good,
        period_error: Some(error),
        amplitude_error: None,
        text: if good {
            msg!(
                "The describing function is good here: it sees a continuum as well, and at the same amplitude its \
                 period is off by {} %.",
                off
            )
        } else {
            msg!(
                "The describing function should not be trusted here: it sees a continuum as well, and at the same \
                 amplitude its period is off by {} %.",
                off
            )
        },
    }
}
