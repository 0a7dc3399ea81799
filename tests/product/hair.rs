//! `hair.rs`: hair below the chin, and hair on the body.

use crate::tubes::jacobian_error;
use glam::DVec3;
use superdeform::internals::geometry::weld::weld;
use superdeform::internals::shape::product::hair::{HairMap, HairOnBody, HairOutline};
use superdeform::internals::shape::product::scales::HeadScale;

const CHIN: DVec3 = DVec3::new(0.1, 1.5, 0.02);
const NEW_CHIN: DVec3 = DVec3::new(0.1, 1.0, -0.03);
const HEAD: HeadScale = HeadScale { height: 1.5, width: 1.68, depth: 1.575 };

/// Hair of these reaches in x and z on the head, and below it as `reach` says by the depth below the chin, 0 to 1.
fn outline(on_head: [f64; 2], depth: f64, reach: impl Fn(f64) -> [f64; 2]) -> HairOutline {
    let mut points = Vec::new();
    for row in 0..=320 {
        let share = f64::from(row) / 320.0;
        for (side, offset) in [(0, DVec3::X), (1, DVec3::Z)] {
            points.push(CHIN + share * 0.2 * DVec3::Y + on_head[side] * offset);
            points.push(CHIN - share * depth * DVec3::Y - reach(share)[side] * offset);
        }
    }
    HairOutline::of(points.into_iter(), CHIN).unwrap()
}

/// A curtain of constant width that ends `depth` below the chin and afterwards at `new_bottom`.
fn map(depth: f64, new_bottom: f64, taming: f64) -> HairMap {
    let outline = outline([0.1, 0.1], depth, |_| [0.1, 0.1]);
    HairMap::new(&outline, [CHIN, NEW_CHIN], new_bottom, HEAD, 0.7, 0.1, taming)
}

#[test]
fn hair_above_the_chin_has_no_outline_below_it() {
    assert_eq!(HairOutline::of([CHIN, CHIN + DVec3::Y].into_iter(), CHIN), None);
    assert_eq!(HairOutline::of(std::iter::empty(), CHIN), None);
    assert_eq!(outline([0.1, 0.1], 0.6, |_| [0.1, 0.1]).depth, 0.6);
}

#[test]
fn hair_begins_with_the_head_and_ends_where_it_should() {
    for (depth, new_bottom) in [(0.6, 0.7), (0.6, 0.2), (0.05, 0.95), (1.2, 0.05)] {
        for taming in [0.0, 1.0] {
            let map = map(depth, new_bottom, taming);
            let chin = map.map(CHIN);
            assert!(chin.position.distance(NEW_CHIN) < 1e-12, "{chin:?}");
            let beside = map.map(CHIN + DVec3::new(0.05, 0.0, -0.04)).position;
            let expected = NEW_CHIN + DVec3::new(1.68 * 0.05, 0.0, -1.575 * 0.04);
            assert!(beside.distance(expected) < 1e-9, "{beside} instead of {expected}");
            let tip = map.map(CHIN - depth * DVec3::Y).position;
            assert!((tip.y - new_bottom).abs() < 1e-9, "{tip}: {new_bottom}");
            // Slopes fall from the head's, or 1.5 times the mean where that is less.
            let mean = (NEW_CHIN.y - new_bottom) / depth;
            assert!((chin.jacobian.y_axis.y - 1.5_f64.min(1.5 * mean)).abs() < 1e-9, "{chin:?}");
        }
    }
}

#[test]
fn lower_hair_stays_lower() {
    for (depth, new_bottom) in [(0.6, 0.7), (0.6, 0.97), (0.6, -0.5), (0.02, 0.99)] {
        let map = map(depth, new_bottom, 1.0);
        let heights: Vec<f64> = (0..=1000)
            .map(|step| map.map(CHIN - depth * f64::from(step) / 1000.0 * DVec3::Y).position.y)
            .collect();
        assert!(heights.windows(2).all(|pair| pair[1] < pair[0]), "{depth}, {new_bottom}");
    }
}

#[test]
fn hair_narrows_to_the_bodys_scale_at_its_tips() {
    // Long hair, so that the tips have come all the way to the larger of 0.6 and the body's 0.7.
    let width = |map: &HairMap, share: f64| map.map(CHIN - 0.6 * share * DVec3::Y).jacobian.x_axis.x;
    let long = map(0.6, 0.5, 0.0);
    assert!((width(&long, 0.0) - 1.68).abs() < 1e-9 && (width(&long, 1.0) - 0.7).abs() < 1e-9);
    let widths: Vec<f64> = (0..=100).map(|step| width(&long, f64::from(step) / 100.0)).collect();
    assert!(widths.windows(2).all(|pair| pair[1] <= pair[0] + 1e-12), "{widths:?}");
    // A tail that ends half of the tapering below the chin has gone half the way: smoothstep(1 / 2).
    let short = HairMap::new(
        &outline([0.1, 0.1], 0.6, |_| [0.1, 0.1]),
        [CHIN, NEW_CHIN],
        NEW_CHIN.y - 0.05,
        HEAD,
        0.7,
        0.1,
        0.0,
    );
    assert!((width(&short, 1.0) - 0.5 * (1.68 + 0.7)).abs() < 1e-9, "{}", width(&short, 1.0));
    let thin =
        HairMap::new(&outline([0.1, 0.1], 0.6, |_| [0.1, 0.1]), [CHIN, NEW_CHIN], 0.5, HEAD, 0.3, 0.1, 0.0);
    assert!((width(&thin, 1.0) - 0.6).abs() < 1e-9, "{}", width(&thin, 1.0));
}

