//! Which way an unrigged figure looks, found from its geometry.

use crate::character::Character;
use crate::error::{Result, Warning};
use glam::DVec3;

/// The way `character` looks, model space, at right angles to up, of length 1, and what a person should know.
///
/// # Errors
/// As [`super::Layout::of`].
pub fn find_forward(_character: &Character) -> Result<(DVec3, Vec<Warning>)> {
    unimplemented!()
}
