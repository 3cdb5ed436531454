//! Figs. 7, 8, 10, 11 and 12 of the paper; the design of a drifting test; play in a relay loop.

use std::f64::consts::PI;

use hysteron_core::drive::{
    Adhesion, Body, Command, Contact, Drive, DriveFigure, DriveInput, DriveRun, EventKind,
    RoughDrive, Summary, TRAVERSES, Turn, checks, cycles_with_play, design_drifting_test, figures,
    loop_theory, play_describing_function, relay_seen_through_play, run, summarize,
};
use hysteron_core::explore::{ExploreInput, compute};
use hysteron_core::limit_cycle::exact_symmetric;
use hysteron_core::message::Message;
use hysteron_core::plant::TransferFunction;
use hysteron_core::relay::Relay;

fn figure(number: u32) -> (DriveFigure, DriveRun, Summary) {
    let figure = figures()
        .into_iter()
        .find(|f| f.number == number)
        .expect("the figure");
    let done = run(&figure.input).unwrap();
    let summary = summarize(&figure.input, &done);
    for check in checks(number, &figure.input, &done, &summary) {
        assert!(check.holds, "Fig. {number}: {}", check.text);
    }
    (figure, done, summary)
}

#[test]
fn fig_7_the_backlash_map_is_a_loop_of_two_branches_a_gap_apart() {
    let (_, done, summary) = figure(7);
    assert!((summary.gap().unwrap() - 0.019).abs() < 1e-6);
    // No point outside of the loop, and both ends met several times.
    for (x1, x2) in done.x1.iter().zip(&done.x2) {
        assert!((x1 - x2).abs() <= 0.0095 * (1.0 + 1e-12));
    }
    assert!(summary.traverses.len() >= 8, "{}", summary.traverses.len());
}

#[test]
fn fig_8_an_impact_hands_momentum_over_and_leaves_the_sum() {
    let (figure, done, _) = figure(8);
    let drive = figure.input.drive;
    let mut impacts = 0;
    for event in &done.events {
        let EventKind::Impact(side, speed) = event.kind else {
            continue;
        };
        impacts += 1;
        let mode = done.mode_at(event.time);
        assert_eq!(mode.met, Some((side, 0.0)));
        assert!(mode.pressed.is_none() && !mode.load_rests);
        // Without loss the kinetic energy stays as well, and the relative speed turns round.
        let [v1, v2] = event.speeds_before(&drive);
        let energy = drive.kinetic_energy(v1, v2) / drive.kinetic_energy(event.v1, event.v2);
        assert!((energy - 1.0).abs() < 1e-12, "{energy}");
        assert!((side.sign() * (event.v2 - event.v1) / speed - 1.0).abs() < 1e-12);
        // The load has moved freely since the sample before, from where it was at rest or slowed by its friction.
        let sample = done.time.partition_point(|t| *t < event.time) - 1;
        let quiet = !done.events.iter().any(|e| {
            e.time > done.time[sample] && e.time < event.time && e.kind != EventKind::SwitchUp
        });
        if quiet && done.v2[sample] == 0.0 {
            assert!(v2.abs() < 1e-12, "{v2}");
        }
    }
    assert!(impacts > 3, "{impacts}");
    // Both sides of an impact are among the instants, and the sum is continuous across it.
    let all = done.instants(&drive, 0.0, 0.6);
    let jumps: Vec<_> = all
        .windows(2)
        .filter(|w| w[0].time == w[1].time && w[0].load != w[1].load)
        .collect();
    assert_eq!(jumps.len(), impacts);
    for pair in jumps {
        let (a, b) = (pair[0].momentum(), pair[1].momentum());
        assert!((a - b).abs() < 1e-12 * pair[1].load.abs(), "{a} {b}");
    }
    // A load that its friction holds is said to rest.
    assert!(done.mode_at(0.0).load_rests);
}

