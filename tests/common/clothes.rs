//! How much of a figure's clothes is inside its body, at rest and in poses: by winding numbers and poses of their own, apart from
//! the product's.
//!
//! Jacobson, Kavan and Sorkine-Hornung. Robust inside-outside segmentation using generalized winding numbers. SIGGRAPH 2013.
//! van Oosterom and Strackee. The solid angle of a plane triangle. IEEE Trans. Biomed. Eng. 30(2), 1983.
#![allow(dead_code)]

use glam::{DMat3, DVec3};
use std::collections::BTreeMap;
use superdeform::internals::geometry::weld::{SEAM, weld};
use superdeform::internals::shape::figure::Figure;
use superdeform::internals::shape::product::worn::Worn;
use superdeform::{Character, Deformed, Mesh, Role};

/// A pose: turns about the side axis in degrees, forward up, by role; what hangs from a joint turns with it.
pub type Pose = &'static [(Role, f64)];

pub const REST: Pose = &[];
/// Perry and Burnfield, Gait Analysis, 2010: thighs at 20 degrees, a knee at 60.
pub const WALK: Pose =
    &[(Role::LeftUpperLeg, 20.0), (Role::RightUpperLeg, -20.0), (Role::RightLowerLeg, -40.0)];
/// On a chair.
pub const SIT: Pose = &[
    (Role::LeftUpperLeg, 90.0),
    (Role::RightUpperLeg, 90.0),
    (Role::LeftLowerLeg, -90.0),
    (Role::RightLowerLeg, -90.0),
];

/// Six degrees of freedom less: p -> turn (p - about) + to.
#[derive(Clone, Copy)]
struct Rigid {
    turn: DMat3,
    shift: DVec3,
}

/// All vertices of `character` in `pose`, mesh by mesh.
pub fn posed(character: &Character, pose: Pose) -> Vec<Vec<DVec3>> {
    let up = character.axes.up.as_dvec3();
    let joints = &character.skeleton.joints;
    let place = |role: Role| joints[character.humanoid.joint(role).unwrap()].position();
    // From right to left, whichever way it looks.
    let side =
        (place(Role::LeftUpperLeg) - place(Role::RightUpperLeg)).reject_from_normalized(up).normalize();
    let mut moves = vec![Rigid { turn: DMat3::IDENTITY, shift: DVec3::ZERO }; joints.len()];
    for joint in character.skeleton.parents_first() {
        let above = match joints[joint].parent {
            Some(parent) => moves[parent],
            None => Rigid { turn: DMat3::IDENTITY, shift: DVec3::ZERO },
        };
        moves[joint] = above;
        for &(role, degrees) in pose {
            if character.humanoid.joint(role) == Some(joint) {
                // Forward up: about the side axis against the right hand's turn.
                let own = DMat3::from_axis_angle(side, -f64::to_radians(degrees));
                let p = joints[joint].position();
                let turn = above.turn * own;
                moves[joint] = Rigid { turn, shift: above.turn * p + above.shift - turn * p };
            }
        }
    }
    let moved = |mesh: &Mesh, vertex: usize| {
        let p = mesh.positions[vertex].as_dvec3();
        let row = mesh.weights.row(vertex);
        let total: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
        if total == 0.0 {
            return p;
        }
        row.iter()
            .map(|&(joint, weight)| {
                let by = moves[joint as usize];
                (by.turn * p + by.shift) * f64::from(weight) / total
            })
            .sum()
    };
    character
        .meshes
        .iter()
        .map(|mesh| (0..mesh.positions.len()).map(|vertex| moved(mesh, vertex)).collect())
        .collect()
}

/// A closed or nearly closed surface, ready for winding numbers: triangles in cells, and what each cell is from far away.
pub struct Winding {
    cells: Vec<Cell>,
    sign: f64,
}

struct Cell {
    triangles: Vec<[DVec3; 3]>,
    centre: DVec3,
    radius: f64,
    /// The sum of the normals, each as long as the triangle's area.
    dipole: DVec3,
}

