//! The describing function, equations (5) and (6), and how far it can be trusted.

use std::f64::consts::PI;

use hysteron_core::limit_cycle::{
    Intersection, describing_function, exact_cycle, existence, harmonics, predict,
};
use hysteron_core::plant::{TransferFunction, parse};
use hysteron_core::relay::Relay;
use hysteron_core::simulate::simulate;
use nalgebra::Complex;

fn relay(gain: f64, hysteresis: f64) -> Relay {
    Relay {
        gain,
        hysteresis,
        ..Relay::default()
    }
}

fn close(what: &str, value: f64, exact: f64, tolerance: f64) {
    assert!(
        (value - exact).abs() <= tolerance * exact.abs(),
        "{what}: {value}, exact {exact}"
    );
}

/// `N(a) P(jw) + 1`, with `N(a)` by equation (5), written down again.
fn balance(plant: &TransferFunction, relay: &Relay, at: &Intersection) -> f64 {
    let (a, eps) = (at.cycle.amplitude, relay.hysteresis);
    let size = 4.0 * relay.gain / (PI * a);
    let n = Complex::new(size * (1.0 - (eps / a).powi(2)).sqrt(), -size * eps / a);
    let p = plant.response(at.omega) * Complex::from_polar(1.0, -at.omega * relay.delay);
    (n * p + 1.0).norm()
}

#[test]
fn equation_5_balances_at_every_intersection() {
    for text in [
        "1/(s+1)^3",
        "1/(s+1)^4",
        "2 e^{-s}/(3s+1)",
        "1/(s(s+1)(s+2))",
        "(1-s)/(s+1)^2",
        "1/(s+1)^12",
        "(s+1)^2/s^3",
        "e^{-2s}/(s^2+0.05s+1)",
        "1/((s^2+0.001s+1)(s+1))",
    ] {
        let plant = parse(text).unwrap();
        for eps in [0.0, 0.05] {
            let relay = relay(1.0, eps);
            let found = describing_function(&plant, &relay);
            assert!(!found.is_empty(), "{text} {eps}");
            for at in &found {
                assert!(balance(&plant, &relay, at) < 1e-9, "{text} {eps} {at:?}");
            }
        }
    }
}

#[test]
fn ultimate_frequencies_in_closed_form() {
    // 1/(s+1)^n: -180 degrees at w = tan(180/n), where the modulus is cos(180/n)^n.
    for n in [3_u16, 4, 6, 8, 12] {
        let plant = parse(&format!("1/(s+1)^{n}")).unwrap();
        let found = describing_function(&plant, &relay(1.0, 0.0));
        let angle = PI / f64::from(n);
        let first = found.iter().find(|i| i.cycle.stable == Some(true)).unwrap();
        close("omega", first.omega, angle.tan(), 1e-10);
        close(
            "amplitude",
            first.cycle.amplitude,
            4.0 / PI * angle.cos().powi(i32::from(n)),
            1e-10,
        );
    }
}

#[test]
fn no_oscillation_is_said_where_there_is_none() {
    // Never beyond -180 degrees; and a hysteresis that the curve does not reach.
    assert!(describing_function(&parse("1/(s+1)").unwrap(), &relay(1.0, 0.0)).is_empty());
    assert!(describing_function(&parse("1/(s+1)^2").unwrap(), &relay(1.0, 0.0)).is_empty());
    assert!(describing_function(&parse("1/(s+1)^3").unwrap(), &relay(1.0, 1.5)).is_empty());
}

#[test]
fn dead_time_meets_an_ideal_relay_again_and_again() {
    // An integrator with dead time: w L = 90, 450, 810 ... degrees; only the first is stable.
    let plant = parse("e^{-0.7s}/s").unwrap();
    let found = describing_function(&plant, &relay(1.0, 0.0));
    assert!(found.len() >= 20, "{}", found.len());
    for (i, at) in found.iter().enumerate() {
        close(
            "omega",
            at.omega,
            (0.5 * PI + 2.0 * PI * i as f64) / 0.7,
            1e-9,
        );
        assert_eq!(at.cycle.stable, Some(i == 0), "{i}");
    }
}

#[test]
fn several_intersections_and_which_are_stable() {
    // Conditionally stable: the curve goes through the axis three times, at w with
    // atan-phases summing to -180 degrees; stable, unstable, stable as the swing falls.
    let plant = parse("100(s+1)^2/((10s+1)^3(0.1s+1)^2)").unwrap();
    let found = describing_function(&plant, &relay(1.0, 0.0));
    let verdicts: Vec<Option<bool>> = found.iter().map(|i| i.cycle.stable).collect();
    for at in &found {
        assert!(plant.response(at.omega).im.abs() < 1e-9 * plant.response(at.omega).norm());
    }
    assert_eq!(found.len() % 2, 1, "{found:?}");
    assert_eq!(verdicts.last(), Some(&Some(true)), "{found:?}");
    // Conditionally stable for certain: three integrators.
    let triple = parse("(s+1)^2/(s^3(0.02s+1)^2)").unwrap();
    let found = describing_function(&triple, &relay(1.0, 0.0));
    let verdicts: Vec<Option<bool>> = found.iter().map(|i| i.cycle.stable).collect();
    assert_eq!(verdicts, [Some(false), Some(true)], "{found:?}");
}

