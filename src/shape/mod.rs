//! From two rigs to a super-deformed body (§V).

pub mod body_shape;
pub mod collider;
pub mod directions;
pub mod field;
pub mod figure;
pub mod group;
pub mod heights;
pub mod measure;
pub mod measured;
pub mod paper;
pub mod placement;
pub mod pose;
pub mod product;
pub mod stride;
pub mod style;
pub mod turn;

pub use body_shape::{BodyShape, BoneShape};
pub use group::{Coefficient, GroupShape};
pub use heights::Heights;
pub use measure::{HeadTop, head_top, measure};
pub use measured::Measured;
pub use paper::{BoneField, Coefficients, Shortened, coefficients, shorten};
pub use style::Style;
