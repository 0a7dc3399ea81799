//! How the target hangs on a field, and where the field takes its points.

use super::Coefficient;
use super::field::{Binding, Field, Finish};
use super::figure::{Figure, extent};
use super::product::body::Attempt;
use super::product::part::Part;
use super::product::parts_field::PartField;
use super::product::profile::radius_map::Spot;
use crate::character::{Character, Role};
use crate::error::Warning;
use crate::face::FaceShape;
use crate::face::stage::FaceBinding;
use crate::geometry::{Rows, marked, range};
use crate::parallel;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// `all`, with what `of` gives for these of them.
pub fn renewed<T: Clone + Send>(
    threads: usize,
    mut all: Arc<Vec<T>>,
    vertices: &[u32],
    of: impl Fn(usize) -> T + Sync,
) -> Arc<Vec<T>> {
    let new = parallel::collect(threads, vertices.len(), parallel::FEW, |index| of(vertices[index] as usize));
    let values = Arc::make_mut(&mut all);
    for (&vertex, new) in vertices.iter().zip(new) {
        values[vertex as usize] = new;
    }
    all
}

/// What a mode makes of target, style and options, before the head's own stages.
#[derive(Debug)]
pub struct Body {
    /// Its field alone.
    pub field: Field,
    /// How the target hangs on that.
    pub bindings: Arc<Bindings>,
    /// Where it takes the vertices, canonical frame.
    pub placed: Arc<Vec<DVec3>>,
    /// g of Eq. 9.
    pub head_ratio: f64,
    /// How many heads tall it is to be: as many as are asked for, or can be reached; `None` in paper mode.
    pub heads: Option<f64>,
    /// alpha and beta by group.
    pub coefficients: BTreeMap<String, Coefficient>,
    /// What a person should know.
    pub warnings: Vec<Warning>,
    /// What is left of a head count that could not be reached.
    pub heads_left: Option<Warning>,
    /// The fields that were tried for it, one after the other; none in paper mode.
    pub attempts: Vec<Attempt>,
}

impl Body {
    /// Its field with a face of this shape.
    pub fn with_face(&self, face: FaceShape) -> Field {
        Field { finish: Finish { face, ..Finish::default() }, ..self.field.clone() }
    }

    /// Product mode's parts; `None` in paper mode.
    pub fn parts(&self) -> Option<&PartField> {
        self.field.parts()
    }

    /// What is done last, all the way and without a younger face, for a figure that shrinks by `whole`.
    pub fn finish(&self, figure: &Figure, whole: f64) -> Finish {
        let hips = figure.role_position(Role::Hips).unwrap_or_default();
        Finish { whole, about: hips.with_y(self.bindings.ground.height), ..Finish::default() }
    }

    /// Where `field`, this body's with more stages, takes the points of `figure`, to whose vertices `offsets` are added.
    pub fn placement<'a>(
        &'a self,
        figure: &'a Figure,
        field: &'a Field,
        offsets: &'a [DVec3],
        threads: usize,
    ) -> Placement<'a> {
        let by_field = Placement::new(figure, &self.bindings, field, threads);
        Placement { placed: Some(&self.placed), offsets, ..by_field }
    }
}

/// How a target is attached to a mode's field.
#[derive(Debug)]
pub struct Bindings {
    /// One for each vertex.
    pub vertices: Vec<Binding>,
    /// One for each joint.
    pub joints: Vec<Binding>,
    /// Where it stands.
    pub ground: GroundContact,
    /// The vertices that the stages after the body's can move, ascending.
    pub of_head: Vec<u32>,
    /// Joints that play eyes, and the vertices that each moves most; none in paper mode.
    pub eyes: Vec<(usize, Vec<u32>)>,
    /// Where vertices are on the maps of the body's relief; none in paper mode.
    pub spots: Rows<(u8, Spot)>,
}

impl Bindings {
    /// All that hangs on the field so.
    pub fn new(vertices: Vec<Binding>, joints: Vec<Binding>, ground: GroundContact) -> Self {
        let of_head =
            (0..vertices.len() as u32).filter(|&vertex| is_of_head(&vertices[vertex as usize])).collect();
        Self { vertices, joints, ground, of_head, eyes: Vec::new(), spots: Rows::default() }
    }
}

/// True where the stages after the body's can move what is attached so.
pub fn is_of_head(binding: &Binding) -> bool {
    match binding {
        Binding::Parts(binding) => {
            let parts = [Part::Head, Part::Neck, Part::Hair];
            binding.face != FaceBinding::None
                || parts.iter().any(|&part| binding.weights[part as usize] > 0.0)
        }
        Binding::Bones(binding) => binding.head > 0.0,
        Binding::Fixed => false,
    }
}

/// Vertices of which the lowest stays where it is, and its height.
#[derive(Debug)]
pub struct GroundContact {
    /// The vertices.
    pub vertices: Vec<u32>,
    /// The height of the lowest one, canonical frame; where none stands, of the lowest vertex that there is.
    pub height: f64,
}

