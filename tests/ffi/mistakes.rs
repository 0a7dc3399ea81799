//! Every mistake that a host can make.

use super::*;

/// A call that must fail, with what it is about.
type Case = (&'static str, u32, Box<dyn Fn(*mut SdefError) -> SdefStatus>);

fn with_mesh(
    handle: SdefCharacter,
    change: impl Fn(&mut SdefMesh) + 'static,
) -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
    let base = c_mesh(&person().meshes[0]);
    Box::new(move |error| unsafe {
        let mut mesh = base.mesh;
        change(&mut mesh);
        sdef_character_add_mesh(handle, &mesh, null_mut(), error)
    })
}

fn with_options(
    handle: SdefCharacter,
    style: SdefStyle,
    change: impl Fn(&mut SdefOptions) + 'static,
) -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
    Box::new(move |error| unsafe {
        let mut options = options();
        change(&mut options);
        let mut to = SdefDeformer::default();
        sdef_deformer_create(handle, style, &options, None, null_mut(), &mut to, error)
    })
}

fn with_skeleton(
    handle: SdefCharacter,
    change: impl Fn(&mut SdefSkeleton) + 'static,
) -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
    let base = c_skeleton(person());
    Box::new(move |error| unsafe {
        let mut skeleton = base.skeleton;
        change(&mut skeleton);
        sdef_character_set_skeleton(handle, &skeleton, error)
    })
}