#[test]
fn fig_10_the_limit_cycle_in_the_gap_has_its_characteristic_points() {
    let (figure, done, summary) = figure(10);
    let cycle = summary.cycle.unwrap();
    // By hand, without the small viscous friction: swing m eps^2 / 2 (1/(k - c) + 1/(k + c)) and
    // period 2 m eps (1/(k - c) + 1/(k + c)).
    let sum = 1.0 / 0.47 + 1.0 / 0.53;
    assert!((cycle.swing / (8.8e-4 * 0.125 * sum) - 1.0).abs() < 0.01);
    assert!((cycle.period / (8.8e-4 * 0.5 * 2.0 * sum) - 1.0).abs() < 0.01);
    assert!(cycle.swing < 2.0 * figure.input.drive.half_gap);
    // Each point of the closed form is an event of the simulation, at the same time after a switch.
    let start = done
        .events
        .iter()
        .rfind(|e| e.kind == EventKind::SwitchUp && e.time < 0.045)
        .expect("a switch");
    for point in cycle.points {
        let wanted = match point.turn {
            Turn::SwitchUp | Turn::Again => EventKind::SwitchUp,
            Turn::Peak | Turn::Trough => continue,
            Turn::SwitchDown => EventKind::SwitchDown,
            Turn::Top | Turn::Bottom => EventKind::Move(hysteron_core::drive::Mass::Motor),
        };
        let time = start.time + point.time;
        let event = done
            .events
            .iter()
            .find(|e| e.kind == wanted && (e.time - time).abs() < 1e-10)
            .unwrap_or_else(|| panic!("{point:?}"));
        assert!((event.x1 - start.x1 - point.x).abs() < 1e-12);
        assert!((event.v1 - point.v).abs() < 1e-12);
    }
}

#[test]
fn fig_11_the_drifting_cycle_repeats_itself_a_step_further() {
    let (_, done, summary) = figure(11);
    let cycle = summary.cycle.unwrap();
    let ups: Vec<_> = done
        .events
        .iter()
        .filter(|e| e.kind == EventKind::SwitchUp)
        .collect();
    for pair in ups.windows(2).skip(1) {
        assert!((pair[1].x1 - pair[0].x1 - cycle.drift).abs() < 1e-9 * cycle.drift.abs());
        assert!((pair[1].time - pair[0].time - cycle.period).abs() < 1e-9 * cycle.period);
    }
    assert!(cycle.drift < 0.0, "against the stronger push");
}

#[test]
fn fig_12_the_drift_changes_where_the_motor_meets_the_load() {
    let (_, _, summary) = figure(12);
    for traverse in &summary.traverses {
        assert!((traverse.travel / 0.019 - 1.0).abs() < 0.1, "{traverse:?}");
    }
    let free = summary.drifts[0].velocity.abs();
    for drift in &summary.drifts {
        assert!(
            (drift.velocity.abs() / free - 1.0).abs() < 1e-3,
            "{drift:?}"
        );
    }
}

/// A drive whose motor is known roughly: what the test is designed for, and what it meets.
fn rough(coulomb: f64, delay: f64, gap: f64, inertia: f64) -> RoughDrive {
    RoughDrive {
        motor: Body {
            inertia,
            viscous: 2.3 * inertia,
            coulomb,
        },
        load_coulomb: 0.5 * coulomb,
        delay,
        gap,
        torque: 700.0 * inertia,
        sampling: None,
        velocity_noise: 2e-3,
    }
}

#[test]
fn a_designed_test_crosses_the_gap_and_pushes_the_load() {
    for design_for in [
        rough(0.03, 0.0, 0.019, 8.8e-4),
        rough(0.03, 0.0, 0.004, 8.8e-4),
        rough(0.1, 0.0, 0.03, 5e-3),
        RoughDrive {
            sampling: Some(2e-4),
            ..rough(0.03, 0.0, 0.019, 8.8e-4)
        },
        RoughDrive {
            load_coulomb: 0.01,
            ..rough(0.0, 2e-4, 0.019, 8.8e-4)
        },
    ] {
        let test = design_drifting_test(&design_for).unwrap();
        assert!(test.warnings.is_empty(), "{:?}", test.warnings);
        assert!(test.cycle.swing < 0.1 * design_for.gap);
        assert!(
            test.relay.relay.gain * (1.0 + test.relay.relay.asymmetry)
                <= design_for.torque * (1.0 + 1e-12)
        );
        // The drive as it is: a fifth off in inertia and friction, with a load of its own.
        let motor = Body {
            inertia: 0.8 * design_for.motor.inertia,
            coulomb: 1.2 * design_for.motor.coulomb,
            ..design_for.motor
        };
        let drive = Drive {
            motor,
            load: Body {
                coulomb: design_for.load_coulomb,
                ..design_for.motor
            },
            half_gap: 0.5 * design_for.gap,
            contact: Contact::Rigid { restitution: 0.5 },
            adhesion: Adhesion::default(),
        };
        let input = DriveInput::new(drive, Command::Relay(test.relay), test.duration, None);
        let summary = summarize(&input, &run(&input).unwrap());
        assert!(
            summary.traverses.len() + 1 >= TRAVERSES,
            "{test:?}: {:?}",
            summary.traverses
        );
        for traverse in &summary.traverses {
            assert!(
                (traverse.travel / design_for.gap - 1.0).abs() < 0.15,
                "{traverse:?}"
            );
        }
    }
}

