//! The loop with a tuned controller: against closed forms, balances that must hold, and halved steps;
//! and the whole auto-tuning experiment.

use std::f64::consts::PI;

use hysteron_core::plant::{TransferFunction, presets};
use hysteron_core::relay::Relay;
use hysteron_core::tuning::{
    Disturbance, Identified, LoopReport, Model, NyquistPoint, Parallel, Pid, RULES, Response,
    Target, TuningError, TuningInput, TuningReport, Ultimate, Wish, close as close_loop, margins,
    respond, rule, tune, unstable_poles,
};
use nalgebra::Complex;
use proptest::prelude::*;

fn close(what: &str, value: f64, exact: f64, tolerance: f64) {
    assert!(
        (value - exact).abs() <= tolerance * exact.abs().max(1e-300),
        "{what}: {value}, exact {exact}"
    );
}

fn plant(numerator: &[f64], denominator: &[f64], dead_time: f64) -> TransferFunction {
    TransferFunction::new(numerator, denominator, dead_time)
}

/// Largest difference of a response from `exact(t)`.
fn distance(response: &Response, exact: impl Fn(f64) -> f64) -> f64 {
    response
        .time
        .iter()
        .zip(&response.output)
        .map(|(t, y)| (y - exact(*t)).abs())
        .fold(0.0, f64::max)
}

/// Unit step response of the loop with `C P = g e^(-Ls)/s`, by the method of steps: the sum of
/// `-(-g (t - n L))^n/n!` over the whole numbers `n >= 1` with `n L < t`.
fn delayed_integrator(g: f64, l: f64) -> impl Fn(f64) -> f64 {
    move |t| {
        let mut sum = 0.0;
        let mut factorial = 1.0;
        for n in 1..40 {
            let late = t - f64::from(n) * l;
            if late <= 0.0 {
                break;
            }
            factorial *= f64::from(n);
            sum -= (-g * late).powi(n) / factorial;
        }
        sum
    }
}

#[test]
fn step_response_with_dead_time_is_the_one_by_the_method_of_steps() {
    let (l, horizon) = (0.7, 9.0);
    let integrator = plant(&[2.0], &[1.0, 0.0], l);
    let p = respond(
        &integrator,
        &Pid::p(0.4),
        Disturbance::SetPoint,
        horizon,
        0.01,
    )
    .unwrap();
    let error = distance(&p, delayed_integrator(0.8, l));
    assert!(error < 1e-9, "{error}");
    // A PI controller whose integral time is the lag leaves g e^(-Ls)/s as well.
    let lag = plant(&[3.0], &[2.5, 1.0], l);
    let pi = respond(
        &lag,
        &Pid::pi(0.6, 2.5),
        Disturbance::SetPoint,
        horizon,
        0.01,
    )
    .unwrap();
    let error = distance(&pi, delayed_integrator(0.6 * 3.0 / 2.5, l));
    assert!(error < 1e-9, "{error}");
}

#[test]
fn step_response_without_dead_time_is_exact_at_any_step() {
    // 1/(s(s+1)) under K = 1: y = 1 - e^(-t/2) (cos wt + sin wt/(2w)), w = sqrt(3)/2.
    let w = 0.75_f64.sqrt();
    let exact = |t: f64| 1.0 - (-0.5 * t).exp() * ((w * t).cos() + (w * t).sin() / (2.0 * w));
    for step in [0.9, 0.01] {
        let drive = plant(&[1.0], &[1.0, 1.0, 0.0], 0.0);
        let found = respond(&drive, &Pid::p(1.0), Disturbance::SetPoint, 20.0, step).unwrap();
        assert!(distance(&found, exact) < 1e-12);
    }
    let drive = plant(&[1.0], &[1.0, 1.0, 0.0], 0.0);
    let found = respond(&drive, &Pid::p(1.0), Disturbance::SetPoint, 20.0, 0.001).unwrap();
    // Damping 1/2: overshoot exp(-pi/sqrt(3)).
    close(
        "overshoot",
        found.overshoot,
        (-PI / 3.0_f64.sqrt()).exp(),
        1e-6,
    );
    // Settling: the last time outside 2 %, from the closed form.
    let last = (0..200_000)
        .map(|i| f64::from(i) * 1e-4)
        .filter(|t| (exact(*t) - 1.0).abs() > 0.02)
        .fold(0.0, f64::max);
    assert!((found.settling_time.unwrap() - last).abs() < 2e-3);
}

