//! Where does the mean of a sequence change?

/// A run of values with one mean: indices `from..to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// First index.
    pub from: usize,
    /// One past the last index.
    pub to: usize,
    /// Mean of the values.
    pub mean: f64,
}

/// Splits `values` into runs of constant mean, for normal noise of standard deviation `sigma`.
///
/// Minimises the sum of squares about the means, in units of `sigma` squared, plus `penalty` for each
/// change, exactly. PELT: Killick, Fearnhead and Eckley 2012, JASA 107, equations (2) and (4) with K = 0.
/// A penalty of `3 ln n` or more keeps false changes rare. Empty where there are no values or `sigma` is
/// not positive; values must be finite.
pub fn pelt(values: &[f64], sigma: f64, penalty: f64) -> Vec<Segment> {
    let n = values.len();
    if n == 0 || sigma.is_nan() || sigma <= 0.0 {
        return Vec::new();
    }
    // Sums about the mean keep digits where the values are far from zero.
    let centre = values.iter().sum::<f64>() / n as f64;
    let mut sums = vec![(0.0, 0.0)];
    let (mut sum, mut square) = (0.0, 0.0);
    for value in values {
        let scaled = (value - centre) / sigma;
        sum += scaled;
        square += scaled * scaled;
        sums.push((sum, square));
    }
    let cost = |from: usize, to: usize| {
        let (sum, square) = (sums[to].0 - sums[from].0, sums[to].1 - sums[from].1);
        square - sum * sum / (to - from) as f64
    };
    let mut best = vec![-penalty];
    let mut last = vec![0];
    let mut open = vec![0_usize];
    for to in 1..=n {
        let costs: Vec<f64> = open
            .iter()
            .map(|&from| best[from] + cost(from, to))
            .collect();
        let mut least = (f64::INFINITY, 0);
        for (&from, &c) in open.iter().zip(&costs) {
            if c < least.0 {
                least = (c, from);
            }
        }
        best.push(least.0 + penalty);
        last.push(least.1);
        // A start that is already worse by the penalty can never win again.
        let mut kept: Vec<usize> = open
            .iter()
            .zip(&costs)
            .filter(|(_, c)| **c <= least.0 + penalty)
            .map(|(from, _)| *from)
            .collect();
        kept.push(to);
        open = kept;
    }
    let mut segments = Vec::new();
    let mut to = n;
    while to > 0 {
        let from = last[to];
        let mean = values[from..to].iter().sum::<f64>() / (to - from) as f64;
        segments.push(Segment { from, to, mean });
        to = from;
    }
    segments.reverse();
    segments
}
