//! Which windows of a drive are held back?
//!
//! Of every two neighbouring windows one is fitted and the other judges. In any order that is fixed beforehand a
//! motion may show one thing to the fit and another to the judge: a periodic one its phases, one that passes a
//! hard spot four times the spot itself. So the pairs are ranked by how much more the baseline leaves in one of
//! their windows than in the other, and along this rank the worse one is now fitted and now held back: both parts
//! get their share of what is missing. (Data are split evenly, "duplex": Snee 1977, Validation of regression
//! models.) The judge stays fair: the values of no effect are known yet when the windows are divided.

use super::cost::cost_between;
use super::cut::{Block, MIN_WINDOW};
use super::data::Data;
use super::fit::Fit;
use super::knowledge::Knowledge;
use super::structure::Structure;
use super::window::bend_within;
use crate::effect::Scales;
use crate::measurement::Kind;

/// Iterations of the baseline before its error is looked at.
const ITERATIONS: usize = 3;

/// Share of what is left beyond the noise from which a window is cut into so many at most, and how often.
const LONE: f64 = 0.6;
const PIECES: usize = 8;
const CUTS: usize = 2;

/// Least share of the bend of the motion that the fitted windows have.
const TOLD: f64 = 0.2;

/// Mean square, in noise units, that may be noise.
const NOISY: f64 = 4.0;

/// Holds back one of every two neighbouring windows, so that both parts know as much of what the baseline that
/// begins at `values` does not explain.
///
/// A window that holds most of it, or the one transient that there is, is cut into shorter ones first: a step that fell
/// to the judge alone would leave the body unknown. A process runs through without a restart: what it leaves in a block
/// is not that block's own, and the order of the blocks stays as it is. So does that of windows that begin where a load
/// was felt: they are of no fixed length, and tell by turns of one end of the gap and of the other.
pub(super) fn hold_back(
    data: &mut Data,
    knowledge: &Knowledge,
    mut values: Vec<f64>,
    scales: &Scales,
) {
    if data.kind == Kind::Process || data.excitation.sees_load() {
        return;
    }
    let structure = Structure::new(data.baseline, Vec::new(), knowledge.clone());
    structure.begin(&mut values, 0);
    let mut fit = fitted(data, &structure, &values, scales);
    for _ in 0..CUTS {
        let Some((window, pieces)) =
            lone(data, &left(data, &fit)).or_else(|| lone(data, &bends(data)))
        else {
            break;
        };
        data.cut_finer(window, pieces);
        fit = fitted(data, &structure, &values, scales);
    }
    let cost = |k: usize| {
        let block = &data.blocks[k];
        cost_between(data, &fit.motion, block.from, block.to)
    };
    let mut ranked: Vec<(usize, f64)> = (0..data.blocks.len() / 2)
        .map(|pair| 2 * pair)
        .map(|first| (first, cost(first) - cost(first + 1)))
        .collect();
    ranked.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    for (rank, (first, more)) in ranked.into_iter().enumerate() {
        let worse = first + usize::from(more < 0.0);
        let better = 2 * first + 1 - worse;
        let held = if is_odd(rank) { worse } else { better };
        data.blocks[held].held_back = true;
    }
    share_bends(data);
}

/// Where nearly all of the motion's bends fell to the judge, the pair with most of them changes sides.
fn share_bends(data: &mut Data) {
    let bends = bends(data);
    let all: f64 = bends.iter().sum();
    let blocks = || data.blocks.iter().zip(&bends);
    let fitted: f64 = blocks().filter(|(b, _)| !b.held_back).map(|(_, w)| w).sum();
    let held = (0..bends.len() / 2 * 2).filter(|k| data.blocks[*k].held_back);
    let most = held.max_by(|a, b| bends[*a].total_cmp(&bends[*b]));
    if let Some(most) = most.filter(|_| fitted < TOLD * all) {
        data.blocks[most].held_back = false;
        data.blocks[most ^ 1].held_back = true;
    }
}

/// The baseline from `values`, fitted a little to all windows.
fn fitted(data: &mut Data, structure: &Structure, values: &[f64], scales: &Scales) -> Fit {
    for block in &mut data.blocks {
        block.held_back = false;
    }
    let (structure, values) = (structure.clone(), values.to_vec());
    let mut fit = Fit::new(data, structure, values, data.guessed_starts(), scales);
    fit.polish_starts(data, scales);
    for _ in 0..ITERATIONS {
        fit.iterate(data, scales);
    }
    fit
}

