//! Puts the stages in order: what is known so far, and what comes out.

use crate::character::{Character, MorphTarget, Role};
use crate::error::{Error, ErrorKind, Result, Warning};
use crate::face::FaceShape;
use crate::geometry::weld::{Weld, weld};
use crate::report::{Coefficient, Counts, FigureReport, LandmarkHeights, Timing};
use crate::shape::attributes::{fitted_jacobians, normal_matrix};
use crate::shape::field::{Binding, Field};
use crate::shape::figure::Figure;
use crate::shape::landmarks::landmarks;
use crate::shape::part_coefficients::{PartCoefficients, Wanted, part_coefficients};
use crate::shape::part_weights::{
    Manner, PartBinding, PartBindings, WELD_TOLERANCE, joint_binding, part_bindings,
};
use crate::shape::parts::PartField;
use crate::shape::proportions::{Anatomy, Part, Proportions};
use glam::{DMat3, DVec3, Vec3, Vec4};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Which field deforms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// 15 parts that meet at landmarks read from the geometry.
    #[default]
    Product,
    /// The paper's chain of bones, Eqs. 1-8, literally.
    Paper,
}

/// The curve that makes a face younger (§VI, Fig. 7).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceCurve {
    /// Eq. 13, the paper's choice.
    #[default]
    F4,
    /// Eq. 12.
    F2,
    /// The sphere approximation of Shen et al. [10], for comparison (Fig. 7f).
    Sphere,
}

/// How far to go (Fig. 6).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Lengths only (Fig. 6b).
    Length,
    /// Lengths and thickness (Fig. 6c).
    Thickness,
    /// Everything.
    #[default]
    Face,
}

/// What a user sets for one bone group; `None` leaves the measured or the default value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroupSettings {
    /// alpha_b: 1 keeps the length of the group's bones.
    pub length_scale: Option<f64>,
    /// beta_b: 1 keeps the girth.
    pub thickness_scale: Option<f64>,
    /// eta_b: 0 keeps the target's length, 1 takes all of the reference's.
    pub length_transfer: Option<f64>,
    /// phi_b: 0 keeps the target's girth, 1 takes all of the reference's.
    pub thickness_transfer: Option<f64>,
}

/// Everything a user can set.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Which field deforms.
    pub mode: Mode,
    /// Rays around each sample of a bone (§V-A); `None`: 12 in paper mode, 48 in product mode. At least 3.
    pub rays: Option<usize>,
    /// alpha_head (Eq. 4), above 0.
    pub head_scale: f64,
    /// gamma (Eqs. 12, 13); `None`: 0 in paper mode, 0.8 in product mode.
    pub face_squash: Option<f64>,
    /// Which curve `face_squash` is for.
    pub face_curve: FaceCurve,
    /// Settings by the name of the bone group.
    pub groups: BTreeMap<String, GroupSettings>,
    /// The user's own bone groups (§IV-A, Fig. 3): the role at a bone's end to a group name.
    pub bone_groups: BTreeMap<Role, String>,
    /// 0 gives the original back, 1 the style.
    pub amount: f64,
    /// Product mode's bounds on coefficients (D27).
    pub limits: bool,
    /// Length of hair below the chin: 1 ends it at the part of the body where it ended, 0 at the chin.
    pub hair_length: f64,
    /// Stop after this stage.
    pub stage: Stage,
    /// Threads to use; 0 means all cores.
    pub thread_count: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            mode: Mode::Product,
            rays: None,
            head_scale: 1.5,
            face_squash: None,
            face_curve: FaceCurve::F4,
            groups: BTreeMap::new(),
            bone_groups: BTreeMap::new(),
            amount: 1.0,
            limits: true,
            hair_length: 1.0,
            stage: Stage::Face,
            thread_count: 0,
        }
    }
}

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

/// What a character should become.
#[derive(Clone, Debug, PartialEq)]
pub enum Style {
    /// Like a reference that was measured.
    Reference(Proportions),
    /// So many heads tall, 1.8 to 6; everything else after the target.
    Heads(f64),
}

/// gamma of product mode (D28).
pub const PRODUCT_FACE_SQUASH: f64 = 0.8;
/// A measured head count this near to the one asked for needs no correction.
const HEADS_TOLERANCE: f64 = 2e-3;
/// Corrections of a style for N heads before what is left is reported.
const HEADS_ATTEMPTS: usize = 4;

/// A character and a field made for it: made once, applied as often as something changes.
#[derive(Clone, Debug)]
pub struct Deformer {
    character: Arc<Character>,
    figure: Figure,
    weld: Weld,
    field: Field,
    bindings: Vec<Binding>,
    joint_bindings: Vec<Binding>,
    /// Scales by bone group.
    pub coefficients: BTreeMap<String, Coefficient>,
    /// What a person should know.
    pub warnings: Vec<Warning>,
    /// Milliseconds by stage.
    pub timing: Timing,
}

