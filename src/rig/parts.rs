//! What is one skin with the body and moves otherwise: hair that hangs from the head over back and shoulders.
//!
//! A crease turns inwards where hair ends and the body begins. So every vertex is reached along the surface, from the skull
//! and from limbs and belly, by the way that turns inwards least: what the skull reaches more easily is the head's
//! (after Au, Zheng, Chen, Xu and Tai, Mesh segmentation with concavity-aware fields, IEEE TVCG 18(7), 2012, which
//! makes creases dear to cross as well). Normals are smoothed for it, so that the stairs of a grid are no creases.

use super::WeightBone;
use super::solid::sides::outward;
use crate::character::{Humanoid, Role};
use crate::geometry::laplacian::has_area;
use crate::geometry::{Neighbours, ROUNDING, SEAM, by_key, foot, least_costs, neighbours, weld};
use glam::{DMat2, DVec2, DVec3};
use std::collections::BTreeMap;

/// Normals are smoothed over about this width, in heights: stairs of a grid of 100 cells a height and the furrows between
/// locks are no creases, the edge of hair on a back is one. Seen, head weight of hair below the chin (solids of Seed-san and
/// MakeHuman's child): .93 and .67 at .012, .94 and .58 at .008; at .016 thin locks are smoothed away, .08 and .15.
const SMOOTHED: f64 = 0.01;
/// One step of smoothing over the neighbours widens by the root of this share of an edge's square: for six neighbours that
/// are as far away as each other it is 6 / 14.
const STEP_VARIANCE: f64 = 0.43;
/// More steps of smoothing than this are not made. Time alone.
const MOST_STEPS: f64 = 60.0;
/// A way as long as the figure is high costs as much as a turn of so many radians inwards. Seen: at .2, and at .6, head
/// weight of hair below the chin changes by up to .03.
const LENGTH_COST: f64 = 0.3;
/// Of the vertices that are nearest to a limb's bone or the head's this share that lies nearest is that for sure; what hangs
/// beside it is not. Seen: at .25, and at .5, head weight of hair below the chin changes by up to .02.
const SURE: f64 = 0.4;
/// What looks this much forward, as the cosine, is the front: 60 degrees to either side.
const FORWARD: f64 = 0.5;
/// The breastbone reaches this share of the way from chest to neck. Seen: without it skin under a lock on the chest is
/// taken for hair.
const BREASTBONE: f64 = 0.7;
/// What hangs ends at least this far below the shoulders, in heights: jaws and the undersides of large heads do not. Seen:
/// without it the weights of 2 % of five of 16 bare figures change, and of 11 % of tubbykun.
const BELOW_SHOULDERS: f64 = 0.01;
/// What the skull reaches this much more easily than the body is the head's, in radians. Seen: at 0 head weight of the hair
/// of MakeHuman's child and baby is .79 and .63 in place of .67 and .18, and 9 % of a bare model change.
const MARGIN: f64 = 0.1;
/// Rows between neck joint and head joint in which the neck's width is looked for.
const NECK_ROWS: usize = 6;
/// So many of the vertices of a row of the neck's front lie within its half width: not what hangs beside it.
const NECK_WIDTH: f64 = 0.8;
/// What lies further from the neck's axis than so many of its radii hangs beside it. Seen: at 1.7 head weight of hair below
/// the chin falls by up to .06, at .9 it rises by up to .03.
const BESIDE_NECK: f64 = 1.3;

/// For each of `positions` whether it is hair, or something else that hangs from the head beside the neck and over the body.
///
/// `bones`: of the joints that `humanoid` names, in the same space, in which the figure is 1 high.
///
/// O(vertices · log vertices).
pub fn hangs_from_head(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    bones: &[WeightBone],
    humanoid: &Humanoid,
) -> Vec<bool> {
    let weld = weld(positions, SEAM);
    let points: Vec<DVec3> = weld.first_vertices().iter().map(|&vertex| positions[vertex as usize]).collect();
    let welded: Vec<[u32; 3]> = triangles
        .iter()
        .map(|&corners| weld.triangle(corners))
        .filter(|corners| has_area(corners.map(|vertex| points[vertex as usize])))
        .collect();
    let near = neighbours(triangles, &weld);
    let hanging = Skin::new(&points, &welded, &near, bones, humanoid)
        .map_or_else(|| vec![false; points.len()], |skin| skin.hanging());
    weld.representative.iter().map(|&welded| hanging[welded as usize]).collect()
}

struct Skin<'a> {
    points: &'a [DVec3],
    near: &'a Neighbours,
    normals: Vec<DVec3>,
    /// How much the surface turns inwards at each vertex, in the direction in which it does most: radians a height.
    hollows: Vec<f64>,
    /// The role whose bone is nearest to each vertex, and how far away that is.
    nearest: Vec<(Role, f64)>,
    head: DVec3,
    neck: DVec3,
    hips: DVec3,
    chest: DVec3,
    /// The height of the shoulder joints, or of the neck's where that lies lower.
    shoulders: f64,
}