#[test]
fn it_is_not_trusted_where_it_is_22_per_cent_off() {
    let plant = parse("-(s^2+s-4)/((s+1)(s+2)(s+3))").unwrap();
    let prediction = predict(&plant, &relay(1.0, 0.5)).unwrap();
    let trust = &prediction.trust;
    assert!(!trust.reliable, "{trust:?}");
    assert!(
        trust.text.to_string().contains("Do not trust"),
        "{}",
        trust.text
    );
    close(
        "period error",
        trust.period_error.unwrap().abs(),
        0.22,
        0.05,
    );
    let run = simulate(&plant.state_space(), &relay(1.0, 0.5), 0.0, 0.05, 4000);
    let [.., a, b] = run.rises.as_slice() else {
        panic!()
    };
    let nearest = prediction
        .exact
        .iter()
        .map(|c| (c.cycle.period / (b - a) - 1.0).abs());
    assert!(nearest.fold(1.0, f64::min) < 1e-9, "{:?}", prediction.exact);
}

#[test]
fn it_is_trusted_on_a_third_order_lag() {
    let prediction = predict(&parse("1/(s+1)^3").unwrap(), &relay(1.0, 0.1)).unwrap();
    assert!(prediction.trust.reliable, "{:?}", prediction.trust);
    assert!(prediction.existence.unwrap().holds);
    assert_eq!(prediction.exact.len(), 1);
}

#[test]
fn asymmetry_balances_the_mean_and_the_first_harmonic() {
    for text in ["1/(s+1)^4", "2 e^{-0.5s}/(s+1)", "e^{-s}/(s(s+1))"] {
        let plant = parse(text).unwrap();
        for (asymmetry, bias) in [(-0.3, 0.0), (0.15, 0.1), (0.4, -0.1)] {
            let relay = Relay {
                asymmetry,
                bias,
                delay: 0.1,
                ..relay(1.0, 0.05)
            };
            let at = describing_function(&plant, &relay)[0];
            // The relay driven by b + a sin, over one period, without any formula of it.
            let (a, b, count) = (at.cycle.amplitude, at.mean, 400_000);
            let mut high = false;
            let (mut mean, mut first) = (0.0, Complex::new(0.0, 0.0));
            for i in 0..2 * count {
                let angle = 2.0 * PI * (f64::from(i) + 0.5) / f64::from(count);
                let y = b + a * angle.sin();
                high = if high {
                    y > -relay.hysteresis
                } else {
                    y > relay.hysteresis
                };
                if i >= count {
                    let u = relay.output(high) / f64::from(count);
                    mean += u;
                    first += Complex::from_polar(2.0 * u, -angle);
                }
            }
            let p = plant.response(at.omega) * Complex::from_polar(1.0, -at.omega * relay.delay);
            let output = p * first;
            let name = format!("{text} {asymmetry} {bias}: {at:?}");
            assert!(
                (output - Complex::new(0.0, -a)).norm() < 1e-4 * a,
                "{name} {output}"
            );
            if plant.dc_gain().is_finite() {
                assert!(
                    (plant.dc_gain() * mean - b).abs() < 1e-4 * a,
                    "{name} {mean}"
                );
            } else {
                assert!(mean.abs() < 1e-4, "{name} {mean}");
            }
        }
    }
}

#[test]
fn harmonics_add_up_to_the_exact_cycle() {
    let plant = parse("2 e^{-0.3s}/((s+1)(0.5s+1))").unwrap();
    let relay = Relay {
        asymmetry: 0.2,
        delay: 0.1,
        ..relay(1.0, 0.1)
    };
    let exact = exact_cycle(&plant.state_space(), &relay, 0.4, 1.0).unwrap();
    let period = exact.cycle.period;
    let parts = harmonics(&plant, &relay, &exact, 400);
    let mean = 2.0
        * (relay.output(true) * exact.durations[0] + relay.output(false) * exact.durations[1])
        / period;
    let at = |t: f64| {
        let wave = |h: &hysteron_core::limit_cycle::Harmonic| {
            h.amplitude * (2.0 * PI * h.order as f64 * t / period + h.phase).cos()
        };
        mean + parts.iter().map(wave).sum::<f64>()
    };
    assert!((at(0.0) - 0.1).abs() < 1e-5, "{}", at(0.0));
    assert!((at(exact.durations[0]) + 0.1).abs() < 1e-5);
    let highest = (0..2000)
        .map(|i| at(period * f64::from(i) / 2000.0))
        .fold(f64::MIN, f64::max);
    close("highest", highest, exact.range[1], 1e-4);
}

#[test]
fn existence_needs_a_push_beyond_the_opposite_threshold() {
    let plant = parse("2/(s+1)^3").unwrap();
    assert!(existence(&plant, &relay(1.0, 1.9)).unwrap().holds);
    assert!(!existence(&plant, &relay(1.0, 2.1)).unwrap().holds);
    let biased = Relay {
        bias: 0.9,
        ..relay(1.0, 0.3)
    };
    assert!(!existence(&plant, &biased).unwrap().holds);
    assert!(
        existence(&parse("1/(s(s+1))").unwrap(), &relay(1.0, 5.0))
            .unwrap()
            .holds
    );
    assert!(existence(&parse("1/(s-1)").unwrap(), &relay(1.0, 0.1)).is_none());
}
