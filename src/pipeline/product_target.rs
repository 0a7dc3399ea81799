//! What product mode finds of a target once, whatever style and options are: how it hangs on the parts, its hair.

use super::Target;
use super::attach::{Bindings, GroundContact, Placement, joint_bindings};
use super::strands::Strands;
use crate::character::Role;
use crate::error::Result;
use crate::face::seat::SeatSources;
use crate::options::{Options, Stage};
use crate::parallel;
use crate::progress::Progress;
use crate::shape::Measured;
use crate::shape::field::{Binding, Field};
use crate::shape::figure::{Figure, extent};
use crate::shape::product::binding::{PartBinding, PartBindings, joint_binding, part_bindings};
use crate::shape::product::hair::HairOnBody;
use crate::shape::product::head::seat_sources;
use crate::shape::product::joints::mean_bindings;
use crate::shape::product::landmarks::{HeadPlacement, HeadSources};
use crate::shape::product::part::Part;
use crate::shape::product::repair::Pushed;
use crate::shape::product::worn::Worn;
use glam::DVec3;
use std::sync::OnceLock;

/// What product mode finds of a measured target once: no style and no option changes it.
#[derive(Debug)]
pub struct ProductTarget {
    pub(super) bindings: Bindings,
    /// Joints that play eyes, and the vertices that each moves most.
    pub(super) eyes: Vec<(usize, Vec<u32>)>,
    /// What the bindings were made with, less the vertices' own.
    pub(super) parts: PartBindings,
    hair: OnceLock<HairOnBody>,
    head_sources: OnceLock<HeadSources>,
    seat_sources: OnceLock<SeatSources>,
    strands: OnceLock<Strands>,
    worn: OnceLock<Worn>,
}

impl ProductTarget {
    /// Binds vertices and joints to parts; finds what is worn meanwhile, where clothes will be pushed.
    pub(super) fn of(
        target: &Target,
        threads: usize,
        will_push: bool,
        progress: &mut Progress,
    ) -> Result<Self> {
        if !will_push || parallel::thread_count(threads) == 1 {
            return Self::bound(target, threads, progress);
        }
        let bind = || Self::bound(target, threads, progress);
        let (worn, bound) = parallel::both(threads, || worn_of(target, threads), bind);
        let bound = bound?;
        bound.worn.get_or_init(|| worn);
        Ok(bound)
    }

    fn bound(target: &Target, threads: usize, progress: &mut Progress) -> Result<Self> {
        let measured = &target.measured;
        let figure = &measured.figure;
        let skeleton = &target.character.skeleton;
        let mut parts = part_bindings(
            figure,
            &measured.anatomy,
            measured.face.as_ref(),
            skeleton,
            &target.measured.weld,
            threads,
            progress,
        )?;
        let vertices = std::mem::take(&mut parts.vertices);
        let of_legs =
            |vertex: usize| vertices[vertex].weights[Part::LeftUpperLeg as usize..].iter().sum::<f32>();
        let ground = GroundContact::of(figure, |vertex| of_legs(vertex) > 0.5);
        let means = mean_bindings(&target.character, figure, &vertices);
        let joints = joint_bindings(&target.character, figure, |joint| {
            Binding::Parts(if is_head_joint_in_neck(measured, joint) {
                PartBinding::to(Part::Neck)
            } else if let Some(mean) = means[joint] {
                mean
            } else {
                joint_binding(figure, &parts, joint)
            })
        });
        let bindings = Bindings::new(vertices.into_iter().map(Binding::Parts).collect(), joints, ground);
        Ok(Self {
            bindings,
            eyes: eyes(target),
            parts,
            hair: OnceLock::new(),
            head_sources: OnceLock::new(),
            seat_sources: OnceLock::new(),
            strands: OnceLock::new(),
            worn: OnceLock::new(),
        })
    }

    /// What the seat of the head is measured on.
    pub fn seat_sources(&self, measured: &Measured) -> &SeatSources {
        self.seat_sources.get_or_init(|| {
            let binding = |binding: &Binding| match binding {
                Binding::Parts(binding) => *binding,
                _ => PartBinding::to(Part::Torso),
            };
            let bindings: Vec<PartBinding> = self.bindings.vertices.iter().map(binding).collect();
            seat_sources(&measured.figure, &measured.anatomy, &bindings)
        })
    }

    /// The vertices of hats, glasses and earrings, thing by thing.
    pub fn things(&self) -> &[Vec<u32>] {
        &self.parts.things
    }

    /// A vertex's weight to `part`.
    fn weight(&self, vertex: usize, part: Part) -> f32 {
        match &self.bindings.vertices[vertex] {
            Binding::Parts(binding) => binding.weights[part as usize],
            _ => 0.0,
        }
    }

