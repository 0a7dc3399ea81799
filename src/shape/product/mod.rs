//! The product's way: parts that meet at landmarks read from the geometry, one map each, blended by smoothed weights.
//!
//! D-numbers are decisions in `docs/method.md`; "Seen" is what a change of that constant alone did to the targets of
//! `docs/constants.md`: ±30 % where no other is named.

pub mod anatomy;
pub mod binding;
pub mod body;
pub mod coefficients;
pub mod face_input;
pub mod hanging;
pub mod joint_bindings;
pub mod landmarks;
pub mod mirror;
pub mod outside;
pub mod part;
pub mod part_settings;
pub mod part_weights;
pub mod parting;
pub mod parts_field;
pub mod pieces;
pub mod profile;
pub mod repair;
pub mod scales;
pub mod skirt_weights;
pub mod smoothing;
pub mod strand;
pub mod strands;
pub mod target;
pub mod worn;