#[test]
fn the_error_falls_with_the_fourth_power_of_the_step() {
    let plant = plant(&[1.0], &[1.0, 2.0, 1.0], 0.8);
    let pid = Pid::with_derivative(1.2, 1.6, 0.4, 5.0);
    let at = |step: f64| {
        let found = respond(&plant, &pid, Disturbance::SetPoint, 16.0, step).unwrap();
        (*found.time.last().unwrap(), *found.output.last().unwrap())
    };
    let runs = [0.1, 0.05, 0.025, 0.0125, 0.8 / 512.0].map(at);
    for run in runs {
        close("end", run.0, 16.0, 1e-12);
    }
    let errors: Vec<f64> = runs[..4].iter().map(|r| (r.1 - runs[4].1).abs()).collect();
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((12.0..22.0).contains(&ratio), "{errors:?}");
    }
}

#[test]
fn a_tiny_dead_time_is_replaced_without_harm() {
    let pid = Pid::with_derivative(1.2, 1.6, 0.4, 5.0);
    let run = |l: f64, horizon: f64| {
        let plant = plant(&[1.0], &[1.0, 2.0, 1.0], l);
        respond(&plant, &pid, Disturbance::Load, horizon, 0.01).unwrap()
    };
    // The same dead time, as a delay line over a short horizon and replaced over a long one.
    let (line, replaced) = (run(4e-4, 8.0), run(4e-4, 40.0));
    let mut compared = 0;
    for (t, y) in line.time.iter().zip(&line.output) {
        for (s, z) in replaced.time.iter().zip(&replaced.output) {
            if (t - s).abs() < 1e-9 {
                assert!((y - z).abs() < 1e-6, "{t}: {y} {z}");
                compared += 1;
            }
        }
    }
    assert!(compared > 70, "{compared}");
}

#[test]
fn a_load_is_paid_for_with_ti_over_k() {
    // The integral must end at minus the load, so the integral of the error is Ti/K; where the error
    // keeps its sign that is the IAE.
    let lag = plant(&[1.0], &[1.0, 1.0], 0.2);
    let pid = Pid::pi(1.5, 1.4);
    let found = respond(&lag, &pid, Disturbance::Load, 60.0, 0.01).unwrap();
    assert!(found.output.iter().all(|y| *y > -1e-9));
    close("IAE", found.iae, 1.4 / 1.5, 1e-7);
    assert_eq!(found.overshoot, 0.0);
}

#[test]
fn margins_of_a_delayed_integrator_are_those_of_the_closed_form() {
    let (g, l) = (0.8, 0.7);
    let loop_plant = plant(&[2.0], &[1.0, 0.0], l);
    let pid = Pid::p(0.4);
    let m = margins(&loop_plant, &pid);
    close(
        "gain margin",
        m.gain_margin.unwrap(),
        PI / (2.0 * g * l),
        1e-12,
    );
    close(
        "phase crossover",
        m.phase_crossover.unwrap(),
        PI / (2.0 * l),
        1e-12,
    );
    close(
        "phase margin",
        m.phase_margin.unwrap(),
        0.5 * PI - g * l,
        1e-12,
    );
    close("gain crossover", m.gain_crossover.unwrap(), g, 1e-12);
    close(
        "delay margin",
        m.delay_margin.unwrap(),
        (0.5 * PI - g * l) / g,
        1e-12,
    );
    // By brute force: |1 + C P|^2 = 1 - 2 (g/w) sin(wL) + (g/w)^2.
    let ms = (1..2_000_000)
        .map(|i| f64::from(i) * 1e-5)
        .map(|w| 1.0 - 2.0 * (g / w) * (w * l).sin() + (g / w).powi(2))
        .fold(f64::INFINITY, f64::min);
    close("Ms", m.max_sensitivity, 1.0 / ms.sqrt(), 1e-9);
}

