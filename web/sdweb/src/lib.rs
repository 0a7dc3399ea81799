//! The library for a page in a browser and for node: a message in, a message out, by six exports of bytes.
//!
//! The other side asks for [`sd_room`], writes a [`message`] there, calls [`sd_call`] and reads the answer, which is one too,
//! from [`sd_answer`]; `session` says what may be asked. A panic ends an instance; what it said can still be read from
//! [`sd_fault`].

pub mod asked;
pub mod message;
pub mod session;

use session::Session;
use std::cell::RefCell;
use std::sync::{Mutex, Once, PoisonError};

thread_local! {
    static GIVEN: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static SESSION: RefCell<Session> = RefCell::new(Session::default());
}

/// What the last panic said.
static FAULT: Mutex<String> = Mutex::new(String::new());

/// Room for a message of so many bytes; it is there until the next call of anything else.
#[unsafe(no_mangle)]
pub extern "C" fn sd_room(size: usize) -> *mut u8 {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        std::panic::set_hook(Box::new(|info| {
            *FAULT.lock().unwrap_or_else(PoisonError::into_inner) = info.to_string();
        }));
    });
    GIVEN.with_borrow_mut(|given| {
        *given = vec![0; size];
        given.as_mut_ptr()
    })
}

/// Does what the message in the room says.
#[unsafe(no_mangle)]
pub extern "C" fn sd_call() {
    let given = GIVEN.take();
    ANSWER.set(Vec::new());
    ANSWER.set(SESSION.with_borrow_mut(|session| session.answer(&given)));
}

/// The answer to the last call.
#[unsafe(no_mangle)]
pub extern "C" fn sd_answer() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// The bytes of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn sd_answer_size() -> usize {
    ANSWER.with_borrow(Vec::len)
}

/// What the panic said that ended this instance, UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn sd_fault() -> *const u8 {
    FAULT.lock().unwrap_or_else(PoisonError::into_inner).as_ptr()
}

/// Its bytes; 0 where there was no panic.
#[unsafe(no_mangle)]
pub extern "C" fn sd_fault_size() -> usize {
    FAULT.lock().unwrap_or_else(PoisonError::into_inner).len()
}
