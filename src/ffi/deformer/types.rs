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

/// The character before.
pub const SDEF_FIGURE_TARGET: u32 = 0;
/// The style; NAN throughout for a style of N heads.
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
    /// head of the target over head of the style, times head_scale (product mode)
    pub head_ratio: f64,
    /// vertices that the rig left without weights
    pub unreached_vertices: u64,
    /// vertices that were weighted by another rule than the chosen one
    pub fallback_vertices: u64,
}
host_structs!(SdefMeshResult, SdefGroup, SdefFigure, SdefReport);