#[test]
fn stability_is_known_on_both_sides_of_its_limit() {
    let check = |p: &TransferFunction, gain: f64, poles: usize| {
        assert_eq!(unstable_poles(p, &Pid::p(gain)), poles, "{p:?} gain {gain}");
    };
    let third = &presets()[0].plant;
    check(third, 7.99, 0);
    check(third, 8.01, 2);
    check(third, -1.01, 1);
    let lag = plant(&[1.0], &[1.0, 1.0], 5.0);
    check(&lag, 1.13, 0);
    check(&lag, 1.134, 2);
    // Far beyond: a pair more for each turn of the dead time with a gain above 1.
    let crossings = |gain: f64| {
        let edge = (gain * gain - 1.0).sqrt();
        ((edge.atan() + edge * 5.0 - PI) / (2.0 * PI)).floor() as usize + 1
    };
    for gain in [3.0, 10.0, 40.0] {
        check(&lag, gain, 2 * crossings(gain));
    }
    let unstable = plant(&[1.0], &[1.0, -1.0], 0.0);
    check(&unstable, 0.9, 1);
    check(&unstable, 1.1, 0);
    let double = plant(&[1.0], &[1.0, 0.0, 0.0], 0.0);
    let pd = Pid {
        derivative_time: 1.0,
        filter_time: 0.1,
        ..Pid::p(1.0)
    };
    assert_eq!(unstable_poles(&double, &pd), 0);
    // Integral action too fast: s^2 (s + 1) + K s + K/Ti is stable for Ti > 1.
    let drive = plant(&[1.0], &[1.0, 1.0, 0.0], 0.0);
    assert_eq!(unstable_poles(&drive, &Pid::pi(1.0, 1.01)), 0);
    assert_eq!(unstable_poles(&drive, &Pid::pi(1.0, 0.99)), 2);
}

#[test]
fn forms_of_the_controller_are_the_same_controller() {
    let pid = Pid::with_derivative(2.0, 3.0, 0.5, 8.0);
    let back = Pid::from_parallel(&pid.parallel()).unwrap();
    for omega in [0.01, 1.0, 50.0] {
        assert!(
            (pid.response(omega) - back.response(omega)).norm()
                < 1e-12 * pid.response(omega).norm()
        );
        let Parallel {
            proportional,
            integral,
            derivative,
            filter_time,
        } = pid.parallel();
        let s = Complex::new(0.0, omega);
        let direct = integral / s + s * derivative / (s * filter_time + 1.0) + proportional;
        assert!((pid.response(omega) - direct).norm() < 1e-12 * direct.norm());
        let unfiltered = Pid {
            filter_time: 1e-12,
            ..pid
        };
        let form = pid.series().unwrap();
        let series =
            (1.0 / (s * form.integral_time) + 1.0) * (s * form.derivative_time + 1.0) * form.gain;
        assert!((unfiltered.response(omega) - series).norm() < 1e-9 * series.norm());
    }
    assert!(Pid::with_derivative(1.0, 1.0, 0.3, 10.0).series().is_none());
    assert!(
        Pid::from_parallel(&Parallel {
            proportional: 0.0,
            ..pid.parallel()
        })
        .is_err()
    );
}

// ---- rules

fn identified(model: Model) -> Identified {
    Identified {
        ultimate: Ultimate {
            gain: 4.0,
            period: 3.0,
        },
        point: NyquistPoint {
            omega: 2.0,
            value: [-0.2, -0.05],
        },
        model: Ok(model),
        wish: Wish::default(),
    }
}

#[test]
fn rules_give_the_numbers_of_their_tables() {
    let lag = identified(Model::Lag {
        gain: 2.0,
        time_constant: 3.0,
        dead_time: 1.0,
    });
    let integrating = identified(Model::Integrating {
        gain: 0.5,
        dead_time: 2.0,
    });
    for (id, p, gain, ti, td) in [
        ("ziegler_nichols_pi", &lag, 1.8, 2.5, 0.0),
        ("ziegler_nichols_pid", &lag, 2.4, 1.5, 0.375),
        ("tyreus_luyben_pi", &lag, 1.25, 6.6, 0.0),
        ("tyreus_luyben_pid", &lag, 4.0 / 2.2, 6.6, 3.0 / 6.3),
        // By hand from Åström and Hägglund (2004): L = 1, T = 3, Kp = 2.
        ("amigo_pi", &lag, 0.318_75, 0.35 + 117.0 / 52.0, 0.0),
        ("amigo_pid", &lag, 0.775, 2.8 / 1.3, 1.5 / 3.3),
        ("amigo_pi", &integrating, 0.35, 26.8, 0.0),
        ("amigo_pid", &integrating, 0.45, 16.0, 1.0),
    ] {
        let pid = (rule(id).unwrap().tune)(p).unwrap();
        close(id, pid.gain, gain, 1e-12);
        close(id, pid.integral_time.unwrap(), ti, 1e-12);
        assert!((pid.derivative_time - td).abs() < 1e-12, "{id}: {pid:?}");
    }
    // The integrating rule is the limit of the other one.
    let slow = identified(Model::Lag {
        gain: 0.5e9,
        time_constant: 1e9,
        dead_time: 2.0,
    });
    let pid = (rule("amigo_pid").unwrap().tune)(&slow).unwrap();
    close("K", pid.gain, 0.45, 1e-6);
    close("Ti", pid.integral_time.unwrap(), 16.0, 1e-6);
}

