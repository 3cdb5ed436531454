//! The gap found from the motor's side, in records of rigs that are not the project's model, and nothing
//! claimed where there is none to see.

#![allow(
    clippy::large_types_passed_by_value,
    reason = "definitions of rigs are plain values"
)]

use std::path::Path;

use crate::support::drive_cases::play;
use hysteron_core::backlash::{
    GapError, GapEstimate, MapSilence, Quality, Segment, Side, backlash_map, estimate_gap, pelt,
};
use hysteron_core::measurement::{Channel, Kind, Measurement, Quantity, import_csv};
use hysteron_core::rig::Random;
use hysteron_core::rig::{
    DriveRig, Excitation, Friction, Load, Recorded, SAMPLING, Stranger, carried_over,
};
use proptest::prelude::*;

/// What the issue of an estimate may be off by.
const WITHIN: f64 = 0.05;

fn file(path: &str) -> Measurement {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    let bytes = std::fs::read(&path).unwrap();
    import_csv("rig.csv", &bytes, None).unwrap()
}

fn estimate(measurement: &Measurement) -> GapEstimate {
    estimate_gap(measurement).unwrap()
}

#[track_caller]
fn close(estimate: &GapEstimate, truth: f64) {
    let gap = estimate
        .gap
        .unwrap_or_else(|| panic!("none: {}", estimate.text));
    assert!(
        (gap / truth - 1.0).abs() < WITHIN,
        "{gap} for {truth}: {}",
        estimate.text
    );
}

#[track_caller]
fn nothing(estimate: &GapEstimate) {
    assert_eq!(
        (estimate.gap, estimate.std_error, estimate.interval),
        (None, None, None),
        "{}",
        estimate.text
    );
    assert!(!estimate.text.is_empty());
}

#[test]
fn drive_10_has_its_gap_by_three_traverses() {
    let estimate = estimate(&file("assets/measurements/drive-10.csv"));
    close(&estimate, 0.012);
    assert_eq!(estimate.quality, Quality::Good);
    assert_eq!(estimate.traverses.len(), 3);
    assert_eq!(estimate.unit, "rad");
    let [low, high] = estimate.interval.unwrap();
    assert!(low < 0.012 && 0.012 < high, "{low} to {high}");
    assert!(
        estimate.text.to_string().contains("three traverses agree"),
        "{}",
        estimate.text
    );
    for traverse in &estimate.traverses {
        assert!(traverse.from.time < traverse.to.time && traverse.from.side != traverse.to.side);
    }
    // The load is 8.8e-4 kg m^2 like the motor, with 0.004 N m s/rad and no dry friction.
    let load = estimate.load.unwrap();
    assert!((load.inertia_ratio - 1.0).abs() < 0.15, "{load:?}");
    assert!(
        (load.viscous / (0.004 / 8.8e-4) - 1.0).abs() < 0.25,
        "{load:?}"
    );
}

#[test]
fn drive_03_has_its_gap_if_it_started_in_the_middle_and_says_so() {
    let estimate = estimate(&file("assets/measurements/drive-03.csv"));
    close(&estimate, 0.019);
    assert_eq!(estimate.quality, Quality::AssumedCentre);
    assert!(estimate.traverses.is_empty());
    assert!(estimate.contacts.iter().all(|c| c.side == Side::Positive));
    assert!(
        estimate
            .text
            .to_string()
            .contains("if the motor started in its middle"),
        "{}",
        estimate.text
    );
    // The pattern changes where the motor reaches the load and where the relay turns the drift.
    let engaged: Vec<f64> = estimate
        .cycles
        .iter()
        .filter(|c| c.engaged)
        .map(|c| c.time)
        .collect();
    assert!(
        engaged
            .iter()
            .all(|t| (2.2..3.01).contains(t) || (8.6..9.01).contains(t)),
        "{engaged:?}"
    );
}