impl Winding {
    pub fn new(triangles: &[[DVec3; 3]]) -> Self {
        let middle = triangles.iter().flatten().sum::<DVec3>() / (3 * triangles.len().max(1)) as f64;
        let volume: f64 = triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|p| p - middle);
                a.dot(b.cross(c))
            })
            .sum();
        let reach = triangles.iter().flatten().map(|p| p.distance(middle)).fold(0.0, f64::max);
        let size = reach / 20.0;
        let mut cells: BTreeMap<[i32; 3], Vec<[DVec3; 3]>> = BTreeMap::new();
        for &corners in triangles {
            let centre = corners.iter().sum::<DVec3>() / 3.0;
            let key = ((centre - middle) / size).floor().as_ivec3().to_array();
            cells.entry(key).or_default().push(corners);
        }
        let cell = |triangles: Vec<[DVec3; 3]>| {
            let normal = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a);
            let area: f64 = triangles.iter().map(|&corners| normal(corners).length()).sum();
            let weighted: DVec3 = triangles
                .iter()
                .map(|&corners| normal(corners).length() * corners.iter().sum::<DVec3>() / 3.0)
                .sum();
            let centre = if area > 0.0 { weighted / area } else { triangles[0][0] };
            let radius = triangles.iter().flatten().map(|p| p.distance(centre)).fold(0.0, f64::max);
            let dipole = triangles.iter().map(|&corners| normal(corners)).sum();
            Cell { triangles, centre, radius, dipole }
        };
        // Wound to look inwards, as mirrored bodies are: all is the other way round.
        Self { cells: cells.into_values().map(cell).collect(), sign: volume.signum() }
    }

    /// How often the surface goes round `p`: 1 inside of a closed one, 0 outside.
    pub fn at(&self, p: DVec3) -> f64 {
        let solid_angle: f64 = self
            .cells
            .iter()
            .map(|cell| {
                let way = cell.centre - p;
                let away = way.length();
                // Barill et al. Fast winding numbers for soups and clouds. SIGGRAPH 2018: the first term from twice the radius.
                if away > 2.5 * cell.radius {
                    return cell.dipole.dot(way) / (away * away * away);
                }
                cell.triangles.iter().map(|&corners| solid_angle(corners.map(|q| q - p))).sum()
            })
            .sum();
        self.sign * solid_angle / (4.0 * std::f64::consts::PI)
    }
}

fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
}

/// What is worn of `character`.
pub fn worn(character: &Character) -> Worn {
    let figure = Figure::of(character).unwrap();
    let weld = weld(&figure.positions, SEAM * figure.height());
    let meshes = character.meshes.iter();
    let known: Vec<bool> =
        meshes.flat_map(|mesh| mesh.positions.iter().map(|_| mesh.kind.is_some())).collect();
    Worn::of(&figure, |vertex| known[vertex], &weld, 0)
}

/// How often the body goes around each place of what is worn, where all vertices are at `positions`; never where the place is a part
/// of the body.
pub fn around(worn: &Worn, positions: &[Vec<DVec3>]) -> Vec<f64> {
    let points = positions.concat();
    let corners: Vec<[DVec3; 3]> =
        worn.body.iter().map(|corners| corners.map(|vertex| points[vertex as usize])).collect();
    let winding = Winding::new(&corners);
    let places = worn.vertices.iter().zip(&worn.is_sewn);
    places
        .map(|(&vertex, &is_sewn)| if is_sewn { 0.0 } else { winding.at(points[vertex as usize]) })
        .collect()
}

/// The share of what is worn that is inside the body in `pose` and went through its surface, which changes the winding number by 1
/// however many holes the body has: of what is `deformed` of `character`.
pub fn newly_inside(character: &Character, worn: &Worn, deformed: &Deformed, pose: Pose) -> f64 {
    let before = around(worn, &posed(character, pose));
    let result = character.with(deformed);
    let after = around(worn, &posed(&result, pose));
    assert!(before.len() > 500, "{} places are worn", before.len());
    let went = before.iter().zip(&after).filter(|&(&before, &after)| after > 0.5 && after - before > 0.5);
    went.count() as f64 / before.len() as f64
}
