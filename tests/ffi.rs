//! The C ABI, called as a C host would: every function, every status, every sentence.
// A host in C has nothing else.
#![allow(unsafe_code)]

#[path = "common/abi.rs"]
mod abi;
#[path = "ffi/mistakes.rs"]
mod mistakes;
#[path = "common/models.rs"]
mod models;
#[path = "common/people.rs"]
mod people;

use abi::*;
use glam::{DVec3, Vec3};
use people::Person;
use std::collections::BTreeSet;
use std::ffi::{CStr, CString, c_void};
use std::ptr::{null, null_mut};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock, PoisonError, RwLock, RwLockReadGuard};
use superdeform::internals::ffi::all_at_once::*;
use superdeform::internals::ffi::basics::*;
use superdeform::internals::ffi::character::*;
use superdeform::internals::ffi::deformer::*;
use superdeform::internals::ffi::lifetime::*;
use superdeform::internals::ffi::options::*;
use superdeform::internals::ffi::rig::*;
use superdeform::internals::ffi::style_handle::*;
use superdeform::internals::shape::Measured;
use superdeform::{
    BodyShape, Character, Deformer, FaceCurve, GroupSettings, Height, Humanoid, Mode, MorphTarget, Options,
    Repair, Rig, RigOptions, Role, Stage, Style, find_roles,
};

/// Held by every test, so that one can wait until no other is at work and count the handles that are left.
static AT_WORK: RwLock<()> = RwLock::new(());

fn at_work() -> RwLockReadGuard<'static, ()> {
    AT_WORK.read().unwrap_or_else(PoisonError::into_inner)
}

/// A person with everything that a mesh can have.
fn person() -> &'static Character {
    static PERSON: OnceLock<Character> = OnceLock::new();
    PERSON.get_or_init(|| dressed(Person { columns: 12, skirt: true, eyes: true, ..Person::adult() }))
}

fn dressed(person: Person) -> Character {
    let mut character = person.build();
    for mesh in &mut character.meshes {
        let count = mesh.positions.len();
        let wave = |vertex: usize, phase: f32| (vertex as f32 * 0.7 + phase).sin();
        mesh.normals = (0..count)
            .map(|v| Vec3::new(wave(v, 0.0), wave(v, 1.0), 0.1 + wave(v, 2.0)).normalize_or(Vec3::Y))
            .collect();
        mesh.tangents = mesh
            .normals
            .iter()
            .enumerate()
            .map(|(v, normal)| normal.any_orthonormal_vector().extend(if v % 2 == 0 { 1.0 } else { -1.0 }))
            .collect();
        let some = |v: usize, phase: f32| {
            if v.is_multiple_of(3) { Vec3::ZERO } else { Vec3::splat(0.01 * wave(v, phase)) }
        };
        mesh.morph_targets = vec![
            MorphTarget {
                name: "smile".to_string(),
                positions: (0..count).map(|v| some(v, 0.3)).collect(),
                normals: (0..count).map(|v| some(v, 0.5)).collect(),
                tangents: (0..count).map(|v| some(v, 0.9)).collect(),
            },
            MorphTarget { positions: (0..count).map(|v| some(v, 0.1)).collect(), ..MorphTarget::default() },
        ];
    }
    character
}

fn library_deformer(character: &Character, style: &Style, options: &Options) -> Deformer {
    Deformer::new(Arc::new(character.clone()), style, options).unwrap()
}

/// The bits that the library itself makes.
fn expected(character: &Character, style: &Style, options: &Options) -> Vec<u32> {
    room(character).bits_of(&library_deformer(character, style, options).apply())
}

/// The bits that come through the ABI.
fn deformed(deformer: SdefDeformer, character: &Character) -> Vec<u32> {
    let mut room = room(character);
    room.apply(deformer).unwrap();
    room.bits()
}

/// Three characters: a made one, and two real ones where they are at hand.
fn three() -> Vec<(&'static str, &'static Character)> {
    let mut all = vec![("person", person())];
    for name in ["quaternius_female_dress.glb", "godette.vrm", "kaykit_rogue.glb"] {
        if let Some(loaded) = models::model(name) {
            all.push((name, &loaded.character));
        }
    }
    all.truncate(3);
    all
}

#[test]
fn results_are_those_of_the_library_for_any_number_of_threads_and_on_every_run() {
    let _at_work = at_work();
    for (name, character) in three() {
        let style = of_heads(2.5);
        let expected = expected(character, &Style::Heads(2.5), &Options::default());
        for (threads, runs) in [(1, 8), (2, 6), (8, 6)] {
            let handle = given(character);
            let deformer = deformer(handle, style, &with_threads(threads));
            for run in 0..runs {
                assert!(deformed(deformer, character) == expected, "{name}: {threads} threads, run {run}");
            }
            destroy(handle.id);
            destroy(deformer.id);
        }
        destroy(style.id);
    }
}

#[test]
fn joints_points_and_groups_are_those_of_the_library() {
    let _at_work = at_work();
    let character = person();
    let (handle, style) = (given(character), from_text("sd2.5").unwrap());
    let made = deformer(handle, style, &options());
    let shape = Style::Shape(Box::new(BodyShape::built_in("sd2.5").unwrap()));
    let library = library_deformer(character, &shape, &Options::default());

    let (positions, binds) = joints_of(made);
    assert_eq!(positions, library.apply().joints);
    for (index, (joint, bind)) in character.skeleton.joints.iter().zip(&binds).enumerate() {
        let mut rest = joint.rest;
        rest.w_axis = positions[index].extend(1.0);
        let product = rest * glam::DMat4::from_cols_array(bind);
        assert!(product.abs_diff_eq(glam::DMat4::IDENTITY, 1e-12), "joint {index}");
    }

    let joints: Vec<u32> = (0..character.skeleton.joints.len() as u32).collect();
    let points: Vec<DVec3> = character
        .skeleton
        .joints
        .iter()
        .map(|joint| joint.position() + DVec3::new(0.01, 0.02, 0.03))
        .collect();
    let count = points.len();
    let (mut mapped, mut scales, mut jacobians) =
        (vec![DVec3::NAN; count], vec![f64::NAN; count], vec![[f64::NAN; 9]; count]);
    ask(|error| unsafe {
        sdef_deformer_map_points(
            made,
            joints.as_ptr(),
            points.as_ptr().cast(),
            count,
            mapped.as_mut_ptr().cast(),
            scales.as_mut_ptr(),
            jacobians.as_mut_ptr().cast(),
            error,
        )
    })
    .unwrap();
    for index in 0..count {
        let wanted = library.map(index, points[index]);
        assert_eq!(mapped[index], wanted.position);
        assert_eq!(scales[index], wanted.local_scale());
        assert_eq!(jacobians[index], wanted.jacobian.to_cols_array());
    }

    let mut group_count = 0;
    ask(|error| unsafe { sdef_deformer_get_groups(made, null_mut(), 0, &mut group_count, error) }).unwrap();
    let mut groups = vec![SdefGroup { struct_size: size_of::<SdefGroup>() as u32, ..zeroed() }; group_count];
    ask(|error| unsafe {
        sdef_deformer_get_groups(made, groups.as_mut_ptr(), group_count, null_mut(), error)
    })
    .unwrap();
    let shapes = library.group_shapes(&library.target().shape);
    for group in &groups {
        let name = unsafe { CStr::from_ptr(group.name.as_ptr()) }.to_str().unwrap();
        if let Some(coefficient) = library.coefficients().get(name) {
            assert_eq!(group.length_scale, coefficient.length_scale);
            assert_eq!(group.thickness_scale, coefficient.thickness_scale);
        }
        match shapes.get(name) {
            Some(shape) => assert_eq!(group.target_length, shape.length),
            None => assert!(group.target_length.is_nan(), "{name}"),
        }
    }
    let names: BTreeSet<&String> = shapes.keys().chain(library.coefficients().keys()).collect();
    assert_eq!(groups.len(), names.len());
    for id in [handle.id, style.id, made.id] {
        destroy(id);
    }
}

#[test]
fn a_name_counts_where_the_mesh_lies_as_it_says() {
    let _at_work = at_work();
    let deformed_as = |name: &CStr, kind: u32| {
        let handle = create();
        let skeleton = c_skeleton(person());
        ask(|error| unsafe { sdef_character_set_skeleton(handle, &skeleton.skeleton, error) }).unwrap();
        for (index, mesh) in person().meshes.iter().enumerate() {
            let mut given = c_mesh(mesh);
            if index == 0 {
                (given.mesh.name, given.mesh.kind) = (name.as_ptr(), kind);
            }
            ask(|error| unsafe { sdef_character_add_mesh(handle, &given.mesh, null_mut(), error) }).unwrap();
        }
        let style = of_heads(2.5);
        let made = deformer(handle, style, &options());
        let joints = joints_of(made).0;
        for id in [handle.id, style.id, made.id] {
            destroy(id);
        }
        joints
    };
    // The first mesh is the whole body, which is no hair, whatever its material is called.
    let body = deformed_as(c"Person", SDEF_MESH_BODY);
    assert_eq!(deformed_as(c"Node/Person/Hair", SDEF_MESH_UNKNOWN), body);
    assert_ne!(deformed_as(c"Node/Person/Hair", SDEF_MESH_HAIR), body);
}

