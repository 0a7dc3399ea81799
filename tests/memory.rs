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

/// Counts what is held, the most that was, and what was asked for: in blocks that are aligned as nothing else is.
struct Counting;
static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);
static CALLS: AtomicUsize = AtomicUsize::new(0);
/// What may be held by what was asked for so far, and the least that this was beside what was held at some time, in thousandths.
static ASKED: AtomicUsize = AtomicUsize::new(usize::MAX);
static LEAST: AtomicUsize = AtomicUsize::new(usize::MAX);
static BEFORE: AtomicUsize = AtomicUsize::new(0);
const OF_ASKING: usize = 256;

// SAFETY: the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.align() == OF_ASKING {
            ASKED.fetch_max(NOW.load(Relaxed) + layout.size(), Relaxed);
            return unsafe { System.alloc(layout) };
        }
        CALLS.fetch_add(1, Relaxed);
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        MOST.fetch_max(now, Relaxed);
        let before = BEFORE.load(Relaxed);
        let asked = ASKED.load(Relaxed).saturating_sub(before);
        // Some kilobytes are always there.
        if let Some(held) = now.checked_sub(before).filter(|&held| held > 1 << 18) {
            LEAST.fetch_min(asked.saturating_mul(1000) / held, Relaxed);
        }
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        if layout.align() != OF_ASKING {
            NOW.fetch_sub(layout.size(), Relaxed);
        }
        unsafe { System.dealloc(at, layout) }
    }
}

/// What is asked for is more than is held by this much, for what the allocator and the sparse solver's packages take besides; and
/// beyond some megabytes not more than this, of a rig and of all else.
const LEAST_ASKED: f64 = 1.25;
const MOST_OF_RIG: f64 = 2.0;
const MOST_ASKED: f64 = 2.7;
const SOME: f64 = 4e6;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What a call took.
struct Taken {
    /// The most that it held at a time beyond what was held before.
    most: usize,
    /// What was asked for it.
    asked: usize,
    /// The least of what was asked for so far over what was held.
    least: f64,
}

/// Does `call`, for which `bytes` are asked for before it begins.
fn taken<T>(bytes: usize, call: impl FnOnce() -> T) -> (T, Taken) {
    let before = NOW.load(Relaxed);
    MOST.store(before, Relaxed);
    BEFORE.store(before, Relaxed);
    ASKED.store(before, Relaxed);
    LEAST.store(usize::MAX, Relaxed);
    let result = memory::with(bytes, 1, || Ok(call())).unwrap();
    let (most, asked) = (MOST.load(Relaxed) - before, ASKED.load(Relaxed) - before);
    ASKED.store(usize::MAX, Relaxed);
    (result, Taken { most, asked, least: LEAST.load(Relaxed) as f64 / 1000.0 })
}

/// One test, so that nothing else is counted.
#[test]
fn no_call_takes_more_than_is_asked_for() {
    let mut wrong = Vec::new();
    let mut check = |what: String, most_asked: f64, taken: Taken| {
        let Taken { most, asked, least } = taken;
        println!(
            "{what}: {} of {} kB, {:.2}, least {least:.2}",
            most / 1000,
            asked / 1000,
            asked as f64 / most as f64
        );
        if least < LEAST_ASKED {
            wrong.push(format!(
                "{what} holds 1 / {least} of what was asked for: raise the numbers of its stages"
            ));
        }
        if asked as f64 > (most_asked * most as f64).max(most as f64 + SOME) {
            wrong.push(format!(
                "{what} takes {most} bytes, and {asked} are asked for: lower the numbers of its stages"
            ));
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
    for name in [
        "godette.vrm",
        "seedsan_vrm1.vrm",
        "makehuman_female_vrm1.vrm",
        "valid_black_m_2_busi.glb",
        "kaykit_rogue.glb",
    ] {
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

/// What each call takes for one character, and what is asked for it.
fn check_calls(name: &str, character: Character, check: &mut impl FnMut(String, f64, Taken)) {
    let character = Arc::new(character);
    let options = Options { thread_count: 1, ..Options::default() };
    let named = |what: &str| format!("{what}, {name}, {} vertices", character.vertex_count());
    let (copy, took) = taken(memory::to_copy(&character), || Character::clone(&character));
    check(named("a copy"), MOST_ASKED, took);
    let (_, took) = taken(memory::to_measure(&character), || Measured::of(&character, &options).unwrap());
    check(named("measuring"), MOST_ASKED, took);
    let style = Style::Heads(2.5);
    let make = || Deformer::new(character.clone(), &style, &options).unwrap();
    let (mut deformer, took) = taken(memory::to_deform(&character), make);
    check(named("making a deformer"), MOST_ASKED, took);
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
        let change = || deformer.set_options(&changed, &mut Progress::none()).unwrap();
        check(named(what), MOST_ASKED, taken(asked, change).1);
    }
    let change = || deformer.set_style(&Style::Heads(3.5), &mut Progress::none()).unwrap();
    check(named("a change of the style"), MOST_ASKED, taken(memory::to_change_style(&character), change).1);
    deformer.set(&Style::Heads(2.5), &options, &mut Progress::none()).unwrap();
    check(named("applying"), MOST_ASKED, taken(memory::to_apply(&character), || deformer.apply()).1);
    let report = || deformer.report(&deformer.apply()).unwrap();
    check(named("reporting"), MOST_ASKED, taken(memory::to_report(&character), report).1);
    let mut bare = copy;
    bare.skeleton = Default::default();
    bare.humanoid = Default::default();
    bare.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
    for (method, voxel_resolution) in
        [(WeightMethod::Heat, 64), (WeightMethod::Volume, 64), (WeightMethod::Volume, 256)]
    {
        let options = RigOptions { voxel_resolution, method, thread_count: 1, ..RigOptions::default() };
        let rig = || Rig::of(&bare, &options).unwrap().applied_to(&bare);
        let took = taken(memory::to_rig(&bare), rig).1;
        check(named(&format!("a rig by {method} {voxel_resolution}")), MOST_OF_RIG, took);
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
