//! How far a body reaches around an axis, by height and direction, and a scale for each: a map of its relief.

use super::station::{GOES_AROUND, hits, outer_surface};
use crate::geometry::slice::{Outline, Planes, RAYS};
use crate::geometry::whole::round;
use crate::geometry::{Moved, median};
use glam::{DMat2, DMat3, DVec2, DVec3};
use std::iter::Sum;
use std::ops::Mul;
use std::sync::Arc;

/// No reach counts for more than so many times the usual one of its cut.
const FURTHEST: f64 = 1.6;

/// One number for each direction.
pub type Ring = [f64; RAYS];

/// Reaches by row (height) and direction.
#[derive(Clone, Debug)]
pub struct RadiusMap {
    /// The axis and the directions.
    pub planes: Planes,
    /// Height of the first row.
    pub start: f64,
    /// Height between rows.
    pub step: f64,
    /// Middle of each row.
    pub middles: Arc<[DVec2]>,
    /// By row, then direction.
    pub reaches: Arc<[Ring]>,
    /// What the reaches are scaled by; none where nothing asks for that yet.
    pub scales: Vec<Ring>,
}

/// A point that stays, looked up once in a map whose scales change.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spot {
    /// Its place among the rows, and among the directions.
    at: [f64; 2],
    /// How far it goes where the reach there becomes twice as long.
    way: DVec3,
}

impl RadiusMap {
    /// How the map moves `p`, with the gradient of that for a Jacobian: everything within a reach is scaled about the row's
    /// middle, what lies further out moves as far as the surface does.
    #[inline(always)]
    pub fn shift<M: Moved>(&self, p: DVec3) -> M {
        let (at, arm) = self.locate(p);
        let distance = arm.length();
        if distance <= 0.0 {
            return M::of(DVec3::ZERO, || DMat3::ZERO);
        }
        let (row, ray) = self.taps(at);
        let read = |rings: &[Ring]| row.mixed(|at| ray.mixed(|other| rings[at][other]));
        let (reach, change) = (read(&self.reaches), read(&self.scales) - 1.0);
        let outward = arm / distance;
        let far = change * distance.min(reach);
        M::of(self.lift(far * outward), || {
            let by_height = |rings: &[Ring]| row.sloped(|at| ray.mixed(|other| rings[at][other])) / self.step;
            let by_turn = |rings: &[Ring]| {
                row.mixed(|at| ray.sloped(|other| rings[at][other])) * RAYS as f64 / std::f64::consts::TAU
            };
            // How far outward, by distance, height and angle.
            let (far_by_distance, far_by_height, far_by_turn) = if distance < reach {
                (change, by_height(&self.scales) * distance, by_turn(&self.scales) * distance)
            } else {
                let slope =
                    |by: &dyn Fn(&[Ring]) -> f64| by(&self.scales) * reach + change * by(&self.reaches);
                (0.0, slope(&by_height), slope(&by_turn))
            };
            // Within the plane, by the place in it.
            let around = DVec2::new(-outward.y, outward.x);
            let outer = |a: DVec2, b: DVec2| DMat2::from_cols(a * b.x, a * b.y);
            let by_place = outer(outward, far_by_distance * outward + far_by_turn / distance * around)
                + outer(around, around) * (far / distance);
            let middle_slope: DVec2 = row.sloped(|at| self.middles[at]);
            let by_height = far_by_height * outward - by_place * middle_slope / self.step;
            let [axis, across, front] = [self.planes.axis, self.planes.across, self.planes.front];
            let column = |of: f64, x: f64, y: f64| {
                self.lift(by_height) * of + self.lift(by_place.x_axis) * x + self.lift(by_place.y_axis) * y
            };
            DMat3::from_cols(
                column(axis.x, across.x, front.x),
                column(axis.y, across.y, front.y),
                column(axis.z, across.z, front.z),
            )
        })
    }

    /// The spot of `p`, so much of which the map moves.
    pub fn spot(&self, p: DVec3, share: f64) -> Spot {
        let (at, arm) = self.locate(p);
        let (row, ray) = self.taps(at);
        let reach: f64 = row.mixed(|at| ray.mixed(|other| self.reaches[at][other]));
        Spot { at, way: self.lift(share * arm.clamp_length_max(reach)) }
    }

    /// How the map moves what is at a spot.
    #[inline(always)]
    pub fn shift_of(&self, spot: &Spot) -> DVec3 {
        let (row, ray) = self.taps(spot.at);
        (row.mixed(|at| ray.mixed(|other| self.scales[at][other])) - 1.0) * spot.way
    }

    /// The place of `p` among the rows and among the directions, and how far it is from its row's middle.
    #[inline(always)]
    fn locate(&self, p: DVec3) -> ([f64; 2], DVec2) {
        let (height, place) = self.planes.locate(p);
        let row = (height - self.start) / self.step;
        let arm = place - self.taps([row, 0.0]).0.mixed(|at| self.middles[at]);
        ([row, arm.y.atan2(arm.x) / std::f64::consts::TAU * RAYS as f64], arm)
    }

    /// The rows and the directions around a place.
    #[inline(always)]
    fn taps(&self, [row, ray]: [f64; 2]) -> (Taps, Taps) {
        let last = self.reaches.len() as i64 - 1;
        let row = Taps::new(row, |index| index.clamp(0, last));
        (row, Taps::new(ray, |index| index.rem_euclid(RAYS as i64)))
    }

    #[inline(always)]
    fn lift(&self, v: DVec2) -> DVec3 {
        v.x * self.planes.across + v.y * self.planes.front
    }
}

