//! Stage names, or files that are through, and a bar on standard error where it is a terminal; silence otherwise.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;

/// A bar that looks like `template`.
fn bar(count: u64, quiet: bool, template: &str) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(count), target);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    if !bar.is_hidden() {
        bar.enable_steady_tick(Duration::from_millis(100));
    }
    bar
}

/// Shows which stage runs.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar of `stage_count` stages; hidden where `quiet`, or where standard error is no terminal.
    pub fn new(stage_count: u64, quiet: bool) -> Self {
        Self { bar: bar(stage_count, quiet, "{bar:24} {pos}/{len} {msg}") }
    }

    /// Says that the stage `name` begins, and so that the one before it is done.
    pub fn stage(&self, name: &'static str) {
        if !self.bar.message().is_empty() {
            self.bar.inc(1);
        }
        self.bar.set_message(name);
    }
}

impl Drop for Progress {
    /// Takes the bar away, so that what is printed next stands alone, even after a panic.
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A bar over all files of a batch; a line for each on standard output.
pub struct Bar {
    bar: ProgressBar,
    quiet: bool,
}

impl Bar {
    /// A bar of `file_count` files; hidden as [`Progress`] is.
    pub fn new(file_count: u64, quiet: bool) -> Self {
        Self { bar: bar(file_count, quiet, "{bar:24} {pos}/{len} files, {eta} left"), quiet }
    }

    /// Says that one more file is through.
    pub fn line(&self, text: &str) {
        if !self.quiet {
            self.bar.suspend(|| crate::print(format!("{text}\n")));
        }
        self.bar.inc(1);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
