//! Figs. 7, 8, 10, 11 and 12 of the paper: a drive for each.

use super::{
    Adhesion, Body, Command, Contact, Direction, Drive, DriveInput, DriveRun, EventKind, Summary,
    VelocityRelay, drifting_cycle, engaged_drift,
};
use crate::counted;
use crate::figures::{Check, digits};
use crate::message::{Message, fixed};
use crate::msg;
use crate::relay::Relay;

/// A figure of the paper as a run of a drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveFigure {
    /// Its number in the paper.
    pub number: u32,
    /// What it shows, in a few words.
    pub title: &'static str,
    /// What it claims.
    pub claim: &'static str,
    /// The run.
    pub input: DriveInput,
}

/// Distance of the samples, s.
const STEP: f64 = 2.5e-4;

/// The reference rig: motor and load of 8.8e-4 kg m^2 and a gap of 0.019 rad.
pub fn reference_drive() -> Drive {
    Drive {
        motor: Body {
            inertia: 8.8e-4,
            viscous: 2e-3,
            coulomb: 0.03,
        },
        load: Body {
            inertia: 8.8e-4,
            viscous: 2e-3,
            coulomb: 0.15,
        },
        half_gap: 0.0095,
        contact: Contact::Rigid { restitution: 1.0 },
        adhesion: Adhesion::default(),
    }
}

/// A drifting relay on the reference rig.
pub fn drifting_test() -> DriveInput {
    let relay = VelocityRelay {
        relay: Relay {
            gain: 0.5,
            hysteresis: 0.5,
            asymmetry: 0.3,
            ..Relay::default()
        },
        flip: Some(2.5),
        sampling: None,
    };
    DriveInput::new(reference_drive(), Command::Relay(relay), 10.0, Some(STEP))
}

/// Figs. 7, 8, 10, 11 and 12.
pub fn figures() -> Vec<DriveFigure> {
    let with = |asymmetry: f64, hysteresis: f64, flip: Option<f64>, duration: f64| {
        let mut input = drifting_test();
        input.command = Command::Relay(VelocityRelay {
            relay: Relay {
                gain: 0.5,
                hysteresis,
                asymmetry,
                ..Relay::default()
            },
            flip,
            sampling: None,
        });
        input.duration = duration;
        input
    };
    // A light load, which friction holds wherever the motor leaves it.
    let mut map = with(0.0, 4.0, None, 0.4);
    map.drive.load.inertia = 2e-5;
    map.drive.contact = Contact::Rigid { restitution: 0.0 };
    // A gap that it has soon crossed.
    let mut structure = with(0.3, 0.5, None, 0.6);
    structure.drive.half_gap = 0.002;
    vec![
        DriveFigure {
            number: 7,
            title: "backlash map",
            claim: "Plotted against the motor's position, that of the load is a loop of two parallel branches, 2β \
                    apart.",
            input: map,
        },
        DriveFigure {
            number: 8,
            title: "two-mass structure",
            claim: "In the open gap each mass moves by itself; an impact passes momentum from one to the other, and \
                    their sum stays the same.",
            input: structure,
        },
        DriveFigure {
            number: 10,
            title: "limit cycle in the gap",
            claim: "A symmetric relay swings the motor inside the gap without touching the load.",
            input: with(0.0, 0.5, None, 0.05),
        },
        DriveFigure {
            number: 11,
            title: "drifting cycle",
            claim: "An asymmetric relay makes the same cycle drift through the gap.",
            input: with(0.3, 0.5, None, 0.6),
        },
        DriveFigure {
            number: 12,
            title: "drifted position",
            claim: "Where the motor meets the load, its drift changes: between two such changes lies the gap.",
            input: with(0.3, 0.5, Some(2.5), 10.0),
        },
    ]
}

/// Share by which the branches of the map may miss the gap.
const BRANCHES: f64 = 1e-3;

/// Share by which a simulated cycle may miss its closed form.
const CLOSED_FORM: f64 = 1e-9;

/// Share of the gap that a single crossing may miss it by: the load moves a little after the last contact.
const CROSSING: f64 = 0.1;

/// Milliradians in a radian.
const MILLI: f64 = 1e3;