#[test]
fn the_report_is_the_library_s() {
    let _at_work = at_work();
    let character = person();
    let (handle, style) = (given(character), from_text("sd3").unwrap());
    let made = deformer(handle, style, &options());
    let shape = Style::Shape(Box::new(BodyShape::built_in("sd3").unwrap()));
    let library = library_deformer(character, &shape, &Options::default());
    let wanted = library.report(&library.apply()).unwrap();
    let mut report = SdefReport { struct_size: size_of::<SdefReport>() as u32, ..zeroed() };
    ask(|error| unsafe { sdef_deformer_get_report(made, &mut report, null_mut(), 0, null_mut(), error) })
        .unwrap();
    assert_eq!(report.struct_size as usize, size_of::<SdefReport>());
    let result = figure(made, SDEF_FIGURE_RESULT);
    assert_eq!(figure(made, SDEF_FIGURE_TARGET).heads, wanted.target.heads);
    assert_eq!((result.heads, result.sole), (wanted.result.heads, wanted.result.landmarks.sole));
    let reference = wanted.reference.as_ref().unwrap();
    assert_eq!(figure(made, SDEF_FIGURE_REFERENCE).head_length, reference.head_length);
    assert_eq!((report.head_ratio, report.rig_made, report.unreached_vertices), (wanted.g, 0, 0));
    let json =
        text(|t, c, s, e| unsafe { sdef_deformer_get_report(made, null_mut(), t.cast(), c, s, e) }).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["result"]["heads"].as_f64().unwrap(), wanted.result.heads);
    assert_eq!(json["counts"]["vertices"].as_u64().unwrap() as usize, character.vertex_count());
    // A change gives another report.
    let flat = SdefOptions { amount: 0.0, ..options() };
    ask(|error| unsafe { sdef_deformer_set_options(made, &flat, None, null_mut(), error) }).unwrap();
    let [before, after] = [SDEF_FIGURE_TARGET, SDEF_FIGURE_RESULT].map(|which| figure(made, which));
    assert!((after.heads - before.heads).abs() < 1e-9);
    for id in [handle.id, style.id, made.id] {
        destroy(id);
    }
}

#[test]
fn options_that_are_set_later_give_what_a_new_deformer_gives() {
    let _at_work = at_work();
    let group = CString::new("upper_leg").unwrap();
    let own = CString::new("my thighs").unwrap();
    let settings = [SdefGroupSettings { length_scale: 0.8, ..group_settings(&group) }];
    let bones = [bone_group(SDEF_ROLE_LEFT_LOWER_LEG, &own), bone_group(SDEF_ROLE_RIGHT_LOWER_LEG, &own)];
    let plain = options();
    let changes: Vec<(&str, SdefOptions, Options)> = vec![
        ("nothing", plain, Options::default()),
        ("amount", SdefOptions { amount: 0.4, ..plain }, Options { amount: 0.4, ..Options::default() }),
        ("none", SdefOptions { amount: 0.0, ..plain }, Options { amount: 0.0, ..Options::default() }),
        (
            "sphere",
            SdefOptions { face_squash: 1.5, face_curve: SDEF_FACE_CURVE_SPHERE, ..plain },
            Options { face_squash: Some(1.5), face_curve: FaceCurve::Sphere, ..Options::default() },
        ),
        (
            "face",
            SdefOptions { face_squash: 1.2, face_curve: SDEF_FACE_CURVE_F2, amount: 0.7, ..plain },
            Options { face_squash: Some(1.2), face_curve: FaceCurve::F2, amount: 0.7, ..Options::default() },
        ),
        ("head", SdefOptions { head_scale: 1.2, ..plain }, Options { head_scale: 1.2, ..Options::default() }),
        ("rays", SdefOptions { rays: 7, ..plain }, Options { rays: Some(7), ..Options::default() }),
        (
            "repair",
            SdefOptions { repair: SDEF_REPAIR_OFF, ..plain },
            Options { repair: Repair::Off, ..Options::default() },
        ),
        ("limits", SdefOptions { limits: 0, ..plain }, Options { limits: false, ..Options::default() }),
        (
            "youth",
            SdefOptions { youth: 0.4, youth_nose: 0.2, smile: 0.3, seat: 0.6, hair_lay: 0.1, ..plain },
            Options {
                youth: 0.4,
                youth_nose: 0.2,
                smile: 0.3,
                seat: 0.6,
                hair_lay: 0.1,
                ..Options::default()
            },
        ),
        (
            "features",
            SdefOptions {
                youth_eye: 0.1,
                youth_lower: 0.2,
                youth_cheek: 0.3,
                youth_jaw: 0.4,
                youth_skull: 0.5,
                youth_ear: 0.6,
                ..plain
            },
            Options {
                youth_eye: 0.1,
                youth_lower: 0.2,
                youth_cheek: 0.3,
                youth_jaw: 0.4,
                youth_skull: 0.5,
                youth_ear: 0.6,
                ..Options::default()
            },
        ),
        (
            "stage",
            SdefOptions { stage: SDEF_STAGE_LENGTH, hair_length: 0.3, ..plain },
            Options { stage: Stage::Length, hair_length: 0.3, ..Options::default() },
        ),
        (
            "kept height",
            SdefOptions { height: 0.0, amount: 0.7, ..plain },
            Options { height: Height::Keep, amount: 0.7, ..Options::default() },
        ),
        (
            "height",
            SdefOptions { height: 0.25, ..plain },
            Options { height: Height::Units(0.25), ..Options::default() },
        ),
        (
            "groups",
            SdefOptions { groups: settings.as_ptr(), group_count: 1, ..plain },
            Options {
                groups: [(
                    "upper_leg".to_string(),
                    GroupSettings { length_scale: Some(0.8), ..GroupSettings::default() },
                )]
                .into(),
                ..Options::default()
            },
        ),
        (
            "paper",
            SdefOptions {
                mode: SDEF_MODE_PAPER,
                bone_groups: bones.as_ptr(),
                bone_group_count: 2,
                amount: 0.9,
                ..plain
            },
            Options {
                mode: Mode::Paper,
                bone_groups: [Role::LeftLowerLeg, Role::RightLowerLeg]
                    .map(|role| (role, "my thighs".to_string()))
                    .into(),
                amount: 0.9,
                ..Options::default()
            },
        ),
    ];
    let character = person();
    let shape = BodyShape::built_in("sd2.5").unwrap();
    let (handle, style) = (given(character), from_text("sd2.5").unwrap());
    let later = deformer(handle, style, &plain);
    // There and back again, so that each follows another.
    for (name, options, library) in changes.iter().chain(changes.iter().rev()) {
        ask(|error| unsafe { sdef_deformer_set_options(later, options, None, null_mut(), error) }).unwrap();
        let wanted = library_deformer(character, &Style::Shape(Box::new(shape.clone())), library);
        assert!(deformed(later, character) == room(character).bits_of(&wanted.apply()), "{name}");
        let lines: String = wanted
            .warnings()
            .iter()
            .map(|warning| format!("{}: {}\n", warning.code, warning.message))
            .collect();
        let warned = text(|t, c, s, e| unsafe { sdef_get_warnings(later.id, t.cast(), c, s, e) }).unwrap();
        let codes =
            |lines: &str| lines.lines().map(|l| l.split(':').next().unwrap().to_string()).collect::<Vec<_>>();
        assert_eq!(codes(&warned), codes(&lines), "{name}");
    }
    // A change that is refused changes nothing.
    ask(|error| unsafe { sdef_deformer_set_options(later, null(), None, null_mut(), error) }).unwrap();
    let before = deformed(later, character);
    let bad = SdefOptions { amount: 2.0, ..plain };
    let refused = ask(|error| unsafe { sdef_deformer_set_options(later, &bad, None, null_mut(), error) });
    assert_eq!(refused.unwrap_err().status, SDEF_STATUS_BAD_OPTION);
    assert!(deformed(later, character) == before);
    for id in [handle.id, style.id, later.id] {
        destroy(id);
    }
}