#[test]
fn the_registry_names_every_rule_once_with_its_source() {
    for (i, a) in RULES.iter().enumerate() {
        assert!(!a.name.is_empty() && !a.source.is_empty() && a.sentence.ends_with('.'));
        assert!(RULES[..i].iter().all(|b| a.id != b.id && a.name != b.name));
        assert_eq!(rule(a.id).unwrap().name, a.name);
    }
    assert_eq!(
        rule("none").unwrap_err(),
        TuningError::UnknownRule("none".to_owned())
    );
}

// ---- the whole experiment

fn input(plant: &TransferFunction) -> TuningInput {
    TuningInput {
        plant: plant.clone(),
        ..TuningInput::default()
    }
}

fn loops(report: &TuningReport) -> impl Iterator<Item = (&str, &LoopReport)> {
    report
        .rules
        .iter()
        .filter_map(|r| Some((r.rule.as_str(), r.outcome.as_ref().ok()?)))
}

#[test]
fn every_preset_is_tuned_and_the_responses_do_not_depend_on_the_step() {
    for preset in presets() {
        let report = tune(&input(&preset.plant)).unwrap_or_else(|e| panic!("{}: {e}", preset.name));
        assert_eq!(report.rules.len(), RULES.len());
        assert!(loops(&report).count() >= RULES.len() - 2, "{}", preset.name);
        for (id, l) in loops(&report) {
            let stable = l.unstable_poles == 0;
            if !stable {
                continue;
            }
            // Twice as fine, at the same times.
            let step = report.test.period / 100.0;
            let coarse = close_loop(&preset.plant, &l.pid, report.horizon, step).unwrap();
            let fine = close_loop(&preset.plant, &l.pid, report.horizon, 0.25 * step).unwrap();
            close(id, coarse.set_point.iae, fine.set_point.iae, 1e-4);
            close(id, l.set_point.iae, fine.set_point.iae, 1e-4);
            close(id, l.load.iae, fine.load.iae, 1e-4);
        }
    }
}

#[test]
fn the_chosen_rule_ends_the_experiment() {
    let report = tune(&TuningInput::default()).unwrap();
    let after = report.after.as_ref().unwrap();
    let chosen = report.rules.iter().find(|r| r.rule == "amigo_pid").unwrap();
    assert_eq!(chosen.outcome.as_ref().unwrap(), after);
    let titles: Vec<String> = report.steps.iter().map(|s| s.title.to_string()).collect();
    assert_eq!(titles.first().map(String::as_str), Some("The loop before"));
    assert_eq!(titles.last().map(String::as_str), Some("The loop after"));
    assert!(
        titles
            .iter()
            .filter(|t| t.starts_with("Gain adaptation"))
            .count()
            >= 2
    );
    // A proportional controller leaves an offset of 1/2 on this plant; the tuned loop none.
    let before = report.before.set_point.output.last().unwrap();
    close("offset", *before, 0.5, 1e-3);
    close("end", *after.set_point.output.last().unwrap(), 1.0, 1e-3);
    // The true margin of K/(s + 1)^3 in closed form, from |P| = 1/K.
    let found = report.phase_margin.unwrap();
    let omega = (found.adaptation.gain.powf(2.0 / 3.0) - 1.0).sqrt();
    let margin = found.true_phase_margin.unwrap();
    close("phase margin", margin, PI - 3.0 * omega.atan(), 1e-9);
    // It is what was asked for, but for the describing function's error: here 6 degrees.
    assert!((margin - PI / 4.0).abs() < 7_f64.to_radians(), "{margin}");
}

