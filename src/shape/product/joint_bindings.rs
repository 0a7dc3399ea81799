//! How joints without a role of their own are attached: as the mesh that they move (product mode).

use super::binding::PartBinding;
use super::part::{PART_COUNT, Part};
use super::pieces::Attachment;
use crate::character::{Character, Role};
use crate::face::stage::FaceBinding;
use crate::geometry::{foot, marked};
use crate::shape::figure::Figure;
use std::collections::BTreeMap;

/// Vertices this near to a joint count alike, as a share of H; further ones count with the fourth power of how much further.
/// D26: a joint bends the mesh where it stands, and a chain's joint moves all the cloth down to the next.
const NEAR: f64 = 0.01;

/// A piece's share beyond this is all, and below what is left of 1 none.
const WHOLE: f32 = 0.999;

/// Each vertex that has weights, and the joints that move it.
pub fn weight_rows<'a>(
    character: &'a Character,
    figure: &'a Figure,
) -> impl Iterator<Item = (usize, &'a [(u32, f32)])> {
    let meshes = character.meshes.iter().zip(&figure.mesh_starts);
    meshes.flat_map(|(mesh, &start)| (start..).zip(mesh.weights.rows()))
}

/// How much `vertex` counts for `joint`: 1 where that stands, the less the further away, and within `near` nearly alike.
pub fn nearness(figure: &Figure, vertex: usize, joint: usize, near: f64) -> f64 {
    let away = figure.positions[vertex].distance_squared(figure.joints[joint]) + near * near;
    (near * near / away).powi(2)
}

/// For each joint the mean binding of the vertices that it moves, the nearest first; none for joints that play a role, hang
/// from the head, or move nothing.
///
/// A joint that moves nothing and hangs from one with a mean takes that: the end of a chain stays with its chain.
///
/// O(influences).
pub fn mean_bindings(
    character: &Character,
    figure: &Figure,
    vertices: &[PartBinding],
) -> Vec<Option<PartBinding>> {
    let mut means: Vec<Mean> = figure.joints.iter().map(|_| Mean::default()).collect();
    let own_role = marked(figure.joints.len(), figure.humanoid.iter().map(|(_, joint)| joint));
    let near = NEAR * figure.height();
    for (vertex, row) in weight_rows(character, figure) {
        for &(joint, weight) in row {
            let joint = joint as usize;
            if !own_role[joint] && weight > 0.0 {
                let nearness = nearness(figure, vertex, joint, near);
                means[joint].add(&vertices[vertex], f64::from(weight) * nearness);
            }
        }
    }
    let mut found: Vec<Option<PartBinding>> = vec![None; means.len()];
    let is_loose =
        |&joint: &usize| !own_role[joint] && figure.joint_roles[joint].is_some_and(|role| role != Role::Head);
    for joint in character.skeleton.parents_first().into_iter().filter(is_loose) {
        found[joint] = means[joint].binding().or_else(|| found[character.skeleton.joints[joint].parent?]);
    }
    found
}

/// The role whose bone, of an arm or a leg, a joint stands on: its own, or that of a twist bone on the way to the next.
pub fn limb_bone(figure: &Figure, joint: usize) -> Option<Role> {
    use Role::*;
    let role = figure.joint_roles[joint]?;
    let next = match role {
        LeftUpperArm => LeftLowerArm,
        RightUpperArm => RightLowerArm,
        LeftLowerArm | LeftHand => LeftHand,
        RightLowerArm | RightHand => RightHand,
        LeftUpperLeg => LeftLowerLeg,
        RightUpperLeg => RightLowerLeg,
        LeftLowerLeg | LeftFoot => LeftFoot,
        RightLowerLeg | RightFoot => RightFoot,
        _ => return None,
    };
    let is_on_bone = figure.humanoid.joint(role) == Some(joint) || {
        let (p, from, to) = (figure.joints[joint], figure.role_position(role)?, figure.role_position(next)?);
        let (nearest, t) = foot(p, from, to);
        (0.0..=1.0).contains(&t) && p.distance(nearest) < NEAR * figure.height()
    };
    is_on_bone.then_some(role)
}

/// The binding of a joint that stands on the bones of an arm: it follows these, so that the arm keeps its angles and a twist bone
/// its share of the way.
pub fn arm_binding(figure: &Figure, joint: usize) -> Option<PartBinding> {
    let part = Part::of(limb_bone(figure, joint)?);
    (part < Part::LeftUpperLeg)
        .then(|| PartBinding { attachment: Attachment::OnBone, ..PartBinding::to(part) })
}

/// A weighted mean in the making.
#[derive(Clone, Debug, Default)]
struct Mean {
    parts: [f64; PART_COUNT],
    /// The weight of what is of each finger.
    digits: [f64; 5],
    /// The weight of what goes with each piece.
    pieces: BTreeMap<usize, f64>,
    /// The weight of what is a skirt.
    skirt: f64,
    total: f64,
}

impl Mean {
    fn add(&mut self, binding: &PartBinding, weight: f64) {
        let (piece, share) = match binding.attachment {
            // What takes the face map as a whole says nothing of the body.
            Attachment::OnFace(_) => return,
            Attachment::Plain | Attachment::OnBone | Attachment::Digits(_) => (None, 0.0),
            Attachment::Piece(piece) => (Some(piece), 1.0),
            Attachment::Strand { piece, share } => (Some(piece), share),
        };
        for (sum, &part) in self.parts.iter_mut().zip(&binding.weights) {
            *sum += weight * f64::from(part);
        }
        if let Attachment::Digits(shares) = binding.attachment {
            self.digits.iter_mut().zip(shares).for_each(|(sum, of)| *sum += weight * f64::from(of));
        }
        if let Some(piece) = piece {
            *self.pieces.entry(piece).or_default() += weight * f64::from(share);
        }
        if binding.is_skirt {
            self.skirt += weight;
        }
        self.total += weight;
    }

    fn binding(&self) -> Option<PartBinding> {
        if !(self.total > 0.0 && self.total.is_finite()) {
            return None;
        }
        let weights = self.parts.map(|sum| (sum / self.total) as f32);
        // A joint goes with one piece: the one that most of its mesh goes with.
        let most = self.pieces.iter().max_by(|one, other| one.1.total_cmp(other.1));
        let attachment = match most.map(|(&piece, &sum)| (piece, (sum / self.total) as f32)) {
            Some((piece, share)) if share > WHOLE => Attachment::Piece(piece),
            Some((piece, share)) if share > 1.0 - WHOLE => Attachment::Strand { piece, share },
            _ if self.digits == [0.0; 5] => Attachment::Plain,
            _ => Attachment::Digits(self.digits.map(|sum| (sum / self.total) as f32)),
        };
        let is_skirt = 2.0 * self.skirt > self.total;
        Some(PartBinding { weights, attachment, face: FaceBinding::None, is_skirt })
    }
}
