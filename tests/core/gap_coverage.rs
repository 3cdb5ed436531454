//! Do the intervals of gaps hold what they promise? Rigs that nobody tuned: heavy and light loads, soft and stiff
//! contacts, with noise and without any, on the bench of other physics and by the exact simulation.
//!
//! `cargo test` runs a few of the development seeds. The table of 200 rigs with a gap and 50 without a contact is
//! printed by
//!
//! ```text
//! HYSTERON_BENCH=full cargo test -p hysteron-core --test core gap_coverage -- --nocapture
//! ```
//!
//! `HYSTERON_BENCH_SEEDS=N` runs another seed: what is claimed comes from one above 5000, run once.

#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_macros,
    reason = "the core neither prints nor starts threads nor reads the clock; its bench does"
)]
#![allow(
    clippy::large_types_passed_by_value,
    reason = "definitions of rigs are plain values"
)]

use hysteron_core::backlash::{GapEstimate, estimate_gap};
use hysteron_core::drive::{
    self, Adhesion, Body, Command, Contact, Drive, DriveInput, VelocityRelay,
};
use hysteron_core::measurement::Measurement;
use hysteron_core::relay::Relay;
use hysteron_core::rig::{DriveRig, Friction, Load, Random, carried_over};

use crate::support::record::of_motor;
use crate::support::threads;

/// Rigs of the full bench with a gap that is met, and without a contact.
const RIGS: usize = 200;
const EMPTY: usize = 50;
/// The same in `cargo test`.
const QUICK: (usize, usize) = (8, 4);

/// Inertia of a motor, kg m^2.
const INERTIA: f64 = 8.8e-4;

/// Samples a second and seconds of a record.
const STEP: f64 = 2e-4;
const DURATION: f64 = 9.0;
/// Time between two flips of the asymmetry, s.
const FLIP: f64 = 2.25;

/// One rig and what is true of it.
struct Rig {
    name: String,
    kind: &'static str,
    gap: f64,
    met: bool,
    record: Measurement,
}

/// What was found on it.
struct Found {
    name: String,
    kind: &'static str,
    gap: f64,
    met: bool,
    estimate: GapEstimate,
}

/// Between two values, evenly in the logarithm.
fn log_between(random: &mut Random, low: f64, high: f64) -> f64 {
    (random.between(low.ln(), high.ln())).exp()
}

/// A load with everything drawn that the motor's side does not know.
fn drawn_load(random: &mut Random, gap: f64) -> Load {
    let inertia = INERTIA * log_between(random, 0.3, 5.0);
    let stiffness = log_between(random, 500.0, 20_000.0);
    let reduced = inertia * INERTIA / (inertia + INERTIA);
    Load {
        half_gap: 0.5 * gap,
        stiffness,
        damping: 2.0 * random.between(0.1, 0.6) * (stiffness * reduced).sqrt(),
        inertia,
        viscous: random.between(2e-3, 5e-3),
        coulomb: log_between(random, 0.003, 0.15),
    }
}

/// A rig of the bench: other physics, a sampled relay, an encoder, noise.
fn on_the_bench(seed: u64, gap: f64, met: bool) -> Rig {
    let mut random = Random::new(seed);
    let load = drawn_load(&mut random, gap);
    let noise = [0.0, 5e-4, 2e-3][(random.uniform() * 3.0) as usize % 3];
    let rig = DriveRig {
        seed: random.seed(),
        inertia: INERTIA * random.between(0.9, 1.1),
        viscous: 2e-3 * random.between(0.8, 1.2),
        friction: Friction::dry(random.between(0.0, 0.04)),
        delay: (random.between(0.0, 3e-4) / 1e-5).round() * 1e-5,
        velocity_noise: noise,
        load: Some(load),
        load_start: gap * random.between(-0.3, 0.3),
        samples: (DURATION / STEP) as usize,
        ..DriveRig::default()
    };
    let travel = if met { 1.4 * gap } else { 0.0 };
    let rig = carried_over(&rig, travel, FLIP, |rig| DriveRig {
        samples: (FLIP / STEP) as usize,
        load: None,
        ..rig
    });
    Rig {
        name: format!(
            "{seed}: J2/J1 {:.2}, K {:.0}, D {:.3}, c2 {:.3}, c1 {:.3}, noise {noise}",
            load.inertia / rig.inertia,
            load.stiffness,
            load.damping,
            load.coulomb,
            rig.friction.coulomb
        ),
        kind: if noise > 0.0 {
            "bench"
        } else {
            "bench, no noise"
        },
        gap,
        met,
        record: rig.measure(),
    }
}

