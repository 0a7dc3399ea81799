//! A host like any other, and the first thing to run: a GLB or VRM in, its super-deformed version out.
//!
//!     cargo run --release --example superdeform
//!     cargo run --release --example superdeform -- TARGET REFERENCE -o OUT.glb

mod cli;
mod input;
mod output;
mod picture;
mod progress;
mod report;
mod run;
mod shades;
mod sheet;
mod words;

use cli::Refusal;
use std::io::Write;
use std::panic;
use std::process::ExitCode;
use std::sync::Mutex;

/// Exit code for bad input and for faults of the program itself.
const BAD_INPUT: u8 = 1;
/// Exit code for wrong usage.
const WRONG_USAGE: u8 = 2;

fn main() -> ExitCode {
    let command = match cli::parse(std::env::args_os()) {
        Ok(command) => command,
        Err(Refusal::Answer(text)) => {
            print(&text);
            return ExitCode::SUCCESS;
        }
        Err(Refusal::Usage(text)) => return fail(WRONG_USAGE, &text),
        Err(Refusal::Input(text)) => return fail(BAD_INPUT, &text),
    };
    match without_panic(|| run::run(&command)) {
        Ok(done) => {
            if !command.quiet {
                print(&report::summary(&done.report, &done.files));
            }
            ExitCode::SUCCESS
        }
        Err(sentence) => fail(BAD_INPUT, &sentence),
    }
}

/// Runs `work`; a panic becomes a sentence like any other error.
fn without_panic<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    static FAULT: Mutex<Option<String>> = Mutex::new(None);
    panic::set_hook(Box::new(|info| {
        let place = info.location().map_or(String::new(), |place| format!(" at {place}"));
        let what = panic_text(info.payload()).replace('\n', " ");
        if let Ok(mut fault) = FAULT.lock() {
            // The first panic is the cause; others follow from it.
            fault.get_or_insert(format!("a fault in superdeform itself{place}: {what}"));
        }
    }));
    let result = panic::catch_unwind(panic::AssertUnwindSafe(work));
    let _ = panic::take_hook();
    result.unwrap_or_else(|_| {
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

fn fail(code: u8, sentence: &str) -> ExitCode {
    // Nothing is left to tell where even standard error is closed.
    let _ = writeln!(std::io::stderr(), "error: {sentence}");
    ExitCode::from(code)
}

/// Prints; a reader that has gone away (`| head`) is no error.
fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