#[test]
fn tamed_hair_reaches_no_further_out_than_on_the_head() {
    // Twice as broad at the tips as on the head, in z three times.
    let spread = |share: f64| [0.1 * (1.0 + share), 0.1 * (1.0 + 2.0 * share)];
    let outline = outline([0.1, 0.1], 0.6, spread);
    let tips = |taming: f64| {
        let map = HairMap::new(&outline, [CHIN, NEW_CHIN], 0.5, HEAD, 1.4, 0.1, taming);
        let at = CHIN - 0.6 * DVec3::Y;
        let reach = spread(1.0);
        [
            map.map(at + reach[0] * DVec3::X).position.x - NEW_CHIN.x,
            map.map(at + reach[1] * DVec3::Z).position.z - NEW_CHIN.z,
        ]
    };
    let (free, tame) = (tips(0.0), tips(1.0));
    assert!((free[0] - 1.4 * 0.2).abs() < 1e-9 && (free[1] - 1.4 * 0.3).abs() < 1e-9, "{free:?}");
    // Of the hair within one knot of the tips, 5 % reach further than the outline: 95 % of a sixteenth of the spread.
    for (tame, scale, growth) in [(tame[0], 1.68, 0.1), (tame[1], 1.575, 0.2)] {
        let on_head: f64 = scale * 0.1;
        assert!(tame >= on_head - 1e-9 && tame <= on_head * (1.0 + growth / 16.0 / 0.1), "{tame} {on_head}");
    }
}

#[test]
fn hairs_jacobian_is_that_of_central_differences() {
    let outline = outline([0.1, 0.12], 0.6, |share| [0.1 + 0.1 * share, 0.1]);
    let map = HairMap::new(&outline, [CHIN, NEW_CHIN], 0.4, HEAD, 0.7, 0.1, 1.0);
    for step in 0..200 {
        // Between the knots of the widths, which have corners: 16 of them in 0.6.
        let share = (f64::from(step % 16) + 0.2 + 0.6 * f64::from(step) / 200.0) / 16.0;
        let p = CHIN + DVec3::new(0.07, -0.6 * share, -0.05);
        let error = jacobian_error(|p| map.map(p), p, 1e-6);
        assert!(error < 1e-7, "{error} at {p}");
    }
}

/// A ball of radius 1 around the origin, a lock of five points before it at these distances, and where all are.
fn lock_on_ball(distances: [f64; 5], inwards: bool) -> (Vec<DVec3>, Vec<[u32; 3]>, Vec<usize>, usize) {
    let mut ball = crate::people::Shape { columns: 48, ..crate::people::Shape::default() };
    ball.ellipsoid(DVec3::ZERO, DVec3::ONE, superdeform::Role::Hips);
    let (mut points, mut triangles) = (ball.positions, ball.triangles);
    if inwards {
        triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    }
    let (body, first) = (triangles.len(), points.len());
    for (index, distance) in distances.into_iter().enumerate() {
        points.push(
            DVec3::new(0.0, 0.1 * (index as f64 - 2.0), 0.0).with_z(1.0).normalize() * (1.0 + distance),
        );
    }
    for index in 0..3 {
        let at = (first + index) as u32;
        triangles.push([at, at + 1, at + 2]);
    }
    (points, triangles, (first..first + 5).collect(), body)
}

#[test]
fn hair_that_would_sink_into_the_body_is_kept_outside() {
    for inwards in [false, true] {
        let (before, triangles, hair, body) = lock_on_ball([0.02; 5], inwards);
        let weld = weld(&before, 1e-9);
        let on_body = HairOnBody::of(&before, &triangles, triangles[..body].to_vec(), hair.clone(), &weld, 1);
        assert!(!on_body.is_empty());
        // Nothing to do where nothing moved.
        assert_eq!(on_body.kept_outside(&before, &weld, 2.0, 1), []);
        let mut after = before.clone();
        for &vertex in &hair[1..4] {
            after[vertex] *= 0.99 / 1.02;
        }
        let pushes = on_body.kept_outside(&after, &weld, 2.0, 1);
        assert_eq!(pushes.len(), 5);
        // Half of the 0.02 that it was away, and 0.008 of the height of 2 is more.
        for (vertex, push) in pushes {
            let distance = (after[vertex] + push).length() - 1.0;
            // The ball's facets lie up to 0.0022 inside of it.
            assert!(distance >= 0.01 - 0.0025, "{distance}, inwards {inwards}");
        }
    }
}

#[test]
fn hair_far_from_the_body_and_hair_without_a_body_stay() {
    let (before, triangles, hair, body) = lock_on_ball([0.5; 5], false);
    let weld = weld(&before, 1e-9);
    let on_body = HairOnBody::of(&before, &triangles, triangles[..body].to_vec(), hair.clone(), &weld, 1);
    let mut after = before.clone();
    for &vertex in &hair {
        after[vertex] *= 1.3 / 1.5;
    }
    // 0.3 away where 0.008 of the height is enough.
    assert_eq!(on_body.kept_outside(&after, &weld, 2.0, 1), []);
    let bald = HairOnBody::of(&before, &triangles, triangles[..body].to_vec(), Vec::new(), &weld, 1);
    assert!(bald.is_empty() && bald.kept_outside(&after, &weld, 2.0, 1).is_empty());
    let bodiless = HairOnBody::of(&before, &triangles, Vec::new(), hair, &weld, 1);
    assert!(bodiless.is_empty() && bodiless.kept_outside(&after, &weld, 2.0, 1).is_empty());
}

#[test]
fn hair_that_was_inside_the_body_may_stay_there() {
    let (before, triangles, hair, body) = lock_on_ball([-0.05; 5], false);
    let weld = weld(&before, 1e-9);
    let on_body = HairOnBody::of(&before, &triangles, triangles[..body].to_vec(), hair, &weld, 1);
    assert_eq!(on_body.kept_outside(&before, &weld, 2.0, 1), []);
}
