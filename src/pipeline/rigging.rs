//! §IV-B in order: facing, kinds, joints, weights of the body, weights of what it wears.

use super::milliseconds;
use crate::character::{Character, Humanoid, MeshKind, Role, Skeleton, Weights};
use crate::error::{Error, ErrorKind, Result, Warning};
use crate::progress::Progress;
use crate::report::RigReport;
use crate::rig::eyes::{Eye, find_eyes};
use crate::rig::facing::find_forward;
use crate::rig::heat::HeatSystem;
use crate::rig::joints::find_joints;
use crate::rig::mesh_kinds::{body_is_whole, guess_kinds, refine_kinds};
use crate::rig::skeleton::{skeleton_of, weight_bones};
use crate::rig::transfer::{Skin, Source, Worn, rigid_weights};
use crate::rig::voxel::{VoxelOptions, heat_would_be_poor, voxel_weights};
use crate::rig::{FoundJoint, GarmentWeights, Layout, RigOptions, WeightBone, WeightMethod, Weighted};
use glam::DVec3;
use std::collections::BTreeMap;
use std::time::Instant;

/// c of the heat equation for the weights that animate: sharper than those that deform.
const SKIN_HEAT: f64 = 3.0;
/// How fast volume weights fall off with distance.
const VOXEL_FALLOFF: f64 = 0.2;

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

    /// As [`Rig::of`], and tells how far it is.
    ///
    /// # Errors
    /// As [`Rig::of`]; `Cancelled`.
    pub fn with_progress(
        character: &Character,
        options: &RigOptions,
        progress: &mut Progress,
    ) -> Result<Self> {
        character.validate()?;
        validate(options)?;
        progress.at(0.0)?;
        let clock = Instant::now();
        let (forward, mut warnings) = find_forward(character);
        let layout = Layout::in_axes(character, forward, options.left_handed)?;
        let (mut kinds, kind_warnings) = guess_kinds(&layout);
        warnings.extend(kind_warnings);
        let given = options.given.iter().map(|(&role, &at)| (role, layout.to_layout(at))).collect();
        let guessed: Vec<Option<MeshKind>> = kinds.iter().copied().map(Some).collect();
        let mut found = find_joints(&layout, &guessed, &given, options.fingers, options.thread_count);
        warnings.append(&mut found.warnings);
        warnings.extend(refine_kinds(&layout, &mut kinds, &found.joints));
        let eyes = find_eyes(&layout, &kinds, &found);
        for eye in &eyes {
            let joint = FoundJoint { position: eye.centre, confidence: eye.confidence };
            found.joints.entry(eye.role).or_insert(joint);
        }
        let joint_time = milliseconds(clock);
        progress.at(0.3)?;

        let at: BTreeMap<Role, DVec3> =
            found.joints.iter().map(|(&role, joint)| (role, joint.position)).collect();
        let chin = options.chin_segment.then_some(found.chin);
        let bones = weight_bones(&at, &found.tips, chin);
        let (_, humanoid) = skeleton_of(&at);
        let mut binder = Binder::new(&layout, &kinds, &bones, &humanoid, &eyes, options);
        warnings.append(&mut binder.warnings);
        progress.at(0.4)?;
        let (weights, fallback) = binder.weights(options.heat);
        progress.at(0.7)?;
        let skin_weights = match binder.rule {
            BodyRule::Heat(_) => binder.weights(SKIN_HEAT.max(options.heat)).0,
            BodyRule::Volume(_) => weights.clone(),
        };
        progress.at(1.0)?;

        let in_model = at.iter().map(|(&role, &p)| (role, layout.to_model(p))).collect();
        let (skeleton, humanoid) = skeleton_of(&in_model);
        Ok(Self {
            skeleton,
            humanoid,
            confidence: found.joints.values().map(|joint| joint.confidence).collect(),
            forward,
            kinds,
            weights,
            skin_weights,
            method: match binder.rule {
                BodyRule::Heat(_) => WeightMethod::Heat,
                BodyRule::Volume(_) => WeightMethod::Volume,
            },
            fallback,
            warnings,
            timing_ms: [joint_time, binder.body_time, binder.garment_time],
        })
    }

    /// The character with this rig in place of its own. Its own joints come first, in their order and with their
    /// roles given up: they ride along with the body around them.
    pub fn applied_to(&self, character: &Character) -> Character {
        let mut rigged = character.clone();
        let own = rigged.skeleton.joints.len();
        let rides = self.rides(character);
        for (joint, ride) in rigged.skeleton.joints.iter_mut().zip(&rides) {
            if let Some(ride) = ride {
                joint.parent = Some(own + ride);
            }
        }
        rigged.skeleton.joints.extend(self.skeleton.joints.iter().cloned().map(|mut joint| {
            joint.parent = joint.parent.map(|parent| own + parent);
            joint
        }));
        rigged.humanoid = Humanoid::default();
        for (role, joint) in self.humanoid.iter() {
            rigged.humanoid.set(role, own + joint);
        }
        for ((mesh, weights), kind) in rigged.meshes.iter_mut().zip(&self.weights).zip(&self.kinds) {
            mesh.weights = weights.shifted(own as u32);
            mesh.kind = Some(*kind);
        }
        rigged.axes.forward = Some(self.forward.as_vec3());
        rigged
    }

    /// For each own joint of `character` the joint of this rig that it hangs from: the one with its role, or the one
    /// that moves most of what it moves. `None` for joints that follow their own parent, or nothing.
    fn rides(&self, character: &Character) -> Vec<Option<usize>> {
        let count = character.skeleton.joints.len();
        let mut rides = vec![None; count];
        let mut has_role = vec![false; count];
        for (role, joint) in character.humanoid.iter() {
            has_role[joint] = true;
            if rides[joint].is_none() {
                rides[joint] = role.chain().find_map(|role| self.humanoid.joint(role));
            }
        }
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
        for joint in 0..count {
            if character.skeleton.ancestors(joint).all(|above| !has_role[above]) {
                let most = moved[joint].iter().max_by(|a, b| a.1.total_cmp(b.1));
                rides[joint] = most.map(|(&to, _)| to as usize);
            }
        }
        rides
    }

    /// The numbers for the report.
    pub fn report(&self) -> RigReport {
        RigReport {
            source: "auto",
            confidence: self
                .humanoid
                .iter()
                .map(|(role, joint)| (role.name().to_string(), self.confidence[joint]))
                .collect(),
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

fn validate(options: &RigOptions) -> Result<()> {
    let bad = |message: String| Err(Error::new(ErrorKind::BadOption, message));
    if !(options.heat.is_finite() && (0.01..=1000.0).contains(&options.heat)) {
        return bad(format!("heat is {}: give a number from 0.01 to 1000", options.heat));
    }
    if !(16..=512).contains(&options.voxel_resolution) {
        return bad(format!(
            "voxel_resolution is {}: give a number from 16 to 512",
            options.voxel_resolution
        ));
    }
    if let Some((role, at)) = options.given.iter().find(|(_, at)| !at.is_finite()) {
        return bad(format!("the given joint {role} is at {at}: positions must be finite numbers"));
    }
    Ok(())
}

/// Meshes that take their weights together, as one list of vertices.
struct Group {
    meshes: Vec<usize>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Group {
    fn new(layout: &Layout, meshes: Vec<usize>) -> Self {
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for &mesh in &meshes {
            let vertices = layout.vertices(mesh);
            let shift = |vertex: u32| vertex - vertices.start as u32 + positions.len() as u32;
            triangles.extend(layout.triangles_of(mesh).iter().map(|corners| corners.map(shift)));
            positions.extend_from_slice(&layout.positions[vertices]);
        }
        Self { meshes, positions, triangles }
    }

    /// Hands the rows of all vertices out to the meshes.
    fn share(&self, layout: &Layout, all: &Weights, weights: &mut [Weights]) {
        let mut start = 0;
        for &mesh in &self.meshes {
            let end = start + layout.vertices(mesh).len();
            weights[mesh] = Weights::from_rows((start..end).map(|vertex| all.row(vertex).iter().copied()));
            start = end;
        }
    }
}

/// What gives the body its weights.
enum BodyRule {
    Heat(HeatSystem),
    /// The volume knows no heat: its weights are the same for every one.
    Volume(Weighted),
}

/// What decides the weights of every mesh, as far as it does not depend on the heat.
struct Binder<'a> {
    layout: &'a Layout,
    head: Option<u32>,
    eyes: &'a [Eye],
    eye_joints: Vec<Option<u32>>,
    options: &'a RigOptions,
    body: Group,
    garments: Vec<Group>,
    accessories: Group,
    of_head: Vec<usize>,
    /// The body's skin and each garment on it, made when weights are first asked for; `None` until then, and where
    /// nothing is worn.
    worn: Option<(Skin, Vec<Worn>)>,
    rule: BodyRule,
    warnings: Vec<Warning>,
    body_time: f64,
    garment_time: f64,
}

impl<'a> Binder<'a> {
    fn new(
        layout: &'a Layout,
        kinds: &[MeshKind],
        bones: &[WeightBone],
        humanoid: &Humanoid,
        eyes: &'a [Eye],
        options: &'a RigOptions,
    ) -> Self {
        let clock = Instant::now();
        let of = |wanted: MeshKind| -> Vec<usize> {
            (0..kinds.len()).filter(|&mesh| kinds[mesh] == wanted).collect()
        };
        let mut body = of(MeshKind::Body);
        let mut garments = of(MeshKind::Garment);
        let whole = body_is_whole(layout, kinds);
        // Clothes in place of a body, or the naive case: both take their weights as one.
        if !whole || options.garments == GarmentWeights::Heat {
            body.append(&mut garments);
            body.sort_unstable();
        }
        let mut accessories = of(MeshKind::Accessory);
        let mut of_head = of(MeshKind::Hair);
        of_head.extend(of(MeshKind::FacePart));
        // There must be a body to take weights from.
        if body.iter().all(|&mesh| layout.triangles_of(mesh).is_empty()) {
            body.append(&mut accessories);
            body.append(&mut of_head);
            body.sort_unstable();
        }
        let body = Group::new(layout, body);
        let mut warnings = Vec::new();
        let method = match options.method {
            WeightMethod::Auto => match heat_would_be_poor(&body.positions, &body.triangles, bones) {
                Some(reason) => {
                    warnings.push(Warning::new(
                        "open_body",
                        format!("weights were found through the volume of the body, not along its surface: {reason}"),
                    ));
                    WeightMethod::Volume
                }
                None => WeightMethod::Heat,
            },
            method => method,
        };
        let threads = options.thread_count;
        let rule = match method {
            WeightMethod::Volume => {
                let options = VoxelOptions {
                    resolution: options.voxel_resolution,
                    falloff: VOXEL_FALLOFF,
                    thread_count: threads,
                };
                BodyRule::Volume(voxel_weights(&body.positions, &body.triangles, bones, &options))
            }
            _ => BodyRule::Heat(HeatSystem::new(&body.positions, &body.triangles, bones, threads)),
        };
        let separate = |meshes: Vec<usize>| -> Vec<Group> {
            meshes.into_iter().map(|mesh| Group::new(layout, vec![mesh])).collect()
        };
        let joint = |role: Role| humanoid.joint(role).map(|joint| joint as u32);
        Self {
            layout,
            head: joint(Role::Head),
            eye_joints: eyes.iter().map(|eye| joint(eye.role)).collect(),
            eyes,
            options,
            body,
            garments: separate(garments),
            // Pieces that touch are one thing, whatever meshes they are in.
            accessories: Group::new(layout, accessories),
            of_head,
            worn: None,
            rule,
            warnings,
            body_time: milliseconds(clock),
            garment_time: 0.0,
        }
    }

    /// Weights of every mesh, with how many vertices took theirs by another rule.
    fn weights(&mut self, heat: f64) -> (Vec<Weights>, BTreeMap<String, usize>) {
        let threads = self.options.thread_count;
        let clock = Instant::now();
        let mut fallback = BTreeMap::new();
        let mut count = |weighted: &Weighted| {
            for (rule, vertices) in &weighted.fallback {
                *fallback.entry((*rule).to_string()).or_default() += vertices;
            }
        };
        let body = &self.body;
        let heated;
        let of_body = match &self.rule {
            BodyRule::Volume(weighted) => weighted,
            BodyRule::Heat(system) => {
                heated = system.weights(heat);
                &heated
            }
        };
        count(of_body);
        let mut weights = vec![Weights::default(); self.layout.mesh_count()];
        body.share(self.layout, &of_body.weights, &mut weights);
        self.body_time += milliseconds(clock);

        let clock = Instant::now();
        if !self.garments.is_empty() || !self.accessories.meshes.is_empty() {
            let (skin, worn) = self.worn.get_or_insert_with(|| {
                let skin = Skin::new(&body.positions, &body.triangles);
                let on_skin = |group: &Group| {
                    let garment = (&group.positions[..], &group.triangles[..]);
                    Worn::new(&skin, &body.triangles, garment, self.options.garments, threads)
                };
                let worn = self.garments.iter().map(on_skin).collect();
                (skin, worn)
            });
            let source = Source {
                skin,
                positions: &body.positions,
                triangles: &body.triangles,
                weights: &of_body.weights,
            };
            for (group, worn) in self.garments.iter().zip(worn) {
                let weighted = worn.weights(&source, threads);
                count(&weighted);
                group.share(self.layout, &weighted.weights, &mut weights);
            }
            let things = &self.accessories;
            let carried = rigid_weights(&source, &things.positions, &things.triangles);
            count(&carried);
            things.share(self.layout, &carried.weights, &mut weights);
        }
        let head = self.head.unwrap_or(0);
        for &mesh in &self.of_head {
            weights[mesh] = Weights::from_rows(self.layout.vertices(mesh).map(|vertex| {
                let eye = self.eyes.iter().position(|eye| eye.vertices.binary_search(&vertex).is_ok());
                [(eye.and_then(|eye| self.eye_joints[eye]).unwrap_or(head), 1.0)]
            }));
        }
        self.garment_time += milliseconds(clock);
        (weights, fallback)
    }
}
