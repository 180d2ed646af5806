//! What goes on in the workers of a run: inputs that take too long, memory that grows too large.

use std::fs;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Memory beyond which a run is given up \[bytes\]; inputs have 64 KiB.
pub(crate) const MOST_MEMORY: u64 = 4 << 30;
/// Time after which an input counts as hanging.
pub(crate) const LONGEST: Duration = Duration::from_secs(60);

/// No execution.
const IDLE: u64 = u64::MAX;

/// What a worker does at present.
#[derive(Debug)]
pub(crate) struct Worker {
    execution: AtomicU64,
    since: Mutex<Instant>,
}

impl Worker {
    pub(crate) fn new() -> Self {
        Self {
            execution: AtomicU64::new(IDLE),
            since: Mutex::new(Instant::now()),
        }
    }

    /// It begins with an execution at a time.
    pub(crate) fn begin(&self, execution: u64, now: Instant) {
        if let Ok(mut since) = self.since.lock() {
            *since = now;
        }
        self.execution.store(execution, Ordering::Release);
    }

    /// It is done.
    pub(crate) fn end(&self) {
        self.execution.store(IDLE, Ordering::Release);
    }

    /// The execution that it is at.
    pub(crate) fn execution(&self) -> Option<u64> {
        let execution = self.execution.load(Ordering::Acquire);
        (execution != IDLE).then_some(execution)
    }

    /// The execution that it has been at for too long.
    pub(crate) fn hanging(&self) -> Option<u64> {
        let since = self.since.lock().ok()?;
        self.execution().filter(|_| since.elapsed() > LONGEST)
    }
}

/// Memory of this process now and at most \[bytes\]; none where the system does not say.
pub(crate) fn memory() -> Option<[u64; 2]> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let value = |key: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(key))?;
        let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
        Some(kibibytes << 10)
    };
    Some([value("VmRSS:")?, value("VmHWM:")?])
}
