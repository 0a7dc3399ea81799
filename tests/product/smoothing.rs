//! `smoothing.rs`: weights on grids whose smoothing can be worked out.

use crate::tubes::blended;
use glam::DVec3;
use superdeform::Progress;
use superdeform::internals::geometry::weld::{Weld, weld};
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::part::{PART_COUNT, Part, PartWeights};
use superdeform::internals::shape::product::smoothing::{Fork, smooth};

/// Far below everything: nothing is a leg's.
const NO_FORK: Fork = Fork { crotch: -1e9, apart: 1.0 };
/// Vertices along each side of a grid.
const SIDE: usize = 41;
/// The width of a step on a figure of height 1, and the grid's spacing.
const WIDTH: f64 = 0.012;
/// What all steps together come to, in those.
const WIDTH_OF_ALL: f64 = 2.6;

/// A figure of height 1 with these points and triangles, and nothing else of the person that it was.
fn figure(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> (Figure, Weld) {
    let weld = weld(&positions, 1e-6);
    let figure = Figure { positions, triangles, extent: (0.0, 1.0), ..blended().figure.clone() };
    (figure, weld)
}

/// `SIDE` by `SIDE` points in the plane z = `z`, `WIDTH` apart, every square with a diagonal from its lower left.
fn grid(z: f64, first: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let at = |x: usize, y: usize| (first + y * SIDE + x) as u32;
    let positions = (0..SIDE * SIDE)
        .map(|index| WIDTH * DVec3::new((index % SIDE) as f64, (index / SIDE) as f64, 0.0) + z * DVec3::Z)
        .collect();
    let squares = (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| (x, y)));
    let triangles = squares
        .flat_map(|(x, y)| {
            [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
        })
        .collect();
    (positions, triangles)
}

fn mixed(first: Part, share: f32, second: Part) -> PartWeights {
    let mut row = [0.0; PART_COUNT];
    row[first as usize] = share;
    row[second as usize] += 1.0 - share;
    row
}

/// How wide a border between two halves of each of some grids becomes: the variance of the change across the last of them. Its edges,
/// and those of the others, are `spacings` steps long; they lie far apart.
fn border(spacings: &[f64]) -> f64 {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (index, spacing) in spacings.iter().enumerate() {
        let (points, more) = grid(0.0, index * SIDE * SIDE);
        positions.extend(points.into_iter().map(|p| spacing * p + 10.0 * index as f64 * DVec3::Z));
        triangles.extend(more);
    }
    let (figure, weld) = figure(positions, triangles);
    let is_neck = |vertex: usize| vertex % SIDE > SIDE / 2;
    let row = |vertex| if is_neck(vertex) { Part::Neck.alone() } else { Part::Torso.alone() };
    let mut rows: Vec<PartWeights> = (0..spacings.len() * SIDE * SIDE).map(row).collect();
    smooth(&figure, &weld, &vec![false; rows.len()], NO_FORK, &mut rows, 1, &mut Progress::none()).unwrap();
    assert!(rows.iter().all(|row| (row.iter().sum::<f32>() - 1.0).abs() < 1e-5));
    let (last, spacing) = (&rows[rows.len() - SIDE * SIDE..], spacings[spacings.len() - 1]);
    let neck = |x: usize| f64::from(last[SIDE / 2 * SIDE + x][Part::Neck as usize]);
    let way = |x: usize| spacing * (x as f64 - (SIDE / 2) as f64);
    (0..SIDE - 1).map(|x| (neck(x + 1) - neck(x)) * way(x).powi(2)).sum()
}

#[test]
fn a_border_becomes_as_wide_on_fine_grids_as_on_coarse_ones() {
    for spacing in [1.0, 0.8, 0.5, 0.3] {
        // Of the two ways on a surface each has half of the square of the width of all steps; they are whole ones.
        let (wanted, found) = (WIDTH_OF_ALL * WIDTH_OF_ALL / 2.0, border(&[spacing]));
        assert!((found / wanted - 1.0).abs() < 0.15, "{spacing}: {found} instead of {wanted}");
    }
}

/// A hand is fine where a shin is coarse: as many steps for both, in which what is three steps apart must not stay as it was.
#[test]
fn a_coarse_grid_beside_fine_ones_is_smoothed_over_its_edges() {
    let spacing = 3.0;
    let found = border(&[0.5, 0.5, spacing]);
    assert!(found > spacing * spacing, "{found}");
}

#[test]
fn copies_along_a_seam_share_one_row_and_loose_meshes_none() {
    // Two grids in one plane that share the line x = 40 as copies, and one far away.
    let (mut positions, mut triangles) = grid(0.0, 0);
    let (right, of_right) = grid(0.0, SIDE * SIDE);
    positions.extend(right.iter().map(|&p| p + (SIDE - 1) as f64 * WIDTH * DVec3::X));
    triangles.extend(of_right);
    let (far, of_far) = grid(5.0, 2 * SIDE * SIDE);
    positions.extend(far);
    triangles.extend(of_far);
    let (figure, weld) = figure(positions, triangles);
    let mut rows = vec![Part::Torso.alone(); SIDE * SIDE];
    rows.resize(2 * SIDE * SIDE, Part::Neck.alone());
    rows.resize(3 * SIDE * SIDE, Part::LeftFoot.alone());
    smooth(&figure, &weld, &vec![false; rows.len()], NO_FORK, &mut rows, 1, &mut Progress::none()).unwrap();
    for y in 0..SIDE {
        let (copy, other) = (y * SIDE + SIDE - 1, SIDE * SIDE + y * SIDE);
        assert_eq!(rows[copy], rows[other]);
    }
    // They begin as the mean of both, and both sides draw alike.
    let middle = rows[20 * SIDE + SIDE - 1];
    assert!((middle[Part::Torso as usize] - 0.5).abs() < 0.02, "{middle:?}");
    assert!(rows[2 * SIDE * SIDE..].iter().all(|row| *row == Part::LeftFoot.alone()));
}

#[test]
fn where_hair_is_rooted_in_skin_the_skin_takes_its_weights() {
    let (mut positions, mut triangles) = grid(0.0, 0);
    let (right, of_right) = grid(0.0, SIDE * SIDE);
    positions.extend(right.iter().map(|&p| p + (SIDE - 1) as f64 * WIDTH * DVec3::X));
    triangles.extend(of_right);
    let (figure, weld) = figure(positions, triangles);
    // Whichever of the two comes first.
    for hair_first in [true, false] {
        let is_hair = |vertex: usize| (vertex < SIDE * SIDE) == hair_first;
        let mut rows: Vec<PartWeights> = (0..2 * SIDE * SIDE)
            .map(|vertex| if is_hair(vertex) { Part::Hair.alone() } else { Part::Torso.alone() })
            .collect();
        let frozen: Vec<bool> = (0..rows.len()).map(is_hair).collect();
        smooth(&figure, &weld, &frozen, NO_FORK, &mut rows, 1, &mut Progress::none()).unwrap();
        for y in 0..SIDE {
            let seam = [y * SIDE + SIDE - 1, SIDE * SIDE + y * SIDE];
            assert!(seam.iter().all(|&vertex| rows[vertex] == Part::Hair.alone()), "{y}: {hair_first}");
        }
    }
}

#[test]
fn layers_of_cloth_come_to_move_alike() {
    // Two sheets a tenth of the width apart, not joined.
    let (mut positions, mut triangles) = grid(0.0, 0);
    let (above, of_above) = grid(0.1 * WIDTH, SIDE * SIDE);
    positions.extend(above);
    triangles.extend(of_above);
    let (figure, weld) = figure(positions, triangles);
    let (skin, cloth) =
        (mixed(Part::Torso, 0.8, Part::LeftUpperLeg), mixed(Part::Torso, 0.2, Part::LeftUpperLeg));
    let mut rows = vec![skin; SIDE * SIDE];
    rows.resize(2 * SIDE * SIDE, cloth);
    let none = vec![false; rows.len()];
    smooth(&figure, &weld, &none, NO_FORK, &mut rows, 1, &mut Progress::none()).unwrap();
    for vertex in 0..SIDE * SIDE {
        let (below, above) = (rows[vertex][0], rows[SIDE * SIDE + vertex][0]);
        // Half and half but for the kernel's difference between 0 and a tenth of its width, at every step.
        assert!((below - above).abs() < 0.01 && (below - 0.5).abs() < 0.01, "{below} {above}");
    }
    // Frozen cloth neither moves nor draws.
    let mut rows = vec![skin; SIDE * SIDE];
    rows.resize(2 * SIDE * SIDE, cloth);
    let frozen: Vec<bool> = (0..rows.len()).map(|vertex| vertex >= SIDE * SIDE).collect();
    smooth(&figure, &weld, &frozen, NO_FORK, &mut rows, 1, &mut Progress::none()).unwrap();
    assert!(rows[..SIDE * SIDE].iter().all(|row| (row[0] - 0.8).abs() < 1e-5));
    assert!(rows[SIDE * SIDE..].iter().all(|row| (row[0] - 0.2).abs() < 1e-6));
}

#[test]
fn arms_do_not_draw_what_they_lie_on() {
    let (mut positions, mut triangles) = grid(0.0, 0);
    let (above, of_above) = grid(0.1 * WIDTH, SIDE * SIDE);
    positions.extend(above);
    triangles.extend(of_above);
    let (figure, weld) = figure(positions, triangles);
    for (arm, other) in [
        (Part::LeftHand, Part::Torso),
        (Part::RightLowerArm, Part::Torso),
        (Part::LeftUpperArm, Part::RightUpperArm),
        (Part::LeftHand, Part::LeftUpperLeg),
    ] {
        let mut rows = vec![arm.alone(); SIDE * SIDE];
        rows.resize(2 * SIDE * SIDE, other.alone());
        let none = vec![false; rows.len()];
        smooth(&figure, &weld, &none, NO_FORK, &mut rows, 1, &mut Progress::none()).unwrap();
        assert!(rows[..SIDE * SIDE].iter().all(|row| (row[arm as usize] - 1.0).abs() < 1e-6), "{arm:?}");
        assert!(rows[SIDE * SIDE..].iter().all(|row| (row[other as usize] - 1.0).abs() < 1e-6), "{other:?}");
    }
}

#[test]
fn threads_do_not_change_what_comes_out() {
    let tubes = blended();
    let weld = weld(&tubes.figure.positions, 1e-6);
    let frozen = vec![false; tubes.figure.positions.len()];
    let rows: Vec<PartWeights> = tubes
        .figure
        .role_weights
        .iter()
        .map(|row| superdeform::internals::shape::product::part::fold_to_parts(row))
        .collect();
    let smoothed = |threads: usize| {
        let mut rows = rows.clone();
        smooth(&tubes.figure, &weld, &frozen, NO_FORK, &mut rows, threads, &mut Progress::none()).unwrap();
        rows
    };
    assert!(smoothed(1) == smoothed(3));
}
