//! What a parameter of an effect is: symbol, unit, range.

use std::f64::consts::TAU;

use crate::measurement::Motion;
/// Physical dimension of a parameter; its SI unit follows from the [`Motion`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Torque or force; for a process the unit of its input.
    Force,
    /// s.
    Time,
    /// Plain number.
    Ratio,
    /// kg m^2 or kg.
    Inertia,
    /// N m s/rad or N s/m.
    ViscousFriction,
    /// rad or m.
    Position,
    /// rad/s or m/s.
    Speed,
    /// N m/rad or N/m.
    Stiffness,
    /// Force per square of speed.
    Drag,
    /// Force per cube of position.
    CubicStiffness,
    /// Input of a process per square of its output.
    Loss,
    /// Input of a process per root of its output.
    Outflow,
    /// Periods of 2 pi in a unit of position: 1/rad or 1/m.
    PerPosition,
    /// An angle of a periodic function, rad.
    Phase,
    /// Force, or input, per second.
    Rise,
    /// Inverse of the unit of a process output.
    PerOutput,
    /// Inverse of the unit of the input of a process.
    PerInput,
    /// A product of powers of force, position, process output and time.
    Compound {
        /// Power of the force, or of the input of a process.
        force: i8,
        /// Power of the position.
        position: i8,
        /// Power of the output of a process.
        output: i8,
        /// Power of the time.
        time: i8,
    },
    /// A formula does not tell it.
    Undetermined,
}

impl Dimension {
    /// SI unit as files have it; [`shown_unit`](crate::uncertain::shown_unit) for a reader.
    pub const fn unit(self, motion: Motion) -> &'static str {
        match (self, motion) {
            (Self::Time, _) => "s",
            (Self::Rise, Motion::None) => "1/s",
            (Self::Force, Motion::Rotational) => "N m",
            (Self::Force, Motion::Translational) => "N",
            (Self::Inertia, Motion::Rotational) => "kg m^2",
            (Self::Inertia, Motion::Translational) => "kg",
            (Self::ViscousFriction, Motion::Rotational) => "N m s/rad",
            (Self::ViscousFriction, Motion::Translational) => "N s/m",
            (Self::Phase, _) | (Self::Position, Motion::Rotational) => "rad",
            (Self::Position, Motion::Translational) => "m",
            (Self::Speed, Motion::Rotational) => "rad/s",
            (Self::Speed, Motion::Translational) => "m/s",
            (Self::Stiffness, Motion::Rotational) => "N m/rad",
            (Self::Stiffness, Motion::Translational) => "N/m",
            (Self::Drag, Motion::Rotational) => "N m s^2/rad^2",
            (Self::Drag, Motion::Translational) => "N s^2/m^2",
            (Self::CubicStiffness, Motion::Rotational) => "N m/rad^3",
            (Self::CubicStiffness, Motion::Translational) => "N/m^3",
            (Self::PerPosition, Motion::Rotational) => "1/rad",
            (Self::PerPosition, Motion::Translational) => "1/m",
            (Self::Rise, Motion::Rotational) => "N m/s",
            (Self::Rise, Motion::Translational) => "N/s",
            (Self::Compound { .. } | Self::Undetermined, _) => "?",
            (Self::Ratio | Self::PerOutput | Self::PerInput | Self::Loss | Self::Outflow, _)
            | (_, Motion::None) => "1",
        }
    }
}

/// Values that a parameter may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Any finite value.
    Signed,
    /// 0 or more.
    NonNegative,
    /// A time by which something is late: 0 to half of the record, or it would not be seen.
    Late,
    /// Above 0: at least `LEAST_SHARE` of its [`Scales::of`].
    Positive,
    /// -0.9 to 0.9.
    Fraction,
    /// 0 to 1.
    UnitInterval,
    /// The same of a dry contact that sticks, where it swings for less than the record shows.
    OfContact,
    /// Up to `STIFFEST` times its [`Scales::of`], and so stiff that the body swings within the record.
    Stiff,
    /// The same up to `HARDEST` times it: a contact may well be over between two samples.
    Hard,
    /// At least `LIGHTEST` times its [`Scales::of`].
    Sizeable,
    /// `RIGID_CROSSINGS` to `SHORT_CROSSINGS` times [`Scales::crossed`], or as far as the position is blurred.
    Short,
    /// At least `RIGID_CROSSINGS` times [`Scales::crossed`], at most the travel: friction that built up over more
    /// would be a spring.
    Long,
    /// A period that the record holds `SEEN_PERIODS` times at least, and of two samples at least.
    Recurring,
    /// At least `SEEN_TURN` times its [`Scales::of`]: what repeats over the position is seen to do so within the
    /// travel.
    Repeating,
}

