//! Work shared out among threads. Every item is made by itself, so results do not depend on how many there are.

use crate::options::table::MOST_THREADS;
use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, LocalKey};

/// The name of every thread that this module starts.
pub const WORKER: &str = "superdeform";

/// Fewer vertices or triangles than this are not worth a thread. It changes time alone.
pub const FEW: usize = 8000;
/// Fewer points than this are not worth a thread where each looks for the nearest of a surface, or casts rays. It
/// changes time alone.
pub const FEW_RAYS: usize = 200;

/// A host's own way to run tasks beside each other, such as an engine's job system.
pub trait Jobs {
    /// Runs `task` of every index below `count`, on whichever threads, and waits for all of them.
    fn run(&self, count: usize, task: &(dyn Fn(usize) + Sync));
}

thread_local! {
    /// This thread starts no others.
    static ALONE: Cell<bool> = const { Cell::new(false) };
    /// This thread is in a task of [`Jobs`].
    static IN_TASK: Cell<bool> = const { Cell::new(false) };
    /// What runs this thread's tasks in place of threads that are started for them.
    static JOBS: RefCell<Option<Rc<dyn Jobs>>> = const { RefCell::new(None) };
}

/// Runs `work` while `flag` is set.
fn within<T>(flag: &'static LocalKey<Cell<bool>>, work: impl FnOnce() -> T) -> T {
    struct Before(&'static LocalKey<Cell<bool>>, bool);
    impl Drop for Before {
        fn drop(&mut self) {
            self.0.set(self.1);
        }
    }
    let _before = Before(flag, flag.replace(true));
    work()
}

/// Runs `work` on this thread alone: where there is no memory for the stacks of others.
pub(crate) fn alone<T>(work: impl FnOnce() -> T) -> T {
    within(&ALONE, work)
}

/// Has this thread's tasks run by `jobs` from now on; `None`: by threads that are started for them.
pub(crate) fn set_jobs(jobs: Option<Rc<dyn Jobs>>) {
    JOBS.set(jobs);
}

/// What runs this thread's tasks, where it is not to work alone.
pub(crate) fn jobs() -> Option<Rc<dyn Jobs>> {
    if ALONE.get() { None } else { JOBS.with_borrow(Clone::clone) }
}

/// True where this thread works for another one.
pub(crate) fn is_worker() -> bool {
    IN_TASK.try_with(Cell::get).unwrap_or(false) || std::thread::current().name() == Some(WORKER)
}

/// The number of threads that `asked` stands for: 0 means all cores.
pub fn thread_count(asked: usize) -> usize {
    if ALONE.get() {
        1
    } else if asked == 0 {
        std::thread::available_parallelism().map_or(1, usize::from)
    } else {
        asked.min(MOST_THREADS as usize)
    }
}

/// Into how many shares `count` items are worth being cut, of which fewer than `least` are not worth a thread.
fn share_count(threads: usize, count: usize, least: usize) -> usize {
    // The system takes longer to say how many cores it has than a small work takes.
    match count / least {
        0 | 1 => 1,
        most => most.min(thread_count(threads)),
    }
}

/// What `mutex` holds, for this thread alone; as another one left it, where that one's work ended in a panic.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
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
    let share_count = share_count(threads, count, least);
    let share = count.div_ceil(share_count).max(1);
    let run = |first: usize| {
        let mut state = start();
        (first..(first + share).min(count)).map(|index| make(&mut state, index)).collect()
    };
    if share_count == 1 {
        return run(0);
    }
    let mut all = Vec::with_capacity(count);
    of_tasks(count.div_ceil(share), |index| run(index * share)).for_each(|share: Vec<T>| all.extend(share));
    all
}

/// Does `work` for shares of `count` items, each with its part of `place`, side by side where there is enough to do.
///
/// - `room`: what it works in, where there is one share; each of several gets its own.
/// - `cut`: a place for so many items, and for those after them.
pub fn in_shares<R: Default, P: Send>(
    threads: usize,
    count: usize,
    least: usize,
    room: &mut R,
    mut place: P,
    cut: impl Fn(P, usize) -> (P, P),
    work: impl Fn(&mut R, Range<usize>, P) + Sync,
) {
    let share = count.div_ceil(share_count(threads, count, least));
    let mut shares = Vec::new();
    let mut first = 0;
    while first + share < count {
        let (of_share, rest) = cut(place, share);
        shares.push(Mutex::new(Some((first..first + share, of_share))));
        (first, place) = (first + share, rest);
    }
    if shares.is_empty() {
        return work(room, 0..count, place);
    }
    shares.push(Mutex::new(Some((first..count, place))));
    collect(threads, shares.len(), 1, |index| {
        let share = lock(&shares[index]).take();
        if let Some((items, place)) = share {
            work(&mut R::default(), items, place);
        }
    });
}

