//! Weights of every mesh in order (§IV-B): of the body, of what it wears, of what the head carries.

use crate::character::{Humanoid, MeshKind, Role, Weights};
use crate::clock::Moment;
use crate::error::{Result, Warning};
use crate::progress::Progress;
use crate::rig::eyeballs::Eye;
use crate::rig::heat::{HeatSystem, Held};
use crate::rig::mesh_kinds::body_is_whole;
use crate::rig::parts::hangs_from_head;
use crate::rig::solid::Solid;
use crate::rig::transfer::{GarmentOnSkin, Skin, Source, rigid_weights};
use crate::rig::voxel::{VoxelOptions, heat_would_be_poor, voxel_weights};
use crate::rig::{GarmentWeights, RigOptions, UnitFigure, WeightBone, WeightMethod, WeightSet};
use crate::room::{self, Of};
use glam::DVec3;
use std::collections::BTreeMap;

/// Meshes that take their weights together, as one list of vertices.
struct Group {
    meshes: Vec<usize>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Group {
    fn new(figure: &UnitFigure, meshes: Vec<usize>) -> Self {
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for &mesh in &meshes {
            let vertices = figure.vertices(mesh);
            let shift = |vertex: u32| vertex - vertices.start as u32 + positions.len() as u32;
            triangles.extend(figure.triangles_of(mesh).iter().map(|corners| corners.map(shift)));
            positions.extend_from_slice(&figure.positions[vertices]);
        }
        Self { meshes, positions, triangles }
    }

    /// Hands the rows of all vertices out to the meshes.
    fn share(&self, figure: &UnitFigure, all: &Weights, weights: &mut [Weights]) {
        let mut start = 0;
        for &mesh in &self.meshes {
            let end = start + figure.vertices(mesh).len();
            weights[mesh] = Weights::from_rows((start..end).map(|vertex| all.row(vertex).iter().copied()));
            start = end;
        }
    }
}

/// By vertex the bones that hold it in place of the nearest ones: hair hangs from the head.
fn held(points: &[DVec3], triangles: &[[u32; 3]], bones: &[WeightBone], humanoid: &Humanoid) -> Vec<Held> {
    let head = humanoid.joint(Role::Head);
    let head = bones.iter().position(|bone| Some(bone.joint as usize) == head).unwrap_or(0) as u32;
    let by_head = |hangs: bool| if hangs { vec![(head, 1.0)] } else { Vec::new() };
    hangs_from_head(points, triangles, bones, humanoid).into_iter().map(by_head).collect()
}

/// What gives the body its weights.
pub enum BodyRule {
    Heat(HeatSystem),
    /// The volume knows no heat: its weights are the same for every one.
    Volume(WeightSet),
}

/// What decides the weights of every mesh, as far as it does not depend on the heat.
pub struct Binder<'a> {
    figure: &'a UnitFigure,
    humanoid: &'a Humanoid,
    eyes: &'a [Eye],
    threads: usize,
    body: Group,
    garments: Vec<Group>,
    accessories: Group,
    of_head: Vec<usize>,
    /// The body's skin and each garment on it; `None` where nothing is worn.
    worn: Option<(Skin, Vec<GarmentOnSkin>)>,
    pub rule: BodyRule,
    pub warning: Option<Warning>,
    pub body_time: f64,
    pub garment_time: f64,
}

