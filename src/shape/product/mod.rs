//! The product's way: parts that meet at landmarks read from the geometry, one map each, blended by smoothed weights.

pub mod anatomy;
pub mod binding;
pub mod coefficients;
pub mod field;
pub mod groups;
pub mod hair;
pub mod landmarks;
pub mod part;
pub mod pieces;
pub mod scales;
pub mod smoothing;
pub mod weights;
