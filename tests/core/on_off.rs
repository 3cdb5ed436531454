//! On-off controllers as they are built, against closed forms, recursions and an integrator of its own.

use std::f64::consts::PI;

use hysteron_core::limit_cycle::exact_cycles;
use hysteron_core::on_off::{
    DiscretePlant, GivenPlant, OnOffInput, OnOffLoop, OnOffPlant, OnOffRelay, Position, Settled,
    describing_function, run, settled, view,
};
use hysteron_core::plant::TransferFunction;
use hysteron_core::relay::Relay;
use hysteron_core::simulate::{self, Noise, Options};

fn continuous(plant: TransferFunction, relay: OnOffRelay) -> OnOffLoop {
    let space = plant.state_space();
    OnOffLoop {
        plant: OnOffPlant::Continuous(plant, space),
        relay,
        initial: None,
    }
}

fn three_lags(dead_time: f64) -> TransferFunction {
    TransferFunction::new(&[1.0], &[1.0, 3.0, 3.0, 1.0], dead_time)
}

fn relay(gain: f64, hysteresis: f64) -> OnOffRelay {
    OnOffRelay {
        relay: Relay {
            gain,
            hysteresis,
            ..Relay::default()
        },
        ..OnOffRelay::default()
    }
}

#[track_caller]
fn close(value: f64, exact: f64, share: f64) {
    assert!(
        (value / exact - 1.0).abs() < share,
        "{value}, exact {exact}"
    );
}

#[track_caller]
fn cycle_of(settled: &Settled) -> &hysteron_core::on_off::OnOffCycle {
    settled
        .exact
        .as_ref()
        .unwrap_or_else(|| panic!("{settled:?}"))
}

/// A heater at a first-order lag that must stay off for longer than the hysteresis asks: off from the upper threshold
/// for this time, on from there to the upper threshold again.
#[test]
fn a_shortest_time_off_in_closed_form() {
    let (gain, time, off) = (2.0, 10.0, 6.0);
    let mut controller = relay(0.5, 0.1);
    controller.relay.bias = 0.5;
    controller.reference = 1.0;
    controller.min_off = off;
    let plant = TransferFunction::new(&[gain], &[time, 1.0], 0.0);
    let found = settled(&continuous(plant, controller)).unwrap();
    let cycle = cycle_of(&found);
    let low = 1.1 * f64::exp(-off / time);
    let on = time * f64::ln((gain - low) / (gain - 1.1));
    close(cycle.period, off + on, 1e-12);
    close(cycle.range[0], low, 1e-12);
    close(cycle.range[1], 1.1, 1e-12);
    assert_eq!(cycle.positions.len(), 2);
    assert_eq!(cycle.stable, Some(true));
    // At the upper threshold its only state is known: nothing is left of a disturbance.
    assert!(cycle.multiplier.unwrap() < 1e-12, "{cycle:?}");
}

/// What has neither dead zone nor times nor samples is the plain relay, of which there is another solver.
#[test]
fn a_plain_relay_has_the_cycle_of_the_other_solver() {
    for (lag, asymmetry) in [(0.0, 0.0), (0.7, 0.0), (5.0, 0.3), (0.0, -0.4)] {
        let mut controller = relay(1.0, 0.1);
        controller.relay.asymmetry = asymmetry;
        let plant = three_lags(lag);
        let space = plant.state_space();
        let other = exact_cycles(&space, &controller.relay, lag, 2.4 + lag);
        let found = settled(&continuous(plant, controller)).unwrap();
        let cycle = cycle_of(&found);
        let same = other
            .iter()
            .find(|c| (c.cycle.period / cycle.period - 1.0).abs() < 1e-9)
            .unwrap_or_else(|| panic!("{lag} {asymmetry}: {cycle:?} {other:?}"));
        close(cycle.amplitude, same.cycle.amplitude, 1e-9);
        assert_eq!(cycle.stable, same.cycle.stable);
        let (a, b) = (cycle.multiplier.unwrap(), same.multiplier.unwrap());
        assert!((a - b).abs() < 1e-6, "{lag} {asymmetry}: {a} {b}");
    }
}

/// What a run shows: period, smallest and largest output.
struct Shown {
    period: f64,
    range: [f64; 2],
}

