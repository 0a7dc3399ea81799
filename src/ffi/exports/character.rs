//! The character
//!
//! Meshes and joints in rest pose: the pose in which vertices and joints fit together, best with arms out (T or A pose).

use super::basics::{SdefCharacter, SdefError, SdefStatus};
use crate::ffi::character;
use core::ffi::{c_char, c_void};
use safer_ffi::prelude::*;

/// Guessed from the name; else body, or what sdef_character_rig sees in it.
pub const SDEF_MESH_UNKNOWN: u32 = 0;
/// Skin, or skin fused with clothes.
pub const SDEF_MESH_BODY: u32 = 1;
/// Clothes.
pub const SDEF_MESH_GARMENT: u32 = 2;
/// Hair of the head.
pub const SDEF_MESH_HAIR: u32 = 3;
/// Eyes, brows, lashes, teeth, tongue: what follows the face.
pub const SDEF_MESH_FACE_PART: u32 = 4;
/// Hats, glasses, bags, weapons: what keeps its shape.
pub const SDEF_MESH_ACCESSORY: u32 = 5;

/// uint32_t for indices and joints, float for weights.
pub const SDEF_TYPE_DEFAULT: u32 = 0;
/// uint8_t; as a weight 255 stands for 1.
pub const SDEF_TYPE_U8: u32 = 1;
/// uint16_t; as a weight 65535 stands for 1.
pub const SDEF_TYPE_U16: u32 = 2;
/// uint32_t; indices and joints only.
pub const SDEF_TYPE_U32: u32 = 3;
/// float; weights only.
pub const SDEF_TYPE_F32: u32 = 4;

/// Humanoid roles: the numbers of Unity's HumanBodyBones under the names of VRM 1.0 (Unity calls the thumb's joints
/// Proximal, Intermediate, Distal).
pub const SDEF_ROLE_COUNT: u32 = 55;
#[allow(missing_docs)]
pub const SDEF_ROLE_HIPS: u32 = 0;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_UPPER_LEG: u32 = 1;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_UPPER_LEG: u32 = 2;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_LOWER_LEG: u32 = 3;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_LOWER_LEG: u32 = 4;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_FOOT: u32 = 5;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_FOOT: u32 = 6;
#[allow(missing_docs)]
pub const SDEF_ROLE_SPINE: u32 = 7;
#[allow(missing_docs)]
pub const SDEF_ROLE_CHEST: u32 = 8;
#[allow(missing_docs)]
pub const SDEF_ROLE_NECK: u32 = 9;
#[allow(missing_docs)]
pub const SDEF_ROLE_HEAD: u32 = 10;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_SHOULDER: u32 = 11;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_SHOULDER: u32 = 12;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_UPPER_ARM: u32 = 13;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_UPPER_ARM: u32 = 14;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_LOWER_ARM: u32 = 15;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_LOWER_ARM: u32 = 16;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_HAND: u32 = 17;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_HAND: u32 = 18;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_TOES: u32 = 19;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_TOES: u32 = 20;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_EYE: u32 = 21;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_EYE: u32 = 22;
#[allow(missing_docs)]
pub const SDEF_ROLE_JAW: u32 = 23;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_THUMB_METACARPAL: u32 = 24;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_THUMB_PROXIMAL: u32 = 25;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_THUMB_DISTAL: u32 = 26;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_INDEX_PROXIMAL: u32 = 27;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_INDEX_INTERMEDIATE: u32 = 28;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_INDEX_DISTAL: u32 = 29;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_MIDDLE_PROXIMAL: u32 = 30;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_MIDDLE_INTERMEDIATE: u32 = 31;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_MIDDLE_DISTAL: u32 = 32;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_RING_PROXIMAL: u32 = 33;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_RING_INTERMEDIATE: u32 = 34;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_RING_DISTAL: u32 = 35;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_LITTLE_PROXIMAL: u32 = 36;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_LITTLE_INTERMEDIATE: u32 = 37;
#[allow(missing_docs)]
pub const SDEF_ROLE_LEFT_LITTLE_DISTAL: u32 = 38;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_THUMB_METACARPAL: u32 = 39;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_THUMB_PROXIMAL: u32 = 40;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_THUMB_DISTAL: u32 = 41;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_INDEX_PROXIMAL: u32 = 42;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_INDEX_INTERMEDIATE: u32 = 43;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_INDEX_DISTAL: u32 = 44;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_MIDDLE_PROXIMAL: u32 = 45;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_MIDDLE_INTERMEDIATE: u32 = 46;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_MIDDLE_DISTAL: u32 = 47;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_RING_PROXIMAL: u32 = 48;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_RING_INTERMEDIATE: u32 = 49;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_RING_DISTAL: u32 = 50;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_LITTLE_PROXIMAL: u32 = 51;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_LITTLE_INTERMEDIATE: u32 = 52;
#[allow(missing_docs)]
pub const SDEF_ROLE_RIGHT_LITTLE_DISTAL: u32 = 53;
#[allow(missing_docs)]
pub const SDEF_ROLE_UPPER_CHEST: u32 = 54;

