//! What concerns all kinds of handles, and the call that does everything.

use super::arrays;
use super::character::{self, CharacterState};
use super::deformer::DeformerState;
use super::exports::basics::*;
use super::exports::character::{SdefMesh, SdefSkeleton};
use super::exports::deformer::SdefMeshResult;
use super::exports::options::SdefOptions;
use super::guard::{Failure, call, in_words_of_hosts};
use super::options;
use super::table::{self, Object};
use crate::error::Warning;
use crate::progress::Progress;
use core::ffi::{c_char, c_void};

/// What tells the host's callback; true to go on.
pub fn teller(progress: SdefProgress, user: *mut c_void) -> impl FnMut(f32) -> bool {
    move |fraction| match progress {
        // SAFETY: the host's own function with its own pointer.
        Some(callback) => unsafe { callback(user, fraction.clamp(0.0, 1.0)) == 0 },
        None => true,
    }
}

/// The body of `sdef_destroy`.
pub unsafe fn destroy(handle: u64, error: *mut SdefError) -> SdefStatus {
    unsafe { call(error, || table::remove(handle)) }
}

/// The body of `sdef_options_init`.
pub unsafe fn options_init(options: *mut SdefOptions, struct_size: u32, error: *mut SdefError) -> SdefStatus {
    unsafe { call(error, || options::init(options, struct_size)) }
}

/// The body of `sdef_get_warnings`.
pub unsafe fn get_warnings(
    handle: u64,
    text: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let lines = match table::any(handle, "character or deformer")? {
            Object::Character(state) => {
                let ready = table::read(&state, "character")?.ready();
                match &ready.rigged {
                    Some((rig, _)) => lines(rig.warnings.iter()),
                    None => lines(ready.warnings.iter()),
                }
            }
            Object::Deformer(state) => lines(table::read(&state, "deformer")?.warnings()),
            Object::Style(_) => {
                return Err(Failure::new(
                    SDEF_STATUS_BAD_HANDLE,
                    format!(
                        "the handle {handle:#x} is a style, but a character or deformer is asked for: give one"
                    ),
                ));
            }
        };
        arrays::text_out(&lines, text, capacity, size)
    };
    unsafe { call(error, body) }
}

fn lines<'a>(warnings: impl Iterator<Item = &'a Warning>) -> String {
    warnings
        .map(|warning| {
            format!("{}: {}\n", warning.code, in_words_of_hosts(&warning.message).replace('\n', " "))
        })
        .collect()
}

/// The body of `sdef_super_deform`.
#[allow(clippy::too_many_arguments)]
pub unsafe fn super_deform(
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
        let style = table::style(style)?;
        let (options, rig_options) = options::read(options)?;
        options.validate()?;
        let results = arrays::structs_in("SdefMeshResult", results, mesh_count)?;
        let mut state = CharacterState::new(character::axes(up, forward)?);
        if !skeleton.is_null() {
            let (skeleton, roles) = character::read_skeleton(skeleton)?;
            state.set_skeleton(skeleton, roles)?;
        }
        for (index, mesh) in arrays::structs_in("SdefMesh", meshes, mesh_count)?.iter().enumerate() {
            let read = character::read_mesh_at(index, mesh)?;
            state.add_mesh(read)?;
        }
        let mut teller = teller(progress, user);
        let mut progress = Progress::new(&mut teller);
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
