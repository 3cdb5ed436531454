//! Short series on one step: Chebyshev coefficients for exact bounds, powers for evaluation.
//!
//! On a step of length `h` the output of a linear plant is an entire function, so that a series of
//! fixed length carries it to round-off if the step is short enough; [`is_resolved`] tells. Roots are
//! isolated by bounds on whole intervals, never by looking at samples: no pair of crossings is missed.

use crate::root::newton;

/// Terms of a series; degree 17 resolves steps of some four time constants.
pub(crate) const TERMS: usize = 18;

/// Coefficients, lowest degree first, over the variable `z` in [-1, 1].
pub(crate) type Series = [f64; TERMS];

/// Chebyshev nodes `cos(pi (2i+1) / 36)`, as literals so that every platform has the same bits.
pub(crate) const NODES: Series = [
    0.996_194_698_091_745_5,
    0.965_925_826_289_068_3,
    0.906_307_787_036_65,
    0.819_152_044_288_991_8,
    std::f64::consts::FRAC_1_SQRT_2,
    0.573_576_436_351_046,
    0.422_618_261_740_699_4,
    0.258_819_045_102_520_74,
    0.087_155_742_747_658_18,
    -0.087_155_742_747_658_18,
    -0.258_819_045_102_520_74,
    -0.422_618_261_740_699_4,
    -0.573_576_436_351_046,
    -std::f64::consts::FRAC_1_SQRT_2,
    -0.819_152_044_288_991_8,
    -0.906_307_787_036_65,
    -0.965_925_826_289_068_3,
    -0.996_194_698_091_745_5,
];

/// `T_0(z)` to `T_17(z)`.
pub(crate) fn chebyshev(z: f64) -> Series {
    let mut t = [1.0; TERMS];
    t[1] = z;
    for k in 2..TERMS {
        t[k] = 2.0 * z * t[k - 1] - t[k - 2];
    }
    t
}

/// Pairs of columns: entries `2j` hold the even powers of `T_2k`, entries `2j + 1` the odd powers of
/// `T_(2k+1)`, each of which has no other ones.
static POWERS: [Series; TERMS / 2] = powers();

const fn powers() -> [Series; TERMS / 2] {
    let mut t = [[0.0; TERMS]; TERMS];
    t[0][0] = 1.0;
    t[1][1] = 1.0;
    let mut k = 2;
    while k < TERMS {
        let mut j = 0;
        while j <= k {
            let higher = if j > 0 { 2.0 * t[k - 1][j - 1] } else { 0.0 };
            t[k][j] = higher - t[k - 2][j];
            j += 1;
        }
        k += 1;
    }
    let mut pairs = [[0.0; TERMS]; TERMS / 2];
    let mut k = 0;
    while k < TERMS {
        let mut j = k % 2;
        while j < TERMS {
            pairs[k / 2][j] = t[k][j];
            j += 2;
        }
        k += 1;
    }
    pairs
}

/// Share of the whole that the last two coefficients may have on a resolved step: round-off.
const RESOLVED: f64 = 1e-15;

/// Share of the whole by which an output at rest seems to move: what the round-off of the state makes of itself.
const AT_REST: f64 = 1e-13;

/// Whether Chebyshev coefficients have fallen to round-off, or to the `noise` of their making, or belong to an output
/// at rest, which is to be waited for in long steps.
pub(crate) fn is_resolved(c: &Series, noise: f64) -> bool {
    let size: f64 = c.iter().map(|v| v.abs()).sum();
    c[TERMS - 1].abs() + c[TERMS - 2].abs() <= RESOLVED * size + noise
        || spread(c) <= AT_REST * size
}

/// Largest distance of a Chebyshev series from its first coefficient.
pub(crate) fn spread(c: &Series) -> f64 {
    c[1..].iter().map(|v| v.abs()).sum()
}

