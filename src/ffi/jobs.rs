//! Threads of the host
//!
//! The library starts threads where a call needs them, and ends them with it. A job system of the host's own may do the
//! work instead. There is no such hook for memory: a call gives back what it takes but for what handles keep, and all of
//! it comes from malloc (Windows: the process heap), where hosts count it already.

use super::basics::*;
use super::guard::call;
use crate::parallel::{self, Jobs};
use core::ffi::c_void;
use safer_ffi::prelude::*;
use std::rc::Rc;

/// One piece of a call's work, to be called by SdefJobs: task(data, index).
pub type SdefTask = Option<unsafe extern "C" fn(data: *mut c_void, index: u32)>;

/// A job system: calls task(data, index) once for every index below count, on any threads, beside each other or not,
/// and returns when all of these calls have returned. user is handed on.
pub type SdefJobs =
    Option<unsafe extern "C" fn(user: *mut c_void, task: SdefTask, data: *mut c_void, count: u32)>;

/// Has jobs do the work of all calls that this thread makes from now on, in place of threads of the library's own, which
/// are then not started. Results are the same bits. Tasks neither wait for each other nor call jobs again; there are at
/// most thread_count (SdefOptions) at a time, and a progress callback still comes on the caller's thread alone, between
/// them.
///
/// jobs: NULL: threads of the library's own again
/// user: handed on; must live until jobs is set anew, or this thread ends
#[cfg_attr(not(target_arch = "wasm32"), ffi_export)]
#[cfg_attr(target_arch = "wasm32", unsafe(no_mangle))]
pub unsafe extern "C" fn sdef_set_jobs(
    jobs: SdefJobs,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || {
        parallel::set_jobs(jobs.map(|run| Rc::new(HostJobs { run, user }) as Rc<dyn Jobs>));
        Ok(())
    };
    unsafe { call(error, body) }
}

/// A host's job system.
struct HostJobs {
    run: unsafe extern "C" fn(user: *mut c_void, task: SdefTask, data: *mut c_void, count: u32),
    user: *mut c_void,
}

/// What `data` of a [`SdefTask`] points to.
type Task<'a> = &'a (dyn Fn(usize) + Sync);

impl Jobs for HostJobs {
    fn run(&self, count: usize, task: Task) {
        unsafe extern "C" fn one(data: *mut c_void, index: u32) {
            // SAFETY: the address of the reference below, which lives until all tasks are done.
            unsafe { (*data.cast::<Task>())(index as usize) }
        }
        let mut task = task;
        // SAFETY: the host's own function with its own pointer.
        unsafe { (self.run)(self.user, Some(one), (&raw mut task).cast(), count as u32) }
    }
}
