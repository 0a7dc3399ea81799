//! What stands around every call: errors become a status and a sentence, panics stop here.

use super::basics::*;
use crate::error::{Element, Error, ErrorKind, Warning};
use crate::options::GroupSettings;
use crate::parallel::lock;
use core::ffi::c_void;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{addr_of, addr_of_mut};
use std::sync::{Mutex, Once};

/// Why a call failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// What the call returns.
    pub status: SdefStatus,
    /// The mesh concerned.
    pub mesh: Option<usize>,
    /// Of which kind, `SDEF_ELEMENT_*`, and which.
    pub element: Option<(u32, usize)>,
    /// One sentence.
    pub message: String,
}

/// What a body gives.
pub type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// About nothing in particular.
    pub fn new(status: SdefStatus, message: impl Into<String>) -> Self {
        Self { status, mesh: None, element: None, message: message.into() }
    }

    /// A mistake in the host's code.
    pub fn argument(message: impl Into<String>) -> Self {
        Self::new(SDEF_STATUS_BAD_ARGUMENT, message)
    }

    /// A wrong number in an array.
    pub fn input(message: impl Into<String>) -> Self {
        Self::new(SDEF_STATUS_BAD_INPUT, message)
    }

    /// About a mesh.
    pub fn in_mesh(mut self, mesh: usize) -> Self {
        self.mesh = Some(mesh);
        self
    }

    /// About an element of the kind `SDEF_ELEMENT_*`.
    pub fn at(mut self, kind: u32, element: usize) -> Self {
        self.element = Some((kind, element));
        self
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let status = match error.kind {
            ErrorKind::BadInput => SDEF_STATUS_BAD_INPUT,
            ErrorKind::NoHumanoid => SDEF_STATUS_NO_HUMANOID,
            ErrorKind::NoGeometry => SDEF_STATUS_NO_GEOMETRY,
            ErrorKind::BadStyle => SDEF_STATUS_BAD_STYLE,
            ErrorKind::BadOption => SDEF_STATUS_BAD_OPTION,
            ErrorKind::Cancelled => SDEF_STATUS_CANCELLED,
            ErrorKind::OutOfMemory => SDEF_STATUS_OUT_OF_MEMORY,
        };
        let message = with_field(&error.message, error.option);
        let element = error.element.map(|element| match element {
            Element::Vertex(index) => (SDEF_ELEMENT_VERTEX, index),
            Element::Triangle(index) => (SDEF_ELEMENT_TRIANGLE, index),
            Element::Joint(index) => (SDEF_ELEMENT_JOINT, index),
        });
        Self { status, mesh: error.mesh, element, message }
    }
}

/// A sentence of the library, with the field that it is about.
pub fn with_field(message: &str, option: Option<&str>) -> String {
    let field = match option {
        // A host names joints by their numbers.
        Some("humanoid") => "role_joints, or sdef_character_rig",
        Some("kinds") => "kind",
        Some("eyes") => "sdef_character_set_face_hints, or kind",
        Some("blend") => "amount",
        // Zeros look as if they did so.
        Some(option) if GroupSettings::default().numbers().iter().any(|(name, _)| *name == option) => {
            return format!("{message}, or NAN to leave it as it is ({option})");
        }
        Some(option) => option,
        None => return message.to_string(),
    };
    format!("{message} ({field})")
}

/// Warnings as a host reads them: a line each, its code first.
pub fn lines<'a>(warnings: impl Iterator<Item = &'a Warning>) -> String {
    warnings
        .map(|warning| {
            let message = with_field(&warning.message, warning.option);
            format!("{}: {}\n", warning.code, message.replace('\n', " "))
        })
        .collect()
}

/// What reports progress to the host; it gives true to go on.
pub fn progress_of(callback: SdefProgress, user: *mut c_void) -> impl FnMut(f32) -> bool {
    move |fraction| match callback {
        // SAFETY: the host's own function with its own pointer.
        Some(callback) => unsafe { callback(user, fraction) == 0 },
        None => true,
    }
}

/// The bytes of `SdefError` before its message.
const HEAD: usize = core::mem::offset_of!(SdefError, message);
/// The size of `SdefError` in version 1 of the ABI, for which its size 0 stands.
const FIRST_ERROR_SIZE: usize = HEAD + MESSAGE;
/// The bytes of a message.
const MESSAGE: usize = 512;

/// Runs `body` and writes how it ended.
///
/// # Safety
/// `error` is NULL or points to as many bytes as its `struct_size` says.
pub unsafe fn call(error: *mut SdefError, body: impl FnOnce() -> Outcome) -> SdefStatus {
    let size = if error.is_null() {
        0
    } else {
        // SAFETY: the caller's struct begins with its size.
        match unsafe { addr_of!((*error).struct_size).read_unaligned() as usize } {
            0 => FIRST_ERROR_SIZE,
            size => size,
        }
    };
    if !error.is_null() && size < FIRST_ERROR_SIZE {
        return SDEF_STATUS_BAD_ARGUMENT;
    }
    keep_quiet();
    let outcome = {
        let _inside = Inside::enter();
        catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|panic| Err(fault(panic.as_ref())))
    };
    let (status, mesh, element, message) = match &outcome {
        Ok(()) => (SDEF_STATUS_OK, None, None, ""),
        Err(failure) => (failure.status, failure.mesh, failure.element, failure.message.as_str()),
    };
    if !error.is_null() {
        let number =
            |index: Option<usize>| index.map_or(SDEF_NONE, |index| index.min(SDEF_NONE as usize) as u32);
        let text = cut(message, MESSAGE).as_bytes();
        // SAFETY: everything written lies within the size that the caller gave.
        unsafe {
            addr_of_mut!((*error).status).write_unaligned(status);
            addr_of_mut!((*error).mesh).write_unaligned(number(mesh));
            addr_of_mut!((*error).element).write_unaligned(number(element.map(|(_, index)| index)));
            addr_of_mut!((*error).element_kind)
                .write_unaligned(element.map_or(SDEF_ELEMENT_NONE, |(kind, _)| kind));
            let to = addr_of_mut!((*error).message).cast::<u8>();
            to.copy_from_nonoverlapping(text.as_ptr(), text.len());
            to.add(text.len()).write(0);
        }
    }
    status
}

