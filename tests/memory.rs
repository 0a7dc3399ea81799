//! What calls take at a time is less than what `src/ffi/memory.rs` asks for before they begin.
#![allow(unsafe_code)]

#[path = "common/abi.rs"]
mod abi;
#[path = "common/people.rs"]
mod people;

use people::Person;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use superdeform::internals::ffi::memory;
use superdeform::internals::shape::Measured;
use superdeform::{
    Character, Deformer, Height, Options, Progress, Rig, RigOptions, Style, WeightMethod, Weights, find_roles,
};
use superdeform_host::file::GltfFile;
use superdeform_host::load::{LoadOptions, load};
use superdeform_host::samples;

/// Counts what is held, and the most that was.
struct Counting;
static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);
static CALLS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        CALLS.fetch_add(1, Relaxed);
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
            check_calls(&format!("{columns} columns"), person.build(), &mut check);
        }
    }
    // Faces with eyes, brows and hair: their stages take memory of their own.
    for name in ["godette.vrm", "seedsan_vrm1.vrm"] {
        let path = samples::folder().join(name);
        if !path.is_file() {
            samples::skipped(name);
            continue;
        }
        let options = LoadOptions { find_roles: Some(&find_roles), ..LoadOptions::default() };
        let loaded = load(GltfFile::read(&path).unwrap(), &options).unwrap();
        check_calls(name, loaded.character, &mut check);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // Here, as a test of its own would allocate beside this one.
    a_second_apply_into_a_hosts_arrays_allocates_nothing();
}

/// What each call takes for one character, and what is asked for before it.
fn check_calls(name: &str, character: Character, check: &mut impl FnMut(String, usize, usize)) {
    let character = Arc::new(character);
    let options = Options { thread_count: 1, ..Options::default() };
    let named = |what: &str| format!("{what}, {name}, {} vertices", character.vertex_count());
    let (copy, taken) = most(|| Character::clone(&character));
    check(named("a copy"), taken, memory::to_copy(&character));
    let (_, taken) = most(|| Measured::of(&character, &options).unwrap());
    check(named("measuring"), taken, memory::to_measure(&character));
    let (mut deformer, taken) =
        most(|| Deformer::new(character.clone(), &Style::Heads(2.5), &options).unwrap());
    check(named("making a deformer"), taken, memory::to_deform(&character));
    for (what, changed) in [
        ("a change of the amount", Options { amount: 0.5, ..options.clone() }),
        ("a change of the height", Options { height: Height::Units(1.0), ..options.clone() }),
        ("a change of youth", Options { youth: 0.5, ..options.clone() }),
        ("a change of the head's size", Options { head_scale: 1.6, ..options.clone() }),
        ("a change of the profile", Options { profile: 0.5, ..options.clone() }),
        ("a change of hair's length", Options { hair_length: 0.5, ..options.clone() }),
        ("a change of rays", Options { rays: Some(24), ..options.clone() }),
    ] {
        let asked = memory::to_change_options(&deformer, &changed);
        let (_, taken) = most(|| deformer.set_options(&changed, &mut Progress::none()).unwrap());
        check(named(what), taken, asked);
    }
    let style = Style::Heads(3.5);
    let (_, taken) = most(|| deformer.set_style(&style, &mut Progress::none()).unwrap());
    check(named("a change of the style"), taken, memory::to_change_style(&character));
    deformer.set(&Style::Heads(2.5), &options, &mut Progress::none()).unwrap();
    let (_, taken) = most(|| deformer.apply());
    check(named("applying"), taken, memory::to_apply(&character));
    let (_, taken) = most(|| deformer.report(&deformer.apply()).unwrap());
    check(named("reporting"), taken, memory::to_report(&character));
    let mut bare = copy;
    bare.skeleton = Default::default();
    bare.humanoid = Default::default();
    bare.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
    for (method, voxel_resolution) in
        [(WeightMethod::Heat, 64), (WeightMethod::Volume, 64), (WeightMethod::Volume, 256)]
    {
        let options = RigOptions { voxel_resolution, method, thread_count: 1, ..RigOptions::default() };
        let (_, taken) = most(|| Rig::of(&bare, &options).unwrap().applied_to(&bare));
        check(
            named(&format!("a rig by {method} {voxel_resolution}")),
            taken,
            memory::to_rig(&bare, &options),
        );
    }
}

fn a_second_apply_into_a_hosts_arrays_allocates_nothing() {
    let character = Person { fingers: true, ..Person::adult() }.build();
    assert!(!character.meshes[0].normals.is_empty());
    let handle = abi::given(&character);
    let deformer = abi::deformer(handle, abi::of_heads(2.5), &abi::with_threads(1));
    let mut room = abi::room(&character);
    room.apply(deformer).unwrap();
    let first = room.bits();
    let before = CALLS.load(Relaxed);
    room.apply(deformer).unwrap();
    assert_eq!(CALLS.load(Relaxed) - before, 0);
    assert!(room.bits() == first);
    abi::destroy(deformer.id);
    abi::destroy(handle.id);
}
