//! Panics as sentences: a fault of the program ends one run like any other error.

use std::panic;
use std::sync::{Mutex, Once};

/// The first panic since the last that was told; others follow from it.
static FAULT: Mutex<Option<String>> = Mutex::new(None);

/// Runs `work`; a panic in it, or in a thread that it starts, becomes a sentence.
pub fn without_panic<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    static LISTENING: Once = Once::new();
    LISTENING.call_once(|| {
        panic::set_hook(Box::new(|info| {
            let place = info.location().map_or(String::new(), |place| format!(" at {place}"));
            let what = panic_text(info.payload()).replace('\n', " ");
            if let Ok(mut fault) = FAULT.lock() {
                fault.get_or_insert(format!("a fault in superdeform itself{place}: {what}"));
            }
        }));
    });
    panic::catch_unwind(panic::AssertUnwindSafe(work)).unwrap_or_else(|_| {
        let fault = FAULT.lock().ok().and_then(|mut fault| fault.take());
        Err(fault.unwrap_or_else(|| "a fault in superdeform itself".to_string()))
    })
}

fn panic_text(payload: &(dyn std::any::Any + Send)) -> &str {
    match (payload.downcast_ref::<String>(), payload.downcast_ref::<&str>()) {
        (Some(text), _) => text,
        (_, Some(text)) => text,
        _ => "unknown",
    }
}
