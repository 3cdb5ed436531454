//! Exact responses to an input that is held between samples and comes a dead time late.

/// A held input, as the times at which it changes.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// Times of the changes, s; the first is the start of the record.
    times: Vec<f64>,
    /// Values from there on.
    values: Vec<f64>,
}

impl Held {
    /// From samples; the first value acted before them as well.
    pub fn new(time: &[f64], input: &[f64]) -> Self {
        let (mut times, mut values) = (Vec::new(), Vec::<f64>::new());
        for (t, u) in time.iter().zip(input) {
            if values.last() != Some(u) {
                times.push(*t);
                values.push(*u);
            }
        }
        Self { times, values }
    }

    /// How often it changes.
    pub fn changes(&self) -> usize {
        self.times.len()
    }

    /// With its mean from each of the `edges` to the next; the last value stays.
    pub fn averaged(&self, edges: &[f64]) -> Self {
        let (mut times, mut values) = (Vec::new(), Vec::new());
        let mut next = 0;
        for edge in edges.windows(2) {
            let (mut from, mut area) = (edge[0], 0.0);
            let mut value = self.at(from);
            next += self.times[next..].partition_point(|t| *t <= from);
            while next < self.times.len() && self.times[next] < edge[1] {
                area += value * (self.times[next] - from);
                (from, value) = (self.times[next], self.values[next]);
                next += 1;
            }
            times.push(edge[0]);
            values.push((area + value * (edge[1] - from)) / (edge[1] - edge[0]));
        }
        if let Some(last) = edges.last() {
            times.push(*last);
            values.push(self.at(*last));
        }
        Self { times, values }
    }

    /// Calls `step(duration, value)` for the stretches with a constant input after the dead time, and `sample(i)` at
    /// each of the `samples`, in order; before the first sample the input had its first value.
    fn walk(&self, samples: &[f64], dead_time: f64, mut step: impl FnMut(Part)) {
        let Some(&start) = samples.first() else {
            return;
        };
        let mut now = start;
        // The change that acts next.
        let mut next = self.times.partition_point(|t| t + dead_time <= start);
        let mut value = self.values[next.saturating_sub(1).min(self.values.len() - 1)];
        for (i, &t) in samples.iter().enumerate() {
            while next < self.times.len() && self.times[next] + dead_time <= t {
                let at = self.times[next] + dead_time;
                if at > now {
                    step(Part::Stretch(at - now, value));
                    now = at;
                }
                value = self.values[next];
                next += 1;
            }
            if t > now {
                step(Part::Stretch(t - now, value));
                now = t;
            }
            step(Part::Sample(i));
        }
    }

    /// Response of the lag `e^(-Ls)/(T s + 1)` at the `samples`, from rest at the first value, less `origin`.
    pub fn lag(
        &self,
        samples: &[f64],
        time_constant: f64,
        origin: f64,
        dead_time: f64,
    ) -> Vec<f64> {
        let mut x = self.values.first().copied().unwrap_or(0.0);
        let mut out = vec![0.0; samples.len()];
        // Samples are mostly as far apart: the last exponential is kept.
        let mut kept = (f64::NAN, 0.0);
        self.walk(samples, dead_time, |part| match part {
            Part::Stretch(span, u) => {
                if span != kept.0 {
                    kept = (span, libm::exp(-span / time_constant));
                }
                x = u + (x - u) * kept.1;
            }
            Part::Sample(i) => out[i] = x - origin,
        });
        out
    }

    /// Integral of the delayed input from the first sample, less `origin`, at the `samples`.
    pub fn integral(&self, samples: &[f64], origin: f64, dead_time: f64) -> Vec<f64> {
        let mut x = 0.0;
        let mut out = vec![0.0; samples.len()];
        self.walk(samples, dead_time, |part| match part {
            Part::Stretch(span, u) => x += (u - origin) * span,
            Part::Sample(i) => out[i] = x,
        });
        out
    }

    /// Value at a time, without dead time.
    pub fn at(&self, t: f64) -> f64 {
        let i = self.times.partition_point(|s| *s <= t);
        self.values[i.saturating_sub(1).min(self.values.len() - 1)]
    }

    /// `int e^(-j w t) u(t) dt` from `from` to `to`, the mean of `u` taken off.
    pub fn fourier(&self, omega: f64, from: f64, to: f64) -> [f64; 2] {
        let mut edges = vec![from];
        edges.extend(self.times.iter().copied().filter(|t| *t > from && *t < to));
        edges.push(to);
        let pieces = || edges.windows(2).map(|e| (e[0], e[1], self.at(e[0])));
        let mean = pieces().map(|(a, b, u)| u * (b - a)).sum::<f64>() / (to - from);
        let mut sum = [0.0; 2];
        for (a, b, u) in pieces() {
            // Times from the start of the window, so that the phase stays exact far from zero.
            let [(sa, ca), (sb, cb)] = [a, b].map(|t| libm::sincos(omega * (t - from)));
            sum[0] += (u - mean) * (sb - sa) / omega;
            sum[1] += (u - mean) * (cb - ca) / omega;
        }
        sum
    }
}

/// What `walk` meets.
enum Part {
    /// So many seconds with this input.
    Stretch(f64, f64),
    /// A sample.
    Sample(usize),
}
