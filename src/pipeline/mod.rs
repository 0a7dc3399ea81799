//! Puts the stages in order: what is known so far, what comes out, and what to redo when something changes.

pub mod rigging;

pub use rigging::Rig;

use crate::character::bones::Bone;
use crate::character::{Character, Humanoid, Mesh, MeshKind, MorphTarget, Role};
use crate::error::{Error, ErrorKind, Result, Warning};
use crate::face::FaceShape;
use crate::geometry::{SEAM, Weld, components, weld};
pub use crate::options::{FaceCurve, GroupSettings, Mode, Options, Stage};
use crate::parallel;
use crate::progress::Progress;
use crate::report::{Counts, FigureReport, Report, RigReport, Timing};
use crate::shape::directions::{Gradients, RestTriangles, has_volume, normal_matrix};
use crate::shape::field::{Binding, BoneBinding, Field, PaperField};
use crate::shape::figure::{Figure, extent};
use crate::shape::group::group_shapes;
use crate::shape::heights::Heights;
use crate::shape::measured::{Measured, is_of_head};
use crate::shape::paper::coefficients::coefficients;
use crate::shape::paper::field::BoneField;
use crate::shape::paper::shorten::{Shortened, shorten};
use crate::shape::product::binding::{PartBinding, PartBindings, joint_binding, part_bindings};
use crate::shape::product::coefficients::{PartCoefficients, Wanted, part_coefficients};
use crate::shape::product::field::PartField;
use crate::shape::product::hair::HairOnBody;
use crate::shape::product::landmarks::{HeadSources, Posed};
use crate::shape::product::part::Part;
pub use crate::shape::style::Style;
use crate::shape::{BodyShape, Coefficient, GroupShape};
use glam::{DMat3, DVec3, Mat3A, Vec3, Vec3A, Vec4};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// One mesh as it came out; arrays the input lacked are empty here too.
#[derive(Clone, Debug, Default)]
pub struct DeformedMesh {
    /// New rest positions, model space.
    pub positions: Vec<Vec3>,
    /// New unit normals.
    pub normals: Vec<Vec3>,
    /// New unit tangents; `w` is kept.
    pub tangents: Vec<Vec4>,
    /// New morph deltas, in the input's order.
    pub morph_targets: Vec<MorphTarget>,
}

/// A super-deformed character: what changed, in the input's order and space.
#[derive(Clone, Debug, Default)]
pub struct Deformed {
    /// One for each input mesh.
    pub meshes: Vec<DeformedMesh>,
    /// Where each joint of the input's skeleton is now, model space. Joints move and do not turn or scale:
    /// the new rest transform is the old one with this translation.
    pub joints: Vec<DVec3>,
}

/// What is wanted of one mesh beside its positions. What is not is left empty, and costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshOutputs {
    /// Normals.
    pub normals: bool,
    /// Tangents.
    pub tangents: bool,
    /// Morph targets: positions, normals and tangents.
    pub morph_targets: bool,
}

impl MeshOutputs {
    /// Everything that the mesh has.
    pub const ALL: Self = Self { normals: true, tangents: true, morph_targets: true };
}

/// Where the field takes a point, and what it does around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mapped {
    /// The point's new place, model space.
    pub position: DVec3,
    /// The field's Jacobian there, at fixed weights.
    pub jacobian: DMat3,
}

impl Mapped {
    /// The scale of small things at this point: the cube root of the Jacobian's determinant.
    pub fn local_scale(&self) -> f64 {
        self.jacobian.determinant().abs().cbrt()
    }
}

/// gamma of product mode unless the user says otherwise (found by looking: 0 leaves an adult, 1.4 a pointed forehead).
pub const PRODUCT_FACE_SQUASH: f64 = 0.8;
/// A head count as near as this to the one asked for needs no correction.
const HEADS_TOLERANCE: f64 = 5e-3;
/// Corrections of a head count before what is left is told.
const HEADS_ATTEMPTS: usize = 5;
/// What is left after that is told above this.
const HEADS_TOLD: f64 = 0.01;
/// Hair that reaches further below the chin than this, in heads, is told to be shortened.
const HAIR_TOLD: f64 = 0.1;
/// Fewer vertices than this are not worth a thread.
const LEAST_VERTICES: usize = 8000;
/// A target may be this many times as tall, in heads, as its style before it is called super-deformed already.
const ALREADY_SD: f64 = 1.2;

/// A character and a field made for it: made once, applied as often as something changes.
#[derive(Clone, Debug)]
pub struct Deformer {
    character: Arc<Character>,
    style: Style,
    study: Arc<Measured>,
    options: Options,
    weld: Arc<Weld>,
    /// Made when directions are first wanted.
    rest_triangles: OnceLock<Arc<RestTriangles>>,
    field: Field,
    bindings: Arc<Vec<Binding>>,
    joint_bindings: Vec<Binding>,
    /// What keeps locks of hair outside the body, added to each vertex at the end; empty where nothing does.
    hair_offsets: Vec<DVec3>,
    found: Found,
    /// Roles that target and style share.
    roles: BTreeSet<Role>,
    head_ratio: f64,
    coefficients: BTreeMap<String, Coefficient>,
    reference: Option<FigureReport>,
    warnings: Vec<Warning>,
    /// How many of the warnings do not depend on amount and face.
    warnings_of_shape: usize,
    /// What is left of a head count that could not be reached.
    heads_left: Option<Warning>,
    timing: Timing,
    made_rig: Option<MadeRig>,
}