impl Deformer {
    /// Reads the target and makes the field that gives it the style.
    ///
    /// # Errors
    /// What [`Character::validate`] and [`Figure::of`] refuse, and options out of their range.
    pub fn new(character: Arc<Character>, style: &Style, options: &Options) -> Result<Self> {
        let figure = Figure::of(&character)?;
        let weld = weld(&figure.positions, WELD_TOLERANCE * figure.height());
        let anatomy = Anatomy::of(&figure);
        let parts = part_bindings(&figure, &anatomy, &character.skeleton);
        let mut warnings = anatomy.landmarks.warnings("target");
        let squash = match options.face_squash {
            Some(squash) => squash,
            None if anatomy.landmarks.chin_seen => PRODUCT_FACE_SQUASH,
            None => 0.0,
        };
        let bindings: Vec<Binding> = parts
            .vertices
            .iter()
            .map(|&binding| Binding::Parts(binding))
            .collect();
        let joint_bindings = joint_bindings(&character, &figure, &parts, &anatomy);
        let mut deformer = Self {
            field: Field::Parts(PartField::new(
                &anatomy,
                PartCoefficients::IDENTITY,
                &parts,
                |_| FaceShape::None,
                1.0,
                0.0,
            )),
            character,
            figure,
            weld,
            bindings,
            joint_bindings,
            coefficients: BTreeMap::new(),
            warnings: Vec::new(),
            timing: Timing::default(),
        };
        let mut make = |wanted: Wanted| -> Result<Vec<Warning>> {
            let (coefficients, warnings) = part_coefficients(&anatomy.proportions, wanted, options)?;
            let face = |heights: &crate::shape::parts::Heights| {
                if options.stage < Stage::Face || squash == 0.0 {
                    FaceShape::None
                } else {
                    FaceShape::F4 {
                        bottom: heights.chin,
                        top: heights.crown,
                        squash,
                    }
                }
            };
            let field = PartField::new(
                &anatomy,
                coefficients,
                &parts,
                face,
                options.hair_length,
                options.amount,
            );
            deformer.field = Field::Parts(field);
            deformer.stand_on_ground();
            deformer.coefficients = coefficients.by_group();
            Ok(warnings)
        };
        match style {
            Style::Reference(reference) => warnings.extend(make(Wanted::Reference(reference))?),
            Style::Heads(heads) => {
                warnings.extend(make(Wanted::Heads(*heads))?);
            }
        }
        deformer.warnings = warnings;
        Ok(deformer)
    }

    /// Feet stand where they stood (D19): the lowest vertex that is not hair keeps its height.
    fn stand_on_ground(&mut self) {
        self.field.set_ground(0.0);
        let lowest = |height: &dyn Fn(usize) -> f64| {
            (0..self.figure.positions.len())
                .filter(|&vertex| match &self.bindings[vertex] {
                    Binding::Parts(binding) => {
                        let legs: f32 = binding.weights[Part::LeftUpperLeg as usize..].iter().sum();
                        legs > 0.5
                    }
                    Binding::Fixed => false,
                })
                .map(height)
                .min_by(f64::total_cmp)
        };
        let before = lowest(&|vertex| self.figure.positions[vertex].y);
        let after = lowest(&|vertex| {
            self.field
                .map(self.figure.positions[vertex], &self.bindings[vertex])
                .0
                .y
        });
        if let (Some(before), Some(after)) = (before, after) {
            self.field.set_ground(before - after);
        }
    }

    /// The new positions of all vertices, canonical frame.
    fn deformed_positions(&self) -> Vec<DVec3> {
        self.figure
            .positions
            .iter()
            .zip(&self.bindings)
            .map(|(&p, binding)| self.field.map(p, binding).0)
            .collect()
    }

    /// The whole result.
    pub fn apply(&self) -> Deformed {
        let after = self.deformed_positions();
        let jacobians = fitted_jacobians(&self.figure.positions, &after, &self.figure.triangles, &self.weld);
        let meshes = (0..self.character.meshes.len())
            .map(|mesh| self.deform_mesh(mesh, &after, &jacobians))
            .collect();
        let joints = (0..self.figure.joints.len())
            .map(|joint| {
                let (p, _) = self
                    .field
                    .map(self.figure.joints[joint], &self.joint_bindings[joint]);
                self.figure.frame.to_model(p)
            })
            .collect();
        Deformed { meshes, joints }
    }

