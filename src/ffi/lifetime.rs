//! How long handles live

use super::basics::*;
use super::guard::call;
use super::handles;
use safer_ffi::prelude::*;

/// How many handles there are that nobody has destroyed, of all kinds and all threads; 0 where nothing leaks.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub extern "C" fn sdef_live_handles() -> u64 {
    handles::live()
}

/// Destroys what a handle stands for. One call for all kinds, so that an owner of handles needs no more than the id.
///
/// handle: the id of a character, style or deformer; 0 is allowed and does nothing
///
/// Returns at once and is never BUSY: a call that uses the handle on another thread goes on to its end and still writes
/// its arrays, so wait for it before they go. The memory goes with the last such call.
///
/// Errors: BAD_HANDLE.
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_destroy(handle: u64, error: *mut SdefError) -> SdefStatus {
    unsafe { call(error, || handles::remove(handle)) }
}
