//! The benches on which a mystery is measured.

use super::experiment::Experiment;
use super::record::{INPUT_STEP, VELOCITY_STEP};
use crate::measurement::Measurement;
use crate::rig::process::{self, ProcessRig};
use crate::rig::{self, DriveRig, ENCODER, Excitation, Random, carried_over, drifting};

/// Length of a record: of a drive, of a process.
const SAMPLES: usize = 8000;
const SAMPLES_PROCESS: usize = 2000;

/// Time after which the drift turns round, s, and how far the motor shall come: beyond every gap of the menu, rad.
const FLIP: f64 = 0.8;
const TRAVEL: f64 = 0.012;

impl Experiment {
    /// A bench of its own kind, where nothing is hidden yet.
    pub(super) fn bench(self, random: &mut Random) -> Bench {
        let drive = |excitation, random: &mut Random| {
            Bench::Drive(DriveRig {
                seed: random.seed(),
                excitation,
                samples: SAMPLES,
                encoder: ENCODER,
                input_step: INPUT_STEP,
                velocity_step: VELOCITY_STEP,
                inertia: 8.8e-4 * random.between(0.9, 1.1),
                viscous: 2e-3 * random.between(0.8, 1.2),
                ..DriveRig::default()
            })
        };
        let process = |excitation, random: &mut Random| {
            Bench::Process(ProcessRig {
                seed: random.seed(),
                excitation,
                samples: SAMPLES_PROCESS,
                gain: 2.0 * random.between(0.9, 1.1),
                time_constant: 30.0 * random.between(0.85, 1.15),
                ..ProcessRig::default()
            })
        };
        match self {
            Self::Relay => drive(rig::relay(0.1), random),
            Self::Sines => drive(Excitation::Multisine { amplitude: 0.08 }, random),
            Self::Stairs => drive(Excitation::Staircase { top: 0.3 }, random),
            Self::Drifting => drive(drifting(FLIP), random),
            Self::ProcessRelay => {
                let (gain, hysteresis) = (1.0, 0.1);
                process(process::Excitation::Relay { gain, hysteresis }, random)
            }
            Self::ProcessStairs => process(process::Excitation::Staircase { top: 1.0 }, random),
            Self::ProcessBinary => process(process::Excitation::Binary { level: 1.0 }, random),
        }
    }
}

/// What the experiment runs on.
pub(super) enum Bench {
    Drive(DriveRig),
    Process(ProcessRig),
}

impl Bench {
    /// Symbols and values of the simplest model, SI.
    pub fn baseline(&self) -> [(String, f64); 2] {
        let named = match self {
            Self::Drive(rig) => [("J1", rig.inertia), ("d1", rig.viscous)],
            Self::Process(rig) => [("K", rig.gain), ("T", rig.time_constant)],
        };
        named.map(|(symbol, value)| (symbol.to_owned(), value))
    }

    /// Runs the experiment.
    pub fn measure(self, experiment: Experiment) -> Measurement {
        match self {
            Self::Process(rig) => rig.measure(),
            // Whether there is a gap or not: else the relay would tell.
            Self::Drive(rig) if experiment == Experiment::Drifting => {
                carried_over(&rig, TRAVEL, FLIP, |rig| rig).measure()
            }
            Self::Drive(rig) => rig.measure(),
        }
    }
}