    fn deform_mesh(&self, index: usize, after: &[DVec3], jacobians: &[Option<DMat3>]) -> DeformedMesh {
        let mesh = &self.character.meshes[index];
        let frame = &self.figure.frame;
        let start = self.figure.mesh_starts[index];
        let count = mesh.positions.len();
        let positions = after[start..start + count]
            .iter()
            .map(|&p| frame.to_model(p).as_vec3())
            .collect();
        let needs_jacobian = !mesh.normals.is_empty() || !mesh.tangents.is_empty();
        let turns: Vec<DMat3> = (0..if needs_jacobian { count } else { 0 })
            .map(|vertex| {
                let whole = start + vertex;
                let fitted = jacobians[self.weld.representative[whole] as usize];
                let jacobian = fitted
                    .filter(|jacobian| jacobian.determinant().abs() > 1e-12)
                    .unwrap_or_else(|| {
                        self.field
                            .map(self.figure.positions[whole], &self.bindings[whole])
                            .1
                    });
                frame.jacobian_to_model(jacobian)
            })
            .collect();
        let turn_normal = |vertex: usize, normal: Vec3| {
            (normal_matrix(turns[vertex]) * normal.as_dvec3()).normalize_or(normal.as_dvec3())
        };
        let normals: Vec<Vec3> = mesh
            .normals
            .iter()
            .enumerate()
            .map(|(vertex, &normal)| turn_normal(vertex, normal).as_vec3())
            .collect();
        let turn_tangent = |vertex: usize, tangent: Vec3| {
            let turned = turns[vertex] * tangent.as_dvec3();
            let flat = match normals.get(vertex) {
                Some(normal) => turned.reject_from(normal.as_dvec3()),
                None => turned,
            };
            flat.normalize_or(tangent.as_dvec3())
        };
        let tangents = mesh
            .tangents
            .iter()
            .enumerate()
            .map(|(vertex, tangent)| {
                turn_tangent(vertex, tangent.truncate())
                    .as_vec3()
                    .extend(tangent.w)
            })
            .collect();
        let morph_targets = mesh
            .morph_targets
            .iter()
            .map(|target| MorphTarget {
                name: target.name.clone(),
                positions: target
                    .positions
                    .iter()
                    .enumerate()
                    .map(|(vertex, &delta)| {
                        if delta == Vec3::ZERO {
                            return Vec3::ZERO;
                        }
                        let whole = start + vertex;
                        let p = self.figure.positions[whole] + frame.to_canonical(delta.as_dvec3());
                        let to = self.field.map(p, &self.bindings[whole]).0;
                        frame.to_model(to - after[whole]).as_vec3()
                    })
                    .collect(),
                normals: morph_turns(&target.normals, &mesh.normals, &normals, &turn_normal),
                tangents: {
                    let before: Vec<Vec3> = mesh.tangents.iter().map(|tangent| tangent.truncate()).collect();
                    let now: Vec<Vec3> = before
                        .iter()
                        .enumerate()
                        .map(|(v, &t)| turn_tangent(v, t).as_vec3())
                        .collect();
                    morph_turns(&target.tangents, &before, &now, &turn_tangent)
                },
            })
            .collect();
        DeformedMesh {
            positions,
            normals,
            tangents,
            morph_targets,
        }
    }

    /// Where the field takes `point`, attached to `joint`; both in model space.
    pub fn map(&self, joint: usize, point: DVec3) -> Mapped {
        let frame = &self.figure.frame;
        let (position, jacobian) = self
            .field
            .map(frame.to_canonical(point), &self.joint_bindings[joint]);
        Mapped {
            position: frame.to_model(position),
            jacobian: frame.jacobian_to_model(jacobian),
        }
    }
}

/// Changes of unit vectors: what the changed vector turns into, less what the unchanged one did.
fn morph_turns(
    deltas: &[Vec3],
    before: &[Vec3],
    after: &[Vec3],
    turn: &dyn Fn(usize, Vec3) -> DVec3,
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
            (turn(vertex, changed) * f64::from(changed.length())).as_vec3() - after[vertex]
        })
        .collect()
}

/// How each joint is attached: role joints by their own part, others by the part they fold into; what lies above the
/// hips stays.
fn joint_bindings(
    character: &Character,
    figure: &Figure,
    parts: &PartBindings,
    anatomy: &Anatomy,
) -> Vec<Binding> {
    let mut above_hips = vec![false; figure.joints.len()];
    for (_, joint) in figure.humanoid.iter() {
        for above in character.skeleton.ancestors(joint).skip(1) {
            above_hips[above] = true;
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
            None if above_hips[joint] || !weighted[joint] => Binding::Fixed,
            Some(Role::Head)
                if figure.humanoid.joint(Role::Head) == Some(joint)
                    && figure.joints[joint].y < anatomy.landmarks.chin =>
            {
                // The head turns about a point in the neck: below the chin it moves as the neck does.
                Binding::Parts(PartBinding::to(Part::Neck))
            }
            _ => Binding::Parts(joint_binding(figure, parts, joint)),
        })
        .collect()
}

/// Measures a character for the report.
pub fn describe(character: &Character) -> Result<FigureReport> {
    let figure = Figure::of(character)?;
    let marks = landmarks(&figure);
    let by_role = |_: ()| -> BTreeMap<String, [f64; 3]> {
        character
            .humanoid
            .iter()
            .map(|(role, joint)| {
                (
                    role.name().to_string(),
                    character.skeleton.joints[joint].position().to_array(),
                )
            })
            .collect()
    };
    Ok(FigureReport {
        height: figure.height(),
        head_length: marks.head_length(),
        heads: marks.heads(),
        shape: BTreeMap::new(),
        joints: by_role(()),
        file_joints: by_role(()),
        landmarks: LandmarkHeights {
            crown: marks.crown,
            chin: marks.chin,
            shoulder_line: marks.shoulder_line,
            crotch: marks.crotch,
            sole: marks.sole,
        },
    })
}
