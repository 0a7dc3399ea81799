//! The C ABI called as a C host would: structs filled in by hand, handles passed on, errors read from the caller's struct.
#![allow(dead_code)]

use glam::{DVec3, Vec3, Vec4};
use std::ffi::{CStr, CString, c_void};
use std::ptr::{null, null_mut};
use superdeform::internals::ffi::basics::*;
use superdeform::internals::ffi::character::*;
use superdeform::internals::ffi::deformer::*;
use superdeform::internals::ffi::lifetime::*;
use superdeform::internals::ffi::options::*;
use superdeform::internals::ffi::style_handle::*;
use superdeform::{Character, Deformed, FaceHints, Humanoid, Mesh, MeshKind, MorphTarget, Role, Shade};

/// A status with its sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failed {
    pub status: u32,
    pub mesh: Option<u32>,
    pub element: Option<u32>,
    pub message: String,
}

pub fn error() -> SdefError {
    SdefError {
        struct_size: size_of::<SdefError>() as u32,
        status: 0,
        mesh: 0,
        element: 0,
        element_kind: 0,
        message: [0; 512],
    }
}

/// Calls with a struct for the error; the status must be the struct's.
pub fn ask(call: impl FnOnce(*mut SdefError) -> SdefStatus) -> Result<(), Failed> {
    let mut error = error();
    let status = call(&mut error);
    assert_eq!(status, error.status, "the status returned is the one in the struct");
    let index = |number: u32| (number != SDEF_NONE).then_some(number);
    let message = unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().unwrap().to_string();
    let failed = Failed { status, mesh: index(error.mesh), element: index(error.element), message };
    if status == SDEF_STATUS_OK {
        assert_eq!((failed.mesh, failed.element, failed.message.as_str()), (None, None, ""));
        return Ok(());
    }
    assert!(!failed.message.is_empty());
    Err(failed)
}

pub fn options() -> SdefOptions {
    let mut options = std::mem::MaybeUninit::uninit();
    let size = size_of::<SdefOptions>() as u32;
    ask(|error| unsafe { sdef_options_init(options.as_mut_ptr(), size, error) }).unwrap();
    unsafe { options.assume_init() }
}

/// Settings of a group that change nothing.
pub fn group_settings(group: &CStr) -> SdefGroupSettings {
    SdefGroupSettings { group: group.as_ptr(), ..SdefGroupSettings::default() }
}

pub fn bone_group(role: u32, group: &CStr) -> SdefBoneGroup {
    SdefBoneGroup { struct_size: size_of::<SdefBoneGroup>() as u32, role, group: group.as_ptr() }
}

/// What was measured, `SDEF_FIGURE_*`.
pub fn figure(deformer: SdefDeformer, which: u32) -> SdefFigure {
    let mut figure = SdefFigure { struct_size: size_of::<SdefFigure>() as u32, ..zeroed() };
    ask(|error| unsafe { sdef_deformer_get_figure(deformer, which, &mut figure, error) }).unwrap();
    figure
}

/// Hips at the origin.
pub fn given_joint() -> SdefGivenJoint {
    SdefGivenJoint { struct_size: size_of::<SdefGivenJoint>() as u32, role: 0, x: 0.0, y: 0.0, z: 0.0 }
}

/// A bone without length.
pub fn bone() -> SdefBone {
    SdefBone { struct_size: size_of::<SdefBone>() as u32, ..SdefBone::default() }
}

pub fn with_threads(thread_count: u32) -> SdefOptions {
    SdefOptions { thread_count, ..options() }
}

pub fn zeroed<T>() -> T {
    unsafe { std::mem::zeroed() }
}

pub fn create() -> SdefCharacter {
    let mut handle = SdefCharacter::default();
    ask(|error| unsafe { sdef_character_create(null(), null(), &mut handle, error) }).unwrap();
    assert_ne!(handle.id, 0);
    handle
}

pub fn destroy(id: u64) {
    ask(|error| unsafe { sdef_destroy(id, error) }).unwrap();
}

pub fn of_heads(heads: f64) -> SdefStyle {
    let mut style = SdefStyle::default();
    ask(|error| unsafe { sdef_style_from_heads(heads, SdefStyle::default(), &mut style, error) }).unwrap();
    style
}

pub fn from_text(text: &str) -> Result<SdefStyle, Failed> {
    let mut style = SdefStyle::default();
    ask(|error| unsafe { sdef_style_from_text(text.as_ptr().cast(), text.len(), &mut style, error) })?;
    Ok(style)
}

