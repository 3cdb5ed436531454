//! The simulated drive against drives that were measured on a rig of other physics: bristle friction, a
//! sampled relay, an encoder, noise. What the rig hides is known here, and nothing is fitted.

use hysteron_core::drive::{
    Adhesion, Body, Command, Contact, Drive, DriveInput, VelocityRelay, drifting_cycle, run,
};
use hysteron_core::measurement::{Measurement, Quantity, import_csv};
use hysteron_core::relay::Relay;

/// The controller's sampling time, s.
const SAMPLING: f64 = 2e-4;

fn motor(coulomb: f64) -> Body {
    Body {
        inertia: 8.8e-4,
        viscous: 2e-3,
        coulomb,
    }
}

fn measured(name: &str, bytes: &[u8]) -> Measurement {
    import_csv(name, bytes, None).unwrap()
}

fn relay(asymmetry: f64, delay: f64) -> VelocityRelay {
    VelocityRelay {
        relay: Relay {
            gain: 0.5,
            hysteresis: 0.5,
            asymmetry,
            delay,
            ..Relay::default()
        },
        flip: None,
        sampling: Some(SAMPLING),
    }
}

/// Period and drift velocity of the motor in its gap, with standard errors from the scatter of cycles.
#[derive(Debug)]
struct Cycles {
    period: [f64; 2],
    drift: [f64; 2],
}

/// Mean and standard error of groups of cycles: a sampled relay repeats itself over several cycles.
const GROUP: usize = 10;

fn cycles(time: &[f64], input: &[f64], position: &[f64], from: f64, to: f64) -> Cycles {
    let rises: Vec<usize> = (1..time.len())
        .filter(|i| time[*i] > from && time[*i] < to && input[*i] < 0.0 && input[i - 1] > 0.0)
        .collect();
    let groups: Vec<[f64; 2]> = rises
        .chunks_exact(GROUP)
        .zip(rises.chunks_exact(GROUP).skip(1))
        .map(|(a, b)| {
            let span = time[b[0]] - time[a[0]];
            [
                span / GROUP as f64,
                (position[b[0]] - position[a[0]]) / span,
            ]
        })
        .collect();
    let statistics = |k: usize| {
        let n = groups.len() as f64;
        let mean = groups.iter().map(|g| g[k]).sum::<f64>() / n;
        let square = groups.iter().map(|g| (g[k] - mean).powi(2)).sum::<f64>();
        [mean, (square / (n - 1.0) / n).sqrt()]
    };
    Cycles {
        period: statistics(0),
        drift: statistics(1),
    }
}

fn of_measurement(m: &Measurement, from: f64, to: f64) -> Cycles {
    let position = &m.output(Quantity::Position).unwrap().values;
    cycles(&m.time, &m.input.values, position, from, to)
}

fn of_simulation(motor: Body, relay: VelocityRelay) -> Cycles {
    let drive = Drive {
        motor,
        load: motor,
        half_gap: 10.0,
        contact: Contact::Rigid { restitution: 1.0 },
        adhesion: Adhesion::default(),
    };
    let done = run(&DriveInput::new(
        drive,
        Command::Relay(relay),
        2.0,
        Some(SAMPLING),
    ))
    .unwrap();
    cycles(&done.time, &done.input, &done.x1, 0.0, 2.0)
}

/// Whether a value lies within three standard errors of what was measured.
#[track_caller]
fn within_noise([measured, error]: [f64; 2], value: f64) {
    assert!(
        (value - measured).abs() <= 3.0 * error,
        "{value}, measured {measured} +- {error}"
    );
}

/// Stretches of the drifting tests in which the motor is inside its gap, s.
const FREE: [(f64, f64); 4] = [(0.05, 2.1), (3.05, 5.95), (6.05, 8.4), (9.05, 11.95)];

#[test]
fn the_drift_in_the_gap_of_drive_03_is_that_of_the_closed_form() {
    let m = measured(
        "drive-03",
        include_bytes!("../../assets/measurements/drive-03.csv"),
    );
    for (i, (from, to)) in FREE.into_iter().enumerate() {
        let found = of_measurement(&m, from, to);
        let asymmetry = if i % 2 == 0 { 0.15 } else { -0.15 };
        let cycle = drifting_cycle(&motor(0.03), &relay(asymmetry, 0.0)).unwrap();
        within_noise(found.drift, cycle.drift_velocity());
        // The mean delay of half a sampling time is a mean; the period differs by less than a tenth of a sample.
        assert!((found.period[0] - cycle.period).abs() < 0.1 * SAMPLING);
        // Late by half a sample, it drifts with the stronger push in spite of its friction; without
        // that delay it would drift against it.
        assert!(found.drift[0] * asymmetry > 0.0);
        let prompt = VelocityRelay {
            sampling: None,
            ..relay(asymmetry, 0.0)
        };
        assert!(drifting_cycle(&motor(0.03), &prompt).unwrap().drift * asymmetry < 0.0);
    }
}

#[test]
fn the_drift_of_drive_10_without_friction_is_that_of_its_sampling_alone() {
    let m = measured(
        "drive-10",
        include_bytes!("../../assets/measurements/drive-10.csv"),
    );
    for (from, to, asymmetry) in [(0.05, 0.45, 0.15), (9.05, 9.9, -0.15)] {
        let found = of_measurement(&m, from, to);
        let simulated = of_simulation(motor(0.0), relay(asymmetry, 0.0));
        let error = found.drift[1].hypot(simulated.drift[1]);
        within_noise([found.drift[0], error], simulated.drift[0]);
        assert!((found.period[0] - simulated.period[0]).abs() < 0.02 * SAMPLING);
    }
}

/// A relay that looks every 0.2 ms locks its cycle to whole samples: 20 of them, where a relay that looks
/// all the time would have a period of 17.8 or 17.9.
#[test]
fn a_sampled_relay_locks_the_period_as_the_rig_does() {
    for (name, bytes, coulomb) in [
        (
            "drive-01",
            include_bytes!("../data/drive-01.csv").as_slice(),
            0.0,
        ),
        (
            "drive-02",
            include_bytes!("../data/drive-02.csv").as_slice(),
            0.04,
        ),
    ] {
        let found = of_measurement(&measured(name, bytes), 0.0, 2.0);
        let simulated = of_simulation(motor(coulomb), relay(0.1, 0.0));
        assert!(
            (found.period[0] / simulated.period[0] - 1.0).abs() < 2e-4,
            "{found:?} {simulated:?}"
        );
        assert!((simulated.period[0] / (20.0 * SAMPLING) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn late_drives_drift_with_the_stronger_push_as_fast_as_simulated() {
    for (name, bytes, coulomb, delay) in [
        (
            "drive-04",
            include_bytes!("../data/drive-04.csv").as_slice(),
            0.0,
            8e-4,
        ),
        (
            "drive-12",
            include_bytes!("../data/drive-12.csv").as_slice(),
            0.05,
            6e-4,
        ),
    ] {
        let found = of_measurement(&measured(name, bytes), 0.0, 2.0);
        let cycle = drifting_cycle(&motor(coulomb), &relay(0.1, delay)).unwrap();
        assert!(
            (found.period[0] / cycle.period - 1.0).abs() < 0.01,
            "{found:?}"
        );
        // Locked to its samples, the drift may be off by a tenth; its direction may not.
        assert!(
            (found.drift[0] / cycle.drift_velocity() - 1.0).abs() < 0.1,
            "{found:?}"
        );
    }
}