/// The third-order lag from `-1` by the classical Runge-Kutta method in steps of `step` s, and the controller as a few
/// lines of its own that look at the output every so many of them.
fn by_small_steps(controller: &OnOffRelay, dead_time: f64, step: f64, every: usize) -> Shown {
    const END: f64 = 240.0;
    let rate = |x: [f64; 3], u: f64| [x[1], x[2], u - x[0] - 3.0 * x[1] - 3.0 * x[2]];
    let add = |a: [f64; 3], b: [f64; 3], h: f64| std::array::from_fn(|i| a[i] + h * b[i]);
    let (d, eps) = (controller.dead_zone, controller.relay.hysteresis);
    let (mut x, mut way, mut since) = ([-1.0, 0.0, 0.0], 1, f64::NEG_INFINITY);
    let (mut sent, mut ups) = (Vec::new(), Vec::new());
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let late = (dead_time / step).round() as usize;
    for k in 0..(END / step) as usize {
        let (t, e) = (k as f64 * step, x[0] - controller.reference);
        let is_off = way == 0 || (d == 0.0 && way < 0);
        let hold = if is_off {
            controller.min_off
        } else {
            controller.min_on
        };
        if k % every == 0 && t - since >= hold - 1e-9 {
            let next = if e < -d - eps {
                1
            } else if e > d + eps {
                -1
            } else if d > 0.0 && ((way > 0 && e > eps - d) || (way < 0 && e < d - eps)) {
                0
            } else {
                way
            };
            if next != way {
                if next == 1 {
                    ups.push(t);
                }
                (way, since) = (next, t);
            }
        }
        let position = [Position::Down, Position::Off, Position::Up][(way + 1) as usize];
        sent.push(controller.output(position));
        let u = sent[k.saturating_sub(late)];
        let a = rate(x, u);
        let b = rate(add(x, a, 0.5 * step), u);
        let c = rate(add(x, b, 0.5 * step), u);
        let d4 = rate(add(x, c, step), u);
        x = std::array::from_fn(|i| x[i] + step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d4[i]));
        if t > 0.7 * END {
            range = [range[0].min(x[0]), range[1].max(x[0])];
        }
    }
    let last = &ups[ups.len() - 9..];
    Shown {
        period: (last[8] - last[0]) / 8.0,
        range,
    }
}

/// A controller around the third-order lag with this dead time, from `-1`.
fn from_below(controller: OnOffRelay, dead_time: f64) -> OnOffLoop {
    OnOffLoop {
        initial: Some(nalgebra::DVector::from_vec(vec![0.0, 0.0, -1.0])),
        ..continuous(three_lags(dead_time), controller)
    }
}

#[track_caller]
fn as_by_small_steps(controller: OnOffRelay, dead_time: f64, every: usize, share: f64) -> Settled {
    let shown = by_small_steps(&controller, dead_time, 1e-3, every);
    let found = settled(&from_below(controller, dead_time)).unwrap();
    let cycle = found
        .exact
        .as_ref()
        .unwrap_or_else(|| panic!("{controller:?}: {found:?}"));
    assert_eq!(cycle.stable, Some(true), "{cycle:?}");
    // The run repeats this cycle, so what is known of it holds for what the run shows.
    if let Some(seen) = &found.simulated {
        assert_eq!(seen.stable, Some(true), "{seen:?}");
    }
    close(cycle.period, shown.period, share);
    for (value, other) in cycle.range.iter().zip(shown.range) {
        assert!(
            (value - other).abs() < share * cycle.amplitude,
            "{cycle:?} {other}"
        );
    }
    let simulated = found.simulated.as_ref().unwrap();
    close(cycle.period, simulated.period, 1e-5);
    found
}

#[test]
fn heat_off_and_cool_as_by_small_steps() {
    let mut controller = relay(1.0, 0.02);
    controller.dead_zone = 0.05;
    let found = as_by_small_steps(controller, 0.6, 1, 5e-3);
    assert_eq!(cycle_of(&found).positions.len(), 4);
    // Weaker cooling.
    controller.relay.asymmetry = 0.3;
    as_by_small_steps(controller, 0.6, 1, 5e-3);
    // Far above what it has by itself: it heats longer than it cools.
    controller.reference = 0.6;
    let found = as_by_small_steps(controller, 0.6, 1, 5e-3);
    let time = |position| -> f64 {
        let all = cycle_of(&found).positions.iter();
        all.filter(|p| p.0 == position).map(|p| p.1).sum()
    };
    assert!(time(Position::Up) > time(Position::Down), "{found:?}");
}

