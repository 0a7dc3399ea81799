//! What a map of space does to a point.

use glam::{DMat3, DVec3};

/// Where a map takes a point, and what it does around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mapped {
    /// The point's new place.
    pub position: DVec3,
    /// The map's Jacobian at the point.
    pub jacobian: DMat3,
}

impl Mapped {
    /// `p` where nothing moves it.
    pub const fn unmoved(p: DVec3) -> Self {
        Self { position: p, jacobian: DMat3::IDENTITY }
    }

    /// What the map `next` makes of what comes out of this one.
    #[inline(always)]
    pub fn then(self, next: impl FnOnce(DVec3) -> Mapped) -> Self {
        let Mapped { position, jacobian } = next(self.position);
        Self { position, jacobian: jacobian * self.jacobian }
    }

    /// The scale of small things at this point: the cube root of the Jacobian's determinant.
    pub fn local_scale(&self) -> f64 {
        self.jacobian.determinant().abs().cbrt()
    }
}

/// The product of a column and a row.
pub fn outer(column: DVec3, row: DVec3) -> DMat3 {
    DMat3::from_cols(column * row.x, column * row.y, column * row.z)
}