impl GroundContact {
    /// By the vertices of `figure` that `stands` accepts.
    pub fn of(figure: &Figure, stands: impl Fn(usize) -> bool) -> Self {
        let vertices: Vec<u32> =
            (0..figure.positions.len() as u32).filter(|&vertex| stands(vertex as usize)).collect();
        let standing = range(vertices.iter().map(|&vertex| figure.positions[vertex as usize].y));
        let (height, _) = if vertices.is_empty() { extent(&figure.positions) } else { standing };
        let height = if height.is_finite() { height } else { 0.0 };
        Self { vertices, height }
    }
}

/// How each joint is attached: by the role it folds into, as `bind` says; what lies above the hips stays.
pub fn joint_bindings(
    character: &Character,
    figure: &Figure,
    bind: impl Fn(usize) -> Binding,
) -> Vec<Binding> {
    let count = figure.joints.len();
    let above = figure.humanoid.iter().flat_map(|(_, joint)| character.skeleton.ancestors(joint).skip(1));
    let above_humanoid = marked(count, above);
    let entries = character.meshes.iter().flat_map(|mesh| mesh.weights.rows().flatten());
    let weighted = marked(count, entries.map(|&(joint, _)| joint as usize));
    (0..count)
        .map(|joint| match figure.joint_roles[joint] {
            None if above_humanoid[joint] || !weighted[joint] => Binding::Fixed,
            _ => bind(joint),
        })
        .collect()
}

/// A figure, how it is attached to a field, and that field.
#[derive(Clone, Copy)]
pub struct Placement<'a> {
    /// Where everything is at rest.
    pub figure: &'a Figure,
    /// How it is attached.
    pub bindings: &'a Bindings,
    /// What moves it.
    pub field: &'a Field,
    /// Added to each vertex at the end, as far as the field's amount says; empty where nothing is.
    pub offsets: &'a [DVec3],
    /// The same for each joint.
    pub joint_offsets: &'a [DVec3],
    /// Where the body of `field`, with its face, takes the vertices, where that is kept.
    pub placed: Option<&'a [DVec3]>,
    /// Threads to use, 0 for all cores.
    pub threads: usize,
}

impl<'a> Placement<'a> {
    /// By `field` alone.
    pub fn new(figure: &'a Figure, bindings: &'a Bindings, field: &'a Field, threads: usize) -> Self {
        Self { figure, bindings, field, offsets: &[], joint_offsets: &[], placed: None, threads }
    }

    /// Where a point `p` goes that moves with `vertex`; canonical frame.
    pub fn beside(&self, vertex: usize, p: DVec3) -> DVec3 {
        let to = self.field.place(p, &self.bindings.vertices[vertex]);
        self.with_offset(self.offsets, vertex, to)
    }

    /// Where `vertex` goes, canonical frame.
    pub fn vertex(&self, vertex: usize) -> DVec3 {
        let (p, binding) = (self.figure.positions[vertex], &self.bindings.vertices[vertex]);
        let to = match self.placed {
            Some(placed) => self.field.place_from(p, placed[vertex], binding, Some(vertex)),
            None => self.field.place(p, binding),
        };
        self.with_offset(self.offsets, vertex, to)
    }

    /// `to` with that one of `offsets` whose number is `index`, where there are any.
    fn with_offset(&self, offsets: &[DVec3], index: usize, to: DVec3) -> DVec3 {
        match offsets.get(index) {
            Some(&offset) => to + self.field.finish.share_of_offsets() * offset,
            None => to,
        }
    }

    /// Where the body of the field alone takes `vertex`, canonical frame.
    pub fn by_body(&self, vertex: usize) -> DVec3 {
        let (p, binding) = (self.figure.positions[vertex], &self.bindings.vertices[vertex]);
        match (self.field.parts(), binding) {
            (Some(parts), Binding::Parts(binding)) => {
                parts.place_known(p, binding, self.bindings.spots.of(vertex))
            }
            _ => self.field.place_body(p, binding),
        }
    }

    /// Where every vertex goes, canonical frame.
    pub fn all_vertices(&self) -> Vec<DVec3> {
        self.collect(self.figure.positions.len(), |vertex| self.vertex(vertex))
    }

    /// As [`Self::all_vertices`], of these.
    pub fn vertices(&self, vertices: &[u32]) -> Vec<DVec3> {
        self.collect(vertices.len(), |index| self.vertex(vertices[index] as usize))
    }

    /// What `place` gives for so many numbers.
    pub fn collect(&self, count: usize, place: impl Fn(usize) -> DVec3 + Sync) -> Vec<DVec3> {
        parallel::collect(self.threads, count, parallel::FEW, place)
    }

    /// Where `joint` goes, canonical frame.
    pub fn joint(&self, joint: usize) -> DVec3 {
        let to = self.field.place(self.figure.joints[joint], &self.bindings.joints[joint]);
        self.with_offset(self.joint_offsets, joint, to)
    }
}