/// File and line of the last panic in a call, on whichever of its threads.
static PLACE: Mutex<Option<(String, u32)>> = Mutex::new(None);

/// What a host learns of a panic.
fn fault(panic: &(dyn std::any::Any + Send)) -> Failure {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or_default();
    let place = lock(&PLACE).take();
    let place = place.map_or(String::new(), |(file, line)| format!("{file}:{line}: "));
    let message = format!("a fault of the library, please report it: {place}{text}");
    Failure::new(SDEF_STATUS_INTERNAL, message)
}

/// `text` cut between characters to fit `room` bytes with its NUL.
pub fn cut(text: &str, room: usize) -> &str {
    let most = room.saturating_sub(1).min(text.len());
    let end = (0..=most).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    &text[..end]
}

thread_local! {
    /// How many calls of the library this thread is in: progress callbacks may call back.
    static DEPTH: Cell<usize> = const { Cell::new(0) };
}

/// This thread is in a call.
struct Inside;

impl Inside {
    fn enter() -> Self {
        DEPTH.with(|depth| depth.set(depth.get() + 1));
        Inside
    }
}

impl Drop for Inside {
    fn drop(&mut self) {
        DEPTH.with(|depth| depth.set(depth.get() - 1));
    }
}

/// Keeps panics of our calls, which become a status, from the host's standard error; others are reported as before.
fn keep_quiet() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let in_call = DEPTH.try_with(|depth| depth.get() > 0).unwrap_or(false);
            if !in_call && !crate::parallel::is_worker() {
                return before(info);
            }
            if let (Some(at), Ok(mut place)) = (info.location(), PLACE.try_lock()) {
                *place = Some((at.file().to_string(), at.line()));
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::ffi::{CStr, c_char};

    fn error(size: usize) -> SdefError {
        SdefError {
            struct_size: size as u32,
            status: 99,
            mesh: 99,
            element: 99,
            element_kind: 99,
            message: [b'x' as c_char; MESSAGE],
        }
    }

    fn text(error: &SdefError) -> &str {
        // SAFETY: every call ends the message with a NUL.
        unsafe { CStr::from_ptr(error.message.as_ptr()) }.to_str().unwrap()
    }

    #[test]
    fn a_panic_becomes_a_status() {
        let mut given = error(size_of::<SdefError>());
        let status = unsafe { call(&mut given, || panic!("at the disco")) };
        assert_eq!((status, given.status), (SDEF_STATUS_INTERNAL, SDEF_STATUS_INTERNAL));
        assert_eq!(
            (given.mesh, given.element, given.element_kind),
            (SDEF_NONE, SDEF_NONE, SDEF_ELEMENT_NONE)
        );
        // Another test may panic at the same time, so the line may be its own.
        assert!(text(&given).starts_with("a fault of the library, please report it: src/ffi/guard.rs:"));
        assert!(text(&given).ends_with(": at the disco"), "{}", text(&given));
        let status = unsafe { call(std::ptr::null_mut(), || panic!("{}", 1)) };
        assert_eq!(status, SDEF_STATUS_INTERNAL);
    }

    #[test]
    fn a_panic_of_a_worker_becomes_a_status() {
        let body = || {
            crate::parallel::collect(2, 10, 1, |index| assert_ne!(index, 9, "nine"));
            Ok(())
        };
        let mut given = error(size_of::<SdefError>());
        assert_eq!(unsafe { call(&mut given, body) }, SDEF_STATUS_INTERNAL);
        assert!(text(&given).contains("nine"));
    }

    #[test]
    fn a_message_is_cut_between_characters() {
        for (letter, width) in [("a", 1), ("é", 2), ("髪", 3), ("🦀", 4)] {
            for size in [0, size_of::<SdefError>(), size_of::<SdefError>() + 64] {
                let mut given = error(size);
                let long = letter.repeat(600);
                let failure = Failure::input(long.as_str()).in_mesh(3).at(SDEF_ELEMENT_VERTEX, 7);
                assert_eq!(unsafe { call(&mut given, || Err(failure)) }, SDEF_STATUS_BAD_INPUT);
                assert_eq!((given.mesh, given.element, given.element_kind), (3, 7, SDEF_ELEMENT_VERTEX));
                assert_eq!(text(&given), letter.repeat((MESSAGE - 1) / width));
            }
        }
    }

    #[test]
    fn an_error_struct_without_room_is_refused() {
        for size in [4, HEAD, FIRST_ERROR_SIZE - 4] {
            let mut given = error(size);
            assert_eq!(unsafe { call(&mut given, || Ok(())) }, SDEF_STATUS_BAD_ARGUMENT);
            assert_eq!(given.status, 99);
        }
    }

    #[test]
    fn success_clears_the_error() {
        let mut given = error(size_of::<SdefError>());
        assert_eq!(unsafe { call(&mut given, || Ok(())) }, SDEF_STATUS_OK);
        assert_eq!((given.status, text(&given)), (SDEF_STATUS_OK, ""));
    }
}
