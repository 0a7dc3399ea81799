//! §IV-B in order: facing, kinds, joints, weights of the body, weights of what it wears.

use super::rig_weights::{Binder, BodyRule};
use crate::character::{Character, Humanoid, Joint, MeshKind, Role, Skeleton, Weights};
use crate::clock::Moment;
use crate::error::{Result, Warning};
use crate::geometry::marked;
use crate::progress::Progress;
use crate::report::{JointCandidate, RigReport, by_name};
use crate::rig::candidates::Place;
use crate::rig::eyeballs::find_eyes;
use crate::rig::mesh_kinds::refine_kinds;
use crate::rig::placed::Placed;
use crate::rig::weight_bones::{skeleton_of, weight_bones};
use crate::rig::{FoundJoint, RigOptions, WeightMethod};
use glam::DVec3;
use std::collections::BTreeMap;

/// c of the heat equation for the weights that animate: sharper than those that deform (D23).
const SKIN_HEAT: f64 = 3.0;

/// Of the same, what is less than this share of a vertex's largest is none, and the rest is lowered by it (D23).
const SKIN_TAIL: f32 = 0.05;

/// A rig that was made for a character.
#[derive(Clone, Debug)]
pub struct Rig {
    /// Joints in the order of their roles, model space; none turns or scales.
    pub skeleton: Skeleton,
    /// Their roles: one each.
    pub humanoid: Humanoid,
    /// How sure each joint is, 0..1, in the skeleton's order: 1 for given ones, below 0.5 where a ratio stands in for
    /// what was not seen.
    pub confidence: Vec<f64>,
    /// Where else each joint may be that is doubted: places in model space, each with how likely it is beside the one
    /// that was taken, 0..1; that one first, then the likeliest.
    pub candidates: BTreeMap<Role, Vec<(DVec3, f64)>>,
    /// From the feet to the head, model space: as given, or found.
    pub up: DVec3,
    /// The way the character looks, model space.
    pub forward: DVec3,
    /// What each mesh depicts.
    pub kinds: Vec<MeshKind>,
    /// Weights that deform: all influences, one for each mesh.
    pub weights: Vec<Weights>,
    /// Weights that animate: sharper; limit them with [`Weights::limited`].
    pub skin_weights: Vec<Weights>,
    /// The rule that gave the body its weights.
    pub method: WeightMethod,
    /// Vertices that took their weights by another rule than heat, volume or transfer, by rule.
    pub fallback: BTreeMap<String, usize>,
    /// What a person should know.
    pub warnings: Vec<Warning>,
    /// Milliseconds for joints, weights of the body, and weights of clothes.
    pub timing_ms: [f64; 3],
}

impl Rig {
    /// Makes a rig for `character`, whatever rig it has.
    ///
    /// # Errors
    /// What [`Character::validate`] refuses, `BadOption` for options out of their range, `NoGeometry` where nothing has
    /// an extent along up.
    pub fn of(character: &Character, options: &RigOptions) -> Result<Self> {
        Self::with_progress(character, options, &mut Progress::none())
    }

    /// As [`Rig::of`], and reports how far it is.
    ///
    /// # Errors
    /// As [`Rig::of`]; `Cancelled`.
    pub fn with_progress(
        character: &Character,
        options: &RigOptions,
        progress: &mut Progress,
    ) -> Result<Self> {
        character.validate()?;
        options.validate()?;
        progress.at(0.0)?;
        let clock = Moment::now();
        let Placed { figure, up, forward, mut kinds, surroundings, mut found, candidates, mut warnings } =
            Placed::of(character, options, &mut progress.part(0.0, 0.25))?;
        warnings.extend(refine_kinds(&figure, &surroundings, &mut kinds, &found.joints));
        progress.at(0.28)?;
        let eyes = find_eyes(&figure, &kinds, &found);
        for eye in &eyes {
            let joint = FoundJoint { position: eye.centre, confidence: eye.confidence };
            found.joints.entry(eye.role).or_insert(joint);
        }
        let joint_time = clock.milliseconds();
        progress.at(0.3)?;

        let at: BTreeMap<Role, DVec3> =
            found.joints.iter().map(|(&role, joint)| (role, joint.position)).collect();
        let bones = weight_bones(&at, &found.tips, Some(found.chin));
        let in_model = at.iter().map(|(&role, &p)| (role, figure.to_model(p))).collect();
        let (skeleton, humanoid) = skeleton_of(&in_model);
        let mut binder = Binder::new(
            &figure,
            &kinds,
            (&bones, &found.solid),
            &humanoid,
            &eyes,
            options,
            &mut progress.part(0.3, 0.72),
        )?;
        warnings.extend(binder.warning.take());
        let (weights, fallback) = binder.weights(options.heat, &mut progress.part(0.72, 0.9))?;
        let (method, skin_weights) = match binder.rule {
            BodyRule::Heat(_) => {
                let heat = SKIN_HEAT.max(options.heat);
                (WeightMethod::Heat, binder.weights(heat, &mut progress.part(0.9, 1.0))?.0)
            }
            BodyRule::Volume(_) => (WeightMethod::Volume, weights.clone()),
        };
        let skin_weights = skin_weights.iter().map(|weights| weights.trimmed(SKIN_TAIL)).collect();
        let timing_ms = [joint_time, binder.body_time, binder.garment_time];
        progress.at(1.0)?;

        let scored = |place: Place| (figure.to_model(place.position), place.score);
        Ok(Self {
            skeleton,
            humanoid,
            confidence: found.joints.values().map(|joint| joint.confidence).collect(),
            candidates: candidates
                .into_iter()
                .map(|(role, places)| (role, places.into_iter().map(scored).collect()))
                .collect(),
            up,
            forward,
            kinds,
            weights,
            skin_weights,
            method,
            fallback,
            warnings,
            timing_ms,
        })
    }

