//! The numbers of a run.

use super::memo::{Inputs, View};
use super::{Deformed, Deformer, head_stages};
use crate::character::{Humanoid, Role};
use crate::error::{Result, Warning};
use crate::options::Mode;
use crate::parallel;
use crate::progress::Progress;
use crate::report::{
    Counts, FigureReport, NewlyInside, ProfileReport, RepairReport, Report, RigReport, SoleClearance, by_name,
};
use crate::shape::figure::Figure;
use crate::shape::group::group_shapes;
use crate::shape::pose::{SIT, WALK};
use crate::shape::stride::clearance_of;
use crate::shape::{BodyShape, GroupShape, Measured};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What a person should know of a run before it is measured again.
pub fn warnings(view: &View) -> Result<Vec<Warning>> {
    let (measured, body) = (view.measured()?, view.body()?);
    let mut warnings: Vec<Warning> = view.notes().cloned().collect();
    warnings.extend(measured.anatomy.landmarks.warnings("target"));
    warnings.extend_from_slice(&body.warnings);
    if view.options.amount == 1.0 {
        warnings.extend(body.heads_left.clone());
    }
    warnings.extend(view.face()?.warning.clone());
    warnings.extend(head_stages::eyes_not_found(view)?);
    Ok(warnings)
}

impl Deformer {
    /// Roles that target and style share.
    fn roles(&self) -> BTreeSet<Role> {
        let of_style = self.inputs.style.shape().map(BodyShape::roles);
        let own = self.target().joints.keys().copied();
        own.filter(|role| of_style.as_ref().is_none_or(|roles| roles.contains(role))).collect()
    }

    /// Length and radius of another body's bone groups, measured over the roles that target and style share.
    pub fn group_shapes(&self, shape: &BodyShape) -> BTreeMap<String, GroupShape> {
        group_shapes(shape, &self.roles(), &self.inputs.options)
    }

    /// The numbers of the run; `result` is measured again on `deformed`. The host adds its own times and warnings.
    ///
    /// # Errors
    /// As [`Measured::of`] on the result.
    pub fn report(&self, deformed: &Deformed) -> Result<Report> {
        self.report_with(deformed, &mut Progress::none())
    }

    /// As [`Deformer::report`], and reports how far it is.
    ///
    /// # Errors
    /// `Cancelled` too.
    pub fn report_with(&self, deformed: &Deformed, progress: &mut Progress) -> Result<Report> {
        let Inputs { character, rig, style, options } = &self.inputs;
        let result = character.with(deformed);
        let figure = Arc::new(Figure::of(&result)?);
        let placed = Arc::clone(&figure);
        let (repair, measured) = parallel::both(
            options.thread_count,
            || self.clothes(&placed),
            || Measured::of_figure(figure, &result, options, progress),
        );
        let measured = measured?;
        let roles = self.roles();
        let mut target = FigureReport::of(self.target(), &roles, options);
        let mut result = FigureReport::of(&measured, &roles, options);
        let mut joints = character.skeleton.joints.len();
        if let Some(rig) = rig {
            let at_rest = |joint: usize| character.skeleton.joints[joint].position();
            target.file_joints = joints_by_role(&rig.own, at_rest);
            result.file_joints = joints_by_role(&rig.own, |joint| deformed.joints[joint]);
            joints = if rig.own_count > 0 { rig.own_count } else { joints };
        }
        let mut warnings = self.warnings.to_vec();
        warnings.extend(repair.and_then(pierced));
        Ok(Report {
            target,
            reference: style.shape().map(|shape| FigureReport::of_style(shape, &roles, options)),
            result,
            mode: options.mode.name(),
            g: self.deformation.body.head_ratio,
            coefficients: self.coefficients().clone(),
            profile: ProfileReport::of(self.target(), style, &measured),
            rig: rig.as_ref().map_or_else(|| self.kept_rig(), |rig| rig.report.clone()),
            repair,
            sole_clearance: SoleClearance { target: soles(self.target()), result: soles(&measured) },
            morph_pair_error: self.morph_pair_error() / measured.figure.height(),
            counts: Counts {
                vertices: character.vertex_count(),
                triangles: character.triangle_count(),
                meshes: character.meshes.len(),
                morph_targets: character.meshes.iter().map(|mesh| mesh.morph_targets.len()).sum(),
                joints,
            },
            timing_ms: self.timing(),
            warnings,
        })
    }

