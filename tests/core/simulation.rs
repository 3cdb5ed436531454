//! The event-driven run: equation (2) in a loop, sliding, chattering, several relays, noise (Fig. 4).

use hysteron_core::limit_cycle::exact_cycle;
use hysteron_core::plant::{Multivariable, StateSpace, TransferFunction, parse};
use hysteron_core::relay::Relay;
use hysteron_core::simulate::{
    Cut, MAX_SWITCHES, Noise, Options, SimulateError, Trajectory, run, run_multivariable,
};
use nalgebra::{DMatrix, DVector};

fn ideal() -> Relay {
    Relay {
        hysteresis: 0.0,
        ..Relay::default()
    }
}

fn from(initial: &[f64], duration: f64, step: f64) -> Options {
    Options {
        initial: Some(DVector::from_row_slice(initial)),
        ..Options::new(duration, step)
    }
}

fn space(text: &str) -> StateSpace {
    parse(text).unwrap().state_space()
}

#[test]
fn switching_instants_of_a_double_integrator_to_1e_12() {
    // y'' = u, y = x2: parabolas, v^2/2 + u y constant. From y = 2, v = 0 under u = -1 (h = +1) the
    // fall is at y = -eps: t = sqrt(2 (2 + eps)), and the swings grow by known square roots.
    let relay = Relay {
        hysteresis: 0.5,
        ..Relay::default()
    };
    let run = run(&space("1/s^2"), &relay, 0.0, &from(&[0.0, 2.0], 40.0, 0.1)).unwrap();
    let (mut t, mut peak) = (0.0, 2.0_f64);
    let mut switches: Vec<f64> = run.rises.iter().chain(&run.falls).copied().collect();
    switches.sort_by(f64::total_cmp);
    assert!(switches.len() > 4);
    for (i, at) in switches.iter().enumerate() {
        if i > 0 {
            // From the last switch to the peak beyond the threshold, and on to the other threshold.
            let beyond = peak - 0.5;
            t += (2.0 * beyond).sqrt();
        }
        t += (2.0 * (peak + 0.5)).sqrt();
        assert!((at / t - 1.0).abs() < 1e-12, "switch {i}: {at}, exact {t}");
        // Speed at the switch: v^2/2 = peak + eps; turned round under the other push.
        peak += 1.0;
    }
}

#[test]
fn an_ideal_relay_holds_the_output_on_the_threshold_while_it_can() {
    // P = (s+2)/(s+1)^2 = 1/(s+1) + 1/(s+1)^2, CB = 1: on y = 0 the zero's dynamics remain, x' = -2 x.
    let plant = space("(s+2)/(s+1)^2");
    let run = run(&plant, &ideal(), 0.0, &from(&[0.3, 0.4], 10.0, 0.01)).unwrap();
    assert_eq!(run.cut, None);
    let [[start, end]] = run.sliding[..] else {
        panic!("{:?}", run.sliding)
    };
    assert_eq!(end, 10.0);
    // Equivalent control u = -C A x / (C B) falls off with the zero, e^{-2t}.
    let held: Vec<[f64; 2]> = run.input.iter().filter(|i| i[0] > start).copied().collect();
    let first = held[0];
    for [t, u] in &held {
        let exact = first[1] * (-2.0 * (t - first[0])).exp();
        assert!(
            (u - exact).abs() < 1e-10 * first[1].abs(),
            "{t}: {u} {exact}"
        );
    }
    for (t, y) in run
        .time
        .iter()
        .zip(&run.output)
        .filter(|(t, _)| **t > start)
    {
        assert!(y.abs() < 1e-12, "{t} {y}");
    }
}

#[test]
fn sliding_ends_where_the_relay_is_no_longer_strong_enough() {
    // (s-1)/(s(s+1)): CB = 1, but the zero pushes away, x' = x, until |u_eq| = 1.
    let plant = space("(s-1)/(s^2+s)");
    let run = run(&plant, &ideal(), 0.0, &from(&[0.02, 0.021], 12.0, 0.01)).unwrap();
    assert!(
        !run.sliding.is_empty() && run.sliding[0][1] < 12.0,
        "{:?}",
        run.sliding
    );
    let [start, end] = run.sliding[0];
    let held: Vec<f64> = run
        .input
        .iter()
        .filter(|i| i[0] > start && i[0] < end)
        .map(|i| i[1])
        .collect();
    let last = held.last().unwrap();
    assert!(last.abs() > 0.98 && last.abs() <= 1.0 + 1e-12, "{last}");
}

