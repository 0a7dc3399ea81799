//! `long_hair.rs`: hair that lies on a body, on cylinders about one axis.

use glam::DVec3;
use std::sync::Arc;
use superdeform::internals::face::head::HeadFrame;
use superdeform::internals::geometry::weld::{Weld, weld};
use superdeform::internals::shape::product::long_hair::{Axis, LongHair};

/// Head lengths are units here: the chin is at height 0.
fn axis(length: f64) -> Axis {
    Axis { frame: HeadFrame { origin: DVec3::ZERO, length }, middle: [0.0, 0.0] }
}

/// A cylinder about the axis: points, triangles. `first`: the number of its first vertex.
fn cylinder(radius: f64, top: f64, bottom: f64, first: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    const COLUMNS: u32 = 96;
    let rows = ((top - bottom) / 0.03).ceil() as u32;
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..=rows {
        let y = top + (bottom - top) * f64::from(row) / f64::from(rows);
        for column in 0..COLUMNS {
            let (sin, cos) = (f64::from(column) / f64::from(COLUMNS) * std::f64::consts::TAU).sin_cos();
            points.push(DVec3::new(radius * sin, y, radius * cos));
            let at = |row: u32, column: u32| first + row * COLUMNS + column % COLUMNS;
            if row < rows {
                triangles.push([at(row, column), at(row + 1, column), at(row, column + 1)]);
                triangles.push([at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)]);
            }
        }
    }
    (points, triangles)
}

const BODY: f64 = 0.3;

struct Scene {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    body: Vec<[u32; 3]>,
    strand: Vec<u32>,
    weld: Weld,
}

/// A body of radius .3, and hair of `radius` that hangs from a height of .6 down to `bottom`.
fn scene(radius: f64, bottom: f64) -> Scene {
    let (mut points, body) = cylinder(BODY, 0.3, -2.0, 0);
    let first = points.len() as u32;
    let (hair, of_hair) = cylinder(radius, 0.6, bottom, first);
    points.extend(hair);
    let triangles = [&body[..], &of_hair].concat();
    let weld = weld(&points, 1e-6);
    Scene { strand: (first..points.len() as u32).collect(), points, triangles, body, weld }
}

impl Scene {
    fn hair(&self) -> Option<Arc<LongHair>> {
        let strands = [self.strand.clone()];
        LongHair::of(&self.points, &self.triangles, &self.weld, &strands, &self.body, axis(1.0)).map(Arc::new)
    }
}

#[test]
fn hair_lies_on_the_body_where_it_is_long_and_near() {
    assert!(scene(0.36, -0.8).hair().is_some());
    // Too short; too far off; inside the body.
    assert!(scene(0.36, -0.1).hair().is_none());
    assert!(scene(0.7, -0.8).hair().is_none());
    assert!(scene(0.3, -0.8).hair().is_none());
}

/// How far from the axis hair at a radius of `now` and a height in head lengths comes to hang, on a head `growth` times
/// as large.
fn hangs_at(growth: f64, height: f64) -> f64 {
    let scene = scene(0.36, -0.8);
    let long = scene.hair().unwrap();
    // The head takes the hair with it; the body stays.
    let hair: Vec<DVec3> =
        long.vertices.iter().map(|&vertex| growth * scene.points[vertex as usize]).collect();
    let body: Vec<DVec3> = long.body_vertices.iter().map(|&vertex| scene.points[vertex as usize]).collect();
    let hanging = long.hanging(&scene.points, &hair, &body, axis(growth));
    let rest = DVec3::new(0.0, height, 0.36);
    let now = growth * rest;
    let to = now + hanging.offset(rest, now);
    assert!(to.x.abs() < 1e-9 && to.y == now.y, "{to}");
    to.z
}

#[test]
fn below_a_head_that_does_not_grow_hair_keeps_just_over_half_its_distance() {
    // .3 + .55 * .06.
    assert!((hangs_at(1.0, -0.5) - 0.333).abs() < 0.002, "{}", hangs_at(1.0, -0.5));
    // Beside the face it hangs as it did.
    assert!((hangs_at(1.0, 0.3) - 0.36).abs() < 0.002, "{}", hangs_at(1.0, 0.3));
    assert_eq!(hangs_at(1.0, 0.45), 0.36);
}

#[test]
fn below_a_head_of_twice_the_size_hair_lies_where_it_lay() {
    // Taken along it would stand off by .42: .72 from the axis.
    for height in [-0.5, -0.7] {
        assert!((hangs_at(2.0, height) - 0.36).abs() < 0.006, "{height}: {}", hangs_at(2.0, height));
    }
    // It leans in by no more than .6 of the way down, from .72 at the chin.
    let leans = hangs_at(2.0, -0.1);
    assert!((leans - (0.72 - 0.6 * 0.2)).abs() < 0.02, "{leans}");
    // On the head it stays with the head.
    assert_eq!(hangs_at(2.0, 0.5), 0.72);
}

#[test]
fn what_is_added_is_evened_out_along_the_hair() {
    // Three points and one triangle: from (3, 0, 0), half the way to the neighbours' mean three times over.
    let mut scene = scene(0.36, -0.8);
    let points = [0.0, 0.02, 0.04].map(|x| DVec3::new(x, -0.5, 0.36));
    let first = scene.points.len() as u32;
    scene.points.extend(points);
    scene.triangles.push([first, first + 1, first + 2]);
    scene.strand = (first..first + 3).collect();
    // Long enough for a strand.
    scene.weld = weld(&scene.points, 1e-6);
    let long = scene.hair().unwrap();
    let even = long.smoothed(&[DVec3::X * 3.0, DVec3::ZERO, DVec3::ZERO]);
    let expected = [1.03125, 0.984375, 0.984375];
    for (offset, expected) in even.iter().zip(expected) {
        assert!((offset.x - expected).abs() < 1e-12 && offset.y == 0.0, "{even:?}");
    }
    let same = long.smoothed(&[DVec3::Y; 3]);
    assert!(same.iter().all(|offset| offset.distance(DVec3::Y) < 1e-12));
}

#[test]
fn vertices_at_one_place_move_together() {
    let mut scene = scene(0.36, -0.8);
    // The hair's seam: its first vertex again, in no triangle.
    let again = scene.points[scene.strand[0] as usize];
    scene.strand.push(scene.points.len() as u32);
    scene.points.push(again);
    scene.weld = weld(&scene.points, 1e-6);
    let long = scene.hair().unwrap();
    let mut offsets = vec![DVec3::ZERO; long.vertices.len()];
    offsets[0] = DVec3::X;
    let even = long.smoothed(&offsets);
    assert_eq!(even[0], even[long.vertices.len() - 1]);
    assert!(even[0].x > 0.0);
}
