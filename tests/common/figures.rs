//! People of round limbs with random proportions, poses and things worn, whose joints are known from construction.
//!
//! A figure is 1 high from its soles to the crown of its bare head, stands on y = 0 and looks along z, its left at +x.
//! Proportions follow Winter (Biomechanics and Motor Control of Human Movement, table 4.1: thigh and shank .245 and
//! .246 H, upper arm, forearm and hand .186, .146 and .108 H, joints of the shoulders .259 H apart), the head by the
//! count of heads, all else in what is left below it.
#![allow(dead_code)]

use super::solid::{Solid, surface};
use glam::{DMat3, DVec3, Vec3};
use std::collections::BTreeMap;
use superdeform::Role::{self, *};
use superdeform::{Character, Mesh, MeshKind};

/// Numbers that a seed decides (Steele, Lea and Flood, Fast splittable pseudorandom number generators, 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5DEE_CE66_D1CE_4E5B)
    }

    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }
}

/// How a figure holds itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pose {
    /// Arms so many degrees under the horizontal.
    Arms(f64),
    /// Arms held forward, so many degrees from the side.
    Forward(f64),
    /// The left arm so many degrees over the horizontal.
    OneUp(f64),
}

/// Something that a figure wears or holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Thing {
    LongHair,
    Buns,
    Pigtails,
    Ponytail,
    Hat,
    Brim,
    Tail,
    Skirt,
    Cape,
    Sword,
}

pub const THINGS: [Thing; 10] = [
    Thing::LongHair,
    Thing::Buns,
    Thing::Pigtails,
    Thing::Ponytail,
    Thing::Hat,
    Thing::Brim,
    Thing::Tail,
    Thing::Skirt,
    Thing::Cape,
    Thing::Sword,
];

/// A closed piece of a figure, given by how far a point is outside of it.
#[derive(Clone, Debug)]
pub enum Piece {
    /// A limb between two balls.
    Limb(DVec3, f64, DVec3, f64),
    /// An ellipsoid: middle, half axes, and how it is turned.
    Ball(DVec3, DVec3, DMat3),
    /// A cone of cloth: heights and radii of its lower and its upper rim.
    Cone([f64; 2], [f64; 2], DVec3),
}