/// `make` of every index below `count`, in order, each as a task of its own. What nobody did is done here; what a host's jobs do
/// twice, once.
fn of_tasks<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync) -> impl Iterator<Item = T> {
    let places: Vec<Mutex<Option<std::thread::Result<T>>>> = (0..count).map(|_| Mutex::new(None)).collect();
    run(count, &|index| {
        let Some(place) = places.get(index) else { return };
        // No panic leaves a task.
        lock(place).get_or_insert_with(|| catch_unwind(AssertUnwindSafe(|| make(index))));
    });
    places.into_iter().enumerate().map(move |(index, place)| {
        let made = place.into_inner().unwrap_or_else(PoisonError::into_inner);
        made.map_or_else(|| make(index), |made| made.unwrap_or_else(|panic| resume_unwind(panic)))
    })
}

/// Runs `task` of every index below `count` by the host's jobs, else on threads, the first on this one; what the system starts no
/// thread for is left out: sandboxes and limits may forbid it.
fn run(count: usize, task: &(dyn Fn(usize) + Sync)) {
    match jobs() {
        // The host's threads are its own: a task uses no others.
        Some(jobs) => jobs.run(count, &|index| within(&IN_TASK, || alone(|| task(index)))),
        None => std::thread::scope(|scope| {
            for index in 1..count {
                let _ = worker().spawn_scoped(scope, move || task(index));
            }
            task(0);
        }),
    }
}

fn worker() -> Builder {
    Builder::new().name(WORKER.to_string())
}

/// Both results, made side by side where there are two threads to use and they are the library's own.
pub fn both<A: Send, B>(threads: usize, one: impl Fn() -> A + Sync, other: impl FnOnce() -> B) -> (A, B) {
    if thread_count(threads) == 1 || jobs().is_some() {
        return (one(), other());
    }
    std::thread::scope(|scope| {
        let thread = worker().spawn_scoped(scope, &one);
        let other = other();
        let one = match thread {
            Ok(thread) => thread.join().unwrap_or_else(|panic| resume_unwind(panic)),
            Err(_) => one(),
        };
        (one, other)
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

    /// A host that runs tasks backwards, each as often as it is told.
    struct Backwards(usize);

    impl Jobs for Backwards {
        fn run(&self, count: usize, task: &(dyn Fn(usize) + Sync)) {
            // Beyond the last one too, as no host should.
            (0..=count).rev().for_each(|index| (0..self.0).for_each(|_| task(index)));
        }
    }

    #[test]
    fn jobs_of_a_host_make_the_same_whether_it_runs_each_once_twice_or_not_at_all() {
        for times in 0..3 {
            set_jobs(Some(Rc::new(Backwards(times))));
            let here = std::thread::current().id();
            let make = |index: usize| (index * index, std::thread::current().id(), is_worker());
            let made = collect(4, 100, 1, make);
            let expected: Vec<_> = (0..100).map(|index| (index * index, here, times > 0)).collect();
            assert_eq!(made, expected);
            // A task starts none of its own, and shares none out.
            let inner = collect(4, 4, 1, |_| collect(4, 4, 1, |_| std::thread::current().id()));
            assert!(inner.iter().flatten().all(|&thread| thread == here));
            assert_eq!(both(4, || std::thread::current().id(), || 2), (here, 2));
            let panics = catch_unwind(|| collect(4, 10, 1, |index| assert_ne!(index, 9)));
            assert!(panics.is_err() && !is_worker());
            set_jobs(None);
        }
        assert!(jobs().is_none());
    }

    #[test]
    fn two_things_are_made_side_by_side() {
        for threads in 0..3 {
            assert_eq!(both(threads, || "one", || 2), ("one", 2));
        }
    }

    #[test]
    fn a_panic_reaches_the_caller() {
        let made = catch_unwind(|| collect(2, 10, 1, |index| assert_ne!(index, 9)));
        assert!(made.is_err());
    }
}