/// Checks the claim of a figure on a run; none for a number that is not among [`figures`].
pub fn checks(number: u32, input: &DriveInput, run: &DriveRun, summary: &Summary) -> Vec<Check> {
    match number {
        7 => map_has_two_branches(input, run, summary),
        8 => hands_its_momentum_over(input, run),
        10 => stays_in_the_gap(input, run, summary),
        11 => drifts_as_the_formula_says(input, summary),
        12 => changes_its_drift_at_the_ends(input, run, summary),
        _ => Vec::new(),
    }
}

fn check(text: Message, holds: bool) -> Check {
    Check { text, holds }
}

fn map_has_two_branches(input: &DriveInput, run: &DriveRun, summary: &Summary) -> Vec<Check> {
    let gap = 2.0 * input.drive.half_gap;
    let branches = summary.gap();
    let apart = branches.unwrap_or(0.0);
    let (mut pushed, mut slope) = (0.0_f64, 0.0);
    let (mut between, mut slipped) = (0.0_f64, 0.0);
    for i in 1..run.time.len() {
        let (dx1, dx2) = (run.x1[i] - run.x1[i - 1], run.x2[i] - run.x2[i - 1]);
        let inside = |i: usize| (run.x1[i] - run.x2[i]).abs() < (1.0 - BRANCHES) * 0.5 * gap;
        if inside(i) && inside(i - 1) {
            between += dx1.abs();
            slipped += dx2.abs();
        } else if !inside(i) && !inside(i - 1) {
            pushed += dx1.abs();
            slope += dx2.abs();
        }
    }
    vec![
        check(
            msg!(
                "the branches are {} mrad apart, 2β is {} mrad",
                fixed(MILLI * apart, 2),
                fixed(MILLI * gap, 2)
            ),
            (apart / gap - 1.0).abs() < BRANCHES,
        ),
        check(
            msg!(
                "on them the load moves {} times as far as the motor",
                fixed(slope / pushed, 3)
            ),
            (slope / pushed - 1.0).abs() < 0.01,
        ),
        check(
            msg!(
                "between them the load moves {} % as far as the motor",
                fixed(100.0 * slipped / between, 0)
            ),
            slipped < 0.5 * between,
        ),
    ]
}

/// Across each impact, from the sample before it to the one after, the sum of both momenta changes by what the torque
/// and the frictions give in that time at most.
fn hands_its_momentum_over(input: &DriveInput, run: &DriveRun) -> Vec<Check> {
    let Drive { motor, load, .. } = input.drive;
    let (mut handed, mut lost, mut allowed) = (0.0_f64, 0.0_f64, true);
    for event in &run.events {
        let after = run.time.partition_point(|t| *t <= event.time);
        if !matches!(event.kind, EventKind::Impact(..)) || after == 0 || after == run.time.len() {
            continue;
        }
        let (a, b) = (after - 1, after);
        let sum = |i: usize| input.drive.momentum(run.v1[i], run.v2[i]);
        let fastest = |v: &[f64], now: f64| v[a].abs().max(v[b].abs()).max(now.abs());
        let friction = motor.coulomb
            + load.coulomb
            + motor.viscous * fastest(&run.v1, event.v1)
            + load.viscous * fastest(&run.v2, event.v2);
        let torque = run.input[a].abs().max(run.input[b].abs());
        let change = (sum(b) - sum(a)).abs();
        handed = handed.max(load.inertia * (event.v2 - event.speeds_before(&input.drive)[1]).abs());
        lost = lost.max(change);
        allowed &= change <= (torque + friction) * (run.time[b] - run.time[a]);
    }
    let widest = run.x1.iter().zip(&run.x2).map(|(x1, x2)| (x1 - x2).abs());
    let widest = widest.fold(0.0, f64::max);
    vec![
        check(
            msg!(
                "{} at the ends of the gap",
                counted!(run.impacts(), "1 impact", "{} impacts")
            ),
            run.impacts() > 0,
        ),
        check(
            msg!(
                "d stays within {} mrad, β is {} mrad",
                fixed(MILLI * widest, 2),
                fixed(MILLI * input.drive.half_gap, 2)
            ),
            widest <= input.drive.half_gap * (1.0 + CLOSED_FORM),
        ),
        check(
            msg!(
                "an impact transfers up to {} mN m s; their sum changes by {} meanwhile, because of the torque",
                fixed(MILLI * handed, 3),
                fixed(MILLI * lost, 3)
            ),
            allowed && handed > 0.0,
        ),
    ]
}

