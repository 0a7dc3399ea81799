//! What calls take at a time is less than what `src/ffi/memory.rs` asks for before they begin.
#![allow(unsafe_code)]

#[path = "common/people.rs"]
mod people;

use people::Person;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use superdeform::internals::ffi::memory;
use superdeform::internals::shape::Measured;
use superdeform::{Character, Deformer, Options, Rig, RigOptions, Style, WeightMethod, Weights};

/// Counts what is held, and the most that was.
struct Counting;
static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        MOST.fetch_max(now, Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The most that `call` held at a time beyond what was held before.
fn most<T>(call: impl FnOnce() -> T) -> (T, usize) {
    let before = NOW.load(Relaxed);
    MOST.store(before, Relaxed);
    let result = call();
    (result, MOST.load(Relaxed) - before)
}

/// One test, so that nothing else is counted.
#[test]
fn no_call_takes_more_than_is_asked_for() {
    let mut wrong = Vec::new();
    let mut check = |what: String, taken: usize, asked: usize| {
        println!("{what}: {} of {} kB", taken / 1000, asked / 1000);
        if 1.25 * taken as f64 > asked as f64 {
            wrong.push(format!("{what} takes {taken} bytes, and {asked} are asked for: raise the numbers of src/ffi/memory.rs"));
        }
    };
    for columns in [12, 24, 48] {
        for person in [
            Person { columns, ..Person::adult() },
            Person { columns, skirt: true, fingers: true, blended: true, ..Person::adult() },
        ] {
            let character = Arc::new(person.build());
            let options = Options { thread_count: 1, ..Options::default() };
            let name = |what: &str| format!("{what}, {} vertices", character.vertex_count());
            let (copy, taken) = most(|| Character::clone(&character));
            check(name("a copy"), taken, memory::to_copy(&character));
            let (_, taken) = most(|| Measured::of(&character, &options).unwrap());
            check(name("measuring"), taken, memory::to_measure(&character));
            let (deformer, taken) =
                most(|| Deformer::new(character.clone(), &Style::Heads(2.5), &options).unwrap());
            check(name("making a deformer"), taken, memory::to_deform(&character));
            let (_, taken) = most(|| deformer.apply());
            check(name("applying"), taken, memory::to_apply(&character));
            let (_, taken) = most(|| deformer.report(&deformer.apply()).unwrap());
            check(name("reporting"), taken, memory::to_report(&character));
            let mut bare = copy;
            bare.skeleton = Default::default();
            bare.humanoid = Default::default();
            bare.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
            for (method, voxel_resolution) in
                [(WeightMethod::Heat, 64), (WeightMethod::Volume, 64), (WeightMethod::Volume, 256)]
            {
                let options =
                    RigOptions { voxel_resolution, method, thread_count: 1, ..RigOptions::default() };
                let (_, taken) = most(|| Rig::of(&bare, &options).unwrap().applied_to(&bare));
                let what = name(&format!("a rig by {method} {voxel_resolution}"));
                check(what, taken, memory::to_rig(&bare, &options));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