impl<'a> Skin<'a> {
    fn new(
        points: &'a [DVec3],
        triangles: &[[u32; 3]],
        near: &'a Neighbours,
        bones: &[WeightBone],
        humanoid: &Humanoid,
    ) -> Option<Self> {
        let roles: BTreeMap<usize, Role> = humanoid.iter().map(|(role, joint)| (joint, role)).collect();
        let of_bones: Vec<(Role, &WeightBone)> =
            bones.iter().filter_map(|bone| Some((*roles.get(&(bone.joint as usize))?, bone))).collect();
        let at = |role: Role| {
            let bone = of_bones.iter().find(|(own, _)| *own == role)?.1;
            bone.segments.first().map(|ends| ends[0])
        };
        let nearest_bone = |&p: &DVec3| {
            let segments =
                of_bones.iter().flat_map(|&(role, bone)| bone.segments.iter().map(move |ends| (role, ends)));
            let distances = segments.map(|(role, &[a, b])| (role, foot(p, a, b).0.distance(p)));
            let none = (Role::Hips, f64::INFINITY);
            distances.fold(none, |best, other| if other.1 < best.1 { other } else { best })
        };
        let normals = smoothed(points, near, outward(points, triangles));
        Some(Self {
            points,
            near,
            hollows: hollows(points, near, &normals),
            normals,
            nearest: points.iter().map(nearest_bone).collect(),
            head: at(Role::Head)?,
            neck: at(Role::Neck)?,
            hips: at(Role::Hips)?,
            chest: at(Role::Chest)?,
            shoulders: at(Role::LeftUpperArm)?.y.min(at(Role::RightUpperArm)?.y).min(at(Role::Neck)?.y),
        })
    }

    /// Vertices that hang from the head.
    fn hanging(&self) -> Vec<bool> {
        let count = self.points.len();
        let is_skull = |&v: &usize| self.nearest[v].0 == Role::Head && self.points[v].y > self.head.y;
        let skull = self.surest((0..count).filter(is_skull).collect());
        let ([low, high], radius) = self.throat();
        let body = self.sure_body(radius);
        if skull.is_empty() || body.is_empty() {
            return vec![false; count];
        }
        let (of_skull, of_body) = (self.reached(&skull), self.reached(&body));
        let radius = radius * BESIDE_NECK;
        let hanging: Vec<bool> = (0..count)
            .map(|v| {
                let p = self.points[v];
                let beside = foot(p, low, high).0.distance(p) > radius;
                beside && of_body[v].is_finite() && of_skull[v] + MARGIN < of_body[v]
            })
            .collect();
        self.low(&hanging)
    }

    /// Vertices that are limbs or belly for sure.
    fn sure_body(&self, radius: f64) -> Vec<usize> {
        let vertices = || self.nearest.iter().enumerate().map(|(vertex, &(role, _))| (role, vertex));
        let is_trunk = |role: Role| matches!(role, Role::Hips | Role::Spine | Role::Chest);
        let trunk = vertices().filter(|&(role, vertex)| is_trunk(role) && self.is_front(vertex, radius));
        let limbs = by_key(vertices().filter(|&(role, _)| is_end(role)));
        let limbs = limbs.into_values().flat_map(|vertices| self.surest(vertices));
        trunk.map(|(_, vertex)| vertex).chain(limbs).collect()
    }

    /// True for the belly, and above it for the breastbone, as broad as the neck: locks hang beside it.
    fn is_front(&self, vertex: usize, neck_radius: f64) -> bool {
        let p = self.points[vertex];
        let top = self.chest.lerp(self.neck, BREASTBONE).y;
        let is_between = p.y > self.hips.y
            && p.y < if (p.x - self.neck.x).abs() < neck_radius { top } else { self.chest.y };
        is_between && p.z > self.hips.z.max(self.chest.z) && self.normals[vertex].z > FORWARD
    }

    /// Those of `vertices` that lie nearest to their bones.
    fn surest(&self, mut vertices: Vec<usize>) -> Vec<usize> {
        vertices.sort_by(|&a, &b| self.nearest[a].1.total_cmp(&self.nearest[b].1));
        vertices.truncate((SURE * vertices.len() as f64).ceil() as usize);
        vertices
    }

