//! The paper's field: the mesh follows the shortened bones, then its thickness is adjusted (§V-B2, Eqs. 5-8).

use crate::character::Role;
use crate::character::bones::{Bone, Group};
use crate::geometry::{Mapped, foot, outer};
use crate::options::Stage;
use crate::shape::{Coefficient, Shortened};
use glam::{DMat3, DVec3};
use std::collections::BTreeMap;

/// A bone before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldBone {
    /// The joint whose weights move the bone: the one at its beginning.
    pub joint: Role,
    /// p_parent.
    pub parent: DVec3,
    /// p_child; equal to `parent` for the bone of a joint at which the skeleton ends.
    pub child: DVec3,
    /// p'_parent.
    pub new_parent: DVec3,
    /// p'_child.
    pub new_child: DVec3,
    /// beta of the bone's group.
    pub thickness_scale: f64,
}

/// Eqs. 5 and 8, for any point and its weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoneField {
    /// The bones that weights speak of.
    pub bones: Vec<FieldBone>,
}

impl BoneField {
    /// The field of a shortened skeleton.
    ///
    /// - `joints`, `head_top`: the rest pose; `shortened`: what [`shorten`](super::shorten()) made of it.
    /// - `coefficients`: by group name.
    ///
    /// A joint from which no bone runs gets a bone of length 0, so that it has something to move.
    pub fn new(
        bones: &[Bone],
        joints: &BTreeMap<Role, DVec3>,
        head_top: DVec3,
        shortened: &Shortened,
        coefficients: &BTreeMap<String, Coefficient>,
    ) -> Self {
        let thickness = |group: &str| coefficients.get(group).map(|coefficient| coefficient.thickness_scale);
        let mut field: Vec<FieldBone> = Vec::with_capacity(bones.len() + joints.len());
        let places = |role: Role| Some((*joints.get(&role)?, *shortened.joints.get(&role)?));
        for bone in bones {
            let ends = bone.child.map_or(Some((head_top, shortened.head_top)), places);
            if let (Some((parent, new_parent)), Some((child, new_child))) = (places(bone.parent), ends) {
                field.push(FieldBone {
                    joint: bone.parent,
                    parent,
                    child,
                    new_parent,
                    new_child,
                    thickness_scale: thickness(&bone.group).unwrap_or(1.0),
                });
            }
        }
        for &joint in shortened.joints.keys() {
            let Some((old, new)) = places(joint) else { continue };
            if field.iter().any(|bone| bone.joint == joint) {
                continue;
            }
            let limb = Group::beginning_at(joint);
            // By the name that the limb's group has here, else as what leads to it.
            let named = bones.iter().find(|bone| bone.kind == limb).map_or(limb.name(), |bone| &bone.group);
            let incoming = bones.iter().find(|bone| bone.child == Some(joint));
            let thickness_scale = thickness(named).or_else(|| thickness(&incoming?.group)).unwrap_or(1.0);
            field.push(FieldBone {
                joint,
                parent: old,
                child: old,
                new_parent: new,
                new_child: new,
                thickness_scale,
            });
        }
        Self { bones: field }
    }

    /// w_ki: weights of bones from weights of joints, for a vertex at `v` in rest pose.
    ///
    /// A joint from which several bones run (hips, chest, hand) splits its weight over them by the inverse square of the
    /// distance; a role without bones hands its weight to the nearest role above that has some.
    pub fn bone_weights(&self, v: DVec3, role_weights: &[(Role, f64)]) -> Vec<(u16, f64)> {
        let mut weights: Vec<(u16, f64)> = Vec::with_capacity(role_weights.len() + 2);
        for &(role, weight) in role_weights {
            let of = |role: Role| self.bones.iter().enumerate().filter(move |(_, bone)| bone.joint == role);
            let Some(role) = role.chain().find(|&role| of(role).next().is_some()) else {
                continue;
            };
            let near: Vec<(u16, f64)> = of(role)
                .map(|(index, bone)| (index as u16, foot(v, bone.parent, bone.child).0.distance_squared(v)))
                .collect();
            let least = near.iter().map(|&(_, distance)| distance).fold(f64::INFINITY, f64::min);
            // Relative to the least distance, so that a vertex on a bone divides 0 by 0 nowhere.
            let share = |distance: f64| if distance == least { 1.0 } else { least / distance };
            let total: f64 = near.iter().map(|&(_, distance)| share(distance)).sum();
            let parts = near.iter().map(|&(bone, distance)| (bone, weight * share(distance) / total));
            for (bone, part) in parts.filter(|&(_, part)| part > 0.0) {
                match weights.iter_mut().find(|(other, _)| *other == bone) {
                    Some((_, sum)) => *sum += part,
                    None => weights.push((bone, part)),
                }
            }
        }
        weights
    }