/// Powers of a Chebyshev series whose coefficients fall fast.
pub(crate) fn to_powers(c: &Series) -> Series {
    let mut m = [0.0; TERMS];
    for (weights, columns) in c.chunks_exact(2).zip(&POWERS) {
        for (value, power) in m.chunks_exact_mut(2).zip(columns.chunks_exact(2)) {
            value[0] += weights[0] * power[0];
            value[1] += weights[1] * power[1];
        }
    }
    m
}

/// Chebyshev coefficients of the derivative with respect to `z`.
pub(crate) fn derivative(c: &Series) -> Series {
    let mut d = [0.0; TERMS];
    for k in (1..TERMS).rev() {
        let above = if k + 1 < TERMS { d[k + 1] } else { 0.0 };
        d[k - 1] = above + 2.0 * k as f64 * c[k];
    }
    d[0] *= 0.5;
    d
}

/// Powers of the derivative with respect to `z`.
pub(crate) fn power_derivative(m: &Series) -> Series {
    let mut d = [0.0; TERMS];
    for k in 1..TERMS {
        d[k - 1] = k as f64 * m[k];
    }
    d
}

/// Value at `z` of a series in powers; even and odd powers side by side, since each chain of
/// multiplications waits for itself.
pub(crate) fn value(m: &Series, z: f64) -> f64 {
    let w = z * z;
    let (mut even, mut odd) = (0.0, 0.0);
    for k in (0..TERMS / 2).rev() {
        even = even * w + m[2 * k];
        odd = odd * w + m[2 * k + 1];
    }
    even + z * odd
}

/// Value and derivative at `z`.
fn value_and_slope(m: &Series, d: &Series, z: f64) -> (f64, f64) {
    (value(m, z), value(d, z))
}

/// Coefficients of `s -> m(middle + radius s)`.
fn local(m: &Series, middle: f64, radius: f64) -> Series {
    let mut c = *m;
    if middle != 0.0 {
        for i in 0..TERMS - 1 {
            for k in (i..TERMS - 1).rev() {
                c[k] += middle * c[k + 1];
            }
        }
    }
    if radius != 1.0 {
        let mut scale = 1.0;
        for value in &mut c {
            *value *= scale;
            scale *= radius;
        }
    }
    c
}

/// Halvings of an interval before a pair of roots counts as a touch.
const MAX_DEPTH: u32 = 40;

/// Changes of sign of a series in an interval, in ascending order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roots {
    at: [f64; TERMS],
    count: usize,
}

impl Roots {
    const NONE: Self = Self {
        at: [0.0; TERMS],
        count: 0,
    };

    /// All changes of sign of `m` (in powers) between `low` and `high`.
    pub fn of(m: &Series, low: f64, high: f64) -> Self {
        let mut roots = Self::NONE;
        roots.search(m, &power_derivative(m), low, high, 0);
        roots
    }

    /// The roots.
    pub fn as_slice(&self) -> &[f64] {
        &self.at[..self.count]
    }

    /// The roots before `end`.
    pub fn before(&self, end: f64) -> &[f64] {
        let roots = self.as_slice();
        &roots[..roots.partition_point(|z| *z < end)]
    }

    fn search(&mut self, m: &Series, d: &Series, low: f64, high: f64, depth: u32) {
        let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low));
        let here = local(m, middle, radius);
        let rest: f64 = here[1..].iter().map(|v| v.abs()).sum();
        if here[0].abs() > rest || !rest.is_finite() {
            return;
        }
        let slope: f64 = (2..TERMS).map(|k| k as f64 * here[k].abs()).sum();
        let monotone = here[1].abs() > slope;
        if !monotone && depth < MAX_DEPTH {
            self.search(m, d, low, middle, depth + 1);
            self.search(m, d, middle, high, depth + 1);
            return;
        }
        let (f_low, f_high) = (value(m, low), value(m, high));
        if f_low != 0.0 && (f_low < 0.0) != (f_high < 0.0) && self.count < TERMS {
            self.at[self.count] = root(m, d, low, high, f_low, f_high);
            self.count += 1;
        }
    }
}

