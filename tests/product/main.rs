//! Product mode, file by file as in `src/shape/product`, on people made of tubes: expected values come from how they are
//! built. `models` looks at real models.

#[path = "../common/clothes.rs"]
mod clothes;
#[path = "../common/hair.rs"]
mod common_hair;
#[path = "../common/models.rs"]
mod common_models;
#[path = "../common/people.rs"]
mod people;

mod anatomy;
mod coefficients;
mod face_input;
mod hanging;
mod landmarks;
mod mascots;
mod mirror;
mod models;
mod part;
mod part_weights;
mod parting;
mod parts_field;
mod pieces;
mod repair;
mod scales;
mod smoothing;
mod tubes;
