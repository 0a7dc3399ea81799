//! People made of tubes, of which everything is known in advance: lengths, radii, landmarks.
//!
//! A person stands with the soles at height 0 and the hips over the origin, looks along z, the left side at +x, in
//! metres; `unit` and `facing` are applied last. Known analytically (before `unit` and `facing`):
//!
//! - every joint: [`Person::joints`], and so every length;
//! - the surrounding-mesh radius of neck, torso, arms and legs: [`Person::radius`]. Tubes have 48 columns that begin
//!   where the measuring ring begins, so 12 or 48 rays meet the vertices and the radius is exact; for a turned person
//!   it is at most 0.22 % too small, for a coarser one 0.9 % (24 columns). Ends are rounded over 0.15 of a bone only, so no neighbour's end reaches a sample;
//! - landmarks: sole 0, [`Person::crotch`], [`Person::shoulder_line`], [`Person::chin`], [`Person::crown`]. From the
//!   chin down the front profile steps back from the face to the neck;
//! - the total height: the crown.
//!
//! Shoulders, hips, hands and feet have no radius of their own: their groups keep their girth in the paper.
#![allow(dead_code)]

use glam::{DMat3, DMat4, DVec3};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use superdeform::internals::character::bones::Group;
use superdeform::internals::character::humanoid::LEFT_FINGERS;
use superdeform::{Character, Humanoid, Joint, Mesh, MeshKind, Role, Skeleton, Weights};

/// Columns of every tube unless told otherwise.
pub const COLUMNS: usize = 48;

/// How far a tube's rounded end reaches, in lengths of its bone, ...
const END: f64 = 0.15;

/// ... and at most, metres: the height of the hips over the upper-leg joints, so that thighs end below the trunk's rays.
const LONGEST_END: f64 = 0.03;

/// Lengths and radii, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proportions {
    /// Chin to crown.
    pub head: f64,
    /// Half the head's width, and its half depth without the nose.
    pub head_half_width: f64,
    /// Neck joint to head joint; the chin is at 0.8 of it.
    pub neck: f64,
    /// Hips to neck joint: spine, chest and upper chest divide it into four.
    pub torso: f64,
    pub upper_arm: f64,
    pub lower_arm: f64,
    pub upper_leg: f64,
    pub lower_leg: f64,
    /// Wrist to the middle finger's first joint, or to the tip without fingers.
    pub hand: f64,
    /// Ankle to toes.
    pub foot: f64,
    /// From the middle to the upper-arm joint.
    pub shoulder_half_width: f64,
    /// From the middle to the upper-leg joint.
    pub hip_half_width: f64,
    pub neck_radius: f64,
    pub torso_radius: f64,
    pub upper_arm_radius: f64,
    pub lower_arm_radius: f64,
    pub upper_leg_radius: f64,
    pub lower_leg_radius: f64,
}

/// About 7.4 heads.
pub const ADULT: Proportions = Proportions {
    head: 0.23,
    head_half_width: 0.08,
    neck: 0.10,
    torso: 0.50,
    upper_arm: 0.28,
    lower_arm: 0.25,
    upper_leg: 0.42,
    lower_leg: 0.40,
    hand: 0.10,
    foot: 0.14,
    shoulder_half_width: 0.19,
    hip_half_width: 0.10,
    neck_radius: 0.05,
    torso_radius: 0.13,
    upper_arm_radius: 0.045,
    lower_arm_radius: 0.035,
    upper_leg_radius: 0.075,
    lower_leg_radius: 0.05,
};

/// About 2.5 heads.
pub const CHIBI: Proportions = Proportions {
    head: 0.50,
    head_half_width: 0.25,
    neck: 0.05,
    torso: 0.30,
    upper_arm: 0.14,
    lower_arm: 0.12,
    upper_leg: 0.16,
    lower_leg: 0.15,
    hand: 0.06,
    foot: 0.10,
    shoulder_half_width: 0.18,
    hip_half_width: 0.09,
    neck_radius: 0.06,
    torso_radius: 0.13,
    upper_arm_radius: 0.05,
    lower_arm_radius: 0.045,
    upper_leg_radius: 0.07,
    lower_leg_radius: 0.06,
};

