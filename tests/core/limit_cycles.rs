//! Exact limit cycles, equation (3): the reference table, closed forms, asymmetry and stability.

use hysteron_core::explore::{ExploreInput, compute};
use hysteron_core::limit_cycle::{
    describing_function, exact_cycle, exact_cycles, exact_symmetric, predict,
    pulse_transfer_at_minus_one, z_form,
};
use hysteron_core::plant::TransferFunction;
use hysteron_core::relay::Relay;
use hysteron_core::simulate::{Options, Trajectory, run, simulate};
use proptest::prelude::*;

struct Row {
    name: String,
    plant: TransferFunction,
    relay: Relay,
    period: f64,
    amplitude: f64,
}

/// Period and amplitude of limit cycles that were solved to 15 digits elsewhere.
fn table() -> Vec<Row> {
    rows(include_str!("../data/limit_cycles.csv"))
}

/// More of them, by `../data/limit_cycles.py`.
fn more() -> Vec<Row> {
    rows(include_str!("../data/limit_cycles_more.csv"))
}

fn rows(csv: &str) -> Vec<Row> {
    let numbers = |text: &str| {
        text.split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect::<Vec<f64>>()
    };
    csv.lines()
        .skip(1)
        .map(|line| {
            let f: Vec<&str> = line.split(',').collect();
            let number = |i: usize| f[i].parse::<f64>().unwrap();
            Row {
                name: f[0].to_owned(),
                plant: TransferFunction::new(&numbers(f[1]), &numbers(f[2]), number(3)),
                relay: Relay {
                    gain: number(4),
                    hysteresis: number(5),
                    ..Relay::default()
                },
                period: number(6),
                amplitude: number(7),
            }
        })
        .collect()
}

fn close(name: &str, what: &str, value: f64, exact: f64, tolerance: f64) {
    assert!(
        (value / exact - 1.0).abs() < tolerance,
        "{name}: {what} {value}, exact {exact}"
    );
}

/// Last period, s, and half of the last swing from peak to peak.
fn last_cycle(run: &Trajectory) -> (f64, f64) {
    let [.., a, b] = run.rises.as_slice() else {
        panic!("fewer than two switches")
    };
    let [.., swing] = run.swings.as_slice() else {
        panic!("no whole cycle")
    };
    (b - a, 0.5 * (swing[1] - swing[0]))
}

#[test]
fn equation_3_agrees_with_the_reference_to_nine_digits() {
    let (rows, more) = (table(), more());
    assert_eq!([rows.len(), more.len()], [12, 39]);
    for row in rows.into_iter().chain(more) {
        let guess = describing_function(&row.plant, &row.relay)
            .first()
            .map_or(1.0, |i| 0.5 * i.cycle.period);
        let space = row.plant.state_space();
        let cycle = exact_symmetric(&space, &row.relay, row.plant.dead_time, guess)
            .unwrap_or_else(|| panic!("{}: no cycle", row.name));
        close(&row.name, "period", cycle.period, row.period, 1e-9);
        close(&row.name, "amplitude", cycle.amplitude, row.amplitude, 1e-9);
        assert_eq!(cycle.stable, Some(true), "{}", row.name);
    }
}

#[test]
fn long_simulations_settle_into_the_reference_cycles() {
    for row in table() {
        let space = row.plant.state_space();
        let lag = row.plant.dead_time;
        let run = simulate(&space, &row.relay, lag, row.period / 64.0, 64 * 60);
        let (period, amplitude) = last_cycle(&run);
        close(&row.name, "simulated period", period, row.period, 1e-9);
        close(
            &row.name,
            "simulated amplitude",
            amplitude,
            row.amplitude,
            1e-9,
        );
    }
}

/// Between switches a first-order plant forgets all but its output, so that its cycle can be written
/// down: time with `h = +1` and `h = -1`, s, smallest and largest output.
fn first_order(gain: f64, lag: f64, time: f64, relay: &Relay) -> ([f64; 2], [f64; 2]) {
    let (up, down) = (gain * relay.output(false), gain * relay.output(true));
    let eps = relay.hysteresis;
    let fade = (-lag / time).exp();
    let high = up - (up - eps) * fade;
    let low = down - (down + eps) * fade;
    let falling = lag + time * ((high - down) / (-eps - down)).ln();
    let rising = lag + time * ((up - low) / (up - eps)).ln();
    ([falling, rising], [low, high])
}

