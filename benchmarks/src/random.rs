//! A fixed stream of numbers, so that every run measures the same work.

/// `SplitMix64` (Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A stream that `seed` determines.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform between `low` and `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        low + (high - low) * ((z >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// Components uniform in (-`size`, `size`).
    pub fn values<const N: usize>(&mut self, size: f64) -> [f64; N] {
        [0; N].map(|_| self.between(-size, size))
    }
}