/// A mesh. Zero it, set struct_size, and fill in what there is.
///
/// Weights come in one of two shapes, or not at all (all zero: the mesh has no rig, or waits for one):
/// fixed: influence_count joints and weights a vertex, vertex after vertex; row_starts is NULL.
/// rows:  vertex v has the joints and weights row_starts[v] to row_starts[v + 1] - 1; influence_count is how many there
///        are in all, row_starts holds vertex_count + 1 numbers that rise from 0, both strides are 0.
/// Weights are 0 or more; each vertex's are scaled to sum 1 where it matters. Weight 0 may name any joint. A vertex
/// whose weights are all 0 moves with the hips.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefMesh {
    /// sizeof(SdefMesh)
    pub struct_size: u32,
    /// SDEF_MESH_*
    pub kind: u32,
    /// for messages, and for guessing the kind, as in "node/mesh/material", of which the last
    /// that says one counts; may be NULL
    pub name: *const c_char,
    /// up to 4294967294
    pub vertex_count: usize,
    /// 3 floats a vertex, model units
    pub positions: *const f32,
    /// bytes from vertex to vertex; 0: 12
    pub position_stride: usize,
    /// 3 floats a vertex, of any length: unit vectors come out; may be NULL
    pub normals: *const f32,
    /// bytes from vertex to vertex; 0: 12
    pub normal_stride: usize,
    /// 4 floats a vertex: a vector, of any length too, and the handedness; may be NULL
    pub tangents: *const f32,
    /// bytes from vertex to vertex; 0: 16
    pub tangent_stride: usize,
    /// 3 vertices a triangle, packed
    pub indices: *const c_void,
    /// numbers in indices: 3 times the triangles
    pub index_count: usize,
    /// SDEF_TYPE_U8, _U16 or _U32 (or 0): how wide the array's numbers are
    pub index_type: u32,
    /// SDEF_TYPE_U8, _U16 or _U32 (or 0), likewise
    pub joint_type: u32,
    /// SDEF_TYPE_U8, _U16 or _F32 (or 0), likewise
    pub weight_type: u32,
    /// 0
    pub reserved: u32,
    /// joints a vertex (fixed), or in all (rows)
    pub influence_count: usize,
    /// indices of joints
    pub joints: *const c_void,
    /// bytes from vertex to vertex; 0: influence_count joints
    pub joint_stride: usize,
    /// one for each joint
    pub weights: *const c_void,
    /// bytes from vertex to vertex; 0: influence_count weights
    pub weight_stride: usize,
    /// vertex_count + 1 numbers (rows), or NULL (fixed)
    pub row_starts: *const u32,
}

/// A morph target (blend shape): what is added to each vertex of a mesh at weight 1. All arrays are as long as the mesh.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefMorphTarget {
    /// sizeof(SdefMorphTarget)
    pub struct_size: u32,
    /// 0
    pub reserved: u32,
    /// for messages; may be NULL
    pub name: *const c_char,
    /// 3 floats a vertex, model units
    pub positions: *const f32,
    /// bytes from vertex to vertex; 0: 12
    pub position_stride: usize,
    /// 3 floats a vertex; may be NULL
    pub normals: *const f32,
    /// bytes from vertex to vertex; 0: 12
    pub normal_stride: usize,
    /// 3 floats a vertex: changes of the direction; may be NULL
    pub tangents: *const f32,
    /// bytes from vertex to vertex; 0: 12
    pub tangent_stride: usize,
}

/// All joints of a character, those without a humanoid role too.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefSkeleton {
    /// sizeof(SdefSkeleton)
    pub struct_size: u32,
    /// elements of role_joints, up to SDEF_ROLE_COUNT
    pub role_count: u32,
    /// joint_count texts, for messages and for guessing roles; may be NULL, and so may each
    pub names: *const *const c_char,
    /// joints
    pub joint_count: usize,
    /// the joint that each hangs from, or -1; in any order
    pub parents: *const i32,
    /// a matrix a joint, joint space to model space, at rest
    pub rest_matrices: *const f64,
    /// bytes from matrix to matrix; 0: 128
    pub rest_stride: usize,
    /// by SDEF_ROLE_*: the joint that plays the role, or -1; a joint plays one role; where hips, head, an upper leg or
    /// upper arm is left out, roles are guessed from names and the shape of the skeleton; may be NULL
    pub role_joints: *const i32,
}

