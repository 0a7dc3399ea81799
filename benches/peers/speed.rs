//! What `speed.py` compares with other programs: the least of many runs on one thread, in milliseconds.
//!
//! Names of models may follow; without them people of 46,848 and 484,218 vertices, and the files that are at hand. With
//! `--only=TEXT` only lines that hold it.

use glam::Vec3;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use superdeform::{Character, Deformer, MeshOutputs, MorphTarget, Options, Progress};
use superdeform_benches::models;

/// Columns of people's tubes.
const COLUMNS: [usize; 2] = [60, 189];

/// What a slider is called, and what its place does to the options.
type Slider = (&'static str, fn(&mut Options, f64));

/// The least time of `run`, in milliseconds.
fn least(runs: usize, mut run: impl FnMut(usize)) -> f64 {
    let timed = |run: &mut dyn FnMut(usize), index| {
        let clock = Instant::now();
        run(index);
        clock.elapsed().as_secs_f64() * 1e3
    };
    // The first one makes what is kept.
    timed(&mut run, 0);
    (1..=runs).map(|index| timed(&mut run, index)).fold(f64::INFINITY, f64::min)
}

fn measure(name: &str, character: Character, only: &str) {
    let (vertices, mesh_count) = (character.vertex_count(), character.meshes.len());
    println!("{name}: {vertices} vertices");
    let options = Options { thread_count: 1, ..Options::default() };
    let mut deformer =
        Deformer::new(Arc::new(character), &models::style(), &options).expect("the model is whole");
    let runs = if vertices > 100_000 { 15 } else { 60 };
    let none = &mut Progress::none();
    let outputs = [
        ("apply: positions", MeshOutputs::default()),
        ("apply: positions and normals", MeshOutputs { normals: true, ..MeshOutputs::default() }),
        (
            "apply: positions, normals, tangents",
            MeshOutputs { normals: true, tangents: true, ..MeshOutputs::default() },
        ),
        ("apply: all", MeshOutputs::ALL),
    ];
    for (what, asked) in outputs.into_iter().filter(|(what, _)| what.contains(only)) {
        let asked = vec![asked; mesh_count];
        let time = least(runs, |_| drop(black_box(deformer.apply_to(&asked, none))));
        println!("  {what:36} {time:9.3}");
    }
    let asked = vec![MeshOutputs::default(); mesh_count];
    let sliders: [Slider; 7] = [
        ("amount", |options, share| options.amount = share),
        ("youth", |options, share| options.youth = share),
        ("face", |options, share| options.face_squash = Some(0.5 * share)),
        ("seat", |options, share| options.seat = share),
        ("head size", |options, share| options.head_scale = 1.2 + 0.3 * share),
        ("a limb", |options, share| {
            options.groups.entry("upper_arm".to_string()).or_default().length_scale = Some(0.6 + 0.3 * share);
        }),
        ("hair length", |options, share| options.hair_length = share),
    ];
    for (what, change) in sliders.into_iter().filter(|(what, _)| what.contains(only)) {
        let [mut set, mut both] = [f64::INFINITY; 2];
        for run in 0..runs / 3 + 2 {
            let mut options = options.clone();
            change(&mut options, 0.3 + 0.6 * (run as f64 / 100.0));
            let clock = Instant::now();
            deformer.set_options(&options, none).expect("the options are in range");
            let then = clock.elapsed().as_secs_f64() * 1e3;
            drop(black_box(deformer.apply_to(&asked, none)));
            // The first ones make what is kept.
            if run >= 2 {
                (set, both) = (set.min(then), both.min(clock.elapsed().as_secs_f64() * 1e3));
            }
        }
        println!("  {:36} {set:9.3}, with positions {both:9.3}", format!("set: {what}"));
        deformer.set_options(&options, none).expect("the options are in range");
    }
}

/// Morph targets, and the vertices that each touches: the highest of the largest mesh, as a face's do.
const MORPHS: [usize; 2] = [50, 5000];

fn measure_morphs(mut character: Character, only: &str) {
    let what = format!("apply: {} morph targets of {} vertices", MORPHS[0], MORPHS[1]);
    if !what.contains(only) {
        return;
    }
    let mesh_count = character.meshes.len();
    let largest = (0..mesh_count).max_by_key(|&mesh| character.meshes[mesh].positions.len()).unwrap_or(0);
    let mesh = &mut character.meshes[largest];
    let mut highest: Vec<usize> = (0..mesh.positions.len()).collect();
    highest.sort_by(|&a, &b| mesh.positions[b].y.total_cmp(&mesh.positions[a].y));
    mesh.morph_targets = (0..MORPHS[0])
        .map(|target| {
            let mut positions = vec![Vec3::ZERO; mesh.positions.len()];
            for &vertex in highest.iter().take(MORPHS[1]) {
                positions[vertex] = Vec3::splat(1e-4 * (target + 1) as f32);
            }
            MorphTarget { positions, ..MorphTarget::default() }
        })
        .collect();
    let options = Options { thread_count: 1, ..Options::default() };
    let deformer =
        Deformer::new(Arc::new(character), &models::style(), &options).expect("the model is whole");
    let only_positions = vec![MeshOutputs::default(); mesh_count];
    let mut asked = only_positions.clone();
    asked[largest].morph_targets = true;
    let [with, without] = [asked, only_positions]
        .map(|asked| least(20, |_| drop(black_box(deformer.apply_to(&asked, &mut Progress::none())))));
    println!("  {what:36} {:9.3}", with - without);
}

fn main() {
    let (only, asked): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|argument| argument.starts_with("--only="));
    let only = only.first().map_or("", |only| &only["--only=".len()..]);
    if asked.is_empty() {
        for columns in COLUMNS {
            measure("capsules", models::capsules(columns), only);
            measure_morphs(models::capsules(columns), only);
        }
        for model in models::models().into_iter().skip(1) {
            measure(&model.name, model.character, only);
        }
    }
    for name in asked {
        let path = superdeform_host::samples::folder().join(&name);
        measure(&name, models::load(&path).character, only);
    }
}
