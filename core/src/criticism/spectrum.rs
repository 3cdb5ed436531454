//! At which frequencies the model fails: the periodogram of a residual beside that of what was measured.
//!
//! By Parseval the lines of the periodogram share out the squared error. A band counts for what it has beyond its width
//! (white noise has as much) and beyond its share of the measured motion: where a model is a little wrong throughout,
//! the residual has the frequencies of the motion, and that is no finding. Where the model starts anew in every window,
//! slow errors are taken up by the starting states, and what is left of them has the frequency of the windows: only
//! what swings several times in a window is looked at.

use super::data::Data;
use crate::diagnosis::ProfileBin;
use crate::message::Message;
use crate::msg;

/// Bands from one period of the record to half the sampling rate, in equal ratios: some five in an octave.
const BANDS: usize = 60;

/// Bands of a picture.
const SHOWN: usize = 30;

/// Share of what a band has beyond chance that its borders may lose to be closer.
const SPARED: f64 = 0.05;

/// Periods that a frequency has at least in a window.
const PERIODS: f64 = 4.0;

/// Samples are at most this share of a step off an even grid; else there is no periodogram.
const EVEN: f64 = 0.1;

/// Fewest samples of a periodogram.
const LEAST: usize = 64;

/// Power of a residual and of the measured output over frequency, each with the sum 1.
pub(super) struct Spectrum {
    /// Distance of the lines, Hz.
    step: f64,
    /// The first line that is looked at.
    first: usize,
    error: Vec<f64>,
    motion: Vec<f64>,
    /// Mean square of the residual.
    mean_square: f64,
}

/// A band of frequencies that holds much of the squared error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Band {
    /// Its borders, Hz.
    pub from: f64,
    pub to: f64,
    /// Its share of the squared error, of all frequencies, and of the power of the measured output.
    pub error: f64,
    pub width: f64,
    pub motion: f64,
    /// It begins at 0, or ends at half the sampling rate.
    pub lowest: bool,
    pub highest: bool,
}

impl Band {
    /// What it has beyond its width and its share of the motion.
    pub fn excess(&self) -> f64 {
        self.error - self.width.max(self.motion)
    }

    /// Where it is, in words.
    pub fn place(&self) -> Message {
        match (self.lowest, self.highest) {
            (true, _) => msg!("below {} Hz", hertz(self.to)),
            (_, true) => msg!("above {} Hz", hertz(self.from)),
            _ => msg!("between {} and {} Hz", hertz(self.from), hertz(self.to)),
        }
    }
}

impl Spectrum {
    /// Of a residual of all samples; `None` where these are few, not evenly spaced, or not all simulated.
    pub fn of(data: &Data, measured: &[f64], residual: &[f64]) -> Option<Self> {
        if data.used() < data.len() {
            return None;
        }
        let windows = data.windows.len();
        let slowest = if windows > 1 {
            let duration = data.excitation.mean_step() * data.len() as f64;
            PERIODS * windows as f64 / duration
        } else {
            0.0
        };
        Self::new(&data.time, measured, residual, slowest)
    }

    /// `slowest`: the lowest frequency that is looked at, Hz.
    fn new(time: &[f64], measured: &[f64], residual: &[f64], slowest: f64) -> Option<Self> {
        let n = residual.len();
        if n < LEAST {
            return None;
        }
        let step = (time[n - 1] - time[0]) / (n - 1) as f64;
        let on_grid = |(i, t): (usize, &f64)| (t - time[0] - step * i as f64).abs() <= EVEN * step;
        if !time.iter().enumerate().all(on_grid) {
            return None;
        }
        let mean = measured.iter().sum::<f64>() / n as f64;
        let moved = measured.iter().map(|v| v - mean);
        let (mut error, mut motion) = powers(residual, moved);
        let sum: f64 = error.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        let padded = 2 * (error.len() - 1);
        scale(&mut error);
        scale(&mut motion);
        let line = 1.0 / (step * padded as f64);
        let first = (slowest / line).ceil() as usize;
        if 2 * first >= error.len() {
            return None;
        }
        Some(Self {
            step: line,
            first,
            error,
            motion,
            mean_square: residual.iter().map(|r| r * r).sum::<f64>() / n as f64,
        })
    }

    /// Share of all frequencies that the lines `from` to `to` are; the first and the last are half as wide.
    fn width(&self, from: usize, to: usize) -> f64 {
        let last = self.error.len() - 1;
        let halves = usize::from(from == 0) + usize::from(to == last + 1);
        ((to - from) as f64 - 0.5 * halves as f64) / last as f64
    }

    /// The lines `from` to `to`, the last not among them.
    fn band(&self, from: usize, to: usize) -> Band {
        let lines = self.error.len();
        let border = |line: usize| self.step * (line as f64 - 0.5);
        Band {
            from: border(from).max(0.0),
            to: border(to).min(self.step * (lines - 1) as f64),
            error: self.error[from..to].iter().sum(),
            width: self.width(from, to),
            motion: self.motion[from..to].iter().sum(),
            lowest: from == 0,
            highest: to == lines,
        }
    }

