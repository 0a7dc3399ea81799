//! From two rigs to a super-deformed body (§V).

pub mod attributes;
pub mod body_shape;
pub mod bones;
pub mod coefficients;
pub mod field;
pub mod figure;
pub mod landmarks;
pub mod measure;
pub mod part_coefficients;
pub mod part_weights;
pub mod parts;
pub mod proportions;
pub mod shorten;
pub mod study;
pub mod style;

pub use body_shape::{BodyShape, BoneShape};
pub use bones::BoneField;
pub use coefficients::{Coefficients, coefficients};
pub use measure::{HeadTop, head_top, measure};
pub use shorten::{Shortened, shorten};
pub use study::Study;
pub use style::Style;