#[test]
fn the_columns_of_the_load_are_never_read() {
    for name in ["drive-03", "drive-10"] {
        let whole = file(&format!("assets/measurements/{name}.csv"));
        let mut without = whole.clone();
        without.reference.clear();
        let mut wrong = whole.clone();
        for channel in &mut wrong.reference {
            let mut random = Random::new(7);
            for value in &mut channel.values {
                *value = random.normal();
            }
        }
        let mut damaged = whole.clone();
        damaged.reference[0].values = vec![f64::NAN; 3];
        let expected = estimate(&whole);
        assert_eq!(expected, estimate(&without));
        assert_eq!(expected, estimate(&wrong));
        assert_eq!(expected, estimate(&damaged));
    }
}

#[test]
fn no_gap_is_claimed_where_a_relay_shows_something_else() {
    for name in ["01", "02", "04", "05", "06", "07", "12"] {
        let estimate = estimate(&file(&format!("tests/data/drive-{name}.csv")));
        nothing(&estimate);
        assert_eq!(estimate.quality, Quality::NoEngagement, "drive-{name}");
        assert!(
            estimate.text.to_string().contains("never changed its sign"),
            "{}",
            estimate.text
        );
    }
}

/// A drifting test on a rig that carries the free motor over `travel` rad before the relay flips.
fn drifting(rig: DriveRig, travel: f64, flip: f64) -> DriveRig {
    carried_over(&rig, travel, flip, |rig| DriveRig {
        samples: (flip / SAMPLING) as usize,
        load: None,
        ..rig
    })
}

/// A rig with this gap: all that a diagnosis does not know is drawn from the seed.
fn with_gap(gap: f64, seed: u64) -> DriveRig {
    let mut random = Random::new(seed);
    let stiffness = random.between(1500.0, 10_000.0);
    let load = Load {
        half_gap: gap / 2.0,
        stiffness,
        damping: random.between(0.3, 0.6) * (stiffness * 4.4e-4).sqrt(),
        inertia: 8.8e-4 * random.between(0.6, 1.8),
        viscous: random.between(2e-3, 5e-3),
        coulomb: random.between(0.002, 0.012),
    };
    let rig = DriveRig {
        seed: random.seed(),
        inertia: 8.8e-4 * random.between(0.9, 1.1),
        viscous: 2e-3 * random.between(0.8, 1.2),
        friction: Friction::dry(random.between(0.0, 0.03)),
        delay: (random.between(0.0, 3e-4) / 1e-5).round() * 1e-5,
        load: Some(load),
        load_start: gap * random.between(-0.3, 0.3),
        load_recorded: true,
        samples: 45_000,
        ..DriveRig::default()
    };
    drifting(rig, 1.4 * gap, 2.25)
}

/// How many of the rigs have the truth in their 95 % interval; each must be close.
fn covered(rigs: &[(f64, DriveRig)]) -> usize {
    rigs.iter()
        .filter(|(gap, rig)| {
            let estimate = estimate(&rig.measure());
            close(&estimate, *gap);
            assert!(
                matches!(
                    estimate.quality,
                    Quality::Good | Quality::Fair | Quality::Poor
                ),
                "{:?} {}",
                estimate.quality,
                estimate.text
            );
            let [low, high] = estimate.interval.unwrap();
            low <= *gap && *gap <= high
        })
        .count()
}

#[test]
fn rigs_with_gaps_from_4_to_10_mrad() {
    let gaps = [0.004, 0.005, 0.006, 0.007, 0.008, 0.01];
    let rigs: Vec<(f64, DriveRig)> = gaps
        .iter()
        .zip(100..)
        .map(|(gap, seed)| (*gap, with_gap(*gap, seed)))
        .collect();
    assert!(covered(&rigs) >= 5);
}

#[test]
fn rigs_with_gaps_from_12_to_30_mrad() {
    let gaps = [0.012, 0.015, 0.019, 0.022, 0.026, 0.03];
    let rigs: Vec<(f64, DriveRig)> = gaps
        .iter()
        .zip(200..)
        .map(|(gap, seed)| (*gap, with_gap(*gap, seed)))
        .collect();
    assert!(covered(&rigs) >= 5);
}

#[test]
fn the_interval_holds_the_truth_over_seeds() {
    let rigs: Vec<(f64, DriveRig)> = (300..312)
        .map(|seed| (0.009, with_gap(0.009, seed)))
        .collect();
    // Of 12 with a chance of 95 % each, 10 or more: 98 %.
    assert!(covered(&rigs) >= 10);
}