#[test]
fn shortest_times_as_by_small_steps() {
    let mut controller = relay(1.0, 0.1);
    (controller.min_on, controller.min_off) = (2.0, 4.0);
    let found = as_by_small_steps(controller, 0.5, 1, 5e-3);
    assert!(cycle_of(&found).positions.iter().any(|p| p.1 >= 4.0));
    controller.dead_zone = 0.15;
    (controller.min_on, controller.min_off) = (2.5, 0.4);
    as_by_small_steps(controller, 1.0, 1, 5e-3);
}

/// Both switch at the same instants then, so that they agree to the error of the small steps.
#[test]
fn a_sampled_relay_and_a_sampled_delay_as_by_small_steps() {
    for (sampling, delay) in [(0.25, 0.0), (0.25, 0.5), (0.4, 1.0)] {
        let mut controller = relay(1.0, 0.05);
        controller.sampling = Some(sampling);
        controller.relay.delay = delay;
        let every = (sampling / 1e-3_f64).round() as usize;
        let shown = by_small_steps(&controller, delay, 1e-3, every);
        let found = settled(&from_below(controller, 0.0)).unwrap();
        let cycle = cycle_of(&found);
        close(cycle.period, shown.period, 1e-9);
        for (value, other) in cycle.range.iter().zip(shown.range) {
            assert!(
                (value - other).abs() < 1e-4 * cycle.amplitude,
                "{cycle:?} {other}"
            );
        }
        // The plant alone lets a disturbance die out: its poles are all at -1.
        let left = cycle.multiplier.unwrap();
        close(left, f64::exp(-cycle.period), 1e-3);
    }
}

/// `y[k] = 1.5 y[k-1] - 0.7 y[k-2] + 0.1 u[k-1]` as a recursion.
#[test]
fn a_plant_in_discrete_time_as_its_recursion() {
    let controller = relay(1.0, 0.05);
    let plant = DiscretePlant::new(&[0.1, 0.0], &[1.0, -1.5, 0.7], 0.2).unwrap();
    let loop_ = OnOffLoop {
        plant: OnOffPlant::Discrete(plant),
        relay: controller,
        initial: None,
    };
    let (mut y, mut u) = ([0.0, 0.0], 1.0);
    let (mut ups, mut range) = (Vec::new(), [f64::INFINITY, f64::NEG_INFINITY]);
    let mut outputs = Vec::new();
    for k in 0..1000 {
        outputs.push(y[0]);
        if u < 0.0 && y[0] < -0.05 {
            u = 1.0;
            ups.push(k);
        } else if u > 0.0 && y[0] > 0.05 {
            u = -1.0;
        }
        y = [1.5 * y[0] - 0.7 * y[1] + 0.1 * u, y[0]];
        if k > 900 {
            range = [range[0].min(y[0]), range[1].max(y[0])];
        }
    }
    let run = run(&loop_, 40.0, 1.0, None).unwrap();
    assert_eq!(run.output.len(), 201);
    for (a, b) in run.output.iter().zip(&outputs) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
    let found = settled(&loop_).unwrap();
    let cycle = cycle_of(&found);
    let [.., a, b] = ups.as_slice() else {
        panic!("no cycle");
    };
    close(cycle.period, 0.2 * f64::from(b - a), 1e-12);
    close(cycle.range[0], range[0], 1e-9);
    close(cycle.range[1], range[1], 1e-9);
    // The poles lie at |z|^2 = 0.7.
    let samples = cycle.period / 0.2;
    close(cycle.multiplier.unwrap(), 0.7_f64.powf(0.5 * samples), 1e-6);
}

/// The describing function comes near the exact cycle; without hysteresis there is an inner balance as well, which is
/// not stable. Each by hand: the first harmonic of what the controller puts out for a sine, `N P = -1`.
#[test]
fn the_first_harmonic_of_three_positions() {
    for hysteresis in [0.02, 0.0] {
        let mut controller = relay(1.0, hysteresis);
        controller.dead_zone = 0.05;
        let loop_ = from_below(controller, 0.6);
        let found = settled(&loop_).unwrap();
        let exact = cycle_of(&found);
        let all = describing_function(&loop_).unwrap();
        let outer = all.iter().find(|b| b.stable == Some(true)).unwrap();
        close(outer.period, exact.period, 0.03);
        close(outer.amplitude, exact.amplitude, 0.05);
        let inner = all.iter().find(|b| b.stable == Some(false));
        assert_eq!(inner.is_some(), hysteresis == 0.0, "{all:?}");
        for balance in &all {
            let gain = harmonic_by_hand(balance.amplitude, 0.05 + hysteresis, 0.05 - hysteresis);
            let off = gain * three_lags(0.6).response(balance.omega) + 1.0;
            assert!(off.norm() < 2e-3, "{balance:?}: {off}");
        }
    }
}