    /// Where the field takes a point `v` of the rest pose, at the bone weights `weights`.
    ///
    /// Paper: Eq. 5, then Eq. 8 on what it gives, with the deformed bones (Fig. 6 b, then c). `Stage::Length` stops after
    /// Eq. 5.
    pub fn displace(&self, v: DVec3, weights: &[(u16, f64)], stage: Stage) -> DVec3 {
        let v = self.follow(v, weights);
        if stage == Stage::Length {
            return v;
        }
        // Eq. 8.
        let mut sum = DVec3::ZERO;
        for (bone, weight) in self.weighted(weights) {
            let (foot, _) = foot(v, bone.new_parent, bone.new_child);
            sum += weight * (1.0 - bone.thickness_scale) * (foot - v);
        }
        v + sum
    }

    /// The Jacobian of [`displace`](Self::displace) at fixed weights.
    pub fn jacobian(&self, v: DVec3, weights: &[(u16, f64)], stage: Stage) -> DMat3 {
        let mut follow = DMat3::IDENTITY;
        for (bone, weight) in self.weighted(weights) {
            let along = bone.child - bone.parent;
            let stretch = (bone.new_child - bone.new_parent) - along;
            if is_beside(v, bone.parent, bone.child) {
                follow += outer(weight * stretch, along / along.length_squared());
            }
        }
        if stage == Stage::Length {
            return follow;
        }
        let v = self.follow(v, weights);
        let mut thicken = DMat3::IDENTITY;
        for (bone, weight) in self.weighted(weights) {
            let mut toward = -DMat3::IDENTITY;
            if is_beside(v, bone.new_parent, bone.new_child) {
                let along = (bone.new_child - bone.new_parent).normalize();
                toward += outer(along, along);
            }
            thicken += weight * (1.0 - bone.thickness_scale) * toward;
        }
        thicken * follow
    }

    /// Eq. 5.
    fn follow(&self, v: DVec3, weights: &[(u16, f64)]) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (bone, weight) in self.weighted(weights) {
            let (toward_parent, toward_child) = shares(v, bone.parent, bone.child);
            sum += weight
                * (toward_parent * (bone.new_parent - bone.parent)
                    + toward_child * (bone.new_child - bone.child));
        }
        v + sum
    }

    fn weighted<'a>(&'a self, weights: &'a [(u16, f64)]) -> impl Iterator<Item = (&'a FieldBone, f64)> {
        weights.iter().map(|&(bone, weight)| (&self.bones[bone as usize], weight))
    }
}

/// How a point is attached to the paper's bones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoneBinding {
    /// w_ki by bone of the field.
    pub weights: Vec<(u16, f64)>,
    /// The weight of the head, by which the face map acts.
    pub head: f64,
    /// For hats and glasses: the point of the rest pose whose face map moves the whole piece.
    pub on_face: Option<DVec3>,
}

/// The paper's field as far as a stage, and its face.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperField {
    /// Eqs. 5 and 8.
    pub bones: BoneField,
    /// How far to go.
    pub stage: Stage,
}

impl PaperField {
    /// Where `p` goes.
    pub fn place(&self, p: DVec3, binding: &BoneBinding) -> DVec3 {
        self.bones.displace(p, &binding.weights, self.stage)
    }

    /// Where `p` goes, and the Jacobian there at fixed weights.
    pub fn map(&self, p: DVec3, binding: &BoneBinding) -> Mapped {
        let jacobian = self.bones.jacobian(p, &binding.weights, self.stage);
        Mapped { position: self.place(p, binding), jacobian }
    }
}

/// lambda and mu: how much a vertex at `v` follows the parent and the child joint of a bone (Eqs. 6, 7).
///
/// The foot is on the segment, clamped, so that the two add up to 1 and a vertex beyond a joint follows that joint alone;
/// a bone of length 0 has all at its parent.
pub fn shares(v: DVec3, parent: DVec3, child: DVec3) -> (f64, f64) {
    let (_, t) = foot(v, parent, child);
    (1.0 - t, t)
}

/// True where the foot of `v` lies between the ends.
fn is_beside(v: DVec3, parent: DVec3, child: DVec3) -> bool {
    let (_, t) = foot(v, parent, child);
    t > 0.0 && t < 1.0
}
