//! Random numbers that are the same on every machine: SplitMix64 (Steele, Lea & Flood 2014).

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(crate) struct Random {
    state: u64,
}

impl Random {
    /// The stream of a number within a campaign of a seed: streams do not depend on how many there
    /// are.
    pub(crate) fn new(seed: u64, number: u64) -> Self {
        let mut mixed = Self { state: seed };
        let state = mixed
            .next()
            .wrapping_add(number.wrapping_mul(0xD1B5_4A32_D192_ED03));
        Self { state }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Its logarithm is uniform between those of `low` and `high`.
    pub(crate) fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    /// An integer from `low` to `high`, both included.
    pub(crate) fn integer(&mut self, low: usize, high: usize) -> usize {
        low + (self.unit() * (high - low + 1) as f64) as usize
    }

    /// True with a probability.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: numbers are those of the published algorithm and fill their ranges.
    /// ORACLE: first outputs of SplitMix64 for the state 1234567, as Vigna's reference code
    /// prints them; mean of the uniform distribution.
    #[test]
    fn the_stream_is_the_published_one() {
        let mut random = Random { state: 1_234_567 };
        assert_eq!(random.next(), 6_457_827_717_110_365_317);
        assert_eq!(random.next(), 3_203_168_211_198_807_973);
        let mean = (0..10_000).map(|_| random.uniform(-1.0, 3.0)).sum::<f64>() / 1e4;
        assert!((mean - 1.0).abs() < 0.05, "{mean}");
        assert!((0..1000).all(|_| (2..=4).contains(&random.integer(2, 4))));
        assert!((0..1000).all(|_| (1.0..1e3).contains(&random.log_uniform(1.0, 1e3))));
    }
}