/// A load with dry friction that the motor pushes along in some cycles and misses in others, behind a motor that rubs
/// itself: no run of cycles shows a drift of its own, and single ones must do.
#[test]
fn a_load_that_is_pushed_along_now_and_then_has_its_gap() {
    let rigs: Vec<(f64, DriveRig)> = (400..406)
        .map(|seed| {
            let mut random = Random::new(seed);
            let rig = DriveRig {
                seed: random.seed(),
                inertia: 8.8e-4 * random.between(0.9, 1.1),
                friction: Friction::dry(random.between(0.03, 0.05)),
                load: Some(play(0.003, 0.01)),
                load_recorded: true,
                samples: 25_000,
                ..DriveRig::default()
            };
            (0.006, drifting(rig, 0.009, 1.5))
        })
        .collect();
    assert!(covered(&rigs) >= 5);
    for (gap, rig) in &rigs {
        let estimate = estimate(&rig.measure());
        for traverse in &estimate.traverses {
            assert!((traverse.gap / gap - 1.0).abs() < 0.1, "{traverse:?}");
        }
    }
}

/// A load with much dry friction is met in every second cycle for as long as the motor drifts one way: the mean of two
/// is then what shows how the pattern differs from that of the free motor, which crosses the gap once in each phase.
/// Where no run shows the free motor nothing may be stated; what is stated must be right.
#[test]
fn a_load_that_is_met_in_every_second_cycle_has_its_gap() {
    let mut stated = 0;
    for seed in 500..508 {
        let mut random = Random::new(seed);
        let half_gap = random.between(0.002, 0.004);
        let rig = DriveRig {
            seed: random.seed(),
            inertia: 8.8e-4 * random.between(0.9, 1.1),
            viscous: 2e-3 * random.between(0.8, 1.2),
            load: Some(play(half_gap, 0.03)),
            samples: 25_000,
            ..DriveRig::default()
        };
        let estimate = estimate(&drifting(rig, 3.0 * half_gap, 2.0).measure());
        let Some(gap) = estimate.gap else { continue };
        assert!(
            (gap / (2.0 * half_gap) - 1.0).abs() < 0.1,
            "{seed}: {}",
            estimate.text
        );
        stated += 1;
    }
    assert!(stated >= 5, "{stated}");
}

/// Such a load may rattle to and fro faster than the motor drifts. Gap and speed of the load can then be
/// scaled together nearly as one likes: the estimate is less good, and its interval must say so.
#[test]
fn a_load_without_dry_friction_flies_between_the_contacts() {
    let mut held = 0;
    for seed in 400..404 {
        let base = with_gap(0.012, seed);
        let load = base.load.map(|load| Load {
            coulomb: 0.0,
            viscous: 4e-3,
            inertia: 8.8e-4,
            ..load
        });
        let estimate = estimate(&DriveRig { load, ..base }.measure());
        let gap = estimate.gap.unwrap();
        assert!((gap / 0.012 - 1.0).abs() < 0.1, "{}", estimate.text);
        let [low, high] = estimate.interval.unwrap();
        held += usize::from(low < 0.012 && 0.012 < high);
    }
    assert!(held >= 3);
}

#[test]
fn position_or_velocity_alone_suffices() {
    for recorded in [Recorded::PositionOnly, Recorded::VelocityOnly] {
        let rig = DriveRig {
            recorded,
            ..with_gap(0.011, 500)
        };
        let estimate = estimate(&rig.measure());
        close(&estimate, 0.011);
        assert_eq!(estimate.unit, "rad");
    }
}

#[test]
fn a_slide_has_its_gap_in_metres() {
    // The same equations with a mass, a force and a length, all a tenth.
    let mut record = with_gap(0.01, 510).measure();
    for (channel, unit) in record.outputs.iter_mut().zip(["m", "m/s"]) {
        unit.clone_into(&mut channel.unit);
        for value in &mut channel.values {
            *value *= 0.1;
        }
    }
    "N".clone_into(&mut record.input.unit);
    let estimate = estimate(&record);
    close(&estimate, 0.001);
    assert_eq!(estimate.unit, "m");
}