/// A person to be built.
#[derive(Clone, Debug, PartialEq)]
pub struct Person {
    pub proportions: Proportions,
    /// Degrees of the arms under the horizontal: 0 is a T-pose, 45 an A-pose.
    pub arm_angle: f64,
    /// A cone of cloth from the waist to the knees, kind garment, weighted to the hips.
    pub skirt: bool,
    /// Tubes without ends: no mesh is closed.
    pub holes: bool,
    /// Thumbs and fingers with three joints each.
    pub fingers: bool,
    /// Limbs and trunk are one tube each, with weights blended over a fifth of a bone on either side of a joint, instead
    /// of one closed tube for each bone, weighted to it alone.
    pub blended: bool,
    /// Two spheres weighted to the eyes, kind face part.
    pub eyes: bool,
    /// Length of a metre in model units.
    pub unit: f64,
    /// Degrees by which the person is turned about y.
    pub facing: f64,
    /// Roles that no joint plays; their weights fall to the role above.
    pub without: Vec<Role>,
    /// Columns of every tube, a multiple of 12; rings grow fewer with them.
    pub columns: usize,
}

impl Default for Person {
    fn default() -> Self {
        Self {
            proportions: ADULT,
            arm_angle: 0.0,
            skirt: false,
            holes: false,
            fingers: false,
            blended: false,
            eyes: true,
            unit: 1.0,
            facing: 0.0,
            without: Vec::new(),
            columns: COLUMNS,
        }
    }
}

/// The radius of the feet, on which the person stands.
const FOOT_RADIUS: f64 = 0.035;

impl Person {
    pub fn adult() -> Self {
        Self::default()
    }

    pub fn chibi() -> Self {
        Self { proportions: CHIBI, ..Self::default() }
    }

    /// The upper-leg joints' height.
    fn hip_line(&self) -> f64 {
        let p = &self.proportions;
        2.0 * FOOT_RADIUS + p.lower_leg + p.upper_leg
    }

    fn hips(&self) -> DVec3 {
        DVec3::Y * (self.hip_line() + LONGEST_END)
    }

    /// Where the trunk ends between the legs.
    pub fn crotch(&self) -> f64 {
        self.hips().y - END * 0.25 * self.proportions.torso
    }

    /// The upper-arm joints' height.
    pub fn shoulder_line(&self) -> f64 {
        self.hips().y + self.proportions.torso - 0.04
    }

    pub fn chin(&self) -> f64 {
        self.hips().y + self.proportions.torso + 0.8 * self.proportions.neck
    }

    pub fn crown(&self) -> f64 {
        self.chin() + self.proportions.head
    }

    /// The head top as 7 rays with the head's own half width find it: the ring's height on the skull.
    pub fn head_top(&self) -> f64 {
        self.chin() + self.proportions.head * (0.5 + 0.5 * (1.0 - 0.25_f64.powi(2)).sqrt())
    }

    /// The surrounding-mesh radius of the bones of a group, where it is known.
    pub fn radius(&self, group: Group) -> Option<f64> {
        let p = &self.proportions;
        match group {
            Group::Neck => Some(p.neck_radius),
            Group::Torso => Some(p.torso_radius),
            Group::UpperArm => Some(p.upper_arm_radius),
            Group::LowerArm => Some(p.lower_arm_radius),
            Group::UpperLeg => Some(p.upper_leg_radius),
            Group::LowerLeg => Some(p.lower_leg_radius),
            _ => None,
        }
    }

