//! How fast a relay loop is simulated and predicted, and how that grows with order and duration.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hysteron_core::explore::{ExploreInput, compute};
use hysteron_core::limit_cycle::{describing_function, exact_cycle};
use hysteron_core::plant::TransferFunction;
use hysteron_core::relay::Relay;
use hysteron_core::simulate::{Options, run};

/// `1/(s+1)^n`.
fn lag(order: usize) -> TransferFunction {
    let mut denominator = vec![0.0; order + 1];
    denominator[0] = 1.0;
    for n in 1..=order {
        for i in (1..=n).rev() {
            denominator[i] += denominator[i - 1];
        }
    }
    TransferFunction::new(&[1.0], &denominator, 0.0)
}

const ORDERS: [usize; 5] = [2, 3, 4, 8, 12];

fn simulation(c: &mut Criterion) {
    let relay = Relay::default();
    let mut group = c.benchmark_group("simulate");
    for order in ORDERS {
        let plant = lag(order);
        let space = plant.state_space();
        let Some(first) = describing_function(&plant, &relay).first().copied() else {
            continue;
        };
        for periods in [10_u64, 1000] {
            let options = Options {
                step: None,
                ..Options::new(first.cycle.period * periods as f64, 1.0)
            };
            group.throughput(Throughput::Elements(periods));
            group.bench_with_input(
                BenchmarkId::new(format!("{periods} periods of order"), order),
                &options,
                |b, o| b.iter(|| run(black_box(&space), &relay, 0.0, o)),
            );
        }
    }
}

fn prediction(c: &mut Criterion) {
    let relay = Relay::default();
    let mut group = c.benchmark_group("predict");
    for order in ORDERS {
        let plant = lag(order);
        let space = plant.state_space();
        group.bench_with_input(
            BenchmarkId::new("all intersections, order", order),
            &plant,
            |b, p| {
                b.iter(|| describing_function(black_box(p), &relay));
            },
        );
        let Some(first) = describing_function(&plant, &relay).first().copied() else {
            continue;
        };
        let guess = 0.5 * first.cycle.period;
        group.bench_with_input(
            BenchmarkId::new("exact cycle with stability, order", order),
            &space,
            |b, s| {
                b.iter(|| exact_cycle(black_box(s), &relay, 0.0, guess));
            },
        );
    }
    let uneven = Relay {
        asymmetry: 0.3,
        ..relay
    };
    let space = lag(3).state_space();
    group.bench_function("exact asymmetric cycle, order 3", |b| {
        b.iter(|| exact_cycle(black_box(&space), &uneven, 0.0, 2.4));
    });
}

/// 128 x 128 exact cycles over gain and hysteresis on one core, as a parameter map has them.
fn map(c: &mut Criterion) {
    let space = lag(3).state_space();
    let plant = lag(3);
    let mut group = c.benchmark_group("map");
    group.sample_size(10);
    group.throughput(Throughput::Elements(128 * 128));
    group.bench_function("128 x 128 exact cycles", |b| {
        b.iter(|| {
            let mut found = 0;
            for i in 0..128 {
                for j in 0..128 {
                    let relay = Relay {
                        gain: 1.0 + 0.03 * f64::from(i),
                        hysteresis: 0.002 * f64::from(j),
                        ..Relay::default()
                    };
                    let guess = describing_function(&plant, &relay)
                        .first()
                        .map_or(2.0, |i| 0.5 * i.cycle.period);
                    found += usize::from(exact_cycle(&space, &relay, 0.0, guess).is_some());
                }
            }
            black_box(found)
        });
    });
}

fn page(c: &mut Criterion) {
    let input = ExploreInput::default();
    c.bench_function("explore, slider to data", |b| {
        b.iter(|| compute(black_box(&input)));
    });
}

criterion_group!(benches, simulation, prediction, map, page);
criterion_main!(benches);
