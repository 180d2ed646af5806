//! Memory of a run, as the system counts it for the process; nothing where it does not tell.

use igimp_results::summary::MemoryShare;

use crate::Estimate;

/// Resident memory at the beginning of a run \[MiB\].
#[derive(Clone, Copy, Debug)]
pub struct Before(Option<f64>);

impl Before {
    /// Reads it now.
    pub fn now() -> Self {
        Self(resident_mib("VmRSS:"))
    }

    /// The memory on top, shared among particles and unknowns as in the model of
    /// [`estimate`](fn@crate::estimate): one number is measured, and its split is the model's.
    pub fn share(self, peak_mib: Option<f64>, size: &Estimate) -> Option<MemoryShare> {
        let used = (peak_mib? - self.0?) * 1_048_576.0;
        let [particle, unknown] = size.per_item;
        let model = particle * size.particles as f64 + unknown * size.unknowns as f64;
        (used > 0.0 && size.unknowns > 0).then(|| MemoryShare {
            bytes_per_particle: particle * used / model,
            bytes_per_unknown: unknown * used / model,
        })
    }
}

/// Largest resident memory of this process so far \[MiB\].
pub fn peak_mib() -> Option<f64> {
    resident_mib("VmHWM:")
}

fn resident_mib(name: &str) -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(name))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate;
    use crate::tests::case;

    #[test]
    fn shares_add_up_to_what_was_used() {
        let size = estimate(&case()).unwrap();
        let share = Before(Some(10.0)).share(Some(34.0), &size).unwrap();
        let used = share.bytes_per_particle * size.particles as f64
            + share.bytes_per_unknown * size.unknowns as f64;
        assert!((used / 1_048_576.0 - 24.0).abs() < 1e-9);
        assert_eq!(Before(None).share(Some(34.0), &size), None);
        assert_eq!(Before(Some(10.0)).share(None, &size), None);
        assert_eq!(Before(Some(40.0)).share(Some(34.0), &size), None);
    }

    #[test]
    fn held_memory_is_at_most_the_peak() {
        let held = vec![1_u8; 1 << 20];
        if let (Some(now), Some(peak)) = (Before::now().0, peak_mib()) {
            assert!(now > 0.0 && now <= peak + 1.0, "{now} {peak}");
        }
        assert_eq!(held.len(), 1 << 20);
    }
}