    /// Where the joints are, before `unit` and `facing`; without the roles of `without`.
    pub fn joints(&self) -> BTreeMap<Role, DVec3> {
        use Role::*;
        let p = &self.proportions;
        let hips = self.hips();
        let neck = hips + DVec3::Y * p.torso;
        let head = neck + DVec3::Y * p.neck;
        let mut joints = BTreeMap::from([
            (Hips, hips),
            (Spine, hips.lerp(neck, 0.25)),
            (Chest, hips.lerp(neck, 0.5)),
            (UpperChest, hips.lerp(neck, 0.75)),
            (Neck, neck),
            (Head, head),
            (Jaw, head + DVec3::Z * 0.3 * p.head_half_width),
        ]);
        let eye_height = self.chin() + 0.45 * p.head;
        let mut left = vec![
            (LeftEye, DVec3::new(0.4 * p.head_half_width, eye_height, 0.75 * p.head_half_width)),
            (LeftUpperLeg, DVec3::new(p.hip_half_width, self.hip_line(), 0.0)),
            (LeftShoulder, DVec3::new(0.3 * p.shoulder_half_width, self.shoulder_line(), 0.0)),
            (LeftUpperArm, DVec3::new(p.shoulder_half_width, self.shoulder_line(), 0.0)),
        ];
        let knee = left[1].1 - DVec3::Y * p.upper_leg;
        let ankle = knee - DVec3::Y * p.lower_leg;
        let toes = DVec3::new(ankle.x, FOOT_RADIUS, 0.0);
        let toes = toes + DVec3::Z * (p.foot.powi(2) - (ankle.y - FOOT_RADIUS).powi(2)).sqrt();
        let along = self.arm_direction();
        let elbow = left[3].1 + along * p.upper_arm;
        let wrist = elbow + along * p.lower_arm;
        left.extend([
            (LeftLowerLeg, knee),
            (LeftFoot, ankle),
            (LeftToes, toes),
            (LeftLowerArm, elbow),
            (LeftHand, wrist),
        ]);
        if self.fingers {
            for (finger, roles) in LEFT_FINGERS.iter().enumerate() {
                let (root, along) = self.finger(wrist, finger);
                for (joint, &role) in roles.iter().enumerate() {
                    left.push((role, root + along * FINGER_JOINTS[joint] * p.hand));
                }
            }
        }
        for (role, at) in left {
            joints.insert(role, at);
            joints.insert(role.mirrored(), DVec3::new(-at.x, at.y, at.z));
        }
        joints.retain(|role, _| !self.without.contains(role));
        joints
    }

    /// The way the left arm points.
    pub fn arm_direction(&self) -> DVec3 {
        let (sin, cos) = self.arm_angle.to_radians().sin_cos();
        DVec3::new(cos, -sin, 0.0)
    }

    /// Where a finger of the left hand begins and the way it points: the thumb forward, the others along the arm.
    fn finger(&self, wrist: DVec3, finger: usize) -> (DVec3, DVec3) {
        let along = self.arm_direction();
        let hand = self.proportions.hand;
        if finger == 0 {
            (wrist + 0.3 * hand * along + 0.35 * hand * DVec3::Z, (along + DVec3::Z).normalize())
        } else {
            (wrist + hand * along + DVec3::Z * hand * (0.75 - 0.3 * finger as f64), along)
        }
    }

    /// The person in rest pose, with `unit` and `facing` applied.
    pub fn build(&self) -> Character {
        let p = &self.proportions;
        let joints = self.joints();
        let roles: Vec<Role> = joints.keys().copied().collect();
        let index = |role: Role| {
            let role = role.chain().find(|role| joints.contains_key(role)).unwrap();
            roles.iter().position(|&other| other == role).unwrap() as u32
        };
        let complete = Person { without: Vec::new(), ..self.clone() }.joints();
        let at = |role: Role| complete[&role];
        let shape = || Shape { columns: self.columns, ..Shape::default() };
        let mut body = shape();
        self.trunk_and_limbs(&mut body, &at);
        body.head(self);
        let mut parts = vec![("body", MeshKind::Body, body)];
        if self.eyes {
            for (name, role) in [("left_eye", Role::LeftEye), ("right_eye", Role::RightEye)] {
                let mut eye = shape();
                eye.ellipsoid(at(role), DVec3::splat(0.15 * p.head_half_width), role);
                parts.push((name, MeshKind::FacePart, eye));
            }
        }
        if self.skirt {
            let mut skirt = shape();
            let top = at(Role::Spine);
            let bottom = DVec3::Y * at(Role::LeftLowerLeg).y;
            let count = self.columns / 3;
            let rings = (0..=count).map(|ring| ring as f64 / count as f64).map(|t| Ring {
                centre: bottom.lerp(top, t),
                radius: (1.0 - t) * 2.4 * p.torso_radius + t * 1.08 * p.torso_radius,
                weights: vec![(Role::Hips, 1.0)],
            });
            skirt.tube(DVec3::Y, &rings.collect::<Vec<_>>(), false);
            parts.push(("skirt", MeshKind::Garment, skirt));
        }

        let turn = DMat3::from_rotation_y(self.facing.to_radians());
        let place = |p: DVec3| turn * p * self.unit;
        let meshes = parts.into_iter().map(|(name, kind, shape)| {
            let rows = shape.weights.iter().map(|row| {
                let mut merged: BTreeMap<u32, f32> = BTreeMap::new();
                for &(role, weight) in row {
                    *merged.entry(index(role)).or_default() += weight as f32;
                }
                merged
            });
            Mesh {
                name: name.to_string(),
                kind: Some(kind),
                weights: Weights::from_rows(rows),
                normals: shape.normals().into_iter().map(|n| (turn * n).as_vec3()).collect(),
                positions: shape.positions.iter().map(|&p| place(p).as_vec3()).collect(),
                triangles: shape.triangles,
                ..Mesh::default()
            }
        });
        let mut humanoid = Humanoid::default();
        let mut skeleton = Skeleton::default();
        for (joint, (&role, &at)) in joints.iter().enumerate() {
            humanoid.set(role, joint);
            skeleton.joints.push(Joint {
                name: role.name().to_string(),
                parent: role.parent().map(|above| index(above) as usize),
                rest: DMat4::from_translation(place(at)),
            });
        }
        Character { meshes: meshes.collect(), skeleton, humanoid, ..Character::default() }
    }