/// What no option but the mode, and what the study depends on, changes: found when first wanted.
#[derive(Clone, Debug, Default)]
struct Found {
    /// What product mode's bindings were made with, less the vertices' own.
    parts: Option<Arc<PartBindings>>,
    hair: OnceLock<Arc<HairOnBody>>,
    head_sources: OnceLock<Arc<HeadSources>>,
    standing: OnceLock<Arc<Standing>>,
}

/// Vertices of which the lowest stays where it is, and its height.
#[derive(Clone, Debug)]
struct Standing {
    vertices: Vec<u32>,
    lowest: f64,
}

/// What the report says of a rig that was made.
#[derive(Clone, Debug)]
struct MadeRig {
    report: RigReport,
    warnings: Vec<Warning>,
    /// Roles of the character's own joints, which ride along.
    own: Humanoid,
    own_count: usize,
}

impl Deformer {
    /// Measures the target and makes the field that gives it the style.
    ///
    /// # Errors
    /// What [`Character::validate`] and [`Figure::of`] refuse; `BadOption` for options out of their range and for a style
    /// of N heads in paper mode; `BadStyle` for a style without what the mode transfers.
    pub fn new(character: Arc<Character>, style: &Style, options: &Options) -> Result<Self> {
        Self::with_progress(character, style, options, &mut Progress::none())
    }