#[test]
fn no_gap_is_claimed_where_a_drifting_relay_shows_something_else() {
    let base = DriveRig {
        inertia: 8.5e-4,
        samples: 30_000,
        excitation: Excitation::Relay {
            gain: 0.5,
            asymmetry: 0.25,
            hysteresis: 0.5,
            flip: Some(1.5),
        },
        ..DriveRig::default()
    };
    let stribeck = Friction {
        coulomb: 0.03,
        standing: 0.06,
        stribeck_velocity: 0.6,
        displacement: 2e-5,
    };
    let presliding = Friction {
        displacement: 3e-3,
        ..Friction::dry(0.05)
    };
    let shaft = Load {
        half_gap: 0.0,
        stiffness: 200.0,
        damping: 0.1,
        inertia: 8.8e-4,
        viscous: 2e-3,
        coulomb: 0.01,
    };
    let strange = |stranger| DriveRig {
        stranger: Some(stranger),
        ..base
    };
    for (name, rig) in [
        ("nothing", base),
        (
            "Coulomb",
            DriveRig {
                friction: Friction::dry(0.04),
                ..base
            },
        ),
        (
            "Stribeck",
            DriveRig {
                friction: stribeck,
                ..base
            },
        ),
        (
            "presliding",
            DriveRig {
                friction: presliding,
                ..base
            },
        ),
        (
            "drag",
            DriveRig {
                quadratic_drag: 6e-5,
                ..base
            },
        ),
        (
            "cogging",
            DriveRig {
                cogging: (0.05, 6.0, 0.4),
                ..base
            },
        ),
        (
            "fine cogging",
            DriveRig {
                cogging: (0.03, 300.0, 0.4),
                ..base
            },
        ),
        (
            "constant load",
            DriveRig {
                constant_load: 0.02,
                ..base
            },
        ),
        (
            "delay",
            DriveRig {
                delay: 8e-4,
                ..base
            },
        ),
        (
            "lag",
            DriveRig {
                actuator_lag: 9e-4,
                ..base
            },
        ),
        (
            "gain asymmetry",
            DriveRig {
                gain_asymmetry: 0.06,
                ..base
            },
        ),
        (
            "dead zone",
            DriveRig {
                dead_zone: 0.03,
                ..base
            },
        ),
        (
            "saturation",
            DriveRig {
                saturation: 0.45,
                ..base
            },
        ),
        (
            "hard spot",
            strange(Stranger::HardSpot {
                torque: 0.05,
                at: 0.003,
                width: 0.001,
            }),
        ),
        (
            "pulse",
            strange(Stranger::Pulse {
                torque: 0.1,
                from: 2.0,
                length: 0.05,
            }),
        ),
        (
            "speed bump",
            strange(Stranger::SpeedBump {
                torque: 0.05,
                centre: 0.3,
                width: 0.1,
            }),
        ),
        ("warming", strange(Stranger::Warming { factor: 3.0 })),
        (
            "shaft",
            DriveRig {
                load: Some(shaft),
                ..base
            },
        ),
        (
            "gap wider than the travel",
            DriveRig {
                load: Some(Load {
                    half_gap: 0.2,
                    ..shaft
                }),
                ..base
            },
        ),
    ] {
        let estimate = estimate(&rig.measure());
        assert!(estimate.gap.is_none(), "{name}: {}", estimate.text);
    }
}

#[test]
fn other_excitations_are_no_drifting_test() {
    let load = with_gap(0.01, 600).load;
    for excitation in [
        Excitation::Multisine { amplitude: 0.08 },
        Excitation::Staircase { top: 0.3 },
    ] {
        let rig = DriveRig {
            excitation,
            load,
            ..DriveRig::default()
        };
        let estimate = estimate(&rig.measure());
        nothing(&estimate);
        assert_eq!(estimate.quality, Quality::NoDriftingTest);
        assert!(estimate.text.to_string().contains("no drifting test"));
    }
}