#[test]
fn moving_point_passes_through_its_target_as_the_describing_function_knows_it() {
    let wish = Wish {
        target: Target::PhaseMargin(1.0),
        ..Wish::default()
    };
    let report = tune(&TuningInput {
        wish,
        ..TuningInput::default()
    })
    .unwrap();
    let (_, moved) = loops(&report)
        .find(|(id, _)| *id == "moving_point_pid")
        .unwrap();
    let at = moved.pid.response(report.point.point.omega);
    let [re, im] = report.point.truth;
    let target = wish.target.point();
    let miss = (at * Complex::new(re, im) - target).norm();
    // It misses by just the describing function's error, scaled as the point is.
    close("miss", miss, report.point.error, 1.0);
    let [re, im] = report.point.point.value;
    assert!((at * Complex::new(re, im) - target).norm() < 1e-12);
    assert!(report.point.fourier_error < 1e-9);
}

#[test]
fn a_relay_delay_counts_as_dead_time_of_the_plant() {
    let with = |delay: f64, dead_time: f64| {
        let mut input = input(&plant(&[1.0], &[1.0, 1.0], dead_time));
        input.relay.delay = delay;
        tune(&input).unwrap()
    };
    assert_eq!(with(0.25, 0.25), with(0.0, 0.5));
}

#[test]
fn reports_survive_json_and_repeat_to_the_bit() {
    for relay in [TuningInput::default().relay, Relay::default()] {
        let input = TuningInput {
            relay,
            ..TuningInput::default()
        };
        let text = serde_json::to_string(&input).unwrap();
        assert_eq!(serde_json::from_str::<TuningInput>(&text).unwrap(), input);
        let report = tune(&input).unwrap();
        assert_eq!(report, tune(&input).unwrap());
        let value = serde_json::to_value(&report).unwrap();
        // Its messages are their English there: what is read says the same, word for word.
        let back: TuningReport = serde_json::from_value(value.clone()).unwrap();
        assert_eq!(serde_json::to_value(&back).unwrap(), value);
    }
}

#[test]
fn wrong_input_is_named() {
    let wrong = |change: fn(&mut TuningInput), word: &str| {
        let mut input = TuningInput::default();
        change(&mut input);
        let error = tune(&input).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    };
    wrong(|i| i.plant.dead_time = -1.0, "dead time -1");
    wrong(|i| i.relay.gain = 0.0, "gain is 0");
    wrong(|i| i.wish.filter = 0.0, "filter");
    wrong(|i| i.wish.time_ratio = f64::NAN, "ratio");
    wrong(|i| i.wish.phase_margin = 2.0, "phase margin is 2");
    wrong(
        |i| i.wish.target = Target::AmplitudeMargin(0.5),
        "amplitude margin is 0.5",
    );
    wrong(|i| i.rule = "magic".to_owned(), "magic");
    wrong(|i| i.present.filter_time = -1.0, "filter time");
    wrong(|i| i.horizon = Some(0.0), "horizon");
    wrong(|i| i.amplitude = Some(f64::INFINITY), "amplitude");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_plant_makes_the_tuner_panic_or_hang(
        numerator in prop::collection::vec(-3.0..3.0_f64, 1..4),
        denominator in prop::collection::vec(-3.0..6.0_f64, 2..6),
        dead_time in prop_oneof![Just(0.0), 0.0..2.0_f64, Just(1e-7)],
        hysteresis in prop_oneof![Just(0.0), 0.0..0.5_f64],
        asymmetry in -0.9..0.9_f64,
        scale in -6.0..6.0_f64,
    ) {
        let mut input = input(&plant(&numerator, &denominator, dead_time));
        for (i, c) in input.plant.denominator.iter_mut().enumerate() {
            *c *= 10_f64.powf(scale * i as f64 / 2.0);
        }
        input.relay.hysteresis = hysteresis;
        input.relay.asymmetry = asymmetry;
        if let Ok(report) = tune(&input) {
            prop_assert!(report.test.amplitude > 0.0 && report.test.period > 0.0);
            for (_, l) in loops(&report) {
                prop_assert!(l.set_point.iae.is_finite() && l.load.iae.is_finite());
            }
        }
    }
}