#[test]
fn a_design_says_what_it_cannot_do() {
    let said = |drive: &RoughDrive| {
        Message::list(" ", design_drifting_test(drive).unwrap().warnings).to_string()
    };
    let fine = rough(0.03, 0.0, 0.019, 8.8e-4);
    // Neither friction nor delay: nothing makes it drift but a delay that the controller adds.
    let mut smooth = rough(0.0, 0.0, 0.019, 8.8e-4);
    smooth.motor.viscous = 0.0;
    let test = design_drifting_test(&smooth).unwrap();
    assert!(test.added_delay > 0.0 && test.cycle.drift > 0.0, "{test:?}");
    let noisy = RoughDrive {
        velocity_noise: 10.0,
        ..fine
    };
    assert!(said(&noisy).contains("noise"), "{}", said(&noisy));
    let coarse = RoughDrive {
        sampling: Some(5e-2),
        ..fine
    };
    assert!(!said(&coarse).is_empty());
    let heavy = RoughDrive {
        load_coulomb: 10.0,
        ..fine
    };
    assert!(
        said(&heavy).contains("does not move motor and load"),
        "{}",
        said(&heavy)
    );
    let weak = RoughDrive {
        torque: 0.01,
        ..fine
    };
    let error = design_drifting_test(&weak).unwrap_err().to_string();
    assert!(error.contains("torque is 0.01"), "{error}");
}

/// First harmonic of play's output for `A sin(wt)`, by the definition: the play operator on samples.
fn play_by_samples(amplitude: f64, half_gap: f64) -> [f64; 2] {
    let n = 200_000;
    let mut out = 0.0_f64;
    let (mut sine, mut cosine) = (0.0, 0.0);
    for turn in 0..2 {
        for i in 0..n {
            let angle = 2.0 * PI * f64::from(i) / f64::from(n);
            let x = amplitude * angle.sin();
            out = out.clamp(x - half_gap, x + half_gap);
            if turn == 1 {
                sine += out * angle.sin();
                cosine += out * angle.cos();
            }
        }
    }
    let scale = 2.0 / f64::from(n) / amplitude;
    [scale * sine, scale * cosine]
}

#[test]
fn the_describing_function_of_play_is_its_first_harmonic() {
    for share in [0.0, 0.1, 0.5, 0.9, 0.999] {
        let n = play_describing_function(2.0, 2.0 * share).unwrap();
        let [re, im] = play_by_samples(2.0, 2.0 * share);
        assert!((n.re - re).abs() < 1e-4, "{share}: {n} {re}");
        assert!((n.im - im).abs() < 1e-4, "{share}: {n} {im}");
    }
    assert_eq!(play_describing_function(1.0, 1.0), None);
    assert_eq!(play_describing_function(f64::NAN, 1.0), None);
}

fn third_order_lag() -> TransferFunction {
    TransferFunction::new(&[1.0], &[1.0, 3.0, 3.0, 1.0], 0.0)
}

fn nothing() -> TransferFunction {
    TransferFunction::new(&[1.0], &[1.0], 0.0)
}

/// The loop with relay and play (and perhaps a lag behind it) by Runge-Kutta: period and amplitude.
fn by_small_steps(relay: &Relay, half_gap: f64, lag: Option<f64>) -> (f64, f64) {
    let h = 1e-4;
    let mut x = [0.3, 0.0, 0.0];
    let (mut out, mut seen, mut high) = (0.0_f64, 0.0_f64, false);
    let (mut rises, mut swing) = (Vec::new(), [0.0_f64; 2]);
    for i in 0..1_200_000 {
        let u = if high { -relay.gain } else { relay.gain };
        let f = |x: [f64; 3]| [x[1], x[2], u - x[0] - 3.0 * x[1] - 3.0 * x[2]];
        let add =
            |x: [f64; 3], k: [f64; 3], c: f64| [x[0] + c * k[0], x[1] + c * k[1], x[2] + c * k[2]];
        let k1 = f(x);
        let k2 = f(add(x, k1, 0.5 * h));
        let k3 = f(add(x, k2, 0.5 * h));
        let k4 = f(add(x, k3, h));
        for j in 0..3 {
            x[j] += h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
        }
        out = out.clamp(x[0] - half_gap, x[0] + half_gap);
        seen = match lag {
            Some(tau) => out + (seen - out) * (-h / tau).exp(),
            None => out,
        };
        if !high && seen > relay.hysteresis {
            high = true;
            rises.push(f64::from(i) * h);
        } else if high && seen < -relay.hysteresis {
            high = false;
        }
        if i > 1_000_000 {
            swing = [swing[0].min(x[0]), swing[1].max(x[0])];
        }
    }
    let n = rises.len();
    (
        (rises[n - 1] - rises[n - 9]) / 8.0,
        0.5 * (swing[1] - swing[0]),
    )
}