/// The same for `1/s`: straight lines.
fn integrator(lag: f64, relay: &Relay) -> ([f64; 2], [f64; 2]) {
    let (up, down) = (relay.output(false), -relay.output(true));
    let eps = relay.hysteresis;
    let (high, low) = (eps + up * lag, -eps - down * lag);
    let falling = lag + (high + eps) / down;
    let rising = lag + (eps - low) / up;
    ([falling, rising], [low, high])
}

fn check_closed_form(plant: &TransferFunction, relay: &Relay, exact: ([f64; 2], [f64; 2])) {
    let ([falling, rising], [low, high]) = exact;
    let lag = plant.dead_time + relay.delay;
    let found = exact_cycle(&plant.state_space(), relay, lag, 0.6 * (falling + rising))
        .unwrap_or_else(|| panic!("{plant:?} {relay:?}: no cycle"));
    let name = format!("{plant:?} {relay:?}");
    close(&name, "time above", found.durations[0], falling, 1e-9);
    close(&name, "time below", found.durations[1], rising, 1e-9);
    let swing = high - low;
    assert!(
        (found.range[0] - low).abs() < 1e-9 * swing,
        "{name}: {found:?}"
    );
    assert!(
        (found.range[1] - high).abs() < 1e-9 * swing,
        "{name}: {found:?}"
    );
    assert_eq!(found.cycle.stable, Some(true), "{name}: {found:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn first_order_plants_with_dead_time_have_their_closed_form(
        gain in 0.5..3.0, time in 0.2..5.0, dead_time in 0.05..4.0, delay in 0.0..0.5,
        hysteresis in 0.0..0.2, asymmetry in -0.5..0.5,
    ) {
        let relay = Relay { gain: 1.0, hysteresis, asymmetry, bias: 0.0, delay };
        let plant = TransferFunction::new(&[gain], &[time, 1.0], dead_time);
        check_closed_form(&plant, &relay, first_order(gain, dead_time + delay, time, &relay));
    }

    #[test]
    fn integrators_with_dead_time_have_their_closed_form(
        gain in 0.5..3.0, dead_time in 0.05..4.0, hysteresis in 0.0..0.5, asymmetry in -0.5..0.5, bias in -0.2..0.2,
    ) {
        let relay = Relay { gain, hysteresis, asymmetry, bias, delay: 0.0 };
        let plant = TransferFunction::new(&[1.0], &[1.0, 0.0], dead_time);
        check_closed_form(&plant, &relay, integrator(dead_time, &relay));
    }
}

#[test]
fn asymmetric_and_biased_relays_agree_with_simulation() {
    for row in table() {
        let relay = Relay {
            asymmetry: 0.25,
            bias: 0.05 * row.relay.gain,
            delay: 0.1,
            ..row.relay
        };
        let space = row.plant.state_space();
        let lag = row.plant.dead_time + relay.delay;
        let exact = exact_cycle(&space, &relay, lag, 0.5 * row.period)
            .unwrap_or_else(|| panic!("{}: no cycle", row.name));
        assert_eq!(exact.cycle.stable, Some(true), "{}", row.name);
        assert!(exact.durations[0] != exact.durations[1]);
        let run = simulate(&space, &relay, lag, row.period / 64.0, 64 * 100);
        let (period, amplitude) = last_cycle(&run);
        close(
            &row.name,
            "simulated period",
            period,
            exact.cycle.period,
            1e-9,
        );
        close(
            &row.name,
            "simulated amplitude",
            amplitude,
            exact.cycle.amplitude,
            1e-9,
        );
    }
}