#[test]
fn a_style_set_later_gives_what_a_style_set_first_gives() {
    let (character, options) = (person(), options());
    let (handle, first, second) = (given(character), from_text("sd2.5").unwrap(), from_text("sd4").unwrap());
    let (later, wanted) = (deformer(handle, first, &options), deformer(handle, second, &options));
    let set = |style| ask(|error| unsafe { sdef_deformer_set_style(later, style, None, null_mut(), error) });
    set(second).unwrap();
    assert!(deformed(later, character) == deformed(wanted, character));
    let refused = set(SdefStyle { id: later.id }).unwrap_err();
    assert_eq!(refused.status, SDEF_STATUS_BAD_HANDLE);
    assert!(deformed(later, character) == deformed(wanted, character));
    for id in [handle.id, first.id, second.id, later.id, wanted.id] {
        destroy(id);
    }
}

/// The same mesh in every shape that arrays can come in.
/// All numbers of a result, in order.
fn numbers(character: &Character) -> Vec<f32> {
    let result = library_deformer(character, &Style::Heads(2.5), &Options::default()).apply();
    let vectors = result.meshes.iter().flat_map(|mesh| {
        let tangents = mesh.tangents.iter().map(|tangent| tangent.truncate());
        let targets = mesh.morph_targets.iter();
        let changes = targets.flat_map(|t| t.positions.iter().chain(&t.normals).chain(&t.tangents).copied());
        mesh.positions.iter().chain(&mesh.normals).copied().chain(tangents).chain(changes)
    });
    vectors.flat_map(|v| v.to_array()).collect()
}

fn is_near(one: &[f32], other: &[f32]) {
    assert_eq!(one.len(), other.len());
    for (index, (one, other)) in one.iter().zip(other).enumerate() {
        assert!((one - other).abs() < 1e-5, "number {index}: {one} and {other}");
    }
}

#[test]
fn normals_and_tangents_of_any_length_give_what_unit_vectors_give() {
    let mut long = person().clone();
    for mesh in &mut long.meshes {
        mesh.normals.iter_mut().for_each(|normal| *normal *= 3.0);
        mesh.tangents.iter_mut().for_each(|tangent| *tangent = (tangent.truncate() * 3.0).extend(tangent.w));
        for target in &mut mesh.morph_targets {
            target.normals.iter_mut().chain(&mut target.tangents).for_each(|delta| *delta *= 3.0);
        }
    }
    is_near(&numbers(person()), &numbers(&long));
}

#[test]
fn a_vertex_whose_weights_are_all_0_moves_with_the_hips() {
    let hips = person().humanoid.joint(Role::Hips).unwrap() as u32;
    let [none, of_hips] = [vec![], vec![(hips, 1.0)]].map(|row: Vec<(u32, f32)>| {
        let mut character = person().clone();
        for mesh in &mut character.meshes {
            let rows = mesh.weights.rows().enumerate();
            mesh.weights = superdeform::Weights::from_rows(
                rows.map(|(vertex, own)| if vertex % 7 == 0 { row.clone() } else { own.to_vec() }),
            );
        }
        character
    });
    is_near(&numbers(&of_hips), &numbers(&none));
}

#[test]
fn strides_and_types_change_nothing() {
    let _at_work = at_work();
    let mut character = person().clone();
    character.meshes.truncate(1);
    let mesh = &mut character.meshes[0];
    mesh.morph_targets.clear();
    // Few enough joints and vertices for bytes, and weights that bytes can hold.
    let count = mesh.positions.len();
    assert!(count < 65536);
    let rows: Vec<Vec<(u32, f32)>> = mesh
        .weights
        .rows()
        .map(|row| match row {
            [(a, _), (b, _), ..] => vec![(*a, 51.0 / 255.0), (*b, 204.0 / 255.0)],
            row => row.iter().map(|&(joint, _)| (joint, 1.0)).collect(),
        })
        .collect();
    mesh.weights = superdeform::Weights::from_rows(rows.clone());
    let mesh = &character.meshes[0];
    let style = of_heads(3.0);
    let wanted = expected(&character, &Style::Heads(3.0), &Options::default());

    const WIDTH: usize = 5;
    let fixed = |of: &dyn Fn(&(u32, f32)) -> f32| -> Vec<f32> {
        rows.iter()
            .flat_map(|row| (0..WIDTH).map(|i| row.get(i).map_or(0.0, of)).collect::<Vec<_>>())
            .collect()
    };
    // What weight 0 names is nobody's business.
    let joints: Vec<u32> = rows
        .iter()
        .flat_map(|row| (0..WIDTH).map(|i| row.get(i).map_or(250, |e| e.0)).collect::<Vec<_>>())
        .collect();
    let weights = fixed(&|entry| entry.1);
    // One interleaved buffer, not aligned: 1 byte, then position, normal, tangent, joints as bytes, weights as bytes.
    let stride = 1 + 12 + 12 + 16 + WIDTH + WIDTH;
    let mut buffer = vec![0xAAu8; 1 + count * stride];
    for vertex in 0..count {
        let mut at = 1 + vertex * stride;
        let numbers = mesh.positions[vertex]
            .to_array()
            .into_iter()
            .chain(mesh.normals[vertex].to_array())
            .chain(mesh.tangents[vertex].to_array());
        for number in numbers {
            buffer[at..at + 4].copy_from_slice(&number.to_ne_bytes());
            at += 4;
        }
        for i in 0..WIDTH {
            buffer[at + i] = joints[vertex * WIDTH + i] as u8;
            buffer[at + WIDTH + i] = (weights[vertex * WIDTH + i] * 255.0).round() as u8;
        }
    }
    let start = unsafe { buffer.as_ptr().add(1) };
    let at = |offset: usize| unsafe { start.add(offset) };
    let shorts: Vec<u16> = mesh.triangles.iter().flatten().map(|&vertex| vertex as u16).collect();
    let short_joints: Vec<u16> = joints.iter().map(|&joint| joint as u16).collect();
    let short_weights: Vec<u16> = weights.iter().map(|weight| (weight * 65535.0).round() as u16).collect();
    let base = c_mesh(mesh);
    let cases = [
        ("rows", base.mesh),
        (
            "fixed",
            SdefMesh {
                influence_count: WIDTH,
                joints: joints.as_ptr().cast(),
                weights: weights.as_ptr().cast(),
                row_starts: null(),
                ..base.mesh
            },
        ),
        (
            "fixed shorts",
            SdefMesh {
                index_type: SDEF_TYPE_U16,
                indices: shorts.as_ptr().cast(),
                influence_count: WIDTH,
                joint_type: SDEF_TYPE_U16,
                joints: short_joints.as_ptr().cast(),
                weight_type: SDEF_TYPE_U16,
                weights: short_weights.as_ptr().cast(),
                row_starts: null(),
                ..base.mesh
            },
        ),
        (
            "interleaved",
            SdefMesh {
                positions: at(0).cast(),
                position_stride: stride,
                normals: at(12).cast(),
                normal_stride: stride,
                tangents: at(24).cast(),
                tangent_stride: stride,
                influence_count: WIDTH,
                joint_type: SDEF_TYPE_U8,
                joints: at(40).cast(),
                joint_stride: stride,
                weight_type: SDEF_TYPE_U8,
                weights: at(40 + WIDTH).cast(),
                weight_stride: stride,
                row_starts: null(),
                ..base.mesh
            },
        ),
    ];
    for (name, mesh) in cases {
        let handle = create();
        let skeleton = c_skeleton(&character);
        ask(|error| unsafe { sdef_character_set_skeleton(handle, &skeleton.skeleton, error) }).unwrap();
        ask(|error| unsafe { sdef_character_add_mesh(handle, &mesh, null_mut(), error) }).unwrap();
        let made = deformer(handle, style, &options());
        assert!(deformed(made, &character) == wanted, "{name}");
        destroy(handle.id);
        destroy(made.id);
    }
    // Results into one interleaved buffer.
    let handle = given(&character);
    let made = deformer(handle, style, &options());
    let stride = 48;
    let mut out = vec![0xAAu8; count * stride + 3];
    let place = unsafe { out.as_mut_ptr().add(3) };
    let result = SdefMeshResult {
        struct_size: size_of::<SdefMeshResult>() as u32,
        vertex_capacity: count,
        positions: place.cast(),
        position_stride: stride,
        normals: unsafe { place.add(12) }.cast(),
        normal_stride: stride,
        tangents: unsafe { place.add(24) }.cast(),
        tangent_stride: stride,
        ..zeroed()
    };
    ask(|error| unsafe { sdef_deformer_apply(made, &result, 1, None, null_mut(), error) }).unwrap();
    let read = |vertex: usize, number: usize| {
        let at = 3 + vertex * stride + 4 * number;
        u32::from_ne_bytes(out[at..at + 4].try_into().unwrap())
    };
    let mut bits = Vec::new();
    for numbers in [0..3, 3..6, 6..10] {
        bits.extend(
            (0..count)
                .flat_map(|vertex| numbers.clone().map(move |number| (vertex, number)))
                .map(|(v, n)| read(v, n)),
        );
    }
    assert!(bits == wanted);
    assert!((0..count).all(|vertex| read(vertex, 10) == 0xAAAA_AAAA && read(vertex, 11) == 0xAAAA_AAAA));
    for id in [handle.id, made.id, style.id] {
        destroy(id);
    }
}

