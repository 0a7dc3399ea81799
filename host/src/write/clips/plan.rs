//! What of a character clips are retargeted by: its legs, its hips, and what can touch the floor.

use super::leg::Bones;
use super::smooth;
use super::touch::{Point, outermost};
use super::track::{Clip, Local, Posed};
use crate::load::Loaded;
use crate::write::extent;
use glam::{DMat4, DQuat, DVec3};
use superdeform::{Deformed, Role};

/// Points of the trunk that hang below this height at rest, in legs' lengths, are a skirt's: these brush the floor, and rest
/// on nothing.
const HEM: f64 = 0.25;

/// The way that a body faces, over the ground, is this long where it lies and where it stands.
const UPRIGHT: [f64; 2] = [0.3, 0.7];

/// A leg.
#[derive(Clone, Debug)]
pub(super) struct Limb {
    /// Nodes.
    pub(super) upper: usize,
    pub(super) lower: usize,
    pub(super) foot: usize,
    /// True where the foot hangs from something else than the shin.
    pub(super) loose: bool,
    /// True where what it hangs from is carried by the hips' node.
    pub(super) carried: bool,
    pub(super) foot_points: Vec<Point>,
    /// How high its lowest point is above the floor at rest, before and after.
    pub(super) rest_height: [f64; 2],
    /// The foot in the shin's space at rest, before and after.
    on_shin: [DVec3; 2],
    /// Undoes the thigh's turn at rest.
    upper_rest: DQuat,
    /// Undoes the foot's turn at rest.
    foot_rest: DQuat,
}

impl Limb {
    /// The leg in a pose.
    pub(super) fn bones(&self, plan: &Plan, posed: &Posed) -> Bones {
        let side = posed.turn[self.upper] * self.upper_rest * plan.side;
        let [hip, knee, ankle] = [self.upper, self.lower, self.foot].map(|node| posed.place(node));
        Bones { hip, knee, ankle, side }
    }

    /// What turns the foot in model space by a share of the way to where its sole is level.
    pub(super) fn towards_level(&self, plan: &Plan, posed: &Posed, share: f64) -> DQuat {
        let normal = (posed.turn[self.foot] * self.foot_rest * plan.up).normalize_or(plan.up);
        DQuat::IDENTITY.slerp(DQuat::from_rotation_arc(normal, plan.up), share)
    }

    /// How high the foot's lowest point is above the floor; `moves` takes nodes' surroundings from rest to a pose, before (side 0)
    /// or after (1).
    pub(super) fn lowest(&self, plan: &Plan, side: usize, moves: &[DMat4]) -> f64 {
        let heights = self.foot_points.iter().map(|point| point.at(side, moves).dot(plan.up));
        heights.fold(f64::INFINITY, f64::min) - plan.floor[side]
    }

    /// Where the new shin takes the foot, which is as far from its place on the shin as it was.
    pub(super) fn carried_to(&self, plan: &Plan, before: &Posed, after: &Posed) -> DVec3 {
        let was = before.world[self.lower].inverse().transform_point3(before.place(self.foot));
        let on_shin = self.on_shin[1] + (was - self.on_shin[0]) * plan.stride;
        after.world[self.lower].transform_point3(on_shin)
    }
}

/// What the frames of all clips have in common.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// The node that carries hips and legs: mostly the hips' own.
    pub(super) hips: usize,
    /// Those that have all three joints and a foot.
    pub(super) legs: Vec<Limb>,
    /// Of trunk, thighs and knees.
    pub(super) trunk: Vec<Point>,
    pub(super) up: DVec3,
    /// From right to left at rest.
    pub(super) side: DVec3,
    /// The hips at rest, before and after.
    pub(super) rest_hips: [DVec3; 2],
    /// The joints whose turns tell the way that the body faces, with what undoes their turns at rest.
    faces: Vec<(usize, DQuat)>,
    /// Heights along up, before and after.
    pub(super) floor: [f64; 2],
    /// Of the new figure.
    pub(super) height: f64,
    /// Of the old one: thigh and shin.
    pub(super) leg_length: f64,
    pub(super) stride: f64,
    /// The nodes as the file has them, in their parents' spaces.
    pub(super) locals: Vec<Local>,
    /// Their places at rest, there.
    pub(super) rest_places: Vec<DVec3>,
    /// What their ways from there are scaled by.
    pub(super) scales: Vec<f64>,
    pub(super) rest_inverse: Vec<DMat4>,
    pub(super) new_inverse: Vec<DMat4>,
}

/// The node that carries hips and legs: that of the hips, or the nearest above it from which both thighs hang, too.
pub(super) fn hips_node(loaded: &Loaded) -> Option<usize> {
    let node = |role: Role| {
        let joint = loaded.character.humanoid.joint(role);
        joint.and_then(|joint| loaded.node_of_joint.get(joint).copied())
    };
    let hips = node(Role::Hips)?;
    let thighs = [Role::LeftUpperLeg, Role::RightUpperLeg].map(node);
    let carries = |&above: &usize| thighs.iter().flatten().all(|&thigh| is_within(loaded, thigh, above));
    std::iter::successors(Some(hips), |&node| loaded.tree.parents[node]).find(carries).or(Some(hips))
}