/// Gives a text of any size.
pub fn text(
    call: impl Fn(*mut i8, usize, *mut usize, *mut SdefError) -> SdefStatus,
) -> Result<String, Failed> {
    let mut size = 0;
    ask(|error| call(null_mut(), 0, &mut size, error))?;
    let mut bytes = vec![b'?'; size];
    let mut again = 0;
    ask(|error| call(bytes.as_mut_ptr().cast(), bytes.len(), &mut again, error))?;
    assert_eq!(again, size);
    // One byte less is too little, and nothing is written.
    let mut less = vec![b'?'; size - 1];
    let small = ask(|error| call(less.as_mut_ptr().cast(), less.len(), &mut again, error)).unwrap_err();
    assert_eq!((small.status, again), (SDEF_STATUS_BUFFER_TOO_SMALL, size));
    assert!(less.iter().all(|&byte| byte == b'?'));
    Ok(CStr::from_bytes_with_nul(&bytes).unwrap().to_str().unwrap().to_string())
}

/// A mesh as C has it, with what its pointers point to.
pub struct CMesh {
    pub mesh: SdefMesh,
    name: CString,
    indices: Vec<u32>,
    joints: Vec<u32>,
    weights: Vec<f32>,
    starts: Vec<u32>,
    kept: Mesh,
}

/// `mesh` as C has it, its weights in rows.
pub fn c_mesh(mesh: &Mesh) -> Box<CMesh> {
    let mut made = Box::new(CMesh {
        mesh: zeroed(),
        name: CString::new(mesh.name.clone()).unwrap(),
        indices: mesh.triangles.iter().flatten().copied().collect(),
        joints: mesh.weights.rows().flatten().map(|&(joint, _)| joint).collect(),
        weights: mesh.weights.rows().flatten().map(|&(_, weight)| weight).collect(),
        starts: std::iter::once(0)
            .chain(mesh.weights.rows().scan(0, |sum, row| {
                *sum += row.len() as u32;
                Some(*sum)
            }))
            .collect(),
        kept: mesh.clone(),
    });
    let kinds = [
        MeshKind::Body,
        MeshKind::Garment,
        MeshKind::Hair,
        MeshKind::FacePart,
        MeshKind::Accessory,
        MeshKind::Eye,
    ];
    let kept = &made.kept;
    let pointer = |empty: bool, start: *const f32| if empty { null() } else { start };
    let weighted = !made.weights.is_empty();
    made.mesh = SdefMesh {
        struct_size: size_of::<SdefMesh>() as u32,
        kind: mesh.kind.map_or(0, |kind| 1 + kinds.iter().position(|&other| other == kind).unwrap() as u32),
        name: made.name.as_ptr(),
        vertex_count: kept.positions.len(),
        positions: kept.positions.as_ptr().cast(),
        normals: pointer(kept.normals.is_empty(), kept.normals.as_ptr().cast()),
        tangents: pointer(kept.tangents.is_empty(), kept.tangents.as_ptr().cast()),
        indices: made.indices.as_ptr().cast(),
        index_count: made.indices.len(),
        influence_count: made.weights.len(),
        joints: made.joints.as_ptr().cast(),
        weights: made.weights.as_ptr().cast(),
        row_starts: if weighted { made.starts.as_ptr() } else { null() },
        ..zeroed()
    };
    match &kept.shade {
        Shade::Vertices(values) => made.mesh.luminance = values.as_ptr(),
        // Its number is known once it is added.
        Shade::Image { uvs, .. } => made.mesh.uvs = uvs.as_ptr().cast(),
        Shade::Unknown => {}
    }
    made
}

/// Hands over the image that `mesh` shows, and gives its number; 0 without one.
pub fn image_of(handle: SdefCharacter, mesh: &Mesh) -> u32 {
    let Shade::Image { image, .. } = &mesh.shade else { return 0 };
    let given = SdefImage {
        struct_size: size_of::<SdefImage>() as u32,
        width: image.width as u32,
        height: image.height as u32,
        pixels: image.pixels.as_ptr(),
        ..zeroed()
    };
    let mut number = 0;
    ask(|error| unsafe { sdef_character_add_image(handle, &given, &mut number, error) }).unwrap();
    number
}

/// Hands over what is known of a face.
pub fn hint(handle: SdefCharacter, hints: &FaceHints) {
    let places = [hints.eye, hints.other_eye].map(|eye| eye.map(|eye| eye.middle.to_array()));
    let pointer = |place: &Option<[f64; 3]>| place.as_ref().map_or(null(), |place| place.as_ptr());
    let eye = hints.eye.unwrap_or_default();
    let given = SdefFaceHints {
        struct_size: size_of::<SdefFaceHints>() as u32,
        eye: pointer(&places[0]),
        other_eye: pointer(&places[1]),
        half_width: eye.half_width,
        half_height: eye.half_height,
        ..zeroed()
    };
    ask(|error| unsafe { sdef_character_set_face_hints(handle, &given, error) }).unwrap();
}