    fn trunk_and_limbs(&self, body: &mut Shape, at: &dyn Fn(Role) -> DVec3) {
        use Role::*;
        let p = &self.proportions;
        let r = p.torso_radius;
        body.chain(
            self,
            &[(Hips, r), (Spine, r), (Chest, r), (UpperChest, r)],
            &[at(Hips), at(Spine), at(Chest), at(UpperChest), at(Neck)],
        );
        body.chain(self, &[(Neck, p.neck_radius)], &[at(Neck), at(Head)]);
        for left in [true, false] {
            let side = |role: Role| if left { role } else { role.mirrored() };
            let at = |role: Role| at(side(role));
            let mirror = |v: DVec3| if left { v } else { DVec3::new(-v.x, v.y, v.z) };
            // From the trunk's surface outwards, so that the torso's rays do not meet it.
            let reach =
                at(LeftUpperArm) - mirror(DVec3::X * (p.shoulder_half_width - p.torso_radius) / (1.0 + END));
            body.chain(self, &[(side(LeftShoulder), p.upper_arm_radius)], &[reach, at(LeftUpperArm)]);
            body.chain(
                self,
                &[(side(LeftUpperArm), p.upper_arm_radius), (side(LeftLowerArm), p.lower_arm_radius)],
                &[at(LeftUpperArm), at(LeftLowerArm), at(LeftHand)],
            );
            let palm = at(LeftHand) + mirror(self.arm_direction()) * p.hand;
            body.chain(self, &[(side(LeftHand), 0.8 * p.lower_arm_radius)], &[at(LeftHand), palm]);
            body.chain(
                self,
                &[(side(LeftUpperLeg), p.upper_leg_radius), (side(LeftLowerLeg), p.lower_leg_radius)],
                &[at(LeftUpperLeg), at(LeftLowerLeg), at(LeftFoot)],
            );
            let level = |z: f64| DVec3::new(at(LeftFoot).x, FOOT_RADIUS, z);
            body.chain(self, &[(side(LeftFoot), FOOT_RADIUS)], &[level(-0.04), level(at(LeftToes).z)]);
            let tip = at(LeftToes).z + 0.3 * p.foot;
            body.chain(self, &[(side(LeftToes), FOOT_RADIUS)], &[level(at(LeftToes).z), level(tip)]);
            if self.fingers {
                let wrist = mirror(at(LeftHand));
                for (finger, roles) in LEFT_FINGERS.iter().enumerate() {
                    let (root, along) = self.finger(wrist, finger);
                    let bones: Vec<_> = roles.iter().map(|&role| (side(role), 0.08 * p.hand)).collect();
                    let points =
                        FINGER_JOINTS.map(|along_finger| mirror(root + along * along_finger * p.hand));
                    body.chain(self, &bones, &points);
                }
            }
        }
    }
}

