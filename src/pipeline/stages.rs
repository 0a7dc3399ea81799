//! The life of a vertex: every stage between a character and its result, from top to bottom.
//!
//! A row says what a stage makes, the function that makes it, and the options that it reads. Which stages above it a function
//! reads stands in it, at its beginning. [`memo`](super::memo) calls it where what it reads has changed. Where a point goes by
//! what comes out here is in [`Placement`] and [`Field`]; what is done last, for every vertex alike,
//! in [`Ending`].

use super::displacement::{self, Displacements};
use super::memo::{Phase, Stage, Value, View};
use super::morphs::{self, Shifts, Touched};
use super::{hair, head_stages, reporting};
use crate::error::{Result, Warning};
use crate::face::FaceShape;
use crate::face::outline::{Outline, OutlineSources};
use crate::face::seat::Seat;
use crate::face::stage::YoungFace;
use crate::geometry::{distinct, range};
use crate::options::table::PRODUCT_FACE_SQUASH;
use crate::options::{Height, Mode, Options, Repair, Stage as LastStage};
use crate::shape::Measured;
use crate::shape::directions::RestTriangles;
use crate::shape::field::{Ending, Field, Finish};
use crate::shape::figure::{Figure, extent};
use crate::shape::paper;
use crate::shape::placement::{Bindings, Body, Placement};
use crate::shape::product;
use crate::shape::product::face_input::outline_sources;
use crate::shape::product::hanging::Hanging;
use crate::shape::product::landmarks::HeadSources;
use crate::shape::product::mirror::Mirror;
use crate::shape::product::repair::Pushed;
use crate::shape::product::strands::Strands;
use crate::shape::product::target::{self, ProductTarget};
use crate::shape::product::worn::Worn;
use glam::{DVec3, Vec3};
use std::sync::Arc;

