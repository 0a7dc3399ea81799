//! The deformer: made once, applied as often as something changes

use super::basics::{SdefCharacter, SdefDeformer, SdefError, SdefProgress, SdefStatus, SdefStyle};
use super::options::SdefOptions;
use crate::ffi::deformer;
use core::ffi::{c_char, c_void};
use safer_ffi::prelude::*;

/// Where the results of one mesh go; arrays that are NULL are not wanted. Those that the mesh was given without
/// (normals, tangents, morph targets) must be NULL.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefMeshResult {
    /// sizeof(SdefMeshResult)
    pub struct_size: u32,
    /// morph targets that the morph arrays can hold
    pub morph_target_capacity: u32,
    /// vertices that each array can hold, for each morph target
    pub vertex_capacity: usize,
    /// 3 floats a vertex
    pub positions: *mut f32,
    /// bytes from vertex to vertex; 0: 12
    pub position_stride: usize,
    /// 3 floats a vertex, unit length
    pub normals: *mut f32,
    /// bytes from vertex to vertex; 0: 12
    pub normal_stride: usize,
    /// 4 floats a vertex, the handedness kept
    pub tangents: *mut f32,
    /// bytes from vertex to vertex; 0: 16
    pub tangent_stride: usize,
    /// 3 floats a vertex, packed: what a target adds at weight 1, all vertices of the mesh for one target after the other
    pub morph_positions: *mut f32,
    /// likewise; 0 for targets that were given without
    pub morph_normals: *mut f32,
    /// likewise
    pub morph_tangents: *mut f32,
}

/// One bone group: what is done to it, and how large it is; NAN where not known.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefGroup {
    /// terminated; longer names of your own are cut
    pub name: [c_char; 64],
    /// 1 keeps the length of the group's bones
    pub length_scale: f64,
    /// 1 keeps the girth
    pub thickness_scale: f64,
    /// sum over the character's bones, left and right
    pub target_length: f64,
    /// mean distance of the surface
    pub target_radius: f64,
    /// the style's, in its own units
    pub reference_length: f64,
    /// the style's, in its own units
    pub reference_radius: f64,
}

/// What was measured on a body; heights are along up.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefFigure {
    /// extent of all meshes along up
    pub height: f64,
    /// chin to crown (product mode), head joint to head top (paper mode)
    pub head_length: f64,
    /// crown to sole over crown to chin
    pub heads: f64,
    /// height
    pub crown: f64,
    /// height
    pub chin: f64,
    /// height
    pub shoulder_line: f64,
    /// height
    pub crotch: f64,
    /// height
    pub sole: f64,
}

/// The numbers of a run.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefReport {
    /// sizeof(SdefReport)
    pub struct_size: u32,
    /// 1 where the rig was made, 0 where it was the character's own
    pub rig_made: u32,
    /// the character before
    pub target: SdefFigure,
    /// the style; NAN throughout for a style of N heads
    pub reference: SdefFigure,
    /// measured anew on what comes out
    pub result: SdefFigure,
    /// head of the target over head of the style, times head_scale (product mode)
    pub head_ratio: f64,
    /// vertices that the rig left without weights
    pub unreached_vertices: u64,
    /// vertices that were weighted by another rule than the chosen one
    pub fallback_vertices: u64,
}

/// Makes the deformation that gives a character a style. What it needs of the character is read before it begins: that
/// may be changed meanwhile.
///
/// options:        NULL for the defaults; rig_* are not read
/// progress, user: see Progress above; user is handed on
/// deformer:       receives the handle
///
/// Errors: BAD_OPTION, BAD_STYLE, NO_HUMANOID, NO_GEOMETRY, CANCELLED.
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_create(
    character: SdefCharacter,
    style: SdefStyle,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    deformer: *mut SdefDeformer,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::create(character, style, options, progress, user, deformer, error) }
}

/// Changes the options of a deformer, with the same results as a new one and for less: only what hangs on the change is
/// done again. For sliders. What sdef_deformer_set_face has set goes too.
///
/// Errors: as sdef_deformer_create, after which the deformer is as it was; BUSY.
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_set_options(
    deformer: SdefDeformer,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::set_options(deformer, options, progress, user, error) }
}

/// Changes the face alone, until options are set again; nothing of the body is done again.
///
/// squash: as SdefOptions.face_squash, NAN too
/// curve:  SDEF_FACE_CURVE_*
///
/// Errors: BAD_ARGUMENT, BAD_OPTION, BUSY.
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_set_face(
    deformer: SdefDeformer,
    squash: f64,
    curve: u32,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::set_face(deformer, squash, curve, error) }
}

/// Deforms the meshes, into the caller's arrays.
///
/// meshes:         mesh_count structs in the order of the character's meshes, all of one struct_size
/// mesh_count:     as many as the character has
/// progress, user: see Progress above
///
/// Errors: BAD_ARGUMENT, BUFFER_TOO_SMALL with the mesh, OUT_OF_MEMORY, CANCELLED.
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_apply(
    deformer: SdefDeformer,
    meshes: *const SdefMeshResult,
    mesh_count: usize,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::apply(deformer, meshes, mesh_count, progress, user, error) }
}

/// Gives the joints where they are now, in the order of sdef_character_get_joints. They move, and neither turn nor
/// scale: the new rest matrix is the old one with this translation.
///
/// positions:     3 doubles a joint, model space
/// inverse_binds: 16 doubles a joint, the inverse of the new rest matrix: model space to joint space
/// capacity:      joints that each array can hold
/// joint_count:   receives how many there are; may be NULL
///
/// Errors: BAD_INPUT where inverse_binds is wanted and a rest matrix has no inverse.
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_get_joints(
    deformer: SdefDeformer,
    positions: *mut f64,
    inverse_binds: *mut f64,
    capacity: usize,
    joint_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::get_joints(deformer, positions, inverse_binds, capacity, joint_count, error) }
}

/// Maps points that hang from joints: colliders, eyes, viewpoints, the tails of springs.
///
/// joints:    the joint that each point hangs from
/// points:    3 doubles a point, model space
/// count:     points; every array holds as many
/// positions: receives 3 doubles a point, model space
/// scales:    receives a number a point: by how much small things there grow (the radius of a collider)
/// jacobians: receives 9 doubles a point, column by column: how directions and lengths there change
///
/// Errors: BAD_INPUT with the point as the element.
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_map_points(
    deformer: SdefDeformer,
    joints: *const u32,
    points: *const f64,
    count: usize,
    positions: *mut f64,
    scales: *mut f64,
    jacobians: *mut f64,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::map_points(deformer, joints, points, count, positions, scales, jacobians, error) }
}

/// Gives what is done to each bone group.
///
/// capacity:    groups that the array can hold
/// group_count: receives how many there are; may be NULL
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_get_groups(
    deformer: SdefDeformer,
    groups: *mut SdefGroup,
    capacity: usize,
    group_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::get_groups(deformer, groups, capacity, group_count, error) }
}

/// Measures the result and gives the numbers of the run. The first call after a change takes as long as an apply and a
/// measurement together.
///
/// report:   may be NULL
/// json:     receives everything as JSON text: numbers by group and role, times, warnings
/// capacity: bytes that json can hold
/// size:     receives the bytes needed, the terminating NUL among them; may be NULL
///
/// Errors: NO_GEOMETRY where the result is too flat to be measured; BUFFER_TOO_SMALL.
#[ffi_export]
pub unsafe extern "C" fn sdef_deformer_get_report(
    deformer: SdefDeformer,
    report: *mut SdefReport,
    json: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { deformer::get_report(deformer, report, json, capacity, size, error) }
}
