//! What comes of an input.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use crate::targets::{Input, Target, Verdict};

/// What a reader makes of an input; a panic is a failure.
///
/// # Errors
/// What does not hold, or the words of the panic and where it was.
pub fn outcome(target: Target, input: &Input) -> Result<Verdict, String> {
    catch_unwind(AssertUnwindSafe(|| target.check(input))).unwrap_or_else(|payload| {
        let place = WORDS.with(RefCell::take);
        Err(format!("panic at {place}: {}", words_of(&*payload)))
    })
}

/// What a panic says.
fn words_of(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| payload.downcast_ref::<&str>().copied())
        .unwrap_or("no words")
}

thread_local! {
    /// Where the last panic of this thread was.
    static WORDS: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Panics of workers are caught and told in the report; nothing is printed.
pub(crate) fn catch_words() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        panic::set_hook(Box::new(|information| {
            let place = information.location().map(ToString::to_string);
            WORDS.with(|words| *words.borrow_mut() = place.unwrap_or_default());
        }));
    });
}
