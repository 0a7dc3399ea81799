//! What a slider waits for, in a character of 50,000 vertices: `cargo bench --bench slider`. A picture a sixtieth of a
//! second is 16.7 ms.

use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;
use superdeform::{Deformer, MeshOutputs, Options, Progress};
use superdeform_benches::models;

/// Columns of a person's tubes that make 50,000 vertices of it.
const COLUMNS: usize = 60;

fn slider(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("slider");
    group.sample_size(20);
    let character = models::capsules(COLUMNS);
    println!("{} vertices, {} triangles", character.vertex_count(), character.triangle_count());
    let mesh_count = character.meshes.len();
    let options = Options::default();
    let mut deformer =
        Deformer::new(Arc::new(character), &models::style(), &options).expect("the model is whole");
    let positions = vec![MeshOutputs::default(); mesh_count];
    let directions = vec![MeshOutputs { normals: true, ..MeshOutputs::default() }; mesh_count];
    let mut none = Progress::none();
    group.bench_function("apply, positions", |bencher| {
        bencher.iter(|| black_box(deformer.apply_to(&positions, &mut none)));
    });
    group.bench_function("apply, positions and normals", |bencher| {
        bencher.iter(|| black_box(deformer.apply_to(&directions, &mut none)));
    });
    let mut slide = |name: &str, change: fn(&mut Options, f64)| {
        let mut amount = 0.6;
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                amount = 1.5 - amount;
                let mut options = options.clone();
                change(&mut options, amount);
                deformer.set_options(&options, &mut Progress::none()).expect("the options are in range");
            });
        });
    };
    slide("face", |options, amount| options.face_squash = Some(amount));
    slide("amount", |options, amount| options.amount = amount);
    slide("hair length", |options, amount| options.hair_length = amount);
    slide("head scale", |options, amount| options.head_scale = 1.5 * amount);
    group.finish();
}

criterion_group!(benches, slider);
criterion_main!(benches);
