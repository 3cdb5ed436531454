//! Over the place where a fit is stuck.
//!
//! Friction that holds and lets go bends the motion sharply, and its level, its stiffness and the damping can be exchanged
//! for each other along a long valley. There a fit creeps and stops short of the least cost, since every step meets a
//! bend; from the other side the way down is often smooth.

use super::fit::Fit;
use super::search::Search;

/// How far beyond a stuck fit others begin, in times of the way that it has come.
const LEAPS: [f64; 2] = [2.0, 1.0];

impl Search {
    /// Refits from beyond where a stuck fit stopped, as seen from where it began.
    pub fn leaping(fit: &Fit) -> Self {
        let points = LEAPS.map(|times| (fit.beyond(times), fit.starts.clone()));
        Self::from_points(fit.structure.clone(), points.into(), f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::criticism::session::Session;
    use crate::criticism::structure::Structure;
    use crate::effect::{Effect, EffectId};
    use crate::measurement::import_csv;
    use crate::user_model::UserModel;

    /// The friction of this drive, N m.
    const FRICTION: f64 = 0.05;

    #[test]
    fn a_fit_that_is_stuck_before_the_friction_of_drive_12_comes_down_from_beyond() {
        let bytes = include_bytes!("../../../assets/measurements/drive-12.csv");
        let measurement = import_csv("drive-12", bytes, None).unwrap();
        let session = Session::new(&measurement, &UserModel::blank(measurement.kind)).unwrap();
        let (data, scales) = (&session.data, &session.scales);
        let effects: Vec<&'static dyn Effect> = ["input_delay", "coulomb_friction"]
            .map(|id| session.find(EffectId::new(id)).unwrap())
            .into();
        let structure = Structure::new(data.baseline, effects, session.knowledge.clone());
        let values = vec![8.8e-4, 0.012, 6.02e-4, 0.045, 6e-6, 0.02];
        let mut stuck = Fit::new(data, structure, values, data.guessed_starts(), scales);
        while !stuck.done {
            stuck.iterate(data, scales);
        }
        let off = |fit: &Fit| (fit.values[3] / FRICTION - 1.0).abs();
        assert!(stuck.is_stuck() && off(&stuck) > 0.03, "{:?}", stuck.values);
        let mut search = Search::leaping(&stuck);
        while search.scan(data, &session.scout, scales) || search.iterate(data, scales) {}
        let again = search.finish(data, scales).unwrap();
        assert!(
            again.cost < 0.99 * stuck.cost,
            "{} {}",
            again.cost,
            stuck.cost
        );
        assert!(off(&again) < 0.01, "{:?}", again.values);
    }
}
