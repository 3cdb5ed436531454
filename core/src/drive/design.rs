//! Design of the drifting test: which relay finds the gap of a drive that is known only roughly?
//!
//! The cycle must be small against the gap, drift through it in reasonable time, push hard enough to
//! move the load, and be slow enough for the controller that runs the relay. All of it follows from the
//! closed form of the cycle ([`drifting_cycle`]), so that a grid of relays is searched for the best.

use serde::{Deserialize, Serialize};

use super::{Body, DriftingCycle, DriveError, VelocityRelay, check, drifting_cycle};
use crate::message::{Message, fixed};
use crate::msg;
use crate::relay::Relay;
use crate::uncertain::brief;

/// What is known of a drive before the test, roughly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoughDrive {
    /// The motor side.
    pub motor: Body,
    /// Coulomb friction of the load, N m (or N); 0 if unknown.
    pub load_coulomb: f64,
    /// Delay from a switch to the push, s, without the controller's sampling.
    pub delay: f64,
    /// The gap that is expected, `2 beta`, rad (or m); above 0.
    pub gap: f64,
    /// Largest torque of the motor, N m (or N); above 0.
    pub torque: f64,
    /// Sampling time of the controller, s; `None` if it can be chosen.
    pub sampling: Option<f64>,
    /// Standard deviation of the measured velocity, rad/s (or m/s); at least 0.
    pub velocity_noise: f64,
}

/// A relay for the drifting test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DriftingTest {
    /// The relay, with flip period and sampling time; its delay is that of the drive and the added one.
    pub relay: VelocityRelay,
    /// Delay that the controller should add, s.
    pub added_delay: f64,
    /// Its cycle in the gap.
    pub cycle: DriftingCycle,
    /// Longest time to cross the gap, s, for a drive that is not quite as it was thought.
    pub traverse: f64,
    /// Duration that gives [`TRAVERSES`] crossings, s.
    pub duration: f64,
    /// What this test cannot do, a sentence each; empty if nothing stands against it.
    pub warnings: Vec<Message>,
}

/// Crossings of the gap over which an estimate can be averaged.
pub const TRAVERSES: usize = 4;

/// Share of the gap that the cycle may swing over, and that is wished for.
const LARGEST_SWING: f64 = 1.0 / 10.0;
const WISHED_SWING: f64 = 1.0 / 40.0;

/// Time to cross the gap, s: wished for, and longest.
const WISHED_TRAVERSE: f64 = 2.0;
const LONGEST_TRAVERSE: f64 = 30.0;

/// Fewest cycles within a crossing: the drift is read from cycle to cycle.
const FEWEST_CYCLES: f64 = 20.0;

/// The weaker push against all dry friction, at least: it must move motor and load.
const PUSH: f64 = 1.25;

/// Samples in a period: at least, and wished for.
const FEWEST_SAMPLES: f64 = 10.0;
const WISHED_SAMPLES: f64 = 40.0;

/// What is known roughly may be off by these shares: inertia; friction and delay.
const ROUGH_INERTIA: f64 = 0.2;
const ROUGH: f64 = 0.3;

/// Hysteresis against the noise of the velocity, at least.
const NOISE: f64 = 6.0;

/// A crossing and a half: the motor then pushes the load for a while before it turns round.
const FLIP: f64 = 1.5;

/// The grid: shares of the largest torque, hystereses a factor apart, asymmetries.
const GAINS: i32 = 16;
const GAIN_RATIO: f64 = 1.4;
const HYSTERESES: i32 = 32;
const HYSTERESIS_RATIO: f64 = 1.3;
const ASYMMETRIES: [f64; 4] = [0.1, 0.15, 0.2, 0.3];

/// Delays that are added, as shares of the time in which the push changes the velocity by `eps`.
const ADDED_DELAYS: [f64; 4] = [0.0, 0.2, 0.5, 1.0];

/// Weight of what must be against what is wished for.
const MUST: f64 = 100.0;

/// A demand that is missed by more than this factor is missed altogether.
const WORST: f64 = 1e6;

impl RoughDrive {
    /// Checks every value.
    ///
    /// # Errors
    /// The first one out of its range.
    pub fn validate(&self) -> Result<(), DriveError> {
        let Body {
            inertia,
            viscous,
            coulomb,
        } = self.motor;
        check("motor inertia", inertia, inertia > 0.0, "above 0")?;
        check("motor viscous", viscous, viscous >= 0.0, "0 or more")?;
        check("motor coulomb", coulomb, coulomb >= 0.0, "0 or more")?;
        let least = self.load_coulomb;
        check("load coulomb", least, least >= 0.0, "0 or more")?;
        check("delay", self.delay, self.delay >= 0.0, "0 s or more")?;
        check("gap", self.gap, self.gap > 0.0, "above 0")?;
        check("torque", self.torque, self.torque > 0.0, "above 0")?;
        if let Some(sampling) = self.sampling {
            check("sampling", sampling, sampling > 0.0, "above 0 s")?;
        }
        let noise = self.velocity_noise;
        check("velocity noise", noise, noise >= 0.0, "0 or more")
    }
}

