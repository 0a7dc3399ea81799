//! Characters as files for hosts that link no Rust: open, set, write, beside the functions of `superdeform.h`, whose
//! conventions hold here too. `python/superdeform/files.py` is the other side.

// What crosses to C needs it, as in the library's own `src/ffi`.
#![allow(unsafe_code, clippy::missing_safety_doc)]

use core::ffi::{CStr, c_char, c_void};
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError, TryLockError};
use superdeform::Progress;
use superdeform::internals::ffi::basics::*;
use superdeform::internals::ffi::guard::{Failure, Outcome, call, progress_of};
use superdeform::internals::ffi::handles::{self, Object};
use superdeform::internals::ffi::options::{self, SdefOptions};
use superdeform_host::conversion::{Conversion, OpenOptions, Reference, RigChoice, Source, WriteOptions};

/// What is open, by its handle. The library's own table of handles knows characters, styles and deformers.
#[derive(Default)]
struct Table {
    last: u64,
    open: BTreeMap<u64, Arc<Mutex<State>>>,
}

static TABLE: LazyLock<Mutex<Table>> = LazyLock::new(Mutex::default);

struct State {
    conversion: Conversion,
    /// The file and its report, from the first call of `sdef_conversion_write` to the next of `sdef_conversion_set`.
    written: Option<(Vec<u8>, String)>,
}

fn table() -> std::sync::MutexGuard<'static, Table> {
    TABLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does something with what is open under a handle.
fn with<T>(handle: u64, work: impl FnOnce(&mut State) -> Outcome<T>) -> Outcome<T> {
    let state = table().open.get(&handle).cloned().ok_or_else(|| {
        let message =
            format!("the handle {handle} is no open conversion: give what sdef_conversion_open gave");
        Failure::new(SDEF_STATUS_BAD_HANDLE, message)
    })?;
    match state.try_lock() {
        Ok(mut state) => work(&mut state),
        // A call that failed has put back what it took.
        Err(TryLockError::Poisoned(state)) => work(&mut state.into_inner()),
        Err(TryLockError::WouldBlock) => {
            let message = "the conversion is in use by another call: wait for it";
            Err(Failure::new(SDEF_STATUS_BUSY, message))
        }
    }
}

fn not_null<T>(what: &str, to: *const T) -> Outcome {
    if to.is_null() { Err(Failure::argument(format!("{what} is NULL: give an address"))) } else { Ok(()) }
}

/// A text of the caller's; empty for NULL.
///
/// # Safety
/// `from` is NULL or ends with a NUL.
unsafe fn text(from: *const c_char) -> String {
    if from.is_null() {
        String::new()
    } else {
        unsafe { CStr::from_ptr(from) }.to_string_lossy().into_owned()
    }
}

/// Writes a number where the caller wants it.
///
/// # Safety
/// `to` is NULL or can be written.
unsafe fn write_out<T>(to: *mut T, value: T) {
    if !to.is_null() {
        unsafe { to.write_unaligned(value) };
    }
}

/// Copies bytes into the caller's, and says how many there are.
///
/// # Safety
/// `to` is NULL or holds `capacity` bytes; `size` is NULL or can be written.
unsafe fn bytes_out(what: &str, from: &[u8], to: *mut u8, capacity: usize, size: *mut usize) -> Outcome {
    unsafe { write_out(size, from.len()) };
    if to.is_null() {
        return Ok(());
    }
    if capacity < from.len() {
        let need = from.len();
        let message = format!("{what} takes {need} bytes, but there is room for {capacity}: give more");
        return Err(Failure::new(SDEF_STATUS_BUFFER_TOO_SMALL, message));
    }
    unsafe { to.copy_from_nonoverlapping(from.as_ptr(), from.len()) };
    Ok(())
}

/// The caller's bytes.
///
/// # Safety
/// `start` points to `size` bytes that stay during the call.
unsafe fn bytes_of<'a>(start: *const u8, size: usize) -> Outcome<&'a [u8]> {
    if size == 0 {
        return Ok(&[]);
    }
    not_null("bytes", start)?;
    Ok(unsafe { std::slice::from_raw_parts(start, size) })
}

fn source<'a>(name: &'a str, bytes: &'a [u8]) -> Source<'a> {
    Source { name, bytes, beside: &|_| None }
}