#[test]
fn cycles_of_which_the_describing_function_sees_nothing_are_found_however_narrow_the_relay() {
    let lag = TransferFunction::new(&[1.0], &[1.0, 1.0], 0.0);
    let integrating = TransferFunction::new(&[1.0], &[1.0, 0.0], 0.0);
    for eps in [1e-4, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.5, 0.9, 0.99, 0.9999] {
        let relay = Relay {
            hysteresis: eps,
            ..Relay::default()
        };
        for (plant, ([falling, rising], _)) in [
            (&lag, first_order(1.0, 0.0, 1.0, &relay)),
            (&integrating, integrator(0.0, &relay)),
        ] {
            let said = predict(plant, &relay).unwrap();
            let [cycle] = said.exact.as_slice() else {
                panic!("{plant:?} {eps}: {:?}", said.exact)
            };
            close(
                "narrow relay",
                "period",
                cycle.cycle.period,
                falling + rising,
                1e-9,
            );
        }
    }
    // Fast at first, slow in the end, and a swing between.
    for (numerator, denominator) in [
        (vec![1.0, 3.0], vec![1.0, 3.0, 2.0]),
        (vec![1.0, 0.01], vec![1.0, 0.2, 1e-4]),
        (vec![5.0, 1.0], vec![1.0, 0.3, 4.0]),
    ] {
        let plant = TransferFunction::new(&numerator, &denominator, 0.0);
        for eps in [0.003, 0.03, 0.1, 0.2] {
            let relay = Relay {
                hysteresis: eps,
                ..Relay::default()
            };
            let data = compute(&ExploreInput {
                plant: plant.clone(),
                relay,
                noise: None,
            })
            .unwrap();
            let (exact, run) = (data.exact, data.simulated);
            let name = format!("{plant:?} {eps}");
            let exact = exact.unwrap_or_else(|| panic!("{name}: no cycle"));
            let run = run.unwrap_or_else(|| panic!("{name}: does not settle"));
            close(&name, "period", exact.period, run.period, 1e-3);
        }
    }
}

#[test]
fn a_dead_time_far_beyond_the_plant_is_counted_right_or_refused() {
    let relay = Relay {
        hysteresis: 0.1,
        ..Relay::default()
    };
    let lag = |dead_time: f64| TransferFunction::new(&[1.0], &[1.0, 3.0, 3.0, 1.0], dead_time);
    // What the output takes from -1 to the threshold does not depend on so long a dead time.
    let rest = predict(&lag(1e2), &relay).unwrap();
    let rest = rest.exact.last().unwrap().cycle.period - 2e2;
    for dead_time in [1e3, 1e4, 1e6, 1e9] {
        let found = predict(&lag(dead_time), &relay).unwrap();
        let stable: Vec<f64> = found
            .exact
            .iter()
            .filter(|c| c.cycle.stable == Some(true))
            .map(|c| c.cycle.period)
            .collect();
        let [period] = stable[..] else {
            panic!("{dead_time}: {stable:?}");
        };
        let error = period - 2.0 * dead_time - rest;
        assert!(error.abs() < 1e-14 * period + 1e-9, "{dead_time}: {error}");
    }
    for dead_time in [1.1e9, 1e12] {
        let refused = predict(&lag(dead_time), &relay).unwrap_err().to_string();
        assert!(refused.contains("slowest time constant"), "{refused}");
    }
}

#[test]
fn delays_longer_than_half_a_period_are_counted_right() {
    // A resonance above a long delay: several changes of the input are on their way at once.
    let plant = TransferFunction::new(&[1.0], &[1.0, 0.2, 1.0], 9.0);
    let relay = Relay::default();
    let space = plant.state_space();
    let cycles = exact_cycles(&space, &relay, plant.dead_time, 3.0);
    let stable: Vec<_> = cycles
        .iter()
        .filter(|c| c.cycle.stable == Some(true) && c.durations[0] < plant.dead_time)
        .collect();
    assert!(!stable.is_empty(), "{cycles:?}");
    let options = Options::new(3000.0, 0.1);
    let run = run(&space, &relay, plant.dead_time, &options).unwrap();
    let (period, amplitude) = last_cycle(&run);
    let nearest = stable
        .iter()
        .min_by(|a, b| {
            let far = |c: f64| (c / period - 1.0).abs();
            far(a.cycle.period).total_cmp(&far(b.cycle.period))
        })
        .unwrap();
    close("long delay", "period", period, nearest.cycle.period, 1e-9);
    close(
        "long delay",
        "amplitude",
        amplitude,
        nearest.cycle.amplitude,
        1e-9,
    );
}

/// Grows (above 1) or shrinks (below 1) by this factor a period, measured from a long simulation that
/// starts a little beside the cycle.
fn measured_growth(plant: &TransferFunction, relay: &Relay, guess: f64) -> (f64, f64, f64) {
    let space = plant.state_space();
    let exact = exact_cycle(&space, relay, plant.dead_time, guess).expect("a cycle");
    let period = exact.cycle.period;
    let mut options = Options::new(60.0 * period, period);
    options.initial = Some(exact.start.scale(1.0 + 1e-7));
    let run = run(&space, relay, 0.0, &options).unwrap();
    let off: Vec<f64> = run
        .rises
        .windows(2)
        .map(|w| (w[1] - w[0] - period).abs())
        .collect();
    let growth = (off[7] / off[3]).powf(0.25);
    let end = off[off.len() - 1] / period;
    (exact.multiplier.expect("a multiplier"), growth, end)
}

