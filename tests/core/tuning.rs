//! Auto-tuning: equations (4), (7), (8) and (9), and what one asymmetric relay test tells, against closed
//! forms and independent numerics.

use std::f64::consts::PI;

use hysteron_core::limit_cycle::exact_symmetric;
use hysteron_core::plant::{TransferFunction, presets};
use hysteron_core::relay::Relay;
use hysteron_core::tuning::{
    AdaptationMethod, Model, NyquistPoint, RelayDesign, RelayTest, Target, TuningError, adapt,
    compare, crossings, half_periods, identify, move_with_pi, move_with_pid, normalised_dead_time,
    orders, true_ultimate,
};
use nalgebra::Complex;

fn close(what: &str, value: f64, exact: f64, tolerance: f64) {
    assert!(
        (value - exact).abs() <= tolerance * exact.abs().max(1e-300),
        "{what}: {value}, exact {exact}"
    );
}

fn ideal() -> Relay {
    Relay {
        hysteresis: 0.0,
        ..Relay::default()
    }
}

fn lag_with_dead_time(gain: f64, time_constant: f64, dead_time: f64) -> TransferFunction {
    TransferFunction::new(&[gain], &[time_constant, 1.0], dead_time)
}

/// Root of a rising `f`, by bisection.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

// ---- equation (9)

#[test]
fn equation_9_lag_with_dead_time_relay_and_true_ultimate_point() {
    for (dead_time, by_relay, exact) in [
        (0.1_f64, 13.380, 16.351),
        (0.5, 3.236, 3.807),
        (5.0, 1.282, 1.132),
    ] {
        let plant = lag_with_dead_time(1.0, 1.0, dead_time);
        let test = RelayTest::run(&plant, &ideal()).unwrap();
        // The output is a charging curve: amplitude 1 - e^-D, half period ln(2 e^D - 1).
        close("amplitude", test.amplitude, 1.0 - (-dead_time).exp(), 1e-10);
        let half = (2.0 * dead_time.exp() - 1.0).ln();
        close("period", test.period, 2.0 * half, 1e-10);
        let report = compare(&test, &plant);
        close("Ku by relay", report.by_relay.gain, by_relay, 5e-4);
        // Phase crossover: atan w + w D = pi.
        let w = root(0.0, PI / dead_time, |w| w.atan() + w * dead_time - PI);
        let truth = report.truth.unwrap();
        close("true Ku", truth.gain, w.hypot(1.0), 1e-12);
        close("true Ku in the issue", truth.gain, exact, 5e-4);
        close("true Tu", truth.period, 2.0 * PI / w, 1e-12);
        let expected = report.by_relay.gain / truth.gain - 1.0;
        close(
            "error of Ku",
            report.by_relay_error.unwrap(),
            expected,
            1e-12,
        );
        assert!(report.amplitude_convention.contains("half of peak to peak"));
    }
}

#[test]
fn equation_9_with_hysteresis_beside_the_gain_on_the_real_axis() {
    let plant = TransferFunction::new(&[1.0], &[1.0, 3.0, 3.0, 1.0], 0.0);
    let test = RelayTest::run(&plant, &Relay::default()).unwrap();
    // Period and amplitude from the table of exact limit cycles.
    let a = 0.285_687_386_127_379_f64;
    close("amplitude", test.amplitude, a, 1e-10);
    close("period", test.period, 4.787_671_942_045_41, 1e-10);
    let report = compare(&test, &plant);
    close("by the relay", report.by_relay.gain, 4.0 / (PI * a), 1e-9);
    let on_axis = 4.0 / (PI * (a * a - 0.01).sqrt());
    close("on the real axis", report.on_real_axis.gain, on_axis, 1e-9);
    let truth = report.truth.unwrap();
    close("true gain", truth.gain, 8.0, 1e-12);
    close(
        "true period",
        truth.period,
        2.0 * PI / 3.0_f64.sqrt(),
        1e-12,
    );
    // Allowing for the hysteresis brings the gain nearer to the truth.
    assert!(report.on_real_axis_error.unwrap().abs() < report.by_relay_error.unwrap().abs());
}

