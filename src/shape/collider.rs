//! Colliders of springs: as thick as the mesh around them, and no nearer to their springs than they were.
//!
//! A collider stands for a limb. Its points go where the field takes them; its thickness is that of the mesh, which along a
//! limb is another scale than across. Where the surroundings of a collider change more than it does, a spring may come to
//! lie nearer, or inside: it would be pushed out with a jerk when the simulation begins, so the collider yields.

use crate::geometry::Mapped;
use glam::{DMat3, DVec3};

/// How much of its radius a collider yields at most, so that a spring starts no nearer than it was. A fifth is as much as
/// the eye takes for the same limb; springs that are inside all the same are told.
pub const MOST_YIELD: f64 = 0.2;

/// What a collider is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A ball around `offset`.
    Sphere,
    /// From `offset` to `end`.
    Capsule,
    /// Through `offset`, `end` its normal, which points to where springs may be.
    Plane,
}

/// A collider, model space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collider {
    /// What it is.
    pub shape: Shape,
    /// True where springs are kept inside, not out.
    pub inside: bool,
    /// The joint that it moves with.
    pub joint: usize,
    /// Its middle, its first end, or a point of it.
    pub offset: DVec3,
    /// A capsule's other end, a plane's normal.
    pub end: DVec3,
    /// Of spheres and capsules.
    pub radius: f64,
}

/// The ball that a spring keeps out of colliders: around the end of its joint's bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringBall {
    /// The joint at the end of the bone.
    pub joint: usize,
    /// Where it is, model space.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// What becomes of a collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MappedCollider {
    /// The collider after the deformation.
    pub collider: Collider,
    /// The share of its radius that it yields to springs, 0 to [`MOST_YIELD`].
    pub yielded: f64,
    /// How many springs start inside that did not, all the same.
    pub newly_inside: usize,
}

