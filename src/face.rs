//! Makes a face younger: lowers the eyes and rounds the chin (§VI, Eqs. 12, 13).
//!
//! D'Arcy Thompson. On growth and form. 1945.
//! Shen, Luo, Huang and Chen. SD models: super-deformed character models. Pacific Graphics 2012 (the sphere of Fig. 7f).

pub mod brows;
pub mod dual;
pub mod eyes;
pub mod face_landmarks;
pub mod head;
pub mod iris;
pub mod islands;
pub mod kernel;
pub mod outline;
pub mod raster;
pub mod rows;
pub mod seat;
pub mod stage;

use crate::error::Warning;
use crate::geometry::{Moved, outer};
use crate::options::FaceCurve;
use glam::{DMat3, DVec3};

/// Beyond 2, f4 folds the chin: its slope at the ends is 1 -+ gamma / 2. D18.
pub const F4_LIMIT: f64 = 1.9;
/// Beyond 1, f2 folds the chin: its slope at the ends is 1 -+ gamma. D18.
pub const F2_LIMIT: f64 = 0.95;

/// Eq. 12: `y` from -0.5 (bottom) to 0.5 (top), `squash` is gamma.
pub fn f2(y: f64, squash: f64) -> f64 {
    squash * (y * y - 0.25) + y
}

/// The slope of Eq. 12.
pub fn f2_slope(y: f64, squash: f64) -> f64 {
    2.0 * squash * y + 1.0
}

/// Eq. 13: `y` from -0.5 (bottom) to 0.5 (top), `squash` is gamma.
pub fn f4(y: f64, squash: f64) -> f64 {
    squash * (y.powi(4) - 0.0625) + y
}

/// The slope of Eq. 13.
pub fn f4_slope(y: f64, squash: f64) -> f64 {
    4.0 * squash * y.powi(3) + 1.0
}

/// The squash that `curve` can bear without folding, and the warning `face_squash_clamped` where that is not the one asked
/// for. f4: at most 1.9 either way; f2: 0.95; the sphere: from 0 to 1.
pub fn bearable_squash(curve: FaceCurve, squash: f64) -> (f64, Option<Warning>) {
    let (low, high) = match curve {
        FaceCurve::F4 => (-F4_LIMIT, F4_LIMIT),
        FaceCurve::F2 => (-F2_LIMIT, F2_LIMIT),
        FaceCurve::Sphere => (0.0, 1.0),
    };
    let bearable = if squash.is_nan() { 0.0 } else { squash.clamp(low, high) };
    let warning = (bearable != squash).then(|| {
        let message = format!("a face squash of {squash} would fold the face: {bearable} is used");
        Warning::new("face_squash_clamped", message).about("face_squash")
    });
    (bearable, warning)
}

/// Eq. 12 or 13 over the height of a box; heights outside stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceMap {
    /// The box's lower end, model units: y = -0.5.
    pub bottom: f64,
    /// Its upper end: y = 0.5.
    pub top: f64,
    /// gamma, as [`bearable_squash`] gives it.
    pub squash: f64,
    /// f2 or f4; the sphere is no map of heights and changes nothing here.
    pub curve: FaceCurve,
}

impl FaceMap {
    /// Where the map takes the height `y`.
    pub fn map(&self, y: f64) -> f64 {
        let Some(inside) = self.inside(y) else { return y };
        let mapped = match self.curve {
            FaceCurve::F4 => f4(inside, self.squash),
            FaceCurve::F2 => f2(inside, self.squash),
            FaceCurve::Sphere => inside,
        };
        // Adding the change leaves a height that does not change as it is, to the last bit.
        y + (mapped - inside) * (self.top - self.bottom)
    }

    /// The map's slope at `y`: 1 where nothing changes.
    pub fn slope(&self, y: f64) -> f64 {
        match (self.inside(y), self.curve) {
            (Some(y), FaceCurve::F4) => f4_slope(y, self.squash),
            (Some(y), FaceCurve::F2) => f2_slope(y, self.squash),
            _ => 1.0,
        }
    }

    /// `y` in the box's own coordinate, from -0.5 to 0.5.
    fn inside(&self, y: f64) -> Option<f64> {
        let extent = self.top - self.bottom;
        (extent > 0.0 && y >= self.bottom && y <= self.top).then(|| (y - self.bottom) / extent - 0.5)
    }
}

/// The sphere approximation that the paper compares with (Fig. 7f): each point moves toward a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereMap {
    /// The sphere's centre.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
    /// 0 leaves a point, 1 puts it on the sphere.
    pub amount: f64,
}

impl SphereMap {
    /// The sphere in the middle of the box from `low` to `high`; its radius is the mean of the box's half extents.
    pub fn in_box(low: DVec3, high: DVec3, amount: f64) -> Self {
        Self { centre: 0.5 * (low + high), radius: 0.5 * (high - low).element_sum() / 3.0, amount }
    }

    /// Where the map takes `p`; the centre, which has no direction, stays.
    pub fn map(&self, p: DVec3) -> DVec3 {
        match (p - self.centre).try_normalize() {
            Some(outward) => p + self.amount * (self.centre + self.radius * outward - p),
            None => p,
        }
    }

    /// The map's Jacobian at `p`; the identity at the centre.
    pub fn jacobian(&self, p: DVec3) -> DMat3 {
        let arm = p - self.centre;
        let Some(outward) = arm.try_normalize() else {
            return DMat3::IDENTITY;
        };
        let around = self.amount * self.radius / arm.length();
        (1.0 - self.amount) * DMat3::IDENTITY + around * (DMat3::IDENTITY - outer(outward, outward))
    }
}

/// What makes a face younger: a curve of heights, a sphere, or nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FaceShape {
    /// The face stays.
    #[default]
    None,
    /// Eq. 12 or 13.
    Curve(FaceMap),
    /// Toward a sphere, inside its box and fading out below it.
    Sphere(SphereMap),
}

impl FaceShape {
    /// The shape over the box from `low` to `high`, with `squash` bounded to what does not fold.
    ///
    /// For the sphere, `squash` is how far to go, 0 to 1.
    pub fn in_box(low: DVec3, high: DVec3, curve: FaceCurve, squash: f64) -> (Self, Option<Warning>) {
        if squash == 0.0 || high.y <= low.y {
            return (Self::None, None);
        }
        let (squash, warning) = bearable_squash(curve, squash);
        let shape = match curve {
            FaceCurve::Sphere => Self::Sphere(SphereMap::in_box(low, high, squash)),
            curve => Self::Curve(FaceMap { bottom: low.y, top: high.y, squash, curve }),
        };
        (shape, warning)
    }

    /// Where the map takes `p`, and its Jacobian there.
    // Inlined, its arithmetic is done ahead of the choice, for every point and on the bytes of another choice: these are
    // often subnormal numbers, which processors are a hundred times as slow with.
    #[inline(never)]
    pub fn map<M: Moved>(&self, p: DVec3) -> M {
        match self {
            Self::None => M::of(p, || DMat3::IDENTITY),
            Self::Curve(map) => {
                M::of(p.with_y(map.map(p.y)), || DMat3::from_diagonal(DVec3::ONE.with_y(map.slope(p.y))))
            }
            Self::Sphere(map) => M::of(map.map(p), || map.jacobian(p)),
        }
    }
}
