//! From two rigs to a super-deformed body (§V).

pub mod body_shape;
pub mod bones;
pub mod coefficients;
pub mod measure;
pub mod shorten;

pub use body_shape::{BodyShape, BoneShape};
pub use bones::BoneField;
pub use coefficients::{Coefficients, coefficients};
pub use measure::{HeadTop, head_top, measure};
pub use shorten::{Shortened, shorten};
