//! Seeded random numbers, the same on every machine, where a bench or a test wants no more than uniform and normal
//! ones.

/// The increment of `SplitMix64`: 2^64 over the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// Spreads a number over all bits (finaliser of `SplitMix64`: Steele, Lea and Flood 2014).
fn spread(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The 53 upper bits as a number in 0 to 1.
fn share(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// The number at place `i` of one series that is evenly spread over 0 to 1 and without pattern: any place, in any
/// order.
pub(crate) fn dither(i: usize) -> f64 {
    share(spread((i as u64).wrapping_add(1).wrapping_mul(STEP)))
}

/// Uniform and normal numbers (xorshift64*, Box and Muller).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator; neighbouring seeds give unrelated numbers.
    pub fn new(seed: u64) -> Self {
        Self(spread(seed.wrapping_add(STEP)) | 1)
    }

    /// Uniform in 0 to 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        share(self.0.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    /// Uniform in `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A seed for another generator.
    pub fn seed(&mut self) -> u64 {
        (self.uniform() * (1_u64 << 53) as f64) as u64
    }

    /// Plus or minus one.
    pub fn sign(&mut self) -> f64 {
        if self.uniform() < 0.5 { -1.0 } else { 1.0 }
    }

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        (-2.0 * libm::log(1.0 - self.uniform())).sqrt()
            * libm::cos(std::f64::consts::TAU * self.uniform())
    }
}
