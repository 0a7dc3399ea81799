//! What a character is made of: kinds of meshes, types of numbers, roles of joints, structs.
#![allow(missing_docs)]

use crate::ffi::arrays::host_structs;
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
/// Brows, lashes, teeth, tongue: what follows the face.
pub const SDEF_MESH_FACE_PART: u32 = 4;
/// Hats, glasses, bags, weapons: what keeps its shape.
pub const SDEF_MESH_ACCESSORY: u32 = 5;
/// Eyeballs, irises, pupils: face parts that keep their shape.
pub const SDEF_MESH_EYE: u32 = 6;

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
pub const SDEF_ROLE_HIPS: u32 = 0;
pub const SDEF_ROLE_LEFT_UPPER_LEG: u32 = 1;
pub const SDEF_ROLE_RIGHT_UPPER_LEG: u32 = 2;
pub const SDEF_ROLE_LEFT_LOWER_LEG: u32 = 3;
pub const SDEF_ROLE_RIGHT_LOWER_LEG: u32 = 4;
pub const SDEF_ROLE_LEFT_FOOT: u32 = 5;
pub const SDEF_ROLE_RIGHT_FOOT: u32 = 6;
pub const SDEF_ROLE_SPINE: u32 = 7;
pub const SDEF_ROLE_CHEST: u32 = 8;
pub const SDEF_ROLE_NECK: u32 = 9;
pub const SDEF_ROLE_HEAD: u32 = 10;
pub const SDEF_ROLE_LEFT_SHOULDER: u32 = 11;
pub const SDEF_ROLE_RIGHT_SHOULDER: u32 = 12;
pub const SDEF_ROLE_LEFT_UPPER_ARM: u32 = 13;
pub const SDEF_ROLE_RIGHT_UPPER_ARM: u32 = 14;
pub const SDEF_ROLE_LEFT_LOWER_ARM: u32 = 15;
pub const SDEF_ROLE_RIGHT_LOWER_ARM: u32 = 16;
pub const SDEF_ROLE_LEFT_HAND: u32 = 17;
pub const SDEF_ROLE_RIGHT_HAND: u32 = 18;
pub const SDEF_ROLE_LEFT_TOES: u32 = 19;
pub const SDEF_ROLE_RIGHT_TOES: u32 = 20;
pub const SDEF_ROLE_LEFT_EYE: u32 = 21;
pub const SDEF_ROLE_RIGHT_EYE: u32 = 22;
pub const SDEF_ROLE_JAW: u32 = 23;
pub const SDEF_ROLE_LEFT_THUMB_METACARPAL: u32 = 24;
pub const SDEF_ROLE_LEFT_THUMB_PROXIMAL: u32 = 25;
pub const SDEF_ROLE_LEFT_THUMB_DISTAL: u32 = 26;
pub const SDEF_ROLE_LEFT_INDEX_PROXIMAL: u32 = 27;
pub const SDEF_ROLE_LEFT_INDEX_INTERMEDIATE: u32 = 28;
pub const SDEF_ROLE_LEFT_INDEX_DISTAL: u32 = 29;
pub const SDEF_ROLE_LEFT_MIDDLE_PROXIMAL: u32 = 30;
pub const SDEF_ROLE_LEFT_MIDDLE_INTERMEDIATE: u32 = 31;
pub const SDEF_ROLE_LEFT_MIDDLE_DISTAL: u32 = 32;
pub const SDEF_ROLE_LEFT_RING_PROXIMAL: u32 = 33;
pub const SDEF_ROLE_LEFT_RING_INTERMEDIATE: u32 = 34;
pub const SDEF_ROLE_LEFT_RING_DISTAL: u32 = 35;
pub const SDEF_ROLE_LEFT_LITTLE_PROXIMAL: u32 = 36;
pub const SDEF_ROLE_LEFT_LITTLE_INTERMEDIATE: u32 = 37;
pub const SDEF_ROLE_LEFT_LITTLE_DISTAL: u32 = 38;
pub const SDEF_ROLE_RIGHT_THUMB_METACARPAL: u32 = 39;
pub const SDEF_ROLE_RIGHT_THUMB_PROXIMAL: u32 = 40;
pub const SDEF_ROLE_RIGHT_THUMB_DISTAL: u32 = 41;
pub const SDEF_ROLE_RIGHT_INDEX_PROXIMAL: u32 = 42;
pub const SDEF_ROLE_RIGHT_INDEX_INTERMEDIATE: u32 = 43;
pub const SDEF_ROLE_RIGHT_INDEX_DISTAL: u32 = 44;
pub const SDEF_ROLE_RIGHT_MIDDLE_PROXIMAL: u32 = 45;
pub const SDEF_ROLE_RIGHT_MIDDLE_INTERMEDIATE: u32 = 46;
pub const SDEF_ROLE_RIGHT_MIDDLE_DISTAL: u32 = 47;
pub const SDEF_ROLE_RIGHT_RING_PROXIMAL: u32 = 48;
pub const SDEF_ROLE_RIGHT_RING_INTERMEDIATE: u32 = 49;
pub const SDEF_ROLE_RIGHT_RING_DISTAL: u32 = 50;
pub const SDEF_ROLE_RIGHT_LITTLE_PROXIMAL: u32 = 51;
pub const SDEF_ROLE_RIGHT_LITTLE_INTERMEDIATE: u32 = 52;
pub const SDEF_ROLE_RIGHT_LITTLE_DISTAL: u32 = 53;
pub const SDEF_ROLE_UPPER_CHEST: u32 = 54;