/// Every mistake that a host can make, with the sentence that it gets. The sentences are printed, to be read.
#[test]
fn every_mistake_gets_its_status_and_a_sentence() {
    let _at_work = at_work();
    let (full, empty, bare) = (given(person()), create(), create());
    let skeleton = c_skeleton(person());
    ask(|error| unsafe { sdef_character_set_skeleton(bare, &skeleton.skeleton, error) }).unwrap();
    let style = of_heads(2.5);
    let other = from_text("sd2.5").unwrap();
    let made = deformer(full, style, &options());
    let nans: &'static [f32] = vec![f32::NAN; 3 * person().meshes[0].positions.len()].leak();
    let high: &'static [u32] = vec![4_000_000_000; 3].leak();
    let negative: &'static [f32] = vec![-0.25; person().meshes[0].positions.len()].leak();
    let zeros: &'static [u32] = vec![0; person().meshes[0].positions.len() + 1].leak();
    let falling: &'static [u32] =
        (0..=person().meshes[0].positions.len() as u32).rev().collect::<Vec<_>>().leak();
    let nan_matrix: &'static [f64] = vec![f64::NAN; 16 * person().skeleton.joints.len()].leak();
    let flat: &'static [f32] = vec![0.0; 9].leak();
    let circle: &'static [i32] =
        (0..person().skeleton.joints.len() as i32).map(|i| (i + 1) % 3).collect::<Vec<_>>().leak();
    let by_rows: &'static [[f64; 16]] = person()
        .skeleton
        .joints
        .iter()
        .map(|joint| joint.rest.transpose().to_cols_array())
        .collect::<Vec<_>>()
        .leak();
    let wild: &'static [i32] = vec![-7; person().skeleton.joints.len()].leak();
    let text_group = CString::new("knees").unwrap();
    let nan = f64::NAN;
    let settings: &'static [SdefGroupSettings] = Box::leak(Box::new(
        [(nan, nan), (0.5, nan), (1000.0, nan)].map(|(length_scale, thickness_scale)| SdefGroupSettings {
            group: c"upper_leg".as_ptr(),
            length_scale,
            thickness_scale,
            length_transfer: nan,
            thickness_transfer: nan,
        }),
    ));
    let unknown: &'static SdefGroupSettings =
        Box::leak(Box::new(SdefGroupSettings { group: text_group.into_raw(), ..settings[1] }));
    let bone: &'static SdefBoneGroup = Box::leak(Box::new(SdefBoneGroup { role: 77, group: c"x".as_ptr() }));
    let joint: &'static [SdefGivenJoint] = Box::leak(Box::new([
        SdefGivenJoint { role: 60, x: 0.0, y: 0.0, z: 0.0 },
        SdefGivenJoint { role: 0, x: nan, y: 0.0, z: 0.0 },
    ]));
    let make_style = |text: &'static str| -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
        Box::new(move |error| unsafe {
            let mut to = SdefStyle::default();
            sdef_style_from_text(text.as_ptr().cast(), text.len(), &mut to, error)
        })
    };
    let numbers = |change: fn(&mut SdefStyleNumbers)| -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
        Box::new(move |error| unsafe {
            let mut numbers =
                SdefStyleNumbers { struct_size: size_of::<SdefStyleNumbers>() as u32, ..zeroed() };
            sdef_style_get_numbers(other, &mut numbers, null_mut(), 0, null_mut(), null_mut());
            change(&mut numbers);
            let mut to = SdefStyle::default();
            sdef_style_from_numbers(null(), &numbers, null(), 0, &mut to, error)
        })
    };
    let bones = |bones: [SdefBone; 2]| -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
        Box::new(move |error| unsafe {
            let mut numbers =
                SdefStyleNumbers { struct_size: size_of::<SdefStyleNumbers>() as u32, ..zeroed() };
            sdef_style_get_numbers(other, &mut numbers, null_mut(), 0, null_mut(), null_mut());
            let mut to = SdefStyle::default();
            sdef_style_from_numbers(null(), &numbers, bones.as_ptr(), 2, &mut to, error)
        })
    };
    let result = |change: fn(&mut SdefMeshResult)| -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
        Box::new(move |error| unsafe {
            let mut room = room(person());
            change(&mut room.meshes[0]);
            sdef_deformer_apply(made, room.meshes.as_ptr(), room.meshes.len(), None, null_mut(), error)
        })
    };
    let add = |change: fn(&mut SdefMorphTarget), mesh: u32| -> Box<dyn Fn(*mut SdefError) -> SdefStatus> {
        Box::new(move |error| unsafe {
            let mut target = c_morph(&person().meshes[0].morph_targets[0]);
            change(&mut target);
            sdef_character_add_morph_target(full, mesh, &target, error)
        })
    };
    use std::ptr::dangling;
    let cases: Vec<Case> = vec![
        (
            "up of length 0",
            SDEF_STATUS_BAD_INPUT,
            Box::new(move |error| unsafe {
                let mut to = SdefCharacter::default();
                sdef_character_create(flat.as_ptr(), null(), &mut to, error)
            }),
        ),
        (
            "forward along up",
            SDEF_STATUS_BAD_INPUT,
            Box::new(move |error| unsafe {
                let (up, mut to) = ([0.0, 2.0, 0.0], SdefCharacter::default());
                sdef_character_create(null(), up.as_ptr(), &mut to, error)
            }),
        ),
        (
            "no place for a character",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(|error| unsafe { sdef_character_create(null(), null(), null_mut(), error) }),
        ),
        (
            "no mesh",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe { sdef_character_add_mesh(full, null(), null_mut(), error) }),
        ),
        ("a mesh of size 0", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.struct_size = 0)),
        ("a mesh of size 7", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.struct_size = 7)),
        (
            "a mesh of wild size",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.struct_size = 0xDEAD_BEEC),
        ),
        ("an unknown kind", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.kind = 6)),
        ("no positions", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.positions = null())),
        (
            "too many vertices",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.vertex_count = u32::MAX as usize),
        ),
        (
            "far too many vertices",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.vertex_count = usize::MAX),
        ),
        ("a stride of 11", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.position_stride = 11)),
        (
            "a stride that overflows",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.position_stride = usize::MAX / 2),
        ),
        (
            "a tangent stride of 12",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.tangent_stride = 12),
        ),
        (
            "a position that is NAN",
            SDEF_STATUS_BAD_INPUT,
            with_mesh(full, move |mesh| mesh.positions = nans.as_ptr()),
        ),
        (
            "a normal that is NAN",
            SDEF_STATUS_BAD_INPUT,
            with_mesh(full, move |mesh| mesh.normals = nans.as_ptr()),
        ),
        ("no indices", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.indices = null())),
        ("4 indices", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.index_count = 4)),
        (
            "more indices than memory",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.index_count = usize::MAX / 3 * 3),
        ),
        (
            "an index beyond the vertices",
            SDEF_STATUS_BAD_INPUT,
            with_mesh(full, move |mesh| (mesh.indices, mesh.index_count) = (high.as_ptr().cast(), 3)),
        ),
        (
            "indices as floats",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.index_type = SDEF_TYPE_F32),
        ),
        (
            "joints as floats",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.joint_type = SDEF_TYPE_F32),
        ),
        (
            "weights as integers",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| mesh.weight_type = SDEF_TYPE_U32),
        ),
        ("no joints", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.joints = null())),
        ("no weights", SDEF_STATUS_BAD_ARGUMENT, with_mesh(full, move |mesh| mesh.weights = null())),
        (
            "wild influences",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| (mesh.influence_count, mesh.row_starts) = (usize::MAX / 2, null())),
        ),
        (
            "a joint stride of 1",
            SDEF_STATUS_BAD_ARGUMENT,
            with_mesh(full, move |mesh| {
                (mesh.influence_count, mesh.row_starts, mesh.joint_stride) = (1, null(), 1);
            }),
        ),
        (
            "rows that do not rise",
            SDEF_STATUS_BAD_INPUT,
            with_mesh(full, move |mesh| mesh.row_starts = falling.as_ptr()),
        ),
        (
            "rows that end early",
            SDEF_STATUS_BAD_INPUT,
            with_mesh(full, move |mesh| mesh.row_starts = zeros.as_ptr()),
        ),
        (
            "a negative weight",
            SDEF_STATUS_BAD_INPUT,
            with_mesh(full, move |mesh| {
                (mesh.influence_count, mesh.row_starts) = (1, null());
                mesh.weights = negative.as_ptr().cast();
                mesh.joints = zeros.as_ptr().cast();
            }),
        ),
        ("weights before the skeleton", SDEF_STATUS_BAD_INPUT, with_mesh(empty, move |_| ())),
        (
            "no morph target",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe { sdef_character_add_morph_target(full, 0, null(), error) }),
        ),
        (
            "a morph target without positions",
            SDEF_STATUS_BAD_ARGUMENT,
            add(|target| target.positions = null(), 0),
        ),
        ("a morph target of no mesh", SDEF_STATUS_BAD_ARGUMENT, add(|_| (), 99)),
        (
            "a delta that is NAN",
            SDEF_STATUS_BAD_INPUT,
            Box::new(move |error| unsafe {
                let mut target = c_morph(&person().meshes[0].morph_targets[0]);
                target.normals = nans.as_ptr();
                sdef_character_add_morph_target(full, 0, &target, error)
            }),
        ),
        (
            "no skeleton",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe { sdef_character_set_skeleton(empty, null(), error) }),
        ),
        (
            "no parents",
            SDEF_STATUS_BAD_ARGUMENT,
            with_skeleton(empty, move |skeleton| skeleton.parents = null()),
        ),
        (
            "a circle of parents",
            SDEF_STATUS_BAD_INPUT,
            with_skeleton(empty, move |skeleton| skeleton.parents = circle.as_ptr()),
        ),
        (
            "a parent of -7",
            SDEF_STATUS_BAD_INPUT,
            with_skeleton(empty, move |skeleton| skeleton.parents = wild.as_ptr()),
        ),
        (
            "a rest matrix that is NAN",
            SDEF_STATUS_BAD_INPUT,
            with_skeleton(empty, move |skeleton| skeleton.rest_matrices = nan_matrix.as_ptr()),
        ),
        (
            "rest matrices row by row",
            SDEF_STATUS_BAD_INPUT,
            with_skeleton(empty, move |skeleton| skeleton.rest_matrices = by_rows.as_ptr().cast()),
        ),
        (
            "one joint for two roles",
            SDEF_STATUS_BAD_INPUT,
            with_skeleton(empty, move |skeleton| {
                (skeleton.role_joints, skeleton.role_count) = (zeros.as_ptr().cast(), 2);
            }),
        ),
        (
            "a matrix stride of 64",
            SDEF_STATUS_BAD_ARGUMENT,
            with_skeleton(empty, move |skeleton| skeleton.rest_stride = 64),
        ),
        (
            "wild joints",
            SDEF_STATUS_BAD_ARGUMENT,
            with_skeleton(empty, move |skeleton| skeleton.joint_count = usize::MAX),
        ),
        (
            "56 roles",
            SDEF_STATUS_BAD_ARGUMENT,
            with_skeleton(empty, move |skeleton| skeleton.role_count = 56),
        ),
        (
            "no roles",
            SDEF_STATUS_BAD_ARGUMENT,
            with_skeleton(empty, move |skeleton| skeleton.role_joints = null()),
        ),
        (
            "a role for joint -7",
            SDEF_STATUS_BAD_INPUT,
            with_skeleton(empty, move |skeleton| {
                (skeleton.role_joints, skeleton.role_count) = (wild.as_ptr(), 3)
            }),
        ),
        (
            "a skeleton that weights do not fit",
            SDEF_STATUS_BAD_INPUT,
            with_skeleton(full, move |skeleton| (skeleton.joint_count, skeleton.role_count) = (1, 0)),
        ),
        (
            "no place for info",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe { sdef_character_get_info(full, null_mut(), error) }),
        ),
        (
            "weights of no mesh",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe {
                sdef_character_get_weights(full, 17, 4, null_mut(), null_mut(), 0, error)
            }),
        ),
        (
            "0 influences",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe {
                sdef_character_get_weights(full, 0, 0, null_mut(), null_mut(), 0, error)
            }),
        ),
        (
            "room for 2 vertices' joints",
            SDEF_STATUS_BUFFER_TOO_SMALL,
            Box::new(move |error| unsafe {
                let mut joints = [9; 8];
                sdef_character_get_weights(full, 0, 4, joints.as_mut_ptr(), null_mut(), 2, error)
            }),
        ),
        (
            "room for 2 joints",
            SDEF_STATUS_BUFFER_TOO_SMALL,
            Box::new(move |error| unsafe {
                let mut parents = [9; 2];
                sdef_character_get_joints(
                    full,
                    parents.as_mut_ptr(),
                    null_mut(),
                    null_mut(),
                    null_mut(),
                    2,
                    null_mut(),
                    error,
                )
            }),
        ),
        (
            "rig without meshes",
            SDEF_STATUS_NO_GEOMETRY,
            Box::new(move |error| unsafe { sdef_character_rig(empty, null(), None, null_mut(), error) }),
        ),
        (
            "heat below 0",
            SDEF_STATUS_BAD_OPTION,
            Box::new(move |error| unsafe {
                sdef_character_rig(
                    full,
                    &SdefOptions { rig_heat: -1.0, ..options() },
                    None,
                    null_mut(),
                    error,
                )
            }),
        ),
        (
            "3 voxels",
            SDEF_STATUS_BAD_OPTION,
            Box::new(move |error| unsafe {
                sdef_character_rig(
                    full,
                    &SdefOptions { rig_voxel_resolution: 3, ..options() },
                    None,
                    null_mut(),
                    error,
                )
            }),
        ),
        (
            "a given joint of role 60",
            SDEF_STATUS_BAD_ARGUMENT,
            with_options(full, style, move |o| (o.rig_joints, o.rig_joint_count) = (joint.as_ptr(), 1)),
        ),
        (
            "a given joint at NAN",
            SDEF_STATUS_BAD_OPTION,
            Box::new(move |error| unsafe {
                sdef_character_rig(
                    full,
                    &SdefOptions { rig_joints: &joint[1], rig_joint_count: 1, ..options() },
                    None,
                    null_mut(),
                    error,
                )
            }),
        ),
        (
            "an unknown rule of weights",
            SDEF_STATUS_BAD_ARGUMENT,
            with_options(full, style, move |o| o.rig_weights = 3),
        ),
        (
            "options of size 0",
            SDEF_STATUS_BAD_ARGUMENT,
            with_options(full, style, move |o| o.struct_size = 0),
        ),
        ("an unknown mode", SDEF_STATUS_BAD_ARGUMENT, with_options(full, style, move |o| o.mode = 2)),
        ("an unknown stage", SDEF_STATUS_BAD_ARGUMENT, with_options(full, style, move |o| o.stage = 9)),
        ("limits of 2", SDEF_STATUS_BAD_ARGUMENT, with_options(full, style, move |o| o.limits = 2)),
        ("an unknown curve", SDEF_STATUS_BAD_ARGUMENT, with_options(full, style, move |o| o.face_curve = 3)),
        ("2 rays", SDEF_STATUS_BAD_OPTION, with_options(full, style, move |o| o.rays = 2)),
        (
            "a head of NAN",
            SDEF_STATUS_BAD_OPTION,
            with_options(full, style, move |o| o.head_scale = f64::NAN),
        ),
        ("an amount of 2", SDEF_STATUS_BAD_OPTION, with_options(full, style, move |o| o.amount = 2.0)),
        ("hair of -1", SDEF_STATUS_BAD_OPTION, with_options(full, style, move |o| o.hair_length = -1.0)),
        ("a squash of 11", SDEF_STATUS_BAD_OPTION, with_options(full, style, move |o| o.face_squash = 11.0)),
        ("no groups", SDEF_STATUS_BAD_ARGUMENT, with_options(full, style, move |o| o.group_count = 1)),
        (
            "a group twice",
            SDEF_STATUS_BAD_ARGUMENT,
            with_options(full, style, move |o| (o.groups, o.group_count) = (settings.as_ptr(), 2)),
        ),
        (
            "a group out of range",
            SDEF_STATUS_BAD_OPTION,
            with_options(full, style, move |o| (o.groups, o.group_count) = (&settings[2], 1)),
        ),
        (
            "an unknown group",
            SDEF_STATUS_BAD_OPTION,
            with_options(full, style, move |o| (o.groups, o.group_count) = (unknown, 1)),
        ),
        (
            "a bone of role 77",
            SDEF_STATUS_BAD_ARGUMENT,
            with_options(full, style, move |o| (o.bone_groups, o.bone_group_count) = (bone, 1)),
        ),
        (
            "N heads in paper mode",
            SDEF_STATUS_BAD_OPTION,
            with_options(full, style, move |o| o.mode = SDEF_MODE_PAPER),
        ),
        ("a deformer of nothing", SDEF_STATUS_NO_HUMANOID, with_options(empty, style, move |_| ())),
        ("a deformer of joints alone", SDEF_STATUS_NO_GEOMETRY, with_options(bare, style, move |_| ())),
        (
            "no place for a deformer",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe {
                sdef_deformer_create(full, style, null(), None, null_mut(), null_mut(), error)
            }),
        ),
        (
            "1.7 heads",
            SDEF_STATUS_BAD_OPTION,
            Box::new(|error| unsafe {
                sdef_style_from_heads(1.7, SdefStyle::default(), &mut SdefStyle::default(), error)
            }),
        ),
        (
            "NAN heads",
            SDEF_STATUS_BAD_OPTION,
            Box::new(|error| unsafe {
                sdef_style_from_heads(f64::NAN, SdefStyle::default(), &mut SdefStyle::default(), error)
            }),
        ),
        ("a style of no text", SDEF_STATUS_BAD_STYLE, make_style("")),
        ("a style that is none", SDEF_STATUS_BAD_STYLE, make_style("sd5")),
        ("a style of broken text", SDEF_STATUS_BAD_STYLE, make_style("{\"superdeform_style\": ")),
        (
            "a style of a later version",
            SDEF_STATUS_BAD_STYLE,
            make_style("{\"superdeform_style\": 99, \"head_length\": 1.0, \"bones\": {}}"),
        ),
        (
            "a style that is no UTF-8",
            SDEF_STATUS_BAD_STYLE,
            Box::new(|error| unsafe {
                let text = b"{\xFF}";
                sdef_style_from_text(text.as_ptr().cast(), text.len(), &mut SdefStyle::default(), error)
            }),
        ),
        (
            "a style of NULL",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(|error| unsafe { sdef_style_from_text(null(), 5, &mut SdefStyle::default(), error) }),
        ),
        (
            "a wild text",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(|error| unsafe {
                sdef_style_from_text(dangling(), usize::MAX, &mut SdefStyle::default(), error)
            }),
        ),
        (
            "a style of the empty character",
            SDEF_STATUS_NO_HUMANOID,
            Box::new(move |error| unsafe {
                sdef_style_measure(empty, null(), null(), &mut SdefStyle::default(), error)
            }),
        ),
        (
            "a style of no numbers",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(|error| unsafe {
                sdef_style_from_numbers(null(), null(), null(), 0, &mut SdefStyle::default(), error)
            }),
        ),
        ("a leg of 0", SDEF_STATUS_BAD_STYLE, numbers(|n| n.leg = 0.0)),
        ("a head of 0", SDEF_STATUS_BAD_STYLE, numbers(|n| n.bone_head_length = 0.0)),
        (
            "a bone to 56",
            SDEF_STATUS_BAD_ARGUMENT,
            bones([SdefBone { end: 56, reserved: 0, length: 1.0, radius: 1.0 }; 2]),
        ),
        (
            "a bone twice",
            SDEF_STATUS_BAD_STYLE,
            bones([SdefBone { end: 55, reserved: 0, length: 1.0, radius: 1.0 }; 2]),
        ),
        (
            "a bone of length -1",
            SDEF_STATUS_BAD_STYLE,
            bones([
                SdefBone { end: 55, reserved: 0, length: 1.0, radius: 1.0 },
                SdefBone { end: 5, reserved: 0, length: -1.0, radius: 1.0 },
            ]),
        ),
        (
            "a blend of 11",
            SDEF_STATUS_BAD_OPTION,
            Box::new(move |error| unsafe {
                sdef_style_blend(other, other, 11.0, &mut SdefStyle::default(), error)
            }),
        ),
        (
            "a blend with N heads",
            SDEF_STATUS_BAD_STYLE,
            Box::new(move |error| unsafe {
                sdef_style_blend(other, style, 0.5, &mut SdefStyle::default(), error)
            }),
        ),
        (
            "N heads as JSON",
            SDEF_STATUS_BAD_STYLE,
            Box::new(move |error| unsafe { sdef_style_to_json(style, null_mut(), 0, null_mut(), error) }),
        ),
        (
            "a short text",
            SDEF_STATUS_BUFFER_TOO_SMALL,
            Box::new(move |error| unsafe {
                let mut text = [0; 10];
                sdef_style_to_json(other, text.as_mut_ptr(), 10, null_mut(), error)
            }),
        ),
        ("results of another size", SDEF_STATUS_BAD_ARGUMENT, result(|mesh| mesh.struct_size = 40)),
        ("room for 5 vertices", SDEF_STATUS_BUFFER_TOO_SMALL, result(|mesh| mesh.vertex_capacity = 5)),
        (
            "room for 1 morph target",
            SDEF_STATUS_BUFFER_TOO_SMALL,
            result(|mesh| mesh.morph_target_capacity = 1),
        ),
        ("a result stride of 8", SDEF_STATUS_BAD_ARGUMENT, result(|mesh| mesh.normal_stride = 8)),
        (
            "results for no mesh",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe { sdef_deformer_apply(made, null(), 0, None, null_mut(), error) }),
        ),
        (
            "results of NULL",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe { sdef_deformer_apply(made, null(), 3, None, null_mut(), error) }),
        ),
        (
            "an unknown curve of the face",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe { sdef_deformer_set_face(made, 1.0, 3, error) }),
        ),
        (
            "a squash of -11",
            SDEF_STATUS_BAD_OPTION,
            Box::new(move |error| unsafe { sdef_deformer_set_face(made, -11.0, 0, error) }),
        ),
        (
            "a point of joint 4000000000",
            SDEF_STATUS_BAD_INPUT,
            Box::new(move |error| unsafe {
                let point = [0.0; 3];
                sdef_deformer_map_points(
                    made,
                    high.as_ptr(),
                    point.as_ptr(),
                    1,
                    null_mut(),
                    null_mut(),
                    null_mut(),
                    error,
                )
            }),
        ),
        (
            "a point at NAN",
            SDEF_STATUS_BAD_INPUT,
            Box::new(move |error| unsafe {
                sdef_deformer_map_points(
                    made,
                    zeros.as_ptr(),
                    nan_matrix.as_ptr(),
                    1,
                    null_mut(),
                    null_mut(),
                    null_mut(),
                    error,
                )
            }),
        ),
        (
            "room for 1 joint",
            SDEF_STATUS_BUFFER_TOO_SMALL,
            Box::new(move |error| unsafe {
                let mut place = [0.0; 3];
                sdef_deformer_get_joints(made, place.as_mut_ptr(), null_mut(), 1, null_mut(), error)
            }),
        ),
        (
            "room for 1 group",
            SDEF_STATUS_BUFFER_TOO_SMALL,
            Box::new(move |error| unsafe {
                let mut group = zeroed::<SdefGroup>();
                sdef_deformer_get_groups(made, &mut group, 1, null_mut(), error)
            }),
        ),
        (
            "a report of size 0",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(move |error| unsafe {
                let mut report = zeroed::<SdefReport>();
                sdef_deformer_get_report(made, &mut report, null_mut(), 0, null_mut(), error)
            }),
        ),
        (
            "no place for options",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(|error| unsafe { sdef_options_init(null_mut(), 200, error) }),
        ),
        (
            "options of size 3",
            SDEF_STATUS_BAD_ARGUMENT,
            Box::new(|error| unsafe { sdef_options_init(&mut options(), 3, error) }),
        ),
        (
            "a handle that is none",
            SDEF_STATUS_BAD_HANDLE,
            Box::new(|error| unsafe { sdef_character_get_info(SdefCharacter { id: 0 }, null_mut(), error) }),
        ),
        (
            "a handle that is made up",
            SDEF_STATUS_BAD_HANDLE,
            Box::new(|error| unsafe { sdef_destroy(42, error) }),
        ),
        (
            "a style for a character",
            SDEF_STATUS_BAD_HANDLE,
            Box::new(move |error| unsafe {
                sdef_character_get_info(SdefCharacter { id: style.id }, null_mut(), error)
            }),
        ),
        (
            "a progress that stops",
            SDEF_STATUS_CANCELLED,
            Box::new(move |error| unsafe {
                sdef_deformer_create(
                    full,
                    style,
                    null(),
                    Some(stop),
                    null_mut(),
                    &mut SdefDeformer::default(),
                    error,
                )
            }),
        ),
    ];
    let (mut produced, mut wrong) = (BTreeSet::new(), Vec::new());
    for (what, status, call) in &cases {
        let name = unsafe { CStr::from_ptr(sdef_status_name(*status)) }.to_str().unwrap();
        match ask(call) {
            Err(told) if told.status == *status => {
                println!("{what}: {name}: {}", told.message);
                for word in ["--", "panicked", "unwrap", "index out of bounds"] {
                    if told.message.contains(word) {
                        wrong.push(format!("{what}: a host does not know {word}: {}", told.message));
                    }
                }
                produced.insert(told.status);
            }
            other => wrong.push(format!("{what}: {name} is wanted, but there is {other:?}")),
        }
        if call(null_mut()) != *status {
            wrong.push(format!("{what}: another status without a struct for the error"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // OK, BUSY, OUT_OF_MEMORY and INTERNAL are produced by tests of their own.
    assert_eq!(produced.len(), 9);
    for id in [full.id, empty.id, bare.id, style.id, other.id, made.id] {
        destroy(id);
    }
}

unsafe extern "C" fn stop(_user: *mut c_void, _fraction: f32) -> i32 {
    1
}