#[test]
fn a_character_comes_back_as_it_was_given() {
    let _at_work = at_work();
    let character = person();
    let handle = given(character);
    let mut info = SdefCharacterInfo { struct_size: size_of::<SdefCharacterInfo>() as u32, ..zeroed() };
    ask(|error| unsafe { sdef_character_get_info(handle, &mut info, error) }).unwrap();
    assert_eq!(info.mesh_count as usize, character.meshes.len());
    assert_eq!(info.joint_count as usize, character.skeleton.joints.len());
    assert_eq!((info.own_joint_count, info.rig_made), (info.joint_count, 0));
    assert_eq!(info.vertex_count as usize, character.vertex_count());
    assert_eq!(info.triangle_count as usize, character.triangle_count());
    assert_eq!(info.morph_target_count as usize, 2 * character.meshes.len());

    let count = character.skeleton.joints.len();
    let (mut parents, mut roles, mut rests, mut sure) =
        (vec![9; count], vec![9; count], vec![[0.0; 16]; count], vec![9.0; count]);
    let mut found = 0;
    ask(|error| unsafe {
        sdef_character_get_joints(
            handle,
            parents.as_mut_ptr(),
            roles.as_mut_ptr(),
            rests.as_mut_ptr().cast(),
            sure.as_mut_ptr(),
            count,
            &mut found,
            error,
        )
    })
    .unwrap();
    assert_eq!(found, count);
    for (index, joint) in character.skeleton.joints.iter().enumerate() {
        assert_eq!(parents[index], joint.parent.map_or(-1, |parent| parent as i32));
        assert_eq!(rests[index], joint.rest.to_cols_array());
        let role = Role::from_number(roles[index] as usize);
        assert_eq!(role.and_then(|role| character.humanoid.joint(role)), role.map(|_| index));
        assert_eq!(sure[index], 1.0);
    }
    for (index, mesh) in character.meshes.iter().enumerate() {
        for most in [1, 4, 7] {
            let rows = mesh.positions.len();
            let (mut joints, mut weights) = (vec![99; rows * most], vec![9.0; rows * most]);
            ask(|error| unsafe {
                sdef_character_get_weights(
                    handle,
                    index as u32,
                    most as u32,
                    joints.as_mut_ptr(),
                    weights.as_mut_ptr(),
                    rows,
                    error,
                )
            })
            .unwrap();
            let limited = mesh.weights.limited(most);
            for vertex in 0..rows {
                for i in 0..most {
                    let entry = limited.row(vertex).get(i).copied().unwrap_or((0, 0.0));
                    assert_eq!((joints[vertex * most + i], weights[vertex * most + i]), entry);
                }
            }
        }
    }
    destroy(handle.id);
}

#[test]
fn roles_that_are_not_given_are_found_from_names() {
    let _at_work = at_work();
    let mut character = person().clone();
    for (role, joint) in person().humanoid.iter() {
        character.skeleton.joints[joint].name = role.to_string();
    }
    character.humanoid = Humanoid::default();
    let (found, _) = find_roles(&character.skeleton, &character.meshes, character.axes.up);
    assert!(found.missing().is_empty());
    let handle = given(&character);
    let count = character.skeleton.joints.len();
    let mut roles = vec![9; count];
    ask(|error| unsafe {
        sdef_character_get_joints(
            handle,
            null_mut(),
            roles.as_mut_ptr(),
            null_mut(),
            null_mut(),
            count,
            null_mut(),
            error,
        )
    })
    .unwrap();
    for (role, joint) in found.iter() {
        assert_eq!(roles[joint], role as u32);
    }
    destroy(handle.id);
}

#[test]
fn styles_come_back_as_text_and_as_numbers() {
    let _at_work = at_work();
    let json = |style: SdefStyle| text(|t, c, s, e| unsafe { sdef_style_to_json(style, t.cast(), c, s, e) });
    let character = given(person());
    let mut measured = SdefStyle::default();
    let name = CString::new("身長").unwrap();
    ask(|error| unsafe { sdef_style_measure(character, name.as_ptr(), null(), &mut measured, error) })
        .unwrap();
    let study = Measured::of(person(), &Options::default()).unwrap();
    let shape = BodyShape { name: "身長".to_string(), ..study.shape };
    assert_eq!(json(measured).unwrap(), shape.to_json());
    let built_in = from_text(" sd2.5\n").unwrap();
    assert_eq!(json(built_in).unwrap(), BodyShape::built_in("sd2.5").unwrap().to_json());
    for style in [measured, built_in] {
        let again = from_text(&json(style).unwrap()).unwrap();
        assert_eq!(json(again).unwrap(), json(style).unwrap());
        destroy(again.id);

        let mut numbers = SdefStyleNumbers { struct_size: size_of::<SdefStyleNumbers>() as u32, ..zeroed() };
        let mut count = 0;
        ask(|error| unsafe { sdef_style_get_numbers(style, &mut numbers, null_mut(), 0, &mut count, error) })
            .unwrap();
        let mut bones = vec![bone(); count];
        ask(|error| unsafe {
            sdef_style_get_numbers(style, null_mut(), bones.as_mut_ptr(), count, null_mut(), error)
        })
        .unwrap();
        let shape = BodyShape::from_json(&json(style).unwrap()).unwrap();
        assert_eq!(numbers.heads, shape.heads().unwrap());
        assert_eq!(count, shape.bones.len());
        let name = CString::new(shape.name.clone()).unwrap();
        let mut again = SdefStyle::default();
        ask(|error| unsafe {
            sdef_style_from_numbers(name.as_ptr(), &numbers, bones.as_ptr(), count, &mut again, error)
        })
        .unwrap();
        // All but the slices, which go as text alone.
        let [had, came] = [style, again].map(|style| BodyShape::from_json(&json(style).unwrap()).unwrap());
        assert_eq!(came, BodyShape { profile: None, ..had });
        destroy(again.id);
    }
    // Blends and stretches.
    let mut made = SdefStyle::default();
    ask(|error| unsafe { sdef_style_blend(measured, built_in, 0.25, &mut made, error) }).unwrap();
    let other = BodyShape::built_in("sd2.5").unwrap();
    assert_eq!(json(made).unwrap(), shape.blended(&other, 0.25).to_json());
    destroy(made.id);
    ask(|error| unsafe { sdef_style_from_heads(3.5, built_in, &mut made, error) }).unwrap();
    assert_eq!(json(made).unwrap(), other.with_heads(3.5).to_json());
    destroy(made.id);
    // Styles of N heads.
    let (two, four) = (of_heads(2.0), of_heads(4.0));
    ask(|error| unsafe { sdef_style_blend(two, four, 0.25, &mut made, error) }).unwrap();
    let mut numbers = SdefStyleNumbers { struct_size: size_of::<SdefStyleNumbers>() as u32, ..zeroed() };
    ask(|error| unsafe { sdef_style_get_numbers(made, &mut numbers, null_mut(), 0, null_mut(), error) })
        .unwrap();
    assert_eq!(numbers.heads, 2.5);
    assert!(numbers.head_length.is_nan());
    let mut again = SdefStyle::default();
    ask(|error| unsafe { sdef_style_from_numbers(null(), &numbers, null(), 0, &mut again, error) }).unwrap();
    assert_eq!(json(again).unwrap_err().status, SDEF_STATUS_BAD_STYLE);
    for id in [again.id, made.id, two.id, four.id, measured.id, built_in.id, character.id] {
        destroy(id);
    }
}

#[test]
fn everything_at_once_is_the_same() {
    let _at_work = at_work();
    let character = person();
    let style = of_heads(2.5);
    let meshes: Vec<_> = character.meshes.iter().map(c_mesh).collect();
    let structs: Vec<SdefMesh> = meshes.iter().map(|mesh| mesh.mesh).collect();
    let skeleton = c_skeleton(character);
    let up = character.axes.up.to_array();
    let forward = character.axes.forward.map(|forward| forward.to_array());
    let plain = {
        let mut plain = character.clone();
        plain.meshes.iter_mut().for_each(|mesh| mesh.morph_targets.clear());
        plain
    };
    let mut room = room(&plain);
    let start = room.meshes.as_mut_ptr();
    ask(|error| unsafe {
        sdef_super_deform(
            up.as_ptr(),
            forward.as_ref().map_or(null(), |forward| forward.as_ptr()),
            &skeleton.skeleton,
            structs.as_ptr(),
            structs.len(),
            style,
            null(),
            start,
            None,
            null_mut(),
            error,
        )
    })
    .unwrap();
    assert!(room.bits() == expected(&plain, &Style::Heads(2.5), &Options::default()));
    destroy(style.id);
}

