//! A character laid out for measuring: one space, one list of vertices, weights folded into humanoid roles.
//!
//! All stages work in a canonical frame: x towards the character's left, y up, z the way the face looks, in the
//! units of the model. Extra joints (hair, skirts, twist helpers) fold into their nearest humanoid ancestor;
//! that is for the deformation only, the animation weights of the character are not touched.

use crate::character::mesh_list::MeshList;
use crate::character::{Character, Frame, Humanoid, MeshKind, Role};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::{marked, range, triangles_where};
use glam::DVec3;
use std::collections::HashMap;

/// A character in the canonical frame, its meshes in one list.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Model space to the canonical frame.
    pub frame: Frame,
    /// Rest positions of all meshes' vertices, one mesh after the other.
    pub positions: Vec<DVec3>,
    /// Triangles of all meshes, as indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// Where each mesh's vertices start; one more than there are meshes.
    pub mesh_starts: Vec<usize>,
    /// What each vertex belongs to.
    pub kinds: Vec<MeshKind>,
    /// Rest positions of all joints.
    pub joints: Vec<DVec3>,
    /// Which joint plays which role.
    pub humanoid: Humanoid,
    /// The role each joint folds into: its own, else its nearest ancestor's; `None` for joints outside the humanoid.
    pub joint_roles: Vec<Option<Role>>,
    /// Each vertex's weights by role; they sum to 1.
    pub role_weights: Vec<Vec<(Role, f64)>>,
    /// Each vertex's weight to joints that play no role themselves (hair, skirts, helpers).
    pub extra_weight: Vec<f64>,
    /// The joint of each vertex's largest weight.
    pub main_joint: Vec<Option<u32>>,
    /// That weight.
    pub main_weight: Vec<f64>,
    /// Lowest and highest point of all meshes along up.
    pub extent: (f64, f64),
}

impl Figure {
    /// Lays `character` out.
    ///
    /// A vertex without weights takes those of the hips.
    ///
    /// # Errors
    /// `ErrorKind::NoHumanoid` where required roles are missing, `ErrorKind::NoGeometry` where nothing has an extent
    /// along up.
    pub fn of(character: &Character) -> Result<Self> {
        character.validate()?;
        let humanoid = character.humanoid.clone();
        if let Some(role) = humanoid.missing().first() {
            let message = format!("no joint has the role {role}: name one, or make a rig");
            return Err(Error::new(ErrorKind::NoHumanoid, message).about("humanoid"));
        }
        let frame = Frame::of(character)?;
        let MeshList { positions, triangles, mesh_starts, .. } =
            MeshList::of(character, |p| frame.to_canonical(p));
        let extent = extent(&positions);
        if triangles.is_empty() || extent.1 <= extent.0 {
            return Err(MeshList::no_extent());
        }
        let mut kinds = Vec::with_capacity(positions.len());
        for (mesh, &end) in character.meshes.iter().zip(&mesh_starts[1..]) {
            kinds.resize(end, mesh.kind.unwrap_or_default());
        }
        let joints: Vec<DVec3> =
            character.skeleton.joints.iter().map(|joint| frame.to_canonical(joint.position())).collect();
        let joint_roles = fold_joints(character);
        let (role_weights, extra_weight, main) = fold_weights(character, &joint_roles);
        for (kind, weights) in kinds.iter_mut().zip(&role_weights) {
            *kind = kind.of_vertex(share_of(weights, Role::is_head), share_of(weights, Role::is_limb));
        }
        copy_kinds_of_drawn(&mut kinds, &positions, &triangles);
        Ok(Self {
            frame,
            positions,
            triangles,
            mesh_starts,
            kinds,
            joints,
            humanoid,
            joint_roles,
            role_weights,
            extra_weight,
            main_joint: main.iter().map(|main| main.map(|(joint, _)| joint)).collect(),
            main_weight: main.iter().map(|main| main.map_or(0.0, |(_, weight)| weight)).collect(),
            extent,
        })
    }

    /// Extent along up, all meshes: H.
    pub fn height(&self) -> f64 {
        self.extent.1 - self.extent.0
    }

    /// Where the joint of `role` is.
    pub fn role_position(&self, role: Role) -> Option<DVec3> {
        self.humanoid.joint(role).map(|joint| self.joints[joint])
    }

    /// The roles of the eyes towards +x and -x: in left-handed axes the left eye is the second.
    pub fn eye_roles(&self) -> [Role; 2] {
        let x = |role: Role| self.role_position(role).map(|p| p.x);
        let is_mirrored = x(Role::LeftEye).zip(x(Role::RightEye)).is_some_and(|(left, right)| left < right);
        if is_mirrored { [Role::RightEye, Role::LeftEye] } else { [Role::LeftEye, Role::RightEye] }
    }

    /// What `vertex` belongs to.
    pub fn kind(&self, vertex: usize) -> MeshKind {
        self.kinds[vertex]
    }

    /// [`MeshKind::is_carried`] of what `vertex` belongs to.
    pub fn is_carried(&self, vertex: usize) -> bool {
        self.kind(vertex).is_carried()
    }

