//! The paper's own way, literally: coefficients of bone groups (Eqs. 9-11), a shortened skeleton (Eqs. 1-4), a chain of
//! bones that moves the mesh (Eqs. 5-8).

pub mod alpha_beta;
pub mod bone_field;
pub mod equations;
pub mod shorten;

pub use alpha_beta::{Coefficients, coefficients};
pub use bone_field::BoneField;
pub use shorten::{Shortened, shorten};
