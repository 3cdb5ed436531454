//! The probe where the body moves.

use super::Probe;

/// Share of the typical speed above which a body moves; samples of a stretch in which it does, at least; and one part
/// in how many that these must be of all.
const MOVING: f64 = 0.1;
const LEAST_MOVING: usize = 20;
const MOSTLY_STILL: usize = 5;

impl Probe {
    /// The same on the stretches where the body moves, with dry friction of any level explained beside the base forces.
    /// While it sticks, friction takes up whatever else acts, and where a model lets go a little too early or too late,
    /// what it leaves tells of little else. `None` where it moves all the time, or hardly ever.
    pub fn moving(&self) -> Option<Self> {
        let fast = MOVING * self.scales.speed;
        let still: Vec<usize> = (0..self.velocity.len())
            .filter(|k| self.velocity[*k].abs() < fast)
            .collect();
        let mut spans = Vec::new();
        for (from, to) in &self.spans {
            let first = still.partition_point(|k| k < from);
            let last = still.partition_point(|k| k < to);
            let ends = still[first..last].iter().copied().chain([*to]);
            let mut begin = *from;
            for end in ends {
                if end >= begin + LEAST_MOVING {
                    spans.push((begin, end));
                }
                begin = end + 1;
            }
        }
        let moves: usize = spans.iter().map(|(from, to)| to - from).sum();
        let all: usize = self.spans.iter().map(|(from, to)| to - from).sum();
        if spans.is_empty() || moves == all || moves < all / MOSTLY_STILL {
            return None;
        }
        let mut probe = Self {
            spans,
            ..self.clone()
        };
        probe.look(Self::bends);
        probe.explain(|k| self.velocity[k].signum());
        Some(probe)
    }

    /// What was measured in a window less what the acting input would do, one output after the other, in noise units.
    fn bends(&self, (from, to): (usize, usize)) -> Vec<f64> {
        let input = |k: usize| self.acting.get(k).copied().unwrap_or(0.0);
        let said = self.answer((from, to), |k| self.inverse_inertia * input(k));
        let outputs = self.outputs.iter().flat_map(|(is_velocity, weight)| {
            let values = if *is_velocity {
                &self.velocity
            } else {
                &self.position
            };
            let measured = values[from..to].iter();
            measured.map(move |value| weight * (value - values[from]))
        });
        outputs.zip(said).map(|(seen, said)| seen - said).collect()
    }
}
