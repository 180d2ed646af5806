//! What a run took: time and bytes by phase, memory by rank.

use std::fmt::Write as _;
use std::time::Duration;

use crate::foreign::{ForeignError, World};

/// Parts of the work of the ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Rows of a new pattern.
    Pattern,
    /// Values of a matrix, gathered by rows and sent.
    Values,
    /// Factors or grids.
    SetUp,
    /// Solutions, with their right-hand sides.
    Solution,
}

/// Calls, time and bytes of each phase, as rank 0 sees them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Phases([(usize, Duration, usize); 4]);

impl Phases {
    pub(crate) fn add(&mut self, phase: Phase, time: Duration, bytes: usize) {
        let own = &mut self.0[phase as usize];
        *own = (own.0 + 1, own.1 + time, own.2 + bytes);
    }

    /// Whether there was any work.
    pub(crate) fn is_used(&self) -> bool {
        self.0.iter().any(|own| own.0 > 0)
    }

    /// A table; `whole` is the time of the run.
    fn table(&self, whole: Duration) -> String {
        let names = ["pattern", "values", "factors or grids", "solutions"];
        let mut text = format!(
            "{:<34}{:>8}{:>12}{:>12}\n",
            "phase", "times", "s", "MiB sent"
        );
        let mut rest = whole;
        for (name, (times, time, bytes)) in names.iter().zip(self.0) {
            rest = rest.saturating_sub(time);
            let (seconds, sent) = (time.as_secs_f64(), mebibytes(bytes as f64));
            let _ = writeln!(text, "{name:<34}{times:>8}{seconds:>12.3}{sent:>12.1}");
        }
        let rest = rest.as_secs_f64();
        let _ = writeln!(
            text,
            "{:<34}{:>8}{rest:>12.3}{:>12}",
            "assembly, particles, files", "", ""
        );
        text
    }
}

/// What a rank used.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RankReport {
    machine: String,
    /// Largest memory of the process \[bytes\].
    peak: u64,
    /// Most memory of MUMPS \[MB\].
    mumps: u64,
}

impl RankReport {
    pub(crate) fn of_this(world: &World, mumps: i32) -> Result<Self, ForeignError> {
        Ok(Self {
            machine: world.machine()?,
            peak: kibibytes("/proc/self/status", "VmHWM:") << 10,
            mumps: u64::try_from(mumps).unwrap_or(0),
        })
    }

    pub(crate) fn send(&self, world: &World) -> Result<(), ForeignError> {
        world.send_list(0, &[self.peak, self.mumps])?;
        world.send_list(0, self.machine.as_bytes())?;
        Ok(())
    }

    pub(crate) fn receive(world: &World, rank: usize) -> Result<Self, ForeignError> {
        let numbers: Vec<u64> = world.receive_list(rank)?;
        let machine: Vec<u8> = world.receive_list(rank)?;
        Ok(Self {
            machine: String::from_utf8_lossy(&machine).into_owned(),
            peak: numbers.first().copied().unwrap_or(0),
            mumps: numbers.get(1).copied().unwrap_or(0),
        })
    }
}

/// What a run took, in tables.
pub(crate) fn tables(phases: &Phases, ranks: &[RankReport], whole: Duration) -> String {
    let mut text = phases.table(whole);
    let _ = writeln!(
        text,
        "{:<6}{:<28}{:>12}{:>20}",
        "rank", "computer", "peak MiB", "of it MUMPS, MB"
    );
    for (rank, own) in ranks.iter().enumerate() {
        let (machine, peak, mumps) = (&own.machine, mebibytes(own.peak as f64), own.mumps);
        let _ = writeln!(text, "{rank:<6}{machine:<28}{peak:>12.0}{mumps:>20}");
    }
    text
}

fn mebibytes(bytes: f64) -> f64 {
    bytes / 1_048_576.0
}

/// A line of a file of the system, `NAME: number kB`; zero where there is none.
fn kibibytes(path: &str, name: &str) -> u64 {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(name));
    let number = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
    number.unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: calls, time and bytes are summed, and what is left of the run is told.
    #[test]
    fn phases_are_summed() {
        let mut phases = Phases::default();
        for _ in 0..2 {
            phases.add(Phase::SetUp, Duration::from_millis(1500), 3 << 20);
        }
        let text = phases.table(Duration::from_secs(4));
        let line = |start: &str| {
            let mut lines = text.lines();
            let line = lines.find(|line| line.starts_with(start)).unwrap();
            line[34..].split_whitespace().collect::<Vec<_>>().join(" ")
        };
        assert_eq!(line("factors"), "2 3.000 6.0");
        assert_eq!(line("assembly"), "1.000");
    }
}
