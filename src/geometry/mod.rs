//! What the paper's sections stand on: segments, triangles, surfaces, near and shared positions, groups.

pub mod cells;
pub mod groups;
pub mod laplacian;
pub mod mapped;
pub mod point_tree;
pub mod segment;
pub mod smoothstep;
pub mod surface;
pub mod triangle;
pub mod weld;

pub use cells::CellMap;
pub use groups::{Bounds, Groups, bounds, touching};
pub use mapped::{Mapped, outer};
pub use point_tree::PointTree;
pub use segment::foot;
pub use smoothstep::smoothstep;
pub use surface::{Closest, Hit, Surface};
pub use triangle::double_area;
pub use weld::{Neighbours, SEAM, Weld, components, neighbours, weld};