/// `A` in observer form and `B` of `1/s`-chains, as the paper has them: poles and `b` by coefficients.
fn observer(a: [f64; 3], b: [f64; 3]) -> StateSpace {
    StateSpace {
        a: DMatrix::from_row_slice(3, 3, &[-a[0], 1.0, 0.0, -a[1], 0.0, 1.0, -a[2], 0.0, 0.0]),
        b: DVector::from_row_slice(&b),
        c: DVector::from_row_slice(&[1.0, 0.0, 0.0]),
    }
}

/// The third-order family of di Bernardo, Johansson and Vasca (2001): damping, frequency, lag, gain,
/// two zeros.
fn family(zeta: f64, omega: f64, lambda: f64, k: f64, sigma: f64, rho: f64) -> StateSpace {
    observer(
        [
            2.0 * zeta * omega + lambda,
            2.0 * zeta * omega * lambda + omega * omega,
            lambda * omega * omega,
        ],
        [k, 2.0 * k * sigma * rho, k * rho * rho],
    )
}

fn finite(run: &Trajectory) -> bool {
    run.output.iter().all(|y| y.is_finite() && y.abs() < 1e3)
}

#[test]
fn multi_sliding_and_chaotic_relay_systems_do_not_hang() {
    // Relay cycles with sliding segments (sigma < 0: the zeros push the sliding motion outwards), from
    // simple to with many segments a period, and aperiodic ones.
    for (lambda, sigma, rho, k) in [
        (1.0, -1.0, 1.0, 1.0),
        (1.0, -0.07, 1.0, 1.0),
        (0.05, -0.05, 1.0, 1.0),
        (0.01, 0.99, 1.0, 1.0),
        (1.0, -1.0, 4.0, 1.0),
    ] {
        for zeta in [0.05, -0.07, 1.0] {
            for omega in [1.0, 10.0] {
                let plant = family(zeta, omega, lambda, k, sigma, rho);
                let run = run(
                    &plant,
                    &ideal(),
                    0.0,
                    &from(&[0.05, -0.01, 0.1], 500.0, 0.05),
                )
                .unwrap();
                let name = format!("{zeta} {omega} {lambda} {sigma} {rho}");
                assert!(
                    run.rises.len() + run.falls.len() <= MAX_SWITCHES + 2,
                    "{name}"
                );
                // Either it ran to its end or it says that it chattered.
                assert!(
                    run.cut.is_some() || run.time.len() == 10_000,
                    "{name} {}",
                    run.time.len()
                );
                assert!(zeta < 0.0 || finite(&run), "{name}");
            }
        }
    }
}

#[test]
fn a_cycle_with_sliding_segments_slides_again_and_again() {
    let plant = family(0.05, 10.0, 0.05, 1.0, -0.05, 1.0);
    let run = run(
        &plant,
        &ideal(),
        0.0,
        &from(&[0.05, -0.01, 0.1], 500.0, 0.05),
    )
    .unwrap();
    assert_eq!(run.cut, None);
    assert!(run.sliding.len() > 10, "{}", run.sliding.len());
    // In each the output stays on the threshold.
    for (t, y) in run.time.iter().zip(&run.output) {
        if run.sliding.iter().any(|s| *t > s[0] && *t < s[1]) {
            assert!(y.abs() < 1e-9, "{t} {y}");
        }
    }
}

#[test]
fn endless_switching_is_reported_and_not_waited_for() {
    // CB = 0, CAB > 0 and an ideal relay: switches accumulate at the origin, 1/(s+1)^2.
    let run = run(
        &space("1/(s+1)^2"),
        &ideal(),
        0.0,
        &from(&[1.0, 1.0], 1e4, 1.0),
    )
    .unwrap();
    assert_eq!(run.cut, Some(Cut::Chattering));
    let [.., a, b] = run.rises[..] else { panic!() };
    assert!(b - a < 1e-3, "{a} {b}");
}

#[test]
fn a_long_run_is_no_chattering() {
    let relay = Relay {
        hysteresis: 0.1,
        ..Relay::default()
    };
    let lag = space("1/(s+1)^3");
    for step in [1.0, 1e6] {
        let run = run(&lag, &relay, 0.0, &Options::new(step * 1e5, step)).unwrap();
        assert_eq!(run.cut, Some(Cut::TooManySwitches));
        assert!(run.rises.len() + run.falls.len() >= MAX_SWITCHES);
        let (period, _) = run.settled(1e-6).unwrap();
        let whole = period * 0.5 * MAX_SWITCHES as f64;
        assert!((run.end() / whole - 1.0).abs() < 1e-3, "{}", run.end());
    }
    // A narrow relay is fast, and no faster in the end.
    let narrow = Relay {
        hysteresis: 1e-4,
        ..Relay::default()
    };
    let run = run(&space("1/(s+1)"), &narrow, 0.0, &Options::new(60.0, 0.1)).unwrap();
    assert_eq!(run.cut, Some(Cut::TooManySwitches));
}

