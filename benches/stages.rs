//! One benchmark for each stage of the pipeline, and one for all of it: `cargo bench --bench stages`.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;
use superdeform::internals::geometry::{SEAM, weld};
use superdeform::internals::shape::measured::Measured;
use superdeform::internals::shape::product::binding::part_bindings;
use superdeform::{Deformer, Options, Progress};
use superdeform_benches::{models, tube};

fn validate(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("validate");
    for ring_count in [100, 1000] {
        let character = tube(ring_count, 50);
        group.throughput(Throughput::Elements(character.vertex_count() as u64));
        group.bench_with_input(
            BenchmarkId::from_parameter(character.vertex_count()),
            &character,
            |bencher, character| bencher.iter(|| black_box(character).validate()),
        );
    }
    group.finish();
}

fn pipeline(criterion: &mut Criterion) {
    let options = Options::default();
    let style = models::style();
    for model in models::models() {
        let mut group = criterion.benchmark_group(&model.name);
        group.sample_size(10);
        let character = Arc::new(model.character);
        let new = || Deformer::new(character.clone(), &style, &options).expect("the model is whole");
        let study = Measured::of(&character, &options).expect("the model is whole");
        let weld = weld(&study.figure.positions, SEAM * study.figure.height());
        let mut deformer = new();
        let deformed = deformer.apply();
        group.bench_function("study", |bencher| bencher.iter(|| Measured::of(&character, &options)));
        group.bench_function("part_bindings", |bencher| {
            bencher.iter(|| {
                part_bindings(
                    &study.figure,
                    &study.anatomy,
                    study.face.as_ref(),
                    &character.skeleton,
                    &weld,
                    options.thread_count,
                    &mut Progress::none(),
                )
            });
        });
        // Measured, bindings and field.
        group.bench_function("deformer", |bencher| bencher.iter(new));
        group.bench_function("apply", |bencher| bencher.iter(|| deformer.apply()));
        group.bench_function("report", |bencher| bencher.iter(|| deformer.report(&deformed)));
        if let Some(path) = &model.path {
            let loaded = models::load(path);
            group.bench_function("load", |bencher| bencher.iter(|| models::load(path)));
            group.bench_function("write", |bencher| {
                bencher.iter(|| models::write(&loaded, &deformer, &deformed));
            });
            group.bench_function("whole", |bencher| {
                bencher.iter(|| {
                    let loaded = models::load(path);
                    let character = Arc::new(loaded.character.clone());
                    let deformer = Deformer::new(character, &style, &options).expect("the model is whole");
                    let deformed = deformer.apply();
                    black_box(deformer.report(&deformed).expect("the result is whole"));
                    models::write(&loaded, &deformer, &deformed)
                });
            });
        }
        group.bench_function("face", |bencher| {
            let options = Options { face_squash: Some(0.5), ..options.clone() };
            bencher.iter(|| {
                deformer.set_options(&options, &mut Progress::none()).expect("the options are in range");
                deformer.apply()
            });
        });
        group.finish();
    }
}

criterion_group!(stages, validate, pipeline);
criterion_main!(stages);
