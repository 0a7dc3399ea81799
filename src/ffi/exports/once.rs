//! All at once

use super::basics::{SdefError, SdefProgress, SdefStatus, SdefStyle};
use super::character::{SdefMesh, SdefSkeleton};
use super::deformer::SdefMeshResult;
use super::options::SdefOptions;
use crate::ffi::bodies;
use core::ffi::c_void;
use safer_ffi::prelude::*;

/// Deforms meshes in one call, for hosts that keep nothing.
///
/// up, forward:    as in sdef_character_create
/// skeleton:       NULL: a rig is made
/// meshes:         mesh_count structs, all of one struct_size; read before anything is written
/// style:          what they should become
/// options:        NULL for the defaults
/// results:        mesh_count structs, all of one struct_size
/// progress, user: see Progress above
///
/// Errors: those of sdef_character_create to sdef_deformer_apply.
#[ffi_export]
pub unsafe extern "C" fn sdef_super_deform(
    up: *const f32,
    forward: *const f32,
    skeleton: *const SdefSkeleton,
    meshes: *const SdefMesh,
    mesh_count: usize,
    style: SdefStyle,
    options: *const SdefOptions,
    results: *const SdefMeshResult,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe {
        bodies::super_deform(
            up, forward, skeleton, meshes, mesh_count, style, options, results, progress, user, error,
        )
    }
}
