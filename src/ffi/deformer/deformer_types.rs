//! Where results go, and what is said of figures.

use crate::ffi::arrays::host_structs;
use core::ffi::c_char;
use safer_ffi::prelude::*;

/// Where the results of one mesh go; arrays that are NULL are left out. Those that the mesh was given without
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
    /// sizeof(SdefGroup)
    pub struct_size: u32,
    /// 0
    pub reserved: u32,
    /// terminated; longer names of your own are cut
    pub name: [c_char; 64],
    /// 1 keeps the length of the group's bones
    pub length_scale: f64,
    /// 1 keeps the thickness
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

/// A ball around the first point.
pub const SDEF_COLLIDER_SPHERE: u32 = 0;
/// Round, from the first point to the second.
pub const SDEF_COLLIDER_CAPSULE: u32 = 1;
/// Through the first point; the second is its normal, to where springs may be.
pub const SDEF_COLLIDER_PLANE: u32 = 2;
/// A sphere that springs are kept inside of.
pub const SDEF_COLLIDER_INSIDE_SPHERE: u32 = 3;
/// A capsule that springs are kept inside of.
pub const SDEF_COLLIDER_INSIDE_CAPSULE: u32 = 4;

/// A collider of springs; lengths and points in model space.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefCollider {
    /// sizeof(SdefCollider)
    pub struct_size: u32,
    /// SDEF_COLLIDER_*
    pub kind: u32,
    /// the joint that it moves with
    pub joint: u32,
    /// elements of springs
    pub spring_count: u32,
    /// the springs that it is for: indices into the call's array springs; NULL where there are none
    pub springs: *const u32,
    /// the first point
    pub x: f64,
    /// the first point
    pub y: f64,
    /// the first point
    pub z: f64,
    /// the second point, or the normal
    pub end_x: f64,
    /// the second point, or the normal
    pub end_y: f64,
    /// the second point, or the normal
    pub end_z: f64,
    /// of spheres and capsules
    pub radius: f64,
    /// of a result: the share of its radius that it yields to springs, 0 to 0.2
    pub yielded: f64,
    /// of a result: springs that start inside and did not
    pub newly_inside: u32,
    /// 0
    pub reserved: u32,
}

/// The ball that a spring keeps out of colliders, at the end of its bone; model space.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefSpringBall {
    /// sizeof(SdefSpringBall)
    pub struct_size: u32,
    /// the joint at the end of the bone
    pub joint: u32,
    /// its middle
    pub x: f64,
    /// its middle
    pub y: f64,
    /// its middle
    pub z: f64,
    /// its radius
    pub radius: f64,
}

/// The character before.
pub const SDEF_FIGURE_TARGET: u32 = 0;
/// The style; NAN throughout for one that is nothing but a number of heads.
pub const SDEF_FIGURE_REFERENCE: u32 = 1;
/// Measured anew on what comes out.
pub const SDEF_FIGURE_RESULT: u32 = 2;

/// What was measured on a body; heights are along up. NAN: not known.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdefFigure {
    /// sizeof(SdefFigure)
    pub struct_size: u32,
    /// 0
    pub reserved: u32,
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
    /// the report's g: head length of the target over that of the style, times head_scale; 1 for a style that is nothing
    /// but a number of heads
    pub head_ratio: f64,
    /// vertices that the rig left without weights
    pub unreached_vertices: u64,
    /// vertices that were weighted by another rule than the chosen one
    pub fallback_vertices: u64,
}
host_structs!(SdefMeshResult, SdefCollider(reserved), SdefSpringBall, SdefGroup, SdefFigure, SdefReport);