/// A drive of the exact simulation, as `hysteron simulate` writes it.
fn simulated(seed: u64, gap: f64, met: bool) -> Rig {
    let mut random = Random::new(seed);
    let load = drawn_load(&mut random, gap);
    let rigid = random.uniform() < 0.4;
    let restitution = random.between(0.5, 1.0);
    let motor = Body {
        inertia: INERTIA * random.between(0.9, 1.1),
        viscous: 2e-3 * random.between(0.8, 1.2),
        coulomb: random.between(0.02, 0.05),
    };
    let contact = if rigid {
        Contact::Rigid { restitution }
    } else {
        Contact::Compliant {
            stiffness: load.stiffness,
            damping: load.damping,
        }
    };
    let input = |asymmetry: f64, gap: f64, duration: f64| {
        let drive = Drive {
            motor,
            load: Body {
                inertia: load.inertia,
                viscous: load.viscous,
                coulomb: load.coulomb,
            },
            half_gap: 0.5 * gap,
            contact,
            adhesion: Adhesion::default(),
        };
        let relay = VelocityRelay {
            relay: Relay {
                gain: 0.5,
                hysteresis: 0.5,
                asymmetry,
                ..Relay::default()
            },
            flip: Some(FLIP),
            sampling: None,
        };
        DriveInput::new(drive, Command::Relay(relay), duration, Some(STEP))
    };
    let crosses = |asymmetry: &f64| {
        let run = drive::run(&input(*asymmetry, 10.0, FLIP)).unwrap();
        let (low, high) = run
            .x1
            .iter()
            .fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(*x), h.max(*x)));
        high - low > 1.4 * gap || !met
    };
    let asymmetry = [0.15, 0.2, 0.25, 0.3, 0.35, 0.4]
        .into_iter()
        .find(crosses)
        .unwrap_or(0.4);
    let run = drive::run(&input(asymmetry, gap, DURATION)).unwrap();
    let contact = if rigid {
        format!("e {restitution:.2}")
    } else {
        format!("K {:.0}, D {:.3}", load.stiffness, load.damping)
    };
    Rig {
        name: format!(
            "{seed}: J2/J1 {:.2}, {contact}, c2 {:.3}, c1 {:.3}, {} impacts",
            load.inertia / motor.inertia,
            load.coulomb,
            motor.coulomb,
            run.impacts()
        ),
        kind: if rigid {
            "simulate, rigid"
        } else {
            "simulate, soft"
        },
        gap,
        met: run.impacts() > 0,
        record: record(&run),
    }
}

fn record(run: &drive::DriveRun) -> Measurement {
    let signals = [run.input.clone(), run.x1.clone(), run.v1.clone()];
    of_motor("simulated".to_owned(), run.time.clone(), signals)
}

fn rig(seed: u64, index: usize) -> Rig {
    let mut random = Random::new(seed.wrapping_mul(1_000_003).wrapping_add(index as u64));
    let met = index < RIGS;
    let gap = if met {
        log_between(&mut random, 0.004, 0.03)
    } else {
        2.0
    };
    let own = random.seed();
    if index.is_multiple_of(2) {
        on_the_bench(own, gap, met)
    } else {
        simulated(own, gap, met)
    }
}

fn look(rig: Rig) -> Found {
    Found {
        estimate: estimate_gap(&rig.record).unwrap(),
        name: rig.name,
        kind: rig.kind,
        gap: rig.gap,
        met: rig.met,
    }
}

impl Found {
    /// Standard errors between the estimate and the truth.
    fn sigmas(&self) -> Option<f64> {
        let error = self.estimate.std_error?;
        Some((self.estimate.gap? - self.gap) / error)
    }