/// Where a finger's joints and its tip lie, in lengths of the hand.
const FINGER_JOINTS: [f64; 4] = [0.0, 0.4, 0.65, 0.85];

/// A ring of a tube.
#[derive(Clone, Debug)]
pub struct Ring {
    pub centre: DVec3,
    pub radius: f64,
    pub weights: Vec<(Role, f64)>,
}

/// A mesh in the making; also of use alone, as a tube around a bone.
#[derive(Clone, Debug)]
pub struct Shape {
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    pub weights: Vec<Vec<(Role, f64)>>,
    /// Columns of the tubes that come next, a multiple of 12.
    pub columns: usize,
}

impl Default for Shape {
    fn default() -> Self {
        Self { positions: Vec::new(), triangles: Vec::new(), weights: Vec::new(), columns: COLUMNS }
    }
}

impl Shape {
    /// A closed tube of `radius` around the segment from `a` to `b`, with round ends beyond it.
    pub fn capsule(a: DVec3, b: DVec3, radius: f64) -> Self {
        let mut shape = Self::default();
        let rings = rings(&[(Role::Hips, radius)], &[a, b], radius, shape.columns);
        shape.tube((b - a).normalize(), &rings, true);
        shape
    }

    /// Bones in a row: one tube for each, or one for all.
    fn chain(&mut self, person: &Person, bones: &[(Role, f64)], points: &[DVec3]) {
        let along = (points[1] - points[0]).normalize();
        let end = |bone: usize| (END * points[bone].distance(points[bone + 1])).min(LONGEST_END);
        if person.blended {
            self.tube(along, &rings(bones, points, end(0), self.columns), !person.holes);
        } else {
            for bone in 0..bones.len() {
                let rings = rings(&bones[bone..=bone], &points[bone..=bone + 1], end(bone), self.columns);
                self.tube(along, &rings, !person.holes);
            }
        }
    }

