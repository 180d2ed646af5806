//! The memory that a run can have at all: beyond it the system ends a program without a word.

use igimp_model::{Case, meshes};

use super::readable;
use crate::error::EstimateError;

/// An estimate is trusted to this factor: a run that is thought to need more than so many times what
/// can be had is not begun \[-\].
const TRUST: f64 = 1.5;

/// A bound of the memory of this process, and who sets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limit {
    pub(crate) bytes: f64,
    pub(crate) by: &'static str,
}

/// Refuses a run that cannot have the memory that it needs; of a study of the mesh error, its largest
/// mesh. Nobody knows what a given solver needs, and where.
///
/// # Errors
/// [`EstimateError::Memory`]; those of [`estimate`](super::estimate()).
pub fn refuse_beyond<const D: usize>(case: &Case<D>) -> Result<(), EstimateError> {
    let Some(limit) = limit().filter(|_| case.given_solver.is_none()) else {
        return Ok(());
    };
    for mesh in meshes::meshes(case) {
        check(super::estimate(&mesh)?.bytes, limit)?;
    }
    Ok(())
}

fn check(needed: f64, limit: Limit) -> Result<(), EstimateError> {
    if needed <= TRUST * limit.bytes {
        return Ok(());
    }
    Err(EstimateError::Memory {
        needed: readable(needed),
        limit: readable(limit.bytes),
        by: limit.by,
    })
}

/// The smallest bound that the system tells of and that stays as long as the program runs, without swap.
pub(crate) fn lasting_limit() -> Option<Limit> {
    let space = || {
        let bytes = soft_limit(&read("/proc/self/limits")?, "Max address space")?;
        let by = "the limit of the address space (ulimit -v)";
        Some(Limit { bytes, by })
    };
    let computer = || {
        let bytes = kibibytes(&read("/proc/meminfo")?, "MemTotal:")?;
        let by = "what the computer has";
        Some(Limit { bytes, by })
    };
    smallest([space(), of_group(), computer()])
}

/// The smallest bound that the system tells of.
fn limit() -> Option<Limit> {
    let space = || {
        let all = soft_limit(&read("/proc/self/limits")?, "Max address space")?;
        let used = kibibytes(&read("/proc/self/status")?, "VmSize:")?;
        Some(Limit {
            bytes: (all - used).max(0.0),
            by: "the limit of the address space (ulimit -v)",
        })
    };
    let computer = || {
        let text = read("/proc/meminfo")?;
        let [memory, swap] = ["MemTotal:", "SwapTotal:"].map(|name| kibibytes(&text, name));
        Some(Limit {
            bytes: memory? + swap.unwrap_or(0.0),
            by: "all that the computer has",
        })
    };
    smallest([space(), of_group(), computer()])
}

/// That of the control group.
fn of_group() -> Option<Limit> {
    Some(Limit {
        bytes: read("/sys/fs/cgroup/memory.max")?.trim().parse().ok()?,
        by: "the limit of the control group",
    })
}

fn smallest(limits: [Option<Limit>; 3]) -> Option<Limit> {
    let smaller = |a: &Limit, b: &Limit| a.bytes.total_cmp(&b.bytes);
    limits.into_iter().flatten().min_by(smaller)
}

fn read(path: &str) -> Option<String> {
    std::fs::read_to_string(path).ok()
}

/// The soft limit of a name in `/proc/self/limits` \[bytes\]; none when it is unlimited.
fn soft_limit(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find(|line| line.starts_with(name))?;
    line.strip_prefix(name)?
        .split_whitespace()
        .next()?
        .parse()
        .ok()
}

/// A line of `NAME: number kB` \[bytes\].
fn kibibytes(text: &str, name: &str) -> Option<f64> {
    let line = text.lines().find(|line| line.starts_with(name))?;
    let kibibytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024.0 * kibibytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_as_the_system_writes_them() {
        let limits = "Limit                     Soft Limit           Hard Limit           Units\n\
            Max processes             127000               127000               processes\n\
            Max address space         409600000            unlimited            bytes\n";
        assert_eq!(soft_limit(limits, "Max address space"), Some(409_600_000.0));
        let unlimited = limits.replace("409600000", "unlimited");
        assert_eq!(soft_limit(&unlimited, "Max address space"), None);
        assert_eq!(
            kibibytes("VmPeak:  20 kB\nVmSize:  10 kB\n", "VmSize:"),
            Some(10_240.0)
        );
    }

    #[test]
    fn memory_that_cannot_fit_names_its_bound() {
        let limit = Limit {
            bytes: 4e8,
            by: "the limit of the address space (ulimit -v)",
        };
        check(5.9e8, limit).unwrap();
        insta::assert_snapshot!(
            check(3.2e9, limit).unwrap_err(),
            @"the run is thought to need 3.0 GiB of memory, and 390 MiB can be had, the limit of the address space (ulimit -v); a larger cell, fewer points per cell or fewer threads need less"
        );
    }
}
