//! Weights through a volume, and whether heat would do: `cargo bench --bench voxel`.

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use std::collections::BTreeMap;
use superdeform::internals::character::Frame;
use superdeform::internals::rig::UnitFigure;
use superdeform::internals::rig::voxel::{VoxelOptions, heat_would_be_poor, voxel_weights};
use superdeform::internals::rig::weight_bones::weight_bones;
use superdeform::{Progress, Role};
use superdeform_benches::models;

fn volume(criterion: &mut Criterion) {
    for model in models::models() {
        let character = model.character;
        let forward = Frame::of(&character).expect("the model is whole").to_model(DVec3::Z);
        let figure = UnitFigure::of(&character, forward).expect("the model is whole");
        let joint = |joint: usize| figure.to_unit(character.skeleton.joints[joint].position());
        let joints: BTreeMap<Role, DVec3> =
            character.humanoid.iter().map(|(role, index)| (role, joint(index))).collect();
        let bones = weight_bones(&joints, &BTreeMap::new(), None);
        let mut group = criterion.benchmark_group(&model.name);
        group.sample_size(10);
        group.bench_function("voxel_weights", |bencher| {
            bencher.iter(|| {
                voxel_weights(
                    &figure.positions,
                    &figure.triangles,
                    &bones,
                    &VoxelOptions::default(),
                    &mut Progress::none(),
                )
                .unwrap()
            });
        });
        group.bench_function("heat_would_be_poor", |bencher| {
            bencher.iter(|| heat_would_be_poor(&figure.positions, &figure.triangles, &bones));
        });
        group.finish();
    }
}

criterion_group!(voxel, volume);
criterion_main!(voxel);
