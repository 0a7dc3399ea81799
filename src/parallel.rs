//! Work shared out among threads. Every item is made by itself, so results do not depend on how many there are.

use std::cell::Cell;
use std::ops::Range;

/// The name of every thread that this module starts.
pub const WORKER: &str = "superdeform";

/// More threads than this are of no use, and tens of thousands are more than a system can start.
const MOST_THREADS: usize = 1024;

thread_local! {
    /// This thread starts no others.
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work` on this thread alone: where there is no memory for the stacks of others.
pub(crate) fn alone<T>(work: impl FnOnce() -> T) -> T {
    struct Before(bool);
    impl Drop for Before {
        fn drop(&mut self) {
            ALONE.set(self.0);
        }
    }
    let _before = Before(ALONE.replace(true));
    work()
}

/// The number of threads that `asked` stands for: 0 means all cores.
pub fn thread_count(asked: usize) -> usize {
    if ALONE.get() {
        1
    } else if asked == 0 {
        std::thread::available_parallelism().map_or(1, usize::from)
    } else {
        asked.min(MOST_THREADS)
    }
}

/// `make` of every index below `count`, in order.
///
/// - `threads`: at most this many, and at most 1024; 0 means all cores.
/// - `least`: fewer items than this are not worth a thread of their own, 1 or more.
///
/// The caller's thread does its share; alone it starts no other. A panic of `make` goes on in the caller.
pub fn collect<T: Send>(
    threads: usize,
    count: usize,
    least: usize,
    make: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    collect_with(threads, count, least, || (), |(), index| make(index))
}

/// As [`collect`], where each thread has something of its own at hand: a buffer, or a guess that only saves time.
pub fn collect_with<S, T: Send>(
    threads: usize,
    count: usize,
    least: usize,
    start: impl Fn() -> S + Sync,
    make: impl Fn(&mut S, usize) -> T + Sync,
) -> Vec<T> {
    // The system takes longer to say how many cores it has than a small work takes.
    let share_count = match count / least {
        0 | 1 => 1,
        most => most.min(thread_count(threads)),
    };
    let share = count.div_ceil(share_count).max(1);
    let run = |indices: Range<usize>, all: &mut Vec<T>| {
        let mut state = start();
        all.extend(indices.map(|index| make(&mut state, index)));
    };
    let mut all = Vec::with_capacity(count);
    if share_count == 1 {
        run(0..count, &mut all);
        return all;
    }
    std::thread::scope(|scope| {
        let run = &run;
        let work = move |first: usize| {
            let indices = first..(first + share).min(count);
            let mut all = Vec::with_capacity(indices.len());
            run(indices, &mut all);
            all
        };
        let others: Vec<_> =
            (share..count).step_by(share).map(|first| beside(scope, move || work(first))).collect();
        run(0..share.min(count), &mut all);
        for other in others {
            all.extend(other.join());
        }
    });
    all
}

/// Work that another thread does, or that is left for when it is asked for.
enum Beside<'scope, W, T> {
    Thread(std::thread::ScopedJoinHandle<'scope, T>),
    Left(W),
}

impl<W: FnOnce() -> T, T> Beside<'_, W, T> {
    /// What the work gives; a panic of it goes on here.
    fn join(self) -> T {
        match self {
            Self::Thread(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            Self::Left(work) => work(),
        }
    }
}

/// Has `work` done by a thread of its own, if the system starts one: sandboxes and limits may forbid it.
fn beside<'scope, T: Send + 'scope, W: Clone + FnOnce() -> T + Send + 'scope>(
    scope: &'scope std::thread::Scope<'scope, '_>,
    work: W,
) -> Beside<'scope, W, T> {
    let thread = std::thread::Builder::new().name(WORKER.to_string());
    match thread.spawn_scoped(scope, work.clone()) {
        Ok(thread) => Beside::Thread(thread),
        Err(_) => Beside::Left(work),
    }
}

/// Both results, made side by side where there are two threads to use.
pub fn both<A: Send, B>(threads: usize, one: impl Fn() -> A + Sync, other: impl FnOnce() -> B) -> (A, B) {
    if thread_count(threads) == 1 {
        return (one(), other());
    }
    std::thread::scope(|scope| {
        let one = beside(scope, &one);
        let other = other();
        (one.join(), other)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_threads_makes_the_same() {
        for count in [0, 1, 2, 7, 100] {
            let alone: Vec<usize> = (0..count).map(|index| index * index).collect();
            for threads in 0..=9 {
                for least in [1, 3, 1000] {
                    assert_eq!(collect(threads, count, least, |index| index * index), alone);
                }
            }
        }
    }

    #[test]
    fn two_things_are_made_side_by_side() {
        for threads in 0..3 {
            assert_eq!(both(threads, || "one", || 2), ("one", 2));
        }
    }

    #[test]
    fn a_panic_reaches_the_caller() {
        let made = std::panic::catch_unwind(|| collect(2, 10, 1, |index| assert_ne!(index, 9)));
        assert!(made.is_err());
    }
}