    /// As [`Deformer::new`], and tells how far it is.
    ///
    /// # Errors
    /// As [`Deformer::new`]; `Cancelled`.
    pub fn with_progress(
        character: Arc<Character>,
        style: &Style,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Self> {
        Self::made(character, None, style, options, progress)
    }

    /// As [`Deformer::new`], by a rig that was made for `character`: its own joints, if any, ride along and come first in
    /// [`Deformed::joints`].
    ///
    /// # Errors
    /// As [`Deformer::new`].
    pub fn with_rig(character: &Character, rig: &Rig, style: &Style, options: &Options) -> Result<Self> {
        let rigged = Arc::new(rig.applied_to(character));
        Self::of_rigged(rigged, character, rig, style, options, &mut Progress::none())
    }

    /// As [`Deformer::with_rig`], with `rigged`, what [`Rig::applied_to`] gave for `character`.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`].
    pub fn of_rigged(
        rigged: Arc<Character>,
        character: &Character,
        rig: &Rig,
        style: &Style,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Self> {
        let made_rig = MadeRig {
            report: rig.report(),
            warnings: rig.warnings.clone(),
            own: character.humanoid.clone(),
            own_count: character.skeleton.joints.len(),
        };
        let mut deformer = Self::made(rigged, Some(made_rig), style, options, progress)?;
        let [rig_joints, rig_weights, transfer] = rig.timing_ms;
        deformer.timing = Timing { rig_joints, rig_weights, transfer, ..deformer.timing };
        Ok(deformer)
    }

    fn made(
        character: Arc<Character>,
        made_rig: Option<MadeRig>,
        style: &Style,
        options: &Options,
        progress: &mut Progress,
    ) -> Result<Self> {
        options.validate()?;
        if let Style::Heads(heads) = style {
            Style::heads(*heads)?;
        }
        progress.at(0.0)?;
        let clock = Instant::now();
        let study = Arc::new(Measured::of(&character, options)?);
        let measure = milliseconds(clock);
        progress.at(0.4)?;
        let weld = Arc::new(weld(&study.figure.positions, SEAM * study.figure.height()));
        let mut deformer = Self {
            character,
            style: style.clone(),
            options: options.clone(),
            weld,
            rest_triangles: OnceLock::new(),
            field: Field::Bones(PaperField {
                bones: BoneField::default(),
                stage: options.stage,
                face: FaceShape::None,
                amount: 1.0,
                ground: 0.0,
            }),
            bindings: Arc::default(),
            joint_bindings: Vec::new(),
            hair_offsets: Vec::new(),
            found: Found::default(),
            roles: BTreeSet::new(),
            head_ratio: 1.0,
            coefficients: BTreeMap::new(),
            reference: None,
            warnings: Vec::new(),
            warnings_of_shape: 0,
            heads_left: None,
            timing: Timing { measure, ..Timing::default() },
            made_rig,
            study,
        };
        deformer.make_field(&mut progress.part(0.45, 1.0))?;
        Ok(deformer)
    }

    /// Changes the options, with the same result as a deformer made anew; only what depends on the change is done
    /// again. Where it fails the deformer is as it was.
    ///
    /// # Errors
    /// As [`Deformer::with_progress`].
    pub fn set_options(&mut self, options: &Options, progress: &mut Progress) -> Result<()> {
        options.validate()?;
        progress.at(0.0)?;
        // The field of another amount, face or number of threads, as it is now.
        let same_shape = Options {
            amount: self.options.amount,
            face_squash: self.options.face_squash,
            face_curve: self.options.face_curve,
            thread_count: self.options.thread_count,
            ..options.clone()
        };
        if same_shape == self.options {
            let same_amount = options.amount == self.options.amount;
            self.options = options.clone();
            match same_amount {
                true => self.set_face_squash(self.face_squash()),
                false => self.finish(),
            }
            return Ok(());
        }
        let mut next = self.clone();
        next.options = options.clone();
        let measures_anew = options.ray_count() != self.options.ray_count()
            || options.bone_groups != self.options.bone_groups;
        if measures_anew {
            let clock = Instant::now();
            next.study = Arc::new(Measured::of_figure(self.study.figure.clone(), options)?);
            next.timing.measure = milliseconds(clock);
        }
        if measures_anew || options.mode != self.options.mode {
            next.found = Found::default();
        }
        next.make_field(&mut progress.part(0.4, 1.0))?;
        *self = next;
        Ok(())
    }

    /// Everything that follows from the measured target, the style and the options.
    fn make_field(&mut self, progress: &mut Progress) -> Result<()> {
        progress.at(0.0)?;
        let clock = Instant::now();
        let style = self.style.clone();
        let study = Arc::clone(&self.study);
        self.warnings = self.made_rig.as_ref().map(|rig| rig.warnings.clone()).unwrap_or_default();
        self.warnings.extend(study.anatomy.landmarks.warnings("target"));
        self.roles = match &style {
            Style::Shape(shape) => {
                study.joints.keys().copied().filter(|role| shape.roles().contains(role)).collect()
            }
            Style::Heads(_) => study.joints.keys().copied().collect(),
        };
        if let (Style::Shape(shape), Some(proportions)) = (&style, &study.shape.proportions)
            && let Some(heads) = shape.heads()
            && proportions.heads() <= ALREADY_SD * heads
            && shape.proportions != study.shape.proportions
        {
            self.warnings.push(Warning::new(
                "already_super_deformed",
                format!(
                    "the target is {:.1} heads tall and the style {heads:.1}: little is left to deform",
                    proportions.heads()
                ),
            ));
        }
        self.heads_left = None;
        self.hair_offsets = Vec::new();
        match self.options.mode {
            Mode::Product => self.make_parts(&style, progress)?,
            Mode::Paper => self.make_bones(&style)?,
        }
        self.warnings_of_shape = self.warnings.len();
        self.finish();
        self.reference = match &style {
            Style::Shape(shape) => Some(style_report(shape, &self.roles, &self.options)),
            Style::Heads(_) => None,
        };
        self.timing.deform = milliseconds(clock);
        progress.at(1.0)
    }

    /// Amount, ground and face: what is done last, in this order.
    fn finish(&mut self) {
        self.warnings.truncate(self.warnings_of_shape);
        if self.options.amount == 1.0 {
            self.warnings.extend(self.heads_left.clone());
        }
        self.field.set_face(FaceShape::None);
        self.field.set_amount(self.options.amount);
        self.stand_on_ground();
        self.set_face_squash(self.face_squash());
    }

    /// gamma as set, else the mode's own.
    fn face_squash(&self) -> f64 {
        match (self.options.face_squash, self.options.mode) {
            (Some(squash), _) => squash,
            (None, Mode::Product) if self.study.anatomy.landmarks.chin_seen => PRODUCT_FACE_SQUASH,
            (None, _) => 0.0,
        }
    }

    /// Product mode: bindings once, then the field, and again while the head count measured on the result is off.
    fn make_parts(&mut self, style: &Style, progress: &mut Progress) -> Result<()> {
        let proportions = self.study.anatomy.proportions.clone();
        let parts = self.bind_to_parts();
        self.warnings.extend(self.study.anatomy.warnings());
        if let Some(hair) = &parts.hair
            && hair.depth > HAIR_TOLD * proportions.head_length
        {
            self.warnings.push(Warning::new(
                "hair_shortened",
                format!(
                    "hair reaches {:.2} head lengths below the chin: there it follows the body instead of the head (--hair-length)",
                    hair.depth / proportions.head_length
                ),
            ));
        }
        let (asked, head_ratio) = match style {
            Style::Heads(heads) => (*heads, 1.0),
            Style::Shape(shape) => {
                let Some(reference) = &shape.proportions else {
                    return Err(Error::new(
                        ErrorKind::BadStyle,
                        format!(
                            "the style {} holds no proportions, which product mode transfers: save it again from its model, or use --paper",
                            shape.name
                        ),
                    ));
                };
                (reference.heads(), self.options.head_scale * proportions.head_length / reference.head_length)
            }
        };
        self.head_ratio = head_ratio;
        let mut aim = asked;
        let mut best: Option<(f64, f64, Attempt)> = None;
        for count in 0..HEADS_ATTEMPTS {
            progress.at(0.3 + 0.1 * count as f32)?;
            let attempt = self.attempt(style, aim / asked, &parts)?;
            let measured = self.heads_by(&attempt.field);
            let predicted =
                crate::shape::product::coefficients::heads_of(&proportions, &attempt.coefficients);
            let limited = attempt.warnings.iter().any(|warning| warning.code == "heads_limited");
            let reach = if limited { predicted } else { asked };
            let error = (measured / reach).ln().abs();
            if best.as_ref().is_none_or(|(least, ..)| error < *least) {
                best = Some((error, measured, attempt));
            }
            if error <= HEADS_TOLERANCE || limited {
                break;
            }
            aim = (aim - 1.0) * ((asked - 1.0) / (measured - 1.0)).clamp(0.8, 1.25) + 1.0;
        }
        let (error, measured, attempt) = best.expect("there is at least one attempt");
        self.field = attempt.field;
        self.coefficients = attempt.coefficients.by_group();
        self.warnings.extend(attempt.warnings);
        if error > HEADS_TOLD {
            self.heads_left = Some(Warning::new(
                "heads_limited",
                format!(
                    "{measured:.2} heads are measured on the result instead of {asked:.2}: its chin or crown reads differently from the target's"
                ),
            ));
        }
        progress.at(0.9)?;
        self.keep_hair_outside();
        Ok(())
    }

    /// Binds vertices and joints to parts, where that is not done yet.
    fn bind_to_parts(&mut self) -> Arc<PartBindings> {
        if let Some(parts) = &self.found.parts {
            return parts.clone();
        }
        let (figure, anatomy) = (&self.study.figure, &self.study.anatomy);
        let mut parts =
            part_bindings(figure, anatomy, &self.character.skeleton, &self.weld, self.options.thread_count);
        let vertices = std::mem::take(&mut parts.vertices);
        let joint_bindings = self.joint_bindings(|figure, joint| {
            if self.is_head_joint_in_neck(joint) {
                return Binding::Parts(PartBinding::to(Part::Neck));
            }
            Binding::Parts(joint_binding(figure, &parts, joint))
        });
        self.bindings = Arc::new(vertices.into_iter().map(Binding::Parts).collect());
        self.joint_bindings = joint_bindings;
        let parts = Arc::new(parts);
        self.found.parts = Some(parts.clone());
        parts
    }

    /// Locks that lay on the body still do.
    fn keep_hair_outside(&mut self) {
        let figure = &self.study.figure;
        let hair = self.found.hair.get_or_init(|| {
            let chin = self.study.anatomy.landmarks.heights.chin;
            let part = |vertex: usize, part: Part| match &self.bindings[vertex] {
                Binding::Parts(binding) => binding.weights[part as usize],
                _ => 0.0,
            };
            let hair: Vec<usize> = (0..figure.positions.len())
                .filter(|&vertex| figure.positions[vertex].y < chin && part(vertex, Part::Hair) > 0.5)
                .collect();
            let of_head = |vertex: usize| part(vertex, Part::Hair) + part(vertex, Part::Head);
            let body = match hair.is_empty() {
                true => Vec::new(),
                false => figure.triangles_where(|vertex| of_head(vertex) < 0.5),
            };
            Arc::new(HairOnBody::of(&figure.positions, &figure.triangles, body, hair, &self.weld))
        });
        if hair.is_empty() {
            return;
        }
        let after = self.positions_by(&self.field);
        let (low, high) = extent(&after);
        let offsets = hair.kept_outside(&after, &self.weld, high - low);
        if !offsets.is_empty() {
            self.hair_offsets = vec![DVec3::ZERO; after.len()];
            for (vertex, offset) in offsets {
                self.hair_offsets[vertex] = offset;
            }
        }
    }

    /// One field of product mode, for a style with everything below the head stretched by what makes the result
    /// `correction` times as many heads tall.
    fn attempt(&self, style: &Style, correction: f64, parts: &PartBindings) -> Result<Attempt> {
        let anatomy = &self.study.anatomy;
        let stretched;
        let wanted = match style {
            Style::Heads(heads) => Wanted::Heads(heads * correction),
            Style::Shape(shape) if correction == 1.0 => {
                Wanted::Reference(shape.proportions.as_ref().expect("checked by the caller"))
            }
            Style::Shape(shape) => {
                let heads = shape.heads().expect("checked by the caller");
                stretched = shape.with_heads(heads * correction).proportions.expect("checked by the caller");
                Wanted::Reference(&stretched)
            }
        };
        let (coefficients, warnings) = part_coefficients(&anatomy.proportions, wanted, &self.options)?;
        let field = PartField::new(anatomy, coefficients, parts, self.options.hair_length, 1.0);
        Ok(Attempt { field: Field::Parts(Box::new(field)), coefficients, warnings })
    }

    /// The paper's own way: coefficients (Eqs. 9-11), skeleton (Eqs. 1-4), mesh (Eqs. 5-8).
    fn make_bones(&mut self, style: &Style) -> Result<()> {
        let Style::Shape(reference) = style else {
            return Err(Error::new(
                ErrorKind::BadOption,
                "a style for N heads needs product mode: leave --paper out, or give a reference",
            ));
        };
        let options = &self.options;
        let found = coefficients(
            &self.study.shape,
            reference,
            options.head_scale,
            &options.groups,
            &options.bone_groups,
        )?;
        self.head_ratio = found.head_ratio;
        self.warnings.extend(found.warnings);
        self.coefficients = found.groups;
        let all: BTreeSet<Role> = self.study.joints.keys().copied().collect();
        let bones: Vec<Bone> = self.study.bones(&all, options);
        let (joints, head_top) = (&self.study.joints, self.study.head_top);
        let shortened: Shortened = shorten(&bones, joints, head_top, &self.coefficients);
        let field = BoneField::new(&bones, joints, head_top, &shortened, &self.coefficients);
        let figure = &self.study.figure;
        let bind = |p: DVec3, weights: &[(Role, f64)]| BoneBinding {
            weights: field.bone_weights(p, weights),
            head: weights.iter().filter(|&&(role, _)| role.is_head()).map(|&(_, weight)| weight).sum(),
            on_face: None,
        };
        let mut bindings: Vec<BoneBinding> = figure
            .positions
            .iter()
            .zip(figure.role_weights.iter())
            .map(|(&p, weights)| bind(p, weights))
            .collect();
        for (members, centre) in head_accessories(figure, &self.weld) {
            for vertex in members {
                bindings[vertex].on_face = Some(centre);
            }
        }
        self.joint_bindings = self.joint_bindings(|figure, joint| {
            let role = figure.joint_roles[joint].unwrap_or(Role::Hips);
            Binding::Bones(bind(figure.joints[joint], &[(role, 1.0)]))
        });
        self.bindings = Arc::new(bindings.into_iter().map(Binding::Bones).collect());
        self.field = Field::Bones(PaperField {
            bones: field,
            stage: options.stage,
            face: FaceShape::None,
            amount: 1.0,
            ground: 0.0,
        });
        Ok(())
    }

    /// Makes the face younger by `squash` (gamma); nothing else is done again.
    ///
    /// A squash that would fold the face is bounded, with the warning `face_squash_clamped`.
    pub fn set_face_squash(&mut self, squash: f64) {
        let clock = Instant::now();
        self.warnings.retain(|warning| warning.code != "face_squash_clamped");
        self.field.set_face(FaceShape::None);
        if self.options.stage < Stage::Face || squash == 0.0 {
            return;
        }
        let Some((low, high)) = self.face_box() else {
            return;
        };
        let (face, warning) = FaceShape::in_box(low, high, self.options.face_curve, squash);
        self.warnings.extend(warning);
        self.field.set_face(face);
        self.timing.face = milliseconds(clock);
    }

    /// The box of the face map: around what the head moves, in body or face meshes, as the field without amount and
    /// ground shift leaves it; in product mode its height is from chin to crown.
    fn face_box(&self) -> Option<(DVec3, DVec3)> {
        let figure = &self.study.figure;
        let mut whole = self.field.clone();
        whole.set_amount(1.0);
        whole.set_ground(0.0);
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for vertex in 0..figure.positions.len() {
            if matches!(figure.kind(vertex), MeshKind::Body | MeshKind::FacePart)
                && is_of_head(figure, vertex)
            {
                let p = self.place_by(&whole, vertex, figure.positions[vertex]);
                low = low.min(p);
                high = high.max(p);
            }
        }
        if let Field::Parts(field) = &self.field {
            let Heights { chin, crown, .. } = *field.after();
            let reach = 0.5 * (crown - chin);
            if low.x > high.x {
                low = DVec3::splat(-reach);
                high = DVec3::splat(reach);
            }
            low.y = chin;
            high.y = crown;
        }
        (low.x <= high.x).then_some((low, high))
    }

    /// Feet stand where they stood: in paper mode the lowest vertex that is not hair keeps its height, in product
    /// mode the lowest one that the legs move.
    fn stand_on_ground(&mut self) {
        self.field.set_ground(0.0);
        let standing = self.found.standing.get_or_init(|| Arc::new(self.standing()));
        let heights = self.vertices_by(&self.field, &standing.vertices);
        if let Some(after) = heights.iter().map(|p| p.y).min_by(f64::total_cmp) {
            self.field.set_ground(standing.lowest - after);
        }
    }

    fn standing(&self) -> Standing {
        let figure = &self.study.figure;
        let feet = self.options.mode == Mode::Product;
        let stands = |vertex: usize| match &self.bindings[vertex] {
            Binding::Parts(binding) if feet => {
                binding.weights[Part::LeftUpperLeg as usize..].iter().sum::<f32>() > 0.5
            }
            _ => figure.kind(vertex) != MeshKind::Hair,
        };
        let vertices: Vec<u32> = (0..figure.positions.len())
            .filter(|&vertex| stands(vertex))
            .map(|vertex| vertex as u32)
            .collect();
        let heights = vertices.iter().map(|&vertex| figure.positions[vertex as usize].y);
        let lowest = heights.fold(f64::INFINITY, f64::min);
        Standing { vertices, lowest }
    }

    /// How each joint is attached: by the role it folds into, as `bind` says; what lies above the hips stays.
    fn joint_bindings(&self, bind: impl Fn(&Figure, usize) -> Binding) -> Vec<Binding> {
        let (character, figure) = (&self.character, &self.study.figure);
        let mut above_humanoid = vec![false; figure.joints.len()];
        for (_, joint) in figure.humanoid.iter() {
            for above in character.skeleton.ancestors(joint).skip(1) {
                above_humanoid[above] = true;
            }
        }
        let mut weighted = vec![false; figure.joints.len()];
        for mesh in &character.meshes {
            for &(joint, _) in mesh.weights.rows().flatten() {
                weighted[joint as usize] = true;
            }
        }
        (0..figure.joints.len())
            .map(|joint| match figure.joint_roles[joint] {
                None if above_humanoid[joint] || !weighted[joint] => Binding::Fixed,
                _ => bind(figure, joint),
            })
            .collect()
    }

    /// Where `field` takes `vertex`, or a point `p` near it that moves with it; canonical frame.
    fn place_by(&self, field: &Field, vertex: usize, p: DVec3) -> DVec3 {
        let to = field.place(p, &self.bindings[vertex]);
        match self.hair_offsets.get(vertex) {
            Some(&offset) => to + field.amount() * offset,
            None => to,
        }
    }

    /// Where `field` takes every vertex, canonical frame.
    fn positions_by(&self, field: &Field) -> Vec<DVec3> {
        let positions = &self.study.figure.positions;
        parallel::collect(self.options.thread_count, positions.len(), LEAST_VERTICES, |vertex| {
            self.place_by(field, vertex, positions[vertex])
        })
    }

    /// As [`Self::positions_by`], of these vertices.
    fn vertices_by(&self, field: &Field, vertices: &[u32]) -> Vec<DVec3> {
        let positions = &self.study.figure.positions;
        parallel::collect(self.options.thread_count, vertices.len(), LEAST_VERTICES, |index| {
            let vertex = vertices[index] as usize;
            self.place_by(field, vertex, positions[vertex])
        })
    }

    /// How many heads tall `field` makes the target, measured on the result.
    fn heads_by(&self, field: &Field) -> f64 {
        let figure = &self.study.figure;
        let sources = self.found.head_sources.get_or_init(|| Arc::new(HeadSources::of(figure)));
        let positions = self.vertices_by(field, &sources.vertices);
        let place_joint = |joint: usize| field.place(figure.joints[joint], &self.joint_bindings[joint]);
        sources.heads(&Posed::of(figure, positions, place_joint))
    }

    /// The whole result.
    pub fn apply(&self) -> Deformed {
        self.apply_with(&mut Progress::none()).unwrap_or_default()
    }

    /// As [`Deformer::apply`], and tells how far it is.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn apply_with(&self, progress: &mut Progress) -> Result<Deformed> {
        self.apply_to(&vec![MeshOutputs::ALL; self.character.meshes.len()], progress)
    }

    /// As [`Deformer::apply_with`], for what is wanted of each mesh.
    ///
    /// # Errors
    /// `Cancelled`.
    ///
    /// # Panics
    /// `outputs` is not as long as the character has meshes.
    pub fn apply_to(&self, outputs: &[MeshOutputs], progress: &mut Progress) -> Result<Deformed> {
        let character = &self.character;
        assert_eq!(outputs.len(), character.meshes.len(), "one for each mesh");
        progress.at(0.0)?;
        if self.options.amount == 0.0 {
            // The way to the canonical frame and back costs a last digit.
            let meshes =
                character.meshes.iter().zip(outputs).map(|(mesh, &wanted)| unchanged(mesh, wanted)).collect();
            progress.at(1.0)?;
            return Ok(Deformed { meshes, joints: self.deformed_joints() });
        }
        let figure = &self.study.figure;
        let threads = self.options.thread_count;
        let after = self.positions_by(&self.field);
        progress.at(0.3)?;
        let has_directions = |(mesh, wanted): (&Mesh, &MeshOutputs)| {
            (wanted.normals || wanted.tangents || wanted.morph_targets)
                && !(mesh.normals.is_empty() && mesh.tangents.is_empty())
        };
        let rest = character.meshes.iter().zip(outputs).any(has_directions).then(|| {
            self.rest_triangles
                .get_or_init(|| Arc::new(RestTriangles::of(&figure.positions, &figure.triangles, &self.weld)))
        });
        let gradients = rest.map(|rest| rest.gradients(&after, threads));
        progress.at(0.6)?;
        let turns: Vec<Turns> = (0..character.meshes.len())
            .map(|mesh| match &gradients {
                Some(gradients) if has_directions((&character.meshes[mesh], &outputs[mesh])) => {
                    self.turns(mesh, outputs[mesh], gradients)
                }
                _ => Turns::default(),
            })
            .collect();
        // Morph targets one by one, whichever mesh they belong to: a face may hold them all.
        let targets: Vec<(usize, usize)> = (0..character.meshes.len())
            .filter(|&mesh| outputs[mesh].morph_targets)
            .flat_map(|mesh| {
                (0..character.meshes[mesh].morph_targets.len()).map(move |target| (mesh, target))
            })
            .collect();
        let least = if after.len() < LEAST_VERTICES { usize::MAX } else { 1 };
        let mut targets = parallel::collect(threads, targets.len(), least, |index| {
            let (mesh, target) = targets[index];
            self.deform_target(mesh, target, &after, &turns[mesh])
        })
        .into_iter();
        let meshes = turns
            .into_iter()
            .enumerate()
            .map(|(index, turns)| {
                let (mesh, wanted) = (&character.meshes[index], outputs[index]);
                let start = figure.mesh_starts[index];
                let of_mesh = &after[start..start + mesh.positions.len()];
                let tangents = turns.tangents.iter().zip(&mesh.tangents);
                let target_count = if wanted.morph_targets { mesh.morph_targets.len() } else { 0 };
                DeformedMesh {
                    positions: of_mesh.iter().map(|&p| single(figure.frame.to_model(p))).collect(),
                    tangents: match wanted.tangents {
                        true => tangents.map(|(tangent, old)| tangent.extend(old.w)).collect(),
                        false => Vec::new(),
                    },
                    normals: if wanted.normals { turns.normals } else { Vec::new() },
                    morph_targets: targets.by_ref().take(target_count).collect(),
                }
            })
            .collect();
        progress.at(1.0)?;
        Ok(Deformed { meshes, joints: self.deformed_joints() })
    }

    /// Where each joint is now, as in [`Deformed::joints`].
    pub fn deformed_joints(&self) -> Vec<DVec3> {
        let figure = &self.study.figure;
        if self.options.amount == 0.0 {
            return self.character.skeleton.joints.iter().map(|joint| joint.position()).collect();
        }
        figure
            .joints
            .iter()
            .zip(&self.joint_bindings)
            .zip(&self.character.skeleton.joints)
            .map(|((&p, binding), joint)| match binding {
                Binding::Fixed => joint.position(),
                _ => figure.frame.to_model(self.field.place(p, binding)),
            })
            .collect()
    }

    /// What the directions of a mesh turn into.
    fn turns(&self, index: usize, wanted: MeshOutputs, gradients: &Gradients) -> Turns {
        let mesh = &self.character.meshes[index];
        let figure = &self.study.figure;
        let frame = figure.frame.rotation();
        let back = frame.transpose();
        let start = figure.mesh_starts[index];
        let threads = self.options.thread_count;
        let turn = |vertex: usize| {
            let whole = start + vertex;
            let jacobian = gradients
                .jacobian(self.weld.representative[whole] as usize)
                .filter(has_volume)
                .unwrap_or_else(|| {
                    self.field.map(figure.positions[whole], &self.bindings[whole]).1.as_mat3().into()
                });
            back * jacobian * frame
        };
        let has_targets = wanted.morph_targets && !mesh.morph_targets.is_empty();
        if !(wanted.tangents || has_targets) {
            // The turns themselves are not needed any more.
            let normals = parallel::collect(threads, mesh.normals.len(), LEAST_VERTICES, |vertex| {
                turned_normal(&turn(vertex), mesh.normals[vertex])
            });
            return Turns { normals, ..Turns::default() };
        }
        let turns = parallel::collect(threads, mesh.positions.len(), LEAST_VERTICES, turn);
        let mut turns = Turns { turns, normals: Vec::new(), tangents: Vec::new() };
        turns.normals = parallel::collect(threads, mesh.normals.len(), LEAST_VERTICES, |vertex| {
            turns.normal(vertex, mesh.normals[vertex])
        });
        turns.tangents = parallel::collect(threads, mesh.tangents.len(), LEAST_VERTICES, |vertex| {
            turns.tangent(vertex, mesh.tangents[vertex].truncate())
        });
        turns
    }

    fn deform_target(&self, mesh: usize, target: usize, after: &[DVec3], turns: &Turns) -> MorphTarget {
        let start = self.study.figure.mesh_starts[mesh];
        let mesh = &self.character.meshes[mesh];
        let target = &mesh.morph_targets[target];
        let directions: Vec<Vec3> = match target.tangents.is_empty() {
            true => Vec::new(),
            false => mesh.tangents.iter().map(|tangent| tangent.truncate()).collect(),
        };
        MorphTarget {
            name: target.name.clone(),
            positions: self.morph_positions(start, &target.positions, after),
            normals: morph_turns(&target.normals, &mesh.normals, &turns.normals, &|vertex, normal| {
                turns.normal(vertex, normal)
            }),
            tangents: morph_turns(&target.tangents, &directions, &turns.tangents, &|vertex, tangent| {
                turns.tangent(vertex, tangent)
            }),
        }
    }

    /// D(v + d) - D(v): exact, and zero where d is.
    fn morph_positions(&self, start: usize, deltas: &[Vec3], after: &[DVec3]) -> Vec<Vec3> {
        let figure = &self.study.figure;
        let moved = |(vertex, &delta): (usize, &Vec3)| {
            if delta == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let whole = start + vertex;
            let p = figure.positions[whole] + figure.frame.to_canonical(delta.as_dvec3());
            let to = self.place_by(&self.field, whole, p);
            single(figure.frame.to_model(to - after[whole]))
        };
        deltas.iter().enumerate().map(moved).collect()
    }

    /// Heads often turn about a point in the neck: a head joint below the chin moves as the neck does (product mode).
    fn is_head_joint_in_neck(&self, joint: usize) -> bool {
        let figure = &self.study.figure;
        figure.humanoid.joint(Role::Head) == Some(joint)
            && figure.joints[joint].y < self.study.anatomy.landmarks.heights.chin
    }

    /// Where the field takes `point`, attached to `joint`; both in model space.
    pub fn map(&self, joint: usize, point: DVec3) -> Mapped {
        let frame = &self.study.figure.frame;
        let p = frame.to_canonical(point);
        let is_above_chin = p.y >= self.study.anatomy.landmarks.heights.chin;
        // What hangs from a head joint in the neck is on the head all the same, above the chin.
        let on_head = Binding::Parts(PartBinding::to(Part::Head));
        let binding = match &self.field {
            Field::Parts(_) if is_above_chin && self.is_head_joint_in_neck(joint) => &on_head,
            _ => &self.joint_bindings[joint],
        };
        let (position, jacobian) = self.field.map(p, binding);
        Mapped { position: frame.to_model(position), jacobian: frame.jacobian_to_model(jacobian) }
    }

    /// Length and radius of another body's bone groups, measured over the roles that target and style share.
    pub fn group_shapes(&self, shape: &BodyShape) -> BTreeMap<String, GroupShape> {
        group_shapes(shape, &self.roles, &self.options)
    }

    /// The character that is deformed: with the rig in place, where one was made.
    pub fn character(&self) -> &Arc<Character> {
        &self.character
    }

    /// What is set.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// What the style is.
    pub fn style(&self) -> &Style {
        &self.style
    }

    /// alpha and beta by group.
    pub fn coefficients(&self) -> &BTreeMap<String, Coefficient> {
        &self.coefficients
    }

    /// The target as it was measured.
    pub fn target(&self) -> &Measured {
        &self.study
    }

    /// What a person should know so far.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// The numbers of the run; `result` is measured anew on `deformed`. The host adds its own times and warnings.
    ///
    /// # Errors
    /// As [`Measured::of`] on the result.
    pub fn report(&self, deformed: &Deformed) -> Result<Report> {
        let result = Measured::of(&self.character.with(deformed), &self.options)?;
        let character = &self.character;
        let mut target = self.study.report(&self.roles, &self.options);
        let mut result = result.report(&self.roles, &self.options);
        let mut joint_count = character.skeleton.joints.len();
        if let Some(rig) = &self.made_rig {
            target.file_joints =
                joints_by_role(&rig.own, |joint| character.skeleton.joints[joint].position());
            result.file_joints = joints_by_role(&rig.own, |joint| deformed.joints[joint]);
            if rig.own_count > 0 {
                joint_count = rig.own_count;
            }
        }
        Ok(Report {
            target,
            reference: self.reference.clone(),
            result,
            mode: match self.options.mode {
                Mode::Paper => "paper",
                Mode::Product => "product",
            },
            g: self.head_ratio,
            coefficients: self.coefficients.clone(),
            rig: match &self.made_rig {
                Some(rig) => rig.report.clone(),
                None => RigReport {
                    source: "kept",
                    confidence: self.study.joints.keys().map(|role| (role.name().to_string(), 1.0)).collect(),
                    ..RigReport::default()
                },
            },
            counts: Counts {
                vertices: character.vertex_count(),
                triangles: character.triangle_count(),
                meshes: character.meshes.len(),
                morph_targets: character.meshes.iter().map(|mesh| mesh.morph_targets.len()).sum(),
                joints: joint_count,
            },
            timing_ms: self.timing,
            warnings: self.warnings.clone(),
        })
    }
}

/// How the directions at each vertex of a mesh turn, and what its own turn into; all empty where nothing of it is wanted.
#[derive(Default)]
struct Turns {
    /// Model space; empty where normals alone are wanted.
    turns: Vec<Mat3A>,
    normals: Vec<Vec3>,
    tangents: Vec<Vec3>,
}

impl Turns {
    fn normal(&self, vertex: usize, normal: Vec3) -> Vec3 {
        turned_normal(&self.turns[vertex], normal)
    }

