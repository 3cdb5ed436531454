//! Hunting around dry friction, cogging and play, against closed forms and an integrator of its own.

use std::f64::consts::PI;

use hysteron_core::hunting::{
    Cogging, Controller, Friction, Servo, describing_function, friction_gain, run, settled,
};
use hysteron_core::simulate::Noise;

/// Inertia 1, so that all is in natural units.
fn servo(proportional: f64, integral: f64, derivative: f64) -> Servo {
    Servo {
        inertia: 1.0,
        viscous: 0.0,
        friction: Friction::default(),
        cogging: None,
        half_gap: 0.0,
        controller: Controller {
            proportional,
            integral,
            derivative,
            limit: None,
            tracking_time: None,
        },
        reference: 1.0,
    }
}

#[track_caller]
fn close(value: f64, exact: f64, share: f64) {
    assert!(
        (value / exact - 1.0).abs() < share,
        "{value}, exact {exact}"
    );
}

/// A mass on a spring with Coulomb friction: each half swing loses `4 c/P` of the amplitude, and it stops within `c/P`.
#[test]
fn a_mass_on_a_spring_with_dry_friction_in_closed_form() {
    let mut servo = servo(4.0, 0.0, 0.0);
    servo.friction.coulomb = 0.3;
    let lost = 2.0 * 0.3 / 4.0;
    let half = PI / 2.0;
    let run = run(&servo, 20.0, half / 2.0, None).unwrap();
    // From 0 to 1 and beyond: at the end of each half swing the distance is smaller by 2 c/P, on the other side.
    let mut distance = 1.0;
    let mut side = -1.0;
    for k in 1..=6 {
        distance -= lost;
        side = -side;
        let at = run.position[2 * k];
        assert!((at - (1.0 + side * distance)).abs() < 1e-9, "{k}: {at}");
    }
    let found = settled(&servo).unwrap();
    // It stops where the spring is weaker than friction.
    let error = found.error_at_rest.unwrap().abs();
    assert!(error <= 0.3 / 4.0 + 1e-9, "{error}");
    assert!(found.exact.is_none());
}

/// Without anything dry it is a linear loop: the response to a step by its poles.
#[test]
fn a_linear_loop_in_closed_form() {
    let servo = servo(5.0, 0.0, 2.0);
    let run = run(&servo, 6.0, 0.1, None).unwrap();
    for (t, x) in run.time.iter().zip(&run.position) {
        let exact = 1.0 - f64::exp(-t) * ((2.0 * t).cos() + 0.5 * (2.0 * t).sin());
        assert!((x - exact).abs() < 1e-9, "{t}: {x} {exact}");
    }
    assert!(settled(&servo).unwrap().error_at_rest.is_some());
}

/// With an integral the level of friction decides nothing: it is that friction is higher at rest which makes it hunt
/// (Armstrong and Amin 1996).
#[test]
fn what_is_higher_at_rest_makes_it_hunt() {
    let mut plain = servo(4.0, 1.5, 1.5);
    plain.friction.coulomb = 0.3;
    let found = settled(&plain).unwrap();
    assert!(found.simulated.is_none() && !found.unbounded, "{found:?}");
    let mut sticky = plain;
    sticky.friction.excess = 0.2;
    let found = settled(&sticky).unwrap();
    let cycle = found.exact.unwrap_or_else(|| panic!("{found:?}"));
    assert_eq!(cycle.stable, Some(true), "{cycle:?}");
    assert!(cycle.stuck > 0.3, "{cycle:?}");
    // Another inertia and other units of time and force: all scales, and nothing else changes.
    let (j, t) = (3.0, 0.2);
    let f = j / (t * t);
    let mut scaled = sticky;
    scaled.inertia = j;
    scaled.controller.proportional *= f;
    scaled.controller.integral *= f / t;
    scaled.controller.derivative *= f * t;
    scaled.friction.coulomb *= f;
    scaled.friction.excess *= f;
    let other = settled(&scaled).unwrap().exact.unwrap();
    close(other.period, t * cycle.period, 1e-7);
    close(other.amplitude, cycle.amplitude, 1e-7);
}

