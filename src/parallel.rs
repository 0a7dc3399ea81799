//! Work shared out among threads. Every item is made by itself, so results do not depend on how many there are.

/// The number of threads that `asked` stands for: 0 means all cores.
pub fn thread_count(asked: usize) -> usize {
    if asked == 0 { std::thread::available_parallelism().map_or(1, usize::from) } else { asked }
}

/// `make` of every index below `count`, in order.
///
/// - `threads`: at most this many; 0 means all cores.
/// - `least`: fewer items than this are not worth a thread of their own, 1 or more.
///
/// The caller's thread does its share; alone it starts no other. A panic of `make` goes on in the caller.
pub fn collect<T: Send>(
    threads: usize,
    count: usize,
    least: usize,
    make: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let share_count = (count / least).clamp(1, thread_count(threads));
    let share = count.div_ceil(share_count).max(1);
    if share_count == 1 {
        return (0..count).map(make).collect();
    }
    std::thread::scope(|scope| {
        let make = &make;
        let others: Vec<_> = (share..count)
            .step_by(share)
            .map(|start| {
                let end = (start + share).min(count);
                scope.spawn(move || (start..end).map(make).collect::<Vec<T>>())
            })
            .collect();
        let mut all = Vec::with_capacity(count);
        all.extend((0..share).map(make));
        for other in others {
            all.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        all
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
    fn a_panic_reaches_the_caller() {
        let made = std::panic::catch_unwind(|| collect(2, 10, 1, |index| assert_ne!(index, 9)));
        assert!(made.is_err());
    }
}