#[test]
fn equation_9_true_point_through_integrators_dead_time_and_far_poles() {
    let check = |num: &[f64], den: &[f64], dead_time: f64, gain: f64, omega: f64| {
        let plant = TransferFunction::new(num, den, dead_time);
        let truth = true_ultimate(&plant).unwrap_or_else(|| panic!("{den:?}: none"));
        close("gain", truth.gain, gain, 1e-9);
        close("period", truth.period, 2.0 * PI / omega, 1e-9);
    };
    // e^(-Ls)/s: w = pi/(2L).
    check(&[1.0], &[1.0, 0.0], 1e-4, 0.5e4 * PI, 0.5e4 * PI);
    check(&[2.0], &[1.0, 0.0], 300.0, PI / 1200.0, PI / 600.0);
    check(&[1.0], &[1.0, 3.0, 2.0, 0.0], 0.0, 6.0, 2.0_f64.sqrt());
    // Three lags: Ku = (T1 + T2 + T3)(1/T1 + 1/T2 + 1/T3) - 1, w^2 = (T1 + T2 + T3)/(T1 T2 T3).
    let (t1, t2, t3) = (1.0, 1e-4, 1e-5);
    let sum: f64 = t1 + t2 + t3;
    let den = [t1 * t2 * t3, t1 * t2 + t1 * t3 + t2 * t3, sum, 1.0];
    let gain = sum * (1.0 / t1 + 1.0 / t2 + 1.0 / t3) - 1.0;
    check(&[1.0], &den, 0.0, gain, (sum / (t1 * t2 * t3)).sqrt());
    for (num, den) in [
        (&[1.0][..], &[1.0, 2.0, 1.0][..]),
        (&[1.0], &[1.0, 0.0, 0.0]),
        (&[1.0], &[1.0, 1.0]),
    ] {
        assert_eq!(true_ultimate(&TransferFunction::new(num, den, 0.0)), None);
    }
    // (s + 1)^2/s^3 is stable above a gain of 1/2 only: a crossing with rising phase, no ultimate gain.
    let found = crossings(&TransferFunction::new(
        &[1.0, 2.0, 1.0],
        &[1.0, 0.0, 0.0, 0.0],
        0.0,
    ));
    assert_eq!(found.len(), 1);
    close("omega", found[0].omega, 1.0, 1e-12);
    close("gain", found[0].gain, 0.5, 1e-12);
    assert!(!found[0].falling);
}

#[test]
fn the_fourier_point_lies_on_the_nyquist_curve_the_describing_function_beside_it() {
    for preset in presets() {
        let relay = Relay {
            hysteresis: 0.1,
            ..Relay::default()
        };
        for asymmetry in [0.0, 0.3] {
            let relay = Relay { asymmetry, ..relay };
            let test = RelayTest::run(&preset.plant, &relay)
                .unwrap_or_else(|e| panic!("{} {asymmetry}: {e}", preset.name));
            let truth = preset.plant.response(test.omega);
            let error = |p: [f64; 2]| (Complex::new(p[0], p[1]) - truth).norm() / truth.norm();
            assert!(
                error(test.fourier_point) < 1e-8,
                "{} {asymmetry}: {}",
                preset.name,
                error(test.fourier_point)
            );
            assert!(error(test.point) > error(test.fourier_point));
        }
    }
}

#[test]
fn experiments_that_show_nothing_say_why() {
    let lag = TransferFunction::new(&[1.0], &[1.0, 1.0], 0.0);
    let chatters = RelayTest::run(&lag, &ideal()).unwrap_err();
    assert!(
        matches!(chatters, TuningError::Chattering { .. }),
        "{chatters}"
    );
    // Static gain 1 never reaches the threshold 1.5.
    let relay = Relay {
        hysteresis: 1.5,
        ..Relay::default()
    };
    let still = RelayTest::run(&presets()[0].plant, &relay).unwrap_err();
    assert!(
        matches!(still, TuningError::NoOscillation { .. }),
        "{still}"
    );
}

// ---- equation (7)

#[test]
fn equation_7_puts_minus_one_over_n_on_the_unit_circle_at_the_phase_margin() {
    for degrees in [0.0_f64, 15.0, 45.0, 80.0] {
        for amplitude in [0.02, 3.0] {
            let phi = degrees.to_radians();
            let design = RelayDesign::new(phi, amplitude).unwrap();
            let point = design.relay(1.0).inverse_describing_function(amplitude);
            assert!((point[0] + phi.cos()).abs() < 1e-14);
            assert!((point[1] + phi.sin()).abs() < 1e-14);
        }
    }
    for wrong in [-0.1, 0.5 * PI, f64::NAN] {
        let error = RelayDesign::new(wrong, 1.0).unwrap_err();
        assert!(error.to_string().contains("phase margin"), "{error}");
    }
}

