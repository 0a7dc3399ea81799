//! Whether a surface is whole enough for heat: what flows along it stops where it ends.

use super::WeightBone;
use super::solid::Solid;
use super::solid::geodesic::Bone;
use super::voxel::nearest_bone;
use crate::geometry::{SEAM, components, distinct, rim_edges, weld};
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

/// What there is to say about a surface and the bones in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wholeness {
    /// Connected components that bend with at least one bone.
    pub carrying: usize,
    /// Joints between bones with a surface of their own.
    pub joints: usize,
    /// Those that no component bends across: heat gives each piece weights of its own, and seams tear.
    pub unjoined: usize,
    /// Share of those components' voxels that more than one component passes through.
    pub shared: f64,
    /// Length of their edges with one triangle, in square roots of their area.
    pub open: f64,
}

impl Wholeness {
    /// Measures a surface; all in one space.
    pub fn of(positions: &[DVec3], triangles: &[[u32; 3]], bones: &[WeightBone]) -> Self {
        let grid = Solid::around(positions, triangles, RESOLUTION);
        let points: Vec<DVec3> = positions.iter().map(|&p| grid.within(grid.to_cells(p))).collect();
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
            let [a, b, c] = triangle.map(|vertex| points[vertex as usize]);
            let share = (b - a).cross(c - a).length() / 2.0;
            let bone = nearest_bone(&bones, (a + b + c) / 3.0);
            *shares.entry((bone, component_of(triangle[0]))).or_default() += share;
            areas[bone] += share;
        }
        let carried: Vec<BTreeSet<u32>> = (0..bones.len())
            .map(|bone| {
                let of_bone = shares.range((bone, 0)..=(bone, u32::MAX));
                of_bone.filter(|&(_, &share)| share >= CARRYING * areas[bone]).map(|(&(_, c), _)| c).collect()
            })
            .collect();
        // Hair cards, lashes and badges say nothing about the body.
        let body: BTreeSet<u32> = carried.iter().flatten().copied().collect();
        let carrying = body.len();
        let area: f64 = shares.iter().filter(|((_, c), _)| body.contains(c)).map(|(_, share)| share).sum();

        let (mut joints, mut unjoined) = (0, 0);
        for one in 0..bones.len() {
            for other in one + 1..bones.len() {
                let is_long = [one, other].iter().all(|&bone| bones[bone].length() > LEAST_LENGTH * size);
                let has_surface = areas[one] > 0.0 && areas[other] > 0.0;
                if is_long && has_surface && bones[one].touches(&bones[other], SEAM * size) {
                    joints += 1;
                    unjoined += usize::from(carried[one].is_disjoint(&carried[other]));
                }
            }
        }

        let is_of_body = |triangle: &&[u32; 3]| {
            let [a, b, c] = weld.triangle(**triangle);
            a != b && b != c && c != a && body.contains(&component_of(triangle[0]))
        };
        let own: Vec<[u32; 3]> = triangles.iter().filter(is_of_body).copied().collect();
        let first = weld.first_vertices();
        let at = |welded: u32| points[first[welded as usize] as usize];
        let border: f64 =
            rim_edges(&own, &weld).into_iter().map(|[one, other]| at(one).distance(at(other))).sum();
        let voxels = distinct(own.iter().map(|triangle| {
            let middle = triangle.iter().map(|&vertex| points[vertex as usize]).sum::<DVec3>() / 3.0;
            (grid.index(grid.nearest(middle)) as u32, component_of(triangle[0]))
        }));
        let (mut all, mut shared) = (0, 0);
        for voxel in voxels.chunk_by(|one, other| one.0 == other.0) {
            all += 1;
            shared += usize::from(voxel.len() > 1);
        }
        let ratio = |share: f64, whole: f64| if whole > 0.0 { share / whole } else { 0.0 };
        let (shared, open) = (ratio(shared as f64, all as f64), ratio(border, area.sqrt()));
        Self { carrying, joints, unjoined, shared, open }
    }

    /// Why heat would be poor, as a sentence for a person; `None` where it does well.
    pub fn trouble(&self) -> Option<String> {
        let Self { carrying, joints, unjoined, shared, open } = *self;
        if unjoined as f64 > MOST_UNJOINED * joints as f64 {
            Some(format!(
                "the body comes in {carrying} pieces: no surface leads across {unjoined} of {joints} joints"
            ))
        } else if shared > MOST_SHARED {
            Some(format!("{:.0} % of the body lies in shells upon shells", 100.0 * shared))
        } else if open > MOST_OPEN {
            Some(format!("the body is open: its borders are {open:.1} times as long as the root of its area"))
        } else {
            None
        }
    }
}
