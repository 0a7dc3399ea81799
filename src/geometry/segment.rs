//! The foot of the perpendicular on a bone: proj_i(v_k) of Eqs. 6-8.

use glam::DVec3;

/// The point of the segment from `a` to `b` that is closest to `p`, and where it lies: 0 at `a`, 1 at `b`.
///
/// Clamped: a point beyond an end has that end as its foot. A segment of length 0 has its foot at `a`, at 0.
pub fn foot(p: DVec3, a: DVec3, b: DVec3) -> (DVec3, f64) {
    let along = b - a;
    let t = (p - a).dot(along) / along.length_squared();
    // The quotient is NaN or infinite only where the segment is too short to have a direction.
    if !t.is_finite() || t <= 0.0 {
        (a, 0.0)
    } else if t >= 1.0 {
        (b, 1.0)
    } else {
        (a + t * along, t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_between_the_ends_is_perpendicular() {
        let (a, b) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 6.0, 3.0));
        let p = DVec3::new(2.0, 5.0, 7.0);
        let (point, t) = foot(p, a, b);
        assert!((p - point).dot(b - a).abs() < 1e-12);
        assert!((point - a.lerp(b, t)).length() < 1e-12);
        assert!((t - 15.0 / 25.0).abs() < 1e-15);
    }

    #[test]
    fn beyond_an_end_the_foot_is_that_end() {
        let (a, b) = (DVec3::ZERO, DVec3::X);
        assert_eq!(foot(DVec3::new(-2.0, 1.0, 0.0), a, b), (a, 0.0));
        assert_eq!(foot(DVec3::new(2.0, 1.0, 0.0), a, b), (b, 1.0));
    }

    #[test]
    fn a_segment_without_length_has_its_foot_at_the_joint() {
        let a = DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(foot(DVec3::ZERO, a, a), (a, 0.0));
        assert_eq!(foot(a, a, a), (a, 0.0));
        assert_eq!(foot(DVec3::ZERO, a, a + DVec3::X * 1e-200), (a, 0.0));
    }
}