/// What is left of each window beyond the noise: what acts once only, as a limit of the input while a machine starts,
/// would be seen by the fit or by the judge alone.
fn left(data: &Data, fit: &Fit) -> Vec<f64> {
    let beyond = data.blocks.iter().map(|b| {
        let left = cost_between(data, &fit.motion, b.from, b.to);
        (left - noisy(data, b)).max(0.0)
    });
    beyond.collect()
}

/// How far the motion bends in each window beyond the noise: what a body that goes on without a force does not tell.
fn bends(data: &Data) -> Vec<f64> {
    let bend = |b: &Block| {
        let outputs = data.outputs.iter();
        outputs
            .map(|o| bend_within(o, &o.values[b.from..b.to]))
            .sum::<f64>()
    };
    let beyond = data
        .blocks
        .iter()
        .map(|b| (bend(b) - noisy(data, b)).max(0.0));
    beyond.collect()
}

/// Squares, in noise units, that may be noise.
fn noisy(data: &Data, block: &Block) -> f64 {
    NOISY * data.measured(block.from, block.to) as f64
}

/// The window that holds most of this share of all, and into how many it can be cut, if one does and can be.
fn lone(data: &Data, shares: &[f64]) -> Option<(usize, usize)> {
    let worst = (0..shares.len()).max_by(|a, b| shares[*a].total_cmp(&shares[*b]))?;
    let block = &data.blocks[worst];
    let most = shares[worst] > LONE * shares.iter().sum::<f64>();
    let pieces = PIECES.min((block.to - block.from) / MIN_WINDOW);
    (most && pieces > 1).then_some((block.window, pieces))
}

/// One of every two ranks, in the order of Thue and Morse, which never repeats itself.
fn is_odd(rank: usize) -> bool {
    rank.count_ones() % 2 == 1
}

#[cfg(test)]
mod tests {
    use crate::effect::baseline::Baseline;
    use std::fmt::Write as _;

    use super::*;
    use crate::criticism::guess::guess;
    use crate::criticism::session::Session;
    use crate::measurement::import_csv;
    use crate::rig::{DriveRig, Excitation, Stranger};
    use crate::user_model::UserModel;

    #[test]
    fn both_parts_pass_a_hard_spot_that_is_seldom_met() {
        let (at, width) = (0.5, 0.1);
        let measurement = DriveRig {
            excitation: Excitation::Multisine { amplitude: 0.08 },
            stranger: Some(Stranger::PositionBump {
                torque: 0.06,
                at,
                width,
            }),
            ..DriveRig::default()
        }
        .measure();
        let mut data = Data::new(&measurement).unwrap();
        let plain = Baseline::plain();
        let guess = guess(&data, &data.excitation.effective_input(&plain)).unwrap();
        let scales = data.scales(guess[0], guess[1]);
        let knowledge = Knowledge::of(&UserModel::blank(data.kind));
        hold_back(&mut data, &knowledge, guess, &scales);
        for pair in data.blocks.chunks_exact(2) {
            assert_ne!(pair[0].held_back, pair[1].held_back);
        }
        let position = data.position_estimate();
        for held in [true, false] {
            let mut blocks = data.blocks.iter().filter(|b| b.held_back == held);
            assert!(
                blocks.any(|b| position[b.from..b.to]
                    .iter()
                    .any(|x| (x - at).abs() < width)),
                "held back: {held}"
            );
        }
    }

    #[test]
    fn both_parts_pass_the_one_start_of_a_motor() {
        let (inertia, viscous, push, step) = (0.01, 0.1, 1.0, 5e-3);
        let speed = |k: usize| {
            let since = (k as f64 - 230.0).max(0.0) * step;
            push / viscous * (1.0 - libm::exp(-viscous / inertia * since))
        };
        let mut text = "t [s],u [N m],v1 [rad/s]\n".to_owned();
        for k in 0..900 {
            let input = if k < 230 { 0.0 } else { push };
            let noise = 0.02 * libm::sin(1e4 * libm::sin(1e3 * k as f64));
            let _ = writeln!(text, "{},{input},{}", k as f64 * step, speed(k) + noise);
        }
        let measurement = import_csv("start", text.as_bytes(), None).unwrap();
        let (session, _) =
            Session::screened(&measurement, &UserModel::blank(measurement.kind)).unwrap();
        let bends = bends(&session.data);
        let of = |held: bool| -> f64 {
            let blocks = session.data.blocks.iter().zip(&bends);
            let part = blocks.filter(|(b, _)| b.held_back == held);
            part.map(|(_, bend)| bend).sum()
        };
        assert!(of(false) > TOLD * (of(false) + of(true)), "{bends:?}");
        assert!(of(true) > 0.0, "{bends:?}");
    }
}
