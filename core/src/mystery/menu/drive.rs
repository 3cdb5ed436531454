//! What can be hidden in a drive.

use crate::effect::EffectId;
use crate::mystery::Experiment::{Drifting, Relay, Sines, Stairs};
use crate::mystery::hideable::{Family, Hide, Hideable};
use crate::rig::{Friction, Load, Stranger};

pub(super) const MENU: &[Hideable] = &[
    Hideable {
        id: EffectId::new("coulomb_friction"),
        main: "c",
        strengths: [0.02, 0.035, 0.05],
        range: [5e-3, 0.12],
        // Under a relay the drive runs at one speed: dry and viscous friction are the same there.
        shown_by: &[Sines, Stairs],
        families: &[Family::Friction],
        hide: Hide::Drive(|c, rig, _| {
            rig.friction = Friction::dry(c);
            vec![("c", c)]
        }),
    },
    Hideable {
        id: EffectId::new("stribeck_friction"),
        main: "c",
        strengths: [0.02, 0.027, 0.035],
        range: [0.01, 0.06],
        shown_by: &[Sines],
        families: &[Family::Friction],
        hide: Hide::Drive(|c, rig, random| {
            rig.friction = Friction {
                coulomb: c,
                standing: random.between(2.0, 2.6) * c,
                stribeck_velocity: random.between(0.6, 1.5),
                displacement: 2e-5,
            };
            let Friction {
                standing,
                stribeck_velocity,
                ..
            } = rig.friction;
            vec![("c", c), ("dc", standing - c), ("v_s", stribeck_velocity)]
        }),
    },
    Hideable {
        id: EffectId::new("presliding_friction"),
        main: "c",
        strengths: [0.04, 0.05, 0.06],
        range: [0.02, 0.1],
        shown_by: &[Sines, Stairs],
        families: &[Family::Friction],
        hide: Hide::Drive(|c, rig, random| {
            // The bristle yields over milliradians, as in a preloaded bearing.
            let displacement = random.between(2e-3, 5e-3);
            rig.friction = Friction {
                displacement,
                ..Friction::dry(c)
            };
            vec![("c", c), ("s", displacement)]
        }),
    },
    Hideable {
        id: EffectId::new("quadratic_drag"),
        main: "q",
        strengths: [4e-5, 6e-5, 8e-5],
        range: [1e-5, 3e-4],
        shown_by: &[Sines, Stairs],
        families: &[Family::Drag],
        hide: Hide::Drive(|q, rig, _| {
            rig.quadratic_drag = q;
            vec![("q", q)]
        }),
    },
    Hideable {
        id: EffectId::new("joint_compliance"),
        main: "K",
        strengths: [30.0, 20.0, 10.0],
        range: [5.0, 60.0],
        shown_by: &[Sines],
        families: &[Family::Load],
        hide: Hide::Drive(|stiffness, rig, random| {
            // A load like the motor.
            let load = Load {
                half_gap: 0.0,
                stiffness,
                damping: random.between(0.0, 2e-3),
                inertia: 8.8e-4,
                viscous: 2e-3,
                coulomb: 0.0,
            };
            rig.load = Some(load);
            vec![("K", stiffness), ("J2", load.inertia)]
        }),
    },
    Hideable {
        id: EffectId::new("backlash"),
        main: "beta",
        strengths: [2e-3, 3e-3, 4e-3],
        range: [1e-3, 8e-3],
        // Only where the motor drifts does it cross the gap.
        shown_by: &[Drifting],
        families: &[Family::Load],
        hide: Hide::Drive(|half_gap, rig, random| {
            // A load like the motor, with the contact of hardened teeth.
            let load = Load {
                half_gap,
                stiffness: 800.0,
                damping: 0.15,
                inertia: 8.8e-4,
                viscous: 2e-3,
                coulomb: random.between(0.01, 0.03),
            };
            rig.load = Some(load);
            // What stands behind the gap is seen in its short contacts only.
            vec![("beta", half_gap)]
        }),
    },
    Hideable {
        id: EffectId::new("input_delay"),
        main: "tau",
        strengths: [4e-4, 7.5e-4, 1.1e-3],
        range: [2e-4, 3e-3],
        shown_by: &[Relay, Sines],
        families: &[Family::Lateness],
        hide: Hide::Drive(|tau, rig, _| {
            // In whole steps of the bench, so that it is met exactly.
            rig.delay = (tau / 1e-5).round() * 1e-5;
            vec![("tau", rig.delay)]
        }),
    },
    Hideable {
        id: EffectId::new("actuator_lag"),
        main: "T_a",
        strengths: [5e-4, 8.5e-4, 1.2e-3],
        range: [3e-4, 4e-3],
        shown_by: &[Relay, Stairs],
        families: &[Family::Lateness],
        hide: Hide::Drive(|time, rig, _| {
            rig.actuator_lag = time;
            vec![("T_a", time)]
        }),
    },
    Hideable {
        id: EffectId::new("sensor_lag"),
        main: "T_s",
        strengths: [5e-4, 8e-4, 1.1e-3],
        range: [3e-4, 4e-3],
        shown_by: &[Sines],
        families: &[Family::Lateness],
        hide: Hide::Drive(|time, rig, _| {
            rig.sensor_lag = time;
            vec![("T_s", time)]
        }),
    },
    Hideable {
        id: EffectId::new("gain_asymmetry"),
        main: "a",
        strengths: [0.03, 0.055, 0.08],
        range: [0.01, 0.3],
        shown_by: &[Stairs, Relay],
        families: &[Family::Offset],
        hide: Hide::Drive(|a, rig, _| {
            rig.gain_asymmetry = a;
            vec![("a", a)]
        }),
    },
    Hideable {
        id: EffectId::new("constant_load"),
        main: "F0",
        strengths: [0.01, 0.02, 0.03],
        range: [5e-3, 0.06],
        shown_by: &[Stairs, Sines, Relay],
        families: &[Family::Offset],
        hide: Hide::Drive(|torque, rig, _| {
            rig.constant_load = torque;
            vec![("F0", torque)]
        }),
    },
    Hideable {
        id: EffectId::new("cogging"),
        main: "a",
        strengths: [0.02, 0.035, 0.05],
        range: [0.01, 0.1],
        shown_by: &[Sines, Stairs],
        families: &[Family::Ripple],
        hide: Hide::Drive(|amplitude, rig, random| {
            let periods = random.between(3.0, 12.0).round();
            rig.cogging = (amplitude, periods, random.between(-3.0, 3.0));
            vec![("a", amplitude), ("n", periods)]
        }),
    },
    Hideable {
        id: EffectId::new("saturation"),
        main: "M",
        strengths: [0.4, 0.35, 0.3],
        range: [0.2, 0.6],
        shown_by: &[Sines],
        families: &[Family::Amplifier],
        hide: Hide::Drive(|limit, rig, _| {
            rig.saturation = limit;
            vec![("M", limit)]
        }),
    },
    Hideable {
        id: EffectId::new("dead_zone"),
        main: "z",
        strengths: [0.015, 0.022, 0.03],
        range: [8e-3, 0.08],
        shown_by: &[Sines, Stairs],
        families: &[Family::Amplifier],
        hide: Hide::Drive(|width, rig, _| {
            rig.dead_zone = width;
            vec![("z", width)]
        }),
    },
    Hideable {
        id: EffectId::new("gravity"),
        main: "a",
        strengths: [0.06, 0.08, 0.1],
        range: [0.02, 0.3],
        shown_by: &[Sines],
        families: &[Family::Stranger],
        hide: Hide::Drive(|torque, rig, _| {
            rig.stranger = Some(Stranger::Gravity { torque });
            vec![("a", torque)]
        }),
    },
    Hideable {
        id: EffectId::new("return_spring"),
        main: "k",
        strengths: [0.04, 0.05, 0.06],
        range: [0.02, 0.2],
        shown_by: &[Stairs],
        families: &[Family::Stranger],
        hide: Hide::Drive(|stiffness, rig, _| {
            rig.stranger = Some(Stranger::Spring { stiffness });
            vec![("k", stiffness)]
        }),
    },
    Hideable {
        id: EffectId::new("load_dependent_friction"),
        main: "m",
        strengths: [0.15, 0.2, 0.25],
        range: [0.05, 0.4],
        shown_by: &[Sines],
        families: &[Family::Stranger],
        hide: Hide::Drive(|share, rig, _| {
            rig.stranger = Some(Stranger::LoadFriction { share });
            vec![("m", share)]
        }),
    },
    Hideable {
        id: EffectId::new("end_stop"),
        main: "k",
        strengths: [3.0, 5.0, 8.0],
        range: [1.0, 20.0],
        shown_by: &[Sines],
        families: &[Family::Stranger],
        hide: Hide::Drive(|stiffness, rig, random| {
            let upper = random.between(0.8, 1.2);
            let lower = -random.between(0.8, 1.2);
            rig.stranger = Some(Stranger::EndStops {
                stiffness,
                damping: 6e-3,
                upper,
                lower,
            });
            vec![("k", stiffness), ("x_h", upper), ("x_l", lower)]
        }),
    },
    Hideable {
        id: EffectId::new("position_friction"),
        main: "g",
        strengths: [2e-3, 2.5e-3, 3e-3],
        range: [1e-3, 6e-3],
        shown_by: &[Sines],
        families: &[Family::Stranger],
        hide: Hide::Drive(|slope, rig, random| {
            rig.friction = Friction::dry(random.between(0.04, 0.05));
            rig.stranger = Some(Stranger::TightEnd { slope });
            vec![("g", slope)]
        }),
    },
    Hideable {
        id: EffectId::new("cogging_harmonics"),
        main: "b",
        strengths: [0.02, 0.035, 0.05],
        range: [0.01, 0.1],
        shown_by: &[Sines, Stairs],
        families: &[Family::Ripple],
        hide: Hide::Drive(|torque, rig, random| {
            let periods = random.between(3.0, 8.0).round();
            rig.cogging = (torque, periods, random.between(-3.0, 3.0));
            rig.stranger = Some(Stranger::SecondWave {
                torque,
                phase: random.between(-3.0, 3.0),
            });
            vec![("b", torque), ("n", periods)]
        }),
    },
    Hideable {
        id: EffectId::new("torque_ripple"),
        main: "a",
        strengths: [0.1, 0.15, 0.2],
        range: [0.05, 0.5],
        shown_by: &[Sines],
        families: &[Family::Stranger],
        hide: Hide::Drive(|share, rig, random| {
            let periods = random.between(3.0, 8.0).round();
            rig.stranger = Some(Stranger::Ripple {
                share,
                periods,
                phase: random.between(-3.0, 3.0),
            });
            vec![("a", share), ("n", periods)]
        }),
    },
    Hideable {
        id: EffectId::new("encoder_eccentricity"),
        main: "e",
        strengths: [3e-3, 4.5e-3, 6e-3],
        range: [2e-3, 0.02],
        shown_by: &[Stairs],
        families: &[Family::Stranger],
        hide: Hide::Drive(|share, rig, random| {
            rig.stranger = Some(Stranger::EccentricEncoder {
                share,
                phase: random.between(-3.0, 3.0),
            });
            vec![("e", share)]
        }),
    },
    Hideable {
        id: EffectId::new("rate_limit"),
        main: "r",
        strengths: [12.0, 10.0, 8.0],
        range: [5.0, 20.0],
        shown_by: &[Sines],
        families: &[Family::Stranger],
        hide: Hide::Drive(|rate, rig, _| {
            rig.stranger = Some(Stranger::SlowAmplifier { rate });
            vec![("r", rate)]
        }),
    },
    Hideable {
        id: EffectId::new("periodic_disturbance"),
        main: "a",
        strengths: [0.01, 0.015, 0.02],
        range: [5e-3, 0.05],
        shown_by: &[Stairs],
        families: &[Family::Stranger],
        hide: Hide::Drive(|torque, rig, random| {
            let period = random.between(0.13, 0.3);
            rig.stranger = Some(Stranger::Shaking {
                torque,
                period,
                phase: random.between(-3.0, 3.0),
            });
            vec![("a", torque), ("P", period)]
        }),
    },
];
