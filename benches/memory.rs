//! The most memory that each stage has at one time, above what was there before it: `cargo bench --bench memory`.

use std::alloc::{GlobalAlloc, Layout, System};
use std::hint::black_box;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use superdeform::internals::rig::WeightBone;
use superdeform::internals::rig::heat::{HeatOptions, heat_weights};
use superdeform::internals::shape::measured::Measured;
use superdeform::{Deformer, Options, Progress};
use superdeform_benches::models;

/// The system's allocator, counted.
struct Counted;

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

fn add(size: usize) {
    MOST.fetch_max(NOW.fetch_add(size, Relaxed) + size, Relaxed);
}

// Counting needs an allocator, and an allocator is unsafe; it hands everything on.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Both may be there while one is copied to the other.
        add(size);
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counted = Counted;

/// Does `stage` and prints its peak, and what is left of it.
fn peak<T>(name: &str, stage: impl FnOnce() -> T) -> T {
    let before = NOW.load(Relaxed);
    MOST.store(before, Relaxed);
    let made = black_box(stage());
    let megabytes = |bytes: usize| bytes.saturating_sub(before) as f64 / 1e6;
    println!(
        "  {name:10} {:8.2} MB, kept {:8.2} MB",
        megabytes(MOST.load(Relaxed)),
        megabytes(NOW.load(Relaxed))
    );
    made
}

fn main() {
    for body in models::bodies() {
        println!("{}: 100,000 vertices, {} bones", body.name, body.bones.len());
        let (positions, triangles) = superdeform_benches::refined(&body.positions, &body.triangles, 100_000);
        let options = HeatOptions { heat: 1.0, thread_count: 2 };
        peak("heat", || heat_weights(&positions, &triangles, &body.bones, &options));
        // As many bones as a body with fingers has: each once more, beside itself.
        let twice: Vec<WeightBone> = (body.bones.iter())
            .chain(&body.bones)
            .zip(0..)
            .map(|(bone, joint)| WeightBone { joint, ..bone.clone() })
            .collect();
        peak("twice", || heat_weights(&positions, &triangles, &twice, &options));
    }
    let options = Options::default();
    let style = models::style();
    for model in models::models() {
        println!("{}", model.name);
        let loaded = model.path.as_ref().map(|path| peak("load", || models::load(path)));
        let character = Arc::new(model.character);
        peak("study", || Measured::of(&character, &options).expect("the model is whole"));
        let mut deformer = peak("deformer", || {
            Deformer::new(character.clone(), &style, &options).expect("the model is whole")
        });
        let deformed = peak("apply", || deformer.apply());
        peak("report", || deformer.report(&deformed).expect("the result is whole"));
        let younger = Options { face_squash: Some(0.5), ..options.clone() };
        peak("face", || {
            deformer.set_options(&younger, &mut Progress::none()).expect("the options are in range")
        });
        if let Some(loaded) = loaded {
            peak("write", || models::write(&loaded, &deformer, &deformed));
        }
    }
}