    /// The neck's axis and half width where it is slimmest in front: shoulders are wider, and so is the jaw. Joints lie
    /// between a neck and the hair behind it.
    fn throat(&self) -> ([DVec3; 2], f64) {
        let mut rows = vec![Vec::new(); NECK_ROWS];
        for (p, near) in self.points.iter().zip(&self.nearest) {
            let row = (p.y - self.neck.y) / (self.head.y - self.neck.y) * NECK_ROWS as f64;
            if near.0 == Role::Neck && p.z > self.neck.z && row >= 0.0 && row < NECK_ROWS as f64 {
                rows[row as usize].push(((p.x - self.neck.x).abs(), p.z));
            }
        }
        let half = |row: &mut Vec<(f64, f64)>| {
            row.sort_by(|one, other| one.0.total_cmp(&other.0));
            let width = row.get((NECK_WIDTH * row.len() as f64) as usize)?.0;
            Some((width, row.iter().map(|of| of.1).fold(f64::NEG_INFINITY, f64::max)))
        };
        let slimmest = rows.iter_mut().filter_map(half).min_by(|one, other| one.0.total_cmp(&other.0));
        let ends = [self.neck, self.head];
        slimmest.map_or((ends, 0.0), |(width, front)| (ends.map(|end| end.with_z(front - width)), width))
    }

    /// What each vertex costs to reach from `seeds`.
    fn reached(&self, seeds: &[usize]) -> Vec<f64> {
        let beside = move |at: u32| {
            self.near.of(at as usize).iter().map(move |&other| {
                let length = self.points[other as usize].distance(self.points[at as usize]);
                let hollow = 0.5 * (self.hollows[at as usize] + self.hollows[other as usize]);
                (other, (hollow + LENGTH_COST) * length)
            })
        };
        least_costs(self.points.len(), seeds.iter().map(|&seed| (seed as u32, 0.0)), beside)
    }

    /// What of `hanging` hangs together and reaches below the shoulders.
    fn low(&self, hanging: &[bool]) -> Vec<bool> {
        let is_low = |&v: &usize| hanging[v] && self.points[v].y <= self.shoulders - BELOW_SHOULDERS;
        let low = (0..hanging.len()).filter(is_low).map(|v| (v as u32, 0.0));
        let beside = |at: u32| {
            let near = self.near.of(at as usize).iter().filter(|&&other| hanging[other as usize]);
            near.map(|&other| (other, 0.0))
        };
        least_costs(hanging.len(), low, beside).into_iter().map(f64::is_finite).collect()
    }
}

/// True for what no hair hides and no skirt: forearms, shins, hands and feet.
fn is_end(role: Role) -> bool {
    use Role::*;
    let hidden = [Hips, Spine, Chest, UpperChest, Neck, Head, LeftShoulder, LeftUpperArm, LeftUpperLeg];
    !hidden.contains(&role) && !hidden.contains(&role.mirrored())
}

/// Normals as means over neighbours, over about [`SMOOTHED`].
fn smoothed(points: &[DVec3], near: &Neighbours, mut normals: Vec<DVec3>) -> Vec<DVec3> {
    let (mut sum, mut count) = (0.0, 0.0);
    for (vertex, p) in points.iter().enumerate() {
        for &other in near.of(vertex) {
            sum += p.distance_squared(points[other as usize]);
            count += 1.0;
        }
    }
    let variance = STEP_VARIANCE * sum / f64::max(count, 1.0);
    let steps = (SMOOTHED * SMOOTHED / variance.max(f64::MIN_POSITIVE)).ceil().clamp(1.0, MOST_STEPS);
    for _ in 0..steps as usize {
        let mean = |vertex: usize| {
            let around = near.of(vertex).iter().map(|&other| normals[other as usize]).sum::<DVec3>();
            (normals[vertex] + around) / (1 + near.of(vertex).len()) as f64
        };
        normals = (0..points.len()).map(mean).collect();
    }
    normals.into_iter().map(DVec3::normalize_or_zero).collect()
}

/// The greatest curvature inwards at each vertex, 0 where there is none: what turns `normals` along the surface, by
/// least squares over the neighbours.
fn hollows(points: &[DVec3], near: &Neighbours, normals: &[DVec3]) -> Vec<f64> {
    let hollow = |vertex: usize| {
        let normal = normals[vertex];
        let (u, v) = normal.any_orthonormal_pair();
        let flat = |d: DVec3| DVec2::new(d.dot(u), d.dot(v));
        let (mut ways, mut turns) = (DMat2::ZERO, DMat2::ZERO);
        for &other in near.of(vertex) {
            let way = flat(points[other as usize] - points[vertex]);
            let turn = flat(normals[other as usize] - normal);
            ways += DMat2::from_cols(way * way.x, way * way.y);
            turns += DMat2::from_cols(turn * way.x, turn * way.y);
        }
        if normal == DVec3::ZERO
            || ways.determinant() <= ROUNDING * ways.col(0).length() * ways.col(1).length()
        {
            return 0.0;
        }
        let shape = turns * ways.inverse();
        let (a, b, d) = (shape.x_axis.x, 0.5 * (shape.x_axis.y + shape.y_axis.x), shape.y_axis.y);
        let least = 0.5 * (a + d) - (0.25 * (a - d) * (a - d) + b * b).sqrt();
        (-least).max(0.0)
    };
    (0..points.len()).map(hollow).collect()
}