    fn tangent(&self, vertex: usize, tangent: Vec3) -> Vec3 {
        let turned = Vec3::from(self.turns[vertex] * Vec3A::from(tangent));
        let flat = match self.normals.get(vertex) {
            Some(&normal) => turned.reject_from_normalized(normal),
            None => turned,
        };
        flat.normalize_or(tangent)
    }
}

/// What `normal` becomes where the surface turns by `turn`.
fn turned_normal(turn: &Mat3A, normal: Vec3) -> Vec3 {
    (normal_matrix(turn) * Vec3A::from(normal)).normalize_or(normal.into()).into()
}

/// The mesh as it came, of it what is wanted.
fn unchanged(mesh: &Mesh, wanted: MeshOutputs) -> DeformedMesh {
    let mut all = DeformedMesh { positions: mesh.positions.clone(), ..DeformedMesh::default() };
    if wanted.normals {
        all.normals.clone_from(&mesh.normals);
    }
    if wanted.tangents {
        all.tangents.clone_from(&mesh.tangents);
    }
    if wanted.morph_targets {
        all.morph_targets.clone_from(&mesh.morph_targets);
    }
    all
}

/// Where the joints of `humanoid` are, by role.
fn joints_by_role(humanoid: &Humanoid, place: impl Fn(usize) -> DVec3) -> BTreeMap<String, [f64; 3]> {
    humanoid.iter().map(|(role, joint)| (role.name().to_string(), place(joint).to_array())).collect()
}

/// A field of product mode that was tried.
struct Attempt {
    field: Field,
    coefficients: PartCoefficients,
    warnings: Vec<Warning>,
}

/// A style's numbers for the report, where its model is not at hand.
pub fn style_report(shape: &BodyShape, roles: &BTreeSet<Role>, options: &Options) -> FigureReport {
    let marks = shape.landmarks.unwrap_or_default();
    let proportions = shape.proportions.clone().unwrap_or_default();
    FigureReport {
        height: marks.crown - marks.sole,
        head_length: match options.mode {
            Mode::Paper => shape.head_length,
            Mode::Product => proportions.head_length,
        },
        heads: shape.heads().unwrap_or(f64::NAN),
        shape: group_shapes(shape, roles, options),
        landmarks: marks,
        ..FigureReport::default()
    }
}

impl Character {
    /// The same character as `deformed` leaves it.
    pub fn with(&self, deformed: &Deformed) -> Character {
        let mut character = self.clone();
        for (mesh, new) in character.meshes.iter_mut().zip(&deformed.meshes) {
            mesh.positions.clone_from(&new.positions);
            mesh.normals.clone_from(&new.normals);
            mesh.tangents.clone_from(&new.tangents);
            mesh.morph_targets.clone_from(&new.morph_targets);
        }
        for (joint, &position) in character.skeleton.joints.iter_mut().zip(&deformed.joints) {
            joint.rest.w_axis = position.extend(1.0);
        }
        character
    }
}

/// As floats. What lies beyond their range, which takes a model of over 1e30 units, ends there instead of at infinity.
fn single(p: DVec3) -> Vec3 {
    p.clamp(DVec3::splat(f32::MIN.into()), DVec3::splat(f32::MAX.into())).as_vec3()
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

/// Hats and glasses: components of accessories that the head moves, with the middle of each.
fn head_accessories(figure: &Figure, weld: &Weld) -> Vec<(Vec<usize>, DVec3)> {
    let component = components(&figure.triangles, weld);
    let mut pieces: BTreeMap<u32, (Vec<usize>, DVec3, DVec3)> = BTreeMap::new();
    for vertex in 0..figure.positions.len() {
        if figure.kind(vertex) == MeshKind::Accessory && is_of_head(figure, vertex) {
            let p = figure.positions[vertex];
            let (members, low, high) = pieces
                .entry(component[weld.representative[vertex] as usize])
                .or_insert((Vec::new(), DVec3::INFINITY, DVec3::NEG_INFINITY));
            members.push(vertex);
            *low = low.min(p);
            *high = high.max(p);
        }
    }
    pieces.into_values().map(|(members, low, high)| (members, (low + high) / 2.0)).collect()
}

/// Changes of unit vectors: what the changed vector turns into, less what the unchanged one did.
fn morph_turns(
    deltas: &[Vec3],
    before: &[Vec3],
    after: &[Vec3],
    turn: &dyn Fn(usize, Vec3) -> Vec3,
) -> Vec<Vec3> {
    if before.len() != deltas.len() {
        // Without base vectors there is nothing that the deltas change.
        return deltas.to_vec();
    }
    deltas
        .iter()
        .enumerate()
        .map(|(vertex, &delta)| {
            if delta == Vec3::ZERO {
                return Vec3::ZERO;
            }
            let changed = before[vertex] + delta;
            // What comes out is of unit length, whatever came in.
            let length = if before[vertex] == Vec3::ZERO { 1.0 } else { before[vertex].length() };
            turn(vertex, changed) * (changed.length() / length) - after[vertex]
        })
        .collect()
}
