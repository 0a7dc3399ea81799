//! What each mesh of an unrigged figure depicts: as the host says, else guessed from its name and from where it lies.

use super::{FoundJoint, Layout};
use crate::character::{MeshKind, Role};
use crate::error::Warning;
use std::collections::BTreeMap;

/// A kind for every mesh of `layout`, and a warning that names those that were guessed without being sure.
///
/// Runs before joints are known; [`refine_kinds`] looks again once they are.
pub fn guess_kinds(_layout: &Layout) -> (Vec<MeshKind>, Vec<Warning>) {
    unimplemented!()
}

/// Kinds once more, for the meshes that nobody has named, now that it is known where the head is.
pub fn refine_kinds(
    _layout: &Layout,
    _kinds: &mut [MeshKind],
    _joints: &BTreeMap<Role, FoundJoint>,
) -> Vec<Warning> {
    unimplemented!()
}

/// True where the meshes of kind body alone make a whole figure.
pub fn body_is_whole(_layout: &Layout, _kinds: &[MeshKind]) -> bool {
    unimplemented!()
}
