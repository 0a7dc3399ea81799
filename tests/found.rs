//! Inputs that fuzzing found, each with what went wrong.

use glam::{DVec3, Vec3};
use superdeform::internals::parallel;
use superdeform::internals::rig::WeightBone;
use superdeform::internals::rig::voxel::{VoxelOptions, voxel_weights};
use superdeform::{BodyShape, Character, Heights, Mesh, Progress, Proportions, Rig, RigOptions};

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
        let alone =
            voxel_weights(&positions, &triangles, &[bone(7, far)], &options, &mut Progress::none()).unwrap();
        assert!(alone.weights.rows().all(|row| row == [(7, 1.0)]), "{far}");
        let beside = voxel_weights(
            &positions,
            &triangles,
            &[bone(7, far), bone(3, 0.5)],
            &options,
            &mut Progress::none(),
        )
        .unwrap();
        assert!(beside.weights.rows().all(|row| row.iter().all(|&(_, weight)| weight >= 0.0)), "{far}");
    }
}

#[test]
fn a_sheet_any_number_of_times_as_wide_as_high_is_laid_out() {
    // Its width in cells of its height, and two more, was beyond all numbers.
    for height in [1e-19, 1e-25, 1e-40] {
        let positions = vec![Vec3::NEG_X, Vec3::X, Vec3::new(0.0, height, 0.0), Vec3::new(0.5, height, 1.0)];
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [1, 3, 2]], ..Mesh::default() };
        let character = Character { meshes: vec![mesh], ..Character::default() };
        let options = RigOptions { voxel_resolution: 16, thread_count: 1, ..RigOptions::default() };
        let rig = Rig::of(&character, &options).unwrap();
        assert!(rig.skeleton.joints.iter().all(|joint| joint.rest.is_finite()), "{height}");
    }
}

#[test]
fn a_style_that_is_taken_can_be_saved_and_loaded() {
    // Landmarks that are no numbers were taken, saved as null, and not loaded again.
    let good = BodyShape { head_length: 1.0, landmarks: Some(Heights::default()), ..BodyShape::default() };
    assert_eq!(BodyShape::from_json(&good.to_json()).unwrap(), good);
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let chin = Heights { chin: wrong, ..Heights::default() };
        let sole = Heights { sole: wrong, ..Heights::default() };
        for (name, landmarks) in [("chin", chin), ("sole", sole)] {
            let style = BodyShape { landmarks: Some(landmarks), ..good.clone() };
            let error = style.validate().unwrap_err().to_string();
            assert!(error.contains(name) && error.contains(&wrong.to_string()), "{error}");
        }
    }
}

#[test]
#[allow(unsafe_code)]
fn a_style_cannot_be_stretched_beyond_all_numbers() {
    use superdeform::internals::ffi::basics::*;
    use superdeform::internals::ffi::lifetime::*;
    use superdeform::internals::ffi::style_handle::*;
    // Lengths that are next to nothing beside the head: stretched to so many heads they were infinite.
    let lengths = Proportions {
        head_length: 1e300,
        head_half_width: 1.0,
        torso: 1e-300,
        arm: 1.0,
        leg: 1e-300,
        ..Proportions::default()
    };
    let text = BodyShape { head_length: 1.0, proportions: Some(lengths), ..BodyShape::default() }.to_json();
    let (mut flat, mut tall) = (SdefStyle::default(), SdefStyle::default());
    let null = std::ptr::null_mut();
    unsafe {
        let taken = sdef_style_from_text(text.as_ptr().cast(), text.len(), &mut flat, null);
        assert_eq!(taken, SDEF_STATUS_OK);
        assert_eq!(sdef_style_from_heads(3.0, flat, &mut tall, null), SDEF_STATUS_BAD_STYLE);
        assert_eq!(tall.id, 0);
        assert_eq!(sdef_destroy(flat.id, null), SDEF_STATUS_OK);
    }
}
