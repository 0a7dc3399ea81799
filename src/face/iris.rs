//! Painted irises: where on an eyeball the dark disc is, how large, and how it grows on the ball.

use super::dual::step;
use super::head::{Head, quantile};
use super::raster::{DepthMap, Window};
use crate::geometry::Bounds;
use glam::DVec3;

/// An iris on a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iris {
    /// Where its middle is, from the ball's middle, in the ball's half extents: of unit length.
    pub towards: DVec3,
    /// How far its edge is from there, in radians.
    pub angle: f64,
}

/// Squares of a look at a ball, in its widths.
const SQUARES: f64 = 48.0;
/// Only what looks to the front this much is seen well.
const FACING: f64 = 0.45;
/// Dark is below this part of the way from a ball's darkest to its lightest 3 and 10 of 100.
const DARK: f64 = 0.55;
/// See [`DARK`].
const DARKEST: (f64, f64) = (0.03, 0.90);
/// A ball whose lights and darks differ less has no iris that is seen.
const CONTRAST: f64 = 0.15;
/// An iris lies within this cosine of its middle.
const NEAR: f64 = 0.8;
/// Rings about its middle in which the share of dark is looked at, in radians.
const RING: f64 = 0.04;

/// The iris on the ball of `vertices`, in ascending order, that fills the box from `low` to `high`, from how bright it
/// is; `None` where nobody knows that, or it shows none.
pub fn iris(head: &Head, vertices: &[u32], (low, high): Bounds) -> Option<Iris> {
    let is_own = |corners: &&[u32; 3]| corners.iter().all(|corner| vertices.binary_search(corner).is_ok());
    let own: Vec<[u32; 3]> = head.parts.triangles.iter().filter(is_own).copied().collect();
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let step = 2.0 * half.x / SQUARES;
    let window = Window { low: low.truncate(), high: high.truncate(), step };
    let view = DepthMap::new(&head.points, &own, window);
    let look = |(column, row): (usize, usize)| {
        let p = view.middle(column, row);
        let towards = ((p.extend(view.depth(column, row)?) - middle) / half).normalize_or_zero();
        let triangle = view.triangle(column, row).filter(|_| towards.z > FACING)?;
        Some((towards, head.shade(own[triangle], p)?))
    };
    let seen: Vec<(DVec3, f64)> = view.squares().filter_map(look).collect();
    let mut shades: Vec<f64> = seen.iter().map(|&(_, shade)| shade).collect();
    let (darkest, lightest) = (quantile(&mut shades, DARKEST.0)?, quantile(&mut shades, DARKEST.1)?);
    if lightest - darkest < CONTRAST {
        return None;
    }
    let limit = darkest + DARK * (lightest - darkest);
    let dark: Vec<DVec3> =
        seen.iter().filter(|&&(_, shade)| shade < limit).map(|&(towards, _)| towards).collect();
    let mut towards = dark.iter().sum::<DVec3>().normalize_or_zero();
    for _ in 0..5 {
        let near = dark.iter().filter(|direction| direction.dot(towards) > NEAR);
        towards = near.sum::<DVec3>().normalize_or_zero();
    }
    let mut rings: Vec<[usize; 2]> = vec![[0; 2]; (1.2 / RING) as usize];
    for &(direction, shade) in &seen {
        let ring = (direction.dot(towards).clamp(-1.0, 1.0).acos() / RING) as usize;
        if let Some(counts) = rings.get_mut(ring) {
            counts[usize::from(shade < limit)] += 1;
        }
    }
    // The middle holds highlights, and few squares.
    let edge = (3..rings.len()).find(|&ring| rings[ring][0] > rings[ring][1])?;
    Some(Iris { towards, angle: edge as f64 * RING })
}

/// How an iris grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrisFlow {
    /// The ball's middle and half extents, before.
    pub middle: DVec3,
    /// See `middle`.
    pub half: DVec3,
    /// What is found there.
    pub iris: Iris,
    /// How many times as large it becomes, at least 1.
    pub growth: f64,
}

/// Nothing of a ball changes further from the iris's middle than this chord, three quarters of the way to its side.
const UNTOUCHED: f64 = 1.535;

impl IrisFlow {
    /// Where a point of the ball is after the share `youth` of the change, before the ball itself moves: it keeps its
    /// distance from the ball's middle, in the ball's half extents.
    pub fn map(&self, p: DVec3, youth: f64) -> DVec3 {
        let from = (p - self.middle) / self.half;
        let radius = from.length();
        if radius <= 0.0 {
            return p;
        }
        let chord = from / radius - self.iris.towards;
        let even = 2.0 * (0.5 * self.iris.angle).sin();
        let fades = 1.0 - step((chord.length() - even) / (UNTOUCHED - even));
        let grown = (from / radius + fades * youth * (self.growth - 1.0) * chord).normalize();
        self.middle + radius * self.half * grown
    }
}