/// Proposes the relay of a drifting test, with warnings where no relay does all that it should.
///
/// # Errors
/// A value out of its range, or a motor that no relay within its torque keeps swinging.
pub fn design_drifting_test(drive: &RoughDrive) -> Result<DriftingTest, DriveError> {
    drive.validate()?;
    let mut best: Option<(f64, Candidate)> = None;
    for mut candidate in candidates(drive) {
        // Without what makes it slow, the cost is a lower bound.
        candidate.slowest = candidate.cycle.drift_velocity().abs();
        if let Some((least, _)) = &best
            && candidate.cost_besides_drift(drive) >= *least
        {
            continue;
        }
        candidate.slowest = candidate.slowest_drift(drive);
        let cost = candidate.cost(drive);
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, candidate));
        }
    }
    let (_, candidate) = best.ok_or(DriveError::Value {
        name: "torque",
        value: drive.torque,
        range: "large enough to keep the motor swinging against its friction",
    })?;
    Ok(candidate.finish(drive))
}

struct Candidate {
    relay: VelocityRelay,
    cycle: DriftingCycle,
    added: f64,
    /// Least drift velocity of a drive that is not quite as it was thought; 0 where its direction is not
    /// even known.
    slowest: f64,
}

fn candidates(drive: &RoughDrive) -> impl Iterator<Item = Candidate> + use<> {
    // The speed at which the wished swing is reached with the full torque, v^2 = a x, and around it.
    let wished = (WISHED_SWING * drive.gap * drive.torque / drive.motor.inertia).sqrt();
    let drive = *drive;
    (0..GAINS).flat_map(move |i| {
        (0..HYSTERESES).flat_map(move |j| {
            let hysteresis = wished * HYSTERESIS_RATIO.powi(j - 2 * HYSTERESES / 3);
            ASYMMETRIES.into_iter().flat_map(move |asymmetry| {
                let gain = drive.torque / (1.0 + asymmetry) / GAIN_RATIO.powi(i);
                ADDED_DELAYS.into_iter().filter_map(move |share| {
                    let added = share * drive.motor.inertia * hysteresis / gain;
                    Candidate::new(&drive, [gain, hysteresis, asymmetry], added)
                })
            })
        })
    })
}

impl Candidate {
    /// The relay with this gain, hysteresis and asymmetry; `None` where it does not keep the motor swinging.
    fn new(
        drive: &RoughDrive,
        [gain, hysteresis, asymmetry]: [f64; 3],
        added: f64,
    ) -> Option<Self> {
        let mut relay = VelocityRelay {
            relay: Relay {
                gain,
                hysteresis,
                asymmetry,
                bias: 0.0,
                delay: drive.delay + added,
            },
            flip: None,
            sampling: drive.sampling,
        };
        let mut cycle = drifting_cycle(&drive.motor, &relay)?;
        if drive.sampling.is_none() {
            // Sampling delays the switch, which makes the cycle longer: one round suffices.
            relay.sampling = Some(cycle.period / WISHED_SAMPLES);
            cycle = drifting_cycle(&drive.motor, &relay)?;
        }
        Some(Self {
            relay,
            cycle,
            added,
            slowest: 0.0,
        })
    }

    fn traverse(&self, drive: &RoughDrive) -> f64 {
        drive.gap / self.slowest
    }

    /// The least drift over inertia, friction and delay within what is known of them. A sampled relay acts
    /// up to a whole sampling time late, and may do so at every switch.
    fn slowest_drift(&self, drive: &RoughDrive) -> f64 {
        let sampling = self.relay.sampling.unwrap_or(0.0);
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for inertia in [1.0 - ROUGH_INERTIA, 1.0 + ROUGH_INERTIA] {
            for friction in [1.0 - ROUGH, 1.0 + ROUGH] {
                for delay in [
                    self.added + (1.0 - ROUGH) * drive.delay,
                    self.added + (1.0 + ROUGH) * drive.delay + sampling,
                ] {
                    let motor = Body {
                        inertia: inertia * drive.motor.inertia,
                        viscous: friction * drive.motor.viscous,
                        coulomb: friction * drive.motor.coulomb,
                    };
                    let mut relay = self.relay;
                    relay.sampling = None;
                    relay.relay.delay = delay;
                    let Some(cycle) = drifting_cycle(&motor, &relay) else {
                        return 0.0;
                    };
                    let velocity = cycle.drift_velocity();
                    range = [range[0].min(velocity), range[1].max(velocity)];
                }
            }
        }
        if range[0] * range[1] > 0.0 {
            range[0].abs().min(range[1].abs())
        } else {
            0.0
        }
    }

