//! From two rigs to a super-deformed body (§V).

pub mod attributes;
pub mod field;
pub mod figure;
pub mod landmarks;
pub mod part_coefficients;
pub mod part_weights;
pub mod parts;
pub mod proportions;
