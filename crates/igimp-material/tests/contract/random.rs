//! A fixed stream of numbers, so that a failure can be met again.

/// `SplitMix64` (Steele, Lea & Flood 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in (-1, 1).
    pub(crate) fn symmetric(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Uniform between `low` and `high`.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (1.0 + self.symmetric())
    }

    /// Uniform in 0..n.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.next() >> 33).expect("31 bits") % n
    }

    /// Components uniform in (-size, size).
    pub(crate) fn values<const N: usize>(&mut self, size: f64) -> [f64; N] {
        [0; N].map(|_| size * self.symmetric())
    }

    /// A rotation, uniform over all rotations (unit quaternion by rejection).
    pub(crate) fn rotation(&mut self) -> [[f64; 3]; 3] {
        loop {
            let [w, x, y, z] = self.values(1.0);
            let square = w * w + x * x + y * y + z * z;
            if (0.01..1.0).contains(&square) {
                let s = 2.0 / square;
                return [
                    [
                        1.0 - s * (y * y + z * z),
                        s * (x * y - w * z),
                        s * (x * z + w * y),
                    ],
                    [
                        s * (x * y + w * z),
                        1.0 - s * (x * x + z * z),
                        s * (y * z - w * x),
                    ],
                    [
                        s * (x * z - w * y),
                        s * (y * z + w * x),
                        1.0 - s * (x * x + y * y),
                    ],
                ];
            }
        }
    }
}