    /// The part of a vertex's weight that `choose` accepts, 0 to 1.
    pub fn weight_of(&self, vertex: usize, choose: impl Fn(Role) -> bool) -> f64 {
        share_of(&self.role_weights[vertex], choose)
    }

    /// Triangles all of whose corners `choose` accepts.
    pub fn triangles_where(&self, choose: impl Fn(usize) -> bool) -> Vec<[u32; 3]> {
        let chosen: Vec<bool> = (0..self.positions.len()).map(choose).collect();
        triangles_where(&self.triangles, |vertex| chosen[vertex])
    }
}

/// The sum of those of a vertex's `weights` whose roles `choose` accepts.
pub fn share_of(weights: &[(Role, f64)], choose: impl Fn(Role) -> bool) -> f64 {
    weights.iter().filter(|&&(role, _)| choose(role)).map(|&(_, weight)| weight).sum()
}

/// Meshes may share their arrays, each with triangles of its own: then each has copies of what another one draws. Such
/// copies are what is drawn at their place, or a bag would hold together with the whole body.
fn copy_kinds_of_drawn(kinds: &mut [MeshKind], positions: &[DVec3], triangles: &[[u32; 3]]) {
    let is_drawn = marked(positions.len(), triangles.iter().flatten().map(|&vertex| vertex as usize));
    if is_drawn.iter().all(|&is_drawn| is_drawn) {
        return;
    }
    let place = |vertex: usize| positions[vertex].to_array().map(f64::to_bits);
    let drawn: HashMap<[u64; 3], MeshKind> = (0..positions.len())
        .rev() // the first one stays
        .filter(|&vertex| is_drawn[vertex])
        .map(|vertex| (place(vertex), kinds[vertex]))
        .collect();
    for vertex in (0..positions.len()).filter(|&vertex| !is_drawn[vertex]) {
        kinds[vertex] = drawn.get(&place(vertex)).copied().unwrap_or_default();
    }
}

/// Lowest and highest point of `positions` along up; (infinity, -infinity) for none.
pub fn extent(positions: &[DVec3]) -> (f64, f64) {
    range(positions.iter().map(|p| p.y))
}

/// For every joint the role it folds into.
fn fold_joints(character: &Character) -> Vec<Option<Role>> {
    let mut folded = vec![None; character.skeleton.joints.len()];
    // Where one joint plays two roles, the one nearer to the hips moves it.
    for (role, joint) in character.humanoid.iter() {
        folded[joint].get_or_insert(role);
    }
    for joint in character.skeleton.parents_first() {
        if folded[joint].is_none() {
            folded[joint] = character.skeleton.joints[joint].parent.and_then(|parent| folded[parent]);
        }
    }
    folded
}

/// Weights up to this part of a vertex's sum are what the rounding of weights to bytes leaves behind: a head that
/// should move as one would stick to the neck by them. D11.
const WEIGHT_DUST: f64 = 1.5 / 255.0;

type FoldedWeights = (Vec<Vec<(Role, f64)>>, Vec<f64>, Vec<Option<(u32, f64)>>);

/// Each vertex's weights by role, its weight to joints without a role of their own, and its main joint with
/// that joint's weight.
fn fold_weights(character: &Character, joint_roles: &[Option<Role>]) -> FoldedWeights {
    let mut role_weights = Vec::with_capacity(character.vertex_count());
    let mut extra_weight = Vec::with_capacity(character.vertex_count());
    let mut main = Vec::with_capacity(character.vertex_count());
    let has_role = marked(joint_roles.len(), character.humanoid.iter().map(|(_, joint)| joint));
    for mesh in &character.meshes {
        for vertex in 0..mesh.positions.len() {
            let row = if mesh.weights.is_empty() { &[][..] } else { mesh.weights.row(vertex) };
            let all: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
            let row: Vec<(u32, f32)> =
                row.iter().copied().filter(|&(_, weight)| f64::from(weight) > WEIGHT_DUST * all).collect();
            let total: f64 = row.iter().map(|&(_, weight)| f64::from(weight)).sum();
            let mut folded: Vec<(Role, f64)> = Vec::with_capacity(row.len());
            let mut extra = 0.0;
            if total > 0.0 {
                for &(joint, weight) in &row {
                    let weight = f64::from(weight) / total;
                    let role = joint_roles[joint as usize].unwrap_or(Role::Hips);
                    match folded.iter_mut().find(|(known, _)| *known == role) {
                        Some((_, sum)) => *sum += weight,
                        None => folded.push((role, weight)),
                    }
                    if !has_role[joint as usize] {
                        extra += weight;
                    }
                }
            } else {
                folded.push((Role::Hips, 1.0));
            }
            role_weights.push(folded);
            extra_weight.push(extra);
            main.push(
                row.iter()
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .map(|&(joint, weight)| (joint, f64::from(weight) / total.max(f64::MIN_POSITIVE))),
            );
        }
    }
    (role_weights, extra_weight, main)
}