fn harmonic_by_hand(amplitude: f64, on: f64, off: f64) -> num_complex::Complex<f64> {
    let steps = 200_000;
    let (mut sum, mut way) = ([0.0; 2], 0);
    for k in 0..2 * steps {
        let angle = 2.0 * PI * f64::from(k) / f64::from(steps);
        let e = amplitude * angle.sin();
        way = match way {
            _ if e > on => 1,
            _ if e < -on => -1,
            1 if e > off => 1,
            -1 if e < -off => -1,
            _ => 0,
        };
        if k >= steps {
            let share = 2.0 / f64::from(steps) / amplitude;
            sum[0] += share * f64::from(way) * angle.sin();
            sum[1] += share * f64::from(way) * angle.cos();
        }
    }
    num_complex::Complex::new(sum[0], sum[1])
}

/// A heater alone, 0 or 1: around half of what it can reach it is the relay of 0.5 to either side; elsewhere the mean
/// counts.
#[test]
fn the_first_harmonic_of_a_heater_alone() {
    let both = continuous(three_lags(0.0), relay(0.5, 0.05));
    let [same] = describing_function(&both).unwrap()[..] else {
        panic!("one balance");
    };
    for reference in [0.5, 0.35] {
        let mut controller = relay(0.5, 0.05);
        controller.relay.bias = 0.5;
        controller.reference = reference;
        let loop_ = continuous(three_lags(0.0), controller);
        let [balance] = describing_function(&loop_).unwrap()[..] else {
            panic!("one balance");
        };
        if reference == 0.5 {
            close(balance.period, same.period, 1e-6);
            close(balance.amplitude, same.amplitude, 1e-6);
        }
        let found = settled(&loop_).unwrap();
        close(balance.period, cycle_of(&found).period, 0.05);
        close(balance.amplitude, cycle_of(&found).amplitude, 0.1);
    }
}

/// Within the dead zone nothing moves, and a strong dead zone lets every swing die.
#[test]
fn a_wide_dead_zone_brings_rest() {
    let mut controller = relay(1.0, 0.02);
    controller.dead_zone = 0.6;
    let loop_ = from_below(controller, 0.1);
    assert!(settled(&loop_).unwrap().rests.is_some());
    assert_eq!(describing_function(&loop_).unwrap(), Vec::new());
}

/// Odd values end in a result or one sentence, not in a hang.
#[test]
fn odd_loops_end() {
    for bits in 0..256_u32 {
        let bit = |k: u32| f64::from(bits >> k & 1);
        let mut controller = relay(1.0, 0.1 * bit(0));
        controller.dead_zone = 0.2 * bit(1);
        controller.min_on = 3.0 * bit(2);
        controller.min_off = 1e-3 * bit(3);
        controller.sampling = (bit(4) > 0.0).then_some(0.3);
        controller.relay.delay = 1.3 * bit(5);
        controller.reference = 0.4 * bit(6);
        controller.relay.asymmetry = 0.5 * bit(7);
        for plant in [
            TransferFunction::new(&[1.0], &[1.0, 0.0], 0.0),
            TransferFunction::new(&[-1.0, 1.0], &[1.0, 2.0, 1.0], 0.2),
        ] {
            let loop_ = continuous(plant, controller);
            let found = settled(&loop_).unwrap();
            if let Some(cycle) = found.exact {
                assert!(cycle.period > 0.0 && cycle.amplitude >= 0.0, "{cycle:?}");
            }
            describing_function(&loop_);
        }
    }
    let mut wrong = relay(1.0, 0.1);
    wrong.min_off = f64::NAN;
    assert!(settled(&from_below(wrong, 0.0)).is_err());
    assert!(DiscretePlant::new(&[1.0], &[1.0, -0.5], 0.0).is_err());
}

