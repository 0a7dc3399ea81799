//! The rig, for characters without a skeleton

use super::basics::{SdefCharacter, SdefError, SdefProgress, SdefStatus};
use super::options::SdefOptions;
use crate::ffi::{bodies, character};
use core::ffi::{c_char, c_void};
use safer_ffi::prelude::*;

/// Finds joints and weights for a character, in place of any rig that was made before. Joints of its own stay, come
/// first, and ride along with the body; its own weights are not used.
///
/// options: NULL for the defaults; thread_count, rig_weights, rig_garments, rig_voxel_resolution, rig_fingers,
///          rig_chin_segment, rig_heat, rig_joints and rig_left_handed are read
///
/// Read the result with sdef_character_get_joints and sdef_character_get_weights. Errors: BAD_OPTION, NO_GEOMETRY, BUSY,
/// CANCELLED.
#[ffi_export]
pub unsafe extern "C" fn sdef_character_rig(
    character: SdefCharacter,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { character::rig(character, options, progress, user, error) }
}

/// Gives what a person should know about the rig and roles of a character, or about a deformer and all before it: one
/// line each, "code: sentence\n", where code is a fixed word such as joint_by_ratio. Empty text where all is well.
///
/// handle:   the id of a character or deformer
/// text:     receives the lines
/// capacity: bytes that text can hold
/// size:     receives the bytes needed, the terminating NUL among them; may be NULL
#[ffi_export]
pub unsafe extern "C" fn sdef_get_warnings(
    handle: u64,
    text: *mut c_char,
    capacity: usize,
    size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    unsafe { bodies::get_warnings(handle, text, capacity, size, error) }
}