    /// Where `field` takes the target's points.
    pub(super) fn placement<'a>(
        &'a self,
        figure: &'a Figure,
        field: &'a Field,
        threads: usize,
    ) -> Placement<'a> {
        Placement::new(figure, &self.bindings, field, threads)
    }

    /// How many heads tall `placement` makes the target, measured on the result.
    pub(super) fn heads(&self, placement: &Placement) -> f64 {
        let sources = self.head_sources.get_or_init(|| HeadSources::of(placement.figure));
        let positions = placement.vertices(&sources.vertices);
        sources.heads(&HeadPlacement::of(placement.figure, positions, |joint| placement.joint(joint)))
    }

    /// What is added to each vertex so that locks which lay on the body still do; empty where nothing is.
    pub fn hair_offsets(&self, target: &Target, placement: &Placement) -> Vec<DVec3> {
        let hair = self.hair.get_or_init(|| self.hair_on_body(target, placement.threads));
        if hair.is_empty() {
            return placement.hair_offsets.to_vec();
        }
        let after = placement.all_vertices();
        let (low, high) = extent(&after);
        let offsets = hair.kept_outside(&after, &target.measured.weld, high - low, placement.threads);
        let mut all = placement.hair_offsets.to_vec();
        if offsets.is_empty() {
            return all;
        }
        all.resize(after.len(), DVec3::ZERO);
        for (vertex, offset) in offsets {
            all[vertex] += offset;
        }
        all
    }

    /// What keeps clothes outside of the body that `placement` makes.
    pub fn push_clothes(&self, target: &Target, placement: &Placement) -> Pushed {
        let worn = self.worn(target, placement.threads);
        if worn.places.is_empty() {
            return Pushed::default();
        }
        let after = placement.all_vertices();
        let (low, high) = extent(&after);
        worn.pushed(&after, &target.measured.weld, high - low, placement.threads)
    }

    /// The clothes, and how they lie over the body.
    pub fn worn(&self, target: &Target, threads: usize) -> &Worn {
        self.worn.get_or_init(|| worn_of(target, threads))
    }

    /// The hair's strands, and how they hang.
    pub fn strands(&self, target: &Target) -> &Strands {
        self.strands.get_or_init(|| Strands::of(target, &self.bindings))
    }

    /// Finds what the hair is made of, as far as `options` ask for it.
    pub fn find_hair(&self, target: &Target, options: &Options) {
        self.hair.get_or_init(|| self.hair_on_body(target, options.thread_count));
        if options.stage == Stage::Face && options.hair_lay > 0.0 {
            self.strands(target);
        }
    }

    fn hair_on_body(&self, target: &Target, threads: usize) -> HairOnBody {
        let figure = &target.measured.figure;
        let chin = target.measured.anatomy.landmarks.heights.chin;
        let hair: Vec<usize> = (0..figure.positions.len())
            .filter(|&vertex| figure.positions[vertex].y < chin && self.weight(vertex, Part::Hair) > 0.5)
            .collect();
        let of_head = |vertex: usize| self.weight(vertex, Part::Hair) + self.weight(vertex, Part::Head);
        let body =
            if hair.is_empty() { Vec::new() } else { figure.triangles_where(|vertex| of_head(vertex) < 0.5) };
        HairOnBody::of(&figure.positions, &figure.triangles, body, hair, &target.measured.weld, threads)
    }
}

fn worn_of(target: &Target, threads: usize) -> Worn {
    let figure = &target.measured.figure;
    let meshes = &target.character.meshes;
    let is_known = |vertex: usize| {
        meshes[figure.mesh_starts.partition_point(|&start| start <= vertex) - 1].kind.is_some()
    };
    Worn::of(figure, is_known, &target.measured.weld, threads)
}

/// Fewer vertices than this have no middle to speak of.
const LEAST_EYE: usize = 8;

/// Joints that play eyes, and the vertices of what they turn.
fn eyes(target: &Target) -> Vec<(usize, Vec<u32>)> {
    let (character, figure) = (&target.character, &target.measured.figure);
    let of = |joint: usize| -> Vec<u32> {
        let turns = |row: &[(u32, f32)]| row.iter().any(|&(by, weight)| by as usize == joint && weight > 0.5);
        let meshes = character.meshes.iter().zip(&figure.mesh_starts);
        let rows = meshes
            .flat_map(|(mesh, &start)| mesh.weights.rows().enumerate().map(move |(v, row)| (start + v, row)));
        rows.filter(|(_, row)| turns(row)).map(|(vertex, _)| vertex as u32).collect()
    };
    let joints =
        [Role::LeftEye, Role::RightEye].into_iter().filter_map(|role| character.humanoid.joint(role));
    joints.map(|joint| (joint, of(joint))).filter(|(_, vertices)| vertices.len() >= LEAST_EYE).collect()
}

/// Heads often turn about a point in the neck: a head joint below the chin moves as the neck does.
fn is_head_joint_in_neck(measured: &Measured, joint: usize) -> bool {
    let figure = &measured.figure;
    figure.humanoid.joint(Role::Head) == Some(joint)
        && figure.joints[joint].y < measured.anatomy.landmarks.heights.chin
}

/// What hangs from a head joint in the neck is on the head all the same, above the chin: the binding of such a point `p`,
/// canonical frame.
pub fn on_head(measured: &Measured, joint: usize, p: DVec3) -> Option<Binding> {
    let is_above_chin = p.y >= measured.anatomy.landmarks.heights.chin;
    (is_above_chin && is_head_joint_in_neck(measured, joint))
        .then(|| Binding::Parts(PartBinding::to(Part::Head)))
}