#[test]
fn a_destroyed_stale_made_up_or_other_handle_is_refused() {
    let _at_work = at_work();
    let (character, style) = (given(person()), of_heads(2.5));
    let made = deformer(character, style, &options());
    let stale = create().id;
    destroy(stale);
    let bad = |result: Result<(), Failed>| result.unwrap_err().status == SDEF_STATUS_BAD_HANDLE;
    let (info, meshes) = (SdefCharacterInfo { struct_size: 48, ..zeroed() }, room(person()));
    for id in
        [0, 1, stale, u64::MAX, 1 << 56, made.id, style.id, 0x0100_0001_0000_FFFF, character.id ^ 1 << 40]
    {
        let handle = SdefCharacter { id };
        let mut info = info;
        assert!(bad(ask(|error| unsafe { sdef_character_get_info(handle, &mut info, error) })), "{id:#x}");
        assert!(bad(ask(|error| unsafe { sdef_character_add_mesh(handle, null(), null_mut(), error) })));
        assert!(bad(ask(|error| unsafe { sdef_character_add_morph_target(handle, 0, null(), error) })));
        assert!(bad(ask(|error| unsafe { sdef_character_set_skeleton(handle, null(), error) })));
        assert!(bad(ask(|error| unsafe { sdef_character_rig(handle, null(), None, null_mut(), error) })));
        assert!(bad(ask(|error| unsafe {
            sdef_character_get_joints(
                handle,
                null_mut(),
                null_mut(),
                null_mut(),
                null_mut(),
                0,
                null_mut(),
                error,
            )
        })));
        assert!(bad(ask(|error| unsafe {
            sdef_character_get_weights(handle, 0, 4, null_mut(), null_mut(), 0, error)
        })));
        let mut to = SdefStyle::default();
        assert!(bad(ask(|error| unsafe { sdef_style_measure(handle, null(), null(), &mut to, error) })));
        assert!(bad(deformer_with(handle, style, null(), None, null_mut()).map(|_| ())));
    }
    for id in [0, 2, stale, u64::MAX, made.id, character.id, style.id ^ 1 << 33] {
        let handle = SdefStyle { id };
        let mut to = SdefStyle::default();
        assert!(bad(deformer_with(character, handle, null(), None, null_mut()).map(|_| ())), "{id:#x}");
        assert!(bad(ask(|error| unsafe { sdef_style_blend(handle, style, 0.5, &mut to, error) })));
        assert!(bad(ask(|error| unsafe { sdef_style_blend(style, handle, 0.5, &mut to, error) })));
        assert!(bad(ask(|error| unsafe {
            sdef_style_get_numbers(handle, null_mut(), null_mut(), 0, null_mut(), error)
        })));
        assert!(bad(ask(|error| unsafe { sdef_style_to_json(handle, null_mut(), 0, null_mut(), error) })));
        if id != 0 {
            assert!(bad(ask(|error| unsafe { sdef_style_from_heads(2.0, handle, &mut to, error) })));
        }
        assert_eq!(to.id, 0);
    }
    for id in [0, 3, stale, u64::MAX, style.id, character.id, made.id ^ 1 << 40] {
        let handle = SdefDeformer { id };
        let start = meshes.meshes.as_ptr();
        assert!(
            bad(ask(|error| unsafe { sdef_deformer_apply(handle, start, 1, None, null_mut(), error) })),
            "{id:#x}"
        );
        assert!(bad(ask(|error| unsafe {
            sdef_deformer_set_options(handle, null(), None, null_mut(), error)
        })));
        assert!(bad(ask(|error| unsafe {
            sdef_deformer_get_joints(handle, null_mut(), null_mut(), 0, null_mut(), error)
        })));
        assert!(bad(ask(|error| unsafe {
            sdef_deformer_map_points(handle, null(), null(), 0, null_mut(), null_mut(), null_mut(), error)
        })));
        assert!(bad(ask(|error| unsafe {
            sdef_deformer_get_groups(handle, null_mut(), 0, null_mut(), error)
        })));
        assert!(bad(ask(|error| unsafe {
            sdef_deformer_get_report(handle, null_mut(), null_mut(), 0, null_mut(), error)
        })));
        assert!(bad(ask(|error| unsafe { sdef_deformer_measure(handle, None, null_mut(), error) })));
    }
    for id in [1, stale, style.id] {
        assert!(bad(ask(|error| unsafe { sdef_get_warnings(id, null_mut(), 0, null_mut(), error) })));
    }
    for id in [1, stale, u64::MAX, character.id ^ 1 << 57] {
        assert!(bad(ask(|error| unsafe { sdef_destroy(id, error) })), "{id:#x}");
    }
    destroy(0);
    // The deformer keeps what it needs.
    let before = deformed(made, person());
    destroy(character.id);
    destroy(style.id);
    assert!(deformed(made, person()) == before);
    destroy(made.id);
}

#[test]
fn a_deformer_keeps_the_character_as_it_was() {
    let _at_work = at_work();
    let (character, style) = (given(person()), of_heads(2.5));
    let made = deformer(character, style, &options());
    let before = deformed(made, person());
    let mesh = c_mesh(&person().meshes[0]);
    ask(|error| unsafe { sdef_character_add_mesh(character, &mesh.mesh, null_mut(), error) }).unwrap();
    assert!(deformed(made, person()) == before);
    let mut more = person().clone();
    more.meshes.push(person().meshes[0].clone());
    more.meshes.last_mut().unwrap().morph_targets.clear();
    let other = deformer(character, style, &options());
    assert!(deformed(other, &more) == expected(&more, &Style::Heads(2.5), &Options::default()));
    for id in [character.id, style.id, made.id, other.id] {
        destroy(id);
    }
}

/// The person as a sculptor leaves it: meshes alone.
fn statue() -> Character {
    let mut statue = person().clone();
    statue.skeleton.joints.clear();
    statue.humanoid = Humanoid::default();
    for mesh in &mut statue.meshes {
        mesh.weights = superdeform::Weights::default();
        // What SDEF_MESH_UNKNOWN stands for.
        mesh.kind = superdeform::MeshKind::guess(&mesh.name);
        mesh.morph_targets.clear();
    }
    statue
}

fn rig(character: SdefCharacter, options: &SdefOptions) -> Result<(), Failed> {
    ask(|error| unsafe { sdef_character_rig(character, options, None, null_mut(), error) })
}