/// Fig. 7: where both positions are measured the map has the gap.
#[test]
fn fig_7_the_map_shows_gap_and_asymmetry() {
    let map = backlash_map(&file("assets/measurements/drive-10.csv")).unwrap();
    assert!(
        (map.gap.unwrap() / 0.012 - 1.0).abs() < 0.02,
        "{:?}",
        map.gap
    );
    assert!(map.asymmetry.unwrap().abs() < 1e-4, "{:?}", map.asymmetry);
    // In drive-03 the load was only ever pushed one way.
    let map = backlash_map(&file("assets/measurements/drive-03.csv")).unwrap();
    assert!((map.positive.unwrap().offset / 0.0095 - 1.0).abs() < 0.03);
    assert_eq!((map.negative, map.gap), (None, None));
    // Zero of the load's encoder beside that of the motor's.
    let mut record = with_gap(0.008, 700).measure();
    for value in &mut record.reference[0].values {
        *value += 0.002;
    }
    let map = backlash_map(&record).unwrap();
    assert!(
        (map.gap.unwrap() / 0.008 - 1.0).abs() < 0.03,
        "{:?}",
        map.gap
    );
    assert!(
        (map.asymmetry.unwrap() + 0.002).abs() < 1e-4,
        "{:?}",
        map.asymmetry
    );
    record.reference.clear();
    assert!(
        backlash_map(&record)
            .unwrap_err()
            .to_string()
            .contains("x2")
    );
}

#[test]
fn the_map_has_the_gap_of_rigs_and_none_of_a_load_that_stands_still() {
    for (gap, seed) in [(0.004, 710), (0.007, 711), (0.012, 712), (0.025, 713)] {
        let record = with_gap(gap, seed).measure();
        let map = backlash_map(&record).unwrap();
        let found = map
            .gap
            .unwrap_or_else(|| panic!("{seed}: {:?}", map.silence));
        assert!((found / gap - 1.0).abs() < 0.05, "{seed}: {found}");
        // The same load at rest: noise, counts of its encoder, or nothing at all.
        for (name, noise, count) in [
            ("noise", 2e-5, 0.0),
            ("counts", 4e-6, 1e-5),
            ("none", 0.0, 0.0),
        ] {
            let mut random = Random::new(seed);
            let mut still = record.clone();
            for value in &mut still.reference[0].values {
                let read = noise * random.normal();
                *value = if count > 0.0 {
                    (read / count).round() * count
                } else {
                    read
                };
            }
            let map = backlash_map(&still).unwrap();
            assert_eq!(
                (map.gap, map.silence),
                (None, Some(MapSilence::NotMoved)),
                "{name}"
            );
        }
    }
}

/// The load is met in each of them, which so few samples do not show: not that there is none.
#[test]
fn few_samples_in_a_cycle_are_said_to_be_few() {
    for seed in [820, 825] {
        let record = with_gap(0.01, seed).measure();
        for every in [2, 3, 4, 6] {
            let estimate = estimate(&every_so_many(&record, every));
            nothing(&estimate);
            assert_eq!(estimate.quality, Quality::TooFewSamples, "{every}");
            assert!(
                estimate.text.to_string().contains("too few samples"),
                "{}",
                estimate.text
            );
        }
    }
}

/// A record of which one sample in so many was written.
fn every_so_many(record: &Measurement, every: usize) -> Measurement {
    let thin = |values: &[f64]| values.iter().step_by(every).copied().collect::<Vec<f64>>();
    let mut thinned = record.clone();
    thinned.time = thin(&record.time);
    thinned.input.values = thin(&record.input.values);
    for (to, from) in thinned.outputs.iter_mut().zip(&record.outputs) {
        to.values = thin(&from.values);
    }
    thinned.reference.clear();
    thinned
}

/// Optimal partitioning by trying all, Jackson et al. 2005.
fn cheapest(values: &[f64], penalty: f64) -> f64 {
    let cost = |part: &[f64]| {
        let mean = part.iter().sum::<f64>() / part.len() as f64;
        part.iter().map(|v| (v - mean).powi(2)).sum::<f64>()
    };
    let mut best = vec![-penalty];
    for to in 1..=values.len() {
        let least = (0..to)
            .map(|from| best[from] + cost(&values[from..to]) + penalty)
            .fold(f64::INFINITY, f64::min);
        best.push(least);
    }
    best[values.len()]
}