    /// First lines of `count` bands in equal ratios, and the end; fewer where lines are scarce.
    fn edges(&self, count: usize) -> Vec<usize> {
        let lines = self.error.len();
        let least = self.first.max(1) as f64;
        let ratio = libm::pow(lines as f64 / least, 1.0 / count as f64);
        let mut edges = vec![self.first];
        let mut edge = least;
        for _ in 0..count {
            edge *= ratio;
            let line = (edge.round() as usize).min(lines);
            // The line at 0 is half a line.
            if line > edges[edges.len() - 1].max(1) {
                edges.push(line);
            }
        }
        edges
    }

    /// The band with the most error beyond its width and its share of the motion.
    pub fn strongest(&self) -> Option<Band> {
        let edges = self.edges(BANDS);
        let excess: Vec<f64> = edges
            .windows(2)
            .map(|e| self.band(e[0], e[1]).excess())
            .collect();
        let (mut best, mut range) = (0.0, None);
        let (mut sum, mut from) = (0.0, 0);
        for (k, e) in excess.iter().enumerate() {
            if sum <= 0.0 {
                (sum, from) = (0.0, k);
            }
            sum += e;
            if sum > best {
                (best, range) = (sum, Some((from, k)));
            }
        }
        let (mut from, mut to) = range?;
        let mut spared = SPARED * best;
        while from < to && excess[from].min(excess[to]) <= spared {
            if excess[from] <= excess[to] {
                spared -= excess[from];
                from += 1;
            } else {
                spared -= excess[to];
                to -= 1;
            }
        }
        Some(self.band(edges[from], edges[to + 1]))
    }

    /// Root mean square of the residual in bands, such that white noise has the same in all.
    pub fn profile(&self) -> Vec<ProfileBin> {
        self.edges(SHOWN)
            .windows(2)
            .map(|e| {
                let band = self.band(e[0], e[1]);
                ProfileBin {
                    from: band.from,
                    to: band.to,
                    mean: 0.0,
                    rms: (self.mean_square * band.error / band.width).sqrt(),
                }
            })
            .collect()
    }
}

/// A frequency to three digits.
fn hertz(f: f64) -> String {
    let digits = (2.0 - libm::log10(f.max(f64::MIN_POSITIVE)).floor()).clamp(0.0, 6.0) as usize;
    format!("{f:.digits$}")
}

/// Makes the sum 1.
fn scale(powers: &mut [f64]) {
    let sum: f64 = powers.iter().sum();
    if sum > 0.0 {
        for p in powers {
            *p /= sum;
        }
    }
}

/// Power of two series over the lines from 0 to half the sampling rate, both from one transform: one series is the real
/// part, the other the imaginary one. A long record is filled up with zeros to a power of 2.
fn powers(a: &[f64], b: impl Iterator<Item = f64>) -> (Vec<f64>, Vec<f64>) {
    let n = a.len().next_power_of_two();
    let mut z: Vec<[f64; 2]> = a.iter().zip(b).map(|(a, b)| [*a, b]).collect();
    z.resize(n, [0.0; 2]);
    transform(&mut z);
    (0..=n / 2)
        .map(|k| {
            let (p, q) = (z[k], z[(n - k) % n]);
            let real = [p[0] + q[0], p[1] - q[1]];
            let imaginary = [p[0] - q[0], p[1] + q[1]];
            // The lines below 0 are those above: each counts twice, but for the two that have no twin.
            let twice = if k == 0 || k == n / 2 { 0.25 } else { 0.5 };
            let power = |z: [f64; 2]| twice * (z[0] * z[0] + z[1] * z[1]);
            (power(real), power(imaginary))
        })
        .unzip()
}