#[test]
fn a_made_rig_is_the_library_s() {
    let _at_work = at_work();
    let style = of_heads(2.5);
    // Without joints of its own, and with some that ride along.
    for (own, character) in [("none", statue()), ("all", person().clone())] {
        let library = Rig::of(&character, &RigOptions::default()).unwrap();
        let handle = given(&character);
        for threads in [1, 2, 8] {
            rig(handle, &with_threads(threads)).unwrap();
            let own_count = character.skeleton.joints.len();
            let mut info =
                SdefCharacterInfo { struct_size: size_of::<SdefCharacterInfo>() as u32, ..zeroed() };
            ask(|error| unsafe { sdef_character_get_info(handle, &mut info, error) }).unwrap();
            assert_eq!((info.rig_made, info.own_joint_count as usize), (1, own_count));
            let count = info.joint_count as usize;
            assert_eq!(count, own_count + library.skeleton.joints.len());
            let whole = library.applied_to(&character);
            let (mut parents, mut rests, mut sure) =
                (vec![9; count], vec![[0.0; 16]; count], vec![9.0; count]);
            ask(|error| unsafe {
                let (parents, rests) = (parents.as_mut_ptr(), rests.as_mut_ptr().cast());
                let sure = sure.as_mut_ptr();
                sdef_character_get_joints(handle, parents, null_mut(), rests, sure, count, null_mut(), error)
            })
            .unwrap();
            for (index, joint) in whole.skeleton.joints.iter().enumerate() {
                assert_eq!(parents[index], joint.parent.map_or(-1, |parent| parent as i32));
                assert_eq!(rests[index], joint.rest.to_cols_array());
            }
            assert_eq!(sure[own_count..], library.confidence);
            for (index, mesh) in character.meshes.iter().enumerate() {
                let rows = mesh.positions.len();
                let (mut joints, mut weights) = (vec![9; 4 * rows], vec![9.0; 4 * rows]);
                ask(|error| unsafe {
                    let (joints, weights) = (joints.as_mut_ptr(), weights.as_mut_ptr());
                    sdef_character_get_weights(handle, index as u32, 4, joints, weights, rows, error)
                })
                .unwrap();
                let limited = library.skin_weights[index].limited(4);
                for vertex in 0..rows {
                    for (i, &(joint, weight)) in limited.row(vertex).iter().enumerate() {
                        assert_eq!(joints[4 * vertex + i], joint + own_count as u32);
                        assert_eq!(weights[4 * vertex + i], weight);
                    }
                    let sum: f32 = weights[4 * vertex..4 * vertex + 4].iter().sum();
                    assert!((sum - 1.0).abs() < 1e-5);
                }
            }
            let made = deformer(handle, style, &with_threads(threads));
            let wanted =
                Deformer::with_rig(&character, &library, &Style::Heads(2.5), &Options::default()).unwrap();
            assert!(
                deformed(made, &character) == room(&character).bits_of(&wanted.apply()),
                "own joints: {own}"
            );
            assert_eq!(joints_of(made).0, wanted.apply().joints);
            let mut report = SdefReport { struct_size: size_of::<SdefReport>() as u32, ..zeroed() };
            ask(|error| unsafe {
                sdef_deformer_get_report(made, &mut report, null_mut(), 0, null_mut(), error)
            })
            .unwrap();
            assert_eq!((report.rig_made, report.unreached_vertices), (1, 0));
            let lines = |id| text(|t, c, s, e| unsafe { sdef_get_warnings(id, t.cast(), c, s, e) }).unwrap();
            assert_eq!(lines(handle.id).lines().count(), library.warnings.len());
            assert!(lines(made.id).starts_with(&lines(handle.id)));
            // What the report has found is told too.
            let found = wanted.report(&wanted.apply()).unwrap().warnings;
            let codes: Vec<String> = found.iter().map(|warning| format!("{}:", warning.code)).collect();
            let told = lines(made.id);
            assert_eq!(
                told.lines().map(|line| line.split_inclusive(':').next().unwrap()).collect::<Vec<_>>(),
                codes
            );
            destroy(made.id);
        }
        // A rig that is stopped leaves the one before; a new mesh is not in it.
        let rig_made = || {
            let mut info =
                SdefCharacterInfo { struct_size: size_of::<SdefCharacterInfo>() as u32, ..zeroed() };
            ask(|error| unsafe { sdef_character_get_info(handle, &mut info, error) }).unwrap();
            info.rig_made
        };
        stopped_everywhere(|progress, user| {
            let result = ask(|error| unsafe { sdef_character_rig(handle, null(), progress, user, error) });
            assert_eq!(rig_made(), 1);
            result
        });
        let mesh = c_mesh(&statue().meshes[0]);
        ask(|error| unsafe { sdef_character_add_mesh(handle, &mesh.mesh, null_mut(), error) }).unwrap();
        assert_eq!(rig_made(), 0);
        if character.skeleton.joints.is_empty() {
            let mut none = SdefDeformer::default();
            let refused = ask(|error| unsafe {
                sdef_deformer_create(handle, style, null(), None, null_mut(), &mut none, error)
            });
            let refused = refused.unwrap_err();
            assert_eq!(refused.status, SDEF_STATUS_NO_HUMANOID);
            assert!(
                refused.message.ends_with("went when the character changed: make it again"),
                "{refused:?}"
            );
        }
        destroy(handle.id);
    }
    destroy(style.id);
}

#[test]
fn everything_at_once_makes_a_rig_where_there_is_none() {
    let _at_work = at_work();
    let character = statue();
    let library = Rig::of(&character, &RigOptions::default()).unwrap();
    let wanted = Deformer::with_rig(&character, &library, &Style::Heads(3.0), &Options::default()).unwrap();
    let style = of_heads(3.0);
    let meshes: Vec<_> = character.meshes.iter().map(c_mesh).collect();
    let structs: Vec<SdefMesh> =
        meshes.iter().map(|mesh| SdefMesh { kind: SDEF_MESH_UNKNOWN, ..mesh.mesh }).collect();
    let (up, forward) =
        (character.axes.up.to_array(), character.axes.forward.map(|forward| forward.to_array()));
    let forward = forward.as_ref().map_or(null(), |forward| forward.as_ptr());
    let mut results = room(&character);
    let (start, count) = (structs.as_ptr(), structs.len());
    let to = results.meshes.as_mut_ptr();
    ask(|error| unsafe {
        sdef_super_deform(
            up.as_ptr(),
            forward,
            null(),
            start,
            count,
            style,
            null(),
            to,
            None,
            null_mut(),
            error,
        )
    })
    .unwrap();
    assert!(results.bits() == results.bits_of(&wanted.apply()));
    destroy(style.id);
}

/// A struct in memory of another size than ours, with a border behind it that must stay as it is.
fn sized<T: Copy>(value: T, size: usize) -> Vec<u64> {
    let mut memory = vec![0xAAAA_AAAA_AAAA_AAAAu64; size.div_ceil(8) + 2];
    unsafe {
        let start = memory.as_mut_ptr().cast::<u8>();
        start.write_bytes(0, size);
        start.copy_from_nonoverlapping((&raw const value).cast(), size.min(size_of::<T>()));
        start.cast::<u32>().write(size as u32);
    }
    memory
}

fn border_is_whole(memory: &[u64], size: usize) -> bool {
    let bytes: Vec<u8> = memory.iter().flat_map(|word| word.to_ne_bytes()).collect();
    bytes[size..].iter().all(|&byte| byte == 0xAA)
}

#[test]
fn structs_of_older_and_newer_hosts_are_read_and_written_as_far_as_they_go() {
    let _at_work = at_work();
    let character = given(person());
    let style = of_heads(2.5);
    let plain = expected(person(), &Style::Heads(2.5), &Options::default());
    let full = size_of::<SdefOptions>();
    for (size, amount, wanted) in [
        (full, 0.3, expected(person(), &Style::Heads(2.5), &Options { amount: 0.3, ..Options::default() })),
        (
            full + 64,
            0.3,
            expected(person(), &Style::Heads(2.5), &Options { amount: 0.3, ..Options::default() }),
        ),
    ] {
        let memory = sized(SdefOptions { amount, ..options() }, size);
        let made = deformer_with(character, style, memory.as_ptr().cast(), None, null_mut()).unwrap();
        assert!(deformed(made, person()) == wanted, "options of {size} bytes");
        destroy(made.id);

        let mut memory = sized(options(), size);
        ask(|error| unsafe { sdef_options_init(memory.as_mut_ptr().cast(), size as u32, error) }).unwrap();
        assert!(border_is_whole(&memory, size), "options of {size} bytes");
        assert_eq!(memory[0] as u32 as usize, size);
    }
    let made = deformer(character, style, &options());
    for more in [0, 24] {
        let size = size_of::<SdefReport>() + more;
        let mut memory = sized(zeroed::<SdefReport>(), size);
        ask(|error| unsafe {
            sdef_deformer_get_report(made, memory.as_mut_ptr().cast(), null_mut(), 0, null_mut(), error)
        })
        .unwrap();
        assert!(border_is_whole(&memory, size), "a report of {size} bytes");
        let size = size_of::<SdefCharacterInfo>() + more;
        let mut memory = sized(zeroed::<SdefCharacterInfo>(), size);
        ask(|error| unsafe { sdef_character_get_info(character, memory.as_mut_ptr().cast(), error) })
            .unwrap();
        assert!(border_is_whole(&memory, size));
        let size = size_of::<SdefStyleNumbers>() + more;
        let mut memory = sized(zeroed::<SdefStyleNumbers>(), size);
        ask(|error| unsafe {
            sdef_style_get_numbers(style, memory.as_mut_ptr().cast(), null_mut(), 0, null_mut(), error)
        })
        .unwrap();
        assert!(border_is_whole(&memory, size));
    }
    // Arrays of structs are as far apart as they are long.
    for longer in [0, 16] {
        let size = size_of::<SdefMeshResult>() + longer;
        let results = room(person());
        let mut memory = vec![0u8; size * results.meshes.len()];
        for (index, mesh) in results.meshes.iter().enumerate() {
            let mesh = SdefMeshResult { struct_size: size as u32, ..*mesh };
            unsafe {
                let to = memory.as_mut_ptr().add(index * size);
                to.copy_from_nonoverlapping((&raw const mesh).cast(), size_of::<SdefMeshResult>());
            }
        }
        ask(|error| unsafe {
            sdef_deformer_apply(made, memory.as_ptr().cast(), results.meshes.len(), None, null_mut(), error)
        })
        .unwrap();
        assert!(results.bits() == plain, "{longer} bytes more");
    }
    // More room than is needed: morph targets stand one behind the other all the same.
    let count = person().meshes[0].positions.len();
    let mut wide = vec![Vec3::NAN; 3 * (count + 100)];
    let mut results = room(person());
    results.meshes[0].vertex_capacity = count + 100;
    results.meshes[0].morph_target_capacity = 3;
    results.meshes[0].morph_positions = wide.as_mut_ptr().cast();
    results.apply(made).unwrap();
    let library = library_deformer(person(), &Style::Heads(2.5), &Options::default()).apply();
    let targets = &library.meshes[0].morph_targets;
    assert!(wide[..count] == targets[0].positions && wide[count..2 * count] == targets[1].positions);
    assert!(wide[2 * count..].iter().all(|v| v.is_nan()));
    for id in [character.id, style.id, made.id] {
        destroy(id);
    }
}