fn stays_in_the_gap(input: &DriveInput, run: &DriveRun, summary: &Summary) -> Vec<Check> {
    let gap = 2.0 * input.drive.half_gap;
    let Some(cycle) = &summary.cycle else {
        return vec![check("the relay keeps the motor swinging".into(), false)];
    };
    let ups: Vec<f64> = run
        .events
        .iter()
        .filter(|e| e.kind == EventKind::SwitchUp)
        .map(|e| e.time)
        .collect();
    let period = match ups.as_slice() {
        [.., a, b] => b - a,
        _ => f64::NAN,
    };
    let missed = (period / cycle.period - 1.0).abs();
    vec![
        check(
            msg!(
                "it swings over {} of {} mrad",
                fixed(MILLI * cycle.swing, 2),
                fixed(MILLI * gap, 2)
            ),
            cycle.swing < gap,
        ),
        check(
            msg!("{} contacts with the load", run.impacts()),
            run.impacts() == 0,
        ),
        check(
            msg!(
                "its period, {} ms, matches the closed form to {} digits",
                fixed(1e3 * period, 4),
                digits(missed)
            ),
            missed < CLOSED_FORM,
        ),
        check(
            msg!(
                "it drifts by {} % of its swing a period",
                fixed(100.0 * (cycle.drift / cycle.swing).abs(), 4)
            ),
            cycle.drift.abs() < CLOSED_FORM * cycle.swing,
        ),
    ]
}

fn drifts_as_the_formula_says(input: &DriveInput, summary: &Summary) -> Vec<Check> {
    let (Some(cycle), Command::Relay(relay)) = (&summary.cycle, input.command) else {
        return vec![check("the relay keeps the motor swinging".into(), false)];
    };
    let Some(drift) = summary.drifts.first() else {
        return vec![check("the motor drifts freely".into(), false)];
    };
    let missed = (drift.velocity / cycle.drift_velocity() - 1.0).abs();
    let direction = summary.direction(&relay);
    // The same drive without its friction, late instead.
    let mut late = relay;
    late.relay.delay = LATE;
    let smooth = Body {
        viscous: 0.0,
        coulomb: 0.0,
        ..input.drive.motor
    };
    let other = drifting_cycle(&smooth, &late).map_or(0.0, |c| c.drift_velocity());
    vec![
        check(
            msg!(
                "it drifts at {} mrad/s, which matches the closed form to {} digits",
                fixed(MILLI * drift.velocity, 3),
                digits(missed)
            ),
            missed < CLOSED_FORM,
        ),
        check(
            "with friction it drifts against the stronger push".into(),
            direction == Some(Direction::Against),
        ),
        check(
            msg!(
                "without friction, but {} ms late, it would drift with it, at {} mrad/s",
                fixed(1e3 * LATE, 1),
                fixed(MILLI * other, 1)
            ),
            other * relay.relay.mean_output() > 0.0,
        ),
    ]
}

/// Delay of the drive that Fig. 11 is compared with, s.
const LATE: f64 = 3e-4;

fn changes_its_drift_at_the_ends(
    input: &DriveInput,
    run: &DriveRun,
    summary: &Summary,
) -> Vec<Check> {
    let gap = 2.0 * input.drive.half_gap;
    let mut all = Vec::new();
    let free = summary.drifts.first().map(|d| d.velocity.abs());
    if let (Some(free), Some(engaged)) = (free, engaged_drift(run, summary)) {
        let engaged = engaged.abs();
        all.push(check(
            msg!(
                "it drifts at {} mrad/s in the gap, and at {} while it pushes the load",
                fixed(MILLI * free, 2),
                fixed(MILLI * engaged, 2)
            ),
            (engaged / free - 1.0).abs() > 0.05,
        ));
    } else {
        all.push(check(
            "it drifts in the gap and pushes the load".into(),
            false,
        ));
    }
    let count = summary.traverses.len();
    all.push(check(
        msg!(
            "it crosses the gap {}",
            counted!(count, "1 time", "{} times")
        ),
        count >= 2,
    ));
    let mean = summary.traverses.iter().map(|t| t.travel).sum::<f64>() / count.max(1) as f64;
    all.push(check(
        msg!(
            "from contact to contact the motor moves {} mrad, 2β is {} mrad",
            fixed(MILLI * mean, 2),
            fixed(MILLI * gap, 2)
        ),
        (mean / gap - 1.0).abs() < CROSSING,
    ));
    all
}
