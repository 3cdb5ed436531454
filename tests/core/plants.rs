//! Equations (1) and (2): one plant in three forms, its poles, zeros, gain and phase; the relay.

use std::f64::consts::PI;

use hysteron_core::plant::{PlantError, StateSpace, TransferFunction, ZeroPoleGain};
use hysteron_core::relay::Relay;
use nalgebra::{Complex, DMatrix, DVector};

type C = Complex<f64>;

fn real(values: &[f64]) -> Vec<C> {
    values.iter().map(|v| C::new(*v, 0.0)).collect()
}

fn pair(re: f64, im: f64) -> [C; 2] {
    [C::new(re, im), C::new(re, -im)]
}

/// Order 12, relative degree 9, poles over two decades.
fn large() -> ZeroPoleGain {
    let mut poles = real(&[-0.1, -0.35, -1.0, -2.2, -4.0, -7.5]);
    poles.extend(pair(-0.3, 0.9));
    poles.extend(pair(-1.5, 3.0));
    poles.extend(pair(-5.0, 6.0));
    ZeroPoleGain {
        zeros: real(&[-0.6, 2.0, -9.0]),
        poles,
        gain: -31.0,
        dead_time: 0.4,
    }
}

/// `C (jw - A)^-1 B`, by a solution of linear equations.
fn response(plant: &StateSpace, omega: f64) -> C {
    let n = plant.b.len();
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { omega } else { 0.0 };
        C::new(-plant.a[(i, j)], own)
    });
    let b = DVector::from_fn(n, |i, _| C::new(plant.b[i], 0.0));
    let x = matrix.lu().solve(&b).unwrap();
    (0..n).map(|i| x[i] * plant.c[i]).sum()
}

fn product(plant: &ZeroPoleGain, omega: f64) -> C {
    let s = C::new(0.0, omega);
    let zeros: C = plant.zeros.iter().map(|z| s - z).product();
    let poles: C = plant.poles.iter().map(|p| s - p).product();
    plant.gain * zeros / poles * C::from_polar(1.0, -omega * plant.dead_time)
}

#[test]
fn equation_1_three_forms_are_one_plant() {
    let factors = large();
    let ratio = factors.transfer_function().unwrap();
    let space = StateSpace::try_from(&ratio).unwrap();
    let back = space.transfer_function(factors.dead_time).unwrap();
    for k in 0..60 {
        let omega = 1e-2 * 1.2_f64.powi(k);
        let exact = product(&factors, omega);
        let delay = C::from_polar(1.0, -omega * factors.dead_time);
        for (form, value) in [
            ("ratio of polynomials", ratio.response(omega)),
            ("state space", response(&space, omega) * delay),
            ("back from state space", back.response(omega)),
        ] {
            let error = (value - exact).norm() / exact.norm();
            assert!(error < 1e-9, "{form} at {omega} rad/s: off by {error:e}");
        }
    }
}

#[test]
fn equation_1_poles_and_zeros_come_back_from_polynomials() {
    let factors = large();
    let ratio = factors.transfer_function().unwrap();
    for (given, found) in [
        (&factors.poles, ratio.poles()),
        (&factors.zeros, ratio.zeros()),
    ] {
        assert_eq!(given.len(), found.len());
        for root in given {
            let near = found
                .iter()
                .map(|f| (f - root).norm())
                .fold(f64::MAX, f64::min);
            assert!(near < 1e-8 * root.norm(), "{root}: nearest {near:e} away");
        }
    }
}

#[test]
fn equation_1_gain_at_rest_and_relative_degree() {
    let ratio = TransferFunction::new(&[0.0, 4.0, 6.0], &[1.0, 2.0, 3.0, 2.0], 1.0);
    assert!((ratio.dc_gain() - 3.0).abs() < 1e-15);
    assert_eq!(ratio.relative_degree(), 2);
    let space = StateSpace::try_from(&ratio).unwrap();
    assert!((space.dc_gain() - 3.0).abs() < 1e-14);
    let integrator = TransferFunction::new(&[-2.0], &[1.0, 1.0, 0.0], 0.0);
    assert_eq!(integrator.dc_gain(), f64::NEG_INFINITY);
}