    /// What became of the clothes in `result`.
    fn clothes(&self, result: &Figure) -> Option<RepairReport> {
        if self.inputs.options.mode == Mode::Paper {
            return None;
        }
        let (worn, pushed) = (self.view().worn().ok()?, self.view().pushed().ok()?);
        if worn.places.is_empty() {
            return None;
        }
        let (before, threads) = (&self.target().figure, self.inputs.options.thread_count);
        let [rest, walk, sit] = worn.newly_inside(before, result, [&[], WALK, SIT], threads);
        let furthest = pushed.offsets.iter().map(|(_, offset)| offset.length()).fold(0.0, f64::max);
        Some(RepairReport {
            pushed: pushed.offsets.len(),
            furthest: self.field.finish.share_of_offsets() * furthest / result.height(),
            newly_inside: NewlyInside { rest, walk, sit },
        })
    }

    /// How far a vertex is at most from where the field takes it when its two largest morph targets are on at once, model units.
    fn morph_pair_error(&self) -> f64 {
        if self.field.finish.is_nothing() {
            return 0.0;
        }
        let placement = self.placement();
        let figure = placement.figure;
        let mut worst: f64 = 0.0;
        for (mesh, &start) in self.inputs.character.meshes.iter().zip(&figure.mesh_starts) {
            for vertex in 0..mesh.positions.len() {
                let mut largest = [DVec3::ZERO; 2];
                for delta in mesh.morph_targets.iter().map(|target| target.positions[vertex].as_dvec3()) {
                    if delta.length_squared() > largest[0].length_squared() {
                        largest = [delta, largest[0]];
                    } else if delta.length_squared() > largest[1].length_squared() {
                        largest[1] = delta;
                    }
                }
                if largest[1] == DVec3::ZERO {
                    continue;
                }
                let p = mesh.positions[vertex].as_dvec3();
                let to =
                    |delta: DVec3| placement.beside(start + vertex, figure.frame.to_canonical(p + delta));
                let [one, other] = largest;
                let straight = to(one) + to(other) - to(DVec3::ZERO);
                worst = worst.max(to(one + other).distance(straight));
            }
        }
        worst
    }

    /// The character's own rig, of which every joint is sure.
    fn kept_rig(&self) -> RigReport {
        let confidence = by_name(self.target().joints.keys().map(|&role| (role, 1.0)));
        RigReport { source: "kept", confidence, ..RigReport::default() }
    }
}

/// A share of the clothes that is pierced sitting is told above this: a fiftieth is a hem.
const PIERCED_WARNED_ABOVE: f64 = 0.02;

/// A warning where the body goes through clothes in a pose, which no rest pose mends.
fn pierced(repair: RepairReport) -> Option<Warning> {
    let NewlyInside { walk, sit, .. } = repair.newly_inside;
    (walk.max(sit) > PIERCED_WARNED_ABOVE).then(|| {
        let message = format!(
            "the body goes through more of the clothes than before: {:.1} % of them in a walk, {:.1} % sitting; give a skirt springs, or weights to the thighs",
            100.0 * walk,
            100.0 * sit
        );
        Warning::new("clothes_pierced", message)
    })
}

/// How far soles stay from the floor in a walk.
fn soles(measured: &Measured) -> Option<f64> {
    clearance_of(&measured.figure, measured.anatomy.landmarks.heights.sole)
}

/// Where the joints of `humanoid` are, by role.
fn joints_by_role(humanoid: &Humanoid, place: impl Fn(usize) -> DVec3) -> BTreeMap<String, [f64; 3]> {
    by_name(humanoid.iter().map(|(role, joint)| (role, place(joint).to_array())))
}
