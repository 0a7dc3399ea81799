//! Inputs that fuzzing found, each with what went wrong.

use superdeform::parallel;

#[test]
fn more_threads_than_a_system_has_are_no_fault() {
    // A thread for each of 100,000 pieces: the system refused one, which was a panic.
    let made = parallel::collect(usize::MAX, 100_000, 1, |index| index);
    assert!(made.into_iter().eq(0..100_000));
}
