//! One benchmark for each stage of the pipeline: `cargo bench -p superdeform-benches`.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use superdeform_benches::tube;

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

criterion_group!(stages, validate);
criterion_main!(stages);
