//! Stage names and a bar on standard error where it is a terminal; silence otherwise.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;

/// Shows which stage runs.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar of `stage_count` stages; hidden where `quiet`, or where standard error is no terminal.
    pub fn new(stage_count: u64, quiet: bool) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(stage_count), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:24} {pos}/{len} {msg}") {
            bar.set_style(style);
        }
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        Self { bar }
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