#[test]
fn relays_side_by_side_do_not_hear_each_other() {
    // Two third-order lags in one plant, uncoupled: each must do what it does alone, bit for bit in events.
    let (slow, fast) = (space("1/(s+1)^3"), space("3/(0.5s+1)^3"));
    let mut a = DMatrix::zeros(6, 6);
    a.view_mut((0, 0), (3, 3)).copy_from(&slow.a);
    a.view_mut((3, 3), (3, 3)).copy_from(&fast.a);
    let mut b = DMatrix::zeros(6, 2);
    b.view_mut((0, 0), (3, 1)).copy_from(&slow.b);
    b.view_mut((3, 1), (3, 1)).copy_from(&fast.b);
    let mut c = DMatrix::zeros(2, 6);
    c.view_mut((0, 0), (1, 3)).copy_from(&slow.c.transpose());
    c.view_mut((1, 3), (1, 3)).copy_from(&fast.c.transpose());
    let both = Multivariable { a, b, c };
    let relays = [
        Relay::default(),
        Relay {
            asymmetry: 0.2,
            hysteresis: 0.3,
            ..Relay::default()
        },
    ];
    let lags = [0.0, 0.7];
    let options = Options::new(60.0, 0.1);
    let together = run_multivariable(&both, &relays, &lags, &options).unwrap();
    for (i, plant) in [slow, fast].iter().enumerate() {
        let alone = run(plant, &relays[i], lags[i], &options).unwrap();
        assert_eq!(alone.rises.len(), together[i].rises.len());
        for (x, y) in alone
            .rises
            .iter()
            .chain(&alone.falls)
            .zip(together[i].rises.iter().chain(&together[i].falls))
        {
            assert!((x - y).abs() < 1e-11 * (1.0 + x), "{x} {y}");
        }
    }
    let wrong = run_multivariable(&both, &relays[..1], &lags, &options);
    assert!(matches!(wrong, Err(SimulateError::Relays { .. })));
}

/// Matrix exponential: a Taylor series of a 256th, squared eight times.
fn exponential(m: &DMatrix<f64>) -> DMatrix<f64> {
    let small = m / 256.0;
    let one = DMatrix::identity(m.nrows(), m.ncols());
    let terms = (1..30).rev();
    let short = terms.fold(one.clone(), |sum, k| &one + &small * sum / f64::from(k));
    (0..8).fold(short, |e, _| &e * &e)
}

#[test]
fn coupled_relays_solve_the_equations_between_their_switches() {
    let both = Multivariable {
        a: DMatrix::from_row_slice(
            4,
            4,
            &[
                -1.0, 0.3, 0.0, 0.0, 0.0, -2.0, 0.5, 0.0, 0.2, 0.0, -1.5, 1.0, 0.0, 0.4, 0.0, -0.7,
            ],
        ),
        b: DMatrix::from_row_slice(4, 2, &[0.0, 0.2, 1.0, 0.0, 0.1, 0.0, 0.0, 2.0]),
        c: DMatrix::from_row_slice(2, 4, &[1.0, 0.0, 0.2, 0.0, 0.0, 0.1, 1.0, 0.0]),
    };
    let relays = [
        Relay {
            hysteresis: 0.02,
            ..Relay::default()
        },
        Relay {
            hysteresis: 0.03,
            ..Relay::default()
        },
    ];
    let runs = run_multivariable(&both, &relays, &[0.1, 0.0], &Options::new(20.0, 0.01)).unwrap();
    assert!(runs.iter().all(|r| r.rises.len() > 3));
    // Replayed by matrix exponentials from the recorded inputs alone.
    let mut corners: Vec<(f64, usize, f64)> = Vec::new();
    for (i, r) in runs.iter().enumerate() {
        corners.extend(r.input.iter().map(|[t, u]| (*t, i, *u)));
    }
    corners.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut x = DVector::zeros(4);
    let (mut now, mut u, mut next) = (0.0, DVector::zeros(2), 0);
    let propagate = |x: &DVector<f64>, u: &DVector<f64>, t: f64| {
        let mut big = DMatrix::zeros(5, 5);
        big.view_mut((0, 0), (4, 4)).copy_from(&(&both.a * t));
        big.view_mut((0, 4), (4, 1)).copy_from(&(&both.b * u * t));
        let e = exponential(&big);
        e.view((0, 0), (4, 4)) * x + e.view((0, 4), (4, 1))
    };
    for (k, t) in runs[0].time.iter().enumerate() {
        while next < corners.len() && corners[next].0 <= *t {
            let (at, i, value) = corners[next];
            x = propagate(&x, &u, at - now);
            (now, u[i]) = (at, value);
            next += 1;
        }
        let y = &both.c * propagate(&x, &u, t - now);
        assert!((y[0] - runs[0].output[k]).abs() < 1e-11, "{t}");
        assert!((y[1] - runs[1].output[k]).abs() < 1e-11, "{t}");
    }
}

