//! Heat weights by the number of vertices: `cargo bench --bench heat`.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use superdeform::Progress;
use superdeform::internals::rig::heat::{HeatOptions, HeatSystem, heat_weights};
use superdeform_benches::models;

fn heat(criterion: &mut Criterion) {
    for body in models::bodies() {
        let mut group = criterion.benchmark_group(format!("heat/{}", body.name));
        group.sample_size(10);
        for vertex_count in [20_000, 50_000, 100_000] {
            let (positions, triangles) =
                superdeform_benches::refined(&body.positions, &body.triangles, vertex_count);
            group.throughput(Throughput::Elements(positions.len() as u64));
            group.bench_function(BenchmarkId::from_parameter(positions.len()), |bencher| {
                let options = HeatOptions { heat: 1.0, thread_count: 2 };
                bencher.iter(|| heat_weights(&positions, &triangles, &body.bones, &options));
            });
            let system =
                HeatSystem::new(&positions, &triangles, &body.bones, 2, &mut Progress::none()).unwrap();
            group.bench_function(BenchmarkId::new("another_c", positions.len()), |bencher| {
                bencher.iter(|| system.weights(3.0, &mut Progress::none()));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, heat);
criterion_main!(benches);