// ---- equation (8)

/// The gain at which the exact cycle has the wanted amplitude, without any experiment.
fn exact_gain(plant: &TransferFunction, design: &RelayDesign, near: f64) -> f64 {
    let space = plant.state_space();
    let period = RelayTest::run(plant, &design.relay(near)).unwrap().period;
    root(0.9 * near, 1.1 * near, |gain| {
        exact_symmetric(&space, &design.relay(gain), plant.dead_time, 0.5 * period)
            .unwrap()
            .amplitude
            - design.amplitude
    })
}

#[test]
fn equation_8_gain_adaptation_converges_quadratically_to_the_exact_gain() {
    for (preset, first) in [(0, 0.5), (1, 0.6), (3, 2.0)] {
        let plant = &presets()[preset].plant;
        let design = RelayDesign::new(PI / 6.0, 0.4).unwrap();
        let first = first / design.gain;
        let found = adapt(plant, &design, AdaptationMethod::Steffensen, first).unwrap();
        let exact = exact_gain(plant, &design, found.gain);
        close("gain", found.gain, exact, 1e-8);
        // Quadratic: e(n+1)/e(n)^2 stays bounded while e falls by orders of magnitude.
        let errors: Vec<f64> = found
            .steps
            .iter()
            .map(|s| (s.gain / exact - 1.0).abs())
            .filter(|e| *e > 1e-9)
            .collect();
        assert!(errors.len() >= 3, "{preset}: {errors:?}");
        assert!(errors[errors.len() - 1] < 1e-4, "{preset}: {errors:?}");
        for pair in errors.windows(2) {
            assert!(pair[1] < pair[0] * pair[0], "{preset}: {errors:?}");
        }
        let order = *found.orders.last().unwrap();
        assert!((order - 2.0).abs() < 0.25, "{preset}: {:?}", found.orders);
        // The secant through the last two runs has the order (1 + sqrt 5)/2.
        let secant = adapt(plant, &design, AdaptationMethod::Secant, first).unwrap();
        close("gain by secant", secant.gain, exact, 1e-8);
        assert!(secant.steps.iter().all(|s| s.trial.is_none()));
        let order = *secant.orders.last().unwrap();
        assert!(
            (order - 1.618).abs() < 0.25,
            "{preset}: {:?}",
            secant.orders
        );
    }
}

#[test]
fn equation_8_needs_one_step_where_the_amplitude_is_linear_in_the_gain() {
    // Lag with dead time: a = K k - (K k - eps) e^(-L/T), a straight line over the relay's gain.
    let (l, a) = (0.5_f64, 0.4);
    let plant = lag_with_dead_time(1.0, 1.0, l);
    let design = RelayDesign::new(PI / 6.0, a).unwrap();
    let found = adapt(&plant, &design, AdaptationMethod::Steffensen, 2.0).unwrap();
    let late = (-l).exp();
    let gain = (a - design.hysteresis * late) / (1.0 - late) / design.gain;
    close("gain", found.gain, gain, 1e-10);
    assert_eq!(found.steps.len(), 2);
}

#[test]
fn equation_8_orders_of_known_sequences() {
    let quadratic = [1e-1, 1e-2, 1e-4, 1e-8];
    for order in orders(&quadratic) {
        close("order", order, 2.0, 1e-12);
    }
    assert_eq!(orders(&quadratic).len(), 2);
    // Rounding says nothing about the order.
    assert_eq!(orders(&[1e-4, 1e-8, 1e-16]), Vec::<f64>::new());
}

#[test]
fn equation_8_without_an_answer_says_so() {
    // A first-order lag swings with the amplitude eps whatever the gain.
    let plant = TransferFunction::new(&[1.0], &[1.0, 1.0], 0.0);
    let design = RelayDesign::new(PI / 6.0, 0.4).unwrap();
    let error = adapt(&plant, &design, AdaptationMethod::Steffensen, 2.0).unwrap_err();
    assert!(
        matches!(
            error,
            TuningError::NotConverged { .. } | TuningError::NoOscillation { .. }
        ),
        "{error}"
    );
}

// ---- equation (4)

