//! What the paper's sections stand on: segments, surfaces, near and shared positions.

pub mod cells;
pub mod laplacian;
pub mod point_tree;
pub mod segment;
pub mod surface;
pub mod weld;

pub use cells::CellMap;
pub use point_tree::PointTree;
pub use segment::foot;
pub use surface::{Closest, Hit, Surface};
pub use weld::{Neighbours, Weld, components, neighbours, weld};
