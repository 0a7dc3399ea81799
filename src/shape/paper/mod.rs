//! The paper's own way, literally: coefficients of bone groups (Eqs. 9-11), a shortened skeleton (Eqs. 1-4), a chain of
//! bones that moves the mesh (Eqs. 5-8).

pub mod body;
pub mod coefficients;
pub mod field;
pub mod shorten;

pub use coefficients::{Coefficients, coefficients};
pub use field::BoneField;
pub use shorten::{Shortened, shorten};