macro_rules! stages {
    ($($(#[$text:meta])* $name:ident: $value:ty = $make:path, $phase:ident $work:literal, [$($option:ident),*];)+) => {
        /// The stages by number.
        #[allow(non_camel_case_types)]
        pub enum Number { $($name),+ }

        impl Number {
            /// See [`View::is_made`].
            pub const REST_TRIANGLES: usize = Self::rest_triangles as usize;
            /// What comes before it reads the target.
            pub const BODY: usize = Self::body as usize;
            /// What comes before it makes the field.
            pub const FINISH: usize = Self::finish as usize;
        }

        /// All stages, in their order.
        pub static STAGES: &[Stage] = &[$(Stage {
            name: stringify!($name),
            phase: Phase::$phase,
            work: $work,
            options: |_all| Options { $($option: _all.$option.clone(),)* ..Options::default() },
            make: |view| Ok(Arc::<$value>::from($make(view)?) as Value),
        }),+];

        impl View<'_> {
            $($(#[$text])*
            pub fn $name(&self) -> Result<Arc<$value>> {
                self.stage(Number::$name as usize)
            })+
        }
    };
}

stages! {
    // The target, read once.

    /// The character in one space: its meshes in one list of vertices, each with its weights by humanoid role.
    figure: Figure = lay_out, Measure 4, [];
    /// Landmarks, lengths, radii and slices of its body, and its face (V-A).
    measured: Measured = measure, Measure 21, [mode, rays, bone_groups];
    /// Product mode: the parts that each vertex and joint hangs on (D26), and the chart of its body (D29).
    parts: ProductTarget = bind, Deform 21, [];
    /// Which cloth lies how far over what (D32).
    worn: Worn = worn, Deform 0, [];
    /// What crown, chin and soles are read from.
    head_sources: HeadSources = head_sources, Deform 0, [];
    /// Which vertices and joints are each other's mirror image; `None` where the figure is not symmetric.
    mirror: Option<Mirror> = mirror, Deform 1, [];
    /// Strands of hair that hangs below the chin: which way they run, how far down, and what of them lies on the body (D15).
    strands: Option<Strands> = strands, Deform 0, [];
    /// Head and trunk without arms: what the head's outline is read from (D30).
    outline_sources: OutlineSources = outline_of_head, Deform 0, [];

    // The body.

    /// Where trunk and limbs go: Eqs. 1-11, or parts and slices (D27, D29) until the number of heads is right.
    body: Body = shape_body, Deform 14, [
        mode, head_scale, groups, bone_groups, limits, profile, stage
    ];
    /// What keeps clothes outside of that body (D32).
    pushed: Pushed = push_clothes, Deform 5, [repair];
    /// How hair hangs on it (D15).
    hanging: Option<Hanging> = hair::hanging, Deform 4, [hair_length];
    /// What both add to each vertex; empty where nothing is.
    offsets: Vec<DVec3> = hair::offsets, Deform 2, [];
    /// What the whole shrinks by, so that nobody becomes taller (D31): at most 1.
    whole: f64 = not_taller, Deform 1, [];

    // The head.

    /// The box of the face map, around what the head moves.
    face_box: Option<(DVec3, DVec3)> = head_stages::face_box, Face 1, [face_curve];
    /// The younger face of Eqs. 12 and 13, as far as it does not fold.
    face: Face = squash_face, Face 0, [mode, stage, face_squash, face_curve];
    /// The head from front and side, and how it stands over the trunk (D30).
    outline: Option<Outline> = head_stages::outline, Face 1, [];
    /// The table of the head (D30), and each vertex's way through it.
    young: Option<Arc<YoungFace>> = head_stages::make_young, Face 8, [
        youth_eye, youth_lower, youth_nose, youth_cheek, youth_jaw, youth_skull, youth_ear, smile
    ];
    /// How far the head goes back over the chest (D30).
    seat: Option<Seat> = head_stages::seat, Deform 0, [];
    /// Body, face, flow and seat: the field of the head's vertices, all the way.
    field: Field = head_stages::field, Deform 0, [stage, youth, seat];

    // Hair.

    /// Hair on the head and the body as they are now.
    hair: Option<hair::Hair> = hair::hair, Deform 8, [stage, hair_lay];

    // All together.

    /// The field, and what is known of where it takes vertices.
    deformation: Deformation = put_together, Deform 0, [];
    /// How far each vertex below the head goes all the way, as a float.
    below_head: Vec<Vec3> = displacement::below_head, Deform 1, [];
    /// How far every vertex goes all the way, the halves of what is symmetric alike.
    displacements: Displacements = displacement::all, Deform 4, [];
    /// Amount, ground and height: what is left to do for all alike.
    finish: Finish = finish, Deform 1, [amount, height];
    /// What a person should know.
    warnings: Vec<Warning> = reporting::warnings, Deform 0, [amount, stage, youth, youth_eye];

    // Asked for when results are written.

    /// Triangles at rest, of which directions turn as the displacements say (D22).
    rest_triangles: RestTriangles = rest_triangles, Deform 0, [];
    /// The vertices that morph targets touch.
    touched: Vec<Touched> = morphs::touched, Deform 0, [];
    /// How far morph targets go beyond their own deltas: filled in mesh by mesh.
    shifts: Shifts = morphs::shifts, Deform 0, [];
}

/// The face map, and a warning where it was bounded.
#[derive(Debug)]
pub struct Face {
    /// The map.
    pub shape: FaceShape,
    /// `face_squash_clamped`.
    pub warning: Option<Warning>,
}

/// The field all the way, and what is known of where it takes vertices.
#[derive(Debug)]
pub struct Deformation {
    /// The target.
    pub measured: Arc<Measured>,
    /// What the body's mode made.
    pub body: Arc<Body>,
    /// All of it.
    pub field: Arc<Field>,
    /// See the stage `offsets`.
    pub offsets: Arc<Vec<DVec3>>,
    /// Hair, where some hangs below the chin.
    pub hair: Arc<Option<hair::Hair>>,
}

impl Deformation {
    /// Where `field`, this one up to what is done last, takes the target's points.
    pub fn placement<'a>(&'a self, field: &'a Field, threads: usize) -> Placement<'a> {
        let hair = self.hair.as_ref().as_ref();
        let offsets = hair.map_or(&self.offsets[..], |hair| &hair.offsets);
        Placement {
            joint_offsets: hair.map_or(&[], |hair| &hair.joint_offsets),
            ..self.body.placement(&self.measured.figure, field, offsets, threads)
        }
    }
}

fn lay_out(view: &View) -> Result<Figure> {
    Figure::of(view.character())
}

fn measure(view: &View) -> Result<Measured> {
    let figure = view.figure()?;
    view.part(0.0, 1.0, |progress| Measured::of_figure(figure, view.character(), &view.options, progress))
}

fn bind(view: &View) -> Result<ProductTarget> {
    let measured = view.measured()?;
    view.part(0.0, 1.0, |progress| ProductTarget::of(view.character(), &measured, view.threads(), progress))
}

fn head_sources(view: &View) -> Result<HeadSources> {
    Ok(HeadSources::of(&*view.figure()?))
}

fn mirror(view: &View) -> Result<Option<Mirror>> {
    let (measured, parts) = (view.measured()?, view.parts()?);
    let Bindings { vertices, joints, .. } = &*parts.bindings;
    let goes_with = |point: usize| match vertices.get(point) {
        Some(vertex) => vertex.parts()?.goes_with(),
        None => joints[point - vertices.len()].parts().filter(|joint| joint.is_on_bone())?.goes_with(),
    };
    Ok(Mirror::of(&measured.figure, &measured.weld, goes_with, view.threads()))
}

fn worn(view: &View) -> Result<Worn> {
    let measured = view.measured()?;
    Ok(target::worn(view.character(), &measured.figure, &measured.weld, view.threads()))
}

fn strands(view: &View) -> Result<Option<Strands>> {
    let (measured, parts) = (view.measured()?, view.parts()?);
    Ok(Strands::of(view.character(), &measured, &parts.bindings.vertices, view.threads()))
}

fn outline_of_head(view: &View) -> Result<OutlineSources> {
    let (measured, parts) = (view.measured()?, view.parts()?);
    Ok(outline_sources(&measured.figure, &measured.anatomy, &parts.bindings.vertices))
}

fn shape_body(view: &View) -> Result<Body> {
    let (measured, style, options) = (view.measured()?, view.style(), &view.options);
    match options.mode {
        Mode::Paper => paper::equations::body(view.character(), &measured, style, options),
        Mode::Product => {
            let (parts, heads) = (view.parts()?, view.head_sources()?);
            let known = view.before::<Body>();
            view.part(0.0, 1.0, |progress| {
                product::body::body(&measured, &parts, &heads, style, options, known.as_deref(), progress)
            })
        }
    }
}

fn push_clothes(view: &View) -> Result<Arc<Pushed>> {
    let (body, measured) = (view.body()?, view.measured()?);
    let worn = match (view.options.repair, view.before()) {
        (Repair::Kept, Some(pushed)) => return Ok(pushed),
        (Repair::On | Repair::Kept, _) if body.parts().is_some() => view.worn()?,
        (Repair::Off | Repair::On | Repair::Kept, _) => Arc::default(),
    };
    if worn.places.is_empty() {
        return Ok(Arc::default());
    }
    let after = body.placement(&measured.figure, &body.field, &[], view.threads()).all_vertices();
    let (low, high) = extent(&after);
    Ok(Arc::new(worn.pushed(&after, &measured.weld, high - low, view.threads())?))
}

/// Seen: tubbykun, 2.2 heads, came out of a style of 2.5 heads at 1.42 m instead of .94.
fn not_taller(view: &View) -> Result<f64> {
    let (body, measured, offsets) = (view.body()?, view.measured()?, view.offsets()?);
    if body.parts().is_none() {
        return Ok(1.0);
    }
    let placement = body.placement(&measured.figure, &body.field, &offsets, view.threads());
    let (low, high) = extent(&placement.all_vertices());
    Ok(if low < high { (measured.figure.height() / (high - low)).min(1.0) } else { 1.0 })
}

fn squash_face(view: &View) -> Result<Face> {
    // A head without a chin has no face to make younger.
    let measured = view.measured()?;
    let has_face = view.options.mode == Mode::Product && measured.anatomy.landmarks.chin_seen;
    let by_mode = if has_face { PRODUCT_FACE_SQUASH * head_stages::growth(view)? } else { 0.0 };
    let squash = view.options.face_squash.unwrap_or(by_mode);
    let is_squashed = view.options.stage == LastStage::Face && squash != 0.0;
    let around = if is_squashed { *view.face_box()? } else { None };
    let in_box = |(low, high)| FaceShape::in_box(low, high, view.options.face_curve, squash);
    let (shape, warning) = around.map(in_box).unwrap_or_default();
    Ok(Face { shape, warning })
}

fn put_together(view: &View) -> Result<Deformation> {
    Ok(Deformation {
        measured: view.measured()?,
        body: view.body()?,
        field: view.field()?,
        offsets: view.offsets()?,
        hair: view.hair()?,
    })
}

/// The feet stand where they stood: the lowest vertex that touches the ground keeps its height. Then everything becomes as
/// tall as the options say, about the ground below the hips.
fn finish(view: &View) -> Result<Finish> {
    let (deformation, displacements) = (view.deformation()?, view.displacements()?);
    let Deformation { measured, body, .. } = &*deformation;
    let finish = Finish { amount: view.options.amount, ..deformation.field.finish };
    let frame = &measured.figure.frame;
    let up = frame.to_model(DVec3::Y);
    let ground = &body.bindings.ground;
    let height_of = |&vertex: &u32| {
        let vertex = vertex as usize;
        let way = displacements.vertices[vertex].as_dvec3().dot(up);
        measured.figure.positions[vertex].y + finish.amount * way
    };
    let lowest = ground.vertices.iter().map(height_of).min_by(f64::total_cmp);
    let finish = Finish { ground: lowest.map_or(0.0, |lowest| ground.height - lowest), ..finish };
    let height = match view.options.height {
        Height::Style => return Ok(finish),
        Height::Keep => measured.figure.height(),
        Height::Units(units) => units,
    };
    let ending = Ending::of(&finish, frame);
    let rest = view.character().meshes.iter().flat_map(|mesh| &mesh.positions);
    let heights =
        rest.zip(&*displacements.vertices).map(|(&p, &way)| ending.place(p, way).as_dvec3().dot(up));
    let (low, high) = range(heights);
    Ok(Finish { size: if low < high { height / (high - low) } else { 1.0 }, ..finish })
}

fn rest_triangles(view: &View) -> Result<RestTriangles> {
    let Measured { figure, weld, .. } = &*view.measured()?;
    let meshes = &view.character().meshes;
    let positions: Vec<Vec3> = meshes.iter().flat_map(|mesh| &mesh.positions).copied().collect();
    let vertices =
        meshes.iter().flat_map(|mesh| (0..mesh.positions.len()).map(|vertex| mesh.normals.get(vertex)));
    let normals: Vec<Vec3> =
        vertices.map(|normal| normal.map_or(Vec3::ZERO, |normal| normal.normalize_or_zero())).collect();
    // A triangle no wider than a seam is between two facets and of neither.
    let has_width = |&&corners: &&[u32; 3]| distinct(weld.triangle(corners)).len() == 3;
    let triangles: Vec<[u32; 3]> = figure.triangles.iter().filter(has_width).copied().collect();
    Ok(RestTriangles::of(&positions, &triangles, &figure.mesh_starts, &weld.parted(&normals)))
}
