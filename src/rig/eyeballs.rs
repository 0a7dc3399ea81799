//! Eyeballs: two like pieces of the face, one on each side.

use super::UnitFigure;
use super::front_view::image;
use super::joints::{FoundJoints, SEEN};
use crate::character::{MeshKind, Role};
use crate::geometry::{Bounds, SEAM, bounds_by_group, components, weld};
use glam::DVec3;

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
    let piece = |vertex: usize| component[welded.representative[vertex] as usize] as usize;
    let meshes = (0..figure.mesh_count()).filter(|&mesh| kinds[mesh] == MeshKind::FacePart);
    let face: Vec<usize> = meshes.flat_map(|mesh| figure.vertices(mesh)).collect();
    let boxes =
        bounds_by_group(welded.count, face.iter().map(|&vertex| (piece(vertex), figure.positions[vertex])));
    let ball_around = |&(low, high): &Bounds| ((low + high) / 2.0, (high - low).max_element() / 2.0);
    let middle = head.position.x;
    let is_ball = |piece: &&Bounds| {
        let size = piece.1 - piece.0;
        let centre = ball_around(piece).0;
        let round = size.min_element() >= ROUNDNESS * size.max_element() && size.max_element() > 0.0;
        round && centre.y > found.chin.y && centre.y < crown.y && size.max_element() < length / 2.0
    };
    let balls: Vec<(DVec3, f64)> = boxes.iter().filter(is_ball).map(ball_around).collect();
    let pairs = balls.iter().filter(|(centre, _)| centre.x > middle).filter_map(|&left| {
        let off = |ball: &(DVec3, f64)| ball.0.distance(image(left.0, middle));
        let others = balls.iter().filter(|ball| ball.0.x < middle && off(ball) < LIKENESS * length);
        let &right = others.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        (1.0 / LARGER..=LARGER).contains(&(left.1 / right.1)).then_some([left, right])
    });
    // The largest pair, of several the first.
    let Some(pair) = pairs.rev().max_by(|a, b| a[0].1.total_cmp(&b[0].1)) else {
        return Vec::new();
    };
    let eye = |(role, (centre, radius)): (Role, (DVec3, f64))| {
        let turns_with = |&&vertex: &&usize| {
            let (middle, reach) = ball_around(&boxes[piece(vertex)]);
            middle.distance(centre) + reach <= TURNS_WITH * radius
        };
        let vertices = face.iter().filter(turns_with).copied().collect();
        Eye { role, centre, vertices, confidence: SEEN }
    };
    [Role::LeftEye, Role::RightEye].into_iter().zip(pair).map(eye).collect()
}
