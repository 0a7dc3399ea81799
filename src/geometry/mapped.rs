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

/// What comes out of a map: a [`Mapped`], or its place alone. Maps that are written for both cost no Jacobian where none is
/// asked for.
pub trait Moved: Copy {
    /// What a map gives.
    fn of(position: DVec3, jacobian: impl FnOnce() -> DMat3) -> Self;
    /// The point's new place.
    fn position(self) -> DVec3;
    /// The map's Jacobian at the point; 0 where none is kept.
    fn jacobian(self) -> DMat3;
}

impl Moved for Mapped {
    #[inline(always)]
    fn of(position: DVec3, jacobian: impl FnOnce() -> DMat3) -> Self {
        Self { position, jacobian: jacobian() }
    }

    #[inline(always)]
    fn position(self) -> DVec3 {
        self.position
    }

    #[inline(always)]
    fn jacobian(self) -> DMat3 {
        self.jacobian
    }
}

impl Moved for DVec3 {
    #[inline(always)]
    fn of(position: DVec3, _: impl FnOnce() -> DMat3) -> Self {
        position
    }

    #[inline(always)]
    fn position(self) -> DVec3 {
        self
    }

    #[inline(always)]
    fn jacobian(self) -> DMat3 {
        DMat3::ZERO
    }
}

/// The product of a column and a row.
pub fn outer(column: DVec3, row: DVec3) -> DMat3 {
    DMat3::from_cols(column * row.x, column * row.y, column * row.z)
}
