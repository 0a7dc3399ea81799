//! The rig, for characters without a skeleton

use super::arrays;
use super::basics::*;
use super::guard::{call, lines, progress_of};
use super::handles::{self, Object};
use super::options::{self, SdefOptions};
use crate::progress::Progress;
use core::ffi::{c_char, c_void};
use safer_ffi::prelude::*;

/// Finds joints and weights for a character, in place of any rig that was made before. Joints of its own stay, come
/// first, and move with the body; its own weights are not used.
///
/// options: NULL for the defaults; thread_count, rig_weights, rig_garments, rig_voxel_resolution, rig_fingers,
///          rig_left_handed, rig_heat and rig_joints are read
///
/// Read the result with sdef_character_get_joints and sdef_character_get_weights. Errors: BAD_OPTION, NO_GEOMETRY, BUSY,
/// CANCELLED.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_character_rig(
    character: SdefCharacter,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let state = handles::character(character)?;
        let (_, options) = options::read(options)?;
        let mut callback = progress_of(progress, user);
        handles::write(&state, "character")?.make_rig(&options, &mut Progress::new(&mut callback))
    };
    unsafe { call(error, body) }
}

/// Writes the warnings about the rig and roles of a character, or about a deformer and all before it: a line each,
/// "code: sentence\n", where code is a fixed word such as joint_by_ratio (README lists them). Empty text where there are
/// none. What only the result shows (clothes_pierced) is among them once the result is measured (sdef_deformer_measure).
///
/// handle:   the id of a character or deformer
/// text:     receives the lines
/// capacity: bytes that text can hold
/// size:     receives the bytes needed, the terminating NUL among them; may be NULL
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_get_warnings(
    handle: u64,
    text: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let lines = match handles::find(handle) {
            Some(Object::Character(state)) => {
                let ready = handles::read(&state, "character")?.ready();
                match &ready.rigged {
                    Some((rig, _)) => lines(rig.warnings.iter()),
                    None => lines(ready.warnings.iter()),
                }
            }
            Some(Object::Deformer(state)) => handles::read(&state, "deformer")?.warnings(),
            _ => return Err(handles::bad_handle(handle, "character or deformer")),
        };
        arrays::text_out(&lines, text, capacity, size)
    };
    unsafe { call(error, body) }
}
