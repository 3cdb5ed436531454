//! What a slow sensor shows of an output.

/// Share of what a lag began with that is no longer looked at.
const FADED: f64 = 1e-3;

/// A sensor with a first-order lag.
pub(super) struct SlowSensor<'a> {
    /// Its time constant, s.
    pub lag: f64,
    /// Time of each sample, s.
    pub time: &'a [f64],
    /// What it showed; empty where that is not known.
    pub shown: &'a [f64],
    /// By how much what it shows at the begin of the record is off the signal there.
    pub off: f64,
}

impl SlowSensor<'_> {
    /// Passes a run of a signal through the lag, straight between its samples. A run that begins within the record
    /// begins as if the signal had come the same way before, or so that what was shown comes out best; the record
    /// itself with a sensor that is `off` the signal.
    pub fn pass(&self, signal: &mut [f64], (from, end): (usize, usize)) {
        let lag = self.lag;
        let (Some(signal), Some(time)) = (signal.get_mut(from..end), self.time.get(from..end))
        else {
            return;
        };
        if signal.len() < 2 {
            return;
        }
        let mut before = signal[0];
        let mut slow = before;
        if from > 0 {
            slow -= lag * (signal[1] - signal[0]) / (time[1] - time[0]);
        } else {
            slow += self.off;
        }
        signal[0] = slow;
        for (value, time) in signal[1..].iter_mut().zip(time.windows(2)) {
            let (h, now) = (time[1] - time[0], *value);
            let (decay, slope) = (libm::exp(-h / lag), (now - before) / h);
            // The lag follows a ramp at the distance slope * lag.
            slow = now - slope * lag + (slow - before + slope * lag) * decay;
            before = now;
            *value = slow;
        }
        if from > 0
            && let Some(shown) = self.shown.get(from..end)
        {
            begin_as_shown(signal, shown, time, lag);
        }
    }
}

/// Adds to a lagged signal what it may have begun with, which fades away: so much that it comes nearest to what was
/// `shown` (least squares).
fn begin_as_shown(signal: &mut [f64], shown: &[f64], time: &[f64], lag: f64) {
    let fading = |k: usize| libm::exp((time[0] - time[k]) / lag);
    let seen = (0..signal.len()).take_while(|k| fading(*k) > FADED);
    let (product, square) = seen.fold((0.0, 0.0), |(product, square), k| {
        let share = fading(k);
        (
            product + share * (shown[k] - signal[k]),
            square + share * share,
        )
    });
    // The first sample is shown as it is, so that there is a square.
    let begun = product / square;
    for (k, value) in signal.iter_mut().enumerate() {
        let share = fading(k);
        if share <= FADED {
            break;
        }
        *value += begun * share;
    }
}