/// What is asked of `sdef_deformer_map_morph_targets`: the vertices of each target, and positions, normals and tangents there.
struct Sparse {
    counts: Vec<u32>,
    vertices: Vec<u32>,
    deltas: [Vec<Vec3>; 3],
}

impl Sparse {
    fn of(targets: &[MorphTarget]) -> Self {
        let mut sparse = Self { counts: Vec::new(), vertices: Vec::new(), deltas: Default::default() };
        for target in targets {
            let all = [&target.positions, &target.normals, &target.tangents];
            let at = |array: &Vec<Vec3>, vertex: usize| array.get(vertex).copied().unwrap_or_default();
            let touched = |&vertex: &usize| all.iter().any(|array| at(array, vertex) != Vec3::ZERO);
            let touched: Vec<usize> = (0..target.positions.len()).filter(touched).collect();
            sparse.counts.push(touched.len() as u32);
            sparse.vertices.extend(touched.iter().map(|&vertex| vertex as u32));
            for (deltas, array) in sparse.deltas.iter_mut().zip(all) {
                deltas.extend(touched.iter().map(|&vertex| at(array, vertex)));
            }
        }
        sparse
    }

    fn map(&mut self, deformer: SdefDeformer, mesh: u32) -> Result<(), Failed> {
        let [positions, normals, tangents] = self.deltas.each_mut().map(|deltas| deltas.as_mut_ptr().cast());
        ask(|error| unsafe {
            sdef_deformer_map_morph_targets(
                deformer,
                mesh,
                self.counts.as_ptr(),
                self.counts.len(),
                self.vertices.as_ptr(),
                positions,
                normals,
                tangents,
                error,
            )
        })
    }
}

#[test]
fn morph_targets_that_the_character_was_not_given_come_out_as_those_that_it_was() {
    let _at_work = at_work();
    for (style, options) in [(2.5, Options::default()), (5.0, Options { amount: 0.3, ..Options::default() })]
    {
        let wanted = library_deformer(person(), &Style::Heads(style), &options).apply();
        let mut bare = person().clone();
        bare.meshes.iter_mut().for_each(|mesh| mesh.morph_targets.clear());
        let (character, heads) = (given(&bare), of_heads(style));
        let made = deformer(character, heads, &SdefOptions { amount: options.amount, ..with_threads(2) });
        for (index, (mesh, wanted)) in person().meshes.iter().zip(&wanted.meshes).enumerate() {
            let (mut given, wanted) = (Sparse::of(&mesh.morph_targets), Sparse::of(&wanted.morph_targets));
            given.map(made, index as u32).unwrap();
            assert!(given.vertices == wanted.vertices);
            assert!(given.deltas == wanted.deltas, "{style} heads, mesh {index}");
        }
        for id in [character.id, heads.id, made.id] {
            destroy(id);
        }
    }
}

#[test]
fn what_is_wrong_with_mapped_morph_targets_is_said_and_nothing_is_written() {
    let _at_work = at_work();
    let (character, style) = (given(person()), of_heads(2.5));
    let made = deformer(character, style, &with_threads(1));
    let count = person().meshes[0].positions.len() as u32;
    type Spoil = fn(&mut Sparse);
    let faults: [(u32, &str, u32, Spoil); 4] = [
        (99, "there is no mesh 99", SDEF_STATUS_BAD_ARGUMENT, |_| ()),
        (0, "has vertex 4 before 2", SDEF_STATUS_BAD_INPUT, |given| given.vertices.swap(1, 2)),
        (0, "moves vertex 4000000000", SDEF_STATUS_BAD_INPUT, |given| {
            given.vertices[given.counts[0] as usize - 1] = 4_000_000_000;
        }),
        (0, "moves vertex 1 by what is no number", SDEF_STATUS_BAD_INPUT, |given| {
            given.deltas[1][0].y = f32::NAN
        }),
    ];
    assert!(count > 8);
    for (mesh, sentence, status, spoil) in faults {
        let mut wrong = Sparse::of(&person().meshes[0].morph_targets);
        spoil(&mut wrong);
        let before: Vec<u32> =
            wrong.deltas.iter().flatten().flat_map(|d| d.to_array()).map(f32::to_bits).collect();
        let error = wrong.map(made, mesh).unwrap_err();
        let after: Vec<u32> =
            wrong.deltas.iter().flatten().flat_map(|d| d.to_array()).map(f32::to_bits).collect();
        assert!(error.status == status && error.message.contains(sentence), "{}", error.message);
        assert!(before == after);
    }
    for id in [character.id, style.id, made.id] {
        destroy(id);
    }
}

#[test]
fn names_of_blinks_are_those_that_a_character_wants() {
    let read = |name: &std::ffi::CStr| unsafe { sdef_morph_target_is_read(name.as_ptr()) };
    assert_eq!([c"Fcl_EYE_Blink", c"vrc.blink", c"smile", c""].map(read), [1, 1, 0, 0]);
    assert_eq!(unsafe { sdef_morph_target_is_read(std::ptr::null()) }, 0);
}

#[test]
fn eight_hosts_at_once_get_what_one_gets() {
    let _at_work = at_work();
    let wanted = expected(person(), &Style::Heads(2.5), &Options::default());
    std::thread::scope(|scope| {
        for host in 0..8 {
            let wanted = &wanted;
            scope.spawn(move || {
                for _ in 0..3 {
                    let (character, style) = (given(person()), of_heads(2.5));
                    let made = deformer(character, style, &with_threads(1 + host % 3));
                    destroy(character.id);
                    assert!(deformed(made, person()) == *wanted);
                    destroy(style.id);
                    destroy(made.id);
                }
            });
        }
    });
}

#[test]
fn many_threads_read_one_handle_and_a_change_beside_them_is_busy_or_done() {
    let _at_work = at_work();
    let (character, style) = (given(person()), of_heads(2.5));
    let made = deformer(character, style, &with_threads(1));
    let full = expected(person(), &Style::Heads(2.5), &Options::default());
    let half = expected(person(), &Style::Heads(2.5), &Options { amount: 0.5, ..Options::default() });
    let (done, busy, read) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while !over.load(Ordering::Relaxed) {
                    let mut room = room(person());
                    match room.apply(made) {
                        Ok(()) => {
                            let bits = room.bits();
                            assert!(bits == full || bits == half, "a result between two settings");
                            read.fetch_add(1, Ordering::Relaxed);
                        }
                        Err(failed) => assert_eq!(failed.status, SDEF_STATUS_BUSY),
                    }
                    let mut info = SdefCharacterInfo { struct_size: 40, ..zeroed() };
                    ask(|error| unsafe { sdef_character_get_info(character, &mut info, error) }).unwrap();
                }
            });
        }
        for change in 0..200 {
            let amount = if change % 2 == 0 { 0.5 } else { 1.0 };
            let options = SdefOptions { amount, ..with_threads(1) };
            match ask(|error| unsafe { sdef_deformer_set_options(made, &options, None, null_mut(), error) }) {
                Ok(()) => done.fetch_add(1, Ordering::Relaxed),
                Err(failed) => {
                    assert_eq!(failed.status, SDEF_STATUS_BUSY);
                    busy.fetch_add(1, Ordering::Relaxed)
                }
            };
            std::thread::yield_now();
        }
        while read.load(Ordering::Relaxed) == 0 {
            std::thread::yield_now();
        }
        over.store(true, Ordering::Relaxed);
    });
    println!("changes: {done:?} done, {busy:?} busy; {read:?} results read");
    for id in [character.id, style.id, made.id] {
        destroy(id);
    }
}

/// What a progress callback of a test sees and does.
struct Watch {
    thread: std::thread::ThreadId,
    fractions: Vec<f32>,
    /// The call at which to stop.
    stop_at: usize,
    /// What to do from within.
    within: Option<Box<dyn FnMut()>>,
}

impl Watch {
    fn new(stop_at: usize) -> Self {
        Self { thread: std::thread::current().id(), fractions: Vec::new(), stop_at, within: None }
    }
}