/// A motor that is at rest between two slips: what an integrator of small steps shows, in which friction opposes the
/// motion, holds at rest, and the play is taken along.
fn by_small_steps(servo: &Servo, end: f64) -> [f64; 2] {
    let h = 2e-5;
    let c = servo.controller;
    let (mut x, mut v, mut i, mut w) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let (mut tops, mut bottoms): (Vec<(f64, f64)>, Vec<f64>) = (Vec::new(), Vec::new());
    let (mut before, mut rising) = (0.0, true);
    for k in 0..(end / h) as u64 {
        let asked = c.proportional * (servo.reference - w) + i - c.derivative * v;
        let limit = c.limit.unwrap_or(f64::INFINITY);
        let u = asked.clamp(-limit, limit);
        let back = c.tracking_time.map_or(0.0, |t| (u - asked) / t);
        i += h * (c.integral * (servo.reference - w) + back);
        let cogging = servo
            .cogging
            .map_or(0.0, |g| g.amplitude * (g.per_turn * x).sin());
        let force = u - servo.viscous * v - cogging;
        let f = servo.friction;
        let level = if f.stribeck_speed > 0.0 {
            f.coulomb + f.excess * (-(v / f.stribeck_speed).powi(2)).exp()
        } else {
            f.coulomb
        };
        let rests = v == 0.0;
        if !(rests && force.abs() <= f.coulomb + f.excess) {
            let way = if rests { force.signum() } else { v.signum() };
            let next = v + h * (force - way * level) / servo.inertia;
            v = if !rests && next * way <= 0.0 {
                0.0
            } else {
                next
            };
        }
        x += h * v;
        w = w.clamp(x - servo.half_gap, x + servo.half_gap);
        let t = k as f64 * h;
        if w != before {
            if (w > before) != rising {
                if rising {
                    tops.push((t, before));
                } else {
                    bottoms.push(before);
                }
                rising = w > before;
            }
            before = w;
        }
    }
    let last = &tops[tops.len() - 5..];
    let low = bottoms[bottoms.len() - 1];
    [(last[4].0 - last[0].0) / 4.0, 0.5 * (last[4].1 - low)]
}

#[test]
fn sticking_play_cogging_and_limits_as_by_small_steps() {
    let mut sticky = servo(4.0, 1.0, 0.7);
    sticky.friction = Friction {
        coulomb: 0.1,
        excess: 0.3,
        stribeck_speed: 0.02,
    };
    let mut loose = servo(1.0, 0.6, 1.0);
    loose.half_gap = 0.1;
    loose.friction.coulomb = 0.005;
    let mut without_integral = servo(1.0, 0.0, 0.1);
    without_integral.half_gap = 0.1;
    without_integral.friction.coulomb = 1e-5;
    let mut cogged = sticky;
    cogged.cogging = Some(Cogging {
        amplitude: 0.1,
        per_turn: 5.0,
    });
    let mut limited = sticky;
    limited.controller.limit = Some(0.8);
    limited.controller.tracking_time = Some(1.0);
    for (name, servo) in [
        ("sticky", sticky),
        ("loose", loose),
        ("without integral", without_integral),
        ("cogged", cogged),
        ("limited", limited),
    ] {
        let [period, amplitude] = by_small_steps(&servo, 400.0);
        let found = settled(&servo).unwrap();
        let cycle = found.exact.unwrap_or_else(|| panic!("{name}: {found:?}"));
        assert_eq!(cycle.stable, Some(true), "{name}: {cycle:?}");
        assert_eq!(found.simulated.unwrap().stable, Some(true), "{name}");
        close(cycle.period, period, 5e-3);
        close(cycle.amplitude, amplitude, 5e-3);
    }
}

/// Play hunts smoothly, so that the first harmonic says much of it.
#[test]
fn the_first_harmonic_of_play() {
    let mut loose = servo(1.0, 0.6, 1.0);
    loose.half_gap = 0.1;
    let exact = settled(&loose).unwrap();
    let exact = exact.exact.unwrap_or_else(|| panic!("{exact:?}"));
    let all = describing_function(&loose);
    let stable = all.iter().find(|b| b.stable == Some(true));
    let found = stable.unwrap_or_else(|| panic!("{all:?} {exact:?}"));
    close(found.period, exact.period, 0.1);
    close(found.motor_amplitude, exact.motor_amplitude, 0.1);
    close(found.amplitude, exact.amplitude, 0.2);
}