/// A mesh. Zero it, set struct_size, and fill in what there is.
///
/// Weights come in one of two shapes, or not at all (all zero: the mesh has no rig, or waits for one):
/// fixed: influence_count joints and weights a vertex, vertex after vertex; row_starts is NULL.
/// rows:  vertex v has the joints and weights row_starts[v] to row_starts[v + 1] - 1; influence_count is how many there
///        are in all, row_starts holds vertex_count + 1 numbers that rise from 0, both strides are 0.
/// Weights are 0 or more; each vertex's are scaled to sum 1 where it matters. Weight 0 may name any joint. A vertex
/// whose weights are all 0 moves with the hips, and so does a mesh without weights beside a skeleton: what is rigid
/// (a sword, a helmet) has a joint of its own where it begins, a child of the joint that holds it, and weight 1 to that.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefMesh {
    /// sizeof(SdefMesh)
    pub struct_size: u32,
    /// SDEF_MESH_*
    pub kind: u32,
    /// for messages, and for guessing the kind from English words (hair, eyelash, skirt, hat); may be NULL. Best is
    /// "node/mesh/material": the part that the fewest meshes share is read first. A word counts only for a mesh that lies
    /// where such a thing does: hair on the head
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
    /// how bright the surface is: a byte a vertex, from black (0) to white (255) as screens show it; may be NULL. By this,
    /// or by uvs and image, the face step sees irises and brows that are painted; left out, they stay as they are
    pub luminance: *const u8,
    /// bytes from vertex to vertex; 0: 1
    pub luminance_stride: usize,
    /// 2 floats a vertex: where it lies on the image, (0, 0) at the first pixel, (1, 1) at the last; the image repeats
    /// beyond; may be NULL
    pub uvs: *const f32,
    /// bytes from vertex to vertex; 0: 8
    pub uv_stride: usize,
    /// what sdef_character_add_image gave for the image that the mesh shows, or 0
    pub image: u32,
    /// 0
    pub reserved_2: u32,
}

/// How bright a texture is: its base colour without the colours, as 54 red + 183 green + 19 blue of 256.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefImage {
    /// sizeof(SdefImage)
    pub struct_size: u32,
    /// pixels in a row, 1 to 65536; above 512 a smaller one is made of it
    pub width: u32,
    /// rows, likewise
    pub height: u32,
    /// 0
    pub reserved: u32,
    /// width bytes a row, the row of v = 0 first
    pub pixels: *const u8,
    /// bytes from row to row; 0: width
    pub row_stride: usize,
}

/// What a host knows of a face, in model space. Without it eyes are found by their meshes, blinks or joints, or as small
/// twin pieces.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefFaceHints {
    /// sizeof(SdefFaceHints)
    pub struct_size: u32,
    /// 0
    pub reserved: u32,
    /// 3 doubles: the middle of an eye's opening; NULL: nothing is known
    pub eye: *const f64,
    /// 3 doubles: that of the other one; NULL: its mirror image
    pub other_eye: *const f64,
    /// half the width of an opening; 0: not known
    pub half_width: f64,
    /// half its height; 0: not known
    pub half_height: f64,
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
    /// joint_count texts, for messages and for guessing roles, as Unity, VRM, Mixamo, Rigify, MMD and other tools name
    /// joints; may be NULL, and so may each
    pub names: *const *const c_char,
    /// joints
    pub joint_count: usize,
    /// the parent of each joint, or -1; in any order
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

host_structs!(
    SdefMesh(reserved, reserved_2),
    SdefImage(reserved),
    SdefFaceHints(reserved),
    SdefMorphTarget(reserved),
    SdefSkeleton,
    SdefCharacterInfo
);