/// What a character holds.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefCharacterInfo {
    /// sizeof(SdefCharacterInfo)
    pub struct_size: u32,
    /// meshes
    pub mesh_count: u32,
    /// joints, those of a made rig among them
    pub joint_count: u32,
    /// joints that came with the character: the first ones
    pub own_joint_count: u32,
    /// of all meshes
    pub morph_target_count: u32,
    /// 1 where sdef_character_rig has made a rig
    pub rig_made: u32,
    /// of all meshes
    pub vertex_count: u64,
    /// of all meshes
    pub triangle_count: u64,
}

/// Makes an empty character.
///
/// up:        3 floats, from the feet to the head, any length but 0; NULL: (0, 1, 0)
/// forward:   3 floats, the way the face looks, at any angle to up but 0; NULL: found from left and right limbs, as in
///            right-handed axes, so a left-handed host gives it; without joints from feet and face
/// character: receives the handle
///
/// Errors: BAD_ARGUMENT, BAD_INPUT.
#[ffi_export]
pub unsafe extern "C" fn sdef_character_create(
    up: *const f32,
    forward: *const f32,
    character: *mut SdefCharacter,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { character::create(up, forward, character, error) }
}

/// Gives a character its joints, in place of any that it had. Comes before meshes with weights, which name joints.
///
/// Errors: BAD_ARGUMENT; BAD_INPUT with the joint as the element: a parent that is none, a circle of parents, a number
/// that is not finite, a matrix row by row, a role for a joint that is none or has one; or weights of a mesh for a joint
/// that is no more.
#[ffi_export]
pub unsafe extern "C" fn sdef_character_set_skeleton(
    character: SdefCharacter,
    skeleton: *const SdefSkeleton,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { character::set_skeleton(character, skeleton, error) }
}

/// Adds a mesh; everything is copied. A rig made before goes: it did not know this mesh.
///
/// index: receives the mesh's index, counted from 0; may be NULL
///
/// Errors: BAD_ARGUMENT; BAD_INPUT with the vertex or triangle as the element; OUT_OF_MEMORY.
#[ffi_export]
pub unsafe extern "C" fn sdef_character_add_mesh(
    character: SdefCharacter,
    mesh: *const SdefMesh,
    index: *mut u32,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { character::add_mesh(character, mesh, index, error) }
}

/// Adds a morph target to a mesh, after those that it has.
///
/// Errors: BAD_ARGUMENT also for a mesh that is none; BAD_INPUT with the vertex as the element; OUT_OF_MEMORY.
#[ffi_export]
pub unsafe extern "C" fn sdef_character_add_morph_target(
    character: SdefCharacter,
    mesh: u32,
    target: *const SdefMorphTarget,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { character::add_morph_target(character, mesh, target, error) }
}

/// Counts what a character holds.
#[ffi_export]
pub unsafe extern "C" fn sdef_character_get_info(
    character: SdefCharacter,
    info: *mut SdefCharacterInfo,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { character::get_info(character, info, error) }
}

/// Gives the joints back: own ones first, then those of a made rig, parents in any order.
///
/// parents:       the joint that each hangs from, or -1
/// roles:         SDEF_ROLE_* as given, guessed or made, or SDEF_NONE
/// rest_matrices: 16 doubles a joint
/// confidence:    0 to 1; below 0.5 a made joint was placed by ratio or is doubtful; 1 for given and own joints
/// capacity:      joints that each array can hold
/// joint_count:   receives how many joints there are; may be NULL
#[ffi_export]
pub unsafe extern "C" fn sdef_character_get_joints(
    character: SdefCharacter,
    parents: *mut i32,
    roles: *mut u32,
    rest_matrices: *mut f64,
    confidence: *mut f64,
    capacity: usize,
    joint_count: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe {
        character::get_joints(
            character,
            parents,
            roles,
            rest_matrices,
            confidence,
            capacity,
            joint_count,
            error,
        )
    }
}

/// Gives the weights that animate one mesh: those of a made rig, else its own.
///
/// influence_count: joints a vertex, 1 to 255: the largest weights, largest first, scaled to sum 1; what a vertex has no
///                  use for is joint 0 with weight 0
/// joints, weights: influence_count numbers a vertex
/// capacity:        vertices that each array can hold
///
/// Errors: BAD_ARGUMENT also for a mesh that is none; BAD_INPUT for a mesh without weights.
#[ffi_export]
pub unsafe extern "C" fn sdef_character_get_weights(
    character: SdefCharacter,
    mesh: u32,
    influence_count: u32,
    joints: *mut u32,
    weights: *mut f32,
    capacity: usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { character::get_weights(character, mesh, influence_count, joints, weights, capacity, error) }
}