#[test]
fn phase_runs_on_through_integrators_dead_time_and_right_half_plane_zeros() {
    type Phase = fn(f64) -> f64;
    let cases: [(&str, TransferFunction, Phase); 4] = [
        (
            "double integrator, lag and dead time",
            TransferFunction::new(&[5.0], &[1.0, 1.0, 0.0, 0.0], 2.0),
            |w| -PI - w.atan() - 2.0 * w,
        ),
        (
            "right-half-plane zero",
            TransferFunction::new(&[-1.0, 1.0], &[1.0, 2.0, 1.0], 0.0),
            |w| -3.0 * w.atan(),
        ),
        (
            "five lags",
            TransferFunction::new(&[1.0], &[1.0, 5.0, 10.0, 10.0, 5.0, 1.0], 0.0),
            |w| -5.0 * w.atan(),
        ),
        (
            "resonance",
            TransferFunction::new(&[1.0], &[1.0, 0.02, 1.0], 0.0),
            |w| -(0.02 * w).atan2(1.0 - w * w),
        ),
    ];
    for (name, plant, exact) in cases {
        let plant = plant.zero_pole_gain().unwrap();
        for k in 0..90 {
            let omega = 1e-2 * 1.12_f64.powi(k);
            let (found, exact) = (plant.phase(omega), exact(omega));
            // A fivefold pole is found to the fifth root of round-off only; its phase suffers less.
            assert!(
                (found - exact).abs() < 1e-8 * (1.0 + exact.abs()),
                "{name} at {omega} rad/s: {found} rad, exactly {exact}"
            );
        }
    }
}

#[test]
fn phase_never_jumps_and_agrees_with_the_response() {
    let plant = large();
    let ratio = plant.transfer_function().unwrap();
    let mut last: Option<f64> = None;
    for k in 0..4000 {
        let omega = 1e-2 * 1.002_f64.powi(k);
        let phase = plant.phase(omega);
        let turned = ratio.response(omega) * C::from_polar(1.0, -phase);
        assert!(
            turned.arg().abs() < 1e-7,
            "{omega}: off by {}",
            turned.arg()
        );
        if let Some(last) = last {
            assert!((phase - last).abs() < 0.2, "a jump at {omega} rad/s");
        }
        last = Some(phase);
    }
}

#[test]
fn plants_that_cannot_be_say_why() {
    let refused = |numerator: &[f64], denominator: &[f64], dead_time: f64| {
        TransferFunction::new(numerator, denominator, dead_time)
            .validate()
            .unwrap_err()
    };
    assert_eq!(
        refused(&[1.0], &[f64::NAN, 1.0], 0.0),
        PlantError::NotFinite
    );
    assert_eq!(refused(&[1.0], &[1.0; 14], 0.0), PlantError::Order(13));
    assert_eq!(refused(&[0.0], &[1.0, 1.0], 0.0), PlantError::NoNumerator);
    assert_eq!(
        refused(&[1.0], &[1.0, 1.0], -1.0),
        PlantError::DeadTime(-1.0)
    );
    assert!(
        refused(&[1.0, 0.0], &[1.0, 1.0], 0.0)
            .to_string()
            .contains("must be lower")
    );
}

#[test]
fn equation_2_pushes_against_the_output() {
    let relay = Relay {
        gain: 2.0,
        asymmetry: 0.25,
        ..Relay::default()
    };
    // u = k(1+a) while h = -1, u = -k(1-a) while h = +1.
    assert_eq!(relay.output(false), 2.5);
    assert_eq!(relay.output(true), -1.5);
    let biased = Relay {
        bias: 0.5,
        asymmetry: 0.0,
        ..relay
    };
    assert_eq!([biased.output(false), biased.output(true)], [2.5, -1.5]);
}

#[test]
fn equation_6_is_the_first_harmonic_of_equation_2() {
    let relay = Relay {
        gain: 1.7,
        hysteresis: 0.3,
        ..Relay::default()
    };
    for amplitude in [0.31, 0.5, 1.0, 4.0] {
        // First harmonic of h for y = a sin(x), summed between the switches at +-asin(eps/a).
        let late = (relay.hysteresis / amplitude).asin();
        let steps = 20_000;
        let mut harmonic = C::new(0.0, 0.0);
        for i in 0..steps {
            let x = 2.0 * PI * (f64::from(i) + 0.5) / f64::from(steps);
            let high = x > late && x < PI + late;
            let h = if high { relay.gain } else { -relay.gain };
            harmonic += h * C::from_polar(2.0 / f64::from(steps), -x);
        }
        // y = a sin(x) has the first harmonic -j a.
        let n = harmonic / C::new(0.0, -amplitude);
        let exact = -1.0 / n;
        let [re, im] = relay.inverse_describing_function(amplitude);
        assert!(
            (C::new(re, im) - exact).norm() < 1e-3 * exact.norm(),
            "{re} {im} {exact}"
        );
    }
}
