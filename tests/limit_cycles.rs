//! The exact table: period and amplitude of limit cycles that were solved to 15 digits elsewhere.

use hysteron_core::explore::{ExploreInput, compute};
use hysteron_core::limit_cycle::{describing_function, exact_symmetric};
use hysteron_core::plant::TransferFunction;
use hysteron_core::relay::Relay;
use hysteron_core::simulate::simulate;

struct Row {
    name: String,
    plant: TransferFunction,
    relay: Relay,
    period: f64,
    amplitude: f64,
}

fn table() -> Vec<Row> {
    let numbers = |text: &str| {
        text.split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect::<Vec<f64>>()
    };
    include_str!("data/limit_cycles.csv")
        .lines()
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

#[test]
fn exact_cycles_agree_with_the_reference_to_nine_digits() {
    let rows = table();
    assert_eq!(rows.len(), 12);
    for row in rows {
        let guess = describing_function(&row.plant, &row.relay)
            .first()
            .map_or(1.0, |i| 0.5 * i.cycle.period);
        let cycle = exact_symmetric(
            &row.plant.state_space(),
            &row.relay,
            row.plant.dead_time,
            guess,
        )
        .unwrap_or_else(|| panic!("{}: no cycle", row.name));
        close(&row.name, "period", cycle.period, row.period, 1e-9);
        close(&row.name, "amplitude", cycle.amplitude, row.amplitude, 1e-9);
    }
}

#[test]
fn long_simulations_settle_into_the_reference_periods() {
    for row in table() {
        let run = simulate(
            &row.plant.state_space(),
            &row.relay,
            row.plant.dead_time,
            row.period / 64.0,
            64 * 60,
        );
        let [.., a, b] = run.rises.as_slice() else {
            panic!("{}: no switches", row.name)
        };
        close(&row.name, "simulated period", b - a, row.period, 1e-9);
    }
}

#[test]
fn describing_function_of_the_third_order_lag() {
    // 1/(s+1)^3, k = 1, eps = 0.1: worked by hand from equations (5) and (6).
    let found = describing_function(&ExploreInput::default().plant, &Relay::default());
    assert_eq!(found.len(), 1);
    close("third-order lag", "omega", found[0].omega, 1.3258, 1e-4);
    close(
        "third-order lag",
        "period",
        found[0].cycle.period,
        4.7393,
        1e-4,
    );
    close(
        "third-order lag",
        "amplitude",
        found[0].cycle.amplitude,
        0.278_04,
        1e-4,
    );
    assert_eq!(found[0].cycle.stable, Some(true));
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
    assert!(
        data.simulated.is_some() && data.exact.is_none(),
        "{}",
        data.text
    );
}