    /// The character with this rig in place of its own. Its own joints come first, in their order and with their
    /// roles given up: they ride along with the body around them.
    pub fn applied_to(&self, character: &Character) -> Character {
        let mut rigged = character.clone();
        let own = rigged.skeleton.joints.len();
        for (joint, ride) in rigged.skeleton.joints.iter_mut().zip(self.rides(character)) {
            joint.parent = ride.map(|ride| own + ride).or(joint.parent);
        }
        let made = self.skeleton.joints.iter();
        let behind = |joint: &Joint| Joint { parent: joint.parent.map(|above| own + above), ..joint.clone() };
        rigged.skeleton.joints.extend(made.map(behind));
        rigged.humanoid = Humanoid::default();
        for (role, joint) in self.humanoid.iter() {
            rigged.humanoid.set(role, own + joint);
        }
        for ((mesh, weights), kind) in rigged.meshes.iter_mut().zip(&self.weights).zip(&self.kinds) {
            mesh.weights = weights.shifted(own as u32);
            // The rig makes no difference between eyes and the rest of a face.
            if mesh.kind.map(MeshKind::without_eyes) != Some(*kind) {
                mesh.kind = Some(*kind);
            }
        }
        rigged.axes.up = self.up.as_vec3();
        rigged.axes.up_is_known = true;
        rigged.axes.forward = Some(self.forward.as_vec3());
        rigged
    }

    /// For each own joint of `character` the joint of this rig that it hangs from: the one with its role, or the one
    /// that moves most of what it moves. `None` for joints that follow their own parent, or nothing.
    fn rides(&self, character: &Character) -> Vec<Option<usize>> {
        let count = character.skeleton.joints.len();
        let has_role = marked(count, character.humanoid.iter().map(|(_, joint)| joint));
        let mut moved = vec![BTreeMap::<u32, f64>::new(); count];
        for (mesh, weights) in character.meshes.iter().zip(&self.weights) {
            for (old, new) in mesh.weights.rows().zip(weights.rows()) {
                for &(joint, share) in old {
                    for &(to, weight) in new {
                        *moved[joint as usize].entry(to).or_default() += f64::from(share) * f64::from(weight);
                    }
                }
            }
        }
        let most = |joint: usize| moved[joint].iter().max_by(|a, b| a.1.total_cmp(b.1));
        let is_loose = |joint: usize| character.skeleton.ancestors(joint).all(|above| !has_role[above]);
        let ride = |joint| most(joint).filter(|_| is_loose(joint)).map(|(&to, _)| to as usize);
        let mut rides: Vec<_> = (0..count).map(ride).collect();
        for (role, joint) in character.humanoid.iter() {
            rides[joint] = rides[joint].or_else(|| role.chain().find_map(|role| self.humanoid.joint(role)));
        }
        rides
    }

    /// The numbers for the report.
    pub fn report(&self) -> RigReport {
        let candidate =
            |&(position, score): &(DVec3, f64)| JointCandidate { position: position.to_array(), score };
        let candidates = self.candidates.iter();
        RigReport {
            source: "auto",
            confidence: by_name(self.humanoid.iter().map(|(role, joint)| (role, self.confidence[joint]))),
            candidates: by_name(
                candidates.map(|(&role, places)| (role, places.iter().map(candidate).collect())),
            ),
            unreached_vertices: self
                .weights
                .iter()
                .flat_map(Weights::rows)
                .filter(|row| row.iter().all(|&(_, weight)| weight <= 0.0))
                .count(),
            fallback_vertices: self.fallback.clone(),
        }
    }
}
