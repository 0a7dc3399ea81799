//! How long rig, create and report say nothing, as shares of their time: on Seed-san without its rig, where it is at hand, and on a body of
//! 100,000 triangles. Not a benchmark: times of one run each, with the three longest silences.

use std::sync::Arc;
use std::time::Instant;
use superdeform::{Character, Deformer, Mesh, Options, Progress, Rig, RigOptions, Weights};
use superdeform_benches::{models, refined};
use superdeform_host::samples;

/// Runs `call` and prints its longest silences.
fn listen<T>(name: &str, call: impl FnOnce(&mut Progress) -> T) -> T {
    let start = Instant::now();
    let mut reports = vec![(0.0, 0.0)];
    let mut report = |fraction| {
        reports.push((fraction, start.elapsed().as_secs_f64()));
        true
    };
    let result = call(&mut Progress::new(&mut report));
    let all = start.elapsed().as_secs_f64();
    let mut silences: Vec<(f64, f32, f32)> =
        reports.windows(2).map(|pair| (pair[1].1 - pair[0].1, pair[0].0, pair[1].0)).collect();
    silences.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("{name}: {all:.3} s, {} reports", reports.len() - 1);
    for (silence, from, to) in silences.into_iter().take(3) {
        println!("  {:.3} of it from {from:.3} to {to:.3}", silence / all);
    }
    result
}

fn unrigged(mut character: Character) -> Character {
    character.skeleton = Default::default();
    character.humanoid = Default::default();
    character.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
    character
}

fn main() {
    let body = models::capsule_body();
    let (positions, triangles) = refined(&body.positions, &body.triangles, 50_000);
    let positions = positions.iter().map(|p| p.as_vec3()).collect();
    let mesh = Mesh { name: "body".to_string(), positions, triangles, ..Mesh::default() };
    let mut characters =
        vec![("a body of 100,000 triangles", Character { meshes: vec![mesh], ..Character::default() })];
    let path = samples::folder().join("seedsan_vrm1.vrm");
    if path.is_file() {
        characters.push(("Seed-san", unrigged(models::load(&path).character)));
    } else {
        println!("skipped: Seed-san (no {})", path.display());
    }
    let options = Options { thread_count: 1, ..Options::default() };
    let rig_options = RigOptions { thread_count: 1, ..RigOptions::default() };
    for (name, character) in characters {
        let rig = listen(&format!("rig, {name}"), |progress| {
            Rig::with_progress(&character, &rig_options, progress)
        })
        .expect("it can be rigged");
        let rigged = Arc::new(rig.applied_to(&character));
        let deformer = listen(&format!("create, {name}"), |progress| {
            Deformer::with_rigged(rigged, &character, &rig, &models::style(), &options, progress)
        })
        .expect("it can be deformed");
        listen(&format!("report, {name}"), |progress| {
            let deformed = deformer.apply_with(&mut progress.part(0.0, 0.2))?;
            deformer.report_with(&deformed, &mut progress.part(0.2, 1.0))
        })
        .expect("it can be measured");
    }
}