#[test]
fn fig_4_noise_is_reproducible_band_limited_and_answered_by_hysteresis() {
    let plant = space("1/(s+1)^3");
    let noise = Noise {
        std_dev: 0.02,
        interval: 0.01,
        seed: 7,
    };
    let noisy = |hysteresis: f64, seed: u64| {
        let relay = Relay {
            hysteresis,
            ..Relay::default()
        };
        let options = Options {
            noise: Some(Noise { seed, ..noise }),
            ..Options::new(100.0, 0.05)
        };
        run(&plant, &relay, 0.0, &options).unwrap()
    };
    assert_eq!(noisy(0.1, 7), noisy(0.1, 7));
    assert_ne!(noisy(0.1, 7).rises, noisy(0.1, 8).rises);
    // An ideal relay switches many times at each crossing, one with hysteresis above the noise once.
    let (without, with) = (noisy(0.0, 7).rises.len(), noisy(0.1, 7).rises.len());
    assert!(without > 2 * with, "{without} {with}");
    let exact = exact_cycle(&plant, &Relay::default(), 0.0, 2.4)
        .unwrap()
        .cycle
        .period;
    let rises = noisy(0.1, 7).rises;
    let mean = (rises[rises.len() - 1] - rises[2]) / (rises.len() - 3) as f64;
    assert!((mean / exact - 1.0).abs() < 0.05, "{mean} {exact}");
}

#[test]
fn the_relay_switches_where_output_and_noise_pass_the_threshold() {
    let noise = Noise {
        std_dev: 0.02,
        interval: 0.01,
        seed: 7,
    };
    let relay = Relay {
        hysteresis: 0.1,
        ..Relay::default()
    };
    let step = 1e-3;
    let options = Options {
        noise: Some(noise),
        ..Options::new(20.0, step)
    };
    let run = run(&space("1/(s+1)^3"), &relay, 0.0, &options).unwrap();
    assert!(run.rises.len() > 3);
    for rise in &run.rises[1..] {
        let k = (rise / step) as usize;
        let (output, noise) = (&run.output[k..=k + 1], noise.at(&run.time[k..=k + 1]));
        let share = (rise - run.time[k]) / step;
        let seen = |i: usize| output[i] + noise[i];
        let there = seen(0) + share * (seen(1) - seen(0));
        assert!((there - 0.1).abs() < 1e-5, "{there} at {rise}");
    }
}

#[test]
fn a_run_is_the_same_whatever_its_samples() {
    let plant = TransferFunction::new(&[1.0], &[1.0, 3.0, 3.0, 1.0], 0.2);
    let events = |step: f64| {
        run(
            &plant.state_space(),
            &Relay::default(),
            0.2,
            &Options::new(50.0, step),
        )
        .unwrap()
        .rises
    };
    assert_eq!(events(0.01), events(0.7));
}

#[test]
fn bad_input_is_an_error_and_never_a_panic() {
    let plant = space("1/(s+1)^2");
    let relay = Relay::default();
    for (duration, step) in [
        (0.0, 0.1),
        (f64::NAN, 0.1),
        (1.0, -1.0),
        (1e12, 1e-9),
        (1.0, f64::INFINITY),
    ] {
        assert!(
            run(&plant, &relay, 0.0, &Options::new(duration, step)).is_err(),
            "{duration} {step}"
        );
    }
    assert!(run(&plant, &relay, -1.0, &Options::new(1.0, 0.1)).is_err());
    assert!(run(&plant, &relay, 0.0, &from(&[1.0], 1.0, 0.1)).is_err());
    assert!(run(&plant, &relay, 0.0, &from(&[f64::NAN, 0.0], 1.0, 0.1)).is_err());
}

#[test]
fn a_plant_that_swings_millions_of_times_is_cut_and_said_so() {
    // A swing of 10 million rad/s without damping beside a lag of 1 s, for 10 s.
    let relay = Relay::default();
    let plant = space("1/(s + 1) + 1e10/(s^2 + 1e14)");
    let run = run(&plant, &relay, 0.0, &Options::new(10.0, 0.1)).unwrap();
    assert_eq!(run.cut, Some(Cut::TooFast));
    assert!(run.rises.len() + run.falls.len() < MAX_SWITCHES);
}
