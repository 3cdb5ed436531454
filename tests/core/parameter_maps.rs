//! Parameter maps: every cell is the exact cycle of its loop, whatever order the cells come in.

use hysteron_core::maps::{Axis, Map, MapError, MapInput, MapJob, Outcome, Parameter, Quantity};
use hysteron_core::plant::TransferFunction;
use hysteron_core::relay::Relay;

fn small() -> MapInput {
    MapInput {
        size: 16,
        ..MapInput::default()
    }
}

fn finished(input: MapInput) -> Map {
    let mut job = MapJob::new(input).unwrap();
    while !job.advance().is_empty() {}
    job.map().clone()
}

#[test]
fn period_and_shape_depend_on_hysteresis_and_gain_by_their_ratio_only() {
    // y/k obeys the same loop with eps/k: the period is a function of eps/k, the amplitude k times one.
    let input = MapInput {
        x: Axis {
            parameter: Parameter::Hysteresis,
            from: 0.0,
            to: 0.8,
        },
        y: Axis {
            parameter: Parameter::Gain,
            from: 0.0,
            to: 1.6,
        },
        ..small()
    };
    let map = finished(input);
    let pairs = [([1, 1], [4, 4]), ([0, 1], [1, 4]), ([1, 2], [4, 7])];
    for (near, far) in pairs {
        let (near, far) = (map.known(near).unwrap(), map.known(far).unwrap());
        let (a, b) = (near.exact.unwrap(), far.exact.unwrap());
        assert!((a.period / b.period - 1.0).abs() < 1e-9);
        assert!((a.amplitude / near.gain * far.gain / b.amplitude - 1.0).abs() < 1e-9);
    }
}

#[test]
fn no_cycle_where_the_hysteresis_exceeds_what_the_relay_can_reach() {
    // Existence: k P(0) > eps, here k > eps.
    let input = small();
    let map = finished(input.clone());
    for y in 0..input.size {
        for x in 0..input.size {
            let relay = input.at([x, y]).relay;
            if relay.hysteresis > relay.gain {
                assert_eq!(map.known([x, y]).unwrap().exact, None, "{relay:?}");
            }
        }
    }
    assert!(map.known([0, 15]).unwrap().exact.is_some());
}

#[test]
fn a_cycle_of_which_the_describing_function_sees_nothing_is_on_the_map() {
    // One storage: T = 2 ln((k + eps)/(k - eps)).
    let mut input = MapInput {
        x: Axis {
            parameter: Parameter::Hysteresis,
            from: 0.0,
            to: 0.8,
        },
        ..small()
    };
    input.base.plant = TransferFunction::new(&[1.0], &[1.0, 1.0], 0.0);
    let map = finished(input.clone());
    for y in 0..input.size {
        for x in 0..input.size {
            let Relay {
                gain, hysteresis, ..
            } = input.at([x, y]).relay;
            let share: f64 = hysteresis / gain;
            let period = map.known([x, y]).unwrap().exact.map(|c| c.period);
            let exact = (share < 1.0).then(|| 4.0 * share.atanh());
            match (period, exact) {
                (Some(found), Some(exact)) => {
                    assert!((found / exact - 1.0).abs() < 1e-9, "{gain} {hysteresis}");
                }
                (found, exact) => assert_eq!(found, exact, "{gain} {hysteresis}"),
            }
        }
    }
}

#[test]
fn time_constants_stretch_the_period_and_nothing_else() {
    let base = MapInput::default().base;
    let mut slow = base.clone();
    Parameter::TimeScale.write(&mut slow, 2.5);
    let (fast, slow) = (Outcome::of(&base, None), Outcome::of(&slow, None));
    let (fast, slow) = (fast.exact.unwrap(), slow.exact.unwrap());
    assert!((slow.period / fast.period - 2.5).abs() < 1e-9);
    assert!((slow.amplitude / fast.amplitude - 1.0).abs() < 1e-9);
}

#[test]
fn quantities_of_the_third_order_lag() {
    // Exact period and amplitude of the reference table, describing function worked by hand.
    let outcome = Outcome::of(&MapInput::default().base, None);
    let check = |quantity: Quantity, expected: f64, tolerance: f64| {
        let value = quantity.value(&outcome).unwrap();
        assert!(
            (value - expected).abs() < tolerance,
            "{quantity:?}: {value}"
        );
    };
    check(Quantity::Period, 4.787_671_942, 1e-8);
    check(Quantity::Amplitude, 0.285_687_386, 1e-8);
    check(
        Quantity::UltimateGain,
        4.0 / (std::f64::consts::PI * 0.285_687_386),
        1e-7,
    );
    check(
        Quantity::PeriodError,
        100.0 * (4.7393 / 4.787_672 - 1.0),
        3e-3,
    );
    check(
        Quantity::AmplitudeError,
        100.0 * (0.278_04 / 0.285_687 - 1.0),
        3e-3,
    );
    check(Quantity::Stability, 1.0, 1e-12);
}

#[test]
fn a_coarse_picture_is_complete_after_one_batch_and_refines() {
    let mut job = MapJob::new(small()).unwrap();
    job.advance();
    let coarse = job.map().clone();
    assert!(coarse.share() < 0.3);
    for y in 0..16 {
        for x in 0..16 {
            assert!(coarse.at([x, y]).is_some());
        }
    }
    while !job.advance().is_empty() {}
    assert_eq!(job.share(), 1.0);
    assert_eq!(coarse.known([2, 4]), job.map().known([2, 4]));
}

#[test]
fn what_cannot_be_mapped_says_why() {
    let same = MapInput {
        y: small().x,
        ..small()
    };
    assert!(matches!(same.validate(), Err(MapError::SameParameter(_))));
    let mut backwards = small();
    backwards.x.to = -1.0;
    assert!(matches!(backwards.validate(), Err(MapError::Range { .. })));
    let mut negative = small();
    negative.y.from = -3.0;
    assert!(matches!(negative.validate(), Err(MapError::Loop(_))));
    let odd = MapInput {
        size: 100,
        ..small()
    };
    assert_eq!(odd.validate(), Err(MapError::Size(100)));
}
