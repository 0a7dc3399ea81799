//! The points of a body that can touch a floor, before and after.

use crate::load::Loaded;
use glam::{DMat4, DVec3};
use std::collections::{BTreeMap, BTreeSet};
use superdeform::Deformed;

/// Ways into which the outermost vertices of a foot are sought: of a ball of points so spread, one is within 10 degrees of any
/// way, and misses what is outermost there by 1.5 % of the foot.
const WAYS_OF_FOOT: usize = 128;

/// The same of the trunk, whose place matters less.
const WAYS_OF_TRUNK: usize = 32;

/// A vertex with the joints that move it.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// At rest, before and after.
    pub(super) rest: [DVec3; 2],
    /// Nodes and their shares, which sum to 1.
    weights: Vec<(usize, f64)>,
}

impl Point {
    /// Where it is; `moves` takes each node's surroundings from rest to a pose.
    pub(super) fn at(&self, side: usize, moves: &[DMat4]) -> DVec3 {
        let place = |&(node, share): &(usize, f64)| moves[node].transform_point3(self.rest[side]) * share;
        self.weights.iter().map(place).sum()
    }
}

/// The vertices of each part of a body that are outermost in some way, before or after.
///
/// - `part_of`: the part that a vertex is of, by the joint that moves it most and its place at rest.
/// - `ways`: how closely they are sought, by part.
pub(super) fn outermost(
    loaded: &Loaded,
    deformed: &Deformed,
    part_count: usize,
    part_of: impl Fn(usize, DVec3) -> Option<usize>,
    is_foot: impl Fn(usize) -> bool,
) -> Vec<Vec<Point>> {
    let character = &loaded.character;
    let mut found = vec![BTreeSet::<(usize, usize)>::new(); part_count];
    // By joint: its vertices, and the part that these are of.
    let mut of_joint: BTreeMap<(usize, usize), Vec<(usize, usize)>> = BTreeMap::new();
    for (index, mesh) in character.meshes.iter().enumerate() {
        for (vertex, row) in mesh.weights.rows().enumerate() {
            let main = row.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|&(joint, _)| joint as usize);
            let place = mesh.positions[vertex].as_dvec3();
            if let Some(joint) = main
                && let Some(part) = part_of(joint, place)
            {
                of_joint.entry((part, joint)).or_default().push((index, vertex));
            }
        }
    }
    for ((part, _), vertices) in of_joint {
        let ways = if is_foot(part) { WAYS_OF_FOOT } else { WAYS_OF_TRUNK };
        for way in spread(ways) {
            for after in [false, true] {
                let place = |&(mesh, vertex): &(usize, usize)| {
                    let positions = if after {
                        &deformed.meshes[mesh].positions
                    } else {
                        &character.meshes[mesh].positions
                    };
                    positions[vertex].as_dvec3()
                };
                let furthest = vertices.iter().max_by(|a, b| place(a).dot(way).total_cmp(&place(b).dot(way)));
                found[part].extend(furthest);
            }
        }
    }
    let point = |(mesh, vertex): (usize, usize)| {
        let row = character.meshes[mesh].weights.row(vertex);
        let total: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
        let node = |joint: u32| loaded.node_of_joint[joint as usize];
        Point {
            rest: [&character.meshes[mesh].positions, &deformed.meshes[mesh].positions]
                .map(|positions| positions[vertex].as_dvec3()),
            weights: row.iter().map(|&(joint, weight)| (node(joint), f64::from(weight) / total)).collect(),
        }
    };
    found.into_iter().map(|part| part.into_iter().map(point).collect()).collect()
}

/// So many ways, spread evenly: a spiral whose turn from one to the next is the golden angle.
fn spread(count: usize) -> impl Iterator<Item = DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0f64.sqrt());
    (0..count).map(move |index| {
        let y = 1.0 - (2 * index + 1) as f64 / count as f64;
        let (sin, cos) = (golden * index as f64).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        DVec3::new(radius * cos, y, radius * sin)
    })
}
