//! Inputs that fuzzing found, each with what went wrong.

use glam::DVec3;
use superdeform::parallel;
use superdeform::rig::WeightBone;
use superdeform::rig::voxel::{VoxelOptions, voxel_weights};

#[test]
fn more_threads_than_a_system_has_are_no_fault() {
    // A thread for each of 100,000 pieces: the system refused one, and the process ended.
    let made = parallel::collect(usize::MAX, 100_000, 1, |index| index);
    assert!(made.into_iter().eq(0..100_000));
}

#[test]
fn a_bone_far_outside_the_body_is_far_away() {
    // Distances in voxels were counted in as many buckets: memory for all of them, or a number beyond all numbers.
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    let positions: Vec<DVec3> = (0..8).map(corner).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    for far in [1e7, 1e30, 1e300] {
        let bone = |joint: u32, x: f64| WeightBone { joint, segments: vec![[DVec3::new(x, 0.5, 0.5); 2]] };
        let options = VoxelOptions { resolution: 16, falloff: 0.2, thread_count: 1 };
        let alone = voxel_weights(&positions, &triangles, &[bone(7, far)], &options);
        assert!(alone.weights.rows().all(|row| row == [(7, 1.0)]), "{far}");
        let beside = voxel_weights(&positions, &triangles, &[bone(7, far), bone(3, 0.5)], &options);
        assert!(beside.weights.rows().all(|row| row.iter().all(|&(_, weight)| weight >= 0.0)), "{far}");
    }
}
