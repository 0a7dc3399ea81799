//! All at once

use super::arrays::{self, Structs};
use super::basics::{SdefError, SdefProgress, SdefStatus, SdefStyle};
use super::character::character_state::CharacterState;
use super::character::{SdefMesh, SdefSkeleton, read};
use super::deformer::SdefMeshResult;
use super::deformer::deformer_state::DeformerState;
use super::guard::{call, progress_of};
use super::handles;
use super::options::{self, SdefOptions};
use crate::progress::Progress;
use core::ffi::c_void;
use safer_ffi::prelude::*;

/// Deforms meshes in one call, for hosts that keep nothing.
///
/// up, forward:    as in sdef_character_create
/// skeleton:       NULL: a rig is made
/// meshes:         mesh_count structs, all of one struct_size; read before anything is written; their image is 0
/// style:          what they should become
/// options:        NULL for the defaults
/// results:        mesh_count structs, all of one struct_size
/// progress, user: see Progress above
///
/// Errors: those of sdef_character_create to sdef_deformer_apply.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
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
    let body = || unsafe {
        let style = handles::style(style)?;
        let (options, rig_options) = options::read(options)?;
        options.validate()?;
        let results = Structs::new("results", results, mesh_count)?;
        let mut state = CharacterState::new(read::axes(up, forward)?);
        if !skeleton.is_null() {
            let (skeleton, roles) = read::skeleton(skeleton)?;
            state.set_skeleton(skeleton, roles)?;
        }
        for (index, mesh) in arrays::structs_in("meshes", meshes, mesh_count)?.iter().enumerate() {
            let read = read::mesh_at(index, mesh, state.image(mesh.image))?;
            state.add_mesh(read)?;
        }
        let mut callback = progress_of(progress, user);
        let mut progress = Progress::new(&mut callback);
        let mut start = 0.0;
        if skeleton.is_null() {
            state.make_rig(&rig_options, &mut progress.part(0.0, 0.7))?;
            start = 0.7;
        }
        let middle = 0.5 * (1.0 + start);
        let deformer =
            DeformerState::new(&state.ready(), &style, &options, &mut progress.part(start, middle))?;
        deformer.apply(&results, &mut progress.part(middle, 1.0))
    };
    unsafe { call(error, body) }
}
