//! How fast a record is criticised against the whole library, and how that grows with its length: a drive
//! under a relay whose input comes late, as an encoder and a noisy tachometer show it.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::progress::Progress;

/// Sampling time, s; samples by which the input comes late.
const STEP: f64 = 2e-4;
const LATE: usize = 4;

/// Torque of the relay, N m, with an asymmetry of a tenth; its threshold, rad/s.
const TORQUE: f64 = 0.5;
const THRESHOLD: f64 = 0.5;

/// Inertia, kg m^2, and viscous friction, N m s/rad.
const BODY: (f64, f64) = (8.8e-4, 2e-3);

/// Noise of the velocity, rad/s, and step of the encoder, rad.
const NOISE: f64 = 0.004;
const ENCODER: f64 = std::f64::consts::TAU / 1_048_576.0;

/// A record of `samples`, by small exact steps.
fn recorded(samples: usize) -> Option<Measurement> {
    let rate = BODY.1 / BODY.0;
    let decay = (-rate * STEP).exp();
    let (phi1, mut seed) = ((1.0 - decay) / rate, 1_u64);
    let mut even = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let (mut x, mut v, mut high) = (0.0_f64, 0.0_f64, false);
    let mut torques = vec![0.0; LATE];
    let mut text = "t [s],u [N m],x1 [rad],v1 [rad/s]\n".to_owned();
    for i in 0..samples {
        // Twelve even numbers make a normal one.
        let normal: f64 = (0..12).map(|_| even()).sum::<f64>() - 6.0;
        let shown = v + NOISE * normal;
        high = if high {
            shown > -THRESHOLD
        } else {
            shown > THRESHOLD
        };
        let torque = if high { -0.9 * TORQUE } else { 1.1 * TORQUE };
        torques.push(torque);
        let position = (x / ENCODER).round() * ENCODER;
        let time = i as f64 * STEP;
        writeln!(text, "{time:.4},{torque},{position:.8},{shown:.5}").ok()?;
        let push = torques[i] / BODY.0;
        x += phi1 * v + (STEP - phi1) / rate * push;
        v = decay * v + phi1 * push;
    }
    import_csv("late", text.as_bytes(), None).ok()
}

fn diagnosis(c: &mut Criterion) {
    let mut group = c.benchmark_group("diagnosis");
    group.sample_size(10).warm_up_time(Duration::from_millis(1));
    for samples in [10_000, 100_000, 1_000_000] {
        let Some(record) = recorded(samples) else {
            continue;
        };
        group.throughput(Throughput::Elements(samples as u64));
        group.bench_with_input(
            BenchmarkId::from_parameter(samples),
            &record,
            |b, record| {
                b.iter(|| {
                    let mut job = DiagnosisJob::new(black_box(record)).ok()?;
                    loop {
                        if let Progress::Done(diagnosis) = job.advance() {
                            return Some(diagnosis);
                        }
                    }
                });
            },
        );
    }
    group.finish();
}

criterion_group!(benches, diagnosis);
criterion_main!(benches);
