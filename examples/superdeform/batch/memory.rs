//! How much memory a batch may take, and who waits for it.

use std::sync::{Condvar, Mutex, PoisonError};
use sysinfo::System;

/// What a run takes beside its file, in bytes: Seen: 60 to 80 MB for files of 1 to 5 MB.
const SMALL_RUN: u64 = 100 << 20;

/// What it takes for each byte of its file: Seen: 317 MB for a file of 40 MB, of which SMALL_RUN is a part; textures are
/// unpacked to find irises and brows.
const PER_BYTE: u64 = 10;

/// The share of what is free that a batch takes.
const SHARE: f64 = 0.75;

/// Memory that runs share, in bytes.
pub struct Memory {
    whole: u64,
    free: Mutex<u64>,
    given_back: Condvar,
}

/// Memory that one run has been given; given back when it is dropped.
pub struct Part<'a> {
    memory: &'a Memory,
    size: u64,
}

impl Memory {
    /// As many bytes as given; otherwise a share of what the system says is free.
    pub fn of(given: Option<u64>) -> Self {
        let whole = given.unwrap_or_else(|| (SHARE * free_memory() as f64) as u64);
        Self { whole, free: Mutex::new(whole), given_back: Condvar::new() }
    }

    /// Waits until there is enough for a file of `size` bytes. One that needs more than there is in all waits until it is
    /// alone.
    pub fn take(&self, size: u64) -> Part<'_> {
        let size = SMALL_RUN.saturating_add(PER_BYTE.saturating_mul(size)).min(self.whole);
        let free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let enough = self.given_back.wait_while(free, |free| *free < size);
        *enough.unwrap_or_else(PoisonError::into_inner) -= size;
        Part { memory: self, size }
    }
}

impl Drop for Part<'_> {
    fn drop(&mut self) {
        *self.memory.free.lock().unwrap_or_else(PoisonError::into_inner) += self.size;
        self.memory.given_back.notify_all();
    }
}

/// In bytes, within the limits of the container that this runs in; plenty where the system does not say.
fn free_memory() -> u64 {
    let mut system = System::new();
    system.refresh_memory();
    let free = match system.available_memory() {
        0 => u64::MAX / 2,
        free => free,
    };
    system.cgroup_limits().map_or(free, |limits| free.min(limits.free_memory))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn no_more_is_given_than_there_is_and_a_giant_runs_alone() {
        let memory = Memory::of(Some(3 * SMALL_RUN));
        let (taken, most, giants) = (AtomicU64::new(0), AtomicU64::new(0), AtomicU64::new(0));
        std::thread::scope(|scope| {
            for index in 0..12 {
                let (memory, taken, most, giants) = (&memory, &taken, &most, &giants);
                scope.spawn(move || {
                    let giant = index % 4 == 3;
                    let part = memory.take(if giant { 1 << 40 } else { 0 });
                    let now = taken.fetch_add(part.size, Ordering::SeqCst) + part.size;
                    most.fetch_max(now, Ordering::SeqCst);
                    giants.fetch_add(u64::from(giant), Ordering::SeqCst);
                    std::thread::sleep(std::time::Duration::from_millis(5));
                    taken.fetch_sub(part.size, Ordering::SeqCst);
                });
            }
        });
        assert!(most.load(Ordering::SeqCst) <= memory.whole);
        assert_eq!(giants.load(Ordering::SeqCst), 3);
        assert_eq!(*memory.free.lock().unwrap(), memory.whole);
    }

    #[test]
    fn the_system_says_how_much_is_free() {
        let free = free_memory();
        assert!(free > SMALL_RUN, "{free} bytes are free");
    }
}
