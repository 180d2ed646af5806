//! Numbers that are the same in every run.

/// `SplitMix64` (Steele, Lea & Flood 2014): a stream of numbers that its start decides.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The stream of one execution of a run: streams of other executions, and of other seeds, have
    /// nothing in common with it.
    pub fn of(seed: u64, execution: u64) -> Self {
        let mut of_seed = Self(seed);
        let start = of_seed.next();
        Self(start ^ execution.wrapping_mul(0xD134_2543_DE82_EF95))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number below a limit; 0 when the limit is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }

    /// True once in so many times.
    pub fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    /// A byte.
    pub fn byte(&mut self) -> u8 {
        (self.next() >> 56) as u8
    }

    /// One of several; none of nothing.
    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> Option<&'a T> {
        from.get(self.below(from.len()))
    }

    /// A number that is small most of the time: 1, 2, 4, … up to 2^`doublings`, and less.
    pub fn length(&mut self, doublings: usize) -> usize {
        let most = 1 << self.below(doublings + 1);
        1 + self.below(most)
    }
}