/// The root of `m`, with derivative `d`, between `low` and `high` where the values differ in sign.
pub(crate) fn root(m: &Series, d: &Series, low: f64, high: f64, f_low: f64, f_high: f64) -> f64 {
    let mut start = low - f_low * (high - low) / (f_high - f_low);
    if !(start > low && start < high) {
        start = 0.5 * (low + high);
    }
    // Round-off of z is that of the interval [-1, 1].
    newton(
        [low, high],
        start,
        f_low > 0.0,
        |_| 2.0 * f64::EPSILON,
        |z| value_and_slope(m, d, z),
    )
}

/// First instant in `[low, high]` at which `m - level` (powers) comes from 0 or below to above 0;
/// `turns` are its extrema in between, in ascending order.
pub(crate) fn first_rise(m: &Series, turns: &[f64], low: f64, high: f64) -> Option<f64> {
    let mut a = low;
    let mut fa = value(m, a);
    for b in turns.iter().copied().chain(std::iter::once(high)) {
        let fb = value(m, b);
        if fb > 0.0 {
            if fa <= 0.0 {
                return Some(if fa == 0.0 {
                    a
                } else {
                    root(m, &power_derivative(m), a, b, fa, fb)
                });
            }
            // Already beyond and going on: it switches at once.
            if fb > fa {
                return Some(a);
            }
        }
        (a, fa) = (b, fb);
    }
    None
}

/// An output over one step: its Chebyshev coefficients, and what follows from them if somebody asks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve {
    c: Series,
    powers: Option<Series>,
    turns: Option<Roots>,
}

impl Curve {
    /// A curve from its Chebyshev coefficients.
    pub fn new(c: Series) -> Self {
        Self {
            c,
            powers: None,
            turns: None,
        }
    }

    /// Chebyshev coefficients.
    pub fn coefficients(&self) -> &Series {
        &self.c
    }

    /// Smallest and largest value that the curve could have on the whole step.
    pub fn bounds(&self) -> [f64; 2] {
        let reach = spread(&self.c);
        [self.c[0] - reach, self.c[0] + reach]
    }

    /// Coefficients of its powers.
    pub fn powers(&mut self) -> &Series {
        self.powers.get_or_insert_with(|| to_powers(&self.c))
    }

    /// Extrema between -1 and `end`, which is the same at each call.
    pub fn turns(&mut self, end: f64) -> &Roots {
        let c = &self.c;
        let powers = self.powers.get_or_insert_with(|| to_powers(c));
        self.turns.get_or_insert_with(|| {
            let d = derivative(c);
            if d[0].abs() > spread(&d) {
                Roots::NONE
            } else {
                Roots::of(&power_derivative(powers), -1.0, end)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interpolate(f: impl Fn(f64) -> f64) -> Series {
        let mut c = [0.0; TERMS];
        for z in NODES {
            for (value, t) in c.iter_mut().zip(chebyshev(z)) {
                *value += f(z) * t * 2.0 / TERMS as f64;
            }
        }
        c[0] *= 0.5;
        c
    }

    #[test]
    fn finds_every_zero_of_a_wave() {
        // Slow enough for a series of this length to carry it to round-off.
        let c = interpolate(|z| libm::sin(4.0 * z + 0.3));
        let m = to_powers(&c);
        let found = Roots::of(&m, -1.0, 1.0);
        let exact: Vec<f64> = (-1..=1)
            .map(|k| (f64::from(k) * std::f64::consts::PI - 0.3) / 4.0)
            .filter(|z| z.abs() <= 1.0)
            .collect();
        assert_eq!(found.as_slice().len(), exact.len());
        for (a, b) in found.as_slice().iter().zip(&exact) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }

    #[test]
    fn a_narrow_double_crossing_is_not_missed() {
        // Above zero only between 0.3 and 0.3 + 2e-6.
        let f = |z: f64| -(z - 0.3) * (z - 0.300_002) * (z + 2.0);
        let m = to_powers(&interpolate(f));
        let turns = Roots::of(&power_derivative(&m), -1.0, 1.0);
        let at = first_rise(&m, turns.as_slice(), -1.0, 1.0).unwrap();
        assert!((at - 0.3).abs() < 1e-8, "{at}");
    }
}