    fn line(&self) -> String {
        let gap = self.estimate.gap.map_or_else(
            || "none".to_owned(),
            |g| {
                let percent = |v: f64| 100.0 * v / self.gap;
                let error = self.estimate.std_error.unwrap_or(0.0);
                format!("{:+.2} % ± {:.2} %", percent(g - self.gap), percent(error))
            },
        );
        let sigmas = self
            .sigmas()
            .map_or_else(String::new, |s| format!("{s:+.2}"));
        format!(
            "{sigmas:>8} {gap:>18}  {:?}, {} traverses, gap {:.4} rad [{}] {}",
            self.estimate.quality,
            self.estimate.traverses.len(),
            self.gap,
            self.kind,
            self.name
        )
    }
}

/// Standard errors of a normal distribution within which 95 % lie.
const NORMAL_95: f64 = 1.96;

/// Of the rigs of a kind: how many, stated, held by their interval, and within 5 %; median error and standard error in
/// per cent of the gap.
struct Row {
    count: usize,
    stated: usize,
    held: usize,
    close: usize,
    error: f64,
    std_error: f64,
}

impl Row {
    fn new(found: &[&Found]) -> Self {
        let stated: Vec<(f64, f64, f64)> = found
            .iter()
            .filter_map(|f| {
                let off = (f.estimate.gap? - f.gap).abs() / f.gap;
                Some((f.sigmas()?.abs(), off, f.estimate.std_error? / f.gap))
            })
            .collect();
        let median = |value: &dyn Fn(&(f64, f64, f64)) -> f64| {
            let mut values: Vec<f64> = stated.iter().map(value).collect();
            values.sort_by(f64::total_cmp);
            100.0 * values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
        };
        Self {
            count: found.len(),
            stated: stated.len(),
            held: stated.iter().filter(|s| s.0 <= NORMAL_95).count(),
            close: stated.iter().filter(|s| s.1 <= 0.05).count(),
            error: median(&|s| s.1),
            std_error: median(&|s| s.2),
        }
    }

    fn print(&self, kind: &str) {
        println!(
            "| {kind} | {} | {} | {} ({:.0} %) | {} | {:.2} % | {:.2} % |",
            self.count,
            self.stated,
            self.held,
            100.0 * self.held as f64 / self.stated.max(1) as f64,
            self.close,
            self.error,
            self.std_error
        );
    }
}

/// The table of docs/gap.md; gives its last row.
fn table(met: &[&Found]) -> Row {
    println!(
        "| rigs | number | gap stated | held by the 95 % interval | within 5 % | median error | median std. error |"
    );
    println!("|---|---|---|---|---|---|---|");
    for kind in [
        "bench",
        "bench, no noise",
        "simulate, rigid",
        "simulate, soft",
    ] {
        let of: Vec<&Found> = met.iter().copied().filter(|f| f.kind == kind).collect();
        Row::new(&of).print(kind);
    }
    let all = Row::new(met);
    all.print("all");
    all
}

#[test]
fn intervals_hold_the_gap_of_rigs_that_nobody_tuned() {
    let full = std::env::var("HYSTERON_BENCH").is_ok_and(|v| v == "full");
    let seed = std::env::var("HYSTERON_BENCH_SEEDS")
        .ok()
        .and_then(|s| s.parse().ok())
        .unwrap_or(1);
    let (with, without) = if full { (RIGS, EMPTY) } else { QUICK };
    let indices: Vec<usize> = (0..with).chain(RIGS..RIGS + without).collect();
    let found = threads::each(&indices, |index| look(rig(seed, *index)));
    for f in &found {
        println!("{}", f.line());
    }
    let met: Vec<&Found> = found.iter().filter(|f| f.met).collect();
    let row = table(&met);
    let claimed: Vec<String> = found
        .iter()
        .filter(|f| !f.met && !f.estimate.contacts.is_empty())
        .map(Found::line)
        .collect();
    println!(
        "{} without a contact, {} claimed",
        found.len() - met.len(),
        claimed.len()
    );
    assert_eq!(claimed, Vec::<String>::new());
    // Of eight with a chance of 97 % each (what is stated of 200), seven or more: 98 %. All of them are asked for nine
    // in ten.
    assert!(10 * row.stated >= 9 * row.count || row.count - row.stated <= 1);
    // Of eight with a chance of 95 % each, six or more: 99 %.
    assert!(100 * row.held >= 75 * row.stated);
    assert!(10 * row.close >= 9 * row.stated);
}
