//! How fast a drive with a hidden gap is simulated: 12 s of a drifting test, some 6,000 switches.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use hysteron_core::drive::{
    Contact, DriveInput, DriveJob, RoughDrive, design_drifting_test, drifting_test, run, summarize,
};

/// Seconds that are simulated.
const SECONDS: u64 = 12;

fn drifting(contact: Contact, step: Option<f64>) -> DriveInput {
    let mut input = drifting_test();
    input.drive.contact = contact;
    input.duration = SECONDS as f64;
    input.step = step;
    input
}

fn simulation(c: &mut Criterion) {
    let mut group = c.benchmark_group("12 s of drifting drive");
    group.throughput(Throughput::Elements(SECONDS));
    for (name, contact, step) in [
        ("rigid, elastic", Contact::Rigid { restitution: 1.0 }, None),
        (
            "rigid, dying bounces",
            Contact::Rigid { restitution: 0.5 },
            None,
        ),
        (
            "rigid, with samples",
            Contact::Rigid { restitution: 1.0 },
            Some(2e-4),
        ),
        (
            "compliant",
            Contact::Compliant {
                stiffness: 1500.0,
                damping: 0.2,
            },
            None,
        ),
    ] {
        let input = drifting(contact, step);
        let done = run(&input).unwrap_or_default();
        let name = format!(
            "{name}: {} switches, {} impacts",
            done.switches(),
            done.impacts()
        );
        group.bench_function(name, |b| b.iter(|| run(black_box(&input))));
    }
}

fn page(c: &mut Criterion) {
    let input = drifting(Contact::Rigid { restitution: 1.0 }, Some(2.5e-4));
    let done = run(&input).unwrap_or_default();
    c.bench_function("summary of a run", |b| {
        b.iter(|| summarize(black_box(&input), &done));
    });
    c.bench_function("200 events, as a frame simulates at least", |b| {
        b.iter(|| {
            DriveJob::new(black_box(&input)).map(|mut job| {
                job.advance(200);
                job.time()
            })
        });
    });
    let rough = RoughDrive {
        motor: input.drive.motor,
        load_coulomb: 0.15,
        delay: 0.0,
        gap: 0.02,
        torque: 0.7,
        sampling: None,
        velocity_noise: 2e-3,
    };
    c.bench_function("design of a drifting test", |b| {
        b.iter(|| design_drifting_test(black_box(&rough)));
    });
}

criterion_group!(benches, simulation, page);
criterion_main!(benches);