#[test]
fn the_describing_function_of_friction() {
    let coulomb = Friction {
        coulomb: 0.3,
        excess: 0.0,
        stribeck_speed: 0.0,
    };
    close(friction_gain(&coulomb, 2.0), 4.0 * 0.3 / (PI * 2.0), 1e-12);
    let sticky = Friction {
        excess: 0.2,
        stribeck_speed: 0.7,
        ..coulomb
    };
    let steps = 100_000;
    let sum: f64 = (0..steps)
        .map(|k| {
            let s = ((f64::from(k) + 0.5) * PI / f64::from(steps)).sin();
            (0.3 + 0.2 * (-(2.0 * s / 0.7_f64).powi(2)).exp()) * s
        })
        .sum();
    let exact = 2.0 * sum / f64::from(steps) / 2.0;
    close(friction_gain(&sticky, 2.0), exact, 1e-3);
}

#[test]
fn odd_servos_end() {
    for bits in 0..128_u32 {
        let bit = |k: u32| f64::from(bits >> k & 1);
        let mut odd = servo(1.0, 2.0 * bit(0), bit(1));
        odd.friction.coulomb = 0.1 * bit(2);
        odd.friction.excess = 0.1 * bit(3);
        odd.half_gap = 0.1 * bit(4);
        odd.cogging = (bit(5) > 0.0).then_some(Cogging {
            amplitude: 0.2,
            per_turn: 30.0,
        });
        odd.controller.limit = (bit(6) > 0.0).then_some(0.05);
        let found = settled(&odd).unwrap();
        assert!(!found.text.is_empty());
        describing_function(&odd);
    }
    let mut wrong = servo(1.0, 0.0, 0.0);
    wrong.inertia = -1.0;
    assert!(settled(&wrong).is_err() && run(&wrong, 1.0, 0.1, None).is_err());
}

/// Noise on the position that the controller sees, against Euler's method in steps of a millionth.
#[test]
fn in_noise_it_sticks_and_slips_as_small_steps_say() {
    let mut servo = servo(4.0, 3.0, 3.0);
    servo.friction.coulomb = 0.6;
    servo.controller.limit = Some(2.5);
    servo.controller.tracking_time = Some(0.3);
    let noise = |std_dev, seed| {
        Some(Noise {
            std_dev,
            interval: 0.05,
            seed,
        })
    };
    let noisy = run(&servo, 4.0, 0.1, noise(0.05, 5)).unwrap();
    let step = 1e-6;
    let times: Vec<f64> = (0..=4_000_000).map(|k| step * f64::from(k)).collect();
    let seen = noise(0.05, 5).unwrap().at(&times);
    let (mut x, mut v, mut integral, mut stuck) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0);
    for (k, noise) in seen.iter().enumerate() {
        if k % 100_000 == 0 {
            let found = noisy.position[k / 100_000];
            assert!((x - found).abs() < 1e-4, "{k}: {x} {found}");
        }
        let error = 1.0 - x - noise;
        let asked = 4.0 * error + integral - 3.0 * v;
        let u = asked.clamp(-2.5, 2.5);
        integral += step * (3.0 * error + (u - asked) / 0.3);
        if v == 0.0 && u.abs() <= 0.6 {
            stuck += step;
            continue;
        }
        let way = if v == 0.0 { u.signum() } else { v.signum() };
        let next = v + step * (u - 0.6 * way);
        v = if next * way < 0.0 { 0.0 } else { next };
        x += step * v;
    }
    let sticks: f64 = noisy.stuck.iter().map(|s| s[1] - s[0]).sum();
    assert!(
        sticks > 0.5 && (sticks - stuck).abs() < 0.01,
        "{sticks} {stuck}"
    );
    // The seed says which noise, and noise of no size is none.
    assert_ne!(run(&servo, 4.0, 0.1, noise(0.05, 6)).unwrap(), noisy);
    let still = run(&servo, 4.0, 0.1, noise(0.0, 5)).unwrap();
    for (a, b) in (still.position.iter()).zip(&run(&servo, 4.0, 0.1, None).unwrap().position) {
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }
}