/// Opens a character.
///
/// name:             of the file, for sentences
/// bytes, size:      GLB, VRM 0.x or 1.0; read during the call
/// humanoid_map:     role to node name as a JSON object, where the file does not say; may be NULL
/// new_rig:          1 makes a rig whatever there is, 0 where there is none that has the roles that are needed
/// allow_prohibited: 1 takes what its licence forbids to change: the user is its author or may change it
/// options:          NULL for the defaults; rig_* and thread_count are read
/// conversion:       receives the handle, to be given to sdef_conversion_close
///
/// Errors: BAD_INPUT; BAD_OPTION for joints that are given beside a rig; CANCELLED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdef_conversion_open(
    name: *const c_char,
    bytes: *const u8,
    size: usize,
    humanoid_map: *const c_char,
    new_rig: u32,
    allow_prohibited: u32,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    conversion: *mut u64,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        not_null("conversion", conversion)?;
        let (name, bytes) = (text(name), bytes_of(bytes, size)?);
        let map = text(humanoid_map);
        let map = match map.as_str() {
            "" => None,
            map => Some(serde_json::from_str(map).map_err(|fault| {
                Failure::argument(format!(
                    "humanoid_map is no JSON ({fault}): give an object of role and node name"
                ))
            })?),
        };
        let (_, rig_options) = options::read(options)?;
        let asked = OpenOptions {
            humanoid_map: map,
            rig: if new_rig == 0 { RigChoice::Found } else { RigChoice::New },
            rig_options,
            allow_prohibited: allow_prohibited != 0,
            ..OpenOptions::default()
        };
        let mut callback = progress_of(progress, user);
        let opened = Conversion::open(source(&name, bytes), &asked, &mut Progress::new(&mut callback))?;
        let mut table = table();
        table.last += 1;
        let handle = table.last;
        table.open.insert(handle, Arc::new(Mutex::new(State { conversion: opened, written: None })));
        write_out(conversion, handle);
        Ok(())
    };
    unsafe { call(error, body) }
}

/// Gives an open character a style, as often as something changes.
///
/// options: NULL for the defaults; rig_* are not read
///
/// Errors: as sdef_deformer_create, after which all is as it was; BUSY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdef_conversion_set(
    conversion: u64,
    style: SdefStyle,
    options: *const SdefOptions,
    progress: SdefProgress,
    user: *mut c_void,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        let style = handles::style(style)?;
        let (options, _) = options::read(options)?;
        let mut callback = progress_of(progress, user);
        with(conversion, |state| {
            state.conversion.set(&style, &options, &mut Progress::new(&mut callback))?;
            state.written = None;
            Ok(())
        })
    };
    unsafe { call(error, body) }
}

/// Gives the file of an open character that has a style, and its report. They are made by the first call after
/// sdef_conversion_set, and kept until the next.
///
/// bytes:           receives the file: GLB, or VRM of the version that came in
/// capacity:        bytes that it can hold
/// size:            receives the bytes needed; may be NULL
/// report:          receives JSON text, by the keys that README lists
/// report_capacity: bytes that report can hold
/// report_size:     receives the bytes needed, the terminating NUL among them; may be NULL
///
/// Errors: BAD_INPUT before the first sdef_conversion_set, or for a file of 2 GB or more; BUFFER_TOO_SMALL; BUSY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdef_conversion_write(
    conversion: u64,
    bytes: *mut u8,
    capacity: usize,
    size: *mut usize,
    report: *mut c_char,
    report_capacity: usize,
    report_size: *mut usize,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        with(conversion, |state| {
            if state.written.is_none() {
                let converted = state.conversion.write(None, &WriteOptions::default())?;
                state.written = Some((converted.file.to_bytes()?, converted.report_text(None)? + "\0"));
            }
            let (file, text) = state.written.as_ref().expect("it was just written");
            // Sizes are told even where the first array is too small.
            write_out(report_size, text.len());
            bytes_out("the file", file, bytes, capacity, size)?;
            bytes_out("the report", text.as_bytes(), report.cast(), report_capacity, report_size)?;
            Ok(())
        })
    };
    unsafe { call(error, body) }
}

/// Closes what is open; 0 is allowed and does nothing.
///
/// Errors: BAD_HANDLE; BUSY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdef_conversion_close(conversion: u64, error: *mut SdefError) -> SdefStatus {
    let body = || {
        if conversion != 0 {
            with(conversion, |_| Ok(()))?;
            table().open.remove(&conversion);
        }
        Ok(())
    };
    unsafe { call(error, body) }
}

/// Measures a super-deformed character in a file, so that others can be made like it.
///
/// name, bytes, size: as in sdef_conversion_open
/// options:           NULL for the defaults; mode, rays, bone_groups, rig_* and thread_count are read
/// style:             receives the handle, to be given to sdef_destroy
///
/// Errors: BAD_INPUT, NO_HUMANOID, NO_GEOMETRY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdef_style_from_file(
    name: *const c_char,
    bytes: *const u8,
    size: usize,
    options: *const SdefOptions,
    style: *mut SdefStyle,
    error: *mut SdefError,
) -> SdefStatus {
    let body = || unsafe {
        not_null("style", style)?;
        let (name, bytes) = (text(name), bytes_of(bytes, size)?);
        let (options, rig_options) = options::read(options)?;
        let reference = Reference::open(source(&name, bytes), None, &options, &rig_options)?;
        let measured = superdeform::Style::Shape(Box::new(reference.shape().clone()));
        write_out(style, SdefStyle { id: handles::insert(Object::Style(Arc::new(measured)))? });
        Ok(())
    };
    unsafe { call(error, body) }
}
