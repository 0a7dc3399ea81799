//! Numbers that carry their gradient, so that a map is written once and its Jacobian is exact; and eight numbers side by side, so
//! that it is done for eight points at once.

use glam::{DMat3, DVec3};
use std::ops::{Add, Mul, Neg, Sub};
use wide::{CmpGt, CmpLt, f32x8};

/// A number, with or without its gradient, or eight of them.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// A constant.
    fn constant(value: f64) -> Self;

    /// Its square root; 0 at and below 0.
    fn root(self) -> Self;

    /// `then` where it is below `limit`, `otherwise` where it is not.
    fn below(self, limit: f64, then: Self, otherwise: Self) -> Self;

    /// `low` times it where it is below 0, `high` times where it is not.
    #[inline(always)]
    fn by_side(self, low: f64, high: f64) -> Self {
        self * self.below(0.0, Self::constant(low), Self::constant(high))
    }

    /// True where some of it is above `limit`.
    fn is_above(self, limit: f64) -> bool;

    /// True where some of it is below `limit`.
    fn is_below(self, limit: f64) -> bool;
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn root(self) -> Self {
        self.max(0.0).sqrt()
    }

    fn below(self, limit: f64, then: Self, otherwise: Self) -> Self {
        if self < limit { then } else { otherwise }
    }

    fn is_above(self, limit: f64) -> bool {
        self > limit
    }

    fn is_below(self, limit: f64) -> bool {
        self < limit
    }
}

/// Eight numbers, in single precision: as exact as what is written of them.
#[derive(Clone, Copy, Debug)]
pub struct Eight(pub f32x8);

impl Number for Eight {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self(f32x8::splat(value as f32))
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.max(f32x8::ZERO).sqrt())
    }

    #[inline(always)]
    fn below(self, limit: f64, then: Self, otherwise: Self) -> Self {
        Self(self.0.cmp_lt(f32x8::splat(limit as f32)).blend(then.0, otherwise.0))
    }

    #[inline(always)]
    fn is_above(self, limit: f64) -> bool {
        self.0.cmp_gt(f32x8::splat(limit as f32)).any()
    }

    #[inline(always)]
    fn is_below(self, limit: f64) -> bool {
        self.0.cmp_lt(f32x8::splat(limit as f32)).any()
    }
}

macro_rules! eight {
    ($($operator:ident $name:ident $by:tt;)+) => {$(
        impl $operator for Eight {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0 $by other.0)
            }
        }

        impl $operator<f64> for Eight {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                Self(self.0 $by f32x8::splat(other as f32))
            }
        }
    )+};
}

eight! { Add add +; Sub sub -; Mul mul *; }

impl Neg for Eight {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// 0 up to 0, 1 from 1 on; slope and curvature are 0 at both ends.
pub(crate) fn step<N: Number>(t: N) -> N {
    if !t.is_above(0.0) {
        return N::constant(0.0);
    }
    if !t.is_below(1.0) {
        return N::constant(1.0);
    }
    let between = t * t * t * ((t * 6.0 - 15.0) * t + 10.0);
    t.below(0.0, N::constant(0.0), t.below(1.0, between, N::constant(1.0)))
}

/// A number and its derivatives by the three coordinates of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The number.
    pub value: f64,
    /// Its derivatives.
    pub gradient: DVec3,
}

impl Dual {
    /// The coordinates of `p`.
    pub fn point(p: DVec3) -> [Self; 3] {
        [(p.x, DVec3::X), (p.y, DVec3::Y), (p.z, DVec3::Z)].map(|(value, gradient)| Self { value, gradient })
    }

    /// A point, and the matrix of its derivatives.
    pub fn split(p: [Self; 3]) -> (DVec3, DMat3) {
        let [x, y, z] = p;
        let rows = DMat3::from_cols(x.gradient, y.gradient, z.gradient);
        (DVec3::new(x.value, y.value, z.value), rows.transpose())
    }
}

impl Number for Dual {
    fn constant(value: f64) -> Self {
        Self { value, gradient: DVec3::ZERO }
    }

    fn root(self) -> Self {
        let value = self.value.max(0.0).sqrt();
        let slope = if value > 0.0 { 0.5 / value } else { 0.0 };
        Self { value, gradient: slope * self.gradient }
    }

    fn below(self, limit: f64, then: Self, otherwise: Self) -> Self {
        if self.value < limit { then } else { otherwise }
    }

    fn by_side(self, low: f64, high: f64) -> Self {
        self * if self.value < 0.0 { low } else { high }
    }

    fn is_above(self, limit: f64) -> bool {
        self.value > limit
    }

    fn is_below(self, limit: f64) -> bool {
        self.value < limit
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, gradient: self.gradient + other.gradient }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, gradient: self.gradient - other.gradient }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            gradient: self.value * other.gradient + other.value * self.gradient,
        }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, gradient: -self.gradient }
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Self { value: self.value * other, gradient: self.gradient * other }
    }
}