#[test]
fn equation_4_controller_moves_m_exactly_to_s() {
    let from = NyquistPoint {
        omega: 1.7,
        value: [-0.3, -0.11],
    };
    for (size, angle) in [(1.0, 0.3), (0.5, 0.6), (0.4, -0.5), (2.0, 1.0)] {
        let target = Target::Point { size, angle }.point();
        for (ratio, filter) in [(4.0, 10.0), (6.0, 20.0), (4.0, 2.0)] {
            let pid = move_with_pid(&from, target, ratio, filter);
            if let Err(error) = &pid {
                // Only a strong filter keeps the phase from being turned so far.
                assert!(filter < 5.0 && angle > 0.9, "{error}");
                continue;
            }
            let pid = pid.unwrap();
            let there = pid.response(from.omega) * Complex::new(from.value[0], from.value[1]);
            assert!((there - target).norm() < 1e-12, "{there} {target}");
            close(
                "Ti/Td",
                pid.integral_time.unwrap() / pid.derivative_time,
                ratio,
                1e-12,
            );
        }
    }
    let target = Target::Point {
        size: 0.6,
        angle: -0.2,
    }
    .point();
    let pi = move_with_pi(&from, target).unwrap();
    let there = pi.response(from.omega) * Complex::new(from.value[0], from.value[1]);
    assert!((there - target).norm() < 1e-13);
}

#[test]
fn equation_4_without_filter_is_the_closed_form_of_astrom_and_hagglund_1984() {
    let (ku, omega, phi, ratio) = (3.0, 2.0, 0.7_f64, 4.0);
    let from = NyquistPoint {
        omega,
        value: [-1.0 / ku, 0.0],
    };
    let pid = move_with_pid(&from, Target::PhaseMargin(phi).point(), ratio, 1e9).unwrap();
    let td = (phi.tan() + (phi.tan().powi(2) + 4.0 / ratio).sqrt()) / (2.0 * omega);
    close("Td", pid.derivative_time, td, 1e-8);
    close("K", pid.gain, ku * phi.cos(), 1e-8);
    let margin = 2.5;
    let pid = move_with_pid(&from, Target::AmplitudeMargin(margin).point(), ratio, 1e9).unwrap();
    close(
        "Td",
        pid.derivative_time,
        1.0 / (omega * ratio.sqrt()),
        1e-8,
    );
    close("K", pid.gain, ku / margin, 1e-8);
}

#[test]
fn equation_4_targets_out_of_reach_are_named_with_the_reach() {
    let from = NyquistPoint {
        omega: 1.0,
        value: [-0.5, 0.0],
    };
    let target = Target::PhaseMargin(1.4).point();
    match move_with_pid(&from, target, 4.0, 10.0).unwrap_err() {
        TuningError::OutOfReach { turn, least, most } => {
            close("turn", turn, 1.4, 1e-12);
            assert!(least < 0.0 && (0.8..1.1).contains(&most), "{least} {most}");
        }
        other => panic!("{other}"),
    }
    assert!(move_with_pi(&from, Target::PhaseMargin(0.3).point()).is_err());
}

// ---- one asymmetric test

#[test]
fn berner_hagglund_astrom_2016_half_period_equations_agree_with_the_simulation() {
    for (gain, t, l) in [(1.0, 1.0, 0.3), (2.5, 4.0, 0.4), (0.7, 0.5, 2.0)] {
        for (asymmetry, hysteresis) in [(0.3, 0.05), (-0.4, 0.1), (0.2, 0.0)] {
            let relay = Relay {
                gain: 1.5,
                hysteresis,
                asymmetry,
                ..Relay::default()
            };
            let test = RelayTest::run(&lag_with_dead_time(gain, t, l), &relay).unwrap();
            let model = Model::Lag {
                gain,
                time_constant: t,
                dead_time: l,
            };
            let (on, off) = half_periods(&model, &relay).unwrap();
            close("t_on", test.on_time, on, 1e-9);
            close("t_off", test.off_time, off, 1e-9);
            close("static gain", test.static_gain().unwrap(), gain, 1e-9);
        }
    }
    let relay = Relay {
        asymmetry: 0.3,
        ..Relay::default()
    };
    let test = RelayTest::run(&TransferFunction::new(&[0.8], &[1.0, 0.0], 0.7), &relay).unwrap();
    let model = Model::Integrating {
        gain: 0.8,
        dead_time: 0.7,
    };
    let (on, off) = half_periods(&model, &relay).unwrap();
    close("t_on", test.on_time, on, 1e-9);
    close("t_off", test.off_time, off, 1e-9);
    assert_eq!(test.static_gain(), None);
}

