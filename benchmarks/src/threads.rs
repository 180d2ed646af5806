//! Pools of threads: the same work on one thread and on several.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::BenchResult;

/// The numbers of threads to compare: one, and as many as rayon uses when nothing is said
/// (`RAYON_NUM_THREADS`, or all cores).
pub fn counts() -> Vec<usize> {
    match rayon::current_num_threads() {
        1 => vec![1],
        several => vec![1, several],
    }
}

/// A pool of so many threads.
///
/// # Errors
/// When the system grants no threads.
pub fn pool(threads: usize) -> BenchResult<ThreadPool> {
    Ok(ThreadPoolBuilder::new().num_threads(threads).build()?)
}

/// The number in the name of a bench: `1-thread`, `2-threads`.
pub fn name(threads: usize) -> String {
    let plural = if threads == 1 { "" } else { "s" };
    format!("{threads}-thread{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pools_have_the_threads_that_were_asked_for() {
        let threads = pool(3).unwrap().install(rayon::current_num_threads);
        assert_eq!(threads, 3);
    }

    #[test]
    fn one_thread_comes_first() {
        assert_eq!(counts()[0], 1);
        assert_eq!([1, 2].map(name), ["1-thread", "2-threads"]);
    }
}