impl<'a> Binder<'a> {
    pub fn new(
        figure: &'a UnitFigure,
        kinds: &[MeshKind],
        (bones, solid): (&[WeightBone], &Solid),
        humanoid: &'a Humanoid,
        eyes: &'a [Eye],
        options: &RigOptions,
        progress: &mut Progress,
    ) -> Result<Self> {
        let clock = Moment::now();
        let of =
            |kind: MeshKind| -> Vec<usize> { (0..kinds.len()).filter(|&mesh| kinds[mesh] == kind).collect() };
        let mut body = of(MeshKind::Body);
        let mut garments = of(MeshKind::Garment);
        // Clothes in place of a body, or the naive case: both take their weights as one.
        if !garments.is_empty() && (options.garments == GarmentWeights::Heat || !body_is_whole(figure, kinds))
        {
            body.append(&mut garments);
        }
        let mut accessories = of(MeshKind::Accessory);
        let mut of_head = of(MeshKind::Hair);
        of_head.extend(of(MeshKind::FacePart));
        // There must be a body to take weights from.
        if body.iter().all(|&mesh| figure.triangles_of(mesh).is_empty()) {
            body.append(&mut accessories);
            body.append(&mut of_head);
        }
        body.sort_unstable();
        let body = Group::new(figure, body);
        progress.at(0.1)?;
        let (points, triangles, threads) = (&body.positions, &body.triangles, options.thread_count);
        let (poor, by_volume) = match options.method {
            WeightMethod::Auto => (heat_would_be_poor(points, triangles, bones), false),
            WeightMethod::Heat => (None, false),
            WeightMethod::Volume => (None, true),
        };
        progress.at(0.25)?;
        let part = &mut progress.part(0.25, 0.95);
        let rule = if by_volume || poor.is_some() {
            let options = VoxelOptions {
                resolution: options.voxel_resolution,
                thread_count: threads,
                ..VoxelOptions::default()
            };
            BodyRule::Volume(voxel_weights(points, triangles, bones, &options, part)?)
        } else {
            room::ask(Of::Heat, points.len())?;
            let held = || held(points, triangles, bones, humanoid);
            let body: (_, &(dyn Fn() -> _ + Sync)) = (Some(solid), &held);
            BodyRule::Heat(HeatSystem::in_body(points, triangles, bones, body, threads, part)?)
        };
        let body_time = clock.milliseconds();

        let clock = Moment::now();
        let garments: Vec<Group> = garments.into_iter().map(|mesh| Group::new(figure, vec![mesh])).collect();
        let worn = if garments.is_empty() && accessories.is_empty() {
            None
        } else {
            room::ask(Of::Skin, points.len())?;
            let skin = Skin::new(points, triangles);
            let on_skin = |group: &Group| {
                let garment = (&group.positions[..], &group.triangles[..]);
                GarmentOnSkin::new(&skin, triangles, garment, options.garments, threads)
            };
            let on_skin = garments.iter().map(on_skin).collect();
            Some((skin, on_skin))
        };
        progress.at(1.0)?;
        let message = |reason| {
            format!("weights were found through the volume of the body, not along its surface: {reason}")
        };
        Ok(Self {
            figure,
            humanoid,
            eyes,
            threads,
            body,
            garments,
            // Pieces that touch are one thing, whatever meshes they are in.
            accessories: Group::new(figure, accessories),
            of_head,
            worn,
            rule,
            warning: poor.map(|reason| Warning::new("open_body", message(reason))),
            body_time,
            garment_time: clock.milliseconds(),
        })
    }

    /// Weights of every mesh, with how many vertices took theirs by another rule.
    ///
    /// # Errors
    /// `Cancelled`, `OutOfMemory`.
    pub fn weights(
        &mut self,
        heat: f64,
        progress: &mut Progress,
    ) -> Result<(Vec<Weights>, BTreeMap<String, usize>)> {
        let clock = Moment::now();
        let mut weights = vec![Weights::default(); self.figure.mesh_count()];
        let mut fallback = BTreeMap::new();
        let mut hand_out = |group: &Group, weighted: &WeightSet| {
            group.share(self.figure, &weighted.weights, &mut weights);
            for (rule, vertices) in &weighted.fallback {
                *fallback.entry((*rule).to_string()).or_default() += vertices;
            }
        };
        let of_body = match &self.rule {
            BodyRule::Volume(weighted) => weighted,
            BodyRule::Heat(system) => &system.weights(heat, &mut progress.part(0.0, 0.5))?,
        };
        hand_out(&self.body, of_body);
        self.body_time += clock.milliseconds();
        progress.at(0.5)?;

        let clock = Moment::now();
        if let Some((skin, worn)) = &self.worn {
            let Group { positions, triangles, .. } = &self.body;
            let source = Source { skin, positions, triangles, weights: &of_body.weights };
            for (group, worn) in self.garments.iter().zip(worn) {
                hand_out(group, &worn.weights(&source, self.threads));
                progress.at(0.85)?;
            }
            let things = &self.accessories;
            hand_out(things, &rigid_weights(&source, &things.positions, &things.triangles));
        }
        let joint = |role: Role| self.humanoid.joint(role).or(self.humanoid.joint(Role::Head));
        for &mesh in &self.of_head {
            weights[mesh] = Weights::from_rows(self.figure.vertices(mesh).map(|vertex| {
                let eye = self.eyes.iter().find(|eye| eye.vertices.binary_search(&vertex).is_ok());
                [(joint(eye.map_or(Role::Head, |eye| eye.role)).unwrap_or(0) as u32, 1.0)]
            }));
        }
        self.garment_time += clock.milliseconds();
        progress.at(1.0)?;
        Ok((weights, fallback))
    }
}
