//! Whether a run kept to its estimate, and whether the computer has the memory for it.

use igimp_results::summary::Summary;

use super::{readable, time};

/// A run may cost this many times its estimate before anything is said \[-\].
const FACTOR: f64 = 1.5;
/// Nobody waits for less \[s\].
const LEAST_SECONDS: f64 = 10.0;
/// Nobody runs short of less \[MiB\].
const LEAST_MEMORY: f64 = 100.0;

/// The cost of a run beyond its estimate, in sentences. A run that took its time because the computer
/// was busy with other work is judged by the time of the processors.
pub fn exceeded(summary: &Summary) -> Vec<String> {
    let Some(expected) = &summary.estimate else {
        return Vec::new();
    };
    let mut remarks = Vec::new();
    let threads = expected.threads.max(1) as f64;
    let used = summary
        .cpu_seconds
        .map_or(summary.seconds, |cpu| cpu / threads);
    if used > FACTOR * expected.seconds && used - expected.seconds > LEAST_SECONDS {
        remarks.push(format!(
            "the run took {}, {:.1} times the estimate of {}: more steps were cut, or more corrections \
             needed, than is usual",
            time::readable(used),
            used / expected.seconds,
            time::readable(expected.seconds),
        ));
    }
    let bytes = expected.bytes.max(expected.most_bytes);
    let estimated = bytes / 1_048_576.0;
    if let Some(peak) = summary.peak_memory_mib
        && peak > FACTOR * estimated
        && peak - estimated > LEAST_MEMORY
    {
        remarks.push(format!(
            "the run needed {} of memory, {:.1} times the estimate of {}",
            readable(peak * 1_048_576.0),
            peak / estimated,
            readable(bytes),
        ));
    }
    remarks
}

/// Says so if a run will not fit into the memory that is available, or not if iterations are given up for factors: what it is
/// thought to need without and with those \[bytes\].
pub fn lacks_memory(bytes: f64, most_bytes: f64) -> Option<String> {
    let available = available()?;
    let (needed, when) = if bytes > available {
        (bytes, "")
    } else {
        (most_bytes, " where an iteration is given up for factors")
    };
    (needed > available).then(|| {
        format!(
            "the run is thought to need {} of memory{when}, and {} are available",
            readable(needed),
            readable(available)
        )
    })
}

/// How many runs that need so much memory each may go side by side on the threads of the current pool.
///
/// All have room, or they go one after another; and so they do within a pool that has other work, and
/// on one thread.
pub fn side_by_side(bytes: &[f64]) -> usize {
    let threads = rayon::current_num_threads();
    let all: f64 = bytes.iter().sum();
    if rayon::current_thread_index().is_some() || available().is_some_and(|free| all > free) {
        1
    } else {
        threads.min(bytes.len()).max(1)
    }
}

/// Memory that the system can give without swapping \[bytes\], where it tells.
pub fn available() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find(|line| line.starts_with("MemAvailable:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024.0 * kib)
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_results::summary::Expected;

    fn summary(cpu_seconds: f64, peak_memory_mib: f64) -> Summary {
        Summary {
            seconds: 1000.0,
            cpu_seconds: Some(cpu_seconds),
            peak_memory_mib: Some(peak_memory_mib),
            estimate: Some(Expected {
                seconds: 100.0,
                open_ended: false,
                threads: 2,
                bytes: 400.0 * 1_048_576.0,
                most_bytes: 400.0 * 1_048_576.0,
                seconds_of_steps_taken: None,
            }),
            ..Summary::default()
        }
    }

    #[test]
    fn a_run_within_its_estimate_is_not_spoken_of() {
        assert!(exceeded(&summary(280.0, 590.0)).is_empty());
        assert!(exceeded(&Summary::default()).is_empty());
    }

    #[test]
    fn a_run_beyond_its_estimate_is_reported() {
        insta::assert_snapshot!(exceeded(&summary(480.0, 800.0)).join("\n"), @r"
        the run took 4 min, 2.4 times the estimate of 2 min: more steps were cut, or more corrections needed, than is usual
        the run needed 800 MiB of memory, 2.0 times the estimate of 400 MiB
        ");
    }

    #[test]
    fn runs_go_side_by_side_if_all_have_room() {
        assert_eq!(side_by_side(&[]), 1);
        assert_eq!(side_by_side(&[1.0; 3]), rayon::current_num_threads().min(3));
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(4)
            .build()
            .unwrap();
        assert_eq!(pool.install(|| side_by_side(&[1.0; 3])), 1);
        if available().is_some() {
            assert_eq!(side_by_side(&[1e18, 1.0]), 1);
        }
    }

    #[test]
    fn a_run_beyond_all_memory_is_reported_beforehand() {
        if available().is_none() {
            println!("skipped: the system does not tell its memory");
            return;
        }
        assert_eq!(lacks_memory(1.0, 1.0), None);
        assert!(lacks_memory(1e18, 1e18).unwrap().contains("of memory, and"));
        assert!(
            lacks_memory(1.0, 1e18)
                .unwrap()
                .contains("for factors, and")
        );
    }
}
