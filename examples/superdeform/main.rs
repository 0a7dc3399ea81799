//! A host like any other, and the first thing to run: a GLB or VRM in, its super-deformed version out.
//!
//!     cargo run --release --example superdeform
//!     cargo run --release --example superdeform -- TARGET REFERENCE -o OUT.glb
//!     cargo run --release --example superdeform -- batch FOLDER --style sd2.5 -o RESULTS

mod batch;
mod cli;
mod faults;
mod input;
mod output;
mod picture;
mod progress;
mod report;
mod run;
mod samples;
mod sheet;
mod words;

use cli::Refusal;
use cli::batch::Batch;
use faults::without_panic;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

/// Exit code for bad input and for faults of the program itself.
const BAD_INPUT: u8 = 1;
/// Exit code for wrong usage.
const WRONG_USAGE: u8 = 2;

fn main() -> ExitCode {
    let words: Vec<OsString> = std::env::args_os().collect();
    if words.get(1).is_some_and(|word| word == "batch") {
        return many(words);
    }
    if let Some(page) = cli::pages::page(&words) {
        return match page {
            Ok(page) => {
                print(&page);
                ExitCode::SUCCESS
            }
            Err(refusal) => refused(refusal),
        };
    }
    let command = match cli::parse(words) {
        Ok(command) => command,
        Err(refusal) => return refused(refusal),
    };
    match without_panic(|| run::run(&command)) {
        Ok(done) => {
            if !command.quiet {
                // What went wrong stands above where to look, on a terminal.
                tell(&report::notes(&done.report.warnings, command.verbose));
                print(report::summary(&done.report, &done.files));
            }
            ExitCode::SUCCESS
        }
        Err(sentence) => fail(BAD_INPUT, &sentence),
    }
}

/// Converts a batch.
fn many(words: Vec<OsString>) -> ExitCode {
    let batch = match Batch::parse_from_words(words) {
        Ok(batch) => batch,
        Err(refusal) => return refused(refusal),
    };
    match without_panic(|| batch::run(&batch)) {
        Ok(outcome) => {
            if !batch.settings.quiet {
                outcome.left_out.iter().for_each(|sentence| tell(&format!("{sentence}\n")));
                print(&outcome.table);
            }
            if outcome.failures.is_empty() {
                return ExitCode::SUCCESS;
            }
            let (failed, count) = (outcome.failures.len(), outcome.count);
            let list = outcome.failures.join("\n");
            fail(BAD_INPUT, &format!("{failed} of {count} files were not converted:\n{list}"))
        }
        Err(sentence) => fail(BAD_INPUT, &sentence),
    }
}

fn refused(refusal: Refusal) -> ExitCode {
    match refusal {
        Refusal::Answer(text) => {
            print(&text);
            ExitCode::SUCCESS
        }
        Refusal::Usage(text) => fail(WRONG_USAGE, &text),
        Refusal::Input(text) => fail(BAD_INPUT, &text),
    }
}

fn fail(code: u8, sentence: &str) -> ExitCode {
    tell(&format!("error: {sentence}\n"));
    ExitCode::from(code)
}

fn tell(text: &str) {
    // Nothing is left to tell where even standard error is closed.
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Prints; a reader that has gone away (`| head`) is no error.
fn print(text: impl AsRef<[u8]>) {
    let _ = std::io::stdout().write_all(text.as_ref());
}
