//! Eyeballs: two like pieces of the face, one on each side.

use super::UnitFigure;
use super::joints::{FoundJoints, SEEN};
use crate::character::{MeshKind, Role};
use crate::geometry::{SEAM, components, weld};
use glam::DVec3;
use std::collections::BTreeMap;

/// An eyeball is no thinner than this share of its width: what is flatter is a brow, a lash or a painted eye. Seen: at
/// -30 %, six more eyes.
const ROUNDNESS: f64 = 0.6;
/// Two eyes mirror each other to within this share of the head's length. Seen: ±30 % changes no eye.
const LIKENESS: f64 = 0.05;

/// Of two eyes neither is larger than this times the other. Seen: at -30 %, 20 fewer eyes.
const LARGER: f64 = 1.25;
/// What lies within this many radii of an eyeball's middle turns with it: an iris lies on it, a lid beside it. Seen:
/// ±30 % changes no eye.
const TURNS_WITH: f64 = 1.25;

/// An eyeball.
#[derive(Clone, Debug)]
pub struct Eye {
    /// `LeftEye` or `RightEye`.
    pub role: Role,
    /// Its middle, in the unit figure.
    pub centre: DVec3,
    /// The vertices that turn with it, by index into the unit figure, in order.
    pub vertices: Vec<usize>,
    /// 0..1.
    pub confidence: f64,
}

/// Both eyeballs, or none where the face has none that could turn.
///
/// An eyeball is a round piece of a mesh of kind `FacePart` with a like one mirrored on the other side of the head;
/// pieces inside of it (iris, pupil) turn with it.
pub fn find_eyes(figure: &UnitFigure, kinds: &[MeshKind], found: &FoundJoints) -> Vec<Eye> {
    let (Some(head), Some(crown)) = (found.joints.get(&Role::Head), found.tips.get(&Role::Head)) else {
        return Vec::new();
    };
    let length = (crown.y - found.chin.y).abs();
    let welded = weld(&figure.positions, SEAM);
    let component = components(&figure.triangles, &welded);
    let mut pieces: BTreeMap<u32, (DVec3, DVec3, Vec<usize>)> = BTreeMap::new();
    for mesh in (0..figure.mesh_count()).filter(|&mesh| kinds[mesh] == MeshKind::FacePart) {
        for vertex in figure.vertices(mesh) {
            let p = figure.positions[vertex];
            let (low, high, vertices) =
                pieces.entry(component[welded.representative[vertex] as usize]).or_insert((p, p, Vec::new()));
            *low = low.min(p);
            *high = high.max(p);
            vertices.push(vertex);
        }
    }
    let pieces: Vec<(DVec3, DVec3, Vec<usize>)> = pieces.into_values().collect();
    let middle = head.position.x;
    let balls: Vec<(DVec3, f64)> = pieces
        .iter()
        .filter_map(|(low, high, _)| {
            let size = *high - *low;
            let centre = (*low + *high) / 2.0;
            let round = size.min_element() >= ROUNDNESS * size.max_element() && size.max_element() > 0.0;
            let inside = centre.y > found.chin.y && centre.y < crown.y && size.max_element() < length / 2.0;
            (round && inside).then_some((centre, size.max_element() / 2.0))
        })
        .collect();
    let mut best: Option<[(DVec3, f64); 2]> = None;
    for &(left, radius) in balls.iter().filter(|(centre, _)| centre.x > middle) {
        let mirrored = DVec3::new(2.0 * middle - left.x, left.y, left.z);
        let other = balls
            .iter()
            .filter(|(centre, _)| centre.x < middle && centre.distance(mirrored) < LIKENESS * length)
            .min_by(|a, b| a.0.distance(mirrored).total_cmp(&b.0.distance(mirrored)));
        if let Some(&other) = other
            && (1.0 / LARGER..=LARGER).contains(&(radius / other.1))
            && best.is_none_or(|[(_, largest), _]| radius > largest)
        {
            best = Some([(left, radius), other]);
        }
    }
    let Some(pair) = best else {
        return Vec::new();
    };
    [Role::LeftEye, Role::RightEye]
        .into_iter()
        .zip(pair)
        .map(|(role, (centre, radius))| {
            let within = |&(low, high, _): &&(DVec3, DVec3, Vec<usize>)| {
                ((*low + *high) / 2.0).distance(centre) + (*high - *low).max_element() / 2.0
                    <= TURNS_WITH * radius
            };
            let mut vertices: Vec<usize> =
                pieces.iter().filter(within).flat_map(|(_, _, vertices)| vertices).copied().collect();
            vertices.sort_unstable();
            Eye { role, centre, vertices, confidence: SEEN }
        })
        .collect()
}
