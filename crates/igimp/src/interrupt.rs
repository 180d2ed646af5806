//! Ctrl-C, the request to end, and the terminal that is closed: the first signal lets the run end after
//! its step, with everything saved; a later one ends it at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::output;

/// Exit code of a program that was interrupted, as shells have it: 128 + SIGINT.
const AT_ONCE: i32 = 130;
/// Signals so soon after the first belong to it: a terminal that is closed, and a system that is shut
/// down, send several.
const TOGETHER: Duration = Duration::from_millis(500);

/// A flag that becomes true at SIGINT, SIGTERM and SIGHUP.
pub(crate) fn watch() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let mut first: Option<Instant> = None;
    let handler = move || match first {
        Some(first) if first.elapsed() > TOGETHER => std::process::exit(AT_ONCE),
        Some(_) => {}
        None => {
            first = Some(Instant::now());
            raised.store(true, Ordering::SeqCst);
            output::print_message("\nfinishing the step; press again to stop at once");
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        output::print_message(&format!(
            "warning: Ctrl-C will stop the run at once, without saving: {error}"
        ));
    }
    flag
}