#[test]
fn berner_hagglund_astrom_2016_finds_lag_and_dead_time() {
    // The formula's ends are exact: a pure dead time has equal half periods, an integrator's are in the
    // ratio of the relay's outputs.
    close("tau", normalised_dead_time(2.0, 1.0), 1.0, 1e-15);
    close("tau", normalised_dead_time(2.0, 2.0) + 1.0, 1.0, 1e-15);
    for normalised in [0.1, 0.25, 0.5, 0.75, 0.9] {
        let l = normalised / (1.0 - normalised);
        let relay = Relay {
            gain: 1.0,
            hysteresis: 0.02,
            asymmetry: 0.3,
            ..Relay::default()
        };
        let test = RelayTest::run(&lag_with_dead_time(2.0, 1.0, l), &relay).unwrap();
        let found = identify(test).unwrap();
        // The formula was fitted; its authors ask for no more than a few hundredths.
        assert!((found.normalised_dead_time - normalised).abs() < 0.01);
        let Ok(Model::Lag {
            gain,
            time_constant,
            dead_time,
        }) = found.berner
        else {
            panic!("no lag")
        };
        close("gain", gain, 2.0, 1e-9);
        close("time constant", time_constant, 1.0, 0.05);
        close("dead time", dead_time, l, 0.02);
    }
}

#[test]
fn shen_wu_yu_1996_recovers_a_first_order_lag_exactly() {
    for (gain, t, l) in [(1.0, 1.0, 0.1), (2.5, 4.0, 0.4), (0.7, 0.5, 2.0)] {
        let relay = Relay {
            gain: 1.0,
            hysteresis: 0.03,
            asymmetry: 0.4,
            ..Relay::default()
        };
        let found = identify(RelayTest::run(&lag_with_dead_time(gain, t, l), &relay).unwrap());
        let Ok(Model::Lag {
            gain: k,
            time_constant,
            dead_time,
        }) = found.unwrap().shen
        else {
            panic!("no lag")
        };
        close("gain", k, gain, 1e-9);
        close("time constant", time_constant, t, 1e-8);
        close("dead time", dead_time, l, 1e-8);
    }
}

#[test]
fn an_integrator_with_dead_time_is_recovered_exactly_by_both() {
    let relay = Relay {
        hysteresis: 0.05,
        asymmetry: 0.25,
        ..Relay::default()
    };
    let plant = TransferFunction::new(&[0.8], &[1.0, 0.0], 0.7);
    let found = identify(RelayTest::run(&plant, &relay).unwrap()).unwrap();
    for model in [found.berner.unwrap(), found.shen.unwrap()] {
        let Model::Integrating { gain, dead_time } = model else {
            panic!("{model:?}")
        };
        close("gain", gain, 0.8, 1e-9);
        close("dead time", dead_time, 0.7, 1e-8);
    }
}

#[test]
fn a_symmetric_relay_identifies_no_model() {
    let test = RelayTest::run(&lag_with_dead_time(1.0, 1.0, 0.5), &Relay::default()).unwrap();
    let error = identify(test).unwrap_err();
    assert!(matches!(error, TuningError::Symmetric { .. }), "{error}");
}

#[test]
fn a_bias_of_the_relay_is_an_asymmetry_in_other_units() {
    let plant = lag_with_dead_time(2.0, 1.0, 0.5);
    let asymmetric = Relay {
        gain: 2.0,
        asymmetry: 0.3,
        ..Relay::default()
    };
    let biased = Relay {
        asymmetry: 0.0,
        bias: 0.6,
        ..asymmetric
    };
    let found = |relay| identify(RelayTest::run(&plant, relay).unwrap()).unwrap();
    let (a, b) = (found(&asymmetric), found(&biased));
    close("ratio of outputs", b.asymmetry_ratio, 1.3 / 0.7, 1e-14);
    close("static gain", b.static_gain.unwrap(), 2.0, 1e-9);
    close("period", b.test.period, a.test.period, 1e-12);
    assert!(matches!(b.berner, Ok(Model::Lag { .. })), "{:?}", b.berner);
}
