//! What the paper's sections stand on: segments, surfaces, shared positions.

pub mod segment;
pub mod surface;
pub mod weld;

pub use segment::foot;
pub use surface::{Closest, Hit, Surface};
pub use weld::{Neighbours, Weld, components, neighbours, weld};
