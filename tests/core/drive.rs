//! The drive with a hidden gap: energy, momentum, the drift formula, and the two contact models.

use hysteron_core::drive::{
    Adhesion, Body, Command, Contact, Drive, DriveInput, DriveRun, EventKind, Start, VelocityRelay,
    drift_formula, drifting_cycle, run,
};
use hysteron_core::relay::Relay;

/// The reference rig: 2 beta = 0.019 rad.
fn rig() -> Drive {
    Drive {
        motor: Body {
            inertia: 8.8e-4,
            viscous: 2e-3,
            coulomb: 0.03,
        },
        load: Body {
            inertia: 8.8e-4,
            viscous: 0.0,
            coulomb: 0.01,
        },
        half_gap: 0.0095,
        contact: Contact::Rigid { restitution: 1.0 },
        adhesion: Adhesion::default(),
    }
}

fn frictionless(inertia: f64) -> Body {
    Body {
        inertia,
        viscous: 0.0,
        coulomb: 0.0,
    }
}

fn velocity_relay(asymmetry: f64, delay: f64) -> VelocityRelay {
    VelocityRelay {
        relay: Relay {
            gain: 0.5,
            hysteresis: 0.5,
            asymmetry,
            delay,
            ..Relay::default()
        },
        flip: None,
        sampling: None,
    }
}

fn drifting() -> Command {
    Command::Relay(VelocityRelay {
        flip: Some(3.0),
        ..velocity_relay(0.3, 0.0)
    })
}

#[track_caller]
fn close(value: f64, exact: f64, tolerance: f64) {
    let error = (value - exact).abs();
    assert!(
        error <= tolerance * exact.abs(),
        "{value}, exact {exact}: off by {:e}",
        error / exact.abs()
    );
}

#[test]
fn energy_and_momentum_are_kept_over_ten_thousand_elastic_impacts() {
    let drive = Drive {
        motor: frictionless(8.8e-4),
        load: frictionless(2.3e-3),
        ..rig()
    };
    let input = DriveInput {
        start: Start {
            v1: 1.0,
            v2: -0.3,
            ..Start::default()
        },
        ..DriveInput::new(drive, Command::Torque(0.0), 160.0, None)
    };
    let done = run(&input).unwrap();
    assert!(done.impacts() >= 10_000, "{}", done.impacts());
    let (energy, momentum) = (drive.kinetic_energy(1.0, -0.3), drive.momentum(1.0, -0.3));
    for event in &done.events {
        close(drive.kinetic_energy(event.v1, event.v2), energy, 1e-10);
        close(drive.momentum(event.v1, event.v2), momentum, 1e-10);
    }
    // Without force the relative speed stays, so that impacts are 2 beta / 1.3 s apart.
    let times: Vec<f64> = done.events.iter().map(|e| e.time).collect();
    close(times[9_999] - times[0], 9_999.0 * 0.019 / 1.3, 1e-10);
}

/// `supplied = heat + kinetic`, with every mechanism at work.
fn balance(input: &DriveInput) -> DriveRun {
    let done = run(input).unwrap();
    let turned_over = done.energy.coulomb + done.energy.viscous + done.energy.contact.abs();
    assert!(
        done.energy.residual().abs() < 1e-10 * turned_over,
        "{:?}",
        done.energy
    );
    assert_eq!(done.chattering, None);
    done
}

#[test]
fn every_loss_is_booked() {
    for restitution in [0.0, 0.3, 0.7, 1.0] {
        let drive = Drive {
            half_gap: 0.001,
            contact: Contact::Rigid { restitution },
            ..rig()
        };
        let done = balance(&DriveInput::new(drive, drifting(), 6.0, None));
        assert!(done.impacts() > 50, "{restitution}: {}", done.impacts());
        assert!(done.energy.contact >= -1e-12);
    }
    for damping in [0.0, 0.2, 1.0] {
        let contact = Contact::Compliant {
            stiffness: 1000.0,
            damping,
        };
        let drive = Drive {
            half_gap: 0.001,
            contact,
            ..rig()
        };
        balance(&DriveInput::new(drive, drifting(), 6.0, None));
    }
}

#[test]
fn the_drift_formula_is_what_the_simulation_does() {
    for (coulomb, asymmetry, delay) in [
        (0.03, 0.15, 0.0),
        (0.0, 0.15, 0.4e-3),
        (0.03, 0.15, 0.2e-3),
        (0.05, -0.3, 0.7e-3),
        (0.0, 0.15, 0.0),
    ] {
        let relay = velocity_relay(asymmetry, delay);
        let motor = Body {
            coulomb,
            ..frictionless(8.8e-4)
        };
        let push = [0.5 * (1.0 + asymmetry), 0.5 * (1.0 - asymmetry)];
        let [period, drift] = drift_formula(motor.inertia, coulomb, push, 0.5, delay);
        let (simulated_period, simulated_drift) = drift_of(&motor, relay);
        close(simulated_period, period, 1e-9);
        // Where nothing drifts the swing is the measure.
        let measure = drift.abs().max(1e-3 * 4.4e-4);
        assert!(
            (simulated_drift - drift).abs() < 1e-9 * measure,
            "{simulated_drift} {drift}"
        );
        let cycle = drifting_cycle(&motor, &relay).unwrap();
        close(cycle.period, period, 1e-12);
        assert!((cycle.drift - drift).abs() < 1e-12 * measure);
    }
}

#[test]
fn the_cycle_with_viscous_friction_is_what_the_simulation_does() {
    for viscous in [1e-8, 2e-3, 0.1, 0.3] {
        let motor = Body {
            viscous,
            ..rig().motor
        };
        let relay = velocity_relay(0.15, 0.3e-3);
        let cycle = drifting_cycle(&motor, &relay).unwrap();
        let (period, drift) = drift_of(&motor, relay);
        close(period, cycle.period, 1e-9);
        close(drift, cycle.drift, 1e-9);
    }
}

/// Period and drift between late switches of a motor far from any contact.
fn drift_of(motor: &Body, relay: VelocityRelay) -> (f64, f64) {
    let drive = Drive {
        motor: *motor,
        half_gap: 10.0,
        ..rig()
    };
    let done = run(&DriveInput::new(drive, Command::Relay(relay), 1.0, None)).unwrap();
    let switches: Vec<_> = done
        .events
        .iter()
        .filter(|e| e.kind == EventKind::SwitchUp)
        .collect();
    let (a, b) = (switches[20], switches[70]);
    ((b.time - a.time) / 50.0, (b.x1 - a.x1) / 50.0)
}

#[test]
fn the_direction_of_drift_tells_which_effect_is_missing() {
    let drift = |coulomb, delay| {
        let motor = Body {
            coulomb,
            ..frictionless(8.8e-4)
        };
        drift_of(&motor, velocity_relay(0.15, delay)).1
    };
    assert!(
        drift(0.03, 0.0) < -1e-6,
        "friction: against the stronger push"
    );
    assert!(drift(0.0, 0.3e-3) > 1e-6, "delay: with the stronger push");
    assert!(drift(0.0, 0.0).abs() < 1e-15, "neither: it stays");
}