unsafe extern "C" fn watch(user: *mut c_void, fraction: f32) -> i32 {
    let watch = unsafe { &mut *user.cast::<Watch>() };
    assert_eq!(std::thread::current().id(), watch.thread);
    watch.fractions.push(fraction);
    if let Some(within) = &mut watch.within {
        within();
    }
    i32::from(watch.fractions.len() == watch.stop_at)
}

/// Stops `call` at each of its callbacks, and lets it end at last; gives how often it called back.
fn stopped_everywhere(call: impl Fn(SdefProgress, *mut c_void) -> Result<(), Failed>) -> usize {
    for stop_at in 1..100 {
        let mut watcher = Watch::new(stop_at);
        let result = call(Some(watch), (&raw mut watcher).cast());
        assert!(watcher.fractions.is_sorted(), "{:?}", watcher.fractions);
        assert!(watcher.fractions.iter().all(|fraction| (0.0..=1.0).contains(fraction)));
        match result {
            Err(failed) => {
                assert_eq!(failed.status, SDEF_STATUS_CANCELLED);
                assert_eq!(watcher.fractions.len(), stop_at, "no call back after the stop");
            }
            Ok(()) => {
                assert_eq!(watcher.fractions.last(), Some(&1.0));
                return watcher.fractions.len();
            }
        }
    }
    panic!("it never ended");
}

#[test]
fn a_host_can_stop_every_long_call_and_nothing_has_changed() {
    let _at_work = at_work();
    let (character, style) = (given(person()), of_heads(2.5));
    let mut last = SdefDeformer::default();
    let calls = stopped_everywhere(|progress, user| {
        deformer_with(character, style, null(), progress, user).map(|made| destroy(made.id))
    });
    assert!(calls >= 4, "{calls} callbacks");
    last.id = deformer(character, style, &options()).id;
    let before = deformed(last, person());
    let calls = stopped_everywhere(|progress, user| {
        let room = room(person());
        let untouched = room.bits();
        let (start, count) = (room.meshes.as_ptr(), room.meshes.len());
        let result = ask(|error| unsafe { sdef_deformer_apply(last, start, count, progress, user, error) });
        assert!(room.bits() == if result.is_ok() { before.clone() } else { untouched });
        result
    });
    assert!(calls >= 3, "{calls} callbacks");
    let changed = SdefOptions { head_scale: 1.3, rays: 9, ..options() };
    stopped_everywhere(|progress, user| {
        let result = ask(|error| unsafe { sdef_deformer_set_options(last, &changed, progress, user, error) });
        if result.is_err() {
            assert!(deformed(last, person()) == before);
        }
        result
    });
    let calls = stopped_everywhere(|progress, user| {
        ask(|error| unsafe { sdef_deformer_measure(last, progress, user, error) })
    });
    assert!(calls >= 6, "{calls} callbacks");
    for id in [character.id, style.id, last.id] {
        destroy(id);
    }
}

#[test]
fn a_callback_that_calls_back_gets_an_answer_and_never_waits() {
    let _at_work = at_work();
    let (character, style) = (given(person()), of_heads(2.5));
    let made = deformer(character, style, &options());
    let before = deformed(made, person());
    // A change that is called back from cannot be looked at or changed; an apply can be beside another.
    let mut watcher = Watch::new(0);
    watcher.within = Some(Box::new(move || {
        let change = ask(|error| unsafe { sdef_deformer_set_options(made, null(), None, null_mut(), error) });
        assert_eq!(change.unwrap_err().status, SDEF_STATUS_BUSY);
        assert_eq!(room(person()).apply(made).unwrap_err().status, SDEF_STATUS_BUSY);
        // Other handles are free.
        destroy(of_heads(3.0).id);
    }));
    let changed = SdefOptions { head_scale: 1.3, ..options() };
    let user = (&raw mut watcher).cast();
    ask(|error| unsafe { sdef_deformer_set_options(made, &changed, Some(watch), user, error) }).unwrap();
    ask(|error| unsafe { sdef_deformer_set_options(made, null(), None, null_mut(), error) }).unwrap();
    let mut watcher = Watch::new(0);
    watcher.within = Some(Box::new(move || {
        let change = ask(|error| unsafe { sdef_deformer_set_options(made, null(), None, null_mut(), error) });
        assert_eq!(change.unwrap_err().status, SDEF_STATUS_BUSY);
        assert!(room(person()).apply(made).is_ok());
        // Destroyed while it works: the work is done all the same.
        unsafe { sdef_destroy(made.id, null_mut()) };
        unsafe { sdef_destroy(character.id, null_mut()) };
    }));
    let results = room(person());
    let (start, count) = (results.meshes.as_ptr(), results.meshes.len());
    let user = (&raw mut watcher).cast();
    ask(|error| unsafe { sdef_deformer_apply(made, start, count, Some(destroyer), user, error) }).unwrap();
    assert!(results.bits() == before);
    assert_eq!(room(person()).apply(made).unwrap_err().status, SDEF_STATUS_BAD_HANDLE);
    destroy(style.id);
}

/// Does what is to be done within at the first call alone.
unsafe extern "C" fn destroyer(user: *mut c_void, _fraction: f32) -> i32 {
    let watch = unsafe { &mut *user.cast::<Watch>() };
    if let Some(mut within) = watch.within.take() {
        within();
    }
    0
}

/// Waits until no other test is at work.
#[test]
fn no_handle_is_left() {
    // The others begin first.
    std::thread::sleep(std::time::Duration::from_millis(300));
    let _alone = AT_WORK.write().unwrap_or_else(PoisonError::into_inner);
    assert_eq!(sdef_live_handles(), 0);
    let (character, style) = (given(person()), of_heads(2.5));
    let made = deformer(character, style, &options());
    assert_eq!(sdef_live_handles(), 3);
    for (left, id) in [(2, made.id), (1, character.id), (0, style.id)] {
        destroy(id);
        assert_eq!(sdef_live_handles(), left);
    }
}

#[test]
fn the_version_and_the_names_of_all_statuses() {
    assert_eq!(sdef_abi_version(), SDEF_ABI_VERSION);
    let before = env!("CARGO_PKG_VERSION_PRE");
    let before = if before.is_empty() { String::new() } else { format!("-{before}") };
    let version = format!("{SDEF_VERSION_MAJOR}.{SDEF_VERSION_MINOR}.{SDEF_VERSION_PATCH}{before}");
    assert_eq!(unsafe { CStr::from_ptr(sdef_version()) }.to_str(), Ok(version.as_str()));
    assert_eq!(env!("CARGO_PKG_VERSION"), version);
    let name = |status| unsafe { CStr::from_ptr(sdef_status_name(status)) }.to_str().unwrap();
    let names: BTreeSet<&str> = (0..=SDEF_STATUS_INTERNAL).map(name).collect();
    assert_eq!(names.len() as u32, SDEF_STATUS_INTERNAL + 1);
    assert!(names.iter().all(|name| name.starts_with("SDEF_STATUS_")));
    assert_eq!(name(SDEF_STATUS_INTERNAL + 1), "unknown status");
    assert_eq!(name(u32::MAX), "unknown status");
}

/// Runs by itself in a process whose memory is limited, where the test below starts it.
#[test]
#[ignore = "started by memory_that_cannot_be_had_is_a_status"]
fn with_little_memory() {
    const COUNT: usize = 60_000_000;
    // Zeros that the system has promised and not yet given.
    let positions = vec![0.0f32; 3 * COUNT];
    let mesh = SdefMesh {
        struct_size: size_of::<SdefMesh>() as u32,
        vertex_count: COUNT,
        positions: positions.as_ptr(),
        ..zeroed()
    };
    let handle = create();
    let failed =
        ask(|error| unsafe { sdef_character_add_mesh(handle, &mesh, null_mut(), error) }).unwrap_err();
    assert_eq!(failed.status, SDEF_STATUS_OUT_OF_MEMORY);
    println!("{}", failed.message);
    let small = c_mesh(&person().meshes[0]);
    let few = SdefMesh { influence_count: 0, row_starts: null(), ..small.mesh };
    ask(|error| unsafe { sdef_character_add_mesh(handle, &few, null_mut(), error) }).unwrap();
    destroy(handle.id);
}

#[cfg(target_os = "linux")]
#[test]
fn memory_that_cannot_be_had_is_a_status() {
    let _at_work = at_work();
    let test = std::env::current_exe().unwrap();
    // 720 MB of input and as much again are more than 1.2 GB.
    let script =
        format!("ulimit -v 1200000 && exec '{}' --ignored --exact with_little_memory", test.display());
    let result = std::process::Command::new("sh").args(["-c", &script]).output().unwrap();
    assert!(
        result.status.success(),
        "{}{}",
        String::from_utf8_lossy(&result.stdout),
        String::from_utf8_lossy(&result.stderr)
    );
}
