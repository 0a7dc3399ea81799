//! Version, status, errors, handles

use core::ffi::{CStr, c_char, c_void};
use safer_ffi::prelude::*;

/// Compared with sdef_abi_version() before anything else.
pub const SDEF_ABI_VERSION: u32 = 1;
/// Of the release that this header belongs to.
pub const SDEF_VERSION_MAJOR: u32 = 1;
/// Likewise.
pub const SDEF_VERSION_MINOR: u32 = 0;
/// Likewise.
pub const SDEF_VERSION_PATCH: u32 = 0;

/// No mesh, no element, no role.
pub const SDEF_NONE: u32 = 0xFFFF_FFFF;

/// How a call ended: one of SDEF_STATUS_*.
pub type SdefStatus = u32;
/// Done.
pub const SDEF_STATUS_OK: u32 = 0;
/// A NULL, size, stride or constant that cannot be: an error in the host's code.
pub const SDEF_STATUS_BAD_ARGUMENT: u32 = 1;
/// The handle is none, was destroyed, was never given, or is of another kind.
pub const SDEF_STATUS_BAD_HANDLE: u32 = 2;
/// A number in an array is wrong: an index, a position that is not finite.
pub const SDEF_STATUS_BAD_INPUT: u32 = 3;
/// An option is out of its range.
pub const SDEF_STATUS_BAD_OPTION: u32 = 4;
/// A style cannot be read, or lacks what the mode transfers.
pub const SDEF_STATUS_BAD_STYLE: u32 = 5;
/// No joints for hips, head, upper legs, upper arms: name them, or make a rig.
pub const SDEF_STATUS_NO_HUMANOID: u32 = 6;
/// There are no triangles, or they have no extent along up.
pub const SDEF_STATUS_NO_GEOMETRY: u32 = 7;
/// An array of the caller's is too small; see Arrays out above.
pub const SDEF_STATUS_BUFFER_TOO_SMALL: u32 = 8;
/// The handle is in use, by another thread or by the call around this one.
pub const SDEF_STATUS_BUSY: u32 = 9;
/// The progress callback asked to stop.
pub const SDEF_STATUS_CANCELLED: u32 = 10;
/// Memory could not be had; see Memory above.
pub const SDEF_STATUS_OUT_OF_MEMORY: u32 = 11;
/// A fault of this library; the host goes on. Please report it with the message.
pub const SDEF_STATUS_INTERNAL: u32 = 12;

/// No element is concerned.
pub const SDEF_ELEMENT_NONE: u32 = 0;
/// A vertex of the mesh.
pub const SDEF_ELEMENT_VERTEX: u32 = 1;
/// A triangle of the mesh.
pub const SDEF_ELEMENT_TRIANGLE: u32 = 2;
/// A joint of the skeleton.
pub const SDEF_ELEMENT_JOINT: u32 = 3;
/// A point, joint or spring of sdef_deformer_map_points or _map_colliders.
pub const SDEF_ELEMENT_POINT: u32 = 4;
/// An element of SdefOptions.groups.
pub const SDEF_ELEMENT_GROUP: u32 = 5;
/// An element of SdefOptions.bone_groups.
pub const SDEF_ELEMENT_BONE_GROUP: u32 = 6;
/// An element of SdefOptions.rig_joints.
pub const SDEF_ELEMENT_GIVEN_JOINT: u32 = 7;
/// An element of the array bones of sdef_style_from_numbers.
pub const SDEF_ELEMENT_BONE: u32 = 8;
/// An element of the array colliders of sdef_deformer_map_colliders.
pub const SDEF_ELEMENT_COLLIDER: u32 = 9;

/// What went wrong. The caller's: SDEF_ERROR_INIT or {0} before the first call; every call fills it anew.
#[derive_ReprC]
#[repr(C)]
pub struct SdefError {
    /// sizeof(SdefError), or 0 for the size that it had in version 1 of the ABI
    pub struct_size: u32,
    /// as returned
    pub status: SdefStatus,
    /// index of the mesh concerned, or SDEF_NONE
    pub mesh: u32,
    /// index of the element concerned, or SDEF_NONE
    pub element: u32,
    /// what element counts: SDEF_ELEMENT_*
    pub element_kind: u32,
    /// one sentence, UTF-8, always terminated, cut between characters; empty after SDEF_STATUS_OK
    pub message: [c_char; 512],
}

/// Called now and then with what part of the work is done, 0 to 1; anything but 0 cancels.
pub type SdefProgress = Option<unsafe extern "C" fn(user: *mut c_void, fraction: f32) -> i32>;

/// A character: meshes, joints, weights.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SdefCharacter {
    /// 0: none
    pub id: u64,
}

/// What a character should become.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SdefStyle {
    /// 0: none
    pub id: u64,
}

/// A character together with the deformation that gives it a style.
#[derive_ReprC]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SdefDeformer {
    /// 0: none
    pub id: u64,
}

/// The version of the library's ABI, to compare with SDEF_ABI_VERSION before anything else: another number is another
/// ABI, with which nothing else may be called. It rises when a function, field or constant goes or changes its meaning.
/// What is only added (functions, fields at the end of structs with struct_size, constants) raises SDEF_VERSION_MINOR.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn sdef_abi_version() -> u32 {
    SDEF_ABI_VERSION
}

/// The library's release, such as "1.0.0-rc.1". Static text.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn sdef_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// The name of a status, such as "SDEF_STATUS_BUSY"; "unknown status" for other numbers. Static text.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn sdef_status_name(status: SdefStatus) -> *const c_char {
    name_of(status).as_ptr()
}

fn name_of(status: SdefStatus) -> &'static CStr {
    match status {
        SDEF_STATUS_OK => c"SDEF_STATUS_OK",
        SDEF_STATUS_BAD_ARGUMENT => c"SDEF_STATUS_BAD_ARGUMENT",
        SDEF_STATUS_BAD_HANDLE => c"SDEF_STATUS_BAD_HANDLE",
        SDEF_STATUS_BAD_INPUT => c"SDEF_STATUS_BAD_INPUT",
        SDEF_STATUS_BAD_OPTION => c"SDEF_STATUS_BAD_OPTION",
        SDEF_STATUS_BAD_STYLE => c"SDEF_STATUS_BAD_STYLE",
        SDEF_STATUS_NO_HUMANOID => c"SDEF_STATUS_NO_HUMANOID",
        SDEF_STATUS_NO_GEOMETRY => c"SDEF_STATUS_NO_GEOMETRY",
        SDEF_STATUS_BUFFER_TOO_SMALL => c"SDEF_STATUS_BUFFER_TOO_SMALL",
        SDEF_STATUS_BUSY => c"SDEF_STATUS_BUSY",
        SDEF_STATUS_CANCELLED => c"SDEF_STATUS_CANCELLED",
        SDEF_STATUS_OUT_OF_MEMORY => c"SDEF_STATUS_OUT_OF_MEMORY",
        SDEF_STATUS_INTERNAL => c"SDEF_STATUS_INTERNAL",
        _ => c"unknown status",
    }
}
