//! Ctrl-C: the first one lets the run end after its step, the second ends it at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::output;

/// Exit code of a program that was interrupted, as shells have it: 128 + SIGINT.
const AT_ONCE: i32 = 130;

/// A flag that becomes true at Ctrl-C.
pub(crate) fn watch() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let handler = move || {
        if raised.swap(true, Ordering::SeqCst) {
            std::process::exit(AT_ONCE);
        }
        output::complain("\nfinishing the step; press again to stop at once");
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        output::complain(&format!(
            "warning: Ctrl-C will stop the run at once, without saving: {error}"
        ));
    }
    flag
}
