//! What the paper's sections stand on: segments, triangles, surfaces, boxes, near and shared positions, groups.

/// What differs by less, in figures about 1 high, differs by rounding; nothing is divided by less.
pub const ROUNDING: f64 = 1e-6;

/// In place of an index: there is none.
pub const NONE: u32 = u32::MAX;

pub mod bounds;
pub mod cells;
pub mod groups;
pub mod laplacian;
pub mod lists;
pub mod mapped;
pub mod means;
pub mod point_tree;
pub mod profile;
pub mod segment;
pub mod slice;
pub mod smoothstep;
pub mod surface;
pub mod triangle;
pub mod weld;
pub mod whole;
pub mod winding;

pub use bounds::{Bounds, bounds, bounds_by_group, clusters, grown_clusters, range};
pub use cells::CellMap;
pub use groups::{Groups, Rows, by_number, least_costs, merge_tree};
pub use lists::{by_key, distinct, marked, slots};
pub use mapped::{Mapped, Moved, outer};
pub use means::{mean, median, upper_median};
pub use point_tree::PointTree;
pub use profile::{CHIN_BAND, CHIN_BY_RATIO, CHIN_STEP, StepSearch, deepest_step, lowest};
pub use segment::foot;
pub use slice::{Outline, Planes, slices};
pub use smoothstep::{smoothstep, smoothstep_slope};
pub use surface::{Closest, Hit, Surface, Tree};
pub use triangle::{cut_at, double_area, triangles_where};
pub use weld::{Neighbours, SEAM, Weld, components, neighbours, rim_edges, weld};
pub use winding::WindingGroups;