proptest! {
    #[test]
    fn pelt_is_as_good_as_trying_all(
        values in prop::collection::vec(-5.0..5.0_f64, 1..60),
        penalty in 0.5..20.0_f64,
    ) {
        let segments = pelt(&values, 1.0, penalty);
        prop_assert_eq!(segments[0].from, 0);
        prop_assert_eq!(segments[segments.len() - 1].to, values.len());
        let cost: f64 = segments
            .iter()
            .map(|s| values[s.from..s.to].iter().map(|v| (v - s.mean).powi(2)).sum::<f64>())
            .sum::<f64>()
            + penalty * (segments.len() - 1) as f64;
        prop_assert!((cost - cheapest(&values, penalty)).abs() < 1e-8);
    }

    #[test]
    fn garbage_is_no_panic(
        n in 0..400_usize,
        levels in prop::collection::vec(-1e3..1e3_f64, 1..6),
        seed in 0..1000_u64,
        position in any::<bool>(),
        velocity in any::<bool>(),
        even in any::<bool>(),
        scale in -300.0..300.0_f64,
    ) {
        let mut random = Random::new(seed);
        let mut t = 0.0;
        let time: Vec<f64> = (0..n)
            .map(|_| {
                t += if even { 1e-3 } else { random.between(1e-4, 1e-2) };
                t
            })
            .collect();
        let mut noise = |quantity, unit: &str| Channel {
            quantity,
            name: "c".to_owned(),
            unit: unit.to_owned(),
            values: (0..n).map(|_| 10_f64.powf(scale) * random.normal()).collect(),
        };
        let mut outputs = Vec::new();
        if position {
            outputs.push(noise(Quantity::Position, "rad"));
        }
        if velocity {
            outputs.push(noise(Quantity::Velocity, "rad/s"));
        }
        let input = Channel {
            quantity: Quantity::Input,
            name: "u".to_owned(),
            unit: "N m".to_owned(),
            values: (0..n).map(|i| levels[i / 4 % levels.len()]).collect(),
        };
        let measurement = Measurement {
            name: "garbage".to_owned(),
            kind: Kind::Drive,
            time,
            input,
            outputs,
            reference: vec![],
            warnings: vec![],
        };
        if let Ok(estimate) = estimate_gap(&measurement) {
            prop_assert!(!estimate.text.is_empty());
            prop_assert!(estimate.gap.is_none_or(f64::is_finite));
        }
        let _ = backlash_map(&measurement);
    }
}

#[test]
fn pelt_finds_planted_changes() {
    let mut random = Random::new(3);
    let values: Vec<f64> = (0..600)
        .map(|i| [0.0, 2.0, -1.0][i / 200] + 0.5 * random.normal())
        .collect();
    let segments = pelt(&values, 0.5, 3.0 * 600_f64.ln());
    let ends: Vec<usize> = segments.iter().map(|s: &Segment| s.to).collect();
    assert_eq!(ends.len(), 3);
    assert!(
        ends[0].abs_diff(200) <= 2 && ends[1].abs_diff(400) <= 2,
        "{ends:?}"
    );
    assert!(pelt(&[], 1.0, 1.0).is_empty() && pelt(&[1.0], 0.0, 1.0).is_empty());
}

#[test]
fn short_or_broken_records_say_what_is_wrong() {
    let record = with_gap(0.01, 800);
    for samples in [1, 20, 100, 700] {
        match estimate_gap(&DriveRig { samples, ..record }.measure()) {
            Ok(estimate) => nothing(&estimate),
            Err(error) => assert_eq!(error, GapError::Damaged),
        }
    }
    let whole = DriveRig {
        samples: 1000,
        ..record
    }
    .measure();
    let mut process = whole.clone();
    process.kind = Kind::Process;
    assert_eq!(estimate_gap(&process), Err(GapError::NotADrive));
    let mut blind = whole.clone();
    blind.outputs.clear();
    assert_eq!(estimate_gap(&blind), Err(GapError::NoMotorColumn));
    let mut holes = whole.clone();
    holes.outputs[0].values[7] = f64::NAN;
    assert_eq!(estimate_gap(&holes), Err(GapError::Damaged));
    let mut pause = whole;
    for time in &mut pause.time[500..] {
        *time += 100.0;
    }
    assert_eq!(estimate_gap(&pause), Err(GapError::UnevenTime));
}