/// A skeleton as C has it, with what its pointers point to.
pub struct CSkeleton {
    pub skeleton: SdefSkeleton,
    names: Vec<CString>,
    pointers: Vec<*const std::ffi::c_char>,
    parents: Vec<i32>,
    rests: Vec<[f64; 16]>,
    roles: Vec<i32>,
}

pub fn c_skeleton(character: &Character) -> Box<CSkeleton> {
    let joints = &character.skeleton.joints;
    let mut made = Box::new(CSkeleton {
        skeleton: zeroed(),
        names: joints.iter().map(|joint| CString::new(joint.name.clone()).unwrap()).collect(),
        pointers: Vec::new(),
        parents: joints.iter().map(|joint| joint.parent.map_or(-1, |parent| parent as i32)).collect(),
        rests: joints.iter().map(|joint| joint.rest.to_cols_array()).collect(),
        roles: Role::all()
            .map(|role| character.humanoid.joint(role).map_or(-1, |joint| joint as i32))
            .collect(),
    });
    made.pointers = made.names.iter().map(|name| name.as_ptr()).collect();
    let known = character.humanoid != Humanoid::default();
    made.skeleton = SdefSkeleton {
        struct_size: size_of::<SdefSkeleton>() as u32,
        role_count: if known { SDEF_ROLE_COUNT } else { 0 },
        names: made.pointers.as_ptr(),
        joint_count: joints.len(),
        parents: made.parents.as_ptr(),
        rest_matrices: made.rests.as_ptr().cast(),
        rest_stride: 0,
        role_joints: if known { made.roles.as_ptr() } else { null() },
    };
    made
}

pub fn c_morph(target: &MorphTarget) -> SdefMorphTarget {
    let pointer = |deltas: &[Vec3]| if deltas.is_empty() { null() } else { deltas.as_ptr().cast() };
    SdefMorphTarget {
        struct_size: size_of::<SdefMorphTarget>() as u32,
        positions: pointer(&target.positions),
        normals: pointer(&target.normals),
        tangents: pointer(&target.tangents),
        ..zeroed()
    }
}

/// The whole character behind a handle.
pub fn given(character: &Character) -> SdefCharacter {
    let up = character.axes.up.to_array();
    let forward = character.axes.forward.map(|forward| forward.to_array());
    let forward = forward.as_ref().map_or(null(), |forward| forward.as_ptr());
    let mut handle = SdefCharacter::default();
    ask(|error| unsafe { sdef_character_create(up.as_ptr(), forward, &mut handle, error) }).unwrap();
    let skeleton = c_skeleton(character);
    ask(|error| unsafe { sdef_character_set_skeleton(handle, &skeleton.skeleton, error) }).unwrap();
    for (index, mesh) in character.meshes.iter().enumerate() {
        let mut added = 99;
        let mut made = c_mesh(mesh);
        made.mesh.image = image_of(handle, mesh);
        ask(|error| unsafe { sdef_character_add_mesh(handle, &made.mesh, &mut added, error) }).unwrap();
        assert_eq!(added as usize, index);
        for target in &mesh.morph_targets {
            let target = c_morph(target);
            ask(|error| unsafe { sdef_character_add_morph_target(handle, added, &target, error) }).unwrap();
        }
    }
    if !character.face_hints.is_empty() {
        hint(handle, &character.face_hints);
    }
    handle
}

pub fn deformer_with(
    character: SdefCharacter,
    style: SdefStyle,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
) -> Result<SdefDeformer, Failed> {
    let mut handle = SdefDeformer::default();
    ask(|error| unsafe {
        sdef_deformer_create(character, style, options, progress, user, &mut handle, error)
    })?;
    Ok(handle)
}

pub fn deformer(character: SdefCharacter, style: SdefStyle, options: &SdefOptions) -> SdefDeformer {
    deformer_with(character, style, options, None, null_mut()).unwrap()
}

/// Room for the results of a character.
pub struct Room {
    pub meshes: Vec<SdefMeshResult>,
    positions: Vec<Vec<Vec3>>,
    normals: Vec<Vec<Vec3>>,
    tangents: Vec<Vec<Vec4>>,
    morphs: Vec<[Vec<Vec3>; 3]>,
    shapes: Vec<Vec<[bool; 2]>>,
}