impl Piece {
    /// About how far `p` is outside, below 0 within.
    pub fn outside(&self, p: DVec3) -> f64 {
        match self {
            Piece::Limb(a, one, b, other) => {
                let along = *b - *a;
                let t = ((p - *a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
                p.distance(a.lerp(*b, t)) - (one + t * (other - one))
            }
            Piece::Ball(middle, half, turn) => {
                let q = turn.transpose() * (p - *middle);
                let k = (q / *half).length();
                let gradient = (q / (*half * *half)).length();
                if gradient < 1e-9 { -half.min_element() } else { k * (k - 1.0) / gradient }
            }
            Piece::Cone(heights, radii, middle) => {
                let t = ((p.y - heights[0]) / (heights[1] - heights[0])).clamp(0.0, 1.0);
                let radius = radii[0] + t * (radii[1] - radii[0]);
                let around = (p - *middle).with_y(0.0).length() - radius;
                around.max(heights[0] - p.y).max(p.y - heights[1])
            }
        }
    }

    pub fn bounds(&self) -> (DVec3, DVec3) {
        match self {
            Piece::Limb(a, one, b, other) => ((*a - *one).min(*b - *other), (*a + *one).max(*b + *other)),
            Piece::Ball(middle, half, _) => {
                let reach = DVec3::splat(half.max_element());
                (*middle - reach, *middle + reach)
            }
            Piece::Cone(heights, radii, middle) => {
                let radius = radii[0].max(radii[1]);
                ((*middle - radius).with_y(heights[0]), (*middle + radius).with_y(heights[1]))
            }
        }
    }
}

/// A figure to be built.
#[derive(Clone, Debug)]
pub struct Figure {
    pub name: String,
    pub joints: BTreeMap<Role, DVec3>,
    pub pieces: Vec<Piece>,
    pub pose: Pose,
    pub things: Vec<Thing>,
    /// Where the pieces of each thing begin; those of the body come first.
    pub worn: Vec<usize>,
    pub heads: f64,
    /// Depth and wavelength of the waves on its surface.
    pub waves: (f64, f64),
}

impl Figure {
    /// The figure of a seed: in four of ten an A-pose, in one each an I-pose, arms forward and one arm up; each thing
    /// in one of ten.
    pub fn random(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let draw = random.unit();
        let pose = if draw < 0.7 {
            Pose::Arms(random.within(0.0, 60.0))
        } else if draw < 0.8 {
            Pose::Arms(random.within(75.0, 86.0))
        } else if draw < 0.9 {
            Pose::Forward(random.within(30.0, 80.0))
        } else {
            Pose::OneUp(random.within(20.0, 60.0))
        };
        let things: Vec<Thing> = THINGS.into_iter().filter(|_| random.chance(0.1)).collect();
        Self::new(seed, pose, &things)
    }

    /// The figure of a seed in a pose, with things.
    pub fn new(seed: u64, pose: Pose, things: &[Thing]) -> Self {
        let mut random = Random::new(seed ^ 0xF1_6012E);
        let heads = random.within(2.0, 8.0);
        let head = 1.0 / heads;
        let rest = 1.0 - head;
        let neck = rest * random.within(0.02, 0.06);
        let leg = (rest * random.within(0.42, 0.62)).clamp(0.2, 0.55);
        let torso = rest - neck - leg;
        let arm = (rest * random.within(0.45, 0.58)).clamp(0.25, 0.50);
        let stance = random.within(0.0, 0.2);
        let shoulder_half = rest * random.within(0.11, 0.15);
        let hip_half = rest * random.within(0.05, 0.075);
        let thigh = hip_half * random.within(0.75, 0.98);
        let ankle_radius = thigh * random.within(0.42, 0.62);
        let arm_radius = rest * random.within(0.025, 0.042);
        let wrist_radius = arm_radius * random.within(0.55, 0.75);
        let knee_share = random.within(0.47, 0.53);
        let elbow_share = random.within(0.52, 0.58);
        let hand_share = random.within(0.2, 0.26);
        let waves = (random.within(0.0, 0.01), random.within(0.03, 0.2));
        let uneven = [1.0 + random.within(-0.05, 0.05), 1.0];
        let ankle_height = (leg * random.within(0.08, 0.13)).max(0.02);
        let foot = leg * random.within(0.22, 0.3);

        let hip_y = leg;
        let shoulder_y = leg + torso - 0.12 * torso;
        let chin = 1.0 - head;
        let mut joints = BTreeMap::new();
        let mut pieces = Vec::new();
        let depth = 0.75;
        // Trunk: pelvis, waist, chest.
        let trunk = |y: f64, half: f64, high: f64| {
            Piece::Ball(DVec3::Y * y, DVec3::new(half, high, half * depth), DMat3::IDENTITY)
        };
        let pelvis = hip_half + 0.9 * thigh;
        // The crotch lies below the hip joints, as trochanters (.53 H) lie over it (.48 H).
        let high = (0.19 * leg).max(0.3 * torso);
        pieces.push(trunk(hip_y - 0.07 * leg + high, pelvis, high));
        let waist = 0.85 * pelvis.min(shoulder_half);
        pieces.push(Piece::Limb(
            DVec3::Y * (hip_y + 0.15 * torso),
            waist * depth,
            DVec3::Y * (hip_y + 0.7 * torso),
            waist * depth,
        ));
        pieces.push(trunk(hip_y + 0.35 * torso, waist, 0.35 * torso));
        pieces.push(trunk(hip_y + 0.68 * torso, shoulder_half * 0.95, 0.33 * torso));
        joints.insert(Hips, DVec3::Y * (hip_y + 0.05 * torso));
        joints.insert(Neck, DVec3::Y * (leg + torso));
        joints.insert(Head, DVec3::Y * (chin + 0.06 * head));
        let neck_radius = 0.45 * waist.min(0.4 * head.max(0.12));
        pieces.push(Piece::Limb(
            DVec3::Y * (hip_y + 0.85 * torso),
            1.2 * neck_radius,
            DVec3::Y * (chin + 0.3 * head),
            neck_radius,
        ));
        let head_half =
            DVec3::new(random.within(0.36, 0.5) * head, 0.5 * head, random.within(0.38, 0.5) * head);
        let head_middle = DVec3::new(0.0, chin + 0.5 * head, 0.0);
        pieces.push(Piece::Ball(head_middle, head_half, DMat3::IDENTITY));
        // The jaw, so that the face hangs over the neck in front.
        pieces.push(Piece::Ball(
            head_middle + DVec3::new(0.0, -0.3 * head, 0.3 * head_half.z),
            DVec3::new(0.6 * head_half.x, 0.2 * head, 0.65 * head_half.z),
            DMat3::IDENTITY,
        ));

        for (index, left) in [true, false].into_iter().enumerate() {
            let sign = if left { 1.0 } else { -1.0 };
            let scale = uneven[index];
            let at = |x: f64, y: f64, z: f64| DVec3::new(sign * x, y, z);
            // Leg, slanting outwards; its sole stays on the ground.
            let hip = at(hip_half, hip_y, 0.0);
            let ankle = at(hip_half + 0.5 * stance, ankle_height, 0.0);
            let knee = hip.lerp(ankle, 1.0 - knee_share) + DVec3::Z * 0.01 * leg;
            let knee_radius = 0.5 * (thigh + ankle_radius);
            pieces.push(Piece::Limb(hip, thigh, knee, knee_radius));
            pieces.push(Piece::Limb(knee, knee_radius, ankle, ankle_radius));
            // The foot: from heel to tip, flat on the ground.
            let sole = 0.5 * ankle_height.min(1.2 * ankle_radius);
            pieces.push(Piece::Limb(
                at(ankle.x.abs(), 1.2 * sole, -0.2 * foot),
                1.2 * sole,
                at(ankle.x.abs() + 0.05 * foot, sole, 0.72 * foot),
                sole,
            ));
            pieces.push(Piece::Limb(ankle, ankle_radius, ankle.with_y(sole), ankle_radius.max(sole)));
            joints.insert(sided(LeftUpperLeg, left), hip);
            joints.insert(sided(LeftLowerLeg, left), knee);
            joints.insert(sided(LeftFoot, left), ankle);
            // Arm.
            let way = match pose {
                Pose::Arms(angle) => {
                    let (sin, cos) = angle.to_radians().sin_cos();
                    at(cos, -sin, 0.0)
                }
                Pose::Forward(angle) => {
                    let (sin, cos) = angle.to_radians().sin_cos();
                    at(cos, -0.1, sin).normalize()
                }
                Pose::OneUp(angle) => {
                    let angle = if left { angle } else { -50.0 };
                    let (sin, cos) = angle.to_radians().sin_cos();
                    at(cos, sin, 0.0)
                }
            };
            let shoulder = at(shoulder_half, shoulder_y, 0.0);
            let length = scale * arm;
            let wrist = shoulder + way * length * (1.0 - hand_share);
            let elbow = shoulder.lerp(wrist, elbow_share) - DVec3::Z * 0.01 * arm;
            let elbow_radius = 0.5 * (arm_radius + wrist_radius);
            pieces.push(Piece::Limb(
                at(0.4 * shoulder_half, shoulder_y, 0.0),
                arm_radius,
                shoulder,
                1.1 * arm_radius,
            ));
            pieces.push(Piece::Limb(shoulder, 1.1 * arm_radius, elbow, elbow_radius));
            pieces.push(Piece::Limb(elbow, elbow_radius, wrist, wrist_radius));
            // The hand: flat, palm down or to the body.
            let side = way.cross(DVec3::Z).normalize_or(DVec3::X);
            let front = side.cross(way).normalize_or(DVec3::Z);
            let hand = 0.5 * length * hand_share;
            let palm = (0.55 * hand).max(1.35 * wrist_radius);
            pieces.push(Piece::Ball(
                wrist + way * hand,
                DVec3::new(hand * 1.05, 0.85 * wrist_radius, palm),
                DMat3::from_cols(way, side, front),
            ));
            joints.insert(sided(LeftUpperArm, left), shoulder);
            joints.insert(sided(LeftLowerArm, left), elbow);
            joints.insert(sided(LeftHand, left), wrist);
        }
        let mut figure = Self {
            name: format!("{seed} {heads:.1} heads {pose:.0?} {things:?}"),
            joints,
            pieces,
            pose,
            things: things.to_vec(),
            worn: Vec::new(),
            heads,
            waves,
        };
        let measures = Measures { head, head_half, head_middle, leg, torso, pelvis, shoulder_half, arm };
        for &thing in things {
            figure.worn.push(figure.pieces.len());
            figure.add(thing, &measures, &mut random);
        }
        figure
    }

    fn add(&mut self, thing: Thing, m: &Measures, random: &mut Random) {
        let turn = |degrees: f64| DMat3::from_rotation_x(degrees.to_radians());
        let head = m.head_middle;
        match thing {
            Thing::LongHair => {
                let bottom = m.leg + random.within(-0.3, 0.6) * m.torso;
                let top = head.y + 0.4 * m.head;
                self.pieces.push(Piece::Ball(
                    DVec3::new(0.0, 0.5 * (top + bottom), -0.7 * m.head_half.z),
                    DVec3::new(1.05 * m.head_half.x, 0.5 * (top - bottom), 0.5 * m.head_half.z),
                    DMat3::IDENTITY,
                ));
            }
            Thing::Buns => {
                let size = random.within(0.25, 0.45) * m.head;
                for sign in [-1.0, 1.0] {
                    let off = DVec3::new(sign * (m.head_half.x + 0.6 * size), 0.3 * m.head, 0.0);
                    self.pieces.push(Piece::Ball(head + off, DVec3::splat(size), DMat3::IDENTITY));
                }
            }
            Thing::Pigtails => {
                let long = random.within(0.5, 1.6) * m.head;
                let out = random.within(0.2, 1.0);
                for sign in [-1.0, 1.0] {
                    let from = head + DVec3::new(sign * m.head_half.x, 0.15 * m.head, -0.2 * m.head_half.z);
                    let to = from + long * DVec3::new(sign * out, -1.0, 0.0).normalize();
                    self.pieces.push(Piece::Limb(from, 0.14 * m.head, to, 0.05 * m.head));
                }
            }
            Thing::Ponytail => {
                let from = head + DVec3::new(0.0, 0.3 * m.head, -0.9 * m.head_half.z);
                let to = from + random.within(0.8, 2.0) * m.head * DVec3::new(0.0, -1.0, -0.5).normalize();
                self.pieces.push(Piece::Limb(from, 0.15 * m.head, to, 0.05 * m.head));
            }
            Thing::Hat => {
                let top = head.y + random.within(0.7, 1.2) * m.head;
                let radius = 0.9 * m.head_half.x;
                self.pieces.push(Piece::Cone(
                    [head.y + 0.3 * m.head, top],
                    [radius, 0.8 * radius],
                    DVec3::ZERO,
                ));
            }
            Thing::Brim => {
                let radius = random.within(1.3, 2.2) * m.head_half.x;
                let y = head.y + 0.28 * m.head;
                self.pieces.push(Piece::Cone([y, y + 0.05 * m.head], [radius, 0.9 * radius], DVec3::ZERO));
            }
            Thing::Tail => {
                let from = DVec3::new(0.0, m.leg + 0.15 * m.torso, -0.6 * m.pelvis);
                let aside = random.within(-0.3, 0.3);
                let long = random.within(0.3, 0.8) * m.leg;
                let bend = from + long * DVec3::new(aside, -0.4, -1.0).normalize();
                let to = bend + 0.6 * long * DVec3::new(aside, 0.8, -0.6).normalize();
                self.pieces.push(Piece::Limb(from, 0.3 * m.pelvis, bend, 0.22 * m.pelvis));
                self.pieces.push(Piece::Limb(bend, 0.22 * m.pelvis, to, 0.1 * m.pelvis));
            }
            Thing::Skirt => {
                let bottom = random.within(0.25, 0.75) * m.leg;
                let top = m.leg + 0.4 * m.torso;
                let low = m.pelvis * random.within(1.3, 2.0);
                self.pieces.push(Piece::Cone([bottom, top], [low, 0.9 * m.pelvis], DVec3::ZERO));
            }
            Thing::Cape => {
                let bottom = random.within(0.1, 0.6) * m.leg;
                let top = m.leg + 0.9 * m.torso;
                let wide = m.shoulder_half * random.within(1.0, 1.6);
                self.pieces.push(Piece::Ball(
                    DVec3::new(0.0, 0.5 * (top + bottom), -0.9 * m.shoulder_half),
                    DVec3::new(wide, 0.5 * (top - bottom), 0.012),
                    turn(random.within(0.0, 12.0)),
                ));
            }
            Thing::Sword => {
                let (elbow, wrist) = (self.joints[&LeftLowerArm], self.joints[&LeftHand]);
                let way = (wrist - elbow).normalize();
                let grip = wrist + way * 0.1 * m.arm;
                let draw = random.unit();
                let blade = if draw < 0.5 { DVec3::Z } else { (DVec3::Z - 0.5 * DVec3::Y).normalize() };
                let long = random.within(0.3, 0.7);
                self.pieces.push(Piece::Limb(grip - 0.05 * blade, 0.012, grip + long * blade, 0.006));
            }
        }
    }

    fn outside(&self, p: DVec3) -> f64 {
        outside(&self.pieces, p)
    }

    /// One skin over all pieces, from a grid of `cells` cells a height, waves on it.
    pub fn fused(&self, cells: usize) -> Character {
        let (low, high) = self.bounds();
        let (depth, length) = self.waves;
        let wave = move |p: DVec3| {
            let q = p * (std::f64::consts::TAU / length);
            depth * (q.x + 0.7 * q.y).sin() * (q.y - 0.6 * q.z).sin() * (q.z + 0.3 * q.x).cos()
        };
        let solid = Solid::of_field(low, high, 1.0 / cells as f64, |p| self.outside(p) + wave(p));
        let (positions, triangles) = surface(&solid);
        character(vec![(String::new(), positions, triangles)])
    }

    /// Every piece a closed shell of its own: all in one mesh, or a mesh each.
    pub fn shells(&self, meshes: bool) -> Character {
        let parts: Vec<(String, Vec<DVec3>, Vec<[u32; 3]>)> = (0..self.pieces.len())
            .map(|index| {
                let (positions, triangles) = meshed(&self.pieces[index..=index]);
                (format!("part_{index}"), positions, triangles)
            })
            .collect();
        if meshes {
            return character(parts);
        }
        let (positions, triangles) = meshed(&self.pieces);
        character(vec![(String::new(), positions, triangles)])
    }

    /// As games have people: meshes with names and kinds, the head open under its hair, of every other figure what is below
    /// its shirt left out, of every third each triangle of the body twice, once for either side.
    pub fn dressed(&self) -> Character {
        let mut random = Random::new(self.heads.to_bits());
        let head = 1.0 / self.heads;
        let body = &self.pieces[..self.worn.first().copied().unwrap_or(self.pieces.len())];
        let Some(Piece::Ball(middle, half, _)) = body.iter().find(
            |piece| matches!(piece, Piece::Ball(m, h, _) if m.y > 1.0 - 0.6 * head && h.y > 0.4 * head),
        ) else {
            unreachable!("a figure has a head")
        };
        // Hair: a sheet over the head, off it by so much, down to the brow in front and to the nape behind.
        let off = random.within(1.02, 1.15);
        let is_covered = |p: DVec3| {
            let (up, ahead) = ((p.y - middle.y) / half.y, (p.z - middle.z) / half.z);
            up > 0.3 + 0.8 * ahead.min(0.3)
        };
        let (low, high) = bounds(body);
        let skin = Solid::of_field(low, high, 1.0 / 128.0, |p| outside(body, p));
        let (positions, mut triangles) = surface(&skin);
        let hair = Piece::Ball(*middle, *half * off, DMat3::IDENTITY);
        let ends = random.within(0.25, 0.9);
        // A shirt over the trunk and the upper arms, open at neck, hem and cuffs.
        let (neck, hem) = (self.joints[&Neck].y, self.joints[&Hips].y);
        let sleeve = |p: DVec3, left: bool| {
            let [a, b] = [LeftUpperArm, LeftLowerArm].map(|role| self.joints[&sided(role, left)]);
            let along = (b - a).normalize_or_zero();
            (p - a).dot(along) / (b - a).length()
        };
        let is_shirt = |p: DVec3, ends: f64| {
            let arm = [true, false].map(|left| sleeve(p, left));
            let beside = p.x.abs() > 0.8 * self.joints[&LeftUpperArm].x;
            let way = if p.x > 0.0 { arm[0] } else { arm[1] };
            p.y < neck && (p.y > hem && !beside || beside && (0.0..ends).contains(&way))
        };
        let shirt = Solid::of_field(low - 0.02, high + 0.02, 1.0 / 128.0, |p| outside(body, p) - 0.008);
        let (cloth, mut cloth_triangles) = surface(&shirt);
        let middle_of = |positions: &[DVec3], corners: &[u32; 3]| {
            corners.iter().map(|&vertex| positions[vertex as usize]).sum::<DVec3>() / 3.0
        };
        cloth_triangles.retain(|corners| is_shirt(middle_of(&cloth, corners), ends));
        let (hidden, doubled) = (random.chance(0.5), random.chance(0.33));
        triangles.retain(|corners| {
            let p = middle_of(&positions, corners);
            !(is_covered(p) || hidden && is_shirt(p, ends - 0.15) && p.y > hem + 0.03)
        });
        if doubled {
            triangles.extend(triangles.clone().into_iter().map(|[a, b, c]| [a, c, b]));
        }
        let mut meshes =
            vec![("Body".to_string(), positions, triangles), ("Shirt".to_string(), cloth, cloth_triangles)];
        let (sheet, mut sheet_triangles) = meshed(&[hair]);
        sheet_triangles.retain(|corners| is_covered(middle_of(&sheet, corners)));
        meshes.push(("Hair".to_string(), sheet, sheet_triangles));
        let eyes = [1.0, -1.0].map(|sign| {
            let at = *middle + DVec3::new(0.4 * sign * half.x, 0.0, 0.85 * half.z);
            Piece::Ball(at, DVec3::splat(0.09 * head), DMat3::IDENTITY)
        });
        let (balls, balls_triangles) = meshed(&eyes);
        meshes.push(("Eyes".to_string(), balls, balls_triangles));
        for (index, (&thing, &start)) in self.things.iter().zip(&self.worn).enumerate() {
            let end = self.worn.get(index + 1).copied().unwrap_or(self.pieces.len());
            let (positions, triangles) = meshed(&self.pieces[start..end]);
            meshes.push((format!("{thing:?}"), positions, triangles));
        }
        let mut character = character(meshes);
        for mesh in &mut character.meshes {
            mesh.kind = match mesh.name.as_str() {
                "Hair" | "LongHair" | "Buns" | "Pigtails" | "Ponytail" => Some(MeshKind::Hair),
                "Shirt" | "Skirt" | "Cape" => Some(MeshKind::Garment),
                "Hat" | "Brim" | "Sword" => Some(MeshKind::Accessory),
                "Eyes" => Some(MeshKind::FacePart),
                _ => Some(MeshKind::Body),
            };
        }
        character
    }

    fn bounds(&self) -> (DVec3, DVec3) {
        bounds(&self.pieces)
    }
}

fn bounds(pieces: &[Piece]) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    pieces.iter().map(Piece::bounds).fold(none, |a, b| (a.0.min(b.0), a.1.max(b.1)))
}

fn outside(pieces: &[Piece], p: DVec3) -> f64 {
    pieces.iter().map(|piece| piece.outside(p)).fold(f64::INFINITY, f64::min)
}

/// A closed shell around each piece.
fn meshed(pieces: &[Piece]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for piece in pieces {
        let (low, high) = piece.bounds();
        let cell = ((high - low).max_element() / 24.0).clamp(0.002, 0.02);
        let solid = Solid::of_field(low, high, cell, |p| piece.outside(p));
        let start = positions.len() as u32;
        let (more, faces) = surface(&solid);
        positions.extend(more);
        triangles.extend(faces.into_iter().map(|corners| corners.map(|vertex| vertex + start)));
    }
    (positions, triangles)
}

struct Measures {
    head: f64,
    head_half: DVec3,
    head_middle: DVec3,
    leg: f64,
    torso: f64,
    pelvis: f64,
    shoulder_half: f64,
    arm: f64,
}

/// A character of meshes: name, vertices, triangles.
pub fn character(meshes: Vec<(String, Vec<DVec3>, Vec<[u32; 3]>)>) -> Character {
    let meshes = meshes.into_iter().map(|(name, positions, triangles)| Mesh {
        name,
        positions: positions.iter().map(|p| p.as_vec3()).collect::<Vec<Vec3>>(),
        triangles,
        ..Mesh::default()
    });
    Character { meshes: meshes.collect(), ..Character::default() }
}

/// A left role, or its image.
fn sided(role: Role, left: bool) -> Role {
    if left { role } else { role.mirrored() }
}
