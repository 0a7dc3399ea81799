//! Whether a surface is whole enough for heat: what flows along it stops where it ends.

use super::WeightBone;
use super::solid::Solid;
use super::solid::geodesic::Bone;
use super::voxel::nearest_bone;
use crate::geometry::{SEAM, components, distinct, double_area, rim_edges, weld};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Shorter bones are fingers: how they bend says little about the body. In the same units. Seen: ±30 % moves no vertex.
const LEAST_LENGTH: f64 = 0.02;
/// A component with this share of a bone's surface bends with it. Seen: at +30 %, vertices move up to 0.120 H.
const CARRYING: f64 = 0.25;
/// Voxels along the longest side in which components are looked for that lie on each other. Seen: ±30 % moves no
/// vertex.
const RESOLUTION: usize = 64;

/// More of the joints than this without a component across them: the body comes in pieces. Seen: ±30 % moves no vertex.
const MOST_UNJOINED: f64 = 0.15;
/// More of the surface than this in more than one component: shells on shells. Seen: ±30 % moves no vertex.
const MOST_SHARED: f64 = 0.5;
/// A longer border than this, in square roots of the area: patches. A body without head, hands and feet has about 1.
/// Seen: ±30 % moves no vertex.
const MOST_OPEN: f64 = 3.0;

/// Why heat would be poor on this body: a sentence for a person; `None` where heat does well. All in one space.
pub fn heat_would_be_poor(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    bones: &[WeightBone],
) -> Option<String> {
    let grid = Solid::around(positions, triangles, RESOLUTION);
    let points: Vec<DVec3> = positions.iter().map(|&p| grid.within(grid.to_cells(p))).collect();
    let middle =
        |corners: &[u32; 3]| corners.iter().map(|&vertex| points[vertex as usize]).sum::<DVec3>() / 3.0;
    let size = RESOLUTION as f64;
    let in_cells = |bone: &WeightBone| Bone {
        segments: bone.segments.iter().map(|ends| ends.map(|p| grid.to_cells(p))).collect(),
        starts: Vec::new(),
    };
    let bones: Vec<Bone> = bones.iter().map(in_cells).collect();
    let weld = weld(&points, SEAM * size);
    let components = components(triangles, &weld);
    let component_of = |vertex: u32| components[weld.representative[vertex as usize] as usize];

    // Area by bone and component.
    let mut shares: BTreeMap<(usize, u32), f64> = BTreeMap::new();
    let mut areas = vec![0.0; bones.len().max(1)];
    for triangle in triangles {
        let share = double_area(&points, *triangle).length() / 2.0;
        let bone = nearest_bone(&bones, middle(triangle));
        *shares.entry((bone, component_of(triangle[0]))).or_default() += share;
        areas[bone] += share;
    }
    // The connected components that bend with each bone.
    let carried: Vec<BTreeSet<u32>> = (0..bones.len())
        .map(|bone| {
            let of_bone = shares.range((bone, 0)..=(bone, u32::MAX));
            of_bone.filter(|&(_, &share)| share >= CARRYING * areas[bone]).map(|(&(_, c), _)| c).collect()
        })
        .collect();
    // Those that bend with any bone: hair cards, lashes and badges say nothing about the body.
    let body: BTreeSet<u32> = carried.iter().flatten().copied().collect();

    // Joints between bones with a surface of their own; where no component bends across one, heat gives each piece weights of
    // its own, and seams tear.
    let counts = |&bone: &usize| areas[bone] > 0.0 && bones[bone].length() > LEAST_LENGTH * size;
    let counted: Vec<usize> = (0..bones.len()).filter(counts).collect();
    let (mut joints, mut unjoined) = (0, 0);
    for (index, &one) in counted.iter().enumerate() {
        for &other in &counted[index + 1..] {
            if bones[one].touches(&bones[other], SEAM * size) {
                joints += 1;
                unjoined += usize::from(carried[one].is_disjoint(&carried[other]));
            }
        }
    }
    if unjoined as f64 > MOST_UNJOINED * f64::from(joints) {
        let carrying = body.len();
        return Some(format!(
            "the body comes in {carrying} pieces: no surface leads across {unjoined} of {joints} joints"
        ));
    }

    let is_of_body = |triangle: &&[u32; 3]| {
        let [a, b, c] = weld.triangle(**triangle);
        a != b && b != c && c != a && body.contains(&component_of(triangle[0]))
    };
    let own: Vec<[u32; 3]> = triangles.iter().filter(is_of_body).copied().collect();
    let ratio = |share: f64, whole: f64| if whole > 0.0 { share / whole } else { 0.0 };
    let voxels = distinct(
        own.iter()
            .map(|triangle| (grid.index(grid.nearest(middle(triangle))) as u32, component_of(triangle[0]))),
    );
    let voxels: Vec<_> = voxels.chunk_by(|one, other| one.0 == other.0).collect();
    let shared = voxels.iter().filter(|components| components.len() > 1).count();
    let shared = ratio(shared as f64, voxels.len() as f64);
    if shared > MOST_SHARED {
        return Some(format!("{:.0} % of the body lies in shells upon shells", 100.0 * shared));
    }

    let first = weld.first_vertices();
    let at = |welded: u32| points[first[welded as usize] as usize];
    let border: f64 =
        rim_edges(&own, &weld).into_iter().map(|[one, other]| at(one).distance(at(other))).sum();
    let area: f64 = shares.iter().filter(|((_, c), _)| body.contains(c)).map(|(_, share)| share).sum();
    let open = ratio(border, area.sqrt());
    (open > MOST_OPEN)
        .then(|| format!("the body is open: its borders are {open:.1} times as long as the root of its area"))
}