pub fn room(character: &Character) -> Room {
    let mut room = Room {
        meshes: Vec::new(),
        positions: Vec::new(),
        normals: Vec::new(),
        tangents: Vec::new(),
        morphs: Vec::new(),
        shapes: Vec::new(),
    };
    for mesh in &character.meshes {
        let (count, targets) = (mesh.positions.len(), mesh.morph_targets.len());
        room.positions.push(vec![Vec3::NAN; count]);
        room.normals.push(vec![Vec3::NAN; mesh.normals.len()]);
        room.tangents.push(vec![Vec4::NAN; mesh.tangents.len()]);
        room.morphs.push([(); 3].map(|()| vec![Vec3::NAN; count * targets]));
        room.shapes.push(
            mesh.morph_targets.iter().map(|t| [!t.normals.is_empty(), !t.tangents.is_empty()]).collect(),
        );
        let some = |empty: bool, start: *mut f32| if empty { null_mut() } else { start };
        let (p, n, t) = (
            room.positions.last_mut().unwrap().as_mut_ptr().cast(),
            room.normals.last_mut().unwrap().as_mut_ptr().cast(),
            room.tangents.last_mut().unwrap().as_mut_ptr().cast(),
        );
        let [mp, mn, mt] =
            room.morphs.last_mut().unwrap().each_mut().map(|deltas| deltas.as_mut_ptr().cast::<f32>());
        room.meshes.push(SdefMeshResult {
            struct_size: size_of::<SdefMeshResult>() as u32,
            morph_target_capacity: targets as u32,
            vertex_capacity: count,
            positions: p,
            position_stride: 0,
            normals: some(mesh.normals.is_empty(), n),
            normal_stride: 0,
            tangents: some(mesh.tangents.is_empty(), t),
            tangent_stride: 0,
            morph_positions: some(targets == 0, mp),
            morph_normals: some(targets == 0, mn),
            morph_tangents: some(targets == 0, mt),
        });
    }
    room
}

impl Room {
    pub fn apply(&mut self, deformer: SdefDeformer) -> Result<(), Failed> {
        let (start, count) = (self.meshes.as_ptr(), self.meshes.len());
        ask(|error| unsafe { sdef_deformer_apply(deformer, start, count, None, null_mut(), error) })
    }

    /// Every number that was written, as bits.
    pub fn bits(&self) -> Vec<u32> {
        let threes =
            |all: &[Vec3]| all.iter().flat_map(|v| v.to_array()).map(f32::to_bits).collect::<Vec<_>>();
        let mut bits = Vec::new();
        for mesh in 0..self.positions.len() {
            bits.extend(threes(&self.positions[mesh]));
            bits.extend(threes(&self.normals[mesh]));
            bits.extend(self.tangents[mesh].iter().flat_map(|v| v.to_array()).map(f32::to_bits));
            self.morphs[mesh].iter().for_each(|deltas| bits.extend(threes(deltas)));
        }
        bits
    }

    /// What the library's own result would have written.
    pub fn bits_of(&self, deformed: &Deformed) -> Vec<u32> {
        let threes =
            |all: &[Vec3]| all.iter().flat_map(|v| v.to_array()).map(f32::to_bits).collect::<Vec<_>>();
        let mut bits = Vec::new();
        for mesh in &deformed.meshes {
            bits.extend(threes(&mesh.positions));
            bits.extend(threes(&mesh.normals));
            bits.extend(mesh.tangents.iter().flat_map(|v| v.to_array()).map(f32::to_bits));
            let none = vec![Vec3::ZERO; mesh.positions.len()];
            for which in 0..3 {
                for target in &mesh.morph_targets {
                    let deltas = [&target.positions, &target.normals, &target.tangents][which];
                    bits.extend(threes(if deltas.is_empty() { &none } else { deltas }));
                }
            }
        }
        bits
    }
}

/// Where the joints are now.
pub fn joints_of(deformer: SdefDeformer) -> (Vec<DVec3>, Vec<[f64; 16]>) {
    let mut count = 0;
    ask(|error| unsafe { sdef_deformer_get_joints(deformer, null_mut(), null_mut(), 0, &mut count, error) })
        .unwrap();
    let (mut positions, mut binds) = (vec![DVec3::NAN; count], vec![[f64::NAN; 16]; count]);
    ask(|error| unsafe {
        let (p, b) = (positions.as_mut_ptr().cast(), binds.as_mut_ptr().cast());
        sdef_deformer_get_joints(deformer, p, b, count, null_mut(), error)
    })
    .unwrap();
    (positions, binds)
}