impl Range {
    /// What a value would have to be, if it cannot be in the range whatever the sizes of the experiment.
    pub fn refuses(self, value: f64) -> Option<&'static str> {
        let (right, wanted) = match self {
            Self::Signed => (value.is_finite(), "finite"),
            Self::NonNegative | Self::Late => (value >= 0.0, "at least 0"),
            Self::Fraction => ((-0.9..=0.9).contains(&value), "between -0.9 and 0.9"),
            Self::UnitInterval | Self::OfContact => {
                ((0.0..=1.0).contains(&value), "between 0 and 1")
            }
            _ => (value > 0.0, "above 0"),
        };
        (!right).then_some(wanted)
    }
}

/// A parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSpec {
    /// Symbol, such as `c`.
    pub symbol: &'static str,
    /// Plain words, such as `friction level`.
    pub label: &'static str,
    /// Dimension, from which the unit follows.
    pub dimension: Dimension,
    /// Values that it may take.
    pub range: Range,
}

/// A displacement counts as short up to this many times that which a sample crosses after a reversal:
/// more than that can be seen building up sample by sample.
pub const SHORT_CROSSINGS: f64 = 8.0;

/// Nor can it be seen within this many times the noise of the position.
pub const BLURRED: f64 = 1.0;

/// Below this share of it the contact cannot be told from a rigid one: the impulse that friction lacks while it builds
/// up goes with the root of it, and adds up from turn to turn.
pub const RIGID_CROSSINGS: f64 = 1e-4;

/// Share of it at which a search begins with a contact that is all but rigid.
pub const HARD_CROSSINGS: f64 = 0.003;

/// A spring that swings by more than this in a sample, squared radians, is rigid to the measurement.
pub const STIFFEST: f64 = 0.3;

/// A contact that swings by more than this in a sample, squared radians, is an impact.
pub const HARDEST: f64 = 300.0;

/// A load lighter than this share of the motor is part of it.
pub const LIGHTEST: f64 = 0.03;

/// Radians in the travel from which a periodic force is seen to repeat, a turn and a half; less of it may look like any
/// other force.
pub const SEEN_TURN: f64 = 1.5 * TAU;

/// Periods in a record from which on something is seen to come back: once may be chance, and a slow one any drift.
pub const SEEN_PERIODS: f64 = 3.0;

/// A wave within this factor of the longest is at the end of its range.
const AT_END: f64 = 1.001;

/// The longest period that is seen to recur, s.
fn longest_period(scales: &Scales) -> f64 {
    scales.duration / SEEN_PERIODS
}

/// Share of the travel from which on a displacement is most of the way.
const MOST_OF_THE_WAY: f64 = 0.3;

/// Share of the record after which nothing is late any more.
const LATEST: f64 = 0.5;

/// Smallest share of its typical size that a positive parameter may take: too small to be seen.
pub const LEAST_SHARE: f64 = 1e-4;

impl ParameterSpec {
    /// Whether it only says how a hard contact builds up its force, between two samples or nearly so.
    pub fn is_of_contact(&self) -> bool {
        matches!(self.range, Range::Short | Range::OfContact)
    }

    /// Whether the parameter is a size, which changes by factors rather than by differences.
    pub fn is_size(&self) -> bool {
        matches!(
            self.range,
            Range::Positive
                | Range::Stiff
                | Range::Hard
                | Range::Sizeable
                | Range::Short
                | Range::Long
                | Range::Recurring
                | Range::Repeating
        )
    }

    /// Whether a wave is at the end of its range, so that the record shows too little of it to tell that it repeats, or
    /// a displacement over which friction builds up is most of the way, so that it may as well be a spring.
    pub fn is_too_long(&self, value: f64, scales: &Scales) -> bool {
        match self.range {
            Range::Repeating => value <= AT_END * (SEEN_TURN * scales.of(self.dimension)),
            Range::Recurring => value * AT_END >= longest_period(scales),
            Range::Long => value >= MOST_OF_THE_WAY * scales.travel,
            _ => false,
        }
    }

