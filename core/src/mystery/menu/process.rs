//! What can be hidden in a process.

use crate::effect::EffectId;
use crate::mystery::Experiment::{ProcessBinary, ProcessRelay, ProcessStairs};
use crate::mystery::hideable::{Family, Hide, Hideable};
use crate::rig::process::Stranger;

/// Shares of a time constant of some 30 s and of an input of 1. What shifts, bends or cuts off the static
/// characteristic is one family: of two such effects a diagnosis may find neither.
pub(super) const MENU: &[Hideable] = &[
    Hideable {
        id: EffectId::new("input_delay"),
        main: "tau",
        strengths: [3.0, 5.0, 8.0],
        range: [1.0, 15.0],
        shown_by: &[ProcessRelay, ProcessBinary, ProcessStairs],
        families: &[Family::Lateness],
        hide: Hide::Process(|tau, rig, _| {
            // In whole steps of the bench, so that it is met exactly.
            rig.dead_time = (tau / 5e-3).round() * 5e-3;
            vec![("tau", rig.dead_time)]
        }),
    },
    Hideable {
        id: EffectId::new("second_lag"),
        main: "T2",
        strengths: [4.0, 6.0, 8.0],
        range: [2.0, 15.0],
        shown_by: &[ProcessRelay, ProcessBinary, ProcessStairs],
        families: &[Family::Storage],
        hide: Hide::Process(|time, rig, _| {
            rig.second_lag = time;
            vec![("T2", time)]
        }),
    },
    Hideable {
        id: EffectId::new("sensor_lag"),
        main: "T_s",
        strengths: [3.0, 4.5, 6.0],
        range: [1.5, 12.0],
        shown_by: &[ProcessBinary, ProcessStairs],
        // Two lags in a row are the same in either order.
        families: &[Family::Storage],
        hide: Hide::Process(|time, rig, _| {
            rig.sensor_lag = time;
            vec![("T_s", time)]
        }),
    },
    Hideable {
        id: EffectId::new("underdamped"),
        main: "P",
        strengths: [15.0, 20.0, 30.0],
        range: [10.0, 40.0],
        shown_by: &[ProcessBinary, ProcessStairs],
        families: &[Family::Storage],
        hide: Hide::Process(|period, rig, random| {
            // Some tenths of the damping that would stop it.
            let damping = random.between(0.15, 0.6);
            rig.swing_period = period;
            rig.time_constant = damping * period / std::f64::consts::PI;
            vec![("P", period)]
        }),
    },
    Hideable {
        id: EffectId::new("gain_asymmetry"),
        main: "a",
        strengths: [0.08, 0.12, 0.16],
        range: [0.03, 0.4],
        shown_by: &[ProcessStairs, ProcessBinary],
        families: &[Family::Offset],
        hide: Hide::Process(|a, rig, _| {
            rig.gain_asymmetry = a;
            vec![("a", a)]
        }),
    },
    Hideable {
        id: EffectId::new("constant_load"),
        main: "F0",
        strengths: [0.05, 0.08, 0.12],
        range: [0.02, 0.3],
        shown_by: &[ProcessStairs, ProcessBinary],
        families: &[Family::Offset],
        hide: Hide::Process(|load, rig, _| {
            rig.constant_load = load;
            vec![("F0", load)]
        }),
    },
    Hideable {
        id: EffectId::new("load_ramp"),
        main: "r",
        strengths: [3e-4, 5e-4, 8e-4],
        range: [1e-4, 1.5e-3],
        shown_by: &[ProcessRelay, ProcessStairs],
        families: &[Family::Offset],
        hide: Hide::Process(|slope, rig, _| {
            rig.load_ramp = slope;
            vec![("r", slope)]
        }),
    },
    Hideable {
        id: EffectId::new("saturation"),
        main: "M",
        strengths: [0.72, 0.66, 0.6],
        range: [0.4, 0.9],
        // The others have one size of input only.
        shown_by: &[ProcessStairs],
        families: &[Family::Offset],
        hide: Hide::Process(|limit, rig, _| {
            rig.saturation = limit;
            vec![("M", limit)]
        }),
    },
    Hideable {
        id: EffectId::new("static_curvature"),
        main: "p",
        strengths: [0.04, 0.06, 0.08],
        range: [0.02, 0.12],
        shown_by: &[ProcessStairs],
        families: &[Family::Offset],
        hide: Hide::Process(|p, rig, _| {
            rig.curvature = p;
            vec![("p", p)]
        }),
    },
    Hideable {
        id: EffectId::new("outflow"),
        main: "a",
        strengths: [0.3, 0.4, 0.5],
        range: [0.2, 0.8],
        shown_by: &[ProcessStairs],
        families: &[Family::Stranger],
        hide: Hide::Process(|flow, rig, _| {
            rig.stranger = Some(Stranger::Outflow { flow });
            vec![("a", flow)]
        }),
    },
    Hideable {
        id: EffectId::new("periodic_disturbance"),
        main: "a",
        strengths: [0.06, 0.08, 0.1],
        range: [0.04, 0.3],
        shown_by: &[ProcessBinary, ProcessStairs],
        families: &[Family::Stranger],
        hide: Hide::Process(|amplitude, rig, random| {
            let period = random.between(30.0, 50.0);
            rig.stranger = Some(Stranger::Swing { amplitude, period });
            vec![("a", amplitude), ("P", period)]
        }),
    },
    Hideable {
        id: EffectId::new("valve_stiction"),
        main: "b",
        strengths: [0.06, 0.09, 0.12],
        range: [0.03, 0.25],
        shown_by: &[ProcessStairs],
        families: &[Family::Stranger],
        hide: Hide::Process(|behind, rig, random| {
            let jump = random.between(0.5, 1.5) * behind;
            let band = 2.0 * behind + jump;
            rig.stranger = Some(Stranger::SlippingValve { band, jump });
            vec![("b", behind)]
        }),
    },
    Hideable {
        id: EffectId::new("directional_lag"),
        main: "a",
        strengths: [0.1, 0.15, 0.2],
        range: [0.06, 0.5],
        shown_by: &[ProcessStairs, ProcessBinary],
        families: &[Family::Stranger, Family::Storage],
        hide: Hide::Process(|a, rig, _| {
            rig.stranger = Some(Stranger::SlowFall {
                factor: (1.0 + a) / (1.0 - a),
            });
            vec![("a", a)]
        }),
    },
    Hideable {
        id: EffectId::new("rate_limit"),
        main: "r",
        strengths: [0.2, 0.15, 0.1],
        range: [0.06, 0.3],
        shown_by: &[ProcessStairs],
        families: &[Family::Stranger],
        hide: Hide::Process(|rate, rig, _| {
            rig.stranger = Some(Stranger::SlowValve { rate });
            vec![("r", rate)]
        }),
    },
    Hideable {
        id: EffectId::new("dead_zone"),
        main: "z",
        strengths: [0.06, 0.09, 0.12],
        range: [0.04, 0.25],
        shown_by: &[ProcessStairs],
        families: &[Family::Stranger],
        hide: Hide::Process(|width, rig, _| {
            rig.stranger = Some(Stranger::DeadBand { width });
            vec![("z", width)]
        }),
    },
    Hideable {
        id: EffectId::new("inverse_response"),
        main: "T_z",
        strengths: [4.0, 6.0, 8.0],
        range: [2.0, 15.0],
        shown_by: &[ProcessBinary, ProcessStairs],
        families: &[Family::Stranger, Family::Storage],
        hide: Hide::Process(|time, rig, random| {
            rig.second_lag = random.between(3.0, 5.0);
            rig.stranger = Some(Stranger::WrongWay { time });
            vec![("T_z", time), ("T2", rig.second_lag)]
        }),
    },
];
