//! How many threads may be asked for.

use std::num::NonZero;
use std::thread::available_parallelism;

/// Most threads on a computer with fewer cores: each costs memory, and more than cores are of no use.
const MOST: usize = 512;

/// Why so many threads are refused; none where they are not.
#[must_use]
pub fn refusal(threads: usize) -> Option<String> {
    let cores = available_parallelism().map_or(1, NonZero::get);
    let most = MOST.max(cores);
    let plural = if cores == 1 { "" } else { "s" };
    (threads > most).then(|| {
        format!(
            "{threads} threads are too many: at most {most}, this computer has {cores} core{plural}"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: a number of threads that no computer uses is refused with the number of cores. CASE: a few, as many as there are cores, and
    /// 100000. ORACLE: the cores that the system tells.
    #[test]
    fn threads_have_a_bound() {
        let cores = available_parallelism().unwrap().get();
        for threads in [1, cores, MOST] {
            assert_eq!(refusal(threads), None);
        }
        let text = refusal(100_000).unwrap();
        assert!(
            text.contains(&format!("this computer has {cores} core")),
            "{text}"
        );
    }
}