#[test]
fn play_before_a_relay_adds_its_half_gap_to_the_hysteresis() {
    let relay = Relay {
        hysteresis: 0.05,
        ..Relay::default()
    };
    let (period, amplitude) = by_small_steps(&relay, 0.05, None);
    let same = relay_seen_through_play(&relay, 0.05);
    let space = third_order_lag().state_space();
    let exact = exact_symmetric(&space, &same, 0.0, 0.5 * period).expect("a cycle");
    assert!(
        (period / exact.period - 1.0).abs() < 1e-4,
        "{period} {exact:?}"
    );
    assert!((amplitude / exact.amplitude - 1.0).abs() < 1e-4);
    // Harmonic balance with both describing functions in series comes close to it.
    let found = cycles_with_play(&third_order_lag(), 0.05, &nothing(), &relay).unwrap();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        (found[0].period / period - 1.0).abs() < 0.03,
        "{found:?} {period}"
    );
    assert!(
        (found[0].before / amplitude - 1.0).abs() < 0.05,
        "{found:?} {amplitude}"
    );
}

#[test]
fn a_loop_with_play_between_two_plants_oscillates_as_predicted() {
    let relay = Relay {
        hysteresis: 0.02,
        ..Relay::default()
    };
    let behind = TransferFunction::new(&[1.0], &[0.4, 1.0], 0.0);
    let (period, amplitude) = by_small_steps(&relay, 0.05, Some(0.4));
    let found = cycles_with_play(&third_order_lag(), 0.05, &behind, &relay).unwrap();
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        (found[0].period / period - 1.0).abs() < 0.03,
        "{found:?} {period}"
    );
    assert!(
        (found[0].before / amplitude - 1.0).abs() < 0.05,
        "{found:?} {amplitude}"
    );
    // Without play the same balance is that of equations (5) and (6).
    let none = cycles_with_play(&third_order_lag(), 0.0, &nothing(), &relay).unwrap();
    let known = hysteron_core::limit_cycle::describing_function(&third_order_lag(), &relay);
    assert!((none[0].omega / known[0].omega - 1.0).abs() < 1e-9);
    assert!((none[0].before / known[0].cycle.amplitude - 1.0).abs() < 1e-9);
}

#[test]
fn the_theory_of_a_loop_with_play_meets_its_exact_cycle() {
    let input = ExploreInput {
        plant: third_order_lag(),
        relay: Relay {
            hysteresis: 0.05,
            ..Relay::default()
        },
        noise: None,
    };
    let theory_of = |input: &ExploreInput, half_gap: f64| {
        loop_theory(input, &compute(input).unwrap(), half_gap)
    };
    let theory = theory_of(&input, 0.05);
    // Equation (3) in z: -H_h(-1) at the exact half period is eps/k.
    let [h, value] = theory.at_cycle.unwrap();
    assert!((value - 0.05).abs() < 1e-9, "{value}");
    let beside = |i: usize| (theory.z_form[i][0] - h).signum() * (theory.z_form[i][1] - 0.05);
    let ends = [beside(0), beside(theory.z_form.len() - 1)];
    assert!(
        ends[0] * ends[1] > 0.0,
        "it crosses the threshold once: {ends:?}"
    );
    // With play the exact cycle is that of the hysteresis 0.1, the table's 4.78767194204541 s.
    let exact = theory.with_play.unwrap();
    assert!((exact.period / 4.787_671_942_045_41 - 1.0).abs() < 1e-9);
    let (predicted, _) = theory.predicted[0];
    assert!((predicted.period / exact.period - 1.0).abs() < 0.03);
    // Nearly nothing passes a play as wide as the swing, and nearly all one that is small against it.
    let (first, last) = (theory.play[0], theory.play[theory.play.len() - 1]);
    assert!(first[0] < 0.05 && last[0] > 0.95, "{first:?} {last:?}");
    // Without play there is none, and an asymmetric relay has no symmetric cycle.
    let none = theory_of(&input, 0.0);
    assert!(none.play.is_empty() && none.predicted.is_empty());
    let mut asymmetric = input.clone();
    asymmetric.relay.asymmetry = 0.2;
    let none = theory_of(&asymmetric, 0.05);
    assert!(none.z_form.is_empty() && none.at_cycle.is_none());
}