    /// Rings joined to a tube, from the first to the last along `along`; poles close it where the end rings have no
    /// radius, and `closed` is false to leave round ends away.
    pub fn tube(&mut self, along: DVec3, rings: &[Ring], closed: bool) {
        // Begins where the measuring ring begins (the world axis least parallel to the bone, crossed with it).
        let least = along.abs().min_element();
        let axis = DVec3::AXES.into_iter().find(|axis| axis.dot(along).abs() <= least + 1e-9).unwrap();
        let start = axis.cross(along).normalize();
        let side = along.cross(start);
        let columns = self.columns;
        let widest = rings.iter().map(|ring| ring.radius).fold(0.0, f64::max);
        let kept: Vec<&Ring> = rings.iter().filter(|ring| closed || ring.radius > 0.5 * widest).collect();
        let mut before: Option<Vec<u32>> = None;
        for ring in kept {
            let count = if ring.radius > 0.0 { columns } else { 1 };
            let first = self.positions.len() as u32;
            for column in 0..count {
                let (sin, cos) = (TAU * column as f64 / columns as f64).sin_cos();
                self.positions.push(ring.centre + ring.radius * (cos * start + sin * side));
                self.weights.push(ring.weights.clone());
            }
            let now: Vec<u32> = (0..columns).map(|column| first + (column % count) as u32).collect();
            if let Some(before) = before {
                for column in 0..columns {
                    let next = (column + 1) % columns;
                    let [a, b, c, d] = [before[column], before[next], now[column], now[next]];
                    // Quads are split the other way on the other side: smoothing along edges sees the diagonals.
                    let middle: f64 = [a, b, c, d].iter().map(|&v| self.positions[v as usize].x).sum();
                    let faces = if middle < 0.0 { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] };
                    self.triangles.extend(faces.into_iter().filter(|[a, b, c]| a != b && b != c && c != a));
                }
            }
            before = Some(now);
        }
    }

    /// A closed ellipsoid weighted to `role`.
    pub fn ellipsoid(&mut self, centre: DVec3, half: DVec3, role: Role) {
        let first = self.positions.len();
        let count = self.columns / 3;
        let angles = (0..=count).map(|ring| FRAC_PI_2 * (2.0 * ring as f64 / count as f64 - 1.0));
        let rings = angles.map(|angle| Ring {
            centre: DVec3::Y * angle.sin(),
            radius: if angle.abs() > 1.57 { 0.0 } else { angle.cos() },
            weights: vec![(role, 1.0)],
        });
        self.tube(DVec3::Y, &rings.collect::<Vec<_>>(), true);
        for p in &mut self.positions[first..] {
            *p = centre + *p * half;
        }
    }

    /// The head: an ellipsoid above its middle, blunt below it so that the chin is a step, with a nose.
    fn head(&mut self, person: &Person) {
        let p = &person.proportions;
        let first = self.positions.len();
        let count = self.columns * 5 / 6;
        let rings = (0..=count).map(|ring| 2.0 * ring as f64 / count as f64 - 1.0).map(|fraction| {
            // Rings crowd at the ends.
            let height = (FRAC_PI_2 * fraction).sin();
            let power = if height < 0.0 { 6.0 } else { 2.0 };
            Ring {
                centre: DVec3::Y * (person.chin() + 0.5 * p.head * (1.0 + height)),
                radius: if fraction.abs() == 1.0 {
                    0.0
                } else {
                    p.head_half_width * (1.0 - height.abs().powf(power)).powf(1.0 / power)
                },
                weights: vec![(Role::Head, 1.0)],
            }
        });
        self.tube(DVec3::Y, &rings.collect::<Vec<_>>(), true);
        let nose = DVec3::new(0.0, person.chin() + 0.35 * p.head, p.head_half_width);
        for q in &mut self.positions[first..] {
            let near = (*q - nose).length() / (0.3 * p.head_half_width);
            if q.z > 0.0 {
                q.z += 0.25 * p.head_half_width * (-near * near).exp();
            }
        }
    }

    /// Unit normals: means over the triangles, weighted by their areas.
    pub fn normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.positions.len()];
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|vertex| self.positions[vertex as usize]);
            for &vertex in corners {
                normals[vertex as usize] += (b - a).cross(c - a);
            }
        }
        normals.into_iter().map(|n| n.normalize_or(DVec3::Y)).collect()
    }
}

/// The rings of bones in a row, with ends of height `end` rounded off beyond the first and the last point.
fn rings(bones: &[(Role, f64)], points: &[DVec3], end: f64, columns: usize) -> Vec<Ring> {
    let (steps, cap_steps) = (columns / 3, columns / 8);
    let along = (points[points.len() - 1] - points[0]).normalize();
    let mut rings = Vec::new();
    let cap = |rings: &mut Vec<Ring>, at: DVec3, (role, radius): (Role, f64), outward: f64| {
        for step in 0..cap_steps {
            let step = if outward < 0.0 { step } else { cap_steps - 1 - step };
            let (sin, cos) = (FRAC_PI_2 * step as f64 / cap_steps as f64).sin_cos();
            rings.push(Ring {
                centre: at + outward * end * cos * along,
                radius: radius * sin,
                weights: vec![(role, 1.0)],
            });
        }
    };
    cap(&mut rings, points[0], bones[0], -1.0);
    for (bone, &(role, radius)) in bones.iter().enumerate() {
        let last = bone + 1 == bones.len();
        for step in 0..steps + usize::from(last) {
            let t = step as f64 / steps as f64;
            // Half of the neighbour's at the joint, none of it a fifth of the bone away.
            let before = (bone > 0 && t < 0.2).then(|| (bones[bone - 1], 0.5 - 2.5 * t));
            let after = (!last && t > 0.8).then(|| (bones[bone + 1], 2.5 * t - 2.0));
            let mut ring =
                Ring { centre: points[bone].lerp(points[bone + 1], t), radius, weights: vec![(role, 1.0)] };
            if let Some(((other, other_radius), share)) = before.or(after)
                && share > 0.0
            {
                ring.radius = (1.0 - share) * radius + share * other_radius;
                ring.weights = vec![(role, 1.0 - share), (other, share)];
            }
            rings.push(ring);
        }
    }
    cap(&mut rings, points[points.len() - 1], bones[bones.len() - 1], 1.0);
    rings
}