/// The discrete Fourier transform in place, for a power of 2 (Cooley and Tukey 1965).
fn transform(z: &mut [[f64; 2]]) {
    let n = z.len();
    let shift = usize::BITS - n.trailing_zeros();
    for i in 1..n {
        let j = i.reverse_bits() >> shift;
        if i < j {
            z.swap(i, j);
        }
    }
    let turns: Vec<[f64; 2]> = (0..n / 2)
        .map(|k| {
            let (sin, cos) = libm::sincos(-std::f64::consts::TAU * k as f64 / n as f64);
            [cos, sin]
        })
        .collect();
    let mut half = 1;
    while half < n {
        let stride = n / (2 * half);
        for block in z.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for (k, (a, b)) in low.iter_mut().zip(high).enumerate() {
                let w = turns[k * stride];
                let t = [w[0] * b[0] - w[1] * b[1], w[0] * b[1] + w[1] * b[0]];
                *b = [a[0] - t[0], a[1] - t[1]];
                *a = [a[0] + t[0], a[1] + t[1]];
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::rig::Random;

    const STEP: f64 = 1e-3;

    fn time(n: usize) -> Vec<f64> {
        (0..n).map(|i| STEP * i as f64).collect()
    }

    fn tone(n: usize, hertz: f64, size: f64) -> Vec<f64> {
        let wave = |t: &f64| size * libm::sin(TAU * hertz * t);
        time(n).iter().map(wave).collect()
    }

    fn noise(n: usize, seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed);
        (0..n).map(|_| random.between(-0.5, 0.5)).collect()
    }

    fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| a + b).collect()
    }

    #[test]
    fn the_transform_is_that_of_the_definition() {
        let (a, b) = (noise(64, 1), noise(64, 2));
        let (pa, pb) = powers(&a, b.iter().copied());
        for (k, (pa, pb)) in pa.iter().zip(&pb).enumerate() {
            for (series, power) in [(&a, pa), (&b, pb)] {
                let (mut re, mut im) = (0.0, 0.0);
                for (i, v) in series.iter().enumerate() {
                    let (sin, cos) = libm::sincos(TAU * (i * k) as f64 / 64.0);
                    re += v * cos;
                    im -= v * sin;
                }
                let sides = if k == 0 || k == 32 { 1.0 } else { 2.0 };
                let expected = sides * (re * re + im * im);
                assert!((power - expected).abs() < 1e-11, "{k}: {power} {expected}");
            }
        }
    }

    #[test]
    fn a_tone_beside_noise_and_motion_is_found_where_it_is() {
        let n = 10_000;
        let motion = tone(n, 3.0, 20.0);
        // Power 0.5 of the tone, 1/12 of the noise.
        let residual = sum(&tone(n, 31.0, 1.0), &noise(n, 7));
        let band = Spectrum::new(&time(n), &motion, &residual, 0.0)
            .unwrap()
            .strongest()
            .unwrap();
        assert!(band.from < 31.0 && 31.0 < band.to, "{band:?}");
        assert!(band.to / band.from < 1.4, "{band:?}");
        let share = 0.5 / (0.5 + 1.0 / 12.0);
        assert!((band.error - share).abs() < 0.02, "{band:?}");
        assert!(band.width < 0.03 && band.motion < 0.01, "{band:?}");
    }

    #[test]
    fn noise_and_the_frequencies_of_the_motion_itself_are_no_finding() {
        let n = 10_000;
        let motion = sum(&tone(n, 3.0, 20.0), &tone(n, 9.0, 5.0));
        let alike = motion.iter().map(|v| 0.01 * v).collect();
        for residual in [noise(n, 11), alike] {
            let spectrum = Spectrum::new(&time(n), &motion, &residual, 0.0).unwrap();
            let excess = spectrum.strongest().map_or(0.0, |b| b.excess());
            assert!(excess < 0.05, "{excess}");
        }
    }

    #[test]
    fn what_lies_at_an_end_says_so() {
        let n = 4000;
        let still = noise(n, 5);
        let drift: Vec<f64> = time(n).iter().map(|t| t - 2.0).collect();
        let alternating: Vec<f64> = (0..n)
            .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        for (residual, word) in [(drift, "below "), (alternating, "above ")] {
            let spectrum = Spectrum::new(&time(n), &still, &residual, 0.0).unwrap();
            let place = spectrum.strongest().unwrap().place();
            assert!(place.to_string().starts_with(word), "{place}");
        }
    }

    #[test]
    fn white_noise_has_its_own_size_in_every_band() {
        let n = 16_384;
        let residual: Vec<f64> = noise(n, 13).iter().map(|v| v * 12.0_f64.sqrt()).collect();
        let spectrum = Spectrum::new(&time(n), &residual, &residual, 0.0).unwrap();
        let bins = spectrum.profile();
        assert!((bins.last().unwrap().to - 500.0).abs() < 1e-9);
        let mut before = 0.0;
        for bin in &bins {
            assert!(bin.from < bin.to && bin.from == before, "{bin:?}");
            before = bin.to;
            // A band of so many lines scatters by the square root of one over their number.
            let lines = (bin.to - bin.from) * n as f64 * STEP;
            assert!((bin.rms - 1.0).abs() < 3.0 / lines.sqrt(), "{bin:?}");
        }
    }

    #[test]
    fn what_is_slower_than_asked_is_not_looked_at() {
        let n = 4000;
        let residual = sum(&tone(n, 20.0, 10.0), &tone(n, 153.0, 6.0));
        let spectrum = Spectrum::new(&time(n), &noise(n, 5), &residual, 60.0).unwrap();
        let band = spectrum.strongest().unwrap();
        assert!(
            band.from > 100.0 && band.to > 153.0 && band.to < 200.0,
            "{band:?}"
        );
        // Its share is that of the whole error.
        assert!(
            (band.error - 36.0 / 136.0).abs() < 0.02 && !band.lowest,
            "{band:?}"
        );
        let from = spectrum.profile()[0].from;
        assert!((from - 60.0).abs() < 0.5, "{from}");
    }

    #[test]
    fn uneven_samples_have_no_spectrum() {
        let mut late = time(1000);
        for t in &mut late[500..] {
            *t += 0.5 * STEP;
        }
        let values = noise(1000, 3);
        assert!(Spectrum::new(&late, &values, &values, 0.0).is_none());
        assert!(Spectrum::new(&time(1000), &values, &values, 0.0).is_some());
    }
}
