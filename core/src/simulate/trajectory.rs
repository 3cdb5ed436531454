//! What a run leaves behind.

/// A simulated run of one relay and its output, sampled at equal steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times, s.
    pub time: Vec<f64>,
    /// Output `y`.
    pub output: Vec<f64>,
    /// Its derivative, 1/s.
    pub slope: Vec<f64>,
    /// Acting input as `[t, u]` at each change; while the output slides, at each sample.
    pub input: Vec<[f64; 2]>,
    /// Instants at which the relay switched up (`h` became +1), s.
    pub rises: Vec<f64>,
    /// Instants at which it switched down, s.
    pub falls: Vec<f64>,
    /// Smallest and largest output between each two rises, exact: from the extrema of the output and
    /// its corners, not from samples.
    pub swings: Vec<[f64; 2]>,
    /// Intervals of time in which an ideal relay held the output on its threshold (Filippov sliding).
    pub sliding: Vec<[f64; 2]>,
    /// Why the run was cut before its end, if it was.
    pub cut: Option<Cut>,
}

/// Why a run is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// The relay switches without end: ever faster, or far faster than the plant can follow.
    Chattering,
    /// It switched as often as a run may, though at a pace that goes on: the run was too long.
    TooManySwitches,
    /// A mode of the plant is so fast that the run would take millions of steps.
    TooFast,
}

impl Trajectory {
    /// The last instant of which something is known, s.
    pub fn end(&self) -> f64 {
        let last = [self.time.last(), self.rises.last(), self.falls.last()];
        last.into_iter().flatten().copied().fold(0.0, f64::max)
    }

    /// Period in s and amplitude (half of peak to peak) of the last whole cycle, if the run has settled:
    /// the two last cycles differ by less than the share `tolerance` in both.
    pub fn settled(&self, tolerance: f64) -> Option<(f64, f64)> {
        let [.., a, b, c] = self.rises.as_slice() else {
            return None;
        };
        let [.., before, last] = self.swings.as_slice() else {
            return None;
        };
        let (period, amplitude) = (c - b, 0.5 * (last[1] - last[0]));
        let earlier = 0.5 * (before[1] - before[0]);
        let calm = ((b - a) - period).abs() < tolerance * period
            && (earlier - amplitude).abs() < tolerance * amplitude;
        let goes_on = matches!(self.cut, None | Some(Cut::TooManySwitches));
        (calm && goes_on).then_some((period, amplitude))
    }
}
