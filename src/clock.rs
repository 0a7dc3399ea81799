//! How long stages take. A browser's plain WebAssembly has no clock: there everything takes no time.

use std::time::Instant;

/// A moment; `None` where there is no clock.
#[derive(Clone, Copy, Debug)]
pub struct Moment(Option<Instant>);

impl Moment {
    /// This one.
    pub fn now() -> Self {
        // On wasm32-unknown-unknown the standard library's clock panics.
        Self((!cfg!(all(target_family = "wasm", target_os = "unknown"))).then(Instant::now))
    }

    /// Milliseconds since it was; 0 where there is no clock.
    pub fn milliseconds(self) -> f64 {
        self.0.map_or(0.0, |at| at.elapsed().as_secs_f64() * 1e3)
    }
}