#[test]
fn the_poincare_map_says_which_cycles_die_out_or_run_away() {
    // Conditionally stable: larger swings grow, smaller ones shrink.
    let unstable = TransferFunction::new(&[1.0, 2.0, 1.0], &[0.05, 1.0, 0.0, 0.0, 0.0], 0.0);
    let relay = Relay {
        hysteresis: 0.05,
        ..Relay::default()
    };
    let (multiplier, growth, end) = measured_growth(&unstable, &relay, 3.0);
    assert!(multiplier > 1.05, "{multiplier}");
    close("unstable cycle", "growth", growth, multiplier, 1e-2);
    assert!(end > 1e-3, "it stayed: {end}");

    let stable = TransferFunction::new(&[4.0], &[1.0, 1.4, 4.4, 4.0], 0.0);
    let (multiplier, growth, end) = measured_growth(&stable, &relay, 1.5);
    assert!(multiplier < 0.95, "{multiplier}");
    close("stable cycle", "decay", growth, multiplier, 1e-2);
    assert!(end < 1e-9, "it went: {end}");
}

#[test]
fn describing_function_of_the_third_order_lag() {
    // 1/(s+1)^3, k = 1, eps = 0.1: worked by hand from equations (5) and (6).
    let found = describing_function(&ExploreInput::default().plant, &Relay::default());
    assert_eq!(found.len(), 1);
    let (omega, cycle) = (found[0].omega, found[0].cycle);
    close("third-order lag", "omega", omega, 1.3258, 1e-4);
    close("third-order lag", "period", cycle.period, 4.7393, 1e-4);
    close(
        "third-order lag",
        "amplitude",
        cycle.amplitude,
        0.278_04,
        1e-4,
    );
    assert_eq!(cycle.stable, Some(true));
}

#[test]
fn too_much_hysteresis_ends_the_oscillation() {
    let relay = Relay {
        hysteresis: 1.5,
        ..Relay::default()
    };
    let data = compute(&ExploreInput {
        relay,
        ..ExploreInput::default()
    })
    .unwrap();
    assert!(
        data.simulated.is_none() && data.exact.is_none(),
        "{}",
        data.text
    );
}

#[test]
fn an_asymmetric_relay_still_oscillates() {
    let relay = Relay {
        asymmetry: 0.3,
        delay: 0.2,
        ..Relay::default()
    };
    let data = compute(&ExploreInput {
        relay,
        ..ExploreInput::default()
    })
    .unwrap();
    let (exact, simulated) = (data.exact.unwrap(), data.simulated.unwrap());
    close("asymmetric", "period", simulated.period, exact.period, 1e-6);
    close(
        "asymmetric",
        "amplitude",
        simulated.amplitude,
        exact.amplitude,
        1e-6,
    );
}

/// Equation (3) in the z-form: the pulse transfer function at -1, sampled with the exact half period, is `-eps/k`.
#[test]
fn equation_3_in_the_z_form_has_the_same_half_periods() {
    for row in table().into_iter().chain(more()) {
        let space = row.plant.state_space();
        let value =
            pulse_transfer_at_minus_one(&space, row.plant.dead_time, 0.5 * row.period).unwrap();
        let wanted = -row.relay.hysteresis / row.relay.gain;
        let size = row.amplitude / row.relay.gain;
        assert!(
            (value - wanted).abs() < 1e-12 * size.max(1.0),
            "{}: {value}, {wanted}",
            row.name
        );
    }
    // 1/(s + 1) by hand: H_h(z) = (1 - e^-h)/(z - e^-h).
    let lag = TransferFunction::new(&[1.0], &[1.0, 1.0], 0.0).state_space();
    let h = 0.7_f64;
    let value = pulse_transfer_at_minus_one(&lag, 0.0, h).unwrap();
    let exact = -(1.0 - (-h).exp()) / (1.0 + (-h).exp());
    assert!((value - exact).abs() < 1e-14, "{value}, {exact}");
    // The curve goes through it, and a time that is none has no curve.
    let curve = z_form(&lag, 0.0, h);
    assert!(curve.len() > 100 && curve[0][0] < h);
    assert!(z_form(&lag, 0.0, -1.0).is_empty() && z_form(&lag, f64::NAN, h).is_empty());
}