/// The three samples around a place, by a quadratic B-spline: smooth, and without overshooting.
struct Taps {
    indices: [usize; 3],
    weights: [f64; 3],
    slopes: [f64; 3],
}

impl Taps {
    /// Around `place`, of samples whose numbers `bound` keeps among those that there are.
    #[inline(always)]
    fn new(place: f64, bound: impl Fn(i64) -> i64) -> Self {
        let nearest = round(place);
        let t = place - nearest;
        let nearest = nearest as i64;
        let indices = [nearest.saturating_sub(1), nearest, nearest.saturating_add(1)];
        Self {
            indices: indices.map(|index| bound(index) as usize),
            weights: [0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)],
            slopes: [t - 0.5, -2.0 * t, t + 0.5],
        }
    }

    /// The samples' mean there.
    #[inline(always)]
    fn mixed<T: Sum + Mul<f64, Output = T>>(&self, sample: impl Fn(usize) -> T) -> T {
        (0..3).map(|tap| sample(self.indices[tap]) * self.weights[tap]).sum()
    }

    /// Its slope, by samples.
    #[inline(always)]
    fn sloped<T: Sum + Mul<f64, Output = T>>(&self, sample: impl Fn(usize) -> T) -> T {
        (0..3).map(|tap| sample(self.indices[tap]) * self.slopes[tap]).sum()
    }
}

/// Reaches no further than [`FURTHEST`]; gaps between rays filled along the ring; NaN where too few rays meet anything.
fn bounded(mut ring: Ring) -> Ring {
    let mut hits: Vec<f64> = hits(ring).collect();
    if (hits.len() as f64) < GOES_AROUND * RAYS as f64 {
        return [f64::NAN; RAYS];
    }
    let usual = median(&mut hits);
    let known = ring;
    for (ray, reach) in ring.iter_mut().enumerate() {
        if reach.is_nan() {
            let find = |step: usize| {
                (1..RAYS).map(|away| known[(ray + step * away) % RAYS]).position(|reach| !reach.is_nan())
            };
            // There are hits, so both are found.
            let (before, after) = (find(RAYS - 1).unwrap_or(0) + 1, find(1).unwrap_or(0) + 1);
            let (low, high) = (known[(ray + (RAYS - 1) * before) % RAYS], known[(ray + after) % RAYS]);
            *reach = low + (high - low) * before as f64 / (before + after) as f64;
        }
        *reach = reach.min(FURTHEST * usual);
    }
    ring
}

/// The reaches of what `cuts` show around their `middles`, from the first row of which something is known to the last one; what is
/// between them is filled by those beside it. With the first one's number; `None` where nothing is met anywhere.
pub(super) fn reaches_around(cuts: &[Vec<Outline>], middles: &[DVec2]) -> Option<(usize, Vec<Ring>)> {
    let reach = |(outlines, &middle): (&Vec<Outline>, _)| bounded(outer_surface(outlines.iter(), middle));
    let rings = cuts.iter().zip(middles).map(reach).enumerate();
    let known: Vec<(usize, Ring)> = rings.filter(|(_, ring)| !ring[0].is_nan()).collect();
    let between = |pair: &[(usize, Ring)]| {
        let [(low, before), (high, after)] = [pair[0], pair[1]];
        (low..high).map(move |row| {
            let t = (row - low) as f64 / (high - low) as f64;
            std::array::from_fn(|ray| before[ray] + t * (after[ray] - before[ray]))
        })
    };
    let ((first, _), (_, last)) = (known.first()?, known.last()?);
    Some((*first, known.windows(2).flat_map(between).chain([*last]).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Mapped;

    fn waist() -> RadiusMap {
        let planes = Planes {
            origin: DVec3::new(0.1, 0.2, -0.1),
            axis: DVec3::new(0.6, 0.8, 0.0),
            across: DVec3::new(0.8, -0.6, 0.0),
            front: DVec3::Z,
        };
        let ring = |row: usize, off: f64| -> Ring {
            std::array::from_fn(|ray| {
                1.0 + 0.1 * (0.7 * row as f64 + off).sin() + 0.05 * (ray as f64 / 3.0).cos()
            })
        };
        RadiusMap {
            planes,
            start: -0.5,
            step: 0.1,
            middles: (0..12).map(|row| DVec2::new(0.01 * row as f64, 0.02 * (row as f64).cos())).collect(),
            reaches: (0..12).map(|row| ring(row, 0.3)).collect(),
            scales: (0..12).map(|row| ring(row, 1.1)).collect(),
        }
    }

    #[test]
    fn the_gradient_is_that_of_the_shift() {
        let map = waist();
        let h = 1e-6;
        for index in 0..60 {
            let angle = 0.37 * f64::from(index);
            let distance = 0.2 + 0.03 * f64::from(index);
            let p = map.planes.point(0.01 * f64::from(index), distance * DVec2::from_angle(angle));
            let gradient = map.shift::<Mapped>(p).jacobian;
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let shift = |p: DVec3| map.shift::<DVec3>(p);
                let wanted = (shift(p + h * axis) - shift(p - h * axis)) / (2.0 * h);
                assert!(
                    (gradient * axis).distance(wanted) < 1e-5,
                    "{index}: {:?} {wanted:?}",
                    gradient * axis
                );
            }
        }
    }

    #[test]
    fn gaps_are_filled_from_both_sides() {
        let mut ring = [1.0; RAYS];
        ring[35] = f64::NAN;
        ring[0] = f64::NAN;
        ring[1] = 1.3;
        let filled = bounded(ring);
        assert!((filled[35] - 1.1).abs() < 1e-12 && (filled[0] - 1.2).abs() < 1e-12, "{filled:?}");
        assert!(bounded([f64::NAN; RAYS])[0].is_nan());
    }
}
