//! What a second body asks of the motor, as columns of a regression.

use super::atom::{Series, Solved};

/// Share of the body below which a load is nothing that a regression tells ([`Range::Sizeable`]).
const LEAST_LOAD: f64 = 0.05;

/// What inertia, viscous and dry friction of a load at these positions ask of the motor.
pub(super) fn load_columns(position: &[f64], step: f64) -> Vec<Series> {
    let speed = |k: usize| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(position.len() - 1));
        (position[after] - position[before]) / (step * (after - before).max(1) as f64)
    };
    let rubbing: Vec<f64> = (0..position.len())
        .map(|k| {
            if speed(k) == 0.0 {
                0.0
            } else {
                -speed(k).signum()
            }
        })
        .collect();
    let back: Vec<f64> = position.iter().map(|y| -y).collect();
    let viscous = back.clone();
    [(2, back), (1, viscous), (0, rubbing)]
        .map(|(derivative, values)| Series { derivative, values })
        .into_iter()
        .collect()
}

/// Whether a load of this inertia is more than nothing beside its body.
pub(super) fn is_load(inertia: f64, solved: &Solved) -> bool {
    inertia > LEAST_LOAD * solved.body[0] && solved.body[0] > 0.0
}

/// Inertia, viscous and dry friction of a load; none where it is nothing.
pub(super) fn load_values(solved: &Solved) -> Option<[f64; 3]> {
    let [inertia, viscous, dry] = *solved.coefficients else {
        return None;
    };
    is_load(inertia, solved).then_some([inertia, viscous.max(0.0), dry.max(0.0)])
}