#[test]
fn a_view_begins_where_it_should_and_its_curves_meet_on_both() {
    let input = OnOffInput {
        plant: GivenPlant::Continuous(three_lags(0.0)),
        relay: OnOffRelay {
            relay: Relay::default(),
            dead_zone: 0.1,
            ..OnOffRelay::default()
        },
        start: 1.0,
    };
    let data = view(&input).expect("a loop");
    assert!((data.output[0] - 1.0).abs() < 1e-12);
    // It stands still there: the second sample is as far away as a push of the third derivative takes it.
    assert!((data.output[1] - 1.0).abs() < 1e-4);
    let [meeting] = data.meetings[..] else {
        panic!("{:?}", data.meetings)
    };
    let near = |curve: &[[f64; 2]]| {
        let distance = |p: &[f64; 2]| (p[0] - meeting[0]).hypot(p[1] - meeting[1]);
        curve.iter().map(distance).fold(f64::INFINITY, f64::min)
    };
    let size = meeting[0].hypot(meeting[1]);
    assert!(near(&data.nyquist) < 0.02 * size && near(&data.inverse_df) < 0.02 * size);
    let exact = data.exact.expect("a cycle");
    assert!((exact.period - 4.901_668_676).abs() < 1e-8);
    let again = OnOffInput::of(&input.on_off_loop().expect("a loop")).expect("a loop");
    assert_eq!(again.plant, input.plant);
    assert!((again.start - 1.0).abs() < 1e-12);
}

fn noise(std_dev: f64, interval: f64, seed: u64) -> Noise {
    Noise {
        std_dev,
        interval,
        seed,
    }
}

/// Two positions without anything more are the relay of the textbook, whose simulation is another program.
#[test]
fn in_noise_two_positions_switch_as_the_plain_relay_does() {
    let plant = three_lags(0.4);
    let loop_ = continuous(plant.clone(), relay(1.0, 0.05));
    // It begins within the threshold: the plain relay looks at its noise from the first crossing on only.
    let noise = Some(noise(0.1, 0.02, 3));
    let found = run(&loop_, 40.0, 0.1, noise).unwrap();
    let options = Options {
        noise,
        ..Options::new(40.0, 0.1)
    };
    let plain = simulate::run(&plant.state_space(), &loop_.relay.relay, 0.4, &options).unwrap();
    let mut times: Vec<f64> = plain.rises.iter().chain(&plain.falls).copied().collect();
    times.sort_by(f64::total_cmp);
    assert!(times.len() > 100, "{}", times.len());
    assert_eq!(found.switches.len(), times.len());
    for (switch, time) in found.switches.iter().zip(&times) {
        assert!((switch.time - time).abs() < 1e-9, "{} {time}", switch.time);
    }
    // Without noise it switches twice in a cycle of 8 s.
    let calm = run(&loop_, 40.0, 0.1, None).unwrap();
    assert!(calm.switches.len() < 20, "{}", calm.switches.len());
    assert_eq!(run(&loop_, 40.0, 0.1, noise).unwrap(), found);
}

/// `y[k+1] = 0.9 y[k] + 0.1 u[k]` with heating, off and cooling for two samples at least: a recursion by hand.
#[test]
fn in_noise_a_dead_zone_with_shortest_times_follows_its_recursion() {
    let mut controller = relay(1.0, 0.02);
    (controller.dead_zone, controller.min_on, controller.min_off) = (0.1, 0.4, 0.4);
    let loop_ = OnOffLoop {
        plant: OnOffPlant::Discrete(DiscretePlant::new(&[0.1], &[1.0, -0.9], 0.2).unwrap()),
        relay: controller,
        initial: None,
    };
    let noise = noise(0.15, 0.07, 3);
    let found = run(&loop_, 60.0, 1.0, Some(noise)).unwrap();
    let times: Vec<f64> = (0..=300).map(|k| 0.2 * f64::from(k)).collect();
    let seen = noise.at(&times);
    let (mut y, mut u, mut held, mut switches) = (0.0_f64, 0.0_f64, 0, 0);
    for (k, (noise, output)) in seen.iter().zip(&found.output).enumerate() {
        assert!((y - output).abs() < 1e-12, "{k}: {y} {output}");
        let e = y + noise;
        let outside = |limit: f64| if e.abs() > limit { -e.signum() } else { 0.0 };
        // Off within the zone, and from a push back to off once it is on the zone's near side.
        let wanted = match u {
            0.0 => outside(0.12),
            _ if u * e > -0.08 => outside(0.12),
            _ => u,
        };
        held -= 1;
        let first = k == 0;
        if wanted != u && (held <= 0 || first) {
            u = wanted;
            held = if first { 0 } else { 2 };
            switches += usize::from(!first);
        }
        y = 0.9 * y + 0.1 * u;
    }
    assert!(switches > 50, "{switches}");
    assert_eq!(found.switches.len(), switches);
}