/// True where a node is `above` or hangs from it.
pub(super) fn is_within(loaded: &Loaded, node: usize, above: usize) -> bool {
    std::iter::successors(Some(node), |&node| loaded.tree.parents[node]).any(|node| node == above)
}

/// True where a foot or its shin hangs from a node, or is it.
pub(super) fn is_of_leg(loaded: &Loaded, node: usize) -> bool {
    let ends = LEGS.as_flattened().iter().filter_map(|&role| loaded.character.humanoid.joint(role));
    ends.map(|joint| loaded.node_of_joint[joint]).any(|end| is_within(loaded, end, node))
}

/// New over old height of the hips above the ground, which is as low as the lowest vertex.
pub(super) fn hip_ratio(loaded: &Loaded, deformed: &Deformed) -> f64 {
    let up = up_of(loaded);
    let Some(hips) = loaded.character.humanoid.joint(Role::Hips) else {
        return 1.0;
    };
    let (low, high) = extent(loaded.character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let (new_low, _) = extent(deformed.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
    let before = loaded.character.skeleton.joints[hips].position().dot(up) - low;
    let after = deformed.joints[hips].dot(up) - new_low;
    let ratio = after / before;
    // Hips at or below the soles tell nothing.
    if before > 1e-3 * (high - low) && ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
}

fn up_of(loaded: &Loaded) -> DVec3 {
    loaded.character.axes.up.as_dvec3().normalize_or(DVec3::Y)
}

const LEGS: [[Role; 3]; 2] = [
    [Role::LeftUpperLeg, Role::LeftLowerLeg, Role::LeftFoot],
    [Role::RightUpperLeg, Role::RightLowerLeg, Role::RightFoot],
];

/// The parts whose points may touch the floor: both feet, both shins' lower halves, which stand for feet that move no vertex, and
/// the trunk with thighs and knees.
const TRUNK: usize = 4;

impl Plan {
    /// The plan of a character whose joints were `loaded`'s and are `deformed`'s; `None` without hips and two whole legs.
    pub(super) fn of(loaded: &Loaded, deformed: &Deformed, new_rest: &[DMat4]) -> Option<Self> {
        let character = &loaded.character;
        let up = up_of(loaded);
        let hips = hips_node(loaded)?;
        let rest = &loaded.pose.rest;
        let joint = |role: Role| character.humanoid.joint(role);
        let node = |role: Role| joint(role).map(|joint| loaded.node_of_joint[joint]);
        let nodes: Vec<[usize; 3]> = LEGS
            .iter()
            .map(|roles| Some([node(roles[0])?, node(roles[1])?, node(roles[2])?]))
            .collect::<Option<_>>()?;
        let place = |side: usize, node: usize| [rest, new_rest][side][node].w_axis.truncate();
        let length = |side: usize| -> f64 {
            let of_leg = |&[upper, lower, foot]: &[usize; 3]| {
                let [hip, knee, ankle] = [upper, lower, foot].map(|node| place(side, node));
                hip.distance(knee) + knee.distance(ankle)
            };
            nodes.iter().map(of_leg).sum::<f64>() / 2.0
        };
        let leg_length = length(0);
        let stride = length(1) / leg_length;
        let (low, high) = extent(character.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
        let (new_low, new_high) = extent(deformed.meshes.iter().map(|mesh| mesh.positions.as_slice()), up);
        let usable = leg_length > 1e-3 * (high - low) && stride.is_finite() && stride > 0.0;
        if !usable {
            return None;
        }
        let floor = [low, new_low];

        let mut points = touching(loaded, deformed, low + HEM * leg_length, up);
        let trunk = points.pop()?;
        let shins = points.split_off(2);
        let feet =
            points.into_iter().zip(shins).map(|(foot, shin)| if foot.is_empty() { shin } else { foot });
        let legs = nodes.iter().zip(feet).map(|(&[upper, lower, foot], foot_points)| {
            let lowest = |side: usize| {
                let heights = foot_points.iter().map(|point| point.rest[side].dot(up));
                heights.fold(f64::INFINITY, f64::min) - floor[side]
            };
            let on_shin =
                |side: usize| [rest, new_rest][side][lower].inverse().transform_point3(place(side, foot));
            let rest_height = [lowest(0), lowest(1)];
            let undo = |node: usize| turn_of(&rest[node]).inverse();
            (!foot_points.is_empty() && is_within(loaded, lower, upper)).then(|| Limb {
                upper,
                lower,
                foot,
                loose: !is_within(loaded, foot, lower),
                carried: foot != hips && is_within(loaded, foot, hips),
                rest_height,
                on_shin: [on_shin(0), on_shin(1)],
                upper_rest: undo(upper),
                foot_rest: undo(foot),
                foot_points,
            })
        });
        let legs: Vec<Limb> = legs.collect::<Option<_>>()?;
        let side = (place(0, legs[0].upper) - place(0, legs[1].upper)).reject_from_normalized(up);
        let faces = [Role::Hips, Role::UpperChest, Role::Chest, Role::Spine].map(node);
        // The hips and the highest part of the trunk: in a step they turn against each other.
        let faces = [faces[0], faces[1].or(faces[2]).or(faces[3])].into_iter().flatten();
        let locals: Vec<Local> =
            loaded.tree.local.iter().map(|local| local.to_scale_rotation_translation()).collect();
        let inverse = |rest: &[DMat4]| rest.iter().map(DMat4::inverse).collect();
        Some(Self {
            hips,
            legs,
            trunk,
            up,
            side: side.normalize_or_zero(),
            rest_hips: [place(0, hips), place(1, hips)],
            faces: faces.map(|node| (node, turn_of(&rest[node]).inverse())).collect(),
            floor,
            height: new_high - new_low,
            leg_length,
            stride,
            rest_places: (0..locals.len()).map(|node| loaded.pose_translation(node)).collect(),
            scales: vec![1.0; locals.len()],
            locals,
            rest_inverse: inverse(rest),
            new_inverse: inverse(new_rest),
        })
    }

    /// True where a clip moves the hips or the legs, or what these hang from.
    pub(super) fn moved_by(&self, loaded: &Loaded, clip: &Clip) -> bool {
        let ends = self.legs.iter().flat_map(|leg| [leg.lower, leg.foot]).chain([self.hips]);
        ends.flat_map(|end| std::iter::successors(Some(end), |&node| loaded.tree.parents[node])).any(|node| {
            clip.places.contains_key(&node)
                || clip.turns.contains_key(&node)
                || clip.scales.contains_key(&node)
        })
    }

    /// The turn about up that takes the way that the body faces at rest to the way that it faces in a pose; and how much it stands
    /// upright, 1 or less: the way of a body that lies leads up or down.
    pub(super) fn facing(&self, posed: &Posed) -> (DQuat, f64) {
        let forward = self.side.cross(self.up);
        let faces = |&(node, undo): &(usize, DQuat)| posed.turn[node] * undo * forward;
        let way: DVec3 = self.faces.iter().map(faces).sum::<DVec3>() / self.faces.len().max(1) as f64;
        let way = way.reject_from_normalized(self.up);
        let angle = forward.cross(way).dot(self.up).atan2(forward.dot(way));
        (DQuat::from_axis_angle(self.up, angle), smooth(way.length(), UPRIGHT))
    }
}

fn turn_of(matrix: &DMat4) -> DQuat {
    matrix.to_scale_rotation_translation().1
}

/// The points that may touch the floor, by part; of the trunk what is above `hem`.
fn touching(loaded: &Loaded, deformed: &Deformed, hem: f64, up: DVec3) -> Vec<Vec<Point>> {
    let character = &loaded.character;
    let joints = &character.skeleton.joints;
    let mut role_of: Vec<Option<Role>> = vec![None; joints.len()];
    character.humanoid.iter().for_each(|(role, joint)| role_of[joint] = Some(role));
    // A joint without a role is of a foot where it hangs from one; tails and skirts, which rest on nothing, are no trunk.
    let of_foot = |joint: usize| {
        let role = character.skeleton.ancestors(joint).take(joints.len()).find_map(|above| role_of[above]);
        role.filter(|role| {
            matches!(role, Role::LeftFoot | Role::LeftToes | Role::RightFoot | Role::RightToes)
        })
    };
    let role_of: Vec<Option<Role>> =
        (0..joints.len()).map(|joint| role_of[joint].or_else(|| of_foot(joint))).collect();
    let place = |role: Role| character.humanoid.joint(role).map(|joint| joints[joint].position());
    let part = |joint: usize, p: DVec3| {
        use Role::*;
        let above_hem = (p.dot(up) > hem).then_some(TRUNK);
        match role_of[joint]? {
            LeftFoot | LeftToes => Some(0),
            RightFoot | RightToes => Some(1),
            Hips | Spine | Chest | UpperChest | LeftUpperLeg | RightUpperLeg => above_hem,
            shin @ (LeftLowerLeg | RightLowerLeg) => {
                let foot = if shin == LeftLowerLeg { LeftFoot } else { RightFoot };
                let (knee, ankle) = (place(shin)?, place(foot)?);
                let of_foot = if shin == LeftLowerLeg { 2 } else { 3 };
                Some(if p.distance(knee) < p.distance(ankle) { TRUNK } else { of_foot })
            }
            _ => None,
        }
    };
    outermost(loaded, deformed, TRUNK + 1, part, |part| part != TRUNK)
}