impl Collider {
    /// How far `ball` is from being touched; below 0 it is touched. A plane's normal may have any length.
    pub fn distance(&self, ball: &SpringBall) -> f64 {
        let from = ball.centre - self.offset;
        let away = match self.shape {
            Shape::Plane => return from.dot(self.end.normalize_or(DVec3::Y)) - ball.radius,
            Shape::Sphere => from.length(),
            Shape::Capsule => {
                let axis = self.end - self.offset;
                let along = (from.dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                (from - along * axis).length()
            }
        };
        if self.inside { self.radius - away - ball.radius } else { away - self.radius - ball.radius }
    }

    /// Where `map` takes the collider, as thick as the mesh around it, before it yields to springs.
    ///
    /// - A sphere grows as small things there grow: by the cube root of the Jacobian's determinant.
    /// - A capsule grows across its axis, by the square root of the determinant over the stretch along the axis;
    ///   of its two ends the geometric mean, as it has one radius.
    /// - A plane's normal goes with the inverse transpose and keeps its length.
    fn moved(&self, map: &impl Fn(usize, DVec3) -> Mapped) -> Self {
        let start = map(self.joint, self.offset);
        let mut moved = Self { offset: start.position, ..*self };
        let mut scale = start.local_scale();
        match self.shape {
            Shape::Sphere => {}
            Shape::Plane => {
                let turned = start.jacobian.inverse().transpose() * self.end;
                if turned.is_finite() && turned != DVec3::ZERO {
                    moved.end = turned.normalize() * self.end.length();
                }
            }
            Shape::Capsule => {
                let end = map(self.joint, self.end);
                moved.end = end.position;
                let axis = self.end - self.offset;
                scale = if axis == DVec3::ZERO {
                    (scale * end.local_scale()).sqrt()
                } else {
                    (across(&start.jacobian, axis) * across(&end.jacobian, axis)).sqrt()
                };
            }
        }
        if scale.is_finite() {
            moved.radius *= scale;
        }
        moved
    }
}

/// How much lengths at right angles to `axis` grow, as a geometric mean.
fn across(jacobian: &DMat3, axis: DVec3) -> f64 {
    let along = (*jacobian * axis).length() / axis.length();
    (jacobian.determinant().abs() / along.max(f64::MIN_POSITIVE)).sqrt()
}

/// Maps a collider and the springs that it guards.
///
/// - `springs`: those that the collider is for.
/// - `map`: where the field takes a point that moves with a joint.
///
/// A spring that would start nearer than it was, or deeper inside, makes the collider thinner (one that springs are kept
/// inside of, thicker), by [`MOST_YIELD`] of its radius at most; planes do not yield. The distance that a spring had grows
/// with the spring, and what is more than its radius is no concern.
pub fn map_collider(
    collider: &Collider,
    springs: &[SpringBall],
    map: impl Fn(usize, DVec3) -> Mapped,
) -> MappedCollider {
    let mut moved = collider.moved(&map);
    // Each where it starts, and the distance to keep, at the size that it has now. What only touches swings inside.
    let now: Vec<(SpringBall, f64)> = springs
        .iter()
        .map(|ball| {
            let to = map(ball.joint, ball.centre);
            let scale = to.local_scale();
            (
                SpringBall { centre: to.position, radius: ball.radius * scale, ..*ball },
                scale * collider.distance(ball).min(ball.radius),
            )
        })
        .collect();
    let deeper = now.iter().map(|(ball, had)| had - moved.distance(ball)).fold(0.0, f64::max);
    // What is nearer by rounding alone is where it was.
    let rounding = 1e-9 * moved.radius.abs().max(moved.offset.length());
    let mut yielded = 0.0;
    if moved.shape != Shape::Plane && moved.radius > 0.0 && deeper > rounding {
        yielded = (deeper / moved.radius).clamp(0.0, MOST_YIELD);
        moved.radius *= if moved.inside { 1.0 + yielded } else { 1.0 - yielded };
    }
    let newly_inside =
        now.iter().filter(|(ball, had)| *had >= 0.0 && moved.distance(ball) < -rounding).count();
    MappedCollider { collider: moved, yielded, newly_inside }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice as long along y, half as thick.
    fn stretched(_: usize, p: DVec3) -> Mapped {
        let jacobian = DMat3::from_diagonal(DVec3::new(0.5, 2.0, 0.5));
        Mapped { position: jacobian * p, jacobian }
    }

    fn capsule() -> Collider {
        Collider {
            shape: Shape::Capsule,
            inside: false,
            joint: 0,
            offset: DVec3::ZERO,
            end: DVec3::Y,
            radius: 0.2,
        }
    }

    #[test]
    fn a_capsule_is_as_thick_as_the_limb_however_long_that_gets() {
        let moved = map_collider(&capsule(), &[], stretched).collider;
        assert!((moved.radius - 0.1).abs() < 1e-12, "{moved:?}");
        assert_eq!(moved.end, 2.0 * DVec3::Y);
        // Across the limb: 0.5 and 2 at right angles.
        let lying = Collider { end: DVec3::X, ..capsule() };
        assert!((map_collider(&lying, &[], stretched).collider.radius - 0.2).abs() < 1e-12);
        // Without length it is a sphere.
        let ball = Collider { end: DVec3::ZERO, ..capsule() };
        let sphere = Collider { shape: Shape::Sphere, ..ball };
        let radius = |collider| map_collider(collider, &[], stretched).collider.radius;
        assert!((radius(&ball) - radius(&sphere)).abs() < 1e-12);
        assert!((radius(&sphere) - 0.2 * 0.5_f64.cbrt()).abs() < 1e-12);
    }

    #[test]
    fn a_plane_stays_at_right_angles_to_what_lies_in_it() {
        let plane = Collider { shape: Shape::Plane, end: DVec3::new(1.0, 1.0, 0.0), ..capsule() };
        let moved = map_collider(&plane, &[], stretched).collider;
        assert!(moved.end.dot(stretched(0, DVec3::new(1.0, -1.0, 0.0)).position).abs() < 1e-12);
        assert!((moved.end.length() - plane.end.length()).abs() < 1e-12);
    }

    /// Joint 1 stays, all else goes through [`stretched`]: what is near the capsule comes nearer.
    fn map(joint: usize, p: DVec3) -> Mapped {
        if joint == 1 { Mapped::unmoved(p) } else { stretched(joint, p) }
    }

    #[test]
    fn a_collider_yields_to_what_was_outside_and_no_further_than_a_fifth() {
        let thick = Collider { joint: 1, ..capsule() };
        let ball = |x: f64| SpringBall { joint: 0, centre: DVec3::new(x, 0.25, 0.0), radius: 0.02 };
        // At 0.4 it comes to 0.2, its radius from 0.02 to 0.02 times the cube root of a half, and it keeps as much room.
        let near = ball(0.4);
        let result = map_collider(&thick, &[near], map);
        let small = 0.02 * 0.5_f64.cbrt();
        assert!((result.yielded - 2.0 * small / 0.2).abs() < 1e-9, "{result:?}");
        assert_eq!(result.newly_inside, 0);
        assert!(
            (result.collider.distance(&SpringBall {
                centre: DVec3::new(0.2, 0.5, 0.0),
                radius: small,
                ..near
            }) - small)
                .abs()
                < 1e-9
        );
        // At 0.3 it comes to 0.15: a fifth of 0.2 is not enough.
        let result = map_collider(&thick, &[near, ball(0.3)], map);
        assert_eq!((result.yielded, result.newly_inside), (MOST_YIELD, 1));
    }

    #[test]
    fn what_was_inside_before_gets_no_deeper_for_its_size() {
        let thick = Collider { joint: 1, ..capsule() };
        let ball = SpringBall { joint: 0, centre: DVec3::new(0.2, 0.25, 0.0), radius: 0.02 };
        // Joint 0 moves by 0.03 towards the axis: from 0.02 deep to 0.05.
        let nearer =
            |joint: usize, p: DVec3| Mapped::unmoved(if joint == 1 { p } else { p - 0.03 * DVec3::X });
        let result = map_collider(&thick, &[ball], nearer);
        assert!((result.yielded - 0.03 / 0.2).abs() < 1e-9, "{result:?}");
        assert_eq!(result.newly_inside, 0);
        // Joint 0 grows to twice its size where it is, and so may the depth: from 0.02 to 0.04.
        let larger = |joint: usize, p: DVec3| {
            if joint == 1 {
                Mapped::unmoved(p)
            } else {
                Mapped { position: p, jacobian: 2.0 * DMat3::IDENTITY }
            }
        };
        assert!(map_collider(&thick, &[ball], larger).yielded < 1e-9);
    }

    #[test]
    fn a_collider_that_keeps_springs_in_grows() {
        let around = Collider { inside: true, joint: 0, shape: Shape::Sphere, radius: 0.5, ..capsule() };
        let held = SpringBall { joint: 1, centre: DVec3::new(0.42, 0.0, 0.0), radius: 0.0 };
        assert!(around.distance(&held) > 0.0);
        let result = map_collider(&around, &[held], map);
        // 0.5 becomes 0.397, and the spring stays at 0.42.
        assert!((result.collider.radius - 0.42).abs() < 1e-9, "{result:?}");
        assert_eq!(result.newly_inside, 0);
    }
}