    fn weaker_push(&self) -> f64 {
        self.relay.relay.gain * (1.0 - self.relay.relay.asymmetry)
    }

    fn samples(&self) -> f64 {
        self.relay
            .sampling
            .map_or(f64::INFINITY, |s| self.cycle.period / s)
    }

    /// How far each demand is missed: a factor above 1 where it is.
    fn misses(&self, drive: &RoughDrive) -> [f64; 6] {
        let dry = drive.motor.coulomb + drive.load_coulomb;
        let traverse = self.traverse(drive);
        [
            self.cycle.swing / (LARGEST_SWING * drive.gap),
            traverse / LONGEST_TRAVERSE,
            FEWEST_CYCLES * self.cycle.period / traverse,
            PUSH * dry / self.weaker_push(),
            FEWEST_SAMPLES / self.samples(),
            NOISE * drive.velocity_noise / self.relay.relay.hysteresis,
        ]
    }

    /// What is missed of what must be, apart from the drift, and of what is wished for.
    fn cost_besides_drift(&self, drive: &RoughDrive) -> f64 {
        let [swing, _, _, push, samples, noise] = self.misses(drive);
        let must: f64 = [swing, push, samples, noise]
            .into_iter()
            .map(|m| libm::log(m.clamp(1.0, WORST)))
            .sum();
        let swing = libm::log(self.cycle.swing / (WISHED_SWING * drive.gap));
        let samples = libm::log((WISHED_SAMPLES / self.samples()).max(1.0));
        MUST * must + swing.powi(2) + samples.powi(2)
    }

    fn cost(&self, drive: &RoughDrive) -> f64 {
        let traverse = self.traverse(drive).min(WORST * LONGEST_TRAVERSE);
        let slow = libm::log((traverse / LONGEST_TRAVERSE).max(1.0));
        let fast = libm::log(self.misses(drive)[2].clamp(1.0, WORST));
        let wish = libm::log(traverse / WISHED_TRAVERSE);
        self.cost_besides_drift(drive) + MUST * (slow + fast) + wish.powi(2)
    }

    fn finish(mut self, drive: &RoughDrive) -> DriftingTest {
        let traverse = self.traverse(drive);
        let warnings = self.warnings(drive);
        let flip = FLIP * traverse.min(LONGEST_TRAVERSE);
        self.relay.flip = Some(flip);
        DriftingTest {
            duration: (TRAVERSES + 1) as f64 * flip,
            relay: self.relay,
            added_delay: self.added,
            cycle: self.cycle,
            traverse,
            warnings,
        }
    }

    fn warnings(&self, drive: &RoughDrive) -> Vec<Message> {
        let [swing, slow, fast, push, samples, noise] = self.misses(drive);
        let mut warnings = Vec::new();
        let mut warn = |missed: f64, text: Message| {
            if missed.is_nan() || missed > 1.0 + 1e-9 {
                warnings.push(text);
            }
        };
        warn(
            swing,
            msg!(
                "The cycle swings over {} % of the gap: it should stay below {} %. Less delay or more torque would \
                 help.",
                fixed(100.0 * self.cycle.swing / drive.gap, 1),
                fixed(100.0 * LARGEST_SWING, 0)
            ),
        );
        warn(
            slow,
            if self.traverse(drive) < 1e6 {
                msg!(
                    "The cycle may need {} s to cross the gap: friction and delay nearly cancel in their effect on \
                     the drift, or both are small.",
                    fixed(self.traverse(drive), 0)
                )
            } else {
                "The cycle may not drift: without friction and delay, or where they cancel, no asymmetry moves it."
                    .into()
            },
        );
        warn(
            fast,
            msg!(
                "The cycle crosses the gap within {} periods: too few to see where its drift changes.",
                fixed(self.traverse(drive) / self.cycle.period, 0)
            ),
        );
        warn(
            push,
            msg!(
                "The weaker push, {}, does not move motor and load against their dry friction, {}.",
                fixed(self.weaker_push(), 3),
                fixed(drive.motor.coulomb + drive.load_coulomb, 3)
            ),
        );
        warn(
            samples,
            msg!(
                "A period has only {} samples: the controller should sample every {} s.",
                fixed(self.samples(), 1),
                brief(self.cycle.period / FEWEST_SAMPLES)
            ),
        );
        warn(
            noise,
            msg!(
                "The hysteresis, {}, is less than {} times the noise of the velocity: noise will switch the relay.",
                fixed(self.relay.relay.hysteresis, 3),
                fixed(NOISE, 0)
            ),
        );
        warnings
    }
}