    /// `value` moved into the range.
    pub fn clamp(&self, value: f64, scales: &Scales) -> f64 {
        let scale = scales.of(self.dimension);
        match self.range {
            Range::Signed => value,
            Range::NonNegative => value.max(0.0),
            Range::Late => value.clamp(0.0, LATEST * scales.duration),
            Range::Positive => value.max(LEAST_SHARE * scale),
            Range::Fraction => value.clamp(-0.9, 0.9),
            Range::UnitInterval | Range::OfContact => value.clamp(0.0, 1.0),
            Range::Stiff | Range::Hard => {
                let most = if self.range == Range::Stiff {
                    STIFFEST
                } else {
                    HARDEST
                };
                let slowest = scales.inertia.abs() / (scales.duration * scales.duration);
                value.max(slowest).min((most * scale).max(slowest))
            }
            Range::Sizeable => value.max(LIGHTEST * scale),
            Range::Short => {
                let crossed = scales.crossed();
                let longest = (SHORT_CROSSINGS * crossed).max(BLURRED * scales.resolution);
                value.clamp(RIGID_CROSSINGS * crossed, longest)
            }
            Range::Long => {
                let least = RIGID_CROSSINGS * scales.crossed();
                value.max(least).min(scales.travel.max(least))
            }
            Range::Recurring => value.max(2.0 * scales.step).min(longest_period(scales)),
            Range::Repeating => value.max(SEEN_TURN * scale),
        }
    }
}

/// Typical sizes of one experiment, from which effects take their starting values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Mean sampling time, s.
    pub step: f64,
    /// Length of the record, s.
    pub duration: f64,
    /// Root mean square of the input about its mean.
    pub force: f64,
    /// Inertia of the baseline fit.
    pub inertia: f64,
    /// Factor of it within which that of a model stays.
    pub inertia_factor: f64,
    /// Viscous friction of the baseline fit.
    pub viscous: f64,
    /// Root mean square of the velocity, or of a process output, about its mean.
    pub speed: f64,
    /// Range of the position over the whole record.
    pub travel: f64,
    /// Standard deviation of the noise of the position; 0 where it is not measured.
    pub resolution: f64,
    /// Time constant of the baseline fit, s.
    pub time_constant: f64,
}

impl Scales {
    /// Displacement of the body in one sample after a reversal, under the typical force.
    pub fn crossed(&self) -> f64 {
        (self.force / self.inertia).abs() * self.step * self.step
    }

    /// Typical size of a quantity of this dimension.
    pub fn of(&self, dimension: Dimension) -> f64 {
        match dimension {
            Dimension::Force => self.force,
            Dimension::Time => self.step,
            Dimension::Inertia => self.inertia.abs(),
            Dimension::ViscousFriction => self.viscous.abs(),
            Dimension::Position => self.travel,
            Dimension::Speed => self.speed,
            Dimension::Stiffness => self.inertia.abs() / (self.step * self.step),
            Dimension::Drag | Dimension::Loss => self.force / (self.speed * self.speed),
            Dimension::CubicStiffness => self.force / self.travel.powi(3),
            Dimension::Outflow => self.force / self.speed.sqrt(),
            Dimension::PerPosition => 1.0 / self.travel,
            Dimension::Ratio | Dimension::Phase | Dimension::Undetermined => 1.0,
            Dimension::Compound {
                force,
                position,
                output,
                time,
            } => {
                let period = (self.step * self.duration).sqrt();
                [
                    (self.force, force),
                    (self.travel, position),
                    (self.speed, output),
                    (period, time),
                ]
                .into_iter()
                .map(|(size, power)| size.powi(i32::from(power)))
                .product()
            }
            Dimension::Rise => self.force / self.duration,
            Dimension::PerOutput => 1.0 / self.speed,
            Dimension::PerInput => 1.0 / self.force,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_may_swing_slowly_however_fast_the_samples_come() {
        let stiffness = ParameterSpec {
            symbol: "K",
            label: "stiffness of the joint",
            dimension: Dimension::Stiffness,
            range: Range::Stiff,
        };
        for step in [2e-5, 2e-4, 2e-3] {
            let scales = Scales {
                step,
                duration: 2.0,
                inertia: 1e-3,
                inertia_factor: 1e4,
                viscous: 1e-3,
                force: 0.1,
                speed: 1.0,
                travel: 1.0,
                resolution: 0.0,
                time_constant: 1.0,
            };
            // 2 Hz
            let soft = scales.inertia * (2.0 * TAU).powi(2);
            assert_eq!(stiffness.clamp(soft, &scales), soft, "{step}");
            let rigid = stiffness.clamp(1e9, &scales);
            assert!(rigid * step * step < 0.5 * scales.inertia, "{step}");
            assert!(stiffness.clamp(0.0, &scales) > 0.0);
        }
    }
}
